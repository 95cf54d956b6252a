"""Faces of a STEP solid as numbers, and the sections of each at a height: planes, cylinders, cones, swept curves; mm.

A face lies on the left of its bounds as seen from outside the solid. So where a bound comes down through a height the
section begins, and it ends where a bound goes up, the solid on its left as seen from above.
"""

from __future__ import annotations

from collections import Counter
from functools import cached_property
from typing import TYPE_CHECKING, ClassVar, NamedTuple, TypeAlias

import numpy as np

from kin.contour.biarc import arcs_along
from kin.contour.nearest import nearest
from kin.numeric.angles import TURN
from kin.numeric.places import place_text
from kin.numeric.records import dataclass
from kin.read.drawing.shapes import Shape, shape
from kin.read.step.curves import Conic, Spline, Straight, edge_of, spline_of
from kin.read.step.patch import PATCH, Patch, patch_of

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kin.contour.arcs import Arcs
    from kin.contour.bezier import Beziers
    from kin.numeric.arrays import Array
    from kin.read.step.curves import StepEdge, StepFile

# Sine of an angle that is still rounding: of a plane against the horizontal, an axis against the vertical.
LEVEL = 1e-9
SURFACES = ("PLANE", "CYLINDRICAL_SURFACE", "CONICAL_SURFACE", "SURFACE_OF_LINEAR_EXTRUSION")
SAME = 1e-9  # rad, within which a bound that comes down and one that goes up are a seam
SPLINE_ERROR = 1e-9  # mm, of the arcs by which edges are held against a swept spline
FINE = 1e-12  # of the extent
WOUND = 1.0  # rad, by which bounds may miss going round and back: they miss it by nothing, or by whole turns
CONIC_PARTS = 64  # chords in place of a circle or an ellipse
MOST_NAMED = 3  # edges in a message

Crossing: TypeAlias = "tuple[Array, bool]"


class Plane(NamedTuple):
    """A plane through a point (3,) with a normal (3,)."""

    point: Array
    normal: Array

    @property
    def level(self) -> bool:
        """Whether the plane is horizontal."""
        return bool(np.hypot(*self.normal[:2]) <= LEVEL)

    @property
    def upright(self) -> bool:
        """Whether the plane is vertical."""
        return bool(abs(self.normal[2]) <= LEVEL)

    def off(self, points: Array) -> Array:
        """Distances (k,) of points (k, 3) from the plane, mm."""
        off: Array = np.abs((points - self.point) @ self.normal)
        return off


@dataclass(frozen=True, eq=False)
class RoundFace:
    """A cylinder or a cone about a vertical axis: centre (2,), radius at the height `base`, its growth per mm of z."""

    centre: Array
    radius: float
    base: float
    slope: float

    level: ClassVar[bool] = False

    @property
    def upright(self) -> bool:
        """Whether the surface is a cylinder, not a cone."""
        return self.slope == 0.0

    def radius_at(self, z: float) -> float:
        """Radius at height z, mm."""
        return self.radius + self.slope * (z - self.base)

    def off(self, points: Array) -> Array:
        """Distances (k,) of points (k, 3) from the surface, mm."""
        radius = self.radius + self.slope * (points[:, 2] - self.base)
        off: Array = np.abs(np.hypot(*(points[:, :2] - self.centre).T) - radius) / np.hypot(1.0, self.slope)
        return off


@dataclass(frozen=True, eq=False)
class Tube:
    """A cylinder about a horizontal axis: a point (3,) on the axis, the axis's unit vector (3,), and the radius."""

    point: Array
    along: Array
    radius: float

    level: ClassVar[bool] = False
    upright: ClassVar[bool] = False

    def off(self, points: Array) -> Array:
        """Distances (k,) of points (k, 3) from the cylinder, mm."""
        away = points - self.point
        away = away - np.outer(away @ self.along, self.along)
        off: Array = np.abs(np.linalg.norm(away, axis=1) - self.radius)
        return off


