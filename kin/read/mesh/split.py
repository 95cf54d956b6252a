"""Corners of a mesh that a file keeps apart by less than the tolerance, joined where that closes the surface."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kin.numeric.records import replace
from kin.read.mesh.mesh import Mesh

if TYPE_CHECKING:
    from kin.numeric.arrays import Array, Indices, Mask
    from kin.read.mesh.checked import CheckedMesh

MOST_PAIRS = 2_000_000  # pairs of corners that may be near one another


class Joined(NamedTuple):
    """A mesh with the number of corners that were joined to others, and how far apart they were at most, mm."""

    read: CheckedMesh
    corners: int = 0
    apart: float = 0.0


def joined(read: CheckedMesh, reach: float) -> Joined:
    """Join corners at open edges that are less than `reach`, mm, apart, if the surface is sound then; else as it was.

    A triangle that has no area then, since it filled the gap between two corners, is left out.
    """
    mesh = read.mesh
    open_ = _at_open_edges(mesh)
    if not read.faults or not len(open_):
        return Joined(read)
    number = _nearest_first(mesh.points[open_], reach)
    moved = np.flatnonzero(number != np.arange(len(open_)))
    if not len(moved):
        return Joined(read)
    into = np.arange(len(mesh.points))
    into[open_] = open_[number]
    a, b, c = into[mesh.corners].T
    kept: Mask = (a != b) & (b != c) & (c != a)
    used, corners = np.unique(np.stack([a, b, c], axis=1)[kept], return_inverse=True)
    whole = Mesh(mesh.points[used], corners.reshape(-1, 3))
    if whole.faults or whole.shells.any():
        return Joined(read)
    apart = np.linalg.norm(mesh.points[open_[moved]] - mesh.points[open_[number[moved]]], axis=1)
    return Joined(replace(read, mesh=whole, faults=()), len(moved), float(apart.max()))


def _at_open_edges(mesh: Mesh) -> Indices:
    """Numbers of corners at edges with one triangle alone."""
    start, end = mesh.edges
    codes, place, count = np.unique(
        mesh.code(np.minimum(start, end), np.maximum(start, end)), return_index=True, return_counts=True
    )
    single = place[count == 1]
    return np.unique(np.concatenate([start[single], end[single]])) if len(codes) else np.zeros(0, dtype=np.intp)


def _nearest_first(points: Array, reach: float) -> Indices:
    """Number (n,) of the point that each of the points (n, 3) is one with: those in reach of one another are one."""
    order = np.argsort(points[:, 0], kind="stable")
    rising = points[order]
    firsts, lasts, step, total = [], [], 1, 0
    while step < len(points) and total <= MOST_PAIRS:
        near = np.flatnonzero(rising[step:, 0] - rising[:-step, 0] < reach)
        if not len(near):
            break
        total += len(near)
        near = near[np.linalg.norm(rising[near + step] - rising[near], axis=1) < reach]
        firsts.append(order[near])
        lasts.append(order[near + step])
        step += 1
    number = np.arange(len(points))
    if not firsts:
        return number
    a, b = np.concatenate(firsts), np.concatenate(lasts)
    while True:
        before = number.copy()
        least = np.minimum(number[a], number[b])
        np.minimum.at(number, a, least)
        np.minimum.at(number, b, least)
        if (number == before).all():
            return number
