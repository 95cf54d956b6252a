"""A recipe of a cam that was measured: its base radius and its motion, as its points have them.

The given recipe states follower, guide, units and part; its base radius and motion, if any, are replaced. Strokes have
the law that fits them best; where none does, or the turn begins within one, the motion is a table. A support function
is a Fourier series. The keys of size and motion are those of the cam's family (`ByMotion`).
"""

from __future__ import annotations

import math
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from camgeo.cams.families import FAMILIES
from camgeo.capabilities.made.made_part import made_part
from camgeo.capabilities.made.options import PointOptions
from camgeo.capabilities.made.part_points import (
    by_disc,
    by_label,
    demand_points,
    joined,
    places_of,
    read_tables,
    scale_of,
)
from camgeo.capabilities.made.refusal import as_call_errors
from camgeo.cli.extension import Started
from camgeo.common.errors import CallError
from camgeo.common.terminal import escaped
from camgeo.measures.units import UNIT_NAMES, report_unit
from camgeo.motions.recognised import MOST_LEFT, STROKES_BEGIN, Recognised, roundest
from camgeo.recipe.recipe import file_bytes, load_text
from camgeo.schema.change import replace_entry, set_value
from camgeo.schema.errors import RecipeErrors
from camgeo.schema.yaml_source import Mapping, Scalar, Source, entries, read_source
from camgeo.synthesis.design import designed
from kin.follower.motion_error import ContactError
from kin.follower.recognised import COVERAGE, recognised
from kin.law.normalised import IntentError
from kin.made.point_motion import SurfaceRun, measured_motion
from kin.made.series import STANDS_OUT, support_series
from kin.made.smooth import GapError
from kin.numeric.errors import UnsettledError
from kin.numeric.records import dataclass, replace
from kin.read.formats import FORMATS, suffixes

if TYPE_CHECKING:
    import collections.abc
    from collections.abc import Sequence

    from camgeo.cams.family import ExactCam
    from camgeo.motions.by_motion import ByMotion
    from camgeo.recipe.recipe import Recipe
    from camgeo.schema.change import Value
    from camgeo.schema.yaml_source import Node
    from kin.follower.recognised import Programme
    from kin.made.point_motion import PointMotion
    from kin.numeric.arrays import Array, Indices
    from kin.read.points import PointTable

READING = 0.02  # mm within which dwells rest and laws fit, where the recipe gives no zone of its profile
MOST_UNEVEN = 0.02  # of the motion: points farther off the symmetry of a kind of cam are of another kind
BESIDE = 8  # points to either side by polar angle, among which the flanks of a groove are told apart


@dataclass(frozen=True, eq=False)
class _MeasuredCam:
    """A measured cam: its motion, its strokes (`programme`, None without any), and its base radius, mm.

    `reading`, mm or rad, is how near dwells and laws hold the motion. `base` is None where other lengths fix the size;
    `base_uncertainty`, mm, is its expanded uncertainty (k = 2). `base_by_wave`, mm, is how far a form as high as the
    reading moves the base radius, at the number of waves that is most taken for motion.
    """

    recipe: Recipe
    keys: ByMotion
    motion: PointMotion
    reading: float
    programme: Programme | None
    base: float | None = None
    base_uncertainty: float = 0.0
    base_by_wave: float = 0.0


def started(paths: Sequence[Path], recipe: Path, name: str) -> Started:
    """Make a recipe, for a file called `name`, from files of points.

    `recipe` states follower, guide, units and part; its base radius and motion are replaced. Raises CallError for
    points from which no recipe can be made, RecipeErrors for a faulty recipe or one that cannot be read.
    """
    names = ", ".join(escaped(str(path)) for path in paths)
    for path in paths:
        kind = suffixes().get(path.suffix.lower())
        if kind is not None and FORMATS[kind].contents in {"drawing", "solid"}:
            problem = f"a {FORMATS[kind].contents}, and no points: its recipe is made by camgeo follow with --recipe"
            raise CallError(f"{escaped(str(path))}: {problem}")
    rough = _placeholders(recipe, paths)
    try:
        measured, source = _measured_cam(rough), Source.of(rough.text, str(recipe))
    except (GapError, UnsettledError, ContactError) as error:
        raise CallError(f"{names}: {error}") from error
    except IntentError as error:
        raise CallError(f"{names}: these points give the follower no motion: {error.message}") from error
    made, beside, lines = (_by_series if measured.keys.series else _by_strokes)(measured, source, name)
    lines = [*rough.remarks, *lines, *_play(measured), *_verified(made.text, beside, name, paths)]
    return Started(made.text, beside, tuple(lines))


