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

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

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
_DIPS, _HELD = 60, 0.1  # times at most that a function is held up at dips, and to what share of the depth it may have
_GAUSS = np.polynomial.legendre.leggauss(3)  # exact for squares of quadratic pieces
_WRAPPED = 5  # knots: fewer than that stand over a period more than once
_BACK = np.array([2, 1, 0])  # B-splines on a piece, counted back from the one that begins there
_ROW, _COLUMN = np.repeat(np.arange(3), 3), np.tile(np.arange(3), 3)


class UnsolvedError(CamgeoError, ArithmeticError):
    """Bounds that are missed by more than rounding when the integral grows no more."""


class CrowdedError(CamgeoError, ArithmeticError):
    """So many bounds are touched, and found one by one, that the search would take minutes."""


class Space(NamedTuple):
    """Functions from `begin` to `end`: at rest at both ends, at the levels `rest`, or of that period (None)."""

    begin: float
    end: float
    rest: tuple[float, float] | None = None


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
        """Some of the bounds."""
        return Bounds(self.x[which], self.lo[which], self.hi[which], self.unit[which], self.row[which])

    def with_more(self, more: Bounds) -> Bounds:
        """These and others, by their angles."""
        return joined_bounds([self, more]).at(np.argsort(np.concatenate([self.x, more.x]), kind="stable"))

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
    """Bounds one after another."""
    x, lo, hi, unit = (np.concatenate([part[k] for part in parts]) for k in range(4))
    return Bounds(x, lo, hi, unit, np.concatenate([part.row for part in parts]))


class Floor(NamedTuple):
    """A level that a function is nowhere below by more than `depth`."""

    level: float
    depth: float


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
        """The function, or a derivative of it, at x (n,)."""
        if self.period:
            x = self.starts[0] + np.mod(x - self.starts[0], self.period)
        piece = np.clip(np.searchsorted(self.starts, x, side="right") - 1, 0, len(self.starts) - 1)
        width = self.widths[piece]
        u, value = (x - self.starts[piece]) / width, np.zeros(len(x))
        for row in self._rows(order)[::-1]:
            value = value * u + row[piece]
        return value / width**order

    def _rows(self, order: int) -> Array:
        rows = self.coefficients
        for _ in range(order):
            rows = rows[1:] * np.arange(1, len(rows))[:, None]
        return rows

    def peak(self, begin: float, end: float) -> float:
        """Greatest absolute acceleration from `begin` to `end`."""
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
        """Integral of the jerk's square from `begin` to `end`."""
        x = self.starts
        if self.period:
            x = begin + np.mod(x - begin, self.period)
        x = np.unique(np.concatenate([[begin, end], x[(x > begin) & (x < end)]]))
        half, middle = 0.5 * np.diff(x), 0.5 * (x[1:] + x[:-1])
        return sum(float(w * (self(middle + u * half, 3) ** 2) @ half) for u, w in zip(*_GAUSS, strict=True))

    def lowest(self) -> tuple[float, float]:
        """Where the function is least, and its value there."""
        place, _ = self.dips(np.inf)
        i = int(np.argmin(self(place)))
        return float(place[i]), float(self(place[i : i + 1])[0])

    def dips(self, floor: float) -> tuple[Array, Array]:
        """Local minima below a floor: where, and how deep they lie, (m,) each."""
        x = (self.starts + _SHARES[:, None] * self.widths).ravel(order="F")
        x = np.append(x, self.starts[-1] + self.widths[-1])
        slope = self._slopes()
        at = np.flatnonzero((slope[:-1] < 0.0) & (slope[1:] >= 0.0))
        low, high = x[at].copy(), x[at + 1].copy()
        place = 0.5 * (low + high)
        for _ in range(_NEWTON):
            slope, bend = self(place, 1), self(place, 2)
            low, high = np.where(slope < 0.0, place, low), np.where(slope < 0.0, high, place)
            step = place - np.divide(slope, bend, out=np.zeros_like(slope), where=bend > 0.0)
            place = np.where((step > low) & (step < high), step, 0.5 * (low + high))
        deep = floor - self(place)
        return place[deep > 0.0], deep[deep > 0.0]

    def _slopes(self) -> Array:
        """The slope at the shares of all pieces, one after another, and at the end."""
        rows = self._rows(1)
        u, slope = np.append(_SHARES, 1.0)[:, None], np.zeros((len(_SHARES) + 1, len(self.widths)))
        for row in rows[::-1]:
            slope = slope * u + row
        slope /= self.widths
        return np.append(slope[:-1].ravel(order="F"), slope[-1, -1])


