"""A cam's contour from exact arcs in CadQuery, extruded: `python examples/cadquery_cam.py` prints both areas."""

import cadquery as cq

import camgeo

RECIPE = """
cam: {kind: support, p: 30 + 2*cos(2*t) + cos(3*t)}
"""


def areas() -> tuple[float, float]:
    """Area of the face that CadQuery makes, and that of the edges."""
    edges = camgeo.design(camgeo.load(RECIPE)).edges(tolerance=0.001)
    made = []
    for edge in edges:
        if isinstance(edge, camgeo.Arc):
            made.append(cq.Edge.makeThreePointArc(*(cq.Vector(*p) for p in (edge.start, edge.middle, edge.end))))
        elif isinstance(edge, camgeo.Line):
            made.append(cq.Edge.makeLine(cq.Vector(*edge.start), cq.Vector(*edge.end)))
    face = cq.Face.makeFromWires(cq.Wire.assembleEdges(made))
    solid = cq.Solid.extrudeLinear(face, cq.Vector(0, 0, 10))
    return solid.Volume() / 10, edges.area


if __name__ == "__main__":
    print(*areas())
