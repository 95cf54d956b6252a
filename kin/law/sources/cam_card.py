"""Lobes by their cam cards: the lift, and the angles over which a lobe is above stated lifts.

The powers 2-p-q-r-s of the lobe polynomial are whole numbers, so that no single member of the family meets a card. A
mixture of members over one angle, with weights of 0 or more that sum to 1, is a lobe polynomial too: each rises
from its foot to its nose without a turn (of S' five terms change their sign four times at most, Descartes, and its
fourfold zero at the foot takes all four), and so does the mixture. Lift and slopes are linear in the weights, so that
the mixture of least peak acceleration is a linear programme for each angle.
"""

from __future__ import annotations

import math
from functools import cache, lru_cache
from itertools import combinations, pairwise
from operator import itemgetter
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kin.law.programme import IntentError
from kin.law.sources.functions import Flank
from kin.law.sources.lobe import LobeSide, Ramp
from kin.numeric.linear_programme import minimise

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from kin.numeric.arrays import Array, Indices

_POWERS = (4, 6, 8, 10, 14, 20, 26, 34, 44, 60, 80, 100)  # of the members that are mixed: four of them, after 2
_ALL = (2, *_POWERS)
_EXPONENTS = np.array(_ALL, dtype=float)
_LOOKS = 129  # places from the nose to the foot at which the acceleration is bounded
_HALVES = 32  # angles of a side that are tried before the best is refined
_CUTS = 12  # rounds in which places with a greater acceleration are added to a programme
_EXACT = 1e-10  # of the lift: rows of a programme that are missed by less count as met, and are corrected
_ACTIVE = 0.98  # of the peak: places with a lesser acceleration are dropped before the next programme
_SHORTEST = 1e-3  # of the longest side: the shortest
_REFINED = 10  # steps of a golden section
_DEGREES = 0.01  # of the crank: the nearest card is rounded to this
_NEAREST = 10  # halvings of the greatest difference of a card
_FARTHEST = 720.0  # degrees of the crank: greatest difference of the nearest card
_CLOSE = 1e-4  # of a peak: an acceleration greater by less needs no new place
_GOLDEN = 0.5 * (math.sqrt(5.0) - 1.0)
_LEVELS = 7  # halvings towards the acceleration at the nose that two sides have in common
_LEAST_WEIGHT = 1e-12  # of a mixture: a lesser weight is rounding


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
    """A side that meets a card, and (powers, weight) of its members, by falling weight; () for a known side."""

    members: tuple[tuple[tuple[int, ...], float], ...]
    side: LobeSide


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
def _bends() -> tuple[Array, Array]:
    """Second derivatives by u, at k places, of the terms that `_lagrange` weighs at 0 and at 1: (k, n), (k, n)."""
    u = np.linspace(0.0, 1.0, _LOOKS)[:-1]
    powers = _EXPONENTS * (_EXPONENTS - 1.0) * u[:, None] ** (_EXPONENTS - 2.0)
    at_0, at_1 = _lagrange()
    return powers @ at_0.T, powers @ at_1.T


class _Family(NamedTuple):
    """Members of one lift over one angle `half`, rad: indices, and the shares of Lagrange's polynomials at 0 and 1."""

    lift: float
    half: float
    chosen: Indices
    shares: tuple[float, float]

    def lifts(self, angle: float) -> Array:
        """Each member's lift (n,), as a share of the whole lift, at an angle from the nose, rad."""
        at_0, at_1 = _lagrange()
        powers, (first, second) = (angle / self.half) ** _EXPONENTS, self.shares
        return 1.0 + (first * (at_0 @ powers) + second * (at_1 @ powers))[self.chosen]

    def accelerations(self, places: slice = slice(None)) -> Array:
        """Each member's S'' (k, n), as shares of the lift by rad^2, at k places from the nose to the foot."""
        at_0, at_1 = _bends()
        first, second = (share / self.half**2 for share in self.shares)
        return (first * at_0[places] + second * at_1[places])[:, self.chosen]


