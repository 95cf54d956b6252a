"""Followers: what each one does on a given contour, by contact, against what it is meant to do."""

from __future__ import annotations

from kin.follower.base import Closure, Contact, Follower
from kin.follower.faces_on_arm import FlatPair, SwingingFace
from kin.follower.flat import FlatFace, TiltedFace, Yoke
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
    "SwingingFace",
    "TiltedFace",
    "Yoke",
]
