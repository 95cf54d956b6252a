"""Paths of points of links: closed forms, difference quotients, and chords within their tolerance."""

import math

import numpy as np
import pytest
from support.heavy import shapely

from kin.law.formula.formula import Formula
from kin.law.from_formula import lift_from_formula
from kin.linkage.dyad import RRP, RRR
from kin.linkage.four_bar import FourBar, InvertedSliderCrank, SliderCrank
from kin.linkage.mechanism import Mechanism
from kin.linkage.trace import flattened, traced

CAM = Formula("sin(3*t) + 13/15*sin(3*t)*cos(2*t) + 25")
DYADS = (
    RRR("coupler", (10.0, 25.0), (160.0, 40.0), (110.0, 90.0), "open"),
    RRP("previous", (60.0, 5.0), 80.0, (140.0, 0.0), 1.2, "open"),
)
THETA = np.linspace(0.0, 2 * math.pi, 721)


def driven(linkage, dyads=()):
    return Mechanism(linkage, lift_from_formula(CAM, (18.0, 8.5)), 50.0, dyads)


FOUR_BAR = driven(FourBar(80.0, 70.0, 105.0), DYADS)


def test_a_point_of_a_rocker_runs_on_a_circle_about_its_pivot() -> None:
    """Its curvature is that of the circle, of the sign of the turn (theta_4 is clockwise); its speed r omega."""
    path = traced(FOUR_BAR, "output", (60.0, -25.0), THETA)
    motion = FOUR_BAR.at(THETA, 1)
    omega = motion.outputs[0][1] / motion.shaft[1]
    assert np.hypot(path.x - 80.0, path.y) == pytest.approx(65.0, abs=1e-10)
    assert path.speed == pytest.approx(65.0 * np.abs(omega), abs=1e-10)
    assert -path.curvature * np.sign(omega) == pytest.approx(1 / 65.0, rel=1e-6)
    of_dyad = traced(FOUR_BAR, "dyads[0]", (0.0, 40.0), THETA)
    assert np.hypot(of_dyad.x - 160.0, of_dyad.y - 40.0) == pytest.approx(40.0, abs=1e-9)


def test_a_point_of_a_slide_runs_on_a_straight_line() -> None:
    path = traced(FOUR_BAR, "dyads[1]", (5.0, 3.0), THETA)
    along = np.array([math.cos(1.2), math.sin(1.2)])
    assert np.ptp(path.x * along[1] - path.y * along[0]) < 1e-9
    assert np.nanmax(np.abs(path.curvature)) < 1e-6
    slider = driven(SliderCrank(100.0, 20.0))
    assert np.ptp(traced(slider, "output", (0.0, 4.0), THETA).y) < 1e-12


@pytest.mark.thin(2)
@pytest.mark.parametrize("linkage", [FourBar(80.0, 70.0, 105.0, "crossed"), InvertedSliderCrank(90.0, 0.0)])
def test_a_coupler_curve_by_differences(linkage) -> None:
    """Of places alone, over the shaft angle; curvature by three points of the path."""
    mechanism, point, step = driven(linkage), (40.0, 10.0), 1e-4
    shaft = np.linspace(0.1, 6.2, 83)
    before, here, after = (
        traced(mechanism, "coupler", point, mechanism.relative(shaft + d)) for d in (-step, 0.0, step)
    )
    dx, dy = (after.x - before.x) / (2 * step), (after.y - before.y) / (2 * step)
    ddx, ddy = ((b - 2 * a + c) / step**2 for a, b, c in zip(here[:2], after[:2], before[:2], strict=True))
    assert here.speed == pytest.approx(np.hypot(dx, dy), rel=1e-5, abs=1e-6)
    fast = here.speed > 1.0
    assert np.count_nonzero(fast) > 40
    assert here.curvature[fast] == pytest.approx(((dx * ddy - dy * ddx) / np.hypot(dx, dy) ** 3)[fast], abs=1e-4)


@pytest.mark.thin(2)
@pytest.mark.parametrize("tolerance", [0.1, 0.001])
def test_chords_stay_within_the_tolerance(tolerance) -> None:
    line = flattened(FOUR_BAR, "coupler", (40.0, 10.0), tolerance)
    path = traced(FOUR_BAR, "coupler", (40.0, 10.0), np.linspace(0.0, 2 * math.pi, 9001))
    off = shapely.distance(shapely.LineString(line), shapely.points(np.column_stack([path.x, path.y])))
    assert off.max() <= tolerance
    assert off.max() > 0.2 * tolerance  # no finer than it needs to be
    assert line[0] == pytest.approx(line[-1])


def test_where_nothing_moves_there_is_no_curvature() -> None:
    """The oscillating yoke's pivot, in the axes of its rocker."""
    path = traced(FOUR_BAR, "output", (0.0, 0.0), THETA)
    assert np.isnan(path.curvature).all()
    assert path.speed.max() < 1e-12
    assert len(flattened(FOUR_BAR, "output", (0.0, 0.0), 1e-3)) == 2
