"""Flanks of drums by brute force that knows positions alone: the lowest underside, or highest top, of all rollers.

Nothing here knows a derivative, a normal or a formula of the maker.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Sequence

LOOKS = 201
GOLDEN = 0.5 * (math.sqrt(5.0) - 1.0)


def law_at(law: str, u: Any, m: Any = np) -> Any:
    """Share of the stroke at a share of the angle, by the textbook's polynomials and sine."""
    if law == "cycloidal":
        return u - m.sin(2 * m.pi * u) / (2 * m.pi)
    if law == "polynomial-345":
        return 10 * u**3 - 15 * u**4 + 6 * u**5
    return 35 * u**4 - 84 * u**5 + 70 * u**6 - 20 * u**7


class Lift:
    """Lift over the shaft angle from rows (kind, stroke, degrees, law)."""

    def __init__(self, rows: Sequence[tuple]) -> None:
        self.rows = rows

    def __call__(self, theta: np.ndarray) -> np.ndarray:
        """Lift, mm, at shaft angles, rad, of any shape."""
        degrees = np.mod(np.degrees(theta), 360.0)
        lift, begin, level = np.zeros_like(degrees), 0.0, 0.0
        for kind, stroke, over, law in self.rows:
            sign = {"rise": 1.0, "return": -1.0, "dwell": 0.0}[kind]
            inside = (degrees >= begin) & (degrees < begin + over)
            u = (degrees[inside] - begin) / over
            lift[inside] = level + (sign * stroke * law_at(law, u) if sign else 0.0)
            begin, level = begin + over, level + sign * stroke
        return lift


def envelope(lift: Lift, side: int, roller: float, r: np.ndarray, phi: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Height (n,) over the roller's level at lift 0 of what all rollers leave at places (n,), and the shaft angle.

    `side` -1 is below them, 1 above them.
    """

    def height(theta: np.ndarray) -> np.ndarray:
        across = r[:, None] * np.sin(phi[:, None] - theta)
        inside = roller * roller - across * across
        found = side * (lift(theta) + side * np.sqrt(np.maximum(inside, 0.0)))
        return np.where(inside > 0.0, found, -np.inf)

    half = np.arcsin(np.minimum(roller / r, 1.0))
    theta = phi[:, None] + half[:, None] * np.linspace(-1.0, 1.0, LOOKS)
    best = np.argmax(height(theta), axis=1)
    step = 2.0 * half / (LOOKS - 1)
    middle = theta[np.arange(r.size), best]
    low, high = middle - step, middle + step
    for _ in range(45):  # golden section: of one top between neighbours
        a, b = high - GOLDEN * (high - low), low + GOLDEN * (high - low)
        more = (height(a[:, None]) > height(b[:, None]))[:, 0]
        low, high = np.where(more, low, a), np.where(more, b, high)
    at = 0.5 * (low + high)
    return side * height(at[:, None])[:, 0], at


def off_flank(lift: Lift, side: int, roller: float, level: float, points: np.ndarray) -> np.ndarray:
    """Distance (n,) of points (n, 3) above an envelope of rollers, square to the roller that touches beneath each."""
    r, phi = np.hypot(points[:, 0], points[:, 1]), np.arctan2(points[:, 1], points[:, 0])
    z, at = envelope(lift, side, roller, r, phi)
    across = r * np.sin(phi - at)
    lean = np.sqrt(np.maximum(roller * roller - across * across, 0.0)) / roller
    return (points[:, 2] - level - z) * lean
