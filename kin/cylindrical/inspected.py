"""Points measured on the flanks of a drum, as measuring machines and inspection tables write them.

A table has x, y and z, or a polar angle, a radius and z, by its heading, with units as kin.read.points reads them:
`x_mm`, `phi_deg`, `r [in]`. Columns of two flanks may stand side by side, `lower_r_mm`, `upper_r_mm`, or a column
`flank` or `surface` names the flank of each point.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kin.numeric.records import dataclass
from kin.read.errors import ReadError, short
from kin.read.points import ANGLES, COMMENT, LARGEST, MOST_BYTES, MOST_POINTS, NAMES, UNIT, UNITS
from kin.read.rows import RowError, read_rows

if TYPE_CHECKING:
    from pathlib import Path

    from kin.numeric.arrays import Array, Indices
    from kin.read.rows import Rows

FLANKS = ("lower", "upper")
ANY = -1  # number of the flank of a point whose file does not name it
LEAST_POINTS = 12
PLACES = (("x", "y", "z"), ("angle", "radius", "z"))
READ = "x, y, z or phi_deg, r, z are read, for each flank as lower_x or with a column flank"


class _Column(NamedTuple):
    """A column: what it is, whose it is ("" for no flank), its number, and its unit as a factor, None for none."""

    name: str
    flank: str
    number: int
    unit: float | None


@dataclass(frozen=True, eq=False)
class FlankPoints:
    """Points of a file: places (n, 3) as x, y, z in the file's unit of length, their flanks (n,) and lines (n,).

    `unit` is mm of the file's unit where its heading states it, else None.
    """

    places: Array
    flank: Indices
    lines: Indices
    unit: float | None


def read_flank_points(path: Path) -> FlankPoints:
    """Read the points of a file; rows without a number are left out, as of contacts that are lost to undercut.

    Raises OSError where the file cannot be read; ReadError for a file that is too large, no text, without these
    columns, with units that differ, a flank of another name, or too few points.
    """
    if (size := path.stat().st_size) > MOST_BYTES:
        raise ReadError("range", f"{size / 1e6:.4g} MB, and of points up to {MOST_BYTES / 1e6:.4g} MB are read", path)
    try:
        text = path.read_bytes().decode("utf-8-sig")
    except UnicodeDecodeError:
        raise ReadError("syntax", "not a text; save the points as CSV", path) from None
    try:
        rows = read_rows(text, COMMENT)
        if len(rows.lines) > MOST_POINTS:
            raise ReadError("range", f"{len(rows.lines)} rows; up to {MOST_POINTS} are read: leave some out", path)
        found = _read(rows, path)
    except RowError as error:
        place = "" if error.line is None else f"line {error.line}: "
        raise ReadError("syntax", f"{place}{error.message}", path) from None
    if len(found.lines) < LEAST_POINTS:
        raise ReadError("empty", f"{len(found.lines)} points; at least {LEAST_POINTS} are read", path)
    if not bool((np.abs(found.places) <= LARGEST).all()):
        raise ReadError("range", f"a coordinate is beyond {LARGEST:g}", path)
    return found


def _read(rows: Rows, path: Path) -> FlankPoints:
    columns = [_column(name, k) for k, name in enumerate(rows.heading)]
    known = [column for column in columns if column is not None]
    groups = []
    for flank in ("", *FLANKS):
        own = {column.name: column for column in reversed(known) if column.flank == flank}
        names = next((names for names in PLACES if all(name in own for name in names)), None)
        if names is not None:
            groups.append((flank, [own[name] for name in names], names))
    if not groups:
        heading = short(", ".join(rows.heading)) if rows.heading else "no heading"
        raise ReadError("unsupported", f"no columns of points of a flank, in its heading: {heading}; {READ}", path)
    label = next((column.number for column in known if column.name == "surface"), None)
    units, parts, flanks, lines = set(), [], [], []
    for flank, chosen, names in groups:
        values = rows.values([column.number for column in chosen], blanks=True)
        units |= {column.unit for column in chosen if column.name != "angle"}
        if names[0] == "angle":
            angle = np.radians((chosen[0].unit or 1.0) * values[:, 0])
            values = np.stack([values[:, 1] * np.cos(angle), values[:, 1] * np.sin(angle), values[:, 2]], axis=-1)
        there = np.isfinite(values).all(axis=1)
        parts.append(values[there])
        lines.append(rows.numbers[there])
        named = _labels(rows, label, path)[there] if label is not None and not flank else None
        number = FLANKS.index(flank) if flank else ANY
        flanks.append(np.full(int(there.sum()), number, dtype=np.intp) if named is None else named)
    if len(units) > 1:
        raise ReadError("unsupported", f"its heading states different units of length: {', '.join(rows.heading)}", path)
    return FlankPoints(np.concatenate(parts), np.concatenate(flanks), np.concatenate(lines), units.pop())


def _column(heading: str, number: int) -> _Column | None:
    """A column by its heading; None for one that is not read."""
    text = heading.strip().strip('"').lower()
    stated = UNIT.search(text)
    unit = "" if stated is None else (stated["inside"] or stated["after"] or "").strip()
    name = text if stated is None else text[: stated.start()].strip()
    if stated is not None and unit not in UNITS and unit not in ANGLES:
        name = text
    flank = next((flank for flank in FLANKS if name.startswith((f"{flank}_", f"{flank} "))), "")
    name = name.removeprefix(flank).strip(" _") if flank else name
    base = NAMES.get(name)
    # where the roller stands is no place of the point
    if name in {"shaft", "rho"} or base not in {"x", "y", "z", "angle", "radius", "surface"}:
        return None
    factor = ANGLES.get(unit) if base == "angle" else UNITS.get(unit)
    return _Column(base, flank, number, factor)


def _labels(rows: Rows, column: int, path: Path) -> Indices:
    """Numbers (n,) of the flanks that a column names."""
    texts = [text.strip().strip('"').lower() for text in rows.texts(column)]
    for text, line in zip(texts, rows.numbers.tolist(), strict=True):
        if text not in FLANKS:
            raise ReadError("syntax", f"line {line}: a flank is lower or upper, not {short(text)!r}", path)
    return np.array([FLANKS.index(text) for text in texts], dtype=np.intp)
