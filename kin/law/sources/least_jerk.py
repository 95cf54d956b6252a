"""The function of least mean square jerk within bounds: a quintic spline with a knot at each bound that it touches.

Of all functions with lo_i <= S(x_i) <= hi_i that of the least integral of S'''^2 is a spline of degree five whose knots
are the bounds it touches (O. L. Mangasarian and L. L. Schumaker, SIAM J. Control 7, 1969). The multiplier of a bound is
the jump of -S^(5) there, above 0 at a lower bound and below 0 at an upper one.

S''' is a spline of degree two over the same knots. Its coefficients mu solve G mu = E s, where G has the products of
the quadratic B-splines and E takes third divided differences of the values s (C. de Boor, A Practical Guide to Splines,
chapter 14). The multipliers are E^T mu. Differences of neighbours alone enter, so that close knots do little harm.

Which bounds are touched is found on the dual side: bounds that are missed are added, all at once where that raises the
integral, else by the steps of C. L. Lawson and R. J. Hanson (Solving Least Squares Problems, chapter 23), which stop
where a multiplier comes to 0. The integral grows each time, so no set of bounds comes twice.
"""

from __future__ import annotations

import math
from functools import lru_cache
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kin.law.sources.ring import SAME_ANGLE
from kin.numeric.errors import CamgeoError

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from kin.numeric.arrays import Array, Indices

_MISSED = 1e-6  # of the unit of a bound: by so much it may be missed
_STALLED = 1e-3  # of it, where rounding lets the integral grow no more
_GROWS = 1e-12  # of the integral: a growth above rounding
# of one search: the cubes of the knots, summed over its solves, which are some 3 s of a core. A thousand rows that
# scatter by 400 readings take 4.3e10, a hundred thousand that are but rounded 2.3e8
_MOST_WORK = 5e10
_FEW = 1000  # bounds that are looked at together; of more these are the first, and then those that are missed
_DIPS, _HELD = 60, 0.1  # times at most that a function is held up at dips, and to what share of the tolerance
_GAUSS = np.polynomial.legendre.leggauss(3)  # exact for squares of quadratic pieces
_BACK = np.array([[2], [1], [0]])  # B-splines on a piece, counted back from the one that begins there
_BLOCK = 24  # B-splines of one block of equations with its separators, from three times as many on
_ROW, _COLUMN = np.repeat(np.arange(3), 3), np.tile(np.arange(3), 3)


class UnsolvedError(CamgeoError, ArithmeticError):
    """Bounds that are missed by more than rounding when the integral grows no more."""


class CrowdedError(CamgeoError, ArithmeticError):
    """A search that would take minutes: too many bounds are touched, and found one by one."""


class FunctionSpace(NamedTuple):
    """Functions from `begin` to `end`: at rest at both ends, at the levels `rest`, or of that period (None)."""

    begin: float
    end: float
    rest: tuple[float, float] | None = None

    @property
    def period(self) -> float:
        """Angle, rad, after which the functions repeat; 0 where they do not."""
        return 0.0 if self.rest else self.end - self.begin


class Bounds(NamedTuple):
    """Rising angles (n,), least and greatest value at each, the unit in which a miss is measured, and the row it is of.

    All are (n,). A bound of no row has the number -1.
    """

    x: Array
    lo: Array
    hi: Array
    unit: Array
    row: Indices

    def at(self, which: Indices) -> Bounds:
        """Bounds with the indices `which` (k,)."""
        return Bounds(self.x[which], self.lo[which], self.hi[which], self.unit[which], self.row[which])

    def with_more(self, more: Bounds, period: float) -> Bounds:
        """Bounds joined with `more`, in the order of their angles; of two at one angle the narrower limits hold."""
        at, away = self.nearest(more.x, period)
        same = away <= SAME_ANGLE
        lo, hi, unit, at = self.lo.copy(), self.hi.copy(), self.unit.copy(), at[same]
        lo[at], hi[at] = np.maximum(lo[at], more.lo[same]), np.minimum(hi[at], more.hi[same])
        unit[at] = np.minimum(unit[at], more.unit[same])
        both = joined_bounds([self._replace(lo=lo, hi=hi, unit=unit), more.at(np.flatnonzero(~same))])
        return both.at(np.argsort(both.x, kind="stable"))

    def nearest(self, x: Array, period: float) -> tuple[Indices, Array]:
        """Places of the bounds nearest to angles x (m,), and how far away they are."""
        away = np.abs(x[:, None] - self.x)
        if period:
            away = np.minimum(away, period - away)
        at = away.argmin(axis=1)
        return at, away[np.arange(len(x)), at]

    def touching(self, start: Touch | None) -> Touch | None:
        """Places of those bounds that are of the rows of a touch."""
        if start is None:
            return None
        place = np.full(int(max(self.row.max(initial=-1), start.which.max(initial=-1))) + 2, -1, dtype=np.intp)
        place[self.row] = np.arange(len(self.row))
        place[-1] = -1
        at = place[start.which]
        order = np.argsort(at)[int((at < 0).sum()) :]
        return Touch(at[order], start.upper[order])


