"""S. Rabinowitz, A polynomial curve of constant width, Missouri J. Math. Sciences 9, 1997: p = 9 + cos 3t.

Measured on the spline of the exported R2000 DXF, whose points are put into the polynomial.
"""

import numpy as np
import pytest
from support.page_tables import Row

PI = np.pi


def polynomial(x, y):
    """The polynomial of degree 8 that vanishes on the curve."""
    r2, q = x * x + y * y, x * x - 3 * y * y
    return (
        r2**4
        - 45 * r2**3
        - 41283 * r2**2
        + 7950960 * r2
        + 16 * q**3
        + 48 * r2 * q**2
        + x * q * (16 * r2**2 - 5544 * r2 + 266382)
        - 373248000
    )


def gradient(x, y):
    """Its gradient (n,) by complex steps, which cancel nothing."""
    h = 1e-30
    return np.hypot(polynomial(x + 1j * h, y).imag, polynomial(x, y + 1j * h).imag) / h


def distances(contour):
    """Distance of points of the contour from the polynomial's curve, to first order: |F| / |grad F|, mm."""
    x, y = contour.sample(200).T
    return np.abs(polynomial(x, y)) / gradient(x, y)


def rows(workshop):
    made = workshop.shipped("rabinowitz", "spline")
    e, radius = (
        made.recipe.export.tolerance,
        made.design.only_surface.surface.curve.sample(np.linspace(0, 2 * PI, 3601)).speed,
    )
    source = "Rabinowitz 1997"
    q = made.contour.support(np.linspace(0, 2 * PI, 3601)).q
    breadth = q[:1800] + q[1800:3600]
    return [
        Row(
            "breadth, farthest from it at any angle",
            source,
            "18",
            18.0,
            breadth[np.abs(breadth - 18).argmax()],
            2 * e,
            ".8g",
        ),
        Row("perimeter (the spline)", source, "18 π", 18 * PI, made.contour.length, 2 * PI * e, ".9g"),
        Row("area (the spline)", source, "77 π", 77 * PI, made.contour.area, 1.001 * e * 18 * PI, ".9g"),
        Row("least radius of curvature", source, "1", 1.0, radius.min(), 1e-9),
        Row("greatest radius of curvature", source, "17", 17.0, radius.max(), 1e-9),
        Row(
            "distance of the file's points from the polynomial's zeros",
            source,
            "0",
            0.0,
            distances(made.contour).max(),
            1.01 * e,
            ".2g",
        ),
    ]


@pytest.fixture(scope="module")
def curve(workshop):
    return workshop.shipped("rabinowitz", "spline")


def test_the_polynomial_vanishes_on_the_parametric_curve():
    t = np.linspace(0, 2 * PI, 1001)
    p, slope = 9 + np.cos(3 * t), -3 * np.sin(3 * t)
    x, y = p * np.cos(t) - slope * np.sin(t), p * np.sin(t) + slope * np.cos(t)
    assert (np.abs(polynomial(x, y)) / gradient(x, y)).max() < 1e-9


@pytest.mark.slow
def test_the_polynomial_vanishes_on_the_file_within_its_tolerance(curve):
    found = distances(curve.contour)
    assert found.size > 1000
    assert found.max() <= 1.01 * curve.recipe.export.tolerance


def test_a_contour_grown_by_two_tolerances_is_told_apart(curve):
    assert distances(curve.contour.scaled(1 + 0.002 / 9)).max() > 1.5 * curve.recipe.export.tolerance


def test_radii_of_curvature(curve):
    assert curve.value("radius-of-curvature") == pytest.approx(1.0, abs=1e-7)
