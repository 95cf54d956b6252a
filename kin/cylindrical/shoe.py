"""A shoe in a groove: a lens between two arcs from tip to tip, that turns freely about the pin in its middle.

In the development at the radius r the pin's path bends by k = r |S''|/(r^2 + S'^2)^(3/2), and the groove is what lies
within R of it. A lens of the length L, 2 R wide in the middle, that lies along the path with its middle on it, stands
nowhere farther out of the groove than by

    sqrt(1/k^2 + L^2/4) - 1/k - R                               k the greatest curvature of the path.

For the path runs between the two circles of the radius 1/k that touch the lens there, and the way from a point of the
lens to either circle's nearest point crosses it, or to the other's. On an arc of that curvature it is exact.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from kin.cylindrical.lifts import Lifts

if TYPE_CHECKING:
    from kin.cylindrical.follower import DrumFollower


def shoe_interference(follower: DrumFollower) -> tuple[float, float]:
    """How far, mm, a follower's shoe may stand out of its groove, at most, and the angle of the sharpest bend, rad.

    It is that of the development, the greatest between the ends of the pin; 0 where it goes through.
    """
    bow, at = _sharpest(follower)
    half = 0.5 * (follower.shoe or 0.0)
    # sqrt(1/k^2 + h^2) - 1/k without a difference of great numbers
    rise = half * half * bow / (1.0 + math.hypot(1.0, half * bow))
    return max(rise - follower.radius, 0.0), at


def longest_shoe(follower: DrumFollower, tolerance: float) -> float:
    """Length, mm, of the longest shoe of the follower's width that stands out of its groove by a tolerance, mm."""
    bow, _ = _sharpest(follower)
    rise = follower.radius + tolerance
    return 2.0 * math.sqrt(rise * (rise + 2.0 / bow)) if bow > 0.0 else math.inf


def _sharpest(follower: DrumFollower) -> tuple[float, float]:
    """Greatest curvature of the pin's path, 1/mm, at most, 0 of a straight one; and its angle, rad."""
    lifts = Lifts(follower.law, follower.turns)
    low, high = lifts.enclosed
    bend = np.maximum(np.abs(low[2]), np.abs(high[2]))
    least = np.where((low[1] <= 0.0) & (high[1] >= 0.0), 0.0, np.minimum(np.abs(low[1]), np.abs(high[1])))
    # r/(r^2 + s^2)^(3/2) is greatest at r = s/sqrt 2
    r = np.clip(least / math.sqrt(2.0), follower.inner, follower.outer)
    curvature = r * bend / np.hypot(r, least) ** 3
    k = int(np.argmax(curvature))
    return max(float(curvature[k]), 0.0), 0.5 * float(lifts.nodes[k] + lifts.nodes[k + 1])
