"""The drum as a solid of exact surfaces, by Open CASCADE: flanks are splines, all else planes and cylinders.

As in `camgeo.capabilities.cylindrical.solid` a section through the axis runs round the metal, and every corner of it is
a closed line about the axis. Lines are parted at two angles at least, so that no face meets itself, and neighbouring
faces share their edges. A row of a flank lies on its cylinder within the bound of the flank.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from camgeo.capabilities.cylindrical.bicubic import NEAR, bicubics, jumps_of
from camgeo.capabilities.cylindrical.figures import at_angle
from camgeo.capabilities.cylindrical.sides import Sides, widest_gap
from camgeo.capabilities.cylindrical.trimmed import trimmed
from camgeo.files.brep import Shape, Stack
from camgeo.files.curves import CONFUSION
from camgeo.files.errors import RegionError
from kin.numeric.angles import TURN

if TYPE_CHECKING:
    from collections.abc import Sequence

    from camgeo.capabilities.cylindrical.bicubic import Bicubic
    from camgeo.capabilities.cylindrical.design import DrumDesign
    from kin.numeric.arrays import Array

HALVES = 2  # faces of a cylinder
STARTS, APART = 12, 0.02  # cuts that are tried, and rad from a jump beside which one leaves a face too narrow


class Solid(NamedTuple):
    """The kernel's solid, the proved bound of its flanks, mm, and the number of their polynomials."""

    shape: Shape
    off: float
    pieces: int


class _Line(NamedTuple):
    """A closed line about the axis: edges, the vertex at the start of each, and which of these part its cylinders."""

    edges: list[Shape]
    vertices: list[Shape]
    parted: list[int]

    def half(self, k: int) -> tuple[Shape, list[Shape], Shape]:
        """Start, edges and end of one of its parts."""
        count = len(self.edges)
        first, last = self.parted[k], self.parted[(k + 1) % HALVES]
        numbers = [n % count for n in range(first, last if last > first else last + count)]
        return self.vertices[first], [self.edges[n] for n in numbers], self.vertices[last]


class _Rib(NamedTuple):
    """An edge from floor to blank, with the vertices at its ends."""

    edge: Shape
    ends: tuple[Shape, Shape]


