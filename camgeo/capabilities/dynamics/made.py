# needs: made
"""Forces, pressures and float speeds of a follower train in the motion that a made part gives it.

The figures of a rigid follower follow from position, velocity and acceleration of the made motion, and under preload
from the gap that the metal leaves between the contacts. Their uncertainty is the root of the sum of squares of the
changes that one standard deviation of each quantity makes, times COVERAGE.

An elastic train is linear while contact holds: its steady force is that of the intended motion plus its response to the
error of the motion, which is a weighted sum of errors. The uncertainty is that of this sum.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from camgeo.capabilities.dynamics.elastic import steady_force
from camgeo.capabilities.dynamics.keys import Dynamics
from camgeo.capabilities.dynamics.running_forces import FollowerRunning, follower_running
from camgeo.capabilities.made.extension import MadeFigure, MadeFigures, OnMetal
from kin.numeric.angles import TURN, degrees

if TYPE_CHECKING:
    from camgeo.capabilities.made.extension import MadeMotion
    from camgeo.recipe.recipe import Recipe
    from camgeo.synthesis.design import Design
    from kin.numeric.arrays import Array

COVERAGE = 2.0  # standard deviations of an expanded uncertainty
LINKAGE = "forces on the made part are not found under a linkage"
BACKLASH = "impacts of a train with backlash are not followed on the made part: which face bears is not settled by it"
SECOND = "of an elastic train whose follower has two contacts under a spring no forces on the made part are found"
ELASTIC_SPEED = (
    "the speed from which an elastic train floats is not searched on the made part, whose motion is a sum of waves"
)
LEAST_FORCE, FLOAT_SPEED, LEAST_PRELOAD = "least contact force", "float speed", "least preload"


def figures_on_metal(recipe: Recipe, design: Design, motion: MadeMotion) -> MadeFigures:
    """Greatest and least figures of the made motion, with those of the intended one, and remarks on what is left out.

    Both are empty for a recipe without dynamics; figures are empty where the stem jams. Raises RecipeErrors for a load
    that has no value or no bound or is too large, for a contact that nothing holds on the cam, for preloaded contacts
    that wedge the stem, and for an elastic train without a steady state; RoughError for too abrupt a motion.
    """
    train = recipe.of(Dynamics)
    if train is None:
        return MadeFigures()
    if design.driven is not None:
        return MadeFigures(remarks=(LINKAGE,))
    if train.stiffness is None:
        return MadeFigures(_rigid(recipe, design, train, motion))
    figures = [] if train.material is None else _rigid(recipe, design, train, motion)
    if train.backlash is not None or len(design.follower.contacts) > 1:
        return MadeFigures(figures, (BACKLASH if train.backlash is not None else SECOND,))
    return MadeFigures([*figures, *_elastic(recipe, design, train, motion)], (ELASTIC_SPEED,))


def _rigid(recipe: Recipe, design: Design, train: Dynamics, motion: MadeMotion) -> list[MadeFigure]:
    """Figures of the rigid follower; none where its stem jams."""
    running = follower_running(recipe, design, train)
    return [] if running.jam_deg is not None else _figures(running, motion)  # a stem that jams fails a check


def _elastic(recipe: Recipe, design: Design, train: Dynamics, motion: MadeMotion) -> list[MadeFigure]:
    """Greatest and least contact force of the steady state at the recipe's speed, N or N m."""
    running, intended = steady_force(recipe, design, train, motion.shaft)
    count = len(motion.shaft)
    # the response to periodic errors, harmonic by harmonic
    transfer = design.exact.gauge.si * running.transfer(count)
    made = intended + np.fft.irfft(transfer * np.fft.rfft(motion.errors[0]), count)
    row = np.roll(np.fft.irfft(transfer, count)[::-1], 1)  # weights of the errors in the force at the first angle
    row -= row.mean()  # assembly sets the offset, which is no error
    unit = "N m" if design.follower.arrangement.unit == "deg" else "N"
    figures = []
    for name, pick in (("contact force, elastic", np.argmax), ("least contact force, elastic", np.argmin)):
        at = int(pick(made))
        unsure = COVERAGE * motion.deviation(np.roll(row, at))
        intended_value = float(intended[pick(intended)])
        figures.append(
            MadeFigure(name, unit, intended_value, float(made[at]), unsure, degrees(float(motion.shaft[at])))
        )
    return figures


