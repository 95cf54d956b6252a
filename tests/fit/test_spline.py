# needs: study
"""Spans of a spline against the least count of theory, and the theory against closed forms and small spans."""

from __future__ import annotations

import math

import numpy as np
import pytest
from support.cases import few
from support.places import RECIPES
from support.shapes import booth

from camgeo.capabilities.study.least_pieces import least_pieces, least_spline
from camgeo.curve.curve import Curve
from camgeo.curve.support import SupportShape
from camgeo.fit import spline as module
from camgeo.fit.cubic import LEAST, nearest_cubic, span_density
from camgeo.fit.handles import LOOKS, PLACES, Spans, cubic_spans, sampled_gap
from camgeo.fit.nodes import ToleranceError
from camgeo.fit.spans import plane
from camgeo.fit.spline import fit_spline
from camgeo.output import pipeline
from camgeo.recipe.loading import load, load_text
from camgeo.synthesis.design import designed
from kin.law.support_function import lift_from_fourier, lift_reuleaux

# one recipe for each contour that is shipped
CONTOURS = [
    "as-figure-1", "as-figure-2a", "as-figure-2b", "as-figure-2c", "as-figure-2d", "fourier", "hypocycloid",
    "oscillating-yoke", "rabinowitz", "reuleaux", "reuleaux-nine", "shu-wu", "slider-crank",
    "w-booth", "w-ellipse", "w-figure-5", "w-figure-9", "w-law", "w-rosette",
    "long-dwell",  # needs: sweep
]  # fmt: skip


def support(mean: float, cos: dict[int, float], sin: dict[int, float] | None = None) -> Curve:
    return Curve.whole(SupportShape(lift_from_fourier(mean, cos, sin or {})))


def stretches(curve: Curve) -> np.ndarray:
    return np.concatenate([run.stretches for run in curve.runs])


def test_the_two_constants() -> None:
    """Greatest values over [0, 1] of z (z - 1)^2 less half its greatest, and of (z - 1)^2 (z - m), over (1/2)^6."""
    z = np.linspace(0, 1, 100_001)
    even = z * (z - 1) ** 2
    assert np.abs(even - 0.5 * even.max()).max() / 64 == pytest.approx(1 / LEAST, rel=1e-8)
    m = 64 / module.ON_CURVE
    on_curve = (z - 1) ** 2 * (z - m)
    assert np.abs(on_curve).max() == pytest.approx(m, rel=1e-5)
    assert on_curve.max() == pytest.approx(-on_curve.min(), rel=1e-4)


@pytest.mark.parametrize("radius", [1e-3, 0.5, 25.0, 1e4])
def test_a_circle_in_closed_form(radius: float) -> None:
    curve = support(radius, {})
    found = nearest_cubic(*curve.shape.series(np.array([0.3]), 4))
    assert found.miss[0] == pytest.approx(1 / (128 * radius**5), rel=1e-12)
    assert found.lean[0] == pytest.approx(0.0, abs=1e-9 / radius)
    e = 1e-6 * radius
    assert least_spline(curve, e) == pytest.approx(2 * math.pi / (128 * 864 * 1e-6) ** (1 / 6), rel=1e-12)
    assert least_pieces("spline", curve, e) == least_spline(curve, e)


def test_a_parabola_and_a_cubic_are_met_for_good() -> None:
    """Curves that are cubics themselves: y = x^2/2, and y = x^3 about its inflection, by speed and turn over x."""
    from kin.numeric.elementary import Jet

    x = Jet.variable(np.array([-0.7, 0.1, 1.3]), 4)
    for slope, bend in ((x, x.constant(1.0)), (x * x * 3.0, x * 6.0)):
        square = slope * slope + 1.0
        found = nearest_cubic((square**0.5).c, (bend * square**-1).c)
        assert np.abs(found.miss).max() < 1e-12
    speed, turn = np.zeros((2, 5, 1))
    speed[0], turn[1] = 1.0, 6.0  # at the inflection itself
    assert np.isfinite(nearest_cubic(speed, turn).miss).all()


def test_small_spans_err_as_theory_says() -> None:
    curve = support(25.0, {2: 1.0, 3: 0.2}, {3: 0.1})
    for length in (4.0, 2.0, 1.0):
        middle = np.linspace(0.1, 6.2, 40)
        speed = curve.sample(middle).speed
        low, high = middle - 0.5 * length / speed, middle + 0.5 * length / speed
        miss = np.abs(nearest_cubic(*curve.shape.series(middle, 4)).miss)
        _, worst, _ = cubic_spans(curve, low, high, 0.0)
        ratio = worst / (miss * length**6 / module.ON_CURVE)
        clear = miss * length**6 / module.ON_CURVE > 1e-12  # of rounding
        assert clear.sum() > 20
        assert np.median(ratio[clear]) == pytest.approx(1.0, abs=0.02)


