"""From the cutter's path to passes: where it begins, which way it runs, how the cutter comes to it and leaves it."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from camgeo.curve.ring import radius_of
from camgeo.files.gcode import ClosedPath, Pass
from camgeo.fit.bound import EXACT
from camgeo.fit.pieces import ArcSpline
from kin.contour.contour import Contour

if TYPE_CHECKING:
    from collections.abc import Sequence

    from camgeo.recipe.machining import Manufacture
    from kin.law.contacts import Side
    from kin.numeric.arrays import Array

BESIDE = 1.6  # of the cutter's radius: greatest distance of two paths, so that no stock is left between them
SAME = 1e-9  # mm: a path that begins this near to a joint begins in it
QUARTER = math.tan(math.pi / 8.0)  # bulge of a quarter turn


def begun_at(path: ArcSpline, direction: float) -> ArcSpline:
    """Path that begins in its point farthest in a direction, rad; the piece there is cut in two unless at a joint."""
    contour = Contour.from_bulges(path.points, path.bulges)
    support = contour.support(np.array([direction]))
    piece, point = int(support.piece[0]), support.point[0]
    points, bulges = np.roll(path.points, -piece, axis=0), np.roll(path.bulges, -piece)
    if np.hypot(*(point - points[1 % len(points)])) <= SAME:
        return ArcSpline(np.roll(points, -1, axis=0), np.roll(bulges, -1), path.bound)
    if np.hypot(*(point - points[0])) <= SAME:
        return ArcSpline(points, bulges, path.bound)
    # the piece is cut in two by the turn of the tangent up to the point
    first = float(contour.directions[0][piece])
    sweep = 4.0 * math.atan(float(bulges[0]))
    turned = math.remainder(direction + 0.5 * math.pi - first, 2.0 * math.pi)
    before, after = math.tan(0.25 * turned), math.tan(0.25 * (sweep - turned))
    points = np.concatenate([point[None], points[1:], points[:1]])
    bulges = np.concatenate([[after], bulges[1:], [before]])
    return ArcSpline(points, bulges, path.bound)


def bend_at_begin(path: ArcSpline) -> float:
    """Least radius, mm, of the two pieces that meet where a path begins; infinite where both are straight."""
    points, bulges = path.points, path.bulges
    ends = np.stack([points[1 % len(points)] - points[0], points[0] - points[-1]])
    chords, at = np.hypot(*ends.T), np.abs(bulges[[0, -1]])
    with np.errstate(divide="ignore"):
        return float(radius_of(chords, at).min())


def circle(centre: tuple[float, float], radius: float, direction: float) -> ArcSpline:
    """A counter-clockwise circle, centre and radius in mm, in four arcs, begun in a direction, rad."""
    angle = direction + 0.5 * math.pi * np.arange(4)
    points = np.array(centre) + radius * np.column_stack([np.cos(angle), np.sin(angle)])
    return ArcSpline(points, np.full(4, QUARTER), EXACT)


def led(path: ArcSpline, lead: float, *, side: Side, clockwise: bool) -> ClosedPath:
    """A closed counter-clockwise path, run as `clockwise` says, with quarter turns of radius `lead`, mm, at its ends.

    Both touch the path in its first point, from outside it (`side` 1) or from inside (-1).
    """
    first = float(Contour.from_bulges(path.points, path.bulges).directions[0][0])
    points, bulges = _run(path, clockwise=clockwise)
    along = np.array([math.cos(first), math.sin(first)])
    away = np.array([along[1], -along[0]]) * side
    forward = -along if clockwise else along
    start = points[0]
    enter, leave = start + lead * (away - forward), start + lead * (away + forward)
    turn = forward[0] * away[1] - forward[1] * away[0]  # 1 where the way in turns left
    bend = math.copysign(QUARTER, turn)
    return ClosedPath(
        np.concatenate([enter[None], points, start[None], leave[None]]),
        np.concatenate([[bend], bulges, [bend]]),
        1,
        len(points) + 1,
    )


def plunged(path: ArcSpline, *, clockwise: bool) -> ClosedPath:
    """A closed counter-clockwise path, run as `clockwise` says, in whose first point the cutter comes down."""
    points, bulges = _run(path, clockwise=clockwise)
    return ClosedPath(np.concatenate([points, points[:1]]), bulges, 0, len(points))


def _run(path: ArcSpline, *, clockwise: bool) -> tuple[Array, Array]:
    """Points (n, 2) and bulges (n,) of a closed counter-clockwise path, run as `clockwise` says."""
    if not clockwise:
        return path.points, path.bulges
    return np.roll(path.points[::-1], 1, axis=0), -path.bulges[::-1]


def side_by_side(near: float, far: float, radius: float, allowance: float) -> list[float]:
    """Offsets, mm, between the flanks' paths `near` and `far` at which a cutter of `radius` clears the stock between.

    The middle comes first, then pairs outward; the last pair lies `allowance` off the flanks' paths.
    """
    middle, half = 0.5 * (near + far), 0.5 * (far - near) - math.copysign(allowance, far - near)
    if half * (far - near) <= 0.0:
        return [middle]
    steps = math.ceil(abs(half) / (BESIDE * radius))
    return [middle, *(middle + sign * half * k / steps for k in range(1, steps + 1) for sign in (-1.0, 1.0))]


def depths(thickness: float, depth_of_cut: float) -> list[float]:
    """Heights z of equal passes, mm, from the first down to minus the thickness, at most `depth_of_cut` mm apart."""
    count = max(math.ceil(thickness / depth_of_cut * (1.0 - 1e-12)), 1)
    return [-thickness * (k + 1) / count for k in range(count)]


def passes(
    rough: Sequence[ClosedPath], fine: Sequence[ClosedPath], manufacture: Manufacture, depth: float
) -> list[Pass]:
    """Passes down to `depth`, mm: rough and fine paths at each height.

    With rough paths and an allowance, fine paths follow last, at the full depth alone.
    """
    levels = depths(depth, manufacture.depth_of_cut or depth)
    if not rough or manufacture.allowance is None:
        return [Pass(z, loop) for z in levels for loop in (*rough, *fine)]
    return [*(Pass(z, loop) for z in levels for loop in rough), *(Pass(levels[-1], loop) for loop in fine)]
