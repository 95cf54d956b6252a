"""Lists of points for CAD systems: the spline through them is the contour, within the tolerance."""

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from support.heavy import interpolate, shapely

import camgeo
from camgeo.schema.errors import RecipeErrors
from kin.contour.closed_spline import closed_spline
from kin.read.errors import ReadError
from kin.read.point_list import spline_of_points

STEM = """\
cam:
  kind: disc
  base_radius: 40
  follower: {kind: roller, radius: 10}
  motion: [{rise: 20, over: 100, law: modified-sine}, {dwell: 60}, {return: 20, over: 120, law: cycloidal}, {dwell: 80}]
"""
CAMS = {
    "stem": STEM,
    "ccw": "rotation: ccw\n" + STEM,
    "inch": "units: inch\n" + STEM.replace("40", "1.6").replace("10}", "0.4}").replace(": 20", ": 0.8"),
    "flat": "cam: {kind: disc, base_radius: 30, follower: {kind: flat}, motion: {formula: 5*(1 - cos(t))}}\n",
    "pair": "cam: {kind: double-roller, ratio: 2, arm: 60, roller_radius: 8, delta: {cos: {1: 625}}}\n",
}


def written(folder: Path, cam: str, options: str = "", tolerance: str = "0.001") -> Path:
    path = folder / "cam.yaml"
    files = f"export: {{tolerance: {tolerance}, files: [{{csv: {{as: points{options}}}}}]}}\n"
    path.write_text(CAMS[cam] + files, encoding="utf-8")
    return path


@pytest.mark.slow
@pytest.mark.parametrize("cam", CAMS)
def test_the_spline_through_the_points_is_judged_as_a_contour(cam: str, tmp_path: Path) -> None:
    report = camgeo.export(written(tmp_path, cam, tolerance="0.0001" if cam == "inch" else "0.001"), tmp_path / "out")
    assert report.ok
    assert {check.name for check in report.checks if check.file == "cam.csv"} >= {"contour", "motion"}
    rows = np.loadtxt(tmp_path / "out" / "cam" / "cam.csv", delimiter=",")
    assert (rows[:, 2] == 0.0).all()
    assert rows[0].tolist() == rows[-1].tolist()
    assert 36 < len(rows) < 2000


@pytest.mark.slow
@pytest.mark.parametrize("suffix", ["txt", "xyz"])
def test_a_text_has_blanks_between_the_numbers(suffix: str, tmp_path: Path) -> None:
    report = camgeo.export(written(tmp_path, "flat", f", suffix: {suffix}"), tmp_path / "out")
    assert report.ok
    path = tmp_path / "out" / "cam" / f"cam.{suffix}"
    assert re.fullmatch(r"(\S+ \S+ 0\n)+", path.read_text(encoding="ascii"))
    contour, _ = spline_of_points(path)
    assert contour.area == pytest.approx(np.pi * 35**2, rel=1e-4)  # an eccentric


@pytest.mark.slow
def test_points_beside_another_table_have_a_name_of_their_own(tmp_path: Path) -> None:
    path = tmp_path / "cam.yaml"
    files = "[csv, {csv: {as: points}}, {csv: {as: points, suffix: xyz}}, {csv: {as: points, suffix: txt}}]"
    path.write_text(f"{CAMS['flat']}export: {{files: {files}}}\n", encoding="utf-8")
    camgeo.export(path, tmp_path / "out")
    made = sorted(item.name for item in (tmp_path / "out" / "cam").glob("cam*"))
    assert made == ["cam-points.csv", "cam-points.txt", "cam-points.xyz", "cam.csv"]


