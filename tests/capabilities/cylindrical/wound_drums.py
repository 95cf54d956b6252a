"""Recipes of drums of several turns for tests, in rows of constant velocity between blends, and where a pin was."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Sequence
    from random import Random

TURN = 2.0 * math.pi

Row = tuple[float, float, float, float]  # lift gained, degrees, and degrees of the blends at its ends


class Pins:
    """Lift over several turns by positions, from rows of constant velocity between blends, and where a pin has been."""

    def __init__(self, rows: Sequence[Row], radius: float) -> None:
        self.rows, self.radius = rows, radius
        self.turns = round(sum(row[1] for row in rows) / 360.0)

    def __call__(self, theta: np.ndarray) -> np.ndarray:
        """Lift, mm, at shaft angles, rad."""
        degrees = np.mod(np.degrees(theta), 360.0 * self.turns)
        lift, begin, level = np.zeros_like(degrees), 0.0, 0.0
        for gain, over, first, last in self.rows:
            t = np.clip(degrees - begin, 0.0, over)
            rate = gain / (over - 0.5 * (first + last))
            x, y = np.clip(t / max(first, 1e-9), 0.0, 1.0), np.clip((over - t) / max(last, 1e-9), 0.0, 1.0)
            # products, as powers of arrays take long
            begins = 0.5 * rate * first * (x * x * x * (2 - x)) + rate * np.maximum(t - first, 0.0)
            ends = gain - 0.5 * rate * last * (y * y * y * (2 - y))
            inside = (degrees >= begin) & (degrees < begin + over)
            lift = np.where(inside, level + np.where(t < over - last, begins, ends), lift)
            begin, level = begin + over, level + gain
        return lift

    def away(self, points: np.ndarray, level: float) -> np.ndarray:
        """Distance (n, turns), mm, of places (n, 3) from the pin nearest to them in each turn; below 0 within it."""
        r, phi, z = np.hypot(points[:, 0], points[:, 1]), np.arctan2(points[:, 1], points[:, 0]), points[:, 2] - level
        found = np.empty((len(points), self.turns))
        for turn in range(self.turns):
            middle, half = phi + TURN * turn, 1.6 * self.radius / r
            for _ in range(5):
                theta = middle[:, None] + half[:, None] * np.linspace(-1.0, 1.0, 25)
                off = np.hypot(r[:, None] * np.sin(theta - phi[:, None]), z[:, None] - self(theta))
                best = np.argmin(off, axis=1)
                middle, half = theta[np.arange(r.size), best], half / 8.0
            found[:, turn] = off.min(axis=1) - self.radius
        return found


def text_of(rows: Sequence[Row], *, radius: float, depth: float, width: float, length: float, more: str = "") -> str:
    """Recipe of rows; its lowest place lies width and 3 mm over the lower face, its highest as far below the upper."""
    low = width + 3.0
    stroke = float(max(np.cumsum([row[0] for row in rows])))
    turns = round(sum(row[1] for row in rows) / 360.0)
    motion = ", ".join(
        f"{{{'rise' if gain > 0 else 'return'}: {abs(gain)!r}, over: {over!r}, "
        f"law: {{uniform: {{blend: [{first!r}, {last!r}]}}}}}}"
        for gain, over, first, last in rows
    )
    return (
        f"{more}cam:\n  kind: cylindrical\n  radius: {radius!r}\n  turns: {turns}\n"
        f"  track: {{groove: {{depth: {depth!r}}}}}\n"
        f"  follower: {{kind: shoe, width: {width!r}, length: {length!r}}}\n  pitch_height: {low!r}\n"
        f"  motion: [{motion}]\npart: {{length: {stroke + 2.0 * low!r}, bore: 10}}\n"
        "export: {tolerance: 0.05, files: [stl]}\n"
    )


SCREW_ROWS: list[Row] = [(55.0, 1080.0, 90.0, 90.0), (-55.0, 1080.0, 90.0, 90.0)]
SCREW = text_of(SCREW_ROWS, radius=30.0, depth=6.0, width=10.0, length=55.0)
"""The screw of the worked case, 20 mm a turn, with reversals."""
SPIRAL_ROWS: list[Row] = [(60.0, 1080.0, 60.0, 80.0), (-60.0, 360.0, 80.0, 60.0)]
SPIRAL = text_of(SPIRAL_ROWS, radius=40.0, depth=6.0, width=8.0, length=26.0, more="rotation: ccw\n")


def random_track(rng: Random) -> tuple[list[Row], str]:
    """Rows of a random screw, or of a spiral with a quick return, and the text of its recipe."""
    radius = rng.uniform(25.0, 45.0)
    depth, width = rng.uniform(0.12, 0.2) * radius, rng.uniform(0.15, 0.25) * radius
    out = rng.choice([2, 3, 4])
    back = out if rng.random() < 0.5 else rng.choice([1, 2])
    stroke = out * width * rng.uniform(1.9, 2.6)
    shift = rng.uniform(-60.0, 60.0)
    first, second, third, last = (rng.uniform(60.0, 100.0) for _ in range(4))
    rows: list[Row] = [(stroke, out * 360.0 + shift, first, second), (-stroke, back * 360.0 - shift, third, last)]
    more = "rotation: ccw\n" if rng.random() < 0.5 else ""
    return rows, text_of(rows, radius=radius, depth=depth, width=width, length=width * rng.uniform(2.0, 9.0), more=more)
