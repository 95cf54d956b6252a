"""Figures of indexing cams against formulas of their own, and against rollers by positions alone.

Holds: camgeo.capabilities.indexing.engaged, camgeo.capabilities.indexing.tracks,
camgeo.capabilities.indexing.turrets, camgeo.capabilities.indexing.checks_of,
camgeo.capabilities.indexing.section, camgeo.capabilities.indexing.tables.
"""

from __future__ import annotations

import functools
import math
from typing import TYPE_CHECKING

import numpy as np
import pytest
from capabilities.indexing.made_indexers import (
    BARREL,
    GLOBOID,
    changed,
    design_of,
    rollers_of,
    shared_design,
    window,
)

from camgeo.capabilities.indexing.checks_of import design_checks, remarks_on, walls
from camgeo.capabilities.indexing.figures import figures_of, volume
from camgeo.capabilities.indexing.section import index_section
from camgeo.capabilities.indexing.tables import motion_table
from camgeo.capabilities.indexing.tracks import removed, rib_thickness

if TYPE_CHECKING:
    from camgeo.capabilities.indexing.design import IndexDesign

DRIVEN = changed(
    BARREL,
    ("  motion", "  drive: {rpm: 60, load: 20, inertia: 0.05, material: steel}\n  motion"),
    ("keyway: din6885", "density: 7850"),
)
OVER = {BARREL: 150.0, GLOBOID: 120.0}


@functools.cache
def known(design: IndexDesign) -> dict[str, tuple[float, float | None]]:
    return {figure.name: (figure.value, figure.at) for figure in figures_of(design)}


def cycloid(theta: float, stops: int, over: float) -> tuple[float, float, float]:
    """Angle of the turret, rad, with two derivatives, in its rise."""
    b, h = math.radians(over), math.tau / stops
    u = theta / b
    return (
        h * (u - math.sin(math.tau * u) / math.tau),
        h / b * (1.0 - math.cos(math.tau * u)),
        h * math.tau / b**2 * math.sin(math.tau * u),
    )


def test_pressure_angles_are_those_of_the_formulas() -> None:
    """Tan alpha = (l psi' + s rho sin psi)/(rho cos psi) of a barrel, rho psi'/(C - rho cos psi) of a globoid."""
    theta = np.radians([20.0, 60.0, 75.0, 100.0])
    barrel, globoid = shared_design(BARREL), shared_design(GLOBOID)
    for rho in (38.0, 49.0):
        for k, angle in enumerate(theta.tolist()):
            s, rate, _ = cycloid(angle, 6, 150.0)
            psi = s - math.pi / 6
            wanted = math.atan((60.0 * rate + rho * math.sin(psi)) / (rho * math.cos(psi)))
            found = barrel.flanks["lower"].pressure(theta, np.full(4, rho))[k]
            assert found == pytest.approx(wanted, abs=1e-9)
            s, rate, _ = cycloid(angle, 8, 120.0)
            wanted = math.atan((rho + 10.0) * rate / (90.0 - (rho + 10.0) * math.cos(s - math.pi / 8)))
            found = globoid.flanks["upper"].pressure(theta, np.full(4, rho + 10.0))[k]
            assert found == pytest.approx(wanted, abs=1e-9)


def test_the_steepest_roller_of_a_globoid() -> None:
    """In the middle of the rise one roller faces the cam, and its outer end is the steepest."""
    found = known(shared_design(GLOBOID))
    rate = 2.0 * 45.0 / 120.0
    end = math.sqrt(62.0**2 - 8.0**2)  # of the roller, whose rim stands half a millimetre off the floor
    for name, rho in (("", end), ("-inner", 49.0), ("-outer", end), ("-middle", 0.5 * (49.0 + end))):
        value, at = found[f"pressure-angle{name}"]
        assert value == pytest.approx(math.degrees(math.atan(rho * rate / (90.0 - rho))), abs=1e-6)
        assert at == pytest.approx(60.0, abs=0.01)
    assert found["pressure-angle-any"][0] >= found["pressure-angle"][0]
    assert found["contact-length"][0] == pytest.approx(end - 49.0)


@pytest.mark.parametrize("text", [BARREL, GLOBOID], ids=["barrel", "globoid"])
@pytest.mark.parametrize("share", [0.1, 0.9])
def test_what_rollers_take_out_of_a_layer(text: str, share: float) -> None:
    """The area is that of all places of a layer to which a roller comes nearer than its radius."""
    design = shared_design(text)
    form, rollers = design.recipe.form, rollers_of(design, OVER[text])
    w = form.floor + share * (form.blank - form.floor)
    low, high = (float(end) for end in form.ends(w))
    heights = low + (np.arange(160) + 0.5) * (high - low) / 160
    phi = math.tau * (np.arange(12) + 0.37) / 12
    every, area, inside = window(design.recipe.stops), 0.0, 0.0
    for angle in phi.tolist():
        # of one roller, all its turns: the same as all rollers of one turn
        free = np.zeros(heights.size, dtype=bool)
        for turn in (-1, 0, 1):
            points = form.points(np.full(heights.size, angle + turn * math.tau), heights, w)
            near = np.abs(every - angle - turn * math.tau) < 1.5
            free |= rollers.away(points, every[near][::8]).min(axis=1) < design.recipe.roller.radius
        each = w if text == BARREL else w * (90.0 - w * np.cos(heights))
        area += float(np.sum(free * each)) * (high - low) / 160 * math.tau / 12
        inside += float(np.sum(np.ones(160) * each)) * (high - low) / 160 * math.tau / 12
    assert removed(design, w) == pytest.approx(area, rel=0.02)
    assert 0.2 * inside < area < 0.8 * inside


