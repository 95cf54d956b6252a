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
from camgeo.capabilities.made.keys import LOCAL, POINTS_PATH, TAKE, Made, files_of_run
from camgeo.capabilities.made.options import Probing
from camgeo.capabilities.made.part_points import demand_points, part_points, read_tables
from camgeo.capabilities.made.refusal import refused_at
from camgeo.capabilities.made.run_faults import counted
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
    from camgeo.capabilities.made.run_faults import CountedRun
    from camgeo.recipe.machining import Altered
    from camgeo.recipe.recipe import Recipe
    from camgeo.synthesis.design import Design
    from kin.follower.base import Follower as Gauge
    from kin.made.points import Deviations
    from kin.made.smooth import SmoothFit


BELOW = 0.9  # of the greatest share to first order: a margin
LOOKS = 1440  # places round a contour at which curves are evaluated


@dataclass(frozen=True, eq=False)
class RunMade:
    """Result of a run of parts, from its `files`; the mappings are by the name of the surface.

    `points` is the number of points. `curves` are the smoothed deviations, means over the files, mm; they have the same
    spans in all runs, so that they can be added. `scatter` is the standard deviation of the files' curves about their
    mean, mm, root mean square all round; None for a single file. `error` is the greatest expanded uncertainty (k = 2)
    of a point that the files state, mm, 0 without; it is common to all points and does not average. `counted` is what
    counts of the run for a correction that leaves local faults of a single run out, and these faults.
    """

    files: tuple[str, ...]
    points: Mapping[str, int]
    curves: Mapping[str, Smooth]
    scatter: Mapping[str, float | None]
    error: float
    counted: Mapping[str, CountedRun]


class _FilePoints(NamedTuple):
    """Deviations of the points in a file, by surface name; `place` is the path of its entry in the recipe."""

    recipe: Recipe
    place: str
    name: str
    deviations: Mapping[str, Deviations]

    def smooth(self, surface: str, spans: int | None = None) -> SmoothFit:
        """Curve of a surface's smoothed deviation, mm, on a number of spans, by default that of cross-validation.

        Raises RecipeErrors where the points are too few for it or leave a gap.
        """
        points = self.deviations[surface]
        with refused_at(self.recipe, self.place, self.name):
            return fit(points.parameter, points.e, spans)


def runs_made(recipe: Recipe, design: Design) -> list[RunMade]:
    """Smoothed deviations of all runs of a recipe, each against the exact contour; empty without `made.points`.

    Raises RecipeErrors, at the file's entry in the recipe, for files without points, for points that are not of this
    part, are too few or leave a gap, and for a disc without points.
    """
    made = recipe.of(Made)
    listed = () if made is None else made.points
    runs = [_files(recipe, design, run, f"{POINTS_PATH}[{i}]") for i, run in enumerate(listed)]
    every = [file for run in runs for file in run]
    spans = {surface.name: _spans(surface.name, every) for surface in design.exact.surfaces}
    errors = [max(file.error or 0.0 for file in files) for files in listed]
    smoothed = {
        name: [[(file, file.smooth(name, count)) for file in run if name in file.deviations] for run in runs]
        for name, count in spans.items()
    }
    counts = {
        name: counted([[(file.deviations[name], fitted) for file, fitted in run] for run in own])
        for name, own in smoothed.items()
    }
    made_runs = []
    for k, (run, error) in enumerate(zip(runs, errors, strict=True)):
        curves = {name: [fitted.curve for _, fitted in own[k]] for name, own in smoothed.items()}
        made_runs.append(
            RunMade(
                tuple(file.name for file in run),
                {name: sum(len(file.deviations[name].e) for file, _ in own[k]) for name, own in smoothed.items()},
                {name: Smooth.total(own).times(1.0 / len(own)) for name, own in curves.items()},
                {name: _scatter(own) if len(own) > 1 else None for name, own in curves.items()},
                error,
                {name: own[k] for name, own in counts.items()},
            )
        )
    return made_runs


def _scatter(curves: Sequence[Smooth]) -> float:
    """Standard deviation of curves about their mean, root mean square all round, mm."""
    rows = np.stack([curve.rows(equal_steps(LOOKS))[0] for curve in curves])
    return float(np.sqrt(np.mean(np.var(rows, axis=0, ddof=1))))


