"""A dwell is one arc and a disc two, also where nothing but the curve itself tells that it is round."""

import numpy as np
import pytest

from camgeo.fit.arcs import fit_arcs
from camgeo.recipe.loading import load_text
from kin.contour.contour import Contour

LAW = "[{rise: 1, over: 30, law: modified-sine}, {dwell: 30}, {return: 1, over: 30, law: cycloidal}]"
DISCS = [
    ("support, p: 25", 25.0, (0.0, 0.0)),
    ("support, p: 25 + 3*cos(t)", 25.0, (3.0, 0.0)),
    ("support, p: 25 + 3*cos(t) - sin(t)/3, shaft: [2, 1]", 25.0, (1.0, -4.0 / 3.0)),
    ("support, p: 25 + 3*cos(t/2)**2", 26.5, (1.5, 0.0)),
    ("support, fourier: {mean: 25, cos: {1: 3}}", 25.0, (3.0, 0.0)),
    ("double-roller, ratio: 2, arm: 40, roller_radius: 8, law: [{dwell: 90}]", 40.0 * 2.0**0.5 - 8.0, (0.0, 0.0)),
]


def curve_of(cam):
    cam = load_text(f"cam: {{kind: {cam}}}\nexport: {{files: [dxf]}}\n", "cam.yaml").cam
    return cam.exact().surfaces[0].curve


def turned(arcs):
    """Angles that the arcs turn through, degrees, the greatest first."""
    return np.sort(np.degrees(4.0 * np.arctan(arcs.bulges)))[::-1]


@pytest.mark.parametrize("tolerance", [1e-2, 1e-6, 1e-11])
@pytest.mark.parametrize(("cam", "radius", "centre"), DISCS)
def test_a_disc_is_two_half_circles(cam, radius, centre, tolerance):
    arcs = fit_arcs(curve_of(cam), tolerance)
    assert turned(arcs) == pytest.approx([180.0, 180.0], abs=1e-9)
    assert 0.0 <= arcs.bound.worst <= tolerance
    contour = Contour.from_bulges(arcs.points, arcs.bulges)
    points = contour.sample(50)
    off = np.abs(np.hypot(*(points - np.array(centre)).T) - radius)
    assert float(off.max()) <= 1e-12


@pytest.mark.parametrize(
    ("cam", "most", "dwells"),
    [
        ("support, p: '25 + max(0, cos(t))**6'", 17, [180.0]),
        ("support, p: '25 + 2*sin(t) + max(0, cos(t))**6'", 17, [180.0]),
        ("support, p: '25 + 2*sin(t) + 0.02*max(0, 0.8 - cos(t))**6'", 22, [73.7397952917]),
        (
            "constant-breadth, base_radius: 40, motion: [{rise: 3, over: 60, law: cycloidal}, {dwell: 120}]",
            24,
            [120.0] * 2,
        ),
        (f"flat-pair, ratio: 2, arm: 40, law: {LAW}", 76, [30.0] * 4),
    ],
)
def test_a_dwell_is_one_arc(cam, most, dwells):
    arcs = fit_arcs(curve_of(cam), 1e-3)
    assert turned(arcs)[: len(dwells)] == pytest.approx(dwells, abs=1e-6)
    assert turned(arcs)[len(dwells)] < 0.9 * dwells[-1]
    assert arcs.count <= most


def test_more_than_a_half_turn_is_two_arcs():
    arcs = fit_arcs(curve_of("support, p: '25 + 2*sin(t) + 5*max(0, cos(t) - 0.8)**6'"), 1e-6)
    assert turned(arcs)[:2] == pytest.approx([143.1301023542] * 2, abs=1e-6)


@pytest.mark.parametrize(
    ("ripple", "tolerance"), [("1e-4*sin(2*t)", 1e-3), ("1e-11*sin(2*t)", 1e-3), ("1e-6*sin(3*t)", 5e-7)]
)
def test_what_is_nearly_round_is_no_disc(ripple, tolerance):
    """Two half circles would meet in corners above rounding, or are too far off."""
    arcs = fit_arcs(curve_of(f"support, p: 25 + 3*cos(t) + {ripple}"), tolerance)
    assert arcs.count > 2
    assert arcs.bound.worst <= tolerance
    corner = Contour.from_bulges(arcs.points, arcs.bulges).joints
    assert float(np.abs(corner).max()) < 1e-13
