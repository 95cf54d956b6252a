"""A mechanism as members that move as one or apart: plates, exact places over the shaft angle, and fits."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from camgeo.capabilities.mechanism.body import PrintBody
from kin.numeric.angles import TURN
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Callable

    from camgeo.capabilities.mechanism.body import Plate
    from camgeo.capabilities.mechanism.sizes import Sizes
    from kin.numeric.arrays import Array

    Place: TypeAlias = Callable[[Array, int], Array]
    """Shaft angles (n,) and an order to x, y and angle with their derivatives by the shaft angle, (3, order + 1, n)."""

STEPS = 360  # places of a turn that a file is given
GROUND = "ground"


@dataclass(frozen=True, eq=False)
class Member:
    """A body with its exact place, None for what stands still.

    Members of one `group` are pressed together and move as one.
    """

    name: str
    plates: tuple[Plate, ...]
    group: str
    place: Place | None = None
    colour: str = "#9aa5b1"

    def body(self, steps: int = STEPS) -> PrintBody:
        """Return it as what is printed, with its places at so many equal steps of a turn."""
        return PrintBody(self.name, self.plates, self.poses(steps), self.place is None, self.colour)

    def poses(self, steps: int = STEPS) -> Array:
        """Return x, y and angle (steps + 1, 3) over a turn; (1, 3) of what stands still."""
        if self.place is None:
            return np.zeros((1, 3))
        found = self.place(TURN * np.arange(steps + 1) / steps, 0)[:, 0].T.copy()
        found[:, 2] = np.unwrap(found[:, 2])
        return found


@dataclass(frozen=True)
class Fit:
    """A place where one body runs on another, and by how much the one is wider; mm. `pressed` ones are narrower.

    `held` is by how much what drives is too wide to turn in what it drives.
    """

    name: str
    clearance: float
    pressed: bool = False
    held: float | None = None


@dataclass(frozen=True, eq=False)
class Assembly:
    """All bodies of a mechanism, the cam first, and the pairs that touch by design.

    `fits` are the clearances by construction; `remarks` tell a maker what the bodies do not show.
    """

    members: tuple[Member, ...]
    fits: tuple[Fit, ...]
    sizes: Sizes
    touching: frozenset[frozenset[str]] = frozenset()
    remarks: tuple[str, ...] = ()
