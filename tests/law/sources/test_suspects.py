"""Rows that stand out, whether or not a motion repeats; corners, noise and few rows name none."""

import math

import numpy as np
import pytest

from kin.law.sources.laws import named
from kin.law.sources.programme import Dwell, Move, programme
from kin.law.sources.ring import Samples
from kin.law.sources.suspects import nearest, suspects
from kin.law.sources.tabled import tabled

TURN = 2 * math.pi
READING = 0.0005


def rows_of(values, total=TURN, *, closed=False, rounding=READING):
    theta = np.linspace(0.0, total, len(values), endpoint=closed)
    return Samples(theta, np.array(values, dtype=float), np.arange(len(values)) + 1, rounding=rounding)


def standing(rows, total=TURN, around=1, reading=READING):
    """Lines of rows that stand out, and values that fit there."""
    layout = tabled(rows, reading, total, around, rest=None, field="motion")
    plain, raised = nearest(layout)
    return {
        int(layout.lines[place]): value
        for found in suspects(layout, plain, noisy=raised is not None)
        for place, value in zip(found.rows, found.expected, strict=True)
    }


def wave(count, total=TURN, *, closed=False):
    theta = np.linspace(0.0, total, count, endpoint=closed)
    return np.round(10 - 10 * np.cos(theta), 3)


@pytest.mark.parametrize(
    ("around", "total", "place"), [(1, TURN, 40), (1, TURN, 0), (-1, math.pi, 40), (-1, math.pi, 1)]
)
def test_a_wrong_row_is_named_with_what_fits_there(around, total, place):
    closed = around == -1
    values = wave(120, total, closed=closed)
    sound = values[place]
    values[place] += 0.05
    assert standing(rows_of(values, total, closed=closed), total, around) == {
        place + 1: pytest.approx(sound, abs=0.002)
    }


@pytest.mark.parametrize("place", [1, 30, 59])
def test_so_is_one_of_a_motion_that_rests_at_its_ends(place):
    law = programme([Move(TURN, named("cycloidal"), by=10.0)], TURN, around=None)
    values = np.round(law.derivatives(np.linspace(0.0, TURN, 61), 0)[0], 3)
    sound = values[place]
    values[place] += 0.05
    assert standing(rows_of(values, closed=True), around=None) == {place + 1: pytest.approx(sound, abs=0.002)}


@pytest.mark.parametrize("place", [17, 119])
def test_rows_that_were_swapped_are_named_together(place):
    values = wave(120)
    later = (place + 1) % 120
    values[[place, later]] = values[[later, place]]
    assert set(standing(rows_of(values))) == {place + 1, later + 1}


def test_a_corner_noise_and_few_rows_name_none():
    lash = np.maximum(wave(120) - 0.3, 0.0)
    scattered = wave(120) + np.round(np.random.default_rng(3).uniform(-0.02, 0.02, 120), 3)
    slipped = wave(11)
    slipped[4] += 2.0
    law = programme(
        [
            Move(2.0, named("constant-velocity"), by=10.0),
            Dwell(1.0),
            Move(2.0, named("parabolic"), by=-10.0),
            Dwell(TURN - 5),
        ],
        TURN,
    )
    jumps = np.round(law.derivatives(np.arange(90) * TURN / 90, 0)[0], 3)
    assert [standing(rows_of(values)) for values in (lash, scattered, slipped, jumps)] == [{}] * 4


def test_a_row_of_fewer_digits_stands_out_of_none_but_beyond_them():
    """The row 10 of a table to four significant digits: 10.0009 as well as 9.996 is written so."""
    values = wave(120)
    rounding = np.full(120, READING)
    place = 31
    rounding[place] = 0.05
    for off, lines in ((0.04, []), (0.6, [place + 1])):
        assert list(standing(rows_of(values + off * (np.arange(120) == place), rounding=rounding))) == lines
