"""Drums whose roller is a cone, on an arm or beside the axis, judged: against brute force by positions, with faults.

Holds: kin.cylindrical.led_gauge, kin.turned.guide, kin.cylindrical.play.
"""

import functools
import math
from pathlib import Path

import numpy as np
import pytest
from capabilities.cylindrical.kin.drums import (
    LED,
    Arm,
    Drum,
    End,
    Groove,
    Made,
    Motion,
    Rib,
    Steps,
    distances,
    enveloped,
    on_flanks,
    on_triangles,
    random_led,
    replace,
    resting,
)
from capabilities.cylindrical.kin.figures import forces, pressure_angles, rib_thickness, undercut

from kin.cylindrical.development import judged_line
from kin.cylindrical.frame import flank_points
from kin.cylindrical.gauge import gauges_of
from kin.cylindrical.judge import judge_mesh
from kin.cylindrical.play import exact_play
from kin.cylindrical.volume import volume_within
from kin.numeric.limits import Limits
from kin.read.mesh.checked import Triangles, checked
from kin.turned.files import Developed

SEED = 52
SWING = math.radians(30.0)
PARTS = ((SWING, 120.0, "cycloidal"), (0.0, 60.0, ""), (-SWING, 120.0, "polynomial-345"), (0.0, 60.0, ""))
LOW = 80.0 * math.sin(0.5 * SWING)
PLAIN = Drum(track=Groove(12.5, 0.03))
ARM = replace(PLAIN, motion=Motion(PARTS), level=40.0 - LOW, arm=Arm(80.0, 78.0, 40.0, 1))
CONE_ON_ARM = replace(ARM, arm=Arm(80.0, -78.0, 40.0, -1), taper=math.radians(6.0))
BESIDE = replace(PLAIN, offset=-5.0, taper=math.atan(10.0 / 44.0))
RIB = replace(ARM, track=Rib(12.5, 34.0), level=52.0 - LOW, length=104.0, arm=Arm(80.0, 78.0, 52.0, 1))
DRUMS = {"arm": ARM, "cone on an arm": CONE_ON_ARM, "cone beside the axis": BESIDE, "rib on an arm": RIB}
named = pytest.mark.parametrize("drum", DRUMS.values(), ids=DRUMS)


def read(made):
    return checked(Triangles(made.places[made.corners].astype(np.float32), "binary"), Path("drum.stl"))


def judged(places, corners, intent, limits):
    return judge_mesh(
        checked(Triangles(places[corners].astype(np.float32), "binary"), Path("drum.stl")), intent, limits
    )


def refused(verdict):
    return {(check.name, check.surface) for check in verdict.checks if not check.ok}


@named
def test_points_at_their_worst_angles(drum):
    chance = np.random.default_rng(1)
    phi, r = chance.uniform(0.0, 2.0 * np.pi, 100), chance.uniform(drum.floor, drum.radius, 100)
    for gauge, flank in zip(gauges_of(drum.intent()), drum.flanks, strict=True):
        z = gauge.surface(phi, r)
        points = np.stack([r * np.cos(phi), r * np.sin(phi), z], axis=-1)
        away, _ = distances(drum, points, flank)
        np.testing.assert_allclose(away, 0.0, atol=2e-8)
        points[:, 2] += chance.uniform(-0.05, 0.05, 100)
        near, (away, gives) = gauge.worst(points), distances(drum, points, flank)
        np.testing.assert_allclose(near.height / gauge.lever, gives, rtol=0.0, atol=3e-10)
        np.testing.assert_allclose(near.distance, away, rtol=0.0, atol=1e-7)
        assert (near.bend > 0.0).all()


def test_points_that_an_arm_is_too_short_for_hold_nothing():
    phi = np.linspace(0.0, 2.0 * np.pi, 73)
    points = np.stack([50.0 * np.cos(phi), 50.0 * np.sin(phi), np.zeros_like(phi)], axis=-1)
    height = gauges_of(ARM.intent())[0].worst(points).height
    assert (height < -5.0).all()
    assert np.isneginf(height).any()


