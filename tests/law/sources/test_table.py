"""Tables kept within their reading error; what is no table is refused with its line.

Holds: kin.law.sources.dwells.
"""

import math
import re

import mpmath
import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from support.cases import examples

from kin.law.normalised import IntentError
from kin.law.sources.laws import named
from kin.law.sources.lobe import lobe
from kin.law.sources.programme import Dwell, Move, programme
from kin.law.sources.ring import Samples
from kin.law.sources.table import from_table
from kin.law.sources.tabled import TableError
from kin.law.support_function import lift_constant_breadth
from kin.numeric.lengths import in_unit
from kin.read.tables import Sheet, read_table

TURN = 2 * math.pi
rad = math.radians
VALVE = lobe(8.0, rad(68), (2, 8, 14, 20, 26))
PLATE = programme(
    [
        Move(rad(100), named("modified-sine"), by=20.0),
        Dwell(rad(60)),
        Move(rad(140), named("modified-trapezoid"), by=-20.0),
        Dwell(rad(60)),
    ],
    TURN,
)


@pytest.mark.parametrize("closing", [False, True])
def test_angles_may_pass_360_once(closing):
    """Rows from 200 to 358 and on from 0, as a machine counts within the turn, are those from -160 on."""
    degrees = np.arange(200.0, 560.0 + closing, 4.0)
    shaft = np.radians(degrees)
    s = np.round(6.0 - 6.0 * np.cos(shaft), 4)
    lines = np.arange(len(s)) + 2
    rows = Samples(np.mod(shaft, TURN), s, lines)
    motion, straight = from_table(rows, 5e-5), from_table(Samples(shaft - TURN, s, lines), 5e-5)
    t = np.linspace(0.0, TURN, 100, endpoint=False)
    np.testing.assert_allclose(motion.derivatives(t, 0)[0], straight.derivatives(t, 0)[0], atol=1e-9)


def event():
    """The valve's lift at every degree of its event, rounded to a thousandth."""
    theta = np.radians(np.arange(-68.0, 69.0))
    return Samples(theta, np.round(VALVE.derivatives(np.mod(theta, TURN), 0)[0], 3), np.arange(137) + 1)


def plate(count=360, places=3):
    theta = np.arange(count) * (TURN / count)
    return Samples(theta, np.round(PLATE.derivatives(theta, 0)[0], places), np.arange(count) + 1)


# --- tables -----------------------------------------------------------------------------------------------------------


def off(motion, rows, period=TURN):
    return np.abs(motion.derivatives(np.mod(rows.theta, period), 0)[0] - rows.s)


def test_the_valve_table_is_kept_within_half_its_digit():
    """Its own second differences are more than twice as far off as the motion's acceleration, which is within 5 %."""
    motion = from_table(event(), 0.0005)
    assert off(motion, event()).max() <= 0.0005
    theta = np.mod(np.linspace(-rad(68), rad(68), 40001), TURN)
    wrong = np.abs(motion.derivatives(theta, 2) - VALVE.derivatives(theta, 2)).max(axis=1)
    assert (wrong <= [0.001, 0.03, 0.05 * 47.6]).all()
    second = np.diff(event().s, 2) / rad(1) ** 2
    true = VALVE.derivatives(np.mod(event().theta[1:-1], TURN), 2)[2]
    assert np.abs(second - true).max() > 2 * wrong[2]
    assert motion.range == pytest.approx((0.0, 8.0), abs=0.0005)


def test_the_greatest_distance_from_the_rows_is_told_with_its_line():
    motion = from_table(event(), 0.001)
    assert motion.kept.distance == pytest.approx(off(motion, event()).max(), abs=1e-12)
    assert off(motion, event())[motion.kept.line - 1] == pytest.approx(motion.kept.distance, abs=1e-12)
    assert motion.kept.remarks == ()


def test_dwells_are_level_on_their_inner_part_and_the_acceleration_is_continuous():
    motion = from_table(plate(), 0.0005)
    found = [(math.degrees(rest.begin), math.degrees(rest.end), rest.level) for rest in motion.rests]
    assert found == [pytest.approx((100, 160, 20), abs=1.5), pytest.approx((300, 360, 0), abs=1.5)]
    assert [rest.level for rest in motion.rests] == [20.0, 0.0]
    assert motion.demand_joined()
    assert all(jump[0] == 3 for joint in motion.joints for jump in joint.jumps)
    theta = np.linspace(0, TURN, 1000)
    assert motion.derivatives(theta, 0)[0] == pytest.approx(PLATE.derivatives(theta, 0)[0], abs=1e-3)
    assert np.abs(motion.derivatives(theta, 2)[2]).max() < 1.1 * np.abs(PLATE.derivatives(theta, 2)[2]).max()
    # rotated, with the dwell over the end of the turn
    rows = plate()
    moved = from_table(rows._replace(s=np.roll(rows.s, 330)), 0.0005)
    assert [math.degrees(rest.end) for rest in moved.rests] == pytest.approx([130, 330], abs=1.5)


