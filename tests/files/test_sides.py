"""The side of a line on which a point lies: against fractions, also where doubles cannot tell."""

from fractions import Fraction

import numpy as np

from camgeo.files.sides import sides


def exact(a, b, c):
    (ax, ay), (bx, by), (cx, cy) = (map(Fraction, point) for point in (a, b, c))
    value = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
    return (value > 0) - (value < 0)


def test_known_sides():
    a, b = np.zeros((3, 2)), np.tile([2.0, 0.0], (3, 1))
    assert sides(a, b, np.array([[1.0, 1.0], [1.0, -1.0], [5.0, 0.0]])).tolist() == [1, -1, 0]


def test_points_a_rounding_beside_a_line():
    # the classic failure of doubles: points one unit in the last place about a diagonal
    step = 2.0**-53
    c = np.array([[0.5 + i * step, 0.5 + j * step] for i in range(16) for j in range(16)])
    a, b = np.tile([12.0, 12.0], (len(c), 1)), np.tile([24.0, 24.0], (len(c), 1))
    assert sides(a, b, c).tolist() == [exact(*rows) for rows in zip(a.tolist(), b.tolist(), c.tolist(), strict=True)]
