"""Rational Bezier pieces, thousands at a time, as arrays of control points and weights.

A piece is X(t)/w(t) with X = sum w_i P_i B_i(t) and w = sum w_i B_i(t), t in [0, 1], all weights positive; equal weights
make it a polynomial piece. Splines and ellipses become such pieces exactly (up to rounding).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import comb, pi
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

__all__ = ["Beziers", "Unrolled", "bernstein", "bernstein_product", "halves", "restrict"]

Floats = NDArray[np.float64]
Ints = NDArray[np.intp]

# A hodograph vector below this part of the piece's longest one is rounding of a vanishing end derivative.
VANISHING = 1e-12
# A Bernstein coefficient below this part of its own terms' sizes is rounding, and has no sign.
SIGNLESS = 1e-13
# Halvings after which a piece that still turns too far is a cusp smaller than rounding.
CUSP_HALVINGS = 48


def bernstein(coefficients: Floats, t: Floats) -> Floats:
    """Values of Bernstein polynomials by de Casteljau: coefficients (n, k+1, ...), t (n,) -> (n, ...)."""
    s = t.reshape(t.shape + (1,) * (coefficients.ndim - 1))
    b = coefficients
    while b.shape[1] > 1:
        b = b[:, :-1] * (1.0 - s) + b[:, 1:] * s
    return b[:, 0]


def bernstein_product(f: Floats, g: Floats) -> Floats:
    """Bernstein coefficients of products, f (n, j+1) and g (n, k+1) -> (n, j+k+1)."""
    j, k = f.shape[1] - 1, g.shape[1] - 1
    out = np.zeros((f.shape[0], j + k + 1))
    for i in range(j + 1):
        weights = np.array([comb(j, i) * comb(k, m) / comb(j + k, i + m) for m in range(k + 1)])
        out[:, i : i + k + 1] += f[:, i : i + 1] * (g * weights)
    return out


def halves(coefficients: Floats) -> tuple[Floats, Floats]:
    """Coefficients (n, k+1, ...) over [0, 1/2] and over [1/2, 1]."""
    k = coefficients.shape[1]
    left, right = np.empty_like(coefficients), np.empty_like(coefficients)
    b = coefficients
    for level in range(k):
        left[:, level] = b[:, 0]
        right[:, k - 1 - level] = b[:, -1]
        b = (b[:, :-1] + b[:, 1:]) / 2.0
    return left, right


def restrict(coefficients: Floats, a: Floats, b: Floats) -> Floats:
    """Coefficients (n, k+1, ...) over the intervals [a, b] (n,) instead of [0, 1]."""
    shape = (a.size,) + (1,) * (coefficients.ndim - 1)
    right = coefficients.copy()
    s = a.reshape(shape)
    for level in range(1, coefficients.shape[1]):  # what lies right of a
        right[:, :-level] = right[:, :-level] * (1.0 - s) + right[:, 1 : right.shape[1] - level + 1] * s
    with np.errstate(invalid="ignore", divide="ignore"):
        s = np.where(a < 1.0, (b - a) / (1.0 - a), 0.0).reshape(shape)
    left = right.copy()
    for level in range(1, coefficients.shape[1]):  # and of that, what lies left of b
        left[:, level:] = left[:, level - 1 : -1] * (1.0 - s) + left[:, level:] * s
    return left


class Unrolled(NamedTuple):
    """Pieces cut where their tangent's sense of turning changes: `pieces`, and for each the row it was cut from (n,)."""

    pieces: Beziers
    row: Ints


