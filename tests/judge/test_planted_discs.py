"""Spoilt files of disc cams, each with one fault, judged against every follower: contact and contour must tell.

The sound files are fits of curves that know nothing of the judge. A ring is drawn as its opening in a circle.
"""

import numpy as np
import pytest
from support import followers
from support.camfiles import arcs_through, solid_triangles, write_dxf, write_stl
from support.disc_followers import (
    CURVES,
    FOLLOWERS,
    TRAILING,
    chain,
    on_arm,
    on_face,
    on_stem,
    on_swinging_face,
)
from support.discs import DEGREE, M01, M02, M03, M07, M08, TURN, displaced
from support.intent import part_of
from support.outlines import bored
from support.stepfiles import washer

from camgeo.curve.curve import Curve
from camgeo.curve.moving_frame import Oscillating
from camgeo.fit.spline import fit_spline
from camgeo.formats.dxf import write_dxf as drawn_spline
from kin.contour.holes import round_hole
from kin.follower.guide import Line
from kin.follower.roller import GuidedRoller
from kin.judge.intent import Limits
from kin.judge.verify import verify
from kin.law.piecewise import Piecewise
from kin.law.segment import Constant

OUTER = 200.0
LIMITS = Limits(tolerance=1e-4)
DENSE = TURN / 4000 * np.arange(4000)


def intent(follower, **other):
    ring = isinstance(follower, GuidedRoller) and follower.side < 0
    return part_of(follower, outline=OUTER if ring else None, **other)


def drawn(path, points, bulges, follower):
    ring = isinstance(follower, GuidedRoller) and follower.side < 0
    return write_dxf(path, points, bulges, bores=[(0.0, 0.0, 0.5 * OUTER)] if ring else ())


def failures(path, asked):
    return {check.name for check in verify(path, asked, 180, LIMITS).checks if not check.ok}


def rotated(points, degrees):
    c, s = np.cos(degrees * DEGREE), np.sin(degrees * DEGREE)
    return points @ np.array([[c, s], [-s, c]])


@pytest.mark.thin(4)
@pytest.mark.parametrize("name", FOLLOWERS)
def test_a_sound_file_passes(tmp_path, name):
    made, follower = chain(name), FOLLOWERS[name]
    verdict = verify(drawn(tmp_path / "cam.dxf", made.points, made.bulges, follower), intent(follower), 180, LIMITS)
    assert verdict.ok, [check for check in verdict.checks if not check.ok]
    assert verdict.motion.extremes == "true"
    assert verdict.motion.bound <= follower.motion_limit(1e-5)
    assert verdict.pieces == made.count


@pytest.mark.thin(16)
@pytest.mark.parametrize("name", FOLLOWERS)
def test_a_spline_under_every_follower(tmp_path, name):
    follower, path = FOLLOWERS[name], tmp_path / "cam.dxf"
    asked = intent(follower)
    drawn_spline(path, bored(fit_spline(Curve.whole(CURVES[name]), 1e-5), asked.outline))
    verdict = verify(path, asked, 180, LIMITS)
    assert verdict.ok, [check for check in verdict.checks if not check.ok]
    assert verdict.measured_error <= 1e-5 + 1e-8  # the judge's own arcs for a spline count
    assert verdict.motion.max <= follower.motion_limit(1e-5 + 1e-8)


@pytest.mark.slow
def test_a_spline_at_the_edge_of_its_tolerance(tmp_path):
    """What does not hold with coarse arcs for it counted in is judged by fine ones."""
    follower, path = FOLLOWERS["trailing arm"], tmp_path / "cam.dxf"
    drawn_spline(path, bored(fit_spline(Curve.whole(CURVES["trailing arm"]), 1e-4), intent(follower).outline))
    error = verify(path, intent(follower), 180, Limits(1e-8)).measured_error
    for share, ok in ((1.0002, True), (0.9998, False)):
        (check,) = (
            one for one in verify(path, intent(follower), 180, Limits(share * error)).checks if one.name == "contour"
        )
        assert check.ok is ok
        assert check.value == pytest.approx(error, abs=2e-9)


