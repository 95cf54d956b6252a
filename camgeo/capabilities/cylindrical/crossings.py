"""Where the tracks of a groove of several turns cross, and what each takes of the other's walls.

A groove that closes after n turns crosses itself: S(t) and S(t + 2 pi k) have the same mean over the period, so that
they are equal somewhere. At a crossing the track a rises against the track b. On every cylinder about the axis the
flanks of both meet at four corners, and between two of them either lacks a stretch of each of its walls:

    flanks of a and b    corner                          of a begins, ends    of b begins, ends
    lower, lower         the wall below goes on as b's   begins               ends
    upper, upper         the wall above goes on as a's   ends                 begins
    lower, upper         metal begins between them       ends (lower)         ends (upper)
    upper, lower         metal ends between them         begins (upper)       begins (lower)

A corner solves phi_b(s) = phi_a(t) + 2 pi k and z_b(s) = z_a(t) by Newton's method, from places where rows on the blank
change sides; those on the floor have to be the same. With tracks that cross at an angle g, a gap in a wall is as long
as the groove is wide, over sin g. As tan a = S'/r, sin g is r |S_a' - S_b'|/(w_a w_b): it has one greatest value, so
that over the roller's length it is least, and the gap longest, at one of its ends; at the outer one of tracks that
climb alike to either side, and are no steeper than 45 degrees.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from camgeo.curve.curve import CurveError
from kin.numeric.angles import TURN
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Mapping

    from camgeo.capabilities.cylindrical.flank import Flank
    from kin.numeric.arrays import Array, Mask

SEEK = 1440  # places of a turn between which rows change sides
BEYOND = 0.3  # of a turn by which a row is known beyond its period
STEPS = 6  # radii from the blank to the floor, from each of which the corners of the next are found
NEWTON, SETTLED = 12, 3e-13  # steps, and mm of a corner that need no further one
MEET = 1e-9  # mm: so near two flanks are at a corner
STEP = 1e-6  # rad: of a difference quotient for Newton's method, which its result does not depend on
NEAR = 0.1  # rad by which lines of corners between their known radii stay within these
PARTS = 64  # of a gap, over which its length is summed
TOGETHER = 1e-9  # of the stroke: tracks so near to one another run together
PAIRS = {
    "below": ("lower", "lower"),
    "above": ("upper", "upper"),
    "open": ("lower", "upper"),
    "close": ("upper", "lower"),
}
"""Corners of a crossing: the flank of the track a and that of the track b."""
LOST = {
    ("a", "lower"): ("below", "open"),
    ("a", "upper"): ("close", "above"),
    ("b", "lower"): ("close", "below"),
    ("b", "upper"): ("above", "open"),
}
"""Corners between which a track lacks a stretch of a wall."""


class CrossingError(CurveError):
    """Tracks that run together, or whose walls are not there between two crossings."""


@dataclass(frozen=True, eq=False)
class Corner:
    """A corner of a crossing on cylinders of radii r (k,), mm, falling: shaft angles (k,) on both flanks, rad."""

    flanks: tuple[Flank, Flank]
    shift: float
    r: Array
    first: Array
    second: Array

    def at(self, r: Array) -> tuple[Array, Array]:
        """Shaft angles (n,), rad, on the flanks of a and of b on cylinders of radii (n,), mm."""
        rising = self.r[::-1]
        first, second = (np.interp(r, rising, own[::-1]) for own in (self.first, self.second))
        if np.isin(r, rising).all():
            return first, second
        return _settled(self.flanks, self.shift, r, first, second)


@dataclass(frozen=True, eq=False)
class Crossing:
    """Tracks a and b at shaft angles `first` and `second`, rad, at which their paths meet, whole turns apart."""

    first: float
    second: float
    corners: Mapping[str, Corner]

    def angle(self, flank: Flank, rho: float) -> float:
        """Angle between both tracks, rad, at a distance from the axis, mm."""
        slopes = flank.law.derivatives(np.array([self.first, self.second]), 1)[1]
        up, down = np.arctan2(slopes, rho).tolist()
        return float(up - down)

    def gap(self, r: float) -> float:
        """Greatest length, mm, over which either track lacks a wall on the cylinder r, mm."""
        radius, places = np.array([r]), {}
        for word, corner in self.corners.items():
            contact = corner.flanks[0].on(corner.at(radius)[0], radius)
            places[word] = (r * float(contact.phi[0]), float(contact.z[0]))
        # on the cylinder a corner is one place, of a and, whole turns on, of b
        return max(math.dist(places[begin], places[end]) for begin, end in LOST.values())

    def gap_within(self, r: float, tolerance: float) -> float:
        """Greatest length, mm, along the paths of the roller's axis, over which a solid may lack a wall on a cylinder.

        What lies within a tolerance, mm, of the other track counts as gone: at a corner where both walls meet at an
        angle b that is tolerance/sin b, to first order.
        """
        radius, shares, found = np.array([r]), (np.arange(PARTS) + 0.5) / PARTS, []
        places, nearer = {}, {}
        for word, corner in self.corners.items():
            places[word] = corner.at(radius)
            rows = [_row(flank, at, radius) for flank, at in zip(corner.flanks, places[word], strict=True)]
            one, other = (math.atan2(float(z[0]), r * float(phi[0])) for _, _, phi, z in rows)
            nearer[word] = tolerance / abs(math.sin(one - other))
        for (track, _), words in LOST.items():
            k = "ab".index(track)
            begin, end = (float(places[word][k][0]) for word in words)
            more = sum(nearer[word] for word in words)
            slope = self.corners[words[0]].flanks[k].law.derivatives(begin + (end - begin) * shares, 1)[1]
            found.append((end - begin) * float(np.hypot(r, slope).mean()) + more)
        return max(found)


class Lost(NamedTuple):
    """A stretch that a flank lacks: the corners at which it begins and ends, each with which of its flanks it is."""

    begin: tuple[Corner, int]
    end: tuple[Corner, int]

    def over(self, r: Array) -> tuple[Array, Array]:
        """First and last shaft angle that is lost on cylinders of radii r (n,), mm."""
        (first, i), (last, j) = self
        return first.at(r)[i], last.at(r)[j]

    def has(self, theta: Array, r: Array, period: float) -> Mask:
        """Whether places of a flank, at shaft angles, rad, on cylinders of radii, mm, (n,) each, are lost."""
        found = np.zeros(theta.shape, dtype=bool)
        (first, i), (last, j) = self
        ends = (first.first, first.second)[i], (last.first, last.second)[j]
        begin = min(float(end.min()) for end in ends) - NEAR
        offset = np.mod(theta - begin, period)
        near = np.flatnonzero(offset < max(float(end.max()) for end in ends) + NEAR - begin)
        if near.size:
            low, high = self.over(r[near])
            found[near] = (low < begin + offset[near]) & (begin + offset[near] < high)
        return found


def _settled(flanks: tuple[Flank, Flank], shift: Array | float, r: Array, t: Array, s: Array) -> tuple[Array, Array]:
    """Shaft angles (n,), rad, at which two flanks meet on cylinders r (n,), mm, from a guess."""
    off = np.full_like(t, np.inf)
    for _ in range(NEWTON):
        (phi_a, z_a, phi_1, z_1), (phi_b, z_b, phi_2, z_2) = (
            _row(flank, angle, r) for flank, angle in zip(flanks, (t, s), strict=True)
        )
        along, up = phi_b - phi_a - shift, z_b - z_a
        off = np.hypot(r * along, up)
        if not (off > SETTLED).any():
            break
        det = phi_1 * z_2 - phi_2 * z_1
        if not det.all():
            raise CrossingError("two turns of the groove touch without crossing", float(t[np.argmin(np.abs(det))]))
        # phi_1 dt - phi_2 ds = along, z_1 dt - z_2 ds = up
        dt, ds = (phi_2 * up - z_2 * along) / -det, (phi_1 * up - z_1 * along) / -det
        t, s = t + dt, s + ds
    if not (off < MEET).all():
        raise CrossingError("the walls of two tracks do not meet at one place", float(t[0]))
    return t, s


def _row(flank: Flank, theta: Array, r: Array) -> tuple[Array, Array, Array, Array]:
    """Polar angle and height on cylinders, and their derivatives by the shaft angle, (n,) each."""
    near = np.concatenate([theta, theta + STEP, theta - STEP])
    contact = flank.on(near, np.tile(r, 3))
    (phi, ahead, behind), (z, over, under) = (part.reshape(3, -1) for part in (contact.phi, contact.z))
    return phi, z, (ahead - behind) / (2.0 * STEP), (over - under) / (2.0 * STEP)


def _changes(one: Array, other: Array, turns: int) -> list[tuple[int, int]]:
    """Places and turns k at which a row comes from below to above another one k turns on; rows (turns SEEK,)."""
    found = []
    for k in range(1, turns):
        over = one - np.roll(other, -k * SEEK) > 0.0
        found += [(int(i), k) for i in np.flatnonzero(~over & np.roll(over, -1))]
    return found


def sampled(flank: Flank, r: float | None) -> tuple[Array, Array]:
    """Heights, mm, of a row on a cylinder at equal steps of its polar angle over the period, and its shaft angles.

    Without a radius it is the path of the roller's axis over the shaft angle.
    """
    turns = round(flank.period / TURN)
    at = np.asarray(np.arange(turns * SEEK) * (TURN / SEEK), dtype=np.float64)
    if r is None:
        return flank.pose(at).z, at
    margin = round(BEYOND * SEEK)
    theta = np.asarray(np.arange(-margin, turns * SEEK + margin + 1) * (TURN / SEEK), dtype=np.float64)
    contact = flank.on(theta, r)
    return np.interp(at, contact.phi, contact.z), np.interp(at, contact.phi, theta)


def crossings_of(flanks: Mapping[str, Flank], low: float, high: float) -> list[Crossing]:
    """Crossings of the tracks of a groove between two radii, mm, by the shaft angle of the rising track.

    Raises CrossingError for tracks that run together or whose walls vanish beside a crossing, with a shaft angle.
    """
    lower = flanks["lower"]
    turns = round(lower.period / TURN)
    if turns == 1:
        return []
    places = meetings(lower)
    rows = {(name, r): sampled(flank, r) for name, flank in flanks.items() for r in (low, high)}
    found: dict[str, list[Corner]] = {}
    radii = np.linspace(high, low, STEPS + 1)
    for word, (a, b) in PAIRS.items():
        seeds = _seeds(rows, (a, b), high, turns)
        if len(seeds) != len(places) or len(_seeds(rows, (a, b), low, turns)) != len(places):
            raise _no_wall(places, seeds)
        found[word] = _corners((flanks[a], flanks[b]), seeds, radii)
        _demand_same(found[word], _seeds(rows, (a, b), low, turns), low)
    made = []
    for first, k in places:
        chosen = {}
        for word, corners in found.items():
            near = min(
                corners, key=lambda corner: (corner.shift != TURN * k, _apart(corner.first[0], first, lower.period))
            )
            if near.shift != TURN * k:
                raise _no_wall(places, [])
            chosen[word] = near
        made.append(Crossing(first, math.fmod(first + TURN * k, lower.period), chosen))
    if any(len({id(each.corners[word]) for each in made}) != len(made) for word in PAIRS):
        raise _no_wall(places, [])
    return sorted(made, key=lambda each: each.first)


def meetings(flank: Flank) -> list[tuple[float, int]]:
    """Shaft angles, rad, at which the path of the roller's axis rises through itself, and the turns between them.

    Raises CrossingError for a path that is the same over a stretch of two turns.
    """
    path, at = sampled(flank, None)
    turns = path.size // SEEK
    _demand_apart(path, turns)
    return [(_meeting(flank, float(at[i]), TURN * k), k) for i, k in _changes(path, path, turns)]


def _no_wall(places: list[tuple[float, int]], seeds: list[tuple[float, float, int]]) -> CrossingError:
    """Error of walls that are not there: of a corner without a crossing of paths near it, or of two that are one."""
    at = [t for t, *_ in seeds] or [t for t, _ in places] or [0.0]
    far = max(at, key=lambda t: min((abs(t - other) for other, _ in places), default=math.inf))
    return CrossingError("neighbouring turns of the groove run into one another beside their crossings", far)


def _demand_apart(path: Array, turns: int) -> None:
    """Raise CrossingError where the path of the roller's axis is the same over a stretch of two turns."""
    slack = TOGETHER * max(float(np.ptp(path)), 1e-3)
    for k in range(1, turns):
        same = np.abs(path - np.roll(path, -k * SEEK)) < slack
        both = same & np.roll(same, -1)
        if both.any():
            raise CrossingError("two turns of the groove are one over a stretch", float(np.argmax(both)) * TURN / SEEK)


