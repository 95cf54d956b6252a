"""Disc cams from a short recipe to files, their motion judged from the files themselves."""

__version__ = "0.1.0"
