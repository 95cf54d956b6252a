"""The flank of a roller."""

from __future__ import annotations

from typing import Any

from kin.numeric.records import dataclass


@dataclass(frozen=True, eq=False)
class Flank:
    """The flank of a roller of a radius, mm, below it (`side` -1) or above it (1)."""

    form: Any
    law: Any
    start: float
    radius: float
    side: int
