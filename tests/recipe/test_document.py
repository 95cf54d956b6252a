"""The text of a recipe: places of its fields, errors at them, other values in it."""

from pathlib import Path
from typing import Any

import pytest

import camgeo
from camgeo.recipe.document import Document

TEXT = "cam: {kind: support, p: 25}\nexport:\n  files: [dxf]\n"
DOCUMENT = Document(path=Path("a.yaml"), text=TEXT, marks={"cam": (1, 1), "cam.p": (1, 22), "export": (2, 1)})


def test_a_field_that_is_not_given_has_the_place_of_its_parent():
    assert [DOCUMENT.locate(path) for path in ("cam.p", "cam.shaft[0].x", "export.files[2]", "part")] == [
        (1, 22),
        (1, 1),
        (2, 1),
        (1, 1),
    ]


def test_an_error_has_its_place_and_one_of_a_text_has_none():
    assert str(DOCUMENT.error("cam.p", "too small", "25 mm", "give more")) == (
        "a.yaml:1:22: cam.p: too small, given 25 mm; give more"
    )
    unplaced = Document(path=Path("a.yaml"), text=TEXT, marks=DOCUMENT.marks, unplaced="recipe")
    assert str(unplaced.error("cam.p", "too small")).startswith("recipe: cam.p: too small")


def test_values_change_and_all_else_stays():
    assert DOCUMENT.changed({"cam.p": 30, "export.tolerance": 0.01}).startswith(
        "cam: {kind: support, p: 30}\nexport:\n"
    )
    assert DOCUMENT.text_with({"cam.p": 26.5}) == TEXT.replace("25", "26.5")
    numbered: Any = {1: 2.0}
    with pytest.raises(TypeError, match="a path must be a str"):
        DOCUMENT.text_with(numbered)


def test_a_text_is_saved_as_it_is(tmp_path):
    DOCUMENT.save(tmp_path / "b.yaml")
    assert (tmp_path / "b.yaml").read_bytes() == TEXT.encode()
    with pytest.raises(camgeo.SurroundingsError, match="cannot be written"):
        DOCUMENT.save(tmp_path / "none" / "b.yaml")
