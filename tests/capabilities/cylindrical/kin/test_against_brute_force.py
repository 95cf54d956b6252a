"""Drums by chance, judged, against brute force that knows positions alone: the least distance from all axes of the
roller, and the roller held by points on the file's triangles.

Holds: kin.cylindrical.contact, kin.cylindrical.grid, kin.cylindrical.torn_edges, kin.cylindrical.within.
"""

from pathlib import Path

import numpy as np
import pytest
from capabilities.cylindrical.kin.drums import (
    KINDS,
    Drum,
    Groove,
    Made,
    Motion,
    Steps,
    distances,
    enveloped,
    on_flanks,
    on_triangles,
    random_drum,
    replace,
    resting,
)

from kin.cylindrical.gauge import gauges_of
from kin.cylindrical.judge import judge_mesh
from kin.cylindrical.lifts import Lifts
from kin.cylindrical.volume import volume_within
from kin.numeric.limits import Limits
from kin.read.mesh.checked import Triangles, checked

SEED = 20


def read(made, path="drum.stl"):
    return checked(Triangles(made.places[made.corners].astype(np.float32), "binary"), Path(path))


@pytest.mark.slow  # each drum with thousands of points by brute force
@pytest.mark.parametrize("number", range(0, 30, 5))
def test_random_drums(number):
    chance = np.random.default_rng([SEED, number])
    kind = KINDS[number % len(KINDS)]
    drum, size = random_drum(chance, kind)
    if kind == "undercut":
        made = Made(drum, Steps(1200, 14, 12, 5, 4), enveloped(drum))
        tolerance = 0.35 * size
    else:
        made = Made(drum, Steps(480, 6, 20, 8, 8))
        tolerance = 0.1 * size
    mesh = read(made)
    verdict = judge_mesh(mesh, drum.intent(), Limits(tolerance))
    assert verdict.ok, [check for check in verdict.checks if not check.ok]
    for flank, own in zip(verdict.flanks, drum.flanks, strict=True):
        edges, within = on_triangles(made, flank.name, chance, 2000)
        rounding = 4.0 * mesh.rounding
        # no point is farther off than the verdict says, and along the edges some are nearly so
        off = np.abs(distances(drum, np.concatenate([within, edges[chance.choice(len(edges), 3000)]]), own)[0])
        assert off.max() <= flank.measured_error + rounding + 0.1 * tolerance
        if kind != "undercut":
            assert off.max() >= 0.7 * flank.measured_error
        theta = np.append(chance.uniform(0.0, 2.0 * np.pi, 12), np.radians(flank.motion.at))
        held = resting(drum, np.concatenate([edges, within]), theta, own)
        motion = flank.motion
        assert held.max() <= motion.bound + rounding
        assert held.min() >= -motion.bound - rounding - 0.05 * tolerance  # points leave the edges between them out
        assert abs(held[-1]) == pytest.approx(motion.max, abs=0.08 * tolerance + rounding)


@pytest.mark.slow  # every point of a mesh is looked at
@pytest.mark.parametrize("track", [Groove(12.5, 0.05)])
def test_the_roller_set_down_in_closed_form(track):
    drum = Drum(track=track)
    made = Made(drum, Steps(240, 4, 8, 4, 2))
    theta = np.array([0.1, 0.9, 1.0, 2.5, 4.2, 6.2])
    found = on_flanks(read(made), drum.intent(), theta)
    names = np.array(made.names * len(made.theta))
    for gives, (name, side, _, level) in zip(found, drum.flanks, strict=True):
        own = (names[made.corners] == name).any(axis=1)
        triangles = made.places[made.corners[own]]
        a, b = triangles, np.roll(triangles, -1, axis=1)
        points = (a + np.linspace(0.0, 1.0, 400)[:, None, None, None] * (b - a)).reshape(-1, 3)
        held = resting(replace(drum, track=Groove(12.5)), points, theta, (name, side, drum.roller, level))
        np.testing.assert_allclose(gives, held, atol=2e-4)


SHARP = Motion(((15.0, 60.0, "cycloidal"), (0.0, 120.0, ""), (-15.0, 60.0, "harmonic"), (0.0, 120.0, "")))


@pytest.mark.parametrize(
    "drum",
    [Drum(track=Groove(12.5, 0.2)), Drum(SHARP, 12.0, 22.0, 40.0, 30.0, Groove(18.5), 40.0, 60.0, 8.0)],
    ids=["regular", "undercut"],
)
def test_points_at_their_worst_angles(drum):
    chance = np.random.default_rng(1)
    phi, r = chance.uniform(0.0, 2.0 * np.pi, 300), chance.uniform(drum.floor, drum.radius, 300)
    for gauge, flank in zip(gauges_of(drum.intent()), drum.flanks, strict=True):
        points = np.stack([r * np.cos(phi), r * np.sin(phi), np.zeros_like(r)], axis=-1)
        worst = gauge.worst(points)
        np.testing.assert_allclose(worst.height, distances(drum, points, flank)[1], rtol=0.0, atol=1e-9)
        # close to the flank the distance is known as well
        points[:, 2] += gauge.side * (worst.height - chance.uniform(-0.02, 0.02, 300))
        near = gauge.worst(points)
        away = distances(drum, points, flank)[0]
        assert (near.distance >= away - 1e-8).all()
        alike = np.abs(near.distance - away) < 1e-8
        assert alike.mean() > (0.95 if drum.motion is SHARP else 0.999)


def test_the_lift_as_cubics():
    motion = Drum().motion
    lifts = Lifts(motion.law)
    theta = np.random.default_rng(0).uniform(-7.0, 14.0, 1000)
    lift, slope, bend = lifts.at(theta)
    np.testing.assert_allclose(lift, motion(theta), rtol=0.0, atol=1e-9)
    np.testing.assert_allclose(slope, motion(theta, 1), rtol=0.0, atol=1e-6)
    np.testing.assert_allclose(bend, motion(theta, 2), rtol=0.0, atol=0.05)
    steep = np.abs(motion(np.linspace(0.0, 7.0, 10_001), 1)).max()
    assert steep <= lifts.steepest <= 1.001 * steep
    bends = motion(np.linspace(0.0, 2.0 * np.pi, 20_001), 2)
    for side in (-1, 1):
        assert (side * bends).max() <= lifts.bends(side).max() <= 1.01 * (side * bends).max()


@pytest.mark.parametrize("kind", ["groove", "rib", "bottom", "hub"])
def test_the_volume_is_that_of_ever_finer_meshes(kind):
    drum, _ = random_drum(np.random.default_rng(3), kind)
    exact, _ = volume_within(drum.intent(), gauges_of(drum.intent()))
    coarse, fine = (
        read(Made(drum, Steps(columns, 4 * scale, 12 * scale, 6 * scale, 6 * scale))).mesh.volume
        for scale, columns in ((1, 240), (2, 480))
    )
    # what a mesh lacks falls as the square of its steps
    assert (4.0 * fine - coarse) / 3.0 == pytest.approx(exact, rel=2e-6)
