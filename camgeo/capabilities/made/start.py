"""A recipe of a cam that was measured: its base radius and its motion, as its points have them.

The recipe that is given says follower, guide, units and part; what it says of base radius and motion gives way. Strokes
are told by the law that fits them best; where none does, or the turn begins within one, the motion is a table.
"""

from __future__ import annotations

import math
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from camgeo.capabilities.made.judge import made_part
from camgeo.capabilities.made.keys import Made
from camgeo.capabilities.made.placed import scale_of
from camgeo.capabilities.made.reading import Call, places_of, tables_of
from camgeo.common.errors import CallError
from camgeo.common.terminal import escaped
from camgeo.measures.units import UNIT_NAMES
from camgeo.recipe.recipe import load_text
from camgeo.schema.change import changed
from camgeo.schema.errors import RecipeErrors
from camgeo.schema.yaml_source import Mapping, Source, entries
from camgeo.synthesis.design import designed
from kin.follower.motion_error import ContactError
from kin.law.programme import IntentError
from kin.made.motion import COVERAGE
from kin.made.recognised import measured_motion, recognised
from kin.made.smooth import GapError
from kin.numeric.errors import UnsettledError
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    import collections.abc
    from collections.abc import Sequence

    from camgeo.recipe.recipe import Recipe
    from camgeo.schema.change import Value
    from kin.law.contacts import Contact, Guide, Side, Touch
    from kin.made.recognised import PointMotion, Programme
    from kin.numeric.arrays import Array

READING = 0.02  # mm within which dwells rest and laws fit, where the recipe gives no zone of its profile
MOST_LEFT = 2.0  # readings that laws may leave: beyond, the motion is a table
ROUND = (1.0, 0.5, 0.1, 0.05, 0.01, 0.005, 0.001, 0.0005, 0.0001)  # what numbers are written to
AT_ZERO = 3.0  # degrees: a stroke that ends or begins so near the turn's beginning is tried as one that does so there
BASE, MOTION = "cam.base_radius", "cam.motion"


class Started(NamedTuple):
    """A new recipe, other files beside it by their names, and what there is to say of it, a line each."""

    text: str
    beside: collections.abc.Mapping[str, str]
    lines: tuple[str, ...]


@dataclass(frozen=True, eq=False)
class _MeasuredCam:
    """What points say of a motion: base radius and its uncertainty (k = 2), mm, and strokes where there are such."""

    recipe: Recipe
    motion: PointMotion
    base: float
    unsure: float
    reading: float
    programme: Programme | None


def started(paths: Sequence[Path], recipe: Path, name: str) -> Started:
    """Make a recipe, to stand in a file of that name, of files of points; see the module.

    Raises CallError for points and recipes of which none is made, RecipeErrors for a faulty recipe, OSError.
    """
    names = ", ".join(escaped(str(path)) for path in paths)
    rough = _placeholders(recipe, paths)
    try:
        measured, source = _measured_cam(rough, recipe), Source.of(rough.text, str(recipe))
    except (GapError, UnsettledError, ContactError) as error:
        raise CallError(f"{names}: {error}") from error
    except IntentError as error:
        raise CallError(f"{names}: these points give the follower no motion: {error.message}") from error
    base = _number(measured.base / measured.recipe.mm, measured.unsure / measured.recipe.mm)
    made = _with(source, BASE, base)
    segments, why = None, "there are no strokes between dwells or turning points"
    if measured.programme is not None:
        segments, why = _segments(measured, measured.programme)
    beside: dict[str, str] = {}
    unit = UNIT_NAMES[measured.recipe.units]
    told = f"base radius {measured.base / measured.recipe.mm:.6g} +- {measured.unsure / measured.recipe.mm:.2g} {unit}"
    lines = [*rough.remarks, f"{told}; {base:.9g} is written"]
    if segments is None or measured.programme is None:
        table = f"{Path(name).stem}-lift.csv"
        beside[table] = _lifts(measured)
        made = _with(made, MOTION, {"table": table, "angle": "cam", "reading": _in_unit(measured, measured.reading)})
        reading = f"{_in_unit(measured, measured.reading):.3g} {_unit(measured)}"
        lines.append(f"the motion is a table, {table}, within {reading}: {why}")
    else:
        made = _with(made, MOTION, segments)
        lines += _told(measured, measured.programme)
    lines += _verified(made.text, beside, name, paths)
    return Started(made.text, beside, tuple(lines))


def _with(source: Source, path: str, value: Value) -> Source:
    return Source.of(changed(source, path, value), source.file)


class _Rough(NamedTuple):
    """Text of a recipe with a base radius, mm, and a motion to begin with; the points, mm, their normals; remarks."""

    text: str
    base: float
    points: tuple[Array, Array | None]
    remarks: list[str]


