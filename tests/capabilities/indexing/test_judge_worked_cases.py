"""The worked cases of indexing cams by positions alone: a roller set down on the exact surface touches it, no deeper.

Holds: kin.indexing.forms, kin.indexing.intent, kin.indexing.motion, kin.indexing.rollers.
"""

import math

import numpy as np
import pytest
from capabilities.indexing.turrets import GLOBOID, TURN, Barrel, Turret, changed

from kin.indexing.motion import Turning
from kin.indexing.rollers import Rollers

WORKED = changed(Turret(), form=Barrel(50.0, 14.0, 60.0, 60.0, 1), length=90.0, height=45.0)
"""c15, its pivot at the height 0 of the digits below."""


def places(*rows):
    """Points (n, 3) by r, phi, deg, and height over the turret's centre."""
    return np.array([(r * math.cos(math.radians(a)), r * math.sin(math.radians(a)), z) for r, a, z in rows])


@pytest.mark.slow
@pytest.mark.parametrize(
    ("turret", "theta", "side", "place"),
    [
        (WORKED, 40.0, -1, (45.1822706308, 53.1360149742, -31.2009649506)),
        (WORKED, 75.0, 1, (36.7129404979, 63.690067526, 5.4)),
        (WORKED, 110.0, 1, (44.0195752172, 111.708771914, 32.1431223568)),
        (GLOBOID, 40.0, -1, (31.586482771, 51.1074062696, -19.7321477863)),
        (GLOBOID, 60.0, 1, (40.372486051, 52.2109522658, 5.83629763312)),
    ],
)
def test_digits_of_the_worked_cases_are_touched_there(turret, theta, side, place):
    rollers, points = Rollers(turret.intent, 1e-6), places(place)
    worst = rollers.worst(points)
    assert abs(worst.excess[0]) < 1e-5
    assert worst.excess[0] + worst.open[0] > -1e-9
    assert abs(math.degrees(worst.theta[0]) % 360.0 - theta) < 0.02
    assert math.copysign(1.0, rollers.at(points, worst.theta).d[0]) == side


@pytest.mark.parametrize("turret", [Turret(), GLOBOID])
@pytest.mark.parametrize("more", [-0.3, 0.01])
def test_what_a_larger_roller_touches_is_so_far_in_the_metal(turret, more):
    rng = np.random.default_rng(7)
    theta, rho = rng.uniform(0.0, TURN, 80), rng.uniform(turret.inner, turret.outer, 80)
    rollers = Rollers(turret.intent, 1e-5)
    for side in (-1, 1):
        points = turret.contact(theta, rho, side, more) - [0.0, 0.0, turret.height]
        points = points[np.abs(points[:, 2]) < turret.height]
        worst = rollers.worst(points)
        distance = rollers.distance(worst.excess, rollers.own(rollers.at(points, worst.theta)))
        np.testing.assert_allclose(distance, more, atol=2e-6)


@pytest.mark.thin(3)
@pytest.mark.parametrize("turret", [Turret(), GLOBOID, changed(Turret(), form=Barrel(50.0, 13.0, -57.0, 60.0, -1))])
def test_the_least_of_many_angles_is_found(turret):
    """Points anywhere in the blank, against all angles of a fine grid on the turret's side."""
    rng = np.random.default_rng(20)
    count = 200
    low, high = turret.intent.ends
    z, phi = rng.uniform(low, high, count), rng.uniform(0.0, TURN, count)
    depths = rng.uniform(0.0, 13.0, count)
    r = np.array([turret.form.rims(depth, np.array([at]))[0] for depth, at in zip(depths, z, strict=True)])
    points = np.stack([r * np.cos(phi), r * np.sin(phi), z], axis=-1)
    rollers = Rollers(turret.intent, 1e-3)
    worst = rollers.worst(points)
    least = np.full(count, np.inf)
    pitch = TURN / turret.stops
    for theta in np.arange(0.0, TURN, TURN / 3600):
        x, y = (r * f(phi - theta) for f in (np.cos, np.sin))
        psi = turret.psi(np.array([theta]))[0]
        for k in range(turret.stops):
            at = psi + k * pitch
            if turret.globoid:
                along = (90.0 - x) * math.cos(at) + z * math.sin(at)
                square = y**2 + ((90.0 - x) * math.sin(at) - z * math.cos(at)) ** 2
                square[along <= 0.0] = np.inf
            else:
                s, l = turret.form.sense, turret.form.pitch
                square = (y - turret.form.offset + s * l * math.cos(at)) ** 2 + (z - l * math.sin(at)) ** 2
            square[x <= 0.0] = np.inf
            least = np.minimum(least, square - turret.roller**2)
    near = least < rollers.reached
    assert near.sum() > 0.4 * count
    assert (worst.excess[near] - worst.open[near] <= least[near] + 1e-9).all()
    assert (worst.excess[near] <= least[near] + 1e-3).all()
    assert (worst.excess[near] >= least[near] - 0.01).all()  # the grid here is coarser than the search
    assert (worst.excess[~near] >= rollers.reached - 0.01).all()


