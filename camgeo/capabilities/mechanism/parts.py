"""Solids of every body of a mechanism, the cam among them: a file each, or all in one."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from camgeo.capabilities.mechanism.interference import slabs
from camgeo.capabilities.mechanism.meshes import body_mesh, flat, laid_out, mirrored, standing
from camgeo.common.units import UNIT_MM
from camgeo.files.errors import RegionError
from camgeo.files.mesh import Item
from camgeo.fit.pieces import Bound
from camgeo.measures.file_result import FileResult
from camgeo.output.job import Made
from camgeo.output.solid import cam_mesh, numbers

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from pathlib import Path

    from camgeo.capabilities.mechanism.body import PrintBody
    from camgeo.files.mesh import Mesh
    from camgeo.output.job import Job
    from camgeo.recipe.export import FileRequest
    from kin.judge.check import Check
    from kin.numeric.arrays import Array

CAM = "cam"


class Part(NamedTuple):
    """A body as drawn, its mesh in axes of its own, and how far its walls are off.

    The cam's mesh is that of its own files, with z = 0 in the lower face of the disc; `raised` is where that face is,
    and `pieces` counts the edges of its contour.
    """

    body: PrintBody
    mesh: Mesh
    bound: Bound
    raised: float = 0.0
    pieces: int | None = None

    @property
    def raised_mesh(self) -> Mesh:
        """Its mesh in the axes of the body, as it moves."""
        return replace(self.mesh, points=self.mesh.points + np.array([0.0, 0.0, self.raised]))

    @property
    def place(self) -> Array:
        """Where it stands at shaft angle 0."""
        found = standing(self.body.pose[0])
        found[3, 2] = self.raised
        return found


def make_parts(job: Job, request: FileRequest, path: Path, bodies: Sequence[PrintBody]) -> Made:
    """Write and judge all bodies, given as for a shaft that turns clockwise; one of them is named "cam".

    A format whose files are by disc has one for each body, another two of all, one to look at shows them move. Raises
    RecipeErrors and SurroundingsError as `make` does.
    """
    record = request.format
    write = one_by_one if record.by_disc else together if record.contour else moving
    drawn = [mirrored(body) for body in bodies] if job.recipe.rotation == "ccw" else list(bodies)
    # the cam's own mesh last, as it is dear: a body that has none is told at once
    meshed = {body.name: _part(job, request, body) for body in sorted(drawn, key=lambda body: body.name == CAM)}
    parts = [meshed[body.name] for body in drawn]
    with job.clock.stage(f"write {request.kind}"):
        return write(job, request, path, parts)


def _part(job: Job, request: FileRequest, body: PrintBody) -> Part:
    if body.name == CAM:
        mesh, facts = cam_mesh(job, request)
        return Part(body, mesh, facts.bound, body.low - float(mesh.points[:, 2].min()), facts.vertices)
    with job.refusals(request), job.clock.stage(f"mesh {request.kind}"):
        try:
            mesh, off = body_mesh(body, tolerance=job.tolerance(request), precision=numbers(job, request))
        except RegionError as error:
            raise job.recipe.error("mechanism", str(error)) from error
    return Part(body, mesh, Bound(off, off))


def one_by_one(job: Job, request: FileRequest, path: Path, parts: Sequence[Part]) -> Made:
    """Write and judge a file for each body: the cam's at `path`, the others' `<name>-<body>` beside it, lying flat."""
    from kin.read.files import read_meshes

    mm, ending, write = job.recipe.told_for(request).mm, request.format.ending, _writer(request)
    files: list[FileResult] = []
    checks: list[Check] = []
    for part in parts:
        name = part.body.name
        if name == CAM:
            write(path, [Item(name, part.mesh)], f"{job.recipe.name}: {name}", mm, "")
            made = _judged_cam(job, request, path, part)
        else:
            there = path.with_name(f"{job.recipe.name}-{name}.{ending}")
            turn, lift = flat(part.mesh)
            lying = replace(part.mesh, points=numbers(job, request).rounded(part.mesh.points @ turn + lift)[0])
            write(there, [Item(name, lying)], f"{job.recipe.name}: {name}", mm, "")
            (built,) = read_meshes(there, mm)
            # the way back is the way there: half a turn, and the lift undone before it
            made = _judged_body(job, request, there, part, (built.corners - lift) @ turn)
        files += made.files
        checks += made.checks
    return Made(tuple(files), tuple(checks))


def together(job: Job, request: FileRequest, path: Path, parts: Sequence[Part]) -> Made:
    """Write and judge two files of all bodies: laid out for printing at `path`, standing in `<name>-assembly`."""
    from kin.read.files import read_meshes

    recipe, mm, write = job.recipe, job.recipe.told_for(request).mm, _writer(request)
    for_printing = laid_out([part.mesh for part in parts])
    standing_there = path.with_name(f"{recipe.name}-assembly.{request.format.ending}")
    made = Made(())
    for there, places in ((path, for_printing), (standing_there, [part.place for part in parts])):
        items = [Item(p.body.name, p.mesh, place) for p, place in zip(parts, places, strict=True)]
        write(there, items, recipe.name, mm, recipe.about)
        built = {one.name: one for one in read_meshes(there, mm)}
        checks: list[Check] = []
        for part in parts:
            if part.body.name == CAM:
                cam = _judged_cam(job, request, there, part)
                checks += cam.checks
                files = cam.files
            else:
                checks += _judged_body(job, request, there, part, built[part.body.name].corners).checks
        if there is standing_there:
            files = tuple(replace(file, body="assembly") for file in files)
        made = Made((*made.files, *files), (*made.checks, *checks))
    return made


def moving(job: Job, request: FileRequest, path: Path, parts: Sequence[Part]) -> Made:
    """Write all bodies as they move, to look at."""
    from camgeo.formats.glb import Actor, write_glb
    from camgeo.output.job import looked_at

    actors = [Actor(part.body.name, part.raised_mesh, part.body.pose, part.body.colour) for part in parts]
    write_glb(path, actors, title=job.recipe.name)
    return looked_at(path, request, UNIT_MM["m"])


def _writer(request: FileRequest) -> Callable[[Path, Sequence[Item], str, float, str], None]:
    if request.format.write is None:
        raise ValueError(f"{request.kind} holds no mesh")
    return request.format.write


def _judged_cam(job: Job, request: FileRequest, path: Path, part: Part) -> Made:
    return job.judged(request, path, part.bound, part.pieces or 0)


def _judged_body(job: Job, request: FileRequest, path: Path, part: Part, corners: Array) -> Made:
    from kin.judge.check import about
    from kin.judge.printed import judge_body

    tolerance, units = job.tolerance(request), job.recipe.told_for(request).mm
    with job.clock.stage(f"judge {request.kind}"):
        checks = judge_body(part.body.name, corners, slabs(part.body.plates), tolerance, path)
    file = FileResult(path, request, tolerance, None, part.bound, part.body.name, units)
    return Made((file,), tuple(about(check, path.name) for check in checks))
