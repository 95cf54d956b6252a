"""Roller followers: a single roller on an arm or on a line of travel, and two on rigid arms, the cam between them.

Positions are mm or swings in radians, error figures mm or degrees. The greatest motion error is that over all shaft
angles, with a proved remainder (`kin.follower.tracking`). On a contour of more than MOST_PIECES pieces, and where the
proof does not succeed, it is that of samples: at the given shaft angles and, up to MOST_PIECES, where the roller
passes from piece to piece and midway along each. So is the gap at a second roller.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, ClassVar

import numpy as np

from kin.contour.arcs import cross, dot, left, right
from kin.contour.nearest import signed_distance
from kin.follower.contact import dilated, first_contact, shortened
from kin.follower.envelope import RollerEnvelope, TransmissionPitch
from kin.follower.flat import dwell_angles
from kin.follower.guide import LEADING, TRAILING, Arm, polar_rows
from kin.follower.motion_error import ContactError, Judged, Play, Unit, motion_error, with_steps
from kin.follower.projection import grid
from kin.follower.steepness import ParameterTable, Steepness, steepness_of_law, steepness_of_transmission
from kin.follower.tracking import Greatest, Held, greatest_error
from kin.numeric.angles import TURN, degrees
from kin.numeric.errors import UnsettledError
from kin.numeric.jet import Jet

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kin.contour.arcs import Arcs
    from kin.contour.contour import Contour
    from kin.follower.guide import Guide, Side
    from kin.follower.tracking import Law
    from kin.law.piecewise import Piecewise
    from kin.law.transmission import Transmission
    from kin.numeric.arrays import Array, Indices

MOST_PIECES = 20_000  # beyond, the error repeats itself many times between neighbouring shaft angles
ONE_ANGLE = 1e-12  # rad; shaft angles this near are one
NEAR = 1e-7  # rad; a step of third order is good to rounding


@dataclass(frozen=True, eq=False)
class Roller:
    """A roller of `radius`, mm, on a guide that stands at the shaft angle in the cam's frame.

    Its position, of which `law` is the intended one over the shaft angle, grows as the roller is lifted: the angle at
    an arm's pivot between shaft and roller, radians, or the distance travelled from the shaft's foot, mm.
    """

    guide: Guide
    radius: float
    law: Piecewise

    @property
    def unit(self) -> Unit:
        """Unit of the errors."""
        return self.guide.unit

    def intended(self, phi: Array) -> Array:
        """Intended position at shaft angles phi (n,), radians or mm (n,)."""
        position: Array = self.law.derivatives(phi, 0)[0]
        return position

    def contact(self, contour: Contour, phi: Array) -> Array:
        """Position with the roller in contact, radians or mm (n,). ContactError where it meets nothing."""
        return held_position(dilated(contour.as_arcs()[0], self.radius), self.guide, phi)

    @cached_property
    def envelope(self) -> RollerEnvelope:
        """The exact contour; its parameter is the shaft angle."""
        return RollerEnvelope(GuidedPitch(self.guide, self.law), self.radius)

    def shaft_angle(self, parameter: Array) -> Array:
        """Shaft angle at which the envelope's point of that parameter is touched (n,)."""
        return parameter

    @cached_property
    def _law(self) -> ByLaw:
        return ByLaw(self.law)

    def judge(self, contour: Contour, phi: Array) -> Judged:
        """Motion error; rms and increments from the given shaft angles phi (n,). ContactError where nothing is met."""
        obstacle = dilated(contour.as_arcs()[0], self.radius)
        steps = with_steps(phi)
        held = held_on(obstacle, self.guide, steps)
        errors = (held.position[: len(steps)] - self.intended(steps))[None]
        worst, remainder = settled([held], self._law, errors, few=len(obstacle) <= MOST_PIECES)
        return Judged(motion_error(worst, errors[0], None, self.unit, remainder=remainder), None)

    def motion_limit(self, tolerance: float) -> float:
        """Greatest error, degrees or mm, of a contour within `tolerance` of the exact one.

        That is e/cos(pressure angle), of an arm over its length, the largest over the turn, and the term of second
        order.
        """
        pitch = self.envelope.pitch
        tau = grid(pitch.breaks)
        along = self.guide.along(tau, self.intended(tau))
        swing = float(leeway(pitch.points(tau), *along, tolerance)[0].max())
        return float(np.degrees(swing)) if self.unit == "deg" else swing


