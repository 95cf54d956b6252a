"""Developments of a barrel: lines of a drawing laid round a cylinder, and a turret set down on them there.

A straight line of the drawing becomes a helix. The second derivative of the squared distance of its points from an
axis, by the polar angle, is at most `2 (r^2 + climb^2)` and at least -2 r times the distance. So points close to one
another settle what stands out and what is bare, within a remainder. The turret is set down at the angles between such
points, and its errors there are a sample. A development says nothing of any other radius.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kin.indexing.holding import by_error
from kin.indexing.intent import SIDES
from kin.indexing.rollers import REACH, Rollers
from kin.indexing.volume import swept_stretches
from kin.law.motion_error import MotionError
from kin.numeric.angles import TURN, degrees
from kin.numeric.arrays import runs_of
from kin.numeric.check import ROUNDING, Check, at_most, failed
from kin.numeric.lengths import UNIT, length_words
from kin.numeric.limits import limit_of
from kin.numeric.records import dataclass, replace
from kin.turned.verdict import CONTOUR, MOTION, FlankVerdict

if TYPE_CHECKING:
    from kin.indexing.intent import IndexIntent
    from kin.numeric.arrays import Array, Mask
    from kin.numeric.limits import Limits
    from kin.turned.files import Developed

FINE = 0.05  # of the tolerance, within which what lies between points is known
MOST = 200_000  # points of a line
STEEP = 1e3  # mm per mm: a line that rises faster is divided by its length, as it may cross a track at one angle
ANGLES = 720  # of a turn, at which it is looked whether a line is missing
BESIDE = 0.1  # of a roller's radius: a line that is farther off is another one


class _Line(NamedTuple):
    """Points of lines round their cylinder: places (n, 3), over the turret's centre; `joined` (n - 1,) to the next.

    `room` is by how much the excess may be another between points that are joined, mm^2.
    """

    points: Array
    joined: Mask
    room: float


@dataclass(frozen=True)
class _Measured:
    """What a line shows: its distance in the drawing, mm, at an angle, rad, and the turret's errors (m,), rad.

    The distance is known within `remainder`, each error within `room`. An error of the line of 1 mm turns the turret by
    `cost`, rad, at most.
    """

    off: float
    at: float
    remainder: float
    errors: Array
    angles: Array
    room: float
    cost: float


def judged_line(
    parts: list[Array], intent: IndexIntent, line: Developed, limits: Limits
) -> tuple[FlankVerdict, list[Check]]:
    """Verdict on one line, in mm and as if not mirrored, and its checks; raises ValueError for a globoid."""
    depth = intent.form.developed(line.radius)
    rollers = Rollers(intent, limits.tolerance)
    if not parts:
        why = f"nothing is drawn on the layer {line.layer}"
        return FlankVerdict(line.layer), [failed(CONTOUR, why, unit="mm", limit=limits.tolerance)]
    short = _missing(parts, rollers, line, depth)
    if short is not None:
        why = f"the line is missing at x = {length_words(short[0])}, y = {length_words(short[1])} {UNIT}"
        return FlankVerdict(line.layer), [failed(CONTOUR, why, unit="mm", limit=limits.tolerance)]
    found = _flank(parts, rollers, line)
    slack = ROUNDING * max(float(np.abs(part).max()) for part in parts)
    alone = f"at a radius of {length_words(line.radius)} {UNIT} alone"
    sure = f"true within {length_words(found.remainder, '.2g')} {UNIT}"
    off = found.off + found.remainder if found.remainder > FINE * limits.tolerance else found.off
    check = at_most(CONTOUR, off, limits.tolerance, "mm", detail=f"{alone}; {sure}", slack=slack)
    checks = [replace(check, at=degrees(found.at))]
    errors = np.degrees(found.errors)
    k = int(np.abs(errors).argmax())
    sizes = float(np.abs(errors[k])), degrees(float(found.angles[k])), math.degrees(found.room)
    motion = MotionError(
        *sizes, float(errors.min()), float(errors.max()), float(np.sqrt(np.mean(errors**2))), "deg", "sampled"
    )
    given = None if limits.motion is None else math.degrees(limits.motion)
    cost = math.degrees(found.cost)
    limit, room = limit_of(lambda e: e * cost, given, limits.tolerance, slack)
    check = at_most(MOTION, motion.max, limit, "deg", detail=alone, slack=room)
    checks.append(replace(check, at=motion.at))
    return FlankVerdict(line.layer, motion, found.off), checks


def _missing(parts: list[Array], rollers: Rollers, line: Developed, depth: float) -> tuple[float, float] | None:
    """A place x, y, mm, at which no line is drawn and one should be; None where there is none."""
    intent, turn = rollers.intent, TURN * line.radius
    phi = (np.arange(ANGLES) + 0.5) * np.float64(TURN / ANGLES)
    below = SIDES[line.flank] < 0
    wanted = [least if below else most for least, most in swept_stretches(rollers, depth, phi)]
    starts = np.concatenate([part[:-1] for part in parts])
    lasts = np.concatenate([part[1:] for part in parts])
    low, high = np.minimum(starts[:, 0], lasts[:, 0]), np.maximum(starts[:, 0], lasts[:, 0])
    width = turn / ANGLES
    first, last = (np.floor(x / width + 0.5).astype(np.intp) for x in (low, high))
    own, more = runs_of(last - first)
    column = first[own] + more
    way = (lasts - starts)[own]
    share = ((column + 0.5) * width - starts[own, 0]) / way[:, 0]
    heights = starts[own, 1] + share * way[:, 1] - intent.height
    reach = BESIDE * intent.roller
    order = np.argsort(column % ANGLES, kind="stable")
    column, heights = column[order] % ANGLES, heights[order]
    # heights of all columns in one row: those of one are apart from those of others
    apart = 4.0 * (intent.length + intent.form.radius)
    row = np.sort(column * apart + np.clip(heights, -0.4 * apart, 0.4 * apart))
    for want in wanted:
        inside = np.isfinite(want) & (want > intent.ends[0] + reach) & (want < intent.ends[1] - reach)
        at = np.flatnonzero(inside)
        sought = at * apart + want[at]
        found = np.searchsorted(row, sought)
        ahead, behind = row[np.minimum(found, len(row) - 1)], row[np.maximum(found - 1, 0)]
        near = np.minimum(np.abs(ahead - sought), np.abs(behind - sought)) if len(row) else np.full(len(at), np.inf)
        if (near > reach).any():
            k = at[int(near.argmax())]
            return float(phi[k] * line.radius), float(want[k] + intent.height)
    return None


def _laid(parts: list[Array], rollers: Rollers, radius: float) -> _Line:
    """Points of the lines round their cylinder, so close that what lies between them is known."""
    intent = rollers.intent
    steps = [np.diff(part, axis=0) for part in parts]
    along, up = np.abs(np.concatenate(steps)).T
    steep = up > STEEP * along
    climb = radius * float((up[~steep] / np.maximum(along[~steep], 1e-9)).max(initial=0.0))
    reach = REACH * float(rollers.radii.max())
    bend = 2.0 * (radius**2 + climb**2) + 2.0 * reach * radius
    fine = 8.0 * FINE * rollers.tolerance * 2.0 * intent.roller
    step = max(math.sqrt(fine / bend), float(along.sum()) / radius / MOST)
    # of a steep line by its share: twice its squared length, and the bend of its angle beside which is nothing
    long = np.hypot(up, along) * math.sqrt(2.0 * (1.0 + reach / radius / STEEP**2))
    short = max(math.sqrt(fine), float(long[steep].sum()) / MOST)
    counts = np.where(steep, np.ceil(long / short), np.maximum(np.ceil(along / (radius * step)), 1.0)).astype(np.intp)
    room = 0.125 * max(bend * step**2, short**2 if steep.any() else 0.0)
    rows, joined = [], []
    for part, count in zip(parts, np.split(counts, np.cumsum([len(way) for way in steps])[:-1]), strict=True):
        own, number = runs_of(count)
        share = number / count[own]
        rows.append(np.concatenate([part[own] + share[:, None] * np.diff(part, axis=0)[own], part[-1:]]))
        joined.append(np.append(np.ones(len(own), dtype=np.bool_), False))
    flat = np.concatenate(rows)
    phi = flat[:, 0] / radius
    points = np.stack([radius * np.cos(phi), radius * np.sin(phi), flat[:, 1] - intent.height], axis=-1)
    return _Line(points, np.concatenate(joined)[:-1], room)


def _flank(parts: list[Array], rollers: Rollers, line: Developed) -> _Measured:
    """A flank: how far its points are from what rollers sweep, and what they hold the turret by."""
    laid, side = _laid(parts, rollers, line.radius), SIDES[line.flank]
    form, radius = rollers.intent.form, rollers.intent.radius(side)
    worst = rollers.worst(laid.points)
    met = rollers.at(laid.points, worst.theta)
    away = rollers.distance(worst.excess, np.full(len(met.d), radius))
    # seen in the drawing the surface is as far off as its normal is level there
    u, v = form.plane(met.x, met.y, laid.points[:, 2])
    one, other = form.beside(met.y, u, v, met.psi)
    out = one / np.maximum(np.hypot(one, other), 1e-9) * met.y / line.radius
    off = np.abs(away) / np.sqrt(np.maximum(1.0 - out**2, 1e-6))
    off = np.where(met.d * side > 0.0, off, off + radius)
    first, last = worst.theta[:-1][laid.joined], worst.theta[1:][laid.joined]
    middle = first + 0.5 * (np.remainder(last - first + math.pi, TURN) - math.pi)
    between = []
    for points in (laid.points[:-1][laid.joined], laid.points[1:][laid.joined]):
        there = rollers.at(points, middle)
        touch = form.touch(there.s, there.y, np.full(len(middle), radius))
        give = np.where(np.isfinite(touch) & (there.d * side > 0.0), touch - np.abs(there.d), -math.pi)
        between.append(give)
    holds = np.minimum(*between)
    # of several rollers the one that holds the turret best counts
    count = max(1, min(4096, len(holds) // 4))
    column = np.floor(np.remainder(middle, TURN) * (count / TURN)).astype(np.intp) % count
    best = np.full(count, -np.inf)
    np.maximum.at(best, column, holds)
    held = np.flatnonzero(np.isfinite(best))
    gives = form.touch(met.s, met.y, np.full(len(met.d), radius)) - np.abs(met.d)
    gives = np.where(np.isfinite(gives), gives, math.pi)
    errors = np.concatenate([best[held], [float(gives.max())]])
    angles = np.append((held + 0.5) * (TURN / count), worst.theta[int(gives.argmax())])
    k = int(off.argmax())
    room = laid.room / (2.0 * radius)
    cost = by_error(rollers, side, form.developed(line.radius))
    return _Measured(float(off[k]), float(worst.theta[k]), room, errors, angles, room * cost, cost)
