"""Inspection tables and DMIS programs: what they say to measure, measured without error, is the contour."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from support.measured import RECIPES, disc

import camgeo
from camgeo.capabilities.made import dmis
from camgeo.capabilities.made.dmis import shaft_program
from camgeo.cli.main import main
from camgeo.common.errors import CallError

ZONE = "\nmade: {profile: 0.02, datum: part}"


def exported(folder, text, files):
    recipe = folder / "part.yaml"
    recipe.write_text(f"{text.partition(chr(10) + 'export:')[0]}{ZONE}\nexport: {{files: [{files}]}}\n", "utf-8")
    return recipe, camgeo.export(recipe, folder / "out")


@pytest.mark.thin(8)
@pytest.mark.parametrize("kind", list(RECIPES))
def test_a_table_measured_without_error_is_judged_at_its_digits(kind, tmp_path):
    recipe, report = exported(tmp_path, RECIPES[kind], "{csv: {as: inspection, step: 2}}")
    file = report.path / "part.csv"
    assert len(file.read_text("utf-8").splitlines()) == 182
    verdict = camgeo.verify(recipe, file, probe_error=1e-9)
    assert verdict.ok
    scale = 25.4 if verdict["units"] == "inch" else 1.0
    assert all(scale * one["profile"] < 2e-9 for one in verdict["made"]["discs"])


@pytest.mark.thin(16)
@pytest.mark.parametrize("kind", list(RECIPES))
def test_a_dmis_program_run_without_error_is_judged_at_its_digits(kind, tmp_path):
    thick = "bore: 12, thickness: 8" if kind == "conjugate discs" else "bore: 12"
    recipe, report = exported(tmp_path, RECIPES[kind].replace("bore: 12", thick), "{dmis: {step: 2}}")
    program = (report.path / "part.dmi").read_text("utf-8")
    assert "T(ZONE)=TOL/PROFP,-0.01,0.01" in program.splitlines() or "inch" in RECIPES[kind]
    lines = [line.replace("F(P", "FA(P") for line in program.splitlines() if line.startswith(("F(P", "UNITS"))]
    (tmp_path / "actual.dmi").write_text("\n".join(lines), "utf-8")
    files = [tmp_path / "actual.dmi"]
    if kind == "conjugate discs":  # a file for each disc
        low = [line for line in lines if line.startswith("UNITS") or float(line.split(",")[4]) < 5.0]
        files = [tmp_path / "actual-1.dmi", tmp_path / "actual-2.dmi"]
        files[0].write_text("\n".join(low), "utf-8")
        files[1].write_text("\n".join([lines[0], *(line for line in lines if line not in low)]), "utf-8")
    verdict = camgeo.verify(recipe, *files, probe_error=1e-9)
    assert verdict.ok
    scale = 25.4 if verdict["units"] == "inch" else 1.0
    assert all(scale * one["profile"] < 4e-9 for one in verdict["made"]["discs"])


def test_the_table_has_normals_and_the_limits_of_the_zone(tmp_path):
    text = disc("kind: roller, radius: 10, offset: 6")
    _, report = exported(tmp_path, text, "{csv: {as: inspection, step: 5}}")
    table = np.genfromtxt(report.path / "part.csv", delimiter=",", names=True)
    assert len(table) == 73
    assert table["shaft_deg"][1] == 5.0
    assert np.hypot(table["nx"], table["ny"]) == pytest.approx(1.0, abs=1e-11)
    assert set(table["lower_mm"]) == {-0.01}
    assert set(table["upper_mm"]) == {0.01}


def test_conjugate_discs_stand_in_one_table(tmp_path):
    _, report = exported(tmp_path, RECIPES["conjugate discs"], "{csv: {as: inspection, step: 5}}")
    head = (report.path / "part.csv").read_text("utf-8").splitlines()[0].split(",")
    assert {"disc_1_x_mm", "disc_2_ny"} <= set(head)


@pytest.mark.parametrize(
    ("files", "told"),
    [
        (
            "{csv: {as: inspection, step: 7}}",
            "csv.step: 360 degrees are no whole number of it; give 7.05882353 or another",
        ),
        ("{dmis: {step: 7}}", "dmis.step: 360 degrees are no whole number of it; give 7.05882353 or another"),
        ("{csv: {as: inspection, tolerance: 0.1}}", "csv.tolerance: belongs to a table as grinding"),
        ("{csv: {as: motion, step: 5}}", "csv.step: belongs to a table as inspection, grinding"),
        ("{dmis: {tolerance: 0.1}}", "dmis.tolerance: unknown key"),
    ],
)
def test_options_that_do_not_go_with_it_are_told(files, told, tmp_path, capsys):
    recipe = tmp_path / "part.yaml"
    recipe.write_text(disc("kind: flat") + ZONE + f"\nexport: {{files: [{files}]}}", "utf-8")
    assert main(["export", str(recipe), "--out", str(tmp_path / "out")]) == 2
    assert told in capsys.readouterr().err


def test_a_program_is_not_what_it_measures(tmp_path):
    recipe, report = exported(tmp_path, next(iter(RECIPES.values())), "{dmis: {step: 5}}")
    with pytest.raises(CallError, match=r"a program that measures, and no point FA\(label\)=FEAT/POINT,CART of what"):
        camgeo.verify(recipe, report.path / "part.dmi")


@pytest.mark.parametrize(("units", "word"), [(None, "MM"), ("inch", "INCH")])
def test_a_program_of_a_shaft_is_in_the_units_asked_for_or_its_recipe_s(units, word):
    recipe = SimpleNamespace(name="shaft", units="mm", verify=SimpleNamespace(angles=8))
    assert list(shaft_program(recipe, [], None, units)) == ["DMISMN/'shaft'", f"UNITS/{word},ANGDEC", "ENDFIL"]


def test_a_program_of_a_shaft_measures_each_cam_halfway_along_its_length_in_its_zone(monkeypatch):
    cam: Any = SimpleNamespace(
        recipe=SimpleNamespace(profile=0.02), low=20.0, high=32.0, design=SimpleNamespace(contours=()), at=1.5
    )
    monkeypatch.setattr(dmis, "_program", lambda _, discs, step, units: [*discs, step, units])
    found: Any = shaft_program(SimpleNamespace(units="mm"), [cam], 0.5)
    disc, step, units = found
    assert (disc.zone, disc.height, step, units) == (0.02, 26.0, 0.5, "mm")
