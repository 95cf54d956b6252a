"""By which keys a recipe gives a cam its size and motion."""

from __future__ import annotations

from typing import TYPE_CHECKING

from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from camgeo.schema.change import Value


@dataclass(frozen=True, kw_only=True)
class ByMotion:
    """Keys below `cam` by which recipes of a family give a cam by its motion.

    motion    key of the motion
    base      key of the base circle's radius, where displacements are 0; empty where other lengths fix the size
    instead   keys that give the motion in another way
    still     key and value of an entry that gives hardly any motion
    opposed   whether size and motion fix how far two opposite contacts are apart
    lag       share of the swing to take off the shaft angle: over the rest the swing changes sign each section
    series    whether the motion is a Fourier series of the support function, of which `base` is the mean
    """

    motion: str
    base: str = ""
    instead: tuple[str, ...] = ()
    still: tuple[str, Value]
    opposed: bool = False
    lag: float = 0.5
    series: bool = False
