"""A motion through points: a quintic spline, periodic or at rest beside dwells."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from kin.law.normalised import IntentError
from kin.law.sources.ring import SAME_ANGLE, Dwelling, Samples, demand_whole, laid
from kin.law.sources.spline import Ends, through
from kin.numeric.lengths import INPUT, input_number, input_words

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kin.law.segment import Stretch
    from kin.law.sources.motion import Motion
    from kin.numeric.arrays import Array


MOST_POINTS = 1000  # the system of equations is dense
_LEAST = 3  # points of a motion without a dwell


def from_points(
    theta: Sequence[float] | Array,
    s: Sequence[float] | Array,
    total: float = 2 * math.pi,
    *,
    dwells: Sequence[tuple[float, float]] = (),
    around: int | None = 1,
    field: str = "motion.points",
    unit: float = 1.0,
) -> Motion:
    """Make the C4 quintic spline through displacements s (n,), mm or rad, at angles theta (n,), rad, in [0, total].

    Each of `dwells` gives the angles, rad, of a point and of the next one (beyond `total` over the end), both of one
    displacement: between them S rests, and S' = S'' = 0 at its ends. Without any, and `around` 1, the spline is
    periodic; with -1 it is fitted over two halves, the second one upside down; with None it rests at both ends.

    Raises IntentError for too few or too many points, numbers that are not finite, angles that do not rise, that lie
    outside [0, total] or do not fill it where the motion does not repeat, a repeating motion that does not close, and a
    dwell that no points bound. Messages have displacements divided by `unit`, mm or rad.
    """
    angles, values = np.asarray(theta, dtype=float), np.asarray(s, dtype=float)
    if angles.shape != values.shape or angles.ndim != 1 or len(angles) > MOST_POINTS:
        raise IntentError(f"points are at most {MOST_POINTS} pairs of an angle and a displacement", field)
    if not (np.isfinite(angles).all() and np.isfinite(values).all()):
        raise IntentError("angles and displacements are finite numbers", field)
    falls = np.flatnonzero(np.diff(angles) <= SAME_ANGLE)
    if len(falls):
        i = int(falls[0]) + 1
        before, here = angles[i - 1 : i + 1].tolist()
        problem = f"the {INPUT}s must rise; {input_number(here)} follows {input_words(before)}"
        raise IntentError(problem, f"{field}[{i}]")
    if len(angles) and (angles[0] < -SAME_ANGLE or angles[-1] > total + SAME_ANGLE):
        raise IntentError(f"the {INPUT}s lie between 0 and {input_words(total)}", field)
    if around == 1 and len(angles) > 1 and angles[-1] - angles[0] > total - SAME_ANGLE:
        if abs(values[-1] - values[0]) > 1e-9 * max(1.0, float(np.abs(values).max())):
            raise IntentError(
                f"the motion does not close: it is {values[0] / unit:.6g} at the first point, "
                f"{values[-1] / unit:.6g} a turn later; give both the same displacement",
                f"{field}[{len(values) - 1}]",
            )
        angles, values = angles[:-1], values[:-1]
    elif around == 1 and len(angles) and angles[-1] > total - SAME_ANGLE:  # a turn on it is the first
        angles, values = np.append(0.0, angles[:-1]), np.append(values[-1], values[:-1])
    # the fit, with the dwells as rows of equal displacement
    rows = Samples(angles, values, np.arange(len(angles)))
    demand_whole(rows, total, around, field)
    if len(angles) < (2 if dwells else _LEAST):
        raise IntentError(f"a motion needs {_LEAST} points, or two and a dwell", field)
    rests = sorted(_dwelling(rows, dwell, total, around, field=field, unit=unit) for dwell in dwells)
    return laid(rows, rests, total, around, _exact)


def _exact(rows: Samples, ends: Ends | None, between: tuple[float, float], /) -> tuple[Array, Sequence[Stretch]]:
    if ends is not None:
        return rows.theta, through(rows.theta, rows.s, ends)
    sites = np.append(rows.theta, between[1])
    return sites, through(sites, np.append(rows.s, rows.s[0]), None)


def _dwelling(
    rows: Samples, dwell: tuple[float, float], total: float, around: int | None, *, field: str, unit: float
) -> Dwelling:
    n, ends = len(rows.theta), []
    for angle in dwell:
        turns = math.floor((angle + SAME_ANGLE) / total) if around == 1 else 0
        i = int(np.argmin(np.abs(rows.theta - (angle - turns * total))))
        if abs(rows.theta[i] - (angle - turns * total)) > SAME_ANGLE:
            raise IntentError(f"no point stands at {input_words(angle)}, where a dwell ends", field)
        ends.append(i + turns * n)
    first, last = (ends[0] - n, ends[1] - n) if ends[0] >= n else ends
    if last != first + 1:
        ends_of = f"from {input_number(dwell[0])} to {input_number(dwell[1])}"
        raise IntentError(f"a dwell runs from a point to the next; {ends_of} is none", field)
    a, b = float(rows.s[first % n]), float(rows.s[last % n])
    if a != b:
        climb = f"{a / unit:.6g} to {b / unit:.6g}"
        ends_of = f"from {input_number(dwell[0])} to {input_words(dwell[1])}"
        raise IntentError(f"no dwell {ends_of}: it would climb from {climb}", field)
    return Dwelling(first, last, a)
