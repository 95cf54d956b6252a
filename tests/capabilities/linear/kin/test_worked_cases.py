"""Worked linear cams: each figure was also found by brute force that knows positions alone (mpmath, 30 digits)."""

import math

import numpy as np
import pytest
from capabilities.linear.kin.contours import endless, flank, moved, on_arm, on_stem
from support.programmes import Segment, law, programme

from kin.linear.follower import Arm, LinearFollower, Stem
from kin.linear.parallels import parallel_lift, pressure_angles
from kin.linear.undercut import cuts
from kin.numeric.records import replace


def close(found, wanted):
    np.testing.assert_allclose(found, wanted, rtol=1e-10, atol=1e-11)


def degrees(angles):
    return [math.degrees(angles.greatest.value), math.degrees(angles.least.value)]


def test_a_roller_on_an_upright_guide():
    points = [
        [28.7109284815, 35.8854503349],
        [39.9975603804, 43.7530495245],
        [89.912704276, 48.3217567840],
        [106.268333458, 34.9939670576],
    ]
    close(flank(on_stem(), np.array([25.0, 35.0, 95.0, 110.0])), points)
    close(degrees(pressure_angles(on_stem())), [38.6598082541, -43.1523897340])


@pytest.mark.parametrize(
    ("lean", "points", "steepest"),
    [
        (-15.0, [[41.9015121853, 42.9216581251], [96.4515204165, 44.5268825082]], [47.6268296005, -35.0927299366]),
        (15.0, [[37.9952010935, 43.9298831783], [92.7002609681, 43.1938650057]], [29.2606780669, -51.0820766970]),
    ],
)
def test_a_guide_that_leans(lean, points, steepest):
    close(flank(on_stem(lean=lean), np.array([35.0, 100.0])), points)
    close(degrees(pressure_angles(on_stem(lean=lean))), steepest)


@pytest.mark.parametrize(
    ("side", "points", "steepest"),
    [
        (1, [[-13.9395985076, 35.8179670663], [40.492552215, 35.4788752446]], [35.8636093995, -48.2433969713]),
        (-1, [[104.187178893, 35.2280366667], [158.560596551, 36.1986263922]], [45.4167468473, -39.6087028485]),
    ],
)
def test_an_arm(side, points, steepest):
    close(flank(on_arm(side), np.array([40.0, 105.0])), points)
    close(degrees(pressure_angles(on_arm(side))), steepest)


def test_a_groove():
    upper = flank(on_stem(), np.array([35.0, 100.0]), 1, 0.05)
    close(upper[0], [29.9712048672, 56.2859939160])
    close(upper[1], [105.505726087, 55.8727744933])
    lift = on_stem().law.derivatives(np.array([35.0]), 0)[0]
    close(parallel_lift(on_stem(), 0.05, np.array([35.0])) - lift, [0.0640312102939])


def test_an_undercut_crest():
    large = on_stem(radius=30.0, level=60.0)
    rise = LinearFollower(Stem(), 30.0, 60.0, moved(back=240.0))  # so gentle a return is not cut
    (cut,) = cuts(rise)
    close([cut.begin, cut.end, *cut.corner], [41.3071793956, 57.6866928251, 58.1900959587, 49.9912463119])
    close(cut.lost, 0.178261447960)
    assert cut.lost_at == pytest.approx(49.301755, abs=1e-6)
    # the return of the whole motion is sharper still
    assert [round(cut.lost, 6) for cut in cuts(large)] == [0.178261, 0.757847]


def test_an_undercut_below_an_arm_is_found_to_the_rounding_of_its_lift():
    sharp = [
        Segment("dwell", 7.06),
        Segment("rise", 12.25, math.radians(4.95), law("polynomial-4567")),
        Segment("dwell", 45.51),
        Segment("return", 14.16, math.radians(4.95), law("modified-trapezoid")),
        Segment("dwell", 39.93),
    ]
    follower = LinearFollower(Arm(85.5, 47.21, -1), 10.43, 42.67, programme(sharp, 118.91).motion)
    # the follower set down on all that 6,000 rollers leave, at steps of 0.0007 mm about each corner
    lost = [math.degrees(cut.lost) for cut in cuts(follower)]
    assert lost == pytest.approx([0.48008, 0.15993], abs=2e-4)


def test_a_knife_edge():
    knife = on_stem(radius=0.0)
    close(flank(knife, np.array([35.0])), [[35.0, 50.0]])
    assert cuts(knife) == ()


def test_an_endless_plate():
    low = replace(endless(), level=20.0)
    close(flank(low, np.array([10.0, 17.0])), [[13.706006949, 20.2813653994], [19.0151132944, 23.8035444620]])
    close(flank(low, np.array([130.0]))[:, 1], [20.2813653994])


def test_contacts_at_the_ends_of_constant_velocity():
    segment = Segment("rise", 100.0, 12.0, law("constant-velocity"))
    uniform = on_stem(radius=10.0, level=30.0, motion=programme([segment], 100.0).motion)
    points = flank(uniform, np.array([0.0, 100.0]))
    close(points[:, 0] - [0.0, 100.0], [1.19145220618, 1.19145220618])
    close(points[:, 1], [20.0712316151, 32.0712316151])
