"""From the recipe of an axis to files on disk and a verdict on them; as `camgeo.output.pipeline` for a disc."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from camgeo.capabilities.axis.design import designed
from camgeo.capabilities.axis.keys import ADVANCE
from camgeo.capabilities.axis.tables import write_motion
from camgeo.checks.declared import READABLE
from camgeo.common.clock import Clock
from camgeo.common.errors import CallError
from camgeo.common.units import UNIT_MM
from camgeo.formats.tables.controller import rates_of, write_rows
from camgeo.measures.file_result import FileResult
from camgeo.measures.rule_remark import RuleRemark, source_remarks
from camgeo.measures.units import in_units, report_unit
from camgeo.output.pipeline import REPORT, Outcome
from camgeo.recipe.export import FileRequest
from camgeo.report.document import Findings, as_json, document
from kin.judge.drive import drive_checks
from kin.numeric.check import Check, about, failed
from kin.numeric.monotone import RoughError
from kin.numeric.records import dataclass, replace
from kin.read.drive_tables import SLAVES, is_drive, read_drive
from kin.read.errors import ReadError

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from camgeo.capabilities.axis.design import AxisDesign
    from camgeo.capabilities.axis.keys import AxisRecipe

HOUR = 3600.0


@dataclass(frozen=True, eq=False)
class Run:
    """A run: the exact motion, and what follows from the files that were made or given."""

    design: AxisDesign
    findings: Findings

    @property
    def report(self) -> dict[str, Any]:
        """The report as plain data."""
        recipe = self.design.recipe
        report = document(recipe, self.findings)
        report["tolerance"] = recipe.export.tolerance / recipe.scale
        report["tolerance_unit"] = report_unit(recipe, self.design.unit)[1]
        return {**report, "axis": _section(self.design)}


def export(
    recipe: AxisRecipe, out: Path, *, only: tuple[str, ...] = (), progress: Callable[[str], None] | None = None
) -> Outcome:
    """Write and judge the files of an axis under `out`/<name>; where a check fails, to `out`/<name>.rejected.

    `only` names the kinds of the files to be made, by default all; files of other kinds stay. Raises RecipeErrors where
    there is no such motion or a tolerance cannot be held, SurroundingsError where the file system refuses.
    """
    from camgeo.output.output_folder import RunFolder

    requests = tuple(request for request in recipe.export.files if not only or request.kind in only)
    with RunFolder(out, recipe.name) as folder:
        run = _produced(recipe, requests, folder.folder, Clock(progress))
        kept = folder.kept_names() if only else ()
        run = replace(run, findings=replace(run.findings, kept=kept))
        report = run.report
        (folder.folder / REPORT).write_text(as_json(report), encoding="utf-8", newline="\n")
        names = [file.path.name for file in run.findings.files]
        place = folder.commit(names, keep=kept) if run.findings.ok else folder.reject()
    return Outcome(report, run.findings.ok, place)


def check(recipe: AxisRecipe, *, progress: Callable[[str], None] | None = None) -> Outcome:
    """Make and judge all files in a temporary folder that is removed afterwards; raises as `export` does."""
    from camgeo.output.output_folder import temporary_folder

    with temporary_folder() as folder:
        run = _produced(recipe, recipe.export.files, folder, Clock(progress))
        return Outcome(run.report, run.findings.ok, None)


def judged(
    recipe: AxisRecipe, paths: list[Path], tolerance: float | None, units: float | None, gap: float | None
) -> dict[str, Any]:
    """Report on tables for drives of any origin.

    `tolerance`, mm, takes the place of the recipe's where the axis runs along a line, `units` is the unit, mm, of files
    that state none. Raises RecipeErrors where there is no such motion, CallError for a gap, or for a tolerance that is
    a length where the axis turns; OSError where a file cannot be read.
    """
    run, _ = _judged(recipe, paths, tolerance, units, gap)
    return run.report


def judged_and_shown(
    recipe: AxisRecipe, paths: list[Path], tolerance: float | None, units: float | None, gap: float | None
) -> tuple[dict[str, Any], str]:
    """Report of `judged`, and the HTML of the page with the error of each table; arguments and errors are the same."""
    from camgeo.capabilities.axis.axis_page import JudgedTable, page

    run, within = _judged(recipe, paths, tolerance, units, gap)
    mm = recipe.mm if units is None else units
    tables = [JudgedTable(path, most, mm) for path, most in zip(paths, within, strict=True)]
    report = run.report
    return report, page(run.design, report, tables)


def _judged(
    recipe: AxisRecipe, paths: list[Path], tolerance: float | None, units: float | None, gap: float | None
) -> tuple[Run, list[float]]:
    """The run of `judged`, and the tolerance of each file, mm or rad."""
    if gap is not None:
        raise CallError("a gap joins the ends of drawings: leave it out for tables")
    if tolerance is not None and recipe.swings:
        raise CallError("the axis turns: its tolerance is an angle, give it in the recipe as export.tolerance")
    clock = Clock()
    design = designed(recipe, clock)
    files, checks, tolerances = [], design.limit_checks(), []
    for path in paths:
        request = recipe.request_of(path.name)
        within = tolerance or (request and request.tolerance) or recipe.export.tolerance
        with clock.stage("judge csv"):
            found = _table_checks(design, path, request, within, recipe.mm if units is None else units)
        checks += found
        tolerances.append(within)
        files.append(FileResult(path, request or FileRequest("csv", "controller"), units=units))
    return _run(design, files, checks, clock), tolerances


def _table_checks(design: AxisDesign, path: Path, request: FileRequest | None, within: float, mm: float) -> list[Check]:
    """Checks of a table for a drive; one that says why where it is none."""
    if path.suffix.lower() not in {".csv", ".txt"} or not is_drive(path):
        return [about(failed(READABLE.name, "no table for a drive"), path.name)]
    rates = (None, None) if request is None else rates_of(request)
    checks = drive_checks(path, design.driven(within, rates), mm)
    if design.recipe.index and checks[0].name != READABLE.name:
        checks.append(_advance_check(design, path, mm))
    return [about(each, path.name) for each in checks]


def _advance_check(design: AxisDesign, path: Path, mm: float) -> Check:
    """Error of the table's advance of a cycle, which adds up from cycle to cycle."""
    unit = SLAVES["slave_deg"] if design.unit == "deg" else mm
    try:
        slave = read_drive(path, unit).rows.slave[0]
    except ReadError as error:
        return failed(ADVANCE, error.message)
    off = abs(float(slave[-1] - slave[0]) - design.advance) / design.own
    hour, shown = in_units(design.recipe, off * HOUR / design.recipe.cycle, design.unit)
    detail = f"a cycle; {hour or 0.0:.3g} {shown} in an hour where each adds to the last"
    return Check(ADVANCE, True, off, None, design.unit, detail=detail)


