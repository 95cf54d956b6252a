"""A lift from a recipe's own formula: where p, p' and p'' exist, that they close over a turn, and where they break."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from kin.law.bounds import unbounded
from kin.law.formula.expression import Expression, FormulaDomainError, FormulaError
from kin.law.normalised import IntentError
from kin.law.support_function import Circle, Lift, about, joined

if TYPE_CHECKING:
    from kin.law.formula.formula import Formula
    from kin.law.segment import Stretch
    from kin.numeric.arrays import Array


_TURN = 2 * math.pi
# Greatest difference of p(t + 2 pi) from p(t), relative to the largest of p, p', p'': t is rounded to an ulp of 4 pi.
_PERIOD = 1e-9
_SEAM_ORDER = 6  # derivatives that must agree at 0 and 2 pi, else 0 is a break
_CLEAR = 1e-6  # rad: closer to a switch p is not compared with p a turn later
_MOST_WAVES = 5000  # of p in a turn: proofs and drawings are divided for each of them
_ABOUT = 1.01  # factor by which the estimate of the waves may be off
_PLACES = 2048  # places of a turn at which waves are looked for
_CALM = 1e-6  # of the largest p: flatter slopes of the radius of curvature are no waves, they may be rounding
_WHOLE = "a whole exponent is smooth where what it is put on vanishes"
_HINTS = (
    ("fractional power", _WHOLE),
    ("derivative", _WHOLE),
    ("division", "where both sides of a fraction vanish, write it out (sin(2*t)/sin(t) is 2*cos(t))"),
)


def lift_from_formula(formula: Formula, pivot: tuple[float, float] = (0.0, 0.0), scale: float = 1.0) -> Lift:
    """Make p, mm, scale times a formula in t, rad, about the shaft at `pivot`, mm (Aygahoglu and Saka 2023, eq. 7).

    Raises IntentError, each with angle and figure, where the formula has no value or p, p', p'' no bound; where it does
    not close, p(t + 2 pi) = p(t); where it has too many waves to be worked out; and where abs, min, max or another
    switch makes p or p' jump. Jumps of p'' become breaks.
    """
    _demand_calm(formula)
    try:
        places, pieces = formula.pieces(0.0, _TURN)
        _demand_period(formula, places, scale)
        knots = places.tolist()
        for piece, begin, end in zip(pieces, knots[:-1], knots[1:], strict=True):
            _demand_finite(piece, begin, end)
    except FormulaDomainError as error:
        at = math.degrees(error.at) % 360
        what = "p or a derivative of it" if error.operation.startswith("derivative") else "p"
        hint = next((f"; {hint}" for word, hint in _HINTS if word in error.operation), "")
        raise IntentError(f"{what} does not exist at {at:.6g} degrees: {error.operation}{hint}", "p", at) from error
    except FormulaError as error:
        raise IntentError(error.message, "p") from error
    functions = [about(_plain(piece, begin), pivot, scale) for piece, begin in zip(pieces, knots[:-1], strict=True)]
    # where an arc meets a formula the seam is a break, however smoothly they join
    one_kind = isinstance(functions[0], Circle) == isinstance(functions[-1], Circle)
    return joined(knots, functions, "p", smooth_seam=one_kind and _runs_on(pieces[-1], pieces[0]))


def _runs_on(last: Expression, first: Expression) -> bool:
    """Whether the turn's end runs on smoothly in its beginning, by the derivatives there.

    Equal expressions are no sign of it: abs(cos(t/2)) has different ones at 0 and 2 pi and no break at 0, abs(sin(t/2))
    has the same one and a break.
    """
    try:
        end, begin = last.jet(_TURN, _SEAM_ORDER).derivatives(), first.jet(0.0, _SEAM_ORDER).derivatives()
    except FormulaDomainError:  # a high derivative does not exist there: a break
        return False
    return bool((np.abs(end - begin) <= _PERIOD * (1 + np.abs(begin).max())).all())


def _demand_calm(formula: Formula) -> None:
    """Raise IntentError for p with more waves in a turn than are worked out, before any work is done on them."""
    try:
        waves = _waves(formula)
    except FormulaDomainError:  # the next checks name the place and the reason
        return
    if waves > _MOST_WAVES * _ABOUT:
        raise IntentError(f"p has about {waves:.3g} waves in a turn; no more than {_MOST_WAVES} are worked out", "p")


def _waves(formula: Formula) -> float:
    """Estimate how often the radius of curvature goes up and down in a turn.

    A wave of its slope g is a turn of the point (g, g'/s) about 0 (Pruefer's angle), whatever the rate s: the mean rate
    of turning is counted, at places that no symmetry repeats. Derivatives are exact, so that waves between two places
    are counted as well.
    """
    t = np.mod(np.arange(1, _PLACES + 1) * (math.sqrt(5) - 1) * math.pi, _TURN)
    with np.errstate(all="ignore"):  # numbers that are not finite are refused by the next checks
        p = formula.jet(t, 5).derivatives()
        g, slope, bend = p[1:4] + p[3:6]
        rate = math.sqrt(float(np.mean(slope**2))) / (math.sqrt(float(np.mean(g**2))) or 1.0) or 1.0
        across = slope / rate
        turned = np.abs(g * bend / rate - rate * across**2)
        mean = float(np.mean(turned / (g**2 + across**2 + (_CALM * np.abs(p[0]).max()) ** 2)))
    return mean if math.isfinite(mean) else 0.0


def _demand_period(formula: Formula, switches: Array, scale: float) -> None:
    """Raise IntentError unless p(t + 2 pi) = p(t), on a grid that no symmetry repeats, clear of the switches."""
    t = np.mod(np.arange(1, 98) * (math.sqrt(5) - 1) * math.pi, _TURN)
    t = t[np.abs(t[:, None] - switches).min(axis=1) > _CLEAR]
    before, after = np.hsplit(formula.jet(np.concatenate([t, t + _TURN]), 2).derivatives(), 2)
    miss = after - before
    for row, what, unit in ((0, "p", "mm"), (1, "p'", "mm/rad"), (2, "p''", "mm/rad^2")):
        worst = int(np.argmax(np.abs(miss[row])))
        if abs(miss[row, worst]) > _PERIOD * np.abs(before).max():
            at = math.degrees(t[worst])
            miss_mm = scale * miss[row, worst]
            raise IntentError(
                f"p does not close: {what} is off by {miss_mm:.9g} {unit} a full turn after {at:.6g} degrees", "p", at
            )


def _demand_finite(piece: Expression, begin: float, end: float) -> None:
    """Raise IntentError unless p, p' and p'' are proved finite over a stretch."""
    piece.jet(np.linspace(begin, end, 65), 2)  # raises where there is no value
    at = unbounded(piece, begin, end, 2)
    if at is not None:
        degrees = math.degrees(at) % 360
        raise IntentError(
            f"p, p' or p'' cannot be bounded near {degrees:.6g} degrees; {_WHOLE}, and a fraction of which both sides "
            "vanish has to be written out",
            "p",
            degrees,
        )


def _plain(piece: Expression, begin: float) -> Stretch:
    """Return the expression, or the circle that it is if it does not depend on t from `begin` on."""
    radius = piece.constant_value(begin)
    return piece if radius is None else Circle(radius)
