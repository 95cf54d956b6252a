"""Developments: lines of a drawing laid round a cylinder, and a roller set down on them there.

A straight line of the drawing becomes a helix. Along it, in its polar angle, F of `kin.cylindrical.roller` bends by no
more than r^2 R^2/(R^2 - y^2)^(3/2), and in the shaft angle it is concave about its greatest value, so that points close
to one another settle both what stands out and what holds the roller. A development says nothing of any other radius.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kin.cylindrical.crossings import Crossings
from kin.cylindrical.gauge import gauges_of
from kin.cylindrical.lifts import Lifts
from kin.law.motion_error import MotionError
from kin.numeric.angles import TURN
from kin.numeric.arrays import runs_of
from kin.numeric.check import ROUNDING, Check, at_most, failed
from kin.numeric.errors import UnsettledError
from kin.numeric.lengths import UNIT, length_words
from kin.numeric.limits import limit_of
from kin.numeric.records import replace
from kin.turned.verdict import CONTOUR, MOTION, FlankVerdict

if TYPE_CHECKING:
    from kin.cylindrical.intent import DrumIntent
    from kin.cylindrical.roller import Gauge
    from kin.numeric.arrays import Array
    from kin.numeric.limits import Limits
    from kin.turned.files import Developed

FINE = 0.05  # of the tolerance, within which what lies between points is known
LOOSE = 2.0 * FINE  # of the tolerance: what is known less well counts in full
MOST = 400_000  # points of a line
GAP = 1e-6  # of the radius: ends of lines that are so close meet
SLACK = 1e-6  # of a limit that follows from the steepest slope
TURNED = 4096  # angles of a turn, at which it is looked how fast an axis on an arm goes aside
MEETINGS = 40  # steps to the angle at which an axis on an arm meets a cylinder


class _Line(NamedTuple):
    """Points of a line round its cylinder (n,) each: polar angle, rad, height, mm; `joined` (n - 1,) to the next."""

    phi: Array
    z: Array
    joined: Array


class _Measured(NamedTuple):
    """What a line shows: its distance in the drawing, mm, at a shaft angle, rad, and the motion on it.

    The motion is in the follower's unit, of which a line that is off by 1 mm costs `steep` at most.
    """

    off: float
    at: float
    remainder: float
    motion: MotionError
    steep: float


def judged_line(
    parts: list[Array], drum: DrumIntent, line: Developed, limits: Limits
) -> tuple[FlankVerdict, list[Check]]:
    """Verdict on one line, in mm and as if not mirrored, and its checks."""
    tolerance, alone = limits.tolerance, f"at a radius of {length_words(line.radius)} {UNIT} alone"
    if not parts:
        missing = failed(CONTOUR, f"nothing is drawn on the layer {line.layer}", unit="mm", limit=tolerance)
        return FlankVerdict(line.flank), [missing]
    short = _missing(parts, drum, line, tolerance)
    if short is not None:
        why = f"the line is missing at x = {length_words(short)} {UNIT}: it does not go round"
        return FlankVerdict(line.flank), [failed(CONTOUR, why, unit="mm", limit=tolerance)]
    if line.flank == "pitch":
        lifts, gauge = Lifts(drum.follower.law, drum.follower.turns), None
        try:
            found = _measured_pitch(parts, drum, line.radius, tolerance)
        except UnsettledError as error:
            return FlankVerdict(line.flank), [failed(CONTOUR, str(error), unit="mm", limit=tolerance)]
    else:
        gauge = _gauge(drum, line)
        lifts = gauge.lifts
        bend = gauge.line_bend(line.radius, _climb(parts, line.radius))
        step = math.sqrt(8.0 * FINE * tolerance / (bend + gauge.lever * float(lifts.bends(-gauge.side).max())))
        found = _measured_flank(_laid(parts, line.radius, step), drum, gauge, line.radius, bend)
    slack = ROUNDING * max(float(np.abs(part).max()) for part in parts)
    sure = f"true within {length_words(found.remainder, '.2g')} {UNIT}"
    # lines that ask for more points than are looked at leave more open, which counts
    loose = found.remainder > LOOSE * tolerance
    off = found.off + found.remainder if loose else found.off
    check = at_most(CONTOUR, off, tolerance, "mm", detail=f"{alone}; {sure}", slack=slack)
    checks = [replace(check, at=lifts.degrees(found.at))]
    follower = drum.follower
    given = None if limits.motion is None else follower.in_unit(limits.motion)
    steep = found.steep * (1.0 + SLACK)
    limit, room = limit_of(lambda e: e * steep, given, tolerance, slack)
    if not drum.shortened or gauge is None:  # what an undercut loses at one radius, another carries
        most = found.motion.bound if loose else found.motion.max
        check = at_most(MOTION, most, limit, follower.unit, detail=alone, slack=room)
        checks.append(replace(check, at=found.motion.at))
    return FlankVerdict(line.flank, found.motion, found.off), checks


def _climb(parts: list[Array], radius: float) -> float:
    """How fast the lines rise or fall at most, mm per rad round a cylinder."""
    steps = [np.abs(np.diff(part, axis=0)) for part in parts]
    rates = [float((step[:, 1] / np.maximum(step[:, 0], GAP * radius)).max(initial=0.0)) for step in steps]
    return radius * max(rates)


def _gauge(drum: DrumIntent, line: Developed) -> Gauge:
    """The gauge of a line's flank."""
    (gauge,) = (one for one in gauges_of(drum) if one.name == line.flank)
    return gauge


