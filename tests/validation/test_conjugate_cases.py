"""Conjugate discs: worked cases, and both contacts led by hand along either contour.

The cases are d11 and d12 of the sheet on disc cams. Where the rollers and faces are, is written down here from the
motion alone, with no moving frame: how far the contour is from them is looked for all along it.
"""

import math
import re
from pathlib import Path

import numpy as np
import pytest
from support import brute_disc

from camgeo.fit.arcs import fit_arcs
from camgeo.recipe.loading import read
from camgeo.synthesis.design import designed
from camgeo.synthesis.intent import closures_between, intents
from kin.contour.contour import Contour
from kin.judge.closure import judge_closures
from kin.judge.intent import Limits

TURN = 2 * math.pi
D09 = [(24.0, 100.0, "polynomial-4567"), (0.0, 40.0, ""), (-24.0, 140.0, "polynomial-4567"), (0.0, 80.0, "")]
D07 = [(20.0, 110.0, "modified-sine"), (0.0, 50.0, ""), (-20.0, 120.0, "cycloidal"), (0.0, 80.0, "")]
SWING = [(20.0, 110.0, "polynomial-345"), *D07[1:]]
NAMES = ("disc 1", "disc 2")


def text(follower, conjugate, rows=D09, base=36.0, more=""):
    steps = [
        f"{{{'rise' if by > 0 else 'return'}: {abs(by)!r}, over: {over!r}, law: {law}}}"
        if law
        else f"{{dwell: {over!r}}}"
        for by, over, law in rows
    ]
    return (
        f"cam:\n  kind: disc\n  base_radius: {base!r}\n  follower: {{{follower}}}\n"
        f"  conjugate: {{{conjugate}}}\n  motion: [{', '.join(steps)}]\n{more}"
    )


def design_of(*args, **kwargs):
    return designed(read(text(*args, **kwargs).encode(), Path("pair.yaml")))


STEM = "kind: roller, radius: 9, offset: 6", "radius: 11, distance: 120"
CRANK = "kind: roller, radius: 8, arm: {length: 65, pivot: 80}", "radius: 9, length: 60, angle: 90"


@pytest.mark.thin(2)
@pytest.mark.parametrize(
    ("pair", "points", "pressure", "least"),
    [
        (
            (*STEM, D09, 36.0),
            {
                0: (-64.436455097, 5.127447390),
                50: (-41.732077194, -34.323915452),
                250: (25.649630320, 58.284731346),
            },
            (-21.018564856, 23.829947468),
            40.190322820,
        ),
        (
            (*CRANK, D07, 34.0),
            {0: (42.388997607, 44.597705924), 55: (-9.201006093, 50.886019754), 230: (9.986768761, -54.168544147)},
            (-24.412066316, 15.123628872),
            46.124248614,
        ),
    ],
)
def test_disc_2_of_the_cases(pair, points, pressure, least):
    design = design_of(*pair)
    _, second = design.exact.surfaces
    found = second.curve.sample(np.radians(list(points))).point
    assert found == pytest.approx(np.array(list(points.values())), abs=1.01e-9)
    slopes = [math.degrees(math.atan(end.value)) for end in second.extremes("slope")]
    assert slopes == pytest.approx(pressure, abs=1e-8)
    (radius,) = [check.value for check in design.checks if (check.name, check.surface) == ("pitch-radius", "disc 2")]
    assert radius == pytest.approx(least, abs=1e-8)


PAIRS = {
    "stem": (*STEM, D09, 36.0),
    "stem with shoes": ("kind: shoe, radius: 20, offset: -4", "distance: 132", D09, 30.0),
    "crank": (*CRANK, SWING, 34.0),
    "leading crank": (CRANK[0].replace("}", ", side: leading}"), "length: 70, angle: 110", SWING, 34.0),
    "flat": ("kind: flat, offset: 5", "distance: 100", [(8.0, 150.0, "cycloidal"), (-8.0, 210.0, "cycloidal")], 38.0),
}


