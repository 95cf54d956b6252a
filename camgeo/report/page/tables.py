"""Tables of the report as HTML: checks with failed ones first, files, the linkage, skipped things."""

from __future__ import annotations

import math
from html import escape
from typing import TYPE_CHECKING, Any
from urllib.parse import quote

from camgeo.checks.declared import declaration
from camgeo.measures.units import in_pounds
from camgeo.registry.formats import FORMATS
from camgeo.report.document import error_text, pieces_word, value_text
from camgeo.report.limit_words import sign, title

if TYPE_CHECKING:
    from collections.abc import Sequence

    Row = tuple[str, float | None, str, float | None]  # name, value, unit, shaft angle in degrees

NONE = "–"
MANY = 40  # checks, beyond which those of files that hold are folded up


def failing_count(checks: Sequence[dict[str, Any]]) -> str:
    """Return the number of failed checks in words: `2 checks of 30 fail`."""
    count = sum(not check["ok"] for check in checks)
    return f"{count} check{'s' * (count != 1)} of {len(checks)} fail{'s' * (count == 1)}"


def checks(report: dict[str, Any]) -> str:
    """Return the table of checks, failed ones first; a place is a button that turns the shaft to it.

    Of more than `MANY`, the checks of files that hold are folded up, file by file.
    """
    listed: list[dict[str, Any]] = sorted(report["checks"], key=lambda check: bool(check["ok"]))
    folded: dict[str, list[dict[str, Any]]] = {}
    if len(listed) > MANY:
        for check in listed:
            if check["ok"] and check.get("file"):
                folded.setdefault(check["file"], []).append(check)
        listed = [check for check in listed if not check["ok"] or not check.get("file")]
    linked = "linkage" in report
    noted = [_remark(remark) for remark in report.get("remarks", ())]
    head = ("", "check", "value", "unit", "limit", "at", "file")
    failing_first = sum(not check["ok"] for check in listed)
    rows = [_check(check, linked=linked) for check in listed]
    text = html_table("Checks", head, [*rows[:failing_first], *noted, *rows[failing_first:]], "checks")
    for file, holding in folded.items():
        rows = [_check(check, linked=linked) for check in holding]
        heading = f"{len(holding)} check{'s' * (len(holding) != 1)} of {escape(file)} hold{'s' * (len(holding) == 1)}"
        table = html_table(f"Checks of {escape(file)}", head, rows, "checks")
        text += f'<details class="file"><summary>{heading}</summary>{table}</details>'
    return text


def _check(check: dict[str, Any], *, linked: bool) -> str:
    side = {">=": "≥", "<=": "≤"}.get(sign(check), sign(check))
    bound = check.get("pounds", check).get("limit")
    limit = NONE if bound is None else f"{escape(side)} {number(bound)}"
    declared = declaration(check["name"])
    # a check of the cam in its frame has the relative angle as its place (docs/report.md)
    over = "relative" if linked and declared is not None and declared.in_frame else "shaft"
    state = ("ok", "holds") if check["ok"] else ("failed", "fails")
    return _row(state, check, limit, over, check.get("detail", ""))


def _remark(remark: dict[str, Any]) -> str:
    rule = remark["rule"]
    usual = NONE if rule is None else f"{'≥' if remark['value'] < rule else '≤'} {number(rule)}"
    return _row(("remark", "remark"), remark, usual, "shaft", remark["sentence"])


def _row(state: tuple[str, str], check: dict[str, Any], limit: str, over: str, text: str) -> str:
    """Return the row of a check or a remark; `state` is its class and its word."""
    figures = check.get("pounds", check)
    value = number(figures["value"])
    if state[1] == "holds" and check["value"] is not None:
        value = _with_hint(value_text({**check, **figures}), figures["value"])
    detail = f'<div class="detail">{escape(text)}</div>' if text else ""
    return (
        f'<tr class="{state[0]}"><td class="state">{state[1]}</td>'
        f'<th scope="row">{escape(title(check))}{detail}</th>'
        f'<td class="number">{value}</td>'
        f"<td>{beside(figures['unit'], check['value'], check['unit'])}</td>{_cell(limit, 'number')}"
        f"{_cell(place(check, over))}"
        f"{_cell(escape(check.get('file', '')), 'file')}</tr>"
    )


def file_table(report: dict[str, Any]) -> str:
    """Return the table of files."""
    rows = []
    for file in (
        {**file_entry, **surface} for file_entry in report["files"] for surface in file_entry.get("surfaces") or [{}]
    ):
        if file.get("stale"):
            cells = ["left as it was", *[NONE] * 6]
        else:
            motion = file.get("motion") or {}
            pieces = f"{file['pieces']} {pieces_word(file)}" if file.get("pieces") else NONE
            unit = escape(_unit(motion.get("unit", "")))
            cells = [
                _bytes(file["bytes"]),
                pieces,
                *(number(file.get(key)) for key in ("tolerance", "geometry_error")),
                _error(file.get("measured_error"), file),
                f"{_error(motion.get('max'), file)} {unit}".strip(),
                _error(motion.get("rms"), file),
            ]
        body = "".join(f'<td class="number">{cell}</td>' for cell in cells)
        link = f'<a href="{quote(file["path"])}">{escape(file["path"])}</a>'
        surface = f" {escape(file['name'])}" if "name" in file else ""
        rows.append(f'<tr><th scope="row">{link}{surface}</th>{body}</tr>')
    if not rows:
        return "<p>No files were made.</p>"
    unit = "in" if report["units"] == "inch" else "mm"
    head = ("file", "size", "pieces", f"tolerance, {unit}", "proved", "measured", "motion error", "rms")
    return html_table("Files", head, rows)


