"""The function of least mean square jerk within bounds: a quintic spline with a knot at each bound that it touches.

Of all functions with lo_i <= S(x_i) <= hi_i that of the least integral of S'''^2 is a spline of degree five whose knots
are the bounds it touches (O. L. Mangasarian and L. L. Schumaker, SIAM J. Control 7, 1969). The multiplier of a bound is
the jump of -S^(5) there, above 0 at a lower bound and below 0 at an upper one.

S''' is a spline of degree two over the same knots. Its coefficients mu solve G mu = E s, where G has the products of
the quadratic B-splines and E takes third divided differences of the values s (C. de Boor, A Practical Guide to Splines,
chapter 14). The multipliers are E^T mu. Differences of neighbours alone enter, so that close knots do little harm.
An end at rest is a threefold knot. At a free end S''' and its slope vanish at the last knot, so that the B-splines over
knots beyond it are left out, and S goes on as a polynomial of degree two. Where rows show a jerk at the end itself, the
function has a tail of that jerk, which dies away, and the integral is that of the rest.

The touched bounds are found by the dual problem: bounds that are missed are added, all at once where that raises the
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

_MISSED = 1e-6  # of the unit of a bound: greatest miss that counts as kept
_STALLED = 1e-3  # of the unit: greatest miss that is accepted where the integral grows no more by rounding
_GROWS = 1e-12  # of the integral: a growth above rounding
# Most work of one search, the sum of knots^3 over its solves: some 3 s of a core. A thousand rows that scatter by 400
# readings take 4.3e10, a hundred thousand that are only rounded 2.3e8.
_MOST_WORK = 5e10
_FEW = 1000  # bounds that are looked at together; of more a search begins with these and adds those that are missed
_DIPS, _HELD = 60, 0.1  # most rounds of bounds at dips, and the share of the tolerance that these bounds allow
_EXCHANGES = 100  # of bounds, towards the nearest parabola: some ten do
_GAUSS = np.polynomial.legendre.leggauss(3)  # exact for squares of quadratic pieces
_BACK = np.array([[2], [1], [0]])  # B-splines on a piece, counted back from the last one, which begins there
_BLOCK = 24  # B-splines of one block of equations with its separators, from three times as many on
_ROW, _COLUMN = np.repeat(np.arange(3), 3), np.tile(np.arange(3), 3)


class UnsolvedError(CamgeoError, ArithmeticError):
    """A search in which bounds are still missed by more than rounding when the integral grows no more."""


class CrowdedError(CamgeoError, ArithmeticError):
    """A search that would take minutes, as too many bounds are touched and are found one by one."""


class EndJerk(NamedTuple):
    """Jerk at a free end `at`, rad, and its slope by the distance y from it, which die away over a `width`, rad.

    The jerk is a (1 - 2y/w)^2 + b (1 - y/w)^2, each to where it is 0; `way` is 1 at a beginning, -1 at an end, where
    distances are backwards.
    """

    at: float
    way: float
    width: float
    jerk: float
    slope: float

    @property
    def tails(self) -> tuple[Tail, Tail]:
        """Displacements with that jerk."""
        half, a = 0.5 * self.width, -self.jerk - 0.5 * self.slope * self.width
        first, second = (
            Tail(self.at, self.way, w, -c * w**3 / 60.0) for w, c in ((half, a), (2.0 * half, self.jerk - a))
        )
        return first, second


class Tail(NamedTuple):
    """Displacement size (1 - y/w)^5 at the distance y < w from the end `at`, rad, and 0 beyond."""

    at: float
    way: float
    width: float
    size: float

    def __call__(self, x: Array) -> Array:
        """Displacement (n,), mm or rad, at x (n,), rad."""
        value: Array = self.size * np.maximum(1.0 - self.way * (x - self.at) / self.width, 0.0) ** 5
        return value

    @property
    def end(self) -> float:
        """Where it ends, rad."""
        return self.at + self.way * self.width

    def coefficients(self, starts: Array, widths: Array) -> Array:
        """Coefficients (6, m) of powers of u over pieces (m,), which do not run across its end."""
        base, slope = 1.0 - self.way * (starts - self.at) / self.width, -self.way * widths / self.width
        k = np.arange(6)[:, None]
        binomial = np.array([math.comb(5, j) for j in range(6)])[:, None]
        coefficients: Array = np.where(base + 0.5 * slope > 0.0, binomial * base ** (5 - k) * slope**k, 0.0)
        return self.size * coefficients


class FunctionSpace(NamedTuple):
    """Functions from `begin` to `end`, rad: at rest at the levels `rest` of its ends, or, with None, periodic.

    An end whose level is None is free: value, slope and curvature there are any. What the functions have besides by the
    jerk of ends does not count.
    """

    begin: float
    end: float
    rest: tuple[float | None, float | None] | None = None
    ends: tuple[EndJerk, ...] = ()

    @property
    def tails(self) -> tuple[Tail, ...]:
        """Displacements by the jerk of ends."""
        return tuple(tail for end in self.ends for tail in end.tails)

    @property
    def period(self) -> float:
        """Angle, rad, after which the functions repeat; 0 where they do not."""
        return 0.0 if self.rest else self.end - self.begin

    @property
    def free(self) -> bool:
        """Whether both ends are free."""
        return self.rest == (None, None)

    def tail(self, x: Array) -> Array:
        """Displacement (n,), mm or rad, that the tails have at x (n,), rad."""
        value: Array = np.sum([tail(x) for tail in self.tails], axis=0) if self.tails else np.zeros(len(x))
        return value

    def inside(self, x: Array) -> NDArray[np.bool_]:
        """Mask (n,) of the places x (n,), rad, at which functions may be bounded: not at ends where they rest."""
        first, last = (-SAME_ANGLE if level is None else SAME_ANGLE for level in self.rest or (0.0, 0.0))
        mask: NDArray[np.bool_] = (x > self.begin + first) & (x < self.end - last)
        return mask


class Bounds(NamedTuple):
    """Bounds (n,) of a function at rising angles x, rad: least value `lo`, greatest value `hi`, and row of a table.

    A miss is measured in `unit`; all values are mm or rad. A bound of no row has the row -1.
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
        """Bounds joined with `more`, in the order of their angles; of two at one angle the narrower limits hold.

        `period`, rad, is that of the function, 0 without one.
        """
        at, away = self.nearest(more.x, period)
        same = away <= SAME_ANGLE
        lo, hi, unit, at = self.lo.copy(), self.hi.copy(), self.unit.copy(), at[same]
        lo[at], hi[at] = np.maximum(lo[at], more.lo[same]), np.minimum(hi[at], more.hi[same])
        unit[at] = np.minimum(unit[at], more.unit[same])
        merged = joined_bounds([self._replace(lo=lo, hi=hi, unit=unit), more.at(np.flatnonzero(~same))])
        return merged.at(np.argsort(merged.x, kind="stable"))

    def nearest(self, x: Array, period: float) -> tuple[Indices, Array]:
        """Indices (m,) of the bounds nearest to angles x (m,), and their distances (m,), rad; `period` 0 for none."""
        away = np.abs(x[:, None] - self.x)
        if period:
            away = np.minimum(away, period - away)
        at = away.argmin(axis=1)
        return at, away[np.arange(len(x)), at]

    def touching(self, start: Touch | None) -> Touch | None:
        """The touch `start` by rows as one by indices of these bounds, rising; rows without a bound are left out."""
        if start is None:
            return None
        place = np.full(int(max(self.row.max(initial=-1), start.which.max(initial=-1))) + 2, -1, dtype=np.intp)
        place[self.row] = np.arange(len(self.row))
        place[-1] = -1
        at = place[start.which]
        order = np.argsort(at)[int((at < 0).sum()) :]
        return Touch(at[order], start.upper[order])


