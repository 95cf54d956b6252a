"""Transmission laws: Wunderlich's equations on every route, mpmath as the oracle, and what must be refused.

Holds: kin.law.feasibility, kin.law.transmission_law.
"""

import math
from functools import cache
from itertools import pairwise

import mpmath as mp
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from support.programmes import Segment, law, programme

from kin.law.formula.formula import Formula
from kin.law.normalised import IntentError, polynomial_law
from kin.law.routes import FromDelta
from kin.law.segment import Harmonics
from kin.law.transmission import from_arc, from_delta, from_law, from_rosette
from kin.numeric.elementary import BallJet, Jet

TURN = 2 * math.pi
RATIOS = [(2, 1), (3, 1), (4, 1), (4, 3), (5, 3), (7, 5)]
L = 60.0
STEEP = "psi'(phi) must stay below 1, else the cam cannot be turned through; it reaches"


def degrees(kind, over, stroke=0.0, name="cycloidal"):
    return Segment(kind, math.radians(over), math.radians(stroke), None if kind == "dwell" else law(name))


def up_and_down(lam, swing, name="cycloidal"):
    """Dwell, rise, dwell, return, dwell over delta = 180/lam degrees; swing in degrees."""
    parts = [0.1 * 180 / lam, 0.35 * 180 / lam, 0.05 * 180 / lam, 0.4 * 180 / lam]
    last = 180 / lam - sum(parts)
    return programme(
        [
            degrees("dwell", parts[0]),
            degrees("rise", parts[1], swing, name),
            degrees("dwell", parts[2]),
            degrees("return", parts[3], swing, name),
            degrees("dwell", last),
        ],
        math.pi / lam,
    )


def leaf(text):
    return Formula(text, ("x",))


@cache
def routes(lam, mu):
    """A law by every route; swings of 2 to 10 degrees."""
    small = 0.1 * min(2 / lam, math.sin(min(math.pi * mu / lam, math.pi - math.pi * mu / lam)))
    mean = 2 * L * math.cos(math.pi * mu / lam / 2)
    return {
        "delta": from_delta(lam, mu, L, {1: small * L * L}, {}),
        "delta with sines": from_delta(lam, mu, L, {1: 0.5 * small * L * L}, {1: 0.3 * small * L * L, 3: -20.0}),
        "law": from_law(lam, mu, L, up_and_down(lam, 3.0)),
        "law of a pair": from_law(lam, mu, L, up_and_down(lam, 1.5, "modified-sine"), "pair"),
        "flatter arc": from_arc(lam, mu, L, 6 * mean, "concave") if mu > 1 else from_arc(lam, mu, L, 1.1 * mean),
        "arc": from_arc(lam, mu, L, 0.95 * mean),
        "rosette": from_rosette(lam, mu, L, leaf("3*sin(pi*x)")),
        "rosette with a rest": from_rosette(lam, mu, L, leaf("2*max(0, sin(pi*x) - 0.3)**3")),
    }


ROUTES = (
    "delta",
    "delta with sines",
    "law",
    "law of a pair",
    "flatter arc",
    "arc",
    "rosette",
    "rosette with a rest",
)
ALL = [(lam, mu, name) for lam, mu in RATIOS for name in ROUTES]
every_law = pytest.mark.parametrize(("lam", "mu", "name"), ALL)


def made(lam, mu, name):
    return routes(lam, mu)[name]


def samples(law, count=500):
    """Parameters all round, breaks among them."""
    return np.concatenate((np.linspace(0, TURN, count), law.breaks))


# --- Wunderlich's equations ---


@pytest.mark.thin(4)
@every_law
def test_closing_equation(lam, mu, name):
    """W 7.1: the roller that stands where the other stood before sees a pitch curve that closes."""
    law = made(lam, mu, name)
    tau = samples(law)
    phi, psi = law.at(tau, 0)
    r, t = law.pitch(tau, 0)
    following = law.parameter(phi[0] - psi[0] + law.alpha)  # W 4.6: roller A comes to where roller B is
    r_next, t_next = law.pitch(following, 0)
    np.testing.assert_allclose(t_next[0], t[0] + law.alpha, atol=1e-12)
    closing = r**2 + r_next**2 - 2 * r * r_next * math.cos(law.alpha)
    np.testing.assert_allclose(closing[0] / (4 * L**2 * math.sin(law.alpha) ** 2), 1, atol=1e-12)