@pytest.mark.slow
def test_a_hundred_thousand_rows():
    motion = from_table(plate(100_000), 0.0005)
    assert off(motion, plate(100_000)).max() <= 0.0005
    assert len(motion.motion.functions) < 200
    theta = np.linspace(0, TURN, 5000)
    wrong = np.abs(motion.derivatives(theta, 2)[2] - PLATE.derivatives(theta, 2)[2])
    assert wrong.max() < 0.05 * np.abs(PLATE.derivatives(theta, 2)[2]).max()


def test_a_table_without_a_dwell_is_periodic_and_c4():
    theta = np.arange(240) * (TURN / 240)
    rows = Samples(theta, 5 - 5 * np.cos(theta) + 0.3 * np.sin(2 * theta), np.arange(240) + 1)
    motion = from_table(rows, 1e-4)
    assert motion.joints == ()
    assert np.abs(motion.motion.jumps(4)[1]).max() < 1e-8
    again = rows._replace(theta=np.append(theta, TURN), s=np.append(rows.s, rows.s[0]), lines=np.arange(241) + 1)
    assert from_table(again, 1e-4).derivatives(theta, 4) == pytest.approx(motion.derivatives(theta, 4))
    mid, radius = motion.enclosure(theta[:-1], theta[1:], 4)
    inside = motion.derivatives(0.5 * (theta[:-1] + theta[1:]), 4)
    assert (np.abs(inside - mid) <= radius).all()


def test_a_table_over_a_half_turn_closes_upside_down():
    theta = np.radians(np.arange(181.0))
    rows = Samples(
        theta, np.round(2.5 + 6 * (1 - np.cos(theta)) + 0.3 * (1 - np.cos(3 * theta)), 4), np.arange(181) + 1
    )
    motion = from_table(rows, 1e-4, math.pi, around=-1)
    assert motion.joints == ()
    assert motion.derivatives(0.0, 0)[0, 0] == pytest.approx(0, abs=1e-12)
    lift = lift_constant_breadth(40.0, motion)
    assert lift.derivatives(0.3, 0) + lift.derivatives(0.3 + math.pi, 0) == pytest.approx(92.6, abs=2e-4)


def test_a_table_over_a_part_of_a_turn_rests_at_both_ends():
    theta = np.radians(np.arange(0.0, 121.0, 4.0))
    true = programme([Move(rad(120), named("cycloidal"), by=9.0)], rad(120), around=None)
    rows = Samples(theta, np.round(true.derivatives(theta, 0)[0], 3), np.arange(31) + 1)
    motion = from_table(rows, 0.0005, rad(120), around=None)
    assert motion.at_start(2).tolist() == [0, 0, 0]
    assert motion.at_end(2) == pytest.approx([9, 0, 0], abs=1e-12)
    assert np.abs(motion.derivatives(theta, 0)[0] - rows.s).max() <= 0.0005


@pytest.mark.parametrize("around", [1, -1, None])
def test_a_table_of_one_level_is_no_motion(around):
    rows = Samples(np.radians([0.0, 60.0, 120.0, 180.0]), np.zeros(4), np.arange(4) + 1)
    motion = from_table(rows, 0.01, math.pi, around=around)
    assert list(motion.range) == [0, 0]
    assert len(motion.rests) == 1


def test_a_reading_that_leaves_nothing_of_the_motion_is_refused_with_one_that_does():
    for unit, word in ((1.0, "mm"), (25.4, "in"), (0.0254, "in"), (rad(1), "deg")):
        rows = plate(60)._replace(unit=unit)
        with pytest.raises(IntentError, match=rf"give reading: (\S+) {word} or less") as caught:
            from_table(rows, 30.0)
        told = float(re.search(r"reading: (\S+)", caught.value.message)[1])
        from_table(rows, told * {"mm": 1.0, "in": 25.4, "deg": rad(1)}[word])


@pytest.mark.parametrize("reading", [0.0, -1.0, math.nan, math.inf])
def test_a_reading_is_above_0(reading):
    with pytest.raises(IntentError, match="the reading error must be above 0"):
        from_table(plate(), reading)


# --- levels -----------------------------------------------------------------------------------------------------------

EVERY_10 = [0.08, 0.05, 0.19, 0.55, 1.16, 2.03, 3.13, 4.41, 5.78, 7.11, 8.32, 9.31, 10.05, 10.54, 10.81, 10.94, 11.01]
EVERY_10 += [11.07, 11.16, 11.26, 11.35, 11.33, 11.15, 10.73, 10.05, 9.12, 7.98, 6.72, 5.44, 4.22, 3.13, 2.22, 1.5]
EVERY_10 += [0.94, 0.53, 0.24]
EVERY_15 = [0.05, 0.07, 0.52, 1.53, 3.1, 5.06, 7.08, 8.82, 10.02, 10.67, 10.92, 11.01, 11.13, 11.28, 11.31, 10.95]
EVERY_15 += [10.03, 8.54, 6.69, 4.79, 3.1, 1.81, 0.91, 0.34]


def equally_spaced(s, by=0.0):
    return Samples(np.arange(len(s)) * (TURN / len(s)), np.array(s) + by, np.arange(len(s)) + 1)


