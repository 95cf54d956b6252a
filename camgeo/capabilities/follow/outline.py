"""Reading the contours of a file on which a follower runs, in mm about the shaft, as if that turned clockwise."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Literal, NamedTuple

import numpy as np

from camgeo.capabilities.follow.extension import OTHER_INPUTS
from camgeo.common.errors import CallError
from camgeo.common.rounding import upward
from camgeo.common.terminal import escaped
from camgeo.motions.contour_motion import ContourPlacing, joined_words, outermost_words
from camgeo.schema.file_bytes import path_fault
from kin.contour.about import circle_about, goes_round, is_frame, tracks
from kin.contour.across import closed_across
from kin.numeric.records import dataclass
from kin.read.bodies import described
from kin.read.drawing.about_shaft import inside
from kin.read.errors import ReadError
from kin.read.files import read_drawing, read_solid, separate_bodies
from kin.read.formats import FORMATS, format_of, oversize, suffixes
from kin.read.nesting import MOST_CONTOURS, ClosedContour, scaled
from kin.read.points import SUFFIXES, read_contour_points

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from pathlib import Path

    from camgeo.capabilities.follow.follower import Track
    from kin.contour.across import Across, Bridge
    from kin.contour.contour import Contour
    from kin.read.bodies import ReadSolid, SeparateBody

MOST_LISTED = 20  # bodies in a message
LEAST_SEVERAL = 2
NEAR = 1e-3  # of the way from a section to the nearest face, at which its contour is looked at again
ROUND = 1e-3  # of a radius, within which the section of a round solid is round, of triangles too
STEEPEST = 0.5  # greatest draft of a disc's walls, a length by one of height
MOST_NAMED = 3  # holes that a message offers for the shaft
DEEPEST = {"external": MOST_CONTOURS, "internal": 1, "groove": MOST_CONTOURS}  # what is drawn in a bore is passed over


@dataclass(frozen=True, eq=False)
class Outline:
    """The contours on which a follower runs, and round contours beside them.

    contour  the metal's contour, the opening of a ring, or the inner flank of a groove
    outer    outer flank of a groove; None for other tracks
    bore     diameter of a round hole about the shaft, mm; None without one
    blank    diameter of a round outline of a ring or of a groove's blank, mm; None without one
    openings number of other closed contours: bores of other shapes, holes, and contours drawn within them
    remarks  what was done to read them, in words
    bridge   the stretch across which the contour is closed; None where it is closed by itself
    passed   whether something was left out that is no part of the cam
    """

    contour: Contour
    outer: Contour | None = None
    bore: float | None = None
    blank: float | None = None
    openings: int = 0
    remarks: tuple[str, ...] = ()
    bridge: Bridge | None = None
    passed: bool = False


@dataclass(frozen=True)
class Reading:
    """How a file is read, lengths in mm.

    `units` is mm in the unit of a file that states none. The shaft stands `at` a place of the file. A follower runs
    on the contour of a `track`. Ends of a drawing within `gap` are joined; `across` closes a contour that is open. The
    contour is mirrored in the axis `mirror` through the shaft, then turned counter-clockwise by `turn`, rad; with
    `mirrored` it is mirrored, as for a shaft that turns counter-clockwise. `body` is the number, from 1, or the name of
    a solid's body.
    """

    units: float | None
    at: tuple[float, float]
    track: Track
    gap: float | None = None
    across: Across | None = None
    mirror: Literal["x", "y"] | None = None
    turn: float = 0.0
    mirrored: bool = False
    body: int | str | None = None

    @property
    def placing(self) -> ContourPlacing:
        """How the contour is mirrored and turned about the shaft."""
        return ContourPlacing(self.mirror, self.turn, self.mirrored)


class _Found(NamedTuple):
    """Closed contours of a file, mm, remarks on their reading, and the stretch that closes one, mm."""

    chains: Sequence[ClosedContour]
    remarks: Sequence[str] = ()
    bridge: Bridge | None = None
    passed: bool = False


def read_outline(path: Path, asked: Reading) -> Outline:
    """Outline in a file, about the shaft.

    A follower runs on the outermost closed contour round the shaft that is no circle about it, in a ring on the
    innermost one, in a groove between the two outermost; circles about the shaft count where there is no other contour
    round it. Raises CallError for a file without such contours or one that cannot be read, and where a follower that
    does not run in a ring or a groove would run within another contour.
    """
    name, at, track = escaped(str(path)), asked.at, asked.track
    points = path.suffix.lower() in SUFFIXES
    kinds = [suffix for suffix, kind in suffixes().items() if FORMATS[kind].contents in {"drawing", "solid"}]
    if path.suffix.lower() not in kinds and not points:
        raise CallError(f"{name}: no drawing, no solid and no points: give one of {', '.join([*kinds, *SUFFIXES])}")
    if fault := path_fault(path):
        raise CallError(f"{name}: {fault}")
    if not points and (large := oversize(path, format_of(path).name)):
        raise CallError(f"{name}: {large}")
    read = _read_points if points else _read_drawing if format_of(path).contents == "drawing" else _read_section
    if asked.body is not None and read is not _read_section:
        raise CallError(f"{name}: only a solid has bodies: leave body out")
    if asked.gap is not None and read is not _read_drawing:
        raise CallError(f"{name}: a gap is one between ends in a drawing: leave gap out")
    try:
        found = read(path, asked)
    except ReadError as error:
        remedy = "; of a groove give track groove" if error.reason == "island" and track != "groove" else ""
        if error.closing is not None:
            remedy = f"; give gap {upward(error.closing, 2)} to join them"
            if error.unstated and asked.units is None:
                remedy += ", and units mm, or another and the gap by it: the drawing states none"
        elif error.cams and error.unstated and asked.units is None:
            raise _no_unit(path) from error
        elif error.cams:
            remedy = f": give one of these as at, such as --at {error.cams[-1]}"
        elif error.between is not None and asked.across is None:
            remedy = "; give across arc or chord to close it there"
        raise CallError(f"{name}: {error.message}{remedy}") from error
    # contours round the shaft, the outermost first, and which of them the follower runs on
    chains, bridge = found.chains, None if found.bridge is None else found.bridge.moved(-at[0], -at[1])
    shifted = [chain.contour.moved(-at[0], -at[1]) for chain in chains]
    contours = tracks(shifted)
    where = f"the shaft at {at[0]:.9g}, {at[1]:.9g} mm"
    closed = None if contours or track != "external" else closed_across(shifted[0], asked.across or "arc")
    if closed is not None and asked.across is None:
        raise CallError(f"{name}: a slot reaches {where}: give across arc or chord to close the contour there")
    if closed is not None:
        shifted[0], bridge = closed
        contours = [shifted[0]]
    if not contours:
        raise CallError(f"{name}: no closed contour goes round {where}{_remedy(chains)}")
    if asked.across is not None and bridge is None:
        raise CallError(f"{name}: the contour round {where} is closed: leave across out")
    if track == "groove" and len(contours) == 1:
        raise CallError(f"{name}: one closed contour goes round {where}, and a groove has two flanks: leave track out")
    outer, inner = (contours[0], contours[1]) if track == "groove" else (None, contours[-1])
    contour = contours[0] if track == "external" else inner
    # what looks like a sheet's frame is one but within the contour
    framed = [other for other in shifted if other is contour or not is_frame(other) or inside(other, contour)]
    if track == "external" and contour is not framed[0]:
        remedy = "of a ring's opening give track internal, of a groove track groove"
        raise CallError(f"{name}: what goes round {where} lies within another contour: {remedy}")
    # of the other contours, the outermost one within may be a round bore, the outermost one beyond a round blank
    others = [other for other in framed if other is not contour and other is not outer]
    around = sorted((other for other in others if goes_round(other)), key=lambda other: -abs(other.area))
    within = [circle_about(other) for other in around if abs(other.area) < abs(contour.area)]
    beyond = [circle_about(other) for other in around if abs(other.area) > abs(contour.area)]
    bore, blank = (circles[0] if circles else None for circles in (within, beyond))
    openings = len(others) - sum(circle is not None for circle in (bore, blank))
    placed = asked.placing
    told = outermost_words(shifted, [chain.layer for chain in chains], contours) if track == "external" else []
    return Outline(
        placed.of(contour),
        None if outer is None else placed.of(outer),
        bore,
        blank,
        openings,
        (*found.remarks, *told),
        None if bridge is None else placed.of(bridge),
        found.passed,
    )


def _read_drawing(path: Path, asked: Reading) -> _Found:
    """Closed contours of a drawing; raises CallError where no unit is stated, or both file and call state one."""
    units = asked.units
    drawing = read_drawing(
        path,
        asked.gap,
        deepest=DEEPEST[asked.track],
        unstated=units or 1.0,
        shaft=asked.at,
        across=asked.across,
    )
    chains, bridge = drawing.chains, drawing.bridge
    if drawing.units_mm is None:
        if units is None:
            raise _no_unit(path)
        chains, bridge = scaled(chains, units), None if bridge is None else bridge.scaled(units)
    else:
        _require_same_unit(path, units, drawing.units_mm)
    remarks = joined_words(max(chain.gap for chain in chains), drawing.passed, asked.gap)
    return _Found(chains, remarks, bridge, bool(drawing.passed))


def _no_unit(path: Path) -> CallError:
    """Make the error for a drawing whose unit neither the file nor the call states."""
    return CallError(f"{escaped(str(path))}: the drawing states no unit: give units, such as --units mm")


def _read_points(path: Path, asked: Reading) -> _Found:
    """The polygon through points; raises CallError where no unit is stated, or both file and call state one."""
    found = read_contour_points(path, asked.units or 1.0, asked.across)
    if found[0].unit is None and asked.units is None:
        raise CallError(
            f"{escaped(str(path))}: the points state no unit: give units, or head them x_mm,y_mm; --units mm states it"
        )
    if found[0].unit is not None:
        _require_same_unit(path, asked.units, found[0].unit)
    chains = sorted((ClosedContour(points.contour) for points in found), key=lambda chain: -chain.contour.area)
    return _Found(chains, (), next((points.bridge for points in found if points.bridge is not None), None))


def _read_section(path: Path, asked: Reading) -> _Found:
    """Closed contours of a solid's section: of the plain disc, or of a groove between its two uppermost faces.

    Raises CallError where both file and call state a unit, and for a file of several bodies none of which is chosen.
    """
    record = format_of(path)
    if record.units:
        _require_same_unit(path, asked.units, None)
    mm = 1.0 if record.units or asked.units is None else asked.units
    deepest = DEEPEST[asked.track]
    read = partial(read_solid, path) if asked.body is None else _body_of(path, asked.body, mm)
    try:
        solid = read((), deepest=deepest)
    except ReadError as error:
        if error.reason != "several" or asked.body is not None or len(bodies := separate_bodies(path)) < LEAST_SEVERAL:
            raise
        raise _unchosen(path, bodies, mm, "give body, the number or the name of one") from error
    _demand_plain(path, solid, partial(read, deepest=deepest))
    _demand_disc(path, solid, partial(read, deepest=deepest), (asked.at[0] / mm, asked.at[1] / mm))
    if asked.track == "groove" and len(solid.faces) > 1:
        height = 0.5 * (solid.faces[-1] + solid.faces[-2])
        return _Found(scaled(read((height,), deepest=deepest).section(height).chains, mm))
    return _Found(scaled(solid.chains, mm))


def _demand_plain(path: Path, solid: ReadSolid, read: Callable[[Sequence[float]], ReadSolid]) -> None:
    """Raise CallError for a solid whose outermost contour is another just above or below its section, as of a drum.

    A wall that is drafted, or a chamfer, moves it by less than half of the difference in height.
    """
    rows, height = solid.leaning, solid.height
    if not ((rows[:, 0] < height) & (rows[:, 1] > height)).any():
        return
    step = NEAR * min(abs(face - height) for face in (solid.z_min, solid.z_max, *solid.faces))
    own = solid.chains[0].contour
    beside = [cut.chains[0].contour for cut in read((height - step, height + step)).sections]
    moved = max(float(np.abs(other.distance(own.vertices)).max()) for other in beside)
    if moved > STEEPEST * step:
        raise _no_disc(path, "its contour changes with the height of the section")


def _demand_disc(
    path: Path, solid: ReadSolid, read: Callable[[Sequence[float]], ReadSolid], at: tuple[float, float]
) -> None:
    """Raise CallError for a solid whose section is round about the shaft, and another at its leaning faces: an end cam.

    A round disc with chamfers or a draft is round there, too.
    """
    rows = solid.leaning
    if not len(rows) or not _is_round(solid.chains[0].contour, at):
        return
    height = float(np.median(0.5 * (rows[:, 0] + rows[:, 1])))
    try:
        whole = _is_round(read((height,)).chains[0].contour, at)
    except ReadError:  # several pieces, or none about the shaft
        whole = False
    if not whole:
        raise _no_disc(path, "its section is round, and its faces lean beside that, as of an end cam")


def _is_round(contour: Contour, at: tuple[float, float]) -> bool:
    """Whether a contour, lines round a circle perhaps, is round about a place."""
    radii = np.hypot(*(contour.vertices - at).T)
    return bool(np.ptp(radii) <= ROUND * radii.max())


def _no_disc(path: Path, why: str) -> CallError:
    """Make the error for a solid that is no disc, with how such ones are followed."""
    name = escaped(str(path))
    ways = [OTHER_INPUTS[answering].solids for answering in OTHER_INPUTS.answering()]
    remedy = f"judge a cylindrical cam by its recipe: camgeo verify RECIPE {name}"
    return CallError(f"{name}: no disc, {why}; {', or '.join([*filter(None, ways), remedy])}")


def _body_of(path: Path, body: int | str, mm: float) -> Callable[..., ReadSolid]:
    """What reads the body of a number, from 1, or of a name; raises CallError, with all bodies, where it is not there.

    `mm` is that of the file's unit.
    """
    bodies = separate_bodies(path)
    if isinstance(body, str):
        chosen = [one for one in bodies if one.name == body]
    else:
        chosen = bodies[body - 1 : body] if body >= 1 else []
    if len(chosen) != 1:
        raise _unchosen(path, bodies, mm, f"give one of them, not {body}")
    return chosen[0].read


def _unchosen(path: Path, bodies: Sequence[SeparateBody], mm: float, remedy: str) -> CallError:
    """Make the error that lists the bodies of a file; `mm` is that of its unit."""
    listed = [
        f"{k}: {described(one.name, None if one.box is None else (mm * one.box[0], mm * one.box[1]))}"
        for k, one in enumerate(bodies[:MOST_LISTED], start=1)
    ]
    more = [f"{len(bodies) - MOST_LISTED} more"] if len(bodies) > MOST_LISTED else []
    count = "1 body" if len(bodies) == 1 else f"{len(bodies)} bodies"
    return CallError(f"{escaped(str(path))}: it holds {count}: {escaped('; '.join([*listed, *more]))}; {remedy}")


def _require_same_unit(path: Path, units: float | None, stated: float | None) -> None:
    """Raise CallError where a call gives a unit other than the `stated` one of the file, or any where that is None."""
    if units is not None and units != stated:
        remedy = "leave units out, or save the file with its right unit"
        raise CallError(f"{escaped(str(path))}: the file states its unit itself: {remedy}")


def _remedy(chains: Sequence[ClosedContour]) -> str:
    """Remedy in words: the middles of round holes as places of the shaft, and how cams without one are followed."""
    boxes = [(chain.contour, chain.contour.box) for chain in chains[1:]]
    middles = [(hole, 0.5 * (box.x_min + box.x_max), 0.5 * (box.y_min + box.y_max)) for hole, box in boxes]
    places = [f"{x:.6g},{y:.6g}" for hole, x, y in middles if circle_about(hole, x, y) is not None]
    ways = ["give at, such as --at 120,85"]
    if places:
        ways = [f"give at, such as the middle of a hole: {' or '.join(places[:MOST_NAMED])}, as --at {places[0]}"]
    ways += [OTHER_INPUTS[answering].drawings for answering in OTHER_INPUTS.answering()]
    return f"; {', or '.join(filter(None, ways))}"
