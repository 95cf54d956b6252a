"""Pieces cut until none turns by more than a quarter of a turn: as few as do, of the same length and turn."""

from __future__ import annotations

import math

import numpy as np
import pytest

from kin.contour.arcs import Arcs
from kin.contour.least_distance import _bent_little


@pytest.mark.parametrize(("turn", "count"), [(0.0, 1), (89.9, 1), (90.1, 2), (-90.1, 2), (179.9, 2), (200.0, 3)])
def test_pieces_turn_by_a_quarter_at_most(turn: float, count: int) -> None:
    curvature = math.radians(turn) / 7.0
    made = _bent_little(Arcs(np.zeros((1, 2)), np.array([[1.0, 0.0]]), np.array([curvature]), np.array([7.0])))
    assert len(made) == count
    assert made.length.sum() == pytest.approx(7.0)
    assert np.abs(made.curvature * made.length).max() <= 0.5 * math.pi
