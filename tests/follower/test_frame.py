"""The frame on a contour: against plain geometry on vertices, closed forms, and dense sampling."""

from functools import partial

import numpy as np
import pytest
from support.camfiles import arcs_through, support_points
from support.cases import few
from support.sensitivity import sensitivity
from support.square_frame import CENTRED, RESTS, Bars, Bench

from kin.contour.contour import Contour
from kin.follower.frame import FrameError, _output, implied_limit, judge_frame
from kin.follower.frame_contact import WAYS, FrameRest
from kin.follower.frame_contact import laid as all_laid
from kin.follower.frame_dwell import Output, _runs, longest_dwells
from kin.follower.support import bearing_of
from kin.law.support_function import lift_from_fourier, lift_reuleaux
from kin.linkage.dyad import RPR
from kin.linkage.four_bar import FourBar, InvertedSliderCrank, SliderCrank
from kin.linkage.mechanism import Mechanism
from kin.numeric.extrema import extremes

TURN = 2 * np.pi
BREADTH = 50.0
# AS Figure 2a about (18, 8.5): 25 + sin 3t + 13/15 sin 3t cos 2t
COS, SIN = {1: -18.0}, {1: 13 / 30 - 8.5, 3: 1.0, 5: 13 / 30}
HARMONICS = ((1, -18.0, 13 / 30 - 8.5), (3, 0.0, 1.0), (5, 0.0, 13 / 30))
LIFT = lift_from_fourier(25.0, COS, SIN)
LINKAGES = {
    "four-bar": (FourBar(80.0, 70.0, 105.0), Bars("four-bar", 80.0, 70.0, 105.0)),
    "four-bar, crossed": (FourBar(80.0, 70.0, 105.0, "crossed"), Bars("four-bar", 80.0, 70.0, 105.0, side=-1)),
    "inverted": (InvertedSliderCrank(60.0, 20.0), Bars("inverted", 60.0, rocker=20.0)),
    "yoke, crossed": (InvertedSliderCrank(60.0, 0.0, "crossed"), Bars("inverted", 60.0, side=-1)),
    "slider": (SliderCrank(90.0, 15.0), Bars("slider", coupler=90.0, offset=15.0)),
    "four-bar, off": (
        FourBar(80.0, 70.0, 105.0, joint_offset=-9.0),
        Bars("four-bar", 80.0, 70.0, 105.0, aside=-9.0),
    ),
    "inverted, off": (
        InvertedSliderCrank(60.0, 10.0, "crossed", 14.0),
        Bars("inverted", 60.0, rocker=10.0, side=-1, aside=14.0),
    ),
    "slider, off": (SliderCrank(90.0, 15.0, joint_offset=8.0), Bars("slider", coupler=90.0, offset=15.0, aside=8.0)),
    "slider, crossed": (SliderCrank(90.0, -10.0, "crossed"), Bars("slider", coupler=90.0, offset=-10.0, side=-1)),
}
FOUR_BAR = Mechanism(LINKAGES["four-bar"][0], LIFT, BREADTH)
SHAFT = np.arange(360) * TURN / 360


def p(t):
    value = 25.0
    for k, a, b in HARMONICS:
        value = value + a * np.cos(k * t) + b * np.sin(k * t)
    return value


def cam(count, mean=25.0):
    return support_points(count, mean, HARMONICS)


def uneven(count=501, depth=0.02):
    """A cam whose breadth is not constant: every corner off by its own amount."""
    t = np.arange(count) * TURN / count
    off = depth * (np.sin(2 * t) + 0.5 * np.cos(7 * t + 1.0))
    return cam(count) + off[:, None] * np.column_stack([np.cos(t), np.sin(t)])


@pytest.fixture(params=few(LINKAGES, 2))
def pair(request):
    linkage, bars = LINKAGES[request.param]
    return Mechanism(linkage, LIFT, BREADTH), Bench(bars, BREADTH, p)


def laid(mechanism, vertices, rest=WAYS[0]):
    return all_laid(mechanism, bearing_of(Contour.from_vertices(vertices)), [rest])[0]


# --- against plain geometry -------------------------------------------------------------------------------------------


