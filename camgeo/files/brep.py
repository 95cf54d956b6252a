"""Solids bounded by exact surfaces, by Open CASCADE: planes, cylinders, cones and extruded splines; lengths in mm.

The walls stand on closed outlines. An arc's wall is a cylinder, a line's a plane, a spline's the surface that it
sweeps; the chamfer of an arc is a cone and that of a line a plane. Neighbouring faces share their edges from the start,
so that nothing is sewn; only a cross hole is cut by the kernel, which finds where two cylinders meet.
"""

from __future__ import annotations

import math
from functools import reduce
from itertools import pairwise
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from camgeo.curve.ring import centre_of
from camgeo.files.curves import CONFUSION, curves_of, inset, measures, point
from camgeo.files.errors import MissingExtraError, RegionError, demand_uninterrupted, install
from camgeo.fit.bound import EXACT
from camgeo.fit.pieces import ArcSpline

if TYPE_CHECKING:
    from collections.abc import Sequence

    from camgeo.files.layer_outline import LayerOutline
    from camgeo.files.solid import Drill, Solid
    from camgeo.fit.pieces import Outline

VERSION = 7  # of the kernel
# its shapes have no types
Shape = Any


class Wire(NamedTuple):
    """A closed wire, its edges in order, and the vertex at the start of each."""

    wire: Shape
    edges: list[Shape]
    vertices: list[Shape]


def need_kernel() -> None:
    """Raise MissingExtraError unless Open CASCADE is installed in the major version `VERSION`."""
    try:
        import OCP
        import OCP.STEPControl
    except ImportError as error:
        demand_uninterrupted(error)
        raise MissingExtraError(f"a STEP file needs Open CASCADE: {install('step')}") from error
    version = str(OCP.__version__)
    if not version.startswith(f"{VERSION}."):
        message = f"a STEP file needs Open CASCADE {VERSION}, not {version}: {install('step')}"
        raise MissingExtraError(message)


def solid_shape(outlines: Sequence[LayerOutline], solid: Solid) -> Shape:
    """Return the kernel's solid within the first outline, with boss, openings, chamfers and cross holes.

    Further outlines are contours through it or, with a pocket, the two about the pocket. Raises RegionError where a
    piece is too short for the kernel, an arc is sharper than the chamfer, a cross hole divides the solid, or the kernel
    finds it unsound; TypeError for a polygon, and for a chamfer along anything but arcs; ValueError for a periodic
    spline.
    """
    stack = Stack()
    top = solid.thickness
    outermost, *inner_outlines = (layered.outline for layered in outlines)
    contour_foot, contour_head = _contour(stack, outermost, solid)
    through = [cut for cut in solid.cuts if cut.low <= solid.low]
    within = [cut for cut in through if solid.boss is not None and _is_within(cut.outline, solid.boss)]
    boss_below, boss_above = solid.low < 0.0, solid.high > top
    # wires in the disc's lower and upper face, and in those of the boss
    in_disc_bottom: list[Shape] = []
    in_disc_top: list[Shape] = []
    in_boss_bottom: list[Shape] = []
    in_boss_top: list[Shape] = []
    in_island_top: list[Shape] = []  # in the upper face within a pocket
    # a pocket: its floor lies between the walls of two contours, the island's face within the inner one
    if solid.floor is not None:
        ledge, rim = sorted(inner_outlines, key=lambda outline: outline.box()[2])
        (island_foot, island_head), (foot, head) = (stack.wall(outline, solid.floor, top) for outline in (ledge, rim))
        stack.lid(solid.floor, foot.wire, [island_foot.wire])
        in_disc_top.append(head.wire)
        inner_outlines = []
    for outline in inner_outlines:
        foot, head = stack.wall(outline, 0.0, top)
        in_disc_bottom.append(foot.wire)
        in_disc_top.append(head.wire)
    # an engraving has a floor; an opening goes through the disc, or through disc and boss where it lies within the boss
    for cut in solid.cuts:
        inside = any(cut is other for other in within)
        if not any(cut is other for other in through):
            foot, head = stack.wall(cut.outline, cut.low, cut.high)
            stack.lid(cut.low, foot.wire, [])
            (in_island_top if cut.island else in_disc_top).append(head.wire)
            continue
        foot, head = stack.wall(cut.outline, solid.low if inside else 0.0, solid.high if inside else top)
        (in_boss_bottom if inside and boss_below else in_disc_bottom).append(foot.wire)
        (in_boss_top if inside and boss_above else in_island_top if cut.island else in_disc_top).append(head.wire)
    if solid.boss is not None:
        ring = _disc(0.5 * solid.boss)
        if boss_below:
            foot, head = stack.wall(ring, solid.low, 0.0)
            stack.lid(solid.low, foot.wire, in_boss_bottom)
            in_disc_bottom.append(head.wire)
        if boss_above:
            foot, head = stack.wall(ring, top, solid.high)
            stack.lid(solid.high, head.wire, in_boss_top)
            in_disc_top.append(foot.wire)
    if solid.floor is not None:
        stack.lid(top, island_head.wire, in_island_top)
    stack.lid(0.0, contour_foot.wire, in_disc_bottom)
    stack.lid(top, contour_head.wire, in_disc_top)
    return reduce(_drill, solid.drills, stack.solid())


