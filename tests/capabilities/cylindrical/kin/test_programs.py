"""Programs of a drum, written here: what their cutters leave against brute force, and planted faults.

Holds: kin.cylindrical.program, kin.turned.cutters, kin.turned.moves.
"""

import math
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from capabilities.cylindrical.kin.drums import TURN, Arm, Drum, End, Groove, Motion, Rib, replace
from support.cases import few
from support.programmes import Segment, law, programme

from kin.cylindrical.gauge import gauges_of
from kin.cylindrical.lifts import Lifts
from kin.cylindrical.program import off_path, verify_program
from kin.cylindrical.roller import Gauge
from kin.numeric.limits import Limits
from kin.read.errors import ReadError
from kin.turned.checks import Cutting
from kin.turned.cutters import _Cutter, _least, left_on
from kin.turned.moves import Pass, passes_of, read_turned

TOLERANCE = 1e-3
CUTTING = Cutting(10.0, 300.0, inverse=True, depth_of_cut=7.0)
DRUM = Drum(track=Groove(12.5))


def way(motion=DRUM.motion, level=20.0, step=0.5, over=365.0):
    """Angles, rad, and places along the drum of the roller's axis."""
    a = np.radians(np.arange(0.0, over + 1e-9, step))
    return a, level + motion(a)


def text_of(a, x, *, depths=(44.0, 37.5), digits=5, head="(cutter: diameter 20)"):
    """A program of the way in depths."""
    return text_beside([(a, x, np.zeros_like(a))], depths=depths, digits=digits, head=head).replace(" Y0.0 ", " ")


def text_beside(ways, *, depths=(44.0, 37.5), digits=5, head="(cutter: diameter 20)"):
    """A program of ways, each in depths, with Y."""
    lines = [head, "G21", "G17 G90 G93", "G40 G49 G80", "G0 Z60", "S2000 M3"]
    for a, x, y in ways:
        rows = np.column_stack([np.degrees(a), x, y]).round(digits).tolist()
        for z in depths:
            lines += [f"G0 X{rows[0][1]} Y{rows[0][2]} A{rows[0][0]}", f"G1 Z{z} F10"]
            for before, at in pairwise(rows):
                far = math.hypot(at[1] - before[1], at[2] - before[2], math.radians(at[0] - before[0]) * 50.0)
                lines.append(f"G1 X{at[1]} Y{at[2]} A{at[0]} F{300.0 / far:.4f}")
            lines.append("G0 Z60")
    return "\n".join([*lines, "M5", "M30", ""])


def judged(folder, text, drum=DRUM, cutting=CUTTING, tolerance=TOLERANCE):
    path = folder / "drum.ngc"
    path.write_text(text, "ascii")
    return verify_program(path, drum.intent(), cutting, Limits(tolerance))


def refused(verdict):
    return {check.name for check in verdict.checks if not check.ok}


@pytest.mark.slow
def test_a_cutter_of_the_roller_s_size_along_its_path(tmp_path):
    verdict = judged(tmp_path, text_of(*way()))
    assert verdict.ok, verdict.checks
    assert [flank.name for flank in verdict.flanks] == ["lower", "upper"]
    # between blocks of 0.5 degrees a chord is off by S'' h^2/8, at most 57.3 mm/rad^2 in the polynomial's return
    most = 57.74 * math.radians(0.5) ** 2 / 8.0
    for flank in verdict.flanks:
        assert 0.9 * most < flank.motion.max < 1.001 * most
        assert flank.measured_error < flank.motion.max
        assert flank.motion.remainder < 0.15 * TOLERANCE


SWING = Motion(((0.5, 120.0, "cycloidal"), (0.0, 60.0, ""), (-0.5, 120.0, "polynomial-345"), (0.0, 60.0, "")))
LEVEL = 40.0 - 80.0 * math.sin(0.25)
ARM = Drum(motion=SWING, level=LEVEL, track=Groove(12.5), arm=Arm(80.0, 78.7, 40.0, 1))
TAPER = math.radians(6.0)
LED = {
    "beside": Drum(track=Groove(12.5), offset=6.0),
    "trailing": ARM,
    "leading": replace(ARM, arm=Arm(80.0, -78.7, 40.0, -1)),
    "cone": Drum(track=Groove(12.5), taper=TAPER),
    "cone on an arm": replace(ARM, taper=TAPER),
    "rib on an arm": replace(ARM, track=Rib(12.5, 36.0)),
    "end on an arm": replace(ARM, track=End("top", 12.5)),
}


