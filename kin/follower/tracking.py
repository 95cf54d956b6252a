"""How far a roller is off its intended motion at most: over all shaft angles, with a proved remainder.

Along a piece of what bounds the roller's centre (a line or arc of arc length s) position and shaft angle are closed
forms of s (`kin.follower.guide`), so the error f(s) = position - intended(shaft angle) is known with f' and f'', and
f''' is bounded over an interval by magnitudes of its terms. About the middle of an interval of half-width h

    f <= max over |x| <= h of (f + f' x + f'' x^2/2) + B3 h^3/6,

with B2 in place of f'' and B3 where the intended acceleration jumps inside. Intervals whose bound exceeds the greatest
error reached so far are cut in four. The roller's position is the greatest that any piece gives, so

- the greatest error is the greatest over all pieces, touched or not;
- the error is nowhere below that of a piece which spans a range of shaft angles, whether it is touched there or not:
  the least error is bounded over the pieces that are touched from one sample to the next, where two of them change
  over somewhere between samples by each up to about their crossing.
"""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple, Protocol

import numpy as np

from kin.contour.arcs import Arcs, cross, dot, nearest_on
from kin.follower.contact import angles_of, extent, meet, within_reach
from kin.follower.laws import own_rows
from kin.numeric.angles import TURN
from kin.numeric.errors import UnsettledError
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from kin.follower.contact import Search
    from kin.follower.guide import Guide
    from kin.law.contacts import Contact
    from kin.numeric.arrays import Array, Indices

SHARE = 1e-6  # of the error, to which it is found
RESOLUTION = 1e-12  # of a radian, or of the cam's extent: what rounding leaves of nothing
OUTWARD = 1.0 + 1e-9  # by which bounds are widened against their own rounding
MOST_CUTS = 30
MOST_OPEN = 1_000_000  # intervals, beside four times those given, that may stay undecided
MORE = 24  # times that contacts may be added where pieces hide one another
TRIES = 8  # to find the pieces that are touched between samples
STEPS = 14  # towards the crossing of two pieces
DOUBT = 1e-9  # of a radian, or of the cam's extent: pieces that are farther apart change over elsewhere


class IntendedLaw(Protocol):
    """Intended motion over the shaft angle, with bounds of its derivatives."""

    def rows(self, phi: Array) -> Array:
        """Position, mm or rad, and two derivatives by the shaft angle at angles phi (n,), rad: (3, n)."""

    def steepest(self, low: Array, high: Array) -> Array:
        """Bounds of the magnitudes of three derivatives over shaft angles from low to high, each (n,): (3, n)."""


class Greatest(NamedTuple):
    """Greatest error found, mm or rad, its shaft angle, and the proved remainder by which any error may exceed it."""

    error: float
    at: float
    remainder: float


class Stretches(Protocol):
    """Stretches of the curves that a roller runs on, each about its middle; (n,) each."""

    @property
    def piece(self) -> Indices:
        """Piece (n,) on which each stretch lies."""

    @property
    def half(self) -> Array:
        """Greatest arc length (n,), mm, from the middle of each stretch to its ends."""

    def quarters(self, which: NDArray[np.bool_]) -> Stretches:
        """Four parts of each stretch that the mask (n,) marks."""

    def one(self, i: int) -> Stretches:
        """Stretch i alone."""

    def summit(self, law: IntendedLaw, where: float) -> Array:
        """Shaft angles (2,), rad, near the greatest error of a single stretch, about `where`, mm, off its middle."""

    def state(self) -> CentreState:
        """Roller centre and its derivatives at the middles of the stretches."""

    def limits(self, state: CentreState) -> DerivativeBounds:
        """Bounds of the derivatives of position and shaft angle over the stretches, from the state at their middles."""

    def bounds(self, state: CentreState, most: tuple[Array, Array, Array], rows: Array) -> tuple[Array, Array, Array]:
        """Upper bounds of the error, an error reached in each, and where, mm off the middle: (n,) each.

        `most` bounds the error's three derivatives, `rows` (3, n) are the law's at the middles.
        """


