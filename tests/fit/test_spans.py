"""Proof of cubic spans: against dense sampling, at any number of steps; what is spoilt is seen or left unproved."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from support.cases import examples, few
from support.shapes import booth

from camgeo.curve.curve import Bounds, Curve
from camgeo.curve.support import SupportShape
from camgeo.fit import spans
from camgeo.fit.handles import cubic_spans
from camgeo.fit.spans import Cubics, _bend, _curvature_bounds, _Rates, plane, spans_deviation
from kin.law.support_function import lift_from_fourier, lift_reuleaux

STEPS, DENSE = 4, 101  # of a span, and places in each at which its curvature is seen
CURVES = {
    "circle": Curve.whole(SupportShape(lift_from_fourier(25.0, {}, {}))),
    "fourier": Curve.whole(SupportShape(lift_from_fourier(25.0, {3: 2.0, 5: -0.3}, {2: 0.7}, (10.0, 4.0)))),
    "near undercut": Curve.whole(SupportShape(lift_from_fourier(25.0, {3: 3.0}, {}))),
    "reuleaux": Curve.whole(SupportShape(lift_reuleaux(3, 50.0, 5.0))),
    "booth": Curve.whole(booth(60.0, 20.0)),
}


def hermite(curve: Curve, low: np.ndarray, high: np.ndarray, factors: np.ndarray) -> np.ndarray:
    """Spans with the curve's end points and tangents, handles `factors` (n, 2) times a third of the chord."""
    a, b = curve.span(low, high)
    third = np.hypot(*(b.point - a.point).T)[:, None] / 3 * factors
    inner = a.point + third[:, :1] * a.tangent, b.point - third[:, 1:] * b.tangent
    return np.stack([a.point, *inner, b.point], axis=1)


def distances(curve: Curve, control: np.ndarray, low: float, high: float) -> np.ndarray:
    """Signed distance outside the curve of points of a span (4, 2), by the feet of their normals: bisection alone."""
    u = np.linspace(0, 1, 400)[:, None]
    p0, p1, p2, p3 = control
    points = (1 - u) ** 3 * p0 + 3 * u * (1 - u) ** 2 * p1 + 3 * u**2 * (1 - u) * p2 + u**3 * p3
    left, right = np.full(400, low), np.full(400, high)
    for _ in range(60):
        middle = 0.5 * (left + right)
        at = curve.sample(middle)
        behind = np.sum((points - at.point) * at.tangent, axis=1) > 0
        left, right = np.where(behind, middle, left), np.where(behind, right, middle)
    at = curve.sample(0.5 * (left + right))
    return np.sum((points - at.point) * at.normal, axis=1)


@pytest.mark.parametrize("name", few(CURVES, 2))
@settings(max_examples=examples(12), deadline=None)
@given(
    st.floats(0, 1),
    st.floats(-3, -0.5),
    st.tuples(st.floats(-0.5, 0.5), st.floats(-0.5, 0.5)),
    st.sampled_from([1, 2, 3, 5, 9]),
)
def test_what_is_proved_covers_the_span_at_any_number_of_steps(
    name: str, place: float, exponent: float, longer: tuple[float, float], steps: int
) -> None:
    curve = CURVES[name]
    for begin, end in curve.runs[0].stretches:
        width = (end - begin) * 10.0**exponent
        low = np.array([begin + place * (end - begin - width)])
        high = low + width
        control = hermite(curve, low, high, 1 + np.array([longer]))
        true = distances(curve, control[0], low[0], high[0])
        top, bottom, _ = spans._ranges(curve, Cubics.of(control), low, high, steps)
        assert top[0] >= true.max() - 1e-12
        assert bottom[0] >= -true.min() - 1e-12


@pytest.mark.thin(6)
@pytest.mark.parametrize("name", few(CURVES, 2))
@pytest.mark.parametrize("length", [0.5, 0.1, 0.02])
def test_it_exceeds_the_truth_by_a_fiftieth_at_most(name: str, length: float) -> None:
    curve = CURVES[name]
    begin, end = curve.runs[0].stretches[0]
    low = begin + (end - begin) * np.linspace(0.05, 0.95, 7) - 0.02 * length
    high = low + 0.04 * length * (end - begin)
    control, worst, _ = cubic_spans(curve, low, high, 0.0)
    tolerance = max(1.2 * float(worst.max()), 1e-11)
    outward, inward = spans_deviation(curve, control, low, high, tolerance)
    for i in range(low.size):
        true = distances(curve, control[i], low[i], high[i])
        assert -1e-13 <= outward[i] - max(true.max(), 0.0) <= 0.025 * tolerance + 1e-13
        assert -1e-13 <= inward[i] + min(true.min(), 0.0) <= 0.025 * tolerance + 1e-13


def test_the_error_of_the_proof_falls_as_the_fourth_power_of_the_step() -> None:
    curve = CURVES["fourier"]
    low, high = np.array([0.9]), np.array([1.1])
    control = cubic_spans(curve, low, high, 0.0)[0]
    beyond = [np.subtract(*spans._ranges(curve, Cubics.of(control), low, high, n)[:3:2]).max() for n in (8, 16, 32)]
    assert 12 < beyond[0] / beyond[1] < 20
    assert 12 < beyond[1] / beyond[2] < 20


