"""All bodies of a mechanism: built and checked for collisions once a run, written in each format."""

from __future__ import annotations

from contextlib import contextmanager
from typing import TYPE_CHECKING

from camgeo.capabilities.mechanism.build import build_assembly
from camgeo.capabilities.mechanism.checks import NAME
from camgeo.capabilities.mechanism.interference import collision_checks
from camgeo.capabilities.mechanism.keys import requested_sizes
from camgeo.capabilities.mechanism.parts import make_parts
from camgeo.capabilities.mechanism.shaft import require_drive
from camgeo.capabilities.mechanism.sizes import BodyError, require_clearance
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

    There is no file of a mechanism that does not turn. Raises as `make` does.
    """
    driven = job.design.driven
    if driven is not None and not driven.turns:
        return Made(())
    first = NAME not in job.kept
    if first:
        job.kept[NAME] = _build(job, request)
    assembly: Assembly = job.kept[NAME]
    made = make_parts(job, request, path, [member.body() for member in assembly.members])
    if not first:
        return made
    with job.clock.stage("collision"):  # last, as it takes longest
        checks = collision_checks(assembly)
    return Made(made.files, (*checks, *made.checks))


def foresee_mechanism(job: Job, request: FileRequest) -> None:
    """Raise RecipeErrors for clearances that the file's tolerance may close, and a shaft that may slip in the cam.

    Raises MissingExtraError without the package that joins bodies.
    """
    need_booleans()
    recipe, tolerance = job.recipe, job.tolerance(request)
    clearance = requested_sizes(recipe).clearance
    with _recipe_errors(recipe):
        require_clearance(clearance, job.tolerance_field(request), tolerance)
        require_drive(recipe.part, clearance, tolerance)
        first, *others = job.design.follower.contacts
        for other in others if job.body.pocket is not None else ():
            play = other.touch.radius - first.touch.radius
            require_clearance(play, job.tolerance_field(request), tolerance, "cam.track.groove.clearance")


@contextmanager
def _recipe_errors(recipe: Recipe) -> Iterator[None]:
    """Raise RecipeErrors, at the field that is the cause, in place of BodyError."""
    try:
        yield
    except BodyError as error:
        message, remedy = error.texts(recipe.mm, recipe.units)
        raise recipe.error(error.field, message, None, remedy) from error


def _build(job: Job, request: FileRequest) -> Assembly:
    """Bodies round the contours, as arcs within the file's tolerance."""
    with job.refusals(request), job.clock.stage("bodies"):
        fitted = [fit.within("arcs", job.tolerance(request)) for fit in job.fits]
        contours = [contour for contour in fitted if isinstance(contour, ArcSpline)]
        with _recipe_errors(job.recipe):
            return build_assembly(job.recipe, job.design, *contours)
