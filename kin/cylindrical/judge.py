"""The verdict on a file of a cylindrical cam: whether it is the intended drum, and its roller moves as intended.

A solid is taken as it lies on disk. The way it was made is not known here: the exact flank is what rollers leave at all
angles (`kin.cylindrical.roller`), the motion is that of the roller set down on the file's own triangles. Every triangle
is measured against a face of the intended drum. Together with a closed surface and the volume that says that nothing of
the drum is missing: a closed surface all of which is near that of the drum goes round it once, if it encloses as much.
A groove of several turns is followed over all of them. It crosses itself (`kin.cylindrical.crossings`): flanks of one
turn stop where another begins, and no triangle may stand in the way of any turn. What is left between crossings is an
island; that none is missing follows from the roller, which is carried wherever an exact flank carries it.
"""

from __future__ import annotations

import math
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from kin.cylindrical.crossings import Crossings, Gap
from kin.cylindrical.edges import look
from kin.cylindrical.faces import BLANK, BORE, BOTTOM, FLOOR, TOP, Body, faces_of
from kin.cylindrical.gauge import gauges_of
from kin.cylindrical.grid import angles_for
from kin.cylindrical.lifts import degrees_over
from kin.cylindrical.roller import Worst
from kin.cylindrical.shoe import longest_shoe, shoe_interference
from kin.cylindrical.torn_edges import missing, triangles_at
from kin.cylindrical.volume import volume_within
from kin.law.motion_error import MotionError, Play
from kin.numeric.angles import degrees
from kin.numeric.check import Check, at_most, failed
from kin.numeric.errors import UnsettledError
from kin.numeric.lengths import UNIT, amount_words, length_words
from kin.numeric.limits import is_loose, limit_of, unlimited
from kin.numeric.records import dataclass, replace
from kin.turned.files import closed_mesh, face_check, rounding_of, verify_lines, verify_mesh, volume_check
from kin.turned.verdict import CONTOUR, ENDS, MOTION, PLAY, FlankVerdict, TurnedVerdict, assured, surface_check

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from pathlib import Path

    from kin.cylindrical.edges import Peak, Seen
    from kin.cylindrical.faces import Stands
    from kin.cylindrical.intent import DrumIntent
    from kin.cylindrical.roller import Gauge
    from kin.law.contacts import Unit
    from kin.numeric.arrays import Array, Mask
    from kin.numeric.limits import Limits
    from kin.read.mesh.checked import CheckedMesh
    from kin.turned.files import Developed

CROSSINGS, SHOE = "crossings", "shoe"
ROUNDED = 1e-4  # by which a length that is told is shorter, so that its digits are
SLACK = 1e-6  # of a limit that follows from the steepest slope


def verify(path: Path, drum: DrumIntent, limits: Limits, units: float | None = None) -> TurnedVerdict:
    """Judge a solid of triangles over all shaft angles; `units` and what is raised are those of `verify_mesh`."""
    return verify_mesh(path, units, lambda read, kind: judge_mesh(read, drum, limits, kind))


def verify_development(
    path: Path, drum: DrumIntent, lines: Sequence[Developed], limits: Limits, units: float | None = None
) -> TurnedVerdict:
    """Judge a development's DXF line by line, each for the radius at which it is unrolled, and for no other.

    `units` and what is raised are those of `kin.turned.files.verify_lines`.
    """
    from kin.cylindrical.development import judged_line

    def judge(parts: list[Array], line: Developed) -> tuple[FlankVerdict, list[Check]]:
        return judged_line(parts, drum, line, limits)

    return verify_lines(path, lines, drum, drum.follower.period, judge, units=units)


@dataclass(frozen=True, eq=False)
class Judged:
    """A file being judged: what it is held against, by which gauges, and the rounding of its places, `slack`, mm.

    Positions are mm along the path of the roller's axis; `per_mm` gives them in the follower's unit, mm or deg.
    """

    gauges: tuple[Gauge, ...]
    drum: DrumIntent
    limits: Limits
    slack: float

    @property
    def unit(self) -> Unit:
        """Unit of positions as they are reported."""
        return self.drum.follower.unit

    @cached_property
    def per_mm(self) -> float:
        """One mm of travel in the unit of positions."""
        return self.drum.follower.in_unit(1.0) / self.gauges[0].lever


