"""The motion that a follower has on a contour that exists: an old drawing becomes a recipe."""

from __future__ import annotations

import math
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from camgeo.motions.lift_table import read_path
from camgeo.schema.fields import OwnForm
from camgeo.schema.scalars import MOST_TEXT

if TYPE_CHECKING:
    from camgeo.schema.reader import Reader
    from kin.contour.contour import Contour
    from kin.law.contacts import Contact, Guide, Side, Touch
    from kin.law.sources.motion import Motion

ANGLES = 720  # shaft angles at which the follower's position on the contour is found
_DIGITS = 3  # decimals beyond the first digit of the reading, to which positions are rounded

DRAWING = OwnForm(
    "the path of a drawing, or of points",
    "the path of a DXF or SVG, such as old.dxf, or of a CSV of points x, y round the contour",
    read_path,
    lambda _: {"type": "string", "minLength": 1, "maxLength": MOST_TEXT},
)


class CamDrawing(NamedTuple):
    """Contours of a drawing, mm, the shaft at the origin, for a cam that turns clockwise; or one `pitch` curve."""

    file: str
    contours: tuple[Contour, ...]
    pitch: bool = False


def read_contours(
    reader: Reader, file: str, path: str, *, mirrored: bool, unit: float, pitch: bool = False
) -> CamDrawing | None:
    """Read the contours of a drawing, or the contour through points; `file` is relative to the recipe's folder.

    `unit`, mm, is the unit of a file that states none; `mirrored` says that the cam turns counter-clockwise, `pitch`
    that the curve is a pitch curve. Where the file cannot be read, the fault is noted at `path` and the result is None.
    """
    from kin.read.errors import ReadError
    from kin.read.files import read_drawing
    from kin.read.points import SUFFIXES, read_contour_points

    where = Path(reader.source.file).parent / file
    try:
        if where.suffix.lower() in SUFFIXES:
            contours = read_contour_points(where, unit)
        else:
            chains = read_drawing(where, deepest=3, unstated=unit).chains  # blank, two flanks, bore
            contours = [chain.contour for chain in chains]
    except FileNotFoundError:
        reader.fault_at(path, "the file does not exist", repr(file), "give its path as seen from the recipe's folder")
        return None
    except ReadError as error:
        problem = error.message
    except OSError as error:
        problem = error.strerror or str(error)
    except ValueError as error:
        problem = str(error)
    else:
        return CamDrawing(file, tuple(contour.mirrored() if mirrored else contour for contour in contours), pitch)
    remedy = "give a DXF or an SVG with the cam's closed contour, or a CSV of its points x, y"
    reader.fault_at(path, f"{file}: {problem}", None, remedy)
    return None


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
    from kin.law.programme import IntentError
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
    motion = from_table(rows, reading, suspects="keep", field=field)
    kept = motion.kept
    return motion if kept is None else replace(motion, kept=kept._replace(line=0, remarks=()))
