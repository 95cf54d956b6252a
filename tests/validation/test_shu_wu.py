"""K.-L. Shu, L.-I. Wu, Synthesis of constant-breadth cam mechanisms, 2012 (SW), section 5.

Modified sine, 20 mm in 120 degrees, a dwell of 60 degrees, base radius 40 mm. The paper prints d = 100 mm; its other
figures are curves, so peaks and radii are held against closed forms written out here.
"""

import numpy as np
import pytest
from support.page_tables import Row

PI = np.pi
BETA, STROKE, BASE, BREADTH = 2 * PI / 3, 20.0, 40.0, 100.0
DIGIT = 5e-11  # half of the twelfth digit, the last one of a table, for mm above 10
CA = 4 * PI**2 / (PI + 4)


def motion(theta):
    """S, S', S'', S''' of section 5 on [0, pi], written out: modified sine, then rest; (4, n)."""
    u = theta / BETA
    head, tail = u < 1 / 8, u > 7 / 8
    k = PI / (PI + 4)
    s = np.where(
        head,
        k * (u - np.sin(4 * PI * u) / (4 * PI)),
        np.where(
            tail,
            4 / (PI + 4) + k * u - k / (4 * PI) * np.sin(4 * PI * u),
            2 / (PI + 4) + k * u - 9 / (4 * (PI + 4)) * np.sin(4 * PI * u / 3 + PI / 3),
        ),
    )
    v = k * np.where(head | tail, 1 - np.cos(4 * PI * u), 1 - 3 * np.cos(4 * PI * u / 3 + PI / 3))
    a = CA * np.where(head | tail, np.sin(4 * PI * u), np.sin(4 * PI * u / 3 + PI / 3))
    j = 4 * PI * CA * np.where(head | tail, np.cos(4 * PI * u), np.cos(4 * PI * u / 3 + PI / 3) / 3)
    rest = u > 1
    rows_ = [np.where(rest, 1.0, s), *(np.where(rest, 0.0, x) for x in (v, a, j))]
    return STROKE * np.array([x / BETA**i for i, x in enumerate(rows_)])


def rows(workshop):
    made = workshop.shipped("shu-wu")
    e = made.recipe.export.tolerance
    q = made.contour.support(np.linspace(0, 2 * PI, 7201)).q
    breadth = q[:3600] + q[3600:7200]
    rho = BASE + motion(np.linspace(0, PI, 200_001))[[0, 2]].sum(axis=0)
    steep = [np.abs(made.motion[name]).max() for name in ("velocity", "acceleration", "jerk")]
    radius = made.value("radius-of-curvature")
    return [
        Row(
            "d, mm: breadth of the file, farthest from it at any angle",
            "SW 1",
            "100",
            BREADTH,
            breadth[np.abs(breadth - BREADTH).argmax()],
            2 * e,
            ".8g",
        ),
        Row("peak S', mm/rad (CSV)", "SW Figure 2b", "curve only; 16.80297", 16.80297, steep[0], 5e-6, ".8g"),
        Row("peak S'', mm/rad² (CSV)", "SW Figure 2c", "curve only; 25.20446", 25.20446, steep[1], 5e-6, ".8g"),
        Row("peak S''', mm/rad³ (CSV)", "SW Figure 2d", "curve only; 151.2268", 151.2268, steep[2], 5e-5, ".8g"),
        Row(
            "least radius of curvature, mm",
            "SW 24, Figure 4",
            "curve only; 34.27910",
            min(rho.min(), BREADTH - rho.max()),
            radius,
            5e-6,
            ".8g",
        ),
        Row(
            "greatest radius of curvature, mm",
            "SW 30, Figure 4",
            "curve only; 65.72090",
            65.72090,
            BREADTH - radius,
            5e-6,
            ".8g",
        ),
        Row(
            "dwell, farthest from S = 20 over 120 to 180 deg of the file, mm",
            "SW section 5",
            "20",
            20.0,
            farthest_dwell(q),
            e,
            ".7g",
        ),
    ]