@pytest.mark.thin(6)
@every_law
def test_affinity(lam, mu, name):
    """W 4.9: (phi, psi) -> (phi - psi + delta, -psi) maps the law onto itself, slope -psi'/(1 - psi') included."""
    law = made(lam, mu, name)
    tau = samples(law)
    phi, psi = law.at(tau, 1)
    slope = psi[1] / phi[1]
    image = law.psi_of_shaft(phi[0] - psi[0] + law.delta, 1)
    np.testing.assert_allclose(image[0], -psi[0], atol=1e-13)
    np.testing.assert_allclose(image[1], -slope / (1 - slope), atol=1e-9)
    np.testing.assert_allclose(law.psi_of_shaft(phi[0] + 2 * law.delta, 0)[0], psi[0], atol=1e-13)


@pytest.mark.thin(4)
@every_law
def test_the_parameter_of_a_polar_angle(lam, mu, name):
    law = made(lam, mu, name)
    tau = samples(law)
    np.testing.assert_allclose(law.polar_parameter(law.pitch(tau, 0)[1][0]), tau, atol=1e-13)
    image = law.at(law.polar_parameter(law.pitch(tau, 0)[1][0] + law.alpha), 0)[1][0]
    np.testing.assert_allclose(image, -law.at(tau, 0)[1][0], atol=1e-14)  # W 4.4


@pytest.mark.thin(12)
@every_law
def test_chords_close_after_two_lambda_steps(lam, mu, name):
    """W section 6: chords of length 2 l sin(alpha), stepped round the pitch curve from anywhere, close."""
    law = made(lam, mu, name)
    tau = np.linspace(0.1, 0.1 + 2 * law.delta, 7)
    corners, turned = [], []
    for _ in range(2 * lam + 1):
        (r,), (t,) = law.pitch(tau, 0)
        corners.append(r * np.exp(1j * t))
        turned.append(t)
        (phi,), (psi,) = law.at(tau, 0)
        tau = law.parameter(phi - psi + law.alpha)
    for one, other in pairwise(corners):
        assert np.abs(other - one) == pytest.approx(2 * L * math.sin(law.alpha), rel=1e-12)
    np.testing.assert_allclose(corners[-1], corners[0], atol=1e-9)
    np.testing.assert_allclose(turned[-1] - turned[0], TURN * mu, atol=1e-11)


@pytest.mark.thin(4)
@every_law
def test_shaft_angle_rises_and_turns_back_nowhere(lam, mu, name):
    law = made(lam, mu, name)
    tau = np.linspace(0, TURN, 2001)
    for side in (1, -1):
        phi, psi = law.at(tau, 1, side)
        assert phi[1].min() > 0
        assert (psi[1] / phi[1]).max() < 1
    (ends,), (psi,) = law.at(np.array([0.0, TURN]), 0)
    assert ends[1] - ends[0] == pytest.approx(TURN, abs=1e-14)
    assert psi[0] == pytest.approx(psi[1], abs=1e-14)


@pytest.mark.thin(6)
@every_law
def test_the_law_over_the_shaft_angle_is_the_parametric_one(lam, mu, name):
    law = made(lam, mu, name)
    tau = np.linspace(0.003, TURN - 0.003, 701)
    phi, psi = law.at(tau, 3)
    over_shaft = law.psi_of_shaft(phi[0], 3)
    first = psi[1] / phi[1]
    second = (psi[2] - first * phi[2]) / phi[1] ** 2
    third = (psi[3] - 3 * second * phi[1] * phi[2] - first * phi[3]) / phi[1] ** 3
    np.testing.assert_allclose(law.parameter(phi[0]), tau, atol=1e-13)
    np.testing.assert_allclose(over_shaft[0], psi[0], atol=1e-14)
    for k, true in ((1, first), (2, second), (3, third)):
        np.testing.assert_allclose(over_shaft[k], true, atol=1e-9 * np.abs(true).max())


