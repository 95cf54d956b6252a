"""The motion that a follower has on a contour that exists: an old drawing becomes a recipe."""

from __future__ import annotations

import math
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Literal, NamedTuple, TypeVar

from camgeo.common.rounding import upward
from camgeo.motions.lift_table import read_path
from camgeo.schema.errors import quote
from camgeo.schema.fields import OwnForm
from camgeo.schema.file_bytes import path_fault
from camgeo.schema.scalars import MOST_TEXT

if TYPE_CHECKING:
    from collections.abc import Sequence

    from camgeo.schema.reader import Reader
    from kin.contour.across import Across, Bridge
    from kin.contour.contour import Contour
    from kin.law.contacts import Contact, Guide, Side, Touch
    from kin.law.sources.motion import Motion

Placeable = TypeVar("Placeable", "Contour", "Bridge")

ANGLES = 720  # shaft angles at which the follower's position on the contour is found
_DIGITS = 3  # decimals beyond the first digit of the reading, to which positions are rounded

DRAWING = OwnForm(
    "the path of a drawing, or of points",
    "the path of a DXF or SVG, such as old.dxf, or of a CSV of points x, y round the contour",
    read_path,
    lambda _: {"type": "string", "minLength": 1, "maxLength": MOST_TEXT},
)


class CamDrawing(NamedTuple):
    """Contours of a drawing, mm, the shaft at the origin, for a cam that turns clockwise; or one `pitch` curve.

    `remarks` has what was done to read them, `layers` those of the contours, empty of points. `bridge` is the stretch
    across which one is closed, None where all are.
    """

    file: str
    contours: tuple[Contour, ...]
    pitch: bool = False
    remarks: tuple[str, ...] = ()
    bridge: Bridge | None = None
    layers: tuple[str, ...] = ()


class ContourPlacing(NamedTuple):
    """How a contour is placed about the shaft: mirrored in the axis `mirror`, then turned counter-clockwise by `turn`.

    `turn` is in rad; `mirrored` says that it is mirrored then, as for a cam that turns counter-clockwise.
    """

    mirror: Literal["x", "y"] | None = None
    turn: float = 0.0
    mirrored: bool = False

    def of(self, contour: Placeable) -> Placeable:
        """A contour, or a stretch of one, in its place."""
        if self.mirror is not None:
            contour = contour.mirrored()
        turn = self.turn + (math.pi if self.mirror == "y" else 0.0)
        contour = contour.turned(turn) if turn else contour
        return contour.mirrored() if self.mirrored else contour


class ContourReading(NamedTuple):
    """How the contours of a file are read: `unit`, mm, of one that states none; ends within `gap`, mm, are joined.

    `across` is how a contour that is open is closed; `pitch` says that the curve is a pitch curve.
    """

    unit: float
    placing: ContourPlacing
    pitch: bool = False
    gap: float | None = None
    across: Across | None = None


def read_contours(reader: Reader, file: str, path: str, how: ContourReading) -> CamDrawing | None:
    """Read the contours of a drawing, or the contour through points; `file` is relative to the recipe's folder.

    Where the file cannot be read, the fault is noted at `path` and the result is None.
    """
    from kin.read.errors import ReadError

    where = Path(reader.source.file).parent / file
    if fault := path_fault(where):
        reader.fault_at(path, fault, quote(file), "give its path as seen from the recipe's folder")
        return None
    remedy = "give a DXF or an SVG with the cam's closed contour, or a CSV of its points x, y"
    try:
        contours, layers, bridge, remarks = _read(where, how)
    except ReadError as error:
        problem = error.message
        if error.closing is not None:
            remedy = f"give gap: {upward(error.closing / how.unit, 2)} beside it to join them"
        elif error.cams:
            remedy = "move the cam in its file until its shaft is there"
    except OSError as error:
        problem = error.strerror or str(error)
    except ValueError as error:
        problem = str(error)
    else:
        placed = tuple(how.placing.of(contour) for contour in contours)
        bridge = None if bridge is None else how.placing.of(bridge)
        return CamDrawing(file, placed, how.pitch, remarks, bridge, layers)
    told, _, own = problem.rpartition("; ")  # what the fault itself says of its remedy
    problem, remedy = (told, own) if own.startswith(("give ", "leave ")) else (problem, remedy)
    reader.fault_at(path, f"{file}: {problem}", None, remedy)
    return None