def _family(lift: float, half: float, ramp: Ramp | None) -> _Family:
    """Members whose acceleration at the nose is negative; beside a steep ramp it is not in some."""
    at_0, at_1 = _lagrange()
    foot, slope = (0.0, 0.0) if ramp is None else (ramp.height / lift, ramp.velocity * half / lift)
    shares = (foot - 1.0 + slope, -slope)
    return _Family(lift, half, np.flatnonzero(shares[0] * at_0[:, 0] + shares[1] * at_1[:, 0] < 0.0), shares)


class _Programme(NamedTuple):
    """Sides over their angles: mixtures that meet their crossings, and have one acceleration at the nose.

    A crossing may be off by `within` degrees of the crank. `nose` is the acceleration at the nose of a known side, as a
    share of the lift by rad^2. Rows are linear equations of the members' weights, the columns.
    """

    families: tuple[_Family, ...]
    cards: tuple[SideCard, ...]
    nose: float | None
    within: float = 0.0

    def least_miss(self) -> tuple[float, list[Array]]:
        """Least distance by which the rows are missed, 0 where they can be met, and its weights (n,) of each side."""
        rows, right = self._rows()
        solution = minimise(np.zeros(rows.shape[1]), rows, right, _EXACT)
        return solution.missed, self._weights(solution.x)

    def least_nose(self, sign: float) -> float:
        """Least of `sign` times the acceleration at the nose, a share of the lift by rad^2; inf without a mixture."""
        rows, right = self._rows()
        cost = np.zeros(rows.shape[1])
        cost[: len(self.families[0].chosen)] = sign * self.families[0].accelerations(slice(1))[0]
        return minimise(cost, rows, right, _EXACT).value

    def least_peak(self, cuts: list[int]) -> tuple[float, list[Array]]:
        """Least peak of |S''|, a share of the lift by rad^2, and the weights of each side; (inf, []) without a mixture.

        `cuts` are indices of places at which the acceleration is bounded from the first. Places at which it turns out
        greater are added to the list, those far below the peak are dropped from it.
        """
        rows, right = self._rows()
        bends = self._accelerations(rows.shape[1])
        size = np.abs(bends).max(axis=1)
        for _ in range(_CUTS):
            # columns: weights, the peak as a share of the least greatest acceleration, and a slack for each cut
            count = len(cuts)
            lower = bends[cuts] / size[cuts][:, None]
            whole = np.block(
                [
                    [rows, np.zeros((len(rows), 1 + count))],
                    [lower, -size.min() / size[cuts][:, None], np.eye(count)],
                ]
            )
            cost = np.zeros(whole.shape[1])
            cost[rows.shape[1]] = 1.0
            solution = minimise(cost, whole, np.concatenate([right, np.zeros(count)]), _EXACT)
            if not math.isfinite(solution.value):
                return math.inf, []
            # the four greatest accelerations of the mixture, where they exceed the peak, are new cuts
            peaks = bends @ solution.x[: rows.shape[1]]
            highest = [int(i) for i in peaks.argsort()[-4:]]
            new = [i for i in highest if peaks[i] > solution.value * size.min() * (1.0 + _CLOSE) and i not in cuts]
            if not new:
                break
            cuts += new
        level = solution.value * size.min()
        cuts[:] = [i for i in cuts if peaks[i] > _ACTIVE * level]
        return float(peaks.max()), self._weights(self._exact(solution.x, rows, right))

    @staticmethod
    def _exact(x: Array, rows: Array, right: Array) -> Array:
        """The weights, corrected by least squares for what rounding has left of the rows."""
        used = np.flatnonzero(x[: rows.shape[1]] > _LEAST_WEIGHT)
        x = x[: rows.shape[1]].copy()
        more, *_ = np.linalg.lstsq(rows[:, used], right - rows @ x, rcond=None)
        x[used] += more
        return x

    def _accelerations(self, columns: int) -> Array:
        """S'' and -S'' of each column at every place, one side after the other, as shares of the lift by rad^2."""
        start, blocks = 0, []
        for family in self.families:
            block = np.zeros((_LOOKS - 1, columns))
            block[:, start : start + len(family.chosen)] = family.accelerations()
            start += len(family.chosen)
            blocks += [block, -block]
        return np.vstack(blocks)

    def _rows(self) -> tuple[Array, Array]:
        """Rows and right sides: weights that sum to 1, crossings, one acceleration at the nose.

        With `within` a crossing is two inequalities, each with a slack column behind those of the weights.
        """
        size = sum(len(family.chosen) for family in self.families)
        slack = 0 if self.within == 0.0 else 2 * sum(len(card.crossings) for card in self.cards)
        rows: list[Array] = []
        right: list[float] = []
        start, used = 0, size
        # of each side: the sum of its weights, and its crossings
        for family, card in zip(self.families, self.cards, strict=True):
            columns = slice(start, start + len(family.chosen))
            start = columns.stop
            row = np.zeros(size + slack)
            row[columns] = 1.0
            rows.append(row)
            right.append(1.0)
            for lift, angle in card.crossings:
                off = math.radians(self.within / card.crank)
                ways = ((0.0, 0.0),) if off == 0.0 else ((-off, -1.0), (off, 1.0))
                for shift, sign in ways:
                    row = np.zeros(size + slack)
                    row[columns] = family.lifts(min(max(angle + shift, 0.0), family.half))
                    if sign:
                        row[used] = sign
                        used += 1
                    rows.append(row)
                    right.append(lift / family.lift)
        # the acceleration at the nose is that of the known side, or the same on both sides; scaled to about 1
        noses = [(family.accelerations(slice(1))[0] * family.half**2, family.half) for family in self.families]
        if self.nose is not None or len(self.families) > 1:
            row = np.zeros(size + slack)
            row[: len(noses[0][0])] = noses[0][0]
            level = self.nose
            if level is None:
                (_, half), (second, second_half) = noses
                row[size - len(second) : size] = -second * (half / second_half) ** 2
            biggest = float(np.abs(row).max())
            rows.append(row / biggest)
            right.append(0.0 if level is None else level * noses[0][1] ** 2 / biggest)
        return np.array(rows), np.array(right)

    def _weights(self, x: Array) -> list[Array]:
        ends = np.cumsum([0, *(len(family.chosen) for family in self.families)])
        return [x[a:b] for a, b in pairwise(ends.tolist())]


