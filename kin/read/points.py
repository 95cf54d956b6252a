"""Points measured on a part, as measuring machines, roundness testers, indicators and scanners write them.

A table has rows of x, y and, if there are, z and a normal nx, ny, nz; of a radius and a polar angle; or of a shaft
angle and a lift. Its heading says which and in which units (`x_mm`, `X [mm]`, `lift_in`); without one, rows of two or
three numbers are x, y and z, of six with a normal. Angles of lifts in crank degrees, by their heading, are halved: the
camshaft of a four-stroke engine turns half as fast. `kin.read.rows` has how columns are parted. Lines that begin with
#, ;, %, ! or // are comments. DMIS gives points as `FA(label) = FEAT/POINT,CART,x,y,z,i,j,k` (ISO 22093); a `$` at the
end continues a line.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Literal, NamedTuple, TypeAlias

import numpy as np

from kin.contour.across import Bridge, bulge_across
from kin.contour.contour import Contour
from kin.contour.intersections import crossings
from kin.numeric.records import dataclass, replace
from kin.read.errors import ReadError, short
from kin.read.rows import ROW, RowError, has_more_rows, read_rows

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from pathlib import Path

    from kin.contour.across import Across
    from kin.numeric.arrays import Array, Indices, Mask
    from kin.read.rows import Rows

Measured: TypeAlias = Literal["places", "lift"]
TurnsOf: TypeAlias = Literal["crank", "cam", ""]
SUFFIXES = (".csv", ".txt", ".xyz", ".asc", ".dmo", ".dmi", ".dms")
MOST_BYTES = 200_000_000
LEAST_POINTS, MOST_POINTS = 36, 1_000_000  # in a file; the least is one every 10 degrees
MOST_HEADINGS = 1000  # lines of words above the rows; of few points beyond the most the rows are counted one by one
LARGEST = 1e6  # of a coordinate, in the file's unit
# Points leave out a stretch where a step is so many times as wide as the second widest of so many on either side,
MANY, NEIGHBOURS = 3.5, 10
UNEVEN = 2.0  # twice as many of steps that are themselves so uneven
# unless it goes straight on from both: turns by no more than so much, rad, and so many times as the steps beside it.
STRAIGHT, BENDS = np.radians(0.5), 1.5
UNITS = {"mm": 1.0, "cm": 10.0, "m": 1000.0, "um": 1e-3, "in": 25.4, "inch": 25.4, "inches": 25.4, "thou": 0.0254}
CRANK = 2.0  # turns of a four-stroke engine's crank for one of its camshaft
ANGLES = {"deg": 1.0, "degree": 1.0, "degrees": 1.0, "°": 1.0, "rad": 180.0 / np.pi}
NAMES = {  # what columns are called by the programs that write them
    "x": "x", "xm": "x", "xact": "x", "xactual": "x", "xmeas": "x",
    "y": "y", "ym": "y", "yact": "y", "yactual": "y", "ymeas": "y",
    "z": "z", "zm": "z", "zact": "z", "zactual": "z", "zmeas": "z",
    "nx": "nx", "i": "nx", "u": "nx", "ny": "ny", "j": "ny", "v": "ny", "nz": "nz", "k": "nz", "w": "nz",
    "r": "radius", "radius": "radius", "rho": "radius",
    "polar": "angle", "angle": "angle", "theta": "angle", "phi": "angle", "a": "angle", "cam": "angle",
    "camshaft": "angle", "shaft": "angle", "crank": "angle", "crankshaft": "angle", "ca": "angle", "lift": "lift",
    "s": "lift", "reading": "lift", "displacement": "lift", "swing": "lift",
    "surface": "surface", "flank": "surface", "lobe": "lobe",
}  # fmt: skip
UNIT = re.compile(r"[\[(](?P<inside>[^\[\]()]*)[\])]$|_(?P<after>[a-z°]+)$")
OF_CRANK, OF_CAM = (
    re.compile(rf"(?<![a-z])(?:{word})(?![a-z])") for word in ("crank(?:shaft)?|ca", "cam(?:shaft)?|shaft")
)
COMMENT = ("#", ";", "%", "!", "//", "$$")
POINT = r"FA[ \t]*\("  # begin of the statement of a point in DMIS
DMIS = re.compile(r"FA\s*\([^)]*\)\s*=\s*FEAT\s*/\s*POINT\s*,\s*CART\s*,(?P<rest>.*)$", re.IGNORECASE)


@dataclass(frozen=True, eq=False)
class PointTable:
    """Measured points (n), as their file has them.

    measured    "places" where `columns` have x and y, "lift" where they have angle and lift
    columns     by name: x, y, z, nx, ny, nz (n,), or angle (degrees) and lift; lengths in the file's unit
    lines       line of each point in the file (n,), from 1
    unit        mm of the file's unit of length where the file states it, else None
    turns_of    shaft that the heading of the angles names, "" for none; crank angles are halved in `columns`
    degrees     whether lifts are angles, by the unit in their heading; they are degrees in `columns`
    labels      surface, or lobe, of each point where the file names them; else empty
    """

    measured: Measured
    columns: Mapping[str, Array]
    lines: Indices
    unit: float | None = None
    turns_of: TurnsOf = ""
    degrees: bool = False
    labels: Sequence[str] = ()

    def __len__(self) -> int:
        return len(self.lines)

    def rows(self, chosen: Mask) -> PointTable:
        """The table with its `chosen` rows (n,) alone."""
        columns = {name: column[chosen] for name, column in self.columns.items()}
        labels = [self.labels[i] for i in np.flatnonzero(chosen).tolist()] if self.labels else ()
        return replace(self, columns=columns, lines=self.lines[chosen], labels=labels)


def heading_of(path: Path) -> tuple[str, ...]:
    """Names of the columns, as written, by the first 65536 bytes of a file; empty where rows have no heading.

    Where no row of numbers is found, the cells of the first line that is no comment are taken, or one empty name.
    Raises OSError where the file cannot be read.
    """
    with path.open("rb") as stream:
        text = _decoded(stream.read(65536))
    try:
        return read_rows(text, COMMENT).heading
    except RowError:
        lines = (line.strip() for line in text.lstrip("\ufeff").splitlines())
        first = next((line for line in lines if line and not line.startswith(COMMENT)), "")
        return tuple(name.strip() for name in re.split(r"[;,\t]", first))


def read_points(path: Path) -> PointTable:
    """Read the points of a file.

    Raises OSError where the file cannot be read; ReadError for a file that is too large, no text or without points that
    are read, rows that are damaged, numbers out of range, too few points, and normals that run along the shaft.
    """
    size = path.stat().st_size
    if size > MOST_BYTES:
        raise ReadError("range", f"{size / 1e6:.4g} MB, and of points up to {MOST_BYTES / 1e6:.4g} MB are read", path)
    raw = path.read_bytes()
    if b"\0" in raw and not raw.startswith((b"\xff\xfe", b"\xfe\xff")):
        raise ReadError("syntax", "not a text; save the points as CSV", path)
    text = _decoded(raw)
    is_dmis = has_more_rows(text, 0, POINT) and "FEAT" in text.upper()
    if has_more_rows(text, MOST_POINTS + MOST_HEADINGS, POINT if is_dmis else ROW):
        raise ReadError("range", f"more than {MOST_POINTS} rows; up to {MOST_POINTS} are read: leave some out", path)
    if is_dmis:
        return _demand_sound(_dmis(text, path), path)
    if text.lstrip().upper().startswith("DMISMN"):
        message = "a program that measures, and no point FA(label)=FEAT/POINT,CART of what it measured: give its output"
        raise ReadError("empty", message, path)
    return _demand_sound(_table(text, path), path)


class PointContour(NamedTuple):
    """A closed contour through points, counter-clockwise, mm, and the stretch that closes it where points are left out.

    `unit` is mm of the file's unit, None where it states none.
    """

    contour: Contour
    bridge: Bridge | None
    unit: float | None


def read_contour_points(path: Path, unit: float, across: Across | None = None) -> list[PointContour]:
    """Read closed polygons, counter-clockwise, mm, through points in order: one for each surface that the file names.

    `unit`, mm, is the unit of a file that states none. Where points leave a stretch of the contour out, `across` closes
    it. Raises OSError where the file cannot be read; ReadError for a file without sound points, one of angles and
    lifts, points out of order, whose lines cross, and points that leave a stretch out without `across`.
    """
    table = read_points(path)
    if "x" not in table.columns:
        message = "angles and lifts make no contour; give them as table, or points x, y"
        raise ReadError("unsupported", message, path)
    mm = table.unit or unit
    places = np.column_stack([table.columns["x"], table.columns["y"]]) * mm
    labels = np.array(table.labels or [""] * len(table))
    contours = []
    for label in dict.fromkeys(labels.tolist()):
        points, lines = places[labels == label], table.lines[labels == label]
        moved = (points != np.roll(points, 1, axis=0)).any(axis=1)
        points, lines = points[moved], lines[moved]
        contour = Contour.from_vertices(points)
        crossing = crossings(contour).point
        if len(crossing):
            x, y = (crossing[0] / mm).tolist()
            message = f"lines from point to point cross near {x:.6g}, {y:.6g}; give the points in their order"
            raise ReadError("crossing", f"{message} round the contour", path, (x, y))
        if contour.area < 0.0:
            points, lines = points[::-1], lines[::-1]
        contours.append(PointContour(*_closed(points, lines, across, mm, path), table.unit))
    return contours


def _closed(
    points: Array, lines: Indices, across: Across | None, mm: float, path: Path
) -> tuple[Contour, Bridge | None]:
    """The polygon through points (n, 2), mm, counter-clockwise, closed by `across` where they leave a stretch out."""
    open_at = left_out(points)
    if open_at is None:
        return Contour.from_vertices(points), None
    start, end = points[open_at], points[(open_at + 1) % len(points)]
    between = sorted([int(lines[open_at]), int(lines[(open_at + 1) % len(points)])])
    wide = float(np.hypot(*(end - start)))
    named = (
        f"lines {between[0]} and {between[1]}: {wide / mm:.4g} apart, {wide / _usual(points):.0f} times the usual step"
    )
    bridge = Bridge((float(start[0]), float(start[1])), (float(end[0]), float(end[1])))
    if across is None or bridge.angles[1] - bridge.angles[0] >= np.pi:
        remedy = "give the points between them" + ("" if across else ", or across: arc or chord, which closes it there")
        raise ReadError("open", f"{named}: a stretch of the contour is left out; {remedy}", path, None, wide)
    bulges = np.zeros(len(points))
    bulges[open_at] = bulge_across(start, end, across)
    return Contour.from_bulges(points, bulges), bridge


def left_out(points: Array) -> int | None:
    """Index of the point (n, 2), mm, behind which a stretch of the closed contour is left out; None where none is.

    The step there is many times as wide as those on either side, and does not go straight on from either: a flank
    that is straight needs no points between its ends. Of several the widest counts.
    """
    step = np.roll(points, -1, axis=0) - points
    length = np.hypot(*step.T)
    beside = np.stack([np.roll(length, k) for k in range(-NEIGHBOURS, NEIGHBOURS + 1) if k])
    usual = np.sort(beside, axis=0)[-2]  # but for one more such stretch
    many = np.where(usual > UNEVEN * np.median(beside, axis=0), 2.0, 1.0) * MANY
    # the turn from each step to the next, and how much the points turn beside that
    heading = np.arctan2(step[:, 1], step[:, 0])
    turn = np.abs((np.roll(heading, -1) - heading + np.pi) % (2.0 * np.pi) - np.pi)
    near = np.stack([np.maximum(np.roll(turn, k + 1), np.roll(turn, -k)) for k in range(1, NEIGHBOURS // 2 + 1)])
    straight = np.maximum(np.roll(turn, 1), turn) <= STRAIGHT + BENDS * np.median(near, axis=0)
    wide = np.flatnonzero((length > many * usual) & ~straight)
    return int(wide[np.argmax(length[wide])]) if wide.size else None


def _usual(points: Array) -> float:
    return float(np.median(np.hypot(*(np.roll(points, -1, axis=0) - points).T)))


def _decoded(data: bytes) -> str:
    if data.startswith((b"\xff\xfe", b"\xfe\xff")):
        return data.decode("utf-16", "replace")
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError:  # a degree sign of an older encoding
        return data.decode("latin-1")


def _dmis(text: str, path: Path) -> PointTable:
    rows, lines, begin = [], [], 0
    parts: list[str] = []
    for number, line in enumerate(text.splitlines(), 1):
        begin = begin if parts else number
        parts.append(line.strip())
        if parts[-1].endswith("$") and not parts[0].startswith("$$"):
            parts[-1] = parts[-1][:-1]
            continue
        statement, parts = "".join(parts), []
        if feature := DMIS.match(statement):
            try:
                rows.append([float(cell) for cell in feature["rest"].split(",")])
            except ValueError:
                raise ReadError("syntax", f"line {begin}: not numbers: {short(statement)}", path) from None
            if len(rows[-1]) not in {3, 6}:
                raise ReadError("syntax", f"line {begin}: x,y,z or x,y,z,i,j,k are expected: {short(statement)}", path)
            lines.append(begin)
    if not rows:
        raise ReadError("empty", "no FA(label) = FEAT/POINT,CART,... is among its lines", path)
    if len({len(row) for row in rows}) > 1:
        raise ReadError("syntax", "some of its points have normals, and others do not", path)
    values = np.array(rows)
    columns = dict(zip(("x", "y", "z", "nx", "ny", "nz")[: values.shape[1]], values.T, strict=True))
    return PointTable("places", columns, np.array(lines, dtype=np.intp), _stated_in_dmis(text))


def _stated_in_dmis(text: str) -> float | None:
    statement = re.search(r"^[ \t]*UNITS[ \t]*/[ \t]*(MM|CM|M|INCH)\b", text, re.MULTILINE | re.IGNORECASE)
    return UNITS[statement[1].lower()] if statement else None


def _table(text: str, path: Path) -> PointTable:
    try:
        rows = read_rows(text, COMMENT)
        if len(rows.lines) > MOST_POINTS:
            raise ReadError("range", f"{len(rows.lines)} rows; up to {MOST_POINTS} are read: leave some out", path)
        return _with_heading(rows, path) if rows.heading else _without_heading(rows, path)
    except RowError as error:
        if error.line is None:
            raise ReadError("empty", error.message, path) from None
        raise ReadError("syntax", f"line {error.line}: {error.message}", path) from None


def _without_heading(rows: Rows, path: Path) -> PointTable:
    names = {2: "x y", 3: "x y z", 6: "x y z nx ny nz"}.get(rows.columns)
    if names is None:
        count = f"line {rows.numbers[0]}: {rows.columns} numbers without a heading"
        remedy = "x y, x y z or x y z nx ny nz are read so: give the file a heading such as x_mm,y_mm"
        raise ReadError("unsupported", f"{count}; {remedy}", path)
    values = rows.values([*range(rows.columns)], blanks=True)
    columns = dict(zip(names.split(), values.T, strict=True))
    return PointTable("places", columns, rows.numbers)


def _with_heading(rows: Rows, path: Path) -> PointTable:
    # columns by name; `inner_x` and `outer_x` are x of two surfaces, read only where there is no plain x
    known = _columns(rows.heading, path)
    names = [name for name, _, _ in known]
    surfaces = list(dict.fromkeys(prefix for name, prefix, _ in known if name == "x" and prefix))
    first = surfaces[0] if surfaces and ("x", "") not in {(name, prefix) for name, prefix, _ in known} else ""

    def at(name: str, prefix: str = first) -> int | None:
        return next((i for i, (own, before, _) in enumerate(known) if own == name and before == prefix), None)

    wanted = ["x", "y"] if at("x") is not None else ["radius", "angle"] if at("radius", "") is not None else []
    measured: Measured = "places"
    if not wanted and at("lift", "") is not None:
        wanted, measured = ["angle", "lift"], "lift"
    missing = [name for name in wanted if at(name, first if name in {"x", "y"} else "") is None]
    if not wanted or missing:
        lacking = f"a column {' and '.join(missing)} is missing" if wanted else "no columns of measured points"
        names_read = short(", ".join(rows.heading))
        readable = "x,y or radius,angle or angle_deg,lift are read, or of a grinder's table c_deg and x or lift"
        raise ReadError("unsupported", f"{lacking} in its heading {names_read}; {readable}", path)
    # the columns of each surface, one surface below another
    prefixes = surfaces if first else [""]
    groups = [_group(known, prefix, wanted) for prefix in prefixes]
    used = sorted({i for group in groups for i in group.values()})
    values = rows.values(used, blanks=True)
    place = {column: k for k, column in enumerate(used)}
    columns: dict[str, Array] = {}
    for name in [name for name in groups[0] if all(name in group for group in groups)]:
        parts = [values[:, place[group[name]]] for group in groups]
        columns[name] = np.concatenate(parts)
    # one unit of all lengths; angles become degrees, those of a crank degrees of the cam
    units = {unit for name, prefix, unit in known if unit in UNITS and name in {*wanted, "z"} and unit}
    stated = {UNITS[unit] for unit in units}
    if len(stated) > 1:
        raise ReadError("unsupported", f"its columns are in {' and '.join(sorted(units))}; give all in one unit", path)
    turned = next((unit for name, _, unit in known if name == "angle" and unit in ANGLES), "deg")
    if "angle" in columns:
        columns["angle"] = columns["angle"] * ANGLES[turned]
    cell = rows.heading[groups[0]["angle"]].lower() if "angle" in columns else ""
    turns_of = _turns_of(cell)
    if measured == "lift":
        columns["angle"] = columns["angle"] / CRANK if turns_of == "crank" else columns["angle"]
        swing = next((unit for name, _, unit in known if name == "lift" and unit in ANGLES), "")
        columns["lift"] = columns["lift"] * ANGLES.get(swing, 1.0)
    elif turns_of == "crank":
        remedy = "a polar angle is the part's own: head it polar_deg"
        raise ReadError("unsupported", f"its radii stand over crank degrees, {short(cell)}; {remedy}", path)
    if "radius" in columns:
        radius, angle = columns.pop("radius"), np.radians(columns.pop("angle"))
        columns |= {"x": radius * np.cos(angle), "y": radius * np.sin(angle)}
    # surface of each point: the prefix of its columns, else the cell of a column
    labels: list[str] = [prefix for prefix in prefixes for _ in rows.lines] if first else []
    column = names.index("surface") if "surface" in names else names.index("lobe") if "lobe" in names else None
    if column is not None and not first:
        labels = rows.texts(column)
    swings = any(name == "lift" and unit in ANGLES for name, _, unit in known)
    lines = np.tile(rows.numbers, len(prefixes))
    if first:  # places that are not touched are left empty
        touched = np.isfinite(np.stack(list(columns.values()))).all(axis=0)
        columns, lines = {name: row[touched] for name, row in columns.items()}, lines[touched]
        labels = [labels[i] for i in np.flatnonzero(touched).tolist()]
    return PointTable(measured, columns, lines, next(iter(stated), None), turns_of, swings, labels)


def _turns_of(cell: str) -> TurnsOf:
    """Shaft of the angles below a heading's cell, by its words; "" where it names none."""
    return "crank" if OF_CRANK.search(cell) else "cam" if OF_CAM.search(cell) else ""


