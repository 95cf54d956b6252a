"""The cam to look at, turning once: GLB."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from camgeo.common.units import UNIT_MM
from camgeo.formats.glb import Actor, write_glb
from camgeo.measures.file_result import FileResult
from camgeo.output.job import Made
from camgeo.output.solid import cam_meshes

if TYPE_CHECKING:
    from pathlib import Path

    from camgeo.output.job import Job
    from camgeo.recipe.export import FileRequest

COLOURS = "#d08a3c", "#5b8aa6"  # of the first disc, and of one above it
STEPS = 8  # of a turn: between two a viewer turns steadily, as the shaft does


def make_view(job: Job, request: FileRequest, path: Path) -> Made:
    """Fit and write the cam; raises as `make` does."""
    discs = cam_meshes(job, request)
    sense = 1.0 if job.recipe.rotation == "ccw" else -1.0
    pose = np.zeros((STEPS + 1, 3))
    pose[:, 2] = sense * 2.0 * math.pi * np.arange(STEPS + 1) / STEPS
    with job.clock.stage("write glb"):
        actors = [Actor(one.name, one.standing, pose, COLOURS[k % 2]) for k, one in enumerate(discs)]
        write_glb(path, actors, title=job.recipe.name)
    return Made((FileResult(path, request, units=UNIT_MM["m"]),))