def joined_bounds(parts: Sequence[Bounds]) -> Bounds:
    """Concatenate bounds in the order passed."""
    x, lo, hi, unit = (np.concatenate([part[k] for part in parts]) for k in range(4))
    return Bounds(x, lo, hi, unit, np.concatenate([part.row for part in parts]))


class LowerLimit(NamedTuple):
    """A level that a function is nowhere below by more than a tolerance."""

    level: float
    tolerance: float


class Touch(NamedTuple):
    """Bounds (k,) that a function touches, by their places or their rows; which of them are upper ones."""

    which: Indices
    upper: NDArray[np.bool_]


class Curve(NamedTuple):
    """A quintic spline: the starts and widths of its m pieces, and coefficients (6, m) of powers from 0 to 1 over each.

    Beyond its end it goes on with the `period`, if it has one.
    """

    starts: Array
    widths: Array
    coefficients: Array
    period: float

    def __call__(self, x: Array, order: int = 0) -> Array:
        """Value of the function, or its derivative of an order, (n,), at x (n,)."""
        if self.period:
            x = self.starts[0] + np.mod(x - self.starts[0], self.period)
        piece = np.maximum(np.searchsorted(self.starts, x, side="right") - 1, 0)
        width = self.widths[piece]
        value = _polynomial(self._rows(order)[:, piece], (x - self.starts[piece]) / width)
        return value / width**order if order else value

    def _rows(self, order: int) -> Array:
        rows = self.coefficients
        for _ in range(order):
            rows = rows[1:] * np.arange(1, len(rows))[:, None]
        return rows

    def peak(self, begin: float, end: float) -> float:
        """Greatest absolute second derivative from angle `begin` to `end`, rad."""
        _, q1, q2, q3 = self._rows(2)
        root = np.sqrt(np.maximum(q2 * q2 - 3.0 * q1 * q3, 0.0))
        with np.errstate(divide="ignore", invalid="ignore"):
            shares = np.array([0.0 * q1, (-q2 + root) / (3.0 * q3), (-q2 - root) / (3.0 * q3), -q1 / (2.0 * q2)])
        x = (self.starts + np.clip(np.nan_to_num(shares), 0.0, 1.0) * self.widths).ravel()
        if self.period:
            x = begin + np.mod(x - begin, self.period)
        x = np.concatenate([[begin, end], x[(x > begin) & (x < end)]])
        return float(np.abs(self(x, 2)).max())

    def square(self, begin: float, end: float) -> float:
        """Integral of the third derivative's square from angle `begin` to `end`, rad."""
        x = self.starts
        if self.period:
            x = begin + np.mod(x - begin, self.period)
        x = np.unique(np.concatenate([[begin, end], x[(x > begin) & (x < end)]]))
        half, middle = 0.5 * np.diff(x), 0.5 * (x[1:] + x[:-1])
        places, weights = _GAUSS
        jerk = self((middle + places[:, None] * half).ravel(), 3).reshape(len(places), -1)
        return float(weights @ jerk**2 @ half)

    def lowest(self) -> tuple[float, float]:
        """The place, rad, at which the function is least, and its value there."""
        place = np.concatenate([self.starts, self.dips(np.inf)[0]])
        value = self(place)
        i = int(np.argmin(value))
        return float(place[i]), float(value[i])

    def dips(self, level: float) -> tuple[Array, Array]:
        """Local minima below `level`, except at knots: places (m,), rad, and positive depths below the level (m,)."""
        slope = _polynomial(self._rows(1)[:, None], _SHARES[:, None])
        i, piece = np.nonzero((slope[:-1] < 0.0) & (slope[1:] >= 0.0))
        low, high = _SHARES[i], _SHARES[i + 1]
        rows, bends, u = self._rows(1)[:, piece], self._rows(2)[:, piece], 0.5 * (low + high)
        for _ in range(_NEWTON):
            slopes, bend = _polynomial(rows, u), _polynomial(bends, u)
            falling = slopes < 0.0
            low, high = np.where(falling, u, low), np.where(falling, high, u)
            step = u - np.divide(slopes, bend, out=np.zeros_like(u), where=bend > 0.0)
            u = np.where((step > low) & (step < high), step, 0.5 * (low + high))
        depth = level - _polynomial(self.coefficients[:, piece], u)
        deep = depth > 0.0
        return (self.starts[piece] + u * self.widths[piece])[deep], depth[deep]


