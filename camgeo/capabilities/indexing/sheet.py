"""A flank as triangles between the end faces, floor and blank: columns at shaft angles, rows in layers.

Where a flank enters at the lower end face and leaves at the upper one, columns end on that face. The breaks of the
motion, and the corners of the flank, lie on columns. Two columns are joined from the floor to the blank in the order of
their layers. Where a flank meets an end face twice at one shaft angle, the columns before it lean, and the last one
lies in that face. Each triangle lies in a cell of shaft angles and rho, whose bound is proved
(`camgeo.capabilities.indexing.bends`). Where a flank meets an end face is found in layers, and looked at again at all
points of the sheet.
"""

from __future__ import annotations

import math
from itertools import pairwise
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from camgeo.capabilities.indexing.bends import bends
from camgeo.capabilities.indexing.spans import TrackError, breaks_within, layers_at, layers_of, span_of
from camgeo.curve.curve import CurveError
from camgeo.fit.cells import MOST_CELLS, columns, fewest_cells, too_many
from camgeo.fit.nodes import ToleranceError
from kin.numeric.angles import TURN
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from camgeo.capabilities.indexing.bends import Bends
    from camgeo.capabilities.indexing.flank import Flank
    from kin.numeric.arrays import Array, Indices, Mask

LOOKS = 240  # parts of a turn, and
BLOCKS = 4  # of the depth, over each of which second derivatives are bounded before triangles are known
MOST_ROWS = 2000
ROUNDS = 40  # in which columns are divided and rows added
MORE_ROWS = 1.2  # times as many rows, where they are too far apart
SHARE = 0.9  # of a tolerance that the first columns are made for
LAYERS = 33  # in which ends are looked at
LEAN = 0.01  # rad over which columns lean at least
SAME = 1e-12  # rad: shaft angles so near are one
NEAR = 1e-3  # of the distance of rows: so near to the end of a column no row has a point of its own
BEYOND = 1e-6  # mm by which a point in a column may lie beyond an end face


@dataclass(frozen=True, eq=False)
class Sheet:
    """Points of a flank in its layers and its triangles (t, 3), which run counter-clockwise seen from outside.

    phi, h, w, z   of the points (k,): polar angles, unrolled, rad, heights and layers, and heights over the lower face
    floor, blank   numbers of the points in these layers, by rising shaft angles
    ends           numbers of the points at the lower and the upper end face, from the floor to the blank
    off            bound, mm, of the distance of the triangles from the flank
    """

    phi: Array
    h: Array
    w: Array
    z: Array
    triangles: Indices
    floor: Indices
    blank: Indices
    ends: tuple[Indices, Indices]
    off: float


class _Lean(NamedTuple):
    """Columns that lean: from the shaft angle `begin`, rad, on, up to the end face; the last one stands for `end`."""

    begin: float
    end: float


class _Shape(NamedTuple):
    """Shaft angles of the ends of floor and blank, rad (2, 2), by the end face, and how columns lean there, if so."""

    corners: Array
    leans: tuple[_Lean | None, _Lean | None]

    @property
    def ends(self) -> tuple[float, float]:
        """Shaft angles, rad, of the first and the last column."""
        low, high = self.leans
        return low.end if low else float(self.corners[0].min()), high.end if high else float(self.corners[1].max())


class _Ends(NamedTuple):
    """Where columns (n,) begin towards the floor and end towards the blank, mm, and by which end face, 0, 1 or -1."""

    theta: Array
    inner: Array
    outer: Array
    inner_face: Indices
    outer_face: Indices


class _Net(NamedTuple):
    """Points: shaft angles, layers, rho and end face (k,), and triangles (t, 3), about +n; numbers by columns."""

    theta: Array
    w: Array
    rho: Array
    face: Indices
    triangles: Indices
    columns: list[Indices]

    @property
    def gaps(self) -> Indices:
        """Number of the gap between columns in which each triangle lies (t,)."""
        own = np.repeat(np.arange(len(self.columns)), [column.size for column in self.columns])
        return np.asarray(own[self.triangles].min(axis=1))


