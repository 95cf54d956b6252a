"""Rows of text: headings of one line and two, marks between columns, and what is no row."""

import numpy as np
import pytest

from kin.read.rows import RowError, read_rows


@pytest.mark.parametrize(
    ("text", "heading"),
    [
        ("0 1\n2 3\n", ()),
        ("angle,lift\n0,1\n2,3\n", ("angle", "lift")),
        ("angle,lift\ndeg,mm\n0,1\n2,3\n", ("angle (deg)", "lift (mm)")),
        ("angle;lift\n[deg];[mm]\n0;1\n2;3\n", ("angle (deg)", "lift (mm)")),
        ("angle;lift\n;mm\n0;1\n2;3\n", ("angle", "lift (mm)")),
        ("x;y;z\nmm;mm\n0;1;\n2;3;\n", ("x (mm)", "y (mm)", "z")),
        ("x;y\nmm;mm;mm\n0;1;\n2;3;\n", ("x (mm)", "y (mm)", "(mm)")),
        ("Intake cam 7\nangle,lift\n0,1\n2,3\n", ("angle", "lift")),
        ("\ufeffsep=;\nangle;lift\n0,0;1,0\n2,0;3,0\n", ("angle", "lift")),
        ("angle;lift\n0 1\n2 3\n", ("angle", "lift")),
    ],
)
def test_headings_are_those_lines_that_have_no_row(text, heading):
    rows = read_rows(text)
    assert rows.heading == heading
    assert rows.values([0, 1]).tolist() == [[0.0, 1.0], [2.0, 3.0]]


@pytest.mark.parametrize("mark", [";", "\t", " ", ", ", ","])
def test_columns_are_parted_by_the_mark_that_most_lines_have(mark):
    lines = [mark.join(("0.5", "1", "-2e-3")), mark.join(("1.5", "2", "7"))]
    text = "\n".join(line if "," in mark else line.replace(".", ",") for line in lines)
    assert read_rows(text).values([2, 0]) == pytest.approx(np.array([[-2e-3, 0.5], [7.0, 1.5]]))


def test_a_label_before_numbers_is_no_heading_and_a_word_among_the_rows_is_told():
    assert read_rows("P1,1,2\nP2,3,4\n").values([1, 2]).tolist() == [[1.0, 2.0], [3.0, 4.0]]
    with pytest.raises(RowError, match=r"^'4O0' is not a number, in '1,4O0'$") as caught:
        read_rows("a,b\n0,0\n1,4O0\n").values([0, 1])
    assert caught.value.line == 3


def test_names_with_blanks_beside_numbers_part_no_columns():
    rows = read_rows("lobe,x,y\ncylinder 1 intake,1.5,2\ncylinder 2 intake,3,4\n")
    assert rows.values([1, 2]).tolist() == [[1.5, 2.0], [3.0, 4.0]]
    assert rows.texts(0) == ["cylinder 1 intake", "cylinder 2 intake"]
    assert read_rows("x y z\n1,5 2,5 3,5\n").values([0, 2]).tolist() == [[1.5, 3.5]]


def test_an_empty_cell_is_nan_where_it_may_be():
    rows = read_rows("a,b\n0,\n1,2\n")
    assert np.isnan(rows.values([0, 1], blanks=True)).tolist() == [[False, True], [False, False]]
    with pytest.raises(RowError, match="column 2 is empty"):
        rows.values([0, 1])


@pytest.mark.parametrize("cell", ["1_0", "0x1p3", "٣", "1e", "--1", "1.2.3"])
def test_what_other_readers_take_for_a_number_is_none(cell):
    with pytest.raises(RowError, match="is not a number"):
        read_rows(f"0,0\n1,{cell}\n").values([0, 1])


@pytest.mark.parametrize(
    "text",
    [
        "2\n0;1\n2;3\n",
        "angle;lift\n2\n0;1\n2;3\n",
        "2\nangle;lift\n0;1\n2;3\n",
        "! exported\n% by a machine\n// today\n0 1\n2 3\n",
        "0;1 # at rest\n2;3  // moving\n",
        "a;b;note\n0;1;\n2;3;the nose\n",
        "0 1\n2 3 the nose\n",
        "0;1;;\n2;3;;\n;;;\n",
        "| a | b |\n|---:|:--|\n| 0 | 1 |\n| 2 | 3 |\n",
        "0 deg,1 mm\n2 deg,3 mm\n",
        "Report\nspeed;1500\nangle;lift\n0;1\n2;3\n",
        " 0.0D+00  1.0D0\n 2.0d0 3\n",
    ],
)
def test_what_stands_beside_rows_is_no_row(text):
    assert read_rows(text).values([0, 1]).tolist() == [[0.0, 1.0], [2.0, 3.0]]


def test_units_behind_numbers_are_told_and_a_number_of_rows_is_compared():
    assert read_rows("0 deg, 1.5mm\n2 deg, 3.0mm\n").units == ("deg", "mm")
    with pytest.raises(RowError, match=r"^3 rows are stated, and 2 follow; add the others, or begin this line with #"):
        read_rows("3\n0;1\n2;3\n")
    assert read_rows("#3\n0;1\n2;3\n").numbers.tolist() == [2, 3]
    # above one column it is that of the rows, or a row itself
    assert [read_rows(f"{first}\n1\n2\n").values([0]).tolist() for first in (2, 0)] == [
        [[1.0], [2.0]],
        [[0.0], [1.0], [2.0]],
    ]


def test_columns_may_end_before_others():
    rows = read_rows("a;b;c;d\n0;1;5;6\n2;3;;\n4;5\n")
    assert rows.filled([2, 3]).values([2, 3]).tolist() == [[5.0, 6.0]]
    assert rows.filled([0, 1]) is rows
    with pytest.raises(RowError, match="these columns are empty"):
        read_rows("a;b;c;d\n0;1;;\n2;3;;\n").filled([2, 3])
