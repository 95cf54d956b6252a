"""Meshes as binary glTF 2.0, to look at: one node a body, coloured, with its motion over one turn of the shaft.

glTF is in metres with y upward, so a point (x, y, z) in mm stands there at (x, z, -y)/1000 in single precision, and an
angle about z becomes an angle about the y axis of glTF. Normals are left out: a viewer then shades every triangle flat.
"""

from __future__ import annotations

import json
import math
from typing import TYPE_CHECKING, Any

import numpy as np

from camgeo.common.units import UNIT_MM
from camgeo.formats.meshes import foresee_mesh
from camgeo.formats.options import TOLERANCE
from camgeo.output.extension import Making
from camgeo.registry.formats import Format
from camgeo.schema.fields import FieldTable
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from numpy.typing import NDArray

    from camgeo.files.mesh import Mesh
    from camgeo.files.precision import Precision
    from camgeo.output.job import Job, MadeFiles
    from camgeo.recipe.export import FileRequest
    from kin.numeric.arrays import Array

PERIOD = 4.0  # seconds of a turn in a viewer
_METRE = 1e-3  # of a mm
_FLOAT, _INDEX = 5126, 5125  # single precision, unsigned whole numbers of 32 bits
_POINTS, _TRIANGLES = 34962, 34963  # what a part of the buffer is for
_JSON, _BIN = b"JSON", b"BIN\0"
_ROUGHNESS, _METAL = 0.6, 0.1


@dataclass(frozen=True, eq=False)
class Actor:
    """A named mesh, mm, its colour "#rrggbb", and its pose (n, 3) at equal steps of a turn, or (1, 3) at rest.

    The pose is x and y, mm, and an angle, rad, that goes on from step to step without jumps of a turn. The first row
    is for the start of the turn, the last one for its end. The angle is about the direction `axis`, a unit vector, at
    the height z, mm.
    """

    name: str
    mesh: Mesh
    pose: Array
    colour: str
    axis: tuple[float, float, float] = (0.0, 0.0, 1.0)
    height: float = 0.0


def write_glb(path: Path, actors: Sequence[Actor], *, title: str) -> None:
    """Write bodies and their motion over one turn, as a scene named `title`.

    Raises OSError where the file cannot be written.
    """
    buffer = _Buffer()
    nodes: list[dict[str, Any]] = []
    meshes: list[dict[str, Any]] = []
    materials: list[dict[str, Any]] = []
    channels: list[dict[str, Any]] = []
    samplers: list[dict[str, Any]] = []
    times: dict[int, int] = {}
    for k, actor in enumerate(actors):
        meshes.append(_mesh(buffer, actor, k))
        materials.append(_material(actor))
        shift = _y_up(np.column_stack((actor.pose[:, :2], np.full(len(actor.pose), actor.height))))
        # a turn by a about a unit vector u is the quaternion (u sin a/2, cos a/2)
        half, (x, y, z) = 0.5 * actor.pose[:, 2], actor.axis
        turn = np.column_stack((np.outer(np.sin(half), (x, z, -y)) + 0.0, np.cos(half))).astype("<f4")
        nodes.append({"name": actor.name, "mesh": k, "translation": shift[0].tolist(), "rotation": turn[0].tolist()})
        steps = len(actor.pose)
        if steps == 1:
            continue
        # bodies with equally many steps share their times; a viewer interpolates place and turn between them
        if steps not in times:
            clock = np.linspace(0.0, PERIOD, steps).astype("<f4").reshape(-1, 1)
            times[steps] = buffer.append(clock, "SCALAR", None, bounds=True)
        for channel, values, shape in (("translation", shift, "VEC3"), ("rotation", turn, "VEC4")):
            channels.append({"sampler": len(samplers), "target": {"node": k, "path": channel}})
            output = buffer.append(values, shape, None)
            samplers.append({"input": times[steps], "interpolation": "LINEAR", "output": output})
    document: dict[str, Any] = {
        "asset": {"version": "2.0", "generator": "camgeo"},
        "scene": 0,
        "scenes": [{"name": title, "nodes": list(range(len(nodes)))}],
        "nodes": nodes,
        "meshes": meshes,
        "materials": materials,
        "accessors": buffer.accessors,
        "bufferViews": buffer.views,
        "buffers": [{"byteLength": len(buffer.data)}],
    }
    if channels:
        document["animations"] = [{"name": "one turn", "channels": channels, "samplers": samplers}]
    text = json.dumps(document, separators=(",", ":"), ensure_ascii=False).encode("utf-8")
    chunks = _chunk(_JSON, text, b" ") + _chunk(_BIN, bytes(buffer.data), b"\0")
    path.write_bytes(b"glTF" + _word(2) + _word(12 + len(chunks)) + chunks)


