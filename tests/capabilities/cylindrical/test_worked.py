"""Worked cylindrical cams, each figure held against brute force that knows positions alone (mpmath, 30 digits).

The flank is the lowest underside, or the highest top, of all rollers at a radius and an angle. What stands in no table
is computed here, by searching that envelope.

Holds: camgeo.capabilities.cylindrical.flank, camgeo.capabilities.cylindrical.figures,
camgeo.capabilities.cylindrical.undercut.
"""

from __future__ import annotations

import math

import mpmath
import numpy as np
import pytest
from capabilities.cylindrical.made_drums import GROOVE, RIB, TOP, UNDERCUT, changed, design_of
from capabilities.cylindrical.positions import law_at

from camgeo.capabilities.cylindrical.checks_of import offset_off, wrapped_off
from camgeo.capabilities.cylindrical.figures import figures_of, rib_thickness
from camgeo.capabilities.cylindrical.undercut import below

DIGITS = 1e-10
LEVEL = 20.0  # z of the cases is over the pitch line


def close(found: object, wanted: object) -> None:
    np.testing.assert_allclose(found, wanted, rtol=DIGITS, atol=DIGITS)


def figure(text: str, name: str) -> float:
    return next(each.value for each in figures_of(design_of(text)) if each.name == name)


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
    design = design_of(GROOVE)
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
    values = {each.name: each.value for each in figures_of(design_of(GROOVE))}
    close([values["pressure-angle"], values["pressure-angle-middle"]], [45.1482721410, 40.9618320715])
    # the blank ends the contact before the roller does: at 49.63 in place of 50, where the formula says 37.38
    assert values["pressure-angle-outer"] == pytest.approx(37.59, abs=5e-3)
    at_50 = changed(
        GROOVE, ("radius: 50", "radius: 60"), ("depth: 12.5", "depth: 22.5"), ("from: 38", "from: 38, to: 50")
    )
    close(figure(at_50, "pressure-angle-outer"), 37.3777916118)


def test_a_flank_on_the_cylinder_of_the_blank() -> None:
    flank = design_of(GROOVE).flanks["lower"]
    contact = flank.on(np.radians([30.0, 60.0]), 50.0)
    close(50.0 * contact.phi, [29.7592556974, 58.4745116351])
    close(contact.z - LEVEL, [-5.70484645319, 12.0755272731])


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
    found, _ = offset_off(design_of(helix(radius, roller, angle, radius - 1.0)), float(radius))
    close(found, wanted)


def test_what_radial_walls_cost() -> None:
    """Of a helix of 30 degrees from 50 to 38 mm it is 1.02628; a cam's motion is steep at one place alone."""
    design = design_of(GROOVE)
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
    design = design_of(changed(GROOVE, ("depth: 12.5", "depth: 12.5, clearance: 0.3")))
    for theta, r, name, roller in ((17.0, 41.3, "lower", 10), (101.0, 49.2, "upper", 10.3), (288.5, 37.6, "lower", 10)):
        flank = design.flanks[name]
        contact = flank.on(np.array([math.radians(theta)]), r)
        with mpmath.workdps(30):
            wanted = height(flank.side, r, mpmath.mpf(float(contact.phi[0])), roller)
        close(contact.z[0] - LEVEL, float(wanted))


@pytest.mark.costly("a flank's cut is found along its envelope")
def test_undercut_at_the_inner_end_alone() -> None:
    """The rule of the development, a radius of curvature above the roller's, would say 28.8626."""
    design = design_of(UNDERCUT)
    lower = design.flanks["lower"]
    close(below(lower, 20.0, 40.0)[0], 29.100516094)
    close(figure(UNDERCUT, "undercut-radius"), 29.100516094)
    for rho, at, wanted in (
        (40, 47.70907, 17.8819315878),
        (30, 48.30676, 1.63176748872),
        (25, 48.77245, -7.96125505181),
        (20, 49.41918, -19.2693524244),
    ):
        theta = np.radians(np.linspace(at - 0.01, at + 0.01, 401))
        assert lower.along(theta, np.full_like(theta, rho)).regular.min() == pytest.approx(wanted, abs=1e-9)
    # what carries at 50 degrees begins where the cut ends, and loses nothing
    assert figure(UNDERCUT, "contact-length") == pytest.approx(40.0 - 29.2, abs=0.1)
    assert 0.5 < figure(UNDERCUT, "carrying-share") < 0.6


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
    design = design_of(RIB)
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


def test_curvature_across_the_line() -> None:
    flanks = design_of(GROOVE).flanks
    for theta, rho, name, wanted in (
        (30, 44, "lower", 0.0824274423323),
        (90, 38, "lower", 0.143259107194),
        (90, 38, "upper", 0.0795001577066),
        (250, 38, "lower", 0.0971588273894),
    ):
        close(flanks[name].curvature(np.radians([float(theta)]), np.array([float(rho)]))[0], wanted)
