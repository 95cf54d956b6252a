"""The pages on the three papers: their tables are measured anew, their pictures drawn again."""

from __future__ import annotations

import re
import xml.etree.ElementTree as ET
from dataclasses import replace
from functools import cache
from importlib import import_module

import numpy as np
import paper_pages
import pytest
from support.page_tables import PaperRow, Row, cells, off
from support.places import ROOT

import camgeo
from camgeo.api.design import Design

DOCS = ROOT / "docs"
FIGURES = DOCS / "figures"
# what draws, and the page that shows it
SCRIPTS = {
    "make_camshafts": "camshafts.md",  # needs: camshaft
    "make_constant_breadth": "constant-breadth.md",
    "make_cylindrical_picture": "cylindrical.md",  # needs: cylindrical
    "make_indexing_picture": "indexing.md",  # needs: indexing
    "make_double_roller": "double-roller.md",
    "make_laws": "double-roller.md",
    "make_yoke_pictures": "linkages.md",
}
WORDS = {"double-roller.md": 1}  # tables without figures
NINE = [str(k) for k in range(1, 10)]


def numbered(section: str, count: int) -> list[str]:
    """Numbers of a section's equations."""
    return [f"{section}.{k}" for k in range(1, count + 1)]


@cache
def measured(page: str, mark: str) -> list[Row]:
    """Rows of a table, measured once."""
    return paper_pages.TABLES[page, mark]()


# numbers of each paper's equations, and of its figures
EQUATIONS = {
    "paper AS": (
        [str(k) for k in range(1, 35)],
        ["1", "2a", "2b", "2c", "2d", *(str(k) for k in range(3, 16))],
    ),
    "paper SW": ([str(k) for k in range(1, 33)], ["1", "2a", "2b", "2c", "2d", "3", "4"]),
    "paper W": (numbered("2", 2) + numbered("4", 10) + numbered("5", 11) + numbered("6", 5) + numbered("7", 2), NINE),
}
LARGEST = 60_000  # bytes of a picture
NUMBER = re.compile(r"-?\d+(?:\.\d+)?")
CLOSE = 0.25  # px: coordinates are rounded to a tenth, and letters stand about them


@pytest.mark.slow
@pytest.mark.parametrize("page", sorted({page for page, _ in paper_pages.TABLES}))
def test_the_tables_of_a_page_are_measured_anew(page: str) -> None:
    marks = [mark for name, mark in paper_pages.TABLES if name == page]
    for mark in marks:
        rows = measured(page, mark)
        assert len(rows) >= 3
        assert [row.line() for row in rows if not row.holds] == []
        assert off(cells(DOCS / page, mark), rows) == [], f"{page}: python tests/docs/paper_pages.py writes it anew"


@pytest.mark.slow  # of this file itself
def test_a_wrong_figure_and_a_wrong_word_of_a_table_are_found() -> None:
    page, mark = "constant-breadth.md", "extremes of the radius of curvature"
    rows, shown = measured(page, mark), cells(DOCS / page, mark)
    assert off(shown, rows) == []
    assert off(shown, [replace(rows[0], ours=rows[0].ours + 1e-4), *rows[1:]]) != []
    assert off(shown, [replace(rows[0], source="SW 25"), *rows[1:]]) != []
    assert off(shown, rows[:-1]) != []


def test_a_spoilt_motion_is_found_by_the_rows_of_its_equations(monkeypatch: pytest.MonkeyPatch) -> None:
    sound = Design.motion

    def spoilt(self, theta, *, derivative=0):
        """A ten-thousandth of a millimetre, twice a turn."""
        wave = np.sin(2 * np.asarray(theta) + derivative * np.pi / 2)
        return sound(self, theta, derivative=derivative) + 1e-4 * 2**derivative * wave

    monkeypatch.setattr(Design, "motion", spoilt)
    failed = {row.source for row in paper_pages.TABLES["validation.md", "paper SW"]() if not row.holds}
    assert failed >= {"Figure 3", "Figure 4", "2", "3", "4, 5, 6", "9", "10", "11, 12, 13, 14", "15, 16, 17", "31, 32"}
    assert "1" not in failed  # the contour's own breadth is none of it


@pytest.mark.slow
@pytest.mark.parametrize("paper", EQUATIONS)
def test_every_equation_and_every_figure_of_a_paper_has_a_row(paper: str) -> None:
    rows = measured("validation.md", paper)
    named = [name.strip() for row in rows for name in row.source.removeprefix("Figure ").split(",")]
    equations, figures = EQUATIONS[paper]
    there = {row.source for row in rows}
    assert [name for name in equations if name not in named] == []
    assert [name for name in figures if f"Figure {name}" not in there] == []
    for row in rows:
        assert isinstance(row, PaperRow)
        assert all((row.source, row.quantity, row.recipe, row.place, row.published, row.shown, row.differs))
        assert "not yet" not in row.shown, row.line()


def test_what_excludes_a_ratio_or_a_swing_is_said() -> None:
    cam = "cam: {{kind: double-roller, ratio: {}, arm: 60, roller_radius: 8, delta: {{cos: {{1: {}}}}}}}\n"
    for ratio, wave, word in (("5/2", 100, "odd"), ("4/3", 3601, "l^2")):
        with pytest.raises(camgeo.CamgeoError, match=re.escape(word)):
            camgeo.design(camgeo.load(cam.format(ratio, wave)))


def test_a_swing_over_the_shaft_needs_a_frame_that_alone_places_the_output() -> None:
    """Of the inverted slider-crank and the oscillating yoke: the others tie S to S1."""
    cam = (
        "cam: {{kind: constant-breadth, base_radius: 40, swing: [{{rise: 20, over: 140, law: modified-sine}}, "
        "{{dwell: 60}}]}}\nlinkage: {}\n"
    )
    design = camgeo.design(camgeo.load(cam.format("{kind: inverted-slider-crank, ground: 80, rocker: 0}")))
    assert design.unit == "rad"
    assert np.ptp(design.motion(np.linspace(0.0, 6.28, 100))) == pytest.approx(np.radians(20.0), abs=1e-3)
    for linkage in ("{kind: four-bar, ground: 80, coupler: 70, rocker: 105}", "{kind: slider-crank, coupler: 90}"):
        with pytest.raises(camgeo.RecipeErrors, match="inverted-slider-crank"):
            camgeo.load(cam.format(linkage))


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


@pytest.mark.slow
@pytest.mark.parametrize("script", SCRIPTS)
def test_the_pictures_are_what_the_script_draws(script: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(str(ROOT / "tools" / "docs"))
    for name, text in import_module(script).figures().items():
        path = FIGURES / f"{name}.svg"
        assert differences(path.read_text(encoding="utf-8"), text) == [], f"python tools/docs/{script}.py draws it anew"
        assert path.stat().st_size < LARGEST
        assert not re.search(r"var\(|<style|\sstyle=|calc\(|vector-effect|paint-order", text)


def test_a_moved_point_and_another_word_are_found() -> None:
    text = (FIGURES / "shu-wu-4.svg").read_text(encoding="utf-8")
    assert differences(text, text) == []
    (x,) = re.findall(r'<circle [^>]*cx="([\d.]+)"', text)[:1]
    assert differences(text, text.replace(f'cx="{x}"', f'cx="{float(x) + 1.0:.1f}"')) != []
    assert differences(text, text.replace("65.721", "65.722")) != []


# needs: camshaft
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
            assert len(re.findall(r"^\| ---", text, re.MULTILINE)) == len(marks) + WORDS.get(page, 0)
