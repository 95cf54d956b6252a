"""The lobe of valve trains: a polynomial 2-p-q-r-s, or a mixture of such, on either side of its nose, and ramps."""

from __future__ import annotations

import math
from itertools import pairwise
from operator import itemgetter
from typing import TYPE_CHECKING, NamedTuple

from kin.law.normalised import IntentError
from kin.law.segment import AffineStretch, Constant, Power
from kin.law.sources.functions import Flank, FromRest, RampedFlank
from kin.law.sources.motion import Motion, joined

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kin.law.segment import Stretch

FROM_REST = 0.4  # of a ramp's height: the part over which it reaches its velocity
LEAST_RAMP = math.radians(1e-4)  # rad: a shorter ramp is as good as a jump of velocity
_NOTHING = 1e-12  # rad: a shorter part is rounding
GREATEST_POWER = 100


class Ramp(NamedTuple):
    """A lash ramp: its height, mm or rad, and its constant velocity, by rad of the cam.

    It leaves rest by 2 u**3 - u**4 over the first two fifths of its height, and climbs the others at that velocity.
    """

    height: float
    velocity: float

    @property
    def parts(self) -> tuple[float, float]:
        """Angles, rad, of the part from rest, at half the velocity on average, and of the part at constant velocity."""
        return 2.0 * FROM_REST * self.height / self.velocity, (1.0 - FROM_REST) * self.height / self.velocity

    @property
    def over(self) -> float:
        """Angle of the whole ramp, rad."""
        return sum(self.parts)


class LobeSide(NamedTuple):
    """One side of a lobe, from its foot, or from its ramp's end, to the nose over `half` rad.

    Without a ramp `flank` rises to 1 and is multiplied by `scale`, mm or rad. With a ramp the flank is the lobe's
    height above the ramp's straight line, mm or rad, and `scale` is 1.
    """

    half: float
    flank: Flank
    scale: float = 1.0
    ramp: Ramp | None = None

    @staticmethod
    def of(lift: float, half: float, powers: Sequence[int], ramp: Ramp | None) -> LobeSide:
        """Make the side of a lobe from its five powers over `half`, rad, without checks; `lift` in mm or rad."""
        if ramp is None:
            return LobeSide(half, Flank.of(powers)[0], lift)
        return LobeSide(half, Flank.of(powers, lift, ramp.height, ramp.velocity * half)[0], 1.0, ramp)

    @property
    def reach(self) -> float:
        """Angle from rest to the nose, rad."""
        return self.half + (0.0 if self.ramp is None else self.ramp.over)


def lobe(
    lift: float,
    half: float,
    powers: Sequence[float],
    total: float = 2 * math.pi,
    *,
    nose: float = 0.0,
    ramp: Ramp | None = None,
    around: int | None = 1,
    field: str = "motion.lobe",
) -> Motion:
    """Make S = lift (1 + C2 u**2 + Cp u**p + ... + Cs u**s), u = |theta - nose|/half, rest beyond `half` rad.

    `powers` are (2, p, q, r, s), rising whole numbers; the coefficients make S to S'''' vanish at u = 1 (R. L.
    Norton, Cam Design and Manufacturing Handbook, chapter on valve trains). With a ramp the lobe meets it at its height
    with its velocity, S'' to S'''' vanish there, and the ramp lies beyond `half`. The motion covers `total`, rad, with
    the nose at `nose`, rad; where it does not repeat (`around` is not 1) the nose stands in the middle. Raises
    IntentError for a lift, angle, powers or ramp that give no lobe, and for a `nose` of a motion that does not repeat.
    """
    side = side_of(lift, half, powers, ramp, total=total, field=field)
    return lobe_of(side, side, total, nose=nose, around=around, field=field)


def side_of(
    lift: float, half: float, powers: Sequence[float], ramp: Ramp | None, *, total: float, field: str
) -> LobeSide:
    """Make the side of a lobe from its powers, over `half`, rad, of a motion over `total`, rad; `lift` in mm or rad.

    Raises IntentError, at a field below `field`, for a lift not above 0, `half` outside 0 to total/2, powers that are
    not 2 and four more whole ones that rise to 100 at most, and a ramp that is impossible or too long.
    """
    demand_lift(lift, field)
    if not (math.isfinite(half) and 0 < half < total / 2):
        raise IntentError(
            f"half the event lies between 0 and {math.degrees(total / 2):.6g} degrees, not {math.degrees(half):.6g}",
            f"{field}.half",
        )
    rising = all(int(k) == k for k in powers) and all(a < b for a, b in pairwise(powers))
    if len(powers) != 5 or powers[0] != 2 or not rising or powers[-1] > GREATEST_POWER:
        shown = ", ".join(f"{k:g}" for k in powers)
        raise IntentError(
            f"the powers of a lobe are 2 and four more whole numbers that rise to {GREATEST_POWER} at most, "
            f"such as [2, 8, 14, 20, 26], not [{shown}]",
            f"{field}.powers",
        )
    if ramp is not None:
        demand_ramp(lift, ramp, field)
        _demand_left(half, ramp, total, field)
    return LobeSide.of(lift, half, [int(k) for k in powers], ramp)