@pytest.mark.parametrize(
    ("s", "reading", "square", "least"), [(EVERY_10, 0.02, 719.888, 0.02934), (EVERY_15, 0.005, 762.118, 0.010858)]
)
def test_a_least_row_beyond_its_reading_of_0_leaves_the_motion_of_least_jerk(s, reading, square, least):
    """Its integral and least value are those of a Fourier series of 240 harmonics, by non-negative least squares."""
    rows = equally_spaced(s)
    motion = from_table(rows, reading, suspect="keep")
    jerk = motion.derivatives((np.arange(20000) + 0.5) * (TURN / 20000), 3)[3]
    assert np.mean(jerk**2) * TURN == pytest.approx(square, rel=2e-4)
    assert motion.range[0] == pytest.approx(0.0, abs=1e-12)
    # lowered by its least value; no row is nearer than that less its reading, and the worst is as far as both
    assert motion.kept.distance == pytest.approx(least + reading, abs=3e-5)
    assert motion.kept.distance == pytest.approx(off(motion, rows).max(), abs=1e-12)


@pytest.mark.parametrize("reading", [0.02, pytest.param(0.005, marks=pytest.mark.slow)])
def test_the_motion_follows_the_level_of_its_rows_without_a_jump(reading):
    """Readings of a least row beyond which other rules begin, and places between: 1e-7 moves no motion by 1e-3."""
    levels = np.array([-2.0, -1.0, -0.999, 0.999, 1.0, 2.0]) * reading
    theta = np.linspace(0.0, TURN, 500)
    for level in [*levels, 0.0607 if reading == 0.02 else 0.0492]:
        below, above = (
            from_table(equally_spaced(EVERY_10, level - 0.05 + step), reading, suspect="keep") for step in (-1e-7, 1e-7)
        )
        assert above.derivatives(theta, 0)[0] == pytest.approx(below.derivatives(theta, 0)[0], abs=1e-3)
        for motion, step in ((below, -1e-7), (above, 1e-7)):
            within = off(motion, equally_spaced(EVERY_10, level - 0.05 + step)).max()
            assert motion.kept.distance == pytest.approx(within, abs=1e-12)
            if abs(level) < reading:
                assert within <= reading


def test_the_lowest_dwell_is_at_0_and_its_rows_are_followed_at_any_level():
    """Rows of a dwell beyond twice their reading from 0 are lowered by their level, nearer ones by less."""
    plain = from_table(plate(), 0.0005).derivatives(plate().theta, 0)[0]
    for level, lowered in ((25.0, 25.0), (-0.3, -0.3), (0.0008, 0.0006), (0.0004, 0.0)):
        rows = plate()._replace(s=plate().s + level)
        motion = from_table(rows, 0.0005)
        assert motion.rests[-1].level == pytest.approx(0.0, abs=1e-8)
        assert motion.kept.distance == pytest.approx(off(motion, rows).max(), abs=1e-12)
        assert motion.kept.distance <= abs(lowered) + 0.0005
        if abs(level) > 0.001:
            assert motion.derivatives(rows.theta, 0)[0] == pytest.approx(plain, abs=1e-8)


def test_rows_far_from_0_are_remarked_with_the_level_by_which_they_are_lowered():
    (remark,) = from_table(plate()._replace(s=plate().s + 25.0), 0.0005).kept.remarks
    assert remark.name == "table-distance"
    assert remark.sentence.endswith("within 0.0005 mm of its rows lowered by 25 mm; subtract that by offset")
    level = from_table(equally_spaced([5.0] * 12), 0.01)
    assert (level.range, level.kept.distance) == ((0.0, 0.0), 5.0)


@pytest.mark.parametrize("level", [25.0, -25.0, 0.0])
@pytest.mark.parametrize("around", [1, -1])
def test_the_distance_of_the_shape_is_that_of_rows_lowered_as_a_whole(level, around):
    """The rows are a cosine, rounded: whatever they are raised by, the motion is as near to its shape."""
    theta = np.radians(np.arange(0.0, 360.0 if around == 1 else 181.0, 5.0))
    waves = np.round(5.0 - 5.0 * np.cos(theta), 3)
    rows = Samples(theta, waves + level, np.arange(len(theta)) + 1)
    kept = from_table(rows, 0.0005, TURN if around == 1 else math.pi, around=around).kept
    assert kept.distance == pytest.approx(abs(level), abs=0.00101)  # the least row is 0 within its reading
    assert kept.lowered == pytest.approx(level, abs=0.00051)
    assert kept.distance_lowered <= 0.00051


# --- few rows ---------------------------------------------------------------------------------------------------------

FEW_ROWS = st.integers(2, 12).flatmap(
    lambda n: st.one_of(
        st.lists(st.integers(0, 40), min_size=n, max_size=n),
        st.lists(st.integers(0, 40), min_size=(n + 1) // 2, max_size=(n + 1) // 2).map(
            lambda half: [*half, *half[::-1][n % 2 :]]
        ),
    )
)


