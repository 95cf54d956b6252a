"""Influences of a follower at rest, where they can be said without a formula."""

from __future__ import annotations

import numpy as np
import pytest

from kin.budget.influence import bearing
from kin.law.contacts import Contact, Flat, Oscillating, Roller, Translating

SHAFT = np.array([0.0, 1.0, 4.0])
REST = np.stack([np.zeros(3), np.zeros(3)])


def test_a_roller_in_line_with_the_shaft_rises_as_metal_does() -> None:
    held = bearing(Contact(Translating(0.0), Roller(5.0), datum=30.0), 1, SHAFT, REST)
    ray = np.exp(1j * SHAFT)
    assert held.point == pytest.approx(25.0 * ray)
    assert held.metal(0.2 * ray) == pytest.approx(0.2)
    assert held.metal(0.2j * ray) == pytest.approx(0.0, abs=1e-15)
    assert held.touch(0.2 * ray) == pytest.approx(-0.2)
    assert held.grown == pytest.approx(1.0)
    assert held.metal_turned() == pytest.approx(0.0, abs=1e-14)


def test_an_offset_stem_rises_by_the_secant_of_its_pressure_angle() -> None:
    held = bearing(Contact(Translating(18.0), Roller(5.0), datum=24.0), 1, SHAFT, REST)
    assert np.abs(held.grown) == pytest.approx(30.0 / 24.0)


def test_a_face_square_to_its_stem_feels_nothing_along_itself() -> None:
    held = bearing(Contact(Translating(3.0), Flat(), datum=30.0), 1, SHAFT, REST)
    ray = np.exp(1j * SHAFT)
    assert held.metal(ray) == pytest.approx(1.0)
    assert held.metal(1j * ray) == pytest.approx(0.0, abs=1e-14)


def test_an_arm_square_to_the_ray_swings_by_the_length_over_the_arm() -> None:
    # roller at 30 mm from the shaft, pivot at 50 mm, arm of 40 mm: a right angle at the roller
    held = bearing(Contact(Oscillating(50.0, 1, 40.0), Roller(5.0), datum=np.arctan2(30.0, 40.0)), 1, SHAFT, REST)
    assert np.abs(held.grown) == pytest.approx(1.0 / 40.0)
