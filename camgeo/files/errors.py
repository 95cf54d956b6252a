"""Errors of writers: a library that is not installed, a region that has no triangles."""

from importlib.util import find_spec

from kin.numeric.errors import CamgeoError


class MissingExtraError(CamgeoError, ImportError):
    """A package is missing or of another version; the message has the command that installs it."""


class RegionError(CamgeoError, ValueError):
    """No sound solid can be made of outlines.

    An outline touches or crosses itself or another, a piece is too short or too sharp, or a body does not close.
    """


def demand_package(name: str, reason: str) -> None:
    """Raise MissingExtraError where a package is not installed; the message begins with `reason`."""
    if find_spec(name) is None:
        raise MissingExtraError(f"{reason}: pip install {name}")


def install(extra: str) -> str:
    """Command that installs an extra of this package from a clone, as no index has the package."""
    return f"pip install '.[{extra}]' in a clone of camgeo"


def demand_uninterrupted(error: ImportError) -> None:
    """Raise the KeyboardInterrupt that a binding wrapped in an ImportError; return for any other ImportError."""
    if isinstance(error.__cause__, KeyboardInterrupt):
        raise error.__cause__
