"""What a sweep comes to: counts, order, table, pictures, recipes."""

from __future__ import annotations

import csv
import io
import json
from dataclasses import replace
from typing import TYPE_CHECKING, Any, cast

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from support.heavy import parquet
from support.sweepers import GRID, PROCEDURES, hills, task

from camgeo.capabilities.sweep import gather as gathering
from camgeo.capabilities.sweep import outputs
from camgeo.capabilities.sweep.engines import Engine
from camgeo.capabilities.sweep.gather import KEPT, OUTSIDE, STUCK, Ranking, gather
from camgeo.capabilities.sweep.keys import Axis
from camgeo.capabilities.sweep.outputs import Best, curve_of, recipe_text
from camgeo.capabilities.sweep.pictures import draw_map
from camgeo.capabilities.sweep.plan import Plan
from camgeo.capabilities.sweep.refine import PolishError
from camgeo.capabilities.sweep.search import search
from camgeo.capabilities.sweep.task import Task
from camgeo.common.errors import SurroundingsError
from camgeo.recipe.limits import Limit
from camgeo.recipe.loading import load, read

if TYPE_CHECKING:
    from pathlib import Path

RANKING = Ranking("dwell", most=True, limits=(Limit("margin", at_least=1.0),))
PNG, SVG = b"\x89PNG", b"<?xml"


def chunks(plan: Plan, compute=hills) -> list[dict[str, np.ndarray]]:
    return [compute("", plan.values(*plan.span(number))) for number in range(plan.chunks)]


def by_hand(ranking: Ranking, plan: Plan = GRID) -> list[tuple[float, int]]:
    """Rank and index of each design kept, one by one."""
    found = []
    for index in range(plan.count):
        figures = hills("", plan.values(index, index + 1))
        if not np.isnan(figures["dwell"][0]) and all(
            (limit.at_least is None or figures[limit.figure][0] >= limit.at_least)
            and (limit.at_most is None or figures[limit.figure][0] <= limit.at_most)
            for limit in ranking.limits
        ):
            found.append((figures[ranking.rank][0], index))
    return sorted(found, key=lambda pair: (-pair[0] if ranking.most else pair[0], pair[1]))


# --- gathering --------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("most", [True, False])
@pytest.mark.parametrize(
    "limits",
    [(), (Limit("margin", 1.0),), (Limit("margin", at_most=4.0), Limit("dwell", 38.0, 49.9)), (Limit("dwell", 99.0),)],
)
def test_designs_are_kept_and_ranked_as_by_hand(limits: tuple[Limit, ...], most: bool) -> None:
    ranking = Ranking("dwell", most=most, limits=limits)
    found, expected = gather(GRID, ranking, chunks(GRID)), by_hand(ranking)
    assert found.index.tolist() == [index for _, index in expected]
    assert found.figures["dwell"].tolist() == [value for value, _ in expected]
    assert found.counts.kept == len(expected)
    if not limits:
        assert len({value for value, _ in expected}) < len(expected)  # there are ties to tell apart


def test_counts_tell_why_designs_are_not_kept() -> None:
    limits = (Limit("margin", 1.0), Limit("dwell", 45.0))
    counts = gather(GRID, Ranking("dwell", most=True, limits=limits), chunks(GRID)).counts
    x, y = GRID.values(0, 825).T
    turns = x + y <= 128.0
    dwell = hills("", GRID.values(0, 825))["dwell"]
    assert counts.computed == 825
    assert counts.not_turning == (~turns).sum() > 0
    assert counts.reasons == ((1, counts.not_turning),)
    assert counts.failing == (("margin", (turns & (x < 13.0)).sum()), ("dwell", (dwell < 45.0).sum()))
    assert counts.kept == ((x >= 13.0) & (dwell >= 45.0)).sum() > 0


