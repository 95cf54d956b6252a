"""The checks on the contour of a surface, in mm and no longer mirrored: its form, and the motion of its gauge on it."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kin.contour.contour import ARC_SHARE
from kin.follower.deviation import Deviation, convex_deviation, deviation
from kin.follower.motion_error import ALLOWANCE, ContactError, Judged, MotionError, Play
from kin.judge.limits import direct_play, stroke_of
from kin.judge.verdict import SurfaceVerdict
from kin.numeric.angles import TURN
from kin.numeric.check import ROUNDING, Check, at_most, failed
from kin.numeric.errors import UnsettledError
from kin.numeric.lengths import UNIT, amount_words, length_words, marked
from kin.numeric.limits import SPLINE_ERROR, SPLINE_SHARE, is_loose, limit_of, unlimited

if TYPE_CHECKING:
    from kin.contour.contour import Contour
    from kin.follower.base import Closure, Follower
    from kin.follower.envelope import Envelope
    from kin.judge.intent import Limits, LinkageIntent, SurfaceIntent
    from kin.numeric.arrays import Array
    from kin.read.nesting import ClosedContour


PLACED = np.linspace(0.0, TURN, 720, endpoint=False)  # parameters at which an exact contour is taken to be placed


class Fine(NamedTuple):
    """A contour of lines and arcs that stands for one with splines.

    `spline`, mm, is the distance within which arcs stand for splines, 0 without any; `slack`, mm, bounds the error of a
    length by arcs and rounding.
    """

    contour: Contour
    spline: float
    slack: float


def judge_contour(
    chain: ClosedContour,
    surface: SurfaceIntent,
    phi: Array,
    limits: Limits,
    uneven: float = 0.0,
    *,
    standing: float = 0.0,
    linkage: LinkageIntent | None = None,
) -> tuple[SurfaceVerdict, list[Check]]:
    """Judge the chain of a surface at shaft angles phi (n,), rad: checks on contour, motion, play, linkage and dwell.

    With a linkage phi are relative angles for the plain frame's checks, and shaft angles for the mechanism's. `uneven`,
    mm, bounds the distance of a solid's other sections from this one; its effect is counted into all figures.
    `standing`, mm, is the metal that may stand outside the contour where a cutter does not reach.
    """
    # the motion of the gauge, and the play of the follower where that is another one
    contour, spline, slack = fine(chain.contour, limits.tolerance)
    judged, play, checks, gauge = None, None, [], surface.gauge
    try:
        judged = _less_sure(gauge.judge(contour, phi), gauge, uneven)
        play = judged.play
        if play is not None and surface.follower is not None:
            play = _less_sure(surface.follower.judge(contour, phi), surface.follower, uneven).play
        checks = _motion_checks(judged, play, surface, limits, slack)
    except (ContactError, UnsettledError) as error:
        checks = [failed("motion", str(error), unit=gauge.unit)]
    verdict = SurfaceVerdict(surface.name, chain.contour, judged and judged.motion, play, pieces=chain.pieces)
    envelope = gauge.envelope
    # the deviation: of convex contours from the support functions alone
    if judged and judged.reach and contour.is_convex and envelope.regular:
        strayed = convex_deviation(judged.reach)
    else:
        try:
            strayed = deviation(contour, envelope, spline or SPLINE_ERROR)
        except UnsettledError as error:
            unsettled = failed("contour", str(error), unit="mm", limit=limits.tolerance)
            return verdict, [_placed(unsettled, contour, envelope, limits.tolerance), *checks]
    if uneven:
        strayed = strayed.less_sure(uneven)
    verdict = replace(verdict, measured_error=strayed.worst[0])
    if linkage is not None:
        from kin.judge.linkage_checks import judge_linkage  # a plain follower does without

        driven, more = judge_linkage(contour, linkage, phi, limits, trimmed=surface.trimmed, slack=slack, uneven=uneven)
        verdict, checks = replace(verdict, linkage=driven), [*checks, *more]
    checked = _contour_check(strayed, surface, limits.tolerance, slack, standing)
    return verdict, [_placed(checked, contour, envelope, limits.tolerance), *checks]


def _placed(check: Check, contour: Contour, envelope: Envelope, tolerance: float) -> Check:
    """The check, if it fails with the place added at which the exact contour would fit the file's."""
    if check.ok or not envelope.regular:
        return check
    from kin.contour.placement import placement  # what is right does without

    elsewhere = placement(contour, envelope.points(PLACED), tolerance)
    return replace(check, detail=f"{marked(check.detail)}; {elsewhere}") if elsewhere else check


def fine(contour: Contour, tolerance: float) -> Fine:
    """Contour with arcs in place of its splines, and the distance of the arcs from the splines, mm.

    That is a small share of `tolerance`, mm, or less, but no less than rounding on a large part. A contour without
    splines comes back unchanged.
    """
    spline = 0.0
    if contour.beziers.count:
        least = ARC_SHARE * float(np.abs(contour.vertices).max())  # on a part of many metres rounding is coarser
        spline = max(min(SPLINE_ERROR, SPLINE_SHARE * tolerance), least)
        contour = contour if spline >= contour.spread else contour.within(spline)  # for rollers too
    return Fine(contour, spline, spline + ROUNDING * float(np.abs(contour.vertices).max()))