def sheet_of(flank: Flank, tolerance: float, wide: tuple[float, float]) -> Sheet:
    """Sheet within a tolerance, mm, of a flank that is regular.

    In the layers of floor and blank its edges span at most the polar angle and height `wide` of (phi, h). Raises
    ToleranceError where it would have too many triangles, and as `span_of` does.
    """
    shape = _shape(flank)
    theta, rows = _first(flank, shape, tolerance, wide)
    off = np.array([math.inf])
    for _ in range(ROUNDS):
        if theta.size * rows > MOST_CELLS:
            raise too_many(tolerance, theta.size * rows)
        net = _net(flank, shape, theta, rows)
        off, across = _off(flank, net)
        bad = ~(off <= tolerance)
        edges = _edges_wide(flank, net, theta.size, wide)
        if not bad.any() and not edges.any():
            return _made(flank, net, float(off.max()))
        deep = bad & ~across
        if deep.any():
            rows = math.ceil(MORE_ROWS * rows)
        split = edges
        split[net.gaps[bad & across]] = True
        theta = np.sort(np.concatenate([theta, 0.5 * (theta[:-1] + theta[1:])[split]]))
    raise ToleranceError(f"a flank is not within {tolerance:.3g} mm", float(np.nanmax(off)))


def _shape(flank: Flank) -> _Shape:
    """Where a flank begins and ends; raises TrackError as `span_of` does."""
    ends = span_of(flank, layers_of(flank, LAYERS)).theta
    leans: list[_Lean | None] = []
    breaks = breaks_within(flank)
    for k, sense in ((0, -1.0), (1, 1.0)):
        steps = np.diff(ends[k])
        if bool((steps >= 0.0).all() or (steps <= 0.0).all()):
            leans.append(None)
            continue
        inner, outer = sorted((sense * ends[k]).tolist())[:: LAYERS - 1]
        before = sense * breaks[sense * breaks < inner - SAME]
        begin = max(inner - LEAN - 0.5 * (outer - inner), float(before.max(initial=-math.inf)))
        if ((sense * breaks > inner - SAME) & (sense * breaks < outer + SAME)).any():
            problem = f"the {flank.name} flank meets an end face along a break of the motion"
            raise TrackError(problem, sense * inner, "give a part.length that is a little less")
        leans.append(_Lean(sense * begin, sense * (outer + 0.5 * (inner - begin))))
    return _Shape(ends[:, [0, -1]], (leans[0], leans[1]))


def _first(flank: Flank, shape: _Shape, tolerance: float, wide: tuple[float, float]) -> tuple[Array, int]:
    """Shaft angles of columns, rad, and number of rows that about hold a tolerance."""
    begin, end = shape.ends
    breaks = breaks_within(flank)
    own = [[lean.begin, lean.end] if lean else shape.corners[k].tolist() for k, lean in enumerate(shape.leans)]
    knots = np.unique(np.concatenate([*own, breaks[(breaks > begin) & (breaks < end)]]))
    knots = knots[np.append(np.diff(knots) > SAME, True)]
    even = np.linspace(begin, end, max(2, math.ceil(LOOKS * (end - begin) / TURN)) + 1)
    look = np.unique(np.concatenate([even, knots]))
    look = look[np.append(np.diff(look) > SAME, True)]
    found, reach = _bounds(flank, look)

    def step_of(count: int) -> Array:
        return np.minimum(found.step(reach / count, SHARE * tolerance), wide[0])

    rows, step = fewest_cells(step_of, look, MOST_ROWS, tolerance)
    return columns(knots, look, step), rows


