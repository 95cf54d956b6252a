"""The verdict on a file: whether it is the cam that was asked for, and its follower moves as intended.

The file is taken as it lies on disk. Nothing of the way it was made is known here: the exact contour comes from the
intended motion alone (`kin.follower.envelope`), the motion from contact with the file's own contour
(`kin.follower.follower`).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kin.contour.intersections import crossings
from kin.judge.check import Check, about, at_most, failed, less_sure
from kin.judge.contour_checks import ROUNDING, DwellAsked, Intent, Limits, bore_check, judge_contour, volume_check
from kin.judge.ring import Faced, faced
from kin.numeric.angles import TURN
from kin.numeric.errors import KinError
from kin.numeric.places import place_text
from kin.read.errors import ReadError
from kin.read.files import SOLIDS, kind_of, read_drawing, read_solid

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from kin.contour.contour import Contour
    from kin.follower.frame import LinkageVerdict
    from kin.follower.motion_error import MotionError, Play
    from kin.read.drawing.drawing import Drawing
    from kin.read.files import AnySolid, Kind
    from kin.read.mesh.stl import Section

__all__ = ["DwellAsked", "Intent", "Limits", "UnitsError", "Verdict", "verify"]

UNITS_SHARE = 1e-9  # two statements of the unit agree within this share
SIZE_SHARE = (
    0.05  # a drawing that comes out by another unit's factor too large or small, within this, misstates its own
)
SIZED = np.linspace(0.0, TURN, 64)  # parameters at which the exact contour's size is looked at
NOT_CLOSED = frozenset({"open", "gap", "branch", "several", "island"})
NOT_READ = frozenset({"syntax", "truncated", "empty", "unsupported", "range"})  # of solids
MOST_NAMED = 5  # faults named in a message
OTHERS = (
    ("inches", 25.4),
    ("centimetres", 10.0),
    ("metres", 1000.0),
)  # what an STL, which has no unit, may be drawn in


@dataclass(frozen=True)
class Verdict:
    """What was found of a file.

    kind            of the file: drawing, solid or program
    checks          units, closed, contour, motion, bore, ... ; or the one that says why the file cannot be read
    motion, play    as the contour gives them by contact; None without contact, play also for one-sided followers
    measured_error  two-sided distance from the exact contour, mm
    pieces          of the outer contour, as the file counts them
    linkage         what the contour makes of the mechanism; None without one, or where it does not drive it all round
    perimeter, area of the outer contour as read, mm and mm^2
    units           mm in a unit of the file as it was read: as the file states, or else as it was given or meant
    contour         that the follower touches, as read, in mm and as if not mirrored
    """

    kind: Kind
    checks: tuple[Check, ...]
    motion: MotionError | None = None
    play: Play | None = None
    measured_error: float | None = None
    pieces: int | None = None
    linkage: LinkageVerdict | None = None
    perimeter: float | None = None
    area: float | None = None
    units: float | None = None
    contour: Contour | None = None

    @property
    def ok(self) -> bool:
        """Whether every check holds."""
        return all(check.ok for check in self.checks)


class UnitsError(KinError, ValueError):
    """A unit was given for a file that states another one itself."""


def verify(path: Path, intent: Intent, angles: int, limits: Limits, units: float | None = None) -> Verdict:
    """Judge a drawing, a solid or a milling program, told apart by the suffix, at `angles` equal steps of the shaft.

    What a file states as its unit counts; `units`, mm, is that of one that states none. A file from which no contour
    can be read gets a verdict that says why. Raises OSError as the file system does, UnitsError where the file states
    another unit than `units`, and ValueError for another suffix or no angles.
    """
    kind = kind_of(path)
    if angles < 1:
        raise ValueError(f"a file is judged at one shaft angle at least, not {angles}")
    phi = TURN / angles * np.arange(angles, dtype=np.float64)
    try:
        read = _of_program if kind == "gcode" else _of_solid if kind in SOLIDS else _of_drawing
        one = read(path, intent, limits, units)
    except ReadError as error:
        if kind in SOLIDS:
            unread = "readable" if error.reason in NOT_READ else "watertight"
        else:
            unread = "closed" if error.reason in NOT_CLOSED else "readable"
        return Verdict(kind, (about(failed(unread, error.message), path.name),))
    found = judge_contour(one.contour, intent, phi, limits, one.uneven)
    return Verdict(
        kind=kind,
        checks=tuple(about(check, path.name) for check in (*one.checks, *found.checks)),
        motion=found.judged and found.judged.motion,
        play=found.judged and found.judged.play,
        measured_error=found.deviation.worst[0] if found.deviation else None,
        pieces=one.pieces,
        linkage=found.linkage,
        perimeter=one.contour.length,
        area=abs(one.contour.area),
        units=one.units,
        contour=one.contour,
    )


class _Read(NamedTuple):
    """The checks on what a file holds, its contour in mm as if not mirrored, the number of its pieces, mm in its unit.

    `uneven`: by how much a solid's other sections differ from that contour, mm, where only rounding is behind it.
    """

    checks: list[Check]
    contour: Contour
    pieces: int
    units: float
    uneven: float = 0.0


def _demand_same(stated: float | None, given: float | None, path: Path) -> None:
    """Refuse a unit that is given beside another one that the file states."""
    if stated is not None and given is not None and not abs(stated / given - 1.0) <= UNITS_SHARE:
        told = f"{path}: the file states its unit, {stated:.9g} mm; {given:.9g} mm is given for it"
        raise UnitsError(f"{told}, which is for files that state none")


def _of_drawing(path: Path, intent: Intent, limits: Limits, units: float | None) -> _Read:
    """Read a DXF or SVG: the checks on what is drawn, contour in mm as if not mirrored, number of its pieces."""
    drawing = read_drawing(path, engraved=any(hole.depth is not None for hole in intent.holes))
    _demand_same(drawing.units_mm, units, path)
    scale = (intent.mm if units is None else units) if drawing.units_mm is None else 1.0
    outline, *holes = (_placed(c, scale, intent.mirrored) for c in (drawing.contour, *drawing.holes))
    found = faced(outline, holes, intent.outer, limits.tolerance, path)
    checks = [_units_check(drawing.units_mm, units, intent, found.contour), _closed_check(drawing, found.contour)]
    engraved = [_placed(c, scale, intent.mirrored) for c in drawing.engraved]
    checks += [*found.checks, *_opening_checks(found.holes, engraved, intent, limits)]
    pieces = drawing.pieces if intent.outer is None else len(found.contour)
    return _Read(checks, found.contour, pieces, scale if drawing.units_mm is None else drawing.units_mm)


def _of_program(path: Path, intent: Intent, limits: Limits, units: float | None) -> _Read:
    """Read a program: the checks on it and on what it mills, that contour as if not mirrored, number of its moves."""
    from kin.judge.milling import milled
    from kin.read.gcode import read_gcode

    if intent.milling is None:
        raise ReadError("unsupported", "how the part is milled is not given", path)
    program = read_gcode(path)
    _demand_same(program.units_mm, units, path)
    done = milled(program, intent.milling, limits.tolerance)
    contour, *holes = (_placed(c, 1.0, intent.mirrored) for c in (done.contour, *done.holes))
    checks = [_units_check(program.units_mm, units, intent, contour), _count_check("closed", _crossing_places(contour))]
    checks += [*done.checks, *_opening_checks(holes, [], intent, limits)]
    return _Read(checks, contour, done.pieces, program.units_mm)


def _opening_checks(
    holes: Sequence[Contour], engraved: Sequence[Contour], intent: Intent, limits: Limits
) -> list[Check]:
    """Check what is drawn or milled inside the contour."""
    if intent.featured:
        from kin.judge.part_checks import drawn_checks  # a plain part does without

        return drawn_checks(holes, engraved, intent, limits.tolerance)
    bore = bore_check(holes, intent.bore, limits.tolerance)
    return [bore] if bore else []


def _placed(contour: Contour, scale: float, mirrored: bool) -> Contour:
    contour = contour.scaled(scale) if scale != 1.0 else contour
    return contour.mirrored() if mirrored else contour


def _units_check(stated: float | None, given: float | None, intent: Intent, contour: Contour) -> Check:
    """Check the unit of a drawing or a program: what it states counts, unless its size tells that it is misstated."""
    meant = intent.mm
    if stated is None and given is None:
        told = f"the drawing states no unit and is judged in that of the recipe, {meant:.9g} mm"
        return failed("units", f"{told}; give it by --units, such as --units mm", limit=UNITS_SHARE)
    if stated is None:
        return Check("units", True, 0.0, UNITS_SHARE, "", detail=f"the file states no unit; {given:.9g} mm is given")
    off = abs(stated / meant - 1.0)
    detail = f"a drawing unit is {stated:.9g} mm, {meant:.9g} mm is expected"
    if off > UNITS_SHARE:
        large = float(np.abs(contour.vertices).max() / np.abs(intent.follower.envelope.points(SIZED)).max())
        if abs(large * meant / stated - 1.0) > SIZE_SHARE or abs(large - 1.0) <= SIZE_SHARE:
            return Check("units", True, 0.0, UNITS_SHARE, "", detail=f"a drawing unit is {stated:.9g} mm, as stated")
    return Check("units", off <= UNITS_SHARE, off, UNITS_SHARE, "", detail=detail)


def _closed_check(drawing: Drawing, contour: Contour) -> Check:
    """Check that the contour does not cross itself, and that nothing is drawn twice or without length."""
    faults = [f"{fault.kind} {fault.entity} at {place_text(fault.x, fault.y)}" for fault in drawing.faults]
    faults += _crossing_places(contour)
    return _count_check("closed", faults)


def _crossing_places(contour: Contour) -> list[str]:
    return [f"the contour crosses or touches itself at {place_text(x, y)} mm" for x, y in crossings(contour).point]


def _count_check(name: str, faults: list[str]) -> Check:
    more = f"; and {len(faults) - MOST_NAMED} more" if len(faults) > MOST_NAMED else ""
    return at_most(name, len(faults), 0, "faults", detail="; ".join(faults[:MOST_NAMED]) + more)


def _of_solid(path: Path, intent: Intent, limits: Limits, units: float | None) -> _Read:
    """Read a solid: the checks on the solid, its contour in mm as if not mirrored, and the number of its edges."""
    from kin.read.mesh.stl import Section

    if intent.layers:
        from kin.judge.part_checks import levels, solid_checks

        solid = read_solid(path, levels(intent), units)
        _demand_same(solid.units_mm, units, path)
        if not solid.sections:
            told = "the solid has no section where the part has its layers"
            if solid.units_mm is None:
                told += f"; it states no unit and is read in one of {units or 1.0:.9g} mm, another is given by --units"
            raise ReadError("empty", told, path)
        at = [_faced_section(one, intent, limits.tolerance, path) for one in solid.sections]
        sections = [Section(one.height, f.contour, f.holes) for one, f in zip(solid.sections, at, strict=True)]
        checks = [_watertight_check(solid, at[0].contour), *(less_sure(one, solid.uneven) for one in at[0].checks)]
        checks += solid_checks(solid, sections, intent, limits.tolerance)
        pieces = solid.pieces if intent.outer is None else len(at[0].contour)
        return _Read(checks, at[0].contour, pieces, solid.units_mm or units or 1.0, solid.uneven)
    solid = read_solid(path, (), units)
    _demand_same(solid.units_mm, units, path)
    contour, holes, ring = _faced_section(solid, intent, limits.tolerance, path)
    checks = [_watertight_check(solid, contour), *(less_sure(one, solid.uneven) for one in ring)]
    bore = bore_check(holes, intent.bore, limits.tolerance)
    if bore:
        checks.append(less_sure(bore, solid.uneven))
    if intent.thickness is not None:
        checks.append(_thickness_check(solid, intent.thickness, limits.tolerance))
        checks.append(volume_check(solid.volume, solid.thickness, contour, intent, limits.tolerance))
    pieces = solid.pieces if intent.outer is None else len(contour)
    return _Read(checks, contour, pieces, solid.units_mm or units or 1.0, solid.uneven)


def _faced_section(section: AnySolid | Section, intent: Intent, tolerance: float, path: Path) -> Faced:
    outline, *holes = (_placed(c, 1.0, intent.mirrored) for c in (section.contour, *section.holes))
    return faced(outline, holes, intent.outer, tolerance, path)


def _watertight_check(solid: AnySolid, contour: Contour) -> Check:
    """Check that each edge has two faces that run along it either way, facing outward, and the contour no crossing."""
    return _count_check("watertight", [*solid.faults, *_crossing_places(contour)])


def _thickness_check(solid: AnySolid, thickness: float, tolerance: float) -> Check:
    """Check that the part reaches from z = 0 to its thickness, with walls that stand upright all the way.

    Walls that only the rounding of the file's own numbers makes lean do stand upright; what they differ by is counted.
    """
    off = max(abs(solid.z_min), abs(solid.z_max - thickness))
    detail = f"z from {solid.z_min:.9g} to {solid.z_max:.9g} mm, 0 to {thickness:.9g} mm is expected"
    for unit, mm in OTHERS:
        if abs(mm * solid.thickness - thickness) <= 1e-3 * thickness:
            detail += f"; as if drawn in {unit} and stated as mm"
    if not solid.prism:
        return failed("thickness", f"the sections at different heights differ; {detail}", unit="mm", limit=tolerance)
    checked = at_most("thickness", off, tolerance, "mm", detail=detail, slack=ROUNDING * thickness)
    return less_sure(checked, solid.uneven)
