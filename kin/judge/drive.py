"""A table for a drive as it lies on disk: its rows joined as its controller joins them, held to the intended motion."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from kin.law.joined_rows import errors
from kin.numeric.angles import TURN
from kin.numeric.angles import degrees as in_degrees
from kin.numeric.check import Check, at_most, failed
from kin.numeric.monotone import RoughError, between, cells, pieces
from kin.numeric.records import dataclass, replace
from kin.read.drive_tables import SLAVES, read_drive
from kin.read.errors import ReadError

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from kin.follower.base import Follower, IntendedMotion
    from kin.judge.intent import Limits
    from kin.law.contacts import Unit
    from kin.law.joined_rows import Errors
    from kin.numeric.arrays import Array

SHORT = 1e-5  # share by which the error in the head may be short: it has six digits
DIGITS = 1e-11  # of a position, as a table has it
SHARE = 1e-12  # of the stroke, to which its lowest place is found


@dataclass(frozen=True, eq=False)
class Driven:
    """What a drive is to do over one turn of its master: a motion above a displacement `base`, mm or rad.

    most    greatest error of the position, mm or degrees
    shares  greatest errors of velocity and acceleration, as shares of their greatest values; None where none is given
    speed   of the master, degrees a second, for rates in time; None for rates by degree of the master
    """

    motion: IntendedMotion
    unit: Unit
    base: float
    most: float
    shares: tuple[float | None, float | None] = (None, None)
    speed: float | None = None

    @property
    def breaks(self) -> list[float]:
        """Angles from 0 to a turn, rad, at which a derivative may jump."""
        folded: list[float] = np.mod(self.motion.breaks, TURN).tolist()
        return sorted(folded)

    @property
    def own(self) -> float:
        """Unit of positions in reports, mm or rad."""
        return math.radians(1.0) if self.unit == "deg" else 1.0

    def rows(self, angle: Array, order: int) -> Array:
        """Position above the base, mm or rad, and derivatives by the master's angle (order + 1, n), at angles (n,)."""
        rows = np.array(self.motion.derivatives(angle, order))
        rows[0] -= self.base
        return rows

    def rate(self, order: int) -> tuple[float, str]:
        """Factor from mm or rad by rad^order to the unit of a derivative in reports, and that unit."""
        power = f"^{order}" if order > 1 else ""
        per = math.degrees(1.0) if self.speed is None else math.degrees(1.0) / self.speed
        return 1.0 / (self.own * per**order), f"{self.unit}/{'deg' if self.speed is None else 's'}{power}"


def lowest(motion: Callable[[Array, int], Array], breaks: list[float]) -> float:
    """Least displacement, mm or rad, of a motion over a turn, given as rows of derivatives up to an order.

    Raises RoughError where it cannot be followed.
    """
    return pieces(cells(lambda t: motion(t, 0), between(0.0, TURN, breaks), share=SHARE)).least()[0]


def driven_by(follower: Follower, limits: Limits, shares: tuple[float | None, float | None] = (None, None)) -> Driven:
    """What a drive is to do in place of a cam: the follower's motion above its lowest place.

    The greatest error may reach the limit of motion or, without one, the error that the tolerance makes at a pressure
    angle of 0. Raises RoughError where the motion changes too abruptly to be followed.
    """
    most = follower.direct_limit(limits.tolerance) if limits.motion is None else limits.motion
    driven = Driven(follower.motion, follower.unit, 0.0, most, shares)
    return replace(driven, base=lowest(driven.rows, driven.breaks))


def follower_checks(path: Path, follower: Follower, limits: Limits, mm: float = 1.0) -> list[Check]:
    """Check the motion by a drive's table, lowest at 0, against a follower's intended one; as `drive_checks`."""
    try:
        driven = driven_by(follower, limits)
    except RoughError:
        return [_rough()]
    return drive_checks(path, driven, mm)


def drive_checks(path: Path, driven: Driven, mm: float = 1.0) -> list[Check]:
    """Check the motion by a drive's table, with velocity and acceleration, against what the drive is to do.

    `mm` is the unit, in mm, of a slave whose table states none, where positions are lengths. A file that is no such
    table has one failed check that says why. Raises OSError where the disk refuses.
    """
    try:
        table = read_drive(path, SLAVES["slave_deg"] if driven.unit == "deg" else mm)
        found = errors(table.rows, driven.rows, driven.breaks)
    except RoughError:
        return [_rough()]
    except ReadError as error:
        return [failed("readable", error.message)]
    if (table.unit == SLAVES["slave_deg"]) != (driven.unit == "deg"):
        return [failed("readable", f"the slave is not in the motion's unit, {driven.unit}")]
    worst, at = found.off[0].value / driven.own, found.off[0].at
    slack = DIGITS * float(np.ptp(table.rows.slave[0])) / driven.own
    checks = [at_most("interpolation", worst, driven.most, driven.unit, angle=at, slack=slack)]
    checks += _rate_checks(found, driven)
    if table.stated is not None:
        stated = table.stated * table.unit / driven.own
        checks.append(at_most("stated-error", worst, stated, driven.unit, slack=SHORT * stated + slack))
    return checks


def _rate_checks(found: Errors, driven: Driven) -> list[Check]:
    """Checks of the derivatives that the joined rows have, and of the steps of the velocity between lines."""
    checks = []
    for order, name in enumerate(("interpolation-velocity", "interpolation-acceleration")[: len(found.peaks)], 1):
        factor, unit = driven.rate(order)
        value, share = found.off[order].value * factor, driven.shares[order - 1]
        limit = None if share is None or not found.peaks[order - 1] else share * found.peaks[order - 1] * factor
        detail = found.share(found.off[order].value, order)
        ok = limit is None or value <= limit * (1.0 + SHORT)
        checks.append(Check(name, ok, value, limit, unit, in_degrees(found.off[order].at), detail=detail))
    if found.step is not None:
        factor, unit = driven.rate(1)
        detail = found.share(found.step.value, 1)
        at = in_degrees(found.step.at)
        checks.append(Check("velocity-step", True, found.step.value * factor, None, unit, at, detail=detail))
    return checks


def _rough() -> Check:
    return failed("readable", "the motion changes too abruptly to be followed")