@pytest.mark.slow
def test_outputs_by_vertices(pair):
    """In every way of resting, at given shaft angles: the same output as of the turned vertices in a rigid frame."""
    mechanism, bench = pair
    vertices = uneven()
    for rest in (*(FrameRest(name, *shares) for name, shares in RESTS.items()), FrameRest("centred", *CENTRED)):
        expected = bench.measured(vertices, SHAFT, (rest.first, rest.second))
        found = laid(mechanism, vertices, rest).over_shaft(SHAFT, 0)[0]
        np.testing.assert_allclose(found, expected, rtol=0, atol=1e-11 * max(1.0, np.abs(expected).max()))


@pytest.mark.slow
@pytest.mark.thin(12)
def test_the_verdict_by_vertices(pair):
    """Greatest error, rms, increment and play: nothing that dense sampling finds is missed, and nothing made up."""
    mechanism, bench = pair
    vertices = uneven(257)
    scale = np.degrees(1.0) if mechanism.unit == "deg" else 1.0
    phi = np.arange(360) * TURN / 360
    verdict = judge_frame(Contour.from_vertices(vertices), mechanism, phi, 1e-3)
    meant = bench.intended(phi)
    errors = scale * np.array([bench.measured(vertices, phi, rest) - meant for rest in (*RESTS.values(), CENTRED)])
    sampled = np.abs(errors).max()
    assert sampled <= verdict.error.max * (1 + 1e-9)
    assert verdict.error.max == pytest.approx(sampled, rel=0.2)
    assert verdict.centred.max == pytest.approx(np.abs(errors[-1]).max(), rel=0.2)
    assert verdict.error.rms == pytest.approx(np.sqrt(np.mean(errors**2)), rel=1e-9)
    assert verdict.centred.rms == pytest.approx(np.sqrt(np.mean(errors[-1] ** 2)), rel=1e-9)
    increment = np.abs(np.roll(errors, -1, axis=1) - errors).max()  # the samples are the increment of a degree apart
    assert verdict.error.increment == pytest.approx(increment, rel=1e-9)
    assert verdict.error.unit == verdict.centred.unit == mechanism.unit
    # where the greatest error is said to be, it is
    at = np.radians(verdict.error.at_deg) + np.array([-1e-9, 0.0])
    there = [np.abs(bench.measured(vertices, at, rest) - bench.intended(at)).max() for rest in RESTS.values()]
    assert scale * max(there) == pytest.approx(verdict.error.max, rel=1e-7)


def test_play_by_vertices():
    vertices = uneven(257)
    verdict = judge_frame(Contour.from_vertices(vertices), FOUR_BAR, SHAFT, 1e-3)
    bench = Bench(LINKAGES["four-bar"][1], BREADTH, p)
    across, along = bench.clearances(vertices, np.linspace(0.0, TURN, 20_001))
    for play, sampled in ((verdict.play_across, across), (verdict.play_along, along)):
        assert play.least <= sampled.min() <= play.least + 2e-4
        assert play.most - 2e-4 <= sampled.max() <= play.most
    centred = laid(FOUR_BAR, vertices, FrameRest("centred", *CENTRED))
    for row, play in enumerate((verdict.play_across, verdict.play_along)):
        places = np.radians([play.least_at_deg, play.most_at_deg])
        theta = np.interp(places, centred.shaft, centred.nodes)
        for _ in range(3):
            value, rate = centred.turned(theta, 1)
            theta = theta + (places - value) / rate
        there = bench.clearances(vertices, theta)[row]
        np.testing.assert_allclose(there, [play.least, play.most], atol=1e-9)


@pytest.mark.thin(2)
@pytest.mark.parametrize("size", [2e-5, 2e4])
def test_a_linkage_of_a_micrometre_and_of_a_kilometre(size):
    vertices = uneven(257)
    usual = judge_frame(Contour.from_vertices(vertices), FOUR_BAR, SHAFT, 1e-3)
    lift = lift_from_fourier(25.0 * size, {k: size * a for k, a in COS.items()}, {k: size * b for k, b in SIN.items()})
    scaled = Mechanism(FourBar(80.0 * size, 70.0 * size, 105.0 * size), lift, BREADTH * size)
    verdict = judge_frame(Contour.from_vertices(size * vertices), scaled, SHAFT, 1e-3 * size)
    assert verdict.error.max == pytest.approx(usual.error.max, rel=1e-6)
    for play, other in ((verdict.play_across, usual.play_across), (verdict.play_along, usual.play_along)):
        assert (play.least / size, play.most / size) == pytest.approx((other.least, other.most), abs=1e-11)


