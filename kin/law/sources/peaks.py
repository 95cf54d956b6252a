"""Greatest and least values of the derivatives of piecewise functions, to the last places."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from kin.numeric.elementary import Jet
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from kin.law.piecewise import Piecewise
    from kin.law.segment import Stretch
    from kin.numeric.arrays import Array


_GRID = 129  # places on a stretch at which a derivative is looked at first
_STEPS = 6  # of Newton's method from there: the error of a grid is squared six times
_REST = 1e-9  # of the greatest value: a smaller step is rounding


@dataclass(frozen=True)
class Peaks:
    """Largest absolute velocity, acceleration and jerk of a law, for unit stroke over unit interval from rest to rest.

    `acceleration` is infinite where the velocity steps, `jerk` where velocity or acceleration does, at the ends too.
    """

    velocity: float
    acceleration: float
    jerk: float


def extremes(motion: Piecewise, k: int) -> tuple[float, float, float, float]:
    """Least value of derivative k and its place, greatest value and its place.

    Local extremes of a grid on each stretch are followed to the zeros of the next derivative; limits at knots count.
    Raises DomainError where a function of the motion does not exist.
    """
    least, greatest = (math.inf, 0.0), (-math.inf, 0.0)
    for function, (begin, end) in zip(motion.functions, pairwise(motion.knots.tolist()), strict=True):
        at, value = _candidates(function, begin, end, k)
        low, high = int(np.argmin(value)), int(np.argmax(value))
        least = min(least, (float(value[low]), float(at[low])))
        if value[high] > greatest[0]:
            greatest = (float(value[high]), float(at[high]))
    return *least, *greatest


def _candidates(function: Stretch, begin: float, end: float, k: int) -> tuple[Array, Array]:
    grid = np.linspace(begin, end, _GRID)
    grid[-1] = end
    value = function(Jet.variable(grid, k)).derivatives()[k]
    middle = value[1:-1]
    top = (middle >= value[:-2]) & (middle >= value[2:])
    bottom = (middle <= value[:-2]) & (middle <= value[2:])
    near = np.flatnonzero(top ^ bottom) + 1  # both at once: constant
    if not len(near):
        return grid, value
    low, high, x = grid[near - 1], grid[near + 1], grid[near]
    for _ in range(_STEPS):
        slope, bend = function(Jet.variable(x, k + 2)).derivatives()[k + 1 :]
        step = np.divide(slope, bend, out=np.zeros_like(slope), where=bend != 0)
        x = np.minimum(np.maximum(x - step, low), high)
    followed = function(Jet.variable(x, k)).derivatives()[k]
    return np.concatenate((grid, x)), np.concatenate((value, followed))


def peaks(motion: Piecewise) -> Peaks:
    """Peaks of a law for unit stroke over unit interval, from rest to rest: steps at the ends count.

    The acceleration is infinite where the velocity steps, the jerk where the acceleration does.
    """
    tops = [0.0] + [max(abs(low), abs(high)) for low, _, high, _ in (extremes(motion, k) for k in (1, 2, 3))]
    knots = motion.knots
    right, left = motion.derivatives(knots[:-1], 2, 1), motion.derivatives(knots[1:], 2, -1)
    zero = np.zeros((3, 1))
    step = np.abs(np.hstack((right, zero)) - np.hstack((zero, left))).max(axis=1)
    moving, pushed = (step[k] > _REST * max(1.0, tops[k]) for k in (1, 2))
    return Peaks(tops[1], math.inf if moving else tops[2], math.inf if moving or pushed else tops[3])
