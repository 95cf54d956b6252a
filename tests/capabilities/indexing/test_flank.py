"""Flanks of indexing cams against worked cases, and against rollers at all angles by positions alone.

Holds: camgeo.capabilities.indexing.flank, camgeo.capabilities.indexing.forms, camgeo.capabilities.indexing.undercut,
camgeo.capabilities.indexing.spans, camgeo.capabilities.indexing.bends.
"""

from __future__ import annotations

import math
import random
from typing import Any

import numpy as np
import pytest
from capabilities.indexing.made_indexers import shared_design
from capabilities.indexing.rollers import TURN, Indexed, barrel_away, globoid_away, nearest

from camgeo.capabilities.indexing.bends import bends, pose_over, second_of
from camgeo.capabilities.indexing.flank import Flank
from camgeo.capabilities.indexing.forms import Barrel, Globoid
from camgeo.capabilities.indexing.law import IndexLaw
from camgeo.capabilities.indexing.spans import TrackError, layers_at, span_of
from camgeo.capabilities.indexing.turrets import BarrelTurret
from camgeo.capabilities.indexing.undercut import UndercutError, demand_regular, least_regular
from kin.law.piecewise import Piecewise
from kin.law.segment import Constant, Power, moved
from kin.numeric.records import replace

SHARES = {
    "polynomial-345": (0.0, 0.0, 0.0, 10.0, -15.0, 6.0),
    "polynomial-4567": (0.0, 0.0, 0.0, 0.0, 35.0, -84.0, 70.0, -20.0),
}


def law_of(rise: float, over: float, law: str = "polynomial-345", turns: tuple[int, int] = (-5, 5)) -> IndexLaw:
    """Motion of a turret that rises by so many degrees over others of each turn, and rests."""
    advance, width = math.radians(rise), math.radians(over)
    functions = moved(Power(SHARES[law]), scale=advance, width=width), Constant(advance)
    return IndexLaw(Piecewise(np.array([0.0, width, TURN]), functions), advance, turns)


class Cycloids:
    """The motion of the worked cases, written out."""

    def __init__(self, rise: float, over: float) -> None:
        self.rise, self.over = math.radians(rise), math.radians(over)

    def derivatives(self, theta: Any, order: int, _side: int = 1) -> np.ndarray:
        u, l, h = np.asarray(theta) / self.over, self.over, self.rise
        a = 2.0 * np.pi * u
        rows = [h * (u - np.sin(a) / TURN), h / l * (1.0 - np.cos(a)), h * TURN / l**2 * np.sin(a)]
        return np.array([*rows, h * TURN**2 / l**3 * np.cos(a)])[: order + 1]


WORKED_BARREL = Barrel(50.0, 14.5, 60.0, 60.0, 1, 0.0, 90.0)
WORKED_GLOBOID = Globoid(49.0, 14.0, 90.0, 0.0, 60.0)


@pytest.mark.parametrize(
    ("place", "wanted"),
    [
        ((40.0, 44.0, -1), (45.1822706308, 53.1360149742, 36.024213112, -31.2009649506)),
        ((75.0, 36.0, 1), (36.7129404979, 63.690067526, 53.130102354, 5.4)),
        ((110.0, 44.0, 1), (44.0195752172, 111.708771914, 24.013065794, 32.1431223568)),
    ],
)
def test_a_barrel_as_worked_by_hand(place: tuple[float, float, int], wanted: tuple[float, ...]) -> None:
    (theta, rho, side), (r, phi, angle, z) = place, wanted
    flank = Flank(WORKED_BARREL, Cycloids(60.0, 150.0), math.radians(-30.0), 9.0, side)
    at = np.array([math.radians(theta)])
    found = flank.along(at, np.array([rho]))
    assert found.w[0] == pytest.approx(r, abs=1e-10)
    assert math.degrees(found.phi[0]) == pytest.approx(phi, abs=1e-9)
    assert math.degrees(found.angle[0]) == pytest.approx(angle, abs=1e-9)
    assert found.z[0] == pytest.approx(z, abs=1e-10)
    assert found.h[0] == found.z[0]
    assert flank.on(at, found.w).rho[0] == pytest.approx(rho, abs=1e-11)
    # the force on the roller's way: arm formula (l psi' + s rho sin psi)/(rho cos psi)
    psi, rate = flank.law.derivatives(at, 1)
    psi = psi[0] + flank.start
    steep = (60.0 * rate[0] + rho * math.sin(psi)) / (rho * math.cos(psi))
    assert math.tan(flank.pressure(at, np.array([rho]))[0]) == pytest.approx(steep, rel=1e-12)


