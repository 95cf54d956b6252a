"""Strokes to which rows of a table belong, whether or not the table fills a turn."""

from types import SimpleNamespace

import numpy as np
import pytest

from kin.law.sources.suspects import spanned


@pytest.mark.parametrize(
    ("values", "period", "place", "rows"),
    [
        ([0, 1, 2, 3, 4, 5], 0.0, 0, 6),
        ([0, 1, 2, 3, 4, 5], 0.0, 1, 6),
        ([0, 1, 2, 3, 4, 5], 0.0, 3, 6),
        ([0, 1, 2, 3, 4, 5], 0.0, 5, 6),
        ([0, 1, 2, 3, 2, 1], 0.0, 1, 4),
        ([0, 1, 2, 3, 2, 1], 0.0, 3, 2),
        ([0, 0, 0, 1, 2, 3], 0.0, 2, 4),
        ([3, 4, 5, 6, 5, 4, 3, 2, 1, 0, 1, 2], 1.0, 0, 7),
    ],
)
def test_rows_of_a_stroke(values: list[float], period: float, place: int, rows: int) -> None:
    assert spanned(SimpleNamespace(s=np.array(values, dtype=float), period=period), place) == rows
