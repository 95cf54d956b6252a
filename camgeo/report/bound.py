"""How a check is titled and its limit reported: whether the limit itself is allowed, in words and as a sign."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from camgeo.checks.declared import (
    BENT,
    CHAMFER,
    CLEARANCE,
    JAM,
    LEAST_BACKLASH,
    MOBILITY,
    PRESSURE,
    RATIO,
    REVERSAL,
    WALL,
)

if TYPE_CHECKING:
    from collections.abc import Mapping

STRICT: dict[str, float | None] = {
    **dict.fromkeys(BENT),
    CHAMFER.name: None,
    WALL.name: 0.0,
    MOBILITY.name: 0.0,
    REVERSAL.name: 0.0,
    LEAST_BACKLASH.name: 0.0,
    CLEARANCE.name: 0.0,
    RATIO.name: 1.0,
    PRESSURE.name: 90.0,
    JAM.name: None,
}
"""Checks that a figure on its limit does not hold, and the one limit for which that is so (None: any)."""


def title(check: Mapping[str, object]) -> str:
    """Give the name of a check, with the surface that it is of where a cam has several: `motion, outer`."""
    return f"{check['name']}, {check['surface']}" if check.get("surface") else str(check["name"])


def unit_text(check: Mapping[str, Any]) -> str:
    """Give the unit of a check, behind it its value in pounds where the report has that: `N (115.2 lbf)`."""
    told = check.get("pounds")
    return str(check["unit"]) if told is None else f"{check['unit']} ({told['value']:.6g} {told['unit']})"


def is_strict(check: dict[str, Any]) -> bool:
    """Whether a figure equal to the check's limit fails."""
    name, limit = check["name"], check["limit"]
    return name in STRICT and "file" not in check and STRICT[name] in {None, limit}


def words(check: dict[str, Any]) -> str:
    """Say on which side of its limit the figure must lie: `at least`, `more than`, `at most`, `less than`."""
    below, least = ("less than", "more than") if is_strict(check) else ("at most", "at least")
    return least if check["sense"] == "at_least" else below


def sign(check: dict[str, Any]) -> str:
    """Give the same as a sign."""
    return {"at least": ">=", "more than": ">", "at most": "<=", "less than": "<"}[words(check)]
