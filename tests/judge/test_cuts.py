"""Cuts of a milling program: circles and stadiums about known places, of known areas, milled in known orders."""

from __future__ import annotations

import itertools
import math
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from kin.judge.cuts import Cut, at_the_floor, cuts_of, features_of, rounds
from kin.judge.intent import Milling
from kin.read.errors import ReadError
from kin.read.gcode import Program, ToolMove

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kin.judge.cuts import Feature

PLACE = Path("c.ngc")


def move(
    start: Sequence[float],
    end: Sequence[float],
    sweep: float = 0.0,
    centre: tuple[float, float] | None = None,
    *,
    rapid: bool = False,
) -> ToolMove:
    (x, y, z), (to_x, to_y, to_z) = start, end
    return ToolMove(1, rapid, (x, y, z), (to_x, to_y, to_z), sweep, centre, 0.0 if rapid else 100.0, turning=True)


def round_loop(radius: float, middle: tuple[float, float] = (0.0, 0.0), sense: int = 1, z: float = -1.0) -> Cut:
    """A circle in two half turns, counter-clockwise for the sense 1."""
    x, y = middle
    right, left = (x + radius, y, z), (x - radius, y, z)
    half = sense * math.pi
    return Cut(z, [], [move(right, left, half, middle), move(left, right, half, middle)], [])


def milled(cuts: list[Cut], milling: Milling) -> list[Feature]:
    return list(features_of(Program(PLACE, (), 1.0, ()), cuts, milling, 1e-3))


@given(st.floats(0.5, 20.0), st.floats(0.5, 20.0), st.sampled_from((1, -1)), st.floats(-9.0, 9.0), st.floats(-9.0, 9.0))
def test_the_area_of_a_stadium(radius: float, length: float, sense: int, x: float, y: float) -> None:
    """Two lines and two half turns: a rectangle and a disc, wherever it lies."""
    below, above = y - radius, y + radius
    corners = [(x, below, -1.0), (x + length, below, -1.0), (x + length, above, -1.0), (x, above, -1.0)]
    loop = [
        move(corners[0], corners[1]),
        move(corners[1], corners[2], math.pi, (x + length, y)),
        move(corners[2], corners[3]),
        move(corners[3], corners[0], math.pi, (x, y)),
    ]
    if sense < 0:
        loop = [move(each.end, each.start, -each.sweep, each.centre) for each in reversed(loop)]
    cut = Cut(-1.0, [], loop, [])
    assert cut.area == pytest.approx(sense * (2.0 * radius * length + math.pi * radius**2), rel=1e-12)
    inside = np.array([x + 0.5 * length, y])
    assert rounds(cut.path, inside) == sense
    assert rounds(cut.path, np.array([x + 0.5 * length, y + 3.0 * radius])) == 0


def test_cuts_lie_between_plunge_and_retract() -> None:
    """A way in, a square, a way out, at two depths, after a move above the stock and before one."""
    square = [(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0), (0.0, 0.0)]
    way = [(-2.0, -1.0), (-1.0, 0.0), *square, (1.0, -1.0)]
    moves = [move((9.0, 9.0, 5.0), (*way[0], 5.0), rapid=True)]
    for depth in (-1.0, -2.5):
        moves.append(move((*way[0], 5.0), (*way[0], depth)))
        moves += [move((*a, depth), (*b, depth)) for a, b in itertools.pairwise(way)]
        moves += [move((*way[-1], depth), (*way[-1], 5.0), rapid=True)]
        moves += [move((*way[-1], 5.0), (*way[0], 5.0))]
    upper, lower = cuts_of(Program(PLACE, tuple(moves), 1.0, ()))
    for cut, depth in ((upper, -1.0), (lower, -2.5)):
        assert cut.z == depth
        assert [len(part) for part in (cut.entry, cut.loop, cut.exit)] == [2, 4, 1]
        assert cut.area == 16.0
    assert upper.key == lower.key
    begun_elsewhere = Cut(-1.0, [], upper.loop[2:] + upper.loop[:2], [])
    assert begun_elsewhere.key == upper.key
    assert round_loop(2.0).key != round_loop(2.0, sense=-1).key


