"""The one error for a library that a file needs and that is not installed."""


class MissingExtraError(ImportError):
    """An extra of this package is not installed; the message names it and says how to get it."""
