"""The section `made` of a report in lines of text, for the terminal and the page."""

from __future__ import annotations

from typing import Any

from camgeo.common.terminal import escaped
from camgeo.report.measured_page import NO_LIMIT

METAL = {"too much": "metal to grind off", "missing": "metal is missing"}
OF_PROFILE = "by the profile"  # as the phase is by the motion: two measurands
PER = {"error": "motion, error", "velocity": "  velocity", "acceleration": "  acceleration"}


def shown(report: dict[str, Any], *, everything: bool) -> str:
    """Text of several lines on a report with measured points; `everything` adds spans, multipliers and outliers."""
    section, verdict = report["made"], "ok" if report["ok"] else "FAILED"
    if report["ok"] and not section["verdicts"]:
        verdict = NO_LIMIT
    if not report["ok"] and "failed" not in section["verdicts"].values():
        if any(not check["ok"] and not check["name"].startswith("made-") for check in report["checks"]):
            verdict = "FAILED"
        else:
            verdict = "NOT PROVED"
    lines = [f"{report['recipe']}: {verdict}  {escaped(', '.join(section['files']))}"]
    if "rows" in section:  # of a kind of its own, which words them itself
        rows = section["rows"]
    else:
        rows = (shaft_rows if "lobes" in section else table_rows)(section, everything=everything)
    lines += [f"  {label:<30}{value}" for label, value in rows]
    lines += [f"  remark: {text}" for text in section["remarks"]]
    for check in report["checks"]:
        if not check["ok"]:
            name = f"{check['name']}, {check['surface']}" if "surface" in check else check["name"]
            lines.append(f"  {name}: {escaped(check['detail'])}")
    lines += [f"  wrote {escaped(path)}" for path in section.get("written", ())]
    return "\n".join(lines)


def table_rows(section: dict[str, Any], *, everything: bool) -> list[tuple[str, str]]:
    """Rows of text (label, value) on a part's section `made`; `everything` adds spans, multipliers and outliers."""
    unit, rows = section["unit"], []
    # points and smoothing of each surface
    for surface in section["surfaces"]:
        on = f" on {surface['name']}" if surface["name"] else ""
        words = f"{surface['points']}{on}"
        words += f", noise {surface['noise']:.3g} {unit}" if surface["noise"] else ""
        rows.append(("points", words))
        if everything:
            spans = f"{surface['spans']} spans of {surface['span_deg']:.3g} degrees"
            rows.append(("  smoothed over", f"{spans}, +- {surface['smoothing']:.2g} {unit}"))
            outliers = surface["outliers"]
            rows += [(f"  outlier, line {point['line']}", f"{point['residual']:+.4g} {unit}") for point in outliers]
        point, wave, over = surface["least_fault_point"], surface["least_fault_span"], 2.0 * surface["span_deg"]
        faults = f"{point:.2g} {unit} at one point, {wave:.2g} {unit} over {over:.3g} degrees"
        rows.append(("  least fault that is found", faults))
    # profile, causes and cure of each disc
    for disc in section["discs"]:
        ending = f" of {disc['name']}" if len(section["discs"]) > 1 else ""
        value = f"{disc['profile']:.4g} +- {disc['uncertainty']:.2g} {unit}"
        where = f"{disc['greatest']:+.4g} at {disc['at_deg']:.2f} degrees, line {disc['line']}"
        rows.append((f"profile{ending}, datum {disc['datum']}", f"{value}; {where}"))
        rows.append(("  smoothed", f"{disc['smoothed']:.4g} {unit}"))
        if disc["datum"] != "part":
            rows.append(("  placed by minimax", _placing_words(disc, unit)))
            least = disc["least_squares"]
            rows.append(("  placed by least squares", f"{_placing_words(least, unit)}: {least['profile']:.4g} {unit}"))
        if everything and "multipliers" in disc:
            weights = ", ".join(f"{weight:.4f}" for weight in disc["multipliers"])
            rows.append(("  certified by", f"{disc['certificate']:.6g} {unit}, multipliers {weights}"))
        for cause in disc["causes"]:
            words = f"{cause['value']:+.4g} +- {cause['uncertainty']:.2g} {cause['unit']}"
            if "at_deg" in cause:
                words += f" at {cause['at_deg']:.1f} degrees, {METAL[cause['metal']]}"
            else:
                words += f", {cause['waves']} a turn" if "waves" in cause else ""
                words += f"; makes {cause['effect']:.3g} {unit}"
            on = f", {cause['surface']}" if cause.get("surface") and len(section["surfaces"]) > 1 else ""
            by = f" {OF_PROFILE}" if "turned" in cause["cause"] else ""
            rows.append((f"  cause: {cause['cause']}{by}{on}", words))
        if "reduction" in disc:
            cure = disc["reduction"]
            words = f"{cure['size']:.3g} {unit}: the motion by {cure['offset']:+.3g} {cure['unit']}"
            rows.append(("  good if reground smaller by", f"{words}, within {cure['change']:.2g} of that"))
    # motion, figures, events, play and output
    motion = section["motion"]
    for name, label in PER.items():
        error = motion[name]
        words = f"{error['max']:+.4g} +- {error['uncertainty']:.2g} {error['unit']}"
        rows.append((label, f"{words} at {error['at_deg']:.2f} degrees"))
    offset = f"{motion['offset']:+.4g} +- {motion['offset_uncertainty']:.2g} {motion['unit']}"
    rows.append(("  constant offset", f"{offset}, set on assembly"))
    phase = f"{motion['phase_deg']:+.4g} +- {motion['phase_uncertainty_deg']:.2g} degrees"
    rows.append(
        ("  phase, by the motion", f"{phase}; {motion['without_phase']:.4g} {motion['unit']} remain without it")
    )
    peak = motion["peak_acceleration"]
    rows.append(("  peak acceleration", f"{peak['made']:.4g}, intended {peak['intended']:.4g} {peak['unit']}"))
    for figure in section.get("figures", ()):
        intended = f"intended {figure['intended']:.4g} {figure['unit']}, at {figure['at_deg']:.2f} degrees"
        rows.append((f"  {figure['name']}", f"{figure['made']:.4g} +- {figure['uncertainty']:.2g}, {intended}"))
    rows += _events(section.get("events", {}))
    if "play" in section:
        play = section["play"]
        least, most = (f"{play[key]:+.4g} at {play[f'{key}_at_deg']:.2f}" for key in ("least", "most"))
        rows.append(("play", f"{least} to {most} degrees, +- {play['uncertainty']:.2g} {play['unit']}"))
    if "output" in section:
        output = section["output"]
        words = f"{output['max']:.4g} +- {output['uncertainty']:.2g} {output['unit']} at {output['at_deg']:.2f} degrees"
        rows.append(("output, error", f"{words}; {output['centred']:.4g} centred"))
    if "lifts" in section:
        rows.append(("zero of the readings", f"{section['lifts']['zero']:+.6g} {motion['unit']}"))
    return rows


