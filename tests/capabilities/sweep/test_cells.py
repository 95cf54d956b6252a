"""Cells of a map and of a curve: how many, their ends, and the best design in each."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from camgeo.capabilities.sweep.gather import KEPT, OUTSIDE, BestByCell


def axis(low: float, high: float, values: tuple[float, ...] = ()) -> SimpleNamespace:
    return SimpleNamespace(low=low, high=high, values=values)


@pytest.mark.parametrize(
    ("axes", "designs", "shape"),
    [
        ([axis(0.0, 1.0)], 600, (100, 1)),  # six designs a cell
        ([axis(0.0, 1.0)], 6, (8, 1)),  # eight cells at least
        ([axis(0.0, 1.0)], 10**6, (1000, 1)),  # a thousand at most of a curve
        ([axis(0.0, 1.0), axis(2.0, 1.0)], 5400, (30, 30)),
        ([axis(0.0, 1.0), axis(2.0, 1.0)], 10**6, (120, 120)),  # 120 a side of a map
        ([axis(0.0, 1.0), axis(2.0, 1.0), axis(3.0, 4.0)], 5400, (30, 30)),  # over the first two
        ([axis(0.0, 1.0), axis(0.0, 0.0, (1.0, 2.0, 5.0))], 600, (100, 3)),
    ],
)
def test_cells(axes: list[SimpleNamespace], designs: int, shape: tuple[int, int]) -> None:
    best = BestByCell(SimpleNamespace(axes=axes, count=designs), most=True)
    assert best.state.shape == shape
    assert best.edges[0] == pytest.approx(np.linspace(0.0, 1.0, shape[0] + 1))
    if shape[1] == 3:  # halfway between the values, and as far beyond the first and the last
        assert best.edges[1] == pytest.approx([0.5, 1.5, 3.5, 6.5])


@pytest.mark.parametrize("most", [True, False])
def test_the_best_of_a_cell(most: bool) -> None:
    """Scores rise to the better; of four cells the second has a design outside the limits alone, the last none."""
    plan = SimpleNamespace(axes=[axis(0.0, 4.0, (0.5, 1.5, 2.5, 3.5))], count=4)
    best = BestByCell(plan, most=most)
    figures = np.array([3.0, 5.0, 7.0, 2.0])
    places, states = np.array([[0.4], [0.9], [1.2], [2.9]]), np.array([KEPT, KEPT, OUTSIDE, KEPT], np.uint8)
    best.paint(places, figures if most else -figures, states)
    best.paint(places[:1], np.array([4.0 if most else -4.0]), states[:1])
    expected = [5.0 if most else 3.0, np.nan, 2.0, np.nan]
    assert best.best[:, 0] == pytest.approx(expected, nan_ok=True)
    assert best.state[:, 0].tolist() == [KEPT, OUTSIDE, KEPT, 0]
