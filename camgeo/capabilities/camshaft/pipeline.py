"""From the recipe of a camshaft to files on disk and a verdict on them; as `camgeo.output.pipeline` for one cam."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from camgeo.capabilities.camshaft.extension import ON_SHAFT, writers
from camgeo.capabilities.camshaft.keys import DRAWN, SHAFT_FILES
from camgeo.capabilities.camshaft.lobes import left_to_lobes, lobe_checks, placed
from camgeo.common.clock import Clock
from camgeo.common.units import INCH, UNIT_MM
from camgeo.files.errors import MissingExtraError, RegionError
from camgeo.files.mesh import Item
from camgeo.fit.cache import Fits, formula_rounding
from camgeo.fit.nodes import ToleranceError
from camgeo.measures.file_result import FileResult
from camgeo.output.extension import MAKING, numbers_of
from camgeo.output.pipeline import REPORT, Outcome, demand_any
from camgeo.report.document import Findings, as_json, document
from camgeo.schema.fields import either
from camgeo.synthesis.intent import intended, permitted
from kin.numeric.records import dataclass, field, replace

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping
    from pathlib import Path

    from camgeo.capabilities.camshaft.keys import CamshaftRecipe
    from camgeo.capabilities.camshaft.lobes import PlacedLobe
    from camgeo.fit.bound import Bound
    from camgeo.output.extension import FileCall
    from camgeo.recipe.export import FileRequest
    from kin.judge.camshaft import CamshaftIntent
    from kin.numeric.check import Check

COLOUR = "#d08a3c"


@dataclass(frozen=True)
class _Job:
    """A camshaft in the making: its lobes, and the fits of their contours, one for each cam."""

    recipe: CamshaftRecipe
    lobes: tuple[PlacedLobe, ...]
    clock: Clock
    fits: dict[str, Fits] = field(default_factory=dict)

    def fits_of(self, lobe: PlacedLobe) -> Fits:
        key, contour = str(lobe.lobe.recipe.path), lobe.contour
        if contour is None:
            raise ValueError(f"{lobe.lobe.name}: there is no contour to be made")
        if key not in self.fits:
            self.fits[key] = Fits(contour, self.clock, formula_rounding(lobe.design.exact.rounding, contour))
        return self.fits[key]

    def tolerance(self, request: FileRequest) -> float:
        return self.recipe.tolerance(request)


def export(
    recipe: CamshaftRecipe, out: Path, *, only: tuple[str, ...] = (), progress: Callable[[str], None] | None = None
) -> Outcome:
    """Write and judge a camshaft's files under `out`/<name>; where a check fails, to `out`/<name>.rejected.

    `only` names the kinds of the files to be made, by default all; files of other kinds stay. `progress` is called with
    the name of each stage. Raises RecipeErrors where a lobe has no such curve or a tolerance cannot be held, EventError
    where a valve's motion is too rough to follow, SurroundingsError where the file system refuses or none of the files
    can be made.
    """
    from camgeo.output.output_folder import RunFolder

    requests = tuple(request for request in recipe.export.files if not only or request.kind in only)
    with RunFolder(out, recipe.name) as run:
        findings, lobes = _produced(recipe, requests, run.folder, Clock(progress))
        demand_any(recipe.path, findings)
        kept = run.kept_names() if only else ()
        report = _report(recipe, replace(findings, kept=kept), lobes)
        (run.folder / REPORT).write_text(as_json(report), encoding="utf-8", newline="\n")
        names = [file.path.name for file in findings.files]
        folder = run.commit(names, keep=kept) if findings.ok else run.reject()
    return Outcome(report, findings.ok, folder)


def check(recipe: CamshaftRecipe, *, progress: Callable[[str], None] | None = None) -> Outcome:
    """Make and judge all files in a temporary folder that is removed afterwards; `progress` gets each stage's name.

    Raises RecipeErrors where a lobe has no such curve or a tolerance cannot be held, EventError where a valve's motion
    is too rough to follow, SurroundingsError where the file system refuses or none of the files can be made.
    """
    from camgeo.output.output_folder import temporary_folder

    with temporary_folder() as folder:
        findings, lobes = _produced(recipe, recipe.export.files, folder, Clock(progress))
        demand_any(recipe.path, findings)
        return Outcome(_report(recipe, findings, lobes), findings.ok, None)


def judged(
    recipe: CamshaftRecipe, paths: list[Path], *, tolerance: float | None = None, units: float | None = None
) -> dict[str, Any]:
    """Report on solids of any origin, judged against a camshaft's lobes.

    `tolerance`, mm, is that of the files, by default the recipe's; `units` is mm in the unit of files that name none.
    Raises RecipeErrors for a lobe without a curve and for a file that is no solid, ValueError for an unknown suffix.
    """
    from camgeo.recipe.export import FileRequest
    from kin.judge.camshaft import verify_camshaft
    from kin.read.formats import FORMATS, format_of

    clock = Clock()
    lobes = placed(recipe, clock)
    checks, files = lobe_checks(recipe, lobes), []
    for path in paths:
        record = format_of(path)
        kind = record.name
        if record.contents != "solid":
            solids = tuple(name for name, other in FORMATS.items() if other.contents == "solid")
            remedy = f"give its {either(solids)}"
            raise recipe.error("camshaft", f"a camshaft is judged by its solid, not by {path.name}", None, remedy)
        request = recipe.request_of(path.name) or FileRequest(kind)
        within = (request.tolerance or recipe.export.tolerance) if tolerance is None else tolerance
        stated = units
        if stated is None and not record.units and request.units == "inch":
            stated = INCH
        with clock.stage("judge"):
            verdict = verify_camshaft(path, _intent(recipe, lobes, within), recipe.verify.angles, stated)
        files.append(FileResult.of(path, FileRequest(kind), within, verdict))
        checks += verdict.checks
    findings = _findings(recipe, lobes, checks, files, clock)
    return _report(recipe, findings, lobes)


def judged_by(recipe: CamshaftRecipe, name: str, call: FileCall) -> dict[str, Any]:
    """Report on files that the capability `name` claims, such as points: `call` has their paths and options.

    Raises CallError for files that cannot be judged, RecipeErrors for a lobe without a curve, KeyError for a capability
    that judges no files of a shaft.
    """
    judge = ON_SHAFT[name].judge
    if judge is None:
        raise KeyError(name)
    clock = Clock()
    lobes = placed(recipe, clock)
    with clock.stage(name):
        cams = [lobe.on_shaft(recipe.engine) for lobe in lobes]
        results = judge(recipe, cams, call, clock)
    findings = _findings(recipe, lobes, [*lobe_checks(recipe, lobes), *results.checks], [], clock)
    return _report(recipe, replace(findings, sections=results.sections), lobes)


def _produced(
    recipe: CamshaftRecipe, requests: tuple[FileRequest, ...], folder: Path, clock: Clock
) -> tuple[Findings, tuple[PlacedLobe, ...]]:
    """Write and judge the requested files in a folder; return the findings and the lobes."""
    lobes = placed(recipe, clock)
    checks = lobe_checks(recipe, lobes)
    files: list[FileResult] = []
    pages = [request for request in requests if request.format.summary]
    missing: dict[FileRequest, str] = {}
    if all(lobe.contour is not None for lobe in lobes) and all(check.ok or check.name != "shaft" for check in checks):
        job = _Job(recipe, lobes, clock)
        for request in requests:
            try:
                _demand_packages(request)
            except MissingExtraError as error:
                missing[request] = str(error)
        for request in requests:
            if request in missing or request.format.summary:
                continue
            path = folder / request.filename(recipe.name, recipe.export.files)
            file, more = _made(job, request, path)
            files.append(file)
            checks += more
    names = {request: request.filename(recipe.name, recipe.export.files) for request in missing}
    findings = _findings(recipe, lobes, checks, files, clock)
    findings = replace(findings, missing=tuple((names[request], why) for request, why in missing.items()))
    for request in pages:
        from camgeo.capabilities.camshaft.shaft_page import page

        path = folder / request.filename(recipe.name, recipe.export.files)
        path.write_text(page(recipe, lobes, _report(recipe, findings, lobes)), encoding="utf-8", newline="\n")
        findings = replace(findings, files=(*findings.files, FileResult(path, request)))
    return findings, lobes


def _demand_packages(request: FileRequest) -> None:
    """Raise MissingExtraError where a package is missing that makes the requested solid."""
    if not SHAFT_FILES[request.kind].solid:
        return
    if not request.format.mesh:  # but a STEP
        from camgeo.files.brep import need_kernel

        need_kernel()
    else:
        from camgeo.files.solid import need_booleans

        need_booleans()


def _made(job: _Job, request: FileRequest, path: Path) -> tuple[FileResult, tuple[Check, ...]]:
    """Write one file; a solid is read back and judged."""
    if request.kind in _UNJUDGED:
        return _UNJUDGED[request.kind](job, request, path), ()
    recipe, write = job.recipe, writers().get(request.kind)
    if write is None:
        return _solid(job, request, path)
    with job.clock.stage(request.kind):
        write(recipe, [lobe.on_shaft(recipe.engine) for lobe in job.lobes], request, path)
    return FileResult(path, request, units=UNIT_MM[request.unit_for(recipe.units)]), ()


def _table(job: _Job, request: FileRequest, path: Path) -> FileResult:
    from camgeo.capabilities.camshaft.tables import write_csv

    with job.clock.stage("table"):
        write_csv(path, job.recipe, job.lobes, request)
    return FileResult(path, request, units=job.recipe.mm)


def _drawing(job: _Job, request: FileRequest, path: Path) -> FileResult:
    from camgeo.capabilities.camshaft.diagrams import diagram

    with job.clock.stage("timing"):
        path.write_text(diagram(job.recipe, job.lobes, request.as_), encoding="utf-8", newline="\n")
    return FileResult(path, request)


_UNJUDGED: Mapping[str, Callable[[_Job, FileRequest, Path], FileResult]] = {"csv": _table, DRAWN: _drawing}


def _unit(request: FileRequest) -> float:
    """Millimetres in the unit of a file's lengths."""
    return INCH if request.units == "inch" else 1.0


