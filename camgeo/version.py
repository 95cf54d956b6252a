"""The version, for whoever asks for nothing else."""

__version__ = "0.2.0"
