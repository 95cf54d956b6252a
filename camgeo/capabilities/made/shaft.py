"""Points of several cams on one shaft: which cam each is on, the cams judged about its axis, and their phases.

A cam's points are known by their column `z` or `lobe`, turned back by the angle at which the cam stands, and judged as
those of a part of its own. The axis is that of the shaft, so that the profile of a cam may turn about it alone, and
`--align rotation` turns the shaft as one: what is left of a cam's phase is its own.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from camgeo.capabilities.made.keys import Made
from camgeo.capabilities.made.made_part import TURNED, part_of_points
from camgeo.capabilities.made.part_points import (
    MIXED,
    NO_SHIFT,
    label_of,
    part_points,
    places_of,
    read_tables,
    readings_of,
    scale_of,
    surface_points,
)
from camgeo.capabilities.made.refusal import as_call_errors
from camgeo.capabilities.made.shaft_axis import leaning_of
from camgeo.common.errors import CallError
from camgeo.common.terminal import escaped
from camgeo.measures.units import UNIT_NAMES
from camgeo.synthesis.intent import intents
from kin.contour.arcs import turned
from kin.made.axis import LEAST_CAMS
from kin.made.causes import shift_of
from kin.made.motion import Influence
from kin.made.points import FACTORS, Placing, UnlikePointsError, turned_at
from kin.made.shaft_alike import LOOKS, OF_LIFTS, OF_POINTS, LobeRows, lone_turns, radii, standing_together
from kin.made.smooth import fit
from kin.numeric.feet import equal_steps
from kin.numeric.records import dataclass, replace
from kin.read.points import CRANK, LEAST_POINTS

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from camgeo.capabilities.made.made_part import PartMade
    from camgeo.capabilities.made.options import PointOptions, Probing
    from camgeo.capabilities.made.part_points import MeasuredSurface
    from camgeo.capabilities.made.shaft_axis import Leaning
    from camgeo.synthesis.shaft_cam import ShaftCam
    from kin.made.axis import Axis
    from kin.made.lifts import Readings
    from kin.made.motion import Errors
    from kin.numeric.arrays import Array, Indices
    from kin.read.points import PointTable

MOST_NAMES = 8  # named in a message
SHIFTED = "shifted along the shaft: count z from the recipe's zero, {0:+.6g} {1}"
TURNED_OVER = "measured from the other end: z is {0:.6g} {1} less the column, and y turned round"
TWO = 2
ROUNDS = 3  # of taking out the lean and fitting it anew: the error shrinks with its square
CERTAIN = 4.0  # a turn above so many times its uncertainty has a remark
WITHIN = 1e-6  # mm, by which a height may lie beyond a cam's end: rounding of what is written


@dataclass(frozen=True, eq=False)
class CamPoints:
    """Points of one cam: each file that has any, with its rows on this cam."""

    cam: ShaftCam
    files: tuple[tuple[Path, PointTable], ...]

    @property
    def paths(self) -> tuple[Path, ...]:
        """Paths of the files."""
        return tuple(path for path, _ in self.files)

    @property
    def tables(self) -> tuple[PointTable, ...]:
        """Rows of each file that are on this cam."""
        return tuple(table for _, table in self.files)

    def heights(self, scale: float) -> Array:
        """Height of each point (n,), mm, in files with units of `scale` mm; without a column z the cam's middle."""
        middle = 0.5 * (self.cam.low + self.cam.high)
        tables = (table.columns.get("z", np.full(len(table), middle / scale)) for table in self.tables)
        return scale * np.concatenate(list(tables))

    def moved(self, axis: Axis, scale: float) -> CamPoints:
        """Copy with points moved back by the shift of an axis at their heights; files have units of `scale` mm."""
        sign, files, first = np.array([1.0, -1.0 if self.cam.recipe.rotation == "ccw" else 1.0]), [], 0
        shifts = turned(axis.shifts(self.heights(scale)), np.array(-self.cam.at)) * sign / scale
        for path, table in self.files:
            x, y = shifts[first : first + len(table)].T
            first += len(table)
            columns = {**table.columns, "x": table.columns["x"] - x, "y": table.columns["y"] - y}
            files.append((path, replace(table, columns=columns)))
        return replace(self, files=tuple(files))

    def halved(self) -> CamPoints:
        """Copy of lifts at angles of the crank, with these halved."""
        files = (
            (path, replace(table, columns={**table.columns, "angle": table.columns["angle"] / CRANK}))
            for path, table in self.files
        )
        return replace(self, files=tuple(files))

    def turned(self, angle: float) -> CamPoints:
        """Copy with the metal turned by an angle, rad, counter-clockwise as drawn for `cw`."""
        drawn = -angle if self.cam.recipe.rotation == "ccw" else angle
        return replace(self, files=tuple((path, _turn_table(table, drawn, angle)) for path, table in self.files))


