"""The exact volume of a drum: the blank less what rollers sweep, by quadrature over the cylinders that flanks reach."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from kin.contour.nearest import signed_distance
from kin.cylindrical.intent import Groove, Rib
from kin.numeric.angles import TURN

if TYPE_CHECKING:
    from kin.cylindrical.intent import DrumIntent
    from kin.cylindrical.roller import Gauge

ANGLES = 1440  # of a turn
RADII = 16  # by Gauss' rule from the floor to the blank


def volume_within(drum: DrumIntent, gauges: tuple[Gauge, ...]) -> tuple[float, float]:
    """The exact volume of a drum, mm^3, and what half as many angles change of it.

    Where a groove crosses itself what it takes is not smooth, and its quadrature errs by the square of the step: by a
    third of that change. The change is left at 0 for a motion of one turn: of a surface that has kinks at most, such a
    quadrature errs by far less than a volume may be off. Neither is proved.
    """
    bore = 0.0 if drum.bore is None else drum.bore.contour.area
    floor, radius, length = drum.floor, drum.radius, drum.length
    if drum.follower.turns > 1:
        fine, coarse = _taken(drum, gauges)
        return (math.pi * radius**2 - bore) * length - fine, abs(fine - coarse)
    below = [_below(drum, gauge) for gauge in gauges]
    # what lies within the floor is as long as the blank; where flanks go down to the bore, there is nothing
    core = 0.0 if drum.track.depth is None else (math.pi * floor**2 - bore) * length
    area = math.pi * (radius**2 - floor**2) if core else math.pi * radius**2 - bore
    if isinstance(drum.track, Groove):
        return core + area * length - (below[1] - below[0]), 0.0
    if isinstance(drum.track, Rib):
        return core + below[0] - below[1], 0.0
    return core + (below[0] if drum.track.sides[0] < 0 else area * length - below[0]), 0.0


def _taken(drum: DrumIntent, gauges: tuple[Gauge, ...]) -> tuple[float, float]:
    """Volume, mm^3, between floor and blank that a groove takes in all its turns, and as half as many angles have it.

    What several turns take counts once.
    """
    floor, radius, turns = drum.floor, drum.radius, drum.follower.turns
    shares, weights = np.polynomial.legendre.leggauss(RADII)
    r = 0.5 * (floor + radius) + 0.5 * (radius - floor) * shares
    phi = np.arange(turns * ANGLES) * (TURN / ANGLES)
    angle, far = (row.ravel() for row in np.broadcast_arrays(phi[:, None], r))
    low, high = (np.clip(gauge.surface(angle, far).reshape(turns, ANGLES, RADII), 0.0, drum.length) for gauge in gauges)
    order = np.argsort(low, axis=0)
    low, high = (np.take_along_axis(rows, order, axis=0) for rows in (low, high))
    reached = np.maximum.accumulate(high, axis=0)
    before = np.concatenate([np.zeros_like(low[:1]), reached[:-1]])
    rows = np.maximum(high - np.maximum(low, before), 0.0).sum(axis=0) @ (weights * r)
    each = 0.5 * (radius - floor) * TURN
    return each * float(rows.mean()), each * float(rows[::2].mean())


def _below(drum: DrumIntent, gauge: Gauge) -> float:
    """Volume, mm^3, from z = 0 up to a flank, between floor and blank, without what the bore takes of it."""
    floor, radius = drum.floor, drum.radius
    shares, weights = np.polynomial.legendre.leggauss(RADII)
    r = 0.5 * (floor + radius) + 0.5 * (radius - floor) * shares
    phi = np.arange(ANGLES) * (TURN / ANGLES)
    angle, far = (row.ravel() for row in np.broadcast_arrays(phi[:, None], r))
    height = gauge.surface(angle, far).reshape(ANGLES, RADII)
    volume = float((height @ (weights * r)).sum()) * 0.5 * (radius - floor) * (TURN / ANGLES)
    if drum.bore is None or drum.track.depth is not None:
        return volume
    # a keyway reaches beyond the nearest point of the bore: its area, times the mean height over it
    keyed = drum.bore.contour.area - math.pi * floor**2
    flat = np.stack([far * np.cos(angle), far * np.sin(angle)], axis=-1)
    own = signed_distance(drum.bore.contour.as_arcs()[0], flat) < 0.0
    return volume - keyed * float(height.ravel()[own].mean()) if own.any() else volume
