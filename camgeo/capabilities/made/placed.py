"""Points of the surfaces of a part, out of the files that hold them: in the drawing's axes, placed as a call asks."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from camgeo.capabilities.made.reading import OnSurface, averaged, disc_of, label_of, sorted_out, tables_of
from camgeo.common.errors import CallError
from camgeo.measures.units import UNIT_NAMES
from camgeo.synthesis.intent import intents
from kin.law.contacts import Flat, KnifeEdge, Roller
from kin.made.points import Placing, UnlikePointsError, demand_alike, demand_round, settled, turned_at
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from camgeo.capabilities.made.reading import Probing
    from camgeo.recipe.recipe import Recipe
    from camgeo.synthesis.design import Design
    from kin.judge.intent import PartIntent
    from kin.law.contacts import Touch
    from kin.made.lifts import Lifts, Readings
    from kin.read.points import PointTable

BORE = 0.05  # of its diameter: points so near to it are on the bore
LIFT_KINDS = "a lift is of a cam with one surface and one contact; give points x,y of this one"


@dataclass(frozen=True, eq=False)
class DiscPoints:
    """Points of one disc.

    surfaces   each of its surfaces with its points; empty where no file is of this disc
    placing    turn and shift that were taken out (`align`)
    turned     known turn of the disc, rad: its points are placed by it too
    """

    part: PartIntent
    surfaces: tuple[OnSurface, ...] = ()
    placing: Placing = Placing()
    turned: float = 0.0


@dataclass(frozen=True, eq=False)
class Points:
    """Points of a part.

    every      each disc of the part
    lifts      zero of the readings, mm or rad, and by how much they are late and turned back, rad, of lifts alone
    remarks    sentences
    unit       mm in the unit of the files
    """

    every: tuple[DiscPoints, ...]
    lifts: tuple[float, float] | None
    remarks: tuple[str, ...]
    unit: float

    @property
    def discs(self) -> tuple[DiscPoints, ...]:
        """Discs of the part that have points."""
        return tuple(disc for disc in self.every if disc.surfaces)

    @property
    def missing(self) -> tuple[DiscPoints, ...]:
        """Discs of the part without points."""
        return tuple(disc for disc in self.every if not disc.surfaces)


def points_of(recipe: Recipe, design: Design, paths: Sequence[Path], probing: Probing, first: int = 0) -> Points:
    """Points of a part, out of files of which the first is the `first` of several calls, counted from 0.

    Raises CallError for what is no file of points, and as kin does for points that are not on its contours.
    """
    return points_of_tables(recipe, design, list(zip(paths, tables_of(paths), strict=True)), probing, first)


def points_of_tables(
    recipe: Recipe, design: Design, files: Sequence[tuple[Path, PointTable]], probing: Probing, first: int = 0
) -> Points:
    """Points of a part, out of files and their tables, as `points_of`."""
    parts, tables = intents(recipe, design), [table for _, table in files]
    scale, remarks = scale_of(recipe, tables, probing.units)
    if any(table.measured == "lift" for table in tables):
        lifts, placed = _of_lifts(parts, tables, scale, probing)
        turned = 0.0 if probing.align else lifts.late
        whole = _disc(recipe, parts[0], placed, replace(probing, align="", alone=turned))
        return Points((whole,), (lifts.zero, lifts.late - turned), tuple(remarks), scale)
    if probing.face is not None:
        raise CallError("a face is of an indicator, and these are places: leave it out; a ball has a radius")
    pieces: list[list[tuple[int, PointTable, float]]] = [[] for _ in parts]
    names = [[surface.name for surface in part.surfaces] for part in parts]
    for place, (path, table) in enumerate(files):
        for disc, rows in by_disc(names, table, path, first + place):
            pieces[disc].append((place, rows, scale))
    discs = [
        _disc(recipe, part, sorted_out(part, piece, probing), probing) if piece else DiscPoints(part)
        for part, piece in zip(parts, pieces, strict=True)
    ]
    return Points(tuple(discs), None, tuple(remarks), scale)


def by_disc(names: Sequence[Sequence[str]], table: PointTable, path: Path, place: int) -> list[tuple[int, PointTable]]:
    """Rows of a file by disc index: by the surface that each row names, else by the file's name or place."""
    owners = {label_of(name): rank for rank, own in enumerate(names) for name in own}
    labels = [label_of(label) for label in table.labels]
    if len(names) == 1:
        return [(0, table)]
    if not labels or not all(labels) or not set(labels) <= set(owners):
        return [(disc_of(path, place, len(names)), table)]
    rank = np.array([owners[label] for label in labels])
    return [(disc, table.rows(rank == disc)) for disc in sorted(set(rank.tolist()))]