def stack_shape(stretches: Sequence[tuple[Outline, float, float]], bore: Outline | None) -> Shape:
    """Return the kernel's solid of prisms one above the other, with a hole through all of them where there is a bore.

    `stretches` are (outline, z below, z above), mm, from below; of two neighbouring outlines one has to lie within the
    other. Raises RegionError where a piece is too short for the kernel, or the kernel finds the solid unsound;
    TypeError for a polygon, ValueError for a periodic spline.
    """
    stack = Stack()
    low, high = stretches[0][1], stretches[-1][2]
    hole = None if bore is None else stack.wall(bore, low, high)
    walls = [stack.wall(outline, bottom, top) for outline, bottom, top in stretches]
    stack.lid(low, walls[0][0].wire, [] if hole is None else [hole[0].wire])
    stack.lid(high, walls[-1][1].wire, [] if hole is None else [hole[1].wire])
    for (below, above), (wall, following) in zip(pairwise(stretches), pairwise(walls), strict=True):
        wider = below[0].box()[2] > above[0].box()[2]
        outer, inner = (wall[1], following[0]) if wider else (following[0], wall[1])
        stack.lid(above[1], outer.wire, [inner.wire])
    return stack.solid()


def raise_shape(shape: Shape, z: float) -> Shape:
    """Solid moved up by z, mm, its faces rewritten there: a placement in the file would be read as an assembly."""
    if not z:
        return shape
    from OCP.BRepBuilderAPI import BRepBuilderAPI_Transform
    from OCP.gp import gp_Trsf, gp_Vec

    up = gp_Trsf()
    up.SetTranslation(gp_Vec(0.0, 0.0, z))
    return BRepBuilderAPI_Transform(shape, up, True).Shape()


def _contour(stack: Stack, outline: Outline, solid: Solid) -> tuple[Wire, Wire]:
    """Add the walls on the outermost outline, chamfers included; returns its lowest and its highest loop.

    Raises TypeError for the chamfer of a spline.
    """
    if not solid.chamfer:
        return stack.wall(outline, 0.0, solid.thickness)
    if not isinstance(outline, ArcSpline):
        raise TypeError("the chamfer of a spline is not a spline")
    c = solid.chamfer
    if (circle := outline.circle) is not None:
        outline = _circle_of_arcs(*circle)  # a whole circle's cone would have a seam, and no edge to be laid along it
    foot, head = stack.wall(outline, c, solid.thickness - c)
    inner = inset(outline, c)
    lowest, highest = stack.loop(inner, 0.0), stack.loop(inner, solid.thickness)
    stack.slope((lowest, inner, 0.0), (foot, outline, c))
    stack.slope((highest, inner, solid.thickness), (head, outline, solid.thickness - c))
    return lowest, highest


