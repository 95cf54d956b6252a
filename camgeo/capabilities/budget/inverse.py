"""The widest tolerances that stay within a permitted error at every angle.

T is the permitted error, w the influence of a free dimension, t its tolerance, rest the sum of the others. A single
free dimension gets what the others leave: (T - rest)/w in the worst case, sqrt(T^2 - rest^2)/w as root of the sum of
squares. Several free dimensions get the tolerances of least cost, sum c_i/t_i^k. With t_i = exp(x_i) the cost and the
constraints are sums of exponentials of linear functions. So the problem is convex (a geometric programme), and it has
one optimum:

    least sum c_i/t_i^k   with   sum_i w_ij^q t_i^q <= T_j^q  at every angle j,  q = 1 worst case, 2 squares,

T_j^q = T^q - rest_j^q; the error of a contour that is not exact is taken from T beforehand. The problem's dual has a
multiplier for each angle, which is 0 where the angle does not bind (Boyd, Vandenberghe, Convex Optimization, 2004, 4.5
and 5.5). With multipliers m_j the tolerances are

    t_i = (k c_i/(q sum_j m_j w_ij^q))^(1/(k + q)).

A single angle has a closed form: t_i = T sqrt(c_i/w_i)/sum sqrt(c_j w_j) for k = q = 1.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from camgeo.capabilities.budget.dimensions import CONTOUR
from camgeo.capabilities.budget.sums import POWERS, by_name, powers, total
from kin.numeric.errors import CamgeoError

if TYPE_CHECKING:
    from collections.abc import Mapping

    from camgeo.capabilities.budget.influence import Influence
    from camgeo.capabilities.budget.sums import Sum
    from kin.numeric.arrays import Array, Indices

NEAR = 1e-6  # relative excess below which Newton's step is taken whole: rounding hides whether the bound rises
STRAIGHT = 1e-6  # of the greatest excess: what Newton's step leaves below that is rounding
SINGULAR = 1e-9  # of the greatest singular value of the bend: a lesser one counts as 0
BROKEN = 1e-11  # share of what is permitted by which a sum may exceed it in the course of the search
LEAST_STEP = 1e-12  # share of Newton's step below which nothing is gained
MOST_STEPS = 200  # of Newton's method; ten are usual


class TakenError(CamgeoError, ValueError):
    """The stated dimensions, or the contour, leave nothing of the permitted error.

    `name` is the word of the dimension that takes most, or CONTOUR, `taken` what it takes, mm or rad of the motion, and
    `at` the shaft angle, rad. `needed` is the greatest sum of all that is stated, mm or rad: more permitted leaves
    something.
    """

    def __init__(self, name: str, taken: float, at: float, needed: float) -> None:
        super().__init__(f"{name} takes most of it")
        self.name = name
        self.taken = taken
        self.at = at
        self.needed = needed


class Split(NamedTuple):
    """Tolerances of the free dimensions by their words, mm or rad, and their cost.

    `binding` has the rising shaft angles, rad, at which nothing of the permitted error is left.
    """

    tolerances: Mapping[str, float]
    cost: float
    binding: tuple[float, ...]


class Constraints(NamedTuple):
    """Constraints weights @ t^q <= left on the tolerances t (f,) of the f free dimensions `names`.

    q is the power of the sum: 1 for the worst case, 2 for the root of the sum of squares. There are n rows: all shaft
    angles of the first contact, then of the next. `weights` (n, f) are influences to the power q. `left` (n,) is T^q
    less the addends of the other dimensions, T the permitted error less that of the contour, mm or rad. `at` (n,) are
    the shaft angles, rad.
    """

    names: tuple[str, ...]
    weights: Array
    left: Array
    at: Array


def constraints(influence: Influence, permitted: float, sum_: Sum) -> Constraints:
    """The constraints on the free dimensions, those without a tolerance, by the permitted error, mm or rad.

    Raises TakenError where the stated dimensions and the contour take all that is permitted at some angle.
    """
    q = POWERS[sum_]
    free = tuple(dict.fromkeys(row.name for row in influence.contributions if row.tolerance is None))
    weights, left = [], []
    for output in influence.outputs():
        spent = by_name(influence, powers(influence, output, sum_))
        contour = np.abs(output.contour)
        unspent = np.maximum(permitted - contour, 0.0) ** q - np.sum([*spent.values()], axis=0)
        if not unspent.min() > 0.0:
            place = int(unspent.argmin())
            taken = {name: float(added[place]) ** (1.0 / q) for name, added in spent.items()}
            taken[CONTOUR] = float(contour[place])
            name = max(taken, key=taken.__getitem__)
            needed = max(float(total(influence, each, sum_).max()) for each in influence.outputs())
            raise TakenError(name, taken[name], float(influence.shaft[place]), needed)
        per_tolerance = by_name(influence, output.weights**q)
        weights.append(np.stack([per_tolerance[name] for name in free], axis=1))
        left.append(unspent)
    return Constraints(free, np.concatenate(weights), np.concatenate(left), np.tile(influence.shaft, len(weights)))


def left_for(influence: Influence, permitted: float, sum_: Sum) -> Array:
    """Greatest tolerance of the only free dimension at each shaft angle, (n,), mm or rad, the least by any contact.

    It is infinite where the dimension has no influence. `permitted` is the permitted error, mm or rad. Raises
    TakenError where the stated dimensions and the contour take all that is permitted at some angle.
    """
    limits = constraints(influence, permitted, sum_)
    (column,) = limits.weights.T
    with np.errstate(divide="ignore"):
        left = (limits.left / column) ** (1.0 / POWERS[sum_])
    least: Array = left.reshape(-1, len(influence.shaft)).min(axis=0)
    return least


def widest(
    influence: Influence, permitted: float, cost: Mapping[str, float], sum_: Sum, exponent: float = 1.0
) -> Split:
    """Tolerances t of the free dimensions at which the sum of c/t^exponent is least; `cost` has c by the dimension.

    The costs are those of tolerances in mm or rad. `permitted` is the permitted error, mm or rad. A dimension without
    influence at all angles gets an infinite tolerance. Raises TakenError where the stated dimensions and the contour
    take all that is permitted at some angle, ArithmeticError where the search does not end.
    """
    limits = constraints(influence, permitted, sum_)
    weights = limits.weights / limits.left[:, None]
    # dimensions without influence take no part in the problem
    moves = weights.max(axis=0) > 0.0
    names = [name for name, does in zip(limits.names, moves, strict=True) if does]
    tolerances = dict.fromkeys(limits.names, math.inf)
    if not names:
        return Split(tolerances, 0.0, ())
    problem = Problem(weights[:, moves], np.array([cost[name] for name in names]), POWERS[sum_], exponent)
    least, binding = _least_cost(problem)
    tolerances |= dict(zip(names, least.tolist(), strict=True))
    angles = sorted({float(limits.at[place]) for place in binding})
    return Split(tolerances, float(problem.cost(least)), tuple(angles))


class Problem(NamedTuple):
    """Optimisation problem: least sum of costs (f,)/t^k over tolerances t (f,), with weights (n, f) @ t^q <= 1."""

    weights: Array
    costs: Array
    q: int
    k: float

    def at(self, angles: Indices) -> Problem:
        """Problem with the constraints of these indices (a,) alone."""
        return self._replace(weights=self.weights[angles])

    def cost(self, tolerances: Array) -> float:
        """Cost of tolerances (f,), mm or rad, in the unit of `costs`."""
        return float((self.costs / tolerances**self.k).sum())

    def cheapest(self, multipliers: Array) -> Array:
        """Tolerances t (f,), mm or rad, at which cost + multipliers (n,) @ (weights @ t^q - 1) is least."""
        cheapest: Array = (self.k * self.costs / (self.q * (multipliers @ self.weights))) ** (1.0 / (self.k + self.q))
        return cheapest


def _least_cost(problem: Problem) -> tuple[Array, Indices]:
    """Tolerances (f,) of the free dimensions that cost least, and the sorted indices of the constraints that bind.

    The problem is solved with few active constraints. The constraint that its solution breaks most joins them, until
    none is broken by more than BROKEN. Raises ArithmeticError where the search does not end.
    """
    weights, q = problem.weights, problem.q
    # start: where each dimension has its greatest weight, and where their sum is greatest
    active = np.unique(np.append(weights.argmax(axis=0), weights.sum(axis=1).argmax()))
    multipliers = _scaled(problem.at(active))
    for _ in range(len(weights)):
        multipliers = _multipliers(multipliers, problem.at(active))
        tolerances = problem.at(active).cheapest(multipliers)
        totals = weights @ tolerances**q
        worst = int(totals.argmax())
        if totals[worst] <= 1.0 + BROKEN or worst in active[multipliers > 0.0]:
            # what is broken by rounding is scaled back to the bound
            tolerances = tolerances / max(float(totals[worst]), 1.0) ** (1.0 / q)
            return tolerances, np.sort(active[multipliers > 0.0])
        kept = multipliers > 0.0
        active, multipliers = np.append(active[kept], worst), np.append(multipliers[kept], 0.0)
    raise ArithmeticError("the widest tolerances were not found")


def _scaled(problem: Problem) -> Array:
    """Start of the search: equal multipliers (n,), at which the mean of the constraints' left sides is 1.

    Multipliers s times as great make t^q less by the factor s^(-q/(q + k)).
    """
    shares = np.full(len(problem.weights), 1.0 / len(problem.weights))
    used = float(shares @ (problem.weights @ problem.cheapest(shares) ** problem.q))
    scaled: Array = shares * used ** ((problem.q + problem.k) / problem.q)
    return scaled


def _multipliers(start: Array, problem: Problem) -> Array:
    """Multipliers m (n,) >= 0 at which the dual bound is greatest, by a projected Newton's method from `start`.

    The bound is cost(t) + m @ (weights @ t^q - 1) at the tolerances t = cheapest(m). Its gradient is the excess weights
    @ t^q - 1, its Hessian the negative of `bend`. Raises ArithmeticError where the search does not end.
    """
    weights, q = problem.weights, problem.q

    def bound(multipliers: Array) -> float:
        t = problem.cheapest(multipliers)
        return problem.cost(t) + float(multipliers @ (weights @ t**q - 1.0))

    now, moving = start, np.ones(len(start), dtype=bool)
    for _ in range(MOST_STEPS):
        t = problem.cheapest(now)
        broken = weights @ t**q - 1.0  # excess of each constraint
        off = np.abs(broken[moving]).max()
        if off < BROKEN:
            return now
        # Newton's step of the multipliers that are not held at 0
        per = q * t**q / ((q + problem.k) * (now @ weights))
        bend = (weights[moving] * per) @ weights[moving].T
        step, longest = np.zeros(len(now)), 1.0
        step[moving] = np.linalg.lstsq(bend, broken[moving], rcond=SINGULAR)[0]
        straight = broken[moving] - bend @ step[moving]
        # more angles than unknowns: along what the step leaves, the bound rises without a bend
        if np.abs(straight).max() > STRAIGHT * off:
            step[moving], longest = straight, math.inf
        # the step ends where the first multiplier comes to 0, and is halved until the bound does not fall
        down = step < 0.0
        ratios = np.where(down, now / np.where(down, -step, 1.0), math.inf)
        size, value = min(longest, float(ratios.min())), bound(now)
        stops = ratios <= size  # the multipliers that come to 0 and stay there
        while off > NEAR and bound(np.maximum(now + size * step, 0.0)) < value:
            size, stops = 0.5 * size, np.zeros_like(moving)
            if size < LEAST_STEP:
                return now  # the greatest bound, within rounding
        now = np.where(stops, 0.0, np.maximum(now + size * step, 0.0))
        moving = moving & ~stops
    raise ArithmeticError("the widest tolerances were not found")
