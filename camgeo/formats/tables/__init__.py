"""A file each for the tables of a CSV: its columns, how much of a cam it holds, what it needs, and what judges it."""
