"""How far a follower's measured motion is from the intended one, and how much play it has."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal, NamedTuple

import numpy as np

from kin.numeric.angles import degrees
from kin.numeric.errors import CamgeoError
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from kin.law.contacts import Unit
    from kin.numeric.arrays import Array
    from kin.numeric.extrema import Extremes

Extreme = Literal["true", "sampled"]
ALLOWANCE = 0.02  # of a sampled extreme, by which the true one is estimated to exceed it at most
STEP_DEG = 1.0  # the shaft turns by this much in an increment


@dataclass(frozen=True)
class MotionError:
    """Error of a follower's position over one turn, measured less intended; mm, or degrees where the follower swings.

    max             greatest absolute error
    rms             root mean square over the given shaft angles
    at_deg          shaft angle of the greatest, [0, 360)
    increment       greatest change of the error while the shaft turns by `step_deg`, starting from each given angle
    dwell_flatness  greatest range of the measured position over a dwell of the intended motion; None without a dwell
    extremes        "true": `max` is the greatest over all shaft angles; "sampled": over the angles looked at
    remainder       amount by which the greatest may exceed `max`: proved where extremes are true, else an estimate
    """

    max: float
    rms: float
    unit: Unit
    at_deg: float
    increment: float
    step_deg: float
    dwell_flatness: float | None = None
    extremes: Extreme = "true"
    remainder: float = 0.0

    @property
    def bound(self) -> float:
        """Upper bound of the motion error's size, mm or degrees: `max` plus the remainder, proved where that is."""
        return self.max + self.remainder

    def less_sure(self, by: float) -> MotionError:
        """Motion error with figures that hold if every measured position is off by up to `by`, mm or degrees."""
        flat = self.dwell_flatness
        return replace(
            self,
            max=self.max + by,
            rms=self.rms + by,
            increment=self.increment + 2.0 * by,
            dwell_flatness=None if flat is None else flat + 2.0 * by,
        )


@dataclass(frozen=True)
class Play:
    """Clearance between contour and follower over one turn, negative where they interfere.

    A frame of faces: its breadth less the contour's, mm. A yoke of rollers, or a follower between two surfaces: its
    free travel with the cam at rest, mm or degrees. A double roller: the gap at the second roller while the first is
    held in contact, mm. A flat pair: the angle by which the faces stand wider than they need, degrees. The angles are
    shaft angles, [0, 360). `extremes` is "true" for extremes over all of them, "sampled" over those looked at.
    """

    least: float
    least_at_deg: float
    most: float
    most_at_deg: float
    unit: Unit
    extremes: Extreme = "true"

    def less_sure(self, by: float) -> Play:
        """Play with its least value lower and its greatest higher by `by`, in its unit, the error that it may have."""
        return replace(self, least=self.least - by, most=self.most + by)


class Judged(NamedTuple):
    """Result of resting a follower on a contour.

    motion  its motion error
    play    play of a follower that is held from two sides, else None
    reach   of a flat face: extremes over the shaft angle, rad, of how far the contour reaches beyond the intended
            position, mm; None for other followers
    """

    motion: MotionError
    play: Play | None
    reach: Extremes | None = None


class ContactError(CamgeoError, ValueError):
    """The follower finds no contact; `at` is the shaft angle, rad, at which contact was sought."""

    def __init__(self, message: str, angle: float) -> None:
        super().__init__(f"{message} at {degrees(angle):.6g} degrees")
        self.at = angle


def with_steps(phi: Array) -> Array:
    """The given shaft angles (n,), rad, and after them each one an increment further: (2n,), for `motion_error`."""
    return np.concatenate([phi, phi + np.radians(STEP_DEG)])


def motion_error(
    worst: tuple[float, float],
    errors: Array,
    flatness: float | None,
    unit: Unit,
    *,
    remainder: float | None = 0.0,
    off: float = 0.0,
) -> MotionError:
    """Motion error from the `worst` error and its shaft angle, and `errors` (..., 2n) at `with_steps` of n angles.

    Errors and `flatness`, that of the dwells, are mm or rad; rad become degrees for the unit deg. `remainder` is the
    proved amount by which the worst may be exceeded; None where it is the worst of samples alone. `off`, mm or degrees,
    bounds the change of a position by arcs in place of splines.
    """
    scale = 180.0 / np.pi if unit == "deg" else 1.0
    given, further = np.split(errors, 2, axis=-1)
    return MotionError(
        max=scale * worst[0],
        rms=scale * float(np.sqrt(np.mean(given * given))) + off,
        unit=unit,
        at_deg=degrees(worst[1]),
        increment=scale * float(np.abs(further - given).max()) + 2.0 * off,
        step_deg=STEP_DEG,
        dwell_flatness=None if flatness is None else scale * flatness + 2.0 * off,
        extremes="sampled" if remainder is None else "true",
        remainder=scale * (ALLOWANCE * worst[0] if remainder is None else remainder) + off,
    )
