"""Series of motions: what they reach, and how they are cut."""

import math

import numpy as np
import pytest
from support.drives import Harmonic, Saw
from support.dynamics_oracle import Cycloid

from kin.dynamics.drive import Drive, DriveError, drives, lowest
from kin.numeric.chebyshev import DEGREE, NODES, evaluated

TURN = 2.0 * math.pi


class Cusp:
    """|sin|^1.5, whose acceleration has no bound at a place that is not declared."""

    breaks = np.empty(0)
    smooth = True

    def rows(self, phi):
        w = np.sin(phi - 1.0)
        c = np.cos(phi - 1.0)
        a = np.abs(w)
        return np.stack([a**1.5, 1.5 * a**0.5 * np.sign(w) * c, 0.75 * a**-0.5 * c * c - 1.5 * a**1.5])


def values(drive, phi):
    """Position, velocity and acceleration (3, n) at shaft angles."""
    stretch = np.array([drive.find(angle) for angle in phi])
    x = (phi - drive.knots[stretch]) / drive.half[stretch] - 1.0
    return np.stack([evaluated(series, stretch, x) for series in (drive.position, drive.velocity, drive.acceleration)])


def test_an_undeclared_cusp_is_refused_with_its_place():
    with pytest.raises(DriveError, match=r"not better near (57\.3|237\.3|57\.2|237\.2)"):
        drives([Cusp()])


def test_a_split_drive_is_the_same_motion():
    (drive,) = drives([Harmonic(5), Cycloid(1.0, 1.0)][:1], also=[0.123])
    parts = np.arange(len(drive)) % 4 + 1
    cut = drive.split(parts)
    assert len(cut) == parts.sum()
    phi = np.linspace(0.001, 6.28, 301)
    rows = [values(d, phi) for d in (drive, cut)]
    assert np.abs(rows[0] - rows[1]).max() < 1e-12
    assert 0.123 in drive.knots
    assert 0.123 in cut.knots
    scaled = cut.scaled(3.0)
    assert isinstance(scaled, Drive)
    assert scaled.acceleration == pytest.approx(3.0 * cut.acceleration)


def test_the_least_value_lies_between_any_places():
    """cos 5 phi at pi/5, -sin/(2 + cos) where its slope vanishes, cos = -1/2; at a jump the lower limit counts."""
    (drive,) = drives([Harmonic(5)], also=[0.6, 0.7])
    assert lowest(drive.knots, [drive.position], lambda row: row[0])[0] == pytest.approx(-1.0, abs=1e-14)
    (drive,) = drives([Harmonic(1)])
    rows = drive.position, drive.velocity
    value, at = lowest(drive.knots, rows, lambda row: row[1] / (2.0 + row[0]))
    assert value == pytest.approx(-1.0 / math.sqrt(3.0), rel=1e-15)
    assert at == pytest.approx(math.radians(120.0), abs=1e-7)
    (saw,) = drives([Saw()])
    assert lowest(saw.knots, [saw.velocity], lambda row: row[0])[0] == pytest.approx(-1.0, abs=1e-14)


def test_series_reach_the_degree():
    assert NODES.shape == (DEGREE + 1,)
    (drive,) = drives([Harmonic(3)])
    assert drive.position.shape == (len(drive), DEGREE + 1)
