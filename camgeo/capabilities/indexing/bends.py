"""Proved bounds of the second derivatives of a flank over (theta, rho), by which its triangles are as fine as need be.

With the frame g, tau, n and the speeds P, Q of `camgeo.capabilities.indexing.flank`

    p_11 = (Q_1 + P K) g + (P_1 - Q K) tau - (P T + Q G) n
    p_12 = Q_2 g + P_2 tau + P a_2 n
    p_22 = -side R (a_22 tau + a_2^2 n)

where w a_ij = cos a B_ij - sin a A_ij - a_i w_j - a_j w_i. All are balls over a cell.

`camgeo.fit.facets` bounds by them how far triangles are from the surface.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from camgeo.capabilities.indexing.forms import Pose
from camgeo.fit.facets import facets_off, facets_width
from kin.numeric.interval import Ball

if TYPE_CHECKING:
    from camgeo.capabilities.indexing.flank import Flank, Touch
    from camgeo.capabilities.indexing.forms import Number, Vector
    from kin.numeric.arrays import Array, Indices


class Second(NamedTuple):
    """Second derivatives along g, tau and n: twice by theta, by theta and rho, twice by rho; arrays or balls."""

    theta: Vector
    mixed: Vector
    rho: Vector


class Bends(NamedTuple):
    """Bounds of a flank's second derivatives over cells (n,), in mm and rad.

    across   of |p_ij . n|, (3, n): twice by theta, by theta and rho, twice by rho
    whole    of |p_ij|, (3, n)
    turns    of the turn of the normal by theta and by rho, (2, n)
    """

    across: Array
    whole: Array
    turns: Array

    def off(self, h1: Array, h2: Array | float) -> Array:
        """Bound of the distance of triangles from the surface, mm (n,), in cells of h1 rad by h2 mm."""
        return facets_off(self, h1, h2)

    def step(self, h2: Array | float, tolerance: float) -> Array:
        """Widths h1, rad (n,), of cells of h2 mm whose triangles are within a tolerance, mm; 0 where none is."""
        return facets_width(self, h2, tolerance)

    def most(self, blocks: int) -> Bends:
        """Greatest bounds of corresponding cells in `blocks` equal blocks of them, (n / blocks,)."""

        def over(values: Array) -> Array:
            folded: Array = values.reshape(*values.shape[:-1], blocks, -1).max(axis=-2)
            return folded

        return Bends(*(over(part) for part in self))

    def at(self, index: Indices) -> Bends:
        """Bounds of some of the cells."""
        return Bends(*(part[..., index] for part in self))


def pose_over(flank: Flank, theta: tuple[Array, Array]) -> Pose:
    """The turret as balls over shaft angles from theta[0] to theta[1], rad (n,) each."""
    return Pose.at(Ball(*flank.law.enclosure(theta[0], theta[1], 3)), flank.start)


def second_of(flank: Flank, pose: Pose, rho: Number, touch: Touch) -> Second:
    """Second derivatives of a flank, of arrays or balls."""
    form, reach = flank.form, flank.side * flank.radius
    speed, inverse = form.speed(pose, rho), touch.w**-1
    sine, cosine, a1, a2 = touch.sine, touch.cosine, touch.a1, touch.a2
    a11 = (cosine * speed.b11 - sine * speed.a11 - a1 * touch.w1 * 2.0) * inverse
    a12 = (cosine * speed.b12 - sine * speed.a12 - a1 * touch.w2 - a2 * touch.w1) * inverse
    a22 = a2 * touch.w2 * inverse * -2.0
    bend1 = (touch.w1 * a2 + touch.w * a12) * -1.0
    bend2 = (touch.w2 * a2 + touch.w * a22) * -1.0
    along1 = touch.w1 + (form.tilt(pose)[1] - a11) * reach
    along2 = touch.w2 - a12 * reach
    beside1 = form.slip(pose, rho)[1] + bend1 * reach
    twist = form.twist(pose, sine, cosine)
    return Second(
        (
            beside1 + touch.along * twist,
            along1 - touch.beside * twist,
            (touch.along * touch.turn + touch.beside * touch.bend) * -1.0,
        ),
        (bend2 * reach, along2, touch.along * a2),
        (a2 * 0.0, a22 * -reach, a2 * a2 * -reach),
    )


def bends(flank: Flank, theta: tuple[Array, Array], rho: tuple[Array, Array]) -> Bends:
    """Bounds of second derivatives over cells from theta[0] to theta[1], rad, and rho[0] to rho[1], mm, (n,) each.

    Within a cell the first derivatives of the flank do not jump.
    """
    pose, along = pose_over(flank, theta), Ball.between(*rho)
    touch = flank.touch(pose, along)
    second = second_of(flank, pose, along, touch)
    return Bends(
        np.stack([each[2].magnitude for each in second]),
        np.stack([np.sqrt(sum(part.magnitude**2 for part in each)) for each in second]),
        np.stack([np.hypot(touch.turn.magnitude, touch.bend.magnitude), touch.a2.magnitude]),
    )
