"""Dyads: bars keep their lengths, derivatives against 50 digits, limits, mirror images, points of links."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from support.cases import few
from support.linkage_oracle import judged_dyad, ratio

from kin.law.support_function import lift_hypocycloid
from kin.linkage.chain import Chain
from kin.linkage.dyad import RPR, RRP, RRR, BindingError, Link, Reached
from kin.linkage.four_bar import FourBar, InvertedSliderCrank, SliderCrank
from kin.numeric.elementary import Jet

W = 50.0
CAM = lift_hypocycloid(3, 2.0, W, (18.0, 8.5))
THETA = np.linspace(0, 2 * math.pi, 73)
ORDER = 4
ASSEMBLIES = ("open", "crossed")


def lifts(order=ORDER):
    factorials = np.array([[math.factorial(k)] for k in range(order + 1)])
    return [Jet(CAM.derivatives(THETA + turn, order) / factorials) for turn in (0, math.pi / 2)]


S, S1 = lifts()
FOUR_BAR = FourBar(80.0, 70.0, 105.0).solve(S, S1, W)
POINT = FourBar(80.0, 70.0, 105.0).output_link(FOUR_BAR).point(60.0, 20.0)
DYADS: list[Any] = [
    *(RRR("output", (60.0, 20.0), (150.0, 0.0), (110.0, 160.0), assembly) for assembly in ASSEMBLIES),
    *(RRP("output", (60.0, 20.0), 140.0, (10.0, 60.0), 0.3, assembly) for assembly in ASSEMBLIES),
    *(RPR("output", (60.0, 20.0), (150.0, -20.0), offset) for offset in (0.0, 30.0, -30.0)),
]


def distance(p, q):
    """Of two points of jets, as derivatives."""
    return (((p[0] - q[0]) ** 2 + (p[1] - q[1]) ** 2) ** 0.5).derivatives()


def constant(value):
    return np.vstack((np.full((1, len(THETA)), value), np.zeros((ORDER, len(THETA)))))


def fixed(point):
    return tuple(FOUR_BAR.output.constant(v) for v in point)


def cross(origin, p, q):
    ax, ay, bx, by = (d[i].c[0] - origin[i] for d in (p, q) for i in (0, 1))
    return ax * by - ay * bx


@pytest.mark.parametrize("dyad", DYADS[:2])
def test_rrr_keeps_its_bars(dyad):
    output, joint = dyad.solve(*POINT)
    ground = fixed(dyad.ground)
    assert distance(joint, POINT) == pytest.approx(constant(110.0), abs=1e-9)
    assert distance(joint, ground) == pytest.approx(constant(160.0), abs=1e-9)
    tip = dyad.output_link(dyad.solve(*POINT)).point(160.0, 0.0)
    for ours, theirs in zip(tip, joint, strict=True):
        assert ours.derivatives() == pytest.approx(theirs.derivatives(), abs=1e-9)
    assert (np.sign(cross(dyad.ground, POINT, joint)) == (1 if dyad.assembly == "open" else -1)).all()
    assert dyad.unit == "deg"
    assert np.ptp(output.c[0]) < 1


@pytest.mark.parametrize("dyad", DYADS[2:4])
def test_rrp_keeps_its_bar_and_its_line(dyad):
    output, joint = dyad.solve(*POINT)
    assert distance(joint, POINT) == pytest.approx(constant(140.0), abs=1e-9)
    u = math.cos(0.3), math.sin(0.3)
    for i in (0, 1):
        assert (joint[i] - dyad.through[i]).derivatives() == pytest.approx((output * u[i]).derivatives(), abs=1e-12)
    foot = (POINT[0].c[0] - 10) * u[0] + (POINT[1].c[0] - 60) * u[1]
    assert ((output.c[0] > foot) == (dyad.assembly == "open")).all()
    slide = dyad.output_link(dyad.solve(*POINT))
    assert slide.direction is None
    assert (slide.point(3.0, -4.0)[1].c[0] == joint[1].c[0] - 4).all()
    assert dyad.unit == "mm"


@pytest.mark.parametrize("dyad", DYADS[4:])
def test_rpr_keeps_its_slot(dyad):
    reached = dyad.solve(*POINT, math.pi)
    slot = dyad.output_link(reached)
    for along in (0.0, 50.0):  # P stays on the slot's line: it is on the line of any two points of it
        p, q = slot.point(along, dyad.offset), slot.point(along + 100.0, dyad.offset)
        area = (p[0] - POINT[0]) * (q[1] - POINT[1]) - (p[1] - POINT[1]) * (q[0] - POINT[0])
        assert area.derivatives() == pytest.approx(np.zeros_like(area.c), abs=1e-8)
    ahead = slot.point(1.0, 0.0)
    assert ((ahead[0].c[0] - 150) * (POINT[0].c[0] - 150) + (ahead[1].c[0] + 20) * (POINT[1].c[0] + 20) > 0).all()
    assert reached.joint == POINT
    assert dyad.unit == "deg"


def test_crossed_rrr_is_the_mirror_image():
    for ours, image in ((0, 1), (1, 0)):
        x, y = POINT
        here = DYADS[ours].solve(x, y, math.pi)
        there = DYADS[image].solve(x, -y, -math.pi)
        assert here.output.c == pytest.approx(-there.output.c, rel=1e-12, abs=1e-13)
        assert here.joint[1].c == pytest.approx(-there.joint[1].c, rel=1e-12, abs=1e-11)


def test_crossed_rrp_is_the_open_one_along_the_line_reversed():
    way: Any = DYADS[2]
    back = RRP("output", (60.0, 20.0), 140.0, (10.0, 60.0), 0.3 + math.pi, "crossed")
    assert way.solve(*POINT).output.c == pytest.approx(-back.solve(*POINT).output.c, rel=1e-12, abs=1e-12)


@pytest.mark.parametrize("assembly", ASSEMBLIES)
def test_four_bar_as_a_dyad(assembly):
    """A four-bar driven by a point on a circle about A is the RRR dyad of coupler and rocker on that point."""
    angle = Jet.variable(THETA, 3)
    from kin.numeric.elementary import cos, sin

    x, y = cos(angle) * 30.0, sin(angle) * 30.0
    output, joint = RRR("output", (0.0, 0.0), (100.0, 0.0), (90.0, 70.0), assembly).solve(x, y, math.pi)
    # Freudenstein: k1 cos(out) - k2 cos(in) + k3 = cos(in - out)
    k1, k2, k3 = 100 / 30, 100 / 70, (30**2 - 90**2 + 70**2 + 100**2) / (2 * 30 * 70)
    rest = cos(output) * k1 - cos(angle) * k2 + k3 - cos(angle - output)
    assert rest.derivatives() == pytest.approx(np.zeros_like(rest.c), abs=1e-12)
    assert np.abs(np.diff(output.c[0])).max() < 0.3
    assert (joint[0] - cos(output) * 70.0).c == pytest.approx(angle.constant(100.0).c, abs=1e-12)


def test_direction_is_taken_about_the_middle():
    """P passes the cut of the polar angle behind G, and the output runs on."""
    angle = Jet.variable(THETA, 2)
    from kin.numeric.elementary import cos, sin

    x, y = cos(angle) * 30.0, sin(angle) * 30.0
    for dyad in (
        RPR("output", (0.0, 0.0), (100.0, 0.0), 5.0),
        RRR("output", (0.0, 0.0), (100.0, 0.0), (90.0, 70.0), "open"),
    ):
        about = dyad.middle(x.c[0], y.c[0])
        assert about == pytest.approx(math.pi, abs=0.01) or about == pytest.approx(-math.pi, abs=0.01)
        assert np.abs(np.diff(dyad.solve(x, y, about).output.c[0])).max() < 0.3
        assert np.abs(np.diff(dyad.solve(x, y).output.c[0])).max() > 6
    assert DYADS[2].middle(x.c[0], y.c[0]) == 0


def test_points_of_links():
    s, s1 = lifts()
    linkages: Any = FourBar(80.0, 70.0, 105.0), InvertedSliderCrank(130.0, 70.0), SliderCrank(70.0, 12.0)
    four, inverted, slider = (linkage.solve(s, s1, W) for linkage in linkages)
    for linkage, at in zip(linkages[:2], (four, inverted), strict=True):
        length = linkage.rocker
        for ours, theirs in zip(linkage.output_link(at).point(length, 0.0), at.joint, strict=True):
            assert ours.derivatives() == pytest.approx(theirs.derivatives(), rel=1e-10, abs=1e-9)
        # to the left of the way from B to D
        side = linkage.output_link(at).point(0.0, 1.0)
        assert cross((linkage.ground, 0.0), at.joint, side) == pytest.approx(np.full(len(THETA), length), rel=1e-12)
    for at in (four, slider):  # back along the frame's axes lies the shaft
        x, y = at.slide.c[0], s.c[0] - W / 2
        for i in (0, 73 // 2, 50):
            shaft = at.coupler.point(-x[i], -y[i])
            assert [shaft[0].c[0, i], shaft[1].c[0, i]] == pytest.approx([0, 0], abs=1e-12)
    beside = linkages[2].output_link(slider).point(5.0, 7.0)
    assert (beside[0].c[0] == slider.output.c[0] + 5).all()
    assert (beside[1].c[0] == 19).all()
    assert (beside[0].c[1:] == slider.output.c[1:]).all()


def test_dyad_on_a_dyad():
    """A six-bar and two more links: the second dyad on the output link of the first."""
    first = DYADS[0]
    point = first.output_link(first.solve(*POINT)).point(80.0, 10.0)
    second = RPR("previous", (80.0, 10.0), (60.0, -50.0), 4.0)
    assert second.margins(point[0].c[0], point[1].c[0]).min() > 18
    output = second.solve(*point).output
    h = 1e-6
    near = []
    for step in (-h, h):
        value = [
            Jet(np.array([np.polynomial.polynomial.polyval(step, jet.c[:, i]) for i in range(len(THETA))])[None])
            for jet in point
        ]
        near.append(second.solve(*value).output.c[0])
    assert output.c[1] == pytest.approx((near[1] - near[0]) / (2 * h), abs=1e-7)


MARGINS = [
    (RRR("output", (0, 0), (10.0, 5.0), (30.0, 50.0), "open"), lambda x, y: 20.0 - math.hypot(x - 10, y - 5), 1),
    (RRR("output", (0, 0), (10.0, 5.0), (30.0, 50.0), "open"), lambda x, y: math.hypot(x - 10, y - 5) - 80.0, -1),
    (RRP("output", (0, 0), 30.0, (10.0, 5.0), 0.0, "open"), lambda _, y: abs(y - 5) - 30.0, -1),
    (RPR("output", (0, 0), (10.0, 5.0), -20.0), lambda x, y: 20.0 - math.hypot(x - 10, y - 5), 1),
]


@pytest.mark.parametrize("case", range(len(MARGINS)))
def test_margin_and_where_it_binds(case):
    dyad, beyond, _ = MARGINS[case]
    y = np.array([5.0, 18.0, 24.9, 25.1, 34.9, 35.1, 84.9, 85.1, 200.0])
    x = np.full_like(y, 10.0)
    margin = dyad.margins(x, y).min(axis=0)
    where = [-beyond(*pair) for pair in zip(x, y, strict=True)]
    near = np.abs(where) < 0.2
    assert near.any()
    assert margin[near] == pytest.approx(np.array(where)[near], abs=1e-12)
    jets = Jet(np.vstack((x, np.ones_like(x)))), Jet(np.vstack((y, np.ones_like(y))))
    with pytest.raises(BindingError, match="do not reach") as caught:
        dyad.solve(*jets)
    assert (caught.value.indices == np.flatnonzero(margin <= 0)).all()


LIMITS = [
    (RRR("output", (0, 0), (10.0, 5.0), (30.0, 55.0), "open"), (25.0, 25.0)),
    (RRR("output", (0, 0), (10.0, 5.0), (30.0, 35.0), "crossed"), (49.0, 57.0)),
    (RRP("output", (0, 0), 30.0, (10.0, 5.0), 0.0, "open"), (3.0, 35.0)),
    (RPR("output", (0, 0), (10.0, 5.0), 25.0), (25.0, 25.0)),
]
BARE = [
    (RRR("output", (0, 0), (10.0, 5.0), (30.0, 30.0), "open"), (10.0, 5.0)),
    (RPR("output", (0, 0), (10.0, 5.0), 0.0), (10.0, 5.0)),
]


@pytest.mark.parametrize("case", range(len(LIMITS) + len(BARE)))
def test_limit_positions_are_said_so(case):
    dyad, (x, y) = (LIMITS + BARE)[case]
    assert dyad.margins(x, y).min(axis=0) == [0.0]
    for order in (1, 2):
        with pytest.raises(BindingError, match="limit position"):
            dyad.solve(Jet.variable(x, order), Jet.variable(y, order))
    still = Jet.variable(x, 0), Jet.variable(y, 0)
    if case < len(LIMITS):
        assert np.isfinite(dyad.solve(*still).output.c).all()
    else:
        with pytest.raises(BindingError, match="limit position"):
            dyad.solve(*still)


def test_rrp_loses_nothing_near_its_limit():
    link, short = 30.0, 2.0**-40
    y = np.array([[link - short], [0.25]])
    reached = RRP("output", (0, 0), link, (0.0, 0.0), 0.0, "open").solve(Jet(0 * y), Jet(y))
    root = math.sqrt(short * (2 * link - short))
    assert reached.output.c[:, 0] == pytest.approx([root, -0.25 * (link - short) / root], rel=1e-15)


def test_refusals():
    for make in (
        lambda: RRR("rocker", (0, 0), (0, 0), (1, 1), "open"),
        lambda: RRR("output", (0, 0), (0, 0), (0, 1), "open"),
        lambda: RRR("output", (0, 0), (0, 0), (1, 1), "up"),
        lambda: RRP("output", (0, 0), -1, (0, 0), 0, "open"),
        lambda: RRP("output", (0, 0), 1, (0, 0), math.nan, "open"),
        lambda: RPR("coupler", (0, math.inf), (0, 0), 0),
        lambda: RPR("coupler", (0, 0), (0, 0), math.nan),
    ):
        with pytest.raises(ValueError, match=r"dyad|must be longer|open or crossed"):
            make()


def judge(dyad, kind, numbers, driven, ground):
    """Compare output and Q with the oracle's."""
    jets = [Jet(np.array([[c[0]], [c[1]], [c[2] / 2]])) for c in driven]
    assembly = getattr(dyad, "assembly", "open")
    exact, condition = judged_dyad(kind, assembly, numbers, ground, driven)
    reached = dyad.solve(*jets, float(exact[0]) if kind == "rpr" else 0.0)
    output, joint = reached.output, reached.joint
    values = np.concatenate([jet.derivatives()[:, 0] for jet in (output, *joint)])
    if kind == "rrr":
        values[0] += 2 * math.pi * round((float(exact[0]) - values[0]) / (2 * math.pi))
    worst = 0.0
    for ours, theirs, bound in zip(values, exact, condition, strict=True):
        reached_ratio = ratio(ours, theirs, bound)
        assert reached_ratio <= 1, (reached_ratio, dyad, driven)
        worst = max(worst, reached_ratio)
    return worst


