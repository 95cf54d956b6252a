"""Tables of sound laws rounded to their own last digit: none is refused, and the motion made stays within its rows."""

import math

import numpy as np
import pytest

from kin.law.sources.laws import named
from kin.law.sources.programme import Dwell, Move, programme
from kin.law.sources.ring import Samples
from kin.law.sources.smoothing import TableError
from kin.law.sources.table import from_table

TURN = 2 * math.pi
rad = math.radians


def law(shape):
    name, back, stroke, up, top, down = shape
    rest = 360.0 - up - top - down
    moves = [Move(rad(up), named(name), by=stroke), Move(rad(down), named(back), by=-stroke)]
    steps = [moves[0], *([Dwell(rad(top))] if top else []), moves[1], *([Dwell(rad(rest))] if rest > 1e-9 else [])]
    return programme(steps, TURN)


def table(motion, step, places):
    theta = np.radians(np.arange(0.0, 360.0, step))
    return Samples(theta, np.round(motion.derivatives(theta, 0)[0], places), np.arange(len(theta)) + 1)


def off(motion, rows):
    """Greatest distance from the rows of the motion that is made: less its least value."""
    return np.abs(motion.from_lowest().derivatives(rows.theta, 0)[0] - rows.s).max()


def accelerations(motion):
    return [math.degrees(joint.at) % 360 for joint in motion.joints if joint.jumps[0][0] == 2]


QUICK = [
    ("cubic", "cubic", 10.0, 100, 0, 121, 1, 4, 0.0005),
    ("cycloidal", "cycloidal", 24.93, 200.8, 0, 159.2, 1, 3, 0.0005),
    ("cycloidal", "cycloidal", 14.39, 181.2, 0, 178.8, 1, 3, 0.0005),
    ("harmonic", "harmonic", 21.175, 67.66, 25.01, 93.72, 1, 4, 0.00005),
    ("polynomial-4567", "polynomial-4567", 22.578, 126.2, 0, 233.8, 2, 4, 0.00005),
]
SLOW = [
    ("parabolic", "scca-33", 38.217, 130.2, 0, 229.8, 2, 3, 0.0005),
    ("modified-sine", "polynomial-4567", 11.324, 146.7, 0, 213.3, 2, 3, 0.0005),
    ("scca-20", "polynomial-4567", 37.023, 115.5, 0, 244.5, 1, 3, 0.0005),
    ("freudenstein-13", "freudenstein-13", 19.218, 192.5, 0, 167.5, 1, 4, 0.00005),
    ("polynomial-23", "polynomial-23", 5.155, 108.45, 50.41, 114.92, 2, 4, 0.00005),
    ("scca-20", "harmonic", 16.969, 65.62, 41.98, 75.62, 1, 3, 0.0005),
    ("freudenstein-135", "modified-trapezoid", 21.964, 85.47, 40.91, 118.0, 1, 4, 0.00005),
    ("gutman-13", "gutman-13", 6.011, 83.14, 40.22, 97.22, 1, 3, 0.0005),
    ("modified-trapezoid", "modified-trapezoid", 32.383, 152.4, 0, 207.6, 1, 3, 0.0005),
]


@pytest.mark.thin(40)
@pytest.mark.parametrize("case", [*QUICK, *(pytest.param(case, marks=pytest.mark.slow) for case in SLOW)], ids=str)
def test_a_sound_table_is_smoothed_within_its_reading(case):
    *shape, step, places, reading = case
    rows = table(law(shape), step, places)
    smoothed = from_table(rows, reading)
    assert smoothed.motion.demand_joined()
    assert off(smoothed.motion, rows) <= reading * (1 + 1e-6)


@pytest.mark.slow
def test_a_jump_of_the_acceleration_is_a_joint():
    """Nothing else than the acceleration jumps in the middle of both strokes."""
    rows = table(law(("cubic", "cubic", 10.0, 100, 0, 121)), 1, 4)
    found = accelerations(from_table(rows, 0.0005).motion)
    assert found == pytest.approx([50, 160.5], abs=0.1)


@pytest.mark.slow
def test_the_acceleration_jumps_where_a_dwell_ends_between_rows():
    motion = law(("harmonic", "harmonic", 21.175, 67.66, 25.01, 93.72))
    found = from_table(table(motion, 1, 4), 0.00005).motion
    assert accelerations(found) == pytest.approx([0, 67.66, 92.67, 186.39], abs=0.02)
    assert [rest.level for rest in found.rests] == pytest.approx([21.175, 0], abs=1e-12)


@pytest.mark.slow
@pytest.mark.thin(3)
@pytest.mark.parametrize("row", [18, 49, 130])
def test_a_row_that_stands_out_of_a_law_with_jumps_is_refused(row):
    rows = table(law(("cubic", "cubic", 10.0, 100, 0, 121)), 1, 4)
    rows.s[row] += 20 * 0.0005
    with pytest.raises(TableError) as caught:
        from_table(rows, 0.0005)
    assert caught.value.line == row + 1


PLATE = ("modified-sine", "modified-sine", 20.0, 100, 60, 140)
SHORT = ("cycloidal", "cycloidal", 12.0, 60, 14, 90)
MIXED = ("polynomial-345", "modified-trapezoid", 14.933, 70, 37, 83)


@pytest.mark.thin(40)
@pytest.mark.parametrize(
    ("shape", "step", "row"),
    [
        *((PLATE, 1, row) for row in (1, 33, 70, 98, 102, 103, 115, 130, 157, 161, 200, 299, 303, 330, 357)),
        *((MIXED, 2, row) for row in (17, 34, 36, 40, 44, 49, 60, 96, 100, 140, 178)),
        *((SHORT, 2, row) for row in (12, 31, 33, 35, 50, 83, 130)),
    ],
    ids=str,
)
def test_a_row_that_stands_out_is_refused_wherever_it_is(shape, step, row):
    """In strokes, at the ends of dwells and inside them; twenty readings off."""
    rows = table(law(shape), step, 3)
    rows.s[row] += 20 * 0.0005
    with pytest.raises(TableError) as caught:
        from_table(rows, 0.0005)
    assert caught.value.line == row + 1


@pytest.mark.thin(2)
@pytest.mark.parametrize(
    ("shape", "step", "row", "last"),
    [
        (PLATE, 1, 30, 80),
        (PLATE, 1, 99, 130),
        (PLATE, 1, 115, 130),
        (PLATE, 1, 157, 200),
        (PLATE, 1, 320, 340),
        (MIXED, 2, 44, 84),
        (MIXED, 2, 20, 60),
        (SHORT, 2, 34, 60),
    ],
    ids=str,
)
def test_a_step_is_refused_wherever_it_is(shape, step, row, last):
    rows = table(law(shape), step, 3)
    rows.s[row:last] += 60 * 0.0005
    with pytest.raises(TableError) as caught:
        from_table(rows, 0.0005)
    assert caught.value.line in {row + 1, last + 1}


def test_two_levels_that_no_row_joins_are_a_step():
    rows = table(law(PLATE), 1, 3)
    rows.s[130:161] += 60 * 0.0005
    with pytest.raises(TableError, match=r"line 131: the displacement steps from 20 mm to 20\.03 mm here"):
        from_table(rows, 0.0005)
