"""Which designs a sweep looks at."""

from __future__ import annotations

import itertools
import signal
from contextlib import suppress

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from support.heavy import qmc

from camgeo.capabilities.sweep.keys import Axis
from camgeo.capabilities.sweep.plan import GREATEST, MOST, SMALLEST, Plan

AXES = (Axis("a", -1.0, 3.0), Axis("b", 5.0, 5.5), Axis("c", 0.0, 2.0, (0.0, 1.5, 2.0)))


def test_a_grid_is_every_combination_in_order_with_exact_ends() -> None:
    axes = (Axis("a", 0.1, 0.7, steps=4), Axis("b", 1.0, 2.0, (1.0, 2.0, 1.25)))
    plan = Plan(axes, "grid", 12)
    expected = list(itertools.product(axes[0].values, axes[1].values))
    assert plan.values(0, 12).tolist() == [list(pair) for pair in expected]
    assert plan.values(0, 12)[[0, -1], 0].tolist() == [0.1, 0.7]


@pytest.mark.thin(2)
@pytest.mark.parametrize("method", ["random", "sobol"])
@given(seed=st.integers(0, 2**32 - 1), first=st.integers(0, 999), length=st.integers(0, 300))
def test_a_design_follows_from_its_index_alone(method: str, seed: int, first: int, length: int) -> None:
    plan = Plan(AXES, method, 1300, seed)
    whole = plan.values(0, 1300)
    assert np.array_equal(plan.values(first, first + length), whole[first : first + length])
    # and from nothing else: a longer plan begins with the same designs
    assert np.array_equal(Plan(AXES, method, 5000, seed).values(0, 1300), whole)


@pytest.mark.thin(4)
@pytest.mark.parametrize("width", [1, 2, 5, 11])
def test_sobol_is_scipys_scrambled_sequence(width: int) -> None:
    plan = Plan(tuple(Axis(f"x{i}", 0.0, 1.0) for i in range(width)), "sobol", 4096, 7)
    expected = qmc.Sobol(width, scramble=True, rng=np.random.default_rng(7)).random(4096)
    assert np.array_equal(plan.values(0, 4096), expected)


def test_an_interrupt_while_scipy_reads_its_numbers_is_not_lost(monkeypatch: pytest.MonkeyPatch) -> None:
    sobol = qmc.Sobol

    def interrupted(*arguments: object, **named: object) -> object:
        with suppress(KeyboardInterrupt):  # as its compiled code does
            signal.raise_signal(signal.SIGINT)
        return sobol(*arguments, **named)

    monkeypatch.setattr("scipy.stats.qmc.Sobol", interrupted)
    with pytest.raises(KeyboardInterrupt):
        Plan(AXES, "sobol", 100, 987_654).values(0, 1)
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler


@pytest.mark.parametrize("method", ["random", "sobol"])
def test_designs_fill_their_ranges_evenly_and_seeds_differ(method: str) -> None:
    plan = Plan(AXES, method, 4096, 1)
    values = plan.values(0, 4096)
    for i, axis in enumerate(AXES):
        assert values[:, i].min() >= axis.low
        assert values[:, i].max() <= axis.high
    quarters = np.histogram(values[:, 0], 4, (-1.0, 3.0))[0]
    assert np.abs(quarters - 1024).max() < 120  # four times the deviation of independent ones
    assert set(values[:, 2]) == {0.0, 1.5, 2.0}
    assert abs(np.corrcoef(values[:, 0], values[:, 1])[0, 1]) < 0.06
    assert not np.array_equal(values, Plan(AXES, method, 4096, 2).values(0, 4096))


def test_independent_numbers_of_neighbours_do_not_repeat() -> None:
    plan = Plan(tuple(Axis(f"x{i}", 0.0, 1.0) for i in range(6)), "random", 10_000, 3)
    assert len(np.unique(plan.values(0, 10_000))) == 60_000


@given(count=st.integers(1, MOST))
def test_chunks_cover_every_design_once(count: int) -> None:
    plan = Plan(AXES, "random", count)
    assert SMALLEST <= plan.chunk <= GREATEST
    spans = [plan.span(number) for number in (0, plan.chunks // 2, plan.chunks - 1)]
    assert spans[0][0] == 0
    assert spans[-1][1] == count
    assert all(0 < last - first <= plan.chunk for first, last in spans)
    if plan.chunks > 1:
        assert plan.span(plan.chunks - 2)[1] == spans[-1][0]


@pytest.mark.parametrize(
    ("axes", "method", "count", "message"),
    [
        ((), "grid", 1, "a sweep varies at least one field"),
        (AXES, "grid", 3, "every axis of a grid has its values"),
        ((AXES[2],), "grid", 4, "this grid has 3 designs, not 4"),
        (AXES, "sobol", MOST + 1, f"a sweep has 1 to {MOST} designs, not {MOST + 1}"),
        (AXES, "random", 0, f"a sweep has 1 to {MOST} designs, not 0"),
    ],
)
def test_a_plan_that_is_none_is_refused(axes: tuple[Axis, ...], method: str, count: int, message: str) -> None:
    with pytest.raises(ValueError, match=f"^{message}$"):
        Plan(axes, method, count)


def test_designs_outside_a_plan_are_refused() -> None:
    with pytest.raises(ValueError, match="designs 0 to 11 of 10"):
        Plan(AXES, "random", 10).values(0, 11)
