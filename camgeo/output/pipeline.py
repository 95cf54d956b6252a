"""From a recipe to files on disk and a verdict on them: the plan, its stages, the report.

Each stage runs only where something asks for it, and imports what it needs when it runs; what nothing asks for is
listed as skipped, with the reason. Files are written into a private folder, read back there by kin, and put in their
place only when every check holds. A file that a missing package would make is left out before anything is fitted.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from camgeo.common.clock import Clock
from camgeo.common.errors import SurroundingsError
from camgeo.files.errors import MissingExtraError
from camgeo.measures.file_result import FileResult
from camgeo.output.file_intent import shaft_of_file
from camgeo.registry import registry
from camgeo.registry.formats import Run
from camgeo.report.document import Findings, as_json, document
from camgeo.synthesis.design import Design, designed
from camgeo.synthesis.intent import permitted
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from camgeo.measures.balance import Balance
    from camgeo.output.sets import FileSet
    from camgeo.output.skipped import Skipped
    from camgeo.recipe.export import FileRequest
    from camgeo.recipe.recipe import Recipe
    from camgeo.registry.capability import FileCall, Results
    from camgeo.report.page.content import Content
    from kin.judge.check import Check
    from kin.judge.intent import ShaftIntent

REPORT = "report.json"


@dataclass(frozen=True)
class Outcome:
    """What became of one recipe: its report, whether every check held, and the folder with its files (None if none)."""

    report: dict[str, Any]
    ok: bool
    folder: Path | None


def export(
    recipe: Recipe,
    out: Path,
    *,
    only: tuple[str, ...] = (),
    progress: Callable[[str], None] | None = None,
) -> Outcome:
    """Write and judge a recipe's files under `out`/<name>; see the module.

    A file that a missing package would make is left out. Raises RecipeErrors where no such curve exists or a tolerance
    cannot be held, SurroundingsError where the disk does not do what it should, or none of the files can be made. A
    failed check raises nothing: the set goes to `out`/<name>.rejected.
    """
    from camgeo.output.output_folder import RunFolder

    clock = Clock(progress)
    requests = tuple(r for r in recipe.export.files if not only or r.kind in only)
    with RunFolder(out, recipe.name) as run:
        _, found = _produced(recipe, requests, run.folder, clock)
        demand_any(recipe.path, found)
        kept = run.kept() if only else ()
        report = document(recipe, replace(found, kept=kept))
        (run.folder / REPORT).write_text(as_json(report), encoding="utf-8", newline="\n")
        names = [file.path.name for file in found.files]
        folder = run.commit(names, keep=kept) if found.ok else run.reject()
    return Outcome(report, found.ok, folder)


def check(recipe: Recipe, *, progress: Callable[[str], None] | None = None) -> Outcome:
    """Make and judge everything in a temporary folder that is gone afterwards; raises as `export` does."""
    import tempfile
    from pathlib import Path

    with tempfile.TemporaryDirectory(prefix="camgeo-") as folder:
        _, found = _produced(recipe, recipe.export.files, Path(folder), Clock(progress))
        demand_any(recipe.path, found)
        return Outcome(document(recipe, found), found.ok, None)


def demand_any(path: Path, findings: Findings) -> None:
    """Raise SurroundingsError, of the recipe's path, where packages are missing for every file."""
    if findings.missing and not findings.files:
        raise SurroundingsError(findings.missing[0][1], path)


def shown(recipe: Recipe, *, progress: Callable[[str], None] | None = None) -> tuple[Outcome, Content]:
    """Make and judge everything as `check` does; also what a page shows of it. Raises as `export` does."""
    import tempfile
    from pathlib import Path

    clock = Clock(progress)
    requests = tuple(request for request in recipe.export.files if not request.format.summary)
    with tempfile.TemporaryDirectory(prefix="camgeo-") as folder:
        design, found = _produced(recipe, requests, Path(folder), clock)
        return Outcome(document(recipe, found), found.ok, None), content_of(recipe, design, found, clock)


def judged(
    recipe: Recipe,
    paths: list[Path],
    *,
    tolerance: float | None = None,
    units: float | None = None,
    gap: float | None = None,
) -> dict[str, Any]:
    """Report on files of any origin, held against a recipe's motion; raises RecipeErrors as `export` does.

    They are held to `tolerance`, mm; without one to that of the recipe's file of the same name, or of its export.
    `units`, mm, is that of files that state none; raises UnitsError where one states another. Ends in drawings within
    `gap`, mm, are joined; CallError for one above the tolerance of a drawing.
    """
    _, findings = _judged(recipe, paths, (tolerance, units, gap), Clock())
    return document(recipe, findings)


