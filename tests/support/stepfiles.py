"""Small STEP texts for tests, written by hand: a prism over arcs, lines or a spline with round holes, in any unit."""

from __future__ import annotations

import math

HEAD = """ISO-10303-21;
HEADER;
FILE_DESCRIPTION((''),'2;1');
FILE_NAME('','',(''),(''),'','','');
FILE_SCHEMA(('CONFIG_CONTROL_DESIGN'));
ENDSEC;
DATA;
"""
TAIL = "ENDSEC;\nEND-ISO-10303-21;\n"
UNITS = {
    "mm": "(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.MILLI.,.METRE.))",
    "m": "(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT($,.METRE.))",
    "inch": "(CONVERSION_BASED_UNIT('INCH',#904)LENGTH_UNIT()NAMED_UNIT(*))",
}


class Text:
    """Instances as they are added; each method returns a reference such as #12."""

    def __init__(self, unit="mm"):
        self.lines = []
        self.unit = unit
        self.k = {"mm": 1.0, "m": 1e-3, "inch": 1 / 25.4}[unit]

    def add(self, what):
        self.lines.append(what)
        return f"#{len(self.lines)}"

    def point(self, x, y, z):
        return self.add(f"CARTESIAN_POINT('',({x * self.k!r},{y * self.k!r},{z * self.k!r}))")

    def direction(self, x, y, z):
        return self.add(f"DIRECTION('',({float(x)!r},{float(y)!r},{float(z)!r}))")

    def vertex(self, x, y, z):
        return self.add(f"VERTEX_POINT('',{self.point(x, y, z)})")

    def axes(self, x, y, z, up=1.0):
        return self.add(
            f"AXIS2_PLACEMENT_3D('',{self.point(x, y, z)},{self.direction(0, 0, up)},{self.direction(1, 0, 0)})"
        )

    def line(self, a, b):
        away = [q - p for p, q in zip(a, b, strict=True)]
        size = math.hypot(*away)
        vector = self.add(f"VECTOR('',{self.direction(*(v / size for v in away))},1.)")
        return self.add(f"LINE('',{self.point(*a)},{vector})")

    def circle(self, x, y, z, r):
        return self.add(f"CIRCLE('',{self.axes(x, y, z)},{r * self.k!r})")

    def edge(self, one, other, curve, same=True):
        return self.add(f"EDGE_CURVE('',{one},{other},{curve},.{'T' if same else 'F'}.)")

    def loop(self, *uses, outer=True):
        """Bound of edges, each with a minus before it where it is run through backwards."""
        turned = [
            self.add(f"ORIENTED_EDGE('',*,*,{use.lstrip('-')},.{'F' if use[0] == '-' else 'T'}.)") for use in uses
        ]
        ring = self.add(f"EDGE_LOOP('',({','.join(turned)}))")
        return self.add(f"FACE_{'OUTER_' if outer else ''}BOUND('',{ring},.T.)")

    def face(self, bounds, surface, same=True):
        return self.add(f"ADVANCED_FACE('',({','.join(bounds)}),{surface},.{'T' if same else 'F'}.)")

    def plane(self, at, normal, along):
        axes = self.add(f"AXIS2_PLACEMENT_3D('',{self.point(*at)},{self.direction(*normal)},{self.direction(*along)})")
        return self.add(f"PLANE('',{axes})")

    def cylinder(self, x, y, r):
        return self.add(f"CYLINDRICAL_SURFACE('',{self.axes(x, y, 0.0)},{r * self.k!r})")

    def text(self, faces):
        shell = self.add(f"CLOSED_SHELL('',({','.join(faces)}))")
        solid = self.add(f"MANIFOLD_SOLID_BREP('part',{shell})")
        self.add(f"ADVANCED_BREP_SHAPE_REPRESENTATION('',({solid}),#900)")
        body = [f"#{k}={line};" for k, line in enumerate(self.lines, start=1)]
        body += [
            "#900=(GEOMETRIC_REPRESENTATION_CONTEXT(3)GLOBAL_UNIT_ASSIGNED_CONTEXT((#901,#902))REPRESENTATION_CONTEXT('',''));",
            f"#901={UNITS[self.unit]};",
            "#902=(NAMED_UNIT(*)PLANE_ANGLE_UNIT()SI_UNIT($,.RADIAN.));",
            "#903=(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.MILLI.,.METRE.));",
            "#904=LENGTH_MEASURE_WITH_UNIT(LENGTH_MEASURE(25.4),#903);",
        ]
        return HEAD + "\n".join(body) + "\n" + TAIL


def ring(text, centre, r, heights, *, hole, seam=True):
    """Wall of a full circle: its face, and the edges of the circles below and above."""
    (x, y), (low, high) = centre, heights
    foot, head = text.vertex(x + r, y, low), text.vertex(x + r, y, high)
    below = text.edge(foot, foot, text.circle(x, y, low, r))
    above = text.edge(head, head, text.circle(x, y, high, r))
    if seam:
        rib = text.edge(foot, head, text.line((x + r, y, low), (x + r, y, high)))
        uses = [below, rib, f"-{above}", f"-{rib}"]
        if hole:
            uses = [f"-{below}", rib, above, f"-{rib}"]
        bounds = [text.loop(*uses)]
    elif hole:
        bounds = [text.loop(f"-{below}"), text.loop(above, outer=False)]
    else:
        bounds = [text.loop(below), text.loop(f"-{above}", outer=False)]
    return text.face(bounds, text.cylinder(x, y, r), same=not hole), below, above