@dataclass(frozen=True, eq=False)
class Phase:
    """Lateness of a cam's motion, rad of the shaft, above 0 for later than intended, and its expanded uncertainty.

    `against` is this lateness less that of the first cam that was measured, with its own expanded uncertainty.
    """

    late: float
    uncertainty: float
    against: float
    against_uncertainty: float


class CamMade(NamedTuple):
    """Result for one cam of a shaft: its points, its part as made, and its phase."""

    points: CamPoints
    result: PartMade
    phase: Phase


@dataclass(frozen=True, eq=False)
class ShaftMade:
    """Result for a measured shaft.

    cams     results of the cams that were measured, in the order of the recipe
    missing  names of the cams that were not measured
    late     lateness of the whole shaft that `align` took out, rad; None without `align`
    leaning  axis of the shaft by the points; None for lifts, and for cams at fewer than three heights
    remarks  sentences for the report
    """

    cams: tuple[CamMade, ...]
    missing: tuple[str, ...]
    late: float | None
    leaning: Leaning | None
    remarks: tuple[str, ...]


def made_shaft(cams: Sequence[ShaftCam], paths: Sequence[Path], options: PointOptions) -> ShaftMade:
    """Judge the cams of a shaft by their measured points: each cam's result and phase, and the axis of the shaft.

    Raises CallError for files without points, or some with points and others with lifts; for points on no cam, too few
    points of a cam, and points of something else, that cannot be smoothed or on which the follower does not run; for a
    cam without a contour, or whose undercut is cut off; and for a lean that cannot be taken out.
    """
    files, probing = read_tables(paths), options.probing
    tables = [table for _, table in files]
    if len({table.measured for table in tables}) > 1:
        raise CallError(MIXED)
    scale, _ = scale_of(cams[0].recipe, tables, probing.units)
    lifts, without_lean = tables[0].measured == "lift", probing.align == "gxy"
    # points of each cam, turned back by the angle at which it stands
    measured, halved = _by_cam(cams, files, scale), ""
    if lifts:
        measured, halved = _at_cam_degrees(measured, scale, probing)
    measured = [points.turned(-points.cam.zero if lifts else -points.cam.at) for points in measured]

    def rows() -> LobeRows:
        return _lift_rows(measured, scale, probing) if lifts else _radii(cams, measured, scale, probing)

    # `align`: the shaft turned back as one, by the cams that stand together
    late, together = None, []
    if probing.align:
        with as_call_errors(paths):
            together = np.flatnonzero(standing_together(rows())).tolist()
            late = _shaft_turn([measured[rank] for rank in together], scale, probing)
        measured = [points.turned(-late) for points in measured]
    with as_call_errors(paths):
        lone = lone_turns(rows(), aligned=late is not None)
    # lean and shift of the axis taken out, then each cam judged with its own turn
    turns = [lone.get(rank, 0.0) for rank in range(len(measured))]
    leaning = None
    if without_lean and late is not None:
        measured, leaning = _without_lean(measured, turns, scale, probing)
        with as_call_errors(paths):
            left = _shaft_turn([measured[rank] for rank in together], scale, probing)  # a shift looks like some turn
        measured, late = [points.turned(-left) for points in measured], late + left
    results = [
        _judge_cam(points, replace(options, probing=replace(probing, align="", turned=turn)))
        for points, turn in zip(measured, turns, strict=True)
    ]
    if not lifts and not without_lean:
        firsts = [result.surfaces[0] for result in results]
        shifts = [shift_of([first.measured.deviations], [first.fit]) for first in firsts]
        leaning = _leaning(measured, turns, shifts, scale)
    # phases, and remarks on the shaft
    phases = _phases(measured, [result.motion for result in results], options)
    names = {points.cam.name for points in measured}
    missing = tuple(cam.name for cam in cams if cam.name not in names)
    remarks = (
        *([halved] if halved else []),
        *([] if leaning is None else leaning.remarks()),
        *_remarks(measured, results, late, missing),
        *_lone_remarks(measured, phases),
    )
    made = tuple(CamMade(*row) for row in zip(measured, results, phases, strict=True))
    return ShaftMade(made, missing, late, leaning, remarks)


