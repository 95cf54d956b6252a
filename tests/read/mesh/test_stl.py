"""STL files made with numpy, trimesh and manifold3d, read back; planted faults; damaged files refused."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from support.cases import examples
from support.meshfiles import BORE, HEIGHT, OUTER, N, binary, in_3mf, quads, ring, text
from support.solids import sound

from kin.contour.contour import Contour
from kin.read.errors import ReadError
from kin.read.files import read_solid, separate_bodies
from kin.read.mesh.mesh import weld, welded
from kin.read.mesh.threemf import read_3mf

if TYPE_CHECKING:
    from pathlib import Path

    from kin.read.mesh.stl import Solid


def test_a_ring(tmp_path: Path) -> None:
    solid = read_solid(binary(tmp_path / "cam.stl", ring()))
    assert solid.prism
    assert solid.edges[:2] == (0, 0)
    assert sound(solid)
    assert (solid.z_min, solid.z_max, solid.thickness, solid.height) == (0.0, 8.0, 8.0, 4.0)
    assert solid.triangles == 8 * N
    assert (solid.degenerate, solid.duplicate) == (0, 0)
    outer, hole = Contour.from_vertices(OUTER), Contour.from_vertices(BORE)
    assert solid.volume == pytest.approx((outer.area - hole.area) * HEIGHT, rel=1e-14)
    assert solid.form == "binary"
    # corners to the bit: no diagonal of a wall, no tolerance
    assert {tuple(v) for v in solid.contour.start.tolist()} == {tuple(v) for v in OUTER.tolist()}
    assert len(solid.contour) == N
    assert solid.contour.area == pytest.approx(outer.area, rel=1e-14)
    assert len(solid.holes) == 1
    assert solid.holes[0].area == pytest.approx(hole.area, rel=1e-14)
    theta = np.linspace(0.0, 6.28, 99)
    np.testing.assert_array_equal(solid.contour.support(theta).q, outer.support(theta).q)


@pytest.mark.parametrize("seed", range(3))
def test_neither_the_order_of_triangles_nor_of_their_corners_matters(tmp_path: Path, seed: int) -> None:
    rng = np.random.default_rng(seed)
    triangles = ring()
    triangles = triangles[rng.permutation(len(triangles))]
    shift = rng.integers(0, 3, len(triangles))
    triangles = triangles[np.arange(len(triangles))[:, None], (np.arange(3) + shift[:, None]) % 3]
    solid = read_solid(binary(tmp_path / "cam.stl", triangles))
    assert solid.prism
    assert sound(solid)
    assert len(solid.contour) == N
    assert solid.contour.area == pytest.approx(Contour.from_vertices(OUTER).area, rel=1e-13)


def test_the_text_form_gives_the_same(tmp_path: Path) -> None:
    solid = read_solid(text(tmp_path / "cam.stl", ring()))
    assert solid.form == "text"
    assert sound(solid)
    assert solid.prism
    assert solid.contour.area == pytest.approx(Contour.from_vertices(OUTER).area, rel=1e-14)


def test_a_binary_header_may_begin_with_solid(tmp_path: Path) -> None:
    solid = read_solid(binary(tmp_path / "cam.stl", ring(), b"solid facet by some exporter"))
    assert solid.form == "binary"


def test_negative_zero_is_zero(tmp_path: Path) -> None:
    triangles = ring().astype(np.float32)
    low = triangles[:, :, 2] == 0.0
    low[::2] = False
    triangles[:, :, 2][low] = -0.0
    solid = read_solid(binary(tmp_path / "cam.stl", triangles))
    assert sound(solid)
    assert solid.prism


@pytest.mark.parametrize("scale", [1e-3, 1.0, 1e3])
def test_parts_made_by_trimesh_and_manifold(tmp_path: Path, scale: float) -> None:
    manifold3d = pytest.importorskip("manifold3d")
    trimesh = pytest.importorskip("trimesh")
    section = manifold3d.CrossSection([OUTER * scale, BORE[::-1] * scale])
    mesh = manifold3d.Manifold.extrude(section, HEIGHT * scale).to_mesh()
    part = trimesh.Trimesh(mesh.vert_properties[:, :3], mesh.tri_verts)
    path = tmp_path / "cam.stl"
    for form in ("stl", "stl_ascii"):
        path.write_bytes(data if isinstance(data := part.export(file_type=form), bytes) else data.encode())
        solid = read_solid(path)
        assert solid.edges[:2] == (0, 0)
        assert sound(solid) == part.is_winding_consistent
        assert solid.volume == pytest.approx(part.volume, rel=1e-6)
        assert solid.contour.area == pytest.approx(Contour.from_vertices(OUTER).area * scale**2, rel=1e-6)
        assert len(solid.holes) == 1
        assert solid.prism


def test_a_stepped_part_is_cut_where_it_is_widest(tmp_path: Path) -> None:
    trimesh = pytest.importorskip("trimesh")
    profile = np.array([[0, 0], [25, 0], [25, 6], [8, 6], [8, 20], [0, 20]], dtype=float)
    hub = trimesh.creation.revolve(profile, sections=64)
    path = tmp_path / "hub.stl"
    hub.export(path)
    solid = read_solid(path)
    assert not solid.prism
    assert solid.edges[:2] == (0, 0)
    assert sound(solid)
    assert solid.faces == (0.0, 6.0, 20.0)
    assert solid.height == pytest.approx(3.0)
    round_share = 32.0 * np.sin(2.0 * np.pi / 64)
    assert solid.contour.area == pytest.approx(25.0**2 * round_share, rel=1e-5)
    assert solid.volume == pytest.approx(hub.volume, rel=1e-6)
    at = read_solid(path, [10.0, 4.0])
    assert [section.height for section in at.sections] == [10.0, 4.0]
    assert at.contour.area == pytest.approx(8.0**2 * round_share, rel=1e-5)
    assert at.sections[1].contour.area == pytest.approx(25.0**2 * round_share, rel=1e-5)


def test_a_cone_is_no_prism_and_is_cut_at_half_height_where_corners_lie_there_too(tmp_path: Path) -> None:
    top, middle = 0.6 * OUTER, 0.8 * OUTER
    cap = BORE * 0.5

    def tapered(bottom: np.ndarray, above: np.ndarray, low: float, high: float) -> np.ndarray:
        b, t = np.column_stack([bottom, np.full(N, low)]), np.column_stack([above, np.full(N, high)])
        return quads(b, np.roll(b, -1, axis=0), np.roll(t, -1, axis=0), t)

    whole = ring(inner=cap)
    lids = whole[4 * N :]
    lids[:, :, :2] = np.where(
        (lids[:, :, 2:] == HEIGHT) & (np.hypot(lids[:, :, :1], lids[:, :, 1:2]) > 6.0),
        0.6 * lids[:, :, :2],
        lids[:, :, :2],
    )
    inner = whole[2 * N : 4 * N]
    single = np.concatenate([tapered(OUTER, top, 0.0, HEIGHT), inner, lids])
    solid = read_solid(binary(tmp_path / "cone.stl", single))
    assert not solid.prism
    assert sound(solid)
    assert solid.height == 4.0
    assert solid.contour.area == pytest.approx(0.64 * Contour.from_vertices(OUTER).area, rel=1e-3)
    halves = [tapered(OUTER, middle, 0.0, 4.0), tapered(middle, top, 4.0, HEIGHT)]
    solid = read_solid(binary(tmp_path / "cone.stl", np.concatenate([*halves, inner, lids])))
    assert sound(solid)
    assert solid.height == 4.0
    assert solid.contour.area == pytest.approx(0.64 * Contour.from_vertices(OUTER).area, rel=1e-6)


def in_four(triangles: np.ndarray) -> np.ndarray:
    """Each triangle divided by the middles of its sides: the same solid."""
    a, b, c = triangles.transpose(1, 0, 2)
    ab, bc, ca = 0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a)
    return np.concatenate([np.stack(rows, axis=1) for rows in ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))])


@pytest.mark.thin(2)
@pytest.mark.parametrize(
    ("times", "single"),
    [(1, True), (1, False), *(pytest.param(2, is_single, marks=pytest.mark.slow) for is_single in (True, False))],
)
def test_a_plane_through_corners_or_close_to_them_cuts_the_same_section(
    tmp_path: Path, times: int, single: bool
) -> None:
    """A disc that narrows evenly to 0.8 of its size at half of its height: the area of any section is known."""
    half = 0.5 * HEIGHT
    corners = ring()
    edge = np.hypot(*corners[:, :, :2].transpose(2, 0, 1))[:, :, None] > 6.0
    wall = edge.all(axis=1)[:, 0] & (np.ptp(corners[:, :, 2], axis=1) > 0.0)
    narrow = np.where(edge & (corners[:, :, 2:] == HEIGHT), [0.8, 0.8, 1.0], 1.0)
    low, high = corners[wall] * narrow[wall] * [1.0, 1.0, 0.5], corners[wall] * [0.8, 0.8, 0.5] + [0.0, 0.0, half]
    triangles = np.concatenate([low, high, (corners * narrow)[~wall]])
    for _ in range(times):
        triangles = in_four(triangles)
    planes = [z + off for z in (2.0, 1.0, 6.0) for off in (0.0, 1e-15, -1e-15, 3e-12, 1e-7)]
    write = binary if single else text
    solid = read_solid(write(tmp_path / "cam.stl", triangles), planes)
    assert sound(solid)
    whole, bore = Contour.from_vertices(OUTER).area, Contour.from_vertices(BORE).area
    exact = 1e-6 if single else 1e-12
    for z, section in zip(planes, solid.sections, strict=True):
        size = 1.0 - 0.2 * min(z / half, 1.0)
        assert section.height == z
        assert section.contour.area == pytest.approx(size**2 * whole, rel=exact)
        assert section.holes[0].area == pytest.approx(bore, rel=exact)


def test_walls_with_corners_halfway_up_still_make_a_prism(tmp_path: Path) -> None:
    whole = ring()
    low, high = ring(high=3.0), ring(low=3.0)
    walls = np.concatenate([low[: 4 * N], high[: 4 * N]])
    solid = read_solid(binary(tmp_path / "cam.stl", np.concatenate([walls, whole[4 * N :]])))
    assert sound(solid)
    assert solid.prism
    assert solid.height == 4.0
    assert solid.contour.area == pytest.approx(Contour.from_vertices(OUTER).area, rel=1e-13)
    leaning = np.concatenate([walls, whole[4 * N :]])
    leaning[:, :, :2] = np.where(leaning[:, :, 2:] == 3.0, leaning[:, :, :2] * (1.0 + 1e-6), leaning[:, :, :2])
    assert not read_solid(binary(tmp_path / "cam.stl", leaning)).prism


# --- planted faults: in the fields


def fields(solid: Solid) -> tuple[bool, bool, tuple[int, ...], int, int]:
    return solid.edges[:2] == (0, 0), sound(solid), tuple(solid.edges), solid.degenerate, solid.duplicate


@pytest.mark.parametrize("lid", [4 * N, 5 * N + 7, 8 * N - 1])
def test_a_hole_in_a_lid(tmp_path: Path, lid: int) -> None:
    solid = read_solid(binary(tmp_path / "cam.stl", np.delete(ring(), lid, axis=0)))
    assert fields(solid) == (False, False, (3, 0, 0), 0, 0)


def test_a_lid_turned_over(tmp_path: Path) -> None:
    triangles = ring()
    triangles[5 * N] = triangles[5 * N, ::-1]
    solid = read_solid(binary(tmp_path / "cam.stl", triangles))
    assert fields(solid) == (True, False, (0, 0, 3), 0, 0)


def test_a_part_turned_inside_out(tmp_path: Path) -> None:
    solid = read_solid(binary(tmp_path / "cam.stl", ring()[:, ::-1]))
    assert sound(solid)
    assert solid.volume < 0.0
    assert solid.contour.area > 0.0


def test_duplicate_triangles_the_same_way_and_the_other(tmp_path: Path) -> None:
    triangles = ring()
    lid = triangles[5 * N]
    again = np.concatenate([triangles, [lid[[1, 2, 0]]]])
    assert fields(read_solid(binary(tmp_path / "cam.stl", again))) == (False, False, (0, 3, 0), 0, 1)
    pillow = np.array([[8.0, 8.0, 1.0], [9.0, 8.0, 1.0], [8.0, 9.0, 1.0]])
    loose = np.concatenate([triangles, [pillow, pillow[::-1]]])
    solid = read_solid(binary(tmp_path / "cam.stl", loose))
    assert sound(solid)
    assert solid.duplicate == 1
    assert not solid.prism


def test_triangles_without_area(tmp_path: Path) -> None:
    triangles = ring()
    a, b, _ = triangles[5 * N]
    flat = np.concatenate([triangles, [[a, b, b], [a, a, a], [a, (a + b) / 2.0, b]]])
    solid = read_solid(binary(tmp_path / "cam.stl", flat))
    assert solid.degenerate >= 2
    assert solid.edges.open or solid.edges.crowded


# --- what makes it unreadable


def reason(path: Path) -> str:
    try:
        read_solid(path)
    except ReadError as error:
        return error.reason
    return "read"


@pytest.mark.parametrize("wall", [0, N, N + 5, 2 * N - 1])
def test_a_hole_in_the_wall_opens_the_section(tmp_path: Path, wall: int) -> None:
    path = binary(tmp_path / "cam.stl", np.delete(ring(), wall, axis=0))
    with pytest.raises(ReadError, match=r"the section is open at \(-?\d") as caught:
        read_solid(path)
    assert caught.value.reason == "open"
    x, y = caught.value.place
    assert np.hypot(*(OUTER - (x, y)).T).min() < 2.0


def test_two_parts_in_a_file(tmp_path: Path) -> None:
    triangles = np.concatenate([ring(), ring() + np.array([100.0, 0.0, 0.0])])
    assert reason(binary(tmp_path / "cam.stl", triangles)) == "several"


def test_a_flat_part_and_none_at_all(tmp_path: Path) -> None:
    assert reason(binary(tmp_path / "cam.stl", ring() * [1.0, 1.0, 0.0])) == "empty"
    assert reason(binary(tmp_path / "cam.stl", ring()[:0])) == "empty"
    assert reason(text(tmp_path / "cam.stl", ring()[:0])) == "empty"


@pytest.mark.parametrize("value", [np.nan, np.inf, 1e30])
def test_numbers_beyond_measure(tmp_path: Path, value: float) -> None:
    triangles = ring()
    triangles[7, 1, 0] = value
    assert reason(binary(tmp_path / "cam.stl", triangles)) == "range"


@given(st.floats(0.0, 1.0))
@settings(max_examples=examples(100), deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
def test_a_file_cut_short(tmp_path: Path, share: float) -> None:
    path = binary(tmp_path / "cam.stl", ring())
    raw = path.read_bytes()
    path.write_bytes(raw[: int(share * (len(raw) - 1))])
    assert reason(path) == "truncated"
    path = text(tmp_path / "cam.stl", ring())
    raw = path.read_bytes()
    path.write_bytes(raw[: int(share * (len(raw) - len("endsolid cam 7\n") + 7))])
    assert reason(path) == "truncated"


def test_a_file_with_more_than_it_should_hold(tmp_path: Path) -> None:
    path = binary(tmp_path / "cam.stl", ring())
    path.write_bytes(path.read_bytes() + b"\0")
    with pytest.raises(ReadError, match=r"960 triangles make a file of 48084 bytes, not 48085") as caught:
        read_solid(path)
    assert caught.value.reason == "syntax"
    twice = text(path, ring()).read_bytes() + text(path, ring() + np.array([100.0, 0.0, 0.0])).read_bytes()
    path.write_bytes(twice)
    assert reason(path) == "several"
    first, second = (body.read((), 1) for body in separate_bodies(path))
    assert first.volume == read_solid(text(path, ring())).volume == pytest.approx(second.volume)
    assert second.contour.box.x_min == pytest.approx(100.0 + first.contour.box.x_min)


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        (b"facet normal", b"facets normal", "facet 1 has"),
        (b"vertex ", b"vertex", "words"),
        (b"normal 0 0 0", b"normal 0 0", "words"),
        (b"    vertex 3", b"    vertex x3", "not a number"),
        (b"endsolid", b"solidend", "endsolid"),
        (b"normal", b"n" * 1000, "1000 characters"),
    ],
)
def test_damage_in_the_text_form(tmp_path: Path, old: bytes, new: bytes, words: str) -> None:
    path = text(tmp_path / "cam.stl", ring() + np.array([10.0, 0.0, 0.0]))
    raw = path.read_bytes()
    assert old in raw
    path.write_bytes(raw.replace(old, new))
    with pytest.raises(ReadError, match=words):
        read_solid(path)


@given(st.lists(st.tuples(st.floats(0.0, 0.9999), st.integers(0, 255)), min_size=1, max_size=5), st.booleans())
@settings(max_examples=examples(150), deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
def test_flipped_bytes_give_a_solid_or_a_read_error(
    tmp_path: Path, flips: list[tuple[float, int]], as_text: bool
) -> None:
    small = ring(OUTER[::10], BORE[::10])
    path = (text if as_text else binary)(tmp_path / "cam.stl", small)
    raw = bytearray(path.read_bytes())
    for share, value in flips:
        raw[int(share * len(raw))] = value
    path.write_bytes(raw)
    reason(path)


@given(
    st.lists(st.tuples(st.integers(-2, 2), st.integers(-2, 2), st.integers(-2, 2)), min_size=1, max_size=40),
    st.booleans(),
)
def test_welding_numbers_distinct_points(points: list[tuple[int, int, int]], single: bool) -> None:
    given_points: np.ndarray = np.array(points, dtype=np.float32 if single else np.float64)
    for columns in (given_points, given_points[:, :2]):
        distinct, numbers = weld(columns)
        np.testing.assert_array_equal(distinct[numbers], columns)
        assert len({tuple(p) for p in distinct.tolist()}) == len(distinct)


def test_welding_survives_points_of_one_hash(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("kin.read.mesh.mesh.SPREAD", np.uint64(0))  # every point hashes to zero
    mesh = welded(ring().astype(np.float32))
    assert len(mesh.points) == 4 * N
    assert tuple(mesh.edge_faults) == (0, 0, 0)


def test_a_missing_file_is_the_file_systems_error(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError):
        read_solid(tmp_path / "none.stl")


@pytest.mark.parametrize("stumps", [False, True])
def test_lids_without_walls(tmp_path: Path, stumps: bool) -> None:
    """Two lids at their heights, also with walls that end on the way: there is no section at half of the height."""
    whole = ring()
    triangles = whole[np.ptp(whole[:, :, 2], axis=1) == 0.0]
    if stumps:
        triangles = np.concatenate([triangles, ring(high=0.25 * HEIGHT)[: 4 * N]])
    files = [
        (read_solid, binary(tmp_path / "a.stl", triangles)),
        (read_solid, text(tmp_path / "b.stl", triangles)),
        (read_3mf, in_3mf(tmp_path / "c.3mf", triangles)),
    ]
    for read, path in files:
        with pytest.raises(ReadError, match=r"nothing is at z = \d mm, .*: walls are missing between faces"):
            read(path)


def test_words_in_capitals(tmp_path: Path) -> None:
    path = text(tmp_path / "cam.stl", ring())
    small = read_solid(path)
    path.write_text(path.read_text().upper())
    assert read_solid(path).volume == small.volume
    path.write_text(path.read_text().replace("OUTER LOOP", "OUTER RING", 1))
    with pytest.raises(ReadError, match='facet 1 has "ring" where "loop" belongs'):
        read_solid(path)


def test_what_is_no_stl_at_all_is_told_by_how_it_begins(tmp_path: Path) -> None:
    path = tmp_path / "cam.stl"
    path.write_bytes(b"ISO-10303-21;\nHEADER;\n" + b"FILE_DESCRIPTION(('a part'),'2;1');\n" * 40)
    with pytest.raises(ReadError, match=r"neither binary nor text: it begins with \"ISO-10303-21; HEADER\"$") as caught:
        read_solid(path)
    assert caught.value.reason == "syntax"
