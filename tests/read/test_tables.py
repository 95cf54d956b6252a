"""Tables as text: columns, decimal marks and units by their headings; what is no row is refused with its line."""

import math

import numpy as np
import pytest

from kin.law.normalised import IntentError
from kin.read.tables import Counted, Sheet, read_table

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
        '"Winkel","Hub"\n"0,0","0,000"\n"1,5","0,25"\n"3","1,000"\n',
        '"0.0","0.000"\n"1.5","0.25"\n"3","1.000"\n',
    ],
)
def test_columns_and_decimal_marks(text):
    rows = read_table(text)
    assert np.degrees(rows.theta) == pytest.approx([0, 1.5, 3])
    assert rows.s.tolist() == [0, 0.25, 1]
    assert set(rows.rounding.tolist()) <= {0.0005, 0.005}


def test_a_minus_of_typesetters_is_one():
    assert np.degrees(read_table("deg,mm\n\u22121.5,0.5\n0,0\n").theta) == pytest.approx([-1.5, 0])


def test_crank_degrees_inches_and_degrees():
    text = "# inlet\ndeg;in\n0;0,0\n2;0,1\n4;0,25\n"
    rows = read_table(text, Sheet("length", angle="crank", unit="inch"))
    assert np.degrees(rows.theta) == pytest.approx([0, 1, 2])
    assert rows.s == pytest.approx([0, 2.54, 6.35])
    assert rows.lines.tolist() == [3, 4, 5]
    assert rows.rounding == pytest.approx(0.127)
    plain = text.replace(";in", ";lift")
    assert read_table(plain, Sheet("angle", instead="degrees")).s == pytest.approx(np.radians([0, 0.1, 0.25]))


