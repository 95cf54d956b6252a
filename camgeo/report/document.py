"""The report as plain data and as text: checks, files, errors, times, things left out. In the recipe's units."""

from __future__ import annotations

import hashlib
import json
import math
from typing import TYPE_CHECKING, Any

from camgeo.common.terminal import escaped
from camgeo.common.units import UNIT_MM
from camgeo.measures.units import UNIT_NAMES, in_units, pounds
from camgeo.registry.formats import FORMATS
from camgeo.report.extension import PAGE
from camgeo.report.limit_words import place_text, sign, title, unit_text, verb, words
from camgeo.version import __version__
from kin.judge.verdict import UNREAD
from kin.numeric.lengths import in_unit
from kin.numeric.records import dataclass, field

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from camgeo.curve.measures import Measures
    from camgeo.measures.balance import Balance
    from camgeo.measures.file_result import FileResult
    from camgeo.measures.rule_remark import RuleRemark
    from camgeo.recipe.recipe import Order
    from kin.follower.motion_error import MotionError, Play
    from kin.judge.verdict import ClosureVerdict, SurfaceVerdict
    from kin.law.joints import DerivativeJump
    from kin.law.sources.motion import Kept
    from kin.numeric.check import Check

BELOW = "below rounding"
ROUNDING = 1e-11  # mm, in or degrees: rounding of sums of numbers of some hundred
DESIGN = frozenset({"motion", "profile", "undercut", "figures", "linkage", "part"})  # stages of the exact cam


@dataclass(frozen=True)
class Findings:
    """Results of a run, lengths in mm and angles in degrees.

    stages         (name, seconds) of each stage
    skipped        (name, reason) of each format, check or capability that was left out
    follower       name of its kind
    missing        (file, reason) of each file that could not be made: the missing package and how to install it
    kept           names of files of an earlier run that stay beside the new ones
    linkage        section of the report, in the recipe's units; None without one, as `preload`
    joints         joints of the motion at which derivatives jump
    table          how closely the motion keeps to its table of rows; None without a table
    displacements  factor from mm or rad to the unit of the follower's displacements in the report, and that unit
    contours       measures of the exact contours, by the names of the surfaces
    sections       sections of capabilities by their keys, in the recipe's units
    """

    checks: tuple[Check, ...]
    files: tuple[FileResult, ...]
    stages: tuple[tuple[str, float], ...]
    skipped: tuple[tuple[str, str], ...]
    follower: str
    missing: tuple[tuple[str, str], ...] = ()
    kept: tuple[str, ...] = ()
    linkage: dict[str, Any] | None = None
    preload: dict[str, object] | None = None
    remarks: tuple[RuleRemark, ...] = ()
    joints: tuple[DerivativeJump, ...] = ()
    table: Kept | None = None
    displacements: tuple[float, str] = (1.0, "mm")
    contours: Mapping[str, Measures] = field(default_factory=dict)
    balances: tuple[Balance, ...] = ()
    sections: Mapping[str, Any] = field(default_factory=dict)

    @property
    def ok(self) -> bool:
        """Whether every check holds."""
        return all(check.ok for check in self.checks)


def document(recipe: Order, findings: Findings) -> dict[str, Any]:
    """Report as plain data, with the keys and units of docs/report.md."""
    linkage = {} if findings.linkage is None else {"linkage": findings.linkage}
    preload = {} if findings.preload is None else {"preload": findings.preload}
    return {
        "recipe": recipe.name,
        "about": recipe.about,
        "camgeo": __version__,
        "units": recipe.units,
        **recipe.input_entries,
        "follower": findings.follower,
        "ok": findings.ok,
        "tolerance": recipe.export.tolerance / recipe.mm,
        "contour": _contours(recipe, findings.contours),
        **({"balance": [_balance(recipe, disc) for disc in findings.balances]} if findings.balances else {}),
        "checks": [_check(recipe, check) for check in findings.checks],
        "remarks": [_remark(recipe, remark) for remark in findings.remarks],
        "joints": [entry for joint in findings.joints for entry in _jumps(findings, joint)],
        **_table_entry(findings),
        "files": [_file(recipe, file) for file in findings.files]
        + [{"path": name, "stale": True} for name in findings.kept],
        **linkage,
        **preload,
        **findings.sections,
        "stages": [{"name": name, "seconds": round(seconds, 6)} for name, seconds in findings.stages],
        "skipped": [{"what": what, "why": why, "missing": True} for what, why in findings.missing]
        + [{"what": what, "why": why} for what, why in findings.skipped],
    }


