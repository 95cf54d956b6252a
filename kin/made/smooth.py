"""Smooth periodic curves through noisy points: quintic splines by least squares, their spans, noise and covariance.

On N equal spans of a turn the curve is sum c_j B(u - j), B the quintic B-spline, u = N t/(2 pi): four times
continuously differentiable, local, and linear in its coefficients c. These solve banded normal equations. The number of
spans is that of the least generalised cross-validation n RSS/(n - N)^2 (Craven and Wahba 1979): the trace of the
projection on a spline space is its dimension N. The covariance is that of the points as they lie, sigma^2 (B^T B)^-1.
"""

from __future__ import annotations

import math
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from kin.numeric.angles import TURN, degrees
from kin.numeric.errors import CamgeoError
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from kin.numeric.arrays import Array, Indices

DEGREE = 5
WIDTH = DEGREE + 1
LEAST_SPANS = 12  # twice the width of a spline
MOST_SPANS = 1440  # a quarter of a degree: what a probe's ball lets through; keeps the normal equations small
POINTS_A_SPAN = 5  # at least, on average
WIDEST_GAP = 2.0  # spans without a point, above which the curve between is invented
BLOCK = 40  # coefficients that are eliminated at once, more than the band is wide
GROSS = 3.0  # times the bound: outliers that are left out before there is a curve
LADDER = 1.35  # ratio of the numbers of spans that are tried
FINER = 1.09  # ratio of those beside the best
OUTLIER = 4.5  # standard deviations: the least by which an outlier stands out
FALSE = 0.005  # of sets of points, however many, in normal noise without outliers, one is found: 4.5 of 735 points
MAD = 1.4826  # standard deviations of normal noise in its median absolute deviation
FELLOWS = 2  # points beside one another: more that stand out together are a fault of the part, not of the measurement
MOST_STRAYS = 0.05  # of the values
ROUNDS = 12  # of leaving out outliers
TRIFLE = 1e-5  # mm: less than this no instrument tells, so that no point is an outlier by it
CORRELATED = 2.0  # standard deviations 1/sqrt(n) of the lag-1 correlation of white noise


class GapError(CamgeoError, ValueError):
    """Points with a gap so wide that no curve may bridge it."""


class SpansError(CamgeoError, ValueError):
    """A number of spans that is below the least, or more than the points permit."""


def _basis() -> Array:
    """Coefficients (6, 6) by powers of the place in a span, [0, 1); row m has the m-th of the six splines there."""
    rows = [np.array([1.0])]
    for d in range(1, WIDTH):
        before, rows = rows, []
        for m in range(d + 1):
            row = np.zeros(d + 1)
            if m > 0:
                row += np.append(0.0, before[m - 1]) / d - (m - d) / d * np.append(before[m - 1], 0.0)
            if m < d:
                row += (m + 1) / d * np.append(before[m], 0.0) - np.append(0.0, before[m]) / d
            rows.append(row)
    return np.stack(rows)


BASIS = _basis()


@dataclass(frozen=True, eq=False)
class Smooth:
    """A fitted curve over a turn, mm over radians.

    coefficients (N,)  of the splines
    sigma              standard deviation of the points' noise, mm; 0 for points without any
    widened            factor by which correlated residuals widen every standard deviation, 1 for white ones
    factor (N, N)      inverse of the normal matrix: the covariance over sigma^2
    """

    coefficients: Array
    sigma: float
    widened: float
    factor: Array

    @property
    def spans(self) -> int:
        """Number of spans N of the turn."""
        return len(self.coefficients)

    @property
    def pieces(self) -> Array:
        """Coefficients (6, N) of the polynomial on each span, lowest first, by the place in it from 0 to 1."""
        return _pieces(self.coefficients)

    def times(self, factor: float) -> Smooth:
        """The curve with values and standard deviations times a factor."""
        return replace(self, coefficients=factor * self.coefficients, sigma=abs(factor) * self.sigma)

    @staticmethod
    def total(curves: Sequence[Smooth]) -> Smooth:
        """Sum of curves on the same spans, fitted to independent sets of points; their variances add."""
        factor = sum((curve.widened * curve.sigma) ** 2 * curve.factor for curve in curves)
        return Smooth(np.sum([curve.coefficients for curve in curves], axis=0), 1.0, 1.0, np.asarray(factor))

    def rows(self, t: Array, order: int = 0) -> Array:
        """Value, mm, and its derivatives by the parameter at parameters t (n,), up to `order`: (order + 1, n)."""
        place, span = _place(t, self.spans)
        index = (span + np.arange(WIDTH)[:, None]) % self.spans
        c = self.coefficients[index]
        rows: Array = np.stack([(c * _values(place, q, self.spans)).sum(axis=0) for q in range(order + 1)])
        return rows

    def standard_deviations(self, t: Array, order: int = 0) -> Array:
        """Standard deviation (n,) of the curve's derivative of an order at parameters t (n,), mm/rad^order."""
        place, span = _place(t, self.spans)
        index = (span + np.arange(WIDTH)[:, None]) % self.spans
        values = _values(place, order, self.spans)
        square = np.zeros(len(place))
        for a in range(WIDTH):
            for b in range(a, WIDTH):
                square += (1 + (b > a)) * values[a] * values[b] * self.factor[index[a], index[b]]
        deviations: Array = self.widened * self.sigma * np.sqrt(np.maximum(square, 0.0))
        return deviations

    def deviation_of_sum(self, t: Array, weights: Array) -> float:
        """Standard deviation of the sum of the curve's values at t (n,), rad, each times its weight (n,)."""
        place, span = _place(t, self.spans)
        index = (span + np.arange(WIDTH)[:, None]) % self.spans
        row = np.bincount(index.ravel(), (weights * _values(place, 0, self.spans)).ravel(), self.spans)
        return self.widened * self.sigma * math.sqrt(max(float(row @ self.factor @ row), 0.0))


