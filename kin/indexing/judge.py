"""The verdict on a file of an indexing cam: whether it is the intended cam, and its turret moves as intended.

A solid is taken as it lies on disk, and the way it was made is not known here. The exact metal is what rollers leave of
the blank at all angles (`kin.indexing.rollers`). The motion is that of a turret held by the file's own triangles. Every
triangle is measured against a face of the intended cam. A closed surface all of which is near that of the cam goes
round it once, if it encloses as much: so nothing is missing.

Contour and motion are proved within remainders. The play is known at angles of a grid. The greatest cost of an error,
on which a limit that is not given depends, is sampled; the volume is integrated.
"""

from __future__ import annotations

import math
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from kin.indexing.contour import Known, Peak, across, bare, edges_of, proud
from kin.indexing.faces import BLANK, BORE, BOTTOM, FLOOR, TOP, Body, plain_offs, sorted_faces, within_bore
from kin.indexing.holding import angles_for, by_error, held
from kin.indexing.intent import SIDES
from kin.indexing.rollers import Rollers
from kin.indexing.volume import exact_volume
from kin.law.motion_error import MotionError, Play
from kin.numeric.angles import TURN, degrees
from kin.numeric.check import Check, at_most, failed
from kin.numeric.errors import UnsettledError
from kin.numeric.lengths import UNIT, amount_words, length_words
from kin.numeric.limits import is_loose, limit_of, unlimited
from kin.numeric.records import dataclass, replace
from kin.turned.files import closed_mesh, face_check, rounding_of, verify_lines, verify_mesh, volume_check
from kin.turned.verdict import CONTOUR, ENDS, MOTION, PLAY, FlankVerdict, TurnedVerdict, assured, surface_check

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from kin.indexing.contour import Edged
    from kin.indexing.faces import Faces
    from kin.indexing.holding import Held
    from kin.indexing.intent import IndexIntent
    from kin.law.contacts import Side
    from kin.numeric.arrays import Array, Indices, Mask
    from kin.numeric.limits import Limits
    from kin.read.mesh.checked import CheckedMesh
    from kin.turned.files import Developed


def verify(path: Path, intent: IndexIntent, limits: Limits, units: float | None = None) -> TurnedVerdict:
    """Judge a solid of triangles over all shaft angles; `units` and what is raised are those of `verify_mesh`."""
    return verify_mesh(path, units, lambda read, kind: judge_mesh(read, intent, limits, kind))


def verify_development(
    path: Path, intent: IndexIntent, lines: Sequence[Developed], limits: Limits, units: float | None = None
) -> TurnedVerdict:
    """Judge a development's DXF line by line, each for the radius at which it is unrolled, and for no other.

    `units` and what is raised are those of `kin.turned.files.verify_lines`; ValueError for a globoid too.
    """
    from kin.indexing.development import judged_line

    for line in lines:
        intent.form.developed(line.radius)

    def judge(parts: list[Array], line: Developed) -> tuple[FlankVerdict, list[Check]]:
        return judged_line(parts, intent, line, limits)

    return verify_lines(path, lines, intent, TURN, judge, units=units)


def judge_mesh(read: CheckedMesh, intent: IndexIntent, limits: Limits, kind: str = "") -> TurnedVerdict:
    """Judge a mesh, mm, as its file has it; corners that it keeps apart by less than the tolerance are joined."""
    read, closed = closed_mesh(read, limits.tolerance)
    checks = [closed]
    flanks: list[FlankVerdict] = []
    play = None
    try:
        job = _Judged.of(read, intent, limits)
        checks += job.plain()
        seen = []
        for name, side in SIDES.items():
            verdict, own, found = job.flank(name, side)
            flanks.append(verdict)
            checks += [replace(check, surface=name) for check in found]
            seen.append(own)
        one, other = seen
        if one is not None and other is not None:
            play, check = play_of(job.rollers, limits, job.slack, (one, other))
            checks.append(check)
        checks.append(volume_check(read, exact_volume(job.rollers), limits.tolerance))
    except UnsettledError as error:
        checks.append(failed(CONTOUR, str(error), unit="mm", limit=limits.tolerance))
    return TurnedVerdict(kind, tuple(checks), tuple(flanks), play, read.units_mm or 1.0, read.mesh)