def levels_of(drum):
    """Heights of the rollers' axes at lift 0."""
    return sorted({level for _, _, _, level in drum.flanks})


def ways_of(drum, step=0.5, over=365.0):
    """Angles, rad, and places along the drum and beside its axis of its rollers' axes, each roller once."""
    a = np.radians(np.arange(0.0, over + 1e-9, step))
    places = [drum.axis(a, level) for level in levels_of(drum)]
    return [(a, z, y) for y, z in places]


def cut_by(drum):
    """The cutter of a drum's roller, at its end on the floor."""
    return replace(CUTTING, radius=drum.size(drum.roller, drum.floor), taper=drum.taper)


def named(drum):
    cone = f" at its end, half angle {math.degrees(drum.taper):.9f} degrees" if drum.taper else ""
    return f"(cutter: diameter {2.0 * drum.size(drum.roller, drum.floor):.9f}{cone}, its axis square to the drum's)"


def led(folder, drum, ways=None, cutting=None, **more):
    text = text_beside(ways or ways_of(drum), **{"head": named(drum), **more})
    return judged(folder, text, drum, cutting or cut_by(drum))


@pytest.mark.slow
@pytest.mark.parametrize("kind", LED)
def test_a_cutter_like_the_roller_along_its_path_is_right_at_every_radius(tmp_path, kind):
    """What stands between blocks is what a chord leaves out, no more than the path's bend times h^2/8."""
    drum = LED[kind]
    verdict = led(tmp_path, drum)
    assert verdict.ok, verdict.checks
    fine, chords = np.radians(np.arange(0.0, 365.0, 0.01)), 0.0
    for level, (a, x, y) in zip(levels_of(drum), ways_of(drum), strict=True):
        place = drum.axis(fine, level)
        chords = max(chords, np.hypot(np.interp(fine, a, y) - place[0], np.interp(fine, a, x) - place[1]).max())
    for flank in verdict.flanks:
        assert 0.3 * chords < flank.measured_error < 1.01 * chords + 1e-5
        assert flank.motion.unit == ("mm" if drum.arm is None else "deg")
        reach = 1.0 if drum.arm is None else math.degrees(1.0 / drum.arm.length)
        assert 0.3 * chords * reach < flank.motion.max < 2.0 * chords * reach


def moved(ways, x=0.0, y=0.0, a=1.0, across=1.0):
    return [(a * angle, along + x, across * beside + y) for angle, along, beside in ways]


def coarse(ways):
    """Angles rounded to 0.01 degrees."""
    return [(np.radians(np.round(np.degrees(angle), 2)), along, beside) for angle, along, beside in ways]


LED_FAULTS: dict[str, Any] = {
    "a block left out": lambda _, ways: ([tuple(np.delete(row, 60) for row in way) for way in ways], {}),
    "X + 0.01": lambda _, ways: (moved(ways, x=0.01), {}),
    "Y + 0.01": lambda _, ways: (moved(ways, y=0.01), {}),
    "A mirrored": lambda _, ways: (moved(ways, a=-1.0), {}),
    "Y mirrored": lambda _, ways: (moved(ways, across=-1.0), {}),
    "A rounded": lambda drum, _: (coarse(ways_of(drum, 0.4953)), {}),
    "a smaller cutter": lambda _, ways: (ways, {"less": 0.025}),
    "another cone": lambda _, ways: (ways, {"taper": math.radians(0.5)}),
    "not deep enough": lambda _, ways: (ways, {"depths": (44.0, 38.2)}),
    "too deep": lambda _, ways: (ways, {"depths": (44.0, 37.4)}),
}
PLANTED = [
    (kind, fault)
    for kind, drum in LED.items()
    for fault in LED_FAULTS
    if fault != "Y mirrored" or drum.arm or drum.offset
]


@pytest.mark.slow
@pytest.mark.parametrize(("kind", "fault"), few(PLANTED[::3], 7))
def test_planted_faults_of_led_rollers_are_refused(tmp_path, kind, fault):
    drum = LED[kind]
    ways, more = LED_FAULTS[fault](drum, ways_of(drum))
    cutting = cut_by(drum)
    cutting = replace(
        cutting, radius=cutting.radius - more.pop("less", 0.0), taper=cutting.taper + more.pop("taper", 0.0)
    )
    verdict = led(tmp_path, drum, ways, cutting, **({"head": ""} if cutting != cut_by(drum) else {}), **more)
    assert not verdict.ok
    assert refused(verdict) & {"contour", "ways", "depth"}, verdict.checks