def _by_strokes(measured: _MeasuredCam, source: Source, name: str) -> tuple[Source, dict[str, str], list[str]]:
    """Recipe with base radius and a motion by strokes or a table, the files beside it by name, and lines of text."""
    keys, made, lines = measured.keys, source, []
    if measured.base is not None:
        mm, unit = measured.recipe.mm, UNIT_NAMES[measured.recipe.units]
        base = roundest(measured.base / mm, measured.base_uncertainty / mm)
        made = _with(made, f"cam.{keys.base}", base)
        measured_base = f"{measured.base / mm:.6g} +- {measured.base_uncertainty / mm:.2g} {unit}"
        lines.append(f"base radius {measured_base}; {base:.9g} is written")
    segments, why = None, "there are no strokes between dwells or turning points"
    if measured.programme is not None:
        segments, why = _told(measured, measured.programme).segments()
        why += ": turn the points so that it begins in a dwell" if why == STROKES_BEGIN else ""
    beside: dict[str, str] = {}
    if segments is None or measured.programme is None:
        table = f"{Path(name).stem}-lift.csv"
        beside[table] = _lifts(measured)
        rows: Value = {"table": table, "angle": "cam", "reading": _in_unit(measured, measured.reading)}
        made = _with_motion(made, keys, keys.motion, rows)
        reading = f"{_in_unit(measured, measured.reading):.3g} {_unit(measured)}"
        lines.append(f"the motion is a table, {table}, within {reading}: {why}; every deviation of form is part of it")
    else:
        made = _with_motion(made, keys, keys.motion, segments)
        lines += _stroke_lines(measured, measured.programme)
    return made, beside, lines


def _by_series(measured: _MeasuredCam, source: Source, _: str) -> tuple[Source, dict[str, str], list[str]]:
    """Recipe with the support function as a Fourier series about the shaft, files beside it (none), and lines of text.

    Raises CallError where the harmonics that stand out of the noise leave more than the reading.
    """
    motion, mm, unit = measured.motion, measured.recipe.mm, UNIT_NAMES[measured.recipe.units]
    p = motion.turn + motion.gauge.intended(np.zeros(1))
    series = support_series(p, motion.sd, motion.spans)
    left, unsure = series.left(p), series.unsure / mm
    if left > measured.reading:
        what = f"the harmonics that stand out of the noise leave {left / mm:.3g} {unit} of the support function"
        raise CallError(f"{what}, more than {measured.reading / mm:.3g}: give points closer together")
    linear = measured.recipe.cam.linear
    shaft = (0.0, 0.0) if linear is None else linear.shaft
    fourier: dict[str, Value] = {"mean": _rounded(series.mean / mm, unsure)}
    for key, coefficients, place in (("cos", series.cos, shaft[0]), ("sin", series.sin, shaft[1])):
        about = {1: 0.0, **coefficients}
        about[1] += place  # the series is about the origin of p, the points are about the shaft
        sizes = {str(k): _rounded(about[k] / mm, unsure) for k in sorted(about)}
        if any(sizes.values()):
            fourier[key] = {k: size for k, size in sizes.items() if size}
    orders = ", ".join(map(str, series.cos)) or "none"
    lines = [
        f"support function of mean {series.mean / mm:.6g} {unit} and harmonics {orders}, each +- {unsure:.2g}",
        f"the harmonics leave {left / mm:.2g} {unit} at most; a deviation of form of as many waves is taken for them",
    ]
    return _with_motion(source, measured.keys, measured.keys.motion, fourier), {}, lines


def _with(source: Source, path: str, value: Value) -> Source:
    return Source.of(set_value(source, path, value), source.file)


def _with_motion(source: Source, keys: ByMotion, key: str, value: Value) -> Source:
    """Recipe with a motion under `key`, in place of the former motion."""
    for other in (keys.motion, *keys.instead):
        if other != key and other in _cam_keys(source):
            return Source.of(replace_entry(source, f"cam.{other}", key, value), source.file)
    return _with(source, f"cam.{key}", value)


