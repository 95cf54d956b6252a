"""The verdict on a program of a machine with a rotary axis: what its cutter leaves of a drum, and how it goes there.

The cutter's path is what the control makes of the blocks: all axes move evenly between them. The metal is what no
position of the cutter takes away, held against the exact flanks over all shaft angles, from the roller's inner end to
the blank (`kin.turned.cutters`), over all turns after which the motion repeats. A flank that is shortened by
undercut, or has corners, is judged by the path alone: a cutter as large as the roller leaves what the rollers leave,
but for the error of its own path.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kin.cylindrical.gauge import gauges_of
from kin.cylindrical.intent import Groove
from kin.cylindrical.judge import Judged, motion_check
from kin.law.motion_error import MotionError
from kin.numeric.check import ROUNDING, Check, at_most, failed
from kin.numeric.errors import UnsettledError
from kin.numeric.lengths import UNIT, length_words
from kin.numeric.records import replace
from kin.read.checks import count_check
from kin.turned.checks import Work, astray, cleared_check, cutter_check, depth_check, feed_check, rapid_check
from kin.turned.cutters import END, finest_on, left_on
from kin.turned.files import verify_moves
from kin.turned.verdict import CONTOUR, FlankVerdict, TurnedVerdict, assured

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from kin.cylindrical.intent import DrumIntent
    from kin.cylindrical.lifts import Lifts
    from kin.cylindrical.roller import Gauge
    from kin.numeric.arrays import Array, Indices
    from kin.numeric.limits import Limits
    from kin.turned.checks import Cutting
    from kin.turned.cutters import Left
    from kin.turned.moves import Pass, TurnedProgram

SAME = 1e-9  # mm: sizes that differ by less are one
LEAN = 1e-2  # by which the slope of a flank may be more between two angles
COARSE, FAR = 20.0, 3.0  # times the tolerance: what a first look is good for, and what is refused at it
PATH = 0.02  # of the tolerance, by which a path may stray between two places that are looked at


class _Path(NamedTuple):
    """How far a pass is off the path of a roller's axis, along the drum: least and greatest, mm, and where, rad.

    `beside` is how far it is off across the axis at most; `remainder` by how much all may be exceeded, mm.
    """

    least: float
    least_at: float
    most: float
    most_at: float
    beside: float
    remainder: float = 0.0


def verify_program(path: Path, drum: DrumIntent, cutting: Cutting, limits: Limits) -> TurnedVerdict:
    """Judge a program by what its cutter leaves; raises OSError where the disk refuses."""

    def judge(program: TurnedProgram, passes: list[Pass]) -> TurnedVerdict:
        checks, flanks = judged_passes(program, passes, drum, cutting, limits)
        return TurnedVerdict("gcode", tuple(checks), tuple(flanks), units=program.units_mm)

    return verify_moves(path, drum.radius, judge, mirrored=drum.mirrored)


def judged_passes(
    program: TurnedProgram, passes: list[Pass], drum: DrumIntent, cutting: Cutting, limits: Limits
) -> tuple[list[Check], list[FlankVerdict]]:
    """Checks of a program, not mirrored, and verdicts on the flanks that its passes leave."""
    work = Work(drum.radius, drum.floor, gauges_of(drum)[0].lifts.period)
    checks = [
        cutter_check(program, cutting),
        rapid_check(program, work),
        _ways(program, passes, drum),
        feed_check(program, work, cutting),
    ]
    if not passes:
        return [*checks, failed(CONTOUR, "the program cuts nothing", unit="mm", limit=limits.tolerance)], []
    checks.append(depth_check(program, passes, work, cutting, limits.tolerance))
    if not all(check.ok for check in checks[1:3]):
        unseen = failed(CONTOUR, "what is left is not looked at on such ways", unit="mm", limit=limits.tolerance)
        return [*checks, unseen], []
    if isinstance(drum.track, Groove):
        checks.append(cleared_check(passes, work, cutting.radius))
    flanks = []
    try:
        job = Judged(gauges_of(drum), drum, limits, ROUNDING * (drum.radius + drum.length))
        for gauge in job.gauges:
            flank, own = _flank(job, gauge, passes, cutting)
            flanks.append(flank)
            checks += [replace(check, surface=gauge.name) for check in own]
    except UnsettledError as error:
        checks.append(failed(CONTOUR, str(error), unit="mm", limit=limits.tolerance))
    return checks, flanks


def finest_told(drum: DrumIntent, cutting: Cutting) -> float:
    """Least tolerance, mm, to which `verify_program` tells what a cutter leaves; 0 where its path alone is judged."""
    gauges = [gauge for gauge in gauges_of(drum) if not (drum.shortened or len(gauge.lifts.corners))]
    wholes = [replace(gauge, outer=drum.radius) for gauge in gauges]
    return max((finest_on(gauge, cutting.radius, cutting.growth) for gauge in wholes), default=0.0)


# --- what is left -----------------------------------------------------------------------------------------------------


def _flank(job: Judged, gauge: Gauge, passes: list[Pass], cutting: Cutting) -> tuple[FlankVerdict, list[Check]]:
    """Verdict on a flank by what the cutter leaves of it, and its checks."""
    drum, tolerance = job.drum, job.limits.tolerance

    def unknown(why: str) -> tuple[FlankVerdict, list[Check]]:
        return FlankVerdict(gauge.name), [failed(CONTOUR, why, unit="mm", limit=tolerance)]

    gauge.demand_bounded()
    deepest = min(one.z for one in passes)
    beyond = [_beyond(cutting, gauge, rho, deepest) for rho in (gauge.inner, drum.radius)]
    if max(beyond) > max(tolerance * gauge.spread, SAME):
        across = f"{length_words(2.0 * cutting.radius, '.9g')} {UNIT} across{' at its end' if cutting.taper else ''}"
        return unknown(f"a cutter {across} is wider than the roller")
    if drum.shortened or len(gauge.lifts.corners):
        if max(abs(each) for each in beyond) > max(tolerance * gauge.spread, SAME):
            return unknown(
                "of a flank with a cut or a corner, what a cutter smaller than the roller leaves is not known"
            )
        return _by_path(job, gauge, passes, cutting)
    whole = replace(gauge, outer=drum.radius)
    left = left_on(whole, passes, cutting.radius, COARSE * tolerance, cutting.growth)
    if left is None or _extremes(left)[0] <= FAR * tolerance:
        left = left_on(whole, passes, cutting.radius, tolerance, cutting.growth)
    if left is None:
        return unknown("it would take too many points to tell")
    if not np.isfinite(left.off).all():
        k = int(np.flatnonzero(~np.isfinite(left.off).all(axis=0))[0])
        return unknown(f"nothing cuts as deep as the roller goes at an angle of {_angle(left.theta[k]):.6g} degrees")
    worst, at, remainder = _extremes(left)
    most, least = max(float(left.off.max()), 0.0), max(-float(left.off.min()), 0.0)
    words = f"{length_words(most, '.3g')} {UNIT} left and {length_words(least, '.3g')} {UNIT} too deep"
    detail = f"{words}; true within {length_words(remainder, '.2g')} {UNIT}"
    value = assured(worst, remainder, tolerance)
    check = replace(at_most(CONTOUR, value, tolerance, "mm", detail=detail, slack=job.slack), at=_angle(at))
    motion = _motion(gauge, left).scaled(job.per_mm, job.unit)
    return FlankVerdict(gauge.name, motion, worst), [
        check,
        motion_check(job, motion, gauge),
    ]


def _angle(theta: float) -> float:
    """Degrees of a shaft angle, rad, over all turns."""
    return math.degrees(float(theta))


def _extremes(left: Left) -> tuple[float, float, float]:
    """Greatest error found, mm, its angle, rad, and by how much one between the points may exceed it, mm."""
    error = np.abs(left.off)
    k = int(np.argmax(error)) % len(left.theta)
    worst = float(error.max())
    bound = max(float(left.above.max()), -float(left.below.min()))
    return worst, float(left.theta[k]), max(bound - worst, 0.0)


def _motion(gauge: Gauge, left: Left) -> MotionError:
    """Error of the roller on what is left, mm: it stands where that holds it highest along its length."""
    rows = max(int(np.searchsorted(left.rho, gauge.outer, side="right")), 2)
    lean = 1.0 / upright_at(gauge, left.theta, left.rho[:rows, None])
    held = (left.off[:rows] * lean).max(axis=0)
    steep = np.maximum(lean[:-1, 1:], lean[:-1, :-1]) * (1.0 + LEAN)
    above, below = left.above[: rows - 1], left.below[: rows - 1]
    most = float(np.where(above > 0.0, above * steep, above).max())
    least = float(np.where(below < 0.0, below * steep, below).max(axis=0).min())
    k = int(np.argmax(np.abs(held)))
    worst = float(abs(held[k]))
    share = 0.5 * (np.append(np.diff(left.theta), 0.0) + np.append(0.0, np.diff(left.theta))) / gauge.lifts.period
    rms, rest = float(np.sqrt((share * held**2).sum())), max(most - worst, -least - worst, 0.0)
    return MotionError(worst, _angle(left.theta[k]), rest, float(held.min()), float(held.max()), rms, "mm")


def upright_at(gauge: Gauge, theta: Array, rho: Array) -> Array:
    """Cosine of the angle between the flank's normal and the roller's path, at angles and places along it."""
    rows = gauge.lifts.at(theta)
    axis, way = gauge.led.axis(*rows), gauge.led.axis(rows[0], np.ones_like(theta), np.zeros_like(theta))
    sine, cosine, _ = gauge.leaning(axis, rho)
    upright: Array = (cosine * way.z1 - sine * way.y1) / (gauge.lever * math.hypot(1.0, gauge.spread))
    return upright


def _by_path(job: Judged, gauge: Gauge, passes: list[Pass], cutting: Cutting) -> tuple[FlankVerdict, list[Check]]:
    """A flank by the paths of cutters as large as its roller: what they cut is off by no more than they are."""
    drum, tolerance = job.drum, job.limits.tolerance
    own = [one for one in passes if _is_about(one, gauge)]
    whole = [one for one in own if one.z <= gauge.inner + END and float(np.ptp(one.a)) >= gauge.lifts.period - SAME]
    if not whole:
        why = "no pass as deep as the roller goes right round"
        return FlankVerdict(gauge.name), [failed(CONTOUR, why, unit="mm", limit=tolerance)]
    off = [path_off(one, gauge, PATH * tolerance) for one in own]
    beside, remainder = max(each.beside for each in off), max(each.remainder for each in off)
    # a cutter whose cone lies elsewhere than the roller's is smaller, or larger
    beyond = max(abs(_beyond(cutting, gauge, rho, one.z)) for one in whole for rho in (gauge.inner, drum.radius))
    errors = [(-each.least, each.least_at) for each in off] + [(each.most, each.most_at) for each in off]
    worst, at = max(errors)
    detail = f"by its path, which is off by {length_words(worst, '.3g')} {UNIT} along the drum"
    most = math.hypot(worst, beside) + remainder + beyond
    check = replace(at_most(CONTOUR, most, tolerance, "mm", detail=detail, slack=job.slack), at=_angle(at))
    least, most = min(each.least for each in off), max(each.most for each in off)
    least, most = (least, most) if gauge.side < 0 else (-most, -least)
    # what is off across the roller's path, or too wide, moves it by no more than a flank that is off by as much
    by_flank = gauge.by_error(beside + remainder + beyond) if beside + remainder + beyond else 0.0
    rms = max(abs(least), abs(most))
    motion = MotionError(worst, _angle(at), by_flank, least, most, rms, "mm").scaled(job.per_mm, job.unit)
    return FlankVerdict(gauge.name, motion, worst), [
        check,
        motion_check(job, motion, gauge),
    ]


def _is_about(one: Pass, gauge: Gauge) -> bool:
    """Whether a pass follows the roller of a flank, and not that of the other."""
    return abs(float(np.mean(one.x - gauge.axis(one.a)))) < gauge.radius


def path_off(one: Pass, gauge: Gauge, near: float) -> _Path:
    """How far a pass is off the path of a roller's axis: exactly along a slide, else within `near`, mm."""
    if not gauge.led.bend:
        found, aside = off_path(one, gauge.lifts, gauge.level), gauge.led.axis(*gauge.lifts.at(one.a)).y
        return found._replace(beside=float(np.abs(one.y - aside).max()))
    # an arc bends by s'' T + k s'^2 E; between places so near to one another a chord is off by no more than that
    slope = gauge.lever * gauge.lifts.steepest
    bend = gauge.lever * max(float(np.abs(each[2]).max()) for each in gauge.lifts.enclosed) + gauge.led.bend * slope**2
    step = math.sqrt(8.0 * near / max(bend, SAME))
    a, x, y = (row if one.a[-1] >= one.a[0] else row[::-1] for row in (one.a, one.x, one.y))
    knots = np.mod(gauge.lifts.law.breaks, gauge.lifts.period)
    knots = np.concatenate([knots + gauge.lifts.period * turn for turn in _turns_of(one, gauge.lifts)])
    at = np.unique(np.concatenate([np.arange(a[0], a[-1], step), a, knots[(knots > a[0]) & (knots < a[-1])]]))
    axis = gauge.led.axis(*gauge.lifts.at(at))
    off, beside = np.interp(at, a, x) - axis.z, np.abs(np.interp(at, a, y) - axis.y)
    least, most = int(np.argmin(off)), int(np.argmax(off))
    return _Path(float(off[least]), float(at[least]), float(off[most]), float(at[most]), float(beside.max()), near)


