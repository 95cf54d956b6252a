"""Programmes of segments: strokes, matched segments, formulas; joints told with what jumps; motions by formula.

Holds: kin.law.joints.
"""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from support.cases import examples

from kin.law.formula.formula import Formula
from kin.law.normalised import IntentError, polynomial_law
from kin.law.sources.laws import NAMES, named, scca, split
from kin.law.sources.motion import Motion
from kin.law.sources.peaks import peaks
from kin.law.sources.programme import Dwell, Given, JointState, Matched, Move, RiseAndFall, programme
from kin.law.sources.whole_turn import from_formula
from kin.law.support_function import lift_constant_breadth

TURN = 2 * math.pi
rad = math.radians
SMOOTH = [name for name in NAMES if math.isfinite(peaks(named(name).motion).jerk)]


def rise(degrees, by, name="modified-sine"):
    return Move(rad(degrees), named(name), by=by)


def to(degrees, level, name="modified-sine"):
    return Move(rad(degrees), named(name), to=level)


def dwell(degrees):
    return Dwell(rad(degrees))


def closed(*segments):
    """Segments and a dwell that fills the turn."""
    return programme([*segments, Dwell(TURN - math.fsum(s.over for s in segments))], TURN)


def test_absolute_strokes_land_on_their_level():
    motion = programme([to(90, 12.0), to(60, 3.5, "cycloidal"), dwell(60), to(60, -2.0), to(90, 0.0)], TURN)
    at = np.radians([90, 150, 180, 270, 360])
    assert motion.derivatives(at, 0, -1)[0] == pytest.approx([12, 3.5, 3.5, -2, 0], abs=1e-15)
    assert motion.range == pytest.approx((-2, 12), abs=1e-15)
    assert motion.from_lowest().range == pytest.approx((0, 14), abs=1e-15)
    assert [(math.degrees(r.begin), math.degrees(r.end), r.level) for r in motion.rests] == [
        pytest.approx((150, 210, 3.5))
    ]


@pytest.mark.parametrize("law", [named("double-harmonic"), polynomial_law([0, 0, 0, 4, -3])], ids=lambda law: law.name)
def test_a_return_runs_an_asymmetric_law_backwards(law):
    motion = closed(Move(rad(120), law, by=8.0), Move(rad(120), law, by=-8.0))
    u = np.linspace(0.01, 0.99, 41)
    assert np.abs(law.derivatives(u, 0)[0] + law.derivatives(1.0 - u, 0)[0] - 1.0).max() > 0.1
    up, down = motion.derivatives(u * rad(120), 0)[0], motion.derivatives(rad(120) * (2 - u), 0)[0]
    assert up == pytest.approx(down, abs=1e-14)
    # S'' is the same on both sides of the turn: only rest-to-motion jerks are left
    assert all(jump[0] >= 3 for joint in motion.joints for jump in joint.jumps)


def test_a_split_polynomial_accelerates_over_its_share_of_a_return_too():
    """A symmetric one alone can be split: of a return the share is that of the segment, from its start."""
    law = split(polynomial_law([0, 0, 3, -2]), 0.2)
    motion = closed(Move(rad(120), law, by=8.0), Move(rad(120), law, by=-8.0))
    bend = motion.derivatives(rad(120) * (1.0 + np.array([0.1, 0.19, 0.21, 0.9])), 2)[2]
    assert np.sign(bend).tolist() == [-1.0, -1.0, 1.0, 1.0]


@settings(max_examples=examples(30), deadline=None)
@given(
    st.lists(st.tuples(st.sampled_from(SMOOTH), st.floats(20, 100), st.floats(0.5, 30)), min_size=1, max_size=3),
    st.floats(0.2, 0.8),
)
def test_smooth_laws_join_and_close(drawn, share):
    moves = [Move(rad(over), split(named(name), share), by=stroke) for name, over, stroke in drawn]
    motion = closed(*moves, to(40, 0.0))
    assert all(jump[0] == 3 for joint in motion.joints for jump in joint.jumps)
    motion.demand_joined()
    whole = motion.periodic()
    assert whole.period == TURN
    theta = np.linspace(0, TURN, 200, endpoint=False)
    assert (whole.derivatives(theta, 2) == whole.derivatives(theta + TURN, 2)).mean() > 0.5
    mid, rad_ = motion.enclosure(theta[:-1], theta[1:], 4)
    sample = motion.derivatives(0.5 * (theta[:-1] + theta[1:]), 4)
    assert (np.abs(sample - mid) <= rad_ * (1 + 1e-12)).all()


