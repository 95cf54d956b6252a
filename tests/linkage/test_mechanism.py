"""Mechanisms driven by a cam: against a polygon in a rigid frame, dense samples, and perturbed mechanisms."""

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from support.cases import examples, few
from support.sensitivity import sensitivity

from kin.law.formula.formula import Formula
from kin.law.from_formula import lift_from_formula
from kin.law.normalised import IntentError
from kin.law.support_function import lift_from_fourier, lift_hypocycloid, lift_reuleaux
from kin.linkage.dyad import RPR, RRP, RRR
from kin.linkage.four_bar import FourBar, InvertedSliderCrank, SliderCrank
from kin.linkage.loop import BindingError
from kin.linkage.mechanism import Mechanism, PlaceError
from kin.numeric.elementary import Jet
from kin.numeric.extrema import extremes

TURN = 2 * math.pi
DEGREE = math.pi / 180
CAM_2A = Formula("sin(3*t) + 13/15*sin(3*t)*cos(2*t) + 25")
EVERY = np.linspace(0, TURN, 3001)

LINKAGES: dict[str, Any] = {
    "four-bar": FourBar(80.0, 70.0, 105.0),
    "four-bar, crossed": FourBar(80.0, 70.0, 105.0, "crossed"),
    "inverted slider-crank": InvertedSliderCrank(130.0, 70.0),
    "inverted slider-crank, crossed": InvertedSliderCrank(130.0, 70.0, "crossed"),
    "oscillating yoke": InvertedSliderCrank(90.0, 0.0),
    "slider-crank": SliderCrank(100.0, 20.0),
    "slider-crank, crossed": SliderCrank(100.0, 20.0, "crossed"),
    "four-bar, joint off": FourBar(80.0, 70.0, 105.0, "open", 8.0),
    "inverted slider-crank, joint off": InvertedSliderCrank(130.0, 50.0, "crossed", -12.0),
    "slider-crank, joint off": SliderCrank(100.0, 20.0, "open", -9.0),
}
SIX_BAR = (
    RRR("coupler", (10.0, 25.0), (160.0, 40.0), (110.0, 90.0), "open"),
    RRP("previous", (60.0, 5.0), 80.0, (140.0, 0.0), 1.2, "open"),
)


def cam_2a(x=18.0, y=8.5):
    return lift_from_formula(CAM_2A, (x, y))


def mechanism(linkage=LINKAGES["four-bar"], pivot=(18.0, 8.5), dyads=()):
    return Mechanism(linkage, cam_2a(*pivot), 50.0, dyads)


@pytest.fixture(params=LINKAGES.values(), ids=LINKAGES)
def driven(request):
    return mechanism(request.param)


# The paper's mechanisms, and THEORY's figures


def test_the_paper_s_dwell():
    (first, second, *_rest) = mechanism().dwells(0.1 * DEGREE, "relative")
    assert first.length / DEGREE == pytest.approx(45.17, abs=0.005)
    assert (first.start / DEGREE, first.end / DEGREE) == pytest.approx((269.0, 314.2), abs=0.05)
    assert second.length < 0.5 * first.length
    (over_shaft, *_rest) = mechanism().dwells(0.1 * DEGREE)
    assert over_shaft.length / DEGREE == pytest.approx(37.05, abs=0.01)
    assert over_shaft.least == pytest.approx(first.least, abs=1e-12), "the same window of the output"


def test_the_shaft_turns_back_before_a_four_bar_binds():
    mobile = mechanism(FourBar(80.0, 70.0, 160.0)).mobility()
    assert not mobile.turns
    ((begin, end),) = mobile.binds
    assert (begin / DEGREE, end / DEGREE) == pytest.approx((73.4, 151.5), abs=0.05)
    ((back, until),) = mobile.reverses
    assert back / DEGREE == pytest.approx(59.8, abs=0.05)
    assert until == pytest.approx(begin, abs=1e-6)
    assert mobile.margin < 0
    assert math.isnan(mobile.least_rate)


