"""The turret of an indexing cam as meshes that turn beside the cam, to look at."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from camgeo.files.mesh import Mesh
from camgeo.formats.glb import Actor
from camgeo.report.page.scene import poses
from kin.numeric.angles import TURN

if TYPE_CHECKING:
    from collections.abc import Sequence

    from camgeo.capabilities.indexing.design import IndexDesign
    from camgeo.capabilities.indexing.turrets import Bar, Standing
    from kin.numeric.arrays import Array

PARTS = 360  # of a turn, between which a viewer turns steadily
CHORDS = 64  # of a round bar
COLOURS = "#5b8aa6", "#dfe4e8"  # of the body, and of its rollers


def turret_actors(design: IndexDesign) -> list[Actor]:
    """Body and rollers of the turret, which stands where the polar angle is 0 and turns by its motion."""
    recipe = design.recipe
    standing = recipe.turret.standing(recipe.roller, recipe.stops)
    drawn = recipe.turret.drawn(recipe.roller, recipe.stops, recipe.sense)
    psi = recipe.start + design.law.derivatives(np.linspace(0.0, TURN, PARTS + 1), 0)[0]
    right, height = drawn.centre
    x, y, _ = (right * np.array(standing.right)).tolist()
    pose = poses(x, y, psi if drawn.way > 0 else math.pi - psi)
    meshes = (_mesh(standing, bars) for bars in (standing.body, standing.rollers))
    return [
        Actor(name, mesh, pose, colour, standing.axis, height)
        for name, mesh, colour in zip(("turret", "rollers"), meshes, COLOURS, strict=True)
    ]


def _mesh(standing: Standing, bars: Sequence[Bar]) -> Mesh:
    """Bars as one mesh, in axes parallel to the cam's, about the turret's centre."""
    axes = np.array([standing.right, (0.0, 0.0, 1.0), standing.axis])
    points, triangles = zip(*(_bar(bar) for bar in bars), strict=True)
    size = len(points[0])
    return Mesh(np.concatenate(points) @ axes, np.concatenate([part + size * k for k, part in enumerate(triangles)]))


def _bar(bar: Bar) -> tuple[Array, Array]:
    """Points (2 CHORDS + 2, 3), mm, and triangles (t, 3) of a round bar, which run counter-clockwise from outside."""
    start, end = np.array(bar.start), np.array(bar.end)
    along = (end - start) / np.linalg.norm(end - start)
    # across the bar: beside that axis along which it runs least
    across = np.cross(along, np.eye(3)[int(np.argmin(np.abs(along)))])
    across /= np.linalg.norm(across)
    t = np.arange(CHORDS) * (TURN / CHORDS)
    ring = bar.radius * (np.outer(np.cos(t), across) + np.outer(np.sin(t), np.cross(along, across)))
    points = np.concatenate([start + ring, end + ring, [start, end]])
    i = np.arange(CHORDS)
    j = np.roll(i, -1)
    low, high = np.full(CHORDS, 2 * CHORDS), np.full(CHORDS, 2 * CHORDS + 1)
    rows = [(i, j, j + CHORDS), (i, j + CHORDS, i + CHORDS), (j, i, low), (i + CHORDS, j + CHORDS, high)]
    return points, np.concatenate([np.column_stack(row) for row in rows])
