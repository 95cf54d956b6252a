"""The motion of a contour without a recipe: against the laws that contours were made for, and what it refuses.

Holds: camgeo.capabilities.follow, camgeo.capabilities.follow.command.
"""

from __future__ import annotations

import json
import math
import os
import re
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
import pytest
from support.cases import few
from support.drawn import circle, polygon
from support.heavy import ezdxf
from support.places import RECIPES

import camgeo
from camgeo.capabilities.follow.followed import judged_by_recipe, summary
from camgeo.cli.exit_status import OK, WRONG
from camgeo.cli.main import main
from kin.contour.about import tracks
from kin.follower.measured import MeasuredMotion, measured
from kin.law.contacts import Contact
from kin.read.files import read_drawing

if TYPE_CHECKING:
    from pathlib import Path

    from kin.law.contacts import Side

FOLLOWERS: dict[str, dict[str, Any]] = {
    "disc-roller": {"roller": 9.0, "offset": 10.0},
    "disc-arm": {"roller": 8.0, "arm": (80.0, 65.0)},
    "disc-flat": {"flat": True},
    "disc-knife-edge": {"roller": 0.0},
}


@pytest.fixture(scope="module")
def drawings(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    out = tmp_path_factory.mktemp("drawings")
    found = {}
    for name in FOLLOWERS:
        recipe = camgeo.load(RECIPES / f"{name}.yaml").replace({"export.files": ["dxf"], "export.tolerance": 1e-5})
        report = camgeo.export(recipe, out)
        assert report.path is not None
        found[name] = report.path / f"{name}.dxf"
    return found


@pytest.fixture(scope="module")
def eccentric(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A circle about a point 5 mm from the shaft, whose two strokes are of no law: they are fitted in little time."""
    path = tmp_path_factory.mktemp("eccentric") / "eccentric.dxf"
    document = ezdxf.new("R2010", units=4)
    document.modelspace().add_circle((5.0, 0.0), 30.0)
    document.saveas(path)
    return path


def asked(name: str) -> dict[str, Any]:
    return FOLLOWERS[name] | {"rotation": camgeo.load(RECIPES / f"{name}.yaml").rotation}


@pytest.mark.slow
@pytest.mark.parametrize("name", FOLLOWERS)
def test_the_motion_is_that_of_the_law(drawings: dict[str, Path], name: str) -> None:
    """Within what a contour that is 1e-5 mm off gives a follower, at pressure angles below 40 degrees."""
    followed = camgeo.follow(drawings[name], **asked(name))
    design = camgeo.design(RECIPES / f"{name}.yaml")
    law = design.motion(followed.theta)
    scale = 1.0 if followed.unit == "mm" else 65.0
    lift = followed.position - followed.least[0]
    np.testing.assert_allclose(scale * lift, scale * (law - law.min()), atol=2e-5)
    speed = design.motion(followed.theta, derivative=1)
    np.testing.assert_allclose(scale * followed.velocity, scale * speed, atol=0.02)
    pressure = design.exact.exact.surfaces[0].pressure(followed.theta)
    np.testing.assert_allclose(followed.pressure_angle, pressure, atol=1e-3)
    assert followed.lift == pytest.approx(float(np.ptp(law)), abs=2e-5)
    text = design.recipe.text
    assert followed.base_radius == pytest.approx(float(text.split("base_radius: ")[1].split()[0]), abs=1e-4)


@pytest.mark.thin(3)
@pytest.mark.parametrize(
    ("name", "side"),
    [
        ("disc-arm-flat", 1),
        ("disc-shoe", 1),
        ("disc-ring", -1),  # needs: milling
    ],
)
def test_pressure_angles_are_those_of_the_exact_cam(tmp_path: Path, name: str, side: Side) -> None:
    """Of a face that stands nearer the shaft than its pivot's parallel, of a shoe, and of a roller in a ring."""
    recipe = camgeo.load(RECIPES / f"{name}.yaml")
    exact = camgeo.design(recipe).exact
    report = camgeo.export(recipe.replace({"export.files": ["dxf"], "export.tolerance": 1e-5}), tmp_path)
    assert report.path is not None
    drawn = [chain.contour for chain in read_drawing(report.path / f"{name}.dxf").chains]
    contour = tracks(drawn)[0]
    contour = contour.mirrored() if recipe.rotation == "ccw" else contour
    contact = exact.follower.contacts[0]
    motion = measured(contour, [Contact(contact.guide, contact.touch)], 360, side)
    np.testing.assert_allclose(motion.pressure, exact.exact.surfaces[0].pressure(motion.phi), atol=2e-3)


@pytest.mark.thin(3)
@pytest.mark.parametrize(("name", "offset"), [("disc-flat", 0.0), ("disc-flat", 4.0), ("disc-arm-flat", 0.0)])
def test_the_travel_of_the_contact_is_that_of_the_exact_cam(tmp_path: Path, name: str, offset: float) -> None:
    recipe = camgeo.load(RECIPES / f"{name}.yaml").replace({"export.files": ["dxf"], "export.tolerance": 1e-5})
    recipe = recipe.replace("cam.follower.offset", offset) if offset else recipe
    exact = camgeo.design(recipe).exact
    report = camgeo.export(recipe, tmp_path)
    assert report.path is not None
    contour = read_drawing(report.path / f"{name}.dxf").contour
    contact = exact.follower.contacts[0]
    motion = measured(contour, [Contact(contact.guide, contact.touch)], 360)
    least, most = (extreme.value for extreme in exact.exact.surfaces[0].extremes("contact"))
    assert motion.travel == pytest.approx((least, most), abs=0.01)


def test_dwells_are_found_and_noses_are_none(drawings: dict[str, Path]) -> None:
    rests = camgeo.follow(drawings["disc-roller"], **asked("disc-roller")).rests
    assert len(rests) == 2
    for rest, (begin, end) in zip(rests, [(100.0, 140.0), (280.0, 360.0)], strict=True):
        assert math.degrees(rest.begin) == pytest.approx(begin, abs=4.0)
        assert math.degrees(rest.end) == pytest.approx(end, abs=4.0)
        assert rest.flatness <= 0.01
    assert camgeo.follow(drawings["disc-knife-edge"], **asked("disc-knife-edge"), reading=0.05).rests == ()


def test_positions_at_two_levels_are_no_dwell_between_them() -> None:
    """Of 720 every other one is 1.9 readings higher over half the turn, and all rest over 30 degrees."""
    phi = 2.0 * np.pi * np.arange(720) / 720
    position = np.where(phi < np.pi, 1.9e-2 * (np.arange(720) % 2), np.where(phi < 1.1 * np.pi, 1.0, 5.0 * np.sin(phi)))
    rows = np.stack([position, 0.0 * phi, 0.0 * phi])
    motion = MeasuredMotion("mm", phi, rows, 0.0 * phi, 0.0 * phi, (0.0, 0.0), (1.0, 0.0))
    dwells = motion.dwells(0.01)
    assert [round(dwell.level, 3) for dwell in dwells if dwell.begin > 3.0] == [1.0]
    assert all(dwell.flatness <= 0.02 for dwell in dwells)


def test_a_dwell_begins_within_the_turn() -> None:
    """A parabola ends at 2.5 degrees in a rest: what is within the reading begins before 0, the dwell after it."""
    degrees = np.arange(720) / 2.0
    before = np.mod(2.5 - degrees, 360.0)  # before the rest, degrees
    position = np.where(before > 300.0, 0.0, 0.002 * np.minimum(before, 300.0 - before) ** 2)
    phi = np.radians(degrees)
    rows = np.stack([position, 0.0 * phi, 0.0 * phi])
    motion = MeasuredMotion("mm", phi, rows, 0.0 * phi, 0.0 * phi, (0.0, 0.0), (45.0, 0.0))
    (dwell,) = motion.dwells(0.01)
    assert math.degrees(dwell.begin) == pytest.approx(1.0, abs=0.1)
    assert math.degrees(dwell.end) == pytest.approx(64.0, abs=0.1)


def test_a_polygon_of_few_points_comes_near_its_law(tmp_path: Path) -> None:
    """Chords of 240 points of a roller's cam lie within it: the follower stands up to 0.0074 mm low, never high."""
    recipe = camgeo.load(RECIPES / "disc-roller.yaml")
    design = camgeo.design(recipe)
    path = polygon(tmp_path / "points.dxf", design.contour(240))
    followed = camgeo.follow(path, **asked("disc-roller"), reading=0.004)
    law = design.motion(followed.theta)
    error = followed.position - followed.least[0] - law
    assert 0.003 < float(np.abs(error).max()) < 0.0037
    smooth = tmp_path / "cam.yaml"
    smooth.write_text(followed.recipe("lift.csv"), encoding="utf-8")
    (tmp_path / "lift.csv").write_text(followed.lifts(), encoding="utf-8")
    motion = camgeo.design(smooth).motion
    assert float(np.ptp(motion(followed.theta) - law)) < 2.0 * 0.0037
    peak = np.abs(design.motion(followed.theta, derivative=2)).max()
    assert np.abs(motion(followed.theta, derivative=2)).max() == pytest.approx(peak, rel=0.02)
    fine = camgeo.follow(path, **asked("disc-roller"), steps=7200)
    low = fine.position - math.sqrt(45.0**2 - 10.0**2) - design.motion(fine.theta)
    assert -2.0 * 0.00372 < float(low.min()) < float(low.max()) < 1e-9


@pytest.mark.parametrize(("count", "off"), [(240, 0.0074), (90, 0.0526)])
def test_accelerations_of_a_polygon_are_those_of_the_smoothed_motion(tmp_path: Path, count: int, off: float) -> None:
    """Its corners' are many times the law's, in tables and figures there is neither one of them nor their radius."""
    design = camgeo.design(RECIPES / "disc-roller.yaml")
    path = polygon(tmp_path / "points.dxf", design.contour(count))
    followed = camgeo.follow(path, **asked("disc-roller"))
    law = design.motion(followed.theta, derivative=2)
    assert np.abs(followed.acceleration).max() > 4.0 * np.abs(law).max()
    assert followed.facets == pytest.approx(off, rel=0.1)  # the chords of a follower on a polygon of 240 points
    head, *rows = followed.table().splitlines()
    columns = dict(zip(head.split(","), zip(*(row.split(",") for row in rows), strict=True), strict=True))
    assert "acceleration_mm_per_rad2" not in columns
    assert set(columns["radius_of_curvature_mm"]) == {""}
    smoothed = np.array([float(cell) for cell in columns["smoothed_acceleration_mm_per_rad2"]])
    assert np.abs(smoothed).max() == pytest.approx(np.abs(law).max(), rel=0.1)
    told = summary(followed)
    assert "corner" not in told
    assert "least radius" not in told
    assert f"acceleration of the smoothed motion from {smoothed.min():.4g} to {smoothed.max():.4g} mm/rad²" in told


def test_edges_of_a_square_are_no_facets(tmp_path: Path) -> None:
    square = np.array([[30.0, 30.0], [-30.0, 30.0], [-30.0, -30.0], [30.0, -30.0]])
    followed = camgeo.follow(polygon(tmp_path / "square.dxf", square), roller=9.0)
    assert followed.facets is None
    assert "acceleration_mm_per_rad2" in followed.table()
    assert "least radius of curvature 0 mm, a corner" in summary(followed)


@pytest.mark.slow
def test_rows_of_a_recipe_are_no_slips_of_a_pen(tmp_path: Path) -> None:
    """In the hollow of a limacon the rows of a polygon bend sharply, and none of them stands out."""
    angle = 2.0 * np.pi * np.arange(360) / 360
    reach = 400.0 + 360.0 * np.cos(angle)
    path = polygon(tmp_path / "limacon.dxf", np.column_stack((reach * np.cos(angle), reach * np.sin(angle))))
    followed = camgeo.follow(path, shoe=60.0, rotation="ccw")
    recipe = tmp_path / "cam.yaml"
    recipe.write_text(followed.recipe("lift.csv"), encoding="utf-8")
    (tmp_path / "lift.csv").write_text(followed.lifts(), encoding="utf-8")
    lift = camgeo.design(recipe).motion(followed.theta)
    np.testing.assert_allclose(lift, followed.position - followed.least[0], atol=0.0101)
    kept = camgeo.load(recipe).cam.exact().kept
    assert "table-row" not in {remark.name for remark in kept.remarks}


def test_an_eccentric_circle_by_hand(tmp_path: Path) -> None:
    """A knife edge, a flat face and a yoke on a circle of radius 20 about a point 5 mm from the shaft."""
    path = tmp_path / "eccentric.dxf"
    document = ezdxf.new("R2010")
    document.header["$INSUNITS"] = 4
    document.modelspace().add_circle((5.0, 0.0), 20.0, dxfattribs={"layer": "0"})
    document.modelspace().add_circle((0.0, 0.0), 6.0, dxfattribs={"layer": "0"})
    document.saveas(path)
    flat = camgeo.follow(path, flat=True, yoke=True)
    np.testing.assert_allclose(flat.position, 20.0 + 5.0 * np.cos(flat.theta), atol=1e-12)
    np.testing.assert_allclose(flat.velocity, -5.0 * np.sin(flat.theta), atol=1e-12)
    np.testing.assert_allclose(flat.acceleration, -5.0 * np.cos(flat.theta), atol=1e-12)
    np.testing.assert_allclose(flat.radius, 20.0, atol=1e-12)
    assert flat.breadth == pytest.approx((40.0, 40.0), abs=1e-12)
    assert (flat.lift, flat.bore) == pytest.approx((10.0, 12.0), abs=1e-12)
    edge = camgeo.follow(path, roller=0.0)
    reach = 5.0 * np.cos(edge.theta) + np.sqrt(400.0 - 25.0 * np.sin(edge.theta) ** 2)
    np.testing.assert_allclose(edge.position, reach, atol=1e-12)
    roller = camgeo.follow(path, roller=3.0)
    np.testing.assert_allclose(
        roller.position, 5.0 * np.cos(edge.theta) + np.sqrt(529.0 - 25.0 * np.sin(edge.theta) ** 2)
    )
    np.testing.assert_allclose(roller.radius, 20.0, atol=1e-9)
    np.testing.assert_allclose(np.sin(roller.pressure_angle), -5.0 * np.sin(roller.theta) / 23.0, atol=1e-12)


@pytest.mark.parametrize("follower", [{"roller": 5.0}, {"flat": True}])
def test_kinks_of_six_decimals_are_no_corners(tmp_path: Path, follower: dict[str, Any]) -> None:
    """An eccentric circle in arcs of six decimals, which meet just where the follower stands at each 5 degrees."""
    phi, eccentricity, radius = np.radians(np.arange(0.0, 360.0, 5.0)), 8.0, 30.0
    touch = follower.get("roller", math.inf)
    sine = np.sin(phi) * eccentricity / (radius + touch)
    turn = phi if math.isinf(touch) else phi + np.arcsin(sine)
    points = np.round(np.column_stack([eccentricity + radius * np.cos(turn), radius * np.sin(turn)]), 6)
    bulges = np.round(np.tan(0.25 * np.mod(np.roll(turn, -1) - turn, 2 * math.pi)), 6)
    document = ezdxf.new("R2000")
    document.header["$INSUNITS"] = 4
    document.modelspace().add_lwpolyline(np.column_stack([points, bulges]), format="xyb", close=True)
    document.saveas(tmp_path / "cam.dxf")
    followed = camgeo.follow(tmp_path / "cam.dxf", **follower)
    assert np.abs(followed.radius - radius).max() < 0.01
    across, along = -eccentricity * np.sin(followed.theta), eccentricity * np.cos(followed.theta)
    reach = radius + (0.0 if math.isinf(touch) else touch)
    root = np.sqrt(reach**2 - across**2)
    exact = -along if math.isinf(touch) else -along - (along**2 - across**2) / root - (across * along) ** 2 / root**3
    assert np.abs(followed.acceleration - exact).max() < 0.01


def test_a_corner_is_one_still(tmp_path: Path) -> None:
    followed = camgeo.follow(polygon(tmp_path / "polygon.dxf", circle(360, 30.0, (0.0, 0.0))), roller=5.0)
    assert (followed.radius == 0.0).any()


def test_the_shaft_stands_where_the_call_says(tmp_path: Path) -> None:
    moved = polygon(tmp_path / "moved.dxf", circle(720, 20.0, (105.0, 40.0)))
    with pytest.raises(camgeo.CallError, match="no closed contour goes round the shaft at 0, 0 mm; give at"):
        camgeo.follow(moved, flat=True)
    followed = camgeo.follow(moved, flat=True, at=(100.0, 40.0))
    np.testing.assert_allclose(followed.position, 20.0 + 5.0 * np.cos(followed.theta), atol=2e-4)
    with pytest.raises(camgeo.CallError, match="move the shaft there, or leave page out"):
        judged_by_recipe(followed)


@pytest.mark.thin(3)
@pytest.mark.parametrize("name", ["my cam", "Nocken-ä", "x.rejected"])
def test_a_page_is_of_a_file_of_any_name(eccentric: Path, tmp_path: Path, name: str, capsys) -> None:
    """Its recipe has no name of its own, and the page has that of the file."""
    drawing, page = tmp_path / f"{name}.dxf", tmp_path / "page.html"
    drawing.write_bytes(eccentric.read_bytes())
    assert main(["follow", str(drawing), "--roller", "9", "--page", str(page)]) == OK
    assert f"<title>{name}" in page.read_text("utf-8")
    assert capsys.readouterr().err == ""


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no pipes with names")
def test_what_is_no_file_says_what_it_is(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe.dxf")
    (tmp_path / "folder.dxf").mkdir()
    named = {
        "pipe": "a pipe, a socket or a device, not a file",
        "folder": "a folder",
        "none": "the file does not exist",
        "x" * 300: "cannot be read: ",
    }
    for name, why in named.items():
        with pytest.raises(camgeo.CallError, match=re.escape(f"{name}.dxf: {why}")):
            camgeo.follow(tmp_path / f"{name}.dxf", roller=8.0)


@pytest.mark.slow
@pytest.mark.parametrize("name", few([*FOLLOWERS], 2))
def test_its_recipe_makes_the_file_again(drawings: dict[str, Path], tmp_path: Path, name: str, capsys) -> None:
    """Within the reading, by the judge; and a page shows how far off the file is all round."""
    words = {"disc-roller": "--roller 9 --offset 10", "disc-arm": "--roller 8 --arm 80,65", "disc-flat": "--flat"}
    call = ["follow", str(drawings[name]), *words.get(name, "--roller 0").split()]
    call += ["--rotation", camgeo.load(RECIPES / f"{name}.yaml").rotation, "--reading", "0.002"]
    files = {key: tmp_path / f"{name}.{end}" for key, end in {"recipe": "yaml", "page": "html"}.items()}
    files["table"] = tmp_path / "turn.csv"
    for key, path in files.items():
        call += [f"--{key}", str(path)]
    assert main(call) == OK, capsys.readouterr()
    assert "lift" in capsys.readouterr().out
    report = camgeo.verify(files["recipe"], drawings[name], tolerance=0.006)
    assert [check.name for check in report.checks if not check.ok and check.name not in {"bore", "holes"}] == []
    assert "Error of the files round the contour" in files["page"].read_text("utf-8")
    head, first = files["table"].read_text("utf-8").splitlines()[:2]
    assert head.startswith("shaft_deg,position_")
    assert first.startswith("0,")
    assert main(call) == WRONG
    assert "exists already and is left as it is" in capsys.readouterr().err


OPENINGS: dict[str, tuple[list[list[tuple[float, float, float]]], int, float | None]] = {
    "keyway": ([[(4, 3, 0), (-4, 3, 0), (-4, -3, 0), (4, -3, 0), (5, -1, 0), (5, 1, 0)]], 1, None),
    "D": ([[(3.0, 4.0, 1.6), (3.0, -4.0, 0.0)]], 1, None),
    "round": ([[(5, 0, 1), (-5, 0, 1)]], 0, 10.0),
    "round and four holes": (
        [[(5, 0, 1), (-5, 0, 1)], *([(x + 1.0, 9.0, 1.0), (x - 1.0, 9.0, 1.0)] for x in (-9.0, -3.0, 3.0, 9.0))],
        4,
        10.0,
    ),
    "counterbore": ([[(8, 0, 1), (-8, 0, 1)], [(5, 0, 1), (-5, 0, 1)]], 1, 16.0),
    "keyway round a circle": ([[(6, 5, 0), (-6, 5, 0), (-6, -5, 0), (6, -5, 0)], [(4, 0, 1), (-4, 0, 1)]], 2, None),
    "no shaft": ([[(12, 0, 1), (9, 0, 1)]], 1, None),
}


@pytest.mark.slow
@pytest.mark.parametrize("name", OPENINGS)
def test_openings_are_passed_over_and_said(eccentric: Path, tmp_path: Path, name: str) -> None:
    openings, count, bore = OPENINGS[name]
    document = ezdxf.readfile(eccentric)
    for points in openings:
        document.modelspace().add_lwpolyline(points, "xyb", close=True, dxfattribs={"layer": "0"})
    path = tmp_path / "foreign.dxf"
    document.saveas(path)
    followed, plain = (camgeo.follow(file, roller=9.0) for file in (path, eccentric))
    np.testing.assert_array_equal(followed.position, plain.position)
    assert (followed.openings, followed.bore) == (count, bore and pytest.approx(bore))
    assert ("passed over" in summary(followed)) == (count > 0)
    (tmp_path / "lift.csv").write_text(followed.lifts(), "utf-8")
    (tmp_path / "again.yaml").write_text(followed.recipe("lift.csv"), "utf-8")
    recipe = camgeo.load(tmp_path / "again.yaml")
    assert (recipe.verify.openings, recipe.part.bore) == ("ignore" if count else "judge", bore and pytest.approx(bore))
    report = judged_by_recipe(followed)
    assert report.ok, str(report)
    assert [remark.name for remark in report.remarks if remark.name == "openings"] == ["openings"] * (count > 0)


@pytest.mark.parametrize("turned", [0.0, 50.0, 180.0])
def test_a_yokes_recipe_begins_where_the_cam_stands(tmp_path: Path, turned: float) -> None:
    """An eccentric circle, by hand, whose lift begins anywhere between its least and its greatest."""
    path = tmp_path / "eccentric.dxf"
    document = ezdxf.new("R2010")
    document.header["$INSUNITS"] = 4
    middle = 5.0 * math.cos(math.radians(turned)), 5.0 * math.sin(math.radians(turned))
    document.modelspace().add_circle(middle, 20.0, dxfattribs={"layer": "0"})
    document.saveas(path)
    followed = camgeo.follow(path, flat=True, yoke=True)
    (tmp_path / "cam.yaml").write_text(followed.recipe("lift.csv"), encoding="utf-8")
    (tmp_path / "lift.csv").write_text(followed.lifts(), encoding="utf-8")
    design = camgeo.design(tmp_path / "cam.yaml")
    lift = 5.0 * np.cos(followed.theta - math.radians(turned)) - middle[0]
    np.testing.assert_allclose(design.motion(followed.theta) - design.motion(0.0), lift, atol=0.0201)


def test_as_json(drawings: dict[str, Path], capsys) -> None:
    assert main(["follow", str(drawings["disc-flat"]), "--flat", "--yoke", "--json"]) == OK
    found = json.loads(capsys.readouterr().out)
    assert found["lift"] == pytest.approx(12.0, abs=1e-4)
    assert found["breadth"][1] == pytest.approx(72.0, abs=1e-3)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        ({}, "a follower has a roller, of radius 0 for a knife edge, or a shoe, or is flat: give one of them"),
        ({"roller": 1.0, "flat": True}, "give one of them"),
        ({"roller": 1.0, "shoe": 30.0}, "give one of them"),
        ({"shoe": 0.0}, "a shoe has a radius above 0, not 0.0; a knife edge is a roller of radius 0"),
        ({"roller": 1e9}, "roller is a length of at most 2000000 mm, not 1000000000.0"),
        ({"roller": math.nan}, "roller is a length of at most 2000000 mm, not nan"),
        ({"flat": True, "width": 0.0}, "a face has a width above 0, not 0.0"),
        ({"flat": True, "width": 27.0, "arm": 80.0}, "only a flat face on a line of travel has a width"),
        ({"roller": 3.0, "width": 27.0}, "only a flat face on a line of travel has a width"),
        ({"flat": True, "width": 20.0}, "the contact leaves the face: it runs from -"),
        ({"flat": True, "track": "internal"}, "inside a ring a roller runs: give roller above 0, without yoke"),
        ({"roller": 0.0, "track": "groove"}, "in a groove a roller runs: give roller above 0, without yoke"),
        ({"roller": 3.0, "track": "outside"}, "a track is one of external, internal, groove, not 'outside'"),
        (
            {"roller": 3.0, "track": "groove"},
            "no groove for this roller, whose play between the two outermost",
        ),
        ({"roller": -1.0}, "a roller has a radius of 0 or above, not -1.0; 0 is a knife edge"),
        ({"roller": 3.0, "arm": 80.0}, "give arm as pivot distance and length, 80,65"),
        ({"flat": True, "arm": (80.0, 65.0)}, "give arm as the pivot's distance alone"),
        ({"roller": 3.0, "arm": (80.0, 65.0), "offset": 1.0}, "an arm has no offset: leave one of them out"),
        ({"roller": 3.0, "leading": True}, "only an arm leads: leave leading out, or give arm"),
        ({"roller": 3.0, "yoke": True, "offset": 2.0}, "leave arm and offset out"),
        ({"roller": 3.0, "arm": (80.0, 65.0, 3.0)}, "arm is the distance of its pivot"),
        ({"roller": 3.0, "arm": (80.0, -65.0)}, "an arm's pivot and length are lengths above 0, not 80.0, -65.0"),
        ({"roller": 3.0, "at": (1.0,)}, "at is the place of the shaft in the file"),
        ({"roller": 3.0, "reading": 0.0}, "a reading is a length above 0"),
        ({"roller": 3.0, "steps": 3}, "a turn is looked at in 36 to 100000 steps"),
        ({"roller": 3.0, "at": (1e5, 0.0)}, "no closed contour goes round the shaft at 100000, 0 mm; give at"),
        ({"roller": 3.0, "units": "inch"}, "states its unit itself: leave units out, or save the file with"),
        ({"roller": 3.0, "arm": (80.0, 20.0)}, "the roller does not touch the contour at"),
        ({"roller": 3.0, "offset": 200.0}, " degrees; give the machine's offset or arm, and its shaft by at"),
    ],
)
def test_what_makes_no_sense_is_refused(drawings: dict[str, Path], call: dict[str, Any], message: str) -> None:
    with pytest.raises(camgeo.CallError) as refused:
        camgeo.follow(drawings["disc-roller"], **call)
    assert message in str(refused.value)


def test_files_that_are_none(tmp_path: Path) -> None:
    (tmp_path / "bad.dxf").write_text("nothing", encoding="utf-8")
    (tmp_path / "table.pdf").write_text("1,2\n", encoding="utf-8")
    for name, message in {
        "bad.dxf": "bad.dxf: ",
        "table.pdf": "no drawing, no solid and no points: give one of .dxf, .svg",
        "gone.dxf": "the file does not exist",
    }.items():
        with pytest.raises(camgeo.CallError) as refused:
            camgeo.follow(tmp_path / name, roller=3.0)
        assert message in str(refused.value)
    document = ezdxf.new("R2010")
    document.header["$INSUNITS"] = 4
    document.modelspace().add_circle((5.0, 0.0), 20.0, dxfattribs={"layer": "0"})
    document.saveas(tmp_path / "round.dxf")
    with pytest.raises(
        camgeo.CallError, match="one closed contour goes round the shaft at 0, 0 mm, and a groove has two"
    ):
        camgeo.follow(tmp_path / "round.dxf", roller=3.0, track="groove")
    ring = camgeo.follow(tmp_path / "round.dxf", roller=3.0, track="internal")
    with pytest.raises(camgeo.CallError, match="a ring's recipe has a round outline"):
        ring.recipe("lift.csv")
    for radius in (30.0, 12.0):
        document.modelspace().add_circle((5.0, 0.0), radius, dxfattribs={"layer": "0"})
    document.saveas(tmp_path / "nested.dxf")
    with pytest.raises(camgeo.CallError, match="lies inside a hole; it is 24 x 24 mm; of a groove give track groove"):
        camgeo.follow(tmp_path / "nested.dxf", roller=5.0, track="internal")
    groove = camgeo.follow(tmp_path / "nested.dxf", roller=5.0, track="groove")
    assert groove.play == pytest.approx((0.0, 0.0), abs=1e-9)
    (tmp_path / "empty.svg").write_text("", encoding="utf-8")
    (tmp_path / "empty.stl").write_text("", encoding="utf-8")
    for empty in ("empty.svg", "empty.stl"):
        with pytest.raises(camgeo.CallError, match=empty):
            camgeo.follow(tmp_path / empty, roller=3.0)
    unstated = polygon(tmp_path / "unstated.dxf", circle(360, 1.0, (0.25, 0.0)), unit=0)
    with pytest.raises(camgeo.CallError, match="the drawing states no unit: give units"):
        camgeo.follow(unstated, flat=True)
    assert camgeo.follow(unstated, flat=True, units="inch").lift == pytest.approx(12.7, abs=1e-3)


def test_a_recipe_of_a_yoke_whose_breadth_varies_is_refused(drawings: dict[str, Path]) -> None:
    followed = camgeo.follow(drawings["disc-flat"], flat=True, yoke=True)
    with pytest.raises(camgeo.CallError) as refused:
        followed.recipe("lift.csv")
    text = str(refused.value)
    assert text.startswith(f"{drawings['disc-flat']}: the breadth varies by 8.2")
    wide = float(text.partition("give reading ")[2].split()[0])
    assert "constant-breadth" in camgeo.follow(drawings["disc-flat"], flat=True, yoke=True, reading=wide).recipe(
        "a.csv"
    )
    odd = camgeo.follow(drawings["disc-flat"], flat=True, yoke=True, reading=wide, steps=361)
    with pytest.raises(camgeo.CallError, match="give an even number of steps"):
        odd.recipe("lift.csv")


MADE: dict[str, dict[str, Any]] = {
    "disc-shoe": {"shoe": 60.0},
    "disc-flat": {"flat": True, "width": 28.0},
    "disc-ring": {"roller": 9.0, "track": "internal"},  # needs: milling
    "groove-stem": {"roller": 8.0, "offset": 5.0, "track": "groove"},  # needs: milling
    "groove-arm": {"roller": 8.0, "arm": (90.0, 75.0), "track": "groove"},
    "shu-wu": {"flat": True, "yoke": True},
    "two-rollers": {"roller": 8.0, "yoke": True},
}


TWO_ROLLERS: dict[str, Any] = {
    "name": "two-rollers",
    "cam": {
        "kind": "constant-diameter",
        "base_radius": 28,
        "roller_radius": 8,
        "motion": [{"rise": 12, "over": 80, "law": "modified-sine"}, {"dwell": 100}],
    },
    "part": {"thickness": 8, "bore": 12},
}


@pytest.mark.thin(42)
@pytest.mark.parametrize(  # two kinds of file of each, and each kind in both senses
    ("name", "kind", "rotation"),
    [
        (name, ("dxf", "svg", "stl")[(number + k) % 3], ("cw", "ccw")[(number + k) % 2])
        for number, name in enumerate(MADE)
        for k in range(2)
    ],
)
def test_each_follower_on_each_kind_of_file(
    tmp_path: Path, name: str, kind: str, rotation: Literal["cw", "ccw"]
) -> None:
    """The law, the pressure angle, and a recipe whose cam is the file's within two readings, by the judge."""
    shipped = RECIPES / f"{name}.yaml"
    recipe = camgeo.load(shipped if shipped.is_file() else TWO_ROLLERS)
    recipe = recipe.replace({"export.files": [kind], "export.tolerance": 1e-4, "rotation": rotation})
    report = camgeo.export(recipe, tmp_path)
    assert report.path is not None
    path = report.path / f"{name}.{kind}"
    followed = camgeo.follow(path, **MADE[name], rotation=rotation, reading=0.005)
    design = camgeo.design(recipe)
    law = design.motion(followed.theta)
    lever = 75.0 if followed.unit == "rad" else 1.0
    lift = followed.position - followed.position[0] - (law - law[0])
    assert float(np.abs(lever * lift).max()) < 4e-4
    (tmp_path / "found.yaml").write_text(followed.recipe("lift.csv"), encoding="utf-8")
    (tmp_path / "lift.csv").write_text(followed.lifts(), encoding="utf-8")
    verdict = camgeo.verify(tmp_path / "found.yaml", path, tolerance=0.012)
    unsaid = {"bore", "holes", "keyway", "hole-positions"}  # bolts and keyways are not in the recipe
    assert [check.name for check in verdict.checks if not check.ok and check.name not in unsaid] == []
    if followed.play is not None:
        normal = lever * np.array(followed.play)
        assert 0.019 < normal[0] <= normal[1] < 0.04
    if followed.breadth is not None:
        assert followed.breadth[1] - followed.breadth[0] < 4e-4


@pytest.mark.parametrize("name", [".", "found", "found.csv"])
def test_a_recipe_has_the_name_of_one(name: str, capsys) -> None:
    with pytest.raises(SystemExit) as left:
        main(["follow", "cam.dxf", "--flat", "--recipe", name])
    assert left.value.code == WRONG
    assert "a file whose name ends in .yaml is expected" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("files", "message"),
    [
        (["--recipe", "new.yaml", "--table", "new.csv"], "new.csv {} --table and by the lifts of --recipe: give"),
        (["--recipe", "new.yaml", "--table", "./new.yaml"], "new.yaml {} --table and by --recipe: give"),
        (["--table", "new.html", "--page", "new.html"], "new.html {} --table and by --page: give"),
    ],
)
def test_a_file_is_not_written_twice(eccentric: Path, tmp_path: Path, capsys, files: list[str], message: str) -> None:
    """The table of lifts beside a recipe has the recipe's name: a table of that name would be lost."""
    drawing = str(eccentric)
    files = [name if name.startswith("--") else f"{tmp_path}/{name}" for name in files]
    assert main(["follow", drawing, "--roller", "9", *files]) == WRONG
    assert message.format("would be written twice, by") in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []
    assert main(["follow", drawing, "--roller", "9", *files[:3], f"{tmp_path}/other.csv"]) == OK
