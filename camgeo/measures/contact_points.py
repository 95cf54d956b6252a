"""Where the follower touches the exact cam, for what is to be measured: places and outward normals."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from camgeo.curve.measures import touched

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from camgeo.cams.surface import Surface
    from camgeo.curve.curve import Curve
    from camgeo.synthesis.design import Design
    from kin.numeric.arrays import Array


class ContactPoints(NamedTuple):
    """Places (n, 2), mm, and normals (n, 2) out of the metal, in the cam's axes as if it were not mirrored.

    `angles` (n,) are the shaft angles, rad, at which they are touched.
    """

    angles: Array
    places: Array
    normals: Array

    def drawn(self, turned: float, rotation: str) -> ContactPoints:
        """The points of the cam turned by an angle, rad, as it is drawn: mirrored for `ccw`."""
        places, normals = self.places, self.normals
        if turned:
            c, s = math.cos(turned), math.sin(turned)
            back = np.array([[c, s], [-s, c]])
            places, normals = places @ back, normals @ back
        mirror = np.array([1.0, -1.0 if rotation == "ccw" else 1.0])
        return self._replace(places=places * mirror, normals=normals * mirror)


def contact_points(design: Design, shaft: Array, contours: Sequence[tuple[Surface, Curve]]) -> Iterator[ContactPoints]:
    """Give what each contact touches of contours at shaft angles (n,), rad; nothing where a contour is trimmed away."""
    relative = shaft if design.driven is None else design.driven.mechanism.relative(shaft)
    for parameter in design.motion.parameters(shaft, relative).values():
        for surface, contour in contours:
            frame, there = contour.sample(parameter), touched(contour, parameter)
            yield ContactPoints(shaft[there], frame.point[there], (surface.side * frame.normal)[there])
