"""docs/accuracy.md: every line of it is measured anew, and there is none besides."""

import re

import accuracy
import pytest


@pytest.mark.parametrize("topic", accuracy.TOPICS)
def test_the_page_shows_what_is_measured(topic):
    """The same lines in the same order with the same bounds; figures of rounding differ between machines."""
    rows = accuracy.rows_of(topic)
    assert len(rows) >= 10
    assert [row.line() for row in rows if not row.holds] == []
    lines = accuracy.shown(topic)
    assert [tuple(line[:2]) for line in lines] == [row.key for row in rows]
    for line, row in zip(lines, rows, strict=True):
        shown, measured = line[2:], accuracy.cells(row.line())[2:]
        assert shown[1:] == measured[1:], line
        if isinstance(row.reached, str):
            assert plain(shown[0]) == plain(measured[0])
        else:
            assert float(shown[0]) <= row.most * 1.05, line


def plain(words):
    """Words without their figures."""
    return re.sub(r"-?[0-9.]+(e[-+]?\d+)?", "#", words)


def test_the_page_has_no_table_besides():
    text = accuracy.PAGE.read_text(encoding="utf-8")
    marks = re.findall(r"^<!-- (?!end)(.*) -->$", text, re.MULTILINE)
    assert marks == list(accuracy.TOPICS)
    assert len(re.findall(r"^\| ---", text, re.MULTILINE)) == len(marks)


def test_a_wrong_figure_is_caught():
    row = next(row for row in accuracy.rows_of(accuracy.TOPICS[0]) if not isinstance(row.reached, str))
    spoilt = accuracy.Row(row.case, row.asked, 2.0 * row.most, row.most, row.why)
    assert row.holds
    assert not spoilt.holds
    assert not accuracy.Row("a case", "a file", "nothing was said", "cannot be held", "").holds
