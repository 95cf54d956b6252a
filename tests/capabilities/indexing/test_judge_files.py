"""Solids of indexing cams: sound ones are accepted however they are saved, planted faults are refused.

Holds: kin.indexing.contour, kin.indexing.faces, kin.indexing.holding, kin.indexing.judge, kin.turned.verdict,
kin.indexing.volume.
"""

import functools
import math
from pathlib import Path

import manifold3d
import numpy as np
import pytest
from capabilities.indexing.turrets import GLOBOID, Barrel, Turret, changed, made, solid, written

from kin.indexing.faces import Body
from kin.indexing.judge import judge_mesh, pushed_by, verify
from kin.indexing.rollers import Rollers
from kin.indexing.volume import exact_volume
from kin.numeric.limits import Limits
from kin.read.mesh.checked import Triangles, checked

TOLERANCE = 0.02
STEPS = {"step": 0.015, "strips": 3, "across": 12, "segments": 360}
BARREL = Turret()
LEADING = changed(BARREL, form=Barrel(50.0, 13.0, -57.0, 60.0, -1))
PLAY = changed(BARREL, clearance=0.05)
PRELOAD = changed(GLOBOID, clearance=-0.03)
MIRRORED = changed(BARREL, mirrored=True)
EIGHT = changed(BARREL, stops=8, start=0.3, over=2.0, roller=6.0, length=66.0, height=30.0)
FORMS = pytest.mark.parametrize("turret", [BARREL, GLOBOID])


@functools.cache
def mesh(turret) -> tuple[np.ndarray, np.ndarray]:
    return made(turret, **STEPS)


def judged(points, corners, intent, tolerance=TOLERANCE, **limits):
    read = checked(Triangles(points[corners].astype(np.float32), "binary"), Path("cam.stl"))
    return judge_mesh(read, intent, Limits(tolerance, **limits))


@functools.cache
def of_the_sound(turret):
    """Verdict on the sound mesh of a turret."""
    return judged(*mesh(turret), turret.intent)


def refused(verdict):
    """Names of the checks that do not hold."""
    return {check.name for check in verdict.checks if not check.ok}


@pytest.mark.slow
@pytest.mark.parametrize("turret", [BARREL, LEADING, MIRRORED, GLOBOID, PRELOAD, EIGHT, PLAY])
def test_a_sound_cam_is_accepted(turret):
    verdict = of_the_sound(turret)
    assert verdict.ok, [check for check in verdict.checks if not check.ok]
    assert [check.name for check in verdict.checks] == [
        *("watertight", "blank", "floor", "ends", "bore", "contour", "motion", "contour", "motion"),
        *("form-closure", "volume"),
    ]
    for flank in verdict.flanks:
        assert 0.002 < flank.measured_error <= TOLERANCE
        assert flank.motion.remainder < 0.005
    # chords stand out of the flanks: what is left between them is less than the clearance
    lever = 60.0 if not turret.globoid else 50.0
    play = turret.clearance / lever * 180.0 / math.pi
    steep = math.degrees(TOLERANCE / lever) * 4.0
    assert play - steep < verdict.play.least < verdict.play.most < 2.2 * max(play, 0.0) + steep


@FORMS
def test_errors_are_those_of_the_chords(turret):
    """Corners lie on the exact flank: chords push the turret out of its place more than they let it in."""
    for flank in of_the_sound(turret).flanks:
        assert 0.0 < -flank.motion.least < 0.7 * flank.motion.most


