"""Chunks on disk: whole or not there, and nobody else's."""

from __future__ import annotations

import os
import time
from typing import TYPE_CHECKING

import numpy as np
import pytest
from support.sweepers import GRID, calls, fail, hills, job, task

from camgeo.capabilities.sweep import chunks as storing
from camgeo.capabilities.sweep.chunks import (
    ChunkError,
    Chunks,
    SweepJob,
    VersionsError,
    chunks_of,
    compute,
    decode,
    encode,
    gather_chunks,
    result,
)
from camgeo.capabilities.sweep.engines import Workers
from camgeo.capabilities.sweep.figures import SweepScene
from camgeo.capabilities.sweep.gather import Ranking
from camgeo.capabilities.sweep.keys import Axis
from camgeo.capabilities.sweep.plan import Plan
from camgeo.capabilities.sweep.task import SweepTask
from camgeo.common.errors import SurroundingsError
from camgeo.recipe.loading import load_text, read

if TYPE_CHECKING:
    from pathlib import Path

BEST = Ranking("dwell", most=True)


@pytest.fixture
def filled(tmp_path: Path) -> Chunks:
    chunks = chunks_of(job(), tmp_path)
    compute(job(), chunks, Workers(1))
    return chunks


def test_what_is_written_is_read_to_the_last_bit() -> None:
    figures = {"a": np.array([np.nan, -0.0, 5e-324, 1 / 3]), "b": np.array([np.inf, 1.0, 2.0, 3.0])}
    again = decode(encode("key", 4, 8, figures), "key", 4, 8)
    assert list(again) == ["a", "b"]
    assert all(again[name].tobytes() == values.tobytes() for name, values in figures.items())


def test_arrays_of_another_length_or_type_are_refused() -> None:
    with pytest.raises(ValueError, match="a of designs 0 to 3"):
        encode("key", 0, 3, {"a": np.zeros(2)})
    with pytest.raises(ValueError, match="a of designs 0 to 2"):
        encode("key", 0, 2, {"a": np.zeros(2, np.float32)})


def test_every_cut_and_every_changed_byte_is_noticed() -> None:
    data = encode("key", 0, 3, {"a": np.arange(3.0)})
    for length in range(len(data)):
        with pytest.raises(ChunkError, match="torn or changed"):
            decode(data[:length], "key", 0, 3)
    for place in range(len(data)):
        changed = data[:place] + bytes([data[place] ^ 1]) + data[place + 1 :]
        with pytest.raises(ChunkError, match="torn or changed"):
            decode(changed, "key", 0, 3)
    with pytest.raises(ChunkError, match="torn or changed"):
        decode(data + b"\0", "key", 0, 3)


@pytest.mark.parametrize("mine", [("other", 0, 3), ("key", 3, 6), ("key", 0, 4)])
def test_a_sound_chunk_of_another_place_is_noticed(mine: tuple[str, int, int]) -> None:
    with pytest.raises(ChunkError, match="of another sweep, or another chunk of this one"):
        decode(encode("key", 0, 3, {"a": np.arange(3.0)}), *mine)


@pytest.mark.parametrize("fault", ["torn", "empty", "changed", "planted", "foreign", "gone"])
def test_a_spoilt_chunk_is_computed_again_and_no_other(filled: Chunks, tmp_path: Path, fault: str) -> None:
    sound = {path.name: path.read_bytes() for path in filled.folder.iterdir()}
    path, data = filled.path(5), filled.path(5).read_bytes()
    if fault == "torn":
        path.write_bytes(data[:-100])
    elif fault == "empty":
        path.write_bytes(b"")
    elif fault == "changed":
        path.write_bytes(data[:200] + bytes([data[200] ^ 64]) + data[201:])
    elif fault == "planted":
        path.write_bytes(filled.path(6).read_bytes())
    elif fault == "foreign":
        path.write_bytes(encode("f" * 64, *GRID.span(5), hills("", GRID.values(*GRID.span(5)))))
    else:
        path.unlink()
    told = tmp_path / "calls"
    told.mkdir()
    work = compute(job(scene=f"calls={told};"), filled, Workers(1))
    assert work.computed == 64
    assert work.reused == GRID.count - 64
    assert work.damaged == (fault != "gone")
    assert calls(told) == [repr(GRID.values(*GRID.span(5))[0].tolist())]
    assert {path.name: path.read_bytes() for path in filled.folder.iterdir()} == sound


def test_a_chunk_that_is_spoilt_before_it_is_gathered_is_computed_again(filled: Chunks) -> None:
    expected = gather_chunks(job(), filled, BEST)
    filled.path(2).write_bytes(b"torn")
    filled.path(3).unlink()
    again = gather_chunks(job(), filled, BEST)
    assert again.index.tolist() == expected.index.tolist()
    assert again.counts == expected.counts


