"""From a recipe to files on disk and a verdict on them: the plan, its stages, the report.

Each stage runs only where the recipe needs it, and imports its modules when it runs; other stages are listed as
skipped, with the reason. Files are written into a private folder, read back there by kin, and moved to their place only
when every check holds. A file that needs a missing package is left out before anything is fitted.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from camgeo.common.clock import Clock
from camgeo.common.errors import SurroundingsError
from camgeo.files.errors import MissingExtraError
from camgeo.measures.file_result import FileResult
from camgeo.output.file_intent import shaft_of_file
from camgeo.registry import registry
from camgeo.registry.formats import RunResults
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
    """Outcome of one recipe: its report, whether every check held, and the folder with its files.

    The folder is None where the files were made in a temporary one.
    """

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
    """Write a recipe's files into a private folder, judge them there, and move them to `out`/<name> if all checks hold.

    A file that a missing package would make is left out. Raises RecipeErrors where no such curve exists or a tolerance
    cannot be held, SurroundingsError where the disk does not do what it should, or none of the files can be made. A
    failed check raises nothing: the set goes to `out`/<name>.rejected.
    """
    from camgeo.output.output_folder import RunFolder

    clock = Clock(progress)
    requests = tuple(request for request in recipe.export.files if not only or request.kind in only)
    with RunFolder(out, recipe.name) as run:
        _, findings = _produce(recipe, requests, run.folder, clock)
        demand_any(recipe.path, findings)
        kept_names = run.kept_names() if only else ()
        report = document(recipe, replace(findings, kept=kept_names))
        (run.folder / REPORT).write_text(as_json(report), encoding="utf-8", newline="\n")
        names = [file.path.name for file in findings.files]
        folder = run.commit(names, keep=kept_names) if findings.ok else run.reject()
    return Outcome(report, findings.ok, folder)


def check(recipe: Recipe, *, progress: Callable[[str], None] | None = None) -> Outcome:
    """Make and judge everything in a temporary folder that goes.

    A failed check raises nothing. Raises RecipeErrors where no such curve exists or a tolerance cannot be held,
    SurroundingsError where the disk refuses, or a package is missing for all files or for a capability that is used.
    """
    from camgeo.output.output_folder import temporary_folder

    with temporary_folder() as folder:
        _, findings = _produce(recipe, recipe.export.files, folder, Clock(progress))
        demand_any(recipe.path, findings)
        return Outcome(document(recipe, findings), findings.ok, None)


def demand_any(path: Path, findings: Findings) -> None:
    """Raise SurroundingsError, of the recipe's path, where packages are missing for every file."""
    if findings.missing and not findings.files:
        raise SurroundingsError(findings.missing[0][1], path)


def check_and_show(recipe: Recipe, *, progress: Callable[[str], None] | None = None) -> tuple[Outcome, Content]:
    """Outcome of making and judging everything in a temporary folder that goes, and the content of its page.

    Pages and other summaries are not made, and no file is demanded. Raises RecipeErrors where no such curve exists or a
    tolerance cannot be held, SurroundingsError where the disk refuses or a package of a capability is missing.
    """
    from camgeo.output.output_folder import temporary_folder

    clock = Clock(progress)
    requests = tuple(request for request in recipe.export.files if not request.format.summary)
    with temporary_folder() as folder:
        design, findings = _produce(recipe, requests, folder, clock)
        return Outcome(document(recipe, findings), findings.ok, None), content_of(recipe, design, findings, clock)


def judge_files(
    recipe: Recipe,
    paths: list[Path],
    tolerance: float | None = None,
    units: float | None = None,
    gap: float | None = None,
) -> dict[str, Any]:
    """Report on files of any origin, judged by a recipe's motion.

    `tolerance`, mm, is by default that of the recipe's file of the same name, or of its export. `units`, mm, is the
    unit of files that state none; raises UnitsError where a file states another. Ends in drawings within `gap`, mm, are
    joined; raises CallError for a gap above the tolerance of a drawing. Raises RecipeErrors where there is no such
    motion or curve, SurroundingsError where a package of a capability that the recipe uses is missing.
    """
    _, findings = _judge(recipe, paths, (tolerance, units, gap), Clock())
    return document(recipe, findings)


def judge_and_show(
    recipe: Recipe,
    paths: list[Path],
    tolerance: float | None = None,
    units: float | None = None,
    gap: float | None = None,
) -> tuple[dict[str, Any], str]:
    """Report on files of any origin, judged by a recipe's motion, and the HTML of the page that shows them.

    `tolerance`, mm, is by default that of the recipe's file of the same name, or of its export. `units`, mm, is the
    unit of files that state none; raises UnitsError where a file states another. Ends in drawings within `gap`, mm, are
    joined; raises CallError for a gap above the tolerance of a drawing. Raises RecipeErrors where there is no such
    motion or curve, SurroundingsError where a package of a capability that the recipe uses is missing.
    """
    from camgeo.report.page.page import page

    clock = Clock()
    design, findings = _judge(recipe, paths, (tolerance, units, gap), clock)
    report = document(recipe, findings)
    return report, page(recipe, content_of(recipe, design, findings, clock), report)


