"""Disc cams from a short recipe to files, with the motion proved from the files themselves."""

__version__ = "0.1.0"
