"""Motions told from points: dwells, strokes by law, turning points, base circles; by formulas."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
from support.measured import disc, points, surfaces

from camgeo.recipe.recipe import read
from camgeo.synthesis.design import designed
from kin.follower.follower import still_follower
from kin.follower.recognised import Stroke, _fitted, recognised
from kin.law.sources.laws import NAMES
from kin.made.point_motion import SurfaceRun, measured_motion

ROLLER = "kind: roller, radius: 10, offset: 6"
READING = 0.01


def motion_of(text, noise=0.0005, deviation=lambda t: 0.0 * t):
    ((_, part, surface),) = surfaces(text)
    contact = designed(read(text.encode(), "part.yaml")).exact.follower.contacts[0]
    still = still_follower([contact], surface.side)
    return measured_motion([SurfaceRun(still, surface.side, points(part, surface, deviation, noise), None)])


def told(text, noise=0.0005):
    """Strokes in the order of the turn: law, height in mm, begin and end in degrees."""
    motion = motion_of(text, noise)
    programme = recognised(motion, READING, "mm")
    rows = []
    for stroke in programme.strokes:
        begin, end = (np.degrees(programme.boundaries[k]) for k in (stroke.first, stroke.last))
        rows.append(
            (stroke.law, programme.levels[stroke.high] - programme.levels[stroke.low], begin % 360.0, end % 360.0)
        )
    return rows


JUMPING = {"constant-velocity", "cubic", "parabolic", "polynomial-23"}
BELOW = {"cycloidal", "harmonic", "modified-sine", "modified-trapezoid", "polynomial-345", "polynomial-4567"}


@pytest.mark.slow  # six laws are told by the tests behind it
@pytest.mark.parametrize("law", [name for name in NAMES if name not in JUMPING | BELOW])
def test_each_law_is_told_by_what_it_leaves(law):
    text = disc(
        ROLLER,
        f"[{{rise: 8, over: 110, law: {law}}}, {{dwell: 60}}, {{return: 8, over: 120, law: {law}}}, {{dwell: 70}}]",
    )
    rows = sorted(told(text), key=lambda row: -row[1])
    for (name, height, begin, end), (meant, low, high) in zip(
        rows, ((8.0, 0.0, 110.0), (-8.0, 170.0, 290.0)), strict=True
    ):
        assert name == law
        assert height == pytest.approx(meant, abs=5e-4)
        assert (begin + 5.0) % 360.0 == pytest.approx(low + 5.0, abs=0.1)
        assert end == pytest.approx(high, abs=0.1)


@pytest.mark.slow
def test_strokes_without_a_dwell_between_meet_at_turning_points():
    text = disc(
        ROLLER, "[{rise: 8, over: 100, law: modified-sine}, {return: 8, over: 120, law: polynomial-345}, {dwell: 140}]"
    )
    (down, up) = sorted(told(text), key=lambda row: row[1])
    assert (down[0], up[0]) == ("polynomial-345", "modified-sine")
    assert down[2] == pytest.approx(100.0, abs=0.05)
    assert up[3] == pytest.approx(100.0, abs=0.05)


def test_a_motion_without_any_dwell():
    text = disc(
        "kind: roller, radius: 10", "[{rise: 8, over: 200, law: cycloidal}, {return: 8, over: 160, law: harmonic}]"
    )
    (down, up) = sorted(told(text), key=lambda row: row[1])
    assert (down[0], up[0]) == ("harmonic", "cycloidal")
    assert up[3] == pytest.approx(200.0, abs=0.1)


@pytest.mark.slow
def test_steps_of_several_heights():
    text = disc(
        ROLLER,
        "[{rise: 8, over: 100, law: modified-sine}, {dwell: 40}, {rise: 4, over: 60, law: modified-trapezoid}, "
        "{return: 12, over: 120, law: polynomial-4567}, {dwell: 40}]",
    )
    rows = sorted(told(text), key=lambda row: row[1])
    assert [row[0] for row in rows] == ["polynomial-4567", "modified-trapezoid", "modified-sine"]
    assert [row[1] for row in rows] == pytest.approx([-12.0, 4.0, 8.0], abs=1e-3)


def test_a_circle_has_no_strokes():
    motion = motion_of(
        disc(
            "kind: roller, radius: 10",
            "[{rise: 0.001, over: 180, law: cycloidal}, {return: 0.001, over: 180, law: cycloidal}]",
        )
    )
    assert recognised(motion, READING, "mm") is None


def test_the_circle_of_a_level_is_that_on_which_the_follower_stands():
    """Of a roller with an offset: from a radius R the centre stands at sqrt(R^2 - e^2)."""
    motion = motion_of(disc(ROLLER))
    for larger in (-0.5, 0.0, 0.7):
        level = np.sqrt((50.0 + larger) ** 2 - 36.0) - np.sqrt(50.0**2 - 36.0)
        assert motion.lifted_circle(level) == pytest.approx(larger, abs=1e-9)


@pytest.mark.slow
def test_what_a_long_wave_hides_is_what_it_moves():
    """Refitted with a wave of height 0.01 mm at three phases, levels move by what is told at most, and come near it."""
    text = disc(ROLLER)
    clean = recognised(motion_of(text, 0.0), READING, "mm")
    hidden = clean.hidden
    moved = []
    for phase in np.radians(np.arange(0.0, 180.0, 60.0)):
        wavy = motion_of(text, 0.0, lambda t, phase=phase: 0.01 * np.cos(hidden.waves * t - phase))
        other = recognised(wavy, READING, "mm")
        moved.append(np.abs(other.levels - clean.levels) / 0.01)
        left = np.sqrt(np.mean(other.residual**2)) / (0.01 / np.sqrt(2.0))
        assert left >= np.sqrt(1.0 - hidden.share**2) - 0.05
    assert 0.9 < hidden.share <= 1.0
    assert (np.max(moved, axis=0) < 1.05 * hidden.levels).all()
    assert (np.max(moved, axis=0) > 0.8 * hidden.levels).all()


@pytest.mark.parametrize("height", [1.0, 2.0])  # 1 is also the scale of a boundary
def test_ends_of_a_part_of_a_turn_that_rest_at_zero_stay_there(height):
    boundaries = np.radians([0.0, 60.0, 120.0])
    strokes = (
        Stroke(0, 1, 0, 1, "cycloidal", (), 0.0),
        Stroke(1, 2, 1, 2, "cycloidal", (), 0.0),
    )
    shaft = np.linspace(0.0, boundaries[-1], 400)
    position = height * np.sin(0.5 * np.pi * (1.0 - np.abs(shaft / boundaries[1] - 1.0))) ** 2
    motion = SimpleNamespace(
        closed=False,
        span=boundaries[-1],
        zero_ends=True,
        shaft=shaft,
        position=position,
        spans=40,
        alike=lambda _: (1,),
    )
    programme = _fitted(motion, boundaries, np.array([0.02, height + 0.02, 0.02]), strokes)
    assert programme.levels[[0, -1]].tolist() == [0.0, 0.0]
