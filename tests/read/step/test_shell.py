"""Solids of a STEP file by their faces, with a B-spline surface on a box written by hand; no CAD kernel.

Holds: kin.read.step.shell, kin.read.step.patch, kin.contour.bezier.
"""

import math
import re

import numpy as np
import pytest
from support.stepfiles import Text, washer

from kin.read.errors import ReadError
from kin.read.files import read_solid
from kin.read.step.shell import read_shell

A, B, H, BUMP = 6.0, 4.0, 3.0, 2.5


def bump(text, *, weights=False, split=True, wide=1.0):
    """The surface z = H + BUMP s (1 - s) t (1 - t), x = A s, y = B t, of degree 2 by 3, with a knot at s = 1/2.

    It goes on beyond the box where it is wider.
    """
    # s (1 - s) has the Bernstein coefficients 0, 1/2, 0; with a double knot at 1/2 it has 0, 1/4, 1/4, 1/4, 0
    s = (
        [(0.0, 0.0), (0.25, 0.25), (0.5, 0.25), (0.75, 0.25), (1.0, 0.0)]
        if split
        else [(0.0, 0.0), (0.5, 0.5), (1.0, 0.0)]
    )
    t = [(0.0, 0.0), (1.0 / 3.0, 1.0 / 3.0), (2.0 / 3.0, 1.0 / 3.0), (1.0, 0.0)]
    rows = ",".join("(" + ",".join(text.point(wide * A * x, B * y, H + BUMP * p * q) for y, q in t) + ")" for x, p in s)
    knots = "(3,2,3),(4,4),(0.,0.5,1.),(0.,1.)" if split else "(3,3),(4,4),(0.,1.),(0.,1.)"
    if not weights:
        return text.add(f"B_SPLINE_SURFACE_WITH_KNOTS('',2,3,({rows}),.UNSPECIFIED.,.F.,.F.,.F.,{knots},.UNSPECIFIED.)")
    shares = ",".join(f"({','.join([str(float(weights))] * len(t))})" for _ in s[1:]) + ",(1.,1.,1.,1.)"
    return text.add(
        f"(BOUNDED_SURFACE()B_SPLINE_SURFACE(2,3,({rows}),.UNSPECIFIED.,.F.,.F.,.F.)"
        f"B_SPLINE_SURFACE_WITH_KNOTS({knots},.UNSPECIFIED.)GEOMETRIC_REPRESENTATION_ITEM()"
        f"RATIONAL_B_SPLINE_SURFACE(({shares}))REPRESENTATION_ITEM('')SURFACE())"
    )


def box(unit="mm", *, sense=True, **more):
    """A box whose upper face bulges."""
    text = Text(unit)
    plan = [(0.0, 0.0), (A, 0.0), (A, B), (0.0, B)]
    vertices = [[text.vertex(*xy, z) for xy in plan] for z in (0.0, H)]
    rows = [
        [text.edge(row[k], row[(k + 1) % 4], text.line((*plan[k], z), (*plan[(k + 1) % 4], z))) for k in range(4)]
        for row, z in zip(vertices, (0.0, H), strict=True)
    ]
    ribs = [text.edge(vertices[0][k], vertices[1][k], text.line((*plan[k], 0.0), (*plan[k], H))) for k in range(4)]
    normals = [(0, -1, 0), (1, 0, 0), (0, 1, 0), (-1, 0, 0)]
    faces = [
        text.face(
            [text.loop(rows[0][k], ribs[(k + 1) % 4], f"-{rows[1][k]}", f"-{ribs[k]}")],
            text.plane((*plan[k], 0.0), normals[k], (0, 0, 1)),
        )
        for k in range(4)
    ]
    down = [f"-{edge}" for edge in reversed(rows[0])]
    faces.append(text.face([text.loop(*down)], text.plane((0, 0, 0.0), (0, 0, -1), (1, 0, 0))))
    faces.append(text.face([text.loop(*rows[1])], bump(text, **more), same=sense))
    return text.text(faces)


def put(folder, text):
    path = folder / "part.step"
    path.write_text(text, encoding="latin-1")
    return path


def changed(text, pattern, replacement):
    found, number = re.subn(pattern, replacement, text, count=1)
    assert number == 1
    return found


def refused(folder, text):
    with pytest.raises(ReadError) as caught:
        read_shell(put(folder, text))
    return str(caught.value)