def lobe_of(
    opening: LobeSide,
    closing: LobeSide,
    total: float = 2 * math.pi,
    *,
    nose: float = 0.0,
    around: int | None = 1,
    field: str = "motion.lobe",
) -> Motion:
    """Join the two sides of a lobe at its nose, with rest beyond them, into a motion over `total`, rad.

    The nose stands at `nose`, rad; in the middle where the motion does not repeat (`around` is not 1). Raises
    IntentError for a `nose` of a motion that does not repeat.
    """
    if around != 1 and nose != 0.0:
        raise IntentError("the nose stands in the middle where the motion does not repeat each turn", f"{field}.nose")
    falling = [part.mirrored() for part in reversed(_rising(closing))]
    stretches = [*_rising(opening), *falling]
    middle = nose if around == 1 else total / 2
    before, after = opening.reach, closing.reach
    if around != 1 or (middle > before and middle + after < total):
        knots = [0.0, *(middle + part.begin for part in stretches), middle + after, total]
        return joined(knots, [Constant(0.0), *(part.moved(middle) for part in stretches), Constant(0.0)], around)
    # parts before or behind the turn are moved by a turn; a part that its end cuts stands at both ends
    pieces: list[tuple[float, float, Stretch]] = []
    for turns in (-1.0, 0.0, 1.0):
        shift = middle + turns * total
        standing = _Stretch(after, total - before, Constant(0.0))
        for part in (*stretches, standing):
            low, high = max(part.begin + shift, 0.0), min(part.end + shift, total)
            if high - low > _NOTHING:
                pieces.append((low, high, part.moved(shift)))
    pieces.sort(key=itemgetter(0))
    return joined([*(low for low, _, _ in pieces), total], [function for _, _, function in pieces])


class _Stretch(NamedTuple):
    """A part of a lobe about a nose at 0, over [begin, end], rad: scale times a function of the angle over `width`.

    A negative width runs the function backwards, from the end.
    """

    begin: float
    end: float
    function: Stretch
    scale: float = 1.0
    width: float = 0.0

    def moved(self, by: float) -> Stretch:
        """The function of the angle, with the nose at `by`, rad."""
        if isinstance(self.function, Constant):
            return self.function
        start = self.begin if self.width > 0.0 else self.end
        return AffineStretch(self.function, scale=self.scale, start=start + by, width=self.width)

    def mirrored(self) -> _Stretch:
        """The part on the other side of the nose."""
        return self._replace(begin=-self.end, end=-self.begin, width=-self.width)


def _rising(side: LobeSide) -> list[_Stretch]:
    """The parts of a side from rest to the nose, which stands at 0."""
    half, ramp = side.half, side.ramp
    if ramp is None:
        return [_Stretch(-half, 0.0, side.flank, side.scale, half)]
    first, second = ramp.parts
    begin, reached = -half - second, FROM_REST * ramp.height
    steady = Power((reached, ramp.height - reached))
    return [
        _Stretch(begin - first, begin, FromRest(), reached, first),
        _Stretch(begin, -half, steady, 1.0, second),
        _Stretch(-half, 0.0, RampedFlank(ramp.height, ramp.velocity * half, side.flank), 1.0, half),
    ]


def demand_lift(lift: float, field: str) -> None:
    """Raise IntentError for a lift that is not above 0 and finite."""
    if not (math.isfinite(lift) and lift > 0):
        raise IntentError(f"the lift of a lobe must be above 0, not {lift:.6g}", f"{field}.lift")


def demand_ramp(lift: float, ramp: Ramp, field: str) -> None:
    """Raise IntentError for a ramp without height or velocity, as high as the lobe, or too short."""
    if not (math.isfinite(ramp.height) and 0 < ramp.height < lift):
        raise IntentError("the ramp's height must lie between 0 and the lift", f"{field}.ramp.height")
    if not (math.isfinite(ramp.velocity) and ramp.velocity > 0):
        raise IntentError("the ramp's velocity must be above 0", f"{field}.ramp.velocity")
    if not ramp.over >= LEAST_RAMP:
        over, least = math.degrees(ramp.over), math.degrees(LEAST_RAMP)
        why = f"at its velocity so low a ramp lasts {over:.3g} degrees: give one of {least:g} or more, or none"
        raise IntentError(why, f"{field}.ramp.height")


def _demand_left(half: float, ramp: Ramp, total: float, field: str) -> None:
    """Raise IntentError for a ramp longer than the rest of the half turn beyond `half`."""
    left = total / 2 - half
    if not ramp.over < left:
        least = math.radians(ramp.over / left * ramp.velocity)
        raise IntentError(
            f"the ramp takes {math.degrees(ramp.over):.6g} degrees, {math.degrees(left):.6g} are left beyond `half`; "
            f"{least:.6g} a degree is too slow",
            f"{field}.ramp.velocity",
        )


def coefficients(powers: Sequence[int]) -> tuple[float, ...]:
    """Coefficients C2, Cp, Cq, Cr and Cs of the lobe polynomial of five powers, without a ramp."""
    return Flank.of(powers)[1]
