"""Forces, pressures and the float speed of a rigid follower in the motion that a made part gives it.

They follow from position, velocity and acceleration as those of the intended motion do, curvature of the contour
included. Their uncertainty is that of these three, each by what a standard deviation more of it adds.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from camgeo.capabilities.dynamics.keys import Dynamics
from camgeo.capabilities.dynamics.running_forces import FollowerRunning, follower_running
from camgeo.registry.capability import MadeFigure, MadeFigures
from kin.numeric.angles import TURN, degrees

if TYPE_CHECKING:
    from camgeo.recipe.recipe import Recipe
    from camgeo.registry.capability import MadeMotion
    from camgeo.synthesis.design import Design
    from kin.numeric.arrays import Array

COVERAGE = 2.0  # standard deviations of an expanded uncertainty
LINKAGE = "forces on the made part are not found under a linkage"
ELASTIC = "forces on the made part are those of a rigid follower: an elastic train is not followed on it"
NO_FORCES = "of an elastic train no forces on the made part are found; with dynamics.material those of a rigid one are"
LEAST_FORCE, FLOAT_SPEED = ("least contact force", "N"), ("float speed", "rpm")
LEAST = {LEAST_FORCE, FLOAT_SPEED}
PRELOADED = "forces on the made part have the preload of the intended one"


def figures_on_metal(recipe: Recipe, design: Design, motion: MadeMotion) -> MadeFigures:
    """Figures of the made motion beside those intended at the same shaft angles; see `Capability.on_metal`."""
    train = recipe.of(Dynamics)
    if train is None:
        return MadeFigures()
    if design.driven is not None:
        return MadeFigures(remarks=(LINKAGE,))
    if train.stiffness is not None and train.material is None:
        return MadeFigures(remarks=(NO_FORCES,))
    running = follower_running(recipe, design, train)
    if running.jam_deg is not None:  # which a check tells
        return MadeFigures()
    remarks = [ELASTIC] if train.stiffness is not None else []
    remarks += [PRELOADED] if design.exact.preload is not None else []
    return MadeFigures(_figures(running, motion), remarks)


def _figures(running: FollowerRunning, motion: MadeMotion) -> list[MadeFigure]:
    """Greatest force and pressure of each contact; of a single one its least force and its float speed as well."""
    intended = running.turn.rows(motion.shaft)
    made = intended + motion.errors
    first, rows = (_rows(running, motion.shaft, each) for each in (intended, made))
    square = {name: np.zeros_like(row) for name, row in rows.items()}
    for order, sd in enumerate(motion.sds):
        more = made.copy()
        more[order] += sd
        with np.errstate(invalid="ignore"):  # speeds that nothing takes it off at
            for name, row in _rows(running, motion.shaft, more).items():
                square[name] += (row - rows[name]) ** 2
    figures = []
    for figure, row in rows.items():
        if not np.isfinite(row).any():  # nothing takes the follower off at any speed
            continue
        least = figure in LEAST
        at = int(np.nanargmin(row) if least else np.nanargmax(row))
        meant = float(np.nanmin(first[figure]) if least else np.nanmax(first[figure]))
        unsure = COVERAGE * math.sqrt(float(square[figure][at]))
        figures.append(MadeFigure(*figure, meant, float(row[at]), unsure, degrees(float(motion.shaft[at]))))
    return figures


def _rows(running: FollowerRunning, shaft: Array, rows: Array) -> dict[tuple[str, str], Array]:
    """Forces, pressures and torque (n,) at shaft angles (n,), rad, by name and unit, of a motion (3, n)."""
    state, names = running.in_motion(shaft, rows), running.turn.names
    of = [f", {name}" if len(names) > 1 else "" for name in names]
    found = {(f"contact force{ending}", "N"): row for ending, row in zip(of, state.normal, strict=True)}
    if state.pressure is not None:
        each = zip(of, state.pressure, strict=True)
        found |= {(f"pressure{ending}", "N/mm^2"): row for ending, row in each}
    if len(names) == 1:
        found[LEAST_FORCE] = state.normal[0]
        found[FLOAT_SPEED] = _float_speed(running, shaft, state.rows)
    return found


def _float_speed(running: FollowerRunning, shaft: Array, y: Array) -> Array:
    """Speeds, turns a minute, from which inertia takes the follower off the cam, (n,); infinite where at none.

    `y` are position and two derivatives, SI: what holds the follower there is m Omega^2 (-y'').
    """
    holds = running.rest(running.turn.parameter(shaft), y[0]) + running.preload
    pull = -running.train.mass * y[2]
    with np.errstate(divide="ignore", invalid="ignore"):
        speed: Array = np.where(pull > 0.0, np.sqrt(np.maximum(holds, 0.0) / pull) * 60.0 / TURN, np.inf)
    return np.where(np.isnan(pull), np.nan, speed)
