"""Printable bodies as meshes: closed forms, a second reader, their places; the judge of bodies and planted faults."""

import itertools
import math

import numpy as np
import pytest
from support.cases import few
from support.heavy import trimesh
from support.parts import member_of

from camgeo.capabilities.mechanism.assembly import Plate, PrintBody
from camgeo.capabilities.mechanism.making import build_assembly
from camgeo.capabilities.mechanism.meshes import GAP, body_mesh, layout, mirror, pose_matrix, print_pose
from camgeo.capabilities.mechanism.shapes import bar
from camgeo.files.errors import RegionError
from camgeo.files.precision import DECIMALS, SINGLE
from camgeo.fit.nodes import ToleranceError
from camgeo.fit.pieces import ArcSpline, Bound, Polygon
from camgeo.output.job import Job
from camgeo.recipe.loading import load_text
from camgeo.synthesis.design import designed
from kin.contour.contour import Contour
from kin.mechanism.clearance import Slab
from kin.mechanism.printed import judge_body

NONE = Bound(0.0, 0.0)
E = 0.01


def disc(x, y, r):
    return ArcSpline(np.array([[x + r, y], [x - r, y]]), np.ones(2), NONE)


def box(x0, y0, x1, y1):
    return ArcSpline(np.array([[x0, y0], [x1, y0], [x1, y1], [x0, y1]], dtype=float), np.zeros(4), NONE)


BAR = box(0.0, 0.0, 40.0, 20.0)
HOLE = disc(10.0, 10.0, 4.0)
BODIES = {
    "a pin on a bar": ([Plate(BAR, (HOLE,), 0.0, 4.0), Plate(disc(30.0, 10.0, 5.0), (), 4.0, 12.0)], 1),
    "a hole overlap": ([Plate(BAR, (HOLE,), 0.0, 4.0), Plate(BAR, (), 4.0, 12.0)], 0),
    "three storeys with one bore": (
        [
            Plate(BAR, (HOLE,), 0.0, 4.0),
            Plate(box(0.0, 0.0, 20.0, 20.0), (HOLE,), 4.0, 12.0),
            Plate(disc(10.0, 10.0, 6.0), (HOLE,), 12.0, 13.3),
        ],
        1,
    ),
    "the same walls on both": (
        [Plate(disc(0.0, 0.0, 10.1), (disc(0.0, 0.0, 4.0),), low, low + 4.1) for low in (0.0, 4.1)],
        1,
    ),
}
OVERLAPPING = [
    Plate(BAR, (HOLE,), 0.0, 4.0),
    Plate(box(20.0, -5.0, 60.0, 25.0), (), 2.0, 4.0),
    Plate(disc(10.0, 10.0, 2.0), (), 0.0, 6.0),
]


def body(plates, name="body", **more):
    return PrintBody(name, tuple(plates), **more)


def exact(plates):
    """Volume of plates that do not overlap, and the area of their walls."""
    volume = sum((p.outline.area - sum(h.area for h in p.holes)) * (p.high - p.low) for p in plates)
    return volume, sum(2.0 * math.pi * 30.0 * (p.high - p.low) for p in plates)


def as_trimesh(mesh):
    return trimesh.Trimesh(mesh.points, mesh.triangles, process=False)


def slabs(one):
    def contour(outline):
        return Contour.from_bulges(outline.points, outline.bulges)

    return [Slab(contour(p.outline), tuple(map(contour, p.holes)), p.low, p.high) for p in one.plates]


def failing(mesh, one, tolerance=E):
    corners = mesh.points[mesh.triangles] if hasattr(mesh, "points") else mesh
    checks = judge_body(one.name, corners, slabs(one), tolerance, "body.stl")
    assert all(one.name in check.detail for check in checks)
    return {check.name for check in checks if not check.ok}


@pytest.mark.slow
@pytest.mark.parametrize("precision", [SINGLE, DECIMALS], ids=["stl", "3mf"])
@pytest.mark.parametrize("name", BODIES)
def test_plates_become_one_closed_body_of_their_volume(name, precision):
    plates, handles = BODIES[name]
    one = body(plates)
    mesh, off = body_mesh(one, tolerance=E, precision=precision)
    assert 0.0 < off <= E
    read = as_trimesh(mesh)
    assert read.is_watertight
    assert read.is_winding_consistent
    assert read.euler_number == 2 - 2 * handles
    volume, walls = exact(plates)
    assert read.volume == pytest.approx(mesh.volume, rel=1e-9)
    assert mesh.volume == pytest.approx(volume, abs=off * walls)
    assert np.array_equal(mesh.points, precision.nearest(mesh.points))
    assert failing(mesh, one) == set()
    again, _ = body_mesh(one, tolerance=E, precision=precision)
    assert np.array_equal(again.points, mesh.points)
    assert np.array_equal(again.triangles, mesh.triangles)