def test_volumes() -> None:
    """Of the blank less the bore, where next to nothing is taken out; of the layers otherwise."""
    barrel, globoid = shared_design(BARREL), shared_design(GLOBOID)
    z = np.linspace(-30.0, 30.0, 20001)
    whole = float(np.trapezoid(math.pi * (90.0 - np.sqrt(49.0**2 - z**2)) ** 2, z))
    assert globoid.recipe.form.volume == pytest.approx(whole, rel=1e-8)
    r = np.linspace(37.0, 50.0, 11)
    taken = float(np.trapezoid([removed(barrel, w) for w in r.tolist()], r))
    bore = 0.0 if barrel.bore is None else barrel.bore.outline.area
    assert volume(barrel) == pytest.approx(math.pi * 2500 * 80 - bore * 80 - taken, rel=1e-4)


@pytest.mark.slow
@pytest.mark.parametrize("text", [BARREL, GLOBOID], ids=["barrel", "globoid"])
def test_the_rib_is_thinnest_where_rollers_come_nearest_to_one_another(text: str) -> None:
    """At the place that the figure names, the rib between two rollers is what both leave of it."""
    design = shared_design(text)
    thin, at = rib_thickness(design)
    form, rollers = design.recipe.form, rollers_of(design, OVER[text])
    every, there, elsewhere = window(design.recipe.stops), [], []
    for w in (form.floor, 0.5 * (form.floor + form.blank), form.blank):
        low, high = (float(end) for end in form.ends(w))
        unit = 1.0 if text == BARREL else w
        h = np.linspace(low, high, 900)
        place = float(design.flanks["upper"].on(np.array([at]), w).phi[0])
        for phi in (place, *(place + np.radians(np.arange(-45.0, 46.0, 5.0)))):
            near = every[(np.abs(every - phi) < 1.4)][::6]
            next_one = every[(np.abs(every - phi - math.tau) < 1.4)][::6]
            below = rollers.away(form.points(np.full(h.size, phi), h, w), near).min(axis=1)
            above = rollers.away(form.points(np.full(h.size, phi), h, w), next_one).min(axis=1)
            lower, upper = below < design.recipe.roller.radius, above < design.recipe.roller.radius
            if lower.any() and upper.any():
                (there if phi == place else elsewhere).append(unit * float(h[upper].min() - h[lower].max()))
    assert thin == pytest.approx(min(there), abs=0.15)
    assert min(elsewhere) > thin - 0.15


def test_curvature_is_that_of_the_gap_across_the_line() -> None:
    """The distance of the flank from the roller's axis grows by kappa d^2/2 across the line of contact.

    It is measured by positions: points of the flank beside the contact, and their distances from the axis there.
    """
    for text, rho in ((BARREL, 44.0), (GLOBOID, 56.0)):
        design = shared_design(text)
        rollers = rollers_of(design, OVER[text])
        for name in ("lower", "upper"):
            flank = design.flanks[name]
            theta, step = math.radians(50.0), 2e-3
            contact = flank.along(np.array([theta]), np.array([rho]))
            w = float(contact.w[0])
            here = design.recipe.form.points(contact.phi, contact.h, contact.w)[0]
            beside = flank.on(np.array([theta - step, theta + step]), w)
            points = design.recipe.form.points(beside.phi, beside.h, beside.w)
            away = rollers.away(points, np.array([theta]))[:, 0] - design.recipe.roller.radius
            along = flank.along(np.array([theta, theta]), np.array([rho - 1e-4, rho + 1e-4]))
            ends = design.recipe.form.points(along.phi, along.h, along.w)
            line = (ends[1] - ends[0]) / np.linalg.norm(ends[1] - ends[0])
            off = points - here
            across = np.linalg.norm(off - np.outer(off @ line, line), axis=1)
            wanted = float(np.mean(2.0 * away / across**2))
            assert float(flank.curvature(np.array([theta]), np.array([rho]))[0]) == pytest.approx(wanted, rel=5e-3)


