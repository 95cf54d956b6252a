"""Tables as text: columns, decimal marks and units by their headings; what is no row is refused with its line."""

import math

import numpy as np
import pytest

from kin.law.programme import IntentError
from kin.read.tables import Sheet, read_table

TURN = 2 * math.pi
rad = math.radians


@pytest.mark.parametrize(
    "text",
    [
        "0;0,000\n1,5;0,25\n3;1\n",
        "0,0.000\n1.5,0.25\n3,1\n",
        "angle lift\n0 0,0\n1,5 0,25\n\n3 1,000\n",
        "deg, mm\n0, 0.0\n1.5, 0.25\n# half way\n3, 1.000",
        "\ufeff0\t0,0\n1,5\t0,25\n3\t1,000\n",
        '"0";"0,000"\r\n"1,5";"0,25"\r\n"3";"1";\r\n',
    ],
)
def test_columns_and_decimal_marks(text):
    rows, unit = read_table(text)
    assert np.degrees(rows.theta) == pytest.approx([0, 1.5, 3])
    assert rows.s.tolist() == [0, 0.25, 1]
    assert unit in {0.001, 0.01}


def test_crank_degrees_inches_and_degrees():
    text = "# inlet\ndeg;in\n0;0,0\n2;0,1\n4;0,25\n"
    rows, unit = read_table(text, Sheet("length", angle="crank", unit="inch"))
    assert np.degrees(rows.theta) == pytest.approx([0, 1, 2])
    assert rows.s == pytest.approx([0, 2.54, 6.35])
    assert rows.lines.tolist() == [3, 4, 5]
    assert unit == pytest.approx(0.254)
    plain = text.replace(";in", ";lift")
    assert read_table(plain, Sheet("angle", instead="degrees"))[0].s == pytest.approx(np.radians([0, 0.1, 0.25]))


@pytest.mark.parametrize(
    ("quantity", "unit"),
    [("length", 1.0), ("angle", np.pi / 180), ("force", 1.0), ("moment", 1.0), ("share", 1.0)],
)
def test_a_column_without_a_unit_is_in_the_first_of_its_quantity(quantity, unit):
    rows, _ = read_table("0;0\n90;1\n", Sheet(quantity))
    assert rows.s.tolist() == [0.0, unit]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (
            "w;lift\n0;1\n1;x\n",
            "line 3: 'x' is not a number, in '1;x'; an angle and a displacement are expected",
        ),
        (
            "0,1,0,2\n1,5,0,3\n",
            (
                "line 1: the table's columns are 4 without a heading; give those of the angle and the value, such as "
                "columns: [1, 2]: with decimal commas, separate the columns by semicolons"
            ),
        ),
        (
            "crank in ex\n0 1 2\n1 2 3\n",
            (
                "line 2: the table's columns are crank, in, ex; give those of the angle and the value, such as "
                "columns: [crank, in]"
            ),
        ),
        (
            "0,1,2\n1.5,5,3\n2,1,4,5\n",
            (
                "line 1: the table's columns are 3 without a heading; give those of the angle and the value, such as "
                "columns: [1, 2]: with decimal commas, separate the columns by semicolons"
            ),
        ),
        (
            "deg,lift\n0,0\n1,2,3\n",
            (
                "line 3: 3 columns, and 2 are expected, parted by commas: '1,2,3': with decimal commas, part the "
                "columns by semicolons; an angle and a displacement are expected"
            ),
        ),
        ("deg,lift\n0,0\n1,\n", "line 3: column 2 is empty, in '1,'; an angle and a displacement are expected"),
        (
            "deg,lift\n0,0\n1\n",
            "line 3: 1 columns, and 2 are expected, parted by commas: '1'; an angle and a displacement are expected",
        ),
        ("deg;lift\n", "below its heading there is no row"),
        ("# nothing\n", "no row of numbers is among its lines"),
    ],
)
def test_what_is_no_row_is_refused_with_its_line(text, message):
    with pytest.raises(IntentError) as caught:
        read_table(text)
    assert caught.value.message == message


SEVERAL = "crank_deg;intake_thou;exhaust_thou\n0;0;1\n2;10;3\n4;20;5\n"


