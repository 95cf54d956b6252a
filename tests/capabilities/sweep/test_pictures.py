"""Pictures of a sweep: long names, one variable."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
import pytest
from support.sweepers import GRID, PROCEDURES, RANKING, gather_inputs, hills, task

from camgeo.capabilities.sweep.engines import Workers
from camgeo.capabilities.sweep.gather import gather
from camgeo.capabilities.sweep.pictures import draw_map
from camgeo.capabilities.sweep.search import search
from camgeo.capabilities.sweep.task import SweepTask
from camgeo.recipe.loading import read

if TYPE_CHECKING:
    from pathlib import Path


@pytest.mark.slow
def test_a_picture_has_room_for_long_names_and_notes() -> None:
    cells = gather(GRID, RANKING, gather_inputs(GRID)).cells
    paths = ", ".join(f"linkage.dyads[{i}].links[{j}]" for i in range(9) for j in (0, 1))
    files = draw_map(
        "a" * 60 + " " + "b" * 60, cells, "dwell (deg)", paths[:46].split(", "), np.empty((0, 2)), notes=paths
    )
    assert files["png"].startswith(b"\x89PNG")
    assert b"links[1]" in files["svg"]


@pytest.mark.slow
def test_a_curve_over_one_variable_is_drawn(tmp_path: Path) -> None:
    text = task().recipe.text.replace("    linkage.rocker: {from: 95, to: 110, steps: 33}\n", "")

    def flat(_scene, values):
        return hills("", np.column_stack([values, np.full(len(values), 111.0)]))

    procedures = replace(PROCEDURES, compute=flat, measure=lambda _task, values: {"dwell": flat("", values)["dwell"]})
    outcome = search(SweepTask.from_recipe(read(text.encode(), "a.yaml")), tmp_path, Workers(1), procedures)
    assert outcome.report["counts"]["computed"] == 25
    assert (outcome.folder / "sweep-map.png").read_bytes().startswith(b"\x89PNG")
