"""Solids of every body of a mechanism, the cam among them: a file each, or all in one."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from camgeo.capabilities.mechanism.interference import slabs
from camgeo.capabilities.mechanism.meshes import body_mesh, layout, mirror, pose_matrix, print_pose
from camgeo.common.units import UNIT_MM
from camgeo.files.errors import RegionError
from camgeo.files.mesh import Item
from camgeo.fit.pieces import Bound
from camgeo.measures.file_result import FileResult
from camgeo.output.extension import MAKING
from camgeo.output.job import MadeFiles
from camgeo.output.solid import cam_mesh, numbers

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from pathlib import Path

    from camgeo.capabilities.mechanism.assembly import PrintBody
    from camgeo.files.mesh import Mesh
    from camgeo.output.job import Job
    from camgeo.recipe.export import FileRequest
    from kin.numeric.arrays import Array
    from kin.numeric.check import Check

CAM = "cam"


class MeshedBody(NamedTuple):
    """A body, its mesh, and the error of its walls.

    The mesh is in the body's axes, but for the cam: there it is the mesh of the cam's own files, whose z = 0 is raised
    to z = `raised`, mm, in the mechanism. `pieces` is the number of edges of the cam's contour, None for other bodies.
    """

    body: PrintBody
    mesh: Mesh
    bound: Bound
    raised: float = 0.0
    pieces: int | None = None

    @property
    def raised_mesh(self) -> Mesh:
        """Mesh in the body's axes, in which it moves."""
        return replace(self.mesh, points=self.mesh.points + np.array([0.0, 0.0, self.raised]))

    @property
    def place(self) -> Array:
        """Matrix (4, 3) of the mesh at shaft angle 0: images of the axes, then of the origin, mm."""
        matrix = pose_matrix(self.body.pose[0])
        matrix[3, 2] = self.raised
        return matrix


def make_parts(job: Job, request: FileRequest, path: Path, bodies: Sequence[PrintBody]) -> MadeFiles:
    """Write and judge all bodies, drawn for a shaft that turns clockwise; the cam is the body named "cam".

    A format with one file for each disc gets one file for each body, another format that is judged two files of all
    bodies, laid out and assembled, and a format for viewers one file of bodies in motion. Raises RecipeErrors where a
    mesh cannot be made within the tolerance, OSError where a file cannot be written, ReadError where it cannot be read
    back.
    """
    record = request.format
    write = write_each if record.by_disc else write_together if record.contour else write_moving
    drawn = [mirror(body) for body in bodies] if job.recipe.rotation == "ccw" else list(bodies)
    # the cam's own mesh last, as it takes longest: errors of other bodies come first
    meshed = {body.name: _mesh(job, request, body) for body in sorted(drawn, key=lambda body: body.name == CAM)}
    parts = [meshed[body.name] for body in drawn]
    with job.clock.stage(f"write {request.kind}"):
        return write(job, request, path, parts)


def _mesh(job: Job, request: FileRequest, body: PrintBody) -> MeshedBody:
    """Body with its closed mesh; raises RecipeErrors where no mesh can be made within the tolerance."""
    if body.name == CAM:
        mesh, facts = cam_mesh(job, request)
        return MeshedBody(body, mesh, facts.bound, body.low - float(mesh.points[:, 2].min()), facts.vertices)
    with job.refusals(request), job.clock.stage(f"mesh {request.kind}"):
        try:
            mesh, error_mm = body_mesh(body, tolerance=job.tolerance(request), precision=numbers(job, request))
        except RegionError as error:
            raise job.recipe.error("mechanism", str(error)) from error
    return MeshedBody(body, mesh, Bound(error_mm, error_mm))


