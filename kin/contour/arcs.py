"""Lines and arcs by start, tangent, curvature and length: a form without a centre, so nothing is lost as radii grow.

A piece of unit tangent T and curvature k at its start lies, at arc length s, at  start + s sinc(k s / 2) T',  where
sinc x = sin x / x and T' is T turned counter-clockwise by k s / 2; a line has k = 0. The outward normal of a
counter-clockwise contour is the tangent turned clockwise; k > 0 is convex. Vectors lie along the last axis, of size 2.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from kin.numeric.arrays import Array, Indices


def cross(a: Array, b: Array) -> Array:
    """Plane cross product (...) of vectors a and b (..., 2): positive where b is counter-clockwise of a."""
    product: Array = a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]
    return product


def dot(a: Array, b: Array) -> Array:
    """Scalar product (...) of vectors a and b (..., 2)."""
    product: Array = a[..., 0] * b[..., 0] + a[..., 1] * b[..., 1]
    return product


def unit(angle: float | Array) -> Array:
    """Unit vectors u(t) = (cos t, sin t), (..., 2), at angles t, rad."""
    return np.stack([np.cos(angle), np.sin(angle)], axis=-1)


def left(v: Array) -> Array:
    """Vectors (..., 2) turned a quarter turn counter-clockwise."""
    return np.stack([-v[..., 1], v[..., 0]], axis=-1)


def right(v: Array) -> Array:
    """Vectors (..., 2) turned a quarter turn clockwise."""
    return np.stack([v[..., 1], -v[..., 0]], axis=-1)


def turned(v: Array, angle: Array) -> Array:
    """Vectors (n, 2) turned counter-clockwise by angles (n,), rad."""
    c, s = np.cos(angle), np.sin(angle)
    return np.stack([c * v[..., 0] - s * v[..., 1], s * v[..., 0] + c * v[..., 1]], axis=-1)


@dataclass(frozen=True, eq=False)
class Arcs:
    """n pieces: `start` (n, 2), unit `tangent` (n, 2) there, signed `curvature` (n,), `length` (n,), in mm and 1/mm.

    In a chain each piece ends where the next one starts, the last where the first starts; no method needs a chain
    unless its docstring says so.
    """

    start: Array
    tangent: Array
    curvature: Array
    length: Array

    def __len__(self) -> int:
        return len(self.length)

    def take(self, index: Indices | NDArray[np.bool_]) -> Arcs:
        """Return the pieces chosen by index or mask."""
        return Arcs(self.start[index], self.tangent[index], self.curvature[index], self.length[index])

    def points(self, s: Array) -> Array:
        """Return points at arc lengths s (n,), one on each piece: (n, 2)."""
        if not self.curvature.any():
            return self.start + s[:, None] * self.tangent
        half = 0.5 * self.curvature * s
        chord = s * np.sinc(half / np.pi)
        return self.start + chord[:, None] * turned(self.tangent, half)

    def tangents(self, s: Array) -> Array:
        """Return unit tangents at arc lengths s (n,), one on each piece: (n, 2)."""
        return turned(self.tangent, self.curvature * s)

    @property
    def ends(self) -> Array:
        """End points (n, 2)."""
        return self.points(self.length)

    @property
    def end_tangents(self) -> Array:
        """Unit tangents (n, 2) at the ends."""
        return self.tangents(self.length)

    def cut(self, parts: NDArray[np.intp]) -> tuple[Arcs, Indices]:
        """Pieces cut into `parts` (n,) equal parts each, in order, and the index of the piece each part comes from."""
        if parts.max(initial=1) == 1:
            return self, np.arange(len(self))
        owner = np.repeat(np.arange(len(self)), parts)
        number = np.arange(len(owner)) - np.repeat(np.cumsum(parts) - parts, parts)
        whole = self.take(owner)
        step = whole.length / parts[owner]
        s = number * step
        return Arcs(whole.points(s), whole.tangents(s), whole.curvature, step), owner

    def joined(self, other: Arcs) -> Arcs:
        """The pieces of this set, then those of the other."""
        return Arcs(
            np.concatenate([self.start, other.start]),
            np.concatenate([self.tangent, other.tangent]),
            np.concatenate([self.curvature, other.curvature]),
            np.concatenate([self.length, other.length]),
        )

    def reversed(self) -> Arcs:
        """Return the pieces in reverse order, each run backwards: the left side becomes the right side."""
        return Arcs(self.ends, -self.end_tangents, -self.curvature, self.length).take(np.arange(len(self))[::-1])

    def turned(self, angle: float) -> Arcs:
        """The pieces turned counter-clockwise about the origin by an angle, rad."""
        if not angle:
            return self
        by = np.full(len(self), angle)
        return Arcs(turned(self.start, by), turned(self.tangent, by), self.curvature, self.length)

    def turns(self) -> Array:
        """Counter-clockwise turn of the tangent (n,), rad in [-pi, pi], at the start of each piece of a chain."""
        before = np.roll(self.end_tangents, 1, axis=0)
        return np.arctan2(cross(before, self.tangent), dot(before, self.tangent))


def circle(centre: Array, radius: Array) -> Arcs:
    """Full circles about centres (n, 2) with radii (n,), counter-clockwise from the point at angle 0."""
    start = centre + np.stack([radius, np.zeros_like(radius)], axis=-1)
    tangent = np.broadcast_to(np.array([0.0, 1.0]), start.shape)
    return Arcs(start, tangent, 1.0 / radius, 2.0 * np.pi * radius)


def radial(arcs: Arcs, point: Array) -> Array:
    """Signed distance (n,) of points (n, 2) from the full circle or line of each piece, positive on its right.

    The right is the outside of a circle with k > 0, the inside with k < 0. With y from the start and the right normal
    m, the circle is 2 y.m + k y^2 = 0; the root below takes that to a distance without the cancellation that a far
    centre would bring.
    """
    y = point - arcs.start
    height = 2.0 * dot(y, right(arcs.tangent)) + arcs.curvature * dot(y, y)
    distance: Array = height / (1.0 + np.sqrt(np.maximum(1.0 + arcs.curvature * height, 0.0)))
    return distance


def nearest_on(arcs: Arcs, point: Array) -> tuple[Array, Array]:
    """Arc length (n,) on each piece of its place nearest to `point` (n, 2), and the unsigned distance (n,) there.

    Pieces may turn by at most half a turn.
    """
    y = point - arcs.start
    k = arcs.curvature
    s = dot(y, arcs.tangent)
    if k.any():
        away = 1.0 + k * dot(y, right(arcs.tangent))
        with np.errstate(divide="ignore", invalid="ignore"):
            s = np.where(k == 0.0, s, np.arctan2(k * s, away) / k)
        # The foot of an arc may lie behind its start or beyond its end, whichever is nearer round the circle.
        turn = np.where(k == 0.0, np.inf, 2.0 * np.pi / np.abs(np.where(k == 0.0, 1.0, k)))
        s = np.where(s < 0.5 * (arcs.length - turn), s + turn, s)
    s = np.clip(s, 0.0, arcs.length)
    inside = (s > 0.0) & (s < arcs.length)
    gap = arcs.points(s) - point
    return s, np.where(inside, np.abs(radial(arcs, point)), np.hypot(gap[:, 0], gap[:, 1]))
