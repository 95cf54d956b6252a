"""Mass, centre of mass, moment of inertia and unbalance of each disc, from its exact outline and its openings.

Every section is an area with holes; its moments are line integrals (`camgeo.curve.measures`). A section within a
chamfer shrinks evenly, so that its moments are polynomials of the height, of the fourth degree at most, which three
Gauss nodes integrate exactly. Cross holes are left out.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from camgeo.curve.measures import Moments, moments, moments_of_chain
from kin.numeric.quadrature import gauss
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from camgeo.part.body import Body
    from camgeo.recipe.recipe import Recipe
    from camgeo.synthesis.design import Design, Disc
    from kin.numeric.arrays import Array
    from kin.read.layers import Layer

KG = 1e-9  # m^3 in a mm^3: from kg/m^3 to kg/mm^3
NODES, WEIGHTS = gauss(3)


@dataclass(frozen=True)
class Balance:
    """Mass of a disc, kg; centre of mass (3,), mm, as the part is drawn; moment of inertia about the shaft, kg mm^2.

    `unbalance` is the mass times the distance of its centre from the shaft, kg mm. `error` is the greatest error of the
    integrals, as a share of the disc's volume and size. `without` names features that are left out; `surface` is the
    name of the disc, empty for a cam of one disc.
    """

    mass: float
    centre: tuple[float, float, float]
    inertia: float
    unbalance: float
    error: float
    without: tuple[str, ...] = ()
    surface: str = ""

    @property
    def eccentricity(self) -> float:
        """Distance of the centre of mass from the shaft, mm."""
        return self.unbalance / self.mass

    @property
    def direction(self) -> float:
        """Polar angle of the centre of mass as the part is drawn, degrees, from 0 to less than 360."""
        angle = math.degrees(math.atan2(self.centre[1], self.centre[0])) % 360.0
        return angle if angle < 360.0 else 0.0


def balances_of(recipe: Recipe, design: Design) -> tuple[Balance, ...]:
    """Mass properties of each disc at `part.density`; empty without a density.

    Discs without a part or a contour, or of several bodies, are left out. Raises CurveError as `moments` does.
    """
    density = recipe.part.density
    if density is None:
        return ()
    mirror = -1.0 if recipe.rotation == "ccw" else 1.0
    balances = []
    for disc in design.discs:
        if disc.body is None or not disc.contours or (len(disc.contours) > 1 and disc.body.pocket is None):
            continue
        name = disc.name if len(design.discs) > 1 else ""
        balances.append(replace(_balance(disc, disc.body, density * KG, mirror), surface=name))
    return tuple(balances)


def _balance(disc: Disc, body: Body, density: float, mirror: float) -> Balance:
    from camgeo.part.as_intent import layers_of

    volume, error = np.zeros(5), np.zeros(4)  # integrals of 1, x, y, r^2 and z
    for layer in layers_of(body):
        half, middle = 0.5 * (layer.high - layer.low), 0.5 * (layer.high + layer.low)
        even = layer.inset == (0.0, 0.0)
        for node, weight in [(0.0, 2.0)] if even else zip(NODES.tolist(), WEIGHTS.tolist(), strict=True):
            z = middle + half * node
            section, off = _section(disc, body, layer, layer.inset_at(z))
            volume += weight * half * np.append(section, z * section[0])
            error += weight * half * off
    mass, x, y, inertia, z = (density * volume).tolist()
    size = max(contour.size for _, contour in disc.contours)
    share = float((error / (volume[0] * np.array([1.0, size, size, size * size]))).max())
    without = tuple(hole.name for hole in body.cross_holes)
    centre = (x / mass, mirror * y / mass, z / mass)
    return Balance(mass, centre, inertia, math.hypot(x, y), share, without)


def _section(disc: Disc, body: Body, layer: Layer, inset: float) -> tuple[Array, Array]:
    """Area and integrals of x, y and r^2 over a layer's section (4,), and their errors (4,).

    The outline is `inset` mm inside the contour.
    """
    holes = [moments_of_chain(hole.contour.as_arcs()[0]) for hole in layer.holes]
    if layer.outline is not None:
        outlines = [(1.0, moments_of_chain(layer.outline.contour.as_arcs()[0]))]
    else:
        outlines = [(float(surface.side), moments(contour, inset)) for surface, contour in disc.contours]
        if body.rim is not None:
            outlines.append((1.0, moments_of_chain(body.rim.chain)))
    solid = sum((sign * _row(area) for sign, area in outlines), np.zeros(4))
    return solid - sum(map(_row, holes), np.zeros(4)), sum((np.array(area.error) for _, area in outlines), np.zeros(4))


def _row(moments: Moments) -> Array:
    return np.array([moments.area, moments.x, moments.y, moments.polar])
