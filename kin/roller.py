"""Roller followers on a swinging arm: a single roller, and two rollers on rigid arms that hold the cam from two sides.

Positions are swings in radians, error figures in degrees. Contact is sampled: at the given shaft angles and, unless the
contour has more pieces than MOST_PIECES, also where the roller passes from piece to piece and midway along each.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, ClassVar

import numpy as np

from kin.arcs import Arcs, cross, dot, left, right, unit
from kin.check import degrees
from kin.contact import LEADING, TRAILING, Arm, dilated, first_contact
from kin.envelope import RollerEnvelope, TransmissionPitch
from kin.flat import dwell_angles
from kin.foot import grid
from kin.motion import TURN, ContactError, Judged, Play, Unit, motion_error, with_steps
from kin.nearest import signed_distance

if TYPE_CHECKING:
    from kin.arcs import Array
    from kin.contact import Side
    from kin.contour import Contour
    from kin.piecewise import Piecewise
    from kin.transmission import Transmission

MOST_PIECES = 20_000  # beyond, the error repeats itself many times between neighbouring shaft angles


@dataclass(frozen=True, eq=False)
class Roller:
    """A roller of `radius` on an arm whose pivot stands at polar angle phi of the cam frame, `pivot_distance` away, mm.

    Its position is the arm's lean, the angle at the pivot between shaft and roller, which grows as the roller is
    lifted: `law` gives it in radians over the shaft angle. The roller trails the pivot.
    """

    arm: float
    pivot_distance: float
    radius: float
    law: Piecewise
    unit: ClassVar[Unit] = "deg"

    def intended(self, phi: Array) -> Array:
        """Intended lean at shaft angles phi (n,), radians (n,)."""
        lean: Array = self.law.derivatives(phi, 0)[0]
        return lean

    def contact(self, contour: Contour, phi: Array) -> Array:
        """Lean with the roller in contact, radians (n,). ContactError where it meets nothing."""
        return held_lean(dilated(contour.as_arcs()[0], self.radius), self._arm, phi)

    @property
    def _arm(self) -> Arm:
        return Arm(self.arm, self.pivot_distance, TRAILING)

    @cached_property
    def envelope(self) -> RollerEnvelope:
        """The exact contour; its parameter is the shaft angle."""
        return RollerEnvelope(LeanPitch(self._arm, self.law), self.radius)

    def shaft_angle(self, parameter: Array) -> Array:
        """Shaft angle at which the envelope's point of that parameter is touched (n,)."""
        return parameter

    def judge(self, contour: Contour, phi: Array) -> Judged:
        """Motion error; rms and increments from the given shaft angles phi (n,). ContactError where nothing is met."""
        obstacle = dilated(contour.as_arcs()[0], self.radius)
        every = np.concatenate([with_steps(phi), passing_angles(obstacle, self._arm)])
        error = held_lean(obstacle, self._arm, every) - self.intended(every)
        return Judged(motion_error(greatest(error, every), error[: 2 * len(phi)], None, "deg"), None)

    def motion_limit(self, tolerance: float) -> float:
        """Greatest error, degrees, of a contour within `tolerance` of the exact one.

        That is e/cos(pressure angle) over the arm, the largest over the turn, and the term of second order.
        """
        pitch = self.envelope.pitch
        tau = grid(pitch.breaks)
        return float(np.degrees(leeway(*pitch.points(tau), self.pivot_distance * unit(tau), tolerance)[0].max()))


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
        a = np.pi - held_lean(obstacle, self._arm(TRAILING), phi) - self.transmission.alpha
        b = held_lean(obstacle, self._arm(LEADING), phi) - np.pi + self.transmission.alpha
        return np.stack([a, b])

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
        obstacle = dilated(chain, self.radius)
        passing = [passing_angles(obstacle, self._arm(side)) for side in (TRAILING, LEADING)]
        every = np.concatenate([with_steps(phi), *passing])
        psi = self._contact(obstacle, every)
        error = psi - self.intended(every)
        worst = greatest(np.abs(error).max(axis=0), every)
        dwells = dwell_angles(self.transmission, phi)
        flatness = [float(np.ptp(self._contact(obstacle, angle), axis=1).max()) for angle in dwells]
        motion = motion_error(worst, error[:, : 2 * len(phi)], max(flatness, default=None), "deg")
        chosen = np.r_[: len(phi), 2 * len(phi) : len(every)]  # the increments tell nothing new of the gap
        angle = every[chosen]
        second = self._arm(LEADING).centre(angle, np.pi - self.transmission.alpha + psi[0, chosen])
        gap = signed_distance(chain, second) - self.radius
        least, most = int(np.argmin(gap)), int(np.argmax(gap))
        play = Play(float(gap[least]), degrees(angle[least]), float(gap[most]), degrees(angle[most]), "mm")
        return Judged(motion, play)

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
        pivot = self.transmission.arm * unit(phi[0])
        apart = np.zeros_like(phi)
        apart[0] = self.transmission.alpha
        found = []
        for side in (TRAILING, LEADING):
            centre = polar_rows(phi, self.transmission.arm)
            arm = polar_rows(phi + side * apart - psi, self.transmission.arm)
            points = [c + a for c, a in zip(centre, arm, strict=True)]
            found.append(leeway(points[0], points[1], points[2], pivot, tolerance))
        return found


