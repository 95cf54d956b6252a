"""Drawings and solids of a part, of any origin, read by the suffix of their file."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from kin.read.bodies import demand_reached
from kin.read.errors import ReadError
from kin.read.formats import FORMATS, DrawingOptions, format_of

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kin.contour.across import Across
    from kin.read.bodies import Placed, SeparateBody, Sought
    from kin.read.drawing.drawing import Drawing
    from kin.read.formats import AnySolid
    from kin.read.mesh.checked import CheckedMesh


def kind_of(path: Path | str) -> str:
    """Name of a file's format, by its suffix; raises ValueError for an unknown suffix."""
    return format_of(Path(path)).name


def read_drawing(
    path: Path | str,
    gap: float | None = None,
    *,
    engraved: bool = False,
    deepest: int = 1,
    bridged: float = 0.0,
    unstated: float = 1.0,
    shaft: tuple[float, float] | None = None,
    across: Across | None = None,
) -> Drawing:
    """Read the contour and the holes that a drawing gives to cut.

    Ends within `gap`, mm, are joined; by default those that are as near as the digits of the file explain, or 1e-7 of
    the drawing's size. With `engraved` the closed chains on the layer ENGRAVE are read too, if there is something on
    CUT. A closed chain may lie inside `deepest` others. Gaps up to `bridged`, mm, and open chains within the contour
    are reported in `openings`; without `bridged` they raise. Where the whole is not one contour with others in it, the
    contours round `shaft`, mm, are read if it is given, and what is left out is told in `passed`; `across` closes a
    contour that is open in one place, which `bridge` tells. For a drawing that states no unit, `gap`, `bridged` and
    `shaft` take its unit to be `unstated` mm.

    Raises OSError where the file cannot be read; ReadError for a damaged or too large file, and for what is not one
    closed contour with holes; ValueError for a suffix that is no drawing's.
    """
    path = Path(path)
    read = format_of(path).drawing
    if read is None:
        raise ValueError(f"{path.name} is no drawing")
    return read(path, DrawingOptions(gap, engraved, deepest, bridged, unstated, shaft, across))


def read_solid(
    path: Path | str, heights: Sequence[float] = (), units: float | None = None, deepest: int = 1
) -> AnySolid:
    """Read a solid with its sections at `heights`, mm, the first of which gives its contour.

    In a section a closed chain may lie inside `deepest` others. `units`, mm, is the unit of a file that states none;
    None is mm.

    Raises OSError where the file cannot be read; ReadError for a damaged or too large file, a height beyond the part,
    and a section that is not one closed contour with others in it; ValueError for a suffix that is no solid's.
    """
    path = Path(path)
    record = format_of(path)
    if record.solid is None:
        raise ValueError(f"{path.name} is no solid")
    if record.units:
        return record.solid(path, heights, deepest)
    mm = units or 1.0
    own = heights if mm == 1.0 else [z / mm for z in heights]
    try:
        solid = record.solid(path, own, deepest)
    except ReadError as error:
        if error.reason != "height":
            raise
        # words of the heights in mm, by the part's own, which is read without them
        solid = record.solid(path, (), deepest)
        unit = f"it states no unit and is read in one of {mm:.9g} mm, another is given by --units"
        demand_reached(mm * solid.z_min, mm * solid.z_max, heights, path, unit)
        raise
    return solid if mm == 1.0 else solid.in_units(heights, mm)


def separate_bodies(path: Path | str) -> list[SeparateBody]:
    """List the bodies of a solid's file, each to be read by itself, in the file's order.

    Raises OSError where the file cannot be read; ReadError for a file that is too large or damaged; ValueError for a
    suffix that is no solid's.
    """
    path = Path(path)
    separate = format_of(path).separate
    if separate is None:
        raise ValueError(f"{path.name} is no solid")
    return list(separate(path))


def read_meshes(path: Path | str, units: float | None = None) -> list[Placed]:
    """Read the triangles of each body, mm; `units`, mm, is the unit of a file that states none, None is mm.

    Raises OSError where the file cannot be read; ReadError for a file that is too large, damaged or none of its format;
    ValueError for a suffix of files without meshes.
    """
    path = Path(path)
    record = format_of(path)
    if record.meshes is None:
        raise ValueError(f"{path.name} holds no mesh")
    scale = 1.0 if record.units or units is None else units
    return [placed._replace(corners=placed.corners * scale) for placed in record.meshes(path)]


def read_mesh(path: Path | str, units: float | None = None) -> CheckedMesh:
    """Read the mesh of one part of any shape, mm, welded and checked; `faults` says in words what is wrong with it.

    `units`, mm, is the unit of a file that states none; None is mm. A 3MF holds one object that is built, or one of
    several that is named "cam".

    Raises OSError where the file cannot be read; ReadError for a file that is too large, damaged or none of its format,
    a flat part, and several bodies; ValueError for a suffix of files without meshes.
    """
    from kin.read.mesh.checked import checked

    path = Path(path)
    record = format_of(path)
    if record.part is None:
        raise ValueError(f"{path.name} holds no mesh")
    return checked(record.part(path), path, 1.0 if record.units or units is None else units)


def read_bodies(path: Path | str, sought: Sequence[Sought], levels: Sequence[float]) -> list[AnySolid]:
    """Read several solids from one file, the lowest first.

    `sought` and `levels`, mm, have an entry for each solid, from the lowest up. The heights sought of a solid, and all
    heights of what is returned, are mm above its level.

    Raises OSError where the file cannot be read; ReadError for a format that does not hold several solids, a damaged or
    too large file, more or fewer solids, and a section that is not one closed contour with others in it; ValueError for
    an unknown suffix, or not as many levels as solids.
    """
    path = Path(path)
    read = format_of(path).bodies
    if read is None:
        several = " or ".join(name.upper() for name, record in FORMATS.items() if record.bodies is not None)
        message = f"a {several} holds {len(sought)} discs, any other file one of them: judge these"
        raise ReadError("unsupported", message, path)
    above = list(zip(sought, levels, strict=True))
    shifted = [wanted._replace(heights=[level + z for z in wanted.heights]) for wanted, level in above]
    solids = read(path, shifted)
    return [solid.lowered(wanted.heights, level) for solid, (wanted, level) in zip(solids, above, strict=True)]
