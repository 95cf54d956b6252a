"""Tables smoothed within their reading error, points, and lobes; what is no table is refused with its line."""

import math

import numpy as np
import pytest

from kin.law.programme import IntentError
from kin.law.sources.laws import named
from kin.law.sources.lobe import coefficients, lobe
from kin.law.sources.points import from_points
from kin.law.sources.programme import Dwell, Move, programme
from kin.law.sources.ring import Samples
from kin.law.sources.smoothing import TableError
from kin.law.sources.table import from_table
from kin.law.sources.table_text import read_table
from kin.law.support_function import lift_constant_breadth

TURN = 2 * math.pi
rad = math.radians
VALVE = lobe(8.0, rad(68), (2, 8, 14, 20, 26))
PLATE = programme(
    [
        Move(rad(100), named("modified-sine"), by=20.0),
        Dwell(rad(60)),
        Move(rad(140), named("modified-trapezoid"), by=-20.0),
        Dwell(rad(60)),
    ],
    TURN,
)


def event():
    """The valve's lift at every degree of its event, rounded to a thousandth."""
    theta = np.radians(np.arange(-68.0, 69.0))
    return Samples(theta, np.round(VALVE.derivatives(np.mod(theta, TURN), 0)[0], 3), np.arange(137) + 1)


def plate(count=360, places=3):
    theta = np.arange(count) * (TURN / count)
    return Samples(theta, np.round(PLATE.derivatives(theta, 0)[0], places), np.arange(count) + 1)


# --- the lobe polynomial -----------------------------------------------------------------------------------------


def test_the_lobe_has_the_coefficients_and_lifts_of_its_closed_form():
    found = coefficients((2, 8, 14, 20, 26))
    assert found == pytest.approx((-1.872427984, 1.872427984, -1.604938272, 0.748971193, -0.144032922), abs=5e-10)
    p, q, r, s = 8, 14, 20, 26
    assert found[0] == pytest.approx(-p * q * r * s / ((p - 2) * (q - 2) * (r - 2) * (s - 2)), rel=1e-15)
    assert found[1] == pytest.approx(2 * q * r * s / ((p - 2) * (q - p) * (r - p) * (s - p)), rel=1e-15)
    lifts = VALVE.derivatives(np.radians([0.0, 20.0, 45.0]), 0)[0]
    assert lifts == pytest.approx([8, 6.705040433, 1.952853268], abs=5e-10)
    assert VALVE.derivatives(np.radians([320.23336]), 1)[1] == pytest.approx([12.538158514], abs=5e-9)


def test_a_lobe_ends_with_four_derivatives_at_rest():
    assert VALVE.derivatives(rad(68), 4, -1)[:, 0].tolist() == [0, 0, 0, 0, 0]
    assert VALVE.derivatives(TURN - rad(68), 4)[:, 0] == pytest.approx([0] * 5, abs=0)
    assert VALVE.joints == ()
    theta = np.linspace(0.01, rad(67.9), 50)
    u = theta / rad(68)
    powers = zip(coefficients((2, 8, 14, 20, 26)), (2, 8, 14, 20, 26), strict=True)
    plain = 8 * (1 + sum(c * u**k for c, k in powers))
    assert VALVE.derivatives(theta, 0)[0] == pytest.approx(plain, abs=1e-13)
    assert VALVE.derivatives(TURN - theta, 0)[0] == pytest.approx(plain, abs=1e-13)


@pytest.mark.parametrize(
    ("lift", "half", "powers", "message"),
    [
        (0.0, 1.0, (2, 4, 6, 8, 10), "the lift of a lobe must be above 0, not 0"),
        (1.0, 3.2, (2, 4, 6, 8, 10), "half the event lies between 0 and 180 degrees, not 183.346"),
        (
            1.0,
            1.0,
            (2, 8, 8, 20, 26),
            (
                "the powers of a lobe are 2 and four more whole numbers that rise to 100 at most, "
                "such as [2, 8, 14, 20, 26], not [2, 8, 8, 20, 26]"
            ),
        ),
    ],
)
def test_what_is_no_lobe_is_refused(lift, half, powers, message):
    with pytest.raises(IntentError) as caught:
        lobe(lift, half, powers)
    assert caught.value.message == message


# --- tables ------------------------------------------------------------------------------------------------------


