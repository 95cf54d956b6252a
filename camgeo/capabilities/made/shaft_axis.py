"""The axis about which the cams of a measured shaft stand: its lean, its shift, and each cam's own eccentricity."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from camgeo.measures.units import UNIT_NAMES
from kin.contour.arcs import turned
from kin.follower.recognised import COVERAGE
from kin.made.axis import CamShift, axis_of
from kin.made.smooth import TRIFLE
from kin.numeric.angles import degrees
from kin.numeric.records import replace

if TYPE_CHECKING:
    from collections.abc import Sequence

    from camgeo.recipe.recipe import ShaftOrder
    from kin.made.axis import Axis
    from kin.numeric.arrays import Array

CERTAIN = 2.0  # a lean above so many times its expanded uncertainty has a remark


class Leaning(NamedTuple):
    """The axis of a shaft by its points, in the shaft's axes as if not mirrored.

    `names` are the names of the cams; `removed` is whether lean and shift were taken out of the points.
    """

    axis: Axis
    names: Sequence[str]
    removed: bool

    def after(self, later: Leaning) -> Leaning:
        """The axis that is left in a `later` round, with the lean and the shift of this one added."""
        axis = replace(later.axis, shift=self.axis.shift + later.axis.shift, lean=self.axis.lean + later.axis.lean)
        return self._replace(axis=axis)

    def section(self, recipe: ShaftOrder) -> dict[str, Any]:
        """Report entry `axis`: as drawn, lengths in the recipe's unit, angles in degrees, uncertainties with k = 2."""
        axis, mm, drawn = self.axis, recipe.mm, np.array([1.0, -1.0 if recipe.rotation == "ccw" else 1.0])
        x, y = (drawn * axis.lean).tolist()
        return {
            "unit": UNIT_NAMES[recipe.units],
            "z": axis.middle / mm,
            "shifted": (drawn * axis.shift / mm).tolist(),
            "shift_uncertainty": COVERAGE * float(np.sqrt(np.linalg.eigvalsh(axis.covariance[:2, :2])[-1])) / mm,
            "leans_deg": math.degrees(math.hypot(x, y)),
            "uncertainty_deg": math.degrees(COVERAGE * axis.lean_deviation),
            "towards_deg": degrees(math.atan2(y, x)),
            "over": axis.length / mm,
            "removed": self.removed,
            "eccentricity": [
                {
                    "name": name,
                    "shifted": (drawn * own / mm).tolist(),
                    "value": float(np.hypot(*own)) / mm,
                    "uncertainty": COVERAGE * float(sd) / mm,
                }
                for name, own, sd in zip(self.names, axis.own, axis.own_deviations.tolist(), strict=True)
            ],
        }

    def remarks(self) -> list[str]:
        """Remark on a lean that was taken out, or that is certain; else empty."""
        axis = self.axis
        lean, unsure = float(np.hypot(*axis.lean)), COVERAGE * axis.lean_deviation
        amount = f"{math.degrees(lean):.3g} +- {math.degrees(unsure):.2g} degrees"
        if self.removed:
            return [
                f"a lean of {amount} and a shift of the axis were taken out by --align best-fit: motions show neither"
            ]
        if lean <= CERTAIN * unsure:
            return []
        over = f"{1e3 * lean * axis.length:.3g} micrometres over {axis.length:.4g} mm"
        return [f"the axis of the shaft leans by {amount}, {over}, against that of z: `--align best-fit` takes it out"]


def leaning_of(
    names: Sequence[str], cams: Sequence[tuple[float, float, tuple[Array, Array]]], *, removed: bool = False
) -> Leaning | None:
    """Axis of a shaft by the shift of each cam; None where cams stand at fewer than three heights.

    Each of `cams` has its height, mm, the angle of its own axes in the shaft's, rad, and its shift in its own axes
    (2,), mm, with the covariance (2, 2), mm^2. `names` are the names of the cams; `removed` is whether lean and shift
    are taken out of the points.
    """
    shifts = []
    for height, angle, (shift, covariance) in cams:
        back = np.array([turned(column, np.array(angle)) for column in np.eye(2)]).T
        shifts.append(CamShift(height, back @ shift, back @ (covariance + TRIFLE**2 * np.eye(2)) @ back.T))
    axis = axis_of(shifts)
    return None if axis is None else Leaning(axis, names, removed)