def test_what_is_no_span_along_the_curve_is_not_proved() -> None:
    curve = CURVES["fourier"]
    low, high = np.full(4, 0.9), np.full(4, 1.3)
    control = hermite(curve, low, high, np.array([[-1.0, 1.0], [1.0, 9.0], [0.0, 0.0], [1.0, 1.0]]))
    outward, inward = spans_deviation(curve, control, low, high, 0.1)
    assert (np.maximum(outward, inward) > 0.1).tolist() == [
        True,
        True,
        True,
        False,
    ]  # the third stands still at its ends
    # a span that folds back on itself, its ends and end tangents as they should be
    folded = control[3].copy()
    folded[1], folded[2] = folded[0] + 4 * (folded[1] - folded[0]), folded[3] + 4 * (folded[2] - folded[3])
    outward, inward = spans_deviation(curve, folded[None], low[:1], high[:1], 1.0)
    assert min(outward[0], inward[0]) > 1.0


def test_cubics_are_their_bezier_points() -> None:
    control = np.random.default_rng(2).normal(size=(5, 4, 2))
    cubic = Cubics.of(control)
    assert cubic.ahead(np.ones(5)) + cubic.start == pytest.approx(plane(control[:, 3]))
    assert cubic.velocity(np.ones(5)) == pytest.approx(3 * plane(control[:, 3] - control[:, 2]))
    bend = plane(control[:, 3] - 2 * control[:, 2] + control[:, 1])
    assert cubic.acceleration(np.ones(5)) == pytest.approx(6 * bend)


def test_what_is_shorter_than_rounding_is_as_far_off_as_it_is_long() -> None:
    curve = CURVES["fourier"]
    low = np.array([0.9])
    point = curve.sample(low).point
    control = np.repeat(point[:, None], 4, axis=1)
    outward, inward = spans_deviation(curve, control, low, low + 1e-15, 1e-3)
    assert max(outward[0], inward[0]) <= 1e-13


def rates_of(cubic: Cubics, u: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Absolute values of k, dk/ds and d2k/ds2 by truncated series of u, an arithmetic of its own."""
    p, a, j = cubic.velocity(u), cubic.acceleration(u), 6.0 * cubic.c
    n = np.array([(p.conj() * a).imag, (p.conj() * j).imag, (a.conj() * j).imag / 2.0])  # N(u + h) = n0 + n1 h + n2 h^2
    v = np.array([abs(p) ** 2, 2.0 * (p.conj() * a).real, (abs(a) ** 2 + (p.conj() * j).real)])
    # k = N v^(-3/2)
    r, q = v[1] / v[0], v[2] / v[0]
    power = np.array([np.ones_like(r), -1.5 * r, -1.5 * q + 1.875 * r**2]) * v[0] ** -1.5
    k0 = n[0] * power[0]
    k1 = n[1] * power[0] + n[0] * power[1]
    k2 = 2.0 * (n[2] * power[0] + n[1] * power[1] + n[0] * power[2])
    pace = np.sqrt(v[0])
    return abs(k0), abs(k1) / pace, abs(k2 / v[0] - k1 * v[1] / (2.0 * v[0] ** 2))


@pytest.mark.thin(2)
@pytest.mark.parametrize("seed", range(20))
def test_no_place_of_a_step_exceeds_its_bound(seed: int) -> None:
    rng = np.random.default_rng(seed)
    control = np.cumsum(rng.normal(size=(200, 4, 2)) * 0.5 + np.array([rng.choice([0.3, 1.0, 3.0]), 0.0]), axis=1)
    cubic = Cubics.of(control).column()
    u = np.broadcast_to(np.linspace(0.0, 1.0, STEPS + 1), (200, STEPS + 1))
    velocity, acceleration = cubic.velocity(u), cubic.acceleration(u)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        found = _curvature_bounds(cubic, u, np.abs(velocity), (velocity.conj() * acceleration).imag)
    within = np.linspace(0.0, 1.0, DENSE)
    for step in range(STEPS):
        places = u[:, step, None] + (u[:, step + 1] - u[:, step])[:, None] * within
        proved = [bound[:, step] for bound in (found.curvature, found.slope, found.bend)]
        for seen, bound in zip(rates_of(cubic, places), proved, strict=True):
            sane = np.isfinite(bound)
            assert sane.any()
            assert (seen.max(axis=1)[sane] <= bound[sane] * (1.0 + 1e-9)).all()


def test_a_step_in_which_the_span_may_stand_across_the_curve_is_not_confirmed() -> None:
    """A span of curvature 4 along a curve that turns by 1 rad: bounds leave an angle between them above a right one."""
    one, none, ends = np.ones(1), np.zeros(1), np.zeros((1, 2))
    bounds = Bounds(one, one, one, one, none, none, none, none)
    rates = _Rates(np.full((1, 1), 4.0), np.zeros((1, 1)), np.zeros((1, 1)))
    _, confirmed = _bend(
        np.ones((1, 1)), bounds, rates, g=ends, angle=ends, speed=ends + 1.0, turn=ends + 1.0, excess=ends + 3.0
    )
    assert not confirmed.any()
