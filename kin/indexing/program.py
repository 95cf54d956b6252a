"""The verdict on a program of a machine with a rotary axis: what its cutter leaves of a barrel, and how it goes there.

The cutter's path is what the control makes of the blocks: all axes move evenly between them. The metal is what no
position of the cutter takes away. It is held against the exact flank that a roller leaves on its way through the
barrel, over all its angles and from its inner end to the blank (`kin.turned.cutters`). The turret is held by all
rollers that are in the barrel at an angle. What is left moves it by the cost of an error there, to first order.

Where the cutter is, it stands beside the barrel, or within the track. At its own angle it is parallel to all rollers,
and reaches no farther beyond one than its axis is off, and its radius is larger. Between blocks that is bounded by the
second derivative of the roller's way.
"""

from __future__ import annotations

import math
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from kin.indexing.contour import Peak
from kin.indexing.holding import Held, by_error
from kin.indexing.intent import SIDES
from kin.indexing.judge import contour_check, motion_check, motion_error, play_of
from kin.indexing.motion import STEPS
from kin.indexing.rollers import Rollers
from kin.numeric.angles import TURN, degrees
from kin.numeric.arrays import runs_of
from kin.numeric.check import ROUNDING, Check, failed
from kin.numeric.errors import UnsettledError
from kin.numeric.lengths import UNIT, length_words
from kin.numeric.records import dataclass, replace
from kin.read.checks import count_check
from kin.turned.checks import Work, astray, cleared_check, cutter_check, depth_check, feed_check, rapid_check
from kin.turned.cutters import cells_within, corners_of, finest_on, left_on
from kin.turned.files import verify_moves
from kin.turned.verdict import CONTOUR, FlankVerdict, TurnedVerdict

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from kin.indexing.intent import IndexIntent
    from kin.law.contacts import Side
    from kin.numeric.arrays import Array, Mask
    from kin.numeric.limits import Limits
    from kin.turned.checks import Cutting
    from kin.turned.cutters import Along, Left
    from kin.turned.guide import Axis, Swing
    from kin.turned.moves import Pass, TurnedProgram

COARSE, FAR = 20.0, 3.0  # times the tolerance: what a first look is good for, and what is refused at it
MARGIN = 0.01  # of a roller's radius beyond the ends, over which the flank is looked at too
LONGEST = 0.01  # rad of a block, in which the cutter is held against one roller
ANGLES = 4096  # of a turn, at which the turret is held
NEAR = 0.05  # of the tolerance, by which a block may bend away from the roller's way
MOST_PLACES = 4_000_000  # at which the cutter is held against one


def verify_program(path: Path, intent: IndexIntent, cutting: Cutting, limits: Limits) -> TurnedVerdict:
    """Judge a program by what its cutter leaves; raises OSError where the disk refuses, ValueError for a globoid."""
    intent.form.guide(intent.height, intent.start)
    job = _Judged(Rollers(intent, limits.tolerance), cutting, limits)
    return verify_moves(path, intent.form.radius, job.verdict, mirrored=intent.mirrored)


def finest_told(intent: IndexIntent, cutting: Cutting) -> float:
    """Least tolerance, mm, to which `verify_program` tells what a cutter leaves; raises ValueError for a globoid."""
    rollers = Rollers(intent, 1.0)
    return max(finest_on(_Track(rollers, side), cutting.radius) for side in SIDES.values())


@dataclass(frozen=True, eq=False)
class _Way:
    """How a roller of the turret goes through the cam, turn after turn."""

    rollers: Rollers

    @cached_property
    def span(self) -> tuple[float, float]:
        """Shaft angles, rad, between which it touches the cam."""
        intent = self.rollers.intent
        pitch, (low, high) = intent.pitch, intent.ends
        reach = (1.0 + MARGIN) * float(self.rollers.radii.max())
        first, last = (math.floor((end * 0.5 * math.pi - intent.start) / pitch) for end in (-1.0, 1.0))
        theta = np.arange((first - 2) * STEPS, (last + 3) * STEPS + 1) * np.float64(TURN / STEPS)
        psi = intent.start + self.at(theta)[0]
        height = self.rollers.intent.form.lever * np.sin(psi)
        near = np.flatnonzero((np.abs(psi) < 0.5 * math.pi) & (height >= low - reach) & (height <= high + reach))
        return float(theta[near[0] - 1]), float(theta[near[-1] + 1])

    @cached_property
    def breaks(self) -> Array:
        """Angles (k,) of the span at which a derivative may jump."""
        first, last = (math.floor(end / TURN) for end in self.span)
        each = np.append(self.rollers.intent.law.breaks, 0.0)
        every = (each + TURN * np.arange(first, last + 2)[:, None]).ravel()
        return np.asarray(every[(every > self.span[0]) & (every < self.span[1])])

    def at(self, theta: Array) -> tuple[Array, Array, Array]:
        """Advance, rad, with its slope and bend (n,) each, at angles (n,), rad, of any turn."""
        advance, slope, bend = self.rollers.turning.moved(theta)
        return advance + self.rollers.intent.pitch * np.floor(theta / TURN), slope, bend

    def enclosure(self, lower: Array, upper: Array, order: int) -> tuple[Array, Array]:
        """Balls mid +- rad (order + 1, n) of the advance and its derivatives between angles (n,) of one turn each."""
        turn = np.floor(0.5 * (lower + upper) / TURN)
        first, last = (np.clip(each - TURN * turn, 0.0, TURN) for each in (lower, upper))
        mid, rad = self.rollers.intent.law.enclosure(first, last, order)
        mid = mid.copy()
        mid[0] += self.rollers.intent.pitch * turn
        return mid, rad

    def repeats(self, turns: int) -> bool:
        """A roller is in the same place after no turn alone."""
        return turns == 0


