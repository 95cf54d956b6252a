"""STL files read back: closed and oriented by counting edges, exact volume, tolerances, second readers.

Holds: camgeo.files.mesh, camgeo.files.precision, camgeo.files.triangulate.
"""

import math
from collections import Counter
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from support.cases import examples
from support.heavy import manifold3d, trimesh
from support.outlines import bored

from camgeo.files.errors import RegionError
from camgeo.files.precision import SINGLE
from camgeo.files.prism import bore_polygon, extruded_mesh
from camgeo.files.sides import sides
from camgeo.files.triangulate import clip_region, disc, ring, star_shaped
from camgeo.fit.nodes import ToleranceError
from camgeo.fit.pieces import Bound, Polygon
from camgeo.formats import stl

NONE = Bound(0.0, 0.0)
fit_tolerance, single_precision_bound = SINGLE.fit_tolerance, SINGLE.bound
RECORD = np.dtype([("normal", "<f4", 3), ("vertices", "<f4", (3, 3)), ("attribute", "<u2")])


def write_stl(path, polygon, *, bore=None, about="", **shape):
    mesh, facts = extruded_mesh(bored(polygon, bore), **shape, precision=SINGLE)
    stl.write_stl(path, mesh, about=about)
    return facts


def single(points):
    return np.asarray(points, dtype=np.float32).astype(np.float64)


def support_cam(n, harmonic=2.0, shaft=(0.0, 0.0)):
    """p = 25 + harmonic cos 3t about a shaft: convex for harmonic < 25/8."""
    t = np.linspace(0.0, 2.0 * np.pi, n, endpoint=False)
    p, slope = 25.0 + harmonic * np.cos(3.0 * t), -3.0 * harmonic * np.sin(3.0 * t)
    x, y = p * np.cos(t) - slope * np.sin(t), p * np.sin(t) + slope * np.cos(t)
    return np.column_stack((x - shaft[0], y - shaft[1]))


def lobed(n):
    """Concave between its lobes, star-shaped about the shaft."""
    t = np.linspace(0.0, 2.0 * np.pi, n, endpoint=False)
    r = 20.0 + 8.0 * np.cos(5.0 * t)
    return np.column_stack((r * np.cos(t), r * np.sin(t)))


def hooked(n):
    """A C round the shaft's disc, with an arm that hides part of itself: not star-shaped about the shaft."""
    t = np.linspace(0.25, 2.0 * np.pi - 0.25, n)
    outside = np.column_stack((30.0 * np.cos(t), 30.0 * np.sin(t)))
    inside = np.column_stack((20.0 * np.cos(t), 20.0 * np.sin(t)))[::-1]
    # a disc of radius 10 about the shaft, joined to the C at the left
    a = np.linspace(np.pi + 0.2, 3.0 * np.pi - 0.2, n)
    hub = np.column_stack((10.0 * np.cos(a), 10.0 * np.sin(a)))
    upper, lower = inside[inside[:, 1] > 3.0], inside[inside[:, 1] < -3.0]
    return np.concatenate((outside, lower, hub, upper))


SQUARE = np.array([[-10.0, -10.0], [10.0, -10.0], [10.0, 10.0], [-10.0, 10.0]])
SHAPES = {
    "convex": support_cam(242),
    "off centre": support_cam(300, shaft=(17.0, 7.5)),
    "lobed": lobed(200),
    "hooked": hooked(40),
    "square": SQUARE,
    "triangle": np.array([[30.0, 0.0], [-20.0, 30.0], [-20.0, -30.0]]),
    "collinear": np.array([[-10.0, -10.0], [0.0, -10.0], [5.0, -10.0], [10.0, -10.0], [10.0, 10.0], [-10.0, 10.0]]),
    # one long edge opposite many short ones
    "half disc": np.concatenate((support_cam(240, 0.0)[20:100], [[-20.0, -12.0], [20.0, -12.0]])),
}


def read(path):
    data = path.read_bytes()
    count = int.from_bytes(data[80:84], "little")
    assert len(data) == 84 + 50 * count
    return np.frombuffer(data, RECORD, offset=84)


