"""Polishing a design: from where a sweep has found it to the best place near it, off the grid.

The figure to be best in is seldom smooth. A dwell is longest where its ripple just fills the band, and one step farther
it falls in two. So differential evolution searches a cloud of designs about the start, all computed together, and
Nelder and Mead's simplex walks on from the best of them; both from scipy, with a fixed seed.

A cam within its tolerance moves the output by a little, and a ripple that just fills the band then leaves it. So dwells
are sought within a band less twice that error: a file's dwell is at least as long as the one that was sought.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, TypeAlias

import numpy as np
from numpy.typing import NDArray

from camgeo.capabilities.sweep.certify import slack
from camgeo.capabilities.sweep.figures import DWELLS, Evaluator
from camgeo.capabilities.sweep.rebuilt import mechanism_in, recipe_with
from camgeo.common.rounding import downward
from kin.numeric.errors import CamgeoError
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from collections.abc import Sequence

    from camgeo.capabilities.sweep.ask import Ask
    from camgeo.recipe.limits import Limit
    from camgeo.recipe.recipe import Recipe

Array: TypeAlias = NDArray[np.float64]

_SEED = 5
_ANGLES = 720  # at least so many samples; extremes and ends between them are then good to about 1e-7
_CLOUD = 0.04  # of each range: the spread of the cloud about the start
_MEMBERS = 40
_GENERATIONS, _STEPS = 150, 400
_SLOW_GENERATIONS, _SLOW_STEPS = 6, 150  # where each design is a recipe of its own
_TIGHTER = 1e-6  # relatively: limits as they are sought, so that no rounding of a figure breaks them
_DIGITS = 6  # of each range, that a polished value keeps
_WORTH = 1e-3
_IDLE = 1e-9  # relatively: what is gained by less is rounding, and the start stays
_FAR = 1e6  # what breaks a limit is worse than anything that does not
_ROOM = 1.05  # times the output error of the start: that of designs near it differs by a few percent
_ROUNDS = 3  # of a search whose result has a greater output error than it was sought with


class PolishError(CamgeoError, ValueError):
    """A design that cannot be polished."""


@dataclass(frozen=True)
class _Goal:
    """Loss of designs within the unit cube of the ranges that are free; the other values stay as they are."""

    evaluator: Evaluator
    rank: str
    most: bool
    limits: tuple[Limit, ...]
    start: Array
    free: NDArray[np.intp]
    low: Array
    span: Array

    def values(self, share: Array) -> Array:
        """Values (m, axes) of designs at places (m, free) in the cube."""
        values = np.repeat(self.start[None], len(share), axis=0)
        values[:, self.free] = self.low + self.span * share
        return values

    def loss(self, values: Array) -> Array:
        """The rank's figure (m,), less is better, and above all others where a limit is broken."""
        return self.loss_of(self.evaluator.found(values).figures)

    def loss_of(self, figures: dict[str, Array]) -> Array:
        """The same for designs whose figures are known."""
        lost = -figures[self.rank] if self.most else figures[self.rank]
        broken = np.zeros(len(lost))
        for limit in self.limits:
            figure = figures[limit.figure]
            for bound, sign in ((limit.at_least, 1.0), (limit.at_most, -1.0)):
                if bound is not None:
                    size = max(abs(bound), 1.0)
                    broken += np.maximum(sign * (bound - figure) / size + _TIGHTER, 0.0)
        lost = np.where(broken > 0.0, _FAR * (1.0 + np.minimum(broken, 1e3)), lost)
        return np.where(np.isfinite(lost), lost, 1e4 * _FAR)


def polish(ask: Ask, values: dict[str, float]) -> tuple[dict[str, float], dict[str, float]]:
    """Give a design that is as good or better, and its figures in mm and degrees.

    `values` are those of a design of the sweep by their paths. Only what varies over a range moves, within that range;
    listed values stay. The result keeps the sweep's limits, or is the start. Dwells are sought within the band less
    twice the output error within the tolerance of the files; the figures are those within the band itself. Raises
    PolishError where that error leaves nothing of the band, and ModuleNotFoundError without scipy.
    """
    paths = [axis.path for axis in ask.sweep.vary]
    start = np.array([values[path] for path in paths])
    goal = _goal(ask, paths, start)
    designs = start[None]
    if len(goal.free):
        goal, found = _settled(ask, goal)
        designs = np.stack([start, found, _rounded(goal, found)])
    # all figures, in the end; the search itself looks at those that rank or limit
    whole = replace(goal.evaluator, recipe=_unlimited(ask), wanted=ask.all_figures, screened=False)
    figures = whole.found(designs).figures
    lost = replace(goal, limits=ask.sweep.limits).loss_of(figures)
    loss = lost if goal.evaluator.estimator else np.where(lost < _FAR, goal.loss(designs), lost)
    best = 0
    if len(designs) > 1 and loss[1] < min(loss[0] - _IDLE * abs(loss[0]), _FAR):
        # written with no more digits than it is worth, unless that costs a part of what was gained
        best = 2 if loss[2] - loss[1] <= _WORTH * (loss[0] - loss[1]) else 1
    return (
        {path: float(value) for path, value in zip(paths, designs[best], strict=True)},
        {name: float(column[best]) for name, column in figures.items()},
    )


