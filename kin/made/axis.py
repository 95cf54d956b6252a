"""The axis about which a shaft's cams stand, against that of their points: shift, lean, each cam's eccentricity.

A cam at a height z is shifted by a + b z where the axis is shifted and leans, and by its own eccentricity besides. The
line is that of least squares over the shifts, weighted by their covariances. A cam that stands off the line of the
others by far more than the uncertainty is left out, so that its eccentricity does not pass for a lean. Where the
residuals of the others are greater than their covariances say, they widen that of the line.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kin.numeric.arrays import Array, Mask

LEAST_CAMS = 3  # at different heights: two have a line through them whatever they are
APART = 0.01  # mm: heights that are closer are one
STANDS_OFF = 4.0  # standard deviations from the line of the others: a cam beyond is left out
UNKNOWNS = 4  # two of the shift, two of the lean


class CamShift(NamedTuple):
    """Shift (2,) of a cam across the shaft at a height, mm, and its covariance (2, 2), mm^2."""

    height: float
    shift: Array
    covariance: Array


@dataclass(frozen=True, eq=False)
class Axis:
    """Straight axis through most of the cams.

    middle                 height, mm, at which the shift is stated
    shift, lean (2,)       mm, and mm by mm of height
    covariance (4, 4)      of x and y of the shift, mm, then of the lean
    own (m, 2)             eccentricity of each cam about the axis, mm
    own_deviations (m,)    its standard deviation in the most uncertain direction, mm
    length                 range of the heights of the cams, mm
    """

    middle: float
    shift: Array
    lean: Array
    covariance: Array
    own: Array
    own_deviations: Array
    length: float

    @property
    def lean_deviation(self) -> float:
        """Standard deviation of the lean in its own direction, mm by mm of height; along x where it is 0."""
        size = float(np.hypot(*self.lean))
        direction = self.lean / size if size else np.array([1.0, 0.0])
        return float(np.sqrt(direction @ self.covariance[2:, 2:] @ direction))

    def shifts(self, height: Array) -> Array:
        """Shift of the axis (n, 2) at heights (n,), mm."""
        shifts: Array = self.shift + (height - self.middle)[:, None] * self.lean
        return shifts


def heights_of(cams: Sequence[CamShift]) -> int:
    """Number of different heights at which cams stand, in steps of 0.01 mm."""
    return len({round(cam.height / APART) for cam in cams})


def axis_of(cams: Sequence[CamShift]) -> Axis | None:
    """Axis fitted to the shifts of cams by weighted least squares; None for cams at fewer than 3 heights.

    A cam more than 4 standard deviations off the axis of the others is left out, the farthest first, as long as 3
    heights are left.
    """
    if heights_of(cams) < LEAST_CAMS:
        return None
    height = np.array([cam.height for cam in cams])
    middle = float(0.5 * (height.min() + height.max()))
    # shift of each cam = row @ (shift, lean)
    rows = [np.hstack([np.eye(2), (z - middle) * np.eye(2)]) for z in height.tolist()]
    chosen = np.ones(len(cams), dtype=bool)
    while True:
        line, covariance = _line(cams, rows, chosen)
        own = np.stack([cam.shift - row @ line for cam, row in zip(cams, rows, strict=True)])
        # each chosen cam against the line of the others, in standard deviations (Mahalanobis)
        off = np.zeros(len(cams))
        for k in np.flatnonzero(chosen).tolist():
            without = chosen.copy()
            without[k] = False
            if heights_of([cam for cam, kept in zip(cams, without.tolist(), strict=True) if kept]) >= LEAST_CAMS:
                others, of_others = _line(cams, rows, without)
                apart = cams[k].shift - rows[k] @ others
                spread = cams[k].covariance + rows[k] @ of_others @ rows[k].T
                off[k] = float(np.sqrt(apart @ np.linalg.solve(spread, apart)))
        if off.max() <= STANDS_OFF:
            break
        chosen[int(np.argmax(off))] = False
    deviations = [_greatest(cam.covariance + row @ covariance @ row.T) for cam, row in zip(cams, rows, strict=True)]
    return Axis(middle, line[:2], line[2:], covariance, own, np.array(deviations), float(height.max() - height.min()))


def _line(cams: Sequence[CamShift], rows: Sequence[Array], chosen: Mask) -> tuple[Array, Array]:
    """Shift and lean (4,) of the line through chosen cams, and their covariance (4, 4), widened by the residuals."""
    kept = np.flatnonzero(chosen).tolist()
    weights = {k: np.linalg.inv(cams[k].covariance) for k in kept}
    inverse = np.linalg.inv(np.sum([rows[k].T @ weights[k] @ rows[k] for k in kept], axis=0))
    line = inverse @ np.sum([rows[k].T @ weights[k] @ cams[k].shift for k in kept], axis=0)
    left = [(cams[k].shift - rows[k] @ line, weights[k]) for k in kept]
    square = sum(float(residual @ weight @ residual) for residual, weight in left)
    return line, max(square / max(2 * len(kept) - UNKNOWNS, 1), 1.0) * inverse


def _greatest(covariance: Array) -> float:
    """Standard deviation in the direction in which a covariance is the greatest."""
    return float(np.sqrt(np.linalg.eigvalsh(covariance)[-1]))