@pytest.mark.thin(12)
@every_law
def test_enclosures_hold(lam, mu, name):
    law = made(lam, mu, name)
    rng = np.random.default_rng(lam)
    lower = rng.uniform(-1, 7, 200)
    upper = lower + 10.0 ** rng.uniform(-6, 0.5, 200)
    inside = lower + rng.uniform(0.001, 0.999, 200) * (upper - lower)
    for (mid, rad), values in zip(law.enclosure(lower, upper, 4), law.at(inside, 4), strict=True):
        noise = 1e-13 * np.abs(values).max(axis=1, keepdims=True)
        assert (np.abs(values - mid) <= rad + noise).all()
    phi, psi = law.jets(BallJet.variable(lower, upper, 4))
    np.testing.assert_array_equal(phi.bounds()[0] <= law.at(inside, 4)[0] + noise, np.ones((5, 200), dtype=bool))
    assert psi.order == 4


@pytest.mark.thin(6)
@every_law
def test_breaks_steady_stretches_and_known_arcs(lam, mu, name):
    law = made(lam, mu, name)
    assert (np.diff(law.breaks) > 0).all()
    assert ((law.breaks >= 0) & (law.breaks < TURN)).all()
    ends = law.breaks if len(law.breaks) else np.array([0.0])
    assert len(law.steady) == len(law.radius) == len(law.pitch_arcs) == len(ends)
    arcs = 0
    for i, low in enumerate(ends):
        high = ends[i + 1] if i + 1 < len(ends) else ends[0] + TURN
        tau = np.linspace(low, high, 12)[1:-1]
        (r,), (t,) = law.pitch(tau, 0)
        if law.steady[i]:
            assert r == pytest.approx(law.radius[i], rel=1e-14)
        else:
            assert np.ptp(r) > 1e-9
        x, y, radius = law.pitch_arcs[i]
        if not math.isnan(radius):
            arcs += 1
            assert np.abs(r * np.exp(1j * t) - complex(x, y)) == pytest.approx(abs(radius), rel=1e-12)
    rests = {"law": 4, "law of a pair": 4, "rosette with a rest": 2}.get(name, 0)
    assert law.steady.sum() == rests * lam
    assert arcs == {"arc": 1, "flatter arc": 1}.get(name, rests) * lam


# --- oracles ---


def psi_by_mpmath(delta, alpha, arm, phi, guess):
    """psi(phi) from W 5.10 and 4.4 alone: t from cos(phi - t) = r(t)/2l, at high precision."""
    a, b = mp.cos(mp.pi / 4 - alpha / 2), mp.sin(mp.pi / 4 - alpha / 2)

    def r(t):
        d = delta(t)
        return mp.sqrt(2) * (a * mp.sqrt(arm**2 + d) + b * mp.sqrt(arm**2 - d))

    t = mp.findroot(lambda t: mp.cos(phi - t) - r(t) / (2 * arm), guess)
    return 2 * (phi - t) - alpha


@pytest.mark.thin(4)
@pytest.mark.parametrize(("lam", "mu", "m2"), [(4, 3, 625.0), (2, 1, 1100.0), (3, 1, 400.0), (5, 3, 900.0)])
def test_delta_route_against_mpmath(lam, mu, m2):
    law = from_delta(lam, mu, L, {1: m2}, {3: 30.0})
    with mp.workdps(40):
        alpha = mp.pi * mu / lam
        for phi in (0.3, 1.234, 2.9, 5.5):
            guess = mp.mpf(float(law.pitch(law.parameter(phi), 0)[1][0, 0]))

            def psi(x, guess=guess):
                return psi_by_mpmath(
                    lambda t: m2 * mp.cos(lam * t) + 30 * mp.sin(3 * lam * t), alpha, mp.mpf(60), x, guess
                )

            true = [float(mp.diff(psi, mp.mpf(phi), k)) for k in range(4)]
            ours = law.psi_of_shaft(phi, 3)[:, 0]
            assert ours == pytest.approx(true, rel=1e-11, abs=1e-12)


def test_delta_route_to_the_edge_of_the_square():
    """|D| = l^2 (1 - 1e-12): half the digits would be lost by an arcsine near t = 0."""
    m2 = L * L * (1 - 1e-12)
    law = from_delta(2, 1, L, {1: m2}, {})
    t = np.array([0.0, 1e-9, 1e-7, 1e-6, 1e-4, 0.1, 0.7, math.pi / 2 - 1e-6])
    psi = law.at(t, 2)[1]
    with mp.workdps(60):

        def exact(x):
            return -mp.asin(mp.mpf(m2) / (mp.mpf(L) ** 2) * mp.cos(2 * x))

        for i, x in enumerate(t):
            assert psi[0, i] == pytest.approx(float(exact(mp.mpf(x))), rel=1e-14)
            slope, bend = float(mp.diff(exact, mp.mpf(x))), float(mp.diff(exact, mp.mpf(x), 2))
            assert psi[1, i] == pytest.approx(slope, rel=1e-9, abs=1e-9)
            assert psi[2, i] == pytest.approx(bend, rel=1e-9, abs=1e-9)