@pytest.mark.parametrize(
    ("path", "fault"),
    [
        ([(0, 0, 5), (0, 0, -1), (3, 0, -2), (0, 0, -2)], "cuts along a slope"),
        ([(0, 0, 5), (3, 0, -1), (0, 0, -1)], "cuts along a slope"),
        ([(0, 0, 5), (0, 0, -1), (0, 0, 5)], "goes down where nothing is cut"),
        ([(0, 0, 5), (0, 0, -1), (3, 0, -1), (3, 3, -1), (0, 0, 5)], "cuts along a slope"),
        ([(0, 0, 5), (0, 0, -1), (3, 0, -1), (3, 3, -1), (3, 3, 5)], "does not close"),
    ],
)
def test_what_is_no_cut_is_refused(path: list[tuple[float, float, float]], fault: str) -> None:
    moves = tuple(move(a, b) for a, b in itertools.pairwise(path))
    with pytest.raises(ReadError, match=fault):
        list(cuts_of(Program(PLACE, moves, 1.0, ())))


@given(st.permutations(range(4)), st.lists(st.sampled_from((1, -1)), min_size=4, max_size=4))
def test_a_pocket_is_what_lies_side_by_side_from_the_outermost_inward(order: list[int], senses: list[int]) -> None:
    """Circles about the shaft at 30, 26.1, 22.2 mm, a cutter of 2 mm apart; that at 18 is 4.2 mm from the next."""
    radii = (30.0, 26.1, 22.2, 18.0)
    drawn = [round_loop(radius, sense=sense) for radius, sense in zip(radii, senses, strict=True)]
    aside = round_loop(3.0, (40.0, 0.0))  # round no shaft
    pocket, *others = milled([aside, *(drawn[k] for k in order)], Milling(2.0, 12.0, 5.0, outline=False, pocket=5.0))
    assert pocket.depth == 5.0
    assert pocket.cuts == [drawn[k] for k in order if k < 3]
    inner, outer = pocket.edges
    # the metal stands inside the inner edge and outside the outer one
    assert (inner.side, inner.cut, outer.side, outer.cut) == (1, drawn[2], -1, drawn[0])
    assert inner.contour.area == pytest.approx(math.pi * 20.2**2, rel=1e-12)
    assert outer.contour.area == pytest.approx(math.pi * 32.0**2, rel=1e-12)
    assert [(feature.depth, feature.cuts) for feature in others] == [(12.0, [aside]), (12.0, [drawn[3]])]


@pytest.mark.parametrize("sense", [1, -1])
@pytest.mark.parametrize("outline", [True, False])
def test_the_longest_path_is_the_outline_and_the_others_are_holes(sense: int, outline: bool) -> None:
    """A rough path 1.5 mm outside goes with the last one; one 2.1 mm outside would be of another contour."""
    hole = round_loop(3.0, (9.0, 0.0), -sense)
    rough, last, far = (round_loop(radius, sense=sense) for radius in (21.5, 20.0, 23.6))
    features = milled([hole, far, rough, last], Milling(2.0, 6.0, 3.0, outline=outline))
    assert [feature.cuts for feature in features] == [[hole], [far], [rough, last]]
    assert [feature.depth for feature in features] == [6.0, 6.0, 6.0]
    radii = [math.sqrt(feature.edges[0].contour.area / math.pi) for feature in features]
    assert radii == pytest.approx([5.0, 21.6 if outline else 25.6, 22.0], rel=1e-12)
    assert [feature.edges[0].side for feature in features] == [-1, 1 if outline else -1, -1]
    assert [len(feature.edges) for feature in features] == [1, 1, 1]


def test_the_floor_is_what_lies_deepest() -> None:
    outer, again = (round_loop(9.0, sense=-1, z=z) for z in (-4.0, -3.995))
    above, inner = round_loop(7.0), round_loop(5.0, z=-3.99)
    assert at_the_floor([outer, above, inner, again], 0.011) == [inner, again]
    assert at_the_floor([outer, above, inner, again], 0.006) == [again]
    assert at_the_floor([again, above, inner, outer], 0.004) == [outer]
