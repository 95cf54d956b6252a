"""Worked cylindrical cams, each figure held against brute force that knows positions alone (mpmath, 30 digits).

The flank is the lowest underside, or the highest top, of all rollers at a radius and an angle. What stands in no table
is computed here, by searching that envelope.

Holds: camgeo.capabilities.cylindrical.flank, camgeo.capabilities.cylindrical.guide,
camgeo.capabilities.cylindrical.figures,
camgeo.capabilities.cylindrical.undercut.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import mpmath
import numpy as np
import pytest
from capabilities.cylindrical.kin.meshing import contact_angles, relative_curvature
from capabilities.cylindrical.made_drums import (
    ARM,
    BESIDE,
    CONE,
    CONE_ON_ARM,
    GROOVE,
    LEADING,
    RIB,
    RIB_ON_ARM,
    TOP,
    UNDERCUT,
    changed,
    design_of,
    shared_design,
)
from capabilities.cylindrical.positions import Lift, envelope, law_at
from support.heavy import optimize

from camgeo.capabilities.cylindrical.bends import bends
from camgeo.capabilities.cylindrical.checks_of import offset_off, wrapped_off
from camgeo.capabilities.cylindrical.figures import figures_of, rib_thickness
from camgeo.capabilities.cylindrical.undercut import below
from camgeo.capabilities.cylindrical.verdicts import intended
from kin.cylindrical.frame import flank_points
from kin.cylindrical.gauge import gauges_of

if TYPE_CHECKING:
    from camgeo.capabilities.cylindrical.flank import Flank

DIGITS = 1e-10
LEVEL = 20.0  # z of the cases is over the pitch line


def close(found: object, wanted: object) -> None:
    np.testing.assert_allclose(found, wanted, rtol=DIGITS, atol=DIGITS)


def figure(text: str, name: str) -> float:
    return next(each.value for each in figures_of(shared_design(text)) if each.name == name)


CASES = [  # theta, rho, flank, r, phi, contact angle, z
    (30, 48, "lower", 48.1421608349, 34.4042478546, 21.696983972, -5.65771805946),
    (30, 48, "upper", 48.1421608349, 25.5957521454, 21.696983972, 12.9253226121),
    (30, 38, "lower", 38.2644239046, 36.7397038281, 26.68385345, -5.30117748016),
    (30, 38, "upper", 38.2644239046, 23.2602961719, 26.68385345, 12.5687820328),
    (60, 48, "lower", 48.4021968889, 67.3913817939, 38.511887254, 12.1752101417),
    (60, 48, "upper", 48.4021968889, 52.6086182061, 38.511887254, 27.8247898583),
    (60, 38, "lower", 38.6556436054, 70.567709167, 45.148272141, 12.9472546161),
    (60, 38, "upper", 38.6556436054, 49.432290833, 45.148272141, 27.0527453839),
    (250, 48, "lower", 48.3447143746, 243.153774157, -35.190259992, 5.69234746199),
    (250, 48, "upper", 48.3447143746, 256.846225843, -35.190259992, 22.0372050072),
    (250, 38, "lower", 38.5777196097, 240.071780202, -41.692679285, 6.39754450401),
    (250, 38, "upper", 38.5777196097, 259.928219798, -41.692679285, 21.3320079651),
]


def test_the_flanks_of_a_groove() -> None:
    design = shared_design(GROOVE)
    for theta, rho, name, r, phi, angle, z in CASES:
        at = np.array([math.radians(theta)])
        contact = design.flanks[name].along(at, np.array([float(rho)]))
        close(contact.r[0], r)
        close(math.degrees(contact.phi[0]), phi)
        close(math.degrees(contact.angle[0]), angle)
        close(contact.z[0] - LEVEL, z)
        again = design.flanks[name].on(at, contact.r)
        close([again.rho[0], again.phi[0], again.z[0]], [rho, contact.phi[0], contact.z[0]])


def test_pressure_angles_along_the_roller() -> None:
    values = {each.name: each.value for each in figures_of(shared_design(GROOVE))}
    close([values["pressure-angle"], values["pressure-angle-middle"]], [45.1482721410, 40.9618320715])
    # the blank ends the contact before the roller does: at 49.63 in place of 50, where the formula says 37.38
    assert values["pressure-angle-outer"] == pytest.approx(37.59, abs=5e-3)
    at_50 = changed(
        GROOVE, ("radius: 50", "radius: 60"), ("depth: 12.5", "depth: 22.5"), ("from: 38", "from: 38, to: 50")
    )
    close(figure(at_50, "pressure-angle-outer"), 37.3777916118)


def test_a_flank_on_the_cylinder_of_the_blank() -> None:
    flank = shared_design(GROOVE).flanks["lower"]
    contact = flank.on(np.radians([30.0, 60.0]), 50.0)
    close(50.0 * contact.phi, [29.7592556974, 58.4745116351])
    close(contact.z - LEVEL, [-5.70484645319, 12.0755272731])


STEEP_ARM = (39.9018286077, 47.2109142786)  # at 50 and at 38
OTHERS = [  # cones, a roller beside a radius, and arms: text, height of z in the cases, rows as above
    (
        CONE,
        20.0,
        [
            (60, 50, "lower", 50.4440719486, 67.6081374135, 35.995477351, 10.8060978551),
            (60, 38, "lower", 38.4656904626, 68.9245980578, 43.705916308, 13.7568089811),
            (60, 38, "upper", 38.4656904626, 51.0754019422, 43.705916308, 26.2431910189),
            (250, 44, "upper", 44.3943322964, 257.642351927, -36.185112414, 21.9359136980),
        ],
    ),
    (
        changed(GROOVE, ("radius: 10,", "radius: 10, taper: 6, at: 44,")),
        20.0,
        [
            (60, 50, "lower", 50.4032960939, 67.2528746987, 36.768755708, 11.4842534376),
            (250, 38, "upper", 38.4932718647, 259.182337569, -40.965761452, 20.9396049483),
        ],
    ),
    (
        BESIDE,
        20.0,
        [
            (60, 48, "lower", 49.5327558566, 74.290722821, 38.511887254, 12.1752101417),
            (250, 38, "upper", 40.0506759541, 268.414160845, -41.692679285, 21.3320079651),
        ],
    ),
    (
        ARM,
        40.0,
        [
            (35, 50, "lower", 50.1784274964, 39.8332445771, 28.649871939, -23.8511308936),
            (60, 38, "lower", 38.3609494216, 67.8660599927, 46.468800714, -6.88749461915),
            (60, 38, "upper", 39.1096202387, 46.3190827031, 46.468800714, 6.88749461915),
            (255, 44, "upper", 44.1997818658, 260.449658881, -34.362035616, -1.13948277386),
        ],
    ),
    (
        LEADING,
        40.0,
        [
            (35, 50, "lower", 50.2188147693, 40.3505759912, 24.306357209, -24.1890472578),
            (60, 38, "lower", 39.1096202387, 73.6809172969, 46.468800714, -6.88749461915),
            (60, 38, "upper", 38.3609494216, 52.1339400073, 46.468800714, 6.88749461915),
            (255, 44, "upper", 44.6802714922, 265.010907111, -39.201723515, -1.64510467340),
        ],
    ),
    (
        CONE_ON_ARM,
        40.0,
        [
            (5, 44, "lower", 44.0082210084, 6.10749055464, 0.74374194003, -30.6854885496),
            (60, 38, "upper", 38.9798773105, 47.1258891319, 45.520786609, 6.56465656516),
            (100, 50, "upper", 50.0219087247, 98.304171607, 10.309255444, 29.9955552269),
        ],
    ),
]


@pytest.mark.slow
@pytest.mark.parametrize(
    ("text", "level", "rows"), OTHERS, ids=["apex", "cone", "beside", "arm", "leading", "cone-arm"]
)
def test_the_flanks_of_other_followers(text: str, level: float, rows: list[tuple]) -> None:
    design = shared_design(text)
    for theta, rho, name, r, phi, angle, z in rows:
        at = np.array([math.radians(theta)])
        contact = design.flanks[name].along(at, np.array([float(rho)]))
        close(contact.r[0], r)
        close(math.degrees(contact.phi[0]), phi)
        assert math.degrees(contact.angle[0]) == pytest.approx(angle, abs=6e-10)
        assert contact.z[0] - level == pytest.approx(z, abs=5e-11)
        again = design.flanks[name].on(at, contact.r)
        close([again.rho[0], again.phi[0], again.z[0]], [rho, contact.phi[0], contact.z[0]])


@pytest.mark.parametrize("text", [ARM, LEADING])
def test_pressure_angles_on_an_arm(text: str) -> None:
    theta = np.linspace(0.0, 2.0 * math.pi, 200001)
    flank = shared_design(text).flanks["lower"]
    for rho, wanted in zip((50.0, 38.0), STEEP_ARM, strict=True):
        assert math.degrees(np.abs(flank.pressure(theta, np.full_like(theta, rho))).max()) == pytest.approx(
            wanted, abs=1e-7
        )


def test_the_contact_angle_of_a_cone() -> None:
    """At 60 degrees, where the slope is the greatest: tan a = S'/(rho + R tan d)."""
    close(
        math.degrees(shared_design(CONE).flanks["lower"].along(np.array([math.pi / 3]), np.array([44.0])).angle[0]),
        39.5389734592,
    )


