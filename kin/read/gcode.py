"""Programs for milling machines as moves: RS-274 (NIST IR 6556), the words that a contour needs, and no others.

Read are G0 to G3 with I and J from the start of an arc, G17, G20, G21, G40, G49, G54, G80, G90, G91, G91.1, G94, F, S,
M3, M5, M2 and M30, N and comments. Every other word is refused with the number of its line: a program that is only
half understood is not judged.
"""

from __future__ import annotations

import math
import re
from pathlib import Path
from typing import ClassVar, NamedTuple

import numpy as np

from kin.contour.arcs import Arcs
from kin.numeric.records import dataclass
from kin.read.errors import ReadError
from kin.read.formats import contents

ARC_MM = 0.002  # by which the distances of an arc's ends from its centre may differ (NIST IR 6556, 3.5.3)
MOST_LINES = 1_000_000
LARGEST = 1e6  # of a number as written
CENTRES = "have the post-processor write arcs by their centre, I and J"
_WORD = re.compile(r"([A-Z])([+-]?(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+))")
_COMMENT = re.compile(r"\(([^()]*)\)")
GROUPS = {
    "motion": ("0", "1", "2", "3"),
    "plane": ("17",),
    "units": ("20", "21"),
    "distance": ("90", "91"),
    "arc centres": ("91.1",),
    "feed": ("94",),
    "cutter compensation": ("40",),
    "tool length": ("49",),
    "cycle": ("80",),
    "offsets": ("54",),
}
_SPINDLE, _END = ("3", "5"), ("2", "30")


class ToolMove(NamedTuple):
    """One move of the cutter from `start` to `end`, x, y and z, mm.

    line        number of its line in the file, from 1
    sweep       of an arc in the plane, rad, counter-clockwise positive; 0 for a straight move
    centre      of an arc, x and y, mm; None for a straight move
    feed        mm a minute; 0 for a rapid move
    turning     whether the spindle turns
    mismatch    mm by which the ends of an arc differ in their distance from its centre
    """

    line: int
    rapid: bool
    start: tuple[float, float, float]
    end: tuple[float, float, float]
    sweep: float
    centre: tuple[float, float] | None
    feed: float
    turning: bool
    mismatch: float = 0.0


@dataclass(frozen=True)
class Program:
    """The moves of a program and its comments, both in order, and the mm in its unit, 25.4 or 1."""

    path: Path
    moves: tuple[ToolMove, ...]
    units_mm: float
    comments: tuple[str, ...]


def read_gcode(path: Path | str) -> Program:
    """Read a milling program.

    Raises OSError where the file cannot be read; ReadError for a file that is too large or not ASCII, a program that
    does not end or makes no move, and, with the number of the line, for words that are not read or do not fit together.
    """
    machine = Machine(Path(path))
    follow(machine)
    return Program(machine.path, tuple(machine.moves), machine.unit, tuple(machine.comments))


def follow(machine: Machine) -> None:
    """Let a machine follow its program to the end; raises as `read_gcode` does."""
    path = machine.path
    try:
        text = contents(path, "gcode").decode("ascii")
    except UnicodeDecodeError as error:
        raise ReadError("syntax", f"byte {error.start} is not ASCII", path) from error
    if max(text.count("\n"), text.count("\r")) > MOST_LINES:
        raise ReadError("range", f"more than {MOST_LINES} lines", path)
    for number, line in enumerate(text.splitlines(), start=1):
        machine.block(number, line)
    if not machine.ended:
        raise ReadError("truncated", "the program does not end: there is no M30 or M2", path)
    if not machine.moves:
        raise ReadError("empty", "the program makes no move", path)


