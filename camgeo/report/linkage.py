"""The linkage in the report: mobility, figures of the intended motion, dwells, and the errors of the files.

In the section, angles are in degrees, lengths in the recipe's unit, velocities and accelerations by radian of shaft or
relative angle. A place has both angles: the shaft's, and the relative angle between cam and frame.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from camgeo.measures.units import in_units
from camgeo.synthesis.linkage import OVER

if TYPE_CHECKING:
    from collections.abc import Sequence

    from camgeo.measures.file_result import FileResult
    from camgeo.recipe.recipe import Recipe
    from camgeo.synthesis.linkage import DesignedLinkage
    from kin.follower.frame import LinkageVerdict
    from kin.follower.motion_error import MotionError, Play
    from kin.linkage.extremes import ExtremePlace, Figures


def linkage_section(recipe: Recipe, driven: DesignedLinkage, files: Sequence[FileResult]) -> dict[str, Any]:
    """Section of the report on the linkage of a recipe, as plain data.

    Its `error` is the error of the output with the file in which it is greatest, and is absent without judged files. Of
    a mechanism that does not turn right round the section has mobility alone.
    """
    mechanism, mobility = driven.mechanism, driven.mechanism.mobility()
    length_unit = in_units(recipe, None, "mm")[1]
    scale, unit = (math.degrees(1.0), "deg") if mechanism.unit == "deg" else (1.0 / recipe.mm, length_unit)
    judged = [(file.path.name, file.linkage) for file in files if file.linkage is not None]
    # what a mechanism that binds has, too
    section: dict[str, Any] = {
        "kind": None if recipe.linkage is None else recipe.linkage.kind,
        "margin": {"value": mobility.margin / recipe.mm, "unit": length_unit, "loop": mobility.loop},
        "binds_at_deg": _spans(mobility.binds),
        "reverses_at_deg": _spans(mobility.reverses),
        "shaft_rate": {"min": mobility.least_rate, "relative_deg": math.degrees(mobility.rate_at)},
        "dwells": [],
    }
    if driven.figures is None:
        return section
    section |= _figures(driven.figures, scale, unit)
    section["dwells"] = _dwells(recipe, driven, judged, scale)
    # the limit is the recipe's, or else the one that the judge derived from the tolerance
    if judged:
        name, worst = max(judged, key=lambda pair: pair[1].error.max)
        limit = recipe.verify.output_error
        permitted = worst.limit if limit is None else limit * (math.degrees(1.0) if mechanism.unit == "deg" else 1.0)
        section["error"] = {**_error(recipe, worst.error), "limit": in_units(recipe, permitted, mechanism.unit)[0]}
        section["error"]["file"] = name
        section["files"] = [_file(recipe, name, verdict) for name, verdict in judged]
    return section


def _spans(spans: Sequence[tuple[float, float]]) -> list[list[float]]:
    """Spans of the relative angle, degrees; one that runs through 0 ends beyond 360."""
    return [[math.degrees(begin), math.degrees(end)] for begin, end in spans]


def _place(place: ExtremePlace, scale: float) -> dict[str, float]:
    return {
        "value": place.value * scale,
        "shaft_deg": math.degrees(place.shaft),
        "relative_deg": math.degrees(place.relative),
    }


def _figures(figures: Figures, scale: float, unit: str) -> dict[str, Any]:
    turn = math.degrees(1.0)
    least, greatest = _place(figures.least, scale), _place(figures.greatest, scale)
    return {
        "output": {"unit": unit, "min": least["value"], "max": greatest["value"], "min_at": least, "max_at": greatest},
        "swing": figures.swing * scale,
        "frame": {"unit": "deg", "min": figures.frame_least.value * turn, "max": figures.frame_greatest.value * turn},
        "transmission_angle": {
            "min": figures.transmission_least.value * turn,
            "max": figures.transmission_greatest.value * turn,
            "min_at_deg": math.degrees(figures.transmission_least.shaft),
        },
        "force_angle": {
            "min": figures.force_least.value * turn,
            "min_at_deg": math.degrees(figures.force_least.shaft),
        },
        "dead_centres": [
            {"shaft_deg": math.degrees(place.shaft), "relative_deg": math.degrees(place.relative)}
            for place in figures.dead_centres
        ],
        "peaks": {
            "shaft": {
                "velocity": _place(figures.velocity, scale),
                "acceleration": _place(figures.acceleration, scale),
            },
            "relative": {
                "velocity": _place(figures.velocity_relative, scale),
                "acceleration": _place(figures.acceleration_relative, scale),
            },
        },
    }


def _dwells(
    recipe: Recipe, driven: DesignedLinkage, judged: Sequence[tuple[str, LinkageVerdict]], scale: float
) -> list[dict[str, Any]]:
    """Rows of the dwells; those over the angle that the recipe names come first."""
    demanded = recipe.dwell
    if demanded is None:
        return []
    band = demanded.band * scale
    rows: list[dict[str, Any]] = [
        {
            "over": over,
            "band": band,
            "start_deg": math.degrees(dwell.start),
            "length_deg": math.degrees(dwell.length),
            "from": "intended",
        }
        for over in sorted(OVER, key=lambda over: over != demanded.over)
        for dwell in driven.dwells[over]
    ]
    # of the ways in which a frame with play can rest, that in which the dwell is shortest
    rows += [
        {"over": dwell.over, "band": band, "start_deg": dwell.start_deg, "length_deg": dwell.length_deg, "from": name}
        for name, verdict in judged
        for dwell in verdict.dwells[:1]
    ]
    return rows


def _error(recipe: Recipe, error: MotionError) -> dict[str, Any]:
    greatest, unit = in_units(recipe, error.max, error.unit)
    rms, _ = in_units(recipe, error.rms, error.unit)
    return {"max": greatest, "rms": rms, "unit": unit, "at_deg": error.at_deg}


def _file(recipe: Recipe, name: str, verdict: LinkageVerdict) -> dict[str, Any]:
    return {
        "path": name,
        "error": _error(recipe, verdict.error),
        "centred": _error(recipe, verdict.centred),
        "backlash_across": _backlash(recipe, verdict.play_across),
        "backlash_along": _backlash(recipe, verdict.play_along),
        "shaft_rate": verdict.least_rate,
    }


def _backlash(recipe: Recipe, play: Play) -> dict[str, Any]:
    least, unit = in_units(recipe, play.least, play.unit)
    most, _ = in_units(recipe, play.most, play.unit)
    return {"min": least, "min_at_deg": play.least_at_deg, "max": most, "max_at_deg": play.most_at_deg, "unit": unit}