@dataclass(frozen=True, eq=False)
class Beziers:
    """Bezier pieces of one degree d: control points (m, d+1, 2) in mm and positive weights (m, d+1)."""

    control: Floats
    weight: Floats

    @staticmethod
    def empty() -> Beziers:
        """Return no pieces at all (of degree 1)."""
        return Beziers(np.zeros((0, 2, 2)), np.ones((0, 2)))

    @staticmethod
    def joined(parts: list[Beziers]) -> Beziers:
        """Several sets in one, the lower degrees elevated to the highest (which leaves the curves as they are)."""
        parts = [p for p in parts if p.count]
        if not parts:
            return Beziers.empty()
        degree = max(p.degree for p in parts)
        raised = [p.elevated(degree) for p in parts]
        return Beziers(np.concatenate([p.control for p in raised]), np.concatenate([p.weight for p in raised]))

    @staticmethod
    def from_ellipse(centre: Floats, major: Floats, minor: Floats, first: float, last: float) -> Beziers:
        """Exact pieces of centre + major cos t + minor sin t for t from `first` to `last` (either sense), (2,) vectors.

        Each piece spans at most a quarter turn: quadratic, with the middle weight cos(half its span).
        """
        count = max(1, int(np.ceil(abs(last - first) / (pi / 2.0) - 1e-12)))
        knots = np.linspace(first, last, count + 1)
        half = (last - first) / count / 2.0
        middle = (knots[:-1] + knots[1:]) / 2.0

        def at(t: Floats, stretch: float) -> Floats:
            return centre + (np.outer(np.cos(t), major) + np.outer(np.sin(t), minor)) * stretch

        control = np.stack([at(knots[:-1], 1.0), at(middle, 1.0 / np.cos(half)), at(knots[1:], 1.0)], axis=1)
        if abs(abs(last - first) - 2.0 * pi) < 1e-12:
            control[-1, -1] = control[0, 0]
        weight = np.tile([1.0, float(np.cos(half)), 1.0], (count, 1))
        return Beziers(control, weight)

    @staticmethod
    def from_spline(degree: int, knots: Floats, control: Floats, weight: Floats) -> Beziers:
        """The polynomial (or rational) spans of a B-spline over its domain knots[d] .. knots[-d-1].

        knots (n+d+1,) not falling, control (n, 2), weight (n,) positive. Each span's control points are the blossom's
        values at its two ends, found by de Boor's scheme with an argument of its own at every level.
        """
        n = control.shape[0]
        spans = np.flatnonzero(knots[degree:n] < knots[degree + 1 : n + 1]) + degree
        a, b = knots[spans], knots[spans + 1]
        homogeneous = np.concatenate([control * weight[:, None], weight[:, None]], axis=1)
        local = homogeneous[spans[:, None] + np.arange(-degree, 1)]  # (spans, d+1, 3)
        out = np.empty_like(local)
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
        return Beziers.from_homogeneous(out)

    @staticmethod
    def from_homogeneous(points: Floats) -> Beziers:
        """Pieces from (m, d+1, 3) arrays of (w x, w y, w)."""
        w = points[:, :, 2]
        if w.size and bool((w == w.flat[0]).all()) and w.flat[0] == 1.0:
            return Beziers(points[:, :, :2].copy(), w.copy())
        return Beziers(points[:, :, :2] / w[:, :, None], w.copy())

    @property
    def count(self) -> int:
        """Number of pieces."""
        return self.control.shape[0]

    @property
    def degree(self) -> int:
        """Degree of every piece."""
        return self.control.shape[1] - 1

    @cached_property
    def homogeneous(self) -> Floats:
        """(w x, w y, w), (m, d+1, 3)."""
        return np.concatenate([self.control * self.weight[:, :, None], self.weight[:, :, None]], axis=2)

    @cached_property
    def rational(self) -> bool:
        """True if the weights of some piece differ."""
        return bool((self.weight != self.weight[:, :1]).any())

    @cached_property
    def velocity(self) -> Floats:
        """Bernstein coefficients (m, k+1, 2) of a positive multiple of the derivative by t.

        The derivative itself (k = d-1) where all pieces are polynomials, else the numerator X' w - X w' (k = 2d-1).
        """
        d = self.degree
        relative = self.control - self.control[:, :1]
        if not self.rational:
            return d * np.diff(relative, axis=1)
        w, dw = self.weight, d * np.diff(self.weight, axis=1)
        x = relative * w[:, :, None]
        dx = d * np.diff(x, axis=1)
        return np.stack(
            [bernstein_product(dx[:, :, c], w) - bernstein_product(x[:, :, c], dw) for c in (0, 1)],
            axis=2,
        )

    @cached_property
    def directions(self) -> tuple[Floats, Floats]:
        """Directions of the tangent at both ends, 2 x (m,) radians; a vanishing end derivative takes its limit."""
        v = self.velocity
        size = np.hypot(v[:, :, 0], v[:, :, 1])
        alive = size > VANISHING * size.max(axis=1, keepdims=True, initial=0.0)
        rows = np.arange(self.count)
        first = v[rows, alive.argmax(axis=1)]
        last = v[rows, v.shape[1] - 1 - alive[:, ::-1].argmax(axis=1)]
        return np.arctan2(first[:, 1], first[:, 0]), np.arctan2(last[:, 1], last[:, 0])

    def elevated(self, degree: int) -> Beziers:
        """The same curves with control points of a higher degree."""
        h = self.homogeneous
        while h.shape[1] - 1 < degree:
            d = h.shape[1]
            share = (np.arange(1, d) / d)[None, :, None]
            h = np.concatenate([h[:, :1], h[:, :-1] * share + h[:, 1:] * (1.0 - share), h[:, -1:]], axis=1)
        return self if degree <= self.degree else Beziers.from_homogeneous(h)

    def take(self, rows: Ints | NDArray[np.bool_]) -> Beziers:
        """Return the pieces of these rows."""
        return Beziers(self.control[rows], self.weight[rows])

    def turned_round(self) -> Beziers:
        """The same curves run through backwards."""
        return Beziers(self.control[:, ::-1].copy(), self.weight[:, ::-1].copy())

    def part(self, a: Floats, b: Floats) -> Beziers:
        """Return the stretches [a, b] of the pieces, a and b (m,); ends at 0 and 1 keep their control points to the bit."""
        h = restrict(self.homogeneous, a, b)
        out = Beziers.from_homogeneous(h)
        out.control[a == 0.0, 0] = self.control[a == 0.0, 0]
        out.control[b == 1.0, -1] = self.control[b == 1.0, -1]
        return out

    def point(self, rows: Ints, t: Floats) -> Floats:
        """Return points (n, 2) of the pieces `rows` at t (n,); exact at both ends."""
        origin = self.control[rows, 0]
        relative = self.control[rows] - origin[:, None]
        w = self.weight[rows]
        x = bernstein(relative * w[:, :, None], t) / bernstein(w, t)[:, None]
        return np.where((t == 1.0)[:, None], self.control[rows, -1], origin + x)

    def derivative(self, rows: Ints, t: Floats) -> Floats:
        """Return derivatives (n, 2) by t of the pieces `rows` at t (n,)."""
        v = bernstein(self.velocity[rows], t)
        if not self.rational:
            return v
        return v / bernstein(self.weight[rows], t)[:, None] ** 2

    def farthest(self, rows: Ints, theta: Floats) -> Floats:
        """Parameters t (n,) where x(t).u(theta) is greatest, for pieces that turn one way by less than pi.

        The slope x'.u falls through zero at most once on such a piece when theta lies in its normals' range: Newton's
        steps, kept inside a shrinking bracket.
        """
        u = np.stack([np.cos(theta), np.sin(theta)], axis=1)
        slope = np.einsum("nkc,nc->nk", self.velocity[rows], u)
        bend = (slope.shape[1] - 1) * np.diff(slope, axis=1) if slope.shape[1] > 1 else np.zeros((rows.size, 1))
        low, high = np.zeros(rows.size), np.ones(rows.size)
        with np.errstate(invalid="ignore", divide="ignore"):
            t = slope[:, 0] / (slope[:, 0] - slope[:, -1])
        t = np.where((t > 0.0) & (t < 1.0), t, 0.5)
        for _ in range(80):
            g = bernstein(slope, t)
            low, high = np.where(g > 0.0, t, low), np.where(g > 0.0, high, t)
            with np.errstate(invalid="ignore", divide="ignore"):
                following = t - g / bernstein(bend, t)
            inside = (following > low) & (following < high)
            following = np.where(inside, following, (low + high) / 2.0)
            moved = np.abs(following - t)
            t = following
            if not bool((moved > 4e-16).any()):
                break
        return np.clip(t, 0.0, 1.0)

    def area_over_chords(self) -> float:
        """Area between the pieces and their chords, mm^2: Gauss's rule, exact for polynomials, to rounding for the others."""
        if not self.count:
            return 0.0
        # x . y' of degree 2d-1 needs d nodes; a rational piece of at most a half turn is smooth enough for 24 more.
        nodes, weights = np.polynomial.legendre.leggauss(self.degree + (24 if self.rational else 0))
        total = 0.0
        rows = np.arange(self.count)
        for x, w in zip((nodes + 1.0) / 2.0, weights / 2.0, strict=True):
            t = np.full(self.count, x)
            y = self.point(rows, t) - self.control[:, 0]
            v = self.derivative(rows, t)
            total += float(w) * float(np.sum(y[:, 0] * v[:, 1] - y[:, 1] * v[:, 0])) / 2.0
        return total

    def unrolled(self) -> Unrolled:
        """Pieces cut at their inflections and cusps, so that each one's tangent turns one way, by less than pi."""
        v = self.velocity
        if v.shape[1] == 1 or not self.count:
            return Unrolled(self, np.arange(self.count))
        bend = turning_numerator(v)
        low, high = bend.min(axis=1, initial=0.0), bend.max(axis=1, initial=0.0)
        both = (low < 0.0) & (high > 0.0)
        cuts: dict[int, list[float]] = {int(i): roots(bend[i]) for i in np.flatnonzero(both)}
        rows = np.repeat(np.arange(self.count), [1 + len(cuts.get(i, ())) for i in range(self.count)])
        ends = [np.array([0.0, *cuts.get(i, ()), 1.0]) for i in range(self.count)] if cuts else []
        a = np.concatenate([e[:-1] for e in ends]) if cuts else np.zeros(self.count)
        b = np.concatenate([e[1:] for e in ends]) if cuts else np.ones(self.count)
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
        same = rows[1:] == rows[:-1]
        cut.control[1:, 0][same] = cut.control[:-1, -1][same]
        return Unrolled(cut, rows)

    def turns_little(self) -> NDArray[np.bool_]:
        """True (m,) where every hodograph vector points forward along the chord: the tangent stays within pi/2 of it."""
        chord = self.control[:, -1] - self.control[:, 0]
        forward = np.einsum("nkc,nc->nk", self.velocity, chord)
        size = np.abs(forward).max(axis=1, keepdims=True)
        return np.asarray((forward >= -SIGNLESS * size).all(axis=1) & (size[:, 0] > 0.0))


