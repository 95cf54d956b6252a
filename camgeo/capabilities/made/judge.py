"""Points against a recipe: profile, motion and verdicts.

Everything is in mm and radians until the section is written, which is in the recipe's units and degrees.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from camgeo.capabilities.made.checks import MOTION, OUTPUT, PROFILE
from camgeo.capabilities.made.keys import Made, datum_of
from camgeo.capabilities.made.placed import demand_discs, name_of, points_of
from camgeo.synthesis.intent import closures_between, permitted
from kin.judge.check import Check
from kin.made.motion import COVERAGE, Errors, OutputErrors, Play, between, contact_errors, output_errors, paired
from kin.made.points import profile, settled
from kin.made.smooth import Fit, fit
from kin.numeric.angles import degrees
from kin.numeric.feet import equal_steps
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from pathlib import Path

    from camgeo.capabilities.made.placed import DiscPoints, Points
    from camgeo.capabilities.made.reading import Call, OnSurface
    from camgeo.recipe.recipe import Recipe
    from camgeo.synthesis.design import Design
    from kin.judge.intent import PartIntent
    from kin.made.motion import Influence
    from kin.made.points import Datum, Placing, Profile
    from kin.numeric.arrays import Array

TURNED = math.radians(0.25)  # from which on lifts, and cams of a shaft, are said to be turned


@dataclass(frozen=True, eq=False)
class SurfaceMade:
    """Result for one surface: its points, its smoothed deviation, the errors of its follower, and the play."""

    on: OnSurface
    fit: Fit
    errors: Errors
    play: Play | None


@dataclass(frozen=True, eq=False)
class DiscMade:
    """Result for one disc, from its measured points.

    surfaces     results of each of its surfaces
    profile      deviation of the profile over all their points, by the datum
    placing      shift and turn that were taken out before (`align`)
    turned       known turn of the disc, rad: its points are turned back by it, its motion is not
    uncertain    expanded uncertainty of every point's deviation (n,), mm
    smoothed     greatest magnitude of the smoothed deviation as the datum places it, mm
    """

    part: PartIntent
    surfaces: tuple[SurfaceMade, ...]
    profile: Profile
    placing: Placing
    turned: float
    uncertain: Array
    smoothed: float


@dataclass(frozen=True, eq=False)
class PartMade:
    """Result for a part, from all points of a call; mm and rad.

    motion, play   errors of the follower and its play: midway where two contacts or surfaces hold it
    output         errors of a linkage's output; None without a linkage
    lifts          zero of the readings, and their lateness that was turned back; None of points that are not lifts
    remarks        sentences for the report
    unit           mm in the unit of the files
    """

    discs: tuple[DiscMade, ...]
    motion: Errors
    play: Play | None
    output: OutputErrors | None
    lifts: tuple[float, float] | None
    remarks: tuple[str, ...]
    unit: float

    @property
    def surfaces(self) -> tuple[SurfaceMade, ...]:
        """The surfaces of all discs."""
        return tuple(surface for disc in self.discs for surface in disc.surfaces)


def made_part(recipe: Recipe, design: Design, paths: Sequence[Path], call: Call) -> PartMade:
    """Judge a part by its measured points; give deviations, errors of the motion, and remarks.

    Raises CallError for points that cannot be judged, and the errors of kin.
    """
    datum = datum_of(recipe.of(Made), recipe.part)
    return part_of_points(recipe, design, points_of(recipe, design, paths, call.probing), call, datum)


def part_of_points(recipe: Recipe, design: Design, points: Points, call: Call, datum: Datum) -> PartMade:
    """Judge a part by its points, with the profile's datum given; raises as `made_part`."""
    demand_discs(points.missing)
    discs = [_disc(recipe, disc, call, datum) for disc in points.discs]
    each = {surface.on.surface.name: (surface.errors, surface.play) for disc in discs for surface in disc.surfaces}
    motion, play = follower_motion(design, each)
    remarks = [*points.remarks, *_remarks(recipe, discs, call, points.lifts)]
    late = (
        motion.phase[0] if points.lifts is not None and not call.probing.align and call.probing.alone is None else 0.0
    )
    if abs(late) > TURNED:
        remarks.append(f"the lifts look turned by {math.degrees(late):.3g} degrees: `--align rotation`")
    output = _output([disc.part for disc in discs], discs)
    return PartMade(tuple(discs), motion, play, output, points.lifts, tuple(remarks), points.unit)


