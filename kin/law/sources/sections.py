"""Angles at which the acceleration or the jerk of sampled displacements jumps, and where a dwell ends between rows.

A least-squares spline of many spans is drawn through the rows. What it leaves is compared with what would be left of a
row that stands out, of a jump of S or S', and of one of S'' or S''', at every quarter of a row (orthogonal matching
pursuit; Y. C. Pati et al., Asilomar 1993). A jump of S'' or S''' is taken as a joint of the spline and moved to where
the derivative below does not jump, until nothing is left that the reading error would not explain.
"""

from __future__ import annotations

import math
from itertools import pairwise
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kin.law.sources.spline import DEGREE, Basis, Ends, Fitting
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from kin.law.sources.ring import Samples
    from kin.numeric.arrays import Array

ACCELERATION, JERK = 2, 3  # orders of derivatives that a joint lets jump
_MOST_ROWS = 1500  # of more, some are left out in the search
_MOST_JOINTS = 10
_ROWS_A_JOINT = 6  # at least
_GAIN = 12.0  # squares of the reading by which a joint must lessen the sum of squares: six standard deviations
_PARTS = 4  # places looked at between two rows
_WINDOW = 8.0  # spans to each side over which a jump is compared
_APART, _FAR_APART = 3, 6  # rows between two joints; and where the acceleration jumps at one of them
_MERGED = 8  # rows, within which two joints may be one at which the acceleration jumps
_BETWEEN = (0.5, 0.75, 0.25, 1.0, 0.0)  # where between them it is looked for
_THREE = 10  # rows between the first of three joints and the last
_ROUND = 1e-9  # of the squares of a jump: what the spline follows
_SHARES = (1.0, 0.4)  # of such a step, the second where the first does not lessen it
_MOVES = 6  # of the joints, each by Newton's method
_BETTER = 0.97  # of the sum of squares, where a joint has been moved


class Kink(NamedTuple):
    """A joint of a spline: where, and the lowest derivative that jumps."""

    at: float
    order: int


