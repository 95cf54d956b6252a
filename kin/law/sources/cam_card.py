"""Lobes by their cam cards: the lift, and the angles over which a lobe is above stated lifts.

The powers 2-p-q-r-s of the lobe polynomial are whole numbers, so that no single member of the family meets a card. A
mixture of members over one angle, with weights of 0 or more that sum to 1, is a lobe polynomial too: each rises
from its foot to its nose without a turn (of S' five terms change their sign four times at most, Descartes, and its
fourfold zero at the foot takes all four), and so does the mixture. Lift and slopes are linear in the weights, so that
the mixture of least peak acceleration is a linear programme for each angle.

Whether there is one at any angle is decided by weak duality: the multipliers of a programme that misses its rows bound
the miss of every other from below, so that a few programmes exclude all angles, or lead to those that have a lobe. The
bounds are worked out at single angles, and between two of these the lesser counts, which is no proof.
"""

from __future__ import annotations

import math
from functools import cache, lru_cache
from itertools import combinations, pairwise, product
from operator import itemgetter
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kin.law.normalised import IntentError
from kin.law.sources.functions import Flank
from kin.law.sources.lobe import LobeSide, Ramp
from kin.numeric.linear_programme import minimise

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kin.numeric.arrays import Array, Indices

_POWERS = (4, 6, 8, 10, 14, 20, 26, 34, 44, 60, 80, 100)  # of the members that are mixed: four of them, after 2
_ALL = (2, *_POWERS)
_EXPONENTS = np.array(_ALL, dtype=float)
_NONE = "no lobe of the family is above these lifts for so long"


class _Cuts(NamedTuple):
    """Programmes for the mixture of a side: the acceleration is bounded at few places, to which the worst are added."""

    looks: int = 1024
    """Places from the nose to the foot at which the acceleration is looked at."""
    rounds: int = 12
    """Rounds in which places with a greater acceleration are added to a programme."""
    close: float = 5e-5
    """Share of a peak: an acceleration greater by less needs no new place."""
    active: float = 0.98
    """Share of the peak: places with a lesser acceleration are dropped before the next programme."""
    exact: float = 1e-10
    """Share of the lift: rows of a programme that are missed by less count as met, and are corrected."""
    weight: float = 1e-12
    """Share of a mixture: a lesser weight is rounding."""


class _Angles(NamedTuple):
    """Search for the angles of both sides, from foot to nose, with the least peak."""

    first: int = 65
    """Angles of a side between which its bounds are looked at first."""
    shortest: float = 1e-3
    """Share of the longest side that the shortest has."""
    beside: float = 1e-5
    """Share of the angle of a crossing: the least by which a side is longer."""
    step: float = 1e-6
    """Share of an angle over which a slope is taken."""
    tries: int = 60
    """Pairs of angles, at most, for the least peak."""
    most: int = 100
    """Pairs of angles, at most, for a lobe: the last decide on less than a card's rounding."""
    grid: int = 33
    """Angles of a side among which those in the middle are taken."""
    few: int = 30
    """Pairs left, below which others are taken between them."""
    border: float = 1e-6
    """Share of what a tangent says over all pairs that are left: less is rounding."""
    narrow: float = 1e-10
    """Share of an angle: angles that differ by less are one."""
    lower: float = 1e-4
    """Share of a peak: a lobe whose peak is lower by less is not looked for."""


class _Nearest(NamedTuple):
    """The card nearest to one that no lobe meets; in degrees of the crank."""

    read: tuple[float, ...] = (0.0, 1e-6, 5e-4)
    """Differences, one after another, by which a card's rounding may take it off a lobe."""
    met: float = 1e-8
    """A card that is off by less is met."""
    accuracy: float = 0.005
    """The nearest card's difference is the least but for this."""
    farthest: float = 720.0
    """Greatest difference of the nearest card."""
    inward: float = 0.01
    """What the nearest card may differ by more, to leave the border."""
    further: int = 8
    """Doublings of that."""
    places: tuple[int, ...] = (2, 3, 4)
    """Decimal places of the nearest card: more where its rounding is not met."""
    fine: int = 150
    """Angles of both sides, at most, for a difference: more decide on less than the accuracy."""


CUTS, ANGLES, NEAREST = _Cuts(), _Angles(), _Nearest()


class Crossing(NamedTuple):
    """A row of a cam card: a lift, mm or rad, and the cam angle from the nose, rad, at which the lift is crossed."""

    lift: float
    angle: float


class SideCard(NamedTuple):
    """One side of a lobe as a card gives it: its crossings, or the side itself, `known`.

    `half`, rad, is the angle from foot to nose, None where it is free. `crank` is degrees of a duration by degrees of
    the cam from the nose: 4 where a duration is that of both sides, 2 of one. `field` is the crossings' field.
    """

    crossings: tuple[Crossing, ...] = ()
    half: float | None = None
    ramp: Ramp | None = None
    known: LobeSide | None = None
    crank: float = 4.0
    field: str = "motion.lobe"


