"""Whether a stem jams in its guide, from the exact cam alone."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from camgeo.cams.flat_faced import spread
from camgeo.capabilities.dynamics.declared import JAM
from camgeo.capabilities.dynamics.keys import Dynamics
from camgeo.synthesis.checks import greatest
from kin.numeric.angles import degrees
from kin.numeric.check import Check

if TYPE_CHECKING:
    from collections.abc import Callable

    from camgeo.cams.family import ExactCam
    from camgeo.capabilities.dynamics.keys import StemGuide
    from camgeo.recipe.recipe import Recipe
    from kin.numeric.arrays import Array


def guide_checks(recipe: Recipe, exact: ExactCam) -> list[Check]:
    """Make the check that the stem does not jam in its guide, degrees, of a flat face mm; none without a guide."""
    train = recipe.of(Dynamics)
    if train is None or train.guide is None:
        return []
    aside = _aside(exact, train.guide)
    value, limit, at = aside or jam_angle(exact, train.guide)
    return [Check(JAM.name, value < limit, value, limit, "mm" if aside else "deg", at)]


def jam_angle(exact: ExactCam, guide: StemGuide) -> tuple[float, float, float]:
    """Greatest pressure angle on the rise, the angle at which the stem jams, and the shaft angle; all in degrees.

    The rise includes its begin, where an eccentric stem has the tangent |e|/foot. Of two contacts that nearer to
    jamming counts; the second stands beyond the shaft. Raises TypeError where no round follower is led on a stem.
    """
    first, angles = exact.follower.contacts[0], []
    surfaces = {surface.name: surface for surface in exact.surfaces}
    for contact in exact.follower.contacts:
        if (slope := surfaces[contact.surface].extremes("slope")) is not None:
            beyond = first.zero + contact.zero if contact.turned else 0.0
            steepest = max(slope[1].value + slope[1].slack, exact.follower.lean)
            # on a shared surface the second contact reaches the place of the first by an angle later
            later = 0.0 if contact.surface else contact.turned
            at = degrees(math.fmod(slope[1].at + later, 2.0 * math.pi))
            angles.append((math.degrees(math.atan(steepest)), math.degrees(guide.jam(beyond)), at))
    if not angles:
        raise TypeError("no stem is led in a guide")
    return max(angles, key=lambda angle: angle[0] - angle[1])


def _aside(exact: ExactCam, guide: StemGuide) -> tuple[float, float, float] | None:
    """Greatest distance of a pushing contact from the stem's axis, the distance at which it jams, and the shaft angle.

    mm and degrees, of a flat face without tilt; None for other touches. The contact is S' ahead of the shaft: on the
    rise that is the greatest S', or 0 where the rise begins. One of the faces of a yoke pushes wherever it moves.
    """
    proved = [along[1] for surface in exact.surfaces if (along := surface.extremes("contact")) is not None]
    place = exact.surfaces[0].place
    if not proved and place is not None:
        pushed: Callable[[Array], Array] = place if exact.follower.breadth is None else lambda t: np.abs(place(t))
        ((farthest, at),) = greatest(lambda t: pushed(t)[None], spread(exact.breaks, 2.0 * math.pi))
        return max(farthest, 0.0), guide.reach, exact.motion.shaft_deg(at)
    if not proved:
        return None
    most = max(proved, key=lambda bound: bound.value + bound.slack)
    return max(most.value + most.slack, abs(exact.follower.offset)), guide.reach, degrees(most.at)