@pytest.mark.slow
@pytest.mark.parametrize("name", FOLLOWERS)
def test_a_file_drawn_wrong_side_up_or_turned_is_caught(tmp_path, name):
    made, follower = chain(name), FOLLOWERS[name]
    mirrored = made.points[::-1] * np.array([1.0, -1.0])
    spoilt = [(rotated(made.points, 0.02), made.bulges)]
    if name != "knife edge":  # its lift is the same either way
        spoilt.append((mirrored, np.roll(made.bulges[::-1], -1)))
    for points, bulges in spoilt:
        caught = failures(drawn(tmp_path / "cam.dxf", points, bulges, follower), intent(follower))
        assert caught >= {"contour", "motion"}


@pytest.mark.thin(32)
@pytest.mark.parametrize("depth", [1e-3, -1e-3])
@pytest.mark.parametrize("name", FOLLOWERS)
def test_an_offset_one_micrometre_too_deep_is_caught(tmp_path, name, depth):
    """The pitch curve is right, the contour lies a micrometre beside it: the wrong radius was taken."""
    follower = FOLLOWERS[name]
    points, bulges = arcs_through(follower.envelope.inset(depth).points(DENSE))
    sound = arcs_through(follower.envelope.points(DENSE))
    path = tmp_path / "cam.dxf"
    assert failures(drawn(path, sound[0], sound[1], follower), intent(follower)) == set()
    assert failures(drawn(path, points, bulges, follower), intent(follower)) >= {"contour", "motion"}


# motions of the shaft read as those of a crank that turns twice as fast
M01_TWICE = displaced(*(2 * [(20, 60, "cycloidal"), (30,), (-20, 60, "polynomial-345"), (30,)]))
M03_TWICE = displaced(*(2 * [(12, 50, "cycloidal"), (20,), (-12, 50, "modified-trapezoid"), (60,)]))
M07_TWICE = displaced(*(2 * [(20, 55, "modified-sine"), (25,), (-20, 60, "cycloidal"), (40,)]), scale=DEGREE)
M08_TWICE = displaced(*(2 * [(10, 60, "cycloidal"), (20,), (-10, 60, "polynomial-345"), (40,)]), scale=DEGREE)

MISTAKEN = {
    "cam for crank degrees, roller": ("roller", on_stem(M01_TWICE, 50.0, 0.0, 10.0)),
    "cam for crank degrees, ring": ("ring", on_stem(M01_TWICE, 50.0, 0.0, 10.0, side=-1)),
    "cam for crank degrees, tilted": ("flat, tilted", on_face(M03_TWICE, 32.0, 8 * DEGREE)),
    "cam for crank degrees, arm": ("trailing arm", on_arm(M07_TWICE, Oscillating.on(42.0, 80.0, 65.0, 1), 8.0)),
    "cam for crank degrees, face": ("trailing face", on_swinging_face(M08_TWICE, 36.0, 90.0, 10.0, 1)),
    "offset on the other side": ("roller, offset", on_stem(M02, 45.0, -10.0, 9.0)),
    "offset on the other side, against": ("roller, offset against", on_stem(M02, 45.0, 10.0, 9.0)),
    "in line for offset": ("roller, offset", on_stem(M02, 45.0, 0.0, 9.0)),
    "leading for trailing": ("leading arm", on_arm(M07, Oscillating.on(42.0, 80.0, 65.0, 1), 8.0)),
    "trailing for leading": ("trailing arm", on_arm(M07, Oscillating.on(42.0, 80.0, 65.0, -1), 8.0)),
    "tilted the other way": ("flat, tilted", on_face(M03, 32.0, -8 * DEGREE)),
    "straight for tilted": ("flat, tilted", on_face(M03, 32.0)),
    "leading face for trailing": ("leading face", on_swinging_face(M08, 36.0, 90.0, 10.0, 1)),
    "trailing face for leading": ("trailing face", on_swinging_face(M08, 36.0, 90.0, 10.0, -1)),
    "face beyond its pivot": ("trailing face", on_swinging_face(M08, 36.0, 90.0, -10.0, 1)),
    "external for a ring": ("roller", on_stem(M01, 50.0, 0.0, 10.0, side=-1)),
    "a ring for external": ("ring", on_stem(M01, 50.0, 0.0, 10.0)),
    "knife edge for a shoe": ("shoe", on_stem(M01, 25.0, 0.0, 0.0)),
}