@pytest.mark.slow
@pytest.mark.thin(2)
@pytest.mark.parametrize("offset", [-0.01, 0.004])
def test_play_of_a_cam_that_is_smaller_or_larger_all_round(offset):
    vertices, bulges = arcs_through(cam(6000, 25.0 + offset))
    verdict = judge_frame(Contour.from_bulges(vertices, bulges), FOUR_BAR, SHAFT, 0.02)
    for play in (verdict.play_across, verdict.play_along):
        assert play.least == pytest.approx(-2 * offset, abs=1e-7)
        assert play.most == pytest.approx(-2 * offset, abs=1e-7)


# --- true extremes ----------------------------------------------------------------------------------------------------


@pytest.mark.slow
def test_no_error_between_the_samples_is_missed():
    """A coarse polygon errs most at corners and edges: found exactly, from no more than a few shaft angles."""
    vertices = cam(40)
    mechanism = FOUR_BAR
    one = judge_frame(Contour.from_vertices(vertices), mechanism, SHAFT[:1], 0.1).error
    many = judge_frame(Contour.from_vertices(vertices), mechanism, SHAFT, 0.1).error
    assert (one.max, one.at_deg) == (many.max, many.at_deg)
    fine = np.linspace(0.0, TURN, 40_001)
    meant = mechanism.at(mechanism.relative(fine), 0).output[0]
    sampled = max(np.abs(laid(mechanism, vertices, way).over_shaft(fine, 0)[0] - meant).max() for way in WAYS)
    assert np.radians(one.max) >= sampled - 1e-15
    assert np.radians(one.max) == pytest.approx(sampled, rel=1e-3)


@pytest.mark.slow
def test_exact_arcs_give_no_error():
    """A Reuleaux triangle with rounded corners, drawn as its six arcs: its lift jumps in p'' where the arcs meet."""
    lift = lift_reuleaux(3, BREADTH, 6.0)
    mechanism = Mechanism(FourBar(90.0, 70.0, 105.0), lift, BREADTH)
    t = np.arange(6) * np.pi / 3 - np.pi / 6
    value, slope = lift.derivatives(t, 1)
    points = np.column_stack([value * np.cos(t) - slope * np.sin(t), value * np.sin(t) + slope * np.cos(t)])
    contour = Contour.from_bulges(points, np.full(6, np.tan(np.pi / 12)))
    verdict = judge_frame(contour, mechanism, SHAFT, 1e-3)
    assert verdict.error.max < 1e-11
    shifted = Contour.from_bulges(points + np.array([0.003, 0.0]), np.full(6, np.tan(np.pi / 12)))
    bench = Bench(Bars("four-bar", 90.0, 70.0, 105.0), BREADTH, lambda x: float(lift.derivatives(x, 0)[0, 0]))
    fine = shifted.sample(2000)
    expected = bench.measured(fine, SHAFT, RESTS["1 and 2"])
    (way,) = all_laid(mechanism, bearing_of(shifted), WAYS[:1])
    np.testing.assert_allclose(way.over_shaft(SHAFT, 0)[0], expected, atol=2e-8)
    meant = mechanism.at(mechanism.relative(SHAFT), 0).output[0]
    error = judge_frame(shifted, mechanism, SHAFT, 1e-3).error
    assert np.radians(error.max) >= np.abs(expected - meant).max() - 2e-8


def test_derivatives_over_both_angles():
    """Each is the slope of the one before, from the right side of every break."""
    way = laid(FOUR_BAR, uneven(31))
    for f, ends in ((way.over_shaft, way.shaft), (way.over_relative, way.nodes)):
        low, high = ends[:-1], ends[1:]
        right, left = f(low, 2, 1), f(high, 2, -1)
        h = high - low
        wide = h > 1e-3
        # the trapezium rule with its end correction is good to h^5
        for k in (0, 1):
            if k == 0:
                step = h / 2 * (right[1] + left[1]) + h**2 / 12 * (right[2] - left[2])
                np.testing.assert_allclose((left[0] - right[0])[wide], step[wide], atol=1e-12)
            else:
                np.testing.assert_allclose((left[1] - right[1])[wide], (h / 2 * (right[2] + left[2]))[wide], atol=1e-6)
        assert np.abs(left[1][:-1] - right[1][1:]).max() > 1e-2  # polygon: the slopes do jump
    at = np.array([0.0, TURN, -TURN, 3 * TURN])
    np.testing.assert_allclose(way.over_relative(at, 2), np.repeat(way.low[1][:, :1], 4, axis=1), atol=1e-13)
    np.testing.assert_allclose(way.over_relative(at, 2, -1), np.repeat(way.high[1][:, -1:], 4, axis=1), atol=1e-13)


