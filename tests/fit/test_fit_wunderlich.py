"""Fits of Wunderlich's curves, convex and hollow, with breaks, against distances measured without the fitters.

The pitch curve is written out from W's formulas in plain numpy (W section 5; docs/theory.md 6). The contour of a roller
lies at the roller's radius inside it, so a point's distance from the contour is its distance from the pitch curve less
that radius: found from a dense table and Newton's steps.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import mpmath as mp
import numpy as np
import pytest
from support.cases import few
from support.fitted_points import arc_points, polygon_points, some, spline_points
from support.programmes import Segment, law, programme

from camgeo.curve.curvature import least_radius
from camgeo.curve.curve import Curve
from camgeo.curve.parallel import Parallel
from camgeo.curve.wunderlich import FlatPairShape, PitchShape
from camgeo.fit.arcs import arc_density, fit_arcs
from camgeo.fit.nodes import Density
from camgeo.fit.polygon import fit_polygon, least_vertices
from camgeo.fit.spline import fit_spline
from kin.law.transmission import from_arc, from_delta, from_law
from kin.numeric.elementary import Jet

if TYPE_CHECKING:
    from collections.abc import Callable

    from camgeo.curve.curve import Shape
    from camgeo.fit.pieces import ArcSpline, BSpline, Polygon

TOLERANCES = (1e-1, 1e-3, 1e-5, 1e-6)
ARM = 60.0


def delta_radius(lam: int, mu: int, waves: dict[int, float]) -> Callable[[np.ndarray], np.ndarray]:
    """r = sqrt2 [a sqrt(l^2 + D) + b sqrt(l^2 - D)] (W section 5)."""
    alpha = math.pi * mu / lam
    a, b = math.cos(math.pi / 4 - alpha / 2), math.sin(math.pi / 4 - alpha / 2)

    def radius(t: np.ndarray) -> np.ndarray:
        d = sum(c * np.cos(j * lam * t) for j, c in waves.items())
        return math.sqrt(2) * (a * np.sqrt(ARM**2 + d) + b * np.sqrt(ARM**2 - d))

    return radius


def arc_radius(lam: int, mu: int, bend: float) -> Callable[[np.ndarray], np.ndarray]:
    """r of a convex arc on [0, delta], then r(t + delta) = r cos alpha + sqrt(4 l^2 - r^2) sin alpha."""
    alpha, delta = math.pi * mu / lam, math.pi / lam
    mean = 2 * ARM * math.cos(alpha / 2)
    centre = mean * math.cos(delta / 2) - math.sqrt(bend**2 - (mean * math.sin(delta / 2)) ** 2)

    def radius(t: np.ndarray) -> np.ndarray:
        fold = np.floor(t.real / delta)
        x = t - fold * delta - delta / 2
        r = centre * np.cos(x) + np.sqrt(bend**2 - (centre * np.sin(x)) ** 2)
        image = r * math.cos(alpha) + np.sqrt(4 * ARM**2 - r**2) * math.sin(alpha)
        return np.where(fold % 2 == 0, r, image)

    return radius


@dataclass(frozen=True)
class Case:
    shape: Shape
    point: Callable[[np.ndarray], np.ndarray]  # complex t to complex-step x, y: (2, n)
    inside: float = 0.0
    extrema: int = 0
    breaks: int = 0


def polar(radius: Callable[[np.ndarray], np.ndarray]) -> Callable[[np.ndarray], np.ndarray]:
    return lambda t: radius(t) * np.stack([np.cos(t), np.sin(t)])


def ellipse(t: np.ndarray) -> np.ndarray:
    """The pair of lam = 2 works an ellipse: r^2 = A cos^2 t + B sin^2 t as the support function (W section 5)."""
    a, b = math.sqrt(2 * (ARM**2 + 360.0)), math.sqrt(2 * (ARM**2 - 360.0))
    return np.stack([a * np.cos(t), b * np.sin(t)])


def rollers(lam: int, mu: int, waves: dict[int, float], roller: float, extrema: int) -> Case:
    shape = Parallel(PitchShape(from_delta(lam, mu, ARM, waves, {})), roller)
    return Case(shape, polar(delta_radius(lam, mu, waves)), roller, extrema)


CASES = {
    "booth's oval": rollers(2, 1, {1: 0.3 * ARM**2}, 8.0, 4),
    "hollow booth": rollers(2, 1, {1: 0.8 * ARM**2}, 5.0, 8),
    "figure 9": rollers(4, 3, {1: 625.0}, 8.0, 16),
    "two waves": rollers(3, 1, {1: 300.0, 3: 12.0}, 6.0, 36),
    "arcs": Case(Parallel(PitchShape(from_arc(3, 1, ARM, 70.0)), 8.0), polar(arc_radius(3, 1, 70.0)), 8.0, 3, 6),
    "ellipse": Case(FlatPairShape(from_delta(2, 1, ARM, {1: 360.0}, {})), ellipse, 0.0, 4),
}


@pytest.fixture(params=CASES, scope="module")
def case(request: pytest.FixtureRequest) -> Case:
    return CASES[request.param]


def outward(case: Case, points: np.ndarray) -> np.ndarray:
    """Signed distance of points (n, 2) outside the exact contour, (n,)."""
    table = np.linspace(0, 2 * np.pi, 1500, endpoint=False)
    x, y = case.point(table)
    t = np.empty(len(points))
    for part in np.array_split(np.arange(len(points)), max(1, len(points) // 500)):
        gap = (points[part, :1] - x) ** 2 + (points[part, 1:] - y) ** 2
        t[part] = table[np.argmin(gap, axis=1)]
    step = 1e-200  # complex step: derivatives exact to rounding
    for _ in range(12):
        on = case.point(t + 1j * step)
        along = on.imag / step
        gap = points.T - on.real
        miss = (gap * along).sum(axis=0)
        # the second derivative steers the search alone: a difference quotient will do
        bend = (case.point(t + 1e-6 + 1j * step).imag - case.point(t - 1e-6 + 1j * step).imag) / (2e-6 * step)
        slope = (along**2).sum(axis=0) - (gap * bend).sum(axis=0)
        t = t + miss / np.maximum(slope, 0.05 * (along**2).sum(axis=0))
    along = along / np.hypot(*along)
    side = gap[0] * along[1] - gap[1] * along[0]
    assert np.abs((gap * along).sum(axis=0)).max() < 1e-6, "the foot was found"
    return np.sign(side) * np.hypot(*gap) + case.inside


def check_proof(
    case: Case, fitted: Polygon | ArcSpline | BSpline, points: np.ndarray, tolerance: float, slack: float
) -> None:
    """The bound holds, is within the tolerance, and exceeds what is measured by no more than the proof's slack."""
    gap = outward(case, points)
    floor = 2e-12
    assert gap.max() <= fitted.bound.outward + floor
    assert -gap.min() <= fitted.bound.inward + floor
    assert fitted.bound.worst <= tolerance
    assert np.abs(gap).max() >= fitted.bound.worst - slack * tolerance - floor


