"""Undercut, local and global: where, why, and trimmed if the recipe says so."""