def test_booths_lemniscate():
    """W 6.3: for lam/mu = 2, r^2 = 2 (l^2 + m^2 cos 2t), an oval as long as 3 m^2 < l^2."""
    t = np.linspace(0, TURN, 721)
    for m2, oval in ((0.333 * L * L, True), (0.334 * L * L, False)):
        law = from_delta(2, 1, L, {1: m2}, {})
        r, angle = law.pitch(t, 2)
        np.testing.assert_allclose(angle[0], t, atol=1e-14)
        np.testing.assert_allclose(r[0] ** 2, 2 * (L**2 + m2 * np.cos(2 * t)), rtol=1e-14)
        bending = r[0] ** 2 + 2 * r[1] ** 2 - r[0] * r[2]  # of the sign of the curvature
        assert (bending.min() > 0) == oval


def test_wunderlichs_figure_9():
    law = from_delta(4, 3, L, {1: 625.0}, {})
    t = np.linspace(0, TURN, 2881)
    (r,), (angle,) = law.pitch(t, 0)
    a, b = math.cos(math.radians(-22.5)), math.sin(math.radians(-22.5))
    assert (a, b) == pytest.approx((0.924, -0.383), abs=5e-4)
    d = 625 * np.cos(4 * t)
    np.testing.assert_allclose(r, math.sqrt(2) * (a * np.sqrt(L**2 + d) + b * np.sqrt(L**2 - d)), rtol=1e-14)
    np.testing.assert_allclose(angle, t, atol=1e-14)
    assert np.abs(law.at(t, 0)[1]).max() == pytest.approx(math.asin(625 / 3600), rel=1e-14)
    assert law.breaks.tolist() == []


def test_an_ellipse_works_a_right_angled_flat_pair():
    """W section 5, Goldberg's ellipse: r of lam/mu = 2 is the support function; its orthoptic circle has radius 2l."""
    m2 = 900.0
    law = from_delta(2, 1, L, {1: m2}, {})
    t = np.linspace(0, TURN, 361)
    long, short = math.sqrt(2 * (L**2 + m2)), math.sqrt(2 * (L**2 - m2))
    assert math.hypot(long, short) == pytest.approx(2 * L)
    np.testing.assert_allclose(law.pitch(t, 0)[0][0], np.hypot(long * np.cos(t), short * np.sin(t)), rtol=1e-14)


@pytest.mark.parametrize(("lam", "mu", "limit"), [(4, 3, 0.05583), (5, 3, 0.06188), (3, 1, 0.57486), (4, 1, 0.42309)])
def test_convexity_of_a_flat_pairs_cam(lam, mu, limit):
    """r + r'' > 0 needs m^2/l^2 below a limit far narrower than the roller's."""
    t = np.linspace(0, TURN / lam, 20001)
    for share, convex in ((limit - 1e-5, True), (limit + 1e-5, False)):
        r = from_delta(lam, mu, 1.0, {1: share}, {}).pitch(t, 2)[0]
        assert ((r[0] + r[2]).min() > 0) == convex


@pytest.mark.parametrize("name", ["cycloidal", "modified-sine", "parabolic"])
def test_law_route_is_the_programme_over_the_shaft_angle(name):
    moves = up_and_down(4, 2.0, name)
    law = from_law(4, 3, L, moves)
    phi = np.linspace(0, law.delta, 400)[1:-1]
    np.testing.assert_allclose(law.psi_of_shaft(phi, 3), moves.motion.derivatives(phi, 3), rtol=1e-10, atol=1e-10)
    (start,), (rest,) = law.at(0.0, 0)
    assert (start[0], rest[0]) == (0.0, 0.0)
    pair = from_law(4, 3, L, moves, "pair")
    np.testing.assert_allclose(pair.psi_of_shaft(phi, 3), 2 * moves.motion.derivatives(phi, 3), rtol=1e-10, atol=1e-10)


