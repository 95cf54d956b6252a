"""Path data of SVG as numbers: lines, circular arcs and Bezier pieces, in the user space of the element."""

from __future__ import annotations

import math
import re
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kin.contour.bezier import Beziers
from kin.read.drawing.shapes import ALIKE, Shape, UnfitError, check, shape
from kin.read.errors import short
from kin.read.nesting import MOST_PIECES

if TYPE_CHECKING:
    from collections.abc import Iterator

    from kin.read.drawing.shapes import Affine

NUMBER = r"[-+]?(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)(?:[eE][-+]?[0-9]+)?"
TOKEN = re.compile(rf"([A-Za-z])|({NUMBER})|[\s,]+|(.)", re.DOTALL)
# Numbers that follow each letter that is read.
COUNT = {"M": 2, "L": 2, "H": 1, "V": 1, "A": 7, "C": 6, "Z": 0}


class Loose(NamedTuple):
    """One piece of a path: its letter, where the pen stands before it, and its numbers in absolute coordinates."""

    letter: str
    start: tuple[float, float]
    numbers: tuple[float, ...]

    @property
    def end(self) -> tuple[float, float]:
        """Point (x, y) at which the pen stands after the piece."""
        return self.numbers[-2], self.numbers[-1]


def path_of(text: str, to: Affine) -> list[Shape]:
    """Shapes of path data under a map, one for each stretch of lines and arcs or of cubics; closing lines are drawn.

    Letters M, L, H, V, A, C and Z are read, absolute and relative; arcs of circles only. Raises UnfitError for anything
    else, too many pieces, and numbers that are too large.
    """
    _demand_few(text)
    shapes: list[Shape] = []
    chords: list[tuple[float, ...]] = []
    cubics: list[list[tuple[float, float]]] = []

    def close() -> None:
        if chords:
            shapes.append(shape(chords=chords, heights=0.0))
        if cubics:
            control = np.array(cubics)
            check(control)
            shapes.append(shape(beziers=Beziers(control, np.ones(control.shape[:2])), heights=0.0))
        chords.clear()
        cubics.clear()

    # a stretch ends where the pen is lifted, or between lines and cubics
    pen = (0.0, 0.0)
    for count, piece in enumerate(pieces_of(text)):
        if count >= MOST_PIECES:
            raise _too_many()
        if piece.start != pen or (chords if piece.letter == "C" else cubics):
            close()
        pen = piece.end
        x, y = to.at(*piece.start)
        if piece.letter == "C":
            inner = [to.at(*piece.numbers[k : k + 2]) for k in (0, 2, 4)]
            cubics.append([(x, y), *inner])
        else:
            bulge = bulge_of(piece) * to.scale_and_sense()[1] if piece.letter == "A" else 0.0
            chords.append((x, y, *to.at(*piece.end), bulge))
    close()
    return shapes


def _demand_few(text: str) -> None:
    """Raise UnfitError for path data that have more than MOST_PIECES pieces whatever they say, before any is read."""
    letters = {letter: text.count(letter) + text.count(letter.lower()) for letter in COUNT}
    drawn = sum(count for letter, count in letters.items() if letter not in "MZ")
    # a letter may stand for several pieces, of as many numbers each as the letters that are there take at most; of the
    # words between blanks and commas each has a number, or is a letter
    most = max((COUNT[letter] for letter in COUNT if letters[letter]), default=0)
    characters = np.frombuffer(text.encode("utf-8", "replace"), np.uint8)
    apart = (characters <= ord(" ")) | (characters == ord(","))
    numbers = np.count_nonzero(apart[:-1] & ~apart[1:]) - sum(letters.values())
    if drawn > MOST_PIECES or numbers > COUNT["M"] * letters["M"] + most * MOST_PIECES:
        raise _too_many()


def _too_many() -> UnfitError:
    return UnfitError("range", f"it has more than {MOST_PIECES} pieces")