@dataclass(frozen=True, eq=False)
class DoubleRoller:
    """W's two rollers of `radius` on rigid arms of length l that include 2 alpha, the pivot at l from the shaft.

    The position is psi, clockwise positive; roller A trails the pivot, roller B leads it (W 4.4).
    """

    transmission: Transmission
    radius: float
    unit: ClassVar[Unit] = "deg"

    def intended(self, phi: Array) -> Array:
        """Intended psi at shaft angles phi (n,), radians (n,)."""
        psi: Array = self.transmission.psi_of_shaft(phi, 0)[0]
        return psi

    def contact(self, contour: Contour, phi: Array) -> Array:
        """psi, radians (2, n): with roller A held in contact, and with roller B. ContactError where nothing is met."""
        return self._contact(dilated(contour.as_arcs()[0], self.radius), phi)

    def _contact(self, obstacle: Arcs, phi: Array) -> Array:
        return np.stack(
            [self._psi(held_position(obstacle, self._arm(side), phi), side) for side in (TRAILING, LEADING)]
        )

    def _psi(self, lean: Array, side: int) -> Array:
        """Swing psi (n,) of the arms at which the roller on that side leans so, radians (n,)."""
        return side * (lean - np.pi + self.transmission.alpha)

    def _arm(self, side: Side) -> Arm:
        return Arm(self.transmission.arm, self.transmission.arm, side)

    @cached_property
    def envelope(self) -> RollerEnvelope:
        """The exact contour; its parameter is the transmission's own."""
        return RollerEnvelope(TransmissionPitch(self.transmission), self.radius)

    def shaft_angle(self, parameter: Array) -> Array:
        """Shaft angle at which roller A touches the envelope's point of that parameter (n,)."""
        phi: Array = self.transmission.at(parameter, 0)[0][0]
        return phi

    def judge(self, contour: Contour, phi: Array) -> Judged:
        """Motion error with either roller in contact, and the gap at B while A is held.

        Rms and increments are from the given shaft angles phi (n,). ContactError where a roller meets nothing.
        """
        chain, _ = contour.as_arcs()
        obstacle, steps = dilated(chain, self.radius), with_steps(phi)
        passing = [passing_angles(obstacle, self._arm(side)) for side in (TRAILING, LEADING)]
        # psi = alpha' - lean with roller A in contact, lean - alpha' with B, alpha' = pi - alpha
        straight = np.pi - self.transmission.alpha
        held = [
            held_on(obstacle, self._arm(side), looked, straight, side)
            for side, looked in ((TRAILING, np.concatenate([steps, *passing])), (LEADING, steps))
        ]
        psi = np.stack([self._psi(one.position[: len(steps)], one.sense) for one in held])
        errors = psi - self.intended(steps)
        worst, remainder = settled(held, self._law, errors, few=len(obstacle) <= MOST_PIECES)
        dwells = dwell_angles(self.transmission, phi)
        flatness = [float(np.ptp(self._contact(obstacle, angle), axis=1).max()) for angle in dwells]
        motion = motion_error(worst, errors, max(flatness, default=None), "deg", remainder=remainder)
        # the increments tell nothing new of the gap
        chosen = np.r_[: len(phi), len(steps) : len(steps) + sum(map(len, passing))]
        angle = held[0].phi[chosen]
        second = self._arm(LEADING).centre(angle, straight + self._psi(held[0].position[chosen], TRAILING))
        gap = signed_distance(chain, second) - self.radius
        least, most = int(np.argmin(gap)), int(np.argmax(gap))
        at_least, at_most = degrees(angle[least]), degrees(angle[most])
        return Judged(motion, Play(float(gap[least]), at_least, float(gap[most]), at_most, "mm", "sampled"))

    @cached_property
    def _law(self) -> BySwing:
        return BySwing(self.transmission)

    def motion_limit(self, tolerance: float) -> float:
        """Greatest error, degrees, of a contour within `tolerance` of the exact one.

        That is e/cos(pressure angle) over the arm, the largest over the turn and of both rollers, and the term of
        second order.
        """
        return float(np.degrees(max(swing.max() for swing, _, _ in self._leeway(tolerance))))

    def play_limit(self, tolerance: float) -> float:
        """Greatest gap or interference at B, mm: e there, and how far the swing from e at A moves B on the cam."""
        (swing, _, _), (_, slope, bend) = self._leeway(tolerance)
        return float((tolerance + slope * swing + 0.5 * bend * swing**2).max())

    def _leeway(self, tolerance: float) -> list[tuple[Array, Array, Array]]:
        """For rollers A and B, over the turn: the swing `tolerance` allows, and how fast a swing moves them off."""
        tau = grid(self.transmission.breaks)
        phi, psi = self.transmission.at(tau, 2)
        apart = np.zeros_like(phi)
        apart[0] = self.transmission.alpha
        found = []
        for side in (TRAILING, LEADING):
            centre = polar_rows(phi, self.transmission.arm)
            arm = polar_rows(phi + side * apart - psi, self.transmission.arm)
            first, second, third = (c + a for c, a in zip(centre, arm, strict=True))
            found.append(leeway((first, second, third), left(arm[0]), -arm[0], tolerance))
        return found


