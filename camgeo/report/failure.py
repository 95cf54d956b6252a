"""A check of a report that does not hold, in words for an engineer: figure, limit, place, and what would do."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from camgeo.checks.declared import LIMIT, Declared, declaration
from camgeo.report.bound import title, unit_text, verb, words

if TYPE_CHECKING:
    from camgeo.recipe.recipe import Order, Recipe

INDENT = "\n  "
UNKNOWN = Declared("", ())  # of a check that none declares


def failure(check: dict[str, Any], report: dict[str, Any], recipe: Recipe, shown: str | None = None) -> str:
    """Tell a failed check of a report over several lines; `shown` names the recipe's file in place of its path."""
    return placed(check, recipe, _field(check, recipe), remedy(check, report, recipe), shown)


def placed(check: dict[str, Any], recipe: Order, field: str, would_do: str = "", shown: str | None = None) -> str:
    """Tell a failed check over several lines, with the place of a recipe's field and what would let it hold."""
    line, column = recipe.locate(field)
    place = recipe.unplaced or f"{shown or recipe.path}:{line}:{column}"
    rows = [
        ("value", _value(check)),
        ("limit", _limit(check)),
        ("at", "" if check["at_deg"] is None else f"{check['at_deg']:.4f} deg of shaft angle"),
        ("file", check.get("file", "")),
        ("found", check.get("detail", "")),
        ("remedy", would_do),
        ("recipe", f"{place} {field}"),
    ]
    return headline(check) + "".join(f"{INDENT}{name:<9}{text}" for name, text in rows if text)


def headline(check: dict[str, Any]) -> str:
    """Tell a failed check on one line."""
    file = check.get("file")
    text = f"{title(check)} of {file}" if file else title(check)
    if check["value"] is None:
        return f"{text}: {check.get('detail') or 'nothing to measure'}"
    parts = [_value(check), f"{_limit(check)} {verb(check)}" if _limit(check) else ""]
    if check["at_deg"] is not None:
        parts.append(f"at {check['at_deg']:.2f} deg")
    return f"{text}: " + ", ".join(part for part in parts if part)


def remedy(check: dict[str, Any], report: dict[str, Any], recipe: Recipe) -> str:
    """Tell what would let the check hold; empty where nothing would, or where the check itself says it."""
    declared = declaration(check["name"])
    return "" if declared is None or declared.remedy is None else declared.remedy(check, report, recipe)


def _field(check: dict[str, Any], recipe: Recipe) -> str:
    declared = declaration(check["name"]) or UNKNOWN
    if check["name"].startswith(LIMIT):
        figure = check["name"].removeprefix(LIMIT)
        own = [one for one in recipe.limits if one.figure == figure and getattr(one, check["sense"]) is not None]
        return next((one.field(check["sense"]) for one in own), f"limits.{figure}.{check['sense']}")
    return declared.place(recipe, check.get("file"))


def _value(check: dict[str, Any]) -> str:
    return "" if check["value"] is None else f"{check['value']:.6g} {unit_text(check)}".rstrip()


def _limit(check: dict[str, Any]) -> str:
    if check["limit"] is None:
        return ""
    return f"{words(check)} {check['limit']:.6g} {check['unit']}".rstrip()
