"""What a part's features become in DXF and STL files: by second readers, closed forms, and kin's verdict.

Holds: camgeo.files.errors, camgeo.output.part_geometry, camgeo.formats.three_mf, camgeo.output.solid.
"""

import math

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from support.cases import examples, few
from support.heavy import ezdxf, manifold3d, trimesh
from support.parts import files_of, found, recipe_of

from camgeo.files.errors import RegionError
from camgeo.files.precision import DECIMALS, SINGLE
from camgeo.files.prism import bore_polygon, loop_polygon
from camgeo.files.sides import sides
from camgeo.files.solid import inset
from camgeo.files.triangulate import _all_positive, _merge, region
from camgeo.part.shapes import disc, flattened, keyed, polygonal, slot
from kin.contour.contour import Contour

AREA = math.pi * (25**2 - 4 * 8 / 2)  # of p = 25 + 2 cos 3t: pi (m^2 + (1 - k^2) a^2/2)
PERIMETER = 50 * math.pi
FULL = (
    "{thickness: 8, bore: 12, keyway: {standard: din6885, at: 180}, hub: {diameter: 22, height: 10}, "
    "set_screw: {diameter: 3.4, at: 90}, bolts: {count: 3, circle: 31, hole: 3.2, start: 60}, "
    "dowel: {circle: 31, hole: 3, at: 200}, lightening: {largest: 2, wall: 1.5}, chamfer: 0.5, "
    "mark: {length: 3, width: 0.8, depth: 0.4}, wall: 1.2}"
)


def layers(path):
    by_layer = {}
    for entity in ezdxf.readfile(path).modelspace():
        by_layer.setdefault(entity.dxf.layer, []).append(entity)
    return by_layer


def keyed_area(r, b, t2):
    return math.pi * r * r + b * (r + t2) - (b / 2 * math.sqrt(r * r - b * b / 4) + r * r * math.asin(b / 2 / r))


# --- DXF ------------------------------------------------------------------------------------------------------------


@pytest.mark.slow
def test_drawing_has_each_feature_on_its_layer_as_cad_likes_it(tmp_path):
    design, files = files_of(recipe_of(FULL), tmp_path)
    drawn = layers(files["dxf"][0])
    assert set(drawn) == {"CUT", "BORE", "HOLES", "ENGRAVE", "REFERENCE"}
    assert [e.dxftype() for e in drawn["CUT"]] == ["LWPOLYLINE"]
    (bore,) = drawn["BORE"]
    assert bore.dxftype() == "LWPOLYLINE"
    assert bore.closed
    assert [round(b, 12) != 0 for *_, b in bore.get_points()] == [True, False, False, False]
    assert {e.dxftype() for e in drawn["HOLES"]} == {"CIRCLE"}
    holes = sorted((e.dxf.center.x, e.dxf.center.y, e.dxf.radius) for e in drawn["HOLES"])
    meant = sorted((*one.circle[0], one.circle[1]) for one in design.discs[0].body.openings if one.circle)
    assert np.allclose(holes, meant, rtol=0, atol=1e-12)
    assert len(holes) == 6
    (mark,) = drawn["ENGRAVE"]
    points = np.array([point[:2] for point in mark.get_points()])
    assert points[:, 1].min() == -points[:, 1].max() == -0.4
    assert points[:, 0].min() > 0
    comments = files["dxf"][0].read_text().split("\n")[:30]
    assert "camgeo hub: diameter 22, height 10, side top" in comments
    assert "camgeo chamfer: 0.5 at 45 degrees, both edges of CUT" in comments
    assert "camgeo mark: 0.4 deep" in comments


@pytest.mark.thin(6)
@pytest.mark.parametrize("version", ["R12", "R2000", "R2013"])
@pytest.mark.parametrize("bore", ["{hexagon: 12, at: 30}", "12, flat: {across: 10.5, at: 45}"])
def test_shaped_bores_in_any_version(tmp_path, version, bore):
    recipe = recipe_of(f"{{bore: {bore}, mark: {{as: cut, width: 1}}}}")
    recipe = recipe.replace("export.files", [{"dxf": {"as": "arcs", "version": version}}])
    _, files = files_of(recipe, tmp_path)
    path, checks = files["dxf"]
    assert set(layers(path)) == {"CUT", "BORE", "MARK", "REFERENCE"}
    assert {"bore", "mark"} <= checks.keys()
    assert not ezdxf.readfile(path).audit().has_errors