def _judge_cam(points: CamPoints, options: PointOptions) -> PartMade:
    """Judge a cam by its points; raises CallError without a contour, and for points that cannot be judged."""
    cam = points.cam
    if not cam.design.contours:
        raise CallError(f"{cam.name}: there is no exact contour to hold points against: a check of its recipe fails")
    if cam.design.trimmed:
        raise CallError(f"{cam.name}: points of a cam whose undercut is cut off are not judged; give undercut: refuse")
    made = cam.recipe.of(Made)
    datum = "bore" if made is None or made.datum is None else made.datum
    with as_call_errors(points.paths, cam.name):
        placed = part_points(cam.recipe, cam.design, points.files, options.probing)
        return part_of_points(cam.recipe, cam.design, placed, options, datum)


# --- which cam a point is of ------------------------------------------------------------------------------------------


def _by_cam(cams: Sequence[ShaftCam], files: Sequence[tuple[Path, PointTable]], scale: float) -> list[CamPoints]:
    """Points of each cam that has any; raises CallError for points on no cam, and for too few of a cam."""
    pieces: list[list[tuple[Path, PointTable]]] = [[] for _ in cams]
    for path, table in files:
        owner = _owners(cams, path, table, scale)
        for rank, piece in enumerate(pieces):
            if (owner == rank).any():
                piece.append((path, table.rows(owner == rank)))
    measured = [CamPoints(cam, tuple(piece)) for cam, piece in zip(cams, pieces, strict=True) if piece]
    for points in measured:
        if (count := sum(len(table) for table in points.tables)) < LEAST_POINTS:
            problem = f"{points.cam.name} has {count} points, and at least {LEAST_POINTS} are needed, all round it"
            raise CallError(f"{', '.join(escaped(str(path)) for path in points.paths)}: {problem}")
    return measured


def _owners(cams: Sequence[ShaftCam], path: Path, table: PointTable, scale: float) -> Indices:
    """Index (n,) of the cam that each point of a file is on, by its label or z; CallError for no or several cams."""
    name, z = escaped(str(path)), table.columns.get("z")
    by_label = _by_label(cams, name, table) if table.labels else None
    if z is None:
        if by_label is None and len(cams) > 1:
            problem = "a column z or lobe has to tell which lobe each point is on"
            raise CallError(f"{name}: {problem}; lobes are 1 to {len(cams)}, or {_names(cams)}")
        return np.zeros(len(table), dtype=np.intp) if by_label is None else by_label
    height = z * scale
    on = np.array([(height >= cam.low - WITHIN) & (height <= cam.high + WITHIN) for cam in cams])
    if by_label is not None:
        on &= by_label == np.arange(len(cams))[:, None]
    wrong = on.sum(axis=0) != 1
    if not wrong.any():
        owner: Indices = np.argmax(on, axis=0)
        return owner
    at = int(np.argmax(wrong))
    mm, unit = cams[0].recipe.mm, UNIT_NAMES[cams[0].recipe.units]

    def span(cam: ShaftCam) -> str:
        return f"{cam.name}, {cam.low / mm:.9g} to {cam.high / mm:.9g} {unit}"

    here = f"{name}: line {table.lines[at]}: z is {height[at] / mm:.9g} {unit}"
    if by_label is not None:
        raise CallError(f"{here}, which is not on {span(cams[int(by_label[at])])}, that its column names")
    if on[:, at].any():
        met = " and ".join(cam.name for cam, there in zip(cams, on[:, at].tolist(), strict=True) if there)
        raise CallError(f"{here}, where {met} meet: give a column lobe too")
    nearest = min(cams, key=lambda cam: max(cam.low - height[at], height[at] - cam.high))
    looks = _height_advice(cams, height) if by_label is None else ""
    raise CallError(f"{here}, which is on no lobe; the nearest is {span(nearest)}{looks}")


