"""Cells of curves, on which proved bounds are kept: they cover the curve, and none is without width."""

from __future__ import annotations

import math
from functools import cache
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from support.cases import examples

from camgeo.curve.curve import Bounds, Cells, Curve, CurveError, SmoothRun
from camgeo.recipe.loading import load_text
from camgeo.synthesis.design import designed


@cache
def contour() -> Curve:
    recipe = load_text("cam: {kind: support, p: 30 + 3*cos(2*t) + cos(3*t)}\n", "cam.yaml")
    return designed(recipe).only_surface.contour


@given(st.floats(0.01, 3.0), st.lists(st.integers(1, 12), min_size=1, max_size=5))
@settings(max_examples=examples(60), deadline=None)
def test_breaks_that_are_neighbours_of_rounding_leave_no_cell_without_width(first: float, steps: list[int]) -> None:
    """As a trim leaves them that ends at a break of the motion; a few units in the last place are no six cells."""
    breaks = [first]
    for step in steps:
        place = breaks[-1]
        for _ in range(step):
            place = math.nextafter(place, math.inf)
        breaks.append(place)
    low, high = 0.0, 6.0
    with np.errstate(divide="raise", invalid="raise"):
        cells = Cells.of(Curve(contour().shape, (SmoothRun(low, high, tuple(breaks), closed=False),)))
    assert (cells.low[0], cells.high[-1]) == (low, high)
    assert np.array_equal(cells.low[1:], cells.high[:-1])
    assert (cells.high > cells.low).all()
    assert set(breaks) <= set(cells.low.tolist())


class Boundless:
    """A shape of which no bound is finite on an interval that holds a place."""

    def __init__(self, shape: Any, place: float) -> None:
        self._shape, self._place = shape, place

    def __getattr__(self, name: str) -> Any:
        return getattr(self._shape, name)

    def bounds(self, low: np.ndarray, high: np.ndarray) -> Bounds:
        rows = self._shape.bounds(low, high).rows()
        rows[6:, (low <= self._place) & (self._place <= high)] = np.inf
        return Bounds(*rows)


def test_a_curve_without_a_finite_bound_is_refused_once_its_cells_cannot_be_halved() -> None:
    """Its first cells are as narrow as breaks of a motion may be, 1e-9 rad: halved 24 times they have no width."""
    place = 3.0
    run = SmoothRun(1.0, 5.0, (place, place + 1e-9), closed=False)
    with np.errstate(divide="raise"), pytest.raises(CurveError, match="no finite bound on the curvature can be proved"):
        Cells.of(Curve(Boundless(contour().shape, place + 5e-10), (run,)))
