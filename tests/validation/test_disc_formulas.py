"""Disc cams by the closed forms of the cam handbooks, written out here and held against the exported files.

R. L. Norton, Cam Design and Manufacturing Handbook, 2009 (N): a roller on a stem at the offset e has tan alpha =
(s' - e)/(sqrt(Rp^2 - e^2) + s); a flat face touches s' from its stem's line, at the radius of curvature Rb + s + s''.
A convex curve's perimeter is the integral of its support function (Cauchy), here Rb + s. A lobe's C_p is the product of
the other powers over the product of (power - p), negative.
"""

import math

import numpy as np
import pytest
from support.page_tables import Row

PI = math.pi
DEGREE = PI / 180
LOBE = (2, 8, 14, 20, 26)


def modified_sine(u):
    """s and s' of the middle of a modified sine, of a unit rise over a unit angle, u from 1/8 to 7/8."""
    k = PI / (PI + 4)
    s = 2 / (PI + 4) + k * u - 9 / (4 * (PI + 4)) * np.sin(4 * PI * u / 3 + PI / 3)
    return s, k * (1 - 3 * np.cos(4 * PI * u / 3 + PI / 3))


def rise_angle(e):
    """Greatest pressure angle of the rise of disc-roller at an offset, degrees."""
    s, v = modified_sine(np.linspace(1 / 8, 7 / 8, 400_001))
    return math.degrees(math.atan(((24 * v / (100 * DEGREE) - e) / (math.sqrt(45**2 - e**2) + 24 * s)).max()))


VALVE = """\
cam:
  kind: disc
  base_radius: 18
  follower: {kind: flat, width: 27}
  motion: {lobe: {lift: 8, half: 68, powers: [2, 8, 14, 20, 26]}}
part: {thickness: 14, bore: 20}
limits: {radius-of-curvature: {at_least: 3.5}}
export: {tolerance: 0.001, files: [dxf, stl, csv]}
"""  # that of valve-lobe


def lobe():
    """The lobe of valve-lobe as a polynomial in u, and its half angle in rad."""
    made = np.zeros(27)
    made[0] = 8.0
    for p in LOBE:
        others = [q for q in LOBE if q != p]
        made[p] = -8.0 * math.prod(others) / math.prod(q - p for q in others)
    return np.polynomial.Polynomial(made), 68 * DEGREE


def heart_area():
    """Half the integral of (Rb + s)^2 over the turn of disc-knife-edge; its halves are alike."""
    v = 26 / 140 * 20  # mm, slope of the constant velocity over one matched segment
    start = np.polynomial.Polynomial([0, 0, 0, 20 - 4 * v, 7 * v - 30, 12 - 3 * v])
    end = 30 - start(np.polynomial.Polynomial([1, -1]))
    middle = np.polynomial.Polynomial([2, 26])
    return sum(
        over * DEGREE * np.diff((((30 + s) ** 2).integ())(np.array([0.0, 1.0])))[0]
        for s, over in ((start, 20), (middle, 140), (end, 20))
    )


def rows(workshop):
    roller, flat = workshop.shipped("disc-roller"), workshop.shipped("disc-flat")
    valve, heart = workshop.written("lobe", VALVE), workshop.shipped("disc-knife-edge")
    e = 0.001
    s, half = lobe()
    u = np.linspace(-1, 1, 400_001)
    v, a = s.deriv()(u) / half, s.deriv(2)(u) / half**2
    lift = (s.integ()(1.0) - s.integ()(-1.0)) * half
    widest = max(abs(v.min()), v.max())
    size = heart.contour.as_arcs()[0].length.sum()
    return [
        Row("greatest pressure angle on the rise of disc-roller, deg", "N: tan α = (s' - e)/(√(Rp² - e²) + s)",
            f"{rise_angle(10):.7g}", rise_angle(10), roller.value("limit:pressure-angle-rise"), 1e-7),
        Row("perimeter of disc-flat, mm", "Cauchy: 2π Rb + ∫ s; laws are symmetric",
            "2π (30 + 12 · 140/360)", 2 * PI * (30 + 12 * 140 / 360),
            flat.contour.as_arcs()[0].length.sum(), 2 * PI * e),
        Row("perimeter of valve-lobe, mm", "Cauchy: 2π Rb + ∫ s",
            f"{2 * PI * 18 + lift:.7g}", 2 * PI * 18 + lift, valve.contour.as_arcs()[0].length.sum(), 2 * PI * e),
        Row("least radius of curvature of valve-lobe, mm", "N: Rb + s + s''",
            f"{(18 + s(u) + a).min():.7g}", (18 + s(u) + a).min(), valve.value("radius-of-curvature"), 1e-7),
        Row("travel of the contact over the tappet of valve-lobe, mm", "N: max s' - min s'",
            f"{2 * widest:.7g}", 2 * widest, valve.value("contact-travel"), 1e-7),
        Row("area of disc-knife-edge, mm²", "1/2 ∫ (Rb + s)² dθ",
            f"{heart_area():.7g}", heart_area(), heart.contour.area, size * e),
    ]  # fmt: skip


def test_the_offset_is_worth_what_the_recipe_says():
    assert rise_angle(10) == pytest.approx(14.4336, abs=1e-3)
    assert rise_angle(0) == pytest.approx(23.4439, abs=1e-3)


def test_a_lobe_ends_with_four_vanishing_derivatives():
    made, _ = lobe()
    assert [made.deriv(n)(1.0) if n else made(1.0) for n in range(5)] == pytest.approx([0.0] * 5, abs=1e-7)
