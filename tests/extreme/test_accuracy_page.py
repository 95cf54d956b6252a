"""docs/accuracy.md as a whole; the tests of each topic hold its lines, case by case."""

import re

import accuracy
import pytest


@pytest.mark.slow
@pytest.mark.parametrize("topic", accuracy.TOPICS)
def test_the_page_shows_what_is_measured_and_nothing_besides(topic):
    rows = accuracy.rows_of(topic)
    assert len(rows) >= 10
    assert [tuple(line[:2]) for line in accuracy.shown(topic)] == [row.key for row in rows]


def test_the_page_has_no_table_besides():
    text = accuracy.PAGE.read_text(encoding="utf-8")
    marks = re.findall(r"^<!-- (?!end)(.*) -->$", text, re.MULTILINE)
    # the corpus of tables measures and writes its own
    assert marks == [*accuracy.TOPICS, "tables by step and decimals"]
    assert len(re.findall(r"^\| ---", text, re.MULTILINE)) == len(marks) + 2  # the corpus has three tables


def test_a_wrong_figure_is_caught():
    row = accuracy.Row("a case", "a file", 0.9e-15, 1e-15, "rounding")
    spoilt = accuracy.Row(row.case, row.asked, 2.0 * row.most, row.most, row.why)
    assert row.holds
    assert not spoilt.holds
    assert not accuracy.Row("a case", "a file", "nothing was said", "cannot be held", "").holds
