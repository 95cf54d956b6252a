"""A cam's contour as arcs, and as one spline, in the OpenCASCADE kernel that CadQuery and build123d stand on.

`python examples/ocp_cam.py` prints the areas of the kernel's faces and those of the edges, mm^2; the kernel comes with
`pip install cadquery-ocp-novtk`.
"""

from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeEdge, BRepBuilderAPI_MakeFace, BRepBuilderAPI_MakeWire
from OCP.BRepGProp import BRepGProp
from OCP.GC import GC_MakeArcOfCircle
from OCP.Geom import Geom_BSplineCurve
from OCP.gp import gp_Pnt
from OCP.GProp import GProp_GProps
from OCP.TColgp import TColgp_Array1OfPnt
from OCP.TColStd import TColStd_Array1OfInteger, TColStd_Array1OfReal
from OCP.TopoDS import TopoDS_Edge

import camgeo

RECIPE = """
cam: {kind: support, p: 30 + 2*cos(2*t) + cos(3*t)}
"""


def areas() -> tuple[float, ...]:
    """Area of the kernel's face and of the edges, by arcs and then by a spline."""
    design = camgeo.design(camgeo.load(RECIPE))
    arcs, spline = design.edges(tolerance=0.001), design.edges(tolerance=0.001, form="spline")
    return face_area(arcs), arcs.area, face_area(spline), spline.area


def face_area(edges: camgeo.Edges) -> float:
    """Area of the face within the edges."""
    wire = BRepBuilderAPI_MakeWire()
    for edge in edges:
        wire.Add(kernel_edge(edge))
    found = GProp_GProps()
    # without a precision of its own the kernel is off by a thousandth along a spline
    BRepGProp.SurfaceProperties_s(BRepBuilderAPI_MakeFace(wire.Wire()).Face(), found, 1e-9)
    return float(found.Mass())


def kernel_edge(edge: camgeo.Line | camgeo.Arc | camgeo.Spline) -> TopoDS_Edge:
    """One edge as the kernel has it."""
    start, end = gp_Pnt(*edge.start, 0.0), gp_Pnt(*edge.end, 0.0)
    if isinstance(edge, camgeo.Line):
        return BRepBuilderAPI_MakeEdge(start, end).Edge()
    if isinstance(edge, camgeo.Arc):
        return BRepBuilderAPI_MakeEdge(GC_MakeArcOfCircle(start, gp_Pnt(*edge.middle, 0.0), end).Value()).Edge()
    points = TColgp_Array1OfPnt(1, len(edge.control))
    for i, (x, y) in enumerate(edge.control, 1):
        points.SetValue(i, gp_Pnt(x, y, 0.0))
    distinct = sorted(set(edge.knots))  # the kernel takes each knot once, and how often it counts
    knots, often = TColStd_Array1OfReal(1, len(distinct)), TColStd_Array1OfInteger(1, len(distinct))
    for i, knot in enumerate(distinct, 1):
        knots.SetValue(i, knot)
        often.SetValue(i, edge.knots.count(knot))
    return BRepBuilderAPI_MakeEdge(Geom_BSplineCurve(points, knots, often, edge.degree)).Edge()


if __name__ == "__main__":
    print(*areas())