def judge_mesh(read: CheckedMesh, drum: DrumIntent, limits: Limits, kind: str = "") -> TurnedVerdict:
    """Judge a mesh, mm, as its file has it; corners that it keeps apart by less than the tolerance are joined."""
    read, closed = closed_mesh(read, limits.tolerance)
    body, checks = Body.of(read.mesh, mirrored=drum.mirrored), [closed]
    slack, gauges = rounding_of(read, body.points), gauges_of(drum)
    verdicts, seen, play = [], [], None
    try:
        for gauge in gauges:
            gauge.demand_bounded()
        faces = faces_of(body, drum, gauges, limits.tolerance + slack)
        job = Judged(gauges, drum, limits, slack)
        checks += plain_checks(job, faces.off)
        angles = angles_for(gauges, limits.tolerance)
        crossings = Crossings(drum, gauges, limits.tolerance + slack)
        held = [crossings.carried(gauge, angles) for gauge in gauges]
        for stands, own_held in zip(faces.stands, held, strict=True):
            flank, found, own = _flank(job, stands, own_held)
            verdicts.append(flank)
            seen.append(found)
            checks += [replace(check, surface=flank.name) for check in own]
        both = [found for found, flank in zip(seen, verdicts, strict=True) if found is not None and flank.motion]
        if len(both) > 1 and np.logical_and(*held).any():
            play, check = _play(job, faces.stands, both, np.logical_and(*held))
            checks.append(check)
        checks += led_checks(crossings)
        checks.append(volume_check(read, volume_within(drum, gauges), limits.tolerance))
    except UnsettledError as error:
        checks.append(failed(CONTOUR, str(error), unit="mm", limit=limits.tolerance))
    return TurnedVerdict(kind, tuple(checks), tuple(verdicts), play, read.units_mm or 1.0, read.mesh)


def plain_checks(job: Judged, off: Mapping[str, float]) -> list[Check]:
    """Checks of blank, floor, ends and bore, by how far each is off, mm: nan of one that is not there."""
    drum, checks = job.drum, []

    def check(name: str, worst: float, detail: str) -> None:
        checks.append(face_check(name, worst, job.limits.tolerance, detail, job.slack))

    check(BLANK, off[BLANK], f"from a radius of {length_words(drum.radius)} {UNIT}")
    if FLOOR in off:
        room = f"the roller ends at {length_words(drum.follower.inner)} {UNIT}"
        check(FLOOR, off[FLOOR], f"from a radius of {length_words(drum.floor)} {UNIT}; {room}")
    ends = [name for name in (BOTTOM, TOP) if name in off]
    worst = max(off[name] for name in ends) if not any(math.isnan(off[name]) for name in ends) else math.nan
    heights = " and ".join(length_words(0.0 if name == BOTTOM else drum.length) for name in ends)
    check(ENDS, worst, f"from z = {heights} {UNIT}")
    if drum.bore is not None:
        check(BORE, off[BORE], f"from {drum.bore.name}")
    return checks


def _flank(job: Judged, stands: Stands, held: Mask) -> tuple[FlankVerdict, Seen | None, list[Check]]:
    """Verdict on one flank, to carry the roller at some angles of a grid (n,), what was seen of it, and its checks."""
    body, gauge, tolerance = stands.body, stands.gauge, job.limits.tolerance
    count = int(np.count_nonzero(stands.flank))
    if not count:
        nothing = failed(CONTOUR, "the flank is missing", unit="mm", limit=tolerance)
        return FlankVerdict(gauge.name), None, [nothing]
    edges = stands.edges()
    seen = look(gauge, edges, tolerance, len(held))
    free = stretches(held, seen.grid.width)
    bare = seen.bare
    if len(seen.torn):
        beside = triangles_at(body, stands.flank, (edges.a[seen.torn], edges.b[seen.torn]))
        bare = missing(gauge, body.points[beside], stands.worst.theta[beside], bare, tolerance)
    check, worst = contour_check(job, seen.proud, bare)
    checks = [check]
    if stands.across.any():
        where = body.points[body.corners[stands.across][0]].mean(axis=0)
        angle = degrees(math.atan2(where[1], where[0]))
        blocked = failed(
            MOTION, f"metal stands in the roller's way, about an angle of {angle:.6g} degrees", unit=job.unit
        )
        return FlankVerdict(gauge.name, None, worst, count, free), seen, [*checks, blocked]
    if not np.isfinite(seen.least[held]).all() or not held.any():
        k = int(np.argmin(np.isfinite(seen.least) | ~held)) if held.any() else 0
        angle = gauge.lifts.degrees(k * seen.grid.width)
        loose = failed(MOTION, f"the roller touches nothing at an angle of {angle:.6g} degrees", unit=job.unit)
        return FlankVerdict(gauge.name, None, worst, count, free), seen, [*checks, loose]
    motion = _motion_error(seen, held, job, gauge)
    checks.append(motion_check(job, motion, gauge, free))
    return FlankVerdict(gauge.name, motion, worst, count, free), seen, checks


