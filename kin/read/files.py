"""Contours read back from files, told apart by their suffix: drawings, DXF or SVG of any origin; solids of a part."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Literal, TypeAlias, get_args

from kin.read.errors import ReadError

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kin.read.bodies import Sought
    from kin.read.drawing.drawing import Drawing
    from kin.read.mesh.stl import Solid
    from kin.read.step.step import StepSolid

Kind: TypeAlias = Literal["dxf", "svg", "stl", "3mf", "step", "gcode", "csv"]
KINDS: tuple[Kind, ...] = get_args(Kind)
DRAWINGS = frozenset({"dxf", "svg"})
SOLIDS = frozenset({"stl", "3mf", "step"})
OTHERS: dict[str, Kind] = {".stp": "step", ".ngc": "gcode", ".nc": "gcode", ".tap": "gcode"}
"""Suffixes that are not the kind's own."""
SUFFIXES: dict[str, Kind] = {f".{kind}": kind for kind in KINDS} | OTHERS
"""Every suffix, and the kind of file that it means."""
AnySolid: TypeAlias = "Solid | StepSolid"


def kind_of(path: Path | str) -> Kind:
    """Tell a file's kind by its suffix; raises ValueError for one that is none of KINDS."""
    path = Path(path)
    found = SUFFIXES.get(path.suffix.lower())
    if found is None:
        raise ValueError(f"{path.name}: none of {', '.join(SUFFIXES)}")
    return found


def read_drawing(
    path: Path | str,
    gap: float | None = None,
    *,
    engraved: bool = False,
    deepest: int = 1,
    bridged: float = 0.0,
    unstated: float = 1.0,
) -> Drawing:
    """Read a DXF or SVG; raises as `read_dxf` does."""
    if kind_of(path) == "svg":
        from kin.read.drawing.svg import read_svg

        return read_svg(path, gap, engraved=engraved, deepest=deepest, bridged=bridged, unstated=unstated)
    from kin.read.drawing.dxf import read_dxf

    return read_dxf(path, gap, engraved=engraved, deepest=deepest, bridged=bridged, unstated=unstated)


def read_solid(
    path: Path | str, heights: Sequence[float] = (), units: float | None = None, deepest: int = 1
) -> AnySolid:
    """Read an STL, 3MF or STEP; raises as `read_stl`, `read_3mf` and `read_step` do.

    `units`, mm, is that of an STL, which states none and is read in mm without.
    """
    if kind_of(path) == "step":
        from kin.read.step.step import read_step

        return read_step(path, heights, deepest)
    if kind_of(path) == "3mf":
        from kin.read.mesh.threemf import read_3mf

        return read_3mf(path, heights, deepest)
    from kin.read.mesh.stl import Section, read_stl
    from kin.read.nesting import scaled

    if units is None or units == 1.0:
        return read_stl(path, heights, deepest)
    found = read_stl(path, [z / units for z in heights], deepest)
    sections = zip(heights, found.sections, strict=False)
    return replace(
        found,
        chains=scaled(found.chains, units),
        z_min=units * found.z_min,
        z_max=units * found.z_max,
        height=units * found.height,
        volume=units**3 * found.volume,
        sections=tuple(Section(scaled(one.chains, units), z) for z, one in sections),
        faces=tuple(units * z for z in found.faces),
        leaning=found.leaning * [units, units, units, 1.0],
        slivers=units * found.slivers,
        rounding=units * found.rounding,
    )


def read_bodies(path: Path | str, sought: Sequence[Sought], levels: Sequence[float]) -> list[AnySolid]:
    """Read several solids from one 3MF or STEP, the lowest first; raises as `read_3mf` and `read_step` do.

    Heights are those above each one's own level, mm, and so they are in what is returned. ReadError for a file of
    another kind, which does not hold several.
    """
    if kind_of(path) not in {"step", "3mf"}:
        message = f"a 3MF or STEP holds {len(sought)} discs, a drawing, an STL or a program one of them: judge these"
        raise ReadError("unsupported", message, Path(path))
    above = list(zip(sought, levels, strict=True))
    shifted = [one._replace(heights=[level + z for z in one.heights]) for one, level in above]
    found: list[AnySolid] = []
    if kind_of(path) == "step":
        from kin.read.step.step import read_step_bodies

        found += read_step_bodies(path, shifted)
    else:
        from kin.read.mesh.threemf import read_3mf_bodies

        found += read_3mf_bodies(path, shifted)
    return [_lowered(solid, one.heights, level) for solid, (one, level) in zip(found, above, strict=True)]


def _lowered(solid: AnySolid, heights: Sequence[float], level: float) -> AnySolid:
    """The solid with its heights counted from a level, mm; those of its sections as they were asked for."""
    from kin.read.mesh.stl import Section

    return replace(
        solid,
        z_min=solid.z_min - level,
        z_max=solid.z_max - level,
        height=solid.height - level,
        sections=tuple(Section(one.chains, z) for z, one in zip(heights, solid.sections, strict=False)),
        faces=tuple(z - level for z in solid.faces),
        leaning=solid.leaning - [level, level, 0.0, 0.0],
        slivers=solid.slivers - [level, level, 0.0, 0.0],
    )
