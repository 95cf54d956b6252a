"""Exact places of a linkage's bodies over the shaft angle, from the jets of its mechanism."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Callable

    from camgeo.capabilities.mechanism.assembly import Place
    from kin.linkage.chain import Solved
    from kin.linkage.links import Link
    from kin.linkage.mechanism import Mechanism
    from kin.numeric.arrays import Array


@dataclass(frozen=True, eq=False)
class Links:
    """The links of a mechanism that turns: each by its place over the shaft angle.

    Loop 0 is the linkage's, loop k that of the k-th dyad.
    """

    mechanism: Mechanism

    def place(self, pose: Callable[[Solved], Link]) -> Place:
        """Give the place of a link's own axes."""
        mechanism = self.mechanism

        def place(phi: Array, order: int) -> Array:
            motion = mechanism.at(mechanism.relative(phi), order)
            link = pose(motion.solved)
            x, y = link.origin
            angle = x.constant(0.0) if link.direction is None else link.direction
            found: Array = np.stack([motion.over_shaft(row.derivatives()) for row in (x, y, angle)])
            return found

        return place

    def frame(self) -> Place:
        """Place of the square frame: its middle, and u(theta_3)."""
        return self.place(self.mechanism.chain.frame)

    def output(self, loop: int) -> Place:
        """Place of the link that a loop drives."""
        return self.place(self.mechanism.chain.output(loop).pose)

    def rod(self, loop: int) -> Place:
        """Place of a dyad's bar PQ: origin P, x towards Q."""
        return self.place(lambda solved: self.mechanism.chain.rod(solved, loop - 1))

    def joint(self, loop: int, name: str) -> Place:
        """Place of a joint and of the block in it, x along the line on which that slides."""
        return self.place(lambda solved: self.mechanism.chain.joints(solved, loop)[name].place)
