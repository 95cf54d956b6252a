"""Grooves of several turns that cross, made by booleans, judged; faults planted in them, and the crossings themselves.

Holds: kin.cylindrical.crossings, kin.cylindrical.shoe.
"""

from functools import cache
from pathlib import Path

import manifold3d
import numpy as np
import pytest
from capabilities.cylindrical.kin.drums import TURN, Drum, End, Groove, Motion, on_flanks, replace, resting
from capabilities.cylindrical.kin.screws import (
    TWO_AND_ONE,
    cut,
    line,
    outside,
    plain,
    ring,
    screw,
    taken_away,
    union,
)

from kin.cylindrical.crossings import Crossings
from kin.cylindrical.development import judged_line
from kin.cylindrical.gauge import gauges_of
from kin.cylindrical.judge import judge_mesh
from kin.cylindrical.shoe import longest_shoe, shoe_interference
from kin.cylindrical.smooth import BINS, Crossed, Smooth, look
from kin.cylindrical.volume import volume_within
from kin.numeric.limits import Limits
from kin.read.mesh.checked import Triangles, checked
from kin.turned.files import Developed

TOLERANCE = 0.012
SCREW = screw()
SPIRAL = screw(TWO_AND_ONE, shoe=34.5)
CONTACTS = {(name, side) for name in ("contour", "motion") for side in ("lower", "upper")}


def read(places, corners):
    return checked(Triangles(places[corners].astype(np.float32), "binary"), Path("screw.stl"))


def judged(solid, drum, tolerance=TOLERANCE):
    return judge_mesh(read(*solid), drum.intent(), Limits(tolerance))


def refused(verdict):
    """Names of the checks that do not hold, with their surfaces."""
    return {(check.name, check.surface) for check in verdict.checks if not check.ok}


def check_of(verdict, name):
    (found,) = (check for check in verdict.checks if check.name == name)
    return found


@pytest.fixture(scope="module")
def sound():
    return cut(SCREW)


@pytest.fixture(scope="module")
def wide():
    """A sound screw in wider triangles: a chord stands 30 (1 - cos 1 deg) = 0.0046 out."""
    return cut(SCREW, 180, 3, 8)


@pytest.fixture(scope="module")
def of_wide(wide):
    """The verdict on it."""
    return judged(wide, SCREW)


@pytest.fixture(scope="module")
def spiral():
    return cut(SPIRAL)


def walls_of(drum, solid, chance, count):
    """Points (n, 3) by chance on the triangles of a solid that lie between its floor and its blank."""
    places, corners = solid
    triangles = places[corners]
    r = np.hypot(triangles[..., 0], triangles[..., 1])
    level = np.ptp(triangles[..., 2], axis=1) < 1e-6
    own = ~level & (r.min(axis=1) < drum.radius - 0.05) & (r.max(axis=1) > drum.floor + 0.05)
    own &= r.min(axis=1) > drum.floor - 0.05
    chosen = triangles[own][chance.choice(int(own.sum()), count)]
    return np.einsum("nk,nkx->nx", chance.dirichlet(np.full(3, 0.3), count), chosen)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["sound", "spiral"])
def test_a_sound_screw_is_accepted_with_what_was_measured(name, request):
    solid, drum = request.getfixturevalue(name), {"sound": SCREW, "spiral": SPIRAL}[name]
    verdict = judged(solid, drum)
    assert verdict.ok, [check for check in verdict.checks if not check.ok]
    chance = np.random.default_rng(1)
    worst = max(flank.measured_error for flank in verdict.flanks)
    # a chord of a degree stands 30 (1 - cos 0.5 deg) = 0.0011 out
    off = np.abs(outside(drum, walls_of(drum, solid, chance, 2500)))
    assert 0.5 * worst < off.max() < worst + 1e-4
    assert 0.001 < worst < 0.0025


@pytest.mark.slow
@pytest.mark.parametrize("columns", [60, 90])
def test_a_tall_screw_in_wide_triangles_is_accepted(columns):
    """Its ends lie far below turns at the other one, farther than a step of Newton's method is good for."""
    motion = Motion(((60.0, 720.0, "cv-blended"), (-60.0, 360.0, "cv-blended")))
    tall = screw(motion, roller=4.0, inner=25.0, track=Groove(6.0), level=14.0, length=88.0, shoe=22.0)
    solid, tolerance = cut(tall, columns, 5, 10), 30.0 * (1.0 - np.cos(np.pi / columns)) + 0.02
    verdict = judged(solid, tall, tolerance)
    assert verdict.ok, [check for check in verdict.checks if not check.ok]
    off = np.abs(outside(tall, walls_of(tall, solid, np.random.default_rng(3), 500)))
    assert max(flank.measured_error for flank in verdict.flanks) > 0.5 * off.max()


