"""Cubic spans between two points of a curve, or of a parallel beside it: the handles of least deviation.

Points and directions are complex numbers here, x + iy.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from camgeo.fit.cubic import nearest_cubic
from camgeo.fit.spans import plane
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from camgeo.curve.curve import Curve
    from camgeo.fit.spans import Complex
    from kin.numeric.arrays import Array

PLACES = np.array([0.1, 0.26, 0.5, 0.74, 0.9])  # of a span: least squares there make its error equal to both sides
MOST_LEAN = 0.6  # share by which the handles of the first guess may differ from a circular arc's
LOOKS = 16  # steps of a span at which its error is sampled
ROUNDS = 4  # of sampling the curve at the feet of the places,
NEAR = 0.01  # of a span's length: feet that moved by less are not sampled again
HANDLE_STEPS = 4  # for each round
ENOUGH = 0.003  # of a span's error: handles that would change it by less are settled
STEP = 0.3  # greatest change of a handle's logarithm in one step
SHORTEST, LONGEST = 0.1, 2.5  # handles, times a third of the chord: beyond, a span nearly folds
FIRST_DAMPING = 1e-5  # of the equations, times their trace
LIGHTER, HEAVIER = 0.1, 30.0  # times the damping, after a step that lessens the error and one that does not
HUMP = 0.2  # weight of the humps where the span keeps to a parallel


def _weights(u: Array) -> tuple[Array, Array]:
    """Bernstein weights of a span's two inner control points at u."""
    return 3.0 * u * (1.0 - u) ** 2, 3.0 * u**2 * (1.0 - u)


def _without_humps() -> Array:
    """Projection (m, m) of distances at `PLACES` that removes most of the humps (x (x^2 - 1))^2."""
    x = 2.0 * PLACES - 1.0
    hump = (x * (x * x - 1.0)) ** 2
    freed: Array = np.eye(x.size) - (1.0 - HUMP) * hump[:, None] * hump / np.sum(hump * hump)
    return freed


def _interpolation() -> tuple[Array, Array]:
    """Places in a span at which its error is sampled, and the matrix that interpolates there from 0, `PLACES` and 1."""
    known = np.concatenate([[0.0], PLACES, [1.0]])
    u = np.linspace(0.0, 1.0, LOOKS + 1)[1:-1]
    # Lagrange's polynomials: 1 at their own place, 0 at the remaining ones
    remaining = [np.delete(known, i) for i in range(known.size)]
    rows = [np.prod((u[:, None] - zeros) / (own - zeros), axis=1) for own, zeros in zip(known, remaining, strict=True)]
    return u, np.array(rows)


WITHOUT_HUMPS = _without_humps()
SAMPLED_AT, INTERPOLATION = _interpolation()


@dataclass(frozen=True)
class Spans:
    """Spans over parameters [low, high] (n,): end points, mm, and unit tangents at both ends, complex (n,)."""

    low: Array
    high: Array
    start: Complex
    leaving: Complex
    end: Complex
    arriving: Complex

    def take(self, rows: NDArray[np.intp]) -> Spans:
        """The spans at the indices `rows`."""
        return Spans(*(getattr(self, name)[rows] for name in self.__dataclass_fields__))

    def control(self, handles: Array) -> Array:
        """Bezier points (n, 4, 2), mm, with handles (n, 2), mm, the lengths at the start and at the end."""
        first, last = self.start + handles[:, 0] * self.leaving, self.end - handles[:, 1] * self.arriving
        points = np.stack([self.start, first, last, self.end], axis=1)
        control: Array = points.view(np.float64).reshape(-1, 4, 2)
        return control


