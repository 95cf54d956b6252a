"""A solid in layers: between two heights every section should be the same, or shrink evenly along a chamfer.

A layer's outline is the cam's contour, moved inside by `inset`, or an outline of its own such as a hub. A cross hole
runs along a radius through layers with an outline of their own.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kin.contour.arcs import cross
from kin.contour.contour import Contour
from kin.contour.holes import Tally
from kin.numeric.lengths import UNIT, length_words
from kin.numeric.quadrature import gauss
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kin.contour.holes import Hole, Tallies
    from kin.numeric.arrays import Array, Indices, Mask
    from kin.numeric.check import Check
    from kin.read.formats import AnySolid

GAUSS = 48  # nodes for each smooth part of a cross hole
AT_CHAMFER = (0.25, 0.75)  # of the height of a layer that shrinks: its sections judged
ACROSS = (0.1, 0.5, -0.5)  # of a cross hole's radius from its axis: sections judged through it
SAME = 1e-9  # mm: heights this close are one
MOST_NAMED = 3  # places where walls lean, in a message
ORDER = ("bore", "holes", "mark", "thickness", "hub", "chamfer", "set-screw")


@dataclass(frozen=True)
class Layer:
    """Slab of a solid as intended, from z = low to high, mm.

    outline  None for the cam's contour, `inset` (at low, at high) inside it
    holes    openings through the layer
    """

    low: float
    high: float
    holes: tuple[Hole, ...] = ()
    outline: Hole | None = None
    inset: tuple[float, float] = (0.0, 0.0)

    def inset_at(self, z: float) -> float:
        """Distance, mm, of the outline inside the cam's contour, at height z, mm."""
        share = (z - self.low) / (self.high - self.low)
        return self.inset[0] + share * (self.inset[1] - self.inset[0])


@dataclass(frozen=True)
class CrossHole:
    """A radial hole of this diameter, mm, in direction `at`, rad, its axis at height z, from the first hole outward."""

    name: str
    at: float
    diameter: float
    z: float

    def half_width(self, z: float) -> float:
        """Half the width of the hole, mm, in the horizontal section at height z, mm; 0 above and below the hole."""
        return float(np.sqrt(max(0.25 * self.diameter**2 - (z - self.z) ** 2, 0.0)))


class Lean(NamedTuple):
    """Walls that should lean, and the check that reports them.

    They lean evenly from `low` to `high`, mm, inward by `inward` mm per mm of height; or, where `reach` is given, in
    any way between these heights and within `reach`, mm, from the axis.
    """

    kind: str
    low: float
    high: float
    reach: float | None = None
    inward: float = 0.0

    def means(self, rows: Array, slack: float) -> Mask:
        """Mask (k,) of the walls of a solid that belong to this lean, within `slack`, mm.

        Of each wall `rows` (k, 4) has its lowest and highest z, its reach from the axis, mm, and its inward slope. A
        wall that leans over the whole height need only have its ends there: the sections between check it. A wall over
        a part of the height must lie within it and lean inward at the intended slope, or reach no farther than `reach`
        if set.
        """
        low, high, reach, inward = rows.T
        inside: Mask = (low >= self.low - slack) & (high <= self.high + slack)
        if self.reach is not None:
            inside &= reach <= self.reach + slack
            return inside
        whole: Mask = (np.abs(low - self.low) <= slack) & (np.abs(high - self.high) <= slack)
        steep: Mask = np.abs(inward - self.inward) * (self.high - self.low) <= slack
        return whole | (inside & steep)


