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
        return u * u * u * (10 - u * (15 - 6 * u))
    return u * u * u * u * (35 - u * (84 - u * (70 - 20 * u)))


class Lift:
    """Lift over the shaft angle from rows (kind, stroke, degrees, law), and where it leads a roller.

    The roller is on a carriage, `offset` mm beside a radius, or on an `arm`: its length, y of its pivot, height of the
    pivot over the roller at lift 0, and side. Strokes are then degrees. `taper` is a cone's half angle in degrees; its
    radius is that at `at` mm; `beside` is how far the roller is square to its arm, or along the axis.
    """

    def __init__(
        self,
        rows: Sequence[tuple],
        *,
        offset: float = 0.0,
        arm: tuple[float, float, float, int] | None = None,
        taper: float = 0.0,
        at: float = 0.0,
        beside: float = 0.0,
    ) -> None:
        self.rows, self.offset, self.arm, self.beside = rows, offset, arm, beside
        self.slope, self.at = math.tan(math.radians(taper)), at

    def second(self, beside: float) -> Lift:
        """The same motion of a roller beside this one."""
        other = Lift(self.rows, offset=self.offset, arm=self.arm, at=self.at, beside=beside)
        other.slope = self.slope
        return other

    def place(self, theta: np.ndarray) -> tuple[Any, Any]:
        """Y, and z over the height of the middle at lift 0, mm, of the roller's axis at shaft angles, rad."""
        lift = self(theta)
        if self.arm is None:
            return self.offset, lift + self.beside
        length, y, z, side = self.arm
        psi = math.asin(-z / length) + np.radians(lift)
        cosine, sine = np.cos(psi), np.sin(psi)
        across, up = length * cosine - self.beside * sine, length * sine + self.beside * cosine
        return y - side * across, z + up

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
        y, z = lift.place(theta)
        along, across = r[:, None] * np.cos(phi[:, None] - theta), r[:, None] * np.sin(phi[:, None] - theta) - y
        inside = (roller + (along - lift.at) * lift.slope) ** 2 - across * across
        found = side * (z + side * np.sqrt(np.maximum(inside, 0.0)))
        return np.where(inside > 0.0, found, -np.inf)

    most = roller + (r - lift.at) * lift.slope + np.abs(lift.place(np.linspace(0.0, 6.3, 200))[0]).max()
    half = np.arcsin(np.minimum(most / r, 1.0))
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
    across, size = r * np.sin(phi - at) - lift.place(at)[0], roller + (r * np.cos(phi - at) - lift.at) * lift.slope
    lean = np.sqrt(np.maximum(size * size - across * across, 0.0)) / size / math.hypot(1.0, lift.slope)
    return (points[:, 2] - level - z) * lean
