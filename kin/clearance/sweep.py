"""How far a moving flat body reaches over one turn of the shaft: a box, and a radius about a point; proved bounds.

The greatest reach f over the turn is found by halving intervals of the shaft angle: over half a width h it exceeds that
at the middle by no more than h times the greatest speed of any point of the body. It is as close as asked, but where
that takes more than 200,000 intervals: then it is too large by more.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from kin.clearance.distance import Relative, fastest
from kin.clearance.pose import Still
from kin.contour.arcs import turned
from kin.contour.contour import Box
from kin.contour.region import farthest

if TYPE_CHECKING:
    from collections.abc import Callable

    from kin.clearance.clearance import Mover
    from kin.contour.region import Region
    from kin.numeric.arrays import Array

__all__ = ["swept_box", "swept_radius"]

CELLS = 64
MOST = 200_000  # intervals left at once, beyond which the bound is as close as it has come


def swept_box(mover: Mover, accuracy: float = 0.05) -> Box:
    """Box of all places that the body takes over a turn; it is no more than `accuracy` mm too large on any side."""
    sides = []
    for direction in np.arange(4) * (0.5 * math.pi):

        def reach(phi: Array, direction: float = float(direction)) -> Array:
            pose = mover.motion.over(phi, 0.0 * phi).pose
            along = pose[:, 0] * np.cos(direction) + pose[:, 1] * np.sin(direction)
            own = [slab.outer.support(direction - pose[:, 2]).q for slab in mover.slabs]
            found: Array = along + np.max(own, axis=0)
            return found

        sides.append(_greatest(mover, reach, accuracy))
    right, top, left, bottom = sides
    return Box(-left, -bottom, right, top)


def swept_radius(mover: Mover, about: tuple[float, float] = (0.0, 0.0), accuracy: float = 0.05) -> float:
    """Radius of the disc about a point that holds the body all over a turn; at most `accuracy` mm too large."""

    def reach(phi: Array) -> Array:
        pose = mover.motion.over(phi, 0.0 * phi).pose
        seen = turned(np.array(about) - pose[:, :2], -pose[:, 2])
        own = [_from(slab.region, seen) for slab in mover.slabs]
        found: Array = np.max(own, axis=0)
        return found

    return _greatest(mover, reach, accuracy)


def _from(region: Region, points: Array) -> Array:
    """Greatest distance of the region from each of the points (m, 2)."""
    chain = region.chain
    every = chain.take(np.tile(np.arange(len(chain)), len(points)))
    apart = farthest(every, np.repeat(points, len(chain), axis=0))
    greatest: Array = apart.reshape(len(points), -1).max(axis=1)
    return greatest


def _greatest(mover: Mover, reach: Callable[[Array], Array], accuracy: float) -> float:
    """Upper bound of a reach of the body over the turn, mm, by no more than the accuracy too large."""
    half = math.pi / CELLS
    phi: Array = np.linspace(half, 2.0 * math.pi - half, CELLS)
    found, bound = -math.inf, -math.inf
    while len(phi):
        width = np.full(len(phi), half)
        value = reach(phi)
        found = max(found, float(value.max()))
        upper = value + half * _speed(mover, phi, width)
        open_ = upper > found + accuracy
        bound = max(bound, float(upper[~open_].max(initial=-math.inf)))
        if np.count_nonzero(open_) > MOST:
            return max(bound, float(upper.max()))
        half *= 0.5
        phi = np.concatenate([phi[open_] - half, phi[open_] + half])
    return bound


def _speed(mover: Mover, phi: Array, half: Array) -> Array:
    ground, course = Still().over(phi, half), mover.motion.over(phi, half)
    motion = Relative.of(ground, course, half)
    speed: Array = np.max([fastest(slab.region, motion) for slab in mover.slabs], axis=0)
    return speed