class Mixture(NamedTuple):
    """A side that meets a card, and (powers, weight) of its members, by falling weight; () for a known side.

    `off` is the greatest difference of a crossing from the card, degrees of the crank, 0 but for a card on the border.
    """

    members: tuple[tuple[tuple[int, ...], float], ...]
    side: LobeSide
    off: float = 0.0


@cache
def _members() -> tuple[tuple[int, ...], ...]:
    return tuple((2, *four) for four in combinations(_POWERS, 4))


@cache
def _lagrange() -> tuple[Array, Array]:
    """Lagrange's polynomials over the powers of each of n members, at 0 and at 1: (n, 13) each, a column a power."""
    places = {power: k for k, power in enumerate(_ALL)}
    at_0, at_1 = np.zeros((2, len(_members()), len(_ALL)))
    for i, powers in enumerate(_members()):
        for k in powers:
            remaining = [p for p in powers if p != k]
            at_0[i, places[k]] = math.prod(p / (p - k) for p in remaining)
            at_1[i, places[k]] = math.prod((p - 1) / (p - k) for p in remaining)
    return at_0, at_1


@cache
def _powers(order: int) -> Array:
    """First or second derivatives of the powers of u (n, 13), at CUTS.looks places from the nose to before the foot."""
    u = np.linspace(0.0, 1.0, CUTS.looks + 1)[:-1]
    factor = _EXPONENTS if order == 1 else _EXPONENTS * (_EXPONENTS - 1.0)
    powers: Array = factor * u[:, None] ** (_EXPONENTS - order)
    return powers


class _Family(NamedTuple):
    """Members of one lift over one angle `half`, rad: indices, and their coefficients (n, 13) of the powers of u."""

    lift: float
    half: float
    chosen: Indices
    coefficients: Array

    @staticmethod
    def of(lift: float, half: float, ramp: Ramp | None) -> _Family:
        """Members whose acceleration at the nose is negative; beside a steep ramp it is not in some."""
        (at_0, at_1), (first, second) = _lagrange(), _shares(lift, np.array(half), ramp)
        every = first * at_0 + second * at_1
        chosen = np.flatnonzero(every[:, 0] < 0.0)
        return _Family(lift, half, chosen, every[chosen])

    def lifts(self, angle: float) -> Array:
        """Each member's lift (n,), as a share of the whole lift, at an angle from the nose, rad."""
        return 1.0 + self.coefficients @ (angle / self.half) ** _EXPONENTS

    def derivatives(self, places: Sequence[int], order: int) -> Array:
        """Each member's S' or S'' (k, n), as shares of the lift by rad, at k of the places from nose to foot."""
        return _powers(order)[places] @ self.coefficients.T / self.half**order

    def derivative(self, weights: Array, order: int) -> Array:
        """S' or S'' (CUTS.looks,) of a mixture by weights (n,), shares of the lift by rad, from nose to foot."""
        return _powers(order) @ (weights @ self.coefficients) / self.half**order


def _shares(lift: float, halves: Array, ramp: Ramp | None) -> tuple[Array, Array]:
    """Shares of Lagrange's polynomials at 0 and at 1 in the members over angles, rad."""
    if ramp is None:
        return np.full_like(halves, -1.0), np.zeros_like(halves)
    slopes = ramp.velocity * halves / lift
    return ramp.height / lift - 1.0 + slopes, -slopes


class _Cut(NamedTuple):
    """A side's place, one of `CUTS.looks`, at which what is made least, times `sign`, is bounded in a programme."""

    side: int
    place: int
    sign: float


class _Bound(NamedTuple):
    """A lower bound of what a programme makes least, over any angles, by the multipliers of one (weak duality).

    Weights are 0 or more and sum to 1 on each side. So what is made least is nowhere below the multipliers' sum of the
    right sides, `level`, and for each side the least of what they leave of a member. `crossings` are the multipliers of
    each side's crossings, `bends` (2, 13) what those of each side's S' and S'' leave of the powers' derivatives.
    """

    level: float
    crossings: tuple[Array, ...]
    bends: tuple[Array, ...]

    @staticmethod
    def of_nothing(cards: Sequence[SideCard]) -> _Bound:
        """The bound 0."""
        crossings = tuple(np.zeros(len(card.crossings)) for card in cards)
        return _Bound(0.0, crossings, (np.zeros((2, len(_ALL))),) * len(cards))