@dataclass(frozen=True, eq=False)
class Swept:
    """Vertical wall over a plane curve, given by the curve's spans as seen from above, and whether it is swept up."""

    spans: Beziers
    up: bool

    level: ClassVar[bool] = False
    upright: ClassVar[bool] = True

    @cached_property
    def arcs(self) -> Arcs:
        """Arcs in place of the curve's spans."""
        extent = float(np.abs(self.spans.control).max())
        return arcs_along(self.spans.unrolled().pieces, max(SPLINE_ERROR, FINE * extent))[0]

    def off(self, points: Array) -> Array:
        """Distances (k,) of points (k, 3) from the wall, mm."""
        return nearest(self.arcs, points[:, :2])[1]

    def along(self, points: Array) -> Array:
        """Directions (k, 2) of the curve near points (k, 2)."""
        along: Array = self.arcs.tangents(0.5 * self.arcs.length)[nearest(self.arcs, points)[0]]
        return along


Surface: TypeAlias = "Plane | RoundFace | Tube | Swept | Patch"


class Use(NamedTuple):
    """An edge in a bound of a face: its number, and whether the bound runs along it in its own sense."""

    edge: int
    forward: bool


@dataclass(frozen=True, eq=False)
class Face:
    """An ADVANCED_FACE: its number, its surface, the loops that bound it, and whether its normal is the surface's.

    `edges` are the edges of the solid by number.
    """

    number: int
    surface: Surface
    loops: tuple[tuple[Use, ...], ...]
    outward: bool
    edges: dict[int, StepEdge]

    @cached_property
    def uses(self) -> list[tuple[StepEdge, bool]]:
        """All edges of its bounds, and whether the bound runs along each in the edge's own sense."""
        return [(self.edges[use.edge], use.forward) for loop in self.loops for use in loop]

    @cached_property
    def heights(self) -> tuple[float, float]:
        """Least and greatest height, mm, of its edges, or of the whole cylinder about a level axis."""
        if isinstance(self.surface, Tube):
            axis = float(self.surface.point[2])
            return axis - self.surface.radius, axis + self.surface.radius
        z = np.concatenate([edge.samples[:, 2] for edge, _ in self.uses])
        return float(z.min()), float(z.max())

    @property
    def leans(self) -> bool:
        """Whether it is neither horizontal nor upright."""
        return not (self.surface.level or self.surface.upright)

    @property
    def reach(self) -> float:
        """Greatest distance of the face's edges from the axis z, mm."""
        return max(float(np.hypot(*edge.samples[:, :2].T).max()) for edge, _ in self.uses)

    @property
    def misfit(self) -> float:
        """Greatest distance of the face's edges from its surface, mm."""
        return float(self.surface.off(np.concatenate([edge.samples for edge, _ in self.uses])).max())

    @property
    def winding(self) -> float:
        """Angle, rad, by which all bounds together run round the axis of a cylinder or a cone; 0 where they are sound.

        It finds an arc that goes the long way round, which lies on the same surface at the same height. 0 for planes
        and swept walls.
        """
        if isinstance(self.surface, RoundFace):
            x, y, centre = np.array([1.0, 0.0, 0.0]), np.array([0.0, 1.0, 0.0]), np.append(self.surface.centre, 0.0)
        elif isinstance(self.surface, Tube):
            y, centre = np.array([0.0, 0.0, 1.0]), self.surface.point
            x = np.cross(y, self.surface.along)
        else:
            return 0.0
        total = 0.0
        for edge, forward in self.uses:
            away = edge.samples - centre
            angle = np.unwrap(np.arctan2(away @ y, away @ x))
            run = float(angle[-1] - angle[0])
            backwards = isinstance(edge.curve, Spline) and edge.curve.back
            total += run if forward != backwards else -run
        return total

    @property
    def inside_out(self) -> bool:
        """Whether it lies on the right of its bounds as seen from outside; False where they go the wrong way round."""
        return abs(self.winding) <= WOUND and self.enclosed < 0.0

    @property
    def enclosed(self) -> float:
        """Area within its bounds, above 0 where it lies on their left as seen from outside, in mm² or as `unrolled`.

        0 for patches and level cylinders, whose area is not known by their bounds.
        """
        match self.surface:
            case Plane():
                points = [points_along(*use) for use in self.uses]
                area = sum(0.5 * np.cross(row[:-1], row[1:]).sum(axis=0) for row in points) @ self.surface.normal
            case RoundFace():
                area = self.unrolled
            case Swept():
                area = self.unrolled if self.surface.up else -self.unrolled
            case _:
                return 0.0
        return float(area if self.outward else -area)

    @property
    def unrolled(self) -> float:
        """Area of an upright wall, unrolled; above 0 where it lies on the left of its bounds.

        It is in mm rad of a cylinder or a cone, seen from beyond it, and in mm² of a swept curve, seen from its right.
        """
        total = 0.0
        for use in self.uses:
            points = points_along(*use)
            middle, step = 0.5 * (points[1:] + points[:-1]), np.diff(points[:, :2], axis=0)
            if isinstance(self.surface, RoundFace):
                run = np.diff(np.unwrap(np.arctan2(*(points[:, :2] - self.surface.centre).T[::-1])))
            elif isinstance(self.surface, Swept):
                run = np.einsum("kc,kc->k", step, self.surface.along(middle[:, :2]))
            else:
                return 0.0
            total -= float(middle[:, 2] @ run)
        return total

    def section(self, space: StepFile, z: float) -> list[Shape]:
        """Pieces of the section just above a height z, mm, in the face; none for a level face or a height beyond it.

        Raises ReadError where its bounds do not enclose a part of its surface at that height.
        """
        low, high = self.heights
        if self.surface.level or not low <= z < high:
            return []
        crossings = [(place, rises == forward) for edge, forward in self.uses for place, rises in edge.crossings(z)]
        if not crossings and not isinstance(self.surface, RoundFace):
            return []
        match self.surface:
            case RoundFace():
                return self._arcs(space, self.surface, z, crossings)
            case Plane():
                normal = self.surface.normal * (1.0 if self.outward else -1.0)
                return self._chords(space, crossings, np.array([-normal[1], normal[0]]))
            case Tube():
                along, point = self.surface.along, self.surface.point
                across = np.array([-along[1], along[0], 0.0])
                pieces = []
                for side in (1.0, -1.0):
                    on_side = [crossing for crossing in crossings if side * float((crossing[0] - point) @ across) > 0.0]
                    pieces += self._chords(space, on_side, along[:2] * (-side if self.outward else side))
                return pieces
            case Patch():
                raise space.file.error(self.number, "is no surface of which a section is known")
        self._demand_ends(space, crossings)
        return [shape(beziers=self.surface.spans, heights=0.0)]

    def _chords(self, space: StepFile, crossings: list[Crossing], along: Array) -> list[Shape]:
        """Pieces of a straight section that runs in a direction (2,)."""
        begins = sorted((place for place, rises in crossings if not rises), key=lambda place: float(place[:2] @ along))
        ends = sorted((place for place, rises in crossings if rises), key=lambda place: float(place[:2] @ along))
        pairs = list(zip(begins, ends, strict=False))
        forward = all(float((last - first)[:2] @ along) > 0.0 for first, last in pairs)
        if len(begins) != len(ends) or not forward:
            raise self._contrary(space)
        return [shape(chords=(*first[:2], *last[:2], 0.0), heights=0.0) for first, last in pairs]

    def _arcs(self, space: StepFile, surface: RoundFace, z: float, crossings: list[Crossing]) -> list[Shape]:
        """Pieces of a round section."""
        radius = surface.radius_at(z)
        if not radius > 0.0:
            raise space.file.error(self.number, f"it passes its cone's tip at z = {z:.9g} mm")
        if not crossings:
            return [_arc(surface.centre, radius, 0.0, TURN)]
        sense = 1.0 if self.outward else -1.0
        angles = [(*(place[:2] - surface.centre), rises) for place, rises in crossings]
        begins = [float(np.arctan2(y, x)) for x, y, rises in angles if not rises]
        ends = [float(np.arctan2(y, x)) for x, y, rises in angles if rises]
        if len(begins) != len(ends):
            raise self._contrary(space)
        pieces = []
        for first in begins:
            sweeps = [(sense * (last - first)) % TURN for last in ends]
            sweep = min(TURN if angle < SAME or TURN - angle < SAME else angle for angle in sweeps)
            pieces.append(_arc(surface.centre, radius, first, sense * sweep))
        return pieces

    def _demand_ends(self, space: StepFile, crossings: list[Crossing]) -> None:
        """Raise ReadError for a swept face that is bounded by anything but the ends of its curve."""
        if len(crossings) != 2 or crossings[0][1] == crossings[1][1] or not isinstance(self.surface, Swept):
            raise self._contrary(space)
        control = self.surface.spans.control
        ends = np.stack([control[0, 0], control[-1, -1]])
        for place, _ in crossings:
            if float(np.hypot(*(ends - place[:2]).T).min()) > space.accuracy:
                raise space.file.error(self.number, "it ends before its curve does; swept curves are read whole")

    def _contrary(self, space: StepFile) -> Exception:
        return space.file.error(self.number, "its bounds do not enclose a part of its surface that faces outward")