def as_json(report: object) -> str:
    """JSON text of a report or of several; a figure that is nan or infinite is null, as strict JSON has neither."""
    return json.dumps(finite(report), indent=2, ensure_ascii=False, allow_nan=False) + "\n"


def file_entry(name: str, data: bytes) -> dict[str, Any]:
    """Entry of a file in a report: path, size in bytes and SHA-256 checksum; `name` is the path, `data` the content."""
    return {"path": name, "bytes": len(data), "sha256": hashlib.sha256(data).hexdigest()}


def _check(recipe: Order, check: Check) -> dict[str, Any]:
    value, unit = in_units(recipe, check.value, check.unit)
    limit, _ = in_units(recipe, check.limit, check.unit)
    entry: dict[str, Any] = {
        "name": check.name,
        "ok": check.ok,
        "value": value,
        "limit": limit,
        "unit": unit,
        "sense": check.sense,
        **_place_entry(recipe, check),
    }
    if (conversion := pounds(recipe.units, unit)) is not None and value is not None:
        pound_unit, factor = conversion
        entry["pounds"] = {
            "value": value * factor,
            "limit": None if limit is None else limit * factor,
            "unit": pound_unit,
        }
    if check.file is not None:
        entry["file"] = check.file
    if check.surface:
        entry["surface"] = check.surface
    if check.detail:
        entry["detail"] = in_unit(check.detail, recipe.mm, UNIT_NAMES[recipe.units])
    return entry


def _place_entry(recipe: Order, item: Check | RuleRemark) -> dict[str, Any]:
    """Entries of the place of a check or remark: `at_deg`, a shaft angle, or `at` with its unit."""
    if item.at_unit == "deg":
        return {"at_deg": item.at}
    at, unit = in_units(recipe, item.at, item.at_unit)
    return {"at": at, "at_unit": unit}


def _remark(recipe: Order, remark: RuleRemark) -> dict[str, Any]:
    value, unit = in_units(recipe, remark.value, remark.unit)
    rule, _ = in_units(recipe, remark.rule, remark.unit)
    return {
        "name": remark.name,
        "value": value,
        "rule": rule,
        "unit": unit,
        **_place_entry(recipe, remark),
        "sentence": remark.sentence,
    }


def _jumps(findings: Findings, joint: DerivativeJump) -> list[dict[str, Any]]:
    """Entries for the jumps at a joint of the motion, one for each derivative."""
    scale, unit = findings.displacements
    per = ("", "/rad", "/rad^2", "/rad^3")
    at_deg = math.degrees(joint.at)
    return [
        {"at_deg": at_deg, "derivative": k, "before": a, "after": b, "unit": unit + per[k]}
        for k, a, b in joint.scaled(scale).jumps
    ]


def _table_entry(findings: Findings) -> dict[str, Any]:
    """Entry on how closely the motion follows the rows of its table; empty for a motion without a table."""
    table, (scale, unit) = findings.table, findings.displacements
    if table is None or table.distance is None:
        return {}
    return {
        "table": {
            "distance": table.distance * scale,
            "lowered": table.lowered * scale,
            "distance_lowered": table.distance_lowered * scale,
            "unit": unit,
            "line": table.line or None,
        }
    }


