"""Runs of kinds of cams with recipes of their own: from a recipe to files on disk and a verdict on them.

`camgeo.output.pipeline` is the same for a disc.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Generic, NamedTuple, Protocol, TypeVar

from camgeo.common.clock import Clock
from camgeo.common.errors import CallError
from camgeo.files.errors import MissingExtraError
from camgeo.measures.file_result import FileResult
from camgeo.output.pipeline import REPORT, Outcome, demand_any
from camgeo.recipe.export import FileRequest
from camgeo.report.document import Findings, as_json, document, finite
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from pathlib import Path

    from camgeo.files.layer_outline import LayerOutline
    from camgeo.files.mesh import Mesh
    from camgeo.fit.bound import Bound
    from camgeo.measures.extension import Results
    from camgeo.measures.placed import Figure
    from camgeo.measures.rule_remark import RuleRemark
    from camgeo.motions.stated import StatedMotion
    from camgeo.recipe.recipe import Order
    from camgeo.report.page.scene import Scene
    from kin.law.contacts import Unit
    from kin.law.sources.motion import Kept
    from kin.numeric.arrays import Array
    from kin.numeric.check import Check


class FlankVerdict(Protocol):
    """Protocol of kin's verdict on a flank."""

    @property
    def pieces(self) -> int | None:
        """Number of pieces of the file on this flank, as its format counts them; None where it counts none."""
        ...


class Verdict(Protocol):
    """Protocol of kin's verdict on a file."""

    @property
    def kind(self) -> str:
        """Word of the file's format."""
        ...

    @property
    def checks(self) -> tuple[Check, ...]:
        """Checks of the file."""
        ...

    @property
    def units(self) -> float | None:
        """Length, mm, of a unit of the file as it was read; None where nothing was read."""
        ...

    @property
    def flanks(self) -> Sequence[FlankVerdict]:
        """Verdicts on the flanks in the file."""
        ...


class Designed(Protocol):
    """Protocol of the exact cam of a recipe."""

    @property
    def recipe(self) -> Order:
        """The recipe."""
        ...


D = TypeVar("D", bound=Designed)
D_contra = TypeVar("D_contra", bound=Designed, contravariant=True)
V = TypeVar("V", bound=Verdict)
V_co = TypeVar("V_co", bound=Verdict, covariant=True)


class Judging(Protocol[D_contra, V_co]):
    """Protocol of a function that gives kin's verdict on a file of a design.

    The request is None for a file that the recipe does not ask for; `units` is mm in the unit of a file that states
    none, None for the recipe's; `gap` is that over which ends are joined, mm.
    """

    def __call__(
        self,
        design: D_contra,
        path: Path,
        request: FileRequest | None,
        tolerance: float,
        *,
        units: float | None = None,
        gap: float | None = None,
    ) -> V_co:
        """Verdict on a file within a tolerance, mm."""
        ...


class Page(Protocol[D_contra]):
    """Protocol of the module that draws the page of a kind of cams."""

    def drawn(self, design: D_contra, /) -> dict[str, Any]:
        """Data of its script that show and move the mechanism: entries of `camgeo.report.page.page.picture`."""
        ...

    def script(self, design: D_contra, made: Sequence[Made[Any]], /) -> dict[str, Any]:
        """All data of its script, for the files that were made or given; there may be none."""
        ...

    def panels(self, design: D_contra, report: dict[str, Any], /) -> str:
        """HTML of the panels that only this kind has."""
        ...

    def looks(self) -> tuple[str, str]:
        """CSS of these panels, and JavaScript of the players that `script` names."""
        ...


Bounds = tuple[float | None, float | None, float | None]
"""Tolerance, mm in the unit of files that state none, and gap over which ends are joined, mm; None: the recipe's."""


class Made(NamedTuple, Generic[V]):
    """A file that was made or given, its checks, and kin's verdict; None of a file that nothing judges."""

    file: FileResult
    checks: tuple[Check, ...] = ()
    verdict: V | None = None


def judged_made(
    judge: Judging[D_contra, V],
    design: D_contra,
    path: Path,
    request: FileRequest,
    *,
    clock: Clock,
    fit: tuple[int | None, Bound],
) -> Made[V]:
    """A file that was written, with kin's verdict on it; `fit` is its number of pieces, None for a mesh, and bound."""
    tolerance = design.recipe.tolerance(request)
    with clock.stage(f"judge {request.kind}"):
        verdict = judge(design, path, request, tolerance)
    return Made(FileResult(path, request, tolerance, *fit, units=verdict.units), verdict.checks, verdict)


class Told(NamedTuple):
    """What a report says besides, as `Findings` has it: follower, remarks, the kept table, unit of displacements."""

    follower: str
    remarks: tuple[RuleRemark, ...]
    table: Kept | None
    displacements: tuple[float, str]


