"""Motions through points: they meet them, rest beside dwells, are of the sixth order; what are no points.

Holds: kin.law.sources.spline.
"""

import math

import numpy as np
import pytest

from kin.law.normalised import IntentError
from kin.law.sources.points import from_points
from kin.law.support_function import lift_constant_breadth

TURN = 2 * math.pi
rad = math.radians


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


@pytest.mark.parametrize("level", [0.0, 4.0])
def test_a_last_point_after_a_whole_turn_is_the_first(level):
    """With equal neighbours over the end of the turn it bounds a dwell, as the point at 0 does."""
    late, early = np.radians([30.0, 180.0, 360.0]), np.radians([0.0, 30.0, 180.0])
    dwells = ([(TURN, TURN + rad(30))], [(0.0, rad(30))]) if level == 0.0 else ([], [])
    last = from_points(late, [0.0, 10.0, level], dwells=dwells[0])
    first = from_points(early, [level, 0.0, 10.0], dwells=dwells[1])
    theta = np.linspace(0, TURN, 50)
    assert last.derivatives(theta, 2) == pytest.approx(first.derivatives(theta, 2), abs=1e-12)


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


def test_a_dwell_that_climbs_is_told_in_the_unit_of_the_points():
    with pytest.raises(IntentError, match=r"it would climb from 1 to 2$"):
        from_points(np.radians([0.0, 90.0, 180.0]), [0.0, 25.4, 50.8], dwells=[(rad(90), rad(180))], unit=25.4)


def test_points_over_a_half_turn_go_on_upside_down():
    theta = np.radians(np.arange(0.0, 181.0, 15.0))
    motion = from_points(theta, 6 * (1 - np.cos(theta)) + 0.3 * (1 - np.cos(3 * theta)), math.pi, around=-1)
    assert motion.joints == ()
    assert lift_constant_breadth(40.0, motion).derivatives(0.0, 0)[0, 0] == pytest.approx(40, abs=1e-12)
