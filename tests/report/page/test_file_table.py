"""The table of files: a row for each surface, every row as wide as the head."""

from __future__ import annotations

import pytest

from camgeo.report.page.tables import failing_count, file_table

MADE = {
    "path": "c.dxf",
    "bytes": 2048,
    "pieces": 12,
    "kind": "dxf",
    "as": "arcs",
    "tolerance": 0.001,
    "geometry_error": 0.0005,
}
STALE = {"path": "old.stl", "stale": True}


def test_each_row_is_as_wide_as_the_head() -> None:
    surfaces = [
        {"name": name, "measured_error": 2e-4, "motion": {"max": 1e-3, "rms": 2e-4, "unit": "mm"}} for name in "ab"
    ]
    text = file_table({"units": "mm", "files": [MADE, {**MADE, "surfaces": surfaces}, STALE]})
    head, *rows = text[text.index("<table") :].split("<tr>")[1:]
    assert head.count("<th") == 8
    assert [row.count("<th") + row.count("<td") for row in rows] == [8, 8, 8, 8]
    assert [row.count("left as it was") for row in rows] == [0, 0, 0, 1]
    assert "c.dxf</a> a" in rows[1]
    assert "c.dxf</a> b" in rows[2]


def test_no_files() -> None:
    assert file_table({"units": "mm", "files": []}) == "<p>No files were made.</p>"


@pytest.mark.parametrize(
    ("failed", "words"), [(0, "0 checks of 3 fail"), (1, "1 check of 3 fails"), (2, "2 checks of 3 fail")]
)
def test_failed_checks_are_counted(failed: int, words: str) -> None:
    assert failing_count([{"ok": k >= failed} for k in range(3)]) == words