@pytest.mark.parametrize("place", ["out", "out/sweep", "out/sweep/KEY"])
def test_a_file_in_the_place_of_a_folder_is_told_before_anything_is_computed(place: str, tmp_path: Path) -> None:
    chunks = chunks_of(job(), tmp_path / "out")
    path = tmp_path / place.replace("KEY", chunks.folder.name)
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text("mine")
    with pytest.raises(SurroundingsError, match=r"not a folder, where .*: move it or remove it") as refused:
        compute(job(compute=fail), chunks, Workers(1))
    assert refused.value.path == path
    path.rename(tmp_path / "elsewhere")  # as the message says
    assert compute(job(), chunks, Workers(1)).computed == GRID.count


def test_a_wrong_result_is_refused_before_it_is_written(filled: Chunks) -> None:
    before = filled.path(1).read_bytes()
    with pytest.raises(ChunkError):
        filled.write(1, filled.path(2).read_bytes())
    assert filled.path(1).read_bytes() == before


def test_nothing_is_computed_twice(filled: Chunks) -> None:
    assert compute(job(), filled, Workers(1)).computed == 0


def test_fresh_computes_all_again(filled: Chunks) -> None:
    assert compute(job(), filled, Workers(1), fresh=True).computed == GRID.count


def test_what_killed_runs_left_is_cleared_away_and_what_others_write_is_not(filled: Chunks) -> None:
    old, young, own = (filled.folder / name for name in (".chunk-0000001.1.part", ".chunk-0000002.1.part", "mine.txt"))
    for path in (old, young, own):
        path.write_bytes(b"")
    os.utime(old, (time.time() - 7200, time.time() - 7200))
    filled.open(fresh=True)
    assert sorted(path.name for path in filled.folder.iterdir()) == [young.name, own.name]


# --- the key ----------------------------------------------------------------------------------------------------------


def test_the_key_is_of_all_that_a_recipe_says() -> None:
    """Not of its name alone, which is all that its `repr` shows."""
    text = "cam: {kind: support, p: SIZE + cos(3*t), shaft: [1, 2]}\n"
    scenes = [SweepScene(load_text(text.replace("SIZE", size), "cam.yaml"), ("size",)) for size in ("25", "26", "25")]
    assert repr(scenes[0].recipe) == repr(scenes[1].recipe) == "Recipe('cam', 'cam.yaml')"
    assert repr(scenes[0]) == repr(scenes[2]) != repr(scenes[1])


def test_the_key_changes_with_all_that_decides_the_outcome(monkeypatch: pytest.MonkeyPatch) -> None:
    plain = job()
    axes = (GRID.axes[0], Axis("linkage.ground", 95.0, 110.0, GRID.axes[1].values))
    others = [
        job(Plan(axes, "grid", 825)),
        job(Plan(GRID.axes, "random", 825)),
        job(Plan(GRID.axes, "random", 825, 1)),
        SweepJob(GRID, "another", hills),
        job(compute=fail),
    ]
    for package in (storing, np):
        monkeypatch.setattr(package, "__version__", "99.0")
        others_key = job().key
        monkeypatch.undo()
        assert others_key != plain.key
    assert len({plain.key, *(other.key for other in others)}) == 6
    key = plain.key
    monkeypatch.setattr(storing, "REVISION", 99)
    assert job().key != key


def test_what_does_not_bear_on_the_figures_leaves_the_key() -> None:
    def key(recipe: SweepTask) -> str:
        return SweepJob(recipe.plan, recipe.scene(recipe.figures), hills).key

    plain = key(task())
    for same in (
        task("a comment"),
        task(margin=3.0),
        task(rank="margin"),
        task(refine="true"),
        task(path="other/name.yaml"),
    ):
        assert key(same) == plain
    longer = task()
    # needs: dynamics
    train = "dynamics: {mass: 0.4, stiffness: 2.0e5, preload: 150, rpm: 600}\n"
    # needs: dynamics
    assert key(SweepTask.from_recipe(read((longer.recipe.text + train).encode(), "four-bar.yaml"))) == plain
    text = longer.recipe.text.replace("coupler: 70", "coupler: 71")
    assert key(SweepTask.from_recipe(read(text.encode(), "four-bar.yaml"))) != plain


def test_limits_cost_computing_only_where_they_ask_for_another_figure() -> None:
    def key(limits: str, rank: str = "dwell") -> str:
        text = task(rank=rank).recipe.text.replace("margin: {at_least: 1.0}", limits)
        asked = SweepTask.from_recipe(read(text.encode(), "four-bar.yaml"))
        return SweepJob(asked.plan, asked.scene(asked.figures), hills).key

    plain = key("margin: {at_least: 1}")
    assert key("swing: {at_least: 20}, size: {at_most: 44}, dwell: {at_least: 9}") == plain
    assert key("margin: {at_least: 1}", "transmission-angle") == plain
    assert key("force-angle: {at_least: 9}") == key("margin: {at_least: 1}", "force-angle") != plain


def test_a_worker_of_other_versions_is_refused() -> None:
    with pytest.raises(VersionsError, match=r"a worker has other versions than this run, .*: camgeo .*, numpy "):
        result(job(), 0, "0" * 64)
