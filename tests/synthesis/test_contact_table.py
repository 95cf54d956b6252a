"""Tables of contacts and over the polar angle, as files hold them: against differences and the drawing.

Holds: camgeo.formats.tables.contacts, camgeo.formats.tables.motion, camgeo.formats.tables.polar.
"""

from __future__ import annotations

import csv
import math
from typing import TYPE_CHECKING

import numpy as np
import pytest
from support.places import ROOT

from camgeo.formats.csv import MODULES
from camgeo.output import pipeline
from camgeo.recipe.loading import load_text
from camgeo.schema.errors import RecipeErrors
from camgeo.synthesis.design import designed

if TYPE_CHECKING:
    from pathlib import Path

    from kin.numeric.arrays import Array

MOTION = (
    "[{dwell: 40}, {rise: 18, over: 110, law: modified-sine}, {dwell: 60}, {return: 18, over: 100, law: cycloidal}, "
)
MOTION += "{dwell: 50}]"
SWING = MOTION.replace("18", "12")
DISC = "cam: {kind: disc, base_radius: 36, follower: {%s}, motion: %s}\n"
KINDS = {
    "roller": DISC % ("kind: roller, radius: 9, offset: 8", MOTION),
    "ring": DISC.replace("follower", "track: internal, follower") % ("kind: roller, radius: 9", SWING)
    + "part: {outer: 140}\n",
    "shoe": DISC % ("kind: shoe, radius: 60", MOTION),
    "knife edge": DISC % ("kind: knife-edge", MOTION),
    "flat": DISC % ("kind: flat, tilt: 8, offset: 5", SWING),
    "arm": DISC % ("kind: roller, radius: 8, arm: {length: 65, pivot: 80, side: leading}", SWING),
    "arm with a face": DISC % ("kind: flat, arm: {pivot: 90, face: 10}", SWING.replace("12", "8")),
    "roller yoke": "cam: {kind: constant-diameter, base_radius: 30, roller_radius: 8, "
    "motion: [{rise: 12, over: 120, law: cycloidal}, {dwell: 60}]}\n",
    "plate": "cam: {kind: support, p: 30 + 2*cos(2*t) + cos(3*t)}\n",
    "double roller": "cam: {kind: double-roller, ratio: 4/3, arm: 60, roller_radius: 8, delta: {cos: {1: 300}}}\n",
    "flat pair": "cam: {kind: flat-pair, ratio: 2, arm: 30, delta: {cos: {1: 252}}}\n",
    "linkage": "cam: {kind: support, p: 25 + sin(3*t) + 13/15*sin(3*t)*cos(2*t), shaft: [18, 8.5]}\n"
    "linkage: {kind: four-bar, ground: 80, coupler: 70, rocker: 105}\n",
}
FILES = "export: {files: [csv, {csv: {as: contacts}}, {csv: {as: polar}}, {csv: {as: inspection}}]}\n"


def exported(text: str, folder: Path, files: str = FILES) -> dict[str, dict[str, Array]]:
    recipe = load_text(text + files, "cam.yaml")
    pipeline.export(recipe, folder)
    found = {}
    for path in folder.rglob("*.csv"):
        with path.open(encoding="ascii", newline="") as stream:
            head, *rows = list(csv.reader(stream))
        columns = np.array([[float(cell) if cell else math.nan for cell in row] for row in rows]).T
        found[path.stem.removeprefix("cam-").replace("cam", "motion")] = dict(zip(head, columns, strict=True))
    return found