def test_no_span_of_a_right_length_does_better() -> None:
    """A span's handles are near the best there are: no others of a grid about them stray less by more than 2 %."""
    curve = support(25.0, {3: 2.0})
    low, high = np.array([0.9]), np.array([1.2])
    control, worst, _ = cubic_spans(curve, low, high, 0.0)
    a, b = curve.span(low, high)
    spans = Spans(low, high, *(plane(x) for x in (a.point, a.tangent, b.point, b.tangent)))
    own = np.array([np.hypot(*(control[0, i + 1] - control[0, i])) for i in (0, 2)])
    feet = (low + (high - low) * PLACES)[None]
    for i in np.linspace(-0.02, 0.02, 21):
        for j in np.linspace(-0.02, 0.02, 21):
            gap = sampled_gap(curve, spans, (own * (1 + np.array([i, j])))[None], feet)
            assert gap.shape == (1, LOOKS - 1)
            assert np.abs(gap).max() > 0.98 * worst[0]


@pytest.mark.thin(6)
@pytest.mark.parametrize("name", few(CONTOURS, 4))
def test_shipped_contours_are_within_a_fifth_of_the_least_count(name: str) -> None:
    contour = designed(load(RECIPES / f"{name}.yaml")).only_surface.contour
    assert contour is not None
    totals = span_density(contour, stretches(contour)).totals
    ratios = []
    for exponent in (-3, -4, -5, -6):
        tolerance = 10.0**exponent
        found = fit_spline(contour, tolerance)
        assert found.bound.worst <= tolerance
        # a joint stands in every break, and so a whole number of spans between two
        least = np.ceil(totals * tolerance ** (-1 / 6)).sum()
        ratios.append(found.count / least)
        assert 1.0 <= ratios[-1] <= 1.2
        if len(totals) == 1:
            assert found.count <= 1.2 * least_spline(contour, tolerance)
    assert np.mean(ratios) <= 1.16


@pytest.mark.slow
@pytest.mark.parametrize("tolerance", few([5e-4, 1.6e-4, 1e-5, 2e-6, 1e-6], 2))
def test_where_sharing_does_not_settle_what_came_nearest_is_halved(tolerance: float) -> None:
    """A double roller in whose contour many places have no nearest cubic, and these move about as nodes are shared."""
    delta = "{cos: {1: 130}, sin: {1: 60, 3: -14}}"
    body = f"cam: {{kind: double-roller, ratio: 5/3, arm: 55, roller_radius: 7, delta: {delta}}}\n"
    contour = designed(load_text(body, "a.yaml")).only_surface.contour
    assert contour is not None
    found = fit_spline(contour, tolerance)
    assert found.bound.worst <= tolerance
    assert found.count <= 1.25 * least_spline(contour, tolerance)


def test_curves_missed_to_one_side_take_no_more_than_theory_does() -> None:
    for name in ("reuleaux", "reuleaux-nine", "w-ellipse"):
        contour = designed(load(RECIPES / f"{name}.yaml")).only_surface.contour
        assert contour is not None
        totals = span_density(contour, stretches(contour)).totals
        for exponent in (-4, -6):
            found = fit_spline(contour, 10.0**exponent)
            assert found.count <= np.ceil(1.02 * totals * 10.0 ** (-exponent / 6)).sum() + 1


@pytest.mark.thin(4)
@pytest.mark.parametrize("share", few([0.5, 0.98, 0.999], 4))
@pytest.mark.parametrize("harmonic", [49, 97, 98, 99])
def test_high_harmonics_near_undercut_are_held(harmonic: int, share: float) -> None:
    curve = support(50.0, {harmonic: share * 50.0 / (harmonic**2 - 1)})
    found = fit_spline(curve, 1e-3)
    assert found.bound.worst <= 1e-3
    # places where the nearest cubic ceases to exist, several to a wave, come as close together as spans
    assert found.count <= 2.2 * least_spline(curve, 1e-3)


def test_within_a_nanometre() -> None:
    for curve in (support(25.0, {3: 2.0}), support(9.0, {3: 1.0}), Curve.whole(booth(60.0, 20.0))):
        found = fit_spline(curve, 1e-9)
        assert found.bound.worst <= 1e-9
        assert found.count <= 1.2 * least_spline(curve, 1e-9)