def test_a_law_may_run_through_its_joint():
    # psi' = 0.2 at phi = 0; the image starts with -0.2/(1 - 0.2) = -0.25, so the law must end with that slope
    delta, rise = math.pi / 4, math.radians(4)
    start, end = 0.2 * delta / rise, -0.25 * delta / rise
    # s = a u + b u^2 + c u^3 with s(1) = 1, split into a rise over 0.5 and its return
    half = 0.5 * start
    first = polynomial_law([0, half, 3 - 2 * half, half - 2])
    back = -0.5 * end
    last = polynomial_law([0, back, 3 - 2 * back, back - 2])  # a return runs it from its end to its start
    moves = programme([Segment("rise", delta / 2, rise, first), Segment("return", delta / 2, rise, last)], delta)
    assert moves.at_start(1)[1] == pytest.approx(0.2)
    assert moves.at_end(1)[1] == pytest.approx(-0.25)
    law = from_law(4, 3, L, moves)
    for phi in (0.0, law.delta):
        right, left = (law.psi_of_shaft(phi, 1, side)[1, 0] for side in (1, -1))
        assert right == pytest.approx(left, abs=1e-12)


@pytest.mark.parametrize(
    ("lam", "mu", "side", "radius"),
    [(3, 1, "convex", 70.0), (3, 1, "convex", 1e6), (4, 3, "concave", 150.0), (4, 3, "concave", 1e6)],
)
def test_arc_route_begins_with_that_arc(lam, mu, side, radius):
    law = from_arc(lam, mu, L, radius, side)
    mean = 2 * L * math.cos(law.alpha / 2)
    (r,), (t,) = law.pitch(np.linspace(0, law.delta, 101), 0, 1)
    assert (t[0], t[-1]) == pytest.approx((0.0, law.delta), abs=1e-15)
    assert (r[0], r[-1]) == pytest.approx((mean, mean), rel=1e-14)
    x, y, signed = law.pitch_arcs[0]
    assert signed == (radius if side == "convex" else -radius)
    assert math.atan2(y, x) % math.pi == pytest.approx(law.delta / 2)
    points = r * np.exp(1j * t)
    assert np.abs(points - complex(x, y)) == pytest.approx(radius, rel=1e-13)
    middle = abs(points[50]) - mean * math.cos(law.delta / 2)
    assert (middle > 0) == (side == "convex")
    # W 4.3, with the sine outside the root
    following = law.pitch(np.linspace(0, law.delta, 101) + law.delta, 0, -1)[0][0]
    np.testing.assert_allclose(
        following, r * math.cos(law.alpha) + np.sqrt(4 * L**2 - r**2) * math.sin(law.alpha), rtol=1e-13
    )
    assert np.abs(law.psi.jumps(1)[1]).max() < 1e-12  # joins its image with a common tangent


def test_rosette_route_traces_the_leaf():
    """W section 5: Q = 2 l sin(psi/2) n(phi - psi/2); a leaf spans delta, the next is turned by delta + pi."""
    text = "4*sin(pi*x)*(1 + 0.3*cos(pi*x)**2)"
    law = from_rosette(4, 3, L, leaf(text))
    x = np.linspace(0, 1, 51)
    direction = math.pi / 2 + x * law.delta
    distance = leaf(text)(x)
    tau = x * law.delta - law.alpha / 2
    for turn, sense in ((0.0, 1.0), (law.delta, -1.0), (2 * law.delta, 1.0)):
        (phi,), (psi,) = law.at(tau + turn, 0)
        assert (sense * psi >= -1e-15).all()
        q = 2 * L * np.sin(psi / 2) * np.exp(1j * (phi - psi / 2 + math.pi / 2))
        # |OQ| along the leaf's ray, the leaf turned by delta + pi for each step
        np.testing.assert_allclose(q, sense * distance * np.exp(1j * (direction + turn)), atol=1e-12)
        # and Q is the tip of the third arm: from the pivot, l long, towards the shaft when psi = 0
        pivot = L * np.exp(1j * phi)
        np.testing.assert_allclose(q - pivot, -L * np.exp(1j * (phi - psi)), atol=1e-12)
    assert law.psi_of_shaft(0.0, 0)[0, 0] == pytest.approx(0, abs=1e-15)


