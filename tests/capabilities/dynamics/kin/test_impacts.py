"""Loss of contact, flight and impacts: closed forms, and a second opinion by scipy.

Holds: kin.dynamics.cycle, kin.dynamics.flight.
"""

import math
import re

import numpy as np
import pytest
from support.cases import few
from support.drives import Harmonic, Saw, Still
from support.dynamics_oracle import Cycloid
from support.integrated import integrated
from support.places import ROOT
from support.trains import stiff

from camgeo.recipe.loading import load
from camgeo.synthesis.design import designed
from kin.dynamics.drive import drives
from kin.dynamics.events import FREE, LOWER, UPPER
from kin.dynamics.excitation import intended_faces
from kin.dynamics.impacts import MOST_WORK, ContactState, course, least_gap
from kin.dynamics.train import DynamicsError, Train, steady
from kin.follower.drive import Shifted
from kin.follower.roller import DoubleRoller

TURN = 2.0 * math.pi


def faces(lower, upper=None):
    found = drives([lower] if upper is None else [lower, upper])
    return found[0], found[1] if upper is not None else None


# --- closed forms -----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("stiffness", [1e4, 1e7, 1e11])
def test_a_follower_that_falls_on_a_still_face(stiffness):
    """Under a constant preload it drops with F/m, meets the face with sqrt(2 h F/m), and bounces for ever."""
    mass, preload, height, rpm = 0.5, 20.0, 1e-3, 600.0
    train = Train(mass, 0.0, stiffness, preload)
    w = rpm * TURN / 60.0
    found = course(train, faces(Still()), rpm, 1, ContactState(FREE, height, 0.0)).turns[0]
    speed = math.sqrt(2.0 * height * preload / mass)
    assert found.velocity == pytest.approx(speed, rel=1e-10)
    # a half swing about -F/k from 0 with that speed
    peak = preload + math.sqrt(preload**2 + stiffness * mass * speed**2)
    assert found.greatest == pytest.approx(peak, rel=1e-9)
    natural = math.sqrt(stiffness / mass)
    fall = speed * mass / preload
    contact = (math.pi + 2.0 * math.atan(preload / (mass * natural * speed))) / natural
    assert found.impacts == 1 + math.floor((TURN / w - fall) / (2.0 * fall + contact))
    assert found.least == 0.0


def test_play_between_two_still_faces_is_crossed_to_and_fro():
    mass, stiffness, play, rpm, speed = 0.2, 1e6, 2e-4, 600.0, 0.05
    train = Train(mass, 0.0, stiffness)
    w = rpm * TURN / 60.0
    found = course(train, faces(Still(), Still(play)), rpm, 1, ContactState(FREE, 0.5 * play, speed / w))
    turn = found.turns[0]
    assert turn.velocity == pytest.approx(speed, rel=1e-10)
    assert turn.greatest == pytest.approx(speed * math.sqrt(stiffness * mass), rel=1e-9)
    flight, contact = play / speed, math.pi * math.sqrt(mass / stiffness)
    assert turn.impacts == 1 + math.floor((TURN / w - 0.5 * flight) / (flight + contact))
    first = 0.5 * flight + (turn.impacts - 1) * (flight + contact)  # the last meeting
    free = 0.5 * flight + (turn.impacts - 1) * flight + max(0.0, TURN / w - first - contact)
    assert turn.free == pytest.approx(w * free, rel=1e-9)


def test_damping_ends_contact_before_the_spring_is_slack():
    """From a press-in that is let go: N = -(k z + c z') reaches 0 while z is still below 0."""
    train = Train(1.0, 600.0, 1e5, 0.0)
    found = course(train, faces(Still()), 60.0, 1, ContactState(LOWER, -1e-3, 0.0))
    a, b = 300.0, math.sqrt(1e5 - 300.0**2)
    t = math.atan2(b, a) / b  # N = m z'', and from rest z'' goes as cos bt - (a/b) sin bt
    w = TURN
    assert found.turns[0].free == pytest.approx(TURN - w * t, rel=1e-9)
    assert found.turns[0].impacts == 0
    assert found.end.contact == FREE


def test_a_train_at_rest_stays_there():
    train = Train(0.4, 20.0, 2e5, 150.0)
    found = course(train, faces(Still(0.01)), 600.0, 5)
    assert found.settled
    assert len(found.turns) == 1
    assert found.turns[0].greatest == pytest.approx(150.0, rel=1e-12)
    assert found.turns[0].least == pytest.approx(150.0, rel=1e-12)