class Stack:
    """Faces of a solid under construction, which share their edges."""

    def __init__(self) -> None:
        self.faces: list[Shape] = []

    def loop(self, outline: Outline, z: float) -> Wire:
        """Closed wire of an outline at a height.

        Raises RegionError where the kernel makes no edge of a piece.
        """
        from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeEdge, BRepBuilderAPI_MakeVertex, BRepBuilderAPI_MakeWire

        curves = curves_of(outline, z)
        vertices = [BRepBuilderAPI_MakeVertex(point(start, z)).Vertex() for _, start in curves]
        maker = BRepBuilderAPI_MakeWire()
        edges = []
        for k, (curve, _) in enumerate(curves):
            ends = (vertices[k], vertices[(k + 1) % len(vertices)])
            # a spline is taken whole: by its ends alone a closed one would be nothing
            range_ = (curve.FirstParameter(), curve.LastParameter()) if hasattr(curve, "FirstParameter") else ()
            edge_maker = BRepBuilderAPI_MakeEdge(curve, *ends, *range_)
            if not edge_maker.IsDone():
                raise RegionError(f"Open CASCADE makes no edge of piece {k}: {edge_maker.Error().name}")
            edges.append(edge_maker.Edge())
            maker.Add(edges[-1])
        return Wire(maker.Wire(), edges, vertices)

    def wall(self, outline: Outline, low: float, high: float) -> tuple[Wire, Wire]:
        """Add the faces that stand on an outline between two heights; returns the loops below and above."""
        from OCP.BRepPrimAPI import BRepPrimAPI_MakePrism
        from OCP.gp import gp_Vec

        foot = self.loop(outline, low)
        prism = BRepPrimAPI_MakePrism(foot.wire, gp_Vec(0.0, 0.0, high - low))
        self.faces += _parts(prism.Shape(), "face")
        edges = [prism.LastShape(edge) for edge in foot.edges]
        vertices = [prism.LastShape(vertex) for vertex in foot.vertices]
        return foot, Wire(_cast(prism.LastShape(), "wire"), edges, vertices)

    def slope(self, inner: tuple[Wire, ArcSpline, float], outer: tuple[Wire, ArcSpline, float]) -> None:
        """Add cones and planes at 45 degrees between an outline and its parallel inside.

        `inner` is (loop, parallel, height, mm) and `outer` (loop, outline, height, mm).
        """
        from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeEdge

        (near, small, z), (far, large, z_far) = inner, outer
        pairs = zip(near.vertices, far.vertices, strict=True)
        ribs = [BRepBuilderAPI_MakeEdge(_cast(a, "vertex"), _cast(b, "vertex")).Edge() for a, b in pairs]
        count = len(ribs)
        for k in range(count):
            edges = near.edges[k], ribs[(k + 1) % count], far.edges[k], ribs[k]
            self.face(_chamfer_surface(k, (small, z), (large, z_far)), edges)

    def face(self, surface: Shape, edges: Sequence[Shape], holes: Sequence[Sequence[Shape]] = ()) -> None:
        """Add the face of a surface within edges and outside those of its holes, which follow one another.

        An edge without a curve in the surface's parameters gets one, and is as wide as it lies beside the surface.
        """
        from OCP.BRep import BRep_Builder
        from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeWire
        from OCP.ShapeFix import ShapeFix_Edge, ShapeFix_Face
        from OCP.TopoDS import TopoDS_Face

        face = TopoDS_Face()
        builder = BRep_Builder()
        builder.MakeFace(face, surface, CONFUSION)
        for loop in (edges, *holes):
            maker = BRepBuilderAPI_MakeWire()
            for edge in loop:
                maker.Add(_cast(edge, "edge"))
            builder.Add(face, maker.Wire())
        for edge in _parts(face, "edge"):
            fix = ShapeFix_Edge()
            fix.FixAddPCurve(edge, face, False, CONFUSION)
            fix.FixSameParameter(edge, face)
            fix.FixVertexTolerance(edge, face)
        turned = ShapeFix_Face(face)
        turned.FixOrientation()
        self.faces.append(turned.Face())

    def lid(self, z: float, outer: Shape, inner: Sequence[Shape]) -> None:
        """Add a horizontal face within one wire and outside others, its holes."""
        from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeFace
        from OCP.gp import gp_Dir, gp_Pln

        maker = BRepBuilderAPI_MakeFace(gp_Pln(point((0.0, 0.0), z), gp_Dir(0.0, 0.0, 1.0)), outer)
        for wire in inner:
            maker.Add(_cast(wire.Reversed(), "wire"))
        self.faces.append(maker.Face())

    def solid(self) -> Shape:
        """Return the solid that the faces bound; raises RegionError where the kernel finds it unsound."""
        from OCP.BRep import BRep_Builder
        from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeSolid
        from OCP.BRepLib import BRepLib
        from OCP.ShapeFix import ShapeFix_Shell
        from OCP.TopoDS import TopoDS_Shell

        shell = TopoDS_Shell()
        builder = BRep_Builder()
        builder.MakeShell(shell)
        for face in self.faces:
            builder.Add(shell, face)
        turned = ShapeFix_Shell()
        turned.FixFaceOrientation(shell)
        solid = BRepBuilderAPI_MakeSolid(turned.Shell()).Solid()
        BRepLib.OrientClosedSolid_s(solid)
        return _sound(solid)


