"""Linear programmes: least values against another solver, rows that cannot be met, and degenerate ones."""

import numpy as np
import pytest
from support.heavy import optimize

from kin.numeric.linear_programme import minimise


def test_a_programme_by_hand():
    """Cheapest mixture of three: 2 x + 3 y + z with x + y + z = 1 and x - z = 0.5."""
    found = minimise(np.array([2.0, 3.0, 1.0]), np.array([[1.0, 1.0, 1.0], [1.0, 0.0, -1.0]]), np.array([1.0, 0.5]))
    assert found.value == pytest.approx(1.75, abs=1e-14)
    assert found.x == pytest.approx([0.75, 0.0, 0.25], abs=1e-14)
    assert found.missed == 0.0


def test_rows_that_cannot_be_met_are_missed_by_the_least():
    found = minimise(np.ones(2), np.array([[1.0, 1.0], [1.0, 0.5]]), np.array([1.0, 2.0]))
    assert found.value == np.inf
    assert found.missed == pytest.approx(1.0, abs=1e-14)


@pytest.mark.thin(6)
@pytest.mark.parametrize("seed", range(24))
def test_the_least_value_is_that_of_another_solver(seed):
    pytest.importorskip("scipy")
    rng = np.random.default_rng(seed)
    count, size = rng.integers(2, 14), rng.integers(15, 400)
    rows = rng.normal(size=(count, size))
    rows /= np.abs(rows).max(axis=1)[:, None]
    rows[0] = np.abs(rows[0])
    if seed % 4 == 1:  # slacks, as inequalities have
        rows = np.hstack([rows, np.vstack([np.zeros(count - 1), np.eye(count - 1)])])
    right = rows @ np.where(rng.random(rows.shape[1]) < 0.1, rng.random(rows.shape[1]), 0.0)
    if seed % 4 == 2:
        right = right + rng.normal(size=count) * 3
    cost = rng.random(rows.shape[1])
    found, other = minimise(cost, rows, right), optimize.linprog(cost, A_eq=rows, b_eq=right)
    if other.status == 2:
        assert found.value == np.inf
        assert found.missed > 1e-9
        assert found.multipliers @ right == pytest.approx(found.missed, rel=1e-8)
        assert (found.multipliers @ rows <= 1e-8).all()
    else:
        assert found.value == pytest.approx(other.fun, rel=1e-8, abs=1e-10)
        assert found.multipliers @ right == pytest.approx(other.fun, rel=1e-8, abs=1e-10)
        assert (found.multipliers @ rows <= cost + 1e-8).all()
        assert rows @ found.x == pytest.approx(right, abs=1e-10)
        assert (found.x >= 0.0).all()
