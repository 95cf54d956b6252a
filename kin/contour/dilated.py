"""Boundary of what a disc's centre cannot enter: the metal, dilated by the disc's radius, in lines and arcs."""

from __future__ import annotations

import numpy as np

from kin.contour.arcs import Arcs, circle, right

STRAIGHT_ON = 1e-12  # corners that turn less, in radians, get no arc of their own


def dilated(chain: Arcs, radius: float) -> Arcs:
    """Pieces, in no order, among them the whole boundary of the region that a disc's centre cannot enter.

    The metal lies left of the closed chain; `radius` is the disc's, mm. Of radius 0, the point of a knife edge, the
    boundary is the chain itself.
    """
    if radius == 0.0:
        return chain
    # moved outward by r, a piece of curvature k and length L has k/(1 + k r) and L (1 + k r)
    growth = 1.0 + chain.curvature * radius
    fits = growth > 0.0
    moved = chain.start + radius * right(chain.tangent)
    pieces = Arcs(moved, chain.tangent, chain.curvature / np.where(fits, growth, 1.0), chain.length * growth).take(fits)
    # about convex corners arcs of the disc's radius
    turns = chain.turns()
    corner = turns > STRAIGHT_ON
    before = np.roll(chain.end_tangents, 1, axis=0)[corner]
    vertices = chain.start[corner]
    bend = np.full(len(vertices), 1.0 / radius)
    pieces = pieces.joined(Arcs(vertices + radius * right(before), before, bend, radius * turns[corner]))
    if not fits.all():  # hollows too tight for the disc: it rests on their edges
        edges = np.concatenate([chain.start[~fits], chain.ends[~fits]])
        pieces = pieces.joined(circle(edges, np.full(len(edges), radius)))
    return pieces