def cubic_spans(curve: Curve, low: Array, high: Array, out: float) -> tuple[Array, Array, Array]:
    """Cubic spans (n, 4, 2) over parameters from `low` to `high` (n,), between points `out` mm outside the curve.

    With them come the greatest sampled distances, mm (n,), of each from the curve and from the parallel through its
    ends. Handles are sought from two guesses, as their equations may have more than one solution; the closer span is
    taken. Raises DomainError where the curve stands still in the middle of an interval.
    """
    a, b = curve.span(low, high)
    leaving, arriving = plane(a.tangent), plane(b.tangent)
    start, end = plane(a.point) - 1j * out * leaving, plane(b.point) - 1j * out * arriving
    chord = np.abs(end - start)
    # handles of a circular arc with these ends, and the lean by which the nearest cubic's handles differ
    third = chord * 2.0 / (3.0 * (1.0 + np.maximum(0.5 * np.abs(leaving + arriving), 1e-6)))
    speed, turn = curve.shape.series(0.5 * (low + high), 4)
    lean = np.clip(np.nan_to_num(nearest_cubic(speed, turn).lean) * chord, -MOST_LEAN, MOST_LEAN)
    leaning = np.column_stack([third * (1.0 - lean), third * (1.0 + lean)])
    spans = Spans(low, high, start, leaving, end, arriving)
    twice = np.tile(np.arange(low.size), 2)
    guess = np.concatenate([leaning, np.column_stack([third, third])])
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        # at a cusp nothing is finite: the error is unknown, and the span is divided
        handles, t, size = fit_handles(curve, spans.take(twice), guess, out)
        first = np.nan_to_num(size.reshape(2, -1), nan=np.inf)
        chosen = np.argmin(first, axis=0) * low.size + np.arange(low.size)
        gap = sampled_gap(curve, spans, handles[chosen], t[chosen])
    # a span is no farther off than it and its stretch of the curve are long, even where its directions are rounding
    most = 4.0 * (chord + np.maximum(a.speed, b.speed) * (high - low))
    strayed, beside = (np.abs(part).max(axis=1) for part in (gap, gap - out))
    return spans.control(handles[chosen]), np.fmin(strayed, abs(out) + most), np.fmin(beside, most)


@dataclass(frozen=True)
class _Near:
    """Points of spans seen from the curve near their feet at t (n, m): ``offset + first h0 - second h1``, complex.

    h0 and h1 are the handles. The real part is along the curve's tangent, the imaginary part to its left, mm.
    """

    t: Array
    speed: Array
    curvature: Array
    slope: Array
    offset: Complex
    first: Complex
    second: Complex

    @staticmethod
    def of(curve: Curve, spans: Spans, u: Array, t: Array) -> _Near:
        """Points of spans at u (m,), seen from the curve at t (n, m)."""
        frames = curve.sample(t.ravel())
        along = plane(frames.tangent).conj().reshape(t.shape)
        first, second = _weights(u)
        share = u * u * (3.0 - 2.0 * u)
        base = spans.start[:, None] + share * (spans.end - spans.start)[:, None]
        return _Near(
            t,
            frames.speed.reshape(t.shape),
            frames.curvature.reshape(t.shape),
            frames.curvature_slope.reshape(t.shape),
            (base - plane(frames.point).reshape(t.shape)) * along,
            first * spans.leaving[:, None] * along,
            second * spans.arriving[:, None] * along,
        )

    def gaps(self, handles: Array) -> tuple[Array, Array, Array, Array]:
        """Distance outside the curve with handles (n, 2), its gradient along and outward, and the feet's offset (n, m).

        They follow from the circle of curvature and the slope of the curvature; the error is of the fourth power of the
        offset. Lengths are mm.
        """
        points = self.offset + handles[:, :1] * self.first - handles[:, 1:] * self.second
        x, y = points.real, -points.imag
        up, across = 1.0 + self.curvature * y, self.curvature * x
        root = np.hypot(up, across)
        foot = x / np.maximum(up, 1e-3)
        gap = (2.0 * y + self.curvature * (x * x + y * y)) / (1.0 + root) + self.slope * foot**3 / 6.0
        return gap, across / root, up / root, foot