def test_the_shaft_turns_back_where_no_loop_binds():
    mobile = mechanism(InvertedSliderCrank(20.0, 0.0)).mobility()
    assert mobile.margin > 0
    assert not mobile.binds
    assert mobile.least_rate == pytest.approx(-0.20, abs=0.005)
    assert not mobile.turns
    assert len(mobile.reverses) == 2


# A polygon in a rigid square frame, independent of all else: support and circles alone


class Polygon:
    """Cam 2a as the hull of many of its points, about the shaft; a frame found by bisection at a shaft angle."""

    def __init__(self, pivot, corners=40000):
        t = np.arange(corners) * (TURN / corners)
        p = np.sin(3 * t) * (1 + 13 / 15 * np.cos(2 * t)) + 25
        slope = 3 * np.cos(3 * t) * (1 + 13 / 15 * np.cos(2 * t)) - 26 / 15 * np.sin(3 * t) * np.sin(2 * t)
        u, n = np.array([np.cos(t), np.sin(t)]), np.array([-np.sin(t), np.cos(t)])
        self.points = p * u + slope * n - np.array(pivot)[:, None]

    def reach(self, direction):
        return (np.array([math.cos(direction), math.sin(direction)]) @ self.points).max()

    def joint(self, frame, turned, linkage):
        """D, for the frame's direction and a cam turned clockwise."""
        face1, face2 = self.reach(frame + math.pi / 2 + turned), self.reach(frame + math.pi + turned)
        u, n = np.array([math.cos(frame), math.sin(frame)]), np.array([-math.sin(frame), math.cos(frame)])
        return (50 + linkage.coupler - face2) * u + (face1 - 25 + linkage.joint_offset) * n

    def frame(self, miss, low, high):
        """Direction of the frame at which `miss` of the joint vanishes, between low and high."""
        sign = miss(low) > 0
        assert sign != (miss(high) > 0)
        for _ in range(60):
            middle = 0.5 * (low + high)
            low, high = (middle, high) if (miss(middle) > 0) == sign else (low, middle)
        return 0.5 * (low + high)


@pytest.mark.thin(4)
@pytest.mark.parametrize("kind", ["four-bar", "slider-crank", "four-bar, joint off", "slider-crank, joint off"])
def test_a_polygon_in_a_rigid_frame(kind):
    """At given shaft angles, where only the direction of the frame is unknown."""
    linkage, swings = LINKAGES[kind], kind.startswith("four-bar")
    of, polygon = mechanism(linkage), Polygon((18.0, 8.5))
    start = of.at(0.0, 0).frame[0, 0] + math.pi / 2
    for shaft in (0.0, 0.7, 1.9, 3.3, 4.4, 5.9):
        turned = shaft - start

        def miss(frame, turned=turned):
            x, y = polygon.joint(frame, turned, linkage)
            return math.hypot(x - 80, y) - 105 if swings else y - 20

        expected = of.at(of.relative(shaft), 0)
        low, high = (0.5, 2.2) if swings else (-0.6, 0.9)
        frame = polygon.frame(miss, low, high)
        x, y = polygon.joint(frame, turned, linkage)
        output = math.atan2(y, 80 - x) if swings else x
        assert frame == pytest.approx(expected.frame[0, 0], abs=1e-7)
        assert output == pytest.approx(expected.output[0, 0], abs=1e-7 if swings else 1e-5)


# The shaft angle


@pytest.mark.thin(8)
def test_shaft_angle_and_its_inverse(driven):
    shaft = np.linspace(-20, 20, 777)
    theta = driven.relative(shaft)
    at = driven.at(theta, 1)
    assert np.abs(at.shaft[0] - shaft).max() < 2e-14
    assert (np.diff(theta) > 0).all()
    assert driven.at(0.0, 0).shaft[0, 0] == 0
    assert at.shaft[1] == pytest.approx(1 - at.frame[1])
    assert driven.relative(shaft + TURN) == pytest.approx(theta + TURN, abs=1e-13)
    size = max(1.0, np.abs(driven.at(theta, 0).output[0]).max())
    assert np.abs(driven.output(shaft) - driven.at(theta, 0).output[0]).max() < 1e-14 * size