@dataclass(frozen=True, eq=False)
class LeanPitch:
    """Pitch curve of a roller whose arm leans as a law over the shaft angle says."""

    arm: Arm
    law: Piecewise

    @property
    def breaks(self) -> Array:
        """Shaft angles where the second derivative may jump."""
        return self.law.breaks

    def points(self, tau: Array) -> tuple[Array, Array, Array]:
        """Centre and two derivatives by the shaft angle, each (n, 2)."""
        phi = np.stack([tau, np.ones_like(tau), np.zeros_like(tau)])
        pivot = polar_rows(phi, self.arm.pivot)
        arm = polar_rows(phi - self.arm.side * self.law.derivatives(tau, 2), -self.arm.length)
        first, second, third = (p + a for p, a in zip(pivot, arm, strict=True))
        return first, second, third


def polar_rows(angle: Array, length: float) -> tuple[Array, Array, Array]:
    """Give length u(angle) and two derivatives, each (n, 2), from the angle's own, (3, n)."""
    u = length * unit(angle[0])
    n = left(u)
    return u, angle[1][:, None] * n, angle[2][:, None] * n - (angle[1] ** 2)[:, None] * u


def held_lean(obstacle: Arcs, arm: Arm, phi: Array) -> Array:
    """Lean of an arm whose roller is held in contact, radians (n,). ContactError where it meets nothing."""
    r, piece = first_contact(obstacle, arm, phi)
    if (piece < 0).any():
        raise ContactError("the roller meets nothing", float(phi[int(np.argmin(piece))]))
    return arm.lean(r)


def passing_angles(obstacle: Arcs, arm: Arm) -> Array:
    """Shaft angles at which the roller's centre comes to the start and to the middle of each piece, if they are few."""
    if len(obstacle) > MOST_PIECES:
        return np.empty(0)
    points = np.concatenate([obstacle.start, obstacle.points(0.5 * obstacle.length)])
    angle = arm.shaft_angle(points)
    return np.mod(angle[np.isfinite(angle)], TURN)


def greatest(error: Array, phi: Array) -> tuple[float, float]:
    """Greatest absolute error (n,), and its shaft angle."""
    i = int(np.argmax(np.abs(error)))
    return float(abs(error[i])), float(phi[i])


def leeway(centre: Array, first: Array, second: Array, pivot: Array, tolerance: float) -> tuple[Array, Array, Array]:
    """How far an arm may swing before its roller leaves a pitch curve by `tolerance`, to second order: radians (n,).

    `centre`, `first`, `second` (n, 2) are the pitch point and its derivatives, `pivot` (n, 2). Also first and second
    derivative of the distance from the pitch curve by the swing, absolute, mm (n,): the first is l cos(pressure angle).
    """
    speed = np.hypot(first[:, 0], first[:, 1])
    tangent = first / speed[:, None]
    outward = right(tangent)
    bend = cross(first, second) / speed**3
    arm = centre - pivot
    slope = np.abs(dot(left(arm), outward))
    if (slope <= 0.0).any():
        raise ContactError("the roller moves along the cam, at a pressure angle of 90 degrees,", float("nan"))
    sag = np.abs(bend * dot(left(arm), tangent) ** 2 - dot(arm, outward))
    swing = tolerance / slope
    return swing + 0.5 * sag / slope * swing**2, slope, sag