@pytest.mark.thin(16)
@pytest.mark.parametrize("name", KINDS)
def test_contacts_of_every_kind(name: str, tmp_path: Path) -> None:
    tables = exported(KINDS[name] + "verify: {angles: 720}\n", tmp_path)
    motion, contacts, seen = tables["motion"], tables["contacts"], tables["inspection"]
    assert list(contacts)[: len(motion)] == list(motion)
    assert all(np.array_equal(contacts[column], motion[column]) for column in motion)
    for mark in ("a_", "b_") if "a_x_mm" in contacts else ("",):
        x, y = contacts[f"{mark}x_mm"], contacts[f"{mark}y_mm"]
        assert x == pytest.approx(seen[f"{mark}x_mm"], abs=1e-12)
        assert y == pytest.approx(seen[f"{mark}y_mm"], abs=1e-12)
        # turn of the normal over the way, from the inspection table's own columns
        turned = np.unwrap(np.radians(seen[f"{mark}normal_deg"]))
        way = np.hypot(np.diff(x), np.diff(y)) * np.sign(
            np.diff(x) * -seen[f"{mark}ny"][:-1] + np.diff(y) * seen[f"{mark}nx"][:-1]
        )
        with np.errstate(divide="ignore", invalid="ignore"):
            between = way / np.diff(turned)
        radius = contacts[f"{mark}radius_of_curvature_mm"]
        low, high = np.minimum(radius[:-1], radius[1:]), np.maximum(radius[:-1], radius[1:])
        smooth = (np.abs(high - low) < 0.1 * np.abs(low)) & (low * high > 0) & (np.abs(way) > 1e-6)
        assert smooth.sum() > 300
        assert np.abs(between / (0.5 * (low + high)) - 1.0)[smooth].max() < 0.05


@pytest.mark.slow
def test_pressure_angles_are_those_of_the_limits(tmp_path: Path) -> None:
    from camgeo.measures.figures import design_figures

    recipe = load_text(KINDS["roller"], "cam.yaml")
    design = designed(recipe)
    most = design_figures(recipe, design, design.checks, ["pressure-angle-rise", "pressure-angle-return"])
    angle = exported(KINDS["roller"], tmp_path)["contacts"]["pressure_angle_deg"]
    assert angle.max() == pytest.approx(most["pressure-angle-rise"].value, abs=1e-4)
    assert -angle.min() == pytest.approx(most["pressure-angle-return"].value, abs=1e-4)


@pytest.mark.thin(8)
@pytest.mark.parametrize("kind", ["roller", "flat", "arm", "plate", "knife edge"])
@pytest.mark.parametrize("rotation", ["cw", "ccw"])
def test_polar_radii_are_those_of_the_drawn_contour(kind: str, rotation: str, tmp_path: Path) -> None:
    from camgeo.api.designing import design

    text = f"rotation: {rotation}\n" + KINDS[kind] + "verify: {angles: 90}\n"
    table = exported(text, tmp_path)["polar"]
    assert table["polar_deg"].tolist() == [4.0 * i for i in range(91)]
    assert table["radius_mm"][0] == table["radius_mm"][-1]
    points = design(load_text(text, "cam.yaml")).contour(200_000)
    turned = np.unwrap(np.arctan2(points[:, 1], points[:, 0]))
    wanted = np.radians(table["polar_deg"])
    wanted = np.mod(wanted - turned[0], 2 * math.pi) + turned[0]
    assert table["radius_mm"] == pytest.approx(np.interp(wanted, turned, np.hypot(*points.T)), abs=1e-7)


def test_the_metal_is_not_base_radius_and_lift(tmp_path: Path) -> None:
    tables = exported(KINDS["roller"] + "verify: {angles: 90}\n", tmp_path)
    assert np.abs(36.0 + tables["motion"]["lift_mm"] - tables["polar"]["radius_mm"]).max() > 0.5


@pytest.mark.slow
def test_inches(tmp_path: Path) -> None:
    inch = "units: inch\ncam: {kind: disc, base_radius: 1.5, follower: {kind: roller, radius: 0.4}, motion: %s}\n"
    tables = exported(inch % MOTION.replace("18", "0.5"), tmp_path)
    assert {"radius_of_curvature_in", "pressure_angle_deg", "x_in", "y_in"} <= set(tables["contacts"])
    assert tables["contacts"]["radius_of_curvature_in"][0] == pytest.approx(1.5)
    assert tables["polar"]["radius_in"].min() == pytest.approx(1.5)
    assert tables["polar"]["radius_in"].max() == pytest.approx(2.0)