def joined_bounds(parts: Sequence[Bounds]) -> Bounds:
    """Concatenate bounds in the order given."""
    x, lo, hi, unit = (np.concatenate([part[k] for part in parts]) for k in range(4))
    return Bounds(x, lo, hi, unit, np.concatenate([part.row for part in parts]))


class LowerLimit(NamedTuple):
    """A level, mm or rad, below which a function may nowhere be by more than the tolerance."""

    level: float
    tolerance: float


class Touch(NamedTuple):
    """Bounds (k,) that a function touches, as indices or as rows of a table, and the mask of upper bounds."""

    which: Indices
    upper: NDArray[np.bool_]


class Curve(NamedTuple):
    """A quintic spline: starts and widths of its m pieces, rad, and coefficients (6, m) of powers of u, 0 to 1 on each.

    Beyond its end it goes on with the `period`, rad, unless that is 0.
    """

    starts: Array
    widths: Array
    coefficients: Array
    period: float

    def __call__(self, x: Array, order: int = 0) -> Array:
        """Value of the function, or its derivative of the given order, (n,), at x (n,), rad."""
        if self.period:
            x = self.starts[0] + np.mod(x - self.starts[0], self.period)
        piece = np.maximum(np.searchsorted(self.starts, x, side="right") - 1, 0)
        width = self.widths[piece]
        value = _polynomial(self._rows(order)[:, piece], (x - self.starts[piece]) / width)
        return value / width**order if order else value

    def with_tail(self, tail: Tail) -> Curve:
        """The curve with a tail added, from where it ends on a knot more."""
        starts, widths, rows = self.starts, self.widths, self.coefficients
        i = int(np.searchsorted(starts, tail.end, side="right")) - 1
        share = float((tail.end - starts[i]) / widths[i]) if i >= 0 else 0.0
        if SAME_ANGLE < share < 1.0 - SAME_ANGLE:
            powers = np.arange(6)
            # the polynomial of u beyond `share`, and both parts over their own widths
            later = [sum(math.comb(m, k) * rows[m, i] * share ** (m - k) for m in range(k, 6)) for k in range(6)]
            parts = np.column_stack([rows[:, i] * share**powers, np.array(later) * (1.0 - share) ** powers])
            rows = np.column_stack([rows[:, :i], parts, rows[:, i + 1 :]])
            starts = np.insert(starts, i + 1, tail.end)
            widths = np.concatenate([widths[:i], [share * widths[i], (1.0 - share) * widths[i]], widths[i + 1 :]])
        return Curve(starts, widths, rows + tail.coefficients(starts, widths), self.period)

    def _rows(self, order: int) -> Array:
        rows = self.coefficients
        for _ in range(order):
            rows = rows[1:] * np.arange(1, len(rows))[:, None]
        return rows

    def peak(self, begin: float, end: float) -> float:
        """Greatest absolute second derivative from angle `begin` to `end`, rad."""
        # extremes of the second derivative, a cubic in u: zeros of a quadratic, or of a line where the cubic term is 0
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
        """Angle, rad, at which the function is least, and its value there."""
        ends = self.starts if self.period else np.append(self.starts, self.starts[-1] + self.widths[-1])
        place = np.concatenate([ends, self.dips(np.inf)[0]])
        value = self(place)
        i = int(np.argmin(value))
        return float(place[i]), float(value[i])

    def dips(self, level: float) -> tuple[Array, Array]:
        """Local minima below `level`, except at knots: places (m,), rad, and positive depths below the level (m,)."""
        # brackets in which the slope rises through 0, then Newton's method inside them
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
    """Values of polynomials at u, row k of `rows` the coefficients of u^k."""
    value: Array = rows[-1]
    for row in rows[-2::-1]:
        value = value * u + row
    return value


