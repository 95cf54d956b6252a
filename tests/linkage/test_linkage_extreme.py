"""Linkages where they are hardest to work out, against 50 digits: output and both derivatives, over either angle.

Each figure must come within 1e-10 of itself, or within ten roundings times its condition number where that is more.
Every input is a double and taken as exact. By its discriminant a linkage is judged only where it has one above 0;
where it has none it must be refused.
"""

from __future__ import annotations

import math
from collections import defaultdict

import numpy as np
import pytest
from support.cases import few
from support.linkage_oracle import NAMES, discriminant, judged_linkage, ratio

from kin.law.support_function import lift_hypocycloid, lift_reuleaux
from kin.linkage.four_bar import BindingError, FourBar, InvertedSliderCrank, SliderCrank
from kin.numeric.elementary import Jet

W = 50.0
KINDS = {"four": FourBar, "inverted": InvertedSliderCrank, "slider": SliderCrank}
ASSEMBLIES = ("open", "crossed")
HALVES = np.array([[1.0], [1.0], [0.5]])


def solve(case, order=2):
    kind, assembly, lengths, w, lifts = case
    jets = (Jet(np.reshape(lift[: order + 1], (-1, 1)) * HALVES[: order + 1]) for lift in lifts)
    return KINDS[kind](*lengths, assembly).solve(*jets, w)


def figures(case):
    at = solve(case)
    rate = 1.0 - at.frame.derivative()
    over_shaft = at.output.derivative() / rate
    again = over_shaft.derivative() / Jet(rate.c[:-1])
    out, frame = at.output.derivatives()[:, 0], at.frame.derivatives()[:, 0]
    return [*out, over_shaft.c[0, 0], again.c[0, 0], *frame]


def hold(cases, outright=()):
    """Judge all cases; the figures named outright must be good to 1e-10 of themselves whatever their condition."""
    judged = 0
    for case in cases:
        kind, _, lengths, w, lifts = case
        if discriminant(kind, lengths, w, lifts) <= 0:
            with pytest.raises(BindingError):
                solve(case)
            continue
        judged += 1
        for name, found, exact, condition in zip(NAMES, figures(case), *judged_linkage(*case), strict=True):
            reached = ratio(found, exact, 0 if name in outright else condition)
            assert reached <= 1, (name, reached, case)
    assert judged > len(cases) / 2


def motion(rng, x=None, y=None, r3=70.0):
    """Lifts S, S1 with random derivatives, and values that put D at x, y in the frame's axes (default: random)."""
    s = [W / 2 + (rng.uniform(-0.5, 0.5) * W if y is None else y), *rng.normal(scale=0.3 * W, size=2)]
    s1 = [rng.uniform(0, W) if x is None else W + r3 - x, *rng.normal(scale=0.3 * W, size=2)]
    return [float(v) for v in s], [float(v) for v in s1]


def all_three(rng, assembly, lifts):
    """Ordinary linkages of each kind that close for these lifts."""
    s, s1 = lifts
    side = math.hypot(W + 70 - s1[0], s[0] - W / 2)
    r1 = rng.uniform(30, 150)
    r4 = rng.uniform(abs(side - r1) + 1, side + r1 - 1)
    return [
        ("four", assembly, (r1, 70.0, r4), W, (s, s1)),
        ("inverted", assembly, (rng.uniform(80, 150), rng.uniform(0, 50)), W, (s, s1)),
        ("slider", assembly, (70.0, rng.uniform(-50, 50)), W, (s, s1)),
    ]


def posed(rng, assembly, frame_of):
    """A four-bar whose theta_3 is frame_of(theta_4), within rounding."""
    while True:
        r1, r4 = rng.uniform(30, 150, 2)
        theta4 = rng.uniform(0, math.pi) * (1 if assembly == "open" else -1)
        theta3 = frame_of(theta4)
        dx, dy, c, s = r1 - r4 * math.cos(theta4), r4 * math.sin(theta4), math.cos(theta3), math.sin(theta3)
        x, y = dx * c + dy * s, dy * c - dx * s
        if x > 10 and abs(y) < W / 2:
            r3 = max(1.0, x - rng.uniform(0, W))
            return ("four", assembly, (float(r1), float(r3), float(r4)), W, motion(rng, x, y, r3))


@pytest.mark.slow
@pytest.mark.parametrize("assembly", ASSEMBLIES)
@pytest.mark.parametrize("beside", [0.0, 1e-15, -1e-12, 1e-8])
def test_dead_centres(assembly, beside):
    rng = np.random.default_rng(1)
    hold([case for _ in range(5) for case in all_three(rng, assembly, motion(rng, y=beside * W))])