@settings(max_examples=examples(100))
@example([0, 10, 20, 10, 0], True, 0.01, None)
@example([0, 10, 20, 10], False, 0.01, None)
@given(FEW_ROWS, st.booleans(), st.sampled_from([0.01, 0.3, 2.0]), st.sampled_from([None, "dwell", "mirror", "cycle"]))
def test_any_few_rows_are_a_motion_or_refused(s, closed, reading, rest):
    """Symmetric ones too; a motion leaves its rows by its reading, and twice what the least row is above its own."""
    total = TURN if rest is None else math.pi
    theta = np.linspace(0.0, total, len(s), endpoint=closed)
    rows = Samples(theta, np.array(s, dtype=float), np.arange(len(s)) + 1)
    refused = None
    try:
        motion = from_table(rows, reading, rest=rest, suspect="keep")
    except IntentError as error:
        refused = error.message
    if refused is not None:
        assert "\n" not in refused
        return
    assert motion.kept.distance == pytest.approx(off(motion, rows).max(), abs=1e-12)
    assert motion.kept.distance <= (reading + 2.0 * max(min(s) - reading, 0.0)) * (1.0 + 1e-6)


def test_a_heart_cam_of_four_rows():
    """The touched rows are those of both turning points alone: without them a constant is left."""
    rows = Samples(np.radians([0.0, 90.0, 180.0, 270.0, 360.0]), np.array([0.0, 10, 20, 10, 0]), np.arange(5) + 1)
    for suspects in ("keep", "refuse"):
        motion = from_table(rows, 0.01, suspect=suspects)
        assert off(motion, rows).max() <= 0.01
        # by symmetry the least jerk is nearly that of a cosine: through 0.01 and 19.99
        assert motion.derivatives(rad(45), 0)[0, 0] == pytest.approx(10 - 10 / math.sqrt(2), abs=0.1)


# --- what rows leave out ----------------------------------------------------------------------------------------------


def test_what_an_event_leaves_out_of_a_turn_is_a_dwell():
    (rest,) = from_table(event(), 0.0005).rests
    assert np.degrees([rest.begin, rest.end]) == pytest.approx([68, 292], abs=8)


def test_the_rest_of_a_turn_is_mirrored_or_repeated():
    theta = np.radians(np.arange(0.0, 181.0, 3.0))
    half = Samples(theta, np.round(6 * (1 - np.cos(theta)), 3), np.arange(61) + 1)
    x = np.linspace(0, TURN, 100)
    mirrored = from_table(half, 0.0005, rest="mirror").derivatives(x, 0)[0]
    assert mirrored == pytest.approx(6 * (1 - np.cos(x)), abs=2e-3)
    third = np.radians(np.arange(0.0, 120.0, 3.0))
    part = Samples(third, np.round(2 * (1 - np.cos(3 * third)), 3), np.arange(40) + 1)
    closed = Samples(np.append(third, rad(120)), np.append(part.s, 0.0), np.arange(41) + 1)
    for rows in (part, closed):
        repeated = from_table(rows, 0.0005, rest="cycle").derivatives(x, 0)[0]
        assert repeated == pytest.approx(2 * (1 - np.cos(3 * x)), abs=2e-3)


def test_a_dwell_at_the_last_level_fills_the_rest_of_a_turn():
    rows = plate().part(slice(0, 331))
    motion = from_table(rows, 0.0005, rest="dwell")
    assert motion.rests[-1].level == 0.0
    assert math.degrees(motion.rests[-1].end) == pytest.approx(360, abs=1.5)


def test_a_sharp_end_of_the_rows_before_a_filled_rest_is_no_row_that_stands_out():
    """The rows that fill the rest have no line; a motion that does not end level has a corner there, and no bad row."""
    theta = np.radians(np.arange(60.0, 181.0, 2.0))
    rows = Samples(theta, np.round(20 + 15 * np.sin(1.5 * theta - 1.5), 1), np.arange(61) + 1)
    kept = from_table(rows, 0.05, rest="dwell", suspect="keep").kept
    assert "table-row" not in {remark.name for remark in kept.remarks}


def test_equal_rows_at_an_end_that_are_no_dwell_leave_the_end_itself():
    """A slow start of few digits: the motion reaches from end to end though its first run of equal rows is none."""
    theta = np.radians(np.arange(0.0, 181.0, 15.0))
    s = np.array([0, 0, 0, 2, 3, 5, 7, 8, 8, 8, 8, 8, 8], dtype=float)
    motion = from_table(Samples(theta, s, np.arange(13) + 1), 0.5, math.pi, around=None)
    assert motion.motion.knots[[0, -1]].tolist() == [0.0, math.pi]
    assert np.abs(motion.derivatives(theta, 0)[0] - s).max() <= 0.5
    assert motion.derivatives([0.0, math.pi], 1)[1].tolist() == [0.0, 0.0]


# --- what is no motion ------------------------------------------------------------------------------------------------


def broken(change):
    rows = plate()
    theta, s, lines = rows.theta.copy(), rows.s.copy(), rows.lines
    return Samples(*change(theta, s, lines))


def outlier(theta, s, lines):
    s[50] += 0.05
    return theta, s, lines


def back(theta, s, lines):
    theta[50] = theta[48] - 1e-3
    return theta, s, lines


def twice(theta, s, lines):
    theta[50] = theta[49]
    return theta, s, lines


def unfinished(theta, s, lines):
    return theta[:200], s[:200], lines[:200]


def hole(theta, s, lines):
    s[50] = math.nan
    return theta, s, lines


def climbing(theta, s, lines):
    return np.append(theta, TURN), np.append(s, 3.0), np.append(lines, 361)


