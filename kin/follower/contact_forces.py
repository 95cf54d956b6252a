"""Forces of two contacts that hold a follower from both sides, elastic along their normals and rigid otherwise.

Contact 1 pushes the follower out by P1, contact 2 in by P2, both along its travel, or as moments about its pivot:
P1 - P2 = F is what the cam must give. With the levers h of `kin.follower.contact_lines` a normal force is N = P/h, and
a stiffness k along the normal is K = k h^2 along the travel.

In a guide with friction P1 - P2 = F + rub (|R_near| + |R_far|), R the reactions of its ends to both contacts together.
What the contacts yield together stays the same: P1/K1 + P2/K2 is the travel by which the metal is too wide for them.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from kin.numeric.arrays import Array


class Elastic(NamedTuple):
    """Two contacts under preload: preload P and stiffness K of each contact, both along the travel; (n,) each.

    N and N/mm; about a pivot N mm and N mm/rad.
    """

    preload: Array
    first: Array
    second: Array

    @property
    def loses_second(self) -> Array:
        """Force F above 0 (n,) from which on contact 2 is lost and contact 1 bears alone: 2 P for equal stiffness."""
        force: Array = self.preload * (1.0 + self.first / self.second)
        return force

    @property
    def loses_first(self) -> Array:
        """Force F below 0 (n,) below which contact 1 is lost and contact 2 bears alone."""
        force: Array = -self.preload * (1.0 + self.second / self.first)
        return force

    @property
    def together(self) -> Array:
        """Share of the stiffness along the travel that is left while both contacts bear (n,): 1 without friction."""
        return np.ones_like(self.preload)

    def apart(self, gap: Array) -> Elastic:
        """The pair on metal narrower by `gap` (n,), mm or rad along the travel: the preload falls, at most to 0."""
        compliance = 1.0 / self.first + 1.0 / self.second
        return self._replace(preload=np.maximum(self.preload - gap / compliance, 0.0))

    def split(self, force: Array) -> Array:
        """P1 and P2 (2, n), N or N mm, 0 or above, at forces F = P1 - P2 (n,).

        Where one contact is lost, the other bears |F| alone.
        """
        share = self.first / (self.first + self.second)
        pair = np.array([self.preload + share * force, self.preload - (1.0 - share) * force])
        pair[0] = np.where(pair[1] < 0.0, force, pair[0])
        pair[1] = np.where(pair[0] < 0.0, -force, pair[1])
        pressed: Array = np.maximum(pair, 0.0)
        return pressed


class Guided(NamedTuple):
    """Two contacts under preload on a stem that rubs in its guide, at n places.

    elastic  both contacts without friction
    ends     reactions of the guide's near and far end to 1 N of P of either contact, N (2, 2, n): contact, end
    rub      coefficient of friction, above 0 where the stem moves as contact 1 pushes, 0 at rest (n,)
    """

    elastic: Elastic
    ends: Array
    rub: Array

    @property
    def alone(self) -> Array:
        """Force along the travel, less guide friction, by the P of contact 1 and of contact 2 (2, n) that bears alone.

        This ratio is 1 without friction. At 0 or below the stem jams.
        """
        rubbing = self.rub * np.abs(self.ends).sum(axis=1)
        shares: Array = np.array([1.0 - rubbing[0], 1.0 + rubbing[1]])
        return shares

    @property
    def together(self) -> Array:
        """Least share of the stiffness along the travel that friction leaves while both bear (n,); at 0 it jams."""
        ratio = self.elastic.second / self.elastic.first
        turned = np.abs(self.ends[0] - ratio * self.ends[1]).sum(axis=0)
        share: Array = 1.0 - np.abs(self.rub) * turned / (1.0 + ratio)
        return share

    @property
    def loses_second(self) -> Array:
        """Force F (n,), friction included, from which on contact 2 is lost and contact 1 bears alone."""
        force: Array = self.elastic.loses_second * self.alone[0]
        return force

    @property
    def loses_first(self) -> Array:
        """Force F (n,) below 0, friction included, below which contact 1 is lost and contact 2 bears alone."""
        force: Array = self.elastic.loses_first * self.alone[1]
        return force

    def split(self, force: Array) -> Array:
        """P1 and P2 (2, n) at forces F (n,); not a number where the stem jams.

        While both bear, P1 - P2 less friction is linear in P1 for either sign of both reactions. Friction takes the
        signs that make it greatest: of four solutions P1 is the greatest where that opposes it, else the least.
        """
        ratio, preload_sum = self.elastic.second / self.elastic.first, -self.elastic.loses_first
        force_by_signs = []
        for near in (-1.0, 1.0):  # signs of the reactions at both ends of the guide
            for far in (-1.0, 1.0):
                first, second = self.rub * (near * self.ends[:, 0] + far * self.ends[:, 1])
                force_by_signs.append((force + preload_sum * (1.0 + second)) / (1.0 + ratio - first + ratio * second))
        first_force = np.where(self.rub > 0.0, np.max(force_by_signs, axis=0), np.min(force_by_signs, axis=0))
        pair = np.array([first_force, preload_sum - ratio * first_force])
        alone = self.alone
        pair = np.where(force > self.loses_second, [force / alone[0], np.zeros_like(force)], pair)
        pair = np.where(force < self.loses_first, [np.zeros_like(force), -force / alone[1]], pair)
        free = np.minimum(alone.min(axis=0), self.together) > 0.0
        pressed: Array = np.where(free, pair, np.nan)
        return pressed


def preloaded(levers: tuple[Array, Array], overlaps: tuple[float, float], stiffness: tuple[float, float]) -> Elastic:
    """Two contacts under the preload that follows from their overlaps with the metal, the follower unloaded.

    levers     h1, h2 (n,) of `kin.follower.contact_lines`
    overlaps   o1, o2 along the normals of the contacts, mm
    stiffness  k1, k2 along the normals, N/mm

    The follower yields until both contacts press alike. Its travel lacks x = o1/h1 + o2/h2. The preload is P = x/(1/K1
    + 1/K2), K = k h^2.
    """
    overlap = overlaps[0] / levers[0] + overlaps[1] / levers[1]
    first, second = (k * lever**2 for k, lever in zip(stiffness, levers, strict=True))
    return Elastic(overlap / (1.0 / first + 1.0 / second), first, second)