@pytest.mark.parametrize("rpm", [60.0, 400.0])
def test_where_contact_holds_the_course_settles_in_the_steady_state(rpm):
    train = Train(0.4, 40.0, 2e5, 150.0)
    lower, _ = faces(Cycloid(math.radians(120.0), 20e-3))
    found = course(train, (lower, None), rpm, 40)
    force = steady(train, lower, rpm).force
    assert found.settled
    assert found.turns[-1].greatest == pytest.approx(force.greatest, rel=1e-7)
    assert found.turns[-1].least == pytest.approx(force.least, rel=1e-7)
    assert found.turns[-1].greatest_at == pytest.approx(force.greatest_at, abs=1e-5)
    assert found.turns[0].greatest > 0.0


def test_corners_throw_the_follower_off_without_damping_at_any_preload_they_can():
    """A blow of 2 at a corner of s' gives |k z| = 2 sqrt(k m) W: float if that is above F."""
    rpm = 60.0
    w = rpm * TURN / 60.0
    lower, _ = faces(Saw())
    blow = 2.0 * w * math.sqrt(1e6)  # the corner at half a turn lets go of the follower
    for preload, floats in ((1.6 * blow, False), (0.6 * blow, True)):
        found = course(Train(1.0, 30.0, 1e6, preload), (lower, None), rpm, 1)
        assert (found.turns[0].least == 0.0) == floats


def test_no_play_is_refused_with_its_place():
    lower = Harmonic(1, 1e-3)
    upper = Shifted(Harmonic(1, 0.9e-3), 1.0, 0.05e-3)  # they meet where cos is above a half
    drives_ = faces(lower, upper)
    least, at = least_gap(drives_[0], drives_[1])
    assert least == pytest.approx(-0.05e-3, rel=1e-12)
    assert math.cos(at) == pytest.approx(1.0)
    with pytest.raises(DynamicsError, match="no backlash is left at 0 degrees: -5e-05"):
        course(Train(1.0, 1.0, 1e5), drives_, 100.0, 1)


def test_a_touch_between_two_samples_is_met():
    """A face that first falls away from the follower, then reaches for it again, within a hundredth of a radian."""

    class Wave(Still):
        def rows(self, phi):
            x = 12.0 * phi - 0.5 * math.pi - 8.0 * 0.01
            return 1e-3 * np.stack([np.cos(x), -12.0 * np.sin(x), -144.0 * np.cos(x)])

    face = Wave()
    start = face.rows(np.zeros(1))[:, 0]
    for share, meets in ((0.99, 1), (0.998, 1), (1.002, 0)):
        # z is 288 t (t - a)^2 c or so, its least close to t = a = 0.01; x keeps its speed upwards
        rate = share * 288e-3 * 0.01**2
        time = np.linspace(0.0, TURN, 1_000_001)[1:]
        z = start[0] + (start[1] + rate) * time - face.rows(time)[0]
        assert (z.min() < 0.0) == bool(meets)
        found = course(Train(0.4, 0.0, 1e13), faces(face), 300.0, 1, ContactState(FREE, 0.0, rate))
        assert found.turns[0].impacts == meets
        if meets:
            first = time[int(np.argmax(z < 0.0))]
            assert found.turns[0].velocity_at == pytest.approx(first, abs=2.0 * time[0])


@pytest.mark.slow
@pytest.mark.parametrize(
    ("play", "ratio", "zeta", "impacts", "peak"),
    few([(0.05, 123.3, 0.03, 79, 30.797), (0.02, 400.3, 0.05, 157, 41.34), (0.002, 400.3, 0.05, 57, 11.937)], 3),
)
def test_as_many_meetings_as_another_integration_of_the_same_law(play, ratio, zeta, impacts, peak):
    """Pinned figures: flight as a straight line, contact by Duhamel's integral in steps of a sixth of a swing.

    That integration shares the motion alone, and met the same faces in the same order, within 1e-5 rad.
    """
    recipe = load(ROOT / "recipes" / "w-law.yaml")
    follower = designed(recipe).exact.gauge
    assert isinstance(follower, DoubleRoller)
    both = intended_faces(follower, play / follower.transmission.arm)
    lower, upper = drives([both.lower, both.upper])
    found = course(stiff(ratio, zeta, mass=2e-3), (lower, upper), 300.0, 1).turns[0]
    assert found.impacts == impacts
    assert found.greatest == pytest.approx(peak, rel=1e-3)


# --- what it takes ----------------------------------------------------------------------------------------------------


@pytest.mark.thin(6)
@pytest.mark.parametrize("zeta", [1e-4, 0.1, 1.0])
@pytest.mark.parametrize("ratio", [1.3, 123.0, 1e3 + 0.3, 1e5 + 0.3])
def test_play_takes_no_more_places_the_stiffer_the_train(ratio, zeta):
    """Two turns of a rise and its dwells between two faces."""
    motion = Cycloid(math.radians(120.0), 20e-3)
    found = course(stiff(ratio, zeta), faces(motion, Shifted(motion, 1.0, 5e-5)), 300.0, 2)
    assert found.stopped is None
    assert found.turns[-1].impacts > 0
    assert found.turns[-1].bore == {LOWER, UPPER}
    assert found.places < 1_000_000