@pytest.mark.slow
@FORMS
def test_sound_savings_are_accepted(turret, tmp_path):
    points, corners = mesh(turret)
    whole = solid(points, corners)
    finer, coarser = whole.refine(2), whole.simplify(0.002)
    for name, body in (("finer", finer), ("coarser", coarser)):
        found = body.to_mesh64()
        places, triangles = np.array(found.vert_properties)[:, :3], np.array(found.tri_verts).astype(np.int64)
        assert len(triangles) != len(corners)
        path = written(tmp_path / f"{name}.ply", places, triangles)
        verdict = verify(path, turret.intent, Limits(TOLERANCE))
        assert verdict.ok, [check for check in verdict.checks if not check.ok]
    rng = np.random.default_rng(5)
    order = rng.permutation(len(corners))
    turned = np.array(
        [np.roll(row, by) for row, by in zip(corners[order], rng.integers(0, 3, len(order)), strict=True)]
    )
    path = written(tmp_path / "shuffled.stl", points, turned)
    verdict = verify(path, turret.intent, Limits(TOLERANCE))
    assert verdict.ok, [check for check in verdict.checks if not check.ok]
    assert verdict.kind == "stl"
    assert {check.file for check in verdict.checks} == {"shuffled.stl"}


def on_flank(turret, points):
    """Numbers of corners on flanks, well within them."""
    within = np.zeros(len(points), dtype=bool)
    depth, z = turret.depth(points), points[:, 2]
    within = (depth > 4.0) & (depth < 9.0) & (z > 15.0) & (z < turret.length - 15.0)
    return np.flatnonzero(within)


@pytest.mark.slow
@FORMS
def test_a_corner_that_was_moved(turret):
    points, corners = mesh(turret)
    rng = np.random.default_rng(11)
    for sign in (1.0, -1.0, 1.0):
        k = rng.choice(on_flank(turret, points))
        own = corners[(corners == k).any(axis=1)]
        normal = np.cross(points[own[:, 1]] - points[own[:, 0]], points[own[:, 2]] - points[own[:, 0]]).sum(axis=0)
        places = points.copy()
        places[k] += sign * 0.05 * normal / np.linalg.norm(normal)
        assert "contour" in refused(judged(places, corners, turret.intent))


def turned(points, angle):
    cosine, sine = math.cos(angle), math.sin(angle)
    return points @ np.array([[cosine, sine, 0.0], [-sine, cosine, 0.0], [0.0, 0.0, 1.0]])


FAULTS = {
    "mirrored": (lambda p, c: (p * [1.0, -1.0, 1.0], c[:, ::-1]), {"contour"}),
    "upside down": (lambda p, c: (p * [1.0, -1.0, -1.0] + [0.0, 0.0, 70.0], c), {"contour"}),
    "scaled": (lambda p, c: (1.001 * p, c), {"contour", "blank"}),
    "turned": (lambda p, c: (turned(p, math.radians(0.1)), c), {"contour"}),
    "raised": (lambda p, c: (p + np.array([0.0, 0.0, 0.03]), c), {"contour", "ends"}),
    "inside out": (lambda p, c: (p, c[:, ::-1]), {"watertight"}),
    "open": (lambda p, c: (p, c[1:]), {"watertight"}),
}


@pytest.mark.slow
@pytest.mark.parametrize("fault", FAULTS)
def test_a_fault_of_the_whole(fault):
    how, names = FAULTS[fault]
    points, corners = how(*mesh(BARREL))
    assert names <= refused(judged(points, corners, BARREL.intent))


@pytest.mark.thin(8)
@pytest.mark.costly("a verdict for each fault")
@pytest.mark.parametrize(
    ("how", "names"),
    [
        ({"stops": 5}, {"contour", "volume"}),
        ({"roller": 9.03}, {"contour"}),
        ({"start": math.radians(-30.05)}, {"contour", "motion"}),
        ({"over": math.radians(150.5)}, {"contour"}),
        ({"form": Barrel(50.0, 13.0, 57.0, 60.04, 1)}, {"contour"}),
        ({"form": Barrel(50.0, 13.0, 57.2, 60.0, 1)}, {"contour"}),
        ({"form": Barrel(50.0, 13.1, 57.0, 60.0, 1)}, {"floor"}),
        ({"form": Barrel(50.05, 13.05, 57.0, 60.0, 1)}, {"blank"}),
        ({"length": 70.1}, {"ends"}),
        ({"bore": 20.1}, {"bore"}),
        ({"clearance": 0.03}, {"contour"}),
        ({"inner": 36.9}, {"floor"}),
    ],
)
def test_a_file_of_another_cam(how, names):
    """The sound file, judged by an intent that is a little another."""
    assert names <= refused(judged(*mesh(BARREL), changed(BARREL, **how).intent))


