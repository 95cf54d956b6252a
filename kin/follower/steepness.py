"""How steep an intended motion is at most: proved bounds of its first three derivatives over ranges of shaft angle."""

from __future__ import annotations

from functools import cached_property, lru_cache
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from kin.numeric.jet import BallJet, derivatives_by
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from kin.law.piecewise import Piecewise
    from kin.law.transmission import Transmission
    from kin.numeric.arrays import Array, Indices

CELLS = 256  # in a turn, besides those that breaks add
TABLED = 2048  # cells in a turn, of the table of parameters
ROUNDING = 1e-12  # rad; a break this near counts as inside
SMOOTH = 1e-9  # of the derivative's greatest, below which a jump of it is rounding


@dataclass(frozen=True, eq=False)
class Steepness:
    """Bounds of |f'|, |f''|, |f'''| of a periodic function, over cells of the shaft angle.

    edges (m + 1,)  ends of the cells, rising over one period, radians
    most (3, m)     the bounds in each cell, for limits from within it
    breaks (m,)     lowest derivative, 1 or 2, that jumps at the lower edge of each cell; 3 where neither does
    """

    edges: Array
    most: Array
    breaks: Array

    @property
    def _period(self) -> float:
        return float(self.edges[-1] - self.edges[0])

    @cached_property
    def _tiled(self) -> Array:
        """Edges over three periods, the first of them before the cells' own."""
        return np.concatenate([self.edges[:-1] + turn * self._period for turn in (-1, 0, 1)])

    @cached_property
    def _table(self) -> Array:
        """Bounds over 2^k cells from each cell on, over three periods: (k, 3, 3 m)."""
        levels = [np.tile(self.most, 3)]
        while 2 ** len(levels) <= self.most.shape[1]:
            last, step = levels[-1], 2 ** (len(levels) - 1)
            levels.append(np.maximum(last, np.roll(last, -step, axis=1)))
        return np.stack(levels)

    def over(self, low: Array, high: Array) -> Array:
        """Bounds of the magnitudes of the three derivatives over [low, high], rad, each (n,): (3, n).

        Above a derivative that jumps inside the range the bounds are infinite.
        """
        count = self.most.shape[1]
        width = np.where(np.isfinite(high - low), high - low, np.inf)
        wide = ~(width < self._period)
        begin = np.where(wide, 0.0, np.mod(np.where(wide, 0.0, low) - self.edges[0], self._period)) + self.edges[0]
        end = begin + np.where(wide, 0.0, width) + ROUNDING
        first = np.searchsorted(self._tiled, begin - ROUNDING, side="right") - 1
        last = np.searchsorted(self._tiled, end, side="right") - 1
        cells = np.where(wide, count, np.minimum(last - first + 1, count))
        level = np.log2(cells).astype(np.intp)
        steepest: Array = np.maximum(self._table[level, :, first], self._table[level, :, first + cells - 2**level]).T
        for order in (1, 2):
            at = np.append(0, np.cumsum(np.tile(self.breaks == order, 3)))
            steepest[order:, wide & bool(at[-1]) | (at[last + 1] > at[first + 1])] = np.inf
        return steepest


def steepness_of_law(law: Piecewise) -> Steepness:
    """Bounds of the first three derivatives of a law over the shaft angle."""
    edges, at_knot = _cells(law.knots)
    mid, rad = law.enclosure(edges[:-1], edges[1:], 3)
    at = edges[:-1][at_knot]
    jumps = np.abs(law.derivatives(at, 2) - law.derivatives(at, 2, -1))
    return _steepness(edges, (np.abs(mid) + rad)[1:], jumps, at_knot)


@lru_cache(maxsize=8)  # the files of one cam are judged one after another
def steepness_of_transmission(transmission: Transmission) -> Steepness:
    """Bounds of the first three derivatives of psi by the shaft angle, which rises with the law's parameter."""
    edges, at_knot = _cells(transmission.psi.knots)
    shaft, psi = transmission.jets(BallJet.variable(edges[:-1], edges[1:], 3))
    most = [row.rows[0].magnitude for row in derivatives_by(psi, shaft)[1:]]
    phi = transmission.at(edges, 0)[0][0]
    phi[-1] = phi[0] + 2.0 * transmission.delta
    at = phi[:-1][at_knot]
    jumps = np.abs(transmission.psi_of_shaft(at, 2) - transmission.psi_of_shaft(at, 2, -1))
    return _steepness(phi, np.stack(most), jumps, at_knot)


@dataclass(frozen=True, eq=False)
class ParameterTable:
    """A transmission's parameter over the shaft angle, by cubics between ends of cells: a first guess alone.

    phi, tau (m + 1,)       shaft angle and parameter at the ends of cells, rising over one period
    after, before (m,)      derivative of tau by phi at the lower and at the upper end of each cell, from within
    """

    phi: Array
    tau: Array
    after: Array
    before: Array

    @staticmethod
    @lru_cache(maxsize=8)
    def of(transmission: Transmission) -> ParameterTable:
        """Table of a transmission over one period of its law."""
        tau, _ = _cells(transmission.psi.knots, TABLED)
        phi = transmission.at(tau, 0)[0][0]
        phi[-1] = phi[0] + 2.0 * transmission.delta
        after, before = transmission.at(tau[:-1], 1)[0][1], transmission.at(tau[1:], 1, -1)[0][1]
        return ParameterTable(phi, tau, 1.0 / after, 1.0 / before)

    def at(self, phi: Array) -> tuple[Array, Indices]:
        """Parameters (n,) near those of shaft angles phi (n,), rad, in the same stretch of the law; and sides (n,).

        The side, 1 or -1, is the one from which a parameter at a break is seen.
        """
        x = np.mod(phi - self.phi[0], self.phi[-1] - self.phi[0]) + self.phi[0]
        cell = np.clip(np.searchsorted(self.phi, x, side="right") - 1, 0, len(self.after) - 1)
        low, high, width = self.tau[cell], self.tau[cell + 1], self.phi[cell + 1] - self.phi[cell]
        u = (x - self.phi[cell]) / width
        begin, end = u * (1.0 - u) ** 2 * self.after[cell], u * u * (1.0 - u) * self.before[cell]
        tau = low + (high - low) * u * u * (3.0 - 2.0 * u) + width * (begin - end)
        tau = np.clip(tau, low, high) + (phi - x)
        return tau, np.where(u < 0.5, 1, -1)


def _cells(knots: Array, count: int = CELLS) -> tuple[Array, NDArray[np.bool_]]:
    """Edges of cells between knots, and whether each but the last is a knot."""
    step = 2.0 * np.pi / count
    parts = [np.linspace(a, b, int(np.ceil((b - a) / step)) + 1)[:-1] for a, b in pairwise(knots.tolist())]
    at_knot = np.concatenate([np.arange(len(part)) == 0 for part in parts])
    return np.append(np.concatenate(parts), knots[-1]), at_knot


def _steepness(edges: Array, most: Array, jumps: Array, at_knot: NDArray[np.bool_]) -> Steepness:
    """Steepness by bounds (3, m) over cells, and by the jumps (3, k) of position and two derivatives at the k knots."""
    most = np.where(np.isfinite(most), most, np.inf)
    size = np.append(1.0, np.where(np.isfinite(most[:2]), most[:2], 0.0).max(axis=1))[:, None]
    real = jumps > SMOOTH * (size + 1.0)
    breaks = np.full(most.shape[1], 3)
    breaks[at_knot] = np.where(real[:2].any(axis=0), 1, np.where(real[2], 2, 3))
    return Steepness(edges, most, breaks)