def points_along(edge: StepEdge, forward: bool) -> Array:
    """Points (k, 3), mm, along an edge, in the sense of a bound."""
    match edge.curve:
        case Straight():
            points = np.stack([edge.start, edge.end])
        case Conic():
            points = edge.curve.at(np.linspace(0.0, 1.0, CONIC_PARTS + 1))
        case _:
            points = edge.samples[::-1] if edge.curve.back else edge.samples
    return points if forward else points[::-1]


def _arc(centre: Array, radius: float, first: float, sweep: float) -> Shape:
    """Arc as a shape, a whole circle as two halves."""
    parts = 2 if abs(sweep) > 1.5 * np.pi else 1
    rows = [(*centre, radius, first + k * sweep / parts, sweep / parts) for k in range(parts)]
    return shape(arcs=rows, heights=0.0)


def face_of(space: StepFile, number: int, edges: dict[int, StepEdge], *, smooth: bool = False) -> Face:
    """Read the ADVANCED_FACE of a number, and the edges of its bounds into `edges`; `smooth` takes B-spline surfaces.

    Raises ReadError for a surface or an edge that is not read, and a loop whose edges do not follow one another.
    """
    file = space.file
    kind = file.kind(number, ("ADVANCED_FACE", "FACE_SURFACE"), number)
    _, bounds, surface, sense, *_ = file.values(number, kind, 4)
    loops = []
    for listed in file.several(bounds, number):
        bound = file.reference(listed, number)
        _, loop, orientation, *_ = file.values(bound, file.kind(bound, ("FACE_BOUND", "FACE_OUTER_BOUND"), number), 3)
        forward = file.flag(orientation, bound)
        edge_loop = file.reference(loop, bound)
        file.kind(edge_loop, ("EDGE_LOOP",), bound)
        uses = [
            _use(space, file.reference(item, edge_loop), edges)
            for item in file.several(file.values(edge_loop, "EDGE_LOOP", 2)[1], edge_loop)
        ]
        _check_loop(space, edge_loop, uses, edges)
        loops.append(tuple(uses) if forward else tuple(Use(use.edge, not use.forward) for use in reversed(uses)))
    if not loops:
        raise file.error(number, "it has no bounds")
    geometry = _surface(space, file.reference(surface, number), number, SURFACES + (PATCH,) * smooth)
    return Face(number, geometry, tuple(loops), file.flag(sense, number), edges)


