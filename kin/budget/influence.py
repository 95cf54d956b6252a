"""How far a follower moves where a dimension of what it runs on is off, the metal of the cam staying as it is.

At one shaft angle a contact is where the touch bears on the metal. Displace the metal there by v, let it grow by e
along its normal, or displace the touch by u: to first order the follower moves by dS with

    K dS = e + N.(v - u),      K = N.(d touch / dS),

N the normal out of the metal, all in the axes of the standing cam (plane as complex numbers, x.y = Re(conj(x) y)). So
every influence is one projection on N, over K. Of round touches N stands across the path of the centre, of flat faces
it is that of the face: a contact's record and the follower's motion are all that is needed, no contour.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from kin.law.contacts import Flat, Oscillating
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from kin.law.contacts import Contact, Guide, Side, Touch
    from kin.numeric.arrays import Array, Complexes

ACROSS = 0.5 * math.pi


@dataclass(frozen=True, eq=False)
class Bearing:
    """Where one contact bears at n shaft angles; complex numbers (n,) in the axes of the cam as it is drawn, mm.

    `point` is where it touches; `normal`, `axis` and `arm` are unit vectors: the normal out of the metal, the x axis of
    the contact's guide, and the direction from an arm's pivot to its touch, on a stem again the axis. `anchor` is the
    pivot of an arm, on a stem the point of its axis at the roller's centre or on the face. `gain` is K, mm along the
    normal per mm or rad of the follower, `sense` the contact's. `upper`: it bounds the follower's position from above.
    """

    point: Complexes
    normal: Complexes
    axis: Complexes
    arm: Complexes
    anchor: Complexes
    gain: Array
    sense: Side
    upper: bool

    @property
    def grown(self) -> Array:
        """Change (n,) of the position, mm or rad, per mm by which metal or touch grows along the normal: 1/K."""
        grown: Array = 1.0 / self.gain
        return grown

    def metal(self, displacement: Complexes | complex) -> Array:
        """Change (n,) of the follower's position, mm or rad, for displacements (n,) of the metal at the contact, mm."""
        change: Array = (np.conj(self.normal) * displacement).real / self.gain
        return change

    def touch(self, displacement: Complexes | complex) -> Array:
        """Change (n,) of the follower's position, mm or rad, for displacements (n,) of the touch at the contact, mm."""
        return -self.metal(displacement)

    def metal_turned(self) -> Array:
        """Change (n,) of the position, mm or rad, per rad of the metal's turn counter-clockwise about the shaft."""
        return self.metal(1j * self.point)

    def touch_turned(self, centre: Complexes) -> Array:
        """Change (n,) of the position, mm or rad, per rad of the touch's turn counter-clockwise about `centre` (n,)."""
        return self.touch(1j * (self.point - centre))


def bearing(contact: Contact[Guide, Touch], side: Side, shaft: Array, position: Array) -> Bearing:
    """Where a contact bears at `shaft` angles (n,), rad; `position` (2, n) is the follower's, with its derivative.

    The position, mm or rad, counts from the zero of the contacts, the derivative is by the shaft angle. The metal lies
    inside the contour (side 1) or outside (-1). Raises ValueError for a round touch on an arm without a length.
    """
    own, slope = contact.own(position[0]), contact.sense * position[1]
    axis = np.exp(1j * (shaft + contact.turned))
    guide, touch = contact.guide, contact.touch
    if isinstance(guide, Oscillating):
        hand = guide.side
        arm, anchor = -axis * np.exp(1j * hand * own), guide.pivot * axis
        rate = 1.0 + hand * slope  # at which the arm turns in the axes of the cam
        # the face is the tangent of the support function p = pivot sin(own) - nearer; a round touch stands off its path
        if isinstance(touch, Flat):
            normal = -arm * np.exp(-1j * hand * ACROSS)
            reach = guide.pivot * np.cos(own) * slope / rate
            point = normal * ((np.conj(normal) * anchor).real - touch.nearer + 1j * reach)
        else:
            centre = anchor + guide.arm * arm
            normal = _across(1j * (anchor + rate * guide.arm * arm), side)
            point = centre - touch.radius * normal
        way = 1j * hand * (point - anchor)
    else:
        arm, anchor, way = axis, axis * (own + 1j * guide.offset), axis
        if isinstance(touch, Flat):
            normal = axis * np.exp(1j * touch.tilt)
            point = normal * ((np.conj(normal) * anchor).real + 1j * slope * math.cos(touch.tilt))
        else:
            normal = _across(1j * anchor + slope * axis, side)
            point = anchor - touch.radius * normal
    gain = contact.sense * (np.conj(normal) * way).real
    return Bearing(point, normal, axis, arm, anchor, gain, contact.sense, upper=contact.sense * side < 0)


def _across(path: Complexes, side: Side) -> Complexes:
    """Normal out of the metal, across the velocity `path` of a round touch's centre round the standing cam."""
    normal: Complexes = -1j * side * path / np.abs(path)
    return normal
