"""Forces of two contacts that hold a follower from both sides, elastic along their normals and rigid otherwise.

Contact 1 pushes the follower out by P1, contact 2 in by P2, both along its travel, or as moments about its pivot:
P1 - P2 = F is what the cam must give. With the levers h of `kin.follower.contact_lines` a normal force is N = P/h, and
a stiffness k along the normal is K = k h^2 along the travel.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from kin.numeric.arrays import Array


class Elastic(NamedTuple):
    """Two contacts under preload: its force along the travel, and the stiffness of each along it; (n,) each."""

    preload: Array
    first: Array
    second: Array

    @property
    def loses_second(self) -> Array:
        """Force F at which contact 2 is lost (n,): above it contact 1 bears alone. For equal stiffness twice P."""
        force: Array = self.preload * (1.0 + self.first / self.second)
        return force

    @property
    def loses_first(self) -> Array:
        """Force F, below 0, at which contact 1 is lost (n,)."""
        force: Array = -self.preload * (1.0 + self.second / self.first)
        return force

    def split(self, force: Array) -> Array:
        """P1 and P2 (2, n) at forces F (n,): a contact that is lost bears nothing, the other all of it."""
        share = self.first / (self.first + self.second)
        pair = np.array([self.preload + share * force, self.preload - (1.0 - share) * force])
        pair[0] = np.where(pair[1] < 0.0, force, pair[0])
        pair[1] = np.where(pair[0] < 0.0, -force, pair[1])
        pressed: Array = np.maximum(pair, 0.0)
        return pressed


def preloaded(levers: tuple[Array, Array], overlaps: tuple[float, float], stiffness: tuple[float, float]) -> Elastic:
    """Two contacts that overlap the metal by lengths along their normals, unloaded.

    The follower yields until both press alike: it lacks x = o1/h1 + o2/h2 of room, so P = x/(1/K1 + 1/K2).
    """
    room = overlaps[0] / levers[0] + overlaps[1] / levers[1]
    first, second = (k * lever**2 for k, lever in zip(stiffness, levers, strict=True))
    return Elastic(room / (1.0 / first + 1.0 / second), first, second)
