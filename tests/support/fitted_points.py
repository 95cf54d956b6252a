"""Points of fitted contours, from their definitions alone."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from camgeo.fit.pieces import ArcSpline, BSpline, Polygon


def polygon_points(polygon: Polygon, per_piece: int) -> np.ndarray:
    """Points (count * per_piece, 2) at equal shares of each edge, mm."""
    share = np.linspace(0, 1, per_piece, endpoint=False)[None, :, None]
    a = polygon.vertices[:, None]
    return (a + share * (np.roll(a, -1, axis=0) - a)).reshape(-1, 2)


def arc_points(arcs: ArcSpline, per_piece: int) -> np.ndarray:
    """Points at equal angles, from the chord and the bulge alone: no centre, which may lie far away."""
    a = arcs.points
    chord = np.roll(a, -1, axis=0) - a
    half = 2 * np.arctan(arcs.bulges)[:, None]
    angle = np.linspace(0, 1, per_piece, endpoint=False) * half
    with np.errstate(invalid="ignore"):
        length = np.where(half == 0, angle * 0, np.sin(angle) / np.sin(half))
    # the chord to the point at angle 2 x of 2 half turns by x - half from the whole chord
    turn = np.exp(1j * (angle - half)) * length * (chord[:, :1] + 1j * chord[:, 1:])
    return np.column_stack([(a[:, :1] + turn.real).ravel(), (a[:, 1:] + turn.imag).ravel()])


def spline_points(spline: BSpline, per_piece: int) -> np.ndarray:
    """Points (count * per_piece, 2) at equal steps of each Bezier piece, mm."""
    u = np.linspace(0, 1, per_piece, endpoint=False)
    basis = np.stack([(1 - u) ** 3, 3 * u * (1 - u) ** 2, 3 * u**2 * (1 - u), u**3], axis=1)
    return np.einsum("ui,nia->nua", basis, spline.beziers()).reshape(-1, 2)


def some(count: int) -> int:
    """Points on each of `count` pieces: some thousands in all."""
    return max(5, min(200, 3_000 // count))