def test_a_corner_held_still_to_the_shafts_least_rate():
    vertices = uneven(61)
    way = laid(FOUR_BAR, vertices)
    fine = np.linspace(0.0, TURN, 50_001)[:-1]
    interval = np.searchsorted(way.nodes, fine, side="right") - 1
    sampled = way.rows(fine, interval)[0, 1].min()
    least, at = way.least_rate
    assert least <= sampled
    assert least == pytest.approx(sampled, abs=1e-4)
    assert judge_frame(Contour.from_vertices(vertices), FOUR_BAR, SHAFT, 0.1).least_rate <= least
    assert 0.0 <= at <= TURN


# --- the limit that the tolerance implies -----------------------------------------------------------------------------


@pytest.mark.thin(2)
@pytest.mark.parametrize("tolerance", [1e-6, 1e-3])
def test_the_limit_is_the_sensitivity_times_the_tolerance(pair, tolerance):
    mechanism, _ = pair
    theta = np.linspace(0.0, TURN, 20_001)
    scale = np.degrees(1.0) if mechanism.unit == "deg" else 1.0
    first_order = scale * tolerance * np.abs(sensitivity(mechanism, theta)).sum(axis=0).max()
    # to second order it differs by a share of the tolerance over the lengths of the links
    assert implied_limit(mechanism, tolerance) == pytest.approx(first_order, rel=max(0.2 * tolerance, 1e-6))


@pytest.mark.slow
@pytest.mark.parametrize("tolerance", few([1e-3, 0.1], 2))
def test_a_parallel_cam_uses_the_whole_limit_and_no_more(pair, tolerance):
    """All round outside by the tolerance: the four ways of resting are the four combinations of signs."""
    mechanism, _ = pair
    vertices, bulges = arcs_through(cam(4000, 25.0 + tolerance))
    error = judge_frame(Contour.from_bulges(vertices, bulges), mechanism, SHAFT[:1], tolerance).error
    limit = implied_limit(mechanism, tolerance)
    assert error.max <= limit * (1 + 1e-5)  # the arcs are off by 1e-8 mm
    assert error.max == pytest.approx(limit, rel=0.05 * tolerance + 1e-5)


def test_no_limit_where_the_mechanism_binds_within_the_tolerance():
    p_least = LIFT.derivatives(np.linspace(0, TURN, 4001), 0)[0].min()
    rocker = 60.0
    reach = p_least - 0.5 * BREADTH  # of Y, at its least: cos theta_4 = (rocker - Y)/ground
    ground = rocker - reach + 0.01
    mechanism = Mechanism(InvertedSliderCrank(ground, rocker), LIFT, BREADTH)
    assert implied_limit(mechanism, 1e-3) is not None
    assert implied_limit(mechanism, 0.02) is None


def test_no_limit_where_a_contour_may_take_a_block_past_its_pivot():
    """The corners of the tolerance lie on either side of the pivot, none on it: an error of 180 degrees is no limit."""
    here = FOUR_BAR.at(1.3, 1)
    x, y = here.joint[:, 0, 0] - 70.0 * np.array([np.cos(here.frame[0, 0]), np.sin(here.frame[0, 0])])
    slide = RPR("coupler", (-70.0, 0.0), (x - 0.03, y - 0.04), 0.0)
    mechanism = Mechanism(FOUR_BAR.linkage, LIFT, BREADTH, (slide,))
    assert 1e-3 < mechanism.mobility().margin < 0.05
    assert 0 < implied_limit(mechanism, 1e-4) < 10
    assert implied_limit(mechanism, 0.05) is None


# --- what does not go round -------------------------------------------------------------------------------------------


def test_a_contour_with_which_the_mechanism_binds():
    """A spike that pushes the frame farther than the yoke's pivot is away."""
    vertices = cam(2000)
    k = int(LIFT.derivatives(np.arange(2000) * TURN / 2000, 0)[0].argmax())
    vertices[k] *= 1.0 + 45.0 / np.hypot(*vertices[k])
    mechanism = Mechanism(InvertedSliderCrank(60.0, 0.0), LIFT, BREADTH)
    with pytest.raises(FrameError, match=r"on faces 1 and 2 the mechanism binds at a relative angle of .* degrees"):
        judge_frame(Contour.from_vertices(vertices), mechanism, SHAFT, 1e-3)