def turning_numerator(velocity: Floats) -> Floats:
    """Bernstein coefficients (m, 2k) of v x v', whose sign is that of the curvature; rounding is set to zero."""
    k = velocity.shape[1] - 1
    x, y = velocity[:, :, 0], velocity[:, :, 1]
    dx, dy = k * np.diff(x, axis=1), k * np.diff(y, axis=1)
    bend = bernstein_product(x, dy) - bernstein_product(y, dx)
    scale = np.hypot(x, y).max(axis=1) * np.hypot(dx, dy).max(axis=1)
    return np.where(np.abs(bend) <= SIGNLESS * scale[:, None], 0.0, bend)


def roots(coefficients: Floats) -> list[float]:
    """Where a Bernstein polynomial (k+1,) changes sign inside (0, 1), rising; a touching root may be listed too.

    The number of sign changes of the coefficients bounds the number of roots (variation diminishing): none or one is
    decided at once, more are halved.
    """
    found: list[float] = []
    stack = [(coefficients, 0.0, 1.0)]
    while stack:
        c, a, b = stack.pop()
        signs = np.sign(c[c != 0.0])
        changes = int(np.count_nonzero(signs[1:] != signs[:-1]))
        if changes == 0:
            continue
        if b - a < 2e-16 or (changes > 1 and b - a < 1e-9):
            found.append((a + b) / 2.0)
            continue
        left, right = halves(c[None])
        if left[0, -1] == 0.0:
            found.append((a + b) / 2.0)
        stack.append((right[0], (a + b) / 2.0, b))
        stack.append((left[0], a, (a + b) / 2.0))
    return sorted({t for t in found if 1e-12 < t < 1.0 - 1e-12})