@dataclass(frozen=True, eq=False)
class _Track:
    """A flank, and the roller that leaves it on its way through the cam (`kin.turned.cutters.Track`)."""

    rollers: Rollers
    side: Side

    @property
    def radius(self) -> float:
        """Radius of the flank's gauge, mm."""
        return self.rollers.intent.radius(self.side)

    @property
    def inner(self) -> float:
        """Where the roller begins, mm from the cam's axis."""
        return self.rollers.intent.inner

    @property
    def outer(self) -> float:
        """Radius of the blank, mm."""
        return self.rollers.intent.form.radius

    @property
    def floor(self) -> float:
        """Radius of the floor, mm."""
        return self.rollers.intent.form.radius - self.rollers.intent.form.depth

    @property
    def spread(self) -> float:
        """A roller is a cylinder."""
        return 0.0

    @property
    def ends(self) -> tuple[float, float]:
        """The cam's faces, with a margin."""
        margin = MARGIN * self.radius
        return -margin, self.rollers.intent.length + margin

    @cached_property
    def led(self) -> Swing:
        """The turret."""
        return self.rollers.intent.form.guide(self.rollers.intent.height, self.rollers.intent.start)

    @cached_property
    def lifts(self) -> _Way:
        """How it turns."""
        return _Way(self.rollers)

    @cached_property
    def reach(self) -> float:
        """Distance of the roller from the plane of the cam's axis and its direction at most, mm."""
        low, high = (np.array([self.lifts.at(np.array([end]))[0][0]]) for end in self.lifts.span)
        return float(np.abs(self.led.enclosed(low, high)[0]).max()) + self.radius

    def size(self, along: Along) -> Along:
        """Radius of the roller, mm, at any place."""
        return self.radius + 0.0 * along

    def axis(self, theta: Array) -> Array:
        """Height of the roller's axis over the lower face, mm (n,), at shaft angles (n,), rad."""
        return self.led.axis(*self.lifts.at(theta)).z

    def leaning(self, axis: Axis[Array], along: Array) -> tuple[Array, Array, Array]:
        """Sine and cosine of the contact's angle, whose tangent is z'/(rho + y'), and the root of both squared, mm."""
        ahead = along + axis.y1
        h = np.hypot(ahead, axis.z1)
        return axis.z1 / h, ahead / h, h