@pytest.mark.thin(2)
@pytest.mark.parametrize("loop", [LINKAGES["four-bar"], InvertedSliderCrank(80.0, 0.0)], ids=["four-bar", "yoke"])
def test_either_limit_of_a_loop_is_followed_by_itself(monkeypatch, loop):
    """The nearer of two limits has a kink where they change places, on which cells would be halved thirty times."""
    of = mechanism(loop)
    margins, counts = of.chain.margins, []

    def counted(*arguments):
        rows = margins(*arguments)
        counts.append(rows.shape)
        return rows

    monkeypatch.setattr(type(of.chain), "margins", lambda _self, *arguments: counted(*arguments))
    assert of.mobility().turns
    assert len(counts) <= 6
    assert {rows for rows, _ in counts} == {2}


@pytest.mark.thin(8)
def test_derivatives_over_the_shaft_are_those_of_the_output_at_shaft_angles(driven):
    shaft, step = np.linspace(0.1, 6.1, 13), 1e-3

    def output(x):
        return driven.at(driven.relative(x), 0).output[0]

    at = driven.at(driven.relative(shaft), 3)
    over = at.over_shaft(at.output)
    away = [output(shaft + k * step) for k in (-2, -1, 0, 1, 2)]
    first = (away[0] - 8 * away[1] + 8 * away[3] - away[4]) / (12 * step)
    second = (-away[0] + 16 * away[1] - 30 * away[2] + 16 * away[3] - away[4]) / (12 * step**2)
    scale = np.abs(over).max(axis=1)
    assert over[0] == pytest.approx(away[2])
    assert np.abs(over[1] - first).max() < 1e-8 * scale[1]
    assert np.abs(over[2] - second).max() < 1e-6 * scale[2]
    assert at.over_shaft(at.shaft)[:, 3] == pytest.approx([shaft[3], 1, 0, 0], abs=1e-12)


def test_breaks_are_those_of_both_faces_and_sides_differ_there():
    of = Mechanism(LINKAGES["four-bar"], lift_reuleaux(3, 50.0, 2.0, (4.0, 3.0)), 50.0)
    assert of.breaks == pytest.approx(np.arange(12) * math.pi / 6, abs=1e-12)
    right, left = of.at(of.breaks, 2), of.at(of.breaks, 2, side=-1)
    assert right.output[:2] == pytest.approx(left.output[:2], abs=1e-12)
    assert (np.abs(right.output[2] - left.output[2]) > 1e-3).all()
    away = 1e-7
    assert right.output[2] == pytest.approx(of.at(of.breaks + away, 2).output[2], abs=1e-4)
    assert left.output[2] == pytest.approx(of.at(of.breaks - away, 2).output[2], abs=1e-4)
    # the greatest acceleration is a limit at a break
    figures = of.figures()
    assert np.abs(of.breaks - figures.acceleration.relative).min() < 1e-9
    at_breaks = np.concatenate([m.over_shaft(m.output)[2] for m in (right, left)])
    assert abs(figures.acceleration.value) == pytest.approx(np.abs(at_breaks).max(), rel=1e-10)
    assert of.relative(np.linspace(0, 6, 50)) == pytest.approx(
        [float(of.relative(x)[0]) for x in np.linspace(0, 6, 50)], abs=1e-14
    )


# Forces


def test_force_angle_vanishes_exactly_where_the_shaft_stands_still():
    of = mechanism(InvertedSliderCrank(20.0, 0.0))
    still = np.array(of.mobility().reverses).ravel()
    s, s1 = (Jet(rows) for rows in of.at(still, 1).faces)
    sine, cosine = of.linkage.force_angle(of.linkage.solve(s, s1, 50.0), s.c[1], s1.c[1])
    assert np.abs(of.at(still, 1).shaft[1]).max() < 1e-10
    assert np.abs(sine).max() < 1e-10
    assert np.abs(cosine) == pytest.approx(1)


