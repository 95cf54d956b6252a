"""Helpers of all packages: arguments, errors, texts on the terminal, processes, the clock of a run."""