@pytest.mark.slow
def test_a_contour_that_turns_the_shaft_back():
    """The exact cam just turns; over the edges of a coarse polygon the frame swings faster than the shaft turns."""
    mechanism = Mechanism(InvertedSliderCrank(25.0, 0.0), LIFT, BREADTH)
    assert 0.0 < mechanism.mobility().least_rate < 0.1
    fine = judge_frame(Contour.from_vertices(cam(6000)), mechanism, SHAFT, 1e-3)
    assert fine.least_rate == pytest.approx(mechanism.mobility().least_rate, abs=5e-3)
    with pytest.raises(FrameError, match=r"turns the shaft back at a relative angle of .* 1 - theta_3' is -"):
        judge_frame(Contour.from_vertices(cam(20)), mechanism, SHAFT, 1e-3)


# --- dwells -----------------------------------------------------------------------------------------------------------


@pytest.mark.slow
@pytest.mark.parametrize("over", ["shaft", "relative"])
def test_the_dwell_of_the_paper_from_a_file(over):
    """AS Figure 9: about 45 degrees of the relative angle around 3 pi/2; less over the shaft angle."""
    verdict = judge_frame(Contour.from_vertices(cam(4000)), FOUR_BAR, SHAFT, 1e-3, band=np.radians(0.1), over=over)
    shortest = verdict.dwells[0]
    assert shortest.over == over
    assert shortest.band == pytest.approx(0.1)
    assert len(verdict.dwells) == 4
    assert [d.length_deg for d in verdict.dwells] == sorted(d.length_deg for d in verdict.dwells)
    if over == "relative":
        assert shortest.start_deg == pytest.approx(269.0, abs=0.05)
        assert shortest.length_deg == pytest.approx(45.17, abs=0.01)
    else:
        assert shortest.length_deg == pytest.approx(37.05, abs=0.01)
    assert verdict.error.dwell_flatness == pytest.approx(0.1, abs=2 * verdict.error.max)


@pytest.mark.slow
@pytest.mark.parametrize("over", few(["shaft", "relative"], 2))
def test_a_dwell_by_sampling(over):
    """On a spoilt cam each way of resting dwells for its own time; the samples' longest window tells how long."""
    vertices, band = uneven(300, 0.01), np.radians(0.1)
    verdict = judge_frame(Contour.from_vertices(vertices), FOUR_BAR, SHAFT, 1e-3, band=band, over=over)
    count = 7200
    for way in WAYS:
        resting = laid(FOUR_BAR, vertices, way)
        f = resting.over_shaft if over == "shaft" else resting.over_relative
        value = f(np.arange(count) * TURN / count, 0)[0]
        sampled = longest_run(value, band) * 360.0 / count
        told = next(d for d in verdict.dwells if d.rest == way.name)
        assert told.length_deg == pytest.approx(sampled, abs=0.1001)
        start = np.radians(told.start_deg)
        inside = f(start + np.radians(told.length_deg) * np.linspace(0, 1, 5001), 0)[0]
        assert 0.999 * band < np.ptp(inside) <= band * (1 + 1e-9)
    assert verdict.dwells[0].length_deg < verdict.dwells[-1].length_deg - 0.1


def longest_run(value, band):
    """Steps of the longest cyclic window of samples whose range is within the band."""
    doubled = np.concatenate([value, value])
    best = begin = 0
    for end in range(len(doubled)):
        while np.ptp(doubled[begin : end + 1]) > band:
            begin += 1
        best = max(best, end - begin)
    return best


def wavy(x):
    """Two long dwells, one a little longer, and ripples."""
    return np.sin(x) ** 5 + 0.02 * np.sin(2 * x) + 0.003 * np.sin(40 * x)


def wavy_range(a, b):
    """Least and greatest, by samples and a parabola at the best of them."""
    x = np.linspace(a, b, 4001)
    y = wavy(x)
    found = []
    for sign in (-1.0, 1.0):
        k = int(np.argmax(sign * y))
        if 0 < k < 4000:
            rise, bend = (y[k + 1] - y[k - 1]) / 2, y[k + 1] - 2 * y[k] + y[k - 1]
            found.append(y[k] - rise**2 / bend / 2)
        else:
            found.append(y[k])
    return tuple(found)