def arcs_of(moves: tuple[ToolMove, ...] | list[ToolMove]) -> Arcs:
    """Paths of the moves in the plane, mm: lines, and arcs through both ends, in four parts beyond a quarter turn.

    No move may be without length.
    """
    start = np.array([move.start[:2] for move in moves])
    chord = np.array([move.end[:2] for move in moves]) - start
    sweep = np.array([move.sweep for move in moves])
    straight = np.hypot(chord[:, 0], chord[:, 1])
    # the heading at the start is the chord's less half the sweep; chord = 2 sin(sweep / 2) / curvature
    heading = np.arctan2(chord[:, 1], chord[:, 0]) - 0.5 * sweep
    bent = np.where(sweep == 0.0, 1.0, sweep)
    with np.errstate(divide="ignore", invalid="ignore"):
        curvature = np.where(sweep == 0.0, 0.0, 2.0 * np.sin(0.5 * bent) / straight)
        length = np.where(sweep == 0.0, straight, bent / curvature)
    for i, move in enumerate(moves):
        if straight[i] == 0.0 and move.centre is not None:  # a full circle
            away = start[i] - np.array(move.centre)
            radius, sense = math.hypot(*away.tolist()), math.copysign(1.0, move.sweep)
            curvature[i], length[i] = sense / radius, 2.0 * math.pi * radius
            heading[i] = math.atan2(away[1], away[0]) + sense * 0.5 * math.pi
    arcs = Arcs(start, np.column_stack([np.cos(heading), np.sin(heading)]), curvature, length)
    return arcs.cut(1 + (np.abs(sweep) > 0.5 * math.pi).astype(np.intp) * 3)[0]


