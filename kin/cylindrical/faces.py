"""Which face of the intended drum each triangle belongs to, and how far it is from it.

A triangle belongs to the face that it is nearest to: blank and floor are cylinders about the axis, ends are level, the
bore is an outline drawn along z, flanks are known by the roller (`kin.cylindrical.roller`). Corners alone do not tell:
all three may lie on the edge between two faces, so that middles of sides and the inside count as well. Normals are not
asked: a coarse blank has skew facets.
"""

from __future__ import annotations

import math
from functools import cached_property
from typing import TYPE_CHECKING, TypeVar

import numpy as np

from kin.cylindrical.edges import Edges
from kin.cylindrical.roller import BESIDE, Place, Worst
from kin.numeric.angles import TURN
from kin.numeric.arrays import paired
from kin.numeric.records import dataclass, replace
from kin.turned.bore import corners_off_bore, edges_off_bore, inside_off_bore, middles

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from kin.cylindrical.intent import DrumIntent
    from kin.cylindrical.roller import Gauge
    from kin.numeric.arrays import Array, Indices, Mask
    from kin.read.mesh.mesh import Mesh

Entry = TypeVar("Entry", bound=np.generic)

BLANK, FLOOR, BOTTOM, TOP, BORE = "blank", "floor", "bottom", "top", "bore"
NEAR = 0.1  # of the radius of a roller: what is farther below its flank holds it nowhere


