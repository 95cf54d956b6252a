"""Tables: the intended motion, its contacts on the exact cam, or the contour over its polar angle; CSV."""

from __future__ import annotations

from typing import TYPE_CHECKING

from camgeo.formats.csv import write_table
from camgeo.measures.file_result import FileResult
from camgeo.output.job import Made

if TYPE_CHECKING:
    from pathlib import Path
    from typing import TypeAlias

    from camgeo.output.job import Job
    from camgeo.recipe.export import FileRequest
    from kin.numeric.arrays import Array

    Columns: TypeAlias = tuple[tuple[str, ...], Array]


def make_table(job: Job, request: FileRequest, path: Path) -> Made:
    """Write one table; that of a mechanism that does not turn is left out, as the report says."""
    driven = job.design.driven
    if driven is not None and not driven.turns:
        return Made(())
    if request.ground:
        return _ground(job, request, path)
    name = request.as_ or "motion"
    with job.clock.stage(_STAGES[name]):
        columns, rows = _TABLES[name](job, request)
        write_table(path, columns, rows, gaps=name in _GAPS)
    units = job.recipe.told_for(request).mm
    return Made((FileResult(path, request, units=units),))


def _ground(job: Job, request: FileRequest, path: Path) -> Made:
    """A table by which a lobe is ground: written, read back, and the metal judged that its wheel leaves."""
    from camgeo.fit.bound import Bound
    from camgeo.machining.grinding import ground_table

    recipe = job.recipe.told_for(request)
    with job.clock.stage("grinding"), job.refusals(request):
        made = ground_table(recipe, job.design, request, job.tolerance(request), job.field(request))
        write_table(path, made.columns, made.rows, head=made.head)
    return job.judged(request, path, Bound(made.error, made.error), len(made.rows) - 1)


def _motion(job: Job, request: FileRequest) -> Columns:
    told = job.recipe.told_for(request)
    if job.design.driven is not None:
        from camgeo.synthesis import linkage

        return linkage.motion_table(told, job.design.driven.mechanism)
    from camgeo.synthesis.motion_table import motion_table

    return motion_table(told, job.design.motion)


def _contacts(job: Job, request: FileRequest) -> Columns:
    from camgeo.synthesis.contact_table import contact_table

    return contact_table(job.recipe.told_for(request), job.design, _motion(job, request))


def _polar(job: Job, request: FileRequest) -> Columns:
    from camgeo.curve.measures import StarError
    from camgeo.synthesis.contact_table import polar_table

    try:
        (fit,) = job.fits
        return polar_table(job.recipe.told_for(request), fit.contour)
    except StarError as error:
        where, remedy = f"{job.field(request)}.csv.as", "give `as: inspection`, whose rows are places of contact"
        raise job.recipe.error(where, str(error), "'polar'", remedy) from error


def _inspection(job: Job, request: FileRequest) -> Columns:
    from camgeo.machining.inspection import inspection_table

    return inspection_table(job.recipe.told_for(request), job.design)


def _forces(job: Job, request: FileRequest) -> Columns:
    from camgeo.measures.force_figures import forces_table
    from camgeo.measures.running_forces import running_of

    running = running_of(job.recipe, job.design)
    if running is None:
        raise ValueError(f"{job.recipe.name}: there are no forces")
    return forces_table(running, job.recipe.verify.angles, job.recipe.told_for(request).units)


def _trace(job: Job, request: FileRequest) -> Columns:
    from camgeo.synthesis.traces import trace_table

    return trace_table(job.recipe.told_for(request), job.design)


_TABLES = {
    "motion": _motion,
    "contacts": _contacts,
    "polar": _polar,
    "inspection": _inspection,
    "trace": _trace,
    "forces": _forces,
}
_STAGES = {
    "motion": "table",
    "contacts": "contacts",
    "polar": "polar",
    "inspection": "inspection",
    "trace": "trace",
    "forces": "forces",
}
# nothing is touched there, nothing is to be reported, nothing moves, and a stem that jams has no force
_GAPS = frozenset({"contacts", "inspection", "trace", "forces"})
