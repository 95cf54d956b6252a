"""Rollers on a guide: one, two on rigid arms with the cam between them, and two opposite ones in a translating frame.

Positions are mm or swings in radians, error figures mm or degrees. The greatest motion error is that over all shaft
angles, with a proved remainder (`kin.follower.tracking`). A smooth contour of polynomials is followed itself
(`kin.follower.on_spline`); arcs stand for splines that have corners, are rational or lie beside lines and arcs, and
their distance is counted in. On a polygon of more than MOST_PIECES pieces, and where the proof does not succeed, the
error is that of samples: at the given shaft angles, where a piece stands out most and, up to MOST_PIECES, where the
roller passes from piece to piece and midway along each; more closely about the worst of them. The play between two
rollers is likewise that of samples, without the closer look.
"""

from __future__ import annotations

import math
from abc import abstractmethod
from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from kin.contour.arcs import cross, dot, left, right
from kin.contour.dilated import dilated
from kin.contour.nearest import signed_distance
from kin.follower.base import Closure, Moved, OfLaw, OfTransmission
from kin.follower.contact import Search, shortened
from kin.follower.envelope import RollerEnvelope, TransmissionPitch
from kin.follower.guide import led
from kin.follower.laws import GuidedPitch, leeway
from kin.follower.motion_error import ContactError, Judged, Play, motion_error, with_steps
from kin.follower.on_spline import SplinePath
from kin.follower.rests import dwell_angles
from kin.follower.tracking import Greatest, Held, greatest, greatest_error, outward
from kin.numeric.angles import TURN, degrees
from kin.numeric.errors import UnsettledError
from kin.numeric.feet import grid
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kin.contour.arcs import Arcs
    from kin.contour.contour import Contour
    from kin.follower.guide import Guide
    from kin.follower.tracking import IntendedLaw
    from kin.law.contacts import Contact, Side
    from kin.numeric.arrays import Array, Indices

MOST_ARCS = 200_000  # pieces in place of a spline, which repeats nothing
MOST_PIECES = 20_000  # of a polygon: with more the error repeats itself many times between neighbouring shaft angles
ONE_ANGLE = 1e-12  # rad; shaft angles this near are one
CLOSER = 8  # places about which samples are looked at more closely, and steps to either side
ROUNDS = 4  # of samples, each closer than the last
SPLINE_ERROR = 1e-7  # mm, within which arcs stand in for a spline that drives a train
INSET = 1e-6  # of an interval between two angles, so far within which the piece met there is sought
HALVINGS = 60  # of an interval, more than a number has bits: a passage is found to its last places


