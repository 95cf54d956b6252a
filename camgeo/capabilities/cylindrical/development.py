"""Developments: flanks and the path of the roller's axis, unrolled at a radius, as a drawing whose layers name it.

A line holds for its radius alone. It covers one period, from x = 0 to the circumference, and goes on by an overlap,
which two marks enclose.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Literal, NamedTuple

import numpy as np

from camgeo.capabilities.cylindrical.bends import bends
from camgeo.capabilities.cylindrical.keys import OUTER, PITCH
from camgeo.capabilities.cylindrical.undercut import cut_at
from camgeo.fit.bound import Bound
from camgeo.fit.nodes import ToleranceError
from camgeo.fit.parted import LOOKS, looks_of, parted
from kin.numeric.angles import TURN
from kin.numeric.interval import Ball
from kin.turned.files import Developed

if TYPE_CHECKING:
    from pathlib import Path

    from ezdxf.layouts.layout import Modelspace

    from camgeo.capabilities.cylindrical.design import DrumDesign
    from camgeo.capabilities.cylindrical.flank import Flank
    from camgeo.fit.bound import Box
    from camgeo.recipe.export import FileRequest
    from kin.numeric.arrays import Array

OVERLAP = TURN / 24.0  # by which a line goes on beyond its period
MOST_POINTS = 2_000_000  # of one line
STEPS, HALVINGS = 30, 60  # to the shaft angle at which a path, or a flank, has the polar angle 0
COLOURS = {"lower": 5, "upper": 1, PITCH: 3}  # of AutoCAD, by what a line is
MARKS = "OVERLAP"  # end of the name of the layer whose marks enclose what is drawn twice


class Line(NamedTuple):
    """A line of a development: where it is, its points (n, 2), mm, and the bound, mm, of their distance from it."""

    of: Developed
    points: Array
    off: float


def radii(design: DrumDesign, request: FileRequest) -> list[tuple[float, bool]]:
    """Radii of a request, mm, each with whether the path of the roller's axis is unrolled in place of the flanks."""
    blank = design.recipe.radius
    chosen = request.own.get("at", (OUTER, PITCH))
    return [(blank if isinstance(each, str) else each, each == PITCH) for each in chosen]


def developed(design: DrumDesign, request: FileRequest, mm: float) -> list[Developed]:
    """Lines of a requested development, by their layers; `mm` is the drawing's unit."""
    found = []
    for radius, pitch in radii(design, request):
        named = f"R{radius / mm:.9g}"
        names: list[Literal["lower", "upper", "pitch"]] = ["pitch"] if pitch else list(design.flanks)  # type: ignore[arg-type]
        found += [Developed(f"{named}_{name.upper()}", radius, name) for name in names]
    return list({line.layer: line for line in found}.values())


def drawn(design: DrumDesign, line: Developed, tolerance: float) -> Line:
    """Points of a line over its period and the overlap, in the axes of the drawing; ToleranceError where too many."""
    look, period = looks_of(design.law), design.recipe.period
    if line.flank == PITCH:
        bend, begin = _pitch_bends(design, line.radius, look), _pitch_start(design, line.radius)
    else:
        flank, r = design.flanks[line.flank], np.full(look.size - 1, line.radius)
        bend, begin = bends(flank, (look[:-1], look[1:]), (r, r)).unrolled, _start(flank, line.radius)
    first, off = parted(look, bend, tolerance)
    if first.size > MOST_POINTS:
        least = tolerance * (float(first.size) / MOST_POINTS) ** 2
        raise ToleranceError(f"a development within {tolerance:.3g} mm would take too many points", least)
    theta = np.concatenate([first - period, first, first + period])
    theta = np.unique(np.concatenate([theta, [begin, begin + period, begin + period + OVERLAP]]))
    theta = theta[(theta >= begin) & (theta <= begin + period + OVERLAP)]
    points = _pitch(design, line.radius, theta) if line.flank == PITCH else _flank(design, line, theta)
    if design.recipe.mirrored:
        points = points * np.array([-1.0, 1.0]) + 0.0
    return Line(line, points, off)


def unrolled(design: DrumDesign, tolerance: float) -> list[Array]:
    """Lines (n, 2), mm, of the flanks on the blank, with the blank's ends and the marks of the overlap."""
    recipe = design.recipe
    lines = [drawn(design, Developed("", recipe.radius, name), tolerance).points for name in design.flanks]  # type: ignore[arg-type]
    begin, end = _reach(design, recipe.radius, 0.0), _reach(design, recipe.radius, recipe.period + OVERLAP)
    edges = [np.array([[begin, z], [end, z]]) for z in (0.0, recipe.height)]
    return [*lines, *edges, *(_mark(design, recipe.radius, at) for at in (0.0, recipe.period, recipe.period + OVERLAP))]