@pytest.mark.parametrize(
    ("change", "line", "message"),
    [
        (outlier, 51, "the row stands out: it is 10.05 mm, about 10 mm fits the others; "),
        (back, 51, "the angles must rise; 47.94"),
        (twice, 51, "the angles must rise; 49 stands twice, with another displacement"),
        (unfinished, 200, "the table ends after 199 degrees, 17.299 mm off its first row: the rest of the turn can be"),
        (hole, 51, "the displacement is not finite"),
        (climbing, 361, "the motion does not close: 3 mm off the first row, 360 degrees earlier; give this"),
    ],
)
def test_what_is_no_motion_is_refused_with_its_line(change, line, message):
    with pytest.raises(TableError) as caught:
        from_table(broken(change), 0.0005, suspect="refuse")
    assert message in caught.value.message
    assert caught.value.line == line
    assert caught.value.message.startswith(f"line {line}: ")


@pytest.mark.thin(2)
@pytest.mark.parametrize(("unit", "word"), [(1.0, "mm"), (25.4, "in"), (0.0254, "in"), (rad(1), "deg")])
def test_the_reading_that_is_advised_lets_a_table_close(unit, word):
    rows = broken(climbing)._replace(unit=unit)
    rows.s[-1] = 0.123456 * unit
    with pytest.raises(TableError, match=rf"or reading: (\S+) {word}$") as caught:
        from_table(rows._replace(s=rows.s * 1.0), 0.0005 * unit)
    told = (
        float(re.search(r"or reading: (\S+)", caught.value.message)[1]) * {"mm": 1.0, "in": 25.4, "deg": rad(1)}[word]
    )
    assert told < 0.7 * rows.s[-1]
    assert from_table(rows, told, suspect="keep").kept.distance <= told


def test_a_row_that_stands_out_is_followed_or_left_out():
    rows, sound = broken(outlier), plate()
    motion = from_table(rows, 0.0005)
    assert off(motion, rows).max() <= 0.0005
    (remark,) = motion.kept.remarks
    assert remark.name == "table-row"
    assert remark.sentence.startswith("line 51: the row stands out: it is 10.05 mm, about 10 mm fits the others")
    assert remark.sentence.endswith("; mend it, or give suspect: drop")
    dropped = from_table(rows, 0.0005, suspect="drop")
    assert off(dropped, sound).max() <= 0.001
    assert dropped.kept.distance <= 0.0005
    assert dropped.kept.remarks[0].sentence.startswith("line 51: left out, the row stands out")


@pytest.mark.slow
def test_several_rows_that_stand_out_are_all_told():
    rows = broken(outlier)
    rows.s[[250, 200]] = rows.s[[200, 250]]
    rows.s[220:222] = rows.s[[221, 220]]
    motion = from_table(rows, 0.0005)
    told = [re.match(r"line (\d+): ", remark.sentence)[1] for remark in motion.kept.remarks]
    assert sorted(told) == ["201", "221", "251", "51"]
    with pytest.raises(TableError, match=r"stands out too; mend it, or give suspect: keep or drop$"):
        from_table(rows, 0.0005, suspect="refuse")
    assert off(from_table(rows, 0.0005, suspect="drop"), plate()).max() <= 0.001


def test_rows_that_are_written_twice_and_rows_that_fall_are_the_same_table():
    rows = plate()
    plain = from_table(rows, 0.0005).derivatives(rows.theta, 0)[0]
    doubled = Samples(*(np.insert(column, 50, column[50]) for column in rows[:3]))
    falling = rows.part(slice(None, None, -1))
    for other in (doubled, falling):
        assert from_table(other, 0.0005).derivatives(rows.theta, 0)[0] == pytest.approx(plain, abs=1e-9)


def test_a_gap_is_bridged():
    rows = plate()
    keep = np.r_[:50, 53:360]
    part = Samples(rows.theta[keep], rows.s[keep], rows.lines[keep])
    assert off(from_table(part, 0.0005), rows).max() < 1e-3


# --- remarks ----------------------------------------------------------------------------------------------------------


@pytest.mark.thin(2)
@pytest.mark.parametrize("readings", [3.0, 30.0])
def test_noise_beyond_the_digits_is_remarked_with_a_reading_that_calms_it(readings):
    rng = np.random.default_rng(7)
    rows = plate(places=9)
    noisy = rows._replace(s=np.round(rows.s + rng.uniform(-1, 1, 360) * readings * 0.0005, 3))
    (remark,) = from_table(noisy, 0.0005).kept.remarks
    assert remark.name == "table-noise"
    told = float(re.search(r"reading: (\S+) mm", remark.sentence)[1])
    assert readings * 0.0005 / 4 < told <= 0.0005 * 4 * max(4, readings)
    calm = from_table(noisy, told)
    assert calm.kept.remarks == ()
    peaks = [np.abs(motion.derivatives(rows.theta, 2)[2]).max() for motion in (calm, from_table(noisy, 0.0005), PLATE)]
    assert peaks[0] < 1.15 * peaks[2] < peaks[1]


def scattered(count, scatter):
    """The plate's rows, off by as much at random."""
    rows = plate(count, places=9)
    return rows._replace(s=np.round(rows.s + np.random.default_rng(5).uniform(-scatter, scatter, count), 3))


@pytest.fixture
def short_search(monkeypatch):
    monkeypatch.setattr("kin.law.sources.least_jerk._MOST_WORK", 5e8)