@pytest.mark.slow
def test_the_error_is_that_of_another_spline(tmp_path: Path) -> None:
    """Scipy's periodic cubic over the lengths of the chords, held against the contour of a fine list."""
    path = written(tmp_path, "stem", ", step: 10", "0.05")
    report: dict[str, Any] = dict(camgeo.export(path, tmp_path / "coarse"))
    (measured,) = [check["value"] for check in report["checks"] if check["name"] == "contour"]
    camgeo.export(written(tmp_path, "stem", ", step: 0.1"), tmp_path / "fine")
    few, many = (np.loadtxt(tmp_path / name / "cam" / "cam.csv", delimiter=",")[:, :2] for name in ("coarse", "fine"))
    along = np.append(0.0, np.cumsum(np.hypot(*np.diff(few, axis=0).T)))
    curve = interpolate.CubicSpline(along, few, bc_type="periodic")(np.linspace(0.0, along[-1], 20_001))
    exact = shapely.LinearRing(many)
    off = shapely.distance(exact, shapely.points(curve))
    assert measured == pytest.approx(off.max(), abs=2e-5)


def test_a_closed_spline_is_the_periodic_cubic_over_its_chords() -> None:
    rng = np.random.default_rng(3)
    angle = np.sort(rng.uniform(0.0, 2 * np.pi, 17))
    points = np.column_stack([5 * np.cos(angle), 3 * np.sin(angle)]) + rng.normal(size=(17, 2)) * 0.1
    closed = np.vstack([points, points[:1]])
    along = np.append(0.0, np.cumsum(np.hypot(*np.diff(closed, axis=0).T)))
    other = interpolate.CubicSpline(along, closed, bc_type="periodic")
    control = closed_spline(points)
    for x in (0.0, 0.3, 0.7, 1.0):
        weights = np.array([(1 - x) ** 3, 3 * x * (1 - x) ** 2, 3 * x * x * (1 - x), x**3])
        here = np.tensordot(control, weights, axes=(1, 0))
        assert here == pytest.approx(other(along[:-1] + x * np.diff(along)), abs=1e-12)


@pytest.mark.costly("both remedies are tried, an export each")
def test_a_step_that_does_not_hold_the_tolerance_is_refused_with_one_that_does(tmp_path: Path) -> None:
    told = r"a spline through points so far apart is off by .*; give (\S+) or less, or a tolerance of (\S+) mm"
    with pytest.raises(RecipeErrors, match=told) as caught:
        camgeo.export(written(tmp_path, "stem", ", step: 10", "0.0001"), tmp_path / "out")
    found = re.search(told, str(caught.value))
    assert found is not None
    assert camgeo.export(written(tmp_path, "stem", f", step: {found[1]}", "0.0001"), tmp_path / "out").ok
    assert camgeo.export(written(tmp_path, "stem", ", step: 10", found[2]), tmp_path / "out").ok


def test_a_step_that_makes_more_points_than_are_read_is_refused(tmp_path: Path) -> None:
    with pytest.raises(RecipeErrors, match=r"csv.step: more than 100000 points; give 0.0036 or more"):
        camgeo.load(written(tmp_path, "stem", ", step: 0.001"))
    assert camgeo.load(written(tmp_path, "stem", ", step: 0.0036"))


@pytest.mark.slow
def test_a_contour_with_corners_is_no_spline(tmp_path: Path) -> None:
    sharp = "cam: {kind: disc, base_radius: 12, undercut: trim, follower: {kind: flat}, motion: [{rise: 20, over: 60, "
    sharp += "law: cycloidal}, {return: 20, over: 60, law: cycloidal}, {dwell: 240}]}\n"
    path = tmp_path / "cam.yaml"
    path.write_text(sharp + "export: {files: [{csv: {as: points}}]}\n", encoding="utf-8")
    with pytest.raises(RecipeErrors, match="a contour with corners is no one spline through points; give"):
        camgeo.export(path, tmp_path / "out")
    path.write_text(sharp + "export: {files: [{dxf: {as: spline}}]}\n", encoding="utf-8")
    camgeo.export(path, tmp_path / "out")


