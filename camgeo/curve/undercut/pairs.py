"""Pairs of points of a pitch curve: proved bounds of the disc that touches it at one and passes through the other.

Over a box, a pair of parameter intervals, bounds are taken about its centre, from the bounds of speed and turn.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from camgeo.curve.curvature import ROUNDING
from camgeo.curve.curve import Curve
from camgeo.curve.parallel import Parallel
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from camgeo.curve.curve import Frame
    from kin.numeric.arrays import Array


@dataclass(frozen=True)
class Pitch:
    """The path of a roller's centre, as a whole curve."""

    curve: Curve

    @staticmethod
    def of(contour: Curve) -> Pitch:
        """Pitch curve of a roller's whole contour, with its own bounds, tighter than the contour's.

        Raises TypeError for a contour that is no `Parallel`.
        """
        if not isinstance(contour.shape, Parallel):
            raise TypeError("only a roller's contour has a pitch curve")
        return Pitch(Curve(contour.shape.base, contour.runs))

    def bounds(self, low: Array, high: Array, points: Frame, t: Array) -> Bends:
        """Bounds of speed and curvature over intervals [low, high] (n,), sharpened about a parameter t (n,) in each.

        `points` are the frames at t.
        """
        b = self.curve.cells.over(low, high)
        far = np.maximum(t - low, high - t)
        # breaks inside an interval spoil Taylor's series about the point, not the bounds of the cells
        speed_change = np.abs(points.speed_slope) * far + 0.5 * b.speed_bend * far**2
        turn_change = np.abs(points.turn_slope) * far + 0.5 * b.turn_bend * far**2
        broken = self._broken(low, high)
        speed_change[broken], turn_change[broken] = np.inf, np.inf
        least = np.maximum(b.speed_low, points.speed - speed_change)
        most = np.minimum(b.speed_high, points.speed + speed_change)
        turn_low = np.maximum(b.turn_low, points.turn - turn_change)
        turn_high = np.minimum(b.turn_high, points.turn + turn_change)
        # where the speed is not proved to be above 0, nothing is known of the curvature
        least = np.where(least > 0.0, least, np.nan)
        bend_low = np.minimum(turn_low / least, turn_low / most)
        bend_high = np.maximum(turn_high / least, turn_high / most)
        return Bends(most, bend_low, bend_high)

    def _broken(self, low: Array, high: Array) -> NDArray[np.bool_]:
        """Whether a break lies inside the intervals (n,)."""
        breaks = np.array(self.curve.runs[0].breaks)
        inside: NDArray[np.bool_] = np.searchsorted(breaks, high) > np.searchsorted(breaks, low, side="right")
        return inside


@dataclass(frozen=True)
class Bends:
    """Greatest speed, mm, and bounds of the curvature, 1/mm, over intervals (n,); nan where none is known."""

    speed: Array
    low: Array
    high: Array


@dataclass(frozen=True)
class Boxes:
    """Pairs of parameter intervals: low and high ends (n, 2)."""

    low: Array
    high: Array