@pytest.mark.slow
@pytest.mark.parametrize("precision", few([SINGLE, DECIMALS], 2), ids=["stl", "3mf"])
def test_crossing_walls_that_go_on_through_storeys_leave_no_slivers(precision):
    """Arms of a base: each storey by itself would round the corners where they cross in its own way."""
    ends = [
        (91.035, 0.0),
        (133.274, 206.75),
        (170.09, 148.309),
        (148.437, -50.642),
        (161.3, 152.9),
        (112.425, -137.333),
    ]
    for first, second in itertools.combinations(ends, 2):
        arms = [disc(0.0, 0.0, 16.3), bar((0.0, 0.0), first, 32.6), bar((0.0, 0.0), second, 32.6)]
        plates = [
            Plate(arm, (disc(0.0, 0.0, radius),), low, high)
            for low, high, radius in ((0.0, 2.8, 9.35), (2.8, 6.0, 5.85))
            for arm in arms
        ]
        mesh, _ = body_mesh(body(plates), tolerance=E, precision=precision)
        read = as_trimesh(mesh)
        assert read.is_watertight
        assert read.euler_number == 0


SLANTED = """
cam: {kind: support, p: 25 + sin(3*t) + 13/15*sin(3*t)*cos(2*t), shaft: [9.65, 0.831]}
part: {thickness: 8, bore: {hexagon: 9}}
linkage:
  kind: four-bar
  ground: 76.481
  coupler: 79.102
  rocker: 123.475
  dyads:
    - {kind: rrr, point: [75.484, 3.813], ground: [188.578, -99.672], links: [101.29, 158.912]}
    - {kind: rrp, on: previous, point: [84.81, 11.181], link: 171.84, through: [138.318, 124.086], direction: 92.47}
    - {kind: rpr, on: coupler, point: [3.706, -6.773], ground: [181.009, 147.426]}
"""


@pytest.mark.slow
def test_corners_that_are_one_once_rounded_leave_nothing_open():
    """The edge of an arm passes under a rail at a slant: three pairs of corners lie within a millionth of a mm."""
    recipe = load_text(SLANTED, "c.yaml")
    design = designed(recipe)
    base = member_of(build_assembly(recipe, design, Job.of(recipe, design).fits[0].within("arcs", E)), "base").body()
    mesh, off = body_mesh(base, tolerance=E, precision=SINGLE)
    assert off <= E
    assert as_trimesh(mesh).is_watertight
    assert failing(mesh, base) == set()


def test_plates_may_overlap_and_fill_each_other_s_holes_in_part():
    """The pin of radius 2 stands free in the hole of radius 4, a piece of its own, unless a plate below holds it."""
    with pytest.raises(RegionError, match="body: its plates make 2 separate bodies, where one is expected"):
        body_mesh(body(OVERLAPPING), tolerance=E, precision=DECIMALS)
    held = body([*OVERLAPPING, Plate(BAR, (), -1.0, 0.0)])
    mesh, _ = body_mesh(held, tolerance=E, precision=DECIMALS)
    assert as_trimesh(mesh).is_watertight
    assert failing(mesh, held) == set()


@pytest.mark.parametrize(
    "second", [Plate(BAR, (), 4.1, 8.0), Plate(box(40.0, 20.0, 60.0, 30.0), (), 0.0, 4.0)], ids=["above", "at a corner"]
)
def test_plates_that_do_not_hang_together(second):
    with pytest.raises(RegionError, match=r"separate bodies|does not close"):
        body_mesh(body([Plate(BAR, (), 0.0, 4.0), second]), tolerance=E, precision=DECIMALS)


def test_a_polygon_is_taken_as_it_stands_with_its_own_bound():
    t = np.linspace(0.0, 2.0 * np.pi, 50, endpoint=False)
    vertices = 20.0 * np.column_stack((np.cos(t), np.sin(t)))
    one = body([Plate(Polygon(vertices, Bound(0.004, 0.002)), (), 0.0, 5.0)])
    mesh, off = body_mesh(one, tolerance=E, precision=SINGLE)
    assert 0.004 < off < 0.00401
    assert len(mesh.points) == 100
    with pytest.raises(ToleranceError, match=r"an outline would be off by 0\.00400"):
        body_mesh(one, tolerance=0.004, precision=SINGLE)


