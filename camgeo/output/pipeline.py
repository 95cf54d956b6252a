"""From a recipe to files on disk and a verdict on them: the plan, its stages, the report.

Each stage runs only where the recipe needs it, and imports its modules when it runs; other stages are listed as
skipped, with the reason. Files are written into a private folder, read back there by kin, and moved to their place only
when every check holds. A file that needs a missing package is left out before anything is fitted. Where a function has
`progress`, it is called with the name of each stage as the stage begins.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from camgeo.common.clock import Clock
from camgeo.common.errors import SurroundingsError
from camgeo.files.errors import MissingExtraError
from camgeo.measures.extension import MEASURES
from camgeo.measures.file_result import FileResult
from camgeo.output.extension import MAKING, OUTPUTS, RunResults
from camgeo.output.file_intent import shaft_of_file
from camgeo.report.document import Findings, as_json, document
from camgeo.synthesis.design import Design, designed
from camgeo.synthesis.intent import permitted
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from camgeo.measures.balance import Balance
    from camgeo.measures.extension import Results
    from camgeo.output.extension import FileCall
    from camgeo.output.sets import FileSet
    from camgeo.output.skipped import Skipped
    from camgeo.recipe.export import FileRequest
    from camgeo.recipe.recipe import Recipe
    from camgeo.report.page.content import Content
    from kin.judge.intent import ShaftIntent
    from kin.numeric.check import Check

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

    `only` has the formats of the files to be made; empty for all that the recipe lists. A file that needs a missing
    package is left out. A failed check raises nothing: the set goes to `out`/<name>.rejected. Raises RecipeErrors where
    no such curve exists or a tolerance cannot be held, SurroundingsError where the disk refuses, or a package is
    missing for all files or for a capability that is used, BusyError where another run of this name is at work.
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
    """Make and judge all files of a recipe in a temporary folder, which is removed.

    A failed check raises nothing. Raises RecipeErrors where no such curve exists or a tolerance cannot be held,
    SurroundingsError where the disk refuses, or a package is missing for all files or for a capability that is used.
    """
    from camgeo.output.output_folder import temporary_folder

    with temporary_folder() as folder:
        _, findings = _produce(recipe, recipe.export.files, folder, Clock(progress))
        demand_any(recipe.path, findings)
        return Outcome(document(recipe, findings), findings.ok, None)


def demand_any(path: Path, findings: Findings) -> None:
    """Raise SurroundingsError where no file was made and a package was missing; `path` is the recipe's."""
    if findings.missing and not findings.files:
        raise SurroundingsError(findings.missing[0][1], path)


