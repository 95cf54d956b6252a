"""DXF drawings read back by ezdxf: units, layers, exact numbers, extents, same bytes in any process and time zone.

Holds: camgeo.formats.drawings, camgeo.files.layer_outline.
"""

import os
import subprocess
import sys
from importlib.metadata import version

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from support.cases import examples
from support.heavy import ezdxf
from support.outlines import bored
from support.places import TESTS
from support.splines import closed_spline, periodic_spline

from camgeo.files.layer_outline import LayerOutline
from camgeo.fit.pieces import ArcSpline, Bound, Polygon
from camgeo.formats.dxf import APPLICATION, VERSIONS, Point, ReferenceCircle, Trace, write_dxf

NONE = Bound(0.0, 0.0)
TWO = (13.000000000000004, 13.000000000000005)  # differ in mm, the same in inches
T = np.linspace(0.0, 2.0 * np.pi, 40, endpoint=False)
# coordinates with all their digits, and numbers that an exponent is needed for
POLYGON = Polygon(np.column_stack((25.0 * np.cos(T) + 2.0 / 3.0, 20.0 * np.sin(T) + 1e-17)), NONE)
ARCS = ArcSpline(POLYGON.vertices, np.where(np.arange(40) % 5 == 0, 0.0, np.tan(np.pi / 80.0)), NONE)
REFERENCE = (
    ReferenceCircle("prime circle", (0.0, 0.0), 30.0),
    Point("shaft", (0.0, 0.0)),
    Trace("pitch curve", ArcSpline(POLYGON.vertices * 1.25, np.full(40, np.tan(np.pi / 80.0)), NONE)),
)
MODERN = [version for version in VERSIONS if version != "R12"]


def read(path):
    drawing = ezdxf.readfile(path)
    audit = drawing.audit()
    assert not audit.errors
    assert not audit.fixes
    return drawing


def on(drawing, layer):
    return [entity for entity in drawing.modelspace() if entity.dxf.layer == layer]


def points_of(entity):
    """Rows of x, y, bulge of an LWPOLYLINE or POLYLINE."""
    if entity.dxftype() == "LWPOLYLINE":
        return np.array(entity.get_points("xyb"))
    return np.array([(*v.dxf.location.xyz[:2], v.dxf.get("bulge", 0.0)) for v in entity.vertices])


@pytest.mark.thin(3)
@pytest.mark.parametrize("version", VERSIONS)
@pytest.mark.parametrize("outline", [POLYGON, ARCS], ids=["polygon", "arcs"])
def test_one_closed_polyline_with_every_digit(tmp_path, version, outline):
    path = tmp_path / "cam.dxf"
    write_dxf(path, bored(outline, 10.0), reference=REFERENCE, version=version)
    drawing = read(path)
    assert drawing.acad_release == version
    (cut,) = on(drawing, "CUT")
    assert cut.dxftype() == ("POLYLINE" if version == "R12" else "LWPOLYLINE")
    assert cut.is_closed
    rows = points_of(cut)
    assert np.array_equal(rows[:, :2], POLYGON.vertices)
    assert np.array_equal(rows[:, 2], ARCS.bulges if outline is ARCS else np.zeros(40))


@pytest.mark.thin(3)
@pytest.mark.parametrize("version", MODERN)
@pytest.mark.parametrize("spline", [closed_spline(), periodic_spline(11, 5)], ids=["clamped", "periodic"])
def test_spline_by_control_points_and_knots(tmp_path, version, spline):
    path = tmp_path / "cam.dxf"
    write_dxf(path, bored(spline), version=version)
    drawing = read(path)
    (cut,) = on(drawing, "CUT")
    assert cut.dxftype() == "SPLINE"
    assert cut.dxf.degree == spline.degree
    assert np.array_equal(np.array(cut.control_points)[:, :2], spline.control)
    assert np.array_equal(np.array(cut.knots), spline.knots)
    assert cut.fit_point_count() == 0
    assert len(cut.weights) == 0
    assert cut.dxf.flags == (1 if spline.clamped else 3)
    curve = cut.construction_tool()
    first, last = spline.knots[spline.degree], spline.knots[len(spline.control)]
    assert curve.point(first).isclose(curve.point(last), abs_tol=1e-9)


def test_r12_has_no_splines(tmp_path):
    path = tmp_path / "cam.dxf"
    with pytest.raises(ValueError, match="DXF R12 has no splines"):
        write_dxf(path, bored(closed_spline()), version="R12")
    with pytest.raises(ValueError, match="DXF R12 has no splines"):
        write_dxf(path, bored(ARCS), reference=[Trace("pitch curve", closed_spline())], version="R12")
    assert not path.exists()


