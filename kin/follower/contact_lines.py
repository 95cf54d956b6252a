"""The line along which each contact's force acts, over the shaft angle, and the levers that it has.

In the axes of the contact's own guide, which runs round the standing cam by the shaft angle phi: a line of travel along
x at y = offset, or a pivot at (distance, 0). A point r of the cam there moves by (y, -x) per radian of phi. The centre
c of a round touch moves over the cam by w = c' + (-c_y, c_x); the contact's normal stands at right angles to it. A flat
face is the tangent at p n + (dp/d omega) t of its support function p, whose normal n turns by omega.
With a lever h = d(gap)/d(own position) the virtual work of the normal force N on follower and cam is the same:
N h times the rate of the own position, which is N times the shaft's lever of the line.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from kin.law.contacts import Flat, Oscillating, Roller
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from kin.law.contacts import Contact, Guide, Side, Touch
    from kin.numeric.arrays import Array


@dataclass(frozen=True, eq=False)
class ContactLine:
    """The line along which the normal force of a contact acts, at n shaft angles, in the axes of the contact's guide.

    normal  unit vector from the shaft's side to the follower's, (n, 2)
    centre  a point on the line: the centre of a round touch, the point of contact of a face, mm (n, 2)
    lever   growth of the gap with the own position, (n,): mm per mm, or mm per rad about a pivot
    shaft   lever of the line about the shaft, mm (n,), above 0 where the cam drives the follower outwards
    bent    radius of curvature of the path of `centre` on the cam, mm (n,), above 0 where the path is convex
    speed   speed of `centre` along that path, mm per rad of shaft (n,)
    turn    turn of the arm, or of the face's normal, against the cam, rad per rad of shaft (n,): 1 on a line of travel
    """

    normal: Array
    centre: Array
    lever: Array
    shaft: Array
    bent: Array
    speed: Array
    turn: Array


def contact_line(contact: Contact[Guide, Touch], follower: Array) -> ContactLine:
    """The force's line of a contact; `follower` (3, n) is the follower's position, mm or rad, and two derivatives.

    The derivatives are by the shaft angle. Raises ValueError for a round touch on an arm without a length.
    """
    own = contact.sense * np.asarray(follower, dtype=np.float64)[:3]
    own[0] += contact.zero
    if isinstance(contact.touch, Flat):
        return _of_face(contact.guide, contact.touch, own)
    return _of_centre(contact.guide, own)


def roller_turns(line: ContactLine, touch: Touch, side: Side) -> Array | None:
    """Turns of a roller about its pin per turn of the shaft (n,), above 0 against the shaft's sense.

    The metal lies inside the contour (side 1) or outside (-1). None for a touch that is no roller.
    """
    if not isinstance(touch, Roller):
        return None
    turns: Array = side * line.speed / touch.radius - line.turn
    return turns


def _of_centre(guide: Guide, own: Array) -> ContactLine:
    """Line through the centre of a round touch; `own` (3, n) is its own position with two derivatives."""
    u, speed, bend = own
    if isinstance(guide, Oscillating):
        length, side = guide.arm, float(guide.side)
        sin, cos = length * np.sin(u), length * np.cos(u)
        centre = np.array([guide.pivot - cos, -side * sin])
        along, curve = np.array([sin, -side * cos]), np.array([cos, side * sin])  # d centre/du, and again
        turn = 1.0 + side * speed
    else:
        centre = np.array([u, np.full_like(u, guide.offset)])
        along, curve = np.array([np.ones_like(u), np.zeros_like(u)]), np.zeros((2, len(u)))
        turn = np.ones_like(u)
    # the centre moves over the cam by w = c' + M c, M the quarter turn anticlockwise
    way = along * speed + _across(centre)
    bending = along * bend + curve * speed**2 + _across(along * speed)
    size = np.hypot(*way)
    # the normal stands across w; as w changes on the cam by w' + M w, the curvature is (w x w' + w^2)/|w|^3
    normal = -_across(way) / size
    curvature = (_cross(way, bending) + size**2) / size**3
    with np.errstate(divide="ignore"):
        bent = 1.0 / curvature
    lever = np.sum(normal * along, axis=0)
    return ContactLine(normal.T, centre.T, lever, -_cross(centre, normal), bent, size, turn)


def _of_face(guide: Guide, touch: Flat, own: Array) -> ContactLine:
    """Line of a flat face; `own` (3, n) is its own position with two derivatives by the shaft angle."""
    u, speed, bend = own
    if isinstance(guide, Oscillating):
        # the support function is p = a sin u - nearer, its normal turns by omega' = 1 + side u'
        side, a = float(guide.side), guide.pivot
        normal = np.array([np.sin(u), -side * np.cos(u)])
        p, turning = a * np.sin(u) - touch.nearer, 1.0 + side * speed
        slope = a * np.cos(u) * speed / turning
        # derivative by the shaft angle of slope = dp/d omega
        rate = a * (np.cos(u) * bend - np.sin(u) * speed**2) / turning - slope * side * bend / turning
        centre = p * normal + slope * _across(normal)
        lever = np.sum((centre - np.array([[a], [0.0]])) * -np.array([np.cos(u), side * np.sin(u)]), axis=0)
        bent = p + rate / turning
        return ContactLine(normal.T, centre.T, lever, -_cross(centre, normal), bent, np.abs(bent * turning), turning)
    # on a line of travel p = u cos(tilt) + offset sin(tilt), and omega' = 1
    cos, sin = math.cos(touch.tilt), math.sin(touch.tilt)
    normal = np.array([np.full_like(u, cos), np.full_like(u, sin)])
    p = cos * u + sin * guide.offset
    centre = p * normal + cos * speed * _across(normal)
    bent = p + cos * bend
    return ContactLine(
        normal.T, centre.T, np.full_like(u, cos), -_cross(centre, normal), bent, np.abs(bent), np.ones_like(u)
    )


def _across(vector: Array) -> Array:
    """Vectors (2, n) turned a quarter anticlockwise."""
    return np.array([-vector[1], vector[0]])


def _cross(first: Array, second: Array) -> Array:
    product: Array = first[0] * second[1] - first[1] * second[0]
    return product
