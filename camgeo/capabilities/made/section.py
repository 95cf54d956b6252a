"""The section `made` of a report on measured points, of a part or of a shaft: in the recipe's units and degrees."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from camgeo.capabilities.made.extension import ON_METAL, MadeMotion
from camgeo.capabilities.made.made_part import motion_uncertainty
from camgeo.capabilities.made.part_points import name_of
from camgeo.measures.units import UNIT_NAMES, report_unit
from kin.follower.recognised import COVERAGE
from kin.made.motion import least_fault
from kin.numeric.angles import degrees
from kin.numeric.feet import equal_steps

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from pathlib import Path

    from camgeo.capabilities.made.made_part import DiscMade, PartMade, SurfaceMade
    from camgeo.capabilities.made.options import PointOptions
    from camgeo.capabilities.made.shaft import Phase, ShaftMade
    from camgeo.recipe.recipe import Recipe, ShaftOrder
    from camgeo.synthesis.design import Design
    from kin.made.points import Placing

MOST_OUTLIERS = 50  # listed one by one, the worst first
DERIVATIVES = ("error", "velocity", "acceleration")


def section(
    recipe: Recipe, paths: Sequence[Path], result: PartMade, options: PointOptions, verdicts: Mapping[str, str]
) -> dict[str, Any]:
    """Section `made` of the report on a part as plain data, lengths in the recipe's unit, angles in degrees."""
    entry: dict[str, Any] = {
        "files": [path.name for path in paths],
        "unit": UNIT_NAMES[recipe.units],
        "verdicts": dict(verdicts),
        "discs": [_disc(recipe, disc) for disc in result.discs],
        "surfaces": [_surface(recipe, paths, surface) for surface in result.surfaces],
        "motion": _motion(recipe, result, options),
    }
    # keys of followers held from both sides, of linkages and of lifts
    scale, unit = report_unit(recipe, result.motion_unit)
    if (play := result.play) is not None:
        entry["play"] = {"unit": unit}
        for key, worst in (("least", int(np.argmin(play.gap))), ("most", int(np.argmax(play.gap)))):
            entry["play"][key] = scale * float(play.gap[worst])
            entry["play"][f"{key}_at_deg"] = degrees(float(play.shaft[worst]))
        entry["play"]["uncertainty"] = scale * float(play.uncertainty(options.error or 0.0, options.axes_shift).max())
    if (output := result.output) is not None:
        factor, output_unit = report_unit(recipe, result.output_unit)
        worst = int(np.argmax(np.abs(output.worst)))
        entry["output"] = {
            "unit": output_unit,
            "max": factor * abs(float(output.worst[worst])),
            "at_deg": degrees(float(output.shaft[worst])),
            "centred": factor * float(np.abs(output.centred).max()),
            "uncertainty": factor * float(output.uncertainty(options.systematic, options.axes_turn)[worst]),
        }
    if result.lifts is not None:
        entry["lifts"] = {"zero": scale * result.lifts[0], "turned_deg": math.degrees(result.lifts[1])}
    entry["remarks"] = list(result.remarks)
    return entry


def add_figures(entry: dict[str, Any], recipe: Recipe, design: Design, result: PartMade) -> None:
    """Add `figures` and `remarks` of other capabilities on the part's motion to a section `entry`.

    Raises RecipeErrors where a capability cannot compute its figures, as under a load that has no bound.
    """
    errors = result.motion
    rows = np.stack([errors.remaining, errors.rows[1], errors.rows[2]])
    gap = None if result.play is None else np.stack([result.play.gap, result.play.sds])
    motion = MadeMotion(errors.shaft, rows, errors.sds, lambda weights: errors.influence(weights).sd, gap)
    made = [answers.figures(recipe, design, motion) for answers in ON_METAL.of(recipe.uses)]
    if figures := [figure._asdict() for metal in made for figure in metal.figures]:
        entry["figures"] = figures
    entry["remarks"] += [remark for metal in made for remark in metal.remarks]