def test_the_valve_table_smoothed_by_32_spans():
    """Nine digits of the worked case: least squares over the event, the base circle exact."""
    smoothed = from_table(event(), 0.001, spans=32)
    assert smoothed.residual == pytest.approx(0.000528062, abs=5e-10)
    theta = np.linspace(-rad(68), rad(68), 40001)
    folded = np.mod(theta, TURN)
    off = np.abs(smoothed.motion.derivatives(folded, 2) - VALVE.derivatives(folded, 2)).max(axis=1)
    assert off == pytest.approx([0.000314, 0.007518, 0.28236], abs=2e-5)
    for at, side in ((rad(68), -1), (TURN - rad(68), 1)):
        assert smoothed.motion.derivatives(at, 2, side)[:, 0].tolist() == [0, 0, 0]
    # the table's own second differences are 18 times worse
    second = np.diff(event().s, 2) / rad(1) ** 2
    true = VALVE.derivatives(np.mod(event().theta[1:-1], TURN), 2)[2]
    assert np.abs(second - true).max() > 18 * off[2]


@pytest.mark.parametrize(("reading", "most"), [(0.001, 22), (0.0005, 34)])
def test_the_fewest_spans_hold_the_reading(reading, most):
    smoothed = from_table(event(), reading)
    assert smoothed.spans <= most
    assert smoothed.residual <= reading
    theta = np.mod(event().theta, TURN)
    off = np.abs(smoothed.motion.derivatives(theta, 0)[0] - event().s)
    assert off.max() == pytest.approx(smoothed.residual, abs=1e-12)
    assert off[smoothed.line - 1] == pytest.approx(smoothed.residual, abs=1e-12)
    assert from_table(event(), reading, spans=smoothed.spans - 1).residual > reading


def test_dwells_are_found_exact_and_where_they_are():
    smoothed = from_table(plate(), 0.001)
    found = [(math.degrees(r.begin), math.degrees(r.end), r.level) for r in smoothed.motion.rests]
    assert found == [pytest.approx((100, 160, 20)), pytest.approx((300, 360, 0))]
    assert smoothed.motion.demand_joined()
    assert all(jump[0] == 3 for joint in smoothed.motion.joints for jump in joint.jumps)
    theta = np.linspace(0, TURN, 1000)
    assert smoothed.motion.derivatives(theta, 0)[0] == pytest.approx(PLATE.derivatives(theta, 0)[0], abs=1.5e-3)
    # rotated, with the dwell over the end of the turn
    rows = plate()
    moved = from_table(Samples(rows.theta, np.roll(rows.s, 330), rows.lines), 0.001)
    assert [math.degrees(r.end) for r in moved.motion.rests] == [pytest.approx(130), pytest.approx(330)]


def test_a_measured_dwell_is_given():
    rows = plate()
    rng = np.random.default_rng(5)
    noisy = Samples(rows.theta, rows.s + rng.uniform(-0.0008, 0.0008, 360), rows.lines)
    smoothed = from_table(noisy, 0.002, dwells=[(rad(100), rad(160)), (rad(300), rad(360))])
    assert [r.level for r in smoothed.motion.rests] == pytest.approx([20, 0], abs=5e-4)
    with pytest.raises(TableError, match=r"line 166: the row is not part of a dwell at 19.99"):
        from_table(noisy, 0.002, dwells=[(rad(100), rad(165))])


def test_a_hundred_thousand_rows():
    smoothed = from_table(plate(100_000), 0.001)
    assert smoothed.spans < 40
    assert smoothed.residual <= 0.001


def test_a_table_without_a_dwell_is_periodic():
    theta = np.arange(240) * (TURN / 240)
    rows = Samples(theta, 5 - 5 * np.cos(theta) + 0.3 * np.sin(2 * theta), np.arange(240))
    motion = from_table(rows, 1e-4).motion
    assert motion.joints == ()
    again = Samples(np.append(theta, TURN), np.append(rows.s, rows.s[0]), np.arange(241))
    assert from_table(again, 1e-4).motion.derivatives(theta, 4) == pytest.approx(motion.derivatives(theta, 4))
    mid, radius = motion.enclosure(theta[:-1], theta[1:], 4)
    inside = motion.derivatives(0.5 * (theta[:-1] + theta[1:]), 4)
    assert (np.abs(inside - mid) <= radius).all()


