"""How a check is titled and its limit reported: whether the limit itself is allowed, in words and as a sign."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from camgeo.checks.declared import declaration

if TYPE_CHECKING:
    from collections.abc import Mapping


def title(check: Mapping[str, object]) -> str:
    """Give the name of a check, with the surface that it is of where a cam has several: `motion, outer`."""
    return f"{check['name']}, {check['surface']}" if check.get("surface") else str(check["name"])


def unit_text(check: Mapping[str, Any]) -> str:
    """Give the unit of a check, behind it its value in pounds where the report has that: `N (115.2 lbf)`."""
    told = check.get("pounds")
    return str(check["unit"]) if told is None else f"{check['unit']} ({told['value']:.6g} {told['unit']})"


def is_strict(check: dict[str, Any]) -> bool:
    """Whether a figure equal to the check's limit fails."""
    declared = None if "file" in check else declaration(check["name"])
    return declared is not None and (declared.strict or check["limit"] in declared.strict_at)


def words(check: dict[str, Any]) -> str:
    """Say on which side of its limit the figure must lie: `at least`, `more than`, `at most`, `less than`."""
    below, least = ("less than", "more than") if is_strict(check) else ("at most", "at least")
    return least if check["sense"] == "at_least" else below


def verb(check: dict[str, Any]) -> str:
    """Say what its limit is behind those words: `needed` where the limit itself fails, else `allowed`."""
    return "needed" if is_strict(check) else "allowed"


def sign(check: dict[str, Any]) -> str:
    """Give the same as a sign."""
    return {"at least": ">=", "more than": ">", "at most": "<=", "less than": "<"}[words(check)]
