"""DXF files of every version and manner, made with ezdxf, read back; damaged and wrong ones refused with the place.

Holds: kin.read.drawing.drawing.
"""

from __future__ import annotations

import logging
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from ezdxf.enums import InsertUnits
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from support.cases import examples
from support.heavy import ezdxf

from kin.contour.arcs import unit
from kin.contour.contour import Contour
from kin.read.drawing.chaining import close_pairs
from kin.read.errors import ReadError
from kin.read.files import read_drawing

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from ezdxf.document import Drawing as Document
    from ezdxf.layouts.layout import Modelspace

ANGLES = np.linspace(0.0, 2.0 * np.pi, 721)
CENTRE, RADIUS = np.array([3.0, -1.5]), 25.0
KNOTS = np.deg2rad([20.0, 95.0, 180.0, 300.0])


def circle_points() -> tuple[np.ndarray, np.ndarray]:
    sweeps = np.mod(np.roll(KNOTS, -1) - KNOTS, 2.0 * np.pi)
    return CENTRE + RADIUS * unit(KNOTS), np.tan(sweeps / 4.0)


def new(version: str = "R2010", units: int = InsertUnits.Millimeters) -> Document:
    document = ezdxf.new(version)
    if version != "R12":
        document.units = units
    return document


def saved(document: Document, folder: Path, comment: str = "") -> Path:
    path = folder / "cam.dxf"
    document.saveas(path)
    if comment:
        path.write_text(f"999\n{comment}\n" + path.read_text())
    return path


def assert_is_the_circle(contour: Contour, scale: float = 1.0) -> None:
    q = contour.support(ANGLES).q
    np.testing.assert_allclose(q, scale * (unit(ANGLES) @ CENTRE + RADIUS), rtol=0.0, atol=1e-11 * scale)
    assert contour.area == pytest.approx(np.pi * (scale * RADIUS) ** 2, rel=1e-12)
    assert contour.is_convex


def stadium(space: Modelspace, layer: str, order: list[int], backwards: list[bool], shift: float = 0.0) -> None:
    """A stadium of two lines and two arcs, its entities in any order; lines drawn backwards where told."""
    ends = [((-20, -8), (20, -8)), None, ((20, 8), (-20, 8)), None]
    for k in order:
        line = ends[k]
        if line is None:
            x, first = (20.0, -90.0) if k == 1 else (-20.0 + shift, 90.0)
            if backwards[k]:  # seen from below: the extrusion -z turns the x axis round, and with it the sense
                space.add_arc(
                    (-x, 0.0),
                    8.0,
                    180.0 - first - 180.0,
                    180.0 - first,
                    dxfattribs={"layer": layer, "extrusion": (0, 0, -1)},
                )
            else:
                space.add_arc((x, 0.0), 8.0, first, first + 180.0, dxfattribs={"layer": layer})
        else:
            space.add_line(*(line[::-1] if backwards[k] else line), dxfattribs={"layer": layer})


# --- one closed entity, in every version


@pytest.mark.thin(2)
@pytest.mark.parametrize("version", ["R12", "R2000", "R2004", "R2007", "R2010", "R2013", "R2018"])
@pytest.mark.parametrize("clockwise", [False, True])
def test_polylines_with_bulges(tmp_path: Path, version: str, clockwise: bool) -> None:
    points, bulges = circle_points()
    if clockwise:
        points, bulges = points[::-1], -np.roll(bulges[::-1], -1)
    rows = np.column_stack([points, bulges]).tolist()
    document = new(version)
    if version == "R12":
        document.modelspace().add_polyline2d(rows, format="xyb", close=True, dxfattribs={"layer": "CUT"})
    else:
        document.modelspace().add_lwpolyline(rows, format="xyb", close=True, dxfattribs={"layer": "CUT"})
    drawing = read_drawing(saved(document, tmp_path, "camgeo units: mm"))
    assert_is_the_circle(drawing.contour)
    assert drawing.turned == clockwise
    assert drawing.pieces == 4
    assert drawing.units_mm == 1.0
    assert drawing.layers == ("CUT",)
    assert drawing.faults == ()
    assert drawing.holes == ()
    assert drawing.version == document.dxfversion


@pytest.mark.parametrize("first", range(4))
def test_every_start_vertex_gives_the_same_contour(tmp_path: Path, first: int) -> None:
    points, bulges = circle_points()
    rows = np.roll(np.column_stack([points, bulges]), first, axis=0).tolist()
    document = new()
    document.modelspace().add_lwpolyline(rows, format="xyb", close=True)
    assert_is_the_circle(read_drawing(saved(document, tmp_path)).contour)


def test_coordinates_come_back_to_the_bit(tmp_path: Path) -> None:
    rng = np.random.default_rng(3)
    t = np.sort(rng.random(500)) * 2.0 * np.pi
    points = (25.0 + rng.random(500))[:, None] * unit(t)
    document = new()
    document.modelspace().add_lwpolyline(points.tolist(), close=True, dxfattribs={"layer": "CUT"})
    contour = read_drawing(saved(document, tmp_path)).contour
    assert np.array_equal(contour.start, points)
    assert np.array_equal(contour.end, np.roll(points, -1, axis=0))


