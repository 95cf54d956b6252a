"""What a recipe says of the part round the contour: lengths in mm, angles in radians from the zero of the motion.

Angles are counter-clockwise in the cam's own axes, in which the shaft angle counts: at 0 lies the ray that points to
the face whose lift is told, or to the follower's pivot, when the shaft angle is 0. `rotation: ccw` mirrors them with
the contour.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal


@dataclass(frozen=True)
class Keyway:
    """A keyway in a round bore: `depth` is t2 of DIN 6885, from the bore's circle to the floor; `at` its middle.

    `standard` is whether width and depth are those of that standard by the bore.
    """

    width: float
    depth: float
    at: float = 0.0
    standard: bool = False


@dataclass(frozen=True)
class Flat:
    """A flat of a D-shaped bore, `across` from the opposite side of the bore; `at` is the direction of its normal."""

    across: float
    at: float = 0.0


@dataclass(frozen=True)
class Hub:
    """A round hub about the shaft: `height` beyond the face of the disc, on one side or on both."""

    diameter: float
    height: float
    side: Literal["top", "bottom", "both"] = "top"


@dataclass(frozen=True)
class SetScrew:
    """A radial hole from the hub's outside into the bore, `height` above the face of the disc (None: half the hub)."""

    diameter: float
    at: float = 0.0
    height: float | None = None


@dataclass(frozen=True)
class Bolts:
    """Equal round holes at equal angles; `circle` is the diameter that their centres lie on, `hole` their own."""

    count: int
    circle: float
    hole: float
    start: float = 0.0


@dataclass(frozen=True)
class Dowel:
    """One round hole of diameter `hole`, its centre on a circle of diameter `circle`."""

    circle: float
    hole: float
    at: float = 0.0


@dataclass(frozen=True)
class Lightening:
    """Round holes that are placed where there is room, `wall` from every edge; none smaller than `least` across.

    `ring` equal ones at equal angles from `start`, or up to `largest` of them, each the largest that still fits.
    """

    wall: float
    ring: int | None = None
    largest: int | None = None
    least: float | None = None
    start: float = 0.0


@dataclass(frozen=True)
class Mark:
    """A slot on the ray at 0, engraved into the upper face or cut through; `radius` is that of its outer end.

    Without a radius the slot lies as far out as the wall lets it.
    """

    kind: Literal["engrave", "cut"] = "engrave"
    width: float = 0.5
    length: float = 4.0
    depth: float = 0.3
    radius: float | None = None


@dataclass(frozen=True)
class Part:
    """The part round the contour, mm.

    `thickness` of the disc along the shaft. `bore` is a diameter, or the width across flats where `sides` (4 or 6) are
    given; `bore_at` is then the direction of one flat's normal. `wall` is the least that may be left between any two
    edges; without it what is left is told and must be above 0.
    """

    thickness: float | None = None
    bore: float | None = None
    sides: int = 0
    bore_at: float = 0.0
    keyway: Keyway | None = None
    flat: Flat | None = None
    hub: Hub | None = None
    set_screw: SetScrew | None = None
    bolts: Bolts | None = None
    dowel: Dowel | None = None
    lightening: Lightening | None = None
    chamfer: float | None = None
    mark: Mark | None = None
    wall: float | None = None

    @property
    def plain(self) -> bool:
        """Whether there is nothing but a round bore or none."""
        shaped = (self.keyway, self.flat, self.hub, self.bolts, self.dowel, self.lightening, self.chamfer, self.mark)
        return not self.sides and all(feature is None for feature in shaped)