def _placeholders(recipe: Path, paths: Sequence[Path]) -> _Rough:
    """Give the recipe what it need not say, by the size of the points."""
    source = Source.of(recipe.read_text("utf-8"), str(recipe))
    cam = entries(source.root).get("cam") if isinstance(source.root, Mapping) else None
    given = entries(cam) if isinstance(cam, Mapping) else {}
    for path, value in ((BASE, 40.0), (MOTION, _strokes(1.0))):
        if path.partition(".")[2] not in given:
            source = _with(source, path, value)
    rough = load_text(source.text, recipe)
    tables = tables_of(paths)
    if any(table.measured == "lift" for table in tables):
        raise CallError("lifts tell no base radius: a recipe is made of points x,y")
    scale, remarks = scale_of(rough, tables, None)
    pieces = [places_of(table, scale, mirrored=rough.rotation == "ccw") for table in tables]
    places = np.concatenate([piece[0] for piece in pieces])
    normals = [piece[1] for piece in pieces if piece[1] is not None]
    directions = np.concatenate(normals) if len(normals) == len(pieces) else None
    base = float(f"{np.hypot(places[:, 0], places[:, 1]).min() / rough.mm:.6g}")
    swing = 1.0 if rough.cam.arrangement.unit == "deg" else float(f"{0.01 * base:.3g}")
    source = _with(_with(source, BASE, base), MOTION, _strokes(swing))
    return _Rough(source.text, base * rough.mm, (places, directions), remarks)


def _strokes(height: float) -> list[Value]:
    """A motion that any follower makes, to begin with."""
    return [{kind: height, "over": 180.0, "law": "cycloidal"} for kind in ("rise", "return")]


def _measured_cam(rough: _Rough, path: Path) -> _MeasuredCam:
    """Base radius, motion, and its programme if there is one."""
    recipe = load_text(rough.text, path)
    exact = recipe.cam.exact(framed=recipe.linkage is not None)
    if len(exact.follower.contacts) != 1 or recipe.linkage is not None:
        raise CallError(f"{escaped(str(path))}: a recipe is made of points of a cam with one contact, and no linkage")
    contact: Contact[Guide, Touch] = exact.follower.contacts[0]
    side: Side = exact.surfaces[0].side
    motion = measured_motion(contact, side, (*rough.points, 0.0))
    made = recipe.of(Made)
    zone = None if made is None else made.profile
    reading = READING if zone is None else 0.5 * zone
    unit = motion.gauge.unit
    reading = motion.gauge.moved_by(reading) if unit == "deg" else reading
    programme = recognised(motion, reading, unit)
    lowest, unsure = float(motion.position.min()), COVERAGE * motion.sd
    if programme is not None:
        at = int(np.argmin(programme.levels))
        lowest, unsure = float(programme.levels[at]), float(programme.uncertainty[1][at])
    circle, more = (motion.lifted_circle(level) for level in (lowest, lowest + unsure))
    return _MeasuredCam(recipe, motion, rough.base + circle, abs(more - circle), reading, programme)


def _in_unit(measured: _MeasuredCam, value: float) -> float:
    """A displacement in the recipe's unit, or degrees."""
    return math.degrees(value) if measured.motion.gauge.unit == "deg" else value / measured.recipe.mm


def _unit(measured: _MeasuredCam) -> str:
    return "deg" if measured.motion.gauge.unit == "deg" else UNIT_NAMES[measured.recipe.units]


def _number(value: float, uncertainty: float) -> float:
    """The roundest number within an uncertainty of a value."""
    for step in ROUND:
        near = round(value / step) * step
        if abs(near - value) <= max(uncertainty, 0.5 * ROUND[-1]):
            return float(f"{near:.9g}")
    return float(f"{value:.9g}")


def _segments(measured: _MeasuredCam, programme: Programme) -> tuple[list[Value] | None, str]:
    """Segments of the motion from angle 0 on, in the recipe's units and degrees; None with the reason why not."""
    angles = [
        _angle(float(k), float(off)) for k, off in zip(programme.boundaries, programme.uncertainty[0], strict=True)
    ]
    order = sorted(programme.strokes, key=lambda stroke: angles[stroke.first])
    if any(0.0 < angles[stroke.last] < angles[stroke.first] for stroke in order):
        return None, "the turn begins within a stroke: turn the points so that it begins in a dwell"
    heights = _heights(measured, programme)
    unit = math.radians(1.0) if measured.motion.gauge.unit == "deg" else measured.recipe.mm
    levels = programme.levels.min() + unit * np.array(heights)
    left = programme.written(measured.motion, np.radians(angles), levels).greatest
    if left > MOST_LEFT * measured.reading:
        return None, f"the laws that fit best leave {_in_unit(measured, left):.3g} {_unit(measured)}"
    segments: list[Value] = []
    at = 0.0
    for stroke in order:
        begin, end = angles[stroke.first], angles[stroke.last] or 360.0
        if begin > at:
            segments.append({"dwell": float(f"{begin - at:.9g}")})
        height = float(f"{heights[stroke.high] - heights[stroke.low]:.9g}")
        kind = "rise" if height > 0.0 else "return"
        segments.append({kind: abs(height), "over": float(f"{end - begin:.9g}"), "law": stroke.law})
        at = end
    if at < 360.0:
        segments.append({"dwell": float(f"{360.0 - at:.9g}")})
    return segments, ""


