"""What a limit is compared with: the stroke, and the play that a tolerance permits without a pressure angle."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from kin.numeric.feet import grid

if TYPE_CHECKING:
    from kin.follower.base import Closure, Follower


def stroke_of(follower: Follower) -> float:
    """Stroke, mm, or swing, degrees, of the intended motion, from a grid of shaft angles that has its breaks."""
    stroke = float(np.ptp(follower.intended(grid(follower.motion.breaks))))
    return float(np.degrees(stroke)) if follower.unit == "deg" else stroke


def direct_play(closure: Closure, follower: Follower, tolerance: float) -> float:
    """Greatest play, mm or degrees, at a pressure angle of 0, of two contacts each off by the tolerance, mm."""
    return 2.0 * (follower.direct_limit(tolerance) if closure.radius is None else tolerance)