def write_each(job: Job, request: FileRequest, path: Path, parts: Sequence[MeshedBody]) -> MadeFiles:
    """Write and judge a file for each body: the cam's at `path`, others as `<name>-<body>` beside it, lying flat.

    Raises OSError where a file cannot be written, ReadError where it cannot be read back.
    """
    from kin.read.files import read_meshes

    mm, ending, write = job.recipe.in_units_of(request).mm, request.format.ending, _writer(request)
    files: list[FileResult] = []
    checks: list[Check] = []
    for part in parts:
        name = part.body.name
        if name == CAM:
            write(path, [Item(name, part.mesh)], f"{job.recipe.name}: {name}", mm, "")
            made = _judge_cam(job, request, path, part)
        else:
            beside = path.with_name(f"{job.recipe.name}-{name}.{ending}")
            rotation, shift = print_pose(part.mesh)
            lying = replace(part.mesh, points=numbers(job, request).rounded(part.mesh.points @ rotation + shift)[0])
            write(beside, [Item(name, lying)], f"{job.recipe.name}: {name}", mm, "")
            (built,) = read_meshes(beside, mm)
            # back in the body's axes: the rotation is its own inverse
            made = _judge_body(job, request, beside, part, (built.corners - shift) @ rotation)
        files += made.files
        checks += made.checks
    return MadeFiles(tuple(files), tuple(checks))


def write_together(job: Job, request: FileRequest, path: Path, parts: Sequence[MeshedBody]) -> MadeFiles:
    """Write and judge two files of all bodies: laid out for printing at `path`, assembled in `<name>-assembly`.

    Raises OSError where a file cannot be written, ReadError where it cannot be read back.
    """
    from kin.read.files import read_meshes

    recipe, mm, write = job.recipe, job.recipe.in_units_of(request).mm, _writer(request)
    on_plate = layout([part.mesh for part in parts])
    assembled = path.with_name(f"{recipe.name}-assembly.{request.format.ending}")
    made = MadeFiles(())
    for file_path, places in ((path, on_plate), (assembled, [part.place for part in parts])):
        items = [Item(p.body.name, p.mesh, place) for p, place in zip(parts, places, strict=True)]
        write(file_path, items, recipe.name, mm, recipe.about)
        built = {body.name: body for body in read_meshes(file_path, mm)}
        checks: list[Check] = []
        for part in parts:
            if part.body.name == CAM:
                cam = _judge_cam(job, request, file_path, part)
                checks += cam.checks
                files = cam.files
            else:
                checks += _judge_body(job, request, file_path, part, built[part.body.name].corners).checks
        if file_path is assembled:
            files = tuple(replace(file, body="assembly") for file in files)
        made = MadeFiles((*made.files, *files), (*made.checks, *checks))
    return made


def write_moving(job: Job, request: FileRequest, path: Path, parts: Sequence[MeshedBody]) -> MadeFiles:
    """Write a file of all bodies in motion, for viewers, which is not judged; OSError where it cannot be written."""
    from camgeo.formats.glb import Actor, write_glb
    from camgeo.output.job import unjudged

    actors = [Actor(part.body.name, part.raised_mesh, part.body.pose, part.body.colour) for part in parts]
    write_glb(path, actors, title=job.recipe.name)
    return unjudged(path, request, UNIT_MM["m"])


def _writer(request: FileRequest) -> Callable[[Path, Sequence[Item], str, float, str], None]:
    write = MAKING[request.kind].write
    if write is None:
        raise ValueError(f"{request.kind} holds no mesh")
    return write


def _judge_cam(job: Job, request: FileRequest, path: Path, part: MeshedBody) -> MadeFiles:
    return job.judge(request, path, part.bound, part.pieces or 0)


def _judge_body(job: Job, request: FileRequest, path: Path, part: MeshedBody, corners: Array) -> MadeFiles:
    """Compare the triangles `corners` of a file, mm in the body's axes, with the body's plates."""
    from kin.mechanism.printed import judge_body
    from kin.numeric.check import about

    tolerance, units = job.tolerance(request), job.recipe.in_units_of(request).mm
    with job.clock.stage(f"judge {request.kind}"):
        checks = judge_body(part.body.name, corners, slabs(part.body.plates), tolerance, path)
    file = FileResult(path, request, tolerance, None, part.bound, part.body.name, units)
    return MadeFiles((file,), tuple(about(check, path.name) for check in checks))