@pytest.mark.parametrize(
    "text", [CONE, BESIDE, ARM, CONE_ON_ARM, RIB_ON_ARM], ids=["cone", "beside", "arm", "cone-arm", "rib"]
)
def test_bends_and_regularity_are_those_of_the_places(text: str) -> None:
    """Bounds over cells of no width, D and curvature, against difference quotients of places."""
    for flank in shared_design(text).flanks.values():
        theta, r, h, w = np.radians([20.0, 47.0, 101.0, 193.0, 222.0, 290.0]), np.linspace(38.5, 49.5, 6), 1e-3, 1e-9

        def place(t: np.ndarray, radius: np.ndarray, flank: Flank = flank) -> np.ndarray:
            contact = flank.on(t, radius)
            return np.stack([radius * np.cos(contact.phi), radius * np.sin(contact.phi), contact.z], axis=-1)

        def touched(t: np.ndarray, rho: np.ndarray, flank: Flank = flank) -> np.ndarray:
            contact = flank.along(t, rho)
            return np.stack([contact.r * np.cos(contact.phi), contact.r * np.sin(contact.phi), contact.z], axis=-1)

        contact = flank.on(theta, r)
        normal = flank.normal(contact, theta)
        found = bends(flank, (theta - w, theta + w), (r - w, r + w))
        middle = place(theta, r)
        second = (
            (place(theta + h, r) - 2 * middle + place(theta - h, r)) / h**2,
            (place(theta + h, r + h) - place(theta + h, r - h) - place(theta - h, r + h) + place(theta - h, r - h))
            / (4 * h * h),
            (place(theta, r + h) - 2 * middle + place(theta, r - h)) / h**2,
        )
        for k, each in enumerate(second):
            np.testing.assert_allclose(np.abs(np.sum(each * normal, axis=1)), found.across[k], atol=3e-4)
            np.testing.assert_allclose(np.linalg.norm(each, axis=1), found.whole[k], atol=3e-4)
        sides = [flank.normal(flank.on(theta + d, r), theta + d) for d in (h, -h)]
        np.testing.assert_allclose(np.linalg.norm(sides[0] - sides[1], axis=1) / (2 * h), found.turns[0], atol=2e-5)
        swept = (flank.on(theta + h, r).phi - flank.on(theta - h, r).phi) / (2 * h)
        np.testing.assert_allclose(swept, found.sweep, atol=2e-5)
        np.testing.assert_allclose(swept, flank.sweep(contact, theta), atol=2e-5)
        along = (touched(theta + h, contact.rho) - touched(theta - h, contact.rho)) / (2 * h)
        across = (touched(theta, contact.rho + h) - touched(theta, contact.rho - h)) / (2 * h)
        cross = np.cross(along, across)
        np.testing.assert_allclose(np.linalg.norm(cross, axis=1), contact.regular, rtol=1e-5)
        np.testing.assert_allclose(np.abs(np.sum(cross * normal, axis=1)), contact.regular, rtol=1e-5)