def _spans(surface: str, files: Sequence[_FilePoints]) -> int:
    """Spans of a surface's curves: the most of any file by cross-validation, as far as all have the points."""
    own = [file for file in files if surface in file.deviations]
    return min(
        max(file.smooth(surface).curve.spans for file in own),
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


def total_deviations(runs: Sequence[RunMade], *, local: bool = False) -> dict[str, Smooth]:
    """Sum over at least one run of the smoothed deviation of each surface, by its name, mm.

    Local faults that a single run has are left out, with `local` taken.
    """
    return {
        name: Smooth.total([run.curves[name] if local else run.counted[name].curve for run in runs])
        for name in runs[0].curves
    }


@dataclass(frozen=True, eq=False)
class CorrectedCam(AlteredCam):
    """An exact cam whose surfaces lie off the nominal ones by smooth `deviations`.

    These are by the name of the surface, mm along the normal, above 0 for too much metal.
    """

    deviations: Mapping[str, Smooth]

    @property
    def surfaces(self) -> tuple[Surface, ...]:
        """The corrected surfaces."""
        return tuple(self._corrected(surface) for surface in self.nominal.surfaces)

    def _corrected(self, surface: Surface) -> Surface:
        """A surface moved by its deviation: its support function under a flat face, its pitch curve under others."""
        by = PeriodicPolynomials(surface.side * self.deviations[surface.name].pieces)
        if not self.follower.contacts[0].touch.centred:
            return replace(surface, curve=Curve.whole(BySupport(surface.curve.shape, by)))
        pitch = AlongNormals(surface.base.shape, by)
        return replace(surface, curve=Curve.whole(Parallel(pitch, surface.side * surface.radius)))

    @cached_property
    def on_metal(self) -> dict[str, Corrected]:
        """Followers on metal that is off by the deviations, by the name of the surface."""
        sides = {surface.name: surface.side for surface in self.nominal.surfaces}
        gauges = self.nominal.gauges.items()
        return {name: Corrected.of(gauge, sides[name], self.deviations[name]) for name, gauge in gauges}

    @cached_property
    def gauges(self) -> dict[str, Gauge]:
        """Followers by which kin judges the corrected surfaces, by the name of the surface."""
        return dict(self.on_metal)

    @cached_property
    def running(self) -> dict[str, Gauge]:
        """The real follower on the corrected surfaces, by name, where `gauges` are wider; empty where they are not."""
        return {name: self.on_metal[name].run_by(follower) for name, follower in self.nominal.running.items()}

    def grow(self, out: float, scale: float) -> ExactCam:
        """The cam grown by `out` mm and scaled, its deviations scaled by the same factor."""
        curves = {name: curve.times(scale) for name, curve in self.deviations.items()}
        return CorrectedCam(self.nominal.grow(out, scale), curves)


def takes_local(by: Altered) -> bool:
    """Whether a correction takes local faults of a single run off too."""
    return by.beside == (LOCAL.name, TAKE)


def corrected(recipe: Recipe, design: Design, exact: ExactCam, by: Altered, scale: float) -> ExactCam:
    """The cam `exact` less a share of the summed deviations of a recipe's runs, which are scaled as `exact` is.

    `by` has the share, and the word for the local faults of a single run. Raises CallError where there are sharp
    corners, or where the follower would not reach into a hollow; RecipeErrors for points of a run that are not of this
    part or cannot be smoothed.
    """
    if not all(surface.curve.closed for surface in exact.surfaces):
        raise CallError(
            "a contour with sharp corners is not corrected: give `reuleaux.rounding`, or leave `correct` out"
        )
    share, totals = by.value, total_deviations(runs_made(recipe, design), local=takes_local(by))
    curves = {name: total.times(-share * scale) for name, total in totals.items()}
    cam = CorrectedCam(exact, curves)
    for name, follower in cam.on_metal.items():
        reach, where = follower.within_reach()
        if not reach > 1.0:
            place = f"{degrees(where):.6g} degrees" + (f" of the {name}" if name else "")
            remedy = f"give {downward(BELOW * reach * share, 3)} or less, or smooth what was measured over more points"
            raise CallError(f"the corrected contour turns back at {place}, where the follower does not reach: {remedy}")
    return cam