def test_inch_drawing_is_in_inches_and_its_solid_in_millimetres(tmp_path):
    cam = "units: inch\ncam: {kind: support, p: 1 + 0.05*cos(3*t)}\n"
    bolts = "bolts: {count: 4, circle: 1.3, hole: 0.125}"
    recipe = recipe_of(f"{{thickness: 0.25, bore: 0.5, keyway: {{width: 0.125, depth: 0.0625}}, {bolts}}}", cam=cam)
    _, files = files_of(recipe, tmp_path)
    bore = layers(files["dxf"][0])["BORE"][0]
    points = np.array([point[:2] for point in bore.get_points()])
    assert points[:, 0].max() == pytest.approx(0.25 + 0.0625, abs=1e-15)
    mesh = trimesh.load(files["stl"][0])
    assert mesh.bounds[1, 2] == pytest.approx(6.35)
    assert mesh.is_watertight


@pytest.mark.slow
def test_counter_clockwise_mirrors_every_feature(tmp_path):
    (tmp_path / "cw").mkdir()
    (tmp_path / "ccw").mkdir()
    _, cw = files_of(recipe_of(FULL), tmp_path / "cw")
    _, ccw = files_of(recipe_of(FULL, more="rotation: ccw\n"), tmp_path / "ccw")
    for layer in ("HOLES",):
        one = sorted((e.dxf.center.x, -e.dxf.center.y) for e in layers(cw["dxf"][0])[layer])
        other = sorted((e.dxf.center.x, e.dxf.center.y) for e in layers(ccw["dxf"][0])[layer])
        assert np.allclose(one, other, rtol=0, atol=1e-12)
    one, other = (trimesh.load(files["stl"][0]) for files in (cw, ccw))
    assert np.allclose(one.bounds[:, 1], -other.bounds[::-1, 1], atol=1e-6)
    assert one.volume == pytest.approx(other.volume, rel=1e-6)
    # the set screw's hole points to the other side
    height = 13.0
    sides = [np.sign(mesh.section([0, 0, 1], [0, 0, height]).vertices[:, 1].sum()) for mesh in (one, other)]
    assert sides[0] == -sides[1]


# --- STL: prisms ----------------------------------------------------------------------------------------------------


def test_prism_with_openings_by_trimesh_and_closed_forms(tmp_path):
    part = (
        "{thickness: 8, bore: 12, keyway: din6885, bolts: {count: 5, circle: 32, hole: 4}, mark: {as: cut, width: 1}}"
    )
    files_of(recipe_of(part), tmp_path)
    mesh = trimesh.load(tmp_path / "part.stl")
    assert mesh.is_watertight
    assert mesh.is_winding_consistent
    assert mesh.euler_number == 2 - 2 * 7
    area = AREA - keyed_area(6, 4, 1.8) - 5 * math.pi * 4 - (3 + math.pi / 4)
    assert mesh.volume == pytest.approx(8 * area, rel=1e-4)  # arcs of keyway and slot are chords inside them


@pytest.mark.parametrize("outline", [keyed(6, 4, 1.8, 0.7), flattened(6, 10.5, 2), polygonal(6, 10, 0.1), slot(3, 9, 2),
                                     disc("", "HOLES", (5.0, 3.0), 2.0).outline])  # fmt: skip
@pytest.mark.parametrize("tolerance", [0.1, 1e-3, 1e-5])
def test_polygons_of_outlines_keep_their_tolerance(outline, tolerance):
    polygon, off = loop_polygon(outline, tolerance)
    assert off <= tolerance
    exact = Contour.from_bulges(outline.points, outline.bulges)
    edges = Contour.from_vertices(polygon).sample(16)
    worst = max(exact.distance(edges).max(), Contour.from_vertices(polygon).distance(exact.sample(400)).max())
    assert worst <= tolerance * (1 + 1e-6)
    assert worst == pytest.approx(off, rel=0.05, abs=1e-12)


SQUARE = np.array([[30, -30], [30, 30], [-30, 30], [-30, -30]], dtype=float)


def covers_once(outer, holes):
    triangles = region(outer, holes)
    points = np.concatenate([outer, *holes])
    assert len(triangles) == len(points) + 2 * len(holes) - 2
    a, b, c = points[triangles].transpose(1, 0, 2)
    areas = 0.5 * ((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0])
    assert (sides(a, b, c) == 1).all()
    inner = sum(abs(Contour.from_vertices(hole).area) for hole in holes)
    assert areas.sum() == pytest.approx(Contour.from_vertices(outer).area - inner, rel=1e-9)


