"""Contour of the cam on a page: as the files draw it, the exact one, and the distance between both."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from camgeo.curve.ring import Ring
from camgeo.report.page.scene import STEPS
from kin.numeric.angles import TURN
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from camgeo.curve.curve import Curve
    from camgeo.measures.file_result import FileResult
    from camgeo.recipe.recipe import Recipe
    from camgeo.synthesis.design import Design, SurfaceDesign
    from kin.contour.arcs import Arcs
    from kin.contour.contour import Contour
    from kin.numeric.arrays import Array

POINTS = 1440  # of an exact contour
MOST_PIECES = 1600  # of a file's contour that a page draws; of more, every second or third node
ROUNDING = 1e-12  # of the contour's size: an error below this is none
FINE = 1e-5  # of the contour's size: to this a spline is drawn
MEASURED = 1e-3  # of the tolerance: to this its error is measured, as far as rounding lets it be
PER_PIECE = 6  # places of a file's piece at which its error is looked at, as far as `MOST_LOOKS` goes
MOST_LOOKS = 6  # for each step of the turn


def exact(curve: Curve, *, whole: bool = False) -> Ring:
    """Return a curve as a ring of about `POINTS` points; with `whole` it keeps the loops that trimming takes away."""
    period = curve.shape.period
    runs = [(0.0, period)] if whole else [(run.low, run.high) for run in curve.runs]
    points = []
    for low, high in runs:
        count = max(2, math.ceil(POINTS * (high - low) / period))
        points.append(curve.sample(low + (high - low) * np.arange(count) / count).point)
        if not curve.closed:
            points.append(curve.sample(np.array([high]), -1).point)
    return Ring.through(np.concatenate(points))


@dataclass(frozen=True, eq=False)
class FileContours:
    """Contours read from a file, mm, for a shaft that turns clockwise.

    `contours` and `arcs` are by the names of the surfaces, `pieces` is the number of all pieces. `rings` are for
    drawing: of each disc in the file its outline and holes; the contour of a ring is a hole. `tolerance`, mm, is the
    file's. `disc` is the disc that the file holds, counted from 0, None for all.
    """

    name: str
    contours: dict[str, Contour]
    arcs: dict[str, Arcs]
    pieces: int
    rings: tuple[tuple[Ring, ...], ...]
    tolerance: float
    disc: int | None = None


def contours_of(recipe: Recipe, file: FileResult) -> FileContours | None:
    """Contours that the judge read from a drawing or a solid; None where it read none, which a check reports."""
    contours = {surface.name: surface.contour for surface in file.surfaces if surface.contour is not None}
    if not contours:
        return None
    size = max(float(np.abs(contour.vertices).max()) for contour in contours.values())
    fine = max(MEASURED * recipe.export.tolerance, ROUNDING * size)
    arcs = {name: contour.as_arcs(fine)[0] for name, contour in contours.items()}
    rings = tuple(tuple(_drawing_ring(arcs_read.as_arcs(FINE * size)[0]) for arcs_read in body) for body in file.bodies)
    tolerance = recipe.export.tolerance if file.tolerance is None else file.tolerance
    return FileContours(file.path.name, contours, arcs, sum(map(len, contours.values())), rings, tolerance, file.disc)


def group_files(files: Sequence[FileContours], discs: int) -> list[list[FileContours]]:
    """Groups of files that show the whole cam: one file with all discs, or successive files of each of `discs` discs.

    Files of an incomplete group are left out.
    """
    groups: list[list[FileContours]] = []
    for file in files:
        if file.disc and groups and groups[-1][-1].disc == file.disc - 1:
            groups[-1].append(file)
        elif not file.disc:
            groups.append([file])
    return [group for group in groups if group[0].disc is None or len(group) == discs]


def _drawing_ring(arcs: Arcs) -> Ring:
    step = -(-len(arcs) // MOST_PIECES)
    if step > 1:
        return Ring.through(arcs.start[::step])
    return Ring(arcs.start, np.tan(0.25 * arcs.curvature * arcs.length))


@dataclass(frozen=True, eq=False)
class Exact:
    """The exact contour where it is touched at equal steps of the angle between cam and frame.

    Each of the `STEPS` steps of a turn has `per` of them.
    `point`, mm, and `normal` are (STEPS * per, 2); `radius` of curvature, mm, and `curvature`, 1/mm, (STEPS * per,) are
    of the base curve, the pitch curve of a roller; `kept` is true at points that belong to the made contour.
    """

    per: int
    point: Array
    normal: Array
    radius: Array
    curvature: Array
    kept: NDArray[np.bool_]

    @staticmethod
    def of(design: Design, surface: SurfaceDesign, per: int) -> Exact:
        """Sample the contour of one of a design's surfaces at `per` angles in each of `STEPS` steps."""
        shaft = TURN * np.arange(STEPS * per) / (STEPS * per)
        curve = surface.surface.curve
        t = next(iter(design.motion.parameters(shaft, shaft).values()))
        frame, base = curve.sample(t), surface.surface.base.sample(t)
        with np.errstate(divide="ignore", invalid="ignore"):
            radius = base.speed / base.turn
        is_kept = np.ones(len(t), dtype=np.bool_)
        if surface.trimmed and surface.contour is not None:
            inside = [np.mod(t - run.low, curve.shape.period) <= run.high - run.low for run in surface.contour.runs]
            is_kept = np.any(inside, axis=0)
        return Exact(per, frame.point, frame.normal, radius, base.curvature, is_kept)

    @staticmethod
    def looks(files: list[FileContours]) -> int:
        """Number of places in each step at which the errors of these files are measured, from 1 to `MOST_LOOKS`."""
        pieces = max((file.pieces for file in files), default=0)
        return min(MOST_LOOKS, max(1, math.ceil(PER_PIECE * pieces / STEPS)))

    def error(self, arcs: Arcs) -> tuple[Array, Array]:
        """Least and greatest distance of a file's contour from the exact contour in each step, mm, (STEPS,) each.

        It is above 0 where the file's contour lies outside, below 0 inside; nan where the exact contour is cut away.
        """
        from kin.contour.nearest import signed_distance

        off = np.full(len(self.point), np.nan)
        off[self.kept] = -signed_distance(arcs, self.point[self.kept])
        off[np.abs(off) < ROUNDING * np.abs(self.point).max()] = 0.0
        by_step = off.reshape(STEPS, self.per)
        empty = np.isnan(by_step).all(axis=1)
        by_step[empty] = 0.0
        low, high = np.nanmin(by_step, axis=1), np.nanmax(by_step, axis=1)
        low[empty], high[empty] = np.nan, np.nan
        return low, high
