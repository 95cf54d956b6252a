"""Position of a made follower on a made cam, by contact, for given errors of all sizes.

No influence coefficient is used here. The metal stays in its own axes, and its displacements are applied inversely to
the guide: the touch moves on a displaced line, or about a displaced pivot, until it meets the metal. The metal is
displaced against the bore, then turned with the cam on the shaft, then displaced with the shaft. All arrays are (parts,
angles), or broadcast to that. Points, displacements and directions are complex numbers, x + iy; lengths are mm, angles
rad.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Protocol

import numpy as np

from kin.law.contacts import Flat, Oscillating
from kin.numeric.angles import TURN
from kin.numeric.errors import CamgeoError
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from kin.law.contacts import Contact, Guide, Touch
    from kin.numeric.arrays import Array, Complexes


class LostError(CamgeoError, ValueError):
    """A made part that cannot be simulated: no contact or closed loop near the intended place, or no usable contour."""


class Metal(Protocol):
    """Metal of the cam that a follower's touch meets, at each shaft angle, in the cam's axes.

    All results are (parts, angles). `radius` is that of a round touch. The methods raise LostError where there is no
    contact near the intended place.
    """

    def reach(self, normal: Complexes) -> Array:
        """Distance from the shaft, mm, along its unit `normal`, of a flat face that touches: the support function."""

    def along(self, way: Complexes, middle: Complexes, radius: Array) -> Array:
        """Distance from `middle`, mm, along the unit direction `way` to the centre of a round touch on the metal."""

    def arm(self, pivot: Complexes, length: Array, radius: Array) -> Complexes:
        """Unit direction from a pivot to the centre of a round touch on the metal, at the end of an arm of `length`."""

    def face_normal(self, pivot: Complexes, nearer: Array) -> Complexes:
        """Outward unit normal of a flat face `nearer` mm nearer the shaft than its parallel through a pivot."""


@dataclass(frozen=True, eq=False)
class SizeErrors:
    """Errors of the sizes at one contact, made less intended, each (parts, 1), or (parts, n) at n shaft angles.

    `turned` is the turn of the metal on the shaft, `bore` the displacement of the metal in the cam's axes. `shaft` and
    `pivot` are displacements in the ground, x along the travel or from the shaft to the pivot. `grown` is the growth of
    touch and metal along the normal. `offset` is the error of the offset of the stem's line, `guide` its tilt about the
    middle of the guide. `face` is the tilt of a face about its crossing with the stem's axis or about the pivot, and of
    an arm about the pivot. `length` is the error of the arm's length, `datum` that of the position from which the
    contact's own counts.
    """

    turned: Array
    bore: Complexes
    shaft: Complexes
    pivot: Complexes
    grown: Array
    offset: Array
    guide: Array
    face: Array
    length: Array
    datum: Array


@dataclass(frozen=True, eq=False)
class ContactPlace:
    """A contact on its metal at shaft angles (n,), and its intended position `own` (n,) on its guide, mm or rad.

    `first` (n,) is the x axis of the follower's frame in the cam's axes, a unit direction. `eccentric` is the
    eccentricity of a stem, `middle` the distance of its guide's middle from the foot of the perpendicular from the
    shaft on the line of travel.
    """

    contact: Contact[Guide, Touch]
    metal: Metal
    shaft: Array
    own: Array
    first: Complexes
    eccentric: float
    middle: float


def positions(place: ContactPlace, off: SizeErrors) -> Array:
    """Positions of the follower by one contact, from its own zero, mm or rad, (parts, angles).

    Raises LostError where the made metal has no contact near the intended place.
    """
    contact = place.contact
    axis = np.exp(1j * (place.shaft + contact.turned))
    back = np.exp(-1j * off.turned)

    def within(point: Complexes) -> Complexes:
        """A point of the ground in the axes of the displaced metal."""
        inside: Complexes = back * (point - off.shaft * place.first) - off.bore
        return inside

    if isinstance(contact.guide, Oscillating):
        pivot = within(axis * contact.guide.pivot + off.pivot * place.first)
        own = _own_on_arm(place, contact.guide, off, pivot, axis * back)
    else:
        middle = place.first * (place.middle + 1j * (place.eccentric + off.offset))
        # from the foot of the perpendicular to the intended middle, along this contact's line
        ahead = (np.conj(axis) * place.first * (place.middle + 1j * place.eccentric)).real
        own = ahead + _own_on_stem(place, off, within(middle), axis * back * np.exp(1j * off.guide))
    return contact.position(own - off.datum)


def _own_on_stem(place: ContactPlace, off: SizeErrors, middle: Complexes, way: Complexes) -> Array:
    """Distance, mm, along a stem's line from the middle of its guide at which the touch meets the metal."""
    touch = place.contact.touch
    if isinstance(touch, Flat):
        normal = way * np.exp(1j * (touch.tilt + off.face))
        gap = place.metal.reach(normal) + off.grown - (np.conj(normal) * middle).real
        along: Array = gap / (np.conj(normal) * way).real
        return along
    return place.metal.along(way, middle, touch.radius + off.grown)


def _own_on_arm(place: ContactPlace, guide: Oscillating, off: SizeErrors, pivot: Complexes, axis: Complexes) -> Array:
    """Position of an arm, rad, at which its touch meets the metal: the solution nearest the intended position."""
    touch, hand = place.contact.touch, guide.side
    if isinstance(touch, Flat):
        normal = place.metal.face_normal(pivot, touch.nearer + off.grown)
        turn = hand * np.angle(normal * np.conj(axis)) + 0.5 * math.pi
    else:
        arm = place.metal.arm(pivot, guide.arm + off.length, touch.radius + off.grown)
        turn = hand * np.angle(-arm * np.conj(axis))
    # the turn nearest the intended position, which an angle fixes but for whole turns
    own: Array = place.own + np.remainder(turn - hand * off.face - place.own + math.pi, TURN) - math.pi
    return own
