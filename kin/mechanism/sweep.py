"""How far a moving flat body reaches over one turn of the shaft: a box, with a proved bound.

The greatest reach over the turn is found by halving intervals of the shaft angle: within half a width h it exceeds the
reach at the middle by no more than h times the greatest speed of any point of the body. The bound is within the
accuracy, except where that takes more than 200,000 intervals at once: then it is too large by more.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from kin.contour.contour import Box
from kin.mechanism.distance import Relative, fastest
from kin.mechanism.pose import Still

if TYPE_CHECKING:
    from collections.abc import Callable

    from kin.mechanism.clearance import Mover
    from kin.numeric.arrays import Array

CELLS = 64  # intervals of a turn to begin with
MOST = 200_000  # intervals left at once, beyond which the search ends


def swept_box(mover: Mover, accuracy: float = 0.05) -> Box:
    """Box of all places that the body takes over a turn of its stated motion, without the motion's slack.

    It is too large by no more than `accuracy`, mm, on any side, unless that leaves over 200,000 intervals at once.
    """
    sides = []
    for direction in np.arange(4) * (0.5 * math.pi):

        def reach(phi: Array, direction: float = float(direction)) -> Array:
            pose = mover.motion.over(phi, 0.0 * phi).pose
            along = pose[:, 0] * np.cos(direction) + pose[:, 1] * np.sin(direction)
            own = [slab.outer.support(direction - pose[:, 2]).q for slab in mover.slabs]
            farthest: Array = along + np.max(own, axis=0)
            return farthest

        sides.append(_greatest(mover, reach, accuracy))
    right, top, left, bottom = sides
    return Box(-left, -bottom, right, top)


def _greatest(mover: Mover, reach: Callable[[Array], Array], accuracy: float) -> float:
    """Upper bound, mm, of a reach (m,) of the body at angles phi (m,), over the turn: at most `accuracy` too large."""
    half = math.pi / CELLS
    phi: Array = np.linspace(half, 2.0 * math.pi - half, CELLS)
    greatest, bound = -math.inf, -math.inf
    while len(phi):
        width = np.full(len(phi), half)
        value = reach(phi)
        greatest = max(greatest, float(value.max()))
        upper = value + half * _speed(mover, phi, width)
        open_ = upper > greatest + accuracy
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