@pytest.mark.slow  # a whole verdict and points by brute force
@pytest.mark.parametrize("number", range(len(LED)))
def test_random_led_drums(number):
    chance = np.random.default_rng([SEED, number])
    drum, size = random_led(chance, LED[number % len(LED)])
    made, tolerance = Made(drum, Steps(420, 6, 24, 10, 8)), 0.1 * size
    mesh = read(made)
    verdict = judge_mesh(mesh, drum.intent(), Limits(tolerance))
    assert verdict.ok, [check for check in verdict.checks if not check.ok]
    unit = math.radians(1.0) if drum.arm else 1.0
    lever = drum.arm.length if drum.arm else 1.0
    for flank, own in zip(verdict.flanks, drum.flanks, strict=True):
        edges, within = on_triangles(made, flank.name, chance, 600)
        rounding = 4.0 * mesh.rounding
        off = np.abs(distances(drum, np.concatenate([within, edges[chance.choice(len(edges), 1000)]]), own)[0])
        assert off.max() <= flank.measured_error + rounding + 0.1 * tolerance
        assert off.max() >= 0.7 * flank.measured_error
        motion = flank.motion
        assert motion.unit == ("deg" if drum.arm else "mm")
        theta = np.append(chance.uniform(0.0, 2.0 * np.pi, 8), np.radians(motion.at))
        held = resting(drum, np.concatenate([edges, within]), theta, own)
        near = (rounding + 0.05 * tolerance) / lever
        assert held.max() <= unit * motion.bound + near
        assert held.min() >= -unit * motion.bound - 2.0 * near  # points leave the edges between them out
        assert abs(held[-1]) == pytest.approx(unit * motion.max, abs=2.0 * near)


def sharp(stroke):
    return Motion(((stroke, 62.0, "cycloidal"), (0.0, 110.0, ""), (-stroke, 70.0, "cycloidal"), (0.0, 118.0, "")))


CUT = Drum(sharp(15.2), 12.0, 26.0, 40.0, 27.0, Groove(16.0, 0.05), 40.0, 70.0, 10.0, shortened=True)


@pytest.mark.slow  # flanks by brute force, and peaks that are sought by cells
def test_an_undercut_that_is_cut_off():
    drum = replace(CUT, motion=sharp(15.2 / 70.0), arm=Arm(70.0, 69.7, 34.6, 1))
    found = undercut(drum.intent())
    assert drum.floor < found.below < drum.inner + 2.0
    # by positions: nearer to the axis what is touched stands in the way of other rollers
    theta = found.at + np.linspace(-0.2, 0.2, 101)
    stands = []
    for rho in (found.below + 0.05, found.below - 0.5):
        points = flank_points(drum.intent().follower, theta, rho)
        stands.append(-distances(drum, points, drum.flanks[0])[0].min())
    assert stands[0] < 1e-9
    assert stands[1] > 1e-6
    made = Made(drum, Steps(240, 6, 10, 8, 4), enveloped(drum))
    verdict = judge_mesh(read(made), drum.intent(), Limits(0.5))
    assert verdict.ok, refused(verdict)
    # the outer part of the line carries the roller all round
    assert all(flank.motion.max < 0.02 for flank in verdict.flanks)
    for flank, own in zip(verdict.flanks, drum.flanks, strict=True):
        edges, within = on_triangles(made, flank.name, np.random.default_rng(0), 500)
        off = np.abs(distances(drum, np.concatenate([edges[::9], within]), own)[0])
        assert off.max() <= flank.measured_error + 0.05


STEPS, LIMITS = Steps(400, 5, 20, 12, 1), Limits(0.0125)


CUT_BESIDE = replace(
    CUT, motion=sharp(17.0), track=End("bottom", 16.0), offset=-6.88, taper=math.radians(13.3), at=33.0
)
CUT_ON_ARM = replace(CUT, motion=sharp(15.2 / 70.0), arm=Arm(70.0, 69.7, 34.6, 1))


@pytest.mark.parametrize("drum", [CUT_BESIDE, CUT_ON_ARM], ids=["cone beside the axis", "arm"])
def test_peaks_are_sought_where_the_roller_reaches_and_once_each(drum, monkeypatch):
    chance, count = np.random.default_rng(7), 120
    gauge, flank = gauges_of(drum.intent())[0], drum.flanks[0]
    phi, r = chance.uniform(0.0, 2.0 * np.pi, count), chance.uniform(drum.floor, drum.radius, count)
    z = gauge.surface(phi, r) + chance.uniform(-1.0, 0.2, count)
    points = np.stack([r * np.cos(phi), r * np.sin(phi), z], axis=-1)
    looked, climbed = [], []
    risen, climbing = type(gauge)._risen, type(gauge)._climbed
    monkeypatch.setattr(type(gauge), "_risen", lambda *given: looked.append(len(given[1])) or risen(*given))
    monkeypatch.setattr(type(gauge), "_climbed", lambda *given: climbed.append(len(given[1])) or climbing(*given))
    found = gauge.worst(points)
    np.testing.assert_allclose(found.height / gauge.lever, distances(drum, points, flank)[1], rtol=0.0, atol=1e-8)
    many = np.count_nonzero(gauge.least_bend(phi, r) <= 0.0)
    assert many > 20
    assert sum(looked) < 60 * many
    assert sum(climbed) - count < 8 * many