def _height_advice(cams: Sequence[ShaftCam], height: Array) -> str:
    """End of a message on heights (n,), mm, off the cams: the unit or shift that puts all on them, or nothing."""
    levels = np.unique(np.round(height, 3))
    low, high = np.array([[cam.low, cam.high] for cam in cams]).T

    def fit(values: Array) -> bool:
        on = (values[:, None] >= low - WITHIN) & (values[:, None] <= high + WITHIN)
        return bool(on.any(axis=1).all())

    for factor, unit in FACTORS.items():
        if fit(factor * levels):
            words = "small" if factor > 1.0 else "large"
            return f"; they look {max(factor, 1.0 / factor):.6g} times too {words}: `--units {unit}`"
    mm, name = cams[0].recipe.mm, UNIT_NAMES[cams[0].recipe.units]
    for sign, looks in ((1.0, SHIFTED), (-1.0, TURNED_OVER)):
        for shift in sorted((0.5 * (low + high) - sign * levels[0]).tolist(), key=abs):
            if fit(sign * levels + shift):
                return "; they look " + looks.format(shift / mm, name)
    return ""


def _by_label(cams: Sequence[ShaftCam], name: str, table: PointTable) -> Indices:
    """Index (n,) of each point's cam by its label, a name or a number from 1; raises CallError for an unknown label."""
    ranks = {str(rank + 1): rank for rank in range(len(cams))}
    ranks |= {label_of(cam.name): rank for rank, cam in enumerate(cams)}
    owners = {label: ranks.get(_plain(label)) for label in set(table.labels)}
    for label, line in zip(table.labels, table.lines.tolist(), strict=True):
        if owners[label] is None:
            problem = f"line {line}: {escaped(label)[:40]!r} is no lobe"
            raise CallError(f"{name}: {problem}; lobes are 1 to {len(cams)}, or {_names(cams)}")
    return np.array([owners[label] for label in table.labels], dtype=np.intp)


def _plain(label: str) -> str:
    """A label in the form of names; a number such as 2.0 as 2."""
    plain = label_of(label)
    whole, point, rest = plain.partition(".")
    return whole if point and whole.isdigit() and not rest.strip("0") else plain


def _names(cams: Sequence[ShaftCam]) -> str:
    """Names of the cams for a message, of many the first and the last."""
    first, *_ = names = [label_of(cam.name) for cam in cams]
    return ", ".join(names) if len(names) <= MOST_NAMES else f"{first} to {names[-1]}"


# --- turns ------------------------------------------------------------------------------------------------------------


def _turn_table(table: PointTable, drawn: float, angle: float) -> PointTable:
    """Table with points and normals turned by `drawn`, rad, and the angles of lifts made greater by `angle`, rad."""
    columns = dict(table.columns)
    if "angle" in columns:
        columns["angle"] = columns["angle"] + math.degrees(angle)
    c, s = math.cos(drawn), math.sin(drawn)
    for x, y in (("x", "y"), ("nx", "ny")):
        if x in columns:
            columns |= {x: c * columns[x] - s * columns[y], y: s * columns[x] + c * columns[y]}
    return replace(table, columns=columns)


def _shaft_turn(measured: Sequence[CamPoints], scale: float, probing: Probing) -> float:
    """Angle, rad, by which the shaft as one stands later than intended, by least squares over all its points."""
    if measured[0].tables[0].measured == "lift":
        from kin.made.lifts import lateness

        readings = [_readings(points, scale, probing) for points in measured]
        return lateness([cam.on_metal(lateness([cam])) for cam in readings])
    return turned_at([_on_surface(points, scale, probing).points.on_metal for points in measured]).turn


