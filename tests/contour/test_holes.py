"""Distances of openings from those that are meant, and which opening is which."""

from __future__ import annotations

import numpy as np
import pytest

from kin.contour.contour import Contour
from kin.contour.holes import Tally, _piece_by_piece, apart, round_hole, tally

FINE, TOLERANCE = 1e-5, 0.01  # mm
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


def test_distance_sees_what_only_one_side_has() -> None:
    square = np.array([[5, -5], [5, 5], [-5, 5], [-5, -5]], dtype=float)
    notched = np.insert(square, 1, [[5, -0.01], [3, 0.0], [5, 0.01]], axis=0)
    one, two = Contour.from_vertices(square), Contour.from_vertices(notched)
    assert apart(one, two, 1e-4) == pytest.approx(2.0, abs=1e-6)
    assert apart(two, one, 1e-4) == pytest.approx(2.0, abs=1e-6)


def test_openings_are_matched_one_to_one() -> None:
    meant = [round_hole(f"hole {k}", "holes", (4.0 * k, 0.0), 3.0) for k in range(3)]
    contours = [hole.contour for hole in meant]
    tallies: dict[str, Tally] = {}
    tally(tallies, [contours[2], contours[0], contours[1]], meant, TOLERANCE)
    assert tallies["holes"].faults == []
    assert tallies["holes"].worst == pytest.approx(0.0, abs=1e-12)
    tallies = {}
    tally(tallies, [contours[0], contours[0], contours[1]], meant, TOLERANCE)
    assert len(tallies["holes"].faults) == 2  # one is missing, one is there twice
    assert not Tally(worst=0.011).check("holes", TOLERANCE).ok
    assert Tally(worst=0.0099).check("holes", TOLERANCE).ok


def test_chains_are_bounded_piece_by_piece_by_their_starts_and_lengths() -> None:
    """The upper edges begin 4 apart and differ by 5 in length; edges that turn or bend apart add to that."""
    first, second = Contour.from_vertices(SQUARE), Contour.from_vertices(SQUARE * [1.5, 1.0] - [1.0, 0.0])
    assert _piece_by_piece(first.as_arcs()[0], second.as_arcs()[0]) == pytest.approx(9.0)
    assert _piece_by_piece(second.as_arcs()[0], first.as_arcs()[0]) == pytest.approx(9.0)
    triangle = Contour.from_vertices(SQUARE[:3])
    assert _piece_by_piece(first.as_arcs()[0], triangle.as_arcs()[0]) == np.inf
