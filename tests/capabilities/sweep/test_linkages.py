"""Loops of many linkages against the loop closed by hand."""

from __future__ import annotations

import numpy as np
import pytest

from camgeo.capabilities.sweep.linkages import FourBarLoop, Lengths, SliderLoop, Support, angles

N = 360
T = angles(N)
SINE, COSINE = np.sin(3 * T)[None], np.cos(3 * T)[None]
CAM = Support(np.full((1, 1), 50.0), 25 + SINE, 3 * COSINE, -9 * SINE)


def lengths(**values: float) -> Lengths:
    return Lengths(*(np.full((1, 1), values.get(name, 0.0)) for name in Lengths._fields))


def slope(values: np.ndarray) -> np.ndarray:
    """Derivative by the angle, from harmonics of the samples."""
    return np.fft.irfft(1j * np.arange(N // 2 + 1) * np.fft.rfft(values), N)


def test_a_four_bar_closes_and_its_rates_are_derivatives() -> None:
    loop = FourBarLoop.from_lengths(1.0, CAM, lengths(ground=80.0, coupler=70.0, rocker=105.0))
    # triangle of A, the rocker's pivot and D: AD^2 = r1^2 + r4^2 - 2 r1 r4 cos(theta_4)
    square = (50.0 + 70.0 - np.roll(CAM.p[0], -N // 4)) ** 2 + (CAM.p[0] - 25.0) ** 2
    cosine = (80.0**2 + 105.0**2 - square) / (2.0 * 80.0 * 105.0)
    assert np.abs(np.cos(loop.output[0])) == pytest.approx(np.abs(cosine), abs=1e-12)
    assert loop.rate[0] == pytest.approx(slope(loop.output[0]), abs=1e-9)
    assert loop.second[0] == pytest.approx(slope(loop.rate[0]), abs=1e-8)
    assert loop.frame_rate[0] == pytest.approx(slope(loop.frame[0]), abs=1e-9)
    assert loop.frame_second[0] == pytest.approx(slope(loop.frame_rate[0]), abs=1e-8)


def test_a_slider_crank_stands_where_its_coupler_reaches() -> None:
    loop = SliderLoop.from_lengths(1.0, CAM, lengths(coupler=70.0, offset=12.0))
    square = (50.0 + 70.0 - np.roll(CAM.p[0], -N // 4)) ** 2 + (CAM.p[0] - 25.0) ** 2
    assert loop.output[0] == pytest.approx(np.sqrt(square - 144.0), abs=1e-12)
    assert loop.rate[0] == pytest.approx(slope(loop.output[0]), abs=1e-9)
    assert loop.frame_second[0] == pytest.approx(slope(loop.frame_rate[0]), abs=1e-8)


def test_rows_of_a_part_are_those_of_the_whole() -> None:
    cams = Support(*(np.repeat(rows, 3, axis=0) for rows in (CAM.breadth, CAM.p, CAM.dp, CAM.ddp)))
    three = Lengths(*(np.repeat(length, 3, axis=0) for length in lengths(ground=80.0, coupler=70.0, rocker=105.0)))
    three.rocker[:, 0] = 100.0, 105.0, 110.0
    loop = FourBarLoop.from_lengths(-1.0, cams, three)
    rate = loop.rate
    part = loop.part(np.array([False, True, True]))
    assert part.lengths.rocker[:, 0].tolist() == [105.0, 110.0]
    assert np.array_equal(part.rate, rate[1:])
    assert np.array_equal(part.output, loop.output[1:])