def heights(layers: Sequence[Layer], cross_holes: Sequence[CrossHole]) -> list[tuple[float, Layer]]:
    """Heights z, mm, at which a solid's sections are judged, each with its layer.

    The plain disc's height is the first.
    """
    samples = []
    main = max((layer for layer in layers if layer.outline is None and layer.inset == (0.0, 0.0)), key=_height)
    for layer in (main, *(other for other in layers if other is not main)):
        shares: tuple[float, ...] = (0.5,) if layer.inset == (0.0, 0.0) else AT_CHAMFER
        inside = [hole for hole in cross_holes if layer.outline is not None and layer.low < hole.z < layer.high]
        if inside:
            hole = inside[0]
            samples += [(hole.z + share * 0.5 * hole.diameter, layer) for share in ACROSS]
            below, above = hole.z - 0.5 * hole.diameter, hole.z + 0.5 * hole.diameter
            samples += [(0.5 * (layer.low + below), layer), (0.5 * (above + layer.high), layer)]
        else:
            samples += [(layer.low + share * _height(layer), layer) for share in shares]
    return samples


def _height(layer: Layer) -> float:
    return layer.high - layer.low


def faces(layers: Sequence[Layer]) -> list[tuple[str, float]]:
    """Pairs of the check that reports a horizontal face (thickness, hub or mark) and the face's height, mm, rising."""
    rising = sorted(layers, key=lambda layer: layer.low)
    levels = []
    for below, above in zip([None, *rising], [*rising, None], strict=True):
        present = below or above
        if present is None:
            continue
        z = present.high if present is below else present.low
        if below is None or above is None:
            levels.append((present.outline.kind if present.outline is not None else "thickness", z))
        elif below.outline != above.outline or below.inset[1] != above.inset[0]:
            levels.append(("thickness", z))
        elif below.holes != above.holes:
            levels.append(("mark", z))
    return levels


def leans(layers: Sequence[Layer], cross_holes: Sequence[CrossHole]) -> list[Lean]:
    """Leans of the walls of cross holes, then of chamfers from below; chamfers that meet count as one."""
    rows = []
    for hole in cross_holes:
        outline = next(
            layer.outline for layer in layers if layer.outline is not None and layer.low < hole.z < layer.high
        )
        reach = float(np.hypot(*outline.contour.vertices.T).max())
        rows.append(Lean("set-screw", hole.z - 0.5 * hole.diameter, hole.z + 0.5 * hole.diameter, reach))
    for layer in sorted(layers, key=lambda layer: layer.low):
        if layer.inset != (0.0, 0.0):
            low = rows.pop().low if rows and rows[-1].high == layer.low else layer.low
            inward = (layer.inset[1] - layer.inset[0]) / _height(layer)
            rows.append(Lean("chamfer", low, layer.high, inward=inward))
    return rows


def settled(solid: AnySolid, leaning: Sequence[Lean], tolerance: float) -> AnySolid:
    """The solid with those faces made level that only the rounding of its numbers keeps from being level.

    Corners of such a face differ in height by no more than that rounding in all; the difference is kept in `slivers`.
    Walls of the leans in `leaning`, within `tolerance`, mm, stay as they are.
    """
    rows = solid.leaning
    level = rows[:, 1] - rows[:, 0] <= solid.rounding
    for lean in leaning:
        level &= ~lean.means(rows, tolerance + SAME)
    if not level.any():
        return solid
    faces = np.array(solid.faces)
    # ends of level rows and faces, in groups of heights that rounding does not tell apart
    heights = np.concatenate([rows[level, 0], rows[level, 1], faces])
    order = np.argsort(heights, kind="stable")
    group = np.empty(len(heights), dtype=np.intp)
    group[order] = np.cumsum(np.diff(heights[order], prepend=-np.inf) > solid.rounding) - 1
    heads = np.searchsorted(group[order], np.arange(group.max() + 1))
    low, high = np.minimum.reduceat(heights[order], heads), np.maximum.reduceat(heights[order], heads)
    uneven = high - low
    # a group that holds such a row, and no more than rounding, becomes one face in its middle
    of_row = group[: int(level.sum())]
    even = np.zeros(len(uneven), dtype=bool)
    even[of_row] = True
    even &= uneven <= solid.rounding
    merged = np.flatnonzero(level)[even[of_row]]
    more = np.column_stack([rows[merged, :3], uneven[of_row][even[of_row]]])
    left = faces[~even[group[2 * len(of_row) :]]]
    return replace(
        solid,
        faces=tuple(np.sort(np.concatenate([left, 0.5 * (low + high)[even]])).tolist()),
        leaning=np.delete(rows, merged, axis=0),
        slivers=np.concatenate([solid.slivers, more]),
    )


