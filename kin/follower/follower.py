"""Followers: what each one does on a given contour, by contact, against what it is meant to do."""

from __future__ import annotations

from kin.follower.base import Closure, Contact, Follower
from kin.follower.flat import FlatFace, Yoke
from kin.follower.flat_pair import FlatPair
from kin.follower.motion_error import ContactError, Judged, MotionError, Play
from kin.follower.roller import DoubleRoller, Roller, RollerYoke

__all__ = [
    "Closure",
    "Contact",
    "ContactError",
    "DoubleRoller",
    "FlatFace",
    "FlatPair",
    "Follower",
    "Judged",
    "MotionError",
    "Play",
    "Roller",
    "RollerYoke",
    "Yoke",
]
