"""Motion errors under a flat face, which are the deviations themselves, and of two opposite contacts, by hand."""

from __future__ import annotations

import numpy as np
import pytest
from support.disc_followers import FOLLOWERS

from kin.made.motion import Errors, Felt, OutputErrors, between, contact_errors
from kin.made.smooth import fit

T = np.arange(3600) * np.pi / 1800.0
SHAFT = np.radians([3.0, 20.0, 77.0, 141.0, 200.0, 263.0, 322.0])


@pytest.mark.parametrize("turned", [0.0, 0.01])
def test_under_a_flat_face_error_velocity_and_acceleration_are_those_of_the_metal(turned: float) -> None:
    """0.003 cos 5t, at the shaft angle less the metal's turn; a turn of the metal changes the motion besides."""
    follower, curve = FOLLOWERS["flat"], fit(T, 0.003 * np.cos(5.0 * T), 360).curve
    (errors,) = contact_errors(follower, 1, curve, SHAFT, turned)
    angle = SHAFT - turned
    expected = 0.003 * np.stack([np.cos(5.0 * angle), -5.0 * np.sin(5.0 * angle), -25.0 * np.cos(5.0 * angle)])
    intended = follower.motion.derivatives(SHAFT, 2)[:3]
    expected += follower.motion.derivatives(angle, 2)[:3] - intended
    for found, row, off in zip(
        errors.rows, expected, (4e-6, 5e-5, 4e-4), strict=True
    ):  # the place of contact moves a little
        assert found == pytest.approx(row, abs=off)
    assert errors.intended == pytest.approx(intended)
    assert errors.gain == pytest.approx(np.ones(7), abs=1e-6)
    (felt,) = errors.felt
    assert np.cos(felt.places) == pytest.approx(np.cos(angle), abs=5e-4)
    outward = felt.places + turned
    assert felt.normals == pytest.approx(np.column_stack([np.cos(outward), np.sin(outward)]))
    for order in range(3):
        assert errors.sds[order] == pytest.approx(curve.standard_deviations(felt.places, order), rel=2e-2)


def test_about_breaks_there_is_no_acceleration() -> None:
    """Breaks at 0, 100, 140 and 240 degrees; 360 spans: three steps of a twentieth of one are 0.15 degrees."""
    follower, curve = FOLLOWERS["flat"], fit(T, 0.003 * np.cos(5.0 * T), 360).curve
    shaft = np.radians([0.1, 0.2, 99.8, 99.9, 100.1, 100.2, 139.9, 240.1, 359.8, 359.9])
    (errors,) = contact_errors(follower, 1, curve, shaft)
    assert np.isnan(errors.rows[2]).tolist() == [True, False, False, True, True, False, True, True, False, True]
    assert np.isfinite(errors.rows[:2]).all()


def errors_of(position: float, sd: float, gain: float, normal: tuple[float, float], sound: list[bool]) -> Errors:
    row, one = np.full((3, 2), position), np.ones(2)
    felt = Felt(None, np.zeros(2), gain * one, np.tile(normal, (2, 1)))
    return Errors(
        np.arange(2.0), row * [[1.0], [2.0], [3.0]], np.full((3, 2), sd), gain * one, row, (felt,), np.array(sound)
    )


def test_between_two_contacts_the_follower_is_midway_and_what_is_left_is_play() -> None:
    """Pushed out by 0.02 mm, stopped at 0.05 mm: 0.035 mm, and 0.03 mm of play; deviations add as squares."""
    first = errors_of(0.02, 0.003, 1.2, (1.0, 0.0), [True, False])
    second = errors_of(0.05, 0.004, -1.5, (0.6, 0.8), [True, True])
    middle, play = between(first, second)
    assert middle.rows[:, 0] == pytest.approx([0.035, 0.07, 0.105])
    assert middle.sds == pytest.approx(np.full((3, 2), 0.0025))
    assert middle.gain == pytest.approx([1.5, 1.5])
    assert [felt.gain[0] for felt in middle.felt] == [0.6, -0.75]
    assert middle.intended[0, 0] == 0.02
    assert middle.sound.tolist() == [True, False]
    assert play.gap == pytest.approx([0.03, 0.03])
    assert play.sds == pytest.approx([0.005, 0.005])
    # 0.001 mm of the probe on both, 0.002 mm of a shift along the normals' difference, twice the deviation
    expected = np.sqrt(0.01**2 + (2.7 * 0.001) ** 2 + (np.hypot(1.2 + 0.9, 1.2) * 0.002) ** 2)
    assert play.uncertainty(0.001, 0.002) == pytest.approx(np.full(2, expected))


def test_an_output_s_uncertainty_is_the_root_of_squares() -> None:
    row = np.ones(1)
    errors = OutputErrors(row, row, row, 0.002 * row, 3.0 * row, 12.0 * row)
    assert errors.uncertainty() == pytest.approx([0.004])
    assert errors.uncertainty(0.001) == pytest.approx([0.005])
    assert errors.uncertainty(0.001, 0.001) == pytest.approx([0.013])