@lru_cache(maxsize=16)
def sides_of_card(lift: float, opening: SideCard, closing: SideCard, most: float) -> tuple[Mixture, Mixture]:
    """The sides of a lobe, opening and closing, that meet its card with the least peak acceleration.

    `lift` is mm or rad, as the crossings' lifts; `most`, rad, is the longest a side may be, its ramp included. Equal
    cards give one side twice. A known side keeps its acceleration at the nose, which the other side then has too.
    Crossings are met to 1e-9 degrees, and the peak is the least to about a thousandth. Raises IntentError for crossings
    in no possible order or beyond the side, and where no mixture meets the card: it then names the card of the least
    greatest difference that one meets.
    """
    sides = [opening] if opening == closing else [card for card in (opening, closing) if card.known is None]
    known = next((card.known for card in (opening, closing) if card.known is not None), None)
    for card in sides:
        _demand_order(lift, card, most)
    nose = None if known is None else _at_nose(known) / lift
    solved = _solved(lift, sides, nose, most)
    if solved is None:
        raise _no_card(lift, sides, nose, most)
    mixtures = [_mixture(family, card, weights) for card, (family, weights) in zip(sides, solved, strict=True)]
    if opening == closing:
        return mixtures[0], mixtures[0]
    solved_sides = iter(mixtures)
    first, second = (
        Mixture((), card.known) if card.known is not None else next(solved_sides) for card in (opening, closing)
    )
    return first, second


