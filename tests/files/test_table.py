"""CSV tables: numbers of twelve digits, plain lines, and what is refused."""

import csv

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from camgeo.files.table import write_table


def test_header_lines_and_zeros(tmp_path):
    path = tmp_path / "motion.csv"
    write_table(path, ["shaft_deg", "lift_mm"], np.array([[0.0, -0.0], [0.1, 1e-300], [360.0, 2.0 / 3.0]]))
    assert path.read_bytes() == b"shaft_deg,lift_mm\n0,0\n0.1,1e-300\n360,0.666666666667\n"


@given(st.lists(st.tuples(*[st.floats(allow_nan=False, allow_infinity=False)] * 3), max_size=20))
def test_any_double_comes_back_to_twelve_digits(tmp_path_factory, rows):
    path = tmp_path_factory.mktemp("table") / "motion.csv"
    table = np.array(rows, dtype=np.float64).reshape(-1, 3)
    write_table(path, ["a", "b", "c"], table)
    with path.open(newline="") as stream:
        header, *lines = list(csv.reader(stream))
    assert header == ["a", "b", "c"]
    back = np.array(lines, dtype=np.float64).reshape(-1, 3)
    assert back == pytest.approx(table, rel=5e-12, abs=1e-320)
    assert all(
        len(cell.strip("-").partition("e")[0].replace(".", "").lstrip("0")) <= 12 for row in lines for cell in row
    )


@pytest.mark.parametrize(
    ("columns", "rows", "message"),
    [
        (["a"], np.zeros((3, 2)), r"table: rows of shape \(3, 2\) under 1 columns"),
        (["a"], np.zeros(3), r"table: rows of shape \(3,\) under 1 columns"),
        (["a", "b,c"], np.zeros((3, 2)), "table: 'b,c' is not a plain column name"),
        (["a", "b"], np.array([[0.0, 0.0], [0.0, np.nan]]), "table: b is not finite in row 1"),
    ],
)
def test_refuses(tmp_path, columns, rows, message):
    path = tmp_path / "motion.csv"
    with pytest.raises(ValueError, match=f"^{message}$"):
        write_table(path, columns, rows)
    assert not path.exists()