def test_a_table_over_a_half_turn_closes_upside_down():
    theta = np.radians(np.arange(181.0))
    rows = Samples(theta, np.round(2.5 + 6 * (1 - np.cos(theta)) + 0.3 * (1 - np.cos(3 * theta)), 4), np.arange(181))
    smoothed = from_table(rows, 1e-4, math.pi, around=-1)
    assert smoothed.motion.joints == ()
    assert smoothed.motion.derivatives(0.0, 0)[0, 0] == pytest.approx(0, abs=1e-12)
    lift = lift_constant_breadth(40.0, smoothed.motion)
    assert lift.derivatives(0.3, 0) + lift.derivatives(0.3 + math.pi, 0) == pytest.approx(92.6, abs=2e-4)


def broken(change):
    rows = plate()
    theta, s, lines = rows.theta.copy(), rows.s.copy(), rows.lines
    return Samples(*change(theta, s, lines))


def outlier(theta, s, lines):
    s[50] += 0.05
    return theta, s, lines


def step(theta, s, lines):
    s[50:130] += 1.0
    return theta, s, lines


def noise(theta, s, lines):
    return theta, s + 0.02 * np.sin(1e4 * np.arange(360.0) ** 2), lines


def back(theta, s, lines):
    theta[50] = theta[48] - 1e-3
    return theta, s, lines


def twice(theta, s, lines):
    theta[50] = theta[49]
    return theta, s, lines


def gap(theta, s, lines):
    kept = np.r_[:50, 53:360]
    return theta[kept], s[kept], lines[kept]


def unfinished(theta, s, lines):
    return theta[:200], s[:200], lines[:200]


def hole(theta, s, lines):
    s[50] = math.nan
    return theta, s, lines


def climbing(theta, s, lines):
    return np.append(theta, TURN), np.append(s, 3.0), np.append(lines, 361)


@pytest.mark.parametrize(
    ("change", "line", "message"),
    [
        (outlier, 51, "the row does not lie on a smooth curve with its neighbours: it is 10.05 mm, about "),
        (step, 51, "the displacement steps from 9.648 mm to 11 mm here"),
        (noise, None, "the rows scatter about any smooth curve: the closest one is 0.0"),
        (back, 51, "the angles must rise; 47.94"),
        (twice, 51, "the angles must rise; 49 stands twice"),
        (gap, 54, "rows are missing between 49 and 53 degrees; the steps beside it are 1"),
        (unfinished, 200, "the table ends after 199 degrees, 17.299 mm off its first row: the rest of the turn can be"),
        (hole, 51, "the displacement is not finite"),
        (climbing, 361, "the motion does not close: 3 mm off the first row, a turn later"),
    ],
)
def test_what_is_no_motion_is_refused_with_its_line(change, line, message):
    with pytest.raises(TableError) as caught:
        from_table(broken(change), 0.001)
    assert message in caught.value.message
    if line is not None:
        assert caught.value.line == line
    assert caught.value.message.startswith(f"line {caught.value.line}: ")


def test_scatter_is_smoothed_with_the_reading_that_it_has():
    assert from_table(broken(noise), 0.03).spans < 60


# --- tables as text ----------------------------------------------------------------------------------------------


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
    rows, unit = read_table(text, angles="crank", unit="inch")
    assert np.degrees(rows.theta) == pytest.approx([0, 1, 2])
    assert rows.s == pytest.approx([0, 2.54, 6.35])
    assert rows.lines.tolist() == [3, 4, 5]
    assert unit == pytest.approx(0.254)
    assert read_table(text, unit="degrees")[0].s == pytest.approx(np.radians([0, 0.1, 0.25]))


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (
            "w;lift\n0;1\n1;x\n",
            "line 3: '1;x' is not a row separated by semicolons: an angle and a displacement are expected",
        ),
        (
            "0,1,0,2\n1,5,0,3\n",
            (
                "line 1: '0,1,0,2' is not a row separated by commas: an angle and a displacement are expected: with "
                "decimal commas, separate the columns by semicolons"
            ),
        ),
        (
            "0 1 2\n1 2 3\n",
            "line 1: '0 1 2' is not a row separated by blanks: an angle and a displacement are expected",
        ),
        ("# nothing\n", "the table is empty"),
    ],
)
def test_what_is_no_row_is_refused_with_its_line(text, message):
    with pytest.raises(IntentError) as caught:
        read_table(text)
    assert caught.value.message == message


def test_a_table_goes_from_text_to_motion():
    rows = event()
    text = "\n".join(f"{2 * math.degrees(t):.1f};{s:.3f}" for t, s in zip(rows.theta, rows.s, strict=True))
    found, unit = read_table(text.replace(".", ","), angles="crank")
    assert unit == 0.001
    smoothed = from_table(found, unit)
    assert smoothed.motion.rests[0].level == 0
    assert smoothed.spans == from_table(rows, 0.001).spans