def _solved(
    lift: float, sides: Sequence[SideCard], nose: float | None, most: float
) -> list[tuple[_Family, Array]] | None:
    """The mixtures of least peak acceleration that meet the sides' crossings; None where there are none.

    The peak of two sides is that of the worse side, so it is no less than the worse side's own least peak, over its
    best angle. Where the other side can have the same acceleration at the nose with no greater peak, that is the least.
    Elsewhere the common acceleration is found by halving between those that are best for each side, as a side's least
    peak rises with the distance from its own best. Each pair of angles met is tried with any common acceleration.
    """
    alone = [_side(lift, card, nose, most) for card in sides]
    best = _one_acceleration(lift, sides, alone, nose)
    bound = max(side.peak for side in alone) * (1.0 + _CLOSE)
    if len(sides) == 1 or best.peak <= bound:
        return best.solved
    # the accelerations between which the common one is looked for
    ends = [side.nose for side in alone]
    if math.isinf(best.peak):
        reach = _common_noses(lift, sides, most, 0.0)
        if reach is None:
            return None
        ends = [min(max(level, reach[0]), reach[1]) for level in ends]

    def tried(level: float) -> list[_Side]:
        return [_side(lift, card, level, most) for card in sides]

    worse = max(range(len(sides)), key=lambda i: alone[i].peak)
    best = min(best, _one_acceleration(lift, sides, tried(ends[worse]), None), key=_peak)
    for _ in range(_LEVELS):
        if best.peak <= bound:
            break
        level = 0.5 * (ends[0] + ends[1])
        own = tried(level)
        best = min(best, _one_acceleration(lift, sides, own, None), key=_peak)
        # the side with the higher peak draws the level towards its own best: the end of the other side moves
        ends[own[0].peak > own[1].peak] = level
    if bound < best.peak < math.inf:
        best = min(best, _one_acceleration(lift, sides, tried(best.nose), None), key=_peak)
    return best.solved


_peak = itemgetter(0)


class _Side(NamedTuple):
    """A side by itself: its best angle, rad, and over that angle its least peak and its acceleration at the nose."""

    half: float
    peak: float
    nose: float


def _side(lift: float, card: SideCard, nose: float | None, most: float) -> _Side:
    """The best of one side alone, or with the acceleration `nose` at the nose."""
    half = _search(lift, card, nose, most)
    programme = _programme(lift, [card], [half], nose)
    peak, weights = programme.least_peak(_first_cuts(1))
    bends = programme.families[0].accelerations(slice(1))[0]
    return _Side(half, peak, float(bends @ weights[0]) if weights else math.nan)


class _Joined(NamedTuple):
    """Least peak of all sides over their angles, their acceleration at the nose, and their mixtures, or None."""

    peak: float
    nose: float
    solved: list[tuple[_Family, Array]] | None


def _one_acceleration(lift: float, sides: Sequence[SideCard], own: Sequence[_Side], nose: float | None) -> _Joined:
    """Give the least peak of sides with one acceleration at the nose, each over its own angle; else infinite."""
    programme = _programme(lift, sides, [side.half for side in own], nose)
    peak, weights = programme.least_peak(_first_cuts(len(sides)))
    if not weights:
        return _Joined(math.inf, math.nan, None)
    bends = programme.families[0].accelerations(slice(1))[0]
    return _Joined(peak, float(bends @ weights[0]), list(zip(programme.families, weights, strict=True)))


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


def _programme(
    lift: float, sides: Sequence[SideCard], halves: Sequence[float], nose: float | None, within: float = 0.0
) -> _Programme:
    families = tuple(_family(lift, half, card.ramp) for card, half in zip(sides, halves, strict=True))
    return _Programme(families, tuple(sides), nose, within)


