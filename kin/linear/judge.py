"""The verdict on a file of a linear cam: whether it is the intended plate, and its follower moves as intended.

The file is taken as it lies on disk. The way it was made is not known here: the exact flank comes from the intended
motion alone (`kin.linear.frame`), the motion from the roller set down on the file's own contour (`kin.linear.contact`).
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kin.contour.contour import ARC_SHARE
from kin.contour.holes import FINE, Tallies, Tally, apart, tally
from kin.linear.contact import Held, RestError
from kin.linear.flanks import Metal, held_by, judged_motion, judged_play
from kin.linear.outline import Flank, groove_strayed, plate_strayed
from kin.linear.parallels import motion_limits
from kin.linear.verdict import FlankVerdict, PlateVerdict
from kin.numeric.check import ROUNDING, Check, at_most, failed, less_sure
from kin.numeric.errors import CamgeoError, UnsettledError
from kin.numeric.lengths import UNIT, length_words
from kin.numeric.limits import SPLINE_ERROR, SPLINE_SHARE, is_loose, limit_of, unlimited
from kin.numeric.records import replace
from kin.read.checks import (
    closed_check,
    count_check,
    crossing_places,
    demand_same,
    thickness_check,
    units_check,
)
from kin.read.errors import ReadError
from kin.read.files import read_drawing, read_solid
from kin.read.formats import format_of
from kin.read.nesting import MOST_CONTOURS, ClosedContour, counter_clockwise

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from pathlib import Path

    from kin.contour.contour import Contour
    from kin.contour.holes import Hole
    from kin.law.motion_error import MotionError, Play
    from kin.linear.follower import LinearFollower
    from kin.linear.intent import PlateIntent
    from kin.linear.outline import Strayed
    from kin.numeric.arrays import Array
    from kin.numeric.limits import Limits
    from kin.read.formats import AnySolid
    from kin.read.layers import Layer


MOTION, PLAY, CONTOUR, ENDS = "motion", "form-closure", "contour", "ends"


class _NoGrooveError(CamgeoError, ValueError):
    """A file has no groove, or several."""


class _Read(NamedTuple):
    """Contents of a file, in mm and as if not mirrored.

    checks   on the file and on what is not a flank
    chains   of the drawing or section that has the flanks, the outermost first
    flank    the one of these that holds the flanks
    units    mm in the file's unit
    uneven   bound, mm, of the contours' own error: gaps that were joined, sections that differ by rounding
    """

    checks: list[Check]
    chains: tuple[ClosedContour, ...]
    flank: ClosedContour
    units: float = 1.0
    uneven: float = 0.0


def verify(path: Path, plate: PlateIntent, limits: Limits, units: float | None = None) -> PlateVerdict:
    """Judge a drawing or solid by the suffix of its file, over all inputs.

    The unit that a file states counts; `units`, mm, is the unit of a file that states none. A file from which no
    contour can be read gets a verdict that says why. Raises OSError where the disk refuses, UnitsError where the file
    states another unit than `units`, ValueError for another suffix.
    """
    kind = format_of(path)
    flanks = _flanks(plate)
    try:
        file = READERS.get(kind.contents, _refused)(path, plate, flanks, limits, units)
    except _NoGrooveError as error:
        return PlateVerdict(kind.name, (failed("readable", str(error)),)).about(path)
    except ReadError as error:
        return PlateVerdict.unread(path, kind.name, kind.contents, error)
    return _judged(file, plate, flanks, limits, kind.name).about(path)


def judge_chains(chains: Sequence[ClosedContour], plate: PlateIntent, limits: Limits, kind: str = "") -> PlateVerdict:
    """Judge closed chains, mm, as if not mirrored, as a drawing, section or program has them: the outermost first.

    With a groove, and no outline in the intent, there is none among them. Where a groove has no chain the verdict says
    so.
    """
    flanks = _flanks(plate)
    chains = [chain._replace(contour=counter_clockwise(chain.contour)) for chain in chains]
    try:
        chain = _flank_chain(chains, plate, flanks)
    except _NoGrooveError as error:
        return PlateVerdict(kind, (failed("readable", str(error)),))
    checks = [count_check("closed", crossing_places([chain.contour]))]
    if plate.outline is not None:
        checks.append(_outline_check(chains[0].contour, plate.outline, limits.tolerance, 0.0))
    checks += _drawn_checks(_holes(chains, chain, plate), [], plate, limits.tolerance)
    return _judged(_Read(checks, tuple(chains), chain), plate, flanks, limits, kind)


def positions(contour: Contour, follower: LinearFollower, u: Array) -> Array:
    """Positions (n,), mm or rad, of the follower set down on a plate's contour, mm, at inputs u (n,), mm.

    nan where it touches nothing: a recipe's motion is not needed, `follower.law` is not read (`follow`).
    """
    held = Held.of(counter_clockwise(contour).as_arcs()[0], follower, (float(u.min()), float(u.max())))
    return held.first(u)[0]


def _flanks(plate: PlateIntent) -> tuple[Flank, ...]:
    """Exact flanks: that below the follower, and of a groove that above it, of the reflected follower."""
    lower = Flank(plate.follower, plate.ends, plate.periods)
    if plate.groove is None:
        return (lower,)
    upper = plate.follower.reflected().larger(plate.groove.clearance)
    return lower, Flank(upper, plate.ends, plate.periods)


def _within(contour: Contour, tolerance: float) -> float:
    """Distance, mm, within which arcs stand for splines; 0 for a contour without any."""
    if not contour.beziers.count:
        return 0.0
    return max(min(SPLINE_ERROR, SPLINE_SHARE * tolerance), ARC_SHARE * float(np.abs(contour.vertices).max()))


def _judged(file: _Read, plate: PlateIntent, flanks: Sequence[Flank], limits: Limits, kind: str) -> PlateVerdict:
    """Verdict on the chain of the flanks: its distance from them, the motion on each, ends, play."""
    contour, tolerance = file.flank.contour, limits.tolerance
    spline = _within(contour, tolerance)
    within = spline or None
    slack = spline + ROUNDING * float(np.abs(contour.vertices).max())
    names = ("",) if plate.groove is None else ("lower", "upper")
    checks, verdicts, errors = list(file.checks), [], []
    bodies = tuple(chain.contour for chain in file.chains)
    try:
        strayed = _strayed(contour, plate, flanks, tolerance + slack + file.uneven, within)
    except UnsettledError as error:
        unsettled = failed(CONTOUR, str(error), unit="mm", limit=tolerance)
        return PlateVerdict(kind, (*checks, unsettled), units=file.units, bodies=bodies)
    for name, flank, off in zip(names, flanks, strayed, strict=True):
        own = contour if name != "upper" else contour.mirrored()
        found = [_contour_check(off, tolerance, slack, file.uneven)]
        motion, more = _motion(own, plate, flank, limits, slack=slack, off=file.uneven + spline)
        found += more
        reach = None
        if plate.ends is not None:
            reach = off.reach
            found.append(_ends_check(reach, plate.ends.overrun, tolerance, slack + file.uneven))
        checks += [replace(check, surface=name) for check in found]
        worst = off.worst + file.uneven
        verdicts.append(FlankVerdict(name, contour, motion, worst, file.flank.pieces or len(contour), reach))
        errors.append(motion)
    play = None
    if plate.groove is not None and all(motion is not None for motion in errors):
        play, check = _play(contour, plate, flanks, limits, slack)
        checks.append(check)
    return PlateVerdict(kind, tuple(checks), tuple(verdicts), play, file.units, bodies)


def _strayed(
    contour: Contour, plate: PlateIntent, flanks: Sequence[Flank], tolerance: float, within: float | None
) -> Sequence[Strayed]:
    if plate.groove is None:
        return (plate_strayed(contour, flanks[0], tolerance, within=within),)
    return groove_strayed(contour, flanks[0], flanks[1], tolerance, within)


def _contour_check(strayed: Strayed, tolerance: float, slack: float, uneven: float) -> Check:
    outside, inside = (f"{length_words(max(off, 0.0), '.3g')} {UNIT}" for off in (strayed.outside, strayed.inside))
    detail = f"{outside} outside, {inside} inside the exact contour"
    if strayed.bare > max(strayed.outside, strayed.inside):
        detail += f"; a point of that is {length_words(strayed.bare, '.3g')} {UNIT} from this one"
    check = at_most(CONTOUR, strayed.worst + uneven, tolerance, "mm", detail=detail, slack=slack)
    return _at(check, strayed.at)


def _at(check: Check, u: float) -> Check:
    return replace(check, at=float(u) if math.isfinite(u) else None, at_unit="mm")


def _ends_check(reach: tuple[float, float], overrun: tuple[float, float], tolerance: float, slack: float) -> Check:
    """Check that metal reaches as far beyond both contacts as it should, within the tolerance."""
    short = max(wanted - found for wanted, found in zip(overrun, reach, strict=True))
    found, wanted = (
        " and ".join(length_words(value, ".6g") for value in pair) if all(map(math.isfinite, pair)) else "no length"
        for pair in (reach, overrun)
    )
    detail = f"the flank reaches {found} {UNIT} beyond the contacts at the first and the last input, {wanted} is wanted"
    return at_most(ENDS, max(short, 0.0), tolerance, "mm", detail=detail, slack=slack)


def _motion(
    contour: Contour, plate: PlateIntent, flank: Flank, limits: Limits, *, slack: float, off: float
) -> tuple[MotionError | None, list[Check]]:
    """Motion of the flank's gauge on a contour that may be off by `off`, mm, and the check on it."""
    gauge, metal = flank.follower, Metal.of(plate)
    try:
        motion = judged_motion(held_by(contour, flank, metal, limits.tolerance), flank.span)
        implied = _implied(flank, [limits.tolerance, limits.tolerance + slack, off])
    except (RestError, UnsettledError) as error:
        return None, [failed(MOTION, str(error), unit=gauge.unit)]
    motion = motion.less_sure(implied(off) if off else 0.0)
    if limits.motion is None and (plate.trimmed or flank.cuts):
        return motion, []  # what an undercut loses is told, and judged against what a user permits
    limit, room = limit_of(implied, limits.motion, limits.tolerance, slack)
    worst = motion.max if limits.motion is None else motion.bound
    detail = f"true within {motion.remainder:.2g} {motion.unit}" if motion.remainder else ""
    check = _at(at_most(MOTION, worst, limit, gauge.unit, detail=detail, slack=room), motion.at)
    direct = limits.tolerance / gauge.lever
    direct = math.degrees(direct) if gauge.unit == "deg" else direct
    vacuous = limits.motion is None and is_loose(limit, direct, lambda: _stroke(gauge))
    return motion, [unlimited(check) if vacuous else check]


