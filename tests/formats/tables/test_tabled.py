"""Steps of tables: divisors of a turn in whole ticks, and the fewest rows whose error is small enough."""

import pytest

from camgeo.formats.tables.tabled import TICKS, fewest_rows
from camgeo.recipe.machining import COARSEST, FINEST


@pytest.mark.parametrize("most", [1e-2, 1e-4, 1e-6])
def test_the_fewest_rows_of_a_falling_error(most):
    rows = fewest_rows(lambda n: 40.0 / n**2, most)
    ticks = [t for t in range(int(COARSEST * TICKS), round(FINEST * TICKS) - 1, -1) if 360 * TICKS % t == 0]
    assert rows == next(360 * TICKS // t for t in ticks if 40.0 / (360 * TICKS // t) ** 2 <= most)


def test_none_where_no_step_is_fine_enough():
    assert fewest_rows(lambda _: 1.0, 0.5) is None


def test_no_finer_than_the_controller_takes():
    assert fewest_rows(lambda n: 1.0 / n, 1.0 / 400.0, finest=1.0) is None
    assert fewest_rows(lambda n: 1.0 / n, 1.0 / 360.0, finest=1.0) == 360
