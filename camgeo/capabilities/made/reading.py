"""Files of points: which they are, the options of the call, and the surface that each point is on."""

from __future__ import annotations

import math
import re
from typing import TYPE_CHECKING

import numpy as np

from camgeo.capabilities.made.runs import ALIGN
from camgeo.common.arguments import short_repr
from camgeo.common.errors import CallError
from camgeo.common.terminal import escaped
from camgeo.schema.quantity import read_quantity
from camgeo.schema.scalars import Complaint
from kin.judge.drive import is_drive
from kin.made.points import SurfacePoints
from kin.numeric.records import dataclass
from kin.read.errors import ReadError
from kin.read.formats import FORMATS
from kin.read.point_list import is_point_list
from kin.read.points import PointTable, heading_of, read_points

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from pathlib import Path

    from camgeo.recipe.recipe import Recipe
    from kin.judge.intent import PartIntent, SurfaceIntent
    from kin.numeric.arrays import Array, Indices

GRINDER = "c_deg"  # heading of the column of the work's angle in a grinder's table
REPEATED = 0.02  # of the mean step: points nearer than this are one place, measured again
FEWER = 0.8  # of the points: as many places or less, and they are repeats
MOST_LENGTH = 1e3  # mm, of a probe and its errors


def claims(path: Path, options: Mapping[str, object]) -> bool:
    """Whether a file holds measured points, and not rows for a machine."""
    if "as" in options:
        return options["as"] == "measured"
    if is_point_list(path) or is_drive(path):  # of a curve, which is judged as a contour, or of a motion
        return False
    if path.suffix.lower() not in FORMATS["csv"].suffixes:
        return True
    heading = [cell.strip().strip('"').lower() for cell in heading_of(path)]
    return GRINDER not in heading


@dataclass(frozen=True)
class Probing:
    """Way in which points were measured.

    align   unknowns that are placed by least squares before all else: letters of "gxy", the turn and the shift
    ball    radius of the probe, mm; None for points of the metal, and for the follower's own of lifts
    face    width of an indicator's flat face, mm
    units   mm in a unit of files whose headings state none; None for that of the recipe
    alone   known turn, rad, of a cam on a shaft against the others; None for a part of its own
    """

    align: str = ""
    ball: float | None = None
    face: float | None = None
    units: float | None = None
    alone: float | None = None


@dataclass(frozen=True)
class Call:
    """Options of a call, mm and radians; None for an option that is not given.

    error        expanded uncertainty of a point, k = 2
    axes         expanded uncertainty of the part's axes: shift, and turn
    spans        number of spans of the smoothed deviation
    out          folder for a page, a drawing and a table
    """

    probing: Probing = Probing()
    error: float | None = None
    axes: tuple[float, float] | None = None
    spans: int | None = None
    out: str | None = None

    @staticmethod
    def of(options: Mapping[str, object], recipe: Recipe, units: float | None = None) -> Call:
        """Read the options of a call, with the unit of its files, mm.

        Raises CallError with a line for each that makes no sense.
        """
        faults: list[str] = []

        def length(name: str, value: object, *, least: float = 0.0) -> float | None:
            try:
                number = read_quantity(str(value), recipe.units) * recipe.mm
            except Complaint:
                number = math.nan
            if not least <= number <= MOST_LENGTH:
                faults.append(
                    f"--{name.replace('_', '-')}: a length such as 0.002 or 0.0001in is expected, "
                    f"not {short_repr(value)}"
                )
                return None
            return number

        align = str(options.get("align", "none"))
        if align not in ALIGN:
            faults.append(f"--align: one of {', '.join(ALIGN)}, not {short_repr(align)}")
        ball = length("probe_radius", options["probe_radius"]) if "probe_radius" in options else None
        face = length("probe_face", options["probe_face"]) if "probe_face" in options else None
        if face is not None and ball is not None:
            faults.append("--probe-face: a probe has a face or a radius: leave one of them out")
        error = length("probe_error", options["probe_error"]) if "probe_error" in options else None
        axes = None
        if "axes_error" in options:
            value = options["axes_error"]
            cells = [str(cell) for cell in value] if isinstance(value, (tuple, list)) else str(value).split(",")
            try:
                shift = read_quantity(cells[0], recipe.units) * recipe.mm
                (turn,) = [float(cell) for cell in cells[1:]]
            except (Complaint, ValueError):
                shift = turn = math.nan
            if 0.0 <= shift <= MOST_LENGTH and 0.0 <= turn <= 180.0:
                axes = shift, math.radians(turn)
            else:
                faults.append(
                    f"--axes-error: a length and an angle in degrees, such as 0.005,0.02, not {short_repr(value)}"
                )
        spans = None
        if "spans" in options:
            text = str(options["spans"])
            if re.fullmatch(r"[0-9]{1,6}", text):
                spans = int(text)
            else:
                faults.append(f"--spans: a whole number from 12 is expected, not {short_repr(text)}")
        out = options.get("out")
        if out is not None and not str(out):
            faults.append("--out: an empty name")
        if faults:
            raise CallError(*faults)
        return Call(Probing(ALIGN[align], ball, face, units), error, axes, spans, None if out is None else str(out))


@dataclass(frozen=True, eq=False)
class OnSurface:
    """Points on one surface (n), and where they come from.

    points         held against the surface's exact contour
    files, lines   of each point: place of its file among those of the call, and its line (n,)
    repeats        points that were averaged into these; as many as these where none was
    spread         standard deviation of repeats about their mean, mm; None without any
    """

    surface: SurfaceIntent
    points: SurfacePoints
    files: Indices
    lines: Indices
    repeats: int
    spread: float | None = None


