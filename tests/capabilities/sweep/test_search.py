"""A whole sweep: which designs are polished and kept, whose files are replaced, an angle that each design finds.

Holds: camgeo.capabilities.sweep.earlier.
"""

from __future__ import annotations

import csv
import io
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
import pytest
from support.sweepers import GRID, PROCEDURES, RANKING, by_hand, task

import camgeo
from camgeo.capabilities.sweep import search as searches
from camgeo.capabilities.sweep.engines import Workers
from camgeo.capabilities.sweep.outputs import outputs
from camgeo.capabilities.sweep.refine import PolishError
from camgeo.capabilities.sweep.search import search
from camgeo.capabilities.sweep.task import SweepTask
from camgeo.common.errors import SurroundingsError
from camgeo.recipe.loading import load, read

if TYPE_CHECKING:
    from pathlib import Path


def apart_by_hand(count: int) -> list[int]:
    """Indices of the best designs that lie 15 percent of a range or more from each better one taken."""
    taken: list[int] = []
    for _, index in by_hand(RANKING):
        here = GRID.values(index, index + 1)[0] / (10.0, 15.0)
        if all(np.abs(here - GRID.values(i, i + 1)[0] / (10.0, 15.0)).max() > 0.15 for i in taken):
            taken.append(index)
    return taken[:count]


@pytest.mark.slow
@pytest.mark.usefixtures("no_pictures", "pooled")
@pytest.mark.thin(2)
@pytest.mark.parametrize("jobs", [1, 2])
def test_the_best_that_lie_apart_are_polished_and_equal_ones_are_one(jobs: int, tmp_path: Path) -> None:
    text = task(refine="true").recipe.text.replace("keep: 3", "keep: 20")
    outcome = search(SweepTask.from_recipe(read(text.encode(), "x.yaml")), tmp_path, Workers(jobs), PROCEDURES)
    best = outcome.report["best"]
    # the stand-in sends every design to one place of the first variable: of rockers within 5 percent one is left
    rockers = [GRID.values(index, index + 1)[0, 1] for index in apart_by_hand(20)]
    apart: list[float] = []
    for rocker in sorted(rockers, key=lambda rocker: (-round(rocker), rockers.index(rocker))):
        if all(abs(rocker - other) > 0.05 * 15.0 for other in apart):
            apart.append(rocker)
    assert [design["values"]["linkage.rocker"] for design in best] == apart
    assert 1 < len(best) < len(rockers)
    assert all(design["polished"] and design["values"]["cam.shaft[0]"] == 15.0 for design in best)
    assert [design["file"] for design in best] == [f"best-{place}.yaml" for place in range(1, len(best) + 1)]
    assert load(outcome.folder / "best-1.yaml").about.startswith(f"polished from design {best[0]['index']} of 825")


@pytest.mark.usefixtures("no_pictures")
def test_the_table_holds_what_was_polished_and_the_best_lie_apart(tmp_path: Path) -> None:
    text = task(refine="true").recipe.text.replace("keep: 3", "keep: 20")
    outcome = search(
        SweepTask.from_recipe(read(text.encode(), "x.yaml")), tmp_path, Workers(1), replace(PROCEDURES, polish=_crowd)
    )
    best, folder = outcome.report["best"], outcome.folder
    rows = list(csv.DictReader(io.StringIO((folder / "sweep.csv").read_text(encoding="utf-8"))))
    new = [row for row in rows if row["polished"] == "1"]
    assert new == rows[: len(best)]  # they are better than all others
    for design, row in zip(best, new, strict=True):
        assert int(row["index"]) == design["index"]
        assert {path: float(row[path]) for path in design["values"]} == design["values"]
        assert float(row["dwell_deg"]) == design["figures"]["dwell"]
    assert [row["place"] for row in rows] == [str(place) for place in range(1, len(rows) + 1)]
    assert outcome.report["counts"]["rows"] == len(rows) == outcome.report["counts"]["kept"] + len(new)
    assert sorted(rows, key=lambda row: -float(row["dwell_deg"])) == rows
    # of designs within 5 percent of the range of 15 only the best is left
    rockers = [design["values"]["linkage.rocker"] for design in best]
    assert len(rockers) == 2
    assert abs(rockers[1] - rockers[0]) > 0.05 * 15.0


def _crowd(_task: SweepTask, values: dict[str, float]) -> tuple[dict[str, float], dict[str, float]]:
    """Polish to places that lie within 4 percent of 15 about 97 and 105."""
    rocker = round((97.0 if values["linkage.rocker"] < 102.0 else 105.0) + values["linkage.rocker"] / 500.0, 6)
    return {"cam.shaft[0]": 15.0, "linkage.rocker": rocker}, {"dwell": rocker, "margin": 3.0}


def _refuse(_task: SweepTask, _values: dict[str, float]) -> tuple[dict[str, float], dict[str, float]]:
    raise PolishError("nothing is left of the band")