def test_a_jump_is_told_with_what_jumps():
    motion = closed(rise(120, 10.0, "parabolic"), rise(120, -10.0, "harmonic"))
    peak = 4 * 10 / rad(120) ** 2
    told = {round(math.degrees(j.at)): j for j in motion.joints}
    # the parabola's steps at 0, 60 and 120, the harmonic's at 120 and 240
    assert sorted(told) == [0, 60, 120, 240]
    assert told[0].jumps[0] == pytest.approx((2, 0, peak))
    assert told[60].jumps == (pytest.approx((2, peak, -peak)),)
    assert told[60].said() == "S'' jumps from 9.11891 to -9.11891 mm/rad^2 at 60 degrees"
    motion.demand_joined()  # S and S' do join


def test_a_velocity_that_jumps_is_refused_where_it_does():
    motion = closed(rise(60, 10.0, "constant-velocity"), to(100, 0.0))
    with pytest.raises(IntentError) as caught:
        motion.demand_joined("law")
    assert caught.value.message.startswith("the motion does not join: S' jumps from 0 to 9.5493 mm/rad at 0 degrees; ")
    assert caught.value.field == "law"
    motion = programme([rise(60, 10.0), Dwell(rad(300))], TURN)
    with pytest.raises(IntentError, match="S jumps from 10 to 0 mm at 0 degrees"):
        motion.demand_joined()


@pytest.mark.parametrize("degree", [5, 7])
def test_matched_segments_take_their_neighbours_state(degree):
    window = Move(rad(60), named("constant-velocity"), by=15.0)
    match = Matched(degree)
    motion = programme(
        [Move(rad(60), match, by=5.0), window, Move(rad(60), match, by=4.0), to(120, 0.0), dwell(60)], TURN
    ).demand_joined()
    assert motion.derivatives(rad(60), 1)[:, 0] == pytest.approx([5, 15 / rad(60)], rel=1e-15)
    lowest = {jump[0] for joint in motion.joints for jump in joint.jumps[:1] if joint.at < rad(170)}
    assert lowest == ({3} if degree == 5 else set())


def test_a_match_across_the_end_takes_the_last_segment():
    motion = programme(
        [Move(rad(80), Matched(7), by=-4.0), to(100, 14.0), Move(rad(180), named("constant-velocity"), to=0.0)], TURN
    )
    before, after = motion.derivatives(TURN, 3, -1)[:, 0], motion.derivatives(0.0, 3)[:, 0]
    assert after == pytest.approx(before, abs=1e-12)


def test_the_quick_return_turns_with_the_given_acceleration():
    turn = JointState(0.0, -30.0)
    motion = closed(Move(rad(90), Matched(at_end=turn), by=10.0), Move(rad(70), Matched(), by=-10.0)).demand_joined()
    for side in (1, -1):
        assert motion.derivatives(rad(90), 2, side)[:, 0] == pytest.approx([10, 0, -30], abs=1e-13)
    given_after = closed(Move(rad(90), Matched(), by=10.0), Move(rad(70), Matched(at_start=turn), by=-10.0))
    theta = np.linspace(0, 3, 50)
    assert (given_after.derivatives(theta, 2) == motion.derivatives(theta, 2)).all()
    with pytest.raises(IntentError) as caught:
        closed(Move(rad(90), Matched(), by=10.0), Move(rad(70), Matched(), by=-10.0))
    assert caught.value.message == (
        "two matched segments meet at 90 degrees: give the first one `at_end: {v: ..., a: ...}`"
    )
    assert caught.value.field == "motion[0]"


def test_up_and_down_in_one_segment():
    motion = closed(dwell(30), RiseAndFall(rad(120), 6.0))
    u = np.array([0.0, 0.2, 0.5, 0.9])
    wanted = 6 * 64 * (u * (1 - u)) ** 3
    assert motion.derivatives(rad(30) + u * rad(120), 0)[0] == pytest.approx(wanted, abs=1e-14)
    for at, side in ((30, 1), (150, -1)):
        assert motion.derivatives(rad(at), 2, side)[:, 0].tolist() == [0, 0, 0]