def _implied(flank: Flank, tolerances: Sequence[float]) -> Callable[[float], float]:
    """Greatest motion error, mm or degrees, by a flank within one of the tolerances, mm, all worked out together."""
    found = dict(zip(tolerances, motion_limits(flank.follower, tolerances), strict=True))
    return found.__getitem__


def _stroke(follower: LinearFollower) -> float:
    """Stroke, mm, or swing, degrees, of the intended motion."""
    cells = follower.cells
    stroke = float(np.ptp(follower.law.derivatives(cells, 0, np.where(cells < cells[-1], 1, -1))[0]))
    return math.degrees(stroke) if follower.unit == "deg" else stroke


def _play(
    contour: Contour, plate: PlateIntent, flanks: Sequence[Flank], limits: Limits, slack: float
) -> tuple[Play, Check]:
    """Play of the follower in a groove, and the check on that of the two gauges, which should fit without any."""
    lower, upper = flanks
    metal, span, tolerance, over = Metal.of(plate), lower.span, limits.tolerance, contour.mirrored()
    below, above = held_by(contour, lower, metal, tolerance), held_by(over, upper, metal, tolerance)
    gauges = judged_play(below, above, span)
    own = judged_play(below, held_by(over, upper, metal, tolerance, lower.follower.radius), span)

    first, other = (_implied(flank, [tolerance, tolerance + slack]) for flank in flanks)
    limit, room = limit_of(lambda e: first(e) + other(e), limits.play, limits.tolerance, slack)
    worst, at = max((-gauges.least, gauges.least_at), (gauges.most, gauges.most_at))
    unit = "mm" if own.unit == "mm" else "degrees"
    detail = f"the follower's own play is {own.least:.6g} to {own.most:.6g} {unit}"
    if own.unit == "mm":
        detail = f"the follower's own play is {length_words(own.least)} to {length_words(own.most)} {UNIT}"
    return own, _at(at_most(PLAY, worst, limit, own.unit, detail=detail, slack=room), at)