@pytest.mark.parametrize("turret", [Turret(), GLOBOID])
def test_an_edge_is_as_deep_as_its_worst_place(turret):
    rng = np.random.default_rng(3)
    theta, rho = rng.uniform(0.0, TURN, 60), rng.uniform(turret.inner + 1.0, turret.outer - 1.0, 60)
    start = turret.contact(theta, rho, -1) - [0.0, 0.0, turret.height]
    last = turret.contact(theta + 0.02, rho + rng.uniform(-3.0, 3.0, 60), -1) - [0.0, 0.0, turret.height]
    within = np.abs(start[:, 2]) < turret.height
    start, last = start[within], last[within]
    rollers = Rollers(turret.intent, 1e-3)
    found = rollers.edges(start, last, (rollers.worst(start), rollers.worst(last)))
    share = np.linspace(0.0, 1.0, 41)
    between = start[:, None] + share[:, None] * (last - start)[:, None]
    least = rollers.worst(between.reshape(-1, 3)).excess.reshape(-1, 41).min(axis=1)
    assert (found.excess <= least + 1e-9).all()
    assert (found.excess - found.open >= least - 2e-3).all()


@pytest.mark.parametrize("clearance", [-1.2, 0.25])
def test_an_edge_from_one_half_of_a_roller_to_the_other_is_held_against_both(clearance):
    """Edges of a steep flank pass from above the axis to below it: the larger half is nowhere in their way.

    Each place of an edge is held against the half that it is on, at all angles of a grid, by distances alone.
    """
    turret = changed(Turret(), clearance=clearance, length=80.0, height=40.0)
    side, more = (1, clearance) if clearance < 0.0 else (-1, 0.0)  # the flank of the smaller roller
    theta = np.radians(np.arange(0.0, 150.0, 2.0))
    start, last = (turret.contact(theta + by, np.full(75, 37.5), side, more) for by in (0.0, 0.04))
    start, last = start - [0.0, 0.0, 40.0], last - [0.0, 0.0, 40.0]
    within = (np.abs(start[:, 2]) < 40.0) & (np.abs(last[:, 2]) < 40.0)
    start, last = start[within], last[within]
    rollers = Rollers(turret.intent, 1e-3)
    found = rollers.edges(start, last, (rollers.worst(start), rollers.worst(last))).excess
    places = (start[:, None] + np.linspace(0.0, 1.0, 21)[:, None] * (last - start)[:, None]).reshape(-1, 3)
    least = np.full(len(places), np.inf)
    offset, pitch = turret.form.offset, turret.form.pitch
    for angle in np.arange(0.0, TURN, TURN / 1800):
        x = places[:, 0] * math.cos(angle) + places[:, 1] * math.sin(angle)
        y = places[:, 1] * math.cos(angle) - places[:, 0] * math.sin(angle)
        for k in range(turret.stops):
            psi = float(turret.psi(np.array([angle]))[0]) + k * TURN / turret.stops
            if math.cos(psi) < 0.0:  # behind the turret's axis, or more than a radius beyond an end of the cam
                continue
            right, up = offset - y - pitch * math.cos(psi), places[:, 2] - pitch * math.sin(psi)
            above = up * math.cos(psi) - right * math.sin(psi) > 0.0
            square = right**2 + up**2 - np.where(above, turret.roller + clearance, turret.roller) ** 2
            least = np.minimum(least, np.where(x > 0.0, square, np.inf))
    np.testing.assert_allclose(found, least.reshape(-1, 21).min(axis=1), atol=0.05)


def test_the_turret_goes_one_place_on_in_a_turn():
    turret = Turret()
    turning = Turning(turret.intent.law, turret.start)
    theta = np.linspace(0.0, TURN - 1e-9, 1001)
    angle, slope = turning.at(theta)
    np.testing.assert_allclose(angle, turret.psi(theta), atol=1e-11)
    np.testing.assert_allclose(slope, turret.psi(theta, 1), atol=1e-8)
    most, bend = turning.fastest
    assert most.max() == pytest.approx(2.0 * (math.pi / 3.0) / math.radians(150.0), rel=0.01)
    assert bend.max() == pytest.approx(TURN * (math.pi / 3.0) / math.radians(150.0) ** 2, rel=0.03)


@pytest.mark.parametrize(
    ("how", "why"),
    [
        ({"roller": 31.0}, "overlap"),
        ({"form": GLOBOID.form, "stops": 8, "roller": 20.0}, "overlap"),
        ({"form": GLOBOID.form, "stops": 8, "length": 120.0}, "longer than its throat"),
    ],
)
def test_a_turret_that_cannot_be(how, why):
    with pytest.raises(ValueError, match=why):
        _ = changed(Turret(), **how).intent
