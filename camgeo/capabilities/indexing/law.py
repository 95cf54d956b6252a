"""The motion of a turret over any number of turns of its cam: that of one turn, each time one pitch further."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from kin.law.piecewise import Piecewise
from kin.law.segment import Constant, moved
from kin.numeric.angles import TURN
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from kin.law.piecewise import Side
    from kin.law.segment import Stretch
    from kin.numeric.arrays import Array


@dataclass(frozen=True, eq=False)
class IndexLaw:
    """S, rad, over the shaft angle, rad, any real number: S(theta + 2 pi) = S(theta) + `advance`.

    `turn` is S over [0, 2 pi], from 0 to `advance`. `turns` are the first and the last whole turn of the stretches that
    `enclosure` knows; `derivatives` knows all angles.
    """

    turn: Piecewise
    advance: float
    turns: tuple[int, int]

    def derivatives(self, theta: float | Array, order: int, at: Side = 1) -> Array:
        """Give S and its derivatives at angles (n,), rad, as (order + 1, n), rad; at a break the limit of one side."""
        theta = np.atleast_1d(np.asarray(theta, dtype=float))
        turns = np.floor(theta / TURN)
        rest = theta - turns * TURN
        snap = 8.0 * np.spacing(np.maximum(np.abs(theta), TURN))
        # at the seam the side says which turn an angle belongs to
        turns = np.where((rest >= TURN - snap) & (np.asarray(at) > 0), turns + 1.0, turns)
        turns = np.where((rest <= snap) & (np.asarray(at) < 0), turns - 1.0, turns)
        rows = self.turn.derivatives(np.clip(theta - turns * TURN, 0.0, TURN), order, at)
        rows[0] += turns * self.advance
        return rows

    def enclosure(self, lower: float | Array, upper: float | Array, order: int) -> tuple[Array, Array]:
        """Balls mid +- rad, (order + 1, n) each, that hold S and its derivatives over [lower, upper], (n,) each.

        Raises ValueError for an interval that leaves the turns of this law.
        """
        return self.unrolled.enclosure(lower, upper, order)

    @cached_property
    def unrolled(self) -> Piecewise:
        """S over all `turns`, without a period; a dwell that runs over the end of a turn is one stretch."""
        first, last = self.turns
        knots: list[float] = [TURN * first]
        functions: list[Stretch] = []
        for turn in range(first, last + 1):
            for function, end in zip(self.turn.functions, self.turn.knots[1:].tolist(), strict=True):
                own = moved(function, offset=turn * self.advance, start=turn * TURN)
                if functions and isinstance(own, Constant) and isinstance(functions[-1], Constant):
                    knots[-1] = turn * TURN + end
                    continue
                functions.append(own)
                knots.append(turn * TURN + end)
        return Piecewise(np.array(knots), tuple(functions))

    @cached_property
    def breaks(self) -> Array:
        """Angles (b,) in [0, 2 pi), rad, rising, at which a derivative may jump; 0 is none within a dwell."""
        inner = self.turn.knots[1:-1]
        ends = self.turn.functions[0], self.turn.functions[-1]
        if all(isinstance(each, Constant) for each in ends):
            return np.asarray(inner)
        return np.append(0.0, inner)

    def breaks_over(self, first: int, last: int) -> Array:
        """Shaft angles (k,) of the breaks, rad, rising, over whole turns from number `first` to number `last`."""
        return np.asarray((self.breaks + TURN * np.arange(first, last + 1)[:, None]).ravel())