@pytest.mark.parametrize("kind", few(["trailing", "beside", "cone", "cone on an arm"], 3))
def test_a_cut_flank_of_a_led_roller_is_judged_by_the_path(tmp_path, kind):
    """The greatest distance of the path from the chords, along the drum and across it, within what is looked at."""
    drum = replace(LED[kind], shortened=True)
    verdict = led(tmp_path, drum)
    assert verdict.ok, verdict.checks
    ((a, x, y),), fine = ways_of(drum), np.linspace(0.0, TURN, 400_001)
    place = drum.axis(fine, drum.level)
    chord = float(np.abs(np.interp(fine, a, x) - place[1]).max())
    (check, *_) = [each for each in verdict.checks if each.name == "contour"]
    assert chord <= check.value < chord + 0.02 * TOLERANCE + np.abs(np.interp(fine, a, y) - place[0]).max() + 1e-4
    for ways in (moved(ways_of(drum), x=0.01), moved(ways_of(drum), y=0.01)):
        assert "contour" in refused(led(tmp_path, drum, ways))
    smaller = replace(cut_by(drum), radius=cut_by(drum).radius - 0.025)
    assert refused(led(tmp_path, drum, cutting=smaller, head="")) == {"contour"}


@pytest.mark.slow
def test_a_cutter_of_another_cone_is_named(tmp_path):
    drum = LED["cone"]
    verdict = led(tmp_path, drum, head=named(drum).replace("angle 6.0", "angle 6.1"))
    assert refused(verdict) == {"cutter"}
    twice = text_beside(ways_of(drum), head=named(drum)).replace("F10\n", "F20\n")
    verdict = judged(tmp_path, twice.replace("F68", "F136"), drum, cut_by(drum))
    assert refused(verdict) == {"feed"}


# --- several turns ----------------------------------------------------------------------------------------------------

TURNS = 2
OUT = (
    Segment("rise", TURN, 50.0, law("cycloidal")),
    Segment("return", TURN, 50.0, law("polynomial-345")),
)


def out_and_back(theta):
    """Lift over two turns: 50 out in the first and back in the second, by the laws' own formulas."""
    u = np.mod(theta, 2.0 * TURN) / TURN
    w = u - 1.0
    rise = 50.0 * (u - np.sin(TURN * u) / TURN)
    back = 50.0 * (1.0 - w**3 * (10.0 - 15.0 * w + 6.0 * w**2))
    return np.where(u < 1.0, rise, back)


def crossing_drum(**more):
    """A groove that goes out and back in two turns and crosses itself."""
    drum = Drum(track=Groove(12.5), length=90.0).intent()
    follower = replace(drum.follower, law=programme(OUT, TURNS * TURN).motion, turns=TURNS, **more)
    return replace(drum, follower=follower)


def text_of_turns(step=0.4, over=725.0, x=0.0):
    a = np.radians(np.arange(0.0, over + 1e-9, step))
    return text_of(a, 20.0 + out_and_back(a) + x)


def judged_turns(folder, text, drum=None):
    path = folder / "drum.ngc"
    path.write_text(text, "ascii")
    return verify_program(path, drum or crossing_drum(), CUTTING, Limits(TOLERANCE))


@pytest.mark.slow
def test_a_groove_that_crosses_itself_is_cut_by_all_its_turns(tmp_path):
    verdict = judged_turns(tmp_path, text_of_turns())
    assert verdict.ok, verdict.checks
    # chords of 0.4 degrees leave out S'' h^2/8, at most 7.96 mm/rad^2 in the rise, 7.3 in the return
    most = 2.0 * math.pi * 50.0 / TURN**2 * math.radians(0.4) ** 2 / 8.0
    for flank in verdict.flanks:
        assert 0.5 * most < flank.motion.max < 1.01 * most + 1e-5
    place = max(check.at for check in verdict.checks if check.at is not None)
    assert 0.0 <= place < 720.0
    # on the way through a crossing the other turn's cutter takes the wall: without it, the wall would be cut too deep
    once = replace(crossing_drum(), follower=replace(crossing_drum().follower, turns=1, law=DRUM.motion.law))
    assert not judged_turns(tmp_path, text_of_turns(), once).ok


