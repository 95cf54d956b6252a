"""A check of a report that does not hold, in words for an engineer: figure, limit, place, and what would do."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from camgeo.recipe.model import ConstantBreadthCam, DoubleRollerCam, SupportCam
from camgeo.remedies import larger
from camgeo.report.bound import words
from camgeo.rounded import downward, upward

if TYPE_CHECKING:
    from camgeo.recipe.model import Recipe

FIELDS = {
    "undercut-global": "cam.roller_radius",
    "wall": "part.bore",
    "bore": "part.bore",
    "holes": "part",
    "mark": "part.mark",
    "hub": "part.hub",
    "chamfer": "part.chamfer",
    "set-screw": "part.set_screw",
    "lightening": "part.lightening",
    "thickness": "part.thickness",
    "units": "units",
    "contour": "export.tolerance",
    "mobility": "linkage",
    "reversal": "linkage",
    "dwell": "dwell.at_least",
}
"""The recipe's field that a check hangs on most; of the others it is the cam as a whole."""
INDENT = "\n  "


def failure(check: dict[str, Any], report: dict[str, Any], recipe: Recipe, shown: str | None = None) -> str:
    """Tell a failed check of a report over several lines; `shown` names the recipe's file in place of its path."""
    field = _field(check, recipe)
    line, column = recipe.locate(field)
    rows = [
        ("value", _value(check)),
        ("limit", _limit(check)),
        ("at", "" if check["at_deg"] is None else f"{check['at_deg']:.4f} deg of shaft angle"),
        ("file", check.get("file", "")),
        ("found", check.get("detail", "")),
        ("would do", remedy(check, report, recipe)),
        ("recipe", f"{shown or recipe.path}:{line}:{column} {field}"),
    ]
    return headline(check) + "".join(f"{INDENT}{name:<9}{text}" for name, text in rows if text)


def headline(check: dict[str, Any]) -> str:
    """Tell a failed check on one line."""
    file = check.get("file")
    text = f"{check['name']} of {file}" if file else check["name"]
    if check["value"] is None:
        return f"{text}: {check.get('detail') or 'nothing to measure'}"
    parts = [_value(check), _limit(check)]
    if check["at_deg"] is not None:
        parts.append(f"at {check['at_deg']:.2f} deg")
    return f"{text}: " + ", ".join(part for part in parts if part)


def remedy(check: dict[str, Any], report: dict[str, Any], recipe: Recipe) -> str:
    """Tell what would let the check hold; empty where nothing would, or where the check itself tells it."""
    name, value, limit, unit = check["name"], check["value"], check["limit"], check["unit"]
    if name in {"transmission", "pressure-angle"}:
        return "a smaller swing, or the same over a wider angle"
    if value is None or limit is None:
        return ""
    if name == "radius-of-curvature":
        return _rounder(recipe, value, limit, unit)
    if name == "chamfer" and "file" not in check:
        return (
            f"a chamfer below {downward(value)} {unit}" if value > 0.0 else "no chamfer, or a contour without corners"
        )
    if name == "wall" and recipe.part.plain and recipe.part.bore is not None:  # else the check names the edges
        less = 2.0 * (limit - value)
        return f"a bore smaller by more than {upward(less)} {unit}" if less * recipe.mm < recipe.part.bore else ""
    if name == "motion" and recipe.verify.motion_error is not None and value > 0.0:
        return _nearer(check, report, recipe)
    return ""


def _nearer(check: dict[str, Any], report: dict[str, Any], recipe: Recipe) -> str:
    """Tell what would bring the motion error, or its limit, to where it holds."""
    value, limit = check["value"], check["limit"]
    looser = f"verify.motion_error above {upward(value)}"
    if isinstance(recipe.cam, ConstantBreadthCam | SupportCam):  # a flat face is off by no more than the contour
        return f"a tolerance of {limit:.6g}, or {looser}"
    tolerance = next((file["tolerance"] for file in report["files"] if file["path"] == check.get("file")), None)
    return looser if tolerance is None else f"a tolerance of about {tolerance * limit / value:.2g}, or {looser}"


def _rounder(recipe: Recipe, value: float, limit: float, unit: str) -> str:
    """Tell what would make the least radius of curvature, `value`, large enough."""
    if isinstance(recipe.cam, DoubleRollerCam):
        return f"a roller radius below {downward(value)} {unit}" if value > 0.0 else ""
    return larger(recipe.cam, limit - value, unit)


def _field(check: dict[str, Any], recipe: Recipe) -> str:
    if check["name"] == "motion":
        return "export.tolerance" if recipe.verify.motion_error is None else "verify.motion_error"
    if check["name"] == "linkage-error":
        return "export.tolerance" if recipe.verify.output_error is None else "verify.output_error"
    return FIELDS.get(check["name"], "export.files" if check.get("file") else "cam")


def _value(check: dict[str, Any]) -> str:
    return "" if check["value"] is None else f"{check['value']:.6g} {check['unit']}".rstrip()


def _limit(check: dict[str, Any]) -> str:
    if check["limit"] is None:
        return ""
    return f"{words(check)} {check['limit']:.6g} {check['unit']}".rstrip()
