"""Followers that judge files of a corrected contour: metal that should lie off the exact contour by a smooth curve.

The intended contour is that of the metal. A contact's position on a file counts less the effect of the metal's
deviation from the exact contour on it. So the remaining motion is compared to the recipe's, and the remaining play to
none, as for a part that is not corrected.
"""

from __future__ import annotations

import math
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kin.follower.base import Closure, Follower
from kin.follower.drive import CLOSE, extremes_between
from kin.follower.motion_error import Judged, Play, motion_error, with_steps
from kin.made.metal import Metal, places_of
from kin.made.motion import step_of
from kin.numeric.angles import TURN, degrees
from kin.numeric.feet import equal_steps
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kin.contour.contour import Contour
    from kin.follower.base import IntendedMotion, Rests
    from kin.follower.drive import Excitation
    from kin.follower.envelope import Envelope
    from kin.law.contacts import Side
    from kin.made.smooth import Smooth
    from kin.numeric.arrays import Array

FIT = np.linalg.inv(np.vander(np.arange(5.0), increasing=True))  # coefficients of a quartic by its values at 0 to 4
LIMIT_ANGLES = 720  # shaft angles at which the effect of a tolerance is found


class _Beyond(NamedTuple):
    """Drive of a contact that rests on a contour, less the correction's effect, in SI (m, rad), as an excitation."""

    drive: Excitation
    follower: Corrected
    contact: int

    @property
    def breaks(self) -> Array:
        """Breaks of the drive on the contour, of the law and of the metal, rad of shaft."""
        return np.concatenate([self.drive.breaks, self.follower.motion.breaks, self.follower.metal_breaks])

    @property
    def smooth(self) -> bool:
        """Whether the velocity of the drive on the contour is continuous."""
        return self.drive.smooth

    def rows(self, phi: Array) -> Array:
        """Position, m or rad, velocity and acceleration by rad of the shaft, (3, n), at shaft angles phi (n,), rad."""
        outwards = self.follower.contacts[self.contact].sense  # own positions grow outwards
        rows: Array = self.drive.rows(phi) - outwards * self.follower.si * self.follower.added(phi)[self.contact]
        return rows


@dataclass(frozen=True, eq=False)
class _Meant:
    """The intended motion as an excitation, in SI (m, rad)."""

    follower: Follower

    @property
    def breaks(self) -> Array:
        """Breaks of the law, rad of shaft."""
        return self.follower.motion.breaks

    @property
    def smooth(self) -> bool:
        """Whether velocity is continuous: it is for all laws of cams."""
        return True

    def rows(self, phi: Array) -> Array:
        """Intended position, m or rad, velocity and acceleration by rad of shaft, (3, n), at angles phi (n,), rad."""
        rows: Array = self.follower.si * self.follower.motion.derivatives(phi, 2)[:3]
        return rows