@pytest.mark.parametrize("text", [CONE, BESIDE, CONE_ON_ARM], ids=["cone", "beside", "cone-arm"])
def test_curvature_across_the_line_of_other_followers(text: str) -> None:
    """The gap between roller and flank on either side of the line of contact, square to it in their common plane."""
    for name, flank in shared_design(text).flanks.items():
        theta, rho, d = np.radians([75.0]), np.array([41.0]), 0.02
        contact = flank.along(theta, rho)
        normal = flank.normal(contact, theta)[0]
        point = np.array(
            [contact.r[0] * math.cos(contact.phi[0]), contact.r[0] * math.sin(contact.phi[0]), contact.z[0]]
        )
        beside = flank.along(theta, rho + 1e-4)
        line = (
            np.array([beside.r[0] * math.cos(beside.phi[0]), beside.r[0] * math.sin(beside.phi[0]), beside.z[0]])
            - point
        )
        across = np.cross(normal, line / np.linalg.norm(line))
        gaps = []
        for sign in (-1.0, 1.0):
            foot = point + sign * d * across
            gaps.append(_to_roller(flank, theta, foot, normal) - _to_flank(flank, foot, normal, theta))
        curvature = flank.curvature(theta, rho)[0]
        assert sum(gaps) / d**2 == pytest.approx(curvature, rel=2e-3), name


