"""Attacks by chance on the command line: recipes, wrong recipes, altered files and calls, judged independently."""
