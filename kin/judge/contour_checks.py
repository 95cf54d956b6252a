"""The checks on a contour, its holes and its solid, in mm and no longer mirrored, against what was intended."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Literal

import numpy as np

from kin.contour.arcs import dot, left
from kin.contour.contour import ARC_SHARE
from kin.follower.deviation import Deviation, convex_deviation, deviation
from kin.follower.follower import ContactError, Follower, Judged, MotionError
from kin.follower.motion_error import ALLOWANCE
from kin.follower.projection import grid
from kin.judge.check import Check, at_most, failed
from kin.numeric.errors import UnsettledError
from kin.numeric.extrema import extremes, resolution
from kin.numeric.places import place_text

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from kin.contour.contour import Contour
    from kin.follower.frame import DwellFound, LinkageVerdict
    from kin.judge.holes import Hole
    from kin.judge.layers import CrossHole, Layer
    from kin.judge.milling import Milling
    from kin.law.frame_swing import FrameSwing
    from kin.linkage.mechanism import Mechanism
    from kin.numeric.arrays import Array, Indices

# The judge's own rounding, as a share of the contour's extent; a value this far above its limit still holds.
ROUNDING = 1e-12
# Splines are judged as arcs within this share of the tolerance, and no coarser than SPLINE_ERROR, mm, as far as
# rounding lets them be.
SPLINE_SHARE, SPLINE_ERROR = 1e-3, 1e-9
DWELL_ROUNDING = 1e-7  # degrees; the ends of a dwell are found to this
# A limit that the tolerance implies is none where it is above this share of the stroke (of a play: of the rollers'
# radius), and so many times what the tolerance gives at a pressure angle of 0.
MOST_SHARE, STEEP = 0.1, 10.0
NO_LIMIT = "no limit follows from the tolerance here; give verify.motion_error"


@dataclass(frozen=True)
class DwellAsked:
    """A dwell: the output stays within a range of `band`, rad or mm, for `at_least`, rad (None: it is only told)."""

    band: float
    at_least: float | None = None
    over: Literal["shaft", "relative"] = "shaft"


@dataclass(frozen=True)
class Intent:
    """What a file is meant to be.

    follower    with its motion law, in mm and radians
    mirrored    the file is drawn mirrored about the x axis (the shaft turns counter-clockwise)
    mm          mm in one drawing unit of a DXF or SVG file or a program (solids are always in mm)
    bore        diameter, mm; None for no hole at all
    outer       diameter of a ring, mm, whose follower runs in the opening; None for a cam that it runs round
    thickness   of a solid, mm, z from 0; None where only contours are judged
    trimmed     an undercut is cut off: what motion is lost is reported, and judged only against limits that are given
    mechanism   that the yoke's frame drives as a coupler; None for a plain follower
    swing       law that the mechanism's frame has to follow; its lift's is the law if None
    dwell       of the mechanism's output, which is found in each file and, if it must last, judged
    holes       all openings, the bore among them, of a part that has more than a round bore; `bore` is None then
    layers      of its solid, from below, and radial holes through layers with an outline of their own
    milling     how a program mills it
    """

    follower: Follower
    mirrored: bool = False
    mm: float = 1.0
    bore: float | None = None
    thickness: float | None = None
    trimmed: bool = False
    mechanism: Mechanism | None = None
    swing: FrameSwing | None = None
    dwell: DwellAsked | None = None
    holes: tuple[Hole, ...] = ()
    layers: tuple[Layer, ...] = ()
    cross_holes: tuple[CrossHole, ...] = ()
    milling: Milling | None = None
    outer: float | None = None

    @property
    def featured(self) -> bool:
        """Whether the part has more than a round bore."""
        return bool(self.holes or self.layers)


@dataclass(frozen=True)
class Limits:
    """What is permitted: `tolerance` of the contour, mm; greatest motion error, and greatest play or interference.

    Motion and play are in mm or degrees as the follower has them, `output`, the greatest error of a mechanism's output,
    as the mechanism has it; None is what the tolerance implies, see `motion_limit` and `closure` of the followers
    and `kin.follower.frame.implied_limit`.
    """

    tolerance: float
    motion: float | None = None
    play: float | None = None
    output: float | None = None


@dataclass(frozen=True)
class Findings:
    """What was found on a contour; motion is None where the follower finds no contact.

    `deviation` is None where it could not be found.
    `linkage` is None without a mechanism, or where the contour does not drive it all round.
    """

    judged: Judged | None
    deviation: Deviation | None
    checks: tuple[Check, ...]
    linkage: LinkageVerdict | None = None


def judge_contour(contour: Contour, intent: Intent, phi: Array, limits: Limits, uneven: float = 0.0) -> Findings:
    """Judge a contour at shaft angles phi (n,): the checks from contour and motion to linkage-error and dwell.

    With a mechanism phi are relative angles for the plain frame's checks, and shaft angles for the mechanism's.
    `uneven` is how far a solid's other sections may be off this one, mm; what that can do is counted into everything.
    """
    spline = 0.0
    if contour.beziers.count:
        fine = ARC_SHARE * float(np.abs(contour.vertices).max())  # on a part of many metres rounding is coarser
        spline = max(min(SPLINE_ERROR, SPLINE_SHARE * limits.tolerance), fine)
        contour = contour.finer(spline)  # for rollers too
    slack = spline + ROUNDING * float(np.abs(contour.vertices).max())
    judged, checks = None, []
    try:
        judged = _less_sure(intent.follower.judge(contour, phi), intent.follower, uneven)
        checks = _motion_checks(judged, intent, limits, slack)
    except (ContactError, UnsettledError) as error:
        checks = [failed("motion", str(error), unit=intent.follower.unit)]
    envelope = intent.follower.envelope
    if judged and judged.reach and contour.is_convex and envelope.regular:
        found = convex_deviation(judged.reach)
    else:
        try:
            found = deviation(contour.as_arcs(spline or SPLINE_ERROR)[0], envelope)
        except UnsettledError as error:
            unsettled = failed("contour", str(error), unit="mm", limit=limits.tolerance)
            return Findings(judged, None, (unsettled, *checks))
    if uneven:
        away = (found.outside + uneven, found.inside + uneven, found.bare + uneven)
        found = replace(found, outside=away[0], inside=away[1], bare=away[2])
    linkage = None
    if intent.mechanism is not None:
        linkage, more = _judge_linkage(contour, intent, phi, limits, slack=slack, uneven=uneven)
        checks += more
    judged_contour = _contour_check(found, intent, limits.tolerance, slack)
    return Findings(judged, found, (judged_contour, *checks), linkage)


def _less_sure(judged: Judged, follower: Follower, uneven: float) -> Judged:
    """Count in what a contour that is off by `uneven`, mm, can do to the motion and the play."""
    if not uneven:
        return judged
    play, closure = judged.play, follower.closure
    if play is not None and closure is not None:
        play = play.less_sure(closure.limit(uneven))
    return judged._replace(motion=judged.motion.less_sure(follower.motion_limit(uneven)), play=play)


def _contour_check(found: Deviation, intent: Intent, tolerance: float, slack: float) -> Check:
    """Check both sides of a contour against the tolerance; on the cutter's, as much more may stand as it may leave."""
    worst, parameter = found.worst
    milling, follower = intent.milling, intent.follower
    if milling is not None and milling.standing:
        worst = max(worst - milling.standing, found.inside if milling.side > 0 else found.outside)
    detail = f"{found.outside:.3g} mm outside, {found.inside:.3g} mm inside the exact contour"
    if found.rounds != 1:
        detail = f"the contour goes {found.rounds} times round the exact one; {detail}"
        return failed("contour", detail, unit="mm", limit=tolerance)
    if found.backwards > tolerance + slack:
        detail = f"the contour turns back on itself by {found.backwards:.3g} mm; {detail}"
        worst = max(worst, found.backwards)
    at = float(follower.shaft_angle(np.array([parameter]))[0])
    return at_most("contour", worst, tolerance, "mm", at=at, detail=detail, slack=slack)


