"""A motion as a recipe states it, over its input: what a program needs that draws it and changes its segments."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Callable

    from camgeo.motions.motion import MotionSource
    from kin.numeric.arrays import Array


class StatedMotion(NamedTuple):
    """A motion and its input.

    source    the motion in the recipe; None where the recipe gives none over this input
    total     input that it fills with all repeats, rad or mm
    repeat    number of its repeats
    behind    what comes behind it: the `same` again, its `opposite`, which falls as it rose, or `nothing`
    lift      displacements, mm or rad, at inputs (n,), rad or mm
    per_input, per_lift  degrees, or units of the recipe, of a rad or a mm of the input and of the displacement
    """

    source: MotionSource | None
    total: float
    repeat: int
    behind: Literal["same", "opposite", "nothing"]
    lift: Callable[[Array], Array]
    per_input: float
    per_lift: float