def test_a_leaf_has_a_unit():
    inches = from_rosette(4, 3, 2.0 * 25.4, leaf("0.2*sin(pi*x)"), 25.4)
    metric = from_rosette(4, 3, 50.8, leaf("5.08*sin(pi*x)"))
    tau = np.linspace(0, 6, 50)
    np.testing.assert_allclose(inches.at(tau, 2)[1], metric.at(tau, 2)[1], atol=1e-14)


# --- the parameter and its inverse ---


def test_sides_at_breaks_of_the_shaft_angle():
    law = from_law(
        4, 3, L, programme([degrees("rise", 20, 4, "parabolic"), degrees("return", 25, 4, "parabolic")], math.pi / 4)
    )
    a = 4 * math.radians(4) / math.radians(20) ** 2
    for phi, right, left in ((math.radians(10), -a, a), (math.radians(0) + TURN, a, None), (0.0, a, None)):
        assert law.psi_of_shaft(phi, 2, 1)[2, 0] == pytest.approx(right, rel=1e-12)
        if left is not None:
            assert law.psi_of_shaft(phi, 2, -1)[2, 0] == pytest.approx(left, rel=1e-12)


@settings(deadline=None)
@given(st.sampled_from(ALL), st.floats(-20, 20))
def test_any_shaft_angle_is_reached(which, phi):
    law = made(*which)
    tau = law.parameter(phi)
    assert law.at(tau, 0)[0][0, 0] == pytest.approx(phi, abs=1e-13)


def test_a_jet_of_the_parameter_may_be_any_jet():
    law = made(4, 3, "law")
    t = np.array([0.2, 1.7, 3.1])
    phi, psi = law.jets(Jet.variable(t, 2) * 2.0 + 1.0)
    true = law.at(2 * t + 1, 2)
    scale = np.array([1.0, 2.0, 4.0])[:, None]
    np.testing.assert_allclose(phi.derivatives(), true[0] * scale, rtol=1e-12, atol=1e-12)
    np.testing.assert_allclose(psi.derivatives(), true[1] * scale, rtol=1e-12, atol=1e-12)


# --- refusals ---


@pytest.mark.parametrize(
    ("lam", "mu", "arm", "field", "message"),
    [
        (5, 4, L, "ratio", "the denominator of 5/4 is even: the pitch curve would cross itself (W 3)"),
        (8, 6, L, "ratio", "8/6 is not in lowest terms; write 4/3"),
        (3, 3, L, "ratio", "pi/alpha = lam/mu must be above 1, not 3/3 (W 2.2)"),
        (1, 3, L, "ratio", "pi/alpha = lam/mu must be above 1, not 1/3 (W 2.2)"),
        (3, -1, L, "ratio", "pi/alpha = lam/mu must be above 1, not 3/-1 (W 2.2)"),
        (3, 1, 0.0, "arm", "the arm must be above 0, not 0 mm"),
        (3, 1, math.nan, "arm", "the arm must be above 0, not nan mm"),
    ],
)
def test_ratios_that_wunderlich_excludes(lam, mu, arm, field, message):
    moves = programme([Segment("dwell", 1.0)], 1.0)
    for build in (
        lambda: from_delta(lam, mu, arm, {1: 1.0}, {}),
        lambda: from_law(lam, mu, arm, moves),
        lambda: from_arc(lam, mu, arm, 70.0),
        lambda: from_rosette(lam, mu, arm, leaf("sin(pi*x)")),
    ):
        with pytest.raises(IntentError) as caught:
            build()
        assert (caught.value.field, caught.value.message) == (field, message)