def test_what_an_stl_cannot_hold_is_refused():
    one = body([Plate(box(0.0, 0.0, 100.1, 20.0), (), 0.0, 4.0)])
    with pytest.raises(ToleranceError, match="an STL"):
        body_mesh(one, tolerance=1e-6, precision=SINGLE)
    assert body_mesh(one, tolerance=1e-6, precision=DECIMALS)[1] <= 1e-6


# --- places -----------------------------------------------------------------------------------------------------------


def test_bodies_are_laid_flat_apart_and_at_positive_places():
    shapes = [*(plates for plates, _ in BODIES.values()), [Plate(box(-1.0, -1.0, 1.0, 1.0), (), -3.0, 9.0)]] * 3
    # a knob on a thin stem, drawn stem down
    shapes.append([Plate(disc(5.0, 5.0, 2.0), (), 0.0, 9.0), Plate(disc(5.0, 5.0, 8.0), (), 9.0, 12.0)])
    meshes = [body_mesh(body(plates), tolerance=E, precision=DECIMALS)[0] for plates in shapes]
    places = layout(meshes)
    boxes = []
    for mesh, place in zip(meshes, places, strict=True):
        assert np.linalg.det(place[:3]) == 1.0
        points = mesh.points @ place[:3] + place[3]
        assert points[:, 2].min() == 0.0
        assert (points[:, :2].min(axis=0) >= GAP).all()
        boxes.append((points.min(axis=0), points.max(axis=0)))
    for k, (low, high) in enumerate(boxes):
        for low_too, high_too in boxes[:k]:
            apart = np.maximum(low - high_too, low_too - high)[:2]
            assert apart.max() >= GAP - 1e-9
    wide, deep = np.max([high for _, high in boxes], axis=0)[:2]
    assert max(wide, deep) < 2.5 * min(wide, deep)
    assert places[-1][2, 2] == -1.0  # the knob lies on its face
    assert places[0][2, 2] == 1.0
    assert all(np.array_equal(a, b) for a, b in zip(places, layout(meshes), strict=True))


@pytest.mark.parametrize("size", [3.3, 7.1, 11.7, 40.2])
def test_a_plain_plate_stays_as_it_is(size):
    """Its two faces are triangulated apart, and their areas may differ by rounding."""
    mesh, _ = body_mesh(
        body([Plate(disc(1.0, 2.0, size), (disc(1.0, 1.0, 1.0),), 0.3, 2.0)]), tolerance=E, precision=SINGLE
    )
    assert print_pose(mesh)[0][2, 2] == 1.0


def test_flat_and_back():
    mesh, _ = body_mesh(
        body([Plate(disc(5.0, 5.0, 2.0), (), 1.0, 9.0), Plate(disc(5.0, 5.0, 8.0), (), 9.0, 12.0)]),
        tolerance=E,
        precision=SINGLE,
    )
    turn, lift = print_pose(mesh)
    lying = mesh.points @ turn + lift
    assert (lying[:, 2].min(), lying[:, 2].max()) == (0.0, 11.0)
    assert np.allclose((lying - lift) @ turn, mesh.points, rtol=0.0, atol=1e-12)


def test_standing_turns_about_z_and_shifts():
    place = pose_matrix(np.array([3.0, -2.0, 0.5 * math.pi]))
    point = np.array([1.0, 0.0, 7.0]) @ place[:3] + place[3]
    assert point == pytest.approx([3.0, -1.0, 7.0])


def test_mirrored_bodies_and_motions():
    one = body(BODIES["a pin on a bar"][0], pose=np.array([[1.0, 2.0, 0.3], [4.0, 5.0, -0.6]]))
    other = mirror(one)
    assert np.array_equal(other.pose, [[1.0, -2.0, -0.3], [4.0, -5.0, 0.6]])
    (mesh, _), (glass, _) = (body_mesh(each, tolerance=E, precision=DECIMALS) for each in (one, other))
    assert glass.volume == pytest.approx(mesh.volume, rel=1e-9)
    assert np.allclose(glass.points[:, 1].min(), -mesh.points[:, 1].max())
    assert failing(glass, other) == set()
    assert "outline" in failing(glass, body([Plate(disc(20.0, -10.0, 11.0), (), 0.0, 4.0), *other.plates[1:]]))


# --- planted faults ---------------------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def sound():
    one = body(BODIES["three storeys with one bore"][0], "rocker")
    return one, body_mesh(one, tolerance=E, precision=DECIMALS)[0]


def spoilt(mesh, change):
    corners = mesh.points[mesh.triangles]
    return change(corners)


