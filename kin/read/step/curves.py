"""Edges of a STEP solid as numbers: lines, conics and B-splines in space, and where they pass a height; mm."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kin.contour.bezier import Beziers
from kin.numeric.angles import TURN
from kin.numeric.bernstein import roots, values
from kin.numeric.records import dataclass
from kin.read.drawing.shapes import HIGHEST_DEGREE, LARGEST, UnfitError, check_degree, check_spline
from kin.read.step.part21 import Reference

if TYPE_CHECKING:
    from kin.numeric.arrays import Array, Indices
    from kin.read.step.part21 import Exchange, Value

# A circle's ends this close, rad, are one: the whole circle.
WHOLE = 1e-9
CLOSED = 1e-9  # mm between the ends of a closed spline
BEYOND = 1e-3  # of its size, by which a spline's ends may miss the edge's before it is taken for a trimmed one
SAMPLES = np.array([0.0, 0.25, 0.5, 0.75, 1.0])  # of a piece, where it is held against its faces
# Curves of a surface that carry their curve in space as their first value after the name.
WRAPPED = ("SURFACE_CURVE", "SEAM_CURVE", "INTERSECTION_CURVE")
SPLINES = ("B_SPLINE_CURVE_WITH_KNOTS", "BEZIER_CURVE")


class StepFile(NamedTuple):
    """A file, with the length of its unit in mm, its unit of angle in rad if stated, and its own accuracy in mm.

    `place` is where the file puts its solid, None where it leaves it; points and directions come back placed. Methods
    read the entity that `value`, of the entity numbered `by`, refers to. They raise ReadError where it is of another
    kind or its numbers are out of bounds.
    """

    file: Exchange
    mm: float
    radian: float | None
    accuracy: float
    place: Frame | None = None

    def point(self, value: Value, by: int) -> Array:
        """Place (3,) of a CARTESIAN_POINT, mm."""
        place = self.triple(value, by, "CARTESIAN_POINT") * self.mm
        if self.place is not None:
            place = self.place.origin + self.turned(place)
        if not bool((np.abs(place) <= LARGEST).all()):
            raise self.file.error(by, f"a coordinate of {np.abs(place).max():g} mm", "range")
        return place

    def direction(self, value: Value, by: int) -> Array:
        """Direction (3,) of a DIRECTION, of any length."""
        return self.turned(self.triple(value, by, "DIRECTION"))

    def turned(self, drawn: Array) -> Array:
        """Turn a direction (3,) as the file's place does."""
        if self.place is None:
            return drawn
        turned_direction: Array = drawn[0] * self.place.x + drawn[1] * self.place.y + drawn[2] * self.place.z
        return turned_direction

    def triple(self, value: Value, by: int, kind: str) -> Array:
        """Three numbers (3,) of an entity of a kind, not placed: a point in the file's unit, or any direction."""
        number = self.file.reference(value, by)
        numbers = self.file.several(self.file.values(number, kind, 2)[1], number)
        if len(numbers) != 3:
            raise self.file.error(number, f"{len(numbers)} coordinates", "syntax")
        return np.array([self.file.number(coordinate, number) for coordinate in numbers])

    def length(self, value: Value, by: int) -> float:
        """Length above 0, mm, of the number `value`."""
        size = self.file.number(value, by) * self.mm
        if not 0.0 < size <= 1e6 * LARGEST:
            raise self.file.error(by, f"a length of {size:g} mm", "range")
        return size

    def frame(self, value: Value, by: int) -> Frame:
        """Axes of an AXIS2_PLACEMENT_3D; axes left out are the standard's (ISO 10303-42)."""
        number = self.file.reference(value, by)
        _, place, axis, first, *_ = (*self.file.values(number, "AXIS2_PLACEMENT_3D", 2), None, None)
        z = np.array([0.0, 0.0, 1.0]) if axis is None else self.triple(axis, number, "DIRECTION")
        x = np.array([1.0, 0.0, 0.0]) if first is None else self.triple(first, number, "DIRECTION")
        size = np.linalg.norm(z)
        if not size > 0.0:
            raise self.file.error(number, "its axis has no direction", "range")
        z = z / size
        if first is None and abs(z[0]) > 0.9:  # ISO 10303-42, first_proj_axis: y where the axis is that of x
            x = np.array([0.0, 1.0, 0.0])
        x = x - (x @ z) * z
        size = np.linalg.norm(x)
        if not size > 1e-9:
            raise self.file.error(number, "its axes are parallel", "range")
        x, z = self.turned(x / size), self.turned(z)
        return Frame(self.point(place, number), x, np.cross(z, x), z)


