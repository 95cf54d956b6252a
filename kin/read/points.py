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
from typing import TYPE_CHECKING, Literal, TypeAlias

import numpy as np

from kin.contour.contour import Contour
from kin.contour.intersections import crossings
from kin.numeric.records import dataclass, replace
from kin.read.errors import ReadError
from kin.read.nesting import counter_clockwise
from kin.read.rows import RowError, read_rows, short

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from pathlib import Path

    from kin.numeric.arrays import Array, Indices, Mask
    from kin.read.rows import Rows

Measured: TypeAlias = Literal["places", "lift"]
TurnsOf: TypeAlias = Literal["crank", "cam", ""]
SUFFIXES = (".csv", ".txt", ".xyz", ".asc", ".dmo", ".dmi", ".dms")
MOST_BYTES = 200_000_000
LEAST_POINTS, MOST_POINTS = 36, 1_000_000  # in a file; the least is one every 10 degrees
LARGEST = 1e6  # of a coordinate, in the file's unit
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
HEADING = re.compile(r"^(?P<name>.*?)[ _]*(?:[\[(]\s*(?P<inside>[^\])]*)[\])]|_(?P<after>[a-z°]+))?$")
OF_CRANK, OF_CAM = (
    re.compile(rf"(?<![a-z])(?:{word})(?![a-z])") for word in ("crank(?:shaft)?|ca", "cam(?:shaft)?|shaft")
)
COMMENT = ("#", ";", "%", "!", "//", "$$")
DMIS = re.compile(r"^FA\s*\(\s*(?P<label>[^)]*)\)\s*=\s*FEAT\s*/\s*POINT\s*,\s*CART\s*,(?P<rest>.*)$", re.IGNORECASE)


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
    if re.search(r"^\s*FA\s*\(", text, re.MULTILINE | re.IGNORECASE) and "FEAT" in text.upper():
        return _demand_sound(_dmis(text, path), path)
    if text.lstrip().upper().startswith("DMISMN"):
        message = "a program that measures, and no point FA(label)=FEAT/POINT,CART of what it measured: give its output"
        raise ReadError("empty", message, path)
    return _demand_sound(_table(text, path), path)


def read_contour_points(path: Path, unit: float) -> list[Contour]:
    """Read closed polygons, counter-clockwise, mm, through points in order: one for each surface that the file names.

    `unit`, mm, is the unit of a file that states none. Raises OSError where the file cannot be read; ReadError for a
    file without sound points, one of angles and lifts, and points out of order, whose lines cross.
    """
    table = read_points(path)
    if "x" not in table.columns:
        message = "angles and lifts make no contour; give them as table, or points x, y"
        raise ReadError("unsupported", message, path)
    places = np.column_stack([table.columns["x"], table.columns["y"]]) * (table.unit or unit)
    labels = np.array(table.labels or [""] * len(table))
    contours = []
    for label in dict.fromkeys(labels.tolist()):
        points = places[labels == label]
        contour = Contour.from_vertices(points[(points != np.roll(points, 1, axis=0)).any(axis=1)])
        crossing = crossings(contour).point
        if len(crossing):
            x, y = (crossing[0] / (table.unit or unit)).tolist()
            message = f"lines from point to point cross near {x:.6g}, {y:.6g}; give the points in their order"
            raise ReadError("crossing", f"{message} round the contour", path, (x, y))
        contours.append(counter_clockwise(contour))
    return contours


def _decoded(data: bytes) -> str:
    if data.startswith((b"\xff\xfe", b"\xfe\xff")):
        return data.decode("utf-16", "replace")
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError:  # a degree sign of an older encoding
        return data.decode("latin-1")


def _dmis(text: str, path: Path) -> PointTable:
    rows, lines, statement, begin = [], [], "", 0
    for number, line in enumerate(text.splitlines(), 1):
        begin = begin if statement else number
        statement += line.strip()
        if statement.endswith("$") and not statement.startswith("$$"):
            statement = statement[:-1]
            continue
        if feature := DMIS.match(statement):
            try:
                rows.append([float(cell) for cell in feature["rest"].split(",")])
            except ValueError:
                raise ReadError("syntax", f"line {begin}: not numbers: {short(statement)}", path) from None
            if len(rows[-1]) not in {3, 6}:
                raise ReadError("syntax", f"line {begin}: x,y,z or x,y,z,i,j,k are expected: {short(statement)}", path)
            lines.append(begin)
        statement = ""
    if not rows:
        raise ReadError("empty", "no FA(label) = FEAT/POINT,CART,... is among its lines", path)
    if len({len(row) for row in rows}) > 1:
        raise ReadError("syntax", "some of its points have normals, and others do not", path)
    values = np.array(rows)
    columns = dict(zip(("x", "y", "z", "nx", "ny", "nz")[: values.shape[1]], values.T, strict=True))
    return PointTable("places", columns, np.array(lines, dtype=np.intp), _stated_in_dmis(text))


def _stated_in_dmis(text: str) -> float | None:
    statement = re.search(r"^\s*UNITS\s*/\s*(MM|CM|M|INCH)\b", text, re.MULTILINE | re.IGNORECASE)
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
    heading = HEADING.match(text)
    name, unit = text, ""
    if heading is not None:
        stated = (heading["inside"] or heading["after"] or "").strip()
        if stated in UNITS or stated in ANGLES or heading["inside"] is not None:
            name, unit = heading["name"].strip(), stated
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