def _motion_checks(judged: Judged, intent: Intent, limits: Limits, slack: float) -> list[Check]:
    follower, motion, play = intent.follower, judged.motion, judged.play
    checks, direct = [], follower.direct_limit(limits.tolerance)
    size = stroke_of(follower)
    if limits.motion is not None or not intent.trimmed:
        limit, room = _limit(follower.motion_limit, limits.motion, limits.tolerance, slack)
        # the implied limit is a theorem about contours; one that a user gives is held by all that may be
        worst = motion.max if limits.motion is None else motion.bound
        at, detail = np.radians(motion.at_deg), _found(motion)
        vacuous = limits.motion is None and is_loose(limit, direct, size)
        checked = at_most("motion", worst, limit, motion.unit, at=at, detail=detail, slack=room)
        checks.append(_unlimited(checked) if vacuous else checked)
    closure = follower.closure
    if play is None or closure is None:
        return checks
    if limits.play is None and intent.trimmed:
        return checks
    given = limits.play
    if given is None and limits.motion is not None and closure.lever is not None:
        given = closure.lever * limits.motion
    limit, room = _limit(closure.limit, given, limits.tolerance, slack)
    tight, loose = (-play.least, np.radians(play.least_at_deg)), (play.most, np.radians(play.most_at_deg))
    worst, at = max(tight, loose)
    if play.extremes == "sampled" and given is not None:
        worst += ALLOWANCE * abs(worst)
    detail = closure.detail(play)
    vacuous = given is None and is_loose(limit, direct_play(follower, limits.tolerance), closure.radius or size)
    checked = at_most(closure.name, worst, limit, play.unit, at=at, detail=detail, slack=room)
    checks.append(_unlimited(checked) if vacuous else checked)
    if closure.tight is not None:
        checks.append(at_most(closure.tight, tight[0], limit, play.unit, at=tight[1], slack=room))
    return checks


