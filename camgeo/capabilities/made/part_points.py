"""Points of a part, out of the files that hold them: on its surfaces, in the drawing's axes, placed as `align` says."""

from __future__ import annotations

import math
import re
from typing import TYPE_CHECKING

import numpy as np

from camgeo.common.errors import CallError
from camgeo.common.terminal import escaped
from camgeo.measures.units import UNIT_NAMES
from camgeo.schema.file_bytes import path_fault
from camgeo.synthesis.intent import intents
from kin.law.contacts import Flat, KnifeEdge, Roller
from kin.made.points import (
    Placing,
    SurfacePoints,
    UnlikePointsError,
    demand_alike,
    demand_round,
    settled,
    turned_at,
)
from kin.numeric.angles import TURN
from kin.numeric.records import dataclass, replace
from kin.read.errors import ReadError
from kin.read.points import read_points

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from camgeo.capabilities.made.options import Probing
    from camgeo.recipe.recipe import Recipe
    from camgeo.synthesis.design import Design
    from kin.follower.base import Follower as Gauge
    from kin.judge.intent import PartIntent, SurfaceIntent
    from kin.law.contacts import Touch
    from kin.made.lifts import Lifts, Readings
    from kin.made.points import Deviations
    from kin.numeric.arrays import Array, Indices
    from kin.read.points import PointTable

REPEATED = 0.02  # of the mean step between points: points that are nearer are one place, measured again
FEWER = 0.8  # of the points: with more places than this nothing was measured again on purpose
BORE = 0.05  # of its diameter: points so near to it are on the bore
LIFT_KINDS = "a lift is of a cam with one surface and one contact; give points x,y of this one"
MIXED = "some files have lifts and others places: give them in calls of their own"
NO_SHIFT = "lifts tell no shift: --align rotation is all that they can be placed by"


@dataclass(frozen=True, eq=False)
class MeasuredSurface:
    """Points on one surface (n), and where they come from.

    intent         the surface as intended
    points         the points, with the exact contour from which they deviate
    files, lines   index of each point's file in the call, and its line (n,); of a mean those of its first point
    repeats        number of points before those of one place were averaged
    spread         standard deviation of repeats about their means, mm; None where none were averaged
    """

    intent: SurfaceIntent
    points: SurfacePoints
    files: Indices
    lines: Indices
    repeats: int
    spread: float | None = None

    @property
    def gauge(self) -> Gauge:
        """Follower of the surface, by which its exact contour and its motion are known."""
        return self.intent.gauge

    @property
    def deviations(self) -> Deviations:
        """Deviations of the points from the exact contour."""
        return self.points.deviations


@dataclass(frozen=True, eq=False)
class DiscPoints:
    """Points of one disc.

    part       the disc as intended
    surfaces   each of its surfaces with its points
    placing    turn and shift that `align` took out
    turned     known turn of the disc, rad, which is taken out of the points too
    """

    part: PartIntent
    surfaces: tuple[MeasuredSurface, ...] = ()
    placing: Placing = Placing()
    turned: float = 0.0


@dataclass(frozen=True, eq=False)
class PartPoints:
    """Points of a part.

    discs      each disc of the part that has points
    missing    names of its discs without points
    lifts      zero of the readings, mm or rad, and the lateness that was taken out, rad; None for points x, y
    remarks    sentences for the report
    unit       mm in the unit of the files
    """

    discs: tuple[DiscPoints, ...]
    missing: tuple[str, ...]
    lifts: tuple[float, float] | None
    remarks: tuple[str, ...]
    unit: float


def read_tables(paths: Sequence[Path]) -> list[tuple[Path, PointTable]]:
    """Path and table of each file; raises CallError, with a line for each file that holds no points."""
    tables, faults = [], []
    for path in paths:
        fault = path_fault(path)
        try:
            if not fault:
                tables.append((path, read_points(path)))
        except ReadError as error:
            fault = error.message
        if fault:
            faults.append(f"{escaped(str(path))}: {fault}")
    if faults:
        raise CallError(*faults)
    return tables


