"""Tables for electronic cams: rows of a master and a slave for the controller of a drive, which interpolates them.

The interpolated rows are judged against the motion at every place: they are read back from the file and joined as the
controller joins them.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from camgeo.common.rounding import upward
from camgeo.files.table import DIGITS, write_table
from camgeo.formats.tables.tabled import check_step, fewest_rows
from camgeo.measures.file_result import FileResult
from camgeo.recipe.machining import FINEST
from camgeo.registry.formats import Form
from kin.judge.check import about
from kin.judge.drive import JOINS, MASTER, RATES, drive_checks
from kin.law.joined_rows import JoinedRows
from kin.numeric.angles import TURN
from kin.numeric.monotone import between, cells, pieces

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from pathlib import Path

    from camgeo.output.job import Job, MadeFiles
    from camgeo.recipe.export import FileRequest
    from camgeo.schema.reader import Reader, Values
    from kin.law.joined_rows import Join
    from kin.numeric.arrays import Array

SHARE = 1e-12  # of the stroke, to which the lowest place is found
PLACES = 9  # decimals of a curve point: of a millimetre the last is 1e-6 micrometres
NOTHING = 1e-13  # of the greatest value: rounding about 0


def _write(path: Path, columns: Sequence[str], rows: Array, head: Sequence[str]) -> None:
    write_table(path, columns, rows, head=head)


def fixed(value: float) -> str:
    """Text of a number rounded to nine decimals, without zeros at its end and without an exponent; -0 is 0.

    SEW-EURODRIVE's manual of the MOVI-C mentions no exponents.
    """
    text = f"{value:.{PLACES}f}".rstrip("0").rstrip(".")
    return "0" if text == "-0" else text


def write_curve_points(path: Path, _columns: Sequence[str], rows: Array, _head: Sequence[str]) -> None:
    """Write a curve point table of SEW-EURODRIVE's MOVI-C, in the layout of `kin.read.curve_points`.

    The file has the number of rows, then master and slave of each row of `rows` (n, 2), without heading and remarks.
    Raises OSError where it cannot be written.
    """
    lines = [str(len(rows)), *(f"{fixed(master)};{fixed(slave)}" for master, slave in rows.tolist())]
    path.write_bytes("".join(f"{line}\n" for line in lines).encode("ascii"))


class Controller(NamedTuple):
    """A controller: how it interpolates between the rows of its table, and the layout of the table.

    `join` is the interpolation. Two texts are for the head of the table: `layout` describes the layout, `word` says by
    whose word the controller interpolates so. `finest` is the least step between rows, degrees, as the controller takes
    no more rows. `number` gives the text of a position or a rate; `write` writes the table: (path, names of columns,
    rows, lines of the head).
    """

    join: Join
    layout: str
    word: str
    finest: float = FINEST
    number: Callable[[float], str] = f"{{:.{DIGITS}g}}".format
    write: Callable[[Path, Sequence[str], Array, Sequence[str]], None] = _write


CONTROLLERS = {
    "codesys": Controller(
        "quintic",
        "CODESYS SoftMotion, MC_CAM_REF of type XYVA: an array of SMC_CAMXYVA with dX, dY, dV, dA",
        "by position, velocity and acceleration, as the library SM3_Basic says of SMC_CAM_TYPE.XYVA",
    ),
    "codesys-table": Controller(
        "line",
        "CODESYS SoftMotion, MC_CAM_REF of type XY: SMC_CAMTable_LREAL_n_2 with pairs of master and slave",
        "as SM3_Basic says of MC_CAM_REF with byInterpolationQuality 1",
    ),
    "sew": Controller(
        "line",
        "SEW-EURODRIVE MOVI-C, curve point table: the number of points, then master and slave with a semicolon between",
        "as its manual says of the interpolation method Linear",
        finest=0.36,  # 1001 rows: a table has 1024, and 0.36 degrees are the next divisor of a turn
        number=fixed,
        write=write_curve_points,
    ),
    "plain": Controller(
        "quintic",
        "x, s, v, a of any controller",
        "by position, velocity and acceleration, as is assumed here",
    ),
}
"""Controllers by their words after the key `for`, in the order of the schema."""


def check(file: Values, values: Values, reader: Reader) -> None:
    """Note faults of a request: no controller, a linkage, a step that the controller does not take."""
    path = f"{file['path']}.csv"
    if f"{path}.for" not in reader.marks:
        remedy = f"give one of {', '.join(CONTROLLERS)} beside it"
        reader.fault_at(f"{path}.as", "a table for a controller needs to know which", "'controller'", remedy)
    if "linkage" in values:
        remedy = "leave the table or the linkage out"
        reader.fault_at(f"{path}.as", "a table for a controller is of a follower without a linkage", None, remedy)
    check_step(file, reader)
    finest = CONTROLLERS[file["for"]].finest if "for" in file else FINEST
    if "step" in file and math.degrees(file["step"]) < finest * (1.0 - 1e-9):
        reader.fault_at(f"{path}.step", "more rows than its table takes", None, f"give {finest:g} or more")


def make(job: Job, request: FileRequest, path: Path) -> MadeFiles:
    """Write a table with the step of the request, or the widest that holds the tolerance; read it back and judge it.

    Raises RecipeErrors where the step of the request, or any step of this controller, does not hold the tolerance;
    RoughError for a motion too abrupt to be followed, OSError where the file cannot be written.
    """
    from camgeo.output.job import MadeFiles
    from camgeo.synthesis.intent import permitted

    recipe, tolerance = job.recipe.in_units_of(request), job.tolerance(request)
    gauge = job.design.exact.gauge
    limits = permitted(recipe, tolerance)
    scale = math.radians(1.0) if gauge.unit == "deg" else 1.0
    with job.clock.stage("controller"):
        rows = _Rows(job, request)
        most = scale * (gauge.direct_limit(tolerance) if limits.motion is None else limits.motion)
        joined, error = _join_rows(job, request, rows, most)
        columns, table = rows.table(joined)
        controller = CONTROLLERS[str(request.own["for"])]
        unit = rows.unit
        head = (
            f"{recipe.name}: one turn of the master; the slave is 0 where the follower is lowest",
            f"{controller.layout}; {'velocity and acceleration by degree of the master' * (len(columns) > 2)}".rstrip(
                "; "
            ),
            f"{JOINS[controller.join]} ({controller.word})",
            f"so joined it is within {upward(error / rows.scale, 6)} {unit} of the motion, proved",
        )
        controller.write(path, columns, table, head)
    with job.clock.stage("judge csv"):
        checks = drive_checks(path, gauge, limits, recipe.mm)
    file = FileResult(path, request, units=recipe.mm)
    return MadeFiles((file,), tuple(about(check, path.name) for check in checks))


class _Rows:
    """Rows of the motion for a controller, above its lowest place and rounded as in the file.

    `unit` is the unit of positions in the file, `scale` that unit in mm or rad.
    """

    def __init__(self, job: Job, request: FileRequest) -> None:
        recipe, exact = job.recipe.in_units_of(request), job.design.exact
        self.motion = exact.motion
        self.controller = CONTROLLERS[str(request.own["for"])]
        swings = recipe.cam.arrangement.unit == "deg"
        self.unit = "deg" if swings else "in" if recipe.units == "inch" else "mm"
        self.scale = math.radians(1.0) if swings else recipe.mm
        self.breaks = [math.radians(exact.motion.shaft_deg(place)) for place in exact.breaks.tolist()]
        followed = cells(lambda t: self.motion.rows(t, 0), between(0.0, TURN, sorted(self.breaks)), share=SHARE)
        self.lowest = pieces(followed).least()[0]

    def position(self, angle: Array) -> Array:
        """Position above the lowest place (n,), mm or rad, at shaft angles up to a turn."""
        above: Array = self.motion.rows(angle, 0)[0] - self.lowest
        return above

    def joined(self, count: int) -> JoinedRows:
        """Rows of a turn, `count` + 1 of them, rounded to the digits of the file; mm or rad."""
        angle = np.linspace(0.0, TURN, count + 1)
        order = 2 if self.controller.join == "quintic" else 0
        rows = self.motion.turn(angle, order)
        rows[0] -= self.lowest
        degree = math.radians(1.0)
        powers = np.array([1.0, degree, degree**2])[: order + 1, None]
        values = rows * powers / self.scale
        values[np.abs(values) < NOTHING * np.abs(values).max(axis=1, keepdims=True)] = 0.0
        rounded = np.array([[float(self.controller.number(value)) for value in row] for row in values.tolist()])
        return JoinedRows(angle, rounded * self.scale / powers, self.controller.join)

    def off(self, joined: JoinedRows) -> float:
        """Greatest distance of joined rows from the motion, mm or rad."""
        return joined.off(self.position, self.breaks)[0]

    def error(self, count: int) -> float:
        """Greatest distance of `count` + 1 joined rows of a turn from the motion, mm or rad."""
        return self.off(self.joined(count))

    def table(self, joined: JoinedRows) -> tuple[tuple[str, ...], Array]:
        """Column names and rows (n, k): angle of the master, degrees, position of the slave and its derivatives.

        The position is in the unit of the file or, of a follower that swings, in degrees; velocity and acceleration, if
        the controller takes them, are by degree of the master.
        """
        degree = math.radians(1.0)
        powers = np.array([1.0, degree, degree**2])[: len(joined.slave), None]
        degrees = np.linspace(0.0, 360.0, len(joined.master))
        names = (MASTER, f"slave_{self.unit}", *RATES)[: 1 + len(joined.slave)]
        return names, np.column_stack([degrees, *(joined.slave * powers / self.scale)])


def _join_rows(job: Job, request: FileRequest, rows: _Rows, most: float) -> tuple[JoinedRows, float]:
    """Rows by the request's step, or the fewest within `most`, mm or rad, and their greatest error, mm or rad.

    Raises RecipeErrors where rows at that step, or the finest that the controller takes, are not within `most`.
    """
    recipe, field = job.recipe, job.field(request)
    step = request.own.get("step")
    if step is not None:
        count = round(TURN / float(step))
        joined = rows.joined(count)
        error = rows.off(joined)
        if error <= most:
            return joined, error
        problem = f"joined as the controller joins them rows so far apart leave {error / rows.scale:.4g} {rows.unit}"
        fewest = fewest_rows(rows.error, most, rows.controller.finest)
        remedy = "" if fewest is None else f"give {360.0 / fewest:g} or less, or "
        remedy += f"a tolerance of {upward(error / rows.scale)} {rows.unit}"
        raise recipe.error(f"{field}.csv.step", problem, f"{360.0 / count:.9g} degrees", remedy)
    finest = rows.controller.finest
    fewest = fewest_rows(rows.error, most, finest)
    if fewest is None:
        error = rows.error(round(360.0 / finest))
        error_text = f"{error / rows.scale:.4g} {rows.unit}"
        problem = f"joined as the controller joins them rows {finest:g} degrees apart leave {error_text}"
        remedy = f"give at least {upward(error / rows.scale)} {rows.unit}"
        raise recipe.error(job.tolerance_field(request), problem, None, remedy)
    joined = rows.joined(fewest)
    return joined, rows.off(joined)


FORM = Form(name="controller", surfaces=2, takes=("step", "tolerance", "for"), check=check, make=make)