def _group(known: list[tuple[str, str, str]], prefix: str, wanted: Sequence[str]) -> dict[str, int]:
    """Columns of one surface by their names."""
    group: dict[str, int] = {}
    for i, (name, before, _) in enumerate(known):
        own = name in {*wanted, "z", "nx", "ny", "nz"} and (before == prefix or (name == "angle" and not before))
        if own and name not in group and not (name == "angle" and "angle" not in wanted):
            group[name] = i
    if not {"nx", "ny"} <= set(group):
        group = {name: i for name, i in group.items() if name not in {"nx", "ny", "nz"}}
    return group


def _columns(heading: Sequence[str], path: Path) -> list[tuple[str, str, str]]:
    """Name, surface and unit of each cell of a heading; the name is empty if unknown.

    Raises ReadError where only by their first words several columns are the same, as `X set` and `X found` are.
    """
    named, known = [_column(cell) for cell in heading], []
    sure = {(name, prefix) for name, prefix, _, certain in named if certain}
    first: dict[str, str] = {}
    for (name, prefix, unit, certain), cell in zip(named, heading, strict=True):
        kept = name if certain or (name, prefix) not in sure else ""
        if kept and not certain and first.setdefault(kept, cell) is not cell:
            pair, remedy = short(f"{first[kept]} and {cell}"), f"head those that were measured {kept}"
            raise ReadError("unsupported", f"its columns {pair} may both be {kept}; {remedy}", path)
        known.append((kept, prefix, unit))
    return known


