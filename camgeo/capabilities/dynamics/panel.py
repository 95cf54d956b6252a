"""A follower train on the page: forces of a rigid follower, response of an elastic train."""

from __future__ import annotations

from html import escape
from typing import TYPE_CHECKING, Any

from camgeo.capabilities.dynamics.frame_forces import REACTIONS
from camgeo.measures.units import in_pounds
from camgeo.report.page.tables import NONE, figure_table, html_table, number, place_button

if TYPE_CHECKING:
    from camgeo.report.page.tables import Row


def panel(report: dict[str, Any]) -> str:
    """Return the HTML of both sections, forces and dynamics; empty where the report has neither."""
    return forces(report) + dynamics(report)


def forces(report: dict[str, Any]) -> str:
    """Return the HTML section on the extreme forces of a rigid follower; empty where the report has no forces."""
    section = report.get("forces")
    if section is None:
        return ""
    caption = f"At {number(section['rpm'])} rpm, of a rigid follower."
    head = '<section aria-labelledby="forces-head"><h2 id="forces-head">Forces</h2>'
    if "jams_at_deg" in section:
        return f"{head}<p>{caption} The stem jams in its guide at {number(section['jams_at_deg'])}°.</p></section>"
    # least and greatest value of each force, with its angle
    rows: list[Row] = []
    ranges = [(f"force at {entry['contact']}", entry) for entry in section["contacts"]]
    ranges += [("torque of the shaft", section["torque"])]
    ranges += [(f"reaction at the {entry['end']} end of the guide", entry) for entry in section.get("guide", ())]
    ranges += [(REACTIONS[entry["reaction"]], entry) for entry in section.get("reactions", ())]
    for name, entry in ranges:
        for word, key in (("least", "min"), ("greatest", "max")):
            rows.append((f"{word} {name}", entry[key], entry["unit"], entry[f"{key}_at_deg"]))
    if (moved := section.get("moved")) is not None:
        held = moved.get("shut", {}).get("tappet_held_by")
        for stretch in moved["open"]:
            caption += f" The valve is open from {number(stretch['from_deg'])}° to {number(stretch['to_deg'])}°."
        caption += "" if held is None else f" Before and after, its seat carries the spring: {held} holds the tappet."
        felt = (("ratio", "ratio of the open valve"), ("mass_at_tappet", "mass that the tappet feels"))
        for key, name in (*felt, ("rate_at_tappet", "spring rate that it feels")):
            if (entry := moved.get(key)) is not None:
                for word, end in (("least", "min"), ("greatest", "max")):
                    rows.append((f"{word} {name}", entry[end], entry["unit"], entry[f"{end}_at_deg"]))
    if (sampled := section.get("load_sampled")) is not None:
        rows.append(("load is sampled, and may be off by", sampled["within"], sampled["unit"], sampled["at_deg"]))
    # contacts: width, pressure, mean forces of rollers, speeds that lift contacts off
    if (width := section.get("width")) is not None:
        rows.append((f"width of the contacts: {width['bound_by']}", width["value"], width["unit"], None))
    rows += [
        (f"greatest pressure at {entry['contact']}", entry["max"], entry["unit"], entry["max_at_deg"])
        for entry in section.get("pressure", ())
    ]
    rows += [
        (
            "that pressure over the {:.6g} {} that the material bears".format(
                *in_pounds(report["units"], entry["limit"], "N/mm^2")
            ),
            entry["share_of_limit"],
            "",
            None,
        )
        for entry in section.get("pressure", ())
        if "limit" in entry
    ]
    rows += [
        (f"mean force of {entry['roller']}", entry["mean_force"], "N", None) for entry in section.get("rollers", ())
    ]
    rows += [
        (f"speed that lifts {entry['contact']} off", entry["rpm"], "rpm", entry["at_deg"])
        for entry in section.get("lost", ())
    ]
    return f"{head}<p>{caption}</p>{figure_table('Forces', rows, report['units'])}</section>"


def dynamics(report: dict[str, Any]) -> str:
    """Return the HTML section on an elastic train: a row for the intended motion and for each file; empty without."""
    section = report.get("dynamics")
    if section is None:
        return ""
    unit, rows = section["force_unit"], list[str]()
    shown = in_pounds(report["units"], None, unit)[1]
    for run in section["runs"]:  # entries that a run lacks become dashes
        steady, impacts = run.get("steady") or {}, run.get("impacts") or {}
        cells = [
            *(_force(steady, name, unit, report["units"]) for name in ("peak", "least")),
            number(run.get("float_rpm")),
            NONE if impacts.get("count") is None else str(impacts["count"]),
            number(impacts.get("greatest_velocity")),
        ]
        body = "".join(f'<td class="number">{cell}</td>' for cell in cells)
        rows.append(f'<tr><th scope="row">{escape(run["from"])}</th>{body}</tr>')
    head = (
        "driven by",
        f"peak force, {shown}",
        f"least force, {shown}",
        "floats from, rpm",
        "impacts a turn",
        "fastest",
    )
    caption = (
        f"At {number(section['rpm'])} rpm; the train's own frequency is {number(section['natural_ratio'])} times the "
        f"shaft's, its damping ratio {number(section['damping_ratio'])}."
    )
    table = html_table("Dynamics", head, rows)
    return f'<section aria-labelledby="train-head"><h2 id="train-head">Dynamics</h2><p>{caption}</p>{table}</section>'


def _force(steady: dict[str, Any], name: str, si: str, units: str) -> str:
    """Return an extreme of a train's force with its shaft angle, as text; in pounds for a recipe in inches."""
    value, angle = steady.get(f"{name}_force"), steady.get(f"{name}_at_deg")
    if value is None or angle is None:
        return number(value)
    return f"{number(in_pounds(units, value, si)[0])} {place_button(angle, 'shaft')}"
