"""Where a flank is undercut, and what all rollers together leave of it.

On every cylinder a regular flank is a graph over the polar angle, on which each roller touches at one place alone: so
where it is regular from floor to blank, no roller cuts into what another one leaves. Where it turns back (D < 0), the
row on a cylinder crosses itself, and beyond the crossing another roller has cut deeper. Towards the blank such a cut
ends at its tip, a place with D = 0 on the farthest cylinder.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from camgeo.capabilities.cylindrical.bends import bends
from camgeo.capabilities.cylindrical.grid import breaks_of, parts_between
from camgeo.curve.curve import CurveError
from camgeo.measures.placed import greatest_of
from kin.numeric.angles import TURN
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from camgeo.capabilities.cylindrical.flank import Flank, Pose
    from kin.numeric.arrays import Array, Mask

SEEK = 2880  # shaft angles of a turn at which an undercut is sought
DEPTHS = 33  # radii at which it is sought
HALVINGS = 50  # of a step between two of these, or of an angle, at which it begins
ZOOMS = 8  # onto a tip, each to a 24th of the angles before
ALONG = 400  # places on either branch of a row near its crossing
NEWTON = 12  # steps to where a row crosses itself
SHARP = 1e-3  # of a roller's radius, to which the largest one without an undercut is sought
STEP = 1e-6  # rad: of a difference quotient for Newton's method, which its result does not depend on
CELLS, PARTS, ROUNDS, MOST_OPEN = 360, 4, 11, 100_000  # of the proof that a flank is regular


class Tip(NamedTuple):
    """The outermost place of an undercut: distance along the roller and from the axis, mm, and shaft angle, rad."""

    rho: float
    r: float
    at: float


class CutError(CurveError):
    """Undercut that no shortening of the contact removes."""


@dataclass(frozen=True, eq=False)
class Cut:
    """A part of a flank that is cut away: at radii r (k,), mm, rising to its tip, from `first` to `last`, rad (k,).

    Both ends of a row are one point of the flank.
    """

    tip: Tip
    r: Array
    first: Array
    last: Array

    def at(self, r: Array) -> tuple[Array, Array]:
        """First and last shaft angle that is lost at radii (n,), mm; equal beyond the tip."""
        # in the root of the distance from the tip both run straight there
        depth, own = (np.sqrt(np.maximum(self.tip.r - radius, 0.0)) for radius in (r, self.r))
        order = np.argsort(own)
        grown = np.append(0.0, own[order])
        first, last = (np.interp(depth, grown, np.append(self.tip.at, ends[order])) for ends in (self.first, self.last))
        return first, last


def _both(flank: Flank, theta: Array) -> tuple[Pose, Pose]:
    """Poses at shaft angles (n,), before and behind a break."""
    return flank.pose(theta, -1), flank.pose(theta, 1)


def _regular(flank: Flank, poses: Sequence[Pose], r: Array | float) -> Array:
    """D (n,), mm, on cylinders r, mm, the least of all poses (n,)."""
    found = [flank.regularity(pose, flank.reached(pose, r)) for pose in poses]
    return np.asarray(np.min(found, axis=0))


def _along(flank: Flank, poses: Sequence[Pose], rho: Array) -> Array:
    """D, mm, at distances rho, mm, along the roller, of a shape that goes with (n,), the least of all poses (n,)."""
    return np.asarray(np.min([flank.regularity(pose, rho) for pose in poses], axis=0))


def tips(flank: Flank, low: float, high: float) -> list[Tip]:
    """Tips of all undercuts of a flank from radius `low` to `high`, mm, by their shaft angles; empty where none is.

    An undercut that reaches the blank has its tip there.
    """
    theta = parts_between(breaks_of(flank), SEEK)
    reach = _reach(flank, theta, low, high)
    if not (reach > low).any():
        return []
    under = np.flatnonzero(reach > low)
    groups = np.split(under, np.flatnonzero(np.diff(under) > 1) + 1)
    if len(groups) > 1 and groups[0][0] == 0 and groups[-1][-1] == theta.size - 1:
        groups[0] = np.concatenate([groups.pop(), groups[0]])
    found = []
    for group in groups:
        best = int(group[np.argmax(reach[group])])
        at, step = float(theta[best]), TURN / SEEK
        r = float(reach[best])
        for _ in range(ZOOMS):
            near = np.linspace(at - step, at + step, 65)
            reached = _reach(flank, near, low, high)
            k = int(np.argmax(reached))
            if reached[k] > r:
                at, r = float(near[k]), float(reached[k])
            step /= 24.0
        rho = float(flank.on(np.array([at]), r).rho[0])
        found.append(Tip(rho, r, math.fmod(at, flank.period)))
    return sorted(found, key=lambda tip: tip.at)


def _reach(flank: Flank, theta: Array, low: float, high: float) -> Array:
    """Greatest radius (n,), mm, at which the flank is undercut at shaft angles (n,), up to `high`; else `low`."""
    both = _both(flank, theta)
    rho, outside = _zeros(flank, both, low, high)
    some = np.flatnonzero(rho)
    reach = np.full(theta.shape, low)
    reach[some] = np.where(outside[some], high, flank.radii(both[1].at(some), rho[some]))
    return reach


def below(flank: Flank, low: float, high: float) -> tuple[float, float]:
    """Greatest distance along the roller, mm, at which D is 0, between radii of a flank, and the shaft angle, rad.

    Nearer to the axis the flank is undercut somewhere. (0, nan) of a flank that is regular.
    """
    greatest, at = greatest_of(lambda theta: _zeros(flank, _both(flank, theta), low, high)[0], flank.period)
    return (greatest, at) if greatest else (0.0, math.nan)


def _zeros(flank: Flank, poses: Sequence[Pose], low: float, high: float) -> tuple[Array, Mask]:
    """Greatest distance along the roller (n,), mm, at which D is 0 at poses (n,) between radii; 0 without undercut.

    The mask (n,) says where the flank is undercut out to the radius `high`.
    """
    rho, under = _seen(flank, poses, low, high)
    last = DEPTHS - 1 - np.argmax(under[::-1], axis=0)
    some = under.any(axis=0)
    found = np.where(some, rho[last, np.arange(some.size)], 0.0)
    where = np.flatnonzero(some & (last < DEPTHS - 1))
    a, b = rho[last[where], where], rho[last[where] + 1, where]
    near = [pose.at(where) for pose in poses]
    for _ in range(HALVINGS):
        middle = 0.5 * (a + b)
        less = _along(flank, near, middle) < 0.0
        a, b = np.where(less, middle, a), np.where(less, b, middle)
    found[where] = b
    return found, some & (last == DEPTHS - 1)


def _seen(flank: Flank, poses: Sequence[Pose], low: float, high: float) -> tuple[Array, Mask]:
    """Distances along the roller (DEPTHS, n), mm, at poses (n,) between radii, and whether the flank is undercut."""
    inner, outer = (flank.reached(poses[-1], r) for r in (low, high))
    share = np.linspace(0.0, 1.0, DEPTHS)[:, None]
    rho = inner * (1.0 - share) + outer * share
    return rho, _along(flank, poses, rho) < 0.0


def largest_regular(resized: Callable[[float], Sequence[Flank]], most: float, ends: tuple[float, float]) -> float:
    """Largest roller, mm, to a share of `SHARP`, of which no flank is undercut between radii; 0 where none is found.

    `resized` gives the flanks of a roller; those of the radius `most`, mm, are undercut. Where the axis of the roller
    goes does not depend on its size, so it is sought where that one undercuts, and the one found is looked at all over.
    """
    whole = [_both(flank, parts_between(breaks_of(flank), SEEK)) for flank in resized(most)]
    near = [
        [pose.at(np.flatnonzero(_seen(flank, poses, *ends)[1].any(axis=0))) for pose in poses]
        for flank, poses in zip(resized(most), whole, strict=True)
    ]

    def free(radius: float, seen: Sequence[Sequence[Pose]]) -> bool:
        flanks = resized(radius)
        return not any(_seen(flank, poses, *ends)[1].any() for flank, poses in zip(flanks, seen, strict=True))

    for seen in (near, whole):
        low, high = 0.0, most
        while high - low > SHARP * high:
            middle = 0.5 * (low + high)
            low, high = (middle, high) if free(middle, seen) else (low, middle)
        if low == 0.0 or free(low, whole):
            return low
    return 0.0


def demand_regular(flank: Flank, low: float, high: float) -> None:
    """Raise CurveError where it is not proved that a flank is regular from radius `low` to `high`, mm."""
    theta = parts_between(breaks_of(flank), CELLS)
    edges = np.linspace(low, high, PARTS + 1)
    n = theta.size - 1
    a, b = np.tile(theta[:-1], PARTS), np.tile(theta[1:], PARTS)
    c, d = np.repeat(edges[:-1], n), np.repeat(edges[1:], n)
    for _ in range(ROUNDS):
        open_ = ~(bends(flank, (a, b), (c, d)).regular > 0.0)
        if not open_.any():
            return
        if np.count_nonzero(open_) > MOST_OPEN:
            break
        a, b, c, d = a[open_], b[open_], c[open_], d[open_]
        t, r = 0.5 * (a + b), 0.5 * (c + d)
        if (_regular(flank, _both(flank, t), r) < 0.0).any():
            break
        a, b = np.concatenate([a, t, a, t]), np.concatenate([t, b, t, b])
        c, d = np.concatenate([c, c, r, r]), np.concatenate([r, r, d, d])
    raise CurveError("a flank is so near to an undercut that it can be neither proved nor excluded", float(a[0]))


def cut_at(flank: Flank, tip: Tip, r: Array) -> Cut:
    """What is lost about a tip at radii r (k,), mm, below that of the tip, rising.

    Raises CutError where two undercuts reach into one another.
    """
    first, last = _crossings(flank, tip, r)
    for _ in range(NEWTON):
        (phi1, z1), (phi2, z2) = (_place(flank, t, r) for t in (first, last))
        (dphi1, dz1), (dphi2, dz2) = (_slope(flank, t, r) for t in (first, last))
        gap, rise = phi2 - phi1, z2 - z1
        det = dphi2 * dz1 - dphi1 * dz2
        sound = np.abs(det) > 0.0
        det = np.where(sound, det, 1.0)
        # dphi2 d2 - dphi1 d1 = -gap, dz2 d2 - dz1 d1 = -rise
        d1 = np.where(sound, (dphi2 * rise - dz2 * gap) / -det, 0.0)
        d2 = np.where(sound, (dphi1 * rise - dz1 * gap) / -det, 0.0)
        half = 0.25 * (last - first)
        first, last = first + np.clip(-d1, -half, half), last + np.clip(-d2, -half, half)
    return Cut(tip, r, first, last)


def _place(flank: Flank, theta: Array, r: Array) -> tuple[Array, Array]:
    contact = flank.on(theta, r)
    return contact.phi, contact.z


def _slope(flank: Flank, theta: Array, r: Array) -> tuple[Array, Array]:
    after, before = _place(flank, theta + STEP, r), _place(flank, theta - STEP, r)
    return (after[0] - before[0]) / (2.0 * STEP), (after[1] - before[1]) / (2.0 * STEP)


def _crossings(flank: Flank, tip: Tip, r: Array) -> tuple[Array, Array]:
    """Shaft angles (k,), rad, at which rows on cylinders r (k,) cross themselves about a tip, to an interpolation."""
    middle = SEEK // 2
    theta = np.asarray(tip.at + TURN / SEEK * np.arange(-middle, middle + 1), dtype=np.float64)
    both = _both(flank, theta)
    low, high = np.empty((2, r.size)), np.empty((2, r.size))
    phi = np.stack([_place(flank, theta, np.full_like(theta, radius))[0] for radius in r.tolist()])
    spans = []
    for radius in r.tolist():
        back = _regular(flank, both, radius) < 0.0
        back[middle] = True
        a = middle - int(np.argmax(~back[: middle + 1][::-1]))  # the last before the turn back
        b = middle + int(np.argmax(~back[middle:]))  # the first behind it
        more = np.flatnonzero(back[:a]), np.flatnonzero(back[b:])
        spans.append(
            (int(more[0][-1]) + 1 if more[0].size else 0, a, b, b + int(more[1][0]) - 1 if more[1].size else -1)
        )
    _, firsts, lasts, _ = np.array(spans).T
    edges = [
        _turning(flank, theta[firsts], np.minimum(theta[firsts + 1], tip.at), r),
        _turning(flank, theta[lasts], np.maximum(theta[lasts - 1], tip.at), r),
    ]
    phi_a, phi_b = (_place(flank, edge, r)[0] for edge in edges)
    for k, (begin, a, b, end) in enumerate(spans):
        before = np.flatnonzero(phi[k, begin : a + 1] <= phi_b[k])
        behind = np.flatnonzero(phi[k, b : end if end >= 0 else None] >= phi_a[k])
        if not (before.size and behind.size):
            raise CutError("two undercuts of a flank reach into one another", tip.at)
        low[0, k], high[1, k] = theta[begin + int(before[-1])], theta[b + int(behind[0])]
    share = np.linspace(0.0, 1.0, ALONG)
    left = low[0][:, None] * (1.0 - share) + edges[0][:, None] * share
    right = edges[1][:, None] * (1.0 - share) + high[1][:, None] * share
    radii = np.repeat(r, ALONG)
    (phi_l, z_l), (phi_r, z_r) = (
        [part.reshape(left.shape) for part in _place(flank, t.ravel(), radii)] for t in (left, right)
    )
    first, last = edges[0].copy(), edges[1].copy()
    for k in range(r.size):
        gap = z_l[k] - np.interp(phi_l[k], phi_r[k], z_r[k])
        inside = (phi_l[k] >= phi_r[k, 0]) & (phi_l[k] <= phi_r[k, -1])
        change = np.flatnonzero(inside[:-1] & inside[1:] & (np.sign(gap[:-1]) != np.sign(gap[1:])))
        if change.size:
            i = int(change[0])
            part = gap[i] / (gap[i] - gap[i + 1])
            first[k] = left[k, i] + part * (left[k, i + 1] - left[k, i])
            last[k] = np.interp(phi_l[k, i] + part * (phi_l[k, i + 1] - phi_l[k, i]), phi_r[k], right[k])
    return first, last


def _turning(flank: Flank, sound: Array, back: Array, r: Array) -> Array:
    """Shaft angles (k,), rad, between regular places and ones that are not, at which rows turn back."""
    for _ in range(HALVINGS):
        middle = 0.5 * (sound + back)
        turned = _regular(flank, _both(flank, middle), r) < 0.0
        sound, back = np.where(turned, sound, middle), np.where(turned, middle, back)
    return sound
