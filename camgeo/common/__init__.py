"""Helpers of all packages: rounding, the clock of a run."""
