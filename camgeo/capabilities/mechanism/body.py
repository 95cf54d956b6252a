"""A printable body: horizontal plates, one on or in another, and where it stands over one turn of the shaft.

All in mm and rad, z upward, drawn as for a shaft that turns clockwise: who writes a file mirrors last.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

import numpy as np

from kin.numeric.records import dataclass, field

if TYPE_CHECKING:
    from camgeo.fit.pieces import ArcSpline, Polygon
    from kin.numeric.arrays import Array

NAME = re.compile(r"[a-z0-9]+(-[a-z0-9]+)*")
COLOUR = re.compile(r"#[0-9a-f]{6}")


@dataclass(frozen=True, eq=False)
class Plate:
    """A horizontal slab from z `low` to `high`: an outline with holes in it, counter-clockwise all of them.

    The outline may be a polygon, which is taken as it stands. Raises ValueError for a slab without height.
    """

    outline: ArcSpline | Polygon
    holes: tuple[ArcSpline, ...]
    low: float
    high: float

    def __post_init__(self) -> None:
        if not (np.isfinite([self.low, self.high]).all() and self.low < self.high):
            raise ValueError(f"a plate from z = {self.low!r} to {self.high!r} mm has no height")


@dataclass(frozen=True, eq=False)
class PrintBody:
    """A body of one piece: the union of its plates, in axes of its own.

    name     safe in file names: lower-case words joined by hyphens, such as "roller-a"
    plates   stacked, touching or overlapping
    pose     (n + 1, 3): x, y and angle of its axes at equal steps of one shaft turn, or (1, 3) for one standing still
    fixed    part of the ground
    colour   "#rrggbb", for viewers

    Raises ValueError for a name, colour or shape that is none of these, and for a body without plates.
    """

    name: str
    plates: tuple[Plate, ...]
    pose: Array = field(default_factory=lambda: np.zeros((1, 3)))
    fixed: bool = False
    colour: str = "#9aa5b1"

    def __post_init__(self) -> None:
        if not NAME.fullmatch(self.name):
            raise ValueError(f"{self.name!r} is not a name for a body: lower-case words joined by hyphens")
        if not self.plates:
            raise ValueError(f"{self.name}: a body without plates")
        if self.pose.ndim != 2 or self.pose.shape[1] != 3 or not len(self.pose) or not np.isfinite(self.pose).all():
            raise ValueError(f"{self.name}: the pose must be finite, of shape (n + 1, 3) or (1, 3)")
        if not COLOUR.fullmatch(self.colour):
            raise ValueError(f"{self.name}: {self.colour!r} is not a colour such as #9aa5b1")

    @property
    def low(self) -> float:
        """Least z, mm."""
        return min(plate.low for plate in self.plates)

    @property
    def high(self) -> float:
        """Greatest z, mm."""
        return max(plate.high for plate in self.plates)
