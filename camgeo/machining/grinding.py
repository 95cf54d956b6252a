"""The grinder's table: how far the wheel's centre stands from the shaft over the angle of the work, X over C.

The wheel's path c is the contour's parallel at the wheel's radius, with tangent T, normal N, speed sigma and turn
omega of the tangent, both per parameter. With g = c.T and h = c.N, X = |c| and

    dX/dC = X g/h,   d2X/dC2 = X g^2/h^2 + X^3/h^2 (1 - k X^2/h),   k = omega/sigma.

Joined by straight lines over steps H, rad, the table is off by up to H^2/8 of the greatest second derivative; where
every place of the wheel is within that distance of the exact one, so is the metal that it leaves.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from camgeo.common.rounding import downward, upward
from camgeo.curve.curve import Curve, CurveError
from camgeo.curve.extremes import subdivide
from camgeo.curve.measures import StarError, nearest, polar_parameters
from camgeo.curve.undercut.causes import UndercutError
from camgeo.files.table import DIGITS as PLACES
from camgeo.machining.cutter import cutter_path
from camgeo.measures.units import UNIT_NAMES
from camgeo.recipe.machining import COARSEST, FINEST
from camgeo.synthesis.checks import hollow_radius
from kin.judge.grinding import Grinding

if TYPE_CHECKING:
    from collections.abc import Sequence

    from camgeo.recipe.export import FileRequest
    from camgeo.recipe.recipe import Recipe
    from camgeo.schema.errors import RecipeErrors
    from camgeo.synthesis.design import Design
    from kin.numeric.arrays import Array

ROLLER = "roller"  # option of a table of a roller's lift; a table of a wheel's places does not have it
CELLS = 16_384  # intervals of the turn over which the second derivative is bounded
SHARE = 0.99  # of the tolerance that straight joins may take; the table's digits take some too
TICKS = 10_000  # parts of a degree, in whole numbers of which steps are, so that angles have four decimals
BELOW = 0.95  # of the largest wheel that reaches: with a larger one rows would have to be very close
NOTHING = 1e-13  # of a direction's component or of the size: less is rounding about 0
DIGITS = 5e-12  # relative error of a length as the table writes it


class GrindingTable(NamedTuple):
    """Names of the columns, rows (n + 1, k), the lines of the head, and the greatest error of straight joins, mm."""

    columns: tuple[str, ...]
    rows: Array
    head: tuple[str, ...]
    error: float


def grinding_table(recipe: Recipe, design: Design, request: FileRequest, tolerance: float, field: str) -> GrindingTable:
    """Table of a request within a tolerance, mm; `field` is the path of the request, for errors.

    Columns are the direction of the wheel's centre, degrees, its distance from the shaft in the recipe's unit, and the
    direction of the metal's normal, degrees; of a roller the direction and its lift. Raises RecipeErrors for a missing
    wheel, a wheel or roller that the contour does not let in, a trimmed contour, a path that a ray from the shaft
    crosses twice, a step that is too wide for the tolerance, and a tolerance that takes too fine a step, CurveError
    where it cannot be proved what is reached.
    """
    wheel = _Wheel.of(recipe, request, field)
    path = _path(recipe, design, wheel)
    try:
        bend, far = greatest_bend(path), path.size
    except CurveError as failure:
        ((_, contour),) = design.contours
        raise _refusal(recipe, wheel, str(failure), 2.0 * hollow_radius(1, contour)[0]) from failure
    # number of rows by the proved second derivative, then the wheel's place at each angle of the work
    count = _count(recipe, request, bend, (tolerance - DIGITS * far, tolerance), field)
    error = _join_error(360.0 / count, bend) + DIGITS * far
    angle = 2.0 * math.pi * np.arange(count) / count
    mirror = -1.0 if recipe.rotation == "ccw" else 1.0
    try:
        frames = path.sample(polar_parameters(path, mirror * angle))
    except StarError as failure:
        raise recipe.error(field, str(failure), None, "leave the table out") from failure
    # columns in the recipe's unit; what is 0 but for rounding is written as 0
    distance = np.hypot(frames.point[:, 0], frames.point[:, 1])
    degrees, unit = 360.0 * np.arange(count + 1) / count, UNIT_NAMES[recipe.units]
    length = _exact_length(2.0 * wheel.radius, recipe)
    head = [f"{recipe.name}: {{}}; c_deg: direction of its centre from the shaft, as the part is drawn"]
    if ROLLER in request.own:
        zero = nearest(path).value
        lift = np.where(np.abs(distance - zero) < NOTHING * far, 0.0, distance - zero)
        rows = [degrees, _closed(lift / recipe.mm)]
        columns: tuple[str, ...] = ("c_deg", f"lift_{unit}")
        head[0] = head[0].format(f"lift of a roller {length} across on a stem through the shaft")
        head.append(f"at lift 0 its centre is {_exact_length(zero, recipe)} from the shaft")
    else:
        outward = np.where(np.abs(frames.normal) < NOTHING, 0.0, frames.normal)
        normal = np.mod(np.degrees(np.arctan2(mirror * outward[:, 1], outward[:, 0])), 360.0)
        rows = [degrees, _closed(distance / recipe.mm), _closed(np.where(normal < 360.0, normal, 0.0))]
        columns = ("c_deg", f"x_{unit}", "normal_deg")
        head[0] = head[0].format(f"places of a grinding wheel {length} across")
        head.append(f"x_{unit}: its distance; normal_deg: direction in which the metal faces where it grinds")
    head.append(f"joined by straight lines the metal is within {_length(error, recipe)} of the exact contour, proved")
    return GrindingTable(columns, np.column_stack(rows), tuple(head), error)


def grinding_intent(recipe: Recipe, design: Design) -> Grinding:
    """Radius of the wheel, and of a tabled roller with its least distance from the shaft, mm, for kin's judgement.

    The distance is that of the roller's centre. The wheel's radius is None without a wheel, the roller's where none is
    tabled or no contour is made. With a roller raises RecipeErrors where the contour does not let it in or is trimmed,
    CurveError where it cannot be proved what it reaches.
    """
    request = next((request for request in recipe.export.files if request.form.ground and ROLLER in request.own), None)
    if request is None or not design.contours:
        return Grinding(recipe.wheel)
    wheel = _Wheel.of(recipe, request, recipe.field_of(request))
    return Grinding(recipe.wheel, wheel.radius, nearest(_path(recipe, design, wheel)).value)


def greatest_bend(path: Curve) -> float:
    """Proved bound of |d2X/dC2|, mm/rad^2, of a grinding wheel's path: X is its distance from the shaft.

    C is the direction of its centre. Raises CurveError where no bound exists.
    """
    stretches = np.concatenate([run.stretches for run in path.runs])
    low, high = subdivide(stretches[:, 0], stretches[:, 1], max(CELLS // len(stretches), 1))
    proved, ends, width = path.shape.bounds(low, high), path.span(low, high), high - low
    speed, turn = proved.speed_high, np.maximum(np.abs(proved.turn_low), np.abs(proved.turn_high))
    g, h, x = (
        np.stack([np.sum(frame.point * frame.tangent, axis=1) for frame in ends]),
        np.stack([np.sum(frame.point * frame.normal, axis=1) for frame in ends]),
        np.stack([np.hypot(frame.point[:, 0], frame.point[:, 1]) for frame in ends]),
    )
    # x' <= sigma, |g'| <= sigma + |omega h|, h' = omega g: none strays from its nearer end by more than half the width
    far = x.max(axis=0) + 0.5 * width * speed
    sway = 0.5 * width * (speed + turn * far)
    g_most = np.abs(g).max(axis=0) + sway
    h_sway = 0.5 * width * turn * g_most
    h_low, h_high = h.min(axis=0) - h_sway, h.max(axis=0) + h_sway
    with np.errstate(divide="ignore", invalid="ignore"):
        # |x'| = sigma |g|/x. Where x is less than near = far - width*speed, g_most is |g| + near - x or more; as |g| is
        # at most x, |g|/x is at most (|g| + near - x)/near, and so at most g_most/near
        x_sway = 0.5 * width * speed * np.minimum(g_most / (far - width * speed), 1.0)
        x_low, x_high = x.min(axis=0) - x_sway, x.max(axis=0) + x_sway
        bent = np.stack([a / b for a in (proved.turn_low, proved.turn_high) for b in (proved.speed_low, speed)])
        ratios = np.stack([p**2 / q for p in (x_low, x_high) for q in (h_low, h_high)])
        terms = (bent[:, None] * ratios[None]).reshape(-1, width.size)
        # where the second term is below 0 the first one lessens it
        up = x_high * g_most**2 / h_low**2 + np.maximum(1.0 - terms.min(axis=0), 0.0) * x_high**3 / h_low**2
        down = np.maximum(terms.max(axis=0) - 1.0, 0.0) * x_high**3 / h_low**2
        reached = np.where((proved.speed_low > 0.0) & (h_low > 0.0), np.maximum(up, down), np.inf)
    if not np.isfinite(reached).all():
        raise CurveError("turns on the spot in a hollow, or nearly so", float(low[~np.isfinite(reached)][0]))
    return float(reached.max())


def _path(recipe: Recipe, design: Design, wheel: _Wheel) -> Curve:
    """The path of the wheel's or the roller's centre.

    Raises RecipeErrors for one that does not reach all of the contour, and for a trimmed contour, which has corners,
    CurveError where it cannot be proved what is reached.
    """
    ((_, contour),) = design.contours
    try:
        path = cutter_path(contour, wheel.radius)
    except UndercutError as error:
        raise _refusal(recipe, wheel, "does not reach the contour", 2.0 * hollow_radius(1, contour)[0]) from error
    if path.lost:
        largest = 2.0 * min(cut.free_at for cut in path.lost)
        raise _refusal(recipe, wheel, "does not reach all of the contour's hollows", largest)
    if path.corners:
        raise recipe.error(wheel.field, "a trimmed contour has corners, which are not ground", None, "leave it out")
    return path.curve


class _Wheel(NamedTuple):
    """A wheel, or a roller whose lift is tabled: its radius, mm, and the path of its field in the recipe."""

    radius: float
    field: str

    @staticmethod
    def of(recipe: Recipe, request: FileRequest, field: str) -> _Wheel:
        """Wheel or roller of a request, `field` its path; raises RecipeErrors without a wheel."""
        if ROLLER in request.own:
            return _Wheel(0.5 * request.own[ROLLER], f"{field}.csv.{ROLLER}")
        if recipe.wheel is None:
            raise recipe.error("manufacture.wheel", "missing", None, "give its diameter")
        return _Wheel(recipe.wheel, "manufacture.wheel")


def _refusal(recipe: Recipe, wheel: _Wheel, problem: str, largest: float) -> RecipeErrors:
    """RecipeErrors for a wheel that does not reach; the remedy is a wheel a little below `largest`, mm in diameter.

    That is the largest wheel that reaches every hollow; where it is infinite, the remedy is to leave the table out.
    """
    remedy = "leave the table out"
    if math.isfinite(largest):
        problem += f"; the largest that reaches is {downward(largest / recipe.mm)} {recipe.units} across"
        remedy = f"give {downward(BELOW * largest / recipe.mm)} {recipe.units} or less"
    return recipe.error(wheel.field, problem, _length(2.0 * wheel.radius, recipe), remedy)


def _count(recipe: Recipe, request: FileRequest, bend: float, tolerances: Sequence[float], field: str) -> int:
    """Number of rows of a turn, by the step of the request or, without one, by the tolerance.

    `bend` is the greatest |d2X/dC2|, mm/rad^2; `tolerances` are the tolerance less the error of the table's digits, mm,
    and the tolerance itself. Raises RecipeErrors for a tolerance that the finest step does not hold, and for a step too
    wide for the tolerance.
    """
    available, tolerance = tolerances
    widest = COARSEST if bend == 0.0 else math.degrees(math.sqrt(8.0 * max(SHARE * available, 0.0) / bend))
    ticks = int(min(widest, COARSEST) * TICKS)
    if ticks < FINEST * TICKS:
        least = upward(_join_error(FINEST, bend) / SHARE / recipe.mm)
        problem = f"joined by straight lines a table of {360.0 / FINEST:.0f} rows does not keep it"
        path = f"{field}.csv.tolerance" if request.tolerance is not None else "export.tolerance"
        raise recipe.error(path, problem, _length(tolerance, recipe), f"give at least {least} {recipe.units}")
    step = next(tick for tick in range(ticks, 0, -1) if 360 * TICKS % tick == 0) / TICKS
    if "step" not in request.own:
        return round(360.0 / step)
    count = round(2.0 * math.pi / float(request.own["step"]))
    error = _join_error(360.0 / count, bend)
    if error > tolerance:
        problem = f"joined by straight lines rows so far apart leave {_length(error, recipe)}, beyond the tolerance"
        remedy = f"give {step:g} or less, or a tolerance of {upward(error / recipe.mm)} {recipe.units}"
        raise recipe.error(f"{field}.csv.step", problem, f"{360.0 / count:.9g} degrees", remedy)
    return count


def _join_error(step: float, bend: float) -> float:
    """Greatest error, mm, of straight joins over a step, degrees, where |d2X/dC2| is at most `bend`, mm/rad^2."""
    return math.radians(step) ** 2 * bend / 8.0


def _closed(column: Array) -> Array:
    """The column with its first value again at the end."""
    return np.append(column, column[:1])


def _length(value: float, recipe: Recipe) -> str:
    return f"{value / recipe.mm:.6g} {recipe.units}"


def _exact_length(value: float, recipe: Recipe) -> str:
    """A length with as many digits as the rows have, as readers of the table compute with it."""
    return f"{value / recipe.mm:.{PLACES}g} {recipe.units}"