class Frame(NamedTuple):
    """A place and three axes, (3,) each."""

    origin: Array
    x: Array
    y: Array
    z: Array


class Straight(NamedTuple):
    """A line through a point (3,) in a direction of length one (3,)."""

    point: Array
    along: Array


class Conic(NamedTuple):
    """Part of a circle or an ellipse: centre + u cos t + v sin t, (3,) each, from t = first over `sweep`, rad."""

    centre: Array
    u: Array
    v: Array
    first: float
    sweep: float

    def at(self, share: Array) -> Array:
        """Points (k, 3) at shares (k,) of the angle."""
        t = self.first + self.sweep * share
        points: Array = self.centre + np.outer(np.cos(t), self.u) + np.outer(np.sin(t), self.v)
        return points


class Spline(NamedTuple):
    """Spans of a B-spline in its own sense: plan (x, y), and heights as (z, 0), with the same weights.

    `back` says that the edge runs against the spline.
    """

    plan: Beziers
    rise: Beziers
    back: bool = False

    @property
    def ends(self) -> tuple[Array, Array]:
        """Start and end point (3,) of the edge, mm."""
        first = np.append(self.plan.control[0, 0], self.rise.control[0, 0, 0])
        last = np.append(self.plan.control[-1, -1], self.rise.control[-1, -1, 0])
        return (last, first) if self.back else (first, last)

    def at(self, row: Indices, share: Array) -> Array:
        """Points (k, 3) of spans (k,) at shares (k,) of their parameter."""
        plan, rise = (part.point(row, share) for part in (self.plan, self.rise))
        return np.column_stack([plan, rise[:, 0]])


@dataclass(frozen=True, eq=False)
class StepEdge:
    """An EDGE_CURVE: its number, where it starts and ends (3,), and its curve."""

    number: int
    start: Array
    end: Array
    curve: Straight | Conic | Spline

    @property
    def samples(self) -> Array:
        """Points (k, 3), mm, along the curve in its own sense, its two ends included."""
        match self.curve:
            case Straight():
                return np.stack([self.start, 0.5 * (self.start + self.end), self.end])
            case Conic():
                return self.curve.at(SAMPLES)
        count = self.curve.plan.count
        return self.curve.at(np.repeat(np.arange(count), len(SAMPLES)), np.tile(SAMPLES, count))

    @property
    def misfit(self) -> float:
        """Greatest distance of the edge's ends from its curve, mm."""
        if isinstance(self.curve, Straight):
            beside = [np.cross(place - self.curve.point, self.curve.along) for place in (self.start, self.end)]
            return float(max(np.linalg.norm(offset) for offset in beside))
        if isinstance(self.curve, Conic):
            first, last = self.curve.at(np.array([0.0, 1.0]))
        else:
            first, last = self.curve.ends
        return float(max(np.linalg.norm(first - self.start), np.linalg.norm(last - self.end)))

    def crossings(self, z: float) -> list[tuple[Array, bool]]:
        """Points (3,) where the edge passes the height z, mm, in its own sense, each with whether it rises there."""
        curve = self.curve
        if isinstance(curve, Straight):
            low, high = float(self.start[2]), float(self.end[2])
            if (low > z) == (high > z):
                return []
            return [(self.start + (z - low) / (high - low) * (self.end - self.start), high > low)]
        if isinstance(curve, Conic):
            return _conic_crossings(curve, z)
        return _spline_crossings(curve, z)


