"""Files of drums: the same solid saved anew, subdivided, simplified or with split corners is accepted.

Holds: kin.cylindrical.judge, kin.read.mesh.split.
"""

import math
from pathlib import Path

import numpy as np
import pytest
from capabilities.cylindrical.kin.drums import Drum, End, Groove, Made, Motion, Rib, Steps, binary, replace
from support.meshfiles import in_3mf, text

from kin.contour.holes import Hole
from kin.cylindrical.judge import judge_mesh, verify
from kin.numeric.limits import Limits
from kin.read.mesh.checked import Triangles, checked

DRUM = Drum(
    Motion(((12.0, 150.0, "cycloidal"), (0.0, 40.0, ""), (-12.0, 120.0, "polynomial-345"), (0.0, 50.0, ""))),
    6.0, 21.0, 29.0, 16.0, Groove(9.5), 30.0, 44.0, 8.0,
)  # fmt: skip
STEPS = Steps(240, 4, 12, 5, 3)
LIMITS = Limits(0.03)


@pytest.fixture(scope="module")
def made():
    return Made(DRUM, STEPS)


@pytest.fixture
def stl(tmp_path, made):
    path = tmp_path / "drum.stl"
    path.write_bytes(binary(made.places, made.corners))
    return path


def words(verdict):
    return [(check.name, check.surface, check.detail) for check in verdict.checks if not check.ok]


def test_a_file_is_judged_and_named(stl):
    verdict = verify(stl, DRUM.intent(), LIMITS)
    assert verdict.ok, words(verdict)
    assert (verdict.kind, verdict.units) == ("stl", 1.0)
    assert {check.file for check in verdict.checks} == {"drum.stl"}
    expected = ["watertight", "blank", "floor", "ends", "bore", *["contour", "motion"] * 2, "form-closure", "volume"]
    assert [check.name for check in verdict.checks] == expected
    # without a clearance what flanks within the tolerance may pinch is permitted, and told
    assert verdict.play.least < 0.0
    (closure,) = [check for check in verdict.checks if check.name == "form-closure"]
    assert "it is pinched by up to" in closure.detail
    assert closure.value <= closure.limit == pytest.approx(2.0 * LIMITS.tolerance * steepness(), rel=1e-4)


def steepness():
    steep = np.abs(DRUM.motion(np.linspace(0.0, 2.0 * math.pi, 100_001), 1)).max()
    return math.hypot(1.0, steep / DRUM.inner)


def test_a_limit_that_is_given(stl):
    (motion, _) = [check for check in verify(stl, DRUM.intent(), LIMITS).checks if check.name == "motion"]
    bound = motion.value
    assert verify(stl, DRUM.intent(), Limits(0.03, motion=1.2 * bound)).ok
    short = verify(stl, DRUM.intent(), Limits(0.03, motion=0.99 * bound, play=0.5 * bound))
    assert {name for name, *_ in words(short)} == {"motion", "form-closure"}


def test_what_cannot_be_read(tmp_path, stl):
    cut = tmp_path / "cut.stl"
    cut.write_bytes(stl.read_bytes()[:-20])
    (check,) = verify(cut, DRUM.intent(), LIMITS).checks
    assert (check.name, check.ok, check.file) == ("readable", False, "cut.stl")
    with pytest.raises(ValueError, match="no mesh"):
        verify(tmp_path / "drum.dxf", DRUM.intent(), LIMITS)


@pytest.mark.slow
def test_other_forms_and_units(tmp_path, made):
    triangles = made.places[made.corners]
    for path in (text(tmp_path / "text.stl", triangles), in_3mf(tmp_path / "drum.3mf", triangles)):
        assert verify(path, DRUM.intent(), LIMITS).ok
    inches = tmp_path / "inches.stl"
    inches.write_bytes(binary(made.places / 25.4, made.corners))
    assert verify(inches, DRUM.intent(), LIMITS, 25.4).ok
    assert not verify(inches, DRUM.intent(), LIMITS).ok