class _Drum:
    """Faces of a drum under construction."""

    def __init__(self, design: DrumDesign, tolerance: float) -> None:
        self.design, self.stack = design, Stack()
        self.sign = design.recipe.sense
        self.off, self.pieces = 0.0, 0
        self.tolerance = tolerance

    def circle(self, radius: float, z: float, angles: Sequence[float]) -> _Line:
        """A circle parted at two polar angles, rad, the second less than a turn beyond the first."""
        from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeEdge
        from OCP.gp import gp_Ax2, gp_Circ, gp_Dir

        first, last = angles
        vertices = [_vertex([radius * math.cos(a), self.sign * radius * math.sin(a), z]) for a in angles]
        way = gp_Dir(0.0, 0.0, self.sign)
        edges = []
        for k, angle in enumerate((first, last)):
            # a circle of the kernel begins at its x axis
            axes = gp_Ax2(_point([0.0, 0.0, z]), way, gp_Dir(math.cos(angle), self.sign * math.sin(angle), 0.0))
            edges.append(BRepBuilderAPI_MakeEdge(gp_Circ(axes, radius), vertices[k], vertices[1 - k]).Edge())
        return _Line(edges, vertices, [0, 1])

    def flank(self, name: str, parted: Sequence[float]) -> tuple[_Line, _Line]:
        """Add the faces of a flank, parted at two shaft angles, rad; its lines on the blank and on the floor."""
        recipe = self.design.recipe
        parts, off = bicubics(self.design.flanks[name], (recipe.floor, recipe.radius), self.tolerance, parted)
        self.off = max(self.off, off)
        ribs = [self.rib(part, 0) for part in parts]
        rows = self.strip(parts, [*ribs, ribs[0]])
        places = [
            int(np.argmin([abs(math.remainder(part.theta[0] - angle, TURN)) for part in parts])) for angle in parted
        ]
        foot, head = (_Line(edges, [rib.ends[k] for rib in ribs], places) for k, edges in enumerate(rows))
        return head, foot

    def rib(self, part: Bicubic, column: int) -> _Rib:
        """The line at which a spline begins, 0, or ends, -1, from its foot on the floor to its head on the blank."""
        net = part.control[column] * [1.0, self.sign, 1.0]
        ends = _vertex(net[0]), _vertex(net[-1])
        return _Rib(_spline_edge(net, part.r, ends), ends)

    def strip(self, parts: Sequence[Bicubic], ribs: Sequence[_Rib]) -> tuple[list[Shape], list[Shape]]:
        """Add the faces of splines between ribs that follow one another; their edges on the floor and on the blank."""
        rows: tuple[list[Shape], list[Shape]] = ([], [])
        for part, begin, end in zip(parts, ribs[:-1], ribs[1:], strict=True):
            self.pieces += (len(part.theta) - 1) * (len(part.r) - 1)
            net = part.control * [1.0, self.sign, 1.0]
            for k, row in enumerate((0, -1)):
                rows[k].append(_spline_edge(net[:, row], part.theta, (begin.ends[k], end.ends[k])))
            surface = _surface(net, part)
            u, v = part.theta[[0, -1]].tolist(), part.r[[0, -1]].tolist()
            lay = (
                (rows[0][-1], (0.0, v[0])),
                (end.edge, (u[1], 0.0)),
                (rows[1][-1], (0.0, v[1])),
                (begin.edge, (u[0], 0.0)),
            )
            for n, (edge, at) in enumerate(lay):
                _lay(edge, surface, at, along_u=n % 2 == 0)
            self.stack.face(surface, [edge for edge, _ in lay])
        return rows

    def crossed(self) -> tuple[_Line, _Line]:
        """Add the flanks of a groove that crosses itself, with blank and floor; the lines of both end faces."""
        design = self.design
        cuts: dict[float, float] = {}

        def parted(radius: float, phi: Array) -> list[float]:
            cuts[radius] = widest_gap(phi)
            return [cuts[radius], cuts[radius] + 0.5 * TURN]

        made = trimmed(design, self.tolerance, parted)
        self.off = made.off
        floor, blank = (Sides(radius, cuts[radius]) for radius in (design.recipe.floor, design.recipe.radius))
        corners: dict[int, _Rib] = {}
        for stretch in made.stretches:
            parts = stretch.parts
            for corner, part, column in ((stretch.begin, parts[0], 0), (stretch.end, parts[-1], -1)):
                if id(corner) not in corners:
                    corners[id(corner)] = self.rib(part, column)
            within = [self.rib(part, 0) for part in parts[1:]]
            ribs = [corners[id(stretch.begin)], *within, corners[id(stretch.end)]]
            below = stretch.name == "lower"  # the metal
            for side, k, edges in zip((floor, blank), (0, -1), self.strip(parts, ribs), strict=True):
                for n, (edge, part) in enumerate(zip(edges, parts, strict=True)):
                    forward = below != (side is blank)
                    side.add(edge, (ribs[n].ends[k], ribs[n + 1].ends[k]), part.control[:, k], forward=forward)
        lines, half = [], 0.5 * TURN
        for z, forward in ((0.0, True), (design.recipe.height, False)):
            line = self.circle(blank.radius, z, [blank.cut, blank.cut + half])
            for k, edge in enumerate(line.edges):
                angle = blank.cut + half * (k + np.linspace(0.0, 1.0, HALVES + 1))
                x, y = blank.radius * np.cos(angle), blank.radius * np.sin(angle)
                places = np.column_stack([x, y, np.full_like(angle, z)])
                blank.add(edge, (line.vertices[k], line.vertices[1 - k]), places, forward=forward)
            lines.append(line)
        for side in (floor, blank):
            for middle, outer, holes in side.faces():
                loops = [outer, *holes]
                if self.sign < 0.0:
                    loops = [[edge.Reversed() for edge in loop[::-1]] for loop in loops]
                self.stack.face(self.round(side.radius, self.sign * middle), loops[0], loops[1:])
        return lines[0], lines[1]

    def round(self, radius: float, middle: float) -> Shape:
        """The cylinder about the axis whose seam lies opposite a polar angle, rad."""
        from OCP.Geom import Geom_CylindricalSurface
        from OCP.gp import gp_Ax3, gp_Dir

        seam = middle + 0.5 * TURN
        axes = gp_Ax3(_point([0.0, 0.0, 0.0]), gp_Dir(0.0, 0.0, 1.0), gp_Dir(math.cos(seam), math.sin(seam), 0.0))
        return Geom_CylindricalSurface(axes, radius)

    def cylinder(self, radius: float, first: _Line, second: _Line) -> None:
        """Add the faces between two lines on a cylinder about the axis, which are parted at the same polar angles."""
        from OCP.BRep import BRep_Tool
        from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeEdge

        ribs = [
            BRepBuilderAPI_MakeEdge(first.vertices[a], second.vertices[b]).Edge()
            for a, b in zip(first.parted, second.parted, strict=True)
        ]
        for k in range(HALVES):
            start, edges, end = first.half(k)
            x, y = ([getattr(BRep_Tool.Pnt_s(vertex), axis)() for vertex in (start, end)] for axis in "XY")
            angle = math.atan2(y[0], x[0])
            sweep = (self.sign * (math.atan2(y[1], x[1]) - angle)) % TURN
            round_ = [*edges, ribs[(k + 1) % HALVES], *second.half(k)[1][::-1], ribs[k]]
            self.stack.face(self.round(radius, angle + self.sign * 0.5 * sweep), round_)

    def lid(self, z: float, line: _Line, bore: Shape | None) -> None:
        """Add an end face within a line, outside the bore."""
        from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeWire

        maker = BRepBuilderAPI_MakeWire()
        for edge in line.edges:
            maker.Add(edge)
        self.stack.lid(z, maker.Wire(), [] if bore is None else [bore])


