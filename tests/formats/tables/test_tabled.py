"""Steps of tables: divisors of a turn in whole ticks, and the fewest rows whose error is small enough."""

import pytest

from camgeo.formats.tables.tabled import TICKS, fewest_rows
from camgeo.recipe.machining import COARSEST, FINEST


@pytest.mark.parametrize("most", [1e-2, 1e-4, 1e-6])
def test_the_fewest_rows_of_a_falling_error(most):
    rows = fewest_rows(lambda n: 40.0 / n**2 <= most)
    ticks = [t for t in range(int(COARSEST * TICKS), round(FINEST * TICKS) - 1, -1) if 360 * TICKS % t == 0]
    assert rows == next(360 * TICKS // t for t in ticks if 40.0 / (360 * TICKS // t) ** 2 <= most)


def test_none_where_no_step_is_fine_enough():
    assert fewest_rows(lambda _: False) is None


def test_no_finer_than_the_controller_takes():
    assert fewest_rows(lambda n: n >= 400, finest=1.0) is None
    assert fewest_rows(lambda n: n >= 360, finest=1.0) == 360


@pytest.mark.thin(2)
@pytest.mark.parametrize("least", [36, 1_000, 360_000, 400_000])
def test_each_number_of_rows_is_tried_once(least):
    """A try of 360,000 rows takes seconds."""
    tried = []

    def holds(count):
        tried.append(count)
        return count >= least

    rows = fewest_rows(holds)
    assert len(tried) == len(set(tried)) <= 8
    # what costs less says so first, and is believed where it says no
    tried.clear()
    assert fewest_rows(holds, may=lambda count: count >= least) == rows
    assert tried == ([rows] if rows else [])
    assert fewest_rows(holds, may=lambda count: count >= 0.5 * least) == rows