def name_of(part: PartIntent) -> str:
    """Name of one of several discs, that of its surface, such as `disc 2`; empty where a part is the only one."""
    return part.surfaces[0].name if len(part.surfaces) == 1 else part.name


def demand_discs(missing: Sequence[DiscPoints]) -> None:
    """Raise CallError where there are discs without points."""
    demand_points([name_of(disc.part) for disc in missing])


def demand_points(missing: Sequence[str]) -> None:
    """Raise CallError where there are surfaces, by their names, without points."""
    if missing:
        raise CallError(f"points of {' and '.join(missing)} are missing: give a file for each disc")


def _disc(recipe: Recipe, part: PartIntent, surfaces: Sequence[OnSurface], probing: Probing) -> DiscPoints:
    """Place the points of a disc by the unknowns of `align`, and average those that were measured again."""
    _demand_outside(recipe, surfaces)
    align = probing.align
    placing, turned = Placing(), probing.alone or 0.0
    points = [surface.points.placed(Placing(turned)) for surface in surfaces]
    demand_round(points)
    if align:
        placing = turned_at(points, "g")
        if align != "g":
            placing = settled([surface.placed(placing) for surface in points], align)
        points = [surface.placed(placing) for surface in points]
    demand_alike(points, aligned=bool(align), shiftable=probing.alone is None)
    placed = [averaged(replace(surface, points=own)) for surface, own in zip(surfaces, points, strict=True)]
    return DiscPoints(part, tuple(placed), placing, turned)


def scale_of(recipe: Recipe, tables: Sequence[PointTable], units: float | None) -> tuple[float, list[str]]:
    """Mm in a unit of the points: what their headings state, else what is given, else the recipe's with a remark."""
    stated = {table.unit for table in tables if table.unit is not None}
    if len(stated) > 1:
        raise CallError("the files are in different units: give each in a call of its own")
    if stated and units is not None and abs(next(iter(stated)) / units - 1.0) > 1e-9:
        raise CallError(f"a heading states a unit of {next(iter(stated)):.6g} mm; leave --units out")
    if stated or units is not None:
        return next(iter(stated), units or 1.0), []
    return recipe.mm, [f"no heading states a unit: the points are taken in that of the recipe, {recipe.units}; --units"]


def _of_lifts(
    parts: Sequence[PartIntent], tables: Sequence[PointTable], scale: float, probing: Probing
) -> tuple[Lifts, list[OnSurface]]:
    """Lifts of an indicator, and their points on the surface."""
    from kin.made.lifts import points_of_lifts

    readings = readings_of(parts, tables, scale, probing)
    lifts = points_of_lifts(readings, aligned=bool(probing.align), alone=bool(probing.alone))
    files = np.concatenate([np.full(len(table), i) for i, table in enumerate(tables)])
    lines = np.concatenate([table.lines for table in tables])
    return lifts, [OnSurface(parts[0].surfaces[0], lifts.points, files, lines, len(lines))]


def readings_of(parts: Sequence[PartIntent], tables: Sequence[PointTable], scale: float, probing: Probing) -> Readings:
    """Lifts of an indicator as tables have them; raises CallError where there are others among them."""
    from kin.made.lifts import Readings

    surface = parts[0].surfaces[0]
    single = len(parts) == 1 and len(parts[0].surfaces) == 1 and len(surface.gauge.contacts) == 1
    if not single or parts[0].linkage is not None:
        raise CallError(LIFT_KINDS)
    if any(table.measured != "lift" for table in tables):
        raise CallError("some files have lifts and others places: give them in calls of their own")
    if probing.align == "gxy":
        raise CallError("lifts tell no shift: --align rotation is all that they can be placed by")
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


def _demand_outside(recipe: Recipe, points: Sequence[OnSurface]) -> None:
    """Raise UnlikePointsError for points of the bore."""
    bore = recipe.part.bore
    radius = np.concatenate([np.hypot(surface.points.places[:, 0], surface.points.places[:, 1]) for surface in points])
    if bore is not None and abs(2.0 * float(np.median(radius)) / bore - 1.0) <= BORE:
        across = f"{bore / recipe.mm:.6g} {UNIT_NAMES[recipe.units]} across"
        raise UnlikePointsError(f"the points lie on the bore, {across}: measure the contour")