@dataclass(frozen=True)
class Pairs:
    """Bounds for n boxes, each two parameter intervals of points x and y, about their centres (n, 2); lengths in mm.

    R is the radius of the circle that touches the curve at one point and passes through the other. The rows of arrays
    (2, n) are for R that touches at x and at y.

    radius        upper bound of R at the centres (2, n)
    reach         length along the curve of half a box (2, n)
    doubt         by how much reach and turning move the points against each other (2, n)
    chord         lower bound of |x - y| (n,)
    bowl          least eigenvalue of the Hessian of |x - y|^2 / 2 in arc length (n,)
    square        |x - y|^2 at the centres (n,)
    along         components of the chord towards the point of contact along the tangent there (2, n)
    along_change  by how much they may change over the box (2, n)
    across        components of this chord along the outward normal (2, n)
    bend_low      bounds of the curvature over the box, 1/mm (2, n); so is `bend_high`
    slanted       bound of the component of one normal along the other tangent (n,)
    """

    centre: Array
    radius: Array
    reach: Array
    doubt: Array
    chord: Array
    bowl: Array
    square: Array
    along: Array
    along_change: Array
    across: Array
    bend_low: Array
    bend_high: Array
    slanted: Array

    @staticmethod
    def of(pitch: Pitch, boxes: Boxes) -> Pairs:
        """Compute the bounds for n boxes of pairs of a pitch curve."""
        count = boxes.low.shape[0]
        centre = 0.5 * (boxes.low + boxes.high)
        frames = pitch.curve.sample(centre.T.ravel())
        x, y = frames.split(count)
        bends = pitch.bounds(boxes.low.T.ravel(), boxes.high.T.ravel(), frames, centre.T.ravel())
        bend_low, bend_high = bends.low.reshape(2, count), bends.high.reshape(2, count)
        reach = 0.5 * bends.speed.reshape(2, count) * (boxes.high - boxes.low).T
        d = x.point - y.point
        square = np.sum(d * d, axis=1)
        length = np.sqrt(square)
        shift = reach.sum(axis=0)
        along = np.stack([np.sum(d * x.tangent, axis=1), -np.sum(d * y.tangent, axis=1)])
        across = np.stack([np.sum(d * x.normal, axis=1), -np.sum(d * y.normal, axis=1)])
        # how far these may change over the box: d moves by `shift`, the frames turn by bend * reach
        turned = np.maximum(np.abs(bend_low), np.abs(bend_high)) * reach
        doubt = np.nan_to_num(reach + turned * length, nan=np.inf)
        along_change = shift + turned * (length + shift)
        across_change = shift + turned * (np.abs(along) + along_change)
        radius = np.full(across.shape, np.inf)
        least_across = across - ROUNDING * pitch.curve.size  # points of a fold differ by less than they are rounded
        np.divide(square, 2.0 * least_across, out=radius, where=least_across > 0.0)
        # Hessian of |d|^2 / 2 in arc length: [[1 - k across, -T.T'], [-T.T', 1 - k' across']]
        diagonal = 1.0 - np.maximum(
            np.maximum(bend_low * (across - across_change), bend_low * (across + across_change)),
            np.maximum(bend_high * (across - across_change), bend_high * (across + across_change)),
        )
        mixed = np.minimum(np.abs(np.sum(x.tangent * y.tangent, axis=1)) + turned.sum(axis=0), 1.0)
        bowl = 0.5 * (diagonal[0] + diagonal[1]) - np.hypot(0.5 * (diagonal[0] - diagonal[1]), mixed)
        # |d|^2 from its Taylor series about the centre, from its minimum in a bowl, or |d| less the reach
        slope = np.sum(along**2, axis=0)
        least = square - 2.0 * np.sum(np.abs(along) * reach, axis=0) + np.minimum(bowl, 0.0) * np.sum(reach**2, axis=0)
        with np.errstate(divide="ignore", invalid="ignore"):
            least = np.where(bowl > 0.0, np.maximum(least, square - slope / bowl), least)
        chord = np.maximum(length - shift, np.sqrt(np.fmax(least, 0.0)))
        slanted = np.abs(np.sum(x.normal * y.tangent, axis=1)) + turned.sum(axis=0)
        return Pairs(
            centre, radius, reach, doubt, chord, bowl, square, along, along_change, across, bend_low, bend_high, slanted
        )

    def free(self, aim: float) -> NDArray[np.bool_]:
        """Whether R is proved to be at least `aim`, mm, over each box (n,)."""
        # G = |d|^2 - 2 v across is above 0 where R > v = aim; its derivatives are 2 (1 - v k) along, and for the other
        # point 2 (along' - v N.T')
        clear = np.ones(self.square.size, dtype=bool)
        for i in (0, 1):
            other = 1 - i
            steep = np.maximum(np.abs(1.0 - aim * self.bend_low[i]), np.abs(1.0 - aim * self.bend_high[i]))
            own = 2.0 * steep * (np.abs(self.along[i]) + self.along_change[i]) * self.reach[i]
            pull = np.abs(self.along[other]) + self.along_change[other] + aim * self.slanted
            clear &= self.square - 2.0 * aim * self.across[i] > own + 2.0 * pull * self.reach[other]
        return clear | (self.chord >= 2.0 * aim)
