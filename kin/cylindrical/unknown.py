"""A solid of unknown origin as a drum: its facets about its axis, and what a line along the axis meets of it.

Nothing is intended: blank, floor and bore are read off the file. A solid of triangles is taken as it is; of one of
exact surfaces the B-spline ones are cut into triangles, finer than any reading.
"""

from __future__ import annotations

import math
from functools import cached_property
from typing import TYPE_CHECKING, Literal, NamedTuple

import numpy as np

from kin.cylindrical.faces import least_radius
from kin.numeric.angles import TURN
from kin.numeric.arrays import paired, runs_of
from kin.numeric.bernstein import values
from kin.numeric.errors import CamgeoError
from kin.numeric.records import dataclass
from kin.read.files import read_mesh
from kin.read.formats import format_of
from kin.read.step.faces import Plane, RoundFace
from kin.read.step.patch import Patch

if TYPE_CHECKING:
    from pathlib import Path

    from kin.numeric.arrays import Array, Indices, Mask
    from kin.read.step.shell import Shell

AxisName = Literal["x", "y", "z"]

FINE = 1e-4  # mm: triangles of exact surfaces lie so near them
MOST_PARTS = 24  # of a patch, each way
SECTORS = 12  # of the turn, each of which has a corner on the blank
ROUND = 1e-3  # of the radius, within which corners lie on one cylinder
SAME = 1e-7  # mm: crossings of a line nearer than this are one, on an edge between two triangles
WIDE = 1.0  # rad, of a triangle that is looked at from all angles
BENT = math.radians(20.0)  # a sharper edge is an edge of the part, and none between two facets of a face
MOST_BENT = 0.999  # of the edges between facets stand off no farther than is told: single ones do where a face ends
MOST_CROSSED = 0.995  # of them where a groove crosses itself
FACING = 0.9  # of a normal along the radius: of a facet that may be of the blank
UPRIGHT = 0.5  # of a normal along the radius: of a facet that may be of a flank


class UnknownError(CamgeoError, ValueError):
    """A solid that is no drum about its axis; `remedy` says in words what may help."""

    def __init__(self, problem: str, remedy: str = "") -> None:
        super().__init__(problem)
        self.remedy = remedy


class Column(NamedTuple):
    """What a line along the axis meets: heights (k,), mm, rising; the metal ends there (1) or begins (-1), (k,)."""

    z: Array
    sense: Array


class Placed(NamedTuple):
    """How a solid lies in its file: its axis, the place (2,) of that, mm, and how it is turned and mirrored.

    `turn`, rad, is counter-clockwise; with `mirrored` y is mirrored, as for a drum that turns counter-clockwise.
    """

    axis: AxisName = "z"
    at: tuple[float, float] = (0.0, 0.0)
    turn: float = 0.0
    mirrored: bool = False


