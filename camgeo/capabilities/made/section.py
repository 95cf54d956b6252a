"""What points told, as a section of the report: in the recipe's units and degrees."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from camgeo.capabilities.made.judge import expanded, motion_uncertainty, systematic
from camgeo.capabilities.made.keys import Made
from camgeo.capabilities.made.placed import name_of
from camgeo.measures.units import UNIT_NAMES
from camgeo.registry import registry
from camgeo.registry.capability import MadeMotion
from kin.made.causes import causes
from kin.made.motion import COVERAGE, least_fault
from kin.numeric.angles import degrees
from kin.numeric.feet import equal_steps

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from pathlib import Path

    from camgeo.capabilities.made.judge import DiscMade, PartMade, SurfaceMade
    from camgeo.capabilities.made.reading import Call
    from camgeo.recipe.recipe import Recipe
    from camgeo.synthesis.design import Design
    from kin.made.points import Placing
    from kin.numeric.arrays import Array

MOST_OUTLIERS = 50  # listed one by one
DERIVATIVES = ("error", "velocity", "acceleration")


def section(
    recipe: Recipe, paths: Sequence[Path], result: PartMade, call: Call, verdicts: Mapping[str, str]
) -> dict[str, Any]:
    """Give the section `made`."""
    entry: dict[str, Any] = {
        "files": [path.name for path in paths],
        "unit": UNIT_NAMES[recipe.units],
        "verdicts": dict(verdicts),
        "discs": [_disc(recipe, disc) for disc in result.discs],
        "surfaces": [_surface(recipe, paths, surface) for surface in result.surfaces],
        "motion": motion_section(recipe, result, call),
    }
    if result.play is not None:
        worst = {key: int(pick(result.play.gap)) for key, pick in (("least", np.argmin), ("most", np.argmax))}
        scale, unit = scale_of(recipe, result)
        entry["play"] = {"unit": unit}
        for key, at in worst.items():
            entry["play"][key] = scale * float(result.play.gap[at])
            entry["play"][f"{key}_at_deg"] = degrees(float(result.play.shaft[at]))
        entry["play"]["uncertainty"] = scale * COVERAGE * float(result.play.sds.max())
    if result.output is not None:
        linkage = result.discs[0].part.linkage
        swings = linkage is not None and linkage.mechanism.unit == "deg"
        factor = math.degrees(1.0) if swings else 1.0 / recipe.mm
        worst_at = int(np.argmax(np.abs(result.output.worst)))
        entry["output"] = {
            "unit": "deg" if swings else UNIT_NAMES[recipe.units],
            "max": factor * abs(float(result.output.worst[worst_at])),
            "at_deg": degrees(float(result.output.shaft[worst_at])),
            "centred": factor * float(np.abs(result.output.centred).max()),
            "uncertainty": factor * COVERAGE * float(result.output.sds[worst_at]),
        }
    if result.lifts is not None:
        scale, _ = scale_of(recipe, result)
        entry["lifts"] = {"zero": scale * result.lifts[0], "turned_deg": math.degrees(result.lifts[1])}
    entry["remarks"] = list(result.remarks)
    return entry


def add_figures(entry: dict[str, Any], recipe: Recipe, design: Design, result: PartMade) -> None:
    """Add to a section what other capabilities make of the part's motion; raises RecipeErrors as they do."""
    errors = result.motion
    rows = np.stack([errors.remaining, errors.rows[1], errors.rows[2]])
    gap = None if result.play is None else np.stack([result.play.gap, result.play.sds])
    motion = MadeMotion(errors.shaft, rows, errors.sds, lambda weights: errors.influence(weights).sd, gap)
    made = [capability.on_metal(recipe, design, motion) for capability in registry.in_order(recipe.uses)]
    if figures := [figure._asdict() for metal in made for figure in metal.figures]:
        entry["figures"] = figures
    entry["remarks"] += [remark for metal in made for remark in metal.remarks]