def _polynomial(rows: Array, u: Array) -> Array:
    """Polynomials with coefficients of rising powers in their rows, at u."""
    value: Array = rows[-1]
    for row in rows[-2::-1]:
        value = value * u + row
    return value


# places on a piece between which a minimum is looked for, close to its ends too, where it may rest; and steps to it
_SHARES = np.array([0.0, 1e-3, 0.01, 0.05, 0.15, 0.3, 0.45, 0.6, 0.75, 0.9, 0.97, 0.995, 0.9995, 1.0])
_NEWTON = 8
_MOVES, _CLOSE = 14, 1e-3  # times that bounds at the limit move to where they are called for; later only close ones
_BETWEEN = 2.0 / 3.0  # from a bound at the limit to the dip beside it: dips move by about half of that, and back


class _Spline(NamedTuple):
    """The spline of least integral of S'''^2 through values, by the quadratic B-splines of its third derivative.

    Over a piece of width h that is b0 (1 - u)^2 + 2 b1 u (1 - u) + b2 u^2.
    """

    period: float  # 0 between two rests
    starts: Array  # of the pieces
    widths: Array
    values: Array  # at the ends of all pieces, one more than there are pieces
    near: Array  # one over the steps from knot to knot, 0 for none
    far: Array  # one over those from a knot to the next but one
    mu: Array  # coefficients
    bernstein: tuple[Array, Array, Array]
    square: float  # integral of S'''^2

    def pull(self) -> Array:
        """Lagrange multipliers (k,) of the values."""
        pull = _fall(_fall(_fall(2.0 * self.mu) * self.far) * self.near)
        if not self.period:
            return pull[3:-3]
        count = len(self.widths)
        for place in range(count, len(pull)):
            pull[place % count] += pull[place]
        return pull[:count]

    def curve(self) -> Curve:
        """Polynomials of the motion between its knots."""
        width, (b0, b1, b2) = self.widths, self.bernstein
        c = np.zeros((6, len(width)))
        c[0] = self.values[:-1]
        cube = width**3
        c[3], c[4], c[5] = b0 * cube / 6.0, (b1 - b0) * cube / 12.0, (b0 - 2.0 * b1 + b2) * cube / 60.0
        # what velocity and acceleration add over each piece, seen from its start and from its end
        gain = self.values[1:] - c[0]
        ahead = (gain - c[3] - c[4] - c[5]) / width
        behind = (gain - c[3] - 3.0 * c[4] - 6.0 * c[5]) / width
        bend = np.zeros(len(width))
        bend[1:] = 2.0 * (ahead[1:] - behind[:-1]) / (width[1:] + width[:-1])
        if self.period:
            bend[0] = 2.0 * (ahead[0] - behind[-1]) / (width[0] + width[-1])
        c[1], c[2] = (ahead - 0.5 * bend * width) * width, 0.5 * bend * width**2
        if not self.period:
            c[1, 0] = 0.0
        return Curve(self.starts, width, c, self.period)


def _fall(values: Array) -> Array:
    """From each value to the next, the first one from 0 and the last one to it, with the sign turned: one more."""
    fall = np.empty(len(values) + 1)
    fall[0], fall[-1] = -values[0], values[-1]
    np.subtract(values[:-1], values[1:], out=fall[1:-1])
    return fall