@dataclass(frozen=True, eq=False)
class Drum:
    """A drum about z, its lower face at z = 0; mm.

    facets   corners (t, 3, 3) of triangles, counter-clockwise from outside; of exact surfaces those of flanks alone
    radius   of the blank
    length   greatest height
    below    height of the lower face in the file
    bends    how far facets stand off the surface between them, by the bend at each of their edges, (k,): an estimate
    rounding by which a coordinate may be off by the file's numbers
    levels   heights of level faces that are no facets, with the radii between which they lie and their sense, (k, 4)
    floors   radii of floors that are no facets, each with the heights between which it lies, (k, 3)
    bore     radius of a round bore, None without one
    keyed    the bore is no circle
    remarks  in words
    """

    facets: Array
    radius: float
    length: float
    below: float
    bends: Array
    rounding: float
    levels: Array
    floors: Array
    bore: float | None = None
    keyed: bool = False
    remarks: tuple[str, ...] = ()

    @cached_property
    def sag(self) -> float:
        """How far facets stand off the surface between them, mm."""
        return _most(self.bends, MOST_BENT)

    @cached_property
    def crossed_sag(self) -> float:
        """How far facets of a groove that crosses itself stand off the surface, mm.

        Fewer bends count than in `sag`: at a crossing's corner two flanks may bend as little as two facets do.
        """
        return _most(self.bends, MOST_CROSSED)

    @cached_property
    def phi(self) -> Array:
        """Polar angles (t, 3) of corners, rad, each within half a turn of the first of its facet."""
        own = np.arctan2(self.facets[..., 1], self.facets[..., 0])
        return np.asarray(own[:, :1] + np.remainder(own - own[:, :1] + 0.5 * TURN, TURN) - 0.5 * TURN)

    @cached_property
    def r(self) -> Array:
        """Distances (t, 3) of corners from the axis, mm."""
        return np.hypot(self.facets[..., 0], self.facets[..., 1])

    @cached_property
    def least(self) -> Array:
        """Least distances (t,) of facets from the axis, mm, seen along it; all corners may lie on the rim."""
        corners = list(np.moveaxis(self.facets[..., :2], 1, 0))
        sides = [(corners[k - 1], corners[k]) for k in range(3)]
        turned = np.stack([start[:, 0] * last[:, 1] - start[:, 1] * last[:, 0] for start, last in sides])
        about = (turned > 0.0).all(axis=0) | (turned < 0.0).all(axis=0)
        return np.where(about, 0.0, np.minimum.reduce([least_radius(*side) for side in sides]))

    @cached_property
    def rim(self) -> float:
        """Radius, mm, within which no line along the axis lies beneath a facet of the blank, but in the metal."""
        out = np.einsum("nk,nk->n", self.normals[:, :2], self.facets[..., :2].mean(axis=1))
        length = np.linalg.norm(self.normals, axis=1) * np.hypot(*self.facets[..., :2].mean(axis=1).T)
        own = (self.r.min(axis=1) >= (1.0 - ROUND) * self.radius) & (out > FACING * length)
        return float(self.least[own].min(initial=self.radius))

    @cached_property
    def normals(self) -> Array:
        """Twice the areas (t, 3) of facets, along their outward normals."""
        a, b, c = np.moveaxis(self.facets, 1, 0)
        return np.cross(b - a, c - a)

    def columns(self, radius: float, theta: Array) -> list[Column]:
        """What lines along the axis meet at a radius, mm, and polar angles (n,), rad."""
        places = radius * np.stack([np.cos(theta), np.sin(theta)], axis=-1)
        own, at = self._meetings(theta, self.least <= radius, self.r.max(axis=1) >= radius)
        a, b, c = np.moveaxis(self.facets[own], 1, 0)
        with np.errstate(divide="ignore", invalid="ignore"):
            shares = _shares(a[:, :2], b[:, :2], c[:, :2], places[at])
        hit = np.isfinite(shares).all(axis=1) & (shares >= -1e-12).all(axis=1)
        z = np.einsum("nk,nk->n", shares, np.stack([a[:, 2], b[:, 2], c[:, 2]], axis=1))[hit]
        sense, at = np.sign(self.normals[own[hit], 2]), at[hit]
        flat = [(height, way) for height, low, high, way in self.levels if low <= radius <= high]
        columns = []
        order = np.argsort(at, kind="stable")
        ends = np.searchsorted(at[order], np.arange(len(theta) + 1))
        for k in range(len(theta)):
            rows = order[ends[k] : ends[k + 1]]
            heights = np.concatenate([z[rows], [height for height, _ in flat]])
            ways = np.concatenate([sense[rows], [way for _, way in flat]])
            rising = np.argsort(heights, kind="stable")
            heights, ways = heights[rising], ways[rising]
            new = np.ones(len(heights), dtype=np.bool_)
            new[1:] = (np.diff(heights) > SAME) | (np.diff(ways) != 0.0)
            columns.append(Column(heights[new], ways[new]))
        return columns

    def floor(self, theta: Array, z: Array) -> float:
        """Greatest radius, mm, that lines from places (n,), at polar angles, rad, and heights, mm, meet inwards.

        It is nan where one of them meets nothing.
        """
        if len(self.floors):
            low, high = float(z.min()), float(z.max())
            radii = [r for r, bottom, top in self.floors if bottom <= low and high <= top]
            return max(radii, default=math.nan)
        out = np.einsum("nk,nk->n", self.normals[:, :2], self.facets[..., :2].mean(axis=1)) > 0.0
        low, high = self.facets[..., 2].min(axis=1), self.facets[..., 2].max(axis=1)
        own, at = self._meetings(theta, out, low <= z.max(), high >= z.min())
        turned = TURN * np.round((theta[at] - self.phi[own, 0]) / TURN)
        corners = np.stack([self.phi[own], self.facets[own][..., 2]], axis=-1)
        place = np.stack([theta[at] - turned, z[at]], axis=-1)
        with np.errstate(divide="ignore", invalid="ignore"):
            shares = _shares(corners[:, 0], corners[:, 1], corners[:, 2], place)
        hit = np.isfinite(shares).all(axis=1) & (shares >= -1e-9).all(axis=1)
        met = np.full(len(theta), np.nan)
        np.fmax.at(met, at[hit], np.einsum("nk,nk->n", shares[hit], self.r[own[hit]]))
        return math.nan if np.isnan(met).any() else float(met.max())

    def core(self, radius: float) -> tuple[float, float]:
        """Heights, mm, between which the metal within a radius, mm, lies: of its outermost level faces.

        Those of the whole drum where there is none.
        """
        level = (np.ptp(self.facets[..., 2], axis=1) == 0.0) & (self.r.max(axis=1) <= radius)
        z, up = self.facets[level, 0, 2], self.normals[level, 2] > 0.0
        flat = self.levels[self.levels[:, 2] <= radius] if len(self.levels) else self.levels
        low = [*z[~up].tolist(), *flat[flat[:, 3] < 0.0, 0].tolist()]
        high = [*z[up].tolist(), *flat[flat[:, 3] > 0.0, 0].tolist()]
        return min(low, default=0.0), max(high, default=self.length)

    def _meetings(self, theta: Array, *kept: Mask) -> tuple[Indices, Indices]:
        """Numbers of facets and of angles (m,), (m,) that may meet, of the facets that are kept."""
        low, high = self.phi.min(axis=1), self.phi.max(axis=1)
        chosen = np.logical_and.reduce(kept)
        order = np.argsort(theta % TURN)
        rising = (theta % TURN)[order]
        owns, places = [], []
        wide = np.flatnonzero(chosen & (high - low > WIDE))
        owns.append(np.repeat(wide, len(theta)))
        places.append(np.tile(np.arange(len(theta)), len(wide)))
        own = np.flatnonzero(chosen & (high - low <= WIDE))
        start, wide_by = low[own] % TURN, (high - low)[own]
        for turn in (0.0, -TURN):
            first = np.searchsorted(rising, start + turn - 1e-12)
            count = np.maximum(np.searchsorted(rising, start + turn + wide_by + 1e-12, side="right") - first, 0)
            each, step = runs_of(count)
            owns.append(own[each])
            places.append(order[first[each] + step])
        return np.concatenate(owns), np.concatenate(places)


