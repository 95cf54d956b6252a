"""Rings as they are designed: where they undercut by brute force, walls, and advice that does."""

import math
import re

import numpy as np
import pytest

from camgeo.recipe.loading import load_text
from camgeo.synthesis.checks import hollow_radius
from camgeo.synthesis.design import designed

MOTION = "[{{rise: 12, over: {}, law: modified-sine}}, {{dwell: 60}}, {{return: 12, over: 100, law: cycloidal}}, "
MOTION += "{{dwell: {}}}]"
TURN = 2 * math.pi


def ring(radius, *, rise=50, base=30.0, part="{outer: 130}", more=""):
    said = f"kind: disc, base_radius: {base}, track: internal, follower: {{kind: roller, radius: {radius}}}{more}"
    motion = MOTION.format(rise, 200 - rise)
    return load_text(f"cam: {{{said}, motion: {motion}}}\npart: {part}\n", "ring.yaml")


def checks(recipe):
    return {check.name: check for check in designed(recipe).checks}


def pitch(recipe, count=40_000):
    """Points of the pitch curve as complex numbers, and its radius of curvature there, by differences alone."""
    law = designed(recipe).exact.law
    theta = TURN * np.arange(count) / count
    z = (recipe.cam.prime + law.derivatives(theta, 0)[0]) * np.exp(-1j * theta)
    step = TURN / count
    first = (np.roll(z, -1) - np.roll(z, 1)) / (2 * step)
    second = (np.roll(z, -1) - 2 * z + np.roll(z, 1)) / step**2
    with np.errstate(divide="ignore"):
        return z, first, np.abs(first) ** 3 / np.imag(first.conj() * second)


@pytest.mark.thin(3)
@pytest.mark.parametrize("rise", [40, 50, 60])
def test_the_hollows_of_the_pitch_curve_hold_the_roller(rise):
    """Run through clockwise as the shaft turns, the curve bends to the left in its hollows."""
    recipe = ring(4.0, rise=rise, base=25.0)
    _, _, radius = pitch(recipe)
    hollow = radius[radius > 0].min()
    told = checks(recipe)["pitch-radius"]
    assert told.value == pytest.approx(hollow, rel=1e-5)
    assert told.limit == 4.0
    assert told.ok == (hollow > 4.0)


@pytest.mark.slow
@pytest.mark.parametrize(("beyond", "sound"), [(-0.05, True), (0.05, False)])
def test_a_roller_at_the_limit_against_all_its_own_positions(beyond, sound):
    """Contact is where no other place of the roller's centre lies nearer to the opening than its radius."""
    start = ring(9.0)
    least = checks(start)["pitch-radius"].value
    radius = least + beyond
    recipe = ring(radius, base=start.cam.prime + radius)
    z, first, _ = pitch(recipe, 4000)
    outward = 1j * first / np.abs(first)
    edge = z + radius * outward * np.sign(np.real(outward * z.conj()))
    near = np.array([np.abs(point - z).min() for point in edge])
    assert (near.min() > radius - 1e-6) == sound
    assert checks(recipe)["undercut-local"].ok == sound
    assert checks(recipe)["pitch-radius"].ok == sound


def test_the_opening_is_wider_than_its_roller():
    recipe = ring(9.0, rise=100)
    design = designed(recipe)
    _, _, radius = pitch(recipe)
    widest = -radius[radius < 0].max()
    assert hollow_radius(recipe.cam.side, design.only_surface.contour)[0] == pytest.approx(widest + 9.0, rel=1e-5)


def test_a_ring_without_hollows_has_no_limit():
    told = checks(ring(9.0, rise=140, base=60.0, part="{outer: 200}"))["pitch-radius"]
    assert told.ok
    assert math.isinf(told.value)
    assert told.at_deg is None
    assert told.detail == "the pitch curve of the ring has no hollow"


@pytest.mark.slow
def test_the_roller_that_would_do_does():
    found = checks(ring(9.0))["undercut-local"]
    assert not found.ok
    said = re.search(
        r"a roller radius below ([0-9.]+) with a base radius of ([0-9.]+) and that radius would be", found.detail
    )
    assert said
    radius = 0.9999 * float(said[1])
    assert all(check.ok for check in checks(ring(radius, base=float(said[2]) + radius)).values())


