"""Polishing a design: a search near it, off the grid.

The figure to be optimised is seldom smooth: a dwell is longest where its ripple just fills the band, and one step
farther it is two. So differential evolution searches a cloud of designs about the start, all computed together, and
Nelder and Mead's simplex continues from the best of them; both from scipy, with a fixed seed.

A cam within its tolerance moves the output by a little, and a ripple that just fills the band then leaves it. So dwells
are optimised within a band less twice that error: the dwell of a file is at least as long as the optimum.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from camgeo.capabilities.sweep.figures import DWELLS, Evaluator
from camgeo.capabilities.sweep.screen import slack
from camgeo.capabilities.sweep.single_designs import mechanism_in, recipe_with
from camgeo.common.rounding import downward
from kin.numeric.errors import CamgeoError
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from collections.abc import Sequence

    from camgeo.capabilities.sweep.task import SweepTask
    from camgeo.recipe.limits import Limit
    from camgeo.recipe.recipe import Recipe
    from kin.numeric.arrays import Array, Indices

_SEED = 5
_ANGLES = 720  # at least so many samples; extremes and ends between them are then good to about 1e-7
_CLOUD = 0.04  # of each range: the spread of the cloud about the start
_MEMBERS = 40
_GENERATIONS, _STEPS = 150, 400
_SLOW_GENERATIONS, _SLOW_STEPS = 6, 150  # where each design is a recipe of its own
_TIGHTER = 1e-6  # relatively: limits in the search are so much narrower, so that rounding a figure breaks none
_DIGITS = 6  # of each range, that a polished value keeps
_ROUNDING_COST = 1e-3  # share of the gain that rounding the values may cost
_LEAST_GAIN = 1e-9  # relatively: a smaller one is rounding, and the start stays
_BROKEN = 1e6  # loss of a design that breaks a limit, greater than any other
_ERROR_FACTOR = 1.05  # times the output error of the start: that of designs near it differs by a few percent
_ROUNDS = 3  # of the search, until its result has no greater output error than was allowed for


class PolishError(CamgeoError, ValueError):
    """A design cannot be polished: its message says why, and what to change."""


@dataclass(frozen=True)
class _Goal:
    """Loss of designs by their places in the unit cube of the axes that are ranges; other values stay as in `start`.

    `start` (axes,) are values in the recipe's units. `free` (f,) are the columns of the ranges, which run from `low`
    (f,) to `low` + `span`. `rank` is the ranking's figure, the greatest is best if `most`.
    """

    evaluator: Evaluator
    rank: str
    most: bool
    limits: tuple[Limit, ...]
    start: Array
    free: Indices
    low: Array
    span: Array

    def values(self, share: Array) -> Array:
        """Values (m, axes) of designs at the places `share` (m, f) in the cube, 0 to 1 in each range."""
        values = np.repeat(self.start[None], len(share), axis=0)
        values[:, self.free] = self.low + self.span * share
        return values

    def loss(self, values: Array) -> Array:
        """Loss (m,) of designs with values (m, axes): the ranking's figure, less is better; large beyond a limit."""
        return self.loss_of(self.evaluator.evaluate(values).figures)

    def loss_of(self, figures: dict[str, Array]) -> Array:
        """Loss (m,) of designs with these figures: the ranking's figure, less is better; large beyond a limit."""
        loss = -figures[self.rank] if self.most else figures[self.rank]
        broken = np.zeros(len(loss))
        for limit in self.limits:
            figure = figures[limit.figure]
            for bound, sign in ((limit.at_least, 1.0), (limit.at_most, -1.0)):
                if bound is not None:
                    size = max(abs(bound), 1.0)
                    broken += np.maximum(sign * (bound - figure) / size + _TIGHTER, 0.0)
        loss = np.where(broken > 0.0, _BROKEN * (1.0 + np.minimum(broken, 1e3)), loss)
        return np.where(np.isfinite(loss), loss, 1e4 * _BROKEN)


