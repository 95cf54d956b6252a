"""Files of a request: whether its form holds the cam, and the files that are made."""

from __future__ import annotations

from typing import TYPE_CHECKING

from camgeo.output.extension import MAKING, OUTPUTS
from camgeo.output.job import MadeFiles
from camgeo.recipe.export import disc_filename
from camgeo.registry.formats import FORMATS
from kin.numeric.check import about

if TYPE_CHECKING:
    from pathlib import Path

    from camgeo.output.job import Job
    from camgeo.recipe.export import FileRequest
    from camgeo.recipe.recipe import Recipe
    from camgeo.synthesis.design import Design


def make(job: Job, request: FileRequest, path: Path) -> MadeFiles:
    """Make and judge the files of one request: one at `path`, or one beside it for each disc.

    Of an altered part whose contour fails a check no file is made, and the failed checks come back alone. Neither files
    nor checks come back where the format needs a mechanism that turns right round and this mechanism does not. Packages
    must be there: `foresee` refuses a file that needs a missing one. Raises RecipeErrors where a tolerance cannot be
    held or no such file can be made, ValueError for a format that only reports on other files, OSError where a file
    cannot be written.
    """
    job, failed = job.of_file(request)
    if failed:
        return MadeFiles((), tuple(about(check, path.name) for check in failed))
    if request.variant:
        make_variant = OUTPUTS[request.variant].make
        if make_variant is None:
            raise ValueError(f"nothing makes the files of {request.variant}")
        return make_variant(job, request, path)
    driven = job.design.driven
    if request.format.turning and driven is not None and not driven.turns:
        return MadeFiles(())
    if len(job.design.discs) == 1 or not request.format.by_disc:
        return _make_file(job, request, path)
    paths = [path.with_name(disc_filename(path.name, rank)) for rank in range(len(job.design.discs))]
    return job.combine_discs(
        request,
        [
            _make_file(single_job, request, single_path)
            for single_job, single_path in zip(job.single, paths, strict=True)
        ],
    )


def _make_file(job: Job, request: FileRequest, path: Path) -> MadeFiles:
    make_file = MAKING[request.kind].make
    if make_file is None:
        raise ValueError(f"nothing makes {request.kind} alone")
    return make_file(job, request, path)


def demand_capacity(recipe: Recipe, design: Design, request: FileRequest) -> None:
    """Raise RecipeErrors where the form of the request's file holds fewer surfaces or discs than the cam has."""
    surfaces, discs, form = len(design.exact.surfaces), len(design.discs), request.form
    if discs > form.discs:
        contents = f"{discs} discs"
    elif discs == 1 and surfaces > form.surfaces:
        contents = f"{surfaces} surfaces"
    else:
        return
    holders = [
        kind if not name else f"{kind} as {name}"
        for kind, record in FORMATS.items()
        for name, form_record in record.forms.items()
        if not record.summary and (form_record.discs >= discs if discs > 1 else form_record.surfaces >= surfaces)
    ]
    remedy = f"give {', '.join(holders)}" if holders else "leave it out"
    raise recipe.error(recipe.field_of(request), f"{request.word} does not hold a cam of {contents}", None, remedy)


def foresee(job: Job, request: FileRequest) -> None:
    """Refuse a request before anything is fitted, where `make` is certain to refuse it.

    Raises RecipeErrors where no such file can be made, MissingExtraError where a package that makes it is missing.
    """
    demand_capacity(job.recipe, job.design, request)
    if request.variant:
        OUTPUTS[request.variant].foresee(job, request)
    job, failed = job.of_file(request)
    if not failed:
        MAKING[request.kind].foresee(job, request)