def _file(recipe: Order, file: FileResult) -> dict[str, Any]:
    listing = file_entry(file.path.name, file.path.read_bytes())
    entry: dict[str, Any] = {"path": listing.pop("path"), "kind": file.request.kind, **listing}
    if file.units is not None:
        named = (name for name, mm in UNIT_MM.items() if math.isclose(mm, file.units, rel_tol=1e-6))
        entry["units"] = next(named, f"{file.units:.9g} mm")
    if not file.request.format.contour and not file.surfaces:
        return entry
    mm = recipe.mm
    if file.body != "cam":
        entry["body"] = file.body
    options = {"as": file.request.as_, **file.request.own}
    entry |= {key: options.get(key) for key in file.request.form.listed}
    if file.request.compensation is not None:
        entry["compensation"] = file.request.compensation.entry(mm)
    entry |= {
        "pieces": file.pieces,
        "tolerance": None if file.tolerance is None else file.tolerance / mm,
        "geometry_error": None if file.bound is None else file.bound.worst / mm,
        "geometry_outward": None if file.bound is None else file.bound.outward / mm,
        "geometry_inward": None if file.bound is None else file.bound.inward / mm,
    }
    rows = [(surface.name, _surface(recipe, surface)) for surface in file.surfaces or (UNREAD,)]
    if len(rows) > 1:
        entry["surfaces"] = [{"name": name, **row} for name, row in rows]
    for name, row in rows if len(rows) == 1 else ():  # flat keys, where there is one
        entry |= row | ({"surface": name} if name else {})
    if file.closures or "surfaces" in entry:
        entry["play"] = [_closure_entry(recipe, surface) for surface in file.closures]
    return entry


def _closure_entry(recipe: Order, closure: ClosureVerdict) -> dict[str, Any]:
    """Entry on the play of the follower between two surfaces of a file."""
    return {"between": [closure.pushes, closure.stops], **_play(recipe, closure.play)}


def _play(recipe: Order, play: Play) -> dict[str, Any]:
    """Least and greatest play of a follower that is held from both sides, over a turn; negative: interference."""
    least, unit = in_units(recipe, play.least, play.unit)
    most, _ = in_units(recipe, play.most, play.unit)
    place = {"min_at_deg": play.least_at_deg, "max_at_deg": play.most_at_deg}
    return {"min": least, "max": most, "unit": unit, **place}


def _surface(recipe: Order, surface: SurfaceVerdict) -> dict[str, Any]:
    """Measurements of a surface of a file by the judge."""
    return {
        "measured_error": None if surface.measured_error is None else surface.measured_error / recipe.mm,
        "motion": None if surface.motion is None else _motion(recipe, surface.motion),
        **_measures(recipe, surface.perimeter, surface.area),
        **({} if surface.play is None else {"play": [_play(recipe, surface.play)]}),
    }


def _contours(recipe: Order, measures: Mapping[str, Measures]) -> dict[str, Any] | None:
    """Perimeter and area of the exact contour, of several by the names of their surfaces."""
    entries = {name: _measures(recipe, contour.perimeter, contour.area) for name, contour in measures.items()}
    return entries.get("", entries) or None


def _balance(recipe: Order, disc: Balance) -> dict[str, Any]:
    """Mass and its moments of a disc: kg and mm whatever the recipe's unit, but for the place of the centre."""
    return {
        **({"surface": disc.surface} if disc.surface else {}),
        "mass_kg": disc.mass,
        "centre": [value / recipe.mm for value in disc.centre],
        "inertia_kg_mm2": disc.inertia,
        "unbalance_kg_mm": disc.unbalance,
        "unbalance_deg": disc.direction,
        "error": disc.error,
        **({"without": list(disc.without)} if disc.without else {}),
    }


def _measures(recipe: Order, perimeter: float | None, area: float | None) -> dict[str, float | None]:
    return {"perimeter": in_units(recipe, perimeter, "mm")[0], "area": in_units(recipe, area, "mm^2")[0]}


def _motion(recipe: Order, motion: MotionError) -> dict[str, Any]:
    entry: dict[str, Any] = {}
    for key, value in (
        ("max", motion.max),
        ("rms", motion.rms),
        ("increment", motion.increment),
        ("dwell_flatness", motion.dwell_flatness),
    ):
        entry[key], unit = in_units(recipe, value, motion.unit)
    remainder, _ = in_units(recipe, motion.remainder, motion.unit)
    extremes = {"extremes": motion.extremes, "remainder": remainder}
    return {**entry, "unit": unit, "at_deg": motion.at_deg, "increment_deg": motion.step_deg, **extremes}