def test_a_circle_and_its_bore(tmp_path: Path) -> None:
    document = new()
    space = document.modelspace()
    space.add_circle(CENTRE.tolist(), RADIUS, dxfattribs={"layer": "CUT"})
    space.add_circle((0, 0), 5.0, dxfattribs={"layer": "BORE"})
    space.add_circle((0, 0), 99.0, dxfattribs={"layer": "REFERENCE"})
    space.add_point((0, 0), dxfattribs={"layer": "REFERENCE"})
    drawing = read_drawing(saved(document, tmp_path))
    assert_is_the_circle(drawing.contour)
    assert len(drawing.contour.vertices) == 2
    assert [h.area for h in drawing.holes] == [pytest.approx(25.0 * np.pi)]
    assert [(a.layer, a.kind, a.number) for a in drawing.aside] == [
        ("REFERENCE", "CIRCLE", 1),
        ("REFERENCE", "POINT", 1),
    ]
    assert drawing.layers == ("BORE", "CUT")


def test_what_is_drawn_without_choosing_a_layer_is_cut_too(tmp_path: Path) -> None:
    document = new()
    space = document.modelspace()
    space.add_circle(CENTRE.tolist(), RADIUS, dxfattribs={"layer": "CUT"})
    space.add_circle(CENTRE.tolist(), 5.0)
    document.layout("Layout1").add_line((0, 0), (9, 9))  # of a frame on paper
    path = saved(document, tmp_path)
    (hole,) = read_drawing(path).holes
    assert hole.area == pytest.approx(25.0 * np.pi)


@pytest.mark.parametrize(("side", "expected"), [(1, 1.0), (-1, -1.0)])
def test_an_extrusion_along_minus_z_mirrors(tmp_path: Path, side: int, expected: float) -> None:
    points = np.array([[0.0, -10.0], [30.0, 0.0], [0.0, 10.0]])
    bulges = [0.2, 0.0, -0.1]
    document = new()
    document.modelspace().add_lwpolyline(
        np.column_stack([points, bulges]).tolist(), format="xyb", close=True, dxfattribs={"extrusion": (0, 0, side)}
    )
    contour = read_drawing(saved(document, tmp_path)).contour
    plain = Contour.from_bulges(points, np.array(bulges))
    assert contour.area == pytest.approx(plain.area)
    q = plain.support(ANGLES if expected > 0 else np.pi - ANGLES).q
    np.testing.assert_allclose(contour.support(ANGLES).q, q, atol=1e-12)


@pytest.mark.parametrize("extrusion", [(0, 0, 1), (0, 0, -1)])
def test_ellipses(tmp_path: Path, extrusion: tuple[int, int, int]) -> None:
    document = new()
    space = document.modelspace()
    a, ratio, turn = 30.0, 0.4, 0.3
    major = (a * np.cos(turn), a * np.sin(turn))
    # in two halves, of which one is seen from below: there the parameter runs the other way
    space.add_ellipse((2, 1), major, ratio, 0.5, 3.5, dxfattribs={"extrusion": (0, 0, 1)})
    params = (3.5, 0.5 + 2 * np.pi) if extrusion[2] > 0 else (-0.5 - 2 * np.pi, -3.5)
    space.add_ellipse((2, 1), major, ratio, *params, dxfattribs={"extrusion": extrusion})
    drawing = read_drawing(saved(document, tmp_path))
    p = 2 * np.cos(ANGLES) + np.sin(ANGLES) + np.hypot(a * np.cos(ANGLES - turn), a * ratio * np.sin(ANGLES - turn))
    np.testing.assert_allclose(drawing.contour.support(ANGLES).q, p, atol=1e-12)
    assert drawing.contour.area == pytest.approx(np.pi * a * a * ratio, rel=1e-13)


def test_a_full_ellipse_and_a_full_circle_as_an_arc(tmp_path: Path) -> None:
    document = new()
    document.modelspace().add_ellipse((0, 0), (30, 0), 0.5, 0.0, 2.0 * np.pi)
    assert read_drawing(saved(document, tmp_path)).contour.area == pytest.approx(450.0 * np.pi)
    document = new()
    document.modelspace().add_arc(CENTRE.tolist(), RADIUS, 30.0, 390.0)
    assert_is_the_circle(read_drawing(saved(document, tmp_path)).contour)


def test_rational_and_plain_splines(tmp_path: Path) -> None:
    h = np.sqrt(0.5)
    corners = np.array([[1, 0], [1, 1], [0, 1], [-1, 1], [-1, 0], [-1, -1], [0, -1], [1, -1], [1, 0]], dtype=float)
    document = new()
    spline = document.modelspace().add_rational_spline(
        [(*p, 0.0) for p in CENTRE + RADIUS * corners], [1, h, 1, h, 1, h, 1, h, 1], degree=2,
        knots=[0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4],
    )  # fmt: skip
    spline.closed = True
    drawing = read_drawing(saved(document, tmp_path))
    assert_is_the_circle(drawing.contour)
    assert drawing.pieces == 4


