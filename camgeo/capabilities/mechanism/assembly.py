"""The bodies of a printable mechanism: plates one on another, exact places over the shaft angle, and fits.

All in mm and rad, z upward, for a shaft that turns clockwise; for the other sense the bodies are mirrored last.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from kin.numeric.angles import TURN
from kin.numeric.records import dataclass, field

if TYPE_CHECKING:
    from collections.abc import Callable

    from camgeo.capabilities.mechanism.sizes import Sizes
    from camgeo.fit.pieces import ArcSpline, Polygon
    from kin.numeric.arrays import Array

    Place: TypeAlias = Callable[[Array, int], Array]
    """Shaft angles (n,) and an order to x, y and angle with their derivatives by the shaft angle, (3, order + 1, n)."""

NAME = re.compile(r"[a-z0-9]+(-[a-z0-9]+)*")
COLOUR = re.compile(r"#[0-9a-f]{6}")
STEPS = 360  # of a turn, at which files state the places of bodies
GROUND = "ground"


@dataclass(frozen=True, eq=False)
class Plate:
    """A horizontal slab from z `low` to `high`, mm: an outline with holes, all counter-clockwise.

    Raises ValueError for a slab without height.
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
    pose     (n + 1, 3): x, y and angle of its axes at equal steps of one shaft turn; (1, 3) of a body at rest
    fixed    whether the body is at rest
    colour   "#rrggbb", for viewers

    Raises ValueError for another name, colour or shape of the pose, a pose that is not finite, and without plates.
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


@dataclass(frozen=True, eq=False)
class Member:
    """A body with its exact place over the shaft angle, None for a body at rest.

    Members of one `group` are pressed together and move as one.
    """

    name: str
    plates: tuple[Plate, ...]
    group: str
    place: Place | None = None
    colour: str = "#9aa5b1"

    def body(self, steps: int = STEPS) -> PrintBody:
        """The printed body, with its poses at `steps` equal steps of a turn.

        Raises ValueError for a faulty name or colour, a member without plates, and poses that are not finite.
        """
        return PrintBody(self.name, self.plates, self.poses(steps), self.place is None, self.colour)

    def poses(self, steps: int = STEPS) -> Array:
        """Poses x, y and angle (steps + 1, 3) over a turn, mm and rad, the angle without leaps; (1, 3) at rest."""
        if self.place is None:
            return np.zeros((1, 3))
        poses = self.place(TURN * np.arange(steps + 1) / steps, 0)[:, 0].T.copy()
        poses[:, 2] = np.unwrap(poses[:, 2])
        return poses


@dataclass(frozen=True)
class BodyFit:
    """The fit of two bodies: the `clearance` between them, mm, or of `pressed` bodies their interference, above 0 too.

    `excess` is by how much the shaft is wider than the opening in which it would turn if it slipped, mm; None for other
    bodies, and for a shaft that is pressed in.
    """

    name: str
    clearance: float
    pressed: bool = False
    excess: float | None = None


@dataclass(frozen=True, eq=False)
class Assembly:
    """All bodies of a mechanism, the cam first, with their fits by construction.

    `touching` are pairs of names of bodies that touch by design; `remarks` are sentences on what bodies do not show.
    """

    members: tuple[Member, ...]
    fits: tuple[BodyFit, ...]
    sizes: Sizes
    touching: frozenset[frozenset[str]] = frozenset()
    remarks: tuple[str, ...] = ()
