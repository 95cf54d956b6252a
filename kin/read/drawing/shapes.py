"""Entities of a drawing as numbers, in its plane and unit, and the maps of an SVG's groups and a DXF's blocks."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from kin.contour.bezier import Beziers
from kin.contour.pieces import Pieces
from kin.numeric.errors import CamgeoError

if TYPE_CHECKING:
    from kin.numeric.arrays import Array

# Beyond this, in drawing units, the squares of coordinates have no digits left for a contour.
LARGEST = 1e7
LARGEST_BULGE = 1e6
LARGEST_WEIGHT_RATIO = 1e6
HIGHEST_DEGREE = 25
# Two radii, or two scales, that differ by less are equal; an arc's radius may be short of half its chord by as much.
ALIKE = 1e-12


class UnfitError(CamgeoError):
    """An entity that is no part of a plane contour.

    Its arguments are a reason, a key of `kin.read.errors.REASONS`, and a text of what is wrong.
    """


class Shape(NamedTuple):
    """One entity, in drawing units: chords, arcs or Bezier pieces, in order along it; two of the three are empty.

    chords   (k, 5): x and y of start and end, and the bulge, tan(sweep / 4), 0 for a line
    arcs     (k, 5): x and y of the centre, radius, start angle and sweep, rad, counter-clockwise positive
    beziers  pieces of splines and ellipses
    heights  (h,) above the plane, to be compared
    """

    chords: Array
    arcs: Array
    beziers: Beziers
    heights: Array

    @property
    def spans(self) -> int:
        """Number of pieces as the file counts them."""
        return len(self.chords) + len(self.arcs) + self.beziers.count


def shape(*, chords: Any = (), arcs: Any = (), beziers: Beziers | None = None, heights: Any) -> Shape:  # noqa: ANN401
    """Return a Shape; raises UnfitError for numbers, but for those of `beziers`, that are not finite or too large."""
    made = Shape(
        np.asarray(chords, dtype=np.float64).reshape(-1, 5),
        np.asarray(arcs, dtype=np.float64).reshape(-1, 5),
        Beziers.empty() if beziers is None else beziers,
        np.asarray(heights, dtype=np.float64).ravel(),
    )
    check(made.chords[:, :4], made.arcs, made.heights)
    check(made.chords[:, 4], limit=LARGEST_BULGE)
    return made


def check(*numbers: Array, limit: float = LARGEST) -> None:
    """Raise UnfitError for numbers that are not finite or whose size is above `limit`."""
    for array in numbers:
        bad = array[~(np.abs(array) <= limit)]
        if bad.size:
            problem = f"a value of {bad.flat[0]:g}" if np.isfinite(bad.flat[0]) else "a value that is not finite"
            raise UnfitError("range", problem)


def check_degree(degree: int) -> None:
    """Raise UnfitError for a degree of a B-spline that is below 1 or above HIGHEST_DEGREE."""
    if not 1 <= degree <= HIGHEST_DEGREE:
        raise UnfitError("unsupported", f"it is of degree {degree}; up to {HIGHEST_DEGREE} is read")


def check_spline(degree: int, knots: Array, weight: Array, count: int) -> None:
    """Raise UnfitError where a B-spline's numbers do not fit together or tear it apart.

    It has a degree, knots (k,), weights (n,) and `count` control points; k = count + degree + 1, n = count.
    """
    if len(knots) != count + degree + 1 or count <= degree or len(weight) != count:
        numbers = f"{count} control points, {len(knots)} knots, {len(weight)} weights, degree {degree}"
        raise UnfitError("syntax", f"these numbers do not fit together: {numbers}")
    first, last = knots[degree], knots[count]
    if (np.diff(knots) < 0.0).any() or not first < last:
        raise UnfitError("syntax", "its knots fall or span nothing")
    inner = knots[(knots > first) & (knots < last)]
    if (inner[degree:] == inner[:-degree]).any():
        raise UnfitError("unsupported", "a knot repeated too often tears it apart")
    if not ((weight > 0.0).all() and weight.max() <= LARGEST_WEIGHT_RATIO * weight.min()):
        raise UnfitError("unsupported", "its weights are not all positive and of one order")


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
        """Image (x, y) of a point under the map."""
        return self.a * x + self.c * y + self.e, self.b * x + self.d * y + self.f

    def scale_and_sense(self) -> tuple[float, float]:
        """Scale of the map, and its sense, -1 for a mirror and else 1.

        Raises UnfitError for a map that makes ellipses of circles.
        """
        scale, sense = math.hypot(self.a, self.b), 1.0 if self.a * self.d - self.b * self.c > 0.0 else -1.0
        off = max(abs(self.c + sense * self.b), abs(self.d - sense * self.a))
        if not 0.0 < scale < math.inf or not off <= ALIKE * scale:
            raise UnfitError("unsupported", "a transform makes ellipses of its circles")
        return scale, sense

    @property
    def widest(self) -> float:
        """Greatest length of what it makes of a unit along an axis."""
        return max(math.hypot(self.a, self.b), math.hypot(self.c, self.d))

    @staticmethod
    def rotation(degrees: float) -> Affine:
        """Return the rotation by `degrees`, counter-clockwise where y points up."""
        c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
        return Affine(c, s, -s, c)

    def moved(self, drawn: Shape, rise: float = 0.0, scale: float = 1.0) -> Shape:
        """Shape under the map, each height z at `rise` + `scale` z.

        Arcs become pieces of ellipses where the map makes these of circles. Raises UnfitError for numbers that are too
        large.
        """
        matrix, shift = np.array([[self.a, self.b], [self.c, self.d]]), np.array([self.e, self.f])
        chords, arcs, beziers = drawn.chords.copy(), drawn.arcs.copy(), drawn.beziers
        if len(arcs) or bool(chords[:, 4].any()):
            try:
                size, sense = self.scale_and_sense()
            except UnfitError:
                chords, arcs, beziers = chords[:0], arcs[:0], _curves(drawn)
            else:
                chords[:, 4] *= sense
                arcs[:, :2] = arcs[:, :2] @ matrix + shift
                arcs[:, 2] *= size
                arcs[:, 3] = math.atan2(self.b, self.a) + sense * arcs[:, 3]
                arcs[:, 4] *= sense
        if len(chords):
            chords[:, :2], chords[:, 2:4] = chords[:, :2] @ matrix + shift, chords[:, 2:4] @ matrix + shift
        if beziers.count:
            beziers = Beziers(beziers.control @ matrix + shift, beziers.weight)
            check(beziers.control)
        return shape(chords=chords, arcs=arcs, beziers=beziers, heights=rise + scale * drawn.heights)


def _curves(drawn: Shape) -> Beziers:
    """Lines and arcs of a shape as Bezier pieces, in order."""
    chords = drawn.chords
    pieces = Pieces.from_chords(chords[:, :2], chords[:, 2:4], chords[:, 4]) if len(chords) else None
    rows = drawn.arcs.tolist()
    if pieces is not None:
        rows = np.column_stack([pieces.centre, pieces.radius, pieces.angle, pieces.sweep]).tolist()
    parts = []
    for i, (x, y, radius, angle, sweep) in enumerate(rows):
        if pieces is not None and not radius:
            parts.append(Beziers(np.array([[pieces.start[i], pieces.end[i]]]), np.ones((1, 2))))
            continue
        axes = np.array([radius, 0.0]), np.array([0.0, radius])
        parts.append(Beziers.from_ellipse(np.array([x, y]), *axes, angle, angle + sweep))
    return Beziers.joined(parts)
