"""M. E. Aygahoglu, Z. Saka, Kinematic analysis of constant breadth cam driven linkages, 2023 (AS): equations 1 to 10.

Measured on the arcs of the exported DXF files. The paper prints its curves and no numbers of them: perimeters are
held against Barbier's theorem, areas and lifts against closed forms written out here.
"""

import numpy as np
import pytest
from support.page_tables import Row

PI = np.pi
SHAFT = (16.0, 7.5)  # Figure 6
FIGURES = {
    "as-figure-1": ("AS Figure 1", lambda t: 4 * np.cos(1.5 * t) ** 2 + 23),
    "as-figure-2a": ("AS Figure 2a", lambda t: np.sin(3 * t) + 13 / 15 * np.sin(3 * t) * np.cos(2 * t) + 25),
    "as-figure-2b": ("AS Figure 2b", lambda t: 2 * np.cos(2 * t) ** 2 * np.sin(t) ** 3 + 25),
    "as-figure-2c": ("AS Figure 2c", lambda t: 2 * np.sin(PI * np.cos(t)) * np.cos(PI * np.sin(t)) + 25),
    "as-figure-2d": ("AS Figure 2d", lambda t: np.sin(2 * t) * np.cos(3 * t) + np.cos(3 * t) + 25),
}


def fourier_area(p):
    """1/2 integral of p^2 - p'^2 = pi (c0^2 + 1/2 sum of (1 - k^2) |c_k|^2), from 1024 values of p."""
    t = np.arange(1024) * 2 * PI / 1024
    c = np.abs(np.fft.rfft(p(t))) / 512
    k = np.arange(c.size)
    return PI * (c[0] ** 2 / 4 + 0.5 * np.sum((1 - k**2) * c**2 * (k > 0)))


def reuleaux_area(sides, breadth, rounding):
    """A regular Reuleaux polygon of breadth w - 2r and its parallel curve at r (Steiner)."""
    inner = breadth - 2 * rounding
    sharp = inner**2 / 2 * (PI - sides * np.tan(PI / (2 * sides)))
    return sharp + PI * inner * rounding + PI * rounding**2


def star_area(degrees, breadth):
    """Straight polygon and segments of a sharp Reuleaux polygon by the angles at the points of its star.

    The star's points lie at the sums of its diagonals, which turn by these angles and are run there and back.
    """
    angles = np.radians(degrees)
    turned = np.concatenate([[0.0], np.cumsum(angles[:-1])])
    points = np.cumsum((-1.0) ** np.arange(len(angles)) * np.exp(1j * turned))
    points = points[np.argsort(np.angle(points - points.mean()))]
    straight = 0.5 * np.sum((np.conj(points) * np.roll(points, -1)).imag)
    return breadth**2 * (straight + 0.5 * np.sum(angles - np.sin(angles)))


# a star of five by hand: two angles given, the others from the closing equations to 40 digits
FIVE = [50.0, 30.0, 15.712662486361410631, 33.366994074168145453, 50.920343439470443916]
WRITTEN = {
    "sharp Reuleaux triangle": "cam: {kind: support, reuleaux: {sides: 3, breadth: 50}}\n",
    "sharp Reuleaux polygon of unequal arcs": (
        "cam: {kind: support, reuleaux: {sides: 5, breadth: 50, angles: [50, 30]}}\n"
    ),
}


# breadth, mm; source; area, mm^2, where it has a closed form
CONSTANT_BREADTH = {
    **{name: (50.0, source, fourier_area(p)) for name, (source, p) in FIGURES.items()},
    "fourier": (50.0, "Resnikoff", PI * (625 - 0.5 * (8 * 1.5**2 + 24 * 0.3**2))),
    "hypocycloid": (50.0, "Euler", PI * (625 - 0.5 * 8 * 2.5**2)),
    "reuleaux": (50.0, "Reuleaux", reuleaux_area(3, 50.0, 5.0)),
    "reuleaux-nine": (50.8, "Reuleaux", reuleaux_area(9, 50.8, 5.08)),
    "sharp Reuleaux triangle": (50.0, "Blaschke, Lebesgue", 50.0**2 * (PI - np.sqrt(3)) / 2),
    "sharp Reuleaux polygon of unequal arcs": (50.0, "Reuleaux", star_area(FIVE, 50.0)),
    "rabinowitz": (18.0, "Rabinowitz", 77 * PI),
    "shu-wu": (100.0, "SW section 5", None),
}


