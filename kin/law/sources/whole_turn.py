"""Motions by a formula: over a whole turn, or the pieces of one for a segment."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from kin.law.bounds import unbounded
from kin.law.formula.expression import Expression, FormulaDomainError, FormulaError
from kin.law.normalised import IntentError
from kin.law.segment import Constant, Stretch, moved
from kin.law.sources.motion import Motion, joined
from kin.numeric.lengths import input_words

if TYPE_CHECKING:
    from kin.law.formula.formula import Formula


_LOOKS = 65  # places of a piece at which the formula must have a value


def from_formula(
    formula: Formula, total: float = 2 * math.pi, *, scale: float = 1.0, around: int | None = 1, field: str = "formula"
) -> Motion:
    """Make S = scale times a formula in t, rad, over [0, total]; `around` is 1 if the motion repeats (`Motion`).

    Raises IntentError, at `field` and with the angle, where the formula has no value or S, S', S'' no bound. Jumps over
    the end are no errors here: `Motion.joints` has them.
    """
    knots, functions = pieces_of(formula, 0.0, total, field, formula.variables[0])
    return joined(knots, [moved(f, scale=scale) for f in functions] if scale != 1 else functions, around)


def pieces_of(
    formula: Formula, begin: float, end: float, field: str, variable: str
) -> tuple[list[float], list[Stretch]]:
    """Knots from `begin` to `end`, and stretches of a formula between them, without switches.

    Raises IntentError, at `field`, where the formula or one of its first two derivatives does not exist or has no
    bound; `variable` is for messages, an angle in rad if it is t.
    """

    def place(x: float) -> str:
        return input_words(x) if variable == "t" else f"{variable} = {x:.6g}"

    try:
        places, parts = formula.pieces(begin, end)
        knots = places.tolist()
        for part, low, high in zip(parts, knots[:-1], knots[1:], strict=True):
            part.jet(np.linspace(low, high, _LOOKS), 2)  # raises where there is no value
            at = unbounded(part, low, high, 2)
            if at is not None:
                raise IntentError(
                    f"the displacement or its first two derivatives cannot be bounded near {place(at)}", field
                )
    except FormulaDomainError as error:
        what = "the displacement or a derivative of it" if "derivative" in error.operation else "the displacement"
        raise IntentError(f"{what} does not exist at {place(error.at)}: {error.operation}", field) from error
    except FormulaError as error:
        raise IntentError(error.message, field) from error
    return knots, [_plain(part, low) for part, low in zip(parts, knots[:-1], strict=True)]


def _plain(part: Expression, angle: float) -> Stretch:
    """The expression, or a constant if it does not depend on its variable from `angle` on."""
    value = part.constant_value(angle)
    return part if value is None else Constant(value)
