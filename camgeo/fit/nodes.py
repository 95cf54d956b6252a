"""Where the nodes of a fit go: equal shares of the density that its theory gives, corrected by what was measured."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Callable

    from camgeo.curve import Array, Curve, Frame

STEPS_PER_CELL = 8  # of the grid on which a density is integrated
MOST_PIECES = 4_000_000  # beyond this a contour is no hand-off; a tolerance that needs more is refused
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


class Density:
    """Running integral of a density over parameter intervals that span no break, on a grid that follows the cells."""

    def __init__(self, curve: Curve, low: float, high: float, density: Callable[[Frame], Array]) -> None:
        cells = curve.cells
        inside = (cells.high > low) & (cells.low < high)
        left = np.maximum(cells.low[inside], low)
        right = np.minimum(cells.high[inside], high)
        share = np.linspace(0.0, 1.0, STEPS_PER_CELL + 1)
        t = left[:, None] + (right - left)[:, None] * share
        interior = curve.sample(t[:, :-1].ravel(), 1)
        value = np.empty_like(t)
        value[:, :-1] = density(interior).reshape(-1, STEPS_PER_CELL)
        value[:, -1] = density(curve.sample(t[:, -1], -1))
        step = (right - left) / STEPS_PER_CELL
        area = 0.5 * (value[:, :-1] + value[:, 1:]) * step[:, None]
        self._t = np.append(t[:, :-1].ravel(), t[-1, -1])
        self._sum = np.concatenate([[0.0], np.cumsum(area.ravel())])
        self.total = float(self._sum[-1])

    def grid(self) -> tuple[Array, Array]:
        """The grid's parameters and the running integral there."""
        return self._t, self._sum

    def nodes(self, count: int) -> Array:
        """Parameters of `count` equal shares, both ends included (count + 1,)."""
        if self.total <= 0.0:
            return np.linspace(self._t[0], self._t[-1], count + 1)
        t: Array = np.interp(np.linspace(0.0, self.total, count + 1), self._sum, self._t)
        t[0], t[-1] = self._t[0], self._t[-1]
        return t


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