def polish(task: SweepTask, values: dict[str, float]) -> tuple[dict[str, float], dict[str, float]]:
    """Values by path of a design as good or better, and its figures by name, mm and degrees.

    `values` are the values, by path, of a design of the sweep. Only what varies over a range changes, within it; listed
    values stay. The result keeps the sweep's limits, or is the start. Dwells are optimised within the band less twice
    the output error within the tolerance of the files; the figures are those within the band itself. Where a dwell
    ranks or limits, raises PolishError if the mechanism may bind within the tolerance, or the error leaves nothing of
    the band. Raises ModuleNotFoundError without scipy.
    """
    paths = [axis.path for axis in task.sweep.vary]
    start = np.array([values[path] for path in paths])
    goal = _goal(task, paths, start)
    designs = start[None]
    if len(goal.free):
        goal, optimum = _optimise(task, goal)
        designs = np.stack([start, optimum, _rounded(goal, optimum)])
    # all figures, in the end; the search itself computes those that rank or limit
    exact = replace(goal.evaluator, recipe=_unlimited(task), names=task.all_figures, screened=False)
    figures = exact.evaluate(designs).figures
    loss = replace(goal, limits=task.sweep.limits).loss_of(figures)
    if not goal.evaluator.estimator:
        loss = np.where(loss < _BROKEN, goal.loss(designs), loss)
    best = 0
    if len(designs) > 1 and loss[1] < min(loss[0] - _LEAST_GAIN * abs(loss[0]), _BROKEN):
        # rounded values, unless they cost a part of what was gained
        best = 2 if loss[2] - loss[1] <= _ROUNDING_COST * (loss[0] - loss[1]) else 1
    return (
        {path: float(value) for path, value in zip(paths, designs[best], strict=True)},
        {name: float(column[best]) for name, column in figures.items()},
    )


def _optimise(task: SweepTask, goal: _Goal) -> tuple[_Goal, Array]:
    """Search for the best values (axes,); return the goal, with the band of the last search, and the values.

    Where the result has a greater output error than the band allows for, the search starts again from there; after
    `_ROUNDS` searches the start of the last is returned.
    """
    if not {limit.figure for limit in goal.limits}.union({goal.rank}) & set(DWELLS):
        return goal, goal.values(_minimum(goal)[None])[0]
    recipe, paths, start = _unlimited(task), goal.evaluator.paths, goal.start
    error = output_error(recipe_with(task.recipe, paths, start))
    for _ in range(_ROUNDS):
        allowed = _ERROR_FACTOR * error
        if recipe.dwell is not None:
            narrow = replace(recipe, dwell=replace(recipe.dwell, band=recipe.dwell.band - 2.0 * allowed))
            goal = replace(goal, evaluator=replace(goal.evaluator, recipe=narrow), start=start)
        start = goal.values(_minimum(goal)[None])[0]
        try:
            error = output_error(recipe_with(task.recipe, paths, start))
        except PolishError:
            break
        if error <= allowed:
            return goal, start
    return goal, goal.start


def output_error(recipe: Recipe) -> float:
    """Greatest error of the output within the tolerance of a recipe's files, rad or mm.

    The recipe has a linkage. Raises PolishError where the mechanism may bind within the tolerance, or twice the error,
    times `_ERROR_FACTOR`, fills the band of a dwell.
    """
    from kin.follower.frame import implied_limit

    export, mechanism = recipe.export, mechanism_in(recipe)
    tolerance = max((file.tolerance or export.tolerance for file in export.files), default=export.tolerance)
    error = implied_limit(mechanism, tolerance)
    within = f"{tolerance / recipe.mm:.6g} {'in' if recipe.units == 'inch' else 'mm'}"
    if error is None:
        raise PolishError(f"the mechanism may bind within the tolerance of {within}: give a smaller export.tolerance")
    swings = mechanism.unit == "deg"
    bound = math.radians(error) if swings else error
    if recipe.dwell is None or 2.0 * _ERROR_FACTOR * bound < recipe.dwell.band:
        return bound
    size = f"{error:.3g} deg" if swings else f"{error / recipe.mm:.3g} {'in' if recipe.units == 'inch' else 'mm'}"
    # a tolerance by which the error either way takes half of the band
    most = downward(tolerance / recipe.mm * recipe.dwell.band / (4.0 * bound))
    raise PolishError(
        f"within the tolerance of {within} the output may be off by {size} either way, which leaves nothing of "
        f"dwell.band: give export.tolerance at most {most}"
    )


