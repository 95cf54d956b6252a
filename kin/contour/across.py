"""Contours closed across a stretch of which nothing is known: a slot that reaches the shaft, or what was left out."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Literal, NamedTuple, TypeAlias

import numpy as np

from kin.contour.contour import Contour
from kin.contour.pieces import Pieces
from kin.numeric.angles import TURN

if TYPE_CHECKING:
    from kin.numeric.arrays import Array

Across: TypeAlias = Literal["arc", "chord"]
FAR = 10.0  # chords of a stretch, within which tangents at its ends meet
DEEP = 0.5  # of the distance from the shaft, to which a notch goes in place of what is not known


class Bridge(NamedTuple):
    """The stretch that closes a contour: its ends (x, y), mm, in the order of the contour."""

    start: tuple[float, float]
    end: tuple[float, float]

    def moved(self, x: float, y: float) -> Bridge:
        """Return the stretch moved by a distance along x and along y, mm."""
        return Bridge((self.start[0] + x, self.start[1] + y), (self.end[0] + x, self.end[1] + y))

    def scaled(self, factor: float) -> Bridge:
        """Return the stretch enlarged about the origin."""
        return Bridge((factor * self.start[0], factor * self.start[1]), (factor * self.end[0], factor * self.end[1]))

    def mirrored(self) -> Bridge:
        """Return the mirror image in the x axis, of a contour that is turned round."""
        return Bridge((self.end[0], -self.end[1]), (self.start[0], -self.start[1]))

    def turned(self, angle: float) -> Bridge:
        """Return the stretch turned counter-clockwise about the origin by an angle, rad."""
        c, s = math.cos(angle), math.sin(angle)
        first, last = ((c * x - s * y, s * x + c * y) for x, y in self)
        return Bridge(first, last)

    @property
    def angles(self) -> tuple[float, float]:
        """Polar angles of its ends, rad: the first in [0, 2 pi), the second beyond it by less than a turn."""
        first, last = (math.atan2(y, x) for x, y in self)
        return first % TURN, first % TURN + (last - first) % TURN


def bulge_across(start: Array, end: Array, way: Across, shaft: tuple[float, float] = (0.0, 0.0)) -> float:
    """Bulge of the stretch from start to end (2,), mm, counter-clockwise round the shaft.

    An arc has its centre as near to the shaft as can be: it goes on as a circle about it where both ends are equally
    far from it.
    """
    if way == "chord":
        return 0.0
    chord = end - start
    normal = np.array([-chord[1], chord[0]]) / math.hypot(*chord)
    centre = 0.5 * (start + end)
    centre = centre + float((np.array(shaft) - centre) @ normal) * normal
    (x, y), (x2, y2) = start - centre, end - centre
    return math.tan(0.25 * (math.atan2(x * y2 - y * x2, x * x2 + y * y2) % TURN))


def closed_across(contour: Contour, way: Across) -> tuple[Contour, Bridge] | None:
    """The outline, counter-clockwise, with its slot closed, and the stretch that closes it; the shaft is at the origin.

    The outline does not go round the shaft, as a slot goes from there out through its rim. It is closed between the
    two vertices beyond which the shaft does not see the rim. None where the shaft does not lie in such a slot.
    """
    contour = contour if contour.area > 0.0 else contour.reversed()
    # the angle as it grows along the rim; within the slot it comes back
    angle = np.unwrap(np.arctan2(*contour.sample(8).T[::-1]))[::8]
    first, last = int(angle.argmin()), int(angle.argmax())
    if angle[last] - angle[first] <= np.pi:
        return None
    count = (last - first) % len(contour)
    rim = contour.take((first + np.arange(count)) % len(contour))
    start, end = contour.start[last], contour.start[first]
    bulge = bulge_across(start, end, way)
    stretch = Pieces.from_chords(start[None], end[None], np.array([bulge]))
    closed = Contour.from_pieces(Pieces.joined([rim, stretch]))
    return closed, Bridge((float(start[0]), float(start[1])), (float(end[0]), float(end[1])))


def notched(contour: Contour, bridge: Bridge) -> Contour:
    """The contour with a notch towards the shaft, at the origin, in place of the stretch that closes it."""
    start, end = (np.array(place) for place in bridge)
    return _with_corners(contour, bridge, [0.5 * DEEP * (start + end)])


def tented(contour: Contour, bridge: Bridge) -> Contour:
    """The contour with its tangents on either side in place of the stretch that closes it, up to where they meet.

    Where they do not meet within some chords of it, each goes on for one chord.
    """
    start, end = (np.array(place) for place in bridge)
    k, chord = _stretch(contour, bridge), end - start
    before, behind = contour.directions[1][k - 1], contour.directions[0][(k + 1) % len(contour)]
    out, back = (np.array([np.cos(angle), np.sin(angle)]) for angle in (before, behind + np.pi))
    across = out[0] * back[1] - out[1] * back[0]
    if across:
        along = (chord[0] * back[1] - chord[1] * back[0]) / across, (chord[0] * out[1] - chord[1] * out[0]) / across
        if min(along) > 0.0 and max(along) <= FAR * np.hypot(*chord):
            return _with_corners(contour, bridge, [start + along[0] * out])
    size = float(np.hypot(*chord))
    return _with_corners(contour, bridge, [start + size * out, end + size * back])


def _stretch(contour: Contour, bridge: Bridge) -> int:
    """Index of the piece that closes the contour."""
    off = np.abs(contour.start - bridge.start).sum(axis=1) + np.abs(contour.end - bridge.end).sum(axis=1)
    return int(off.argmin())


def _with_corners(contour: Contour, bridge: Bridge, corners: list[Array]) -> Contour:
    """The contour with lines by way of corners (2,) in place of the stretch that closes it."""
    k = _stretch(contour, bridge)
    places = np.array([contour.start[k], *corners, contour.end[k]])
    lines = Pieces.from_chords(places[:-1], places[1:], np.zeros(len(places) - 1))
    before, behind = contour.take(np.arange(k)), contour.take(np.arange(k + 1, len(contour)))
    return Contour.from_pieces(Pieces.joined([part for part in (before, lines, behind) if len(part)]))
