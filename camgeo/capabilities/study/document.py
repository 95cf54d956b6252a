"""A study as plain data for study.json, in the recipe's units, and as a table for a terminal."""

from __future__ import annotations

import platform
from typing import TYPE_CHECKING

from camgeo.capabilities.study.tolerance_ladder import End, Rung
from camgeo.measures.units import in_units
from camgeo.report.document import align
from camgeo.version import __version__

if TYPE_CHECKING:
    from collections.abc import Sequence

    from camgeo.capabilities.study.margins import FailureMargin
    from camgeo.checks.declaration import Entry
    from camgeo.recipe.recipe import Recipe
    from kin.numeric.check import Check


def document(
    recipe: Recipe,
    steps: Sequence[Rung | End],
    margins: Sequence[FailureMargin],
    skipped: Sequence[tuple[str, str]],
    *,
    failed: Sequence[Check] = (),
    names: Sequence[str] = (),
) -> Entry:
    """Content of study.json, figures in the recipe's units.

    `steps` are the rungs and ends of all ladders, `skipped` pairs of what is left out and why, `failed` the checks of
    the exact cam that fail, `names` the names of its surfaces where there are several.
    """
    length = in_units(recipe, None, "mm")[1]
    rungs = [rung for rung in steps if isinstance(rung, Rung)]
    return {
        "recipe": recipe.name,
        "camgeo": __version__,
        "units": recipe.units,
        "machine": {"python": platform.python_version(), "system": platform.system(), "processor": platform.machine()},
        "surfaces": list(names),
        "rows": [_row(recipe, rung) for rung in rungs],
        "ended": [
            {"form": end.form, "tolerance": end.tolerance / recipe.mm, "unit": length, "why": end.why}
            for end in steps
            if isinstance(end, End)
        ],
        "margins": [_margin(recipe, margin) for margin in margins],
        "failed": [{"name": check.name, "why": check.detail} for check in failed],
        "skipped": [{"what": what, "why": why} for what, why in skipped],
    }


def _row(recipe: Recipe, rung: Rung) -> Entry:
    mm = recipe.mm
    motion, unit = in_units(recipe, rung.motion_error, rung.motion_unit)
    entry: Entry = {
        "form": rung.form,
        "tolerance": rung.tolerance / mm,
        "geometry_error": None if rung.geometry_error is None else rung.geometry_error / mm,
        "proved": rung.proved / mm,
        "motion_error": motion,
        "motion_unit": unit,
        "seconds": rung.seconds,
        "stages": rung.stages,
        "pieces": rung.pieces,
        "least_pieces": rung.least_pieces,
        "ratio": rung.ratio,
        "bytes": rung.bytes,
        "ok": rung.ok,
        "failed": list(rung.failed),
    }
    if rung.output_error is not None:
        entry["output_error"], entry["output_unit"] = in_units(recipe, rung.output_error, rung.output_unit)
    return entry


def _margin(recipe: Recipe, margin: FailureMargin) -> Entry:
    value, unit = in_units(recipe, margin.value, margin.unit)
    if margin.unit == "deg/mm":
        value, unit = margin.value * recipe.mm, f"deg/{in_units(recipe, None, 'mm')[1]}"
    return {
        "name": margin.name,
        "value": value,
        "unit": unit,
        "of": margin.of,
        "kind": "factor" if margin.grows else "margin",
    }


def table(study: Entry) -> str:
    """Text of `study` for a terminal: a row for each file, ends of the ladders, margins, failures and omissions."""
    linkage = any("output_error" in row for row in study["rows"])
    errors = ["tolerance", "geometry", "motion", *(["output"] if linkage else [])]
    times = ["fit ms", "write ms", "judge ms"]
    rows: list[Sequence[str]] = [["form", *errors, *times, "pieces", "least", "ratio", "bytes", ""]]
    for row in study["rows"]:
        motion = _with_unit(row["motion_error"], row["motion_unit"])
        errors = [f"{row['tolerance']:.0e}", _with_unit(row["geometry_error"], ""), motion]
        if linkage:
            errors.append(_with_unit(row.get("output_error"), row.get("output_unit", "")))
        times = [f"{1e3 * row['stages'][stage]:.2f}" for stage in ("fit", "write", "judge")]
        pieces = [str(row["pieces"]), f"{row['least_pieces']:.1f}", f"{row['ratio']:.3f}"]
        failed = "" if row["ok"] else f"FAILED {', '.join(row['failed'])}"
        rows.append([row["form"], *errors, *times, *pieces, str(row["bytes"]), failed])
    text = align(rows)
    if study["surfaces"]:
        text += f"\n\nerrors are the greatest, pieces, bytes and seconds the sums of {' and '.join(study['surfaces'])}"
    ends = [f"{end['form']} ends at {end['tolerance']:.0e} {end['unit']}: {end['why']}" for end in study["ended"]]
    text += "\n\n" + "\n".join(ends)
    if study["failed"]:
        checks = [f"{item['name']}: {item['why']}" if item["why"] else item["name"] for item in study["failed"]]
        text += "\n\n" + "\n".join(f"FAILED before any file: {line}" for line in checks)
    margins: list[Sequence[str]] = [("margin", "value", "", "at 0; or what grows by it")]
    margins += [(m["name"], f"{m['value']:.6g}", m["unit"], m["of"]) for m in study["margins"]]
    text += "\n\n" + align(margins)
    if study["skipped"]:
        text += "\n\n" + "\n".join(f"skipped {item['what']}: {item['why']}" for item in study["skipped"])
    return text


def _with_unit(value: float | None, unit: str) -> str:
    """Value with four digits and its unit; without a value the unit alone."""
    return f"{'' if value is None else f'{value:.4g}'} {unit}".rstrip()
