"""Piecewise functions: stretches written in jet arithmetic between knots, folded by a period, with a side at a knot.

A stretch (`kin.law.segment`) is never evaluated beyond its own knots: a parameter within a few ulp of a knot is the
knot, and belongs to the side that is given, 1 for the right and -1 for the left. So a jump of a derivative is given as
its two limits and never smeared.
"""

from __future__ import annotations

import math
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from kin.law.formula.expression import Expression
from kin.law.segment import AffineStretch, Alike, Harmonic, moved
from kin.numeric.arrays import Array, Indices
from kin.numeric.distinct import distinct
from kin.numeric.elementary import BallJet, DomainError, Jet, cos, sin
from kin.numeric.interval import Ball, hull
from kin.numeric.jet import finite
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Iterator

    from kin.law.segment import Series, Stretch

Side = int | Indices  # 1 or -1 for all, or for each parameter (n,)

# Folding by the period, and the sums and products behind a knot, are each good to about an ulp; a parameter closer to a
# knot than this many ulps is the knot.
_SNAP_ULPS = 8.0
# Stretches shorter than this, relative to the whole, would be lost in that rounding.
_LEAST_STRETCH = 1e-13
_LOOKS = 1024  # parameters at which a formula's rounding is looked at
_AT_ONCE = 200_000  # numbers that describe the stretches of points, which bounds the memory


@dataclass(frozen=True, eq=False)
class _Group:
    """Stretches that are one function moved in several ways; a way is (offset, scale, start, 1/width).

    `ways` is (4, m) over all the stretches of a piecewise function; None where the function stands as it is.
    """

    function: Stretch
    ways: Array | None

    def __call__(self, t: Series, index: Indices) -> Series:
        """Apply the function to points or intervals t (n,), each in its stretch (n,)."""
        if self.ways is None:
            return self.function(t)
        return _moved(self.function, self.ways[:, index], t)


_AS_IS = (0.0, 1.0, 0.0, 1.0)


@dataclass(frozen=True, eq=False)
class _Alike:
    """Stretches of one kind, each with its column of `numbers` (k, m) and its way in `ways` (4, m)."""

    first: Alike
    numbers: Array
    ways: Array

    def __call__(self, t: Series, index: Indices) -> Series:
        """Apply to each of the points or intervals t (n,) the function of its stretch (n,)."""
        half = len(index) // 2
        if len(self.numbers) * half < _AT_ONCE:
            return _moved(self.first.together(self.numbers[:, index]), self.ways[:, index], t)
        kind, rows = type(t), _rows(t)
        first = self(kind(*(row[:, :half] for row in rows)), index[:half])
        try:
            last = self(kind(*(row[:, half:] for row in rows)), index[half:])
        except DomainError as error:
            raise DomainError(error.operation, error.indices + half) from None
        return kind(*map(np.hstack, zip(_rows(first), _rows(last), strict=True)))


def _moved(function: Stretch, ways: Array, t: Series) -> Series:
    """Apply a function moved in the ways (4, n) to t (n,)."""
    offset, scale, start, rate = ways
    if isinstance(t, BallJet):
        value: BallJet = function((t - start) * rate) * scale + offset
        return value
    c = t.c.copy()
    with np.errstate(all="ignore"):
        c[0] -= start
        c *= rate
        c = function(finite(c, "overflow")).c * scale
        c[0] += offset
        return finite(c, "overflow")


def _ways(members: list[Stretch], places: list[int], count: int) -> Array:
    """Ways (4, count) of the stretches `members`, in the columns `places`."""
    ways = np.empty((4, count))
    for place, member in zip(places, members, strict=True):
        ways[:, place] = _AS_IS
        if isinstance(member, AffineStretch):
            ways[:, place] = member.offset, member.scale, member.start, 1 / member.width
    return ways


@dataclass(frozen=True, eq=False)
class _Round:
    """Stretches mean + x cos t + y sin t: rows (3, m) of mean, x and y over all the stretches."""

    parts: Array

    def __call__(self, t: Series, index: Indices) -> Series:
        """Apply each stretch's function to its points or intervals t (n,), in stretches (n,)."""
        mean, x, y = self.parts[:, index]
        total = t.constant(mean)
        return total + cos(t) * x + sin(t) * y if self.parts[1:].any() else total


