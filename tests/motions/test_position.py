"""Positions of a follower over a turn, in mm and as tables have them."""

import math
from pathlib import Path

import numpy as np
import pytest

from camgeo.motions.position import ArmPosition, LiftPosition, SwingPosition
from camgeo.recipe.loading import load_text
from camgeo.synthesis.design import designed

TURN = 2.0 * math.pi


class Sawtooth:
    """3 + 2 theta up to a turn, with a break there, from where it falls with slope -5."""

    def derivatives(self, theta, order, side=1):
        falls = theta > TURN if side < 0 else theta >= TURN
        slope = np.where(falls, -5.0, 2.0)
        return np.stack([3.0 + slope * (theta - np.where(falls, TURN, 0.0)), slope])[: order + 1]


def test_a_turn_ends_with_the_derivatives_before_its_end():
    lift = LiftPosition(Sawtooth(), 3.0)
    rows = lift.turn(np.linspace(0.0, TURN, 5), 1)
    assert rows[0] == pytest.approx(np.linspace(0.0, 2.0 * TURN, 5))
    assert rows[1].tolist() == [2.0] * 5
    assert lift.rows(np.array([TURN]), 1)[1, 0] == -5.0
    assert lift.travel(np.array([0.0]), 0)[0, 0] == 3.0  # not from the datum
    assert lift.by_parameter(np.array([1.0]), 1)[:, 0].tolist() == [5.0, 2.0]


def test_lifts_are_in_the_recipes_unit_and_swings_in_degrees():
    lift, arm = LiftPosition(Sawtooth()), ArmPosition(Sawtooth(), arm=40.0)
    assert (lift.column("mm"), lift.column("inch"), arm.column("inch")) == ("lift_mm", "lift_in", "follower_deg")
    assert lift.convert(np.array([50.8]), 25.4).tolist() == [2.0]
    assert lift.factor(25.4) == pytest.approx(1.0 / 25.4)
    assert arm.convert(np.array([math.pi]), 25.4).tolist() == [180.0]
    assert arm.factor(25.4) == pytest.approx(180.0 / math.pi)
    theta = np.linspace(0.0, 1.0, 3)
    assert lift.stroke(theta) == (2.0, 1.0)
    assert arm.stroke(theta) == (2.0, 40.0)


def test_a_swing_by_its_parameter_is_that_over_the_shaft():
    cam = "{kind: double-roller, ratio: 2, arm: 60, roller_radius: 8, delta: {cos: {1: 4}}}"
    text = f"cam: {cam}\nexport: {{tolerance: 0.01, files: [dxf]}}\n"
    motion = designed(load_text(text, Path("case.yaml"))).motion
    assert isinstance(motion, SwingPosition)
    parameter = np.linspace(0.1, 5.0, 7)
    shaft = np.radians([motion.shaft_deg(t) for t in parameter.tolist()])
    rows = motion.by_parameter(parameter, 2)
    assert rows == pytest.approx(motion.rows(shaft, 2), abs=1e-9)
    assert motion.parameters(shaft, shaft)["a_"] == pytest.approx(parameter, abs=1e-9)
