"""Assertions for users' own tests: on good files of known figures, and on planted faults."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path
from typing import Any, cast

import numpy as np
import pytest
from support.camfiles import (
    arcs_through,
    circle_points,
    roller_points,
    solid_triangles,
    support_points,
    write_dxf,
    write_lines,
    write_stl,
)
from support.heavy import ezdxf

from camgeo import testing
from camgeo.common.errors import CallError
from camgeo.recipe.loading import load
from camgeo.schema.errors import RecipeErrors
from camgeo.schema.fields import either
from kin.read.formats import FORMATS

COUNT = 720
TOP = 4 * COUNT + 3  # a triangle of the upper face
BORES_INCH = ((0.0, 0.0, 5.0 / 25.4),)
# p = 25 + 2 cos 3t + 0.3 sin 5t, of breadth 50; so many chords stay within 0.001 mm of it
CAM = """\
cam: {kind: support, fourier: {mean: 25, cos: {3: 2}, sin: {5: 0.3}}}
part: {thickness: 8, bore: 10}
export: {tolerance: 0.002, files: [dxf, stl]}
"""
BOOTH = """\
cam: {kind: double-roller, ratio: 2, arm: 40, roller_radius: 8, delta: {cos: {1: 400}}}
part: {bore: 10}
export: {tolerance: 0.002, files: [dxf]}
"""


@pytest.fixture
def recipe(tmp_path):
    path = tmp_path / "cam.yaml"
    path.write_text(CAM)
    return path


@pytest.fixture
def vertices():
    return support_points(COUNT)


def dxf(tmp_path, vertices, **options):
    return write_dxf(tmp_path / "cam.dxf", vertices, **options)


def stl(tmp_path, vertices, spoil=lambda triangles: triangles):
    triangles = solid_triangles(vertices, 5.0 * circle_points(len(vertices)), 0.0, 8.0)
    return write_stl(tmp_path / "cam.stl", spoil(triangles))


def moved(vertices, by, at=100):
    """Move one vertex outward."""
    spoilt = vertices.copy()
    spoilt[at] *= 1.0 + by / np.hypot(*spoilt[at])
    return spoilt


# --- breadth ----------------------------------------------------------------------------------------------------------


@pytest.mark.thin(2)
@pytest.mark.parametrize("write", [dxf, stl])
def test_breadth_of_a_good_file(tmp_path, vertices, write):
    path = write(tmp_path, vertices)
    for found in (
        testing.assert_constant_breadth(path, 50.0, tolerance=0.001),
        testing.assert_constant_breadth(path, tolerance=0.001),
        testing.assert_constant_breadth(str(path), 50.0),
    ):
        assert 49.999 <= found.least < found.greatest <= 50.0 + 1e-5


@pytest.mark.slow
def test_breadth_is_that_of_the_whole_turn(tmp_path):
    # an ellipse-like p = 20 + cos 2t has breadth 40 + 2 cos 2t
    path = dxf(tmp_path, support_points(2000, 20.0, ((2, 1.0, 0.0),)))
    found = testing.assert_constant_breadth(path, 40.0, tolerance=1.001)
    assert found.least == pytest.approx(38.0, abs=1e-4)
    assert found.greatest == pytest.approx(42.0, abs=1e-4)
    assert found.least_at_deg % 180 == pytest.approx(90.0, abs=0.1)
    assert (found.greatest_at_deg + 1) % 180 == pytest.approx(1.0, abs=0.1)
    message = r"cam\.dxf: breadth 42 at \d+\.\d{4} deg, \+2 from the nominal 40 mm, at most 1 mm allowed"
    with pytest.raises(AssertionError, match=message):
        testing.assert_constant_breadth(path, 40.0, tolerance=0.5)
    with pytest.raises(AssertionError, match=r"from the mean 39\.9999"):
        testing.assert_constant_breadth(path, tolerance=0.5)


def test_the_breadth_is_held_to_twice_the_tolerance_and_no_more(tmp_path):
    circle = 10.0 * circle_points(64)
    path = dxf(tmp_path, circle[::2], bulges=arcs_through(circle)[1])
    testing.assert_constant_breadth(path, 20.002, tolerance=0.00101)
    with pytest.raises(AssertionError, match="from the nominal"):
        testing.assert_constant_breadth(path, 20.002, tolerance=0.00099)
    with pytest.raises(AssertionError, match="from the nominal"):
        testing.assert_constant_breadth(path, 19.998, tolerance=0.00099)
    with pytest.raises(AssertionError):
        testing.assert_constant_breadth(path, float("nan"))


@pytest.mark.thin(2)
@pytest.mark.parametrize("write", [dxf, stl])
def test_breadth_of_spoilt_files(tmp_path, vertices, write):
    with pytest.raises(AssertionError, match=r"breadth 50\.0\d+ at "):
        testing.assert_constant_breadth(write(tmp_path, moved(vertices, 0.02)), 50.0)
    with pytest.raises(AssertionError, match=r"breadth 50\.05\d* at "):
        testing.assert_constant_breadth(write(tmp_path, 1.001 * vertices), 50.0)


def test_breadth_minds_the_unit(tmp_path, vertices):
    inches = dxf(tmp_path, vertices / 25.4, units=1, bores=BORES_INCH)
    testing.assert_constant_breadth(inches, 50.0)
    with pytest.raises(AssertionError, match="breadth 1270"):
        testing.assert_constant_breadth(dxf(tmp_path, vertices, units=1), 50.0)
    silent = dxf(tmp_path, vertices / 25.4, units=0, bores=BORES_INCH)
    with pytest.raises(AssertionError, match=r"states no unit; give mm="):
        testing.assert_constant_breadth(silent, 50.0)
    testing.assert_constant_breadth(silent, 50.0, mm=25.4)


# --- closed and watertight --------------------------------------------------------------------------------------------


@pytest.mark.slow
def test_closed(tmp_path, vertices):
    assert testing.assert_closed(dxf(tmp_path, vertices)) == 0.0
    assert testing.assert_closed(write_lines(tmp_path / "lines.dxf", vertices, backwards=(3, 7))) == 0.0
    assert testing.assert_closed(stl(tmp_path, vertices)) == 0.0


@pytest.mark.parametrize(
    "assertion", [testing.assert_closed, testing.assert_watertight, testing.assert_constant_breadth]
)
def test_a_solid_without_walls(tmp_path, assertion):
    """Two triangles at two heights, as a lid and a floor whose walls another program has dropped."""
    corners = np.array([[[0, 0, z], [9, 0, z], [0, 9, z]] for z in (0.0, 5.0)])
    path = write_stl(tmp_path / "lid.stl", corners)
    words = r"lid\.stl: nothing is at z = 2\.5 mm, and something above and below: walls are missing between faces"
    with pytest.raises(AssertionError, match=words):
        assertion(path)


def test_a_gap_is_measured(tmp_path):
    def corner(space):
        space.add_lwpolyline([(20, 0.004), (20, 20), (-20, 20), (-20, -20), (20, -20), (20, 0)])

    document = ezdxf.new("R2010")
    document.header["$INSUNITS"] = 4
    corner(document.modelspace())
    path = tmp_path / "gap.dxf"
    document.saveas(path)
    with pytest.raises(AssertionError, match=r"gap\.dxf: .*0\.004"):
        testing.assert_closed(path)
    assert testing.assert_closed(path, gap=0.01) == pytest.approx(0.004, rel=1e-6)


def test_what_is_not_closed(tmp_path, vertices):
    with pytest.raises(AssertionError, match=r"lines\.dxf: "):
        testing.assert_closed(write_lines(tmp_path / "lines.dxf", vertices, leave_out=(5,)))
    with pytest.raises(AssertionError, match=r"cam\.dxf: duplicate LWPOLYLINE .*at \(-?\d"):
        testing.assert_closed(dxf(tmp_path, vertices, twice=True))
    eight = np.array([[-10.0, -10.0], [12.0, 10.0], [10.0, -10.0], [-10.0, 12.0]])
    with pytest.raises(AssertionError, match=r"crosses or touches itself at \("):
        testing.assert_closed(dxf(tmp_path, eight, bores=()))
    with pytest.raises(AssertionError, match="3 edges with one triangle"):
        testing.assert_closed(stl(tmp_path, vertices, lambda t: np.delete(t, TOP, axis=0)))


def test_watertight(tmp_path, vertices):
    volume = testing.assert_watertight(stl(tmp_path, vertices))
    # area of the curve, pi (mean^2 + sum of (1 - k^2) c^2/2), less the bore's
    area = np.pi * (25.0**2 + 0.5 * ((1 - 9) * 4.0 + (1 - 25) * 0.09)) - np.pi * 25.0
    assert volume == pytest.approx(8.0 * area, rel=1e-4)


@pytest.mark.parametrize(
    ("spoil", "message"),
    [
        (lambda t: np.delete(t, TOP, axis=0), "3 edges with one triangle, none allowed"),
        (lambda t: t[:, ::-1], r"the volume is -\d+.* mm\^3: the triangles face inward"),
        (lambda t: np.concatenate([t, t[TOP : TOP + 1]]), "1 triangles drawn twice"),
        (lambda t: np.concatenate([np.delete(t, TOP, axis=0), t[TOP : TOP + 1, ::-1]]), "3 edges between"),
    ],
)
def test_what_is_not_watertight(tmp_path, vertices, spoil, message):
    with pytest.raises(AssertionError, match=rf"cam\.stl: .*{message}"):
        testing.assert_watertight(stl(tmp_path, vertices, spoil))


def test_an_stl_cut_short(tmp_path, vertices):
    path = stl(tmp_path, vertices)
    path.write_bytes(path.read_bytes()[:-30])
    for judge in (testing.assert_watertight, testing.assert_closed, testing.assert_constant_breadth):
        with pytest.raises(AssertionError, match=r"cam\.stl: \d+ triangles make a file of \d+ bytes"):
            judge(path)


def test_calls_that_are_wrong_are_no_verdict(tmp_path, vertices):
    solids = either([record.suffixes[0] for record in FORMATS.values() if record.contents == "solid"])
    with pytest.raises(ValueError, match=re.escape(f"cam.dxf: not a {solids} file")):
        testing.assert_watertight(dxf(tmp_path, vertices))
    for judge in (testing.assert_closed, testing.assert_watertight, testing.assert_constant_breadth):
        for name in ("cam.iges", "cam", "cam.csv", "cam.ngc"):
            with pytest.raises(CallError, match=rf"{name}: a contour is read from one of \.dxf, \.svg, \.stl"):
                judge(tmp_path / name)
    with pytest.raises(FileNotFoundError):
        testing.assert_closed(tmp_path / "none.dxf")


# --- against a recipe -------------------------------------------------------------------------------------------------


@pytest.mark.thin(2)
@pytest.mark.parametrize("write", [dxf, stl])
def test_motion_and_contour_of_good_files(tmp_path, vertices, recipe, write):
    path = write(tmp_path, vertices)
    motion = testing.assert_motion(recipe, path)
    # the vertices lie on the curve; the chords' middles are off by rho s^2/8, at most (25 + 16 + 7.2) (2 pi/720)^2/8
    assert 1e-5 < motion.max < 5e-4
    assert 0.0 < motion.rms < motion.max
    assert (motion.unit, motion.dwell_flatness) == ("mm", None)
    assert testing.assert_contour(load(recipe), str(path)) < 5e-4


@pytest.mark.slow
@pytest.mark.parametrize("write", [dxf, stl])
def test_motion_of_spoilt_files(tmp_path, vertices, recipe, write):
    cosine, sine = np.cos(np.radians(0.2)), np.sin(np.radians(0.2))
    turned = vertices @ np.array([[cosine, sine], [-sine, cosine]])
    message = r"motion of cam\.\w{3}: 0\.0\d+ mm, at most 0\.002 mm allowed, at \d+\.\d\d deg"
    with pytest.raises(AssertionError, match=message):
        testing.assert_motion(recipe, write(tmp_path, moved(vertices, 0.02)))
    with pytest.raises(AssertionError, match=message):
        testing.assert_motion(recipe, write(tmp_path, 1.001 * vertices))
    with pytest.raises(AssertionError, match=message):
        testing.assert_motion(recipe, write(tmp_path, turned))


@pytest.mark.slow
def test_what_contact_cannot_feel_is_felt_by_the_contour(tmp_path, vertices, recipe):
    dented = dxf(tmp_path, moved(vertices, -0.02))
    with pytest.raises(AssertionError, match=r"contour of cam\.dxf: 0\.0\d+ mm, at most 0\.002 mm allowed, at "):
        testing.assert_contour(recipe, dented)
    assert testing.assert_contour(recipe, dented, tolerance=0.03) == pytest.approx(0.02, rel=0.1)


def test_the_limit_of_the_motion_is_held_and_no_more(tmp_path, vertices, recipe):
    path = dxf(tmp_path, vertices)
    reached = testing.assert_motion(recipe, path).max
    assert testing.assert_motion(recipe, path, limit=1.01 * reached, angles=100).max == pytest.approx(reached)
    with pytest.raises(AssertionError, match=r"motion of cam\.dxf: .*\n(.*\n)*  remedy   a tolerance of"):
        testing.assert_motion(recipe, path, limit=0.99 * reached)


@pytest.mark.slow
def test_lengths_are_in_the_recipes_units(tmp_path, vertices, recipe):
    path = dxf(tmp_path, vertices)
    error = testing.assert_contour(recipe, path)
    inch = tmp_path / "inch.yaml"
    fourier = f"{{mean: {25 / 25.4!r}, cos: {{3: {2 / 25.4!r}}}, sin: {{5: {0.3 / 25.4!r}}}}}"
    inch.write_text(
        f"units: inch\ncam: {{kind: support, fourier: {fourier}}}\npart: {{bore: {10 / 25.4!r}}}\n"
        "export: {tolerance: 0.0001, files: [dxf]}\n"
    )
    inches = dxf(tmp_path, vertices / 25.4, units=1, bores=BORES_INCH)
    assert testing.assert_contour(inch, inches) == pytest.approx(error / 25.4, rel=1e-3)
    assert testing.assert_motion(inch, inches).unit == "in"
    with pytest.raises(AssertionError, match=r"at most 1e-05 in"):
        testing.assert_motion(inch, inches, limit=1e-5)


@pytest.mark.slow
def test_a_file_has_the_tolerance_its_name_has_in_the_recipe(tmp_path, vertices, recipe):
    recipe.write_text(CAM.replace("[dxf, stl]", "[{dxf: {tolerance: 0.05}}, stl]"))
    path = dxf(tmp_path, moved(vertices, -0.02))
    assert testing.assert_contour(recipe, path) == pytest.approx(0.02, rel=0.1)
    with pytest.raises(AssertionError, match=r"at most 0\.01 mm"):
        testing.assert_contour(recipe, path, tolerance=0.01)
    with pytest.raises(AssertionError, match=r"at most 0\.002 mm"):
        testing.assert_contour(recipe, path.rename(tmp_path / "other.dxf"))


@pytest.mark.slow
def test_a_file_that_is_no_contour_fails_both(tmp_path, vertices, recipe):
    path = write_lines(tmp_path / "cam.dxf", vertices, leave_out=(5,))
    for judge in (testing.assert_motion, testing.assert_contour):
        with pytest.raises(AssertionError, match=r"closed of cam\.dxf: "):
            judge(recipe, path)


@pytest.mark.slow
def test_a_double_roller_swings(tmp_path):
    recipe = tmp_path / "booth.yaml"
    recipe.write_text(BOOTH)
    vertices, bulges = arcs_through(roller_points(1440, (2, 1, 40.0, {1: 400.0}), 8.0))
    path = write_dxf(tmp_path / "booth.dxf", vertices, bulges)
    motion = testing.assert_motion(recipe, path)
    assert motion.unit == "deg"
    assert motion.max < 1e-3
    with pytest.raises(AssertionError, match=r"motion of booth\.dxf: \S+ deg, at most 1e-09 deg"):
        testing.assert_motion(recipe, path, limit=1e-9)
    larger = write_dxf(tmp_path / "booth.dxf", 1.001 * vertices, bulges)
    with pytest.raises(AssertionError, match=r"motion of booth\.dxf(.*\n)*form-closure of booth\.dxf"):
        testing.assert_motion(recipe, larger)


# --- recipes ----------------------------------------------------------------------------------------------------------


def test_a_good_recipe(recipe):
    report = testing.assert_recipe(recipe)
    assert report["ok"]
    assert [file["path"] for file in report["files"]] == ["cam.dxf", "cam.stl"]
    # p + p'' = 25 - 16 cos 3t - 7.2 sin 5t
    t = np.linspace(0.0, 2.0 * np.pi, 1_000_001)
    least = (25.0 - 16.0 * np.cos(3 * t) - 7.2 * np.sin(5 * t)).min()
    assert testing.assert_no_undercut(recipe) == pytest.approx(least, abs=1e-6)
    assert testing.assert_no_undercut(load(recipe)) == pytest.approx(least, abs=1e-6)


def test_recipes_with_faults(recipe):
    recipe.write_text(CAM.replace("mean", "maen").replace("bore: 10", "bore: -1"))
    with pytest.raises(AssertionError) as caught:
        testing.assert_recipe(recipe)
    assert len(re.findall(rf"^{re.escape(str(recipe))}:\d:\d+: ", str(caught.value), re.MULTILINE)) == 2
    for judge in (testing.assert_no_undercut, lambda path: testing.assert_motion(path, Path("cam.dxf"))):
        with pytest.raises(RecipeErrors):
            judge(recipe)


def test_a_recipe_whose_check_fails(recipe):
    recipe.write_text(CAM + "verify: {motion_error: 0.001}\n")
    with pytest.raises(AssertionError, match=r"^cam: motion of cam\.dxf: 0\.001\d+ mm, at most 0\.001 mm allowed, at "):
        testing.assert_recipe(recipe)


@pytest.mark.thin(2)
@pytest.mark.parametrize("undercut", ["refuse", "trim"])
def test_undercut(recipe, undercut):
    recipe.write_text(CAM.replace("mean: 25", "mean: 20").replace("}}}\n", f"}}}}, undercut: {undercut}}}\n", 1))
    message = r"radius-of-curvature: -\d\S* mm, more than 0 mm needed, at \d(.*\n)*undercut-local"
    with pytest.raises(AssertionError, match=message):
        testing.assert_no_undercut(recipe)


def test_a_neck_narrower_than_the_roller(recipe):
    recipe.write_text(BOOTH)
    sound = testing.assert_no_undercut(recipe)
    loaded = load(recipe)
    larger = replace(loaded, cam=replace(cast("Any", loaded.cam), roller_radius=sound + 1.0))
    with pytest.raises(AssertionError, match=r"undercut-\w+: .* mm, at most 0 mm"):
        testing.assert_no_undercut(larger)


ENDING = """
from camgeo import testing
def test_a(): testing.assert_motion("cams/small.yaml", "none.dxf")
def test_b(): testing.assert_closed("x.foo")
def test_c(): testing.assert_recipe("cams/none.yaml")
def test_d(): testing.assert_no_undercut("cams/cut.yaml")
def test_e(): testing.assert_closed(3)
def test_f(): testing.assert_watertight("none.stl")
def test_g(): testing.assert_contour("cams/none.yaml", "none.dxf")
def test_h(): testing.assert_constant_breadth("none.svg")
"""


@pytest.mark.slow
def test_a_failure_ends_at_the_line_of_the_test(pytester: pytest.Pytester) -> None:
    """Whatever is raised: of the library's own source nothing is shown."""
    (pytester.path / "cams").mkdir()
    small = "cam: {kind: support, p: 9 + cos(3*t)}\nexport: {tolerance: 0.01, files: [dxf]}\n"
    (pytester.path / "cams" / "small.yaml").write_text(small)
    (pytester.path / "cams" / "cut.yaml").write_text(small.replace("9 +", "7 +"))
    pytester.makepyfile(ENDING)
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("PYTEST_DISABLE_PLUGIN_AUTOLOAD", "1")
        result = pytester.runpytest_inprocess()
    result.assert_outcomes(failed=8)
    places = re.findall(r"^(\S+\.py):\d+: \w+$", result.stdout.str(), re.MULTILINE)
    assert places == ["test_a_failure_ends_at_the_line_of_the_test.py"] * 8
