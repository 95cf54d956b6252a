"""Flat faces on a line of travel: along their own normal a single face and a yoke of two, and one that stands askew.

What a face feels of a contour is its support function q and nothing else. The errors below are extremes over all shaft
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

TRAVEL_STEPS = 3600  # of the turn: between two of them the place of contact hides 4e-7 of the radius
NEAR = 1e-8  # mm: so near to a cubic is the intended motion between two places of a search


@dataclass(frozen=True, eq=False)
class OfFace:
    """Distance at which a flat face rests on a contour, its normal `turned` ahead of the shaft angle.

    Between two breaks it is that of one corner or one circle: q = R + C.u(theta), q'' = R - q. Along a line of travel
    on which it stands askew it is q over `share`, the cosine.
    """

    bearing: FlatContacts
    turned: float = 0.0
    share: float = 1.0
    smooth: ClassVar[bool] = False  # over an edge the contact leaps from end to end

    @property
    def breaks(self) -> Array:
        """Shaft angles, rad, in [0, 2 pi), at which the contact passes from one piece of the contour to the next."""
        return np.mod(self.bearing.breaks - self.turned, TURN)

    def rows(self, phi: Array) -> Array:
        """Position, m, and two derivatives by the shaft angle, (3, n), at angles phi (n,), rad, not at breaks."""
        theta = phi + self.turned
        rows: Array = METRE / self.share * self.bearing.derivatives(theta, self.bearing.find(theta))
        return rows


@dataclass(frozen=True, eq=False)
class FlatFace(Follower):
    """A flat face on a line of travel, its normal ahead of that by its tilt; of a yoke the first of two.

    Its position, of which `lift` is the intended one, is its distance from the shaft along the travel, mm: p over the
    tilt's cosine; that of a lone face whose sense is -1 is what its distance leaves of its zero. Where beside the shaft
    the line runs moves the place of contact on the face, not the face.
    """

    lift: Lift

    @property
    def motion(self) -> Lift:
        """Intended lift; of a yoke that of face 1, mm."""
        return self.lift

    @property
    def rests(self) -> Rests:
        """Dwells of the lift."""
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
        """Shaft angles between which the intended distance has nothing narrow."""
        return cubic_cells(self.distance.law, self.distance.breaks, NEAR)

    @property
    def _share(self) -> float:
        """Distance of the face from the shaft for one along the line of travel."""
        return float(np.cos(self.tilt))

    @cached_property
    def envelope(self) -> FlatEnvelope:
        """The exact contour; its parameter is the shaft angle."""
        return FlatEnvelope(LiftPitch(self.distance, self.tilt, self.contacts[0].turned))

    def drives(self, contour: Contour) -> list[OfFace]:
        """Position of each face as it rests on the contour."""
        bearing = bearing_of(contour)
        return [OfFace(bearing, self.tilt + contact.turned, self._share) for contact in self.contacts]

    def pressed(self, contour: Contour, phi: Array) -> tuple[Array, Array]:
        """Pressure angle, rad, at which the face stands askew, and radius of curvature, mm, (n,) each."""
        bearing, theta = bearing_of(contour), phi + self.ahead
        q, _, bend = bearing.derivatives(theta, bearing.find(theta))
        return np.full(phi.shape, -self.tilt), q + bend

    def contact_travel(self, contour: Contour) -> tuple[float, float]:
        """Least and greatest place of contact 1 along the face, mm from the stem's axis, above 0 ahead of it."""
        q, slope, _ = bearing_of(contour).all_round(TRAVEL_STEPS)
        guide = self.contacts[0].guide
        aside = guide.offset / self._share if isinstance(guide, Translating) else 0.0
        place = slope + q * np.tan(self.tilt) - aside
        return float(place.min()), float(place.max())

    def touching(self, points: Array, normals: Array) -> list[tuple[Array, Array]]:
        """Shaft angle, rad, and position, mm, (n,) each, with each face on metal at points and normals (n, 2)."""
        direction = np.arctan2(normals[:, 1], normals[:, 0])
        own = dot(points, normals) / self._share
        return [(direction - self.tilt - contact.turned, contact.position(own)) for contact in self.contacts]

    def judge(self, contour: Contour, theta: Array) -> Judged:
        """Motion error, and of a yoke the play of the contour in the frame; extremes over the whole turn."""
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
        """Greatest motion error of a contour within `tolerance` of the exact one, mm."""
        return tolerance / self._share

    def _play(self, bearing: FlatContacts) -> Play | None:  # noqa: ARG002 - a single face has none
        return None


@dataclass(frozen=True, eq=False)
class Yoke(FlatFace):
    """Two parallel faces at a fixed breadth w, mm, the datum of face 2: a frame, which face 1 holds at p(theta).

    The intended p has p(theta) + p(theta + pi) = w, so face 2 makes the error that face 1 makes half a turn on.
    """

    @property
    def breadth(self) -> float:
        """Distance between the two faces, mm."""
        return self.contacts[1].zero

    @property
    def closure(self) -> Closure:
        """Rule for the play: checks on the contour's breadth, mm, for constancy and for its greatest value."""
        return Closure(self.play_limit, "constant-breadth", "breadth-max", self.breadth)

    def play_limit(self, tolerance: float) -> float:
        """Greatest play or interference of a contour within `tolerance` of the exact one, mm: both sides may be off."""
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
    """Greatest less least q over the angles [begin, end], mm."""
    nodes = bearing.nodes(begin, end, np.empty(0))
    stretch, at_low, at_high = bearing.between(nodes)

    def lift(theta: Array, interval: Indices) -> Array:
        return bearing.derivatives(theta, stretch[interval])

    return extremes(nodes[:-1], nodes[1:], at_low, at_high, lift, resolution=resolution(bearing.contour.vertices)).span
