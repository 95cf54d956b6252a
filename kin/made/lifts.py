"""Lifts that an indicator shows over the shaft angle, as points of the metal that it touches.

The probe runs on the follower's own guide. Its reading less what the exact cam would give it, and less a constant that
is set on the bench, is to first order what a deviation at the place of contact adds: e times the gain. Size and a
constant offset are so unseen.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple, Protocol

import numpy as np

from kin.contour.arcs import dot, left, unit
from kin.follower.follower import follower_of
from kin.law.contacts import Flat, Translating
from kin.law.piecewise import Piecewise
from kin.law.segment import Constant
from kin.made.metal import Metal
from kin.made.motion import RAISED
from kin.made.points import SurfacePoints, UnlikePointsError
from kin.numeric.angles import TURN
from kin.numeric.feet import equal_steps
from kin.numeric.records import replace

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kin.follower.base import Follower
    from kin.law.contacts import Side, Touch
    from kin.numeric.arrays import Array


COARSE_TURNS = 720  # angles at which the zero of the shaft angle is looked for
STEPS = 12
STILL = 1e-12  # rad
UNLIKE = 0.05  # of the stroke: readings that are off by more on average are of something else
ALIKE = 0.1  # of that, which a turn has to bring it down to


class Readings(NamedTuple):
    """Lifts (n,), mm or rad, at shaft angles (n,), rad.

    They are of a follower with one contact, on metal on a side of its contour; `touch` is that of the probe, None for
    the follower's own.
    """

    follower: Follower
    side: Side
    shaft: Array
    lift: Array
    touch: Touch | None = None

    @property
    def exact(self) -> Exact:
        """The probe's position on the exact cam over the shaft angle."""
        probe = probe_of(self.follower, self.side, self.touch)

        def position(angle: Array, raised: float = 0.0) -> tuple[Array, Array]:
            metal = Metal.of(
                self.follower, self.side, lambda t: np.stack([np.full_like(t, raised), np.zeros_like(t)]), gauge=probe
            )
            positions, places = metal.positions(angle)
            return positions[0], places[0]

        return position


class Exact(Protocol):
    """Position of a probe on the exact contour, or on one that is larger all round."""

    def __call__(self, angle: Array, raised: float = 0.0, /) -> tuple[Array, Array]:
        """Position, mm or rad, at shaft angles (n,), and the parameters where it touches, of metal `raised`, mm."""


class Lifts(NamedTuple):
    """Lifts as points, the turn that was taken out of their angles, rad, and the constant of their readings."""

    points: SurfacePoints
    turn: float
    zero: float


def probe_of(follower: Follower, side: Side, touch: Touch | None) -> Follower:
    """The follower with another touch on its guide; itself for None."""
    if touch is None:
        return follower
    (contact,) = follower.contacts
    still = Piecewise(np.array([0.0, TURN]), (Constant(0.0),), TURN)
    return follower_of([replace(contact.away_from(side), touch=touch)], still, side)


def points_of_lifts(readings: Readings, *, aligned: bool = False) -> Lifts:
    """Make points of lifts; `aligned` lets the zero of the shaft angle be found.

    Raises UnlikePointsError for readings that are far off, saying what they look like, and where the contact would
    leave the probe's face.
    """
    follower, side, shaft, lift, touch = readings
    exact = readings.exact
    turn = turn_of([readings]) if aligned else 0.0
    expected, places = exact(shaft + turn)
    zero = float((lift - expected).mean())
    off = lift - expected - zero
    _demand_alike(readings, off, aligned=aligned)
    gain = (exact(shaft + turn, RAISED)[0] - exact(shaft + turn, -RAISED)[0]) / (2.0 * RAISED)
    frame = follower.envelope.frames(places)
    if touch is not None:
        _demand_on_face(probe_of(follower, side, touch), frame.points, shaft + turn)
    metal = frame.points + (side * off / gain)[:, None] * frame.normals
    return Lifts(SurfacePoints(follower, side, metal), turn, zero)


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


def turn_of(readings: Sequence[Readings]) -> float:
    """Angle, rad, to add to the shaft angles of all readings, by least squares; the zero of each one's lift is free."""
    every = equal_steps(COARSE_TURNS)
    each = [(one.exact, one.shaft, one.lift) for one in readings]
    tables = [exact(every)[0] for exact, _, _ in each]

    def scatter(turn: float) -> float:
        return sum(
            len(lift) * float(np.var(lift - np.interp(np.mod(shaft + turn, TURN), every, table, period=TURN)))
            for table, (_, shaft, lift) in zip(tables, each, strict=True)
        )

    turn = min(every.tolist(), key=scatter)
    h = TURN / COARSE_TURNS / 8.0
    for _ in range(STEPS):
        square, product = 0.0, 0.0
        for exact, shaft, lift in each:
            low, here, high = (exact(shaft + turn + d)[0] for d in (-h, 0.0, h))
            slope = (high - low) / (2.0 * h)
            slope -= slope.mean()
            square, product = square + float(slope @ slope), product + float(slope @ (lift - here))
        step = product / square if square > 0.0 else 0.0
        turn += step
        if abs(step) < STILL:
            break
    return math.remainder(turn, TURN)


def _demand_alike(readings: Readings, off: Array, *, aligned: bool) -> None:
    exact, shaft, lift = readings.exact, readings.shaft, readings.lift
    stroke = float(np.ptp(exact(equal_steps(COARSE_TURNS))[0]))
    far = float(np.sqrt(np.mean(off**2)))
    if far <= UNLIKE * stroke:
        return
    told = f"the lifts are off by {far / stroke:.2g} of the stroke on average"
    looks: list[tuple[float, str]] = []
    for sense, words in ((1.0, []), (-1.0, ["run in the other sense"])):
        turn = turn_of([readings._replace(shaft=sense * shaft)])
        left = float(np.std(lift - exact(sense * shaft + turn)[0]))
        degrees = math.degrees(turn)
        turned = [f"turned by {degrees:.3g} degrees"] if abs(degrees) > 0.05 else []
        remedy = "let angles grow as the shaft turns in the motion" if sense < 0.0 else "`--align rotation`"
        looks.append((left, f"{', '.join([*words, *turned])}: {remedy}"))
    if min(looks)[0] <= ALIKE * far:
        raise UnlikePointsError(f"{told}: they look {min(looks)[1]}")
    high = float(np.ptp(lift)) / stroke
    if not 0.8 < high < 1.25:
        raise UnlikePointsError(
            f"{told}: their stroke is {high:.4g} times that of the cam: look at their unit, `--units`"
        )
    raise UnlikePointsError(
        f"{told}, however they are turned{' besides' * aligned}: they look like those of another cam"
    )