def _members_left(
    bounds: Sequence[_Bound], i: int, lift: float, card: SideCard, halves: Array, *, within: float
) -> Array:
    """What the multipliers of m bounds leave of every member of side i, over k angles of it, rad: (m, k, n).

    Crossings may be off by `within` degrees of the crank.
    """
    own, bends = np.array([bound.crossings[i] for bound in bounds]), np.array([bound.bends[i] for bound in bounds])
    angles = [crossing.angle for crossing in card.crossings] - np.sign(own) * math.radians(within / card.crank)
    powers = np.clip(angles[:, None, :] / halves[:, None], 0.0, 1.0)[..., None] ** _EXPONENTS
    bent = bends[:, None, 0] / halves[:, None] + bends[:, None, 1] / halves[:, None] ** 2
    left = bent - np.einsum("mc,mkcp->mkp", own, powers)
    (at_0, at_1), (first, second) = _lagrange(), _shares(lift, halves[:, None], card.ramp)
    of_members: Array = left * first @ at_0.T
    return of_members if card.ramp is None else of_members + left * second @ at_1.T


def _parts(bounds: Sequence[_Bound], i: int, lift: float, card: SideCard, halves: Array, *, within: float) -> Array:
    """The part (m, k) of side i in m bounds at k angles of it, rad; inf where there are no members."""
    (at_0, at_1), (first, second) = _lagrange(), _shares(lift, halves[:, None], card.ramp)
    members = first * at_0[:, 0] + second * at_1[:, 0] < 0.0
    levels = np.array([[bound.level / len(bound.crossings)] for bound in bounds])
    left = _members_left(bounds, i, lift, card, halves, within=within)
    least: Array = levels + left.min(axis=2, where=members, initial=math.inf)
    return least


class _Solution(NamedTuple):
    """What a programme gives: the least peak of |S'| or |S''|, a share of the lift, and the weights of each side.

    Where no mixture meets its rows the peak is inf, and the weights are those of the least miss. The bound is one of
    what was made least.
    """

    peak: float
    families: tuple[_Family, ...]
    weights: list[Array]
    bound: _Bound

    def rise(self, lift: float, cards: Sequence[SideCard], within: float) -> Array:
        """How what was made least grows with the angle of each side, by rad (d,), at the same multipliers."""
        slopes = []
        for i, (family, card, weights) in enumerate(zip(self.families, cards, self.weights, strict=True)):
            halves = family.half * np.array([1.0 - ANGLES.step, 1.0 + ANGLES.step])
            low, high = _members_left([self.bound], i, lift, card, halves, within=within)[0][:, family.chosen] @ weights
            slopes.append((high - low) / (2.0 * ANGLES.step * family.half))
        return np.array(slopes)