@dataclass(frozen=True)
class Sections:
    """A spline `between` two angles: joints inside, rising; at rest at its ends, or of that period (`ends` None).

    With `ends` it rests at their levels up to its first angle `feet[0]` and from its last one on; `rest` are the
    derivatives that jump there first.
    """

    between: tuple[float, float]
    ends: Ends | None
    feet: tuple[float, float]
    rest: tuple[int, int] = (JERK, JERK)
    kinks: tuple[Kink, ...] = ()

    @staticmethod
    def of(between: tuple[float, float], ends: Ends | None, feet: tuple[float, float] | None = None) -> Sections:
        """One without a joint."""
        return Sections(between, ends, feet or between)

    @property
    def _corners(self) -> list[float]:
        at = [kink.at for kink in self.kinks]
        if self.ends is not None:
            return [self.feet[0], *at, self.feet[1]]
        period = self.between[1] - self.between[0]
        return [*at, at[0] + period] if at else list(self.between)

    def fitting(self, x: Array, count: int, *, loose: bool = False) -> Fitting:
        """Equal spans between joints, about `count` in all, at angles x (n,) of the rows.

        Where it is `loose` one derivative more may jump at every joint and foot.
        """
        corners = self._corners
        total, sites = corners[-1] - corners[0], []
        orders = [kink.order for kink in self.kinks]
        if self.ends is not None:
            orders = [DEGREE, *orders]
        elif not orders:
            orders = [DEGREE]
        for (a, b), order in zip(pairwise(corners), orders, strict=True):
            spans = max(1, round(count * (b - a) / total))
            again = DEGREE + 1 - order + (loose and order < DEGREE)
            sites += [np.full(again - 1, a), np.linspace(a, b, spans + 1)[:-1]]
        basis = Basis(np.concatenate([*sites, [corners[-1]]]), self.ends is None)
        if self.ends is None:
            start, end = corners[0], corners[-1]
            return Fitting(basis, start + np.mod(x - start, end - start), None)
        taken = self.rest[0] - loose, self.rest[1] - loose
        return Fitting(basis, np.clip(x, *self.feet), replace(self.ends, taken=taken))

    def moved(self, x: Array, s: Array, count: int) -> Sections:
        """The same with its joints, and its feet, moved to where the derivative below does not jump."""
        best, left = self, self.left(x, s, count)
        step = float(np.median(np.diff(x)))
        for _ in range(_MOVES):
            trial, after = best, math.inf
            for share in _SHARES:
                trial = best._stepped(x, s, count, step, share) or best
                after = trial.left(x, s, count) if trial is not best else math.inf
                if after < _BETTER * left:
                    break
            if not after < _BETTER * left:
                break
            best, left = trial, after
        return best

    def left(self, x: Array, s: Array, count: int) -> float:
        """Sum of squares that the least-squares spline leaves."""
        try:
            fitting = self.fitting(x, count)
            return float(((fitting.values(fitting.nearest(s)) - s) ** 2).sum())
        except np.linalg.LinAlgError:
            return math.inf

    def _stepped(self, x: Array, s: Array, count: int, step: float, share: float) -> Sections | None:
        fitting = self.fitting(x, count, loose=True)
        try:
            spans = fitting.basis.spans(fitting.nearest(s))
        except np.linalg.LinAlgError:
            return None
        places, (begin, end) = fitting.basis.places, self.between
        taylor = np.array([span.function.coefficients for span in spans])  # type: ignore[attr-defined]
        width = np.diff(places)
        if self.ends is not None:  # the last one is about its end
            taylor[-1] = _shifted(taylor[-1], -1.0)
        factorial = np.array([math.factorial(k) for k in range(DEGREE + 1)])
        right = taylor * factorial / width[:, None] ** np.arange(DEGREE + 1)
        left = np.array([_shifted(row, 1.0) for row in taylor]) * factorial / width[:, None] ** np.arange(DEGREE + 1)

        def by(before: Array, after: Array, order: int) -> float:
            low, high = after[order - 1] - before[order - 1], after[order] - before[order]
            return 0.0 if high == 0.0 else float(np.clip(-share * low / high, -step, step))

        rest = np.zeros(DEGREE + 1)
        kinks = []
        for kink in self.kinks:
            i = int(np.argmin(np.abs(places - kink.at)))
            kinks.append(Kink(kink.at + by(left[i - 1], right[i % len(right)], kink.order), kink.order))
        feet = self.feet
        if self.ends is not None:
            first = max(begin, feet[0] + by(rest, right[0], self.rest[0]))
            last = min(end, feet[1] + by(left[-1], rest, self.rest[1]))
            feet = first, last
        moved = replace(self, kinks=tuple(kinks), feet=feet)
        return moved if moved.sparse(step) else None

    def sparse(self, step: float) -> bool:
        """Whether joints leave enough rows between them, of an angle each, that they cannot follow a single row."""
        kinks = list(self.kinks)
        if self.ends is None:
            period = self.between[1] - self.between[0]
            kinks += [kink._replace(at=kink.at + period) for kink in kinks[:2]]
        else:
            kinks = [Kink(self.feet[0], self.rest[0]), *kinks, Kink(self.feet[1], self.rest[1])]
        return all(
            b.at - a.at >= step * (_APART if a.order == b.order == JERK else _FAR_APART) for a, b in pairwise(kinks)
        ) and all(c.at - a.at >= _THREE * step for a, c in zip(kinks, kinks[2:], strict=False))

    def with_kink(self, kink: Kink, apart: float, twin: float | None) -> Sections:
        """The same with a joint more, or with one in place of those that are less than `apart` from it.

        With a `twin` likewise half a period on.
        """
        if twin is not None and kink.at - self.between[0] >= twin:
            kink = kink._replace(at=kink.at - twin)
        added = [kink] if twin is None else [kink, kink._replace(at=kink.at + twin)]
        near = [any(abs(old.at - new.at) < apart for new in added) for old in self.kinks]
        others = [old for old, close in zip(self.kinks, near, strict=True) if not close]
        return replace(self, kinks=tuple(sorted([*others, *added])))


def _shifted(row: Array, by: float) -> Array:
    """Coefficients of a polynomial (k,) in u, in u - by."""
    out = row.copy()
    for k in range(len(row) - 1):
        for j in range(len(row) - 2, k - 1, -1):
            out[j] += by * out[j + 1]
    return out


