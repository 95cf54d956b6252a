"""What a sweep asks of other capabilities."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple, Protocol

from camgeo.registry.slot import EMPTY, Slot
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from camgeo.recipe.recipe import Recipe
    from kin.numeric.arrays import Array


class SampledCams(Protocol):
    """Cams of m designs, each sampled at n places, of which a sweep estimates figures (m,) in mm and degrees."""

    @property
    def recipe(self) -> Recipe:
        """The recipe whose cam varies."""

    def most(self, rows: Array) -> Array:
        """Greatest value of rows (m, n) over the turn, (m,)."""

    def peak(self, order: int, speed: float = 1.0) -> Array:
        """Greatest value of a derivative of the motion by the shaft angle, or by time at a speed in rad/s, (m,).

        The motion is in mm or degrees; `order` is that of the derivative.
        """

    @property
    def slope(self) -> Array:
        """Tangent of the pressure angle, above 0 on the rise, (m, n)."""

    @property
    def lean(self) -> Array | None:
        """Tangent of the pressure angle at rest, (m,); None without a stem."""


class Estimate(NamedTuple):
    """Estimate of a figure of m cams: `of` gives it (m,).

    `error` is the greatest error seen, in degrees with `in_degrees`, else as a share of the figure; None where the
    estimate is exact.
    """

    of: Callable[[SampledCams], Array]
    error: float | None = None
    in_degrees: bool = False


@dataclass(frozen=True, kw_only=True)
class Estimates:
    """Answers of a capability whose figures a sweep estimates of many cams at once: by name."""

    estimates: Mapping[str, Estimate] = EMPTY


ESTIMATES = Slot("sweep", Estimates())
