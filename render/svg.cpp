// svg
