"""Pressure of two bodies that touch along a line, by Hertz: K. L. Johnson, Contact Mechanics (1985), eq. (4.45)."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from camgeo.recipe.materials import Material
    from kin.numeric.arrays import Array


def line_pressure(force: Array, curvature: Array, width: float, first: Material, second: Material) -> Array:
    """Greatest pressure of line contacts, N/mm^2, of the arrays' shape: p = sqrt(N kappa/(pi B C)).

    `force` is the normal force N, N, and `curvature` kappa, the sum of both bodies' curvatures, 1/mm, below 0 of a
    hollow; the pressure is 0 where their product is below 0. `width` is B, the length of the line, mm; C is the sum of
    (1 - nu^2)/E of both bodies.
    """
    compliance = sum((1.0 - body.poisson**2) / body.modulus for body in (first, second))
    pressure: Array = np.sqrt(np.maximum(force * curvature, 0.0) / (math.pi * width * compliance))
    return pressure


def bearable(first: Material | None, second: Material | None) -> float | None:
    """The lower of the pressures that two bodies bear, N/mm^2; None where no limit of either is stated."""
    limits = (body.limit for body in (first, second) if body is not None)
    return min((limit for limit in limits if limit is not None), default=None)