@pytest.mark.thin(3)
@pytest.mark.parametrize(
    ("fault", "names"),
    [
        (lambda: text_of_turns(over=365.0), {"contour"}),
        (lambda: text_of_turns(x=0.01), {"contour", "motion"}),
        (lambda: text_of_turns(step=2.0), {"contour", "motion"}),
        (lambda: text_of_turns().replace("A180.", "A181."), {"ways"}),
    ],
    ids=["a turn left out", "X + 0.01", "coarse", "to and fro"],
)
def test_planted_faults_of_several_turns_are_refused(tmp_path, fault, names):
    assert names <= refused(judged_turns(tmp_path, fault()))


@pytest.mark.costly("brute force over the positions of a cutter")
def test_beside_a_crossing_what_is_left_is_what_no_position_takes():
    """Of points that lie in no roller of the other turn, by positions alone; within it a turn counts alone."""
    drum, rng = crossing_drum(), np.random.default_rng(7)
    gauge = gauges_of(drum)[0]
    a = np.linspace(-0.1, TURNS * TURN + 0.1, 900)
    one = Pass(1, 37.5, a, 20.0 + out_and_back(a) + 0.01 * np.sin(30.0 * a), np.zeros_like(a))
    left = left_on(gauge, [one], 10.0, 0.02)
    rows, columns = rng.integers(0, len(left.rho), 40), rng.integers(0, len(left.theta), 40)
    v = (out_and_back(left.theta[columns] + 1e-6) - out_and_back(left.theta[columns] - 1e-6)) / 2e-6
    w = np.hypot(left.rho[rows], v)
    across, up = 10.0 * v / w, -10.0 * left.rho[rows] / w
    theta, rho = left.theta[columns], left.rho[rows]
    x, y = rho * np.cos(theta) - across * np.sin(theta), rho * np.sin(theta) + across * np.cos(theta)
    points = np.stack([x, y, 20.0 + out_and_back(theta) + up], axis=-1)
    found, wanted = left.off[rows, columns], nearest(points, [one], 10.0)
    inside = wanted < -0.05
    assert 2 <= np.count_nonzero(inside) < 20
    np.testing.assert_allclose(found[~inside], wanted[~inside], atol=5e-6)
    assert np.abs(found[inside]).max() < 0.03


def without(text, number):
    lines = text.split("\n")
    return "\n".join(lines[:number] + lines[number + 1 :])


def drilled(text, degrees, beside=0.0):
    """A program that at the end goes down to the floor once more at an angle, so far beside the roller's axis."""
    x = 20.0 + float(DRUM.motion(np.radians(degrees))) + beside
    return text.replace("M5\n", f"G0 X{x:.5f} A{degrees}\nG1 Z37.5 F10\nG0 Z60\nM5\n")


def pieces_of(text, number):
    """A program whose first pass ends at a line, all of the others whole."""
    lines = text.split("\n")
    return "\n".join(lines[:number] + lines[lines.index("G0 Z60", 6) :])


FAULTS = {
    "a block left out": (lambda text: without(text, 8 + 733 + 50), {"contour", "feed"}),
    "X shifted by 0.01": (lambda _: text_of(way()[0], way()[1] + 0.01), {"contour", "motion"}),
    "A mirrored": (lambda _: text_of(-way()[0], way()[1]), {"ways"}),
    "A rounded to 0.01": (
        lambda _: text_of(np.radians(np.round(np.degrees(way(step=0.495)[0]), 2)), way(step=0.495)[1]),
        {"contour", "motion"},
    ),
    "another cutter": (lambda _: text_of(*way(), head="(cutter: diameter 19.9)"), {"cutter"}),
    "a feed by the minute": (lambda text: text.replace("G93", "G94"), {"feed"}),
    "twice the feed": (lambda text: text.replace("F10\n", "F20\n").replace("F68", "F136"), {"feed"}),
    "not deep enough": (lambda _: text_of(*way(), depths=(44.0, 38.2)), {"depth", "contour"}),
    "too deep": (lambda _: text_of(*way(), depths=(44.0, 37.4)), {"depth"}),
    "too deep at a time": (lambda _: text_of(*way(), depths=(42.0, 37.5)), {"depth"}),
    "less than a turn": (lambda _: text_of(*way(over=355.0)), {"contour"}),
    "fast in the metal": (lambda text: text.replace("G0 Z60\nM5", "G0 X25\nG0 Z60\nM5"), {"rapid"}),
    "into the wall": (lambda text: text.replace("G0 Z60\nM5", "G1 X70 F5\nG0 Z60\nM5"), {"ways"}),
    "drilled beside the path": (lambda text: drilled(text, 200.0, 0.5), {"contour"}),
    "a piece of the first depth alone": (lambda text: pieces_of(text, 8 + 40), {"depth"}),
    "down while it turns": (lambda text: text.replace("G1 Z44.0", "G1 Z44.0 A0.5"), {"ways"}),
    "to and fro": (
        lambda _: text_of(np.concatenate([way()[0][:5], way()[0][3:]]), np.concatenate([way()[1][:5], way()[1][3:]])),
        {"ways"},
    ),
}