def faults(records):
    """What is wrong with the solid: edges not paired, triangles without area, wrong normals."""
    found = []
    corners = [[tuple(corner) for corner in triangle] for triangle in records["vertices"].tolist()]
    edges = Counter((t[k], t[(k + 1) % 3]) for t in corners for k in range(3))
    if max(edges.values()) > 1:
        found.append("an edge runs twice the same way")
    if any((b, a) not in edges for a, b in edges):
        found.append("an edge has no partner")
    a, b, c = records["vertices"].astype(np.float64).transpose(1, 0, 2)
    cross = np.cross(b - a, c - a)
    size = np.linalg.norm(cross, axis=1)
    if not np.all(size > 0.0):
        found.append("a triangle has no area")
    elif np.abs(cross / size[:, None] - records["normal"]).max() > 1e-2 or np.any(
        np.einsum("ij,ij->i", cross, records["normal"]) <= 0.0
    ):
        found.append("a normal is wrong")
    return found


def volume(records):
    """Exact volume by the divergence theorem, in rational numbers."""
    total = Fraction(0)
    for triangle in records["vertices"].astype(np.float64).tolist():
        (ax, ay, az), (bx, by, bz), (cx, cy, cz) = [[Fraction(v) for v in corner] for corner in triangle]
        total += (az + bz + cz) * ((bx - ax) * (cy - ay) - (by - ay) * (cx - ax))
    return total / 6


def area(points):
    x, y = ([Fraction(v) for v in axis] for axis in single(points).T.tolist())
    return sum(x[i - 1] * y[i] - x[i] * y[i - 1] for i in range(len(x))) / 2


@pytest.mark.thin(6)
@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("bore", [None, 8.0])
def test_solid_is_closed_oriented_and_of_exact_volume(tmp_path, shape, bore):
    path = tmp_path / "cam.stl"
    facts = write_stl(path, Polygon(SHAPES[shape], NONE), bore=bore, thickness=8.25, tolerance=0.01)
    records = read(path)
    assert faults(records) == []
    n, m = len(SHAPES[shape]), 0
    plane = area(SHAPES[shape])
    if bore is not None:
        hole, _ = bore_polygon(bore, fit_tolerance(0.01, bore / 2))
        m = len(hole)
        plane -= area(hole)
    assert volume(records) == plane * Fraction(8.25)
    assert facts.vertices == n
    assert len(records) == (4 * (n + m) if bore else 4 * n - 4)
    z = records["vertices"][:, :, 2]
    assert set(np.unique(z).tolist()) == {0.0, 8.25}


@pytest.mark.slow
@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("bore", [None, 8.0])
def test_second_readers_agree(tmp_path, shape, bore):
    path = tmp_path / "cam.stl"
    write_stl(path, Polygon(SHAPES[shape], NONE), bore=bore, thickness=8.25, tolerance=0.01, about="second readers")
    expected = float(volume(read(path)))
    mesh = trimesh.load(path)
    assert mesh.is_watertight
    assert mesh.is_winding_consistent
    assert mesh.euler_number == (2 if bore is None else 0)
    assert mesh.volume == pytest.approx(expected, rel=1e-12)
    solid = manifold3d.Manifold(
        manifold3d.Mesh(np.asarray(mesh.vertices, np.float32), np.asarray(mesh.faces, np.uint32))
    )
    assert solid.status() == manifold3d.Error.NoError
    assert solid.volume() == pytest.approx(expected, rel=1e-6)
    assert solid.genus() == (0 if bore is None else 1)


def test_faults_are_seen(tmp_path):
    """The checks above on spoilt files: each must be named."""
    path = tmp_path / "cam.stl"
    write_stl(path, Polygon(SQUARE, NONE), bore=8.0, thickness=8.0, tolerance=0.01)
    good = read(path)
    assert faults(good[:-1]) == ["an edge has no partner"]
    turned = good.copy()
    turned["vertices"][0] = good["vertices"][0][::-1]
    assert faults(turned) == ["an edge runs twice the same way", "an edge has no partner", "a normal is wrong"]
    flat = good.copy()
    flat["vertices"][0, 2] = flat["vertices"][0, 1]
    assert "a triangle has no area" in faults(flat)


