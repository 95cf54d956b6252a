"""Intended motions and pitch curves of rollers, in the forms that bounds of errors and envelopes take."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from kin.contour.arcs import cross, dot, right
from kin.follower.motion_error import ContactError
from kin.follower.steepness import ParameterTable, Steepness, steepness_of_law, steepness_of_transmission
from kin.numeric.angles import TURN
from kin.numeric.jet import Jet, derivatives_by
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Callable

    from kin.follower.guide import Guide as Led
    from kin.law.contacts import Contact, Guide, Touch
    from kin.law.piecewise import Piecewise
    from kin.law.transmission import Transmission
    from kin.numeric.arrays import Array

NEAR = 1e-7  # rad; up to here a step of third order is good to rounding


def own_rows(contact: Contact[Any, Any], rows: Array) -> Array:
    """Own position of a contact and its derivatives (m, n), mm or rad, from the follower's `rows` (m, n)."""
    own: Array = contact.sense * rows
    own[0] += contact.zero
    return own


@dataclass(frozen=True, eq=False)
class GuidedPitch:
    """Pitch curve of a guided roller, one contact of a follower, over the parameter of its motion.

    `over` gives shaft angle and position of the follower, mm or radians, with two derivatives by the parameter,
    (3, n) each; at `breaks` the second may jump.
    """

    contact: Contact[Guide, Touch]
    guide: Led
    breaks: Array
    over: Callable[[Array], tuple[Array, Array]]

    def _own(self, tau: Array) -> tuple[Array, Array]:
        """Rows of the angle at which the guide stands, and of the contact's own position, (3, n) each."""
        phi, position = self.over(tau)
        own = own_rows(self.contact, position)
        if self.contact.turned:
            phi = np.stack([phi[0] + self.contact.turned, *phi[1:]])
        return phi, own

    def points(self, tau: Array) -> tuple[Array, Array, Array]:
        """Roller centre, mm, and two derivatives by the parameter tau (n,), each (n, 2)."""
        return self.guide.path(*self._own(tau))

    def rates(self, tau: Array) -> tuple[Array, Array]:
        """Absolute first and second derivative of the distance from the pitch curve, mm, by the position: (n,) each.

        They are taken at parameters tau (n,). The first of an arm is l cos(pressure angle). Raises ContactError for a
        pressure angle of 90 degrees.
        """
        phi, own = self._own(tau)
        _, first, second = self.guide.path(phi, own)
        across, inward = self.guide.along(phi[0], own[0])
        speed = np.hypot(first[:, 0], first[:, 1])
        tangent = first / speed[:, None]
        outward = right(tangent)
        bend = cross(first, second) / speed**3
        slope = np.abs(dot(across, outward))
        if (slope <= 0.0).any():
            raise ContactError("the roller moves along the cam, at a pressure angle of 90 degrees,", float("nan"))
        return slope, np.abs(bend * dot(across, tangent) ** 2 + dot(inward, outward))


def leeway(slope: Array, sag: Array, tolerance: float) -> Array:
    """Greatest travel (n,), rad or mm, at which a roller is `tolerance`, mm, off the pitch curve, to second order.

    `slope` and `sag` (n,) are the absolute first and second derivative of the distance from the pitch curve, mm, by the
    position: slope x - sag x^2/2 = tolerance, as the second order takes from the distance on one side.
    """
    swing = tolerance / slope
    leeway: Array = swing + 0.5 * sag / slope * swing**2
    return leeway


@dataclass(frozen=True, eq=False)
class ByLaw:
    """A position that is a law over the shaft angle, as a `kin.follower.tracking.IntendedLaw`."""

    law: Piecewise

    def rows(self, phi: Array) -> Array:
        """Position, mm or rad, and two derivatives by the shaft angle, (3, n), at shaft angles phi (n,)."""
        return self.law.derivatives(phi, 2)

    @cached_property
    def _steepness(self) -> Steepness:
        return steepness_of_law(self.law)

    def steepest(self, low: Array, high: Array) -> Array:
        """Bounds of the magnitudes of three derivatives over shaft angles from low to high, rad, each (n,): (3, n)."""
        return self._steepness.over(low, high)


@dataclass(frozen=True, eq=False)
class Swing:
    """The swing of a double follower over the shaft angle, rad: `share` times psi."""

    transmission: Transmission
    share: float = 1.0

    @cached_property
    def breaks(self) -> Array:
        """Shaft angles, rad (m,), of the law's breaks."""
        phi: Array = self.transmission.at(self.transmission.breaks, 0)[0][0]
        return phi

    def derivatives(self, phi: Array, order: int, side: int = 1) -> Array:
        """Swing, rad, and derivatives by rad of shaft, (order + 1, n), at phi (n,), rad; at a break from `side`."""
        rows: Array = self.share * self.transmission.psi_of_shaft(phi, order, side)
        return rows

    def rows(self, phi: Array) -> Array:
        """Swing, rad, and two derivatives by rad of shaft, (3, n), at phi (n,), rad; at a break from either side."""
        tau, side = ParameterTable.of(self.transmission).at(phi)
        shaft, psi = self.transmission.jets(Jet.variable(tau, 3), side)
        p = [row.c[0] for row in derivatives_by(psi, shaft)]
        h = np.mod(phi - shaft.c[0] + np.pi, TURN) - np.pi  # tau is near enough for a step of third order
        rows = np.stack([p[0] + h * (p[1] + 0.5 * h * p[2]), p[1] + h * (p[2] + 0.5 * h * p[3]), p[2] + h * p[3]])
        far = np.abs(h) > NEAR
        if far.any():
            rows[:, far] = self.transmission.psi_of_shaft(phi[far], 2)
        swing: Array = self.share * rows
        return swing

    @cached_property
    def _steepness(self) -> Steepness:
        return steepness_of_transmission(self.transmission)

    def steepest(self, low: Array, high: Array) -> Array:
        """Bounds of the magnitudes of three derivatives over shaft angles from low to high, rad, each (n,): (3, n)."""
        return self.share * self._steepness.over(low, high)
