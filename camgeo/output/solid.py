"""Solids of the cam as meshes: a polygon extruded with what is cut out of it."""

from __future__ import annotations

from functools import reduce
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from camgeo.files.mesh import Item
from camgeo.files.solid import need_booleans
from camgeo.fit.bound import Bound
from camgeo.fit.nodes import ToleranceError
from camgeo.output.extension import MAKING, numbers_of
from camgeo.output.part_geometry import contours_of, needs_booleans, openings_of, part_mesh, rim_of
from kin.numeric.records import replace

if TYPE_CHECKING:
    from pathlib import Path

    from camgeo.files.mesh import Mesh, MeshFacts
    from camgeo.files.precision import Precision
    from camgeo.output.job import Job, MadeFiles
    from camgeo.recipe.export import FileRequest
    from kin.numeric.arrays import Array


def make_mesh(job: Job, request: FileRequest, path: Path) -> MadeFiles:
    """Fit, write, read back and judge the discs of a file, each a mesh in its place.

    `foresee` has to pass before. Raises RecipeErrors for a part without thickness, a tolerance that cannot be held, and
    outlines that make no sound solid; ValueError for a format without meshes, OSError where the file cannot be written.
    """
    write, kind = MAKING[request.kind].write, request.kind
    if write is None:
        raise ValueError(f"{kind} holds no mesh")
    meshed = cam_meshes(job, request)
    items = [Item(body.name, body.mesh, body.place) for body in meshed]
    with job.clock.stage(f"write {kind}"):
        write(path, items, job.recipe.name, job.recipe.in_units_of(request).mm, job.recipe.about)
    bound = reduce(Bound.wider, (body.facts.bound for body in meshed))
    judged = job.judge if len(meshed) == 1 else job.judge_together
    return judged(request, path, bound, sum(body.facts.vertices for body in meshed))


def foresee(job: Job, request: FileRequest) -> None:
    """Refuse a file of meshes that cannot be made, before anything is fitted.

    Raises RecipeErrors for a tolerance that the precision of the file cannot hold, MissingExtraError for a part that
    needs a missing package.
    """
    for single in job.single:
        aim(single, request)
        if needs_booleans(single.body):
            need_booleans()


def numbers(job: Job, request: FileRequest) -> Precision:
    """Precision of the coordinates in a request's mesh file, in its unit; raises ValueError for one without meshes."""
    return numbers_of(request.kind, job.recipe.in_units_of(request).mm)


def aim(job: Job, request: FileRequest) -> float:
    """Tolerance, mm, of the fit of a cam of one disc, once rounding in the file and a chamfer have taken their share.

    Raises RecipeErrors where too little is left, ValueError for several discs or a format without meshes.
    """
    contours = (contour for _, contour in job.design.contours)
    size = max(float(np.abs(contour.sample(contour.cells.low).point).max()) for contour in contours)
    # 1 % more, as between two samples the contour reaches a little farther
    try:
        fine = numbers(job, request).fit_tolerance(job.tolerance(request), 1.01 * size)
    except ToleranceError as error:
        raise job.refusal(request, error) from error
    return fine * job.body.fineness


class DiscMesh(NamedTuple):
    """A disc of a cam as a named mesh with facts on it.

    `place` (4, 3) has the disc's three axes and its origin, mm, on the shaft; None for z = 0.
    """

    name: str
    mesh: Mesh
    facts: MeshFacts
    place: Array | None = None

    @property
    def standing(self) -> Mesh:
        """Mesh moved to its place on the shaft."""
        return self.mesh if self.place is None else replace(self.mesh, points=self.mesh.points + self.place[3])


def cam_meshes(job: Job, request: FileRequest) -> list[DiscMesh]:
    """Mesh of every disc of the cam in its order, within a request's tolerance, in the precision of its file.

    Raises RecipeErrors for a part without thickness, a tolerance that cannot be held, and outlines that make no sound
    solid; ModuleNotFoundError where manifold3d is needed and missing, which `foresee` refuses.
    """
    discs = job.design.discs
    if len(discs) == 1:
        return [DiscMesh("cam", *cam_mesh(job, request))]
    meshes = []
    for disc, single in zip(discs, job.single, strict=True):
        place = np.vstack([np.eye(3), [0.0, 0.0, disc.z]]) if disc.z else None
        meshes.append(DiscMesh(disc.name, *cam_mesh(single, request), place))
    return meshes


def cam_mesh(job: Job, request: FileRequest) -> tuple[Mesh, MeshFacts]:
    """Mesh of a cam of one disc with its whole part, and facts on it.

    The mesh is within the request's tolerance, in the precision of its file.
    Raises RecipeErrors for a part without thickness, a tolerance that cannot be held, and outlines that make no sound
    solid; ModuleNotFoundError where manifold3d is needed and missing, which `foresee` refuses.
    """
    recipe, tolerance, precision = job.recipe, job.tolerance(request), numbers(job, request)
    if recipe.part.thickness is None:
        raise recipe.error("part.thickness", "a solid needs a thickness")
    fine = aim(job, request)
    with job.refusals(request):
        contours = contours_of(job.design, job.outlines("polyline", fine))
        outlines = [*rim_of(job.body), *contours, *openings_of(job.body)]
        with job.clock.stage(f"mesh {request.kind}"):
            return part_mesh(outlines, job.body, tolerance=tolerance, precision=precision)
