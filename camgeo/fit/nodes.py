"""Nodes of a fit: equal shares of the density of pieces that theory gives, corrected by measured errors."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from camgeo.common.rounding import upward
from camgeo.curve.curve import CurveError
from kin.numeric.errors import CamgeoError
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from camgeo.curve.curve import Curve, Frame
    from kin.numeric.arrays import Array

STEPS_PER_CELL = 8  # of the grid on which a density is integrated
MOST_PIECES = 1_000_000  # a file with more is of no use; a tolerance that needs more is refused
ROUNDING_STEPS = 64.0  # units in the last place of the size: a smaller tolerance is lost in rounding
TRIES = 40  # of placing nodes


class ToleranceError(CamgeoError, ValueError):
    """A tolerance that cannot be held; `reached`, mm, is a tolerance that can, or the best deviation reached."""

    def __init__(self, message: str, reached: float) -> None:
        super().__init__(message)
        self.reached = reached


def rounding(size: float) -> float:
    """Bound, mm, of the rounding of points and distances on a contour that reaches `size` mm from the shaft."""
    return 0.5 * ROUNDING_STEPS * float(np.finfo(np.float64).eps) * size


def check_precision(size: float, tolerance: float, times: float = 1.0) -> None:
    """Refuse a tolerance, mm, that double precision cannot hold on a contour that reaches `size` mm from the shaft.

    A form of more than points and distances needs `times` the least tolerance of these. Raises ToleranceError, with the
    least tolerance that is held, for a smaller one.
    """
    least = times * ROUNDING_STEPS * float(np.finfo(np.float64).eps) * size
    if not tolerance >= least:
        raise ToleranceError(
            f"a tolerance of {tolerance:.3g} mm is below what double precision holds on a contour that reaches "
            f"{size:.6g} mm from the origin: at least {upward(least, 3)} mm",
            least,
        )


def check_count(needed: float, form: str, tolerance: float, order: float, lost: float = 0.0) -> None:
    """Refuse a fit of a form that needs more than `MOST_PIECES` pieces for a tolerance, mm.

    `needed` is their number; the error falls as its power -`order`. `lost`, mm, is the part of the tolerance that
    rounding takes beforehand. Raises ToleranceError with the tolerance that about `MOST_PIECES` pieces hold.
    """
    if needed > MOST_PIECES:
        reached = (tolerance - lost) * (needed / MOST_PIECES) ** order + lost
        raise ToleranceError(
            f"{form} within {tolerance:.3g} mm need about {needed:.3g} pieces, more than {MOST_PIECES}; "
            f"{upward(reached, 3)} mm can be held",
            reached,
        )


@dataclass(frozen=True)
class Density:
    """Running integral `sum` (m,) of a density at the parameters `t` (m,), both rising.

    `turning`, rad, is about the sum of all turning of the tangent.
    """

    t: Array
    sum: Array
    turning: float

    @staticmethod
    def of(curve: Curve, stretches: Array, density: Callable[[Frame], Array]) -> list[Density]:
        """Integrals over stretches (m, 2), none of which spans a break, on a grid that follows the curve's cells.

        `density(frame)` gives the density per unit of the parameter at k places (k,). The list has one integral for
        each stretch, in order. Raises CurveError where the curve runs backwards.
        """
        if not len(stretches):
            return []
        # equal steps of each cell that a stretch covers, cut off at the stretch's ends
        cells = curve.cells
        first = np.searchsorted(cells.low, stretches[:, 0], side="right") - 1
        last = np.searchsorted(cells.high, stretches[:, 1], side="left")
        index = np.concatenate([np.arange(a, b + 1) for a, b in zip(first, last, strict=True)])
        stretch = np.repeat(np.arange(len(stretches)), last - first + 1)
        left = np.maximum(cells.low[index], stretches[stretch, 0])
        right = np.minimum(cells.high[index], stretches[stretch, 1])
        t = left[:, None] + (right - left)[:, None] * np.linspace(0.0, 1.0, STEPS_PER_CELL + 1)
        ends = np.cumsum(last - first + 1) - 1
        inside = t[:, :-1].ravel()
        side = np.repeat([1, -1], [inside.size, ends.size])
        frames = curve.sample(np.concatenate([inside, t[ends, -1]]), side)
        interior = frames.split(inside.size)[0]
        slowest = int(np.argmin(interior.speed))
        if float(interior.speed[slowest]) <= 0.0:
            place = float(inside[slowest])
            raise CurveError(f"the curve runs backwards near parameter {place:.9g}: it undercuts", place)
        # trapezoidal rule; a cell ends in the value at which the next one begins, a stretch in its own limit
        value = np.empty_like(t)
        values = density(frames)
        value[:, :-1] = values[: inside.size].reshape(-1, STEPS_PER_CELL)
        value[:-1, -1] = value[1:, 0]
        value[ends, -1] = values[inside.size :]
        area = 0.5 * (value[:, :-1] + value[:, 1:]) * ((right - left) / STEPS_PER_CELL)[:, None]
        turned = np.abs(interior.turn).reshape(-1, STEPS_PER_CELL).max(axis=1) * (right - left)
        densities, begin = [], 0
        for end in ends:
            grid = np.append(t[begin : end + 1, :-1].ravel(), t[end, -1])
            total = np.concatenate([[0.0], np.cumsum(area[begin : end + 1].ravel())])
            densities.append(Density(grid, total, float(turned[begin : end + 1].sum())))
            begin = end + 1
        return densities

    @staticmethod
    def join(parts: Sequence[Density]) -> Density:
        """Density over consecutive stretches, one at least, from the densities of each."""
        t = np.concatenate([parts[0].t, *(part.t[1:] for part in parts[1:])])
        base = np.cumsum([0.0, *(part.total for part in parts[:-1])])
        total = np.concatenate([parts[0].sum, *(p.sum[1:] + b for p, b in zip(parts[1:], base[1:], strict=True))])
        return Density(t, total, sum(part.turning for part in parts))

    @property
    def total(self) -> float:
        """Integral of the density over all its parameters: the number of pieces at a tolerance of 1 mm."""
        return float(self.sum[-1])

    def parameters_at(self, share: Array) -> Array:
        """Parameters (n,) at which the running integral `sum` reaches the values `share` (n,), 0 to `total`.

        Evenly spaced parameters where the integral is 0 throughout.
        """
        if self.total <= 0.0:
            return np.linspace(self.t[0], self.t[-1], share.size)
        nodes: Array = np.interp(share, self.sum, self.t)
        return nodes

    def share(self, t: float) -> float:
        """Running integral `sum` at a parameter t, interpolated."""
        return float(np.interp(t, self.t, self.sum))

    def nodes(self, count: int) -> Array:
        """Parameters of `count` equal shares, both ends included (count + 1,)."""
        nodes = self.parameters_at(np.linspace(0.0, self.total, count + 1))
        nodes[0], nodes[-1] = self.t[0], self.t[-1]
        return nodes


def reshare(nodes: Array, load: Array, order: float, count: int | None = None) -> Array:
    """Nodes (count + 1,) moved so that pieces with more error become shorter; the ends stay.

    `load` (n,) is the error of each piece between nodes (n + 1,), which grows as the length to the power `order`;
    `count` is by default the number of pieces. Equidistribution after de Boor (Good approximation by splines with
    variable knots II, 1974). Where a load is infinite, or all are 0, pieces keep equal weights.
    """
    top = float(load.max(initial=0.0))
    weight = np.ones_like(load)
    if 0.0 < top < np.inf:
        weight = np.maximum(load / top, 1e-6) ** (1.0 / order)
    total = np.concatenate([[0.0], np.cumsum(weight)])
    moved: Array = np.interp(np.linspace(0.0, total[-1], (count or load.size) + 1), total, nodes)
    moved[0], moved[-1] = nodes[0], nodes[-1]
    return moved