def _on_surface(points: CamPoints, scale: float, probing: Probing) -> MeasuredSurface:
    """Points of a cam, which has one surface, with its exact contour."""
    (part,) = intents(points.cam.recipe, points.cam.design)
    (surface,) = surface_points(part, list(enumerate(points.tables)), scale, probing)
    return surface


def _radii(cams: Sequence[ShaftCam], measured: Sequence[CamPoints], scale: float, probing: Probing) -> LobeRows:
    """Radii, mm, over the angle about the shaft: of the points of each measured cam, and of every cam's contour."""
    contours = []
    for cam in cams:
        (surface,) = intents(cam.recipe, cam.design)[0].surfaces
        contours.append(radii(turned(surface.gauge.envelope.points(equal_steps(LOOKS)), np.array(cam.at))))
    rows = []
    for points in measured:
        mirrored = points.cam.recipe.rotation == "ccw"
        places = np.concatenate([places_of(table, scale, mirrored=mirrored)[0] for table in points.tables])
        rows.append(radii(turned(places, np.array(points.cam.at))) - (probing.ball or 0.0))
    own, nominal, names = np.stack(rows), np.stack(contours), [cam.name for cam in cams]
    order = np.argsort([cam.low for cam in cams])
    rank_if_reversed = np.empty_like(order)  # which cam stands at the place of each if the shaft is turned end for end
    rank_if_reversed[order] = order[::-1]
    return LobeRows(
        own,
        nominal,
        np.array([names.index(points.cam.name) for points in measured], dtype=np.intp),
        names,
        nominal.mean(axis=1),
        own.mean(axis=1),
        rank_if_reversed,
        OF_POINTS,
    )


def _lift_rows(measured: Sequence[CamPoints], scale: float, probing: Probing) -> LobeRows:
    """Lifts, mm or rad, over the shaft's angle of each cam that was measured, as read and as intended."""
    from kin.made.lifts import rows_of_lifts

    readings = [_readings(points, scale, probing) for points in measured]
    names = [points.cam.name for points in measured]
    own, exact = rows_of_lifts(readings, [points.cam.zero for points in measured])
    return LobeRows(
        own,
        exact,
        np.arange(len(measured)),
        names,
        np.ptp(exact, axis=1),
        np.ptp(own, axis=1),
        np.arange(len(measured)),
        OF_LIFTS,
    )


def _readings(points: CamPoints, scale: float, probing: Probing) -> Readings:
    return readings_of(intents(points.cam.recipe, points.cam.design), points.tables, scale, probing)


def _at_cam_degrees(measured: Sequence[CamPoints], scale: float, probing: Probing) -> tuple[list[CamPoints], str]:
    """Lifts at angles of the cams, and a remark where those of an engine were halved, else an empty one.

    Angles are halved only where the heading names no shaft and the lifts fit the crank's angles alone. Raises CallError
    for other lifts that are at the angles of another shaft than their heading says.
    """
    from kin.made.lifts import of_other_shaft

    paths = list(dict.fromkeys(path for points in measured for path in points.paths))
    with as_call_errors(paths):
        other = of_other_shaft([_readings(points, scale, probing) for points in measured])
        if other is None:
            return list(measured), ""
        named = any(table.turns_of for points in measured for table in points.tables)
        if named or all(points.cam.events is None for points in measured):
            raise UnlikePointsError(f"the lifts look {other.words[0]}: {other.remedies[0]}")
    remark = "angles over two turns are taken as those of the engine's crank and halved; head their column crank_deg"
    return [points.halved() for points in measured], remark


# --- the axis ---------------------------------------------------------------------------------------------------------


