"""Programs of a machine that turns its work under a cutter: X along the work, A about it, Z towards it, Y beside it.

What a drum and a barrel have in common: passes at growing depths, decimals of the words, and the words themselves.
"""

from __future__ import annotations

import math
from itertools import pairwise
from typing import TYPE_CHECKING, Any, NamedTuple, Protocol, TypeVar

import numpy as np

from camgeo.common.rounding import downward, upward
from camgeo.files.gcode import SHARE, comment, feed_text, plain
from camgeo.recipe.machining import INVERSE, MOST_PLACES
from kin.numeric.records import dataclass
from kin.read.gcode import LARGEST
from kin.turned.checks import Cutting

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence
    from pathlib import Path

    from camgeo.recipe.export import FileRequest
    from camgeo.recipe.recipe import ShaftOrder
    from kin.numeric.arrays import Array

CHORDS = (
    0.6  # of what setting and rounding leave of the tolerance, for lines between blocks: the judge's proof takes some
)
ROUNDED = 0.5  # of the tolerance, that words of few decimals may take
FEWEST = 3  # decimals, where a recipe does not ask for a number
MOST_PASSES = 2000


class Ending(Protocol):
    """A way of a cutter down to a depth."""

    @property
    def end(self) -> float:
        """Distance of the cutter's end from the work's axis, mm."""


W = TypeVar("W", bound=Ending)


class Cut(NamedTuple):
    """A pass: points (n, 3) of A, rad, X and Y, mm, how far out its end is, mm, and what it is."""

    points: Array
    z: float
    name: str


@dataclass(frozen=True, eq=False)
class TurnedWork:
    """A program that a recipe asks for, of work with a blank of a radius and a track of a depth, mm.

    `mm` is the unit of its numbers, `rounded` the greatest error of a flank, mm, by words of so many decimals.
    """

    recipe: ShaftOrder
    request: FileRequest
    blank: float
    depth: float
    mm: float
    rounded: Callable[[int], float]

    @property
    def own(self) -> dict[str, Any]:
        """Options of the program."""
        return self.request.own

    @property
    def inverse(self) -> bool:
        """Whether each block states the inverse of its time."""
        return bool(self.own.get("feed_mode", INVERSE) == INVERSE)

    @property
    def beside(self) -> bool:
        """Whether Y moves."""
        return "Y" in self.own["axes"]

    @property
    def cut(self) -> float:
        """Greatest depth of a pass, mm."""
        return float(self.own.get("depth_of_cut", self.depth))

    def key(self, name: str) -> str:
        """Path of an option of the program in the recipe."""
        return f"{self.recipe.field_of(self.request)}.{self.request.kind}.{name}"

    def places(self, tolerance: float) -> int:
        """Decimals of the words: as the request states, or as few as take a small share of the tolerance, mm.

        Raises RecipeErrors for so few that rounding takes too much of it.
        """
        stated = self.own.get("decimals")
        for count in range(FEWEST if stated is None else stated, MOST_PLACES + 1):
            if self.rounded(count) <= (SHARE if stated is None else ROUNDED) * tolerance:
                if stated is not None and count > stated:
                    problem = f"rounding takes {self.rounded(stated) / self.recipe.mm:.3g} {self.recipe.units}"
                    remedy = f"give at least {count}"
                    problem = f"{problem} of the tolerance"
                    raise self.recipe.error(self.key("decimals"), problem, str(stated), remedy)
                return count
        return MOST_PLACES

    def demand_few(self, passes: int, ways: list[tuple[str, W]], last: int = 0) -> None:
        """Raise RecipeErrors for more passes than a program has: of `ways`, in depths of cut, and `last` ones."""
        if passes > MOST_PASSES:
            # steps begin anew at each depth at which a way ends
            levels = (MOST_PASSES - last) // len({name for name, _ in ways}) - len({way.end for _, way in ways}) + 1
            least = upward((self.blank - min(way.end for _, way in ways)) / levels / self.recipe.mm, 4)
            problem, remedy = f"makes more than {MOST_PASSES} passes", f"give at least {least} {self.recipe.units}"
            raise self.recipe.error(self.key("depth_of_cut"), problem, None, remedy)

    def write(self, path: Path, count: int, head: Sequence[str], cuts: Sequence[Cut]) -> int:
        """Write a program with words of so many decimals; the number of its blocks.

        Raises RecipeErrors for a safe height or a feed whose words are out of range, OSError where it cannot be
        written.
        """
        recipe = self.recipe
        if (self.blank + self.own["safe_height"]) / self.mm > LARGEST:
            most = downward((LARGEST * self.mm - self.blank) / recipe.mm, 4)
            why = "lies higher than a program tells"
            raise recipe.error(self.key("safe_height"), why, None, f"give at most {most} {recipe.units}")
        written = _Written(self, count)
        lines = [f"({comment(text)})" for text in filter(None, head)] + written.begun()
        for k, cut in enumerate(cuts, start=1):
            lines.append(f"({comment(f'{cut.name}, pass {k} of {len(cuts)}')})")
            lines += written.cut(cut)
        if written.fastest > LARGEST:
            most = downward(self.own["feed"] * LARGEST / written.fastest / recipe.mm, 4)
            why = "makes the inverse time of the shortest block larger than is read"
            raise recipe.error(self.key("feed"), why, None, f"give at most {most}, or feed_mode: per-minute")
        path.write_bytes("\n".join([*lines, "G94", "M5", "M30", ""]).encode("ascii"))
        return written.blocks

    def head(self, tolerance: float, body: str, about: Sequence[str]) -> list[str]:
        """Comments at the top of the program: what it is, its cutter, its axes, and its feed.

        `body` names the work, `about` says where A is zero and how it goes on.
        """
        recipe, own, mm = self.recipe, self.own, self.mm
        blank, feed = plain(self.blank / mm), plain(own["feed"] / mm)
        return [
            recipe.name,
            recipe.about,
            f"units: {'inch' if mm != 1.0 else 'mm'}, A in degrees",
            f"cutter: diameter {plain(own['cutter'] / mm)}{_cone(own)}, its axis square to the {body}'s",
            f"tolerance: {plain(tolerance / mm)}",
            f"X zero: the lower face; X grows along the {body}'s axis, towards the upper face",
            about[0],
            f"A grows as the cutter goes round the {body} counter-clockwise, seen from the upper face",
            *about[1:],
            f"Z zero: the {body}'s axis; blank {blank}, floor {plain((self.blank - self.depth) / mm)}",
            f"Y zero: over the {body}'s axis; seen from the cutter Y grows as A does" if self.beside else "",
            "climb milling along each flank, spindle clockwise",
            f"feed: G93, the inverse of the minutes of a block, {feed} a minute at a radius of {blank}"
            if self.inverse
            else f"feed: G94, along the path at a radius of {blank}: the control has to count A at that radius",
        ]


