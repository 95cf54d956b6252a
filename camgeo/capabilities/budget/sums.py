"""Sums of errors over the shaft angle, in the worst case and as the root of the sum of squares, and their shares.

The error of a contour that is not exact is known, and adds to either sum.

In shapes c is the number of contributions and n that of shaft angles.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Literal, NamedTuple, TypeAlias

import numpy as np

from camgeo.capabilities.budget.dimensions import CONTOUR

if TYPE_CHECKING:
    from collections.abc import Mapping

    from camgeo.capabilities.budget.influence import Influence, Output
    from kin.numeric.arrays import Array

Sum: TypeAlias = Literal["worst", "rss"]
POWERS: Mapping[Sum, int] = {"worst": 1, "rss": 2}  # q: a sum is (sum of addends^q)^(1/q)


def powers(influence: Influence, output: Output, sum_: Sum) -> Array:
    """Influence times tolerance of each contribution at each angle, (c, n); under "rss" its square.

    It is 0 for a free dimension.
    """
    tolerances = np.array([contribution.tolerance or 0.0 for contribution in influence.contributions])
    added: Array = (output.weights * tolerances[:, None]) ** POWERS[sum_]
    return added


def total(influence: Influence, output: Output, sum_: Sum) -> Array:
    """The sum of errors at each angle (n,), mm or rad of the motion: worst case, or root of the sum of squares."""
    added: Array = powers(influence, output, sum_).sum(axis=0) ** (1.0 / POWERS[sum_]) + np.abs(output.contour)
    return added


def spread(influence: Influence, output: Output) -> Array:
    """Standard deviation of the error at each angle (n,), mm or rad of the motion.

    It is sqrt(sum (w t)^2/3 + sum (w r)^2/2) by the influences w. Sizes are taken as uniform within their tolerances t;
    displacements have the full radius r in a random direction.
    """
    squares = powers(influence, output, "rss")
    # a contribution of one component is a size, of two a displacement
    parts = [3.0 if contribution.rows.shape[1] == 1 else 2.0 for contribution in influence.contributions]
    deviation: Array = np.sqrt((squares / np.array(parts)[:, None]).sum(axis=0))
    return deviation


def by_name(influence: Influence, rows: Array) -> dict[str, Array]:
    """Sum (n,) of the `rows` (c, n) of each dimension's contributions, by the word of the dimension."""
    names = [contribution.name for contribution in influence.contributions]
    return {name: rows[[i for i, own in enumerate(names) if own == name]].sum(axis=0) for name in influence.names}


class Worst(NamedTuple):
    """The greatest sum of errors over all angles and contacts: `value`, mm or rad of the motion.

    `at` is its shaft angle, rad, and `contact` the name of its contact. `shares` has the fraction of the sum that each
    dimension makes, and CONTOUR where it is not exact; what the dimensions add as a root of squares is shared by the
    squares. All are 0 where the sum is 0.
    """

    value: float
    at: float
    contact: str
    shares: Mapping[str, float]


def worst(influence: Influence, sum_: Sum) -> Worst:
    """The greatest sum over the angles and contacts, and the share of each dimension in it."""
    outputs = influence.outputs()
    sums = np.stack([total(influence, output, sum_) for output in outputs])
    contact, place = np.unravel_index(int(np.argmax(sums)), sums.shape)
    added = {
        name: float(row[place]) for name, row in by_name(influence, powers(influence, outputs[contact], sum_)).items()
    }
    whole, value = math.fsum(added.values()) or 1.0, float(sums[contact, place])
    known = abs(float(outputs[contact].contour[place])) / (value or 1.0)
    shares = {} if influence.contour is None else {CONTOUR: known}
    shares |= {name: (1.0 - known) * part / whole for name, part in added.items()}
    return Worst(value, float(influence.shaft[place]), outputs[contact].name, shares)