def _without_lean(
    measured: Sequence[CamPoints], turns: Sequence[float], scale: float, probing: Probing
) -> tuple[list[CamPoints], Leaning]:
    """Points with the lean and the shift of the shaft's axis taken out, and that axis.

    `turns` are the angles by which each cam is turned on the shaft, rad. Raises CallError for lifts, and for cams at
    fewer than three heights.
    """
    if measured[0].tables[0].measured == "lift":
        raise CallError(NO_SHIFT)
    moved, total = list(measured), None
    for _ in range(ROUNDS):
        shifts = []
        for points, turn in zip(moved, turns, strict=True):
            with as_call_errors(points.paths, points.cam.name):
                deviations = _on_surface(points, scale, probing).points.placed(Placing(turn)).deviations
                shifts.append(shift_of([deviations], [fit(deviations.parameter, deviations.e)]))
        leaning = _leaning(moved, turns, shifts, scale, removed=True)
        if leaning is None:
            problem = f"lean and shift of a shaft need lobes at {LEAST_CAMS} heights or more"
            raise CallError(f"--align: {problem}: give --align rotation, or none")
        total = leaning if total is None else total.after(leaning)
        moved = [points.moved(leaning.axis, scale) for points in moved]
    assert total is not None
    return moved, total


def _leaning(
    measured: Sequence[CamPoints],
    turns: Sequence[float],
    shifts: Sequence[tuple[Array, Array]],
    scale: float,
    *,
    removed: bool = False,
) -> Leaning | None:
    """The axis of the shaft by the shift of each cam in its own axes; None for cams at fewer than three heights."""
    rows = [
        (float(points.heights(scale).mean()), points.cam.at + turn, shift)
        for points, turn, shift in zip(measured, turns, shifts, strict=True)
    ]
    return leaning_of([points.cam.name for points in measured], rows, removed=removed)


# --- phases -----------------------------------------------------------------------------------------------------------


def _phases(measured: Sequence[CamPoints], motions: Sequence[Errors], options: PointOptions) -> list[Phase]:
    """Phase of each cam, by the turn that explains most of its motion's error, also against the first cam."""
    lates = [errors.phase[0] for errors in motions]
    parts = [
        _on_shaft(errors.influence(errors.phase_weights), points.cam.at)
        for errors, points in zip(motions, measured, strict=True)
    ]
    datum = parts[0]
    phases = []
    for late, part in zip(lates, parts, strict=True):
        between = Influence(math.hypot(part.sd, datum.sd), part.worst + datum.worst, part.shifted - datum.shifted)
        own = math.hypot(options.expanded(part), options.axes_turn)
        phases.append(Phase(late, own, late - lates[0], options.expanded(between)))
    return [replace(phases[0], against_uncertainty=0.0), *phases[1:]]


def _on_shaft(part: Influence, at: float) -> Influence:
    """Turn an influence on a cam's phase from the cam's axes into the shaft's, by the angle `at`, rad."""
    c, s = math.cos(at), math.sin(at)
    return part._replace(shifted=np.array([[c, -s], [s, c]]) @ part.shifted)


def _lone_remarks(measured: Sequence[CamPoints], phases: Sequence[Phase]) -> list[str]:
    """Remarks on cams turned against the median of all by far more than the uncertainty, and on the shaft as one.

    One or two cams are compared with the recipe itself.
    """
    middle = float(np.median([phase.late for phase in phases])) if len(phases) > TWO else 0.0
    as_one = abs(middle) > max(TURNED, CERTAIN * max(phase.uncertainty for phase in phases))
    return [f"the shaft looks turned by {math.degrees(middle):.3g} degrees: `--align rotation`"] * as_one + [
        f"{points.cam.name} looks turned by {math.degrees(phase.late - middle):.3g} degrees against the others"
        for points, phase in zip(measured, phases, strict=True)
        if abs(phase.late - middle) > max(TURNED, CERTAIN * phase.uncertainty)
    ]


def _remarks(
    measured: Sequence[CamPoints], results: Sequence[PartMade], late: float | None, missing: Sequence[str]
) -> list[str]:
    """Remarks of all cams, each once, with the names of the cams where not all have it; and those on the shaft."""
    cams_of: dict[str, list[str]] = {}
    for points, result in zip(measured, results, strict=True):
        for text in result.remarks:
            cams_of.setdefault(text, []).append(points.cam.name)
    remarks = [text if len(names) == len(results) else f"{', '.join(names)}: {text}" for text, names in cams_of.items()]
    if late is not None:
        turn = f"turned back by {math.degrees(late):.6g} degrees as one"
        remarks.append(f"{turn} by --align rotation, the shaft shows no phase of its own")
    if missing:
        remarks.append(f"no points of {', '.join(missing)}: not judged")
    return remarks
