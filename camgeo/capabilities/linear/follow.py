# needs: follow
"""The motion that a plate of unknown origin gives a follower: `camgeo follow --linear FROM,TO`."""

from __future__ import annotations

import json
import math
from itertools import pairwise
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from camgeo.capabilities.follow.extension import OtherInputs
from camgeo.cli.arguments import lengths
from camgeo.common.errors import CallError
from camgeo.common.terminal import escaped
from camgeo.common.units import UNIT_MM
from kin.law.piecewise import Piecewise
from kin.law.segment import Constant
from kin.linear.follower import Arm, LinearFollower, Stem
from kin.linear.judge import positions
from kin.numeric.records import dataclass
from kin.read.errors import ReadError
from kin.read.files import read_drawing, read_solid
from kin.read.formats import format_of

if TYPE_CHECKING:
    import argparse
    from pathlib import Path

    from kin.contour.contour import Contour
    from kin.linear.follower import Guide
    from kin.numeric.arrays import Array

STEPS = 720  # of the travel
LEAST_REST = 10  # steps that a dwell lasts at least
LEAST_OVERRUN = 1.0  # mm beyond the contacts of a recipe
STEEPEST = 80.0  # degrees that a stem may lean
NO_PAGE = "no page is made of a plate: leave --page out; `camgeo verify --page` by its recipe makes one"


