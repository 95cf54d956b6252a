"""Which face of the intended cam each triangle belongs to, and how far the plain ones are off.

Plain faces are the blank and the floor, which are layers of the form, the level ends, and the bore, an outline along z.
A triangle that lies with all of its inside within the tolerance of plain faces belongs to the nearest of them. Corners
alone do not tell, as all three may lie on an edge between two faces. Any other triangle belongs to the flanks or to a
plain face, whichever is nearer. The form bounds how far the inside of a triangle is from a layer; where the bound is
too large, the triangle is divided. The inside is sampled against the bore, whose outline its edges then follow.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from kin.contour.nearest import nearest
from kin.numeric.records import dataclass
from kin.turned.bore import corners_off_bore, edges_off_bore, inside_off_bore

if TYPE_CHECKING:
    from kin.contour.holes import Hole
    from kin.indexing.intent import IndexIntent
    from kin.numeric.arrays import Array, Indices, Mask
    from kin.read.mesh.mesh import Mesh

BLANK, FLOOR, BOTTOM, TOP, BORE = "blank", "floor", "bottom", "top", "bore"
PER_PIECE = 64  # places of a piece of the bore's outline
HALVINGS = 5  # of triangles whose inside is not known well enough


@dataclass(frozen=True, eq=False)
class Body:
    """A mesh, mm, as if not mirrored, heights over the turret's centre.

    points (v, 3) and triangles by their numbers (t, 3); depth (v,) below the blank.
    """

    points: Array
    corners: Indices
    depth: Array

    @staticmethod
    def of(mesh: Mesh, intent: IndexIntent) -> Body:
        """The body of a file's mesh."""
        points, corners = mesh.points - [0.0, 0.0, intent.height], mesh.corners
        if intent.mirrored:
            points, corners = points * [1.0, -1.0, 1.0], corners[:, ::-1]
        r = np.hypot(points[:, 0], points[:, 1])
        return Body(points, corners, intent.form.depth_of(r, points[:, 2]))

    def divided(self, intent: IndexIntent, which: Indices, longest: float) -> Body:
        """The body with some triangles, by their numbers, in quarters until no side of them is longer, mm.

        The parts lie where the triangles do, beside others that are whole. What is farther than that outside the box of
        the intended cam stays whole: it is off every face by as much, and of a file in another unit it is nearly all.
        """
        low, high = intent.ends
        far = float(intent.form.rims(0.0, np.array(intent.ends)).max()) + longest
        box = np.array([[-far, -far, low - longest], [far, far, high + longest]])
        places = self.points[self.corners[which]]
        size = np.linalg.norm(np.roll(places, -1, axis=1) - places, axis=2).max(axis=1, initial=0.0)
        long = (size > longest) & _meets(places, box)
        if not long.any():
            return self
        parts = [np.delete(self.corners, which[long], axis=0)]
        places, size, points = places[long], size[long], [self.points]
        while len(places):
            done = (size <= longest) | ~_meets(places, box)
            count = sum(len(rows) for rows in points)
            points.append(places[done].reshape(-1, 3))
            parts.append(count + np.arange(3 * np.count_nonzero(done)).reshape(-1, 3))
            places, size = quartered(places[~done]), np.repeat(0.5 * size[~done], 4)
        every = np.concatenate(points)
        r = np.hypot(every[:, 0], every[:, 1])
        return Body(every, np.concatenate(parts), intent.form.depth_of(r, every[:, 2]))

    def edges_of(self, which: Indices) -> tuple[Indices, Indices]:
        """Both ends (e,) of the edges of triangles by their numbers, each edge once."""
        chosen = self.corners[which]
        a, b = chosen.ravel(), np.roll(chosen, -1, axis=1).ravel()
        codes = np.unique(np.minimum(a, b) * np.int64(len(self.points)) + np.maximum(a, b))
        return (codes // len(self.points)).astype(np.intp), (codes % len(self.points)).astype(np.intp)


@dataclass(frozen=True, eq=False)
class Faces:
    """Triangles of a body by face.

    kinds  names of the plain faces
    kind   (t,) number of each triangle's face among them, of one on a flank that of none
    off    greatest distance, mm, of a plain face's triangles from it, by its name; nan where it has none
    least  (t,) distance of each triangle from the nearest plain face, mm
    """

    kinds: tuple[str, ...]
    kind: Indices
    off: dict[str, float]
    least: Array

    @property
    def flanks(self) -> Mask:
        """Triangles (t,) that belong to flanks."""
        return np.asarray(self.kind == len(self.kinds))

    def of(self, name: str) -> Mask:
        """Triangles (t,) of a plain face."""
        return np.asarray(self.kind == self.kinds.index(name))


def plain_offs(body: Body, intent: IndexIntent, limits: tuple[float, float]) -> dict[str, Array]:
    """Distances (t,), mm, of triangles from each plain face, their inside included where it may be within tolerance.

    `limits` are the tolerance and that with the rounding of the file. Distances from layers are bounds, and triangles
    are divided until these are within the tolerance itself, if that can be.
    """
    tolerance = limits[1]
    low, high = intent.ends
    z = body.points[:, 2]
    corners = {BOTTOM: np.abs(z - low), TOP: np.abs(z - high)}
    if intent.bore is not None:
        corners[BORE] = corners_off_bore(intent.bore, body.points, intent.form.radius)
    offs = {name: off[body.corners].max(axis=1) for name, off in corners.items()}
    for name, depth in ((BLANK, 0.0), (FLOOR, intent.form.depth)):
        off = np.abs(body.depth - depth)[body.corners].max(axis=1)
        near = np.flatnonzero(off <= tolerance)
        off[near] = _layer_off(body.points[body.corners[near]], intent, depth, limits)
        offs[name] = off
    if intent.bore is not None:
        near = np.flatnonzero(offs[BORE] <= tolerance)
        inside = inside_off_bore(intent.bore, body.points[body.corners[near]])
        offs[BORE][near] = np.maximum(offs[BORE][near], inside)
    return offs


def sorted_faces(body: Body, intent: IndexIntent, offs: dict[str, Array], away: Array, tolerance: float) -> Faces:
    """Faces of triangles that are `offs` from plain faces and `away` (t,), mm, from flanks."""
    kinds = tuple(offs)
    every = np.stack(list(offs.values()))
    kind, least = every.argmin(axis=0), every.min(axis=0)
    kind = np.where((least > tolerance) & (away < least), len(kinds), kind)
    off = {name: float(row[kind == k].max(initial=-math.inf)) for k, (name, row) in enumerate(offs.items())}
    if intent.bore is not None and off[BORE] > -math.inf:
        a, b = body.edges_of(np.flatnonzero(kind == kinds.index(BORE)))
        edges = body.points[a, :2], body.points[b, :2]
        off[BORE] = max(off[BORE], edges_off_bore(intent.bore, *edges, tolerance))
    return Faces(kinds, kind, {name: math.nan if one == -math.inf else one for name, one in off.items()}, least)


def _layer_off(triangles: Array, intent: IndexIntent, depth: float, limits: tuple[float, float]) -> Array:
    """Distance (t,), mm, of triangles (t, 3, 3) from a layer: of their inside too, divided while that is open."""
    form, (goal, tolerance) = intent.form, limits
    worst, own = np.zeros(len(triangles)), np.arange(len(triangles))
    for halving in range(HALVINGS + 1):
        off = form.depth_of(np.hypot(triangles[..., 0], triangles[..., 1]), triangles[..., 2]) - depth
        ways = (np.roll(triangles, -1, axis=1) - triangles).transpose(1, 0, 2)
        more, less = form.bent(ways, triangles.mean(axis=1))
        known = np.abs(off).max(axis=1)
        bound = np.maximum(off.max(axis=1) + more, less - off.min(axis=1))
        bound = np.maximum(bound, known)
        # a corner that rounding has put beyond the tolerance stays there however often its triangle is divided
        settled = (bound <= np.where(known > goal, tolerance, goal)) | (known > tolerance) | (halving == HALVINGS)
        np.maximum.at(worst, own[settled], bound[settled])
        own, triangles = np.repeat(own[~settled], 4), quartered(triangles[~settled])
        if not len(own):
            break
    return worst


def _meets(places: Array, box: Array) -> Mask:
    """Whether triangles (t, 3, 3) may meet a box, its least and its greatest corner (2, 3)."""
    return np.asarray(((places.max(axis=1) >= box[0]) & (places.min(axis=1) <= box[1])).all(axis=1))


def quartered(values: Array) -> Array:
    """Values (t, 3, ...) at corners of triangles as those (4 t, 3, ...) of the four that halved sides make of each."""
    a, b, c = values[:, 0], values[:, 1], values[:, 2]
    ab, bc, ca = 0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a)
    parts = [np.stack(one, axis=1) for one in ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))]
    return np.stack(parts, axis=1).reshape(-1, *values.shape[1:])


def within_bore(bore: Hole, places: Array) -> float:
    """How far places (n, 2), mm, seen along z, lie within the outline of a bore at most, mm; 0 where none does."""
    outline = bore.contour.sample(PER_PIECE)
    near = places[np.hypot(places[:, 0], places[:, 1]) < np.hypot(outline[:, 0], outline[:, 1]).max()]
    inside = np.zeros(len(near), dtype=np.bool_)
    for (x, y), (u, v) in zip(outline, np.roll(outline, -1, axis=0), strict=True):
        if y != v:
            passed = (near[:, 1] < y) != (near[:, 1] < v)
            inside ^= passed & (near[:, 0] < x + (u - x) * (near[:, 1] - y) / (v - y))
    if not inside.any():
        return 0.0
    return float(nearest(bore.contour.as_arcs()[0], near[inside])[1].max())