@dataclass(frozen=True, eq=False)
class OfRoller:
    """Own position of a guided roller that rests on a contour; `obstacle` bounds what its centre cannot enter.

    The guide stands `turned`, rad, ahead of the shaft angle.
    """

    obstacle: Arcs
    guide: Guide
    turned: float = 0.0
    smooth: ClassVar[bool] = False  # the roller may rest in a hollow

    @cached_property
    def _search(self) -> Search:
        return Search.of(self.obstacle, self.guide)

    def _touched(self, phi: Array) -> tuple[Array, Indices]:
        return contact_distances(self._search, phi, self.turned)

    @cached_property
    def breaks(self) -> Array:
        """Shaft angles (k,), rad, rising, where the centre can come to an end of a piece or passes from piece to piece.

        Two passages within a millionth of an interval may be lost. Raises ContactError where the roller touches
        nothing.
        """
        # between angles of ends one passage at most is expected: it is bisected
        ends = self.guide.shaft_angle(np.concatenate([self.obstacle.start, self.obstacle.ends])) - self.turned
        ends = np.unique(np.mod(ends[np.isfinite(ends)], TURN))
        width = np.diff(ends, append=ends[:1] + TURN)
        ends, width = ends[width > 1e-12], width[width > 1e-12]
        low, high = ends + INSET * width, ends + (1.0 - INSET) * width
        piece = self._touched(low)[1]
        leaps = piece != self._touched(high)[1]
        low, high, piece = low[leaps], high[leaps], piece[leaps]
        for _ in range(HALVINGS if len(low) else 0):
            middle = 0.5 * (low + high)
            same = self._touched(middle)[1] == piece
            low, high = np.where(same, middle, low), np.where(same, high, middle)
        return np.sort(np.mod(np.concatenate([ends, low]), TURN))

    def rows(self, phi: Array) -> Array:
        """Position, m or rad, and two derivatives by the shaft angle, (3, n), at angles phi (n,), not at breaks.

        Raises ContactError where the roller touches nothing.
        """
        guide, angle = self.guide, phi + self.turned
        r, piece = self._touched(phi)
        met = self.obstacle.take(piece)
        position = guide.position(r)
        x = guide.centre(angle, position)
        # the piece's circle is 2 y.m + k y^2 = 0 with y = x - start: its gradient m + k y points outwards
        outward = right(met.tangent) + met.curvature[:, None] * (x - met.start)
        tangent = left(outward / np.hypot(outward[:, 0], outward[:, 1])[:, None])
        rows: Array = guide.si * np.stack([position, *guide.rates(angle, x, tangent, met.curvature)])
        return rows

    def pressed(self, phi: Array) -> tuple[Array, Array]:
        """Pressure angle, rad, and radius of curvature of the path of the roller's centre, mm, (n,) each, at phi (n,).

        Raises ContactError where the roller touches nothing.
        """
        angle = phi + self.turned
        r, piece = self._touched(phi)
        met = self.obstacle.take(piece)
        position = self.guide.position(r)
        outward = right(met.tangent) + met.curvature[:, None] * (self.guide.centre(angle, position) - met.start)
        across, _ = self.guide.along(angle, position)
        with np.errstate(divide="ignore"):
            radius = 1.0 / met.curvature
        return np.arctan2(cross(outward, across), dot(outward, across)), radius


