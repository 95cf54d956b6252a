"""Turrets by brute force that knows positions alone: how near all rollers come to a point at any angle.

Nothing here knows a derivative, a normal or a formula of the maker.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

LOOKS = 41
AROUND = 1.4  # rad on either side of a point in which a roller may touch it
GOLDEN = 0.5 * (math.sqrt(5.0) - 1.0)
TURN = 2.0 * math.pi


def law_at(law: str, u: Any, m: Any = np) -> Any:
    """Share of the stroke at a share of the angle, by the textbook's polynomials and sine."""
    if law == "cycloidal":
        return u - m.sin(2 * m.pi * u) / (2 * m.pi)
    if law == "polynomial-345":
        return 10 * u**3 - 15 * u**4 + 6 * u**5
    return 35 * u**4 - 84 * u**5 + 70 * u**6 - 20 * u**7


class Indexed:
    """Angle of a roller, rad, over the shaft angle, on and on, from rows (kind, stroke, degrees, law); at 0 `start`."""

    def __init__(self, rows: Sequence[tuple], start: float) -> None:
        self.rows, self.start = rows, start
        self.advance = sum(row[1] for row in rows)

    def __call__(self, theta: np.ndarray) -> np.ndarray:
        turns = np.floor(theta / TURN)
        degrees = np.degrees(theta - TURN * turns)
        lift, begin, level = np.zeros_like(degrees), 0.0, 0.0
        for kind, stroke, over, law in self.rows:
            inside = (degrees >= begin) & (degrees <= begin + over)
            u = (degrees[inside] - begin) / over
            lift[inside] = level + (stroke * law_at(law, u) if kind == "rise" else 0.0)
            begin, level = begin + over, level + stroke
        return np.radians(self.start + turns * self.advance + lift)


Away = "Callable[[np.ndarray, np.ndarray], np.ndarray]"


def barrel_away(offset: float, pitch: float, side: int, height: float) -> Callable[..., np.ndarray]:
    """Distance of points (n, 3), mm, turned back by the shaft angle, from a roller's axis at angles psi (n,)."""

    def away(points: np.ndarray, psi: np.ndarray) -> np.ndarray:
        y, z = offset - side * pitch * np.cos(psi), height + pitch * np.sin(psi)
        found = np.hypot(points[..., 1] - y, points[..., 2] - z)
        return np.where(points[..., 0] > 0.0, found, np.inf)

    return away


def globoid_away(distance: float, height: float) -> Callable[..., np.ndarray]:
    """The same of a roller that is radial on its turret."""

    def away(points: np.ndarray, psi: np.ndarray) -> np.ndarray:
        x, y, z = distance - points[..., 0], points[..., 1], points[..., 2] - height
        along = x * np.cos(psi) + z * np.sin(psi)
        found = np.sqrt(np.maximum(x * x + y * y + z * z - along * along, 0.0))
        return np.where(along > 0.0, found, np.inf)

    return away


def nearest(
    away: Callable[..., np.ndarray], motion: Indexed, points: np.ndarray, turns: int, steps: int = 45
) -> np.ndarray:
    """Least distance (n,), mm, of points (n, 3) from the axes of all rollers at all shaft angles."""

    def at(theta: np.ndarray) -> np.ndarray:
        cosine, sine = np.cos(theta), np.sin(theta)
        x, y = points[:, :1], points[:, 1:2]
        turned = np.stack([x * cosine + y * sine, y * cosine - x * sine, np.broadcast_to(points[:, 2:], theta.shape)])
        return away(np.moveaxis(turned, 0, -1), motion(theta))

    phi = np.arctan2(points[:, 1], points[:, 0])
    best = np.full(len(points), np.inf)
    for turn in range(-turns, turns + 1):
        theta = phi[:, None] + TURN * turn + np.linspace(-AROUND, AROUND, LOOKS)
        found = at(theta)
        k = np.argmin(found, axis=1)[:, None]
        middle, step = np.take_along_axis(theta, k, axis=1), 2.0 * AROUND / (LOOKS - 1)
        low, high = middle - step, middle + step
        close = np.take_along_axis(found, k, axis=1)[:, 0]
        a, b = high - GOLDEN * (high - low), low + GOLDEN * (high - low)
        at_a, at_b = at(a), at(b)
        for _ in range(steps):
            left = at_a < at_b
            low, high = np.where(left, low, a), np.where(left, b, high)
            a, b = high - GOLDEN * (high - low), low + GOLDEN * (high - low)
            at_a, at_b = at(a), at(b)
        best = np.minimum(best, np.minimum(close, np.minimum(at_a, at_b)[:, 0]))
    return best