@pytest.mark.thin(12)
@pytest.mark.parametrize("assembly", few(ASSEMBLIES, 2))
@pytest.mark.parametrize("power", [1, 3, 5, 7, 9, 11, 13, 15])
def test_near_the_limits(assembly, power):
    """What stands under the root is 10^-power of its scale."""
    rng = np.random.default_rng(1)
    e = 10.0**-power
    for _ in range(3):
        a, b = (float(v) for v in rng.uniform(30, 150, 2))
        ground, way = rng.uniform(-50, 50, 2).tolist(), rng.uniform(-math.pi, math.pi)

        def driven(side, ground=ground, way=way):
            return [
                [g + side * f(way), *rng.normal(scale=20, size=2)]
                for g, f in zip(ground, (math.cos, math.sin), strict=True)
            ]

        for pair, side in (
            ((a, b), math.sqrt((a - b) ** 2 + e * (a + b) ** 2)),
            ((a, b), (a + b) * math.sqrt(1 - e)),
            ((a, a), 2 * a * math.sqrt(e)),
        ):
            point = driven(side)
            dyad = RRR("output", (0, 0), tuple(ground), pair, assembly)
            if dyad.margins(point[0][0], point[1][0]).min(axis=0)[0] > 0:
                judge(dyad, "rrr", pair, point, ground)
        point = driven(math.sqrt(a**2 * (1 + e)))
        rpr = RPR("output", (0, 0), tuple(ground), a if assembly == "open" else -a)
        if rpr.margins(point[0][0], point[1][0]).min(axis=0)[0] > 0:
            judge(rpr, "rpr", (rpr.offset,), point, ground)
        direction = float(way - math.asin(math.sqrt(1 - e)))
        point = driven(b)
        rrp = RRP("output", (0, 0), b, tuple(ground), direction, assembly)
        if rrp.margins(point[0][0], point[1][0]).min(axis=0)[0] > 1e-13:
            judge(rrp, "rrp", (b, direction), point, ground)


