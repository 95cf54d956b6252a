"""The least wall between bore and contour, against closed forms."""

import math

import pytest

from camgeo.curve import Curve
from camgeo.part.wall import least_wall
from camgeo.profile.support import SupportShape
from kin.lift import lift_from_fourier, lift_reuleaux


@pytest.mark.parametrize("pivot", [(3.0, 4.0), (-12.0, 5.0), (0.0, -24.0)])
def test_circle_off_its_shaft(pivot):
    wall, at = least_wall(Curve.whole(SupportShape(lift_from_fourier(25.0, {}, {}, pivot))), 8.0)
    assert wall == pytest.approx(25.0 - math.hypot(*pivot) - 4.0, abs=1e-12)
    # nearest where the outward normal points from the centre to the shaft
    assert math.cos(at - math.atan2(pivot[1], pivot[0])) == pytest.approx(1.0, abs=1e-12)


def test_shaft_outside_the_contour():
    wall, _ = least_wall(Curve.whole(SupportShape(lift_from_fourier(25.0, {}, {}, (30.0, 40.0)))), 8.0)
    assert wall == pytest.approx(-(50.0 - 25.0) - 4.0, abs=1e-12)


def test_reuleaux_about_its_middle():
    # a flank is an arc of radius w - r about the middle of the opposite corner, (w - 2 r)/sqrt 3 from the shaft
    wall, _ = least_wall(Curve.whole(SupportShape(lift_reuleaux(3, 50.0, 5.0))), 10.0)
    assert wall == pytest.approx(45.0 - 40.0 / math.sqrt(3.0) - 5.0, abs=1e-9)