def stretches(held: Mask, width: float) -> tuple[tuple[float, float], ...]:
    """Stretches, degrees, about angles of a grid with a step, rad, at which a flank is not to carry; all round once."""
    if held.all():
        return ()
    if not held.any():
        return ((0.0, math.degrees(width * len(held))),)
    first, last = np.flatnonzero(~held & np.roll(held, 1)), np.flatnonzero(~held & np.roll(held, -1))
    last = last[np.searchsorted(last, first) % len(last)]
    last = np.where(last < first, last + len(held), last)
    low, high = np.degrees((first - 0.5) * width), np.degrees((last + 0.5) * width)
    return tuple(zip(low.tolist(), high.tolist(), strict=True))


def contour_check(job: Judged, proud: Peak, bare: Peak) -> tuple[Check, float]:
    """Check of the distance of a flank's surface, mm, out of the metal and into it, and the greater distance."""
    check, worst = surface_check(proud, bare, job.limits.tolerance, job.slack)
    return placed(check, proud.at if proud.value >= bare.value else bare.at, job.drum.follower.turns), worst


def _motion_error(seen: Seen, held: Mask, job: Judged, gauge: Gauge) -> MotionError:
    """Error of the motion at the angles of the grid (n,) at which the flank is to carry the roller."""
    holds = np.where(held, seen.holds, np.inf)
    k = int(np.argmin(holds))
    least, most = float(holds[k]), seen.out.value
    bound = max(seen.out.value + seen.out.remainder, -float(seen.least[held].min()))
    worst, at = (-least, k * seen.grid.width) if -least > most else (most, seen.out.at)
    rms = float(np.sqrt(np.mean(seen.holds[held] ** 2)))
    left, place = max(bound - worst, 0.0), gauge.lifts.degrees(at)
    return MotionError(worst, place, left, least, most, rms, "mm").scaled(job.per_mm, job.unit)


def motion_check(job: Judged, motion: MotionError, gauge: Gauge, free: tuple[tuple[float, float], ...] = ()) -> Check:
    """Check of the motion on a flank, in the unit of positions, beside stretches, degrees, where it carries nothing."""
    per_mm, tolerance, given = job.per_mm, job.limits.tolerance, _given(job, job.limits.motion)
    limit, room = limit_of(lambda e: per_mm * _implied(gauge, e), given, tolerance, job.slack)
    worst = assured(motion.max, motion.remainder, per_mm * tolerance) if given is None else motion.bound
    detail = f"true within {amount_words(motion.remainder, job.unit, '.2g')}" if motion.remainder else ""
    if free:
        longest = max(high - low for low, high in free)
        beside = f"judged beside {len(free)} crossings, where nothing carries for up to {longest:.4g} degrees"
        detail = f"{detail}; {beside}" if detail else beside
    check = at_most(MOTION, worst, limit, job.unit, detail=detail, slack=room)
    check = replace(check, at=motion.at)
    stroke = job.drum.follower.in_unit(gauge.lifts.stroke)
    loose = given is None and is_loose(limit, per_mm * tolerance, lambda: stroke)
    return unlimited(check) if loose else check


def _given(job: Judged, limit: float | None) -> float | None:
    """A limit that is given, mm or rad, in the unit of positions."""
    return None if limit is None else job.drum.follower.in_unit(limit)


def _implied(gauge: Gauge, tolerance: float) -> float:
    """Greatest motion error, mm, by a flank within a tolerance, mm: at the roller's inner end, where it is steepest."""
    return gauge.by_error(tolerance) * (1.0 + SLACK)


def placed(check: Check, theta: float, turns: int = 1) -> Check:
    """The check with its shaft angle, rad, over so many turns of the motion."""
    return replace(check, at=degrees_over(theta, turns) if math.isfinite(theta) else None)


