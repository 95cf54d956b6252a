"""Limits: given by the user, or implied by the tolerance where that limits anything."""

from __future__ import annotations

from typing import TYPE_CHECKING

from kin.numeric.lengths import amount_words, marked
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from collections.abc import Callable

    from kin.numeric.check import Check

# Arcs in place of a spline are within this share of the tolerance, and within SPLINE_ERROR, mm, as far as rounding
# lets them be.
SPLINE_SHARE, SPLINE_ERROR = 1e-3, 1e-9
# A limit that the tolerance implies is none where it is above this share of the stroke (of a play: of the rollers'
# radius), and so many times what the tolerance gives at a pressure angle of 0.
MOST_SHARE, STEEP = 0.1, 10.0
NO_LIMIT = "no limit follows from the tolerance here; give verify.motion_error"


@dataclass(frozen=True)
class Limits:
    """Permitted errors: `tolerance` of surfaces along their normals, mm; of the position, and of play or interference.

    `motion` and `play` are in the unit of the follower's position: mm or rad of a turning body, mm or degrees of a
    plate. None stands for the most that surfaces within the tolerance can cause. Ends in a plate's drawing that are
    within `gap`, mm, are joined; None for the readers' own gap.
    """

    tolerance: float
    motion: float | None = None
    play: float | None = None
    gap: float | None = None


def is_loose(limit: float, direct: float, size: Callable[[], float], share: float = MOST_SHARE) -> bool:
    """Whether a limit is too large to limit anything: above `share` of `size`, and over 10 times `direct`.

    `direct` is what the same tolerance permits at a pressure angle of 0.
    """
    return limit > STEEP * direct and limit > share * size()


def unlimited(check: Check) -> Check:
    """Turn a check into a failed one, since its implied limit is so large that it is no limit."""
    detail = f"{NO_LIMIT}; {amount_words(check.limit or 0.0, check.unit, '.3g')} would be permitted"
    return replace(check, ok=False, limit=None, detail=f"{detail}; {marked(check.detail)}" if check.detail else detail)


def limit_of(
    implied: Callable[[float], float], limit: float | None, tolerance: float, slack: float
) -> tuple[float, float]:
    """The limit, given or implied by the tolerance, and the excess that the judge's own rounding may cause.

    `implied(tolerance)` is the error, mm or degrees, that a contour within a tolerance, mm, can cause; `slack`, mm, is
    the rounding of the contour. The excess over a given limit is at most a small share of that limit.
    """
    by_tolerance = implied(tolerance)
    room = implied(tolerance + slack) - by_tolerance
    return (by_tolerance, room) if limit is None else (limit, min(room, SPLINE_SHARE * limit))
