"""Units of length that a file may be stated to be in."""

from __future__ import annotations

from typing import Literal, TypeAlias

Units: TypeAlias = Literal["mm", "cm", "m", "inch", "foot"]
INCH = 25.4  # mm
UNIT_MM: dict[Units, float] = {"mm": 1.0, "cm": 10.0, "m": 1000.0, "inch": INCH, "foot": 304.8}