def lift_range(p):
    """Least and greatest p - x cos t - y sin t (the closed form of AS 10), on a grid fine enough for 1e-8 mm."""
    t = np.linspace(0, 2 * PI, 400_001)
    s = p(t) - SHAFT[0] * np.cos(t) - SHAFT[1] * np.sin(t)
    return s.min(), s.max()


def measured_lift(contour):
    """Least and greatest distance of a flat face from the shaft, by contact with the contour."""
    q = contour.support(np.linspace(0, 2 * PI, 100_001)).q
    return q.min(), q.max()


def exported(workshop, name):
    """A shipped recipe, or one that is written here."""
    return workshop.written(name.replace(" ", "-"), WRITTEN[name]) if name in WRITTEN else workshop.shipped(name)


def rows(workshop):
    found = []
    for name, (breadth, source, area) in CONSTANT_BREADTH.items():
        made = exported(workshop, name)
        e = made.recipe.export.tolerance
        length = PI * breadth
        # two convex curves e apart differ by at most 2 pi e in length
        found.append(
            Row(
                f"perimeter of {name}, mm",
                f"Barbier; {source}",
                f"{length:.9g}",
                length,
                made.contour.length,
                2 * PI * e,
                ".9g",
            )
        )
        if area is not None:
            # and by e times the length in area
            found.append(
                Row(
                    f"area of {name}, mm²",
                    f"AS, 1/2 ∫ pρ; {source}",
                    f"{area:.9g}",
                    area,
                    made.contour.area,
                    1.001 * e * length,
                    ".9g",
                )
            )
    for name, (source, p) in FIGURES.items():
        made = workshop.shipped(name)
        for word, exact, ours in zip(("least", "greatest"), lift_range(p), measured_lift(made.contour), strict=True):
            found.append(
                Row(
                    f"{word} lift of {name}, shaft (16, 7.5), mm",
                    f"{source} and 6",
                    f"curve only; {exact:.8g}",
                    exact,
                    ours,
                    made.recipe.export.tolerance,
                    ".8g",
                )
            )
    return found


@pytest.fixture(scope="module", params=sorted(FIGURES))
def figure(request, workshop):
    return workshop.shipped(request.param), FIGURES[request.param][1]


@pytest.fixture(scope="module", params=sorted(CONSTANT_BREADTH))
def constant_breadth(request, workshop):
    return exported(workshop, request.param), CONSTANT_BREADTH[request.param]


@pytest.mark.slow
def test_equation_4_breadth_is_constant_at_every_angle_of_the_file(constant_breadth):
    made, (breadth, _, _) = constant_breadth
    t = np.linspace(0, PI, 5001)
    measured = made.contour.support(t).q + made.contour.support(t + PI).q
    assert np.abs(measured - breadth).max() <= 2 * made.recipe.export.tolerance


@pytest.mark.thin(18)
def test_barbier_and_area(constant_breadth):
    made, (breadth, _, area) = constant_breadth
    e = made.recipe.export.tolerance
    assert made.contour.length == pytest.approx(PI * breadth, abs=2 * PI * e)
    if area is not None:
        assert made.contour.area == pytest.approx(area, abs=1.001 * e * PI * breadth)


@pytest.mark.thin(5)
def test_equation_10_lift_of_the_file_at_every_angle(figure):
    made, p = figure
    t = np.linspace(0, 2 * PI, 5001)
    lift = p(t) - SHAFT[0] * np.cos(t) - SHAFT[1] * np.sin(t)
    assert np.abs(made.contour.support(t).q - lift).max() <= made.recipe.export.tolerance
    assert made.motion["lift_mm"] == pytest.approx(np.interp(np.radians(made.motion["shaft_deg"]), t, lift), abs=1e-4)


def test_equation_7_gives_constant_breadth_for_odd_k_and_l(workshop):
    """a cos^2(k t/2) + b sin^2(l t/2) + c with k = 3, l = 5: breadth a + b + 2 c."""
    made = workshop.written(
        "equation-7", "cam: {kind: support, p: 2*cos(3*t/2)**2 + 0.4*sin(5*t/2)**2 + 20}\nexport: {tolerance: 0.001}\n"
    )
    assert made.report["follower"] == "yoke"
    assert made.contour.length == pytest.approx(PI * 42.4, abs=2 * PI * 0.001)


def test_an_even_k_does_not(workshop):
    made = workshop.written("even-k", "cam: {kind: support, p: 1*cos(2*t/2)**2 + 20}\nexport: {tolerance: 0.001}\n")
    assert made.report["follower"] == "translating flat face"
