"""Followers: what each one does on a given contour, by contact, against what it is meant to do.

Every follower has `intended(phi)`, its position at shaft angles (n,), in mm or radians; `contact(contour, phi)`, its
position (n,) or, for one that is held from two sides, (2, n), with the contour as it lies; `judge(contour, phi)`, the
motion error and the play; `motion_limit(tolerance)` and, with play, `play_limit(tolerance)`, what a contour within a
tolerance of the exact one can do at most; and `envelope`, that exact contour, with `shaft_angle` of its parameter.
"""

from __future__ import annotations

from kin.follower.flat import FlatFace, FlatPair, Yoke
from kin.follower.motion_error import ContactError, Judged, MotionError, Play
from kin.follower.roller import DoubleRoller, Roller

__all__ = [
    "ContactError",
    "DoubleRoller",
    "FlatFace",
    "FlatPair",
    "Follower",
    "Judged",
    "MotionError",
    "Play",
    "Roller",
    "Yoke",
]

Follower = FlatFace | Yoke | FlatPair | Roller | DoubleRoller
