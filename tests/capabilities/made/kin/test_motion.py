"""Errors of the motion with their derivatives and uncertainty; pairs of contacts, frames and linkages."""

from __future__ import annotations

import numpy as np
import pytest
from support.disc_followers import FOLLOWERS
from support.measured import shipped, surfaces

from kin.follower.frame import implied_limit
from kin.made.motion import contact_errors, least_fault, output_errors, paired
from kin.made.smooth import fit

TURN = 2.0 * np.pi
T = np.arange(3600) * TURN / 3600
SHAFT = np.radians(np.arange(360) + 0.25)


def smoothed(e, spans=720):
    return fit(T, e, spans).curve


@pytest.mark.slow
def test_derivatives_of_the_error_are_its_own():
    """Of a wave they are those of e/cos(pressure angle) to first order, and of the error over the angle as it is."""
    follower, curve = FOLLOWERS["roller, offset"], smoothed(0.003 * np.cos(5 * T))
    (errors,) = contact_errors(follower, 1, curve, SHAFT)
    h = 1e-3
    (low,), (high,) = (contact_errors(follower, 1, curve, SHAFT + d) for d in (-h, h))
    assert (high.rows[0] - low.rows[0]) / (2 * h) == pytest.approx(errors.rows[1], abs=2e-6)
    there = np.isfinite(errors.rows[2]) & np.isfinite(low.rows[2]) & np.isfinite(high.rows[2])
    assert ((high.rows[1] - low.rows[1]) / (2 * h))[there] == pytest.approx(errors.rows[2][there], abs=1e-3)
    assert errors.rows[0] == pytest.approx(errors.gain * curve.rows(SHAFT)[0], abs=2e-4)


@pytest.mark.slow
def test_scatter_of_many_noises_is_the_uncertainty():
    follower, draw = FOLLOWERS["roller, offset"], np.random.default_rng(2)
    t = np.arange(720) * TURN / 720
    shaft = np.radians([20.1, 70.3, 130.7, 200.2, 300.9])
    found = [contact_errors(follower, 1, fit(t, 0.002 * draw.normal(size=720), 36).curve, shaft)[0] for _ in range(80)]
    scatter = np.std([each.rows for each in found], axis=0)
    told = np.mean([each.sds for each in found], axis=0)
    assert scatter == pytest.approx(told, rel=0.3)
    assert np.abs(np.mean([each.rows[0] for each in found], axis=0)).max() < 4.0 * told[0].max() / np.sqrt(80)


def test_a_phase_error_is_told_from_what_remains():
    follower = FOLLOWERS["roller, offset"]
    frame = follower.envelope.frames(T)
    moment = frame.points[:, 0] * frame.normals[:, 1] - frame.points[:, 1] * frame.normals[:, 0]
    turn = np.radians(0.02)
    (errors,) = contact_errors(follower, 1, smoothed(turn * moment), SHAFT)
    found, remaining = errors.phase
    assert found == pytest.approx(turn, rel=0.01)
    assert np.abs(remaining).max() < np.abs(errors.remaining).max()


def test_least_fault():
    """Sums of squares and quantiles of the worked cases."""
    assert least_fault(1.0, 14.814814815, 36) == pytest.approx(1.257937542)
    assert least_fault(1.0, 10.634723105, 72) == pytest.approx(1.544456972)
    assert least_fault(1.0, 1.0, 720) == pytest.approx(5.623034819)


def test_a_frame_between_faces_that_meet_different_metal():
    """Worked case of a yoke: error by either face and what is left between them, the frame's breadth as meant."""
    motion = "[{rise: 20, over: 120, law: modified-sine}, {dwell: 60}]"
    text = f"cam: {{kind: constant-breadth, base_radius: 40, motion: {motion}}}"
    ((_, _, surface),) = surfaces(text)
    follower = surface.gauge
    away = np.mod(T - np.radians(60.0) + np.pi, TURN) - np.pi
    curve = smoothed(0.01 * np.exp(-0.5 * (away / np.radians(3.0)) ** 2) + 0.004 * np.cos(2 * T))
    shaft = np.radians([40.0, 100.0, 220.0, 285.0])
    first, second = contact_errors(follower, 1, curve, shaft)
    told = [0.0006951041, -0.0037586613, 0.0006953821, -0.0034639796]
    opposite = [0.0293046179, 0.0337587135, 0.0293048959, 0.0334638689]
    assert first.rows[0] == pytest.approx(told, abs=2e-9)
    assert second.rows[0] + 0.030 == pytest.approx(opposite, abs=2e-9)
    middle, play = paired(follower, [first, second])
    assert play is not None
    assert middle.rows[0] == pytest.approx(0.5 * (first.rows[0] + second.rows[0]))
    assert play.gap + 0.030 == pytest.approx([0.0286095138, 0.0375173748, 0.0286095138, 0.0369278486], abs=3e-9)


@pytest.mark.slow
def test_a_linkage_moves_as_first_order_has_it_for_a_cam_too_large():
    """Metal grown by e all round is a frame too narrow: the worst way of resting is e off at each face."""
    ((_, part, surface),) = surfaces(shipped("as-figure-9-1"))
    linkage = part.linkage
    relative = np.radians(np.arange(0.0, 360.0, 5.0))
    e = 1e-3
    grown = output_errors(linkage.mechanism, surface.gauge, smoothed(np.full_like(T, e)), relative, linkage.overlap)
    exact = output_errors(linkage.mechanism, surface.gauge, smoothed(np.zeros_like(T)), relative, linkage.overlap)
    assert exact.worst == pytest.approx(0.0, abs=1e-10)
    assert np.abs(grown.centred).max() < 1e-9
    limit = implied_limit(linkage.mechanism, e)
    assert limit is not None
    assert np.degrees(np.abs(grown.worst).max()) <= limit
    assert np.degrees(np.abs(grown.worst).max()) > 0.8 * limit


def test_an_output_is_as_uncertain_as_metal_and_turn_make_it():
    """Four-bar of Figure 2a at fixed shaft angles, by worked cases: offset and arm for the faces, the turned cam."""
    ((_, part, surface),) = surfaces(shipped("as-figure-9-2a"))
    linkage, relative = part.linkage, np.radians([30.0, 150.0, 250.0, 300.0])
    errors = output_errors(linkage.mechanism, surface.gauge, smoothed(np.zeros_like(T)), relative, linkage.overlap)
    across = np.array([0.0171435545, 0.0114303890, 0.0124947103, 0.0139986174])
    along = np.array([0.0005745145, 0.0003711379, 0.0002194013, 0.0002287388])
    turn = np.array([0.3691666202, 0.1168007020, 0.1545892624, 0.0029994448])
    assert errors.gain == pytest.approx(across + along, rel=1e-5)
    assert np.abs(errors.rate) == pytest.approx(turn, abs=1e-9)
    assert errors.uncertainty(0.01, 0.002) == pytest.approx(np.hypot(0.01 * (across + along), 0.002 * turn), rel=1e-5)


def test_a_play_is_as_uncertain_as_both_faces_together():
    """A yoke has twice the error of the metal, and none by a shift of the cam between its faces."""
    ((_, _, surface),) = surfaces(shipped("reuleaux"))
    shaft = np.radians([40.0, 100.0, 220.0, 285.0])
    _, play = paired(surface.gauge, contact_errors(surface.gauge, 1, smoothed(np.zeros_like(T)), shaft))
    assert play is not None
    assert play.uncertainty(0.003, 0.1) == pytest.approx(0.006, rel=1e-6)