def fit_handles(curve: Curve, spans: Spans, handles: Array, out: float) -> tuple[Array, Array, Array]:
    """Handles (n, 2), mm, of the spans nearest to the curve by least squares at `PLACES`, from a guess `handles`.

    With them come the parameters of the places' feet (n, m) and the sum of squares (n,), mm^2. Where the ends lie `out`
    mm outside the curve, a span is to keep to the parallel there, and the humps on both sides of its middle, which
    reach as far beyond the curve, hardly count. The method is Levenberg's and Marquardt's in the handles' logarithms:
    near places where the nearest cubic ceases to exist the equations have no solution. Handles need not be the best, as
    each span is proved.
    """
    width = spans.high - spans.low
    low, high = spans.low[:, None], spans.high[:, None]
    near = _Near.of(curve, spans, PLACES, low + width[:, None] * PLACES)
    third = np.abs(spans.end - spans.start)[:, None] / 3.0
    size = np.zeros(len(handles))
    for number in range(ROUNDS):
        foot = near.gaps(handles)[3]
        t = np.clip(near.t + foot / np.maximum(near.speed, 1e-300), low, high)
        if number > 1 and not (np.abs(t - near.t).max(axis=1) > NEAR * width).any():
            break
        near = _Near.of(curve, spans, PLACES, t)
        handles, size = _improve_handles(near, handles, third, out)
    return handles, t, size


def _improve_handles(near: _Near, handles: Array, third: Array, out: float) -> tuple[Array, Array]:
    """Handles (n, 2) of less deviation by the expansion near the feet, and the sum of squares (n,)."""

    def gaps_and_gain(handles: Array) -> tuple[Array, Complex]:
        gap, along, outward, _ = near.gaps(handles)
        slope = along + 1j * outward
        first, second = (slope * near.first).real * handles[:, :1], (slope * near.second).real * handles[:, 1:]
        gain: Complex = first - 1j * second
        if out:
            gap, gain = (gap - out) @ WITHOUT_HUMPS, gain @ WITHOUT_HUMPS
        return gap, gain

    # the two columns of the gain, derivatives by the handles' logarithms, are one complex number: half as many sums
    gap, gain = gaps_and_gain(handles)
    size = (gap * gap).sum(axis=1)
    damping = np.full(len(handles), FIRST_DAMPING)
    for _ in range(HANDLE_STEPS):
        difference, product = (gain * gain).sum(axis=1), (gain * gap).sum(axis=1)
        trace = (gain.real**2 + gain.imag**2).sum(axis=1)
        # of the matrix (a b; b c) of the normal equations: a + c, and a - c + 2 i b
        whole = trace * (1.0 + 2.0 * damping) + 1e-300
        change = 2.0 * (whole * product - difference * product.conj()) / (whole**2 - np.abs(difference) ** 2)
        moved = (gain * change[:, None].conj()).real
        if not ((moved * moved).sum(axis=1) > ENOUGH**2 * size).any():
            break
        step = np.clip(np.stack([change.real, change.imag], axis=1), -STEP, STEP)
        tried = np.clip(handles * np.exp(-step), SHORTEST * third, LONGEST * third)
        gap_, gain_ = gaps_and_gain(tried)
        size_ = (gap_ * gap_).sum(axis=1)
        # steps that lessen the error are kept, and damped less the next time
        better = size_ < size
        row = better[:, None]
        handles, gap, gain = np.where(row, tried, handles), np.where(row, gap_, gap), np.where(row, gain_, gain)
        size = np.where(better, size_, size)
        damping = np.where(better, LIGHTER * damping, HEAVIER * damping)
    return handles, size


def sampled_gap(curve: Curve, spans: Spans, handles: Array, t: Array) -> Array:
    """Sampled distance of n cubic spans outside the curve, mm, at `LOOKS` - 1 places in each: (n, LOOKS - 1).

    `handles` (n, 2) are in mm; `t` (n, 5) are the curve's parameters at the feet of the spans' `PLACES`.
    """
    known = np.column_stack([spans.low, t, spans.high])
    feet = np.clip(known @ INTERPOLATION, spans.low[:, None], spans.high[:, None])
    gap: Array = _Near.of(curve, spans, SAMPLED_AT, feet).gaps(handles)[0]
    return gap