def scale_of(recipe: Recipe, result: PartMade) -> tuple[float, str]:
    """Factor and unit of the follower's motion in a report."""
    swings = result.surfaces[0].on.surface.gauge.unit == "deg"
    return (math.degrees(1.0), "deg") if swings else (1.0 / recipe.mm, UNIT_NAMES[recipe.units])


def _disc(recipe: Recipe, disc: DiscMade) -> dict[str, Any]:
    mm, profile = recipe.mm, disc.profile
    worst = int(np.argmax(np.abs(profile.e)))
    surface, index = _of_all(disc, worst)
    parameter = profile.deviations[surface].parameter[index : index + 1]
    gauge = disc.surfaces[surface].on.surface.gauge
    entry: dict[str, Any] = {
        "name": name_of(disc.part),
        "datum": profile.datum,
        "profile": 2.0 * profile.greatest / mm,
        "greatest": float(profile.e[worst]) / mm,
        "at_deg": degrees(float(gauge.shaft_angle(parameter)[0])),
        "line": int(disc.surfaces[surface].on.lines[index]),
        "uncertainty": 2.0 * float(disc.uncertain[worst]) / mm,
        "smoothed": 2.0 * disc.smoothed / mm,
        "least_squares": {"profile": 2.0 * profile.least[1] / mm, **_placing(recipe, profile.least[0])},
        **_placing(recipe, profile.placing),
    }
    if profile.turns is not None and profile.turns[1] - profile.turns[0] > 1e-9:
        entry["turned_from_deg"], entry["turned_to_deg"] = (math.degrees(turn) for turn in profile.turns)
    if profile.certified is not None:
        entry["certificate"] = 2.0 * profile.certified.certificate / mm
        entry["multipliers"] = profile.certified.multipliers.tolist()
    entry["causes"] = _causes(recipe, disc)
    zone = recipe.of(Made)
    lack = 0.0 if zone is None or zone.profile is None else -float(profile.e.min()) - 0.5 * zone.profile
    if lack > 0.0:
        entry["reduction"] = _reduction(recipe, disc, lack)
    if disc.placing.turn or any(disc.placing.shift):
        entry["aligned"] = _placing(recipe, disc.placing)
    return entry


def _reduction(recipe: Recipe, disc: DiscMade, lack: float) -> dict[str, Any]:
    """Least reduction all round that leaves no metal lacking, and what it does to the motion: offset, and change."""
    swings = disc.surfaces[0].on.surface.gauge.unit == "deg"
    scale = math.degrees(1.0) if swings else 1.0 / recipe.mm
    moved = -lack * disc.surfaces[0].errors.gain
    offset = float(moved.mean())
    return {
        "size": lack / recipe.mm,
        "offset": scale * offset,
        "change": scale * float(np.abs(moved - offset).max()),
        "unit": "deg" if swings else UNIT_NAMES[recipe.units],
    }


def _causes(recipe: Recipe, disc: DiscMade) -> list[dict[str, Any]]:
    """Report rows of the causes of the deviations, greatest effect first; directions are those of the drawing.

    The points are taken as they stand, before they are placed by a datum.
    """
    sign = -1.0 if recipe.rotation == "ccw" else 1.0
    rows = []
    deviations, curves = (
        [surface.on.points.deviations for surface in disc.surfaces],
        [surface.fit.curve for surface in disc.surfaces],
    )
    for cause in causes(deviations, curves, disc.turned):
        turned, mirrored = cause.names == ("turned",), cause.names in {("turned",), ("shifted along y",)}
        scale = (math.degrees(1.0) if turned else 1.0 / recipe.mm) * (sign if mirrored else 1.0)
        row: dict[str, Any] = {
            "cause": " and ".join(cause.names),
            "value": scale * cause.value,
            "uncertainty": abs(scale) * cause.uncertainty,
            "unit": "deg" if turned else UNIT_NAMES[recipe.units],
            "effect": cause.effect / recipe.mm,
        }
        if cause.at is not None:
            gauge = disc.surfaces[0].on.surface.gauge
            row["at_deg"] = degrees(float(gauge.shaft_angle(np.array([cause.at]))[0]))
        if cause.waves is not None:
            row["waves"] = cause.waves
        rows.append(row)
    return rows


