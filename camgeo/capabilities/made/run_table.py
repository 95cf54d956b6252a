"""Runs of parts, and what corrected files take off, as a table: for the terminal, and as a panel of the page."""

from __future__ import annotations

from html import escape
from typing import TYPE_CHECKING, Any

from camgeo.common.terminal import escaped
from camgeo.report.document import align

if TYPE_CHECKING:
    from collections.abc import Sequence

HEAD = ("run", "surface", "points", "greatest", "at", "rms", "+-", "files differ by")
NOTE = "Smoothed deviations, above 0 where metal is too much; of their sum over all runs `correct` takes off a share."


def rows_of(section: dict[str, Any]) -> list[tuple[str, ...]]:
    """Rows below `HEAD`: each run's surfaces, the sums over all runs, and what each share of them takes off."""
    runs = [(", ".join(run["files"]), surface) for run in section["runs"] for surface in run["surfaces"]]
    rows = [_row(files, surface) for files, surface in runs]
    rows += [_row("sum", surface) for surface in section["systematic"]]
    for correction in section["corrections"]:
        motion, most = correction["motion"], f"{correction['greatest']:+.4g}"
        files = f"{', '.join(correction['files'])}: {correction['correct']:g} of the sum"
        rows.append((files, "", "", most, "", "", f"{correction['uncertainty']:.2g}", ""))
        change = f"{motion['change']:+.4g}", f"{motion['at_deg']:.2f} deg"
        rows.append((f"  so its motion changes, {motion['unit']}", "", "", *change, "", "", ""))
    return rows


def _row(name: str, surface: dict[str, Any]) -> tuple[str, ...]:
    differ = surface.get("files_differ_by")
    figures = f"{surface['greatest']:+.4g}", f"{surface['at_deg']:.2f} deg", f"{surface['rms']:.4g}"
    points = str(surface.get("points", ""))
    unsure = f"{surface['uncertainty']:.2g}"
    return name, surface["name"], points, *figures, unsure, "" if differ is None else f"{differ:.2g}"


def _section(report: dict[str, Any]) -> dict[str, Any] | None:
    """The section of an export; None of a report without runs."""
    section: dict[str, Any] = report.get("made", {})
    return section if "runs" in section else None


def lines(report: dict[str, Any]) -> str:
    """The table for the terminal; empty without runs."""
    section = _section(report)
    if section is None:
        return ""
    rows = [tuple(map(escaped, row)) for row in rows_of(section)]
    return align([(f"{HEAD[0]}, {section['unit']}", *HEAD[1:]), *rows])


def panel(report: dict[str, Any]) -> str:
    """The table as a section of the page; empty without runs."""
    from camgeo.report.page.tables import html_table

    section = _section(report)
    if section is None:
        return ""
    rows = [_html(row) for row in rows_of(section)]
    head = '<section aria-labelledby="runs-head"><h2 id="runs-head">Parts that were made</h2>'
    return f"{head}<p>{NOTE} Lengths in {section['unit']}.</p>{html_table('Runs', HEAD, rows)}</section>"


def _html(row: Sequence[str]) -> str:
    name, *cells = (escape(cell.strip()) for cell in row)
    return f'<tr><th scope="row">{name}</th>{"".join(f"<td>{cell}</td>" for cell in cells)}</tr>'