def _cam_keys(source: Source) -> collections.abc.Mapping[str, Node]:
    cam = entries(source.root).get("cam") if isinstance(source.root, Mapping) else None
    return entries(cam) if isinstance(cam, Mapping) else {}


class _Rough(NamedTuple):
    """A recipe, and its text, with a provisional base radius `base`, mm, and hardly any motion; remarks on the points.

    `keys` are those of base radius and motion. `points` has each surface's places (n, 2), mm, and their normals (n, 2)
    or None, by its name.
    """

    recipe: Recipe
    text: str
    keys: ByMotion
    base: float
    points: collections.abc.Mapping[str, tuple[Array, Array | None]]
    remarks: list[str]


def _placeholders(path: Path, paths: Sequence[Path]) -> _Rough:
    """Complete a recipe with a provisional base radius, sized by the points, and nearly no motion.

    Raises CallError for lifts, which show no base radius, and for files without points or surfaces without any;
    RecipeErrors for a faulty recipe or one that cannot be read.
    """
    source = read_source(file_bytes(path), str(path))
    keys = _keys(source)
    if keys.base and not keys.series:
        source = _with(source, f"cam.{keys.base}", 40.0)
    source = _with_motion(source, keys, *keys.still)
    rough = load_text(source.text, path)
    files = read_tables(paths)
    if any(table.measured == "lift" for _, table in files):
        raise CallError("lifts tell no base radius: a recipe is made of points x,y")
    scale, remarks = scale_of(rough, [table for _, table in files], None)
    exact = rough.cam.exact()
    points = _by_surface(rough, exact, files, scale)
    base = 0.0
    if keys.base:
        places, _ = points[exact.surfaces[0].name]
        base = float(f"{np.hypot(places[:, 0], places[:, 1]).min() / rough.mm:.6g}")
        source = _with(source, f"cam.{keys.base}", base)
        rough = load_text(source.text, path)
    return _Rough(rough, source.text, keys, base * rough.mm, points, remarks)


def _keys(source: Source) -> ByMotion:
    """Keys that state size and motion of a recipe's kind of cam."""
    kind = _cam_keys(source).get("kind")
    word = kind.text if isinstance(kind, Scalar) else ""
    return FAMILIES[word if word in FAMILIES else "disc"].by_motion  # a faulty kind is refused as the recipe is read


def _by_surface(
    recipe: Recipe, exact: ExactCam, files: Sequence[tuple[Path, PointTable]], scale: float
) -> dict[str, tuple[Array, Array | None]]:
    """Points (n, 2), mm, and normals (n, 2) or None of each surface; raises CallError for one without points."""
    discs: dict[int, list[str]] = {}
    for surface in exact.surfaces:
        discs.setdefault(surface.disc, []).append(surface.name)
    names = list(discs.values())
    rows: dict[str, list[tuple[Array, Array | None]]] = {surface.name: [] for surface in exact.surfaces}
    for place, (path, table) in enumerate(files):
        for disc, own in by_disc(names, table, path, place):
            places, normals = places_of(own, scale, mirrored=recipe.rotation == "ccw")
            owner = _flanks(own, names[disc], places)
            for rank, name in enumerate(names[disc]):
                if (chosen := owner == rank).any():
                    rows[name].append((places[chosen], None if normals is None else normals[chosen]))
    demand_points([name for name in rows if not rows[name]])
    return {name: joined(pieces) for name, pieces in rows.items()}


def _flanks(table: PointTable, names: Sequence[str], places: Array) -> Indices:
    """Index (n,) of each point's surface: by its label, else 0 within the gap between flanks, 1 beyond it."""
    if len(names) == 1:
        return np.zeros(len(places), dtype=np.intp)
    if (owner := by_label(names, table)) is not None:
        return owner
    # among the radii of the points beside one, the widest step is the gap
    radius, angle = np.hypot(places[:, 0], places[:, 1]), np.arctan2(places[:, 1], places[:, 0])
    order = np.argsort(angle)
    about = np.sort(np.stack([np.roll(radius[order], k) for k in range(-BESIDE, BESIDE + 1)]), axis=0)
    gap = np.argmax(np.diff(about, axis=0), axis=0)
    middle = 0.5 * (about[gap, np.arange(len(order))] + about[gap + 1, np.arange(len(order))])
    owner = np.empty(len(places), dtype=np.intp)
    owner[order] = radius[order] > middle
    return owner