def linkage(report: dict[str, Any]) -> str:
    """Return the section of the linkage; empty for a recipe without one."""
    section = report.get("linkage")
    if section is None:
        return ""
    text = [
        f'<tr><th scope="row">{name}</th><td class="number">{_error(value, {})}</td><td>{_unit(unit)}</td>'
        f"<td>{place_button(shaft_deg, 'shaft')}</td></tr>"
        for name, value, unit, shaft_deg in _linkage_rows(section)
    ]
    spans = [("binds", section["binds_at_deg"]), ("would turn the shaft back", section["reverses_at_deg"])]
    warnings = "".join(
        f'<p class="failed">It {verb} from {number(a)}° to {number(b)}° of the relative angle.</p>'
        for verb, ranges in spans
        for a, b in ranges
    )
    head = html_table(f"Linkage: {section['kind']}", ("figure", "value", "unit", "at"), text)
    return f'<section aria-labelledby="linkage-head"><h2 id="linkage-head">Linkage</h2>{warnings}{head}</section>'


def _linkage_rows(section: dict[str, Any]) -> list[Row]:
    """Figures of a linkage: name, value, unit and shaft angle in degrees."""
    margin, rate = section["margin"], section["shaft_rate"]
    rows: list[Row] = [
        ("margin from binding", margin["value"], margin["unit"], None),
        ("least rate of the shaft", rate["min"], "", None),
    ]
    output = section.get("output")
    if output is not None:
        peaks, unit = section["peaks"]["shaft"], output["unit"]
        velocity, acceleration = peaks["velocity"], peaks["acceleration"]
        transmission, force = section["transmission_angle"], section["force_angle"]
        rows += [
            ("least output", output["min"], unit, output["min_at"]["shaft_deg"]),
            ("greatest output", output["max"], unit, output["max_at"]["shaft_deg"]),
            ("swing", section["swing"], unit, None),
            ("least transmission angle", transmission["min"], "deg", transmission["min_at_deg"]),
            ("least force angle", force["min"], "deg", force["min_at_deg"]),
            ("greatest velocity", velocity["value"], f"{unit}/rad", velocity["shaft_deg"]),
            ("greatest acceleration", acceleration["value"], f"{unit}/rad²", acceleration["shaft_deg"]),
        ]
    for dwell in section["dwells"]:
        if dwell["over"] == "shaft":
            name = f"dwell within {number(dwell['band'])}, {dwell['from']}"
            rows.append((escape(name), dwell["length_deg"], "deg", dwell["start_deg"]))
    error = section.get("error")
    if error is not None:
        rows.append(("error of the output, worst file", error["max"], error["unit"], error["at_deg"]))
    return rows


def preload(report: dict[str, Any]) -> str:
    """Return the section of the preload: its force, and the loads that lift contacts off; empty without a preload."""
    section = report.get("preload")
    if section is None:
        return ""
    sentence = f"The metal and both contacts overlap by {number(section['interference'])} {section['unit']} together."
    table = ""
    if "force" in section:
        force = section["force"]
        cells = [
            (f"{word} preload", force[key], force["unit"], force[f"{key}_at_deg"])
            for word, key in (("least", "min"), ("greatest", "max"))
        ]
        cells += [
            (f"load that lifts {contact['contact']} off", contact["load"], contact["unit"], contact["at_deg"])
            for contact in section["lost"]
        ]
        table = figure_table("Preload", cells, report["units"])
    return (
        f'<section aria-labelledby="preload-head"><h2 id="preload-head">Preload</h2><p>{sentence}</p>{table}</section>'
    )


def figure_table(title: str, figures: Sequence[Row], units: str) -> str:
    """Return an HTML table of figures: (name, value, unit, shaft angle in degrees), None where there is no angle.

    Where `units` is `inch`, forces, moments and pressures are in pounds, with the SI value behind.
    """
    rows = []
    for name, si_value, si, shaft_deg in figures:
        value, unit = in_pounds(units, si_value, si)
        cells = f'<td class="number">{number(value)}</td><td>{beside(unit, si_value, si)}</td>'
        cells += f"<td>{place_button(shaft_deg, 'shaft')}</td>"
        rows.append(f'<tr><th scope="row">{escape(name)}</th>{cells}</tr>')
    return html_table(title, ("figure", "value", "unit", "at"), rows)


def skipped_list(report: dict[str, Any]) -> str:
    """Return the items of a list of what was left out, with the reasons; pages and other summaries are not listed."""
    words = {item["what"] for item in report["skipped"]}
    pages = {word for word in words if word in FORMATS and FORMATS[word].summary}
    items = [item for item in report["skipped"] if item["what"] not in pages]
    return "".join(f"<li><b>{escape(item['what'])}</b>: {escape(item['why'])}</li>" for item in items)