class _Programme(NamedTuple):
    """Sides over their angles: mixtures that meet their crossings, and have one acceleration at the nose.

    A crossing may be off by `within` degrees of the crank. `nose` is the acceleration at the nose of a known side, as a
    share of the lift by rad^2. Rows are linear equations of the members' weights, the columns. The peak of S' or S'',
    by the `order`, is made least.
    """

    families: tuple[_Family, ...]
    cards: tuple[SideCard, ...]
    nose: float | None
    within: float = 0.0
    order: int = 2

    def met(self) -> _Solution:
        """Any mixture that meets the rows, or where there is none the least miss of them."""
        rows, right = self._rows()
        solution = minimise(np.zeros(rows.shape[1]), rows, right, CUTS.exact)
        weights = self._weights(solution.x if solution.missed else self._exact(solution.x, rows, right))
        bends = [family.derivative(own, self.order) for family, own in zip(self.families, weights, strict=True)]
        peak = math.inf if solution.missed else max(float(np.abs(own).max()) for own in bends)
        return _Solution(peak, self.families, weights, self._bound(solution.multipliers, [], ()))

    def solve(self, cuts: list[_Cut]) -> _Solution:
        """The least peak of |S'| or |S''|, or where no mixture meets the rows the least miss of them.

        `cuts` are where it is bounded from the first. Places at which it turns out greater are added to
        the list, those far below the peak are dropped from it. Without a member on each side there is no mixture.
        """
        if not all(len(family.chosen) for family in self.families):
            weights = [np.zeros(len(family.chosen)) for family in self.families]
            return _Solution(math.inf, self.families, weights, _Bound.of_nothing(self.cards))
        rows, right = self._rows()
        ends = np.cumsum([0, *(len(family.chosen) for family in self.families)]).tolist()
        columns = [slice(a, b) for a, b in pairwise(ends)]
        for _ in range(CUTS.rounds):
            # columns: weights, the peak as a share of the least greatest acceleration, and a slack for each cut
            count = len(cuts)
            lower = np.zeros((count, rows.shape[1]))
            for i, family in enumerate(self.families):
                own = [k for k, cut in enumerate(cuts) if cut.side == i]
                signs = np.array([cuts[k].sign for k in own]).reshape(-1, 1)
                lower[own, columns[i]] = signs * family.derivatives([cuts[k].place for k in own], self.order)
            size = np.abs(lower).max(axis=1)
            unit = float(size.min())
            whole = np.block(
                [
                    [rows, np.zeros((len(rows), 1 + count))],
                    [lower / size[:, None], -unit / size[:, None], np.eye(count)],
                ]
            )
            cost = np.zeros(whole.shape[1])
            cost[rows.shape[1]] = 1.0
            solution = minimise(cost, whole, np.concatenate([right, np.zeros(count)]), CUTS.exact)
            weights = self._weights(solution.x)
            if not math.isfinite(solution.value):
                return _Solution(math.inf, self.families, weights, self._bound(solution.multipliers, [], ()))
            level = solution.value * unit
            bends = [family.derivative(own, self.order) for family, own in zip(self.families, weights, strict=True)]
            new = [cut for cut in _peaks(bends, level * (1.0 + CUTS.close)) if cut not in cuts]
            if not new:
                break
            cuts += new
        multipliers = solution.multipliers * unit
        bound = self._bound(multipliers[: len(rows)], cuts, -multipliers[len(rows) :] / size)
        cuts[:] = [cut for cut in cuts if cut.sign * bends[cut.side][cut.place] > CUTS.active * level]
        x = self._exact(solution.x, rows, right)
        peak = max(float(np.abs(own).max()) for own in bends)
        return _Solution(peak, self.families, self._weights(x), bound)

    @staticmethod
    def _exact(x: Array, rows: Array, right: Array) -> Array:
        """The weights, corrected by least squares for what rounding has left of the rows."""
        used = np.flatnonzero(x[: rows.shape[1]] > CUTS.weight)
        x = x[: rows.shape[1]].copy()
        more, *_ = np.linalg.lstsq(rows[:, used], right - rows @ x, rcond=None)
        x[used] += more
        return x

    def inner(self) -> list[Array]:
        """Weights that meet the rows, with as great a share of an even mixture of all members as any have.

        Cards beside that of such a mixture can be met too: the weights of the members have room on both sides.
        """
        rows, right = self._rows()
        even = [np.full(len(family.chosen), 1.0 / len(family.chosen)) for family in self.families]
        mixed = rows[:, : sum(map(len, even))] @ np.concatenate(even)
        cost = np.append(np.zeros(rows.shape[1]), -1.0)
        x = minimise(cost, np.column_stack([rows, mixed]), right, CUTS.exact).x
        return [own + x[-1] * share for own, share in zip(self._weights(x), even, strict=True)]

    def _rows(self) -> tuple[Array, Array]:
        """Rows and right sides: of each side weights that sum to 1 and crossings, then one acceleration at the nose.

        With `within` a crossing is two inequalities, each with a slack column behind those of the weights.
        """
        size = sum(len(family.chosen) for family in self.families)
        slack = 0 if self.within == 0.0 else 2 * sum(len(card.crossings) for card in self.cards)
        rows: list[Array] = []
        right: list[float] = []
        start, used = 0, size
        for family, card in zip(self.families, self.cards, strict=True):
            columns = slice(start, start + len(family.chosen))
            start = columns.stop
            row = np.zeros(size + slack)
            row[columns] = 1.0
            rows.append(row)
            right.append(1.0)
            for lift, angle in card.crossings:
                off = math.radians(self.within / card.crank)
                for sign in (-1.0, 1.0) if off else (0.0,):
                    row = np.zeros(size + slack)
                    row[columns] = family.lifts(min(max(angle + sign * off, 0.0), family.half))
                    if sign:
                        row[used] = sign
                        used += 1
                    rows.append(row)
                    right.append(lift / family.lift)
        # the acceleration at the nose is that of the known side, or the same on both sides; scaled to about 1
        if self._meets_nose:
            noses = [family.derivatives([0], 2)[0] for family in self.families]
            row = np.zeros(size + slack)
            row[:size] = np.concatenate([(-1.0) ** i * nose for i, nose in enumerate(noses)]) / self._nose_unit
            rows.append(row)
            right.append((self.nose or 0.0) / self._nose_unit)
        return np.array(rows), np.array(right)

    def _weights(self, x: Array) -> list[Array]:
        ends = np.cumsum([0, *(len(family.chosen) for family in self.families)])
        return [x[a:b] for a, b in pairwise(ends.tolist())]

    @property
    def _meets_nose(self) -> bool:
        return self.nose is not None or len(self.families) > 1

    @property
    def _nose_unit(self) -> float:
        return max(float(np.abs(family.derivatives([0], 2)).max()) for family in self.families)

    def _bound(self, multipliers: Array, cuts: Sequence[_Cut], shares: Sequence[float] | Array) -> _Bound:
        """The bound by the multipliers (m,) of the rows, and those at the cuts, 0 or more, which sum to 1."""
        ways = 1 if self.within == 0.0 else 2
        level, start = 0.0, 0
        crossings = []
        bends = np.zeros((len(self.families), 2, len(_ALL)))
        for family, card in zip(self.families, self.cards, strict=True):
            end = start + 1 + ways * len(card.crossings)
            own = multipliers[start + 1 : end].reshape(-1, ways).sum(axis=1)
            level += sum(
                y * (row.lift / family.lift - 1.0) for y, row in zip(own.tolist(), card.crossings, strict=True)
            )
            crossings.append(own)
            start = end
        for cut, share in zip(cuts, shares, strict=False):  # cuts of a last round come behind
            bends[cut.side, self.order - 1] += cut.sign * share * _powers(self.order)[cut.place]
        if self._meets_nose:
            last = float(multipliers[-1]) / self._nose_unit
            level += last * (self.nose or 0.0)
            bends[:, 1] -= last * np.array([[1.0], [-1.0]])[: len(bends)] * _powers(2)[0]
        return _Bound(level, tuple(crossings), tuple(bends))