@dataclass(frozen=True, eq=False)
class Run(Generic[D, V]):
    """A run: the exact cam, its figures, the files that were made or given, and what follows from them."""

    kind: OwnKind[D, V]
    design: D
    figures: tuple[Figure, ...]
    made: tuple[Made[V], ...]
    findings: Findings

    @property
    def report(self) -> dict[str, Any]:
        """The report as plain data."""
        report = document(self.design.recipe, self.findings)
        verdicts = {made.file.path.name: made.verdict for made in self.made}
        for entry in report["files"]:
            verdict = verdicts.get(entry["path"])
            if verdict is not None:
                entry.update(self.kind.rows(self.design.recipe, verdict))
        return {**report, **self.kind.section(self.design, self.figures)}


@dataclass(frozen=True, kw_only=True)
class OwnKind(Generic[D, V]):
    """What a kind of cams answers in a run.

    designed  the exact cam of a recipe; raises RecipeErrors where there is none
    figures   all figures, in the order of reports
    at_unit   unit of their places, mm or deg
    checks    checks that need no file, by the figures
    limited   checks of the limits of a recipe, by the figures and these checks
    told      what a report says besides
    section   sections of its own in a report
    rows      entries of a judged file in a report, by the recipe
    foresee   refuses what is certain to be refused of a file; raises MissingExtraError where a package is missing
    maker     function that makes and judges a file of a design: (request, path)
    judged    kin's verdict on a file
    seen      bodies to be drawn, over the kind's input, and of what is drawn anew the shape at a step
    page_of   module that draws its page, imported when it is called
    motion    the motion as the recipe states it
    drawings  drawings at true size within a tolerance, mm: titles, with closed outlines and open lines (n, 2), mm
    mesh      mesh of the part for a request of one; raises RecipeErrors where none can be made
    formats   words of the formats whose absence a report states
    """

    designed: Callable[[Any, Clock], D]
    figures: Callable[[D], Sequence[Figure]]
    at_unit: Unit
    checks: Callable[[D, Sequence[Figure]], Sequence[Check]]
    limited: Callable[[D, Sequence[Figure], Sequence[Check]], list[Check]]
    told: Callable[[D, Sequence[Figure]], Told]
    section: Callable[[D, Sequence[Figure]], dict[str, Any]]
    rows: Callable[[Any, V], dict[str, Any]]
    foresee: Callable[[D, FileRequest], None]
    maker: Callable[[D, Clock], Callable[[FileRequest, Path], Made[V]]]
    judged: Judging[D, V]
    seen: Callable[[D, int], Scene]
    page_of: Callable[[], Page[D]]
    motion: Callable[[D], StatedMotion]
    drawings: Callable[[D, float], list[tuple[str, Sequence[LayerOutline | Array]]]]
    mesh: Callable[[D, FileRequest], Mesh]
    formats: tuple[str, ...]

    def export(
        self, recipe: Order, out: Path, *, only: tuple[str, ...] = (), progress: Callable[[str], None] | None = None
    ) -> Outcome:
        """Write and judge the files of a recipe under `out`/<name>; where a check fails, to `out`/<name>.rejected.

        `only` names the kinds of the files to be made, by default all; files of other kinds stay. Raises RecipeErrors
        where there is no such cam or a tolerance cannot be held, SurroundingsError where the file system refuses or
        none of the files can be made.
        """
        from camgeo.output.output_folder import RunFolder

        requests = tuple(request for request in recipe.export.files if not only or request.kind in only)
        with RunFolder(out, recipe.name) as folder:
            run = self._produced(recipe, requests, folder.folder, Clock(progress))
            demand_any(recipe.path, run.findings)
            kept = folder.kept_names() if only else ()
            run = replace(run, findings=replace(run.findings, kept=kept))
            report = run.report
            (folder.folder / REPORT).write_text(as_json(report), encoding="utf-8", newline="\n")
            names = [file.path.name for file in run.findings.files]
            place = folder.commit(names, keep=kept) if run.findings.ok else folder.reject()
        return Outcome(report, run.findings.ok, place)

    def check(self, recipe: Order, *, progress: Callable[[str], None] | None = None) -> Outcome:
        """Make and judge all files in a temporary folder that is removed afterwards; raises as `export` does."""
        from camgeo.output.output_folder import temporary_folder

        with temporary_folder() as folder:
            run = self._produced(recipe, recipe.export.files, folder, Clock(progress))
            demand_any(recipe.path, run.findings)
            return Outcome(run.report, run.findings.ok, None)

    def report_on(self, recipe: Order, paths: list[Path], bounds: Bounds) -> dict[str, Any]:
        """Report on files of any origin, judged by the recipe's motion.

        Raises RecipeErrors where there is no such cam, CallError for a gap above the tolerance, ValueError for an
        unknown suffix, OSError where a file cannot be read.
        """
        return self._judged(recipe, paths, bounds).report

    def report_and_page(self, recipe: Order, paths: list[Path], bounds: Bounds) -> tuple[dict[str, Any], str]:
        """Report of `report_on`, and the HTML of the page that shows the files; arguments and errors are the same."""
        run = self._judged(recipe, paths, bounds)
        report = run.report
        return report, self.page(run.design, run.made, report)

    def claimed(self, recipe: Order, judge: Callable[[D, Clock], Results]) -> dict[str, Any]:
        """Report on files that no judge of this kind reads, such as measured points, by what `judge` finds of them.

        Raises RecipeErrors where there is no such cam, and what `judge` raises.
        """
        clock = Clock()
        design = self.designed(recipe, clock)
        checks, figures = self._examined(design, clock)
        results = judge(design, clock)
        run = self._run(design, figures, [], [*checks, *results.checks], clock=clock)
        return replace(run, findings=replace(run.findings, sections=results.sections)).report

    def scene(self, design: D) -> dict[str, Any]:
        """Data of the script of a page without files, with its `panels`, `checks` and `remarks`."""
        clock = Clock()
        checks, figures = self._examined(design, clock)
        report = self._run(design, figures, [], checks, clock=clock).report
        told, page = {key: finite(report[key]) for key in ("checks", "remarks")}, self.page_of()
        return {**page.script(design, ()), "panels": page.panels(design, report), **told}

    def page(self, design: D, made: Sequence[Made[V]], report: dict[str, Any]) -> str:
        """HTML of the page, from the design, the files that were made or given, and the report."""
        from camgeo.report.page.page import filled

        page = self.page_of()
        style, code = page.looks()
        data, panels = page.script(design, made), page.panels(design, report)
        return filled(design.recipe, data, report, panels=panels, style=style, code=code)

    def _judged(self, recipe: Order, paths: list[Path], bounds: Bounds) -> Run[D, V]:
        tolerance, units, gap = bounds
        clock = Clock()
        design = self.designed(recipe, clock)
        checks, figures = self._examined(design, clock)
        made: list[Made[V]] = []
        for path in paths:
            request = recipe.request_of(path.name)
            within = ((request and request.tolerance) or recipe.export.tolerance) if tolerance is None else tolerance
            if gap is not None and gap > within:
                shown = f"{within / recipe.mm:.9g}"
                message = f"a gap of {gap / recipe.mm:.9g} {recipe.units} is more than the tolerance, {shown}"
                raise CallError(f"{message}, of {path.name}: give at most that")
            if request is not None and not request.format.contour:
                request = None
            with clock.stage("judge"):
                verdict = self.judged(design, path, request, within, units=units, gap=gap)
            asked = request or FileRequest(verdict.kind)
            pieces = sum(flank.pieces or 0 for flank in verdict.flanks)
            file = FileResult(path, asked, within, pieces, units=verdict.units)
            made.append(Made(file, verdict.checks, verdict))
            checks += verdict.checks
        return self._run(design, figures, made, checks, clock=clock)

    def _examined(self, design: D, clock: Clock) -> tuple[list[Check], tuple[Figure, ...]]:
        with clock.stage("figures"):
            figures = tuple(self.figures(design))
            return [*self.checks(design, figures)], figures

    def _run(
        self,
        design: D,
        figures: tuple[Figure, ...],
        made: list[Made[V]],
        checks: list[Check],
        *,
        clock: Clock,
        skipped: tuple[tuple[str, str], ...] = (),
    ) -> Run[D, V]:
        told = self.told(design, figures)
        findings = Findings(
            (*checks, *self.limited(design, figures, checks)),
            tuple(each.file for each in made),
            tuple(clock.stages),
            skipped,
            told.follower,
            remarks=told.remarks,
            table=told.table,
            displacements=told.displacements,
        )
        return Run(self, design, figures, tuple(made), findings)

    def _produced(self, recipe: Order, requests: tuple[FileRequest, ...], folder: Path, clock: Clock) -> Run[D, V]:
        """Write and judge the requested files in a folder."""
        design = self.designed(recipe, clock)
        checks, figures = self._examined(design, clock)
        made: list[Made[V]] = []
        missing: dict[FileRequest, str] = {}
        pages = [request for request in requests if request.format.summary]
        others = [request for request in requests if not request.format.summary]
        sound = all(each.ok for each in checks)
        for request in others:
            try:
                self.foresee(design, request)
            except MissingExtraError as error:
                missing[request] = str(error)
        make = self.maker(design, clock)
        for request in others if sound else ():
            if request not in missing:
                made.append(make(request, folder / request.filename(recipe.name, recipe.export.files)))
                checks += made[-1].checks
        kinds = {request.kind for request in recipe.export.files}
        skipped = tuple((kind, "not asked for") for kind in self.formats if kind not in kinds)
        run = self._run(design, figures, made, checks, clock=clock, skipped=skipped)
        names = {request: request.filename(recipe.name, recipe.export.files) for request in missing}
        lacking = tuple((names[request], why) for request, why in missing.items())
        run = replace(run, findings=replace(run.findings, missing=lacking))
        for request in pages:
            path = folder / request.filename(recipe.name, recipe.export.files)
            with clock.stage("page"):
                path.write_text(self.page(design, run.made, run.report), encoding="utf-8", newline="\n")
            files = (*run.findings.files, FileResult(path, request))
            run = replace(run, findings=replace(run.findings, files=files, stages=tuple(clock.stages)))
        return run