class _Buffer:
    """Binary part of a glTF file under construction, with its views and accessors."""

    def __init__(self) -> None:
        self.data = bytearray()
        self.views: list[dict[str, Any]] = []
        self.accessors: list[dict[str, Any]] = []

    def append(self, values: NDArray[Any], shape: str, target: int | None, *, bounds: bool = False) -> int:
        """Append an array (n, k) of 4-byte numbers; returns the number of its accessor.

        `shape` is glTF's word for a row, `target` what the rows are for; with `bounds` the accessor has their extremes.
        """
        view: dict[str, Any] = {"buffer": 0, "byteOffset": len(self.data), "byteLength": values.nbytes}
        if target is not None:
            view["target"] = target
        accessor: dict[str, Any] = {
            "bufferView": len(self.views),
            "componentType": _INDEX if values.dtype == np.dtype("<u4") else _FLOAT,
            "count": len(values),
            "type": shape,
        }
        if bounds:
            accessor |= {"min": values.min(axis=0).tolist(), "max": values.max(axis=0).tolist()}
        self.views.append(view)
        self.accessors.append(accessor)
        self.data += values.tobytes()
        return len(self.accessors) - 1


def _mesh(buffer: _Buffer, actor: Actor, material: int) -> dict[str, Any]:
    """Triangles of a body, put into the buffer."""
    position = buffer.append(_y_up(actor.mesh.points), "VEC3", _POINTS, bounds=True)
    triangles = buffer.append(actor.mesh.triangles.astype("<u4").reshape(-1, 1), "SCALAR", _TRIANGLES)
    primitive = {"attributes": {"POSITION": position}, "indices": triangles, "material": material}
    return {"name": actor.name, "primitives": [primitive]}


def _y_up(points: Array) -> NDArray[np.float32]:
    """Points (n, 3) in m with y upward, as glTF has them, of points in mm with z upward."""
    x, y, z = _METRE * points.T
    return np.column_stack((x, z, 0.0 - y)).astype("<f4")


def _material(actor: Actor) -> dict[str, Any]:
    """Material of an actor: its colour, `#rrggbb` of sRGB, as the linear light of glTF."""
    red, green, blue = (int(actor.colour[k : k + 2], 16) / 255.0 for k in (1, 3, 5))
    light = [round(c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4, 4) for c in (red, green, blue)]
    surface = {"baseColorFactor": [*light, 1.0], "metallicFactor": _METAL, "roughnessFactor": _ROUGHNESS}
    return {"name": actor.name, "pbrMetallicRoughness": surface}


def _chunk(kind: bytes, data: bytes, filler: bytes) -> bytes:
    padded = data + filler * (-len(data) % 4)
    return _word(len(padded)) + kind + padded


def _word(number: int) -> bytes:
    return number.to_bytes(4, "little")


# --- its files --------------------------------------------------------------------------------------------------------

COLOURS = "#d08a3c", "#5b8aa6"  # of the first disc, and of one above it
STEPS = 8  # of a turn: between two a viewer turns steadily, as the shaft does


def steady_turn(rotation: str) -> Array:
    """Pose (STEPS + 1, 3) of a body on the shaft, at equal steps of a turn: x, y, mm, and angle, rad.

    The angle goes from 0 to 2 pi for rotation `ccw`, else to -2 pi; x and y are 0.
    """
    sense = 1.0 if rotation == "ccw" else -1.0
    pose = np.zeros((STEPS + 1, 3))
    pose[:, 2] = sense * 2.0 * math.pi * np.arange(STEPS + 1) / STEPS
    return pose


def make_view(job: Job, request: FileRequest, path: Path) -> MadeFiles:
    """Fit and write the cam, turning once, for viewers.

    Raises RecipeErrors for a part without thickness, a tolerance that cannot be held, and outlines that make no sound
    solid; OSError where the file cannot be written. A missing package is refused before, by `foresee` of the format.
    """
    from camgeo.output.job import unjudged
    from camgeo.output.solid import cam_meshes

    discs, pose = cam_meshes(job, request), steady_turn(job.recipe.rotation)
    with job.clock.stage("write glb"):
        actors = [Actor(disc.name, disc.standing, pose, COLOURS[k % 2]) for k, disc in enumerate(discs)]
        write_glb(path, actors, title=job.recipe.name)
    return unjudged(path, request, UNIT_MM["m"])


def _single() -> Precision:
    from camgeo.files.precision import SINGLE

    return SINGLE


FORMAT = Format(
    name="glb",
    options=FieldTable((TOLERANCE,)),
    contour=False,
    part=False,
    solid=True,
    mesh=True,
)
MAKING = Making(make=make_view, foresee=foresee_mesh, numbers=_single)