@pytest.mark.thin(24)
@pytest.mark.parametrize("fault", MISTAKEN)
def test_a_cam_of_another_follower_is_caught(tmp_path, fault):
    name, meant = MISTAKEN[fault]
    made = chain(name)
    assert failures(drawn(tmp_path / "cam.dxf", made.points, made.bulges, meant), intent(meant)) >= {
        "contour",
        "motion",
    }


# --- rings ------------------------------------------------------------------------------------------------------------


def ring_mesh(path, wide=OUTER, count=4000):
    t = TURN / count * np.arange(count)
    outer = 0.5 * wide * np.stack([np.cos(t), np.sin(t)], axis=-1)
    return write_stl(path, solid_triangles(outer, FOLLOWERS["ring"].envelope.points(t), 0.0, 8.0))


@pytest.mark.thin(2)
@pytest.mark.parametrize("mirrored", [False, True])
def test_a_ring_as_a_mesh(tmp_path, mirrored):
    asked = intent(FOLLOWERS["ring"], thickness=8.0, mirrored=mirrored)
    verdict = verify(ring_mesh(tmp_path / "ring.stl"), asked, 90, Limits(1e-3))
    failed = {check.name for check in verdict.checks if not check.ok}
    assert failed == ({"contour", "motion"} if mirrored else set())
    assert {check.name for check in verdict.checks} == {
        *("watertight", "outer", "thickness", "volume", "contour", "motion")
    }


def test_a_ring_of_another_size_or_without_an_opening(tmp_path):
    asked = intent(FOLLOWERS["ring"], thickness=8.0)
    verdict = verify(ring_mesh(tmp_path / "ring.stl", OUTER + 0.02), asked, 90, Limits(1e-3))
    assert {check.name for check in verdict.checks if not check.ok} == {"outer", "volume"}
    made = chain("ring")
    path = write_dxf(tmp_path / "opening.dxf", made.points, made.bulges, bores=())
    (only,) = verify(path, asked, 90, LIMITS).checks
    assert "no opening about the shaft" in only.detail
    beside = write_dxf(tmp_path / "hole.dxf", made.points, made.bulges, bores=[(0, 0, 100.0), (85.0, 0.0, 3.0)])
    assert failures(beside, intent(FOLLOWERS["ring"])) == {"bore"}


def test_a_ring_with_bolt_holes(tmp_path):
    made, places = chain("ring"), [(92.0, 0.0), (0.0, -92.0)]
    holes = tuple(round_hole(f"bolt {k}", "holes", place, 6.0) for k, place in enumerate(places))
    asked = intent(FOLLOWERS["ring"], holes=holes)
    for drawn_at, failed in ((places, set()), (places[:1], {"holes"}), ([(92.0, 0.01), places[1]], {"holes"})):
        bores = [(0.0, 0.0, 0.5 * OUTER), *((x, y, 3.0) for x, y in drawn_at)]
        path = write_dxf(tmp_path / "ring.dxf", made.points, made.bulges, bores=bores)
        assert failures(path, asked) == failed


def test_a_ring_as_a_solid_of_faces(tmp_path):
    """Concentric, so that the follower rests: an opening of radius 6 in a disc of radius 20."""
    path = tmp_path / "ring.step"
    path.write_text(washer(20.0, 6.0, 8.0))
    still = Piecewise(np.array([0.0, TURN]), (Constant(4.0),), TURN, smooth_seam=True)
    follower = followers.roller(Line(), 2.0, still, side=-1)
    for outer, failed in ((40.0, set()), (40.002, {"outer", "volume"})):
        verdict = verify(path, part_of(follower, outline=outer, thickness=8.0), 30, LIMITS)
        assert {check.name for check in verdict.checks if not check.ok} == failed


@pytest.mark.slow
def test_the_side_of_an_arm_is_not_lost_in_the_ring(tmp_path):
    """A trailing arm in a ring, and its own opening of arcs through points of the exact contour."""
    trailing, leading = (on_arm(M07, Oscillating.on(42.0, 80.0, 65.0, side), 8.0, side=-1) for side in (1, -1))
    assert trailing.contacts[0].guide.side == TRAILING
    points, bulges = arcs_through(trailing.envelope.points(DENSE))
    path = drawn(tmp_path / "ring.dxf", points, bulges, trailing)
    assert failures(path, intent(trailing)) == set()
    assert failures(path, intent(leading)) >= {"contour", "motion"}
