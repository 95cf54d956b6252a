"""Linear equations of chains: a link's hold the unknowns of its two joints, and one number that its chain shares.

Links are joined in pairs and the joint between them is eliminated, all pairs at once, until a chain is one link: as
many rounds as the longest chain has binary digits (structured orthogonal factorisation of two-point boundary problems:
S. J. Wright, SIAM J. Sci. Stat. Comput. 13, 1992, 742-764). Orthogonal elimination needs no pivots and loses no digits.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from kin.numeric.arrays import Array

UNKNOWNS = 3  # of a joint


def solve_chains(links: Array, chain: NDArray[np.intp]) -> tuple[Array, Array]:
    """Unknowns of the joints (n + chains, 3) and of the chains (chains,) from the equations of n links.

    `links` (n, 3, 8) are the rows of each link: coefficients of its left joint, of its right joint and of its chain's
    number, and the right-hand side; rows of zeros are allowed. `chain` (n,) is the index of a link's chain, from 0,
    never falling. The first and last joint of every chain are zero. Unknowns that the equations do not determine are
    not finite, or large.
    """
    n = chain.size
    chains = int(chain[-1]) + 1
    left = np.arange(n) + chain
    right = left + 1
    joints = np.zeros((n + chains, UNKNOWNS))
    rounds = []
    # join links a and b = a + 1: QR of the columns of their shared joint leaves three rows that determine the joint
    # and three that do not contain it, which are the new link's
    while True:
        length = np.bincount(chain, minlength=chains)
        place = np.arange(chain.size) - (np.cumsum(length) - length)[chain]
        opens = (place % 2 == 0) & (place + 1 < length[chain])
        a = np.flatnonzero(opens)
        if not a.size:
            break
        b = a + 1
        shared = np.concatenate([links[a, :, 3:6], links[b, :, 0:3]], axis=1)
        rows = np.zeros((a.size, 6, 8))
        rows[:, :3, 0:3] = links[a, :, 0:3]
        rows[:, 3:, 3:6] = links[b, :, 3:6]
        rows[:, :3, 6:] = links[a, :, 6:]
        rows[:, 3:, 6:] = links[b, :, 6:]
        q, r = np.linalg.qr(shared, mode="complete")
        rows = q.transpose(0, 2, 1) @ rows
        rounds.append((left[a], right[a], right[b], r[:, :3], rows[:, :3], chain[a]))
        links = links.copy()
        links[a] = rows[:, 3:]
        right = right.copy()
        right[a] = right[b]
        keep = np.ones(chain.size, dtype=bool)
        keep[b] = False
        links, left, right, chain = links[keep], left[keep], right[keep], chain[keep]
    with np.errstate(divide="ignore", invalid="ignore"):
        # with both end joints 0 a chain's last link gives its number; then joints from the last round to the first
        number = np.sum(links[:, :, 6] * links[:, :, 7], axis=1) / np.sum(links[:, :, 6] ** 2, axis=1)
        for low, middle, high, r, rows, owner in reversed(rounds):
            known = np.concatenate([joints[low], joints[high], number[owner, None]], axis=1)
            value = rows[:, :, 7] - np.einsum("nij,nj->ni", rows[:, :, :7], known)
            for i in (2, 1, 0):
                value[:, i] -= np.einsum("nj,nj->n", r[:, i, i + 1 :], value[:, i + 1 :])
                value[:, i] /= r[:, i, i]
            joints[middle] = value
    return joints, number