def _judge(
    recipe: Recipe, paths: list[Path], bounds: tuple[float | None, float | None, float | None], clock: Clock
) -> tuple[Design, Findings]:
    """Design and findings on files of any origin.

    `bounds` are the tolerance, the unit of files that state none, and the gap over which ends are joined, mm; None for
    those of the recipe. Raises CallError for a gap above the tolerance of a drawing.
    """
    from camgeo.common.errors import CallError
    from camgeo.output.sets import sets_of
    from camgeo.recipe.export import FileRequest
    from kin.judge.together import DiscFile, verify_set
    from kin.read.formats import FORMATS

    tolerance, units, gap = bounds
    _demand(recipe)
    design = designed(recipe, clock)
    checks, results = list(design.checks), dict[int, FileResult]()
    skipped: list[Skipped] = []
    for file_set in sets_of(recipe, paths, tolerance):
        kind, request_listed, within = (
            file_set.requirement.kind,
            file_set.requirement.request,
            file_set.requirement.tolerance,
        )
        if gap is not None and gap > within and FORMATS[kind].contents == "drawing":
            message = (
                f"a gap of {gap / recipe.mm:.9g} {recipe.units} is more than the tolerance, {within / recipe.mm:.9g}"
            )
            raise CallError(f"{message}, of {file_set.files[0][1].name}: give at most that")
        with clock.stage("judge"):
            request = FileRequest(kind) if request_listed is None else request_listed
            file_recipe = recipe if request_listed is None else recipe.in_units_of(request_listed)
            intent = shaft_of_file(file_recipe, design, kind, request.compensation, recipe.field_of(request_listed))
            unstated = [recipe.unstated_unit(path) if units is None else units for _, path, _ in file_set.files]
            discs = [DiscFile(path, disc, mm) for (_, path, disc), mm in zip(file_set.files, unstated, strict=True)]
            verdicts = verify_set(discs, intent, recipe.verify.angles, permitted(recipe, within, gap))
        for (place, path, disc), verdict in zip(file_set.files, verdicts, strict=True):
            file_request = FileRequest(verdict.kind, compensation=request.compensation)
            rank = disc if len(intent.parts) > 1 else None
            results[place] = replace(FileResult.of(path, file_request, within, verdict), disc=rank)
            checks += verdict.checks
        skipped += _lacking_discs(file_set, intent)
    files = [results[place] for place in sorted(results)]
    for result in _opinions(recipe, design, files, checks, clock):
        checks, skipped = [*checks, *result.checks], [*skipped, *result.skipped]
    return design, _findings(recipe, design, checks, files, clock, skipped=tuple(skipped))


def judge_claimed(recipe: Recipe, name: str, call: FileCall) -> dict[str, Any]:
    """Report on files that the capability `name` claims, such as points measured on a part.

    Raises CallError for files that cannot be judged, SurroundingsError where the disk refuses, RecipeErrors where the
    recipe has no such motion or curve.
    """
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


def _lacking_discs(files: FileSet, intent: ShaftIntent) -> list[Skipped]:
    """Skipped checks of a set that lacks a disc, with the reason."""
    lacking = [part.name for rank, part in enumerate(intent.parts) if not {rank, None} & files.discs]
    names = " and ".join(path.name for _, path, _ in files.files)
    why = f"{names} is judged alone: {' and '.join(lacking)} is not among the files that are given"
    return [(closure.name, why) for closure in intent.closures if lacking]


def _demand(recipe: Recipe) -> None:
    """Raise SurroundingsError where a capability that the recipe uses lacks a library."""
    for capability in registry.in_order(recipe.uses):
        capability.demand(recipe)


def _opinions(
    recipe: Recipe, design: Design, files: list[FileResult], checks: list[Check], clock: Clock
) -> list[Results]:
    """Results of the capabilities' own looks at files, beside the judge's."""
    capabilities = registry.in_order(recipe.uses)
    return [capability.look(recipe, design, files, checks, clock) for capability in capabilities]


def _produce(recipe: Recipe, requests: tuple[FileRequest, ...], folder: Path, clock: Clock) -> tuple[Design, Findings]:
    """Design and findings of a run of all stages: design, fits, files, verdicts, page."""
    from camgeo.output.skipped import skipped_items

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
            product = make(job, request, folder / request.filename(recipe.name, recipe.export.files))
            files += product.files
            checks += product.checks
    skipped = skipped_items(recipe, requests, design)
    for result in _opinions(recipe, design, files, checks, clock):
        checks, skipped = [*checks, *result.checks], (*skipped, *result.skipped)
    findings = _findings(recipe, design, checks, files, clock, skipped=skipped)
    names = {request: request.filename(recipe.name, recipe.export.files) for request in missing}
    findings = replace(findings, missing=tuple((names[request], why) for request, why in missing.items()))
    for request in requests:
        if request.format.summarise is not None and request not in missing:
            path = folder / request.filename(recipe.name, recipe.export.files)
            product = request.format.summarise(RunResults(recipe, design, findings, job, clock), request, path)
            findings = replace(
                findings, files=(*findings.files, *product.files), checks=(*findings.checks, *product.checks)
            )
            findings = replace(findings, stages=tuple(clock.stages))
    return design, findings


def content_of(recipe: Recipe, design: Design, findings: Findings, clock: Clock) -> Content:
    """Content of the page of a run."""
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
    """Findings of a run, with the sections, limits and remarks that follow from its checks and files."""
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