lengths = st.floats(1, 300)
places = st.integers(-(10**9), 10**9).map(lambda k: k * 2e-7)  # the oracle does not resolve places of 1e-200
slopes = st.integers(-(10**9), 10**9).map(lambda k: k * 4e-8)
moving = st.tuples(places, slopes, slopes)
driven_points = st.tuples(moving, moving)
grounds = st.tuples(places, places)
assemblies = st.sampled_from(ASSEMBLIES)


@given(lengths, st.floats(1e-6, 1 - 1e-6), grounds, assemblies, driven_points)
def test_any_rrr(near, part, ground, assembly, driven):
    side = math.hypot(driven[0][0] - ground[0], driven[1][0] - ground[1])
    far = abs(side - near) + part * (side + near - abs(side - near))
    assume(far > 0)
    dyad = RRR("output", (0, 0), ground, (near, far), assembly)
    assume(dyad.margins(driven[0][0], driven[1][0]).min(axis=0)[0] > 0)
    judge(dyad, "rrr", (near, far), driven, ground)


@given(st.integers(-7000, 7000).map(lambda k: k / 1000), st.floats(1e-6, 10), grounds, assemblies, driven_points)
def test_any_rrp(direction, more, through, assembly, driven):
    x, y = driven[0][0] - through[0], driven[1][0] - through[1]
    link = abs(y * math.cos(direction) - x * math.sin(direction)) + more
    judge(RRP("output", (0, 0), link, through, direction, assembly), "rrp", (link, direction), driven, through)


