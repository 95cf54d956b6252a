"""Linkages: loops close, AS's equations where those are regular, mpmath's derivatives, mirror images, refusals."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import mpmath as mp
import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from support.linkage_oracle import judged_linkage, ratio

from kin.law.support_function import lift_from_fourier, lift_hypocycloid
from kin.linkage.four_bar import BindingError, FourBar, InvertedSliderCrank, SliderCrank
from kin.numeric.elementary import Jet

W = 50.0
CAM = lift_hypocycloid(3, 2.0, W, (18.0, 8.5))
BROAD = lift_from_fourier(25.0, {3: 1.2, 5: -0.2}, {3: 0.7}, (12.0, 12.0))
THETA = np.linspace(0, 2 * math.pi, 73)
LINKAGES: list[Any] = [
    *(FourBar(80.0, 70.0, 105.0, assembly) for assembly in ("open", "crossed")),
    *(FourBar(70.0, 65.0, 90.0, assembly) for assembly in ("open", "crossed")),
    *(InvertedSliderCrank(130.0, 70.0, assembly) for assembly in ("open", "crossed")),
    InvertedSliderCrank(60.0, 0.0),
    *(SliderCrank(70.0, 12.0, assembly) for assembly in ("open", "crossed")),
    SliderCrank(70.0, -12.0, "crossed"),
    SliderCrank(70.0, 0.0, "crossed"),
    FourBar(80.0, 70.0, 105.0, "open", 7.5),
    FourBar(80.0, 70.0, 105.0, "crossed", -31.0),
    InvertedSliderCrank(130.0, 10.0, "open", 40.0),
    InvertedSliderCrank(130.0, 0.0, "crossed", -12.0),
    SliderCrank(70.0, 12.0, "open", -9.0),
    SliderCrank(70.0, 12.0, "crossed", 9.0),
]


def jets(cam=CAM, theta=THETA, order=2):
    factorials = np.array([[math.factorial(k)] for k in range(order + 1)])
    return [Jet(cam.derivatives(theta + turn, order) / factorials) for turn in (0, math.pi / 2)]


def mirrored(jet):
    """The lift of the face opposite."""
    return W - jet


@pytest.mark.thin(4)
@pytest.mark.parametrize("linkage", LINKAGES)
@pytest.mark.parametrize("cam", [CAM, BROAD])
def test_loop_closes(linkage, cam):
    s, s1 = jets(cam)
    at = linkage.solve(s, s1, W)
    frame, (dx, dy) = at.frame.c[0], (d.c[0] for d in at.joint)
    x, y = at.slide.c[0], s.c[0] - W / 2 + linkage.joint_offset
    assert dx == pytest.approx(x * np.cos(frame) - y * np.sin(frame), abs=1e-12)
    assert dy == pytest.approx(x * np.sin(frame) + y * np.cos(frame), abs=1e-12)
    if isinstance(linkage, SliderCrank):
        assert linkage.joints(at)["D"].kind == "slide"
        assert linkage.unit == "mm"
        assert (dy == linkage.offset).all()
        assert (dx == at.output.c[0]).all()
        assert (np.sign(dx) == (1 if linkage.assembly == "open" else -1)).all()
    else:
        pivot = linkage.joints(at)["B"]
        assert (pivot.kind, [row.c[0, 0] for row in pivot.place.origin]) == ("pivot", [linkage.ground, 0.0])
        assert linkage.unit == "deg"
        output = at.output.c[0]
        assert (np.sign(output) == (1 if linkage.assembly == "open" else -1)).all()
        assert dx == pytest.approx(linkage.ground - linkage.rocker * np.cos(output), abs=1e-12)
        assert dy == pytest.approx(linkage.rocker * np.sin(output), abs=1e-12)
    if isinstance(linkage, InvertedSliderCrank):
        assert frame + output == pytest.approx(np.full_like(frame, math.pi / 2), abs=1e-15)
    else:
        assert x == pytest.approx(W + linkage.coupler - s1.c[0], rel=1e-15)
    assert np.abs(np.diff(frame)).max() < 0.2


@pytest.mark.thin(6)
@pytest.mark.parametrize("linkage", LINKAGES)
def test_derivatives_of_the_joint_are_those_of_the_loop(linkage):
    """D = X u + Y n and the rocker's circle, each differentiated by jets of its own."""
    from kin.numeric.elementary import cos, sin

    s, s1 = jets(order=5)
    at = linkage.solve(s, s1, W)
    x, y, u, v = at.slide, s - W / 2 + linkage.joint_offset, cos(at.frame), sin(at.frame)
    for ours, theirs in zip(at.joint, (x * u - y * v, x * v + y * u), strict=True):
        assert ours.derivatives() == pytest.approx(theirs.derivatives(), rel=1e-10, abs=1e-10)
    if linkage.unit == "deg":
        r1, r4 = linkage.ground, linkage.rocker
        for ours, theirs in zip(at.joint, (r1 - r4 * cos(at.output), r4 * sin(at.output)), strict=True):
            assert ours.derivatives() == pytest.approx(theirs.derivatives(), rel=1e-10, abs=1e-10)