@pytest.mark.parametrize("columns", [("crank", "exhaust"), ("crank_deg", "exhaust_thou"), (1, 3), ("Crank", 3)])
def test_columns_are_chosen_by_heading_or_number_and_their_units_are_taken(columns):
    rows, place = read_table(SEVERAL, Sheet("length", columns))
    assert np.degrees(rows.theta) == pytest.approx([0, 1, 2])
    assert rows.s == pytest.approx([0.0254, 0.0762, 0.127])
    assert (rows.unit, place) == (0.0254, 0.0254)


@pytest.mark.parametrize(
    ("heading", "quantity", "s"),
    [
        ("phi;lift_in", "length", 25.4),
        ("phi;Lift (inch)", "length", 25.4),
        ("phi;lift / thou", "length", 0.0254),
        ("phi;s [cm]", "length", 10.0),
        ("phi;swing_deg", "angle", rad(1)),
        ("phi;swing_rad", "angle", 1.0),
        ("phi;load_lbf", "force", 4.4482216152605),
        ("phi;load_kN", "force", 1000.0),
        ("phi;load_Nm", "moment", 1.0),
        ("phi;torque (lbf in)", "moment", 0.1129848290276167),
    ],
)
def test_a_unit_in_a_heading_is_taken(heading, quantity, s):
    rows, _ = read_table(f"{heading}\n0;0\n90;1\n", Sheet(quantity, instead="mm"))
    assert rows.s[1] == pytest.approx(s, rel=1e-15)
    assert rows.theta[1] == pytest.approx(rad(90))


@pytest.mark.parametrize(
    ("heading", "angle", "turn"),
    [
        ("deg", None, 360),
        ("crank", None, 720),
        ("crank_deg", None, 720),
        ("angle_rad", None, 2 * math.pi),
        ("turns", None, 1),
        ("shaft %", None, 100),
        ("deg", "crank", 720),
        ("angle", "radians", 2 * math.pi),
        ("angle", "turns", 1),
        ("angle", "percent", 100),
    ],
)
def test_angles_in_every_unit_are_of_the_cam_s_turn(heading, angle, turn):
    rows, _ = read_table(f"{heading};lift\n0;0\n{turn!r};0\n", Sheet("length", angle=angle))
    assert rows.theta[1] == pytest.approx(TURN, rel=1e-15)


def test_scale_and_offset_come_before_the_reading():
    rows, place = read_table("0;0,00\n90;1,25\n", Sheet("length", unit="inch", scale=1.6, offset=-0.2))
    assert rows.s == pytest.approx([-0.2 * 25.4, 1.8 * 25.4])
    assert place == pytest.approx(0.016 * 25.4)


def test_displacement_stands_out_among_its_derivatives():
    rows, _ = read_table("t, deg, s (mm), v (mm/deg), a\n1, 0, 0.0, 1, 2\n2, 10, 1.5, 3, 4\n")
    assert rows.s.tolist() == [0, 1.5]
    assert np.degrees(rows.theta) == pytest.approx([0, 10])


@pytest.mark.parametrize(
    ("sheet", "message", "field"),
    [
        (Sheet("length", ("crank", "valve")), "'valve' is no heading of the table: they are crank_deg, ", "columns"),
        (Sheet("length", (1, 4)), "the table has columns 1 to 3, not 4", "columns"),
        (Sheet("length", (1, "crank")), "column 1 cannot be both the angle and the value", "columns"),
        (Sheet("length", (1, 2), "cam"), "the column 'crank_deg' is of the crank, not of the cam", "angle"),
        (Sheet("length", (1, 2), "radians"), "the column 'crank_deg' is in degrees, not in radians", "angle"),
        (Sheet("length", (1, 2), unit="mm"), "the column 'intake_thou' is in thou, not in mm", "units"),
        (Sheet("angle", (1, 2)), "the column 'intake_thou' is in thou; an angle is meant here", ""),
    ],
)
def test_what_contradicts_a_heading_is_refused(sheet, message, field):
    with pytest.raises(IntentError) as caught:
        read_table(SEVERAL, sheet)
    assert caught.value.message.startswith(message)
    assert caught.value.field == ".".join(filter(None, ("motion.table", field)))
