// delta_e
