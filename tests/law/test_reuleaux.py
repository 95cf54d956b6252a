"""Reuleaux polygons with unequal arcs: closed stars, constant breadth, area and perimeter, against mpmath."""

import math
from itertools import accumulate, pairwise

import mpmath as mp
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from support.cases import examples

from kin.law.normalised import IntentError
from kin.law.reuleaux import closed_angles, corners
from kin.law.support_function import lift_reuleaux

TURN = 2 * math.pi
GRID = np.linspace(0, TURN, 1801)


@st.composite
def stars(draw):
    """Sides, and angles within a third of the regular polygon's."""
    sides = draw(st.sampled_from([5, 7, 9, 15]))
    share = st.floats(-0.33, 0.33)
    return sides, [math.pi / sides * (1 + draw(share) / (sides - 3)) for _ in range(sides - 3)]


def integrals(lift):
    """Perimeter and area, integrals of p and of (p^2 - p'^2)/2, by Gauss on each stretch."""
    nodes, weights = np.polynomial.legendre.leggauss(24)
    found = np.zeros(2)
    for a, b in pairwise(lift.law.knots):
        p = lift.derivatives(0.5 * (a + b) + 0.5 * (b - a) * nodes, 1)
        found += 0.5 * (b - a) * np.stack([p[0], 0.5 * (p[0] ** 2 - p[1] ** 2)]) @ weights
    return found


def area(angles, breadth, rounding):
    """Of the straight polygon by the shoelace formula, n segments, and the parallel curve (Steiner)."""
    inner = breadth - 2 * rounding
    z = inner * np.array(corners(angles))
    z = z[np.argsort(np.angle(z))]
    straight = 0.5 * float(np.sum((np.conj(z) * np.roll(z, -1)).imag))
    segments = 0.5 * inner**2 * sum(one - math.sin(one) for one in angles)
    return straight + segments + math.pi * inner * rounding + math.pi * rounding**2


@pytest.mark.thin(2)
@pytest.mark.parametrize("sides", [5, 7, 21])
def test_equal_angles_are_the_regular_polygon(sides):
    own = lift_reuleaux(sides, 50.0, 4.0, (3.0, -2.0), [math.pi / sides] * (sides - 3))
    regular = lift_reuleaux(sides, 50.0, 4.0, (3.0, -2.0))
    assert own.derivatives(GRID, 1) == pytest.approx(regular.derivatives(GRID, 1), abs=1e-12)


@settings(max_examples=examples(60))
@given(stars(), st.floats(0, 20))
def test_breadth_perimeter_and_area(star, rounding):
    sides, angles = star
    own, lift = closed_angles(sides, angles), lift_reuleaux(sides, 50.0, rounding, (0.0, 0.0), angles)
    p, far = lift.derivatives(GRID, 1), lift.derivatives(GRID + math.pi, 1)
    assert np.abs(p[0] + far[0] - 50.0).max() < 1e-12
    assert np.abs(p[1] + far[1]).max() < 1e-11  # jumps of p'' at breaks meet the rounding of GRID + pi there
    assert min(lift.radius) == pytest.approx(rounding)
    perimeter, enclosed = integrals(lift)
    assert perimeter == pytest.approx(50.0 * math.pi, rel=1e-13)  # Barbier
    assert enclosed == pytest.approx(area(own, 50.0, rounding), rel=1e-12)


@settings(max_examples=examples(40))
@given(stars())
def test_the_origin_is_where_there_is_no_first_harmonic(star):
    sides, angles = star
    lift = lift_reuleaux(sides, 50.0, 0.0, (0.0, 0.0), angles)
    nodes, weights = np.polynomial.legendre.leggauss(24)
    total = np.zeros(2)
    for a, b in pairwise(lift.law.knots):
        t = 0.5 * (a + b) + 0.5 * (b - a) * nodes
        p = lift.derivatives(t, 0)[0]
        total += 0.5 * (b - a) * np.stack([p * np.cos(t), p * np.sin(t)]) @ weights
    assert np.abs(total).max() < 1e-11
    first = lift.derivatives(np.array([0.0]), 2)[:, 0]  # the first corner bears evenly about +x
    assert first[0] + first[2] == pytest.approx(0.0, abs=1e-12)
    assert [lift.breaks[0], TURN - lift.breaks[-1]] == pytest.approx([0.5 * angles[0]] * 2)


@pytest.mark.parametrize("angles", [[50, 30], [10, 10], [40, 30], [20, 30, 20, 30], [36, 36]])
def test_the_last_three_angles_solve_the_closing_equations(angles):
    """By Newton's method with 40 digits on sum b = pi, sum (-1)^i exp(i s_i) = 0."""
    sides = len(angles) + 3
    own = closed_angles(sides, [math.radians(one) for one in angles])
    with mp.workdps(40):
        given_ = [mp.mpf(one) * mp.pi / 180 for one in angles]

        def closing(*last):
            s = list(accumulate([*given_, *last], initial=mp.mpf(0)))
            rows = (mp.fsum((-1) ** i * of(s[i]) for i in range(sides)) for of in (mp.cos, mp.sin))
            return [s[-1] - mp.pi, *rows]

        exact = mp.findroot(closing, [mp.mpf(one) for one in own[-3:]])
        assert max(abs(mp.mpf(own[i - 3]) - exact[i]) for i in range(3)) < 1e-14
    assert [abs(b - a) for a, b in pairwise([*corners(own), corners(own)[0]])] == pytest.approx(
        [1.0] * sides, abs=1e-14
    )


@pytest.mark.parametrize(
    ("angles", "why"),
    [
        ([100, 100], "they add up to 200 degrees, and all 5 to 180"),
        ([80, 60], "three arcs more do not close it"),
        ([60, 60], "three arcs more do not close it"),
        ([5, 80], "three arcs more do not close it"),
        ([60, 60, 60, 60], "they add up to 240 degrees, and all 7 to 180"),
        ([0.2, 0.2, 0.2, 100], "three arcs more do not close it"),
    ],
)
def test_angles_of_no_polygon_name_some_that_are(angles, why):
    with pytest.raises(IntentError) as caught:
        closed_angles(len(angles) + 3, [math.radians(one) for one in angles])
    message = caught.value.message
    assert why in message
    near = [float(one) for one in message[message.index("[") + 1 : message.index("]")].split(",")]
    assert min(closed_angles(len(angles) + 3, [math.radians(one) for one in near])) > 0


def test_a_wrong_number_of_angles():
    with pytest.raises(IntentError, match="5 sides take 2 angles, the last three of them follow; here are 1"):
        closed_angles(5, [0.5])