def cutting_of(request: FileRequest, depth: float) -> Cutting:
    """How a requested program cuts a track of a depth, mm, in kin's words."""
    own = request.own
    inverse = own.get("feed_mode", INVERSE) == INVERSE
    return Cutting(0.5 * own["cutter"], own["feed"], inverse, own.get("depth_of_cut", depth), own.get("taper", 0.0))


def demand_judged(recipe: ShaftOrder, request: FileRequest, finest: float, what: str) -> None:
    """Raise RecipeErrors for a program, named, whose tolerance is finer than what it leaves is judged to, mm."""
    tolerance = request.tolerance or recipe.export.tolerance
    if tolerance < finest:
        remedy = f"give at least {upward(finest / recipe.mm, 2)} {recipe.units}"
        problem, shown = f"what {what} leaves is not judged so finely", f"{tolerance / recipe.mm:.9g} {recipe.units}"
        raise recipe.error(recipe.tolerance_field(request), problem, shown, remedy)


def down(blank: float, cut: float, ways: list[tuple[str, W]]) -> list[tuple[str, W, float]]:
    """Ways with how far out their ends are, mm, in steps of at most `cut` from the blank to the depth of each.

    At a depth the first way of each name goes that reaches down to it.
    """
    floor = min(way.end for _, way in ways)
    depths = sorted({way.end for _, way in ways}, reverse=True)
    levels: list[float] = []
    for z in depths:
        above = levels[-1] if levels else blank
        parts = max(math.ceil((above - z) / cut * (1.0 - 1e-9)), 1)
        levels += [above - (above - z) * k / parts for k in range(1, parts + 1)]
    found = []
    for level in levels:
        for name in dict.fromkeys(name for name, _ in ways):
            own = [way for each, way in ways if each == name]
            way = next((each for each in own if each.end <= level + 1e-9), own[-1])
            found.append((name, way, max(level, floor)))
    return found


def _cone(own: dict[str, Any]) -> str:
    return f" at its end, half angle {plain(math.degrees(own['taper']))} degrees" if "taper" in own else ""


class _Written:
    """Blocks of passes, in the words of a machine, and how many there are."""

    def __init__(self, work: TurnedWork, count: int) -> None:
        self.own, self.count, self.mm, self.blocks = work.own, count, work.mm, 0
        self.fastest = 0.0
        self.blank = work.blank
        self.safe = work.blank + work.own["safe_height"]
        self.inverse, self.beside = work.inverse, work.beside

    def begun(self) -> list[str]:
        """Units and modes, the cutter drawn out and the spindle on."""
        feed = "G93" if self.inverse else "G94"
        unit = "G20" if self.mm != 1.0 else "G21"
        return [
            unit,
            f"G17 G90 {feed}",
            "G40 G49 G80",
            f"G0 Z{self._text(self.safe / self.mm)}",
            f"S{plain(self.own['spindle'])} M3",
        ]

    def cut(self, cut: Cut) -> Iterator[str]:
        """A pass."""
        scale = np.array([math.degrees(1.0), 1.0 / self.mm, 1.0 / self.mm])
        rounded = np.round(cut.points * scale, self.count) + 0.0
        rows = rounded.tolist()
        yield f"G0 {self._place(rows[0])}"
        low, high = self._text(cut.z / self.mm), self._text(self.safe / self.mm)
        yield f"G1 Z{low} F{self._feed(self.own['plunge'], (float(high) - float(low)) * self.mm)}"
        first = True
        for before, after in pairwise(rows):
            if before == after:
                continue
            turn, along, beside = (b - a for a, b in zip(before, after, strict=True))
            far = math.hypot(math.radians(turn) * self.blank, along * self.mm, beside * self.mm)
            feed = f" F{self._feed(self.own['feed'], far)}" if self.inverse or first else ""
            first = False
            yield f"G1 {self._place(after)}{feed}"
            self.blocks += 1
        yield f"G0 Z{high}"

    def _place(self, row: list[float]) -> str:
        a, x, y = (self._text(value) for value in row)
        return f"X{x} Y{y} A{a}" if self.beside else f"X{x} A{a}"

    def _feed(self, feed: float, far: float) -> str:
        stated = feed / far if self.inverse else feed / self.mm
        self.fastest = max(self.fastest, stated)
        return feed_text(stated)

    def _text(self, value: float) -> str:
        text = f"{value:.{self.count}f}"
        return text[1:] if float(text) == 0.0 and text.startswith("-") else text