@settings(max_examples=examples(60), deadline=None)
@given(st.integers(2, 9), st.integers(3, 9), st.floats(0.02, 0.9), st.randoms(use_true_random=False))
def test_regions_with_holes_are_covered_once(count, corners, turn, random):
    cells = [(x, y) for x in (-20, 0, 20) for y in (-20, 0, 20)]
    angle = turn + np.arange(corners) * 2 * np.pi / corners
    ring = np.column_stack([np.cos(angle), np.sin(angle)])
    holes = []
    for x, y in random.sample(cells, count):
        hole = (np.array([x, y]) + random.uniform(1, 9.5) * ring).astype(np.float32).astype(float)
        holes.append(hole)
    covers_once(SQUARE, holes)


@pytest.mark.thin(3)
@pytest.mark.parametrize("corners", few([3, 4, 5, 7, 24], 3))
@pytest.mark.parametrize("turn", [0.0, 0.5, math.pi / 4])
@pytest.mark.parametrize("side", [3, 5, 9])
def test_rows_of_equal_holes_have_bridges(corners, turn, side):
    """Corners of all holes in line, and more holes than the square has corners to bridge them to."""
    angle = turn + np.arange(corners) * 2 * np.pi / corners
    ring = np.round(np.column_stack([np.cos(angle), np.sin(angle)]) * 1.5, 3)
    places = np.linspace(-24, 24, side)
    covers_once(SQUARE, [np.array([x, y]) + ring for x in places for y in places])


@pytest.mark.parametrize("other", [(3.0, 3.0), (8.0, 0.0), (8.0, 1.0), (8.0, 8.0), (26.0, 0.0), (28.0, 0.0)])
def test_holes_that_meet_each_other_or_the_rim_have_no_region(other):
    square = np.array([[4, -4], [4, 4], [-4, 4], [-4, -4]], dtype=float)
    with pytest.raises(RegionError, match="a hole reaches another"):
        region(SQUARE, [square, square + other])


def test_openings_in_line_leave_no_flat_triangle():
    """Sides of all squares of a grid lie on its lines, and so do 73 of the ears clipped between them."""
    square = np.array([[0, 0], [1, 0], [1, 1], [0, 1]], dtype=float)
    covers_once(SQUARE, [np.add(square, (x, y)) for x in range(-28, 28, 2) for y in range(-28, 28, 2)])


@pytest.mark.parametrize("number", few(range(60), 20))
def test_random_parts_with_holes_are_covered_once_at_any_tolerance(number):
    """Grids, bolt circles and scattered holes, round, square and with corners in line, in a round or lobed rim."""
    random = np.random.default_rng(number)
    tolerance = 10.0 ** -random.integers(3, 10)
    precision = SINGLE if tolerance > 5e-5 and random.random() < 0.5 else DECIMALS
    # as large as 4000 corners of the rim allow
    radius = min(30.0, 12.0 * tolerance * 10.0 ** random.uniform(2.0, 5.5))
    lobes = random.choice([0.0, 0.02, 0.3])
    angle = np.arange(max(12, math.ceil(math.pi / math.sqrt(tolerance / radius)))) * 2 * np.pi
    angle = angle / len(angle) + random.choice([0.0, 0.3])
    rim = radius * (1 + lobes * np.cos(random.integers(2, 6) * angle))
    outer, _ = precision.rounded(np.column_stack([rim * np.cos(angle), rim * np.sin(angle)]))
    reach = radius * (1 - lobes)
    match random.integers(3):
        case 0:
            row = np.linspace(-0.42 * reach, 0.42 * reach, random.integers(3, 7))
            places, size = [(x, y) for x in row for y in row], 0.4 * (row[1] - row[0])
        case 1:
            turn = 2 * np.pi * np.arange(random.integers(3, 13)) / 12 + random.choice([0.0, 0.2])
            around = 0.65 * reach * np.column_stack([np.cos(turn), np.sin(turn)])
            places, size = [(0.0, 0.0), *around], 0.15 * reach
        case _:
            places, size = [(0.3 * reach, 0.0)], 0.1 * reach
            for place in random.uniform(-0.6 * reach, 0.6 * reach, (20, 2)):
                if min(math.dist(place, other) for other in places) > 2.2 * size:
                    places.append(tuple(place))
    holes = []
    for place in places:
        width = size * random.choice([0.8, random.uniform(0.2, 0.95)])
        square = 0.7 * width * np.array([[1, -1], [1, 0.2], [1, 1], [-0.3, 1], [-1, 1], [-1, -1]])
        hole = square if random.random() < 0.5 else bore_polygon(2 * width, tolerance / 2)[0]
        holes.append(precision.rounded(hole + place)[0])
    covers_once(outer, holes)