@dataclass(frozen=True, eq=False)
class Places:
    """Places of points or intervals (n,) among the stretches of a piecewise function.

    Each begins at `low` in the stretch `first` and ends at `high`, `steps` stretches further on, all (n,); `low` and
    `high` are folded by the period.
    """

    first: Indices
    low: Array
    high: Array
    steps: Indices

    def each(self, count: int) -> Iterator[tuple[int, Indices, Indices]]:
        """Yield for steps 0, 1, ... the step, the indices of the places that reach so far, and their stretches there.

        `count` is the number of stretches in a period.
        """
        for step in range(int(self.steps.max(initial=0)) + 1):
            active = np.flatnonzero(self.steps >= step)
            yield step, active, (self.first[active] + step) % count

    def weigh(self, series: Series, numbers: Array) -> Series:
        """Multiply a series by the number of each place's stretch, out of `numbers` (m,); of several by their ball."""
        least, most = numbers[self.first], numbers[self.first]
        if isinstance(series, Jet) or not self.steps.any():
            return series * least
        for _, active, index in self.each(len(numbers)):
            least[active] = np.minimum(least[active], numbers[index])
            most[active] = np.maximum(most[active], numbers[index])
        return series * Ball.between(least, most)


@dataclass(frozen=True, eq=False)
class Piecewise:
    """m functions on the stretches between m + 1 rising knots; `period` is None where the function just ends.

    With a period, knots[-1] = knots[0] + period, the parameter is any real number, and `smooth_seam` tells that
    knots[0] is no break. Raises ValueError for knots that are not finite or do not rise, a count of functions that does
    not fit, or a period that the knots do not span.
    """

    knots: Array
    functions: tuple[Stretch, ...]
    period: float | None = None
    smooth_seam: bool = False

    def __post_init__(self) -> None:
        knots = np.array(self.knots, dtype=float)
        knots.setflags(write=False)
        object.__setattr__(self, "knots", knots)
        if knots.ndim != 1 or len(knots) < 2 or len(self.functions) != len(knots) - 1:
            raise ValueError(f"{len(self.functions)} functions cannot lie between knots of shape {knots.shape}")
        least = _LEAST_STRETCH * max(abs(knots[0]), abs(knots[-1]))
        if not (np.isfinite(knots).all() and (np.diff(knots) > least).all()):
            raise ValueError("knots must be finite and rise")
        if self.period is not None and abs(knots[-1] - knots[0] - self.period) > self._snap(knots[-1:])[0]:
            raise ValueError(f"the knots span {knots[-1] - knots[0]!r}, the period is {self.period!r}")

    @cached_property
    def breaks(self) -> Array:
        """Knots (b,) that are breaks, rising: in [0, period), or without a period those inside the ends."""
        if self.period is None:
            return self.knots[1:-1]
        first = 1 if self.smooth_seam else 0
        folded = np.mod(self.knots[first:-1], self.period)
        folded[self.period - folded <= self._snap(folded)] = 0.0
        folded.sort()
        folded.setflags(write=False)
        return folded

    def raised(self, by: float) -> Piecewise:
        """Give the function plus the constant `by`; constant stretches stay constant."""
        if not by:
            return self
        functions = tuple(moved(f, offset=by) for f in self.functions)
        return Piecewise(self.knots, functions, self.period, self.smooth_seam)

    def taken_from(self, whole: float) -> Piecewise:
        """Give the constant `whole` less the function; constant stretches stay constant."""
        functions = tuple(moved(f, offset=whole, scale=-1.0) for f in self.functions)
        return Piecewise(self.knots, functions, self.period, self.smooth_seam)

    def derivatives(self, t: float | Array, order: int, side: Side = 1) -> Array:
        """Give derivatives 0..order at t (n,) as (order + 1, n); at a knot the right-hand limit, or left (side -1).

        Raises ValueError outside the knots where there is no period and for a parameter that is not finite, DomainError
        where a function does not exist.
        """
        return self.on(Jet.variable(t, order), side).derivatives()

    def enclosure(self, lower: float | Array, upper: float | Array, order: int) -> tuple[Array, Array]:
        """Balls mid +- rad, each (order + 1, n), that hold every derivative 0..order over [lower, upper], each (n,).

        At an end of the interval only the limit from within counts; a knot inside counts with both. An interval no
        longer than the rounding of a knot in it holds both limits. Raises ValueError outside the knots where there is
        no period, and for an interval that ends before it begins.
        """
        rows = self.on(BallJet.variable(lower, upper, order)).bounds()
        enclosed = Ball.between(*rows)
        return enclosed.mid, enclosed.rad

    def jumps(self, order: int) -> tuple[Array, Array]:
        """Break parameters (b,) and the jumps of derivatives 0..order there, right less left limit, (order + 1, b).

        Raises DomainError where a function does not exist at a break.
        """
        at = self.breaks
        return at, self.derivatives(at, order, 1) - self.derivatives(at, order, -1)

    @cached_property
    def rounding(self) -> float:
        """Greatest error of value or slope through the rounding of a recipe's own formula; 0 without one or a period.

        It is the greatest radius that proved arithmetic gives at 1024 parameters over the period and at the breaks:
        digits that a formula loses by cancelling are lost to everyone who computes with it.
        """
        if self.period is None or not any(isinstance(_innermost(f), Expression) for f in self.functions):
            return 0.0
        t = distinct(np.concatenate([np.arange(_LOOKS) * (self.period / _LOOKS), self.breaks]))
        return float(self.enclosure(t, t, 1)[1].max())

    def on(self, t: Series, side: Side = 1) -> Series:
        """Apply the function to a jet or ball jet; `side` decides for jets whose value is a knot.

        Raises ValueError outside the knots where there is no period, DomainError where the function does not exist at a
        jet.
        """
        return self.at(t, self.places(t, side))

    def at(self, t: Series, places: Places) -> Series:
        """Apply the function to a jet or ball jet with known places; DomainError where it does not exist at a jet."""
        if isinstance(t, Jet):
            c = t.c.copy()
            c[0] = places.low
            return self.apply(Jet(c), places.first)
        return self._on_intervals(t, places)

    def places(self, t: Series, side: Side = 1) -> Places:
        """Stretches in which a jet's points lie, or which a ball jet's intervals meet.

        Raises ValueError for points, or ends of intervals, outside the knots where there is no period.
        """
        if isinstance(t, Jet):
            index, x = self.locate(t.c[0], side)
            return Places(index, x, x, np.zeros_like(index))
        lower, upper = t.rows[0].bounds()
        span = math.inf if self.period is None else self.period
        unbounded = ~(upper - lower < span)
        lower = np.where(unbounded, self.knots[0], lower)
        upper = np.where(unbounded, self.knots[-1], upper)
        index, x, turns = self._place(np.concatenate([lower, upper]), np.repeat([1, -1], lower.size))
        (first, last), (low, high) = index.reshape(2, -1), x.reshape(2, -1)
        steps = last - first + len(self.functions) * np.diff(turns.reshape(2, -1), axis=0)[0].astype(np.intp)
        # An interval within the rounding of one knot: both of its sides.
        tiny = steps < 0
        if tiny.any():
            first, low, high = np.where(tiny, last, first), np.where(tiny, high, low), np.where(tiny, low, high)
        return Places(first, low, high, np.abs(steps))

    def _snap(self, t: Array) -> Array:
        scale = np.maximum(np.abs(t), max(abs(self.knots[0]), abs(self.knots[-1])))
        ulps: Array = np.spacing(scale)
        return _SNAP_ULPS * ulps

    def locate(self, t: Array, side: Side = 1) -> tuple[Indices, Array]:
        """Index (n,) of the stretch of each t (n,), at a knot that of `side`, and t folded into that stretch (n,).

        Raises ValueError outside the knots where there is no period and for a parameter that is not finite.
        """
        index, x, _ = self._place(np.asarray(t, dtype=float), side)
        return index, x

    def _place(self, t: Array, side: Side) -> tuple[Indices, Array, Array]:
        """Stretch, folded parameter, and number of whole periods taken off, of each t (n,)."""
        knots, last = self.knots, len(self.functions) - 1
        if not np.isfinite(t).all():
            raise ValueError("a parameter is not finite")
        turns = np.zeros_like(t) if self.period is None else np.floor((t - knots[0]) / self.period)
        x = t if self.period is None else t - turns * self.period
        inside = np.minimum(np.maximum(np.searchsorted(knots, x, side="right") - 1, 0), last)
        # the common case first: no parameter near a knot
        below, above = x - knots[inside], knots[inside + 1] - x
        least = np.minimum(below, above)
        if t.size and least.min() > self._snap(np.abs(t).max(keepdims=True))[0]:
            return inside, x, turns
        snap = self._snap(t)
        if self.period is None and (least < -snap).any():
            raise ValueError(f"a parameter lies outside {knots[0]} to {knots[-1]}")
        # a parameter within rounding of a knot goes to the stretch on its side
        below, above = np.abs(below), np.abs(above)
        on_knot = np.minimum(below, above) <= snap
        if not on_knot.any():
            return inside, x, turns
        near = np.where(below < above, inside, inside + 1)
        right = np.asarray(side) > 0
        index = np.where(on_knot, near - 1 + right, inside)
        if self.period is not None:  # at the seam the side may lead into the next or the last period
            wrap = np.floor_divide(index, last + 1)
            index = index - wrap * (last + 1)
            turns = turns + wrap
            near = np.where(on_knot, index + 1 - right, near)
        index = np.minimum(np.maximum(index, 0), last)
        return index, np.where(on_knot, knots[near], x), turns

    @cached_property
    def _groups(self) -> tuple[Indices, tuple[_Group | _Alike | _Round, ...]]:
        """Index (m,) of each stretch's group, and the groups, each of which is evaluated in one go.

        A group is all first harmonics, the stretches of one kind, or one function moved in several ways.
        """
        # stretches by kind, or by the function itself; first harmonics apart
        by_stretch: dict[Stretch | tuple[str, int], list[int]] = {}
        owner = np.zeros(len(self.functions), dtype=np.intp)
        parts, arcs = np.zeros((3, owner.size)), []
        for i, function in enumerate(self.functions):
            if isinstance(function, Harmonic):
                parts[:, i] = function.first_harmonic
                arcs.append(i)
            else:
                bare = _bare(function)
                by_stretch.setdefault(bare.kind if isinstance(bare, Alike) else bare, []).append(i)
        # numbers and ways are columns over all stretches, so that an index of stretches picks them
        groups: list[_Group | _Alike | _Round] = []
        for number, members in enumerate(by_stretch.values()):
            owner[members] = number
            stretches = [self.functions[i] for i in members]
            first, ways = _bare(stretches[0]), _ways(stretches, members, owner.size)
            if isinstance(first, Alike):
                rows = np.zeros((len(first.numbers), owner.size))
                rows[:, members] = np.transpose(
                    [bare.numbers for f in stretches if isinstance(bare := _bare(f), Alike)]
                )
                groups.append(_Alike(first, rows, ways))
            else:
                as_is = not any(isinstance(member, AffineStretch) for member in stretches)
                groups.append(_Group(first, None if as_is else ways))
        if arcs:
            owner[arcs] = len(groups)
            groups.append(_Round(parts))
        return owner, tuple(groups)

    def _on_intervals(self, t: BallJet, places: Places) -> BallJet:
        mid, rad = np.zeros_like(t.mid), np.full_like(t.rad, math.inf)
        for step, active, index in places.each(len(self.functions)):
            begin = places.low[active] if step == 0 else self.knots[index]
            end = np.where(places.steps[active] == step, places.high[active], self.knots[index + 1])
            part = self.apply(self._within(index, begin, end, t, active), index).rows
            if step:
                part = hull(Ball(mid[:, active], rad[:, active]), part)
            mid[:, active], rad[:, active] = part.mid, part.rad
        return BallJet(mid, rad)

    def _within(self, index: Indices, begin: Array, end: Array, t: BallJet, here: Indices) -> BallJet:
        """Intervals number `here` of t with their values replaced by [begin, end], each inside its stretch `index`."""
        # The fold t - turns * period is rounded; its ulp is covered, within the stretch. An interval that begins at
        # exactly 0 is taken as it is.
        slack = np.where(np.abs(begin) > 0, np.spacing(np.maximum(np.abs(t.mid[0, here]), np.abs(begin))), 0.0)
        interval = Ball.between(
            np.maximum(begin - slack, self.knots[index]), np.minimum(end + slack, self.knots[index + 1])
        )
        mid, rad = t.mid[:, here], t.rad[:, here]
        mid[0], rad[0] = interval.mid, interval.rad
        return BallJet(mid, rad)

    def apply(self, t: Series, index: Indices) -> Series:
        """Apply to each of the points or intervals t (n,), which lie in stretches `index` (n,), its stretch's function.

        Raises DomainError where a function does not exist at a jet.
        """
        owner, groups = self._groups
        if len(groups) == 1:
            return groups[0](t, index)
        group_of, kind, rows = owner[index], type(t), _rows(t)
        used = np.flatnonzero(np.bincount(group_of))
        if len(used) == 1:
            return groups[used[0]](t, index)
        out = [np.empty_like(row) for row in rows]
        for number in used:
            members = np.flatnonzero(group_of == number)
            try:
                part = groups[number](kind(*(row[:, members] for row in rows)), index[members])
            except DomainError as error:
                raise DomainError(error.operation, members[error.indices]) from None
            for row, values in zip(out, _rows(part), strict=True):
                row[:, members] = values
        return kind(*out)


def _bare(function: Stretch) -> Stretch:
    return function.function if isinstance(function, AffineStretch) else function


def _innermost(function: object) -> object:
    """The function itself, freed from all movements around it."""
    within = getattr(function, "function", None)
    return function if within is None else _innermost(within)


def _rows(t: Jet | BallJet) -> tuple[Array, ...]:
    return (t.c,) if isinstance(t, Jet) else (t.mid, t.rad)