pivots = st.tuples(st.floats(-15, 15), st.floats(-15, 15))
assemblies = st.sampled_from(["open", "crossed"])
asides = st.just(0.0) | st.floats(-50, 50)
linkages = st.one_of(
    st.builds(FourBar, st.floats(20, 200), st.floats(10, 200), st.floats(20, 250), assemblies, asides),
    st.builds(InvertedSliderCrank, st.floats(10, 200), st.floats(0, 200), assemblies, asides),
    st.builds(SliderCrank, st.floats(10, 200), st.floats(-80, 80), assemblies, asides),
)


def close(of, theta):
    """Those of the relative angles at which the linkage is well away from binding."""
    s, s1 = (of.lift.derivatives(theta + k, 0)[0] for k in (0, math.pi / 2))
    return theta[of.linkage.margins(s, s1, of.breadth).min(axis=0) > 1e-3]


@pytest.mark.slow
@settings(max_examples=examples(60))
@given(linkages, pivots)
def test_the_line_of_force_pushes_the_output_on(linkage, pivot):
    """It passes P, does no negative work on the output link, and its lever about the pivot is that of the angle."""
    of = mechanism(linkage, pivot)
    theta = close(of, np.linspace(0, 6.2, 40))
    s, s1 = (Jet(of.lift.derivatives(theta + k, 1)) for k in (0, math.pi / 2))
    at = linkage.solve(s, s1, 50.0)
    (px, py), line = at.instant_centre(s.c[1], s1.c[1]), linkage.force_line(at, s.c[1], s1.c[1])
    reach = 1 + np.hypot(line.x - px, line.y - py)
    certain = reach > 1.001
    assert np.hypot(line.along_x, line.along_y)[certain] == pytest.approx(1)
    assert ((line.x - px) * line.along_y - (line.y - py) * line.along_x) / reach == pytest.approx(0, abs=1e-9)
    link, sine = linkage.output_link(at), np.abs(linkage.force_angle(at, s.c[1], s1.c[1])[0])
    if link.direction is None:
        lever, rate = line.along_x, link.origin[0].c[1]
    else:
        bx, by = (row.c[0] for row in linkage.joints(at)["B"].place.origin)
        arm = linkage.rocker if linkage.joined == "frame" else np.hypot(px - bx, py - by)
        certain &= arm > 1e-3
        lever = ((line.x - bx) * line.along_y - (line.y - by) * line.along_x) / np.maximum(arm, 1e-3)
        rate = link.direction.c[1]
    assert (lever * rate >= -1e-12 * np.abs(rate)).all()
    assert np.abs(lever)[certain] == pytest.approx(sine[certain], abs=1e-6)


@pytest.mark.slow
@settings(max_examples=examples(60))
@given(linkages, pivots)
def test_the_rate_of_the_shaft_is_the_lever_of_the_force_on_the_output(linkage, pivot):
    """phi' = lever of P / lever of the shaft, whatever the linkage: virtual work, from forces alone."""
    of = mechanism(linkage, pivot)
    theta = close(of, np.linspace(0, 6.2, 40))
    s, s1 = (Jet(of.lift.derivatives(theta + k, 1)) for k in (0, math.pi / 2))
    at = linkage.solve(s, s1, 50.0)
    rate = 1 - at.frame.c[1]
    sine, cosine = linkage.force_angle(at, s.c[1], s1.c[1])
    assert np.hypot(sine, cosine) == pytest.approx(1)
    certain = np.abs(rate) > 1e-9
    assert (np.sign(sine) == np.sign(rate))[certain].all()
    (dx, dy), frame = (row.c[0] for row in at.joint), at.frame.c[0]
    u, n = np.array([np.cos(frame), np.sin(frame)]), np.array([-np.sin(frame), np.cos(frame)])
    px, py = -s.c[1] * u - s1.c[1] * n
    if isinstance(linkage, FourBar):
        size, arm = np.hypot(dx - px, dy - py) * linkage.rocker, np.abs(dy) * linkage.ground
    elif isinstance(linkage, InvertedSliderCrank):
        size, arm = np.hypot(linkage.ground - px, -py), np.abs(linkage.ground * u[0])
    else:
        size, arm = np.hypot(dx - px, dy - py), np.abs(dx)
    assert sine * size == pytest.approx(rate * arm, rel=1e-7, abs=1e-7 * np.max(size, initial=1.0))


