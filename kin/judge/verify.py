"""The verdict on a file: whether it is the intended part, and its followers move as intended.

The file is taken as it lies on disk. The way it was made is not known here: the exact contour comes from the
intended motion alone (`kin.follower.envelope`), the motion from contact with the file's own contour
(`kin.follower.follower`).
"""

from __future__ import annotations

from contextlib import suppress
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kin.contour.nearest import signed_distance
from kin.judge.bore import bore_check
from kin.judge.contour_checks import judge_contour
from kin.judge.surfaces import SIZED, SortedChains, deepest, sort_chains
from kin.judge.verdict import ClosureVerdict, SurfaceVerdict, Verdict
from kin.numeric.angles import TURN
from kin.numeric.check import Check, about, as_drawn, less_sure
from kin.numeric.lengths import UNIT, length_words, marked, shown
from kin.read.bodies import Sought
from kin.read.checks import (
    NOT_CLOSED,
    closed_check,
    count_check,
    crossing_places,
    demand_same,
    thickness_check,
    units_check,
    unread_check,
)
from kin.read.errors import ReadError
from kin.read.files import read_bodies, read_drawing, read_solid
from kin.read.formats import FORMATS, format_of
from kin.read.nesting import ClosedContour, scaled
from kin.read.point_list import is_point_list

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from pathlib import Path

    from kin.contour.contour import Contour
    from kin.judge.intent import Limits, PartIntent, ShaftIntent
    from kin.read.drawing.drawing import Drawing
    from kin.read.formats import AnySolid, Contents, Format

SHAFT = (0.0, 0.0)


def verify(path: Path, part: PartIntent, angles: int, limits: Limits, units: float | None = None) -> Verdict:
    """Judge a drawing, solid, program, a machine's table or a list of points, at `angles` equal steps of the shaft.

    The unit that a file states counts; `units`, mm, is the unit of a file that states none. A file from which no
    contour can be read gets a verdict that says why. Raises OSError where the disk refuses, UnitsError where the file
    states another unit than `units`, and ValueError for another suffix or no angles.
    """
    kind = format_of(path)
    if kind.contents == "table":
        from kin.judge.drive import follower_checks  # which has no contour
        from kin.read.drive_tables import is_drive

        if is_drive(path):
            checks = follower_checks(path, part.surfaces[0].gauge, limits, 1.0 if units is None else units)
            return Verdict(kind.name, tuple(about(check, path.name) for check in checks))
        if is_point_list(path):
            return verify_points(path, part, angles, limits, 1.0 if units is None else units)
    read = READERS[kind.contents]
    return _verdict(path, lambda: [(part, read(path, part, limits, units))], angles, limits)


def verify_points(path: Path, part: PartIntent, angles: int, limits: Limits, mm: float) -> Verdict:
    """Judge a list of points of a part's one surface, `mm` to a unit, by the spline that CAD systems put through it.

    `angles` are equal steps of the shaft. A list that cannot be read, or of a part with several surfaces, gets a
    verdict that says why. Raises OSError where the disk refuses, ValueError for no angles.
    """

    def read() -> list[tuple[PartIntent, _Read]]:
        from kin.read.point_list import spline_of_points

        if len(part.surfaces) > 1:
            raise ReadError("unsupported", f"a list of points has one contour, the part {len(part.surfaces)}", path)
        contour, count = spline_of_points(path, mm)
        chains = scaled((ClosedContour(contour, pieces=count),), 1.0, mirrored=part.mirrored)
        return [(part, _Read([], tuple(chains), chains, mm))]

    return _verdict(path, read, angles, limits, FORMATS["csv"])


def verify_together(path: Path, shaft: ShaftIntent, angles: int, limits: Limits) -> Verdict:
    """Judge a 3MF or STEP that holds all discs of a shaft, each in its place, at `angles` equal steps of the shaft.

    A file from which they cannot be read gets a verdict that says why. Raises OSError where the disk refuses,
    ValueError for another suffix or no angles.
    """
    return _verdict(path, lambda: _of_solids(path, shaft, limits), angles, limits)


