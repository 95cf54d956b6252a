"""A roller set down on the contour of a linear cam as it lies in a file, in closed form on each line and arc.

The roller's centre stays out of the contour dilated by its radius (`kin.contour.dilated`). A piece of that boundary
holds the roller up where it faces along the guide, which is where the input falls along it, as metal lies to its left.
With start P, outward normal m there and curvature k its circle is 2 y.m + k y^2 = 0, y = x - P, so that a stem's lift
and an arm's angle follow from

    k t^2 + 2 b t + c = 0,  b = g.(m + k w),  c = w.(2 m + k w),  w = (u, level) - P,  g the guide's direction,
    A cos psi + B sin psi = K,  (-s A, B) = m + k w,  K = -(w.(2 m + k w) + k l^2)/(2 l),  w = (u, pivot) - P.

Of a circle about z with radius r on an upright stem the first is the lift z_y + sqrt(r^2 - (u - z_x)^2).
"""

from __future__ import annotations

import math
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from kin.contour.arcs import Arcs, dot, nearest_on, right
from kin.contour.dilated import dilated
from kin.linear.follower import Stem
from kin.numeric.distinct import distinct
from kin.numeric.errors import CamgeoError
from kin.numeric.lengths import UNIT, length_words
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from kin.linear.follower import LinearFollower
    from kin.numeric.arrays import Array, Indices, Mask

MOST_TURN = np.pi / 8.0  # pieces are cut until each turns less
PART_OF_ARM = 0.125  # of an arm: no piece is longer
REACH = 1.0 - 1e-9  # of an arm: so far off the pivot's height its roller is looked at
HALVINGS = 60  # of a piece, more than a number has bits
SLACK = 1e-13  # of the size: pieces reach so far beyond their ends
PAIRS_AT_ONCE = 1_000_000  # of piece and input, which bounds the memory that a hostile contour takes


class RestError(CamgeoError, ValueError):
    """The follower finds no contact at the input `at`, mm."""

    def __init__(self, at: float) -> None:
        super().__init__(f"the follower touches nothing at an input of {length_words(at)} {UNIT}")
        self.at = at