def _meeting(flank: Flank, t: float, shift: float) -> float:
    """Shaft angle, rad, behind a place, at which the path of the axis meets itself a whole number of turns on."""
    low, high = t, t + TURN / SEEK
    for _ in range(60):
        middle = 0.5 * (low + high)
        one, other = flank.law.derivatives(np.array([middle, middle + shift]), 0)[0]
        low, high = (middle, high) if one < other else (low, middle)
    return 0.5 * (low + high)


def _seeds(
    rows: Mapping[tuple[str, float], tuple[Array, Array]], pair: tuple[str, str], r: float, turns: int
) -> list[tuple[float, float, int]]:
    """Shaft angles on both flanks, rad, near which they meet on a cylinder r, mm, and the turns between them."""
    (one, t), (other, s) = rows[pair[0], r], rows[pair[1], r]
    count = one.size
    found = []
    for i, k in _changes(one, other, turns):
        j = i + k * SEEK
        found.append((float(t[i]), float(s[j % count]) + turns * TURN * (j // count), k))
    return found


def _corners(flanks: tuple[Flank, Flank], seeds: list[tuple[float, float, int]], radii: Array) -> list[Corner]:
    """Corners near places on the first of radii (k,), mm, followed to the others."""
    if not seeds:
        return []
    t, s, k = np.array(seeds).T
    first, second = np.empty((radii.size, t.size)), np.empty((radii.size, t.size))
    for i, r in enumerate(radii.tolist()):
        t, s = _settled(flanks, TURN * k, np.full_like(t, r), t, s)
        first[i], second[i] = t, s
    return [
        Corner(flanks, TURN * float(turns), radii, *line) for turns, *line in zip(k, first.T, second.T, strict=True)
    ]


def _demand_same(corners: list[Corner], seeds: list[tuple[float, float, int]], r: float) -> None:
    """Raise CrossingError where the corners on the floor are not those that were followed from the blank."""
    for t, _, k in seeds:
        if not any(
            corner.shift == TURN * k
            and _apart(corner.at(np.array([r]))[0][0], t, corner.flanks[0].period) < 2.5 * TURN / SEEK
            for corner in corners
        ):
            raise CrossingError("a wall between two turns ends in a ridge above the floor", t)


def _apart(one: float, other: float, period: float) -> float:
    return abs(math.remainder(one - other, period))


def lost_of(crossings: list[Crossing], name: str) -> list[Lost]:
    """Stretches that a flank, `lower` or `upper`, lacks, in no order."""
    found = []
    for crossing in crossings:
        for (side, of), (begin, end) in LOST.items():
            if of == name:
                k = "ab".index(side)
                found.append(Lost((crossing.corners[begin], k), (crossing.corners[end], k)))
    return found


# --- between turns ----------------------------------------------------------------------------------------------------


def wall_between(flanks: Mapping[str, Flank], r: float) -> tuple[float, float]:
    """Least wall, mm, that does not end in a corner between two turns on a cylinder r, mm, and its shaft angle, rad.

    It is a local least distance, unrolled, of an upper flank from the next lower flank above it; infinite where there
    is none. It is sampled and narrowed.
    """
    (low, _), (high, theta) = (sampled(flanks[name], r) for name in ("lower", "upper"))
    turns = low.size // SEEK
    if turns == 1:
        return math.inf, 0.0
    step = TURN / SEEK
    at = np.arange(low.size)
    lows, highs = (np.stack([np.roll(row, -k * SEEK) for k in range(1, turns)]) for row in (low, high))
    covered = ((lows <= high) & (highs > high)).any(axis=0)
    above = np.where((lows > high) & ~covered, lows - high, np.inf)
    k = np.argmin(above, axis=0)
    gap = above[k, at]
    reach = float(np.where(np.isfinite(gap), gap, 0.0).max())
    apart = np.full(low.size, np.inf)
    most = math.ceil(min(reach / r, 0.25 * TURN) / step)
    for beside in range(-most, most + 1):
        other = low[(at + (k + 1) * SEEK + beside) % low.size]
        apart = np.minimum(apart, np.where(other > high, np.hypot(r * step * beside, other - high), np.inf))
    apart = np.where(np.isfinite(gap), apart, np.inf)
    before, behind = np.roll(apart, 1), np.roll(apart, -1)
    same = (np.roll(k, 1) == k) & (np.roll(k, -1) == k) & np.isfinite(before + apart + behind)
    least = np.flatnonzero(same & (apart <= before) & (apart <= behind))
    if not least.size:
        return math.inf, 0.0
    i = int(least[np.argmin(apart[least])])
    return _narrowed(low, high, r, (i, i + (int(k[i]) + 1) * SEEK), reach), float(theta[i])


def _narrowed(low: Array, high: Array, r: float, places: tuple[int, int], reach: float) -> float:
    """Least distance, mm, between two rows near places of them, in steps of the polar angle."""
    step = TURN / SEEK
    x, y = float(places[0]), float(places[1])
    wide = max(2.0, reach / (r * step))
    best = math.inf
    for _ in range(8):
        near, far = (middle + wide * np.linspace(-1.0, 1.0, 65) for middle in (x, y))
        z, w = (
            np.interp(at % row.size, np.arange(row.size + 1), np.append(row, row[0]))
            for at, row in ((near, high), (far, low))
        )
        apart = far[None, :] - near[:, None] - SEEK * round((places[1] - places[0]) / SEEK)
        found = np.hypot(r * step * apart, w[None, :] - z[:, None])
        a, b = np.unravel_index(int(np.argmin(found)), found.shape)
        x, y, best, wide = float(near[a]), float(far[b]), float(found[a, b]), wide / 8.0
    return best