@dataclass(frozen=True, eq=False)
class _Rollers(Moved):
    """Common part of a follower with one roller and one with two rollers of the same radius."""

    side: Side  # of the contour on which the metal lies: 1 inside, -1 outside
    judged: ClassVar[int]  # number of contacts, from the first, whose motion error counts

    @property
    def radius(self) -> float:
        """Radius of the rollers, mm."""
        return self.contacts[0].touch.radius

    @cached_property
    def guides(self) -> tuple[Guide, ...]:
        """Formulas of each contact's guide."""
        return tuple(led(contact.guide, self.side) for contact in self.contacts)

    @property
    def lever(self) -> float:
        """Length of the arm, mm; infinite on a line of travel."""
        return self.guides[0].lever

    def drives(self, contour: Contour) -> list[OfRoller]:
        """Own position of each roller; arcs stand for splines, within `contour.arcs_within` or SPLINE_ERROR, mm."""
        obstacle = self._obstacle(contour, contour.arcs_within or SPLINE_ERROR)
        guided = zip(self.contacts, self.guides, strict=True)
        return [OfRoller(obstacle, guide, contact.turned) for contact, guide in guided]

    def pressed(self, contour: Contour, phi: Array) -> tuple[Array, Array]:
        """Pressure angle at contact 1, rad, and radius of curvature of the contour there, mm, (n,) each, at phi (n,).

        The angle counts counter-clockwise from the normal out of the metal to the way in which the roller moves away
        from the metal. The radius is 0 at a corner, negative in a hollow and infinite on a line. Raises ContactError
        where the roller touches nothing.
        """
        pressure, radius = self.drives(contour)[0].pressed(phi)
        return pressure, radius - self.radius

    def touching(self, points: Array, normals: Array) -> list[tuple[Array, Array]]:
        """Shaft angle, rad, and position, mm or rad, (n,) each, with each roller on metal at points (n, 2), mm.

        `normals` (n, 2) are outward of the contour. Out of reach the angle is nan.
        """
        centres = points + self.side * self.radius * normals
        distance = np.hypot(centres[:, 0], centres[:, 1])
        return [
            (guide.shaft_angle(centres) - contact.turned, contact.position(guide.position(distance)))
            for contact, guide in zip(self.contacts, self.guides, strict=True)
        ]

    def _obstacle(self, contour: Contour, *spline: float) -> Arcs:
        chain = contour.as_arcs(*spline)[0]
        return dilated(chain if self.side > 0 else chain.reversed(), self.radius)

    @cached_property
    def pitches(self) -> tuple[GuidedPitch, ...]:
        """Intended path of each roller's centre."""
        guided = zip(self.contacts, self.guides, strict=True)
        return tuple(GuidedPitch(contact, guide, self.breaks, self.over) for contact, guide in guided)

    @cached_property
    def _rates(self) -> tuple[tuple[Array, Array], ...]:
        """Absolute derivatives of each roller's distance from its pitch curve by the position, (n,) each, all round."""
        tau = grid(self.breaks)
        return tuple(pitch.rates(tau) for pitch in self.pitches)

    @abstractmethod
    def _looked(self, obstacle: Arcs, steps: Array) -> tuple[Array, ...]:
        """Shaft angles at which each roller whose error counts is looked at: `steps` first."""

    @abstractmethod
    def _play(self, contour: Contour, obstacle: Arcs, rollers: Sequence[Held], phi: Array) -> Play | None:
        """Play at shaft angles phi (n,) and where rollers pass from piece to piece; None for a single roller."""

    def judge(self, contour: Contour, phi: Array) -> Judged:
        """Motion error with a roller in contact, and the play; rms and increments are from the shaft angles phi (n,).

        Raises ContactError where a roller meets nothing.
        """
        try:
            return self._judged_on_spline(contour, phi)
        except UnsettledError:
            pass  # arcs stand for it
        obstacle, steps, spread = self._obstacle(contour), with_steps(phi), contour.spread
        # the rollers at the given angles, an increment further, and where few pieces end
        few = len(obstacle) <= (MOST_ARCS if contour.beziers.count else MOST_PIECES)
        judged = list(zip(self.contacts, self.guides, self._looked(obstacle, steps), strict=False))
        # a roller that stands turned meets the contour as one that does not meets it turned back
        held = [hold_roller(obstacle.turned(-contact.turned), guide, at, contact, few) for contact, guide, at in judged]
        place = [roller.contact.position(roller.position[: len(steps)]) for roller in held]
        errors = np.stack(place) - self.course.rows(steps)[0]
        worst, remainder = settled(held, self.course, errors, few=few)
        # range of the position over each dwell
        dwells = list(dwell_angles(self.rests, phi))
        kept = np.empty((1, 0))
        if dwells:
            kept = np.stack([held_position(roller.search, roller.contact, np.concatenate(dwells)) for roller in held])
        ends = np.cumsum([len(angle) for angle in dwells])[:-1]
        flatness = [float(np.ptp(part, axis=1).max()) for part in np.split(kept, ends, axis=1) if part.size]
        # arcs in place of splines may be off by `spread`
        off = self.motion_limit(spread) if spread else 0.0
        motion = motion_error(worst, errors, max(flatness, default=None), self.unit, remainder=remainder, off=off)
        play, closure = self._play(contour, obstacle, held, phi), self.closure
        return Judged(motion, play.less_sure(closure.limit(spread)) if spread and play and closure else play)

    def _judged_on_spline(self, contour: Contour, phi: Array) -> Judged:
        """Judge on the contour's own Bezier pieces, if these are smooth. UnsettledError where they are not."""
        guided = zip(self.contacts, self.guides, strict=True)
        paths = [SplinePath.of(contour, self.side * self.radius, guide, contact) for contact, guide in guided]
        steps, counted = with_steps(phi), paths[: self.judged]
        # one search at all angles: the given ones, an increment further, ends of pieces, dwells
        angles = np.concatenate(
            [steps, *(path.ends for path in paths), *(rests := list(dwell_angles(self.rests, phi)))]
        )
        place = np.stack([path.contact.position(path.reached(angles)) for path in paths])
        errors = place[: self.judged, : len(steps)] - self.course.rows(steps)[0]
        sampled = Greatest(*greatest(np.abs(errors).max(axis=0), steps), 0.0)
        proved = greatest_error(counted, self.course, sampled)
        ends = np.cumsum([len(angles) - sum(map(len, rests)), *(len(angle) for angle in rests)])
        flatness = [float(np.ptp(part, axis=1).max()) for part in np.split(place[: self.judged], ends, axis=1)[1:-1]]
        worst = proved.error, proved.at
        motion = motion_error(worst, errors, max(flatness, default=None), self.unit, remainder=proved.remainder)
        looked = np.r_[: len(phi), len(steps) : ends[0]]
        gap = self._gaps(paths, angles[looked], place[:, looked])
        return Judged(motion, None if gap is None else sampled_play(gap, angles[looked]))

    @abstractmethod
    def _gaps(self, paths: Sequence[SplinePath], phi: Array, place: Array) -> Array | None:
        """Gaps (n,), mm, at shaft angles phi (n,) by positions (2, n) of both rollers; None for a single roller."""

    def motion_limit(self, tolerance: float) -> float:
        """Greatest error, degrees or mm, of a contour within `tolerance` e, mm, of the exact one.

        To first order it is e/cos(pressure angle), on an arm divided by its length; the largest over the turn and of
        all rollers. The term of second order is added. Raises ContactError for a pressure angle of 90 degrees.
        """
        most = max(float(leeway(*rates, tolerance).max()) for rates in self._rates)
        return math.degrees(most) if self.unit == "deg" else most


