"""Rational Bezier pieces, thousands at a time, as arrays of control points and weights.

A piece x(t) is X(t)/w(t) with X = sum w_i P_i B_i(t) and w = sum w_i B_i(t), t in [0, 1], where P_i are the control
points, w_i > 0 their weights and B_i the Bernstein polynomials of degree d; with equal weights it is polynomial.
Splines and ellipses become such pieces exactly (up to rounding).
"""

from __future__ import annotations

from functools import cached_property
from math import pi
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kin.numeric.bernstein import bernstein_product, cross_product, derivative, restrict, rising_root, roots, values
from kin.numeric.quadrature import gauss
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from kin.numeric.arrays import Array, Indices

# A hodograph vector below this part of the piece's longest one is rounding of a vanishing end derivative.
VANISHING = 1e-12
# A Bernstein coefficient below this part of its own terms' sizes is rounding, and has no sign.
SIGNLESS = 1e-13
# Halvings after which a piece that still turns too far is a cusp smaller than rounding.
CUSP_HALVINGS = 48
GAUSS_NODES = 16
# Halvings after which only the neighbourhood of a cusp is left, 2^-30 of the parameter.
LENGTH_HALVINGS = 30


class Unrolled(NamedTuple):
    """n parts whose tangents each turn one way by less than pi, and the row (n,) of the piece each was cut from."""

    pieces: Beziers
    row: Indices


