"""The drum as a mesh: a ring of strips between closed lines about the axis, watertight by construction.

A section through the axis runs counter-clockwise round the metal, and every corner of it is a closed line about the
axis, along which the polar angle rises. Two lines are joined in the order of their angles, so that a triangle of a
cylinder spans no more of the turn than an edge of either line does; flanks have grids, end faces are plane regions.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple, TypeAlias

import numpy as np

from camgeo.capabilities.cylindrical.filling import Run, Sweep
from camgeo.capabilities.cylindrical.grid import sag, widest
from camgeo.capabilities.cylindrical.patches import corners_of, line_of, patches_of
from camgeo.capabilities.cylindrical.sheet import points_of
from camgeo.files.mesh import Building, MeshFacts
from camgeo.files.prism import rounded_loop
from camgeo.files.triangulate import disc, region
from camgeo.fit.bound import Bound
from camgeo.fit.nodes import ToleranceError
from kin.numeric.angles import TURN

if TYPE_CHECKING:
    from camgeo.capabilities.cylindrical.design import DrumDesign
    from camgeo.capabilities.cylindrical.sheet import Sheet
    from camgeo.files.mesh import Mesh
    from camgeo.files.precision import Precision
    from kin.numeric.arrays import Array, Indices

ROUNDINGS = math.sqrt(1.5)  # of a point in space, in those of a plane point
LEAST_EDGES = 6  # of a circle


class _Line(NamedTuple):
    """A closed line about the axis: numbers of its points (n,), in the order of rising angles (n,), rad."""

    number: Indices
    angle: Array


class _Body(Building):
    """A body of lines about an axis, with the bound, mm, of its lines and cylinders."""

    def __init__(self, precision: Precision, tolerance: float) -> None:
        super().__init__(precision)
        self.tolerance, self.off = tolerance, 0.0

    def line(self, points: Array) -> _Line:
        """A closed line through points (n, 3), in their order."""
        return _Line(self.add(points), np.unwrap(np.arctan2(points[:, 1], points[:, 0])))

    def circle(self, radius: float, z: float) -> _Line:
        """A circle about the axis, drawn by chords."""
        count = max(LEAST_EDGES, math.ceil(TURN / widest(radius, self.tolerance)))
        self.off = max(self.off, float(sag(radius, TURN / count)))
        angle = np.asarray(np.arange(count) * (TURN / count), dtype=np.float64)
        at = np.column_stack([radius * np.cos(angle), radius * np.sin(angle), np.full(count, z)])
        return _Line(self.add(at), angle)

    def strip(self, first: _Line, second: _Line) -> None:
        """Join two lines that follow one another round the section, in the order of their angles."""
        a, b = _from_least(first), _from_least(second)
        n, m = a.number.size, b.number.size
        # going round, an edge of either line is joined to the point then reached on the other one
        at_a, at_b = np.append(a.angle[1:], a.angle[0] + TURN), np.append(b.angle[1:], b.angle[0] + TURN)
        of_a = np.searchsorted(at_b, at_a, side="left")
        of_b = np.searchsorted(at_a, at_b, side="right")
        i, j = np.arange(n), np.arange(m)
        from_a = (a.number, a.number[(i + 1) % n], b.number[of_a % m])
        from_b = (b.number[(j + 1) % m], b.number, a.number[of_b % n])
        self.triangles += [np.column_stack(from_a), np.column_stack(from_b)]

    def wall(self, first: _Line, second: _Line) -> None:
        """Join two lines of as many points, point by point."""
        a, b = first.number, second.number
        c, d = np.roll(a, -1), np.roll(b, -1)
        self.triangles += [np.column_stack((a, c, b)), np.column_stack((d, b, c))]

    def face(self, outer: _Line, inner: _Line | None, *, up: bool) -> None:
        """Plane end face between two lines, or within one."""
        points = np.concatenate(self.points)
        loop = points[outer.number, :2]
        if inner is None:
            number, triangles = outer.number, disc(loop)
        else:
            number = np.concatenate([outer.number, inner.number])
            triangles = region(loop, [points[inner.number, :2]])
        faces = number[triangles]
        self.triangles.append(faces if up else faces[:, ::-1])

    def flank(self, sheet: Sheet, *, inwards: bool) -> tuple[_Line, _Line]:
        """Add the grid of a flank; its lines on the blank and on the floor. The section runs inwards, or outwards."""
        rows, columns = sheet.at.shape
        own = self.add(sheet.points)
        number = own[sheet.at]
        rising = number[::-1] if inwards else number
        a, b = rising[:-1], rising[1:]
        c, d = np.roll(a, -1, axis=1), np.roll(b, -1, axis=1)
        quads = (a, c, b), (d, b, c)
        found = np.concatenate([np.column_stack([part.ravel() for part in quad]) for quad in quads])
        if len(own) < rows * columns:  # where rows are cut short neighbours are one point
            x, y, z = found.T
            found = found[(x != y) & (y != z) & (z != x)]
        self.triangles.append(found)
        return self._edge(number[-1]), self._edge(number[0])

    def grid(self, number: Indices) -> None:
        """Add triangles between the places (rows, columns) of a grid of points that has ends."""
        a, b, c, d = number[:-1, :-1], number[1:, :-1], number[:-1, 1:], number[1:, 1:]
        quads = (a, c, b), (d, b, c)
        self.triangles += [np.column_stack([part.ravel() for part in quad]) for quad in quads]

    def _edge(self, row: Indices) -> _Line:
        row = row[row != np.roll(row, 1)]
        points = np.concatenate(self.points)[row]
        return _Line(row, np.unwrap(np.arctan2(points[:, 1], points[:, 0])))


def _from_least(line: _Line) -> _Line:
    """The line from the point of its least angle in [0, 2 pi) on."""
    angle = np.mod(line.angle, TURN)
    first = int(np.argmin(angle))
    return _Line(np.roll(line.number, -first), np.roll(angle, -first))


def drum_mesh(design: DrumDesign, tolerance: float, precision: Precision) -> tuple[Mesh, MeshFacts]:
    """Closed, oriented mesh of the drum, mm, within a tolerance of every surface, and facts on it.

    Raises ToleranceError where the tolerance cannot be held in the precision, RegionError where no sound body is made.
    """
    recipe = design.recipe
    size = max(recipe.radius, abs(recipe.height))
    fine = precision.fit_tolerance(tolerance, ROUNDINGS * size)
    body = _Body(precision, fine)
    if recipe.turns > 1:
        ends, off = _crossed(body, design)
        return _closed(design, body, ends, _bore(body, design, tolerance), (off, tolerance))
    sheets = {name: design.sheet(name, fine) for name in design.flanks}
    bore = _bore(body, design, tolerance)
    core, blank, rising = recipe.floor, recipe.radius, recipe.track.rising
    inner = below = body.circle(blank if rising[0] == "lower" else core, 0.0)
    for name in rising:
        # the section runs down a lower flank from the blank, and up an upper one from the floor
        inwards = name == "lower"
        head, foot = body.flank(sheets[name], inwards=inwards)
        body.strip(below, head if inwards else foot)
        below = foot if inwards else head
    outer = body.circle(blank if rising[-1] == "upper" else core, recipe.height)
    body.strip(below, outer)
    off = max(sheet.off for sheet in sheets.values())
    return _closed(design, body, (inner, outer), bore, (off, tolerance))


def _closed(
    design: DrumDesign, body: _Body, ends: tuple[_Line, _Line], bore: _Bore, bounds: tuple[float, float]
) -> tuple[Mesh, MeshFacts]:
    """The mesh of a body that lacks its end faces, within two lines, and the walls of its bore.

    The bounds, mm, are that of the flanks and the tolerance.
    """
    recipe, precision, (flanks, tolerance) = design.recipe, body.precision, bounds
    (inner, outer), (bore_low, bore_high, bore_off) = ends, bore
    body.face(inner, bore_low, up=False)
    body.face(outer, bore_high, up=True)
    if bore_low is not None and bore_high is not None:
        body.wall(bore_high, bore_low)
    mesh = body.mesh("drum", mirrored=recipe.mirrored)
    off = flanks + body.moved
    precision.within("the flank", off, tolerance)
    rest = max(body.off + body.moved, bore_off)
    return mesh, MeshFacts(len(mesh.points), body.moved, Bound(off, off).wider(Bound(rest, rest)))


def _crossed(body: _Body, design: DrumDesign) -> tuple[tuple[_Line, _Line], float]:
    """Add a groove that crosses itself, with blank and floor; lines of the end faces, and the bound of the flanks, mm.

    Corners of crossings are lines from floor to blank that flanks share; blank and floor lie between the flanks' rows.
    """
    recipe = design.recipe
    made = patches_of(design, body.tolerance)
    edges = {id(corner): body.add(line_of(corner, made.r)) for corner in corners_of(design.crossings)}
    runs: tuple[list[Run], list[Run]] = ([], [])
    for patch in made.patches:
        inside = patch.theta[:, 1:-1]
        radii = np.broadcast_to(made.r[:, None], inside.shape)
        own = body.add(points_of(design.flanks[patch.name], inside.ravel(), radii.ravel())).reshape(inside.shape)
        number: Indices = np.column_stack([edges[id(patch.begin)], own, edges[id(patch.end)]])
        body.grid(number if patch.name == "upper" else number[::-1])
        for run, row in zip(runs, (number[0], number[-1]), strict=True):
            run.append(Run(row, closed=False, under=patch.name == "upper"))
    lower, upper = (body.circle(recipe.radius, z) for z in (0.0, recipe.height))
    runs[1].extend([Run(lower.number, closed=True, under=True), Run(upper.number, closed=True, under=False)])
    points = np.concatenate(body.points)
    angle = np.arctan2(points[:, 1], points[:, 0])
    floor, blank = (Sweep(angle, points[:, 2], each) for each in runs)
    for radius, triangles in ((recipe.floor, floor.groove), (recipe.radius, blank.metal)):
        spans = np.remainder(angle[triangles] - angle[triangles[:, :1]] + math.pi, TURN)
        body.off = max(body.off, float(sag(radius, np.ptp(spans, axis=1).max())))
        body.triangles.append(triangles)
    if body.off > body.tolerance:
        problem = f"blank and floor between crossings are not within {body.tolerance:.3g} mm"
        raise ToleranceError(problem, 2.0 * body.off)
    return (lower, upper), made.off


_Bore: TypeAlias = tuple[_Line | None, _Line | None, float]


def _bore(body: _Body, design: DrumDesign, tolerance: float) -> _Bore:
    """Lines of the bore on the lower and the upper end face, None without one, and the distance of its walls, mm."""
    opening = design.bore
    if opening is None:
        return None, None, 0.0
    loop, off, _ = rounded_loop(opening.outline, tolerance, body.precision, "the bore")
    low, high = (body.line(np.column_stack([loop, np.full(len(loop), z)])) for z in (0.0, design.recipe.height))
    return low, high, off
