"""Sets to print in a slicer, where one is installed: every body sound, in as many layers as the tallest has."""

from __future__ import annotations

import math
import re
import shutil
import subprocess
from typing import TYPE_CHECKING

import pytest
from support.places import RECIPES

from camgeo.output import pipeline
from camgeo.recipe.loading import load

if TYPE_CHECKING:
    from pathlib import Path

LAYER = 0.2  # mm
FIRST = 0.35  # the slicer's own first layer


def sliced(*words: object) -> str:
    command = ["prusa-slicer", *map(str, words)]
    return subprocess.run(command, check=True, capture_output=True, text=True, timeout=300).stdout


@pytest.mark.slow
@pytest.mark.skipif(shutil.which("prusa-slicer") is None, reason="PrusaSlicer is not installed")
@pytest.mark.parametrize(("name", "bodies"), [("print-roller", 8), ("print-arm", 8)])
def test_a_set_is_sliced(tmp_path: Path, name: str, bodies: int) -> None:
    recipe = load(RECIPES / f"{name}.yaml")
    outcome = pipeline.export(recipe, tmp_path)
    assert outcome.ok
    assert outcome.folder is not None
    path, program = outcome.folder / f"{name}-parts.3mf", tmp_path / "set.gcode"
    told = sliced("--info", path)
    assert re.findall(r"manifold = (\w+)", told) == bodies * ["yes"]
    assert [abs(float(z)) < 1e-5 for z in re.findall(r"min_z = (\S+)", told)] == bodies * [True], "all on the bed"
    tallest = max(float(z) for z in re.findall(r"max_z = (\S+)", told))
    bed = ["--bed-shape", "0x0,400x0,400x400,0x400", "--center", "200,200"]
    said = sliced("--export-gcode", "--layer-height", LAYER, *bed, "-o", program, path)
    assert not re.search(r"error|warning|repaired", said, re.IGNORECASE)
    layers = program.read_text().count(";LAYER_CHANGE")
    assert layers == pytest.approx(1 + math.ceil((tallest - FIRST) / LAYER - 1e-6), abs=1)