def _to_roller(flank: Flank, theta: np.ndarray, foot: np.ndarray, normal: np.ndarray) -> float:
    """Way along a normal from a place to the roller at a shaft angle, by a search on the roller's own equation."""
    pose = flank.pose(theta)
    e_r, e_t = (
        np.array([math.cos(theta[0]), math.sin(theta[0]), 0.0]),
        np.array([-math.sin(theta[0]), math.cos(theta[0]), 0.0]),
    )

    def outside(step: float) -> float:
        at = foot + step * normal
        size = flank.radius + (at @ e_r - flank.at) * math.tan(flank.taper)
        return math.hypot(at @ e_t - pose.y[0], at[2] - pose.z[0]) - size

    return float(optimize.brentq(outside, -0.01, 0.01, xtol=1e-15))


def _to_flank(flank: Flank, foot: np.ndarray, normal: np.ndarray, theta: np.ndarray) -> float:
    """Way along a normal from a place to the flank, which is explicit on cylinders."""

    def above(step: float) -> float:
        at = foot + step * normal
        r, phi = math.hypot(at[0], at[1]), math.atan2(at[1], at[0])
        own = optimize.brentq(
            lambda t: flank.on(np.array([t]), r).phi[0] - phi, theta[0] - 0.1, theta[0] + 0.1, xtol=1e-15
        )
        return float(at[2] - flank.on(np.array([own]), r).z[0])

    return float(optimize.brentq(above, -0.01, 0.01, xtol=1e-14))


def helix(radius: float, roller: float, angle: float, floor: float) -> str:
    """Recipe of a groove whose steepest place has a slope of tan(angle) times the radius, by cycloidal strokes."""
    stroke = radius * math.tan(math.radians(angle)) * math.radians(120) / 2.0
    return changed(
        GROOVE,
        ("radius: 50", f"radius: {radius}"),
        ("depth: 12.5", f"depth: {radius - floor!r}"),
        ("radius: 10, from: 38", f"radius: {roller}"),
        ("rise: 40", f"rise: {stroke!r}"),
        ("return: 40, over: 120, law: polynomial-345", f"return: {stroke!r}, over: 120, law: cycloidal"),
        ("length: 80, bore: 24, keyway: din6885", "length: 400"),
        ("pitch_height: 20", "pitch_height: 40"),
    )


