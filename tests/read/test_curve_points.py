"""Curve point tables of a drive's controller: semicolons or tabs, points or commas, and what is none."""

import pytest

from kin.read.curve_points import is_curve_points, read_curve_points
from kin.read.errors import ReadError


@pytest.mark.parametrize("text", ["3\n0;0\n90;1.5\n360;0\n", "3\r\n0,0\t0,0\r\n90,0\t1,5\r\n360,0\t0\r\n"])
def test_rows_are_read(text, tmp_path):
    path = tmp_path / "cam.csv"
    path.write_text(text, newline="")
    assert is_curve_points(path)
    assert read_curve_points(path).tolist() == [[0, 0], [90, 1.5], [360, 0]]


@pytest.mark.parametrize("text", ["0;0\n90;1.5\n", "3\n5;0\n90;1\n360;0\n", "angle;lift\n0;0\n", "3\n"])
def test_other_tables_are_none(text, tmp_path):
    path = tmp_path / "cam.csv"
    path.write_text(text)
    assert not is_curve_points(path)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("4\n0;0\n90;1\n360;0\n", "its first line says 4 rows, and there are 3"),
        ("3\n0;0\n90;up\n360;0\n", "row 2 is not of 2 finite numbers"),
        ("3\n0;0\n90;nan\n360;0\n", "row 2 is not of 2 finite numbers"),
        ("2\n0;0\n360;0\n", "2 rows; 3 to 16383 are judged"),
    ],
)
def test_a_table_that_is_not_whole_is_refused(text, message, tmp_path):
    path = tmp_path / "cam.csv"
    path.write_text(text)
    with pytest.raises(ReadError, match=message):
        read_curve_points(path)