@pytest.mark.thin(4)
@pytest.mark.usefixtures("short_search")
@pytest.mark.parametrize(("around", "scatter"), [(1, 0.01), (1, 0.5), (-1, 0.01), (None, 0.01)])
def test_rows_that_scatter_too_far_to_be_followed_are_refused_with_a_reading_that_does(around, scatter):
    rows = scattered(1200, scatter)
    if around != 1:  # a rise from 0, with both ends where they belong
        theta = np.linspace(0.0, TURN, 1200)
        s = 5.0 * (theta - np.sin(theta)) + np.random.default_rng(5).uniform(-scatter, scatter, 1200)
        s[0], s[-1] = 0.0, 5.0 * TURN
        rows = rows._replace(theta=theta, s=s)
    with pytest.raises(IntentError, match=r"rows scatter too far beyond their reading, 0\.0005 mm") as caught:
        from_table(rows, 0.0005, around=around)
    told = float(re.search(r"give reading: (\S+) mm, or fewer rows$", caught.value.message)[1])
    assert scatter / 2 < told <= 3 * scatter
    motion = from_table(rows, told, around=around)
    assert len(motion.motion.functions) < 200
    from_table(rows.part(slice(None, None, 11 if around != 1 else 12)), 0.0005, around=around, suspect="keep")


@pytest.mark.usefixtures("short_search")
def test_rows_about_no_curve_are_refused_and_means_of_them_are_a_motion():
    rows = plate(3000)._replace(s=np.random.default_rng(5).uniform(0, 10, 3000))
    with pytest.raises(IntentError, match=r"lie about no smooth curve; .* write means of successive rows$"):
        from_table(rows, 0.0005)
    theta, s = (column.reshape(60, 50).mean(axis=1) for column in (rows.theta, rows.s))
    means = Samples(theta, s - s.min(), np.arange(60) + 1)
    assert off(from_table(means, 0.0005), means).max() <= 0.0005


def test_a_distance_of_more_than_a_hundredth_of_the_stroke_is_remarked():
    (remark,) = from_table(plate(24, 0), 0.5).kept.remarks
    assert remark.name == "table-distance"
    assert "by up to 0.5 mm, 2.5 % of the stroke" in remark.sentence
    assert from_table(plate(24, 1), 0.05).kept.remarks == ()


@pytest.mark.thin(3)
@pytest.mark.parametrize(("end", "word"), [(2 * math.pi, "radians"), (1.0, "turns"), (100.0, "percent")])
def test_angles_that_are_hardly_degrees_are_remarked_with_what_they_may_be(end, word):
    theta = np.radians(np.linspace(0, end, 61))
    rows = Samples(theta, np.round(3 - 3 * np.cos(np.linspace(0, TURN, 61)), 3), np.arange(61) + 1)
    names = [remark for remark in from_table(rows, 0.0005).kept.remarks if remark.name == "table-angles"]
    assert [f"give angle: {word}" in remark.sentence for remark in names] == [True]


def test_angles_over_less_than_a_quarter_of_the_turn_are_remarked():
    theta = np.radians(np.arange(0.0, 73.0, 3.0))
    rows = Samples(theta, np.round(3 - 3 * np.cos(5 * theta), 3), np.arange(25) + 1)
    assert "cover 72 degrees" in from_table(rows, 0.0005).kept.remarks[0].sentence
    assert from_table(event(), 0.0005).kept.remarks == ()


# --- rounded angles ---------------------------------------------------------------------------------------------------


def test_angles_that_were_rounded_add_their_slope_to_the_reading():
    degrees = np.arange(54) * 360 / 54
    s = PLATE.derivatives(np.radians(degrees), 0)[0]
    text = "\n".join(f"{x:.1f};{y:.3f}" for x, y in zip(degrees, s, strict=True))
    rows = read_table(text)
    assert math.degrees(rows.slack) == pytest.approx(0.05)
    motion = from_table(rows, None)
    theta = np.linspace(0, TURN, 2000)
    peak = np.abs(PLATE.derivatives(theta, 2)[2]).max()
    assert np.abs(motion.derivatives(theta, 2)[2]).max() < 1.15 * peak
    exact = read_table("\n".join(f"{x};{y}" for x, y in ((0, 0), (10, 1), (20, 3), (30, 2))))
    assert exact.slack == 0.0


def test_a_truncated_table_takes_a_whole_digit():
    theta = np.radians(np.arange(0.0, 360.0, 2.0))
    rows = Samples(theta, np.floor(PLATE.derivatives(theta, 0)[0] * 100 + 1e-9) / 100, np.arange(180) + 1)
    x = np.linspace(0, TURN, 2000)
    peak = np.abs(PLATE.derivatives(x, 2)[2]).max()
    assert np.abs(from_table(rows, 0.01).derivatives(x, 2)[2]).max() < 1.1 * peak


def test_a_table_goes_from_text_to_motion():
    rows = event()
    text = "\n".join(f"{2 * math.degrees(t):.1f};{s:.3f}" for t, s in zip(rows.theta, rows.s, strict=True))
    found = read_table(text.replace(".", ","), Sheet("length", angle="crank"))
    assert found.rounding == pytest.approx(0.0005)
    theta = np.mod(rows.theta, TURN)
    expected = from_table(rows, 0.0005).derivatives(theta, 2)
    assert from_table(found, None).derivatives(theta, 2) == pytest.approx(expected, abs=1e-6)