def _settled(ask: Ask, goal: _Goal) -> tuple[_Goal, Array]:
    """Search; where its result has a greater output error than it was sought with, again from there.

    Gives the goal with the band of the last search, and its values (axes,): the start where no search holds.
    """
    if not {limit.figure for limit in goal.limits}.union({goal.rank}) & set(DWELLS):
        return goal, goal.values(_sought(goal)[None])[0]
    recipe, paths, start, error = _unlimited(ask), goal.evaluator.paths, goal.start, 0.0
    off = output_error(recipe_with(ask.recipe, paths, start))
    for _ in range(_ROUNDS):
        error = _ROOM * off
        goal = replace(goal, evaluator=replace(goal.evaluator, recipe=_narrowed(recipe, error)), start=start)
        start = goal.values(_sought(goal)[None])[0]
        try:
            off = output_error(recipe_with(ask.recipe, paths, start))
        except PolishError:
            break
        if off <= error:
            return goal, start
    return goal, goal.start


def output_error(recipe: Recipe) -> float:
    """Greatest error of the output within the tolerance of a recipe's files, rad or mm.

    Raises PolishError where the mechanism may bind within it, or twice the error fills the dwell's band.
    """
    from kin.follower.frame import implied_limit

    export, mechanism = recipe.export, mechanism_in(recipe)
    tolerance = max((file.tolerance or export.tolerance for file in export.files), default=export.tolerance)
    error = implied_limit(mechanism, tolerance)
    told = f"{tolerance / recipe.mm:.6g} {'in' if recipe.units == 'inch' else 'mm'}"
    if error is None:
        raise PolishError(f"the mechanism may bind within the tolerance of {told}: give a smaller export.tolerance")
    swings = mechanism.unit == "deg"
    off = math.radians(error) if swings else error
    if recipe.dwell is None or 2.0 * _ROOM * off < recipe.dwell.band:
        return off
    size = f"{error:.3g} deg" if swings else f"{error / recipe.mm:.3g} {'in' if recipe.units == 'inch' else 'mm'}"
    most = downward(tolerance / recipe.mm * recipe.dwell.band / (4.0 * off))
    raise PolishError(
        f"within the tolerance of {told} the output may be off by {size} either way, which leaves nothing of "
        f"dwell.band: give export.tolerance at most {most}"
    )


def _narrowed(recipe: Recipe, error: float) -> Recipe:
    """The recipe with its dwell's band less twice an error of the output, rad or mm."""
    dwell = recipe.dwell
    return recipe if dwell is None else replace(recipe, dwell=replace(dwell, band=dwell.band - 2.0 * error))


def _unlimited(ask: Ask) -> Recipe:
    """The recipe with a sweep that computes all designs, whatever limits are broken."""
    return ask.recipe.with_value(replace(ask.sweep, limits=()))


def _goal(ask: Ask, paths: Sequence[str], start: Array) -> _Goal:
    sweep = ask.sweep
    free = np.array([i for i, axis in enumerate(sweep.vary) if not axis.values and not axis.words], dtype=np.intp)
    low = np.array([axis.low for axis in sweep.vary])[free]
    high = np.array([axis.high for axis in sweep.vary])[free]
    wanted = (sweep.rank, *(limit.figure for limit in sweep.limits))
    evaluator = Evaluator.of(_unlimited(ask), paths, figures=wanted, samples=max(sweep.angles, _ANGLES), screened=True)
    limits = sweep.limits if evaluator.estimator is None else tuple(map(_surely, sweep.limits))
    return _Goal(evaluator, sweep.rank, ask.ranking.most, limits, start, free, low, high - low)


def _surely(limit: Limit) -> Limit:
    """The limit that an estimate must keep for the exact figure to keep the one asked for."""
    by = slack(limit)
    least, most = limit.at_least, limit.at_most
    return replace(limit, at_least=None if least is None else least + by, at_most=None if most is None else most - by)


def _sought(goal: _Goal) -> Array:
    """Search about the start; the best place found in the cube (free,)."""
    from scipy.optimize import differential_evolution, minimize

    start = np.clip((goal.start[goal.free] - goal.low) / goal.span, 0.0, 1.0)
    slow = goal.evaluator.slow
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
    corners = evolved.x + 0.25 * _CLOUD * np.eye(len(start) + 1, len(start), k=-1)
    corners = np.where(corners > 1.0, 2.0 * evolved.x - corners, corners)
    walked = minimize(
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
    best: Array = walked.x if walked.fun < evolved.fun else evolved.x
    return best


def _rounded(goal: _Goal, values: Array) -> Array:
    """Values rounded to a millionth of their ranges, within them."""
    rounded = values.copy()
    for i, low, span in zip(goal.free, goal.low, goal.span, strict=True):
        digits = _DIGITS - math.floor(math.log10(span))
        rounded[i] = min(max(round(float(values[i]), digits), float(low)), float(low + span)) + 0.0  # and not -0
    return rounded
