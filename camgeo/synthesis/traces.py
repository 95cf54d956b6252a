"""Paths of points of moving links: as a table over the shaft angle, and as lines in the axes of a drawing."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from kin.numeric.angles import TURN

if TYPE_CHECKING:
    from camgeo.recipe.recipe import Recipe
    from camgeo.synthesis.design import Design
    from kin.numeric.arrays import Array


def trace_table(recipe: Recipe, design: Design) -> tuple[tuple[str, ...], Array]:
    """Column names and rows (angles + 1, k) over equal steps of the shaft: shaft angle, degrees, and four per trace.

    The four are x and y in the fixed axes, in the recipe's unit; the curvature of the path, by that unit, above 0 where
    it turns left, nan where the point stands still; and its speed by radian of the shaft. At a break derivatives are
    those that follow, at the end of the turn those that precede. Raises ValueError without a linkage, PlaceError for
    one that does not turn right round.
    """
    from kin.linkage.trace import traced

    if recipe.linkage is None or design.driven is None:
        raise ValueError(f"{recipe.name}: there is no linkage")
    mechanism, unit, mm = design.driven.mechanism, "in" if recipe.units == "inch" else "mm", recipe.mm
    shaft = np.linspace(0.0, TURN, recipe.verify.angles + 1)
    theta = mechanism.relative(shaft)
    columns = {"shaft_deg": np.degrees(shaft)}
    for k, (on, point) in enumerate(recipe.linkage.traces, start=1):
        parts = traced(mechanism, on, point, theta[:-1]), traced(mechanism, on, point, theta[-1:], -1)
        x, y, speed, curvature = (np.concatenate(rows) for rows in zip(*parts, strict=True))
        columns |= {f"trace_{k}_x_{unit}": x / mm, f"trace_{k}_y_{unit}": y / mm}
        columns |= {f"trace_{k}_curvature": curvature * mm, f"trace_{k}_speed": speed / mm}
    return tuple(columns), np.column_stack(list(columns.values()))


def trace_lines(recipe: Recipe, design: Design, tolerance: float) -> list[tuple[str, Array]]:
    """Name and points (n, 2), mm, of each path in the axes of the cam's drawing, chords within a tolerance, mm.

    The mechanism stands as at shaft angle 0, where the drawing's x axis is the normal of the face whose lift is given,
    a quarter turn ahead of the frame; mirrored where the shaft turns counter-clockwise. Empty where it does not turn.
    Raises RecipeErrors for a path that is too rough to be followed within the tolerance.
    """
    from kin.linkage.trace import flattened
    from kin.numeric.monotone import RoughError

    driven, linkage = design.driven, recipe.linkage
    if linkage is None or driven is None or not linkage.traces or not driven.turns:
        return []
    angle = driven.mechanism.start + 0.5 * math.pi
    turn = np.array([[math.cos(angle), -math.sin(angle)], [math.sin(angle), math.cos(angle)]])
    if recipe.rotation == "ccw":
        turn = turn * (1.0, -1.0)
    lines = []
    for i, trace in enumerate(linkage.traces):
        try:
            points = flattened(driven.mechanism, trace.on, trace.point, tolerance)
        except RoughError as error:
            remedy = "give a point elsewhere, or a wider export.tolerance"
            raise recipe.error(f"linkage.trace[{i}]", str(error), None, remedy) from error
        lines.append((trace.name(recipe.mm), points @ turn))
    return lines