# places on a piece between which a minimum is looked for, close to its ends too, where it may rest; and steps to it
_SHARES = np.array([0.0, 1e-3, 0.01, 0.05, 0.15, 0.3, 0.45, 0.6, 0.75, 0.9, 0.97, 0.995, 0.9995])
_NEWTON = 8
_MOVES, _CLOSE = 14, 1e-3  # times that bounds at the floor move to where they are called for; later only close ones
_BETWEEN = 2.0 / 3.0  # from a bound at the floor to the dip beside it: dips move by about half of that, and back


class _Third(NamedTuple):
    """The third derivative of a spline through values, as quadratic B-splines over its knots.

    Over a piece of width h it is b0 (1 - u)^2 + 2 b1 u (1 - u) + b2 u^2.
    """

    starts: Array  # of the pieces
    widths: Array
    values: Array  # at the ends of all pieces, one more than there are pieces
    near: Array  # one over the steps from knot to knot, 0 for none
    far: Array  # one over those from a knot to the next but one
    mu: Array  # coefficients
    rhs: Array
    bernstein: tuple[Array, Array, Array]


def _third(space: Space, x: Array, s: Array) -> _Third:
    """Solve for the third derivative of the spline through s (k,) at x (k,)."""
    k = len(x)
    if space.rest is None:  # B-spline i stands over the knots i to i + 3
        place = np.arange(k + 4) % k if k < _WRAPPED else np.r_[0:k, 0:4]
        period = space.end - space.begin
        t = x[place]
        t[k:] += period * (1 + (np.arange(4) // k))
        f = s[place]
        starts, widths, values = t[:k], t[1 : k + 1] - t[:k], f[: k + 1]
        before, after = np.roll(widths, 1), np.roll(widths, -1)
        taken, size = (np.arange(k) - _BACK[:, None]) % k, k
        t, f = t[:-1], f[:-1]
    else:
        first, last = space.rest
        t = np.concatenate([[space.begin] * 3, x, [space.end] * 3])
        f = np.concatenate([[first] * 3, s, [last] * 3])
        starts, widths, values = t[2:-3], t[3:-2] - t[2:-3], f[2:-2]
        before, after = np.append(0.0, widths[:-1]), np.append(widths[1:], 0.0)
        taken, size = np.arange(k + 1) + 2 - _BACK[:, None], k + 3
    step, wide = t[1:] - t[:-1], t[2:] - t[:-2]
    near, far = (np.divide(1.0, width, out=np.zeros_like(width), where=width > 0.0) for width in (step, wide))
    slope = (f[1:] - f[:-1]) * near
    bend = (slope[1:] - slope[:-1]) * far
    rhs = 2.0 * (bend[1:] - bend[:-1])
    # on a piece the three B-splines are a (1 - u)^2, c u^2, and what is left of 1
    a, c = widths / (before + widths), widths / (widths + after)
    aa, cc, ac = a * a / 5.0, c * c / 5.0, a * c / 30.0
    ab, cb = a / 3.0 - aa - ac, c / 3.0 - cc - ac
    products = widths * np.array([aa, ab, ac, ab, 1.0 - 2.0 * (a + c) / 3.0 + aa + cc + 2.0 * ac, cb, ac, cb, cc])
    flat = taken[_ROW] * size + taken[_COLUMN]
    gram = np.bincount(flat.ravel(), products.ravel(), size * size).reshape(size, size)
    mu = np.linalg.solve(gram, rhs).astype(np.float64, copy=False)
    low, middle, high = mu[taken]
    return _Third(
        starts, widths, values, near, far, mu, rhs, (middle + a * (low - middle), middle, middle + c * (high - middle))
    )


def pulls(space: Space, x: Array, s: Array) -> tuple[Array, float]:
    """Multipliers of values s (k,) at x (k,), and the integral of S'''^2 of the spline through them."""
    d, k = _third(space, x, s), len(x)
    bend = np.zeros(len(d.far))
    bend[1:] += 2.0 * d.mu
    bend[:-1] -= 2.0 * d.mu
    bend *= d.far
    slope = np.zeros(len(d.near))
    slope[1:] += bend
    slope[:-1] -= bend
    slope *= d.near
    pull = np.zeros(len(d.near) + 1)
    pull[1:] += slope
    pull[:-1] -= slope
    square = float(d.mu @ d.rhs)
    if space.rest is not None:
        return pull[3:-3], square
    return np.bincount(np.arange(k + 3) % k, pull, k).astype(np.float64, copy=False), square


def curve_through(space: Space, x: Array, s: Array) -> Curve:
    """Spline of least integral of S'''^2 through values s (k,) at rising x (k,)."""
    d = _third(space, x, s)
    width, (b0, b1, b2) = d.widths, d.bernstein
    c = np.zeros((6, len(width)))
    c[0] = d.values[:-1]
    cube = width**3
    c[3], c[4], c[5] = b0 * cube / 6.0, (b1 - b0) * cube / 12.0, (b0 - 2.0 * b1 + b2) * cube / 60.0
    # what velocity and acceleration add over each piece, seen from its start and from its end
    gain = d.values[1:] - c[0]
    ahead = (gain - c[3] - c[4] - c[5]) / width
    behind = (gain - c[3] - 3.0 * c[4] - 6.0 * c[5]) / width
    bend = np.zeros(len(width))
    if space.rest is None:
        bend = 2.0 * (ahead - np.roll(behind, 1)) / (width + np.roll(width, 1))
    else:
        bend[1:] = 2.0 * (ahead[1:] - behind[:-1]) / (width[1:] + width[:-1])
    c[1], c[2] = (ahead - 0.5 * bend * width) * width, 0.5 * bend * width**2
    if space.rest is not None:
        c[1, 0] = 0.0
    return Curve(d.starts, width, c, 0.0 if space.rest else space.end - space.begin)


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
        """Rows that are touched, for a search nearby to begin with."""
        real = self.row >= 0
        return Touch(self.row[real], self.upper[real])


def least(space: Space, bounds: Bounds, start: Touch | None = None, floor: Floor | None = None) -> Least | None:
    """The function of least mean square jerk within bounds and above a floor, looked for from the rows of `start`.

    None where a constant keeps all the bounds of a function with a period. Raises UnsolvedError where rounding stands
    in the way, and CrowdedError where the bounds touched are too many for it to end in seconds.
    """
    begun = bounds.touching(start)
    for turn in range(_DIPS):
        found = _of_many(space, bounds, begun)
        if found is None or floor is None:
            return found
        x, deep = found.curve.dips(floor.level)
        x = x[deep > floor.depth]
        if not len(x):
            return found
        share = 1.0 if turn < _MOVES else _CLOSE
        bounds = _held_up(space, bounds, found, x, floor=floor, share=share)
        kept = np.isin(found.x, bounds.x)
        begun = Touch(np.searchsorted(bounds.x, found.x[kept]), found.upper[kept])
    raise UnsolvedError


def _held_up(space: Space, bounds: Bounds, found: Least, dips: Array, *, floor: Floor, share: float) -> Bounds:
    """Bounds with one at the floor at each dip; where one holds the function up beside it, that moves towards the dip.

    Beside it is nearer than `share` of the way to the next touch. With 1 none is left that holds the function nowhere:
    knots that come close to each other leave no digits.
    """
    if not space.rest:
        dips = bounds.x[0] + np.mod(dips - bounds.x[0], space.end - space.begin)
    x, hi = dips.copy(), np.full(len(dips), np.inf)
    held = np.flatnonzero(found.row < 0)
    moved = np.zeros(len(bounds.x), dtype=bool)
    if len(held):
        near = held[np.argmin(np.abs(dips[:, None] - found.x[held]), axis=1)]
        away = np.abs(dips[:, None] - np.where(np.arange(len(found.x)) == near[:, None], np.inf, found.x))
        beside = np.abs(dips - found.x[near]) < share * away.min(axis=1)
        old = np.searchsorted(bounds.x, found.x[near[beside]])
        x[beside] += (1.0 - _BETWEEN) * (found.x[near[beside]] - dips[beside])
        hi[beside], moved[old] = bounds.hi[old], True
    idle = (bounds.row < 0) & np.isinf(bounds.hi) & ~np.isin(bounds.x, found.x) & (share == 1.0)
    rest = bounds.at(np.flatnonzero(~moved & ~idle))
    unit = np.full(len(x), _HELD * floor.depth / _MISSED)
    return rest.with_more(Bounds(x, np.full(len(x), floor.level), hi, unit, np.full(len(x), -1)))


def _of_many(space: Space, bounds: Bounds, start: Touch | None) -> Least | None:
    """The same without a floor; `start` has places among the bounds. Of many bounds few are looked at together."""
    n = len(bounds.x)
    chosen = np.arange(n) if n <= _FEW else np.arange(0, n, -(-n // _FEW))
    if start is not None:
        chosen = np.union1d(chosen, start.which)
    work = 0.0
    while True:
        begun = None if start is None else Touch(np.searchsorted(chosen, start.which), start.upper)
        search = _Search(space, bounds.at(chosen), work)
        found, work = search.run(begun), search.work
        if found is None:
            missed = np.array([np.argmax(bounds.lo), np.argmin(bounds.hi)])
            if bounds.lo[missed[0]] <= bounds.hi[missed[1]]:
                return None
        else:
            miss, _ = missed_by(found.curve, bounds)
            miss[chosen] = -1.0
            missed = _worst(miss)
            if not len(missed):
                return found
            start = Touch(chosen[np.searchsorted(bounds.x[chosen], found.x)], found.upper)
        chosen = np.union1d(chosen, missed)


def missed_by(curve: Curve, bounds: Bounds) -> tuple[Array, NDArray[np.bool_]]:
    """By how many units each bound is missed, below 0 inside, and whether the upper one is the nearer, (n,) each."""
    s = curve(bounds.x)
    under, over = (bounds.lo - s) / bounds.unit, (s - bounds.hi) / bounds.unit
    return np.maximum(under, over), over > under


def _worst(miss: Array) -> Indices:
    """The worst of each run of bounds that are missed, by their places."""
    out = miss > _MISSED
    begins = np.flatnonzero(out & ~np.concatenate([[False], out[:-1]]))
    if not len(begins):
        return begins
    run = np.cumsum(np.isin(np.arange(len(miss)), begins, assume_unique=True)) - 1
    places = np.flatnonzero(out)
    order = places[np.lexsort((-miss[places], run[places]))]
    _, first = np.unique(run[order], return_index=True)
    worst: Indices = order[first]
    return worst


class _Search:
    """The search for the bounds that are touched, after so much work (the knots' cubes, summed over the solves)."""

    def __init__(self, space: Space, bounds: Bounds, work: float) -> None:
        self.space, self.bounds, self.work = space, bounds, work
        self.least = 2 if space.rest is None else 0  # bounds that are touched, of a function that is no constant
        self._before: set[bytes] = set()

    def run(self, start: Touch | None) -> Least | None:
        """Add bounds that are missed until there are none."""
        state = None if start is None else self._cleaned(start)
        state = state or self._begun()
        while state is not None:
            touch, pull, square = state
            x, values = self.bounds.x[touch.which], self._values(touch)
            self._count(touch)
            curve = curve_through(self.space, x, values)
            miss, above = missed_by(curve, self.bounds)
            miss[touch.which] = -1.0
            added = _worst(miss)
            if not len(added):
                return Least(self.bounds.row[touch.which], touch.upper, pull, square, x, values, curve)
            upper = above.copy()
            upper[touch.which] = touch.upper
            which = np.union1d(touch.which, added)
            state = self._cleaned(Touch(which, upper[which]))
            if state is None or not state[2] > square * (1.0 + _GROWS):
                worst = np.array([np.argmax(miss)])
                state = self._climbed(touch, pull, added, upper) or self._climbed(touch, pull, worst, upper)
            if state is None or self._seen(state[0]):
                if miss.max() > _STALLED:
                    raise UnsolvedError
                return Least(self.bounds.row[touch.which], touch.upper, pull, square, x, values, curve)
        return None

    def _seen(self, touch: Touch) -> bool:
        """Whether the same bounds were touched before, which rounding alone can bring about."""
        key = touch.which.tobytes() + touch.upper.tobytes()
        again = key in self._before
        self._before.add(key)
        return again

    def _values(self, touch: Touch) -> Array:
        return np.where(touch.upper, self.bounds.hi[touch.which], self.bounds.lo[touch.which])

    def _count(self, touch: Touch) -> None:
        """Add a solve to the work before it is done: one of many thousand knots would take all memory."""
        self.work += float(len(touch.which)) ** 3
        if self.work > _MOST_WORK:
            raise CrowdedError

    def _solved(self, touch: Touch) -> tuple[Array, float]:
        self._count(touch)
        return pulls(self.space, self.bounds.x[touch.which], self._values(touch))

    def _begun(self) -> tuple[Touch, Array, float] | None:
        """The least that any function does: none, or from the greatest lower bound to the least upper one."""
        lo, hi = self.bounds.lo, self.bounds.hi
        if self.space.rest is not None:
            touch = Touch(np.empty(0, dtype=np.intp), np.empty(0, dtype=bool))
            return touch, *self._solved(touch)
        i, j = int(np.argmax(lo)), int(np.argmin(hi))
        if lo[i] <= hi[j]:
            return None
        which = np.array(sorted((i, j)), dtype=np.intp)
        touch = Touch(which, which == j)
        return touch, *self._solved(touch)

    def _cleaned(self, touch: Touch) -> tuple[Touch, Array, float] | None:
        """Only those bounds of a set whose multipliers have their signs; None where too few are left."""
        while len(touch.which) >= self.least:
            pull, square = self._solved(touch)
            right = np.where(touch.upper, -pull, pull) > 0.0
            if right.all():
                return touch, pull, square
            touch = Touch(touch.which[right], touch.upper[right])
        return None

    def _climbed(
        self, touch: Touch, pull: Array, added: Indices, upper: NDArray[np.bool_]
    ) -> tuple[Touch, Array, float] | None:
        """From multipliers with their signs towards those of more bounds, letting go of those that come to 0."""
        size = np.zeros(len(self.bounds.x))
        size[touch.which] = np.abs(pull)
        which = np.union1d(touch.which, added)
        while len(which) >= self.least:
            part = Touch(which, upper[which])
            solved, square = self._solved(part)
            wanted, now = np.where(part.upper, -solved, solved), size[which]
            wrong = wanted <= 0.0
            if not wrong.any():
                return (part, solved, square) if np.isin(added, which).any() else None
            useless = wrong & (now <= 0.0)
            if useless.any():
                which = which[~useless]
                continue
            share = np.where(wrong, now / np.where(wrong, now - wanted, 1.0), np.inf)
            step = float(share.min())
            size[which] = np.maximum(now + step * (wanted - now), 0.0)
            which = which[share > step]
        return None