@pytest.mark.slow
def test_the_motion_is_that_of_points_of_the_file_in_every_turn(wide, of_wide):
    verdict = of_wide
    assert verdict.ok, [check for check in verdict.checks if not check.ok]
    chance = np.random.default_rng(2)
    points = walls_of(SCREW, wide, chance, 60_000)
    theta = chance.uniform(0.0, 6.0 * TURN, 30)
    degrees = np.degrees(theta)
    found = on_flanks(read(*wide), SCREW.intent(), theta)
    for flank, own, gives in zip(verdict.flanks, SCREW.flanks, found, strict=True):
        side = own[1]
        free = np.zeros(len(theta), dtype=bool)
        for low, high in flank.free:
            free |= np.remainder(degrees - low, 2160.0) < high - low
        held = resting(SCREW, points, theta, own)
        assert 0.2 < free.mean() < 0.7
        assert np.abs(held[~free]).max() < flank.motion.bound + 0.004  # points by chance leave room between them
        assert np.abs(gives[~free]).max() <= flank.motion.bound + 1e-4
        # in the middle of a crossing nothing carries
        middle = np.radians([0.5 * (low + high) for low, high in flank.free])
        assert resting(SCREW, points, middle, own).max() < -0.3
        # where the judge asks for no motion, another turn has taken the exact line; just beside it, it has not
        for rho in np.linspace(SCREW.inner, 29.9, 4):
            inside = outside(SCREW, line(SCREW, middle, rho, side))
            assert (inside < -0.1).all()
        beside = np.radians([low - 1.5 for low, _ in flank.free])
        rooms = np.max([other_turns(line(SCREW, beside, rho, side), beside) for rho in (SCREW.inner, 29.5)], axis=0)
        assert (rooms > 2.0 * TOLERANCE).all()
        assert (rooms < 0.3).all()


def other_turns(points, theta, drum=SCREW):
    """How far (n,) points of the line at angles (n,) lie outside all turns but their own."""
    phi = np.arctan2(points[:, 1], points[:, 0])
    own = np.round((theta - phi) / TURN).astype(int)
    turns = drum.motion.turns
    each = np.stack([outside(drum, points, [k]) for k in range(-1, turns + 1)])
    for k in range(-1, turns + 1):
        each[k + 1, (k - own) % turns == 0] = np.inf
    return each.min(axis=0)


def test_the_longest_gap_is_that_of_two_helices():
    drum = SCREW.intent()
    gauges = gauges_of(drum)
    crossings = Crossings(drum, gauges, 1e-5)
    for gauge in gauges:
        found = crossings.gaps(gauge, 30.0)
        assert len(found) == 10
        # c14: 2 R/sin 2 alpha along the groove, where both helices have their whole slope
        assert max(gap.length for gap in found) == pytest.approx(47.6544062808, rel=2e-4)
        lower = crossings.gaps(gauge, 23.0)
        slope = 20.0 / TURN / 23.0
        assert max(gap.length for gap in lower) == pytest.approx(5.0 * (1.0 + slope**2) / slope, rel=2e-4)


def test_a_roller_drops_into_a_crossing_and_so_does_a_shoe_that_is_too_short(wide, of_wide):
    alone = judged(wide, replace(SCREW, shoe=None))
    assert refused(alone) == {("crossings", "")}
    assert "the roller drops into the groove" in check_of(alone, "crossings").detail
    for shoe, verdict in ((47.0, judged(wide, replace(SCREW, shoe=47.0))), (60.0, of_wide)):
        assert verdict.ok == (shoe == 60.0)
        crossings = check_of(verdict, "crossings")
        # the file may be off by the tolerance
        assert crossings.value == pytest.approx(47.654 + 2.0 * TOLERANCE / 0.2098, abs=0.02)
        assert crossings.limit == shoe


@pytest.mark.slow
def test_a_shoe_that_just_bridges_its_crossings_is_accepted(wide):
    assert judged(wide, replace(SCREW, shoe=48.5)).ok


# --- planted faults ---------------------------------------------------------------------------------------------------