class _Blocks(NamedTuple):
    """The normal equations of so many B-splines as p blocks of b neighbours, with two separators after each.

    Their matrix is one array: the blocks (p, b, b), how each is coupled to the separators before and after it
    (p, b, 4), and the separators (n, n). A place of no B-spline in a block has a 1.
    """

    taken: Indices  # the three B-splines on each piece, (3, m)
    used: Indices  # those of their nine products on each piece that the array has
    flat: Indices  # where they go in it
    ones: Indices  # places in it
    size: tuple[int, int, int]  # p, b, n
    inner: Indices  # B-splines in blocks
    place: Indices  # where they stand there
    parting: Indices  # B-splines that are separators (n,)
    beside: Indices  # separators of each block (p, 4)

    def solve(self, products: Array, rhs: Array) -> Array:
        """Solution of the equations, by blocks: so small that no library calls for threads."""
        p, b, n = self.size
        matrix = np.bincount(self.flat, products.ravel()[self.used], p * b * (b + 4) + n * n)
        if not p:
            return np.linalg.solve(matrix.reshape(n, n), rhs).astype(np.float64, copy=False)
        matrix[self.ones] = 1.0
        couple, sides = matrix[p * b * b : p * b * (b + 4)].reshape(p, b, 4), np.zeros((p, b, 5))
        sides[:, :, :4] = couple
        sides.reshape(-1, 5)[self.place, 4] = rhs[self.inner]
        alone = np.linalg.solve(matrix[: p * b * b].reshape(p, b, b), sides)
        moved = couple.transpose(0, 2, 1) @ alone
        pairs = self.beside[:, :, None] * n + self.beside[:, None, :]
        parted = matrix[p * b * (b + 4) :] - np.bincount(pairs.ravel(), moved[:, :, :4].ravel(), n * n)
        sums = rhs[self.parting] - np.bincount(self.beside.ravel(), moved[:, :, 4].ravel(), n)
        between = np.linalg.solve(parted.reshape(n, n), sums)
        left = alone[:, :, 4] - (alone[:, :, :4] @ between[self.beside][:, :, None])[:, :, 0]
        solution = np.empty(len(rhs))
        solution[self.parting], solution[self.inner] = between, left.ravel()[self.place]
        return solution


@lru_cache(maxsize=256)
def _blocks(count: int, *, periodic: bool) -> _Blocks:
    """Blocks for so many knots; few B-splines are not divided: all are separators."""
    size = count if periodic else count + 3
    columns = (np.arange(count) - _BACK) % count if periodic else np.arange(count + 1) + 2 - _BACK
    p = size // _BLOCK if size >= 3 * _BLOCK else 0
    starts = np.arange(p + 1) * size // max(p, 1) if p else np.array([0, size])
    block = np.searchsorted(starts, np.arange(size), side="right") - 1
    offset, left = np.arange(size) - starts[block], starts[block + 1] - np.arange(size)
    b, n = (int(np.diff(starts).max()) - 2, 2 * p) if p else (0, size)
    parting = left <= 2 if p else left > 0
    number = 2 * block + 2 - left if p else offset
    place = block * b + offset
    row, column = columns[_ROW].ravel(), columns[_COLUMN].ravel()
    flat = np.where(
        parting[row],
        p * b * (b + 4) + number[row] * n + number[column],
        np.where(
            parting[column],
            p * b * b + 4 * place[row] + number[column] % 2 + 2 * (block[row] == block[column]),
            place[row] * b + offset[column],
        ),
    )
    used, inner = np.flatnonzero(parting[column] | ~parting[row]), np.flatnonzero(~parting)
    empty = np.setdiff1d(np.arange(p * b), place[inner])
    beside = (2 * np.arange(p)[:, None] + np.array([-2, -1, 0, 1])) % max(n, 1)
    return _Blocks(
        columns,
        used,
        flat[used],
        empty * b + empty % max(b, 1),
        (p, b, n),
        inner,
        place[inner],
        np.flatnonzero(parting),
        beside,
    )


