"""Maps of the plane that drawings have: of an SVG's groups and of a DXF's blocks, and shapes under them."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from kin.contour.bezier import Beziers
from kin.read.drawing.shapes import Shape, UnfitError, shape

__all__ = ["ALIKE", "Affine"]

# Two radii, or two scales, that differ by less are equal; an arc's radius may be short of half its chord by as much.
ALIKE = 1e-12


class Affine(NamedTuple):
    """The map x' = a x + c y + e, y' = b x + d y + f, as SVG writes it."""

    a: float = 1.0
    b: float = 0.0
    c: float = 0.0
    d: float = 1.0
    e: float = 0.0
    f: float = 0.0

    def after(self, first: Affine) -> Affine:
        """Return the map that applies `first`, then this one."""
        a, b, c, d, e, f = self
        return Affine(
            a * first.a + c * first.b,
            b * first.a + d * first.b,
            a * first.c + c * first.d,
            b * first.c + d * first.d,
            a * first.e + c * first.f + e,
            b * first.e + d * first.f + f,
        )

    def at(self, x: float, y: float) -> tuple[float, float]:
        """Give the image (x, y) of a point."""
        return self.a * x + self.c * y + self.e, self.b * x + self.d * y + self.f

    def similar(self) -> tuple[float, float]:
        """Scale of a similarity and its sense, -1 for a mirror. Raises UnfitError for a map that bends circles."""
        scale, sense = math.hypot(self.a, self.b), 1.0 if self.a * self.d - self.b * self.c > 0.0 else -1.0
        off = max(abs(self.c + sense * self.b), abs(self.d - sense * self.a))
        if not 0.0 < scale < math.inf or not off <= ALIKE * scale:
            raise UnfitError("unsupported", "a transform makes ellipses of its circles")
        return scale, sense

    @staticmethod
    def rotation(degrees: float) -> Affine:
        """Return the rotation by an angle, counter-clockwise where y points up."""
        c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
        return Affine(c, s, -s, c)

    def moved(self, drawn: Shape, rise: float = 0.0, scale: float = 1.0) -> Shape:
        """Return a shape under the map, each height z at `rise` + `scale` z; raises UnfitError for bent circles."""
        matrix, shift = np.array([[self.a, self.b], [self.c, self.d]]), np.array([self.e, self.f])
        chords, arcs, beziers = drawn.chords.copy(), drawn.arcs.copy(), drawn.beziers
        if len(chords):
            chords[:, :2], chords[:, 2:4] = chords[:, :2] @ matrix + shift, chords[:, 2:4] @ matrix + shift
        if len(arcs) or bool(chords[:, 4].any()):
            size, sense = self.similar()
            chords[:, 4] *= sense
            arcs[:, :2] = arcs[:, :2] @ matrix + shift
            arcs[:, 2] *= size
            arcs[:, 3] = math.atan2(self.b, self.a) + sense * arcs[:, 3]
            arcs[:, 4] *= sense
        if beziers.count:
            beziers = Beziers(beziers.control @ matrix + shift, beziers.weight)
        return shape(chords=chords, arcs=arcs, beziers=beziers, heights=rise + scale * drawn.heights)
