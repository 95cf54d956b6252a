"""Digits to which the numbers of a file are rounded, and what they leave open of an entity's ends."""

import math

import numpy as np
import pytest

from kin.read.drawing.digits import Digits, Written, digits_of, rounding

RNG = np.random.default_rng(5)
NUMBERS = RNG.uniform(-150.0, 150.0, 400)


@pytest.mark.parametrize("decimals", [3, 6, 9])
def test_decimals_of_numbers_that_are_rounded(decimals: int) -> None:
    digits = digits_of([*np.round(NUMBERS, decimals).tolist(), 0.0, 20.0])
    assert digits == Digits(decimals, decimals + 3)
    assert digits.half(123.0) == pytest.approx(0.5 * 10.0**-decimals)


def test_significant_digits_of_numbers_that_are_rounded_to_these() -> None:
    digits = digits_of([float(f"{number:.6g}") for number in NUMBERS])
    assert digits is not None
    assert digits.half(123.0) == pytest.approx(0.5e-3)
    assert digits.half(12.0) == pytest.approx(0.5e-4)


@pytest.mark.parametrize(
    "numbers",
    [NUMBERS.tolist(), [3.0, 20.0, 5.0], [0.5, 0.25, 30.01], [1.5, 2.25, 3.125, 30.012345], []],
    ids=["all digits", "whole", "few", "round but for one", "none"],
)
def test_numbers_that_show_no_rounding(numbers: list[float]) -> None:
    assert digits_of(numbers) is None


@pytest.mark.parametrize("decimals", [3, 4, 6])
def test_ends_of_rounded_arcs_are_off_by_no_more_than_is_told_and_by_nearly_as_much(decimals: int) -> None:
    """In every second block twice as large; the exact arc ends at known places, the rounded one beside them."""
    rows = np.column_stack([RNG.uniform(-60, 60, (300, 2)), RNG.uniform(1, 90, 300), RNG.uniform(0, 360, (300, 2))])
    kept = np.round(rows, decimals)
    scale = np.where(np.arange(300) % 2, 2.0, 1.0)
    written = [
        Written(row[:3], row[3:], row[2], math.radians(1.0), float(size))
        for row, size in zip(kept.tolist(), scale, strict=True)
    ]
    told = rounding(written)

    def ends(of: np.ndarray) -> np.ndarray:
        angle = np.radians(of[:, 3:])
        return of[:, :1] + of[:, 2:3] * np.cos(angle)

    share = scale[:, None] * np.abs(ends(kept) - ends(rows)) / told[:, None]
    assert share.max() <= 1.0
    assert share.max() > 0.4