# Mobility


@settings(max_examples=examples(60))
@given(linkages, pivots)
def test_mobility_against_dense_samples(linkage, pivot):
    of = mechanism(linkage, pivot)
    mobile = of.mobility()
    s, s1 = (of.lift.derivatives(EVERY + k, 0)[0] for k in (0, math.pi / 2))
    margin = linkage.margins(s, s1, 50.0).min(axis=0)
    assert mobile.margin <= margin.min() + 1e-9
    assert mobile.margin == pytest.approx(margin.min(), abs=1e-3)
    assert mobile.loop == 0
    assume(abs(mobile.margin) > 1e-6)
    inside = within(mobile.binds, EVERY)
    assert ((margin < 0) == inside)[np.abs(margin) > 1e-6].all()
    for end in np.ravel(mobile.binds) if mobile.margin_at and len(mobile.binds) and not inside.all() else ():
        s, s1 = (of.lift.derivatives(end + k, 0)[0] for k in (0, math.pi / 2))
        assert abs(linkage.margins(s, s1, 50.0).min(axis=0)[0]) < 1e-9
    theta = close(of, EVERY)
    if not len(theta):
        return
    rate = 1 - np.concatenate([linkage.solve(*lifts(of, theta), 50.0).frame.c[1]])
    assert ((rate < 0) == within(mobile.reverses, theta))[np.abs(rate) > 1e-6].all()
    if not mobile.binds:
        assert mobile.least_rate <= rate.min() + 1e-9
        assert mobile.turns == (mobile.least_rate > 0)
        at = mobile.rate_at
        assert mobile.least_rate == pytest.approx(1 - linkage.solve(*lifts(of, np.array([at])), 50.0).frame.c[1, 0])


def lifts(of, theta):
    return tuple(Jet(of.lift.derivatives(theta + k, 1)) for k in (0, math.pi / 2))


def within(spans, theta):
    found = np.zeros(len(theta), dtype=bool)
    for begin, end in spans:
        assert begin <= end <= begin + TURN
        found |= (theta - begin) % TURN <= end - begin
        found |= end - begin == TURN
    return found


def test_a_linkage_that_nowhere_closes_binds_all_round():
    of = mechanism(FourBar(500.0, 10.0, 20.0))
    mobile = of.mobility()
    assert mobile.binds == ((0.0, TURN),)
    assert mobile.reverses == ()
    assert not mobile.turns
    with pytest.raises(PlaceError, match=r"relative angle of 57\.2958 degrees") as refused:
        of.at(1.0, 2)
    assert refused.value.at == 1.0


def test_what_does_not_turn_says_where():
    of = mechanism(FourBar(80.0, 70.0, 160.0))
    with pytest.raises(PlaceError, match="do not reach") as refused:
        of.at(np.array([0.1, 1.9, 2.0]), 1)
    assert refused.value.at == 1.9
    assert refused.value.indices.tolist() == [1, 2]
    assert isinstance(refused.value, BindingError)
    for ask in (of.figures, lambda: of.relative(1.0), lambda: of.dwells(0.01)):
        with pytest.raises(PlaceError, match=r"a loop cannot be closed, at a relative angle of 116\.578 degrees"):
            ask()
    with pytest.raises(PlaceError, match="turn back, at a relative angle of 320"):
        mechanism(InvertedSliderCrank(20.0, 0.0)).relative(0.3)


