"""Drawings on paper: the numbers of the PDF's own pages, read back here, are the exact contour. Holds: web.paper."""

from __future__ import annotations

import json
import math
import re
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from support.places import script

import camgeo
from camgeo.recipe.starter import starter

if TYPE_CHECKING:
    from collections.abc import Iterator

live = script("live")
paper = script("paper")
LARGE = starter("disc-roller").replace("base_radius: 36", "base_radius: 170")
MM = 25.4 / 72.0


@pytest.fixture(autouse=True)
def folders(tmp_path: Path) -> Iterator[None]:
    with pytest.MonkeyPatch.context() as patch:  # designs stay shared: what is patched makes none
        for name in ("FOLDER", "OUT"):
            (tmp_path / name).mkdir()
            patch.setattr(live, name, str(tmp_path / name))
        yield


def printed(text: str) -> list[dict[str, Any]]:
    """Pages of the PDF of a recipe: size, closed paths and straight lines of two points, mm on the sheet, and words."""
    answer = json.loads(live.answer("paper", json.dumps({"name": "cam", "text": text})))
    (file,) = answer["files"]
    data = Path(file["path"]).read_bytes()
    start = int(re.search(rb"startxref\n(\d+)\n", data)[1])
    table = data[start:].split(b"\n")
    assert table[0] == b"xref"
    places = [int(row[:10]) for row in table[3 : 2 + int(table[1].split()[1])]]
    for number, place in enumerate(places, 1):
        assert data[place:].startswith(b"%d 0 obj" % number)
    boxes = re.findall(rb"/MediaBox \[0 0 (\S+) (\S+)\]", data)
    streams = re.findall(rb"/Length (\d+) >>\nstream\n(.*?)\nendstream", data, re.DOTALL)
    assert all(int(length) == len(content) for length, content in streams)
    return [
        {"size": [float(side) * MM for side in box], **drawn(content.decode("ascii"))}
        for box, (_, content) in zip(boxes, streams, strict=True)
    ]


def drawn(content: str) -> dict[str, Any]:
    """Closed paths and lines of a content stream, mm on the sheet, by its matrices; cubics in 64 steps."""
    words = re.findall(r"\((?:\\.|[^)\\])*\)", content)
    matrix, kept = np.eye(3), []
    stack: list[str] = []
    points: list[Any] = []
    closed, lines = [], []
    origin = None
    for token in re.sub(r"\((?:\\.|[^)\\])*\)", "", content).split():
        if re.fullmatch(r"[-+]?[\d.]+", token):
            stack.append(token)
            continue
        values = np.array([float(one) for one in stack])
        stack = []
        if token == "q":
            kept.append(matrix)
        elif token == "Q":
            matrix = kept.pop()
        elif token == "cm":
            a, b, c, d, e, f = values
            matrix = np.array([[a, b, 0.0], [c, d, 0.0], [e, f, 1.0]]) @ matrix
            origin = matrix[2, :2] * MM
        elif token in {"m", "l"}:
            points = [*(points if token == "l" else []), values]
        elif token == "c":
            p, q, r, s = points[-1], values[:2], values[2:4], values[4:]
            for t in np.arange(1, 65) / 64:
                u = 1 - t
                points.append(u**3 * p + 3 * u * u * t * q + 3 * u * t * t * r + t**3 * s)
        elif token == "h":
            placed = np.column_stack([np.array(points), np.ones(len(points))]) @ matrix
            closed.append(placed[:, :2] * MM)
        elif token == "S" and len(points) == 2:
            placed = np.column_stack([np.array(points), np.ones(2)]) @ matrix
            lines.append(placed[:, :2] * MM)
            points = []
    return {"paths": closed, "lines": lines, "words": words, "shaft": origin}


def distance(points: Any, path: Any) -> float:
    """Greatest distance of points from a closed polyline."""
    worst = 0.0
    a, b = path, np.roll(path, -1, axis=0)
    step = b - a
    length = np.einsum("ij,ij->i", step, step) + 1e-30
    for point in points:
        share = np.clip(np.einsum("ij,ij->i", point - a, step) / length, 0.0, 1.0)
        worst = max(worst, float(np.hypot(*(a + share[:, None] * step - point).T).min()))
    return worst


