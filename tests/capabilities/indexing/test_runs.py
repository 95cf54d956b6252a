"""Runs of indexing cams from the recipe to table and page, the library, and the texts of what fails.

Holds: camgeo.capabilities.indexing.library, camgeo.capabilities.indexing.pipeline,
camgeo.capabilities.indexing.root, camgeo.capabilities.indexing.index_page,
camgeo.capabilities.indexing.starter, camgeo.capabilities.indexing.making,
camgeo.capabilities.indexing.verdicts.
"""

from __future__ import annotations

import json
import math
from typing import TYPE_CHECKING

import numpy as np
import pytest
from capabilities.indexing.made_indexers import BARREL, GLOBOID, changed, recipe_of, rollers_of, shared_design
from support.places import ROOT

import camgeo
from camgeo.capabilities.indexing.library import cam_of, foreseen, remedy
from camgeo.capabilities.indexing.turning import scene
from camgeo.cli.main import main
from camgeo.common.errors import CallError
from camgeo.recipe.starter import starter
from camgeo.schema.errors import RecipeErrors

if TYPE_CHECKING:
    from pathlib import Path

DRIVE = ("  motion", "  drive: {rpm: 60, load: 20, material: steel}\n  motion")


def written(folder: Path, text: str) -> Path:
    path = folder / "index.yaml"
    path.write_text(text, "utf-8")
    return path


@pytest.mark.parametrize("text", [BARREL, GLOBOID], ids=["barrel", "globoid"])
def test_a_run_writes_table_page_and_report(text: str, tmp_path: Path) -> None:
    path = written(tmp_path, changed(text, ("[stl]", "[{csv: {step: 90}}, html]")))
    assert main(["export", str(path), "--out", str(tmp_path / "out")]) == 0
    folder = tmp_path / "out" / "index"
    rows = np.genfromtxt(folder / "index.csv", delimiter=",", skip_header=1)
    assert rows[:, 0] == pytest.approx([0.0, 90.0, 180.0, 270.0])
    pitch = 60.0 if text == BARREL else 45.0
    assert rows[[0, 2], 1] == pytest.approx([-0.5 * pitch, 0.5 * pitch])
    report = json.loads((folder / "report.json").read_text("utf-8"))
    assert {entry["name"] for entry in report["indexing"]["figures"]} >= {"pressure-angle", "engaged-least"}
    page = (folder / "index.html").read_text("utf-8")
    assert "Pressure angle" in page
    assert "contact-length" in page


@pytest.mark.parametrize(("text", "least"), [(BARREL, "6.5"), (GLOBOID, "6.75")], ids=["barrel", "globoid"])
def test_a_solid_too_coarse_for_its_flanks_is_refused_with_a_tolerance_that_does(
    text: str, least: str, tmp_path: Path
) -> None:
    coarse = changed(text, ("tolerance: 0.01", "tolerance: 20"))
    wanted = rf"export\.tolerance: the flanks are .* given 20 mm; give at most {least} mm"
    with pytest.raises(RecipeErrors, match=wanted):
        camgeo.export(written(tmp_path, coarse), tmp_path / "out")
    assert camgeo.export(
        written(tmp_path, changed(coarse, ("tolerance: 20", f"tolerance: {least}"))), tmp_path / "out"
    ).ok


@pytest.mark.slow
@pytest.mark.parametrize("head", ["", "rotation: ccw\n"])
@pytest.mark.parametrize("text", [BARREL, GLOBOID], ids=["barrel", "globoid"])
def test_rollers_are_drawn_where_the_turret_leads_them(text: str, head: str) -> None:
    """To the right of the viewer y counts, of a globoid the distance from the cam's axis; rollers stand at psi."""
    design = shared_design(head + text)
    sizes = vars(design.recipe.form)
    bodies = {body.name: body for body in scene(design).bodies}
    for step in (0, 100, 260):
        theta = np.array([math.radians(0.5 * step)])
        psi = float(rollers_of(design, 150.0 if text == BARREL else 120.0).psi(theta)[0])
        found = [
            bodies["rollers"].placed(shape.rings[0].points, step).mean(axis=0) for shape in bodies["rollers"].shapes
        ]
        if text == BARREL:
            wanted = (sizes["offset"] - 60.0 * math.cos(psi)) * (-1.0 if head else 1.0), 40.0 + 60.0 * math.sin(psi)
        else:
            middle = 0.5 * (49.0 + math.sqrt(62.0**2 - 8.0**2))
            wanted = 90.0 - middle * math.cos(psi), 30.0 + middle * math.sin(psi)
        assert min(math.dist(place, wanted) for place in found) < 0.2