def finite(value: Any) -> Any:  # noqa: ANN401 - plain JSON data of any shape
    """Plain data with nan and infinities as None."""
    if isinstance(value, dict):
        return {key: finite(item) for key, item in value.items()}
    if isinstance(value, (list, tuple)):
        return [finite(item) for item in value]
    if hasattr(value, "item"):
        value = value.item()
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value


def summary(report: dict[str, Any]) -> str:
    """Text for a terminal: a line with name, verdict, files and worst motion errors, and one for each failed check."""
    parts = []
    for file in report["files"]:
        if file.get("stale"):
            continue
        prefixes = (report["recipe"] + ".", report["recipe"] + "-")
        text = escaped(file["path"][len(prefixes[0]) :] if file["path"].startswith(prefixes) else file["path"])
        if file.get("pieces"):
            text += f" {file['pieces']} {pieces_word(file)}"
        motion, on = _worst(file)
        if motion:
            text += f", motion {error_text(motion['max'], motion['unit'], 3, file.get('tolerance'))}{on}"
            if motion.get("extremes") == "sampled":
                text += f" (sampled, estimated within {motion['remainder']:.2g})"
        parts.append(text)
    parts += _linkage_parts(report)
    parts += [f"remark: {remark['sentence']}" for remark in report.get("remarks", ())]
    failed = [_failure_text(check) for check in report["checks"] if not check["ok"]]
    verdict = "ok" if report["ok"] else "FAILED"
    line = f"{report['recipe']}: {verdict}"
    if parts:
        line += "  " + "; ".join(parts)
    if failed:
        line += "\n" + "\n".join(f"  {text}" for text in failed)
    return line


def _worst(file: dict[str, Any]) -> tuple[dict[str, Any] | None, str]:
    """Greatest motion error of a file, and ` on ` with its surface where the file has several."""
    motions = [
        (surface["motion"], f" on {surface['name']}" if "name" in surface else "")
        for surface in file.get("surfaces") or [file]
        if surface.get("motion") and surface["motion"]["max"] is not None
    ]
    return max(motions, key=lambda pair: pair[0]["max"], default=(None, ""))


def _linkage_parts(report: dict[str, Any]) -> list[str]:
    """The linkage's worst output error and the shortest dwell of the files.

    Without a file whose dwell is known it is the intended one, and called that if there are files.
    """
    linkage = report.get("linkage")
    if linkage is None:
        return []
    parts = []
    error = linkage.get("error")
    if error is not None:
        parts.append(f"output {error_text(error['max'], error['unit'], digits=3)}")
    lengths = [dwell["length_deg"] for dwell in linkage["dwells"] if dwell["from"] != "intended"]
    intended = [dwell["length_deg"] for dwell in linkage["dwells"] if dwell["from"] == "intended"][:1]
    if lengths or intended:
        of_files = lengths or not report["files"]
        parts.append(f"{'dwell' if of_files else 'intended dwell'} {min(lengths or intended):.2f} deg")
    return parts


def pieces_word(file: dict[str, Any]) -> str:
    """Noun for the pieces of a file's contour: `arcs`."""
    form = FORMATS[file["kind"]].forms.get(file.get("as") or "")
    return "pieces" if form is None else form.pieces