def _reach(design: DrumDesign, radius: float, at: float) -> float:
    """Place of a polar angle, rad, on a development, mm."""
    return design.recipe.sense * radius * at


def _mark(design: DrumDesign, radius: float, at: float) -> Array:
    x = _reach(design, radius, at)
    return np.array([[x, 0.0], [x, design.recipe.height]])


def _pitch(design: DrumDesign, radius: float, theta: Array) -> Array:
    """Where the roller's axis, or the middle between two, meets the cylinder."""
    y, z = design.recipe.guide.place(design.law.derivatives(theta, 0))
    return np.column_stack([radius * (theta + np.arcsin(y[0] / radius)), z[0]])


def _pitch_bends(design: DrumDesign, radius: float, look: Array) -> Array:
    """Bounds of the second derivative of the path by the shaft angle between neighbours of `look`, mm."""
    y, z = design.recipe.guide.place(Ball(*design.law.enclosure(look[:-1], look[1:], 2)))
    if design.recipe.guide.radial:
        return z[2].magnitude
    root = (radius**2 - y[0] * y[0]) ** -0.5
    across = y[2] * root + y[0] * y[1] * y[1] * root * root * root
    return np.hypot((across * radius).magnitude, z[2].magnitude)


def _pitch_start(design: DrumDesign, radius: float) -> float:
    """Shaft angle, rad, at which the path has the polar angle 0."""
    guide, theta = design.recipe.guide, np.zeros(1)
    if guide.radial:
        return 0.0
    for _ in range(STEPS):  # the roller leaves the radius slowly
        theta = -np.arcsin(guide.place(design.law.derivatives(theta, 0))[0][0] / radius)
    return float(theta[0])


def _flank(design: DrumDesign, line: Developed, theta: Array) -> Array:
    """Points of a flank on a cylinder without those that are cut away."""
    flank = design.flanks[line.flank]
    for tip in design.tips[line.flank]:
        if tip.r <= line.radius:
            continue
        cut = cut_at(flank, tip, np.array([line.radius]))
        width = float(cut.last[0] - cut.first[0])
        from_first = np.mod(theta - cut.first[0], flank.period)
        lost = (from_first > 0.0) & (from_first < width)
        edges = cut.first[0] + flank.period * np.arange(-3, 4)
        edges = edges[(edges >= theta[0]) & (edges <= theta[-1])]
        theta = np.unique(np.concatenate([theta[~lost], edges]))
    contact = flank.on(theta, line.radius)
    return np.column_stack([line.radius * contact.phi, contact.z])


def _start(flank: Flank, radius: float) -> float:
    """Shaft angle, rad, at which a flank on a cylinder has the polar angle 0."""
    looks = np.linspace(-0.5 * math.pi, 0.5 * math.pi, LOOKS + 1)
    phi = flank.on(looks, radius).phi
    k = int(np.flatnonzero(phi <= 0.0)[-1])
    low, high = looks[k], looks[k + 1]
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        if flank.on(np.array([middle]), radius).phi[0] <= 0.0:
            low = middle
        else:
            high = middle
    return float(low)


def write_development(
    design: DrumDesign, request: FileRequest, path: Path, tolerance: float, mm: float
) -> tuple[int, Bound]:
    """Write a development; its number of points, and the bound of its lines.

    Raises ToleranceError where the tolerance cannot be held, OSError where the file cannot be written.
    """
    from camgeo.formats.dxf import draw_line, write_dxf

    recipe = design.recipe
    lines = [drawn(design, line, tolerance) for line in developed(design, request, mm)]

    def annotate(space: Modelspace) -> Box:
        boxes = [draw_line(space, line.of.layer, COLOURS[line.of.flank], line.points / mm) for line in lines]
        for radius in dict.fromkeys(line.of.radius for line in lines):
            layer = f"R{radius / mm:.9g}_{MARKS}"
            boxes += [
                draw_line(space, layer, 8, _mark(design, radius, at) / mm)
                for at in (recipe.period, recipe.period + OVERLAP)
            ]
        corners = np.array(boxes)
        return (*corners[:, :2].min(axis=0).tolist(), *corners[:, 2:].max(axis=0).tolist())

    notes = [
        f"camgeo development: on {line.of.layer} x = {line.of.radius / mm:.9g} times the angle, "
        f"one period of {recipe.period * line.of.radius / mm:.9g}, then an overlap; right at this radius alone"
        for line in lines
    ]
    write_dxf(path, [], mm=mm, name=recipe.name, about=recipe.about, remarks=notes, annotate=annotate)
    off = max(line.off for line in lines)
    return sum(len(line.points) for line in lines), Bound(off, off)
