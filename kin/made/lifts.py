"""Lifts that an indicator shows over the shaft angle, as points of the metal that it touches.

The probe runs on the follower's own guide. Its reading less what the exact cam would give it, and less a constant that
is set on the bench, is to first order what a deviation at the place of contact adds: e times the gain. Size and a
constant offset are so unseen.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

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
    from collections.abc import Callable

    from kin.follower.base import Follower
    from kin.law.contacts import Side, Touch
    from kin.numeric.arrays import Array

    Exact = Callable[[Array], tuple[Array, Array]]  # shaft angles: what the exact cam gives the probe, and where

COARSE_TURNS = 720  # angles at which the zero of the shaft angle is looked for
STEPS = 12
STILL = 1e-12  # rad
UNLIKE = 0.05  # of the stroke: readings that are off by more on average are of something else
ALIKE = 0.1  # of that, which a turn has to bring it down to


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


def points_of_lifts(
    follower: Follower, side: Side, shaft: Array, lift: Array, touch: Touch | None = None, *, aligned: bool = False
) -> Lifts:
    """Make points of lifts (n,), mm or rad, at shaft angles (n,), rad, of a follower with one contact.

    `touch` is that of the probe, None for the follower's own. `aligned` lets the zero of the shaft angle be
    found. Raises UnlikePointsError for readings that are far off, saying what they look like, and where the contact
    would leave the probe's face.
    """
    probe = probe_of(follower, side, touch)

    def exact(angle: Array, raised: float = 0.0) -> tuple[Array, Array]:
        metal = Metal.of(follower, side, lambda t: np.stack([np.full_like(t, raised), np.zeros_like(t)]), gauge=probe)
        positions, places = metal.positions(angle)
        return positions[0], places[0]

    turn = _turn(exact, shaft, lift) if aligned else 0.0
    meant, places = exact(shaft + turn)
    zero = float((lift - meant).mean())
    off = lift - meant - zero
    _demand_alike(exact, shaft, lift, off, aligned=aligned)
    gain = (exact(shaft + turn, RAISED)[0] - exact(shaft + turn, -RAISED)[0]) / (2.0 * RAISED)
    frame = follower.envelope.frames(places)
    if touch is not None:
        _demand_on_face(probe, frame.points, shaft + turn)
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


def _turn(exact: Exact, shaft: Array, lift: Array) -> float:
    """What the shaft angles lack, rad, by least squares over the turn and the zero of the readings."""
    every = equal_steps(COARSE_TURNS)
    table = exact(every)[0]

    def scatter(turn: float) -> float:
        return float(np.var(lift - np.interp(np.mod(shaft + turn, TURN), every, table, period=TURN)))

    turn = min(every.tolist(), key=scatter)
    h = TURN / COARSE_TURNS / 8.0
    for _ in range(STEPS):
        low, here, high = (exact(shaft + turn + d)[0] for d in (-h, 0.0, h))
        columns = np.column_stack([(high - low) / (2.0 * h), np.ones_like(shaft)])
        step = float(np.linalg.lstsq(columns, lift - here, rcond=None)[0][0])
        turn += step
        if abs(step) < STILL:
            break
    return math.remainder(turn, TURN)


def _demand_alike(exact: Exact, shaft: Array, lift: Array, off: Array, *, aligned: bool) -> None:
    stroke = float(np.ptp(exact(equal_steps(COARSE_TURNS))[0]))
    far = float(np.sqrt(np.mean(off**2)))
    if far <= UNLIKE * stroke:
        return
    told = f"the lifts are off by {far / stroke:.2g} of the stroke on average"
    looks: list[tuple[float, str]] = []
    for sense, words in ((1.0, []), (-1.0, ["run in the other sense"])):
        turn = _turn(exact, sense * shaft, lift)
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
