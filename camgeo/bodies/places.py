"""Exact places over the shaft angle of what turns, slides and swings by itself; linkages have `linked_places`."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from camgeo.bodies.assembly import Place
    from camgeo.bodies.body import Array
    from kin.lift import Lift
    from kin.transmission import Transmission


def turning(start: float = 0.0) -> Place:
    """Give the place of the cam and its shaft, clockwise from an angle."""

    def place(phi: Array, order: int) -> Array:
        found = np.zeros((3, order + 1, len(phi)))
        found[2, 0] = start - phi
        if order:
            found[2, 1] = -1.0
        return found

    return place


def sliding(lift: Lift) -> Place:
    """Give the place of a plate that slides along x: the face whose lift is told stands at its origin."""

    def place(phi: Array, order: int) -> Array:
        found = np.zeros((3, order + 1, len(phi)))
        found[0] = lift.derivatives(phi, order)
        return found

    return place


def swinging(law: Transmission, away: float, share: float = 1.0) -> Place:
    """Give the place of an arm about a pivot `away` from the shaft: turned clockwise by a share of psi."""

    def place(phi: Array, order: int) -> Array:
        found = np.zeros((3, order + 1, len(phi)))
        found[0, 0] = away
        found[2] = -share * law.psi_of_shaft(phi, order)
        return found

    return place
