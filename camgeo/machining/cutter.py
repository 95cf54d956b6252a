"""The path of a round cutter's centre about a contour, and the metal that it does not reach (docs/manufacture.md).

The path is the contour's parallel outside, exact in the moving frame. Whether the cutter reaches everything is the
question whether a roller of its radius, with the contour for its pitch curve run through the other way, undercuts: the
same proofs decide it, of the bends of hollow stretches and of the gaps between far-apart ones.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from camgeo.curve.backwards import Backwards
from camgeo.curve.curve import Curve, Run
from camgeo.curve.parallel import Parallel
from camgeo.curve.support import is_sharp
from camgeo.curve.undercut.causes import UndercutError, causes
from camgeo.fit.arcs import fit_arcs
from camgeo.fit.bound import Bound
from camgeo.fit.pieces import ArcSpline

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
    outside = Parallel(contour.shape, -radius)
    if isinstance(contour.shape, Parallel):  # one parallel in place of two: nothing is added up and taken off again
        outside = Parallel(contour.shape.base, contour.shape.distance - radius)
    if is_sharp(contour):  # about a corner the parallel is an arc
        return CutterPath(Curve.whole(outside), radius)
    whole = CutterPath(Curve(outside, contour.runs), radius, corners=not contour.closed)
    if is_convex(contour) or radius <= rolled_by(contour):
        return whole
    if not contour.closed:
        across = 2.0 * rolled_by(contour)
        raise UndercutError(f"a trimmed contour with hollows takes a cutter no wider than its roller, {across:.6g} mm")
    turned = Curve.whole(Parallel(Backwards(contour.shape), radius))
    why = causes(turned)
    if why.none:
        return whole
    from camgeo.curve.undercut.trim import kept_runs, remains
    from camgeo.curve.undercut.undercut import stretches

    what = remains(turned, why)
    lost = tuple(_forward(cut) for cut in stretches(turned, why, what))
    if not what.corners:
        raise UndercutError("the cutter comes to no place of the contour")
    if what.pieces > 1:
        raise UndercutError("the cutter does not come through to all of the contour", lost[0].at)
    runs = tuple(
        Run(-run.high, -run.low, tuple(-b for b in reversed(run.breaks)), closed=False)
        for run in reversed(kept_runs(turned, what))
    )
    return CutterPath(Curve(outside, runs), radius, lost=lost)


def is_convex(contour: Curve) -> bool:
    """Whether a contour is proved to turn left throughout."""
    return bool((contour.cells.rows[2] >= 0.0).all())


def rolled_by(contour: Curve) -> float:
    """Radius of the roller that has touched all of a contour from outside, mm; 0 for that of a flat face."""
    return max(contour.shape.distance, 0.0) if isinstance(contour.shape, Parallel) else 0.0


def _forward(cut: Undercut) -> Undercut:
    """What was found running backwards, in the contour's own parameters."""
    return replace(cut, start=-cut.end, end=-cut.start, at=-cut.at)
