"""How far a fitted contour may lie from the exact one."""

from __future__ import annotations

import math

from kin.numeric.records import dataclass

Box = tuple[float, float, float, float]


@dataclass(frozen=True)
class Bound:
    """Proved greatest deviation from the exact curve in mm: outward of it and inward of it, both >= 0.

    Raises ValueError for a negative or non-finite figure.
    """

    outward: float
    inward: float

    def __post_init__(self) -> None:
        for side, value in (("outward", self.outward), ("inward", self.inward)):
            if not (math.isfinite(value) and value >= 0.0):
                raise ValueError(f"bound: {side} must be finite and >= 0, not {value!r}")

    @property
    def worst(self) -> float:
        """The larger of the two sides, in mm."""
        return max(self.outward, self.inward)

    def scaled(self, k: float) -> Bound:
        """Return the bound in a drawing k times as large."""
        return Bound(k * self.outward, k * self.inward)

    def widened(self, margin: float) -> Bound:
        """Return the bound after every point may have moved by `margin` mm more (rounding to a file's precision)."""
        return Bound(self.outward + margin, self.inward + margin)

    def wider(self, other: Bound) -> Bound:
        """Return the greater of both on each side: what holds of two contours."""
        return Bound(max(self.outward, other.outward), max(self.inward, other.inward))


EXACT = Bound(0.0, 0.0)
