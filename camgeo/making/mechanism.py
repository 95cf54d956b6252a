"""Every body of a mechanism: built once a run, held against each other over the whole turn, written in many formats."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from camgeo.bodies.build import assembly_of
from camgeo.bodies.collide import collision_checks
from camgeo.bodies.sizes import BodyError
from camgeo.fit.pieces import ArcSpline
from camgeo.making.job import Made
from camgeo.making.parts import make_parts

if TYPE_CHECKING:
    from pathlib import Path

    from camgeo.bodies.assembly import Assembly
    from camgeo.making.job import Job
    from camgeo.recipe.model import FileRequest
    from kin.check import Check


def make_mechanism(job: Job, request: FileRequest, path: Path) -> Made:
    """Write and judge every body; the checks of the mechanism itself are told with its first file.

    Nothing is made of a mechanism that does not turn. Raises as `make` does.
    """
    driven = job.design.driven
    if driven is not None and not driven.turns:
        return Made(())
    checks: tuple[Check, ...] = ()
    if not job.assemblies:
        assembly, checks = _assembled(job, request)
        job.assemblies.append(assembly)
    made = make_parts(job, request, path, [member.body() for member in job.assemblies[0].members])
    return Made(made.files, (*checks, *made.checks))


def _assembled(job: Job, request: FileRequest) -> tuple[Assembly, tuple[Check, ...]]:
    """Build the bodies round the contour as arcs within the file's tolerance, and turn them once round."""
    with job.refusals(request), job.clock.stage("bodies"):
        contour = job.outlines.within("arcs", job.tolerance(request))
        if not isinstance(contour, ArcSpline):
            raise TypeError("bodies stand round a contour of arcs")
        at = job.contour.sample(job.contour.cells.low).point
        reach = float(np.hypot(at[:, 0], at[:, 1]).max())
        try:
            assembly = assembly_of(job.recipe, job.design, contour, reach)
        except BodyError as error:
            message, remedy = error.told(job.recipe.mm, job.recipe.units)
            raise job.recipe.error(error.field, message, None, remedy) from error
    with job.clock.stage("collision"):
        return assembly, tuple(collision_checks(assembly))
