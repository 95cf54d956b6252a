"""Texts of figures in remedies, rounded to the side on which the remedy is true."""

from __future__ import annotations

NOISE = 1e-9  # share of a figure by which it may be off through rounding: 6.000000000000001 is reported as 6


def upward(value: float, digits: int = 6) -> str:
    """Text of a positive figure rounded up to `digits` significant digits, for a remedy `at least`."""
    return _rounded(value * (1.0 - NOISE), digits, up=True)


def downward(value: float, digits: int = 6) -> str:
    """Text of a positive figure rounded down to `digits` significant digits, for a remedy `at most`."""
    return _rounded(value * (1.0 + NOISE), digits, up=False)


def _rounded(value: float, digits: int, *, up: bool) -> str:
    from decimal import ROUND_CEILING, ROUND_FLOOR, Context

    rounding = ROUND_CEILING if up else ROUND_FLOOR
    return f"{float(Context(prec=digits, rounding=rounding).create_decimal_from_float(value)):.{digits}g}"
