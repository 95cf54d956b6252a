"""What stands on a drawn cam: the dashed line of its zero, and where its edge lies."""

import numpy as np
import pytest

from camgeo.curve.ring import disc
from camgeo.report.page.followers import cam, dashes, edge_ahead


def test_the_edge_ahead_of_the_shaft():
    assert edge_ahead(disc(0.0, 0.0, 20.0)) == pytest.approx(20.0)
    assert edge_ahead(disc(3.0, 0.0, 20.0)) == pytest.approx(23.0)
    assert edge_ahead(disc(-30.0, 0.0, 20.0)) == pytest.approx(50.0, rel=1e-3)  # behind the shaft alone


def test_dashes_begin_and_end_with_one():
    lines = dashes(5.0, 20.0, 1.0)
    ends = np.array([ring.points[:, 0] for ring in lines])
    assert (ends[0, 0], ends[-1, 1]) == (pytest.approx(5.0), pytest.approx(20.0))
    gaps = ends[1:, 0] - ends[:-1, 1]
    assert gaps == pytest.approx(np.full(len(gaps), 0.5 * (ends[0, 1] - ends[0, 0])))


@pytest.mark.parametrize(("radius", "zero"), [(20.0, True), (6.0, False)])
def test_a_cam_shows_its_zero_where_there_is_length_for_it(radius, zero):
    body = cam([("a", (disc(0.0, 0.0, radius),))], 10.0, 1.5, np.zeros(1))
    assert any(shape.role == "zero" for shape in body.shapes) is zero