def table(report: dict[str, Any]) -> str:
    """Tables of a report as aligned text: checks and remarks, files, those of capabilities; skipped items and times."""
    rows: list[Sequence[str]] = [("check", "", "value", "limit", "unit", "at", "file")]
    rows += [
        (
            title(check),
            "ok" if check["ok"] else "FAILED",
            value_text(check),
            "" if check["limit"] is None else f"{sign(check)} {_number(check['limit'])}",
            unit_text(check),
            place_text(check),
            escaped(check.get("file", "")),
        )
        for check in report["checks"]
    ]
    # a remark has no side of its own: its figure lies on the unusual side of the rule
    for remark in report.get("remarks", ()):
        rule = remark["rule"]
        side = "" if rule is None else ">=" if remark["value"] < rule else "<="
        value, usual = _number(remark["value"]), f"{side} {_number(rule)}".strip()
        rows.append((remark["name"], "remark", value, usual, remark["unit"], place_text(remark), ""))
    text = align(rows)
    if report.get("remarks"):
        text += "\n\n" + "\n".join(f"remark {remark['name']}: {remark['sentence']}" for remark in report["remarks"])
    # a file of several surfaces has a row for each
    rows = [("file", "bytes", "pieces", "tolerance", "proved", "measured", "motion max", "rms", "at")]
    for file in (
        {**file_entry, **surface} for file_entry in report["files"] for surface in file_entry.get("surfaces") or [{}]
    ):
        motion = file.get("motion") or {}
        rows.append(
            (
                f"{escaped(file['path'])} {file.get('name', '')}".rstrip(),
                str(file.get("bytes", "stale")),
                str(file.get("pieces") or ""),
                _number(file.get("tolerance")),
                _number(file.get("geometry_error")),
                error_text(file.get("measured_error"), limit=file.get("tolerance")),
                error_text(motion.get("max"), motion.get("unit", ""), limit=file.get("tolerance")),
                error_text(motion.get("rms"), limit=file.get("tolerance")),
                place_text(motion),
            )
        )
    text += "\n\n" + align(rows)
    tables = (answers.lines(report) for answers in PAGE.of(report))
    text += "".join(f"\n\n{lines}" for lines in tables if lines)
    if report["skipped"]:
        text += f"\n\nskipped (the JSON says why): {', '.join(item['what'] for item in report['skipped'])}"
    return f"{text}\n\n{_times(report['stages'])}"


def verdict(report: dict[str, Any]) -> str:
    """Lines of `summary` with its first line, the verdict, last, so that it stays in sight under a table."""
    first, *failed = summary(report).split("\n")
    return "\n".join([*failed, first])


def _times(stages: Sequence[dict[str, Any]]) -> str:
    """Line with the milliseconds of all stages, and of each group: the exact cam, and others by their first word."""
    groups: dict[str, float] = {}
    for stage in stages:
        word = stage["name"].split()[0]
        group = "design" if stage["name"] in DESIGN else word
        groups[group] = groups.get(group, 0.0) + stage["seconds"]
    group_texts = ", ".join(f"{group} {1e3 * seconds:.1f}" for group, seconds in groups.items())
    return f"{1e3 * sum(groups.values()):.1f} ms: {group_texts}"


def _failure_text(check: dict[str, Any]) -> str:
    """Sentence on a failed check."""
    text = title(check)
    if check.get("file"):
        text += f" ({escaped(check['file'])})"
    if check["value"] is not None:
        text += f": {_number(check['value'])} {unit_text(check)}".rstrip()
        if check["limit"] is not None:
            text += f", {words(check)} {_number(check['limit'])} {verb(check)}"
        if place := place_text(check):
            text += f", at {place}"
    if check.get("detail"):
        text += f": {check['detail']}"
    return text


def _number(value: float | None) -> str:
    return "" if value is None else f"{value + 0.0:.6g}"  # no minus before a zero


def value_text(check: dict[str, Any]) -> str:
    """Figure of a check; an error that holds and is only rounding is `below rounding`."""
    holds = check["ok"] and check["sense"] == "at_most"
    return error_text(check["value"], limit=check["limit"]) if holds else _number(check["value"])


def error_text(value: float | None, unit: str = "", digits: int = 6, limit: float | None = None) -> str:
    """Measured error to `digits` significant digits, with its unit; empty for None.

    It is `below rounding` where it is only rounding and less than a thousandth of the limit, if there is one.
    """
    if value is None:
        return ""
    if 0.0 < abs(value) < ROUNDING and (not limit or abs(value) < 1e-3 * limit):
        return BELOW
    return f"{value + 0.0:.{digits}g} {unit}".rstrip()


def align(rows: Sequence[Sequence[str]]) -> str:
    """Rows of cells, at least one row and equally many cells in each, as lines of text in columns."""
    widths = [max(len(row[i]) for row in rows) for i in range(len(rows[0]))]
    padded = ("  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)) for row in rows)
    return "\n".join(line.rstrip() for line in padded)
