"""One module for each kind of file that a run makes: fitted where it needs a fit, written, read back and judged."""