class Tracked(Protocol):
    """A roller held in contact, whose error is bounded."""

    @property
    def resolution(self) -> float:
        """Greatest motion error, mm or rad, that rounding may feign."""

    @property
    def contact(self) -> Contact[Any, Any]:
        """Contact of the follower that the roller makes, which turns intended positions into its own."""

    def reached(self, phi: Array) -> Array:
        """Own position (n,), mm or rad, of the roller in contact at shaft angles phi (n,), rad."""

    def spans(self) -> Stretches:
        """Stretches of all pieces that the roller may touch."""

    def looked_at_about(self, phi: Array) -> Tracked:
        """Give the roller with the contacts at and next to the shaft angles (n,), rad, added to those known."""


class _Changes(NamedTuple):
    """Contacts before and after each of n changes of the piece touched, (n,) each.

    change, after  numbers of the two contacts
    a, b           their shaft angles, rad, a <= b
    one, other     pieces touched before and after
    """

    change: Indices
    after: Indices
    a: Array
    b: Array
    one: Indices
    other: Indices


@dataclass(frozen=True, eq=False)
class Held:
    """A guided roller held on short pieces (`kin.follower.contact.shortened`) that bound its centre.

    At shaft angles phi (n,), rad, it touches pieces `piece` (n,) at distances r (n,), mm, from the shaft; among these
    are contacts at the ends of all pieces. `contact` is the follower's contact, `search` finds more of them.
    """

    search: Search
    phi: Array
    r: Array
    piece: Indices
    contact: Contact[Any, Any]

    @property
    def pieces(self) -> Arcs:
        """Short pieces that bound the roller's centre."""
        return self.search.obstacle

    @property
    def guide(self) -> Guide:
        """Guide of the roller's centre: an arm or a line of travel."""
        return self.search.guide

    @cached_property
    def position(self) -> Array:
        """Position (n,) of the guide, mm or rad, in the contacts known."""
        return self.guide.position(self.r)

    def reached(self, phi: Array) -> Array:
        """Own position (n,), mm or rad, of the roller in contact at phi (n,), rad; nan where it meets nothing."""
        return self.guide.position(self.search.first(phi)[0])

    @cached_property
    def slack(self) -> float:
        """Greatest length, mm, that rounding may feign."""
        return self.guide.slack(extent(self.pieces))

    @cached_property
    def resolution(self) -> float:
        """Greatest motion error that rounding may feign: a share of the extent, mm, or a constant, rad."""
        return RESOLUTION * (extent(self.pieces) if self.guide.unit == "mm" else 1.0)

    @property
    def doubt(self) -> float:
        """Least difference of positions, mm or rad, that counts where pieces change over."""
        return DOUBT / RESOLUTION * self.resolution

    def spans(self) -> Spans:
        """Spans of all pieces for errors outwards, and of the touched ones for errors inwards.

        Raises UnsettledError where the pieces touched between two contacts are not found.
        """
        near = np.flatnonzero(within_reach(self.pieces, self.guide, self.slack))
        half = 0.5 * self.pieces.length[near]
        touched = self.touched()
        return Spans(
            self,
            np.concatenate([np.ones(len(near)), touched.sign]),
            np.concatenate([near, touched.piece]),
            np.concatenate([half, touched.middle]),
            np.concatenate([half, touched.half]),
        )

    def looked_at_about(self, phi: Array) -> Held:
        """The roller with contacts added at phi (n,), rad, and midway to the known contacts before and after."""
        known = np.sort(np.mod(self.phi, TURN))
        at = np.mod(phi, TURN)
        before = known[np.searchsorted(known, at - DOUBT, side="left") - 1]
        after = known[np.searchsorted(known, at + DOUBT, side="right") % len(known)]
        back, on = np.mod(at - before, TURN), np.mod(after - at, TURN)
        more = np.concatenate([at, at - 0.5 * back, at + 0.5 * on])
        r, piece = self.search.first(more)
        met = piece >= 0
        return replace(
            self,
            phi=np.append(self.phi, more[met]),
            r=np.append(self.r, r[met]),
            piece=np.append(self.piece, piece[met]),
        )

    def touched(self) -> Spans:
        """Spans of the pieces that are touched over the whole turn.

        Raises UnsettledError where the roller leaps from piece to piece.
        """
        phi, r, piece = self.phi, self.r, self.piece
        for spare in reversed(range(TRIES)):
            change, after, a, b, one, other = changes = _changes(phi, piece)
            # position on the piece before at b, and on the piece after at a: -inf where it does not reach so far
            far, near = spanned = self._meet(one, b), self._meet(other, a)
            at_a, at_b = self.guide.position(r[change]), self.guide.position(r[after])
            leap = ~(np.isfinite(far) | np.isfinite(near))
            # a piece that spans the gap alone, and lies deep where it is not touched, stands behind a third one there
            below = np.where(np.isfinite(far), at_b - far, at_a - near)
            deep = (np.isfinite(far) ^ np.isfinite(near)) & (below > self.doubt)
            if not (leap.any() or (spare and deep.any())):
                return self._spans(changes, at_a, at_b, spanned)
            lone = 0.5 * (a + b)[leap | deep]  # between its ends a short arc stands out alone
            more, met = self.search.first(lone)
            if (met < 0).any():
                break
            phi, r, piece = np.append(phi, lone), np.append(r, more), np.append(piece, met)
        raise UnsettledError("the motion error is not proved: the roller leaps from piece to piece")

    def _spans(self, changes: _Changes, here: Array, there: Array, spanned: tuple[Array, Array]) -> Spans:
        """Spans of touched pieces: of each between its first and last contact, and over the changes between pieces.

        `here` and `there` are positions at a and b, `spanned` those of the first piece at b and of the second at a.
        """
        _, _, a, b, one, other = changes
        far, near = spanned
        spans = [(one, np.roll(self._place(other, b, there), 1), self._place(one, a, here))]
        span_both = np.isfinite(far) & np.isfinite(near)
        # where just one of them spans the gap it is taken over all of it, else each up to about the crossing
        switch = np.where(np.isfinite(far), b, a)
        gaps = np.maximum(here - near, 0.0)[span_both], np.minimum(far - there, 0.0)[span_both]
        switch[span_both] = self._crossing((one[span_both], other[span_both]), (a[span_both], b[span_both]), gaps)
        for real, number, known, position in ((switch > a, one, a, here), (switch < b, other, b, there)):
            to = self._place(number[real], switch[real], self._meet(number[real], switch[real]))
            spans.append((number[real], self._place(number[real], known[real], position[real]), to))
        number, begin, end = (np.concatenate(rows) for rows in zip(*spans, strict=True))
        _, reach = angles_of(self.pieces.take(number), self.guide, self.slack)
        if not (reach < 0.5 * np.pi).all():  # else there is one way only along it from one shaft angle to another
            raise UnsettledError("the motion error is not proved: a piece is reached from half the turn")
        half = 0.5 * np.abs(end - begin) + 1e-15 * self.pieces.length[number]
        return Spans(self, np.full(len(number), -1.0), number, 0.5 * (begin + end), half)

    def _crossing(self, pair: tuple[Indices, Indices], ends: tuple[Array, Array], gaps: tuple[Array, Array]) -> Array:
        """Shaft angles (n,) near which the second of a pair of pieces comes to stand out beyond the first.

        `gaps` are the heights of the first above the second at both `ends`, >= 0 and <= 0. Any angle between would do.
        """
        (low, high), (f, g) = ends, gaps
        middle = 0.5 * (low + high)
        pieces = np.concatenate(pair)
        open_ = np.arange(len(middle))  # those that are still sought
        for _ in range(STEPS):
            if not len(open_):
                break
            with np.errstate(divide="ignore", invalid="ignore"):
                at = low + (high - low) * np.where(f > g, f / (f - g), 0.5)
            middle[open_] = at
            first, second = self._meet(pieces, np.tile(at, 2)).reshape(2, -1)
            gap = first - second
            if not np.isfinite(gap).all():
                raise UnsettledError("the motion error is not proved: a piece is left between its ends")
            up, far = gap > 0.0, np.abs(gap) > 10.0 * self.resolution
            # Illinois: an end that stays is trusted half as much
            low, f, g = np.where(up, at, low)[far], np.where(up, gap, 0.5 * f)[far], np.where(up, 0.5 * g, gap)[far]
            high, open_, pieces = np.where(up, high, at)[far], open_[far], pieces[np.tile(far, 2)]
        return middle

    def _meet(self, piece: Indices, phi: Array) -> Array:
        """Position with the centre on pieces (n,) at shaft angles phi (n,), -inf where it does not come there."""
        height = meet(self.pieces.take(piece), self.guide, phi, self.slack)
        met = np.isfinite(height)
        return np.where(met, self.guide.position(np.where(met, self.guide.away * height, 0.0)), -np.inf)

    def _place(self, piece: Indices, phi: Array, position: Array) -> Array:
        """Arc length on pieces (n,) of the centre at shaft angles phi and positions (n,)."""
        return nearest_on(self.pieces.take(piece), self.guide.centre(phi, position))[0]