@pytest.mark.thin(4)
@pytest.mark.parametrize(
    ("build", "field", "at", "message"),
    [
        (
            lambda: from_delta(4, 3, L, {1: 1.0}, {2: 1.0}),
            "delta.sin",
            None,
            "D(t + delta) = -D(t) allows odd harmonics only, not 2",
        ),
        (
            lambda: from_delta(2, 1, L, {1: 3600.0}, {}),
            "delta",
            0.0,
            "|D| must stay below l^2 = 3600 mm^2; it reaches 3600",
        ),
        (
            lambda: from_delta(4, 3, L, {1: 2600.0}, {}),
            "delta",
            44.380871,
            (
                "the follower would swing 46.2383 degrees to each side; below 45 is possible with lam/mu = 4/3, there "
                "roller A's distance from the shaft reaches 0"
            ),
        ),
        (
            lambda: from_delta(3, 1, L, {1: 2401.0}, {}),
            "delta",
            60.0,
            f"{STEEP} 1.00020829 at a shaft angle of 60 degrees",
        ),
        (
            lambda: from_law(4, 3, L, programme([degrees("rise", 20, 15), degrees("return", 25, 15)], math.pi / 4)),
            "law",
            10.0,
            f"{STEEP} 1.5 at a shaft angle of 10 degrees",
        ),
        (
            lambda: from_law(4, 3, L, programme([degrees("rise", 45, 4)], math.pi / 4)),
            "law",
            None,
            "psi must come back to 0 at the end of the law; it is 4 deg",
        ),
        (
            lambda: from_law(
                4,
                3,
                L,
                programme(
                    [
                        Segment("rise", math.radians(20), math.radians(4), polynomial_law([0, 1, 1, -1])),
                        degrees("return", 25, 4),
                    ],
                    math.pi / 4,
                ),
            ),
            "law",
            0.0,
            "psi'(phi) jumps from 0 to 0.2 at a shaft angle of 0 degrees: the pitch curve would have a corner",
        ),
        (
            lambda: from_arc(3, 1, L, 20.0),
            "arc.radius",
            None,
            "a convex arc needs a radius above 60 mm, not 20 mm: its middle would lie 2 l or farther from the shaft",
        ),
        (
            lambda: from_arc(3, 1, L, 59.5, "concave"),
            "arc.side",
            30.0,
            (
                f"{STEEP.removesuffix('; it reaches')}; with a whole ratio such as 3 a straight first line reaches 1 "
                "where it begins, and a concave arc of any radius more; a convex arc would satisfy it, "
                "or a ratio such as 5/3"
            ),
        ),
        (
            lambda: from_arc(5, 3, L, 37.0, "concave"),
            "arc.radius",
            None,
            (
                "a concave arc needs a radius above 37.0820394 mm, not 37 mm: below, psi'(phi) reaches 1 where the arc "
                "begins, and the cam cannot be turned through"
            ),
        ),
        (
            lambda: from_arc(3, 1, L, 55.0),
            "arc.radius",
            None,
            "a convex arc needs a radius above 60 mm, not 55 mm: its middle would lie 2 l or farther from the shaft",
        ),
        (
            lambda: from_rosette(4, 3, L, leaf("1 + 10*sin(pi*x)")),
            "rosette.leaf",
            None,
            "the leaf must begin and end in the shaft; |OQ| is 1 mm at x = 0",
        ),
        (
            lambda: from_rosette(4, 3, L, leaf("10*sin(2*pi*x)")),
            "rosette.leaf",
            None,
            "|OQ| is a distance; it is -10 mm at x = 0.75",
        ),
        (
            lambda: from_rosette(4, 3, L, leaf("80*sin(pi*x)")),
            "rosette.leaf",
            None,
            (
                "|OQ| must stay below 45.9220119 mm, where an arm would reach the shaft or be fully stretched; it is "
                "80 mm at x = 0.5"
            ),
        ),
        (
            lambda: from_rosette(4, 3, L, leaf("10*x*(1 - x)**2")),
            "rosette.leaf",
            0.0,
            "psi'(phi) jumps from 0 to 0.191850609 at a shaft angle of 0 degrees: the pitch curve would have a corner",
        ),
        (
            lambda: from_rosette(4, 3, L, leaf("40*sin(pi*x)")),
            "rosette.leaf",
            0.0,
            f"{STEEP} 1.14285714 at a shaft angle of 0 degrees",
        ),
        (
            lambda: from_rosette(4, 3, L, leaf("sqrt(x)*(1 - x)")),
            "rosette.leaf",
            None,
            "derivative of sqrt at zero at x = 0",
        ),
    ],
)
def test_laws_that_no_cam_has(build, field, at, message):
    with pytest.raises(IntentError) as caught:
        build()
    assert (caught.value.field, caught.value.message) == (field, message)
    assert caught.value.at_deg == (at if at is None else pytest.approx(at, abs=1e-4))


