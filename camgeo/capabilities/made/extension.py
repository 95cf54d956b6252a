"""What the judging of a made part asks of other capabilities."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from camgeo.registry.slot import Slot, always
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from camgeo.recipe.recipe import Recipe
    from camgeo.synthesis.design import Design
    from kin.numeric.arrays import Array


class MadeMotion(NamedTuple):
    """The motion of a follower on a made part, beside the intended one, at shaft angles (n,), rad; mm or rad.

    `errors` are made less intended position, velocity and acceleration by the shaft angle (3, n), without the offset
    that is set on assembly; nan where acceleration jumps. `sds` are their standard deviations (3, n). `deviation` gives
    the standard deviation of a sum of position errors with the weights (n,). `gap` is by how much the play of two
    opposite contacts exceeds the intended one, with its standard deviation (2, n); None for a single contact.
    """

    shaft: Array
    errors: Array
    sds: Array
    deviation: Callable[[Array], float]
    gap: Array | None = None


class MadeFigure(NamedTuple):
    """A figure of a made motion as intended and as made, in `unit`.

    `uncertainty` is the expanded uncertainty (k = 2) of the made figure, `at_deg` the shaft angle of its place.
    """

    name: str
    unit: str
    intended: float
    made: float
    uncertainty: float
    at_deg: float


class MadeFigures(NamedTuple):
    """Figures of a made motion by a capability, and sentences on those that it cannot give."""

    figures: Sequence[MadeFigure] = ()
    remarks: Sequence[str] = ()


@dataclass(frozen=True, kw_only=True)
class OnMetal:
    """Answers of a capability with figures of the motion that a made part gives.

    figures  (recipe, design, motion); raises RecipeErrors where they cannot be had
    """

    figures: Callable[[Recipe, Design, MadeMotion], MadeFigures] = always(MadeFigures())


ON_METAL = Slot("made", OnMetal())