def _use(space: StepFile, number: int, edges: dict[int, StepEdge]) -> Use:
    file = space.file
    *_, curve, sense = file.values(number, "ORIENTED_EDGE", 5)[:5]
    edge = file.reference(curve, number)
    if edge not in edges:
        file.kind(edge, ("EDGE_CURVE",), number)
        edges[edge] = edge_of(space, edge)
    return Use(edge, file.flag(sense, number))


def _check_loop(space: StepFile, number: int, uses: list[Use], edges: dict[int, StepEdge]) -> None:
    """Raise ReadError for a loop whose edges do not follow one another."""
    if not uses:
        raise space.file.error(number, "it has no edges", "syntax")
    for use, following in zip(uses, [*uses[1:], uses[0]], strict=True):
        edge, next_edge = edges[use.edge], edges[following.edge]
        end = edge.end if use.forward else edge.start
        start = next_edge.start if following.forward else next_edge.end
        gap = float(np.linalg.norm(start - end))
        if gap > space.accuracy:
            x, y, z = end.tolist()
            where = f"edge #{edge.number} ends at {place_text(x, y, z, digits=9)} mm"
            message = f"{where}, {gap:.3g} mm from where #{next_edge.number} starts"
            raise space.file.error(number, message, "open")


def _surface(space: StepFile, number: int, by: int, kinds: tuple[str, ...]) -> Surface:
    file = space.file
    kind = file.kind(number, kinds, by)
    if kind == PATCH:
        return patch_of(space, number)
    if kind == "SURFACE_OF_LINEAR_EXTRUSION":
        return _swept(space, number)
    _, axes, *sizes = file.values(number, kind, {"PLANE": 2, "CYLINDRICAL_SURFACE": 3, "CONICAL_SURFACE": 4}[kind])
    frame = space.frame(axes, number)
    if kind == "PLANE":
        return Plane(frame.origin, frame.z)
    upright = np.hypot(*frame.z[:2]) <= LEVEL
    if kind == "CYLINDRICAL_SURFACE":
        radius = space.length(sizes[0], number)
        if upright:
            return RoundFace(frame.origin[:2], radius, 0.0, 0.0)
        if abs(frame.z[2]) > LEVEL:
            raise file.error(number, "its axis is neither upright nor level")
        return Tube(frame.origin, frame.z, radius)
    radius = file.number(sizes[0], number) * space.mm
    if space.radian is None:
        raise file.error(number, "the file states no unit of plane angle")
    slope = float(np.tan(file.number(sizes[1], number) * space.radian))
    if not upright:
        raise file.error(number, "its axis is not upright")
    return RoundFace(frame.origin[:2], radius, float(frame.origin[2]), float(np.copysign(slope, frame.z[2])))