@dataclass(frozen=True, eq=False)
class _Judged:
    """A program being judged, not mirrored."""

    rollers: Rollers
    cutting: Cutting
    limits: Limits

    @cached_property
    def slack(self) -> float:
        """Rounding of the judge, mm."""
        return ROUNDING * (self.rollers.intent.form.radius + self.rollers.intent.length)

    def _homed(self, one: Pass) -> Pass:
        """A pass turned on by whole turns of the barrel, so that it goes along the roller that begins at `start`.

        Such turns cut the same: a program may begin at any of them, or go on with the next one at each depth.
        """
        k = int(np.abs(one.x - self.rollers.intent.height).argmin())
        pitches = self._rollers_on(np.array([[one.x[k], one.y[k], one.a[k]]]))[0]
        return replace(one, a=one.a + TURN * pitches) if pitches else one

    def _rollers_on(self, places: Array) -> Array:
        """By how many pitches (n,) the roller nearest to places X, Y, A (n, 3), mm and rad, is ahead of the first."""
        intent = self.rollers.intent
        u, v = intent.form.plane(places[:, 0], places[:, 1], places[:, 0] - intent.height)
        psi = intent.start + _Way(self.rollers).at(places[:, 2])[0]
        return np.asarray(np.round((np.arctan2(v, u) - psi) / intent.pitch))

    def verdict(self, program: TurnedProgram, passes: list[Pass]) -> TurnedVerdict:
        """All checks, the flanks, and the play between them."""
        intent, cutting, tolerance = self.rollers.intent, self.cutting, self.limits.tolerance
        passes = [self._homed(one) for one in passes]
        first, last = _Way(self.rollers).span
        work = Work(
            intent.form.radius, intent.form.radius - intent.form.depth, TURN * math.ceil((last - first) / TURN + 2)
        )
        checks = [cutter_check(program, cutting), rapid_check(program, work)]
        unseen = failed(CONTOUR, "the program cuts nothing", unit="mm", limit=tolerance)
        flanks: list[FlankVerdict] = []
        play = None
        try:
            checks += [self._ways(program, passes), feed_check(program, work, cutting)]
            if not passes:
                return TurnedVerdict("gcode", (*checks, unseen), units=program.units_mm)
            checks.append(depth_check(program, passes, work, cutting, tolerance))
            if not all(check.ok for check in checks[1:3]):
                unseen = replace(unseen, detail="what is left is not looked at on such ways")
                return TurnedVerdict("gcode", (*checks, unseen), units=program.units_mm)
            checks.append(cleared_check(passes, work, cutting.radius))
            seen = []
            for name, side in SIDES.items():
                flank, own, found = self._flank(name, _Track(self.rollers, side), passes)
                flanks.append(flank)
                checks += [replace(check, surface=name) for check in found]
                seen += [] if own is None else [own]
            if len(seen) == len(SIDES):
                play, check = play_of(self.rollers, self.limits, self.slack, (seen[0], seen[1]))
                checks.append(check)
        except UnsettledError as error:
            checks.append(failed(CONTOUR, str(error), unit="mm", limit=tolerance))
        return TurnedVerdict("gcode", tuple(checks), tuple(flanks), play, program.units_mm)

    def _flank(self, name: str, track: _Track, passes: list[Pass]) -> tuple[FlankVerdict, Held | None, list[Check]]:
        """Verdict on a flank by what the cutter leaves of it, what that holds, and its checks."""
        tolerance, cutter = self.limits.tolerance, self.cutting.radius

        def unknown(why: str) -> tuple[FlankVerdict, None, list[Check]]:
            return FlankVerdict(name), None, [failed(CONTOUR, why, unit="mm", limit=tolerance)]

        left = left_on(track, passes, cutter, COARSE * tolerance)
        if left is None or _Seen.of(track, left).worst <= FAR * tolerance:
            left = left_on(track, passes, cutter, tolerance)
        if left is None:
            return unknown("it would take too many points to tell")
        seen = _Seen.of(track, left)
        if math.isinf(seen.worst):
            k = int(np.flatnonzero((seen.asked & ~np.isfinite(left.off)).any(axis=0))[0])
            return unknown(
                f"nothing cuts as deep as the roller goes at an angle of {degrees(left.theta[k]):.6g} degrees"
            )
        check, worst = contour_check(*seen.peaks, tolerance, self.slack)
        holds, pushed = seen.held()
        if not np.isfinite(holds.between).all():
            angle = degrees(int(np.argmin(np.isfinite(holds.between))) * TURN / ANGLES)
            return unknown(f"the turret touches nothing at an angle of {angle:.6g} degrees")
        motion = replace(motion_error(holds, pushed), extremes="sampled")
        cost = by_error(self.rollers, track.side)
        checks = [check, motion_check(self.rollers, motion, self.limits, self.slack, cost)]
        return FlankVerdict(name, motion, worst), holds, checks

    def _ways(self, program: TurnedProgram, passes: Sequence[Pass]) -> Check:
        """Check that the cutter goes down at rest, turns one way, and is beside the cam or within the track."""
        intent, cutter, tolerance = self.rollers.intent, self.cutting.radius, self.limits.tolerance
        low = [move for move in program.moves if min(move.start.z, move.end.z) < intent.form.radius]
        bad = astray(program, passes, intent.form.radius)
        if not low:
            return count_check("ways", bad)
        starts = np.array([(*move.start[:2], move.start.a) for move in low])
        lasts = np.array([(*move.end[:2], move.end.a) for move in low])
        slope, curve = self.rollers.turning.fastest
        bends = intent.form.lever * (curve + slope**2)
        longest = min(LONGEST, math.sqrt(8.0 * NEAR * tolerance / max(float(bends.max()), 1e-9)))
        turned = np.abs(lasts[:, 2] - starts[:, 2])
        if float(turned.sum()) / longest > MOST_PLACES:
            return failed("ways", "the cutter goes round more often than it is followed", limit=0.0)
        own, step = runs_of(np.maximum(np.ceil(turned / longest), 1.0).astype(np.intp))
        share = 1.0 / np.maximum(np.ceil(turned / longest), 1.0)[own, None]
        way = (lasts - starts)[own] * share
        one = starts[own] + step[:, None] * way
        two = one + way
        track = _Track(self.rollers, 1)
        turns = intent.pitch * self._rollers_on(0.5 * (one + two))
        far = np.zeros(len(one))
        for at in (one, two):
            advance, *rates = track.lifts.at(at[:, 2])
            axis = track.led.axis(advance + turns, *rates)
            far = np.maximum(far, np.hypot(at[:, 0] - axis.z, at[:, 1] - axis.y))
        far += NEAR * tolerance
        x = np.stack([one[:, 0], two[:, 0]])
        beside = (x.max(axis=0) <= -cutter) | (x.min(axis=0) >= intent.length + cutter)
        free = beside | (far <= float(self.rollers.radii.max()) - cutter + tolerance)
        if not free.all():
            k = int(np.argmin(free))
            away = length_words(float(far[k]), ".3g")
            bad.append(f"line {low[int(own[k])].line} stands in the metal, {away} {UNIT} from a roller's axis")
        return count_check("ways", bad)


