"""Points against a recipe: a part as made, its profile and motion, and verdicts on them; in mm and radians."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from camgeo.capabilities.made.checks import MOTION, OUTPUT, PROFILE
from camgeo.capabilities.made.keys import ZONE_PATH, Made, datum_of
from camgeo.capabilities.made.part_points import demand_points, name_of, part_points, read_tables
from camgeo.measures.units import UNIT_NAMES
from camgeo.synthesis.intent import closures_between, permitted
from kin.follower.recognised import COVERAGE
from kin.made.causes import causes
from kin.made.motion import Errors, MadePlay, OutputErrors, between, contact_errors, output_errors, paired
from kin.made.points import FREE, profile, settled
from kin.made.smooth import SmoothFit, fit
from kin.numeric.angles import degrees
from kin.numeric.check import Check
from kin.numeric.feet import equal_steps
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from pathlib import Path

    from camgeo.capabilities.made.options import PointOptions
    from camgeo.capabilities.made.part_points import DiscPoints, MeasuredSurface, PartPoints
    from camgeo.recipe.recipe import Recipe
    from camgeo.synthesis.design import Design
    from kin.follower.base import Follower as Gauge
    from kin.judge.intent import PartIntent
    from kin.made.causes import Cause
    from kin.made.points import Datum, Placing, Profile
    from kin.numeric.arrays import Array

TURNED = math.radians(0.25)  # lifts, and cams of a shaft, that are turned by more have a remark


@dataclass(frozen=True, eq=False)
class SurfaceMade:
    """Result for one surface: its points, its smoothed deviation, the motion errors of its follower, and the play.

    `play` is None unless two contacts on the surface hold the follower from both sides.
    """

    measured: MeasuredSurface
    fit: SmoothFit
    errors: Errors
    play: MadePlay | None

    @property
    def gauge(self) -> Gauge:
        """Follower of the surface with its intended motion."""
        return self.measured.gauge


@dataclass(frozen=True, eq=False)
class DiscMade:
    """Result for one disc, from its measured points.

    part         the disc as intended
    surfaces     results of each of its surfaces
    profile      deviation of the profile over all their points, by the datum
    placing      turn and shift that `align` took out of the points before
    turned       known turn of the disc, rad: its points are turned back by it, its motion is not
    uncertain    expanded uncertainty of the deviation of all points (n,), surface by surface, mm
    smoothed     greatest magnitude of the smoothed deviation as the datum places it, mm
    causes       certain causes of the deviations of the points as they stand, by falling effect
    """

    part: PartIntent
    surfaces: tuple[SurfaceMade, ...]
    profile: Profile
    placing: Placing
    turned: float
    uncertain: Array
    smoothed: float
    causes: tuple[Cause, ...]


@dataclass(frozen=True, eq=False)
class PartMade:
    """Result for a part, from all points of a call; mm and rad.

    motion, play   errors of the follower, midway where two contacts or surfaces hold it, and its play, else None
    output         errors of a linkage's output; None without a linkage
    lifts          zero of the readings, and the lateness that was taken out of them, rad; None for points x, y
    remarks        sentences for the report
    """

    discs: tuple[DiscMade, ...]
    motion: Errors
    play: MadePlay | None
    output: OutputErrors | None
    lifts: tuple[float, float] | None
    remarks: tuple[str, ...]

    @property
    def surfaces(self) -> tuple[SurfaceMade, ...]:
        """The surfaces of all discs."""
        return tuple(surface for disc in self.discs for surface in disc.surfaces)

    @property
    def motion_unit(self) -> str:
        """Unit in which the follower's motion is reported: mm, or deg where it swings."""
        return self.surfaces[0].gauge.unit

    @property
    def output_unit(self) -> str:
        """Unit in which a linkage's output is reported: mm, or deg where it turns; the follower's without a linkage."""
        linkage = self.discs[0].part.linkage
        return self.motion_unit if linkage is None else linkage.mechanism.unit


def made_part(recipe: Recipe, design: Design, paths: Sequence[Path], options: PointOptions) -> PartMade:
    """Judge a part by the points in files; the result has deviations, errors of the motion, and remarks.

    Raises CallError for files without points and a disc without any, UnlikePointsError for points of something else,
    SpansError for a number of spans that the points do not permit, UnsettledError and GapError for points that are too
    few or too far apart, ContactError and FrameError where the follower does not run on the metal that they show.
    """
    datum = datum_of(recipe.of(Made), recipe.part)
    points = part_points(recipe, design, read_tables(paths), options.probing)
    return part_of_points(recipe, design, points, options, datum)


