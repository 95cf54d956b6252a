"""The path of a round cutter's centre about a contour, and the metal that it does not reach (docs/manufacture.md).

The path is the contour's parallel on the side without metal, exact in the moving frame: outside a disc, inside the
opening of a ring. The cutter reaches all metal if a roller of its radius does not undercut with the contour for its
pitch curve, which for a disc is run through the other way. The same proofs decide: by the curvature of hollow
stretches, and by the width of necks between stretches that lie far apart along the contour.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from camgeo.curve.backwards import Backwards, runs_backwards
from camgeo.curve.curve import Curve, SmoothRun
from camgeo.curve.parallel import Parallel
from camgeo.curve.support import is_sharp
from camgeo.curve.undercut.causes import UndercutError, causes, in_ring
from camgeo.fit.arcs import fit_arcs
from camgeo.fit.bound import Bound
from camgeo.fit.pieces import ArcSpline
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from collections.abc import Callable

    from camgeo.curve.undercut.undercut import Undercut

    Fit = Callable[[Curve, float], ArcSpline]


@dataclass(frozen=True)
class CutterPath:
    """The path of a cutter's centre, counter-clockwise; `radius` is the cutter's, mm.

    `curve` is the contour's parallel, in runs that meet where metal is not reached. With `corners` it has the runs of a
    trimmed contour instead, about whose corners the cutter swings. `lost` are the stretches that are not reached, by
    the parameters of the contour.
    """

    curve: Curve
    radius: float
    corners: bool = False
    lost: tuple[Undercut, ...] = ()

    def arcs(self, tolerance: float, fit_curve: Fit = fit_arcs) -> ArcSpline:
        """Arcs within `tolerance`, mm, of the path; `fit_curve` fits a curve within a tolerance.

        Raises CurveError where it fits none, as where part of the path shrinks to a point.
        """
        if not self.corners:
            return fit_curve(self.curve, tolerance)
        # each run is fitted by itself; an arc about each corner leads from its end to the next one's begin
        fits = [fit_curve(Curve(self.curve.shape, (self._in_two(run),)), tolerance) for run in self.curve.runs]
        run_ends = np.array([run.high for run in self.curve.runs])
        leave = self.curve.sample(run_ends, -1)
        enter = self.curve.sample(np.array([run.low for run in self.curve.runs]))
        after = np.roll(enter.tangent, -1, axis=0)
        cosine = np.sum(leave.tangent * after, axis=1)
        sine = leave.tangent[:, 0] * after[:, 1] - leave.tangent[:, 1] * after[:, 0]
        bulges = np.tan(0.25 * np.arctan2(sine, cosine))
        points = [row for fit, end in zip(fits, leave.point, strict=True) for row in (fit.points, end[None])]
        turns = [row for fit, bulge in zip(fits, bulges, strict=True) for row in (fit.bulges, np.array([bulge]))]
        bound = Bound(max(fit.bound.outward for fit in fits), max(fit.bound.inward for fit in fits))
        return ArcSpline(np.concatenate(points), np.concatenate(turns), bound)

    def _in_two(self, run: SmoothRun) -> SmoothRun:
        """The run; a circular arc is broken in its middle, as a chain has at least two arcs."""
        if run.breaks or self.curve.radius((run.low, run.high)) is None:
            return run
        return replace(run, breaks=(0.5 * (run.low + run.high),))


def cutter_path(contour: Curve, radius: float) -> CutterPath:
    """Path of the centre of a cutter of `radius`, mm, about a contour, with the stretches that it does not reach.

    Raises UndercutError where the path is nowhere on the contour's parallel or falls into pieces, and for a trimmed
    contour with hollows whose roller is smaller than the cutter; CurveError where it cannot be proved what is reached.
    """
    ring = in_ring(contour)
    inward = radius if ring else -radius
    beside = Parallel(contour.shape, inward)
    if isinstance(contour.shape, Parallel):  # one parallel in place of two, without rounding of their distances
        beside = Parallel(contour.shape.base, contour.shape.distance + inward)
    if is_sharp(contour):  # about a corner the parallel is an arc
        return CutterPath(Curve.whole(beside), radius)
    whole = CutterPath(Curve(beside, contour.runs), radius, corners=not contour.closed)
    if no_hollow(contour) or radius <= roller_radius(contour):
        return whole
    if not contour.closed:
        across = 2.0 * roller_radius(contour)
        raise UndercutError(f"a trimmed contour with hollows takes a cutter no wider than its roller, {across:.6g} mm")
    pitch = Curve.whole(Parallel(contour.shape if ring else Backwards(contour.shape), radius))
    undercut = causes(pitch)
    if undercut.none:
        return whole
    from camgeo.curve.undercut.trim import kept_runs, remains
    from camgeo.curve.undercut.undercut import stretches

    remainder = remains(pitch, undercut)
    lost = stretches(pitch, undercut, remainder)
    if not ring:  # back to the contour's own parameters
        lost = tuple(replace(cut, start=-cut.end, end=-cut.start, at=-cut.at) for cut in lost)
    if not remainder.corners:
        raise UndercutError("the cutter comes to no place of the contour")
    if remainder.pieces > 1:
        raise UndercutError("the cutter does not come through to all of the contour", lost[0].at)
    kept = kept_runs(pitch, remainder)
    return CutterPath(Curve(beside, tuple(kept) if ring else runs_backwards(kept)), radius, lost=lost)


def no_hollow(contour: Curve) -> bool:
    """Whether the metal is proved to have no hollow: where a disc's contour nowhere turns right; never for a ring."""
    return not in_ring(contour) and bool((contour.cells.rows[2] >= 0.0).all())


def roller_radius(contour: Curve) -> float:
    """Radius of the roller that runs on the contour, mm; 0 for the contour of a flat face."""
    return abs(contour.shape.distance) if isinstance(contour.shape, Parallel) else 0.0