@dataclass(frozen=True, eq=False)
class Beziers:
    """Bezier pieces of one degree d: control points (m, d+1, 2) in mm and positive weights (m, d+1)."""

    control: Array
    weight: Array

    @staticmethod
    def empty() -> Beziers:
        """Return no pieces at all (of degree 1)."""
        return Beziers(np.zeros((0, 2, 2)), np.ones((0, 2)))

    @staticmethod
    def joined(parts: list[Beziers]) -> Beziers:
        """All pieces of `parts`, in order, elevated to the highest degree, which leaves the curves as they are."""
        parts = [p for p in parts if p.count]
        if not parts:
            return Beziers.empty()
        degree = max(p.degree for p in parts)
        raised = [p.elevated(degree) for p in parts]
        return Beziers(np.concatenate([p.control for p in raised]), np.concatenate([p.weight for p in raised]))

    @staticmethod
    def from_ellipse(centre: Array, major: Array, minor: Array, first: float, last: float) -> Beziers:
        """Exact pieces of centre + major cos t + minor sin t, vectors (2,), for t from `first` to `last`, rad.

        The curve may run in either sense. Each piece spans at most a quarter turn: quadratic, with the middle weight
        cos(half its span).
        """
        count = max(1, int(np.ceil(abs(last - first) / (pi / 2.0) - 1e-12)))
        knots = np.linspace(first, last, count + 1)
        half = (last - first) / count / 2.0
        middle = (knots[:-1] + knots[1:]) / 2.0

        def at(t: Array, stretch: float) -> Array:
            points: Array = centre + (np.outer(np.cos(t), major) + np.outer(np.sin(t), minor)) * stretch
            return points

        control = np.stack([at(knots[:-1], 1.0), at(middle, 1.0 / np.cos(half)), at(knots[1:], 1.0)], axis=1)
        if abs(abs(last - first) - 2.0 * pi) < 1e-12:
            control[-1, -1] = control[0, 0]
        weight = np.tile([1.0, float(np.cos(half)), 1.0], (count, 1))
        return Beziers(control, weight)

    @staticmethod
    def from_spline(degree: int, knots: Array, control: Array, weight: Array) -> Beziers:
        """Return the polynomial or rational spans of a B-spline over its domain knots[d] .. knots[-d-1].

        knots (n+d+1,) not falling, none of them inside the domain more than d times, where the spline would have a gap;
        control (n, 2), weight (n,) positive.
        """
        homogeneous = np.concatenate([control * weight[:, None], weight[:, None]], axis=1)
        return Beziers.from_homogeneous(spans_of(degree, knots, homogeneous))

    @staticmethod
    def from_homogeneous(points: Array) -> Beziers:
        """Pieces with homogeneous control points (w x, w y, w), (m, d+1, 3)."""
        w = points[:, :, 2]
        if w.size and bool((w == w.flat[0]).all()) and w.flat[0] == 1.0:
            return Beziers(points[:, :, :2].copy(), w.copy())
        return Beziers(points[:, :, :2] / w[:, :, None], w.copy())

    @property
    def count(self) -> int:
        """Number of pieces."""
        return len(self.control)

    @property
    def degree(self) -> int:
        """Degree of every piece."""
        return int(self.control.shape[1]) - 1

    @cached_property
    def homogeneous(self) -> Array:
        """Homogeneous control points (w x, w y, w), (m, d+1, 3)."""
        return np.concatenate([self.control * self.weight[:, :, None], self.weight[:, :, None]], axis=2)

    @cached_property
    def rational(self) -> bool:
        """True if the weights of some piece differ."""
        return bool((self.weight != self.weight[:, :1]).any())

    @cached_property
    def velocity(self) -> Array:
        """Bernstein coefficients (m, k+1, 2) of a positive multiple of the derivative by t.

        It is the derivative itself (k = d-1) where all pieces are polynomials, else w^2 times it, X' w - X w'
        (k = 2d-1).
        """
        d = self.degree
        relative = self.control - self.control[:, :1]
        if not self.rational:
            return derivative(relative)
        w, dw = self.weight, d * np.diff(self.weight, axis=1)
        x = relative * w[:, :, None]
        dx = d * np.diff(x, axis=1)
        return np.stack(
            [bernstein_product(dx[:, :, c], w) - bernstein_product(x[:, :, c], dw) for c in (0, 1)],
            axis=2,
        )

    @cached_property
    def bend(self) -> Array:
        """Bernstein coefficients (m, d-1, 2) of the second derivative by t; for polynomials of degree >= 2 only."""
        return derivative(self.velocity)

    @cached_property
    def directions(self) -> tuple[Array, Array]:
        """Angles of the tangents at the starts and at the ends, rad (m,); a vanishing derivative takes its limit."""
        v = self.velocity
        size = np.hypot(v[:, :, 0], v[:, :, 1])
        alive = size > VANISHING * size.max(axis=1, keepdims=True, initial=0.0)
        rows = np.arange(self.count)
        first = v[rows, alive.argmax(axis=1)]
        last = v[rows, v.shape[1] - 1 - alive[:, ::-1].argmax(axis=1)]
        return np.arctan2(first[:, 1], first[:, 0]), np.arctan2(last[:, 1], last[:, 0])

    def elevated(self, degree: int) -> Beziers:
        """Return the same curves with control points of a higher degree; the pieces themselves for a lower one."""
        h = self.homogeneous
        while h.shape[1] - 1 < degree:
            d = h.shape[1]
            share = (np.arange(1, d) / d)[None, :, None]
            h = np.concatenate([h[:, :1], h[:, :-1] * share + h[:, 1:] * (1.0 - share), h[:, -1:]], axis=1)
        return self if degree <= self.degree else Beziers.from_homogeneous(h)

    def take(self, rows: Indices | NDArray[np.bool_]) -> Beziers:
        """Return the pieces of these rows."""
        return Beziers(self.control[rows], self.weight[rows])

    def turned_round(self, which: NDArray[np.bool_]) -> Beziers:
        """Return the same curves in the same order, the pieces of the mask (m,) run through backwards."""
        w = which[:, None]
        control = np.where(w[:, :, None], self.control[:, ::-1], self.control)
        return Beziers(control, np.where(w, self.weight[:, ::-1], self.weight))

    def part(self, a: Array, b: Array) -> Beziers:
        """Return the stretches [a, b] of the pieces, a and b (m,); at 0 and 1 the control point is kept to the bit."""
        h = restrict(self.homogeneous, a, b)
        out = Beziers.from_homogeneous(h)
        out.control[a == 0.0, 0] = self.control[a == 0.0, 0]
        out.control[b == 1.0, -1] = self.control[b == 1.0, -1]
        return out

    def point(self, rows: Indices, t: Array) -> Array:
        """Return points (n, 2) of the pieces `rows` at t (n,); exact at both ends."""
        origin = self.control[rows, 0]
        relative = self.control[rows] - origin[:, None]
        if self.rational:
            w = self.weight[rows]
            x = values(relative * w[:, :, None], t) / values(w, t)[:, None]
        else:
            x = values(relative, t)
        out: Array = np.where((t == 1.0)[:, None], self.control[rows, -1], origin + x)
        return out

    def derivative(self, rows: Indices, t: Array) -> Array:
        """Return derivatives (n, 2) by t of the pieces `rows` at t (n,)."""
        v = values(self.velocity[rows], t)
        if not self.rational:
            return v
        return v / values(self.weight[rows], t)[:, None] ** 2

    def rows(self, rows: Indices, t: Array) -> tuple[Array, Array, Array]:
        """Points, first and second derivatives by t, (n, 2), of polynomial pieces `rows` of degree >= 2 at t (n,)."""
        return self.point(rows, t), values(self.velocity[rows], t), values(self.bend[rows], t)

    def farthest(self, rows: Indices, theta: Array) -> Array:
        """Parameters t (n,) where x(t).u(theta) is greatest on pieces `rows` (n,) that turn one way by less than pi.

        u(theta) is the unit vector at the angle theta (n,), rad, which must lie in the range of the piece's normals:
        then the slope x'.u falls through zero at most once.
        """
        u = np.stack([np.cos(theta), np.sin(theta)], axis=1)
        slope = np.einsum("nkc,nc->nk", self.velocity[rows], u)
        return rising_root(-slope)

    def area_over_chords(self) -> float:
        """Sum of the signed areas between pieces and chords, mm^2, positive where a piece bulges to the chord's right.

        Gauss's rule gives it exactly for polynomials, else to rounding.
        """
        if not self.count:
            return 0.0
        # x . y' of degree 2d-1 needs d nodes; a rational piece of at most a half turn is smooth enough for 24 more.
        nodes, weights = gauss(self.degree + (24 if self.rational else 0))
        total = 0.0
        rows = np.arange(self.count)
        for x, w in zip((nodes + 1.0) / 2.0, weights / 2.0, strict=True):
            t = np.full(self.count, x)
            y = self.point(rows, t) - self.control[:, 0]
            v = self.derivative(rows, t)
            total += float(w) * float(np.sum(y[:, 0] * v[:, 1] - y[:, 1] * v[:, 0])) / 2.0
        return total

    @cached_property
    def lengths(self) -> Array:
        """Arc length of each piece, mm (m,).

        Gauss's rule is applied to halved parts until a part and its halves agree to 1e-13 of the piece's length.
        """
        nodes, weights = gauss(GAUSS_NODES)
        row, begin, step = np.arange(self.count), np.zeros(self.count), 1.0

        def integrals(row: Indices, begin: Array, step: float) -> Array:
            at = begin[:, None] + step * (nodes + 1.0) / 2.0
            v = self.derivative(np.repeat(row, GAUSS_NODES), at.ravel())
            speed: Array = np.hypot(v[:, 0], v[:, 1]).reshape(at.shape)
            return speed @ weights * (step / 2.0)

        # parts whose halves agree with them are done; the others are halved again
        total = np.zeros(self.count)
        coarse = integrals(row, begin, step)
        whole = coarse.copy()
        for _ in range(LENGTH_HALVINGS):
            step /= 2.0
            row2, begin2 = np.repeat(row, 2), np.stack([begin, begin + step], axis=1).ravel()
            fine = integrals(row2, begin2, step)
            done = np.abs(fine.reshape(-1, 2).sum(axis=1) - coarse) <= 1e-13 * whole[row]
            np.add.at(total, row[done], fine.reshape(-1, 2).sum(axis=1)[done])
            open_ = np.repeat(~done, 2)
            row, begin, coarse = row2[open_], begin2[open_], fine[open_]
        np.add.at(total, row, coarse)
        return total

    def unrolled(self) -> Unrolled:
        """Pieces cut at inflections and cusps, and halved until the tangent of each part turns by less than pi."""
        v = self.velocity
        if v.shape[1] == 1 or not self.count:
            return Unrolled(self, np.arange(self.count))
        bend = turning_numerator(v)
        low, high = bend.min(axis=1, initial=0.0), bend.max(axis=1, initial=0.0)
        # The Bernstein coefficients bound the curvature's numerator: without both signs there is no inflection.
        doubtful = (low < 0.0) & (high > 0.0)
        cuts: dict[int, list[float]] = {int(i): roots(bend[i]) for i in np.flatnonzero(doubtful)}
        rows = np.repeat(np.arange(self.count), [1 + len(cuts.get(i, ())) for i in range(self.count)])
        ends = [np.array([0.0, *cuts.get(i, ()), 1.0]) for i in range(self.count)] if cuts else []
        a = np.concatenate([e[:-1] for e in ends]) if cuts else np.zeros(self.count)
        b = np.concatenate([e[1:] for e in ends]) if cuts else np.ones(self.count)
        # Parts [a, b] of their rows that still turn too far are halved; `first` and `second` mark the new halves.
        for _ in range(CUSP_HALVINGS):
            whole = (a == 0.0) & (b == 1.0)
            parts = self.take(rows).part(a, b) if not bool(whole.all()) else self.take(rows)
            wide = ~parts.turns_little()
            if not bool(wide.any()):
                break
            again = np.repeat(np.arange(rows.size), np.where(wide, 2, 1))
            second = np.concatenate([[False], again[1:] == again[:-1]])
            first = np.concatenate([again[1:] == again[:-1], [False]])
            middle = ((a + b) / 2.0)[again]
            rows, a, b = rows[again], np.where(second, middle, a[again]), np.where(first, middle, b[again])
        if rows.size == self.count:
            return Unrolled(self, np.arange(self.count))
        cut = self.take(rows).part(a, b)
        # Parts of one piece meet to the last bit.
        same = rows[1:] == rows[:-1]
        cut.control[1:, 0][same] = cut.control[:-1, -1][same]
        return Unrolled(cut, rows)

    def turns_little(self) -> NDArray[np.bool_]:
        """Mask (m,) of pieces whose hodograph vectors all point along the chord: the tangent is within pi/2 of it."""
        chord = self.control[:, -1] - self.control[:, 0]
        forward = np.einsum("nkc,nc->nk", self.velocity, chord)
        size = np.abs(forward).max(axis=1, keepdims=True)
        return np.asarray((forward >= -SIGNLESS * size).all(axis=1) & (size[:, 0] > 0.0))


