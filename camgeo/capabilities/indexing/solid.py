"""The indexing cam as a mesh: two flanks, blank, floor and end faces that share their points, closed by construction.

In the layer of the blank the metal is one band about the cam: from the upper flank of a turn of the track up to the
lower flank of the next turn. On the floor the groove is one band, from the lower flank up to the upper one. Both end
on the end faces. These are plane, and bounded by the bore inside. Outside, a line bounds them that runs along the
blank, down the upper flank, along the floor and up the lower flank.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from camgeo.capabilities.indexing.band import filled
from camgeo.capabilities.indexing.sheet import sheet_of
from camgeo.files.errors import RegionError
from camgeo.files.mesh import Building, MeshFacts
from camgeo.files.prism import rounded_loop
from camgeo.files.triangulate import region
from camgeo.fit.bound import Bound
from camgeo.fit.nodes import ToleranceError
from kin.numeric.angles import TURN

if TYPE_CHECKING:
    from camgeo.capabilities.indexing.design import IndexDesign
    from camgeo.capabilities.indexing.forms import Barrel, Globoid
    from camgeo.capabilities.indexing.sheet import Sheet
    from camgeo.files.mesh import Mesh
    from camgeo.files.precision import Precision
    from kin.numeric.arrays import Array, Indices

ROUNDINGS = math.sqrt(1.5)  # of a point in space, in those of a plane point


class _Line(NamedTuple):
    """Points of a line in a layer: their numbers, polar angles, unrolled, rad, and heights, (n,) each."""

    number: Indices
    phi: Array
    h: Array

    def turned(self, by: float) -> _Line:
        """The line by so much of a turn, rad, further on."""
        return _Line(self.number, self.phi + by, self.h)

    def then(self, other: _Line) -> _Line:
        """Both lines as one, which the last point and the first have in common."""
        return _Line(*(np.concatenate([a, b[1:]]) for a, b in zip(self, other, strict=True)))


class _Wall(NamedTuple):
    """A flank in the body: its lines on floor and blank, and numbers of its points at both end faces."""

    floor: _Line
    blank: _Line
    ends: tuple[Indices, Indices]


def index_mesh(design: IndexDesign, tolerance: float, precision: Precision) -> tuple[Mesh, MeshFacts]:
    """Closed, oriented mesh of the cam, mm, within a tolerance of every surface, and facts on it.

    Raises ToleranceError where the tolerance cannot be held in the precision, CurveError and RegionError where no sound
    body is made.
    """
    recipe, form = design.recipe, design.recipe.form
    size = max(form.rim(form.blank), abs(form.length))
    fine = precision.fit_tolerance(tolerance, ROUNDINGS * size)
    deep, high = (form.widest(w, fine) for w in (form.floor, form.blank))
    wide = min(deep[0], high[0]), min(deep[1], high[1])
    body = Building(precision)
    sheets = {name: sheet_of(flank, fine, wide) for name, flank in design.flanks.items()}
    walls = {name: _wall(body, form, sheet) for name, sheet in sheets.items()}
    lower, upper = walls["lower"], walls["upper"]
    floor, blank = (form, form.floor), (form, form.blank)
    mouths = [_arc(body, floor, (k, upper.floor, lower.floor), 0.0, deep[0]) for k in range(2)]
    rims = [_arc(body, blank, (k, lower.blank, upper.blank), -TURN, high[0]) for k in range(2)]
    off = _fill(body, floor, mouths[0].then(lower.floor), upper.floor.then(mouths[1]), deep)
    rib = rims[0].then(upper.blank), lower.blank.turned(-TURN).then(rims[1])
    off = max(off, _fill(body, blank, *rib, high))
    if off > fine:
        raise ToleranceError(f"blank and floor are not within {tolerance:.3g} mm", off)
    bore_low, bore_high, bore_off = _bore(body, design, tolerance)
    for k, hole in enumerate((bore_low, bore_high)):
        loop = np.concatenate([rims[k].number, upper.ends[k][::-1], mouths[k].number, lower.ends[k]])
        _face(body, loop[loop != np.roll(loop, 1)], hole, up=bool(k))
    if bore_low.size:
        a, b = bore_high, bore_low
        c, d = np.roll(a, -1), np.roll(b, -1)
        body.triangles += [np.column_stack((a, c, b)), np.column_stack((d, b, c))]
    mesh = body.mesh("cam", mirrored=recipe.mirrored)
    flanks = max(sheet.off for sheet in sheets.values()) + body.moved
    precision.within("the flank", flanks, tolerance)
    rest = max(off + body.moved, bore_off)
    return mesh, MeshFacts(len(mesh.points), body.moved, Bound(flanks, flanks).wider(Bound(rest, rest)))


def _wall(body: Building, form: Barrel | Globoid, sheet: Sheet) -> _Wall:
    """A flank, added to the body."""
    points = form.points(sheet.phi, sheet.h, sheet.w)
    points[:, 2] = sheet.z
    number = body.add(points)
    body.triangles.append(number[sheet.triangles])
    floor, blank = (_Line(number[each], sheet.phi[each], sheet.h[each]) for each in (sheet.floor, sheet.blank))
    for line in (floor, blank):
        if not bool((np.diff(line.phi) > 0.0).all()):
            raise RegionError("a flank turns back in a layer of the cam")
    return _Wall(floor, blank, (number[sheet.ends[0]], number[sheet.ends[1]]))


def _arc(
    body: Building, layer: tuple[Barrel | Globoid, float], between: tuple[int, _Line, _Line], turn: float, wide: float
) -> _Line:
    """The edge of a layer with an end face, 0 or 1, from the end of one line, turned, to that of another."""
    (form, w), (k, first, last) = layer, between
    a, b = -k, -k
    begin, end = float(first.phi[a]) + turn, float(last.phi[b])
    count = max(1, math.ceil((end - begin) / wide))
    phi = np.linspace(begin, end, count + 1)
    height = float(form.ends(w)[k])
    points = form.points(phi[1:-1], np.full(count - 1, height), w)
    points[:, 2] = k * form.length
    number = np.concatenate([first.number[a : a + 1 or None], body.add(points), last.number[b : b + 1 or None]])
    return _Line(number, phi, np.full(count + 1, height))


def _fill(
    body: Building, layer: tuple[Barrel | Globoid, float], lower: _Line, upper: _Line, wide: tuple[float, float]
) -> float:
    """Add the band of a layer between two lines; the bound of its distance from the layer, mm."""
    form, w = layer
    phi = np.concatenate([lower.phi, upper.phi[1:-1]])
    h = np.concatenate([lower.h, upper.h[1:-1]])
    number = np.concatenate([lower.number, upper.number[1:-1]])
    n, m = lower.number.size, upper.number.size
    above = np.concatenate([[0], np.arange(n, n + m - 2), [n - 1]]).astype(np.intp)
    made = filled((phi, h), np.arange(n), above, (form.rim(w), form.unit(w)), wide)
    number = np.concatenate([number, body.add(form.points(made.phi, made.h, w))])
    body.triangles.append(number[made.triangles])
    phi, h = np.concatenate([phi, made.phi]), np.concatenate([h, made.h])
    spans = (np.ptp(part[made.triangles], axis=1) for part in (phi, h))
    return float(form.off(w, *spans).max())


def _face(body: Building, outer: Indices, inner: Indices, *, up: bool) -> None:
    """Plane end face within a line, and outside another one unless that has no point."""
    points = np.concatenate(body.points)
    holes = [points[inner, :2]] if inner.size else []
    faces = np.concatenate([outer, inner])[region(points[outer, :2], holes)]
    body.triangles.append(faces if up else faces[:, ::-1])


def _bore(body: Building, design: IndexDesign, tolerance: float) -> tuple[Indices, Indices, float]:
    """Numbers of the points of the bore on both end faces, none without one, and the distance of its walls, mm."""
    opening = design.bore
    if opening is None:
        nothing = np.zeros(0, dtype=np.intp)
        return nothing, nothing, 0.0
    loop, off, _ = rounded_loop(opening.outline, tolerance, body.precision, "the bore")
    low, high = (body.add(np.column_stack([loop, np.full(len(loop), z)])) for z in (0.0, design.recipe.form.length))
    return low, high, off
