"""Keys by the bore: rows at the ends of their ranges, and what the rows of the standard have in common."""

import pytest

from camgeo.part.din6885 import TABLE, key_for


@pytest.mark.parametrize(
    ("bore", "width", "hub"), [(6, 2, 1.0), (8, 2, 1.0), (8.01, 3, 1.4), (22, 6, 2.8), (38, 10, 3.3), (230, 50, 11.4)]
)
def test_a_row_holds_up_to_its_end(bore, width, hub):
    row = key_for(bore)
    assert (row.width, row.hub) == (width, hub)


@pytest.mark.parametrize("bore", [5.99, 230.01])
def test_there_is_none_beyond_the_table(bore):
    assert key_for(bore) is None


def test_rows_follow_each_other_and_leave_play_over_the_key():
    assert [row.over for row in TABLE[1:]] == [row.to for row in TABLE[:-1]]
    assert all(row.width >= row.height and 0.1 <= row.shaft + row.hub - row.height <= 0.45 for row in TABLE)
