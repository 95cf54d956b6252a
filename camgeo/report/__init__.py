"""What a run found: checks, files, errors, times."""
