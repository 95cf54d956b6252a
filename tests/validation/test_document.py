"""docs/validation.md: every line of it is measured anew, and there is none besides."""

import re

import ledger
import pytest
from support.page_tables import Row

LONG = (  # seconds each
    "test_wunderlich",
    "test_linkages",
    "test_support_functions",
    "test_indexing",  # needs: indexing
)


@pytest.mark.thin(3)
@pytest.mark.parametrize(
    "topic", [pytest.param(topic, marks=pytest.mark.slow if topic in LONG else ()) for topic in ledger.TOPICS]
)
def test_published_values_hold_and_the_page_shows_them(workshop, topic):
    """The same lines in the same order, our figures within what each may differ by or half its last digit."""
    measured, lines = ledger.measured(topic, workshop), ledger.shown(topic)
    assert len(measured) >= 4
    assert [row.line() for row in measured if not row.holds] == []
    assert [tuple(line[:3]) for line in lines] == [row.key for row in measured]
    for line, row in zip(lines, measured, strict=True):
        digit = abs(float(f"{row.ours:{row.form}}") - row.ours) + 1e-9 * abs(row.ours)
        assert float(line[3]) == pytest.approx(row.ours, abs=row.within + digit), line
        assert float(line[4].lstrip("< ")) <= max(row.within, 2e-9 * max(1.0, abs(row.value))), line


@pytest.mark.slow
def test_the_page_shows_what_is_misprinted(workshop):
    lines = ledger.shown("misprints")
    found = ledger.misprints(workshop)
    assert [line[:4] for line in lines] == [[one.where, one.printed, one.right, one.measured] for one in found]
    assert [float(line[4]) for line in lines] == pytest.approx([one.off[0] for one in found], rel=0.01)


def test_the_page_has_no_table_besides():
    text = ledger.PAGE.read_text(encoding="utf-8")
    marks = re.findall(r"^<!-- (?!end|needs)(.*) -->$", text, re.MULTILINE)
    papers = [mark for mark in marks if mark.startswith("paper ")]  # tests/docs/test_papers.py measures these
    assert marks == [*ledger.TOPICS, "misprints", *papers]
    assert len(re.findall(r"^\| ---", text, re.MULTILINE)) == len(marks)


@pytest.mark.slow
def test_a_wrong_figure_is_caught(workshop):
    row = ledger.measured("test_rabinowitz", workshop)[2]
    spoilt = Row(row.quantity, row.source, row.published, row.value, row.ours + 2 * row.within, row.within)
    assert row.holds
    assert not spoilt.holds
