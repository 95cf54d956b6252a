"""A frame's swing over the shaft angle: the lift that it asks for in 30 digits, and the motion that this gives."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from functools import cache

import mpmath as mp
import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from support.square_frame import Bars, Bench

from kin.law.frame_swing import frame_swing, span_of
from kin.law.normalised import IntentError
from kin.law.sources.laws import named
from kin.law.sources.programme import Dwell, Move, programme
from kin.law.support_function import lift_constant_breadth
from kin.linkage.dyad import RRR
from kin.linkage.four_bar import InvertedSliderCrank
from kin.linkage.mechanism import Mechanism
from kin.numeric.inverse import Inverse

DEG = math.pi / 180
RADIUS = 40.0


@dataclass(frozen=True)
class Case:
    """A rise by the cycloidal law and a dwell, degrees; links in mm."""

    rise: float
    over: float
    ground: float = 80.0
    rocker: float = 0.0
    offset: float = 0.0
    assembly: str = "open"

    @property
    def side(self):
        return 1 if self.assembly == "open" else -1

    @property
    def span(self):
        return math.pi + self.rise * DEG

    def motion(self):
        dwell = [Dwell(self.span - self.over * DEG)]
        return programme(
            [Move(self.over * DEG, named("cycloidal"), by=self.rise * DEG), *dwell], self.span, around=None
        )

    def law(self):
        return frame_swing(self.motion(), self.ground, self.rocker - self.offset, self.side)

    def lift(self, radius=RADIUS):
        return lift_constant_breadth(radius, self.law().half_turn, "swing")

    def mechanism(self, dyads=(), radius=RADIUS):
        lift = self.lift(radius)
        breadth = float(lift.derivatives(np.array([0.0, math.pi]), 0)[0].sum())
        linkage = InvertedSliderCrank(self.ground, self.rocker, self.assembly, self.offset)
        return Mechanism(linkage, lift, breadth, dyads)


CASES = [
    Case(20.0, 140.0),
    Case(-16.0, 100.0),
    Case(20.0, 130.0, assembly="crossed"),
    Case(24.0, 150.0, 70.0, 12.0),
    Case(18.0, 150.0, 90.0, 10.0, 22.0),
    Case(-12.0, 120.0, 60.0, 0.0, -9.0, "crossed"),
]


class Exact:
    """The law and its lift from the equations alone, in mpmath."""

    def __init__(self, case):
        self.case = case
        self.r1, self.r4, self.k = mp.mpf(case.ground), mp.mpf(case.rocker - case.offset), case.side
        self.h, self.over = mp.radians(mp.mpf(case.rise)), mp.radians(mp.mpf(case.over))
        # where constant breadth wants it: Y at the beginning is minus Y half a turn of the relative angle on
        mean = -self.k * self.r4 / (self.r1 * mp.cos(self.h / 2))
        self.begin = mp.asin(mean) - self.h / 2

    def swing(self, phi):
        u = min(phi / self.over, 1)
        return self.begin + self.h * (u - mp.sin(2 * mp.pi * u) / (2 * mp.pi))

    def y(self, psi):
        """Y of AS 24, by theta_4 itself."""
        return self.r4 - self.r1 * mp.cos(psi + self.k * mp.pi / 2)

    def shaft(self, theta):
        """Shaft angle of a relative angle in the first half turn."""
        return mp.findroot(lambda phi: phi - (self.swing(phi) - self.begin) - theta, (theta, theta + self.h / 2))

    def lift(self, theta):
        """S, from that half turn and, beyond, by constant breadth."""
        if theta > mp.pi:
            return 2 * RADIUS + self.y(self.swing(self.case.span)) - self.y(self.begin) - self.lift(theta - mp.pi)
        return RADIUS + self.y(self.swing(self.shaft(theta))) - self.y(self.begin)

    def late(self, phi):
        """psi at a shaft angle beyond the law: the relative angle is half a turn on from one where sin psi is known."""

        def image(first):
            return mp.asin(-2 * self.k * self.r4 / self.r1 - mp.sin(self.swing(first)))

        first = mp.findroot(lambda x: x - self.swing(x) + mp.pi + image(x) - phi, (phi - mp.pi) * mp.mpf(0.9))
        return image(first)


@pytest.fixture(params=CASES, ids=str)
def case(request):
    return request.param


@pytest.mark.thin(8)
def test_the_lift_is_that_of_the_loop(case):
    with mp.workdps(30):
        exact, lift = Exact(case), case.lift()
        for theta in (0.3, 1.1, 1.9, 2.7, 3.9, 5.6):
            p = lift.derivatives(theta, 2)[:, 0]
            wanted = [exact.lift(mp.mpf(theta)), *(mp.diff(exact.lift, theta, k) for k in (1, 2))]
            assert p == pytest.approx([float(x) for x in wanted], abs=1e-11)


@pytest.mark.thin(8)
def test_the_mechanism_swings_by_the_law_all_round(case):
    mechanism, law = case.mechanism(), case.law()
    phi = np.linspace(0.0, 2 * math.pi, 60, endpoint=False)
    at = mechanism.at(mechanism.relative(phi), 2)
    output = at.over_shaft(at.output)
    with mp.workdps(30):
        exact = Exact(case)
        swings = [exact.swing(mp.mpf(x)) if x <= case.span else exact.late(mp.mpf(x)) for x in phi]
        wanted = np.array([float(psi + case.side * mp.pi / 2) for psi in swings])
    assert output[0] == pytest.approx(wanted, abs=1e-12)
    assert law.output(phi, 0).c[0] == pytest.approx(wanted, abs=1e-12)
    # the law's own derivatives, from its image beyond it, against those of the mechanism's loops
    assert law.output(phi + 4 * math.pi, 2).derivatives() == pytest.approx(output, abs=1e-11)


@pytest.mark.slow
def test_a_polygon_turning_in_a_rigid_square_swings_by_the_law():
    """Nothing of kin but the corners: directions of the frame are found by bisection at given shaft angles."""
    case = CASES[4]
    lift, law = case.lift(), case.law()
    t = np.arange(7200) * math.pi / 3600
    s = lift.derivatives(t, 0)[0]
    corner = np.exp(1j * t) * (s + 1j * (np.roll(s, -1) - s * np.cos(t[1])) / np.sin(t[1]))
    bars = Bars("inverted", case.ground, rocker=case.rocker, side=case.side, aside=case.offset)
    bench = Bench(bars, case.mechanism().breadth, cache(lambda x: float(lift.derivatives(x, 0)[0, 0])))
    phi = np.arange(0.0, 2 * math.pi, 0.0199)
    found = bench.measured(np.column_stack([corner.real, corner.imag]), phi, (0.5, 0.5))
    assert found == pytest.approx(law.output(phi, 0).c[0], abs=1e-6)


def test_what_rounding_leaves_of_a_rest_is_no_acceleration():
    back = [
        Move(87.8816 * DEG, named("harmonic"), by=-11.7795 * DEG),
        Move(68.5594 * DEG, named("polynomial-4567"), by=-11.7795 * DEG),
    ]
    law = frame_swing(programme(back, 156.441 * DEG, around=None), 137.0, 0.0, 1.0)
    ends = [end for joint in law.joints for k, *both in joint.jumps if k == 2 for end in both]
    assert len(ends) == 4
    assert sum(end == 0.0 for end in ends) == 2  # beside a harmonic end each, of about 0.43


def test_what_hangs_on_the_rocker_is_solved_from_the_law():
    from kin.follower.frame import _Prescribed

    case = Case(18.0, 150.0, 90.0, 30.0, 22.0)
    mechanism = case.mechanism((RRR("output", (40.0, 5.0), (150.0, 40.0), (70.0, 45.0), "open"),))
    phi = np.linspace(0.0, 2 * math.pi, 50, endpoint=False)
    at = mechanism.at(mechanism.relative(phi), 0)
    assert np.ptp(at.output[0]) > 0.1
    assert _Prescribed(mechanism, case.law()).output(phi) == pytest.approx(at.output[0], abs=1e-11)


def test_stretches_of_a_swing_are_one_evaluation(monkeypatch):
    """The lift and its slope at relative angles that come from shaft angles, either side of each joint, and over all.

    The relative angle is phi - m, the lift that of the swing m moved, so its slope is L'(m) m'/(1 - m').
    """
    swing = [Move(140.0 * DEG, named("modified-sine"), by=20.0 * DEG), Dwell(60.0 * DEG)]
    law = frame_swing(programme(swing, 200.0 * DEG, around=None), 80.0, 0.0, 1.0)
    half, knots = law.half_turn, law.motion.motion.knots
    assert len(knots) == 5
    places = 0.5 * (knots[:-1] + knots[1:])
    phi, side = np.concatenate([places, knots[:-1], knots[1:]]), np.repeat([1, 1, -1], 4)
    moved, rate = law.motion.derivatives(phi, 1, side)
    slope = 80.0 * np.cos(law.start + moved) * rate / (1.0 - rate)
    lift = np.array([law.lift(m) for m in moved.tolist()])

    calls, series = [], Inverse.series
    monkeypatch.setattr(Inverse, "series", lambda *args: calls.append(1) or series(*args))
    theta = np.clip(phi - moved, 0.0, math.pi)
    found = half.derivatives(theta, 1, side)
    assert len(calls) == 1
    assert found == pytest.approx(np.stack([lift, slope]), abs=2e-13)

    order = np.argsort(theta)
    first, last = order[:-3], order[3:]
    mid, rad = half.enclosure(theta[first], theta[last], 1)
    for k in range(4):
        inside = np.stack([lift, slope])[:, order[k : len(order) - 3 + k]]
        assert (np.abs(inside - mid) <= rad + 1e-12).all()


@pytest.mark.slow
@given(
    st.floats(-40, 40).filter(lambda h: abs(h) > 1),
    st.floats(60, 150),
    st.tuples(st.floats(40, 200), st.floats(-15, 15), st.sampled_from(["open", "crossed"])),
    st.tuples(st.floats(0.01, 3.1), st.floats(1e-12, 0.3)),
)
def test_enclosures_hold_the_derivatives(rise, over, links, interval):
    ground, rocker, assembly = links
    begin, width = interval
    case = Case(rise, over, ground, 20.0 + rocker, 20.0, assembly)
    try:
        half = case.law().half_turn
    except IntentError:
        assume(False)
    end = min(begin + width, math.pi)
    mid, rad = half.enclosure(begin, end, 4)
    inside = half.derivatives(np.linspace(begin, end, 33), 4)
    assert (np.abs(inside - mid) <= rad * (1 + 1e-9) + 1e-9 * np.abs(inside).max(axis=1, keepdims=True)).all()
    at = 0.5 * (begin + end)
    mid, rad = half.enclosure(at, at, 2)
    assert (rad < 1e-9 * (1 + np.abs(mid))).all()


@pytest.mark.slow
@given(
    st.floats(-40, 40).filter(lambda h: abs(h) > 1),
    st.floats(60, 150),
    st.tuples(st.floats(40, 200), st.floats(-15, 15), st.sampled_from(["open", "crossed"])),
)
def test_any_swing_that_is_accepted_is_made(rise, over, links):
    ground, rocker, assembly = links
    case = Case(rise, over, ground, 20.0 + rocker, 20.0, assembly)
    try:
        law = case.law()
    except IntentError:
        assume(False)
    mechanism = case.mechanism(radius=1000.0)
    assert mechanism.mobility().turns
    phi = np.linspace(0.0, 2 * math.pi, 37)
    found = mechanism.at(mechanism.relative(phi), 0).output[0]
    assert found == pytest.approx(law.output(phi, 0).c[0], abs=1e-9)


def test_rests_stay_exact():
    """A dwell of the frame is an arc about the shaft, its image too."""
    lift = CASES[0].lift()
    assert lift.steady.sum() == 2
    assert np.nansum(lift.radius) == pytest.approx(2 * RADIUS + 160 * math.sin(10 * DEG))


def test_a_formula_tells_itself_where_it_ends():
    assert math.degrees(span_of("20*sin(t/2)**2", DEG)) == pytest.approx(199.4, abs=0.5)
    assert span_of("5*sin(t)*sin(t)", DEG) == pytest.approx(math.pi, abs=1e-15)
    span = span_of("0.25*t", 1.0)
    assert span == pytest.approx(4 * math.pi / 3, abs=1e-14)
    assert span_of("0.6*t", 1.0) == pytest.approx(2 * math.pi)  # it would have to swing for ever


def moved(by, over, law="cycloidal", span=None):
    rest = (span if span is not None else 180 + by) - over
    steps = [Move(over * DEG, named(law), by=by * DEG), *([Dwell(rest * DEG)] if rest else [])]
    return programme(steps, (over + rest) * DEG, around=None)


def beyond(rise, back):
    """A rise, and a part of the way back."""
    strokes = [
        Move(120.0 * DEG, named("cycloidal"), by=rise * DEG),
        Move((60.0 + rise - back) * DEG, named("cycloidal"), by=-back * DEG),
    ]
    return programme(strokes, (180.0 + rise - back) * DEG, around=None)


@pytest.mark.parametrize(
    ("make", "links", "told"),
    [
        (
            lambda: moved(20.0, 140.0, span=180.0),
            (80.0, 0.0),
            "covers 180 degrees of the shaft; let it cover 200, 180 and",
        ),
        # 20 degrees by a velocity of 2 over 70: 0.571 of the shaft's
        (lambda: moved(20.0, 70.0), (80.0, 0.0), "0.571429 of its speed at 35 degrees; from 0.5 on"),
        (lambda: moved(20.0, 30.0), (80.0, 0.0), "1.33333 of its speed at 15 degrees"),
        (lambda: moved(100.0, 270.0), (80.0, 55.0), "cannot swing by 100 degrees on links of these lengths"),
        (lambda: beyond(50.0, 20.0), (20.0, 18.0), "so far that its loop does not close, near a shaft angle of"),
        (
            lambda: moved(20.0, 140.0, "parabolic"),
            (80.0, 85.0),
            r"cannot swing on links of these lengths: give a ground",
        ),
        (lambda: moved(170.0, 200.0), (80.0, 85.0), "a ground above 11189"),
    ],
)
def test_swings_that_cannot_be(make, links, told):
    with pytest.raises(IntentError, match=told) as caught:
        frame_swing(make(), links[0], links[1], 1.0)
    assert caught.value.field == "swing"


@pytest.mark.slow
@pytest.mark.parametrize(
    ("rise", "ground", "rocker", "does"),
    [
        (9.068, 80.0, 79.5, True),  # below 2 acos(sqrt(79.5/80)), above which psi would pass 90 degrees
        (9.07, 80.0, 79.5, False),
        (15.0, 106.821, 105.0, True),
        (15.0, 106.819, 105.0, False),
        (15.0, 80.0, 78.636, True),
        (15.0, 80.0, 78.638, False),
    ],
)
def test_the_bounds_that_a_refusal_names_are_where_it_ends(rise, ground, rocker, does):
    told = None
    try:
        frame_swing(moved(rise, 0.75 * (180.0 + rise)), ground, rocker, 1.0)
    except IntentError as error:
        told = error.message
    assert ("cannot swing" in str(told)) is not does
    if not does:
        most, above, within = (float(x) for x in re.findall(r"(?:than|above|within) ([0-9.]+)", told))
        assert most == pytest.approx(2 * math.degrees(math.acos(math.sqrt(rocker / ground))), rel=1e-8)
        assert above == pytest.approx(rocker / math.cos(0.5 * rise * DEG) ** 2, rel=1e-8)
        assert within == pytest.approx(ground * math.cos(0.5 * rise * DEG) ** 2, rel=1e-8)


def test_velocities_at_the_ends_are_each_others_image():
    """Half of a wave: without a rest, psi' = -c/(1 - 2 c) at the end for c at the beginning, on an oscillating yoke."""
    from kin.law.formula.formula import Formula
    from kin.law.sources.whole_turn import from_formula

    good = from_formula(Formula("0.1*sin(t)"), math.pi, around=None)
    with pytest.raises(
        IntentError, match=r"is 0.1 of the shaft's at its beginning, so it must be -0.125 at its end, 180"
    ):
        frame_swing(good, 80.0, 0.0, 1.0)
    # a cubic with these slopes at both ends, and no net rise
    met = from_formula(Formula("0.1*t*(1 - t/pi)*(1 + 0.25*t/pi)"), math.pi, around=None)
    law = frame_swing(met, 80.0, 0.0, 1.0)
    lift = lift_constant_breadth(RADIUS, law.half_turn, "swing")
    slopes = lift.derivatives(np.array([0.0, math.pi, math.pi, 2 * math.pi]), 1, np.array([1, -1, 1, -1]))[1]
    assert slopes[0] == pytest.approx(slopes[3], abs=1e-12)
    assert slopes[1] == pytest.approx(slopes[2], abs=1e-12)
    assert slopes[0] == pytest.approx(-slopes[1], abs=1e-12)


def test_two_swings_are_not_mistaken_for_one_another():
    """What a law over the relative angle, or the same law for the way back, would be: both are far off."""
    case = CASES[0]
    phi = np.array([200.0, 230.0, 260.0, 320.0]) * DEG
    found = case.law().output(phi, 0).c[0]
    same_way_back = case.law().output(phi - 200 * DEG, 0).c[0]
    assert np.abs(found - (math.pi - same_way_back)).max() > 2 * DEG
