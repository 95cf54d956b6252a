"""Which maker a request goes to; each is imported when a recipe asks for it."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from camgeo.output.job import Made
from camgeo.recipe.export import BY_DISC, SOLIDS, name_of_disc
from kin.judge.check import about

if TYPE_CHECKING:
    from pathlib import Path

    from camgeo.output.job import Job
    from camgeo.recipe.export import FileRequest
    from camgeo.recipe.recipe import Recipe
    from camgeo.synthesis.design import Design


def make(job: Job, request: FileRequest, path: Path) -> Made:
    """Make the files of one request, the first at `path` or of several discs each beside it, any others there too.

    Raises RecipeErrors where a tolerance cannot be held or no such file can be made, SurroundingsError where the disk
    or a missing extra stands in the way. A page is no such request: it reports on all other files.
    """
    job, failed = job.of_file(request)
    if failed:
        return Made((), tuple(about(check, path.name) for check in failed))
    if request.parts == "all":
        from camgeo.output.mechanism import make_mechanism

        return make_mechanism(job, request, path)
    if len(job.design.discs) == 1 or request.kind not in BY_DISC:
        return _make(job, request, path)
    paths = [path.with_name(name_of_disc(path.name, rank)) for rank in range(len(job.design.discs))]
    return job.closed(request, [_make(one, request, there) for one, there in zip(job.single, paths, strict=True)])


def _make(job: Job, request: FileRequest, path: Path) -> Made:
    match request.kind:
        case "dxf" | "svg":
            from camgeo.output.drawing import make_drawing

            return make_drawing(job, request, path)
        case "stl":
            from camgeo.output.solid import make_stl

            return make_stl(job, request, path)
        case "3mf":
            from camgeo.output.solid import make_3mf

            return make_3mf(job, request, path)
        case "step":
            from camgeo.output.step import make_step

            return make_step(job, request, path)
        case "glb":
            from camgeo.output.view import make_view

            return make_view(job, request, path)
        case "csv":
            from camgeo.output.table import make_table

            return make_table(job, request, path)
        case "gcode":
            from camgeo.output.gcode import make_gcode

            return make_gcode(job, request, path)
    raise ValueError(f"nothing makes {request.kind} alone")


class Capacity(NamedTuple):
    """How many surfaces of a cam of one disc, and how many discs on one shaft, a form of a file is taught to hold."""

    surfaces: int
    discs: int


CAPACITIES: dict[tuple[str, str | None], Capacity] = {
    ("dxf", "arcs"): Capacity(2, 2),
    ("dxf", "polyline"): Capacity(2, 2),
    ("dxf", "spline"): Capacity(2, 2),
    ("svg", "arcs"): Capacity(2, 2),
    ("svg", "polyline"): Capacity(2, 2),
    ("svg", "spline"): Capacity(2, 2),
    ("step", "arcs"): Capacity(2, 2),
    ("step", "spline"): Capacity(2, 2),
    ("stl", None): Capacity(2, 2),
    ("3mf", None): Capacity(2, 2),
    ("glb", None): Capacity(2, 2),
    ("gcode", None): Capacity(2, 2),
    ("csv", "motion"): Capacity(2, 2),
    ("csv", "contacts"): Capacity(2, 2),
    ("csv", "polar"): Capacity(1, 1),
    ("csv", "grinding"): Capacity(1, 1),
    ("csv", "lift"): Capacity(1, 1),
    ("csv", "inspection"): Capacity(2, 1),
    ("csv", "forces"): Capacity(2, 2),
    ("csv", "trace"): Capacity(1, 1),
}
"""Of each form of a file: of a cam with more it would be silently wrong, and is refused."""


def demand_taught(recipe: Recipe, design: Design, request: FileRequest) -> None:
    """Raise RecipeErrors where a form of file is not taught as many surfaces or discs as the cam has."""
    form, surfaces, discs = (request.kind, request.as_), len(design.exact.surfaces), len(design.discs)
    capacity = CAPACITIES.get(form, Capacity(1, 1))
    if discs > capacity.discs:
        others, what = [other for other, most in CAPACITIES.items() if most.discs >= discs], f"{discs} discs"
    elif discs == 1 and surfaces > capacity.surfaces:
        others, what = (
            [other for other, most in CAPACITIES.items() if most.surfaces >= surfaces],
            f"{surfaces} surfaces",
        )
    else:
        return
    held = ", ".join(kind if how is None else f"{kind} as {how}" for kind, how in others)
    word = request.kind if request.as_ is None else f"{request.kind} as {request.as_}"
    remedy = f"give {held}" if held else "leave it out"
    raise recipe.error(recipe.field_of(request), f"{word} does not hold a cam of {what}", None, remedy)


def foresee(job: Job, request: FileRequest) -> None:
    """Refuse what is certain to be refused, before anything is fitted; raises as `make` does."""
    demand_taught(job.recipe, job.design, request)
    if request.parts == "all":
        from camgeo.output.mechanism import foresee_mechanism

        foresee_mechanism(job, request)
    job, failed = job.of_file(request)
    if request.kind in SOLIDS - {"step"} and not failed:
        from camgeo.output.solid import aim

        for single in job.single:
            aim(single, request)
