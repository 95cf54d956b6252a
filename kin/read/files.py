"""Contours read back from files, told apart by their suffix: drawings and solids of a part, whoever wrote them."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from kin.read.errors import ReadError
from kin.read.formats import FORMATS, DrawingOptions, format_of

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kin.read.bodies import Placed, Sought
    from kin.read.drawing.drawing import Drawing
    from kin.read.formats import AnySolid


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
) -> Drawing:
    """Read the contour and the holes that a drawing gives to cut.

    Ends within `gap`, mm, are joined; None is 1e-6 mm, or 2e-8 of a drawing below 50 mm. With `engraved` what is to be
    engraved is read too. A closed chain may lie inside `deepest` others. Gaps up to `bridged`, mm, are reported and do
    not raise. `unstated`, mm, is the unit in which `gap` and `bridged` are meant for a drawing that states none.

    Raises OSError as the file system does; ReadError for a damaged file, and for what is not one closed contour with
    holes; ValueError for a suffix that is no drawing's.
    """
    path = Path(path)
    read = format_of(path).drawing
    if read is None:
        raise ValueError(f"{path.name} is no drawing")
    return read(path, DrawingOptions(gap, engraved, deepest, bridged, unstated))


def read_solid(
    path: Path | str, heights: Sequence[float] = (), units: float | None = None, deepest: int = 1
) -> AnySolid:
    """Read a solid with its sections at `heights`, mm, in which a closed chain may lie inside `deepest` others.

    `units`, mm, is the unit of a file that states none; without it such a file is read in mm.

    Raises OSError as the file system does; ReadError for a damaged file, and where a section is not one closed contour
    with others in it; ValueError for a suffix that is no solid's.
    """
    path = Path(path)
    record = format_of(path)
    if record.solid is None:
        raise ValueError(f"{path.name} is no solid")
    if record.units or units is None or units == 1.0:
        return record.solid(path, heights, deepest)
    return record.solid(path, [z / units for z in heights], deepest).in_units(heights, units)


def read_meshes(path: Path | str, units: float | None = None) -> list[Placed]:
    """Read the triangles of each body, mm; `units`, mm, is the unit of a file that states none.

    Raises OSError as the file system does; ReadError for a file that is too large, damaged or none of its format;
    ValueError for a suffix of files without meshes.
    """
    path = Path(path)
    record = format_of(path)
    if record.meshes is None:
        raise ValueError(f"{path.name} holds no mesh")
    scale = 1.0 if record.units or units is None else units
    return [placed._replace(corners=placed.corners * scale) for placed in record.meshes(path)]


def read_bodies(path: Path | str, sought: Sequence[Sought], levels: Sequence[float]) -> list[AnySolid]:
    """Read several solids from one file, the lowest first.

    Heights are those above each one's own level, mm, and so they are in what is returned.

    Raises OSError as the file system does; ReadError for a format that does not hold several, a damaged file, more or
    fewer solids, and a section that is not one closed contour with others in it; ValueError for an unknown suffix.
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
