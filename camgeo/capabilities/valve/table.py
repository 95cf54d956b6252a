"""The table of a valve over the shaft angle: lifts of tappet and valve, velocity and acceleration of the valve."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from camgeo.capabilities.valve.train import ORDER, valve_of
from camgeo.formats.extension import Table
from camgeo.formats.tables.tabled import table_maker
from kin.numeric.angles import TURN

if TYPE_CHECKING:
    from camgeo.formats.tables.tabled import Columns
    from camgeo.output.job import Job
    from camgeo.recipe.export import FileRequest
    from camgeo.schema.reader import Reader, Values


def _check(file: Values, values: Values, reader: Reader) -> None:
    if "valve" not in values:
        remedy = "give valve, such as valve: {ratio: 1.6, lash: 0.3}, or leave this out"
        reader.fault_at(f"{file['path']}.csv.as", "a table of the valve needs one", "'valve'", remedy)


def _columns(job: Job, request: FileRequest) -> Columns:
    """Column names and rows (angles + 1, 6), derivatives by rad of the cam, in the unit of the file."""
    recipe = job.recipe.in_units_of(request)
    valve = valve_of(recipe, job.design)
    if valve is None:
        raise ValueError(f"{recipe.name}: there is no valve")
    shaft = np.linspace(0.0, TURN, recipe.verify.angles + 1)
    tappet = job.design.motion.turn(shaft, ORDER)
    lifts = valve.rows(tappet) / recipe.mm
    unit, degrees = "in" if recipe.units == "inch" else "mm", np.linspace(0.0, 360.0, len(shaft))
    names = ("shaft_deg", "crank_deg", f"tappet_{unit}", f"valve_{unit}", "valve_velocity", "valve_acceleration")
    return names, np.column_stack([degrees, 2.0 * degrees, tappet[0] / recipe.mm, *lifts])


FORM = Table(name="valve", after="motion", check=_check, make=table_maker("valve", _columns))
