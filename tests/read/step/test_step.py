"""Parts read from STEP texts written by hand, as several CAD systems write them, and faults in them; no CAD kernel.

Holds: kin.read.step.faces.
"""

import contextlib
import math
import re

import numpy as np
import pytest
from support.stepfiles import Text, ring, stadium, swept, washer

from camgeo.testing import assert_closed, assert_watertight
from kin.read.errors import ReadError
from kin.read.files import kind_of
from kin.read.step.part21 import exchange
from kin.read.step.step import read_step

EGG = [(0.0, -10.0), (30.0, -10.0), (10.0, 25.0), (-10.0, 25.0), (-30.0, -10.0), (0.0, -10.0)]


def put(folder, text, name="part.step"):
    path = folder / name
    path.write_text(text, encoding="latin-1")
    return path


def refused(folder, text):
    with pytest.raises(ReadError) as caught:
        read_step(put(folder, text))
    return caught.value


def changed(text, pattern, replacement, count=1):
    found, number = re.subn(pattern, replacement, text, count=count)
    assert number == count
    return found


# --- sound files ----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("unit", ["mm", "m", "inch"])
@pytest.mark.parametrize("seam", [True, False])
def test_round_walls_with_a_seam_or_without_in_any_unit(tmp_path, unit, seam):
    solid = read_step(put(tmp_path, washer(20.0, 6.0, 8.0, unit=unit, seam=seam, at=(1.0, -2.0))))
    assert solid.faults == ()
    assert solid.misfit < 1e-12
    assert solid.prism
    assert (solid.z_min, solid.z_max) == pytest.approx((0.0, 8.0), abs=1e-12)
    assert solid.faces == pytest.approx((0.0, 8.0), abs=1e-12)
    assert solid.contour.area == pytest.approx(math.pi * 400, rel=1e-13)
    assert [hole.area for hole in solid.holes] == pytest.approx([math.pi * 36], rel=1e-13)
    assert solid.volume == pytest.approx(math.pi * 364 * 8, rel=1e-13)
    box = solid.contour.box
    assert (box.x_min, box.y_max) == pytest.approx((-19.0, 18.0), abs=1e-12)


@pytest.mark.parametrize("backwards", [False, True])
def test_lines_and_arcs_whichever_way_their_circles_run(tmp_path, backwards):
    solid = read_step(put(tmp_path, stadium(backwards=backwards)))
    assert solid.faults == ()
    assert solid.pieces == 4
    assert solid.contour.is_convex
    assert solid.volume == pytest.approx((200 + 25 * math.pi) * 4, rel=1e-13)


def test_a_swept_spline(tmp_path):
    solid = read_step(put(tmp_path, swept(EGG, None, 5)))
    assert solid.faults == ()
    node, weight = np.polynomial.legendre.leggauss(20)
    t = 0.5 * (node + 1)
    basis = np.array([math.comb(5, k) * t**k * (1 - t) ** (5 - k) for k in range(6)])
    slope = np.array([math.comb(4, k) * t**k * (1 - t) ** (4 - k) for k in range(5)])
    points, steps = np.array(EGG), 5 * np.diff(EGG, axis=0)
    (x, y), (u, v) = points.T @ basis, steps.T @ slope
    area = 0.25 * float(np.sum(weight * (x * v - y * u)))
    assert solid.contour.area == pytest.approx(area, rel=1e-12)
    assert solid.volume == pytest.approx(5 * area, rel=1e-12)


def test_a_rational_spline_is_the_conic_that_it_stands_for(tmp_path):
    # a whole circle as one rational Bezier of degree 5 (Piegl and Tiller, The NURBS Book, 7.5)
    control = [(0.0, -10.0), (40.0, -10.0), (20.0, 30.0), (-20.0, 30.0), (-40.0, -10.0), (0.0, -10.0)]
    solid = read_step(put(tmp_path, swept(control, [5.0, 1.0, 1.0, 1.0, 1.0, 5.0], 5)))
    assert solid.contour.area == pytest.approx(100 * math.pi, rel=1e-12)
    theta = np.linspace(0.0, 6.0, 7)
    assert np.allclose(solid.contour.support(theta).q, 10.0, rtol=0, atol=1e-12)


