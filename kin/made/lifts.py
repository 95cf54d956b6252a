"""Lifts that an indicator shows over the shaft angle, as points of the metal that it touches.

The probe runs on the follower's own guide. Its reading less its position on the exact cam, and less a constant that is
set on the bench, is to first order the effect of the deviation e at the place of contact: e times the gain. So lifts
show neither the size nor a constant offset.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple, Protocol

import numpy as np

from kin.contour.arcs import dot, left, turned, unit
from kin.follower.follower import follower_of
from kin.law.contacts import Flat, Translating
from kin.law.piecewise import Piecewise
from kin.law.segment import Constant
from kin.made.metal import Metal
from kin.made.motion import RAISED
from kin.made.points import FACTORS, MIRRORED, UNLIKE, SurfacePoints, UnlikePointsError
from kin.made.shaft_alike import LOOKS, NEAR, SMALL, row
from kin.made.smooth import strays
from kin.numeric.angles import TURN
from kin.numeric.feet import equal_steps
from kin.numeric.records import replace
from kin.read.points import CRANK

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from kin.follower.base import Follower
    from kin.law.contacts import Side, Touch
    from kin.numeric.arrays import Array


COARSE_TURNS = 720  # angles at which the zero of the shaft angle is looked for
GAINS = 7200  # angles between which gains are interpolated
FEW = 2000  # readings that suffice for that
STEPS = 12  # of Gauss and Newton
STILL = 1e-12  # rad: the search ends at a smaller step
BETWEEN = 0.75  # of a turn: angles over less may be halved by mistake, over more than a turn by as much the crank's
ODD = 0.1  # of UNLIKE: from which on readings may run in the other sense, or at degrees of another shaft
ALIKE = 0.1  # share of their distance that may be left after a turn that explains it


class Readings(NamedTuple):
    """Lifts (n,), mm or rad, at shaft angles (n,), rad.

    The follower has one contact; `side` is 1 for metal inside its contour, -1 outside. `touch` is that of the probe,
    None for the follower's own. `halved` says that the angles were crank degrees by their heading, and are halved.
    """

    follower: Follower
    side: Side
    shaft: Array
    lift: Array
    touch: Touch | None = None
    halved: bool = False

    @property
    def exact(self) -> Exact:
        """Function that gives the probe's position, mm or rad, and the parameter touched, (n,) each, on the exact cam.

        It takes shaft angles (n,), rad, and a height, mm, by which the metal is raised all round.
        """
        probe = probe_of(self.follower, self.side, self.touch)

        def position(angle: Array, raised: float = 0.0) -> tuple[Array, Array]:
            metal = Metal.of(
                self.follower, self.side, lambda t: np.stack([np.full_like(t, raised), np.zeros_like(t)]), gauge=probe
            )
            positions, places = metal.positions(angle)
            return positions[0], places[0]

        return position

    @property
    def stroke(self) -> float:
        """Range of the probe's position over a turn of the exact cam, mm or rad."""
        return float(np.ptp(self.exact(equal_steps(COARSE_TURNS))[0]))

    def few(self) -> Readings:
        """At most FEW of the readings, evenly chosen."""
        chosen = np.linspace(0, len(self.lift) - 1, min(FEW, len(self.lift))).astype(np.intp)
        return self._replace(shaft=self.shaft[chosen], lift=self.lift[chosen])

    def on_metal(self, late: float) -> Readings:
        """The readings without strays, which stand far off those beside them, where all are `late` by an angle, rad."""
        stray = strays(self.shaft, self.off(late), UNLIKE * self.stroke)
        return self._replace(shaft=self.shaft[~stray], lift=self.lift[~stray]) if stray.any() else self

    def off(self, late: float = 0.0) -> Array:
        """Readings (n,) less the lifts of the exact cam `late` by an angle, rad, and less their mean; mm or rad."""
        off = self.lift - self.exact(self.shaft - late)[0]
        centred: Array = off - off.mean()
        return centred


class Exact(Protocol):
    """Position of a probe on the exact contour, or on one that is larger all round."""

    def __call__(self, angle: Array, raised: float = 0.0, /) -> tuple[Array, Array]:
        """Position, mm or rad, at shaft angles (n,), and the parameters where it touches, of metal `raised`, mm."""


class Lifts(NamedTuple):
    """Lifts as points of the metal.

    `points` stand as measured, or with the lateness taken out. `late` is the lateness, rad, and `zero` the constant in
    the lifts, mm or rad.
    """

    points: SurfacePoints
    late: float
    zero: float


def probe_of(follower: Follower, side: Side, touch: Touch | None) -> Follower:
    """Follower with another touch on its guide, still, on metal inside (1) or outside (-1); itself for None."""
    if touch is None:
        return follower
    (contact,) = follower.contacts
    still = Piecewise(np.array([0.0, TURN]), (Constant(0.0),), TURN)
    return follower_of([replace(contact.away_from(side), touch=touch)], still, side)