def _solid(job: _Job, request: FileRequest, path: Path) -> tuple[FileResult, tuple[Check, ...]]:
    from kin.judge.camshaft import verify_camshaft

    recipe, tolerance, mm = job.recipe, job.tolerance(request), _unit(request)
    try:
        bound, pieces = _written(job, request, path)
    except ToleranceError as error:
        raise recipe.error(recipe.tolerance_field(request), str(error)) from error
    except RegionError as error:
        raise recipe.error("camshaft", f"within the tolerance, {error}") from error
    if not request.format.contour:
        return FileResult(path, request, units=UNIT_MM["m"]), ()
    with job.clock.stage(f"judge {request.kind}"):
        intent = _intent(recipe, job.lobes, tolerance)
        verdict = verify_camshaft(path, intent, recipe.verify.angles, None if request.format.units else mm)
    return FileResult.of(path, request, tolerance, verdict, (pieces, bound)), verdict.checks


def _written(job: _Job, request: FileRequest, path: Path) -> tuple[Bound, int]:
    """Write a solid; return the bound on the error of its lobes' contours, mm, and the number of their pieces."""
    recipe, tolerance, mm, record = job.recipe, job.tolerance(request), _unit(request), MAKING[request.kind]
    if not request.format.mesh:
        from camgeo.capabilities.camshaft.body import camshaft_outlines, circle
        from camgeo.formats.step import write_stack

        stretches, bound, pieces = camshaft_outlines(recipe, job.lobes, job.fits_of, 0.5 * tolerance)
        with job.clock.stage("write step"):
            bore = None if recipe.bore is None else circle(recipe.bore)
            more = write_stack(path, stretches, bore, units=request.units or "mm", name=recipe.name, about=recipe.about)
        return bound.widened(more), pieces
    from camgeo.capabilities.camshaft.body import camshaft_mesh

    numbers = numbers_of(request.kind, mm)
    with job.clock.stage(f"mesh {request.kind}"):
        mesh, bound, pieces = camshaft_mesh(recipe, job.lobes, job.fits_of, tolerance=tolerance, precision=numbers)
    with job.clock.stage(f"write {request.kind}"):
        if record.write is not None:
            record.write(path, [Item("camshaft", mesh)], recipe.name, mm, recipe.about)
        else:
            from camgeo.formats.glb import Actor, steady_turn, write_glb

            write_glb(path, [Actor("camshaft", mesh, steady_turn(recipe.rotation), COLOUR)], title=recipe.name)
    return bound, pieces


