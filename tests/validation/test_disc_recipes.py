"""Worked cases of general disc cams, from recipe to file; each was computed by two separate programs, nine digits.

Points of the exact curve within 1e-9 mm; other figures within one of their last printed digit. Of tied extremes either
angle counts. Every file, of arcs and of splines, moves its follower within the bound that is proved of that file.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from support.discs import AREAS, DEGREE, POINTS

from camgeo.cams.least_size import least_face, least_stem, stem_needs
from camgeo.curve.backwards import least_hollow
from camgeo.curve.curvature import least_radius
from camgeo.curve.curve import Curve
from camgeo.curve.extremes import greatest, least
from camgeo.curve.parallel import Parallel
from camgeo.curve.rates import cut, stretches
from camgeo.output import pipeline
from camgeo.recipe.loading import load, load_text
from camgeo.synthesis.design import designed
from kin.law.sources.lobe import coefficients

if TYPE_CHECKING:
    from pathlib import Path

    from camgeo.recipe.recipe import Recipe
    from camgeo.synthesis.design import Design

NINE = 1.01e-9
TOLERANCE = 1e-4
FILES = "export: {tolerance: 0.0001, files: [dxf, {dxf: {as: spline}}]}\n"

M01 = "[{rise: 20, over: 120, law: cycloidal}, {dwell: 60}, {return: 20, over: 120, law: polynomial-345}, {dwell: 60}]"
M02 = "[{rise: 24, over: 100, law: modified-sine}, {dwell: 40}, {return: 24, over: 140, law: modified-trapezoid}, "
M02 += "{dwell: 80}]"
M03 = "[{rise: 12, over: 100, law: cycloidal}, {dwell: 40}, {return: 12, over: 100, law: modified-trapezoid}, "
M03 += "{dwell: 120}]"
M07 = "[{rise: 20, over: 110, law: modified-sine}, {dwell: 50}, {return: 20, over: 120, law: cycloidal}, {dwell: 80}]"


def at(shape, degrees):
    """Point of a shape at a shaft angle."""
    return tuple(shape.sample(np.array([degrees * DEGREE])).point[0])


def passes(shape, table):
    for degrees, point in table.items():
        assert at(shape, degrees) == pytest.approx(point, abs=NINE), degrees


def angle(found):
    return math.degrees(math.atan(found.value)), math.degrees(found.at) % 360


def made(cam: str, more: str = "") -> tuple[Any, Design]:
    """A recipe of a disc cam with its files, and its exact design."""
    recipe = load_text(f"cam: {{kind: disc, {cam}}}\n{FILES}{more}", "cam.yaml")
    return recipe, designed(recipe)


def pitch_of(design):
    return design.only_surface.surface.base.shape


def contour_of(design):
    assert design.only_surface.contour is not None
    return design.only_surface.contour.shape


def proved(recipe: Recipe, design: Design) -> dict[str, Any]:
    """Export and judge the files, each within what is proved of it; gives the report."""
    outcome = pipeline.check(recipe)
    assert outcome.ok, [check for check in outcome.report["checks"] if not check["ok"]]
    assert [file["as"] for file in outcome.report["files"]] == ["arcs", "spline"]
    follower = design.exact.gauge
    for file in outcome.report["files"]:
        motion, within = file["motion"], file["geometry_error"]
        assert file["measured_error"] <= within <= TOLERANCE
        assert motion["extremes"] == "true"
        assert motion["max"] + motion["remainder"] <= follower.motion_limit(within) * (1.0 + 1e-6)
    return outcome.report


def leans(shape, most, fewest):
    """Greatest and least pressure angle, each with the shaft angle at which it is reached."""
    top, bottom = greatest(shape.slope, stretches(shape)), least(shape.slope, stretches(shape))
    for found, (value, where) in ((top, most), (bottom, fewest)):
        assert found.excess < 1e-11
        assert angle(found)[0] == pytest.approx(value, abs=NINE)
        assert angle(found)[1] == pytest.approx(where, abs=1.01e-5)


def bends(shape, value, where=None):
    """Least convex radius of curvature, and where."""
    radius, t = least_radius(Curve.whole(shape))
    assert radius == pytest.approx(value, abs=NINE)
    if where is not None:
        assert math.degrees(t) % 360 == pytest.approx(where, abs=2e-5)


def convex(shape):
    assert least_hollow(Curve.whole(shape))[0] == math.inf


def moments(shape):
    """Area, centroid and polar moment of area by Green's theorem, Gauss's rule on parts of each stretch."""
    node, weight = np.polynomial.legendre.leggauss(24)
    knots = np.concatenate([np.linspace(a, b, 13)[:-1] for a, b in stretches(shape)] + [[stretches(shape)[-1, 1]]])
    half, middle = np.diff(knots)[:, None] / 2, (knots[1:] + knots[:-1])[:, None] / 2
    frame = shape.sample((middle + half * node).ravel())
    x, y = frame.point.T
    swept = (x * frame.tangent[:, 1] - y * frame.tangent[:, 0]) * frame.speed * (half * weight).ravel()
    area = swept.sum() / 2
    return area, (x * swept).sum() / 3 / area, (y * swept).sum() / 3 / area, ((x * x + y * y) * swept).sum() / 4


def test_d01_roller_inline():
    recipe, design = made(f"base_radius: 40, follower: {{kind: roller, radius: 10}}, motion: {M01}")
    contour, pitch = contour_of(design), pitch_of(design)
    passes(contour, POINTS["roller"])
    leans(pitch, (17.846591833, 55.91628), (-16.811156327, 244.71652))
    bends(pitch, 47.774145953, 85.31561)
    convex(pitch)
    assert moments(contour)[:3] == pytest.approx((8033.402512156, -10.105583694, 5.851681657), abs=NINE)
    assert moments(contour)[3] == pytest.approx(11404218.772426, abs=1.01e-6)
    assert proved(recipe, design)["contour"]["area"] == pytest.approx(AREAS["roller"], abs=NINE)


D02 = {
    10.0: (
        [(35.099857550, 8.0), (20.950512624, 43.972948837), (-18.796393123, 56.566348160),
         (-6.459547404, -37.273971964)],
        (14.433626554, 46.60080),
        (-28.395362172, 216.15537),
        (40.661313990, 80.19275),
    ),
    0.0: (
        [(36.0, 0.0), (28.619761001, 39.578764062), (-10.418890660, 59.088465181), (-14.393930664, -35.048356246)],
        (23.443852354, 44.31670),
        (-19.224649073, 213.91811),
        (41.872302078, 84.14863),
    ),
    -10.0: (
        [(35.099857550, -8.0), (35.042806095, 33.514107951), (-1.683998590, 59.583725020),
         (-21.566813415, -31.107490082)],
        (32.277169661, 41.82876),
        (-9.850384833, 211.93806),
        (42.456119582, 87.55612),
    ),
}  # fmt: skip


@pytest.mark.slow
@pytest.mark.parametrize("eccentricity", D02)
def test_d02_roller_offset(eccentricity):
    points, most, fewest, radius = D02[eccentricity]
    recipe, design = made(
        f"base_radius: 36, follower: {{kind: roller, radius: 9, offset: {eccentricity}}}, motion: {M02}"
    )
    pitch = pitch_of(design)
    passes(contour_of(design), dict(zip((0, 50, 100, 250), points, strict=True)))
    leans(pitch, most, fewest)
    bends(pitch, *radius)
    convex(pitch)
    proved(recipe, design)


@pytest.mark.slow
def test_d03_flat():
    recipe, design = made(f"base_radius: 30, follower: {{kind: flat}}, motion: {M03}")
    shape = contour_of(design)
    passes(shape, POINTS["flat"])
    bends(shape, 16.078192337, 73.66772)
    most = greatest(lambda tau, side=1: rho(shape, tau, side), stretches(shape))
    assert most.value == pytest.approx(55.921807663, abs=NINE)
    assert math.degrees(most.at) == pytest.approx(26.33228, abs=1e-5)
    contact_within(shape, -13.750987083, 13.750987083)
    assert moments(shape)[:3] == pytest.approx((3735.255254814, -3.417610329, 5.881369194), abs=NINE)
    assert proved(recipe, design)["contour"]["area"] == pytest.approx(AREAS["flat"], abs=NINE)
    sized, _ = made(
        f"sizing: {{radius-of-curvature: {{at_least: 5}}}}, follower: {{kind: flat}}, motion: {M03}",
    )
    assert sized.cam.base_radius == pytest.approx(18.921807663, abs=NINE)


def rho(shape, tau, side=1):
    s = shape.law.motion.on(tau, side)
    return s.derivative().derivative() + cut(s, tau.order - 2) + shape.law.base


def contact_within(shape, low, high):
    assert least(shape.law.contact, stretches(shape)).value == pytest.approx(low, abs=NINE)
    assert greatest(shape.law.contact, stretches(shape)).value == pytest.approx(high, abs=NINE)


@pytest.mark.slow
def test_d04_flat_tilted():
    recipe, design = made(f"base_radius: 32, follower: {{kind: flat, tilt: 8, offset: 5}}, motion: {M03}")
    shape = contour_of(design)
    passes(shape, POINTS["flat, tilted"])
    bends(shape, 18.213678412, 73.66772)
    contact_within(shape, -13.347296574, 13.921113620)
    proved(recipe, design)


@pytest.mark.slow
def test_d05_knife_edge():
    motion = "[{rise: 25, over: 180, law: harmonic}, {return: 25, over: 180, law: harmonic}]"
    recipe, design = made(f"base_radius: 30, follower: {{kind: knife-edge}}, motion: {motion}")
    pitch = pitch_of(design)
    passes(contour_of(design), POINTS["knife edge"])
    leans(pitch, (17.104635177, 72.89536), (-17.104635177, 287.10463))
    bends(pitch, 40.620192023)
    convex(pitch)
    area = proved(recipe, design)["contour"]["area"]
    assert area == pytest.approx(AREAS["knife edge"], abs=NINE)
    assert area == pytest.approx(math.pi * (42.5**2 + 12.5**2 / 2), rel=1e-13)


def test_d06_shoe():
    motion = "[{rise: 10, over: 90, law: polynomial-4567}, {dwell: 30}, {return: 10, over: 90, law: polynomial-4567}, "
    recipe, design = made(f"base_radius: 25, follower: {{kind: shoe, radius: 60}}, motion: {motion}{{dwell: 150}}]")
    contour, pitch = contour_of(design), pitch_of(design)
    passes(contour, POINTS["shoe"])
    leans(pitch, (8.806525542, 44.08779), (-8.806525542, 165.91221))
    bends(pitch, 70.950026472, 63.92119)
    convex(pitch)
    most = greatest(pitch.slope, stretches(pitch)).value
    assert 60.0 * math.sin(math.atan(most)) == pytest.approx(9.185903208, abs=NINE)
    bends(contour, 10.950026472)
    proved(recipe, design)


SIDES = {1: "trailing", -1: "leading"}
D07 = {
    1: (
        (26.412053026, 61.43970),
        (-20.131074515, 233.47143),
        (39.474535506, 195.65896),
    ),
    -1: (
        (19.736540186, 38.91812),
        (-27.072856175, 215.14439),
        (40.590983394, 86.38714),
    ),
}  # fmt: skip


@pytest.mark.slow
@pytest.mark.parametrize("side", D07)
def test_d07_arm(side):
    most, fewest, radius = D07[side]
    arm = f"{{length: 65, pivot: 80, side: {SIDES[side]}}}"
    recipe, design = made(f"base_radius: 34, follower: {{kind: roller, radius: 8, arm: {arm}}}, motion: {M07}")
    pitch = pitch_of(design)
    assert math.degrees(pitch.guide.rest) == pytest.approx(31.568024019, abs=NINE)
    passes(contour_of(design), POINTS[f"{SIDES[side]} arm"])
    leans(pitch, most, fewest)
    bends(pitch, *radius)
    convex(pitch)
    proved(recipe, design)


D08 = {
    1: (
        (25.986558731, 194.90677),
        (61.897303035, 87.342340440),
        9.177290294,
        12.013441269,
    ),
    -1: (
        (22.452191379, 81.60162),
        (62.354139715, 88.329867246),
        9.111184849,
        15.547808621,
    ),
}  # fmt: skip


@pytest.mark.slow
@pytest.mark.parametrize("side", D08)
def test_d08_arm_flat(side):
    radius, reach, lean, base = D08[side]
    motion = "[{rise: 10, over: 120, law: cycloidal}, {dwell: 40}, {return: 10, over: 120, law: polynomial-345}, "
    arm = f"{{pivot: 90, face: 10, side: {SIDES[side]}}}"
    recipe, design = made(f"base_radius: 36, follower: {{kind: flat, arm: {arm}}}, motion: {motion}{{dwell: 80}}]")
    shape = contour_of(design)
    assert math.degrees(shape.law.rest) == pytest.approx(30.737868672, abs=NINE)
    passes(shape, POINTS[f"{SIDES[side]} face"])
    bends(shape, *radius)
    contact_within(shape, *reach)
    assert angle(greatest(shape.law.slope, stretches(shape)))[0] == pytest.approx(lean, abs=NINE)
    assert least_face(shape.law, 2.0) == pytest.approx(base, abs=NINE)
    proved(recipe, design)


@pytest.mark.slow
def test_d10_internal():
    recipe, design = made(
        f"base_radius: 60, track: internal, follower: {{kind: roller, radius: 10}}, motion: {M01}",
        "part: {outer: 180}\n",
    )
    passes(contour_of(design), POINTS["ring"])
    assert proved(recipe, design)["contour"]["area"] == pytest.approx(AREAS["ring"], abs=NINE)


@pytest.mark.slow
def test_d13_matched():
    motion = "[{rise: 6, over: 40, law: match}, {rise: 18, over: 60, law: constant-velocity}, "
    motion += "{rise: 6, over: 40, law: match}, {dwell: 40}, {return: 30, over: 120, law: polynomial-345}, {dwell: 60}]"
    recipe, design = made(f"base_radius: 50, follower: {{kind: roller, radius: 10}}, motion: {motion}")
    s, pitch = design.exact.law, pitch_of(design)
    rows = {
        10: (0.164062500, 2.685739665, 27.698678578),
        20: (1.125, 8.594366927, 36.931571438),
        30: (3.164062500, 14.502994189, 27.698678578),
        70: (15.0, 17.188733854, 0.0),
        120: (28.875, 8.594366927, -36.931571438),
    }
    for degrees, row in rows.items():
        assert tuple(s.derivatives(np.array([degrees * DEGREE]), 2)[:, 0]) == pytest.approx(row, abs=NINE)
    bend = greatest(lambda tau, side=1: s.on(tau, side).derivative().derivative(), stretches(s))
    assert bend.value == pytest.approx(39.486023539, abs=NINE)
    assert math.degrees(bend.at) == pytest.approx(274.64102, abs=1e-5)
    fastest = greatest(lambda tau, side=1: s.on(tau, side).derivative(), stretches(s)).value
    assert fastest == pytest.approx(17.188733854, abs=NINE)
    passes(contour_of(design), {20: (47.657108427, 18.827461984), 70: (20.218549394, 62.081535258)})
    leans(pitch, (14.637030515, 38.74881), (-20.030553560, 245.67548))
    bends(pitch, 60.0)
    convex(pitch)
    proved(recipe, design)


LOBE = "{lobe: {lift: 8, half: 68, powers: [2, 8, 14, 20, 26]}}"


@pytest.mark.slow
def test_d14_valve_flat():
    assert coefficients((2, 8, 14, 20, 26)) == pytest.approx(
        (-1.872427984, 1.872427984, -1.604938272, 0.748971193, -0.144032922), abs=NINE
    )
    recipe, design = made(f"base_radius: 18, follower: {{kind: flat, width: 25.0763171}}, motion: {LOBE}")
    s, shape = design.exact.law, contour_of(design)
    for degrees, value in {0: 8.0, 20: 6.705040433, 45: 1.952853268}.items():
        assert lift(s, degrees * DEGREE) == pytest.approx(value, abs=NINE)
    for height, crank in {0.1524: 231.385517089, 1.27: 194.148296112}.items():
        low, high = 1e-3, 68 * DEGREE
        for _ in range(60):
            middle = 0.5 * (low + high)
            low, high = (middle, high) if lift(s, middle) > height else (low, middle)
        assert math.degrees(4 * low) == pytest.approx(crank, abs=NINE)
    most = greatest(shape.law.contact, stretches(shape))
    assert (most.value, math.degrees(most.at) % 360) == pytest.approx((12.538158514, 320.23336), abs=1e-5)
    (needed,) = (check for check in design.checks if check.name == "face-width")
    assert needed.value == pytest.approx(25.076317029, abs=NINE)
    radius, where = least_radius(Curve.whole(shape))
    assert radius == pytest.approx(3.816408204, abs=NINE)
    assert either_side(where) == pytest.approx(20.58289, abs=2e-5)
    widest = greatest(lambda tau, side=1: rho(shape, tau, side), stretches(shape))
    assert widest.value == pytest.approx(66.003869437, abs=NINE)
    proved(recipe, design)


@pytest.mark.slow
def test_d14_valve_roller():
    recipe, design = made(f"base_radius: 18, follower: {{kind: roller, radius: 9}}, motion: {LOBE}")
    pitch, contour = pitch_of(design), contour_of(design)
    passes(contour, {0: (26.0, 0.0), 20: (24.072694423, 6.706515286), 45: (16.971749157, 12.181623197)})
    leans(pitch, (22.761742699, 318.51946), (-22.761742699, 41.48054))
    bends(pitch, 20.996320969)
    hollow, where = least_hollow(Curve.whole(pitch))
    assert hollow == pytest.approx(42.609351862, abs=NINE)
    assert either_side(where) == pytest.approx(55.95494, abs=2e-5)
    assert least_hollow(Curve.whole(contour))[0] == pytest.approx(51.609351862, abs=NINE)
    wheel = complex(*at(Parallel(contour, -40.0), 20))
    assert (abs(wheel), math.degrees(np.angle(wheel))) == pytest.approx((64.327771035, 25.935624732), abs=NINE)
    proved(recipe, design)


def lift(motion, theta):
    return motion.derivatives(np.array([theta]), 0)[0, 0]


def either_side(parameter):
    """Degrees from the nose of a lobe that is the same on both sides."""
    degrees = math.degrees(parameter) % 360
    return min(degrees, 360 - degrees)


D15 = "[{rise: 20, over: 60, law: cycloidal}, {dwell: 10}, {return: 20, over: 60, law: cycloidal}, {dwell: 230}]"


@pytest.mark.slow
def test_d15_undercut():
    cam = f"base_radius: 8, follower: {{kind: roller, radius: 18}}, motion: {D15}"
    _, refused = made(cam)
    assert refused.only_surface.contour is None
    recipe, design = made(f"{cam}, undercut: trim")
    pitch, kept = pitch_of(design), design.only_surface.contour
    radius, where = least_radius(Curve.whole(pitch))
    assert radius == pytest.approx(14.113168077, abs=NINE)
    around = {math.degrees(where) % 360, (130 - math.degrees(where)) % 360}
    assert min(around) == pytest.approx(47.02197, abs=2e-5)
    ends = np.array(
        [(run.high, after.low) for run, after in zip(kept.runs, (*kept.runs[1:], kept.runs[0]), strict=True)]
    )
    ends = np.degrees(ends) % 360
    ends = ends[np.argsort(ends[:, 0])]
    cuts = np.array([[32.610239345, 59.535503075], [70.464496925, 97.389760655]])
    assert ends == pytest.approx(cuts, abs=NINE)
    s = design.exact.law
    corners = {0: (14.188473171, 24.138848564), 1: (9.371256051, 26.385153798)}
    for row, place in corners.items():
        assert at(kept, cuts[row, 0]) == pytest.approx(place, abs=1e-8)  # the angle is printed with nine digits
        lost, theta = lost_lift(s, complex(*place), np.linspace(*(cuts[row] * DEGREE), 200_001))
        assert lost == pytest.approx(0.517693640, abs=1e-8)
        assert math.degrees(theta) == pytest.approx((45.8265, 84.1735)[row], abs=2e-4)
    # the raw offset with its swallowtail lifts the roller
    raw = Parallel(pitch, 18.0).sample(np.linspace(0, 130, 130_001) * DEGREE).point
    theta = 29.5513 * DEGREE
    seen = (raw[:, 0] + 1j * raw[:, 1]) * np.exp(-1j * theta)
    high = (seen.real + np.sqrt(18.0**2 - np.minimum(seen.imag**2, 18.0**2))).max()
    assert high - 26.0 - lift(s, theta) == pytest.approx(1.737170, abs=1e-5)
    # the files: the motion that is lost is reported, and no more is lost than is meant
    report = pipeline.check(recipe).report
    assert report["ok"]
    (cut_off,) = (check for check in report["checks"] if check["name"] == "undercut-local")
    assert "trimmed" in cut_off["detail"]
    for file in report["files"]:
        motion = file["motion"]
        assert file["measured_error"] <= file["geometry_error"] <= TOLERANCE
        assert motion["max"] == pytest.approx(0.517693640, abs=TOLERANCE)
        assert min(abs(motion["at_deg"] - 45.8265), abs(motion["at_deg"] - 84.1735)) < 0.1


def lost_lift(motion, corner, theta):
    """Greatest lift that a roller of 18 mm sitting on a corner lacks over shaft angles, and where."""
    seen = corner * np.exp(-1j * theta)
    lost = 26.0 + motion.derivatives(theta, 0)[0] - (seen.real + np.sqrt(18.0**2 - seen.imag**2))
    return lost.max(), theta[np.argmax(lost)]


def sized(up: int, down: int, follower: str, motion: str) -> tuple[Any, Design]:
    asked = f"sizing: {{pressure-angle: {{at_most: {up}, on_return: {down}}}}}"
    return made(f"{asked}, follower: {{kind: knife-edge{follower}}}, motion: {motion}")


@pytest.mark.slow
def test_d16_sizing_of_a_stem():
    recipe, design = sized(30, 45, "", M02)
    limits = (30 * DEGREE, 45 * DEGREE)
    assert stem_needs(design.exact.law, *limits) == pytest.approx((31.499209525, 9.603238312), abs=NINE)
    assert least_stem(design.exact.law, *limits).foot == pytest.approx(17.617720017, abs=NINE)
    cam = recipe.cam
    assert (cam.base_radius, cam.guide.offset) == pytest.approx((19.354998723, 8.014481704), abs=NINE)
    leans_of(pitch_of(design), 30.0, -45.0, NINE)
    proved(recipe, design)
    inline, _ = sized(30, 45, ", offset: 0", M02)
    assert inline.cam.base_radius == pytest.approx(31.499209525, abs=NINE)


D16 = {"trailing": (16.727263336, 72.169575733, 12.668363853), "leading": (16.273179510, 66.057520228, 14.235604064)}


@pytest.mark.slow
@pytest.mark.parametrize("side", D16)
def test_d16_sizing_of_an_arm(side):
    recipe, design = sized(35, 45, f", arm: {{length: 65, side: {side}}}", M07)
    cam = recipe.cam
    found = (cam.base_radius, cam.guide.pivot, math.degrees(cam.centre_guide.rest))
    assert found == pytest.approx(D16[side], abs=1e-6)
    leans_of(pitch_of(design), 35.0, -45.0, 1e-6)
    proved(recipe, design)


def leans_of(pitch, most, fewest, within):
    assert angle(greatest(pitch.slope, stretches(pitch)))[0] == pytest.approx(most, abs=within)
    assert angle(least(pitch.slope, stretches(pitch)))[0] == pytest.approx(fewest, abs=within)


@pytest.mark.slow
def test_d19_table(tmp_path: Path):
    """A lift read to a micrometre by degrees: the table's reading, the true lift and the file's motion are all held."""
    _, true = made(f"base_radius: 18, follower: {{kind: roller, radius: 9}}, motion: {LOBE}")
    theta = np.arange(360)
    rows = np.round(true.exact.law.derivatives(theta * DEGREE, 0)[0], 3)
    (tmp_path / "lift.csv").write_text("\n".join(f"{a},{s:.3f}" for a, s in zip(theta, rows, strict=True)))
    (tmp_path / "valve.yaml").write_text(
        "cam: {kind: disc, base_radius: 18, follower: {kind: roller, radius: 9}, motion: {table: lift.csv}}\n" + FILES
    )
    recipe: Any = load(tmp_path / "valve.yaml")
    design = designed(recipe)
    dense = np.linspace(0.0, 360.0, 36_001) * DEGREE
    off = np.abs(design.exact.law.derivatives(dense, 2) - true.exact.law.derivatives(dense, 2)).max(axis=1)
    residual = np.abs(design.exact.law.derivatives(theta * DEGREE, 0)[0] - rows).max()
    assert np.array(recipe.cam.motion.rows.rounding) == pytest.approx(0.0005)  # half the last digit
    assert residual <= 0.0005 + 1e-9
    # 32 even spans leave 0.000314, 0.0075 and 0.28; second differences of the table itself are wrong by 5.1
    assert off[0] < 0.001
    assert off[1] < 0.05
    assert off[2] < 2.5
    assert not design.exact.law.derivatives(np.linspace(68.0, 292.0, 225) * DEGREE, 2).any()  # the base circle is exact
    proved(recipe, design)