def _held(job: Judged, stands: Stands, seen: Seen) -> Array:
    """How far the drum's own roller is kept from the intended place at the angles of the grid, above 0 from the metal.

    The roller of a groove is smaller than the gauge of its upper flank, by the clearance.
    """
    radius = job.drum.follower.radius
    if stands.gauge.radius == radius:
        return seen.holds
    gauge, body = replace(stands.gauge, radius=radius), stands.body
    touched = np.flatnonzero(np.bincount(body.corners[stands.touched].ravel(), minlength=len(body.points)))
    worst = Worst(*(np.full(len(body.points), np.nan) for _ in range(4)))
    for row, values in zip(worst, gauge.worst(body.points[touched], body.phi[touched]), strict=True):
        row[touched] = values
    none = np.zeros(len(stands.touched), dtype=np.bool_)
    edges = replace(stands, gauge=gauge, worst=worst, flank=none, beside=none).edges()
    return look(gauge, edges, job.limits.tolerance, len(seen.grid)).holds


def _play(job: Judged, stands: Sequence[Stands], both: Sequence[Seen], held: Mask) -> tuple[Play, Check]:
    """Play at the angles of the grid (n,) at which both flanks are to carry the roller."""
    own = [_held(job, one, found)[held] for one, found in zip(stands, both, strict=True)]
    theta = np.flatnonzero(held) * np.float64(both[0].grid.width)
    return play_check(job, (both[0].holds + both[1].holds)[held], -(own[0] + own[1]), theta)


def play_check(job: Judged, pinched: Array, own: Array, theta: Array) -> tuple[Play, Check]:
    """Play of the follower between two flanks, and the check on that of the gauges, which should fit without any.

    `pinched` is by how much the gauges do not fit, and `own` the follower's own play (n,), mm, at angles (n,), rad.
    """
    k = int(np.argmax(np.abs(pinched)))
    own = own * job.per_mm
    least, most = int(np.argmin(own)), int(np.argmax(own))
    places = [job.gauges[0].lifts.degrees(float(theta[k])) for k in (least, most)]
    play = Play(float(own[least]), places[0], float(own[most]), places[1], job.unit)

    def implied(tolerance: float) -> float:
        return job.per_mm * sum(_implied(gauge, tolerance) for gauge in job.gauges)

    limit, room = limit_of(implied, _given(job, job.limits.play), job.limits.tolerance, job.slack)
    told = f"the follower's own play is {_between(play)}"
    if play.least < 0.0:
        told += f": it is pinched by up to {amount_words(-play.least, job.unit, '.3g')}"
    check = at_most(PLAY, job.per_mm * float(abs(pinched[k])), limit, job.unit, detail=told, slack=room)
    return play, placed(check, float(theta[k]), job.drum.follower.turns)


def led_checks(crossings: Crossings) -> list[Check]:
    """Checks of what leads the follower where its groove crosses itself, and of a shoe in bends."""
    drum, checks = crossings.drum, []
    follower = drum.follower
    if follower.turns > 1:
        ends = follower.inner, min(follower.outer, drum.radius)
        found = [gap for gauge in crossings.gauges for rho in ends for gap in crossings.gaps(gauge, rho)]
        longest = max(found, key=lambda gap: gap.length, default=Gap(0.0, 0.0, 0.0))
        if follower.shoe is None:
            told = "without a shoe the roller drops into the groove that it crosses"
        else:
            told = f"a shoe of {length_words(follower.shoe)} {UNIT}"
        told = f"the longest stretch without a wall, along the groove; {told}"
        check = at_most(CROSSINGS, longest.length, follower.shoe or 0.0, "mm", detail=told)
        checks.append(placed(check, 0.5 * (longest.low + longest.high), follower.turns))
    if follower.shoe is not None:
        interferes, at = shoe_interference(follower)
        most = length_words((1.0 - ROUNDED) * longest_shoe(follower, crossings.tolerance), ".5g")
        told = "tips beyond the walls of the sharpest bend, in the development"
        if interferes > crossings.tolerance:
            told += f"; a shoe of {most} {UNIT} is within that"
        checks.append(placed(at_most(SHOE, interferes, crossings.tolerance, "mm", detail=told), at, follower.turns))
    return checks


def _between(play: Play) -> str:
    if play.unit == "mm":
        return f"{length_words(play.least)} to {length_words(play.most)} {UNIT}"
    return f"{play.least:.6g} to {play.most:.6g} {play.unit}"
