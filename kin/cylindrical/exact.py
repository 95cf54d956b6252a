"""The verdict on a solid of exact surfaces: B-spline flanks by contact, planes and cylinders as they are.

Each face is held against that of the intended drum to which it is nearest. Together with a closed shell, whose faces
look outward, and the volume that says that nothing of the drum is missing (`kin.cylindrical.judge`). A surface of a
groove of several turns belongs to the turn and flank that it is nearest to.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from kin.contour.arcs import Arcs
from kin.contour.holes import farthest
from kin.cylindrical.crossings import Crossings
from kin.cylindrical.edges import Peak
from kin.cylindrical.faces import BLANK, BORE, BOTTOM, FLOOR, TOP
from kin.cylindrical.gauge import gauges_of
from kin.cylindrical.judge import (
    Judged,
    contour_check,
    led_checks,
    motion_check,
    plain_checks,
    play_check,
    stretches,
)
from kin.cylindrical.play import exact_play
from kin.cylindrical.smooth import BINS, Crossed, Smooth, look, off_flank
from kin.cylindrical.volume import volume_within
from kin.law.motion_error import MotionError
from kin.numeric.angles import TURN
from kin.numeric.check import ROUNDING, Check, failed
from kin.numeric.errors import UnsettledError
from kin.numeric.records import dataclass, replace
from kin.read.checks import count_check, enclosed_check
from kin.read.errors import ReadError
from kin.read.formats import format_of
from kin.read.step.faces import RoundFace
from kin.read.step.patch import Patch
from kin.turned.bore import FINE
from kin.turned.files import WATERTIGHT
from kin.turned.verdict import CONTOUR, MOTION, FlankVerdict, TurnedVerdict

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from kin.cylindrical.intent import DrumIntent
    from kin.cylindrical.roller import Gauge
    from kin.cylindrical.smooth import SeenSmooth
    from kin.numeric.arrays import Array, Mask
    from kin.numeric.limits import Limits
    from kin.read.step.faces import Face
    from kin.read.step.shell import Shell

ANGLES = 720  # at which play and the mean error are told
MIRROR = np.array([1.0, -1.0, 1.0])


@dataclass(frozen=True, eq=False)
class _Sorted:
    """Greatest distance, mm, of the faces from plain faces of a drum, by name, nan for none; surfaces by flank."""

    off: dict[str, float]
    flanks: dict[str, list[Smooth]]


def verify_surfaces(path: Path, drum: DrumIntent, limits: Limits) -> TurnedVerdict:
    """Judge a solid of exact surfaces by the suffix of its file, over all shaft angles.

    A file that is not read gets a verdict that says why. Raises OSError where the disk refuses, ValueError for a suffix
    of files without such solids.
    """
    kind = format_of(path)
    if kind.shell is None:
        raise ValueError(f"{path.name} holds no exact surfaces")
    try:
        # faces that cannot be told from what they enclose show when they are looked at
        verdict = judge_shell(kind.shell(path), drum, limits, kind.name)
    except ReadError as error:
        return TurnedVerdict.unread(path, kind.name, "solid", error)
    return verdict.about(path)


def judge_shell(shell: Shell, drum: DrumIntent, limits: Limits, kind: str = "") -> TurnedVerdict:
    """Judge a solid of exact surfaces, mm, as its file has it."""
    gauges = gauges_of(drum)
    checks = [count_check(WATERTIGHT, shell.faults(limits.tolerance))]
    verdicts, seen, play = [], [], None
    slack = ROUNDING * max(drum.radius, drum.length)
    try:
        found = _sorted(shell, drum, gauges, limits.tolerance)
        job, crossings = Judged(gauges, drum, limits, slack), Crossings(drum, gauges, limits.tolerance)
        checks += plain_checks(job, found.off)
        for gauge in gauges:
            flank, own_seen, own = _flank(job, gauge, found.flanks[gauge.name], crossings)
            verdicts.append(flank)
            seen.append(own_seen)
            checks += [replace(check, surface=flank.name) for check in own]
        both = [each for each, flank in zip(seen, verdicts, strict=True) if each is not None and flank.motion]
        if len(both) > 1 and (held := both[0].carried & both[1].carried).any():
            pinched = (both[0].holds + both[1].holds)[held]
            theta = np.flatnonzero(held) * np.float64(TURN / ANGLES)
            play, check = play_check(job, pinched, exact_play(drum, theta) - pinched, theta)
            checks.append(check)
        checks += led_checks(crossings)
        checks.append(enclosed_check((shell.volume, shell.area), volume_within(drum, gauges), limits.tolerance))
    except UnsettledError as error:
        checks.append(failed(CONTOUR, str(error), unit="mm", limit=limits.tolerance))
    return TurnedVerdict(kind, tuple(checks), tuple(verdicts), play, shell.units_mm)


def _flank(
    job: Judged, gauge: Gauge, surfaces: Sequence[Smooth], crossings: Crossings
) -> tuple[FlankVerdict, SeenSmooth | None, list[Check]]:
    """Verdict on one flank, what was seen of it, and its checks."""
    tolerance = job.limits.tolerance
    count = sum(len(surface.nets) for surface in surfaces)
    if not count:
        nothing = failed(CONTOUR, "the flank is missing", unit="mm", limit=tolerance)
        return FlankVerdict(gauge.name), None, [nothing]
    turns = gauge.lifts.turns

    def carries(radii: Array) -> Mask:
        held = crossings.carried(gauge, BINS * turns, radii)
        return held & np.roll(held, -1)

    seen = look(gauge, surfaces, tolerance, ANGLES * turns, Crossed(job.gauges, carries) if turns > 1 else None)
    check, worst = contour_check(job, seen.proud, seen.bare)
    free = stretches(seen.carried, TURN / ANGLES)
    loose = ~np.isfinite(seen.holds) & seen.carried
    if not (math.isfinite(seen.least.remainder) and seen.carried.any()) or loose.any():
        angle = gauge.lifts.degrees(int(np.argmax(loose)) * TURN / ANGLES)
        why = f"the roller touches nothing at an angle of {angle:.6g} degrees"
        return FlankVerdict(gauge.name, None, worst, count, free), seen, [check, failed(MOTION, why, unit=job.unit)]
    motion = _motion_error(seen, job, gauge)
    checks = [check, motion_check(job, motion, gauge, free)]
    return FlankVerdict(gauge.name, motion, worst, count, free), seen, checks


def _motion_error(seen: SeenSmooth, job: Judged, gauge: Gauge) -> MotionError:
    """Error of the motion where the flank is to carry the roller."""
    low, high = seen.least, seen.out
    worst = high if high.value >= -low.value else Peak(-low.value, low.at, low.remainder)
    bound = max(high.value + high.remainder, low.remainder - low.value)
    rms = float(np.sqrt(np.mean(seen.holds[seen.carried] ** 2)))
    left, place = max(bound - worst.value, 0.0), gauge.lifts.degrees(worst.at)
    return MotionError(worst.value, place, left, low.value, high.value, rms, "mm").scaled(job.per_mm, job.unit)


# --- which face is which ----------------------------------------------------------------------------------------------


def _sorted(shell: Shell, drum: DrumIntent, gauges: tuple[Gauge, ...], tolerance: float) -> _Sorted:
    """Sort the faces of a solid by those of a drum; raises UnsettledError for a drum with shortened flanks."""
    if drum.shortened:
        raise UnsettledError("a flank that an undercut shortens is judged on triangles alone: give an STL")
    names = [BLANK, BOTTOM, TOP, *([FLOOR] if drum.track.depth is not None else []), *([BORE] if drum.bore else [])]
    off = dict.fromkeys(names, math.nan)
    flanks: dict[str, list[Smooth]] = {gauge.name: [] for gauge in gauges}

    def note(name: str, value: float) -> None:
        off[name] = value if math.isnan(off[name]) else max(off[name], value)

    surfaces = [_smooth(own, mirrored=drum.mirrored) for own in _patches(shell)]
    if surfaces:
        ways = [(gauge, turn) for gauge in gauges for turn in range(drum.follower.turns)]
        nearest = np.argmin([off_flank(gauge, surfaces, turn) for gauge, turn in ways], axis=0)
        for surface, (gauge, turn) in zip(surfaces, (ways[k] for k in nearest), strict=True):
            flanks[gauge.name].append(replace(surface, about=surface.near + TURN * turn))
    for face in shell.faces:
        if isinstance(face.surface, Patch):
            continue
        if face.surface.level:
            z = face.heights[0]
            name = BOTTOM if abs(z) <= abs(z - drum.length) else TOP
            note(name, abs(z - (0.0 if name == BOTTOM else drum.length)))
        else:
            distances = _off_walls(shell, face, drum, tolerance)
            name = min(distances, key=lambda each: distances[each])
            note(name, distances[name])
    return _Sorted(off, flanks)


def _patches(shell: Shell) -> list[Patch]:
    """B-spline surfaces of a solid."""
    return [face.surface for face in shell.faces if isinstance(face.surface, Patch)]


def _off_walls(shell: Shell, face: Face, drum: DrumIntent, tolerance: float) -> dict[str, float]:
    """Distance, mm, of an upright face from each upright face of a drum that it may be."""
    found = {}
    surface = face.surface
    radii = {BLANK: drum.radius, **({FLOOR: drum.floor} if drum.track.depth is not None else {})}
    for name, radius in radii.items():
        if isinstance(surface, RoundFace):
            found[name] = abs(surface.radius - radius) + float(np.hypot(*surface.centre))
        else:
            points = np.concatenate([edge.samples for edge, _ in face.uses])
            found[name] = float(np.abs(np.hypot(points[:, 0], points[:, 1]) - radius).max())
    if drum.bore is not None and not min(found.values()) <= tolerance:
        arcs = _section(shell, face, mirrored=drum.mirrored)
        outline = drum.bore.contour.as_arcs()[0]
        bend = max(float(np.abs(part.curvature).max(initial=0.0)) for part in (arcs, outline))
        found[BORE] = farthest(arcs, outline, bend, FINE * tolerance) if len(arcs) else math.inf
    return found


def _section(shell: Shell, face: Face, *, mirrored: bool) -> Arcs:
    """Lines and arcs of an upright face as seen from above, as if not mirrored."""
    low, high = face.heights
    rows: list[tuple[Array, Array, float, float]] = []
    for piece in face.section(shell.space, 0.5 * (low + high)):
        for x, y, x1, y1, _ in piece.chords:
            way = np.array([x1 - x, y1 - y])
            size = float(np.hypot(*way))
            if size > 0.0:
                rows.append((np.array([x, y]), way / size, 0.0, size))
        for x, y, radius, first, sweep in piece.arcs:
            sense = math.copysign(1.0, sweep)
            out = np.array([math.cos(first), math.sin(first)])
            rows.append(
                (
                    np.array([x, y]) + radius * out,
                    sense * np.array([-out[1], out[0]]),
                    sense / radius,
                    abs(sweep) * radius,
                )
            )
    flip = np.array([1.0, -1.0 if mirrored else 1.0])
    start, tangent = (np.array([row[k] for row in rows]).reshape(-1, 2) * flip for k in (0, 1))
    curvature, length = (np.array([row[k] for row in rows], dtype=np.float64) for k in (2, 3))
    return Arcs(start, tangent, -curvature if mirrored else curvature, length)


def _smooth(patch: Patch, *, mirrored: bool) -> Smooth:
    """Patches of a surface whose first parameter runs along the turn."""
    nets, v = patch.nets * (MIRROR if mirrored else 1.0), patch.v
    r = np.hypot(patch.corners[:, 0], patch.corners[:, 1])
    # along the turn it stays on its cylinder, however short it is there
    if abs(r[1] - r[0]) > abs(r[3] - r[0]):
        nets, v = nets.transpose(1, 0, 3, 2, 4), patch.u
    share = (v - v[0]) / (v[-1] - v[0])
    count, deep = nets.shape[:2]
    about = np.unwrap(np.arctan2(nets[:, 0, 0, 0, 1], nets[:, 0, 0, 0, 0]))
    lines = np.tile(np.stack([share[:-1], share[1:]], axis=1), (count, 1))
    return Smooth(np.ascontiguousarray(nets.reshape(count * deep, *nets.shape[2:])), lines, np.repeat(about, deep))