def check_and_show(recipe: Recipe, *, progress: Callable[[str], None] | None = None) -> tuple[Outcome, Content]:
    """Outcome of making and judging all files in a temporary folder, which is removed, and the content of its page.

    Pages and other summaries are not made; files that need a missing package are left out, be it all of them. Raises
    RecipeErrors where no such curve exists or a tolerance cannot be held, SurroundingsError where the disk refuses or a
    package of a capability is missing.
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

    `tolerance`, mm, is by default that of the recipe's file of the same name, or of its export. `units` is the unit in
    mm of files that state none, by default the recipe's. Ends in drawings within `gap`, mm, are joined. Raises
    RecipeErrors where there is no such motion or curve, or the recipe lacks what such a file shows; CallError for a gap
    above the tolerance of a drawing, UnitsError where a file states another unit than `units`, ValueError for an
    unknown suffix, OSError where a file cannot be read, SurroundingsError where a package of a capability that the
    recipe uses is missing.
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
    """Report of `judge_files`, and the HTML of the page that shows the files; arguments and errors are the same."""
    from camgeo.report.page.page import page

    clock = Clock()
    design, findings = _judge(recipe, paths, (tolerance, units, gap), clock)
    report = document(recipe, findings)
    return report, page(recipe, content_of(recipe, design, findings, clock), report)


def _judge(
    recipe: Recipe, paths: list[Path], bounds: tuple[float | None, float | None, float | None], clock: Clock
) -> tuple[Design, Findings]:
    """Design and findings on files of any origin.

    `bounds` are the tolerance, the unit of files that state none, and the gap over which ends are joined, all in mm;
    None for the recipe's tolerance, the recipe's unit, no gap.
    """
    from camgeo.output.sets import sets_of
    from camgeo.recipe.export import FileRequest
    from kin.judge.together import DiscFile, verify_set

    tolerance, units, gap = bounds
    _demand(recipe)
    design = designed(recipe, clock)
    # results by the place of a file in the call: sets may take files out of their order
    checks, results = list(design.checks), dict[int, FileResult]()
    skipped: list[Skipped] = []
    for file_set in sets_of(recipe, paths, tolerance):
        kind, request_listed, within = (
            file_set.requirement.kind,
            file_set.requirement.request,
            file_set.requirement.tolerance,
        )
        # a file that the recipe lists is judged as that request says, any other as the nominal part
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
    """Report on the files of `call`, which the capability `name` judges, such as points measured on a part.

    Raises CallError for files that cannot be judged, SurroundingsError where the disk refuses, RecipeErrors where there
    is no such motion or curve, KeyError for a capability that judges no files.
    """
    from camgeo.measures.units import displacement_unit

    judge = OUTPUTS[name].judge
    if judge is None:
        raise KeyError(name)
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
    """Names of the checks between discs that a set without all discs leaves out, each with the reason."""
    lacking = [part.name for rank, part in enumerate(intent.parts) if not {rank, None} & files.discs]
    names = " and ".join(path.name for _, path, _ in files.files)
    why = f"{names} is judged alone: {' and '.join(lacking)} is not among the files that are given"
    return [(closure.name, why) for closure in intent.closures if lacking]


def _demand(recipe: Recipe) -> None:
    """Raise SurroundingsError where a capability that the recipe uses lacks a library."""
    for answers in OUTPUTS.of(recipe.uses):
        answers.demand(recipe)


def _opinions(
    recipe: Recipe, design: Design, files: list[FileResult], checks: list[Check], clock: Clock
) -> list[Results]:
    """Results of the checks that capabilities make of files, beside the judge's; one for each capability used."""
    return [answers.look(recipe, design, files, checks, clock) for answers in OUTPUTS.of(recipe.uses)]


def _produce(recipe: Recipe, requests: tuple[FileRequest, ...], folder: Path, clock: Clock) -> tuple[Design, Findings]:
    """Design and findings of a run of all stages: design, fits, files, verdicts, files that report on the others."""
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
        # all requests are foreseen before the first fit, which may take long
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
    # summaries come last: each shows the findings so far, of earlier summaries too
    for request in requests:
        summarise = MAKING[request.kind].summarise
        if summarise is not None and request not in missing:
            path = folder / request.filename(recipe.name, recipe.export.files)
            product = summarise(RunResults(recipe, design, findings, job, clock), request, path)
            findings = replace(
                findings, files=(*findings.files, *product.files), checks=(*findings.checks, *product.checks)
            )
            findings = replace(findings, stages=tuple(clock.stages))
    return design, findings


def content_of(recipe: Recipe, design: Design, findings: Findings, clock: Clock) -> Content:
    """Content of the page of a run; of its files, the page shows those of the nominal cam."""
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
    """Findings of a run, with the sections, limits and remarks that follow from its checks and files.

    Each step needs the ones before: limits the runs of capabilities, remarks the checks of limits.
    """
    linkage = None
    if design.driven is not None:
        from camgeo.report.linkage import linkage_section

        with clock.stage("figures of the linkage"):
            linkage = linkage_section(recipe, design.driven, files)
    results = []
    for answers in MEASURES.of(recipe.uses):
        result = answers.examine(recipe, design, [file for file in files if file.shows_cam], clock)
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
