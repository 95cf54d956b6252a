"""Tables of a linear cam as CSV: its motion, points of its flank for CAD systems, contacts for inspection."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from camgeo.files.table import DIGITS, write_table
from camgeo.measures.units import UNIT_NAMES

if TYPE_CHECKING:
    from pathlib import Path

    from camgeo.capabilities.linear.design import LinearDesign
    from camgeo.recipe.export import FileRequest
    from kin.numeric.arrays import Array

STEPS = 720  # of a motion, where no step is given
ORDER = 3  # of the highest derivative
NOTHING = 1e-14  # of a direction, or of the plate's size: rounding about a coordinate that is 0


def write_csv(design: LinearDesign, request: FileRequest, path: Path) -> None:
    """Write the table of a request; raises OSError where the file cannot be written."""
    mm, unit = _unit(design, request)
    u = inputs(design, request.own.get("step"))
    kind = request.as_ or "motion"
    if kind == "points":
        write_points(design, path, u, mm)
        return
    names, rows = motion_table(design, u, mm, unit) if kind == "motion" else inspection_table(design, u, mm, unit)
    write_table(path, names, rows, gaps=True)


def _unit(design: LinearDesign, request: FileRequest) -> tuple[float, str]:
    units = request.unit_for(design.recipe.units)
    return (25.4 if units == "inch" else 1.0), UNIT_NAMES[units]


def inputs(design: LinearDesign, step: float | None) -> Array:
    """Inputs (n,), mm, from the first to the last at equal steps, about `step` mm or a 720th of the motion."""
    count = STEPS * design.recipe.periods if step is None else max(math.ceil(design.length / step - 1e-9), 1)
    return np.linspace(0.0, design.length, count + 1)


def motion_table(design: LinearDesign, u: Array, mm: float, unit: str) -> tuple[tuple[str, ...], Array]:
    """Names of 5 columns, and rows (n, 5): travel, position, velocity, acceleration and jerk by the travel.

    Positions are lengths in the file's unit, or degrees; derivatives by that unit of travel.
    """
    swings = design.recipe.swings
    rows = design.path.law.derivatives(u, ORDER, design.sides(u))
    scale = math.degrees(1.0) if swings else 1.0 / mm
    powers = scale * mm ** np.arange(ORDER + 1.0)
    name = "swing_deg" if swings else f"lift_{unit}"
    return (f"travel_{unit}", name, "velocity", "acceleration", "jerk"), np.column_stack(
        [u / mm, *(rows * powers[:, None])]
    )


def inspection_table(design: LinearDesign, u: Array, mm: float, unit: str) -> tuple[tuple[str, ...], Array]:
    """Names and rows of contacts on the exact plate as drawn: place, outward normal of the metal, centre of a cutter.

    The cells of a contact that is lost to undercut are nan.
    """
    recipe, side = design.recipe, design.sides(u)
    s = design.path.law.derivatives(u, 0, side)[0]
    columns = {f"travel_{unit}": u / mm}
    columns |= {"swing_deg": np.degrees(s)} if recipe.swings else {f"lift_{unit}": s / mm}
    size = design.outline.size
    for name, flank in design.flanks.items():
        prefix = f"{name}_" if name else ""
        frame = flank.shape.sample(u, side)
        normal = design.drawn(flank.sense * frame.normal)
        normal = np.where(np.abs(normal) < NOTHING, 0.0, normal)
        point = design.drawn(frame.point)
        point = np.where(np.abs(point) < NOTHING * size, 0.0, point)
        angle = np.mod(np.degrees(np.arctan2(normal[:, 1], normal[:, 0])), 360.0)
        own = {f"{prefix}x_{unit}": point[:, 0] / mm, f"{prefix}y_{unit}": point[:, 1] / mm}
        own |= {f"{prefix}nx": normal[:, 0], f"{prefix}ny": normal[:, 1], f"{prefix}normal_deg": angle}
        if recipe.manufacture is not None:
            cutter = (point + recipe.manufacture.radius * normal) / mm
            own |= {f"{prefix}cutter_x_{unit}": cutter[:, 0], f"{prefix}cutter_y_{unit}": cutter[:, 1]}
        there = flank.stands(u)
        columns |= {key: np.where(there, value, np.nan) for key, value in own.items()}
    return tuple(columns), np.column_stack(list(columns.values()))


def write_points(design: LinearDesign, path: Path, u: Array, mm: float) -> None:
    """Write the flank as points x, y, 0, one a line, which CAD systems import as a curve, from the first contact on."""
    kept = design.lower.kept(float(u[0]), float(u[-1]))
    u = np.unique(np.concatenate([u, np.array(kept).ravel()]))
    u = u[design.lower.stands(u)]
    points = design.drawn(design.lower.shape.sample(u, design.sides(u)).point) / mm + 0.0
    row = f"%.{DIGITS}g,%.{DIGITS}g,0\n"
    path.write_bytes("".join(row % (x, y) for x, y in points.tolist()).encode("ascii"))