def part_points(
    recipe: Recipe, design: Design, files: Sequence[tuple[Path, PointTable]], probing: Probing, first: int = 0
) -> PartPoints:
    """Points of a part, out of files and their tables, by disc and surface, and placed as `probing` says.

    `first` is the rank of the first file among those of a run, from 0: a file without a number in its name belongs to
    the disc of its rank. Raises CallError for files that do not go together or with the part, UnlikePointsError for
    points that are not on its contours, UnsettledError where the foot of a point is not found.
    """
    parts, tables = intents(recipe, design), [table for _, table in files]
    scale, remarks = scale_of(recipe, tables, probing.units)
    # lifts have a lateness of their own; without `align` it is given as a turn and put back
    if any(table.measured == "lift" for table in tables):
        lifts, surfaces = _lift_points(parts, tables, scale, probing)
        turned = 0.0 if probing.align else lifts.late
        whole = _placed_disc(recipe, parts[0], surfaces, replace(probing, align="", turned=turned))
        return PartPoints((whole,), (), (lifts.zero, lifts.late - turned), tuple(remarks), scale)
    if probing.face is not None:
        raise CallError("a face is of an indicator, and these are places: leave it out; a ball has a radius")
    pieces: list[list[tuple[int, PointTable]]] = [[] for _ in parts]
    names = [[surface.name for surface in part.surfaces] for part in parts]
    for index, (path, table) in enumerate(files):
        for disc, rows in by_disc(names, table, path, first + index):
            pieces[disc].append((index, rows))
    discs = [
        _placed_disc(recipe, part, surface_points(part, piece, scale, probing), probing)
        for part, piece in zip(parts, pieces, strict=True)
        if piece
    ]
    missing = [name_of(part) for part, piece in zip(parts, pieces, strict=True) if not piece]
    return PartPoints(tuple(discs), tuple(missing), None, tuple(remarks), scale)


def name_of(part: PartIntent) -> str:
    """Name of a disc: of its only surface, such as `disc 2`, else its own; empty where a part has one disc."""
    return part.surfaces[0].name if len(part.surfaces) == 1 else part.name


def demand_points(missing: Sequence[str]) -> None:
    """Raise CallError where names of surfaces without points are given."""
    if missing:
        raise CallError(f"points of {' and '.join(missing)} are missing: give a file for each disc")


def scale_of(recipe: Recipe, tables: Sequence[PointTable], units: float | None) -> tuple[float, list[str]]:
    """Mm in a unit of the points, and remarks: the unit that headings state, else `units`, else the recipe's.

    There is a remark only where the recipe's unit is taken. `units` is in mm. Raises CallError where headings state
    different units, or another unit than `units`.
    """
    stated = {table.unit for table in tables if table.unit is not None}
    if len(stated) > 1:
        raise CallError("the files are in different units: give each in a call of its own")
    if stated and units is not None and abs(next(iter(stated)) / units - 1.0) > 1e-9:
        raise CallError(f"a heading states a unit of {next(iter(stated)):.6g} mm; leave --units out")
    if stated or units is not None:
        return next(iter(stated), units or 1.0), []
    taken = f"no heading states a unit: the points are taken in that of the recipe, {recipe.units}"
    return recipe.mm, [f"{taken}; another is given by --units"]


# --- which disc and surface a point is on -----------------------------------------------------------------------------


def label_of(name: str) -> str:
    """A name as tables have it: lower case, with underscores for blanks."""
    return name.strip().lower().replace(" ", "_")


def by_label(names: Sequence[str], table: PointTable) -> Indices | None:
    """Index (n,) of each point's surface by its label among names; None where labels are missing or name no surface."""
    ranks = {label_of(name): rank for rank, name in enumerate(names)}
    labels = [label_of(label) for label in table.labels]
    if not labels or not set(labels) <= set(ranks):
        return None
    return np.array([ranks[label] for label in labels], dtype=np.intp)


def by_disc(names: Sequence[Sequence[str]], table: PointTable, path: Path, place: int) -> list[tuple[int, PointTable]]:
    """Pairs of a disc's index and its rows of a file, by the surface that each row names, else by the file.

    `names` has the names of each disc's surfaces. A file belongs to the disc of the number that ends its name, else of
    its `place` in the call, from 0. Raises CallError where the cam has no such disc.
    """
    if len(names) == 1:
        return [(0, table)]
    surface = by_label([name for own in names for name in own], table)
    if surface is None:
        return [(_disc_of_file(path, place, len(names)), table)]
    disc = np.repeat(np.arange(len(names)), [len(own) for own in names])[surface]
    return [(rank, table.rows(disc == rank)) for rank in sorted(set(disc.tolist()))]


def _disc_of_file(path: Path, place: int, discs: int) -> int:
    """Index of the disc of a file, from 0: by the end of its name, `-1` or `-2`, else by its place in the call.

    Raises CallError where the cam has no such disc.
    """
    ending = re.fullmatch(r".+-([1-9])", path.stem)
    number = int(ending[1]) - 1 if ending else place
    if not 0 <= number < discs:
        raise CallError(f"{escaped(str(path))}: the cam has {discs} discs; name the files NAME-1.csv and NAME-2.csv")
    return number


