"""Developments of a barrel: its flanks, unrolled at a radius, as a drawing whose layers name it.

A line holds for its radius alone. It runs from one end face to the other, over more than a turn. It is drawn in pieces
of one turn, from x = 0 to the circumference.

On a cylinder a flank is p(theta, rho(theta)). Let p_ij be the derivatives of `camgeo.capabilities.indexing.bends`, o
the unit vector away from the cam's axis, and q = p_11 + 2 p_12 rho' + p_22 rho'^2. The second derivative of the
unrolled line is then the part of q + p_2 rho'' that is square to o, where p_2.o rho'' = -r phi'^2 - q.o. It is bounded
over stretches of the shaft angle, so that the distance of the chords from the line is proved.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Literal, NamedTuple

import numpy as np

from camgeo.capabilities.indexing.bends import pose_over, second_of
from camgeo.capabilities.indexing.keys import OUTER
from camgeo.capabilities.indexing.spans import breaks_within, span_of
from camgeo.fit.bound import Bound
from camgeo.fit.nodes import ToleranceError
from kin.numeric.angles import TURN
from kin.numeric.arrays import runs_of
from kin.numeric.interval import Ball
from kin.turned.files import Developed

if TYPE_CHECKING:
    from pathlib import Path

    from ezdxf.layouts.layout import Modelspace

    from camgeo.capabilities.indexing.design import IndexDesign
    from camgeo.capabilities.indexing.flank import Flank
    from camgeo.fit.bound import Box
    from camgeo.recipe.export import FileRequest
    from kin.numeric.arrays import Array

LOOKS = 720  # parts of a turn over each of which the second derivative is bounded
SPLITS = 8  # rounds by which a part without a bound is halved
WIDEN, GROW = 1e-9, 1.5  # mm by which places along a roller are enclosed at first, and times as much each time
SETTLE = 12  # rounds of enclosing
WIDEST = TURN / 36.0  # rad between two points, however little a line bends
CHORDS = 0.8  # of the tolerance, for chords: the judge's search of the nearest roller takes some
MOST_POINTS = 2_000_000  # of one line
FLANKS: tuple[Literal["lower", "upper"], ...] = ("lower", "upper")
COLOURS = {"lower": 5, "upper": 1}  # of AutoCAD, by flank
MARKS = "TURN"  # end of the name of the layer whose marks enclose a turn


class Line(NamedTuple):
    """A line of a development: its layer and radius, its pieces (n, 2), mm, and the bound of their error, mm."""

    of: Developed
    pieces: list[Array]
    off: float


def developed_line(flank: Flank, radius: float, tolerance: float) -> tuple[Array, float]:
    """Points (n, 2), mm, of a flank unrolled on the cylinder of a radius, mm, and the bound of their distance from it.

    x is the radius times the polar angle, over more than a turn, y the height; it runs from the lower to the upper end
    face. Raises ToleranceError where too many points would be needed, and as `span_of` does.
    """
    begin, end = span_of(flank, np.array([radius])).theta[:, 0].tolist()
    breaks = breaks_within(flank)
    even = np.linspace(begin, end, max(2, math.ceil(LOOKS * (end - begin) / TURN)) + 1)
    look = np.unique(np.concatenate([even, breaks[(breaks > begin) & (breaks < end)]]))
    bend = unrolled_bends(flank, look, radius)
    for _ in range(SPLITS):
        loose = ~np.isfinite(bend)
        if not loose.any():
            break
        look = np.sort(np.concatenate([look, 0.5 * (look[:-1] + look[1:])[loose]]))
        bend = unrolled_bends(flank, look, radius)
    if not np.isfinite(bend).all():
        raise ToleranceError(f"a development within {tolerance:.3g} mm is not proved", 2.0 * tolerance)
    count = np.maximum(np.ceil(np.diff(look) / widest(bend, CHORDS * tolerance)), 1.0)
    if count.sum() > MOST_POINTS:
        least = tolerance * (float(count.sum()) / MOST_POINTS) ** 2
        raise ToleranceError(f"a development within {tolerance:.3g} mm would take too many points", least)
    count = count.astype(np.intp)
    off = float((bend * (np.diff(look) / count) ** 2).max()) / 8.0
    own, step = runs_of(count)
    theta = np.append(look[own] + (np.diff(look) / count)[own] * step, end)
    contact = flank.on(theta, radius)
    points = np.column_stack([radius * contact.phi, contact.z])
    points[0, 1], points[-1, 1] = 0.0, flank.form.length
    return points, off


def widest(bend: Array, tolerance: float) -> Array:
    """Steps (n,), rad, whose chords are within a tolerance, mm, of a line with bounds of its second derivative (n,)."""
    return np.minimum(np.sqrt(8.0 * tolerance / np.maximum(bend, 1e-300)), WIDEST)


def unrolled_bends(flank: Flank, look: Array, radius: float) -> Array:
    """Bounds (n,), mm, of the second derivative by the shaft angle of a flank unrolled on a cylinder of a radius, mm.

    They hold between neighbours of `look` (n + 1,), rad, and are infinite where none is found.
    """
    cells = look[:-1], look[1:]
    pose = pose_over(flank, cells)
    rho = _enclosed(flank, cells, radius)
    touch = flank.touch(pose, rho)
    outwards = flank.outwards(pose, rho, touch)[1]
    by_theta, by_rho = flank.rising(touch, outwards)
    rate = by_theta * by_rho**-1 * -1.0
    first, mixed, twice = second_of(flank, pose, rho, touch)
    q = [a + b * rate * 2.0 + c * rate * rate for a, b, c in zip(first, mixed, twice, strict=True)]
    along = (Ball.exact(np.ones_like(rho.mid)), touch.a2 * (-flank.side * flank.radius))
    moved = [touch.beside + along[0] * rate, touch.along + along[1] * rate]
    # around the cylinder and up it, along g, tau and n
    axes = flank.form.axes(pose, touch.sine, touch.cosine)
    place = flank.place(pose, rho, touch.sine, touch.cosine)
    around = [(axis[1] * place[0] - axis[0] * place[1]) * (1.0 / radius) for axis in axes]
    turn = moved[0] * around[0] + moved[1] * around[1]
    out = sum(part * o for part, o in zip(q, outwards, strict=True))
    second = (turn * turn * (1.0 / radius) + out) * by_rho**-1 * -1.0
    bent = [q[0] + second, q[1] + along[1] * second, q[2]]
    parts = [
        sum(part * o for part, o in zip(bent, around, strict=True)),
        sum(part * axis[2] for part, axis in zip(bent, axes, strict=True)),
    ]
    return np.asarray(np.hypot(parts[0].magnitude, parts[1].magnitude))


def _enclosed(flank: Flank, cells: tuple[Array, Array], radius: float) -> Ball:
    """Balls of the distances along the roller at which a cylinder is touched over cells; infinite where not proved.

    Within a ball the distance changes no faster than the greatest derivative there. Where that is too slow to reach the
    edge of the ball within the cell, the distance stays inside.
    """
    middle, half = 0.5 * (cells[0] + cells[1]), 0.5 * (cells[1] - cells[0])
    pose = pose_over(flank, cells)
    at = flank.reached(flank.pose(middle), radius)
    reach = np.full_like(at, WIDEN)
    proved = np.zeros(at.shape, dtype=bool)
    for _ in range(SETTLE):
        rho = Ball.between(at - reach, at + reach)
        touch = flank.touch(pose, rho)
        by_theta, by_rho = flank.rising(touch, flank.outwards(pose, rho, touch)[1])
        needed = (by_theta * by_rho**-1).magnitude * half
        proved = needed < reach
        if proved.all():
            break
        with np.errstate(over="ignore"):
            reach = np.where(proved | ~np.isfinite(needed), reach, GROW * needed + WIDEN)
    return Ball(at, np.where(proved, reach, np.inf))


# --- the drawing ------------------------------------------------------------------------------------------------------


def developed(design: IndexDesign, request: FileRequest, mm: float) -> list[Developed]:
    """Lines of a requested development, by their layers; `mm` is the drawing's unit."""
    chosen = request.own.get("at", (OUTER,))
    found = []
    for each in chosen:
        radius = design.recipe.form.blank if isinstance(each, str) else each
        found += [Developed(f"R{radius / mm:.9g}_{name.upper()}", radius, name) for name in FLANKS]
    return list({line.layer: line for line in found}.values())


