"""Transmission laws from a formula over the polar angle: any D with its symmetry, any first arc of the pitch curve."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from kin.law.feasibility import JOIN, checked, demand_ratio
from kin.law.formula.expression import FormulaError
from kin.law.normalised import IntentError
from kin.law.piecewise import Piecewise
from kin.law.routes import FromExpression
from kin.law.segment import Constant, Stretch
from kin.law.transmission import over_period
from kin.law.transmission_law import Transmission
from kin.numeric.elementary import Jet

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kin.law.formula.expression import Expression
    from kin.law.formula.formula import Formula


_LOOKS = 257  # places of a stretch at which a formula's values are looked at
_SAME = 1e-9  # of the greatest |D|: a smaller difference of D(t + delta) from -D(t) is rounding
_CLEAR = 1e-6  # of delta: closer to a switch D is not compared
_SEAM_ORDER = 6  # derivatives that agree where one formula runs on over the period


def from_delta_formula(lam: int, mu: int, arm: float, formula: Formula, scale: float = 1.0) -> Transmission:
    """Make the law psi = -asin(D/l^2) of D = `scale` times a formula in the polar angle t, mm^2 (Wunderlich 5.10).

    lam/mu is the ratio pi/alpha, `arm` is l, mm, and delta = pi/lam. D may be any function with D(t + delta) = -D(t),
    |D| < l^2, and psi'(phi) < 1. Raises IntentError with place and figure for an excluded ratio or arm, and where the
    formula has no value, misses the symmetry, or makes no possible law.
    """
    demand_ratio(lam, mu, arm)
    field, delta, square = "delta.formula", math.pi / lam, arm * arm
    places, pieces = _pieces(formula, 2 * delta, field)
    _demand_odd(formula, places, delta, field)
    _demand_within(places, pieces, (scale, square, "|D|", "l^2", "mm^2"), field)
    leaves = [FromExpression(piece, scale / square, 0.0, is_distance=False) for piece in pieces]
    return _polar((lam, mu, arm), leaves, places, field)


def from_curve(lam: int, mu: int, arm: float, formula: Formula, scale: float = 1.0) -> Transmission:
    """Make the law of a pitch curve r = `scale` times a formula in t, mm, over t in [0, delta] (Wunderlich 1984, 4.10).

    lam/mu is the ratio pi/alpha, `arm` is l, mm, and delta = pi/lam. The curve's image from delta on follows from the
    closing equation, as psi(t + delta) = -psi(t). Raises IntentError for an excluded ratio or arm, where the formula
    has no value, where curve and image do not join in place and tangent, for r outside 0 to 2 l, and for a law that
    turns the cam back.
    """
    demand_ratio(lam, mu, arm)
    field, delta = "arc.formula", math.pi / lam
    places, pieces = _pieces(formula, delta, field)
    _demand_within(places, pieces, (scale, 2 * arm, "r", "2 l", "mm"), field)
    alpha = math.pi * mu / lam
    leaves = [FromExpression(piece, scale / (2 * arm), alpha, is_distance=True) for piece in pieces]
    first, last = (float(f(Jet.variable(at, 0)).c[0, 0]) for f, at in ((leaves[0], 0.0), (leaves[-1], delta)))
    if abs(first + last) > JOIN:
        mean = 2 * arm * math.cos(alpha / 2) / scale
        raise IntentError(
            f"psi must end at {-math.degrees(first):.9g} degrees, where the arc's image begins, as it is "
            f"{math.degrees(first):.9g} at t = 0; it ends at {math.degrees(last):.9g}; an arc from r = {mean:.9g} to "
            "the same does",
            field,
        )
    return _polar((lam, mu, arm), leaves, places, field)


def _pieces(formula: Formula, end: float, field: str) -> tuple[list[float], tuple[Expression, ...]]:
    """Knots and pieces without switches over t in [0, end]; raises IntentError where the formula has no value."""
    try:
        places, pieces = formula.pieces(0.0, end)
    except FormulaError as error:
        raise IntentError(error.message, field) from error
    return places.tolist(), pieces


def _demand_odd(formula: Formula, places: Sequence[float], delta: float, field: str) -> None:
    """Raise IntentError unless D(t + delta) = -D(t), on a grid that no symmetry repeats, clear of the switches."""
    t = np.mod(np.arange(1, 98) * (math.sqrt(5) - 1) * math.pi, delta)
    knots = np.array(places)
    for shift in (0.0, delta):
        t = t[np.abs(t[:, None] + shift - knots).min(axis=1) > _CLEAR * delta]
    try:
        before, after = np.hsplit(formula.jet(np.concatenate([t, t + delta]), 0).c[0], 2)
    except FormulaError as error:
        raise IntentError(error.message, field) from error
    off = np.abs(before + after)
    worst = int(np.argmax(off))
    if off[worst] > _SAME * np.abs(before).max():
        raise IntentError(
            f"D(t + delta) must be -D(t), delta = {math.degrees(delta):.6g} degrees: D is {before[worst]:.9g} at t = "
            f"{math.degrees(t[worst]):.6g} degrees and {after[worst]:.9g} at {math.degrees(t[worst] + delta):.6g}; "
            f"sines and cosines of {math.pi / delta:.0f}*t and of its odd multiples have it",
            field,
            math.degrees(t[worst]),
        )


def _demand_within(
    places: Sequence[float], pieces: Sequence[Expression], limit: tuple[float, float, str, str, str], field: str
) -> None:
    """Raise IntentError for sampled values at or above a limit; between the samples the limit is proved with the law.

    `limit` holds the scale of the formula, the limit, the names of both, and their unit.
    """
    scale, most, what, name, unit = limit
    for begin, end, piece in zip(places[:-1], places[1:], pieces, strict=True):
        t = np.linspace(begin, end, _LOOKS)
        try:
            value = scale * piece.jet(t, 1).c[0]
        except FormulaError as error:
            raise IntentError(error.message, field) from error
        worst = int(np.argmax(np.abs(value)))
        if abs(value[worst]) >= most:
            raise IntentError(
                f"{what} must stay below {name} = {most:.9g} {unit}; it is {abs(value[worst]):.9g} at t = "
                f"{math.degrees(t[worst]):.6g} degrees",
                field,
                math.degrees(t[worst]),
            )


def _polar(
    ratio: tuple[int, int, float], stretches: Sequence[FromExpression], places: Sequence[float], field: str
) -> Transmission:
    """Make the law of a ratio and an arm, (lam, mu, l), from stretches in t between `places`, 0 to delta or 2 delta."""
    lam, mu, arm = ratio
    alpha, delta = math.pi * mu / lam, math.pi / lam
    whole = places[-1] > 1.5 * delta
    if whole and len(stretches) == 1 and _runs_on(stretches[0], 2 * delta):
        one_stretch = [_at_rest(stretches[0], 0.0)]
        whole_psi = Piecewise(np.array(places), tuple(one_stretch), 2 * delta, smooth_seam=True)
        return checked(Transmission(lam, mu, arm, whole_psi, (0.5,), alpha / 2), [0.0, delta], one_stretch, field)
    count = sum(place < delta * (1 - _CLEAR) for place in places)
    knots = [*places[:count], delta]
    functions: list[Stretch] = [_at_rest(f, low) for f, low in zip(stretches[:count], knots, strict=False)]
    psi, lean = over_period(delta, knots, functions, (0.5, 0.5))
    return checked(Transmission(lam, mu, arm, psi, lean, alpha / 2), knots, functions, field)


def _runs_on(function: FromExpression, period: float) -> bool:
    jets = [function(Jet.variable(at, _SEAM_ORDER)).derivatives() for at in (0.0, period)]
    return bool((np.abs(jets[1] - jets[0]) <= _SAME * (1 + np.abs(jets[0]).max())).all())


def _at_rest(function: FromExpression, angle: float) -> Stretch:
    """Return the stretch, or a constant if the formula does not depend on t from `angle` on; psi near 0 becomes 0."""
    if function.formula.constant_value(angle) is None:
        return function
    psi = float(function(Jet.variable(angle, 0)).c[0, 0])
    return Constant(0.0 if abs(psi) <= JOIN else psi)
