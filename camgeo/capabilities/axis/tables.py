"""The motion of an axis in time as CSV."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from camgeo.files.table import write_table
from camgeo.measures.units import UNIT_NAMES
from kin.numeric.angles import TURN
from kin.numeric.records import replace

if TYPE_CHECKING:
    from pathlib import Path

    from camgeo.capabilities.axis.design import AxisDesign
    from camgeo.recipe.export import FileRequest

STEPS = 360  # of a turn of the master, where no step is given
ORDER = 3  # of the highest derivative, the jerk


def write_motion(design: AxisDesign, request: FileRequest, path: Path) -> None:
    """Write time, the master's angle, position, and velocity, acceleration and jerk by second.

    With a modulo a column has the position above the last multiple of it. Raises OSError where it cannot be written.
    """
    recipe = design.recipe
    units = request.unit_for(recipe.units)
    shown = replace(design, recipe=replace(recipe, units=units, mm=25.4 if units == "inch" else 1.0))
    step = request.own.get("step")
    count = STEPS if step is None else round(TURN / float(step))
    angle = np.linspace(0.0, TURN, count + 1)
    rows = shown.in_time(angle, ORDER)
    unit = "deg" if recipe.swings else UNIT_NAMES[units]
    columns = {
        "time_s": recipe.cycle * np.arange(count + 1.0) / count,
        "master_deg": np.linspace(0.0, 360.0, count + 1),
        f"position_{unit}": rows[0],
    }
    if recipe.modulo is not None:
        columns[f"modulo_{unit}"] = np.mod(rows[0], recipe.modulo / shown.recipe.scale)
    columns |= {"velocity": rows[1], "acceleration": rows[2], "jerk": rows[3]}
    write_table(path, tuple(columns), np.column_stack(list(columns.values())))