def _read(where: Path, how: ContourReading) -> tuple[list[Contour], tuple[str, ...], Bridge | None, tuple[str, ...]]:
    """Contours of a file, mm, their layers, the stretch that closes one, and remarks.

    Raises ReadError, OSError and ValueError.
    """
    from kin.contour.about import tracks
    from kin.contour.across import closed_across
    from kin.read.files import read_drawing
    from kin.read.nesting import scaled
    from kin.read.points import SUFFIXES, read_contour_points

    layers: tuple[str, ...] = ()
    if where.suffix.lower() in SUFFIXES:
        if how.gap is not None:
            raise ValueError("a gap is one between ends in a drawing; leave gap out")
        found = read_contour_points(where, how.unit, how.across)
        bridge = next((contour.bridge for contour in found if contour.bridge is not None), None)
        contours, remarks = [contour.contour for contour in found], list[str]()
    else:
        drawing = read_drawing(
            where, how.gap, deepest=3, unstated=how.unit, shaft=(0.0, 0.0), across=how.across
        )  # blank, two flanks, bore
        chains, bridge = drawing.chains, drawing.bridge
        if drawing.units_mm is None and how.unit != 1.0:
            chains, bridge = scaled(chains, how.unit), None if bridge is None else bridge.scaled(how.unit)
        contours, layers = [chain.contour for chain in chains], tuple(chain.layer for chain in chains)
        remarks = joined_words(max(chain.gap for chain in chains), drawing.passed, how.gap)
    if not tracks(contours):
        closed = closed_across(contours[0], how.across or "arc")
        if closed is not None and how.across is None:
            raise ValueError("a slot reaches the shaft; give across: arc or chord, which closes the contour there")
        if closed is not None:
            contours[0], bridge = closed
    if how.across is not None and bridge is None:
        raise ValueError("the contour is closed; leave across out")
    return contours, layers, bridge, tuple(remarks)


def outermost_words(contours: Sequence[Contour], layers: Sequence[str], around: Sequence[Contour]) -> list[str]:
    """Sentence on a contour that is followed while others of those `around` the shaft stand on other layers, within it.

    `around` are some of the contours, the outermost first. A bore may be such a contour, and a cam in its pitch curve.
    """
    of = {id(contour): layer for contour, layer in zip(contours, layers, strict=False)}
    own, *others = [of.get(id(contour), "") for contour in around]
    within = [layer for layer in dict.fromkeys(others) if layer != own]
    if not within:
        return []
    followed = f"followed is the outermost contour, on layer {own}"
    return [f"{followed}; on layer {' and '.join(within)} another one goes round the shaft within it"]


def joined_words(gap: float, passed: tuple[str, ...], wanted: float | None) -> list[str]:
    """Sentences on ends of a drawing that were joined, up to `gap`, mm, apart, and on what was left out of it."""
    remarks = []
    if gap:
        why = "as asked" if wanted is not None else "as the digits or the size of the drawing explain"
        remarks.append(f"ends up to {gap:.3g} mm apart are joined, {why}")
    if passed:
        remarks.append(f"what is no part of the cam is passed over: {', '.join(passed)}")
    return remarks


@lru_cache(maxsize=8)
def motion_on_drawing(
    drawing: CamDrawing, contact: Contact[Guide, Touch], within: int, reading: float, field: str
) -> Motion:
    """Motion of least mean square jerk within `reading`, mm or rad, of a follower's positions on the drawing.

    The follower runs on the contour that lies within `within` others round the shaft; -1 is the innermost, of a ring.
    Raises kin's IntentError, at `field`, where there is no such contour, for a pitch curve of a touch without a centre,
    where the follower finds no contact, and where no motion follows from its positions.
    """
    import numpy as np

    from kin.contour.about import tracks
    from kin.follower.measured import positions
    from kin.follower.motion_error import ContactError
    from kin.follower.unknown import across_words, stretches, unknown_angles
    from kin.law.normalised import IntentError
    from kin.law.sources.motion import TableRemark
    from kin.law.sources.ring import Samples
    from kin.law.sources.table import from_table
    from kin.numeric.records import replace

    contours = tracks(drawing.contours)
    side: Side = -1 if within < 0 else 1
    if drawing.pitch:
        if not contact.touch.centred:
            problem = f"{drawing.file}: a {contact.touch.word} has no centre and so no pitch curve"
            raise IntentError(f"{problem}; give the cam's contour, without curve: pitch", field)
        contact, within = contact.place, min(within, 0)  # its centre runs on the one curve that there is
    if len(contours) <= max(within, 0):
        lacking = "no second" if contours else "no"
        raise IntentError(f"{drawing.file}: {lacking} closed contour goes round the origin, where the shaft is", field)
    phi = np.linspace(0.0, 2.0 * math.pi, ANGLES, endpoint=False) + math.pi / ANGLES
    try:
        position = positions(contours[within], contact, side, phi)
        position -= position.min()
    except (ContactError, ValueError) as error:
        raise IntentError(f"{drawing.file}: the follower does not run on the contour: {error}", field) from error
    digit = 10.0 ** (math.floor(math.log10(reading)) - _DIGITS)  # so that a round part of the contour is a dwell
    rows = Samples(phi, np.round(position / digit) * digit, np.arange(ANGLES) + 1)
    motion = from_table(rows, reading, field=field)
    kept = motion.kept
    outermost = outermost_words(drawing.contours, drawing.layers, contours) if within == 0 else []
    remarks = [TableRemark("contour", f"{drawing.file}: {text}") for text in (*drawing.remarks, *outermost)]
    if drawing.bridge is not None:
        unknown = unknown_angles(contours[within], drawing.bridge, contact, side, phi)
        told = across_words(drawing.bridge, stretches(phi, unknown))
        remarks.append(TableRemark("contour", f"{drawing.file}: {told}"))
        if kept is not None and kept.distance is not None and not unknown.all():  # what is known is judged apart
            off = np.abs(motion.derivatives(phi, 0)[0] - rows.s)[~unknown]
            kept = kept._replace(distance=float(off.max()))
    return motion if kept is None else replace(motion, kept=kept._replace(line=0, remarks=tuple(remarks)))