def _changes(phi: Array, piece: Indices) -> _Changes:
    """Changes of the piece (n,) touched at phi (n,), going round the turn. UnsettledError where there are none."""
    order = np.argsort(np.mod(phi, TURN), kind="stable")
    met, at = piece[order], np.mod(phi, TURN)[order]
    change = np.flatnonzero(met != np.roll(met, -1))
    if len(change) < 2:
        raise UnsettledError("the motion error is not proved: one piece is touched all round")
    after = (change + 1) % len(at)
    a, b = at[change], at[after]
    return _Changes(order[change], order[after], a, np.where(b < a, b + TURN, b), met[change], met[after])


@dataclass(frozen=True, eq=False)
class Spans:
    """Intervals middle +- half of arc length, mm, (n,) each, on pieces `piece` (n,) that a roller is held on.

    `sign` (n,) is 1 where errors outwards are bounded, -1 where errors inwards are.
    """

    held: Held
    sign: Array
    piece: Indices
    middle: Array
    half: Array

    def quarters(self, which: NDArray[np.bool_]) -> Spans:
        """Four equal parts of each stretch that the mask (n,) marks."""
        half = 0.25 * self.half[which]
        middle = np.concatenate([self.middle[which] + k * half for k in (-3.0, -1.0, 1.0, 3.0)])
        sign, piece = np.tile(self.sign[which], 4), np.tile(self.piece[which], 4)
        return Spans(self.held, sign, piece, middle, np.tile(half, 4))

    def one(self, i: int) -> Spans:
        """Stretch i alone."""
        return Spans(self.held, self.sign[[i]], self.piece[[i]], self.middle[[i]], self.half[[i]])

    def summit(self, law: IntendedLaw, where: float) -> Array:
        """Shaft angles (2,), rad: at `where`, mm off the middle of a single span, and a Newton step to its summit."""
        state = replace(self, middle=self.middle + where).state()
        _, slope, bend = self.sign * state.error(own_rows(self.held.contact, law.rows(state.phi)))
        step = -slope / bend if bend[0] < 0.0 else np.zeros(1)
        near = replace(self, middle=self.middle + np.clip(where + step, -self.half, self.half))
        return np.concatenate([state.phi, near.state().phi])

    def state(self) -> CentreState:
        """Roller centre and its derivatives at the middles of the stretches."""
        pieces = self.held.pieces.take(self.piece)
        return CentreState.of(
            pieces.points(self.middle), pieces.tangents(self.middle), pieces.curvature, self.held.guide
        )

    def limits(self, state: CentreState) -> DerivativeBounds:
        """Bounds of the derivatives over the stretches."""
        return state.limits(self.half, np.abs(state.k))

    def bounds(self, state: CentreState, most: tuple[Array, Array, Array], rows: Array) -> tuple[Array, Array, Array]:
        """Upper bounds of sign * error, one reached in each span, and where, mm off the middle: (n,) each.

        `most` bounds the error's three derivatives, `rows` (3, n) are the law's at the middles.
        """
        return bounds_of_error(self.sign * state.error(own_rows(self.held.contact, rows)), most, self.half, self.half)