def _peaks(bends: Sequence[Array], level: float) -> list[_Cut]:
    """Places at which a side's derivative, of either sign, is greater than a level and than beside."""
    cuts = []
    for side, own in enumerate(bends):
        for sign in (1.0, -1.0):
            values = np.concatenate([[-math.inf], sign * own, [-math.inf]])
            inner = values[1:-1]
            highest = (inner > level) & (inner >= values[:-2]) & (inner > values[2:])
            cuts += [_Cut(side, int(place), sign) for place in np.flatnonzero(highest)]
    return cuts


class _Search:
    """The lobes of two sides, or one, over all their angles."""

    def __init__(
        self, lift: float, cards: Sequence[SideCard], nose: float | None, most: float, *, order: int = 2
    ) -> None:
        self._lift, self._cards, self._nose, self._most = lift, tuple(cards), nose, most
        self._order = order
        self._bounds = [_Bound.of_nothing(cards)]
        self._axes: list[Array] = []  # angles of each side: no lobe lies beyond their ends
        self._open: Array = np.array([])  # whether a lobe may lie between two neighbouring angles of each side

    def met(self, within: float = 0.0, fine: float = math.inf) -> _Solution | None:
        """A lobe whose crossings are off by no more than `within` degrees of the crank; None where there is none.

        Each programme that misses its rows gives a bound of the miss for all angles. Another is solved where no bound
        excludes a lobe. Between two angles the lesser of what a bound is at both counts, and angles between them are
        looked at until that excludes all lobes. On the border, where a few billionths of an angle decide, no more than
        `ANGLES.most` are solved, and no more than `fine` angles looked at in what is left, and then it is None too.
        """
        self._axes = [_angles(card, self._most, within) for card in self._cards]
        self._open = np.full([max(len(axis) - 1, 1) for axis in self._axes], fill_value=True)
        parts = [self._parts(i, axis, within, self._bounds) for i, axis in enumerate(self._axes)]
        solved: set[tuple[float, ...]] = set()
        while len(solved) < ANGLES.most and (halves := self._next(parts, solved, within, fine)) is not None:
            solved.add(halves)
            solution = self._programme(halves, within).met()
            if math.isfinite(solution.peak):
                return solution
            self._bounds.append(solution.bound)
            for i, axis in enumerate(self._axes):
                parts[i] = np.vstack([parts[i], self._parts(i, axis, within, self._bounds[-1:])])
        return None

    def _next(
        self, parts: list[Array], solved: set[tuple[float, ...]], within: float, fine: float
    ) -> tuple[float, ...] | None:
        """Angles not solved at which no bound excludes a lobe; None if there are none, nor between `fine` others.

        `parts` (m, k) of each side are its parts in all bounds at its angles. Where angles are added, or left out as no
        lobe lies beyond others, they change.
        """
        while True:
            places = np.argwhere(self._open)
            lesser = [_lesser(part) for part in parts]
            closed = _sums(lesser, places) > CUTS.exact
            self._open[tuple(places[closed].T)] = False
            places = places[~closed]
            if not len(places):
                return None
            low, high = places.min(axis=0), places.max(axis=0) + 2
            self._axes = [axis[low[i] : high[i]] for i, axis in enumerate(self._axes)]
            self._open = self._open[tuple(slice(a, b - 1) for a, b in zip(low, high, strict=True))]
            parts[:] = [part[:, low[i] : high[i]] for i, part in enumerate(parts)]
            if len(self._bounds) == 1:
                return tuple(float(axis[2 * len(axis) // 3]) for axis in self._axes)
            # the bound of no rows is 0 everywhere: the others say where most is left
            left = _sums([own[1:] for own in lesser], places)
            for place in (places[np.argsort(left, kind="stable")] - low).tolist():
                corners = [range(k, min(k + 2, len(axis))) for k, axis in zip(place, self._axes, strict=True)]
                for corner in product(*corners):
                    halves = tuple(float(axis[k]) for axis, k in zip(self._axes, corner, strict=True))
                    if halves not in solved and _sums(parts, np.array([corner]))[0] <= CUTS.exact:
                        return halves
                wide = [
                    i
                    for i, k in enumerate(place)
                    if np.ptp(self._axes[i][k : k + 2]) > ANGLES.narrow * self._axes[i][k]
                ]
                if wide:
                    break
            else:
                return None
            if sum(map(len, self._axes)) > fine:
                return None
            for i in wide:
                k = place[i] + 1
                middle = 0.5 * (self._axes[i][k - 1 : k] + self._axes[i][k : k + 1])
                self._axes[i] = np.insert(self._axes[i], k, middle)
                self._open = np.insert(self._open, k, self._open.take(k - 1, axis=i), axis=i)
                parts[i] = np.insert(parts[i], [k], self._parts(i, middle, within, self._bounds), axis=1)

    def least(self, within: float = 0.0) -> _Solution | None:
        """The lobe of least peak whose crossings are off by no more than `within` degrees; None where there is none.

        Of the angles that are left those in the middle are tried, and the multipliers say where the peak is higher, or
        the miss greater, and those are left out (the method of centres of gravity, A. Yu. Levin, Doklady 160, 1965). So
        it is the least if the peak has one valley over the angles, as in every card that was tried.
        """
        best = self.met(within)
        if best is None:
            return None
        low, high = (np.array([axis[k] for axis in self._axes]) for k in (0, -1))
        # at the nose there is no velocity
        spread = range(0 if self._order == 2 else CUTS.looks // 8, CUTS.looks, CUTS.looks // 8)
        cuts = [_Cut(i, k, sign) for i in range(len(low)) for sign in (1.0, -1.0) for k in spread]
        tried: list[tuple[float, Array, Array]] = []  # a peak, or -inf, its angles, and how it rises with them
        middle = np.array([family.half for family in best.families])
        for _ in range(ANGLES.tries):
            solution = self._programme(middle.tolist(), within).solve(cuts)
            rise = solution.rise(self._lift, self._cards, within)
            if math.isfinite(solution.peak):
                tried.append((solution.peak, middle, rise))
                best = min(best, solution, key=itemgetter(0))
            else:  # never beyond the best
                away = middle - np.array([family.half for family in best.families])
                tried.append((-math.inf, middle, rise if rise @ away > 0.0 else away))
            left = _lower(low, high, tried)
            if len(left) < ANGLES.few:
                step = (high - low) / (ANGLES.grid - 1)
                if not len(left) or (step <= ANGLES.narrow * low).all():
                    break
                low, high = np.maximum(left.min(axis=0) - step, low), np.minimum(left.max(axis=0) + step, high)
                left = _lower(low, high, tried)
            # tangents at other angles may pass above the valley, as the peak bends down on its way there
            lowest = min((row for row in tried if math.isfinite(row[0])), key=itemgetter(0), default=None)
            if lowest is not None and ((left - lowest[1]) @ lowest[2]).min(initial=0.0) >= -ANGLES.lower * lowest[0]:
                break
            middle = left.mean(axis=0)
        return best

    def inner(self, lobe: _Solution, within: float) -> _Solution:
        """A lobe over the angles of another whose crossings are off by less than `within`, off the border of such."""
        halves = [family.half for family in lobe.families]
        return lobe._replace(weights=self._programme(halves, within).inner())

    def _programme(self, halves: Sequence[float], within: float) -> _Programme:
        families = tuple(
            _Family.of(self._lift, half, card.ramp) for half, card in zip(halves, self._cards, strict=True)
        )
        return _Programme(families, self._cards, self._nose, within, self._order)

    def _parts(self, i: int, angles: Array, within: float, bounds: Sequence[_Bound]) -> Array:
        """The part of a side in bounds at its angles, (m, k)."""
        return _parts(bounds, i, self._lift, self._cards[i], angles, within=within)


def _lower(low: Array, high: Array, tried: Sequence[tuple[float, Array, Array]]) -> Array:
    """Angles (n, d) of a grid from `low` to `high`, (d,), towards which nothing that was tried rises."""
    axes = [np.linspace(a, b, ANGLES.grid) if b > a else np.array([a]) for a, b in zip(low, high, strict=True)]
    grid = np.stack(np.meshgrid(*axes), axis=-1).reshape(-1, len(low))
    for _, at, slope in tried:
        # those on the border stay, whatever rounding says of them: they are often in the grid
        grid = grid[(grid - at) @ slope <= ANGLES.border * (np.abs(slope) @ (high - low))]
    return grid


def _lesser(part: Array) -> Array:
    """The lesser of the parts (m, k) at neighbouring angles: (m, k - 1); at a single angle its own."""
    return part if part.shape[1] == 1 else np.minimum(part[:, :-1], part[:, 1:])


def _sums(parts: Sequence[Array], places: Indices) -> Array:
    """Greatest over all m bounds of the sum of the sides' parts, each (m, k), at n places (n, d) of them: (n,)."""
    sums = np.sum([part[:, own] for part, own in zip(parts, places.T, strict=True)], axis=0)
    greatest: Array = sums.max(axis=0)
    return greatest


@lru_cache(maxsize=16)
def sides_of_card(
    lift: float, opening: SideCard, closing: SideCard, most: float, *, order: int = 2
) -> tuple[Mixture, Mixture]:
    """The sides of a lobe, opening and closing, that meet its card with the least peak velocity or acceleration.

    `order` is that of the derivative by the angle whose greatest size is least, 1 or 2.

    `lift` is mm or rad, as the crossings' lifts; `most`, rad, is the longest a side may be, its ramp included. Equal
    cards give one side twice. A known side keeps its acceleration at the nose, which the other side then has too.
    Crossings are met to 1e-9 degrees, and the peak is the least to about a thousandth. A card that no lobe meets but
    some within 5e-4 degrees of the crank, as its rounding takes one on the border beyond, is met within those. Raises
    IntentError for crossings in no possible order or beyond the side, and where no mixture meets the card: it then
    names the card of the least greatest difference that one meets.
    """
    sides = [opening] if opening == closing else [card for card in (opening, closing) if card.known is None]
    known = next((card.known for card in (opening, closing) if card.known is not None), None)
    for card in sides:
        _demand_order(lift, card, most)
    nose = None if known is None else _at_nose(known) / lift
    search = _Search(lift, sides, nose, most, order=order)
    solution = next((lobe for within in NEAREST.read if (lobe := search.least(within)) is not None), None)
    if solution is None:
        raise _no_card(lift, sides, nose, most)
    off = _off(sides, solution)
    off = off if off > NEAREST.met else 0.0
    mixtures = [
        _mixture(family, card, weights, off)
        for family, card, weights in zip(solution.families, sides, solution.weights, strict=True)
    ]
    if opening == closing:
        return mixtures[0], mixtures[0]
    solved_sides = iter(mixtures)
    first, second = (
        Mixture((), card.known) if card.known is not None else next(solved_sides) for card in (opening, closing)
    )
    return first, second


def _demand_order(lift: float, card: SideCard, most: float) -> None:
    """Raise IntentError for crossings that no lobe of this lift and longest side `most`, rad, has."""
    foot = 0.0 if card.ramp is None else card.ramp.height
    left = most - (0.0 if card.ramp is None else card.ramp.over)
    if left <= 0.0:
        raise IntentError(
            "the ramp leaves nothing of the turn; give it a greater velocity", f"{card.field}.ramp.velocity"
        )
    before: Crossing | None = None
    for i, crossing in sorted(enumerate(card.crossings), key=lambda item: item[1]):
        field = f"{card.field}.duration[{i}]"
        if not foot < crossing.lift < lift:
            above = "the ramp's height" if foot else "0"
            raise IntentError(f"a lift of a card lies between {above} and the lift of the lobe", f"{field}.at_lift")
        if before is not None and not (before.lift < crossing.lift and before.angle > crossing.angle):
            raise IntentError("a card has shorter durations at greater lifts", f"{field}.degrees")
        if not crossing.angle < (left if card.half is None else min(card.half, left)):
            longest = "`half` and the turn leave" if card.half is not None else "the turn leaves"
            raise IntentError(f"longer than {longest}, with the ramp", f"{field}.degrees")
        before = crossing
    if card.half is not None and not card.half < left:
        raise IntentError("`half` and the ramp are longer than the turn leaves", f"{card.field}.half")


def _at_nose(side: LobeSide) -> float:
    """Acceleration at the nose of a known side, mm/rad^2 or rad/rad^2."""
    from kin.numeric.elementary import Jet

    _, _, bend = side.flank(Jet.variable(np.array([1.0]), 2)).derivatives()
    return side.scale * float(bend[0]) / side.half**2


def _angles(card: SideCard, most: float, within: float) -> Array:
    """Angles of a side, rad, rising, between which all others lie; that of the card alone where it gives one."""
    if card.half is not None:
        return np.array([card.half])
    left = most - (0.0 if card.ramp is None else card.ramp.over)
    least = max(crossing.angle for crossing in card.crossings) - math.radians(within / card.crank)
    least = max(least, ANGLES.shortest * left)
    # evenly in the logarithm of the angle beyond the last crossing
    return least + np.geomspace(ANGLES.beside * least, (left - least) * (1.0 - 1e-9), ANGLES.first)


def _mixture(family: _Family, card: SideCard, weights: Array, off: float) -> Mixture:
    """The side that mixes the family's members by their weights (n,), and the members that it has."""
    used = np.flatnonzero(weights > CUTS.weight)
    members = [_members()[family.chosen[i]] for i in used]
    share = weights[used] / math.fsum(weights[used].tolist())
    sides = [LobeSide.of(family.lift, family.half, powers, card.ramp) for powers in members]
    order = np.argsort(-share, kind="stable")
    flank = Flank.mixed([side.flank for side in sides], share.tolist())
    side = sides[0]._replace(flank=flank)
    return Mixture(tuple((members[i], float(share[i])) for i in order), side, off)


def _no_card(lift: float, sides: Sequence[SideCard], nose: float | None, most: float) -> IntentError:
    """The error for a card that no lobe meets, with the nearest card: that of the least greatest difference.

    It is the nearest to about 0.02 degrees of the crank; where `met` finds none so near the border, by tenths at most
    in the cards that were tried.
    """
    field = f"{next(card for card in sides if card.crossings).field}.duration"
    search = _Search(lift, sides, nose, most)
    # the least difference that can be met is bracketed by doubling, then halved
    low, high = NEAREST.read[-1], 1.0
    while (lobe := search.met(high, NEAREST.fine)) is None:
        low, high = high, 2.0 * high
        if low > NEAREST.farthest:
            return IntentError(f"{_NONE}; give fewer durations", field)
    high = min(high, _off(sides, lobe))
    while high - low > NEAREST.accuracy:
        middle = 0.5 * (low + high)
        nearer = search.met(middle, NEAREST.fine)
        if nearer is None:
            low = middle
        else:
            lobe, high = nearer, min(middle, _off(sides, nearer))
    # on the border itself no rounding is met, and beside it the angles of the lobes may be too few to be found
    for k, places in product(range(NEAREST.further), NEAREST.places):
        near = _rounded(sides, search.inner(lobe, high + NEAREST.inward * 2.0**k), places)
        if _Search(lift, near, nose, most).met() is not None:
            break
    else:
        return IntentError(f"{_NONE}; give fewer durations", field)
    degrees = "; ".join(", ".join(f"{_crank(card, row):.{places}f}" for row in card.crossings) for card in near)
    off = max(
        abs(_crank(card, crossing) - _crank(card, stated))
        for card, own in zip(near, sides, strict=True)
        for crossing, stated in zip(card.crossings, own.crossings, strict=True)
    )
    return IntentError(f"{_NONE}; the nearest has {degrees} degrees in their order, {off:.3g} off: give those", field)


def _crank(card: SideCard, crossing: Crossing) -> float:
    return card.crank * math.degrees(crossing.angle)


def _off(sides: Sequence[SideCard], lobe: _Solution) -> float:
    """Greatest difference of a lobe's crossings from those of its sides' cards, degrees of the crank."""
    return max(
        card.crank * abs(math.degrees(_angle_at(family, weights, crossing.lift) - crossing.angle))
        for card, family, weights in zip(sides, lobe.families, lobe.weights, strict=True)
        for crossing in card.crossings
    )


def _rounded(sides: Sequence[SideCard], lobe: _Solution, places: int) -> list[SideCard]:
    """The cards of a lobe, by this many decimal places of degrees of the crank."""
    near = []
    for card, family, weights in zip(sides, lobe.families, lobe.weights, strict=True):
        own = [Crossing(lift, _angle_at(family, weights, lift)) for lift, _ in card.crossings]
        crank = [round(_crank(card, crossing), places) for crossing in own]
        rows = [Crossing(row.lift, math.radians(degrees / card.crank)) for row, degrees in zip(own, crank, strict=True)]
        near.append(card._replace(crossings=tuple(rows)))
    return near


def _angle_at(family: _Family, weights: Array, lift: float) -> float:
    """Angle from the nose at which a mixture crosses a lift, rad."""
    low, high = 0.0, family.half
    for _ in range(60):
        middle = 0.5 * (low + high)
        above = float(family.lifts(middle) @ weights) * family.lift > lift
        low, high = (middle, high) if above else (low, middle)
    return 0.5 * (low + high)
