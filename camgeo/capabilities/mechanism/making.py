"""Every body of a mechanism: built once a run, held against each other over the whole turn, written in many formats."""

from __future__ import annotations

from contextlib import contextmanager
from typing import TYPE_CHECKING

from camgeo.capabilities.mechanism.build import assembly_of
from camgeo.capabilities.mechanism.checks import NAME
from camgeo.capabilities.mechanism.interference import collision_checks
from camgeo.capabilities.mechanism.keys import sizes_given
from camgeo.capabilities.mechanism.parts import make_parts
from camgeo.capabilities.mechanism.shaft import drives
from camgeo.capabilities.mechanism.sizes import BodyError, runs
from camgeo.files.solid import need_booleans
from camgeo.fit.pieces import ArcSpline
from camgeo.output.job import Made

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from camgeo.capabilities.mechanism.assembly import Assembly
    from camgeo.output.job import Job
    from camgeo.recipe.export import FileRequest
    from camgeo.recipe.recipe import Recipe


def make_mechanism(job: Job, request: FileRequest, path: Path) -> Made:
    """Write and judge every body; the checks of the mechanism itself are reported with its first file.

    Nothing is made of a mechanism that does not turn. Raises as `make` does.
    """
    driven = job.design.driven
    if driven is not None and not driven.turns:
        return Made(())
    first = NAME not in job.kept
    if first:
        job.kept[NAME] = _assembled(job, request)
    assembly: Assembly = job.kept[NAME]
    made = make_parts(job, request, path, [member.body() for member in assembly.members])
    if not first:
        return made
    with job.clock.stage("collision"):  # last, as it is dear: a body that cannot be written is told at once
        checks = collision_checks(assembly)
    return Made(made.files, (*checks, *made.checks))


def foresee_mechanism(job: Job, request: FileRequest) -> None:
    """Refuse clearances that the file's tolerance takes away, and a shaft that does not turn the cam.

    Raises RecipeErrors; MissingExtraError without the package that joins bodies.
    """
    need_booleans()
    recipe, off = job.recipe, job.tolerance(request)
    clearance = sizes_given(recipe).clearance
    with _told(recipe):
        runs(clearance, job.tolerance_field(request), off)
        drives(recipe.part, clearance, off)
        first, *others = job.design.follower.contacts
        for other in others if job.body.pocket is not None else ():
            play = other.touch.radius - first.touch.radius
            runs(play, job.tolerance_field(request), off, "cam.track.groove.clearance")


@contextmanager
def _told(recipe: Recipe) -> Iterator[None]:
    """Turn a body that cannot be made into RecipeErrors at the field to blame."""
    try:
        yield
    except BodyError as error:
        message, remedy = error.told(recipe.mm, recipe.units)
        raise recipe.error(error.field, message, None, remedy) from error


def _assembled(job: Job, request: FileRequest) -> Assembly:
    """Build the bodies round the contours as arcs within the file's tolerance."""
    with job.refusals(request), job.clock.stage("bodies"):
        fitted = [fit.within("arcs", job.tolerance(request)) for fit in job.fits]
        contours = [contour for contour in fitted if isinstance(contour, ArcSpline)]
        with _told(job.recipe):
            return assembly_of(job.recipe, job.design, *contours)
