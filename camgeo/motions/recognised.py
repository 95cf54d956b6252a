"""A motion that was recognised from a part, written as the segments of a recipe, as round as it is known."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from camgeo.schema.change import Value
    from kin.follower.recognised import Moved, Programme

MOST_LEFT = 2.0  # readings by which laws may be off: beyond, a motion is a table
ROUND = (1.0, 0.5, 0.1, 0.05, 0.01, 0.005, 0.001, 0.0005, 0.0001)  # steps of written numbers, coarsest first
AT_ZERO = 3.0  # degrees: a stroke that ends or begins so near the turn's beginning is tried as one that does so there
ANGLES = 9  # decimals of a degree in texts: what is less is rounding
STROKES_BEGIN = "the turn begins within a stroke"


class Recognised(NamedTuple):
    """A motion and its programme, to be written in a unit of which 1 mm, or 1 rad of an arm, is `scale`.

    `most`, mm or rad, is how far segments may leave the motion: beyond, there are none. `unit` is the word of the unit.
    """

    motion: Moved
    programme: Programme
    most: float
    scale: float
    unit: str

    def shown(self, value: float) -> float:
        """A displacement, mm or rad, in the unit."""
        return self.scale * value

    @property
    def zero(self) -> float:
        """Position at which a recipe's displacement is 0: the least over a turn, the first over a part of one."""
        return float(self.programme.levels.min() if self.motion.closed else self.programme.levels[0])

    @property
    def left(self) -> float:
        """Greatest distance of the motion from its segments as they are written, mm or rad."""
        pairs = zip(self.programme.boundaries.tolist(), self.programme.uncertainty[0].tolist(), strict=True)
        boundaries = np.radians([self.angle(boundary, off) for boundary, off in pairs])
        levels = self.zero + np.array(self._heights()) / self.scale
        return self.programme.written(self.motion, boundaries, levels).greatest

    def segments(self) -> tuple[list[Value] | None, str]:
        """Segments of the motion from angle 0 on, in the unit and degrees; else None, and the reason."""
        programme, whole = self.programme, math.degrees(self.motion.span)
        angles = [
            self.angle(float(k), float(off))
            for k, off in zip(programme.boundaries, programme.uncertainty[0], strict=True)
        ]
        order = sorted(programme.strokes, key=lambda stroke: angles[stroke.first])
        if any(0.0 < angles[stroke.last] < angles[stroke.first] for stroke in order):
            return None, STROKES_BEGIN
        # rounded, the strokes must still fit the positions
        heights, left = self._heights(), self.left
        if left > self.most:
            return None, f"the laws that fit best leave {self.shown(left):.3g} {self.unit}"
        segments: list[Value] = []
        at = 0.0
        for stroke in order:
            begin, end = angles[stroke.first], angles[stroke.last] or whole
            if begin > at:
                segments.append({"dwell": float(f"{begin - at:.9g}")})
            height = float(f"{heights[stroke.high] - heights[stroke.low]:.9g}")
            kind = "rise" if height > 0.0 else "return"
            segments.append({kind: abs(height), "over": float(f"{end - begin:.9g}"), "law": stroke.law})
            at = end
        if at < whole:
            segments.append({"dwell": float(f"{whole - at:.9g}")})
        return segments, ""

    def angle(self, boundary: float, uncertainty: float) -> float:
        """A boundary in degrees, as round as its uncertainty permits: from 0 to below 360, or to the end of a part."""
        motion = self.motion
        if not motion.closed and abs(math.degrees(boundary - motion.span)) <= AT_ZERO:
            return math.degrees(motion.span)
        near = roundest(math.degrees(math.remainder(boundary, 2.0 * math.pi)), math.degrees(uncertainty))
        return 0.0 if abs(near) <= AT_ZERO else near % 360.0

    def _heights(self) -> list[float]:
        """Levels above the zero of displacements, in the unit, rounded by their uncertainty."""
        above = self.programme.levels - self.zero
        pairs = zip(above.tolist(), self.programme.uncertainty[1].tolist(), strict=True)
        return [roundest(self.shown(height), self.shown(unsure)) for height, unsure in pairs]

    def lines(self) -> list[str]:
        """Lines of text on each stroke: height, angles and law, with uncertainties."""
        programme, unsure, lines = self.programme, self.programme.uncertainty[0], []
        order = sorted(programme.strokes, key=lambda s: self.angle(programme.boundaries[s.first], unsure[s.first]))
        for number, stroke in enumerate(order, start=1):
            begin, end = (math.degrees(programme.boundaries[k]) for k in (stroke.first, stroke.last))
            begin = math.remainder(begin, 360.0) if begin > 360.0 - AT_ZERO else begin
            begin = round(begin, ANGLES)
            end = begin + (end - begin) % 360.0
            widest = max(math.degrees(unsure[k]) for k in (stroke.first, stroke.last))
            height = self.shown(float(programme.levels[stroke.high] - programme.levels[stroke.low]))
            off = self.shown(float(np.hypot(*(programme.uncertainty[1][k] for k in (stroke.low, stroke.high)))))
            law = f"{stroke.law} leaves {self.shown(stroke.residual):.2g} {self.unit}"
            if stroke.others:
                law += f", {', '.join(stroke.others)} hardly more: look at which it was"
            lines.append(
                f"stroke {number}: {height:.6g} +- {off:.2g} {self.unit} "
                f"from {begin:.5g} to {end:.5g} +- {widest:.2g} degrees; {law}"
            )
        return lines


def roundest(value: float, uncertainty: float) -> float:
    """The roundest number within an uncertainty of a value, to nine digits where no step of `ROUND` is."""
    for step in ROUND:
        near = round(value / step) * step
        if abs(near - value) <= max(uncertainty, 0.5 * ROUND[-1]):
            return float(f"{near:.9g}")
    return float(f"{value:.9g}")


def in_flow(value: Value) -> str:
    """A segment on one line of YAML, its numbers to nine digits."""
    if isinstance(value, dict):
        return f"{{{', '.join(f'{key}: {in_flow(entry)}' for key, entry in value.items())}}}"
    return f"{value:.9g}" if isinstance(value, float) else str(value)