def _spline_crossings(curve: Spline, z: float) -> list[tuple[Array, bool]]:
    """Crossings where the sign of the height above z changes: at a root within a span, or at a joint of two spans."""
    polynomials = curve.rise.weight * (curve.rise.control[:, :, 0] - z)
    near = np.flatnonzero(~((polynomials > 0.0).all(axis=1) | (polynomials < 0.0).all(axis=1)))
    if not near.size:
        return []
    rows, begins, middles = [], [], []
    for row in range(len(polynomials)):
        cuts = np.array([0.0, *(roots(polynomials[row]) if row in near else ()), 1.0])
        rows += [row] * (len(cuts) - 1)
        begins += cuts[:-1].tolist()
        middles += (0.5 * (cuts[1:] + cuts[:-1])).tolist()
    above = values(polynomials[rows], np.array(middles)) > 0.0
    closed = bool(np.linalg.norm(curve.ends[1] - curve.ends[0]) <= CLOSED)
    crossings = []
    for k in np.flatnonzero(above != np.roll(above, 1)):
        if k or closed:
            place = curve.at(np.array([rows[k]]), np.array([begins[k]]))[0]
            crossings.append((place, bool(above[k]) != curve.back))
    return crossings


def _conic_crossings(curve: Conic, z: float) -> list[tuple[Array, bool]]:
    a, b, c = float(curve.u[2]), float(curve.v[2]), z - float(curve.centre[2])
    size = float(np.hypot(a, b))
    if size <= abs(c):
        return []
    # a cos t + b sin t = c at t = middle - half and middle + half
    middle, half = np.arctan2(b, a), np.arccos(c / size)
    crossings = []
    for t in (middle - half, middle + half):
        share = (t - curve.first) % TURN / curve.sweep if curve.sweep > 0.0 else (curve.first - t) % TURN / -curve.sweep
        if share <= 1.0:
            rises = (b * np.cos(t) - a * np.sin(t)) * curve.sweep > 0.0
            crossings.append((curve.at(np.array([share]))[0], bool(rises)))
    return crossings


def edge_of(space: StepFile, number: int) -> StepEdge:
    """Read the EDGE_CURVE of a number.

    Raises ReadError for a curve that is not read, unsound numbers, and a spline that goes on beyond the edge's ends.
    """
    file = space.file
    _, first, last, geometry, sense, *_ = file.values(number, "EDGE_CURVE", 5)
    start, end = (_vertex(space, file.reference(vertex, number)) for vertex in (first, last))
    forward = file.flag(sense, number)
    curve = file.reference(geometry, number)
    kind = file.kind(curve, (*WRAPPED, "LINE", "CIRCLE", "ELLIPSE", *SPLINES), number)
    if kind in WRAPPED:
        curve = file.reference(file.values(curve, kind, 2)[1], curve)
        kind = file.kind(curve, ("LINE", "CIRCLE", "ELLIPSE", *SPLINES), number)
    if kind == "LINE":
        shape: Straight | Conic | Spline = _line(space, curve)
    elif kind in {"CIRCLE", "ELLIPSE"}:
        shape = _conic(space, curve, kind, (start, end) if forward else (end, start), forward=forward)
    else:
        spline = spline_of(space, curve)
        shape = spline._replace(back=not forward)
    edge = StepEdge(number, start, end, shape)
    if isinstance(shape, Spline) and edge.misfit > BEYOND * float(np.ptp(edge.samples, axis=0).max()):
        raise file.error(number, f"its curve #{curve} goes on beyond its ends; a spline is read whole")
    return edge


def _vertex(space: StepFile, number: int) -> Array:
    return space.point(space.file.values(number, "VERTEX_POINT", 2)[1], number)


def _line(space: StepFile, number: int) -> Straight:
    _, point, vector, *_ = space.file.values(number, "LINE", 3)
    arrow = space.file.reference(vector, number)
    along = space.direction(space.file.values(arrow, "VECTOR", 2)[1], arrow)
    size = np.linalg.norm(along)
    if not size > 0.0:
        raise space.file.error(number, "it has no direction", "range")
    return Straight(space.point(point, number), along / size)