def far_from_crossings(drum, places):
    """Numbers of corners on a lower flank, which other turns leave far away."""
    r = np.hypot(places[:, 0], places[:, 1])
    near = np.flatnonzero((r > 24.0) & (r < 29.0) & (places[:, 2] > 30.0))[:300]
    near = near[np.abs(outside(drum, places[near])) < 1e-3]
    each = np.sort(np.abs([outside(drum, places[near], [k]) for k in range(drum.motion.turns)]), axis=0)
    return near[each[1] > 1.0]


@pytest.mark.slow
def test_a_corner_that_was_moved(sound):
    places, corners = sound
    number = far_from_crossings(SCREW, places)[10]
    for way in (0.05, -0.05):
        moved = places.copy()
        moved[number, 2] += way
        assert "contour" in {name for name, _ in refused(judged((moved, corners), SCREW))}


@pytest.mark.slow  # five whole verdicts
def test_the_whole_at_another_place_size_or_sense(spiral):
    places, corners = spiral
    assert refused(judged((places * [1.0, -1.0, 1.0], corners[:, ::-1]), SPIRAL)) >= CONTACTS
    assert refused(judged((places + np.array([0.0, 0.0, 0.05]), corners), SPIRAL)) >= CONTACTS
    assert refused(judged(spiral, replace(SPIRAL, roller=5.02))) >= CONTACTS
    other = Motion(((36.1, 720.0, "cv-blended"), (-36.1, 360.0, "cv-blended")))
    assert {("contour", "lower"), ("contour", "upper")} <= refused(judged(spiral, replace(SPIRAL, motion=other)))
    mirrored = replace(SPIRAL, mirrored=True)
    assert judged((places * [1.0, -1.0, 1.0], corners[:, ::-1]), mirrored).ok


@pytest.mark.slow  # three solids
def test_one_turn_at_another_height_too_shallow_or_missing():
    def shifted(theta, r, *flank):
        phi, z = SCREW.touched(theta, r, *flank)
        return phi, z + 0.02 * ((theta > 2.0 * TURN) & (theta < 3.0 * TURN))[:, None]

    assert {("contour", "lower"), ("contour", "upper")} <= refused(judged(cut(SCREW, touched=shifted), SCREW))
    shallow = cut(replace(SCREW, track=Groove(7.3)))
    assert {("floor", ""), ("volume", "")} <= refused(judged(shallow, SCREW))
    missing = [k for k in range(12) if k not in {4, 5}]
    verdict = judged(cut(SCREW, pieces=missing), SCREW)
    assert {("motion", "lower"), ("motion", "upper"), ("volume", "")} <= refused(verdict)


def within(low, high, length):
    """All that lies between two cylinders."""
    outer, inner = (manifold3d.Manifold.cylinder(length, r, r, 360) for r in (high, low))
    return outer - inner


@cache
def fins():
    """What the roller takes, and fins on the walls of the way out, as they would go on into the way back."""
    taken = taken_away(SCREW)
    first, second = union(taken[:6]), union(taken[6:])
    thinner = union(taken_away(replace(SCREW, roller=4.994), pieces=range(6)))
    narrow = union(taken_away(replace(SCREW, roller=4.7), pieces=range(6, 12)))
    return first + second, (first - thinner) ^ (second - narrow)


@pytest.mark.slow  # booleans of whole grooves
@pytest.mark.parametrize("heights", [(22.0, 31.0), (22.0, 22.9)], ids=["whole", "under the pin's end"])
def test_a_wall_left_standing_in_a_crossing(heights):
    """Fins 0.006 thick reach 0.3 into the way back."""
    taken, every = fins()
    left = every ^ within(heights[0], heights[1], SCREW.length)
    assert left.volume() > 1e-3
    verdict = judged(plain(ring(SCREW, 360) - (taken - left)), SCREW)
    assert {("contour", "lower"), ("contour", "upper")} <= refused(verdict)
    assert max(flank.measured_error for flank in verdict.flanks) == pytest.approx(0.3, abs=0.02)
    # the pin's end does not reach down there
    assert (("motion", "lower") in refused(verdict)) == (heights[1] > SCREW.inner)


@pytest.mark.slow  # booleans of whole grooves
def test_a_wall_missing_outside_the_crossings():
    """An island between crossings is gone: floor is all that is left of it, as it is beside it."""
    blank, taken = ring(SCREW, 240), union(taken_away(SCREW, 240, 3, 10))
    land = (blank ^ within(SCREW.floor + 0.005, 40.0, SCREW.length)) - taken  # beyond chords of the floor
    islands = sorted(land.decompose(), key=lambda part: part.volume())
    assert len(islands) > 4
    verdict = judged(plain(blank - union([taken, islands[0]])), SCREW)
    assert {("motion", "lower"), ("motion", "upper")} <= refused(verdict)
    assert any("touches nothing" in check.detail for check in verdict.checks)