class _Guided(OfLaw, _Rollers):
    """Rollers on guides, of which the first is to follow a law over the shaft angle."""

    judged = 1

    @cached_property
    def envelope(self) -> RollerEnvelope:
        """The exact contour; its parameter is the shaft angle."""
        return RollerEnvelope(self.pitches[0], self.side * self.radius)

    def _looked(self, obstacle: Arcs, steps: Array) -> tuple[Array, ...]:  # noqa: ARG002 - nothing else is asked of it
        return (steps,)

    def _play(self, contour: Contour, obstacle: Arcs, rollers: Sequence[Held], phi: Array) -> Play | None:  # noqa: ARG002
        return None

    def _gaps(self, paths: Sequence[SplinePath], phi: Array, place: Array) -> Array | None:  # noqa: ARG002
        return None


@dataclass(frozen=True, eq=False)
class GuidedRoller(_Guided):
    """A roller on a guide that stands at the shaft angle in the cam's frame.

    Its position, of which `law` is the intended one over the shaft angle, grows as the roller moves outwards: the angle
    at an arm's pivot between shaft and roller, radians, or the distance travelled from the shaft's foot, mm. A radius
    of 0 is the point of a knife edge, a large one a curved shoe. Where the metal lies outside the roller runs in the
    opening of a ring, which stops it from travelling outwards.
    """


@dataclass(frozen=True, eq=False)
class RollerYoke(_Guided):
    """Two rollers opposite each other in a frame that travels on a line through the shaft.

    The position is the distance p, mm, of roller 1's centre from the shaft, of which `law` is the intended one; that of
    roller 2's centre is w - p, where w, mm, is the distance between the centres. p(theta) + p(theta + pi) = w, so the
    pitch curve has constant diameters through the shaft, and roller 2 makes the error that roller 1 makes half a turn
    on.
    """

    @cached_property
    def _opposite_rates(self) -> tuple[tuple[Array, Array], ...]:
        """Derivatives of both rollers' distances from the pitch curve, all round and where either passes a break."""
        tau = grid(np.sort(np.mod(np.concatenate([self.law.breaks, self.law.breaks + np.pi]), TURN)))
        return tuple(pitch.rates(tau) for pitch in self.pitches)

    @property
    def closure(self) -> Closure:
        """Rule for the play: the way, mm, that the frame can travel with the cam at rest."""
        return Closure(self.play_limit, lever=2.0, radius=self.radius)

    def play_limit(self, tolerance: float) -> float:
        """Greatest play or interference, mm, of a contour within `tolerance`, mm: the sum of both rollers' errors."""
        near, far = (leeway(*rates, tolerance) for rates in self._opposite_rates)
        return float((near + far).max())

    def _play(self, contour: Contour, obstacle: Arcs, rollers: Sequence[Held], phi: Array) -> Play:  # noqa: ARG002
        angle = np.concatenate([phi, passing_angles(obstacle, self.guides[0])])
        near, far = (
            held_position(Search.of(obstacle, guide), contact, angle, contact.turned)
            for contact, guide in zip(self.contacts, self.guides, strict=True)
        )
        return sampled_play(far - near, angle)

    def _gaps(self, paths: Sequence[SplinePath], phi: Array, place: Array) -> Array:  # noqa: ARG002 - the protocol's
        gaps: Array = place[1] - place[0]
        return gaps


