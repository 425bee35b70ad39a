// Image files.