def _bounds(flank: Flank, look: Array) -> tuple[Bends, Array]:
    """Bounds between neighbours of shaft angles (n + 1,), from floor to blank, and how far rho reaches there, mm."""
    pose = flank.pose(look)
    rho = np.array([flank.reached(pose, layer) for layer in layers_of(flank).tolist()])
    every = np.array([rho[:, :-1], rho[:, 1:]])
    low, high = np.nanmin(every, axis=(0, 1)), np.nanmax(every, axis=(0, 1))
    first = (low + np.arange(BLOCKS)[:, None] / BLOCKS * (high - low)).ravel()
    sides = np.tile(look[:-1], BLOCKS), np.tile(look[1:], BLOCKS)
    found = bends(flank, sides, (first, first + np.tile((high - low) / BLOCKS, BLOCKS))).most(BLOCKS)
    loose = ~np.isfinite(found.whole).all(axis=0)
    if loose.any():
        raise CurveError("a flank bends so sharply that no grid of it is proved", float(look[:-1][loose][0]))
    return found, high - low


def _column_ends(flank: Flank, theta: Array, shape: _Shape) -> _Ends:
    """Where columns begin and end in the depth."""
    inner, outer = np.full_like(theta, flank.form.floor), np.full_like(theta, flank.form.blank)
    faces = np.full((2, theta.size), -1)
    for k, (of_floor, of_blank) in enumerate(shape.corners.tolist()):
        if shape.leans[k] is not None:
            continue
        low, high = min(of_floor, of_blank), max(of_floor, of_blank)
        zone = np.flatnonzero((theta >= low - SAME) & (theta <= high + SAME))
        w = layers_at(flank, theta[zone], k * flank.form.length)
        w[np.abs(theta[zone] - of_floor) <= SAME] = flank.form.floor
        w[np.abs(theta[zone] - of_blank) <= SAME] = flank.form.blank
        # at the lower face a flank goes on behind its corner, at the upper one before it
        (inner if (of_floor > of_blank) == (k == 0) else outer)[zone] = w
        faces[0 if (of_floor > of_blank) == (k == 0) else 1, zone] = k
    return _Ends(theta, inner, outer, faces[0], faces[1])


def _net(flank: Flank, shape: _Shape, nominal: Array, rows: int) -> _Net:
    """Points and triangles between columns, with so many steps from floor to blank."""
    ends = _column_ends(flank, nominal, shape)
    floor, blank = flank.form.floor, flank.form.blank
    layers = np.linspace(floor, blank, rows + 1)
    depth = np.abs(layers - floor)
    near = NEAR * abs(blank - floor) / rows
    columns, w, theta, face = [], [], [], []
    count = 0
    first, last = np.abs(ends.inner - floor), np.abs(ends.outer - floor)
    for i in range(ends.theta.size):
        between = layers[(depth > first[i] + near) & (depth < last[i] - near)]
        one = last[i] - first[i] <= SAME
        own = np.concatenate([ends.inner[i : i + 1], between, ends.outer[i : i + 1][int(one) :]])
        mark = np.full(own.size, -1)
        mark[-1] = ends.outer_face[i]
        mark[0] = max(ends.inner_face[i], mark[0]) if own.size == 1 else ends.inner_face[i]
        columns.append(np.arange(count, count + own.size))
        w.append(own)
        theta.append(np.full(own.size, ends.theta[i]))
        face.append(mark)
        count += own.size
    at, layer, faces = np.concatenate(theta), np.concatenate(w), np.concatenate(face)
    for k, lean in enumerate(shape.leans):
        if lean is not None:
            own = (at < lean.begin) if k == 0 else (at > lean.begin)
            share = (at[own] - lean.begin) / (lean.end - lean.begin)
            last = span_of(flank, layers).theta[k]
            faces[own] = np.where(share == 1.0, k, faces[own])
            at[own] = lean.begin + share * (np.interp(np.abs(layer[own] - floor), depth, last) - lean.begin)
    rho = flank.reached(flank.pose(at), layer)
    if not np.isfinite(rho).all():
        raise CurveError("the roller does not touch a layer of the cam", float(at[~np.isfinite(rho)][0]))
    share = np.abs(layer - floor)
    found = []
    for left, right in pairwise(columns):
        if left.size == right.size and np.array_equal(layer[left[1:-1]], layer[right[1:-1]]):
            a, b, c, d = left[:-1], left[1:], right[:-1], right[1:]
            found += [np.column_stack([a, b, c]), np.column_stack([d, c, b])]
        else:
            found.append(_joined(left.tolist(), right.tolist(), share))
    return _Net(at, layer, rho, faces, np.concatenate(found), columns)


