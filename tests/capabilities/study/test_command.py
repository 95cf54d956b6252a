"""`camgeo study`: the rungs of its ladders against the files' own figures, where they end, and the margins.

Holds: camgeo.capabilities.study.picture.
"""

from __future__ import annotations

import json
import math
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from support.places import RECIPES

from camgeo.capabilities.study import command
from camgeo.capabilities.study.least_pieces import least_pieces
from camgeo.capabilities.study.margins import FailureMargin, margins
from camgeo.capabilities.study.tolerance_ladder import End, Rung, climb
from camgeo.cli import main
from camgeo.output.pipeline import export
from camgeo.recipe.loading import load, read
from camgeo.synthesis.design import designed


def named(recipe_name: str) -> dict[str, FailureMargin]:
    recipe = load(RECIPES / f"{recipe_name}.yaml")
    return {margin.name: margin for margin in margins(recipe, designed(recipe))}


@pytest.fixture(scope="module")
def study(tmp_path_factory: pytest.TempPathFactory) -> tuple[dict, Path]:
    out = tmp_path_factory.mktemp("out")
    recipe = out / "cam.yaml"
    recipe.write_text("cam: {kind: support, p: 25 + 2*cos(3*t)}\npart: {thickness: 8}\nverify: {angles: 90}\n")
    assert main.main(["study", str(recipe), "--out", str(out), "--patience", "2", "--json"]) == 0
    return json.loads((out / "cam" / "study.json").read_text(encoding="utf-8")), out / "cam"


@pytest.mark.slow
def test_every_form_climbs_until_it_cannot_hold_the_tolerance(study: tuple[dict, Path]) -> None:
    found, folder = study
    assert (folder / "study.png").stat().st_size > 10_000
    assert {end["form"] for end in found["ended"]} == {"polyline", "arcs", "spline", "stl"}
    stl = next(end for end in found["ended"] if end["form"] == "stl")
    assert stl["tolerance"] == pytest.approx(1e-6)
    assert "single precision" in stl["why"]
    for form in ("polyline", "arcs", "spline", "stl"):
        rows = [row for row in found["rows"] if row["form"] == form]
        assert len(rows) >= 3
        assert [row["tolerance"] for row in rows] == pytest.approx([10.0 ** -(k + 1) for k in range(len(rows))])
        for row in rows:
            assert row["ok"]
            # with many pieces the tolerance is used, with few a whole number of them may leave some of it
            least = 0.9 if row["pieces"] > 100 and form != "spline" else 0.2
            assert least * row["tolerance"] <= row["geometry_error"] <= row["tolerance"] * (1 + 1e-6)
            # a spline is judged by arcs within a thousandth of the tolerance, which counts
            within = 1e-3 * row["tolerance"] if form == "spline" else 1e-10
            assert row["geometry_error"] <= row["proved"] + within
            assert row["seconds"] == pytest.approx(math.fsum(row["stages"].values()))
            assert set(row["stages"]) == {"fit", "write", "judge"}
        assert [row["pieces"] for row in rows] == sorted(row["pieces"] for row in rows)


@pytest.mark.slow
def test_pieces_against_theory(study: tuple[dict, Path]) -> None:
    rows = {(row["form"], round(-math.log10(row["tolerance"]))): row for row in study[0]["rows"]}
    # 241.25 vertices for p = 25 + 2 cos 3t at 0.001 mm, 242 of them reached (docs/validation.md)
    assert rows["polyline", 3]["least_pieces"] == pytest.approx(241.25, abs=0.01)
    assert rows["polyline", 3]["pieces"] == 242
    assert 1.0 <= rows["spline", 6]["pieces"] / rows["spline", 6]["least_pieces"] <= 1.2


def test_least_arcs_against_the_closed_form_of_a_three_lobed_cam() -> None:
    # kappa = 1/rho, ds = rho dt, rho = 25 - 16 cos 3t: the integral of (|rho'|/124.7 e)^(1/3) dt over a turn
    recipe = read(b"cam: {kind: support, p: 25 + 2*cos(3*t)}", Path("cam.yaml"))
    contour = designed(recipe).only_surface.contour
    assert contour is not None
    steps = 200_000
    sine = [abs(math.sin(3.0 * 2.0 * math.pi * (k + 0.5) / steps)) for k in range(steps)]
    integral = math.fsum((48.0 * s / (124.7 * 1e-6)) ** (1 / 3) for s in sine) * 2.0 * math.pi / steps
    # the trapezoids of Density see the cube root's vertical tangent at the six extrema of curvature to a part in 400
    assert least_pieces("arcs", contour, 1e-6) == pytest.approx(integral, rel=2.5e-3)


def test_a_dwell_counts_as_one_arc_at_least() -> None:
    recipe = load(RECIPES / "reuleaux.yaml")
    contour = designed(recipe).only_surface.contour
    assert contour is not None
    assert least_pieces("arcs", contour, 1e-3) == 6.0