def _of_all(disc: DiscMade, index: int) -> tuple[int, int]:
    """Surface, and index among its points, of a point among all of a disc."""
    for rank, surface in enumerate(disc.surfaces):
        if index < len(surface.on.points):
            return rank, index
        index -= len(surface.on.points)
    raise IndexError(index)


def _placing(recipe: Recipe, placing: Placing) -> dict[str, Any]:
    """Turn and shift, as the file is drawn."""
    sign = -1.0 if recipe.rotation == "ccw" else 1.0
    x, y = placing.shift
    return {"turned_deg": sign * math.degrees(placing.turn), "shifted": [x / recipe.mm, sign * y / recipe.mm]}


def _surface(recipe: Recipe, paths: Sequence[Path], surface: SurfaceMade) -> dict[str, Any]:
    mm, curve, count = recipe.mm, surface.fit.curve, len(surface.on.points)
    wide = count / curve.spans * math.sqrt(math.pi)
    outliers = [
        {
            "file": paths[int(surface.on.files[i])].name,
            "line": int(surface.on.lines[i]),
            "residual": float(surface.fit.residuals[i]) / mm,
        }
        for i in np.flatnonzero(surface.fit.outliers)[:MOST_OUTLIERS].tolist()
    ]
    return {
        "name": surface.on.surface.name,
        "points": surface.on.repeats,
        "places": count,
        "spans": curve.spans,
        "noise": curve.sigma / mm,
        "smoothing": COVERAGE * float(curve.standard_deviations(equal_steps(720)).max()) / mm,
        "correlation": surface.fit.correlation,
        "widened": curve.widened,
        "least_fault_point": least_fault(curve.sigma, 1.0, count) / mm,
        "least_fault_span": least_fault(curve.sigma, wide, curve.spans) / mm,
        "span_deg": 360.0 / curve.spans,
        "outliers": outliers,
        "outlier_count": int(surface.fit.outliers.sum()),
    }


def motion_section(recipe: Recipe, result: PartMade, call: Call) -> dict[str, Any]:
    """Errors of the motion with their uncertainties."""
    scale, unit = scale_of(recipe, result)
    errors = result.motion
    uncertain = motion_uncertainty(result, call)
    phase, remaining = errors.phase
    rows = np.stack([errors.remaining, errors.rows[1], errors.rows[2]])
    common: Array = np.abs(errors.gain) * systematic(call)
    entry: dict[str, Any] = {"unit": unit, "offset": scale * errors.offset}
    entry["offset_uncertainty"] = scale * float(common.mean())
    for k, name in enumerate(DERIVATIVES):
        at = int(np.nanargmax(np.abs(rows[k])))
        own = uncertain[at] if k == 0 else COVERAGE * errors.sds[k, at]
        entry[name] = {
            "max": scale * float(rows[k, at]),
            "at_deg": degrees(float(errors.shaft[at])),
            "uncertainty": scale * float(own),
            "unit": unit + ("", "/rad", "/rad^2")[k],
        }
    sign = -1.0 if recipe.rotation == "ccw" else 1.0
    turning = 0.0 if call.axes is None else call.axes[1]
    own = math.hypot(expanded(call, errors.influence(errors.phase_weights)), turning)
    entry["phase_deg"] = sign * math.degrees(phase)
    entry["phase_uncertainty_deg"] = math.degrees(own)
    entry["without_phase"] = scale * float(np.abs(remaining).max())
    made_peak, meant_peak = errors.peak_acceleration
    entry["peak_acceleration"] = {"made": scale * made_peak, "intended": scale * meant_peak, "unit": f"{unit}/rad^2"}
    return entry