@pytest.mark.thin(2)
@pytest.mark.parametrize("lengths", [(80.0, 70.0, 105.0), (70.0, 65.0, 90.0)])
def test_both_roots_of_the_half_angle_equation(lengths):
    """AS 14-18: (+) is the open assembly of Figure 7, (-) the crossed one."""
    r1, r3, r4 = lengths
    s, s1 = jets()
    for sense, assembly in ((1, "open"), (-1, "crossed")):
        found = FourBar(r1, r3, r4, assembly).solve(s, s1, W).frame.c[0]
        for p, p1, theta3 in zip(s.c[0], s1.c[0], found, strict=True):
            with mp.workdps(40):
                x, y = W + r3 - mp.mpf(p1), mp.mpf(p) - W / 2
                a, b, c = (r1 + x) ** 2 + y**2 - r4**2, 2 * r1 * y, (r1 - x) ** 2 + y**2 - r4**2
                expected = 2 * mp.atan((-b + sense * mp.sqrt(b**2 - a * c)) / a)
                assert abs(mp.mpf(float(theta3)) - expected) < 1e-15


def test_angular_velocity_by_appendix_1():
    """AS 34, where it is not 0/0."""
    s, s1 = jets()
    at = FourBar(80.0, 70.0, 105.0).solve(s, s1, W)
    x, y, theta3, theta4 = at.slide.c[0], s.c[0] - W / 2, at.frame.c[0], at.output.c[0]
    above = (x * s1.c[1] - y * s.c[1]) * np.sin(theta3 - theta4)
    below = x * (np.sin(theta4) ** 2 - np.sin(theta3) ** 2) + 0.5 * y * (np.sin(2 * theta4) - np.sin(2 * theta3))
    regular = np.abs(np.sin(theta3 - theta4)) > 0.01
    assert regular.sum() > 50
    assert at.output.c[1][regular] == pytest.approx((above / (105.0 * below))[regular], rel=1e-10, abs=1e-13)


def test_inverted_slider_crank_by_the_paper():
    """AS 27, 29, 31, and r3 of AS 23."""
    r1, r4 = 130.0, 70.0
    s, s1 = jets(BROAD)
    p, p1, p2 = s.derivatives()
    at = InvertedSliderCrank(r1, r4).solve(s, s1, W)
    theta4, omega4, alpha4 = at.output.derivatives()
    assert theta4 == pytest.approx(2 * np.arctan(np.sqrt((r1 + p - W / 2 - r4) / (r1 - p + W / 2 + r4))), rel=1e-14)
    assert omega4 == pytest.approx(p1 / (r1 * np.sin(theta4)), rel=1e-12)
    assert alpha4 == pytest.approx((p2 - r1 * omega4**2 * np.cos(theta4)) / (r1 * np.sin(theta4)), rel=1e-12)
    r3 = ((r4 - p + W / 2) * np.sin(theta4) + (s1.c[0] - W) * np.cos(theta4)) / np.cos(theta4)
    assert at.slide.c[0] - W + s1.c[0] == pytest.approx(r3, rel=1e-10)


def test_rocker_beyond_a_right_angle():
    """AS 20 takes theta_4 from its sine, and loses this branch."""
    s, s1 = (Jet(np.array([[p], [0.3]])) for p in (25.0, 30.0))
    at = FourBar(60.0, 90.0, 70.0).solve(s, s1, W)
    assert math.degrees(at.output.c[0, 0]) == pytest.approx(115.376933525, abs=1e-8)  # acos(-9/21) from AD = 110


def test_a_slide_off_the_mid_line_is_that_of_a_rocker_shorter_by_as_much():
    """The loop knows r4 - e alone; where the joint stands along the rocker is another matter."""
    s, s1 = jets()
    off, plain = InvertedSliderCrank(130.0, 70.0, "open", 22.0), InvertedSliderCrank(130.0, 48.0)
    assert off.solve(s, s1, W).output.c == pytest.approx(plain.solve(s, s1, W).output.c, rel=1e-13)


