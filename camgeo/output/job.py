"""Job from which files are made: recipe, design and fits; refusals become errors at a field of the recipe."""

from __future__ import annotations

from contextlib import contextmanager
from itertools import islice
from typing import TYPE_CHECKING, Any, NamedTuple

from camgeo.checks.declared import MOTION, RATIO
from camgeo.common.clock import Clock
from camgeo.common.errors import SurroundingsError
from camgeo.common.rounding import upward
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
    from kin.numeric.check import Check

STEEP = 0.999  # psi'(phi), 1 for a follower that moves along the contour: the roller may miss one within tolerance


class MadeFiles(NamedTuple):
    """Files of one request, and the checks on them."""

    files: tuple[FileResult, ...]
    checks: tuple[Check, ...] = ()


@dataclass(frozen=True)
class Job:
    """A cam that can be made: its recipe, its exact design, and the fits that its files share.

    `fits` holds one entry for the contour of each surface, in the order of the design. `kept` holds values that
    capabilities reuse from file to file, by name; `variants` the job of each altered part, by its compensation.
    """

    recipe: Recipe
    design: Design
    fits: tuple[Fits, ...]
    kept: dict[str, Any] = field(default_factory=dict, repr=False)
    variants: dict[Compensation, Job] = field(default_factory=dict, repr=False)

    @staticmethod
    def of(recipe: Recipe, design: Design, clock: Clock | None = None) -> Job:
        """Job for the files of a design, timed by `clock`; raises ValueError for a design without contours."""
        if not design.contours:
            raise ValueError(f"{recipe.name}: there is no contour to be made")
        clock, rounding = clock or Clock(), design.exact.rounding
        return Job(
            recipe,
            design,
            tuple(Fits(contour, clock, formula_rounding(rounding, contour)) for _, contour in design.contours),
        )

    def of_file(self, request: FileRequest) -> tuple[Job, tuple[Check, ...]]:
        """Job for the part as one file shows it, altered by the file's compensation; no checks.

        Where the altered contour fails a check, this same job comes back, and the checks. Raises RecipeErrors where the
        compensation leaves nothing of a roller or of an opening, or the altered contour cannot be made or proved.
        """
        compensation = request.compensation
        if compensation is None:
            return self, ()
        from camgeo.machining.compensation import compensate

        if compensation not in self.variants:
            try:
                with self.clock.stage("compensation"):
                    compensated = compensate(self.recipe, self.design, compensation, self.field(request))
            except CurveError as error:
                raise self.recipe.error(self.field(request), str(error)) from error
            if not compensated.design.contours:
                return self, compensated.checks
            pairs = zip(self.fits, compensated.design.contours, strict=True)
            fits = tuple(Fits(contour, self.clock, compensation.scale * fit.unsure) for fit, (_, contour) in pairs)
            self.variants[compensation] = Job(compensated.recipe, compensated.design, fits)
        job, file_recipe = self.variants[compensation], self.recipe.in_units_of(request)
        if request.units is not None:  # the title of a file has lengths in the unit of its numbers
            job = replace(
                job, recipe=replace(job.recipe, name=f"{self.recipe.name}, {compensation.words(file_recipe.mm)}")
            )
        return job, ()

    @property
    def single(self) -> tuple[Job, ...]:
        """Jobs of the discs in their order, each with that disc's design and fits alone."""
        fits = iter(self.fits)
        return tuple(
            replace(self, design=design, fits=tuple(islice(fits, len(design.surfaces))))
            for design in self.design.single
        )

    @property
    def clock(self) -> Clock:
        """Clock that counts the seconds of the run's stages."""
        return self.fits[0].clock

    @property
    def body(self) -> Body:
        """Body of the one disc, mirrored for a counter-clockwise shaft unless the part is plain.

        Raises ValueError for a cam of several discs, and where a failed check prevents the body.
        """
        (disc,) = self.design.discs
        if disc.body is None:
            raise ValueError(f"{self.recipe.name}: there is no part to be made")
        return disc.body.mirrored() if self.recipe.rotation == "ccw" and not self.recipe.part.plain else disc.body

    def field(self, request: FileRequest) -> str:
        """Path of a request in the recipe; the path of the list for a request that the recipe does not have."""
        return self.recipe.field_of(request)

    def tolerance(self, request: FileRequest) -> float:
        """Tolerance of a file, mm: that of the request, or else of the recipe's `export`."""
        return self.recipe.tolerance(request)

    def tolerance_field(self, request: FileRequest) -> str:
        """Path of the field that sets a file's tolerance."""
        return self.recipe.tolerance_field(request)

    def outlines(self, form: str, tolerance: float) -> tuple[Outline, ...]:
        """Contour of each surface within a tolerance, mm, mirrored for a counter-clockwise shaft.

        `form` is arcs, spline or polyline. Raises ToleranceError where the fit cannot hold the tolerance.
        """
        return tuple(self._outline(fit, form, tolerance) for fit in self.fits)

    def written_outlines(
        self, form: str, tolerance: float, shift_of: Callable[[Outline], float]
    ) -> tuple[Outline, ...]:
        """Contour of each surface that is within a tolerance, mm, when it is written.

        `form` is arcs, spline or polyline; the contour is mirrored for a counter-clockwise shaft. Writing moves an
        outline by up to `shift_of(outline)`, mm; where that is a quarter of the tolerance or more, the contour is only
        sure to be within the tolerance before writing. Raises ToleranceError where the fit cannot hold the tolerance.
        """
        outlines = []
        for fit in self.fits:
            outline = self._outline(fit, form, tolerance)
            shift = shift_of(outline)
            if outline.bound.worst + shift > tolerance and 4.0 * shift < tolerance:
                outline = self._outline(fit, form, tolerance - 2.0 * shift)
            outlines.append(outline)
        return tuple(outlines)

    def _outline(self, fit: Fits, form: str, tolerance: float) -> Outline:
        outline = fit.within(form, tolerance)
        return outline.mirrored() if self.recipe.rotation == "ccw" else outline

    @contextmanager
    def refusals(self, request: FileRequest) -> Iterator[None]:
        """Context that turns errors of a fit or a writer into those of a run.

        ToleranceError, RegionError and CurveError become RecipeErrors at the field to blame, MissingExtraError becomes
        SurroundingsError.
        """
        recipe = self.recipe
        try:
            yield
        except ToleranceError as error:
            raise self.refusal(request, error) from error
        except RegionError as error:
            field_path = "part" if not recipe.part.plain else "cam" if recipe.part.bore is None else "part.bore"
            raise recipe.error(field_path, f"within the tolerance, {error}") from error
        except CurveError as error:
            raise recipe.error("cam", str(error)) from error
        except MissingExtraError as error:
            raise SurroundingsError(str(error), recipe.path) from error

    def refusal(self, request: FileRequest, error: ToleranceError) -> RecipeErrors:
        """Errors for a tolerance that cannot be held, at the field that sets it."""
        field_path, recipe = self.tolerance_field(request), self.recipe
        # rounded up as in the message: each figure works as it is written
        inches = f"{upward(error.reached, 3)} mm are {upward(error.reached / recipe.mm, 3)} in"
        return recipe.error(field_path, str(error), None, inches if recipe.units == "inch" else "")

    def judge(self, request: FileRequest, path: Path, bound: Bound, pieces: int) -> MadeFiles:
        """Read a file of one disc back and judge it by the recipe's motion; returns the file and its checks.

        `pieces` is the number of pieces of the fitted contour, `bound` the proved bound of its deviation. Raises
        ValueError for a cam of several discs, RecipeErrors for an entry that the recipe lacks, OSError where the file
        cannot be read.
        """
        from kin.judge.verify import verify

        recipe, tolerance = self.recipe, self.tolerance(request)
        file_recipe = recipe.in_units_of(request)
        intent = intent_of_file(file_recipe, self.design, request.kind)
        units = None if request.format.units else file_recipe.mm
        with self.clock.stage(f"judge {request.kind}"):
            verdict = verify(path, intent, recipe.verify.angles, permitted(recipe, tolerance), units)
        file = FileResult.of(path, request, tolerance, verdict, (pieces, bound))
        return MadeFiles((file,), tuple(self._why_lost(check) for check in verdict.checks))

    def judge_together(self, request: FileRequest, path: Path, bound: Bound, pieces: int) -> MadeFiles:
        """Read back a file of several discs, each in its place, and judge it; returns the file and its checks.

        `pieces` is the number of pieces of all fitted contours, `bound` the proved bound that holds for each. Raises
        RecipeErrors for an entry that the recipe lacks, OSError where the file cannot be read.
        """
        from kin.judge.together import DiscFile, verify_set

        recipe, tolerance = self.recipe, self.tolerance(request)
        intent = shaft_of_file(recipe.in_units_of(request), self.design, request.kind)
        with self.clock.stage(f"judge {request.kind}"):
            (verdict,) = verify_set([DiscFile(path, None)], intent, recipe.verify.angles, permitted(recipe, tolerance))
        file = FileResult.of(path, request, tolerance, verdict, (pieces, bound))
        return MadeFiles((file,), tuple(self._why_lost(check) for check in verdict.checks))

    def combine_discs(self, request: FileRequest, products: Sequence[MadeFiles]) -> MadeFiles:
        """All files and checks of a request with a file for each disc, and the checks of the play between the discs.

        `products` are the judged files of the discs, in the order of the discs.
        """
        from kin.judge.together import DiscsRead, left_between

        files = [replace(file, disc=rank) for rank, product in enumerate(products) for file in product.files]
        checks = [check for product in products for check in product.checks]
        if not files:
            return MadeFiles((), tuple(checks))
        limits = permitted(self.recipe, self.tolerance(request))
        with self.clock.stage(f"judge {request.kind}"):
            discs = [DiscsRead(file.path.name, file.surfaces, file.uneven) for file in files]
            closures, play_checks = left_between(discs, shaft_of_file(self.recipe, self.design, request.kind), limits)
        files[-1] = replace(files[-1], closures=closures)
        return MadeFiles(tuple(files), (*checks, *play_checks))

    def _why_lost(self, check: Check) -> Check:
        """Check with the reason why a roller may miss a file's contour, where the cam can hardly be turned through."""
        if check.name != MOTION.name or check.value is not None:
            return check
        slope = next(
            (design_check.value for design_check in self.design.checks if design_check.name == RATIO.name), None
        )
        if slope is None or slope < STEEP:
            return check
        remedy = self.recipe.cam.advice.less_swing(self.recipe.mm)
        why = (
            f"psi'(phi) reaches {slope:.9g}, so the follower moves almost along the contour; {remedy} would satisfy it"
        )
        return replace(check, detail=f"{marked(check.detail)}: {why}")


def unjudged(path: Path, request: FileRequest, units: float) -> MadeFiles:
    """A file that nothing judges, such as a table, without checks; `units` is the unit of its numbers in mm."""
    return MadeFiles((FileResult(path, request, units=units),))