def _less_sure(judged: Judged, follower: Follower, uneven: float) -> Judged:
    """Motion and play with the effect of a contour that is off by `uneven`, mm, counted in."""
    if not uneven:
        return judged
    play, closure = judged.play, follower.closure
    if play is not None and closure is not None:
        play = play.less_sure(closure.limit(uneven))
    return judged._replace(motion=judged.motion.less_sure(follower.motion_limit(uneven)), play=play)


def _contour_check(
    deviation: Deviation, surface: SurfaceIntent, tolerance: float, slack: float, standing: float
) -> Check:
    """Check both sides of a contour against the tolerance; outside the metal may exceed it by `standing`, mm."""
    worst, parameter = deviation.worst
    if standing:
        worst = max(worst - standing, deviation.inside if surface.side > 0 else deviation.outside)
    outside, inside = (f"{length_words(off, '.3g')} {UNIT}" for off in (deviation.outside, deviation.inside))
    detail = f"{outside} outside, {inside} inside the exact contour"
    if deviation.rounds != 1:
        detail = f"the contour goes {deviation.rounds} times round the exact one; {detail}"
        return failed("contour", detail, unit="mm", limit=tolerance)
    if deviation.backwards > tolerance + slack:
        detail = f"the contour turns back on itself by {length_words(deviation.backwards, '.3g')} {UNIT}; {detail}"
        worst = max(worst, deviation.backwards)
    at = float(surface.gauge.shaft_angle(np.array([parameter]))[0])
    return at_most("contour", worst, tolerance, "mm", angle=at, detail=detail, slack=slack)


def _motion_checks(
    judged: Judged, own: Play | None, surface: SurfaceIntent, limits: Limits, slack: float
) -> list[Check]:
    """Checks on the motion and the play of the gauge; `own` is the play of the follower itself, which may be less."""
    follower, motion, play = surface.gauge, judged.motion, judged.play
    checks = []
    if limits.motion is not None or not surface.trimmed:
        limit, room = limit_of(follower.motion_limit, limits.motion, limits.tolerance, slack)
        # the implied limit is a theorem about contours; one that a user gives is held by all that may be, and so is
        # either where what the proof leaves open is more than rounding
        proved = motion.extremes == "sampled" or motion.remainder <= max(SPLINE_SHARE * limit, 2.0 * room)
        worst = motion.max if limits.motion is None and proved else motion.bound
        at, detail = np.radians(motion.at_deg), _found(motion)
        direct = follower.direct_limit(limits.tolerance)
        vacuous = limits.motion is None and is_loose(limit, direct, partial(stroke_of, follower))
        checked = at_most("motion", worst, limit, motion.unit, angle=at, detail=detail, slack=room)
        checks.append(unlimited(checked) if vacuous else checked)
    closure = follower.closure
    if play is None or own is None or closure is None or (limits.play is None and surface.trimmed):
        return checks
    held = play_checks(play, closure, follower, limits, slack, detail=closure.detail(play))
    if own is play:
        return [*checks, *held]
    return [*checks, *(beside_interference(check, play, own) for check in held)]


def beside_interference(check: Check, play: Play, own: Play) -> Check:
    """Rewrite a check on a gauge's play in terms of its follower, which runs with an interference.

    `play` is the gauge's, `own` the follower's. The check fails where the limit permits as much as the whole
    interference: such a limit limits nothing.
    """
    least, most = length_words(-own.most), f"{length_words(-own.least)} {UNIT}"
    if own.unit != "mm":
        least, most = f"{-own.most:.6g}", f"{-own.least:.6g} {own.unit}"
    interference, detail = play.least - own.least, f"interference from {least} to {most}"
    if check.limit is None or check.limit < interference:
        return replace(check, detail=detail)
    amount = amount_words(check.limit, check.unit, ".3g")
    permitted = f"{amount} would be permitted, as much as the interference; give a finer tolerance"
    return replace(check, ok=False, limit=None, detail=f"{permitted}; {detail}")


def play_checks(
    play: Play, closure: Closure, follower: Follower, limits: Limits, slack: float, *, detail: str
) -> list[Check]:
    """Check the play of a follower that is held from both sides: the worse of play and interference, against the limit.

    A closure with a name `tight` has a second check, of the interference alone. The limit is given, or implied by the
    tolerance; an implied limit that is too large fails the check.
    """
    permitted = limits.play
    if permitted is None and limits.motion is not None and closure.lever is not None:
        permitted = closure.lever * limits.motion
    limit, room = limit_of(closure.limit, permitted, limits.tolerance, slack)
    tight, loose = (-play.least, np.radians(play.least_at_deg)), (play.most, np.radians(play.most_at_deg))
    worst, at = max(tight, loose)
    if play.extremes == "sampled" and permitted is not None:
        worst += ALLOWANCE * abs(worst)
    direct = direct_play(closure, follower, limits.tolerance)
    vacuous = permitted is None and is_loose(limit, direct, lambda: closure.radius or stroke_of(follower))
    checked = at_most(closure.name, worst, limit, play.unit, angle=at, detail=detail, slack=room)
    checks = [unlimited(checked) if vacuous else checked]
    if closure.tight is not None:
        checks.append(at_most(closure.tight, tight[0], limit, play.unit, angle=tight[1], slack=room))
    return checks


def _found(motion: MotionError) -> str:
    """Words on how the greatest motion error was found, where a remainder is left."""
    if motion.extremes == "sampled":
        return f"sampled; {motion.remainder:.3g} {motion.unit} more is an estimate of what lies between"
    return f"true within {amount_words(motion.remainder, motion.unit, '.2g')}" if motion.remainder else ""