def stroke_of(follower: Follower) -> float:
    """Stroke, mm, or swing, degrees, of the intended motion, looked at at the shaft angles of limits."""
    stroke = float(np.ptp(follower.intended(grid(follower.motion.breaks))))
    return float(np.degrees(stroke)) if follower.unit == "deg" else stroke


def is_loose(limit: float, direct: float, size: float, share: float = MOST_SHARE) -> bool:
    """Whether a limit is above that share of a size, and far above what the same tolerance gives directly."""
    return limit > share * size and limit > STEEP * direct


def direct_play(follower: Follower, tolerance: float) -> float:
    """What the limit of play, mm or degrees, is at a pressure angle of 0: two contacts, each off by the tolerance."""
    angular = follower.closure is not None and follower.closure.radius is None
    return 2.0 * (follower.direct_limit(tolerance) if angular else tolerance)


def _unlimited(check: Check) -> Check:
    """Fail a check whose limit is none."""
    detail = f"{NO_LIMIT}; {check.limit:.3g} {check.unit} would be permitted"
    return replace(check, ok=False, limit=None, detail=f"{detail}; {check.detail}" if check.detail else detail)


def _found(motion: MotionError) -> str:
    """Tell how the greatest motion error was found, where that leaves a remainder."""
    if motion.extremes == "sampled":
        return f"sampled; {motion.remainder:.3g} {motion.unit} more is an estimate of what lies between"
    return f"true within {motion.remainder:.2g} {motion.unit}" if motion.remainder else ""


def _limit(
    implied: Callable[[float], float], given: float | None, tolerance: float, slack: float
) -> tuple[float, float]:
    """Return the limit, given or implied by the tolerance, and by how much the judge's own rounding may exceed it.

    Where rounding grows beyond a small share of a limit that is given, the limit holds and not the rounding.
    """
    by_tolerance = implied(tolerance)
    room = implied(tolerance + slack) - by_tolerance
    return (by_tolerance, room) if given is None else (given, min(room, SPLINE_SHARE * given))


