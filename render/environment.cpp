// environment