def _joined(left: list[int], right: list[int], share: Array) -> Indices:
    """Triangles between two columns of points, in the order of their shares of the depth."""
    i = j = 0
    found = []
    while i + 1 < len(left) or j + 1 < len(right):
        if j + 1 == len(right) or (i + 1 < len(left) and share[left[i + 1]] <= share[right[j + 1]]):
            found.append((left[i], left[i + 1], right[j]))
            i += 1
        else:
            found.append((left[i], right[j + 1], right[j]))
            j += 1
    return np.array(found, dtype=np.intp).reshape(-1, 3)


def _off(flank: Flank, net: _Net) -> tuple[Array, Mask]:
    """Bounds, mm (t,), of the triangles' distances from a flank, and which of them narrower columns make less."""
    corners, depths = net.theta[net.triangles], net.rho[net.triangles]
    first, last, near, far = corners.min(axis=1), corners.max(axis=1), depths.min(axis=1), depths.max(axis=1)
    found = bends(flank, (first, last), (near, far))
    off = found.off(last - first, far - near)
    # what two corners in one column are apart stays, however narrow the columns are
    beside = np.roll(corners, 1, axis=1) == corners
    apart = np.where(beside, np.abs(np.roll(depths, 1, axis=1) - depths), 0.0).max(axis=1)
    return off, found.off(np.zeros_like(off), apart) < 0.5 * off


def _edges_wide(flank: Flank, net: _Net, count: int, wide: tuple[float, float]) -> Mask:
    """Gaps (n - 1,) between columns in which an edge on floor or blank spans more than a polar angle and a height."""
    found = np.zeros(count - 1, dtype=bool)
    for k, layer in ((0, flank.form.floor), (-1, flank.form.blank)):
        number = np.array([column[k] for column in net.columns])
        contact = flank.contact(net.theta[number], flank.pose(net.theta[number]), net.rho[number])
        edge = (net.w[number][1:] == layer) & (net.w[number][:-1] == layer)
        found |= edge & ((np.abs(np.diff(contact.phi)) > wide[0]) | (np.abs(np.diff(contact.h)) > wide[1]))
    return found


def _made(flank: Flank, net: _Net, off: float) -> Sheet:
    """The sheet of points and triangles that hold."""
    contact = flank.contact(net.theta, flank.pose(net.theta), net.rho)
    h, z, length = contact.h.copy(), contact.z.copy(), flank.form.length
    outside = np.where(net.face < 0, np.maximum(-z, z - length), 0.0)
    if float(outside.max()) > BEYOND:
        problem = f"the {flank.name} flank leaves the cam and comes back"
        where = float(net.theta[int(np.argmax(outside))])
        raise TrackError(problem, where, "set the turret to the middle of the cam, or give another part.length")
    for k in range(2):
        edge = net.face == k
        z[edge] = k * length
        h[edge] = flank.form.ends(net.w[edge])[k]
    inner, outer = (np.array([column[k] for column in net.columns]) for k in (0, -1))
    floor, blank = inner[net.w[inner] == flank.form.floor], outer[net.w[outer] == flank.form.blank]
    paths = []
    for k, column in ((0, net.columns[0]), (1, net.columns[-1])):
        on_inner, on_outer = inner[net.face[inner] == k], outer[net.face[outer] == k]
        if k == 0:
            path = np.concatenate([on_inner[::-1], column, on_outer])
        else:
            path = np.concatenate([on_inner, column, on_outer[::-1]])
        # a column of one point is the end of both, and what follows itself is left out
        paths.append(path[np.append(True, np.diff(path) != 0)])
    triangles = net.triangles if flank.side < 0 else net.triangles[:, ::-1]
    return Sheet(contact.phi, h, net.w, z, triangles, floor, blank, (paths[0], paths[1]), off)
