"""The inspection table: points of contact on the exact cam, normals of the surface, centres of a cutter.

Places and directions are those of the drawing, mirrored where the drawing is; the motion is not. Where a trimmed cam
is not touched the cells stay empty. Where the recipe gives the zone of the contour, its limits stand behind.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from camgeo.formats.extension import Table
from camgeo.formats.tables.tabled import check_step, table_maker
from kin.numeric.angles import TURN

if TYPE_CHECKING:
    from camgeo.cams.surface import Surface
    from camgeo.curve.curve import Curve
    from camgeo.formats.tables.tabled import Columns
    from camgeo.output.job import Job
    from camgeo.recipe.export import FileRequest
    from camgeo.recipe.recipe import Recipe
    from camgeo.schema.reader import Reader, Values
    from camgeo.synthesis.design import Design
    from kin.numeric.arrays import Array

NOTHING = 1e-14  # of a direction or of the cam's size: rounding about a coordinate that is 0


def inspection_table(recipe: Recipe, design: Design, step: float | None = None) -> tuple[tuple[str, ...], Array]:
    """Column names and rows (angles + 1, k) over equal steps of the shaft, in the recipe's unit of length and degrees.

    `step`, rad, replaces a turn over `verify.angles`.

    First come the shaft angle, with a linkage the relative angle too, and the follower's position. Each contact has its
    place, as x and y and as radius and polar angle, the outward normal with its direction, and with `manufacture` the
    centre of the cutter that touches the same point; all are nan where a trimmed cam is not touched. Of two rollers or
    faces the columns of A come first, of several surfaces those of the first. Raises ValueError for a design without a
    contour, or with a linkage that does not turn right round.
    """
    if not design.contours:
        raise ValueError(f"{recipe.name}: there is no contour to inspect")
    count = recipe.verify.angles if step is None else round(TURN / step)
    shaft = np.linspace(0.0, TURN, count + 1)
    columns = {"shaft_deg": np.linspace(0.0, 360.0, count + 1)}
    unit = "in" if recipe.units == "inch" else "mm"
    position, relative = design.motion, shaft
    if design.driven is not None:
        relative = design.driven.mechanism.relative(shaft)
        columns["relative_deg"] = np.degrees(relative)
    columns[position.column(recipe.units)] = position.convert(position.rows(relative, 0)[0], recipe.mm)
    for name, parameter in position.parameters(shaft, relative).items():
        for surface, contour in design.contours:
            columns |= _contact(recipe, (surface, contour), parameter, f"{surface.prefix}{name}", unit)
    if recipe.profile is not None:
        zone = np.full(count + 1, 0.5 * recipe.profile / recipe.mm)
        columns |= {f"lower_{unit}": -zone, f"upper_{unit}": zone}
    return tuple(columns), np.column_stack(list(columns.values()))


def _check(file: Values, _: Values, reader: Reader) -> None:
    check_step(file, reader)


def _contact(
    recipe: Recipe, touching: tuple[Surface, Curve], parameter: Array, name: str, unit: str
) -> dict[str, Array]:
    """Columns of one contact, in the drawn axes and the recipe's unit."""
    surface, contour = touching
    frame = contour.sample(parameter)
    outward = surface.side * frame.normal  # of the metal: in a ring towards the follower within
    normal = np.where(np.abs(outward) < NOTHING, 0.0, outward)
    point = np.where(np.abs(frame.point) < NOTHING * contour.size, 0.0, frame.point)
    columns = _place(recipe, point, name, unit)
    x, y = _mirror(recipe, normal).T
    columns |= {f"{name}nx": x, f"{name}ny": y, f"{name}normal_deg": _degrees(x, y)}
    if recipe.manufacture is not None:
        columns |= _cartesian(recipe, point + recipe.manufacture.radius * normal, f"{name}cutter_", unit)
    from camgeo.curve.measures import touched

    away = ~touched(contour, parameter)
    return {key: np.where(away, np.nan, column) for key, column in columns.items()} if away.any() else columns


def _place(recipe: Recipe, point: Array, name: str, unit: str) -> dict[str, Array]:
    x, y = (_mirror(recipe, point) / recipe.mm).T
    polar = {f"{name}radius_{unit}": np.hypot(x, y), f"{name}polar_deg": _degrees(x, y)}
    return _cartesian(recipe, point, name, unit) | polar


def _cartesian(recipe: Recipe, point: Array, name: str, unit: str) -> dict[str, Array]:
    x, y = (_mirror(recipe, point) / recipe.mm).T
    return {f"{name}x_{unit}": x, f"{name}y_{unit}": y}


def _mirror(recipe: Recipe, vectors: Array) -> Array:
    """Places or directions (n, 2), mirrored for a counter-clockwise shaft."""
    mirrored: Array = vectors * np.array([1.0, -1.0]) if recipe.rotation == "ccw" else vectors
    return mirrored


def _degrees(x: Array, y: Array) -> Array:
    """Directions in degrees, from 0 to less than 360 (n,)."""
    angle = np.mod(np.degrees(np.arctan2(y, x)), 360.0)
    return np.where(angle < 360.0, angle, 0.0)


def _columns(job: Job, request: FileRequest) -> Columns:
    return inspection_table(job.recipe.in_units_of(request), job.design, request.own.get("step"))


FORM = Table(
    name="inspection",
    surfaces=2,
    discs=2,
    takes=("step",),
    check=_check,
    make=table_maker("inspection", _columns, gaps=True),  # nan: not touched
)