def test_sections_are_taken_where_they_are_asked_for(tmp_path):
    path = put(tmp_path, washer())
    solid = read_step(path, [2.0, 7.5])
    assert [one.height for one in solid.sections] == [2.0, 7.5]
    assert all(one.contour.area == pytest.approx(math.pi * 400) for one in solid.sections)
    with pytest.raises(ReadError, match=r"from z = 0 to 8 mm: it has no section at 9"):
        read_step(path, [9.0])


def test_a_section_where_walls_end_is_that_of_the_walls_above(tmp_path):
    text = Text()
    lower, low, _ = ring(text, (0.0, 0.0), 20.0, (0.0, 4.0), hole=False)
    upper, _, high = ring(text, (0.0, 0.0), 15.0, (4.0, 8.0), hole=False)
    inner, low_in, high_in = ring(text, (0.0, 0.0), 6.0, (0.0, 8.0), hole=True)
    down, up = text.plane((0, 0, 0.0), (0, 0, -1), (1, 0, 0)), text.plane((0, 0, 8.0), (0, 0, 1), (1, 0, 0))
    bottom = text.face([text.loop(f"-{low}"), text.loop(low_in, outer=False)], down)
    top = text.face([text.loop(high), text.loop(f"-{high_in}", outer=False)], up)
    solid = read_step(put(tmp_path, text.text([lower, upper, inner, bottom, top])), [4.0, 2.0])
    assert [one.contour.area for one in solid.sections] == pytest.approx([math.pi * 225, math.pi * 400])
    assert [one.holes[0].area for one in solid.sections] == pytest.approx([math.pi * 36, math.pi * 36])


def test_text_is_read_however_it_is_laid_out(tmp_path):
    text = washer()
    spread = text.replace(",", " ,\r\n  ").replace("#7=", "/* a comment; with #7= */ #7 = ")
    spread = spread.replace("MANIFOLD_SOLID_BREP('part'", "MANIFOLD_SOLID_BREP('it''s ;\\X2\\00E4\\X0\\ #3 (a) part'")
    assert read_step(put(tmp_path, spread)).volume == read_step(put(tmp_path, text)).volume


def test_assertions_and_suffixes(tmp_path):
    path = put(tmp_path, washer(), "PART.STP")
    assert kind_of(path) == "step"
    assert assert_watertight(path) == pytest.approx(math.pi * 364 * 8)
    assert assert_closed(path) == 0.0
    with pytest.raises(AssertionError, match=r"2 edges .* belongs to one face only"):
        assert_watertight(put(tmp_path, washer(lid=False)))


def test_values_of_an_exchange_file(tmp_path):
    body = "#1=A(1,-2.5E-1,.T.,$,*,#2,('x''y',(3.)),B(4.));\n#2=(C()D(5));\n"
    read = exchange(f"ISO-10303-21;\nHEADER;\nENDSEC;\nDATA;\n{body}ENDSEC;\nEND-ISO-10303-21;".encode(), tmp_path)
    assert read.instances[1]["A"] == (1, -0.25, "T", None, None, 2, ("x'y", (3.0,)), ("B", (4.0,)))
    assert read.instances[2] == {"C": (), "D": (5,)}


# --- faults ---------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("bytes_left", [0, 60, 400, 3000])
def test_a_file_cut_short(tmp_path, bytes_left):
    assert refused(tmp_path, washer()[:bytes_left]).reason in {"empty", "truncated", "syntax"}


