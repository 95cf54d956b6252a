"""Angles: one turn, and degrees as they are written."""

from __future__ import annotations

import math

TURN = 2.0 * math.pi  # radians of one turn


def degrees(angle: float) -> float:
    """Return an angle in radians as degrees in [0, 360)."""
    turned = math.degrees(angle) % 360.0
    return 0.0 if turned >= 360.0 else turned
