"""The command `camgeo budget`: what it prints of budgets that are kept, found, or taken by one dimension.

Holds: camgeo.capabilities.budget, camgeo.capabilities.budget.library,
camgeo.capabilities.budget.starter, camgeo.capabilities.budget.text.
"""

from __future__ import annotations

import json
import math
from typing import TYPE_CHECKING

import numpy as np
import pytest
from support.budgets import CAM

from camgeo.cli import progress
from camgeo.cli.main import main
from camgeo.recipe.starter import starter

if TYPE_CHECKING:
    from pathlib import Path

YOKE = "cam: {kind: constant-breadth, base_radius: 40, motion: [{rise: 20, over: 120, law: cycloidal}, {dwell: 60}]}\n"


def run(folder: Path, body: str, *words: str, cam: str = CAM) -> int:
    (folder / "c.yaml").write_text(f"{cam}budget: {{{body}, runs: 100}}\n", encoding="utf-8")
    return main(["budget", str(folder / "c.yaml"), *words])


def test_the_command_splits_what_is_permitted(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(tmp_path, "permitted: 0.05, fit: h6, tolerances: {profile: free, follower.radius: 0.005}") == 0
    out = capsys.readouterr().out
    assert "profile (found)" in out
    assert "left for profile:" in out
    left = float(out.split("left for profile: ")[1].split()[0])
    assert run(tmp_path, f"permitted: 0.05, fit: h6, tolerances: {{profile: {left}, follower.radius: 0.005}}") == 0
    assert "c: 0.05 mm kept by worst case: " in capsys.readouterr().out
    more = left + 0.001
    assert run(tmp_path, f"permitted: 0.05, fit: h6, tolerances: {{profile: {more}, follower.radius: 0.005}}") == 1
    assert "NOT KEPT" in capsys.readouterr().out


def test_the_command_finds_the_widest_set(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    body = "permitted: 0.05, cost: {profile: 4, follower.radius: 1}, tolerances: {angle: 0.02}, sum: rss"
    assert run(tmp_path, body, "--json") == 0
    found = json.loads(capsys.readouterr().out)
    assert found["rss"]["value"] == pytest.approx(0.05, rel=1e-9)
    assert found["worst"]["value"] > 0.05
    assert {row["name"] for row in found["splits"]["worst"]["tolerances"]} == {"profile", "follower.radius"}


def test_what_takes_all_is_refused_by_name(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(tmp_path, "permitted: 0.05, tolerances: {profile: free, follower.offset: 0.2}") == 2
    error = capsys.readouterr().err
    assert "budget.tolerances" in error
    assert "nothing is left for profile: follower.offset alone takes" in error


def test_play_and_a_recipe_without_a_budget(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(tmp_path, "permitted: 0.05, play: 0.03, tolerances: {breadth: 0.02, profile: 0.01}", cam=YOKE) == 1
    assert "play from -0.04 to 0.04 mm, 0.03 permitted" in capsys.readouterr().out
    (tmp_path / "c.yaml").write_text(CAM, encoding="utf-8")
    assert main(["budget", str(tmp_path / "c.yaml")]) == 2
    assert "there is no budget" in capsys.readouterr().err


def test_a_file_that_spends_what_is_permitted_is_not_kept(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    cam = CAM.replace("tolerance: 0.01, files: [dxf]", "tolerance: 0.5, files: [{dxf: {as: polyline}}]")
    (tmp_path / "c.yaml").write_text(cam.replace("360}", "360, motion_error: 2}"), encoding="utf-8")
    assert main(["export", str(tmp_path / "c.yaml"), "--out", str(tmp_path)]) == 0
    drawing = str(tmp_path / "c" / "c.dxf")
    for runs in (100, 0):
        body = f"permitted: 0.05, tolerances: {{profile: 0.01}}, runs: {runs}"
        (tmp_path / "c.yaml").write_text(f"{cam}budget: {{{body}}}\n", encoding="utf-8")
        assert main(["budget", str(tmp_path / "c.yaml"), drawing]) == 1
        assert "contour takes most of it, 9" in capsys.readouterr().out
    assert main(["budget", str(tmp_path / "c.yaml"), str(tmp_path / "none.dxf")]) == 2
    assert "none.dxf: " in capsys.readouterr().err
    free = cam + "budget: {permitted: 0.05, tolerances: {profile: free}}\n"
    (tmp_path / "c.yaml").write_text(free, encoding="utf-8")
    assert main(["budget", str(tmp_path / "c.yaml"), drawing]) == 2
    assert "budget.permitted: nothing is left for profile: contour alone takes" in capsys.readouterr().err
    (tmp_path / "c.yaml").write_text(free.replace("0.05", "0.9, runs: 0"), encoding="utf-8")
    assert main(["budget", str(tmp_path / "c.yaml"), drawing]) == 0


def test_a_file_on_which_the_follower_meets_nothing_is_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    small = CAM.replace("base_radius: 36", "base_radius: 15").replace("24", "3")
    (tmp_path / "c.yaml").write_text(small.replace(", keyway: din6885", ""), encoding="utf-8")
    assert main(["export", str(tmp_path / "c.yaml"), "--out", str(tmp_path)]) == 0
    body, aside = (
        "permitted: 1, tolerances: {angle: 0.1}",
        CAM.replace("radius: 9, offset: 10", "radius: 3, offset: 30"),
    )
    assert run(tmp_path, body, str(tmp_path / "c" / "c.dxf"), cam=aside) == 2
    assert capsys.readouterr().err.endswith("near where it is meant to be; give a file that camgeo verify accepts\n")
    assert main(["export", str(tmp_path / "c.yaml"), "--out", str(tmp_path)]) == 0
    assert run(tmp_path, body, str(tmp_path / "c" / "c.dxf"), cam=aside) == 0


@pytest.mark.slow
def test_a_long_simulation_says_how_far_it_is(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(progress, "LONG", 0.0)
    (tmp_path / "c.yaml").write_text(
        f"{CAM}budget: {{permitted: 0.05, tolerances: {{angle: 0.01}}, runs: 4001}}\n", encoding="utf-8"
    )
    assert main(["budget", str(tmp_path / "c.yaml")]) == 0
    stages = ["sums of errors", *(f"{done} of 4,001 parts" for done in ("2,000", "4,000", "4,001"))]
    assert capsys.readouterr().err == "".join(f"c: {stage} ...\n" for stage in stages)


@pytest.mark.slow
def test_the_starter_leaves_a_tolerance_for_the_profile(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    path = tmp_path / "cam.yaml"
    path.write_text(starter("disc-budget"), encoding="utf-8")
    assert main(["budget", str(path), "--json"]) == 0
    entry = json.loads(capsys.readouterr().out)
    assert entry["left"]["name"] == "profile"
    assert 0.0 < entry["left"]["least"] < entry["permitted"] == 0.05


def test_what_must_be_permitted_is_the_greatest_sum(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """The profile's share by the pressure angle, and the angle's by the velocity, over a cycloidal rise and return."""
    motion = "[{rise: 24, over: 180, law: cycloidal}, {return: 24, over: 180, law: cycloidal}]"
    cam = f"cam: {{kind: disc, base_radius: 36, follower: {{kind: roller, radius: 9}}, motion: {motion}}}\n"
    phi = np.linspace(0.0, math.pi, 100_001)
    s, v = 24 / math.pi * (phi - np.sin(2 * phi) / 2), 24 / math.pi * (1 - np.cos(2 * phi))
    needed = (0.02 * np.hypot(1.0, v / (45 + s)) + math.radians(0.05) * v).max()
    body = "permitted: {:.6f}, tolerances: {{profile: 0.02, angle: 0.05, follower.radius: free}}"
    assert run(tmp_path, body.format(0.01), cam=cam) == 2
    said = capsys.readouterr().err
    number = float(said.split("permit more than ")[1].split()[0])
    assert needed <= number < needed * (1 + 1e-4)
    assert run(tmp_path, body.format(number * 0.9999), cam=cam) == 2
    assert run(tmp_path, body.format(number * 1.0001), cam=cam) == 0
