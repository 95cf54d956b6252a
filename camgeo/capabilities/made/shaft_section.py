"""The section of the report on a measured shaft."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from camgeo.measures.units import UNIT_NAMES

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from camgeo.capabilities.made.shaft import Phase, ShaftMade
    from camgeo.recipe.recipe import Order


def shaft_section(
    recipe: Order, paths: Sequence[Path], result: ShaftMade, sections: Sequence[dict[str, Any]]
) -> dict[str, Any]:
    """Section `made` of the report on a shaft, from the sections of its cams; angles are degrees of the shaft."""
    entry: dict[str, Any] = {
        "files": [path.name for path in paths],
        "unit": UNIT_NAMES[recipe.units],
        "verdicts": {
            f"{check}, {lobe.points.cam.name}": verdict
            for lobe, own in zip(result.cams, sections, strict=True)
            for check, verdict in own["verdicts"].items()
        },
        "lobes": [
            {"name": lobe.points.cam.name, "phase": _phase(lobe.phase), **own}
            for lobe, own in zip(result.cams, sections, strict=True)
        ],
        "datum": result.cams[0].points.cam.name,
        "missing": list(result.missing),
    }
    if result.late is not None:
        entry["turned_late_deg"] = math.degrees(result.late)
    if result.leaning is not None:
        entry["axis"] = result.leaning.section(recipe)
    entry["remarks"] = list(result.remarks)
    return entry


def _phase(phase: Phase) -> dict[str, float]:
    return {
        "late_deg": math.degrees(phase.late),
        "uncertainty_deg": math.degrees(phase.uncertainty),
        "against_datum_deg": math.degrees(phase.against),
        "against_datum_uncertainty_deg": math.degrees(phase.against_uncertainty),
    }