def greatest(error: Array, phi: Array) -> tuple[float, float]:
    """Greatest of the absolute errors (n,), and its shaft angle out of `phi` (n,)."""
    i = int(np.argmax(np.abs(error)))
    return float(abs(error[i])), float(phi[i])


def greatest_error(rollers: Sequence[Tracked], law: IntendedLaw, sampled: Greatest, tries: int = MORE) -> Greatest:
    """Greatest absolute error of rollers, mm or rad, no less than the `sampled` one, with its proved remainder.

    Where pieces hide one another after all `tries`, the error that a hidden one could make is in the remainder. Raises
    UnsettledError where the error has no bound or the pieces touched are not found.
    """
    groups = [roller.spans() for roller in rollers]
    resolution = rollers[0].resolution
    most = 4 * sum(len(group.piece) for group in groups) + MOST_OPEN
    error, best, ceiling = sampled.error, None, sampled.error
    for round_ in range(MOST_CUTS + 1):
        # bounds of the error over every stretch that is still open, and the greatest error reached
        states = [group.state() for group in groups]
        limits = [group.limits(state) for state, group in zip(states, groups, strict=True)]
        phi = np.concatenate([state.phi for state in states])
        # shaft angles that each roller's stretches reach to either side, by the limits of the slope of its angle
        reach = np.concatenate([roller.angle[0] * group.half for roller, group in zip(limits, groups, strict=True)])
        ends = np.cumsum([len(group.piece) for group in groups])[:-1]  # of each roller's stretches among all
        rows, steepest = law.rows(phi), law.steepest(phi - reach, phi + reach)
        tasks = zip(groups, states, limits, np.split(rows, ends, axis=1), np.split(steepest, ends, axis=1), strict=True)
        upper = []
        for owner, (group, state, limit, intended, steep) in enumerate(tasks):
            bound, reached, where = group.bounds(state, limit.of_error(steep), intended)
            upper.append(bound)
            i = int(np.argmax(reached)) if len(reached) else -1
            if i >= 0 and reached[i] > error:
                error = float(reached[i])
                best = owner, group.one(i), float(where[i])
        # stretches that may hold more are cut in four; the greatest bound of the others is the ceiling
        enough = error + max(SHARE * error, resolution)
        open_ = [~(bound <= enough) for bound in upper]
        ceiling = max(ceiling, *(float(b[~o].max(initial=ceiling)) for b, o in zip(upper, open_, strict=True)))
        count = sum(int(np.count_nonzero(roller)) for roller in open_)  # stretches of all rollers
        if not count:
            break
        if round_ == MOST_CUTS or 4 * count > most:  # rougher than rounding, or too many that stay undecided
            ceiling = max(float(bound.max(initial=ceiling)) for bound in upper)
            break
        groups = [group.quarters(which) for group, which in zip(groups, open_, strict=True)]
    if best is not None:
        # the piece may be hidden behind another one there, so the error is taken where the roller itself rests
        owner, span, off = best
        on, phi = rollers[owner], span.summit(law, off)
        errors = np.abs(on.reached(phi) - on.contact.own(law.rows(phi)[0]))
        claimed, (error, at) = error, greatest(errors, phi)
        if tries and not claimed <= error + SHARE * claimed + resolution:
            looked = [roller.looked_at_about(np.array([at])) if roller is on else roller for roller in rollers]
            return greatest_error(looked, law, sampled, tries - 1)
        if error > sampled.error:
            sampled = Greatest(error, at, 0.0)
    if not np.isfinite(ceiling):
        raise UnsettledError("the motion error is not proved: it has no bound")
    return sampled._replace(remainder=max(ceiling - sampled.error, 0.0))