def _disc(recipe: Recipe, disc: DiscMade) -> dict[str, Any]:
    """Report entry of one disc: its profile, placings, causes and cure, lengths in the recipe's unit."""
    mm, profile = recipe.mm, disc.profile
    worst = profile.worst
    surface, index = _surface_of(disc, worst)
    parameter = profile.deviations[surface].parameter[index : index + 1]
    gauge = disc.surfaces[surface].gauge
    entry: dict[str, Any] = {
        "name": name_of(disc.part),
        "datum": profile.datum,
        "profile": 2.0 * profile.greatest / mm,
        "greatest": float(profile.e[worst]) / mm,
        "at_deg": degrees(float(gauge.shaft_angle(parameter)[0])),
        "line": int(disc.surfaces[surface].measured.lines[index]),
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
    # more than half the zone of metal is lacking: all round it could only be made smaller
    zone = recipe.profile
    lack = 0.0 if zone is None else -float(profile.e.min()) - 0.5 * zone
    if lack > 0.0:
        entry["reduction"] = _reduction(recipe, disc, lack)
    if disc.placing.turn or any(disc.placing.shift):
        entry["aligned"] = _placing(recipe, disc.placing)
    return entry


def _reduction(recipe: Recipe, disc: DiscMade, lack: float) -> dict[str, Any]:
    """Reduction all round by `lack`, mm, the least by which no metal is lacking, and its effect on the motion."""
    scale, unit = report_unit(recipe, disc.surfaces[0].gauge.unit)
    moved = -lack * disc.surfaces[0].errors.gain
    offset = float(moved.mean())
    return {
        "size": lack / recipe.mm,
        "offset": scale * offset,
        "change": scale * float(np.abs(moved - offset).max()),
        "unit": unit,
    }


def _causes(recipe: Recipe, disc: DiscMade) -> list[dict[str, Any]]:
    """Report rows of the causes of the deviations, greatest effect first; directions are those of the drawing.

    The points are taken as they stand, before they are placed by a datum.
    """
    rows = []
    for cause in disc.causes:
        mirrored = cause.names in {("turned",), ("shifted along y",)}
        scale, unit = report_unit(recipe, "deg" if cause.names == ("turned",) else "mm")
        scale *= _drawn(recipe) if mirrored else 1.0
        row: dict[str, Any] = {
            "cause": " and ".join(cause.names),
            "value": scale * cause.value,
            "uncertainty": abs(scale) * cause.uncertainty,
            "unit": unit,
            "effect": cause.effect / recipe.mm,
        }
        surface = disc.surfaces[cause.surface]
        if (fault := cause.fault) is not None:
            places = surface.gauge.shaft_angle(np.array([fault.at, fault.begin, fault.end]))
            row |= {key: degrees(float(at)) for key, at in zip(("at_deg", "from_deg", "to_deg"), places, strict=True)}
            row["metal"] = "too much" if fault.height > 0.0 else "missing"
        if fault is not None or cause.waves is not None:
            row["surface"] = surface.measured.intent.name
        if cause.waves is not None:
            row["waves"] = cause.waves
        rows.append(row)
    return rows


def _surface_of(disc: DiscMade, index: int) -> tuple[int, int]:
    """Index of the surface, and index among its points, of a point by its index among all of a disc."""
    for rank, surface in enumerate(disc.surfaces):
        if index < len(surface.measured.points):
            return rank, index
        index -= len(surface.measured.points)
    raise IndexError(index)


def _drawn(recipe: Recipe) -> float:
    """Sign of y and of turns in the file: -1 where it is drawn mirrored, for `rotation: ccw`."""
    return -1.0 if recipe.rotation == "ccw" else 1.0


def _placing(recipe: Recipe, placing: Placing) -> dict[str, Any]:
    """Turn, degrees, and shift, in the recipe's unit, as the file is drawn."""
    sign = _drawn(recipe)
    x, y = placing.shift
    return {"turned_deg": sign * math.degrees(placing.turn), "shifted": [x / recipe.mm, sign * y / recipe.mm]}


def _surface(recipe: Recipe, paths: Sequence[Path], surface: SurfaceMade) -> dict[str, Any]:
    """Report entry of one surface, lengths in the recipe's unit."""
    mm, curve, count = recipe.mm, surface.fit.curve, len(surface.measured.points)
    # sum of squares, over the points, of a bell exp(-x^2/2), x in spans
    wide = count / curve.spans * math.sqrt(math.pi)
    outliers = [
        {
            "file": paths[int(surface.measured.files[i])].name,
            "line": int(surface.measured.lines[i]),
            "residual": float(surface.fit.residuals[i]) / mm,
        }
        for i in surface.fit.worst[:MOST_OUTLIERS].tolist()
    ]
    return {
        "name": surface.measured.intent.name,
        "points": surface.measured.repeats,
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


def _motion(recipe: Recipe, result: PartMade, options: PointOptions) -> dict[str, Any]:
    """Entry on the follower's motion: offset, greatest errors of position, velocity and acceleration, phase, peaks.

    Each error and the phase have their expanded uncertainty; lengths in the recipe's unit, angles in degrees.
    """
    # position less its offset, velocity and acceleration
    scale, unit = report_unit(recipe, result.motion_unit)
    errors = result.motion
    uncertain = motion_uncertainty(result, options)
    phase, remaining = errors.phase
    rows = np.stack([errors.remaining, errors.rows[1], errors.rows[2]])
    even = np.full(len(errors.shaft), 1.0 / len(errors.shaft))
    entry: dict[str, Any] = {"unit": unit, "offset": scale * errors.offset}
    entry["offset_uncertainty"] = scale * options.expanded(errors.influence(even))
    for k, name in enumerate(DERIVATIVES):
        worst = int(np.nanargmax(np.abs(rows[k])))
        own = uncertain[worst] if k == 0 else COVERAGE * errors.sds[k, worst]
        entry[name] = {
            "max": scale * float(rows[k, worst]),
            "at_deg": degrees(float(errors.shaft[worst])),
            "uncertainty": scale * float(own),
            "unit": unit + ("", "/rad", "/rad^2")[k],
        }
    own = math.hypot(options.expanded(errors.influence(errors.phase_weights)), options.axes_turn)
    entry["phase_deg"] = _drawn(recipe) * math.degrees(phase)
    entry["phase_uncertainty_deg"] = math.degrees(own)
    entry["without_phase"] = scale * float(np.abs(remaining).max())
    made_peak, intended_peak = errors.peak_acceleration
    entry["peak_acceleration"] = {"made": scale * made_peak, "intended": scale * intended_peak, "unit": f"{unit}/rad^2"}
    return entry


# --- a shaft ----------------------------------------------------------------------------------------------------------


def shaft_section(
    recipe: ShaftOrder, paths: Sequence[Path], result: ShaftMade, sections: Sequence[dict[str, Any]]
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
    """Report entry of a phase, in degrees of the shaft."""
    return {
        "late_deg": math.degrees(phase.late),
        "uncertainty_deg": math.degrees(phase.uncertainty),
        "against_datum_deg": math.degrees(phase.against),
        "against_datum_uncertainty_deg": math.degrees(phase.against_uncertainty),
    }