@pytest.mark.thin(6)
@pytest.mark.parametrize("gap", few([1e-3, 1e-6, 1e-9, 1e-13, 0.0, -1e-13, -1e-9, -1e-6], 2))
@pytest.mark.parametrize("limit", ["drawn in", "stretched"])
def test_mobility_close_to_a_limit_position(gap, limit):
    """Links that miss their limit by a gap, or overlap by it: the margin is the gap, and nothing is raised."""
    nearest, farthest = 76.59532940170207, 113.42503701566515  # AD with a coupler of 70
    of = mechanism(FourBar(80.0, 70.0, 80 + nearest - gap if limit == "drawn in" else farthest + gap - 80))
    mobile = of.mobility()
    assert mobile.margin == pytest.approx(gap, abs=2e-13)
    assert mobile.loop == 0
    if abs(gap) >= 1e-9:
        assert mobile.turns == (gap > 0)
        assert len(mobile.binds) == (gap < 0)
        for begin, end in mobile.binds:
            assert begin < mobile.margin_at < end
    else:
        assert not mobile.turns


# Figures


@pytest.mark.thin(12)
def test_figures_against_dense_samples(driven):
    figures = driven.figures()
    theta = np.linspace(0, TURN, 20001)
    at = driven.at(theta, 2)
    over = at.over_shaft(at.output)
    for place, row, sense in (
        (figures.least, at.output[0], np.min),
        (figures.greatest, at.output[0], np.max),
        (figures.frame_least, at.frame[0], np.min),
        (figures.frame_greatest, at.frame[0], np.max),
        (figures.velocity, over[1], largest),
        (figures.acceleration, over[2], largest),
        (figures.velocity_relative, at.output[1], largest),
        (figures.acceleration_relative, at.output[2], largest),
    ):
        scale = np.abs(row).max()
        found = abs(place.value) if sense is largest else place.value
        assert found == pytest.approx(sense(row), abs=3e-7 * scale)
        assert (found <= sense(row) + 1e-11 * scale) if sense is np.min else (found >= sense(row) - 1e-11 * scale)
        there = driven.at(place.relative, 0)
        assert math.remainder(there.shaft[0, 0] - place.shaft, TURN) == pytest.approx(0, abs=1e-12)
    assert figures.swing == pytest.approx(np.ptp(at.output[0]), rel=1e-6)
    assert figures.frame_greatest.value - figures.frame_least.value == pytest.approx(np.ptp(at.frame[0]), rel=1e-6)
    value = driven.at(figures.velocity.relative, 1)
    assert value.over_shaft(value.output)[1, 0] == pytest.approx(figures.velocity.value, rel=1e-11)
    assert [place.value for place in figures.dead_centres] == [0, 0]
    for place in figures.dead_centres:
        assert driven.at(place.relative, 0).faces[0, 0, 0] == pytest.approx(25 - driven.linkage.joint_offset, abs=1e-12)


def test_dead_centres_on_either_side_of_zero_are_all_told():
    places = Mechanism(LINKAGES["four-bar"], lift_hypocycloid(3, 1.0, 50.0), 50.0).figures().dead_centres
    assert [place.relative / DEGREE for place in places] == pytest.approx([30, 90, 150, 210, 270, 330], abs=1e-9)


def largest(row):
    return np.abs(row).max()


def test_figures_are_those_of_the_extremes_module():
    of = mechanism()
    ends = np.linspace(0, TURN, 25)

    def velocity(theta, _of=None):
        at = of.at(theta, 3)
        return Jet(at.output / [[1], [1], [2], [6]]).derivative().derivatives()

    found = extremes(ends[:-1], ends[1:], velocity(ends[:-1]), velocity(ends[1:]), velocity, resolution=1e-13)
    assert of.figures().velocity_relative.value == pytest.approx(found.worst[0], abs=2e-13)
    assert of.figures().velocity_relative.relative == pytest.approx(found.worst[1], abs=1e-6)


@pytest.mark.slow
def test_transmission_angles_from_the_positions():
    of = mechanism()
    figures = of.figures()
    at = of.at(EVERY, 0)
    rocker = np.arctan2(at.joint[1, 0], at.joint[0, 0] - 80)
    angle = np.abs(np.arcsin(np.sin(rocker - at.frame[0])))
    assert figures.transmission_least.value == pytest.approx(angle.min(), abs=1e-5)
    assert figures.transmission_greatest.value == pytest.approx(angle.max(), abs=1e-5)
    slide = mechanism(LINKAGES["slider-crank"])
    angle = np.abs(np.arctan2(np.cos(slide.at(EVERY, 0).frame[0]), np.sin(slide.at(EVERY, 0).frame[0])))
    assert slide.figures().transmission_least.value == pytest.approx(angle.min(), abs=1e-5)
    yoke = mechanism(LINKAGES["oscillating yoke"]).figures()
    assert yoke.transmission_least.value == yoke.transmission_greatest.value == math.pi / 2