def between_sections(
    solid: AnySolid, levels: Sequence[float], leaning: Sequence[Lean], tolerance: float
) -> list[tuple[str, str]]:
    """Pairs (name of the check, fault in words) for all that makes a solid differ between the sections at `levels`, mm.

    All sections between two heights are the same if no face lies between them and no wall leans. Two faces nearer to
    each other than the tolerance, where one is intended, would have a fin or a gap between them. Walls that lean evenly
    are known by two sections between their heights.
    """
    places, faces = np.array(levels), np.array(solid.faces)
    faults, slack = [], tolerance + SAME
    for z in levels:
        pair = faces[(np.abs(faces[:, None] - places).min(axis=1) == np.abs(faces - z)) & (np.abs(faces - z) <= slack)]
        if pair.size and float(np.ptp(pair)) > SAME:
            both = " and ".join(length_words(z, ".9g") for z in (pair.min(), pair.max()))
            fault = f"faces at z = {both} {UNIT}, where one is expected"
            faults.append(("thickness", fault))
    rows = solid.leaning
    for lean in leaning:
        rows = rows[~lean.means(rows, slack)]
    for low, high, *_ in rows[:MOST_NAMED].tolist():
        bottom, top = _together(solid.leaning, low, high, slack)
        near = (lean.kind for lean in leaning if bottom < lean.high + slack and lean.low - slack < top)
        both = f"{length_words(low, '.9g')} and {length_words(high, '.9g')} {UNIT}"
        fault = f"walls lean between z = {both}, where none should"
        faults.append((next(near, "thickness"), fault))
    return faults


def _together(rows: Array, low: float, high: float, slack: float) -> tuple[float, float]:
    """The range of heights from low to high, mm, widened by all leaning walls that meet it, within `slack`, mm.

    Walls that meet the wider range widen it further. Of each wall `rows` (k, 4) begins with its lowest and highest z.
    """
    while True:
        touching = rows[(rows[:, 0] <= high + slack) & (rows[:, 1] >= low - slack)]
        bottom, top = float(touching[:, 0].min(initial=low)), float(touching[:, 1].max(initial=high))
        if (bottom, top) == (low, high):
            return low, high
        low, high = bottom, top


def volume(layers: Sequence[Layer], cross_holes: Sequence[CrossHole], area: float, perimeter: float) -> float:
    """Volume, mm^3, of the layers less holes and cross holes, round a contour of this area, mm^2, and perimeter, mm.

    A layer without an outline of its own is bounded by parallels of the contour, of area A - d P + pi d^2 at inset d.
    """
    total = 0.0
    for layer in layers:
        a, b = layer.inset
        solid = (
            layer.outline.contour.area
            if layer.outline is not None
            else (area - perimeter * (a + b) / 2.0 + np.pi * (a * a + a * b + b * b) / 3.0)
        )
        total += (solid - sum(hole.contour.area for hole in layer.holes)) * _height(layer)
        if layer.outline is not None:
            inside = [cross_hole for cross_hole in cross_holes if layer.low < cross_hole.z < layer.high]
            total -= sum(_cross_hole_volume(cross_hole, layer.outline, layer.holes[0]) for cross_hole in inside)
    return float(total)


def wall_area(layers: Sequence[Layer], cross_holes: Sequence[CrossHole], perimeter: float) -> float:
    """Area, mm^2, of the walls of layers, holes and cross holes, without horizontal faces.

    Chamfers count at 45 degrees; `perimeter`, mm, is the cam's contour's. The tolerance times this area limits the
    error of the volume.
    """
    total = 0.0
    for layer in layers:
        length = perimeter if layer.outline is None else layer.outline.contour.length
        slant = np.sqrt(2.0) if layer.inset != (0.0, 0.0) else 1.0
        total += (length * slant + sum(hole.contour.length for hole in layer.holes)) * _height(layer)
        if layer.outline is not None:
            reach = 0.5 * (layer.outline.contour.box.x_max - layer.outline.contour.box.x_min)
            inside = [cross_hole for cross_hole in cross_holes if layer.low < cross_hole.z < layer.high]
            total += sum(np.pi * cross_hole.diameter * reach for cross_hole in inside)
    return float(total)


