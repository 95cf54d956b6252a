"""All bodies of a mechanism: built and checked for collisions once a run, written in each format."""

from __future__ import annotations

from contextlib import contextmanager
from typing import TYPE_CHECKING

import numpy as np

from camgeo.capabilities.mechanism import arms, disc_followers, yoke
from camgeo.capabilities.mechanism.checks import NAME
from camgeo.capabilities.mechanism.interference import collision_checks
from camgeo.capabilities.mechanism.keys import requested_sizes
from camgeo.capabilities.mechanism.parts import make_parts
from camgeo.capabilities.mechanism.shaft import Drive, cam_disk, require_drive, shaft_in
from camgeo.capabilities.mechanism.sizes import BodyError, derive_sizes, require_clearance
from camgeo.files.solid import need_booleans
from camgeo.fit.pieces import ArcSpline
from camgeo.output.job import MadeFiles
from camgeo.synthesis.view import Drawer, entry, view_of
from kin.contour.contour import Contour
from kin.contour.region import farthest
from kin.law.contacts import Arrangement, Flat, KnifeEdge, Oscillating, Roller, Shoe, Translating
from kin.numeric.check import as_drawn

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from camgeo.capabilities.mechanism.assembly import Assembly
    from camgeo.output.job import Job
    from camgeo.recipe.export import FileRequest
    from camgeo.recipe.recipe import Recipe
    from camgeo.synthesis.design import Design


def make_mechanism(job: Job, request: FileRequest, path: Path) -> MadeFiles:
    """Write and judge every body in a request's format; checks of clearance and collision are made once a run.

    The result has no file for a mechanism that does not turn right round. Raises RecipeErrors for bodies that cannot be
    made, or not within the tolerance, OSError where a file cannot be written, ReadError where it cannot be read back.
    """
    driven = job.design.driven
    if driven is not None and not driven.turns:
        return MadeFiles(())
    first = NAME not in job.kept
    if first:
        job.kept[NAME] = _build(job, request)
    assembly: Assembly = job.kept[NAME]
    made = make_parts(job, request, path, [member.body() for member in assembly.members])
    if not first:
        return made
    with job.clock.stage("collision"):  # last, as it takes longest
        mirrored = job.recipe.rotation == "ccw"
        checks = [as_drawn(check, mirrored=mirrored) for check in collision_checks(assembly)]
    return MadeFiles(made.files, (*checks, *made.checks))


def foresee_mechanism(job: Job, request: FileRequest) -> None:
    """Raise RecipeErrors for clearances that the file's tolerance may close, and a shaft that may slip in the cam.

    Clearances are those of the bodies, and of a roller in its groove. Raises MissingExtraError without the package that
    joins bodies.
    """
    need_booleans()
    recipe, tolerance = job.recipe, job.tolerance(request)
    clearance = requested_sizes(recipe).clearance
    with _recipe_errors(recipe):
        require_clearance(clearance, job.tolerance_field(request), tolerance)
        require_drive(recipe.part, clearance, tolerance)
        first, *further = job.design.follower.contacts
        for contact in further if job.body.pocket is not None else ():
            play = contact.touch.radius - first.touch.radius
            require_clearance(play, job.tolerance_field(request), tolerance, "cam.track.groove.clearance")


@contextmanager
def _recipe_errors(recipe: Recipe) -> Iterator[None]:
    """Turn a BodyError into RecipeErrors at its field, with lengths in the recipe's unit."""
    try:
        yield
    except BodyError as error:
        message, remedy = error.texts(recipe.mm, recipe.units)
        raise recipe.error(error.field, message, None, remedy) from error


def _build(job: Job, request: FileRequest) -> Assembly:
    """All bodies, with the cam's contours as arcs within the file's tolerance; RecipeErrors where there are none."""
    with job.refusals(request), job.clock.stage("bodies"):
        fitted = [fit.within("arcs", job.tolerance(request)) for fit in job.fits]
        contours = [contour for contour in fitted if isinstance(contour, ArcSpline)]
        with _recipe_errors(job.recipe):
            return build_assembly(job.recipe, job.design, *contours)


# --- by the kind of follower or linkage -------------------------------------------------------------------------------


def build_assembly(recipe: Recipe, design: Design, *contours: ArcSpline) -> Assembly:
    """All bodies round a cam's contours, one contour for each surface, drawn for a shaft that turns clockwise.

    Raises BodyError for a body that cannot be made, ValueError without a part, thickness or bore.
    """
    (disc,) = design.discs
    if disc.body is None:
        raise ValueError(f"{recipe.name}: there is no part to be made")
    part = recipe.part
    reach = max(map(_greatest_radius, contours)) if part.outer is None else 0.5 * part.outer
    # sizes by the cam and its rollers, whose radius has a key of its own in each family
    arrangement, view = design.follower.arrangement, view_of(recipe, design)
    rolling = arrangement.touch is Roller
    field = "" if not rolling else "cam.follower.radius" if arrangement.contacts == 1 else "cam.roller_radius"
    radius = view.touch.radius if rolling else None
    s = derive_sizes(requested_sizes(recipe), reach, part.bore or 0.0, radius, field)
    drive = Drive(cam_disk(part, disc.body, contours), reach, shaft_in(part, s), s)
    if design.driven is not None:
        from camgeo.capabilities.mechanism.linkage_bodies import linkage_assembly

        return linkage_assembly(design.driven.mechanism, drive)
    return BODIES[arrangement](view, drive)


BODIES: dict[Arrangement, Drawer[[Drive], Assembly]] = dict(
    [
        entry(Translating, Roller, disc_followers.on_stem),
        entry(Translating, Shoe, disc_followers.on_stem),
        entry(Translating, KnifeEdge, disc_followers.on_stem),
        entry(Translating, Flat, yoke.face_on_stem),
        entry(Translating, Flat, yoke.yoke, 2),
        entry(Translating, Roller, disc_followers.roller_frame, 2),
        entry(Oscillating, Roller, disc_followers.on_arm),
        entry(Oscillating, Shoe, disc_followers.on_arm),
        entry(Oscillating, KnifeEdge, disc_followers.on_arm),
        entry(Oscillating, Flat, disc_followers.face_on_arm),
        entry(Oscillating, Roller, arms.double_roller, 2),
        entry(Oscillating, Flat, arms.flat_pair, 2),
    ]
)
"""Functions that make the bodies of each follower; those of a linkage are in `linkage_bodies`."""


def _greatest_radius(contour: ArcSpline) -> float:
    """Upper bound of a contour's distance from the shaft, mm."""
    arcs, _ = Contour.from_bulges(contour.points, contour.bulges).as_arcs()
    return float(farthest(arcs, np.zeros((len(arcs), 2))).max()) + contour.bound.worst
