# needs: sheet
"""What is looked for on the pages of a shop drawing: texts by the ink of their letters, lines, and what they cross."""

from __future__ import annotations

import functools
from itertools import combinations
from typing import TYPE_CHECKING, Any

import numpy as np
from fontTools.ttLib import TTFont

from camgeo.capabilities.sheet.lettering import CAPITALS, FONT
from camgeo.capabilities.sheet.marks import CircleMark, Dimension, LineMark

if TYPE_CHECKING:
    from collections.abc import Iterator

    from camgeo.capabilities.sheet.drawing import Pages
    from camgeo.capabilities.sheet.marks import Page, Text

BINDING, EDGE = 20.0, 10.0  # mm: margins of ISO 5457


@functools.cache
def font() -> tuple[Any, Any, Any, float]:
    """Names by letter, outlines and advances of the letters' font, and the height of a capital in its units."""
    read = TTFont(FONT)
    return read.getBestCmap(), read["glyf"], read["hmtx"], CAPITALS * read["head"].unitsPerEm


@functools.cache
def ink(text: str) -> tuple[float, float, float, float]:
    """Least x and y, greatest x and y of the outlines of a text's letters, in heights of a capital, from its start."""
    letters, outlines, advance, em = font()
    x, boxes = 0.0, []
    for letter in text:
        name = letters[ord(letter)]
        glyph = outlines[name]
        if glyph.numberOfContours:
            boxes.append((x + glyph.xMin, glyph.yMin, x + glyph.xMax, glyph.yMax))
        x += advance[name][0]
    found = np.array(boxes or [(0.0, 0.0, 0.0, 0.0)]) / em
    return (*found[:, :2].min(axis=0).tolist(), *found[:, 2:].max(axis=0).tolist())


def ink_box(text: Text) -> tuple[float, float, float, float]:
    """Least x and y, then greatest x and y, mm, of what is printed of a text, from where its box begins."""
    x0, y0, x1, y1 = (text.height * each for each in ink(text.text))
    left, low = text.box[:2]
    if text.turned:
        return text.at[0] - y1, low + x0, text.at[0] - y0, low + x1
    return left + x0, text.at[1] + y0, left + x1, text.at[1] + y1


def overlapping(page: Page) -> Iterator[tuple[str, str]]:
    """Pairs of texts of which one is printed over the other."""
    boxes = [(text.text, ink_box(text)) for text in page.texts]
    for (one, a), (other, b) in combinations(boxes, 2):
        if a[0] < b[2] and b[0] < a[2] and a[1] < b[3] and b[1] < a[3]:
            yield one, other


def strokes(page: Page, *, frame: bool = True) -> np.ndarray:
    """All lines of a page as ends of chords (n, 2, 2): those of dimensions, circles, and arrows among them.

    Without `frame` those of the frame, the title block and the marks beside them are left out.
    """
    chains = []
    for mark in page.marks:
        lines = mark.lines if isinstance(mark, Dimension) else [mark] if isinstance(mark, LineMark) else []
        kept = [line for line in lines if frame or line.layer != "FRAME"]
        chains += [np.vstack([line.points, line.points[:1]]) if line.closed else line.points for line in kept]
        if isinstance(mark, CircleMark) and (frame or mark.layer != "FRAME"):
            turn = np.linspace(0.0, 2.0 * np.pi, 181)
            chains.append(np.array(mark.centre) + mark.radius * np.column_stack([np.cos(turn), np.sin(turn)]))
    return np.concatenate([np.stack([chain[:-1], chain[1:]], axis=1) for chain in chains])


def crossed(page: Page) -> Iterator[str]:
    """Texts through whose letters a line runs."""
    starts, ends = strokes(page).swapaxes(0, 1)
    ways = np.where(ends == starts, 1e-12, ends - starts)
    for text in page.texts:
        box = ink_box(text)
        low, high = np.array(box[:2]) + 0.01, np.array(box[2:]) - 0.01
        both = np.stack([(low - starts) / ways, (high - starts) / ways])
        enters, leaves = both.min(axis=0).max(axis=1), both.max(axis=0).min(axis=1)
        if (np.maximum(enters, 0.0) < np.minimum(leaves, 1.0)).any():
            yield text.text


def demand_clear(pages: Pages) -> None:
    """Every text is legible, over no other one, no line runs through it, and all stands within the frame."""
    for page in pages.all:
        assert page.texts
        assert list(overlapping(page)) == []
        assert list(crossed(page)) == []
        low, high = np.array([BINDING, EDGE]), np.array([page.width - EDGE, page.height - EDGE])
        for text in page.texts:
            box = np.array(ink_box(text)).reshape(2, 2)
            assert text.height >= 2.5
            assert (low < box[0]).all(), text
            assert (box[1] < high).all(), text
        drawn = strokes(page, frame=False).reshape(-1, 2)
        assert (low <= drawn).all()
        assert (drawn <= high).all()