@dataclass(frozen=True, eq=False)
class Held:
    """Pieces that may hold a roller's centre up, each from its highest input to its lowest.

    pieces     lines and short arcs of the dilated contour that face along the guide
    low, high  inputs (n,), mm, over which each of them may hold it
    """

    follower: LinearFollower
    pieces: Arcs
    low: Array
    high: Array

    @staticmethod
    def of(chain: Arcs, follower: LinearFollower, span: tuple[float, float], near: float | None = None) -> Held:
        """Make ready the pieces of a closed chain with the metal to its left, over inputs in the span, mm.

        With `near`, pieces are left out whose middle lies more than so far, mm, above the intended centre: a groove's
        other flank faces up in its dents.
        """
        pieces = _shortened(dilated(chain, follower.radius), follower)
        pieces = _facing(pieces, follower)
        high, _ = follower.lift_at(pieces.start)
        low, _ = follower.lift_at(pieces.ends)
        keep = (low <= span[1]) & (high >= span[0]) & (low < high)
        held = Held(follower, pieces.take(keep), low[keep], high[keep])
        if near is None or not keep.any():
            return held
        first, last = follower.span
        input_, lift = follower.lift_at(held.pieces.points(0.5 * held.pieces.length))
        inside = input_ if follower.endless else np.clip(input_, first, last)
        keep = (lift - follower.law.derivatives(inside, 0)[0]) * follower.lever <= near
        return Held(follower, held.pieces.take(keep), held.low[keep], held.high[keep])

    @cached_property
    def size(self) -> float:
        """Greatest coordinate, mm, from which rounding counts."""
        return max(float(np.abs(self.pieces.start).max(initial=1.0)), self.follower.lever)

    @cached_property
    def ends(self) -> Array:
        """Inputs (k,), mm, rising, at which pieces begin or end; those that rounding alone parts are given once."""
        every = distinct(np.concatenate([self.low, self.high]))
        return every[np.diff(every, prepend=-np.inf) > 4.0 * SLACK * self.size]

    def on(self, piece: Indices, u: Array) -> Array:
        """Lift (n,), mm or rad, with the centre on each piece, run on beyond its ends, at inputs u (n,), mm."""
        pieces, guide = self.pieces.take(piece), self.follower.guide
        m, k = right(pieces.tangent), pieces.curvature
        if isinstance(guide, Stem):
            g = np.array([math.sin(guide.gamma), math.cos(guide.gamma)])
            w = np.stack([u, np.full(len(u), self.follower.level)], axis=-1) - pieces.start
            b, c = (m + k[:, None] * w) @ g, 2.0 * dot(w, m) + k * dot(w, w)
            root = np.sqrt(np.maximum(b * b - k * c, 0.0))
            with np.errstate(divide="ignore", invalid="ignore"):
                lift: Array = np.where(b > 0.0, -c / (b + root), (root - b) / k)
            return lift
        length = guide.length
        w = np.stack([u, np.full(len(u), guide.pivot)], axis=-1) - pieces.start
        v = m + k[:, None] * w
        a, b = -guide.side * v[:, 0], v[:, 1]
        share = -(2.0 * dot(w, m) + k * (dot(w, w) + length**2)) / (2.0 * length * np.hypot(a, b))
        angle = np.arctan2(b, a) - np.arccos(np.clip(share, -1.0, 1.0))
        turned: Array = np.mod(angle + np.pi, 2.0 * np.pi) - np.pi - self.follower.psi0
        return turned

    def place(self, piece: Indices, u: Array) -> Array:
        """Arc length (n,) on pieces (n,) of the centre at inputs u (n,), mm."""
        return nearest_on(self.pieces.take(piece), self.follower.centre(u, self.on(piece, u)))[0]

    def first(self, u: Array) -> tuple[Array, Indices]:
        """Lift (n,) of the follower set down at inputs u (n,), mm, and the piece that holds it: nan and -1 for none."""
        order = np.argsort(u, kind="stable")
        at = u[order]
        slack = SLACK * self.size
        begin = np.searchsorted(at, self.low - slack, side="left")
        count = np.searchsorted(at, self.high + slack, side="right") - begin
        best, met = np.full(len(at), -np.inf), np.full(len(at), -1)
        total, done = np.cumsum(count), 0
        while done < len(self.pieces):
            stop = int(np.searchsorted(total, total[done] - count[done] + PAIRS_AT_ONCE, side="right"))
            chosen = np.arange(done, max(done + 1, stop))
            piece = np.repeat(chosen, count[chosen])
            index = (
                begin[piece]
                + np.arange(len(piece))
                - np.repeat(np.cumsum(count[chosen]) - count[chosen], count[chosen])
            )
            lift = self.on(piece, at[index])
            np.maximum.at(best, index, lift)
            won = lift == best[index]
            met[index[won]] = piece[won]
            done = int(chosen[-1]) + 1
        lifts, held = np.full(len(at), np.nan), np.empty(len(at), dtype=np.intp)
        lifts[order] = np.where(met >= 0, best, np.nan)
        held[order] = met
        return lifts, held

    def reached(self, u: Array) -> Array:
        """Lift (n,), mm or rad, of the follower set down at inputs u (n,), mm; RestError where it touches nothing."""
        lift, piece = self.first(u)
        if (piece < 0).any():
            raise RestError(float(u[int(np.argmax(piece < 0))]))
        return lift


def _shortened(pieces: Arcs, follower: LinearFollower) -> Arcs:
    """Pieces that turn by MOST_TURN at most, and are short beside an arm, within its reach."""
    parts = np.ceil(np.abs(pieces.curvature) * pieces.length / MOST_TURN)
    if not isinstance(follower.guide, Stem):
        parts = np.maximum(parts, np.ceil(pieces.length / (PART_OF_ARM * follower.guide.length)))
    pieces, _ = pieces.cut(np.maximum(parts, 1.0).astype(np.intp))
    pieces = pieces.take(pieces.length > 0.0)
    if isinstance(follower.guide, Stem):
        return pieces
    height = np.maximum(*(np.abs(ends[:, 1] - follower.guide.pivot) for ends in (pieces.start, pieces.ends)))
    sag = 0.125 * np.abs(pieces.curvature) * pieces.length**2
    return pieces.take(height + sag <= REACH * follower.guide.length)


def _facing(pieces: Arcs, follower: LinearFollower) -> Arcs:
    """The parts of short pieces that face along the guide: each piece changes once at most, at a place bisected."""

    def facing(part: Arcs, s: Array) -> Mask:
        towards: Mask = follower.rates_along(part.points(s), part.tangents(s))[0] < 0.0
        return towards

    begin, end = np.zeros(len(pieces)), pieces.length.copy()
    first, last = facing(pieces, begin), facing(pieces, end)
    change = np.flatnonzero(first != last)
    if change.size:
        part, was = pieces.take(change), first[change]
        low, high = begin[change], end[change]
        for _ in range(HALVINGS):
            middle = 0.5 * (low + high)
            same = facing(part, middle) == was
            low, high = np.where(same, middle, low), np.where(same, high, middle)
        begin[change], end[change] = np.where(was, 0.0, high), np.where(was, low, part.length)
    keep = (first | last) & (end > begin)
    whole, begin, end = pieces.take(keep), begin[keep], end[keep]
    return Arcs(whole.points(begin), whole.tangents(begin), whole.curvature, end - begin)
