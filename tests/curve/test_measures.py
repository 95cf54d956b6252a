"""Perimeter, area, distances from the shaft and polar radius: against circles, polygons, dense samples and mpmath."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import mpmath as mp
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from support.cases import examples
from support.discs import CONTOURS, M15, TURN, displaced

from camgeo.curve.curve import Curve
from camgeo.curve.disc import StraightFace, face_shape
from camgeo.curve.measures import StarError, farthest, least_support, measures, nearest, polar_radius
from camgeo.curve.moving_frame import CentreShape, Translating
from camgeo.curve.parallel import Parallel
from camgeo.curve.undercut.trim import trimmed

if TYPE_CHECKING:
    from kin.numeric.arrays import Array

STILL = displaced((360,))


def circle(radius: float, beside: float = 0.0) -> Curve:
    """A knife edge that stands still; or with an eccentric, whose face moves as a cosine."""
    if not beside:
        return Curve.whole(CentreShape(STILL, Translating.on(radius)))
    half = displaced((2.0 * beside, 180, "harmonic"), (-2.0 * beside, 180, "harmonic"))
    return Curve.whole(face_shape(StraightFace(half, radius - beside)))


def polygon(curve: Curve, count: int) -> Array:
    parts = [curve.sample(np.linspace(run.low, run.high, count)).point for run in curve.runs]
    return np.concatenate(parts)


def area_of(points: Array) -> float:
    x, y = points.T
    return 0.5 * float(np.sum(x * np.roll(y, -1) - y * np.roll(x, -1)))


@pytest.mark.parametrize("beside", [0.0, 7.0])
def test_of_a_circle(beside: float) -> None:
    curve = circle(30.0, beside)
    found = measures(curve)
    assert (found.perimeter, found.area) == pytest.approx((60.0 * math.pi, 900.0 * math.pi), rel=1e-14)
    assert farthest(curve).value == pytest.approx(30.0 + beside, rel=1e-14)
    assert nearest(curve).value == pytest.approx(30.0 - beside, rel=1e-14)
    assert least_support(curve).value == pytest.approx(30.0 - beside, rel=1e-13)
    # from the shaft the circle's centre stands at -beside on the x axis
    angles = np.linspace(-7.0, 7.0, 101)
    wanted = -beside * np.cos(angles) + np.sqrt(900.0 - (beside * np.sin(angles)) ** 2)
    assert polar_radius(curve, angles) == pytest.approx(wanted, rel=1e-14)


def test_a_limacon_has_its_closed_area() -> None:
    found = measures(Curve.whole(CONTOURS["knife edge"]))
    assert found.area == pytest.approx(math.pi * (42.5**2 + 12.5**2 / 2), rel=1e-13)
    speed = lambda t: mp.sqrt((42.5 - 12.5 * mp.cos(t)) ** 2 + (12.5 * mp.sin(t)) ** 2)  # noqa: E731
    assert found.perimeter == pytest.approx(float(mp.quad(speed, [0, mp.pi, 2 * mp.pi])), rel=1e-13)


@pytest.mark.thin(3)
@pytest.mark.parametrize("name", CONTOURS)
def test_against_the_polygon_and_dense_samples(name: str) -> None:
    curve = Curve.whole(CONTOURS[name])
    found, points = measures(curve), polygon(curve, 100_001)
    # chords lose about (step/r)^2/24 of the perimeter, and four times that of the area
    assert found.perimeter == pytest.approx(np.hypot(*np.diff(points, axis=0).T).sum(), rel=1e-9)
    assert found.area == pytest.approx(area_of(points), rel=2e-9)
    assert found.perimeter > np.hypot(*np.diff(points, axis=0).T).sum()
    distance = np.hypot(*points.T)
    far, near = farthest(curve), nearest(curve)
    assert distance.max() - 1e-9 <= far.value + far.excess
    assert far.value == pytest.approx(distance.max(), abs=1e-8)
    assert near.value == pytest.approx(distance.min(), abs=1e-8)
    assert max(far.excess, near.excess) < 1e-10
    for one in (far, near):
        assert np.hypot(*curve.sample(np.array([one.at])).point[0]) == pytest.approx(one.value, abs=1e-11)


def test_of_a_trimmed_contour() -> None:
    curve = trimmed(Curve.whole(Parallel(CentreShape(M15, Translating.on(26.0)), 18.0)))
    assert len(curve.runs) > 1
    points = polygon(curve, 40_001)
    coarse, fine = area_of(polygon(curve, 20_001)), area_of(points)
    assert measures(curve).area == pytest.approx((4.0 * fine - coarse) / 3.0, rel=1e-11)  # Richardson
    assert farthest(curve).value == pytest.approx(np.hypot(*points.T).max(), abs=1e-7)
    angles = np.linspace(0.0, TURN, 721)
    found = polar_radius(curve, angles)
    turned = np.unwrap(np.arctan2(points[:, 1], points[:, 0]))
    assert found == pytest.approx(
        np.interp(np.mod(angles - turned[0], TURN) + turned[0], turned, np.hypot(*points.T)), abs=1e-5
    )


@pytest.mark.slow
@pytest.mark.parametrize("name", CONTOURS)
def test_polar_radii_lie_on_the_contour(name: str) -> None:
    curve = Curve.whole(CONTOURS[name])
    angles = np.linspace(0.0, TURN, 361)
    radius = polar_radius(curve, angles)
    wanted = radius[:, None] * np.column_stack([np.cos(angles), np.sin(angles)])
    t = np.linspace(curve.runs[0].low, curve.runs[0].high, 40_001)
    points = curve.sample(t).point
    # Newton on the polar angle from the nearest sample: another way to the same place
    at = t[[int(np.argmin(np.hypot(*(points - one).T))) for one in wanted]]
    for _ in range(4):
        frame = curve.sample(at)
        beside = wanted[:, 0] * frame.point[:, 1] - wanted[:, 1] * frame.point[:, 0]
        slope = frame.speed * (wanted[:, 0] * frame.tangent[:, 1] - wanted[:, 1] * frame.tangent[:, 0])
        at = at - beside / slope
    assert np.abs(curve.sample(at).point - wanted).max() < 1e-11


def test_a_shaft_outside_is_refused() -> None:
    with pytest.raises(StarError, match="more than once or not at all"):
        polar_radius(circle(30.0, 31.0), np.zeros(1))


def test_a_shaft_just_inside_is_not() -> None:
    beside = 30.0 * (1.0 - 1e-6)
    assert polar_radius(circle(30.0, beside), np.zeros(1)) == pytest.approx([30.0 - beside], rel=1e-9)


@given(st.floats(5, 30), st.floats(0.1, 25), st.floats(40, 170), st.floats(-12, 12))
@settings(deadline=None, max_examples=examples(60))
def test_any_cam_s_measures_are_those_of_its_polygon(base: float, stroke: float, over: float, offset: float) -> None:
    motion = displaced((stroke, over, "cycloidal"), (-stroke, 360 - over, "polynomial-345"))
    curve = Curve.whole(CentreShape(motion, Translating.on(base + 12.5, offset)))
    points = polygon(curve, 20_001)
    assert measures(curve).area == pytest.approx(area_of(points), rel=1e-6)
    far, distance = farthest(curve), np.hypot(*points.T)
    assert distance.max() <= far.value + far.excess + 1e-12
    assert far.value == pytest.approx(distance.max(), rel=1e-6)
    assert nearest(curve).value <= distance.min() + 1e-12