def _column(cell: str) -> tuple[str, str, str, bool]:
    """Name, surface and unit of a cell, and whether the name is sure: `inner_x_mm` is x of `inner` in mm.

    A name by the first word alone, as of `X set`, is not sure. The name is empty if unknown.
    """
    text = cell.strip().strip('"').strip().lower()
    name, unit = text, ""
    if behind := UNIT.search(text):
        stated = (behind["inside"] or behind["after"] or "").strip()
        if stated in UNITS or stated in ANGLES or behind["inside"] is not None:
            name, unit = text[: behind.start()].rstrip(" _\t"), stated
    words = [word for word in re.split(r"[ _]+", name) if word]
    if not words or "cutter" in words:  # where a cutter stands is no metal
        return "", "", unit, True
    known = NAMES.get("".join(words), "")
    if known:
        return known, "", unit, True
    known = NAMES.get(words[-1], "")
    if known:
        return known, "_".join(words[:-1]) if known in {"x", "y", "nx", "ny", "nz", "z"} else "", unit, True
    return NAMES.get(words[0], ""), "", unit, False


def _demand_sound(table: PointTable, path: Path) -> PointTable:
    """The table itself.

    Raises ReadError for numbers that are not finite or too large, too few points, and normals shorter than 0.5 across
    the shaft.
    """
    for name, column in table.columns.items():
        wrong = ~(np.abs(column) <= LARGEST)
        if wrong.any():
            row = int(np.argmax(wrong))
            raise ReadError("range", f"line {table.lines[row]}: {name} is {column[row]:.6g}, which no part has", path)
    if len(table) < LEAST_POINTS:
        message = f"points: {len(table)}, and at least {LEAST_POINTS} are needed, all round the cam"
        raise ReadError("range", message, path)
    if {"nx", "ny"} <= set(table.columns):
        size = np.hypot(table.columns["nx"], table.columns["ny"])
        if (size < 0.5).any():
            row = int(np.argmin(size))
            raise ReadError(
                "range", f"line {table.lines[row]}: its normal is {size[row]:.3g} long across the shaft", path
            )
    return table