# --- developments -----------------------------------------------------------------------------------------------------


def unrolled(name, drum=SCREW, radius=30.0):
    """Points (n, 2) of a line of a development over all turns, and (n,) how far they lie outside the other turns."""
    theta = np.linspace(-0.1, drum.motion.turns * TURN + 0.1, 4001)
    if name == "pitch":
        return np.stack([radius * theta, drum.level + drum.motion(theta)], axis=-1), theta
    (flank,) = (own for own in drum.flanks if own[0] == name)
    phi, z = (rows[:, 0] for rows in drum.touched(theta, np.array([radius]), *flank[1:]))
    points = np.stack([radius * np.cos(phi), radius * np.sin(phi), z], axis=-1)
    return np.stack([radius * phi, z], axis=-1), other_turns(points, phi, drum)


def developed(parts, name, drum=SCREW):
    flank, checks = judged_line(parts, drum.intent(), Developed("L", 30.0, name), Limits(TOLERANCE))
    return flank, {check.name: check for check in checks}


@pytest.mark.parametrize("name", ["lower", "pitch"])
def test_a_line_of_a_development_over_all_turns(name):
    points, room = unrolled(name)
    flank, checks = developed([points], name)
    assert all(check.ok for check in checks.values()), checks
    assert flank.measured_error < 1e-4
    _, checks = developed([points * [1.0, 1.001]], name)
    assert not checks["contour"].ok
    # a turn is missing
    gone = (points[:, 0] < 2.0 * TURN * 30.0) | (points[:, 0] > 3.0 * TURN * 30.0)
    parts = [points[:1600][gone[:1600]], points[1600:][gone[1600:]]]
    assert "the line is missing at x" in developed(parts, name)[1]["contour"].detail
    runs = np.split(np.arange(len(points)), np.flatnonzero(np.diff(room > 0.0)) + 1)
    if name == "pitch":
        assert "missing" in developed([points[:1800], points[1820:]], name)[1]["contour"].detail
        return
    # it may end at crossings, and no earlier
    kept = [points[max(run[0] - 1, 0) : run[-1] + 2] for run in runs if room[run[0]] > 0.0]
    assert len(kept) >= 10
    assert all(check.ok for check in developed(kept, name)[1].values())
    short = [*kept[:4], kept[4][:-5], *kept[5:]]
    assert "missing" in developed(short, name)[1]["contour"].detail


# --- a shoe, the volume, what is not judged ---------------------------------------------------------------------------


def lens(length, radius, count=101):
    """Points (n, 2) of the outline of a shoe that lies along x."""
    arc = (0.25 * length**2 + radius**2) / (2.0 * radius)
    x = np.linspace(-0.5 * length, 0.5 * length, count)
    y = np.sqrt(arc**2 - x**2) - (arc - radius)
    return np.concatenate([np.stack([x, y], axis=-1), np.stack([x, -y], axis=-1)])


@pytest.mark.parametrize(("stroke", "length"), [(30.0, 45.0), (30.0, 60.0), (6.0, 60.0), (12.0, 30.0)])
def test_a_shoe_in_a_bend(stroke, length):
    """Against the distance of its outline from the developed path, at the best angle."""
    motion = Motion(((stroke, 180.0, "harmonic"), (-stroke, 180.0, "harmonic")))
    drum = Drum(motion, roller=5.0, inner=23.0, outer=30.0, track=Groove(7.5), radius=30.0, shoe=length)
    found, at = shoe_interference(drum.intent().follower)
    assert min(at % np.pi, np.pi - at % np.pi) < 0.02  # the sharpest bends of a harmonic are its ends
    theta = np.linspace(-2.0, 2.0, 4001)
    path = np.stack([23.0 * theta, motion(theta)], axis=-1)
    bent = np.inf
    for tilt in np.linspace(-0.04, 0.04, 5):
        turn = np.array([[np.cos(tilt), np.sin(tilt)], [-np.sin(tilt), np.cos(tilt)]])
        outline = lens(length, 5.0) @ turn
        far = max(np.hypot(*(path - point).T).min() for point in outline)
        bent = min(bent, far - 5.0)
    assert bent <= found + 1e-3
    assert (bent > 0.01) == (found > 0.01) or found < 0.3
    if found > 1.0:
        assert bent > 0.5 * found  # along the shoe the bend grows less sharp


