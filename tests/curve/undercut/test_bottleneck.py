"""Necks of pitch curves, against closed forms and against all pairs of many points.

Holds: camgeo.curve.undercut.tangents.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import mpmath
import numpy as np
import pytest
from hypothesis import given, reject, settings
from hypothesis import strategies as st
from support.cases import examples, few
from support.shapes import PEAR, Polar, booth, waves

from camgeo.curve.curvature import least_radius
from camgeo.curve.curve import Bounds, Curve, CurveError, Frame
from camgeo.curve.parallel import Parallel
from camgeo.curve.undercut.bottleneck import NECK_SHARPNESS, OpenNeckError, narrowest_necks, neck_from, rolling_radius
from camgeo.curve.undercut.pairs import Pitch
from kin.numeric import elementary

LENGTH = 60.0


def pitch(shape, e=1.0):
    return Pitch.of(Curve.whole(Parallel(shape, e)))


def least_of_pairs(curve, count=700):
    t = 2 * np.pi * np.arange(count) / count
    radius = rolling_radius(curve, t, t)
    np.fill_diagonal(radius, np.inf)
    return radius.min()


@pytest.mark.thin(3)
@pytest.mark.parametrize("share", [0.5, 0.8, 0.95])
@pytest.mark.parametrize("e", [1.0, 40.0])
def test_the_waist_of_booths_lemniscate(share, e):
    waist = LENGTH * math.sqrt(2.0 * (1.0 - share))
    curve = pitch(booth(LENGTH, LENGTH * math.sqrt(share)), e)
    (neck,) = narrowest_necks(curve, 1.001 * waist)
    assert neck.half == pytest.approx(waist, rel=1e-13)
    assert (neck.first, neck.second) == pytest.approx((0.5 * math.pi, 1.5 * math.pi), abs=1e-9)
    assert narrowest_necks(curve, waist * (1.0 - 1e-8)) == ()
    assert len(narrowest_necks(curve, waist * (1.0 + 1e-8))) == 1


def test_a_convex_curve_has_no_neck():
    # half of the narrowest double normal is 53.7 mm, but the ends are bent more
    curve = pitch(booth(LENGTH, 0.55 * LENGTH))
    assert narrowest_necks(curve, least_radius(curve.curve)[0]) == ()


def test_the_neck_of_a_pear_is_a_double_normal():
    curve = pitch(PEAR, 10.0)
    (neck,) = narrowest_necks(curve, 18.0)
    ends = np.array([neck.first, neck.second])
    frame = PEAR.sample(ends)
    chord = frame.point[1] - frame.point[0]
    assert np.hypot(*chord) == pytest.approx(2.0 * neck.half, rel=1e-14)
    assert frame.tangent @ chord == pytest.approx([0.0, 0.0], abs=1e-11)
    assert neck.half <= least_of_pairs(curve) <= 1.001 * neck.half


@pytest.mark.slow
@pytest.mark.parametrize("place", [0.0, 0.3, 1.234])
def test_opposite_notches_make_a_neck(place):
    # on a circle of 30 mm, about as narrow as their shoulders allow
    def notched(t):
        a = elementary.cos(t - place)
        return t.constant(30.0) - (elementary.exp((a - 1.0) * 5.0) + elementary.exp((a + 1.0) * -5.0)) * 20.0

    curve = pitch(Polar(notched), 0.3)
    half = 10.0 - 20.0 * math.exp(-10.0)
    assert least_radius(curve.curve)[0] > half
    (neck,) = narrowest_necks(curve, half + 1e-3)
    assert neck.half == pytest.approx(half, rel=1e-13)
    assert narrowest_necks(curve, half - 1e-6) == ()


def test_alike_necks_are_all_found():
    # a bulb between two others: a vertical neck on either side, where y has its least value
    def height(t):
        r = 20 + 10.85 * mpmath.cos(2 * t) + 0.89 * mpmath.cos(4 * t) - 0.77 * mpmath.cos(6 * t)
        return r * mpmath.sin(t)

    at = mpmath.findroot(lambda t: mpmath.diff(height, t), (1.2, 1.4), solver="anderson")
    curve = pitch(waves(20.0, (2, 10.85, 0.0), (4, 0.89, 0.0), (6, 0.77, math.pi)), 0.5)
    necks = narrowest_necks(curve, least_radius(curve.curve)[0])
    assert [n.half for n in necks] == pytest.approx([float(height(at))] * 2, rel=1e-13)
    assert [n.first for n in necks] == pytest.approx([float(at), math.pi - float(at)], abs=1e-8)
    assert [n.second for n in necks] == pytest.approx([2 * math.pi - float(at), math.pi + float(at)], abs=1e-8)


@given(
    st.lists(st.tuples(st.integers(2, 7), st.floats(-4.0, 4.0), st.floats(0.0, 6.28)), min_size=1, max_size=3),
    st.floats(1.0, 25.0),
)
@settings(deadline=None, max_examples=examples(40))
def test_no_pair_of_points_lies_closer_than_is_proved(terms, below):
    shape = waves(25.0, *terms)
    curve = pitch(shape, 0.5)
    least = least_radius(Curve.whole(shape))[0]
    below = min(below, least)
    try:
        necks = narrowest_necks(curve, below)
    except CurveError:  # it may leave open whether there is a neck, but tell of none that is not, and miss none
        reject()
    seen = least_of_pairs(curve)
    proved = min([below, *(n.half for n in necks)])
    assert seen >= proved * (1.0 - NECK_SHARPNESS) - 1e-9
    for neck in necks:
        assert neck.half < below
        assert seen <= neck.half * 1.01


def test_newtons_method_tells_inside_from_outside():
    curve = pitch(booth(LENGTH, 0.9 * LENGTH))
    assert neck_from(curve, 1.5, 4.8).half == pytest.approx(LENGTH * math.sqrt(0.38), rel=1e-13)
    # two lobes of a star face each other across the outside
    star = pitch(waves(20.0, (5, 8.0, 0.0)), 0.1)
    assert neck_from(star, 0.1, 2 * math.pi / 5 - 0.1) is None


@pytest.mark.parametrize("steps", [1, 2])
def test_where_newtons_method_has_not_come_to_is_no_neck(monkeypatch, steps):
    monkeypatch.setattr("camgeo.curve.undercut.bottleneck.NEWTON", steps)
    curve = pitch(booth(LENGTH, 0.9 * LENGTH))
    assert neck_from(curve, 1.0, 5.4) is None
    # the search divides its boxes until so few steps suffice
    (neck,) = narrowest_necks(curve, 0.9 * LENGTH)
    assert neck.half == pytest.approx(LENGTH * math.sqrt(0.38), rel=2e-9)


@pytest.mark.thin(2)
@pytest.mark.parametrize("share", few([0.98, 0.999, 1.0 - 1e-6], 2))
def test_a_waist_almost_folded_is_measured(share):
    # bent on its outer side to a hundredth of its width and less
    waist = LENGTH * math.sqrt(2.0 * (1.0 - share))
    curve = pitch(booth(LENGTH, LENGTH * math.sqrt(share)))
    (neck,) = narrowest_necks(curve, 1.001 * waist)
    assert neck.half == pytest.approx(waist, rel=1e-9)
    assert narrowest_necks(curve, 0.999 * waist) == ()
    assert narrowest_necks(curve, 1e-3 * waist) == ()


@dataclass(frozen=True)
class Arcs:
    """A chain of circular arcs (length, turning), each over a unit of the parameter, from (0, 0) along the x axis."""

    arcs: tuple[tuple[float, float], ...]

    repeats = 1

    @property
    def period(self):
        return float(len(self.arcs))

    @property
    def breaks(self):
        return np.arange(len(self.arcs), dtype=float)

    @property
    def steady(self):
        return np.array(self.arcs)

    @property
    def radii(self):
        return np.array([length / turn for length, turn in self.arcs])

    def sample(self, t, side=1):
        t = np.mod(t, self.period)
        i = np.where(side > 0, np.floor(t), np.ceil(t) - 1.0).astype(int) % len(self.arcs)
        x = np.where((t == 0.0) & (np.asarray(side) < 0), 1.0, t - i)
        length, turn = np.array(self.arcs).T
        ahead = np.concatenate([[0.0], np.cumsum(turn)])
        start = np.concatenate([[0.0], np.cumsum(length / turn * (np.exp(1j * ahead[1:]) - np.exp(1j * ahead[:-1])))])
        theta = ahead[i] + turn[i] * x
        z = -1j * (start[i] + length[i] / turn[i] * (np.exp(1j * theta) - np.exp(1j * ahead[i])))
        none = np.zeros_like(t)
        return Frame(
            np.column_stack([z.real, z.imag]),
            np.column_stack([np.cos(theta), np.sin(theta)]),
            length[i],
            turn[i],
            none,
            none,
        )

    def bounds(self, low, high):
        at = self.sample(0.5 * (low + high))
        return Bounds(at.speed, at.speed, at.turn, at.turn, *[np.zeros_like(low)] * 4)


def bent_slot(outer, inner, over):
    """Two arcs about one centre, closed by half circles: each disc of half their distance passes, no larger one."""
    end = 0.5 * (outer - inner)
    return Arcs(((outer * over, over), (math.pi * end, math.pi), (inner * over, -over), (math.pi * end, math.pi)))


def test_what_is_left_open_is_told_in_figures():
    curve = Pitch(Curve.whole(bent_slot(40.0, 20.0, 2.0)))
    with pytest.raises(OpenNeckError) as told:
        narrowest_necks(curve, 10.0)
    error = told.value
    assert 9.0 < error.least <= error.most == pytest.approx(10.0, rel=1e-8)
    assert f"{error.least:.9g} mm is proved to pass" in str(error)
    # anything smaller is proved
    assert narrowest_necks(curve, 9.9) == ()
