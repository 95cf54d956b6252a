"""Errors of measured points, raised as those of the call that names their files."""

from __future__ import annotations

from contextlib import contextmanager
from typing import TYPE_CHECKING

from camgeo.capabilities.made.keys import in_recipe
from camgeo.common.errors import CallError
from camgeo.common.terminal import escaped
from kin.follower.frame_contact import FrameError
from kin.follower.motion_error import ContactError
from kin.made.points import UnlikePointsError
from kin.made.smooth import GapError, SpansError
from kin.numeric.errors import UnsettledError

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence
    from pathlib import Path

    from camgeo.recipe.recipe import Recipe


_OF_POINTS = (UnlikePointsError, GapError, SpansError, UnsettledError)  # errors of points that cannot be judged


@contextmanager
def as_call_errors(paths: Sequence[Path], name: str = "") -> Iterator[None]:
    """Turn errors of points, ContactError and FrameError into CallErrors that name the files of points.

    Those of points are UnlikePointsError, GapError, SpansError and UnsettledError. With the `name` of a cam they name
    it too. A CallError that names none of the files gets their names. Other errors pass unchanged.
    """
    names, lobe = [escaped(str(path)) for path in paths], f"{name}: " if name else ""
    files = ", ".join(names)
    try:
        yield
    except (ContactError, FrameError) as error:
        raise CallError(f"{files}: {lobe}on the metal that these points tell, {error}") from error
    except CallError as error:
        heads = ["" if any(each in fault for each in names) else f"{files}: " for fault in error.faults]
        raise CallError(*(f"{head}{lobe}{fault}" for head, fault in zip(heads, error.faults, strict=True))) from error
    except _OF_POINTS as error:
        raise CallError(f"{files}: {lobe}{error}") from error


@contextmanager
def refused_at(recipe: Recipe, place: str, file: str = "", path: Path | None = None) -> Iterator[None]:
    """Turn CallError, ContactError and errors of points into RecipeErrors at `place` in the recipe.

    Errors of points are as in `as_call_errors`; others pass unchanged. A message that begins with the `path` of the
    file begins with its name in the recipe, `file`, instead; options of `verify` in remedies become keys of the file's
    entry.
    """
    try:
        yield
    except CallError as error:
        faults = [fault.removeprefix(f"{escaped(str(path))}: ") for fault in error.faults]
    except (ContactError, *_OF_POINTS) as error:
        faults = [str(error)]
    else:
        return
    name = f"{escaped(file)}: " if file else ""
    raise recipe.error(place, f"{name}{in_recipe('; '.join(faults))}")
