"""A contour corrected for what a machine makes of it: the exact contour less a share of the metal measured too much.

Each run of parts was made from the contour that the runs before it had corrected, and is measured against the exact
one. Its deviation is what those corrections leave, so the fault of the machine is the sum over all runs. A correction
by the last run alone would undo the corrections before it.
"""

from __future__ import annotations

from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from camgeo.cams.family import AlteredCam
from camgeo.capabilities.made.keys import POINTS_PATH, Made, files_of_run
from camgeo.capabilities.made.options import Probing
from camgeo.capabilities.made.part_points import demand_points, part_points, read_tables
from camgeo.capabilities.made.refusal import refused_at
from camgeo.common.errors import CallError
from camgeo.common.rounding import downward
from camgeo.curve.curve import Curve
from camgeo.curve.moved import AlongNormals, BySupport, PeriodicPolynomials
from camgeo.curve.parallel import Parallel
from kin.made.corrected import Corrected
from kin.made.smooth import POINTS_A_SPAN, Smooth, fit
from kin.numeric.angles import degrees
from kin.numeric.feet import equal_steps
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from camgeo.cams.family import ExactCam
    from camgeo.cams.surface import Surface
    from camgeo.capabilities.made.keys import Run
    from camgeo.recipe.recipe import Recipe
    from camgeo.synthesis.design import Design
    from kin.follower.base import Follower as Gauge
    from kin.made.points import Deviations


BELOW = 0.9  # of the greatest share that is within reach to first order
LOOKS = 1440  # places round a contour at which curves are looked at


@dataclass(frozen=True, eq=False)
class RunMade:
    """Result of a run of parts: the number of points on each surface, by its name, and its smoothed deviation.

    `curves` are the means of the files' deviations; they are on the same spans in all runs, so that they can be added.
    `error` is the greatest stated for its files, expanded (k = 2), mm: it is common to all points and does not average.
    `scatter` is the standard deviation of the files' curves about their mean, mm, all round; None for a single file.
    """

    files: tuple[str, ...]
    points: Mapping[str, int]
    curves: Mapping[str, Smooth]
    scatter: Mapping[str, float | None]
    error: float


class _FilePoints(NamedTuple):
    """Deviations of the points in a file of a run, by surface; `place` is that of the file in the recipe."""

    recipe: Recipe
    place: str
    name: str
    deviations: Mapping[str, Deviations]

    def smooth(self, surface: str, spans: int | None = None) -> Smooth:
        """Smoothed deviation of a surface over a number of spans; raises RecipeErrors where the points leave a gap."""
        points = self.deviations[surface]
        with refused_at(self.recipe, self.place, self.name):
            return fit(points.parameter, points.e, spans).curve


def runs_made(recipe: Recipe, design: Design) -> list[RunMade]:
    """Smoothed deviations of all runs of a recipe, each against the exact contour.

    Raises RecipeErrors at the file's place in the recipe for points that are none of this part or leave a gap.
    """
    made = recipe.of(Made)
    listed = () if made is None else made.points
    runs = [_files(recipe, design, run, f"{POINTS_PATH}[{i}]") for i, run in enumerate(listed)]
    every = [file for run in runs for file in run]
    spans = {surface.name: _spans(surface.name, every) for surface in design.exact.surfaces}
    errors = [max(file.error or 0.0 for file in files) for files in listed]
    return [_run(run, spans, error) for run, error in zip(runs, errors, strict=True)]


def _run(files: Sequence[_FilePoints], spans: Mapping[str, int], error: float) -> RunMade:
    """Average the smoothed deviations of a run's files by surface; their scatter is None for a single file."""
    points, curves, scatter = {}, {}, {}
    for name, count in spans.items():
        own = [file for file in files if name in file.deviations]
        each = [file.smooth(name, count) for file in own]
        points[name] = sum(len(file.deviations[name].e) for file in own)
        curves[name] = Smooth.total(each).times(1.0 / len(own))
        scatter[name] = _scatter(each) if len(own) > 1 else None
    return RunMade(tuple(file.name for file in files), points, curves, scatter, error)


def _scatter(curves: Sequence[Smooth]) -> float:
    """Standard deviation of curves about their mean, all round, mm."""
    rows = np.stack([curve.rows(equal_steps(LOOKS))[0] for curve in curves])
    return float(np.sqrt(np.mean(np.var(rows, axis=0, ddof=1))))