# places on a piece between which a minimum is looked for, close to its ends too, where the function may rest
_SHARES = np.array([0.0, 1e-3, 0.01, 0.05, 0.15, 0.3, 0.45, 0.6, 0.75, 0.9, 0.97, 0.995, 0.9995, 1.0])
_NEWTON = 8  # steps to a minimum
_MOVES, _CLOSE = 14, 1e-3  # rounds in which bounds at the limit move to dips beside them; later only very close ones
_BETWEEN = 2.0 / 3.0  # of the way from a bound at the limit to the dip beside it: dips move back by about half of it


class _Spline(NamedTuple):
    """The spline of least integral of S'''^2 through values, by the quadratic B-splines of its third derivative.

    Over a piece the third derivative is b0 (1 - u)^2 + 2 b1 u (1 - u) + b2 u^2.
    """

    space: FunctionSpace
    knots: Array  # ends of all pieces
    widths: Array
    values: Array  # at the ends of all pieces, one more than there are pieces, less the tails
    near: Array  # 1 over the steps from knot to knot, 0 for a step of no width
    far: Array  # 1 over the steps from a knot to the next but one
    mu: Array  # coefficients
    bernstein: tuple[Array, Array, Array]
    square: float  # integral of S'''^2

    def pull(self) -> Array:
        """Lagrange multipliers (k,) of the values."""
        if not len(self.mu):
            return np.empty(0)
        pull = _fall(_fall(_fall(2.0 * self.mu) * self.far) * self.near)
        if self.space.rest is not None:
            first, last = _repeated(self.space.rest)
            return pull[first : len(pull) - last]
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
        # the rise over each piece less that of the terms above, by its width: seen from its start and from its end
        gain = self.values[1:] - c[0]
        ahead = (gain - c[3] - c[4] - c[5]) / width
        behind = (gain - c[3] - 3.0 * c[4] - 6.0 * c[5]) / width
        # the second derivative at both ends of each piece
        bend = np.zeros(len(width) + 1)
        bend[1:-1] = 2.0 * (ahead[1:] - behind[:-1]) / (width[1:] + width[:-1])
        first, last = (0.0, 0.0) if self.space.rest is None else self.space.rest
        turn = width * (b0 + b1 + b2) / 3.0
        if self.space.period:
            bend[0] = 2.0 * (ahead[0] - behind[-1]) / (width[0] + width[-1])
        if first is None and len(width):
            bend[0] = bend[1] - turn[0]
        if last is None and len(width):
            bend[-1] = bend[-2] + turn[-1]
        c[1], c[2] = (ahead - 0.5 * bend[:-1] * width) * width, 0.5 * bend[:-1] * width**2
        if self.space.rest is not None and first is not None:
            c[1, :1] = 0.0
        starts, space = self.knots[:-1], self.space
        # beyond the last knots towards free ends: polynomials of degree two
        if first is None and self.knots[0] > space.begin:
            state = float(self.values[0]), float(c[1, 0] / width[0]) if len(width) else 0.0, float(bend[0])
            more, wide = space.begin, float(self.knots[0]) - space.begin
            starts, width = np.append(more, starts), np.append(wide, width)
            c = np.column_stack([_parabola(state, -wide, wide), c])
        if last is None and self.knots[-1] < space.end:
            slope = float(behind[-1] + 0.5 * bend[-1] * self.widths[-1]) if len(behind) else 0.0
            wide = space.end - float(self.knots[-1])
            starts, width = np.append(starts, self.knots[-1]), np.append(width, wide)
            c = np.column_stack([c, _parabola((float(self.values[-1]), slope, float(bend[-1])), 0.0, wide)])
        curve = Curve(starts, width, c, space.period)
        for tail in space.tails:
            curve = curve.with_tail(tail)
        return curve