@pytest.mark.thin(3)
@pytest.mark.parametrize(("lam", "mu"), [(3, 1), (4, 1), (4, 3), (5, 3), (7, 5)])
def test_a_cosine_can_be_turned_through_up_to_two_lambdaths_of_the_square(lam, mu):
    """psi' < 1 with D = m^2 cos(lam t) is 4 D^2 + D'^2 < 4 l^4, that is m^2/l^2 < 2/lam for lam > 2."""
    from_delta(lam, mu, L, {1: L * L * 2 / lam * (1 - 1e-10)}, {})
    with pytest.raises(IntentError, match=r"psi'\(phi\) must stay below 1"):
        from_delta(lam, mu, L, {1: L * L * 2 / lam * (1 + 1e-10)}, {})


def test_a_straight_first_arc_is_the_limit_for_whole_ratios():
    """At the joint psi' by t is 2 cot(alpha/2) tan(delta/2) for a straight line: exactly 2 when alpha = delta."""
    from_arc(3, 1, L, 1e7)
    with pytest.raises(IntentError, match=r"psi'\(phi\) must stay below 1"):
        from_arc(3, 1, L, 1e7, "concave")
    from_arc(4, 3, L, 1e7, "concave")


def test_a_slope_just_below_one_is_proved_and_just_above_refused():
    for slope, sound in ((1 - 1e-7, True), (1 + 1e-7, False)):
        stroke = slope * math.radians(20) / 2.0  # the cycloidal law's greatest velocity is 2
        moves = [Segment("rise", math.radians(20), stroke, law("cycloidal")), degrees("dwell", 1)]
        moves.append(Segment("return", math.radians(39), stroke, law("cycloidal")))
        build = programme(moves, math.pi / 3)
        if sound:
            assert from_law(3, 1, L, build).psi_of_shaft(math.radians(10), 1)[1, 0] == pytest.approx(slope, abs=1e-12)
        else:
            with pytest.raises(IntentError, match=r"it reaches 1\.0000001 at a shaft angle of 10 degrees"):
                from_law(3, 1, L, build)


def test_a_slope_too_steep_at_the_very_end_of_a_law():
    quadratic = Segment("rise", math.radians(20), math.radians(11), polynomial_law([0, 0, 1]))  # ends with slope 1.1
    with pytest.raises(IntentError, match=r"it reaches 1\.1 at a shaft angle of 45 degrees"):
        from_law(4, 3, L, programme([degrees("return", 25, 11), quadratic], math.pi / 4))


def test_a_programme_of_another_angle_is_the_callers_fault():
    with pytest.raises(ValueError, match="not delta"):
        from_law(3, 1, L, programme([Segment("dwell", 1.0)], 1.0))


def test_no_motion_is_a_circle_about_the_shaft():
    still = [
        from_delta(4, 3, L, {}, {}),
        from_law(4, 3, L, programme([Segment("dwell", math.pi / 4)], math.pi / 4)),
        from_rosette(4, 3, L, leaf("0")),
    ]
    for rest in still:
        assert rest.breaks.tolist() == []
        assert rest.radius == pytest.approx([2 * L * math.cos(rest.alpha / 2)])
        assert rest.psi_of_shaft(np.linspace(0, 7, 9), 2).tolist() == np.zeros((3, 9)).tolist()


@pytest.mark.parametrize("size", [0.3, 1.0])  # of what reaches |D| = l^2, where the other factor vanishes
@pytest.mark.parametrize("sense", [1.0, -1.0])
def test_factors_over_intervals_hold_those_at_points(size, sense):
    waves = {1: 900.0, 3: 140.0, 5: -60.0, 9: 31.0}
    scale = sense * size * 3600.0 / sum(waves.values())
    law = FromDelta(Harmonics(0.0, tuple((k, scale * a, 0.0) for k, a in waves.items())), 3600.0)
    low = np.linspace(-np.pi, np.pi, 49)[:-1]
    t = BallJet.variable(low, low + 0.13, 4)
    for share in (0.0, 0.37, 1.0):
        at = Jet.variable(low + share * 0.13, 4)
        for ball, jet in zip(law.factors(t, law.delta(t)), law.factors(at, law.delta(at)), strict=True):
            below, above = ball.bounds()
            noise = 1e-12 * np.abs(jet.derivatives()).max(axis=1, keepdims=True)
            assert (below - noise <= jet.derivatives()).all()
            assert (jet.derivatives() <= above + noise).all()
            assert (above - below)[1:].max() < 2.0 * np.ptp(jet.derivatives(), axis=1)[1:].max()
