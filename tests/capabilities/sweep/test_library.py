"""A search from a program: what comes back, in types, and what is raised."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

import pytest

import camgeo

if TYPE_CHECKING:
    from pathlib import Path

TEXT = """\
name: turning
cam: {kind: support, p: 25 + 2*cos(3*t), shaft: [10, 4]}
sweep:
  vary: {"cam.shaft[0]": {from: 8, to: 12, steps: 3}}
  limits: {size: {at_least: LEAST}}
  rank: size
  keep: 2
"""


@pytest.mark.usefixtures("no_pictures")
def test_the_best_designs_come_with_their_recipes(tmp_path: Path) -> None:
    heard: list[str] = []
    recipe = camgeo.load(TEXT.replace("LEAST", "1"))
    search = camgeo.search(recipe, tmp_path, jobs=1, progress=heard.append)
    assert search.ok
    assert search.path == tmp_path / "turning"
    assert dict(search) == json.loads((search.path / "sweep.json").read_text(encoding="utf-8"))
    best, second = search.best
    assert best.values["cam.shaft[0]"] == 8 != second.values["cam.shaft[0]"]
    assert best.figures["size"].value == pytest.approx(camgeo.design(best.recipe).figures["size"].value, abs=1e-9)
    assert best.figures["size"].unit == "mm"
    assert best.figures["size"].value < second.figures["size"].value
    assert best.path == search.path / "best-1.yaml"
    assert any("of 3" in line for line in heard)
    assert str(search).startswith("turning: size ")
    assert repr(search) == f"Search('turning', ok, {str(search.path)!r})"


@pytest.mark.usefixtures("no_pictures")
def test_a_search_that_finds_nothing_raises_nothing(tmp_path: Path) -> None:
    search = camgeo.search(camgeo.load(TEXT.replace("LEAST", "100")), tmp_path, jobs=1)
    assert not search.ok
    assert search.best == ()
    assert search.path == tmp_path / "turning.rejected"


def test_what_cannot_be_searched_is_told(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    recipe = camgeo.load(TEXT.replace("LEAST", "1"))
    with pytest.raises(camgeo.RecipeErrors, match="sweep: "):
        camgeo.search(camgeo.load(TEXT.partition("sweep")[0]), tmp_path)
    with pytest.raises(camgeo.CallError, match="jobs is a number of processes from 1, not 0"):
        camgeo.search(recipe, tmp_path, jobs=0)
    monkeypatch.setattr("camgeo.capabilities.sweep.search.find_spec", lambda _: None)
    with pytest.raises(camgeo.SurroundingsError, match=r"the package distributed is missing: .*\[dask\]"):
        camgeo.search(recipe, tmp_path, scheduler="tcp://127.0.0.1:1")
    (tmp_path / "file").write_text("")
    with pytest.raises(camgeo.SurroundingsError, match="file"):
        camgeo.search(recipe, tmp_path / "file")


LOBE = """\
cam:
  kind: disc
  base_radius: 18
  follower: {kind: flat, width: 27}
  motion: {lobe: {lift: 8, half: 68, powers: [2, 8, 14, 20, 26]}}
sweep: {vary: {cam.motion.lobe.lift: {from: 0.5, to: 8, steps: 3}}, rank: duration}
"""


@pytest.mark.slow
@pytest.mark.usefixtures("no_pictures")
def test_designs_whose_figure_has_no_value_are_counted_by_that_reason(tmp_path: Path) -> None:
    """A lobe of 0.5 mm is never above the lift of 1.27 mm between whose crossings the duration counts."""
    counts = camgeo.search(camgeo.load(LOBE), tmp_path, jobs=1)["counts"]
    assert (counts["not_turning"], counts["reasons"]) == (1, {"no-value": 1})
