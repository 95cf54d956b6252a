"""Faults planted in meshes of a groove: each is refused, by the check that should find it.

Holds: kin.cylindrical.edges, kin.cylindrical.faces, kin.turned.files, kin.cylindrical.volume, kin.turned.bore.
"""

import math
from pathlib import Path

import numpy as np
import pytest
from capabilities.cylindrical.kin.drums import Drum, Groove, Made, Steps, replace

from kin.cylindrical.judge import judge_mesh
from kin.numeric.limits import Limits
from kin.read.mesh.checked import Triangles, checked

DRUM = Drum(track=Groove(12.5, 0.03))
STEPS = Steps(columns=400, flank=5, floor=16, blank=6, bore=1)
TOLERANCE = 0.012


@pytest.fixture(scope="module")
def made():
    return Made(DRUM, STEPS)


@pytest.fixture(scope="module")
def intent():
    return DRUM.intent()


def judged(places, corners, intent, tolerance=TOLERANCE):
    read = checked(Triangles(places[corners].astype(np.float32), "binary"), Path("drum.stl"))
    return judge_mesh(read, intent, Limits(tolerance))


def refused(verdict):
    """Names of the checks that do not hold, with their surfaces."""
    return {(check.name, check.surface) for check in verdict.checks if not check.ok}


def named(verdict):
    return {name for name, _ in refused(verdict)}


def test_a_sound_drum_is_accepted_with_what_was_measured(made, intent):
    verdict = judged(made.places, made.corners, intent)
    assert verdict.ok, verdict.checks
    assert [flank.name for flank in verdict.flanks] == ["lower", "upper"]
    for flank in verdict.flanks:
        # a chord stands 0.01 out of the flank, which is 0.0133 along z where it is steep
        assert 0.008 < flank.measured_error < 0.0102
        assert flank.measured_error < flank.motion.max < 1.42 * flank.measured_error
        assert 0.0 < flank.motion.remainder < 0.08 * TOLERANCE
    assert 0.03 - 0.027 < verdict.play.least < 0.03 < verdict.play.most < 0.03 * 1.42


def test_a_corner_that_was_moved(made, intent):
    places = made.places
    normal = np.array([0.0, 0.0, 1.0])
    for name, column, row in (("lower", 133, 2), ("upper", 300, 3)):
        moved = places.copy()
        moved[made.number(name, column, row)] += 0.05 * normal
        verdict = judged(moved, made.corners, intent)
        assert ("contour", name) in refused(verdict)
        # metal that the roller meets is found by contact too; a dent is hidden by the rest of the line
        assert (("motion", name) in refused(verdict)) == (name == "lower")


def turned(places, degrees):
    a = math.radians(degrees)
    return places @ np.array([[math.cos(a), math.sin(a), 0.0], [-math.sin(a), math.cos(a), 0.0], [0.0, 0.0, 1.0]])


@pytest.mark.slow  # six whole verdicts
def test_the_whole_at_another_place_size_or_sense(made, intent):
    places, corners = made.places, made.corners
    assert {"blank", "floor", "ends", "contour", "volume"} <= named(judged(1.001 * places, corners, intent))
    both = {(name, side) for name in ("contour", "motion") for side in ("lower", "upper")}
    assert both <= refused(judged(turned(places, 0.1), corners, intent))
    assert both <= refused(judged(places * [1.0, -1.0, 1.0], corners[:, ::-1], intent))
    assert both <= refused(judged(places + np.array([0.0, 0.0, 0.05]), corners, intent))
    larger = replace(DRUM, roller=10.02).intent()
    assert both | {("form-closure", "")} <= refused(judged(places, corners, larger))
    # a drum that is meant to be mirrored is the mirror image of this one
    mirrored = replace(DRUM, mirrored=True)
    assert judged(Made(mirrored, STEPS).places, Made(mirrored, STEPS).corners, mirrored.intent()).ok


def radial(radius):
    """Walls that stand radially, right at one radius."""

    def wall(theta, r, *flank):
        phi, z = DRUM.touched(theta, np.array([radius]), *flank)
        return np.broadcast_to(phi, (len(theta), len(r))), np.broadcast_to(z, (len(theta), len(r)))

    return wall


def offset(theta, r, side, roller, level):
    """The developed path of the roller's axis offset on the blank, and cut radially."""
    a = np.arctan2(DRUM.motion(theta, 1), DRUM.radius)
    phi = theta - side * roller * np.sin(a) / DRUM.radius
    z = level + DRUM.motion(theta) + side * roller * np.cos(a)
    return tuple(np.broadcast_to(row[:, None], (len(theta), len(r))) for row in (phi, z))


def offset_everywhere(theta, r, side, roller, level):
    """The developed path offset on each cylinder by itself."""
    a = np.arctan2(DRUM.motion(theta, 1)[:, None], r)
    lift = level + DRUM.motion(theta)[:, None]
    return theta[:, None] - side * roller * np.sin(a) / r, lift + side * roller * np.cos(a)


