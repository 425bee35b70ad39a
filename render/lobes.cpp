// lobes