def outward(roller: Held, law: IntendedLaw) -> tuple[Array, Array]:
    """Error (n,), mm or rad, by which each piece, touched or not, puts the roller out midway, and shaft angle (n,).

    The error is -inf of pieces out of reach.
    """
    # only the middles count: neither signs nor half widths are asked for
    spans = Spans(roller, np.ones(0), np.arange(len(roller.pieces)), 0.5 * roller.pieces.length, np.zeros(0))
    state = spans.state()
    error = state.error(own_rows(roller.contact, law.rows(state.phi)))[0]
    return np.where(within_reach(roller.pieces, roller.guide, roller.slack), error, -np.inf), state.phi


def bounds_of_error(
    error: Array, most: tuple[Array, Array, Array], half: Array, inner: Array
) -> tuple[Array, Array, Array]:
    """Upper bounds of errors in spans, an error reached in each, and where, mm off the middle: (n,) each.

    `error` (3, n) has errors and two derivatives at the middles, `most` bounds three derivatives within `half` (n,) of
    there; each span reaches at least `inner` (n,) to either side.
    """
    f, slope, bend = error
    first, second, third = most

    # greatest of the parabola within h of the middle, and where
    def top(h: Array) -> tuple[Array, Array]:
        where = np.where(bend < 0.0, np.clip(-slope / bend, -h, h), np.copysign(h, slope))
        return where, f + where * (slope + 0.5 * where * bend)

    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        # Taylor's formula of third, second and first order: the least bound counts
        bound = top(half)[1] + third * half**3 / 6.0
        bound = np.fmin(bound, f + np.abs(slope) * half + 0.5 * second * half**2)
        bound = np.fmin(bound, f + first * half)
        where, height = top(inner)
        reached = height - third * np.abs(where) ** 3 / 6.0
    better = reached > f
    return np.where(np.isnan(bound), np.inf, bound), np.where(better, reached, f), np.where(better, where, 0.0)


