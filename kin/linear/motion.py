"""The greatest error of a follower on a contour, over all inputs, with a proved remainder.

Along a piece of what holds the roller's centre, of arc length s, lift and input are closed forms of s, so the error
f(s) = lift - intended lift at that input is known with f' and f''. Over |s - s0| <= h balls enclose f'', and

    f <= max over |x| <= h of f0 + f0' x + (greatest f'') x^2/2;

where the intended velocity jumps inside, f <= f0 + h (greatest |f'|) takes that place. Intervals that may hold more
than the greatest error found are cut in four. The lift is the greatest that any piece gives, so

- the greatest error is that over all pieces, touched or not;
- the error is nowhere below that of a piece which spans a range of inputs: between two inputs at which pieces begin or
  end one piece holds the roller, or two, each as far as they cross.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kin.linear.follower import Stem
from kin.numeric.elementary import BallJet, Jet, asin, sqrt
from kin.numeric.errors import UnsettledError
from kin.numeric.interval import Ball, sin_cos
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from kin.contour.arcs import Arcs
    from kin.linear.contact import Held
    from kin.linear.follower import LinearFollower
    from kin.numeric.arrays import Array, Indices, Mask

SHARE = 1e-6  # of the greatest error, to which it is found
RESOLUTION = 1e-12  # of the size, mm, or of it over an arm's length: what rounding leaves of nothing
MOST_CUTS = 40
PARTS = 4  # of an interval that stays open
AT_FIRST = 250  # intervals at least, from which bounds are begun with
FEW = 4  # intervals looked at where their parabolas are greatest
SIGNS = (1.0, -1.0)
MOST_OPEN = 1_000_000  # intervals, beside four times those given, that may stay undecided
INSET = 1e-6  # of a range of inputs, so far within its ends the piece that holds is looked for
CROSSING = 24  # steps towards the crossing of two pieces
TRIES = 40  # times that inputs are added where a third piece holds between two
BLOCK = 20_000  # intervals at a time


class Extreme(NamedTuple):
    """Error, mm or rad, its input, mm, and by how much the true extreme may lie beyond it."""

    error: float
    at: float
    remainder: float


class Errors(NamedTuple):
    """Least and greatest error of a follower, mm or rad."""

    least: Extreme
    most: Extreme


@dataclass(frozen=True, eq=False)
class _Spans:
    """Intervals of arc length middle +- half (n,) on pieces (n, each its own) of arcs.

    `sign` (n,) is 1 where they count for the greatest error, -1 for the least.
    """

    pieces: Arcs
    middle: Array
    half: Array
    sign: Array

    def take(self, which: Indices | Mask) -> _Spans:
        return _Spans(self.pieces.take(which), self.middle[which], self.half[which], self.sign[which])

    def parts(self, which: Mask) -> _Spans:
        """Each of those that the mask marks in PARTS."""
        part = self.take(which)
        count, half = len(part.half), part.half / PARTS
        steps = np.repeat(np.arange(PARTS) - 0.5 * (PARTS - 1), count)
        whole = part.take(np.tile(np.arange(count), PARTS))
        half = np.tile(half, PARTS)
        return _Spans(whole.pieces, whole.middle + 2.0 * steps * half, half, whole.sign)

    def joined(self, other: _Spans) -> _Spans:
        """These spans, then those of the other."""
        return _Spans(
            self.pieces.joined(other.pieces),
            np.concatenate([self.middle, other.middle]),
            np.concatenate([self.half, other.half]),
            np.concatenate([self.sign, other.sign]),
        )


def errors(held: Held, span: tuple[float, float]) -> Errors:
    """Least and greatest error over all inputs of the span, mm.

    Raises RestError where the follower touches nothing, UnsettledError where the proof does not come to an end.
    """
    first, last = span
    u = held.ends
    u = np.concatenate([[first], u[(u > first) & (u < last)], [last]])
    most, least = _extremes(held, _whole(held, span).joined(_touched(held, u)))
    for _ in range(TRIES):
        there = np.array([np.clip(least.at, first, last)])
        lift = held.reached(there)
        gap = float(lift[0] - intended(held.follower, there)[0]) - least.error
        if gap <= max(SHARE * abs(least.error), 10.0 * resolution(held)):
            return Errors(least, most)
        # a third piece holds the roller there
        near = there[0] + np.array([-1.0, -0.5, 0.0, 0.5, 1.0]) * 1e-3 * (last - first) / len(u)
        u = np.unique(np.concatenate([u, near[(near > first) & (near < last)]]))
        least = _extremes(held, _touched(held, u))[1]
    raise UnsettledError("the motion error is not proved: the pieces that hold the roller are not found")


def resolution(held: Held) -> float:
    """Greatest error, mm or rad, that rounding may feign."""
    return RESOLUTION * held.size / held.follower.lever


def intended(follower: LinearFollower, u: Array) -> Array:
    """Intended lift (n,), mm or rad, at inputs u (n,), mm, of the motion or by rounding beside it."""
    first, last = follower.span
    inside = u if follower.endless else np.clip(u, first, last)
    lift: Array = follower.law.derivatives(inside, 0, np.where(inside < last, 1, -1))[0]
    return lift


def _whole(held: Held, span: tuple[float, float]) -> _Spans:
    """Every piece, as far as it is met at inputs of the span."""
    every = np.arange(len(held.pieces))
    begin, end = np.zeros(len(every)), held.pieces.length.copy()
    for u, to, beyond in ((span[1], begin, held.high > span[1]), (span[0], end, held.low < span[0])):
        over = np.flatnonzero(beyond)
        to[over] = held.place(over, np.full(over.size, u))
    return _Spans(held.pieces, 0.5 * (begin + end), 0.5 * np.abs(end - begin), np.ones(len(every)))


def _touched(held: Held, u: Array) -> _Spans:
    """Pieces that hold the roller, from each of the inputs u (n,), rising, to the next."""
    a, b = u[:-1], u[1:]
    inset = INSET * (b - a)
    _, piece = held.first(np.concatenate([a + inset, b - inset]))
    if (piece < 0).any():
        held.reached(np.concatenate([a + inset, b - inset]))  # which says where
    one, other = piece.reshape(2, -1)
    # a piece with an end within the rounding of the range may not span it
    change = np.flatnonzero(one != other)
    cross = b.copy()
    if change.size:
        cross[change] = _crossing(held, (one[change], other[change]), (a + inset)[change], (b - inset)[change])
    pieces = np.concatenate([one, other[change]])
    begin = held.place(pieces, np.concatenate([a, cross[change]]))
    end = held.place(pieces, np.concatenate([cross, b[change]]))
    half = 0.5 * np.abs(end - begin)
    return _Spans(held.pieces.take(pieces), 0.5 * (begin + end), half, np.full(len(pieces), -1.0))


def _crossing(held: Held, pair: tuple[Indices, Indices], low: Array, high: Array) -> Array:
    """Inputs (n,) near which the second of a pair of pieces comes to hold the roller higher than the first.

    Any input between low and high would do: the nearer to the crossing, the closer is the bound.
    """
    pieces = np.concatenate(pair)

    def ahead(u: Array) -> Array:
        first, second = held.on(pieces, np.tile(u, 2)).reshape(2, -1)
        return first - second

    f, g = np.maximum(ahead(low), 0.0), np.minimum(ahead(high), 0.0)
    fine = 0.1 * resolution(held)
    for _ in range(CROSSING):
        with np.errstate(divide="ignore", invalid="ignore"):
            middle = low + (high - low) * np.where(f > g, f / (f - g), 0.5)
        gap = ahead(middle)
        if float(np.abs(gap).max()) <= fine:
            return middle
        # Illinois: an end that stays is trusted half as much
        up = gap > 0.0
        low, f, g = np.where(up, middle, low), np.where(up, gap, 0.5 * f), np.where(up, 0.5 * g, gap)
        high = np.where(up, high, middle)
    return middle


def _extremes(held: Held, spans: _Spans) -> tuple[Extreme, Extreme]:
    """Greatest and least error over spans of either sign, each to a share of it or to rounding."""
    follower, fine = held.follower, resolution(held)
    best, at, closed = np.full(2, -np.inf), np.full(2, np.nan), np.full(2, -np.inf)
    most = PARTS * len(spans.middle) + MOST_OPEN
    while 0 < len(spans.middle) < AT_FIRST:  # as many cost no more than few
        spans = spans.parts(np.ones(len(spans.middle), dtype=np.bool_))
    for _ in range(MOST_CUTS):
        bounds = [np.empty(0)]
        for begin in range(0, len(spans.middle), BLOCK):
            part = spans.take(np.arange(begin, min(begin + BLOCK, len(spans.middle))))
            reached, u, bound = _bounded(follower, part)
            for k, sign in enumerate(SIGNS):
                own = np.flatnonzero(part.sign == sign)
                top = own[int(np.argmax(reached[own]))] if own.size else -1
                if own.size and reached[top] > best[k]:
                    best[k], at[k] = reached[top], u[top]
            bounds.append(bound)
        bound, group = np.concatenate(bounds), (spans.sign < 0.0).astype(np.intp)
        # without spans of a sign its best stays infinite
        margin = np.where(np.isfinite(best), np.maximum(SHARE * np.abs(best), fine), 0.0)
        open_: Mask = bound > (best + margin)[group]
        np.maximum.at(closed, group[~open_], bound[~open_])
        left = int(np.count_nonzero(open_))
        if not left:
            at = at if follower.endless else np.clip(at, *follower.span)
            rest = np.maximum(closed, best) - np.where(np.isfinite(best), best, 0.0)
            rows = zip(SIGNS, best.tolist(), at.tolist(), rest.tolist(), strict=True)
            greatest, least = (Extreme(sign * error, place, more) for sign, error, place, more in rows)
            return greatest, least
        if left > most:
            break
        spans = spans.parts(open_)
    raise UnsettledError("the motion error is not proved: bounds do not come close to it")


def _bounded(follower: LinearFollower, spans: _Spans) -> tuple[Array, Array, Array]:
    """Errors reached (n,), times the sign, their inputs, and upper bounds over the spans."""
    half, sign = spans.half, spans.sign
    value, slope, _, u = _at(follower, spans, spans.middle)
    value, slope = sign * value, sign * slope
    low, high, over = _enclosed(follower, spans)
    low, high = np.where(sign > 0.0, low, -high), np.where(sign > 0.0, high, -low)
    bend = high[2]
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        # value + slope x + bend x^2/2: greatest at an end or where it is level between
        ends = value + np.abs(slope) * half + 0.5 * bend * half**2
        level = np.where((bend < 0.0) & (np.abs(slope) < -bend * half), value - 0.5 * slope**2 / bend, ends)
        bound = np.where(np.isfinite(level) & ~over, np.maximum(level, value), np.inf)
        steepest = np.maximum(np.abs(low[1]), np.abs(high[1]))
        bound = np.fmin(np.fmin(bound, value + steepest * half), high[0])
        step = np.where(bend < 0.0, -slope / bend, np.copysign(np.inf, slope))
    # the most promising of either sign are looked at where the same parabola is greatest
    chosen = np.concatenate([_promising(bound, spans.sign == k) for k in SIGNS])
    if chosen.size:
        step = np.clip(np.nan_to_num(step[chosen]), -half[chosen], half[chosen])
        there, _, _, at = _at(follower, spans.take(chosen), spans.middle[chosen] + step)
        better = sign[chosen] * there > value[chosen]
        value[chosen[better]], u[chosen[better]] = (sign[chosen] * there)[better], at[better]
    return value, u, np.maximum(bound, value)


def _promising(bound: Array, own: Mask) -> Indices:
    """The few (k,) of some bounds that are highest."""
    which = np.flatnonzero(own)
    return which[np.argsort(bound[which])[-FEW:]]


def _at(follower: LinearFollower, spans: _Spans, s: Array) -> tuple[Array, Array, Array, Array]:
    """Error with two derivatives by the arc length, and the input, mm, (n,) each, at arc lengths s (n,)."""
    points, tangents = spans.pieces.points(s), spans.pieces.tangents(s)
    bend = 0.5 * spans.pieces.curvature[:, None] * np.stack([-tangents[:, 1], tangents[:, 0]], axis=-1)
    x, y = (Jet(np.stack([points[:, i], tangents[:, i], bend[:, i]])) for i in (0, 1))
    lift, u = _guided(follower, x, y)
    at = u.c[0].copy()
    if not follower.endless:
        u.c[0] = np.clip(u.c[0], *follower.span)
    rows = (lift - follower.law.on(u)).derivatives()
    return rows[0], rows[1], rows[2], at


def _guided(follower: LinearFollower, x: Jet, y: Jet) -> tuple[Jet, Jet]:
    guide = follower.guide
    if isinstance(guide, Stem):
        lift = (y - follower.level) * (1.0 / math.cos(guide.gamma))
        return lift, x - lift * math.sin(guide.gamma)
    share = (y - guide.pivot) * (1.0 / guide.length)
    return asin(share) - follower.psi0, x + sqrt(1.0 - share * share) * (guide.side * guide.length)


def _enclosed(follower: LinearFollower, spans: _Spans) -> tuple[Array, Array, Mask]:
    """Lower and upper bounds (3, n) of the error and two derivatives over spans, and where the velocity may jump."""
    pieces, half = spans.pieces, spans.half
    middle, tangent = pieces.points(spans.middle), pieces.tangents(spans.middle)
    k = pieces.curvature
    turn = Ball.between(-np.abs(k) * half, np.abs(k) * half)
    sine, cosine = sin_cos(turn)
    way = [cosine * tangent[:, 0] - sine * tangent[:, 1], sine * tangent[:, 0] + cosine * tangent[:, 1]]
    within = Ball.between(-half, half)
    bends = [way[1] * (-0.5 * k), way[0] * (0.5 * k)]
    x, y = (_jet(within * way[i] + middle[:, i], way[i], bends[i]) for i in (0, 1))
    guide = follower.guide
    if isinstance(guide, Stem):
        lift = (y - follower.level) * (1.0 / math.cos(guide.gamma))
        u = x - y * math.tan(guide.gamma) + follower.level * math.tan(guide.gamma)
    else:
        share = (y - guide.pivot) * (1.0 / guide.length)
        lift = asin(share) - follower.psi0
        u = x + sqrt(1.0 - share**2) * float(guide.side * guide.length)
    low, high = u.rows[0].bounds()
    over = np.zeros(len(half), dtype=np.bool_)
    for corner in follower.corners.tolist():
        over |= _holds(follower, low, high, corner)
    first, last = follower.span
    if not follower.endless:  # the spans lie within the motion, their balls may not
        low, high = np.clip(low, first, last), np.clip(high, first, last)
    inner = Ball.between(low, high)
    u = BallJet(np.concatenate([inner.mid[None], u.mid[1:]]), np.concatenate([inner.rad[None], u.rad[1:]]))
    least, most = (lift - follower.law.on(u)).bounds()
    return least, most, over


def _holds(follower: LinearFollower, low: Array, high: Array, corner: float) -> Mask:
    if not follower.endless:
        inside: Mask = (low < corner) & (corner < high)
        return inside
    length = follower.span[1] - follower.span[0]
    return np.not_equal(np.floor((high - corner) / length), np.floor((low - corner) / length))


def _jet(*rows: Ball) -> BallJet:
    return BallJet(np.stack([row.mid for row in rows]), np.stack([row.rad for row in rows]))
