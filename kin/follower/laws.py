"""Intended motions of rollers as their tracking and their envelope need them."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from kin.follower.steepness import ParameterTable, Steepness, steepness_of_law, steepness_of_transmission
from kin.numeric.angles import TURN
from kin.numeric.jet import Jet

if TYPE_CHECKING:
    from kin.follower.guide import Guide as Led
    from kin.law.contacts import Contact, Guide, Touch
    from kin.law.piecewise import Piecewise
    from kin.law.transmission import Transmission
    from kin.numeric.arrays import Array

NEAR = 1e-7  # rad; a step of third order is good to rounding


@dataclass(frozen=True, eq=False)
class GuidedPitch:
    """Pitch curve of a guided roller, one contact of a follower whose position is a law over the shaft angle."""

    contact: Contact[Guide, Touch]
    guide: Led
    law: Piecewise

    @property
    def breaks(self) -> Array:
        """Shaft angles where the second derivative may jump."""
        return self.law.breaks

    def points(self, tau: Array) -> tuple[Array, Array, Array]:
        """Centre and two derivatives by the shaft angle, each (n, 2)."""
        phi = np.stack([tau, np.ones_like(tau), np.zeros_like(tau)])
        own = self.contact.sense * self.law.derivatives(tau, 2)
        own[0] += self.contact.zero
        return self.guide.path(phi, own)


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