@pytest.mark.slow
def test_a_trimmed_cam_is_not_touched_everywhere(tmp_path: Path) -> None:
    cut = "cam: {kind: disc, base_radius: 8, follower: {kind: roller, radius: 18}, undercut: trim, motion: "
    cut += "[{rise: 20, over: 60, law: cycloidal}, {dwell: 10}, {return: 20, over: 60, law: cycloidal}, "
    cut += "{dwell: 115}, {dwell: 115}]}\n"
    contacts = exported(cut, tmp_path)["contacts"]
    lost = np.isnan(contacts["x_mm"])
    assert 32.61 < contacts["shaft_deg"][lost].min() < 32.71
    assert 97.29 < contacts["shaft_deg"][lost].max() < 97.39
    assert np.array_equal(lost, np.isnan(contacts["pressure_angle_deg"]))


def test_no_polar_table_of_a_shaft_outside(tmp_path: Path) -> None:
    text = "cam: {kind: support, p: 30, shaft: [40, 0]}\nexport:\n  files:\n    - dxf\n    - {csv: {as: polar}}\n"
    with pytest.raises(RecipeErrors) as caught:
        pipeline.export(load_text(text, "cam.yaml"), tmp_path)
    (error,) = caught.value.errors
    assert str(error).startswith("cam.yaml:5:18: export.files[1].csv.as: a ray from the shaft may cross the contour")
    assert "give `as: inspection`" in str(error)
    pipeline.export(load_text(text.replace("polar", "inspection"), "cam.yaml"), tmp_path)


def test_a_motion_table_is_as_it_was(tmp_path: Path) -> None:
    for text in (KINDS["roller"], KINDS["plate"]):
        (table,) = exported(text, tmp_path, "export: {files: [csv]}\n").values()
        assert list(table) == ["shaft_deg", "lift_mm", "velocity", "acceleration", "jerk"]


def test_the_page_tells_of_every_table() -> None:
    page = (ROOT / "docs" / "recipe-export.md").read_text(encoding="utf-8")
    assert [name for name in MODULES if f"`{name}`:" not in page] == []


# --- perimeter and area -----------------------------------------------------------------------------------------------


@pytest.mark.thin(2)
@pytest.mark.parametrize("units", ["mm", "inch"])
def test_perimeter_and_area_in_the_report(units: str) -> None:
    text = f"units: {units}\ncam: {{kind: support, p: 2 + 0.05*cos(3*t)}}\npart: {{thickness: 1, bore: 0.5}}\n"
    text += "export: {tolerance: 1e-5, files: [dxf, stl, {svg: {as: polyline}}, csv]}\n"
    recipe = load_text(text, "cam.yaml")
    report = pipeline.check(recipe).report
    # Cauchy: the perimeter is that of the mean circle; the area is pi (p0^2 - (k^2 - 1) c^2/2)
    exact = {"perimeter": 4 * math.pi, "area": math.pi * (4 - 8 * 0.05**2 / 2)}
    assert report["contour"] == pytest.approx(exact, rel=1e-12)
    files = [file for file in report["files"] if file["kind"] != "csv"]
    assert len(files) == 3
    for file in files:
        assert file["area"] == pytest.approx(exact["area"], abs=1e-5 * exact["perimeter"] * 1.01)
        assert file["perimeter"] == pytest.approx(exact["perimeter"], abs=1e-4)
    assert "area" not in next(file for file in report["files"] if file["kind"] == "csv")


@pytest.mark.slow
def test_of_a_file_from_elsewhere_they_are_its_own(tmp_path: Path) -> None:
    recipe = load_text("cam: {kind: support, p: 30 + cos(3*t)}\nexport: {files: [dxf]}\n", "cam.yaml")
    pipeline.export(recipe, tmp_path)
    path = next(tmp_path.rglob("*.dxf"))
    other = load_text("cam: {kind: support, p: 31 + cos(3*t)}\nexport: {files: [dxf]}\n", "cam.yaml")
    report = pipeline.judge_files(other, [path])
    assert report["files"][0]["perimeter"] == pytest.approx(60 * math.pi, rel=1e-6)
    assert report["contour"]["perimeter"] == pytest.approx(62 * math.pi, rel=1e-12)
    import camgeo

    (file,) = camgeo.verify(other, path).files
    assert (file.perimeter, file.area) == (report["files"][0]["perimeter"], report["files"][0]["area"])


def test_without_a_contour_there_is_none() -> None:
    text = "cam: {kind: support, p: 3 + cos(3*t)}\n"
    assert pipeline.check(load_text(text, "cam.yaml")).report["contour"] is None