def judged_and_shown(
    recipe: Recipe,
    paths: list[Path],
    *,
    tolerance: float | None = None,
    units: float | None = None,
    gap: float | None = None,
) -> tuple[dict[str, Any], str]:
    """Report on files as `judged` does, and give the page that shows them, with their errors round the contour."""
    from camgeo.report.page.page import page

    clock = Clock()
    design, findings = _judged(recipe, paths, (tolerance, units, gap), clock)
    report = document(recipe, findings)
    return report, page(recipe, content_of(recipe, design, findings, clock), report)


def _judged(
    recipe: Recipe, paths: list[Path], held: tuple[float | None, float | None, float | None], clock: Clock
) -> tuple[Design, Findings]:
    """Everything that is found of files of any origin, by tolerance, unit and gap."""
    from camgeo.common.errors import CallError
    from camgeo.output.sets import sets_of
    from camgeo.recipe.export import FileRequest
    from kin.judge.together import DiscFile, verify_set
    from kin.read.formats import FORMATS

    tolerance, units, gap = held
    _demand(recipe)
    design = designed(recipe, clock)
    checks, results = list(design.checks), dict[int, FileResult]()
    skipped: list[Skipped] = []
    for given in sets_of(recipe, paths, tolerance):
        kind, asked, within = given.held.kind, given.held.asked, given.held.tolerance
        if gap is not None and gap > within and FORMATS[kind].contents == "drawing":
            message = (
                f"a gap of {gap / recipe.mm:.9g} {recipe.units} is more than the tolerance, {within / recipe.mm:.9g}"
            )
            raise CallError(f"{message}, of {given.files[0][1].name}: give at most that")
        with clock.stage("judge"):
            request = FileRequest(kind) if asked is None else asked
            told = recipe if asked is None else recipe.told_for(asked)
            meant = shaft_of_file(told, design, kind, request.compensation, recipe.field_of(asked))
            unstated = [recipe.unstated(path) if units is None else units for _, path, _ in given.files]
            discs = [DiscFile(path, disc, mm) for (_, path, disc), mm in zip(given.files, unstated, strict=True)]
            verdicts = verify_set(discs, meant, recipe.verify.angles, permitted(recipe, within, gap))
        for (place, path, disc), verdict in zip(given.files, verdicts, strict=True):
            made = FileRequest(verdict.kind, compensation=request.compensation)
            rank = disc if len(meant.parts) > 1 else None
            results[place] = replace(FileResult.of(path, made, within, verdict), disc=rank)
            checks += verdict.checks
        skipped += _alone(given, meant)
    files = [results[place] for place in sorted(results)]
    for result in _looked(recipe, design, files, checks, clock):
        checks, skipped = [*checks, *result.checks], [*skipped, *result.skipped]
    return design, _findings(recipe, design, checks, files, clock, skipped=tuple(skipped))


def judged_by(recipe: Recipe, name: str, call: FileCall) -> dict[str, Any]:
    """Report on files that a capability claims, see `FileJudge`; raises as it does, and RecipeErrors as `export`."""
    from camgeo.measures.units import displacement_unit

    judge = registry.judges()[name].judge
    clock = Clock()
    design = designed(recipe, clock)
    with clock.stage(name):
        results = judge(recipe, design, call, clock)
    findings = Findings(
        (*design.checks, *results.checks),
        (),
        tuple(clock.stages),
        tuple(results.skipped),
        design.follower.name,
        displacements=displacement_unit(recipe),
        sections=results.sections,
    )
    return document(recipe, findings)


def _alone(files: FileSet, intent: ShaftIntent) -> list[Skipped]:
    """What is not judged of a set that lacks a disc."""
    lacking = [part.name for rank, part in enumerate(intent.parts) if not {rank, None} & files.discs]
    names = " and ".join(path.name for _, path, _ in files.files)
    why = f"{names} is judged alone: {' and '.join(lacking)} is not among the files that are given"
    return [(closure.name, why) for closure in intent.closures if lacking]


def _demand(recipe: Recipe) -> None:
    """Demand what the capabilities need that the recipe uses; raises SurroundingsError."""
    for capability in registry.in_order(recipe.uses):
        capability.demand(recipe)


