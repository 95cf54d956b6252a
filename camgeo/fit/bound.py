"""Proved bound of a fitted contour's deviation from the exact one."""

from __future__ import annotations

import math

from kin.numeric.records import dataclass

Box = tuple[float, float, float, float]


@dataclass(frozen=True)
class Bound:
    """Proved greatest deviation of a fit from the exact curve, mm: outward and inward of the curve, both >= 0.

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
        """The larger deviation of the two sides, mm."""
        return max(self.outward, self.inward)

    def scaled(self, k: float) -> Bound:
        """The bound in a drawing k times as large, k > 0."""
        return Bound(k * self.outward, k * self.inward)

    def widened(self, margin: float) -> Bound:
        """The bound after every point may have moved by `margin` mm more, as by rounding in a file."""
        return Bound(self.outward + margin, self.inward + margin)

    def wider(self, other: Bound) -> Bound:
        """The greater deviation of two bounds on each side: a bound for both contours."""
        return Bound(max(self.outward, other.outward), max(self.inward, other.inward))


EXACT = Bound(0.0, 0.0)
