"""Checks of any file that was read: where contours cross themselves.

Holds: kin.read.checks.
"""

from __future__ import annotations

import numpy as np

from kin.contour.contour import Contour
from kin.read.checks import crossing_places

# a loop that crosses itself at (20, 15), and by a line of length 1 that joins two ends near (-10, -1)
LOOP = Contour.from_vertices(
    np.array([(0, 0), (40, 30), (40, 0), (0, 30), (-10, 30), (-10, -1), (-11, -1)]) + np.array([100.0, 50.0])
)


def test_crossings_beside_a_line_that_joins_two_ends_are_none() -> None:
    near, told = crossing_places([LOOP]), crossing_places([LOOP], 0.7)
    assert (len(near), told) == (2, near[:1])
    assert "120.0" in told[0]
    assert "65.0" in told[0]
    # ends that lie farther apart than the gap along x and along y are not joined by it
    assert crossing_places([LOOP], 0.6) == near
