"""docs/linkages.md: every table of it is measured anew, every picture is there, and there is none besides."""

import re

import linkage_page
import pytest
from ledger import ROOT


@pytest.fixture(scope="module")
def page():
    return linkage_page.PAGE.read_text(encoding="utf-8")


@pytest.mark.slow
@pytest.mark.parametrize(
    "mark", [pytest.param(mark, marks=pytest.mark.slow if mark == "files" else []) for mark in linkage_page.TABLES]
)
def test_every_table_of_the_page_is_measured_anew(workshop, page, mark):
    """Cells are the same, numbers within one unit of the last digit shown."""
    shown = linkage_page.cells(page, mark)
    found = linkage_page.TABLES[mark](workshop)
    assert [line[0] for line in shown] == [line[0] for line in found]
    for line, anew in zip(shown, found, strict=True):
        assert len(line) == len(anew)
        slack = linkage_page.SLACK.get(mark, (0.0,) * len(line))
        for cell, other, allowed in zip(line, anew, slack, strict=True):
            assert linkage_page.same(cell, other, allowed), (line[0], cell, other)


@pytest.mark.slow
@pytest.mark.parametrize("name", [*linkage_page.PAPER, *linkage_page.OURS])
def test_every_shipped_linkage_is_within_its_limits(workshop, name):
    """And by no luck: the limit of the output's error is not more than thrice what is reached."""
    made = workshop.shipped(name)
    linkage = made.report["linkage"]
    assert made.report["ok"]
    assert 0 < linkage["error"]["max"] <= linkage["error"]["limit"] < 3 * linkage["error"]["max"]
    e = made.recipe.export.tolerance / made.recipe.mm
    for file in linkage["files"]:
        for backlash in (file["backlash_across"], file["backlash_along"]):
            assert -2 * e * (1 + 1e-9) <= backlash["min"] <= backlash["max"] <= 2 * e * (1 + 1e-9)


def test_the_page_has_no_table_besides(page):
    marks = re.findall(r"^<!-- (?!end)(.*) -->$", page, re.MULTILINE)
    assert marks == list(linkage_page.TABLES)
    assert len(re.findall(r"^\| ---", page, re.MULTILINE)) == len(marks)


def test_a_wrong_cell_is_caught():
    assert linkage_page.same("45.17", "45.18")
    assert not linkage_page.same("45.17", "45.19")
    assert linkage_page.same("45.17", "45.19", 0.02)
    assert not linkage_page.same("45.17", "45.20", 0.02)
    assert not linkage_page.same("45.17", "-45.17")
    assert linkage_page.same("269.01 to 314.18", "269.01 to 314.19")
    assert not linkage_page.same("269.01 to 314.18", "269.01 to 314.28")
    assert not linkage_page.same("as-figure-8", "as-figure-9")


def test_the_pages_pictures_are_there_and_small(page):
    shown = re.findall(r"\]\((pictures/linkage-[^)]*)\)", page)
    there = sorted(f"pictures/{path.name}" for path in (ROOT / "docs" / "pictures").glob("linkage-*"))
    assert sorted(shown) == there
    assert len(shown) >= 7
    assert all((ROOT / "docs" / name).stat().st_size < 120_000 for name in shown)
