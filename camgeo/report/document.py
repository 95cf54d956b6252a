"""The report as a document: checks, files, errors, times, what was left out and why. In the recipe's units."""

from __future__ import annotations

import json
import math
from typing import TYPE_CHECKING, Any

from camgeo.common.terminal import escaped
from camgeo.common.units import UNIT_MM
from camgeo.measures.units import UNIT_NAMES, in_units, pounds
from camgeo.registry import registry
from camgeo.registry.formats import FORMATS
from camgeo.report.bound import sign, title, unit_text, verb, words
from camgeo.report.listed import listed
from camgeo.version import __version__
from kin.judge.verdict import UNREAD
from kin.numeric.lengths import in_unit
from kin.numeric.records import dataclass, field

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from camgeo.curve.measures import Measures
    from camgeo.measures.balance import Balance
    from camgeo.measures.file_result import FileResult
    from camgeo.measures.remarks import Remark
    from camgeo.recipe.recipe import Order
    from kin.follower.motion_error import MotionError, Play
    from kin.judge.check import Check
    from kin.judge.verdict import ClosureVerdict, SurfaceVerdict
    from kin.law.joints import Joint
    from kin.law.sources.motion import Kept

BELOW = "below rounding"
ROUNDING = 1e-11  # mm, in or degrees: what sums of doubles of some hundred leave, and no machine makes
DESIGN = frozenset({"motion", "profile", "undercut", "figures", "linkage", "part"})  # stages of the exact cam


