"""What a contact of a follower feels of a contour over the shaft angle: what drives a follower train.

Every drive is in SI, metres or radians: a contact's own position, which grows away from the cam. Each touch has its
own, beside its follower.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from kin.numeric.arrays import Array


class Excitation(Protocol):
    """A position over the shaft angle, of period one turn, smooth between `breaks`: of a contact its own position."""

    @property
    def breaks(self) -> Array:
        """Shaft angles at which velocity or acceleration may jump, in [0, 2 pi), in any order."""

    @property
    def smooth(self) -> bool:
        """Whether the two limits of the velocity are one at all breaks."""

    def rows(self, phi: Array) -> Array:
        """Position and two derivatives by the shaft angle, (3, n), at angles phi (n,) that are no breaks."""


@dataclass(frozen=True, eq=False)
class Shifted:
    """sign * drive + offset."""

    drive: Excitation
    sign: float = 1.0
    offset: float = 0.0

    @property
    def breaks(self) -> Array:
        """The drive's."""
        return self.drive.breaks

    @property
    def smooth(self) -> bool:
        """As that one."""
        return self.drive.smooth

    def rows(self, phi: Array) -> Array:
        """See `Excitation`."""
        rows = self.sign * self.drive.rows(phi)
        rows[0] += self.offset
        return rows