class DerivativeBounds(NamedTuple):
    """Bounds of the magnitudes of three derivatives by s of the position and of the shaft angle, over spans: (n,)."""

    position: tuple[Array, Array, Array]
    angle: tuple[Array, Array, Array]

    def of_error(self, steepest: Array) -> tuple[Array, Array, Array]:
        """Bounds of the error's three derivatives by s, (n,) each, from bounds (3, n) of the law's by shaft angle."""
        (q, q_1, q_2), (phi_1, phi_2, phi_3) = self
        first, second, third = steepest
        with np.errstate(invalid="ignore", over="ignore"):
            return (
                OUTWARD * (q + first * phi_1),
                OUTWARD * (q_1 + second * phi_1**2 + first * phi_2),
                OUTWARD * (q_2 + third * phi_1**3 + 3.0 * second * phi_1 * phi_2 + first * phi_3),
            )


@dataclass(frozen=True, eq=False)
class CentreState:
    """The centre at n places on pieces: what position and shaft angle and their derivatives by s are made of.

    With P, T and k point, tangent and curvature of the piece: r = |P|, a = P.T, c = P x T, b = 1 - k c, so that
    a' = b, c' = k a, (r^2)' = 2 a, where s, mm, is the arc length of the path. `position` has the position, mm or rad,
    and its first and second derivative by s; `phi` is the shaft angle, rad, and `angle` has its two derivatives by s.
    All are (n,).
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
    def of(point: Array, tangent: Array, k: Array, guide: Guide) -> CentreState:
        """State at points (n, 2), mm, where the path has unit tangents (n, 2) and curvatures k (n,), 1/mm.

        With u = r^2 position' = 2 a/S and phi' = (c + 2 a m/S)/u, S^2 and m being the guide's functions of u.
        """
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
        away = guide.away
        return CentreState(guide, k, r, a, c, b, phi, (guide.position(r), away * q, away * q_1), (phi_1, phi_2))

    def error(self, intended: Array) -> Array:
        """Error and two derivatives by s, (3, n), from the intended position's rows (3, n) by the shaft angle."""
        (place, q, q_1), (phi_1, phi_2) = self.position, self.angle
        with np.errstate(invalid="ignore", over="ignore"):
            return np.stack(
                [place - intended[0], q - intended[1] * phi_1, q_1 - intended[2] * phi_1**2 - intended[1] * phi_2]
            )

    def limits(self, half: Array, k: Array, change: float | Array = 0.0) -> DerivativeBounds:
        """Bounds of three derivatives by s of the position, and of the shaft angle, within `half` (n,): (n,) each.

        The magnitudes of the curvature and of its derivative by s are at most k and `change`, (n,) each, there.
        """
        guide, h = self.guide, half * OUTWARD
        # bounds of r, c, b and a within h of the middle, then of each derivative term by term
        far, near = self.r + h, np.maximum(self.r - h, 0.0)
        c = np.abs(self.c) + k * h * far
        b = np.abs(self.b) + (k * k * far + change * c) * h
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
            q_2 = (2.0 * (k * k * a + change * c) + abs(guide.square_bend) * a * q * q + 1.5 * slope * q * q_1) / size
            phi_1 = (c + m * q) / least
            phi_2 = (k * a + m_1 * q + m * q_1 + 2.0 * a * phi_1) / least
            phi_1 = np.fmin(phi_1, np.abs(self.angle[0]) + phi_2 * h)
            q = np.fmin(q, np.abs(self.position[1]) + q_1 * h)
            phi_3 = (
                k * b + change * a + m_2 * q + 2.0 * m_1 * q_1 + m * q_2 + 2.0 * b * phi_1 + 4.0 * a * phi_2
            ) / least
        return DerivativeBounds((q, q_1, q_2), (phi_1, phi_2, phi_3))
