"""Files of measured points as instruments and programs write them, and as they must not be."""

from __future__ import annotations

import math

import numpy as np
import pytest

from kin.read.errors import ReadError
from kin.read.points import heading_of, read_contour_points, read_points

ANGLE = np.radians(np.arange(0.0, 360.0, 5.0))
X, Y = 40.0 * np.cos(ANGLE), 40.0 * np.sin(ANGLE)


def rows(*columns, mark=",", digits=6):
    return "\n".join(mark.join(f"{value:.{digits}f}" for value in row) for row in zip(*columns, strict=True))


def comma(text):
    return text.replace(".", ",")


ZERO = np.zeros_like(X)
NX, NY = np.cos(ANGLE), np.sin(ANGLE)
FILES = {
    "x,y": f"x,y\n{rows(X, Y)}",
    "any order and case, inches": f"Y_in,X_in\n{rows(Y / 25.4, X / 25.4, digits=9)}",
    "semicolons and decimal commas": f"X [mm];Y [mm];Z [mm]\n{comma(rows(X, Y, ZERO, mark=';'))}",
    "tabs": f"# probe 3\nX (mm)\tY (mm)\n{rows(X, Y, mark=chr(9))}",
    "blanks": f"x y z\n{rows(X, Y, ZERO, mark='  ')}",
    "blanks and decimal commas": f"x y\n{comma(rows(X, Y, mark=' '))}",
    "without a heading": rows(X, Y, ZERO, mark=" "),
    "with normals, without a heading": rows(X, Y, ZERO, NX, NY, ZERO, mark=" "),
    "with normals": f"x,y,nx,ny\n{rows(X, Y, NX, NY)}",
    "polar": f"polar_deg,radius_mm\n{rows(np.degrees(ANGLE), np.hypot(X, Y))}",
    "radius and angle": f"radius,angle_rad\n{rows(np.hypot(X, Y), ANGLE, digits=9)}",
    "comments": f"% head\n\n! more\nx,y\n{rows(X, Y)}\n# end\n",
    "quoted": '"x","y"\n' + "\n".join(f'"{x:.6f}","{y:.6f}"' for x, y in zip(X, Y, strict=True)),
    "other columns": "Point,X_mm,Y_mm,Time\n"
    + "\n".join(f"P{i},{x:.6f},{y:.6f},12:0{i % 10}" for i, (x, y) in enumerate(zip(X, Y, strict=True))),
    "DMIS": "UNITS/MM,ANGDEC\n"
    + "\n".join(
        f"FA(P{i}) = FEAT/POINT,CART,{x:.6f},$\n  {y:.6f},0.0,{nx:.6f},{ny:.6f},0.0"
        for i, (x, y, nx, ny) in enumerate(zip(X, Y, NX, NY, strict=True))
    ),
}


def read(tmp_path, text, name="points.csv"):
    path = tmp_path / name
    path.write_text(text, "utf-8")
    return read_points(path)


@pytest.mark.parametrize("kind", list(FILES))
def test_points_are_read_however_they_are_written(kind, tmp_path):
    table = read(tmp_path, FILES[kind])
    unit = table.unit or 1.0
    assert table.measured == "places"
    assert unit * table.columns["x"] == pytest.approx(X, abs=2e-6)
    assert unit * table.columns["y"] == pytest.approx(Y, abs=2e-6)
    if "normals" in kind or kind == "DMIS":
        assert table.columns["nx"] == pytest.approx(NX, abs=1e-6)
    else:
        assert "nx" not in table.columns
    assert (np.diff(table.lines) > 0).all()


def test_units_are_those_that_headings_state(tmp_path):
    assert read(tmp_path, FILES["any order and case, inches"]).unit == 25.4
    assert read(tmp_path, FILES["tabs"]).unit == 1.0
    assert read(tmp_path, FILES["x,y"]).unit is None
    assert read(tmp_path, FILES["DMIS"]).unit == 1.0


def test_lifts(tmp_path):
    table = read(tmp_path, f"angle_deg,lift_in\n{rows(np.degrees(ANGLE), ANGLE)}")
    assert (table.measured, table.unit, table.degrees) == ("lift", 25.4, False)
    table = read(tmp_path, f"Theta;Lift (deg)\n{comma(rows(np.degrees(ANGLE), ANGLE, mark=';'))}")
    assert (table.measured, table.unit, table.degrees) == ("lift", None, True)


def test_surfaces(tmp_path):
    table = read(tmp_path, "x,y,surface\n" + "\n".join(f"{x:.6f},{y:.6f},outer" for x, y in zip(X, Y, strict=True)))
    assert set(table.labels) == {"outer"}
    both = f"inner_x_mm,inner_y_mm,outer_x_mm,outer_y_mm,outer_cutter_x_mm\n{rows(X, Y, 2 * X, 2 * Y, X)}"
    table = read(tmp_path, both)
    assert len(table) == 144
    assert table.labels[:72] == ["inner"] * 72
    assert table.columns["x"][72:] == pytest.approx(2.0 * X, abs=1e-6)


