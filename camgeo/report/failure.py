"""Text of a failed check for an engineer: figure, limit, place, remedy.

A check is an entry of the list `checks` of a report (docs/report.md).
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from camgeo.checks.declaration import Declared
from camgeo.checks.declared import LIMIT, declaration
from camgeo.report.limit_words import place_text, title, unit_text, verb, words

if TYPE_CHECKING:
    from camgeo.recipe.recipe import Order, Recipe

INDENT = "\n  "
UNKNOWN = Declared("", ())  # of a check without a declaration


def failure(check: dict[str, Any], report: dict[str, Any], recipe: Recipe, shown: str | None = None) -> str:
    """Text of several lines on a failed check of a report; `shown` names the recipe's file in place of its path."""
    return failure_at(check, recipe, _field(check, recipe), remedy(check, report, recipe), shown)


def failure_at(check: dict[str, Any], recipe: Order, field: str, would_do: str = "", shown: str | None = None) -> str:
    """Text of several lines on a failed check, with the place of a recipe's field and the remedy `would_do`.

    `shown` names the recipe's file in place of its path.
    """
    line, column = recipe.locate(field)
    source = recipe.unplaced or f"{shown or recipe.path}:{line}:{column}"
    place = place_text(check, 4)
    rows = [
        ("value", _value(check)),
        ("limit", _limit(check)),
        ("at", place and f"{place} of {'travel' if 'at' in check else 'shaft angle'}"),
        ("file", check.get("file", "")),
        ("found", check.get("detail", "")),
        ("remedy", would_do),
        ("recipe", f"{source} {field}"),
    ]
    return headline(check) + "".join(f"{INDENT}{name:<9}{text}" for name, text in rows if text)


def headline(check: dict[str, Any]) -> str:
    """Text of one line on a failed check: name, file, figure, limit, place; without a figure the reason."""
    file = check.get("file")
    text = f"{title(check)} of {file}" if file else title(check)
    if check["value"] is None:
        return f"{text}: {check.get('detail') or 'nothing to measure'}"
    parts = [_value(check), f"{_limit(check)} {verb(check)}" if _limit(check) else ""]
    if place := place_text(check):
        parts.append(f"at {place}")
    return f"{text}: " + ", ".join(part for part in parts if part)


def remedy_in(explained: str) -> str:
    """Remedy of a text that `failure_at` gives, with file, line and column; empty where no remedy is known."""
    rows = {row[:9].strip(): row[9:] for row in explained.split(INDENT)[1:]}
    return f"{rows['remedy']} ({rows['recipe'].rpartition(' ')[0]})" if "remedy" in rows else ""


def remedy(check: dict[str, Any], report: dict[str, Any], recipe: Recipe) -> str:
    """Sentence on a change of the recipe that would let the check hold; empty where none is known."""
    declared = declaration(check["name"])
    return "" if declared is None or declared.remedy is None else declared.remedy(check, report, recipe)


def _field(check: dict[str, Any], recipe: Recipe) -> str:
    declared = declaration(check["name"]) or UNKNOWN
    if check["name"].startswith(LIMIT):
        figure = check["name"].removeprefix(LIMIT)
        limits = [
            limit for limit in recipe.limits if limit.figure == figure and getattr(limit, check["sense"]) is not None
        ]
        return next((limit.field(check["sense"]) for limit in limits), f"limits.{figure}.{check['sense']}")
    return declared.place(recipe, check.get("file"))


def _value(check: dict[str, Any]) -> str:
    return "" if check["value"] is None else f"{check['value']:.6g} {unit_text(check)}".rstrip()


def _limit(check: dict[str, Any]) -> str:
    if check["limit"] is None:
        return ""
    return f"{words(check)} {check['limit']:.6g} {check['unit']}".rstrip()