def _spline(space: FunctionSpace, x: Array, s: Array) -> _Spline:
    """Solve for the third derivative of the spline through s (k,) at x (k,)."""
    k = len(x)
    if space.rest is None:  # B-spline i stands over the knots i to i + 3
        place = np.arange(k + 3)
        t, values = x[place % k] + space.period * (place // k), s[place % k]
        near, far = 1.0 / (t[1:] - t[:-1]), 1.0 / (t[2:] - t[:-2])
        first, last, before = 0, k, np.concatenate([far[k - 1 : k], far[: k - 1]])
    else:
        t = np.concatenate([[space.begin] * 3, x, [space.end] * 3])
        values = np.concatenate([[space.rest[0]] * 3, s, [space.rest[1]] * 3])
        near, far = np.zeros(k + 5), np.zeros(k + 4)
        near[2:-2], far[1:-1] = 1.0 / (t[3:-2] - t[2:-3]), 1.0 / (t[3:-1] - t[1:-3])
        first, last, before = 2, k + 3, far[1:-2]
    bend = _rise(_rise(values) * near) * far
    rhs = 2.0 * _rise(bend)
    widths = t[first + 1 : last + 1] - t[first:last]
    # on a piece the three B-splines are a (1 - u)^2, c u^2, and what is left of 1
    a, c = widths * before, widths * far[first:last]
    aa, cc, ac = a * a / 5.0, c * c / 5.0, a * c / 30.0
    ab, cb = a / 3.0 - aa - ac, c / 3.0 - cc - ac
    products = widths * np.array([aa, ab, ac, ab, 1.0 - 2.0 * (a + c) / 3.0 + aa + cc + 2.0 * ac, cb, ac, cb, cc])
    blocks = _blocks(k, periodic=space.rest is None)
    mu = blocks.solve(products, rhs)
    low, middle, high = mu[blocks.taken]
    bernstein = middle + a * (low - middle), middle, middle + c * (high - middle)
    return _Spline(
        space.period, t[first:last], widths, values[first : last + 1], near, far, mu, bernstein, float(mu @ rhs)
    )


def _rise(values: Array) -> Array:
    """From each value to the next."""
    return values[1:] - values[:-1]


def pulls(space: FunctionSpace, x: Array, s: Array) -> tuple[Array, float]:
    """Lagrange multipliers (k,) of values s (k,) at x (k,), and the integral of S'''^2 of the spline through them."""
    spline = _spline(space, x, s)
    return spline.pull(), spline.square


def curve_through(space: FunctionSpace, x: Array, s: Array) -> Curve:
    """Spline of least integral of S'''^2 through values s (k,) at rising x (k,)."""
    return _spline(space, x, s).curve()


class Least(NamedTuple):
    """The function of least mean square jerk: rows of the bounds that it touches, which are upper ones, multipliers.

    `square` is the integral of the jerk's square; the curve goes through `values` at `x`, (k,) each as the others.
    """

    row: Indices
    upper: NDArray[np.bool_]
    pull: Array
    square: float
    x: Array
    values: Array
    curve: Curve

    @property
    def touch(self) -> Touch:
        """Bounds that are touched, from which a search nearby may begin."""
        real = self.row >= 0
        return Touch(self.row[real], self.upper[real])


def least(
    space: FunctionSpace,
    bounds: Bounds,
    start: Touch | None = None,
    limit: LowerLimit | None = None,
    *,
    ample: float = math.inf,
) -> Least | None:
    """The function of least mean square jerk within bounds and above a limit, looked for from the rows of `start`.

    None where a constant keeps all the bounds of a function with a period. A search whose integral passes `ample` ends
    there, with a function of a lesser integral than that looked for, which misses bounds. Raises UnsolvedError where
    rounding stands in the way, and CrowdedError where the bounds touched are too many for it to end in seconds.
    """
    touch = bounds.touching(start)
    for turn in range(_DIPS):
        nearest = _of_many(space, bounds, touch, ample)
        if nearest is None or limit is None or nearest.square > ample:
            return nearest
        dips, depths = nearest.curve.dips(limit.level)
        dips = dips[depths > limit.tolerance]
        if not len(dips):
            return nearest
        share = 1.0 if turn < _MOVES else _CLOSE
        bounds, touch = _with_limit(space, bounds, nearest, dips, limit=limit, share=share)
    raise UnsolvedError


def _with_limit(
    space: FunctionSpace, bounds: Bounds, nearest: Least, dips: Array, *, limit: LowerLimit, share: float
) -> tuple[Bounds, Touch]:
    """Bounds with one at the limit at each dip; where one holds the function up beside it, that moves towards the dip.

    Beside it is nearer than `share` of the way to the next touch. With 1 none is left that holds the function nowhere:
    knots that come close to each other leave no digits. Also returns what is touched, with the bounds at the dips.
    """
    if space.period:
        dips = bounds.x[0] + np.mod(dips - bounds.x[0], space.period)
    x, hi, upper = dips.copy(), np.full(len(dips), np.inf), np.zeros(len(dips), dtype=bool)
    lifted = np.flatnonzero(nearest.row < 0)
    moved = np.zeros(len(bounds.x), dtype=bool)
    if len(lifted):
        near = lifted[np.argmin(np.abs(dips[:, None] - nearest.x[lifted]), axis=1)]
        away = np.abs(dips[:, None] - np.where(np.arange(len(nearest.x)) == near[:, None], np.inf, nearest.x))
        beside = np.abs(dips - nearest.x[near]) < share * away.min(axis=1)
        near = near[beside]
        old = np.searchsorted(bounds.x, nearest.x[near])
        x[beside] += (1.0 - _BETWEEN) * (nearest.x[near] - dips[beside])
        hi[beside], upper[beside], moved[old] = bounds.hi[old], nearest.upper[near], True
    idle = (bounds.row < 0) & np.isinf(bounds.hi) & ~np.isin(bounds.x, nearest.x) & (share == 1.0)
    rest = bounds.at(np.flatnonzero(~moved & ~idle))
    unit = np.full(len(x), _HELD * limit.tolerance / _MISSED)
    more = Bounds(x, np.full(len(x), limit.level), hi, unit, np.full(len(x), -1))
    bounds = rest.with_more(more, space.period)
    new, _ = bounds.nearest(x, space.period)
    kept = np.isin(nearest.x, rest.x) & ~np.isin(nearest.x, bounds.x[new])
    which = np.concatenate([np.searchsorted(bounds.x, nearest.x[kept]), new])
    order = np.argsort(which)
    return bounds, Touch(which[order], np.concatenate([nearest.upper[kept], upper])[order])


def _of_many(space: FunctionSpace, bounds: Bounds, start: Touch | None, ample: float) -> Least | None:
    """Solve without a lower limit; `start` has places among the bounds.

    Of many bounds only some are put in at a time.
    """
    n = len(bounds.x)
    chosen = np.arange(n) if n <= _FEW else np.arange(0, n, -(-n // _FEW))
    if start is not None:
        chosen = np.union1d(chosen, start.which)
    work = 0.0
    while True:
        touch = None if start is None else Touch(np.searchsorted(chosen, start.which), start.upper)
        search = _Search(space, bounds.at(chosen), work)
        nearest, work = search.run(touch, ample), search.work
        if nearest is None:
            missed = np.array([np.argmax(bounds.lo), np.argmin(bounds.hi)])
            if bounds.lo[missed[0]] <= bounds.hi[missed[1]]:
                return None
        elif len(chosen) == n or nearest.square > ample:
            return nearest
        else:
            miss, _ = excess_of_bounds(nearest.curve, bounds)
            miss[chosen] = -1.0
            missed = _worst(miss)
            if not len(missed):
                return nearest
            start = Touch(chosen[np.searchsorted(bounds.x[chosen], nearest.x)], nearest.upper)
        chosen = np.union1d(chosen, missed)


def excess_of_bounds(curve: Curve, bounds: Bounds) -> tuple[Array, NDArray[np.bool_]]:
    """Excess (n,) over each bound in its unit, below 0 inside; and whether the upper limit is the nearer (n,)."""
    s = curve(bounds.x)
    under, over = (bounds.lo - s) / bounds.unit, (s - bounds.hi) / bounds.unit
    return np.maximum(under, over), over > under


def _worst(miss: Array) -> Indices:
    """The worst of each run of bounds that are missed, by their places."""
    out = np.flatnonzero(miss > _MISSED)
    if not len(out):
        return out
    run = np.zeros(len(out), dtype=np.intp)
    np.cumsum(out[1:] - out[:-1] > 1, out=run[1:])
    order = np.lexsort((-miss[out], run))
    worst: Indices = out[order[np.searchsorted(run, np.arange(run[-1] + 1))]]
    return worst


class _State(NamedTuple):
    """A set of bounds that are touched, the spline through them, and its multipliers, which have their signs."""

    touch: Touch
    spline: _Spline
    pull: Array


class _Search:
    """The search for the bounds that are touched, after so much work (the knots' cubes, summed over the solves)."""

    def __init__(self, space: FunctionSpace, bounds: Bounds, work: float) -> None:
        self.space, self.bounds, self.work = space, bounds, work
        self.least = 2 if space.rest is None else 0  # bounds that are touched, of a function that is no constant
        self._before: set[bytes] = set()

    def run(self, start: Touch | None, ample: float) -> Least | None:
        """Add bounds that are missed until there are none, or the integral passes `ample`."""
        state = None if start is None else self._without_wrong_signs(start)
        state = state or self._first()
        while state is not None:
            touch, spline, pull = state
            curve = spline.curve()
            miss, above = excess_of_bounds(curve, self.bounds)
            miss[touch.which] = -1.0
            added = _worst(miss)
            last = Least(
                self.bounds.row[touch.which],
                touch.upper,
                pull,
                spline.square,
                self.bounds.x[touch.which],
                self._values(touch),
                curve,
            )
            if not len(added) or spline.square > ample:
                return last
            above[touch.which] = touch.upper
            which = np.sort(np.concatenate([touch.which, added]))
            state = self._without_wrong_signs(Touch(which, above[which]))
            if state is None or not state.spline.square > spline.square * (1.0 + _GROWS):
                worst = np.array([np.argmax(miss)])
                state = self._with_more(last, touch, added, above) or self._with_more(last, touch, worst, above)
            if state is None or self._is_repeated(state.touch):
                if miss.max() > _STALLED:
                    raise UnsolvedError
                return last
        return None

    def _is_repeated(self, touch: Touch) -> bool:
        """Whether the same bounds were touched before, which rounding alone can bring about."""
        key = touch.which.tobytes() + touch.upper.tobytes()
        again = key in self._before
        self._before.add(key)
        return again

    def _values(self, touch: Touch) -> Array:
        return np.where(touch.upper, self.bounds.hi[touch.which], self.bounds.lo[touch.which])

    def _solved(self, touch: Touch) -> _State:
        """The work is counted before it is done: a solve of many thousand knots would take all memory."""
        self.work += float(len(touch.which)) ** 3
        if self.work > _MOST_WORK:
            raise CrowdedError
        spline = _spline(self.space, self.bounds.x[touch.which], self._values(touch))
        return _State(touch, spline, spline.pull())

    def _first(self) -> _State | None:
        """The least that any function does: none, or from the greatest lower bound to the least upper one."""
        if self.space.rest is not None:
            return self._solved(Touch(np.empty(0, dtype=np.intp), np.empty(0, dtype=bool)))
        i, j = int(np.argmax(self.bounds.lo)), int(np.argmin(self.bounds.hi))
        if self.bounds.lo[i] <= self.bounds.hi[j]:
            return None
        which = np.array(sorted((i, j)), dtype=np.intp)
        return self._solved(Touch(which, which == j))

    def _without_wrong_signs(self, touch: Touch) -> _State | None:
        """The bounds of a set whose multipliers (`pull`) have their signs; None where too few are left."""
        while len(touch.which) >= self.least:
            state = self._solved(touch)
            right = np.where(touch.upper, -state.pull, state.pull) > 0.0
            if right.all():
                return state
            touch = Touch(touch.which[right], touch.upper[right])
        return None

    def _with_more(self, last: Least, touch: Touch, added: Indices, upper: NDArray[np.bool_]) -> _State | None:
        """From multipliers with their signs towards those of more bounds, letting go of those that come to 0."""
        size = np.zeros(len(self.bounds.x))
        size[touch.which] = np.abs(last.pull)
        which = np.sort(np.concatenate([touch.which, added]))
        while len(which) >= self.least:
            state = self._solved(Touch(which, upper[which]))
            wanted, now = np.where(state.touch.upper, -state.pull, state.pull), size[which]
            wrong = wanted <= 0.0
            if not wrong.any():
                return state if np.isin(added, which).any() else None
            useless = wrong & (now <= 0.0)
            if useless.any():
                which = which[~useless]
                continue
            share = np.where(wrong, now / np.where(wrong, now - wanted, 1.0), np.inf)
            step = float(share.min())
            size[which] = np.maximum(now + step * (wanted - now), 0.0)
            which = which[share > step]
        return None