class Machine:
    """State of a machine that follows a program block by block, with the moves made and the comments met so far.

    `letters` are those of words with lengths and angles, `groups` the codes of the G words that exclude one another.
    """

    letters: ClassVar[str] = "XYZIJ"
    groups: ClassVar[dict[str, tuple[str, ...]]] = GROUPS

    def __init__(self, path: Path) -> None:
        self.path = path
        self.moves: list[ToolMove] = []
        self.comments: list[str] = []
        self._group_of = {code: group for group, codes in self.groups.items() for code in codes}
        self.modes: dict[str, str] = {}  # code in force of each group of G words
        self.at: list[float | None] = [None, None, None]  # x, y, z, mm, None until a word has set it
        self.unit = 0.0  # mm, 0 before G20 or G21
        self.feed = self.speed = 0.0
        self.turning = self.ended = False

    def block(self, number: int, line: str) -> None:
        """Carry out one line of the program."""
        words = self._words(number, line)
        if not words:
            return
        if self.ended:
            raise self._error(number, "stands after the end of the program")
        codes = self._codes(number, words)
        numbers = self._numbers(number, words)
        self._modes(number, codes)
        if "F" in numbers:
            self.feed = self._feed(number, numbers["F"])
        self.speed = numbers.get("S", self.speed)
        for value in (numbers.get("F", 1.0), numbers.get("S", 1.0)):
            if not value > 0.0:
                raise self._error(number, "a feed and a speed must be above 0")
        self._spindle(number, codes)
        if any(axis in numbers for axis in self.letters):
            self._move(number, numbers)
        if any(code in _END for letter, code in codes if letter == "M"):
            self.ended = True

    def _error(self, number: int, what: str, reason: str = "unsupported") -> ReadError:
        return ReadError(reason, f"line {number}: {what}", self.path)

    def _words(self, number: int, line: str) -> list[tuple[str, str]]:
        self.comments += [text.strip() for text in _COMMENT.findall(line)]
        bare = _COMMENT.sub("", line)
        bare, mark, remark = bare.partition(";")
        if mark:
            self.comments.append(remark.strip())
        bare = "".join(bare.split()).upper()
        if bare in ("", "%"):
            return []
        words = _WORD.findall(bare)
        if "".join(letter + value for letter, value in words) != bare:
            unread = _WORD.sub(" ", bare).split()
            raise self._error(number, f"{unread[0] if unread else bare} is not read", "syntax")
        return [word for word in words if word[0] != "N"]

    def _codes(self, number: int, words: list[tuple[str, str]]) -> list[tuple[str, str]]:
        """Words G and M, their numbers in one form; each known, and no two of one group."""
        codes: list[tuple[str, str]] = []
        groups: set[str] = set()
        for letter, text in words:
            if letter not in "GM":
                continue
            code = f"{float(text):g}"
            group = (
                self._group_of.get(code)
                if letter == "G"
                else {**dict.fromkeys(_SPINDLE, "spindle"), **dict.fromkeys(_END, "end")}.get(code)
            )
            if group is None:
                raise self._error(number, f"{letter}{text} is not read")
            if group in groups:
                raise self._error(number, f"two words set the {group}", "syntax")
            groups.add(group)
            codes.append((letter, code))
        return codes

    def _numbers(self, number: int, words: list[tuple[str, str]]) -> dict[str, float]:
        numbers: dict[str, float] = {}
        for letter, text in words:
            if letter in "GM":
                continue
            if letter not in self.letters + "FS":
                remedy = f", an arc by its radius; {CENTRES}" if letter == "R" else ""
                raise self._error(number, f"{letter}{text} is not read{remedy}")
            if letter in numbers:
                raise self._error(number, f"{letter} stands twice", "syntax")
            numbers[letter] = float(text)
            if not abs(numbers[letter]) <= LARGEST:
                raise self._error(number, f"{letter}{text} is out of range", "range")
        return numbers

    def _modes(self, number: int, codes: list[tuple[str, str]]) -> None:
        for letter, code in codes:
            if letter == "G":
                self.modes[self._group_of[code]] = code
        unit = {"20": 25.4, "21": 1.0}.get(self.modes.get("units", ""), 0.0)
        if self.unit and unit != self.unit:
            raise self._error(number, "the unit changes within the program")
        self.unit = unit

    def _feed(self, number: int, value: float) -> float:
        return self._length(number, value)

    def _length(self, number: int, value: float) -> float:
        if not self.unit:
            raise self._error(number, "a length stands before G20 or G21", "syntax")
        return value * self.unit

    def _spindle(self, number: int, codes: list[tuple[str, str]]) -> None:
        for letter, code in codes:
            if letter == "M" and code in _SPINDLE:
                self.turning = code == "3"
                if self.turning and not self.speed > 0.0:
                    raise self._error(number, "M3 without a speed S", "syntax")
            elif letter == "M":
                self.turning = False

    def _move(self, number: int, numbers: dict[str, float]) -> None:
        motion, distance = self.modes.get("motion"), self.modes.get("distance")
        if motion is None or distance is None:
            raise self._error(number, "a coordinate stands before G0 to G3, and G90 or G91", "syntax")
        if motion in "23" and self.modes.get("plane") is None:
            raise self._error(number, "an arc stands before G17", "syntax")
        before = list(self.at)
        for k, axis in enumerate("XYZ"):
            if axis not in numbers:
                continue
            value, position = self._length(number, numbers[axis]), self.at[k]
            if distance == "91":
                if position is None:
                    raise self._error(number, f"{axis} moves from an unknown place", "syntax")
                value += position
            self.at[k] = value
        centred = "I" in numbers or "J" in numbers
        if centred != (motion in "23"):
            problem = f"an arc has no centre I, J; {CENTRES}" if motion in "23" else "a straight move has a centre"
            raise self._error(number, problem, "syntax")
        if motion != "0" and not (self.feed > 0.0 and self.turning):
            raise self._error(number, "a feed move without a feed F and a turning spindle M3", "syntax")
        x, y, z = self.at
        if x is None or y is None or z is None:  # the first moves go to a place that is not wholly known
            if motion != "0":
                raise self._error(number, "a feed move from an unknown place", "syntax")
            return
        # a coordinate that was unknown before the move is taken as its end's, and the start no lower than the end
        known = [now if was is None else was for was, now in zip(before, (x, y, z), strict=True)]
        first = (known[0], known[1], max(known[2], z) if None in before else known[2])
        rapid = motion == "0"
        move = ToolMove(number, rapid, first, (x, y, z), 0.0, None, 0.0 if rapid else self.feed, self.turning)
        self.moves.append(self._bent(move, numbers, motion) if centred else move)

    def _bent(self, move: ToolMove, numbers: dict[str, float], motion: str) -> ToolMove:
        """The move with the sweep and the centre of its arc."""
        number, (x, y, z), (x2, y2, z2) = move.line, move.start, move.end
        centre = (
            x + self._length(number, numbers.get("I", 0.0)),
            y + self._length(number, numbers.get("J", 0.0)),
        )
        if z != z2:
            raise self._error(number, "an arc that climbs is not read")
        first, last = math.hypot(x - centre[0], y - centre[1]), math.hypot(x2 - centre[0], y2 - centre[1])
        if not abs(first - last) <= ARC_MM:
            raise self._error(number, f"the ends of the arc lie {first:.9g} and {last:.9g} mm from its centre", "range")
        if not min(first, last) > 0.0:
            raise self._error(number, "an arc of radius 0", "range")
        sweep = math.atan2(y2 - centre[1], x2 - centre[0]) - math.atan2(y - centre[1], x - centre[0])
        turn = 2.0 * math.pi
        # above 0 up to a turn for G3, from a turn below 0 for G2; equal ends make the full circle
        if (x, y) == (x2, y2):
            sweep = turn
        sweep = sweep % turn or turn
        if motion == "2":
            sweep = -((turn - sweep) % turn or turn)
        return move._replace(sweep=sweep, centre=centre, mismatch=abs(first - last))