@pytest.mark.thin(5)
@pytest.mark.parametrize("fault", FAULTS)
def test_planted_faults_are_refused(tmp_path, fault):
    make, names = FAULTS[fault]
    verdict = judged(tmp_path, make(text_of(*way())))
    assert names <= refused(verdict), verdict.checks
    if names <= {"feed", "cutter", "depth"}:
        assert refused(verdict) == names


def test_a_cutter_smaller_than_the_roller_leaves_metal(tmp_path):
    """By 0.05 of the diameter, on the path for the roller: half of that stays on each flank."""
    verdict = judged(tmp_path, text_of(*way(), head=""), cutting=replace(CUTTING, radius=9.975))
    assert refused(verdict) == {"contour", "motion"}
    for flank in verdict.flanks:
        assert flank.measured_error == pytest.approx(0.025, abs=1e-3)


def test_a_rest_in_one_long_block(tmp_path):
    """In dwells the drum turns by 58 degrees at a time; what is left is as before."""
    a, x = way(step=1.0)
    rest = np.isin(np.mod(np.degrees(a).round(), 360.0), np.r_[122:179, 302:359])
    found = [judged(tmp_path, text_of(*each), tolerance=0.005) for each in ((a, x), (a[~rest], x[~rest]))]
    for verdict in found:
        assert verdict.ok, verdict.checks
    for first, second in zip(*(verdict.flanks for verdict in found), strict=True):
        assert second.motion.max == pytest.approx(first.motion.max, abs=1e-6)
        assert second.motion.rms == pytest.approx(first.motion.rms, abs=1e-5)


@pytest.mark.slow
@pytest.mark.parametrize("degrees", [0.0, 90.0, 200.0])
def test_a_hole_on_the_path_is_nothing_s_fault(tmp_path, degrees):
    whole, holed = (judged(tmp_path, text) for text in (text_of(*way()), drilled(text_of(*way()), degrees)))
    assert holed.ok, holed.checks
    for flank, other in zip(whole.flanks, holed.flanks, strict=True):
        assert other.motion.max == pytest.approx(flank.motion.max, abs=1e-5)


def test_a_hole_that_goes_down_in_two_steps_is_one(tmp_path):
    """A cutter that goes on from where it stands makes no pass there; one that leaves does."""
    text = "G21\nG17 G90 G94\nG0 Z60\nG0 X1 A0\nS9 M3\nG1 Z45 F9\nG1 Z40\n{}G0 Z60\nM5\nM30\n"
    path = tmp_path / "hole.ngc"
    for more, points in (("", 2), ("G1 A9\nG1 A12\n", 3)):
        path.write_text(text.format(more), "ascii")
        (one,) = passes_of(read_turned(path).moves, 50.0)
        assert (one.z, len(one.a), one.line) == (40.0, points, 8 if more else 7)


def test_what_stands_between_two_ways_is_found_behind_a_piece_of_a_third(tmp_path):
    a, x = way(level=0.0, step=2.0)
    some = slice(20, 60)
    parts = [(a, x + 14.5), (a[some], x[some] + 20.0), (a, x + 25.5)]
    text = "".join(text_of(*each).split("M5")[0] for each in parts).replace("(cutter: diameter 20)", "")
    verdict = judged(tmp_path, text + "M5\nM30\n", cutting=replace(CUTTING, radius=4.5), tolerance=1.0)
    (check,) = [each for each in verdict.checks if each.name == "cleared"]
    assert not check.ok
    assert check.value == pytest.approx(11.0)


def test_what_stands_between_two_ways_is_found(tmp_path):
    """Of cutters of 9 the two ways of a groove of 20 clear all but a ridge of 2."""
    a, x = way(level=0.0, step=2.0)
    ways = "".join(text_of(a, x + level).split("M5")[0] for level in (14.5, 25.5))
    text = ways.replace("(cutter: diameter 20)", "") + "M5\nM30\n"
    verdict = judged(tmp_path, text, cutting=replace(CUTTING, radius=4.5), tolerance=1.0)
    (check,) = [each for each in verdict.checks if each.name == "cleared"]
    assert not check.ok
    assert check.value == pytest.approx(11.0)