def _measured_cam(rough: _Rough) -> _MeasuredCam:
    """The measured cam: its motion, its strokes where they are recognised, and its base radius with the uncertainty.

    Raises CallError for points of another kind of cam, and ContactError, GapError or UnsettledError for points that
    give no motion.
    """
    recipe, keys = rough.recipe, rough.keys
    exact = recipe.cam.exact()
    gauges = exact.gauges
    if keys.series and recipe.linkage is None:  # one face shows the whole series; only a frame needs both
        gauges = {name: replace(gauge, contacts=gauge.contacts[:1]) for name, gauge in gauges.items()}
    runs = [SurfaceRun(gauges[surface.name], surface.side, *rough.points[surface.name]) for surface in exact.surfaces]
    motion = measured_motion(runs, recipe.cam.motion_span, opposed=keys.opposed, lag=keys.lag)
    _demand_symmetry(recipe, motion)
    # half the zone, as a motion of the follower
    zone = recipe.profile
    reading = READING if zone is None else 0.5 * zone
    unit = motion.gauge.unit
    reading = motion.gauge.moved_by(reading) if unit == "deg" else reading
    programme = None if keys.series else recognised(motion, reading, unit)
    cam = _MeasuredCam(recipe, keys, motion, reading, programme)
    if keys.series or not keys.base:
        return cam
    # base radius: by the lowest level, where the motion's displacement is 0
    lowest = float(motion.position.min() if motion.closed else motion.position[0])
    uncertainty, wave = COVERAGE * motion.sd, 1.0
    if programme is not None:
        rank = int(np.argmin(programme.levels)) if motion.closed else 0
        lowest, uncertainty = float(programme.levels[rank]), float(programme.uncertainty[1][rank])
        wave = float(programme.hidden.levels[rank])
    lengthened = motion.lifted_circle(lowest)
    base_uncertainty, base_by_wave = (
        abs(motion.lifted_circle(lowest + change) - lengthened) for change in (uncertainty, wave * reading)
    )
    return replace(cam, base=rough.base + lengthened, base_uncertainty=base_uncertainty, base_by_wave=base_by_wave)


def _demand_symmetry(recipe: Recipe, motion: PointMotion) -> None:
    """Raise CallError for points of another kind of cam, and for a swing that is not 0 at the beginning of the turn."""
    swing = float(np.ptp(motion.turn))
    scale, unit = report_unit(recipe, motion.gauge.unit)
    unit = "degrees" if unit == "deg" else unit
    if motion.uneven > MOST_UNEVEN * swing:
        off = f"{scale * motion.uneven:.3g} {unit} of a motion over {scale * swing:.3g} {unit}"
        raise CallError(
            f"the points are of no cam of kind {recipe.cam.kind} with these sizes: off its symmetry by {off}"
        )
    if motion.zero_ends and abs(float(motion.position[0])) > MOST_UNEVEN * swing:
        up = np.flatnonzero((motion.turn <= 0.0) & (np.roll(motion.turn, -1) > 0.0))
        turn = 360.0 / len(motion.turn) * float(up[0]) if len(up) else 0.0
        raise CallError(
            f"the swing begins at 0, and these points' is 0 and rises at {turn:.4g} degrees: turn them back"
        )


def _in_unit(measured: _MeasuredCam, value: float) -> float:
    """A displacement, mm or rad, in the recipe's unit or degrees."""
    return math.degrees(value) if measured.motion.gauge.unit == "deg" else value / measured.recipe.mm


def _unit(measured: _MeasuredCam) -> str:
    """Unit of displacements: mm or in, or deg for a follower that swings."""
    return report_unit(measured.recipe, measured.motion.gauge.unit)[1]


def _rounded(value: float, unsure: float) -> float:
    """The roundest number within an uncertainty of a value, else six digits; 0 for a value within its noise."""
    if abs(value) <= STANDS_OUT * unsure:
        return 0.0
    rounded = roundest(value, unsure)
    return rounded if abs(rounded - value) <= unsure else float(f"{value:.6g}")