@pytest.mark.slow
def test_a_row_of_few_digits_does_not_stand_out_for_them():
    """A quantised slope: less than three readings off its neighbours."""
    theta = np.radians(np.arange(0.0, 360.0, 2.0))
    rows = Samples(theta, np.round(0.1 - 0.1 * np.cos(theta), 2), np.arange(180) + 1)
    for k in range(20):
        s = np.roll(rows.s, k)
        s[60 + k] += 0.01
        assert from_table(rows._replace(s=s), 0.005).kept.distance <= 0.005


def test_rows_that_are_one_row_many_times_are_no_table():
    rows = Samples(np.full(5, 0.3), np.full(5, 2.0), np.arange(5) + 1)
    with pytest.raises(IntentError, match="a table has at least 4 rows, not 1"):
        from_table(rows, 0.01)


def test_a_rest_that_there_is_not_is_refused():
    third = np.radians(np.arange(0.0, 100.0, 3.0))
    part = Samples(third, np.round(2 * (1 - np.cos(3 * third)), 3), np.arange(34) + 1)
    for rows, rest, message in (
        (plate(), "cycle", "the rows cover the turn: there is no rest of it"),
        (plate(), "dwell", "the rows cover the turn"),
        (part, "cycle", "a cycle of the rows is neither 99 nor 102 degrees, of which a whole number fill the turn"),
        (part, "mirror", "rows that are mirrored cover 180 degrees, not 99"),
    ):
        with pytest.raises(IntentError, match=message) as caught:
            from_table(rows, 0.0005, rest=rest)
        assert caught.value.field == "motion.table.rest"
    with pytest.raises(IntentError, match="the rest of a turn is that of a motion that repeats with it"):
        from_table(plate().part(slice(0, 181)), 0.0005, math.pi, around=-1, rest="dwell")


# --- open ends --------------------------------------------------------------------------------------------------------


def sampled(law, total, step=1.0, places=6):
    """Rows of a law, a function for mpmath of a length, rounded as a table has them."""
    x = np.arange(round(total / step) + 1) * step
    s = np.array([float(mpmath.nstr(law(mpmath.mpf(float(at))), 40)) for at in x])
    return Samples(x, np.round(s, places), np.arange(len(x)) + 2, rounding=0.5 * 10.0**-places)


def wavy(x):
    return 2 + x / 40 + mpmath.mpf("1.5") * mpmath.sin(x / 17)


@pytest.mark.thin(3)
@pytest.mark.parametrize(
    ("law", "total"),
    [
        (wavy, 100.0),
        (lambda x: 3 * mpmath.exp(-x / 30), 80.0),
        (lambda x: 4 * mpmath.sin(mpmath.pi * x / 160) ** 2, 160.0),
        (lambda x: x / 25, 50.0),
        (lambda x: (x / 20 - 1) ** 2, 60.0),
        (lambda x: mpmath.mpf(4) * mpmath.fabs(x / 50 - 1) ** 5, 90.0),
    ],
)
def test_a_law_over_a_length_is_followed_within_its_digits_to_both_ends(law, total):
    """Value, velocity and acceleration at ends that are not at rest, against the law and its derivatives."""
    rows = sampled(law, total)
    motion = from_table(rows, None, total, around=None, open_ends=True)
    least = motion.kept.lowered
    reading = max(5e-7, 1e-7 * float(np.ptp(rows.s)))
    assert np.abs(motion.derivatives(rows.theta, 0)[0] + least - rows.s).max() <= reading * 1.0001
    assert motion.range[0] == pytest.approx(0.0, abs=1e-9)
    assert motion.around is None
    x = np.linspace(0.0, total, 401)
    true = [[float(mpmath.diff(law, mpmath.mpf(float(at)), k)) for at in x] for k in (1, 2)]
    true.insert(0, [float(law(mpmath.mpf(float(at)))) for at in x])
    found = motion.derivatives(x, 2, np.where(x < total, 1, -1)) - np.array(true)
    found[0] += least
    off = np.abs(found)
    assert (off.max(axis=1) <= [2.0 * reading, 3e-6, 6e-6]).all()


def test_dwells_of_a_motion_with_open_ends_are_level():
    """One at its beginning, one within; it ends on a rise, whose velocity is kept."""
    bend = mpmath.mpf("0.0004")

    def law(x):
        return bend * max(x - 20, 0) ** 3 if x <= 50 else bend * (30**3 + max(x - 90, 0) ** 3)

    rows = sampled(law, 120.0, places=4)
    rows = rows._replace(s=np.where((rows.theta > 50) & (rows.theta <= 90), rows.s[50], rows.s))
    motion = from_table(rows, None, 120.0, around=None, open_ends=True)
    (begin, end, level), (_, _, middle) = motion.rests
    assert (begin, level) == (0.0, 0.0)
    assert end == pytest.approx(20.0, abs=3.0)
    assert middle == pytest.approx(10.8)
    assert motion.at_end(1)[1] == pytest.approx(3 * 0.0004 * 30**2, rel=1e-2)
    assert motion.joints == () or min(joint.jumps[0][0] for joint in motion.joints) > 1
    assert motion.kept.distance <= 5e-5