@dataclass(frozen=True, eq=False)
class _Seen:
    """Distances of the cut metal from a flank, mm, above 0 where it stands proud, and the places that have metal.

    cells  (m - 1, n - 1) that are not wholly beyond the ends; asked (m, n) their corners
    there  (m, n) places of the metal, which may hold a roller; cost (m, n) of 1 mm there, rad
    """

    track: _Track
    left: Left
    cells: Mask
    asked: Mask
    there: Mask
    cost: Array

    @staticmethod
    def of(track: _Track, left: Left) -> _Seen:
        """Distances from a track's flank, with the metal there and what it costs the turret."""
        intent, way, rho = track.rollers.intent, track.lifts.at(left.theta), left.rho[:, None]
        axis = track.led.axis(*way)
        _, cosine, _ = track.leaning(axis, rho)
        cells = cells_within(axis.z + track.side * track.radius * cosine, track.ends)
        turret = intent.start + way[0], way[1]
        cost, depth, height = intent.form.costs(rho, turret, track.side * track.radius)
        there = (height >= intent.ends[0]) & (height <= intent.ends[1]) & (depth >= 0.0) & (rho <= intent.outer)
        return _Seen(track, left, cells, corners_of(cells), there, cost)

    @cached_property
    def worst(self) -> float:
        """Greatest error found, mm."""
        return float(np.abs(self.left.off[self.asked]).max())

    @cached_property
    def peaks(self) -> tuple[Peak, Peak]:
        """How far the surface stands out of the metal, and into it, mm."""
        return self._peak(1.0, self.left.above), self._peak(-1.0, self.left.below)

    def _peak(self, sign: float, bound: Array) -> Peak:
        off = np.where(self.asked, sign * self.left.off, -np.inf)
        k = int(off.argmax())
        value = float(off.ravel()[k])
        more = float((sign * bound[self.cells]).max()) - value
        return Peak(value, max(more, 0.0), float(self.left.theta[k % len(self.left.theta)]))

    def held(self) -> tuple[Held, Peak]:
        """Errors of the turret, rad, over a turn by all rollers in the cam, and how far metal pushes it at most."""
        theta, track = self.left.theta, self.track
        play = track.radius - track.rollers.intent.roller
        at, own = (np.where(self.there, off * self.cost, -np.inf) for off in (self.left.off, self.left.off - play))
        cells = self.there[1:, 1:] & self.there[1:, :-1] & self.there[:-1, 1:] & self.there[:-1, :-1]
        corners = self.cost[1:, 1:], self.cost[1:, :-1], self.cost[:-1, 1:], self.cost[:-1, :-1]
        dear, cheap = np.maximum.reduce(corners), np.minimum.reduce(corners)
        below, above = self.left.below, self.left.above
        between = np.where(cells, below * np.where(below < 0.0, dear, cheap), -np.inf)
        pushes = np.where(self.cells, above * np.where(above > 0.0, dear, cheap), -np.inf)
        grid = np.arange(ANGLES) * np.float64(TURN / ANGLES)
        rows = [np.full(ANGLES, -np.inf) for _ in range(3)]
        for turn in range(math.floor(theta[0] / TURN), math.ceil(theta[-1] / TURN) + 1):
            angles = grid + TURN * turn
            inside = (angles >= theta[0]) & (angles < theta[-1])
            cell = np.searchsorted(theta, angles[inside], side="right") - 1
            nearest = cell + (angles[inside] - theta[cell] > theta[cell + 1] - angles[inside])
            best = at.max(axis=0)[nearest], between.max(axis=0)[cell], own.max(axis=0)[nearest]
            for row, values in zip(rows, best, strict=True):
                row[inside] = np.maximum(row[inside], values)
        k = int(at.max(axis=0).argmax())
        pushed = Peak(float(at[:, k].max()), 0.0, float(theta[k]))
        return Held(*rows), pushed._replace(remainder=max(0.0, float(pushes.max()) - pushed.value))
