"""Blanks of indexing cams."""

from __future__ import annotations

from kin.numeric.records import dataclass


@dataclass(frozen=True)
class Barrel:
    """A barrel: its blank is a cylinder."""

    radius: float
    depth: float
    offset: float
    pitch: float
    side: int
    height: float
    length: float

    @property
    def blank(self) -> float:
        """Layer of the blank, mm."""
        return self.radius

    @property
    def floor(self) -> float:
        """Layer of the floor, mm."""
        return self.radius - self.depth


@dataclass(frozen=True)
class Globoid:
    """A globoid: its blank is a torus about the turret."""

    radius: float
    depth: float
    distance: float
    height: float
    length: float

    @property
    def blank(self) -> float:
        """Layer of the blank, mm."""
        return self.radius

    @property
    def floor(self) -> float:
        """Layer of the floor, mm."""
        return self.radius + self.depth
