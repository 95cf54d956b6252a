"""A list of points that CAD systems import as a curve: x, y, z on each line, the first point again at the end.

It is assumed that a CAD system draws the closed cubic spline whose parameter is the length of the chords. That spline
is read back from the file and judged as a contour. Without a step the points are as far apart as the tolerance allows.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from camgeo.common.rounding import upward
from camgeo.files.table import DIGITS
from camgeo.formats.extension import Table
from camgeo.formats.tables.tabled import check_step, fewest_rows
from camgeo.measures.file_result import FileResult
from camgeo.recipe.machining import FINEST
from kin.contour.closed_spline import closed_spline
from kin.numeric.angles import TURN
from kin.read.point_list import MOST_POINTS

if TYPE_CHECKING:
    from pathlib import Path

    from camgeo.curve.curve import Curve
    from camgeo.output.job import Job, MadeFiles
    from camgeo.recipe.export import FileRequest
    from camgeo.schema.reader import Reader, Values
    from kin.numeric.arrays import Array

SHARES = tuple(k / 10.0 for k in range(1, 10))  # of the way between two points, where the spline is looked at
FEET = 2  # steps to the foot of such a place on the contour
MARGIN = 0.95  # of the tolerance that an estimate may take: the judge has the last word
# coefficients of Bernstein's four cubics, a row each, by the powers 0 to 3
CUBIC = np.array([[1, -3, 3, -1], [0, 3, -6, 3], [0, 0, 3, -3], [0, 0, 0, 1]], dtype=float)


def check(file: Values, _: Values, reader: Reader) -> None:
    """Note a step that does not divide the turn, or makes more points than are read."""
    check_step(file, reader)
    if "step" in file and round(TURN / file["step"]) > MOST_POINTS:
        remedy = f"give {360.0 / MOST_POINTS:g} or more"
        reader.fault_at(f"{file['path']}.csv.step", f"more than {MOST_POINTS} points", None, remedy)


class _Points(NamedTuple):
    """The contour as points at equal steps of its parameter; with `sense` -1 mirrored about the x axis."""

    contour: Curve
    sense: float

    def at(self, shares: Array) -> tuple[Array, Array, Array]:
        """Points, unit normals, and derivatives of the points by the share, (n, 2) each, at shares (n,) of the turn."""
        (run,) = self.contour.runs
        width = run.high - run.low
        frame = self.contour.sample(run.low + width * shares)
        mirror = np.array([1.0, self.sense])
        return frame.point * mirror, frame.normal * mirror, (width * frame.speed)[:, None] * frame.tangent * mirror

    def error(self, count: int) -> float:
        """Greatest distance of the spline through so many points from the contour, mm: an estimate."""
        control, worst = closed_spline(self.at(np.arange(count) / count)[0]), 0.0
        for share in SHARES:
            weights = CUBIC @ share ** np.arange(4)
            places = (np.arange(count) + share) / count
            point, normal, rate = self.at(places)
            between = np.tensordot(control, weights, axes=(1, 0))
            for _ in range(FEET):  # Newton's steps along the contour to the foot of each place of the spline
                aside = np.sum((between - point) * rate, axis=1) / np.sum(rate * rate, axis=1)
                places = places + np.clip(aside, -0.5 / count, 0.5 / count)
                point, normal, rate = self.at(places)
            worst = max(worst, float(np.abs(np.sum((between - point) * normal, axis=1)).max()))
        return worst


def make(job: Job, request: FileRequest, path: Path) -> MadeFiles:
    """Write the points by the step of the request, or the widest that holds the tolerance, and judge their spline.

    Raises RecipeErrors for a contour with corners, and where the step, or any number of points, does not hold the
    tolerance; OSError where the file cannot be written.
    """
    from camgeo.output.job import MadeFiles
    from camgeo.synthesis.intent import intended, permitted
    from kin.judge.verify import verify_points

    recipe, tolerance = job.recipe.in_units_of(request), job.tolerance(request)
    ((_, contour),) = job.design.contours
    if len(contour.runs) > 1 or not contour.closed:
        remedy = "give {dxf: {as: spline}}, which has them"
        raise recipe.error(job.field(request), "a contour with corners is no one spline through points", None, remedy)
    points = _Points(contour, -1.0 if recipe.rotation == "ccw" else 1.0)
    with job.clock.stage("points"):
        count = _count(job, request, points, tolerance)
        placed, *_ = points.at(np.append(np.arange(count) / count, 0.0))
        mark = "," if path.suffix == ".csv" else " "
        row = mark.join([f"%.{DIGITS}g", f"%.{DIGITS}g", "0\n"])
        path.write_bytes("".join(row % tuple(point) for point in (placed / recipe.mm + 0.0).tolist()).encode("ascii"))
    with job.clock.stage("judge csv"):
        limits = permitted(recipe, tolerance)
        verdict = verify_points(path, intended(recipe, job.design), recipe.verify.angles, limits, recipe.mm)
    return MadeFiles((FileResult.of(path, request, tolerance, verdict, None),), verdict.checks)


def _count(job: Job, request: FileRequest, points: _Points, tolerance: float) -> int:
    """Number of points by the request's step, or the fewest within the tolerance, mm.

    Raises RecipeErrors where points at that step, or at the finest one, are not within the tolerance.
    """
    recipe, field = job.recipe, job.field(request)
    fewest = fewest_rows(lambda count: points.error(count) <= MARGIN * tolerance)
    step = request.own.get("step")
    if step is not None:
        count = round(TURN / float(step))
        error = points.error(count)
        if error <= tolerance:
            return count
        problem = f"a spline through points so far apart is off by {error / recipe.mm:.4g} {recipe.units}"
        remedy = "" if fewest is None else f"give {360.0 / fewest:g} or less, or "
        remedy += f"a tolerance of {upward(error / MARGIN / recipe.mm)} {recipe.units}"
        raise recipe.error(f"{field}.csv.step", problem, f"{360.0 / count:.9g} degrees", remedy)
    if fewest is None:
        error = points.error(round(360.0 / FINEST))
        problem = f"a spline through points {FINEST:g} degrees apart is off by {error / recipe.mm:.4g} {recipe.units}"
        remedy = f"give at least {upward(error / MARGIN / recipe.mm)} {recipe.units}"
        raise recipe.error(job.tolerance_field(request), problem, None, remedy)
    return fewest


FORM = Table(name="points", listed=("as",), curve=True, takes=("step", "tolerance", "suffix"), check=check, make=make)
