"""The follower train of a recipe."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Dynamics:
    """A follower train in SI, but for `play`, mm; of `preload` and `play` one is None. `rpm` is the shaft's speed."""

    mass: float
    stiffness: float
    rpm: float
    damping: float = 0.0
    preload: float | None = None
    rate: float = 0.0
    play: float | None = None