@pytest.mark.parametrize("version", VERSIONS)
@pytest.mark.parametrize(("mm", "stated"), [(1.0, ("mm", 4, 1)), (25.4, ("inch", 1, 0))])
def test_units_are_stated(tmp_path, version, mm, stated):
    path = tmp_path / "cam.dxf"
    unit, insunits, measurement = stated
    write_dxf(path, bored(ARCS, 12.7), mm=mm, version=version)
    assert path.read_bytes().startswith(f"999\ncamgeo units: {unit}\n".encode())
    drawing = read(path)
    if version != "R12":
        assert drawing.header["$INSUNITS"] == insunits
        assert drawing.header["$MEASUREMENT"] == measurement
    (cut,), (bore,) = on(drawing, "CUT"), on(drawing, "BORE")
    assert points_of(cut)[:, :2] * mm == pytest.approx(ARCS.points, rel=1e-15)
    assert bore.dxf.radius == 6.35 / mm


@pytest.mark.parametrize("version", VERSIONS)
def test_layers_hold_what_they_are_named_for(tmp_path, version):
    path = tmp_path / "cam.dxf"
    write_dxf(path, bored(ARCS, 10.0), reference=REFERENCE, version=version)
    drawing = read(path)
    (bore,) = on(drawing, "BORE")
    assert (bore.dxftype(), bore.dxf.radius, bore.dxf.center.xyz) == ("CIRCLE", 5.0, (0.0, 0.0, 0.0))
    assert len(on(drawing, "CUT")) == 1
    names = {e.get_xdata(APPLICATION)[0].value: e.dxftype() for e in on(drawing, "REFERENCE")}
    curve = "POLYLINE" if version == "R12" else "LWPOLYLINE"
    assert names == {"prime circle": "CIRCLE", "shaft": "POINT", "pitch curve": curve}
    assert len(drawing.modelspace()) == 5
    layers = [drawing.layers.get(name) for name in ("CUT", "BORE", "REFERENCE")]
    assert len({layer.color for layer in layers}) == 3
    assert [layer.dxf.linetype for layer in layers] == ["Continuous", "Continuous", "CENTER"]


def test_reference_that_coincides_is_drawn_once_under_all_its_names(tmp_path):
    path = tmp_path / "cam.dxf"
    circles = [
        ReferenceCircle(name, (0.0, 0.0), radius) for name, radius in (("prime circle", 9), ("pivots", 9), ("base", 8))
    ]
    write_dxf(path, bored(ARCS), reference=[*circles, Point("shaft", (0.0, 0.0)), Point("centre", (0.0, 0.0))])
    names = [[tag.value for tag in e.get_xdata(APPLICATION)] for e in on(read(path), "REFERENCE")]
    assert names == [["prime circle", "pivots"], ["base"], ["shaft", "centre"]]


def extents(drawing):
    low, high = drawing.header["$EXTMIN"], drawing.header["$EXTMAX"]
    assert drawing.header["$LIMMIN"] == low[:2]
    assert drawing.header["$LIMMAX"] == high[:2]
    assert low[2] == high[2] == 0.0
    return (*low[:2], *high[:2])


@pytest.mark.thin(3)
@pytest.mark.parametrize("outline", [POLYGON, ARCS, closed_spline(), periodic_spline()])
@pytest.mark.parametrize("mm", [1.0, 25.4])
def test_extents_are_those_of_the_curve(tmp_path, outline, mm):
    path = tmp_path / "cam.dxf"
    write_dxf(path, bored(outline), mm=mm)
    assert extents(read(path)) == tuple(value / mm for value in outline.box())


def test_extents_hold_the_reference_too(tmp_path):
    path = tmp_path / "cam.dxf"
    write_dxf(path, bored(ARCS), reference=[*REFERENCE, Point("follower pivot", (60.0, -1.0))])
    x_min, y_min, _, y_max = REFERENCE[2].outline.box()
    assert extents(read(path)) == (min(x_min, -30.0), min(y_min, -30.0), 60.0, max(y_max, 30.0))


def test_extents_with_a_corner_in_the_origin(tmp_path):
    # ezdxf takes a null vector for "not known"
    path = tmp_path / "cam.dxf"
    write_dxf(path, bored(Polygon(np.array([[0.0, 0.0], [4.0, 0.0], [4.0, 3.0], [0.0, 3.0]]), NONE)))
    assert extents(read(path)) == (0.0, 0.0, 4.0, 3.0)