def pieces_of(text: str) -> Iterator[Loose]:
    """Pieces L, A and C of path data in absolute coordinates; a closing line only where it has a length.

    Raises UnfitError for data that do not begin with M, or are not read.
    """
    # H, V and Z become L; relative numbers are counted from the pen
    pen = first = (0.0, 0.0)
    drawn = False
    for letter, numbers in commands(text):
        relative, kind = letter.islower(), letter.upper()
        dx, dy = pen if relative else (0.0, 0.0)
        if kind == "M":
            first = pen = (numbers[0] + dx, numbers[1] + dy)
            drawn = True
            continue
        if not drawn:
            raise UnfitError("syntax", "its path does not begin with M")
        if kind == "Z":
            if pen != first:
                yield Loose("L", pen, first)
            pen = first
            continue
        if kind in "HV":
            end = (numbers[0] + dx, pen[1]) if kind == "H" else (pen[0], numbers[0] + dy)
            piece = Loose("L", pen, end)
        elif kind == "A":
            piece = Loose("A", pen, (*numbers[:5], numbers[5] + dx, numbers[6] + dy))
        else:
            moved = [v + (dy if k % 2 else dx) for k, v in enumerate(numbers)]
            piece = Loose(kind, pen, tuple(moved))
        yield piece
        pen = piece.end


def commands(text: str) -> Iterator[tuple[str, list[float]]]:
    """Letters with their numbers; a letter is repeated for each set of numbers, M as L after the first.

    Flags of arcs need no space behind them. Raises UnfitError for any other text.
    """
    letter, at, end = "", 0, len(text)
    while at < end:
        token = TOKEN.match(text, at)
        if token is None or token[3]:
            raise UnfitError("syntax", f"its path has {text[at]!r} where a letter or a number belongs")
        if token[1]:
            letter, at = token[1], token.end()
            if letter.upper() not in COUNT:
                raise UnfitError("unsupported", f"its path has {letter}; M, L, H, V, A, C and Z are read")
            if letter in "Zz":
                yield letter, []
                continue
        elif token[2] is None:
            at = token.end()
            continue
        elif not letter or letter in "Zz":
            raise UnfitError("syntax", f"its path has the number {short(token[2])} where a letter belongs")
        numbers, at = arguments(text, at, letter.upper())
        yield letter, numbers
        letter = {"M": "L", "m": "l"}.get(letter, letter)


GAP = re.compile(r"[\s,]*")
FLAG = re.compile(r"[01]")
VALUE = re.compile(NUMBER)


def arguments(text: str, place: int, kind: str) -> tuple[list[float], int]:
    """Numbers of the letter `kind` from a place in the text on, and the place behind them.

    Raises UnfitError where a number is missing or infinite.
    """
    numbers = []
    for k in range(COUNT[kind]):
        gap = GAP.match(text, place)
        place = gap.end() if gap else place
        number = (FLAG if kind == "A" and k in (3, 4) else VALUE).match(text, place)
        if number is None:
            raise UnfitError("syntax", f"its path has {text[place : place + 20]!r} where a number of {kind} belongs")
        numbers.append(float(number[0]))
        if math.isinf(numbers[-1]):
            raise UnfitError("range", f"its path has {short(number[0])}, beyond all numbers of a drawing")
        place = number.end()
    return numbers, place


def bulge_of(piece: Loose) -> float:
    """Bulge of an arc given by radii, flags and ends, positive where its angle grows (SVG 2, 9.3.8 and B.2).

    The half chord over the radius is the sine of half the sweep. An arc from a point to itself has the bulge 0. Raises
    UnfitError for a radius that is short of half the chord by more than rounding, which the standard enlarges, and for
    radii of an ellipse.
    """
    rx, ry, _, large, forward, x, y = piece.numbers
    if not (rx > 0.0 and abs(rx - ry) <= ALIKE * rx):
        raise UnfitError("unsupported", f"an arc has the radii {rx:.9g} and {ry:.9g}; arcs of circles are read")
    chord = math.hypot(x - piece.start[0], y - piece.start[1])
    sine = 0.5 * chord / rx
    if sine > 1.0 + ALIKE:
        raise UnfitError("range", f"an arc of radius {rx:.9g} does not reach across its chord of {chord:.9g}")
    cosine = math.sqrt(max((1.0 - sine) * (1.0 + sine), 0.0))
    # tan(half/2) = sin/(1 + cos), of the small arc or of what is left of the circle
    bulge = (1.0 + cosine) / sine if large and sine > 0.0 else min(sine, 1.0) / (1.0 + cosine)
    return bulge if forward else -bulge
