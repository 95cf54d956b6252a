"""What a contact of a follower feels of a contour over the shaft angle: what drives a follower train.

Every drive is in SI, metres or radians: a contact's own position, which grows away from the cam. Each touch has its
own, beside its follower.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    from kin.numeric.arrays import Array


class Drive(Protocol):
    """A contact's own position over the shaft angle, smooth between `breaks`; `kin.dynamics.drive.Motion` is the same.

    Velocity may jump at `corners`, which are some of the breaks.
    """

    @property
    def breaks(self) -> Array:
        """Shaft angles at which velocity or acceleration may jump, in [0, 2 pi)."""

    @property
    def corners(self) -> Array:
        """Those of the breaks at which the velocity may jump."""

    def rows(self, phi: Array) -> Array:
        """Position and two derivatives by the shaft angle, (3, n), at angles phi (n,) that are no breaks."""


@dataclass(frozen=True, eq=False)
class Shifted:
    """sign * drive + offset, where the shaft stands `turned` ahead, radians."""

    drive: Drive
    sign: float = 1.0
    offset: float = 0.0
    turned: float = 0.0

    @property
    def breaks(self) -> Array:
        """The drive's."""
        return self.drive.breaks - self.turned if self.turned else self.drive.breaks

    @property
    def corners(self) -> Array:
        """The drive's."""
        return self.drive.corners - self.turned if self.turned else self.drive.corners

    def rows(self, phi: Array) -> Array:
        """See `Drive`."""
        rows = self.sign * self.drive.rows(phi + self.turned if self.turned else phi)
        rows[0] += self.offset
        return rows