@pytest.mark.thin(6)
@pytest.mark.parametrize("assembly", ASSEMBLIES)
@pytest.mark.parametrize("apart", [0.0, math.pi])
@pytest.mark.parametrize("beside", [0.0, 1e-12, 1e-7])
def test_theta_3_equals_theta_4_or_is_opposite(assembly, apart, beside):
    """AS 34 is 0/0 here."""
    rng = np.random.default_rng(2)
    hold([posed(rng, assembly, lambda theta4: theta4 + apart + beside) for _ in range(8)])


@pytest.mark.thin(12)
@pytest.mark.parametrize("assembly", ASSEMBLIES)
@pytest.mark.parametrize("angle", [0.0, 1e-15, 1e-12, 1e-9, 1e-6, 1e-3])
def test_transmission_angle_near_0(assembly, angle):
    rng = np.random.default_rng(3)
    hold([posed(rng, assembly, lambda theta4: angle - theta4 + rng.choice([0, math.pi])) for _ in range(8)])


@pytest.mark.thin(24)
@pytest.mark.parametrize("assembly", few(ASSEMBLIES, 2))
@pytest.mark.parametrize("power", range(3, 16))
def test_discriminant_down_to_1e_15(assembly, power):
    """Over the relative angle nothing is lost near a limit, however ill-conditioned the figures are there."""
    rng = np.random.default_rng(4)
    e = 10.0**-power
    cases: list[tuple] = []
    for end in ("near", "far", "equal"):  # AD nearly |r1 - r4|, nearly r1 + r4, nearly 0 = r1 - r4
        for _ in range(2):
            r1, r4 = rng.uniform(30, 150, 2)
            r4 = r1 if end == "equal" else r4
            side = math.sqrt((r1 + r4) ** 2 * (1 - e) if end == "far" else (r1 - r4) ** 2 + e * (r1 + r4) ** 2)
            y = 0.6 * min(side, W / 2)
            r3 = 1.0
            cases.append(("four", assembly, (r1, r3, r4), W, motion(rng, math.sqrt(side**2 - y**2), y, r3)))
    for _ in range(2):
        r1, r4 = rng.uniform(50, 100), rng.uniform(30, 70)
        ends = r4 - r1 * (1 - e), r4 + r1 * (1 - e)
        cases += [("inverted", assembly, (r1, r4), W, motion(rng, y=y)) for y in ends]
        s, s1 = motion(rng)
        offset = rng.choice([-1, 1]) * math.sqrt(((W + 70 - s1[0]) ** 2 + (s[0] - W / 2) ** 2) * (1 - e))
        cases.append(("slider", assembly, (70.0, offset), W, (s, s1)))
    hold(cases, outright=("output", "velocity", "acceleration"))


@pytest.mark.slow
@pytest.mark.parametrize("assembly", few(ASSEMBLIES, 2))
def test_links_from_a_millionth_to_a_million_breadths(assembly):
    rng = np.random.default_rng(5)
    cases = []
    least, most = 1e-6 * W, 1e6 * W
    while len(cases) < 150:
        r1, r3 = (float(W * 10 ** rng.uniform(-6, 6)) for _ in range(2))
        s, s1 = motion(rng)
        y = s[0] - W / 2
        side = math.hypot(W + r3 - s1[0], y)
        if rng.random() < 0.5:
            r1 = float(side * rng.uniform(0.2, 3))
        r4 = float(rng.uniform(abs(side - r1), side + r1))
        if least <= min(r1, r4) and max(r1, r4) <= most:
            cases.append(("four", assembly, (r1, r3, r4), W, (s, s1)))
        r1 = float(W * 10 ** rng.uniform(-6, 6))
        r4 = float(rng.uniform(y - r1, y + r1))
        if r4 >= 0:
            cases.append(("inverted", assembly, (r1, r4), W, (s, s1)))
        cases.append(("slider", assembly, (r3, float(side * rng.uniform(-1, 1))), W, (s, s1)))
    hold(cases)


@pytest.mark.slow
@pytest.mark.parametrize("assembly", ASSEMBLIES)
@pytest.mark.parametrize("power", [-6.0, -9.0, -15.0, -300.0, -math.inf])
def test_shaft_at_the_edge_of_the_cam(assembly, power):
    rng = np.random.default_rng(6)
    cases = []
    for face in range(4):
        s, s1 = motion(rng)
        (s if face < 2 else s1)[0] = W * 10.0**power if face % 2 == 0 else W - W * 10.0**power
        cases += all_three(rng, assembly, (s, s1))
    hold(cases)


@pytest.mark.slow
@pytest.mark.parametrize("assembly", ASSEMBLIES)
def test_cam_with_almost_no_radius_of_curvature(assembly):
    """S + S'' is 1e-9 of the breadth at one face or the other, or at both."""
    rng = np.random.default_rng(7)
    cases = []
    for i in range(12):
        s, s1 = motion(rng)
        for lift in ((s,), (s1,), (s, s1))[i % 3]:
            lift[2] = 1e-9 * W - lift[0]
        cases += all_three(rng, assembly, (s, s1))
    hold(cases)


