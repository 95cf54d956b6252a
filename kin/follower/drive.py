"""What the contacts of a follower feel of a contour over the shaft angle: what drives a follower train.

Every drive is in SI, metres or radians: a contact's own position, which grows away from the cam.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, ClassVar, Protocol

import numpy as np

from kin.contour.arcs import left, right
from kin.follower.contact import first_contact
from kin.follower.guide import METRE
from kin.follower.motion_error import ContactError
from kin.numeric.angles import TURN

if TYPE_CHECKING:
    from kin.contour.arcs import Arcs
    from kin.follower.guide import Guide
    from kin.follower.support import Bearing
    from kin.numeric.arrays import Array, Indices

_INSET = 1e-6  # how far within an interval between two angles it is looked for the piece that is met there
_HALVINGS = 60  # of an interval, more than a number has bits: a passage is found to its last places


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
    """sign * drive + offset, where the shaft stands `turned` ahead, radians."""

    drive: Excitation
    sign: float = 1.0
    offset: float = 0.0
    turned: float = 0.0

    @property
    def breaks(self) -> Array:
        """The drive's."""
        return self.drive.breaks - self.turned if self.turned else self.drive.breaks

    @property
    def smooth(self) -> bool:
        """As that one."""
        return self.drive.smooth

    def rows(self, phi: Array) -> Array:
        """See `Excitation`."""
        rows = self.sign * self.drive.rows(phi + self.turned if self.turned else phi)
        rows[0] += self.offset
        return rows


@dataclass(frozen=True, eq=False)
class OfFace:
    """Distance at which a flat face rests on a contour, its normal `turned` ahead of the shaft angle.

    Between two breaks it is that of one corner or one circle: q = R + C.u(theta), q'' = R - q. Along a line of travel
    on which it stands askew it is q over `share`, the cosine.
    """

    bearing: Bearing
    turned: float = 0.0
    share: float = 1.0
    smooth: ClassVar[bool] = False  # over an edge the contact leaps from end to end

    @property
    def breaks(self) -> Array:
        """Where the contact passes from piece to piece."""
        return np.mod(self.bearing.breaks - self.turned, TURN)

    def rows(self, phi: Array) -> Array:
        """See `Excitation`."""
        theta = phi + self.turned
        rows: Array = METRE / self.share * self.bearing.derivatives(theta, self.bearing.find(theta))
        return rows


@dataclass(frozen=True, eq=False)
class OfRoller:
    """Position of a guided roller that rests on a contour; `obstacle` is what the roller's centre cannot enter.

    The guide stands at the shaft angle and what it is `turned` ahead. What a piece's curvature and tangent make of the
    derivatives is the guide's to tell.
    """

    obstacle: Arcs
    guide: Guide
    turned: float = 0.0
    smooth: ClassVar[bool] = False  # the roller may rest in a hollow

    @cached_property
    def breaks(self) -> Array:
        """Where the roller passes from piece to piece; two passages within a millionth of an interval may be lost."""
        ends = self.guide.shaft_angle(np.concatenate([self.obstacle.start, self.obstacle.ends])) - self.turned
        ends = np.unique(np.mod(ends[np.isfinite(ends)], TURN))
        width = np.diff(ends, append=ends[:1] + TURN)
        ends, width = ends[width > 1e-12], width[width > 1e-12]
        low, high = ends + _INSET * width, ends + (1.0 - _INSET) * width
        piece = self._met(low)[1]
        leaps = piece != self._met(high)[1]
        low, high, piece = low[leaps], high[leaps], piece[leaps]
        for _ in range(_HALVINGS if len(low) else 0):
            middle = 0.5 * (low + high)
            same = self._met(middle)[1] == piece
            low, high = np.where(same, middle, low), np.where(same, high, middle)
        return np.sort(np.mod(np.concatenate([ends, low]), TURN))

    def _met(self, phi: Array) -> tuple[Array, Indices]:
        r, piece = first_contact(self.obstacle, self.guide, phi + self.turned)
        if (piece < 0).any():
            raise ContactError("the roller does not touch the contour", float(phi[int(np.argmin(piece))]))
        return r, piece

    def rows(self, phi: Array) -> Array:
        """See `Excitation`."""
        guide, angle = self.guide, phi + self.turned
        r, piece = self._met(phi)
        met = self.obstacle.take(piece)
        position = guide.position(r)
        x = guide.centre(angle, position)
        outward = right(met.tangent) + met.curvature[:, None] * (x - met.start)
        tangent = left(outward / np.hypot(outward[:, 0], outward[:, 1])[:, None])
        rows: Array = guide.si * np.stack([position, *guide.rates(angle, x, tangent, met.curvature)])
        return rows