@pytest.mark.slow
@pytest.mark.parametrize(
    ("part", "wall", "pair"),
    [
        ("{outer: 90}", 3.0, "opening and outline"),
        ("{outer: 83}", -0.5, "opening and outline"),
        ("{outer: 130, bolts: {count: 1, circle: 118, hole: 8}}", 2.0, "bolt hole 1 and outline"),
        ("{outer: 130, dowel: {circle: 90, hole: 5, at: 80}}", 0.5, "dowel hole and contour"),
        ("{outer: 130, dowel: {circle: 60, hole: 5, at: 80}}", -9.5, "dowel hole and contour"),
    ],
)
def test_walls_of_a_ring(part, wall, pair):
    """The opening reaches to 42 mm, from 50 to 110 degrees."""
    found = designed(ring(9.0, rise=50, base=30.0, part=part, more=", undercut: trim"))
    (check,) = (one for one in found.checks if one.name == "wall")
    assert check.value == pytest.approx(wall, abs=2e-9 if wall > 0 else 1e-6)
    assert check.detail.startswith(pair)
    assert check.ok == (wall > 0) == (found.discs[0].body is not None)


@pytest.mark.thin(2)
@pytest.mark.parametrize("part", ["{outer: 83}", "{outer: 90, wall: 4}"])
def test_the_outline_that_would_do_does(part):
    from camgeo.checks.declared import WALL
    from camgeo.checks.remedies import smaller_bore

    recipe = ring(9.0, rise=100, part=part)
    (check,) = (one for one in designed(recipe).checks if one.name == "wall")
    assert not check.ok
    said = re.fullmatch(
        r"a part\.outer larger by more than ([0-9.]+) mm",
        smaller_bore({"value": check.value, "limit": check.limit, "unit": "mm"}, {}, recipe),
    )
    assert said
    assert WALL.place(recipe, None) == "part.outer"
    larger = recipe.part.outer + float(said[1]) + 1e-6
    assert all(one.ok for one in designed(recipe.replace("part.outer", larger)).checks)


def test_no_roller_is_told_for_the_hollows_of_an_opening():
    """With the base radius a wider roller leaves the opening as wide as it is."""
    from camgeo.output import pipeline

    text = ring(9.0, rise=100).text + "limits: {hollow-radius: {at_least: 60}}\nexport: {files: [csv]}\n"
    checks = pipeline.check(load_text(text, "ring.yaml")).report["checks"]
    (check,) = (one for one in checks if one["name"] == "limit:hollow-radius")
    assert not check["ok"]
    assert "roller" not in check["detail"]
    assert "limits.hollow-radius.at_least of" in check["detail"]


# --- siblings ---------------------------------------------------------------------------------------------------------


def cam(follower, motion, base=30):
    return load_text(
        f"cam: {{kind: disc, base_radius: {base}, follower: {{{follower}}}, motion: {motion}}}\n", "cam.yaml"
    )


@pytest.mark.thin(2)
@pytest.mark.parametrize("follower", ["kind: knife-edge", "kind: knife-edge, arm: {length: 60, pivot: 70}"])
def test_a_knife_edge_passes_a_hollow(follower):
    design = designed(cam(follower, MOTION.format(50, 150)))
    assert (design.only_surface.contour.sample(np.linspace(0, TURN, 500)).turn < 0).any()
    assert all(check.ok for check in design.checks if check.name != "pressure-angle")


def test_a_shoe_is_told_of_its_own_radius():
    (check,) = (
        one
        for one in designed(cam("kind: shoe, radius: 60", MOTION.format(50, 150))).checks
        if one.name == "undercut-local"
    )
    assert not check.ok
    assert "a shoe radius below" in check.detail
    assert "roller" not in check.detail


@pytest.mark.thin(2)
@pytest.mark.parametrize("kind", ["{rise_fall: 12, over: 360}", "{displacement: 5*(1-cos(2*pi*u)), over: 360}"])
def test_one_segment_fills_the_turn(kind):
    assert all(check.ok for check in designed(cam("kind: roller, radius: 8", f"[{kind}]")).checks)