@dataclass(frozen=True)
class Findings:
    """Everything a run found, before it is put in the recipe's units; all sections already are.

    `displacements` are factor and unit in which those of the follower are told. `missing` names the files that could
    not be made, each with the package that is missing and how to get it.
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
    remarks: tuple[Remark, ...] = ()
    joints: tuple[Joint, ...] = ()
    table: Kept | None = None
    displacements: tuple[float, str] = (1.0, "mm")
    contours: Mapping[str, Measures] = field(default_factory=dict)
    balances: tuple[Balance, ...] = ()
    sections: Mapping[str, Any] = field(default_factory=dict)

    @property
    def ok(self) -> bool:
        """True where every check holds."""
        return all(check.ok for check in self.checks)


def document(recipe: Order, findings: Findings) -> dict[str, Any]:
    """The report as plain data, keys and units as the report contract fixes them."""
    linkage = {} if findings.linkage is None else {"linkage": findings.linkage}
    preload = {} if findings.preload is None else {"preload": findings.preload}
    return {
        "recipe": recipe.name,
        "about": recipe.about,
        "camgeo": __version__,
        "units": recipe.units,
        "rotation": recipe.rotation,
        "follower": findings.follower,
        "ok": findings.ok,
        "tolerance": recipe.export.tolerance / recipe.mm,
        "contour": _contours(recipe, findings.contours),
        **({"balance": [_balance(recipe, one) for one in findings.balances]} if findings.balances else {}),
        "checks": [_check(recipe, check) for check in findings.checks],
        "remarks": [_remark(recipe, remark) for remark in findings.remarks],
        "joints": [entry for joint in findings.joints for entry in _jumps(findings, joint)],
        **_kept(findings),
        "files": [_file(recipe, file) for file in findings.files]
        + [{"path": name, "stale": True} for name in findings.kept],
        **linkage,
        **preload,
        **findings.sections,
        "stages": [{"name": name, "seconds": round(seconds, 6)} for name, seconds in findings.stages],
        "skipped": [{"what": what, "why": why, "missing": True} for what, why in findings.missing]
        + [{"what": what, "why": why} for what, why in findings.skipped],
    }


def encoded(report: object) -> str:
    """A report, or several, as JSON text; strict JSON, so an infinite figure is null."""
    return json.dumps(finite(report), indent=2, ensure_ascii=False, allow_nan=False) + "\n"


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
        "at_deg": check.at_deg,
    }
    if (other := pounds(recipe.units, unit)) is not None and value is not None:
        name, many = other
        entry["pounds"] = {"value": value * many, "limit": None if limit is None else limit * many, "unit": name}
    if check.file is not None:
        entry["file"] = check.file
    if check.surface:
        entry["surface"] = check.surface
    if check.detail:
        entry["detail"] = in_unit(check.detail, recipe.mm, UNIT_NAMES[recipe.units])
    return entry


def _remark(recipe: Order, remark: Remark) -> dict[str, Any]:
    value, unit = in_units(recipe, remark.value, remark.unit)
    rule, _ = in_units(recipe, remark.rule, remark.unit)
    return {
        "name": remark.name,
        "value": value,
        "rule": rule,
        "unit": unit,
        "at_deg": remark.at_deg,
        "sentence": remark.sentence,
    }


def _jumps(findings: Findings, joint: Joint) -> list[dict[str, Any]]:
    """What jumps at a joint of the motion: an entry for each derivative."""
    scale, unit = findings.displacements
    per = ("", "/rad", "/rad^2", "/rad^3")
    at_deg = math.degrees(joint.at)
    return [
        {"at_deg": at_deg, "derivative": k, "before": a, "after": b, "unit": unit + per[k]}
        for k, a, b in joint.scaled(scale).jumps
    ]


def _kept(findings: Findings) -> dict[str, Any]:
    """How the motion keeps the rows of its table; nothing where it is made of none."""
    kept, (scale, unit) = findings.table, findings.displacements
    if kept is None or kept.distance is None:
        return {}
    return {"table": {"distance": kept.distance * scale, "unit": unit, "line": kept.line or None}}


def _file(recipe: Order, file: FileResult) -> dict[str, Any]:
    told = listed(file.path.name, file.path.read_bytes())
    entry: dict[str, Any] = {"path": told.pop("path"), "kind": file.request.kind, **told}
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
    rows = [(one.name, _surface(recipe, one)) for one in file.surfaces or (UNREAD,)]
    if len(rows) > 1:
        entry["surfaces"] = [{"name": name, **row} for name, row in rows]
    for name, row in rows if len(rows) == 1 else ():  # flat keys, where there is one
        entry |= row | ({"surface": name} if name else {})
    if file.closures or "surfaces" in entry:
        entry["play"] = [_between(recipe, one) for one in file.closures]
    return entry


def _between(recipe: Order, closure: ClosureVerdict) -> dict[str, Any]:
    """What is left to the follower between two surfaces of a file."""
    return {"between": [closure.pushes, closure.stops], **_play(recipe, closure.play)}


def _play(recipe: Order, play: Play) -> dict[str, Any]:
    """What is left to a follower that is held from both sides, over the whole turn; negative: interference."""
    least, unit = in_units(recipe, play.least, play.unit)
    most, _ = in_units(recipe, play.most, play.unit)
    place = {"min_at_deg": play.least_at_deg, "max_at_deg": play.most_at_deg}
    return {"min": least, "max": most, "unit": unit, **place}


def _surface(recipe: Order, surface: SurfaceVerdict) -> dict[str, Any]:
    """What the judge measured of a surface of a file."""
    return {
        "measured_error": None if surface.measured_error is None else surface.measured_error / recipe.mm,
        "motion": None if surface.motion is None else _motion(recipe, surface.motion),
        **_measures(recipe, surface.perimeter, surface.area),
        **({} if surface.play is None else {"play": [_play(recipe, surface.play)]}),
    }


def _contours(recipe: Order, measures: Mapping[str, Measures]) -> dict[str, Any] | None:
    """Perimeter and area of the exact contour, of several by the names of their surfaces."""
    told = {name: _measures(recipe, one.perimeter, one.area) for name, one in measures.items()}
    return told.get("", told) or None


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
    found = {"extremes": motion.extremes, "remainder": remainder}
    return {**entry, "unit": unit, "at_deg": motion.at_deg, "increment_deg": motion.step_deg, **found}


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
    """One line for a terminal: name, verdict, files with pieces and worst motion error, and what failed."""
    parts = []
    for file in report["files"]:
        if file.get("stale"):
            continue
        own = (report["recipe"] + ".", report["recipe"] + "-")
        text = escaped(file["path"][len(own[0]) :] if file["path"].startswith(own) else file["path"])
        if file.get("pieces"):
            text += f" {file['pieces']} {pieces_word(file)}"
        motion, on = _worst(file)
        if motion:
            text += f", motion {measured(motion['max'], motion['unit'], 3, file.get('tolerance'))}{on}"
            if motion.get("extremes") == "sampled":
                text += f" (sampled, estimated within {motion['remainder']:.2g})"
        parts.append(text)
    parts += _of_linkage(report.get("linkage"))
    parts += [f"remark: {remark['sentence']}" for remark in report.get("remarks", ())]
    failed = [_told(check) for check in report["checks"] if not check["ok"]]
    verdict = "ok" if report["ok"] else "FAILED"
    line = f"{report['recipe']}: {verdict}"
    if parts:
        line += "  " + "; ".join(parts)
    if failed:
        line += "\n" + "\n".join(f"  {text}" for text in failed)
    return line


def _worst(file: dict[str, Any]) -> tuple[dict[str, Any] | None, str]:
    """The greatest motion error of a file, and on which of several surfaces it is."""
    found = [
        (one["motion"], f" on {one['name']}" if "name" in one else "")
        for one in file.get("surfaces") or [file]
        if one.get("motion") and one["motion"]["max"] is not None
    ]
    return max(found, key=lambda each: each[0]["max"], default=(None, ""))


def _of_linkage(linkage: dict[str, Any] | None) -> list[str]:
    """The linkage's worst output error, and the dwell that was asked for: as the files have it, where there are any."""
    if linkage is None:
        return []
    parts = []
    error = linkage.get("error")
    if error is not None:
        parts.append(f"output {measured(error['max'], error['unit'], digits=3)}")
    made = [dwell["length_deg"] for dwell in linkage["dwells"] if dwell["from"] != "intended"]
    meant = [dwell["length_deg"] for dwell in linkage["dwells"] if dwell["from"] == "intended"][:1]
    if made or meant:
        parts.append(f"dwell {min(made or meant):.2f} deg")
    return parts