@pytest.fixture(scope="module")
def made():
    return {name: Made(drum, STEPS) for name, drum in DRUMS.items() if drum is not RIB}


def turned(places, angle):
    c, s = math.cos(angle), math.sin(angle)
    return places @ np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])


def moved(made, name):
    places = made.places.copy()
    places[made.number(name, 133, 2)] += np.array([0.0, 0.0, 0.05])
    return places, made.corners


PLANTED = {
    "a corner below": (lambda made: moved(made, "lower"), {("contour", "lower"), ("motion", "lower")}),
    "a corner above": (lambda made: moved(made, "upper"), {("contour", "upper")}),
    "turned": (lambda made: (turned(made.places, math.radians(0.1)), made.corners), {("motion", "lower")}),
    "scaled": (lambda made: (1.001 * made.places, made.corners), {("contour", "upper"), ("blank", ""), ("volume", "")}),
    "mirrored": (lambda made: (made.places * [1.0, -1.0, 1.0], made.corners[:, ::-1]), {("contour", "lower")}),
}


@pytest.mark.slow  # a whole verdict each
@pytest.mark.parametrize("name", ["arm", "cone beside the axis"])
@pytest.mark.parametrize("fault", PLANTED)
def test_faults_in_the_metal(made, name, fault):
    plant, wanted = PLANTED[fault]
    places, corners = plant(made[name])
    assert wanted <= refused(judged(places, corners, DRUMS[name].intent(), LIMITS))


def on_arm(**more):
    return lambda drum: replace(drum, arm=replace(drum.arm, **{key: change(drum.arm) for key, change in more.items()}))


MEANT = {
    "roller": (None, lambda drum: replace(drum, roller=10.02), {("form-closure", "")}),
    "taper": (None, lambda drum: replace(drum, taper=drum.taper + math.radians(0.1)), {("contour", "upper")}),
    "length": ("arm", on_arm(length=lambda arm: arm.length + 0.02), {("contour", "lower")}),
    "pivot aside": ("arm", on_arm(offset=lambda arm: arm.offset + 0.02), {("motion", "lower")}),
    "other side": ("arm", on_arm(side=lambda arm: -arm.side, offset=lambda arm: -arm.offset), {("motion", "lower")}),
    "offset": ("cone beside the axis", lambda drum: replace(drum, offset=drum.offset + 0.02), {("contour", "lower")}),
    "on the other side": ("cone beside the axis", lambda drum: replace(drum, offset=5.0), {("contour", "lower")}),
}


@pytest.mark.slow  # a whole verdict each
@pytest.mark.parametrize("fault", MEANT)
def test_metal_for_another_roller(made, fault):
    name, change, wanted = MEANT[fault]
    for own in (name,) if name else ("arm", "cone beside the axis"):
        verdict = judged(made[own].places, made[own].corners, change(DRUMS[own]).intent(), LIMITS)
        assert wanted <= refused(verdict), own


@pytest.mark.slow  # a whole verdict
def test_a_floor_that_stands_in_the_roller_s_way():
    shallow = replace(ARM, track=Groove(11.9, 0.03))
    verdict = judge_mesh(read(Made(shallow, Steps(200, 3, 14, 8, 1))), ARM.intent(), Limits(0.05))
    assert {"floor", "motion", "volume"} <= {name for name, _ in refused(verdict)}
    blocked = [check for check in verdict.checks if check.name == "motion"]
    assert all("metal stands in the roller's way" in check.detail and check.unit == "deg" for check in blocked)


@functools.cache
def sound(name):
    """Mesh of a drum, as small as it can be judged, and its verdict."""
    mesh = read(Made(DRUMS[name], Steps(160, 3, 16, 10, 2)))
    return mesh, judge_mesh(mesh, DRUMS[name].intent(), Limits(0.15))