def _missing(parts: list[Array], drum: DrumIntent, line: Developed, tolerance: float) -> float | None:
    """A place x, mm, at which no line is drawn and one should be; None where there is none.

    A flank need not be drawn where another turn of the groove has taken it.
    """
    period = drum.follower.period
    bare = _uncovered(parts, line.radius, period * line.radius)
    if not bare or drum.follower.turns == 1 or line.flank == "pitch":
        return bare[0][0] if bare else None
    phi = Crossings(drum, gauges_of(drum), tolerance).standing(_gauge(drum, line), line.radius)
    for low, high in bare:
        ahead = np.remainder(phi - low / line.radius, period) * line.radius
        if (ahead < high - low).any():
            return low + float(ahead.min())
    return None


def _uncovered(parts: list[Array], radius: float, whole: float) -> list[tuple[float, float]]:
    """Stretches of x, mm, of the period, so long as a whole, mm, that no line covers."""
    gap = GAP * radius
    spans = sorted((float(part[:, 0].min()), float(part[:, 0].max())) for part in parts)
    end = spans[0][0] + whole
    reached, bare = spans[0][1], []
    for low, high in [*spans, (end, end)]:
        if low > reached + gap and reached < end:
            bare.append((reached, min(low, end)))
        reached = max(reached, high)
    return bare


def _laid(parts: list[Array], radius: float, step: float) -> _Line:
    """Points of the lines round their cylinder, none farther from the next along a line than a step, rad."""
    phi: list[Array] = []
    z: list[Array] = []
    joined = []
    length = sum(float(np.abs(np.diff(part[:, 0])).sum()) for part in parts) / radius
    step = max(step, length / MOST)
    for part in parts:
        angle, height = part[:, 0] / radius, part[:, 1]
        count = np.maximum(np.ceil(np.abs(np.diff(angle)) / step), 1.0).astype(np.intp)
        own, step_of = runs_of(count)
        share = step_of / count[own]
        for rows, values in ((phi, angle), (z, height)):
            rows.append(np.append(values[own] + share * np.diff(values)[own], values[-1]))
        joined.append(np.append(np.ones(len(own), dtype=np.bool_), False))
    return _Line(np.concatenate(phi), np.concatenate(z), np.concatenate(joined)[:-1])


