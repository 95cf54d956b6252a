"""Recipes that are none of a disc cam: begun by their table of keys, and finished as a value or as faults."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pytest

from camgeo.recipe.own_kind import begin, entry_at, finish
from camgeo.registry import root as roots
from camgeo.schema.errors import RecipeErrors
from camgeo.schema.yaml_source import Scalar, Source

if TYPE_CHECKING:
    from camgeo.recipe.document import Document
    from camgeo.schema.reader import Reader, Values

AXIS = "axis: {rpm: 60, motion: [{rise: 90, over: 180, law: cycloidal}, {return: 90, over: 180, law: cycloidal}]}\n"
PATH = Path("table.yaml")


@pytest.mark.parametrize(
    ("text", "there"),
    [("a: {b: {c: 1}}", True), ("a: {b: 1}", False), ("a: 1", False), ("[1]", False), ("a: {b: {d: 1}}", False)],
)
def test_an_entry_is_looked_for_below_mappings_alone(text: str, there: bool) -> None:
    found = entry_at(Source.of(text, str(PATH)).root, "a", "b", "c")
    assert isinstance(found, Scalar) is there
    assert (found is None) is not there


def kept(values: Values, document: Document, _: Reader) -> tuple[Values, Document]:
    return values, document


# needs: axis
@pytest.mark.parametrize(("swings", "unit"), [(False, 1.0), (True, math.radians(1.0))])
def test_a_motion_that_swings_is_in_degrees(swings: bool, unit: float) -> None:
    reader, values = begin(Source.of(AXIS, str(PATH)), "axis", roots.reading("axis").table(), swings=swings)
    values, document = finish(reader, values, PATH, lambda *_: None, kept)
    motion = values["axis"]["motion"].motion(2.0 * math.pi, "axis.motion", None)
    assert motion.derivatives(np.array([math.pi]), 0)[0] == pytest.approx(90.0 * unit)
    assert values["name"] == "table"
    assert (document.path, document.text) == (PATH, AXIS)


# needs: axis
def test_faults_of_keys_and_between_keys_end_in_errors() -> None:
    def check(_: Values, reader: Reader) -> None:
        reader.fault_at("axis.rpm", "is refused here", None, "give another")

    table = roots.reading("axis").table()
    with pytest.raises(RecipeErrors, match="rpm: is refused here; give another"):
        finish(*begin(Source.of(AXIS, str(PATH)), "axis", table, swings=False), PATH, check, kept)
    spoilt = AXIS.replace("rpm", "rpn")  # between keys nothing is looked at then
    with pytest.raises(RecipeErrors, match="did you mean rpm") as errors:
        finish(*begin(Source.of(spoilt, str(PATH)), "axis", table, swings=False), PATH, check, kept)
    assert "is refused here" not in str(errors.value)
