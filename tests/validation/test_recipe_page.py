"""docs/recipe.md against the schema; every YAML block of the pages, and what README.md prints, by the product."""

import re
from dataclasses import replace

import pytest
import recipe_page
from support.cases import few

from camgeo.cli.main import main
from camgeo.output import pipeline
from camgeo.recipe import read
from kin.law.formula.expression import FUNCTIONS
from kin.law.sources.laws import NAMES

PAGES = ("README.md", *(f"docs/{name}.md" for name in ("recipe", "linkages", "manufacture", "mechanism", "sweep")))


def blocks():
    found = []
    for page in PAGES:
        text = (recipe_page.ROOT / page).read_text(encoding="utf-8")
        for match in re.finditer(r"^```yaml\n(.*?)^```", text, re.MULTILINE | re.DOTALL):
            line = text.count("\n", 0, match.start()) + 2
            found.append(pytest.param(match[1], id=f"{page}:{line}"))
    return found


def test_there_are_blocks_on_each_page():
    assert len(blocks()) >= 14
    assert {block.id.split(":")[0] for block in blocks()} == set(PAGES)


@pytest.mark.parametrize("text", few(blocks(), 3))
def test_every_recipe_shown_is_made_and_passes(text):
    recipe = read(text.encode(), "shown.yaml")
    # a verdict at fewer angles is enough here
    recipe = replace(recipe, verify=replace(recipe.verify, angles=360))
    outcome = pipeline.check(recipe)
    assert outcome.ok, [check for check in outcome.report["checks"] if not check["ok"]]


def test_the_readme_prints_what_its_recipe_gives(tmp_path, capsys):
    text = (recipe_page.ROOT / "README.md").read_text(encoding="utf-8")
    recipe, *_ = re.findall(r"^```yaml\n(.*?)^```", text, re.MULTILINE | re.DOTALL)
    (tmp_path / "shu-wu.yaml").write_text(recipe, encoding="utf-8")
    assert main(["check", str(tmp_path / "shu-wu.yaml")]) == 0
    (shown,) = re.findall(r"^```text\n(shu-wu: .*?)^```", text, re.MULTILINE | re.DOTALL)
    assert capsys.readouterr().out == shown


@pytest.mark.parametrize("name", recipe_page.tables())
def test_every_table_of_the_schema_stands_on_the_page(name):
    text = recipe_page.PAGE.read_text(encoding="utf-8")
    shown = re.search(rf"<!-- {re.escape(name)} -->\n(.*?)\n<!-- end -->", text, re.DOTALL)
    assert shown, f"docs/recipe.md has no table {name}"
    assert shown[1] == recipe_page.tables()[name], "python tests/validation/recipe_page.py"


def test_the_page_has_no_table_besides():
    text = recipe_page.PAGE.read_text(encoding="utf-8")
    marks = re.findall(r"^<!-- (?!end)(.*) -->$", text, re.MULTILINE)
    assert sorted(marks) == sorted(recipe_page.tables())


def test_the_page_names_every_law_and_function():
    text = recipe_page.PAGE.read_text(encoding="utf-8")
    assert [name for name in NAMES if f"`{name}`" not in text] == []
    functions = re.search(r"the functions `(.*?)`", text, re.DOTALL)
    assert functions
    assert sorted(functions[1].split()) == sorted(FUNCTIONS)
