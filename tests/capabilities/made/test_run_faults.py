"""Local faults of earlier runs: left out of a correction while a single run has them, and then taken.

The machine here is a formula: what it adds to the contour that it is given, besides accidents of each part and noise.
Holds: camgeo.capabilities.made.run_faults.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from support.measured import disc, surfaces, table

import camgeo
from camgeo.capabilities.made.correction import runs_made, total_deviations
from camgeo.recipe.loading import read
from camgeo.schema.errors import RecipeErrors
from camgeo.synthesis.design import designed
from kin.numeric.feet import equal_steps

TEXT = disc("kind: roller, radius: 10, offset: 6", part="bore: 12, thickness: 4")
T = equal_steps(720)
SHARE, NOISE = 0.8, 0.0005


def bump(height, at, width=3.0):
    away = (np.degrees(T) - at + 180.0) % 360.0 - 180.0
    return height * np.exp(-0.5 * (away / width) ** 2)


def machine():
    """Cutter too small, axes not square, a slide that waves."""
    return 0.018 + 0.009 * np.cos(2.0 * T + 0.3) + 0.004 * np.cos(3.0 * T)


def run_of(folder, k, off, seed):
    ((_, _, surface),) = surfaces(TEXT)
    frame = surface.gauge.envelope.frames(T)
    off = off + NOISE * np.random.default_rng(seed).normal(size=len(T))
    (folder / f"run{k}.csv").write_text(table(frame.points + off[:, None] * frame.normals), "utf-8")


def recipe_of(folder, count, more=""):
    names = ", ".join(f"run{k}.csv" for k in range(count))
    path = folder / "part.yaml"
    path.write_text(f"{TEXT}\nmade: {{points: [{names}]}}\n{more}", "utf-8")
    return read(path.read_bytes(), path)


def runs(folder, adds, accidents, *, local=False):
    """Deviation of the parts of each run, without noise, and the last total: each made by the correction before."""
    total, left = np.zeros(len(T)), []
    for k, accident in enumerate(accidents):
        off = adds - SHARE * total
        left.append(off + accident)
        run_of(folder, k, off + accident, 10 * k + 1)
        recipe = recipe_of(folder, k + 1)
        made = runs_made(recipe, designed(recipe))
        total = total_deviations(made, local=local)[""].rows(T)[0]
    return left, total


def accidents(seed):
    """Two or three dents and burrs of a part, at places by chance."""
    rng = np.random.default_rng(seed)
    places = rng.permutation(8)[: rng.integers(2, 4)] * 45.0 + rng.uniform(-8.0, 8.0)
    return sum(bump(rng.choice([-1.0, 1.0]) * rng.uniform(0.010, 0.020), at) for at in places)


@pytest.mark.slow
def test_a_machine_with_accidents_is_corrected_to_its_noise_in_three_runs(tmp_path):
    happened = [accidents(seed) for seed in range(4)]
    left, _ = runs(tmp_path, machine(), happened)
    systematic = [off - accident for off, accident in zip(left, happened, strict=True)]
    greatest = [float(np.abs(off).max()) for off in systematic]
    assert greatest[0] > 0.025
    assert greatest[3] < 0.0015  # a fifth is left each time, 0.0002; the rest is noise of three runs
    # with the accidents taken, each is a fault of the next part
    left, _ = runs(tmp_path, machine(), happened, local=True)
    taken = [float(np.abs(off - accident).max()) for off, accident in zip(left, happened, strict=True)]
    assert min(taken[1:]) > 0.007


@pytest.mark.slow
def test_a_fault_that_two_runs_share_is_the_machines(tmp_path):
    scratch = bump(0.012, 130.0)
    left, total = runs(tmp_path, machine() + scratch, [0.0 * T] * 4)
    at = int(np.argmax(scratch))
    smooth = machine() * np.array([1.0, 0.2, 0.04, 0.008])[:, None]
    rest = [float((off - own)[at]) for off, own in zip(left, smooth, strict=True)]
    assert rest[:2] == pytest.approx([0.012, 0.012], abs=0.0015)  # left out of the first correction
    assert rest[2:] == pytest.approx([0.2 * 0.012, 0.04 * 0.012], abs=0.0012)  # then the mean of both is taken
    assert total[at] - machine()[at] / SHARE == pytest.approx(0.012 / SHARE, abs=0.002)


@pytest.mark.costly("runs of a machine, measured and corrected")
def test_the_report_tells_what_was_left_out_and_why(tmp_path):
    dent = bump(-0.015, 200.0)
    for k, off in enumerate([machine() + dent, 0.2 * machine() + bump(0.012, 80.0), bump(0.011, 81.0)]):
        run_of(tmp_path, k, off, k)
    more = "export: {files: [{dxf: {correct: 0.8}}, {svg: {correct: 0.8, local: take}}]}\n"
    recipe_of(tmp_path, 3, more)
    report: Any = camgeo.check(tmp_path / "part.yaml")
    faults = [run["surfaces"][0].get("local", []) for run in report["made"]["runs"]]
    assert [[round(fault["height"], 3) for fault in own] for own in faults] == [[-0.015], [0.012], [0.011]]
    assert [[fault["shared_with"] for fault in own] for own in faults] == [[None], [None], [["run1.csv"]]]
    leave, take = report["made"]["corrections"]
    assert (leave["local"], take["local"]) == ("leave", "take")
    assert leave["greatest"] > 0.0 or abs(leave["greatest"]) < abs(take["greatest"])
    (remark,) = [remark for remark in report["remarks"] if remark["name"] == "local-fault"]
    assert "run0.csv: -0.015" in remark["sentence"]
    assert "`local: take`" in remark["sentence"]
    files = {file["path"]: file["compensation"] for file in report["files"]}
    assert files["part-correct.dxf"]["correct"] == 0.8
    assert "local" not in files["part-correct.dxf"]
    assert files["part-correct.svg"]["local"] == "take"


def test_the_word_for_local_faults_goes_with_a_correction(tmp_path):
    run_of(tmp_path, 0, machine(), 1)
    with pytest.raises(RecipeErrors, match=r"dxf\.local: goes with correct, and there is none; give correct, or leave"):
        recipe_of(tmp_path, 1, "export: {files: [{dxf: {local: take}}]}\n")
    recipe_of(tmp_path, 1, "export: {files: [{dxf: {correct: 0.8, local: take}}]}\n")
    with pytest.raises(RecipeErrors, match=r"dxf\.local: not one of the choices, given 'keep'; give leave or take"):
        recipe_of(tmp_path, 1, "export: {files: [{dxf: {correct: 0.8, local: keep}}]}\n")