WRITE_ALL = """
import sys
from pathlib import Path
sys.path[:0] = sys.argv[2:]
from test_dxf import ARCS, MODERN, POLYGON, REFERENCE, VERSIONS
from support.outlines import bored
from support.splines import closed_spline
from camgeo.formats.dxf import write_dxf
for version in VERSIONS:
    write_dxf(Path(sys.argv[1], f"arcs-{version}.dxf"), bored(ARCS, 10.0), reference=REFERENCE, version=version,
              name="cam", about="W Figure 9")
    write_dxf(Path(sys.argv[1], f"polygon-{version}.dxf"), bored(POLYGON), mm=25.4, version=version)
for version in MODERN:
    write_dxf(Path(sys.argv[1], f"spline-{version}.dxf"), bored(closed_spline()), version=version)
"""


@pytest.mark.slow
def test_same_bytes_in_any_process_and_time_zone(tmp_path):
    written = []
    for i, zone in zip((1, 4, 9), ("UTC", "Asia/Tokyo", "XYZ+11:30"), strict=True):  # sets of texts in several orders
        folder = tmp_path / str(i)
        folder.mkdir()
        environment = {**os.environ, "TZ": zone, "PYTHONHASHSEED": str(i), "LC_ALL": "C"}
        command = [sys.executable, "-c", WRITE_ALL, str(folder), str(TESTS), str(TESTS / "formats")]
        subprocess.run(command, check=True, env=environment)
        written.append({path.name: path.read_bytes() for path in folder.iterdir()})
    assert len(written[0]) == 11
    assert written[0] == written[1] == written[2]
    year = written[0]["arcs-R2010.dxf"]
    assert version("ezdxf").encode() not in year


def test_comments_are_single_lines_of_any_text(tmp_path):
    path = tmp_path / "cam.dxf"
    write_dxf(path, bored(ARCS), version="R12", name="cam", about="two\n  0\nEOF\r\nlines \ud800 \u2603 " + "x" * 300)
    lines = path.read_text("cp1252").split("\n")
    assert lines[:6] == ["999", "camgeo units: mm", "999", "cam", "999", lines[5]]
    assert lines[5].startswith("two 0 EOF lines \\U+2603 xxx")
    assert lines[6] == "  0"
    assert len(on(read(path), "CUT")) == 1


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"version": "R14"}, "DXF version must be one of R12, R2000, R2010, R2013, not 'R14'"),
        ({"mm": 10.0}, "a drawing unit must be 1.0 or 25.4 mm, not 10.0"),
        ({"more": [LayerOutline("BORE", ARCS, ((0.0, 0.0), 0.0))]}, "BORE: radius must be > 0, not 0.0"),
        ({"more": [LayerOutline("BORE", ARCS, ((0.0, 0.0), float("nan")))]}, "BORE: radius must be > 0, not nan"),
        (
            {"reference": [ReferenceCircle("prime circle", (0.0, 0.0), 0.0)]},
            "prime circle: radius must be > 0, not 0.0",
        ),
        (
            {"outline": Polygon(np.array([[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [1.0, 0.0]]), NONE)},
            "the contour comes twice through (1.0, 0.0)",
        ),
        (
            {"outline": Polygon(np.array([[TWO[0], 0.0], [TWO[1], 0.0], [0.0, 1.0]]), NONE), "mm": 25.4},
            "the contour comes twice through (0.5118110236220474, 0.0)",
        ),
    ],
)
def test_refuses(tmp_path, change, message):
    path = tmp_path / "cam.dxf"
    with pytest.raises(ValueError) as caught:
        write_dxf(path, [*bored(change.pop("outline", ARCS)), *change.pop("more", [])], **change)
    assert str(caught.value) == message
    assert not path.exists()


def test_r12_is_written_without_a_word(tmp_path, caplog, capfd):
    write_dxf(tmp_path / "cam.dxf", bored(ARCS), version="R12")
    assert not caplog.records
    assert capfd.readouterr() == ("", "")


@settings(max_examples=examples(25), deadline=None)
@given(
    st.lists(st.tuples(*[st.floats(-1e6, 1e6)] * 3), min_size=3, max_size=12, unique_by=lambda row: row[:2]),
    st.sampled_from(sorted(VERSIONS)),
)
def test_any_double_comes_back(tmp_path_factory, rows, version):
    table = np.array(rows)
    path = tmp_path_factory.mktemp("dxf") / "cam.dxf"
    write_dxf(path, bored(ArcSpline(table[:, :2].copy(), table[:, 2].copy(), NONE)), version=version)
    (cut,) = on(ezdxf.readfile(path), "CUT")
    assert np.array_equal(points_of(cut), table)
