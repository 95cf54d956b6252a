"""The least number of vertices of a polygon that straddles a curve by e: the integral of sqrt(kappa/(16 e)) ds.

L. Fejes Toth's asymptotic formula for the best approximation of convex curves by polygons, for a polygon that may lie
on both sides. The curve is AS Figure 1, p = 25 + 2 cos 3t. Measured on the exported polyline and STL.
"""

import math

import mpmath as mp
import numpy as np
import pytest
from support.page_tables import Row

from camgeo.fit.polygon import least_vertices

E = 0.001


def formula(e):
    """The integral for p = 25 + 2 cos 3t by mpmath: ds = rho dt and kappa = 1/rho, rho = 25 - 16 cos 3t."""
    third = mp.quad(lambda t: mp.sqrt((25 - 16 * mp.cos(3 * t)) / (16 * e)), [0, mp.pi / 3, 2 * mp.pi / 3])
    return float(3 * third)


def deviation(vertices, shaft=(16.0, 7.5)):
    """Support function of the polygon less the curve's: least and greatest, exact at edges, to 1e-9 at vertices."""

    def lift(t):
        return 25 + 2 * np.cos(3 * t) - shaft[0] * np.cos(t) - shaft[1] * np.sin(t)

    edge = np.roll(vertices, -1, axis=0) - vertices
    normal = np.unwrap(np.arctan2(-edge[:, 0], edge[:, 1]))
    inward = (vertices * np.column_stack([np.cos(normal), np.sin(normal)])).sum(axis=1) - lift(normal)
    before = np.roll(normal, 1)
    before[0] -= 2 * np.pi
    t = before + np.linspace(0, 1, 401)[:, None] * (normal - before)
    outward = vertices[:, 0] * np.cos(t) + vertices[:, 1] * np.sin(t) - lift(t)
    return inward.min(), outward.max()


def rows(workshop):
    made = workshop.shipped("as-figure-1", "polyline")
    low, high = deviation(made.contour.vertices)
    source = "∫ √(κ/16e) ds"
    return [
        Row(
            "least vertices for p = 25 + 2 cos 3t at e = 0.001 mm",
            source,
            "241.25",
            241.25,
            least_vertices(made.design.only_surface.surface.curve, E),
            0.005,
            ".7g",
        ),
        Row("vertices of the exported polyline", "rounded up", "242", 242.0, made.drawing.pieces, 0.0, "d"),
        Row("farthest inward, in e", "at least -1", "-1", -1.0, low / E, 0.03, ".3f"),
        Row("farthest outward, in e", "at most 1", "1", 1.0, high / E, 0.03, ".3f"),
    ]


@pytest.fixture(scope="module")
def figure_1(workshop):
    return workshop.shipped("as-figure-1", "polyline")


@pytest.mark.slow
def test_least_count_against_mpmath(figure_1):
    assert formula(E) == pytest.approx(241.25, abs=0.005)
    assert least_vertices(figure_1.design.only_surface.surface.curve, E) == pytest.approx(formula(E), rel=1e-6)


@pytest.mark.slow
def test_the_file_has_no_vertex_too_many(figure_1):
    assert figure_1.drawing.pieces == math.ceil(formula(E))


@pytest.mark.slow
def test_the_file_straddles_the_curve_and_wastes_nothing(figure_1):
    low, high = deviation(figure_1.contour.vertices)
    assert -E <= low < -0.97 * E
    assert 0.97 * E < high <= E


@pytest.mark.slow
@pytest.mark.parametrize("e", [0.01, 0.0001])
def test_the_count_grows_as_the_root_of_the_tolerance(workshop, e):
    made = workshop.shipped("as-figure-1", "polyline", e)
    assert formula(e) <= made.drawing.pieces + 1 <= 1.01 * formula(e) + 2
    low, high = deviation(made.contour.vertices)
    assert max(-low, high) <= e


def test_a_moved_vertex_is_seen(figure_1):
    vertices = figure_1.contour.vertices.copy()
    vertices[100] *= 1 + 0.001 / np.hypot(*vertices[100])
    assert deviation(vertices)[1] > 1.3 * E