def drum_solid(design: DrumDesign, tolerance: float) -> Solid:
    """The kernel's solid of a drum whose flanks are whole, within a tolerance, mm.

    Raises ToleranceError where the tolerance cannot be held, RegionError where the kernel finds the solid unsound.
    """
    recipe, rising = design.recipe, design.recipe.track.rising
    drum = _Drum(design, tolerance)
    top, radii = recipe.height, {"lower": (recipe.radius, recipe.floor), "upper": (recipe.floor, recipe.radius)}
    bore = [None, None]
    if design.bore is not None:
        outline = design.bore.outline if drum.sign > 0.0 else design.bore.outline.mirrored()
        foot, head = drum.stack.wall(outline, 0.0, top)
        bore = [foot.wire, head.wire]
    if recipe.turns > 1:
        low, high = drum.crossed()
        drum.lid(0.0, low, bore[0])
        drum.lid(top, high, bore[1])
        return Solid(drum.stack.solid(), drum.off, drum.pieces)
    # between two flanks one cylinder joins them
    parted = _parted(design, radii[rising[0]][1] if len(rising) > 1 else recipe.radius)
    lines = {name: drum.flank(name, parted[name]) for name in design.flanks}

    def angles(name: str, radius: float) -> list[float]:
        return [float(phi) for phi in design.flanks[name].on(np.array(parted[name]), radius).phi]

    first, last = radii[rising[0]][0], radii[rising[-1]][1]
    low = drum.circle(first, 0.0, angles(rising[0], first))
    high = drum.circle(last, top, angles(rising[-1], last))
    below = low
    for name in rising:
        on_blank, on_floor = lines[name]
        near, far = (on_blank, on_floor) if name == "lower" else (on_floor, on_blank)
        drum.cylinder(radii[name][0], below, near)
        below = far
    drum.cylinder(last, below, high)
    drum.lid(0.0, low, bore[0])
    drum.lid(top, high, bore[1])
    return Solid(drum.stack.solid(), drum.off, drum.pieces)