def _angle(boundary: float, uncertainty: float) -> float:
    """A boundary in degrees, from 0 to less than 360, as round as its uncertainty lets it be."""
    near = _number(math.degrees(math.remainder(boundary, 2.0 * math.pi)), math.degrees(uncertainty))
    return 0.0 if abs(near) <= AT_ZERO else near % 360.0


def _heights(measured: _MeasuredCam, programme: Programme) -> list[float]:
    """Levels above the lowest, in the recipe's unit or degrees, as round as their uncertainties let them be."""
    above = programme.levels - programme.levels.min()
    pairs = zip(above.tolist(), programme.uncertainty[1].tolist(), strict=True)
    return [_number(_in_unit(measured, height), _in_unit(measured, unsure)) for height, unsure in pairs]


def _told(measured: _MeasuredCam, programme: Programme) -> list[str]:
    """What was recognised of each stroke, and how sure that is."""
    unsure, lines = programme.uncertainty[0], []
    order = sorted(programme.strokes, key=lambda one: _angle(programme.boundaries[one.first], unsure[one.first]))
    for number, stroke in enumerate(order, start=1):
        begin, end = (math.degrees(programme.boundaries[k]) for k in (stroke.first, stroke.last))
        begin = math.remainder(begin, 360.0) if begin > 360.0 - AT_ZERO else begin
        end = begin + (end - begin) % 360.0
        widest = max(math.degrees(unsure[k]) for k in (stroke.first, stroke.last))
        height = _in_unit(measured, float(programme.levels[stroke.high] - programme.levels[stroke.low]))
        off = _in_unit(measured, float(np.hypot(*(programme.uncertainty[1][k] for k in (stroke.low, stroke.high)))))
        law = f"{stroke.law} leaves {_in_unit(measured, stroke.residual):.2g} {_unit(measured)}"
        if stroke.others:
            law += f", {', '.join(stroke.others)} hardly more: look at which it was"
        lines.append(
            f"stroke {number}: {height:.6g} +- {off:.2g} {_unit(measured)} "
            f"from {begin:.5g} to {end:.5g} +- {widest:.2g} degrees; {law}"
        )
    lines.append(f"the motion is within {_in_unit(measured, programme.greatest):.3g} {_unit(measured)} of the points'")
    return lines


def _lifts(measured: _MeasuredCam) -> str:
    """Lifts over the shaft angle, a row each half degree and one for the whole turn."""
    motion = measured.motion
    step = len(motion.position) // 720
    lift = [_in_unit(measured, float(value)) for value in (motion.position - motion.position.min())[::step]]
    rows = [f"{0.5 * k:.12g},{value:.9f}\n" for k, value in enumerate([*lift, lift[0]])]
    return "".join(["angle,lift\n", *rows])


def _verified(text: str, beside: collections.abc.Mapping[str, str], name: str, paths: Sequence[Path]) -> list[str]:
    """Export the new recipe's cam, in mind, and hold the points against it; raises CallError where there is none."""
    with tempfile.TemporaryDirectory(prefix="camgeo-") as folder:
        for other, data in beside.items():
            (Path(folder) / other).write_text(data, encoding="utf-8")
        try:
            recipe = load_text(text, Path(folder) / Path(name).name)
            design = designed(recipe)
        except RecipeErrors as errors:
            faults = [f"no recipe is made of these points: {error.without_place(name)}" for error in errors.errors]
            raise CallError(*faults) from errors
        failed = [check for check in design.checks if not check.ok]
        if failed or not design.contours:
            why = "; ".join(f"{check.name}: {check.detail}" for check in failed)
            raise CallError(f"the cam of these points cannot be made: {why}")
        part = made_part(recipe, design, paths, Call())
    profile = max(2.0 * disc.profile.greatest for disc in part.discs) / recipe.mm
    motion = float(np.abs(part.motion.remaining).max())
    scale, unit = (math.degrees(1.0), "deg") if design.exact.gauge.unit == "deg" else (1.0 / recipe.mm, recipe.units)
    told = f"profile {profile:.3g} {UNIT_NAMES[recipe.units]}, motion within {scale * motion:.3g} {unit}"
    return [f"verified against the points: {told}"]
