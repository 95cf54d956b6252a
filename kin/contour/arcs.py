"""Lines and arcs by start, tangent, curvature and length: a form without a centre, so nothing is lost as radii grow.

A piece of curvature k at arc length s lies at  start + s sinc(k s / 2) T turned by k s / 2,  a line being k = 0. The
outward normal of a counter-clockwise contour is the tangent turned clockwise; k > 0 is convex.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from kin.numeric.arrays import Array, Indices


def cross(a: Array, b: Array) -> Array:
    """Plane cross product of vectors (..., 2): positive where b is counter-clockwise of a."""
    product: Array = a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]
    return product


def dot(a: Array, b: Array) -> Array:
    """Scalar product of vectors (..., 2)."""
    product: Array = a[..., 0] * b[..., 0] + a[..., 1] * b[..., 1]
    return product


def unit(angle: float | Array) -> Array:
    """u(t) = (cos t, sin t), (..., 2)."""
    return np.stack([np.cos(angle), np.sin(angle)], axis=-1)


def left(v: Array) -> Array:
    """Vectors (..., 2) turned a quarter turn counter-clockwise."""
    return np.stack([-v[..., 1], v[..., 0]], axis=-1)


def right(v: Array) -> Array:
    """Vectors (..., 2) turned a quarter turn clockwise."""
    return np.stack([v[..., 1], -v[..., 0]], axis=-1)


def turned(v: Array, angle: Array) -> Array:
    """Vectors (n, 2) turned counter-clockwise by angles (n,)."""
    c, s = np.cos(angle), np.sin(angle)
    return np.stack([c * v[..., 0] - s * v[..., 1], s * v[..., 0] + c * v[..., 1]], axis=-1)


@dataclass(frozen=True, eq=False)
class Arcs:
    """n pieces: `start` (n, 2), unit `tangent` (n, 2) there, signed `curvature` (n,), `length` (n,), in mm and 1/mm.

    In a chain each piece ends where the next one starts, the last where the first starts; nothing here relies on it
    unless a docstring says so.
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
        """Unit tangents at the ends (n, 2)."""
        return self.tangents(self.length)

    def cut(self, parts: NDArray[np.intp]) -> tuple[Arcs, Indices]:
        """Each piece cut into `parts` (n,) equal ones, in order; and the piece that each part comes from."""
        if parts.max(initial=1) == 1:
            return self, np.arange(len(self))
        owner = np.repeat(np.arange(len(self)), parts)
        number = np.arange(len(owner)) - np.repeat(np.cumsum(parts) - parts, parts)
        whole = self.take(owner)
        step = whole.length / parts[owner]
        s = number * step
        return Arcs(whole.points(s), whole.tangents(s), whole.curvature, step), owner

    def joined(self, other: Arcs) -> Arcs:
        """Both sets of pieces, one after the other."""
        return Arcs(
            np.concatenate([self.start, other.start]),
            np.concatenate([self.tangent, other.tangent]),
            np.concatenate([self.curvature, other.curvature]),
            np.concatenate([self.length, other.length]),
        )

    def reversed(self) -> Arcs:
        """Return the pieces in reverse order, each run backwards: of a closed chain what lay left lies right."""
        return Arcs(self.ends, -self.end_tangents, -self.curvature, self.length).take(np.arange(len(self))[::-1])

    def turned(self, angle: float) -> Arcs:
        """The pieces turned counter-clockwise about the origin by an angle, rad."""
        if not angle:
            return self
        by = np.full(len(self), angle)
        return Arcs(turned(self.start, by), turned(self.tangent, by), self.curvature, self.length)

    def turns(self) -> Array:
        """Turn of the tangent at the start of each piece of a chain, counter-clockwise, in [-pi, pi] (n,)."""
        before = np.roll(self.end_tangents, 1, axis=0)
        return np.arctan2(cross(before, self.tangent), dot(before, self.tangent))


def circle(centre: Array, radius: Array) -> Arcs:
    """Full circles about centres (n, 2), counter-clockwise."""
    start = centre + np.stack([radius, np.zeros_like(radius)], axis=-1)
    tangent = np.broadcast_to(np.array([0.0, 1.0]), start.shape)
    return Arcs(start, tangent, 1.0 / radius, 2.0 * np.pi * radius)


def radial(arcs: Arcs, point: Array) -> Array:
    """Signed distance of points (n, 2) outside the full circle or line of each piece (n,).

    With y from the start and outward normal m, the circle is 2 y.m + k y^2 = 0; the root below takes that to a
    distance without the cancellation that a far centre would bring.
    """
    y = point - arcs.start
    height = 2.0 * dot(y, right(arcs.tangent)) + arcs.curvature * dot(y, y)
    distance: Array = height / (1.0 + np.sqrt(np.maximum(1.0 + arcs.curvature * height, 0.0)))
    return distance


def nearest_on(arcs: Arcs, point: Array) -> tuple[Array, Array]:
    """Arc length of the point of each piece nearest to `point` (n, 2), and the unsigned distance there: (n,), (n,).

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
