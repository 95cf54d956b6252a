"""Tables kept within their reading error; what is no table is refused with its line.

Holds: kin.law.sources.dwells.
"""

import math
import re

import numpy as np
import pytest

from kin.law.programme import IntentError
from kin.law.sources.laws import named
from kin.law.sources.lobe import lobe
from kin.law.sources.programme import Dwell, Move, programme
from kin.law.sources.ring import Samples
from kin.law.sources.table import from_table
from kin.law.sources.tabled import TableError
from kin.law.support_function import lift_constant_breadth
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


def test_a_sharp_end_of_the_rows_before_a_filled_rest_is_told_by_their_lines():
    """The rows that fill the rest have no line; a motion that does not end level is sharp at them."""
    theta = np.radians(np.arange(60.0, 181.0, 2.0))
    rows = Samples(theta, np.round(20 + 15 * np.sin(1.5 * theta - 1.5), 1), np.arange(61) + 1)
    kept = from_table(rows, 0.05, rest="dwell", suspects="keep").kept
    told = [remark.sentence for remark in kept.remarks if remark.name == "table-row"]
    assert [re.match(r"line (\d+): the row stands out", sentence)[1] for sentence in told] == ["1"]


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
        (climbing, 361, "the motion does not close: 3 mm off the first row, a turn later; give this row"),
    ],
)
def test_what_is_no_motion_is_refused_with_its_line(change, line, message):
    with pytest.raises(TableError) as caught:
        from_table(broken(change), 0.0005)
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
    assert from_table(rows, told, suspects="keep").kept.distance <= told


def test_a_row_that_stands_out_may_be_kept():
    rows = broken(outlier)
    motion = from_table(rows, 0.0005, suspects="keep")
    assert off(motion, rows).max() <= 0.0005
    (remark,) = motion.kept.remarks
    assert remark.name == "table-row"
    assert remark.sentence.startswith("line 51: the row stands out")


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
    from_table(rows.part(slice(None, None, 11 if around != 1 else 12)), 0.0005, around=around, suspects="keep")


@pytest.mark.usefixtures("short_search")
def test_rows_about_no_curve_are_refused_and_means_of_them_are_a_motion():
    rows = plate(3000)._replace(s=np.random.default_rng(5).uniform(0, 10, 3000))
    with pytest.raises(IntentError, match=r"lie about no smooth curve; .* write means of successive rows$"):
        from_table(rows, 0.0005)
    theta, s = (column.reshape(60, 50).mean(axis=1) for column in (rows.theta, rows.s))
    means = Samples(theta, s, np.arange(60) + 1)
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
    rows, place = read_table(text)
    assert math.degrees(rows.slack) == pytest.approx(0.05)
    motion = from_table(rows, 0.5 * place)
    theta = np.linspace(0, TURN, 2000)
    peak = np.abs(PLATE.derivatives(theta, 2)[2]).max()
    assert np.abs(motion.derivatives(theta, 2)[2]).max() < 1.15 * peak
    exact, _ = read_table("\n".join(f"{x};{y}" for x, y in ((0, 0), (10, 1), (20, 3), (30, 2))))
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
    found, unit = read_table(text.replace(".", ","), Sheet("length", angle="crank"))
    assert unit == 0.001
    theta = np.mod(rows.theta, TURN)
    expected = from_table(rows, 0.0005).derivatives(theta, 2)
    assert from_table(found, 0.5 * unit).derivatives(theta, 2) == pytest.approx(expected, abs=1e-6)


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
