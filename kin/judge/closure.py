"""Play of a follower between two surfaces, over the whole turn and from both contours as they lie in files.

One surface pushes the follower out, the other stops it: the flanks of a groove, the discs of a conjugate pair. The
gauges of both should stand at one position, so their intended play is 0; the follower itself has its clearance besides.
Both positions are smooth between breaks, and so is their difference.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from kin.follower.base import Closure
from kin.follower.drive import extremes_between
from kin.follower.motion_error import ContactError, Play
from kin.judge.contour_checks import beside_interference, fine, play_checks
from kin.judge.verdict import ClosureVerdict
from kin.numeric.angles import degrees
from kin.numeric.check import Check, failed
from kin.numeric.errors import UnsettledError

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kin.contour.contour import Contour
    from kin.follower.base import Follower
    from kin.follower.drive import Excitation
    from kin.judge.intent import ClosureIntent, Limits, SurfaceIntent
    from kin.numeric.arrays import Array

Surface = tuple["SurfaceIntent", "Contour"]


def judge_closures(
    surfaces: Sequence[Surface], closures: Sequence[ClosureIntent], limits: Limits, uneven: float = 0.0
) -> tuple[tuple[ClosureVerdict, ...], list[Check]]:
    """Judge the play between pairs of surfaces, of one file or of several, in mm and as if not mirrored.

    Each verdict and its checks stand in the order of `closures`; a closure without both surfaces is left out, and one
    whose follower finds no contact has a failed check alone. `uneven`, mm, bounds the distance of a solid's other
    sections from either contour; its effect is counted into the play.
    """
    by_name = {surface.name: (surface, contour) for surface, contour in surfaces}
    verdicts, checks = [], []
    for closure in closures:
        if not {closure.pushes, closure.stops} <= set(by_name):
            continue
        pair = by_name[closure.pushes], by_name[closure.stops]
        try:
            verdict, more = _judge_closure(closure, pair, limits, uneven)
        except (ContactError, UnsettledError) as error:
            checks.append(failed(closure.name, str(error), unit=pair[0][0].gauge.unit))
            continue
        verdicts.append(verdict)
        checks += more
    return tuple(verdicts), checks


def _judge_closure(
    closure: ClosureIntent, pair: tuple[Surface, Surface], limits: Limits, uneven: float
) -> tuple[ClosureVerdict, list[Check]]:
    """Verdict on one closure, and its checks; the follower's own play is reported beside that of the gauges."""
    gauges = tuple(surface.gauge for surface, _ in pair)
    finer = [fine(contour, limits.tolerance) for _, contour in pair]
    rests = [_rests(gauge, side.contour) for gauge, side in zip(gauges, finer, strict=True)]
    size = max(float(np.abs(contour.vertices).max()) for _, contour in pair)

    def limit(tolerance: float) -> float:
        return sum(gauge.motion_limit(tolerance) for gauge in gauges)

    off = limit(uneven) if uneven else 0.0
    between = _play(rests[0], rests[1], gauges[0], size).less_sure(off)
    play = between
    if any(surface.follower is not None for surface, _ in pair):
        first, second = (
            _rests(surface.follower or surface.gauge, side.contour)
            for (surface, _), side in zip(pair, finer, strict=True)
        )
        play = _play(first, second, gauges[0], size).less_sure(off)
    judged_as = Closure(limit, closure.name, lever=2.0)
    slack = max(side.slack for side in finer)
    checks = play_checks(between, judged_as, gauges[0], limits, slack, detail=judged_as.detail(play))
    if play.least < between.least:  # the follower has less room than its gauges: a preload
        checks = [beside_interference(check, between, play) for check in checks]
    if limits.play is None and any(surface.trimmed for surface, _ in pair):
        checks = []
    return ClosureVerdict(closure.pushes, closure.stops, between, play), checks


def left_over(first: Surface, last: Surface, shaft: Array) -> Array:
    """Play of the follower between two surfaces at shaft angles (n,), mm or degrees, below 0 where it interferes.

    A curve to look at, without bounds. Raises ContactError where a follower finds no contact.
    """
    pushed, stopped = (_rests(surface.follower or surface.gauge, contour) for surface, contour in (first, last))
    gauge = first[0].gauge
    scale = float(np.degrees(1.0)) if gauge.unit == "deg" else 1.0 / gauge.si
    play: Array = scale * (stopped.rows(shaft)[0] - pushed.rows(shaft)[0])
    return play


def _rests(follower: Follower, contour: Contour) -> Excitation:
    """Position of the follower, m or rad, over the shaft angle as it rests on a surface."""
    (rest,) = follower.resting(contour)
    return rest


def _play(pushed: Excitation, stopped: Excitation, gauge: Follower, size: float) -> Play:
    """Least and greatest of `stopped` less `pushed` over the turn, as a play in mm or degrees."""
    ends = extremes_between(pushed, stopped, gauge.si * size if gauge.unit == "mm" else 1.0)
    scale = float(np.degrees(1.0)) if gauge.unit == "deg" else 1.0 / gauge.si
    least, most = (scale * ends.least, degrees(ends.least_at)), (scale * ends.greatest, degrees(ends.greatest_at))
    return Play(*least, *most, gauge.unit)
