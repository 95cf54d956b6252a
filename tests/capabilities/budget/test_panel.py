"""The panel of a budget on the page: sums, dimensions and areas, from the report's entry."""

from __future__ import annotations

import re
from typing import Any

import pytest

from camgeo.capabilities.budget.panel import panel

ENTRY: dict[str, Any] = {
    "permitted": 0.05,
    "unit": "mm",
    "sum": "rss",
    "kept": False,
    "worst": {"value": 0.08, "at_deg": 90.0},
    "rss": {"value": 0.06, "at_deg": 91.0},
    "dimensions": [
        {
            "name": "shaft",
            "tolerance": 0.02,
            "unit": "mm",
            "radius": True,
            "influence": 1.5,
            "influence_unit": "mm/mm",
            "share": 0.375,
        }
    ],
    "over_turn": {"at_deg": [0.0, 120.0, 240.0], "worst": {"shaft": [0.01, 0.03, 0.02]}},
}


def cells(page: str) -> list[list[str]]:
    rows = re.findall(r'<tr><th scope="row">(.*?)</tr>', page)
    return [[re.sub("<[^>]+>", "", cell) for cell in re.split("</th>|</td>", row)] for row in rows]


def test_sums_and_dimensions_stand_in_their_rows() -> None:
    page = panel({"budget": ENTRY})
    worst, rss, shaft = cells(page)
    assert (worst[0], worst[1], worst[3]) == ("worst case", "0.08 mm", "–")
    assert (rss[0], rss[1], rss[3]) == ("root sum of squares", "0.06 mm", "≤ 0.05 mm")
    assert shaft[:4] == ["shaft", "radius 0.02 mm", "1.5 mm/mm", "37.5%"]
    assert "What is permitted, 0.05 mm, is not kept by the root sum of squares." in page


def test_the_area_of_a_dimension_closes_over_the_turn() -> None:
    (points,) = re.findall(r'<polygon points="([^"]+)"', panel({"budget": ENTRY}))
    corners = [tuple(map(float, corner.split(","))) for corner in points.split()]
    assert len(corners) == 8
    assert [x for x, _ in corners[:4]] == [44.0, 269.3, 494.7, 720.0]
    first, second, third, last = (198.0 - y for _, y in corners[:4])
    assert (second / first, third / first) == pytest.approx((3.0, 2.0), abs=0.01)
    assert first == last
    assert {y for _, y in corners[4:]} == {198.0}


def test_without_a_budget_there_is_no_panel() -> None:
    assert not panel({})