def _intent(recipe: CamshaftRecipe, lobes: tuple[PlacedLobe, ...], tolerance: float) -> CamshaftIntent:
    """Intended camshaft that kin judges a file by: each lobe as in its own recipe, with its angle and place."""
    from kin.judge.camshaft import BarIntent, CamshaftIntent, LobeIntent

    return CamshaftIntent(
        tuple(
            LobeIntent(
                lobe.lobe.name,
                intended(lobe.lobe.recipe, lobe.design).surfaces[0],
                lobe.at,
                lobe.lobe.low,
                lobe.lobe.high,
                permitted(lobe.lobe.recipe, tolerance),
            )
            for lobe in lobes
        ),
        tuple(BarIntent(bar.name, bar.low, bar.high, bar.diameter) for bar in recipe.bars),
        recipe.bore,
        recipe.rotation == "ccw",
        tolerance,
    )


def _findings(
    recipe: CamshaftRecipe,
    lobes: tuple[PlacedLobe, ...],
    checks: list[Check],
    files: list[FileResult],
    clock: Clock,
) -> Findings:
    from camgeo.curve.measures import measures

    contours = {lobe.lobe.name: measures(lobe.contour) for lobe in lobes if lobe.contour is not None}
    kinds = {request.kind for request in recipe.export.files}
    skipped = tuple(
        (kind, "not asked for")
        for kind, record in SHAFT_FILES.items()
        if record.solid and record.contour and kind not in kinds
    )
    return Findings(
        tuple(checks),
        tuple(files),
        tuple(clock.stages),
        skipped,
        "of each lobe",
        remarks=tuple(left_to_lobes(recipe)),
        contours=contours,
    )


def _report(recipe: CamshaftRecipe, findings: Findings, lobes: tuple[PlacedLobe, ...]) -> dict[str, Any]:
    """The report, with a section on the lobes: where they stand, and when they lift."""
    from camgeo.capabilities.camshaft.section import camshaft_section

    return {**document(recipe, findings), "camshaft": camshaft_section(recipe, lobes)}