def _figures(running: FollowerRunning, motion: MadeMotion) -> list[MadeFigure]:
    """Greatest force and pressure of each contact; least force and float speed of a single one, preload of two."""
    # position, velocity, acceleration and gap, intended and made
    gap, gap_sd = np.zeros((2, len(motion.shaft))) if motion.gap is None else motion.gap
    intended = np.vstack([running.turn.rows(motion.shaft), np.zeros_like(gap)])
    made = intended + np.vstack([motion.errors, gap])
    first, rows = (_rows(running, motion.shaft, motion_rows) for motion_rows in (intended, made))
    # squares of the changes by one standard deviation of each of the four
    square = {name: np.zeros_like(row) for name, row in rows.items()}
    for order, sd in enumerate([*motion.sds, gap_sd]):
        more = made.copy()
        more[order] += sd
        with np.errstate(invalid="ignore"):  # float speeds may be infinite: inf - inf
            for name, row in _rows(running, motion.shaft, more).items():
                square[name] += (row - rows[name]) ** 2
    figures = []
    for figure, row in rows.items():
        if not np.isfinite(row).any():  # the follower floats at no speed
            continue
        least = figure[0] in {LEAST_FORCE, FLOAT_SPEED, LEAST_PRELOAD}
        at = int(np.nanargmin(row) if least else np.nanargmax(row))
        intended_figure = float(np.nanmin(first[figure]) if least else np.nanmax(first[figure]))
        unsure = COVERAGE * math.sqrt(float(square[figure][at]))
        figures.append(MadeFigure(*figure, intended_figure, float(row[at]), unsure, degrees(float(motion.shaft[at]))))
    return figures


def _rows(running: FollowerRunning, shaft: Array, rows: Array) -> dict[tuple[str, str], Array]:
    """Forces, pressures, float speeds and preload (n,) at shaft angles (n,), rad, by name and unit.

    `rows` (4, n) are position, velocity and acceleration of the follower, and the gap between its contacts; mm or rad.
    """
    state, names = running.in_motion(shaft, rows[:3], rows[3]), running.turn.names
    endings = [f", {name}" if len(names) > 1 else "" for name in names]
    by_name = {(f"contact force{ending}", "N"): row for ending, row in zip(endings, state.normal, strict=True)}
    if state.pressure is not None:
        named = zip(endings, state.pressure, strict=True)
        by_name |= {(f"pressure{ending}", "N/mm^2"): row for ending, row in named}
    if len(names) == 1:
        moved = running.moved
        held = np.full(len(shaft), True) if moved is None or moved.coil is None else moved.is_open(shaft)
        by_name[LEAST_FORCE, "N"] = np.where(held, state.normal[0], np.nan)
        by_name[FLOAT_SPEED, "rpm"] = np.where(held, _float_speed(running, shaft, rows[:3]), np.nan)
    preload = running.preload_force(rows[:3], rows[3])
    if preload is not None:
        by_name[LEAST_PRELOAD, running.turn.unit] = preload
    return by_name


def _float_speed(running: FollowerRunning, shaft: Array, rows: Array) -> Array:
    """Speeds, turns a minute (n,), from which inertia lifts the follower off the cam at shaft angles `shaft` (n,), rad.

    `rows` (3, n) are position and two derivatives, mm or rad. Contact is lost where inertia pulls more than spring and
    load press. A speed is infinite where inertia presses the follower on, and nan where the acceleration is not known.
    """
    t = running.turn.parameter(shaft)
    holds, pull = running.rest(t, running.position(rows)[0]) + running.preload, -running.inertia(t, rows, 1.0)
    with np.errstate(divide="ignore", invalid="ignore"):
        speed: Array = np.where(pull > 0.0, np.sqrt(np.maximum(holds, 0.0) / pull) * 60.0 / TURN, np.inf)
    return np.where(np.isnan(pull), np.nan, speed)


ANSWERS = OnMetal(figures=figures_on_metal)