def _swept(space: StepFile, number: int) -> Surface:
    """Surface that a spline sweeps along the vertical."""
    file = space.file
    _, curve, vector, *_ = file.values(number, "SURFACE_OF_LINEAR_EXTRUSION", 3)
    arrow = file.reference(vector, number)
    along = space.direction(file.values(arrow, "VECTOR", 2)[1], arrow)
    if not np.hypot(*along[:2]) <= LEVEL * abs(along[2]):
        raise file.error(number, "it is not swept along the vertical")
    path = file.reference(curve, number)
    file.kind(path, ("B_SPLINE_CURVE_WITH_KNOTS", "BEZIER_CURVE"), number)
    return Swept(spline_of(space, path).plan, bool(along[2] > 0.0))


def edge_faults(faces: Sequence[Face]) -> list[str]:
    """Faults in words: edges that do not belong to exactly two faces which run along them opposite ways, arcs too."""
    faults = []
    count = Counter(use for face in faces for loop in face.loops for use in loop)
    number = Counter(use.edge for use in count.elements())
    for problem, wrong in (
        ("belongs to one face only", [edge for edge, times in number.items() if times == 1]),
        ("belongs to more than two faces", [edge for edge, times in number.items() if times > 2]),
        (
            "is run along the same way by both its faces",
            [use.edge for use, times in count.items() if times == 2 and number[use.edge] == 2],
        ),
    ):
        named = ", ".join(f"#{edge}" for edge in sorted(wrong)[:MOST_NAMED])
        if wrong:
            faults.append(f"{len(wrong)} edges ({named}): each {problem}")
    wound = [face.number for face in faces if abs(face.winding) > WOUND]
    return faults + [f"face #{number}: an arc of its bounds goes the wrong way round" for number in wound]