def test_a_cut_flank_is_judged_by_the_path(tmp_path):
    """With a corner of the motion, or an undercut: the greatest distance of the path from the chords."""
    a, x = way()
    verdict = judged(tmp_path, text_of(a, x), replace(DRUM, shortened=True))
    assert verdict.ok, verdict.checks
    fine = np.linspace(0.0, TURN, 1_000_001)
    wanted = float(np.abs(np.interp(fine, a, np.round(x, 5)) - 20.0 - DRUM.motion(fine)).max())
    assert verdict.flanks[0].motion.max == pytest.approx(wanted, abs=2e-8)
    shifted = judged(tmp_path, text_of(a, x + 0.01), replace(DRUM, shortened=True))
    assert {"contour", "motion"} == refused(shifted)
    smaller = judged(tmp_path, text_of(a, x, head=""), replace(DRUM, shortened=True), replace(CUTTING, radius=9.9))
    assert refused(smaller) == {"contour"}


def test_a_path_s_extremes_are_between_its_points():
    """Two chords over a rise: the difference is greatest where the slopes are one, found here on a fine grid."""
    a, x = np.array([0.1, 0.9, 1.7, 1.7]), np.array([0.3, 11.0, 33.0, 34.0])
    found = off_path(Pass(1, 40.0, a, x, np.zeros(4)), Lifts(DRUM.motion.law), 0.0)
    fine = np.linspace(0.1, 1.7, 2_000_001)
    off = np.interp(fine, a[:3], x[:3]) - DRUM.motion(fine)
    assert found.least == pytest.approx(off.min(), abs=1e-9)
    assert found.most == pytest.approx(max(off.max(), 34.0 - float(DRUM.motion(np.array([1.7]))[0])), abs=1e-9)


# --- brute force ------------------------------------------------------------------------------------------------------


def nearest(points, passes, cutter, looks=200, growth=0.0):
    """D (n,) of points (n, 3) by positions alone: so many on every block near a point, each pass down to its end.

    The cutter has its radius at its end, and grows along its axis.
    """
    best = np.full(len(points), np.inf)
    for one in passes:
        share = np.arange(looks) / looks
        a, x, y = ((row[:-1, None] + share * np.diff(row)[:, None]).ravel() for row in (one.a, one.x, one.y))
        for k, (px, py, pz) in enumerate(points):
            phi = math.atan2(py, px)
            for turn in range(math.floor((a[0] - phi) / TURN), math.ceil((a[-1] - phi) / TURN) + 1):
                near = slice(*np.searchsorted(a, phi + TURN * turn + np.array([-0.35, 0.35])))
                across = py * np.cos(a[near]) - px * np.sin(a[near]) - y[near]
                along = px * np.cos(a[near]) + py * np.sin(a[near])
                far = (np.hypot(across, pz - x[near]) - cutter - (along - one.z) * growth) / math.hypot(1.0, growth)
                best[k] = min(best[k], far[along >= one.z].min(initial=np.inf))
    return best


@pytest.mark.costly("brute force over the positions of a cutter")
@pytest.mark.thin(1)
@pytest.mark.parametrize("case", ["radial", "beside", "rib"])
def test_what_is_left_is_what_no_position_takes(case):
    """Smaller cutters on wavy ways, in two depths: D at places of the grid, and between them within the bounds."""
    rng = np.random.default_rng(3)
    drum = DRUM if case != "rib" else Drum(track=Rib(12.5, 40.0))
    gauge = gauges_of(drum.intent())[0]
    a = np.sort(np.concatenate([np.linspace(-0.1, TURN + 0.1, 300), rng.uniform(0.0, TURN, 30)]))
    wave = 0.01 * np.sin(40.0 * a)
    x = gauge.axis(a) - 2.0 + wave
    y = 0.8 * np.cos(a) if case == "beside" else np.zeros_like(a)
    passes = [Pass(1, 37.5, a, x, y), Pass(2, 43.0, a + 0.003, x - 0.05, y)]
    left = left_on(gauge, passes, 8.0, 0.02)
    chosen = rng.integers(0, len(left.rho), 12), rng.integers(0, len(left.theta), 12)
    theta, rho = left.theta[chosen[1]], left.rho[chosen[0]]
    points = on_flank(gauge, drum.motion, theta, rho)
    np.testing.assert_allclose(left.off[chosen], nearest(points, passes, 8.0), atol=2e-6)
    cells = rng.integers(0, len(left.rho) - 1, 12), rng.integers(0, len(left.theta) - 1, 12)
    share = rng.uniform(0.0, 1.0, (2, 12))
    theta = left.theta[cells[1]] * (1.0 - share[0]) + left.theta[cells[1] + 1] * share[0]
    rho = left.rho[cells[0]] * (1.0 - share[1]) + left.rho[cells[0] + 1] * share[1]
    between = nearest(on_flank(gauge, drum.motion, theta, rho), passes, 8.0)
    assert (between <= left.above[cells] + 1e-9).all()
    assert (between >= left.below[cells] - 2e-6).all()
    assert np.median(left.above[cells] - left.below[cells]) < 0.02


