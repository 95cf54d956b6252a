"""Reuleaux polygons with unequal arcs: the star of their equal diagonals, by the angles at its points.

A closed star of n diagonals of one length w, n odd, encloses with the arcs about its points a body of constant breadth
w. Over half a turn the cam turns about one point after the other, about the i-th by an angle b_i: two parallel faces
touch that point and the arc about it. With s_i the direction of the diagonal before the i-th point,

    s_(i+1) = s_i + b_i,    C_i = C_(i-1) + (-1)^i w u(s_i),    sum of b_i = pi,    sum of (-1)^i u(s_i) = 0.

So n - 3 of the angles are free. The last two directions are unit vectors of a given difference D: the legs of an
isosceles triangle on D, of which one order lets the directions rise. The body's area is that of the straight polygon
and of n segments; its perimeter is pi w (Barbier 1860). The mean of its points over all directions, Steiner's point, is
the mean of the corners weighted with their angles: the arcs' own share is w/pi times the closing sum, 0.
"""

from __future__ import annotations

import cmath
import math
from typing import TYPE_CHECKING

from kin.law.normalised import IntentError

if TYPE_CHECKING:
    from collections.abc import Sequence

FREE = 3  # number of angles that follow from the others
LEAST = math.radians(0.1)  # of an angle: on a cam of 50 mm an arc of 0.09 mm
_HALVINGS = 50  # of the way to the regular polygon
_DIGITS = 3  # after the point, degrees, of angles that an error suggests
_ROOM = 1e-9  # least size of the gap that two diagonals close: below, its direction is rounding


def closed_angles(sides: int, chosen: Sequence[float]) -> tuple[float, ...]:
    """All angles of a star of odd `sides`, rad, in the order of its points; `chosen` are the first `sides` - 3.

    Raises IntentError for another number of angles, and where no star has them; it then names angles of a star on the
    way to the regular one.
    """
    if len(chosen) != sides - FREE:
        raise IntentError(
            f"{sides} sides take {sides - FREE} angles, the last three of them follow; here are {len(chosen)}",
            "reuleaux.angles",
        )
    corrected = _last_three(chosen)
    if min(*chosen, *corrected, math.inf) >= LEAST:
        return (*chosen, *corrected)
    # the error names angles as far from equal ones, towards the chosen, as a star allows
    equal = math.pi / sides
    low, high = 0.0, 1.0
    for _ in range(_HALVINGS):
        share = 0.5 * (low + high)
        tried = [equal + share * (angle - equal) for angle in chosen]
        low, high = (share, high) if min(*tried, *_last_three(tried)) >= LEAST else (low, share)
    near = [round(math.degrees(equal + low * 0.99 * (angle - equal)), _DIGITS) for angle in chosen]
    total = math.degrees(sum(chosen))
    why = (
        f"they add up to {total:.6g} degrees, and all {sides} to 180"
        if sum(chosen) >= math.pi - FREE * LEAST
        else "three arcs more do not close it"
    )
    raise IntentError(
        f"no Reuleaux polygon of {sides} sides has these angles: {why}; "
        f"[{', '.join(f'{angle:.6g}' for angle in near)}] would do",
        "reuleaux.angles",
    )


def _last_three(chosen: Sequence[float]) -> tuple[float, float, float]:
    """The three angles that close the star, rad; some are not above 0 where no star has the chosen ones."""
    direction, total = 0.0, 1.0 + 0.0j
    for i, angle in enumerate(chosen, 1):
        direction += angle
        total += (-1) ** i * cmath.rect(1.0, direction)
    apart, size = -total, abs(total)
    if not _ROOM < size < 2.0:
        return (-1.0, -1.0, -1.0)
    # two unit diagonals v - u = `apart` close the star; their mean, `height`, is at right angles to it
    height = -1j * apart / size * math.sqrt(1.0 - 0.25 * size * size)
    first = cmath.phase((height - 0.5 * apart) * cmath.rect(1.0, -direction))
    second = cmath.phase((height + 0.5 * apart) / (height - 0.5 * apart))
    return first, second, math.pi - direction - first - second


def corners(angles: Sequence[float]) -> list[complex]:
    """Points of a closed star in their order, as x + i y from its Steiner point, its diagonals of length 1.

    `angles` (n,), rad, are those at the points. The directions over which the first point is in contact lie evenly
    about +x.
    """
    direction, place = -0.5 * angles[0], 0.0 + 0.0j
    places = [place]
    for i, angle in enumerate(angles[:-1], 1):
        direction += angle
        place += (-1) ** i * cmath.rect(1.0, direction)
        places.append(place)
    mean = sum(angle * corner for angle, corner in zip(angles, places, strict=True)) / math.pi
    return [corner - mean for corner in places]