@pytest.mark.slow
def test_a_run_that_takes_too_long_ends_the_ladder(tmp_path: Path) -> None:
    recipe = read(b"cam: {kind: support, p: 25 + 2*cos(3*t)}\nverify: {angles: 8}", Path("cam.yaml"))
    found = list(climb(recipe, designed(recipe), "arcs", tmp_path, patience=1e-9))
    assert [type(item) for item in found] == [Rung, End]
    assert isinstance(found[1], End)
    assert found[1].why.startswith("fit, write and judge took")
    assert "longer than" in found[1].why


@pytest.mark.slow
def test_a_rung_of_two_discs_is_of_both_files(tmp_path: Path) -> None:
    """Its pieces and bytes are those of both, its errors those of the worse."""
    recipe = load(RECIPES / "conjugate-stem.yaml")
    rung = next(one for one in climb(recipe, designed(recipe), "arcs", tmp_path, patience=0.0) if isinstance(one, Rung))
    files = sorted(tmp_path.glob("*.dxf"))
    assert len(files) == 2
    assert rung.bytes == sum(file.stat().st_size for file in files)
    wider = recipe.replace({"export.tolerance": rung.tolerance, "export.files": [{"dxf": {"as": "arcs"}}]})
    report = export(wider, tmp_path / "whole").report
    entries = [one for one in report["files"] if one["path"].endswith(".dxf")]
    assert rung.pieces == sum(one["pieces"] for one in entries)
    assert rung.geometry_error == pytest.approx(max(one["measured_error"] for one in entries), rel=1e-9)
    assert not rung.failed


