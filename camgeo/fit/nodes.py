"""Where the nodes of a fit go: equal shares of the density that its theory gives, corrected by what was measured."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from camgeo.curve import CurveError

if TYPE_CHECKING:
    from collections.abc import Callable

    from camgeo.curve import Array, Curve, Frame

STEPS_PER_CELL = 8  # of the grid on which a density is integrated
MOST_PIECES = 1_000_000  # beyond this a contour is no hand-off; a tolerance that needs more is refused
ROUNDING_STEPS = 64.0  # a tolerance below this many units in the last place of the size cannot be told from rounding
TRIES = 40


class ToleranceError(ValueError):
    """A tolerance that cannot be held; `reached` is what can, in mm."""

    def __init__(self, message: str, reached: float) -> None:
        super().__init__(message)
        self.reached = reached


def check_precision(size: float, tolerance: float) -> None:
    """Refuse a tolerance (mm) that double precision cannot hold on a contour that reaches `size` mm from the shaft.

    Raises ToleranceError with the least tolerance that it can.
    """
    least = ROUNDING_STEPS * float(np.finfo(np.float64).eps) * size
    if not tolerance >= least:
        raise ToleranceError(
            f"a tolerance of {tolerance:.3g} mm is below what double precision holds on a contour that reaches "
            f"{size:.6g} mm from the shaft: at least {least:.3g} mm",
            least,
        )


def check_count(needed: float, form: str, tolerance: float) -> None:
    """Refuse a fit that would need more than `MOST_PIECES` pieces; raises ToleranceError."""
    if needed > MOST_PIECES:
        raise ToleranceError(
            f"{form} within {tolerance:.3g} mm need about {needed:.3g} pieces, more than {MOST_PIECES}", tolerance
        )


@dataclass(frozen=True)
class Density:
    """Running integral `sum` (m,) of a density at the parameters `t` (m,)."""

    t: Array
    sum: Array

    @staticmethod
    def of(curve: Curve, low: float, high: float, density: Callable[[Frame], Array]) -> Density:
        """Integrate over a stretch that spans no break, on a grid that follows the curve's cells."""
        cells = curve.cells
        inside = (cells.high > low) & (cells.low < high)
        left = np.maximum(cells.low[inside], low)
        right = np.minimum(cells.high[inside], high)
        share = np.linspace(0.0, 1.0, STEPS_PER_CELL + 1)
        t = left[:, None] + (right - left)[:, None] * share
        interior = curve.sample(t[:, :-1].ravel(), 1)
        value = np.empty_like(t)
        value[:, :-1] = density(interior).reshape(-1, STEPS_PER_CELL)
        value[:-1, -1] = value[1:, 0]
        value[-1:, -1] = density(curve.sample(t[-1:, -1], -1))
        if float(interior.speed.min()) <= 0.0:
            where = float(t[:, :-1].ravel()[int(np.argmin(interior.speed))])
            raise CurveError(f"the curve runs backwards near parameter {where:.9g}: it undercuts", where)
        step = (right - left) / STEPS_PER_CELL
        area = 0.5 * (value[:, :-1] + value[:, 1:]) * step[:, None]
        grid = np.append(t[:, :-1].ravel(), t[-1, -1])
        return Density(grid, np.concatenate([[0.0], np.cumsum(area.ravel())]))

    @staticmethod
    def joined(parts: list[Density]) -> Density:
        """One density over consecutive stretches."""
        t = np.concatenate([parts[0].t, *(part.t[1:] for part in parts[1:])])
        base = np.cumsum([0.0, *(part.total for part in parts[:-1])])
        total = np.concatenate([parts[0].sum, *(p.sum[1:] + b for p, b in zip(parts[1:], base[1:], strict=True))])
        return Density(t, total)

    @property
    def total(self) -> float:
        """The whole integral."""
        return float(self.sum[-1])

    def at(self, share: Array) -> Array:
        """Parameters at which the running integral reaches `share` (n,)."""
        if self.total <= 0.0:
            return np.linspace(self.t[0], self.t[-1], share.size)
        nodes: Array = np.interp(share, self.sum, self.t)
        return nodes

    def nodes(self, count: int) -> Array:
        """Parameters of `count` equal shares, both ends included (count + 1,)."""
        nodes = self.at(np.linspace(0.0, self.total, count + 1))
        nodes[0], nodes[-1] = self.t[0], self.t[-1]
        return nodes


def reshared(nodes: Array, load: Array, order: float) -> Array:
    """Nodes moved so that pieces with more error become shorter: error grows as the length to the power `order`.

    `load` (n,) is the error of each piece between nodes (n + 1,); the same number of nodes is returned.
    """
    top = float(load.max(initial=0.0))
    if not 0.0 < top < np.inf:
        return nodes
    weight = np.maximum(load / top, 1e-6) ** (1.0 / order)
    total = np.concatenate([[0.0], np.cumsum(weight)])
    moved: Array = np.interp(np.linspace(0.0, total[-1], nodes.size), total, nodes)
    moved[0], moved[-1] = nodes[0], nodes[-1]
    return moved
