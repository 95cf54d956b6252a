"""The pages on the three papers: their tables are measured anew, their pictures drawn again."""

from __future__ import annotations

import re
import xml.etree.ElementTree as ET
from dataclasses import replace
from importlib import import_module

import paper_pages
import pytest
from support.page_tables import cells, off
from support.places import ROOT

DOCS = ROOT / "docs"
FIGURES = DOCS / "figures"
SCRIPTS = {"make_constant_breadth": "constant-breadth.md"}  # what draws, and the page that shows it
LARGEST = 60_000  # bytes of a picture
NUMBER = re.compile(r"-?\d+(?:\.\d+)?")
CLOSE = 0.25  # px: coordinates are rounded to a tenth, and letters stand about them


@pytest.mark.parametrize("page", sorted({page for page, _ in paper_pages.TABLES}))
def test_the_tables_of_a_page_are_measured_anew(page: str) -> None:
    marks = [mark for name, mark in paper_pages.TABLES if name == page]
    for mark in marks:
        rows = paper_pages.TABLES[page, mark]()
        assert len(rows) >= 3
        assert [row.line() for row in rows if not row.holds] == []
        assert off(cells(DOCS / page, mark), rows) == [], f"{page}: python tests/docs/paper_pages.py writes it anew"


def test_a_wrong_figure_and_a_wrong_word_of_a_table_are_found() -> None:
    page, mark = "constant-breadth.md", "extremes of the radius of curvature"
    rows, shown = paper_pages.TABLES[page, mark](), cells(DOCS / page, mark)
    assert off(shown, rows) == []
    assert off(shown, [replace(rows[0], ours=rows[0].ours + 1e-4), *rows[1:]]) != []
    assert off(shown, [replace(rows[0], source="SW 25"), *rows[1:]]) != []
    assert off(shown, rows[:-1]) != []


def drawn(text: str) -> list[tuple[str, str, list[float]]]:
    """What a picture holds: of each element its kind with its look, its words, and its numbers in px."""
    found = []
    for element in ET.fromstring(text).iter():
        place = " ".join(element.get(name, "") for name in ("d", "x", "y", "cx", "cy", "r", "dy", "width", "height"))
        look = " ".join(element.get(name, "") for name in ("fill", "stroke", "stroke-dasharray"))
        kind = f"{element.tag.partition('}')[2]} {look} {NUMBER.sub('', place)}"
        found.append((kind, (element.text or "").strip(), [float(number) for number in NUMBER.findall(place)]))
    return found


def differences(one: str, other: str) -> list[str]:
    """Where two pictures are not the same to `CLOSE` px."""
    a, b = drawn(one), drawn(other)
    found = [] if len(a) == len(b) else [f"{len(a)} elements and {len(b)}"]
    for first, second in zip(a, b, strict=False):
        if first[:2] != second[:2] or len(first[2]) != len(second[2]):
            found.append(f"{first[:2]} and {second[:2]}")
        elif any(abs(x - y) > CLOSE for x, y in zip(first[2], second[2], strict=True)):
            found.append(f"{first[:2]}: moved")
    return found


@pytest.mark.parametrize("script", SCRIPTS)
def test_the_pictures_are_what_the_script_draws(script: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(str(DOCS))
    for name, text in import_module(script).figures().items():
        path = FIGURES / f"{name}.svg"
        assert differences(path.read_text(encoding="utf-8"), text) == [], f"python docs/{script}.py draws it anew"
        assert path.stat().st_size < LARGEST
        assert not re.search(r"var\(|<style|\sstyle=|calc\(|vector-effect|paint-order", text)


def test_a_moved_point_and_another_word_are_found() -> None:
    text = (FIGURES / "shu-wu-4.svg").read_text(encoding="utf-8")
    assert differences(text, text) == []
    (x,) = re.findall(r'<circle [^>]*cx="([\d.]+)"', text)[:1]
    assert differences(text, text.replace(f'cx="{x}"', f'cx="{float(x) + 1.0:.1f}"')) != []
    assert differences(text, text.replace("65.721", "65.722")) != []


def test_each_picture_stands_on_its_page() -> None:
    shown = {name for page in SCRIPTS.values() for name in pictures(page)}
    assert shown == {path.name for path in FIGURES.glob("*.svg")}
    assert len(shown) >= 4


def pictures(page: str) -> list[str]:
    """Names of the pictures that a page shows."""
    return re.findall(r"\]\(figures/([^)]*)\)", (DOCS / page).read_text(encoding="utf-8"))


def test_a_page_has_no_table_besides() -> None:
    for page in {page for page, _ in paper_pages.TABLES}:
        text = (DOCS / page).read_text(encoding="utf-8")
        marks = re.findall(r"^<!-- (?!end)(.*) -->$", text, re.MULTILINE)
        assert [mark for mark in marks if (page, mark) in paper_pages.TABLES] == [
            mark for name, mark in paper_pages.TABLES if name == page
        ]
        if page != "validation.md":  # its other tables have tests of their own
            assert len(re.findall(r"^\| ---", text, re.MULTILINE)) == len(marks)
