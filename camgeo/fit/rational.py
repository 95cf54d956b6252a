"""A closed rational B-spline whose spans are Bezier pieces of one degree: for contours that are stated exactly."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from camgeo.fit.bound import Bound, Box
    from kin.numeric.arrays import Array

HALVINGS = 60  # of a span in the search for its extremes: each quarters what the control points leave open
EXTREME = 4.0 * float(np.finfo(np.float64).eps)  # relative to the size: extremes are found to this


@dataclass(frozen=True, eq=False)
class RationalSpline:
    """A closed rational B-spline of n spans of degree d: control (n d + 1, 2) in mm, weights (n d + 1,) all positive.

    Every d-th control point is a point of the curve, the last one the first. Raises ValueError for anything else.
    """

    degree: int
    control: Array
    weights: Array
    bound: Bound

    def __post_init__(self) -> None:
        points = len(self.control)
        if self.degree < 1 or points <= self.degree or (points - 1) % self.degree:
            raise ValueError(f"rational spline: {points} control points make no spans of degree {self.degree}")
        if self.control.shape != (points, 2) or self.weights.shape != (points,):
            raise ValueError("rational spline: control must be of shape (m, 2) and weights of shape (m,)")
        if not (np.isfinite(self.control).all() and np.isfinite(self.weights).all() and (self.weights > 0.0).all()):
            raise ValueError("rational spline: control must be finite, weights finite and positive")
        if not np.array_equal(self.control[0], self.control[-1]):
            raise ValueError("rational spline: does not close")

    @property
    def count(self) -> int:
        """Number of spans."""
        return (len(self.control) - 1) // self.degree

    @property
    def knots(self) -> Array:
        """Knots (m + d + 1,): whole numbers, each repeated as often as the degree says, the ends once more."""
        d = self.degree
        inner = np.repeat(np.arange(self.count + 1, dtype=np.float64), d)
        return np.concatenate([[0.0], inner, [float(self.count)]])

    @property
    def homogeneous(self) -> Array:
        """Bezier points (n, d + 1, 3) of the spans as (w x, w y, w)."""
        rows = np.column_stack([self.control * self.weights[:, None], self.weights])
        points: Array = rows[np.arange(self.count)[:, None] * self.degree + np.arange(self.degree + 1)]
        return points

    def mirrored(self) -> RationalSpline:
        """Mirror about the x axis, run backwards so that it is counter-clockwise again."""
        return RationalSpline(self.degree, self.control[::-1] * [1.0, -1.0], self.weights[::-1].copy(), self.bound)

    def scaled(self, k: float) -> RationalSpline:
        """Return the drawing k times as large, k > 0 (a change of unit)."""
        if not (math.isfinite(k) and k > 0.0):
            raise ValueError(f"scale must be finite and > 0, not {k!r}")
        return RationalSpline(self.degree, self.control * k, self.weights, self.bound.scaled(k))

    def box(self) -> Box:
        """Extremes (x_min, y_min, x_max, y_max) of the curve, to rounding, not of its control polygon."""
        found = self.control[:: self.degree]
        low, high = found.min(axis=0), found.max(axis=0)
        room = EXTREME * float(np.abs(self.control).max())
        parts = self.homogeneous
        for _ in range(HALVINGS):
            points = parts[:, :, :2] / parts[:, :, 2:]
            ends = points[:, (0, -1)].reshape(-1, 2)
            low, high = np.minimum(low, ends.min(axis=0)), np.maximum(high, ends.max(axis=0))
            # a part lies within the hull of its control points
            beyond = (points.min(axis=1) < low - room) | (points.max(axis=1) > high + room)
            parts = _halved(parts[beyond.any(axis=1)])
            if not len(parts):
                break
        return float(low[0]), float(low[1]), float(high[0]), float(high[1])


def _halved(parts: Array) -> Array:
    """Both halves (2 n, d + 1, 3) of Bezier pieces (n, d + 1, 3), by de Casteljau."""
    left, right, rest = np.empty_like(parts), np.empty_like(parts), parts
    for level in range(parts.shape[1]):
        left[:, level], right[:, parts.shape[1] - 1 - level] = rest[:, 0], rest[:, -1]
        rest = 0.5 * (rest[:, :-1] + rest[:, 1:])
    return np.concatenate([left, right])
