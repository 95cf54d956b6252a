"""Tables of a camshaft: lifts over the shaft's angle, and events; CSV."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from camgeo.capabilities.camshaft.events import CYCLE
from camgeo.capabilities.camshaft.keys import INSPECTION
from camgeo.capabilities.camshaft.lobes import lifts, valves
from camgeo.files.table import write_table
from camgeo.measures.contact_points import contact_points
from camgeo.measures.units import UNIT_NAMES, report_unit
from kin.numeric.angles import TURN
from kin.numeric.feet import equal_steps

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from camgeo.capabilities.camshaft.keys import CamshaftRecipe
    from camgeo.capabilities.camshaft.lobes import PlacedLobe
    from camgeo.recipe.export import FileRequest

STEP = 1.0  # degree of the shaft


def column(name: str) -> str:
    """A lobe's name for the head of a column: ASCII letters and digits, `_` in place of others."""
    return "".join(letter if letter.isalnum() and letter.isascii() else "_" for letter in name)


def write_csv(path: Path, recipe: CamshaftRecipe, lobes: Sequence[PlacedLobe], request: FileRequest) -> None:
    """Write the table that the request's form names: events, inspection, else motion.

    Events raise RecipeErrors and EventError as `PlacedLobe.event_lift` does, motion as `PlacedLobe.moved` does; OSError
    where the file cannot be written.
    """
    if request.as_ == "events":
        write_events(path, recipe, lobes)
    elif request.as_ == INSPECTION:
        write_inspection(path, recipe, lobes, request.own.get("step"))
    else:
        write_motion(path, recipe, lobes)


def write_motion(path: Path, recipe: CamshaftRecipe, lobes: Sequence[PlacedLobe]) -> None:
    """Write lifts at every degree of the shaft, in the recipe's unit or degrees.

    An engine has the crank angle besides, a lobe with a driven part, such as a valve, that part's motion.
    """
    angle = np.arange(0.0, 360.0 + STEP, STEP)
    heads, columns = ["shaft_deg"], [angle]
    if recipe.engine is not None:
        heads, columns = [*heads, "crank_deg"], [*columns, 2.0 * angle]
    for lobe, lift in zip(lobes, lifts(lobes, np.radians(angle)), strict=True):
        unit = "deg" if lobe.swings else UNIT_NAMES[recipe.units]
        heads.append(f"{column(lobe.lobe.name)}_{unit}")
        columns.append(np.degrees(lift) if lobe.swings else lift / recipe.mm)
        if (moved := lobe.moved) is not None:
            made = moved.rows(lobe.rows(np.radians(angle), 2)) / recipe.mm
            name = f"{column(lobe.lobe.name)}_{moved.name}"
            heads += [f"{name}_{unit}", f"{name}_velocity", f"{name}_acceleration"]
            columns += list(made)
    write_table(path, heads, np.column_stack(columns))


def write_events(path: Path, recipe: CamshaftRecipe, lobes: Sequence[PlacedLobe]) -> None:
    """Write the events of every lobe, degrees of the shaft, and of an engine's cylinders, crank degrees.

    `lobe` and `cylinder` are numbers, from 1 as they are listed; what a lobe does not have is an empty cell. `lift`, of
    the follower, is in the recipe's unit, or degrees where it swings. Raises RecipeErrors and EventError as
    `PlacedLobe.event_lift` does, OSError where the file cannot be written.
    """
    heads = ["lobe", "at_deg", "opens_deg", "closes_deg", "centre_deg", "duration_deg", "lift"]
    engine, rows = recipe.engine, []
    if engine is not None:
        heads += ["cylinder", "opens_crank_deg", "closes_crank_deg", "duration_crank_deg"]
        heads += ["ivo_btdc", "ivc_abdc", "evo_bbdc", "evc_atdc", "overlap_crank_deg", "separation_cam_deg"]
    for number, lobe in enumerate(lobes, 1):
        lift = lobe.event_lift(recipe.engine)
        event = lobe.event(lift)
        columns = [math.nan] * 4 if event is None else list(event)
        scale, _ = report_unit(recipe, lobe.lobe.recipe.cam.arrangement.unit)
        row = [number, math.degrees(lobe.at), *columns, lift * scale]
        if engine is not None:
            cylinder = lobe.lobe.cylinder
            crank = [math.nan] * 3
            if event is not None:
                crank = [2.0 * event.opens % CYCLE, 2.0 * event.closes % CYCLE, 2.0 * event.duration]
            own = None if cylinder is None else valves(lobes, engine, cylinder)
            row += [math.nan if cylinder is None else cylinder, *crank, *([math.nan] * 6 if own is None else own)]
        rows.append(row)
    write_table(path, heads, np.array(rows, dtype=np.float64), gaps=True)


def write_inspection(path: Path, recipe: CamshaftRecipe, lobes: Sequence[PlacedLobe], step: float | None) -> None:
    """Write places on every lobe to be measured, as the shaft is drawn, with their normals and limits.

    `lobe` is a number, from 1 as they are listed, and z the middle of its length; `step`, rad, is the shaft angle
    between places, None for `verify.angles` places a turn. The limits, minus and plus half of `profile` along the
    normal, have columns where some lobe's recipe gives it, with empty cells for the other lobes. Lengths are in the
    recipe's unit. Raises OSError where the file cannot be written.
    """
    shaft = equal_steps(recipe.verify.angles if step is None else round(TURN / step))
    rows, limited = [], any(lobe.lobe.recipe.profile is not None for lobe in lobes)
    for number, lobe in enumerate(lobes, 1):
        zone, z = lobe.lobe.recipe.profile, 0.5 * (lobe.lobe.low + lobe.lobe.high)
        half = math.nan if zone is None else 0.5 * zone / recipe.mm
        for points in contact_points(lobe.design, shaft, lobe.design.contours):
            drawn = points.as_drawn(lobe.at, recipe.rotation)
            columns = [np.full(len(drawn.angles), number), np.full(len(drawn.angles), z / recipe.mm)]
            columns += [np.mod(np.degrees(drawn.angles + lobe.zero), 360.0), *(drawn.places / recipe.mm).T]
            columns += list(drawn.normals.T)
            columns += [np.full(len(drawn.angles), sign * half) for sign in ((-1.0, 1.0) if limited else ())]
            rows.append(np.column_stack(columns))
    unit = UNIT_NAMES[recipe.units]
    heads = ["lobe", f"z_{unit}", "shaft_deg", f"x_{unit}", f"y_{unit}", "nx", "ny"]
    heads += [f"lower_{unit}", f"upper_{unit}"] if limited else []
    write_table(path, heads, np.concatenate(rows), gaps=True)