@given(st.floats(-1 + 1e-6, 1 - 1e-6), grounds, driven_points)
def test_any_rpr(part, ground, driven):
    offset = part * math.hypot(driven[0][0] - ground[0], driven[1][0] - ground[1])
    dyad = RPR("output", (0, 0), ground, offset)
    assume(dyad.margins(driven[0][0], driven[1][0]).min(axis=0)[0] > 0)
    judge(dyad, "rpr", (offset,), driven, ground)


def test_a_fixed_link_does_not_turn():
    origin = POINT
    assert Link(origin, None).point(1.0, 2.0)[0].c[1:] == pytest.approx(origin[0].c[1:])


@pytest.mark.parametrize("dyad", DYADS)
def test_joints_are_where_the_links_are(dyad):
    reached = dyad.solve(*POINT)
    joints, link = dyad.joints(POINT, reached), dyad.output_link(reached)
    kinds = {name: joint.kind for name, joint in joints.items()}
    wanted = {
        RRR: {"P": "pin", "Q": "pin", "G": "pivot"},
        RRP: {"P": "pin", "Q": "slide"},
        RPR: {"P": "slot", "G": "pivot"},
    }
    assert kinds == wanted[type(dyad)]
    assert joints["P"].place.origin == POINT
    if dyad.driven == "rocker":
        assert [row.c[:, 0].tolist() for row in joints["G"].place.origin] == [[g] + [0] * ORDER for g in dyad.ground]
        for row, other in zip(link.origin, joints["G"].place.origin, strict=True):
            assert (row.c == other.c).all()
    for joint in joints.values():  # along what slides, a slide keeps to its line, or the link to its pin
        if joint.kind == "slide":
            assert joint.place.direction.c[0] == pytest.approx(dyad.direction)
            assert not joint.place.direction.c[1:].any()
        if joint.kind == "slot":
            assert (joint.place.direction.c == link.direction.c).all()