def _holes(chains: Sequence[ClosedContour], flank: ClosedContour, plate: PlateIntent) -> list[Contour]:
    inner = chains if plate.outline is None else chains[1:]
    return [chain.contour for chain in inner if chain is not flank]


def _flank_chain(chains: Sequence[ClosedContour], plate: PlateIntent, flanks: Sequence[Flank]) -> ClosedContour:
    """The chain that holds the flanks: the outline, or a groove's by its layer, or by its place."""
    if plate.groove is None:
        return chains[0]
    there = [chain for chain in chains if chain.layer == plate.groove.layer]
    if len(there) > 1:
        raise _NoGrooveError(f"{len(there)} closed contours on the layer {plate.groove.layer}")
    if not there:
        x, y = np.vstack([flanks[0].points, flanks[1].points * [1.0, -1.0]]).T
        exact = np.array([x.min(), y.min(), x.max(), y.max()])
        size = 0.5 * float(np.hypot(np.ptp(x), np.ptp(y)))
        inner = chains if plate.outline is None else chains[1:]
        off = [float(np.abs(np.array(chain.contour.box) - exact).max()) for chain in inner]
        there = [inner[int(np.argmin(off))]] if off and min(off) < size else []
    if not there:
        raise _NoGrooveError("the groove is missing, in which its follower runs")
    return there[0]