LEAF = np.array([[30.0, 10.0, 2.0], [31.0, 10.0, 2.0], [30.0, 11.0, 2.0]])
FAULTS = {
    "a triangle less": (lambda c: c[1:], "watertight"),
    "a triangle flipped": (lambda c: np.concatenate([c[:1, ::-1], c[1:]]), "watertight"),
    "inside out": (lambda c: c[:, ::-1], "watertight"),
    "a triangle twice": (lambda c: np.concatenate([c, c[:1]]), "watertight"),
    "inches": (lambda c: c / 25.4, "thickness"),
    "raised": (lambda c: c + np.array([0.0, 0.0, 0.02]), "thickness"),
    "shifted": (lambda c: c + np.array([0.02, 0.0, 0.0]), "outline"),
    "wider": (lambda c: c * [1.001, 1.0, 1.0], "outline"),
    "mirrored": (lambda c: (c * [1.0, -1.0, 1.0])[:, ::-1], "outline"),
    "a foot longer": (lambda c: np.where(c == [[[-1.0, -1.0, 0.0]]], -0.02, c), "thickness"),
    "leaning": (lambda c: c + 0.005 * (c[..., 2:] - 6.65) * np.array([1.0, 0.0, 0.0]), "outline"),
    "a leaf inside": (lambda c: np.concatenate([c, [LEAF, LEAF[::-1]]]), "watertight"),
    "upper storey turned": (lambda c: np.where(c[..., 2:] > 12.5, c * [1.01, 1.01, 1.0], c), "outline"),
}


@pytest.mark.parametrize("name", FAULTS)
def test_fault_of_a_body(sound, name):
    one, mesh = sound
    change, caught = FAULTS[name]
    assert caught in failing(spoilt(mesh, change), one)


def test_the_check_says_what_is_wrong_with_the_mesh(sound):
    """Of a closed mesh that lacks one triangle three edges have one triangle alone."""
    one, mesh = sound
    corners = spoilt(mesh, lambda c: c[1:])
    first = judge_body(one.name, corners, slabs(one), E, "body.stl")[0]
    assert (first.value, first.detail) == (1, f"{one.name}; 3 edges with one triangle")
    assert judge_body(one.name, spoilt(mesh, lambda c: c), slabs(one), E, "body.stl")[0].detail == one.name


MEANT = {
    "a hole that is not there": lambda p: Plate(p.outline, (*p.holes, disc(30.0, 10.0, 2.0)), p.low, p.high),
    "no bore": lambda p: Plate(p.outline, (), p.low, p.high),
    "a bore too wide": lambda p: Plate(p.outline, (disc(10.0, 10.0, 4.03),), p.low, p.high),
    "a bore moved": lambda p: Plate(p.outline, (disc(10.03, 10.0, 4.0),), p.low, p.high),
    "a bar too long": lambda p: Plate(box(0.0, 0.0, 40.03, 20.0), p.holes, p.low, p.high),
    "a corner cut": lambda p: Plate(
        ArcSpline(np.array([[0.0, 0], [40, 0], [40, 19.9], [39.9, 20], [0, 20]]), np.zeros(5), NONE),
        p.holes,
        p.low,
        p.high,
    ),
}


@pytest.mark.parametrize("name", MEANT)
def test_a_body_that_is_another_one(sound, name):
    one, mesh = sound
    assert "outline" in failing(mesh, body([MEANT[name](one.plates[0]), *one.plates[1:]], "rocker"))


def test_a_plate_left_out_is_seen_where_plates_overlap():
    plates = [Plate(BAR, (), 0.0, 4.0), Plate(box(20.0, -5.0, 60.0, 25.0), (), 0.0, 4.0)]
    whole = body(plates)
    mesh, _ = body_mesh(whole, tolerance=E, precision=DECIMALS)
    assert failing(mesh, whole) == set()
    part, _ = body_mesh(body(plates[:1]), tolerance=E, precision=DECIMALS)
    assert failing(part, whole) == {"outline"}
    holed, _ = body_mesh(
        body([Plate(BAR, (disc(10.0, 10.0, 3.0),), 0.0, 4.0), plates[1]]), tolerance=E, precision=DECIMALS
    )
    assert failing(holed, whole) == {"outline"}


def column(corners, low=0.0, high=8.0):
    """Triangles of a prism over a convex polygon (n, 2)."""
    n = len(corners)
    floor, roof = (np.column_stack([corners, np.full(n, z)]) for z in (low, high))
    after = np.roll(np.arange(n), -1)
    sides = [[floor, floor[after], roof[after]], [floor, roof[after], roof]]
    ends = [[[e[0], e[i], e[i + 1]][::way] for i in range(1, n - 1)] for e, way in ((roof, 1), (floor, -1))]
    return np.concatenate([*(np.stack(side, axis=1) for side in sides), *map(np.array, ends)])


