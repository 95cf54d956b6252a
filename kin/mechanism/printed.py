"""A printable body judged from its triangles: closed, its heights, and its sections against the intended slabs."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from kin.contour.contour import Contour
from kin.numeric.check import Check, at_most
from kin.numeric.distinct import distinct
from kin.numeric.lengths import UNIT, length_words, span_words
from kin.read.errors import ReadError
from kin.read.mesh.mesh import welded
from kin.read.mesh.stl import rings, section

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from kin.mechanism.clearance import Slab
    from kin.numeric.arrays import Array
    from kin.read.mesh.mesh import Mesh

__all__ = ["judge_body"]

ROUNDING = 1e-9  # mm
INSIDE = 1.5  # times the tolerance: distance of judged sections from the levels, which may be off by the tolerance


def judge_body(name: str, corners: Array, slabs: Sequence[Slab], tolerance: float, path: Path) -> list[Check]:
    """Judge a body's triangles (t, 3, 3), in its own axes, mm: two checks, and a third if both hold.

    `slabs`, one at least, are the body as intended, `tolerance` is in mm; `name` is the body's, `path` its file's.

    watertight  every edge has two triangles, facing outward; no triangle is without area or there twice
    thickness   the body reaches from the lowest slab's lower face to the highest one's upper face, to `tolerance`
    outline     just within any two neighbouring levels (faces of slabs) farther apart than twice the tolerance the
                corners of the body's section, and the middles of its edges, lie within `tolerance` of the edge of the
                union of the slabs there, and the slabs' corners on that edge within it of the section's; of a single
                slab the section's area differs from the slab's by no more than the tolerance times the length of the
                slab's edges
    """
    mesh = welded(corners)
    faults = mesh.faults
    low, high = min(slab.low for slab in slabs), max(slab.high for slab in slabs)
    z = mesh.points[:, 2]
    off = max(abs(float(z.min()) - low), abs(float(z.max()) - high))
    detail = f"{name}: z from {span_words(z.min(), z.max())}, {span_words(low, high)} is expected"
    checks = [
        at_most("watertight", len(faults), 0, "faults", detail="; ".join([name, *faults])),
        at_most("thickness", off, tolerance, "mm", detail=detail, slack=ROUNDING),
    ]
    if checks[0].ok and checks[1].ok:
        checks.append(_outline(name, mesh, slabs, tolerance, path))
    return checks


def _outline(name: str, mesh: Mesh, slabs: Sequence[Slab], tolerance: float, path: Path) -> Check:
    """Check two sections between any two neighbouring levels against the slabs that pass there.

    It fails where no slab passes between two levels, and where a section is not read.
    """
    levels = distinct(np.array([level for slab in slabs for level in (slab.low, slab.high)]))
    worst, where = 0.0, ""
    for below, above in zip(levels[:-1].tolist(), levels[1:].tolist(), strict=True):
        if above - below <= 2.0 * tolerance:
            continue
        passing = [slab for slab in slabs if slab.low <= below and slab.high >= above]
        room = min(INSIDE * tolerance, 0.5 * (above - below))
        for height in (below + room, above - room):
            try:
                off = _off(mesh, height, passing, path)
            except ReadError as error:
                detail = f"{name}: {error.message}"
                return Check("outline", ok=False, value=None, limit=tolerance, unit="mm", detail=detail)
            if off > worst:
                worst, where = off, f" at z = {length_words(height)} {UNIT}"
    return at_most("outline", worst, tolerance, "mm", detail=f"{name}{where}", slack=ROUNDING)


def _off(mesh: Mesh, height: float, slabs: Sequence[Slab], path: Path) -> float:
    """Greatest distance, mm, between the edge of the section at a height and the edge of the union of these slabs.

    It is taken at the section's corners and the middles of its edges, and at the slabs' corners. Of a single slab it is
    no less than the difference of the areas over the length of the slab's edges. It is inf where the section or the
    union is empty.
    """
    outline = section(mesh, height)
    loops = [outline.points[ring] for ring in rings(outline, path)]
    if not loops or not slabs:
        return np.inf
    middles = [0.5 * (loop + np.roll(loop, -1, axis=0)) for loop in loops]
    off = float(np.abs(_signed(slabs, np.concatenate(loops + middles))).max())
    drawn = [Contour.from_vertices(loop) for loop in loops]
    for slab in slabs:
        points = np.concatenate([edge.vertices for edge in (slab.outer, *slab.holes)])
        others = [other for other in slabs if other is not slab]
        if others:  # corners that lie in another slab, or on its edge, need not lie on the edge of the body
            points = points[_signed(others, points) > ROUNDING]
        if len(points):
            off = max(off, float(np.min([contour.distance(points) for contour in drawn], axis=0).max()))
    if len(slabs) == 1:
        edges = (slabs[0].outer, *slabs[0].holes)
        area = abs(slabs[0].outer.area) - sum(abs(hole.area) for hole in slabs[0].holes)
        off = max(off, abs(sum(contour.area for contour in drawn) - area) / sum(edge.length for edge in edges))
    return off


def _signed(slabs: Sequence[Slab], points: Array) -> Array:
    """Distance (n,), mm, of points (n, 2) from the union of slabs, negative inside it.

    Inside the union a point may lie deeper than this, where slabs meet or overlap.
    """
    distances: Array = np.min([slab.region.signed(points) for slab in slabs], axis=0)
    return distances