@dataclass(frozen=True, eq=False)
class Corrected(Follower):
    """A follower on metal that should lie by a smooth `curve`, mm, above the exact contour of a gauge.

    `exact` is the follower, on the exact contour: the gauge, or one with a clearance to it. `contour` is the contour of
    the metal, over the parameter of the exact one.
    """

    exact: Follower
    metal: Metal
    curve: Smooth
    contour: Envelope

    @staticmethod
    def of(gauge: Follower, side: Side, curve: Smooth) -> Corrected:
        """A gauge on metal that lies by `curve`, mm, above its contour; `side` is 1 for metal inside it, -1 outside."""
        contour = gauge.envelope.displaced(curve.times(side))

        def skin(parameter: Array, height: float) -> tuple[Array, Array]:
            return contour.inset(-side * height).frames(parameter)[:2]

        return Corrected(gauge.contacts, gauge, Metal(gauge, skin, places_of(curve.spans), gauge), curve, contour)

    def within_reach(self) -> tuple[float, float]:
        """Greatest multiple of the curve, to first order, at which the contour nowhere turns back, and where it would.

        Where a contour turns back, no contact reaches it. The place is a shaft angle, rad, among the `places` of the
        metal; the multiple is infinite where the contour never turns back.
        """
        places = self.metal.places
        exact, speed = (curve.frames(places).speed for curve in (self.metal.follower.envelope, self.contour))
        lost = exact - speed
        shares = np.where(lost > 0.0, exact / np.where(lost > 0.0, lost, 1.0), np.inf)
        worst = int(np.argmin(shares))
        return float(shares[worst]), float(self.shaft_angle(places[worst : worst + 1])[0])

    def run_by(self, follower: Follower) -> Corrected:
        """The same metal under another follower of the same motion."""
        return replace(self, contacts=follower.contacts, exact=follower)

    @property
    def envelope(self) -> Envelope:
        """The contour of the metal."""
        return self.contour

    @property
    def motion(self) -> IntendedMotion:
        """Intended motion of the recipe, with which motions less the effect of the correction are compared."""
        return self.exact.motion

    @property
    def rests(self) -> Rests:
        """Dwells of the recipe's motion."""
        return self.exact.rests

    @property
    def closure(self) -> Closure | None:
        """Greatest play beyond that on the metal, by a tolerance of the contour; None for one contact."""
        closure = self.exact.closure
        if closure is None:
            return None
        return Closure(lambda tolerance: sum(self._limits(tolerance)), closure.name, closure.tight, lever=2.0)

    @property
    def lever(self) -> float:
        """Approximate distance of the contact from the arm's pivot, mm; infinite on a line of travel."""
        return self.exact.lever

    def shaft_angle(self, parameter: Array) -> Array:
        """Shaft angle (n,), rad, at which the exact contour is touched at the parameters (n,)."""
        return self.exact.shaft_angle(parameter)

    def drives(self, contour: Contour) -> Sequence[Excitation]:
        """Drive of each contact that rests on a contour, its own position, m or rad, less the correction's effect.

        Raises ContactError as `Follower.drives` does. A drive raises it when it is evaluated, where a contact finds no
        metal.
        """
        return [_Beyond(drive, self, k) for k, drive in enumerate(self.exact.drives(contour))]

    def pressed(self, contour: Contour, phi: Array) -> tuple[Array, Array]:
        """Pressure angle at contact 1, rad, and radius of curvature of a contour there, mm, (n,) each, at phi (n,).

        With the signs of `Follower.pressed`; like it, raises ContactError where contact 1 finds no contact.
        """
        return self.exact.pressed(contour, phi)

    def touching(self, points: Array, normals: Array) -> list[tuple[Array, Array]]:
        """Shaft angle, rad, and position, mm or rad, (n,) each, with each contact on metal at points (n, 2), mm.

        `normals` (n, 2) are outward of the contour. The follower is the exact one; nan is out of reach.
        """
        return self.exact.touching(points, normals)

    def added(self, shaft: Array) -> Array:
        """Effect of the correction on the position of each of c contacts, and two derivatives by rad: (c, 3, n).

        It is in mm or rad, at shaft angles (n,), rad. Derivatives come from a quartic through five places of the
        stretch between two breaks, since velocity or acceleration jumps at breaks. Raises ContactError where a contact
        finds no metal.
        """
        ends = np.unique(np.concatenate([self.motion.breaks, self.metal_breaks, [0.0]]))
        ends = ends[np.diff(ends, prepend=-np.inf) > CLOSE]
        at = np.mod(shaft, TURN)
        index = np.searchsorted(ends, at, side="right") - 1
        low, high = ends[index], np.append(ends[1:], TURN)[index]
        # five places about each angle, moved so that all lie within its stretch
        step = np.minimum(step_of(self.curve), (high - low) / 4.0)
        first = np.clip(at - 2.0 * step, low, high - 4.0 * step)
        errors = self._errors(first + step * np.arange(5.0)[:, None])
        # first and second derivative of the quartic at the angle, x in steps from the first place
        x = (at - first) / step
        power = x[None] ** np.arange(5.0)[:, None]
        zero = np.zeros_like(x)
        slope = np.stack([zero, *(k * power[k - 1] for k in range(1, 5))])
        bend = np.stack([zero, zero, *(k * (k - 1) * power[k - 2] for k in range(2, 5))])
        polynomial = np.tensordot(FIT, errors, axes=([1], [1]))  # coefficients (5, c, n)
        rates = [np.einsum("kn,kcn->cn", row, polynomial) for row in (slope, bend)]
        return np.stack([self._errors(at[None])[:, 0], rates[0] / step, rates[1] / step**2], axis=1)

    def _errors(self, shaft: Array) -> Array:
        """Each contact's position on the metal less the intended, mm or rad, at shaft angles (m, n), rad: (c, m, n)."""
        positions, _ = self.metal.positions(shaft.ravel())
        errors = positions - self.metal.follower.intended(shaft.ravel())
        each: Array = errors.reshape(-1, *shaft.shape)
        return each

    @cached_property
    def metal_breaks(self) -> Array:
        """Shaft angles (m,), rad, at which a contact reaches or leaves a break of the contour."""
        corners = self.metal.corners
        touches = [self.metal.gauge.touching(corners.points, side) for side in (corners.before, corners.after)]
        breaks: Array = np.mod(np.concatenate([angle for touch in touches for angle, _ in touch]), TURN)
        return breaks

    def judge(self, contour: Contour, phi: Array) -> Judged:
        """Motion error and play of a contour beyond those on the corrected metal; no play with one contact.

        The root mean square and the increments of the error are over shaft angles phi (n,), rad. Raises ContactError
        where the follower finds no contact.
        """
        rests, law = self.resting(contour), _Meant(self.exact)
        size = self.si * float(np.abs(contour.vertices).max()) if self.unit == "mm" else 1.0
        each = [extremes_between(law, rest, size).worst for rest in rests]
        worst, at = max(each)
        every = with_steps(phi)
        errors = np.stack([rest.rows(every)[0] - law.rows(every)[0] for rest in rests]) / self.si
        motion = motion_error((worst / self.si, at), errors, None, self.unit)
        if len(rests) == 1:
            return Judged(motion, None)
        pushing, stopping = rests if self.contacts[0].sense > 0 else reversed(rests)
        gap = extremes_between(pushing, stopping, size)
        scale = math.degrees(1.0) if self.unit == "deg" else 1.0 / self.si
        least, most = ((scale * gap.least, degrees(gap.least_at)), (scale * gap.greatest, degrees(gap.greatest_at)))
        return Judged(motion, Play(*least, *most, self.unit))

    def motion_limit(self, tolerance: float) -> float:
        """Greatest motion error, mm or degrees, of a contour within `tolerance`, mm, of the metal."""
        return max(self._limits(tolerance))

    def _limits(self, tolerance: float) -> list[float]:
        """Greatest change of each contact's position, mm or degrees, by metal that is raised or lowered all round."""
        shaft = equal_steps(LIMIT_ANGLES)
        here, _ = self.metal.positions(shaft)
        moved = [self.metal.raised(height).positions(shaft)[0] - here for height in (tolerance, -tolerance)]
        scale = math.degrees(1.0) if self.unit == "deg" else 1.0
        most: list[float] = (scale * np.abs(np.stack(moved)).max(axis=(0, 2))).tolist()
        return most