def test_headings_tell_what_a_table_is(tmp_path):
    path = tmp_path / "a.csv"
    path.write_text("# grinding\nc_deg,x_mm\n0,1\n")
    assert heading_of(path) == ("c_deg", "x_mm")
    path.write_text("1 2\n3 4\n")
    assert heading_of(path) == ()


BAD = {
    "empty": ("", "no row of numbers"),
    "heading alone": ("x,y\n", "below its heading there is no row"),
    "one point": ("x,y\n1,2\n", "points: 1, and at least 36 are needed"),
    "word": (f"x,y\n{rows(X, Y)}\n3,foo\n", "line 74: 'foo' is not a number"),
    "nan": (f"x,y\n{rows(X, Y)}\n3,nan\n", "line 74: y is nan, which no part has"),
    "inf": (f"x,y\ninf,1\n{rows(X, Y)}\n", "line 2: x is inf, which no part has"),
    "1e300": (f"x,y\n{rows(X, Y)}\n3,1e300\n", r"line 74: y is 1e\+300, which no part has"),
    "short row": (f"x,y\n{rows(X, Y)}\n3\n", "line 74: 1 columns, and 2 are expected"),
    "decimal commas between commas": (
        f"x,y\n{comma(rows(X, Y))}",
        "with decimal commas, part the columns by semicolons",
    ),
    "columns of something else": (f"a1,b2\n{rows(X, Y)}", "no columns of measured points in its heading a1, b2"),
    "no y": (f"x,z\n{rows(X, Y)}", "a column y is missing"),
    "four bare columns": (rows(X, Y, X, Y, mark=" "), "4 numbers without a heading"),
    "two units": (f"x_mm,y_in\n{rows(X, Y)}", "its columns are in in and mm; give all in one unit"),
    "no normal": (f"x,y,nx,ny\n{rows(X, Y, ZERO, ZERO)}", "its normal is 0 long across the shaft"),
    "DMIS that breaks": ("FA(A) = FEAT/POINT,CART,1,2\n", "x,y,z or x,y,z,i,j,k are expected"),
}


@pytest.mark.parametrize("fault", list(BAD))
def test_what_is_wrong_is_told_with_its_line(fault, tmp_path):
    text, words = BAD[fault]
    with pytest.raises(ReadError, match=words):
        read(tmp_path, text)


def test_bytes_that_are_no_text(tmp_path):
    path = tmp_path / "points.xyz"
    path.write_bytes(b"\x00\x01\x02" * 100)
    with pytest.raises(ReadError, match="not a text"):
        read_points(path)


def listed(path, points):
    path.write_text("x_mm,y_mm\n" + "".join(f"{x:.6f},{y:.6f}\n" for x, y in points))
    return path


def around(degrees, radius=50.0):
    angle = np.radians(degrees)
    return radius * np.column_stack([np.cos(angle), np.sin(angle)])


@pytest.mark.parametrize(("step", "out"), [(2, 40), (5, 90), (8, 40)])
@pytest.mark.parametrize("backwards", [False, True])
def test_points_that_leave_a_stretch_out_are_refused_unless_it_is_closed_across(step, out, backwards, tmp_path):
    degrees = np.arange(100, 100 + 360 - out + 1, step)
    points = around(degrees)[:: -1 if backwards else 1]
    path = listed(tmp_path / "cam.csv", np.roll(points, 7, axis=0))  # wherever the file begins
    with pytest.raises(ReadError, match="lines 8 and 9") as refused:
        read_contour_points(path, 1.0)
    assert "a stretch of the contour is left out; give the points between them, or across: arc" in str(refused.value)
    (arc,) = read_contour_points(path, 1.0, "arc")
    assert arc.bridge is not None
    assert np.degrees(np.diff(arc.bridge.angles))[0] == pytest.approx(out, abs=1e-3)
    assert arc.contour.area == pytest.approx(math.pi * 2500.0, rel=6e-3)


def test_a_straight_flank_needs_no_points_between_its_ends(tmp_path):
    """Two circles and their tangents, points every 3 degrees of the circles; a flank is 17 times as long as a step."""
    half = math.degrees(math.acos(14.0 / 24.0))
    base = around(np.linspace(half, 360.0 - half, 85), 20.0)
    nose = around(np.linspace(-half, half, 37), 6.0) + np.array([24.0, 0.0])
    (cam,) = read_contour_points(listed(tmp_path / "cam.csv", np.vstack([base, nose])), 1.0)
    assert cam.bridge is None


def test_points_of_uneven_steps_are_no_stretch_that_is_left_out(tmp_path):
    """Dense on one half, every 8 degrees on the other, as scanners thin out what is round."""
    degrees = np.concatenate([np.arange(0.0, 180.0, 1.0), np.arange(180.0, 360.0, 8.0)])
    assert read_contour_points(listed(tmp_path / "cam.csv", around(degrees)), 1.0)[0].bridge is None
