"""What every maker of files is given, and how its refusals become errors at a field of the recipe."""

from __future__ import annotations

from contextlib import contextmanager
from itertools import islice
from typing import TYPE_CHECKING, Any, NamedTuple

from camgeo.checks.declared import MOTION, RATIO
from camgeo.common.clock import Clock
from camgeo.common.errors import SurroundingsError
from camgeo.curve.curve import CurveError
from camgeo.files.errors import MissingExtraError, RegionError
from camgeo.fit.cache import Fits, formula_rounding
from camgeo.fit.nodes import ToleranceError
from camgeo.measures.file_result import FileResult
from camgeo.output.file_intent import intent_of_file, shaft_of_file
from camgeo.synthesis.intent import permitted
from kin.numeric.lengths import marked
from kin.numeric.records import dataclass, field, replace

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence
    from pathlib import Path

    from camgeo.fit.pieces import Bound, Outline
    from camgeo.part.body import Body
    from camgeo.recipe.export import FileRequest
    from camgeo.recipe.machining import Compensation
    from camgeo.recipe.recipe import Recipe
    from camgeo.schema.errors import RecipeErrors
    from camgeo.synthesis.design import Design
    from kin.judge.check import Check

STEEP = 0.999  # psi'(phi) from which a roller may run past a contour that is within its tolerance


class Made(NamedTuple):
    """The files of one request, and the verdicts on them."""

    files: tuple[FileResult, ...]
    checks: tuple[Check, ...] = ()