@settings(max_examples=examples(150), deadline=None)
@given(
    st.lists(st.tuples(st.floats(5.0, 50.0), st.floats(0.05, 1.0)), min_size=4, max_size=40), st.booleans(), st.data()
)
def test_any_star_shaped_contour(tmp_path_factory, corners, with_bore, data):
    radius, share = np.array(corners).T
    angle = 2.0 * np.pi * np.cumsum(share / share.sum())
    assume(np.diff(angle, prepend=0.0).max() < 0.9 * np.pi)
    points = np.column_stack((radius * np.cos(angle), radius * np.sin(angle)))
    following = np.roll(points, -1, axis=0)
    gap = np.abs(np.linalg.det(np.stack((points, following), axis=1))) / np.hypot(*(following - points).T)
    bore = data.draw(st.floats(0.1, 1.9)) * float(gap.min()) if with_bore else None
    path = tmp_path_factory.mktemp("stl") / "cam.stl"
    write_stl(path, Polygon(points, NONE), bore=bore, thickness=3.0, tolerance=0.02)
    records = read(path)
    assert faults(records) == []
    hole = area(bore_polygon(bore, fit_tolerance(0.02, bore / 2))[0]) if with_bore else 0
    assert volume(records) == 3 * (area(points) - hole)


@pytest.mark.thin(4)
@pytest.mark.parametrize("triangles_of", [disc, clip_region])
@pytest.mark.parametrize("n", [3, 4, 5, 6, 7, 8, 33, 100])
def test_disc_of_any_count(triangles_of, n):
    points = single(support_cam(n, 0.0))
    triangles = triangles_of(points)
    assert triangles.shape == (n - 2, 3)
    a, b, c = points[triangles].transpose(1, 0, 2)
    assert np.all(sides(a, b, c) == 1)


@pytest.mark.parametrize("shape", SHAPES)
def test_a_bridge_gives_as_many_triangles_as_the_merge(shape):
    outer, inner = single(SHAPES[shape]), single(bore_polygon(8.0, 0.001)[0])
    assert clip_region(outer, [inner]).shape == ring(outer, inner).shape == (len(outer) + len(inner), 3)


def test_star_shaped():
    assert star_shaped(single(lobed(100)))
    assert not star_shaped(single(hooked(40)))
    assert not star_shaped(SQUARE[::-1])
    assert not star_shaped(SQUARE + 10.0)  # the origin is a corner
    assert not star_shaped(SQUARE + 30.0)
    twice = np.linspace(0.0, 4.0 * np.pi, 40, endpoint=False)
    assert not star_shaped(single(np.column_stack((twice * np.cos(twice), twice * np.sin(twice)))[1:]))


small = st.integers(-(2**24) + 1, 2**24 - 1)
coordinate = st.builds(lambda m, e: float(np.float32(m * 2.0**e)), small, st.integers(-60, 20))


@given(st.lists(st.tuples(coordinate, coordinate), min_size=3, max_size=3), st.sampled_from(range(4)))
def test_sides_are_exact(points, kind):
    a, b, c = (list(p) for p in points)
    if kind == 1:  # c on the line, or a rounding away from it
        c = [float(np.float32((a[0] + b[0]) / 2)), float(np.float32((a[1] + b[1]) / 2))]
    elif kind == 2:
        c = b
    elif kind == 3:
        b, c = [a[1], a[0]], [2.0 * a[1], float(np.nextafter(np.float32(2.0 * a[0]), np.float32(0.0)))]
    (ax, ay), (bx, by), (cx, cy) = [[Fraction(v) for v in p] for p in (a, b, c)]
    exact = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
    (found,) = sides(np.array([a]), np.array([b]), np.array([c]))
    assert found == (exact > 0) - (exact < 0)


