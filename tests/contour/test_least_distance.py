"""The least distance of a path from an edge: circles beside, within and across one another."""

import numpy as np
import pytest

from kin.contour.contour import Contour
from kin.contour.least_distance import least_distance


def circle(radius, x=0.0):
    return Contour.from_bulges(np.array([[x + radius, 0.0], [x - radius, 0.0]]), np.ones(2)).as_arcs()[0]


@pytest.mark.parametrize(
    ("path", "side", "distance"),
    [
        (circle(12.0), 1.0, 2.0),  # all round it, at one distance
        (circle(3.0), -1.0, 7.0),
        (circle(2.0, 15.0), 1.0, 3.0),
        (circle(3.0, 12.0), 1.0, -1.0),  # 1 mm into it, at (9, 0)
        (circle(9.0, 2.0), -1.0, -1.0),  # out of it, at (11, 0)
    ],
)
def test_circles(path, side, distance):
    least, place = least_distance(path, circle(10.0), side, 20.0, 1e-3)
    assert least == pytest.approx(distance, abs=0.01 * 21.0 if distance < 0.0 else 1e-12)
    assert np.hypot(*place) == pytest.approx(10.0 + side * least, abs=1e-9)


def test_a_depth_is_found_within_a_hundredth_of_it():
    least, place = least_distance(circle(3.0, 12.0), circle(10.0), 1.0, 0.0, 1e-3)
    assert least == pytest.approx(-1.0, abs=0.01)
    assert place == pytest.approx([9.0, 0.0], abs=0.2)