def places_of(table: PointTable, scale: float, *, mirrored: bool) -> tuple[Array, Array | None]:
    """Points (n, 2), mm, of a table in units of `scale` mm, and unit normals (n, 2) or None, as if not mirrored.

    `mirrored` says that the table is, as of a cam with `rotation: ccw`: then y changes its sign.
    """
    sign = np.array([1.0, -1.0 if mirrored else 1.0])
    columns = table.columns
    places = np.column_stack([columns["x"], columns["y"]]) * (scale * sign)
    if "nx" not in columns:
        return places, None
    directions = np.column_stack([columns["nx"], columns["ny"]]) * sign
    return places, directions / np.hypot(directions[:, 0], directions[:, 1])[:, None]


def surface_points(
    part: PartIntent, pieces: Sequence[tuple[int, PointTable]], scale: float, probing: Probing
) -> list[MeasuredSurface]:
    """Points of each surface of a disc, told apart by a column that names it or by the nearest surface.

    `pieces` are the tables of the disc, each with the index of its file, in units of `scale` mm. Raises CallError for a
    label that is no surface, and for a surface without points.
    """
    surfaces = []
    gathered: dict[str, list[tuple[Array, Array | None, Indices, Indices]]] = {s.name: [] for s in part.surfaces}
    for file, table in pieces:
        places, directions = places_of(table, scale, mirrored=part.mirrored)
        owner = _surface_of_each(part, table, places)
        for rank, surface in enumerate(part.surfaces):
            own = owner == rank
            if own.any():
                chosen = None if directions is None else directions[own]
                gathered[surface.name].append((places[own], chosen, np.full(own.sum(), file), table.lines[own]))
    for surface in part.surfaces:
        rows = gathered[surface.name]
        if not rows:
            raise CallError(f"no point is on the {surface.name or 'contour'}: measure it too")
        places, directions = joined([row[:2] for row in rows])
        files, lines = (np.concatenate([row[k] for row in rows]) for k in (2, 3))
        points = SurfacePoints(surface.gauge, surface.side, places, probing.ball or 0.0, directions)
        surfaces.append(MeasuredSurface(surface, points, files, lines, len(points)))
    return surfaces


def joined(pieces: Sequence[tuple[Array, Array | None]]) -> tuple[Array, Array | None]:
    """Places (n, 2) of several pieces, one after the other, and their normals (n, 2); None where a piece has none."""
    normals = [normal for _, normal in pieces if normal is not None]
    return np.concatenate([places for places, _ in pieces]), (
        np.concatenate(normals) if len(normals) == len(pieces) else None
    )


def _surface_of_each(part: PartIntent, table: PointTable, places: Array) -> Indices:
    """Index (n,) of the surface that each point is on, by its label, else by the least distance.

    Raises CallError for a label that is no surface.
    """
    names = [surface.name for surface in part.surfaces]
    if len(names) == 1:
        return np.zeros(len(places), dtype=np.intp)
    if (owner := by_label(names, table)) is not None:
        return owner
    if table.labels:
        known = [label_of(name) for name in names]
        unknown = sorted({label_of(label) for label in table.labels} - set(known))
        raise CallError(f"its column names {', '.join(unknown)}; surfaces are {', '.join(known)}")
    off = [np.abs(surface.gauge.envelope.feet(places).excess) for surface in part.surfaces]
    nearest: Indices = np.argmin(off, axis=0)
    return nearest


# --- placed and averaged ----------------------------------------------------------------------------------------------


def _placed_disc(recipe: Recipe, part: PartIntent, surfaces: Sequence[MeasuredSurface], probing: Probing) -> DiscPoints:
    """Place the points of a disc by the unknowns of `align`, and average those that were measured again.

    Raises UnlikePointsError for points that are on the bore, do not go round the shaft, or are not of this contour.
    """
    _demand_not_on_bore(recipe, surfaces)
    # a known turn first, then that of best likeness, then turn and shifts by least squares
    align = probing.align
    placing, turned = Placing(), probing.turned or 0.0
    points = [surface.points.placed(Placing(turned)) for surface in surfaces]
    demand_round(points)
    on_metal = [own.on_metal for own in points]
    if align:
        placing = turned_at(on_metal, "g")
        if align != "g":
            placing = settled([own.placed(placing) for own in on_metal], align)
        points, on_metal = ([own.placed(placing) for own in some] for some in (points, on_metal))
    demand_alike(on_metal, aligned=bool(align), shiftable=probing.turned is None)
    averages = [_average_repeats(replace(surface, points=own)) for surface, own in zip(surfaces, points, strict=True)]
    return DiscPoints(part, tuple(averages), placing, turned)