def _events(events: dict[str, Any]) -> list[tuple[str, str]]:
    """Rows of text (label, value) on greatest lift and velocity, and on durations, made against intended."""
    rows = []
    for name, event in events.items():
        if name != "above":
            rows += [(f"{name}, greatest {figure}", _against(own, own["unit"])) for figure, own in event.items()]
    for above in events.get("above", ()):
        label = f"{above['of']} above {above['lift']:.6g} {above['unit']}"
        if above["duration_crank_deg"] is None:
            rows.append((label, "not crossed once upwards and once down"))
            continue
        rows.append((label, _against(above["duration_crank_deg"], "crank degrees")))
        for key in ("opens", "closes", "centre"):
            rows.append((f"  {key}", _against(above[f"{key}_deg"], "cam degrees")))
    return rows


def _against(own: dict[str, Any], unit: str) -> str:
    """Text of a figure as made, its uncertainty, the intended figure, and the difference."""
    made, off = f"{own['made']:.6g} +- {own['uncertainty']:.2g} {unit}", own["made"] - own["intended"]
    return f"{made}, intended {own['intended']:.6g}: {off:+.2g}"


def shaft_rows(section: dict[str, Any], *, everything: bool) -> list[tuple[str, str]]:
    """Rows of text (label, value) on each lobe of a shaft: profile, motion and phase.

    With `everything` they have all rows of a single cam as well.
    """
    rows = _axis(section["axis"]) if "axis" in section else []
    for lobe in section["lobes"]:
        (disc,), motion, phase = lobe["discs"], lobe["motion"], lobe["phase"]
        error = motion["error"]
        profile = f"{disc['profile']:.4g} +- {disc['uncertainty']:.2g} {lobe['unit']}"
        moved = f"{error['max']:+.4g} +- {error['uncertainty']:.2g} {error['unit']}"
        rows.append((lobe["name"], f"profile {profile}, motion {moved} at {error['at_deg']:.2f} degrees"))
        rows.append(("  phase", f"{_late(phase['late_deg'])} +- {phase['uncertainty_deg']:.2g} cam degrees"))
        if lobe["name"] != section["datum"]:
            against = f"{_late(phase['against_datum_deg'])} +- {phase['against_datum_uncertainty_deg']:.2g}"
            rows[-1] = rows[-1][0], f"{rows[-1][1]}; against {section['datum']} {against}"
        own = table_rows(lobe, everything=everything)
        rows += [(f"  {label}", value) for label, value in own if everything or "cause: " in label or "above " in label]
    return rows


def _axis(axis: dict[str, Any]) -> list[tuple[str, str]]:
    """Rows of text (label, value): lean and shift of the shaft's axis, and cams that are certainly eccentric to it."""
    x, y = axis["shifted"]
    unit = axis["unit"]
    lean = f"{axis['leans_deg']:.3g} +- {axis['uncertainty_deg']:.2g} degrees towards {axis['towards_deg']:.0f}"
    shifted = f"shifted by ({x:+.3g}, {y:+.3g}) +- {axis['shift_uncertainty']:.2g} {unit} at z {axis['z']:.6g}"
    rows = [("axis of the shaft", f"leans by {lean}; {shifted}")]
    for cam in axis["eccentricity"]:
        if cam["value"] > cam["uncertainty"]:
            (x, y), value = cam["shifted"], f"{cam['value']:.3g} +- {cam['uncertainty']:.2g} {unit}"
            rows.append((f"  {cam['name']}, eccentric", f"{value} about it, by ({x:+.3g}, {y:+.3g})"))
    return rows


def _late(degrees: float) -> str:
    """An angle in words: late above 0, early below."""
    return f"{'early' if degrees < 0.0 else 'late'} by {abs(degrees):.4g}"


def _placing_words(placing: dict[str, Any], unit: str) -> str:
    """Turn and shift of a placing in words."""
    x, y = placing["shifted"]
    words = f"turned by {placing['turned_deg']:+.4g} degrees"
    if "turned_from_deg" in placing:
        words += f" ({placing['turned_from_deg']:.4g} to {placing['turned_to_deg']:.4g})"
    return words + (f", shifted by ({x:+.4g}, {y:+.4g}) {unit}" if x or y else "")
