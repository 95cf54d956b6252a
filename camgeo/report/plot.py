"""A plot of the page: curves over a turn."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from kin.numeric.arrays import Array


@dataclass(frozen=True, eq=False)
class Series:
    """Curve of a plot: values (STEPS + 1,) at equal steps of the angle."""

    name: str
    values: Array


@dataclass(frozen=True, eq=False)
class Plot:
    """Curves over the shaft angle or the relative angle, in `unit`, which is empty of counts.

    `limits` are lines across, pairs (value, name); with `dwells` the dwells are shaded; `note` stands below. `axis` is
    the quantity's name beside the upright axis, by default the title. That axis always spans the values of `holds`: 0
    for a force, the tolerance for an error.
    """

    title: str
    unit: str
    series: tuple[Series, ...]
    over: Literal["shaft", "relative"] = "shaft"
    limits: tuple[tuple[float, str], ...] = ()
    dwells: bool = False
    note: str = ""
    axis: str = ""
    holds: tuple[float, ...] = ()
