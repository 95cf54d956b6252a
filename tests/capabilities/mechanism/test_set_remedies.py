"""What a set is advised of its bodies helps: each remedy is applied to the recipe that it was given for."""

from __future__ import annotations

import re

import pytest

from camgeo.output.job import MadeFiles
from camgeo.output.pipeline import check
from camgeo.recipe.loading import load_text
from camgeo.schema.errors import RecipeErrors

SET = """\
cam: {kind: support, fourier: {mean: 20, cos: {3: 1}}, shaft: [6, 0]}
part: {thickness: 5, bore: {square: 6}}
export: {tolerance: 0.02, files: [{stl: {parts: all}}]}
verify: {angles: 24}
"""
SETS = [  # what stands in the set's recipe, what in its place with a figure, the figure at fault, the remedy
    ("{square: 6}", "%s", 1.5, r"part\.bore: .* give a bore of (\S+) mm or more"),
    ("verify:", "mechanism: {bar: %s}\nverify:", 2, r"mechanism\.bar: .* give at least (\S+) mm"),
    ("verify:", "mechanism: {plate: %s}\nverify:", 1, r"mechanism\.plate: .* give at least (\S+) mm"),
    ("verify:", "mechanism: {knob: %s}\nverify:", 7, r"mechanism\.knob: .* give at least (\S+) mm"),
    ("0.02", "%s", 0.05, r"export\.tolerance: .* give a tolerance below (\S+) mm"),
    ("0.02,", "0.05,%.0s", 0, r"export\.tolerance: .* or a mechanism\.clearance above (\S+) mm"),
    ("verify:", "mechanism: {clearance: %s}\nverify:", 1e-6, r"mechanism\.clearance: .* give at least (\S+) mm"),
    ("verify:", "mechanism: {link: %s}\nverify:", 0.1, r"mechanism\.link: .* give at least (\S+) mm"),
    ("thickness: 5", "thickness: %s", 0.2, r"part\.thickness: .* give at least (\S+) mm"),
    ("{square: 6}", "10, flat: {across: %s}", 9.9, r"part\.flat\.across: .* give at most (\S+) mm"),
    ("{square: 6}", "10, keyway: {width: 1.1, depth: %s}", 0.2, r"part\.keyway\.depth: .* a depth of (\S+) mm or more"),
    (
        "{square: 6}",
        "10, keyway: {width: %s, depth: 2}",
        0.9,
        r"part\.keyway\.width: .* give a width of (\S+) mm or more",
    ),
    (
        "{square: 6}}",
        "{hexagon: %s}}\nmechanism: {clearance: 1.2}",
        8,
        r"part\.bore: .* give a bore of (\S+) mm or more",
    ),
    ("verify:", "mechanism: {press: %s}\nverify:", 5, r"mechanism\.press: .* give less, such as (\S+) mm"),
]


@pytest.fixture
def unwritten(monkeypatch: pytest.MonkeyPatch) -> None:
    """Of a set only the bodies are worked out: none is turned round or written."""
    monkeypatch.setattr("camgeo.capabilities.mechanism.making.collision_checks", lambda _: ())
    monkeypatch.setattr("camgeo.capabilities.mechanism.making.make_parts", lambda *_: MadeFiles(()))


def said_of_set(text: str) -> str:
    """What a set is advised of its bodies."""
    recipe = load_text(text, "set.yaml")
    try:
        check(recipe)
    except RecipeErrors as errors:
        return str(errors)
    return ""


@pytest.mark.thin(4)
@pytest.mark.usefixtures("unwritten")
@pytest.mark.parametrize(("old", "new", "wrong", "pattern"), SETS, ids=[pattern for *_, pattern in SETS])
def test_a_set_that_is_changed_as_told_can_be_made(old: str, new: str, wrong: float, pattern: str) -> None:
    told = re.search(pattern, said_of_set(SET.replace(old, new % wrong)))
    assert told
    value = float(told[1]) if told.groups() else 0.0
    if "tolerance below" in pattern:
        value *= 0.999
    changed = SET.replace(old, new % value)
    if "clearance above" in pattern:
        changed += f"mechanism: {{clearance: {1.001 * value}}}\n"
    assert pattern.split(": ", maxsplit=1)[0].replace("\\", "") + ":" not in said_of_set(changed)
