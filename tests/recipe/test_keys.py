"""Keys of a recipe: whatever has a fault, no check between fields reads a value that is not there.

Holds: camgeo.recipe.keys.
"""

from __future__ import annotations

import json
from random import Random
from typing import Any

import pytest
from support.cases import few
from support.places import RECIPES, SHIPPED
from support.spoilt import by_schema, one_wrong, schema

from camgeo.recipe.extension import KEYS as OF_CAPABILITIES
from camgeo.recipe.loading import load_order_text
from camgeo.recipe.starter import STARTERS, starter
from camgeo.registry import root as roots
from camgeo.registry.root import CAM
from camgeo.schema.errors import RecipeErrors

BASES = {name: starter(name) for name in STARTERS} | {path.name: path.read_text(encoding="utf-8") for path in SHIPPED}
QUICK = [
    "disc-roller",
    "disc-budget",  # needs: budget
    "valve-train",  # needs: dynamics, valve
]
KINDS = (CAM, *roots.folders())
TRAIN = """\
cam:
  kind: disc
  base_radius: 36
  follower: {kind: roller, radius: 9}
  motion: [{rise: 24, over: 180, law: cycloidal}, {return: 24, over: 180, law: cycloidal}]
dynamics: {mass: 1, rpm: 100, preload: 80, load: {table: [[0, 5], [90, 80], [270, 9]], units: kN}}
"""


def faults(text: str) -> tuple[str, ...]:
    """Paths of a recipe's faults; empty for a sound one."""
    try:
        load_order_text(text, str(RECIPES / "case.yaml"))
    except RecipeErrors as errors:
        return tuple(error.path for error in errors.errors)
    return ()


@pytest.mark.parametrize("seed", few(range(10), 10))
@pytest.mark.parametrize("order", KINDS)
def test_recipes_of_any_keys_have_faults_and_no_more(order: str, seed: int) -> None:
    """Each seed stands for 40 recipes; the first waits for the schema of all keys."""
    rng = Random(f"{order} {seed}")
    for _ in range(40):
        faults(by_schema(rng, order))


def test_recipes_of_any_keys_have_the_keys_of_all_capabilities() -> None:
    rng, met = Random(1), set[str]()
    for _ in range(200):
        data = json.loads(by_schema(rng))
        met |= {f"{key}.{below}" for key, value in data.items() if isinstance(value, dict) for below in value}
    for name in OF_CAPABILITIES.answering():
        if name in (fields := schema(CAM)["properties"]) and "properties" in fields[name]:
            assert {f"{name}.{below}" for below in fields[name]["properties"]} <= met


@pytest.mark.parametrize(
    ("wrong", "name"),
    [
        pytest.param(wrong, name, marks=() if name in QUICK and wrong == "@nought" else pytest.mark.slow)
        for number, name in enumerate(BASES)
        for wrong in ("@nought", ([], None, {"x": "y"}, -1)[number % 4])
    ],
)
def test_a_sound_recipe_with_one_wrong_value_has_faults_and_no_more(name: str, wrong: Any) -> None:
    assert sum(bool(faults(text)) for text in one_wrong(BASES[name], wrong))


def test_a_depth_that_is_wrong_is_not_said_to_be_missing() -> None:
    groove = starter("disc-groove")
    assert "depth: 6" in groove
    assert faults(groove.replace("depth: 6", "depth: nought")) == ("cam.track.groove.depth",)


def test_overlays_of_an_unknown_cam_are_not_refused() -> None:
    listed = "cam: {kind: disk, p: 9}\nexport: {files: [{html: {overlays: [evolute, pedal]}}]}"
    assert faults(listed) == ("cam.kind",)
    assert faults(listed.replace("pedal", "petal")) == ("cam.kind", "export.files[0].html.overlays[1]")


# needs: dynamics
def test_loads_in_a_unit_of_moments_are_refused_on_a_stem() -> None:
    assert faults(TRAIN) == ()
    assert faults(TRAIN.replace("kN", "lbf in")) == ("dynamics.load.units",)
    arm = TRAIN.replace("radius: 9", "radius: 9, arm: {length: 65, pivot: 80}").replace("rise: 24", "rise: 20")
    assert faults(arm.replace("return: 24", "return: 20")) == ("dynamics.load.units",)
    assert faults(arm.replace("return: 24", "return: 20").replace("kN", "lbf in")) == ()
