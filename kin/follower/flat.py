"""Flat faces on a line of travel: a single face, square to the line or askew, and a yoke of two square ones.

A face depends on a contour by its support function q alone. The errors below are extremes over all shaft
angles, found stretch by stretch between the breaks of the contour's support function and those of the intent.
"""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, ClassVar

import numpy as np

from kin.contour.arcs import dot
from kin.follower.base import Closure, Follower, Rests
from kin.follower.envelope import FlatEnvelope, LiftPitch
from kin.follower.motion_error import Judged, MotionError, Play, motion_error, with_steps
from kin.follower.rests import dwells
from kin.follower.support import FlatContacts, bearing_of
from kin.law.bounds import cubic_cells
from kin.law.contacts import METRE, Flat, Translating
from kin.law.support_function import Lift
from kin.numeric.angles import TURN, degrees
from kin.numeric.extrema import Extremes, extremes, resolution
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from kin.contour.contour import Contour
    from kin.numeric.arrays import Array, Indices

TRAVEL_STEPS = 3600  # of the turn: between two of them the place of contact strays by 4e-7 of the radius at most
NEAR = 1e-8  # mm, within which a cubic follows the intended motion between two places of a search


@dataclass(frozen=True, eq=False)
class OfFace:
    """Distance from the shaft at which a flat face rests on a contour, along its line of travel.

    The face's normal stands `turned`, rad, ahead of the shaft angle; the distance is q/`share`, the cosine of its angle
    to the line. Between two breaks one corner, arc or Bezier piece bears: q'' = R - q, R its radius of curvature there.
    """

    bearing: FlatContacts
    turned: float = 0.0
    share: float = 1.0
    smooth: ClassVar[bool] = False  # over an edge the contact leaps from end to end

    @property
    def breaks(self) -> Array:
        """Shaft angles (m,), rad, in [0, 2 pi), at which the contact passes from one piece to the next."""
        return np.mod(self.bearing.breaks - self.turned, TURN)

    def rows(self, phi: Array) -> Array:
        """Position, m, and two derivatives by the shaft angle, (3, n), at angles phi (n,), rad, not at breaks."""
        theta = phi + self.turned
        rows: Array = METRE / self.share * self.bearing.derivatives(theta, self.bearing.find(theta))
        return rows