def _drill(shape: Shape, drill: Drill) -> Shape:
    """Cut a radial hole, from the shaft outward.

    Raises RegionError where the hole divides the solid, or the kernel finds it unsound.
    """
    from OCP.BRepAlgoAPI import BRepAlgoAPI_Cut
    from OCP.BRepPrimAPI import BRepPrimAPI_MakeCylinder
    from OCP.gp import gp_Ax2, gp_Dir

    along = gp_Dir(math.cos(drill.at), math.sin(drill.at), 0.0)
    axes = gp_Ax2(point((0.0, 0.0), drill.z), along, gp_Dir(0.0, 0.0, 1.0))
    tool = BRepPrimAPI_MakeCylinder(axes, 0.5 * drill.diameter, drill.reach).Shape()
    solids = _parts(BRepAlgoAPI_Cut(shape, tool).Shape(), "solid")
    if len(solids) != 1:
        raise RegionError(f"the set screw's hole leaves {len(solids)} bodies")
    return _sound(solids[0])


def _sound(solid: Shape) -> Shape:
    from OCP.BRepCheck import BRepCheck_Analyzer

    if not BRepCheck_Analyzer(solid).IsValid():
        raise RegionError("Open CASCADE finds the solid invalid: another tolerance may help")
    return solid


def _chamfer_surface(k: int, inner: tuple[ArcSpline, float], outer: tuple[ArcSpline, float]) -> Shape:
    """Surface of the chamfer of piece k: a plane, or the cone whose radius grows along its axis."""
    from OCP.Geom import Geom_ConicalSurface, Geom_Plane
    from OCP.gp import gp_Ax3, gp_Dir

    (_, z), (large, z_far) = inner, outer
    start, end = large.points[k], large.points[(k + 1) % large.count]
    rise = math.copysign(1.0, z_far - z)
    if bool(measures(large)[2][k]):
        along = (end - start) / math.hypot(*(end - start))
        normal = gp_Dir(float(along[1]), float(-along[0]), -rise)
        return Geom_Plane(gp_Ax3(point(start.tolist(), z_far), normal, gp_Dir(*along.tolist(), 0.0)))
    bulge = float(large.bulges[k])
    centre = centre_of(start, end, bulge)
    radius = float(measures(large)[1][k])
    c = abs(z_far - z)
    # a bow outward is narrower inside, one inward wider
    narrow, base, sense = (radius - c, z, rise) if bulge > 0.0 else (radius, z_far, -rise)
    # the surface's seam lies opposite the middle of the arc, where no edge of the face can meet it
    chord = math.copysign(1.0, bulge) * (end - start)
    towards = gp_Dir(float(-chord[1]), float(chord[0]), 0.0)
    axes = gp_Ax3(point(centre.tolist(), base), gp_Dir(0.0, 0.0, sense), towards)
    return Geom_ConicalSurface(axes, 0.25 * math.pi, narrow)


def _disc(radius: float) -> ArcSpline:
    return ArcSpline(np.array([[radius, 0.0], [-radius, 0.0]]), np.ones(2), EXACT)


def _circle_of_arcs(centre: tuple[float, float], radius: float) -> ArcSpline:
    """A circle as four arcs."""
    across = np.array([[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]])
    return ArcSpline(np.array(centre) + radius * across, np.full(4, math.tan(math.pi / 8.0)), EXACT)


def _is_within(outline: ArcSpline, diameter: float) -> bool:
    x_min, y_min, x_max, y_max = outline.box()
    return math.hypot(0.5 * (x_min + x_max), 0.5 * (y_min + y_max)) < 0.5 * diameter


def _parts(shape: Shape, kind: str) -> list[Shape]:
    """Faces, edges or solids of a shape, each once."""
    from OCP.TopAbs import TopAbs_ShapeEnum
    from OCP.TopExp import TopExp_Explorer

    explorer = TopExp_Explorer(shape, getattr(TopAbs_ShapeEnum, f"TopAbs_{kind.upper()}"))
    parts = []
    while explorer.More():
        parts.append(_cast(explorer.Current(), kind))
        explorer.Next()
    return parts


def _cast(shape: Shape, kind: str) -> Shape:
    """Return a shape as the kernel's class for its kind."""
    from OCP.TopoDS import TopoDS

    return getattr(TopoDS, f"{kind.capitalize()}_s")(shape)
