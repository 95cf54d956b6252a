"""What a writer refuses: a library that is not installed, a region that has no triangles."""

from importlib.util import find_spec

from kin.numeric.errors import CamgeoError


class MissingExtraError(CamgeoError, ImportError):
    """An extra of this package is not installed; the message names it and says how to get it."""


class RegionError(CamgeoError, ValueError):
    """A region that has no triangles: its boundary touches or crosses itself, or a hole reaches its edge."""


def demand_package(name: str, reason: str) -> None:
    """Raise MissingExtraError where a package is not installed; the message begins with what needs it."""
    if find_spec(name) is None:
        raise MissingExtraError(f"{reason}: pip install {name}")


def install(extra: str) -> str:
    """How to get an extra of this package, which no index has: from a clone of it."""
    return f"pip install '.[{extra}]' in a clone of camgeo"


def demand_uninterrupted(error: ImportError) -> None:
    """Raise the interrupt by which an import was ended: a binding reports one so while it is set up."""
    if isinstance(error.__cause__, KeyboardInterrupt):
        raise error.__cause__