@given(most=st.integers(1, 300))
def test_a_table_that_is_cut_holds_the_best(most: int) -> None:
    expected = by_hand(RANKING)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(gathering, "MOST_ROWS", most)
        found = gather(GRID, RANKING, chunks(GRID))
    assert found.index.tolist() == [index for _, index in expected[:most]]
    assert found.counts.kept == len(expected)


def test_chunks_that_are_too_few_are_refused() -> None:
    with pytest.raises(ValueError, match="768 designs of 825"):
        gather(GRID, RANKING, chunks(GRID)[:-1])


def test_a_grids_map_has_a_cell_for_each_design() -> None:
    cells = gather(GRID, RANKING, chunks(GRID)).cells
    figures = hills("", GRID.values(0, 825))
    dwell, margin = (figures[name].reshape(25, 33) for name in ("dwell", "margin"))
    assert np.array_equal(cells.best, np.where(margin >= 1.0, dwell, np.nan), equal_nan=True)
    assert np.array_equal(cells.state, np.where(np.isnan(dwell), STUCK, np.where(margin >= 1.0, KEPT, OUTSIDE)))
    assert np.allclose(cells.centres[0], GRID.axes[0].values, rtol=0, atol=0)
    assert np.all((cells.edges[0][:-1] < cells.centres[0]) & (cells.centres[0] < cells.edges[0][1:]))


@pytest.mark.parametrize("most", [True, False])
def test_a_map_shows_the_best_over_the_other_axes(most: bool) -> None:
    third = Axis("linkage.coupler", 60.0, 80.0, steps=5)
    plan = Plan((*GRID.axes, third), "grid", 825 * 5)

    def raised(scene, values):
        figures = hills(scene, values)
        return {**figures, "dwell": figures["dwell"] + np.where(values[:, 2] == 70.0, 1.0, -1.0) * (1 if most else -1)}

    limit = (Limit("margin", 1.0),)
    flat = gather(GRID, Ranking("dwell", most=most, limits=limit), chunks(GRID)).cells
    deep = gather(plan, Ranking("dwell", most=most, limits=limit), chunks(plan, raised)).cells
    assert np.array_equal(deep.best, flat.best + (1.0 if most else -1.0), equal_nan=True)


@pytest.mark.slow
def test_every_design_of_a_sequence_falls_into_its_cell() -> None:
    plan = Plan((Axis("cam.shaft[0]", 10.0, 20.0), Axis("linkage.rocker", 95.0, 110.0)), "sobol", 5000)
    cells = gather(plan, RANKING, chunks(plan)).cells
    assert (cells.state > 0).all()
    values, figures = plan.values(0, 5000), hills("", plan.values(0, 5000))
    fine = figures["margin"] >= 1.0
    for i, j in ((0, 0), (14, 9), (25, 3), (27, 27)):
        (left, right), (low, high) = cells.edges[0][i : i + 2], cells.edges[1][j : j + 2]
        inside = (values[:, 0] >= left) & (values[:, 0] < right) & (values[:, 1] >= low) & (values[:, 1] < high)
        expected = figures["dwell"][inside & fine].max() if (inside & fine).any() else np.nan
        assert np.array_equal(cells.best[i, j], expected, equal_nan=True)


# --- files ------------------------------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def swept(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return search(task(), tmp_path_factory.mktemp("out"), Engine(1), PROCEDURES).folder


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


@pytest.mark.usefixtures("no_pictures")
@pytest.mark.slow
def test_lengths_are_told_in_the_recipes_unit(tmp_path: Path) -> None:
    text = "units: inch\n" + task(margin=0.04).recipe.text
    inches = Task.from_recipe(read(text.encode(), "x.yaml"))
    assert inches.ranking.limits[0].at_least == pytest.approx(0.04 * 25.4)
    report = search(inches, tmp_path, Engine(1), PROCEDURES).report
    first, limit = report["best"][0], report["sweep"]["limits"]["margin"]["at_least"]
    assert limit == pytest.approx(0.04)
    assert first["figures"]["margin"] == pytest.approx((first["values"]["cam.shaft[0]"] - 12.0) / 25.4)
    assert report["figures"]["margin"]["unit"] == "in"
    assert b"margin_in" in (tmp_path / "four-bar" / "sweep.csv").read_bytes()


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
    outcome = search(Task.from_recipe(read(text.encode(), "x.yaml")), tmp_path, Engine(jobs), PROCEDURES)
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
        Task.from_recipe(read(text.encode(), "x.yaml")), tmp_path, Engine(1), replace(PROCEDURES, polish=_crowd)
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


