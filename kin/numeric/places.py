"""Places as messages write them."""

from __future__ import annotations

ROUNDING = 1e-7
"""mm: what a search by doubles leaves of a coordinate that is 0, and finer than any message is read for."""


def place_text(*coordinates: float, digits: int = 6) -> str:
    """Write coordinates in brackets, with `digits` significant digits; one below ROUNDING is 0."""
    return f"({', '.join(f'{0.0 if abs(c) < ROUNDING else c:.{digits}g}' for c in coordinates)})"
