"""Checks on what a file says of any part: its unit, contours that cross themselves, faces at the right heights."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from kin.contour.intersections import crossings
from kin.numeric.check import ROUNDING, Check, at_most, failed, less_sure
from kin.numeric.errors import CamgeoError
from kin.numeric.lengths import UNIT, file_place_words, length_words, marked, place_words, span_words
from kin.read.errors import NOT_READ

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from pathlib import Path

    from kin.contour.contour import Contour
    from kin.read.drawing.drawing import Drawing, Fault
    from kin.read.errors import ReadError
    from kin.read.formats import AnySolid, Contents

VOLUME = "volume"
UNITS_SHARE = 1e-9  # two statements of the unit agree within this share
SIZE_SHARE = (
    0.05  # a drawing that comes out by another unit's factor too large or small, within this, misstates its own
)
NOT_CLOSED = frozenset({"open", "gap", "branch", "several", "island"})
MOST_NAMED = 5  # faults named in a message
WIDE = 1.5  # of a gap within which ends are joined, which is measured along x and along y: how long a line may be
OTHERS = (
    ("inches", 25.4, "inch"),
    ("centimetres", 10.0, "cm"),
    ("metres", 1000.0, "m"),
    ("mm", 1.0, "mm"),
)  # what a file that states no unit may be drawn in, in mm, and what says so


class UnitsError(CamgeoError, ValueError):
    """A unit was given for a file that states another one itself."""


def demand_same(stated: float | None, units: float | None, path: Path) -> None:
    """Refuse a unit that is given beside another one that the file states."""
    if stated is not None and units is not None and not abs(stated / units - 1.0) <= UNITS_SHARE:
        message = f"{path}: the file states its unit, {stated:.9g} mm; {units:.9g} mm is given for it"
        raise UnitsError(f"{message}, which is for files that state none")


def units_check(stated: float | None, units: float | None, unit: float, size: Callable[[], float]) -> Check:
    """Check the unit of a drawing or a program: the stated unit counts, unless the size shows that it is wrong.

    `unit`, mm, is expected; `size` gives the size of what is drawn over that of the exact part.
    """
    if stated is None and units is None:
        why = f"the drawing states no unit and is judged in that of the recipe, {unit:.9g} mm"
        name, mm, word = _unit_by_size(size(), unit)
        why += f"; by its size it is drawn in {name}" if mm != unit else ""
        return failed("units", f"{why}; give it by --units, such as --units {word}", limit=UNITS_SHARE)
    if stated is None:
        return Check("units", True, 0.0, UNITS_SHARE, "", detail=f"the file states no unit; {units:.9g} mm is given")
    off = abs(stated / unit - 1.0)
    detail = f"a drawing unit is {stated:.9g} mm, {unit:.9g} mm is expected"
    if off > UNITS_SHARE:
        large = size()
        if abs(large * unit / stated - 1.0) > SIZE_SHARE or abs(large - 1.0) <= SIZE_SHARE:
            return Check("units", True, 0.0, UNITS_SHARE, "", detail=f"a drawing unit is {stated:.9g} mm, as stated")
        detail += ", as the size has it: save the file with its right unit"
    return Check("units", off <= UNITS_SHARE, off, UNITS_SHARE, "", detail=detail)


def _unit_by_size(large: float, unit: float, share: float = SIZE_SHARE) -> tuple[str, float, str]:
    """Name, length in mm and word in a call of the unit in which a file is by its size; "", `unit` and mm for none.

    `large` is the size of what is in the file, read in `unit`, mm, over that of the exact part, and right within a
    share of it.
    """
    by_size = (other for other in OTHERS if abs(large * other[1] / unit - 1.0) <= share)
    return next(by_size, ("", unit, "mm"))


def crossing_places(contours: Sequence[Contour], joined: float = 0.0) -> list[str]:
    """Words for the places where contours cross themselves, without those beside a line that joins two ends."""
    places = []
    for contour in contours:
        points = crossings(contour).point
        if joined and len(points):
            lines = np.flatnonzero(np.hypot(*(contour.end - contour.start).T) <= WIDE * joined)
            apart = np.hypot(*np.moveaxis(points[:, None] - contour.start[None, lines], 2, 0))
            points = points[~(apart <= 2.0 * WIDE * joined).any(axis=1)]
        places += [f"the contour crosses or touches itself at {place_words(x, y)} {UNIT}" for x, y in points.tolist()]
    return places


def count_check(name: str, faults: list[str]) -> Check:
    """Check that there are no faults; the first of them are told."""
    return at_most(name, len(faults), 0, "faults", detail=listed(faults))


def listed(texts: Sequence[str]) -> str:
    """The first texts, and how many more there are."""
    more = f"; and {len(texts) - MOST_NAMED} more" if len(texts) > MOST_NAMED else ""
    return "; ".join(texts[:MOST_NAMED]) + more


def thickness_check(solid: AnySolid, thickness: float, tolerance: float) -> Check:
    """Check that the part reaches from z = 0 to its thickness, with walls that stand upright all the way.

    Walls that lean by the rounding of the file's own numbers alone count as upright; the difference is counted in.
    """
    off = max(abs(solid.z_min), abs(solid.z_max - thickness))
    detail = f"z from {span_words(solid.z_min, solid.z_max)}, 0 to {length_words(thickness, '.9g')} {UNIT} is expected"
    name, mm, _ = _unit_by_size(solid.thickness / thickness, 1.0, 1e-3)
    detail += f"; as if drawn in {name} and stated as mm" if mm != 1.0 else ""
    if not solid.prism:
        return failed("thickness", f"the sections at different heights differ; {detail}", unit="mm", limit=tolerance)
    checked = at_most("thickness", off, tolerance, "mm", detail=detail, slack=ROUNDING * thickness)
    return less_sure(checked, solid.uneven)


def closed_check(
    drawing: Drawing, scale: float, contours: Sequence[Contour], gap: float | None, joined: float
) -> Check:
    """Check that no contour is open or crosses itself, and that nothing is drawn twice or without length.

    `scale` is mm in a unit of the drawing as it was read. `gap`, mm, was given for ends to be joined, None for none;
    `joined`, mm, is the widest gap that was.
    """
    faults = list(drawing.openings)
    faults += [f"{fault.kind} {_entity_words(fault, scale)}" for fault in drawing.faults]
    faults += crossing_places(contours, joined)
    check = count_check("closed", faults)
    if drawing.openings:
        counted = f"the rest is judged with {joined:.3g} mm counted; {_gap_remedy(joined)}"
        detail = counted if joined else "the rest is judged"
        return replace(check, detail=f"{marked(check.detail)}; {detail}")
    if gap is not None:
        short = [_entity_words(piece, scale) for piece in drawing.short]
        detail = f"ends up to {gap:.6g} mm apart are joined, which is counted; {len(short)} pieces are no longer"
        named = f"{detail}: {listed(short)}" if short else detail
        return replace(check, detail=f"{marked(check.detail)}; {named}".removeprefix("; "))
    if joined:
        detail = f"ends up to {joined:.3g} mm apart are joined, as its digits or its size explain; that is counted"
        return replace(check, detail=f"{marked(check.detail)}; {detail}".removeprefix("; "))
    return check


def _gap_remedy(width: float) -> str:
    return f"--gap {float(f'{WIDE * width:.1e}'):g}mm joins what lies so near"


def _entity_words(fault: Fault, scale: float) -> str:
    return f"{fault.entity} at {file_place_words(scale * fault.x, scale * fault.y)}"


def unread_check(contents: Contents, error: ReadError) -> Check:
    """The check that a file fails from which no contour can be read, by what it should hold, with a remedy if any."""
    if contents == "solid":
        name = "readable" if error.reason in NOT_READ else "watertight"
    else:
        name = "closed" if error.reason in NOT_CLOSED else "readable"
    remedy = "" if error.closing is None else f"; {_gap_remedy(error.closing)}"
    remedy = "; move the cam in its file until its shaft is there" if error.cams else remedy
    return failed(name, f"{error.message}{remedy}")


def enclosed_check(
    measured: tuple[float, float], exact: tuple[float, float], tolerance: float, *, stated: bool = True
) -> Check:
    """Check of a solid's volume, mm^3, by what a surface within a tolerance, mm, encloses.

    `measured` are its volume and its area, mm^2; `exact` are the volume of the exact part, and by how much it may be
    off; `stated` is whether the file states its unit. A failure says in which other unit the file is by its size.
    """
    (volume, area), (expected, remainder) = measured, exact
    detail = f"{length_words(volume, '.9g', 3)} {UNIT}^3, by the intent {length_words(expected, '.9g', 3)}"
    if remainder:
        detail += f", known within {length_words(remainder, '.2g', 3)} {UNIT}^3"
    name, mm, word = _unit_by_size(math.cbrt(volume / expected), 1.0)
    if mm != 1.0:
        remedy = "save the file with its right unit" if stated else f"give --units {word}"
        detail += f"; as if drawn in {name} and stated as mm: {remedy}"
    off = abs(volume - expected) + remainder
    return at_most(VOLUME, off, tolerance * area, "mm^3", detail=detail, slack=ROUNDING * expected)