def _turned_back(chains: Sequence[ClosedContour], factor: float, *, mirrored: bool) -> tuple[ClosedContour, ...]:
    """Chains enlarged by a factor above 0 and, where the file is, mirrored in the y axis."""
    back = []
    for chain in chains:
        contour = chain.contour.scaled(factor) if factor != 1.0 else chain.contour
        contour = contour.mirrored().turned(np.pi) if mirrored else contour
        back.append(chain._replace(contour=contour, gap=factor * chain.gap))
    return tuple(back)


def _of_drawing(path: Path, plate: PlateIntent, flanks: Sequence[Flank], limits: Limits, units: float | None) -> _Read:
    """Read a DXF or SVG: the checks on what is drawn, and its chains."""
    engraved = any(hole.depth is not None for hole in plate.holes)
    unstated = plate.mm if units is None else units
    deepest = 1 if plate.closed else MOST_CONTOURS
    drawing = read_drawing(
        path, limits.gap, engraved=engraved, deepest=deepest, bridged=limits.tolerance, unstated=unstated
    )
    demand_same(drawing.units_mm, units, path)
    scale = unstated if drawing.units_mm is None else 1.0
    chains = _turned_back(drawing.chains, scale, mirrored=plate.mirrored)
    flank = _flank_chain(chains, plate, flanks)
    joined = max(chain.gap for chain in (chains[0], flank))
    uneven = joined if limits.gap is None else max(joined, limits.gap)
    outlines = [chains[0].contour, *([flank.contour] if flank is not chains[0] else [])]
    unit = units_check(drawing.units_mm, units, plate.mm, lambda: _size(chains[0].contour, plate, flanks))
    checks = [unit, closed_check(drawing, scale, outlines, limits.gap, uneven)]
    if plate.outline is not None:
        checks.append(_outline_check(chains[0].contour, plate.outline, limits.tolerance, 0.0))
    engravings = [ClosedContour(contour) for contour in drawing.engraved]
    marks = [mark.contour for mark in _turned_back(engravings, scale, mirrored=plate.mirrored)]
    checks += _drawn_checks(_holes(chains, flank, plate), marks, plate, limits.tolerance)
    return _Read(checks, chains, flank, scale if drawing.units_mm is None else drawing.units_mm, uneven)


def _size(contour: Contour, plate: PlateIntent, flanks: Sequence[Flank]) -> float:
    """Size of the outline over that of the exact one."""
    points = flanks[0].points if plate.outline is None else plate.outline.contour.vertices
    return float(np.abs(contour.vertices).max() / np.abs(points).max())


def _outline_check(contour: Contour, outline: Hole, tolerance: float, uneven: float) -> Check:
    off = apart(contour, outline.contour, FINE * tolerance)
    detail = f"the outline is off by {length_words(off, '.3g')} {UNIT}"
    return less_sure(at_most("outer", off, tolerance, "mm", detail=detail, slack=ROUNDING), uneven)


def _drawn_checks(
    holes: Sequence[Contour], engraved: Sequence[Contour], plate: PlateIntent, tolerance: float
) -> list[Check]:
    """Check the openings of a drawing: each once at its place, and none besides."""
    from kin.read.layers import told

    tallies: Tallies = {}
    through = [hole for hole in plate.holes if hole.depth is None]
    if not through:
        tallies["holes"] = Tally()
    tally(tallies, holes, through, tolerance, settled=plate.holes, closed=plate.closed)
    shallow = [hole for hole in plate.holes if hole.depth is not None]
    if shallow:
        tally(tallies, engraved, shallow, tolerance, where=", engraved", settled=plate.holes, closed=plate.closed)
    return told(tallies, tolerance)


