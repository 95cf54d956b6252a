# needs: camshaft
"""The axis of a measured camshaft: its lean, its shift, and lobes that are eccentric by themselves."""

from __future__ import annotations

import math
import re

import numpy as np
import pytest
from support.shafts import Planted, camshaft, shaft_points, written

import camgeo
from camgeo.cli.main import main
from camgeo.common.errors import CallError
from kin.made.axis import CamShift, axis_of

LEAN, SHIFT = np.array([4e-4, -3e-4]), np.array([0.004, 0.009])  # mm by mm, and mm at z 46


def leaning(rows, lean=LEAN, shift=SHIFT, eccentric=(None, 0.0)):
    """Rows of points whose axis leans, and of which one lobe is eccentric along y."""
    moved = []
    for name, z, x, y in rows:
        by = shift + lean * (z - 46.0) + np.array([0.0, eccentric[1] if name == eccentric[0] else 0.0])
        moved.append((name, z, x + by[0], y + by[1]))
    return moved


def more_lobes(recipe):
    """Three lobes more, beyond the arm's."""
    text = recipe.read_text("utf-8").replace("to: 90", "to: 160")
    rows = "".join(
        f"    - {{recipe: {name}.yaml, at: {at}, z: {z}}}\n"
        for name, at, z in (("flat", 10, 80), ("roller", 100, 105), ("arm", -60, 130))
    )
    recipe.write_text(text.replace("export:", f"{rows}export:"), "utf-8")
    return recipe


@pytest.mark.slow
@pytest.mark.parametrize("more", ["", "rotation: ccw\n"])
def test_a_lean_is_found_and_taken_out_when_that_is_said(more, tmp_path):
    recipe = camshaft(tmp_path, more=more, limits="made: {profile: 0.01}\n")
    file = written(tmp_path / "points.csv", leaning(shaft_points(recipe, noise=0.001)), "z_mm,x_mm,y_mm")
    report = camgeo.verify(recipe, file, probe_error=0.001)
    axis = report["made"]["axis"]
    assert not report.ok
    assert axis["leans_deg"] == pytest.approx(math.degrees(5e-4), abs=axis["uncertainty_deg"])
    assert math.degrees(1e-6) < axis["uncertainty_deg"] < 0.2 * math.degrees(5e-4)
    assert axis["towards_deg"] == pytest.approx(math.degrees(math.atan2(-3.0, 4.0)) % 360.0, abs=10.0)
    assert axis["shifted"] == pytest.approx(SHIFT, abs=axis["shift_uncertainty"])
    assert axis["z"] == 46.0
    remark = next(text for text in report["made"]["remarks"] if "leans" in text)
    assert re.fullmatch(
        r"the axis of the shaft leans by 0\.02\d+ \+- 0\.00\d+ degrees, .* micrometres over 38 mm, against that of z: "
        "`--align best-fit` takes it out",
        remark,
    )
    report = camgeo.verify(recipe, file, probe_error=0.001, align="best-fit")
    made = report["made"]
    assert report.ok
    assert made["axis"]["removed"]
    assert made["axis"]["leans_deg"] == pytest.approx(axis["leans_deg"], rel=0.02)
    assert any("were taken out by --align best-fit: motions show neither" in text for text in made["remarks"])
    assert all(abs(lobe["motion"]["error"]["max"]) < 0.002 for lobe in made["lobes"] if lobe["name"] != "arm")


@pytest.mark.slow
def test_a_straight_shaft_does_not_lean(tmp_path):
    recipe = camshaft(tmp_path)
    file = written(tmp_path / "points.csv", shaft_points(recipe, noise=0.001))
    made = camgeo.verify(recipe, file)["made"]
    assert made["axis"]["leans_deg"] < 1.5 * made["axis"]["uncertainty_deg"]
    assert not any("leans" in text for text in made["remarks"])


@pytest.mark.slow
def test_an_eccentric_lobe_is_no_lean(tmp_path, capsys):
    recipe = more_lobes(camshaft(tmp_path))
    rows = shaft_points(recipe, noise=0.001, count=180)
    file = written(tmp_path / "points.csv", leaning(rows, 0.0 * LEAN, 0.0 * SHIFT, ("flat 1", 0.03)))
    assert main(["verify", str(recipe), str(file)]) == 0
    out = capsys.readouterr().out
    assert re.search(r"flat 1, eccentric +0\.0\d+ \+- \S+ mm about it", out)
    assert "leans by" in out
    assert "remark: the axis" not in out
    file = written(tmp_path / "points.csv", leaning(rows, eccentric=("flat 1", 0.03)))
    axis = camgeo.verify(recipe, file)["made"]["axis"]
    assert axis["leans_deg"] == pytest.approx(math.degrees(5e-4), abs=1.5 * axis["uncertainty_deg"])
    own = {cam["name"]: cam for cam in axis["eccentricity"]}
    assert own["flat 1"]["shifted"] == pytest.approx([0.0, 0.03], abs=own["flat 1"]["uncertainty"])
    assert np.max([cam["value"] for name, cam in own.items() if name != "flat 1"]) < 0.003


def test_a_lobe_that_is_turned_on_a_leaning_axis(tmp_path):
    """Neither hides the other: the lean is no reason to take the turned lobe for another cam's."""
    recipe = camshaft(tmp_path)
    rows = shaft_points(recipe, {"roller": Planted(late=3.0)}, count=120)
    made = camgeo.verify(recipe, written(tmp_path / "points.csv", leaning(rows, 3.0 * LEAN)), spans=24)["made"]
    assert made["lobes"][1]["phase"]["late_deg"] == pytest.approx(3.0, abs=0.2)
    assert made["axis"]["leans_deg"] == pytest.approx(3.0 * math.degrees(5e-4), rel=0.05)


@pytest.mark.slow
def test_what_tells_no_lean(tmp_path):
    recipe = camshaft(tmp_path)
    rows = [row for row in shaft_points(recipe) if row[0] != "arm"]
    file = written(tmp_path / "points.csv", rows)
    assert "axis" not in camgeo.verify(recipe, file)["made"]
    with pytest.raises(CallError, match="need lobes at 3 heights or more: give --align rotation, or none"):
        camgeo.verify(recipe, file, align="best-fit")
    assert camgeo.verify(recipe, file, align="rotation").ok


@pytest.mark.slow
def test_the_lean_scatters_as_its_uncertainty_says():
    """Cams of different certainty, one of them far off the line of the others."""
    rng, ratios = np.random.default_rng(3), []
    sds = np.array([0.001, 0.002, 0.001, 0.003, 0.001, 0.002])
    for _ in range(300):
        cams = []
        for k, sd in enumerate(sds.tolist()):
            shift = SHIFT + 20.0 * k * LEAN + rng.normal(0.0, sd, 2) + (0.05 if k == 2 else 0.0)
            cams.append(CamShift(20.0 * k, shift, sd**2 * np.eye(2)))
        axis = axis_of(cams)
        ratios.append((axis.lean - LEAN) / np.sqrt(np.diag(axis.covariance)[2:]))
        assert np.hypot(*axis.own[2]) == pytest.approx(0.05 * math.sqrt(2.0), abs=0.012)
    assert 0.75 < np.std(ratios) < 1.15