@dataclass(frozen=True, eq=False)
class FollowedPlate:
    """The motion over a travel u (n,), mm: positions (n,), mm along a stem from y = 0, or rad of an arm from level.

    `words` name the follower; `reading` is the tolerance of dwells, mm. `guide` and `radius`, mm, are the follower's,
    `kind` is that of a recipe, and `reach` the least and the greatest x of the outline, mm.
    """

    name: str
    words: str
    u: Array
    position: Array
    reading: float
    guide: Guide
    kind: str
    radius: float
    reach: tuple[float, float]

    @property
    def swings(self) -> bool:
        """Whether the follower swings on an arm."""
        return isinstance(self.guide, Arm)

    @property
    def lever(self) -> float:
        """Length, mm, by which a position becomes a path: of an arm, or 1."""
        return self.guide.length if isinstance(self.guide, Arm) else 1.0

    @property
    def unit(self) -> Literal["mm", "rad"]:
        """Unit of the motion: mm on a stem, rad on an arm."""
        return "rad" if self.swings else "mm"

    @property
    def told(self) -> str:
        """Unit of positions as they are shown."""
        return "deg" if self.swings else "mm"

    @property
    def shown(self) -> Array:
        """Positions (n,), mm or degrees."""
        return np.degrees(self.position) if self.swings else self.position

    @property
    def rests(self) -> list[tuple[float, float, float]]:
        """Begin and end, mm, and level, mm or degrees, of stretches in which the position keeps within the reading."""
        within = self.reading / self.lever
        still = np.abs(np.diff(self.position)) <= within / LEAST_REST
        ends = np.flatnonzero(np.diff(np.concatenate([[0], still.astype(np.int8), [0]])))
        found = []
        for begin, end in pairwise(ends.tolist()):
            inside = self.position[begin : end + 1]
            if still[begin] and end - begin >= LEAST_REST and np.ptp(inside) <= 2.0 * within:
                found.append((float(self.u[begin]), float(self.u[end]), float(np.median(self.shown[begin : end + 1]))))
        return found

    def document(self) -> dict[str, Any]:
        """The figures as plain data; lengths in mm, angles in degrees."""
        low, high = int(self.shown.argmin()), int(self.shown.argmax())
        return {
            "file": self.name,
            "follower": self.words,
            "unit": self.told,
            "travel": [float(self.u[0]), float(self.u[-1])],
            "lift": float(self.shown[high] - self.shown[low]),
            "least": {"position": float(self.shown[low]), "at": float(self.u[low])},
            "greatest": {"position": float(self.shown[high]), "at": float(self.u[high])},
            "dwells": [{"from": begin, "to": end, "position": level} for begin, end, level in self.rests],
        }

    def summary(self) -> str:
        """Text for a terminal."""
        told, unit = self.document(), self.told
        rows = [f"{escaped(self.name)}: {self.words}, over a travel from {self.u[0]:.6g} to {self.u[-1]:.6g} mm"]
        rows.append(
            f"  lift {told['lift']:.6g} {unit}: from {told['least']['position']:.6g} at {told['least']['at']:.6g} mm "
            f"to {told['greatest']['position']:.6g} at {told['greatest']['at']:.6g} mm"
        )
        rows += [f"  rests from {begin:.6g} to {end:.6g} mm at {level:.6g} {unit}" for begin, end, level in self.rests]
        return "\n".join(rows)

    def table(self) -> str:
        """Motion over the travel as CSV text; the velocity is by the travel, from differences."""
        velocity = np.gradient(self.shown, self.u)
        rows = np.column_stack([self.u, self.shown, velocity]) + 0.0
        head = f"travel_mm,position_{self.told},velocity_{self.told}_per_mm"
        return "\n".join([head, *(",".join(f"{value:.12g}" for value in row) for row in rows.tolist()), ""])

    def lifts(self) -> str:
        """Lifts over the travel as CSV text that a recipe reads, from the least position on."""
        rows = np.column_stack([self.u - self.u[0], np.round(self.shown - self.shown.min(), 9)]) + 0.0
        lines = (f"{at:.12g},{lift:.12g}" for at, lift in rows.tolist())
        return "\n".join([f"travel_mm,lift_{self.told}", *lines, ""])

    def recipe(self, table: str) -> str:
        """Text of a recipe of a plate with this motion, whose lifts are in the file `table`.

        The metal reaches as far beyond the motion as that of the file, and the tolerance is twice the reading. Raises
        CallError where the plate would lie below its lower edge.
        """
        least, guide = float(self.position.min()), self.guide
        keys = [f"kind: {self.kind}", *([f"radius: {self.radius:.9g}"] if self.radius else [])]
        if isinstance(guide, Arm):
            base, shift = guide.pivot + guide.length * math.sin(least) - self.radius, 0.0
            side = "trailing" if guide.side > 0 else "leading"
            keys.append(f"arm: {{length: {guide.length:.9g}, pivot: {guide.pivot:.9g}, side: {side}}}")
        else:
            base, shift = least * math.cos(guide.gamma) - self.radius, least * math.sin(guide.gamma)
            keys += [f"lean: {-math.degrees(guide.gamma):.9g}"] if guide.gamma else []
        if not base > 0.0:
            raise CallError(f"the contour comes down to y = {base:.6g} mm: give --at with a lower edge below it")
        first, last = self._end_contacts()
        overrun = (max(upto, LEAST_OVERRUN) for upto in (first - self.reach[0], self.reach[1] - last))
        zero = float(self.u[0]) + shift
        about = f"The motion of {escaped(self.name)} under a {self.words}; x = 0 is at {zero:.6g} mm of the file"
        reading = math.degrees(self.reading / self.lever) if self.swings else self.reading
        lines = [
            f"about: {json.dumps(about, ensure_ascii=False)}",
            "cam:",
            "  kind: linear",
            f"  base: {base:.9g}",
            f"  follower: {{{', '.join(keys)}}}",
            f"  ends: {{overrun: [{', '.join(f'{length:.6g}' for length in overrun)}]}}",
            f"  motion: {{table: {json.dumps(table, ensure_ascii=False)}, reading: {reading:.6g}}}",
            "export:",
            f"  tolerance: {2.0 * self.reading:.6g}",
            "  files: [dxf, csv, html]",
            "",
        ]
        return "\n".join(lines)

    def told_recipe(self, table: str) -> tuple[str, list[str]]:
        """Text of `recipe`; the summary tells what it has."""
        return self.recipe(table), []

    def page(self) -> str:
        """Raise CallError: there is none."""
        raise CallError(NO_PAGE)

    def _end_contacts(self) -> tuple[float, float]:
        """Places along x, mm, at which the follower touches the plate at its first and last input."""
        s, guide = self.position, self.guide
        if isinstance(guide, Arm):
            x, y = self.u - guide.side * guide.length * np.cos(s), guide.length * np.sin(s)
        else:
            x, y = self.u + s * math.sin(guide.gamma), s * math.cos(guide.gamma)
        along, up = np.gradient(x, self.u, edge_order=2), np.gradient(y, self.u, edge_order=2)
        touched = x + self.radius * up / np.hypot(along, up)
        return float(touched[0]), float(touched[-1])


