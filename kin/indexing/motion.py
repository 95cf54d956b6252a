"""The turret's angle over the cam's: a table on equal angles, and proved bounds of its derivatives."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from kin.law.bounds import cubic_cells, cubics_between
from kin.numeric.angles import TURN
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from kin.law.piecewise import Piecewise
    from kin.numeric.arrays import Array

NEAR = 1e-12  # rad: cubics are proved to be so near the law
STEPS = 512  # of a turn, over each of which the greatest derivatives are known


@dataclass(frozen=True, eq=False)
class Turning:
    """A turret whose rollers begin at `start`, rad, and advance by a law over one turn of the cam.

    Angles are those of one roller; after a turn of the cam it stands where another one was. Raises UnsettledError, when
    asked, for a law that is too rough.
    """

    law: Piecewise
    start: float

    @cached_property
    def _cells(self) -> tuple[Array, Array]:
        """Angles (m + 1,) over a turn from 0, and coefficients (4, m) of the cubics between them."""
        nodes = cubic_cells(self.law, self.law.breaks, NEAR)
        return nodes, cubics_between(self.law, nodes)

    def at(self, theta: Array) -> tuple[Array, Array]:
        """Angle of a roller, rad, and its slope (n,) each at angles of the cam (n,), rad, folded to one turn."""
        advance, slope, _ = self.moved(theta)
        return self.start + advance, slope

    def moved(self, theta: Array) -> tuple[Array, Array, Array]:
        """Advance, rad, with its slope and bend (n,) each at angles of the cam (n,), rad, folded to one turn."""
        nodes, cubics = self._cells
        folded = theta - TURN * np.floor(theta / TURN)
        cell = np.minimum(np.searchsorted(nodes, folded, side="right") - 1, len(nodes) - 2)
        x = folded - nodes[cell]
        a, b, c, d = (row[cell] for row in cubics)
        return a + x * (b + x * (c + x * d)), b + x * (2.0 * c + 3.0 * x * d), 2.0 * c + 6.0 * x * d

    @cached_property
    def fastest(self) -> tuple[Array, Array]:
        """Upper bounds of the magnitude of slope and bend (STEPS,) over each step of a turn, per rad and rad^2."""
        edges = np.linspace(0.0, TURN, STEPS + 1)
        mid, rad = self.law.enclosure(edges[:-1], edges[1:], 2)
        most = np.abs(mid) + rad
        return most[1], most[2]