CAMS = {
    "nearly sharp Reuleaux": lift_reuleaux(3, W, 1e-9 * W, (4.0, 3.0)),
    "nearly cusped hypocycloid": lift_hypocycloid(3, W / 16 * (1 - 1e-9), W, (5.0, 2.0)),
    "shaft on the edge": lift_reuleaux(3, W, 5.0, (-W / 2 + 1.0, 0.0)),
}


@pytest.mark.slow
@pytest.mark.parametrize("cam", CAMS)
def test_cams_whole(cam):
    """The lift's own derivatives, at its breaks and between."""
    rng = np.random.default_rng(8)
    theta = np.concatenate((CAMS[cam].breaks, rng.uniform(0, 2 * math.pi, 6)))
    s, s1 = (CAMS[cam].derivatives(theta + turn, 2) for turn in (0, math.pi / 2))
    cases = []
    for i in range(len(theta)):
        cases += all_three(rng, ASSEMBLIES[i % 2], (s[:, i].tolist(), s1[:, i].tolist()))
    hold(cases)


SINGULAR = {
    "rocker on AB": ("four", (48.0, 64.0, 148.0), 100.0, (50.0, 64.0)),
    "rocker in line with AB": ("four", (48.0, 64.0, 52.0), 100.0, (50.0, 64.0)),
    "D in A": ("four", (80.0, 1.0, 80.0), 50.0, (25.0, 51.0)),
    "yoke at its end": ("inverted", (32.0, 7.0), 50.0, (0.0, 10.0)),
    "yoke at its other end": ("inverted", (8.0, 7.0), 50.0, (40.0, 10.0)),
    "slide at the shaft": ("slider", (30.0, -40.0), 50.0, (57.0, 56.0)),
    "D in A on the slide": ("slider", (1.0, 0.0), 50.0, (25.0, 51.0)),
}


@pytest.mark.parametrize("assembly", ASSEMBLIES)
@pytest.mark.parametrize("name", SINGULAR)
def test_singular_is_said_so(name, assembly):
    """A discriminant of exactly 0 has no derivative, one below has no position."""
    kind, lengths, w, (s, s1) = SINGULAR[name]
    linkage = KINDS[kind](*lengths, assembly)
    assert discriminant(kind, lengths, w, ((s,), (s1,))) == 0
    assert linkage.margins(np.array([s]), np.array([s1]), w).min(axis=0) == 0
    for order in (1, 2):
        with pytest.raises(BindingError, match="limit position"):
            solve((kind, assembly, lengths, w, ((s, 1.0, 1.0), (s1, 1.0, 1.0))), order)
    if name.startswith("D in A"):
        with pytest.raises(BindingError, match="limit position"):
            solve((kind, assembly, lengths, w, ((s,), (s1,))), 0)
    else:
        assert abs(solve((kind, assembly, lengths, w, ((s,), (s1,))), 0).output.c[0, 0]) in (0.0, math.pi)


def test_short_coupler_on_a_shaft_at_the_edge():
    """X = r3, though w + r3 rounds it off."""
    w, r3 = 50.0, 1e-7
    at = solve(("slider", "open", (r3, 0.0), w, ((25.0, 0.0, 0.0), (w, 1.0, 0.0))))
    assert at.output.c[:2, 0] == pytest.approx([r3, -1.0], rel=1e-15)


@pytest.mark.slow
def test_one_ulp_from_a_limit_on_either_side():
    """The sign of the discriminant is that of the doubles given, however little it is."""
    found = defaultdict(int)
    rng = np.random.default_rng(9)
    for _ in range(60):
        r1, r4 = (float(v) for v in rng.uniform(30, 150, 2))
        r3 = float(rng.uniform(1, 80))
        y = rng.uniform(-0.5, 0.5) * min(W, abs(r1 - r4))
        x = math.sqrt((r1 - r4) ** 2 - y**2)
        s, s1 = float(W / 2 + y), float(W + r3 - x)
        for ulps in range(-3, 4):
            value = s1 + ulps * math.ulp(s1)
            exact = discriminant("four", (r1, r3, r4), W, ((s,), (value,)))
            margin = FourBar(r1, r3, r4).margins(s, value, W).min(axis=0)[0]
            assert np.sign(margin) == np.sign(float(exact))
            found[float(np.sign(margin))] += 1
            if margin > 0:
                solve(("four", "open", (r1, r3, r4), W, ((s, 1.0, 1.0), (value, 1.0, 1.0))))
            else:
                with pytest.raises(BindingError):
                    solve(("four", "open", (r1, r3, r4), W, ((s, 1.0, 1.0), (value, 1.0, 1.0))))
    assert found[1.0] > 100
    assert found[-1.0] > 100