def _shares(a: Array, b: Array, c: Array, place: Array) -> Array:
    """Barycentric shares (n, 3) of places (n, 2) in triangles; not finite of one that is seen edgewise."""

    def cross(p: Array, q: Array) -> Array:
        return np.asarray(p[:, 0] * q[:, 1] - p[:, 1] * q[:, 0])

    whole = cross(b - a, c - a)
    first, second = cross(b - place, c - place) / whole, cross(c - place, a - place) / whole
    return np.stack([first, second, 1.0 - first - second], axis=-1)


# --- reading --------------------------------------------------------------------------------------------------------


def read_drum(path: Path, placed: Placed, units: float | None = None) -> Drum:
    """Read a solid of any origin as a drum about its axis; `units`, mm, is the unit of a file that states none.

    Raises OSError where the file cannot be read; ReadError for a damaged one; ValueError for a suffix of no solid;
    UnknownError for a solid whose outermost corners lie on no cylinder about the axis.
    """
    record = format_of(path)
    if record.shell is not None:
        return _of_shell(record.shell(path), placed)
    read = read_mesh(path, units)
    points = _turned(read.mesh.points, placed)
    corners = read.mesh.corners[:, ::-1] if placed.mirrored else read.mesh.corners
    radius = _blank(points, read.mesh.points, placed)
    low = float(points[:, 2].min())
    points = points - [0.0, 0.0, low]
    facets = points[corners]
    bore, keyed = _bore(points, corners)
    remarks = tuple(f"the file has a fault: {fault}" for fault in read.faults)
    return Drum(
        facets,
        radius,
        float(points[:, 2].max()),
        low,
        _bends(points, corners, radius),
        read.rounding,
        np.empty((0, 4)),
        np.empty((0, 3)),
        bore,
        keyed,
        remarks,
    )


