"""Worked linear cams, each figure held against one from brute force that knows positions alone (mpmath, 30 digits).

A guide at the height d carries a roller; the flank is the lowest underside of all rollers, a roller is set down on it.

Holds: camgeo.capabilities.linear.path.
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from capabilities.linear.plates import CAM, ENDLESS, GROOVE, MOTION, ON_ARM, changed, design_of

from camgeo.capabilities.linear.figures import crank_travel, figures_of, motion_under, play_at
from camgeo.capabilities.linear.flank import Flank, convex_radius, slopes
from camgeo.fit.polygon import fit_polygon

DIGITS = 1e-10
BUMP = "{formula: 12*sin(pi*x/120), over: 120}"


def drawn_flank(text: str, *u: float, upper: bool = False) -> np.ndarray:
    """Points of a flank as drawn, for a plate that travels to the left."""
    design = design_of(text)
    flank = design.upper if upper else design.lower
    assert flank is not None
    return design.drawn(flank.shape.sample(np.array(u)).point)


def close(found: object, wanted: object) -> None:
    np.testing.assert_allclose(found, wanted, rtol=DIGITS, atol=DIGITS)


def angles(text: str) -> tuple[float, float]:
    least, greatest = slopes(design_of(text).path)
    return math.degrees(math.atan(greatest.value)), math.degrees(math.atan(least.value))


def test_a_roller_on_an_upright_guide() -> None:
    points = [
        (28.7109284815, 35.8854503349),
        (39.9975603804, 43.7530495245),
        (89.912704276, 48.3217567840),
        (106.268333458, 34.9939670576),
    ]
    close(drawn_flank(CAM, 25.0, 35.0, 95.0, 110.0), points)
    close(angles(CAM), (38.6598082541, -43.1523897340))
    # of the rise alone, whose crest is the blunter one of the two
    rise = changed(CAM, (", {dwell: 20}, {return: 20, over: 40, law: polynomial-345}", ", {dwell: 60}"))
    radius, at = convex_radius(design_of(rise).path, 1)
    close(radius, 23.3527005711)
    assert at == pytest.approx(49.835085, abs=1e-6)


@pytest.mark.parametrize(
    ("lean", "points", "steepest"),
    [
        (-15, [(41.9015121853, 42.9216581251), (96.4515204165, 44.5268825082)], (47.6268296005, -35.0927299366)),
        (15, [(37.9952010935, 43.9298831783), (92.7002609681, 43.1938650057)], (29.2606780669, -51.0820766970)),
    ],
)
def test_a_guide_that_leans(lean: int, points: list[tuple[float, float]], steepest: tuple[float, float]) -> None:
    """Above 0 the lean eases the rise."""
    text = changed(CAM, ("radius: 8", f"radius: 8, lean: {lean}"))
    close(drawn_flank(text, 35.0, 100.0), points)
    close(angles(text), steepest)


@pytest.mark.parametrize(
    ("side", "points", "steepest"),
    [
        ("trailing", [(-13.9395985076, 35.8179670663), (40.492552215, 35.4788752446)], (35.8636093995, -48.2433969713)),
        ("leading", [(104.187178893, 35.2280366667), (158.560596551, 36.1986263922)], (45.4167468473, -39.6087028485)),
    ],
)
def test_an_arm(side: str, points: list[tuple[float, float]], steepest: tuple[float, float]) -> None:
    text = changed(ON_ARM, ("trailing", side))
    assert math.degrees(design_of(text).recipe.rest) == pytest.approx(-20.0, abs=1e-12)
    close(drawn_flank(text, 40.0, 105.0), points)
    close(angles(text), steepest)


def test_a_groove() -> None:
    design = design_of(GROOVE)
    upper = design.upper
    assert upper is not None
    # the inputs at which the upper flank stands at these places, by halving
    for place, height in ((29.9712048672, 56.2859939160), (105.505726087, 55.8727744933)):
        low, high = 0.0, 120.0
        for _ in range(80):
            middle = 0.5 * (low + high)
            at = design.drawn(upper.shape.sample(np.array([middle])).point)[0]
            low, high = (middle, high) if at[0] < place else (low, middle)
        assert at[1] == pytest.approx(height, abs=1e-9)  # as the place is given to so many digits
    close(play_at(design, np.array([35.0])), [0.0640312102939])


def test_undercut_that_is_trimmed() -> None:
    only = MOTION.replace("{dwell: 20}, {return: 20, over: 40, law: polynomial-345}", "{dwell: 60}")
    text = changed(CAM, (MOTION, only), ("radius: 8", "radius: 30"), ("base: 32", "base: 30"))
    design = design_of(changed(text, ("  ends:", "  undercut: trim\n  ends:")))
    flank = Flank(design.path, 30.0, endless=False)
    speed = flank.shape.sample(np.linspace(45.0, 55.0, 20001)).speed.min()
    assert speed == pytest.approx(-0.296151185309, abs=1e-7)
    (lost,) = flank.lost
    close((lost.begin, lost.end), (41.3071793956, 57.6866928251))
    close(design.drawn(np.array([lost.corner])), [(58.1900959587, 49.9912463119)])
    assert lost.depth == pytest.approx(0.178261447960, abs=1e-12)
    assert lost.at == pytest.approx(49.301755, abs=1e-6)


@pytest.mark.parametrize(("motion", "sense"), [(BUMP, 1), (BUMP.replace("12*s", "12 - 12*s"), -1)])
def test_a_path_that_is_bent_one_way_alone(motion: str, sense: int) -> None:
    path = design_of(changed(CAM, (MOTION, motion))).path
    radius, at = convex_radius(path, sense)
    close((radius, at), (120.0**2 / (12.0 * math.pi**2), 60.0))
    assert convex_radius(path, -sense)[0] == math.inf


def test_a_path_that_an_arm_of_no_length_hardly_bends() -> None:
    small = MOTION.replace(": 20, over: 50", ": 14, over: 45").replace(": 20, over: 40", ": 14, over: 50")
    text = changed(CAM, (MOTION, small), ("radius: 8", "radius: 8, arm: {length: 0.001, pivot: 40}"))
    path = design_of(text).path
    for sense in (1, -1):
        radius, at = convex_radius(path, sense)
        sampled = path.sample(np.linspace(at - 0.5, at + 0.5, 2001))
        assert radius == pytest.approx(float((sense * sampled.speed / sampled.turn).min()), rel=1e-6)


@pytest.mark.parametrize("radius", [30, 200])
def test_a_polygon_runs_straight_from_a_hollow_to_the_corner_of_an_undercut(radius: int) -> None:
    rests = MOTION.replace("over: 40, law: polynomial-345}]", "over: 50, law: cycloidal}, {dwell: 20}]")
    text = changed(CAM, (MOTION, rests), ("radius: 8", f"radius: {radius}"), ("  ends:", "  undercut: trim\n  ends:"))
    polygon = fit_polygon(design_of(text).outline, 0.001)
    assert 0.5e-3 < polygon.bound.worst <= 1e-3


def test_a_knife_edge_and_a_shoe() -> None:
    knife = changed(CAM, ("{kind: roller, radius: 8}", "{kind: knife-edge}"))
    design = design_of(knife)
    u = np.linspace(0.0, 119.0, 50)
    close(design.drawn(design.lower.shape.sample(u).point)[:, 0], u)
    shoe = changed(
        CAM, ("{kind: roller, radius: 8}", "{kind: shoe, radius: 60}"), ("  ends:", "  undercut: trim\n  ends:")
    )
    figures = {figure.name: figure.value for figure in figures_of(design_of(shoe))}
    close((figures["shoe-from"], figures["shoe-to"]), (-41.0364677329, 37.4817028533))


def test_an_endless_wave() -> None:
    design = design_of(ENDLESS)
    assert design.lower.least_radius[0] == pytest.approx((40.0 / (2.0 * math.pi)) ** 2 / 5.0, rel=1e-12)
    close(drawn_heights(13.706006949, 19.0151132944), (20.2813653994, 23.8035444620))


def drawn_heights(*places: float) -> list[float]:
    """Heights of the flank of a wave at places x."""
    design, found = design_of(ENDLESS), []
    for place in places:
        low, high = -10.0, 50.0
        for _ in range(80):
            middle = 0.5 * (low + high)
            at = design.drawn(design.lower.shape.sample(np.array([middle])).point)[0]
            low, high = (middle, high) if at[0] < place else (low, middle)
        found.append(float(at[1]))
    return found


def test_to_and_fro_under_a_crank() -> None:
    design = design_of(changed(CAM, ("  ends:", "  drive: {crank: {radius: 60, rod: 180, rpm: 90}}\n  ends:")))
    crank = design.recipe.drive.crank
    assert crank is not None
    q = np.radians([70.0, 100.0, 290.0])
    close(motion_under(design, crank, q)[1], (21.9778312458, -0.0790366168617, -21.9778312458))
    close(crank_travel(crank, np.radians([100.0, 260.0]))[0], (80.3937358076, 80.3937358076))


def test_ends_of_a_slope() -> None:
    text = changed(
        CAM,
        (MOTION, "[{rise: 12, over: 100, law: constant-velocity}]"),
        ("radius: 8", "radius: 10"),
        ("base: 32", "base: 20"),
    )
    points = drawn_flank(text, 0.0, 100.0)
    close(points, [(1.19145220618, 20.0712316151), (101.19145220618, 32.0712316151)])