def test_a_file_in_another_unit_is_not_divided():
    """At 25.4 times the size nearly all of it is beyond any roller: in parts it takes a minute."""
    points, corners = mesh(BARREL)
    read = checked(Triangles(25.4 * points[corners], "binary"), Path("cam.stl"))
    body = Body.of(read.mesh, BARREL.intent)
    divided = body.divided(BARREL.intent, np.arange(len(corners)), Rollers(BARREL.intent, TOLERANCE).longest)
    assert len(divided.corners) < 2 * len(corners)


def test_a_solid_in_inches_is_refused_with_its_unit(tmp_path):
    points, corners = mesh(BARREL)
    path = written(tmp_path / "cam.stl", points / 25.4, corners)
    (volume,) = (check for check in verify(path, BARREL.intent, Limits(TOLERANCE)).checks if check.name == "volume")
    assert not volume.ok
    assert volume.detail.endswith("; as if drawn in inches and stated as mm: give --units inch")
    assert verify(path, BARREL.intent, Limits(TOLERANCE), units=25.4).ok


@pytest.mark.slow
def test_walls_that_go_straight_to_the_axis():
    points, corners = made(BARREL, radial=True, **STEPS)
    verdict = judged(points, corners, BARREL.intent)
    assert "contour" in refused(verdict)
    assert max(flank.measured_error for flank in verdict.flanks) > 0.5


@pytest.mark.slow
def test_faults_of_the_metal():
    turret = BARREL
    whole = solid(*mesh(turret))
    # the end of the rib is cut off, level; a lump on a flank; a hollow in the other
    box = manifold3d.Manifold.cube([60.0, 60.0, 3.0]).translate([0.0, 0.0, -0.5])
    core = manifold3d.Manifold.cylinder(70.0, 37.0, 37.0, 360)
    for body in (whole - (box - core), whole + ball(turret, -1), whole - ball(turret, 1)):
        found = body.to_mesh64()
        places, triangles = np.array(found.vert_properties)[:, :3], np.array(found.tri_verts).astype(np.int64)
        assert "contour" in refused(judged(places, triangles, turret.intent))


def ball(turret, side):
    """A ball about a place that the roller touches."""
    place = turret.contact(np.array([1.2]), np.array([43.0]), side)[0]
    return manifold3d.Manifold.sphere(0.4, 24).translate(place.tolist())


@pytest.mark.slow
def test_a_lid_over_the_groove():
    """A thin shell about the blank closes the groove, without a corner in a roller's way: the volume tells."""
    tube = manifold3d.Manifold.cylinder(70.0, 50.0, 50.0, 360) - manifold3d.Manifold.cylinder(70.0, 49.9, 49.9, 360)
    found = (solid(*mesh(BARREL)) + tube).to_mesh64()
    places, triangles = np.array(found.vert_properties)[:, :3], np.array(found.tri_verts).astype(np.int64)
    assert {"contour", "volume"} & refused(judged(places, triangles, BARREL.intent))