@pytest.mark.parametrize(
    ("pattern", "replacement", "reason", "message"),
    [
        ("ISO-10303-21;", "solid", "syntax", "does not begin with"),
        (r"#1=", "#2=", "syntax", "is there twice"),
        (r"#1=", f"#{'9' * 5000}=", "range", "is beyond all numbers of instances"),
        (r"CIRCLE\('',#\d+", "CIRCLE('',#9999", "unsupported", "#9999 .*is no AXIS2"),
        (r"CIRCLE\('',(#\d+),[^)]*", r"CIRCLE('',\1", "syntax", r"#\d+ CIRCLE: has 2 values, 3 belong there"),
        (r"CIRCLE\('',(#\d+),[^)]*", r"CIRCLE('',\1,-3.", "range", r"#\d+ CIRCLE: a length of -3 mm"),
        (r"DIRECTION\('',\(0\.0", "DIRECTION('',(1.E400", "range", r"#\d+ DIRECTION: a value of inf"),
        (r"CIRCLE\('',(#\d+),[^)]*", r"CIRCLE('',\1,'big'", "syntax", r"CIRCLE: 'big' is not a number"),
        (r"CIRCLE\('',(#\d+),[^)]*", rf"CIRCLE('',\1,{'(' * 5000}{')' * 5000}", "range", "more than 64 brackets deep"),
        ("CYLINDRICAL_SURFACE", "TOROIDAL_SURFACE", "unsupported", r"#\d+ TOROIDAL_SURFACE: is none of PLANE"),
        ("CIRCLE", "HYPERBOLA", "unsupported", r"#\d+ HYPERBOLA: is none of"),
        (r"ADVANCED_FACE\('',\([^)]*\)", "ADVANCED_FACE('',()", "unsupported", r"#\d+ ADVANCED_FACE: it has no bounds"),
        ("MANIFOLD_SOLID_BREP", "BREP_WITH_VOIDS", "unsupported", "BREP_WITH_VOIDS: is none of MANIFOLD"),
        ("MANIFOLD_SOLID_BREP", "SHELL_BASED_SURFACE_MODEL", "empty", "it holds no solid"),
        (r"\.MILLI\.,\.METRE\.\)\);\n#902", ".FEMTO.,.METRE.));\n#902", "unsupported", "#901 .*is not a unit"),
        (r"\(#901,#902\)", "(#902)", "unsupported", "states no unit of length"),
        (r"(#\d+)=LINE", r"#899=MAPPED_ITEM('',$,$);\n\1=LINE", "unsupported", "#899 MAPPED_ITEM: is not read"),
        (r"CARTESIAN_POINT\('',\(20.0", "CARTESIAN_POINT('',(1.E99", "range", "a value of 1e.99"),
    ],
)
def test_what_is_not_read_is_named_by_its_number(tmp_path, pattern, replacement, reason, message):
    error = refused(tmp_path, changed(washer(), pattern, replacement))
    assert error.reason == reason, error
    assert re.search(message, error.message), error


def test_a_cone_whose_angle_has_no_unit(tmp_path):
    coned = changed(washer(), r"CYLINDRICAL_SURFACE\('',(#\d+),([^)]*)", r"CONICAL_SURFACE('',\1,\2,0.7")
    without = changed(coned, r"\(#901,#902\)", "(#901)")
    assert re.search(r"CONICAL_SURFACE: the file states no unit of plane angle", refused(tmp_path, without).message)
    read_step(put(tmp_path, changed(washer(), r"\(#901,#902\)", "(#901)")))


def test_two_solids(tmp_path):
    text = washer()
    brep = re.search(r"MANIFOLD_SOLID_BREP\('part',#\d+\);", text)[0]
    error = refused(tmp_path, text.replace("#900=", f"#899={brep}\n#900="))
    assert error.reason == "several"
    assert error.message.startswith("it holds 2 bodies, where one is expected; beside solid #")


def test_a_face_is_missing(tmp_path):
    solid = read_step(put(tmp_path, washer(lid=False)))
    assert len(solid.faults) == 1
    assert re.fullmatch(r"2 edges \(#\d+, #\d+\): each belongs to one face only", solid.faults[0])


def test_a_wall_is_missing(tmp_path):
    text = washer()
    faces = re.search(r"CLOSED_SHELL\('',\((#\d+),(#\d+)", text)
    solid = read_step(put(tmp_path, text.replace(f"({faces[1]},{faces[2]}", f"({faces[1]}")))
    assert solid.holes == ()
    assert any("belongs to one face only" in fault for fault in solid.faults)


def test_faces_that_look_inward(tmp_path):
    text = stadium()
    flipped = re.sub(r"(ADVANCED_FACE\(.*),\.T\.\)", r"\1,.F.)", text)
    assert flipped != text
    error = refused(tmp_path, flipped)
    assert "faces outward" in error.message
    lids = changed(text, r"PLANE\('',(#\d+)\)", r"PLANE('',\1)")
    up = re.findall(r"(#\d+)=DIRECTION\('',\(0\.0,0\.0,-1\.0\)\)", lids)[-1]
    solid = read_step(
        put(tmp_path, lids.replace(f"{up}=DIRECTION('',(0.0,0.0,-1.0))", f"{up}=DIRECTION('',(0.0,0.0,1.0))"))
    )
    assert any("at z = 0 mm looks into the solid" in fault for fault in solid.faults)


