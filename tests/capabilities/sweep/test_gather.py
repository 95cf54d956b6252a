"""Chunks gathered: counts, order, the cells of the map."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from support.sweepers import GRID, RANKING, by_hand, gather_inputs, hills

from camgeo.capabilities.sweep import gather as gathering
from camgeo.capabilities.sweep.gather import KEPT, OUTSIDE, STUCK, Ranking, gather
from camgeo.capabilities.sweep.keys import Axis
from camgeo.capabilities.sweep.plan import Plan
from camgeo.recipe.limits import Limit


@pytest.mark.thin(2)
@pytest.mark.parametrize("most", [True, False])
@pytest.mark.parametrize(
    "limits",
    [(), (Limit("margin", 1.0),), (Limit("margin", at_most=4.0), Limit("dwell", 38.0, 49.9)), (Limit("dwell", 99.0),)],
)
def test_designs_are_kept_and_ranked_as_by_hand(limits: tuple[Limit, ...], most: bool) -> None:
    ranking = Ranking("dwell", most=most, limits=limits)
    found, expected = gather(GRID, ranking, gather_inputs(GRID)), by_hand(ranking)
    assert found.index.tolist() == [index for _, index in expected]
    assert found.figures["dwell"].tolist() == [value for value, _ in expected]
    assert found.counts.kept == len(expected)
    if not limits:
        assert len({value for value, _ in expected}) < len(expected)  # there are ties to tell apart


def test_counts_tell_why_designs_are_not_kept() -> None:
    limits = (Limit("margin", 1.0), Limit("dwell", 45.0))
    counts = gather(GRID, Ranking("dwell", most=True, limits=limits), gather_inputs(GRID)).counts
    x, y = GRID.values(0, 825).T
    turns = x + y <= 128.0
    dwell = hills("", GRID.values(0, 825))["dwell"]
    assert counts.computed == 825
    assert counts.not_turning == (~turns).sum() > 0
    assert counts.reasons == ((1, counts.not_turning),)
    assert counts.failing == (("margin", (turns & (x < 13.0)).sum()), ("dwell", (dwell < 45.0).sum()))
    assert counts.kept == ((x >= 13.0) & (dwell >= 45.0)).sum() > 0


@pytest.mark.slow
@given(most=st.integers(1, 300))
def test_a_table_that_is_cut_holds_the_best(most: int) -> None:
    expected = by_hand(RANKING)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(gathering, "MOST_ROWS", most)
        found = gather(GRID, RANKING, gather_inputs(GRID))
    assert found.index.tolist() == [index for _, index in expected[:most]]
    assert found.counts.kept == len(expected)


def test_chunks_that_are_too_few_are_refused() -> None:
    with pytest.raises(ValueError, match="768 designs of 825"):
        gather(GRID, RANKING, gather_inputs(GRID)[:-1])


def test_a_grids_map_has_a_cell_for_each_design() -> None:
    cells = gather(GRID, RANKING, gather_inputs(GRID)).cells
    figures = hills("", GRID.values(0, 825))
    dwell, margin = (figures[name].reshape(25, 33) for name in ("dwell", "margin"))
    assert np.array_equal(cells.best, np.where(margin >= 1.0, dwell, np.nan), equal_nan=True)
    assert np.array_equal(cells.state, np.where(np.isnan(dwell), STUCK, np.where(margin >= 1.0, KEPT, OUTSIDE)))
    assert np.allclose(cells.centres[0], GRID.axes[0].values, rtol=0, atol=0)
    assert np.all((cells.edges[0][:-1] < cells.centres[0]) & (cells.centres[0] < cells.edges[0][1:]))


@pytest.mark.parametrize("most", [True, False])
def test_a_map_shows_the_best_over_the_other_axes(most: bool) -> None:
    third = Axis("linkage.coupler", 60.0, 80.0, steps=5)
    plan = Plan((*GRID.axes, third), "grid", 825 * 5)

    def raised(scene, values):
        figures = hills(scene, values)
        return {**figures, "dwell": figures["dwell"] + np.where(values[:, 2] == 70.0, 1.0, -1.0) * (1 if most else -1)}

    limit = (Limit("margin", 1.0),)
    flat = gather(GRID, Ranking("dwell", most=most, limits=limit), gather_inputs(GRID)).cells
    deep = gather(plan, Ranking("dwell", most=most, limits=limit), gather_inputs(plan, raised)).cells
    assert np.array_equal(deep.best, flat.best + (1.0 if most else -1.0), equal_nan=True)


@pytest.mark.slow
def test_every_design_of_a_sequence_falls_into_its_cell() -> None:
    plan = Plan((Axis("cam.shaft[0]", 10.0, 20.0), Axis("linkage.rocker", 95.0, 110.0)), "sobol", 5000)
    cells = gather(plan, RANKING, gather_inputs(plan)).cells
    assert (cells.state > 0).all()
    values, figures = plan.values(0, 5000), hills("", plan.values(0, 5000))
    fine = figures["margin"] >= 1.0
    for i, j in ((0, 0), (14, 9), (25, 3), (27, 27)):
        (left, right), (low, high) = cells.edges[0][i : i + 2], cells.edges[1][j : j + 2]
        inside = (values[:, 0] >= left) & (values[:, 0] < right) & (values[:, 1] >= low) & (values[:, 1] < high)
        expected = figures["dwell"][inside & fine].max() if (inside & fine).any() else np.nan
        assert np.array_equal(cells.best[i, j], expected, equal_nan=True)
