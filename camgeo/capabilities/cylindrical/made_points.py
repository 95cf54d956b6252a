"""Points measured on a drum's flanks in `camgeo verify`: checks, and the section `made` of a report."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from camgeo.capabilities.cylindrical.verdicts import intended
from camgeo.common.arguments import short_repr
from camgeo.common.errors import CallError
from camgeo.common.terminal import escaped
from camgeo.measures.extension import Results
from camgeo.measures.units import UNIT_NAMES, in_units
from camgeo.schema.quantity import read_quantity
from camgeo.schema.scalars import Complaint
from kin.cylindrical.gauge import gauges_of
from kin.cylindrical.inspected import read_flank_points
from kin.cylindrical.measured_flanks import MOTION, PROFILE, UNKNOWNS, UnlikeError, made_drum
from kin.cylindrical.play import exact_play
from kin.numeric.angles import TURN, degrees
from kin.numeric.check import Check, at_most, failed
from kin.numeric.errors import UnsettledError
from kin.numeric.feet import equal_steps
from kin.numeric.records import dataclass, replace
from kin.read.errors import ReadError

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from camgeo.capabilities.cylindrical.design import DrumDesign
    from camgeo.capabilities.cylindrical.drum_recipe import DrumRecipe
    from camgeo.common.clock import Clock
    from camgeo.output.extension import FileCall
    from kin.cylindrical.intent import DrumIntent
    from kin.cylindrical.measured_flanks import MadeDrum, Measured, Ring
    from kin.numeric.arrays import Array

ALIGN = {"none": "", "rotation": "g", "height": "z", "rotation-height": "gz", "best-fit": "gzxyab"}
WORDS = {
    "g": "turned about z",
    "z": "shifted along z",
    "x": "shifted along x",
    "y": "shifted along y",
    "a": "tilted about x",
    "b": "tilted about y",
}
OF_DISCS = ("probe_face", "axes_error", "spans")
MOST_LENGTH = 1e3  # mm
NO_RING = "it takes points all round the turn at one radius, 36 or more without a gap of 20 degrees"
MOST_NAMED = 5  # outliers
NEAR = 1.0  # mm, between the radii of two rings that tell a play


@dataclass(frozen=True)
class _Options:
    """How points are placed, what they are of, and what is written of them.

    unknowns  letters of UNKNOWNS
    error     expanded uncertainty (k = 2) of a point, mm, None for none
    ball      radius of the probe's ball whose centres they are, mm; 0 for points of the metal
    out       folder of the page, the drawing and the table of points, None for none
    """

    unknowns: str
    error: float | None
    ball: float
    out: str | None


def demand_one_turn(recipe: DrumRecipe, call: FileCall) -> None:
    """Raise CallError for points of a drum whose motion takes several turns."""
    if recipe.turns > 1:
        names = ", ".join(escaped(str(path)) for path in call.paths)
        raise CallError(
            f"{names}: points of a drum of several turns are not judged; give a solid of it, as a scan in STL"
        )


def judge(design: DrumDesign, call: FileCall, clock: Clock) -> Results:
    """Checks and the section `made` of a report on points of a drum's flanks.

    Raises CallError for files and options that cannot be judged, SurroundingsError where the folder of the call cannot
    be written.
    """
    recipe, options = design.recipe, _options(design, call.options)
    names = ", ".join(escaped(str(path)) for path in call.paths)
    if recipe.undercut == "shorten" and any(design.tips.values()):
        raise CallError(f"{names}: points of a drum whose undercut is cut off are not judged; give undercut: refuse")
    places, flanks, where = [], [], []
    for path in call.paths:
        try:
            read = read_flank_points(path)
        except ReadError as error:
            raise CallError(f"{escaped(str(path))}: {error.message}") from error
        if call.units is not None and read.unit is not None and call.units != read.unit:
            raise CallError(f"{escaped(str(path))}: its heading states another unit than --units: leave units out")
        places.append((read.unit or call.units or recipe.mm) * read.places)
        flanks.append(read.flank)
        where += [(path, line) for line in read.lines.tolist()]
    drum = intended(design)
    own = ["lower" if gauge < 0 else "upper" for gauge in _sides(drum)]
    flank = np.concatenate(flanks)
    for number, name in enumerate(("lower", "upper")):
        if name not in own and (flank == number).any():
            raise CallError(f"{names}: this drum has no {name} flank")
    try:
        with clock.stage("points"):
            made = made_drum(drum, np.concatenate(places), flank, options.unknowns, options.ball)
    except (UnlikeError, UnsettledError) as error:
        raise CallError(f"{names}: {error}") from error
    checks, verdicts = _checks(design, made, options)
    section = _section(design, drum, made, options, where)
    report = {"files": [path.name for path in call.paths], "verdicts": verdicts, **section}
    if options.out is not None:
        from camgeo.capabilities.cylindrical.made_folder import write_drum  # most calls write nothing

        with clock.stage("write"):
            report["written"] = write_drum(recipe, made, report, where, options.out)
    return Results({"made": report}, checks)


def _sides(drum: DrumIntent) -> list[int]:
    return [gauge.side for gauge in gauges_of(drum)]


def _options(design: DrumDesign, given: Mapping[str, object]) -> _Options:
    faults = [
        f"--{name.replace('_', '-')}: it is for points of discs: leave it out" for name in OF_DISCS if name in given
    ]
    align = str(given.get("align", "none"))
    if align not in ALIGN:
        faults.append(f"--align: one of {', '.join(ALIGN)}, not {short_repr(align)}")
    error, ball = (_length(design, name, given, faults) for name in ("probe_error", "probe_radius"))
    out = given.get("out")
    if out is not None and not str(out):
        faults.append("--out: an empty name")
    if faults:
        raise CallError(*faults)
    return _Options(ALIGN[align], error, ball or 0.0, None if out is None else str(out))


def _length(design: DrumDesign, name: str, given: Mapping[str, object], faults: list[str]) -> float | None:
    """Length of an option, mm; None where it is not given, and one more of `faults` for what is no length."""
    if name not in given:
        return None
    try:
        value = read_quantity(str(given[name]), design.recipe.units) * design.recipe.mm
    except Complaint:
        value = math.nan
    if 0.0 <= value <= MOST_LENGTH:
        return value
    told = f"a length such as 0.002 is expected, not {short_repr(given[name])}"
    faults.append(f"--{name.replace('_', '-')}: {told}")
    return None


# --- checks -----------------------------------------------------------------------------------------------------------


def _checks(design: DrumDesign, made: MadeDrum, options: _Options) -> tuple[list[Check], dict[str, str]]:
    """Checks of the profile and of the motion, where the recipe limits them, and verdicts by their names."""
    recipe, checks, verdicts, drum = design.recipe, [], {}, intended(design)
    names = [gauge.name for gauge in gauges_of(drum)]
    unsure = options.error or 0.0
    rests = f"U = {unsure:.3g} mm of a point" if options.error is not None else "no uncertainty of the points is stated"
    if recipe.profile is not None:
        for flank in made.flanks:
            off, name = 2.0 * np.abs(flank.e), flank.gauge.name
            check, verdict = _held(PROFILE, (off, np.full(len(off), 2.0 * unsure), flank.theta), recipe.profile, "mm")
            detail = f"{check.detail}; {len(off)} points, {rests}"
            checks.append(replace(check, surface=name, detail=detail))
            verdicts[f"{PROFILE} {name}"] = verdict
        for name in names:
            if f"{PROFILE} {name}" not in verdicts:
                unseen = failed(PROFILE, "not proved: no point is of this flank", unit="mm", limit=recipe.profile)
                checks.append(replace(unseen, surface=name))
                verdicts[f"{PROFILE} {name}"] = "not proved"
    limit, follower = recipe.verify.motion_error, drum.follower
    for ring in made.rings if limit is not None else ():
        probe = follower.in_unit(1.0) * unsure * ring.most_moved
        values = np.abs(ring.error), np.hypot(ring.uncertain, probe), equal_steps(len(ring.error))
        check, verdict = _held(MOTION, values, follower.in_unit(limit or 0.0), follower.unit)
        name = made.flanks[_index(made, ring)].gauge.name
        told = f"by {ring.count} points round a radius of {ring.radius:.6g} mm alone, {ring.waves} waves a turn"
        checks.append(replace(check, surface=name, detail=f"{check.detail}; {told}, {rests}"))
        verdicts[f"{MOTION} {name} {ring.radius:.6g}"] = verdict
    led = {made.flanks[_index(made, ring)].gauge.name for ring in made.rings}
    for name in (names if led else [""]) if limit is not None else ():
        if name not in led:
            unseen = failed(MOTION, f"not proved: {NO_RING}", unit=follower.unit, limit=follower.in_unit(limit or 0.0))
            checks.append(replace(unseen, surface=name))
            verdicts[f"{MOTION} {name}".rstrip()] = "not proved"
    return checks, verdicts


def _index(made: MadeDrum, ring: Ring) -> int:
    return next(k for k, flank in enumerate(made.flanks) if flank.number == ring.flank)


def _held(name: str, values: tuple[Array, Array, Array], limit: float, unit: str) -> tuple[Check, str]:
    """A check by the rule of ISO 14253-1, and its verdict: ok, failed, or not proved where neither is certain.

    `values` are (n,) magnitudes, their expanded uncertainties, and shaft angles, rad.
    """
    value, uncertain, theta = values
    sure, above = bool((value + uncertain <= limit).all()), bool((value - uncertain > limit).any())
    worst = int(np.argmax(value))
    words = f"{value[worst]:.4g} +- {uncertain[worst]:.2g} {unit}"
    words += "" if sure else ": more than is permitted" if above else ": not proved either way"
    reached = float((value + uncertain).max()) if not above else float(value[worst])
    check = at_most(name, reached, limit, unit, detail=words)
    verdict = "ok" if sure else "failed" if above else "not proved"
    return replace(check, at=degrees(float(theta[worst]) % TURN)), verdict


# --- the report -------------------------------------------------------------------------------------------------------


def _section(
    design: DrumDesign, drum: DrumIntent, made: MadeDrum, options: _Options, where: Sequence[tuple[Any, int]]
) -> dict[str, Any]:
    """The section `made`: points, placing and rings, in the recipe's units, and rows of text."""
    recipe, mm, unit = design.recipe, design.recipe.mm, UNIT_NAMES[design.recipe.units]
    rows: list[tuple[str, str]] = []
    flanks = []
    for flank in made.flanks:
        entry = _flank(flank, mm, where)
        flanks.append(entry)
        span = f"{entry['least']:+.4g} to {entry['most']:+.4g} {unit}"
        words = f"{span} of {entry['count']} points, mean {entry['mean']:+.3g}"
        rows.append((f"flank {entry['name']}", words))
        rows.append(
            (f"  farthest off, {entry['worst']:+.4g}", f"at {entry['at_deg']:.2f} degrees, line {entry['line']}")
        )
        if recipe.profile is not None:
            rows.append(("  profile, ISO 1101", f"{2.0 * abs(entry['worst']):.4g} of {recipe.profile / mm:.4g} {unit}"))
    placing = {}
    for letter in options.unknowns:
        k = UNKNOWNS.index(letter)
        value, unsure = float(made.placing.values[k]), float(made.placing.uncertain[k])
        angle = letter in "gab"
        value, unsure = (math.degrees(value), math.degrees(unsure)) if angle else (value / mm, unsure / mm)
        placing[WORDS[letter]] = {"value": value, "uncertainty": unsure, "unit": "deg" if angle else unit}
        rows.append((f"{WORDS[letter]}, taken out", f"{value:+.4g} +- {unsure:.2g} {'degrees' if angle else unit}"))
    rings = []
    for ring in made.rings:
        entry = _ring(design, drum, made, ring, where)
        rings.append(entry)
        head = f"motion, {entry['flank']} at {entry['radius']:.6g} {unit}"
        off = f"off by {entry['worst']:+.4g} +- {entry['uncertainty']:.2g} {entry['unit']}"
        rows.append((head, f"{off} at {entry['at_deg']:.1f} degrees, mean {entry['mean']:+.3g}"))
        if entry["outliers"]:
            named = ", ".join(str(line) for line in entry["outliers"][:MOST_NAMED])
            more = f" and {len(entry['outliers']) - MOST_NAMED} more" if len(entry["outliers"]) > MOST_NAMED else ""
            rows.append(("  stand out, not in it", f"points of lines {named}{more}"))
    play = _play(design, drum, made)
    if play is not None:
        ends = [f"{play[end]:.4g} {play['unit']} at {play[f'{end}_at_deg']:.1f} degrees" for end in ("least", "most")]
        rows.append(("play", " to ".join(ends)))
    remarks = []
    if options.error is None:
        remarks.append(
            "no uncertainty of a point is stated: give --probe-error, or verdicts rest on the points as they are"
        )
    if not made.rings:
        remarks.append(f"no motion: {NO_RING}")
    return {
        "unit": unit,
        "flanks": flanks,
        "placing": placing,
        "rings": rings,
        "play": play,
        "rows": rows,
        "remarks": remarks,
    }


