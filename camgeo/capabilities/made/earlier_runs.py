"""Points of earlier runs beside an export: deviations of each run, what corrected files take off, and their table."""

from __future__ import annotations

import math
from html import escape
from itertools import chain
from typing import TYPE_CHECKING, Any

import numpy as np

from camgeo.capabilities.made.correction import LOOKS, runs_made, takes_local, total_deviations
from camgeo.capabilities.made.keys import CORRECT, LEAVE, LOCAL, TAKE, Made
from camgeo.capabilities.made.made_part import follower_motion
from camgeo.common.terminal import escaped
from camgeo.measures.extension import Results
from camgeo.measures.rule_remark import RuleRemark
from camgeo.measures.units import UNIT_NAMES, report_unit
from camgeo.report.document import align
from kin.follower.recognised import COVERAGE
from kin.made.motion import contact_errors, paired
from kin.numeric.angles import degrees
from kin.numeric.feet import equal_steps

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from camgeo.capabilities.made.correction import RunMade
    from camgeo.capabilities.made.run_faults import RunFault
    from camgeo.common.clock import Clock
    from camgeo.recipe.recipe import Recipe
    from camgeo.synthesis.design import Design
    from kin.made.smooth import Smooth

HEAD = ("run", "surface", "points", "greatest", "at", "rms", "+-", "files differ by")
NOTE = (
    "Smoothed deviations, above 0 where metal is too much; of their sum over all runs `correct` takes off a share. "
    "Local faults that a single run has are left out of it, unless the file says `local: take`."
)


def examine(recipe: Recipe, design: Design, clock: Clock) -> Results:
    """Section `made` of an export's report on the runs; no section without `made.points` or without a contour.

    Raises RecipeErrors for points that are not of this part, and for a contour with trimmed undercut.
    """
    made = recipe.of(Made)
    if made is None or not made.points or not design.contours:
        return Results()
    if design.trimmed:
        problem = "a contour whose undercut is cut off is not held against points"
        raise recipe.error("made.points", problem, None, "give undercut: refuse")
    with clock.stage("made"):
        runs = runs_made(recipe, design)
    totals = total_deviations(runs)
    error = sum(run.error for run in runs)
    entry = {
        "unit": UNIT_NAMES[recipe.units],
        "runs": [_run(recipe, design, run, runs) for run in runs],
        "systematic": [_surface(recipe, design, name, total, error) for name, total in totals.items()],
        "corrections": [
            _correction(recipe, design, total_deviations(runs, local=taking), error, (share, names))
            | {LOCAL.name: word}
            for (share, taking), names in _corrected_files(recipe).items()
            for word in (TAKE if taking else LEAVE,)
        ],
    }
    return Results({"made": entry})


def _run(recipe: Recipe, design: Design, run: RunMade, runs: Sequence[RunMade]) -> dict[str, Any]:
    """Report entry of a run: deviation of each surface, its local faults, and by how much several files differ."""
    surfaces = []
    for name, curve in run.curves.items():
        entry = {"points": run.points[name], "spans": curve.spans, **_surface(recipe, design, name, curve, run.error)}
        if (scatter := run.scatter[name]) is not None:
            entry["files_differ_by"] = scatter / recipe.mm
        if faults := run.counted[name].faults:
            entry["local"] = [_local(recipe, design, name, own, runs) for own in faults]
        surfaces.append(entry)
    return {"files": list(run.files), "surfaces": surfaces}


def left_out(recipe: Recipe, design: Design) -> Sequence[RuleRemark]:
    """Remark on the local faults that corrected files leave out; none without such files and faults.

    Raises RecipeErrors as `runs_made` does.
    """
    leaving = [names for (_, taking), names in _corrected_files(recipe).items() if not taking]
    if not leaving or not design.contours or design.trimmed:
        return ()
    words = []
    for run in runs_made(recipe, design):
        for name, own in run.counted.items():
            entries = [_local(recipe, design, name, fault, ()) for fault in own.faults if fault.first is None]
            places = ", ".join(f"{entry['height']:+.3g} at {entry['at_deg']:.4g} deg" for entry in entries)
            words += [f"{', '.join(run.files)}{f' on {name}' if name else ''}: {places}"] if places else []
    if not words:
        return ()
    files = ", ".join(chain.from_iterable(leaving))
    sentence = (
        f"local faults of a single run are not taken off in {files} ({'; '.join(words)} {UNIT_NAMES[recipe.units]})"
    )
    return (RuleRemark("local-fault", None, None, "", f"{sentence}; `local: take` takes them"),)


def _local(recipe: Recipe, design: Design, name: str, own: RunFault, runs: Sequence[RunMade]) -> dict[str, Any]:
    """Report entry of a local fault: height, its uncertainty (k = 2), place, and the first run that has it too."""
    fault = own.fault
    places = design.exact.gauges[name].shaft_angle(np.array([fault.at, fault.begin, fault.end]))
    entry: dict[str, Any] = {"height": fault.height / recipe.mm, "uncertainty": COVERAGE * fault.sd / recipe.mm}
    entry |= {key: degrees(float(at)) for key, at in zip(("at_deg", "from_deg", "to_deg"), places, strict=True)}
    return entry | {"shared_with": None if own.first is None else list(runs[own.first].files)}


def _surface(recipe: Recipe, design: Design, name: str, curve: Smooth, error: float) -> dict[str, Any]:
    """Report entry of a surface's smoothed deviation: greatest, its shaft angle, root mean square, uncertainty (k = 2).

    `error`, mm, is the expanded uncertainty that is common to all points.
    """
    t = equal_steps(LOOKS)
    e = curve.rows(t)[0]
    worst = int(np.argmax(np.abs(e)))
    return {
        "name": name,
        "greatest": float(e[worst]) / recipe.mm,
        "at_deg": degrees(float(design.exact.gauges[name].shaft_angle(t[worst : worst + 1])[0])),
        "rms": float(np.sqrt(np.mean(e**2))) / recipe.mm,
        "uncertainty": math.hypot(COVERAGE * float(curve.standard_deviations(t).max()), error) / recipe.mm,
    }


