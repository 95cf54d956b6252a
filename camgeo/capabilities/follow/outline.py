"""Reading the contours of a file on which a follower runs, in mm about the shaft, as if that turned clockwise."""

from __future__ import annotations

from typing import TYPE_CHECKING

from camgeo.common.errors import CallError
from camgeo.common.terminal import escaped
from kin.contour.about import circle_about, goes_round, tracks
from kin.numeric.records import dataclass
from kin.read.errors import ReadError
from kin.read.files import read_drawing, read_solid
from kin.read.formats import FORMATS, format_of, oversize, suffixes
from kin.read.nesting import MOST_CONTOURS, scaled

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from camgeo.capabilities.follow.follower import Track
    from kin.contour.contour import Contour
    from kin.read.nesting import ClosedContour

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
    """

    contour: Contour
    outer: Contour | None = None
    bore: float | None = None
    blank: float | None = None
    openings: int = 0


def read_outline(path: Path, units: float | None, at: tuple[float, float], track: Track, *, mirrored: bool) -> Outline:
    """Outline in a file, about the shaft, which stands at the place `at` of the file, mm.

    `units` is mm in the unit of a file that states none; `mirrored` is whether to mirror the contours, as for a shaft
    that turns counter-clockwise. A follower runs on the outermost closed contour round the shaft that is no circle
    about it, in a ring on the innermost one, in a groove between the two outermost; circles about the shaft count where
    there is no other contour round it. Raises CallError for a file without such contours or one that cannot be read,
    and where a follower that does not run in a ring or a groove would run within another contour.
    """
    name = escaped(str(path))
    kinds = [suffix for suffix, kind in suffixes().items() if FORMATS[kind].contents in {"drawing", "solid"}]
    if path.suffix.lower() not in kinds:
        raise CallError(f"{name}: no drawing and no solid: give one of {', '.join(kinds)}")
    if not path.is_file():
        raise CallError(f"{name}: {'a folder' if path.is_dir() else 'the file does not exist'}")
    record = format_of(path)
    if large := oversize(path, record.name):
        raise CallError(f"{name}: {large}")
    read = _read_drawing if record.contents == "drawing" else _read_section
    try:
        chains = read(path, units, track)
    except ReadError as error:
        remedy = "; of a groove give track groove" if error.reason == "island" and track != "groove" else ""
        raise CallError(f"{name}: {error.message}{remedy}") from error
    # contours round the shaft, the outermost first, and which of them the follower runs on
    shifted = [chain.contour.moved(-at[0], -at[1]) for chain in chains]
    contours = tracks(shifted)
    where = f"the shaft at {at[0]:.9g}, {at[1]:.9g} mm"
    if not contours:
        raise CallError(f"{name}: no closed contour goes round {where}{_remedy(chains)}")
    if track == "groove" and len(contours) == 1:
        raise CallError(f"{name}: one closed contour goes round {where}, and a groove has two flanks: leave track out")
    outer, inner = (contours[0], contours[1]) if track == "groove" else (None, contours[-1])
    contour = contours[0] if track == "external" else inner
    if track == "external" and contour is not shifted[0]:
        remedy = "of a ring's opening give track internal, of a groove track groove"
        raise CallError(f"{name}: what goes round {where} lies within another contour: {remedy}")
    # of the other contours, the outermost one within may be a round bore, the outermost one beyond a round blank
    others = [other for other in shifted if other is not contour and other is not outer]
    around = sorted((other for other in others if goes_round(other)), key=lambda other: -abs(other.area))
    within = [circle_about(other) for other in around if abs(other.area) < abs(contour.area)]
    beyond = [circle_about(other) for other in around if abs(other.area) > abs(contour.area)]
    bore, blank = (circles[0] if circles else None for circles in (within, beyond))
    openings = len(others) - sum(circle is not None for circle in (bore, blank))
    if mirrored:
        contour, outer = contour.mirrored(), None if outer is None else outer.mirrored()
    return Outline(contour, outer, bore, blank, openings)


def _read_drawing(path: Path, units: float | None, track: Track) -> Sequence[ClosedContour]:
    """Closed contours of a drawing, mm; raises CallError where no unit is stated, or both file and call state one."""
    drawing = read_drawing(path, deepest=DEEPEST[track])
    if drawing.units_mm is None:
        if units is None:
            raise CallError(f"{escaped(str(path))}: the drawing states no unit: give units")
        return scaled(drawing.chains, units)
    _require_same_unit(path, units, drawing.units_mm)
    return drawing.chains


def _read_section(path: Path, units: float | None, track: Track) -> Sequence[ClosedContour]:
    """Closed contours of a solid's section, mm: of the plain disc, or of a groove between its two uppermost faces."""
    if format_of(path).units:
        _require_same_unit(path, units, None)
    solid = read_solid(path, (), units, DEEPEST[track])
    if track != "groove" or len(solid.faces) < 2:
        return solid.chains
    height = 0.5 * (solid.faces[-1] + solid.faces[-2])
    return read_solid(path, (height,), units, DEEPEST[track]).section(height).chains


def _require_same_unit(path: Path, units: float | None, stated: float | None) -> None:
    """Raise CallError where a call gives a unit other than the `stated` one of the file, or any where that is None."""
    if units is not None and units != stated:
        raise CallError(f"{escaped(str(path))}: the file states its unit itself: leave units out")


def _remedy(chains: Sequence[ClosedContour]) -> str:
    """Remedy in words: the middles of round holes as places of the shaft."""
    boxes = [(chain.contour, chain.contour.box) for chain in chains[1:]]
    middles = [(hole, 0.5 * (box.x_min + box.x_max), 0.5 * (box.y_min + box.y_max)) for hole, box in boxes]
    places = [f"{x:.6g},{y:.6g}" for hole, x, y in middles if circle_about(hole, x, y) is not None]
    return f"; give at, such as the middle of a hole: {' or '.join(places[:MOST_NAMED])}" if places else "; give at"