def _unlimited(task: SweepTask) -> Recipe:
    """The recipe with a sweep without limits, so that figures of every design are computed."""
    return task.recipe.with_value(replace(task.sweep, limits=()))


def _goal(task: SweepTask, paths: Sequence[str], start: Array) -> _Goal:
    """Goal of a task from the values `start` (axes,), within the recipe's own band."""
    sweep = task.sweep
    free = np.array([i for i, axis in enumerate(sweep.vary) if axis.is_range], dtype=np.intp)
    low = np.array([axis.low for axis in sweep.vary])[free]
    high = np.array([axis.high for axis in sweep.vary])[free]
    names = (sweep.rank, *(limit.figure for limit in sweep.limits))
    evaluator = Evaluator.prepare(
        _unlimited(task), paths, figures=names, samples=max(sweep.angles, _ANGLES), screened=True
    )
    limits = sweep.limits if evaluator.estimator is None else tuple(map(_tightened, sweep.limits))
    return _Goal(evaluator, sweep.rank, task.ranking.most, limits, start, free, low, high - low)


def _tightened(limit: Limit) -> Limit:
    """The limit that an estimate must keep so that the exact figure keeps the sweep's."""
    by = slack(limit)
    least, most = limit.at_least, limit.at_most
    return replace(limit, at_least=None if least is None else least + by, at_most=None if most is None else most - by)


def _minimum(goal: _Goal) -> Array:
    """Place in the cube (f,) of the least loss near the start."""
    from scipy.optimize import differential_evolution, minimize

    start = np.clip((goal.start[goal.free] - goal.low) / goal.span, 0.0, 1.0)
    slow = goal.evaluator.slow
    # differential evolution of a cloud about the start, one batch of designs per generation
    rng = np.random.default_rng(_SEED)
    cloud = np.clip(start + _CLOUD * rng.standard_normal((_MEMBERS, len(start))), 0.0, 1.0)
    cloud[0] = start
    box = [(0.0, 1.0)] * len(start)
    evolved = differential_evolution(
        lambda share: goal.loss(goal.values(share.T)),
        box,
        init=cloud,
        maxiter=_SLOW_GENERATIONS if slow else _GENERATIONS,
        tol=0.0,
        mutation=(0.3, 0.8),
        rng=_SEED,
        polish=False,
        updating="deferred",
        vectorized=True,
    )
    # Nelder and Mead's simplex from its best, corners beyond the cube mirrored
    corners = evolved.x + 0.25 * _CLOUD * np.eye(len(start) + 1, len(start), k=-1)
    corners = np.where(corners > 1.0, 2.0 * evolved.x - corners, corners)
    simplex = minimize(
        lambda share: float(goal.loss(goal.values(share[None]))[0]),
        evolved.x,
        method="Nelder-Mead",
        bounds=box,
        options={
            "initial_simplex": corners,
            "maxfev": _SLOW_STEPS if slow else _STEPS,
            "xatol": 1e-8,
            "fatol": 1e-9,
            "adaptive": True,
        },
    )
    best: Array = simplex.x if simplex.fun < evolved.fun else evolved.x
    return best


def _rounded(goal: _Goal, values: Array) -> Array:
    """Values (axes,), in ranges rounded to a millionth of the range or finer, within it; others stay."""
    rounded = values.copy()
    for i, low, span in zip(goal.free, goal.low, goal.span, strict=True):
        digits = _DIGITS - math.floor(math.log10(span))
        rounded[i] = min(max(round(float(values[i]), digits), float(low)), float(low + span)) + 0.0  # and not -0
    return rounded