@pytest.mark.parametrize(
    ("radius", "roller", "angle", "wanted"),
    [
        (50, 10, 30, 0.00420947453635),
        (50, 10, 45, 0.0169479920379),
        (50, 10, 60, 0.0382354400011),
        (30, 10, 45, 0.0485605986229),
    ],
)
def test_what_an_offset_path_costs(radius: float, roller: float, angle: float, wanted: float) -> None:
    found, _ = offset_off(shared_design(helix(radius, roller, angle, radius - 1.0)), float(radius))
    close(found, wanted)


def test_what_radial_walls_cost() -> None:
    """Of a helix of 30 degrees from 50 to 38 mm it is 1.02628; a cam's motion is steep at one place alone."""
    design = shared_design(GROOVE)
    value, other, at = wrapped_off(design, 50.0)
    assert other == 38.0
    flank = design.flanks["lower"] if design.law.derivatives(np.array([at]), 1)[1][0] else design.flanks["upper"]
    # by positions alone: both envelopes at one angle
    contact = flank.on(np.array([at]), 38.0)
    wall, needed = (height(flank.side, r, contact.phi[0]) for r in (50, 38))
    assert abs(float(wall - needed)) == pytest.approx(value, rel=1e-9)


def lift(theta: mpmath.mpf) -> mpmath.mpf:
    degrees = mpmath.degrees(theta) % 360
    if degrees < 120:
        return 40 * law_at("cycloidal", degrees / 120, mpmath)
    if degrees < 180:
        return mpmath.mpf(40)
    if degrees < 300:
        return 40 - 40 * law_at("polynomial-345", (degrees - 180) / 120, mpmath)
    return mpmath.mpf(0)


def height(side: int, r: float, phi: float, roller: float = 10) -> mpmath.mpf:
    """Height of the envelope over the level at lift 0, by a search on positions."""
    with mpmath.workdps(30):
        half = mpmath.asin(mpmath.mpf(roller) / r)

        def reach(theta: mpmath.mpf) -> mpmath.mpf:
            inside = mpmath.mpf(roller) ** 2 - (r * mpmath.sin(phi - theta)) ** 2
            return side * lift(theta) + mpmath.sqrt(max(inside, mpmath.mpf(0)))

        places = [phi + half * k / 60 for k in range(-60, 61)]
        best = max(places, key=reach)
        low, high = best - half / 60, best + half / 60
        for _ in range(110):
            a, b = high - (high - low) * mpmath.mpf("0.618"), low + (high - low) * mpmath.mpf("0.618")
            low, high = (low, b) if reach(a) > reach(b) else (a, high)
        return side * reach((low + high) / 2)


def test_places_in_no_table() -> None:
    """The closed form on any cylinder is the envelope of positions: at other angles, and for a clearance."""
    design = shared_design(changed(GROOVE, ("depth: 12.5", "depth: 12.5, clearance: 0.3")))
    for theta, r, name, roller in ((17.0, 41.3, "lower", 10), (101.0, 49.2, "upper", 10.3), (288.5, 37.6, "lower", 10)):
        flank = design.flanks[name]
        contact = flank.on(np.array([math.radians(theta)]), r)
        with mpmath.workdps(30):
            wanted = height(flank.side, r, mpmath.mpf(float(contact.phi[0])), roller)
        close(contact.z[0] - LEVEL, float(wanted))