def _told(measured: _MeasuredCam, programme: Programme) -> Recognised:
    """The recognised motion, in the recipe's unit or degrees."""
    most = MOST_LEFT * measured.reading
    return Recognised(measured.motion, programme, most, _in_unit(measured, 1.0), _unit(measured))


def _stroke_lines(measured: _MeasuredCam, programme: Programme) -> list[str]:
    """Lines of text on each recognised stroke, and on all of them: height, angles and law, with uncertainties."""
    lines = _told(measured, programme).lines()
    lines.append(f"the motion is within {_in_unit(measured, programme.greatest):.3g} {_unit(measured)} of the points'")
    return [*lines, _hidden(measured, programme)]


def _hidden(measured: _MeasuredCam, programme: Programme) -> str:
    """Sentence on the form of few waves a turn that is taken for motion the most: its share, and what it moves."""
    waves, share, boundaries, levels = programme.hidden
    high, unit = _in_unit(measured, measured.reading), _unit(measured)
    moved = [f"heights by {levels.max() * high:.2g} {unit}"]
    moved.append(f"ends of strokes by {math.degrees(boundaries.max() * measured.reading):.2g} degrees")
    all_round = ""
    if measured.base is not None:
        length, name = measured.base_by_wave / measured.recipe.mm, UNIT_NAMES[measured.recipe.units]
        moved.insert(0, f"the base radius by {length:.2g} {name}")
        all_round = "a deviation that is the same all round is all taken for base radius; "
    form = f"a form of {waves} wave{'s' * (waves > 1)} a turn, {high:.3g} {unit} high"
    taken = f"is taken for motion by {100.0 * share:.0f} % and moves {', '.join(moved)}"
    return f"what points cannot tell apart: {all_round}{form}, {taken}"


def _play(measured: _MeasuredCam) -> list[str]:
    """Sentences on the play of two contacts, least, mean and greatest, beyond that of the recipe; none without two."""
    if measured.motion.play is None:
        return []
    least, mean, most = (_in_unit(measured, value) for value in measured.motion.play)
    unit = _unit(measured)
    if measured.keys.opposed:
        return [f"between the contacts the part is {-most:+.2g} to {-least:+.2g} {unit} off a constant distance"]
    return [f"the contacts have {mean:+.3g} {unit} more play than the recipe says, from {least:+.2g} to {most:+.2g}"]


def _lifts(measured: _MeasuredCam) -> str:
    """CSV text of the motion: lift in the recipe's unit or degrees over the shaft angle in degrees.

    It has a row about each half degree, and one for the end of the turn or of the part of it.
    """
    motion = measured.motion
    span = math.degrees(motion.span)
    step = max(int(0.5 * len(motion.position) / span), 1)
    zero = float(motion.position.min() if motion.closed else motion.position[0])
    places = motion.position[::step] - zero
    if motion.zero_ends:  # the motion is 0 at both ends of the part of a turn
        places, zero = np.append(0.0, motion.position[step::step]), 0.0
    lift = [_in_unit(measured, value) for value in (*places.tolist(), motion.last - zero)]
    angles = [*np.degrees(motion.shaft[::step]).tolist(), span]
    rows = [f"{angle:.12g},{value:.9f}\n" for angle, value in zip(angles, lift, strict=True)]
    return "".join(["angle,lift\n", *rows])


def _verified(text: str, beside: collections.abc.Mapping[str, str], name: str, paths: Sequence[Path]) -> list[str]:
    """Design the new recipe's cam and judge the points by it: a line of text; raises CallError for a cam that fails."""
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
        with as_call_errors(paths):
            part = made_part(recipe, design, paths, PointOptions())
    profile = max(2.0 * disc.profile.greatest for disc in part.discs) / recipe.mm
    motion = float(np.abs(part.motion.remaining).max())
    scale, _ = report_unit(recipe, design.exact.gauge.unit)
    unit = "deg" if design.exact.gauge.unit == "deg" else recipe.units
    words = f"profile {profile:.3g} {UNIT_NAMES[recipe.units]}, motion within {scale * motion:.3g} {unit}"
    return [f"verified against the points: {words}"]
