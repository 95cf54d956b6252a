"""Intended indexing cams: all that the judge takes beside the file itself and permitted errors.

A cam reaches from z = 0 to its length, from its bore to its blank. Rollers without ends, on the turret's side of the
cam, sweep a groove in the blank, down to the floor, which is a layer of the form. What is left between the rollers is a
rib that winds from one end to the other. The metal below a roller has the lower flank, that above it the upper one.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from kin.numeric.angles import TURN
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from kin.contour.holes import Hole
    from kin.indexing.forms import Form
    from kin.law.contacts import Side
    from kin.law.piecewise import Piecewise

SIDES: dict[str, Side] = {"lower": -1, "upper": 1}  # of a roller on which a flank lies
VELOCITY = 1e-9  # rad per rad: a jump of the velocity below this is rounding


@dataclass(frozen=True, eq=False)
class IndexIntent:
    """Intended indexing cam in a file.

    form       barrel or globoid, mm
    height     of the turret's centre over the lower face, mm
    length     of the cam along z, mm
    law        intended advance of the turret, rad, over one turn of the cam, from 0 to 2 pi/stops at 2 pi
    start      angle, rad, of one of the rollers at advance 0
    stops      number of rollers on the turret
    roller     radius of a roller, mm
    inner      where rollers begin along their axes, mm: from the cam's axis, of a globoid from the turret's
    outer      where they end
    clearance  mm, by which the roller of the upper flanks is larger; below 0 it is a preload
    bore       the opening along the axis, keyway included, mm, as if not mirrored; None for a cam without one
    mirrored   the file is mirrored, y -> -y (rotation ccw), bore too
    mm         mm in a unit of a development's DXF (solids are always in mm)

    Raises ValueError for rollers that overlap, or another turret or cam that cannot be, see its form; and for a turret
    whose velocity jumps.
    """

    form: Form
    height: float
    length: float
    law: Piecewise
    start: float
    stops: int
    roller: float
    inner: float
    outer: float
    clearance: float = 0.0
    bore: Hole | None = None
    mirrored: bool = False
    mm: float = 1.0

    def __post_init__(self) -> None:
        self.form.demand(self.stops, max(self.radius(-1), self.radius(1)), self.ends)
        _, jumps = self.law.jumps(1)
        first, last = (float(self.law.derivatives(end, 1, side)[1, 0]) for end, side in ((0.0, 1), (TURN, -1)))
        if max(float(np.abs(jumps[1]).max(initial=0.0)), abs(first - last)) > VELOCITY:
            raise ValueError("the velocity of the turret jumps")

    @property
    def ends(self) -> tuple[float, float]:
        """Heights of the lower and of the upper face over the turret's centre, mm."""
        return -self.height, self.length - self.height

    @property
    def pitch(self) -> float:
        """Angle from one roller to the next, rad: the advance in one turn of the cam."""
        return 2.0 * math.pi / self.stops

    def radius(self, side: Side) -> float:
        """Radius, mm, of the roller whose flank has the metal below it (-1) or above it (1)."""
        return self.roller + (self.clearance if side > 0 else 0.0)