@dataclass(frozen=True, eq=False)
class DoubleRoller(OfTransmission, _Rollers):
    """W's two rollers on rigid arms of length l that include 2 alpha, the pivot at l from the shaft.

    The position is psi, clockwise positive; roller A trails the pivot, roller B leads it (W 4.4). Psi is pi - alpha
    less the lean of A, and the lean of B less pi - alpha.
    """

    judged = 2

    @property
    def closure(self) -> Closure:
        """Rule for the play: the gap at roller B while roller A is held in contact."""
        return Closure(self.play_limit, lever=float(np.radians(self.transmission.arm)), radius=self.radius)

    @cached_property
    def envelope(self) -> RollerEnvelope:
        """The exact contour; its parameter is the transmission's own."""
        return RollerEnvelope(TransmissionPitch(self.transmission), self.radius)

    def play_limit(self, tolerance: float) -> float:
        """Greatest gap or interference at roller B, mm, of a contour within `tolerance`, mm, with roller A in contact.

        It is the sum of the error at B and of the travel of B in the swing by an error at A.
        """
        first, (slope, bend) = self._rates
        swing = leeway(*first, tolerance)
        return float((tolerance + slope * swing + 0.5 * bend * swing**2).max())

    def _looked(self, obstacle: Arcs, steps: Array) -> tuple[Array, ...]:
        # of A also where the gap at B may be least or greatest
        return np.concatenate([steps, *(passing_angles(obstacle, guide) for guide in self.guides)]), steps

    def _play(self, contour: Contour, obstacle: Arcs, rollers: Sequence[Held], phi: Array) -> Play:
        # the increments tell nothing new of the gap
        count = sum(len(passing_angles(obstacle, guide)) for guide in self.guides)
        chosen = np.r_[: len(phi), 2 * len(phi) : 2 * len(phi) + count]
        a, b = self.contacts
        angle, swing = rollers[0].phi[chosen], a.position(rollers[0].position[chosen])
        second = self.guides[1].centre(angle, b.own(swing))
        return sampled_play(signed_distance(contour.as_arcs()[0], second) - self.radius, angle)

    def _gaps(self, paths: Sequence[SplinePath], phi: Array, place: Array) -> Array:
        return paths[1].gap(self.guides[1].centre(phi, self.contacts[1].own(place[0])), phi)


def hold_roller(obstacle: Arcs, guide: Guide, looked: Array, contact: Contact[Any, Any], few: bool) -> Held:
    """Hold a roller in contact at shaft angles `looked` (n,), rad, and, if pieces are `few`, where each of them ends.

    The given angles come first. Raises ContactError where the roller touches nothing.
    """
    pieces, phi = obstacle, looked
    if few:
        pieces, _ = shortened(obstacle, guide)
        phi = np.concatenate([looked, end_angles(pieces, guide, looked)])
    search = Search.of(pieces, guide)
    return Held(search, phi, *contact_distances(search, phi), contact)


def settled(
    rollers: Sequence[Held], law: IntendedLaw, sampled: Array, few: bool
) -> tuple[tuple[float, float], float | None]:
    """Greatest absolute error of rollers held in contact, and its shaft angle; and by how much it may be exceeded.

    Errors are mm or rad. `sampled` (k, n) are the errors of k rollers at their first n angles. Where pieces are `few` a
    proof is sought; without it the error is the worst of samples, and None stands for the amount.
    """
    worst_sampled = Greatest(*greatest(np.abs(sampled).max(axis=0), rollers[0].phi[: sampled.shape[1]]), 0.0)
    passing: list[Array] = []
    if few:
        try:
            proved = greatest_error(rollers, law, worst_sampled)
        except UnsettledError:
            passing = [passing_angles(roller.pieces, roller.guide) for roller in rollers]
        else:
            return (proved.error, proved.at), proved.remainder
    return _closely(rollers, law, np.concatenate([*(roller.phi for roller in rollers), *passing])), None