def _disc(recipe: Recipe, points: DiscPoints, call: Call, datum: Datum) -> DiscMade:
    """Smooth the points of a disc, and let the followers run on each surface."""
    standing = [
        surface.points.placed(points.placing) if datum == "part" else surface.points for surface in points.surfaces
    ]
    profiled = profile(standing, datum)
    shaft = equal_steps(recipe.verify.angles) + math.pi / recipe.verify.angles
    surfaces = []
    for surface in points.surfaces:
        deviations = surface.points.deviations
        smooth = fit(deviations.parameter, deviations.e, call.spans)
        errors = contact_errors(surface.surface.gauge, surface.surface.side, smooth.curve, shaft, points.turned)
        surfaces.append(SurfaceMade(surface, smooth, *paired(surface.surface.gauge, errors)))
    smoothed = [
        float(np.abs(fit(surface.parameter, surface.e, own.fit.curve.spans).curve.rows(surface.parameter)[0]).max())
        for surface, own in zip(profiled.deviations, surfaces, strict=True)
    ]
    uncertain = _uncertain(surfaces, call)
    return DiscMade(points.part, tuple(surfaces), profiled, points.placing, points.turned, uncertain, max(smoothed))


def _uncertain(surfaces: Sequence[SurfaceMade], call: Call) -> Array:
    """Expanded uncertainty (n,) of every point, mm: as stated, else of the scatter alone; with that of the axes."""
    rows = []
    for surface in surfaces:
        deviations = surface.on.points.deviations
        point = COVERAGE * surface.fit.curve.sigma if call.error is None else call.error
        square = np.full(len(deviations.e), point**2)
        if call.axes is not None:
            square += call.axes[0] ** 2 + (call.axes[1] * deviations.moment) ** 2
        rows.append(np.sqrt(square))
    return np.concatenate(rows)


def follower_motion(design: Design, each: Mapping[str, tuple[Errors, Play | None]]) -> tuple[Errors, Play | None]:
    """Motion errors and play of the follower: on its only surface, or midway between the two that hold it."""
    for closure in closures_between(design):
        return between(each[closure.pushes][0], each[closure.stops][0])
    (motion,) = each.values()
    return motion


def _output(parts: Sequence[PartIntent], discs: Sequence[DiscMade]) -> OutputErrors | None:
    """Errors of a linkage's output that the made cam gives; None without a linkage."""
    linkage = parts[0].linkage
    if linkage is None:
        return None
    (surface,) = discs[0].surfaces
    relative = surface.errors.shaft
    return output_errors(linkage.mechanism, surface.on.surface.gauge, surface.fit.curve, relative, linkage.overlap)


def systematic(call: Call) -> float:
    """Expanded uncertainty of the metal that does not average out, mm: of the probe and of the axes' shift."""
    return math.hypot(call.error or 0.0, 0.0 if call.axes is None else call.axes[0])


def expanded(call: Call, influence: Influence) -> float:
    """Expanded uncertainty (k = 2) of a figure: root sum of squares of noise, probe and shift of the axes.

    The probe's error acts at worst, as it is common to all points. The result is in the unit of the figure.
    """
    shift = 0.0 if call.axes is None else call.axes[0]
    shifted = math.hypot(*influence.shifted.tolist())
    return math.hypot(COVERAGE * influence.sd, influence.worst * (call.error or 0.0), shifted * shift)


def motion_uncertainty(result: PartMade, call: Call) -> Array:
    """Expanded uncertainty of the motion over its shaft angles (n,), mm or rad."""
    turning = 0.0 if call.axes is None else call.axes[1]
    expanded: Array = np.hypot(result.motion.uncertainty(systematic(call)), turning * np.abs(result.motion.intended[1]))
    return expanded


def checks_of(recipe: Recipe, result: PartMade, call: Call) -> tuple[list[Check], dict[str, str]]:
    """Checks on the profile of each disc, the motion and the output, where there is a limit; and their verdicts."""
    checks, verdicts = [], {}
    zone = recipe.of(Made)
    if zone is not None and zone.profile is not None:
        for disc in result.discs:
            e = np.abs(disc.profile.e)
            worst = int(np.argmax(e + disc.uncertain))
            judged = _held(PROFILE.name, 2.0 * e, 2.0 * disc.uncertain, zone.profile, "mm")
            parameter = np.concatenate([deviation.parameter for deviation in disc.profile.deviations])
            at = disc.surfaces[0].on.surface.gauge.shaft_angle(parameter[worst : worst + 1])[0]
            name = name_of(disc.part)
            checks.append(replace(judged[0], at_deg=degrees(float(at)), surface=name))
            verdicts[f"{PROFILE.name} {name}".strip()] = judged[1]
    limits = permitted(recipe, recipe.export.tolerance)
    if limits.motion is not None:
        off, uncertain = np.abs(result.motion.remaining), motion_uncertainty(result, call)
        unit = result.surfaces[0].on.surface.gauge.unit
        turn = math.degrees(1.0) if unit == "deg" else 1.0
        judged = _held(MOTION.name, turn * off, turn * uncertain, limits.motion, unit)
        worst = int(np.argmax(off + uncertain))
        checks.append(replace(judged[0], at_deg=degrees(float(result.motion.shaft[worst]))))
        verdicts[MOTION.name] = judged[1]
    if limits.output is not None and result.output is not None:
        linkage = result.discs[0].part.linkage
        assert linkage is not None
        swings = linkage.mechanism.unit == "deg"
        turn = math.degrees(1.0) if swings else 1.0
        off = np.abs(result.output.worst)
        gain = COVERAGE * result.output.sds
        judged = _held(OUTPUT.name, turn * off, turn * gain, limits.output, "deg" if swings else "mm")
        worst = int(np.argmax(off + gain))
        checks.append(replace(judged[0], at_deg=degrees(float(result.output.shaft[worst]))))
        verdicts[OUTPUT.name] = judged[1]
    return checks, verdicts


