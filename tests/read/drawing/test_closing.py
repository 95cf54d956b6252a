"""Pieces whose ends do not quite meet: where they are made to, and what becomes of arcs, curves and short pieces."""

import math

import numpy as np
import pytest

from kin.contour.bezier import Beziers
from kin.contour.contour import Contour
from kin.contour.pieces import ARC, LINE, Pieces
from kin.follower.measured import positions
from kin.law.contacts import Contact, Roller, Translating
from kin.read.drawing.closing import closed_up

SAME, USUAL = 1e-9, 1e-6


def bows(off: float, count: int = 60, seed: int = 2) -> Pieces:
    """Arcs round (3, 0) of radius 20, each with a centre and a radius that are off by up to `off`, mm."""
    rng = np.random.default_rng(seed)
    centre = np.array([3.0, 0.0]) + rng.uniform(-off, off, (count, 2))
    angle = 2.0 * np.pi * np.arange(count) / count
    return Pieces.from_arcs(centre, 20.0 + rng.uniform(-off, off, count), angle, np.full(count, 2.0 * np.pi / count))


@pytest.mark.parametrize("off", [1e-7, 1e-5, 1e-3])
def test_arcs_meet_and_a_roller_runs_over_their_joints(off: float) -> None:
    """They overshoot as often as they fall short: a line back would turn the contour round."""
    pieces = closed_up(bows(off), SAME, USUAL)
    assert len(pieces) == 60
    assert np.array_equal(pieces.end, np.roll(pieces.start, -1, axis=0))
    assert pieces.radius == pytest.approx(np.full(60, 20.0), abs=40.0 * off)
    assert pieces.start + 0.0 == pytest.approx(pieces.centre + pieces.radius[:, None] * _unit(pieces.angle), abs=1e-9)
    phi = np.linspace(0.0, 2.0 * np.pi, 1000)
    law = 3.0 * np.cos(phi) + np.sqrt(625.0 - 9.0 * np.sin(phi) ** 2)
    found = positions(Contour.from_pieces(pieces), Contact(Translating(0.0), Roller(5.0)), 1, phi)
    assert found == pytest.approx(law, abs=4.0 * off)


def _unit(angle: np.ndarray) -> np.ndarray:
    return np.column_stack([np.cos(angle), np.sin(angle)])


def test_an_arc_that_goes_nearly_all_the_way_round_is_two_whose_ends_meet() -> None:
    whole = Pieces.from_arcs(np.zeros((1, 2)), np.array([20.0]), np.array([0.3]), np.array([2.0 * math.pi - 1e-4]))
    pieces = closed_up(whole, SAME, USUAL)
    assert pieces.kind.tolist() == [ARC, ARC]
    assert np.array_equal(pieces.end, np.roll(pieces.start, -1, axis=0))
    assert Contour.from_pieces(pieces).area == pytest.approx(400.0 * math.pi, rel=1e-4)


def test_a_line_goes_to_a_curve_and_between_two_curves_or_beside_a_short_piece_a_line_is_drawn() -> None:
    curve = Beziers(np.array([[[0.0, 0.0], [10.0, 10.0], [20.0, 0.0]]]), np.ones((1, 3)))
    back = Beziers(np.array([[[20.001, 0.0], [10.0, -10.0], [0.0, 0.0]]]), np.ones((1, 3)))
    bow = Pieces.from_unrolled(curve)
    line = Pieces.from_chords(np.array([[20.001, 0.0]]), np.array([[0.0, 0.001]]), np.zeros(1))
    pieces = closed_up(Pieces.joined([bow, line]), SAME, USUAL)
    assert len(pieces) == 2
    assert pieces.start[1].tolist() == [20.0, 0.0]
    assert pieces.end[1].tolist() == [0.0, 0.0]
    curves = closed_up(Pieces.from_unrolled(Beziers.joined([curve, back])), SAME, USUAL)
    assert curves.kind.tolist().count(LINE) == 1
    assert np.array_equal(curves.end, np.roll(curves.start, -1, axis=0))
    corners = np.array([[0.0, 0.0], [30.0, 0.0], [30.0, 0.01], [0.0, 30.0]])
    ends = np.roll(corners, -1, axis=0)
    ends[1, 1] += 0.001
    short = Pieces.from_chords(corners, ends, np.zeros(4))
    assert len(closed_up(short, SAME, USUAL)) == 5