def test_oscillating_yoke_at_rest_stands_upright():
    """With r4 = 0 the output is 90 degrees where S = w/2, and r1 cos(theta_4) = -Y elsewhere."""
    s = Jet(np.array([[25.0, 31.0], [1.0, 1.0]]))
    at = InvertedSliderCrank(60.0, 0.0).solve(s, s, W)
    assert at.output.c[0] == pytest.approx([math.pi / 2, math.acos(-0.1)], rel=1e-15)
    assert at.output.c[1] == pytest.approx([1 / 60, 1 / 60 / math.sqrt(0.99)], rel=1e-15)


def test_crossed_four_bar_is_the_mirror_image():
    """Mirrored about AB, S and w - S change places."""
    s, s1 = jets(order=3)
    for make in (lambda a: FourBar(80.0, 70.0, 105.0, a), lambda a: FourBar(70.0, 65.0, 90.0, a)):
        crossed, image = make("crossed").solve(s, s1, W), make("open").solve(mirrored(s), s1, W)
        assert crossed.output.c == pytest.approx(-image.output.c, rel=1e-12, abs=1e-14)
        assert crossed.frame.c == pytest.approx(-image.frame.c, rel=1e-12, abs=1e-14)


def test_crossed_inverted_slider_crank_is_the_mirror_image_with_the_frame_turned_round():
    s, s1 = jets(order=3)
    crossed, image = (InvertedSliderCrank(130.0, 70.0, a).solve(s, s1, W) for a in ("crossed", "open"))
    assert (crossed.output.c == -image.output.c).all()
    assert crossed.frame.c[0] + image.frame.c[0] == pytest.approx(math.pi, rel=1e-15)
    assert (crossed.slide.c == -image.slide.c).all()


def test_crossed_slider_crank_is_the_open_one_turned_half_round():
    """About the shaft by 180 degrees; the slide is then at minus the offset."""
    s, s1 = jets(order=3)
    crossed, turned = SliderCrank(70.0, 12.0, "crossed").solve(s, s1, W), SliderCrank(70.0, -12.0).solve(s, s1, W)
    assert (crossed.output.c == -turned.output.c).all()
    assert np.exp(1j * crossed.frame.c[0]) == pytest.approx(-np.exp(1j * turned.frame.c[0]), abs=1e-15)
    assert crossed.frame.c[1:] == pytest.approx(turned.frame.c[1:], rel=1e-12, abs=1e-15)


def test_an_offset_of_minus_zero_is_zero():
    s, s1 = jets()
    found = [SliderCrank(70.0, offset, "crossed").solve(s, s1, W).frame.c for offset in (0.0, -0.0)]
    assert (found[0] == found[1]).all()


def test_a_jet_in_another_direction_gives_the_sensitivity():
    """Against the change of the output by a small change of the lift."""
    s, s1 = (jet.c[:1] for jet in jets())
    for linkage in LINKAGES:
        for direction in ((1.0, 0.0), (0.0, 1.0)):
            lifts = [Jet(np.vstack((v, np.full_like(v, d)))) for v, d in zip((s, s1), direction, strict=True)]
            ours = linkage.solve(*lifts, W).output.c[1]
            h = 1e-5
            ends = [
                linkage.solve(Jet(s + step * direction[0]), Jet(s1 + step * direction[1]), W).output.c[0]
                for step in (-h, h)
            ]
            assert ours == pytest.approx((ends[1] - ends[0]) / (2 * h), rel=1e-5, abs=1e-7)


def margin_from_lengths(linkage, s, s1):
    y = s - W / 2 + linkage.joint_offset
    if isinstance(linkage, InvertedSliderCrank):
        return min(linkage.ground - linkage.rocker + y, linkage.ground + linkage.rocker - y)
    side = math.hypot(W + linkage.coupler - s1, y)
    if isinstance(linkage, SliderCrank):
        return side - abs(linkage.offset)
    return min(side - abs(linkage.ground - linkage.rocker), linkage.ground + linkage.rocker - side)


