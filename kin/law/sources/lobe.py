"""The lobe polynomial 2-p-q-r-s of valve trains."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import TYPE_CHECKING

from kin.law.programme import IntentError
from kin.law.segment import Affine, Constant
from kin.law.sources.functions import Flank
from kin.law.sources.motion import Motion, joined

if TYPE_CHECKING:
    from collections.abc import Sequence

_GREATEST_POWER = 100


def lobe(
    lift: float,
    half: float,
    powers: Sequence[float],
    total: float = 2 * math.pi,
    *,
    around: int | None = 1,
    field: str = "motion.lobe",
) -> Motion:
    """Make S = lift (1 + C2 u**2 + Cp u**p + ... + Cs u**s), u = |theta|/half, the nose at 0, rest beyond `half` rad.

    Where the motion does not repeat (`around` as for `Motion`), the nose stands in the middle. `powers` are
    (2, p, q, r, s), rising whole numbers; the coefficients make S to S'''' vanish at u = 1 (R. L. Norton, Cam Design
    and Manufacturing Handbook, chapter on valve trains). IntentError for what is none.
    """
    if not (math.isfinite(lift) and lift > 0):
        raise IntentError(f"the lift of a lobe must be above 0, not {lift:.6g}", f"{field}.lift")
    if not (math.isfinite(half) and 0 < half < total / 2):
        raise IntentError(
            f"half the event lies between 0 and {math.degrees(total / 2):.6g} degrees, not {math.degrees(half):.6g}",
            f"{field}.half",
        )
    rising = all(int(k) == k for k in powers) and all(a < b for a, b in pairwise(powers))
    if len(powers) != 5 or powers[0] != 2 or not rising or powers[-1] > _GREATEST_POWER:
        shown = ", ".join(f"{k:g}" for k in powers)
        raise IntentError(
            f"the powers of a lobe are 2 and four more whole numbers that rise to {_GREATEST_POWER} at most, "
            f"such as [2, 8, 14, 20, 26], not [{shown}]",
            f"{field}.powers",
        )
    flank, _ = Flank.of([int(k) for k in powers])
    if around != 1:
        nose = total / 2
        up = Affine(flank, scale=lift, start=nose - half, width=half)
        down = Affine(flank, scale=lift, start=nose + half, width=-half)
        knots = [0.0, nose - half, nose, nose + half, total]
        return joined(knots, [Constant(0.0), up, down, Constant(0.0)], around)
    falling = Affine(flank, scale=lift, start=half, width=-half)
    rising_flank = Affine(flank, scale=lift, start=total - half, width=half)
    return joined([0.0, half, total - half, total], [falling, Constant(0.0), rising_flank])


def coefficients(powers: Sequence[int]) -> tuple[float, ...]:
    """C2, Cp, Cq, Cr and Cs of a lobe polynomial."""
    return Flank.of(powers)[1]
