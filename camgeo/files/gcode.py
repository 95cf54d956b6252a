"""Programs for milling machines: plain RS-274 with arcs by their centres, nothing a controller may read in two ways.

Absolute places, feeds by the minute, no cutter compensation, no cycles, no variables. Coordinates have as many
decimals as `places` gives; centres are computed from the ends as they are written.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from camgeo.curve.ring import centre_of
from kin.numeric.records import dataclass
from kin.read.gcode import ARC_MM

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence
    from pathlib import Path

    from kin.numeric.arrays import Array

SHARE = 0.05  # of the tolerance that is left to the rounding of numbers
KEPT = 2e-3  # of a length that a place is given by: the last place is no more
FIGURES = 6  # significant ones, at least, of a feed
LEAST_PLACES = 3
STRAIGHT = 0.25  # of the last place: an arc no higher than this over its chord is written as a line
_COMMENT = 200  # characters


@dataclass(frozen=True, eq=False)
class ClosedPath:
    """Closed path with lead-in and lead-out: points (n, 2), mm, and bulges (n - 1,) of the pieces between them."""

    points: Array
    bulges: Array
    begin: int
    end: int
    """Numbers of the first and the last point of the closed path."""


@dataclass(frozen=True, eq=False)
class Pass:
    """Round of the cutter on a closed path at one height z, mm: 0 at the disc's upper face, below 0 in the metal."""

    z: float
    loop: ClosedPath


@dataclass(frozen=True)
class Cutting:
    """Machine settings besides the path: feeds in mm a minute, spindle in turns a minute, safe height in mm."""

    feed: float
    plunge: float
    spindle: float
    safe_height: float


def places(tolerance: float, mm: float, lengths: Sequence[float] = ()) -> int:
    """Number of decimals, at least 3, that keeps the rounding of ends and centres within `SHARE` of a tolerance, mm.

    The program's unit is `mm` millimetres.

    An end is off by up to 0.71 of the last place, the centre, computed from the ends as written, by 0.71 more, and so
    is the radius from it to either end: together less than 2.5 times the last place. Nor do `lengths`, mm, by which
    places lie apart (a pass above another, a rough path beside a fine one), change by more than `KEPT` of themselves.
    However coarse the tolerance, a centre off by 0.71 of the last place makes the two radii of an arc differ by up to
    1.42 of it: beyond `ARC_MM` controllers refuse the arc.
    """
    last = min([SHARE * tolerance / 2.5, ARC_MM / 1.42, *(KEPT * length for length in lengths)])
    return max(math.ceil(-math.log10(last / mm)), LEAST_PLACES)


def rounding(count: int, mm: float) -> float:
    """Greatest error of a path, mm, whose numbers have `count` decimals in a unit of `mm` millimetres."""
    return 2.5 * mm * 10.0**-count


def write_gcode(
    path: Path,
    features: Sequence[tuple[str, Sequence[Pass]]],
    cutting: Cutting,
    *,
    remarks: Sequence[str],
    count: int,
    mm: float = 1.0,
) -> None:
    """Write the passes of each feature, by name and in order, as a program in a unit of `mm` millimetres.

    `features` are pairs of a name and its passes. `remarks` become comments at the top. `count` is the number of
    decimals. Raises OSError where the disk refuses.
    """
    number = _Numbers(count, mm)
    lines = [f"({comment(text)})" for text in remarks]
    lines += [
        "G20" if mm == 25.4 else "G21",
        "G17 G90 G94",
        "G40 G49 G80",
        f"G0 Z{number(cutting.safe_height)}",
        f"S{plain(cutting.spindle)} M3",
    ]
    for name, steps in features:
        for k, step in enumerate(steps, start=1):
            lines.append(f"({comment(f'{name}, pass {k} of {len(steps)}')})")
            lines += _pass(step, cutting, number)
    lines += ["M5", "M30", ""]
    path.write_bytes("\n".join(lines).encode("ascii"))


class _Numbers:
    """Formatter of lengths in mm as decimals in the program's unit."""

    def __init__(self, count: int, mm: float) -> None:
        self.count, self.mm = count, mm

    def __call__(self, value: float) -> str:
        text = f"{value / self.mm:.{self.count}f}"
        return text[1:] if float(text) == 0.0 and text.startswith("-") else text

    def rounded(self, points: Array) -> Array:
        """Points (n, 2) in the program's unit as they are written."""
        numbers: Array = np.round(points / self.mm, self.count) + 0.0
        return numbers


def _pass(step: Pass, cutting: Cutting, number: _Numbers) -> Iterator[str]:
    points = number.rounded(step.loop.points)
    places = [(_plain(x, number.count), _plain(y, number.count)) for x, y in points.tolist()]
    yield f"G0 X{places[0][0]} Y{places[0][1]}"
    yield f"G1 Z{number(step.z)} F{feed_text(cutting.plunge / number.mm)}"
    feed = f" F{feed_text(cutting.feed / number.mm)}"
    for i, bulge in enumerate(step.loop.bulges.tolist()):
        if places[i + 1] == places[i]:
            continue
        yield _cut(points[i], points[i + 1], bulge, places[i + 1], number.count) + feed
        feed = ""
    yield f"G0 Z{number(cutting.safe_height)}"


def _cut(start: Array, end: Array, bulge: float, place: tuple[str, str], count: int) -> str:
    """One line or arc between two points as they are written."""
    x, y = place
    chord = end - start
    if abs(bulge) * math.hypot(*chord.tolist()) * 0.5 <= STRAIGHT * 10.0**-count:
        return f"G1 X{x} Y{y}"
    i, j = centre_of(np.zeros(2), chord, bulge).tolist()
    return f"G{3 if bulge > 0.0 else 2} X{x} Y{y} I{_plain(i, count)} J{_plain(j, count)}"


def plain(value: float) -> str:
    """Write a number with nine significant figures, without an exponent, which no controller reads."""
    return np.format_float_positional(value, precision=9, fractional=False, trim="-")


def feed_text(value: float) -> str:
    """Write a feed in three decimals, or as many as make up `FIGURES`."""
    return _plain(value, max(LEAST_PLACES, FIGURES - 1 - math.floor(math.log10(value))))


def _plain(value: float, count: int) -> str:
    text = f"{value:.{count}f}"
    return text[1:] if float(text) == 0.0 and text.startswith("-") else text


def comment(text: str) -> str:
    """One line of ASCII without parentheses, which end a comment."""
    plain = text.replace("(", "[").replace(")", "]").encode("ascii", "replace").decode("ascii")
    return " ".join("".join(c if c.isprintable() else " " for c in plain).split())[:_COMMENT]