# --- STL: solids ----------------------------------------------------------------------------------------------------


def expected_volume(side):
    """Closed forms of disc, chamfer, hub, holes, mark and screw hole."""
    c, bore = 0.5, keyed_area(6, 4, 1.8)
    disc_volume = 8 * AREA - 2 * (PERIMETER * c * c / 2 - math.pi * c**3 / 3)
    hub = (2 if side == "both" else 1) * 6 * (math.pi * 121 - bore)
    y = 1.7 * np.sin((np.arange(20000) + 0.5) / 20000 * math.pi - math.pi / 2)
    weight = 2 * (1.7**2 - y * y) * math.pi / 20000  # height 2 sqrt(r^2 - y^2), dy = sqrt(r^2 - y^2) da
    screw = float(np.sum(weight * (np.sqrt(121 - y * y) - np.sqrt(36 - y * y))))
    mark = 0.4 * (0.8 * (3 - 0.8) + math.pi * 0.16)
    return disc_volume + hub - 8 * (bore + 3 * math.pi * 1.6**2) - screw - mark


@pytest.mark.slow
@pytest.mark.parametrize("side", ["top", "bottom", "both"])
def test_solid_by_trimesh_manifold3d_and_closed_forms(tmp_path, side):
    part = (
        "{thickness: 8, bore: 12, keyway: {standard: din6885, at: 180}, "
        f"hub: {{diameter: 22, height: 6, side: {side}}}, "
        "set_screw: {diameter: 3.4, at: 90}, bolts: {count: 3, circle: 31, hole: 3.2, start: 60}, chamfer: 0.5, "
        "mark: {length: 3, width: 0.8, depth: 0.4}}"
    )
    design, files = files_of(recipe_of(part), tmp_path)
    path, checks = files["stl"]
    assert {
        "watertight",
        "bore",
        "holes",
        "mark",
        "thickness",
        "hub",
        "chamfer",
        "set-screw",
        "volume",
    } <= checks.keys()
    mesh = trimesh.load(path)
    assert mesh.is_watertight
    assert mesh.is_winding_consistent
    assert mesh.euler_number == 2 - 2 * 5  # bore, three bolts, and the screw's hole
    assert mesh.bounds[:, 2] == pytest.approx([design.discs[0].body.bottom, design.discs[0].body.top])
    assert mesh.volume == pytest.approx(expected_volume(side), abs=checks["volume"].limit)
    again = manifold3d.Manifold(manifold3d.Mesh64(np.asarray(mesh.vertices, float), np.asarray(mesh.faces, np.uint64)))
    assert again.status() == manifold3d.Error.NoError
    assert again.volume() == pytest.approx(mesh.volume, rel=1e-9)
    assert again.genus() == 5
    # a chamfer's facets stand at 45 degrees, all of them
    x, y, z = mesh.triangles_center.T
    band = (np.hypot(x, y) > 18.0) & (((z > 0) & (z < 0.5)) | ((z > 7.5) & (z < 8)))
    slanted = np.abs(mesh.face_normals[band & (np.abs(mesh.face_normals[:, 2] % 1.0) > 0.1), 2])
    assert slanted.size > 100
    assert np.abs(slanted - math.sqrt(0.5)).max() < 2e-3


@pytest.mark.slow
@pytest.mark.parametrize("bore", ["{square: 9, at: 20}", "{hexagon: 10}", "10, flat: {across: 9, at: 70}"])
def test_screw_and_bolts_through_the_hub_of_a_shaped_bore(tmp_path, bore):
    part = (
        f"{{thickness: 8, bore: {bore}, hub: {{diameter: 32, height: 6}}, set_screw: {{diameter: 3, at: 70}}, "
        "bolts: {count: 3, circle: 23, hole: 4, start: 10}, wall: 1}"
    )
    _, files = files_of(recipe_of(part), tmp_path)
    mesh = trimesh.load(files["stl"][0])
    assert mesh.is_watertight
    assert mesh.euler_number == 2 - 2 * 5
    bolts = mesh.section([0, 0, 1], [0, 0, 13.5])
    assert len(bolts.discrete) == 5  # hub, bore, three holes