@pytest.mark.parametrize("rotation", ["cw", "ccw"])
def test_a_drawing_is_the_exact_contour_in_millimetres_with_a_line_of_fifty(rotation: str) -> None:
    text = starter("disc-roller").replace("rotation: cw", f"rotation: {rotation}")
    assert f"rotation: {rotation}" in text or rotation == "cw"
    (page,) = printed(text)
    design = camgeo.design(camgeo.load(text))
    contour, bore = page["paths"]
    assert distance(design.contour(700) + page["shaft"], contour) < 0.01
    reach = np.hypot(*(bore - page["shaft"]).T)
    assert reach.min() == pytest.approx(5.0, abs=1e-3)
    assert reach.max() == pytest.approx(5.0, abs=1e-3)
    lengths = [float(np.hypot(*(b - a))) for a, b in page["lines"]]
    assert max(lengths) == pytest.approx(50.0, abs=1e-4)
    assert page["size"] == pytest.approx([210.0, 297.0], abs=1e-3)
    assert any("50 mm: measure it" in words for words in page["words"])
    for path in page["paths"]:  # whole on letter too, which is lower by 9 mm at either end
        assert path[:, 0].min() > 5
        assert path[:, 0].max() < 205
        assert path[:, 1].min() > 30
        assert path[:, 1].max() < 280


def test_a_large_one_takes_sheets_whose_marks_lie_upon_each_other() -> None:
    pages = printed(LARGE)
    contour = camgeo.design(camgeo.load(LARGE)).contour(700)
    wide, high = np.ptp(contour, axis=0)
    assert len(pages) == math.ceil((wide - 10) / 180) * math.ceil((high - 10) / 231)
    across = pages[0]["size"][0]
    seen = np.zeros(len(contour), dtype=bool)
    crosses = []
    for page in pages:
        assert distance(contour[::7] + page["shaft"], page["paths"][0]) < 0.01  # each has the whole path, clipped
        placed = contour + page["shaft"]
        seen |= (placed > 10).all(axis=1) & (placed[:, 0] < across - 10) & (placed[:, 1] < page["size"][1] - 20)
        upright = [(a, b) for a, b in page["lines"] if np.hypot(*(b - a)) > 100]
        crosses.append({tuple(np.round(point - page["shaft"], 3)) for line in upright for point in line})
    assert seen.all()
    first, second = crosses[0], crosses[1]
    assert len(first & second) == 2  # the dashed line between them is one line of the drawing
    assert "column 1 of" in pages[0]["words"][1]


def test_what_takes_too_many_sheets_is_refused_with_what_would_do() -> None:
    text = LARGE.replace("base_radius: 170", "base_radius: 1700")
    answer = json.loads(live.answer("paper", json.dumps({"name": "cam", "text": text})))
    told = answer["faults"][0]["told"]
    assert re.search(r"the drawing takes \d+ sheets, and 60 are the most", told)
    assert "take the DXF" in told


def test_each_disc_of_a_pair_has_its_own_sheet() -> None:
    text = starter("disc-conjugate")
    pages = printed(text)
    assert len(pages) == 2
    assert [page["words"][1].split(",")[0] for page in pages] != ["", ""]
    for page, (_, curve) in zip(pages, camgeo.design(camgeo.load(text)).exact.contours, strict=True):
        points = np.vstack([curve.sample(np.linspace(run.low, run.high, 150)).point for run in curve.runs])
        if camgeo.load(text).rotation == "ccw":
            points = points * np.array([1.0, -1.0])
        assert distance(points + page["shaft"], page["paths"][0]) < 0.01


def test_the_ways_up_of_a_sheet_are_chosen_by_their_number() -> None:
    assert [sheet.size for sheet in paper.sheets((0.0, 0.0, 250.0, 160.0))] == [(297.0, 210.0)]
    assert [sheet.size for sheet in paper.sheets((0.0, 0.0, 160.0, 230.0))] == [(210.0, 297.0)]
    for a, b in pairwise(paper.sheets((0.0, 0.0, 189.0, 600.0))):
        assert b.low[1] - a.low[1] == pytest.approx(a.area[1] - 10.0)
