"""Lash ramps of lobes by hand: lengths, heights and velocities, where the nose stands, and what is refused."""

from __future__ import annotations

import math
import re

import numpy as np
import pytest

from kin.law.normalised import IntentError
from kin.law.sources.lobe import LobeSide, Ramp, lobe

DEG = math.pi / 180.0
POWERS = [2, 8, 14, 20, 26]
# 0.25 mm at 0.02 mm a degree: 10 degrees at half of that for the first 0.1 mm, 7.5 for the others; its end at 66
RAMP = Ramp(0.25, 0.02 / DEG)
PLACES = [0.0, 66.0, 69.75, 73.5, 78.5, 83.5, 100.0]
HEIGHTS = [8.25, 0.25, 0.175, 0.1, 0.1 * (2.0 * 0.5**3 - 0.5**4), 0.0, 0.0]
SLOPES = [0.0, 0.02, 0.02, 0.02, 0.1 / 10.0 * (6.0 * 0.5**2 - 4.0 * 0.5**3), 0.0, 0.0]


def test_the_parts_of_a_ramp() -> None:
    assert np.degrees(RAMP.parts) == pytest.approx([10.0, 7.5])
    assert math.degrees(RAMP.over) == pytest.approx(17.5)
    assert math.degrees(LobeSide.of(8.25, 66 * DEG, POWERS, RAMP).reach) == pytest.approx(83.5)
    assert math.degrees(LobeSide.of(8.25, 66 * DEG, POWERS, None).reach) == pytest.approx(66.0)


@pytest.mark.parametrize("nose", [180.0, 40.0, 300.0, 0.0, 83.5])
def test_heights_and_velocities_on_both_sides_of_the_nose(nose: float) -> None:
    """Also where the turn's end cuts the ramp, the flank or the nose."""
    motion = lobe(8.25, 66 * DEG, POWERS, nose=nose * DEG, ramp=RAMP)
    for side in (1.0, -1.0):
        at = np.mod(nose + side * np.array(PLACES), 360.0)
        s, v = motion.derivatives(at * DEG, 1)
        assert s == pytest.approx(HEIGHTS, abs=1e-9)
        assert v * DEG == pytest.approx(-side * np.array(SLOPES), abs=1e-9)


def test_a_motion_that_does_not_repeat_has_its_nose_in_the_middle() -> None:
    motion = lobe(8.25, 66 * DEG, POWERS, 200 * DEG, ramp=RAMP, around=None)
    for side in (1.0, -1.0):
        assert motion.derivatives((100.0 + side * np.array(PLACES)) * DEG, 0)[0] == pytest.approx(HEIGHTS, abs=1e-9)
    with pytest.raises(IntentError, match="stands in the middle"):
        lobe(8.25, 66 * DEG, POWERS, 200 * DEG, nose=0.1, around=None)


def test_the_velocity_that_is_too_slow_is_the_least_that_is() -> None:
    """114 degrees are left beyond 66: 1.4 h/v of them. A little faster does, that itself does not."""

    def made(velocity: float) -> None:
        lobe(8.25, 66 * DEG, POWERS, ramp=Ramp(0.25, velocity / DEG))

    with pytest.raises(IntentError, match="the ramp takes 175 degrees, 114 are left") as refused:
        made(0.002)
    (least,) = (float(number) for number in re.findall(r"; ([\d.]+) a degree is too slow", refused.value.message))
    assert least == pytest.approx(1.4 * 0.25 / 114.0, rel=1e-5)
    with pytest.raises(IntentError):
        made(least * (1.0 - 1e-5))
    made(least * (1.0 + 1e-5))


@pytest.mark.parametrize(
    ("lift", "half", "ramp", "field"),
    [
        (0.0, 66.0, None, "lift"),
        (math.inf, 66.0, None, "lift"),
        (8.25, 0.0, None, "half"),
        (8.25, 180.0, None, "half"),
        (8.25, 66.0, Ramp(0.0, 1.0), "ramp.height"),
        (8.25, 66.0, Ramp(8.25, 1.0), "ramp.height"),
        (8.25, 66.0, Ramp(0.25, 0.0), "ramp.velocity"),
        (8.25, 66.0, Ramp(0.25, math.inf), "ramp.velocity"),
        (8.25, 66.0, Ramp(1e-9, 1.0), "ramp.height"),
    ],
)
def test_what_is_no_ramp(lift: float, half: float, ramp: Ramp | None, field: str) -> None:
    with pytest.raises(IntentError) as refused:
        lobe(lift, half * DEG, POWERS, ramp=ramp)
    assert refused.value.field == f"motion.lobe.{field}"


@pytest.mark.parametrize(
    ("powers", "good"),
    [
        ([2, 8, 14, 20, 100], True),
        ([2, 8, 14, 20, 101], False),
        ([2, 8, 14, 20], False),
        ([3, 8, 14, 20, 26], False),
        ([2, 8, 8, 20, 26], False),
        ([2, 8.5, 14, 20, 26], False),
    ],
)
def test_powers(powers: list[float], good: bool) -> None:
    if good:
        assert lobe(8.25, 66 * DEG, powers).derivatives(np.zeros(1), 0)[0] == pytest.approx([8.25])
    else:
        with pytest.raises(IntentError, match="the powers of a lobe"):
            lobe(8.25, 66 * DEG, powers)