def _verdict(
    path: Path,
    read: Callable[[], list[tuple[PartIntent, _Read]]],
    angles: int,
    limits: Limits,
    kind: Format | None = None,
) -> Verdict:
    """Judge the surfaces of every part that is read from a file, and the play between surfaces of one part.

    The file's format is `kind`, or follows from its suffix.
    """
    kind = kind or format_of(path)
    if angles < 1:
        raise ValueError(f"a file is judged at one shaft angle at least, not {angles}")
    phi = TURN / angles * np.arange(angles, dtype=np.float64)
    try:
        files = read()
    except ReadError as error:
        return Verdict(kind.name, (about(unread_check(kind.contents, error), path.name),))
    checks, surfaces, closures = list[Check](), list[SurfaceVerdict](), list[ClosureVerdict]()
    for part, file in files:
        part_checks = list(file.checks)
        standing = part.milling.standing if part.milling is not None else 0.0
        for chain, surface in zip(file.surfaces, part.surfaces, strict=True):
            verdict, more = judge_contour(
                chain, surface, phi, limits, file.uneven, standing=standing, linkage=part.linkage
            )
            part_checks += [replace(check, surface=surface.name) for check in more]
            surfaces.append(verdict)
            if file.stated_error is not None and verdict.measured_error is not None:
                from kin.judge.grinding import stated_check  # tables alone state it

                part_checks.append(
                    stated_check(verdict.measured_error - file.uneven, file.stated_error, limits.tolerance)
                )
        if part.closures:
            from kin.judge.closure import judge_closures  # most cams have one surface

            pairs = [(surface, chain.contour) for chain, surface in zip(file.surfaces, part.surfaces, strict=True)]
            left, more = judge_closures(pairs, part.closures, limits, file.uneven)
            closures += left
            part_checks += more
        checks += [as_drawn(check, mirrored=part.mirrored) for check in part_checks]
    named = tuple(about(check, path.name) for check in checks)
    bodies = tuple(tuple(chain.contour for chain in file.chains) for _, file in files)
    units, uneven = files[0][1].units, max(file.uneven for _, file in files)
    passed = tuple(words for _, file in files for words in file.passed)
    return Verdict(kind.name, named, tuple(surfaces), tuple(closures), units, bodies, uneven, passed)


class _Read(NamedTuple):
    """Checks on the contents of a file, its surfaces and all chains in mm as if not mirrored, and mm in its unit.

    `uneven`: difference of a solid's other sections from these, mm, by rounding alone; of a drawing the widest gap that
    was joined, of a table the error of its arcs.
    `stated_error`: greatest distance from the exact contour, mm, as the file itself states it.
    `passed`: what was left out of a drawing as no part of the cam, in words.
    """

    checks: list[Check]
    surfaces: tuple[ClosedContour, ...]
    chains: Sequence[ClosedContour]
    units: float
    uneven: float = 0.0
    stated_error: float | None = None
    passed: tuple[str, ...] = ()


def _of_drawing(path: Path, part: PartIntent, limits: Limits, units: float | None) -> _Read:
    """Read a DXF or SVG: the checks on what is drawn, and its surfaces."""
    engraved = any(hole.depth is not None for hole in part.holes)
    unstated, within = part.mm if units is None else units, limits.tolerance
    read = partial(
        read_drawing, path, limits.gap, engraved=engraved, deepest=deepest(part), bridged=within, unstated=unstated
    )
    try:
        drawing = read(shaft=None if part.closed else SHAFT)
    except ReadError as error:
        if part.closed and error.reason in NOT_CLOSED and error.closing is None and _is_read(read):
            error.message += "; verify: {openings: ignore} passes over what is no part of the cam"
        raise
    demand_same(drawing.units_mm, units, path)
    scale = unstated if drawing.units_mm is None else 1.0
    chains = scaled(drawing.chains, scale, mirrored=part.mirrored)
    parts = sort_chains(chains[0], chains[1:], part, limits.tolerance, path)
    joined = max(chain.gap for chain in parts.surfaces)
    uneven = joined if limits.gap is None else max(joined, limits.gap)
    unit = units_check(drawing.units_mm, units, part.mm, partial(_size, part, parts))
    checks = [unit, closed_check(drawing, scale, _contours(parts), limits.gap, uneven)]
    marks = scaled([ClosedContour(contour) for contour in drawing.engraved], scale, mirrored=part.mirrored)
    checks += [*parts.checks, *_opening_checks(parts.holes, [mark.contour for mark in marks], part, limits)]
    return _Read(
        checks,
        parts.surfaces,
        chains,
        scale if drawing.units_mm is None else drawing.units_mm,
        uneven,
        passed=drawing.passed,
    )


def _is_read(read: Callable[..., Drawing]) -> bool:
    """Whether a drawing gives a cam without what is no part of it."""
    with suppress(ReadError):
        return bool(read(shaft=SHAFT).passed)
    return False