def farthest_dwell(q):
    """S over the upper dwell where it is farthest from 20, from q at 7201 angles."""
    lift = q[2400:3601] - BASE
    return lift[np.abs(lift - STROKE).argmax()]


@pytest.fixture(scope="module")
def section_5(workshop):
    return workshop.shipped("shu-wu")


def test_the_closed_form_is_one_motion():
    """Each row is the derivative of the one before, by difference quotients, and the ends are S = 0 and 20."""
    t, h = np.linspace(0.01, PI - 0.01, 501), 1e-6
    for x in (BETA / 8, 7 * BETA / 8, BETA):
        t = t[np.abs(t - x) > 1e-4]
    for k in range(3):
        assert (motion(t + h)[k] - motion(t - h)[k]) / (2 * h) == pytest.approx(motion(t)[k + 1], abs=1e-6)
    assert motion(np.array([0.0, BETA]))[0] == pytest.approx([0, STROKE], abs=1e-12)


def test_motion_table(section_5):
    table = section_5.motion
    theta = np.radians(table["shaft_deg"][:1801])
    wanted = motion(theta)
    assert table["lift_mm"][:1801] == pytest.approx(wanted[0], abs=1e-11 + DIGIT)
    assert table["velocity"][:1801] == pytest.approx(wanted[1], abs=1e-10)
    assert table["acceleration"][:1801] == pytest.approx(wanted[2], abs=1e-9)


def test_equations_3_to_6_second_half_turn(section_5):
    table = section_5.motion
    assert table["lift_mm"][1800:] == pytest.approx(STROKE - table["lift_mm"][:1801], abs=1e-12 + 2 * DIGIT)
    assert table["acceleration"][1800:3600] == pytest.approx(-table["acceleration"][:1800], abs=1e-10)


def test_equation_32_radii_of_opposite_points_make_the_breadth(section_5):
    curve = section_5.design.only_surface.surface.curve
    t = np.linspace(0.001, PI - 0.001, 1001)
    rho = curve.sample(t).speed
    assert rho + curve.sample(t + PI).speed == pytest.approx(np.full(1001, BREADTH), abs=1e-10)
    assert rho == pytest.approx(BASE + motion(t)[0] + motion(t)[2], abs=1e-9)


def test_conjugate_breadth_of_the_file(section_5):
    t = np.linspace(0, PI, 3601)
    breadth = section_5.contour.support(t).q + section_5.contour.support(t + PI).q
    assert np.abs(breadth - BREADTH).max() <= 2 * section_5.recipe.export.tolerance


def test_lift_of_the_file_by_contact(section_5):
    t = np.linspace(0, PI, 3601)
    e = section_5.recipe.export.tolerance
    assert np.abs(section_5.contour.support(t).q - BASE - motion(t)[0]).max() <= e
    # the dwells are arcs about the shaft
    assert section_5.contour.support(t[2400:]).q == pytest.approx(np.full(1201, BASE + STROKE), abs=1e-9)


def test_polar_breadth_is_not_the_conjugate(section_5):
    """Taking the breadth through the shaft instead of the breadth between faces is wrong by millimetres."""
    x, y = section_5.contour.sample(400).T
    order = np.argsort(np.arctan2(y, x))
    t = np.linspace(-PI, 0, 721)
    r = [np.interp(a, np.arctan2(y, x)[order], np.hypot(x, y)[order], period=2 * PI) for a in (t, t + PI)]
    assert np.abs(r[0] + r[1] - BREADTH).max() > 1.0


def test_a_rise_that_does_not_rest_is_refused_with_the_jump():
    """S'(pi) = -S'(0) is what keeps the contour together: equation 4."""
    from camgeo.output.pipeline import check
    from camgeo.recipe.loading import read
    from camgeo.schema.errors import RecipeErrors

    text = (
        "cam: {kind: constant-breadth, base_radius: 40, motion: [{rise: 20, over: 180, law: {polynomial: [0, 1]}}]}\n"
    )
    with pytest.raises(RecipeErrors, match="motion"):
        check(read(text.encode(), "torn.yaml"))