@pytest.mark.slow
@pytest.mark.parametrize("side", [-1, 1], ids=["lower", "upper"])
@pytest.mark.parametrize("kind", ["beside", "trailing", "leading", "cone", "cone on an arm"])
def test_what_is_left_beside_a_led_roller_is_what_no_position_takes(kind, side):
    """A smaller cutter on a wavy way in two depths, at places of the grid, and between them within the bounds."""
    rng, drum = np.random.default_rng(11), LED[kind]
    gauge = next(each for each in gauges_of(drum.intent()) if each.side == side)
    a = np.linspace(-0.1, TURN + 0.1, 300)
    y, z = drum.axis(a, drum.level)
    y, x = y + 0.3 * np.cos(a), z + 0.5 * side + 0.01 * np.sin(40.0 * a)
    end = drum.size(drum.roller, 37.5) - 0.8
    passes = [Pass(1, 37.5, a, x, y), Pass(2, 43.0, a + 0.003, x - 0.05, y)]
    left = left_on(gauge, passes, end, 0.02, drum.growth)
    rows, columns = rng.integers(0, len(left.rho), 12), rng.integers(0, len(left.theta), 12)
    points = on_led_flank(drum, side, left.theta[columns], left.rho[rows])
    wanted = nearest(points, passes, end, growth=drum.growth)
    # beside the end of the second pass, one of its places that is not the nearest may still reach a point
    beside = np.abs(left.rho[rows] - 43.0) < 0.5
    assert np.count_nonzero(beside) < 4
    assert (left.off[rows, columns] >= wanted - 3e-6).all()
    np.testing.assert_allclose(left.off[rows, columns][~beside], wanted[~beside], atol=3e-6)
    rows, columns = rng.integers(0, len(left.rho) - 1, 12), rng.integers(0, len(left.theta) - 1, 12)
    share = rng.uniform(0.0, 1.0, (2, 12))
    theta = left.theta[columns] * (1.0 - share[0]) + left.theta[columns + 1] * share[0]
    rho = left.rho[rows] * (1.0 - share[1]) + left.rho[rows + 1] * share[1]
    between = nearest(on_led_flank(drum, side, theta, rho), passes, end, growth=drum.growth)
    assert (between <= left.above[rows, columns] + 1e-9).all()
    assert (between >= left.below[rows, columns] - 3e-6).all()
    assert np.median((left.above - left.below)[rows, columns]) < 0.02


def on_led_flank(drum, side, theta, rho):
    """Points (n, 3) that a roller on any guide touches, by the equation of meshing."""
    (y, z), (y1, z1) = (drum.axis(theta, drum.level, order) for order in (0, 1))
    size = drum.size(drum.roller, rho)
    ahead = rho + size * drum.growth + y1
    a = np.arctan2(z1, ahead) + side * np.arcsin(y * drum.growth / np.hypot(ahead, z1))
    across, up = y - side * size * np.sin(a), z + side * size * np.cos(a)
    return np.stack(
        [rho * np.cos(theta) - across * np.sin(theta), rho * np.sin(theta) + across * np.cos(theta), up], axis=-1
    )