def _of_program(path: Path, part: PartIntent, limits: Limits, units: float | None) -> _Read:
    """Read a program: the checks on it and on what it mills, and the surfaces that it leaves."""
    from kin.judge.milling import milled
    from kin.read.gcode import read_gcode

    if part.milling is None:
        raise ReadError("unsupported", "how the part is milled is not given", path)
    program = read_gcode(path)
    demand_same(program.units_mm, units, path)
    done = milled(program, part.milling, limits.tolerance)
    chains = scaled(done.chains, 1.0, mirrored=part.mirrored)
    outline, others = (chains[0], chains[1:]) if part.milling.outline else (None, chains)
    parts = sort_chains(outline, others, part, limits.tolerance, path)
    unit = units_check(program.units_mm, units, part.mm, partial(_size, part, parts))
    checks = [unit, count_check("closed", crossing_places(_contours(parts)))]
    checks += [*done.checks, *_opening_checks(parts.holes, [], part, limits)]
    return _Read(checks, parts.surfaces, chains, program.units_mm)


def _of_table(path: Path, part: PartIntent, limits: Limits, units: float | None) -> _Read:
    """Read a grinder's table, and the surface that its wheel leaves."""
    from kin.judge.grinding import ground, normals_check

    if part.grinding is None or len(part.surfaces) > 1:
        raise ReadError("unsupported", "of a CSV the table that grinds a cam of one surface is judged", path)
    table = ground(path, part.grinding, limits.tolerance)
    demand_same(table.units, units, path)
    chains = scaled((table.chain,), 1.0, mirrored=part.mirrored)
    checks = [count_check("head", list(table.faults))]
    normals = normals_check(table, part.surfaces[0].gauge.envelope, limits.tolerance, mirrored=part.mirrored)
    checks += [] if normals is None else [normals]
    return _Read(checks, tuple(chains), chains, table.units, table.off, table.error)


def _opening_checks(
    holes: Sequence[Contour], engraved: Sequence[Contour], part: PartIntent, limits: Limits
) -> list[Check]:
    """Check what is drawn or milled inside the contour."""
    if part.featured:
        from kin.judge.part_checks import drawn_checks  # a plain part does without

        return drawn_checks(holes, engraved, part, limits.tolerance)
    bore = bore_check(holes, part.bore, limits.tolerance, closed=part.closed)
    return [bore] if bore else []


def _size(part: PartIntent, parts: SortedChains) -> float:
    """Size of the first surface over that of the exact one."""
    exact = part.surfaces[0].gauge.envelope.points(SIZED)
    return float(np.abs(parts.surfaces[0].contour.vertices).max() / np.abs(exact).max())


def _contours(parts: SortedChains) -> list[Contour]:
    return [chain.contour for chain in parts.surfaces]


def _of_solid(path: Path, part: PartIntent, limits: Limits, units: float | None) -> _Read:
    """Read a solid of one part: the checks on it, and its surfaces, each in the section that it is found in."""
    sought = _sought(part)
    solid = read_solid(path, sought.heights, units, sought.deepest)
    demand_same(solid.units_mm, units, path)
    return _solid_read(solid, part, limits, path, units)


def _of_solids(path: Path, shaft: ShaftIntent, limits: Limits) -> list[tuple[PartIntent, _Read]]:
    """Read the solids of all parts of a shaft from one file; each one's checks carry its name."""
    solids = read_bodies(path, [_sought(part) for part in shaft.parts], shaft.levels)
    parts = []
    for solid, part, level in zip(solids, shaft.parts, shaft.levels, strict=True):
        way = f"{length_words(abs(solid.z_min))} {UNIT} {'lower' if solid.z_min < 0.0 else 'higher'}"
        moved = f"{part.name} lies {way} than it should" if abs(solid.z_min) > limits.tolerance else ""
        try:
            file = _solid_read(solid, part, limits, path, None)
        except ReadError as error:
            raise ReadError(error.reason, "; ".join(filter(None, [error.message, shown(moved)])), path) from None
        above = (
            f"heights are counted from z = {length_words(level, '.9g')} {UNIT}, where {part.name} belongs"
            if level
            else ""
        )
        above = "; ".join(filter(None, [above, moved]))
        checks = [
            replace(check, surface=part.name, detail=_joined(marked(check.detail), above)) for check in file.checks
        ]
        parts.append((part, file._replace(checks=checks)))
    return parts


def _joined(detail: str, more: str) -> str:
    return f"{detail}; {more}" if more and ("z = " in detail or detail.startswith("z ")) else detail