def part_of_points(recipe: Recipe, design: Design, points: PartPoints, options: PointOptions, datum: Datum) -> PartMade:
    """Judge a part by its points and the datum of its profile; the result has deviations, motion errors, and remarks.

    Raises CallError where a disc has no points, SpansError for a number of spans that the points do not permit,
    UnsettledError and GapError for points that are too few or too far apart, ContactError and FrameError where the
    follower does not run on the metal that they show.
    """
    demand_points(points.missing)
    discs = [_disc(recipe, disc, options, datum) for disc in points.discs]
    errors = {
        surface.measured.intent.name: (surface.errors, surface.play) for disc in discs for surface in disc.surfaces
    }
    motion, play = follower_motion(design, errors)
    remarks = [*points.remarks, *_remarks(recipe, discs, options, points.lifts)]
    if points.lifts is not None and not options.probing.align and options.probing.turned is None:
        late = motion.phase[0]
        if abs(late) > TURNED:
            remarks.append(f"the lifts look turned by {math.degrees(late):.3g} degrees: `--align rotation`")
    return PartMade(tuple(discs), motion, play, _output(discs[0]), points.lifts, tuple(remarks))


def _disc(recipe: Recipe, points: DiscPoints, options: PointOptions, datum: Datum) -> DiscMade:
    """Smooth the points of a disc, and let the followers run on each surface."""
    # by the datum `part` the profile has the placing of `align`; other datums find their own
    standing = [
        surface.points.placed(points.placing) if datum == "part" else surface.points for surface in points.surfaces
    ]
    profiled = profile(standing, datum)
    shaft = equal_steps(recipe.verify.angles) + math.pi / recipe.verify.angles
    deviations = [surface.deviations for surface in points.surfaces]
    fits = [fit(own.parameter, own.e, options.spans) for own in deviations]
    named = causes(deviations, fits, points.turned)
    surfaces = []
    for rank, (surface, smooth) in enumerate(zip(points.surfaces, fits, strict=True)):
        faults = [cause.fault for cause in named if cause.fault is not None and cause.surface == rank]
        errors = contact_errors(surface.gauge, surface.intent.side, smooth.curve, shaft, points.turned, faults=faults)
        surfaces.append(SurfaceMade(surface, smooth, *paired(surface.gauge, errors)))
    # smoothed deviations once more, of the points as the datum places them
    smoothed = [
        float(np.abs(fit(placed.parameter, placed.e, own.fit.curve.spans).curve.rows(placed.parameter)[0]).max())
        for placed, own in zip(profiled.deviations, surfaces, strict=True)
    ]
    uncertain = np.concatenate([_uncertain(surface, options) for surface in surfaces])
    return DiscMade(
        points.part,
        tuple(surfaces),
        profiled,
        points.placing,
        points.turned,
        uncertain,
        smoothed=max(smoothed),
        causes=tuple(named),
    )


def _uncertain(surface: SurfaceMade, options: PointOptions) -> Array:
    """Expanded uncertainty (n,) of every point, mm, as stated, else by the scatter, with that of the axes."""
    deviations = surface.measured.deviations
    point = COVERAGE * surface.fit.curve.sigma if options.error is None else options.error
    square = np.full(len(deviations.e), point**2)
    if options.axes is not None:
        square += options.axes_shift**2 + (options.axes_turn * deviations.moment) ** 2
    uncertain: Array = np.sqrt(square)
    return uncertain


def follower_motion(
    design: Design, each: Mapping[str, tuple[Errors, MadePlay | None]]
) -> tuple[Errors, MadePlay | None]:
    """Motion errors and play of the follower, from those on each surface, by the name of the surface.

    Where two surfaces hold the follower they are midway between both; else they are those of its only surface.
    """
    for closure in closures_between(design):
        return between(each[closure.pushes][0], each[closure.stops][0])
    (motion,) = each.values()
    return motion


def _output(disc: DiscMade) -> OutputErrors | None:
    """Errors of a linkage's output that the made cam gives; None without a linkage."""
    linkage = disc.part.linkage
    if linkage is None:
        return None
    (surface,) = disc.surfaces
    return output_errors(linkage.mechanism, surface.gauge, surface.fit.curve, surface.errors.shaft, linkage.overlap)


def motion_uncertainty(result: PartMade, options: PointOptions) -> Array:
    """Expanded uncertainty of the motion error at its shaft angles (n,), mm or rad: noise, probe and axes."""
    turning = options.axes_turn * np.abs(result.motion.intended[1])
    expanded: Array = np.hypot(result.motion.uncertainty(options.systematic), turning)
    return expanded


# --- verdicts ---------------------------------------------------------------------------------------------------------


def checks_of(recipe: Recipe, result: PartMade, options: PointOptions) -> tuple[list[Check], dict[str, str]]:
    """Checks on the profile of each disc, the motion and the output, where the recipe limits them, and the verdicts.

    Verdicts are by the name of the check, for a disc with its name: `ok`, `failed` or `not proved`.
    """
    checks, verdicts = [], {}
    zone, limits = recipe.profile, permitted(recipe, recipe.export.tolerance)
    if zone is not None:
        for disc in result.discs:
            off, name = np.abs(disc.profile.e), name_of(disc.part)
            worst = disc.profile.worst
            parameter = np.concatenate([deviation.parameter for deviation in disc.profile.deviations])
            at = disc.surfaces[0].gauge.shaft_angle(parameter[worst : worst + 1])[0]
            check, verdict = _held(PROFILE.name, 2.0 * off, 2.0 * disc.uncertain, zone, unit="mm", at=at)
            checks.append(replace(check, surface=name))
            verdicts[f"{PROFILE.name} {name}".strip()] = verdict
    judged = []
    if limits.motion is not None:
        off, uncertain = np.abs(result.motion.remaining), motion_uncertainty(result, options)
        judged.append((MOTION.name, off, uncertain, limits.motion, result.motion_unit, result.motion.shaft))
    if limits.output is not None and result.output is not None:
        off, uncertain = np.abs(result.output.worst), result.output.uncertainty(options.systematic, options.axes_turn)
        judged.append((OUTPUT.name, off, uncertain, limits.output, result.output_unit, result.output.shaft))
    for name, off, uncertain, limit, unit, shaft in judged:
        scale, at = math.degrees(1.0) if unit == "deg" else 1.0, shaft[int(np.argmax(off))]
        check, verdicts[name] = _held(name, scale * off, scale * uncertain, limit, unit=unit, at=at)
        checks.append(check)
    return checks, verdicts