def test_the_library() -> None:
    cam = cam_of(recipe_of(changed(BARREL, DRIVE)))
    assert cam.ok
    assert str(cam) == "index: ok"
    assert cam.motion(np.array([0.0, math.tau, 2.5 * math.tau])) == pytest.approx([0.0, math.pi / 3, math.pi])
    assert cam.motion(math.radians(75.0), derivative=1) == pytest.approx(2.0 * 60.0 / 150.0)
    with pytest.raises(CallError, match="order 0 to 6, not 7"):
        cam.motion(0.0, derivative=7)
    with pytest.raises(CallError, match="finite"):
        cam.motion(math.nan)
    with pytest.raises(CallError, match="flanks reach from 37 to 50 mm"):
        cam.flank([0.0], 51.0)
    with pytest.raises(CallError, match="does not touch that layer"):
        cam.flank([5.0 * math.tau], 37.0)
    assert cam.figures["torque"].unit == "N m"


@pytest.mark.parametrize("head", ["", "rotation: ccw\n"])
@pytest.mark.parametrize("text", [BARREL, GLOBOID], ids=["barrel", "globoid"])
def test_points_of_a_flank_lie_on_the_roller(text: str, head: str) -> None:
    """At their shaft angle they are a radius away from its axis, and at no angle nearer."""
    cam = cam_of(recipe_of(head + text))
    layer, radius = (44.0, 9.0) if text == BARREL else (55.0, 8.0)
    theta = np.radians(np.arange(10.0, 111.0, 10.0))
    rollers = rollers_of(shared_design(head + text), 150.0 if text == BARREL else 120.0)
    every = np.linspace(-1.5, 3.5, 4001)
    for upper in (False, True):
        points = cam.flank(theta, layer, upper=upper) * (1.0, -1.0 if head else 1.0, 1.0)
        assert np.diag(rollers.away(points, theta)) == pytest.approx(np.full(theta.size, radius), abs=1e-9)
        assert float(rollers.away(points, every).min()) > radius - 1e-4


def failure(text: str) -> str:
    """Change that would let the one check that fails hold; empty where none fails."""
    recipe = recipe_of(text)
    failed = [check for check in cam_of(recipe).checks if not check.ok]
    if not failed:
        return ""
    (check,) = failed
    return remedy({"name": check.name, "value": check.value, "limit": check.limit, "sense": check.sense}, recipe)


def limited(limit: str, *pairs: tuple[str, str]) -> str:
    return changed(BARREL, DRIVE, ("export:", f"limits: {{{limit}}}\nexport:"), *pairs)


@pytest.mark.costly("figures of a cam for each limit")
def test_a_limit_that_fails_says_what_would_hold_it() -> None:
    """What a remedy names holds the limit."""
    assert failure(limited("pressure-angle: {at_most: 20}")) == "a larger cam, or a longer motion"
    assert failure(limited("pressure-angle: {at_least: 80}")) == ""
    assert failure(limited("velocity: {at_most: 144}")) == "cam.drive.rpm of at most 30"
    assert failure(limited("velocity: {at_most: 144}", ("rpm: 60", "rpm: 30"))) == ""
    loose = ("roller: 9", "roller: 9, clearance: 0.1")
    told = failure(limited("play: {at_most: 0.05}", loose))
    least = told.removeprefix("a clearance of at most ").removesuffix(" mm")
    assert failure(limited("play: {at_most: 0.05}", ("roller: 9", f"roller: 9, clearance: {least}"))) == ""


@pytest.mark.thin(2)
@pytest.mark.costly("figures of a cam for each load")
@pytest.mark.parametrize("limit", ["contact-pressure: {at_most: 300}", "torque: {at_most: 1}"])
def test_a_load_that_is_named_holds_the_limit(limit: str) -> None:
    """A pressure goes with the root of the load; two percent more of it does not hold."""
    told = failure(limited(limit))
    share = float(told.removeprefix("a load of ").removesuffix(" percent"))
    assert failure(limited(limit, ("load: 20", f"load: {0.2 * share}"))) == ""
    assert failure(limited(limit, ("load: 20", f"load: {0.204 * share}")))


@pytest.mark.slow
@pytest.mark.parametrize("name", ["indexing-barrel", "indexing-globoid"])
def test_starters_are_sound(name: str, tmp_path: Path) -> None:
    text = changed(starter(name), ("[stl, csv]", "[csv]"))
    assert main(["check", str(written(tmp_path, text))]) == 0


@pytest.mark.costly("figures of both recipes")
def test_shipped_recipes_are_sound() -> None:
    paths = sorted((ROOT / "recipes" / "indexing").glob("*.yaml"))
    assert [path.stem for path in paths] == ["index-barrel", "index-globoid"]
    for path in paths:
        assert camgeo.design(camgeo.load(path)).ok


def test_checks_of_a_run_are_foreseen() -> None:
    names = {(each.name, each.file) for each in foreseen(recipe_of(changed(BARREL, ("[stl]", "[stl, dxf, csv]"))))}
    assert ("form-closure", "index.stl") in names
    assert ("contour", "index.dxf") in names
    assert not [name for name, file in names if file == "index.csv"]


def test_a_globoid_has_no_drawing_to_wrap() -> None:
    from camgeo.capabilities.indexing.pipeline import INDEXERS

    with pytest.raises(RecipeErrors, match="a globoid has no development; give stl, 3mf or ply"):
        INDEXERS.drawings(shared_design(GLOBOID), 0.1)