def test_a_transmission_angle_through_90_degrees():
    """Where the frame stands square on the rocker the greatest is 90 degrees itself, not a sample close to it."""
    of = mechanism(FourBar(139.0, 76.0, 97.0), pivot=(2.0, 1.0))
    assert of.mobility().turns
    figures = of.figures()
    at = of.at(figures.transmission_greatest.relative, 0)
    assert figures.transmission_greatest.value == pytest.approx(math.pi / 2, abs=1e-9)
    assert abs(math.cos(float(at.frame[0, 0] + at.output[0, 0]))) < 1e-9


def test_a_round_cam_about_its_centre_stands_still_and_rests_on_the_dead_centre():
    of = Mechanism(LINKAGES["four-bar"], lift_from_fourier(25.0, {}, {}), 50.0)
    figures = of.figures()
    assert figures.swing < 1e-13
    assert figures.velocity.value == 0
    assert [place.relative for place in figures.dead_centres] == [0.0]
    (whole,) = of.dwells(1e-4)
    assert whole.length == TURN
    assert of.mobility().least_rate == 1


# Other lifts


@pytest.mark.slow
@pytest.mark.parametrize(
    ("kind", "dyads"),
    few([*((kind, ()) for kind in LINKAGES), ("four-bar", SIX_BAR), ("oscillating yoke", SIX_BAR)], 3),
)
def test_other_lifts_drive_it_as_perturbed_mechanisms(kind, dyads):
    of = mechanism(LINKAGES[kind], dyads=dyads)
    step = 1e-4
    for theta in (0.3, 2.0, 4.7):
        at = of.at(theta, 1)
        for k in (0, 1):
            outputs = []
            for off in (-step, step):
                turned = theta
                for _ in range(30):  # the relative angle at which the perturbed mechanism's shaft is where it was
                    s, s1 = lifts(of, np.array([turned]))
                    (s, s1) = (s + off, s1) if k == 0 else (s, s1 + off)
                    frame, output = of.driven(s, s1)
                    shaft = turned - frame.c[0, 0] + of.start
                    turned -= (shaft - at.shaft[0, 0]) / (1 - frame.c[1, 0])
                outputs.append(output.c[0, 0])
            expected = (outputs[1] - outputs[0]) / (2 * step)
            assert sensitivity(of, theta)[k, 0] == pytest.approx(expected, rel=1e-6, abs=1e-8)


# Further links


def test_a_six_bar_and_a_slide_on_it():
    of = mechanism(dyads=SIX_BAR)
    assert of.outputs == 3
    assert of.unit == "mm"
    mobile = of.mobility()
    assert mobile.turns
    assert mobile.margin <= mechanism().mobility().margin
    shaft = np.linspace(0, 6, 9)
    at = of.at(of.relative(shaft), 2)
    assert len(at.outputs) == 3
    assert at.outputs[0] == pytest.approx(mechanism().at(at.theta, 2).output)
    # the six-bar's own loop: P on the frame, Q at the end of the second bar
    d, frame = at.joint[:, 0], at.frame[0]
    p = d + np.array([10 * np.cos(frame) - 25 * np.sin(frame), 10 * np.sin(frame) + 25 * np.cos(frame)])
    direction = np.array([np.cos(at.outputs[1][0]), np.sin(at.outputs[1][0])])
    q = np.array([[160.0], [40.0]]) + 90 * direction
    assert np.hypot(*(q - p)) == pytest.approx(110, abs=1e-11)
    hung = np.array([[160.0], [40.0]]) + 60 * direction + 5 * np.array([-direction[1], direction[0]])
    slide = np.array([[140.0], [0.0]]) + at.output[0] * np.array([[math.cos(1.2)], [math.sin(1.2)]])
    assert np.hypot(*(slide - hung)) == pytest.approx(80, abs=1e-11)
    figures = of.figures()
    assert figures.swing == pytest.approx(np.ptp(of.at(EVERY, 0).output[0]), rel=1e-6)


