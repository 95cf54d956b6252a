"""The version, for whoever asks for nothing else."""

__version__ = "0.1.0"