@dataclass(frozen=True, eq=False)
class GuidedPitch:
    """Pitch curve of a guided roller whose position is a law over the shaft angle."""

    guide: Guide
    law: Piecewise

    @property
    def breaks(self) -> Array:
        """Shaft angles where the second derivative may jump."""
        return self.law.breaks

    def points(self, tau: Array) -> tuple[Array, Array, Array]:
        """Centre and two derivatives by the shaft angle, each (n, 2)."""
        phi = np.stack([tau, np.ones_like(tau), np.zeros_like(tau)])
        return self.guide.path(phi, self.law.derivatives(tau, 2))


@dataclass(frozen=True, eq=False)
class ByLaw:
    """`kin.follower.tracking.Law`: a position that is a law over the shaft angle."""

    law: Piecewise

    def rows(self, phi: Array) -> Array:
        """Position and two derivatives at shaft angles phi (n,): (3, n)."""
        return self.law.derivatives(phi, 2)

    @cached_property
    def _steepness(self) -> Steepness:
        return steepness_of_law(self.law)

    def steepest(self, low: Array, high: Array) -> Array:
        """Bounds of three derivatives over shaft angles from low to high, each (n,): (3, n)."""
        return self._steepness.over(low, high)


@dataclass(frozen=True, eq=False)
class BySwing:
    """`kin.follower.tracking.Law`: the swing psi over the shaft angle."""

    transmission: Transmission

    def rows(self, phi: Array) -> Array:
        """Swing and two derivatives at shaft angles phi (n,): (3, n)."""
        tau, side = self._parameter.at(phi)
        shaft, psi = self.transmission.jets(Jet.variable(tau, 3), side)
        p = [psi.c[0]]
        for order in (2, 1, 0):
            psi = psi.derivative() / Jet(shaft.derivative().c[: order + 1])
            p.append(psi.c[0])
        h = np.mod(phi - shaft.c[0] + np.pi, TURN) - np.pi  # tau is near enough for a step of third order
        rows = np.stack([p[0] + h * (p[1] + 0.5 * h * p[2]), p[1] + h * (p[2] + 0.5 * h * p[3]), p[2] + h * p[3]])
        far = np.abs(h) > NEAR
        if far.any():
            rows[:, far] = self.transmission.psi_of_shaft(phi[far], 2)
        return rows

    @cached_property
    def _parameter(self) -> ParameterTable:
        return ParameterTable.of(self.transmission)

    @cached_property
    def _steepness(self) -> Steepness:
        return steepness_of_transmission(self.transmission)

    def steepest(self, low: Array, high: Array) -> Array:
        """Bounds of three derivatives over shaft angles from low to high, each (n,): (3, n)."""
        return self._steepness.over(low, high)


def held_on(obstacle: Arcs, guide: Guide, looked: Array, offset: float = 0.0, sense: int = 1) -> Held:
    """Hold a roller at shaft angles `looked` (n,) first, and where pieces end if they are few. ContactError if loose.

    It is meant to be at offset + sense * law.
    """
    pieces, phi = obstacle, looked
    if len(obstacle) <= MOST_PIECES:
        pieces, _ = shortened(obstacle, guide)
        phi = np.concatenate([looked, end_angles(pieces, guide, looked)])
    return Held(pieces, guide, phi, *_touched(pieces, guide, phi), offset, sense)