def turning_numerator(velocity: Array) -> Array:
    """Bernstein coefficients (m, 2k) of v x v', which has the curvature's sign; rounding is set to zero.

    `velocity` (m, k+1, 2) are the Bernstein coefficients of v.
    """
    change = derivative(velocity)
    bend = cross_product(velocity, change)
    scale = np.hypot(*np.moveaxis(velocity, 2, 0)).max(axis=1) * np.hypot(*np.moveaxis(change, 2, 0)).max(axis=1)
    return np.where(np.abs(bend) <= SIGNLESS * scale[:, None], 0.0, bend)


def spans_of(degree: int, knots: Array, control: Array) -> Array:
    """Bezier control points (m, d+1, k) of the spans of a B-spline with control points (n, k).

    knots (n+d+1,) not falling, none of them inside the domain more than d times. Each span's control points are the
    blossom's values at its two ends, found by de Boor's scheme with an argument of its own at every level.
    """
    n = control.shape[0]
    # spans of some width, and the d + 1 control points of each
    spans = np.flatnonzero(knots[degree:n] < knots[degree + 1 : n + 1]) + degree
    a, b = knots[spans], knots[spans + 1]
    local = control[spans[:, None] + np.arange(-degree, 1)]  # (spans, d+1, k)
    out: Array = np.empty_like(local)
    for j in range(degree + 1):
        d = local.copy()
        for level in range(1, degree + 1):
            x = b if level > degree - j else a
            low = knots[spans[:, None] + np.arange(level - degree, 1)]
            high = knots[spans[:, None] + np.arange(1, degree - level + 2)]
            s = ((x[:, None] - low) / (high - low))[:, :, None]
            d = d[:, :-1] * (1.0 - s) + d[:, 1:] * s
        out[:, j] = d[:, 0]
    out[1:, 0] = out[:-1, degree]
    return out
