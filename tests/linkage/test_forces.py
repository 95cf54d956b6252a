"""Force angles and lines: a triangle of 3, 4, 5, and forces that push a link on."""

import numpy as np

from kin.linkage.forces import angle, pushing


def test_sine_and_cosine_turn_with_the_side():
    lever, along = np.array([3.0, 3.0, 0.0]), np.array([4.0, 4.0, 0.0])
    sine, cosine = angle(lever, along, np.array([1.0, -1.0, 1.0]))
    assert sine.tolist() == [0.6, -0.6, 0.0]
    assert cosine.tolist() == [0.8, -0.8, 0.0]  # no force line: 0, 0


def test_a_force_pushes_the_way_that_the_link_moves():
    place, along = (np.zeros(3), np.ones(3)), (np.array([3.0, 3.0, 0.0]), np.array([4.0, 4.0, 0.0]))
    line = pushing(place, along, (np.ones(3), np.zeros(3)), np.array([2.0, -2.0, 1.0]))
    assert line.along_x.tolist() == [0.6, -0.6, 0.0]
    assert line.along_y.tolist() == [0.8, -0.8, 0.0]
    assert (line.x.tolist(), line.y.tolist()) == ([0.0] * 3, [1.0] * 3)