def test_a_shoe_that_does_not_pass_a_bend_is_refused():
    verdict = judged(cut(SPIRAL, 180, 3, 8), replace(SPIRAL, shoe=40.0))
    assert refused(verdict) == {("shoe", "")}
    (check,) = (check for check in verdict.checks if check.name == "shoe")
    assert "is within that" in check.detail
    most = longest_shoe(SPIRAL.intent().follower, TOLERANCE)
    interferes = [shoe_interference(replace(SPIRAL, shoe=share * most).intent().follower)[0] for share in (1.0, 1.001)]
    assert interferes[0] == pytest.approx(TOLERANCE, rel=1e-9)
    assert interferes[1] > TOLERANCE


@pytest.mark.slow  # two solids; every verdict on a screw has its volume
def test_the_volume_of_a_crossing_groove_is_that_of_ever_finer_meshes():
    drum = SPIRAL.intent()
    exact, remainder = volume_within(drum, gauges_of(drum))
    coarse, fine = (read(*cut(SPIRAL, 180 * k, 3 * k, 5 * k)).mesh.volume for k in (1, 2))
    assert (4.0 * fine - coarse) / 3.0 == pytest.approx(exact, rel=2e-6)
    assert remainder < 1e-6 * exact


def test_what_several_turns_and_shoes_are_not_judged_for():
    with pytest.raises(ValueError, match="led by a groove"):
        screw(track=End()).intent()
    for more, words in (({"shoe": 9.0}, "not longer than it is wide"), ({"offset": 2.0}, "a shoe is on a slide")):
        with pytest.raises(ValueError, match=words):
            screw(**more).intent()
    with pytest.raises(ValueError, match="a whole number of turns"):
        replace_follower(SCREW, turns=0)


COLUMNS = 64  # of patches, of a turn; a power of 2 as BINS is


def patches(drum, flank, kept, widths=None):
    """A flank as bicubic patches through 4 by 4 exact places each: columns by number, and shares of their width."""
    thirds = np.linspace(0.0, 1.0, 4)
    bernstein = np.stack([(1, 3, 3, 1)[k] * thirds**k * (1.0 - thirds) ** (3 - k) for k in range(4)], axis=1)
    inverse, width = np.linalg.inv(bernstein), TURN / COLUMNS
    nets, lines, about = [], [], []
    for column, share in zip(kept, np.ones(len(kept)) if widths is None else widths, strict=True):
        for k in range(2):
            r = drum.floor + (drum.radius - drum.floor) * (k + thirds) / 2
            phi, z = drum.touched(width * (column + share * thirds), r, *flank[1:])
            places = np.stack([r * np.cos(phi), r * np.sin(phi), z], axis=-1)
            nets.append(np.einsum("ai,bj,ijx->abx", inverse, inverse, places))
            lines.append((k / 2, (k + 1) / 2))
            about.append(width * column)
    return Smooth(np.array(nets), np.array(lines), np.array(about))


def looked_at(drum, surface, flank=0, carried=()):
    """What patches of a flank show where it is to carry in some columns."""
    gauges = gauges_of(drum.intent())

    def carries(radii):
        assert radii.min() > drum.floor - 1e-3
        assert radii.max() < drum.radius + 1e-3
        bins = np.arange(BINS * drum.motion.turns) * COLUMNS // BINS
        return np.isin(bins, carried)

    return look(gauges[flank], [surface], TOLERANCE, 720 * drum.motion.turns, Crossed(gauges, carries))


