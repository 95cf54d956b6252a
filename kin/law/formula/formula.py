"""A recipe's formula: exact derivatives, proved bounds, and the parameters at which it switches.

abs, sign, min and max make cases, and atan2 jumps where it crosses its cut. `Formula.pieces` takes a formula apart at
those switches into expressions without any, each of them smooth up to and beyond its own ends. They give one-sided
derivatives at a break, which rounding would smear in the formula itself.
"""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np

from kin.law.formula.expression import Expression, FormulaDomainError, FormulaError
from kin.law.formula.parser import parse
from kin.law.formula.switches import branches, innermost
from kin.numeric.records import dataclass, field

if TYPE_CHECKING:
    from kin.law.formula.expression import Series
    from kin.numeric.arrays import Array
    from kin.numeric.elementary import BallJet, Jet

__all__ = ["Expression", "Formula", "FormulaDomainError", "FormulaError"]


# Stretches looked at while a formula is taken apart; some milliseconds each.
_MOST_STRETCHES = 500
_SLIVER = 1e-11  # of the variable: switches closer than this are one switch, found twice


@dataclass(frozen=True)
class Formula:
    """A text in one variable or more, read by the grammar of `kin.law.formula.parser`.

    Raises FormulaError for a text that is no formula. Evaluation raises FormulaDomainError where the formula, or a
    derivative that is needed, does not exist; the enclosure of a ball is unbounded there instead. TypeError unless
    there is one argument for each variable.
    """

    text: str
    variables: tuple[str, ...] = ("t",)
    expression: Expression = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "expression", parse(self.text, self.variables))

    def __call__(self, *arguments: Any) -> Any:  # noqa: ANN401 -- the kind that came in, see `on`
        """Value at numbers or arrays that broadcast, or series of jets or ball jets; one argument for each variable."""
        return self.expression(*arguments)

    def jet(self, t: float | Array, order: int) -> Jet:
        """Taylor coefficients, (order + 1, n), as a jet at t (n,)."""
        return self.expression.jet(t, order)

    def ball(self, lower: float | Array, upper: float | Array, order: int) -> BallJet:
        """Return proved enclosures of the Taylor coefficients up to an order over the intervals [lower, upper] (n,)."""
        return self.expression.ball(lower, upper, order)

    def on(self, *series: Series) -> Series:
        """Series of the formula at jets or ball jets, one for each variable."""
        return self.expression.on(*series)

    def pieces(self, lower: float, upper: float) -> tuple[Array, tuple[Expression, ...]]:
        """Return knots (k + 1,) from lower to upper and k expressions without switches, one between each two knots.

        The inner knots are the parameters at which abs, sign, min or max switch, or atan2 jumps: isolated with balls,
        so that none is missed, and found to the last places. Switches within 1e-11 of each other give one knot, and
        those within 1e-11 of an end none.
        Raises FormulaError where rounding hides whether there is a switch, where there are too many, or where the
        formula has no value; ValueError unless lower is below upper.
        """
        if not lower < upper:
            raise ValueError(f"no interval from {lower} to {upper}")
        waiting, ends, done = [(lower, upper, self.expression)], [lower], []
        count = 0
        while waiting:  # the innermost switches are settled over the whole interval, the outer ones then over each part
            count += 1
            a, b, expression = waiting.pop()
            places = innermost(expression)
            if not places:
                ends.append(b)
                done.append(expression)
                continue
            inside, parts = branches(expression, places, a, b)
            waiting += [(*end, part) for end, part in zip(pairwise((a, *inside, b)), parts, strict=True)][::-1]
            if count + len(waiting) > _MOST_STRETCHES:
                message = f"the formula switches too often to be taken apart: more than {_MOST_STRETCHES} stretches"
                raise FormulaError(message, expression.steps[places[0]].column)
        wide = np.flatnonzero(np.diff(ends) > _SLIVER)
        knots = [lower, *(ends[i] for i in wide[1:]), upper]
        return np.array(knots, dtype=float), tuple(done[i] for i in wide)