@pytest.mark.slow
@pytest.mark.parametrize("cam", ["stem", "ccw", "inch"])
@pytest.mark.parametrize("suffix", ["csv", "txt", "xyz"])
def test_a_list_of_any_origin_is_verified_as_the_spline_through_it(cam: str, suffix: str, tmp_path: Path) -> None:
    tolerance = 4e-5 if cam == "inch" else 0.001
    recipe = written(tmp_path, cam, f", step: 1, suffix: {suffix}", str(tolerance))
    assert camgeo.export(recipe, tmp_path / "out").ok
    path = tmp_path / "out" / "cam" / f"cam.{suffix}"
    assert camgeo.verify(recipe, path).ok
    lines = path.read_text(encoding="ascii").splitlines()
    mark = "," if suffix == "csv" else " "
    for times, ok in ((2.0, False), (-2.0, False), (0.1, True)):
        place = np.array(lines[90].split(mark), dtype=float)
        place *= 1.0 + times * tolerance / np.hypot(*place[:2])
        moved = mark.join(map(repr, place.tolist()))
        path.write_text("\n".join([*lines[:90], moved, *lines[91:]]), encoding="ascii")
        report = camgeo.verify(recipe, path)
        assert report.ok == ok, times
        assert ok or {check.name for check in report.checks if not check.ok} == {"contour", "motion"}


def test_a_table_of_a_machine_is_one_with_any_suffix(tmp_path: Path) -> None:
    """A table for a drive under the name of a text is judged as ever, and is no list of points."""
    recipe = tmp_path / "cam.yaml"
    recipe.write_text(STEM + "export: {files: [{csv: {as: controller, for: plain}}]}\n", encoding="utf-8")
    assert camgeo.export(recipe, tmp_path / "out").ok
    table = (tmp_path / "out" / "cam" / "cam.csv").rename(tmp_path / "table.txt")
    report = camgeo.verify(recipe, table)
    assert report.ok
    assert "interpolation" in {check.name for check in report.checks}


@pytest.mark.slow
def test_a_list_of_points_is_of_one_contour(tmp_path: Path) -> None:
    recipe = written(tmp_path, "stem")
    camgeo.export(recipe, tmp_path / "out")
    groove = CAMS["stem"].replace("radius: 10}", "radius: 10}\n  track: {groove: {clearance: 0.03, depth: 6}}")
    recipe.write_text(groove + "part: {thickness: 10, outer: 180}\n", encoding="utf-8")
    report = camgeo.verify(recipe, tmp_path / "out" / "cam" / "cam.csv")
    (check,) = (check for check in report.checks if not check.ok)
    assert (check.name, check.detail) == ("readable", "a list of points has one contour, the part 2")


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("0,0\n1e300,0\n1,1\n0,1\n0,0\n", "a coordinate is 1e\\+300, which no part has"),
        ("0,0\n1,0\n1,1\n0,1\n0,0.5\n", "the last point is not the first"),
        ("0,0\n1,0\n1,0\n1,1\n0,1\n0,0\n", "point 3 is the one before it"),
        ("0,0\n1,x\n1,1\n0,1\n0,0\n", "a line is not of two or three numbers"),
        ("0,0\n1,0,1\n1,1\n0,1\n0,0\n", "a line is not of two or three numbers"),
        ("0,0,0\n1,0,1\n1,1,0\n0,1,0\n0,0,0\n", "the points do not lie in a plane"),
        ("0,0\n1,0\n0,0\n", "3 points; 5 to"),
    ],
)
def test_what_is_no_closed_curve_says_why(text: str, message: str, tmp_path: Path) -> None:
    (tmp_path / "p.csv").write_text(text, encoding="utf-8")
    with pytest.raises(ReadError, match=message):
        spline_of_points(tmp_path / "p.csv")


@pytest.mark.parametrize("mark", [",", ";", " ", "\t"])
def test_marks_between_numbers(mark: str, tmp_path: Path) -> None:
    points = [(2, 0), (0, 2), (-2, 0), (0, -2), (2, 0)]
    (tmp_path / "p.xyz").write_text("".join(f"{x}{mark}{y}{mark}0\n" for x, y in points), encoding="utf-8")
    contour, count = spline_of_points(tmp_path / "p.xyz", 25.4)
    assert count == 4
    assert contour.area == pytest.approx(25.4**2 * np.pi * 4, rel=0.04)