def _of_solid(path: Path, plate: PlateIntent, flanks: Sequence[Flank], limits: Limits, units: float | None) -> _Read:
    """Read a solid: the checks on it, its sections and faces, and the chains of the section that has the flanks."""
    from kin.read.layers import heights, leans, settled

    levels = [z for z, _ in heights(plate.layers, ())] if plate.layers else []
    solid = read_solid(path, levels, units, 1 if plate.closed else MOST_CONTOURS)
    demand_same(solid.units_mm, units, path)
    if len(solid.sections) < len(levels):
        raise ReadError("height", "the solid has no section where the plate has its layers", path)
    if plate.layers:
        solid = settled(solid, leans(plate.layers, ()), limits.tolerance)
    chains = _turned_back(solid.chains, 1.0, mirrored=plate.mirrored)
    flank = _flank_chain(chains, plate, flanks)
    checks = [count_check("watertight", [*solid.faults, *crossing_places([flank.contour])])]
    if plate.layers:
        checks += _layer_checks(solid, plate, flanks, limits.tolerance)
    else:
        if plate.outline is not None:
            checks.append(_outline_check(chains[0].contour, plate.outline, limits.tolerance, solid.uneven))
        checks += [
            less_sure(check, solid.uneven)
            for check in _drawn_checks(_holes(chains, flank, plate), [], plate, limits.tolerance)
        ]
        if plate.thickness is not None:
            checks.append(thickness_check(solid, plate.thickness, limits.tolerance))
    return _Read(checks, chains, flank, solid.units_mm or units or 1.0, solid.uneven)


def _layer_checks(solid: AnySolid, plate: PlateIntent, flanks: Sequence[Flank], tolerance: float) -> list[Check]:
    """Check the faces of a solid, and its sections in layers with their openings."""
    from kin.read.layers import between_sections, faces, heights, leans, tally_faces, told

    layers = plate.layers
    tallies: Tallies = {"thickness": Tally()}
    if any(layer.inset != (0.0, 0.0) for layer in layers):
        tallies["chamfer"] = Tally()
    tally_faces(tallies, solid, layers, tolerance)
    for kind, fault in between_sections(solid, [z for _, z in faces(layers)], leans(layers, ()), tolerance):
        tallies[kind].faults.append(fault)
    for (z, layer), section in zip(heights(layers, ()), solid.sections, strict=True):
        chains = _turned_back(section.chains, 1.0, mirrored=plate.mirrored)
        _section(tallies, (z, layer), chains, plate, flanks, tolerance=tolerance)
    return [less_sure(check, solid.uneven) for check in told(tallies, tolerance)]


def _section(
    tallies: Tallies,
    level: tuple[float, Layer],
    chains: Sequence[ClosedContour],
    plate: PlateIntent,
    flanks: Sequence[Flank],
    *,
    tolerance: float,
) -> None:
    """Compare one section of a solid with the intended one at its level."""
    z, layer = level
    where = f" at z = {length_words(z)} {UNIT}"
    outer, outline, flank = chains[0], layer.outline or plate.outline, chains[0]
    kind = "thickness" if layer.inset == (0.0, 0.0) else "chamfer"
    if layer.outline is None and plate.groove is not None:
        flank = _flank_chain(chains, plate, flanks)
        off = max(strayed.worst for strayed in groove_strayed(flank.contour, flanks[0], flanks[1], tolerance))
        tallies[kind].measured(off, f"the groove{where} is off by {length_words(off, '.3g')} {UNIT}")
    if outline is not None:
        off = apart(outer.contour, outline.contour, FINE * tolerance)
    else:
        by = layer.inset_at(z)
        off = plate_strayed(outer.contour, flanks[0].inset(by), tolerance, by).worst
    tallies[kind].measured(off, f"the section{where} is off by {length_words(off, '.3g')} {UNIT}")
    tally(tallies, _holes(chains, flank, plate), layer.holes, tolerance, where=where, settled=plate.holes)


def _refused(path: Path, *_: object) -> _Read:
    raise ReadError("unsupported", "of linear cams drawings and solids are judged", path)


READERS = {"drawing": _of_drawing, "solid": _of_solid}
"""Readers of files, by their contents."""