def facts(report: dict[str, Any], runs: str) -> str:
    """Return one line about the recipe: follower, how its input `runs`, tolerance."""
    unit = report.get("tolerance_unit") or ("in" if report["units"] == "inch" else "mm")
    kind = report["follower"]
    if "linkage" in report:
        linkage = report["linkage"]["kind"].replace("inverted-", "inverted ")
        kind += f" in {'an' if linkage[0] in 'aeiou' else 'a'} {linkage}"
    return escape(f"{kind} · {runs} · tolerance {report['tolerance']:.6g} {unit}")


def number(value: float | None) -> str:
    """Return HTML of a figure to six digits, with its exact value as a hint where it has more; a dash for None."""
    return NONE if value is None else _with_hint(f"{value:.6g}", value)


def degrees(value: float) -> str:
    """Return an angle, degrees, to a hundredth, with the exact value as a hint."""
    return _with_hint(f"{value:.2f}", value)


def _error(value: float | None, file: dict[str, Any]) -> str:
    """Return a measured error of a file; `below rounding` where it is only rounding."""
    return NONE if value is None else _with_hint(error_text(value, limit=file.get("tolerance")), value)


def _with_hint(short: str, value: float) -> str:
    return short if short == f"{value:.6g}" and float(short) == value else f'<span title="{value!r}">{short}</span>'


def place(entry: dict[str, Any], over: str) -> str:
    """Return a button that moves the mechanism to the place of a check or a remark; a dash without one."""
    if "at" not in entry:
        return place_button(entry["at_deg"], over)
    at, unit = entry["at"], entry["at_unit"]
    if at is None:
        return NONE
    return (
        f'<button type="button" class="go" data-at="{at:.6f}" data-over="shaft" '
        f'aria-label="go to {at:.2f} {unit} of the travel">{at:.2f} {unit}</button>'
    )


def place_button(angle: float | None, over: str) -> str:
    """Return a button that turns the shaft to an angle, degrees; a dash for None.

    `over` is `relative` where it is the angle between cam and frame, else `shaft`.
    """
    if angle is None:
        return NONE
    name = "relative angle" if over == "relative" else "shaft angle"
    label = f"turn to {angle:.2f} degrees of the {name}"
    mark = " rel." if over == "relative" else ""
    return (
        f'<button type="button" class="go" data-at="{angle:.6f}" data-over="{over}" aria-label="{label}">'
        f"{angle:.2f}°{mark}</button>"
    )


def _cell(text: str, kind: str = "") -> str:
    """Return a cell, marked where there is nothing in it."""
    name = " ".join(filter(None, (kind, "none" if text in {NONE, ""} else "")))
    return f'<td class="{name}">{text}</td>' if name else f"<td>{text}</td>"


def beside(unit: str, value: float | None, si: str) -> str:
    """Return a unit for reading; behind a unit of pounds stands the value in `si`, N, N m or N/mm²."""
    behind = "" if unit == si or value is None else f" ({value:.6g} {si})"
    return escape(_unit(f"{unit}{behind}"))


def _unit(name: str) -> str:
    """Return a unit with raised digits and the sign for degrees."""
    return name.replace("^2", "²").replace("^3", "³").replace("deg", "°")


def _bytes(count: int) -> str:
    return f'<span title="{count} bytes">{count / 1000.0:.1f} kB</span>' if count >= 1000 else f"{count} B"


def named_row(name: str, *cells: str) -> str:
    """Return a row of a table with `name` as the head of the row; name and cells are HTML."""
    return f'<tr><th scope="row">{name}</th>{"".join(f"<td>{cell}</td>" for cell in cells)}</tr>'


def figures(entries: Sequence[dict[str, Any]], at: str, unit: str) -> str:
    """Return the panel of figures, each with `name`, `value`, `unit`; by the key `at` its place, in `unit`."""
    rows = []
    for entry in entries:
        value, place = entry["value"], entry.get(at)
        shown = number(value) if value is not None and math.isfinite(value) else NONE
        where = "" if place is None else f"{place:.2f}{unit}"
        rows.append(named_row(entry["name"], shown, escape(_unit(entry["unit"])), where))
    table = html_table("Figures", ("figure", "value", "unit", "at"), rows)
    return f'<section aria-labelledby="figures-head"><h2 id="figures-head">Figures</h2>{table}</section>'


def html_table(caption: str, head: Sequence[str], rows: Sequence[str], kind: str = "plain") -> str:
    """Return a table with its caption, the heads of its columns and its rows, HTML each; `kind` is its class in CSS."""
    cells = "".join(f'<th scope="col">{name}</th>' if name else "<td></td>" for name in head)
    # no region, as sections of the same heading are landmarks already
    region = f'<div class="wide" tabindex="0" role="group" aria-label="{caption}">'
    body = f"<thead><tr>{cells}</tr></thead><tbody>{''.join(rows)}</tbody>"
    return f'{region}<table class="{kind}">{body}</table></div>'