def _sought(part: PartIntent) -> Sought:
    """Sections sought of a part's solid: at its layers, the plain disc's first, and at its surfaces."""
    levels: list[float] = []
    if part.layers:
        from kin.judge.part_checks import levels_of

        levels = levels_of(part)
    return Sought([*levels, *(surface.z for surface in part.surfaces if surface.z is not None)], deepest(part))


def _solid_read(solid: AnySolid, part: PartIntent, limits: Limits, path: Path, units: float | None) -> _Read:
    if len(solid.sections) < len(_sought(part).heights):
        raise ReadError("height", "the solid has no section where the part has its layers", path)
    if part.layers:
        from kin.read.layers import leans, settled

        solid = settled(solid, leans(part.layers, part.cross_holes), limits.tolerance)
    parts = _found(solid, part, limits.tolerance, path)
    checks = [_watertight_check(solid, parts), *(less_sure(check, solid.uneven) for check in parts.checks)]
    contours = [chain.contour for chain in parts.surfaces]
    if part.layers:
        from kin.judge.part_checks import solid_checks
        from kin.judge.volume import layers_volume_check

        checks += solid_checks(solid, _layered(solid, part, limits, path), part, limits.tolerance)
        checks.append(layers_volume_check(solid.volume, contours, part, limits.tolerance))
    else:
        bore = bore_check(parts.holes, part.bore, limits.tolerance, closed=part.closed)
        checks += [] if bore is None else [less_sure(bore, solid.uneven)]
        if part.thickness is not None:
            from kin.judge.volume import volume_check

            checks.append(thickness_check(solid, part.thickness, limits.tolerance))
            checks.append(volume_check(solid.volume, solid.thickness, contours, part, limits.tolerance))
    chains = scaled(solid.chains, 1.0, mirrored=part.mirrored)
    return _Read(checks, parts.surfaces, chains, solid.units_mm or units or 1.0, _uneven(solid, part, contours))


def _uneven(solid: AnySolid, part: PartIntent, contours: Sequence[Contour]) -> float:
    """Difference of a part's contours from section to section, mm, without the effect of rounding on hub and bore."""
    layers = [layer for layer in part.layers if layer.outline is None]
    if not solid.uneven or not layers or any(surface.z is not None for surface in part.surfaces):
        return solid.uneven
    axis = np.zeros((1, 2))
    inner = min(abs(float(signed_distance(contour.as_arcs()[0], axis)[0])) for contour in contours)
    low, high = min(layer.low for layer in layers), max(layer.high for layer in layers)
    return solid.uneven_between(low, high, inner - solid.uneven)


def _found(solid: AnySolid, part: PartIntent, tolerance: float, path: Path) -> SortedChains:
    """Sort the chains of the plain disc's section, and of the sections at the heights of surfaces."""
    by_height = {}
    for z in dict.fromkeys(surface.z for surface in part.surfaces):
        chains = solid.chains if z is None else solid.section(z).chains
        outline, *others = scaled(chains, 1.0, mirrored=part.mirrored)
        by_height[z] = sort_chains(outline, others, part, tolerance, path, z=z)
    remaining = {z: iter(section.surfaces) for z, section in by_height.items()}
    surfaces = tuple(next(remaining[surface.z]) for surface in part.surfaces)
    return by_height[part.surfaces[0].z]._replace(surfaces=surfaces)


def _layered(solid: AnySolid, part: PartIntent, limits: Limits, path: Path) -> list[SortedChains]:
    """Sort the chains of a solid's sections in layers; the outline is the surface of a layer with one of its own."""
    from kin.read.layers import heights

    parts = []
    for (_, layer), section in zip(heights(part.layers, part.cross_holes), solid.sections, strict=False):
        outline, *others = scaled(section.chains, 1.0, mirrored=part.mirrored)
        if layer.outline is None:
            parts.append(sort_chains(outline, others, part, limits.tolerance, path))
        else:
            parts.append(SortedChains((outline,), tuple(chain.contour for chain in others), ()))
    return parts


def _watertight_check(solid: AnySolid, parts: SortedChains) -> Check:
    """Check that each edge has two faces, one either way, that they face outward, and no surface crosses itself."""
    return count_check("watertight", [*solid.faults, *crossing_places(_contours(parts))])


READERS: dict[Contents, Callable[[Path, PartIntent, Limits, float | None], _Read]] = {
    "drawing": _of_drawing,
    "solid": _of_solid,
    "program": _of_program,
    "table": _of_table,
}
"""What reads a file of one part, by its contents."""