def test_a_dyad_that_binds_is_named():
    of = mechanism(dyads=(SIX_BAR[0], RRP("previous", (60.0, 5.0), 1.0, (140.0, 0.0), 1.2, "open")))
    mobile = of.mobility()
    assert mobile.loop == 2
    assert mobile.margin < 0
    assert mobile.binds
    assert mobile.least_rate > 0, "the linkage itself turns"
    with pytest.raises(PlaceError):
        of.figures()


def test_a_slotted_rocker():
    of = mechanism(dyads=(RPR("coupler", (0.0, 10.0), (150.0, 150.0), 3.0),))
    assert of.mobility().turns
    assert np.ptp(of.at(EVERY, 0).output[0]) < 2.0
    assert np.abs(np.diff(of.at(EVERY, 0).output[0])).max() < 0.1


def test_a_rocker_that_would_go_right_round_is_refused():
    with pytest.raises(IntentError, match="dyad 1 is attached to circles") as refused:
        mechanism(dyads=(RPR("coupler", (-60.0, 20.0), (-6.0, 40.0), 0.0),))
    assert refused.value.field == "dyads"


def test_the_first_dyad_has_no_previous_one():
    with pytest.raises(ValueError, match="no previous one"):
        mechanism(dyads=(RRP("previous", (0.0, 0.0), 50.0, (0.0, 0.0), 0.0, "open"),))


# Refusals


def test_the_shaft_must_lie_within_the_cam():
    with pytest.raises(IntentError, match="the shaft lies outside the cam, by 15") as refused:
        mechanism(pivot=(40.0, 8.5))
    assert refused.value.field == "shaft"
    assert refused.value.at_deg == pytest.approx(4.47, abs=0.01)
    on_the_edge = lift_hypocycloid(3, 1.0, 50.0, (26.0, 0.0))
    assert Mechanism(FourBar(80.0, 120.0, 160.0), on_the_edge, 50.0).mobility().margin
    with pytest.raises(IntentError, match="outside"):
        Mechanism(FourBar(80.0, 120.0, 160.0), lift_hypocycloid(3, 1.0, 50.0, (26.000001, 0.0)), 50.0)


def test_the_cam_must_be_of_the_frame_s_breadth():
    with pytest.raises(
        IntentError, match=r"p\(t\) \+ p\(t \+ 180 deg\) is 50 mm at [0-9.]+ degrees, .* 50\.001 mm"
    ) as refused:
        Mechanism(LINKAGES["four-bar"], cam_2a(), 50.001)
    assert refused.value.field == "p"
    with pytest.raises(IntentError, match="constant breadth") as refused:
        Mechanism(LINKAGES["four-bar"], lift_from_fourier(25.0, {2: 1e-6}, {}), 50.0)
    assert refused.value.field == "p"


def test_the_shaft_angle_is_inverted_where_newton_s_method_creeps():
    """With a rate six times too great a step covers a sixth of the way: 60 of them would leave a hundred thousandth."""

    class Steep(Mechanism):
        def at(self, theta, order, side=1):
            found = super().at(theta, order, side)
            found.shaft[1:] *= 6.0
            return found

    of = Steep(LINKAGES["four-bar"], cam_2a(), 50.0)
    shaft = np.linspace(0.01, 6.2, 50)
    assert np.abs(of.at(of.relative(shaft), 0).shaft[0] - shaft).max() < 1e-8


@pytest.mark.parametrize("mean", [-25.0, 0.0])
def test_a_frame_without_breadth_is_refused(mean):
    lift = lift_from_fourier(mean, {}, {}, (10.0, 4.0))
    with pytest.raises(IntentError, match=r"^no frame has a breadth of (-50|0) mm: it must be above 0$"):
        Mechanism(SliderCrank(90.0, 0.0), lift, 2 * mean)