def _flank(flank: Measured, mm: float, where: Sequence[tuple[Any, int]]) -> dict[str, Any]:
    worst = int(np.argmax(np.abs(flank.e)))
    return {
        "name": flank.gauge.name,
        "count": len(flank.e),
        "least": float(flank.e.min()) / mm,
        "most": float(flank.e.max()) / mm,
        "mean": float(flank.e.mean()) / mm,
        "rms": float(np.sqrt(np.mean(flank.e**2))) / mm,
        "worst": float(flank.e[worst]) / mm,
        "at_deg": math.degrees(float(flank.theta[worst])) % 360.0,
        "line": where[int(flank.rows[worst])][1],
    }


def _ring(
    design: DrumDesign, drum: DrumIntent, made: MadeDrum, ring: Ring, where: Sequence[tuple[Any, int]]
) -> dict[str, Any]:
    worst, given = int(np.argmax(np.abs(ring.error))), drum.follower.unit
    value, unit = in_units(design.recipe, float(ring.error[worst]), given)
    unsure, _ = in_units(design.recipe, float(ring.uncertain[worst]), given)
    mean, _ = in_units(design.recipe, float(ring.error.mean()), given)
    return {
        "flank": made.flanks[_index(made, ring)].gauge.name,
        "radius": ring.radius / design.recipe.mm,
        "count": ring.count,
        "waves": ring.waves,
        "worst": value,
        "uncertainty": unsure,
        "mean": mean,
        "unit": unit,
        "at_deg": worst * 360.0 / len(ring.error),
        "noise": ring.sd / design.recipe.mm,
        "outliers": [where[int(k)][1] for k in ring.outliers],
    }


def _play(design: DrumDesign, drum: DrumIntent, made: MadeDrum) -> dict[str, Any] | None:
    """Play between both flanks of a groove, where each has a ring at about the same radius; None without."""
    if "play" not in design.recipe.track.figures:
        return None
    pairs = [
        (low, high)
        for low in made.rings
        for high in made.rings
        if low.flank < high.flank and abs(low.radius - high.radius) < NEAR
    ]
    if not pairs:
        return None
    low, high = pairs[0]
    theta = equal_steps(len(low.error))
    per_mm = drum.follower.in_unit(1.0) / (1.0 if drum.follower.arm is None else drum.follower.arm.length)
    play = per_mm * exact_play(drum, theta) + high.error - low.error
    scale = 1.0 if drum.follower.unit == "deg" else 1.0 / design.recipe.mm
    unit = in_units(design.recipe, None, drum.follower.unit)[1]
    least, most = int(np.argmin(play)), int(np.argmax(play))
    return {
        "least": float(scale * play[least]),
        "least_at_deg": least * 360.0 / len(play),
        "most": float(scale * play[most]),
        "most_at_deg": most * 360.0 / len(play),
        "unit": unit,
    }