def settled(held: Sequence[Held], law: Law, sampled: Array, few: bool) -> tuple[tuple[float, float], float | None]:
    """Greatest absolute error of rollers held in contact, and its shaft angle; and by how much it may be exceeded.

    `sampled` are the errors (k, n) at the first n angles of each. That is all that is known where pieces are not few;
    where they are and no proof is found, all angles are looked at: None then.
    """
    found = Greatest(*greatest(np.abs(sampled).max(axis=0), held[0].phi[: sampled.shape[1]]), 0.0)
    if few:
        try:
            found = greatest_error(held, law, found)
        except UnsettledError:
            looked = np.concatenate([one.phi for one in held] + [passing_angles(one.pieces, one.guide) for one in held])
            every = [
                Held(one.pieces, one.guide, looked, *_touched(one.pieces, one.guide, looked), one.offset, one.sense)
                for one in held
            ]
            found = Greatest(*max(greatest(one.errors(law), one.phi) for one in every), 0.0)
        else:
            return (found.error, found.at), found.remainder
    return (found.error, found.at), None


def _touched(obstacle: Arcs, guide: Guide, phi: Array) -> tuple[Array, Indices]:
    """Distance from the shaft of a roller held in contact, and the piece it meets, at shaft angles phi (n,)."""
    r, piece = first_contact(obstacle, guide, phi)
    if (piece < 0).any():
        raise ContactError("the roller does not touch the contour", float(phi[int(np.argmin(piece))]))
    return r, piece


def held_position(obstacle: Arcs, guide: Guide, phi: Array) -> Array:
    """Position of a roller held in contact, mm or radians (n,). ContactError where it meets nothing."""
    return guide.position(_touched(obstacle, guide, phi)[0])


def end_angles(pieces: Arcs, guide: Guide, known: Array) -> Array:
    """Shaft angles at which the roller's centre comes to an end of a piece, each once, without those known (n,)."""
    angle = guide.shaft_angle(np.concatenate([pieces.start, pieces.ends]))
    angle = np.concatenate([np.mod(known, TURN), np.mod(angle[np.isfinite(angle)], TURN)])
    order = np.argsort(angle, kind="stable")
    new = np.diff(angle[order], prepend=-1.0) > ONE_ANGLE
    first = np.flatnonzero(new)
    # the known ones stand first in the original order, and so does the least number of each group
    least = np.minimum.reduceat(order, first) if len(first) else order
    found: Array = angle[least[least >= len(known)]]
    return found


def passing_angles(obstacle: Arcs, guide: Guide) -> Array:
    """Shaft angles at which the roller's centre comes to the start and to the middle of each piece, if they are few."""
    if len(obstacle) > MOST_PIECES:
        return np.empty(0)
    points = np.concatenate([obstacle.start, obstacle.points(0.5 * obstacle.length)])
    angle = guide.shaft_angle(points)
    return np.mod(angle[np.isfinite(angle)], TURN)


def greatest(error: Array, phi: Array) -> tuple[float, float]:
    """Greatest absolute error (n,), and its shaft angle."""
    i = int(np.argmax(np.abs(error)))
    return float(abs(error[i])), float(phi[i])


def leeway(
    pitch: tuple[Array, Array, Array], across: Array, inward: Array, tolerance: float
) -> tuple[Array, Array, Array]:
    """How far a roller may move before it leaves a pitch curve by `tolerance`, to second order: radians or mm (n,).

    `pitch` is the pitch point and its derivatives, `across` and `inward` how the centre moves with its position, to
    first and second order, (n, 2) each. Also first and second derivative of the distance from the pitch curve by the
    position, absolute (n,): the first of an arm is l cos(pressure angle).
    """
    _, first, second = pitch
    speed = np.hypot(first[:, 0], first[:, 1])
    tangent = first / speed[:, None]
    outward = right(tangent)
    bend = cross(first, second) / speed**3
    slope = np.abs(dot(across, outward))
    if (slope <= 0.0).any():
        raise ContactError("the roller moves along the cam, at a pressure angle of 90 degrees,", float("nan"))
    sag = np.abs(bend * dot(across, tangent) ** 2 + dot(inward, outward))
    swing = tolerance / slope
    return swing + 0.5 * sag / slope * swing**2, slope, sag