def sections_of(rows: Samples, start: Sections, reading: float, spacing: int, twin: float | None = None) -> Sections:
    """Find the joints of rows, and feet between rows.

    They are looked for from a spline of a span for `spacing` rows. Of rows that are laid twice, the second time upside
    down, `twin` is the angle of the half.
    """
    every = -(-len(rows.theta) // _MOST_ROWS)
    x, s = rows.theta[::every], rows.s[::every]
    count, step = max(8, len(x) // spacing), float(np.median(np.diff(x)))
    found = start.moved(x, s, count)
    left = found.left(x, s, count)
    while len(found.kinks) < min(_MOST_JOINTS, len(x) // _ROWS_A_JOINT):
        trials = [found.with_kink(kink, _APART * step, twin) for kink in _next(found, x, s, count)]
        trials = [trial.moved(x, s, count) for trial in (*trials, *_feet(found, x, s)) if trial.sparse(step)]
        after, trial = min(
            ((trial.left(x, s, count), trial) for trial in trials), key=lambda pair: pair[0], default=(left, found)
        )
        if left - after < _GAIN * reading**2:
            break
        found, left = trial, after
    return _plain(found, x, s, count, reading)


def _feet(sections: Sections, x: Array, s: Array) -> list[Sections]:
    """The same with the other derivative that jumps first at a foot, there or where roots lead back to."""
    trials: list[Sections] = []
    if sections.ends is None:
        return trials
    for side, level in ((0, sections.ends.start), (1, sections.ends.end)):
        order = ACCELERATION + JERK - sections.rest[side]
        away = np.abs(s - level)
        near = np.flatnonzero(away > 0.0)
        near = near[1:4] if side == 0 else near[-4:-1]
        places = [sections.feet[side]]
        if len(near) == 3:
            slope, foot = np.polyfit(x[near], away[near] ** (1.0 / order), 1)
            places += [float(np.clip(-foot / slope, *sections.between))] if slope else []
        for place in places:
            feet = (place, sections.feet[1]) if side == 0 else (sections.feet[0], place)
            rest = (order, sections.rest[1]) if side == 0 else (sections.rest[0], order)
            trials.append(replace(sections, feet=feet, rest=rest))
    return trials


def _plain(sections: Sections, x: Array, s: Array, count: int, reading: float) -> Sections:
    """The same with one joint for two that stand close, and where of joints only the jerk jumps.

    Each if that leaves hardly more.
    """
    left, step = sections.left(x, s, count), float(np.median(np.diff(x)))
    for a, b in pairwise(sections.kinks):
        if b.at - a.at < _MERGED * step and a in sections.kinks:
            others = [kink for kink in sections.kinks if kink not in {a, b}]
            for share in _BETWEEN:
                kink = Kink(a.at + share * (b.at - a.at), ACCELERATION)
                trial = replace(sections, kinks=tuple(sorted([*others, kink]))).moved(x, s, count)
                after = trial.left(x, s, count)
                if trial.sparse(step) and after < left + _GAIN * reading**2:
                    sections, left = trial, after
                    break
    for i in range(len(sections.kinks) + 2):
        if i < 2:
            rest = (JERK, sections.rest[1]) if i == 0 else (sections.rest[0], JERK)
            trial = replace(sections, rest=rest)
        else:
            kinks = list(sections.kinks)
            kinks[i - 2] = kinks[i - 2]._replace(order=JERK)
            trial = replace(sections, kinks=tuple(kinks))
        if trial != sections:
            trial = trial.moved(x, s, count)
            after = trial.left(x, s, count)
            if after < left + _GAIN * reading**2:
                sections, left = trial, after
    return sections


def _next(sections: Sections, x: Array, s: Array, count: int) -> list[Kink]:
    """The best place for a joint of each order: where it would lessen the sum of squares most."""
    fitting = sections.fitting(x, count)
    try:
        off = s - fitting.values(fitting.nearest(s))
    except np.linalg.LinAlgError:
        return []
    base, _ = np.linalg.qr(fitting.matrix)
    inner = x[_APART:-_APART] if sections.ends is not None else x
    places = (inner[:, None] + np.median(np.diff(x)) * np.arange(_PARTS) / _PARTS).ravel()
    period = sections.between[1] - sections.between[0]
    window, kinks = _WINDOW * period / count, []
    for order in (ACCELERATION, JERK):
        shape = faded(x, places, order, window, period if sections.ends is None else math.inf)
        whole = (shape * shape).sum(axis=0)
        rest = whole - ((base.T @ shape) ** 2).sum(axis=0)
        rest[rest <= _ROUND * whole] = np.inf
        kinks.append(Kink(float(places[int(np.argmax((off @ shape) ** 2 / rest))]), order))
    return kinks


def faded(x: Array, places: Array, order: int, window: float, period: float) -> Array:
    """Jumps of a derivative at places (m,), seen at x (n,), that fade out over a window to each side: (n, m)."""
    z = x[:, None] - places
    if period < math.inf:
        z = np.mod(z + 0.5 * period, period) - 0.5 * period
    z /= window
    size = np.abs(z)
    fade = np.maximum(1.0 - z * z, 0.0) ** 2
    shape = fade * fade * fade * (size if order else 1.0)
    for _ in range(order - 1):
        shape *= size
    jumps: Array = shape if order % 2 else shape * np.sign(z)
    return jumps
