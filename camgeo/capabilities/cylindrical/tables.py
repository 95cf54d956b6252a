"""Tables of a cylindrical cam as CSV: its motion, and points of its flanks for inspection."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from camgeo.capabilities.cylindrical.crossings import lost_of
from camgeo.capabilities.cylindrical.figures import carried_from, outer_end
from camgeo.common.units import UNIT_MM
from camgeo.files.table import write_table
from camgeo.measures.units import UNIT_NAMES

if TYPE_CHECKING:
    from pathlib import Path

    from camgeo.capabilities.cylindrical.design import DrumDesign
    from camgeo.recipe.export import FileRequest
    from kin.numeric.arrays import Array

STEP = math.radians(0.5)  # between rows, where a recipe does not ask for another
ORDER = 3  # of the highest derivative of the motion
PLACES = 3  # along a line of contact: its inner end, its middle, its outer end
SLACK = 1e-9  # of a mm by which a place may lie within what is cut away


def write_csv(design: DrumDesign, request: FileRequest, path: Path) -> None:
    """Write the table of a request; raises OSError where the file cannot be written."""
    units = request.unit_for(design.recipe.units)
    mm = UNIT_MM[units]
    period = design.recipe.period
    count = max(math.ceil(period / request.own.get("step", STEP) - 1e-9), 1)
    theta = np.arange(count) * (period / count)
    table = flank_table if request.as_ == "flank" else motion_table
    names, rows = table(design, theta, mm, UNIT_NAMES[units])
    write_table(path, names, rows, gaps=True)


def motion_table(design: DrumDesign, theta: Array, mm: float, unit: str) -> tuple[tuple[str, ...], Array]:
    """Names of 5 columns, and rows (n, 5): shaft angle, lift, velocity, acceleration and jerk by the radian.

    The swing of an arm is in degrees.
    """
    swings = design.recipe.swings
    rows = design.law.derivatives(theta, ORDER)
    rows = np.degrees(rows) if swings else rows / mm
    name = "swing_deg" if swings else f"lift_{unit}"
    return ("shaft_deg", name, "velocity", "acceleration", "jerk"), np.column_stack([np.degrees(theta), *rows])


def flank_table(design: DrumDesign, theta: Array, mm: float, unit: str) -> tuple[tuple[str, ...], Array]:
    """Names and rows of contacts, three along the roller at each shaft angle: place, and outward normal of the metal.

    Angles are those of the drum as it is made, mirrored for `rotation: ccw`. Cells of a contact that is lost to
    undercut, or to a track that crosses, are empty.
    """
    recipe = design.recipe
    at = np.repeat(theta, PLACES)
    share = np.tile(np.linspace(0.0, 1.0, PLACES), theta.size)
    columns: dict[str, Array] = {"shaft_deg": np.degrees(at)}
    for name, flank in design.flanks.items():
        rho = recipe.roller.inner + share * (outer_end(design, name, at) - recipe.roller.inner)
        contact = flank.along(at, rho)
        normal = flank.normal(contact, at) * np.array([1.0, recipe.sense, 1.0])
        there = rho >= carried_from(design, name, at) - SLACK
        for lost in lost_of(design.crossings, name):
            there &= ~lost.has(at, contact.r, recipe.period)
        own = {
            f"{name}_rho_{unit}": rho / mm,
            f"{name}_r_{unit}": contact.r / mm,
            f"{name}_phi_deg": np.mod(np.degrees(recipe.sense * contact.phi), 360.0),
            f"{name}_z_{unit}": contact.z / mm,
            **{f"{name}_n{axis}": normal[:, k] for k, axis in enumerate("xyz")},
        }
        columns |= {key: np.where(there, value, np.nan) for key, value in own.items()}
    return tuple(columns), np.column_stack(list(columns.values()))
