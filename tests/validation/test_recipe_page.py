"""The tables of docs/recipe.md, of its pages and of those of capabilities, against the schema."""

import re

import pytest
import recipe_page

from camgeo.capabilities.budget.dimensions import DIMENSIONS  # needs: budget
from camgeo.recipe.figures import FIGURES
from camgeo.registry.formats import FORMATS
from camgeo.registry.root import CAM, folders, reading
from camgeo.schema.json_schema import json_schema
from kin.law.formula.expression import FUNCTIONS
from kin.law.sources.laws import NAMES

PAGES = {page.name: (page, written) for page, written in recipe_page.pages().items()}
NAMES_OF_THEIR_OWN = {*FIGURES, *FORMATS}
"""Keys that are names: each kind has a table of its own."""
NAMES_OF_THEIR_OWN |= {*DIMENSIONS}  # needs: budget


@pytest.mark.parametrize(("page", "name"), [(page, name) for page, (_, written) in PAGES.items() for name in written])
def test_every_table_of_the_schema_stands_on_the_page(page, name):
    path, written = PAGES[page]
    shown = re.search(rf"<!-- {re.escape(name)} -->\n(.*?)\n<!-- end -->", path.read_text(encoding="utf-8"), re.DOTALL)
    assert shown, f"{page} has no table {name}"
    assert shown[1] == written[name], "python tests/validation/recipe_page.py"


@pytest.mark.parametrize("page", PAGES)
def test_the_page_has_no_table_besides(page):
    path, written = PAGES[page]
    text = path.read_text(encoding="utf-8")
    marks = re.findall(r"^<!-- (.*) -->\n(?:(?!<!--).*\n)*<!-- end -->$", text, re.MULTILINE)
    assert sorted(marks) == sorted(written)


def test_every_motion_has_the_keys_that_the_page_shows_once():
    cams = {f"cam {kind}": table for kind, table in recipe_page.CAMS.items()}
    of_cams = recipe_page.motions(cams)
    assert len(of_cams) >= 6
    shown = of_cams["cam disc.motion"]
    segment, sources = meanings(shown.inner), meanings(shown.form.instead)
    for name, motion in of_cams.items():
        assert meanings(motion.inner) == segment, name
        other = meanings(motion.form.instead)
        assert other.items() <= sources.items(), name
        assert {key.split(".")[0] for key in sources.keys() - other.keys()} <= {
            "repeat",
            "segments",
            "units",
            "contour",
            "curve",
            "gap",
            "across",
            "mirror",
            "turn",
        }, name


def meanings(table):
    """What each key of a table, and of the tables in it, is said to mean."""
    own = {field.name: field.about for field in table.fields}
    return own | {
        f"{path}.{key}": about for path, below in recipe_page.below(table, "") for key, about in meanings(below).items()
    }


def test_the_pages_name_every_law_and_function():
    text = "".join(page.read_text(encoding="utf-8") for page in recipe_page.CORE)
    assert [name for name in NAMES if f"`{name}`" not in text] == []
    functions = re.search(r"the functions `(.*?)`", text, re.DOTALL)
    assert functions
    assert sorted(functions[1].split()) == sorted(FUNCTIONS)


def test_each_table_stands_on_one_page():
    assert set(recipe_page.CORE[1:]) == set(recipe_page.PAGE.parent.glob("recipe-*.md"))
    found = [mark for page in recipe_page.CORE for mark in recipe_page.marks(page.read_text(encoding="utf-8"))]
    assert len(found) == len(set(found))


def properties(schema):
    """Names of all keys of a JSON schema."""
    if isinstance(schema, list):
        for each in schema:
            yield from properties(each)
    elif isinstance(schema, dict):
        own = schema.get("properties", {})
        yield from own
        yield from properties([*own.values(), *(each for key, each in schema.items() if key != "properties")])


@pytest.mark.parametrize("kind", [CAM, *folders()])
def test_every_key_of_the_schema_has_a_line_in_the_list_of_all(kind):
    text = recipe_page.PAGE.read_text(encoding="utf-8")
    rows = re.findall(r"^\| (`.*?`) \|", text.partition("<!-- keys -->")[2], re.MULTILINE)
    listed = {path.rpartition(".")[2] for row in rows for path in re.findall(r"`(.*?)`", row)}
    found = reading(kind).table()
    assert set(properties(json_schema(found))) - set(found.keys) - NAMES_OF_THEIR_OWN - listed == set()
