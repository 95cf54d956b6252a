"""Diameters that keep walls which are too thin, by hand: whose opening is made smaller, by how much, and when none is.

Holds: camgeo.part.checks.
"""

from __future__ import annotations

from types import SimpleNamespace

import pytest

from camgeo.part.checks import _free_of_thin_walls, thinnest
from camgeo.part.walls import Gap, Pair, Possible

LIMIT = 2.0
BORE = SimpleNamespace(name="bore", circle=((0.0, 0.0), 8.0), radius=8.0)
HOLES = [SimpleNamespace(name=f"bolt hole {k}", circle=((20.0 + 9.0 * k, 0.0), 3.0), radius=3.0) for k in (1, 2)]
DOWEL = SimpleNamespace(name="dowel", circle=((0.0, 20.0), 2.0), radius=2.0)
SQUARE = SimpleNamespace(name="slot", circle=None, radius=9.0)
HUB = SimpleNamespace(name="hub", diameter=24.0)


def told(*walls: tuple[str, str, float], boss: SimpleNamespace | None = None, bore: bool = True) -> str:
    """Remedy for walls between edges of these names, of which 2 mm are asked."""
    body = SimpleNamespace(openings=[*([BORE] if bore else []), *HOLES, DOWEL, SQUARE], boss=boss)
    return _free_of_thin_walls([Pair(one, other, Gap(wall, (0.0, 0.0))) for one, other, wall in walls], body, LIMIT)


@pytest.mark.parametrize(
    ("walls", "remedy"),
    [
        # a wall lacks 2 - 0.5 on one side of a hole, or on one side of each of two of one size
        ([("contour", "bolt hole 1", 0.5)], "; a part.bolts.hole below 3 mm would do"),
        ([("bolt hole 1", "bolt hole 2", 0.5)], "; a part.bolts.hole below 4.5 mm would do"),
        # the later of two keys gives way, and a shape with corners not at all
        ([("bore", "bolt hole 1", 1.0)], "; a part.bolts.hole below 4 mm would do"),
        ([("dowel", "bolt hole 1", 1.75)], "; a part.dowel.hole below 3.5 mm would do"),
        ([("contour", "bore", 1.0)], "; a part.bore below 14 mm would do"),
        ([("slot", "bore", 1.0)], "; a part.bore below 14 mm would do"),
        # of several walls of one size the thinnest decides; of several sizes each is named
        ([("contour", "bolt hole 1", 1.5), ("contour", "bolt hole 2", 0.5)], "; a part.bolts.hole below 3 mm would do"),
        ([("contour", "bolt hole 1", 0.5), ("contour", "bolt hole 2", 1.5)], "; a part.bolts.hole below 3 mm would do"),
        (
            [("contour", "bolt hole 1", 1.0), ("contour", "dowel", 1.5)],
            "; a part.bolts.hole below 4 mm and a part.dowel.hole below 3 mm would do",
        ),
        # a ring's outline moves out, by the most that is lacking
        (
            [("inner opening", "outline", 0.5), ("outer opening", "outline", 1.0), ("contour", "dowel", 1.5)],
            "; a part.dowel.hole below 3 mm and a part.outer larger by more than 3 mm would do",
        ),
        ([("dowel", "outline", 1.5)], "; a part.dowel.hole below 3 mm would do"),
        # nothing is left of a hole, a hole and corners overlap by no diameter, another edge would have to move
        ([("contour", "dowel", 0.0)], ""),
        ([("slot", "bore", -0.5)], ""),
        ([("contour", "slot", 1.0)], ""),
        ([("contour", "bore", -0.5)], "; a part.bore below 11 mm would do"),
        ([("slot", "bore", 0.0)], "; a part.bore below 12 mm would do"),
    ],
)
def test_whose_diameter_gives_way(walls: list[tuple[str, str, float]], remedy: str) -> None:
    assert told(*walls) == remedy


def test_no_diameter_parts_a_hole_from_one_about_its_middle() -> None:
    """Circles of 6 and 4 mm, 1 or 2.9 mm apart: however small, a dowel lies in the hole; at 4 mm not."""
    hole = SimpleNamespace(name="bolt hole 1", circle=((0.0, 0.0), 3.0), radius=3.0)
    for apart, remedy in ((1.0, ""), (2.9, ""), (4.0, "; a part.dowel.hole below 2 mm would do")):
        dowel = SimpleNamespace(name="dowel", circle=((apart, 0.0), 2.0), radius=2.0)
        body = SimpleNamespace(openings=[hole, dowel], boss=None)
        pair = Pair("dowel", "bolt hole 1", Gap(apart - 5.0, (0.0, 0.0)))
        assert _free_of_thin_walls([pair], body, 0.0) == remedy


def test_a_hub_gives_way_to_the_contour_and_openings_to_the_hub() -> None:
    """It keeps its wall round the bore of 16 mm."""
    assert told(("contour", "hub", 1.0), boss=HUB) == "; a part.hub.diameter below 22 mm would do"
    assert told(("hub", "bolt hole 1", 1.0), boss=HUB) == "; a part.bolts.hole below 4 mm would do"
    assert told(("hub", "bore", 1.0), boss=HUB) == "; a part.bore below 14 mm would do"
    assert told(("contour", "hub", -1.9), boss=HUB) == "; a part.hub.diameter below 16.2 mm would do"
    assert told(("contour", "hub", -2.0), boss=HUB) == ""
    assert told(("contour", "hub", -2.0), boss=HUB, bore=False) == "; a part.hub.diameter below 16 mm would do"


def test_walls_are_found_thinnest_first_and_only_as_far_as_they_count() -> None:
    made: list[str] = []

    def possible(name: str, at_least: float, wall: float) -> Possible:
        def pair() -> Pair:
            made.append(name)
            return Pair(name, "contour", Gap(wall, (0.0, 0.0)))

        return Possible(at_least, pair)

    walls = [
        possible("far", 9.0, 9.5),
        possible("thin", 1.0, 1.5),
        possible("thinner", 1.2, 1.3),
        possible("wide", 1.1, 6.0),
    ]
    assert [pair.one for pair in thinnest(walls, 2.0)] == ["thinner", "thin"]
    assert made == ["thin", "wide", "thinner"]
    assert [pair.one for pair in thinnest(walls, 0.0)] == ["thinner"]
    assert [pair.one for pair in thinnest(walls[:1], 0.0)] == ["far"]
    assert thinnest([], 2.0) == []
