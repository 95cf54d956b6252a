"""Speeds from which the preloaded faces of a square frame are lost, against forces round the turn a little aside."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, cast

import numpy as np
import pytest

from camgeo.capabilities.dynamics.running_forces import running_of
from camgeo.recipe.loading import read
from camgeo.synthesis.design import designed

if TYPE_CHECKING:
    from camgeo.capabilities.dynamics.frame_forces import FrameRunning

FRAME = """\
cam: {kind: support, p: 25 + sin(3*t), shaft: [18, 8.5], preload: {interference: 0.02, stiffness: [2e7, 6e7]}}
linkage: {kind: four-bar, ground: 80, coupler: 70, rocker: 105}
dynamics: {mass: 0.02, rpm: 120, load: 12, coupler: {mass: 0.8, inertia: 6e-4}}
"""


def test_faces_are_lost_from_their_speeds_on() -> None:
    """A hundredth below it the face bears all round, a hundredth above it does not, at the place that is told."""
    recipe = read(FRAME.encode(), Path("c.yaml"))
    run = cast("FrameRunning", running_of(recipe, designed(recipe)))
    losses = run.lost_rpm()
    assert [loss.contact for loss in losses] == ["face 1", "face 2", "face 3", "face 4"]
    round_it = np.linspace(0.0, 2.0 * np.pi, 361)
    for face, (_, rpm, at_deg) in enumerate(losses):
        assert rpm is not None
        assert at_deg is not None
        there = run.turn.parameter(np.radians([at_deg]))
        slower, faster = (replace(run, train=replace(run.train, rpm=share * rpm)) for share in (0.99, 1.01))
        assert slower.at(np.append(round_it, there)).normal[face].min() > 0.0
        assert faster.at(there).normal[face, 0] == 0.0
        nearly = replace(run, train=replace(run.train, rpm=rpm)).at(there).normal[face, 0]
        assert nearly == pytest.approx(0.0, abs=1e-6)