# --- points ------------------------------------------------------------------------------------------------------


def test_points_without_a_dwell_are_periodic():
    at = np.radians([0.0, 70.0, 120.0, 200.0, 290.0, 360.0])
    motion = from_points(at, [0.0, 4.0, 6.0, 5.0, 1.0, 0.0])
    assert motion.joints == ()
    assert motion.derivatives(at, 0)[0] == pytest.approx([0, 4, 6, 5, 1, 0], abs=1e-13)
    assert np.abs(motion.motion.jumps(4)[1]).max() < 1e-10  # C4
    assert np.abs(motion.motion.jumps(5)[1][5]).max() > 1
    theta = np.linspace(0, TURN, 100)
    mid, radius = motion.enclosure(theta[:-1], theta[1:], 3)
    assert (np.abs(motion.derivatives(0.5 * (theta[:-1] + theta[1:]), 3) - mid) <= radius).all()


def test_points_rest_beside_dwells():
    at = np.radians([0.0, 40.0, 100.0, 160.0, 200.0, 300.0])
    values = [0.0, 3.0, 10.0, 10.0, 7.0, 0.0]
    motion = from_points(at, values, dwells=[(at[2], at[3]), (at[5], TURN)])
    assert [(r.begin, r.end, r.level) for r in motion.rests] == [
        pytest.approx((at[2], at[3], 10)),
        pytest.approx((at[5], TURN, 0)),
    ]
    assert motion.derivatives(at, 0)[0] == pytest.approx(values, abs=1e-14)
    for joint in motion.joints:
        assert [jump[0] for jump in joint.jumps] == [3]
    assert motion.derivatives(at[2], 2, -1)[:, 0] == pytest.approx([10, 0, 0], abs=1e-13)


def test_a_smooth_function_is_met_closer_by_more_points():
    off = []
    for count in (12, 24):
        theta = np.arange(count) * (TURN / count)
        motion = from_points(theta, np.sin(theta) + 0.2 * np.cos(3 * theta))
        x = np.linspace(0, TURN, 500)
        off.append(np.abs(motion.derivatives(x, 0)[0] - np.sin(x) - 0.2 * np.cos(3 * x)).max())
    assert off[0] / off[1] > 2**5.5  # of the sixth order


@pytest.mark.parametrize(
    ("degrees", "values", "dwells", "message", "field"),
    [
        ([0, 90, 80], [0, 1, 2], [], "the angles must rise; 80 follows 90 degrees", "motion.points[2]"),
        ([0, 90], [0, 1], [], "a motion needs 3 points, or two and a dwell", "motion.points"),
        ([0, 90, 400], [0, 1, 0], [], "the angles lie between 0 and 360 degrees", "motion.points"),
        (
            [0, 90, 360],
            [0, 1, 2],
            [],
            "the motion does not close: it is 0 at the first point, 2 a turn later; give both the same displacement",
            "motion.points[2]",
        ),
        ([0, 90, 180], [0, 1, 2], [(90, 170)], "no point stands at 170 degrees, where a dwell ends", "motion.points"),
        (
            [0, 90, 180],
            [0, 1, 2],
            [(90, 180)],
            "no dwell from 90 to 180 degrees: it would climb from 1 to 2",
            "motion.points",
        ),
        (
            [0, 90, 180],
            [0, 1, 0],
            [(0, 180)],
            "a dwell runs from a point to the next; from 0 to 180 is none",
            "motion.points",
        ),
    ],
)
def test_what_are_no_points_is_refused(degrees, values, dwells, message, field):
    with pytest.raises(IntentError) as caught:
        from_points(np.radians(degrees), values, dwells=[(rad(a), rad(b)) for a, b in dwells])
    assert (caught.value.message, caught.value.field) == (message, field)


def test_points_over_a_half_turn_go_on_upside_down():
    theta = np.radians(np.arange(0.0, 181.0, 15.0))
    motion = from_points(theta, 6 * (1 - np.cos(theta)) + 0.3 * (1 - np.cos(3 * theta)), math.pi, around=-1)
    assert motion.joints == ()
    assert lift_constant_breadth(40.0, motion).derivatives(0.0, 0)[0, 0] == pytest.approx(40, abs=1e-12)