@pytest.mark.parametrize(
    ("place", "wanted"),
    [
        ((40.0, 62.0, -1), (31.586482771, 51.1074062696, -19.7321477863)),
        ((60.0, 50.0, 1), (40.372486051, 52.2109522658, 5.83629763312)),
    ],
)
def test_a_globoid_as_worked_by_hand(place: tuple[float, float, int], wanted: tuple[float, ...]) -> None:
    (theta, rho, side), (r, phi, z) = place, wanted
    flank = Flank(WORKED_GLOBOID, Cycloids(45.0, 120.0), math.radians(-22.5), 8.0, side)
    at = np.array([math.radians(theta)])
    found = flank.along(at, np.array([rho]))
    point = WORKED_GLOBOID.points(found.phi, found.h, found.w)[0]
    assert math.hypot(point[0], point[1]) == pytest.approx(r, abs=1e-9)
    assert math.degrees(found.phi[0]) == pytest.approx(phi, abs=1e-9)
    assert found.z[0] == pytest.approx(z, abs=1e-10)
    assert point[2] == pytest.approx(z, abs=1e-10)
    assert flank.on(at, found.w).rho[0] == pytest.approx(rho, abs=1e-11)
    psi, rate = flank.law.derivatives(at, 1)
    steep = rho * rate[0] / (90.0 - rho * math.cos(psi[0] + flank.start))
    assert math.tan(flank.pressure(at, np.array([rho]))[0]) == pytest.approx(steep, rel=1e-12)


def random_flank(rng: random.Random, form: str) -> tuple[Flank, Any, Indexed]:
    """A flank of a random cam, distances from its rollers' axes, and their motion by the textbook's formulas."""
    stops, over = rng.choice([4, 6, 8]), rng.uniform(140.0, 240.0)
    law, start = rng.choice(sorted(SHARES)), rng.uniform(-0.7, -0.3) * 360.0 / stops
    motion = Indexed([("rise", 360.0 / stops, over, law), ("dwell", 0.0, 360.0 - over, "")], start)
    height = rng.uniform(30.0, 40.0)
    own: Barrel | Globoid
    if form == "barrel":
        side = rng.choice([-1, 1])
        offset = side * rng.uniform(54.0, 60.0)
        own = Barrel(50.0, 12.0, offset, 60.0, side, height, 70.0)
        away = barrel_away(offset, 60.0, side, height)
    else:
        own = Globoid(50.0, 12.0, 95.0, height, 70.0)
        away = globoid_away(95.0, height)
    radius, sense = rng.uniform(5.0, 9.0), rng.choice([-1, 1])
    return Flank(own, law_of(360.0 / stops, over, law), math.radians(start), radius, sense), away, motion


@pytest.mark.slow
@pytest.mark.parametrize("form", ["barrel", "globoid"])
@pytest.mark.parametrize("seed", range(3))
def test_no_roller_comes_nearer_to_a_flank_than_the_one_that_touches_it(form: str, seed: int) -> None:
    rng = random.Random(seed)
    flank, away, motion = random_flank(rng, form)
    for each in (flank, replace(flank, side=-flank.side)):
        demand_regular(each)
        layers = np.array([flank.form.floor, flank.form.blank])
        span = span_of(each, layers).theta
        theta = np.array([rng.uniform(span[0].max(), span[1].min()) for _ in range(12)])
        w = np.array([rng.uniform(*sorted(layers)) for _ in range(12)])
        found = each.on(theta, w)
        points = each.form.points(found.phi, found.h, w)
        assert nearest(away, motion, points, 2) == pytest.approx(flank.radius, abs=1e-9)
        # into the metal they are farther from all rollers, out of it nearer to one
        step = 0.01 * normals(each, theta, found.rho)
        assert nearest(away, motion, points - step, 2) == pytest.approx(flank.radius + 0.01, abs=2e-5)
        assert nearest(away, motion, points + step, 2) == pytest.approx(flank.radius - 0.01, abs=2e-5)


