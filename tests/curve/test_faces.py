"""Flat faces by complex numbers: where their line and the cam's envelope meet, and how the contact can move."""

from __future__ import annotations

import math

import numpy as np
import pytest
from support.discs import displaced

from camgeo.curve.disc import StraightFace, SwingingFace, rest_of
from kin.law.normalised import IntentError
from kin.numeric.elementary import Jet

THETA = np.array([0.2, 0.9, 1.7, 2.4, 3.4, 4.4, 5.6])  # inside the rise, both dwells and the return
STEP = 1e-5
LIFT = displaced((12.0, 120, "cycloidal"), (60,), (-12.0, 120, "cycloidal"), (60,))
SWING = displaced((0.2, 120, "cycloidal"), (60,), (-0.2, 120, "cycloidal"), (60,))


def touched(face: StraightFace | SwingingFace) -> tuple[np.ndarray, np.ndarray]:
    """Normals (n,) and points of contact (n,) as complex numbers: where neighbouring lines p = Re(conj(E) z) meet."""
    (p, t), (before, s), (after, u) = (
        tuple(row[0] for row in face.pitch(THETA + away, 0)) for away in (0.0, -STEP, STEP)
    )
    normal = np.exp(1j * t)
    return normal, normal * (p + 1j * (after - before) / (u - s))


def jets_agree(face: StraightFace | SwingingFace) -> None:
    p, t = face.polar(Jet.variable(THETA, 3))
    rows = face.pitch(THETA, 3)
    assert p.derivatives() == pytest.approx(rows[0], abs=1e-12)
    assert t.derivatives() == pytest.approx(rows[1], abs=1e-12)


@pytest.mark.parametrize("tilt", [-0.3, 0.0, 0.25])
@pytest.mark.parametrize("offset", [-4.0, 0.0, 7.0])
def test_a_face_on_a_stem(tilt: float, offset: float) -> None:
    face = StraightFace(LIFT, 30.0, tilt, offset)
    normal, point = touched(face)
    assert np.angle(normal * np.exp(-1j * THETA)) == pytest.approx(np.full(7, tilt))
    # the stem's axis runs beside the shaft, and carries the face at `level` and as far out as the motion
    crossing = np.exp(1j * THETA) * (face.level + LIFT.derivatives(THETA, 0)[0] + 1j * offset)
    along = (point - crossing) / (1j * normal)
    assert along.imag == pytest.approx(np.zeros(7), abs=1e-6)
    assert face.place(THETA) == pytest.approx(along.real, abs=1e-6)
    assert face.pressure_angle(THETA) == pytest.approx(np.full(7, tilt))
    assert face.slope(Jet.variable(THETA, 2)).c[1:] == pytest.approx(np.zeros((2, 7)))
    jets_agree(face)


def test_a_stem_that_is_turned_carries_its_face_round() -> None:
    one, other = StraightFace(LIFT, 30.0, 0.1, 3.0), StraightFace(LIFT, 30.0, 0.1, 3.0, turned=1.1)
    (normal, point), (ahead, beyond) = touched(one), touched(other)
    assert ahead == pytest.approx(normal * np.exp(1.1j))
    assert beyond == pytest.approx(point * np.exp(1.1j), abs=1e-9)
    jets_agree(other)


@pytest.mark.parametrize("side", [1, -1])
@pytest.mark.parametrize("ahead", [-6.0, 0.0, 5.0])
def test_a_face_on_an_arm(side: int, ahead: float) -> None:
    """At S = 0 it stands 30 mm from the shaft; the contact moves about the pivot, square to the line from there."""
    face = SwingingFace.on(SWING, 30.0, 80.0, ahead, side)
    assert face.base == pytest.approx(30.0)
    normal, point = touched(face)
    pivot = 80.0 * np.exp(1j * THETA)
    out = (pivot - point) / normal
    assert out.real == pytest.approx(np.full(7, ahead), abs=1e-6)  # so much nearer the shaft than the pivot
    assert face.place(THETA) == pytest.approx(np.abs(out.imag), abs=1e-6)
    # the arm swings out by psi on the trailing side ahead of the pivot's line, on the leading side behind it
    psi = face.rest + SWING.derivatives(THETA, 0)[0]
    assert np.angle(normal * np.exp(-1j * THETA)) == pytest.approx(side * (psi - 0.5 * math.pi))
    way = 1j * (point - pivot)
    way *= np.sign((way / normal).real)
    aside = np.abs(np.angle(way / normal))
    assert face.pressure_angle(THETA) == pytest.approx(np.copysign(aside, ahead), abs=1e-7)
    jets_agree(face)


def test_from_either_side_of_a_break() -> None:
    """Parabolic halves of a rise: the slope of the swing's own slope jumps in the middle, and so does the contact's."""
    swing = displaced((0.2, 120, "parabolic"), (60,), (-0.2, 120, "parabolic"), (60,))
    face = SwingingFace.on(swing, 30.0, 80.0, 5.0, 1)
    middle = np.array([math.radians(60.0)])
    for side in (1, -1):
        beside = middle + side * 1e-7
        for figure in (face.contact, face.slope):
            at_break, near = figure(Jet.variable(middle, 2), side).c, figure(Jet.variable(beside, 2), 1).c
            assert at_break[:2] == pytest.approx(near[:2], rel=1e-5)
    before, after = (face.contact(Jet.variable(middle, 2), side).c[1] for side in (-1, 1))
    assert before[0] < 0.0 < after[0]


@pytest.mark.parametrize("tilt", [0.5 * math.pi, -0.5 * math.pi, 2.0, math.nan])
def test_a_face_that_is_not_driven(tilt: float) -> None:
    StraightFace(LIFT, 30.0, math.nextafter(0.5 * math.pi, 0.0))
    with pytest.raises(IntentError, match="below 90 it is"):
        StraightFace(LIFT, 30.0, tilt)


def test_an_arm_that_cannot_be_driven() -> None:
    assert rest_of(30.0, 70.0, 5.0) == pytest.approx(math.radians(30.0))
    for base, face in ((30.0, -30.0), (30.0, 40.0), (75.0, -5.0)):
        with pytest.raises(IntentError, match="must lie between 0 and the pivot's distance, 70 mm"):
            rest_of(base, 70.0, face)
    for stroke, side, refused in (
        (1.0, -1, ""),
        (1.1, 1, ""),
        (1.1, -1, "swings back 1.05042 times"),
        (1.4, 1, "at 90"),
    ):
        motion = displaced((stroke, 120, "cycloidal"), (60,), (-stroke, 150, "cycloidal"), (30,))
        if refused:
            with pytest.raises(IntentError, match=refused):
                SwingingFace(motion, 80.0, 0.0, 0.2, side)
        else:
            assert SwingingFace(motion, 80.0, 0.0, 0.2, side).rest == 0.2
    with pytest.raises(IntentError, match=r"swings from -0\.572958 to"):
        SwingingFace(SWING, 80.0, 0.0, -0.01, 1)
