"""What the checks of a design ask of capabilities and formats."""

from __future__ import annotations

from typing import TYPE_CHECKING

from camgeo.registry.formats import of_formats
from camgeo.registry.slot import Slot, always
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from camgeo.cams.family import ExactCam
    from camgeo.cams.surface import Surface
    from camgeo.checks.declaration import Declared
    from camgeo.curve.curve import Curve
    from camgeo.recipe.recipe import Recipe
    from kin.numeric.check import Check


@dataclass(frozen=True, kw_only=True)
class Checks:
    """Answers of a capability that checks something; figures are in mm and degrees.

    checks  declarations of all its checks of discs; every check that it makes of them is declared here
    others  declarations of checks that it makes of its own kind of cam alone, as far as they differ from a plain one
    exact   checks that need no file: (recipe, exact cam, pairs of a surface and its contour)
    remedy  sentence on a change that would bring a figure of its own to a bound that it misses: (recipe, name of the
            figure, its value, the bound); empty where none is known
    """

    checks: Sequence[Declared] = ()
    others: Sequence[Declared] = ()
    exact: Callable[[Recipe, ExactCam, Sequence[tuple[Surface, Curve]]], Sequence[Check]] = always(())
    remedy: Callable[[Recipe, str, float, float], str] = always("")


CHECKING = Slot("checks", Checks())


def _has_holes(recipe: Recipe, /) -> bool:
    """Whether the part has holes besides its bore."""
    return recipe.part.holed


@dataclass(frozen=True, kw_only=True)
class Holes:
    """Holes that files of a format have of a part.

    bored    whether they have its bore
    drilled  whether they have holes besides the bore
    """

    bored: Callable[[Recipe], bool] = always(True)
    drilled: Callable[[Recipe], bool] = _has_holes


HOLES_OF = of_formats("HOLES", Holes())
"""`HOLES` of each format by its word."""
