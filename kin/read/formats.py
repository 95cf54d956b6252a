"""Formats of files that are read: an entry each, with all that is known of it.

A format is an entry of `FORMATS` and its reader, which shares nothing with any writer. Readers import what they need
from here; here they are imported when a file is read, and for types alone.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal, NamedTuple, TypeAlias

import numpy as np

from kin.numeric.records import dataclass
from kin.read.errors import ReadError

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from pathlib import Path

    from kin.contour.across import Across
    from kin.numeric.arrays import Array
    from kin.read.bodies import Placed, SeparateBody, Sought
    from kin.read.drawing.drawing import Drawing
    from kin.read.mesh.checked import Form, Triangles
    from kin.read.mesh.prism import Corners
    from kin.read.mesh.stl import Solid
    from kin.read.step.shell import Shell
    from kin.read.step.step import StepSolid

    AnySolid: TypeAlias = Solid | StepSolid

Contents: TypeAlias = Literal["drawing", "solid", "program", "table"]


class DrawingOptions(NamedTuple):
    """How a drawing is read.

    gap       mm; ends within it are joined. None: what the file's digits explain, or 1e-7 of the drawing's size
    engraved  read closed chains on the layer ENGRAVE too, if there is something on CUT
    deepest   how many others a closed chain may lie inside: 1, so that a hole has no island
    bridged   mm; gaps up to this, and open chains within the contour, are reported in `openings`; with 0 they raise
    unstated  mm; for a drawing that states no unit, `gap`, `bridged` and `shaft` take its unit to be this long
    across    how a contour that is open in one place is closed there: by an arc about the shaft, or by a chord
    shaft     place, mm, of which the contours are sought: what else is drawn is left aside. None: all of it is read
    """

    gap: float | None = None
    engraved: bool = False
    deepest: int = 1
    bridged: float = 0.0
    unstated: float = 1.0
    shaft: tuple[float, float] | None = None
    across: Across | None = None


@dataclass(frozen=True, kw_only=True)
class Format:
    """Facts of a file format.

    name      key in `FORMATS`, the word by which users name the format
    contents  what a file holds: a drawing, a solid, a program for a machine or a table; the judge goes by that
    most      greatest size of a file that is read, bytes: any is read in 2 GB of memory, and in seconds
    suffixes  endings of files' names; the first is the usual one
    units     whether a file states its unit
    drawing   reads a drawing: (path, options); None for a format that holds none
    solid     reads one part and its sections at heights, within which chains are nested: (path, heights, deepest)
    bodies    reads several parts of one file, the lowest first: (path, sections sought of each part)
    separate  reads the bodies of one file one by one, in the order of the file
    meshes    reads the triangles of each body, in mm, or in the file's unit where it states none
    part      reads the triangles of one part
    shell     reads one part of any shape by its exact faces
    """

    name: str
    contents: Contents
    most: int
    suffixes: tuple[str, ...]
    units: bool = True
    drawing: Callable[[Path, DrawingOptions], Drawing] | None = None
    solid: Callable[[Path, Sequence[float], int], AnySolid] | None = None
    bodies: Callable[[Path, Sequence[Sought]], Sequence[AnySolid]] | None = None
    separate: Callable[[Path], Sequence[SeparateBody]] | None = None
    meshes: Callable[[Path], Sequence[Placed]] | None = None
    part: Callable[[Path], Triangles] | None = None
    shell: Callable[[Path], Shell] | None = None


def mesh(
    name: str,
    most: int,
    suffixes: tuple[str, ...],
    triangles: Callable[[bytes, Path], tuple[Corners, Form]],
    *,
    units: bool,
) -> Format:
    """Make the entry of a format that holds one mesh.

    `triangles` (bytes, path) gives the corners (t, 3, 3), in the file's unit, and the form of the file. `most` is the
    greatest size of a file, bytes; `units` says whether a file states its unit.
    """

    def read(path: Path) -> tuple[Corners, Form]:
        return triangles(contents(path, name), path)

    def solid(path: Path, heights: Sequence[float], deepest: int) -> Solid:
        from kin.read.mesh.stl import solid_of

        return solid_of(*read(path), heights, path, deepest)

    def meshes(path: Path) -> Sequence[Placed]:
        from kin.read.bodies import Placed

        corners: Array = read(path)[0].astype(np.float64)
        return (Placed("", corners, np.eye(4, 3)),)

    def part(path: Path) -> Triangles:
        from kin.read.mesh.checked import Triangles

        return Triangles(*read(path))

    def separate(path: Path) -> Sequence[SeparateBody]:
        from kin.read.mesh.stl import bodies_of

        return bodies_of(*read(path), path)

    return Format(
        name=name,
        contents="solid",
        most=most,
        suffixes=suffixes,
        units=units,
        solid=solid,
        separate=separate,
        meshes=meshes,
        part=part,
    )


def _dxf(path: Path, options: DrawingOptions) -> Drawing:
    from kin.read.drawing.dxf import read_dxf

    return read_dxf(path, options)


def _svg(path: Path, options: DrawingOptions) -> Drawing:
    from kin.read.drawing.svg import read_svg

    return read_svg(path, options)


def _stl(raw: bytes, path: Path) -> tuple[Corners, Form]:
    from kin.read.mesh.stl import triangles_of

    return triangles_of(raw, path)


def _ply(raw: bytes, path: Path) -> tuple[Corners, Form]:
    from kin.read.mesh.ply import triangles_of

    return triangles_of(raw, path)


def _three_mf(path: Path, heights: Sequence[float], deepest: int) -> Solid:
    from kin.read.mesh.threemf import read_3mf

    return read_3mf(path, heights, deepest)


def _bodies_of_three_mf(path: Path, sought: Sequence[Sought]) -> Sequence[AnySolid]:
    from kin.read.mesh.threemf import read_3mf_bodies

    return read_3mf_bodies(path, sought)


def _meshes_of_three_mf(path: Path) -> Sequence[Placed]:
    from kin.read.mesh.threemf import read_placed

    return read_placed(path)


def _separate_of_three_mf(path: Path) -> Sequence[SeparateBody]:
    from kin.read.mesh.threemf import separate_bodies

    return separate_bodies(path)


def _separate_of_step(path: Path) -> Sequence[SeparateBody]:
    from kin.read.step.step import separate_bodies

    return separate_bodies(path)


def _part_of_three_mf(path: Path) -> Triangles:
    from kin.read.mesh.threemf import read_part

    return read_part(path)


def _step(path: Path, heights: Sequence[float], deepest: int) -> StepSolid:
    from kin.read.step.step import read_step

    return read_step(path, heights, deepest)


def _bodies_of_step(path: Path, sought: Sequence[Sought]) -> Sequence[AnySolid]:
    from kin.read.step.step import read_step_bodies

    return read_step_bodies(path, sought)


def _shell_of_step(path: Path) -> Shell:
    from kin.read.step.shell import read_shell

    return read_shell(path)


FORMATS: dict[str, Format] = {
    record.name: record
    for record in (
        Format(name="dxf", contents="drawing", most=64_000_000, suffixes=(".dxf",), drawing=_dxf),
        Format(name="svg", contents="drawing", most=48_000_000, suffixes=(".svg",), drawing=_svg),
        mesh("stl", 256_000_000, (".stl",), _stl, units=False),
        mesh("ply", 256_000_000, (".ply",), _ply, units=False),
        Format(
            name="3mf",
            contents="solid",
            most=64_000_000,
            suffixes=(".3mf",),
            solid=_three_mf,
            bodies=_bodies_of_three_mf,
            separate=_separate_of_three_mf,
            meshes=_meshes_of_three_mf,
            part=_part_of_three_mf,
        ),
        Format(
            name="step",
            contents="solid",
            most=16_000_000,
            suffixes=(".step", ".stp"),
            solid=_step,
            bodies=_bodies_of_step,
            separate=_separate_of_step,
            shell=_shell_of_step,
        ),
        Format(name="gcode", contents="program", most=32_000_000, suffixes=(".gcode", ".ngc", ".nc", ".tap")),
        Format(name="csv", contents="table", most=16_000_000, suffixes=(".csv", ".txt", ".xyz")),
    )
}
"""Entry of each format by its word, in the order in which formats are listed."""


def suffixes() -> dict[str, str]:
    """Name of the format by file suffix, each format's own suffix before the alternative ones."""
    pairs = [(suffix, record.name) for record in FORMATS.values() for suffix in record.suffixes[:1]]
    pairs += [(suffix, record.name) for record in FORMATS.values() for suffix in record.suffixes[1:]]
    return dict(pairs)


def format_of(path: Path) -> Format:
    """Find a file's format by its suffix; raises ValueError for a suffix of no format."""
    known = suffixes()
    name = known.get(path.suffix.lower())
    if name is None:
        raise ValueError(f"{path.name}: none of {', '.join(known)}")
    return FORMATS[name]


def oversize(path: Path, name: str) -> str:
    """Text that a file is larger than files of the format `name` may be; empty where it is not.

    Raises OSError where the file is missing.
    """
    size, most = path.stat().st_size, FORMATS[name].most
    return "" if size <= most else f"{size / 1e6:.4g} MB, and of a {name} up to {most / 1e6:.4g} MB are read"


def contents(path: Path, name: str) -> bytes:
    """The bytes of a file of the format `name`.

    Raises ReadError for a file that is too large, OSError where it cannot be read.
    """
    if problem := oversize(path, name):
        raise ReadError("range", problem, path)
    return path.read_bytes()