@pytest.mark.parametrize(
    ("quantity", "unit"),
    [("length", 1.0), ("angle", np.pi / 180), ("force", 1.0), ("moment", 1.0), ("share", 1.0)],
)
def test_a_column_without_a_unit_is_in_the_first_of_its_quantity(quantity, unit):
    rows = read_table("0;0\n90;1\n", Sheet(quantity))
    assert rows.s.tolist() == [0.0, unit]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (
            "w;lift\n0;1\n1;x\n",
            "line 3: 'x' is not a number, in '1;x'; an angle and a displacement are expected",
        ),
        (
            "deg;lift\n0;1,000.5\n1;1,001.5\n",
            "line 2: '1,000.5' is not a number, in '0;1,000.5'; an angle and a displacement are expected",
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
    rows = read_table(SEVERAL, Sheet("length", columns))
    assert np.degrees(rows.theta) == pytest.approx([0, 1, 2])
    assert rows.s == pytest.approx([0.0254, 0.0762, 0.127])
    assert rows.unit == 0.0254
    assert rows.rounding == pytest.approx(0.0127)


@pytest.mark.parametrize(
    ("heading", "quantity", "s"),
    [
        ("phi;lift_in", "length", 25.4),
        ("phi;Lift (inch)", "length", 25.4),
        ("phi;lift / thou", "length", 0.0254),
        ("phi;s [cm]", "length", 10.0),
        ("phi;Lift [µm]", "length", 0.001),
        ("phi;lift_um", "length", 0.001),
        ("phi;swing_deg", "angle", rad(1)),
        ("phi;swing_rad", "angle", 1.0),
        ("phi;load_lbf", "force", 4.4482216152605),
        ("phi;load_kN", "force", 1000.0),
        ("phi;load_Nm", "moment", 1.0),
        ("phi;torque (lbf in)", "moment", 0.1129848290276167),
    ],
)
def test_a_unit_in_a_heading_is_taken(heading, quantity, s):
    rows = read_table(f"{heading}\n0;0\n90;1\n", Sheet(quantity, instead="mm"))
    assert rows.s[1] == pytest.approx(s, rel=1e-15)
    assert rows.theta[1] == pytest.approx(rad(90))


@pytest.mark.parametrize(
    ("heading", "angle", "turn"),
    [
        ("deg", None, 360),
        ("crank", None, 720),
        ("crank_deg", None, 720),
        ("CrankAngle [deg]", None, 720),
        ("Kurbelwinkel [°]", None, 720),
        ("°KW", None, 720),
        ("Nockenwinkel [°NW]", None, 360),
        ("deg ATDC", None, 720),
        ("Theta [deg CA]", "crank", 720),
        ("CAD", "cam", 360),
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
    rows = read_table(f"{heading};lift\n0;0\n{turn!r};0\n", Sheet("length", angle=angle))
    assert rows.theta[1] == pytest.approx(TURN, rel=1e-15)


@pytest.mark.parametrize("heading", ["CA", "degCA", "CAD", "Theta [deg CA]", "Angle [°CA]"])
def test_an_angle_that_may_be_the_crank_s_or_the_cam_s_is_asked_for(heading):
    with pytest.raises(
        IntentError, match="may be of the crank or of the cam; give angle: crank or angle: cam"
    ) as caught:
        read_table(f"{heading};lift\n0;0\n90;1\n")
    assert caught.value.field == "motion.table.angle"


def test_angles_over_two_turns_are_of_the_crank():
    rows = read_table("deg CA;lift\n-360;0\n0;1\n356;0\n")
    assert np.degrees(rows.theta) == pytest.approx([-180, 0, 178])


@pytest.mark.parametrize(
    ("heading", "sheet"),
    [
        ("lift_mm;angle_deg", Sheet("length")),
        ("mm;deg", Sheet("length")),
        ("Hub [mm];Nockenwinkel", Sheet("length")),
        ("swing;cam", Sheet("angle", instead="degrees")),
    ],
)
def test_two_columns_may_stand_in_either_order_where_their_headings_tell(heading, sheet):
    swapped = ";".join(reversed(heading.split(";")))
    rows, other = read_table(f"{heading}\n0;10\n1.5;20\n", sheet), read_table(f"{swapped}\n10;0\n20;1.5\n", sheet)
    assert np.degrees(rows.theta) == pytest.approx([10, 20])
    assert rows.s.tolist() == other.s.tolist()


@pytest.mark.parametrize(
    "head",
    [
        "Crank Angle (deg)   Lift (in)\n",
        "Crank Angle (deg) Lift (in)\n",
        "Crank [deg] Lift [in]\n",
        "# crank_deg lift_in\n",
        "# crank_deg, lift_in\n",
        "! VALVE LIFT\n! Crank Angle [deg]   Lift [in]\n",
        "# crank;in\n",
        "% crank_deg lift_in\n\n# nose at 90, see below\n",
    ],
)
def test_headings_over_blanks_and_behind_a_comment_s_mark_are_taken(head):
    rows = read_table(head + "0 0\n180 0.5\n360 0\n")
    assert np.degrees(rows.theta) == pytest.approx([0, 90, 180])
    assert rows.s[1] == pytest.approx(12.7)


@pytest.mark.parametrize(
    "head", ["# cam degrees\n", "# opening ramp\n", "# crank_deg lift_in a\n", "# 2 crank\n", "deg mm\n# crank in\n"]
)
def test_comments_that_do_not_name_an_angle_and_a_value_are_none_of_the_headings(head):
    rows = read_table(head + "0 0\n90 0.5\n180 0\n")
    assert np.degrees(rows.theta) == pytest.approx([0, 90, 180])
    assert rows.s[1] == 0.5


def test_a_comment_below_the_first_row_is_no_heading():
    assert read_table("0 0\n# crank_deg lift_in\n90 0.5\n").s[1] == 0.5


@pytest.mark.parametrize("heading", ["deg;deg", "phi;deg", "x;deg"])
def test_the_first_column_is_the_angle_where_headings_do_not_tell(heading):
    assert np.degrees(read_table(f"{heading}\n10;0\n20;1\n", Sheet("angle")).theta) == pytest.approx([10, 20])


def test_scale_and_offset_come_before_the_reading():
    rows = read_table("0;0,00\n90;1,25\n", Sheet("length", unit="inch", scale=1.6, offset=-0.2))
    assert rows.s == pytest.approx([-0.2 * 25.4, 1.8 * 25.4])
    assert rows.rounding == pytest.approx(0.008 * 25.4)


def test_angle_and_lift_of_one_word_stand_out():
    rows = read_table("CrankAngle,ValveLift,Velocity\n0,0.0,1\n20,1.5,3\n")
    assert rows.s.tolist() == [0, 1.5]
    assert np.degrees(rows.theta) == pytest.approx([0, 10])


def test_displacement_stands_out_among_its_derivatives():
    rows = read_table("t, deg, s (mm), v (mm/deg), a\n1, 0, 0.0, 1, 2\n2, 10, 1.5, 3, 4\n")
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


@pytest.mark.parametrize("mark", [";", ",", "\t"])
def test_a_shorter_column_ends_before_the_longer_ones(mark):
    text = "\n".join(
        mark.join(row) for row in (("a", "b", "c", "d"), ("0", "1", "0", "2"), ("5", "2", "9", "3"), ("7", "4", "", ""))
    )
    rows = read_table(text, Sheet("length", (3, 4)))
    assert np.degrees(rows.theta) == pytest.approx([0, 9])
    assert rows.lines.tolist() == [2, 3]
    with pytest.raises(IntentError, match=r"line 4: (?:column 4 is empty|2 columns, and 4 are expected)"):
        read_table(text + f"\n8{mark}5{mark}12{mark}", Sheet("length", (1, 4)))


def test_one_column_is_counted_by_its_step():
    rows = read_table("lift_in\n0\n0.1\n0.25\n", Sheet("length", Counted("lift", 4.0), "crank"))
    assert np.degrees(rows.theta) == pytest.approx([0, 2, 4])
    assert rows.s == pytest.approx([0, 2.54, 6.35])
    with pytest.raises(
        IntentError, match=r"1 column, and 2 are expected; for one of .* give columns: \{column: 1, step: 2\}"
    ):
        read_table("0\n0.1\n0.25\n")


@pytest.mark.parametrize(
    ("heading", "angle", "times"),
    [
        ("Time (sec);Lift1", None, (0, 0.25)),
        ("t [s];s", None, (0, 0.25)),
        ("t_ms;s", None, (0, 250)),
        ("0;0", "seconds", (0, 0.25)),
    ],
)
def test_times_are_angles_of_a_cam_that_turns_once_a_period(heading, angle, times):
    text = f"{heading}\n" * (";s" in heading.lower() or ";l" in heading.lower()) + f"{times[0]};0\n{times[1]};1\n"
    assert np.degrees(read_table(text, Sheet("length", angle=angle, period=0.5)).theta) == pytest.approx([0, 180])


@pytest.mark.parametrize(
    ("heading", "sheet", "message", "field"),
    [
        ("time_sec;s", Sheet("length"), "of times give `period`", "angle"),
        ("time_sec;s", Sheet("length", angle="cam", period=1.0), "is in seconds, not in degrees", "angle"),
        ("deg;s", Sheet("length", period=1.0), "the column 'deg' has angles; give angle: seconds", "period"),
    ],
)
def test_times_without_their_period_and_a_period_without_times_are_refused(heading, sheet, message, field):
    with pytest.raises(IntentError, match=message) as caught:
        read_table(f"{heading}\n0;0\n1;1\n", sheet)
    assert caught.value.field == f"motion.table.{field}"


@pytest.mark.parametrize(
    ("cells", "decimals"),
    [
        ("0 0.00191 0.01912 0.1913 1.913 2.5 9.131 9.9 10.2 11.34", "5 5 5 4 3 3 3 3 2 2"),
        ("0 0.5 2.25 10 9.75", "2 2 2 2 2"),
        ("0.000 0.001 0.019 2.500 10.200", "3 3 3 3 3"),
        ("10 20 30 15", "0 0 0 0"),
        ("1.5e-3 2.25e0 1.125e1 1.25e1", "4 4 4 4"),
        ("1.1 1.2 1.3 1.4 1.5 1.6 1.7 1.8 1.9 2.1 0.22 2.3", "1 1 1 1 1 1 1 1 1 1 2 1"),
    ],
)
def test_a_row_is_rounded_to_the_digits_that_rows_of_its_size_show(cells, decimals):
    rows = read_table("\n".join(f"{10 * k};{cell}" for k, cell in enumerate(cells.split())))
    assert (-np.log10(2.0 * rows.rounding)).round().astype(int).tolist() == [int(word) for word in decimals.split()]