def _parted(design: DrumDesign, radius: float) -> dict[str, list[float]]:
    """Two shaft angles of each flank, rad, which it has at the same polar angles on a cylinder, mm, as the others."""
    names = list(design.flanks)
    first = design.flanks[names[0]]
    jumps = {name: jumps_of(flank) for name, flank in design.flanks.items()}
    begin = float(first.law.breaks[0]) if len(first.law.breaks) else 0.0
    best: tuple[float, dict[str, list[float]]] = -1.0, {}
    for start in begin + np.arange(STARTS) * (0.5 * TURN / STARTS):
        phi = float(first.on(np.array([start]), radius).phi[0]) + np.array([0.0, 0.5 * TURN])
        found = {name: at_angle(design.flanks[name], phi, radius, phi).tolist() for name in names}
        found[names[0]][0] = float(start)
        narrowest = min(_apart(found[name], jumps[name]) for name in names)
        if narrowest > best[0]:
            best = narrowest, found
        if narrowest > APART:
            break
    return best[1]


def _apart(cuts: Sequence[float], jumps: Array) -> float:
    """Least angle, rad, between cuts and jumps that are not one."""
    off = np.abs(np.remainder(np.subtract.outer(np.array(cuts), jumps) + 0.5 * TURN, TURN) - 0.5 * TURN)
    return float(off[off > NEAR].min(initial=TURN))


# --- the kernel's curves ----------------------------------------------------------------------------------------------


def _point(place: Sequence[float] | Array) -> Shape:
    from OCP.gp import gp_Pnt

    return gp_Pnt(*(float(each) for each in place))


def _vertex(place: Sequence[float] | Array) -> Shape:
    from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeVertex

    return BRepBuilderAPI_MakeVertex(_point(place)).Vertex()


def _knots(knots: Array) -> tuple[Shape, Shape]:
    """Knots of the kernel, and how often each counts."""
    from OCP.TColStd import TColStd_Array1OfInteger, TColStd_Array1OfReal

    places, often = TColStd_Array1OfReal(1, len(knots)), TColStd_Array1OfInteger(1, len(knots))
    for i, knot in enumerate(knots.tolist(), 1):
        places.SetValue(i, knot)
        often.SetValue(i, 4 if i in {1, len(knots)} else 2)
    return places, often


def _spline_edge(control: Array, knots: Array, ends: tuple[Shape, Shape]) -> Shape:
    """Edge of a cubic spline, mm, between two vertices; raises RegionError where the kernel makes none."""
    from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeEdge
    from OCP.Geom import Geom_BSplineCurve
    from OCP.TColgp import TColgp_Array1OfPnt

    poles = TColgp_Array1OfPnt(1, len(control))
    for i, place in enumerate(control, 1):
        poles.SetValue(i, _point(place))
    curve = Geom_BSplineCurve(poles, *_knots(knots), 3)
    maker = BRepBuilderAPI_MakeEdge(curve, *ends, curve.FirstParameter(), curve.LastParameter())
    if not maker.IsDone():
        raise RegionError(f"Open CASCADE makes no edge of a flank: {maker.Error().name}")
    return maker.Edge()


def _surface(control: Array, part: Bicubic) -> Shape:
    from OCP.Geom import Geom_BSplineSurface
    from OCP.TColgp import TColgp_Array2OfPnt

    rows, columns = control.shape[:2]
    poles = TColgp_Array2OfPnt(1, rows, 1, columns)
    for i in range(rows):
        for j in range(columns):
            poles.SetValue(i + 1, j + 1, _point(control[i, j]))
    (u, often_u), (v, often_v) = _knots(part.theta), _knots(part.r)
    return Geom_BSplineSurface(poles, u, v, often_u, often_v, 3, 3)


def _lay(edge: Shape, surface: Shape, at: tuple[float, float], *, along_u: bool) -> None:
    """Give an edge its line in the parameters of a surface, whose border it is."""
    from OCP.BRep import BRep_Builder
    from OCP.Geom2d import Geom2d_Line
    from OCP.gp import gp_Dir2d, gp_Pnt2d
    from OCP.TopLoc import TopLoc_Location

    line = Geom2d_Line(gp_Pnt2d(*at), gp_Dir2d(1.0, 0.0) if along_u else gp_Dir2d(0.0, 1.0))
    BRep_Builder().UpdateEdge(edge, line, surface, TopLoc_Location(), CONFUSION)