def _crowd(_task: Task, values: dict[str, float]) -> tuple[dict[str, float], dict[str, float]]:
    """Polish to places that lie within 4 percent of 15 about 97 and 105."""
    rocker = round((97.0 if values["linkage.rocker"] < 102.0 else 105.0) + values["linkage.rocker"] / 500.0, 6)
    return {"cam.shaft[0]": 15.0, "linkage.rocker": rocker}, {"dwell": rocker, "margin": 3.0}


def _refuse(_task: Task, _values: dict[str, float]) -> tuple[dict[str, float], dict[str, float]]:
    raise PolishError("nothing is left of the band")


@pytest.mark.slow
@pytest.mark.usefixtures("no_pictures")
def test_what_could_not_be_polished_is_told(tmp_path: Path) -> None:
    report = search(task(refine="true"), tmp_path, Engine(1), replace(PROCEDURES, polish=_refuse)).report
    assert [design["polished"] for design in report["best"]] == [False] * 3
    assert [entry["what"] for entry in report["skipped"] if entry["what"].startswith("polishing")] == [
        f"polishing best-{place}.yaml" for place in (1, 2, 3)
    ]
    assert all(set(best["figures"]) == {"dwell", "dwell-relative", "margin"} for best in report["best"])


@pytest.mark.slow
@pytest.mark.usefixtures("no_pictures")
def test_a_sweep_that_finds_nothing_leaves_the_last_files_alone(tmp_path: Path) -> None:
    search(task(), tmp_path, Engine(1), PROCEDURES)
    before = (tmp_path / "four-bar" / "sweep.json").read_bytes()
    outcome = search(task(margin=99.0), tmp_path, Engine(1), PROCEDURES)
    assert outcome.report["ok"] is False
    assert outcome.report["counts"]["kept"] == 0
    assert outcome.folder == tmp_path / "four-bar.rejected"
    assert {path.name for path in outcome.folder.iterdir()} >= {"sweep.json", "sweep.csv", "sweep-map.png"}
    assert (tmp_path / "four-bar" / "sweep.json").read_bytes() == before
    assert outcome.work.computed == 0  # other limits, the same figures


@pytest.mark.slow
@pytest.mark.usefixtures("no_pictures")
def test_a_users_own_files_are_left_alone(tmp_path: Path) -> None:
    folder = tmp_path / "four-bar"
    folder.mkdir()
    (folder / "notes.txt").write_text("mine")
    search(task(), tmp_path, Engine(1), PROCEDURES)
    (folder / "best-7.yaml").write_text("mine")
    search(task(), tmp_path, Engine(1), PROCEDURES)
    assert (folder / "notes.txt").read_text() == (folder / "best-7.yaml").read_text() == "mine"


@pytest.mark.parametrize("name", ["best-3.yaml", "sweep.csv", "sweep-map.svg"])
def test_a_users_file_in_the_way_is_told_before_anything_is_computed(name: str, tmp_path: Path) -> None:
    (tmp_path / "four-bar").mkdir()
    (tmp_path / "four-bar" / name).write_text("mine")
    with pytest.raises(SurroundingsError, match=f"{name}: is in the way"):
        search(task(), tmp_path, Engine(1), PROCEDURES)
    assert [path.name for path in (tmp_path / "four-bar").iterdir()] == [name]
    assert [path.name for path in tmp_path.iterdir()] == ["four-bar"]


