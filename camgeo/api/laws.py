"""The motion laws by name, as numbers and as functions."""

from __future__ import annotations

from typing import TYPE_CHECKING, overload

from camgeo.common.arguments import numbers_of, short_repr, whole_of
from camgeo.common.errors import CallError
from kin.law.sources.laws import NAMES, formula, named
from kin.law.sources.peaks import peaks
from kin.numeric.records import dataclass, field

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import ArrayLike

    from kin.law.normalised import Law as Motion
    from kin.numeric.arrays import Array

MOST_DERIVATIVE = 3  # the jerk


@dataclass(frozen=True)
class Law:
    """A motion law: displacement s(u) from 0 to 1 while u runs from 0 to 1.

    `velocity`, `acceleration` and `jerk` are the greatest absolute values of its derivatives for unit stroke over unit
    time, `jerk` infinite where the acceleration steps. A stroke h over an angle b, rad, has h/b, h/b^2 and h/b^3 times
    as much. `formula` is the displacement as text.
    """

    name: str
    formula: str
    velocity: float
    acceleration: float
    jerk: float
    _motion: Motion = field(repr=False, compare=False)

    @overload
    def __call__(self, u: float, *, derivative: int = 0) -> float: ...

    @overload
    def __call__(self, u: ArrayLike, *, derivative: int = 0) -> Array: ...

    def __call__(self, u: ArrayLike, *, derivative: int = 0) -> float | Array:
        """Displacement at u from 0 to 1, or a derivative by u up to the third.

        Where a derivative jumps it is the limit from above, at 1 from below. The result has the shape of `u`; a number
        gives a number. Raises CallError for another u or order, TypeError for what is no number.
        """
        share, order = numbers_of("u", u), whole_of("derivative", derivative)
        if not bool(((share >= 0.0) & (share <= 1.0)).all()):
            raise CallError("u is the share of a segment, from 0 to 1")
        if order not in range(MOST_DERIVATIVE + 1):
            raise CallError(f"a derivative is one of order 0 to {MOST_DERIVATIVE}, not {short_repr(order)}")
        row = self._motion.derivatives(share.ravel(), order)[order].reshape(share.shape)
        return float(row) if row.ndim == 0 else row


def laws() -> Mapping[str, Law]:
    """Motion laws by their names in recipes, in the order of `camgeo laws`."""
    pairs = ((law, peaks(law.motion)) for law in map(named, NAMES))
    return {
        law.name: Law(law.name, formula(law.name), top.velocity, top.acceleration, top.jerk, law) for law, top in pairs
    }