@pytest.mark.parametrize(("ok", "folder"), [(True, "cam"), (False, "cam.rejected")])
def test_a_study_and_its_picture_stand_together(
    ok: bool, folder: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("camgeo.capabilities.study.picture.picture", lambda _: b"drawn")
    recipe: Any = SimpleNamespace(name="cam")
    command._write(recipe, {"rows": [1], "skipped": []}, tmp_path, ok=ok)
    assert (tmp_path / folder / "study.png").read_bytes() == b"drawn"
    (file,) = json.loads((tmp_path / folder / "study.json").read_text(encoding="utf-8"))["files"]
    assert (file["path"], file["bytes"]) == ("study.png", 5)


def test_a_picture_left_out_for_want_of_a_package_exits_3(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def without(_study: object) -> None:
        raise ModuleNotFoundError(name="matplotlib")

    monkeypatch.setattr("camgeo.capabilities.study.picture.picture", without)
    recipe = tmp_path / "cam.yaml"
    recipe.write_text("cam: {kind: support, p: 25 + 2*cos(3*t)}\nverify: {angles: 90}\n")
    assert main.main(["study", str(recipe), "--form", "arcs", "--patience", "0.001", "--out", str(tmp_path)]) == 3
    skipped = json.loads((tmp_path / "cam" / "study.json").read_text(encoding="utf-8"))["skipped"]
    why = "the package matplotlib is missing: pip install '.[study]' in a clone of camgeo"
    assert skipped[1:] == [{"what": "study.png", "why": why, "missing": True}]


@pytest.mark.slow
def test_a_study_of_two_discs_says_of_which_a_figure_is(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    recipe = str(RECIPES / "conjugate-stem.yaml")
    assert main.main(["study", recipe, "--form", "arcs", "--patience", "0.001", "--out", str(tmp_path)]) == 0
    said = capsys.readouterr().out
    assert "errors are the greatest, pieces, bytes and seconds the sums of disc 1 and disc 2\n" in said
    for name in ("undercut", "pressure-angle", "wall", "motion-condition"):
        rows = [line for line in said.splitlines() if line.startswith(f"{name} ")]
        assert [disc in row for disc, row in zip(("disc 1", "disc 2"), rows, strict=True)] == [True, True], name


def test_margins_of_a_four_bar() -> None:
    found = named("as-figure-9-2a")
    assert found["binding"].value == pytest.approx(51.5953, abs=1e-3)
    assert found["reversal"].value == pytest.approx(0.7446, abs=1e-4)
    assert found["motion-condition"].value == pytest.approx(1.0, rel=1e-6)
    assert found["output-condition"].value == pytest.approx(1.0346, abs=1e-3)
    assert found["output-condition"].grows


def test_margins_of_a_ring_are_those_of_its_hollows() -> None:
    """A hollow of the pitch curve must be wider than the roller; without one nothing undercuts."""
    text = "cam: {kind: disc, base_radius: 36, track: internal, follower: {kind: roller, radius: 9}, motion: "
    text += "[{rise: %s, over: 60, law: cycloidal}, {return: %s, over: 60, law: cycloidal}, {dwell: 240}]}\n"
    text += "part: {outer: 160}\n"
    recipe = read((text % (20, 20)).encode(), Path("ring.yaml"))
    bent = next(check for check in designed(recipe).checks if check.name == "pitch-radius")
    assert bent.value is not None
    assert math.isfinite(bent.value)
    (margin,) = (margin for margin in margins(recipe, designed(recipe)) if margin.name == "undercut")
    assert margin.value == pytest.approx(bent.value - 9.0, rel=1e-12)
    recipe = read((text % (0.5, 0.5)).encode(), Path("ring.yaml"))
    assert not any(margin.name.startswith("undercut") for margin in margins(recipe, designed(recipe)))


def test_margins_of_an_ellipse_under_a_flat_pair() -> None:
    # lambda = 2: D = m^2 cos 2t, sin psi = D/l^2, so the square root's edge is acos(m^2/l^2) away
    found = named("w-ellipse")
    recipe = load(RECIPES / "w-ellipse.yaml")
    cam: Any = recipe.cam
    ratio = max(abs(c) for _, c in cam.route.cos) / cam.arm**2
    assert found["square-root"].value == pytest.approx(math.degrees(math.acos(ratio)), abs=1e-6)
    assert found["turning-through"].value > 0.0


def test_margins_of_a_roller_to_the_shaft_and_to_a_stretched_arm() -> None:
    recipe = load(RECIPES / "w-figure-9.yaml")
    base = designed(recipe).only_surface.surface.base
    distance = np.hypot(*base.sample(np.linspace(0.0, 2.0 * math.pi, 20_001)).point.T)
    found = named("w-figure-9")
    assert found["shaft"].value == pytest.approx(distance.min(), rel=1e-5)
    assert found["stretched"].value == pytest.approx(2.0 * vars(recipe.cam)["arm"] - distance.max(), rel=1e-4)


def test_a_cam_at_the_brink_of_undercut_has_hardly_any_margin() -> None:
    recipe = read(b"cam: {kind: support, p: 16.000001 + 2*cos(3*t)}", Path("cam.yaml"))
    found = {margin.name: margin for margin in margins(recipe, designed(recipe))}
    assert found["undercut"].value == pytest.approx(1e-6, rel=1e-3)


def test_an_undercut_recipe_is_told_and_fails(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    recipe = tmp_path / "cam.yaml"
    recipe.write_text("cam: {kind: support, p: 10 + 2*cos(3*t)}\n")
    assert main.main(["study", str(recipe), "--out", str(tmp_path)]) == 1
    text = capsys.readouterr().out
    assert "a check of the exact contour fails" in text
    assert "undercut" in text


@pytest.mark.slow
def test_a_linkage_that_binds_fails_and_is_told(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    recipe = tmp_path / "cam.yaml"
    recipe.write_text(
        "cam: {kind: support, p: 25 + cos(3*t), shaft: [12, 6]}\n"
        "linkage: {kind: four-bar, ground: 80, coupler: 70, rocker: 20}\n"
    )
    call = ["study", str(recipe), "--out", str(tmp_path), "--form", "polyline", "--patience", "1e-9"]
    assert main.main(call) == main.main(["check", str(recipe)]) == 1
    assert "FAILED before any file: mobility" in capsys.readouterr().out
    found = json.loads((tmp_path / "cam.rejected" / "study.json").read_text(encoding="utf-8"))
    assert found["failed"][0]["name"] == "mobility"
    assert next(margin["value"] for margin in found["margins"] if margin["name"] == "binding") < 0.0


@pytest.mark.slow
def test_a_study_that_fails_leaves_the_last_good_one(tmp_path: Path) -> None:
    recipe = tmp_path / "cam.yaml"
    call = ["study", str(recipe), "--out", str(tmp_path), "--form", "polyline", "--patience", "1e-9"]
    # a ladder that ends for want of time is no failure
    recipe.write_text("cam: {kind: support, p: 25 + 2*cos(3*t)}\nverify: {angles: 8}\n")
    assert main.main(call) == 0
    good = (tmp_path / "cam" / "study.json").read_bytes()
    assert not (tmp_path / "cam.rejected").exists()
    for worse in ("p: 10 + 2*cos(3*t)}\n", "p: 25 + 2*cos(3*t)}\nverify: {angles: 8, motion_error: 1e-9}\n"):
        recipe.write_text("cam: {kind: support, " + worse)
        assert main.main(call) == 1
        assert (tmp_path / "cam" / "study.json").read_bytes() == good
        rejected = json.loads((tmp_path / "cam.rejected" / "study.json").read_text(encoding="utf-8"))
        assert rejected["failed"] or not all(row["ok"] for row in rejected["rows"])


def test_a_wrong_call_and_a_wrong_recipe(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    recipe = tmp_path / "cam.yaml"
    recipe.write_text("cam: {kind: support, q: 10}\n")
    assert main.main(["study", str(recipe), "--out", str(tmp_path)]) == 2
    assert "cam.yaml:1:" in capsys.readouterr().err
    with pytest.raises(SystemExit) as caught:
        main.main(["study", str(recipe), "--patience", "0"])
    assert caught.value.code == 2
    assert sorted(path.name for path in tmp_path.iterdir()) == ["cam.yaml"]