@dataclass(frozen=True, eq=False)
class _Judged:
    """A file being judged: the rollers it is held against, and the rounding of its places, `slack`, mm."""

    rollers: Rollers
    limits: Limits
    slack: float
    body: Body
    faces: Faces
    known: Known

    @staticmethod
    def of(read: CheckedMesh, intent: IndexIntent, limits: Limits) -> _Judged:
        """Sort a mesh by faces, and set the rollers beside its corners."""
        rollers = Rollers(intent, limits.tolerance)
        body = Body.of(read.mesh, intent)
        slack = rounding_of(read, body.points)
        tolerance = limits.tolerance + slack
        both = limits.tolerance, tolerance
        rest = np.flatnonzero(_least(plain_offs(body, intent, both)) > tolerance)
        body = body.divided(intent, rest, rollers.longest)
        offs = plain_offs(body, intent, both)
        rest = np.flatnonzero(_least(offs) > tolerance)
        asked = np.zeros(len(body.points), dtype=np.bool_)
        asked[body.corners[rest]] = True
        # blank and ends may not be in a roller's way either
        plain = np.minimum.reduce([offs[name] for name in (BLANK, BOTTOM, TOP)]) <= tolerance
        asked[body.corners[plain]] |= (body.depth < intent.form.depth - tolerance)[body.corners[plain]]
        known = Known.of(rollers, body, np.flatnonzero(asked))
        away = np.full(len(body.corners), np.inf)
        away[rest] = np.abs(known.distance[body.corners[rest]]).max(axis=1)
        return _Judged(rollers, limits, slack, body, sorted_faces(body, intent, offs, away, tolerance), known)

    def plain(self) -> list[Check]:
        """Checks of blank, floor, ends and bore."""
        intent, off, checks = self.rollers.intent, self.faces.off, []

        def check(name: str, worst: float, detail: str) -> None:
            checks.append(face_check(name, worst, self.limits.tolerance, detail, self.slack))

        check(BLANK, off[BLANK], f"from a radius of {length_words(intent.form.radius)} {UNIT}")
        ends = (intent.form.deepest(place, intent.roller) for place in (intent.inner, intent.outer))
        room = intent.form.depth - max(ends)
        told = f"the roller ends {length_words(abs(room), '.3g')} {UNIT} {'above it' if room > 0.0 else 'below it'}"
        check(FLOOR, off[FLOOR], f"from a depth of {length_words(intent.form.depth)} {UNIT} below the blank; {told}")
        checks[-1] = replace(checks[-1], ok=checks[-1].ok and room > 0.0)
        worst = math.nan if math.isnan(off[BOTTOM] + off[TOP]) else max(off[BOTTOM], off[TOP], self._beyond())
        check(ENDS, worst, f"from z = {length_words(0.0)} and {length_words(intent.length)} {UNIT}")
        if intent.bore is not None:
            check(BORE, off[BORE], f"from {intent.bore.name}")
        return checks

    def _beyond(self) -> float:
        """How far triangles of the ends reach out of the blank or into the bore, mm; 0 where none does."""
        body, bore = self.body, self.rollers.intent.bore
        corners = body.corners[self.faces.of(BOTTOM) | self.faces.of(TOP)]
        worst = max(0.0, -float(body.depth[corners].min(initial=math.inf)))
        return worst if bore is None else max(worst, within_bore(bore, body.points[corners][..., :2].mean(axis=1)))

    def flank(self, name: str, side: Side) -> tuple[FlankVerdict, Held | None, list[Check]]:
        """Verdict on one flank, what it holds, and its checks."""
        rollers, known, body = self.rollers, self.known, self.body
        which = np.flatnonzero(self.faces.flanks)
        votes = np.where(known.above[body.corners[which]], 1, -1).sum(axis=1)
        which = which[votes * side > 0]
        limit = self.limits.tolerance
        if not len(which):
            return FlankVerdict(name), None, [failed(CONTOUR, "the flank is missing", unit="mm", limit=limit)]
        edged = edges_of(rollers, body, known, which)
        asked = np.isfinite(known.distance) & (known.above == (side > 0))
        out = proud(rollers, known, edged, np.flatnonzero(asked & self._beside(which)))
        out = max(out, self.spans[side > 0], key=lambda peak: peak.value)
        within = bare(rollers, body, known, which)
        check, worst = contour_check(out, within, limit, self.slack)
        count = angles_for(rollers)
        holds = held(rollers, body, known, (which, side), count)
        if not np.isfinite(holds.between).all():
            angle = degrees(int(np.argmin(np.isfinite(holds.between))) * TURN / count)
            loose = failed(MOTION, f"the turret touches nothing at an angle of {angle:.6g} degrees", unit="deg")
            return FlankVerdict(name, None, worst, len(which)), None, [check, loose]
        motion = motion_error(holds, self._pushed(edged, np.flatnonzero(asked)))
        checks = [check, motion_check(rollers, motion, self.limits, self.slack, by_error(rollers, side))]
        return FlankVerdict(name, motion, worst, len(which)), holds, checks

    @cached_property
    def spans(self) -> tuple[Peak, Peak]:
        """How far blank and ends span tracks below a roller and above it, mm."""
        plain = np.logical_or.reduce([self.faces.of(name) for name in (BLANK, BOTTOM, TOP)])
        floor = self.rollers.intent.form.depth - self.limits.tolerance - self.slack
        return across(self.rollers, self.body, self.known, np.flatnonzero(plain), floor)

    def _beside(self, which: Indices) -> Mask:
        """Corners (v,) that have to be out of what rollers sweep: of a flank, and of blank and ends above the floor."""
        found = np.zeros(len(self.body.points), dtype=np.bool_)
        for name in (BLANK, BOTTOM, TOP):
            found[self.body.corners[self.faces.of(name)]] = True
        found[self.body.corners[self.faces.of(FLOOR)]] = False
        found[self.body.corners[which]] = True
        return found

    def _pushed(self, edged: Edged, own: Indices) -> Peak:
        """How far a flank pushes the turret out of its place at most, rad, by its corners and edges."""
        known, intent = self.known, self.rollers.intent
        within = (known.along >= intent.inner) & (known.along <= intent.outer)
        own = own[within[own]]
        # a corner whose roller passes right through it has no angle at which that touches
        gives = np.where(np.isfinite(known.gives), known.gives, np.where(known.distance < 0.0, math.pi, -math.pi))
        k = int(gives[own].argmax()) if len(own) else 0
        peak = (
            Peak(float(gives[own[k]]), 0.0, float(known.worst.theta[own[k]])) if len(own) else Peak(-math.pi, 0.0, 0.0)
        )
        reach = np.stack([known.along[edged.start], known.along[edged.last]])
        beside = (reach.max(axis=0) >= intent.inner) & (reach.min(axis=0) <= intent.outer)
        slope = np.minimum(known.slope[edged.start], known.slope[edged.last])
        most = pushed_by((edged.worst.open - edged.worst.excess)[beside], slope[beside])
        return peak._replace(remainder=max(0.0, float(most.max(initial=-math.inf)) - peak.value))