def _judge_linkage(
    contour: Contour, intent: Intent, phi: Array, limits: Limits, *, slack: float, uneven: float
) -> tuple[LinkageVerdict | None, list[Check]]:
    """Judge how a contour drives the mechanism: checks linkage-error and, if the dwell must last, dwell."""
    from kin.follower.frame import FrameError, judge_frame  # a plain follower does without
    from kin.linkage.loop import BindingError

    mechanism, asked = intent.mechanism, intent.dwell
    if mechanism is None:
        return None, []
    at_least = None if asked is None or asked.at_least is None else float(np.degrees(asked.at_least))
    try:
        off = _output_less_sure(mechanism, uneven)
        if asked is None:
            found = judge_frame(contour, mechanism, phi, limits.tolerance, swing=intent.swing)
        else:
            band = _band_less_sure(asked, mechanism, off)
            found = judge_frame(
                contour, mechanism, phi, limits.tolerance, swing=intent.swing, band=band, over=asked.over
            )
        if uneven:
            found = replace(
                found,
                error=found.error.less_sure(off),
                centred=found.centred.less_sure(off),
                play_across=found.play_across.less_sure(2.0 * uneven),
                play_along=found.play_along.less_sure(2.0 * uneven),
                dwells=tuple(replace(one, band=one.band + 2.0 * off) for one in found.dwells),
            )
    except (FrameError, BindingError) as problem:
        what = str(problem) if isinstance(problem, FrameError) else f"the intended mechanism: {problem}"
        checks = [failed("linkage-error", what, unit=mechanism.unit, limit=limits.output)]
        if at_least is not None:
            checks.append(replace(failed("dwell", what, unit="deg", limit=at_least), sense="at_least"))
        return None, checks
    checks = []
    if limits.output is not None or not intent.trimmed:
        checks.append(_output_check(found, limits, slack))
    if at_least is not None:
        checks.append(_dwell_check(found.dwells[0], mechanism.unit, at_least))
    return found, checks


def _output_less_sure(mechanism: Mechanism, uneven: float) -> float:
    """What a contour that is off by `uneven`, mm, can do to the output."""
    from kin.follower.frame import FrameError, implied_limit

    off = implied_limit(mechanism, uneven) if uneven else 0.0
    if off is None:
        raise FrameError(f"the mechanism binds within the {uneven:.3g} mm by which the solid's sections differ")
    return off


def _band_less_sure(asked: DwellAsked, mechanism: Mechanism, off: float) -> float:
    """Band within which an output stays for certain in the band asked for, if it may be off either way, rad or mm."""
    from kin.follower.frame import FrameError

    band = asked.band - 2.0 * (float(np.radians(off)) if mechanism.unit == "deg" else off)
    if band <= 0.0:
        raise FrameError(
            f"the output may be off by {off:.3g} {mechanism.unit}, which leaves nothing of the dwell's band"
        )
    return band


def _output_check(found: LinkageVerdict, limits: Limits, slack: float) -> Check:
    error, across, along = found.error, found.play_across, found.play_along
    detail = (
        f"{found.centred.max:.3g} {error.unit} with the frame centred; "
        f"backlash {across.least:.3g} to {across.most:.3g} mm across, "
        f"{along.least:.3g} to {along.most:.3g} mm along the frame"
    )
    limit = found.limit if limits.output is None else limits.output
    if limit is None:
        detail = f"the mechanism binds within the tolerance, which thus implies no limit; {detail}"
        return Check("linkage-error", ok=False, value=error.max, limit=None, unit=error.unit, detail=detail)
    room = 0.0 if found.limit is None else found.limit * slack / limits.tolerance
    at = np.radians(error.at_deg)
    return at_most("linkage-error", error.max, limit, error.unit, at=at, detail=detail, slack=room)


