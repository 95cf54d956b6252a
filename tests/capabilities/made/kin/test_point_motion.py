"""The motion of points without noise, of followers with two contacts: against the law that the cam was made by."""

from __future__ import annotations

import numpy as np
import pytest
from support.measured import points, surfaces

from camgeo.recipe.recipe import read
from kin.made.point_motion import SurfaceRun, measured_motion

HALF = "[{rise: 8, over: 120, law: cycloidal}, {dwell: 60}]"
FRAMES = {
    "faces": f"kind: constant-breadth, base_radius: BASE, motion: {HALF}",
    "rollers": f"kind: constant-diameter, base_radius: BASE, roller_radius: 10, motion: {HALF}",
}
STILL = "[{rise: 0.01, over: 180, law: cycloidal}]"
SWING = "[{rise: 6, over: 30, law: cycloidal}, {return: 6, over: 30, law: cycloidal}]"
ROLLERS = f"kind: double-roller, ratio: 3, arm: 60, roller_radius: 8, law: {SWING}"


def recipe(cam):
    return f"part: {{bore: 12}}\nverify: {{angles: 360}}\ncam: {{{cam}}}"


def of_points(text, still, span, deviation=lambda t: 0.0 * t, *, opposed=False):
    """Motion of a follower that is meant to hardly move, on the points of a cam."""
    ((_, part, surface),) = surfaces(text)
    ((_, _, rough),) = surfaces(still)
    run = SurfaceRun(rough.gauge, rough.side, points(part, surface, deviation, count=1440), None)
    return measured_motion([run], span, opposed=opposed)


@pytest.mark.thin(2)
@pytest.mark.parametrize("kind", FRAMES)
def test_half_a_turn_of_a_frame(kind):
    """Its contacts are as far apart as the points say: with a base circle that is 0.5 mm off, too."""
    text, still = recipe(FRAMES[kind].replace("BASE", "40")), FRAMES[kind].replace(HALF, STILL).replace("BASE", "39.5")
    motion = of_points(text, recipe(still), np.pi, opposed=True)
    law = read(text.encode(), "part.yaml").cam.exact().motion
    meant = law.rows(motion.shaft, 0)[0]
    assert motion.position - motion.position[0] == pytest.approx(meant - meant[0], abs=1e-4)
    assert 39.5 + motion.lifted_circle(float(motion.position[0])) == pytest.approx(40.0, abs=1e-4)
    assert np.abs(motion.play).max() < 2e-4
    assert motion.last == pytest.approx(motion.position[0] + 8.0, abs=1e-4)
    assert motion.alike(4) == (1, 3)


@pytest.mark.slow
def test_a_section_of_the_turn_of_two_rollers_on_an_arm():
    """All six sections tell of the first; a form of one wave a turn keeps from their symmetry, and goes out."""
    text, still = recipe(ROLLERS), recipe(ROLLERS.replace(f"law: {SWING}", "delta: {cos: {1: 0.001}}"))
    law = read(text.encode(), "part.yaml").cam.exact().motion
    offs = []
    for deviation in (lambda t: 0.0 * t, lambda t: 0.01 * np.cos(t)):
        motion = of_points(text, still, np.pi / 3.0, deviation)
        meant = law.rows(motion.shaft, 0)[0]
        offs.append(np.degrees(np.abs(motion.position - meant).max()))
    assert offs[0] < 1e-3
    assert offs[1] < 1.5e-3  # a wave of 0.01 mm alone moves a roller by 0.01 degrees
    assert motion.alike(4) == (3,)
    assert motion.zero_ends
