"""The path of a point of a moving link over the turn: place, speed and curvature from exact derivatives."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kin.numeric.angles import TURN
from kin.numeric.monotone import between, cells

if TYPE_CHECKING:
    from kin.law.piecewise import Side
    from kin.linkage.chain import Solved
    from kin.linkage.mechanism import Mechanism
    from kin.numeric.arrays import Array

_REST = 1e-9  # of the path's reach per radian: a slower point stands still
_SHARE = 1e-3  # of the tolerance, within which polynomials stand for the path


class Traced(NamedTuple):
    """A point at n angles, in the fixed axes: x, y, mm; speed, mm per rad of shaft; curvature, 1/mm; (n,) each.

    The curvature is above 0 where the path turns to its left, nan where the point stands still.
    """

    x: Array
    y: Array
    speed: Array
    curvature: Array


def traced(mechanism: Mechanism, on: str, point: tuple[float, float], theta: Array, side: Side = 1) -> Traced:
    """Follow the point `point`, mm, of the link `on` at relative angles theta (n,), rad; at a break from `side`.

    `on` is coupler, output or dyads[0], ... Raises PlaceError where a loop binds. With dots for derivatives by the
    relative angle the curvature is (x. y.. - y. x..)/v^3, whatever the parameter; the speed is v over the shaft's rate.
    """
    motion = mechanism.at(theta, 2, side)
    x, y = _rows(mechanism, on, point, motion.solved)
    speed = np.hypot(x[1], y[1])
    moving = speed > _REST * max(float(np.hypot(x[0], y[0]).max()), float(np.abs(point).max()))
    curvature = np.full(speed.shape, math.nan)
    curvature[moving] = ((x[1] * y[2] - y[1] * x[2])[moving]) / speed[moving] ** 3
    return Traced(x[0], y[0], speed / np.abs(motion.shaft[1]), curvature)


def flattened(mechanism: Mechanism, on: str, point: tuple[float, float], tolerance: float) -> Array:
    """Points (n, 2), mm, of the path of `point` of the link `on` over a turn, the first again at the end.

    `on` is coupler, output or dyads[0], ...; chords between the points keep within `tolerance`, mm, of the path.

    Between breaks the path is followed by polynomials in Bernstein form, to a thousandth of the tolerance. Their second
    differences bound the second derivative M, and a chord over a part h of the parameter is off by M h^2/8 at most.
    Raises RoughError where no polynomials follow, PlaceError where a loop binds.
    """

    def place(theta: Array) -> Array:
        x, y = _rows(mechanism, on, point, mechanism.at(theta, 0).solved)
        return np.stack([x[0], y[0]])

    made = cells(place, between(0.0, TURN, mechanism.breaks.tolist()), _SHARE * tolerance)
    degree = made.coefficients.shape[-1] - 1
    bend = degree * (degree - 1) * np.hypot(*np.abs(np.diff(made.coefficients, 2, axis=-1)).max(axis=-1))
    counts = np.maximum(np.ceil(np.sqrt(bend / (8.0 * (1.0 - 2.0 * _SHARE) * tolerance))), 1).astype(int)
    ends = zip(made.low.tolist(), made.high.tolist(), counts.tolist(), strict=True)
    theta = np.concatenate([np.linspace(low, high, count, endpoint=False) for low, high, count in ends])
    points = place(theta).T
    moves = np.append(True, np.any(np.diff(points, axis=0) != 0.0, axis=1))
    return np.vstack([points[moves], points[:1]])


def _rows(mechanism: Mechanism, on: str, point: tuple[float, float], solved: Solved) -> tuple[Array, Array]:
    """Derivatives of x and y by the relative angle, (order + 1, n) each."""
    x, y = mechanism.chain.carrier_of(on).pose(solved).point(*point)
    return x.derivatives(), y.derivatives()