@pytest.mark.slow
@pytest.mark.parametrize("degree", [2, 3, 5, 9, 11])
def test_a_closed_spline_of_one_period(tmp_path: Path, degree: int) -> None:
    """Uniform knots, the first control points repeated at the end: as CAD systems write periodic splines."""
    from scipy.interpolate import BSpline

    n = 24
    ring = (25.0 + 2.0 * np.cos(np.arange(n) * 3 * 2 * np.pi / n))[:, None] * unit(np.arange(n) * 2 * np.pi / n)
    control = np.concatenate([ring, ring[:degree]])
    knots = np.arange(n + 2 * degree + 1, dtype=float)
    document = new()
    spline = document.modelspace().add_spline(degree=degree)
    spline.control_points = [(*p, 0.0) for p in control]
    spline.knots = knots.tolist()
    spline.dxf.flags = spline.CLOSED | spline.PERIODIC
    drawing = read_drawing(saved(document, tmp_path))
    points = BSpline(knots, control, degree)(np.linspace(degree, n + degree, 20000))
    reach = (points @ unit(ANGLES).T).max(axis=0)
    q = drawing.contour.support(ANGLES).q
    assert (q >= reach - 1e-12).all()
    assert (q <= reach + 1e-5).all()
    assert drawing.pieces == n


# --- loose entities