def _turned(points: Array, placed: Placed) -> Array:
    """Points (n, 3) about z, of a file about another axis at a place; turned, then mirrored."""
    first = "xyz".index(placed.axis)
    about = points[:, [(first + 1) % 3, (first + 2) % 3, first]] - [*placed.at, 0.0]
    sine, cosine = math.sin(placed.turn), math.cos(placed.turn)
    x, y, z = about.T
    x, y = x * cosine - y * sine, x * sine + y * cosine
    return np.stack([x, -y if placed.mirrored else y, z], axis=-1)


def _blank(points: Array, told: Array, placed: Placed) -> float:
    """Radius, mm, of the outermost corners about the axis, which lie all round it.

    Raises UnknownError where they do not, with the axis or the place of one of which they do. `told` are the points as
    the file has them.
    """
    radius = _round_about(points[:, :2])
    if radius is not None:
        return radius
    for axis in "xyz":
        first = "xyz".index(axis)
        flat = told[:, [(first + 1) % 3, (first + 2) % 3]]
        middle = 0.5 * (flat.min(axis=0) + flat.max(axis=0))
        if _round_about(flat - middle) is not None:
            at = "" if np.abs(middle).max() < SAME else f" and at {middle[0]:.6g},{middle[1]:.6g}"
            raise UnknownError(f"its outermost corners lie on no cylinder about {placed.axis}", f"give axis {axis}{at}")
    raise UnknownError(f"its outermost corners lie on no cylinder about {placed.axis}, x or y: no drum")


def _round_about(flat: Array) -> float | None:
    """Radius, mm, of the outermost of places (n, 2) about the origin; None where they are not all round it."""
    r, sector = np.hypot(*flat.T), np.floor((np.arctan2(flat[:, 1], flat[:, 0]) % TURN) * (SECTORS / TURN))
    most = np.zeros(SECTORS)
    np.maximum.at(most, sector.astype(np.intp) % SECTORS, r)
    radius = float(most.max())
    return radius if float(most.min()) >= (1.0 - ROUND) * radius else None


def _bore(points: Array, corners: Indices) -> tuple[float | None, bool]:
    """Radius, mm, of what the lowest face leaves about the axis, None without; and whether it is no circle."""
    level = (np.abs(points[corners][..., 2]) <= SAME * max(1.0, float(np.abs(points).max()))).all(axis=1)
    chosen = corners[level]
    if not len(chosen):
        return None, False
    a, b = chosen.T.ravel(), np.roll(chosen, -1, axis=1).T.ravel()
    codes, count = np.unique(paired(np.minimum(a, b), np.maximum(a, b), len(points)), return_counts=True)
    first, last = codes[count == 1] // len(points), codes[count == 1] % len(points)
    r = np.hypot(points[:, 0], points[:, 1])
    ends = np.concatenate([first, last])
    least, most = float(r[ends].min()), float(r[ends].max())
    if most - least <= ROUND * most:
        return None, False
    own = (r[first] < 0.5 * (least + most)) & (r[last] < 0.5 * (least + most))
    first, last, around = first[own], last[own], r[np.concatenate([first[own], last[own]])]
    # a keyway leaves most corners on the circle
    radius = float(np.median(around))
    if float(np.abs(around - radius).max()) > ROUND * radius:
        return radius, True
    area = np.abs(points[first, 0] * points[last, 1] - points[first, 1] * points[last, 0]).sum()
    return math.sqrt(0.5 * float(area) / math.pi), False


def _most(bends: Array, share: float) -> float:
    """Greatest of a share of values (k,); 0 without any."""
    return float(np.quantile(bends, share)) if len(bends) else 0.0


def _bends(points: Array, corners: Indices, radius: float) -> Array:
    """How far facets of flanks stand off a surface through their corners, mm, (k,): a width times its turn, over 8."""
    facets = points[corners]
    normal = np.cross(facets[:, 1] - facets[:, 0], facets[:, 2] - facets[:, 0])
    area = np.linalg.norm(normal, axis=1)
    middle = facets[..., :2].mean(axis=1)
    away = np.maximum(np.hypot(*middle.T), 1e-9 * radius)
    with np.errstate(divide="ignore", invalid="ignore"):
        normal = normal / area[:, None]
        outward = np.abs(np.einsum("nk,nk->n", normal[:, :2], middle)) / away
    own = np.flatnonzero((area > 0.0) & (outward < UPRIGHT))
    chosen = corners[own]
    a, b = chosen.T.ravel(), np.roll(chosen, -1, axis=1).T.ravel()
    facet = np.tile(own, 3)
    codes = paired(np.minimum(a, b), np.maximum(a, b), len(points))
    order = np.argsort(codes, kind="stable")
    twice = np.flatnonzero(np.diff(codes[order]) == 0)
    one, other = order[twice], order[twice + 1]
    turned = 2.0 * np.arcsin(np.minimum(0.5 * np.linalg.norm(normal[facet[one]] - normal[facet[other]], axis=1), 1.0))
    length = np.linalg.norm(points[a[one]] - points[b[one]], axis=1)
    width = (area[facet[one]] + area[facet[other]]) / np.maximum(length, 1e-300)
    return np.asarray((turned * width / 16.0)[(turned < BENT) & (length > 0.0)])