@dataclass(frozen=True, eq=False)
class SmoothFit:
    """A smooth curve, and how the points lie about it.

    curve             the curve
    residuals (n,)    of all points, mm
    outliers (n,)     whether a point is left out
    correlation       lag-1 correlation of the residuals, from -1 to 1
    """

    curve: Smooth
    residuals: Array
    outliers: NDArray[np.bool_]
    correlation: float

    @property
    def worst(self) -> Indices:
        """Indices (k,) of the outliers, that of the greatest residual first."""
        out = np.flatnonzero(self.outliers)
        return out[np.argsort(-np.abs(self.residuals[out]), kind="stable")]


def fit(t: Array, e: Array, spans: int | None = None) -> SmoothFit:
    """Fit a smooth curve to values e (n,), mm, at parameters t (n,), rad; outliers are left out.

    `spans` is the number of spans, by default chosen by cross-validation. It is from 12 to n/5, and at most MOST_SPANS;
    12 are always permitted. Raises GapError where a gap is above two of 12 spans, or of the given number, and
    SpansError for a given number out of that range.
    """
    order = np.argsort(np.mod(t, TURN), kind="stable")
    angle, value = np.mod(t, TURN)[order], e[order]
    left_in, number, at_rest = ~_gross(value), 0, True
    for _ in range(ROUNDS):
        kept = left_in
        system = _Points(angle[kept], value[kept], len(angle))
        if at_rest or number > system.most:  # a choice takes as long as twenty curves: not for every set of outliers
            number, chosen_for = system.chosen(spans), kept
        coefficients = system.solved(number)
        residuals = value - _evaluated(coefficients, angle)
        left_in = ~_standing_out(residuals, kept)
        at_rest = bool((left_in == kept).all())
        if at_rest and (kept == chosen_for).all():
            break
    # noise by the residuals' degrees of freedom; residuals of an autoregressive process widen it by (1 + r)/(1 - r)
    count = int(kept.sum())
    left = residuals[kept]
    white = float(left @ left)
    sigma = math.sqrt(white / (count - len(coefficients)))
    correlation = float(left @ np.roll(left, -1)) / white if white > 0.0 else 0.0
    above = correlation if correlation > CORRELATED / math.sqrt(count) and sigma > TRIFLE else 0.0
    widened = math.sqrt((1.0 + above) / (1.0 - above))
    back = np.empty_like(order)
    back[order] = np.arange(len(order))
    curve = Smooth(coefficients, sigma, widened, system.inverse(len(coefficients)))
    return SmoothFit(curve, residuals[back], ~kept[back], correlation)


def _off_neighbours(value: Array) -> Array:
    """By how much values (n,) in order round a turn stand off the median of those beside each, (n,).

    On a slope that is nothing, however they scatter; a value that stands out alone or in a pair shows whole.
    """
    beside = np.stack([np.roll(value, k) for k in range(-FELLOWS - 1, FELLOWS + 2)])
    off: Array = np.abs(value - np.median(beside, axis=0))
    return off


def strays(t: Array, e: Array, far: float) -> NDArray[np.bool_]:
    """Whether values e (n,) at parameters t (n,), rad, are strays: farther than `far` from 0, where nearly all are not.

    Where more are, strays stand off those beside them by as much, alone or in pairs. More than a twentieth are none:
    nothing tells which of the values are right.
    """
    stray = np.abs(e) > far
    if stray.sum() > MOST_STRAYS * len(e):
        order = np.argsort(np.mod(t, TURN), kind="stable")
        stray[order] = _off_neighbours(e[order]) > far
    return stray if stray.sum() <= MOST_STRAYS * len(e) else np.zeros_like(stray)