@pytest.mark.thin(3)
@pytest.mark.parametrize(
    ("points", "bore", "message"),
    [
        (SQUARE[::-1].copy(), None, "the contour touches or crosses itself"),
        (SQUARE[[0, 2, 1, 3]], None, "the contour touches or crosses itself"),
        (SQUARE, 20.1, "the bore reaches the contour, or the contour touches or crosses itself"),
        (SQUARE, 30.0, "the bore reaches the contour, or the contour touches or crosses itself"),
        (np.add(SQUARE, (40.0, 0.0)), 10.0, "the bore reaches the contour, or the contour touches or crosses itself"),
        (np.add(SQUARE, (10.0, 0.0)), 10.0, "the bore reaches the contour, or the contour touches or crosses itself"),
    ],
)
def test_no_solid_from_what_is_no_region(tmp_path, points, bore, message):
    path = tmp_path / "cam.stl"
    with pytest.raises(RegionError, match=f"^{message}$"):
        write_stl(path, Polygon(points, NONE), bore=bore, thickness=5.0, tolerance=0.001)
    assert not path.exists()


class TestTolerance:
    @pytest.mark.parametrize(("size", "bound"), [(50.0, 2.697e-6), (5000.0, 3.452e-4), (1.0, 8.43e-8)])
    def test_single_precision_bound(self, size, bound):
        assert single_precision_bound(size) == pytest.approx(bound, rel=1e-3)

    @given(st.floats(1e-3, 1e6), st.floats(-1.0, 1.0), st.floats(-1.0, 1.0))
    def test_no_point_moves_farther(self, size, x, y):
        point = np.array([x, y]) * size
        assert math.hypot(*(point - single(point))) <= single_precision_bound(size) * (1.0 + 1e-12)

    def test_the_bound_is_reached(self):
        halfway = 50.0 + 0.5 * float(np.spacing(np.float32(50.0)))
        assert math.hypot(*[halfway - float(np.float32(halfway))] * 2) == single_precision_bound(50.0)

    def test_too_fine_a_tolerance_is_refused_with_what_can_be_held(self):
        with pytest.raises(ToleranceError) as caught:
            fit_tolerance(1e-6, 50.0)
        assert str(caught.value) == (
            "an STL of a contour that reaches 50 mm from the origin cannot hold 1e-06 mm: rounding to single precision "
            "alone moves points by 2.7e-06 mm; at least 3.38e-06 mm"
        )
        least = caught.value.reached
        assert 0.0 < fit_tolerance(least, 50.0) < 0.3 * least
        with pytest.raises(ToleranceError):
            fit_tolerance(math.nan, 50.0)

    @given(st.floats(0.01, 1e5))
    def test_the_figure_given_is_accepted(self, size):
        with pytest.raises(ToleranceError) as caught:
            fit_tolerance(0.0, size)
        assert fit_tolerance(caught.value.reached, size) > 0.0
        with pytest.raises(ToleranceError):
            fit_tolerance(0.9 * caught.value.reached, size)

    def test_the_bound_of_the_contour_counts(self, tmp_path):
        path = tmp_path / "cam.stl"
        facts = write_stl(path, Polygon(SHAPES["convex"], Bound(0.0005, 0.0009)), thickness=8.0, tolerance=0.00091)
        assert 0.0 < facts.displacement <= single_precision_bound(27.0)
        assert facts.bound == Bound(0.0005 + facts.displacement, 0.0009 + facts.displacement)
        path.unlink()
        with pytest.raises(ToleranceError, match=r"STL: the contour would be off by 0\.00090\d+ mm in single"):
            write_stl(path, Polygon(SHAPES["convex"], Bound(0.0005, 0.0009)), thickness=8.0, tolerance=0.0009)
        assert not path.exists()

    def test_the_thickness_counts(self, tmp_path):
        with pytest.raises(ToleranceError, match="STL: the thickness would be off by"):
            write_stl(tmp_path / "cam.stl", Polygon(SQUARE, NONE), thickness=1000.1, tolerance=1e-6)

    @pytest.mark.thin(4)
    @pytest.mark.parametrize("diameter", [3.0, 10.0, 12.7, 50.0])
    @pytest.mark.parametrize("tolerance", [0.1, 0.01, 1e-3, 1e-4, 1e-5])
    def test_bore_straddles_its_circle(self, tmp_path, diameter, tolerance):
        path = tmp_path / "cam.stl"
        facts = write_stl(path, Polygon(SQUARE * 4.0, NONE), bore=diameter, thickness=8.0, tolerance=tolerance)
        corners = np.unique(read(path)["vertices"][:, :, :2].reshape(-1, 2).astype(np.float64), axis=0)
        hole = corners[np.hypot(*corners.T) < 0.6 * diameter]
        hole = hole[np.argsort(np.arctan2(hole[:, 1], hole[:, 0]))]
        middle = 0.5 * (hole + np.roll(hole, -1, axis=0))
        out, into = np.hypot(*hole.T).max() - diameter / 2, diameter / 2 - np.hypot(*middle.T).min()
        assert max(out, into) <= tolerance
        assert out == pytest.approx(into, abs=2.0 * facts.displacement)
        # four edges fewer would not do
        fewer = math.pi / (len(hole) - 4)
        assert diameter / 2 * math.tan(fewer / 2) ** 2 > fit_tolerance(tolerance, diameter / 2)

    def test_points_that_fall_together_are_dropped(self, tmp_path):
        points = np.insert(SHAPES["convex"], [5, 9], SHAPES["convex"][[5, 9]] + 1e-9, axis=0)
        path, plain = tmp_path / "cam.stl", tmp_path / "plain.stl"
        facts = write_stl(path, Polygon(points, NONE), bore=8.0, thickness=8.0, tolerance=0.01)
        write_stl(plain, Polygon(SHAPES["convex"], NONE), bore=8.0, thickness=8.0, tolerance=0.01)
        assert facts.vertices == 242
        assert path.read_bytes() == plain.read_bytes()


