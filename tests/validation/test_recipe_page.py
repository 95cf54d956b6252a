"""The tables of docs/recipe.md against the schema."""

import re

import pytest
import recipe_page

from kin.law.formula.expression import FUNCTIONS
from kin.law.sources.laws import NAMES


@pytest.mark.parametrize("name", recipe_page.tables())
def test_every_table_of_the_schema_stands_on_the_page(name):
    text = recipe_page.page_of(name).read_text(encoding="utf-8")
    shown = re.search(rf"<!-- {re.escape(name)} -->\n(.*?)\n<!-- end -->", text, re.DOTALL)
    assert shown, f"no page has the table {name}"
    assert shown[1] == recipe_page.tables()[name], "python tests/validation/recipe_page.py"


def test_the_page_has_no_table_besides():
    text = recipe_page.PAGE.read_text(encoding="utf-8")
    marks = re.findall(r"^<!-- (?!end)(.*) -->$", text, re.MULTILINE)
    assert sorted(marks) == sorted(
        name for name in recipe_page.tables() if recipe_page.page_of(name) == recipe_page.PAGE
    )


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
        assert {key.split(".")[0] for key in sources.keys() - other.keys()} <= {"repeat", "segments", "units"}, name


def meanings(table):
    """What each key of a table, and of the tables in it, is said to mean."""
    own = {field.name: field.about for field in table.fields}
    return own | {
        f"{path}.{key}": about for path, below in recipe_page.below(table, "") for key, about in meanings(below).items()
    }


def test_the_page_names_every_law_and_function():
    text = recipe_page.PAGE.read_text(encoding="utf-8")
    assert [name for name in NAMES if f"`{name}`" not in text] == []
    functions = re.search(r"the functions `(.*?)`", text, re.DOTALL)
    assert functions
    assert sorted(functions[1].split()) == sorted(FUNCTIONS)