@pytest.mark.thin(2)
@pytest.mark.parametrize("form", ["barrel", "globoid"])
@pytest.mark.parametrize("side", [-1, 1])
def test_a_flank_with_d_below_0_is_cut_away(form: str, side: int) -> None:
    """Up to the largest roller without undercut no position of it cuts into what another leaves, beyond it one does."""
    if form == "barrel":
        flank = Flank(Barrel(50.0, 12.0, 57.0, 60.0, 1, 32.0, 64.0), law_of(60.0, 70.0), math.radians(-30.0), 9.0, side)
        away, motion = barrel_away(57.0, 60.0, 1, 32.0), sharp(60.0, 70.0)
    else:
        flank = Flank(Globoid(50.0, 12.0, 95.0, 30.0, 60.0), law_of(45.0, 75.0), math.radians(-22.5), 9.0, side)
        away, motion = globoid_away(95.0, 30.0), sharp(45.0, 75.0)
    low, high = 2.0, 30.0
    while high - low > 1e-2:
        middle = 0.5 * (low + high)
        low, high = (middle, high) if least_regular(replace(flank, radius=middle))[0] > 0.0 else (low, middle)
    for radius, sound in ((0.99 * low, True), (1.03 * high, False)):
        other = replace(flank, radius=radius)
        _, at, layer = least_regular(other)
        theta = at + np.linspace(-0.02, 0.02, 17)
        found = other.on(theta, layer)
        points = other.form.points(found.phi, found.h, np.full(17, layer))
        gap = float((nearest(away, motion, points, 2) - radius).min())
        if sound:
            demand_regular(other)
            assert gap > -1e-9
        else:
            assert gap < -1e-5
            with pytest.raises(UndercutError, match="is undercut"):
                demand_regular(other)


def normals(flank: Flank, theta: np.ndarray, rho: np.ndarray) -> np.ndarray:
    """Normals (n, 3) of the metal, outwards, at shaft angles theta and distances rho along the roller, (n,)."""
    pose = flank.pose(theta)
    touch = flank.touch(pose, rho)
    x, y, z = flank.form.axes(pose, touch.sine, touch.cosine)[2]
    cosine, sine = np.cos(theta), np.sin(theta)
    return -flank.side * np.column_stack([x * cosine - y * sine, x * sine + y * cosine, z])


def sharp(rise: float, over: float) -> Indexed:
    """Motion of a turret whose rib stands in the middle in its dwell."""
    return Indexed([("rise", rise, over, "polynomial-345"), ("dwell", 0.0, 360.0 - over, "")], -0.5 * rise)


@pytest.mark.parametrize("form", ["barrel", "globoid"])
def test_derivatives_and_d_by_differences(form: str) -> None:
    rng = random.Random(11)
    flank, _, _ = random_flank(rng, form)
    low, high = sorted((flank.form.floor, flank.form.blank))
    theta = np.array([rng.uniform(0.3, 2.0) for _ in range(30)])
    rho = np.array([rng.uniform(low, high) for _ in range(30)])

    def at(t: np.ndarray, r: np.ndarray) -> np.ndarray:
        found = flank.along(t, r)
        return flank.form.points(found.phi, found.h, found.w)

    e = 1e-4
    one, two = (at(theta + e, rho) - at(theta - e, rho)) / (2 * e), (at(theta, rho + e) - at(theta, rho - e)) / (2 * e)
    area = np.linalg.norm(np.cross(one, two), axis=1)
    assert flank.along(theta, rho).regular == pytest.approx(area, rel=1e-6)
    normal = normals(flank, theta, rho)
    assert np.abs(np.sum(normal * one, axis=1)).max() < 1e-5
    assert np.abs(np.sum(normal * two, axis=1)).max() < 1e-7
    twice = (
        (at(theta + e, rho) + at(theta - e, rho) - 2.0 * at(theta, rho)) / e**2,
        (at(theta + e, rho + e) - at(theta + e, rho - e) - at(theta - e, rho + e) + at(theta - e, rho - e))
        / (4.0 * e * e),
        (at(theta, rho + e) + at(theta, rho - e) - 2.0 * at(theta, rho)) / e**2,
    )
    pose = flank.pose(theta)
    found = second_of(flank, pose, rho, flank.touch(pose, rho))
    proved = bends(flank, (theta - 1e-3, theta + 1e-3), (rho - 0.01, rho + 0.01))
    for wanted, given, across, whole in zip(twice, found, proved.across, proved.whole, strict=True):
        length = np.linalg.norm(wanted, axis=1)
        assert np.sqrt(sum(part * part for part in given)) == pytest.approx(length, abs=1e-4)
        assert (np.abs(np.sum(wanted * normal, axis=1)) <= across + 1e-5).all()
        assert (length <= whole + 1e-5).all()
    assert pose_over(flank, (theta, theta)).sine.mid == pytest.approx(pose.sine, abs=1e-12)