@pytest.mark.usefixtures("no_pictures")
@pytest.mark.slow
def test_fewer_best_designs_take_the_old_ones_away(tmp_path: Path) -> None:
    search(task(), tmp_path, Engine(1), PROCEDURES)
    text = task().recipe.text.replace("keep: 3", "keep: 1")
    search(Task.from_recipe(read(text.encode(), "x.yaml")), tmp_path, Engine(1), PROCEDURES)
    assert sorted(path.name for path in (tmp_path / "four-bar").glob("*.yaml")) == ["best-1.yaml"]


@pytest.mark.usefixtures("no_pictures")
@pytest.mark.thin(2)
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
    report = search(task(), tmp_path, Engine(1), PROCEDURES).report
    why = f"the package {package} is missing: pip install '.[sweep]' in a clone of camgeo"
    assert report["skipped"] == [{"what": what, "why": why} for what in left_out]
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
    asked = Task.from_recipe(read(text.encode(), "mine.yaml"))
    best = Best(2, 1, polished=False, values={"cam.shaft[0]": 2.0}, figures={"size": 22.0})
    recipe = read(recipe_text(asked, best).encode(), "other.yaml")
    assert recipe.name == f"{asked.recipe.name}-best-2"
    assert recipe.cam == replace(cast("Any", asked.recipe.cam), shaft=(2.0, 0.0))
    assert recipe.about.startswith(f"design 1 of 2 of the sweep of {asked.recipe.name}: size 22 mm")
    assert recipe.about.endswith(asked.recipe.about)


def test_a_long_note_is_cut_to_what_a_recipe_takes() -> None:
    text = task().recipe.text.replace("AS 2023, Figure 9", "x" * 990)
    best = Best(1, 0, polished=False, values={}, figures={"dwell": 40.0})
    about = read(recipe_text(Task.from_recipe(read(text.encode(), "a.yaml")), best).encode(), "b.yaml").about
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


def test_axes_are_labelled_with_their_units() -> None:
    asked = task()
    assert [asked.axis_unit(axis.path) for axis in asked.plan.axes] == ["mm", "mm"]
    text = b"""\
cam: {kind: constant-breadth, base_radius: 40, motion: [{rise: 20, over: 120, law: cycloidal}, {dwell: 60}]}
sweep: {vary: {'cam.motion[0].rise': [10, 20], 'cam.motion[0].over': [119, 120], cam.base_radius: [1, 2]}, rank: size}
"""
    asked = Task.from_recipe(read(text, "a.yaml"))
    assert [asked.axis_unit(axis.path) for axis in asked.plan.axes] == ["mm", "deg", "mm"]


@pytest.mark.slow
def test_a_picture_has_room_for_long_names_and_notes() -> None:
    cells = gather(GRID, RANKING, chunks(GRID)).cells
    paths = ", ".join(f"linkage.dyads[{i}].links[{j}]" for i in range(9) for j in (0, 1))
    files = draw_map(
        "a" * 60 + " " + "b" * 60, cells, "dwell (deg)", paths[:46].split(", "), np.empty((0, 2)), notes=paths
    )
    assert files["png"].startswith(PNG)
    assert b"links[1]" in files["svg"]


@pytest.mark.slow
def test_a_curve_over_one_variable_is_drawn(tmp_path: Path) -> None:
    text = task().recipe.text.replace("    linkage.rocker: {from: 95, to: 110, steps: 33}\n", "")

    def flat(_scene, values):
        return hills("", np.column_stack([values, np.full(len(values), 111.0)]))

    procedures = replace(PROCEDURES, compute=flat, measure=lambda _task, values: {"dwell": flat("", values)["dwell"]})
    outcome = search(Task.from_recipe(read(text.encode(), "a.yaml")), tmp_path, Engine(1), procedures)
    assert outcome.report["counts"]["computed"] == 25
    assert (outcome.folder / "sweep-map.png").read_bytes().startswith(PNG)
