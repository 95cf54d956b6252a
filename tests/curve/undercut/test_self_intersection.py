"""Displacements and self-crossings down to swallowtails that no coordinate shows."""

from __future__ import annotations

import math

import mpmath
import numpy as np
import pytest
from support.programmes import Segment, law, programme
from support.shapes import PEAR

from camgeo.curve.curve import Curve
from camgeo.curve.parallel import Parallel
from camgeo.curve.support import SupportShape
from camgeo.curve.undercut.self_intersection import all_breaks, displacement, newton_crossings, polygon_crossings
from camgeo.curve.wunderlich import PitchShape
from kin.law.support_function import lift_from_fourier, lift_reuleaux
from kin.law.transmission import from_law

PERIOD = 2.0 * math.pi


def wave(a):
    """p = a + cos 3t: radius a - 8 cos 3t."""
    return Curve.whole(SupportShape(lift_from_fourier(a, {3: 1.0}, {})))


def exact(a, start, end):
    a, start, end = (mpmath.mpf(float(x)) for x in (a, start, end))

    def point(t):
        p, slope = a + mpmath.cos(3 * t), -3 * mpmath.sin(3 * t)
        return p * mpmath.cos(t) - slope * mpmath.sin(t), p * mpmath.sin(t) + slope * mpmath.cos(t)

    return [float(b - c) for b, c in zip(point(end), point(start), strict=True)]


@pytest.mark.parametrize("length", [1e-9, 1e-6, 1e-3, 0.1, 0.2, 2.0])
def test_displacement_keeps_its_digits_however_short(length):
    start = np.array([0.7, 5.9])
    found = displacement(wave(9.0), start, start + length)
    for row, t in zip(found, start, strict=True):
        want = np.array(exact(9.0, t, t + length))
        scale = np.abs(want).max() if length < 0.125 else 10.0
        # the parameter itself is rounded
        assert row == pytest.approx(want, abs=scale * (1e-14 + 1e-15 / length))


def test_displacement_across_breaks():
    curve = Curve.whole(SupportShape(lift_reuleaux(3, 50.0, 5.0)))
    at = curve.runs[0].breaks[1]
    ends = np.array([at - 0.04]), np.array([at + 0.03])
    points = curve.sample(np.concatenate(ends)).point
    assert displacement(curve, *ends)[0] == pytest.approx(points[1] - points[0], abs=2e-14)


def test_displacement_along_a_path_that_swings():
    """A rise within a hundredth of a degree turns the tangent to and fro: one rule over all of it was off by 1e-8."""
    width = math.radians(0.01)
    rest = Segment("dwell", math.pi / 14.0 - width)
    ways = [Segment(way, width, math.radians(0.001), law("cycloidal")) for way in ("rise", "return")]
    motion = from_law(7, 5, 60.0, programme([ways[0], rest, ways[1], rest], math.pi / 7.0))
    for radius in (0.5, 20.0):
        curve = Curve.whole(Parallel(PitchShape(motion), radius))
        low, high = curve.runs[0].low + np.array([[-0.3], [0.94]]) * width
        points = curve.sample(np.concatenate([low, high])).point
        assert displacement(curve, low, high)[0] == pytest.approx(points[1] - points[0], abs=1e-12)


def test_breaks_repeat():
    curve = Curve.whole(SupportShape(lift_reuleaux(3, 50.0, 5.0)))
    breaks = all_breaks(curve, -7.0, 14.0)
    assert np.diff(breaks) == pytest.approx([math.pi / 3] * (breaks.size - 1))
    assert breaks.size == 20
    assert all_breaks(wave(9.0), -7.0, 14.0).size == 0


@pytest.mark.thin(2)
@pytest.mark.parametrize("margin", [1e-2, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12])
def test_a_swallowtail_crosses_at_root_three_of_its_reversal(margin):
    # sigma = a - 8 cos 3t is 36 (t^2 - d^2) to leading order, whose integral vanishes from -sqrt(3) d to sqrt(3) d
    curve = wave(8.0 - margin)
    d = math.acos((8.0 - margin) / 8.0) / 3.0
    crest = PERIOD / 3.0
    found = newton_crossings(
        curve, np.array([[crest - 1.5 * d, crest + 1.5 * d], [crest - 2.2 * d, crest + 2.0 * d]]), 10.0
    )
    assert found.shape == (2, 2)
    rough = 3.0 * d**2 + 1e-15 / margin
    assert found - crest == pytest.approx(np.array([[-1.0, 1.0]] * 2) * math.sqrt(3.0) * d, rel=max(rough, 1e-9))


def test_crossings_of_a_polygon():
    # a bow tie with its corners cut: edges 0 and 3 cross in the middle of both
    points = np.array([[0.0, 0.0], [2.0, 2.0], [3.0, 1.0], [2.0, 0.0], [0.0, 2.0], [-1.0, 1.0]])
    t = np.arange(6.0)
    for shift in range(6):
        moved = np.roll(points, -shift, axis=0)
        (found,) = polygon_crossings(t, moved, 6.0, t.size)
        assert sorted((found + shift) % 6.0) == pytest.approx([0.5, 3.5])
    assert polygon_crossings(t[:4], np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]), 4.0, 4).shape == (0, 2)


def test_crossings_settle_across_the_seam():
    curve = Curve.whole(Parallel(PEAR, 15.0))
    nodes = np.linspace(0.0, PERIOD, 401)[:-1]
    for shift in (0.0, 1.62, 3.0):
        t = nodes + shift
        seen = polygon_crossings(t, curve.sample(t).point, PERIOD, t.size)
        assert seen.shape == (2, 2)
        found = newton_crossings(curve, seen, 50.0)
        gap = curve.sample(found[:, 0]).point - curve.sample(found[:, 1]).point
        assert np.abs(gap).max() < 1e-12
        # symmetric about the x axis
        assert np.cos(found.sum(axis=1)) == pytest.approx([1.0, 1.0], abs=1e-15)


def test_what_is_no_crossing_does_not_settle():
    curve = wave(9.0)
    assert newton_crossings(curve, np.array([[0.1, 2.0], [3.0, 4.0], [1.0, 1.0]]), 10.0).shape == (0, 2)
    assert newton_crossings(curve, np.empty((0, 2)), 10.0).shape == (0, 2)
