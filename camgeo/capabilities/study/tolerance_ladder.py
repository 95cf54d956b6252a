"""A ladder of tolerances for each output form: error of the file read back, run time, pieces and bytes.

Each rung writes a file into a private folder and judges it there, as an export does, then repeats the work to time it
warm: the exact curve and its bounds are made once, as stages of the design. A ladder ends where the form cannot hold
the tolerance, with the reason and what can be held, or at a run (fit, write and judge) that is too long.
"""

from __future__ import annotations

import math
import statistics
import time
from typing import TYPE_CHECKING

from camgeo.capabilities.study.least_pieces import least_pieces
from camgeo.output.dispatch import make
from camgeo.output.job import Job
from camgeo.recipe.export import FileRequest
from camgeo.schema.errors import RecipeErrors
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from pathlib import Path

    from camgeo.measures.file_result import FileResult
    from camgeo.recipe.recipe import Recipe
    from camgeo.synthesis.design import Design

FIRST_EXPONENT, LAST_EXPONENT = -1, -12  # of ten: the rungs, in the recipe's unit
REPEATS = 5
QUICK = 0.3  # seconds: longer runs are repeated twice only, and runs above SLOW once, as the first run is cold
SLOW = 2.0


@dataclass(frozen=True)
class Rung:
    """Figures of one form at one tolerance; lengths in mm.

    geometry_error  two-sided distance of the file's contour from the exact one, as the judge measured it; None for a
                    file that cannot be read
    proved          bound of that distance which the fit proved
    motion_error    greatest error of the follower by contact, in `motion_unit`
    output_error    greatest error of a linkage's output, in `output_unit`; None without one
    seconds         sum of `stages`, the seconds of fit, write and judge, each the median of the repeats
    least_pieces    least number of pieces by theory
    failed          names of the checks on the file that fail
    """

    form: str
    tolerance: float
    geometry_error: float | None
    proved: float
    motion_error: float | None
    motion_unit: str
    output_error: float | None
    output_unit: str
    seconds: float
    stages: dict[str, float]
    pieces: int
    least_pieces: float
    bytes: int
    failed: tuple[str, ...]

    @property
    def ok(self) -> bool:
        """Whether every check on the file holds."""
        return not self.failed

    @property
    def ratio(self) -> float:
        """Pieces over the least number by theory."""
        return self.pieces / self.least_pieces


@dataclass(frozen=True)
class End:
    """End of a form's ladder: at which tolerance, mm, and why."""

    form: str
    tolerance: float
    why: str


def climb(
    recipe: Recipe,
    design: Design,
    form: str,
    folder: Path,
    *,
    patience: float,
    listener: Callable[[str], None] | None = None,
) -> Iterator[Rung | End]:
    """Rungs of one form from a tenth of the recipe's unit downward, then the end of the ladder.

    Files are written into `folder`, one over the other; `patience` is the longest run in seconds; `listener` is called
    with the form and tolerance of each rung before it begins. Iterating raises KeyError for an unknown form, ValueError
    for a design without a contour.
    """
    # each rung a power of ten lower, until a file is refused or a run takes too long
    for exponent in range(FIRST_EXPONENT, LAST_EXPONENT - 1, -1):
        tolerance = 10.0**exponent * recipe.mm
        if listener is not None:
            listener(f"{form} within {10.0**exponent:.0e}")
        try:
            rung = _rung(recipe, design, form, tolerance, folder)
        except RecipeErrors as errors:
            yield End(form, tolerance, "; ".join(error.problem for error in errors.errors))
            return
        yield rung
        if rung.seconds > patience:
            why = f"fit, write and judge took {rung.seconds:.3g} s, longer than {patience:.3g} s"
            yield End(form, tolerance / 10.0, why)
            return
    yield End(form, 10.0 ** (LAST_EXPONENT - 1) * recipe.mm, "the ladder's last rung")


def _rung(recipe: Recipe, design: Design, form: str, tolerance: float, folder: Path) -> Rung:
    kind, word = ("stl", None) if form == "stl" else ("dxf", form)
    request = FileRequest(kind, as_=word, tolerance=tolerance)
    path = folder / f"{form}.{request.kind}"
    begun = time.perf_counter()
    files, _, failed = _run_once(recipe, design, request, path)
    first_run = time.perf_counter() - begun
    # warm runs are timed, fewer the longer the first took
    repeats = REPEATS if first_run < QUICK else 2 if first_run < SLOW else 1
    runs = [_run_once(recipe, design, request, path)[1] for _ in range(repeats)]
    medians = {name: statistics.median(run[name] for run in runs) for name in runs[0]}
    motion = max((file.motion for file in files if file.motion is not None), key=lambda error: error.max, default=None)
    output = next((file.linkage.error for file in files if file.linkage is not None), None)
    measured = [file.measured_error for file in files if file.measured_error is not None]
    return Rung(
        form=form,
        tolerance=tolerance,
        geometry_error=max(measured, default=None),
        proved=max(file.bound.worst for file in files if file.bound is not None),
        motion_error=None if motion is None else motion.max,
        motion_unit="" if motion is None else motion.unit,
        output_error=None if output is None else output.max,
        output_unit="" if output is None else output.unit,
        seconds=math.fsum(medians.values()),
        stages=medians,
        pieces=sum(file.pieces or 0 for file in files),
        least_pieces=sum(least_pieces(form, contour, tolerance) for _, contour in design.contours),
        bytes=sum(file.path.stat().st_size for file in files),
        failed=failed,
    )


def _run_once(
    recipe: Recipe, design: Design, request: FileRequest, path: Path
) -> tuple[tuple[FileResult, ...], dict[str, float], tuple[str, ...]]:
    """Fit, write and judge once: a result for each file, the seconds of each stage, names of the checks that fail."""
    recipe = replace(recipe, export=replace(recipe.export, files=(request,)))
    job = Job.of(recipe, design)
    files, checks = make(job, request, path)
    stages = dict.fromkeys(("fit", "write", "judge"), 0.0)
    for name, seconds in job.clock.stages:
        step = name.split()[0]
        stages["write" if step == "mesh" else step] += seconds  # meshing is part of writing a solid
    return tuple(files), stages, tuple(check.name for check in checks if not check.ok)
