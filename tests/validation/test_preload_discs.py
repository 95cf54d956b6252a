# needs: dynamics
"""Conjugate discs preloaded by interference, all of it on disc 2: case f01, and sets of files with a fault."""

import csv
import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import camgeo
from camgeo.capabilities.dynamics.running_forces import running_of
from camgeo.cli.main import main
from camgeo.measures.figures import design_figures
from camgeo.measures.forces import preload_section
from camgeo.recipe.loading import read
from camgeo.schema.errors import RecipeErrors
from camgeo.synthesis.design import designed
from camgeo.synthesis.intent import closures_between, intents, permitted
from kin.judge.intent import ShaftIntent
from kin.judge.together import DiscFile, verify_set

QUINTIC = (
    "[{rise: 24, over: 100, law: polynomial-4567}, {dwell: 40}, {return: 24, over: 140, law: polynomial-4567},"
    " {dwell: 80}]"
)
SWING = "[{rise: 20, over: 110, law: modified-sine}, {dwell: 50}, {return: 20, over: 120, law: cycloidal}, {dwell: 80}]"
LOW = "[{rise: 8, over: 120, law: cycloidal}, {return: 8, over: 240, law: cycloidal}]"
PAIRS = {
    "stem": ("roller, radius: 9, offset: 6", "radius: 11, distance: 120", QUINTIC),
    "crank": ("roller, radius: 8, arm: {length: 65, pivot: 80}", "radius: 9, length: 60, angle: 90", SWING),
    "faces": ("flat, offset: 5", "distance: 90", LOW),
}
DELTA = 0.02
TOLERANCE = 1e-4


def text(pair="stem", preload=f"interference: {DELTA}, stiffness: [4.0e7, 6.0e7]", size="base_radius: 36", more=""):
    follower, conjugate, motion = PAIRS[pair]
    held = f"\n  preload: {{{preload}}}" if preload else ""
    return (
        f"cam:\n  kind: disc\n  {size}\n  follower: {{kind: {follower}}}\n  conjugate: {{{conjugate}}}{held}\n"
        f"  motion: {motion}\nexport: {{tolerance: {TOLERANCE}, files: [dxf]}}\nverify: {{angles: 36}}\n{more}"
    )


def recipe_of(*args, **kwargs):
    return read(text(*args, **kwargs).encode(), Path("pair.yaml"))


# --- f01 --------------------------------------------------------------------------------------------------------------


def test_forces_of_the_case():
    recipe = recipe_of(more="dynamics: {mass: 2.5, load: 150, rpm: 600}\n")
    design = designed(recipe)
    section = preload_section(recipe, design)
    assert section["interference"] == DELTA
    assert section["force"]["min"] == pytest.approx(426.508379977, abs=1e-8)
    assert section["force"]["min_at_deg"] == pytest.approx(218.85345, abs=1e-4)
    assert section["force"]["max"] == pytest.approx(480.0, abs=1e-9)
    figures = design_figures(recipe, design, design.checks, ["preload-force-least", "preload-force-greatest"])
    assert [one.value for one in figures.values()] == [section["force"]["min"], section["force"]["max"]]
    running = running_of(recipe, design)
    state = running.state(np.radians([20.0, 50.0, 85.0, 180.0, 250.0]))
    assert state.force == pytest.approx([651.645312, 150.0, -221.641284, -147.427092453, 419.915086401], abs=1e-8)
    first, second = state.normal
    assert first == pytest.approx([740.660903890, 542.398609476, 391.301727874, 419.255560353, 647.267475801], abs=1e-8)
    assert second == pytest.approx([88.405933393, 373.434916102, 613.236731539, 581.270311390, 207.004054773], abs=1e-8)
    lost = {name: (rpm, at) for name, rpm, at in running.lost_rpm()}
    assert lost["disc 2"] == pytest.approx((618.818473160, 29.31167), abs=1e-4)
    assert lost["disc 1"] == pytest.approx((905.623245060, 71.78214), abs=1e-4)


# --- files ------------------------------------------------------------------------------------------------------------


def exported(folder, recipe_text):
    path = folder / "pair.yaml"
    path.write_text(recipe_text)
    report = camgeo.export(path, folder)
    assert report.ok, [check for check in report.checks if not check.ok]
    return report


@pytest.fixture(scope="module", params=["stem", *(pytest.param(k, marks=pytest.mark.slow) for k in ("crank", "faces"))])
def made(request, tmp_path_factory):
    """A pair, its report with the interference, and the files of pairs with other ones by their share of it."""
    pair = request.param
    folder = tmp_path_factory.mktemp(pair)
    report = exported(folder, text(pair))

    def others(share):
        there = folder / str(share)
        there.mkdir(exist_ok=True)
        return exported(there, text(pair, f"interference: {share * DELTA!r}" if share else "")).path

    return pair, report, others


def failing(pair, files, play=None):
    """Names of the checks that fail on a set of files, each with the rank of its file."""
    recipe = recipe_of(pair)
    design = designed(recipe)
    shaft = ShaftIntent(intents(recipe, design), closures=closures_between(design))
    listed = [DiscFile(path, rank) for rank, path in enumerate(files)]
    verdicts = verify_set(listed, shaft, 36, replace(permitted(recipe, TOLERANCE), play=play))
    return {
        (rank, check.name): check.detail
        for rank, verdict in enumerate(verdicts)
        for check in verdict.checks
        if not check.ok
    }


def files_of(folder):
    return [folder / f"pair-{k}.dxf" for k in (1, 2)]


