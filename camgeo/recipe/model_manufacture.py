"""How a recipe's part is milled, and what a file's contour is moved by."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal


@dataclass(frozen=True)
class Manufacture:
    """Milling, in mm, mm a minute, turns a minute and radians; figures that only a program needs are None without one.

    `allowance` is left by all passes but a last one at full depth. `unreached` is how deep metal may be left where the
    cutter does not reach.
    """

    cutter: float
    feed: float | None = None
    plunge: float | None = None
    spindle: float | None = None
    depth_of_cut: float | None = None
    safe_height: float | None = None
    lead_in: float | None = None
    direction: Literal["climb", "conventional"] = "climb"
    allowance: float | None = None
    start: float = 0.0
    holes: bool = False
    unreached: float = 0.0
    layer: bool = False

    @property
    def radius(self) -> float:
        """Radius of the cutter, mm."""
        return 0.5 * self.cutter

    @property
    def lead(self) -> float:
        """Radius of the arcs of lead-in and lead-out, mm."""
        return self.radius if self.lead_in is None else self.lead_in


@dataclass(frozen=True)
class Compensation:
    """What a file's part is made different by: `kerf` (a cut's whole width) and `clearance` in mm, `shrinkage` a share.

    A cut along the drawn lines takes half its width from the part, so the metal is drawn larger by that; clearance is
    taken from it all round. What shrinks is drawn larger by 1/(1 - shrinkage) about the shaft.
    """

    kerf: float = 0.0
    clearance: float = 0.0
    shrinkage: float = 0.0

    @property
    def out(self) -> float:
        """How far the metal's edges move outward, mm, before the part is scaled."""
        return 0.5 * self.kerf - self.clearance

    @property
    def scale(self) -> float:
        """How many times as large the part is drawn."""
        return 1.0 / (1.0 - self.shrinkage)

    @property
    def tags(self) -> str:
        """Name of what is compensated, for a file's name: `kerf`, `clearance-shrinkage`."""
        return "-".join(name for name in ("kerf", "clearance", "shrinkage") if getattr(self, name))

    def told(self, mm: float) -> str:
        """Say what is compensated, lengths in units of `mm` mm."""
        parts = [f"{name} {value / mm:.9g}" for name in ("kerf", "clearance") if (value := getattr(self, name))]
        if self.shrinkage:
            parts.append(f"shrinkage {100.0 * self.shrinkage:.9g} percent")
        return ", ".join(parts)

    def entry(self, mm: float) -> dict[str, float]:
        """Tell it for a report: lengths in units of `mm` mm, the shrinkage in percent."""
        found = {name: getattr(self, name) / mm for name in ("kerf", "clearance") if getattr(self, name)}
        if self.shrinkage:
            found["shrinkage"] = 100.0 * self.shrinkage
        moved = {"outward": self.out / mm, "scale": self.scale}
        return {**found, **{key: value for key, value in moved.items() if math.isfinite(value)}}