@pytest.mark.thin(6)
@pytest.mark.parametrize("zeta", [1e-4, 0.1, 1.0])
@pytest.mark.parametrize("ratio", [1.3, 123.3, 1e3 + 0.3, 1e5 + 0.3])
def test_a_turn_under_a_spring_is_bounded_too(ratio, zeta):
    lower, _ = faces(Cycloid(math.radians(120.0), 20e-3))
    found = course(stiff(ratio, zeta, preload=150.0), (lower, None), 300.0, 2)
    assert found.stopped is None
    assert found.places < MOST_WORK // 2  # most of it where ringing lasts for a third of the turn


def test_a_course_that_takes_too_much_says_how_far_it_came():
    motion = Cycloid(math.radians(120.0), 20e-3)
    both = faces(motion, Shifted(motion, 1.0, 5e-5))
    train = stiff(123.0, 0.1)
    whole = course(train, both, 300.0, 2)
    found = course(train, both, 300.0, 2, most=whole.places // 4)
    assert found.turns == ()
    assert not found.settled
    assert re.search(
        r"to [\d.]+ degrees of turn 1 .* \d+ changes of contact .* 123 times the shaft's .* 0\.1 ", found.stopped
    )
    assert whole.places // 4 < found.places <= whole.places
    later = course(train, both, 300.0, 2, most=whole.places - 1000)
    assert later.turns == whole.turns[:1]
    assert "of turn 2 and no further" in later.stopped


@pytest.mark.slow
def test_an_undamped_train_that_rings_for_ever_ends_within_the_budget():
    lower, _ = faces(Cycloid(math.radians(120.0), 20e-3))
    found = course(stiff(1e5 + 0.3, 0.0, preload=1500.0), (lower, None), 300.0, 20, most=500_000)
    assert "0 changes of contact" in found.stopped
    assert found.places < 520_000


# --- a second opinion -------------------------------------------------------------------------------------------------


@pytest.mark.slow
@pytest.mark.parametrize(
    ("rpm", "damping", "play"),
    few(
        [(500.0, 20.0, None), (900.0, 20.0, None), (1300.0, 200.0, None), (600.0, 200.0, 2e-5), (1000.0, 400.0, 5e-5)],
        5,
        first=3,
    ),
)
def test_an_implicit_solver_sees_the_same_turn(rpm, damping, play):
    pytest.importorskip("scipy")
    motion = Cycloid(math.radians(120.0), 20e-3)
    upper = None if play is None else Shifted(motion, 1.0, play)
    train = Train(0.4, damping, 2e5, 150.0 if play is None else 0.0)
    start = (train.at(rpm).static(0.0), 0.0) if play is None else (0.5 * play, 0.0)
    places = np.linspace(0.0, TURN, 2001)
    other = integrated(train, (motion, upper), rpm, places, start, rtol=1e-8)
    found = course(train, faces(motion, upper), rpm, 1)
    z, v = found.end.z, found.end.v
    if found.end.contact == UPPER:
        z += play
    size = np.abs(other.states).max(axis=1)
    assert abs(z - other.states[0, -1]) < 1e-6 * size[0]
    assert abs(v - other.states[1, -1]) < 1e-6 * size[1]
    greatest = np.abs(other.force).max()
    assert found.turns[0].greatest >= greatest * (1.0 - 1e-6)
    assert found.turns[0].greatest < 1.25 * greatest  # a step of force at a meeting may fall between two places
    if play is None and found.turns[0].impacts == 0:
        assert found.turns[0].least == pytest.approx(other.force.min(), rel=1e-4)


@pytest.mark.slow
def test_the_implicit_solver_sees_the_same_steady_state():
    pytest.importorskip("scipy")
    motion = Cycloid(1.0, 1e-2)
    (drive,) = drives([motion])
    train = Train(0.4, 60.0, 3e5, 100.0)
    found = steady(train, drive, 300.0)
    places = np.linspace(0.0, TURN, 400)
    other = integrated(train, (motion, None), 300.0, places, found.state, rtol=1e-8, bonded=True)
    assert other.states[:, -1] == pytest.approx(np.array(found.state), rel=1e-5)
    assert other.force.max() <= found.force.greatest * (1.0 + 1e-8)


def test_too_much_work_for_an_explicit_solver_is_told():
    pytest.importorskip("scipy")
    train = Train(0.4, 60.0, 3e12, 100.0)
    with pytest.raises(DynamicsError, match="more than 2000 evaluations"):
        integrated(
            train,
            (Harmonic(2, 1e-3), None),
            300.0,
            np.array([0.0, 1.0]),
            (0.0, 0.0),
            method="RK45",
            most=2000,
            bonded=True,
        )