def drawn(design: IndexDesign, line: Developed, tolerance: float) -> Line:
    """A line in pieces of one turn, in the axes of the drawing; raises as `developed_line` does."""
    points, off = developed_line(design.flanks[line.flank], line.radius, tolerance)
    pieces = _by_turns(points, TURN * line.radius)
    if design.recipe.mirrored:
        pieces = [piece * np.array([-1.0, 1.0]) + 0.0 for piece in pieces]
    return Line(line, pieces, off)


def _by_turns(points: Array, turn: float) -> list[Array]:
    """Points (n, 2) by rising x in pieces of one turn, mm, each moved into it."""
    first, last = math.floor(points[0, 0] / turn), math.floor(points[-1, 0] / turn)
    cuts = np.arange(first + 1, last + 1) * turn
    cuts = cuts[(cuts > points[0, 0]) & (cuts < points[-1, 0])]
    added = np.column_stack([cuts, np.interp(cuts, points[:, 0], points[:, 1])])
    every = np.concatenate([points, added])
    every = every[np.argsort(every[:, 0], kind="stable")]
    every = every[np.append(True, np.diff(every[:, 0]) > 0.0)]
    found = []
    for k in range(first, last + 1):
        inside = (every[:, 0] >= k * turn) & (every[:, 0] <= (k + 1) * turn)
        if np.count_nonzero(inside) > 1:
            found.append(every[inside] - np.array([k * turn, 0.0]))
    return found