def tables_of(paths: Sequence[Path]) -> list[PointTable]:
    """Read all files; raises CallError for a file that holds no points."""
    tables, faults = [], []
    for path in paths:
        try:
            tables.append(read_points(path))
        except ReadError as error:
            faults.append(f"{escaped(str(path))}: {error.message}")
    if faults:
        raise CallError(*faults)
    return tables


def disc_of(path: Path, place: int, discs: int) -> int:
    """Index of the disc that a file is of, from 0: the end of its name, `-1` or `-2`, else its place in the call.

    Raises CallError where the cam has no such disc.
    """
    ending = re.fullmatch(r".+-([1-9])", path.stem)
    number = int(ending[1]) - 1 if ending else place
    if not 0 <= number < discs:
        raise CallError(f"{escaped(str(path))}: the cam has {discs} discs; name the files NAME-1.csv and NAME-2.csv")
    return number


def places_of(table: PointTable, scale: float, *, mirrored: bool) -> tuple[Array, Array | None]:
    """Points (n, 2), mm, and normals of a table, in the drawing's axes as if that were not mirrored."""
    sign = np.array([1.0, -1.0 if mirrored else 1.0])
    columns = table.columns
    places = np.column_stack([columns["x"], columns["y"]]) * (scale * sign)
    if "nx" not in columns:
        return places, None
    directions = np.column_stack([columns["nx"], columns["ny"]]) * sign
    return places, directions / np.hypot(directions[:, 0], directions[:, 1])[:, None]


def sorted_out(part: PartIntent, pieces: Sequence[tuple[int, PointTable, float]], probing: Probing) -> list[OnSurface]:
    """Give each surface of a disc its points, by a column that names it or by the nearest; repeats are averaged."""
    surfaces = []
    gathered: dict[str, list[tuple[Array, Array | None, Indices, Indices]]] = {s.name: [] for s in part.surfaces}
    for file, table, scale in pieces:
        places, directions = places_of(table, scale, mirrored=part.mirrored)
        owner = _owners(part, table, places)
        for rank, surface in enumerate(part.surfaces):
            own = owner == rank
            if own.any():
                chosen = None if directions is None else directions[own]
                gathered[surface.name].append((places[own], chosen, np.full(own.sum(), file), table.lines[own]))
    for surface in part.surfaces:
        rows = gathered[surface.name]
        if not rows:
            raise CallError(f"no point is on the {surface.name or 'contour'}: measure it too")
        normals = [row[1] for row in rows]
        directions = None if any(n is None for n in normals) else np.concatenate([n for n in normals if n is not None])
        places, files, lines = (np.concatenate([row[k] for row in rows]) for k in (0, 2, 3))
        points = SurfacePoints(surface.gauge, surface.side, places, probing.ball or 0.0, directions)
        surfaces.append(OnSurface(surface, points, files, lines, len(points)))
    return surfaces


def label_of(name: str) -> str:
    """The name of a surface as tables have it."""
    return name.strip().lower().replace(" ", "_")


def _owners(part: PartIntent, table: PointTable, places: Array) -> Indices:
    """Index (n,) of the surface that each point is on, by its label, else by the least distance.

    Raises CallError for a label that is no surface.
    """
    names = [label_of(surface.name) for surface in part.surfaces]
    labels = [label_of(label) for label in table.labels]
    if len(names) == 1:
        return np.zeros(len(places), dtype=np.intp)
    if labels and set(labels) <= set(names):
        return np.array([names.index(label) for label in labels], dtype=np.intp)
    if labels:
        raise CallError(
            f"its column names {', '.join(sorted(set(labels) - set(names)))}; surfaces are {', '.join(names)}"
        )
    off = [np.abs(surface.gauge.envelope.feet(places).excess) for surface in part.surfaces]
    owner: Indices = np.argmin(off, axis=0)
    return owner


def averaged(surface: OnSurface) -> OnSurface:
    """Points with those that were measured again at one place taken together."""
    deviations = surface.points.deviations
    turn = np.mod(deviations.parameter, 2.0 * np.pi)
    order = np.argsort(turn, kind="stable")
    new = np.diff(turn[order], prepend=-1.0) > REPEATED * 2.0 * np.pi / len(order)
    group = np.empty(len(order), dtype=np.intp)
    group[order] = np.cumsum(new) - 1
    if turn[order[0]] + 2.0 * np.pi - turn[order[-1]] <= REPEATED * 2.0 * np.pi / len(order):  # across the zero
        group[group == group.max()] = 0
    count = np.bincount(group)
    if len(count) > FEWER * len(order):
        return surface
    means = np.column_stack([np.bincount(group, column) / count for column in surface.points.places.T])
    directions = None
    if surface.points.directions is not None:
        sums = np.column_stack([np.bincount(group, column) for column in surface.points.directions.T])
        directions = sums / np.hypot(sums[:, 0], sums[:, 1])[:, None]
    mean = np.bincount(group, deviations.e) / count
    free = len(order) - len(count)
    spread = math.sqrt(float(((deviations.e - mean[group]) ** 2).sum()) / free)
    first = np.full(len(count), len(order), dtype=np.intp)
    np.minimum.at(first, group, np.arange(len(order)))
    points = SurfacePoints(
        surface.points.follower, surface.points.side, means, surface.points.ball, directions, surface.points.placing
    )
    return OnSurface(surface.surface, points, surface.files[first], surface.lines[first], len(order), spread)