def _demand_not_on_bore(recipe: Recipe, surfaces: Sequence[MeasuredSurface]) -> None:
    """Raise UnlikePointsError where the points lie on the bore in place of a contour."""
    bore = recipe.part.bore
    radius = np.concatenate([np.hypot(*surface.points.places.T) for surface in surfaces])
    if bore is not None and abs(2.0 * float(np.median(radius)) / bore - 1.0) <= BORE:
        across = f"{bore / recipe.mm:.6g} {UNIT_NAMES[recipe.units]} across"
        raise UnlikePointsError(f"the points lie on the bore, {across}: measure the contour")


def _average_repeats(surface: MeasuredSurface) -> MeasuredSurface:
    """Points whose repeats at one place are averaged; the points as they are where hardly any were measured again."""
    # a group is a run of points whose feet are hardly apart
    turn = np.mod(surface.deviations.parameter, TURN)
    order = np.argsort(turn, kind="stable")
    apart = REPEATED * TURN / len(order)
    new = np.diff(turn[order], prepend=-1.0) > apart
    group = np.empty(len(order), dtype=np.intp)
    group[order] = np.cumsum(new) - 1
    if turn[order[0]] + TURN - turn[order[-1]] <= apart:  # across the zero
        group[group == group.max()] = 0
    count = np.bincount(group)
    if len(count) > FEWER * len(order):
        return surface
    # means of places and normals, and the scatter of the deviations about the mean of each group
    points, e = surface.points, surface.deviations.e
    means = np.column_stack([np.bincount(group, column) / count for column in points.places.T])
    directions = None
    if points.directions is not None:
        sums = np.column_stack([np.bincount(group, column) for column in points.directions.T])
        directions = sums / np.hypot(sums[:, 0], sums[:, 1])[:, None]
    mean = np.bincount(group, e) / count
    spread = math.sqrt(float(((e - mean[group]) ** 2).sum()) / (len(order) - len(count)))
    first = np.full(len(count), len(order), dtype=np.intp)
    np.minimum.at(first, group, np.arange(len(order)))
    averages = SurfacePoints(points.follower, points.side, means, points.ball, directions, points.placing)
    return MeasuredSurface(surface.intent, averages, surface.files[first], surface.lines[first], len(order), spread)


# --- lifts of an indicator --------------------------------------------------------------------------------------------


def _lift_points(
    parts: Sequence[PartIntent], tables: Sequence[PointTable], scale: float, probing: Probing
) -> tuple[Lifts, list[MeasuredSurface]]:
    """Lifts of an indicator, and their points on the cam's only surface.

    Raises UnlikePointsError for lifts of something else, CallError for lifts that do not go with the part, or with the
    way they were measured.
    """
    from kin.made.lifts import points_of_lifts

    readings = readings_of(parts, tables, scale, probing)
    lifts = points_of_lifts(readings, aligned=bool(probing.align), alone=bool(probing.turned))
    files = np.concatenate([np.full(len(table), i) for i, table in enumerate(tables)])
    lines = np.concatenate([table.lines for table in tables])
    return lifts, [MeasuredSurface(parts[0].surfaces[0], lifts.points, files, lines, len(lines))]


def readings_of(parts: Sequence[PartIntent], tables: Sequence[PointTable], scale: float, probing: Probing) -> Readings:
    """Readings of an indicator, from tables of lifts in units of `scale` mm; swings are degrees.

    Raises CallError for a cam of several contacts or with a linkage, for places among the lifts, `align` of shifts,
    lifts in degrees of a follower on a stem, and a flat indicator elsewhere than on a stem outside the cam.
    """
    from kin.made.lifts import Readings

    surface = parts[0].surfaces[0]
    single = len(parts) == 1 and len(parts[0].surfaces) == 1 and len(surface.gauge.contacts) == 1
    if not single or parts[0].linkage is not None:
        raise CallError(LIFT_KINDS)
    if any(table.measured != "lift" for table in tables):
        raise CallError(MIXED)
    if probing.align == "gxy":
        raise CallError(NO_SHIFT)
    shaft = np.radians(np.concatenate([table.columns["angle"] for table in tables]))
    lift = np.concatenate([table.columns["lift"] for table in tables])
    halved = any(table.turns_of == "crank" for table in tables)
    swings = surface.gauge.unit == "deg"
    if not swings and any(table.degrees for table in tables):
        raise CallError("its lifts are in degrees, and the follower of this cam does not swing")
    lift = np.radians(lift) if swings else lift * scale
    touch: Touch | None = None
    if probing.face is not None:
        if swings or surface.side < 0:
            raise CallError("an indicator with a flat face is one on the line of a stem, outside the cam")
        touch = Flat(width=probing.face)
    elif probing.ball is not None:
        touch = Roller(probing.ball) if probing.ball else KnifeEdge()
    return Readings(surface.gauge, surface.side, shaft, lift, touch, halved)