@given(st.permutations(range(4)), st.lists(st.booleans(), min_size=4, max_size=4))
@settings(max_examples=examples(25), deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
def test_loose_entities_in_any_order_and_direction(tmp_path: Path, order: list[int], backwards: list[bool]) -> None:
    document = new()
    stadium(document.modelspace(), "0", list(order), backwards)
    drawing = read_drawing(saved(document, tmp_path))
    np.testing.assert_allclose(drawing.contour.support(ANGLES).q, 8.0 + 20.0 * np.abs(np.cos(ANGLES)), atol=1e-12)
    assert drawing.contour.area == pytest.approx(640.0 + 64.0 * np.pi)
    assert drawing.pieces == 4
    assert drawing.widest_gap < 1e-12
    assert len(drawing.contour.vertices) == 4


@pytest.mark.slow
def test_ten_thousand_loose_lines(tmp_path: Path) -> None:
    rng = np.random.default_rng(0)
    points = RADIUS * unit(np.arange(3000) * 2.0 * np.pi / 3000)
    ends = np.stack([points, np.roll(points, -1, axis=0)], axis=1)
    flip = rng.random(3000) < 0.5
    ends[flip] = ends[flip, ::-1]
    document = new()
    for k in rng.permutation(3000):
        document.modelspace().add_line(*ends[k].tolist())
    contour = read_drawing(saved(document, tmp_path)).contour
    assert len(contour) == 3000
    assert contour.is_convex
    assert contour.area == pytest.approx(Contour.from_vertices(points).area)


def test_gaps_are_bridged_up_to_what_is_permitted_and_reported(tmp_path: Path) -> None:
    document = new()
    stadium(document.modelspace(), "0", [0, 1, 2, 3], [False] * 4, shift=0.003)
    path = saved(document, tmp_path)
    drawing = read_drawing(path, gap=0.0031)
    assert drawing.widest_gap == pytest.approx(0.003)
    with pytest.raises(ReadError) as caught:
        read_drawing(path, gap=0.0029)
    error = caught.value
    assert error.reason == "gap"
    assert error.width == pytest.approx(0.003)
    assert error.place in {(-20.0, -8.0), (-20.0, 8.0), (-19.997, -8.0), (-19.997, 8.0)} or error.place is not None
    assert str(error).startswith(f"{path}: the contour is open between (-")
    assert "0.003 apart, permitted is 0.0029; 2 such places" in str(error)


def test_gaps_that_are_reported_are_closed_at_their_middles(tmp_path: Path) -> None:
    document = new()
    stadium(document.modelspace(), "0", [0, 1, 2, 3], [False] * 4, shift=0.003)
    drawing = read_drawing(saved(document, tmp_path), bridged=0.01)
    (told,) = drawing.openings
    assert "0.003 apart, permitted is 5.6e-06; 2 such places" in told
    assert len(drawing.contour) == 4
    assert np.array_equal(drawing.contour.end, np.roll(drawing.contour.start, -1, axis=0))
    np.testing.assert_allclose(drawing.contour.radius, [0.0, 8.0, 0.0, 8.0], atol=1e-3)
    assert drawing.chains[0].gap == pytest.approx(0.003)
    with pytest.raises(ReadError, match=r"0\.003 apart, permitted is 5\.6e-06") as caught:
        read_drawing(saved(document, tmp_path), bridged=0.0029)
    assert caught.value.closing is not None
    assert read_drawing(saved(document, tmp_path), gap=caught.value.closing).widest_gap == pytest.approx(0.003)


@pytest.mark.parametrize("outermost", [False, True])
def test_an_open_chain_within_the_contour_is_left_out(tmp_path: Path, outermost: bool) -> None:
    document = new()
    document.modelspace().add_circle((0, 0), 5.0 if outermost else 25.0)
    document.modelspace().add_arc((0, 0), 25.0 if outermost else 5.0, 0.0, 350.0)
    path = saved(document, tmp_path)
    if outermost:
        with pytest.raises(ReadError, match="the contour is open"):
            read_drawing(path, bridged=0.01)
        return
    drawing = read_drawing(path, bridged=0.01)
    assert drawing.contour.area == pytest.approx(625.0 * np.pi, rel=1e-12)
    assert not drawing.holes
    assert len(drawing.openings) == 1


def test_pieces_no_longer_than_a_gap_are_named(tmp_path: Path) -> None:
    document = new()
    corners = [(0.0, 0.0), (30.0, 0.0), (30.002, 0.0), (30.0, 30.0), (0.0, 30.0)]
    for a, b in zip(corners, corners[1:] + corners[:1], strict=True):
        document.modelspace().add_line(a, b)
    path = saved(document, tmp_path)
    assert not read_drawing(path).short
    (short,) = read_drawing(path, gap=0.004).short
    assert (short.kind, short.x, short.y) == ("short", 30.0, 0.0)


@pytest.mark.thin(2)
@pytest.mark.parametrize("side", [1e-3, 1.0, 50.0, 1e6])
def test_gaps_permitted_by_default_go_with_a_small_drawing(tmp_path: Path, side: float) -> None:
    def square(gap: float) -> Path:
        document = new()
        corners = side * np.array([(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0), (0.0, gap)])
        for a, b in pairwise(corners.tolist()):
            document.modelspace().add_line(a, b)
        return saved(document, tmp_path)

    assert read_drawing(square(1e-15)).contour.area == pytest.approx(side * side)
    share = min(2e-8, 1e-6 / side)
    assert read_drawing(square(0.9 * share)).chains[0].gap == 0.0
    assert read_drawing(square(0.9e-7)).chains[0].gap == pytest.approx(0.9e-7 * side)
    with pytest.raises(ReadError) as caught:
        read_drawing(square(1.1e-7))
    assert caught.value.reason == "gap"


def test_no_piece_of_a_small_drawing_is_without_length(tmp_path: Path) -> None:
    """256 loose lines round a circle of 1e-8 mm: each shorter than what counts as one point in a drawing of 50 mm."""
    points = 1e-8 * unit(np.arange(256) * 2.0 * np.pi / 256)
    document = new()
    for a, b in zip(points.tolist(), np.roll(points, -1, axis=0).tolist(), strict=True):
        document.modelspace().add_line(a, b)
    drawing = read_drawing(saved(document, tmp_path))
    assert len(drawing.contour) == 256
    assert not drawing.faults


def test_a_circle_far_out_closes_without_any_gap(tmp_path: Path) -> None:
    document = new()
    document.modelspace().add_circle((7e5, 3e4), 5e5)
    drawing = read_drawing(saved(document, tmp_path), gap=0.0)
    assert drawing.contour.area == pytest.approx(25e10 * np.pi)


def test_a_missing_segment(tmp_path: Path) -> None:
    document = new()
    stadium(document.modelspace(), "0", [0, 1, 3], [False] * 4)
    with pytest.raises(
        ReadError, match=r"a segment is missing between \(-?20, 8\) and \(-?20, 8\): 40 apart"
    ) as caught:
        read_drawing(saved(document, tmp_path))
    assert caught.value.reason == "open"
    assert caught.value.width == pytest.approx(40.0)


def test_an_open_polyline(tmp_path: Path) -> None:
    points, bulges = circle_points()
    document = new()
    document.modelspace().add_lwpolyline(np.column_stack([points, bulges]).tolist(), format="xyb")
    with pytest.raises(ReadError) as caught:
        read_drawing(saved(document, tmp_path))
    assert caught.value.reason == "open"


def test_a_branch(tmp_path: Path) -> None:
    document = new()
    stadium(document.modelspace(), "0", [0, 1, 2, 3], [False] * 4)
    document.modelspace().add_line((20, 8), (40, 8))
    with pytest.raises(ReadError, match=r"3 ends meet at \(20, 8\), where two should") as caught:
        read_drawing(saved(document, tmp_path))
    assert caught.value.reason == "branch"


@given(st.lists(st.tuples(st.integers(0, 6), st.integers(0, 6)), min_size=1, max_size=40), st.integers(1, 3))
def test_close_pairs_are_all_pairs_that_are_close(points: list[tuple[int, int]], tolerance: int) -> None:
    given_points = np.array(points, dtype=float)
    i, j = close_pairs(given_points, float(tolerance))
    found = {(min(a, b), max(a, b)) for a, b in zip(i.tolist(), j.tolist(), strict=True)}
    close = (np.abs(given_points[:, None] - given_points[None]) <= tolerance).all(axis=2)
    assert found == {(a, b) for a, b in np.argwhere(close).tolist() if a < b}
    assert len(i) == len(found)


# --- units, header


@pytest.mark.parametrize(
    ("units", "mm"),
    [
        (InsertUnits.Millimeters, 1.0),
        (InsertUnits.Inches, 25.4),
        (InsertUnits.Centimeters, 10.0),
        (InsertUnits.Meters, 1e3),
    ],
)
def test_header_units(tmp_path: Path, units: int, mm: float) -> None:
    document = new(units=units)
    points, bulges = circle_points()
    document.modelspace().add_lwpolyline(np.column_stack([points / mm, bulges]).tolist(), format="xyb", close=True)
    drawing = read_drawing(saved(document, tmp_path))
    assert drawing.units_mm == mm
    assert_is_the_circle(drawing.contour)
    assert tuple(drawing.contour.box) == pytest.approx((-22.0, -26.5, 28.0, 23.5))


@pytest.mark.parametrize(
    ("comment", "mm"),
    [
        ("camgeo units: mm", 1.0),
        ("camgeo units: inch", 25.4),
        ("drawn by hand", None),
        ("Units = CM", 10.0),
        ("units: furlong", None),
    ],
)
def test_units_of_r12_by_a_comment(tmp_path: Path, comment: str, mm: float | None) -> None:
    document = new("R12")
    points, bulges = circle_points()
    rows = np.column_stack([points, bulges]).tolist()
    document.modelspace().add_polyline2d(rows, format="xyb", close=True)
    drawing = read_drawing(saved(document, tmp_path, comment))
    assert drawing.units_mm == mm
    assert_is_the_circle(drawing.contour, 1.0 if mm is None else mm)


@pytest.mark.parametrize("head", ["", "0\nSECTION\n2\nHEADER\n0\nENDSEC\n"])
def test_a_file_without_a_header_states_no_unit(tmp_path: Path, head: str) -> None:
    """ezdxf makes a header up where there is none, in metres."""
    path = tmp_path / "cam.dxf"
    circle = "0\nSECTION\n2\nENTITIES\n0\nCIRCLE\n8\n0\n10\n0.0\n20\n0.0\n40\n25.0\n0\nENDSEC\n0\nEOF\n"
    path.write_text(head + circle)
    drawing = read_drawing(path)
    assert drawing.units_mm is None
    assert drawing.contour.area == pytest.approx(625.0 * np.pi, rel=1e-12)
    path.write_text("999\nunits: inch\n" + path.read_text())
    assert read_drawing(path).units_mm == 25.4


def test_frames_in_paper_space_are_set_aside(tmp_path: Path) -> None:
    document = new()
    document.modelspace().add_circle((0, 0), 25.0)
    document.layout("Layout1").add_circle((0, 0), 5.0)
    drawing = read_drawing(saved(document, tmp_path))
    assert drawing.aside == (("0", "CIRCLE in the paper space Layout1", 1),)
    assert not drawing.holes
    assert drawing.contour.area == pytest.approx(625.0 * np.pi, rel=1e-12)


def test_units_that_are_none_for_a_cam(tmp_path: Path) -> None:
    document = new(units=InsertUnits.Parsecs)
    document.modelspace().add_circle((0, 0), 1.0)
    with pytest.raises(ReadError, match=r"\$INSUNITS 20 is not a unit"):
        read_drawing(saved(document, tmp_path))
    document.header["$INSUNITS"] = 0
    assert read_drawing(saved(document, tmp_path)).units_mm is None


# --- layers


def test_foreign_files_have_everything_on_layer_0(tmp_path: Path) -> None:
    document = new()
    space = document.modelspace()
    space.add_circle((0, 0), 5.0)
    space.add_circle((12, 0), 2.0)
    space.add_circle((0, 0), 25.0)
    space.add_text("cam 7")
    drawing = read_drawing(saved(document, tmp_path))
    assert drawing.contour.area == pytest.approx(625.0 * np.pi)
    assert sorted(h.area for h in drawing.holes) == pytest.approx([4.0 * np.pi, 25.0 * np.pi])
    assert [(a.layer, a.kind) for a in drawing.aside] == [("0", "TEXT")]


def refused(folder: Path, draw: Callable[[Document], Any]) -> ReadError:
    document = new()
    draw(document)
    with pytest.raises(ReadError) as caught:
        read_drawing(saved(document, folder))
    return caught.value


def two_outer(document: Document) -> None:
    document.modelspace().add_circle((0, 0), 25.0)
    document.modelspace().add_circle((60, 0), 5.0)


def hole_through_the_edge(document: Document) -> None:
    document.modelspace().add_circle((0, 0), 25.0, dxfattribs={"layer": "CUT"})
    document.modelspace().add_circle((23, 0), 5.0, dxfattribs={"layer": "BORE"})


def island(document: Document) -> None:
    for radius in (25.0, 10.0, 3.0):
        document.modelspace().add_circle((0, 0), radius)


def block_in_itself(document: Document) -> None:
    document.blocks.new("PART").add_blockref("PART", (0, 0))
    document.modelspace().add_blockref("PART", (0, 0), dxfattribs={"layer": "CUT"})


def block_of_many(document: Document) -> None:
    document.blocks.new("PART").add_circle((0, 0), 25.0)
    array = {"column_count": 32000, "row_count": 32000}
    document.modelspace().add_blockref("PART", (0, 0), dxfattribs={"layer": "CUT", **array})


def no_block(document: Document) -> None:
    document.modelspace().add_blockref("PART", (0, 0), dxfattribs={"layer": "CUT"})


def paper(document: Document) -> None:
    document.layout("Layout1").add_circle((0, 0), 5.0)


def hatch(document: Document) -> None:
    document.modelspace().add_circle((0, 0), 25.0)
    document.modelspace().add_hatch()


def tilted(document: Document) -> None:
    document.modelspace().add_circle((0, 0), 25.0, dxfattribs={"extrusion": (0, 1, 1)})


def at_two_heights(document: Document) -> None:
    document.modelspace().add_circle((0, 0, 0), 25.0)
    document.modelspace().add_circle((0, 0, 5), 5.0)


def fit_points(document: Document) -> None:
    document.modelspace().add_spline([(0, 0), (10, 0), (10, 10), (0, 0)])


def torn_spline(document: Document) -> None:
    spline = document.modelspace().add_spline(degree=1)
    spline.control_points = [(0, 0), (1, 0), (1, 1), (0, 1)]
    spline.knots = [0, 0, 1, 1, 2, 2]


def wrong_knots(document: Document) -> None:
    spline = document.modelspace().add_spline(degree=3)
    spline.control_points = [(0, 0), (1, 0), (1, 1), (0, 1)]
    spline.knots = [0, 0, 0, 1, 1, 1]


def negative_weight(document: Document) -> None:
    document.modelspace().add_rational_spline([(0, 0), (1, 0), (1, 1)], [1, -1, 1], degree=2, knots=[0, 0, 0, 1, 1, 1])


def polyline_in_space(document: Document) -> None:
    document.modelspace().add_polyline3d([(0, 0, 0), (1, 0, 1), (1, 1, 2)], close=True)


def mesh(document: Document) -> None:
    document.modelspace().add_polymesh((3, 3))


def huge(document: Document) -> None:
    document.modelspace().add_lwpolyline([(0, 0), (1e12, 0), (0, 1e12)], close=True)


def nothing(document: Document) -> None:
    document.modelspace().add_text("no cam", dxfattribs={"layer": "CUT"})


def only_reference(document: Document) -> None:
    document.modelspace().add_circle((0, 0), 25.0, dxfattribs={"layer": "reference"})


@pytest.mark.thin(2)
@pytest.mark.parametrize(
    ("draw", "reason", "words"),
    [
        (two_outer, "several", "the closed contour at (65, 0) does not lie inside the largest one"),
        (island, "island", "lies inside a hole"),
        (hole_through_the_edge, "crossing", "two closed contours cross or touch at (24."),
        (block_in_itself, "range", "blocks more than 16 deep"),
        (block_of_many, "range", "32000 columns and 32000 rows of 1 entities"),
        (no_block, "syntax", "there is no block PART"),
        (paper, "empty", "nothing to cut in the model space; the file holds 1 CIRCLE in the paper space Layout1 on 0"),
        (hatch, "unsupported", "HATCH"),
        (tilted, "unsupported", "a plane of its own, with the extrusion (0, 1, 1)"),
        (at_two_heights, "unsupported", "heights from 0 to 5"),
        (fit_points, "unsupported", "fit points"),
        (torn_spline, "unsupported", "tears it apart"),
        (wrong_knots, "syntax", "4 control points, 6 knots, 4 weights, degree 3"),
        (negative_weight, "unsupported", "weights"),
        (polyline_in_space, "unsupported", "heights from 0 to 2"),
        (mesh, "unsupported", "it is a mesh"),
        (huge, "range", "1e+12"),
        (nothing, "empty", "1 TEXT on CUT"),
        (only_reference, "empty", "1 CIRCLE on reference"),
    ],
)
def test_what_is_no_contour_is_refused(
    tmp_path: Path, draw: Callable[[Document], Any], reason: str, words: str
) -> None:
    error = refused(tmp_path, draw)
    assert error.reason == reason
    assert words in error.message
    assert error.path == tmp_path / "cam.dxf"


@pytest.mark.parametrize("remedy", ["delete", "REFERENCE"])
def test_a_base_circle_on_the_cams_layer_is_refused_with_its_remedies(tmp_path: Path, remedy: str) -> None:
    def draw(document: Document) -> None:
        document.modelspace().add_circle((5, 0), 30.0)
        document.modelspace().add_circle((0, 0), 25.0)

    error = refused(tmp_path, draw)
    assert error.message == (
        "two closed contours cross or touch at (-25, 0): "
        "delete what is no part of the cam, such as its base circle, or put it on a layer REFERENCE"
    )
    document = new()
    draw(document)
    base = document.modelspace()[1]
    if remedy == "delete":
        document.modelspace().delete_entity(base)
    else:
        base.dxf.layer = remedy
    assert read_drawing(saved(document, tmp_path)).contour.area == pytest.approx(np.pi * 30.0**2)


def test_lines_off_the_plane(tmp_path: Path) -> None:
    def draw(document: Document) -> None:
        for a, b in (((0, 0, 0), (1, 0, 0)), ((1, 0, 0), (1, 1, 0.5)), ((1, 1, 0.5), (0, 0, 0))):
            document.modelspace().add_line(a, b)

    assert refused(tmp_path, draw).reason == "unsupported"


# --- faults


def test_duplicates_are_reported_and_left_out(tmp_path: Path) -> None:
    document = new()
    space = document.modelspace()
    stadium(space, "CUT", [0, 1, 2, 3], [False] * 4)
    space.add_line((20, -8), (-20, -8), dxfattribs={"layer": "CUT"})  # backwards over the first
    space.add_arc((20, 0), 8.0, -90, 90, dxfattribs={"layer": "CUT"})
    drawing = read_drawing(saved(document, tmp_path))
    assert [(f.kind, f.entity.split()[0], f.layer) for f in drawing.faults] == [
        ("duplicate", "LINE", "CUT"),
        ("duplicate", "ARC", "CUT"),
    ]
    assert (drawing.faults[0].x, drawing.faults[0].y) == (20.0, -8.0)
    assert drawing.contour.area == pytest.approx(640.0 + 64.0 * np.pi)


def test_a_whole_contour_drawn_twice_and_one_that_shares_an_edge(tmp_path: Path) -> None:
    points, bulges = circle_points()
    rows = np.column_stack([points, bulges]).tolist()
    document = new()
    for _ in range(2):
        document.modelspace().add_lwpolyline(rows, format="xyb", close=True)
    drawing = read_drawing(saved(document, tmp_path))
    assert [f.kind for f in drawing.faults] == ["duplicate"]
    assert_is_the_circle(drawing.contour)
    document = new()
    document.modelspace().add_lwpolyline([(0, 0), (20, 0), (20, 20), (0, 20)], close=True)
    document.modelspace().add_lwpolyline([(10, 5), (0, 0), (20, 0)], close=True)
    with pytest.raises(ReadError) as caught:
        read_drawing(saved(document, tmp_path))
    assert caught.value.reason == "crossing"


def test_an_edge_drawn_there_and_back_is_an_overlap(tmp_path: Path) -> None:
    document = new()
    document.modelspace().add_lwpolyline([(0, 0), (20, 0), (20, 20), (20, 30), (20, 20), (0, 20)], close=True)
    drawing = read_drawing(saved(document, tmp_path))
    assert [(f.kind, f.x, f.y) for f in drawing.faults] == [("overlap", 20.0, 30.0)]
    assert len(drawing.contour) == 6


def test_a_piece_drawn_again_by_another_entity(tmp_path: Path) -> None:
    """Two of three pieces are new and dangle: where they leave the contour more than two ends meet."""
    document = new()
    stadium(document.modelspace(), "0", [0, 1, 2, 3], [False] * 4)
    document.modelspace().add_lwpolyline([(-20, -8), (20, -8), (30, -30)])
    with pytest.raises(ReadError) as caught:
        read_drawing(saved(document, tmp_path))
    assert caught.value.reason == "branch"


def test_a_line_across_an_arc_of_the_same_ends_is_no_duplicate(tmp_path: Path) -> None:
    document = new()
    document.modelspace().add_arc((0, 0), 10.0, 0.0, 180.0)
    document.modelspace().add_line((-10, 0), (10, 0))
    drawing = read_drawing(saved(document, tmp_path))
    assert drawing.faults == ()
    assert drawing.contour.area == pytest.approx(50.0 * np.pi)


def test_zero_length_pieces_are_reported_and_left_out(tmp_path: Path) -> None:
    document = new()
    document.modelspace().add_lwpolyline([(0, 0), (20, 0), (20, 0), (20, 20), (0, 0)], close=True)
    document.modelspace().add_line((20, 0), (20, 0))
    drawing = read_drawing(saved(document, tmp_path))
    assert sorted((f.kind, f.entity.split()[0], f.x, f.y) for f in drawing.faults) == [
        ("zero-length", "LINE", 20.0, 0.0),
        ("zero-length", "LWPOLYLINE", 0.0, 0.0),
        ("zero-length", "LWPOLYLINE", 20.0, 0.0),
    ]
    assert len(drawing.contour) == 3
    assert drawing.contour.area == pytest.approx(200.0)


# --- damage


@pytest.fixture
def sample(tmp_path: Path) -> Path:
    document = new()
    space = document.modelspace()
    points, bulges = circle_points()
    space.add_lwpolyline(
        np.column_stack([points, bulges]).tolist(), format="xyb", close=True, dxfattribs={"layer": "CUT"}
    )
    stadium(space, "BORE", [0, 1, 2, 3], [False] * 4)
    space.add_ellipse((0, 0), (60, 0), 0.5, dxfattribs={"layer": "REFERENCE"})
    return saved(document, tmp_path)


def outcome(path: Path) -> str:
    """Read, or refuse: nothing else may come out."""
    try:
        read_drawing(path)
    except ReadError as error:
        return error.reason
    return "read"


@given(st.floats(0.0, 0.9999))
@settings(max_examples=examples(60), deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
def test_a_file_cut_short_is_refused(sample: Path, share: float) -> None:
    raw = sample.read_bytes()
    cut = sample.with_name("cut.dxf")
    end = len(raw.rstrip())
    cut.write_bytes(raw[: min(int(share * len(raw)), end - 1)])
    assert outcome(cut) in {"truncated", "empty"}


@given(st.lists(st.tuples(st.floats(0.0, 0.9999), st.integers(0, 255)), min_size=1, max_size=6))
@settings(max_examples=examples(100), deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
def test_flipped_bytes_give_a_contour_or_a_read_error(sample: Path, flips: list[tuple[float, int]]) -> None:
    raw = bytearray(sample.read_bytes())
    begin = raw.index(b"ENTITIES")
    for share, value in flips:
        raw[begin + int(share * (len(raw) - begin))] = value
    spoilt = sample.with_name("spoilt.dxf")
    spoilt.write_bytes(raw)
    logging.disable(logging.ERROR)
    try:
        outcome(spoilt)
    finally:
        logging.disable(logging.NOTSET)


@given(
    st.lists(
        st.tuples(
            st.floats(0.0, 0.9999), st.sampled_from(["nan", "inf", "-1e308", "", "x", "0", "1e-320", "EOF", "99"])
        )
    )
)
@settings(max_examples=examples(100), deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
def test_replaced_lines_give_a_contour_or_a_read_error(sample: Path, lines: list[tuple[float, str]]) -> None:
    text = sample.read_text().splitlines()
    begin = text.index("ENTITIES")
    end = text.index("ENDSEC", begin)
    for share, line in lines:
        text[begin + int(share * (end - begin))] = line
    spoilt = sample.with_name("spoilt.dxf")
    spoilt.write_text("\n".join(text) + "\n")
    logging.disable(logging.ERROR)
    try:
        outcome(spoilt)
    finally:
        logging.disable(logging.NOTSET)


@pytest.mark.parametrize(
    ("content", "reason"),
    [
        (b"", "empty"),
        (b" \n\n", "empty"),
        (b"AutoCAD Binary DXF\r\n\x1a\x00 and so on", "unsupported"),
        (b"solid no drawing\nendsolid", "truncated"),
        (bytes(range(256)) * 20, "truncated"),
        (b"0\nEOF\n", "empty"),
        (b"garbage\n0\nEOF\n", "syntax"),
        (b"0\nSECTION\n2\nENTITIES\n0\nENDSEC\n0\nEOF\n", "empty"),
        (
            b"0\r\nSECTION\r\n2\r\nENTITIES\r\n0\r\nLINE\r\n10\r\n1.0\r\n20\r\n2.0\r\n0\r\nENDSEC\r\n0\r\nEOF\r\n",
            "syntax",
        ),
    ],
)
def test_what_is_no_drawing(tmp_path: Path, content: bytes, reason: str) -> None:
    path = tmp_path / "cam.dxf"
    path.write_bytes(content)
    assert outcome(path) == reason


def test_a_missing_file_is_the_file_systems_error(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError):
        read_drawing(tmp_path / "none.dxf")


def test_a_line_without_its_end_is_not_drawn_to_the_origin(sample: Path) -> None:
    """ezdxf would supply (0, 0, 0)."""
    lines = sample.read_text().splitlines()
    at = lines.index("AcDbLine")
    end = next(k for k in range(at, len(lines)) if lines[k].strip() == "11")
    del lines[end : end + 6]
    sample.write_text("\n".join(lines) + "\n")
    with pytest.raises(ReadError, match="its end is missing"):
        read_drawing(sample)


@pytest.mark.parametrize("note", [False, True])
def test_a_circle_to_engrave_is_cut_or_engraved_and_not_both(tmp_path: Path, *, note: bool) -> None:
    """Text alone on CUT makes it no layer to cut: all curves are cut then, those on ENGRAVE too."""
    document = new()
    space = document.modelspace()
    space.add_circle((0.0, 0.0), 5.0, dxfattribs={"layer": "ENGRAVE"})
    if note:
        space.add_text("5 mm steel", dxfattribs={"layer": "CUT"})
    else:
        space.add_circle((0.0, 0.0), 20.0, dxfattribs={"layer": "CUT"})
    drawing = read_drawing(saved(document, tmp_path), engraved=True)
    assert drawing.contour.area == pytest.approx(np.pi * (5.0 if note else 20.0) ** 2)
    assert len(drawing.engraved) == (0 if note else 1)