@pytest.mark.slow
@pytest.mark.usefixtures("no_pictures")
def test_what_could_not_be_polished_is_told(tmp_path: Path) -> None:
    report = search(task(refine="true"), tmp_path, Workers(1), replace(PROCEDURES, polish=_refuse)).report
    assert [design["polished"] for design in report["best"]] == [False] * 3
    assert [entry["what"] for entry in report["skipped"] if entry["what"].startswith("polishing")] == [
        f"polishing best-{place}.yaml" for place in (1, 2, 3)
    ]
    assert all(set(best["figures"]) == {"dwell", "dwell-relative", "margin"} for best in report["best"])


@pytest.mark.slow
@pytest.mark.usefixtures("no_pictures")
def test_a_sweep_that_finds_nothing_leaves_the_last_files_alone(tmp_path: Path) -> None:
    search(task(), tmp_path, Workers(1), PROCEDURES)
    before = (tmp_path / "four-bar" / "sweep.json").read_bytes()
    outcome = search(task(margin=99.0), tmp_path, Workers(1), PROCEDURES)
    assert outcome.report["ok"] is False
    assert outcome.report["counts"]["kept"] == 0
    assert outcome.folder == tmp_path / "four-bar.rejected"
    assert {path.name for path in outcome.folder.iterdir()} >= {"sweep.json", "sweep.csv", "sweep-map.png"}
    assert (tmp_path / "four-bar" / "sweep.json").read_bytes() == before
    assert outcome.work.computed == 0  # other limits, the same figures


@pytest.mark.usefixtures("no_pictures")
def test_a_run_that_finds_all_as_it_was_makes_no_file_again(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setattr(searches, "COMPUTING", PROCEDURES)
    made, folder = [], tmp_path / "four-bar"
    monkeypatch.setattr(searches, "outputs", lambda *given: made.append(1) or outputs(*given))
    first = search(task(), tmp_path, Workers(1))
    before = {path.name: path.read_bytes() for path in folder.iterdir() if path.is_file()}
    again = search(task(), tmp_path, Workers(1))
    assert len(made) == 1
    assert (again.report["run"]["designs_computed"], again.report["run"]["designs_found"]) == (0, 825)
    assert {**again.report, "run": None} == {**first.report, "run": None}
    after = {path.name: path.read_bytes() for path in folder.iterdir() if path.is_file()}
    assert {**after, "sweep.json": b""} == {**before, "sweep.json": b""}
    (folder / "sweep.csv").write_text("changed")
    search(task(), tmp_path, Workers(1))
    assert (len(made), (folder / "sweep.csv").read_bytes()) == (2, before["sweep.csv"])
    search(task(margin=2.0), tmp_path, Workers(1))
    search(task(margin=2.0), tmp_path, Workers(1), fresh=True)
    assert len(made) == 4


@pytest.mark.slow
@pytest.mark.usefixtures("no_pictures")
def test_a_users_own_files_are_left_alone(tmp_path: Path) -> None:
    folder = tmp_path / "four-bar"
    folder.mkdir()
    (folder / "notes.txt").write_text("mine")
    search(task(), tmp_path, Workers(1), PROCEDURES)
    (folder / "best-7.yaml").write_text("mine")
    search(task(), tmp_path, Workers(1), PROCEDURES)
    assert (folder / "notes.txt").read_text() == (folder / "best-7.yaml").read_text() == "mine"


@pytest.mark.parametrize("name", ["best-3.yaml", "sweep.csv", "sweep-map.svg"])
def test_a_users_file_in_the_way_is_told_before_anything_is_computed(name: str, tmp_path: Path) -> None:
    (tmp_path / "four-bar").mkdir()
    (tmp_path / "four-bar" / name).write_text("mine")
    with pytest.raises(SurroundingsError, match=f"{name}: is in the way"):
        search(task(), tmp_path, Workers(1), PROCEDURES)
    assert [path.name for path in (tmp_path / "four-bar").iterdir()] == [name]
    assert [path.name for path in tmp_path.iterdir()] == ["four-bar"]


@pytest.mark.usefixtures("no_pictures")
@pytest.mark.slow
def test_fewer_best_designs_take_the_old_ones_away(tmp_path: Path) -> None:
    search(task(), tmp_path, Workers(1), PROCEDURES)
    text = task().recipe.text.replace("keep: 3", "keep: 1")
    search(SweepTask.from_recipe(read(text.encode(), "x.yaml")), tmp_path, Workers(1), PROCEDURES)
    assert sorted(path.name for path in (tmp_path / "four-bar").glob("*.yaml")) == ["best-1.yaml"]


TEXT = """
cam:
  kind: disc
  base_radius: 40
  follower: {kind: roller, radius: 8}
  motion: [{rise: 12, over: 240, law: cycloidal}, {return: 12, over: least, law: modified-sine}, {dwell: rest}]
limits: {pressure-angle: {at_most: 25}}
sweep: {vary: {cam.base_radius: {from: 40, to: 50, steps: 2}}, rank: peak-acceleration}
"""


@pytest.mark.slow
def test_each_design_of_a_sweep_finds_its_own_angle(tmp_path: Path) -> None:
    recipe = camgeo.load(TEXT)
    best = camgeo.search(recipe, tmp_path).best
    angles = [each.settled.least.degrees for each in (recipe, recipe.replace("cam.base_radius", 50))]
    assert angles[0] > angles[1]
    assert [design.recipe.settled.least.degrees for design in best] == angles