def lids(turret, points):
    """Sheets of half the tolerance in thickness without a corner in the open, by what they close."""
    thick, (depth, z) = 0.5 * TOLERANCE, (turret.depth(points), points[:, 2])
    mouth = points[(z < 1e-9) & (depth > 4.0) & (depth < 9.0)]
    reach = np.degrees(np.unwrap(np.sort(np.arctan2(mouth[:, 1], mouth[:, 0]))))
    widest = np.diff(reach).argmax()
    one, other = (43.5 * np.array([math.cos(a), math.sin(a)]) for a in np.radians(reach[[widest, widest + 1]]))
    way = other - one
    bar = manifold3d.Manifold.cube([np.hypot(*way) + 4.0, 1.0, thick], center=True)
    bar = bar.rotate([0.0, 0.0, math.degrees(math.atan2(way[1], way[0]))])
    tube = manifold3d.Manifold.cylinder(turret.length, 50.0, 50.0, 720)
    tube -= manifold3d.Manifold.cylinder(turret.length, 50.0 - thick, 50.0 - thick, 720)
    # while the turret rests, two rollers stand at 30 degrees: their track has its edges a radius above and below
    window = manifold3d.Manifold.cube([20.0, 6.0, 20.0], center=True).translate([50.0, 0.0, 65.0 - 60.0 * 0.5])
    window = window.translate([0.0, 0.0, 60.0 - turret.height]).rotate([0.0, 0.0, 255.0])
    return {
        "mouth": bar.translate([*(0.5 * (one + other)).tolist(), 0.5 * thick]),
        "track": tube ^ window.translate([0.0, 0.0, 5.0]),
        "bore": manifold3d.Manifold.cylinder(thick, 0.5 * turret.bore + 2.0, 0.5 * turret.bore + 2.0, 24),
        "beyond": manifold3d.Manifold.cylinder(thick, 60.0, 60.0, 24)
        - manifold3d.Manifold.cylinder(thick, 49.0, 49.0, 24),
    }


@pytest.mark.thin(2)
@pytest.mark.costly("a boolean and a verdict for each lid")
@pytest.mark.parametrize(
    ("place", "name"), [("mouth", "contour"), ("track", "contour"), ("bore", "ends"), ("beyond", "ends")]
)
def test_a_sheet_thinner_than_the_tolerance(place, name):
    """All its corners are on blank, ends and flanks, and its volume is next to nothing: it is in the way still."""
    points, corners = mesh(BARREL)
    found = (solid(points, corners) + lids(BARREL, points)[place]).to_mesh64()
    places, triangles = np.array(found.vert_properties)[:, :3], np.array(found.tri_verts).astype(np.int64)
    assert name in refused(judged(places, triangles, BARREL.intent))


@pytest.mark.slow
def test_a_roller_longer_than_the_track_is_deep():
    """What of it is outside the blank bears nowhere, and is no reason to look there."""
    assert judged(*mesh(BARREL), changed(BARREL, outer=500.0).intent).ok


@pytest.mark.slow
@FORMS
def test_the_volume_is_that_of_many_points(turret):
    """The share of points of the blank that no roller sweeps, by the sweep at many angles."""
    value, remainder = exact_volume(Rollers(turret.intent, 1e-3))
    points, corners = mesh(turret)
    measured = solid(points, corners).volume()
    assert remainder < 2.0
    assert value == pytest.approx(measured, abs=60.0)
    assert abs(value - measured) / measured < 1e-4


@pytest.mark.slow
@pytest.mark.parametrize(("motion", "play", "names"), [(0.004, 0.004, {"motion", "form-closure"}), (0.04, 0.08, set())])
def test_limits_that_are_given_count(motion, play, names):
    found = judged(*mesh(BARREL), BARREL.intent, motion=math.radians(motion), play=math.radians(play))
    assert names <= refused(found)
    assert found.ok == (not names)


def test_what_is_no_solid(tmp_path):
    (tmp_path / "cam.stl").write_bytes(b"solid nothing")
    verdict = verify(tmp_path / "cam.stl", BARREL.intent, Limits(TOLERANCE))
    assert not verdict.ok
    assert verdict.flanks == ()
    with pytest.raises(ValueError, match="cam"):
        verify(tmp_path / "cam.xyz", BARREL.intent, Limits(TOLERANCE))


def test_an_edge_whose_depth_does_not_rise_with_the_angle_is_not_bounded():
    found = pushed_by(np.array([0.2, 0.2, -0.2, 0.0, -0.1]), np.array([4.0, 0.0, 0.0, 0.0, 2.0]))
    assert found.tolist() == [0.05, math.inf, -math.inf, -math.inf, -0.05]