def washer(outer=20.0, bore=6.0, thickness=8.0, *, unit="mm", seam=True, at=(0.0, 0.0), lid=True):
    """A round disc with a round bore."""
    text = Text(unit)
    wall, low, high = ring(text, at, outer, (0.0, thickness), hole=False, seam=seam)
    inner, low_in, high_in = ring(text, at, bore, (0.0, thickness), hole=True, seam=seam)
    faces = [wall, inner]
    down = text.plane((*at, 0.0), (0, 0, -1), (1, 0, 0))
    up = text.plane((*at, thickness), (0, 0, 1), (1, 0, 0))
    faces.append(text.face([text.loop(f"-{low}"), text.loop(low_in, outer=False)], down))
    if lid:
        faces.append(text.face([text.loop(high), text.loop(f"-{high_in}", outer=False)], up))
    return text.text(faces)


def stadium(half=10.0, r=5.0, thickness=4.0, *, backwards=False):
    """Two lines and two arcs, the arcs as circles or, backwards, as edges that run against theirs."""
    text = Text()
    corners = [(-half, -r), (half, -r), (half, r), (-half, r)]
    z = (0.0, thickness)
    vertices = [[text.vertex(*xy, h) for xy in corners] for h in z]
    ribs = [
        text.edge(vertices[0][k], vertices[1][k], text.line((*corners[k], 0.0), (*corners[k], thickness)))
        for k in range(4)
    ]
    rows = []
    for h, row in zip(z, vertices, strict=True):
        edges = []
        for k in range(4):
            one, other = row[k], row[(k + 1) % 4]
            if k % 2:
                circle = text.circle(half if k == 1 else -half, 0.0, h, r)
                edges.append(
                    f"-{text.edge(other, one, circle, same=False)}" if backwards else text.edge(one, other, circle)
                )
            else:
                edges.append(text.edge(one, other, text.line((*corners[k], h), (*corners[k + 1], h))))
        rows.append(edges)
    faces = []
    for k in range(4):
        if k % 2:
            surface = text.cylinder(half if k == 1 else -half, 0.0, r)
        else:
            surface = text.plane((*corners[k], 0.0), (0, -1 if k == 0 else 1, 0), (1, 0, 0))
        faces.append(text.face([text.loop(rows[0][k], ribs[(k + 1) % 4], turned(rows[1][k]), f"-{ribs[k]}")], surface))
    down = [turned(edge) for edge in reversed(rows[0])]
    faces.append(text.face([text.loop(*down)], text.plane((0, 0, 0.0), (0, 0, -1), (1, 0, 0))))
    faces.append(text.face([text.loop(*rows[1])], text.plane((0, 0, thickness), (0, 0, 1), (1, 0, 0))))
    return text.text(faces)


def turned(use):
    return use[1:] if use[0] == "-" else f"-{use}"


def swept(control, weights, degree, thickness=5.0):
    """Prism over one closed Bezier curve, rational or not, its one wall swept along the vertical."""
    text = Text()

    def curve(z):
        points = ",".join([text.point(x, y, z) for x, y in control])
        ends = f"({degree + 1},{degree + 1}),(0.,1.),.UNSPECIFIED."
        if weights is None:
            return text.add(f"B_SPLINE_CURVE_WITH_KNOTS('',{degree},({points}),.UNSPECIFIED.,.T.,.F.,{ends})")
        return text.add(
            f"(BOUNDED_CURVE()B_SPLINE_CURVE({degree},({points}),.UNSPECIFIED.,.T.,.F.)B_SPLINE_CURVE_WITH_KNOTS({ends})"
            f"CURVE()GEOMETRIC_REPRESENTATION_ITEM()RATIONAL_B_SPLINE_CURVE(({','.join(map(repr, weights))}))"
            "REPRESENTATION_ITEM(''))"
        )

    x, y = control[0]
    foot, head = text.vertex(x, y, 0.0), text.vertex(x, y, thickness)
    below, above = text.edge(foot, foot, curve(0.0)), text.edge(head, head, curve(thickness))
    rib = text.edge(foot, head, text.line((x, y, 0.0), (x, y, thickness)))
    vector = text.add(f"VECTOR('',{text.direction(0, 0, 1)},1.)")
    surface = text.add(f"SURFACE_OF_LINEAR_EXTRUSION('',{curve(0.0)},{vector})")
    faces = [
        text.face([text.loop(below, rib, f"-{above}", f"-{rib}")], surface),
        text.face([text.loop(f"-{below}")], text.plane((0, 0, 0.0), (0, 0, -1), (1, 0, 0))),
        text.face([text.loop(above)], text.plane((0, 0, thickness), (0, 0, 1), (1, 0, 0))),
    ]
    return text.text(faces)