def _dwell_check(shortest: DwellFound, unit: str, at_least: float) -> Check:
    """Check the longest dwell in that way of resting in which it is shortest."""
    ok, over = shortest.length_deg >= at_least - DWELL_ROUNDING, shortest.over
    at = shortest.start_deg if over == "shaft" else None
    where = f"from {shortest.start_deg:.6g} degrees of the {over} angle"
    detail = f"{where}, within {shortest.band:.6g} {unit}, {shortest.rest}"
    return Check("dwell", ok, shortest.length_deg, at_least, "deg", at, "at_least", detail=detail)


def bore_check(holes: Sequence[Contour], bore: float | None, tolerance: float) -> Check | None:
    """Check that there is one hole, round and about the shaft, in number, place and diameter; None if none is due."""
    if bore is None:
        if not holes:
            return None
        return failed("bore", f"{len(holes)} hole(s), where none is expected", unit="mm", limit=tolerance)
    if len(holes) != 1:
        detail = f"{len(holes)} holes, where one of diameter {bore:.9g} mm is expected"
        return failed("bore", detail, unit="mm", limit=tolerance)
    return round_check("bore", holes[0], bore, tolerance)


def round_check(name: str, contour: Contour, diameter: float, tolerance: float) -> Check:
    """Check that a contour is a circle of that diameter, mm, about the shaft."""
    least, most = _distance_range(contour)
    across, box = 2.0 * float(np.sqrt(abs(contour.area) / np.pi)), contour.box
    worst = max(most - 0.5 * diameter, 0.5 * diameter - least, 0.5 * abs(across - diameter))
    place = place_text(0.5 * (box.x_min + box.x_max), 0.5 * (box.y_min + box.y_max))
    detail = f"diameter {across:.9g} mm about {place}"
    return at_most(name, worst, tolerance, "mm", detail=detail, slack=ROUNDING * diameter)


def _distance_range(contour: Contour) -> tuple[float, float]:
    """Least and greatest distance of a contour from the origin."""
    arcs, _ = contour.as_arcs()
    pieces, _ = arcs.cut(np.ceil(np.maximum(np.abs(arcs.curvature) * arcs.length / 0.1, 1.0)).astype(np.intp))
    fine = resolution(pieces.start)

    def distance(s: Array, piece: Indices) -> Array:
        here = pieces.take(piece)
        x, tangent = here.points(s), here.tangents(s)
        r = np.maximum(np.hypot(x[:, 0], x[:, 1]), fine)
        slope = dot(x, tangent) / r
        return np.stack([r, slope, (1.0 + here.curvature * dot(x, left(tangent)) - slope**2) / r])

    every = np.arange(len(pieces))
    low, high = np.zeros(len(pieces)), pieces.length
    found = extremes(low, high, distance(low, every), distance(high, every), distance, resolution=fine)
    return found.least, found.greatest


def exact_area(contour: Contour, intent: Intent) -> tuple[float, float, str]:
    """Area and length of the edges, mm^2 and mm, and whose they are: the intent's, or the file's contour's.

    The contour's are those of a trimmed cam, for which there is no closed form. A ring has two edges.
    """
    envelope = intent.follower.envelope
    regular = envelope.regular
    area, length = envelope.area_and_perimeter() if regular else (contour.area, contour.length)
    if intent.outer is not None:
        area, length = 0.25 * np.pi * intent.outer**2 - area, np.pi * intent.outer + length
    return area, length, "intent" if regular else "contour"


def volume_check(volume: float, height: float, contour: Contour, intent: Intent, tolerance: float) -> Check:
    """Check a solid's volume against the area times its height, within the tolerance times the area of the walls."""
    area, perimeter, source = exact_area(contour, intent)
    bore = intent.bore or 0.0
    expected = (area - 0.25 * np.pi * bore**2) * height
    limit = tolerance * (perimeter + np.pi * bore + 2.0 * np.pi * tolerance) * height  # to second order
    detail = f"{volume:.9g} mm^3, by the {source} {expected:.9g}"
    return at_most("volume", abs(volume - expected), limit, "mm^3", detail=detail, slack=ROUNDING * expected)
