"""Position of a contact of a follower on a contour over the shaft angle, as it drives a follower train.

Every drive is in SI, metres or radians: a contact's own position, which grows away from the cam. The drive of each
touch stands in the module of its follower.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

import numpy as np

from kin.numeric.angles import TURN
from kin.numeric.distinct import distinct
from kin.numeric.extrema import extremes
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from kin.numeric.arrays import Array, Indices
    from kin.numeric.extrema import Extremes

INSET = 1e-6  # of a stretch between two breaks: rows at its ends are carried there from so far within
ENDS = ((0.0, INSET), (1.0, 1.0 - INSET))  # shares of a stretch: each end, and the place it is carried from
LEAST = 12  # stretches of a turn at least
RESOLUTION = 1e-11  # of the size of the positions, to which their extremes are found
CLOSE = 1e-9  # rad: breaks that are closer are one


class Excitation(Protocol):
    """Position over the shaft angle, of period one turn, smooth between `breaks`; such as a contact's own position."""

    @property
    def breaks(self) -> Array:
        """Shaft angles (k,), rad, in [0, 2 pi), in any order, at which velocity or acceleration may jump."""

    @property
    def smooth(self) -> bool:
        """Whether the velocity is continuous at all breaks."""

    def rows(self, phi: Array) -> Array:
        """Position, m or rad, and two derivatives by the shaft angle, (3, n), at phi (n,), rad, not at breaks."""


@dataclass(frozen=True, eq=False)
class Shifted:
    """Excitation sign * drive + offset, the offset in m or rad."""

    drive: Excitation
    sign: float = 1.0
    offset: float = 0.0

    @property
    def breaks(self) -> Array:
        """Shaft angles (k,), rad, of the breaks of `drive`, which a shift of its position leaves where they are."""
        return self.drive.breaks

    @property
    def smooth(self) -> bool:
        """Whether the drive that is shifted is smooth."""
        return self.drive.smooth

    def rows(self, phi: Array) -> Array:
        """Shifted position and two derivatives by the shaft angle, (3, n), at angles phi (n,), rad, not at breaks."""
        rows = self.sign * self.drive.rows(phi)
        rows[0] += self.offset
        return rows


def extremes_between(first: Excitation, second: Excitation, size: float) -> Extremes:
    """Least and greatest of second - first over a turn, m or rad, with their shaft angles, rad.

    `size`, m or rad, is the size of the positions, of which rounding is a share. Raises UnsettledError where rounding
    hides an extreme, ContactError where a contact finds nothing to rest on.
    """
    ends = np.concatenate([first.breaks, second.breaks, np.arange(LEAST) * TURN / LEAST])
    ends = distinct(np.mod(ends, TURN))
    ends = ends[np.diff(ends, prepend=-np.inf) > CLOSE]
    width = np.diff(ends, append=ends[0] + TURN)

    def difference(phi: Array, _: Indices | None = None) -> Array:
        rows: Array = second.rows(phi) - first.rows(phi)
        return rows

    at_low, at_high = (_carried(difference(ends + share * width), (at - share) * width) for at, share in ENDS)
    return extremes(ends, ends + width, at_low, at_high, difference, resolution=RESOLUTION * size)


def _carried(rows: Array, step: Array) -> Array:
    """Value and two derivatives (3, n) a step (n,), rad, further on, to second order."""
    f, slope, bend = rows
    return np.stack([f + step * (slope + 0.5 * step * bend), slope + step * bend, bend])
