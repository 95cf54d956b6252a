"""One check of a verdict: what was measured, what is allowed, and where."""

from __future__ import annotations

import math
from typing import Literal

from kin.numeric.angles import degrees
from kin.numeric.lengths import FIRST, Words, amount_words, marked
from kin.numeric.lengths import mirrored as mirrored_words
from kin.numeric.records import dataclass, replace

Sense = Literal["at_least", "at_most"]
ROUNDING = 1e-12  # of the judge itself, as a share of the extent; a value this far above its limit still holds


@dataclass(frozen=True)
class Check:
    """A figure compared with its limit.

    `value` is None where there was nothing to measure (a file that cannot be read); such a check does not hold, and
    `detail` says why. `at` is the input at the worst place in `at_unit`, such as the shaft angle in [0, 360) deg, None
    where there is no such place. `surface` is the name of the surface concerned, empty where the cam has one surface or
    none is concerned.
    """

    name: str
    ok: bool
    value: float | None
    limit: float | None
    unit: str
    at: float | None = None
    sense: Sense = "at_most"
    file: str | None = None
    detail: str = ""
    surface: str = ""
    at_unit: str = "deg"

    def __post_init__(self) -> None:
        """Show the lengths of `detail` in mm; `kin.numeric.lengths.in_unit` gives them in another unit."""
        if FIRST in self.detail:
            object.__setattr__(self, "detail", Words(self.detail))

    @property
    def at_deg(self) -> float | None:
        """Shaft angle of the worst place, [0, 360) degrees; None without one, or where the input is no angle."""
        return self.at if self.at_unit == "deg" else None


def at_most(
    name: str,
    value: float,
    limit: float,
    unit: str,
    *,
    angle: float | None = None,
    detail: str = "",
    slack: float = 0.0,
) -> Check:
    """Check that `value` does not exceed `limit`; `angle` is a shaft angle in radians. A value that is nan fails.

    `slack` is the rounding of the measurement, by which `value` may exceed the limit.
    """
    measured = None if math.isnan(value) else float(value)
    at_deg = None if angle is None or not math.isfinite(angle) else degrees(angle)
    return Check(name, bool(value <= limit + slack), measured, float(limit), unit, at_deg, detail=detail)


def failed(name: str, detail: str, *, unit: str = "", limit: float | None = None) -> Check:
    """Build a check that fails for a reason, `detail`, without a measured value."""
    return Check(name, ok=False, value=None, limit=limit, unit=unit, detail=detail)


def less_sure(check: Check, by: float) -> Check:
    """Give an `at_most` check with its value greater by `by`, for heights of a solid that differ through rounding.

    `by` is in the unit of the check. With `by` 0, or without a value or a limit, the check is returned as it is.
    """
    if not by or check.value is None or check.limit is None:
        return check
    value = check.value + by
    why = f"heights differ by up to {amount_words(by, check.unit, '.3g')} through rounding"
    detail = f"{marked(check.detail)}; {why}" if check.detail else why
    return replace(check, ok=check.ok and value <= check.limit, value=value, detail=detail)


def as_drawn(check: Check, *, mirrored: bool) -> Check:
    """Give the check with its places and turns in the axes of the file, which is drawn mirrored or not."""
    if not mirrored or not check.detail:
        return check
    return replace(check, detail=mirrored_words(marked(check.detail)))


def about(check: Check, file: str) -> Check:
    """Give the check with the name of the file that it concerns."""
    return replace(check, file=file)
