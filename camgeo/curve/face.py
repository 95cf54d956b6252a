"""Profiles under a flat face, from the face's distance from the shaft and the direction of its normal."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol, TypeVar

import numpy as np

from camgeo.curve.curve import Frame, columns
from camgeo.curve.rates import MotionShape, Source, cut
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from camgeo.curve.curve import Side
    from camgeo.curve.rates import Series
    from kin.numeric.arrays import Array


class Facing(Source, Protocol):
    """A face as it moves round the standing cam: its distance r from the shaft and its normal's direction."""

    def polar(self, tau: Series, side: Side = 1, /) -> tuple[Series, Series]:
        """Distance r, mm, and direction of the normal, rad, at jets or ball jets of the parameter."""
        ...

    def pitch(self, tau: Array, order: int, side: Side = 1, /) -> tuple[Array, Array]:
        """Distance r, mm, and direction of the normal, rad, with derivatives, (order + 1, n), at parameters (n,)."""
        ...


FacingT = TypeVar("FacingT", bound=Facing)


@dataclass(frozen=True)
class FaceShape(MotionShape[FacingT]):
    """Envelope of a face: its distance r is the support function of the curve, over the parameter of the law.

    With t the direction of the normal, E(t) = exp(i t), the point is ``E(t)(r + i r'/t')``, ``omega = t'`` and
    ``sigma = (r + d2r/dt2) t'``.
    """

    def sample(self, t: Array, side: Side = 1) -> Frame:
        """Frame at parameters t (n,) of the law; at a break the limit from above (side 1) or from below (side -1)."""
        r, normal = self.law.pitch(t, 3, side)
        turn, turn1, turn2 = normal[1:]
        # sigma = r t' + (r'/t')', with its first derivative
        slope = r[1] / turn
        slope1 = (r[2] - slope * turn1) / turn
        slope2 = (r[3] - slope * turn2 - 2.0 * slope1 * turn1) / turn
        cosine, sine = np.cos(normal[0]), np.sin(normal[0])
        point = columns(r[0] * cosine - slope * sine, r[0] * sine + slope * cosine)
        return Frame(
            point, columns(-sine, cosine), r[0] * turn + slope1, turn, r[1] * turn + r[0] * turn1 + slope2, turn1
        )

    def figures(self, tau: Series, side: Side = 1) -> tuple[Series, ...]:
        """Support function, mm, and direction of the normal, rad, at jets of the parameter."""
        return self.law.polar(tau, side)

    def rates_of(self, figures: tuple[Series, ...]) -> tuple[Series, Series]:
        """Speed ``r t' + (r'/t')'`` and turn t' from the support function r and the normal's direction t."""
        r, normal = figures
        turn = normal.derivative()
        bend = (r.derivative() / turn).derivative()
        turn = cut(turn, bend.order)
        return cut(r, bend.order) * turn + bend, turn