@pytest.mark.slow
def test_undercut_at_the_inner_end_alone() -> None:
    """The rule of the development, a radius of curvature above the roller's, would say 28.8626."""
    design = shared_design(UNDERCUT)
    lower, figures = design.flanks["lower"], {each.name: each.value for each in figures_of(design)}
    close(below(lower, 20.0, 40.0)[0], 29.100516094)
    close(figures["undercut-radius"], 29.100516094)
    for rho, at, wanted in (
        (40, 47.70907, 17.8819315878),
        (30, 48.30676, 1.63176748872),
        (25, 48.77245, -7.96125505181),
        (20, 49.41918, -19.2693524244),
    ):
        theta = np.radians(np.linspace(at - 0.01, at + 0.01, 401))
        assert lower.along(theta, np.full_like(theta, rho)).regular.min() == pytest.approx(wanted, abs=1e-9)
    # what carries at 50 degrees begins where the cut ends, and loses nothing
    assert figures["contact-length"] == pytest.approx(40.0 - 29.2, abs=0.1)
    assert 0.5 < figures["carrying-share"] < 0.6


@pytest.mark.slow
def test_both_ends_of_a_cut_are_one_place() -> None:
    design = design_of(UNDERCUT)
    for name, found in design.cuts.items():
        for cut in found:
            flank = design.flanks[name]
            first, last = flank.on(cut.first, cut.r), flank.on(cut.last, cut.r)
            np.testing.assert_allclose(first.phi, last.phi, atol=1e-12)
            np.testing.assert_allclose(first.z, last.z, atol=1e-11)
            assert (cut.last > cut.first).all()


def test_a_rib() -> None:
    design = shared_design(RIB)
    flank = design.flanks["lower"]
    for r, wanted in ((38.0, 21.9182951883), (50.0, 24.9094704840)):
        theta = np.radians(np.linspace(40.0, 60.0, 2001))
        at = np.interp(math.radians(60), flank.on(theta, r).phi, theta)
        assert rib_thickness(design, np.array([at]), r)[0] == pytest.approx(wanted, abs=1e-8)
    assert figure(RIB, "rib-thickness") == pytest.approx(21.918, abs=1e-3)


def test_forces_of_an_end_cam() -> None:
    text = changed(TOP, ("pitch_height: 20", "pitch_height: 20\n  drive: {load: 200}"), ("from: 38", "from: 44"))
    close(figure(text, "contact-force"), 264.849288363)
    close(figure(text, "torque"), 7.63943726841)
    slope = 40 * 2 / math.radians(120)
    close(figure(text, "side-thrust"), 200 * slope / 44)


def test_forces_of_a_cone() -> None:
    """Its share along the axis is sin d, and the load is what both leave along the way."""
    text = changed(CONE, ("pitch_height: 20", "pitch_height: 20\n  drive: {load: 200}"), ("from: 38", "from: 44"))
    values = {each.name: each.value for each in figures_of(design_of(text))}
    force, angle = values["contact-force"], math.radians(39.5389734592)
    close(values["axial-thrust"] / force, 0.221621103589)
    close(values["pressure-angle"], 39.5389734592)
    close(force * math.cos(math.atan(10 / 44)) * math.cos(angle), 200.0)
    close(values["side-thrust"], 200.0 * math.tan(angle))


def test_figures_of_an_arm() -> None:
    """The contact ends at 50 mm, where the case has its angle; the load turns the drum by virtual work."""
    text = changed(
        ARM,
        ("radius: 50", "radius: 60"),
        ("depth: 12.5", "depth: 22.5, clearance: 0.05"),
        ("from: 38", "from: 38, to: 50"),
        ("  motion", "  drive: {rpm: 60, load: 200}\n  motion"),
    )
    values = {each.name: (each.value, each.unit) for each in figures_of(design_of(text))}
    outer, inner = STEEP_ARM
    rate = math.radians(30) * 2 / math.radians(120)
    for name, wanted, unit in (
        ("pressure-angle", inner, "deg"),
        ("pressure-angle-outer", outer, "deg"),
        ("off-radius", 2.0, "mm"),
        ("play", math.degrees(0.05 / 80 / math.cos(math.radians(outer))), "deg"),
        ("velocity", math.degrees(rate) * 2 * math.pi, "deg/s"),
        ("contact-force", 200 / math.cos(math.radians(inner)), "N"),
        ("side-thrust", 200 * math.tan(math.radians(inner)), "N"),
        ("torque", 200 * 80 * rate * 1e-3, "N m"),
    ):
        close(values[name][0], wanted)
        assert values[name][1] == unit
    assert {"off-radius", "axial-thrust"}.isdisjoint(each.name for each in figures_of(shared_design(GROOVE)))