def _spans(surface: str, files: Sequence[_FilePoints]) -> int:
    """Spans of a surface's curves: the most that any file calls for, and no more than each has points for."""
    own = [file for file in files if surface in file.deviations]
    return min(
        max(file.smooth(surface).spans for file in own),
        *(len(file.deviations[surface].e) // POINTS_A_SPAN for file in own),
    )


def _files(recipe: Recipe, design: Design, run: Run, place: str) -> list[_FilePoints]:
    """Points of the files of a run, each placed by itself; raises RecipeErrors where a disc has none."""
    files: list[_FilePoints] = []
    missing: list[str] = []
    for rank, (below, file) in enumerate(files_of_run(run, place)):
        path = Path(recipe.path).parent / file.file
        with refused_at(recipe, below, file.file, path):
            probing = Probing(file.align, file.ball, file.face, file.units)
            points = part_points(recipe, design, read_tables([path]), probing, rank)
        deviations = {surface.intent.name: surface.deviations for disc in points.discs for surface in disc.surfaces}
        files.append(_FilePoints(recipe, below, file.file, deviations))
        missing = [name for name in points.missing if rank == 0 or name in missing]
    with refused_at(recipe, place):
        demand_points(missing)
    return files


def total_deviations(runs: Sequence[RunMade]) -> dict[str, Smooth]:
    """Sum over all runs of the smoothed deviation of each surface, by its name, mm."""
    return {name: Smooth.total([run.curves[name] for run in runs]) for name in runs[0].curves}


@dataclass(frozen=True, eq=False)
class CorrectedCam(AlteredCam):
    """An exact cam whose surfaces lie at smooth deviations from the nominal ones, above 0 for metal too much, mm."""

    deviations: Mapping[str, Smooth]

    @property
    def surfaces(self) -> tuple[Surface, ...]:
        """The corrected surfaces."""
        return tuple(self._corrected(surface) for surface in self.nominal.surfaces)

    def _corrected(self, surface: Surface) -> Surface:
        by = PeriodicPolynomials(surface.side * self.deviations[surface.name].pieces)
        if not self.follower.contacts[0].touch.centred:
            return replace(surface, curve=Curve.whole(BySupport(surface.curve.shape, by)))
        pitch = AlongNormals(surface.base.shape, by)
        return replace(surface, curve=Curve.whole(Parallel(pitch, surface.side * surface.radius)))

    @cached_property
    def on_metal(self) -> dict[str, Corrected]:
        """Gauges of the follower on metal that lies at the deviations, by surface."""
        sides = {surface.name: surface.side for surface in self.nominal.surfaces}
        gauges = self.nominal.gauges.items()
        return {name: Corrected.of(gauge, sides[name], self.deviations[name]) for name, gauge in gauges}

    @cached_property
    def gauges(self) -> dict[str, Gauge]:
        """Gauges by which kin judges the corrected surfaces, by surface."""
        return dict(self.on_metal)

    @cached_property
    def running(self) -> dict[str, Gauge]:
        """Gauges of the follower itself on the corrected surfaces, by surface, where `gauges` are wider."""
        return {name: self.on_metal[name].run_by(follower) for name, follower in self.nominal.running.items()}

    def grow(self, out: float, scale: float) -> ExactCam:
        """The nominal cam grown by `out` mm and scaled, with deviations scaled by the same factor."""
        curves = {name: curve.times(scale) for name, curve in self.deviations.items()}
        return CorrectedCam(self.nominal.grow(out, scale), curves)


def corrected(recipe: Recipe, design: Design, exact: ExactCam, share: float, scale: float) -> ExactCam:
    """A cam less a share of what the runs of a recipe show too much, drawn at a scale.

    Raises CallError where there are sharp corners, or the follower would not reach into a hollow.
    """
    if not all(surface.curve.closed for surface in exact.surfaces):
        raise CallError(
            "a contour with sharp corners is not corrected: give `reuleaux.rounding`, or leave `correct` out"
        )
    totals = total_deviations(runs_made(recipe, design))
    curves = {name: total.times(-share * scale) for name, total in totals.items()}
    cam = CorrectedCam(exact, curves)
    for name, follower in cam.on_metal.items():
        reach, where = follower.within_reach()
        if not reach > 1.0:
            place = f"{degrees(where):.6g} degrees" + (f" of the {name}" if name else "")
            remedy = f"give {downward(BELOW * reach * share, 3)} or less, or smooth what was measured over more points"
            raise CallError(f"the corrected contour turns back at {place}, where the follower does not reach: {remedy}")
    return cam