def _held(name: str, value: Array, uncertain: Array, limit: float, *, unit: str, at: float) -> tuple[Check, str]:
    """A check by the rule of ISO 14253-1, and its verdict: ok, failed, or not proved where neither is certain.

    `value` (n,) and its expanded uncertainty (n,) are in `unit`, as the limit is; `at` is the shaft angle, rad, at
    which the value is greatest.
    """
    sure, above = bool((value + uncertain <= limit).all()), bool((value - uncertain > limit).any())
    verdict = "ok" if sure else "failed" if above else "not proved"
    worst = int(np.argmax(value))
    value_words = f"{value[worst]:.4g} +- {uncertain[worst]:.2g} {unit}"
    detail = "" if sure else f"{value_words}: {'more than is permitted' if above else 'not proved either way'}"
    return Check(name, sure, float(value[worst]), limit, unit, degrees(float(at)), detail=detail), verdict


def _remarks(
    recipe: Recipe, discs: Sequence[DiscMade], options: PointOptions, lifts: tuple[float, float] | None
) -> list[str]:
    """Remarks in sentences: what is assumed, what the points cannot show, and which points are outliers."""
    remarks = []
    zone, limits = recipe.zone, permitted(recipe, recipe.export.tolerance)
    output = None if discs[0].part.linkage is None else limits.output
    if zone is None and limits.motion is None and output is None:
        remarks.append(f"no limit is given, so nothing fails: {ZONE_PATH}, verify.motion_error")
    elif zone is not None and zone[0] != ZONE_PATH:
        words = f"{zone[1] / recipe.mm:.6g} {UNIT_NAMES[recipe.units]} wide by {zone[0]}"
        remarks.append(f"no {ZONE_PATH} is given: the zone of the profile is {words}")
    if options.error is None:
        remarks.append("without --probe-error the scatter of the points alone is known, and no common error")
    if options.axes is None:
        remarks.append("without --axes-error the part's axes are taken as exact")
    if lifts is not None:
        remarks.append("of lifts the size and a constant offset are unseen")
    if options.probing.align == "gxy":
        remarks.append("placed by --align best-fit, the motion shows neither eccentricity nor phase")
    elif options.probing.align or (lifts is not None and lifts[1]):
        turn = math.degrees(discs[0].placing.turn if lifts is None else lifts[1])
        remarks.append(f"turned back by {turn:.6g} degrees by --align rotation, the motion shows no phase")
    for disc in discs:
        profile = disc.profile
        if profile.datum == "none":
            remarks.append("by datum none the profile shows neither eccentricity nor phase; the motion does")
        if profile.free != FREE[profile.datum]:
            remarks.append("its contour is so nearly round that a turn cannot be told from a shift")
        if profile.datum == "part" and not options.probing.align:
            turned = settled([surface.measured.points.on_metal for surface in disc.surfaces], "g")
            first = disc.surfaces[0].measured.points.on_metal
            gain = float(np.abs(first.deviations.e).max() - np.abs(first.placed(turned).deviations.e).max())
            if gain > 0.25 * profile.greatest and abs(turned.turn) > 0.0:
                remarks.append(f"the points look turned by {math.degrees(turned.turn):.3g} degrees: `--align rotation`")
    for surface in (surface for disc in discs for surface in disc.surfaces):
        if surface.fit.outliers.any():
            count = int(surface.fit.outliers.sum())
            lines = ", ".join(str(line) for line in surface.measured.lines[surface.fit.worst[:5]].tolist())
            remarks.append(
                f"{count} outlier{'s' * (count > 1)} (line {lines}{', ...' if count > 5 else ''}) "
                "counted in the profile, left out of smoothing and motion"
            )
        if surface.fit.curve.widened > 1.0:
            remarks.append(
                f"residuals beside one another agree (correlation {surface.fit.correlation:.2f}): "
                f"uncertainties are widened {surface.fit.curve.widened:.2f} times"
            )
        measured = surface.measured
        if measured.spread is not None:
            spread = measured.spread / recipe.mm
            remarks.append(
                f"{measured.repeats} points are {len(measured.points)} places, measured again within {spread:.2g}"
            )
    return remarks