def test_a_rib_on_an_arm() -> None:
    """Its thinnest place, by both envelopes of rollers on one body."""
    rows = [("rise", 30, 120, "cycloidal"), ("dwell", 0, 60, ""), ("return", 30, 120, "polynomial-345")]
    lift = Lift(rows, arm=(80.0, 78.0, 80.0 * math.sin(math.radians(15.0)), 1))
    phi = np.linspace(0.0, 2.0 * math.pi, 2001)
    r = np.full_like(phi, 38.0)
    upper, lower = (envelope(lift.second(18.0 * k), -k, 10.0, r, phi)[0] for k in (1, -1))
    assert figure(RIB_ON_ARM, "rib-thickness") == pytest.approx((upper - lower).min(), abs=1e-4)


def test_curvature_across_the_line() -> None:
    flanks = shared_design(GROOVE).flanks
    for theta, rho, name, wanted in (
        (30, 44, "lower", 0.0824274423323),
        (90, 38, "lower", 0.143259107194),
        (90, 38, "upper", 0.0795001577066),
        (250, 38, "lower", 0.0971588273894),
    ):
        close(flanks[name].curvature(np.radians([float(theta)]), np.array([float(rho)]))[0], wanted)


@pytest.mark.slow
def test_the_pressure_of_a_line_that_a_cut_shortens() -> None:
    """Half way along what carries, by the judge's flank: it begins where no other roller has gone deeper."""
    driven = "undercut: shorten\n  drive: {load: 200, material: steel}"
    design = design_of(changed(UNDERCUT, ("undercut: shorten", driven)))
    found = {each.name: each for each in figures_of(design)}
    assert not {"contact-pressure", "mating-radius"} & found.keys()
    middle = found["contact-pressure-middle"]
    theta, follower = np.radians([middle.at]), intended(design).follower
    pressures = []
    for gauge in gauges_of(intended(design)):
        begin, end = follower.inner, follower.outer
        stands = [
            gauge.worst(flank_points(follower, theta, rho, gauge.side)).distance[0] > -1e-7 for rho in (begin, end)
        ]
        assert stands[1]
        low, high = begin, end
        while high - low > 1e-9 and not stands[0]:
            between = 0.5 * (low + high)
            cut = gauge.worst(flank_points(follower, theta, between, gauge.side)).distance[0] < -1e-7
            low, high = (between, high) if cut else (low, between)
        begin = begin if stands[0] else high
        # the line ends where the contact leaves the blank
        ends = [
            rho
            for rho in np.linspace(begin, end, 4001)
            if np.hypot(*flank_points(follower, theta, rho, gauge.side)[0, :2]) <= 40.0
        ]
        rho = 0.5 * (begin + ends[-1])
        force = 200.0 / np.cos(contact_angles(follower, theta, rho, gauge.side))[0]
        bent = relative_curvature(follower, theta, rho, gauge.side)[0]
        compliance = 2.0 * (1.0 - 0.3**2) / 206_000.0
        pressures.append(math.sqrt(force * bent / (math.pi * (ends[-1] - begin) * compliance)))
    assert middle.value == pytest.approx(max(pressures), rel=2e-3)


@pytest.mark.costly("two drums and all of their figures")
def test_the_pressure_where_nothing_is_cut_though_it_might_be() -> None:
    driven = ("  pitch_height", "  drive: {load: 200, material: steel}\n  pitch_height")
    told = [
        {each.name: each.value for each in figures_of(design_of(changed(text, driven)))}
        for text in (GROOVE, changed(GROOVE, ("  pitch_height", "  undercut: shorten\n  pitch_height")))
    ]
    assert told[1]["contact-pressure"] == told[0]["contact-pressure"] > told[0]["contact-pressure-middle"]
    assert told[1]["mating-radius"] == told[0]["mating-radius"]