def _first_cuts(sides: int) -> list[int]:
    """Indices of a few places of each side and sign, at which the acceleration is bounded first."""
    return list(range(0, 2 * sides * (_LOOKS - 1), _LOOKS // 8))


def _search(lift: float, card: SideCard, nose: float | None, most: float, within: float | None = None) -> float:
    """The angle, rad, over which a side has the least peak acceleration; of the least miss where none meets its rows.

    With `within`, degrees of the crank by which crossings may be off, it is the angle of the least miss.
    """
    cuts = _first_cuts(1)

    def merit(half: float) -> tuple[float, float]:
        programme = _programme(lift, [card], [half], nose, within or 0.0)
        if within is None:
            peak, _ = programme.least_peak(cuts)
            return (0.0, peak) if math.isfinite(peak) else (programme.least_miss()[0], peak)
        return programme.least_miss()[0], 0.0

    return _best(_angles(card, most, within or 0.0), merit)


def _common_noses(lift: float, sides: Sequence[SideCard], most: float, within: float) -> tuple[float, float] | None:
    """Least and greatest acceleration at the nose that two sides can have in common, shares of the lift by rad^2.

    Each has it over an angle of its own. None where they can have none in common.
    """
    least, greatest = -math.inf, math.inf
    for card in sides:
        reach: list[float] = []
        for half in _angles(card, most, within):
            programme = _programme(lift, [card], [half], None, within)
            reach += (value for sign in (1.0, -1.0) if math.isfinite(value := sign * programme.least_nose(sign)))
        if not reach:
            return None
        least, greatest = max(least, min(reach)), min(greatest, max(reach))
    return (least, greatest) if least <= greatest else None


def _angles(card: SideCard, most: float, within: float) -> list[float]:
    """Angles of a side, rad, to be tried first, rising; that of the card alone where it gives one."""
    if card.half is not None:
        return [card.half]
    left = most - (0.0 if card.ramp is None else card.ramp.over)
    least = max(crossing.angle for crossing in card.crossings) - math.radians(within / card.crank)
    least = max(least, _SHORTEST * left)
    # evenly in the logarithm of the angle beyond the last crossing
    low, high = math.log(2e-3 * least), math.log((left - least) * (1.0 - 1e-9))
    return [least + math.exp(low + (high - low) * k / (_HALVES - 1)) for k in range(_HALVES)]


def _best(angles: Sequence[float], merit: Callable[[float], tuple[float, float]]) -> float:
    """The angle of least merit: the best of those tried, refined by a golden section between its neighbours."""
    if len(angles) == 1:
        return angles[0]
    merits = [merit(angle) for angle in angles]
    i = min(range(len(angles)), key=merits.__getitem__)
    if merits[i] == (0.0, 0.0):
        return angles[i]
    low, high = angles[max(i - 1, 0)], angles[min(i + 1, len(angles) - 1)]
    best = merits[i], angles[i]
    inner = [high - _GOLDEN * (high - low), low + _GOLDEN * (high - low)]
    values = [merit(x) for x in inner]
    for _ in range(_REFINED):
        best = min(best, *zip(values, inner, strict=True))
        if values[0] <= values[1]:
            high = inner[1]
            inner = [high - _GOLDEN * (high - low), inner[0]]
            values = [merit(inner[0]), values[0]]
        else:
            low = inner[0]
            inner = [inner[1], low + _GOLDEN * (high - low)]
            values = [values[1], merit(inner[1])]
    return min(best, *zip(values, inner, strict=True))[1]


def _mixture(family: _Family, card: SideCard, weights: Array) -> Mixture:
    """The side that mixes the family's members by their weights (n,), and the members that it has."""
    used = np.flatnonzero(weights > _LEAST_WEIGHT)
    members = [_members()[family.chosen[i]] for i in used]
    share = weights[used] / math.fsum(weights[used].tolist())
    sides = [LobeSide.of(family.lift, family.half, powers, card.ramp) for powers in members]
    order = np.argsort(-share, kind="stable")
    flank = Flank.mixed([side.flank for side in sides], share.tolist())
    side = sides[0]._replace(flank=flank)
    return Mixture(tuple((members[i], float(share[i])) for i in order), side)


def _no_card(lift: float, sides: Sequence[SideCard], nose: float | None, most: float) -> IntentError:
    """The error for a card that no lobe meets, with the nearest card: that of the least greatest difference."""
    # the least difference that can be met is bracketed by doubling, then halved
    low, high = 0.0, 1.0
    while _weights_within(lift, sides, nose, most, high) is None and high < _FARTHEST:
        low, high = high, 2.0 * high
    for _ in range(_NEAREST):
        middle = 0.5 * (low + high)
        met = _weights_within(lift, sides, nose, most, middle) is not None
        low, high = (low, middle) if met else (middle, high)
    near = _nearest(lift, sides, nose, most, high)
    field = f"{next(card for card in sides if card.crossings).field}.duration"
    if near is None:
        return IntentError("no lobe of the family is above these lifts for so long; give fewer durations", field)
    degrees = "; ".join(", ".join(f"{_crank(card, crossing):.2f}" for crossing in card.crossings) for card in near)
    off = max(
        abs(_crank(card, crossing) - _crank(card, stated))
        for card, own in zip(near, sides, strict=True)
        for crossing, stated in zip(card.crossings, own.crossings, strict=True)
    )
    return IntentError(
        f"no lobe of the family is above these lifts for so long; the nearest has {degrees} degrees in their order, "
        f"{off:.3g} off: give those",
        field,
    )


def _crank(card: SideCard, crossing: Crossing) -> float:
    return card.crank * math.degrees(crossing.angle)


def _weights_within(
    lift: float, sides: Sequence[SideCard], nose: float | None, most: float, within: float
) -> list[tuple[_Family, Array]] | None:
    """Mixtures that meet all crossings within `within` degrees of the crank; None where there are none."""
    if len(sides) > 1:
        reach = _common_noses(lift, sides, most, within)
        if reach is None:
            return None
        nose = 0.5 * (reach[0] + reach[1])
    mixtures = []
    for card in sides:
        programme = _programme(lift, [card], [_search(lift, card, nose, most, within)], nose, within)
        least_miss, (weights,) = programme.least_miss()
        if least_miss > 0.0:
            return None
        mixtures.append((programme.families[0], weights))
    return mixtures


def _nearest(
    lift: float, sides: Sequence[SideCard], nose: float | None, most: float, within: float
) -> list[SideCard] | None:
    """The card, rounded, of a mixture that is off by no more than about `within` degrees of the crank; else None.

    The nearest card lies on the border of those that can be met. So much of every other member is added that the
    rounded card can be met too.
    """
    mixtures = _weights_within(lift, sides, nose, most, within)
    if mixtures is None:
        return None
    for share in (2.0**-k for k in range(_NEAREST, 1, -1)):
        near = []
        for card, (family, own) in zip(sides, mixtures, strict=True):
            mixed = (1.0 - share) * own + share / len(own)
            angles = [_angle_at(family, mixed, crossing.lift) for crossing in card.crossings]
            crank = [round(card.crank * math.degrees(angle) / _DEGREES) * _DEGREES for angle in angles]
            crossings = tuple(
                Crossing(crossing.lift, math.radians(degrees / card.crank))
                for crossing, degrees in zip(card.crossings, crank, strict=True)
            )
            near.append(card._replace(crossings=crossings))
        if _solved(lift, near, nose, most) is not None:
            return near
    return None


def _angle_at(family: _Family, weights: Array, lift: float) -> float:
    """Angle from the nose at which a mixture crosses a lift, rad."""
    low, high = 0.0, family.half
    for _ in range(60):
        middle = 0.5 * (low + high)
        above = float(family.lifts(middle) @ weights) * family.lift > lift
        low, high = (middle, high) if above else (low, middle)
    return 0.5 * (low + high)
