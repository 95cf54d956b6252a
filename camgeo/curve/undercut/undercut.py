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
from camgeo.curve.curve import Curve, Run
from camgeo.curve.undercut.causes import Causes, UndercutError, causes, follower_radius, in_ring
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from camgeo.curve.curvature import Reversal
    from camgeo.curve.undercut.bottleneck import Neck
    from camgeo.curve.undercut.trim import Lost, Remains

MOST_TOLD = 200  # stretches that run backwards, of which the extent is found: a cam with more is no cam
LOOKS = 240  # parameters at which a neck is looked for where it is known to exist


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
    """Find all undercut of a whole curve, in order of the parameter; empty for a sound contour.

    A `Parallel` is a roller's contour inside its pitch curve, or outside it in a ring, which is looked at run through
    the other way; any other shape is that of a flat face. A stretch that is lost for both reasons is reported for each.
    Raises CurveError where freedom from undercut can be neither proved nor refuted, UndercutError where the extent
    cannot be found or more than `MOST_TOLD` stretches run backwards.

    What finds the extent is imported where there is one: most contours are sound.
    """
    if in_ring(curve):
        return _of_ring(curve)
    why = causes(curve)
    if not why.necks and all(r.still for r in why.reversals):
        return ()
    reverse = sum(not r.still for r in why.reversals)
    if reverse > MOST_TOLD * curve.shape.repeats:
        message = f"{reverse} stretches of the contour run backwards; up to {MOST_TOLD} are reported one by one"
        raise UndercutError(message, why.reversals[0].start, _free_at(curve, why))
    from camgeo.curve.undercut.trim import remains

    try:
        what = remains(curve, why)
    except UndercutError as error:
        raise UndercutError(str(error), error.parameter, _free_at(curve, why)) from error
    return stretches(curve, why, what)


def _of_ring(curve: Curve) -> tuple[Undercut, ...]:
    """Undercut of a ring in its own parameter."""
    from camgeo.curve.backwards import backwards

    try:
        inside = undercuts(backwards(curve))
    except UndercutError as error:
        raise error.mirrored() from error
    found = []
    for cut in inside:
        turns = math.floor(-cut.end / curve.shape.period) * curve.shape.period
        found.append(replace(cut, start=-cut.end - turns, end=-cut.start - turns, at=-cut.at - turns))
    return tuple(sorted(found, key=lambda cut: cut.start))


def stretches(curve: Curve, why: Causes, what: Remains) -> tuple[Undercut, ...]:
    """Tell the stretches that undercut of a curve whose causes and remains are found already."""
    found: list[Undercut] = []
    local: list[Undercut | None] = []
    repeats = curve.shape.repeats
    own = len(what.lost) // repeats if len(what.lost) % repeats == 0 else len(what.lost)
    for i, lost in enumerate(what.lost):
        inside = [r for r in why.reversals if not r.still and _within(curve, lost, 0.5 * (r.start + r.end))]
        necks = [n for n in why.necks if _within(curve, lost, n.first) or _within(curve, lost, n.second)]
        before = local[i - own] if i >= own else None
        mine = None
        if inside and before is not None:  # the curve's parts are alike
            at = before.at + curve.shape.period / repeats
            mine = replace(before, start=lost.start, end=lost.end, at=at, depth=lost.depth)
        elif inside:
            mine = _local(curve, lost, inside)
        local.append(mine)
        if mine is not None:
            found.append(mine)
        if necks:
            found.append(_global(curve, lost, min(necks, key=lambda n: n.half)))
        if not inside and not necks and not _still(curve, lost, why):
            found.append(_global(curve, lost, _neck_of(curve, lost)))
    return tuple(found) if why.open is None else tuple(_no_more(cut, why.open.least) for cut in found)


def _no_more(cut: Undercut, least: float) -> Undercut:
    return replace(cut, free_at=min(cut.free_at, least))


def _free_at(curve: Curve, why: Causes) -> float:
    """The value at which all undercut would be free, whatever its extent."""
    least, roller = least_radius(curve)[0], follower_radius(curve)
    if math.isinf(roller):
        return -least
    return min([roller + least, *(n.half for n in why.necks), *([] if why.open is None else [why.open.least])])


def _within(curve: Curve, lost: Lost, t: float) -> bool:
    return (t - lost.start) % curve.shape.period <= lost.end - lost.start


def _still(curve: Curve, lost: Lost, why: Causes) -> bool:
    return any(r.still and _within(curve, lost, 0.5 * (r.start + r.end)) for r in why.reversals)


def _local(curve: Curve, lost: Lost, inside: list[Reversal]) -> Undercut:
    from camgeo.curve.undercut.self_intersection import all_breaks

    least, at = math.inf, lost.start
    for r in inside:
        breaks = tuple(all_breaks(curve, r.start, r.end).tolist())
        radius, where = least_radius(Curve(curve.shape, (Run(r.start, r.end, breaks, closed=False),)))
        if radius < least:
            least, at = radius, where
    roller = follower_radius(curve)
    return Undercut("local", lost.start, lost.end, at, lost.depth, -least if math.isinf(roller) else roller + least)


def _global(curve: Curve, lost: Lost, neck: Neck) -> Undercut:
    at = neck.first if _within(curve, lost, neck.first) else neck.second
    return Undercut("global", lost.start, lost.end, at, lost.depth, neck.half)


def _neck_of(curve: Curve, lost: Lost) -> Neck:
    """Neck for which a stretch is lost that is nowhere bent too much: the least rolling radius on it."""
    from camgeo.curve.undercut.bottleneck import neck_from, rolling_radius
    from camgeo.curve.undercut.pairs import Pitch

    radius = follower_radius(curve)
    if math.isinf(radius):  # a flat face has no necks: a reversal was not found where contact is lost for it
        where = f"near parameter {lost.start:.9g}"
        raise UndercutError(f"the stretches of the contour that run backwards cannot be separated {where}", lost.start)
    pitch = Pitch.of(curve)
    t = np.linspace(lost.start, lost.end, LOOKS)
    s = curve.runs[0].low + curve.shape.period * np.arange(4 * LOOKS) / (4 * LOOKS)
    seen = rolling_radius(pitch, t, s)
    apart = np.abs((t[:, None] - s + 0.5 * curve.shape.period) % curve.shape.period - 0.5 * curve.shape.period)
    seen[apart < 0.5 * (s[1] - s[0])] = np.inf  # next to each other on the curve: rounding, and no neck
    first, second = np.unravel_index(int(np.argmin(seen)), seen.shape)
    neck = neck_from(pitch, float(t[first]), float(s[second]))
    if neck is None or not neck.half < radius:
        raise UndercutError(f"no neck is found where contact is lost, near parameter {lost.start:.9g}", lost.start)
    return neck
