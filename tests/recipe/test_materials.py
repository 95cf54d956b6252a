"""Materials of contacts: by name or by their figures, the pressure that follows, and a limit that is stated alone."""

from __future__ import annotations

import csv
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from camgeo.cli.main import main
from camgeo.measures.running_forces import running_of
from camgeo.output.pipeline import check
from camgeo.recipe.dynamics import MATERIALS, Material
from camgeo.recipe.loading import read
from camgeo.schema.errors import RecipeErrors
from camgeo.synthesis.design import designed

CAM = """\
cam:
  kind: disc
  base_radius: 40
  follower: {kind: roller, radius: 10}
  motion: [{rise: 20, over: 120, law: cycloidal}, {dwell: 60}, {return: 20, over: 180, law: polynomial-345}]
part: {thickness: 12, bore: 20}
export: {files: [csv]}
dynamics: {mass: 1.2, rpm: 300, preload: 80, MATERIAL}
"""
OWN = "material: {E: 206000, nu: 0.3"


def report(material: str, more: str = "") -> dict[str, Any]:
    found: dict[str, Any] = check(read((CAM.replace("MATERIAL", material) + more).encode(), Path("cam.yaml"))).report
    return found


def test_a_name_and_its_figures_are_one_material() -> None:
    assert report("material: steel")["forces"] == report(f"{OWN}}}")["forces"]
    assert (
        report("material: steel, roller_material: pom")["forces"]["pressure"]
        == (report(f"{OWN}}}, roller_material: {{E: 3000, nu: 0.35}}")["forces"]["pressure"])
    )


def test_pressure_by_hertz_of_two_materials() -> None:
    """Worked by hand: p^2 = N (1/10 + 1/rho) / (pi w ((1 - nu1^2)/E1 + (1 - nu2^2)/E2)), on the dwell's arc of 60."""
    text = CAM.replace("MATERIAL", "material: {E: 70000, nu: 0.33}, roller_material: bronze")
    recipe = read(text.encode(), Path("cam.yaml"))
    running = running_of(recipe, designed(recipe))
    assert running is not None
    pressure = running.state(np.radians([150.0])).pressure
    assert pressure is not None
    compliance = (1.0 - 0.33**2) / 70000.0 + (1.0 - 0.34**2) / 110000.0
    assert pressure[0, 0] == pytest.approx(
        math.sqrt(80.0 * (0.1 + 1.0 / 60.0) / (math.pi * 12.0 * compliance)), rel=1e-9
    )


def test_a_limit_is_told_and_not_judged() -> None:
    """The weaker of both; far above it nothing fails but where the recipe limits the figure."""
    plain = report(f"{OWN}}}")["forces"]["pressure"][0]
    assert {"limit", "share_of_limit"}.isdisjoint(plain)
    found = report(f"{OWN}, limit: 900}}, roller_material: {{E: 206000, nu: 0.3, limit: 20}}")
    (pressure,) = found["forces"]["pressure"]
    assert pressure["limit"] == 20.0
    assert pressure["share_of_limit"] == pytest.approx(plain["max"] / 20.0)
    assert pressure["share_of_limit"] > 3.0
    assert all(one["ok"] for one in found["checks"])
    judged = report(f"{OWN}, limit: 20}}", "limits: {contact-pressure: {at_most: 20}}\n")["checks"]
    assert [one["name"] for one in judged if not one["ok"]] == ["limit:contact-pressure"]


def test_the_page_tells_the_share() -> None:
    from camgeo.report.page.tables import forces

    shown = forces(report(f"{OWN}, limit: 1200}}"))
    assert "that pressure over the 1200 N/mm² that the material bears" in shown
    assert "material bears" not in forces(report(f"{OWN}}}"))


def test_names_have_no_limit() -> None:
    assert all(material.limit is None for material in MATERIALS.values())
    assert MATERIALS["steel"] == Material(206_000.0, 0.3)


@pytest.mark.parametrize(
    ("material", "field", "words"),
    [
        ("material: stell", "material", "not one of the choices, given 'stell'; did you mean steel?"),
        (
            "material: cheese",
            "material",
            "give steel, nodular-iron, grey-iron, bronze, aluminium, pom or pa66, or {E: 2",
        ),
        ("material: {nu: 0.3}", "material.E", "missing; give a number above 0: Young's modulus, N/mm²"),
        ("material: {E: 0, nu: 0.3}", "material.E", "not above 0"),
        ("material: {E: 206000, nu: 0.6}", "material.nu", "above 0.5"),
        ("material: {E: 206000, nu: 0.3, limt: 9}", "material.limt", "unknown key; did you mean limit?"),
        ("material: {E: 206000, nu: 0.3, limit: 0}", "material.limit", "not above 0"),
        ("material: [steel]", "material", "give steel, nodular-iron"),
    ],
)
def test_what_is_no_material(material: str, field: str, words: str) -> None:
    with pytest.raises(RecipeErrors) as caught:
        report(material)
    (error,) = caught.value.errors
    assert error.path == f"dynamics.{field}"
    assert words in str(error)


@pytest.mark.parametrize("key", ["width: 4", "material: steel", "roller_material: {E: 3000, nu: 0.4}"])
def test_an_elastic_train_has_no_pressure(key: str) -> None:
    with pytest.raises(RecipeErrors, match=r"belongs to a train without stiffness; leave stiffness out, or this"):
        read(CAM.replace("MATERIAL", f"{key}, stiffness: 1.0e6").encode(), Path("case.yaml"))
    for remedied in (key, "stiffness: 1.0e6"):
        read(CAM.replace("MATERIAL", remedied).encode(), Path("case.yaml"))


def test_a_pressure_needs_a_width() -> None:
    """Without one there is no figure: a limit of it is refused and does not pass unseen."""
    limits = "limits: {contact-pressure: {at_most: 0.001}}\n"
    bare = CAM.replace("MATERIAL", "material: steel").replace("part: {thickness: 12, bore: 20}\n", "")
    with pytest.raises(
        RecipeErrors, match=r"contact-pressure needs dynamics.material, part.thickness or dynamics.width"
    ):
        read((bare + limits).encode(), Path("cam.yaml"))
    whole = CAM.replace("MATERIAL", "material: steel")
    for wide in (bare.replace("material: steel", "material: steel, width: 12"), whole):
        found = check(read((wide + limits).encode(), Path("cam.yaml"))).report
        assert [entry["ok"] for entry in found["checks"] if entry["name"] == "limit:contact-pressure"] == [False]


def test_a_sweep_ranks_by_the_pressure_over_the_part_s_thickness(tmp_path: Path) -> None:
    more = "sweep: {vary: {cam.base_radius: [40, 45]}, rank: contact-pressure, keep: 2}\n"
    recipe = tmp_path / "cam.yaml"
    recipe.write_text(CAM.replace("MATERIAL", "material: steel") + more, encoding="utf-8")
    assert main(["sweep", str(recipe), "--out", str(tmp_path)]) == 0
    lines = (tmp_path / "cam" / "sweep.csv").read_text(encoding="utf-8").splitlines()
    rows = list(csv.DictReader(line for line in lines if not line.startswith("#")))
    pressures = [float(row["contact-pressure_N_per_mm2"]) for row in rows]
    assert pressures == sorted(pressures)
    assert all(0.0 < pressure < 1e4 for pressure in pressures)