@dataclass(frozen=True)
class Job:
    """A cam that can be made: its recipe, its exact design, and the fits that its files share.

    `fits` are those of each surface's contour. `kept` holds what capabilities keep from one file to the next, by their
    names, `variants` the job for each part that is made different from the nominal one.
    """

    recipe: Recipe
    design: Design
    fits: tuple[Fits, ...]
    kept: dict[str, Any] = field(default_factory=dict, repr=False)
    variants: dict[Compensation, Job] = field(default_factory=dict, repr=False)

    @staticmethod
    def of(recipe: Recipe, design: Design, clock: Clock | None = None) -> Job:
        """Begin the files of a design that has its contours; raises ValueError for one that has none."""
        if not design.contours:
            raise ValueError(f"{recipe.name}: there is no contour to be made")
        clock, unsure = clock or Clock(), design.exact.rounding
        return Job(recipe, design, tuple(Fits(one, clock, formula_rounding(unsure, one)) for _, one in design.contours))

    def of_file(self, request: FileRequest) -> tuple[Job, tuple[Check, ...]]:
        """The job for the part as one file shows it, and the checks that forbid to make it."""
        by = request.compensation
        if by is None:
            return self, ()
        from camgeo.machining.compensation import compensate

        if by not in self.variants:
            try:
                with self.clock.stage("compensation"):
                    made = compensate(self.recipe, self.design, by, self.field(request))
            except CurveError as error:
                raise self.recipe.error(self.field(request), str(error)) from error
            if not made.design.contours:
                return self, made.checks
            pairs = zip(self.fits, made.design.contours, strict=True)
            fits = tuple(Fits(contour, self.clock, by.scale * fit.unsure) for fit, (_, contour) in pairs)
            self.variants[by] = Job(made.recipe, made.design, fits)
        job, told = self.variants[by], self.recipe.told_for(request)
        if request.units is not None:  # a file's title tells lengths as its numbers do
            job = replace(job, recipe=replace(job.recipe, name=f"{self.recipe.name}, {by.words(told.mm)}"))
        return job, ()

    @property
    def single(self) -> tuple[Job, ...]:
        """The job for each disc, as a file with that disc alone shows it."""
        fits = iter(self.fits)
        return tuple(
            replace(self, design=design, fits=tuple(islice(fits, len(design.surfaces))))
            for design in self.design.single
        )

    @property
    def clock(self) -> Clock:
        """What times the stages."""
        return self.fits[0].clock

    @property
    def body(self) -> Body:
        """What the disc has besides its surfaces, mirrored as the recipe has it: a round bore is its own image."""
        (disc,) = self.design.discs
        if disc.body is None:
            raise ValueError(f"{self.recipe.name}: there is no part to be made")
        return disc.body.mirrored() if self.recipe.rotation == "ccw" and not self.recipe.part.plain else disc.body

    def field(self, request: FileRequest) -> str:
        """Path of a request in the recipe; that of the list for one that does not stand there."""
        return self.recipe.field_of(request)

    def tolerance(self, request: FileRequest) -> float:
        """Tolerance of a file, mm: its own, or the export's."""
        return request.tolerance or self.recipe.export.tolerance

    def tolerance_field(self, request: FileRequest) -> str:
        """Path of the field that a file's tolerance is asked for by."""
        return self.field(request) if request.tolerance is not None else "export.tolerance"

    def outlines(self, form: str, tolerance: float) -> tuple[Outline, ...]:
        """The contour of each surface in a form, within a tolerance, mirrored as the recipe has it."""
        return tuple(self._outline(fit, form, tolerance) for fit in self.fits)

    def outlines_written(self, form: str, tolerance: float, off: Callable[[Outline], float]) -> tuple[Outline, ...]:
        """The same of forms that are within a tolerance as they are written, which moves each by up to `off`, mm.

        Raises ToleranceError as the fit does.
        """
        written = []
        for fit in self.fits:
            outline = self._outline(fit, form, tolerance)
            moved = off(outline)
            if outline.bound.worst + moved > tolerance and 4.0 * moved < tolerance:
                outline = self._outline(fit, form, tolerance - 2.0 * moved)
            written.append(outline)
        return tuple(written)

    def _outline(self, fit: Fits, form: str, tolerance: float) -> Outline:
        outline = fit.within(form, tolerance)
        return outline.mirrored() if self.recipe.rotation == "ccw" else outline

    @contextmanager
    def refusals(self, request: FileRequest) -> Iterator[None]:
        """Turn what a fit or a writer raises into RecipeErrors at the field to blame, or SurroundingsError."""
        recipe = self.recipe
        try:
            yield
        except ToleranceError as error:
            raise self.refused(request, error) from error
        except RegionError as error:
            where = "part" if not recipe.part.plain else "cam" if recipe.part.bore is None else "part.bore"
            raise recipe.error(where, f"within the tolerance, {error}") from error
        except CurveError as error:
            raise recipe.error("cam", str(error)) from error
        except MissingExtraError as error:
            raise SurroundingsError(str(error), recipe.path) from error

    def refused(self, request: FileRequest, error: ToleranceError) -> RecipeErrors:
        """Turn a tolerance that cannot be held into an error at the field that asks for it."""
        where, recipe = self.tolerance_field(request), self.recipe
        reached = f"{error.reached:.3g} mm are {error.reached / recipe.mm:.3g} in" if recipe.units == "inch" else ""
        return recipe.error(where, str(error), None, reached)

    def judged(self, request: FileRequest, path: Path, bound: Bound, pieces: int) -> Made:
        """Read a file back and hold it against the recipe's motion."""
        from kin.judge.verify import verify

        recipe, tolerance = self.recipe, self.tolerance(request)
        told = recipe.told_for(request)
        meant = intent_of_file(told, self.design, request.kind)
        units = None if request.format.units else told.mm
        with self.clock.stage(f"judge {request.kind}"):
            verdict = verify(path, meant, recipe.verify.angles, permitted(recipe, tolerance), units)
        file = FileResult.of(path, request, tolerance, verdict, (pieces, bound))
        return Made((file,), tuple(self._why_lost(check) for check in verdict.checks))

    def judged_together(self, request: FileRequest, path: Path, bound: Bound, pieces: int) -> Made:
        """Read back a file of several discs, each in its place, and hold it against the recipe's motion."""
        from kin.judge.together import DiscFile, verify_set

        recipe, tolerance = self.recipe, self.tolerance(request)
        meant = shaft_of_file(recipe.told_for(request), self.design, request.kind)
        with self.clock.stage(f"judge {request.kind}"):
            (verdict,) = verify_set([DiscFile(path, None)], meant, recipe.verify.angles, permitted(recipe, tolerance))
        file = FileResult.of(path, request, tolerance, verdict, (pieces, bound))
        return Made((file,), tuple(self._why_lost(check) for check in verdict.checks))

    def closed(self, request: FileRequest, products: Sequence[Made]) -> Made:
        """Put together what was made of each disc, and judge what is left between them."""
        from kin.judge.together import DiscsRead, left_between

        files = [replace(file, disc=rank) for rank, each in enumerate(products) for file in each.files]
        checks = [check for each in products for check in each.checks]
        if not files:
            return Made((), tuple(checks))
        limits = permitted(self.recipe, self.tolerance(request))
        with self.clock.stage(f"judge {request.kind}"):
            read = [DiscsRead(file.path.name, file.surfaces, file.uneven) for file in files]
            closures, more = left_between(read, shaft_of_file(self.recipe, self.design, request.kind), limits)
        files[-1] = replace(files[-1], closures=closures)
        return Made(tuple(files), (*checks, *more))

    def _why_lost(self, check: Check) -> Check:
        """Say why a roller may miss a file's contour, where the cam itself can hardly be turned through."""
        if check.name != MOTION.name or check.value is not None:
            return check
        slope = next((own.value for own in self.design.checks if own.name == RATIO.name), None)
        if slope is None or slope < STEEP:
            return check
        less = self.recipe.cam.advice.less_swing(self.recipe.mm)
        why = f"psi'(phi) reaches {slope:.9g}, so the follower moves almost along the contour; {less} would satisfy it"
        return replace(check, detail=f"{marked(check.detail)}: {why}")


def looked_at(path: Path, request: FileRequest, units: float) -> Made:
    """Give a file that is to look at, or a table, which nothing judges; `units` is that of its numbers, mm."""
    return Made((FileResult(path, request, units=units),))
