"""The path of a round cutter's centre about a contour, and the metal that it does not reach (docs/manufacture.md).

The path is the contour's parallel on the side without metal, exact in the moving frame: outside a disc, inside the
opening of a ring. Whether the cutter reaches everything is the question whether a roller of its radius undercuts, with
the contour for its pitch curve (of a disc run through the other way): the same proofs decide it, of the bends of hollow
stretches and of the gaps between far-apart ones.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from camgeo.curve.backwards import Backwards, runs_backwards
from camgeo.curve.curve import Curve, Run
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
    """The path of a cutter's centre, counter-clockwise.

    `curve` is the contour's parallel, in runs that meet where something is not reached; `corners` says that they are
    those of a trimmed contour instead, about whose corners the cutter swings. `lost` says what is not reached, by the
    contour's own parameters.
    """

    curve: Curve
    radius: float
    corners: bool = False
    lost: tuple[Undercut, ...] = ()

    def within(self, tolerance: float, fitted: Fit = fit_arcs) -> ArcSpline:
        """Arcs within `tolerance` mm of the path, as `fitted` makes them of a curve; raises as that does."""
        if not self.corners:
            return fitted(self.curve, tolerance)
        fits = [fitted(Curve(self.curve.shape, (self._in_two(run),)), tolerance) for run in self.curve.runs]
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

    def _in_two(self, run: Run) -> Run:
        """A run that is one circular arc in two halves: a chain of arcs has two at least."""
        if run.breaks or self.curve.radius((run.low, run.high)) is None:
            return run
        return replace(run, breaks=(0.5 * (run.low + run.high),))


def cutter_path(contour: Curve, radius: float) -> CutterPath:
    """Path of the centre of a cutter of `radius`, mm, about a contour, and what it does not reach.

    Raises UndercutError where no single path is left of it, CurveError where what is reached cannot be proved.
    """
    ring = in_ring(contour)
    inward = radius if ring else -radius
    beside = Parallel(contour.shape, inward)
    if isinstance(contour.shape, Parallel):  # one parallel in place of two: nothing is added up and taken off again
        beside = Parallel(contour.shape.base, contour.shape.distance + inward)
    if is_sharp(contour):  # about a corner the parallel is an arc
        return CutterPath(Curve.whole(beside), radius)
    whole = CutterPath(Curve(beside, contour.runs), radius, corners=not contour.closed)
    if no_hollow(contour) or radius <= rolled_by(contour):
        return whole
    if not contour.closed:
        across = 2.0 * rolled_by(contour)
        raise UndercutError(f"a trimmed contour with hollows takes a cutter no wider than its roller, {across:.6g} mm")
    turned = Curve.whole(Parallel(contour.shape if ring else Backwards(contour.shape), radius))
    why = causes(turned)
    if why.none:
        return whole
    from camgeo.curve.undercut.trim import kept_runs, remains
    from camgeo.curve.undercut.undercut import stretches

    what = remains(turned, why)
    lost = stretches(turned, why, what)
    lost = lost if ring else tuple(_forward(cut) for cut in lost)
    if not what.corners:
        raise UndercutError("the cutter comes to no place of the contour")
    if what.pieces > 1:
        raise UndercutError("the cutter does not come through to all of the contour", lost[0].at)
    kept = kept_runs(turned, what)
    return CutterPath(Curve(beside, tuple(kept) if ring else runs_backwards(kept)), radius, lost=lost)


def no_hollow(contour: Curve) -> bool:
    """Whether the metal is proved to have no hollow: a disc's contour turns left throughout, no ring's opening does."""
    return not in_ring(contour) and bool((contour.cells.rows[2] >= 0.0).all())


def rolled_by(contour: Curve) -> float:
    """Radius of the roller that has touched all of a contour, mm; 0 for that of a flat face."""
    return abs(contour.shape.distance) if isinstance(contour.shape, Parallel) else 0.0


def _forward(cut: Undercut) -> Undercut:
    """What was found running backwards, in the contour's own parameters."""
    return replace(cut, start=-cut.end, end=-cut.start, at=-cut.at)