@pytest.mark.thin(3)
@pytest.mark.parametrize("name", ["as-figure-2a", "w-law", "reuleaux"])
def test_the_spline_is_smooth_in_its_own_parameter(name: str) -> None:
    contour = designed(load(RECIPES / f"{name}.yaml")).only_surface.contour
    assert contour is not None
    found = fit_spline(contour, 1e-5)
    pieces, steps = found.beziers(), np.diff(np.unique(found.knots))
    leaving = 3 * (pieces[1:, 1] - pieces[1:, 0]) / steps[1:, None]
    arriving = 3 * (pieces[:-1, 3] - pieces[:-1, 2]) / steps[:-1, None]
    assert np.abs(leaving - arriving).max() < 1e-9 * np.abs(leaving).max()
    # and at the seam in direction
    first, last = pieces[0, 1] - pieces[0, 0], pieces[-1, 3] - pieces[-1, 2]
    assert abs(first[0] * last[1] - first[1] * last[0]) < 1e-11 * np.hypot(*first) * np.hypot(*last)


@pytest.mark.slow
@pytest.mark.thin(3)
@pytest.mark.parametrize("name", few(["as-figure-2b", "reuleaux", "shu-wu", "w-booth"], 4))
@pytest.mark.parametrize("times", [1.0, 2.0, 20.0])
def test_any_tolerance_above_the_floor_is_held_after_a_few_attempts(
    name: str, times: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    contour = designed(load(RECIPES / f"{name}.yaml")).only_surface.contour
    assert contour is not None
    floor = module.FLOOR * 64 * float(np.finfo(np.float64).eps) * contour.size
    found_anew = []

    def counted(curve: Curve, low: np.ndarray, *rest: object) -> tuple[np.ndarray, ...]:
        found_anew.append(low.size)
        return cubic_spans(curve, low, *rest)

    monkeypatch.setattr(module, "cubic_spans", counted)
    found = fit_spline(contour, times * floor)
    assert found.bound.worst <= times * floor
    assert sum(found_anew) <= 30 * found.count
    with pytest.raises(ToleranceError, match="at least") as caught:
        fit_spline(contour, 0.99 * floor)
    assert caught.value.reached == pytest.approx(floor, rel=1e-9)


def test_spans_between_nodes_that_stay_are_not_sought_again(monkeypatch: pytest.MonkeyPatch) -> None:
    curve = support(25.0, {3: 2.0})
    nodes = np.linspace(0.0, 6.0, 13)
    first = module._Spans.none().between(curve, nodes[:-1], nodes[1:], 0.0, 1.0)
    first = first.prove(curve, np.ones(12, dtype=bool), 1.0)
    sought = []
    monkeypatch.setattr(module, "cubic_spans", lambda *a: sought.append(a[1:3]) or cubic_spans(*a))
    finer = np.sort(np.append(nodes, [0.75, 5.1]))
    again = first.between(curve, finer[:-1], finer[1:], 0.0, 1.0)
    assert [x.tolist() for x in sought[0]] == [[0.5, 0.75, 5.0, 5.1], [0.75, 1.0, 5.1, 5.5]]
    assert np.count_nonzero(np.isnan(again.outward)) == 4
    old = ~np.isnan(again.outward)
    kept = np.isin(first.low, again.low[old])
    assert np.array_equal(again.control[old], first.control[kept])
    assert np.array_equal(again.worst[old], first.worst[kept])


@pytest.mark.parametrize(
    ("sides", "rounding", "count"), [(99, 1e-12, 99), (5, 1e-14, 5), (3, 1e-12, 3), (99, 1e-9, 99), (3, 1e-6, 6)]
)
def test_roundings_too_small_for_a_reader_become_corners(sides: int, rounding: float, count: int) -> None:
    curve = Curve.whole(SupportShape(lift_reuleaux(sides, 50.0, rounding)))
    found = fit_spline(curve, 1e-3)
    assert found.count == count
    assert found.bound.worst <= 1e-3


@pytest.mark.slow
@pytest.mark.parametrize(
    ("fourier", "pivot", "tolerance"),
    few(
        [
            ("mean: 74518.6029814693, cos: {199: 1.8817829035705753}", "[74520.48476437287, 0]", 10.0077),
            ("mean: 25, cos: {3: 3.124999999996875}", "[7.5, -5]", 9.05e-5),
            ("mean: 25, cos: {33: 0.02297794117644761}", "[0, 0]", 0.0055),
        ],
        3,
        first=1,
    ),
)
def test_next_to_cusps_no_span_is_lost_to_the_knots_or_to_a_reader(fourier: str, pivot: str, tolerance: float) -> None:
    """Least radii of curvature of 1e-12 of the size: spans differ in length and in pace by many orders."""
    text = f"cam: {{kind: support, fourier: {{{fourier}}}, shaft: {pivot}}}\n"
    text += f"export: {{tolerance: {tolerance}, files: [{{dxf: {{as: spline}}}}]}}\nverify: {{angles: 360}}\n"
    outcome = pipeline.check(load_text(text, "cusps.yaml"))
    assert outcome.ok, [one for one in outcome.report["checks"] if not one["ok"]]
