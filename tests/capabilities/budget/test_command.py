"""The command `camgeo budget`: what it prints of budgets that are kept, found, or taken by one dimension.

Holds: camgeo.capabilities.budget, camgeo.capabilities.budget.library, camgeo.capabilities.budget.outcome,
camgeo.capabilities.budget.starter, camgeo.capabilities.budget.text.
"""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

import pytest
from support.budgets import CAM

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


def test_the_starter_leaves_a_tolerance_for_the_profile(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    path = tmp_path / "cam.yaml"
    path.write_text(starter("disc-budget"), encoding="utf-8")
    assert main(["budget", str(path), "--json"]) == 0
    entry = json.loads(capsys.readouterr().out)
    assert entry["left"]["name"] == "profile"
    assert 0.0 < entry["left"]["least"] < entry["permitted"] == 0.05
