"""Undercut: where the metal that a follower needs has been cut away by its own contact elsewhere (docs/theory.md 7).

Local undercut comes from bending: a radius of curvature below 0 for a flat face, below the roller's radius for a pitch
curve. Global undercut comes from a neck of the pitch curve narrower than the roller, however gently it is bent. Whether
there is any is proved (`reversals`, `narrowest_necks`); the extent and depth are those of the contour that is left.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Literal

import numpy as np

from camgeo.curve.curvature import least_radius
from camgeo.curve.curve import Curve, SmoothRun
from camgeo.curve.undercut.causes import Causes, UndercutError, causes, follower_radius, in_ring
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from camgeo.curve.curvature import Reversal
    from camgeo.curve.undercut.bottleneck import Neck
    from camgeo.curve.undercut.trim import LostStretch, Remains

MOST_REPORTED = 200  # stretches that run backwards whose extent is found; a cam with more is refused
LOOKS = 240  # parameters of a lost stretch at which its neck is sought


@dataclass(frozen=True)
class Undercut:
    """One stretch of the contour that undercuts.

    Contact is lost from parameter `start` to `end` (beyond `start`, perhaps beyond the period); `at` is where the
    radius of curvature is least (local) or one end of the neck (global). `depth` is how far the follower hangs free at
    the worst, in mm along its normal, infinite where nothing is left of the contour. `free_at`, in mm, is the value
    at which this stretch would just be free: the largest roller radius, or for a flat face by how much the base radius
    must grow. Where it was left open whether there are narrower necks, it is a radius that is proved to be free.
    """

    kind: Literal["local", "global"]
    start: float
    end: float
    at: float
    depth: float
    free_at: float


def undercuts(curve: Curve) -> tuple[Undercut, ...]:
    """All undercut of a whole curve, in order of the parameter; empty for a sound contour.

    A `Parallel` is a roller's contour inside its pitch curve, or outside it in a ring, which is examined in the reverse
    sense; a `CentreShape` is a knife edge's contour, any other shape a flat face's. A stretch that is lost for both
    reasons is reported for each. Raises CurveError where freedom from undercut can be neither proved nor refuted,
    UndercutError where the extent cannot be found or more than `MOST_REPORTED` stretches run backwards, and ValueError
    for a concave curve under a flat face.
    """
    if in_ring(curve):
        return _of_ring(curve)
    reasons = causes(curve)
    if not reasons.necks and all(r.still for r in reasons.reversals):
        return ()
    reverse = sum(not r.still for r in reasons.reversals)
    if reverse > MOST_REPORTED * curve.shape.repeats:
        message = f"{reverse} stretches of the contour run backwards; up to {MOST_REPORTED} are reported one by one"
        raise UndercutError(message, reasons.reversals[0].start, _free_at(curve, reasons))
    # imported here, as most contours are sound
    from camgeo.curve.undercut.trim import remains

    try:
        remainder = remains(curve, reasons)
    except UndercutError as error:
        raise UndercutError(str(error), error.parameter, _free_at(curve, reasons)) from error
    return stretches(curve, reasons, remainder)


def _of_ring(curve: Curve) -> tuple[Undercut, ...]:
    """Undercut of a ring in its own parameter."""
    from camgeo.curve.backwards import backwards

    try:
        reverse_cuts = undercuts(backwards(curve))
    except UndercutError as error:
        raise error.mirrored() from error
    cuts = []
    for cut in reverse_cuts:
        turns = math.floor(-cut.end / curve.shape.period) * curve.shape.period
        cuts.append(replace(cut, start=-cut.end - turns, end=-cut.start - turns, at=-cut.at - turns))
    return tuple(sorted(cuts, key=lambda cut: cut.start))


def stretches(curve: Curve, reasons: Causes, remainder: Remains) -> tuple[Undercut, ...]:
    """Stretches of a curve that undercut, in order of the parameter, from their causes and the contour that is left.

    Raises UndercutError where no cause is found for a lost stretch, and CurveError where a least radius is not proved.
    """
    cuts: list[Undercut] = []
    local: list[Undercut | None] = []
    repeats = curve.shape.repeats
    own = len(remainder.lost) // repeats if len(remainder.lost) % repeats == 0 else len(remainder.lost)
    # each lost stretch has the reversals and necks that lie within it as its causes
    for i, lost in enumerate(remainder.lost):
        inside = [r for r in reasons.reversals if not r.still and _within(curve, lost, 0.5 * (r.start + r.end))]
        necks = [n for n in reasons.necks if _within(curve, lost, n.first) or _within(curve, lost, n.second)]
        before = local[i - own] if i >= own else None
        cut = None
        if inside and before is not None:  # the curve's parts are alike
            place = before.at + curve.shape.period / repeats
            cut = replace(before, start=lost.start, end=lost.end, at=place, depth=lost.depth)
        elif inside:
            cut = _local(curve, lost, inside)
        local.append(cut)
        if cut is not None:
            cuts.append(cut)
        if necks:
            cuts.append(_global(curve, lost, min(necks, key=lambda n: n.half)))
        if not inside and not necks and not _still(curve, lost, reasons):
            cuts.append(_global(curve, lost, _neck_of(curve, lost)))
    least = math.inf if reasons.open is None else reasons.open.least
    return tuple(replace(cut, free_at=min(cut.free_at, least)) for cut in cuts)


def _free_at(curve: Curve, reasons: Causes) -> float:
    """The largest roller radius, mm, free of undercut all round, or by how much a flat face's base radius must grow."""
    least, roller = least_radius(curve)[0], follower_radius(curve)
    if math.isinf(roller):
        return -least
    return min(
        [roller + least, *(n.half for n in reasons.necks), *([] if reasons.open is None else [reasons.open.least])]
    )


