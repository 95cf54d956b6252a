"""Reports of runs: checks, files, errors, times."""