@pytest.mark.slow
def test_patches_of_a_flank_stand_in_the_way_of_other_turns_where_it_goes_on():
    """Depths within the roller of another turn are those of positions; without such patches there are none."""
    flank, count = SPIRAL.flanks[0], COLUMNS * SPIRAL.motion.turns

    def depth(surface):
        """Depths (n,), mm, of columns in what rollers take, as seen on the corners of their patches."""
        corners = surface.nets[:, [0, 0, 3, 3], [0, 3, 0, 3]].reshape(-1, 3)
        return -outside(SPIRAL, corners).reshape(-1, 8).min(axis=1)

    whole = patches(SPIRAL, flank, range(count))
    own = depth(whole)
    clear = np.flatnonzero(np.maximum(np.maximum(own, np.roll(own, 1)), np.roll(own, -1)) < 1e-3)
    assert 0.2 * count < len(clear) < 0.9 * count
    seen = looked_at(SPIRAL, whole, carried=clear)
    # so deep within a roller it is what stands out at the worst angle
    assert 0.8 * own.max() < seen.proud.value < 1.05 * own.max()
    kept = looked_at(SPIRAL, patches(SPIRAL, flank, clear), carried=clear)
    assert kept.proud.value + kept.proud.remainder < 0.1 * TOLERANCE
    assert kept.least.remainder < TOLERANCE
    assert np.isfinite(kept.holds[kept.carried]).all()
    assert 0.8 * len(clear) < kept.carried.mean() * count < 1.2 * len(clear)
    # a patch that goes on until its outer corner is 0.02 mm within a roller
    first = next(k for k in clear if k + 1 not in clear)
    while depth(patches(SPIRAL, flank, [first]))[0] < 0.02:
        first += 1
    low, high = 0.0, 1.0
    for _ in range(20):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if depth(patches(SPIRAL, flank, [first], [middle]))[0] > 0.02 else (middle, high)
    more = patches(SPIRAL, flank, [*clear, first], [*np.ones(len(clear)), high])
    beyond = looked_at(SPIRAL, more, carried=clear).proud
    assert beyond.value == pytest.approx(0.02, abs=2e-4)
    assert beyond.remainder < 0.1 * TOLERANCE


@pytest.mark.costly("patches over all turns against the rollers of all")
def test_a_wall_that_is_missing_where_it_is_to_carry_leaves_the_roller_loose():
    clear = np.arange(5, 15)
    upper = looked_at(SPIRAL, patches(SPIRAL, SPIRAL.flanks[1], clear), 1, carried=clear)
    assert upper.least.remainder < TOLERANCE
    lost = looked_at(SPIRAL, patches(SPIRAL, SPIRAL.flanks[1], np.delete(clear, 4)), 1, carried=clear)
    assert np.isinf(lost.least.remainder)
    # a turn on nothing carries
    elsewhere = looked_at(SPIRAL, patches(SPIRAL, SPIRAL.flanks[1], clear), 1, carried=clear + COLUMNS)
    assert np.isinf(elsewhere.least.remainder)
    nowhere = looked_at(SPIRAL, patches(SPIRAL, SPIRAL.flanks[1], clear), 1)
    assert not nowhere.carried.any()


def test_a_flank_carries_on_cylinders_beside_crossings():
    """It carries on them where it does anywhere, and on none that its roller does not reach."""
    drum = SPIRAL.intent()
    gauge = gauges_of(drum)[0]
    crossings, count = Crossings(drum, gauges_of(drum), TOLERANCE), 360 * SPIRAL.motion.turns
    every = crossings.carried(gauge, count)
    some = crossings.carried(gauge, count, np.array([25.0, 27.0]))
    assert 0.2 < some.mean() <= every.mean() < 1.0
    assert not (some & ~np.roll(every, 1) & ~every & ~np.roll(every, -1)).any()
    assert not crossings.carried(gauge, count, np.array([22.9])).any()  # within the roller's inner end


def replace_follower(drum, **more):
    from kin.numeric.records import replace as changed

    return changed(drum.intent().follower, **more)


@pytest.mark.slow  # solids by chance
@pytest.mark.parametrize("number", [0, 2])
def test_random_screws(number):
    chance = np.random.default_rng([7, number])
    out, back = int(chance.integers(1, 4)), int(chance.integers(1, 3))
    stroke = float(chance.uniform(14.0, 17.0) * min(out, back) + chance.uniform(5.0, 10.0))
    motion = Motion(((stroke, 360.0 * out, "cv-blended"), (-stroke, 360.0 * back, "cv-blended")))
    drum = screw(
        motion, roller=float(chance.uniform(3.0, 5.0)), track=Groove(7.5, float(chance.choice([0.0, 0.03]))), shoe=None
    )
    solid = cut(drum, 360, 5, 12)
    verdict = judged(solid, drum)
    assert refused(verdict) == {("crossings", "")}
    worst = max(flank.measured_error for flank in verdict.flanks)
    if not drum.track.clearance:
        off = np.abs(outside(drum, walls_of(drum, solid, chance, 1500)))
        assert off.max() < worst + 1e-4
    larger = replace(drum, roller=drum.roller + 0.02)
    assert {("contour", "lower"), ("contour", "upper")} <= refused(judged(solid, larger))
