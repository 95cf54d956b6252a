"""Openings drawn smaller by half the width of a cut."""

from __future__ import annotations

import numpy as np

from camgeo.fit.bound import EXACT
from camgeo.fit.pieces import ArcSpline
from camgeo.part.shapes import Opening, disc
from kin.numeric.records import replace


def narrowed(opening: Opening, out: float) -> Opening:
    """The opening smaller by `out`, mm, all round: a circle, or a slot of two lines and two half circles."""
    if opening.circle is not None:
        centre, radius = opening.circle
        return disc(opening.name, opening.layer, centre, radius - out)
    points = opening.outline.points
    middle = points.mean(axis=0)
    along = points[1] - points[0]
    along = along / np.hypot(*along)
    across = np.array([-along[1], along[0]])
    inward = np.sign((points - middle) @ across)[:, None] * across
    return replace(opening, outline=ArcSpline(points - out * inward, opening.outline.bulges, EXACT))
