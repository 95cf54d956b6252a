"""Tables for electronic cams: rows of a master and a slave for the controller of a drive, which interpolates them.

The interpolated rows are judged against the motion at every place: they are read back from the file and joined as the
controller joins them.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from camgeo.files.controllers import CONTROLLERS
from camgeo.formats.extension import Table
from camgeo.formats.tables.drive_rows import (
    RATE_NAMES,
    RATE_OPTIONS,
    DriveRows,
    RowsError,
    Slave,
    Wanted,
    error_lines,
    finest,
)
from camgeo.formats.tables.tabled import check_step
from camgeo.measures.file_result import FileResult
from kin.judge.drive import drive_checks, driven_by, lowest
from kin.law.joined_rows import ORDERS
from kin.numeric.check import about
from kin.numeric.records import replace

if TYPE_CHECKING:
    from pathlib import Path

    from camgeo.output.job import Job, MadeFiles
    from camgeo.recipe.export import FileRequest
    from camgeo.recipe.recipe import Order
    from camgeo.schema.reader import Reader, Values

OPTIONS = ("step", "tolerance", "for", "joints", *RATE_OPTIONS)
"""Options of a file that is such a table."""


def check_options(file: Values, reader: Reader) -> None:
    """Note faults of a request: no controller, a step that it does not take, a rate that its lines do not have."""
    path = f"{file['path']}.csv"
    if f"{path}.for" not in reader.marks:
        remedy = f"give one of {', '.join(CONTROLLERS)} beside it"
        reader.fault_at(f"{path}.as", "a table for a controller needs to know which", "'controller'", remedy)
    check_step(file, reader)
    if "for" not in file:
        return
    controller = CONTROLLERS[file["for"]]
    least = finest(controller.most)
    if "step" in file and math.degrees(file["step"]) < least * (1.0 - 1e-9):
        reader.fault_at(f"{path}.step", "more rows than its table takes", None, f"give {least:g} or more")
    for name, option in zip(
        RATE_NAMES[ORDERS[controller.join] :], RATE_OPTIONS[ORDERS[controller.join] :], strict=True
    ):
        if option in file:
            smooth = ", ".join(word for word, each in CONTROLLERS.items() if ORDERS[each.join] > 1)
            problem = f"straight lines have no {name} but in steps of the velocity"
            reader.fault_at(f"{path}.{option}", problem, None, f"leave it out, or give one of {smooth} as `for`")


def check(file: Values, values: Values, reader: Reader) -> None:
    """Note faults of a request, a linkage among them."""
    check_options(file, reader)
    if "linkage" in values:
        remedy = "leave the table or the linkage out"
        path = f"{file['path']}.csv.as"
        reader.fault_at(path, "a table for a controller is of a follower without a linkage", None, remedy)


def rates_of(request: FileRequest) -> tuple[float | None, float | None]:
    """Greatest errors of velocity and acceleration that a request gives, as shares of their greatest values."""
    velocity, acceleration = (request.own.get(name) for name in RATE_OPTIONS)
    return None if velocity is None else 0.01 * velocity, None if acceleration is None else 0.01 * acceleration


def write_rows(recipe: Order, request: FileRequest, slave: Slave, most: float, path: Path) -> None:
    """Write a slave's table with the step of the request, or the fewest rows that hold what it asks.

    `most` is the greatest error of the position, mm or rad, by the request's tolerance or the recipe's. Raises
    RecipeErrors where no such rows hold it; RoughError for a motion too abrupt to be followed, OSError where the file
    cannot be written.
    """
    controller, own = CONTROLLERS[str(request.own["for"])], request.own
    wanted = Wanted(most, rates_of(request), own.get("step"), bool(own.get("joints")))
    choice = DriveRows(slave, controller, wanted)
    try:
        rows, found = choice.chosen()
    except RowsError as error:
        option = f"{recipe.field_of(request)}.csv.{error.option}"
        place = recipe.tolerance_field(request) if error.option == "tolerance" else option
        raise recipe.error(place, error.problem, error.value, error.remedy) from error
    per = "; velocity and acceleration by degree of the master" * (controller.order > 0)
    head = (
        f"{recipe.name}: {slave.title}",
        f"{controller.layout}{per}",
        controller.joined,
        *error_lines(found, slave),
    )
    controller.write(path, rows, head)


def make(job: Job, request: FileRequest, path: Path) -> MadeFiles:
    """Write a table with the step of the request, or the fewest rows that hold the tolerance; read it back, judge it.

    Raises RecipeErrors where the step of the request, or any step of this controller, does not hold the tolerance;
    RoughError for a motion too abrupt to be followed, OSError where the file cannot be written.
    """
    from camgeo.output.job import MadeFiles
    from camgeo.synthesis.intent import permitted

    recipe, exact = job.recipe.in_units_of(request), job.design.exact
    limits = permitted(recipe, job.tolerance(request))
    with job.clock.stage("controller"):
        swings = recipe.cam.arrangement.unit == "deg"
        unit = "deg" if swings else "in" if recipe.units == "inch" else "mm"
        breaks = sorted(math.radians(exact.motion.shaft_deg(place)) for place in exact.breaks.tolist())
        scale = math.radians(1.0) if swings else recipe.mm
        title = "one turn of the master; the slave is 0 where the follower is lowest"
        slave = Slave(title, exact.motion.rows, exact.motion.turn, breaks, 0.0, unit, scale)
        slave = replace(slave, base=lowest(slave.rows, breaks))
        driven = driven_by(exact.gauge, limits, rates_of(request))
        write_rows(recipe, request, slave, driven.most * driven.own, path)
    with job.clock.stage("judge csv"):
        checks = drive_checks(path, driven, recipe.mm)
    file = FileResult(path, request, units=recipe.mm)
    return MadeFiles((file,), tuple(about(check, path.name) for check in checks))


FORM = Table(name="controller", surfaces=2, drive=True, takes=OPTIONS, check=check, make=make)