def _corrected_files(recipe: Recipe) -> dict[tuple[float, bool], list[str]]:
    """Names of the corrected files, by the share of the deviations that is taken off, and whether local faults are."""
    files: dict[tuple[float, bool], list[str]] = {}
    for request in recipe.export.files:
        for file in request.compensation.altered if request.compensation else ():
            if file.key == CORRECT.name:
                files.setdefault((file.value, takes_local(file)), []).extend(recipe.filenames(request))
    return files


def _correction(
    recipe: Recipe, design: Design, totals: Mapping[str, Smooth], error: float, corrected: tuple[float, list[str]]
) -> dict[str, Any]:
    """Report entry of a correction: its share and its files, the contour's change, and the motion.

    The greatest change of the contour and its uncertainty are in the recipe's unit. The motion is that of a part made
    exactly as those files are drawn, in the recipe's unit or degrees. `error`, mm, is the sum of the expanded
    uncertainties that the runs state. `corrected` is the share and the names of the files.
    """
    (share, names), t = corrected, equal_steps(LOOKS)
    shaft = equal_steps(recipe.verify.angles)
    by_surface, greatest, uncertain = {}, 0.0, 0.0
    for surface in design.exact.surfaces:
        gauge, curve = design.exact.gauges[surface.name], totals[surface.name].times(-share)
        by_surface[surface.name] = paired(gauge, contact_errors(gauge, surface.side, curve, shaft))
        e = curve.rows(t)[0]
        greatest = max(greatest, float(e.max()), float(e.min()), key=abs)
        uncertain = max(uncertain, COVERAGE * float(curve.standard_deviations(t).max()))
    motion, _ = follower_motion(design, by_surface)
    scale, unit = report_unit(recipe, design.exact.gauge.unit)
    worst = int(np.argmax(np.abs(motion.remaining)))
    return {
        CORRECT.name: share,
        "files": names,
        "greatest": greatest / recipe.mm,
        "uncertainty": math.hypot(uncertain, share * error) / recipe.mm,
        "motion": {
            "unit": unit,
            "offset": scale * motion.offset,
            "change": scale * float(motion.remaining[worst]),
            "at_deg": degrees(float(motion.shaft[worst])),
        },
    }


# --- as a table -------------------------------------------------------------------------------------------------------


def _rows(section: dict[str, Any]) -> list[tuple[str, ...]]:
    """Rows of cells below `HEAD`: surfaces of each run, sums over all runs, and each correction with its motion."""
    runs = [(", ".join(run["files"]), surface) for run in section["runs"] for surface in run["surfaces"]]
    rows = []
    for files, surface in runs:
        rows.append(_row(files, surface))
        for fault in surface.get("local", ()):
            with_run = fault["shared_with"]
            fate = "left out" if with_run is None else f"the machine's, as in {', '.join(with_run)}"
            place = f"{fault['height']:+.4g}", f"{fault['at_deg']:.2f} deg", "", f"{fault['uncertainty']:.2g}"
            rows.append((f"  local, {fate}", surface["name"], "", *place, ""))
    rows += [_row("sum", surface) for surface in section["systematic"]]
    for correction in section["corrections"]:
        motion, most = correction["motion"], f"{correction['greatest']:+.4g}"
        files = f"{', '.join(correction['files'])}: {correction['correct']:g} of the sum"
        files += ", with local faults" if correction["local"] == TAKE else ""
        rows.append((files, "", "", most, "", "", f"{correction['uncertainty']:.2g}", ""))
        change = f"{motion['change']:+.4g}", f"{motion['at_deg']:.2f} deg"
        rows.append((f"  so its motion changes, {motion['unit']}", "", "", *change, "", "", ""))
    return rows


def _row(name: str, surface: dict[str, Any]) -> tuple[str, ...]:
    """Cells of a surface's entry, `name` the first of them."""
    differ = surface.get("files_differ_by")
    figures = f"{surface['greatest']:+.4g}", f"{surface['at_deg']:.2f} deg", f"{surface['rms']:.4g}"
    points = str(surface.get("points", ""))
    unsure = f"{surface['uncertainty']:.2g}"
    return name, surface["name"], points, *figures, unsure, "" if differ is None else f"{differ:.2g}"


def _section(report: dict[str, Any]) -> dict[str, Any] | None:
    """The section `made` of an export's report; None without runs."""
    section: dict[str, Any] = report.get("made", {})
    return section if "runs" in section else None


def lines(report: dict[str, Any]) -> str:
    """Table of runs and corrections for the terminal; empty without runs."""
    section = _section(report)
    if section is None:
        return ""
    rows = [tuple(map(escaped, row)) for row in _rows(section)]
    return align([(f"{HEAD[0]}, {section['unit']}", *HEAD[1:]), *rows])


def panel(report: dict[str, Any]) -> str:
    """HTML section of the page with the table of runs and corrections; empty without runs."""
    from camgeo.report.page.tables import html_table, named_row

    section = _section(report)
    if section is None:
        return ""
    rows = [named_row(*(escape(cell.strip()) for cell in row)) for row in _rows(section)]
    head = '<section aria-labelledby="runs-head"><h2 id="runs-head">Parts that were made</h2>'
    return f"{head}<p>{NOTE} Lengths in {section['unit']}.</p>{html_table('Runs', HEAD, rows)}</section>"