def _produced(recipe: AxisRecipe, requests: tuple[FileRequest, ...], folder: Path, clock: Clock) -> Run:
    """Write and judge the requested files in a folder."""
    design = designed(recipe, clock)
    files, checks = [], design.limit_checks()
    sound = all(each.ok for each in checks)
    pages = [request for request in requests if request.format.summary]
    for request in requests if sound else ():
        if request in pages:
            continue
        path = folder / request.filename(recipe.name, recipe.export.files)
        checks += _made(design, request, path, clock)
        files.append(FileResult(path, request, units=UNIT_MM[request.unit_for(recipe.units)]))
    run = _run(design, files, checks, clock)
    for request in pages:
        from camgeo.capabilities.axis.axis_page import page

        path = folder / request.filename(recipe.name, recipe.export.files)
        with clock.stage("page"):
            path.write_text(page(design, run.report), encoding="utf-8", newline="\n")
        files = [*run.findings.files, FileResult(path, request)]
        run = replace(run, findings=replace(run.findings, files=tuple(files), stages=tuple(clock.stages)))
    return run


def _made(design: AxisDesign, request: FileRequest, path: Path, clock: Clock) -> list[Check]:
    """Write a table, and judge one for a controller."""
    recipe = design.recipe
    if request.as_ != "controller":
        with clock.stage("table"):
            write_motion(design, request, path)
        return []
    within = request.tolerance or recipe.export.tolerance
    slave = design.slave(request)
    with clock.stage("controller"):
        try:
            write_rows(recipe, request, slave, within, path)
        except RoughError as error:
            problem = "the motion changes too abruptly for a controller's table"
            raise recipe.error("axis.motion", problem, None, "give a smoother one") from error
    with clock.stage("judge csv"):
        return _table_checks(design, path, request, within, slave.scale)


def _run(design: AxisDesign, files: list[FileResult], checks: list[Check], clock: Clock) -> Run:
    recipe, remarks = design.recipe, source_remarks(design.motion.kept)
    if recipe.index and recipe.modulo is not None and design.advance and design.cycles is None:
        sentence = "no number of cycles brings the axis back to its place: what is left adds up"
        remarks.append(RuleRemark("modulo", None, None, "", sentence))
    findings = Findings(
        tuple(checks),
        tuple(files),
        tuple(clock.stages),
        (),
        "an axis that turns" if recipe.swings else "an axis along a line",
        remarks=tuple(remarks),
        joints=design.joints,
        table=design.motion.kept,
        displacements=report_unit(recipe, design.unit),
    )
    return Run(design, findings)


def _section(design: AxisDesign) -> dict[str, Any]:
    """Section `axis` of the report: kind, speed of the master, figures in time with their places."""
    recipe = design.recipe
    figures = []
    for figure in design.figures:
        value, unit = in_units(recipe, figure.value, figure.unit)
        figures.append({"name": figure.name, "value": value, "unit": unit, "at_deg": figure.at})
    section: dict[str, Any] = {"kind": recipe.kind, "rpm": recipe.rpm, "index": recipe.index, "figures": figures}
    if recipe.modulo is not None:
        section["modulo"] = recipe.modulo / recipe.scale
    return section