def _add_arguments(parser: argparse.ArgumentParser) -> None:
    text = "a plate that slides, the inputs at which its motion begins and ends, mm: 0,120; x and y begin at --at"
    parser.add_argument("--linear", type=lengths, metavar="FROM,TO", help=text)
    text = "degrees by which the stem on a plate leans so that the rise is eased; --arm is height of the pivot, length"
    parser.add_argument("--lean", type=float, default=0.0, metavar="DEG", help=text)


def _follow(arguments: argparse.Namespace) -> FollowedPlate:
    """Motion of a roller, shoe or knife edge set down on a plate's outline; raises CallError where it touches none."""
    from camgeo.common.arguments import number_of, path_of, tuple_of

    path = path_of("file", arguments.file)
    span = tuple_of("linear", arguments.linear)
    arguments.lean = number_of("lean", arguments.lean)
    if len(span) != len(("from", "to")) or not span[0] < span[1]:
        raise CallError("linear takes two inputs in mm, the lesser first, such as --linear 0,120")
    of_discs = (arguments.flat, arguments.yoke, arguments.offset, arguments.track != "external", arguments.across)
    given = arguments.body is not None or arguments.width is not None
    if any(of_discs) or arguments.mirror or arguments.turn or given:
        raise CallError("a plate is followed by a roller, a shoe or a knife edge: leave the other options out")
    radius = arguments.shoe if arguments.shoe is not None else arguments.roller
    if radius is None or not radius >= 0.0:
        raise CallError("give --roller with a radius, 0 for a knife edge, or --shoe")
    touch = "shoe" if arguments.shoe is not None else "roller" if radius else "knife edge"
    guide, level, words = _guide(arguments)
    law = Piecewise(np.array(span), (Constant(0.0),))
    follower = LinearFollower(guide, radius, level, law)
    unit = None if arguments.units is None else UNIT_MM[arguments.units]
    u = np.linspace(span[0], span[1], STEPS + 1)
    outline = _outline(path, unit, arguments.gap).moved(-arguments.at[0], -arguments.at[1])
    place = positions(outline, follower, u)
    lost = np.flatnonzero(~np.isfinite(place))
    if lost.size:
        raise CallError(f"{escaped(str(path))}: the follower touches nothing at input {u[lost[0]]:.6g} mm")
    of_size = f" of {radius:.6g} mm" if radius else ""
    reach = float(outline.vertices[:, 0].min()), float(outline.vertices[:, 0].max())
    return FollowedPlate(
        path.name,
        f"{touch}{of_size} {words}",
        u,
        place,
        arguments.reading,
        guide,
        touch.replace(" ", "-"),
        radius,
        reach,
    )


def _guide(arguments: argparse.Namespace) -> tuple[Guide, float, str]:
    """The guide, the height at which positions count from, mm, and words for it."""
    if arguments.arm is None:
        if not abs(arguments.lean) <= STEEPEST:
            raise CallError(f"a stem leans by up to {STEEPEST:g} degrees either way")
        lean = f", which leans by {arguments.lean:g} degrees" if arguments.lean else ""
        return Stem(-math.radians(arguments.lean)), 0.0, f"on a stem{lean}"
    if len(arguments.arm) != len(("pivot", "length")) or not arguments.arm[1] > 0.0:
        raise CallError("the arm on a plate has the height of its pivot and its length, mm: --arm 50,60")
    pivot, length = arguments.arm
    return Arm(length, pivot, -1 if arguments.leading else 1), pivot, f"on an arm of {length:.6g} mm"


def _outline(path: Path, unit: float | None, gap: float | None) -> Contour:
    """The outermost contour of a drawing or solid, mm; raises CallError for a file that has none."""
    try:
        contents = format_of(path).contents
        if contents == "drawing":
            drawing = read_drawing(path, gap, unstated=unit or 1.0)
            scale = (unit or 1.0) if drawing.units_mm is None else 1.0
            return drawing.chains[0].contour.scaled(scale) if scale != 1.0 else drawing.chains[0].contour
        if contents == "solid":
            return read_solid(path, [], unit).chains[0].contour
    except (ReadError, ValueError) as error:
        raise CallError(str(error)) from error
    except OSError as error:
        raise CallError(f"{escaped(str(path))}: {error.strerror or error}") from error
    raise CallError(f"{escaped(str(path))}: a drawing or a solid is expected")


ANSWERS = OtherInputs(
    option="linear",
    add_arguments=_add_arguments,
    follow=_follow,
    alone={"--lean": ("lean", 0.0)},
    drawings="follow a plate on a slide over its travel: --linear 0,120",
)