def parted(triangles):
    """Each triangle in four, by the middles of its sides."""
    a, b, c = np.moveaxis(triangles, 1, 0)
    ab, bc, ca = 0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a)
    parts = [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
    return np.concatenate([np.stack(part, axis=1) for part in parts])


def judged(triangles, limits=LIMITS, drum=DRUM, **more):
    return judge_mesh(checked(Triangles(triangles, "binary"), Path("drum.stl")), drum.intent(**more), limits)


@pytest.mark.slow  # a mesh four times as large
def test_subdivided_and_in_another_order(made):
    triangles = made.places[made.corners]
    finer = parted(triangles.astype(np.float32).astype(np.float64))
    whole, parts = judged(triangles.astype(np.float32)), judged(finer)
    assert parts.ok, words(parts)
    for one, other in zip(whole.flanks, parts.flanks, strict=True):
        # the surface is the same: what is measured agrees as far as each is proved
        assert other.measured_error == pytest.approx(one.measured_error, rel=0.02)
        assert abs(other.motion.max - one.motion.max) <= one.motion.remainder + other.motion.remainder
    order = np.random.default_rng(0).permutation(len(triangles))
    again = judged(np.roll(triangles[order], 1, axis=1).astype(np.float32))
    assert again.flanks[0].motion.max == pytest.approx(whole.flanks[0].motion.max, abs=1e-9)


@pytest.mark.slow  # a mesh of another library
def test_simplified_within_the_tolerance(made):
    manifold3d = pytest.importorskip("manifold3d")
    mesh = manifold3d.Mesh(made.places.astype(np.float32), made.corners.astype(np.uint32))
    solid = manifold3d.Manifold(mesh).simplify(0.01)
    simple = solid.to_mesh()
    triangles = np.asarray(simple.vert_properties)[:, :3][np.asarray(simple.tri_verts)]
    assert len(triangles) < 0.9 * len(made.corners)
    verdict = judged(triangles.astype(np.float32), Limits(0.1))  # it flips edges of the blank by 0.0925
    assert verdict.ok, words(verdict)


def test_corners_that_a_file_repeats_and_keeps_apart(made):
    """A corner drawn twice at one place is one corner; so is one that is split by less than the tolerance."""
    triangles = made.places[made.corners].astype(np.float32)
    whole = judged(triangles)
    assert whole.ok  # a binary STL repeats every corner
    chance = np.random.default_rng(3)
    split = triangles.copy()
    split[chance.choice(len(split), 400), chance.integers(3, size=400), chance.integers(3, size=400)] += np.float32(
        1e-3
    )
    parted = judged(split)
    assert parted.ok, words(parted)
    (closed,) = [check for check in parted.checks if check.name == "watertight"]
    assert "corners that the file keeps up to 0.0014 mm apart" in closed.detail
    for one, other in zip(whole.flanks, parted.flanks, strict=True):
        assert abs(one.motion.max - other.motion.max) < 2e-3
    split[7, 1] += np.float32(0.04)  # beyond the tolerance
    assert "watertight" in {name for name, *_ in words(judged(split))}
    assert "watertight" in {name for name, *_ in words(judged(triangles[1:]))}


def keyed(radius, width, height):
    """A round bore with a keyway of a width, its floor at a height."""
    y, x = 0.5 * width, math.sqrt(radius**2 - 0.25 * width**2)
    half = math.tan(0.25 * (2.0 * math.pi - 2.0 * math.atan2(y, x)))
    points = ((x, -y), (height, -y), (height, y), (x, y))
    return Hole("the bore with its keyway", "bore", points, (0.0, 0.0, 0.0, half))


@pytest.mark.slow  # eight whole verdicts
def test_ribs_and_ends_and_a_bore_that_is_not_round():
    rib = replace(DRUM, track=Rib(9.5, 20.0), level=22.0, length=56.0)
    hub = replace(DRUM, track=End("top", 9.5))
    for drum in (rib, hub, replace(DRUM, track=End(), bore=17.0), replace(DRUM, track=End("bottom"), bore=17.0)):
        made = Made(drum, replace(STEPS, flank=6, blank=8))
        verdict = judged(made.places[made.corners].astype(np.float32), drum=drum)
        assert verdict.ok, (drum.track, words(verdict))
        assert (verdict.play is None) == (len(drum.flanks) == 1)
        other = judged(
            made.places[made.corners].astype(np.float32), drum=drum, bore=keyed(drum.bore, 3.0, 1.15 * drum.bore)
        )
        assert {"bore"} <= {name for name, *_ in words(other)}


def test_a_flank_that_is_missing(made):
    """A drum without its groove."""
    plain = made.places.copy()
    inside = np.hypot(plain[:, 0], plain[:, 1])
    named = np.array(made.names * len(made.theta))
    groove = np.isin(named, ["lower", "upper", "floor"])
    plain[groove, :2] *= (DRUM.radius / inside[groove])[:, None]
    verdict = judged(plain[made.corners].astype(np.float32))
    assert {"floor", "contour"} <= {name for name, *_ in words(verdict)}
    assert [flank.motion for flank in verdict.flanks] == [None, None]