def _held(name: str, value: Array, uncertain: Array, limit: float, unit: str) -> tuple[Check, str]:
    """A check by the rule of ISO 14253-1, and its verdict: ok, failed, or not proved where neither is certain."""
    sure, above = bool((value + uncertain <= limit).all()), bool((value - uncertain > limit).any())
    verdict = "ok" if sure else "failed" if above else "not proved"
    worst = int(np.argmax(value))
    value_words = f"{value[worst]:.4g} +- {uncertain[worst]:.2g} {unit}"
    detail = "" if sure else f"{value_words}: {'more than is permitted' if above else 'not proved either way'}"
    return Check(name, sure, float(value[worst]), limit, unit, detail=detail), verdict


def _remarks(recipe: Recipe, discs: Sequence[DiscMade], call: Call, lifts: tuple[float, float] | None) -> list[str]:
    """Remarks in sentences: what is assumed, what the points cannot show, and which points were left out."""
    remarks = []
    limits = permitted(recipe, recipe.export.tolerance)
    zone = recipe.of(Made)
    if (zone is None or zone.profile is None) and limits.motion is None:
        remarks.append("no limit is given, so nothing fails: made.profile, verify.motion_error")
    if call.error is None:
        remarks.append("without --probe-error the scatter of the points alone is known, and no common error")
    if call.axes is None:
        remarks.append("without --axes-error the part's axes are taken as exact")
    every = [surface for disc in discs for surface in disc.surfaces]
    if lifts is not None:
        remarks.append("of lifts the size and a constant offset are unseen")
    if call.probing.align == "gxy":
        remarks.append("placed by --align best-fit, the motion shows neither eccentricity nor phase")
    elif call.probing.align or (lifts is not None and lifts[1]):
        turn = math.degrees(discs[0].placing.turn if lifts is None else lifts[1])
        remarks.append(f"turned back by {turn:.6g} degrees by --align rotation, the motion shows no phase")
    for disc in discs:
        profile = disc.profile
        if profile.datum == "none":
            remarks.append("by datum none the profile shows neither eccentricity nor phase; the motion does")
        wanted = {"part": "", "bore": "g", "none": "gxy"}[profile.datum]
        if profile.free != wanted:
            remarks.append("its contour is so nearly round that a turn cannot be told from a shift")
        if profile.datum == "part" and not call.probing.align:
            turned = settled([surface.on.points for surface in disc.surfaces], "g")
            rest = disc.surfaces[0].on.points.placed(turned).deviations.e
            gain = float(np.abs(disc.surfaces[0].on.points.deviations.e).max() - np.abs(rest).max())
            if gain > 0.25 * disc.profile.greatest and abs(turned.turn) > 0.0:
                remarks.append(f"the points look turned by {math.degrees(turned.turn):.3g} degrees: `--align rotation`")
    for surface in every:
        if surface.fit.outliers.any():
            count = int(surface.fit.outliers.sum())
            lines = ", ".join(str(line) for line in surface.on.lines[surface.fit.outliers][:5].tolist())
            remarks.append(
                f"{count} outlier{'s' * (count > 1)} (line {lines}{', ...' if count > 5 else ''}) "
                "counted in the profile, left out of smoothing and motion"
            )
        if surface.fit.curve.widened > 1.0:
            remarks.append(
                f"residuals beside one another agree (correlation {surface.fit.correlation:.2f}): "
                f"uncertainties are widened {surface.fit.curve.widened:.2f} times"
            )
        if surface.on.spread is not None:
            spread = surface.on.spread / recipe.mm
            remarks.append(
                f"{surface.on.repeats} points are {len(surface.on.points)} places, measured again within {spread:.2g}"
            )
    return remarks