@pytest.mark.slow
def test_what_is_made_interferes(made):
    pair, report, _ = made
    assert not failing(pair, files_of(report.path))
    (play,) = next(entry["play"] for entry in report["files"] if "play" in entry)
    assert play["max"] < 0.0
    if pair != "crank":  # along the stem: the interference over the cosine of disc 2's pressure angle
        steepest = {"stem": 23.829947468, "faces": 0.0}[pair]
        ends = [-DELTA / math.cos(math.radians(steepest)), -DELTA]
        assert [play["min"], play["max"]] == pytest.approx(ends, abs=3.0 * TOLERANCE)


@pytest.mark.slow
@pytest.mark.parametrize(
    "share", [0.0, pytest.param(0.5, marks=pytest.mark.slow), pytest.param(1.5, marks=pytest.mark.slow), 2.0]
)
def test_another_interference_fails(made, share):
    """Of the files of such a pair disc 1 is right, and so is disc 1 of this pair beside that disc 2."""
    pair, report, others = made
    first, second = files_of(others(share))
    for set_of_files in ((first, second), (files_of(report.path)[0], second)):
        found = failing(pair, set_of_files)
        assert set(found) >= {(1, "contour"), (1, "motion"), (1, "form-closure")}
        assert not [name for rank, name in found if rank == 0]
        assert "interference from" in found[1, "form-closure"]


def test_a_limit_as_wide_as_the_interference_is_none(made):
    pair, report, _ = made
    (told,) = failing(pair, files_of(report.path), play=1.0).values()
    assert "as much as the interference" in told


@pytest.mark.slow
def test_the_command_line_judges_a_set(made, capsys):
    _, report, others = made
    recipe = report.path.parent / "pair.yaml"
    assert main(["verify", str(recipe), *map(str, files_of(report.path))]) == 0
    assert main(["verify", str(recipe), *map(str, files_of(others(0.0)))]) == 1
    assert "form-closure" in capsys.readouterr().out


# --- what a recipe cannot have ----------------------------------------------------------------------------------------


def refused(recipe_text):
    with pytest.raises(RecipeErrors) as caught:
        designed(read(recipe_text.encode(), Path("pair.yaml")))
    (error,) = caught.value.errors
    return error.path, str(error)


WITHOUT = f"  conjugate: {{{PAIRS['stem'][1]}}}\n"


def test_one_contact_is_not_preloaded():
    path, told = refused(text().replace(WITHOUT, ""))
    assert path == "cam.preload"
    assert "give conjugate" in told
    assert designed(recipe_of()).exact.preload is not None
    assert designed(read(text(preload="").replace(WITHOUT, "").encode(), Path("x.yaml"))).contours


def test_a_groove_is_not_preloaded():
    path, told = refused(text().replace(WITHOUT, "  track: {groove: {clearance: 0.03}}\n"))
    assert path == "cam.preload"
    assert "a roller in a groove needs clearance: for preload take conjugate discs" in told.replace(";", ":")


@pytest.mark.parametrize(
    ("preload", "more", "field", "words"),
    [
        ("interference: 12", "", "cam.preload.interference", ": it is no less than the roller's radius, 9 mm"),
        ("interference: 1.0e-4", "", "export.tolerance", "below 5e-05"),
        ("interference: 0.02", "dynamics: {mass: 2, stiffness: 1.0e6, rpm: 9}\n", "dynamics.stiffness", "leave it out"),
        ("interference: 0.02", "dynamics: {mass: 2, preload: 9, rpm: 9}\n", "dynamics.preload", "leave cam.preload"),
        (
            "interference: 0.02",
            "dynamics: {mass: 2, stiffness: 1.0e6, backlash: 0.1, rpm: 9}\n",
            "dynamics.backlash",
            "leave cam.preload",
        ),
        ("interference: 0.02", "limits: {preload-force-least: {at_least: 1}}\n", None, "cam.preload.stiffness"),
    ],
)
def test_what_is_refused(preload, more, field, words):
    path, told = refused(text(preload=preload, more=more))
    assert field is None or path == field
    assert words in told


def test_a_pair_is_sized_as_without():
    size = "sizing: {pressure-angle: {at_most: 30}}"
    sizes = [recipe_of(preload=preload, size=size).cam.sizes for preload in ("", "interference: 0.02")]
    assert sizes[0] == sizes[1]
    assert recipe_of(preload="interference: 0.02", size=size).cam.exact().preload is not None


@pytest.mark.slow
def test_a_sweep_ranks_by_the_force(tmp_path):
    """Which is in proportion to the interference."""
    sweep = "sweep: {vary: {cam.preload.interference: {from: 0.01, to: 0.03, steps: 3}}, rank: preload-force-least}\n"
    path = tmp_path / "pair.yaml"
    path.write_text(text(more=sweep))
    assert main(["sweep", str(path), "--out", str(tmp_path)]) == 0
    (table,) = (tmp_path / "pair").glob("*.csv")
    rows = list(csv.DictReader(line for line in table.read_text().splitlines() if not line.startswith("#")))
    forces = [float(row["preload-force-least_N"]) for row in rows]
    assert forces == pytest.approx([1.5 * 426.508379977, 426.508379977, 0.5 * 426.508379977], rel=1e-11)


def test_a_drawing_made_larger_keeps_the_interference():
    """Scaled with all of it: what a cutter or a printer is given."""
    exact = designed(recipe_of()).exact
    grown = exact.grow(0.1, 2.0)
    assert grown.preload.interference == 2.0 * DELTA
    assert [one.radius for one in grown.surfaces] == pytest.approx([2.0 * 8.9, 2.0 * (10.9 - DELTA)])
