"""A motion of positions alone is told as dwells and strokes, and written as segments.

Holds: camgeo.motions.recognised, kin.follower.recognised.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import pytest

from camgeo.motions.recognised import STROKES_BEGIN, Recognised, roundest
from kin.follower.recognised import recognised

TURN = 2.0 * math.pi


@dataclass
class Told:
    """Positions at equal steps of a turn."""

    position: np.ndarray
    sd: float = 0.001
    spans: int = 360
    span: float = TURN
    closed: bool = True
    zero_ends: bool = False

    @property
    def turn(self):
        return self.position

    @property
    def shaft(self):
        return np.arange(len(self.position)) * (TURN / len(self.position))

    @property
    def last(self):
        return float(self.position[0])

    def alike(self, most):
        return tuple(range(1, most + 1))


def motion(lead: float) -> Told:
    """A cycloidal rise by 12 over 90 degrees, 50 degrees of rest, a harmonic return over 130; it begins at `lead`."""
    at = np.mod(np.arange(720) * 0.5 + lead, 360.0)
    u, v = np.clip(at / 90.0, 0.0, 1.0), np.clip((at - 140.0) / 130.0, 0.0, 1.0)
    return Told(3.0 + 12.0 * (u - np.sin(TURN * u) / TURN) - 6.0 * (1.0 - np.cos(math.pi * v)))


@pytest.mark.slow
def test_segments_are_those_of_the_motion():
    told = motion(0.0)
    programme = recognised(told, 0.01, "mm")
    known = Recognised(told, programme, 0.02, 1.0, "mm")
    assert known.segments() == (
        [
            {"rise": 12.0, "over": 90.0, "law": "cycloidal"},
            {"dwell": 50.0},
            {"return": 12.0, "over": 130.0, "law": "harmonic"},
            {"dwell": 90.0},
        ],
        "",
    )
    assert known.zero == pytest.approx(3.0, abs=1e-6)
    first, second = known.lines()
    assert first.startswith("stroke 1: 12 +- ")
    assert "harmonic leaves" in second


@pytest.mark.costly("all laws are tried on each stroke")
def test_a_turn_that_begins_in_a_stroke_has_none():
    told = motion(45.0)
    known = Recognised(told, recognised(told, 0.01, "mm"), 0.02, 1.0, "mm")
    assert known.segments() == (None, STROKES_BEGIN)


@pytest.mark.slow
def test_laws_that_leave_more_than_may_be_are_none():
    told = motion(0.0)
    told.position += 0.1 * np.sin(9.0 * told.shaft)
    programme = recognised(told, 0.15, "mm")
    segments, why = Recognised(told, programme, 0.02, 1.0, "mm").segments()
    assert segments is None
    assert why.startswith("the laws that fit best leave 0.")


@pytest.mark.parametrize(
    ("value", "unsure", "round_"),
    [(39.998, 0.01, 40.0), (39.998, 0.001, 39.998), (0.03012, 0.0005, 0.03), (1.23456789, 0.0, 1.2346)],
)
def test_numbers_are_as_round_as_they_are_known(value, unsure, round_):
    assert roundest(value, unsure) == pytest.approx(round_)
