"""How far a roller is off its intended motion at most: over all shaft angles, with a proved remainder.

Along a piece of what bounds the roller's centre (a line or arc of arc length s) position and shaft angle are closed
forms of s (`kin.guide`), so the error f(s) = position - intended(shaft angle) is known with f' and f'', and f''' is
bounded over an interval by magnitudes of its terms. About the middle of an interval of half-width h

    f <= max over |x| <= h of (f + f' x + f'' x^2/2) + B3 h^3/6,

with B2 in place of f'' and B3 where the intended acceleration jumps inside. Intervals whose bound exceeds the greatest
error found so far are halved. The roller's position is the greatest that any piece gives, so

- the greatest error is the greatest over all pieces, touched or not;
- the error is nowhere below that of a piece which spans a range of shaft angles, whether it is touched there or not:
  the least error is bounded over the pieces that are touched from one sample to the next, where two of them change
  over somewhere between samples by each up to about their crossing.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple, Protocol

import numpy as np

from kin.arcs import Arcs, cross, dot, nearest_on
from kin.check import UnsettledError
from kin.contact import angles_of, extent, meet, within_reach

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from kin.arcs import Array, Indices
    from kin.guide import Guide

SHARE = 1e-3  # of the error, to which it is found
RESOLUTION = 1e-12  # of a radian, or of the cam's extent: what rounding leaves of nothing
OUTWARD = 1.0 + 1e-9  # by which bounds are widened against their own rounding
MOST_HALVINGS = 60
MOST_OPEN = 100_000  # intervals, beside four times those given, that may stay undecided
BLOCK = 8192  # intervals at a time, so that their arrays stay in the cache
STEPS = 8  # towards the crossing of two pieces


class Intended(Protocol):
    """An intended motion over the shaft angle."""

    def rows(self, phi: Array) -> Array:
        """Position, mm or radians, and two derivatives at shaft angles phi (n,): (3, n)."""

    def steepest(self, low: Array, high: Array) -> Array:
        """Bounds of the magnitudes of three derivatives over shaft angles from low to high, each (n,): (3, n)."""


class Greatest(NamedTuple):
    """An error that is reached, its shaft angle, and by how much the greatest of all may exceed it, proved."""

    error: float
    at: float
    remainder: float


class Spans(NamedTuple):
    """Intervals middle +- half of arc length, each (n,), on the pieces of these numbers (n,)."""

    piece: Indices
    middle: Array
    half: Array

    def take(self, which: slice | NDArray[np.bool_]) -> Spans:
        """Choose some."""
        return Spans(self.piece[which], self.middle[which], self.half[which])

    def halved(self) -> Spans:
        """Both halves of each."""
        half = 0.5 * self.half
        middle = np.concatenate([self.middle - half, self.middle + half])
        return Spans(np.tile(self.piece, 2), middle, np.tile(half, 2))


@dataclass(frozen=True, eq=False)
class Tracking:
    """A guided roller on short pieces (`kin.contact.shortened`) that bound its centre, and what it is meant to do."""

    pieces: Arcs
    guide: Guide
    intended: Intended

    @property
    def resolution(self) -> float:
        """What rounding may make of no error, mm or radians."""
        return RESOLUTION * (extent(self.pieces) if self.guide.unit == "mm" else 1.0)

    def greatest(self, found: Greatest) -> Greatest:
        """Greatest error where the roller stands too far out; `found` if that is more. UnsettledError if unproved."""
        near = np.flatnonzero(within_reach(self.pieces, self.guide, self.guide.slack(extent(self.pieces))))
        half = 0.5 * self.pieces.length[near]
        return self._search(Spans(near, half, half), 1.0, found)

    def least(self, found: Greatest, phi: Array, r: Array, piece: Indices) -> Greatest:
        """Greatest error where it stands too far in; `found` if that is more. UnsettledError if unproved.

        At shaft angles phi (n,) the centre touches pieces (n,) at distances r (n,) from the shaft. Among phi must be
        the ends of all pieces.
        """
        return self._search(self._touched(phi, r, piece), -1.0, found)

    def _search(self, spans: Spans, sign: float, found: Greatest) -> Greatest:
        """Halve the spans until none can hold much more than the greatest of sign * error."""
        most, ceiling = 4 * len(spans.piece) + MOST_OPEN, found.error + found.remainder
        for _ in range(MOST_HALVINGS):
            bounds, tops = [], []
            for begin in range(0, len(spans.piece), BLOCK):
                block = spans.take(slice(begin, begin + BLOCK))
                bound, top = self._bound(block, sign)
                bounds.append(bound)
                tops.append(top)
            bound = np.concatenate(bounds) if bounds else np.empty(0)
            if not len(bound):
                break
            found = self._better(found, spans, np.concatenate(tops, axis=1), sign)
            enough = found.error + max(SHARE * found.error, self.resolution)
            open_ = ~(bound <= enough)
            ceiling = max(ceiling, float(bound[~open_].max(initial=ceiling)))
            if not open_.any():
                break
            if 2 * np.count_nonzero(open_) > most:
                raise UnsettledError("the motion error is not proved: too many intervals stay undecided")
            spans = spans.take(open_).halved()
        else:
            raise UnsettledError("the motion error is not proved: it is rougher than rounding")
        return found._replace(remainder=max(ceiling - found.error, 0.0))

    def _better(self, found: Greatest, spans: Spans, tops: Array, sign: float) -> Greatest:
        """The greatest error at the middles, or where the most promising parabola has its top, if it exceeds `found`.

        `tops` (3, n): errors at the middles, greatest of each parabola, and where.
        """
        value, top, where = tops
        for i, s in ((int(np.argmax(value)), 0.0), (int(np.argmax(top)), float(where[int(np.argmax(top))]))):
            piece, at = spans.piece[i : i + 1], spans.middle[i : i + 1] + s
            phi, rows = self._errors(piece, at)
            reached = sign * float(rows[0, 0])
            if reached > found.error:
                found = Greatest(reached, float(phi[0]), 0.0)
        return found

    def _errors(self, piece: Indices, s: Array) -> tuple[Array, Array]:
        """Shaft angles (n,), and error and two derivatives by s (3, n), at s (n,) on pieces (n,)."""
        state = _State.of(self.pieces.take(piece), s, self.guide)
        return state.phi, state.error(self.intended.rows(state.phi))

    def _bound(self, spans: Spans, sign: float) -> tuple[Array, Array]:
        """Upper bounds of sign * error over spans (n,), and rows (3, n) of what `_better` asks for."""
        state = _State.of(self.pieces.take(spans.piece), spans.middle, self.guide)
        f, slope, bend = sign * state.error(self.intended.rows(state.phi))
        h = spans.half
        first, second, third = state.most(h, self.intended)
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            where = np.where(bend < 0.0, np.clip(-slope / bend, -h, h), np.copysign(h, slope))
            top = f + where * (slope + 0.5 * where * bend)
            bound = top + third * h**3 / 6.0
            bound = np.fmin(bound, f + np.abs(slope) * h + 0.5 * second * h**2)
            bound = np.fmin(bound, f + first * h)
        return np.where(np.isnan(bound), np.inf, bound), np.stack([f, top, where])

    def _touched(self, phi: Array, r: Array, piece: Indices) -> Spans:
        """Spans of pieces that reach over the whole turn, from contacts at shaft angles phi (n,)."""
        turn = 2.0 * np.pi
        order = np.argsort(np.mod(phi, turn), kind="stable")
        phi, r, piece = np.mod(phi, turn)[order], r[order], piece[order]
        change = np.flatnonzero(piece != np.roll(piece, -1))  # before each change of piece
        if len(change) < 2:
            raise UnsettledError("the motion error is not proved: one piece is touched all round")
        after = (change + 1) % len(phi)
        a, b, one, other = phi[change], phi[after], piece[change], piece[after]
        here, there = self.guide.position(r[change]), self.guide.position(r[after])
        spans = [(one, np.roll(self._place(other, b, there), 1), self._place(one, a, here))]
        b = np.where(b < a, b + turn, b)
        far, near = self._meet(one, b), self._meet(other, a)
        both = np.isfinite(far) & np.isfinite(near)
        if not (np.isfinite(far) | np.isfinite(near)).all():
            raise UnsettledError("the motion error is not proved: the roller leaps from piece to piece")
        # where just one of them spans the gap it is taken over all of it, else each up to about the crossing
        switch = np.where(np.isfinite(far), b, a)
        switch[both] = self._crossing(
            one[both], other[both], a[both], b[both], here[both] - near[both], far[both] - there[both]
        )
        for real, number, known, position in ((switch > a, one, a, here), (switch < b, other, b, there)):
            to = self._place(number[real], switch[real], self._meet(number[real], switch[real]))
            spans.append((number[real], self._place(number[real], known[real], position[real]), to))
        number, begin, end = (np.concatenate(rows) for rows in zip(*spans, strict=True))
        self._demand_short(np.unique(number))
        half = 0.5 * np.abs(end - begin)
        return Spans(number, 0.5 * (begin + end), half + 1e-15 * self.pieces.length[number])

    def _demand_short(self, number: Indices) -> None:
        """Raise UnsettledError unless pieces span so little that from one shaft angle to another there is one way."""
        _, reach = angles_of(self.pieces.take(number), self.guide, self.guide.slack(extent(self.pieces)))
        if not (reach < 0.5 * np.pi).all():
            raise UnsettledError("the motion error is not proved: a piece is reached from half the turn")

    def _crossing(self, one: Indices, other: Indices, a: Array, b: Array, at_a: Array, at_b: Array) -> Array:
        """About where pieces `other` come to stand out beyond `one`, between shaft angles a and b (n,).

        `at_a` >= 0 >= `at_b` is how far the one stands beyond the other there. Any angle between is right.
        """
        low, high, f, g = a, b, np.maximum(at_a, 0.0), np.minimum(at_b, 0.0)
        middle = 0.5 * (a + b)
        for _ in range(STEPS):
            with np.errstate(divide="ignore", invalid="ignore"):
                middle = low + (high - low) * np.where(f > g, f / (f - g), 0.5)
            if not len(middle):
                break
            gap = self._meet(one, middle) - self._meet(other, middle)
            if not np.isfinite(gap).all():
                raise UnsettledError("the motion error is not proved: a piece is left between its ends")
            up = gap > 0.0
            # Illinois: an end that stays is trusted half as much
            low, f, g = np.where(up, middle, low), np.where(up, gap, 0.5 * f), np.where(up, 0.5 * g, gap)
            high = np.where(up, high, middle)
        return middle

    def _meet(self, piece: Indices, phi: Array) -> Array:
        """Position with the centre on pieces (n,) at shaft angles phi (n,), -inf where it does not come there."""
        slack = self.guide.slack(extent(self.pieces))
        r = meet(self.pieces.take(piece), self.guide, phi, slack)
        return np.where(np.isfinite(r), self.guide.position(np.maximum(r, 0.0)), -np.inf)

    def _place(self, piece: Indices, phi: Array, position: Array) -> Array:
        """Arc length on pieces (n,) of the centre at shaft angles phi and positions (n,)."""
        return nearest_on(self.pieces.take(piece), self.guide.centre(phi, position))[0]


@dataclass(frozen=True, eq=False)
class _State:
    """The centre at n places on pieces: what position and shaft angle and their derivatives by s are made of.

    With P, T and k point, tangent and curvature of the piece: r = |P|, a = P.T, c = P x T, b = 1 - k c, so that
    a' = b, c' = k a, (r^2)' = 2 a. q is the derivative of the position, phi_1 that of the shaft angle.
    """

    guide: Guide
    k: Array
    r: Array
    a: Array
    c: Array
    b: Array
    phi: Array
    position: tuple[Array, Array, Array]
    angle: tuple[Array, Array]

    @staticmethod
    def of(pieces: Arcs, s: Array, guide: Guide) -> _State:
        """State at s (n,) on each of the pieces."""
        point, tangent, k = pieces.points(s), pieces.tangents(s), pieces.curvature
        a, c, r = dot(point, tangent), cross(point, tangent), np.hypot(point[:, 0], point[:, 1])
        b, u = 1.0 - k * c, r * r
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            size = np.sqrt(np.maximum(guide.square(u), 0.0))
            m, m_slope = guide.moment(u), 2.0 * guide.moment_slope * a
            q = 2.0 * a / size
            q_1 = (2.0 * b - 0.5 * guide.square_slope(u) * q * q) / size
            phi_1 = (c + m * q) / u
            phi_2 = (k * a + m_slope * q + m * q_1 - 2.0 * a * phi_1) / u
        phi = np.nan_to_num(np.arctan2(point[:, 1], point[:, 0]) - guide.lead(r))
        return _State(guide, k, r, a, c, b, phi, (guide.position(r), q, q_1), (phi_1, phi_2))

    def error(self, meant: Array) -> Array:
        """Error and two derivatives by s, (3, n), from the intended position's rows (3, n) by the shaft angle."""
        (place, q, q_1), (phi_1, phi_2) = self.position, self.angle
        with np.errstate(invalid="ignore", over="ignore"):
            return np.stack([place - meant[0], q - meant[1] * phi_1, q_1 - meant[2] * phi_1**2 - meant[1] * phi_2])

    def most(self, half: Array, intended: Intended) -> tuple[Array, Array, Array]:
        """Bounds of the magnitudes of the error's three derivatives by s, within `half` (n,): (n,) each."""
        guide, k, h = self.guide, np.abs(self.k), half * OUTWARD
        far, near = self.r + h, np.maximum(self.r - h, 0.0)
        c = np.abs(self.c) + k * h * far
        b = np.abs(self.b) + k * k * h * far
        a = np.minimum(np.abs(self.a) + b * h, far)
        least, most = near**2, far**2
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            # S^2 bends downwards, its slope and m are linear: each is worst at an end
            size = np.sqrt(np.maximum(np.minimum(guide.square(least), guide.square(most)), 0.0))
            slope = np.maximum(np.abs(guide.square_slope(least)), np.abs(guide.square_slope(most)))
            m = np.maximum(np.abs(guide.moment(least)), np.abs(guide.moment(most)))
            m_1, m_2 = 2.0 * a * abs(guide.moment_slope), 2.0 * b * abs(guide.moment_slope)
            q = 2.0 * a / size
            q_1 = (2.0 * b + 0.5 * slope * q * q) / size
            q_2 = (2.0 * k * k * a + abs(guide.square_bend) * a * q * q + 1.5 * slope * q * q_1) / size
            phi_1 = (c + m * q) / least
            phi_2 = (k * a + m_1 * q + m * q_1 + 2.0 * a * phi_1) / least
            phi_1 = np.fmin(phi_1, np.abs(self.angle[0]) + phi_2 * h)
            q = np.fmin(q, np.abs(self.position[1]) + q_1 * h)
            phi_3 = (k * b + m_2 * q + 2.0 * m_1 * q_1 + m * q_2 + 2.0 * b * phi_1 + 4.0 * a * phi_2) / least
            first, second, third = intended.steepest(self.phi - phi_1 * h, self.phi + phi_1 * h)
            return (
                OUTWARD * (q + first * phi_1),
                OUTWARD * (q_1 + second * phi_1**2 + first * phi_2),
                OUTWARD * (q_2 + third * phi_1**3 + 3.0 * second * phi_1 * phi_2 + first * phi_3),
            )