@pytest.mark.slow
@pytest.mark.parametrize("name", DRUMS)
def test_a_sound_drum_is_accepted(name):
    drum, (_, verdict) = DRUMS[name], sound(name)
    assert verdict.ok, refused(verdict)
    unit = "deg" if drum.arm else "mm"
    told = [check for check in verdict.checks if check.name in {"motion", "form-closure"}]
    assert {check.unit for check in told} == {flank.motion.unit for flank in verdict.flanks} == {unit}
    assert verdict.play.unit == unit


@pytest.mark.slow
@pytest.mark.parametrize("name", DRUMS)
def test_a_limit_is_kept(name):
    """Limits of an arm are rad, and what is told of it degrees."""
    drum, (mesh, verdict) = DRUMS[name], sound(name)
    most = max(flank.motion.bound for flank in verdict.flanks)
    limit = 0.99 * (math.radians(most) if drum.arm else most)
    failed = [check for check in judge_mesh(mesh, drum.intent(), Limits(0.15, limit)).checks if not check.ok]
    assert {check.name for check in failed} == {"motion"}
    assert failed[0].limit == pytest.approx(0.99 * most)


def test_an_arm_that_stands_beside_the_drum_is_refused():
    drum = replace(ARM, arm=replace(ARM.arm, side=-1))
    (_, check) = judge_mesh(read(Made(ARM, Steps(60, 1, 4, 2, 1))), drum.intent(), LIMITS).checks
    assert check.detail.startswith("the roller reaches")
    with pytest.raises(ValueError, match="does not reach 19"):
        replace(ARM, arm=replace(ARM.arm, length=10.0)).intent().follower.guide()


@pytest.mark.slow
@pytest.mark.parametrize("drum", [BESIDE, ARM, RIB], ids=["cone beside the axis", "arm", "rib on an arm"])
def test_the_volume_is_that_of_ever_finer_meshes(drum):
    exact, _ = volume_within(drum.intent(), gauges_of(drum.intent()))
    coarse, fine = (
        read(Made(drum, Steps(columns, 4 * scale, 12 * scale, 6 * scale, 6 * scale))).mesh.volume
        for scale, columns in ((1, 200), (2, 400))
    )
    assert (4.0 * fine - coarse) / 3.0 == pytest.approx(exact, rel=4e-6)


@pytest.mark.slow  # every point of a mesh is looked at
@pytest.mark.parametrize("name", ["cone on an arm", "rib on an arm"])
def test_a_led_roller_set_down(name):
    drum = DRUMS[name]
    made, theta = Made(drum, Steps(240, 4, 8, 4, 2)), np.array([0.1, 1.0, 2.5, 4.2])
    names = np.array(made.names * len(made.theta))
    found = on_flanks(read(made), drum.intent(), theta)
    for gives, (own, side, _, level) in zip(found, drum.flanks, strict=True):
        triangles = made.places[made.corners[(names[made.corners] == own).any(axis=1)]]
        a, b = triangles, np.roll(triangles, -1, axis=1)
        points = (a + np.linspace(0.0, 1.0, 400)[:, None, None, None] * (b - a)).reshape(-1, 3)
        held = resting(drum, points, theta, (own, side, drum.roller, level))
        np.testing.assert_allclose(gives, held, atol=1e-5)


def test_the_path_of_a_roller_that_an_arm_takes_round_too_fast_is_not_judged():
    fast = replace(ARM, motion=Motion(((SWING, 10.0, "cycloidal"), (0.0, 90.0, ""), (-SWING, 260.0, "cycloidal"))))
    level = np.array([[0.0, 40.0], [2.0 * math.pi * 50.0, 40.0]])
    flank, (check,) = judged_line([level], fast.intent(), Developed("L", 50.0, "pitch"), LIMITS)
    assert not check.ok
    assert check.detail.startswith("the arm takes its roller round as fast")
    assert flank.motion is None


THETA = np.linspace(-0.5, 2.0 * math.pi + 0.5, 2401)


def line_at(drum, name, radius):
    """A flank, or the path of the roller's axis, on a cylinder, unrolled."""
    if name == "pitch":
        y, z = drum.axis(THETA, drum.level)
        return np.stack([radius * (THETA + np.arcsin(y / radius)), z], axis=1)
    flank = next(own for own in drum.flanks if own[0] == name)
    phi, z = drum.touched(THETA, np.array([radius]), *flank[1:])
    return np.stack([radius * phi[:, 0], z[:, 0]], axis=1)


