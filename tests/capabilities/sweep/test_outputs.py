"""The files of a sweep: table, report, recipes, pictures."""

from __future__ import annotations

import csv
import io
import json
from dataclasses import replace
from typing import TYPE_CHECKING, Any, cast

import numpy as np
import pytest
from support.heavy import parquet
from support.sweepers import GRID, PROCEDURES, RANKING, by_hand, task

from camgeo.capabilities.sweep import outputs
from camgeo.capabilities.sweep.engines import Workers
from camgeo.capabilities.sweep.outputs import Best, curve_of, recipe_text
from camgeo.capabilities.sweep.search import search
from camgeo.capabilities.sweep.task import SweepTask
from camgeo.recipe.loading import load, read

if TYPE_CHECKING:
    from pathlib import Path

PNG, SVG = b"\x89PNG", b"<?xml"


@pytest.fixture(scope="module")
def swept(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return search(task(), tmp_path_factory.mktemp("out"), Workers(1), PROCEDURES).folder


def test_all_files_are_there_and_the_report_tells_them(swept: Path) -> None:
    report = json.loads((swept / "sweep.json").read_text(encoding="utf-8"))
    names = {"sweep.csv", "sweep.parquet", "sweep-map.png", "sweep-map.svg", "sweep-best.png", "sweep-best.svg"}
    names |= {"best-1.yaml", "best-2.yaml", "best-3.yaml"}
    assert {file["path"] for file in report["files"]} == names
    assert {path.name for path in swept.iterdir()} == names | {"sweep.json", "sweep"}
    assert all((swept / file["path"]).stat().st_size == file["bytes"] for file in report["files"])
    assert report["skipped"] == []
    for name in ("sweep-map", "sweep-best"):
        assert (swept / f"{name}.png").read_bytes().startswith(PNG)
        assert (swept / f"{name}.svg").read_bytes().startswith(SVG)


def test_csv_and_parquet_hold_every_design_kept_to_the_last_bit(swept: Path) -> None:
    rows = list(csv.reader(io.StringIO((swept / "sweep.csv").read_text(encoding="utf-8"))))
    expected = by_hand(RANKING)
    assert rows[0] == ["place", "index", "cam.shaft[0]", "linkage.rocker", "dwell_deg", "margin_mm"]
    assert [(float(row[4]), int(row[1])) for row in rows[1:]] == expected
    assert [int(row[0]) for row in rows[1:]] == list(range(1, len(expected) + 1))
    values = GRID.values(0, 825)
    assert all([float(row[2]), float(row[3])] == values[int(row[1])].tolist() for row in rows[1:])
    table = parquet.read_table(swept / "sweep.parquet")
    assert table.column_names == rows[0]
    assert [list(map(repr, row.values())) for row in table.to_pylist()] == rows[1:]
    assert table.schema.metadata[b"recipe"] == b"four-bar"


def test_the_best_are_whole_recipes_that_say_what_was_measured(swept: Path) -> None:
    for place, (dwell, index) in enumerate(by_hand(RANKING)[:3], 1):
        recipe = load(swept / f"best-{place}.yaml")
        x, y = GRID.values(index, index + 1)[0]
        assert recipe.name == f"four-bar-best-{place}"
        assert not recipe.uses
        assert vars(recipe.cam)["shaft"] == (x, 8.5)
        assert replace(recipe.linkage.loop, rocker=9.0) == replace(task().recipe.linkage.loop, rocker=9.0)
        assert recipe.linkage.loop.rocker == y
        origin = f"design {index} of 825 of the sweep of four-bar"
        assert recipe.about == f"{origin}: dwell {dwell:.6g} deg. AS 2023, Figure 9"
        assert "# the shaft" in recipe.text


def test_the_report_tells_what_was_asked_and_what_came_of_it(swept: Path) -> None:
    report = json.loads((swept / "sweep.json").read_text(encoding="utf-8"))
    assert report["ok"] is True
    assert report["sweep"]["vary"]["linkage.rocker"] == {"from": 95.0, "to": 110.0, "values": 33}
    assert report["sweep"]["limits"] == {"margin": {"at_least": 1.0}}
    assert report["counts"]["reasons"] == {"binds": report["counts"]["not_turning"]}
    assert report["counts"]["kept"] == report["counts"]["rows"] == len(by_hand(RANKING))
    assert [best["index"] for best in report["best"]] == [index for _, index in by_hand(RANKING)[:3]]
    # the table holds what every design was given, the best designs all there is
    in_table = {name: figure["in_table"] for name, figure in report["figures"].items()}
    assert in_table == {"dwell": True, "dwell-relative": False, "margin": True}
    assert all(set(best["figures"]) == set(in_table) for best in report["best"])
    assert report["run"]["designs_computed"] == 825
    assert report["run"]["designs_per_second"] > 0


@pytest.mark.slow
@pytest.mark.usefixtures("no_pictures")
@pytest.mark.parametrize(
    ("package", "left_out"),
    [
        ("pyarrow", ["sweep.parquet"]),
        ("matplotlib", ["sweep-map.png, sweep-map.svg", "sweep-best.png, sweep-best.svg"]),
    ],
)
def test_what_a_missing_package_leaves_out_is_told(
    package: str, left_out: list[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    missing = {"pyarrow": ["as_parquet"], "matplotlib": ["draw_map", "draw_best"]}[package]

    def without(*_arguments: object, **_named: object) -> None:
        raise ModuleNotFoundError(name=package)

    for name in missing:
        monkeypatch.setattr(outputs, name, without)
    report = search(task(), tmp_path, Workers(1), PROCEDURES).report
    why = f"the package {package} is missing: pip install '.[sweep]' in a clone of camgeo"
    assert report["skipped"] == [{"what": what, "why": why, "missing": True} for what in left_out]
    assert (tmp_path / "four-bar" / "best-1.yaml").exists()
    assert (tmp_path / "four-bar" / "sweep.csv").exists()


CAM = "cam: {kind: support, p: 20, shaft: [0, 0]}"
SWEEP = "sweep: {vary: {'cam.shaft[0]': [1, 2]}, rank: size}"


@pytest.mark.parametrize(
    "text",
    [
        f"{{{SWEEP}, {CAM}}}",
        f"---\nname: x\n{SWEEP}\n{CAM}",
        f"  about: 'it''s: # old'\r\n  {CAM}\r\n  {SWEEP}\r\n",
    ],
)
def test_recipes_are_written_in_the_way_of_the_users(text: str) -> None:
    asked = SweepTask.from_recipe(read(text.encode(), "mine.yaml"))
    best = Best(2, 1, polished=False, values={"cam.shaft[0]": 2.0}, figures={"size": 22.0})
    recipe = read(recipe_text(asked, best).encode(), "other.yaml")
    assert recipe.name == f"{asked.recipe.name}-best-2"
    assert recipe.cam == replace(cast("Any", asked.recipe.cam), shaft=(2.0, 0.0))
    assert recipe.about.startswith(f"design 1 of 2 of the sweep of {asked.recipe.name}: size 22 mm")
    assert recipe.about.endswith(asked.recipe.about)


def test_a_long_note_is_cut_to_what_a_recipe_takes() -> None:
    text = task().recipe.text.replace("AS 2023, Figure 9", "x" * 990)
    best = Best(1, 0, polished=False, values={}, figures={"dwell": 40.0})
    about = read(recipe_text(SweepTask.from_recipe(read(text.encode(), "a.yaml")), best).encode(), "b.yaml").about
    assert about.endswith("xxx...")
    assert about.startswith("design 0 of 825")


def test_the_curve_of_a_linkage_is_its_output_over_the_shaft_with_its_dwell() -> None:
    curve, name = curve_of(task().recipe, "it")
    assert name == "output (deg)"
    assert curve.output[0] == pytest.approx(curve.output[-1])
    start, length = curve.dwell
    inside = (curve.shaft >= start) & (curve.shaft <= start + length)
    assert 30.0 < length < 45.17  # less than the paper's over the relative angle
    assert np.ptp(curve.output[inside]) <= 0.1 + 1e-9
    beyond = (curve.shaft >= start - 1.0) & (curve.shaft <= start + length + 1.0)
    assert np.ptp(curve.output[beyond]) > 0.1


def test_the_curve_of_a_plain_cam_is_its_lift() -> None:
    recipe = read(b"cam: {kind: support, p: 20 + cos(3*t)}", "cam.yaml")
    curve, name = curve_of(recipe, "it")
    assert name == "lift (mm)"
    assert np.allclose(curve.output, 20.0 + np.cos(3.0 * np.radians(curve.shaft)), rtol=0, atol=1e-12)
    assert curve.dwell is None