def places(name, theta):
    """Centres of both rollers (complex), or distance and direction of both faces, at a shaft angle, the cam at rest."""
    follower, conjugate, rows, base = PAIRS[name]
    follower, conjugate = numbers(follower), numbers(conjugate)
    s = float(brute_disc.motion(rows, np.degrees(np.atleast_1d(theta)))[0])
    if name == "flat":
        return (base + s, theta), (conjugate["distance"] - base - s, theta + math.pi)
    r, e = follower["radius"], follower.get("offset", 0.0)
    line = np.exp(1j * theta)
    if "crank" not in name:
        along = math.sqrt((base + r) ** 2 - e**2) + s
        return line * (along + 1j * e), line * (along - conjugate["distance"] + 1j * e)
    pivot, arm = 80.0, 65.0
    side = -1 if "leading" in name else 1
    rest = math.acos((pivot**2 + arm**2 - (base + r) ** 2) / (2 * pivot * arm)) + math.radians(s)
    other = rest - math.radians(conjugate["angle"])
    return tuple(
        line * (pivot - by * np.exp(1j * side * lean)) for by, lean in ((arm, rest), (conjugate["length"], other))
    )


def numbers(keys):
    return {key: float(value) for key, value in re.findall(r"(\w+): (-?[\d.]+)", keys)}


@pytest.mark.thin(6)
@pytest.mark.parametrize("name", PAIRS)
def test_each_contact_touches_its_disc_all_round(name):
    """The nearest point of each contour is a radius from the roller's centre, or lies on the face and none beyond."""
    assert_touching(name, design_of(*PAIRS[name]), (0.0, 0.0))


@pytest.mark.parametrize(
    "name", ["crank", *(pytest.param(name, marks=pytest.mark.slow) for name in PAIRS if name != "crank")]
)
def test_a_preload_stands_on_disc_2_alone(name):
    """Its metal is nearer by all of the interference all round, that of disc 1 by nothing."""
    follower, conjugate, *more = PAIRS[name]
    design = design_of(follower, f"{conjugate}}}\n  preload: {{interference: 0.3", *more)
    assert_touching(name, design, (0.0, 0.3))


def assert_touching(name, design, overlaps):
    follower, conjugate = map(numbers, PAIRS[name][:2])
    surfaces = design.exact.surfaces
    radii = follower.get("radius", 0.0), conjugate.get("radius", follower.get("radius", 0.0))
    all_round = [sampled(surface, T) for surface in surfaces]
    for theta in np.radians(np.arange(0.0, 360.0, 17.3)):
        for k, place in enumerate(places(name, theta)):
            if name == "flat":
                distance, towards = place
                off = least(surfaces[k], all_round[k], lambda z, d=distance, a=towards: d - (z * np.exp(-1j * a)).real)
            else:
                off = least(surfaces[k], all_round[k], lambda z, c=place: np.abs(z - c)) - radii[k]
            assert abs(off + overlaps[k]) < 1e-9, (math.degrees(theta), NAMES[k])


T = np.linspace(0.0, TURN, 2000, endpoint=False)


def sampled(surface, t):
    return surface.curve.sample(np.mod(t, TURN)).point @ np.array([1.0, 1j])


def least(surface, all_round, far):
    """Least of what a function makes of the points of a contour, looked at ever more closely."""
    best, t, value = int(np.argmin(far(all_round))), T, math.inf
    for _ in range(4):
        t = t[best] + (t[1] - t[0]) * np.linspace(-2.0, 2.0, 81)
        seen = far(sampled(surface, t))
        best, value = int(np.argmin(seen)), float(seen.min())
    return value


@pytest.mark.thin(5)
@pytest.mark.parametrize("name", PAIRS)
def test_the_judge_finds_nothing_left_between_the_discs(name):
    """Contours of arcs within 1e-5 mm, each judged under its own gauge, and both as they hold the follower."""
    design = design_of(*PAIRS[name])
    recipe = read(text(*PAIRS[name]).encode(), Path("pair.yaml"))
    first, second = intents(recipe, design)
    assert [one.name for part in (first, second) for one in part.surfaces] == list(NAMES)
    read_back = []
    for part, (_, curve) in zip((first, second), design.contours, strict=True):
        arcs = fit_arcs(curve, 1e-5)
        contour = Contour.from_bulges(arcs.points, arcs.bulges)
        (surface,) = part.surfaces
        judged = surface.gauge.judge(contour, np.radians(np.arange(0.0, 360.0, 5.0)))
        assert judged.motion.max <= surface.gauge.motion_limit(1.1e-5)
        read_back.append((surface, contour))
    (closure,), (check,) = judge_closures(read_back, closures_between(design), Limits(1e-5))
    assert check.ok
    assert max(abs(closure.play.least), abs(closure.play.most)) <= check.limit
    assert (closure.pushes, closure.stops) == NAMES
