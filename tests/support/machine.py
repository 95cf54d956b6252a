"""A milling machine with faults, by shapely: it follows a program, and what its cutter leaves is measured by chance."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

import numpy as np

from support.heavy import shapely

if TYPE_CHECKING:
    from pathlib import Path

    from kin.numeric.arrays import Array

STEP = 0.04  # mm between points of a path


def path_of(program: Path) -> Array:
    """Path of the cutter's centre round the contour in the last pass (n, 2), without leading in and out, mm."""
    at, mode = {"X": 0.0, "Y": 0.0, "Z": 0.0}, 0
    moves: list[tuple[float, Array]] = []
    for line in program.read_text("utf-8").splitlines():
        words = {k: float(v) for k, v in re.findall(r"([GXYZIJ])(-?[0-9.]+)", re.sub(r"\(.*\)", "", line))}
        if "G" in words and words["G"] <= 3:
            mode = int(words["G"])
        start = np.array([at["X"], at["Y"]])
        at |= {k: v for k, v in words.items() if k in at}
        end = np.array([at["X"], at["Y"]])
        if mode == 0 or not {"X", "Y"} & words.keys():
            continue
        if mode == 1:
            share = np.linspace(0.0, 1.0, int(np.hypot(*(end - start)) / STEP) + 2)[:-1]
            moves.append((at["Z"], start + share[:, None] * (end - start)))
            continue
        centre = start + np.array([words["I"], words["J"]])
        radius = np.hypot(*(start - centre))
        a, b = np.arctan2(*(start - centre)[::-1]), np.arctan2(*(end - centre)[::-1])
        sweep = (b - a) % (2.0 * np.pi) if mode == 3 else -((a - b) % (2.0 * np.pi))
        angle = a + sweep * np.linspace(0.0, 1.0, int(radius * abs(sweep) / STEP) + 2)[:-1]
        moves.append((at["Z"], centre + radius * np.column_stack([np.cos(angle), np.sin(angle)])))
    bottom = min(z for z, _ in moves)
    return np.concatenate([points for z, points in moves if z == bottom][1:-1])


def lagging(command: Array, play: float) -> Array:
    """Where a slide stands that a screw with play drives (n,): it stays until the play is taken up."""
    slide, at = np.empty_like(command), command[0]
    for _ in range(2):  # the first turn takes up the play
        for i, to in enumerate(command.tolist()):
            at = min(max(at, to - 0.5 * play), to + 0.5 * play)
            slide[i] = at
    return slide


def milled(program: Path, radius: float, *, play: float, skew: float, count: int = 720) -> Array:
    """Points of what a machine makes of a program (count, 2), mm.

    `radius` is that of the cutter as it is, `play` of the screws of x and y, mm, `skew` what x gains by y.
    """
    path = path_of(program)
    x, y = (lagging(row, play) for row in path.T)
    ring = shapely.Polygon(np.column_stack([x + skew * y, y])).buffer(-radius, quad_segs=200).exterior
    corners = shapely.get_coordinates(ring)
    along = np.append(0.0, np.cumsum(np.hypot(*np.diff(corners, axis=0).T)))
    at = np.linspace(0.0, along[-1], count, endpoint=False)
    return np.column_stack([np.interp(at, along, column) for column in corners.T])


def scattered(points: Array, noise: float, seed: int) -> Array:
    """The same with a scatter along the radius, mm."""
    away = points / np.hypot(points[:, 0], points[:, 1])[:, None]
    scattered: Array = points + np.random.default_rng(seed).normal(0.0, noise, len(points))[:, None] * away
    return scattered