def points_of_lifts(readings: Readings, *, aligned: bool = False, alone: bool = False) -> Lifts:
    """Turn lifts into points of the surface as they stand, or `aligned`, with their lateness taken out.

    Lateness is the angle by which the lifts follow the exact cam. A constant in them is always taken out, as their zero
    is arbitrary. Raises UnlikePointsError where the contact would leave the probe's face, and for readings that are far
    off; its message says what they look like. `alone` says that the cam may be turned on its shaft by any angle.
    """
    follower, side, shaft, lift, touch, _ = readings
    # without `aligned` it is put back, so that an approximation is enough
    on_metal = readings.on_metal(lateness([readings.few()]))
    late = lateness([on_metal if aligned else on_metal.few()])
    _demand_alike(on_metal, late if aligned or alone else 0.0, aligned=aligned)
    # deviation of the metal: what the lifts are off, over the gain (probe's position by mm of metal)
    exact = readings.exact
    expected, places = exact(shaft - late)
    zero = float((on_metal.lift - exact(on_metal.shaft - late)[0]).mean())
    every = equal_steps(GAINS)
    gains = (exact(every, RAISED)[0] - exact(every, -RAISED)[0]) / (2.0 * RAISED)
    gain = np.interp(np.mod(shaft - late, TURN), every, gains, period=TURN)
    frame = follower.envelope.frames(places)
    if touch is not None:
        _demand_on_face(probe_of(follower, side, touch), frame.points, shaft - late)
    metal = frame.points + (side * (lift - expected - zero) / gain)[:, None] * frame.normals
    if not aligned:
        metal = turned(metal, np.array(late))
    return Lifts(SurfacePoints(follower, side, metal), late, zero)


def _demand_on_face(probe: Follower, points: Array, shaft: Array) -> None:
    """Raise UnlikePointsError where points (n, 2) touched at shaft angles (n,) lie beyond a probe's face."""
    (contact,) = probe.contacts
    if not isinstance(contact.touch, Flat) or contact.touch.width is None or not isinstance(contact.guide, Translating):
        return
    across = dot(points, left(unit(shaft + contact.turned))) - contact.guide.offset
    farthest = float(np.abs(across).max())
    if farthest > 0.5 * contact.touch.width:
        raise UnlikePointsError(
            f"the contact would leave the probe's face, {contact.touch.width:.6g} mm wide: it goes {farthest:.4g} mm "
            f"from its middle; the face has to be {2.0 * farthest:.4g} mm wide"
        )


def lateness(readings: Sequence[Readings]) -> float:
    """Angle, rad, from -pi to pi, by which all readings are late, by least squares; each zero of lifts is free."""
    every = equal_steps(COARSE_TURNS)
    few = [cam.few() for cam in readings]
    tables = [cam.exact(every)[0] for cam in few]
    variances = [max(float(np.var(table)), np.finfo(float).tiny) for table in tables]

    turned_back = (np.mod(cam.shaft - every[:, None], TURN) for cam in few)
    scatter = sum(
        np.var(cam.lift - np.interp(shaft, every, table, period=TURN), axis=1) / variance
        for cam, shaft, table, variance in zip(few, turned_back, tables, variances, strict=True)
    )
    late = float(every[np.argmin(scatter)])
    slopes = [(np.roll(table, -1) - np.roll(table, 1)) * (0.5 * COARSE_TURNS / TURN) for table in tables]
    for some in (few, readings):
        late = _least_squares_lateness(some, late, variances, slopes)
    return math.remainder(late, TURN)


def _least_squares_lateness(
    readings: Sequence[Readings], late: float, variances: Sequence[float], slopes: Sequence[Array]
) -> float:
    """Lateness, rad, of least squares near `late`, by Gauss and Newton; residuals count in shares of a cam's variance.

    `slopes` are derivatives of the exact lifts at equal steps, near enough for the steps of the search.
    """
    every = equal_steps(COARSE_TURNS)
    for _ in range(STEPS):
        square, product = 0.0, 0.0
        for cam, variance, table in zip(readings, variances, slopes, strict=True):
            slope = np.interp(np.mod(cam.shaft - late, TURN), every, table, period=TURN)
            slope -= slope.mean()
            square += float(slope @ slope) / variance
            product -= float(slope @ (cam.lift - cam.exact(cam.shaft - late)[0])) / variance
        step = product / square if square > 0.0 else 0.0
        late += step
        if abs(step) < STILL:
            break
    return late


def rows_of_lifts(readings: Sequence[Readings], zeros: Sequence[float]) -> tuple[Array, Array]:
    """Lifts of several cams over the shaft's angle, each less its mean: as read, and exact; (m, LOOKS), mm or rad.

    Readings are at angles from the `zeros`, rad, at which each one's motion begins.
    """
    every = equal_steps(LOOKS)
    rows = [row(cam.shaft + zero, cam.lift) for cam, zero in zip(readings, zeros, strict=True)]
    exact = [cam.exact(every - zero)[0] for cam, zero in zip(readings, zeros, strict=True)]
    measured, nominal = np.stack(rows), np.stack(exact)
    return measured - measured.mean(axis=1, keepdims=True), nominal - nominal.mean(axis=1, keepdims=True)