@pytest.mark.parametrize("value", [0.0, -1.0, math.nan, math.inf])
def test_the_thickness_must_be_positive(tmp_path, value):
    with pytest.raises(ValueError, match=f"thickness must be > 0, not {value}"):
        write_stl(tmp_path / "cam.stl", Polygon(SQUARE, NONE), tolerance=0.01, thickness=value)


@pytest.mark.parametrize("value", [0.0, math.nan, math.inf])
def test_a_bore_has_an_extent(tmp_path, value):
    with pytest.raises(ValueError, match="arcs: "):
        write_stl(tmp_path / "cam.stl", Polygon(SQUARE, NONE), tolerance=0.01, thickness=8.0, bore=value)


def test_header_and_bytes(tmp_path):
    path, again = tmp_path / "cam.stl", tmp_path / "again.stl"
    for target in (path, again):
        write_stl(target, Polygon(SQUARE - 0.0, NONE), bore=8.0, thickness=8.0, tolerance=0.01, about="naïve " * 20)
    assert path.read_bytes() == again.read_bytes()
    header = path.read_bytes()[:80]
    assert not header.startswith(b"solid")
    assert header == (b"camgeo: binary STL in mm, z upwards. " + b"na?ve " * 20)[:80]
    coordinates = read(path)["vertices"].ravel()
    assert not np.any(np.signbit(coordinates[coordinates == 0.0]))


def test_numpy_stl_reads_it(tmp_path):
    stl = pytest.importorskip("stl", reason="numpy-stl is a further second reader, not needed")
    path = tmp_path / "cam.stl"
    write_stl(path, Polygon(SHAPES["lobed"], NONE), bore=8.0, thickness=8.25, tolerance=0.01)
    mesh = stl.mesh.Mesh.from_file(str(path))
    assert mesh.is_closed(exact=True)
    assert float(mesh.get_mass_properties()[0]) == pytest.approx(float(volume(read(path))), rel=1e-5)
