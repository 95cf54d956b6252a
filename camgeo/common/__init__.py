"""What every room uses: rounding, the clock of a run."""