def _measured_pitch(parts: list[Array], drum: DrumIntent, radius: float, tolerance: float) -> _Measured:
    """The path on which the roller's axis meets the cylinder: its height tells the position itself."""
    follower, lifts = drum.follower, Lifts(drum.follower.law, drum.follower.turns)
    guide = follower.guide()
    bends = max(float(lifts.bends(side).max()) for side in (-1, 1))
    swung = guide.axis(*lifts.at(np.linspace(0.0, lifts.period, TURNED * lifts.turns)))
    slowest = 1.0 - float((np.abs(swung.y1) / np.sqrt(radius**2 - swung.y**2)).max())
    if not slowest > 0.0:
        raise UnsettledError("the arm takes its roller round as fast as the cylinder turns: its path is not known")
    bend = guide.lever * (bends + lifts.steepest**2 * guide.lever * guide.bend) / slowest**3
    line = _laid(parts, radius, math.sqrt(8.0 * FINE * tolerance / max(bend, 1e-3 * radius)))
    theta = line.phi
    for _ in range(MEETINGS):
        theta = line.phi - np.arcsin(guide.axis(*lifts.at(theta)).y / radius)
    lift, slope, curve = lifts.at(theta)
    axis, way = guide.axis(lift, slope, curve), guide.axis(lift, np.ones_like(lift), np.zeros_like(lift))
    along = np.sqrt(radius**2 - axis.y**2)
    climb = axis.z1 / (1.0 + axis.y1 / along)
    error = guide.above(line.z, lift)
    off = np.abs(error) / np.hypot(1.0, climb / radius)
    rate = way.z1 - climb * way.y1 / along
    error = error / rate
    room = 0.125 * bend * float((np.diff(line.phi)[line.joined] ** 2).max(initial=0.0))
    k, worst = int(np.argmax(off)), int(np.argmax(np.abs(error)))
    most, rest, rms = float(np.abs(error).max()), room / guide.lever, float(np.sqrt(np.mean(error**2)))
    motion = MotionError(
        most, lifts.degrees(float(theta[worst])), rest, float(error.min()), float(error.max()), rms, "mm"
    ).scaled(follower.in_unit(1.0), follower.unit)
    steep = (
        follower.in_unit(1.0)
        * math.hypot(1.0, guide.lever * lifts.steepest / slowest / radius)
        / float(np.abs(rate).min())
    )
    return _Measured(float(off[k]), float(theta[k]), room, motion, steep)


def _measured_flank(line: _Line, drum: DrumIntent, gauge: Gauge, radius: float, bend: float) -> _Measured:
    """A flank: how far it stands out at the worst angles of its points, and how high it holds the roller between."""
    points = np.stack([radius * np.cos(line.phi), radius * np.sin(line.phi), line.z], axis=-1)
    worst = gauge.worst(points, line.phi)
    off = gauge.off_line(worst, points, radius)
    room = 0.125 * bend * float((np.diff(line.phi)[line.joined] ** 2).max(initial=0.0))
    first, last = worst.theta[:-1][line.joined], worst.theta[1:][line.joined]
    middle = first + 0.5 * (np.remainder(last - first + math.pi, TURN) - math.pi)
    held = [gauge.stand(side, middle).gives for side in (points[:-1][line.joined], points[1:][line.joined])]
    between = np.minimum(*(np.where(np.isfinite(one), one, -np.inf) for one in held))
    k, least, most = int(np.argmax(off)), int(np.argmin(between)), int(np.argmax(worst.height))
    low, high = min(float(between[least]), float(worst.height.min())), float(worst.height[most])
    value, at = (high, float(worst.theta[most])) if high >= -low else (-low, float(middle[least]))
    rms = float(np.sqrt(np.mean(worst.height**2)))
    per_mm = drum.follower.in_unit(1.0) / gauge.lever
    motion = MotionError(value, gauge.lifts.degrees(at), room, low, high, rms, "mm").scaled(per_mm, drum.follower.unit)
    return _Measured(float(off[k]), float(worst.theta[k]), room, motion, per_mm * gauge.by_line(1.0, radius))
