"""The checks on a mechanism that a cam drives: the error of its output, and the length of its dwells."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from kin.follower.frame import FrameError, implied_limit, judge_frame
from kin.linkage.loop import BindingError
from kin.numeric.check import Check, at_most, failed
from kin.numeric.lengths import amount_words, span_words

if TYPE_CHECKING:
    from kin.contour.contour import Contour
    from kin.follower.frame import DwellFound, LinkageVerdict
    from kin.judge.intent import DwellAsked, Limits, LinkageIntent
    from kin.linkage.mechanism import Mechanism
    from kin.numeric.arrays import Array

DWELL_ROUNDING = 1e-7  # degrees; the ends of a dwell are found to this


def judge_linkage(
    contour: Contour,
    linkage: LinkageIntent,
    phi: Array,
    limits: Limits,
    *,
    trimmed: bool,
    slack: float,
    uneven: float,
) -> tuple[LinkageVerdict | None, list[Check]]:
    """Judge how a contour drives the mechanism: checks linkage-error and, if the dwell must last, dwell.

    `phi` (n,), rad, are shaft angles. `slack`, mm, is the rounding of the contour; `uneven`, mm, bounds the distance of
    a solid's other sections from it. A contour that does not drive the mechanism gives None and failed checks; of a
    `trimmed` one the output is judged against a given limit alone.
    """
    mechanism, dwell = linkage.mechanism, linkage.dwell
    at_least = None if dwell is None or dwell.at_least is None else float(np.degrees(dwell.at_least))
    try:
        off = _output_less_sure(mechanism, uneven)
        verdict = judge_frame(
            contour,
            mechanism,
            phi,
            limits.tolerance,
            swing=linkage.swing,
            band=None if dwell is None else _band_less_sure(dwell, mechanism, off),
            over="shaft" if dwell is None else dwell.over,
            overlap=linkage.overlap,
        )
        if uneven:
            verdict = replace(
                verdict,
                error=verdict.error.less_sure(off),
                centred=verdict.centred.less_sure(off),
                play_across=verdict.play_across.less_sure(2.0 * uneven),
                play_along=verdict.play_along.less_sure(2.0 * uneven),
                dwells=tuple(replace(row, band=row.band + 2.0 * off) for row in verdict.dwells),
            )
    except (FrameError, BindingError) as problem:
        what = str(problem) if isinstance(problem, FrameError) else f"the intended mechanism: {problem}"
        checks = [failed("linkage-error", what, unit=mechanism.unit, limit=limits.output)]
        if at_least is not None:
            checks.append(replace(failed("dwell", what, unit="deg", limit=at_least), sense="at_least"))
        return None, checks
    checks = []
    if limits.output is not None or not trimmed:
        checks.append(_output_check(verdict, limits, slack))
    if at_least is not None:
        checks.append(_dwell_check(verdict.dwells[0], mechanism.unit, at_least))
    return verdict, checks


def _output_less_sure(mechanism: Mechanism, uneven: float) -> float:
    """Greatest error of the output, mm or degrees, that a contour off by `uneven`, mm, can cause.

    Raises FrameError where the mechanism binds within that.
    """
    off = implied_limit(mechanism, uneven) if uneven else 0.0
    if off is None:
        raise FrameError(f"the mechanism binds within the {uneven:.3g} mm by which the solid's sections differ")
    return off


def _band_less_sure(dwell: DwellAsked, mechanism: Mechanism, off: float) -> float:
    """Band of the dwell, rad or mm, less the errors `off`, degrees or mm, by which the output may stray either way.

    Raises FrameError where nothing of the band is left.
    """
    band = dwell.band - 2.0 * (float(np.radians(off)) if mechanism.unit == "deg" else off)
    if band <= 0.0:
        raise FrameError(
            f"the output may be off by {off:.3g} {mechanism.unit}, which leaves nothing of the dwell's band"
        )
    return band


def _output_check(linkage: LinkageVerdict, limits: Limits, slack: float) -> Check:
    error, across, along = linkage.error, linkage.play_across, linkage.play_along
    centred = amount_words(linkage.centred.max, error.unit, ".3g")
    detail = (
        f"{centred} with the frame centred; "
        f"backlash {span_words(across.least, across.most, '.3g')} across, "
        f"{span_words(along.least, along.most, '.3g')} along the frame"
    )
    limit = linkage.limit if limits.output is None else limits.output
    if limit is None:
        detail = f"the mechanism binds within the tolerance, which thus implies no limit; {detail}"
        return Check("linkage-error", ok=False, value=error.max, limit=None, unit=error.unit, detail=detail)
    room = 0.0 if linkage.limit is None else linkage.limit * slack / limits.tolerance
    at = np.radians(error.at_deg)
    return at_most("linkage-error", error.max, limit, error.unit, angle=at, detail=detail, slack=room)


def _dwell_check(shortest: DwellFound, unit: str, at_least: float) -> Check:
    """Check that `shortest`, a dwell, lasts `at_least` degrees.

    It is the longest dwell in the way of resting in which dwells are shortest. `unit` is the unit of its band.
    """
    ok, over = shortest.length_deg >= at_least - DWELL_ROUNDING, shortest.over
    at = shortest.start_deg if over == "shaft" else None
    where = f"from {shortest.start_deg:.6g} degrees of the {over} angle"
    detail = f"{where}, within {amount_words(shortest.band, unit)}, {shortest.rest}"
    return Check("dwell", ok, shortest.length_deg, at_least, "deg", at, "at_least", detail=detail)
