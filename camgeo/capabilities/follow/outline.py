"""The contour that a follower runs on, about the shaft, in mm and as if that turned clockwise."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from camgeo.common.errors import CallError
from camgeo.common.terminal import escaped
from kin.judge.surfaces import goes_round
from kin.read.errors import ReadError
from kin.read.files import read_drawing, read_solid
from kin.read.formats import FORMATS, format_of, suffixes
from kin.read.nesting import scaled
from kin.read.size import oversize

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from kin.contour.contour import Contour
    from kin.read.nesting import Chain

ROUND = 1e-6  # of its diameter: within this a chain is a circle
MOST_NAMED = 3  # holes that a message offers for the shaft


def contour_of(
    path: Path, units: float | None, at: tuple[float, float], *, mirrored: bool
) -> tuple[Contour, float | None]:
    """Read the outermost closed contour of a file that goes round the shaft, which stands at a place in mm.

    Also give the diameter of a round hole about the shaft, None without one. `units`, mm, is that of a file that states
    none. Raises CallError for what is no such file.
    """
    name = escaped(str(path))
    kinds = [suffix for suffix, kind in suffixes().items() if FORMATS[kind].contents in {"drawing", "solid"}]
    if path.suffix.lower() not in kinds:
        raise CallError(f"{name}: no drawing and no solid: give one of {', '.join(kinds)}")
    if not path.is_file():
        raise CallError(f"{name}: {'a folder' if path.is_dir() else 'the file does not exist'}")
    record = format_of(path)
    if large := oversize(path, record.name):
        raise CallError(f"{name}: {large}")
    try:
        chains = _drawn(path, units) if record.contents == "drawing" else _solid(path, units, states=record.units)
    except ReadError as error:
        raise CallError(f"{name}: {error.message}") from error
    moved = [chain.contour.moved(-at[0], -at[1]) for chain in chains]
    round_shaft = next((contour for contour in moved if goes_round(contour)), None)
    if round_shaft is None:
        x, y = at
        raise CallError(f"{name}: no closed contour goes round the shaft at {x:.9g}, {y:.9g} mm{_remedy(chains)}")
    bores = (width for contour in moved[1:] if (width := _width(contour)) is not None and _is_about(contour, width))
    return round_shaft.mirrored() if mirrored else round_shaft, next(bores, None)


def _width(contour: Contour) -> float | None:
    """Diameter of a circle, mm; None of any other contour."""
    box, length = contour.box, contour.length
    wide, high = box.x_max - box.x_min, box.y_max - box.y_min
    return wide if max(abs(wide - high), abs(length - math.pi * wide)) <= ROUND * wide else None


def _is_about(contour: Contour, width: float) -> bool:
    box = contour.box
    return max(abs(box.x_max + box.x_min), abs(box.y_max + box.y_min)) <= ROUND * width


def _drawn(path: Path, units: float | None) -> Sequence[Chain]:
    drawing = read_drawing(path)
    if drawing.units_mm is None:
        if units is None:
            raise CallError(f"{escaped(str(path))}: the drawing states no unit: give units")
        return scaled(drawing.chains, units)
    _demand_same(path, units, drawing.units_mm)
    return drawing.chains


def _solid(path: Path, units: float | None, *, states: bool) -> Sequence[Chain]:
    if states:
        _demand_same(path, units, None)
    return read_solid(path, (), units).chains


def _demand_same(path: Path, units: float | None, stated: float | None) -> None:
    """Raise CallError where a file states its unit, and another one is given."""
    if units is not None and units != stated:
        raise CallError(f"{escaped(str(path))}: the file states its unit itself: leave units out")


def _remedy(chains: Sequence[Chain]) -> str:
    """Offer the middles of round holes for the shaft."""
    found = []
    for chain in chains[1:]:
        if _width(chain.contour) is not None:
            box = chain.contour.box
            found.append(f"{0.5 * (box.x_min + box.x_max):.9g},{0.5 * (box.y_min + box.y_max):.9g}")
    return f"; give at, such as the middle of a hole: {' or '.join(found[:MOST_NAMED])}" if found else "; give at"
