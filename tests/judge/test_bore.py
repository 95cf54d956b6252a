"""Round openings about the shaft: how far one is off in place, size and roundness, by hand."""

from __future__ import annotations

import math

import numpy as np
import pytest

from kin.contour.contour import Contour
from kin.contour.holes import round_hole
from kin.judge.bore import bore_check, round_check


def circle(x: float, diameter: float) -> Contour:
    return round_hole("bore", "bore", (x, 0.0), diameter).contour


def polygon(count: int, radius: float) -> Contour:
    t = np.arange(count) * (2.0 * np.pi / count)
    return Contour.from_vertices(radius * np.column_stack([np.cos(t), np.sin(t)]))


@pytest.mark.parametrize(("x", "diameter", "off"), [(0.01, 20.0, 0.01), (0.0, 20.03, 0.015), (0.01, 19.97, 0.025)])
def test_a_circle_is_off_by_its_place_and_half_its_diameter(x: float, diameter: float, off: float) -> None:
    assert round_check("bore", circle(x, diameter), 20.0, 1.0).value == pytest.approx(off, abs=1e-12)


def test_the_middle_of_an_edge_lies_within_the_circle_through_its_ends() -> None:
    check = round_check("bore", polygon(60, 10.0), 20.0, 0.01)
    assert check.value == pytest.approx(10.0 * (1.0 - math.cos(math.pi / 60.0)), abs=1e-12)
    assert not check.ok


def test_one_hole_is_due_where_a_bore_is_and_none_elsewhere() -> None:
    bore, hole = circle(0.0, 20.0), circle(30.0, 5.0)
    assert bore_check([], None, 0.01) is None
    for holes, diameter in (([bore], None), ([], 20.0), ([bore, hole], 20.0)):
        check = bore_check(holes, diameter, 0.01)
        assert check is not None
        assert not check.ok
    sound = bore_check([bore, hole], 20.0, 0.01, closed=False)
    assert sound is not None
    assert sound.ok
