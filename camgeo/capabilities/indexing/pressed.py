"""Distance of the flank of the smaller roller from the half of a roller that has the other flank's radius.

Each flank has a roller of its own radius. A roller is taken in halves, parted by the plane through its axis and square
to its way: the half below has the lower flank's radius, the half above that of the upper flank. Where the track is
steep, the roller also passes the flank of the smaller radius with its other half. By positions alone, it is sampled
whether that half stays clear.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from camgeo.capabilities.indexing.forms import Pose
from camgeo.capabilities.indexing.tracks import track

if TYPE_CHECKING:
    from camgeo.capabilities.indexing.design import IndexDesign
    from camgeo.capabilities.indexing.forms import Number, Vector
    from kin.numeric.arrays import Array

LAYERS, EACH, STEPS = 3, 6, 121  # of a flank: layers, one of so many places, and angles about each
AROUND = 1.5  # radii of a roller by the radius of the core: angle, rad, over which it passes a place


def other_half(design: IndexDesign) -> tuple[float, float]:
    """Least distance, mm, of the smaller roller's flank from the axis of a roller whose other half passes it.

    With it comes the shaft angle, rad. The distance is infinite where no other half passes the flank.
    """
    form = design.recipe.form
    flank = min(design.flanks.values(), key=lambda each: each.radius)
    wide = min(AROUND * design.largest / form.core, 0.5 * math.pi)
    best = (math.inf, 0.0)
    steps: Array = np.linspace(-wide, wide, STEPS)
    for w in np.linspace(*design.recipe.layers, LAYERS).tolist():
        theta, rows = track(design, flank.name, w)
        inside = np.flatnonzero((rows.z > 0.0) & (rows.z < form.length))[::EACH]
        at: Array = (theta[inside, None] + steps).ravel()
        z, phi = (np.repeat(each[inside], STEPS) for each in (rows.z, rows.phi))
        psi = flank.psi(at)
        r, pose, lean = form.beside(w, z), Pose.standing(psi), form.lean(psi)
        along, _, way = form.axes(pose, -np.sin(lean), np.cos(lean))
        place = r * np.cos(phi - at), r * np.sin(phi - at), z
        axis = form.axis(pose, np.full_like(at, w))
        off = place[0] - axis[0], place[1] - axis[1], place[2] - axis[2]
        square = _dot(off, off) - _dot(off, along) ** 2
        square, side, at = (each.reshape(-1, STEPS) for each in (square, flank.side * _dot(off, way), at))
        # between two angles of either half the roller passes the place with the plane between them
        passes = side[:, 1:] * side[:, :-1] < 0.0
        share = side[:, :-1] / np.where(passes, side[:, :-1] - side[:, 1:], 1.0)
        between = np.where(passes, square[:, :-1] + share * (square[:, 1:] - square[:, :-1]), np.inf)
        square = np.minimum(np.where(side < 0.0, square, np.inf)[:, :-1], between)
        if square.size:
            k = int(np.argmin(square))
            best = min(best, (math.sqrt(max(float(square.flat[k]), 0.0)), float(at[:, :-1].flat[k])))
    return best


def _dot(one: Vector, other: Vector) -> Number:
    return one[0] * other[0] + one[1] * other[1] + one[2] * other[2]