@pytest.mark.thin(6)
@pytest.mark.parametrize("tolerance", few(TOLERANCES, 2))
def test_polygon_is_proved_full_and_small(case: Case, tolerance: float) -> None:
    curve = Curve.whole(case.shape)
    polygon = fit_polygon(curve, tolerance)
    points = polygon_points(polygon, max(6, some(polygon.count)))
    check_proof(case, polygon, points[:: max(1, len(points) // 3_000)], tolerance, 0.05)
    if polygon.count >= 25:
        assert polygon.bound.worst > 0.9 * tolerance
    assert polygon.count <= math.ceil(1.01 * least_vertices(curve, tolerance)) + 1 + case.breaks


@pytest.mark.thin(6)
@pytest.mark.parametrize("tolerance", few(TOLERANCES, 2))
def test_arcs_are_proved_and_few(case: Case, tolerance: float) -> None:
    curve = Curve.whole(case.shape)
    arcs = fit_arcs(curve, tolerance)
    check_proof(case, arcs, arc_points(arcs, some(arcs.count)), tolerance, 0.05)
    densities = Density.of(curve, curve.runs[0].stretches, arc_density)
    least = sum(density.total for density in densities) / math.cbrt(tolerance)
    assert arcs.count <= 1.05 * least + 4 * (case.breaks + case.extrema)


@pytest.mark.thin(6)
@pytest.mark.parametrize("tolerance", few(TOLERANCES, 2))
def test_spline_is_proved(case: Case, tolerance: float) -> None:
    spline = fit_spline(Curve.whole(case.shape), tolerance)
    check_proof(case, spline, spline_points(spline, some(spline.spans)), tolerance, 0.05)


@pytest.mark.thin(3)
@pytest.mark.parametrize("tolerance", TOLERANCES[:2])
def test_curve_is_near_the_polygon_too(case: Case, tolerance: float) -> None:
    """The other half of the Hausdorff distance: no point of the contour is farther from every edge than promised."""
    polygon = fit_polygon(Curve.whole(case.shape), tolerance)
    t = np.linspace(0, 2 * np.pi, 900, endpoint=False) + 1e-4
    on = case.point(t + 1e-200j)
    along = on.imag / np.hypot(*on.imag)
    contour = on.real - case.inside * np.stack([along[1], -along[0]])
    a = polygon.vertices.T[:, None]
    chord = np.roll(a, -1, axis=2) - a
    gap = contour[:, :, None] - a
    share = np.clip((gap * chord).sum(axis=0) / (chord**2).sum(axis=0), 0, 1)
    distance = np.hypot(*(gap - share * chord)).min(axis=1)
    assert distance.max() <= polygon.bound.worst + 1e-12


def test_given_arcs_stay_arcs() -> None:
    """The route from an arc of 70 mm: each of its three places is one arc of 62 mm under an 8 mm roller."""
    arcs = fit_arcs(Curve.whole(CASES["arcs"].shape), 1e-6)
    chord = np.hypot(*(np.roll(arcs.points, -1, axis=0) - arcs.points).T)
    half = 2 * np.arctan(arcs.bulges)
    radius = chord / (2 * np.sin(half))
    whole = np.abs(radius - 62.0) < 1e-9
    assert whole.sum() == 3
    assert chord[whole] == pytest.approx(chord[whole][0])


@pytest.mark.slow
def test_every_rest_of_a_law_is_one_arc() -> None:
    motion = [
        Segment("rise", math.radians(15), math.radians(2), law("cycloidal")),
        Segment("dwell", math.radians(10)),
        Segment("return", math.radians(20), math.radians(2), law("cycloidal")),
    ]
    transmission = from_law(4, 3, ARM, programme(motion, math.radians(45)))
    curve = Curve.whole(Parallel(PitchShape(transmission), 8.0))
    rests = int(transmission.steady.sum())
    assert rests == 8
    arcs = fit_arcs(curve, 1e-5)
    chord = np.hypot(*(np.roll(arcs.points, -1, axis=0) - arcs.points).T)
    radius = chord / (2 * np.sin(2 * np.arctan(arcs.bulges)))
    expected = [2 * ARM * math.cos((psi + transmission.alpha) / 2) - 8.0 for psi in np.radians([2.0, -2.0])]
    assert sum(int((np.abs(radius - r) < 1e-7).sum()) for r in expected) == rests
    for tolerance in (TOLERANCES[0], TOLERANCES[-1]):
        for fit in (fit_polygon, fit_arcs, fit_spline):
            assert fit(curve, tolerance).bound.worst <= tolerance


def test_a_moved_vertex_is_seen() -> None:
    """The measure itself can fail: a vertex moved by twice the tolerance is found."""
    case = CASES["hollow booth"]
    polygon = fit_polygon(Curve.whole(case.shape), 1e-3)
    vertices = polygon.vertices.copy()
    vertices[17] *= 1.0 + 2e-3 / np.hypot(*vertices[17])
    assert np.abs(outward(case, vertices)).max() > 2e-3


@pytest.mark.parametrize("kind", [PitchShape, FlatPairShape])
@pytest.mark.parametrize("route", ["cosines", "with sines", "arc"])
def test_rates_by_hand_are_those_of_series(kind: type[PitchShape | FlatPairShape], route: str) -> None:
    law = {
        "cosines": from_delta(2, 1, ARM, {1: 0.8 * ARM**2}, {}),
        "with sines": from_delta(4, 3, ARM, {1: 500.0, 3: 5.0}, {1: 60.0}),
        "arc": from_arc(3, 1, ARM, 70.0),
    }[route]
    shape = kind(law)
    t = np.linspace(0.01, 2 * np.pi, 83)
    at = shape.sample(t)
    speed, turn = (Jet(rows).derivatives() for rows in shape.series(t, 1))
    assert at.speed == pytest.approx(speed[0], rel=1e-13)
    assert at.turn == pytest.approx(turn[0], rel=1e-13, abs=1e-13)
    assert at.speed_slope == pytest.approx(speed[1], rel=1e-13, abs=1e-13 * np.abs(speed[1]).max())
    assert at.turn_slope == pytest.approx(turn[1], rel=1e-13, abs=1e-13 * np.abs(turn[1]).max())


def test_cells_of_one_period_hold_over_the_whole_turn(case: Case) -> None:
    curve = Curve.whole(case.shape)
    cells = curve.cells
    assert np.array_equal(cells.low[1:], cells.high[:-1])
    assert (cells.low[0], cells.high[-1]) == (curve.runs[0].low, curve.runs[0].high)
    assert np.isin([low for low, _ in curve.runs[0].stretches], cells.low).all()
    t = cells.low[:, None] + (cells.high - cells.low)[:, None] * np.linspace(0, 1, 7)[1:-1]
    at = curve.sample(t.ravel())
    bounds = curve.cells.over(t.ravel(), t.ravel())
    assert (bounds.speed_low <= at.speed).all()
    assert (at.speed <= bounds.speed_high).all()
    assert (bounds.turn_low <= at.turn + 1e-12).all()
    assert (at.turn <= bounds.turn_high + 1e-12).all()
    assert (np.abs(at.speed_slope) <= bounds.speed_slope).all()
    assert (np.abs(at.turn_slope) <= bounds.turn_slope + 1e-12).all()


def needle(share: float, t: float) -> tuple[mp.mpf, mp.mpf, mp.mpf]:
    """Point and radius of curvature of the ellipse that lambda/mu = 2/1 works, m^2 = share of l^2, at its normal t."""
    a2, b2 = 2 * mp.mpf(ARM) ** 2 * (1 + mp.mpf(share)), 2 * mp.mpf(ARM) ** 2 * (1 - mp.mpf(share))
    c, s = mp.cos(mp.mpf(t)), mp.sin(mp.mpf(t))
    r = mp.sqrt(a2 * c * c + b2 * s * s)
    return a2 * c / r, b2 * s / r, a2 * b2 / r**3


@pytest.mark.thin(2)
@pytest.mark.parametrize("thin", [2.0**-10, 2.0**-20, 2.0**-30, 2.0**-40])
def test_a_flat_pair_that_is_almost_a_needle(thin: float) -> None:
    """The ellipse's radii of curvature, l thin to l/sqrt(thin): each within the rounding of the size, or its own."""
    with mp.workdps(50):
        shape = FlatPairShape(from_delta(2, 1, ARM, {1: ARM**2 * (1.0 - thin)}, {}))
        curve = Curve.whole(shape)
        t = np.concatenate([np.linspace(0.0, 2 * np.pi, 41), np.pi / 2 + np.sqrt(thin) * np.linspace(-3, 3, 13)])
        at, exact = shape.sample(t), np.array([needle(1.0 - thin, x) for x in t])
        # an angle's own rounding moves points by the radius times it, and radii by 1/sqrt(thin) of themselves
        assert (np.abs(at.point - exact[:, :2]).max(axis=1) <= 1e-14 * ARM + 1e-15 * exact[:, 2]).all()
        assert (np.abs(at.speed - exact[:, 2]) <= 1e-14 * ARM + 2e-15 / np.sqrt(thin) * exact[:, 2]).all()
        inside = np.array([float(x) for x in exact[:, 2]])
        bounds = curve.cells.over(t, t)
        assert (bounds.speed_low <= inside * (1 + 1e-15)).all()
        assert (inside <= bounds.speed_high * (1 + 1e-15)).all()
    assert bounds.speed_low.min() > 0.0  # the tip is proved to be convex
    assert curve.cells.low.size < 10_000
    assert least_radius(curve)[0] == pytest.approx(ARM * thin / math.sqrt(1 - thin / 2), rel=1e-13, abs=1e-14 * ARM)