@dataclass(frozen=True, eq=False)
class FlatFace(Follower):
    """A flat face on a line of travel, its normal ahead of the line by its tilt; of a yoke the first of two.

    Its position, mm, of which `lift` is the intended one, is its distance p/cos(tilt) from the shaft along the line; of
    a lone face whose sense is -1 its zero less that distance. The line's offset from the shaft moves the place of
    contact on the face, not the face.
    """

    lift: Lift

    @property
    def motion(self) -> Lift:
        """Intended lift, mm, of a yoke the lift of face 1."""
        return self.lift

    @property
    def rests(self) -> Rests:
        """Dwells of the lift, each a pair of shaft angles (from, to), rad."""
        return tuple(dwells(self.lift))

    @property
    def tilt(self) -> float:
        """Angle by which the face's normal stands ahead of the line of travel, radians."""
        touch = self.contacts[0].touch
        return touch.tilt if isinstance(touch, Flat) else 0.0

    @property
    def ahead(self) -> float:
        """Angle by which the first face's normal stands ahead of the shaft angle, radians."""
        return self.tilt + self.contacts[0].turned

    @cached_property
    def distance(self) -> Lift:
        """Intended distance of the first face from the shaft along the line of travel, mm."""
        first = self.contacts[0]
        if first.sense < 0:
            return Lift(self.lift.law.taken_from(first.zero))
        return Lift(self.lift.law.raised(first.zero)) if first.zero else self.lift

    @cached_property
    def _cells(self) -> Array:
        """Shaft angles (m,), rad, between which cubics follow the intended distance."""
        return cubic_cells(self.distance.law, self.distance.breaks, NEAR)

    @property
    def _share(self) -> float:
        """Distance of the face from the shaft over its distance along the line of travel: cos(tilt)."""
        return float(np.cos(self.tilt))

    @cached_property
    def envelope(self) -> FlatEnvelope:
        """The exact contour; its parameter is the shaft angle."""
        return FlatEnvelope(LiftPitch(self.distance, self.tilt, self.contacts[0].turned))

    def drives(self, contour: Contour) -> list[OfFace]:
        """Own position of each face, m, over the shaft angle as it rests on the contour."""
        bearing = bearing_of(contour)
        return [OfFace(bearing, self.tilt + contact.turned, self._share) for contact in self.contacts]

    def pressed(self, contour: Contour, phi: Array) -> tuple[Array, Array]:
        """Pressure angle, rad, minus the tilt, and radius of curvature of the contour, mm, (n,) each, at phi (n,)."""
        bearing, theta = bearing_of(contour), phi + self.ahead
        q, _, bend = bearing.derivatives(theta, bearing.find(theta))
        return np.full(phi.shape, -self.tilt), q + bend

    def contact_travel(self, contour: Contour) -> tuple[float, float]:
        """Least and greatest place of contact 1 along the face, mm from the stem's axis, above 0 ahead of it."""
        q, slope, _ = bearing_of(contour).all_round(TRAVEL_STEPS)
        guide = self.contacts[0].guide
        # the stem's axis meets the face aside - q tan(tilt) ahead of the foot of the shaft on it; _share is cos(tilt)
        aside = guide.offset / self._share if isinstance(guide, Translating) else 0.0
        place = slope + q * np.tan(self.tilt) - aside
        return float(place.min()), float(place.max())

    def touching(self, points: Array, normals: Array) -> list[tuple[Array, Array]]:
        """Shaft angle, rad, and position, mm, (n,) each, with each face on metal at points and normals (n, 2)."""
        direction = np.arctan2(normals[:, 1], normals[:, 0])
        own = dot(points, normals) / self._share
        return [(direction - self.tilt - contact.turned, contact.position(own)) for contact in self.contacts]

    def judge(self, contour: Contour, theta: Array) -> Judged:
        """Motion error, and of a yoke the play of the contour in the frame; rms from shaft angles theta (n,), rad.

        Extremes are over the whole turn. Raises UnsettledError where rounding hides them.
        """
        bearing = bearing_of(contour)
        reach = self._reach(bearing)
        return Judged(self._error(bearing, theta, reach), self._play(bearing), reach)

    def _error(self, bearing: FlatContacts, theta: Array, reach: Extremes) -> MotionError:
        (worst, at), share, ahead = reach.worst, self._share, self.ahead
        angle = with_steps(theta)
        position = self.contacts[0].position(bearing.derivatives(angle + ahead, bearing.find(angle + ahead))[0] / share)
        ranges = [lift_range(bearing, begin + ahead, end + ahead) / share for begin, end in self.rests]
        errors = position - self.intended(angle)
        return motion_error((worst / share, at), errors, max(ranges, default=None), "mm")

    def _reach(self, bearing: FlatContacts) -> Extremes:
        """Extremes over the shaft angle of how far the contour reaches beyond the intended face, along its normal."""
        lift, share, ahead = self.distance, self._share, self.ahead
        nodes = bearing.nodes(0.0, TURN, self._cells, ahead)
        stretch, at_low, at_high = bearing.between(nodes, ahead)
        intended = share * lift.derivatives(nodes, 2)
        at_low -= intended[:, :-1]
        at_high -= intended[:, 1:]
        if len(lift.breaks):  # from within, that is from the left, at the high ends
            at = np.searchsorted(nodes, lift.breaks)
            at = np.where(at == 0, len(nodes) - 1, at)
            at_high[:, at - 1] += intended[:, at] - share * lift.derivatives(nodes[at], 2, -1)

        def error(phi: Array, interval: Indices) -> Array:
            return bearing.derivatives(phi + ahead, stretch[interval]) - share * lift.derivatives(phi, 2)

        fine = resolution(bearing.contour.vertices) + 4.0 * lift.rounding
        return extremes(nodes[:-1], nodes[1:], at_low, at_high, error, resolution=fine)

    def motion_limit(self, tolerance: float) -> float:
        """Greatest motion error, mm, of a contour within `tolerance`, mm, of the exact one."""
        return tolerance / self._share

    def _play(self, bearing: FlatContacts) -> Play | None:  # noqa: ARG002 - a single face has none
        return None


@dataclass(frozen=True, eq=False)
class Yoke(FlatFace):
    """Two parallel faces of a frame at a fixed breadth w, mm, the zero of face 2; face 1 stands at p(theta).

    The intended p has p(theta) + p(theta + pi) = w, so face 2 makes the error that face 1 makes half a turn on.
    """

    @property
    def breadth(self) -> float:
        """Distance between the two faces, mm."""
        return self.contacts[1].zero

    @property
    def closure(self) -> Closure:
        """Rule for the play: checks that the contour's breadth, mm, is constant and nowhere too great."""
        return Closure(self.play_limit, "constant-breadth", "breadth-max", self.breadth)

    def play_limit(self, tolerance: float) -> float:
        """Greatest play or interference, mm, of a contour within `tolerance`, mm: both sides may be off."""
        return 2.0 * tolerance

    def _play(self, bearing: FlatContacts) -> Play:
        breadths = bearing.breadth_extremes(resolution(bearing.contour.vertices))
        return Play(
            self.breadth - breadths.greatest,
            degrees(breadths.greatest_at),
            self.breadth - breadths.least,
            degrees(breadths.least_at),
            "mm",
        )


def lift_range(bearing: FlatContacts, begin: float, end: float) -> float:
    """Greatest less least support function q, mm, over the normals' angles [begin, end], rad.

    Raises UnsettledError where rounding hides the extremes.
    """
    nodes = bearing.nodes(begin, end, np.empty(0))
    stretch, at_low, at_high = bearing.between(nodes)

    def lift(theta: Array, interval: Indices) -> Array:
        return bearing.derivatives(theta, stretch[interval])

    return extremes(nodes[:-1], nodes[1:], at_low, at_high, lift, resolution=resolution(bearing.contour.vertices)).span
