"""A material in a recipe, read by the table of any key: its name or its figures, and what is refused."""

from __future__ import annotations

import pytest

from camgeo.recipe.keys import recipe_table
from camgeo.recipe.materials import MATERIALS, Material, material
from camgeo.schema.reader import Reader
from camgeo.schema.readers import READERS
from camgeo.schema.yaml_source import entries, read_source


def read(text: str) -> tuple[Material | None, list[str]]:
    """The material of a key `stuff`, and the faults."""
    source = read_source(f"stuff: {text}\n".encode(), "case.yaml")
    reader = Reader(source, READERS, recipe_table())
    found: Material | None = reader.field(
        material("stuff", "what it is made of"), entries(source.root)["stuff"], "stuff"
    )
    return found, [str(error) for error in reader.errors]


@pytest.mark.parametrize(
    ("text", "figures"),
    [
        ("bronze", (110_000.0, 0.34)),
        ("{E: 206000, nu: 0.3}", (206_000.0, 0.3)),
        ("{E: 206 GPa, nu: 0.3, limit: 0.9 GPa}", (206_000.0, 0.3, 900.0)),
    ],
)
def test_a_name_or_figures(text: str, figures: tuple[float, ...]) -> None:
    assert read(text) == (Material(*figures), [])


def test_names_have_no_limit() -> None:
    assert all(one.limit is None for one in MATERIALS.values())
    assert MATERIALS["steel"] == Material(206_000.0, 0.3)


@pytest.mark.parametrize(
    ("text", "field", "words"),
    [
        ("stell", "", "not one of the choices, given 'stell'; did you mean steel?"),
        ("cheese", "", "give steel, nodular-iron, grey-iron, bronze, aluminium, pom or pa66, or {E: 2"),
        ("[steel]", "", "give steel, nodular-iron"),
        ("{nu: 0.3}", ".E", "missing; give a number above 0 in N/mm^2: Young's modulus, N/mm²"),
        ("{E: 0, nu: 0.3}", ".E", "not above 0"),
        ("{E: 206000, nu: 0.6}", ".nu", "above 0.5"),
        ("{E: 206000, nu: 0.3, limt: 9}", ".limt", "unknown key; did you mean limit?"),
        ("{E: 206000, nu: 0.3, limit: 0}", ".limit", "not above 0"),
    ],
)
def test_what_is_no_material(text: str, field: str, words: str) -> None:
    _, (error,) = read(text)
    assert f"stuff{field}" in error
    assert words in error