def slotted(outline: Hole, hole: Hole, angle: float, half: float) -> Contour:
    """The section of a ring between two outlines, slotted in direction `angle`, rad, to a half width `half`, mm.

    Raises ValueError where the slot's sides do not meet both outlines.
    """
    outer, inner = _turned(outline, -angle), _turned(hole, -angle)
    ends = np.array([half, -half])
    out_x, out_piece = rightmost_crossing(outer, ends)
    in_x, in_piece = rightmost_crossing(inner, ends)
    if not np.isfinite([*out_x, *in_x]).all():
        raise ValueError("the slot does not reach both outlines")
    outside = _part(outer, (float(out_x[0]), half, int(out_piece[0])), (float(out_x[1]), -half, int(out_piece[1])))
    inside = _part(inner, (float(in_x[0]), half, int(in_piece[0])), (float(in_x[1]), -half, int(in_piece[1])))
    # round the outline, in along the lower side, back round the hole, out along the upper side
    (outer_points, outer_bulges), (inner_points, inner_bulges) = outside, inside
    points = np.concatenate([outer_points, inner_points[::-1]])
    bulges = np.concatenate([outer_bulges, [0.0], -inner_bulges[::-1], [0.0]])
    c, s = np.cos(angle), np.sin(angle)
    return Contour.from_bulges(points @ np.array([[c, s], [-s, c]]), bulges)


def _turned(hole: Hole, angle: float) -> tuple[Array, Array]:
    c, s = np.cos(angle), np.sin(angle)
    return np.array(hole.points) @ np.array([[c, s], [-s, c]]), np.array(hole.bulges)


def _part(
    outline: tuple[Array, Array], first: tuple[float, float, int], last: tuple[float, float, int]
) -> tuple[Array, Array]:
    """Points (m, 2) and bulges (m - 1,) of an outline from a point on it, counter-clockwise, to another."""
    points, bulges = outline
    n = len(points)
    start, end = np.array(first[:2]), np.array(last[:2])
    i, j = first[2], last[2]
    follows = (j - i) % n
    if follows == 0 and _along(points, bulges, i, start) > _along(points, bulges, i, end):
        follows = n
    between = [(i + k) % n for k in range(1, follows + 1)]
    rows = np.array([start, *(points[k] for k in between), end])
    whole = [float(bulges[(i + k) % n]) for k in range(follows + 1)]
    sweeps = 4.0 * np.arctan(np.array(whole))
    if follows == 0:
        shares = [(_along(points, bulges, i, end) - _along(points, bulges, i, start))]
    else:
        shares = [1.0 - _along(points, bulges, i, start), *([1.0] * (follows - 1)), _along(points, bulges, j, end)]
    return rows, np.tan(0.25 * sweeps * np.array(shares))


def _along(points: Array, bulges: Array, k: int, place: Array) -> float:
    """Place of a point on piece k, as a share of the piece's sweep or length."""
    start, end, bulge = points[k], points[(k + 1) % len(points)], float(bulges[k])
    chord, part = end - start, place - start
    if bulge == 0.0:
        return float(part @ chord / (chord @ chord))
    # the angle between chord and part is half of what is left of the sweep
    turn = float(np.arctan2(part[0] * chord[1] - part[1] * chord[0], part @ chord))
    sweep = 4.0 * float(np.arctan(bulge))
    return 2.0 * (0.5 * sweep - turn) / sweep