@dataclass(frozen=True, eq=False)
class Body:
    """A mesh, mm, as if not mirrored: corners' places (v, 3), and triangles by corner numbers (t, 3).

    Of one that is laid over several turns of a motion, `laid` (v,) are the corners' polar angles there, rad.
    """

    points: Array
    corners: Indices
    laid: Array | None = None

    @staticmethod
    def of(mesh: Mesh, *, mirrored: bool) -> Body:
        """The body of a file's mesh."""
        if not mirrored:
            return Body(mesh.points, mesh.corners)
        return Body(mesh.points * [1.0, -1.0, 1.0], mesh.corners[:, ::-1])

    @cached_property
    def r(self) -> Array:
        """Distances (v,) of corners from the axis, mm."""
        return np.hypot(self.points[:, 0], self.points[:, 1])

    @cached_property
    def phi(self) -> Array:
        """Polar angles (v,) of corners, rad."""
        return np.arctan2(self.points[:, 1], self.points[:, 0]) if self.laid is None else self.laid

    @cached_property
    def beyond(self) -> Array:
        """By how much farther than BESIDE the corners of triangles (t,) are apart round the axis, rad."""
        a, b, c = self.each(self.phi)
        apart = [np.abs(np.remainder(one - other + np.pi, TURN) - np.pi) for one, other in ((a, b), (b, c), (c, a))]
        beyond: Array = np.maximum(np.maximum.reduce(apart) - BESIDE, 0.0)
        return beyond

    def near(self, gauge: Gauge, most: Array) -> Mask:
        """Triangles (t,) that are high enough for a gauge to hold it; of their corners F is `most` (v,) at most."""
        climb = gauge.lever * gauge.lifts.steepest * self.beyond
        return np.asarray(np.maximum.reduce(self.each(most)) + climb >= -NEAR * gauge.radius)

    def over(self, turns: int, gauges: Sequence[Gauge]) -> tuple[Body, Indices]:
        """The body laid over so many turns, and the number (k,) of the triangle that each of its triangles is.

        A drum of several turns is one turn of a drum that goes round as often: each triangle stands in it once a turn,
        as far as it is near the way of the rollers there.
        """
        if turns == 1:
            return self, np.arange(len(self.corners))
        count, start = len(self.points), self.corners[:, 0]
        ahead = np.round((self.phi[start][:, None] - self.phi[self.corners]) / TURN).astype(np.intp)
        corners, numbers = [], []
        z, far = self.points[:, 2], np.maximum.reduce(self.each(self.r)) >= min(gauge.floor for gauge in gauges)
        least = [[gauge.most(self.phi + TURN * turn, z) for turn in range(turns)] for gauge in gauges]
        for turn in range(turns):
            near = far.copy()
            for gauge, most in zip(gauges, least, strict=True):
                near &= self.near(gauge, most[turn])
            number = np.flatnonzero(near)
            corners.append(self.corners[number] + count * ((turn + ahead[number]) % turns))
            numbers.append(number)
        used, named = np.unique(np.concatenate(corners), return_inverse=True)
        own = used % count
        laid = self.phi[own] + TURN * (used // count)
        return Body(self.points[own], named.reshape(-1, 3), laid), np.concatenate(numbers)

    def each(self, values: NDArray[Entry]) -> tuple[NDArray[Entry], NDArray[Entry], NDArray[Entry]]:
        """Values of the three corners (t,) each, out of those of all corners (v,)."""
        a, b, c = (values[column] for column in self.corners.T)
        return a, b, c

    def edges_of(self, *groups: Mask) -> tuple[Indices, Indices, list[Mask]]:
        """Ends (e,), (e,) of the edges of some triangles, each once, and which of them are edges of each group."""
        which = np.flatnonzero(np.logical_or.reduce(groups))
        chosen, size = self.corners[which], len(self.points)
        a, b = chosen.T.ravel(), np.roll(chosen, -1, axis=1).T.ravel()
        bits = sum(group[which].astype(np.int64) << k for k, group in enumerate(groups))
        codes = paired(np.minimum(a, b), np.maximum(a, b), size) * (1 << len(groups)) + np.tile(bits, 3)
        codes.sort()
        edge = codes >> len(groups)
        heads = np.flatnonzero(np.diff(edge, prepend=-1))
        bits = np.bitwise_or.reduceat(codes, heads) if len(heads) else codes
        edge = edge[heads]
        members = [np.asarray(bits >> k & 1, dtype=np.bool_) for k in range(len(groups))]
        return (edge // size).astype(np.intp), (edge % size).astype(np.intp), members


@dataclass(frozen=True, eq=False)
class Faces:
    """Triangles of a body by face.

    kinds   names of the faces that the drum has, those of the flanks last
    kind    (t,) number of each triangle's face among them
    off     greatest distance, mm, of a plain face's triangles from it, by its name; nan where it has none
    stands  of each gauge: its roller, what it may touch, and the corners at their worst angles
    """

    kinds: tuple[str, ...]
    kind: Indices
    off: dict[str, float]
    stands: tuple[Stands, ...]

    def of(self, name: str) -> Mask:
        """Triangles (t,) of a face."""
        return np.asarray(self.kind == self.kinds.index(name))


@dataclass(frozen=True, eq=False)
class Stands:
    """How a body stands to a gauge.

    body     the file's, laid over the turns of the motion
    touched  triangles (t,) that the roller may touch: within its reach, and high enough
    across   triangles (t,) within its reach that its axis passes through
    worst    corners (v,) at their worst angles, as far as they are asked for; nan for others
    flank    triangles (t,) of the gauge's flank
    beside   triangles (t,) of flanks in other turns, which the roller without ends must leave room
    """

    gauge: Gauge
    body: Body
    touched: Mask
    across: Mask
    worst: Worst
    flank: Mask
    beside: Mask

    def among(self, walls: Mask) -> Stands:
        """Copy in which the marked triangles (t,) are walls of all turns of a groove."""
        within = np.maximum.reduce(self.body.each(self.body.r)) >= self.gauge.inner
        return replace(self, across=self.across & (within | walls), beside=self.beside & walls & ~self.flank)

    def edges(self) -> Edges:
        """Edges that the roller may touch, that are of its flank, or beside it."""
        a, b, (flank, reached, beside) = self.body.edges_of(self.flank, self.touched, self.beside)
        corners = self.body.corners[self.touched]
        return Edges(self.body.points, self.worst, a, b, flank, reached, beside, corners)


def faces_of(body: Body, drum: DrumIntent, gauges: tuple[Gauge, ...], tolerance: float) -> Faces:
    """Sort the triangles of a body by face; those within the tolerance, mm, of a plain face belong to one."""
    plain = _plain(body, drum)
    names = tuple(plain)
    offs = np.stack([np.maximum.reduce(body.each(off)) for off in plain.values()])
    edged = np.flatnonzero(offs.min(axis=0) <= tolerance)
    for name, row in zip(names, offs, strict=True):
        near = edged[row[edged] <= tolerance]
        row[near] = np.maximum(row[near], _inside(body, drum, name, body.corners[near]))
    kind, least = offs.argmin(axis=0), offs.min(axis=0)
    laid, base = body.over(drum.follower.turns, gauges)
    rest = np.flatnonzero((least > tolerance)[base])
    # only the inside shows that they are of none of the plain faces
    bent = np.flatnonzero(np.isin(base[rest], edged))
    stands = [_stands(laid, gauge, rest) for gauge in gauges]
    aways = np.stack([_aways(own, rest, bent) for own in stands])
    nearest = least.copy()
    np.minimum.at(nearest, base[rest], aways.min(axis=0))
    free = nearest < least
    for number, (own, away) in enumerate(zip(stands, aways, strict=True), len(names)):
        which = np.flatnonzero((away == nearest[base[rest]]) & free[base[rest]])
        _, first = np.unique(base[rest[which]], return_index=True)  # in one turn alone
        chosen = rest[which[first]]
        own.flank[chosen] = True
        kind[base[chosen]], free[base[chosen]] = number, False
    # beside one turn of a groove the walls of its others leave its roller room down to the floor
    walls = (kind >= len(names))[base] & (drum.follower.turns > 1)
    stands = [own.among(walls) for own in stands]
    found = {name: _farthest(body, drum, (name, tolerance), kind == k, offs[k]) for k, name in enumerate(names)}
    return Faces((*names, *(gauge.name for gauge in gauges)), kind, found, tuple(stands))


def _aways(stands: Stands, rest: Indices, bent: Indices) -> Array:
    """Distance (n,), mm, of triangles by their numbers (n,) from a flank, with their inside if they are `bent`."""
    body, gauge = stands.body, stands.gauge
    corners, off = body.corners[rest], _off_flank(gauge, stands.worst)
    away: Array = np.maximum.reduce([off[column] for column in corners.T])
    within = middles(body.points[corners[bent]])
    about = np.repeat(body.phi[corners[bent, 0]], within.shape[1])
    inside = _off_flank(gauge, gauge.worst(within.reshape(-1, 3), about)).reshape(within.shape[:2])
    away[bent] = np.maximum(away[bent], inside.max(axis=1, initial=0.0))
    return away


def _inside(body: Body, drum: DrumIntent, name: str, corners: Indices) -> Array:
    """How far the inside of triangles (n, 3) is from a plain face, mm (n,), if their corners lie on it."""
    if name in {BOTTOM, TOP}:
        return np.zeros(len(corners))
    if name == BORE and drum.bore is not None:
        return inside_off_bore(drum.bore, body.points[corners])
    radius = drum.radius if name == BLANK else drum.floor
    flat = body.points[corners][..., :2]
    ends = [(flat[:, k], flat[:, k - 1]) for k in range(3)]
    sag: Array = np.maximum(radius - np.minimum.reduce([least_radius(*each) for each in ends]), 0.0)
    return sag


def least_radius(start: Array, last: Array) -> Array:
    """Least distance (n,) from the axis of lines from one to another place (n, 2), mm."""
    way = last - start
    square = np.einsum("nk,nk->n", way, way)
    share = np.clip(-np.einsum("nk,nk->n", start, way) / np.where(square > 0.0, square, 1.0), 0.0, 1.0)
    foot = start + share[:, None] * way
    least: Array = np.hypot(foot[:, 0], foot[:, 1])
    return least


def _off_flank(gauge: Gauge, worst: Worst) -> Array:
    """Distance (n,) of points from a flank, mm; infinite on the other side of the roller's axis, where it has none."""
    off: Array = np.where(worst.height < gauge.smallest, np.abs(worst.distance), np.inf)
    return off


def _stands(body: Body, gauge: Gauge, rest: Indices) -> Stands:
    """How a body stands to a gauge; `rest` are the triangles whose corners are asked for at any rate."""
    z = body.points[:, 2]
    above = gauge.beyond(Place(body.phi, body.r, z)) > 0.0
    signs = body.each(above)
    within = np.maximum.reduce(body.each(body.r)) >= gauge.inner
    metal = ~np.logical_or.reduce(signs)
    across = ~metal & ~np.logical_and.reduce(signs)
    near = body.near(gauge, gauge.most(body.phi, z))
    touched = within & metal & near
    corner = np.zeros(len(z), dtype=np.bool_)
    corner[body.corners[rest]] = corner[body.corners[touched]] = True
    asked = np.flatnonzero(corner & ~above & (body.r > 0.0))
    worst = Worst(*(np.full(len(z), np.nan) for _ in range(4)))
    for row, values in zip(worst, gauge.worst(body.points[asked], body.phi[asked]), strict=True):
        row[asked] = values
    return Stands(gauge, body, touched, across, worst, np.zeros(len(metal), dtype=np.bool_), metal & near)


def _plain(body: Body, drum: DrumIntent) -> dict[str, Array]:
    """Distances (v,) of corners from each plain face, mm."""
    r, z = body.r, body.points[:, 2]
    faces = {BLANK: np.abs(r - drum.radius)}
    track = drum.track
    if track.depth is not None:
        faces[FLOOR] = np.abs(r - drum.floor)
    # an end whose flank goes down to the bore takes the place of a level one
    whole = track.depth is None
    if not (whole and track.sides[0] > 0):
        faces[BOTTOM] = np.abs(z)
    if not (whole and track.sides[0] < 0):
        faces[TOP] = np.abs(z - drum.length)
    if drum.bore is not None:
        faces[BORE] = corners_off_bore(drum.bore, body.points, drum.radius)
    return faces


def _farthest(body: Body, drum: DrumIntent, what: tuple[str, float], own: Mask, off: Array) -> float:
    """Greatest distance, mm, of some triangles from a plain face, by its name and the tolerance; nan for none.

    `own` (t,) marks the triangles, whose corners are `off` (t,) from it.
    """
    name, tolerance = what
    if not own.any():
        return math.nan
    worst = float(off[own].max())
    if name in {BOTTOM, TOP}:
        return worst
    a, b, _ = body.edges_of(own)
    start, last = body.points[a, :2], body.points[b, :2]
    if name == BORE and drum.bore is not None:
        return max(worst, edges_off_bore(drum.bore, start, last, tolerance))
    radius = drum.radius if name == BLANK else drum.floor
    return max(worst, radius - float(least_radius(start, last).min()))