@pytest.mark.parametrize(
    "linkage",
    [
        FourBar(80.0, 70.0, 160.0),
        FourBar(30.0, 70.0, 70.0),
        FourBar(80.0, 70.0, 162.0, "open", 20.0),
        InvertedSliderCrank(20.0, 12.0),
        InvertedSliderCrank(20.0, 3.0, "open", -12.0),
        SliderCrank(40.0, 70.0),
        SliderCrank(40.0, 78.0, "open", -20.0),
    ],
)
def test_margin_and_where_it_binds(linkage):
    s, s1 = jets()
    margin = linkage.margins(s.c[0], s1.c[0], W).min(axis=0)
    expected = [margin_from_lengths(linkage, *pair) for pair in zip(s.c[0], s1.c[0], strict=True)]
    assert margin == pytest.approx(expected, rel=1e-10, abs=1e-11)
    assert margin.min() < 0 < margin.max()
    with pytest.raises(BindingError, match="do not reach each other by") as caught:
        linkage.solve(s, s1, W)
    assert (caught.value.indices == np.flatnonzero(margin < 0)).all()
    assert f"{-margin.min():.6g} mm" in caught.value.message == str(caught.value)
    fit = margin > 0
    assert np.isfinite(linkage.solve(Jet(s.c[:, fit]), Jet(s1.c[:, fit]), W).output.c).all()


def test_margin_takes_numbers():
    assert FourBar(80.0, 70.0, 105.0).margins(25.0, 30.0, W).shape == (2, 1)
    assert InvertedSliderCrank(80.0, 10.0).margins(25.0, 30.0, W).min(axis=0) == pytest.approx([70.0])
    assert SliderCrank(70.0, -10.0).margins(25.0, 30.0, W).min(axis=0) == pytest.approx([80.0])


@pytest.mark.parametrize("bad", [0.0, -1.0, math.nan, math.inf])
def test_lengths_that_are_none(bad):
    for make in (
        lambda: FourBar(bad, 1.0, 1.0),
        lambda: FourBar(1.0, bad, 1.0),
        lambda: FourBar(1.0, 1.0, bad),
        lambda: InvertedSliderCrank(bad, 1.0),
        lambda: SliderCrank(bad, 1.0),
    ):
        with pytest.raises(ValueError, match="must be longer than 0"):
            make()
    if bad != 0:
        with pytest.raises(ValueError, match="must be 0 or longer"):
            InvertedSliderCrank(1.0, bad)
    if not math.isfinite(bad):
        with pytest.raises(ValueError, match="must be finite"):
            SliderCrank(1.0, bad)
        for linkage in (FourBar(1.0, 1.0, 1.0), InvertedSliderCrank(1.0, 1.0), SliderCrank(1.0, 1.0)):
            with pytest.raises(ValueError, match="joint's offset must be finite"):
                replace(linkage, joint_offset=bad)


def test_assembly_by_name_only():
    for make in (lambda a: FourBar(1, 1, 1, a), lambda a: InvertedSliderCrank(1, 1, a), lambda a: SliderCrank(1, 1, a)):
        with pytest.raises(ValueError, match="open or crossed, not 'up'"):
            make("up")


lengths = st.floats(5, 300)
slopes = st.integers(-(10**9), 10**9).map(lambda k: k * 4e-8)  # the oracle does not resolve slopes of 1e-200
lifts = st.tuples(st.floats(1, 49), slopes, slopes)
assemblies = st.sampled_from(["open", "crossed"])
frames = st.tuples(st.just(0.0) | st.floats(-60, 60), st.tuples(lifts, lifts))


def check(kind, linkage, dims, pair):
    s, s1 = (Jet(np.array([[c[0]], [c[1]], [c[2] / 2]])) for c in pair)
    assume(linkage.margins(s.c[0], s1.c[0], W).min(axis=0)[0] > 0)
    at = linkage.solve(s, s1, W)
    exact, condition = judged_linkage(kind, linkage.assembly, dims, W, pair, offset=linkage.joint_offset)
    found = (*at.output.derivatives()[:, 0], *at.frame.derivatives()[:, 0])
    for ours, theirs, bound in zip(found, (*exact[:3], *exact[5:]), (*condition[:3], *condition[5:]), strict=True):
        assert ratio(ours, theirs, bound) <= 1


@pytest.mark.slow
@given(lengths, lengths, lengths, assemblies, frames)
def test_any_four_bar(r1, r3, r4, assembly, frame):
    e, pair = frame
    check("four", FourBar(r1, r3, r4, assembly, e), (r1, r3, r4), pair)


@given(lengths, st.floats(0, 300), assemblies, frames)
def test_any_inverted_slider_crank(r1, r4, assembly, frame):
    e, pair = frame
    check("inverted", InvertedSliderCrank(r1, r4, assembly, e), (r1, r4), pair)


@given(lengths, st.floats(-300, 300), assemblies, frames)
def test_any_slider_crank(r3, offset, assembly, frame):
    e, pair = frame
    check("slider", SliderCrank(r3, offset, assembly, e), (r3, offset), pair)