def _gross(value: Array) -> NDArray[np.bool_]:
    """Points that stand out from the median of those beside them, before there is a curve, which they would bend."""
    off = _off_neighbours(value)
    scatter = float(np.median(np.abs(value - 0.5 * (np.roll(value, 1) + np.roll(value, -1)))))
    gross: NDArray[np.bool_] = off > max(GROSS * _bound(len(value)) * MAD * scatter, TRIFLE)
    return gross


def _bound(count: int) -> float:
    """Standard deviations by which an outlier of `count` points stands out: hardly ever passed in normal noise."""
    from statistics import NormalDist

    return max(OUTLIER, NormalDist().inv_cdf(1.0 - 0.5 * FALSE / count))


def _standing_out(residuals: Array, kept: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Points (n,) that stand out alone or in pairs; of those kept until now only the worst among its neighbours.

    The others may stand out because it bends the curve. A point that was left out and does not stand out any more comes
    back.
    """
    middle = np.median(residuals[kept])
    size = np.abs(residuals - middle)
    far = size > max(_bound(len(size)) * MAD * float(np.median(size[kept])), TRIFLE)
    if not far.any() or far.all():
        return far
    turn = -int(np.flatnonzero(~far)[0])  # a run of them may pass the turn's zero
    state = np.roll(far * np.sign(residuals - middle), turn)
    run = np.cumsum(np.diff(state, prepend=state[:1]) != 0.0)
    alone: NDArray[np.bool_] = far & (np.roll(np.bincount(run)[run], -turn) <= FELLOWS)
    worst = alone.copy()
    inside = np.where(kept, size, 0.0)
    for k in (*range(-WIDTH, 0), *range(1, WIDTH + 1)):
        worst &= size >= np.roll(inside, k)
    return alone & (worst | ~kept)


class _Points:
    """Points in order of their parameters (n,), and the normal equations of splines through them."""

    def __init__(self, angle: Array, value: Array, count: int) -> None:
        """Take the kept ones of `count` points; find their widest gap, rad, and the most spans by number and by gap."""
        self.angle, self.value, self.count = angle, value, count
        gaps = np.diff(angle, append=angle[:1] + TURN)
        self.widest = int(np.argmax(gaps))
        self.gap = float(gaps[self.widest])
        self.enough = min(max(count // POINTS_A_SPAN, LEAST_SPANS), MOST_SPANS)
        self.most = max(min(self.enough, int(WIDEST_GAP * TURN / self.gap)), LEAST_SPANS)

    def chosen(self, spans: int | None) -> int:
        """Number of spans: the given one, else that of the least cross-validation.

        Raises SpansError for a given number that is too small, or too large for the points, GapError for a gap above
        two spans.
        """
        if spans is not None:
            if not LEAST_SPANS <= spans <= self.enough:
                range_ = f"from {LEAST_SPANS} to {self.enough} spans"
                raise SpansError(f"{range_} are fitted to {self.count} points, not {spans}")
            self._demand_filled(spans)
            return spans
        self._demand_filled(LEAST_SPANS)
        most = self.most
        count = max(1, math.ceil(math.log(most / LEAST_SPANS) / math.log(LADDER)))
        coarse = np.unique(np.round(np.geomspace(LEAST_SPANS, most, count + 1)).astype(int)).tolist()
        best = min(coarse, key=self._validated)
        beside = {round(best * FINER**k) for k in range(-2, 3)}
        fine: int = min(sorted(n for n in beside | {best} if LEAST_SPANS <= n <= most), key=self._validated)
        return fine

    def _demand_filled(self, spans: int) -> None:
        if self.gap > WIDEST_GAP * TURN / spans:
            begin = degrees(self.angle[self.widest])
            gap = (
                f"no point lies within {degrees(self.gap) or 360.0:.4g} degrees of the contour from {begin:.4g} degrees"
            )
            raise GapError(f"{gap} on, more than two of {spans} spans")

    def _validated(self, spans: int) -> float:
        """Mean square error by generalised cross-validation, to within a factor of the number of points."""
        coefficients = self.solved(spans)
        off = self.value - _evaluated(coefficients, self.angle)
        return float(off @ off) / (len(off) - spans) ** 2

    def _normal(self, spans: int) -> tuple[Array, Array]:
        """Normal matrix (N, N), banded but for its corners, and right side (N,)."""
        # in each span sums of powers of the place, and of these times the value; points are in order
        place, span = _place(self.angle, spans)
        begin = np.flatnonzero(np.diff(span, prepend=-1))
        filled, power = span[begin], np.ones(len(place))
        sums, moments = np.zeros((2 * DEGREE + 1, spans)), np.zeros((WIDTH, spans))
        for k in range(len(sums)):
            sums[k, filled] = np.add.reduceat(power, begin)
            if k < WIDTH:
                moments[k, filled] = np.add.reduceat(power * self.value, begin)
            power *= place
        # products of the six splines, and of these with the value
        hankel = sums[np.arange(WIDTH)[:, None] + np.arange(WIDTH)]
        products = np.einsum("ai,bj,ijs->abs", BASIS, BASIS, hankel, optimize=True)
        index = (np.arange(spans) + np.arange(WIDTH)[:, None]) % spans
        matrix, right = np.zeros((spans, spans)), np.zeros(spans)
        np.add.at(matrix, (index[:, None], index[None]), products)
        np.add.at(right, index, BASIS @ moments)
        return matrix, right

    def solved(self, spans: int) -> Array:
        """Coefficients (N,), mm, of the spline of least squares with N = `spans` spans."""
        matrix, right = self._normal(spans)
        if spans <= 3 * BLOCK:
            return np.asarray(np.linalg.solve(matrix, right), dtype=np.float64)
        return _banded(matrix, right)

    def inverse(self, spans: int) -> Array:
        """Inverse of the normal matrix (N, N)."""
        return np.asarray(np.linalg.inv(self._normal(spans)[0]), dtype=np.float64)


def _banded(matrix: Array, right: Array) -> Array:
    """Solve a cyclic system (N, N) whose band is narrower than BLOCK, by blocks; the last one is eliminated last."""
    ends = np.linspace(0, len(right), len(right) // BLOCK + 1).astype(int).tolist()
    parts = [slice(a, b) for a, b in pairwise(ends)]
    last = parts.pop()
    sides: Array = np.column_stack([right, matrix[:, last]])
    carried: Array = np.empty((0, 0))
    gains: list[Array] = []
    following: Array
    for i, part in enumerate(parts):
        block = matrix[part, part]
        if i:
            coupling = matrix[part, parts[i - 1]]
            block = block - coupling @ carried
            sides[part] -= coupling @ sides[parts[i - 1]]
        following = matrix[part, parts[i + 1]] if i + 1 < len(parts) else np.empty((part.stop - part.start, 0))
        both = np.asarray(np.linalg.solve(block, np.column_stack([sides[part], following])), dtype=np.float64)
        sides[part], carried = both[:, : sides.shape[1]], both[:, sides.shape[1] :]
        gains.append(carried)
    for i in range(len(parts) - 2, -1, -1):
        sides[parts[i]] -= gains[i] @ sides[parts[i + 1]]
    kept = slice(0, last.start)
    schur = matrix[last, last] - matrix[last, kept] @ sides[kept, 1:]
    end = np.linalg.solve(schur, right[last] - matrix[last, kept] @ sides[kept, 0])
    return np.append(sides[kept, 0] - sides[kept, 1:] @ end, end)


def _place(t: Array, spans: int) -> tuple[Array, Indices]:
    """Place of each parameter (n,) within its span, [0, 1), and the index of the span."""
    u = np.mod(t, TURN) * (spans / TURN)
    span = np.minimum(u.astype(np.intp), spans - 1)
    return u - span, span


def _values(place: Array, order: int, spans: int) -> Array:
    """Derivative of an order by the parameter, (6, n), of the six splines that are not 0 at places (n,) in a span."""
    rows = BASIS
    for _ in range(order):
        rows = rows[:, 1:] * np.arange(1, rows.shape[1])
    values = np.zeros((WIDTH, len(place)))
    for column in rows.T[::-1]:
        values *= place
        values += column[:, None]
    values *= (spans / TURN) ** order
    return values


def _pieces(coefficients: Array) -> Array:
    """Coefficients (6, N) of the polynomial on each span, lowest first, by the place in it from 0 to 1."""
    spans = len(coefficients)
    index = (np.arange(spans) + np.arange(WIDTH)[:, None]) % spans
    pieces: Array = BASIS.T @ coefficients[index]
    return pieces


def _evaluated(coefficients: Array, t: Array) -> Array:
    """Values (n,) at parameters t (n,), rad, of the curve with these coefficients."""
    place, span = _place(t, len(coefficients))
    *pieces, highest = _pieces(coefficients)
    total: Array = highest[span]
    for piece in reversed(pieces):
        total *= place
        total += piece[span]
    return total
