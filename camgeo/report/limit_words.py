"""Title of a check, and its limit in words and as a sign, which say whether the limit itself is allowed.

A check is an entry of the list `checks` of a report (docs/report.md).
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from camgeo.checks.declared import declaration

if TYPE_CHECKING:
    from collections.abc import Mapping


def title(check: Mapping[str, object]) -> str:
    """Name of a check, with its surface where a cam has several: `motion, outer`."""
    return f"{check['name']}, {check['surface']}" if check.get("surface") else str(check["name"])


def unit_text(check: Mapping[str, Any]) -> str:
    """Unit of a check, with its value in pounds where the report has it: `N (115.2 lbf)`."""
    in_pounds = check.get("pounds")
    return (
        str(check["unit"]) if in_pounds is None else f"{check['unit']} ({in_pounds['value']:.6g} {in_pounds['unit']})"
    )


def is_strict(check: dict[str, Any]) -> bool:
    """Whether a figure equal to the check's limit fails."""
    declared = None if "file" in check else declaration(check["name"])
    return declared is not None and (declared.strict or check["limit"] in declared.strict_at)


def words(check: dict[str, Any]) -> str:
    """Side of the limit on which the figure must lie: `at least`, `more than`, `at most`, `less than`."""
    below, least = ("less than", "more than") if is_strict(check) else ("at most", "at least")
    return least if check["sense"] == "at_least" else below


def verb(check: dict[str, Any]) -> str:
    """Verb for the limit: `needed` where the limit itself fails, else `allowed`."""
    return "needed" if is_strict(check) else "allowed"


def sign(check: dict[str, Any]) -> str:
    """Side of the limit on which the figure must lie, as a sign: `>=`, `>`, `<=`, `<`."""
    return {"at least": ">=", "more than": ">", "at most": "<=", "less than": "<"}[words(check)]


def place_text(entry: dict[str, Any], digits: int = 2) -> str:
    """Place of a check's or remark's entry, with its unit; empty without one."""
    at, unit = (entry["at"], entry["at_unit"]) if "at" in entry else (entry.get("at_deg"), "deg")
    return "" if at is None else f"{at:.{digits}f} {unit}"
