"""Rows of a cam table joined as a drive's controller joins them: by lines, or by polynomials of degree 5.

Between two rows the difference from a motion is followed by polynomials that leave nothing between samples
(`kin.numeric.monotone`), so that no greater value is missed.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

import numpy as np

from kin.numeric.angles import TURN
from kin.numeric.monotone import between, cells, extremes
from kin.numeric.quintics import coefficients, polynomial
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from kin.numeric.arrays import Array

Join = Literal["line", "quintic"]
_SHARE = 1e-12  # accuracy of the difference, as a part of the range of positions


@dataclass(frozen=True, eq=False)
class JoinedRows:
    """Rows of a master's angle (n,), rad, from 0 to a turn, and of a slave (1 or 3, n): row 0 its position, mm or rad.

    Lines meet the position alone. Quintics also meet the first and second derivatives by the master's angle, rows 1 and
    2 of the slave.
    """

    master: Array
    slave: Array
    join: Join

    @property
    def coefficients(self) -> Array:
        """Coefficients (2 or 6, n - 1) of the polynomial of each part over 0 to 1, the constant first."""
        if self.join == "line":
            return np.stack([self.slave[0, :-1], np.diff(self.slave[0])])
        return coefficients(self.slave[:, :-1], self.slave[:, 1:], np.diff(self.master))

    def position(self, angle: Array) -> Array:
        """The slave's position (n,), mm or rad, at angles of the master (n,), rad."""
        part = np.clip(np.searchsorted(self.master, angle, side="right") - 1, 0, len(self.master) - 2)
        width = np.diff(self.master)[part]
        position: Array = polynomial(self.coefficients[:, part], width, angle - self.master[part], 0)[0]
        return position

    def off(self, position: Callable[[Array], Array], breaks: Iterable[float]) -> tuple[float, float]:
        """Greatest |motion - joined rows| over a turn, mm or rad, and the master's angle where it is, rad.

        `position` gives the motion (n,) at angles (n,) from 0 to a turn; at `breaks`, rad, a derivative of it may jump.
        Raises RoughError where the motion changes too abruptly to be followed.
        """
        size = float(np.ptp(self.slave[0])) or 1.0
        places = between(0.0, TURN, [*self.master.tolist(), *breaks])

        def difference(angle: Array) -> Array:
            return (position(angle) - self.position(angle))[None]

        (least, low), (greatest, high) = extremes(cells(difference, places, _SHARE * size))
        return max((abs(least), low), (abs(greatest), high))