@pytest.mark.parametrize("form", ["barrel", "globoid"])
def test_curvature_across_the_line_of_contact_by_positions(form: str) -> None:
    """The gap between roller and flank beside the line of contact, square to it, in the tangent plane."""
    rng = random.Random(5)
    flank, away, motion = random_flank(rng, form)
    theta = np.array([0.9])
    rho = np.array([0.5 * (flank.form.floor + flank.form.blank)])
    found = flank.along(theta, rho)
    point = flank.form.points(found.phi, found.h, found.w)
    normal = normals(flank, theta, rho)
    e = 1e-4
    along = flank.form.points(*flank.along(theta, rho + e)[2:4], flank.along(theta, rho + e).w) - point
    across = np.cross(normal, along / np.linalg.norm(along))
    step, gap = 0.05, []
    for sign in (-1.0, 1.0):
        beside = point + sign * step * across
        high = np.linspace(-0.02, 0.02, 81)[:, None]
        columns = beside + high * normal
        turned = _turned(columns, theta[0])
        roller = away(turned, np.full(len(columns), motion(theta)[0])) - flank.radius
        all_of_them = nearest(away, motion, columns, 1) - flank.radius
        gap.append(np.interp(0.0, -all_of_them, high[:, 0]) - np.interp(0.0, -roller, high[:, 0]))
    # both gaps are square in the step, and of opposite cubes
    measured = 2.0 * abs(float(np.mean(gap))) / step**2
    assert flank.curvature(theta, rho)[0] == pytest.approx(measured, rel=2e-3)


def _turned(points: np.ndarray, by: float) -> np.ndarray:
    x, y, z = points.T
    return np.column_stack([x * math.cos(by) + y * math.sin(by), y * math.cos(by) - x * math.sin(by), z])


def test_layers_at_an_end_face() -> None:
    flank = shared_design(GLOBOID_60).flanks["lower"]
    corners = span_of(flank, np.array([flank.form.floor, flank.form.blank])).theta
    theta = np.linspace(*sorted(corners[1].tolist()), 7)[1:-1]
    w = layers_at(flank, theta, flank.form.length)
    assert flank.on(theta, w).z == pytest.approx(flank.form.length, abs=1e-9)


GLOBOID_60 = """cam:
  kind: indexing
  globoid: {distance: 90, radius: 49}
  depth: 13
  turret: {stops: 8, roller: 8}
  motion: [{rise: 45, over: 120, law: cycloidal}, {dwell: 240}]
part: {length: 60}
"""


def test_a_track_that_leaves_at_the_side() -> None:
    law = law_of(60.0, 150.0)
    flank = Flank(Barrel(50.0, 13.0, 57.0, 60.0, 1, 57.0, 114.0), law, math.radians(-30.0), 9.0, -1)
    with pytest.raises(TrackError, match="does not reach the lower end face"):
        span_of(flank, np.array([37.0]))
    span_of(replace(flank, form=Barrel(50.0, 13.0, 57.0, 60.0, 1, 40.0, 80.0)), np.array([37.0]))


def test_rollers_that_come_back_into_the_cam() -> None:
    told = BarrelTurret(Barrel(50.0, 13.0, 25.0, 25.0, 1, 15.0, 30.0)).fault(4.0, str)
    assert told is not None
    assert "meet the cam on their way back" in told[1]
    assert BarrelTurret(Barrel(50.0, 13.0, 60.0, 60.0, 1, 35.0, 70.0)).fault(4.0, str) is None
