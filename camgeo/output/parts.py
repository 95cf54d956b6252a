"""Solids of every body of a mechanism, the cam among them: an STL each, or all in one 3MF or GLB."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from camgeo.assembly.interference import slabs
from camgeo.assembly.meshes import body_mesh, flat, laid_out, mirrored, standing
from camgeo.common.units import UNIT_MM
from camgeo.files.errors import RegionError
from camgeo.fit.pieces import Bound
from camgeo.measures.file_result import FileResult
from camgeo.output.job import Made
from camgeo.output.solid import cam_mesh, precision_of

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from camgeo.assembly.body import PrintBody
    from camgeo.files.mesh import Mesh
    from camgeo.formats.three_mf import Item
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
    def place(self) -> Array:
        """Where it stands at shaft angle 0."""
        found = standing(self.body.pose[0])
        found[3, 2] = self.raised
        return found


def make_parts(job: Job, request: FileRequest, path: Path, bodies: Sequence[PrintBody]) -> Made:
    """Write and judge all bodies, given as for a shaft that turns clockwise; one of them is named "cam".

    STL: one file a body, the cam's at `path`, the others' `<name>-<body>.stl` beside it, lying flat. 3MF: laid out for
    printing at `path`, and standing in the mechanism in `<name>-assembly.3mf`. GLB: moving, at `path`.
    Raises RecipeErrors and SurroundingsError as `make` does.
    """
    drawn = [mirrored(body) for body in bodies] if job.recipe.rotation == "ccw" else list(bodies)
    # the cam's own mesh last, as it is dear: a body that has none is told at once
    meshed = {body.name: _part(job, request, body) for body in sorted(drawn, key=lambda body: body.name == CAM)}
    parts = [meshed[body.name] for body in drawn]
    with job.clock.stage(f"write {request.kind}"):
        if request.kind == "glb":
            return _glb(job, request, path, parts)
        if request.kind == "3mf":
            return _three_mf(job, request, path, parts)
        return _stl(job, request, path, parts)


def _part(job: Job, request: FileRequest, body: PrintBody) -> Part:
    if body.name == CAM:
        mesh, facts = cam_mesh(job, request)
        return Part(body, mesh, facts.bound, body.low - float(mesh.points[:, 2].min()), facts.vertices)
    with job.refusals(request), job.clock.stage(f"mesh {request.kind}"):
        try:
            mesh, off = body_mesh(body, tolerance=job.tolerance(request), precision=precision_of(job, request))
        except RegionError as error:
            raise job.recipe.error("mechanism", str(error)) from error
    return Part(body, mesh, Bound(off, off))


def _stl(job: Job, request: FileRequest, path: Path, parts: Sequence[Part]) -> Made:
    from camgeo.formats.stl import write_stl
    from kin.read.mesh.stl import triangles_of

    mm = job.recipe.told_for(request).mm
    files: list[FileResult] = []
    checks: list[Check] = []
    for part in parts:
        name = part.body.name
        if name == CAM:
            write_stl(path, part.mesh, mm=mm, about=f"{job.recipe.name}: {name}")
            made = _judged_cam(job, request, path, part)
        else:
            there = path.with_name(f"{job.recipe.name}-{name}.stl")
            turn, lift = flat(part.mesh)
            lying = replace(part.mesh, points=precision_of(job, request).rounded(part.mesh.points @ turn + lift)[0])
            write_stl(there, lying, mm=mm, about=f"{job.recipe.name}: {name}")
            corners = triangles_of(there.read_bytes(), there)[0].astype(np.float64) * mm
            # the way back is the way there: half a turn, and the lift undone before it
            made = _judged_body(job, request, there, part, (corners - lift) @ turn)
        files += made.files
        checks += made.checks
    return Made(tuple(files), tuple(checks))


def _three_mf(job: Job, request: FileRequest, path: Path, parts: Sequence[Part]) -> Made:
    from camgeo.formats.three_mf import Item, write_3mf
    from kin.read.mesh.threemf import read_placed

    recipe = job.recipe
    for_printing = laid_out([part.mesh for part in parts])
    standing_there = path.with_name(f"{recipe.name}-assembly.3mf")
    made = Made(())
    for there, places in ((path, for_printing), (standing_there, [part.place for part in parts])):
        items: list[Item] = [Item(p.body.name, p.mesh, place) for p, place in zip(parts, places, strict=True)]
        write_3mf(there, items, title=recipe.name, mm=recipe.told_for(request).mm, about=recipe.about)
        built = {one.name: one for one in read_placed(there)}
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


def _glb(job: Job, request: FileRequest, path: Path, parts: Sequence[Part]) -> Made:
    from camgeo.formats.glb import Actor, write_glb

    actors = []
    for part in parts:
        mesh = replace(part.mesh, points=part.mesh.points + np.array([0.0, 0.0, part.raised]))
        actors.append(Actor(part.body.name, mesh, part.body.pose, part.body.colour))
    write_glb(path, actors, title=job.recipe.name)
    return Made((FileResult(path, request, units=UNIT_MM["m"]),))


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
