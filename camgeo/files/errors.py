"""The one error for a library that a file needs and that is not installed."""

from kin.numeric.errors import KinError


class MissingExtraError(KinError, ImportError):
    """An extra of this package is not installed; the message names it and says how to get it."""


def install(extra: str) -> str:
    """How to get an extra of this package, which no index has: from a clone of it."""
    return f"pip install '.[{extra}]' in a clone of camgeo"