def on_flank(gauge, motion, theta, rho):
    """Points (n, 3) that the roller touches, by the equation of meshing."""
    v = motion(theta, 1)
    w = np.hypot(rho, v)
    across, up = -gauge.side * gauge.radius * v / w, gauge.side * gauge.radius * rho / w
    x, y = rho * np.cos(theta) - across * np.sin(theta), rho * np.sin(theta) + across * np.cos(theta)
    return np.stack([x, y, gauge.level + motion(theta) + up], axis=-1)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("beside", "outside", "inside"),
    [(False, 0.00212883859238, 0.168907879811), (True, 4.81844361801e-6, 0.0175138654945)],
    ids=["radial", "beside"],
)
def test_a_smaller_cutter_on_a_helix(beside, outside, inside):
    """Worked case c13: a roller of 10, a cutter of 8, a helix of 30 degrees at the radius 50 where it is set."""
    v = 50.0 * math.tan(math.radians(30.0))
    rise = Segment("rise", math.radians(300.0), v * math.radians(300.0), law("constant-velocity"))
    back = Segment("return", math.radians(60.0), v * math.radians(300.0), law("constant-velocity"))
    lifts = Lifts(programme([rise, back], TURN).motion)
    gauge = Gauge("lower", -1, 10.0, 0.0, 36.0, 50.0, lifts, 35.0)
    sine = v / math.hypot(50.0, v)
    y, up = 2.0 * sine, -2.0 * math.sqrt(1.0 - sine**2)
    a = np.linspace(0.3, 4.9, 2000)
    turn = 0.0 if beside else math.atan2(y, 50.0)
    one = Pass(1, 30.0, a + turn, v * a + up, np.full_like(a, y if beside else 0.0))
    left = left_on(gauge, [one], 8.0, 2e-3)
    column = int(np.argmin(np.abs(left.theta - 2.6)))
    w = np.hypot(left.rho, v)
    r = np.hypot(left.rho, 10.0 * v / w)
    # the case measures on the cylinder r, square to the flank's curve there: its normal leans by its part along r
    along = 10.0 * (v / w) ** 2 / r
    smooth = np.polynomial.Polynomial.fit(r, left.off[:, column] / np.sqrt(1.0 - along**2), 7)
    found = smooth(np.array([38.0, 50.0]))
    # along the curve's normal the metal is thicker by its bend: second order
    np.testing.assert_allclose(found, [inside, outside], rtol=2e-3)
    assert found[1] == pytest.approx(outside, rel=6e-4)


# --- reading ----------------------------------------------------------------------------------------------------------


def read(folder, text):
    path = folder / "part.ngc"
    path.write_text(text, "ascii")
    return read_turned(path)


HEAD = "G21\nG90 G93\nS1000 M3\nG0 Z60 X5 A10\n"


def test_moves_are_read_with_the_time_of_their_blocks(tmp_path):
    program = read(tmp_path, f"{HEAD}G1 Z40 F10\nG1 X6 A-350 F2.5\nG94 G1 X7 Y1 F100\nG0 Z60\nM30\n")
    (down, turn, along, out) = program.moves[1:]
    assert (down.end.z, down.feed, down.inverse) == (40.0, 10.0, True)
    assert turn.end.a == pytest.approx(math.radians(-350.0))
    assert (along.feed, along.inverse, along.end.y) == (100.0, False, 1.0)
    assert out.rapid
    assert program.beside
    (one,) = passes_of(program.moves, 50.0)
    assert (one.line, one.z, len(one.a)) == (6, 40.0, 3)


@pytest.mark.parametrize(
    ("words", "problem"),
    [
        ("G1 Z40 F10\nG1 X6", "every block that cuts"),
        ("G2 X6 Y0 I1", "is not read"),
        ("G1 B6 F1", "is not read"),
        ("G91 G1 X6 F1", "is not read"),
        ("M5\nG1 X6 F1", "a spindle that turns"),
    ],
)
def test_what_is_not_read_is_refused_with_its_line(tmp_path, words, problem):
    with pytest.raises(ReadError, match=problem):
        read(tmp_path, f"{HEAD}{words}\nM30\n")
    assert not judged(tmp_path, f"{HEAD}{words}\nM30\n").ok


def test_a_feed_move_has_to_begin_somewhere(tmp_path):
    with pytest.raises(ReadError, match="from an unknown place"):
        read(tmp_path, "G21\nG90 G94\nS1000 M3\nF100\nG1 X5\nM30\n")


@pytest.mark.parametrize("growth", [0.0, 0.1])
def test_a_point_on_the_axis_of_a_cutter_is_as_deep_as_that_is_wide(growth):
    """Half way through a block, where no way leads from the axis to the point."""
    one, zero = Pass(1, 20.0, np.array([0.0, 0.02]), np.zeros(2), np.zeros(2)), np.zeros(1)
    least, share = _least(one, np.array([0]), (np.array([0.01]), np.array([30.0]), zero), _Cutter(5.0, growth))
    assert least == pytest.approx(-growth * 30.0)
    assert share == pytest.approx(0.5)
