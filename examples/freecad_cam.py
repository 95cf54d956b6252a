"""A cam's contour from exact arcs in FreeCAD, extruded: `freecadcmd examples/freecad_cam.py` prints both areas."""

import Part
from FreeCAD import Vector

import camgeo

RECIPE = """
cam: {kind: support, p: 30 + 2*cos(2*t) + cos(3*t)}
"""


def areas() -> tuple[float, float]:
    """Area of the face that FreeCAD makes, and that of the edges."""
    edges = camgeo.design(camgeo.load(RECIPE)).edges(tolerance=0.001)
    made = []
    for edge in edges:
        if isinstance(edge, camgeo.Arc):
            made.append(Part.Arc(*(Vector(*point, 0) for point in (edge.start, edge.middle, edge.end))).toShape())
        elif isinstance(edge, camgeo.Line):
            made.append(Part.LineSegment(Vector(*edge.start, 0), Vector(*edge.end, 0)).toShape())
    solid = Part.Face(Part.Wire(made)).extrude(Vector(0, 0, 10))
    return solid.Volume / 10, edges.area


if __name__ in {"__main__", "freecad_cam"}:  # freecadcmd imports a script by its name
    print(*areas())