@pytest.mark.slow
@pytest.mark.thin(4)
@pytest.mark.parametrize("band", few([0.02, 0.2, 1.0, 3.0], 2))
@pytest.mark.parametrize("count", [60, 3000])
def test_the_longest_dwell_wherever_it_starts(band, count):
    for begin in (0.0, 0.4, 3.3):
        x = begin + np.linspace(0.0, TURN, count + 1)
        slack = 2 * (TURN / count) ** 2 / 8 * 10.0
        (found,) = longest_dwells([Output(wavy, wavy_range, x, wavy(x), slack)], band)
        fine = np.arange(4000) * TURN / 4000
        assert found.length == pytest.approx(min(longest_run(wavy(fine), band) * TURN / 4000, TURN), abs=4e-3)
        assert 0.0 <= found.start < TURN
        inside = wavy(found.start + found.length * np.linspace(0, 1, 5001))
        assert np.ptp(inside) <= band * (1 + 1e-9)


def test_the_longest_dwells_of_several_outputs_are_those_of_each_alone():
    x = np.linspace(0.0, TURN, 241)
    slack = 2 * (TURN / 240) ** 2 / 8 * 10.0
    outputs = [Output(partial(moved, by), partial(moved_range, by), x, moved(by, x), slack) for by in (0.0, 0.7, -0.3)]
    together = longest_dwells(outputs, 0.2)
    for output, by, dwell in zip(outputs, (0.0, 0.7, -0.3), together, strict=True):
        (alone,) = longest_dwells([output], 0.2)
        assert [dwell.start, dwell.length] == pytest.approx([alone.start, alone.length], abs=1e-9)
        assert dwell.start == pytest.approx((together[0].start + by) % TURN, abs=1e-9)


def moved(by, x):
    """`wavy`, later by an angle."""
    return wavy(x - by)


def moved_range(by, a, b):
    return wavy_range(a - by, b - by)


@pytest.mark.thin(3)
@pytest.mark.parametrize("count", [1, 2, 3, 5, 8, 60])
@pytest.mark.parametrize("band", [0.0, 0.3, 0.9, 1.5, 4.0])
def test_runs_of_blocks_within_a_band_are_those_of_a_count_one_by_one(count, band):
    middle = np.random.default_rng(count).uniform(0.0, 1.0, count)
    low, high = middle - 0.1, middle + 0.1
    ring = np.arange(2 * count) % count
    fits = [
        [np.ptp(np.r_[low[ring[i : i + n]], high[ring[i : i + n]]]) <= band for n in range(1, count + 1)]
        for i in range(count)
    ]
    assert _runs(low, high, band).tolist() == [sum(np.cumprod(row)) for row in fits]


@pytest.mark.slow
def test_flatness_is_the_range_over_the_intended_dwell():
    vertices, band = uneven(300, 0.02), np.radians(0.1)
    verdict = judge_frame(Contour.from_vertices(vertices), FOUR_BAR, SHAFT, 1e-3, band=band)
    exact = judge_frame(Contour.from_vertices(cam(6000)), FOUR_BAR, SHAFT, 1e-3, band=band).dwells[0]
    phi = np.radians(exact.start_deg + exact.length_deg * np.linspace(0.0, 1.0, 20_001))
    ranges = [np.degrees(np.ptp(laid(FOUR_BAR, vertices, way).over_shaft(phi, 0)[0])) for way in WAYS]
    assert verdict.error.dwell_flatness == pytest.approx(max(ranges), abs=1e-4)
    assert verdict.error.dwell_flatness > 0.101


def test_the_slack_between_nodes_is_never_less_than_what_the_output_strays():
    way = laid(FOUR_BAR, cam(25))
    middle = 0.5 * (way.nodes[:-1] + way.nodes[1:])
    value = way.rows(middle, np.arange(len(middle)))[1, 0]
    low, high = np.minimum(way.low[1, 0], way.high[1, 0]), np.maximum(way.low[1, 0], way.high[1, 0])
    output = _output(way, FOUR_BAR, "relative")
    assert np.maximum(low - value, value - high).max() <= output.slack
    found = extremes(
        way.nodes[:-1], way.nodes[1:], way.low[1], way.high[1], lambda x, of: way.rows(x, of)[1], resolution=1e-13
    )
    assert found.greatest <= output.value.max() + output.slack