def _turns_of(one: Pass, lifts: Lifts) -> Indices:
    """Numbers of the periods that a pass goes through."""
    return np.arange(math.floor(float(one.a.min()) / lifts.period), math.ceil(float(one.a.max()) / lifts.period) + 1)


def off_path(one: Pass, lifts: Lifts, level: float) -> _Path:
    """How far a pass is off the path level + S(theta) along the drum, between all of its points; both are cubics."""
    knots = (lifts.nodes[:-1] + lifts.period * _turns_of(one, lifts)[:, None]).ravel()
    knots = knots[(knots > one.a.min()) & (knots < one.a.max())]
    a, x = (one.a, one.x) if one.a[-1] >= one.a[0] else (one.a[::-1], one.x[::-1])
    at = np.unique(np.concatenate([a, knots]))
    # places where the difference may be greatest: ends of the pieces, and where it is flat within them
    low, width = at[:-1], np.diff(at)
    middle = low + 0.5 * width
    _, slope, bend = lifts.at(middle)
    after, before = lifts.at(middle + 0.25 * width)[2], lifts.at(middle - 0.25 * width)[2]
    third = (after - before) / (0.5 * width)
    rise = (np.interp(at[1:], a, x) - np.interp(low, a, x)) / width
    # slope + bend t + third t^2/2 = rise, t from the middle
    c, root = slope - rise, np.sqrt(np.maximum(bend**2 - 2.0 * third * (slope - rise), 0.0))
    q = -(bend + np.where(bend < 0.0, -root, root))
    with np.errstate(divide="ignore", invalid="ignore"):
        flat = [np.where(np.isfinite(t), t, 0.0) for t in (2.0 * c / q, q / third)]
    inside = [middle + np.clip(t, -0.5 * width, 0.5 * width) for t in flat]
    looked = np.concatenate([at, *inside])
    off = np.interp(looked, a, x) - level - lifts.at(looked)[0]
    # where X moves while the drum stands, both of its ends count
    ends = one.x - level - lifts.at(one.a)[0]
    looked, off = np.concatenate([looked, one.a]), np.concatenate([off, ends])
    least, most = int(np.argmin(off)), int(np.argmax(off))
    beside = float(np.abs(one.y).max())
    return _Path(float(off[least]), float(looked[least]), float(off[most]), float(looked[most]), beside)


def _beyond(cutting: Cutting, gauge: Gauge, rho: float, end: float) -> float:
    """By how much the cutter is larger than a roller at a place rho, its end at another, mm."""
    return cutting.radius + (rho - end) * cutting.growth - gauge.size(rho)


def _ways(program: TurnedProgram, passes: Sequence[Pass], drum: DrumIntent) -> Check:
    """Check that the cutter stays out of the metal, goes down at rest, and that a pass turns the drum one way."""
    low = [move for move in program.moves if min(move.start.z, move.end.z) < drum.radius]
    bad = astray(program, passes, drum.radius)
    ends = np.array([(*move.start, *move.end) for move in low]).reshape(-1, 4)
    deep = np.maximum(ends[:, 2], drum.floor)
    within = [gauge.size(deep) - gauge.side * (ends[:, 0] - gauge.axis(ends[:, 3])) > 0.0 for gauge in gauges_of(drum)]
    free = np.any(within, axis=0) if drum.track.distance else np.all(within, axis=0)
    if not free.all():
        bad.append(f"line {low[int(np.argmin(free)) // 2].line} stands in the metal")
    return count_check("ways", bad)
