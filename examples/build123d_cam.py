"""A cam's contour from exact arcs in build123d, extruded: `python examples/build123d_cam.py` prints both areas."""

from build123d import Edge, Face, Line, ThreePointArc, Wire, extrude

import camgeo

RECIPE = """
cam: {kind: support, p: 30 + 2*cos(2*t) + cos(3*t)}
"""


def areas() -> tuple[float, float]:
    """Area of the face that build123d makes, and that of the edges."""
    edges = camgeo.design(camgeo.load(RECIPE)).edges(tolerance=0.001)
    made: list[Edge] = []
    for edge in edges:
        if isinstance(edge, camgeo.Arc):
            made.append(ThreePointArc(edge.start, edge.middle, edge.end))
        elif isinstance(edge, camgeo.Line):
            made.append(Line(edge.start, edge.end))
    solid = extrude(Face(Wire(made)), amount=10)
    return solid.volume / 10, edges.area


if __name__ == "__main__":
    print(*areas())