def _looked(
    recipe: Recipe, design: Design, files: list[FileResult], checks: list[Check], clock: Clock
) -> list[Results]:
    """What capabilities say of files beside the judge."""
    capabilities = registry.in_order(recipe.uses)
    return [capability.look(recipe, design, files, checks, clock) for capability in capabilities]


def _produced(recipe: Recipe, requests: tuple[FileRequest, ...], folder: Path, clock: Clock) -> tuple[Design, Findings]:
    """All stages: design, fits, files, verdicts, page."""
    from camgeo.output.skipped import left_out

    _demand(recipe)
    design = designed(recipe, clock)
    checks = list(design.checks)
    files: list[FileResult] = []
    missing: dict[FileRequest, str] = {}
    job = None
    if design.contours:
        from camgeo.output.dispatch import foresee, make
        from camgeo.output.job import Job

        job = Job.of(recipe, design, clock)
        for request in requests:
            try:
                foresee(job, request)
            except MissingExtraError as error:
                missing[request] = str(error)
        for request in requests:
            if request in missing or request.format.summary:
                continue
            made = make(job, request, folder / request.filename(recipe.name, recipe.export.files))
            files += made.files
            checks += made.checks
    skipped = left_out(recipe, requests, design)
    for result in _looked(recipe, design, files, checks, clock):
        checks, skipped = [*checks, *result.checks], (*skipped, *result.skipped)
    found = _findings(recipe, design, checks, files, clock, skipped=skipped)
    names = {request: request.filename(recipe.name, recipe.export.files) for request in missing}
    found = replace(found, missing=tuple((names[request], why) for request, why in missing.items()))
    for request in requests:
        if request.format.summarise is not None and request not in missing:
            path = folder / request.filename(recipe.name, recipe.export.files)
            made = request.format.summarise(Run(recipe, design, found, job, clock), request, path)
            found = replace(found, files=(*found.files, *made.files), checks=(*found.checks, *made.checks))
            found = replace(found, stages=tuple(clock.stages))
    return design, found


def content_of(recipe: Recipe, design: Design, findings: Findings, clock: Clock) -> Content:
    """What a page shows of a run."""
    from camgeo.report.page.content import content

    with clock.stage("page"):
        return content(recipe, design, [file for file in findings.files if file.shows_cam])


def _findings(
    recipe: Recipe,
    design: Design,
    checks: list[Check],
    files: list[FileResult],
    clock: Clock,
    *,
    skipped: tuple[tuple[str, str], ...] = (),
) -> Findings:
    """Everything that a run found."""
    linkage = None
    if design.driven is not None:
        from camgeo.report.linkage import linkage_section

        with clock.stage("figures of the linkage"):
            linkage = linkage_section(recipe, design.driven, files)
    results = []
    for capability in registry.in_order(recipe.uses):
        result = capability.examine(recipe, design, [file for file in files if file.shows_cam], clock)
        results.append(result)
        checks = [*checks, *result.checks]
    preload = None
    if design.exact.preload is not None:
        from camgeo.measures.forces import preload_section

        with clock.stage("preload"):
            preload = preload_section(recipe, design)
    if recipe.limits:
        from camgeo.measures.limits import limit_checks

        with clock.stage("limits"):
            runs = {name: values for result in results for name, values in result.runs.items()}
            checks = [*checks, *limit_checks(recipe, design, checks, files, runs)]
    balances: tuple[Balance, ...] = ()
    if recipe.part.density is not None:
        from camgeo.measures.balance import balances_of

        balances = balances_of(recipe, design)
    from camgeo.curve.measures import measures
    from camgeo.measures.remarks import remarks_of, shortened_dwells
    from camgeo.measures.units import displacement_unit

    with clock.stage("remarks"):
        remarks = remarks_of(recipe, design, checks, files)
        remarks += () if design.driven is None else shortened_dwells(design.driven, files)
    return Findings(
        tuple(checks),
        tuple(files),
        tuple(clock.stages),
        skipped,
        design.follower.name,
        linkage=linkage,
        preload=preload,
        sections={name: section for result in results for name, section in result.sections.items()},
        remarks=remarks,
        joints=design.exact.joints,
        table=design.exact.kept,
        displacements=displacement_unit(recipe),
        contours={surface.name: measures(contour) for surface, contour in design.contours},
        balances=balances,
    )
