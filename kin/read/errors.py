"""The error that readers raise for a file without a contour, with what an engineer needs to find the place in it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from kin.numeric.errors import CamgeoError

if TYPE_CHECKING:
    from pathlib import Path

REASONS = {
    "syntax": "the file is damaged or not of this format",
    "truncated": "the file ends too early",
    "empty": "the file holds nothing to cut",
    "unsupported": "the file holds something that is not a contour of lines, arcs and splines in one plane",
    "range": "a number is not finite or out of range",
    "open": "the contour does not close: a segment is missing",
    "gap": "two ends are farther apart than the permitted gap",
    "branch": "more than two ends meet",
    "height": "the part does not reach a height at which its section is sought",
    "several": "there is more than one outer contour",
    "crossing": "two contours cross or touch",
    "island": "a contour lies inside a hole",
}

NOT_READ = frozenset({"syntax", "truncated", "empty", "unsupported", "range", "height"})
"""Reasons for which a solid counts as not readable; for the others it is not watertight."""


class ReadError(CamgeoError, ValueError):
    """A file from which no contour can be read.

    reason      a short code, a key of REASONS
    message     what is wrong, where, and by how much
    path        the file
    place       (x, y) in mm (drawing units if the file states none), or None if the error has no place
    width       size of a gap, in the same unit, or None
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

    def __str__(self) -> str:
        return f"{self.path}: {self.message}"


def xml_fault(error: Exception) -> str:
    """Text of where an XML file breaks, by the error of its parser.

    ExpatError has `lineno` and `offset`; ParseError has both in `position`, and a `lineno` of None.
    """
    line, column = getattr(error, "position", (getattr(error, "lineno", None), getattr(error, "offset", 0)))
    if line is None:
        return "its encoding is not known"
    return f"its XML breaks at line {line}, column {column}"