def _parabola(state: tuple[float, float, float], begin: float, width: float) -> Array:
    """Coefficients (6,) of powers of u of a polynomial of degree two, over a piece of some width.

    `state` is its value, slope and second derivative at a place from which the piece begins at `begin`, rad.
    """
    s, v, a = state
    return np.array([s + (v + 0.5 * a * begin) * begin, (v + a * begin) * width, 0.5 * a * width**2, 0.0, 0.0, 0.0])


def _fall(values: Array) -> Array:
    """Falls (n + 1,) from each of the values (n,) to the next, with a 0 before the first and behind the last."""
    fall = np.empty(len(values) + 1)
    fall[0], fall[-1] = -values[0], values[-1]
    np.subtract(values[:-1], values[1:], out=fall[1:-1])
    return fall


class _Blocks(NamedTuple):
    """The normal equations of B-splines as p blocks of b neighbours, with two separators after each.

    Their matrix is one flat array: the blocks (p, b, b), their couplings to the separators before and after each
    (p, b, 4), and the separators (n, n). A place without a B-spline in a block has a 1 on the diagonal.
    """

    taken: Indices  # the three B-splines on each piece, (3, m); their number for one that is left out
    used: Indices  # indices of those of their nine products on each piece that the array holds
    flat: Indices  # places of these products in the array
    ones: Indices  # places of the 1s in the array
    size: tuple[int, int, int]  # p, b, n
    inner: Indices  # B-splines in blocks
    place: Indices  # places of these B-splines in the blocks
    parting: Indices  # B-splines that are separators (n,)
    beside: Indices  # separators of each block (p, 4)

    def solve(self, products: Array, rhs: Array) -> Array:
        """Solution of the equations, block by block: so small that no library starts threads.

        `products` are the nine products of B-splines on each piece, `rhs` the right side, one for each B-spline.
        """
        p, b, n = self.size
        matrix = np.bincount(self.flat, products.ravel()[self.used], p * b * (b + 4) + n * n)
        if not p:
            return np.linalg.solve(matrix.reshape(n, n), rhs).astype(np.float64, copy=False)
        matrix[self.ones] = 1.0
        couple, sides = matrix[p * b * b : p * b * (b + 4)].reshape(p, b, 4), np.zeros((p, b, 5))
        sides[:, :, :4] = couple
        sides.reshape(-1, 5)[self.place, 4] = rhs[self.inner]
        # each block is eliminated, which leaves a system of the separators; then the blocks follow from these
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
def _blocks(size: int, first: int, last: int, *, periodic: bool) -> _Blocks:
    """Blocks for `size` B-splines over the pieces from knot `first` to `last`; those that are left out have no place.

    A few B-splines are not divided: all of them are separators.
    """
    columns = np.arange(first, last) - _BACK
    if periodic:
        columns %= size
    there = (columns >= 0) & (columns < size)
    taken, columns = np.where(there, columns, size), np.where(there, columns, 0)
    p = size // _BLOCK if size >= 3 * _BLOCK else 0
    # block of each B-spline, the last two of each block being separators
    starts = np.arange(p + 1) * size // max(p, 1) if p else np.array([0, size])
    block = np.searchsorted(starts, np.arange(size), side="right") - 1
    offset, left = np.arange(size) - starts[block], starts[block + 1] - np.arange(size)
    b, n = (int(np.diff(starts).max()) - 2, 2 * p) if p else (0, size)
    parting = left <= 2 if p else left > 0
    number = 2 * block + 2 - left if p else offset
    place = block * b + offset
    # place of each product in the array: among separators, in a coupling, or in a block
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
    both = (there[_ROW] & there[_COLUMN]).ravel()
    used, inner = np.flatnonzero(both & (parting[column] | ~parting[row])), np.flatnonzero(~parting)
    empty = np.setdiff1d(np.arange(p * b), place[inner])
    beside = (2 * np.arange(p)[:, None] + np.array([-2, -1, 0, 1])) % max(n, 1)
    return _Blocks(
        taken,
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
    k, s = len(x), s - space.tail(x)
    # knots and values with their continuation: by the period, or threefold at an end at rest
    if space.rest is None:  # B-spline i stands over the knots i to i + 3
        place = np.arange(k + 3)
        t, values = x[place % k] + space.period * (place // k), s[place % k]
        near, far = 1.0 / (t[1:] - t[:-1]), 1.0 / (t[2:] - t[:-2])
        first, last, before, after = 0, k, np.concatenate([far[k - 1 : k], far[: k - 1]]), far[:k]
    else:
        (start, end), (level, level_end) = _repeated(space.rest), space.rest
        t = np.concatenate([[space.begin] * start, x, [space.end] * end])
        values = np.concatenate([[level] * start, s, [level_end] * end]).astype(np.float64)
        # steps without width count for nothing
        near, far = np.zeros(len(t) - 1), np.zeros(len(t) - 2)
        first, last = (2 if start else 0), len(t) - (3 if end else 1)
        np.divide(1.0, t[first + 1 : last + 1] - t[first:last], out=near[first:last])
        low, high = (1 if start else 0), len(far) - (1 if end else 0)
        np.divide(1.0, t[low + 2 : high + 2] - t[low:high], out=far[low:high])
        more = np.concatenate([[0.0], far, [0.0]])
        before, after = more[first:last], more[first + 1 : last + 1]
    # third divided differences of the values are the right side
    bend = _rise(_rise(values) * near) * far
    rhs = 2.0 * _rise(bend)
    widths = t[first + 1 : last + 1] - t[first:last]
    # on a piece the three B-splines are a (1 - u)^2, c u^2, and the remainder to 1
    a, c = widths * before, widths * after
    aa, cc, ac = a * a / 5.0, c * c / 5.0, a * c / 30.0
    ab, cb = a / 3.0 - aa - ac, c / 3.0 - cc - ac
    products = widths * np.array([aa, ab, ac, ab, 1.0 - 2.0 * (a + c) / 3.0 + aa + cc + 2.0 * ac, cb, ac, cb, cc])
    size = len(rhs)
    blocks = _blocks(size, first, last, periodic=space.rest is None)
    mu = blocks.solve(products, rhs)
    low, middle, high = np.append(mu, 0.0)[blocks.taken]
    bernstein = middle + a * (low - middle), middle, middle + c * (high - middle)
    return _Spline(
        space, t[first : last + 1], widths, values[first : last + 1], near, far, mu, bernstein, float(mu @ rhs)
    )


def _repeated(rest: tuple[float | None, float | None]) -> tuple[int, int]:
    """How many knots stand at each end: three where functions rest, none where the end is free."""
    first, last = (0 if level is None else 3 for level in rest)
    return first, last


def _rise(values: Array) -> Array:
    """Rises (n - 1,) from each of the values (n,) to the next."""
    return values[1:] - values[:-1]


def pulls(space: FunctionSpace, x: Array, s: Array) -> tuple[Array, float]:
    """Lagrange multipliers (k,) of values s (k,) at x (k,), and the integral of S'''^2 of the spline through them."""
    spline = _spline(space, x, s)
    return spline.pull(), spline.square


def curve_through(space: FunctionSpace, x: Array, s: Array) -> Curve:
    """Spline of least integral of S'''^2 through values s (k,) at rising x (k,)."""
    return _spline(space, x, s).curve()


class Least(NamedTuple):
    """The function of least mean square jerk: rows of the k bounds that it touches, mask of upper bounds, multipliers.

    `square` is the integral of the jerk's square; the `curve` goes through `values` at angles `x`, rad. Arrays are
    (k,).
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
        """Touched bounds by their rows, from which a similar search may begin."""
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
    """The function of least mean square jerk within bounds and above a limit, searched from the rows of `start`.

    None where a constant keeps all the bounds of a function without an end at rest. A search whose integral passes
    `ample` ends with a function that misses bounds, and whose integral is less than that of the solution. Raises
    UnsolvedError where rounding stands in the way, and CrowdedError where too many bounds are touched for it to end in
    seconds.
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
    """Bounds with a new one at the limit at each dip, and the touch with the new ones.

    A bound at the limit that is touched beside a dip, nearer than `share` of the way to the next touch, moves towards
    the dip instead. With `share` 1, bounds at the limit that are not touched are dropped: knots close to each other
    cost digits.
    """
    if space.period:
        dips = bounds.x[0] + np.mod(dips - bounds.x[0], space.period)
    x, hi, upper = dips.copy(), np.full(len(dips), np.inf), np.zeros(len(dips), dtype=bool)
    # touched bounds at the limit that have a dip beside them
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
    staying = bounds.at(np.flatnonzero(~moved & ~idle))
    unit = np.full(len(x), _HELD * limit.tolerance / _MISSED)
    more = Bounds(x, np.full(len(x), limit.level), hi, unit, np.full(len(x), -1))
    bounds = staying.with_more(more, space.period)
    new, _ = bounds.nearest(x, space.period)
    kept = np.isin(nearest.x, staying.x) & ~np.isin(nearest.x, bounds.x[new])
    which = np.concatenate([np.searchsorted(bounds.x, nearest.x[kept]), new])
    order = np.argsort(which)
    return bounds, Touch(which[order], np.concatenate([nearest.upper[kept], upper])[order])


def _of_many(space: FunctionSpace, bounds: Bounds, start: Touch | None, ample: float) -> Least | None:
    """Solve without a lower limit, from the touch `start` by indices of bounds.

    Of many bounds some are chosen, and those that are missed are added.
    """
    # every k-th bound first, then also those that the motion misses
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
    """Excess (n,) of a curve over each bound in its unit, negative inside, and the mask (n,) of nearer upper limits."""
    s = curve(bounds.x)
    under, over = (bounds.lo - s) / bounds.unit, (s - bounds.hi) / bounds.unit
    return np.maximum(under, over), over > under


def _worst(miss: Array) -> Indices:
    """Indices of the worst bound of each run of neighbouring bounds that are missed, from the misses (n,)."""
    out = np.flatnonzero(miss > _MISSED)
    if not len(out):
        return out
    run = np.zeros(len(out), dtype=np.intp)
    np.cumsum(out[1:] - out[:-1] > 1, out=run[1:])
    order = np.lexsort((-miss[out], run))
    worst: Indices = out[order[np.searchsorted(run, np.arange(run[-1] + 1))]]
    return worst


class _State(NamedTuple):
    """A set of touched bounds, the spline through them, and its multipliers, all of the right sign."""

    touch: Touch
    spline: _Spline
    pull: Array


class _Search:
    """The search for the touched bounds; `work` is the sum of knots^3 over all solves so far."""

    def __init__(self, space: FunctionSpace, bounds: Bounds, work: float) -> None:
        self.space, self.bounds, self.work = space, bounds, work
        # fewest touched bounds of a function with a jerk
        self.least = 2 if space.rest is None else 4 if space.free else 0
        self._before: set[bytes] = set()

    def run(self, start: Touch | None, ample: float) -> Least | None:
        """Add bounds that are missed until there are none, or the integral passes `ample`; None for a constant.

        Raises UnsolvedError where a bound is still missed when the integral grows no more.
        """
        state = None if start is None else self._without_wrong_signs(start)
        if state is None:
            first = self._first()
            if isinstance(first, Curve):
                none = np.empty(0)
                return Least(none.astype(np.intp), none.astype(np.bool_), none, 0.0, none, none, first)
            state = first
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
            # all at once if that raises the integral, else by steps: all of them, or the worst alone
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
        """Whether the same bounds were touched before, which only rounding can cause; remembers them."""
        key = touch.which.tobytes() + touch.upper.tobytes()
        again = key in self._before
        self._before.add(key)
        return again

    def _values(self, touch: Touch) -> Array:
        return np.where(touch.upper, self.bounds.hi[touch.which], self.bounds.lo[touch.which])

    def _solved(self, touch: Touch) -> _State:
        """Spline through the touched bounds; raises CrowdedError before a solve that would exceed the work allowed."""
        self.work += float(len(touch.which)) ** 3
        if self.work > _MOST_WORK:
            raise CrowdedError
        spline = _spline(self.space, self.bounds.x[touch.which], self._values(touch))
        return _State(touch, spline, spline.pull())

    def _first(self) -> _State | Curve | None:
        """State of no bound, of the greatest lower and least upper bound, or of four bounds that no parabola keeps.

        None where a constant keeps all bounds, a curve where a parabola keeps those of a function with free ends.
        """
        if self.space.rest is not None and not self.space.free:
            return self._solved(Touch(np.empty(0, dtype=np.intp), np.empty(0, dtype=bool)))
        i, j = int(np.argmax(self.bounds.lo)), int(np.argmin(self.bounds.hi))
        if self.bounds.lo[i] <= self.bounds.hi[j]:
            return None
        if self.space.free:
            found = nearest_parabola(self.space, self.bounds)
            return self._solved(found) if isinstance(found, Touch) else found
        which = np.array(sorted((i, j)), dtype=np.intp)
        return self._solved(Touch(which, which == j))

    def _without_wrong_signs(self, touch: Touch) -> _State | None:
        """Drop bounds until all multipliers have the right sign; None where too few bounds are left."""
        while len(touch.which) >= self.least:
            state = self._solved(touch)
            right = np.where(touch.upper, -state.pull, state.pull) > 0.0
            if right.all():
                return state
            touch = Touch(touch.which[right], touch.upper[right])
        return None

    def _with_more(self, last: Least, touch: Touch, added: Indices, upper: NDArray[np.bool_]) -> _State | None:
        """Step from multipliers of the right sign towards those with the bounds `added`, dropping bounds that reach 0.

        None where none of the added bounds stays, or too few bounds are left (Lawson and Hanson, chapter 23).
        """
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


def nearest_parabola(space: FunctionSpace, bounds: Bounds) -> Touch | Curve:
    """The curve of a parabola and the space's tails that misses bounds the least; or four bounds that forbid any."""
    tail = space.tail(bounds.x)
    bounds = bounds._replace(lo=bounds.lo - tail, hi=bounds.hi - tail)
    place = 0.5 * (space.begin + space.end), 0.5 * (space.end - space.begin)
    touch, parabola, miss = nearest_polynomial(bounds, 2, *place)
    if miss > _MISSED:
        return touch
    state = float(parabola[0]), float(parabola[1]) / place[1], 2.0 * float(parabola[2]) / place[1] ** 2
    width = space.end - space.begin
    curve = Curve(np.array([space.begin]), np.array([width]), _parabola(state, -place[1], width)[:, None], 0.0)
    for tail_of_end in space.tails:
        curve = curve.with_tail(tail_of_end)
    return curve


def nearest_polynomial(bounds: Bounds, degree: int, middle: float, half: float) -> tuple[Touch, Array, float]:
    """The polynomial that misses bounds the least: what it touches, its coefficients, and the miss in their unit.

    The coefficients (degree + 1,) are those of powers of (x - middle)/half. It misses degree + 2 bounds alike, in turn
    upper and lower ones, by as much as any (E. Ya. Remez, C. R. Acad. Sci. Paris 198, 1934): the worst of the others
    takes the place of one of them, by which the miss grows, until none is worse. The miss is negative where all bounds
    are kept. Raises UnsolvedError where rounding stands in the way.
    """
    powers = np.vander((bounds.x - middle) / half, degree + 1, increasing=True)
    usable = np.flatnonzero(np.isfinite(bounds.lo) & np.isfinite(bounds.hi))
    which = usable[np.linspace(0, len(usable) - 1, degree + 2).round().astype(np.intp)].tolist()

    def levelled(upper: Sequence[bool]) -> tuple[Array, float]:
        at, above = np.array(which), np.array(upper)
        values = np.where(above, bounds.hi[at], bounds.lo[at])
        equations = np.column_stack([powers[at], np.where(above, -1.0, 1.0) * bounds.unit[at]])
        solution = np.linalg.solve(equations, values)
        return solution[:-1], float(solution[-1])

    turns = ([k % 2 == way for k in range(degree + 2)] for way in (0, 1))
    upper = max(turns, key=lambda upper: levelled(upper)[1])
    for _ in range(_EXCHANGES):
        polynomial, miss = levelled(upper)
        s = powers @ polynomial
        excess = np.stack([(bounds.lo - s) / bounds.unit, (s - bounds.hi) / bounds.unit])
        above, worst = divmod(int(np.argmax(excess)), len(s))
        most = float(excess[above, worst])
        if most <= miss + _MISSED or (most <= _MISSED and worst in which):
            return Touch(np.array(which), np.array(upper)), polynomial, miss
        # of the bounds, one more now, that goes whose place keeps upper and lower ones in turn
        place = sum(old <= worst for old in which)
        which.insert(place, worst)
        upper.insert(place, bool(above))
        if place and upper[place - 1] == upper[place]:
            gone = place - 1
        elif place + 1 < len(upper) and upper[place + 1] == upper[place]:
            gone = place + 1
        else:
            gone = 0 if place else len(upper) - 1
        del which[gone], upper[gone]
    raise UnsolvedError
