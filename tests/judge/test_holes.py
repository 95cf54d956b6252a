"""Distances of openings from those that are meant, and which opening is which."""

from __future__ import annotations

import numpy as np
import pytest

from kin.contour.contour import Contour
from kin.judge.holes import Tally, apart, round_hole, tally

FINE = 1e-5
SQUARE = np.array([[0.0, 0.0], [10.0, 0.0], [10.0, 10.0], [0.0, 10.0]])


def circle(x: float, y: float, radius: float) -> Contour:
    return round_hole("hole", "holes", (x, y), 2.0 * radius).contour


@pytest.mark.parametrize("off", [1e-7, 1e-3, 0.5])
def test_circles_are_apart_by_centres_and_radii(off: float) -> None:
    assert apart(circle(off, 0.0, 4.0), circle(0.0, 0.0, 4.0), FINE) == pytest.approx(off, abs=FINE)
    assert apart(circle(0.0, 0.0, 4.0 + off), circle(0.0, 0.0, 4.0), FINE) == pytest.approx(off, abs=FINE)


@pytest.mark.parametrize("bulge", [1e-7, 1e-3, -0.2])
def test_an_edge_that_bulges_between_right_corners_is_apart_by_its_height(bulge: float) -> None:
    straight, bulges = np.zeros(4), np.array([0.0, bulge, 0.0, 0.0])
    bent = Contour.from_bulges(SQUARE, bulges)
    assert apart(bent, Contour.from_bulges(SQUARE, straight), FINE) == pytest.approx(5.0 * abs(bulge), abs=FINE)


def test_other_starts_and_numbers_of_pieces_make_no_distance() -> None:
    plain = Contour.from_bulges(SQUARE, np.zeros(4))
    middles = 0.5 * (SQUARE + np.roll(SQUARE, -1, axis=0))
    halved = Contour.from_bulges(np.stack([SQUARE, middles], axis=1).reshape(-1, 2), np.zeros(8))
    shifted = Contour.from_bulges(np.roll(SQUARE, 1, axis=0), np.zeros(4))
    assert apart(plain, halved, FINE) == pytest.approx(0.0, abs=1e-14)
    assert apart(plain, shifted, FINE) == pytest.approx(0.0, abs=1e-14)


def test_a_hole_that_is_missing_and_one_too_many_are_named_at_their_places() -> None:
    tallies: dict[str, Tally] = {}
    meant = [round_hole("hole 1", "holes", (20.0, 0.0), 6.0), round_hole("hole 2", "holes", (-20.0, 0.0), 6.0)]
    tally(tallies, [circle(20.0, 2e-4, 3.0), circle(0.0, 20.0, 3.0)], meant, 1e-3)
    check = tallies["holes"].check("holes", 1e-3)
    assert not check.ok
    assert "hole 2 at (-20, 0) is missing" in check.detail
    assert "about (0, 20), where none is expected" in check.detail
    assert tallies["holes"].worst == pytest.approx(2e-4, abs=FINE)