def unrolled(design: IndexDesign, tolerance: float) -> list[Array]:
    """Lines (n, 2), mm, of the flanks on the blank, with the blank's ends and the marks of a turn."""
    radius, length = design.recipe.form.blank, design.recipe.length
    pieces = [piece for name in FLANKS for piece in drawn(design, Developed("", radius, name), tolerance).pieces]
    turn = design.recipe.sense * TURN * radius
    edges = [np.array([[0.0, z], [turn, z]]) for z in (0.0, length)]
    return [*pieces, *edges, *(_mark(at, length) for at in (0.0, turn))]


def _mark(x: float, length: float) -> Array:
    return np.array([[x, 0.0], [x, length]])


def write_development(
    design: IndexDesign, request: FileRequest, path: Path, tolerance: float, mm: float
) -> tuple[int, Bound]:
    """Write a development; its number of points, and the bound of its lines.

    Raises ToleranceError where the tolerance cannot be held, OSError where the file cannot be written.
    """
    from camgeo.formats.dxf import draw_line, write_dxf

    recipe = design.recipe
    lines = [drawn(design, line, tolerance) for line in developed(design, request, mm)]

    def annotate(space: Modelspace) -> Box:
        boxes = [
            draw_line(space, line.of.layer, COLOURS[line.of.flank], piece / mm)
            for line in lines
            for piece in line.pieces
        ]
        for radius in dict.fromkeys(line.of.radius for line in lines):
            layer = f"R{radius / mm:.9g}_{MARKS}"
            turn = recipe.sense * TURN * radius
            boxes += [draw_line(space, layer, 8, _mark(at, recipe.length) / mm) for at in (0.0, turn)]
        corners = np.array(boxes)
        return (*corners[:, :2].min(axis=0).tolist(), *corners[:, 2:].max(axis=0).tolist())

    notes = [
        f"camgeo development: on {line.of.layer} x = {line.of.radius / mm:.9g} times the angle, "
        f"one turn of {TURN * line.of.radius / mm:.9g}; right at this radius alone"
        for line in lines
    ]
    write_dxf(path, [], mm=mm, name=recipe.name, about=recipe.about, remarks=notes, annotate=annotate)
    off = max(line.off for line in lines)
    return sum(len(piece) for line in lines for piece in line.pieces), Bound(off, off)