def pushed_by(depth: Array, slope: Array) -> Array:
    """Angles (n,), rad, by which edges push the turret at most, by their depth, mm^2, and its slope by the angle.

    The depth is convex in the angle. Where its slope is 0 a roller touches with its very side, and nothing bounds it.
    """
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(slope > 0.0, depth / slope, np.where(depth > 0.0, np.inf, -np.inf))


def _least(offs: dict[str, Array]) -> Array:
    """Distance (t,) from the nearest plain face."""
    least: Array = np.minimum.reduce(list(offs.values()))
    return least


def contour_check(out: Peak, within: Peak, tolerance: float, slack: float) -> tuple[Check, float]:
    """Check of the distance of a flank's surface, mm, out of the metal and into it, and the greater distance."""
    check, worst = surface_check(out, within, tolerance, slack)
    at = out.at if out.value >= within.value else within.at
    return replace(check, at=degrees(at) if math.isfinite(at) else None), worst


def motion_error(holds: Held, pushed: Peak) -> MotionError:
    """Error of the turret on a flank, by what it holds and how far it pushes the turret at most, rad."""
    k = int(holds.at.argmin())
    least, most = float(holds.at[k]), max(pushed.value, float(holds.at.max()))
    bound = max(pushed.value + pushed.remainder, most, -float(holds.between.min()))
    worst, at = (-least, k * TURN / len(holds.at)) if -least > most else (most, pushed.at)
    rms = float(np.sqrt(np.mean(holds.at**2)))
    found = MotionError(worst, degrees(at), max(bound - worst, 0.0), least, most, rms, "deg")
    return found.scaled(math.degrees(1.0), "deg")


def motion_check(rollers: Rollers, motion: MotionError, limits: Limits, slack: float, cost: float) -> Check:
    """Check of the motion on a flank, deg; `cost` is what an error of the flank of 1 mm costs at most, rad."""
    given = None if limits.motion is None else math.degrees(limits.motion)
    cost = math.degrees(cost)
    limit, room = limit_of(lambda e: e * cost, given, limits.tolerance, slack)
    worst = assured(motion.max, motion.remainder, cost * limits.tolerance) if given is None else motion.bound
    detail = f"true within {amount_words(motion.remainder, 'deg', '.2g')}" if motion.remainder else ""
    check = replace(at_most(MOTION, worst, limit, "deg", detail=detail, slack=room), at=motion.at)
    direct = math.degrees(limits.tolerance / rollers.intent.form.lever)
    loose = given is None and is_loose(limit, direct, lambda: math.degrees(rollers.intent.pitch))
    return unlimited(check) if loose else check


def play_of(rollers: Rollers, limits: Limits, slack: float, flanks: tuple[Held, Held]) -> tuple[Play, Check]:
    """Play of the turret between all flanks, and the check on that of the gauges, which should fit without any."""
    lower, upper = flanks
    count = len(lower.at)
    own = -np.degrees(lower.own + upper.own)
    least, most = int(own.argmin()), int(own.argmax())
    places = [degrees(k * TURN / count) for k in (least, most)]
    play = Play(float(own[least]), places[0], float(own[most]), places[1], "deg")
    cost = math.degrees(sum(by_error(rollers, side) for side in SIDES.values()))
    given = None if limits.play is None else math.degrees(limits.play)
    limit, room = limit_of(lambda e: e * cost, given, limits.tolerance, slack)
    told = f"the turret's own play is {play.least:.6g} to {play.most:.6g} deg"
    if play.least < 0.0:
        told += f": it is pinched by up to {-play.least:.3g} deg"
    pinched = np.degrees(np.abs(lower.at + upper.at))
    k = int(pinched.argmax())
    check = at_most(PLAY, float(pinched[k]), limit, "deg", detail=told, slack=room)
    return play, replace(check, at=degrees(k * TURN / count))
