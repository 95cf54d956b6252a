"""Table of an indexing cam as CSV: the turret's motion, and the pressure angle of its best placed roller."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from camgeo.capabilities.indexing.engaged import Engaged
from camgeo.files.table import write_table
from kin.numeric.angles import TURN

if TYPE_CHECKING:
    from pathlib import Path

    from camgeo.capabilities.indexing.design import IndexDesign
    from camgeo.recipe.export import FileRequest
    from kin.numeric.arrays import Array

STEP = math.radians(0.5)  # between rows, where a recipe does not ask for another
AT_ONCE = 4096  # rows


def write_csv(design: IndexDesign, request: FileRequest, path: Path) -> None:
    """Write the table of a request; raises OSError where the file cannot be written."""
    count = max(math.ceil(TURN / request.own.get("step", STEP) - 1e-9), 1)
    names, rows = motion_table(design, np.arange(count) * (TURN / count))
    write_table(path, names, rows, gaps=True)


def motion_table(design: IndexDesign, theta: Array) -> tuple[tuple[str, ...], Array]:
    """Names of 6 columns, and rows (n, 6) at shaft angles (n,), rad.

    The turret's angle is that of its roller at the start, degrees; velocity and acceleration are by the radian.
    Pressure angles are those in the middle of the line of contact of each flank's best placed roller. They are above 0
    where the cam drives the turret on, and nan where the flank bears on no roller.
    """
    rows = np.degrees(design.law.derivatives(theta, 2))
    rows[0] += math.degrees(design.recipe.start)
    angles = []
    for name in ("lower", "upper"):
        parts = [_pressure(Engaged(design, name, theta[i : i + AT_ONCE])) for i in range(0, theta.size, AT_ONCE)]
        angles.append(np.degrees(np.concatenate(parts)))
    names = ("shaft_deg", "turret_deg", "velocity", "acceleration", "lower_pressure_deg", "upper_pressure_deg")
    return names, np.column_stack([np.degrees(theta), *rows, *angles])


def _pressure(engaged: Engaged) -> Array:
    index, load = engaged.best
    angle = engaged.angle(engaged.middle)[np.arange(index.size), index]
    return np.where(np.isfinite(load), angle, np.nan)
