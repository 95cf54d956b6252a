"""What a recipe says of a search among designs: plain values, all as the recipe writes them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal


@dataclass(frozen=True)
class Axis:
    """One number that a sweep varies, by its path in the recipe; all values as the recipe writes them.

    `values` are those listed; where there are none the axis runs from `low` to `high`, over a grid in `steps` values.
    """

    path: str
    low: float = 0.0
    high: float = 0.0
    steps: int | None = None
    values: tuple[float, ...] = ()


@dataclass(frozen=True)
class Limit:
    """Bounds of a figure, as figures are told: angles in degrees, lengths in mm, rates per radian of shaft angle."""

    figure: str
    at_least: float | None = None
    at_most: float | None = None


@dataclass(frozen=True)
class Sweep:
    """A search among designs: `count` of them, or of a grid (count None) every combination of the axes' values.

    `rank` is the figure to be best in, `keep` the number of best designs that become recipes, `angles` the number of
    angles at which a design is sampled, `refine` whether the best are polished.
    """

    vary: tuple[Axis, ...]
    method: Literal["grid", "random", "sobol"]
    count: int | None
    seed: int
    limits: tuple[Limit, ...]
    rank: str
    keep: int
    angles: int
    refine: bool
