"""Lines along which a turret's rollers touch the exact flanks, by vectors: place, pressure angle, regularity, curvature.

With the axis c = o + rho u, its derivative c' by theta and the unit vector n square to u and c' (equation of meshing,
F. L. Litvin, Gear Geometry and Applied Theory, 1994) the flank of a roller of the radius R is p = c + side R n. Its
derivatives p_theta = c' + side R n_theta and p_rho = u + side R n_rho span the tangent plane; D = |p_theta x p_rho| n
is above 0 where the flank is regular. Along the line of contact both bodies bend alike, so that the sum of curvatures
across it follows from any one direction, here p_theta:

    kappa = side ((p_theta.e)(c'.e)/(side R) - (n_theta.u)(p_theta.u)) |p_rho|^2/D^2,     e = u x n
"""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from camgeo.curve.curve import CurveError
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from camgeo.capabilities.indexing.law import IndexLaw
    from camgeo.capabilities.indexing.turrets import Axis, Turret
    from kin.law.piecewise import Side
    from kin.numeric.arrays import Array

NEWTON, SETTLED = 60, 1e-12  # steps to a layer, and the share of it by which the last one moves


def _dot(a: Array, b: Array) -> Array:
    found: Array = np.sum(a * b, axis=-1)
    return found


@dataclass(frozen=True, eq=False)
class Line:
    """Contacts of a roller of a radius, mm, whose axis is known, at places rho (n,), mm; `side` -1 below it, 1 above."""

    turret: Turret
    axis: Axis
    rho: Array
    radius: float
    side: int

    @cached_property
    def _velocity(self) -> Array:
        return np.asarray(self.axis.o1 + self.rho[..., None] * self.axis.u1)

    @cached_property
    def _normal(self) -> tuple[Array, Array]:
        """The normal, and its length before it was made a unit vector."""
        across = self.turret.turn * np.cross(self.axis.u, self._velocity)
        size = np.linalg.norm(across, axis=-1)
        return across / size[..., None], size

    @property
    def normal(self) -> Array:
        """Unit vectors (n, 3) square to the flank, upwards."""
        return self._normal[0]

    @cached_property
    def points(self) -> Array:
        """Points (n, 3), mm, of the flank, in the turning frame."""
        return np.asarray(self.axis.o + self.rho[..., None] * self.axis.u + self.side * self.radius * self.normal)

    @cached_property
    def place(self) -> tuple[Array, Array, Array]:
        """Polar angle from the frame's own, rad, layer w, mm, and height h in it, mm or rad (n,) each."""
        points = self.points
        return (np.arctan2(points[..., 1], points[..., 0]), *self.turret.place(points))

    @cached_property
    def pressure(self) -> Array:
        """Pressure angle (n,), rad, between the force and the way of the roller; above 0 where the cam drives it up."""
        across = self.turret.turn * np.cross(self.axis.u, self.axis.lead)
        return np.arctan2(_dot(self.normal, across), _dot(self.normal, self.axis.lead))

    @cached_property
    def _bent(self) -> tuple[Array, Array, Array, Array]:
        """Derivatives n_theta, p_theta, p_rho (n, 3), and D, mm (n,)."""
        axis, turn, normal, size = self.axis, self.turret.turn, *self._normal
        faster = axis.o2 + self.rho[..., None] * axis.u2
        by_theta = turn * (np.cross(axis.u1, self._velocity) + np.cross(axis.u, faster))
        by_rho = turn * np.cross(axis.u, axis.u1)
        n_theta, n_rho = (
            (each - normal * _dot(normal, each)[..., None]) / size[..., None] for each in (by_theta, by_rho)
        )
        reach = self.side * self.radius
        p_theta, p_rho = self._velocity + reach * n_theta, axis.u + reach * n_rho
        return n_theta, p_theta, p_rho, -turn * _dot(np.cross(p_theta, p_rho), normal)

    @property
    def regular(self) -> Array:
        """D (n,), mm: below 0 the flank turns back, and is undercut."""
        return self._bent[3]

    @property
    def sweep(self) -> tuple[Array, Array]:
        """Derivatives (n, 3) of the points by theta and by rho, mm."""
        return self._bent[1], self._bent[2]

    @cached_property
    def curvature(self) -> Array:
        """Sum of the curvatures of both bodies across the line (n,), 1/mm, of a regular flank."""
        n_theta, p_theta, p_rho, regular = self._bent
        e = np.cross(self.axis.u, self.normal)
        bent = _dot(p_theta, e) * _dot(self._velocity, e) / (self.side * self.radius)
        bent -= _dot(n_theta, self.axis.u) * _dot(p_theta, self.axis.u)
        return np.asarray(self.side * bent * _dot(p_rho, p_rho) / regular**2)


@dataclass(frozen=True, eq=False)
class Lines:
    """All lines of contact of one flank: that of a roller of a radius, mm, below it (`side` -1) or above it (1).

    `start` is the angle on the turret, rad, at which the roller stands at S = 0.
    """

    turret: Turret
    law: IndexLaw
    start: float
    radius: float
    side: int

    def axis(self, theta: Array, at: Side = 1) -> Axis:
        """Axes of the roller at shaft angles of any shape, rad; at a break of one side."""
        rows = self.law.derivatives(theta.ravel(), 2, at).reshape(3, *theta.shape)
        rows[0] += self.start
        return self.turret.axis(rows)

    def along(self, theta: Array, rho: Array, at: Side = 1) -> Line:
        """Contacts at shaft angles and places along the roller, both (n,)."""
        return Line(self.turret, self.axis(theta, at), rho, self.radius, self.side)

    def on(self, theta: Array, w: float, at: Side = 1) -> Line:
        """Contacts at shaft angles (n,) in a layer w, mm; raises CurveError where none is found."""
        axis = self.axis(theta, at)
        rho = np.full(theta.shape, float(w))
        for _ in range(NEWTON):
            line = Line(self.turret, axis, rho, self.radius, self.side)
            step = (line.place[1] - w) / self.turret.outward(line.points, line.sweep[1])
            rho = np.clip(rho - step, 0.5 * rho, 2.0 * rho)
            if not (np.abs(step) > SETTLED * w).any():
                return Line(self.turret, axis, rho, self.radius, self.side)
        raise CurveError("a roller does not touch a layer at one place", 0.0)