def test_a_motion_with_open_ends_that_rests_at_both_is_a_law():
    """No row is far from the table's own law, and both dwells reach the ends."""
    rows = plate(361, 4)
    theta = np.linspace(0.0, 200.0, 201)
    law = named("cycloidal").motion
    u = np.clip((theta - 30.0) / 120.0, 0.0, 1.0)
    rows = Samples(theta, np.round(15.0 * law.derivatives(u, 0)[0], 4), np.arange(201) + 1, rounding=5e-5)
    motion = from_table(rows, None, 200.0, around=None, open_ends=True)
    assert [(rest.begin, rest.end) for rest in motion.rests] == [
        pytest.approx((0.0, 30.0), abs=2.0),
        pytest.approx((150.0, 200.0), abs=2.0),
    ]
    assert off(motion, rows, math.inf).max() <= 5e-5
    fine = np.linspace(0.0, 200.0, 2001)
    true = 15.0 * law.derivatives(np.clip((fine - 30.0) / 120.0, 0.0, 1.0), 0)[0]
    assert np.abs(motion.derivatives(fine, 0)[0] - true).max() <= 2e-4


@pytest.mark.thin(3)
@pytest.mark.parametrize("place", [3, 4, 40, 96, 97])
def test_a_row_that_is_off_is_named_near_open_ends_too(place):
    rows = sampled(wavy, 100.0, places=4)
    s = rows.s.copy()
    s[place] += 0.01
    with pytest.raises(TableError) as caught:
        from_table(rows._replace(s=s), None, 100.0, around=None, open_ends=True, suspect="refuse")
    assert caught.value.line == rows.lines[place]
    assert "fits the others" in caught.value.message
    made = from_table(rows._replace(s=s), None, 100.0, around=None, open_ends=True, suspect="drop")
    assert [remark.name for remark in made.kept.remarks] == ["table-row", "table-distance"]
    sound = from_table(rows, None, 100.0, around=None, open_ends=True)
    x = np.linspace(0.0, 100.0, 999)
    assert np.abs(made.derivatives(x, 0)[0] - sound.derivatives(x, 0)[0]).max() <= 2e-4


@pytest.mark.slow
@pytest.mark.parametrize("step", [1.0, 2.5, 5.0])
@pytest.mark.parametrize("places", [3, 5])
def test_no_row_of_a_sound_table_with_open_ends_stands_out(step, places):
    for law in (wavy, lambda x: 3 * mpmath.exp(-x / 12), lambda x: x**4 / 2**22, lambda x: 2 * mpmath.cos(x / 8)):
        rows = sampled(law, 100.0, step, places)
        remarks = from_table(rows, None, 100.0, around=None, open_ends=True).kept.remarks
        assert "table-row" not in [remark.name for remark in remarks]


def in_mm(caught):
    return in_unit(caught.value.message, 1.0, "mm", travel=True)


@pytest.mark.parametrize(
    ("x", "s", "problem", "mended"),
    [
        (
            [5, 10, 15, 20, 25],
            [0, 1, 2, 4, 5],
            "line 1: the lengths begin at 5, not at 0; make every length 5 mm less",
            0,
        ),
        ([0, 10, 8, 20, 25], [0, 1, 2, 4, 5], "line 3: the lengths must rise; 8 follows 10", None),
        ([0, 10, 10, 20, 25], [0, 1, 2, 4, 5], "line 3: the lengths must rise; 10 stands twice, with another", None),
        ([0, 10, 20], [0, 1, 2], "a table has at least 4 rows, not 3", None),
        ([0, 10, math.nan, 30, 40], [0, 1, 2, 3, 4], "line 3: the length is not finite", None),
    ],
)
def test_what_is_no_table_over_a_length_is_refused_with_its_line(x, s, problem, mended):
    rows = Samples(np.array(x, dtype=float), np.array(s, dtype=float), np.arange(len(x)) + 1, rounding=0.5)
    total = float(np.nanmax(rows.theta) - np.nanmin(rows.theta))
    with pytest.raises(IntentError) as caught:
        from_table(rows, None, total, around=None, open_ends=True)
    assert problem in in_mm(caught)
    if mended is not None:
        from_table(rows._replace(theta=rows.theta - x[0]), None, total, around=None, open_ends=True)


def test_a_period_of_a_length_closes_or_names_the_row_that_does_not():
    x = np.arange(41.0)
    s = np.round(5 - 5 * np.cos(2 * math.pi * x / 40), 5)
    rows = Samples(x, s, np.arange(41) + 2, rounding=5e-6)
    motion = from_table(rows, None, 40.0)
    fine = np.linspace(0.0, 40.0, 999)
    assert np.abs(motion.derivatives(fine, 0)[0] - (5 - 5 * np.cos(2 * math.pi * fine / 40))).max() <= 1e-5
    assert motion.joints == ()
    s[-1] = 0.5
    with pytest.raises(TableError) as caught:
        from_table(rows._replace(s=s), None, 40.0)
    assert in_mm(caught).startswith(
        "line 42: the motion does not close: 0.5 mm off the first row, 40 mm earlier; give this"
    )