def test_a_segment_by_formula_is_the_law_it_writes():
    formula = Formula("20*u**3*(10 - 15*u + 6*u**2)", ("u",))
    ours = closed(Given(rad(120), formula), to(100, 0.0))
    theirs = closed(rise(120, 20.0, "polynomial-345"), to(100, 0.0))
    theta = np.linspace(0, TURN, 300)
    assert ours.derivatives(theta, 4) == pytest.approx(theirs.derivatives(theta, 4), abs=1e-10)
    with pytest.raises(IntentError) as caught:
        closed(Given(rad(120), Formula("3 + u", ("u",))))
    assert caught.value.message == "a displacement counts from the segment's start: f(0) must be 0, not 3"
    assert caught.value.field == "motion[0].displacement"
    with pytest.raises(IntentError, match="derivative of it does not exist at u = 0: derivative of sqrt at zero"):
        closed(Given(rad(120), Formula("sqrt(u)", ("u",))))


def test_dwells_at_both_ends_are_one():
    motion = programme([dwell(30), rise(90, 4.0), to(120, 0.0), dwell(120)], TURN)
    assert [(math.degrees(r.begin), math.degrees(r.end)) for r in motion.rests] == [pytest.approx((240, 390))]
    whole = motion.periodic()
    assert len(whole.breaks) == 3 + 2 * 2  # 30, 120, 240 and the inner knots of two modified sines, no seam
    assert 0.0 not in whole.breaks


def test_a_half_turn_makes_a_constant_breadth_cam():
    motion = programme([rise(100, 12.0), Dwell(math.pi - rad(100))], math.pi, around=-1)
    assert all(jump[0] == 3 for joint in motion.joints for jump in joint.jumps)
    lift = lift_constant_breadth(40.0, motion)
    theta = np.linspace(0, math.pi, 50)
    breadth = lift.derivatives(theta, 0) + lift.derivatives(theta + math.pi, 0)
    assert breadth == pytest.approx(np.full((1, 50), 92.0), abs=1e-13)
    window = scca(0.25, 0.0, 0.4)
    matched = programme([Move(rad(60), Matched(), by=4.0), Move(rad(120), window, by=8.0)], math.pi, around=-1)
    assert matched.joints[0].jumps[0][0] == 3


@pytest.mark.parametrize(
    ("segments", "total", "message", "field"),
    [
        ([], TURN, "a motion needs at least one segment", "motion"),
        ([dwell(100)], TURN, "the segments cover 100 degrees, 360 are wanted", "motion"),
        ([dwell(0), dwell(360)], TURN, "the angle of a segment must be above 0, not 0 degrees", "motion[0]"),
        ([rise(360, 0.0)], TURN, "the stroke of a segment must be a number other than 0, not 0", "motion[0]"),
        ([rise(180, 5.0), to(180, 5.0)], TURN, "the motion is there already; write a dwell", "motion[1].to"),
        (
            [Move(rad(360), named("cubic"), by=1.0, to=2.0)],
            TURN,
            "a segment has either a stroke or an absolute displacement",
            "motion[0]",
        ),
        (
            [Move(rad(360), Matched(6), by=1.0)],
            TURN,
            "a matched segment has degree 5 or 7, not 6",
            "motion[0].law",
        ),
    ],
)
def test_what_is_no_programme_is_refused(segments, total, message, field):
    with pytest.raises(IntentError) as caught:
        programme(segments, total)
    assert (caught.value.message, caught.value.field) == (message, field)


def test_a_motion_by_formula():
    motion = from_formula(Formula("3*(1 - cos(t)) + 0.2*(1 - cos(3*t))"))
    assert motion.joints == ()
    assert motion.range == pytest.approx((0, 6.4), abs=1e-14)
    assert len(motion.periodic().breaks) == 0
    kinked = from_formula(Formula("5*max(0, sin(t))**3"), scale=2.0)
    assert kinked.rests[0].level == 0
    assert [round(math.degrees(j.at)) for j in kinked.joints] == [0, 180]
    assert all(j.jumps[0][0] == 3 for j in kinked.joints)
    with pytest.raises(IntentError, match=r"S jumps from 6.28319 to 0 mm at 0 degrees"):
        from_formula(Formula("t")).demand_joined()
    with pytest.raises(IntentError, match=r"the displacement does not exist at .* degrees: log of a number"):
        from_formula(Formula("log(sin(t))"))


def test_a_motion_keeps_its_kind():
    motion = closed(rise(90, 3.0), to(90, 0.0))
    assert isinstance(motion.raised(2.0), Motion)
    assert motion.raised(2.0).rests[0].level == 2.0
    assert motion.from_lowest() is motion