@pytest.mark.slow
def test_loads_follow_from_virtual_work() -> None:
    """T = (load + J psi'' Omega^2) psi', the torque on the turret its first factor; velocities those of a cycloid."""
    found = known(shared_design(DRIVEN))
    rate = math.tau
    theta = np.radians(np.linspace(0.0, 150.0, 3001))
    rows = np.array([cycloid(angle, 6, 150.0) for angle in theta.tolist()]).T
    turret = 20.0 + 0.05 * rows[2] * rate**2
    assert found["velocity"][0] == pytest.approx(2.0 * 60.0 / 150.0 * 360.0)
    assert found["acceleration"][0] == pytest.approx(math.degrees(float(rows[2].max()) * rate**2))
    assert found["turret-torque"][0] == pytest.approx(float(np.abs(turret).max()), rel=1e-6)
    assert found["torque"][0] == pytest.approx(float(np.abs(turret * rows[1]).max()), rel=1e-6)
    assert found["mass"][0] == pytest.approx(volume(shared_design(DRIVEN)) * 7850e-9)
    assert found["contact-force"][0] > 1e3 * 20.0 / 60.0
    light = known(design_of(changed(DRIVEN, ("load: 20, inertia: 0.05", "load: 10"))))
    heavy = known(design_of(changed(DRIVEN, ("load: 20, inertia: 0.05", "load: 40"))))
    assert heavy["contact-force"][0] == pytest.approx(4.0 * light["contact-force"][0], rel=1e-6)
    assert heavy["contact-pressure"][0] == pytest.approx(2.0 * light["contact-pressure"][0], rel=1e-6)


@pytest.mark.slow
def test_play_is_the_clearance_by_its_lever() -> None:
    """In the dwell two rollers stand 30 degrees beside the middle: cos alpha 60 is their lever."""
    design = design_of(changed(BARREL, ("roller: 9", "roller: 9, clearance: 0.06")))
    value, at = known(design)["play"]
    table = motion_table(design, np.radians([200.0, 300.0]))[1]
    assert table[:, 5] == pytest.approx([-30.0, -30.0])
    assert value >= math.degrees(0.06 / (60.0 * math.cos(math.radians(30.0)))) * (1.0 - 1e-9)
    assert at is not None
    assert "play" not in known(shared_design(BARREL))


@pytest.mark.costly("figures over the whole turn")
def test_rollers_engaged() -> None:
    """In the dwell the rib stands between two rollers: a flank bears on at least one of them."""
    found = known(shared_design(BARREL))
    assert found["engaged-least"][0] >= 1.0
    assert found["engaged-most"][0] <= 3.0
    many = known(
        design_of(changed(GLOBOID, ("stops: 8, roller: 8", "stops: 16, roller: 5"), ("rise: 45", "rise: 22.5")))
    )
    assert many["engaged-least"][0] > known(shared_design(GLOBOID))["engaged-least"][0]


def test_the_table() -> None:
    """Each row has the turret's angle, its derivatives by the radian, and the pressure angles of both flanks."""
    names, rows = motion_table(shared_design(BARREL), np.radians([60.0, 180.0]))
    s, rate, bend = cycloid(math.radians(60.0), 6, 150.0)
    assert names[:4] == ("shaft_deg", "turret_deg", "velocity", "acceleration")
    assert rows[0, :4] == pytest.approx([60.0, math.degrees(s) - 30.0, math.degrees(rate), math.degrees(bend)])
    assert rows[1, :4] == pytest.approx([180.0, 30.0, 0.0, 0.0])


def test_checks_and_remarks() -> None:
    design = shared_design(BARREL)
    figures = figures_of(design)
    checks = {check.name: check for check in design_checks(design, figures)}
    assert all(check.ok for check in checks.values())
    assert walls(design)[0][0] == pytest.approx(37.0 - math.hypot(12.0 + 3.3, 4.0))
    assert walls(shared_design(GLOBOID))[0][0] == pytest.approx(90.0 - 62.5 - 10.0)
    assert walls(design_of(changed(BARREL, (", bore: 24, keyway: din6885", ""))))[0][0] == pytest.approx(74.0)
    (remark,) = remarks_on(design, figures)
    assert "the pressure angle of the best placed roller reaches" in remark.sentence
    section = index_section(design, figures)
    assert section["form"] == "barrel"
    assert section["offset"] == pytest.approx(30.0 * (1.0 + math.cos(math.pi / 6)))


@pytest.mark.slow
def test_rollers_that_reach_out_of_the_blank_bear_within_it() -> None:
    """However far they go on, they bear as those that end at the blank."""
    one, other = (design_of(changed(BARREL, ("roller: 9", f"roller: 9, to: {to}"))) for to in (50, 500))
    assert known(other)["contact-length"] == pytest.approx(known(one)["contact-length"])
    limits = [design_checks(each, figures_of(each))[1].limit for each in (one, other)]
    assert limits == pytest.approx([0.15 * 12.5] * 2)


@pytest.mark.slow
def test_a_cam_too_short_for_its_turret_is_told() -> None:
    """Where no roller bears on a flank the check of the line of contact fails, and says what serves."""
    text = changed(BARREL, ("length: 80", "length: 36"))
    design = design_of(text)
    checks = {check.name: check for check in design_checks(design, figures_of(design))}
    assert not checks["contact-length"].ok
    assert "give more stops, or a longer cam" in checks["contact-length"].detail
    longer = design_of(changed(text, ("length: 36", "length: 76")))
    assert {check.name: check.ok for check in design_checks(longer, figures_of(longer))}["contact-length"]
