"""The error that readers raise for a file without a contour, with what an engineer needs to find the place in it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from kin.numeric.errors import CamgeoError

if TYPE_CHECKING:
    from pathlib import Path

SHOWN = 40  # characters of a text of a file in a message
NOT_READ = frozenset({"syntax", "truncated", "empty", "unsupported", "range", "height"})
"""Reasons for which a solid counts as not readable; for the others it is not watertight."""


class ReadError(CamgeoError, ValueError):
    """A file from which no contour can be read.

    Codes of reasons: syntax, the file is damaged or not of this format; truncated, it ends too early; empty, it holds
    nothing to cut; unsupported, something that is not a contour of lines, arcs and splines in one plane; range, a
    number is not finite or out of range; open, a segment is missing; gap, two ends are farther apart than permitted;
    branch, more than two ends meet; height, the part does not reach a height at which its section is sought; several,
    there is more than one outer contour; crossing, two contours cross or touch; island, one lies inside a hole.

    reason      a short code
    message     what is wrong, where, and by how much
    path        the file
    place       (x, y) in mm (drawing units if the file states none), or None if the error has no place
    width       size of a gap, in the same unit, or None
    closing     gap, mm, within which all ends would find a partner; None where none closes it
    unstated    whether the file states no unit, where ends of its contour do not meet or none goes round the shaft
    between     ends (x, y), in the same unit, of the one stretch that is missing; None where there are more
    cams        places "x,y", mm, of cams beside the shaft, where no contour goes round it; empty otherwise
    """

    def __init__(
        self,
        reason: str,
        message: str,
        path: Path,
        place: tuple[float, float] | None = None,
        width: float | None = None,
    ) -> None:
        super().__init__(reason, message, path, place, width)
        self.reason = reason
        self.message = message
        self.path = path
        self.place = place
        self.width = width
        self.closing: float | None = None
        self.unstated = False
        self.cams: tuple[str, ...] = ()
        self.between: tuple[tuple[float, float], tuple[float, float]] | None = None

    def closed_by(self, gap: float | None) -> ReadError:
        """Return the error itself, with the gap that would close what is open."""
        self.closing = gap
        return self

    def __str__(self) -> str:
        return f"{self.path}: {self.message}"


def short(text: str) -> str:
    """Text of a file, cut to SHOWN characters for a message."""
    return text if len(text) <= SHOWN else f"{text[: SHOWN - 3]}..."


def xml_fault(error: Exception) -> str:
    """Text of where an XML file breaks, by the error of its parser.

    ExpatError has `lineno` and `offset`; ParseError has both in `position`, and a `lineno` of None.
    """
    line, column = getattr(error, "position", (getattr(error, "lineno", None), getattr(error, "offset", 0)))
    if line is None:
        return "its encoding is not known"
    return f"its XML breaks at line {line}, column {column}"