SQUARE = np.array([[0.0, 0.0], [20.0, 0.0], [20.0, 20.0], [0.0, 20.0]])
BLOCK = body([Plate(box(0.0, 0.0, 20.0, 20.0), (), 0.0, 8.0)])


@pytest.mark.parametrize("sense", [1.0, -1.0])
@pytest.mark.parametrize(("share", "caught"), [(0.9999, set()), (1.0001, {"thickness"})])
def test_heights_are_held_to_the_tolerance_at_either_end(sense, share, caught):
    off = sense * share * E
    assert failing(column(SQUARE), BLOCK) == set()
    assert failing(column(SQUARE, low=off), BLOCK) == caught
    assert failing(column(SQUARE, high=8.0 + off), BLOCK) == caught


@pytest.mark.parametrize("sense", [1.0, -1.0])
@pytest.mark.parametrize(("share", "caught"), [(0.9999, set()), (1.0001, {"outline"})])
def test_outlines_are_held_to_the_tolerance(sense, share, caught):
    assert failing(column(SQUARE + np.array([sense * share * E, 0.0])), BLOCK) == caught


@pytest.mark.parametrize("others", [[], [Plate(box(-3.0, -3.0, 3.0, 3.0), (), 0.0, 8.0)]], ids=["alone", "in a union"])
def test_a_polygon_for_a_disc_is_seen_in_the_middle_of_its_edges(others):
    """All corners lie on the circle, and those of the circle on the polygon."""
    meant = body([Plate(disc(0.0, 0.0, 10.0), (), 0.0, 8.0), *others])
    for count, caught in ((6, {"outline"}), (68, {"outline"}), (72, set())):  # sagitta 10 (1 - cos(pi/n))
        angle = 2.0 * np.pi * np.arange(count) / count
        assert failing(column(10.0 * np.column_stack([np.cos(angle), np.sin(angle)])), meant) == caught


def test_walls_that_lean_by_more_than_the_tolerance_are_seen_though_they_are_right_midway():
    corners = column(SQUARE)
    for share, caught in ((0.99, set()), (1.02, {"outline"})):
        lean = share * E / (4.0 - 1.5 * E) * (corners[..., 2:] - 4.0)
        assert failing(corners + lean * [1.0, 0.0, 0.0], BLOCK) == caught


@pytest.mark.parametrize("end", [0.0, 8.0])
def test_walls_that_lean_towards_either_end_are_seen(end):
    corners = column(SQUARE)
    leaning = corners + 1.2 * E * (corners[..., 2:] == end) * [1.0, 0.0, 0.0]
    assert failing(leaning, BLOCK) == {"outline"}


def test_what_lies_between_levels_nearer_than_they_are_told_is_not_looked_at():
    plates = [Plate(box(0.0, 0.0, 20.0, 20.0), (), 0.0, 8.0)]
    for thick, caught in ((1.99 * E, set()), (2.01 * E, {"outline"})):
        step = Plate(box(0.0, 0.0, 30.0, 20.0), (), 4.0, 4.0 + thick)
        assert failing(column(SQUARE), body([*plates, step])) == caught


def test_corners_of_a_slab_that_lies_a_little_within_another_are_no_corners_of_the_body():
    meant = body([Plate(box(0.0, 0.0, 12.0, 20.0), (), 0.0, 8.0), Plate(box(11.5, 5.0, 20.0, 15.0), (), 0.0, 8.0)])
    mesh, _ = body_mesh(meant, tolerance=E, precision=DECIMALS)
    assert failing(mesh, meant) == set()


@pytest.mark.parametrize("filled", [False, True])
def test_no_body_is_meant_in_two_parts_above_each_other(filled):
    parts = [Plate(box(0.0, 0.0, 20.0, 20.0), (), low, low + 3.0) for low in (0.0, 5.0)]
    corners = column(SQUARE) if filled else np.concatenate([column(SQUARE, p.low, p.high) for p in parts])
    assert failing(corners, body(parts)) == {"outline"}


def test_a_triangle_without_area_is_a_fault_where_its_edges_are_none():
    corners = column(SQUARE)
    first = corners[0]  # split at the middle of its first edge, and the gap that this leaves closed by a straight line
    middle = 0.5 * (first[0] + first[1])
    split = [[first[0], middle, first[2]], [middle, first[1], first[2]], [first[1], middle, first[0]]]
    assert failing(np.concatenate([split, corners[1:]]), BLOCK) == {"watertight"}