@pytest.mark.slow
@pytest.mark.parametrize("part", [washer(), washer(seam=False), stadium(), swept(EGG, None, 5)])
def test_each_face_that_is_turned_over_is_a_fault(tmp_path, part):
    """Also one that goes all round, whose section is a whole circle either way."""
    faces = list(re.finditer(r"(#\d+)=ADVANCED_FACE\(.*,\.([TF])\.\)", part))
    assert len(faces) >= 3
    assert read_step(put(tmp_path, part)).faults == ()
    for face in faces:
        start = face.start(2)
        turned = f"{part[:start]}{'F' if face[2] == 'T' else 'T'}{part[start + 1 :]}"
        try:
            faults = read_step(put(tmp_path, turned)).faults
        except ReadError as error:
            faults = (error.message,)
        assert any("wrong side of its bounds" in fault or "faces outward" in fault for fault in faults), face[1]


def test_an_edge_that_two_faces_run_along_the_same_way(tmp_path):
    text = washer(seam=False)
    uses = re.findall(r"#\d+=ORIENTED_EDGE\('',\*,\*,(#\d+),\.([TF])\.\)", text)
    edge, sense = uses[0]
    other = "F" if sense == "T" else "T"
    found = text.replace(f"*,{edge},.{other}.)", f"*,{edge},.{sense}.)")
    assert found != text
    solid = read_step(put(tmp_path, found))
    assert any("run along the same way by both its faces" in fault for fault in solid.faults)


@pytest.mark.parametrize("surface", ["CIRCLE", "CYLINDRICAL_SURFACE"])
def test_an_edge_off_its_wall(tmp_path, surface):
    error = refused(tmp_path, changed(washer(), rf"({surface}\('',#\d+,)20\.0", r"\g<1>20.01"))
    assert error.reason == "gap"
    wrong = {"CIRCLE": "EDGE_CURVE: ends beside its curve"}.get(surface, "ADVANCED_FACE: is bounded by edges beside it")
    assert re.search(rf"#\d+ {wrong}.* by 0\.01 mm, permitted is 1e-06", error.message)


def test_a_vertex_off_its_place(tmp_path):
    text = stadium()
    point = re.search(r"VERTEX_POINT\('',(#\d+)\)", text)[1]
    moved = changed(text, rf"{point}=CARTESIAN_POINT\('',\(-10\.0", f"{point}=CARTESIAN_POINT('',(-10.01")
    error = refused(tmp_path, moved)
    assert error.reason == "gap"
    assert re.search(r"#\d+ \w+: .* by 0\.01 mm, permitted is 1e-06", error.message)


def test_edges_that_do_not_follow_one_another(tmp_path):
    text = stadium()
    loop = re.search(r"EDGE_LOOP\('',\((#\d+),(#\d+),(#\d+),(#\d+)\)\)", text)
    crossed = text.replace(f"({','.join(loop.groups())})", f"({','.join(loop.group(1, 3, 2, 4))})", 1)
    error = refused(tmp_path, crossed)
    assert error.reason == "open"
    assert re.search(r"#\d+ EDGE_LOOP: edge #\d+ ends at .*, .* mm from where #\d+ starts", error.message)


def test_random_damage_is_never_a_crash(tmp_path):
    random = np.random.default_rng(1)
    text = stadium()
    for _ in range(150):
        letters = list(text)
        for place in random.integers(0, len(letters), 3):
            letters[place] = chr(random.integers(32, 127))
        with contextlib.suppress(ReadError):  # any other error fails
            read_step(put(tmp_path, "".join(letters)))


def test_an_arc_that_goes_the_long_way_round(tmp_path):
    """The circle of an edge of a lid turned over: the same circle, and the rest of it."""
    text = stadium()
    circles = re.findall(r"#(\d+)=CIRCLE\('',#(\d+)", text)
    assert len(circles) == 4
    for _, axes in circles:
        z = re.search(rf"#{axes}=AXIS2_PLACEMENT_3D\('',#\d+,#(\d+),", text)[1]
        solid = read_step(
            put(tmp_path, changed(text, rf"#{z}=DIRECTION\('',\(0(\.0)?,0(\.0)?,1", f"#{z}=DIRECTION('',(0.,0.,-1"))
        )
        (fault,) = solid.faults
        assert re.fullmatch(r"face #\d+: an arc of its bounds goes the wrong way round", fault)