def rightmost_crossing(outline: tuple[Array, Array], y: Array) -> tuple[Array, Indices]:
    """Greatest x, mm (k,), at which an outline meets lines of given y (k,), mm, -inf without any, and its piece."""
    points, bulges = outline
    best, which = np.full(len(y), -np.inf), np.zeros(len(y), dtype=np.intp)
    for k, bulge in enumerate(bulges.tolist()):
        start, end = points[k], points[(k + 1) % len(points)]
        with np.errstate(invalid="ignore", divide="ignore"):
            if bulge == 0.0:
                share = (y - start[1]) / (end[1] - start[1])
                tried = [np.where((share >= 0.0) & (share <= 1.0), start[0] + share * (end[0] - start[0]), -np.inf)]
            else:
                tried = _on_arc(start, end, bulge, y)
        for x in tried:
            ahead = x > best
            best, which = np.where(ahead, x, best), np.where(ahead, k, which)
    return best, which


def _on_arc(start: Array, end: Array, bulge: float, y: Array) -> list[Array]:
    """Both x, (k,) each, mm, at which an arc's circle meets lines of given y (k,), mm; -inf where not on the arc."""
    chord = end - start
    middle, left_of = 0.5 * (start + end), np.array([-chord[1], chord[0]])
    centre = middle + left_of * (1.0 - bulge * bulge) / (4.0 * bulge)
    radius = float(np.hypot(*(start - centre)))
    half = np.sqrt(radius**2 - (y - centre[1]) ** 2)
    places = []
    for x in (centre[0] - half, centre[0] + half):
        place = np.stack([x, y], axis=-1)
        beside = cross(chord[None, :], place - start) * np.sign(bulge) <= 1e-12 * radius**2
        places.append(np.where(np.isfinite(x) & beside, x, -np.inf))
    return places


def _cross_hole_volume(cross: CrossHole, outline: Hole, hole: Hole) -> float:
    """Volume, mm^3, that a cross hole takes from between a hole and an outline.

    The integral of the height of the bore times the way from hole to outline over its width, y = r sin a, by Gauss's
    rule between the corners of the hole.
    """
    outer, inner = _turned(outline, -cross.at), _turned(hole, -cross.at)
    radius = 0.5 * cross.diameter
    corners = inner[0][:, 1] / radius
    knots = np.unique(np.concatenate([[-0.5 * np.pi, 0.5 * np.pi], np.arcsin(corners[np.abs(corners) < 1.0])]))
    node, weight = gauss(GAUSS)
    low, width = knots[:-1, None], np.diff(knots)[:, None]
    angle = (low + 0.5 * width * (node + 1.0)).ravel()
    share = (0.5 * width * weight).ravel()
    y = radius * np.sin(angle)
    way = rightmost_crossing(outer, y)[0] - rightmost_crossing(inner, y)[0]
    return float(np.sum(share * 2.0 * (radius * np.cos(angle)) ** 2 * way))


def told(tallies: Tallies, tolerance: float) -> list[Check]:
    """Give the check of each kind of opening or face, in a settled order."""
    names = [*(name for name in ORDER if name in tallies), *(name for name in tallies if name not in ORDER)]
    return [tallies[name].check(name, tolerance) for name in names]


def tally_faces(tallies: Tallies, solid: AnySolid, layers: Sequence[Layer], tolerance: float) -> None:
    """Compare the horizontal faces with the intended ones."""
    expected = faces(layers)
    levels = np.array(solid.faces)
    for kind, z in expected:
        tally = tallies.setdefault(kind, Tally())
        if not levels.size:
            tally.faults.append(f"no horizontal face at z = {length_words(z, '.9g')} {UNIT}")
            continue
        nearest = float(levels[np.abs(levels - z).argmin()])
        tally.measured(
            abs(nearest - z),
            f"a face at z = {length_words(nearest, '.9g')} {UNIT}, where {length_words(z, '.9g')} {UNIT} is expected",
        )
    places = np.array([z for _, z in expected])
    for z in solid.faces:
        k = int(np.abs(places - z).argmin())
        if abs(float(places[k]) - z) > tolerance + SAME:
            kind = expected[k][0]
            tallies[kind].faults.append(
                f"a horizontal face at z = {length_words(z, '.9g')} {UNIT}, where none is expected"
            )
