"""Fits of disc cams of every follower: what is written lies within the tolerance of the exact contour, and says so."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest
from support.cases import few
from support.discs import CONTOURS, TURN
from support.fitted_points import arc_points, polygon_points, some, spline_points

from camgeo.curve.curve import Curve
from camgeo.fit.arcs import fit_arcs
from camgeo.fit.polygon import fit_polygon
from camgeo.fit.spline import fit_spline

if TYPE_CHECKING:
    from collections.abc import Callable

FITS = {
    "polyline": (fit_polygon, lambda found: polygon_points(found, 6)),
    "arcs": (fit_arcs, lambda found: arc_points(found, some(found.count))),
    "spline": (fit_spline, lambda found: spline_points(found, some(found.spans))),
}


def outward(curve: Curve, points: np.ndarray) -> np.ndarray:
    """Signed distance of points (n, 2) outside a contour: feet on it by Newton's method from the nearest of a table."""
    table = np.linspace(0.0, TURN, 2_000, endpoint=False)
    on = curve.sample(table).point
    t = np.concatenate(
        [
            table[np.argmin(((part[:, None] - on[None]) ** 2).sum(axis=2), axis=1)]
            for part in np.array_split(points, 1 + len(points) // 500)
        ]
    )
    for _ in range(8):
        at = curve.sample(t)
        along = ((points - at.point) * at.tangent).sum(axis=1)
        across = ((points - at.point) * at.normal).sum(axis=1)
        t = t + along / (at.speed + across * at.turn)
    assert np.abs(along).max() < 1e-9
    return across


@pytest.mark.thin(20)
@pytest.mark.parametrize("fit", FITS)
@pytest.mark.parametrize("name", CONTOURS)
@pytest.mark.parametrize("tolerance", few((1e-3, 1e-5, 1e-1), 3))
def test_fit_holds_its_tolerance(name: str, fit: str, tolerance: float) -> None:
    make, points_of = FITS[fit]
    check(Curve.whole(CONTOURS[name]), make, points_of, tolerance)


def check(curve: Curve, make: Callable, points_of: Callable, tolerance: float) -> None:
    fitted = make(curve, tolerance)
    points = points_of(fitted)
    gap = outward(curve, points[:: max(1, len(points) // 3_000)])
    floor = 2e-12 + 1e-13 * curve.size
    assert gap.max() <= fitted.bound.outward + floor
    assert -gap.min() <= fitted.bound.inward + floor
    assert fitted.bound.worst <= tolerance
    assert np.abs(gap).max() >= 0.3 * fitted.bound.worst


def test_a_dwell_is_one_arc() -> None:
    """Four stretches of the inline roller: two dwells, each one arc about the shaft, at any tolerance."""
    arcs = fit_arcs(Curve.whole(CONTOURS["roller"]), 1e-5)
    chord = np.hypot(*(np.roll(arcs.points, -1, axis=0) - arcs.points).T)
    radius = chord / (2 * np.sin(2 * np.arctan(arcs.bulges)))
    for dwell in (40.0, 60.0):
        found = np.abs(radius - dwell) < 1e-9
        assert found.sum() == 1
        assert chord[found] == pytest.approx(dwell, abs=1e-9)  # over 60 degrees