def test_a_chain_gives_the_link_that_carries_each_dyad():
    """Name and pose: the point of a dyad is a point of that link, whose distance to the link's joints is constant."""
    hung: list[Any] = [
        RRR("coupler", (20.0, 30.0), (150.0, 60.0), (110.0, 110.0), "open"),
        RPR("previous", (40.0, 5.0), (0, 0), 2),
    ]
    hung += [
        RRP("output", (60.0, 20.0), 300.0, (10.0, 60.0), 0.3, "open"),
        RRR("previous", (0, 0), (0, 0), (9, 9), "open"),
    ]
    s, s1 = lifts()
    for linkage, names in (
        (FourBar(80.0, 70.0, 105.0), ["frame", "rocker-1", "rocker", "slide-3"]),
        (InvertedSliderCrank(130.0, 70.0), ["block", "rocker-1", "rocker", "slide-3"]),
        (SliderCrank(70.0, 12.0), ["frame", "rocker-1", "slide", "slide-3"]),
    ):
        chain = Chain(linkage, W, tuple(hung))
        assert [chain.carrier(k).name for k in range(4)] == names
        solved = chain.solve(s, s1, ())
        reached = solved._replace(dyads=(Reached(s, POINT),) * 3)
        poses: list[Any] = [chain.carrier(k).pose(reached) for k in range(4)]
        assert poses[0].origin == solved.linkage.joint
        assert poses[0].direction is solved.linkage.frame
        assert (poses[1].origin[0].c[0] == 150).all()
        assert poses[1].direction is s
        assert poses[3].origin == POINT
        for k, pose in enumerate(poses):
            for ours, theirs in zip(chain.hung(reached, k), pose.point(*hung[k].point), strict=True):
                assert (ours.c == theirs.c).all()
        joints = chain.joints(reached, 0)
        ends = linkage.output_link(solved.linkage).point(linkage.rocker if "B" in joints else 0.0, 0.0)
        for ours, theirs in zip(ends, joints["D"].place.origin, strict=True):
            assert ours.c == pytest.approx(theirs.c, abs=1e-9)
        frame = chain.frame(solved)  # the shaft, which is the origin, by S and S1 from its faces
        shaft = frame.point(s1 - W / 2, W / 2 - s)
        assert [np.abs(row.c).max() for row in shaft] == pytest.approx([0, 0], abs=1e-11)