def _closely(rollers: Sequence[Held], law: IntendedLaw, looked: Array) -> tuple[float, float]:
    """Greatest absolute error, and its shaft angle, at shaft angles `looked` (n,) and more closely about the worst.

    Added are angles at which a piece by itself, touched or not, would put the roller out the most, and the ends of the
    pieces that turn the most: beside a dent in a fine polygon they stand out.
    """
    for roller in rollers:
        error, phi = outward(roller, law)
        sharp = roller.pieces.take(np.argsort(np.abs(roller.pieces.curvature * roller.pieces.length))[-2 * CLOSER :])
        ends = roller.guide.shaft_angle(np.concatenate([sharp.start, sharp.ends]))
        looked = np.concatenate([looked, phi[np.argsort(error)[-CLOSER:]], ends[np.isfinite(ends)]])
    worst = 0.0, 0.0
    for _ in range(ROUNDS):
        intended = law.rows(looked)
        errors = [
            np.abs(roller.guide.position(contact_distances(roller.search, looked)[0]) - roller.contact.own(intended[0]))
            for roller in rollers
        ]
        error = np.max(errors, axis=0)
        worst = max(worst, greatest(error, looked))
        # the highest local maxima, each looked at again over the wider of the gaps beside it
        order = np.argsort(np.mod(looked, TURN))
        at, height = np.mod(looked, TURN)[order], error[order]
        gap = np.diff(at, append=at[0] + TURN)
        tops = np.flatnonzero((height >= np.roll(height, 1)) & (height >= np.roll(height, -1)))
        tops = tops[np.argsort(height[tops])[-CLOSER:]]
        width = np.maximum(gap, np.roll(gap, 1))[tops, None]
        looked = (at[tops, None] + width * np.linspace(-1.0, 1.0, 2 * CLOSER + 1)).ravel()
    return worst


def contact_distances(search: Search, phi: Array, turned: float = 0.0) -> tuple[Array, Indices]:
    """Distance of a roller's centre from the shaft, mm, and index of the piece touched, (n,) each, at phi (n,), rad.

    The contact is `turned`, rad, ahead of the shaft. Raises ContactError where the roller touches nothing.
    """
    r, piece = search.first(phi + turned)
    if (piece < 0).any():
        raise ContactError("the roller does not touch the contour", float(phi[int(np.argmin(piece))]))
    return r, piece


def held_position(search: Search, contact: Contact[Any, Any], phi: Array, turned: float = 0.0) -> Array:
    """Position of the follower, mm or rad (n,), at phi (n,), rad, by one roller held in contact.

    The contact is `turned`, rad, ahead of the shaft. Raises ContactError where the roller touches nothing.
    """
    return contact.position(search.guide.position(contact_distances(search, phi, turned)[0]))


def end_angles(pieces: Arcs, guide: Guide, angles: Array) -> Array:
    """Shaft angles (m,), rad, at which the centre comes to an end of a piece, each once, without the known `angles`."""
    angle = guide.shaft_angle(np.concatenate([pieces.start, pieces.ends]))
    angle = np.concatenate([np.mod(angles, TURN), np.mod(angle[np.isfinite(angle)], TURN)])
    order = np.argsort(angle, kind="stable")
    new = np.diff(angle[order], prepend=-1.0) > ONE_ANGLE
    first = np.flatnonzero(new)
    # the known angles stand first in the original order, so the least number of a group shows whether one is known
    least = np.minimum.reduceat(order, first) if len(first) else order
    ends: Array = angle[least[least >= len(angles)]]
    return ends


def passing_angles(obstacle: Arcs, guide: Guide) -> Array:
    """Shaft angles (n,), rad, in [0, 2 pi), at which the roller's centre comes to the start or middle of a piece.

    All starts come first. Points out of the guide's reach are left out, and all for more than MOST_PIECES pieces.
    """
    if len(obstacle) > MOST_PIECES:
        return np.empty(0)
    points = np.concatenate([obstacle.start, obstacle.points(0.5 * obstacle.length)])
    angle = guide.shaft_angle(points)
    return np.mod(angle[np.isfinite(angle)], TURN)


def sampled_play(gap: Array, phi: Array) -> Play:
    """Play between the least and the greatest of sampled gaps (n,), mm, at shaft angles phi (n,)."""
    least, most = int(np.argmin(gap)), int(np.argmax(gap))
    return Play(float(gap[least]), degrees(phi[least]), float(gap[most]), degrees(phi[most]), "mm", "sampled")