def of_other_shaft(readings: Sequence[Readings]) -> _Factor | None:
    """Mistake of crank angles for cam angles, or of cam angles for crank angles, if only so readings fit; else None."""
    few = [cam.few() for cam in readings]
    longest = max(few, key=lambda cam: float(np.ptp(cam.shaft)))
    for other in _factors(longest):
        if other.factor in {CRANK, 1.0 / CRANK} and _fit(few, other.factor) and not _fit(few, 1.0):
            return other
    return None


def _fit(readings: Sequence[Readings], factor: float) -> bool:
    """Whether readings fit their cams when the angles are multiplied by a factor and each is turned by its lateness."""
    scaled = [cam._replace(shaft=factor * cam.shaft) for cam in readings]
    return all(float(np.std(cam.off(lateness([cam])))) <= UNLIKE * cam.stroke for cam in scaled)


def _demand_alike(readings: Readings, late: float, *, aligned: bool) -> None:
    """Raise UnlikePointsError for readings that are far off the exact cam turned `late` by an angle, rad."""
    few, stroke = readings.few(), readings.stroke
    far = float(np.std(few.off(late)))
    if far <= ODD * UNLIKE * stroke:
        return
    problem = f"the lifts are off by {far / stroke:.2g} of the stroke on average"
    looks = [look for other in _factors(few) for look in _turned_looks(few, other, aligned=aligned)]
    best = min(looks)
    if best.left <= ALIKE * far and (far > UNLIKE * stroke or not best.turned_alone):
        raise UnlikePointsError(f"{problem}: they look {best.words}")
    if far <= UNLIKE * stroke:
        return
    high = float(np.ptp(few.lift)) / stroke
    if few.follower.unit == "deg" and NEAR > math.degrees(high) > 1.0 / NEAR:
        raise UnlikePointsError(f"{problem}: they look like radians read as degrees: head their column lift_rad")
    factor = next((value for value in FACTORS if 1.0 / NEAR < value * high < NEAR), None)
    if factor is not None and few.follower.unit == "mm":
        large, word = max(factor, 1.0 / factor), "small" if factor > 1.0 else "large"
        raise UnlikePointsError(f"{problem}: they look {large:.6g} times too {word}: `--units {FACTORS[factor]}`")
    if not 0.8 < high < 1.25:
        raise UnlikePointsError(
            f"{problem}: their stroke is {high:.4g} times that of the cam: look at their unit, `--units`"
        )
    raise UnlikePointsError(
        f"{problem}, however they are turned{' besides' * aligned}: they look like those of another cam"
    )


class _Factor(NamedTuple):
    """A mistake in angles or lifts: the factors that undo it, words for how the readings look, and remedies."""

    factor: float
    words: list[str]
    remedies: list[str]
    lift: float = 1.0


class _Look(NamedTuple):
    """An explanation of readings: how far off they are by it, mm or rad, its words, and whether it is a turn alone."""

    left: float
    words: str
    turned_alone: bool


def _factors(readings: Readings) -> list[_Factor]:
    """Mistakes that angles and lifts may hold: first no mistake, last angles of another shaft."""
    span = float(np.ptp(readings.shaft))
    factors = [_Factor(1.0, [], []), _Factor(1.0, ["to fall as the follower rises"], ["turn their sign round"], -1.0)]
    if abs(math.degrees(span) / TURN - 1.0) < 1.0 - BETWEEN:
        factors.append(_Factor(math.degrees(1.0), ["to have angles in radians"], ["head their column angle_rad"]))
    if readings.halved and span < BETWEEN * TURN:
        factors.append(_Factor(CRANK, ["to be at the camshaft's own angles"], ["head their column cam_deg"]))
    elif not readings.halved and span > TURN / BETWEEN:
        factors.append(_Factor(1.0 / CRANK, ["to be at crank degrees"], ["head their column crank_deg"]))
    return factors


def _turned_looks(readings: Readings, other: _Factor, *, aligned: bool) -> Iterator[_Look]:
    """Explanations by a mistake with a turn, for angles in the sense of the motion and in the other sense."""
    for sense in (1.0, -1.0):
        other_readings = readings._replace(shaft=sense * other.factor * readings.shaft, lift=other.lift * readings.lift)
        late = lateness([other_readings])
        words, remedies = [*other.words], [*other.remedies]
        if sense < 0.0:
            words.append("run in the other sense")
            remedies.append("let angles grow as the shaft turns in the motion")
        if abs(late) > SMALL:
            words.append(f"turned by {math.degrees(late):.3g} degrees")
            remedies += [] if aligned else ["`--align rotation`"]
        left = float(np.std(other_readings.off(late))) * (MIRRORED if min(sense, other.lift) < 0.0 else 1.0)
        alone = sense > 0.0 and not other.words
        yield _Look(left, f"{', '.join(words)}: {', then '.join(remedies)}", turned_alone=alone)