def upright(theta, r, side, roller, level):
    """The lift plus and less the roller's radius along the axis."""
    return np.broadcast_to(theta[:, None], (len(theta), len(r))), np.broadcast_to(
        (level + DRUM.motion(theta) + side * roller)[:, None], (len(theta), len(r))
    )


@pytest.mark.parametrize(
    ("wall", "motion"),
    [
        (radial(50.0), 1.51),
        (radial(43.75), 0.81),
        (offset, 1.52),
        (upright, 4.07),
        (offset_everywhere, 0.052),
    ],
    ids=["radial from the outer edge", "radial at the middle", "offset", "along the axis", "offset at each radius"],
)
@pytest.mark.slow  # bounds of what is far off take many parts
def test_wrong_walls(intent, wall, motion):
    made = Made(DRUM, STEPS, wall)
    verdict = judged(made.places, made.corners, intent)
    for flank in verdict.flanks:
        assert {("contour", flank.name), ("motion", flank.name)} <= refused(verdict)
        assert flank.motion.max == pytest.approx(motion, rel=0.02)


def widened(below, by):
    """Walls that are farther apart below a radius."""

    def wall(theta, r, *flank):
        phi, z = DRUM.touched(theta, r, *flank)
        return phi, z + flank[0] * np.where(r < below, by, 0.0)

    return wall


@pytest.mark.slow  # three whole verdicts
def test_what_the_roller_never_meets(intent):
    """A groove too wide beyond the roller's ends, and a floor too shallow or in the roller's way."""
    made = Made(DRUM, replace(STEPS, flank=20), widened(37.9, 0.1))
    verdict = judged(made.places, made.corners, intent)
    assert refused(verdict) == {("contour", "lower"), ("contour", "upper")}
    shallow = Made(replace(DRUM, track=Groove(12.2, 0.03)), STEPS)
    verdict = judged(shallow.places, shallow.corners, intent)
    assert {"floor", "volume"} == named(verdict)
    blocking = Made(replace(DRUM, track=Groove(11.9, 0.03)), STEPS)
    verdict = judged(blocking.places, blocking.corners, intent)
    assert {"floor", "motion"} <= named(verdict)
    (blocked, _) = [check for check in verdict.checks if check.name == "motion"]
    assert "metal stands in the roller's way" in blocked.detail


@pytest.mark.slow
def test_a_triangle_turned_over_or_left_out(made, intent):
    corners = made.corners.copy()
    corners[1000] = corners[1000, ::-1]
    assert "watertight" in named(judged(made.places, corners, intent))
    assert "watertight" in named(judged(made.places, made.corners[1:], intent))
    assert "watertight" in named(judged(made.places, made.corners[:, ::-1], intent))


@pytest.mark.slow  # two whole verdicts
def test_bore_and_ends(made, intent):
    places = made.places
    wider = places.copy()
    bored = np.hypot(places[:, 0], places[:, 1]) < 12.1
    wider[bored, :2] *= 1.002
    assert refused(judged(wider, made.corners, intent)) == {("bore", "")}
    longer = places.copy()
    longer[places[:, 2] > 79.0, 2] += 0.02
    assert "ends" in named(judged(longer, made.corners, intent))


def grooved(theta, side, depth):
    """A ridge (above 0) or a notch (below 0) 0.02 mm wide along the whole line of contact at one angle."""
    half = 0.01 / math.hypot(44.0, DRUM.motion(np.array([theta]), 1)[0])

    def wall(at, r, own, roller, level):
        phi, z = DRUM.touched(at, r, own, roller, level)
        if own == side:
            k = int(np.argmin(np.abs(at - theta)))
            a = np.arctan2(DRUM.motion(at[k : k + 1], 1)[0], r)
            phi[k] -= -own * depth * np.sin(a) / r
            z[k] += -own * depth * np.cos(a)
        return phi, z

    return Made(DRUM, STEPS, wall, [theta - half, theta, theta + half])


@pytest.mark.slow  # dozens of whole verdicts
@pytest.mark.parametrize("part", range(2))
def test_a_ridge_is_found_by_contact_and_a_notch_by_distance(intent, part):
    """0.02 mm wide and 0.02 high, between any two angles."""
    chance = np.random.default_rng(part)
    for _ in range(12):
        theta, side = chance.uniform(0.0, 2.0 * math.pi), int(chance.choice([-1, 1]))
        name = "lower" if side < 0 else "upper"
        ridge, notch = (grooved(theta, side, depth) for depth in (0.02, -0.02))
        assert ("motion", name) in refused(judged(ridge.places, ridge.corners, intent)), math.degrees(theta)
        assert ("contour", name) in refused(judged(notch.places, notch.corners, intent)), math.degrees(theta)