def _within(curve: Curve, lost: LostStretch, t: float) -> bool:
    return (t - lost.start) % curve.shape.period <= lost.end - lost.start


def _still(curve: Curve, lost: LostStretch, reasons: Causes) -> bool:
    return any(r.still and _within(curve, lost, 0.5 * (r.start + r.end)) for r in reasons.reversals)


def _local(curve: Curve, lost: LostStretch, inside: list[Reversal]) -> Undercut:
    from camgeo.curve.undercut.self_intersection import all_breaks

    least, place = math.inf, lost.start
    for r in inside:
        breaks = tuple(all_breaks(curve, r.start, r.end).tolist())
        radius, parameter = least_radius(Curve(curve.shape, (SmoothRun(r.start, r.end, breaks, closed=False),)))
        if radius < least:
            least, place = radius, parameter
    roller = follower_radius(curve)
    return Undercut("local", lost.start, lost.end, place, lost.depth, -least if math.isinf(roller) else roller + least)


def _global(curve: Curve, lost: LostStretch, neck: Neck) -> Undercut:
    place = neck.first if _within(curve, lost, neck.first) else neck.second
    return Undercut("global", lost.start, lost.end, place, lost.depth, neck.half)


def _neck_of(curve: Curve, lost: LostStretch) -> Neck:
    """Neck that costs a stretch nowhere bent too much: the least rolling radius along the stretch.

    Raises UndercutError for a flat face, which has no necks, and where no neck narrower than the roller is found.
    """
    from camgeo.curve.undercut.bottleneck import neck_from, rolling_radius
    from camgeo.curve.undercut.pairs import Pitch

    radius = follower_radius(curve)
    if math.isinf(radius):  # a flat face has no necks: a reversal was not found where contact is lost for it
        place = f"near parameter {lost.start:.9g}"
        raise UndercutError(f"the stretches of the contour that run backwards cannot be separated {place}", lost.start)
    pitch = Pitch.of(curve)
    t = np.linspace(lost.start, lost.end, LOOKS)
    s = curve.runs[0].low + curve.shape.period * np.arange(4 * LOOKS) / (4 * LOOKS)
    radii = rolling_radius(pitch, t, s)
    apart = np.abs((t[:, None] - s + 0.5 * curve.shape.period) % curve.shape.period - 0.5 * curve.shape.period)
    radii[apart < 0.5 * (s[1] - s[0])] = np.inf  # next to each other on the curve: rounding, and no neck
    first, second = np.unravel_index(int(np.argmin(radii)), radii.shape)
    neck = neck_from(pitch, float(t[first]), float(s[second]))
    if neck is None or not neck.half < radius:
        raise UndercutError(f"no neck is found where contact is lost, near parameter {lost.start:.9g}", lost.start)
    return neck