def pieces_word(file: dict[str, Any]) -> str:
    """What the pieces of a file's contour are called."""
    form = FORMATS[file["kind"]].forms.get(file.get("as") or "")
    return "pieces" if form is None else form.pieces


def table(report: dict[str, Any]) -> str:
    """Every check and file of a report as aligned text."""
    rows: list[Sequence[str]] = [("check", "", "value", "limit", "unit", "at", "file")]
    rows += [
        (
            title(check),
            "ok" if check["ok"] else "FAILED",
            value_text(check),
            "" if check["limit"] is None else f"{sign(check)} {_number(check['limit'])}",
            unit_text(check),
            "" if check["at_deg"] is None else f"{check['at_deg']:.2f} deg",
            escaped(check.get("file", "")),
        )
        for check in report["checks"]
    ]
    for remark in report.get("remarks", ()):
        rule, place = remark["rule"], remark["at_deg"]
        side = "" if rule is None else ">=" if remark["value"] < rule else "<="
        at = "" if place is None else f"{place:.2f} deg"
        value, usual = _number(remark["value"]), f"{side} {_number(rule)}".strip()
        rows.append((remark["name"], "remark", value, usual, remark["unit"], at, ""))
    text = aligned(rows)
    if report.get("remarks"):
        text += "\n\n" + "\n".join(f"remark {remark['name']}: {remark['sentence']}" for remark in report["remarks"])
    rows = [("file", "bytes", "pieces", "tolerance", "proved", "measured", "motion max", "rms", "at")]
    for file in ({**one, **surface} for one in report["files"] for surface in one.get("surfaces") or [{}]):
        motion = file.get("motion") or {}
        rows.append(
            (
                f"{escaped(file['path'])} {file.get('name', '')}".rstrip(),
                str(file.get("bytes", "stale")),
                str(file.get("pieces") or ""),
                _number(file.get("tolerance")),
                _number(file.get("geometry_error")),
                measured(file.get("measured_error"), limit=file.get("tolerance")),
                measured(motion.get("max"), motion.get("unit", ""), limit=file.get("tolerance")),
                measured(motion.get("rms"), limit=file.get("tolerance")),
                "" if motion.get("at_deg") is None else f"{motion['at_deg']:.2f} deg",
            )
        )
    text += "\n\n" + aligned(rows)
    tables = (capability.lines(report) for capability in registry.in_order(registry.names_loaded()))
    text += "".join(f"\n\n{lines}" for lines in tables if lines)
    if report["skipped"]:
        text += f"\n\nskipped (the JSON says why): {', '.join(item['what'] for item in report['skipped'])}"
    return f"{text}\n\n{_times(report['stages'])}"


def verdict(report: dict[str, Any]) -> str:
    """What `summary` says with the verdict's line last, so that it stays in sight under a table."""
    first, *failed = summary(report).split("\n")
    return "\n".join([*failed, first])


def _times(stages: Sequence[dict[str, Any]]) -> str:
    """Milliseconds of all stages, and of each group of them: the exact cam, and the rest by the first word."""
    groups: dict[str, float] = {}
    for stage in stages:
        word = stage["name"].split()[0]
        group = "design" if stage["name"] in DESIGN else word
        groups[group] = groups.get(group, 0.0) + stage["seconds"]
    told = ", ".join(f"{group} {1e3 * seconds:.1f}" for group, seconds in groups.items())
    return f"{1e3 * sum(groups.values()):.1f} ms: {told}"


def _told(check: dict[str, Any]) -> str:
    """A failed check as a sentence."""
    text = title(check)
    if check.get("file"):
        text += f" ({escaped(check['file'])})"
    if check["value"] is not None:
        text += f": {_number(check['value'])} {unit_text(check)}".rstrip()
        if check["limit"] is not None:
            text += f", {words(check)} {_number(check['limit'])} {verb(check)}"
        if check["at_deg"] is not None:
            text += f", at {check['at_deg']:.2f} deg"
    if check.get("detail"):
        text += f": {check['detail']}"
    return text


def _number(value: float | None) -> str:
    return "" if value is None else f"{value + 0.0:.6g}"  # no minus before a zero


def value_text(check: dict[str, Any]) -> str:
    """A check's figure; of an error that holds, without the digits that only rounding made."""
    holds = check["ok"] and check["sense"] == "at_most"
    return measured(check["value"], limit=check["limit"]) if holds else _number(check["value"])


def measured(value: float | None, unit: str = "", digits: int = 6, limit: float | None = None) -> str:
    """A measured error with its unit; one that rounding made, far from its limit, has no digits worth telling."""
    if value is None:
        return ""
    if 0.0 < abs(value) < ROUNDING and (not limit or abs(value) < 1e-3 * limit):
        return BELOW
    return f"{value + 0.0:.{digits}g} {unit}".rstrip()


def aligned(rows: Sequence[Sequence[str]]) -> str:
    """Rows of cells as text in columns."""
    widths = [max(len(row[i]) for row in rows) for i in range(len(rows[0]))]
    padded = ("  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)) for row in rows)
    return "\n".join(line.rstrip() for line in padded)