@pytest.mark.slow
def test_solids_have_the_same_bytes_each_time(tmp_path):
    written = []
    for name in ("a", "b"):
        (tmp_path / name).mkdir()
        _, files = files_of(recipe_of(FULL), tmp_path / name)
        written.append([path.read_bytes() for path, _ in files.values()])
    assert written[0] == written[1]


def test_inset_of_a_square_and_its_limit():
    square = np.array([[5.0, -5.0], [5.0, 5.0], [-5.0, 5.0], [-5.0, -5.0]])
    assert np.allclose(inset(square, 2.0), square * 0.6)
    with pytest.raises(RegionError, match=r"too sharp for a chamfer of 5\.1 mm"):
        inset(square, 5.1)


# --- anything that passes its walls is a sound part -----------------------------------------------------------------


def angles():
    return st.integers(-180, 180)


@st.composite
def part_texts(draw):
    """Parts of all kinds, crowded ones among them."""
    bore = draw(st.sampled_from(["", "8", "12", "14.5", "{square: 9, at: 20}", "{hexagon: 11}"]))
    keys = ["thickness: 8"]
    if bore:
        keys.append(f"bore: {bore}")
    if bore and "{" not in bore:
        shape = draw(st.sampled_from(["", "keyway: {standard: din6885, at: ANGLE}", "flat: {across: 7.1, at: ANGLE}"]))
        if shape and not (shape.startswith("flat") and bore != "8"):
            keys.append(shape.replace("ANGLE", str(draw(angles()))))
    if draw(st.booleans()):
        side, height = draw(st.sampled_from(["top", "bottom", "both"])), draw(st.sampled_from([4, 7.5]))
        keys.append(f"hub: {{diameter: {draw(st.sampled_from([20, 23, 30]))}, height: {height}, side: {side}}}")
        if bore and draw(st.booleans()):
            keys.append(f"set_screw: {{diameter: 2.5, at: {draw(angles())}}}")
    if draw(st.booleans()):
        circle, hole = draw(st.sampled_from([26, 33, 38])), draw(st.sampled_from([2, 4.3]))
        keys.append(
            f"bolts: {{count: {draw(st.integers(1, 5))}, circle: {circle}, hole: {hole}, start: {draw(angles())}}}"
        )
    if draw(st.booleans()):
        keys.append(f"dowel: {{circle: {draw(st.sampled_from([28, 36]))}, hole: 3, at: {draw(angles())}}}")
    if draw(st.booleans()):
        keys.append(
            draw(st.sampled_from(["lightening: {largest: 2, wall: 1}", "lightening: {ring: 5, wall: 1, start: 20}"]))
        )
    if draw(st.booleans()):
        keys.append(f"chamfer: {draw(st.sampled_from([0.3, 1, 3]))}")
    if draw(st.booleans()):
        keys.append(f"mark: {{as: {draw(st.sampled_from(['engrave', 'cut']))}, length: 2.5, width: 0.7}}")
    if draw(st.booleans()):
        keys.append(f"wall: {draw(st.sampled_from([0.5, 1.5]))}")
    return "{" + ", ".join(keys) + "}"


@pytest.mark.slow
@settings(max_examples=examples(14), deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(part_texts(), st.sampled_from(["cw", "ccw"]))
def test_a_part_passes_every_check_or_is_refused_by_name(tmp_path, part, rotation):
    recipe = recipe_of(part, more=f"rotation: {rotation}\n")
    design, checks = found(recipe)
    if design.only_surface.contour is None:
        failed = [check for check in checks.values() if not check.ok]
        assert {check.name for check in failed} <= {"wall", "chamfer", "lightening"}
        for check in failed:
            if check.name == "wall":
                assert " and " in check.detail
                assert " mm" in check.detail
        return
    files_of(recipe, tmp_path)


def test_two_loops_round_the_origin_are_merged_whatever_corner_is_their_first():
    """By the angles of their edges, without a search for ears."""
    for first in (0, 7, 20):
        outer = np.roll(round_loop(31, 9.0), first, axis=0)
        inner = np.roll(round_loop(17, 4.0), 2 * first, axis=0)
        merged = _merge(outer, inner)
        assert _all_positive(np.concatenate([outer, inner]), merged)
        assert len(merged) == 31 + 17


def round_loop(count, radius):
    at = np.linspace(0.0, 2.0 * np.pi, count, endpoint=False) + 0.1
    return radius * np.column_stack([np.cos(at), np.sin(at)])
