"""Points in which the follower touches the exact cam, with outward normals."""

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
    """Points of contact (n, 2), mm, and unit normals (n, 2) out of the metal, in the axes of the cam before mirroring.

    `angles` (n,) are the shaft angles, rad, of the contacts.
    """

    angles: Array
    places: Array
    normals: Array

    def as_drawn(self, angle: float, rotation: str) -> ContactPoints:
        """Copy of the points, cam turned counter-clockwise by `angle`, rad, then mirrored about the x axis for `ccw`.

        `rotation` is the sense in which the shaft turns, `cw` or `ccw`.
        """
        places, normals = self.places, self.normals
        if angle:
            c, s = math.cos(angle), math.sin(angle)
            # rows times this matrix are turned counter-clockwise
            turn = np.array([[c, s], [-s, c]])
            places, normals = places @ turn, normals @ turn
        mirror = np.array([1.0, -1.0 if rotation == "ccw" else 1.0])
        return self._replace(places=places * mirror, normals=normals * mirror)


def contact_points(design: Design, shaft: Array, contours: Sequence[tuple[Surface, Curve]]) -> Iterator[ContactPoints]:
    """Yield the contact points at shaft angles (n,), rad: for each contact, on each of the `contours`.

    Places that were trimmed off are left out.
    """
    relative = shaft if design.driven is None else design.driven.mechanism.relative(shaft)
    for parameter in design.motion.parameters(shaft, relative).values():
        for surface, contour in contours:
            frame, kept = contour.sample(parameter), touched(contour, parameter)
            yield ContactPoints(shaft[kept], frame.point[kept], (surface.side * frame.normal)[kept])