@pytest.mark.costly("lines of four drums")
@named
def test_a_line_is_right_at_its_radius_alone(drum):
    for name in ("lower", "pitch"):
        points, line = line_at(drum, name, 48.0), Developed("L", 48.0, name)
        flank, checks = judged_line([points], drum.intent(), line, Limits(0.01))
        assert all(check.ok for check in checks)
        assert checks[0].detail.startswith("at a radius of")
        assert (checks[1].unit, flank.motion.unit) == (("deg", "deg") if drum.arm else ("mm", "mm"))
        assert flank.measured_error < 1e-4
        _, checks = judged_line([points + np.array([0.0, 0.02])], drum.intent(), line, Limits(0.01))
        assert not any(check.ok for check in checks)
        (elsewhere, _) = judged_line([points * [42.0 / 48.0, 1.0]], drum.intent(), Developed("L", 42.0, name), LIMITS)[
            1
        ]
        assert elsewhere.ok == (name == "pitch" and not (drum.arm or drum.offset))


def test_a_line_that_is_too_high_turns_an_arm():
    """A normal n and the arm's path T give way to a line by n_z/(n.T) of what that is too high, to first order."""
    points, line = line_at(ARM, "lower", 48.0), Developed("L", 48.0, "lower")
    points[:, 1] += 0.02
    motion = judged_line([points], ARM.intent(), line, Limits(0.01))[0].motion
    (y1, z1), psi = ARM.axis(THETA, ARM.level, 1), ARM.motion(THETA) - 0.5 * SWING
    normal = np.arctan2(z1, 48.0 + y1)
    turned = 0.02 * np.cos(normal) / (80.0 * (np.cos(normal) * np.cos(psi) - np.sin(normal) * np.sin(psi)))
    assert math.radians(motion.most) == pytest.approx(turned.max(), rel=2e-3)


def surface(drum, name, phi, radius):
    """Height of a flank by positions alone: the lowest underside, or the highest top, of all rollers there."""
    _, side, roller, level = next(own for own in drum.flanks if own[0] == name)
    theta = phi + np.linspace(-0.6, 0.6, 2_401)
    x, y = radius * np.cos(phi - theta), radius * np.sin(phi - theta)
    y0, z0 = drum.axis(theta, level)
    with np.errstate(invalid="ignore"):
        heights = side * z0 + np.sqrt(drum.size(roller, x) ** 2 - (y - y0) ** 2)
    return side * np.nanmax(heights)


@pytest.mark.costly("the thickness is sought over the turn")
def test_the_thickness_of_a_rib_on_an_arm():
    found = rib_thickness(RIB.intent())
    angles = np.linspace(0.0, 2.0 * math.pi, 73)
    by_positions = [surface(RIB, "lower", phi, 37.5) - surface(RIB, "upper", phi, 37.5) for phi in angles]
    assert found.radius == 37.5
    assert min(by_positions) - 0.1 < found.value <= min(by_positions) + 1e-6
    at = found.at
    near = [
        surface(RIB, "lower", at + x, 37.5) - surface(RIB, "upper", at + x, 37.5) for x in np.linspace(0.0, 0.6, 121)
    ]
    assert found.value == pytest.approx(min(near), abs=1e-3)


@pytest.mark.costly("play is sought across the roller at both of its ends")
def test_play_forces_and_undercut_on_an_arm():
    intent = ARM.intent()
    theta = np.radians([60.0, 150.0])
    play = exact_play(intent, theta)
    # in a dwell the clearance turns the arm by j/(l cos alpha), alpha being the arm's own angle
    assert play[1] == pytest.approx(0.03 / (80.0 * math.cos(0.5 * SWING)), rel=1e-3)
    (_, _, _, level) = ARM.flanks[1]
    assert (
        0.03 / 80.0 < play[0] < 0.03 / (80.0 * math.cos(pressure_angles(intent.follower, 50.0).greatest.value)) * 1.02
    )
    assert level == ARM.level
    force = forces(intent.follower, 1000.0, 38.0)
    steep = max(abs(angle.value) for angle in pressure_angles(intent.follower, 38.0))
    assert force.contact.value == pytest.approx(1000.0 / (80.0 * math.cos(steep)))
    assert force.torque.value == pytest.approx(1000.0 * SWING / math.radians(60.0))
    found = undercut(intent)
    assert (found.below, found.share) == (0.0, 1.0)