def _conic(space: StepFile, number: int, kind: str, ends: tuple[Array, Array], *, forward: bool) -> Conic:
    """Circle or ellipse between two `ends` (3,) in its own sense, reversed unless the edge runs forward."""
    axes, *sizes = space.file.values(number, kind, 3 if kind == "CIRCLE" else 4)[1:]
    frame = space.frame(axes, number)
    a = space.length(sizes[0], number)
    b = a if kind == "CIRCLE" else space.length(sizes[1], number)
    first, last = (float(np.arctan2((p - frame.origin) @ frame.y / b, (p - frame.origin) @ frame.x / a)) for p in ends)
    sweep = (last - first) % TURN
    if sweep < WHOLE or TURN - sweep < WHOLE:
        sweep = TURN
    if not forward:
        first, sweep = first + sweep, -sweep
    return Conic(frame.origin, a * frame.x, b * frame.y, first, sweep)


def spline_of(space: StepFile, number: int) -> Spline:
    """Read the B-spline curve, rational or not, of a number. Raises ReadError where its numbers do not fit together."""
    file = space.file
    records = file.instances[number]
    if "B_SPLINE_CURVE" in records:  # of several types at once, each with its own values
        shape = file.values(number, "B_SPLINE_CURVE", 5)
        knotted = file.values(number, "B_SPLINE_CURVE_WITH_KNOTS", 2) if "B_SPLINE_CURVE_WITH_KNOTS" in records else ()
    else:
        kind = next(item for item in SPLINES if item in records)
        every = file.values(number, kind, 8 if kind == SPLINES[0] else 6)
        shape, knotted = every[1:6], every[6:]
    degree = int(file.number(shape[0], number))
    points = file.several(shape[1], number)
    control = np.array([space.point(item, number) for item in points if isinstance(item, Reference)]).reshape(-1, 3)
    weight = np.ones(len(control))
    if "RATIONAL_B_SPLINE_CURVE" in records:
        shares = file.several(file.values(number, "RATIONAL_B_SPLINE_CURVE", 1)[0], number)
        weight = np.array([file.number(item, number) for item in shares])
    try:
        check_degree(degree)
        knots = _knots(space, number, knotted, degree, len(control))
        check_spline(degree, knots, weight, len(control))
    except UnfitError as error:
        reason, problem = error.args
        raise file.error(number, problem, reason) from None
    plan = Beziers.from_spline(degree, knots, control[:, :2], weight)
    rise = Beziers.from_spline(degree, knots, np.column_stack([control[:, 2], np.zeros(len(control))]), weight)
    return Spline(plan, rise)


def _knots(space: StepFile, number: int, knotted: tuple[Value, ...], degree: int, count: int) -> Array:
    """Knots (k,), each as often as it counts, of a curve with `count` control points.

    Without the values of knots, as in a BEZIER_CURVE, the ends of spans are knots, `degree` times each between spans.
    """
    if len(knotted) >= 2:
        return repeated(space, number, knotted[0], knotted[1], count)
    spans = (count - 1) // degree
    return np.concatenate([[0.0], np.repeat(np.arange(spans + 1.0), degree), [float(spans)]])


def repeated(space: StepFile, number: int, often: Value, places: Value, count: int) -> Array:
    """Knots (k,) of the entity of a number, each as often as it counts, for `count` control points.

    Raises ReadError where knots and multiplicities do not fit together.
    """
    file = space.file
    listed = [file.several(item, number) for item in (often, places)]
    times = np.array([int(file.number(item, number)) for item in listed[0]])
    where = np.array([file.number(item, number) for item in listed[1]])
    if len(times) != len(where) or bool((times < 1).any()) or times.sum() > count + HIGHEST_DEGREE + 1:
        raise file.error(number, "its knots and their multiplicities do not fit together", "syntax")
    return np.repeat(where, times)