def _of_shell(shell: Shell, placed: Placed) -> Drum:
    """The drum of a solid of exact faces, whose B-spline surfaces may be flanks.

    Raises UnknownError where no cylinder is its blank.
    """
    if placed.axis != "z":
        raise UnknownError("exact surfaces are read about z", "leave axis out")
    flanks, levels, floors, bores, keyed = [], [], [], [], False
    for face in shell.faces:
        surface, (low, high) = face.surface, face.heights
        if isinstance(surface, Patch):
            facets = _cut(surface, outward=face.outward)
            facets = _turned(facets.reshape(-1, 3), placed).reshape(-1, 3, 3)
            flanks.append(facets[:, ::-1] if placed.mirrored else facets)
        elif isinstance(surface, RoundFace):
            if float(np.hypot(*(surface.centre - placed.at))) > ROUND * surface.radius:
                keyed = True
            elif face.outward:
                floors.append((surface.radius, low, high))
            else:
                bores.append(surface.radius)
        elif isinstance(surface, Plane) and surface.level:
            ends = np.concatenate([edge.samples for edge, _ in face.uses])[:, :2] - placed.at
            r = np.hypot(*ends.T)
            up = 1.0 if (surface.normal[2] > 0.0) == face.outward else -1.0
            levels.append((low, float(r.min()), float(r.max()), up))
        else:
            keyed = True
    if not flanks or not floors:
        raise UnknownError("no faces of a drum: B-spline surfaces between cylinders about z")
    facets = np.concatenate(flanks)
    radius = max(r for r, _, _ in floors)
    every = [z for _, *span in floors for z in span] + [z for z, *_ in levels]
    least = min(*every, float(facets[..., 2].min()))
    length = max(*every, float(facets[..., 2].max())) - least
    return Drum(
        facets - [0.0, 0.0, least],
        radius,
        length,
        least,
        np.array([FINE]),
        0.0,
        np.array([(z - least, low, high, up) for z, low, high, up in levels]).reshape(-1, 4),
        np.array([(r, low - least, high - least) for r, low, high in floors if r < radius]).reshape(-1, 3),
        min(bores, default=None),
        keyed,
    )


def _cut(patch: Patch, *, outward: bool) -> Array:
    """Triangles (t, 3, 3) of a B-spline surface, within FINE of it."""
    nets = patch.nets
    m, k = nets.shape[:2]
    own = nets.reshape(m * k, *nets.shape[2:])
    count = []
    for axis in (1, 2):
        degree = own.shape[axis] - 1
        bend = np.linalg.norm(np.diff(own, 2, axis=axis), axis=-1).max(initial=0.0) * degree * (degree - 1)
        count.append(int(min(max(math.ceil(math.sqrt(bend / (8.0 * FINE))), 1), MOST_PARTS)))
    share = [np.linspace(0.0, 1.0, each + 1) for each in count]
    rows = np.stack([values(own, np.full(len(own), t)) for t in share[0]], axis=1)
    flat = rows.reshape(-1, *rows.shape[2:])
    grid = np.stack([values(flat, np.full(len(flat), t)) for t in share[1]], axis=1)
    grid = grid.reshape(len(own), count[0] + 1, count[1] + 1, 3)
    a, b, c, d = grid[:, :-1, :-1], grid[:, 1:, :-1], grid[:, 1:, 1:], grid[:, :-1, 1:]
    facets = np.concatenate([np.stack(own, axis=-2).reshape(-1, 3, 3) for own in ((a, b, c), (a, c, d))])
    return facets if outward else facets[:, ::-1]