@pytest.mark.parametrize("unit", ["mm", "inch"])
@pytest.mark.parametrize(
    "more", [{}, {"split": False}, {"weights": 1.0}], ids=["split", "whole", "weights of one size"]
)
def test_a_bulging_box(tmp_path, unit, more):
    shell = read_shell(put(tmp_path, box(unit, **more)))
    assert shell.faults(1e-9) == []
    assert shell.volume == pytest.approx(A * B * (H + BUMP / 36.0), rel=1e-12)
    walls, floor = 2.0 * (A + B) * H, A * B
    assert walls + 2.0 * floor < shell.area < walls + 2.0 * floor + 1.0
    assert shell.units_mm == pytest.approx({"mm": 1.0, "inch": 25.4}[unit])


def test_its_patches(tmp_path):
    (patch,) = [face.surface for face in read_shell(put(tmp_path, box())).faces if hasattr(face.surface, "nets")]
    assert patch.nets.shape == (2, 1, 3, 4, 3)
    assert patch.u == pytest.approx([0.0, 0.5, 1.0])
    top = patch.nets[0, 0, -1]  # over s = 1/2
    assert top[:, 0] == pytest.approx(A / 2.0)
    assert top[:, 2] == pytest.approx([H, H + BUMP / 12.0, H + BUMP / 12.0, H])
    places = np.array([[A / 2.0, 0.1, H], [A / 2.0, -0.2, H], [A + 0.3, B + 0.4, H], [0.0, 1.0, H + 0.25]])
    assert patch.off(places) == pytest.approx([0.1, 0.2, 0.5, 0.25], abs=1e-12)


def test_a_washer_is_one_too(tmp_path):
    shell = read_shell(put(tmp_path, washer(20.0, 6.0, 8.0, at=(1.0, -2.0))))
    assert shell.faults(1e-9) == []
    assert shell.volume == pytest.approx(math.pi * 364 * 8, rel=1e-12)
    # chords of the rims stand in for arcs in the area of walls alone
    assert shell.area == pytest.approx(math.pi * (2 * 364 + 52 * 8), rel=1e-6)


@pytest.mark.parametrize(
    ("spoil", "told"),
    [
        (lambda text: changed(text, r"CLOSED_SHELL\('',\(#\d+,", "CLOSED_SHELL('',("), "belongs to one face only"),
        (lambda text: changed(text, r"(ADVANCED_FACE\('',\(#\d+\),#\d+),\.T\.", r"\1,.F."), "wrong side of its bounds"),
        (lambda text: changed(text, r"(FACE_OUTER_BOUND\('',#\d+),\.T\.", r"\1,.F."), "the same way by both its faces"),
        (lambda _: box(sense=False), "wrong side of its bounds"),
        (lambda _: box(wide=1.1), "ends 0.6 mm from a corner of its surface"),
    ],
    ids=["left out", "sense", "bound", "sense of the surface", "a part of its surface"],
)
def test_faults_of_a_shell(tmp_path, spoil, told):
    faults = read_shell(put(tmp_path, spoil(box()))).faults(1e-6)
    assert any(told in fault for fault in faults), faults


def test_edges_beside_their_surface(tmp_path):
    text = box()
    # the second control point along a border
    number = re.search(r"B_SPLINE_SURFACE_WITH_KNOTS\('',2,3,\(\(#\d+,(#\d+)", text)[1]
    place = rf"{number}=CARTESIAN_POINT\('',\(0\.0,([\d.]+),3\.0"
    moved = changed(text, place, rf"{number}=CARTESIAN_POINT('',(0.0,\1,3.3")
    shell = read_shell(put(tmp_path, moved))
    assert any("beside its edges" in fault for fault in shell.faults(0.05))
    # 3 t (1 - t)^2 is 27/64 at a quarter, which is looked at, and 4/9 at most
    assert shell.faults(0.14) == []


def test_what_is_not_read(tmp_path):
    assert "is rational" in refused(tmp_path, box(weights=2.0))
    assert "fit together" in refused(tmp_path, changed(box(), r"\(3,2,3\)", "(3,1,3)"))
    assert "not of one length" in refused(tmp_path, changed(box(), r"(KNOTS\('',2,3,\(\()#\d+,", r"\1"))
    solid = r"MANIFOLD_SOLID_BREP\('part',(#\d+)\);"
    two = changed(box(), solid, r"MANIFOLD_SOLID_BREP('part',\1);\n#990=MANIFOLD_SOLID_BREP('b',\1);")
    assert "2 bodies" in refused(tmp_path, two)
    # a disc's reader knows no B-spline surfaces
    with pytest.raises(ReadError, match="none of PLANE"):
        read_solid(put(tmp_path, box()))
