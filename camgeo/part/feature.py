"""Records of features of the part, one for each file of `camgeo.part`, and helpers that such files share."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, Generic, Literal, NamedTuple, TypeVar

from camgeo.registry.capability import NO_CHECK
from camgeo.schema.fields import Field, FieldTable, Kind
from kin.numeric.errors import CamgeoError
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Iterable, Mapping, Sequence

    from camgeo.curve.curve import Curve
    from camgeo.fit.pieces import ArcSpline
    from camgeo.part.body import Body
    from camgeo.part.part import Part
    from camgeo.part.shapes import Opening
    from camgeo.part.walls import Looks, Possible
    from camgeo.recipe.recipe import Recipe
    from camgeo.schema.reader import Reader, Values
    from kin.judge.check import Check
    from kin.judge.layers import CrossHole

T = TypeVar("T")
MOST_HOLES = 60
WALL = "wall"  # name of the check on the least wall, and of the figure


class Site(NamedTuple):
    """Part in which a feature seeks its place: the contour, and the openings and the boss that are there.

    `wall` is the recipe's least wall, mm, None where it states none; `edge`, mm, is what a chamfer takes off the
    contour.
    """

    looks: Looks
    openings: Sequence[Opening]
    wall: float | None
    edge: float


class Placed(NamedTuple):
    """Openings for which a place was found, and the check of their number; None where no check is needed."""

    openings: Sequence[Opening]
    check: Check | None = None


class Boss(NamedTuple):
    """Round body about the shaft that stands on the disc; lengths in mm.

    `name` is that of its edge, and of the check of files. `above` and `below` are its heights beyond the upper and the
    lower face of the disc, 0 where it does not stand.
    """

    name: str
    diameter: float
    above: float
    below: float

    @property
    def circle(self) -> Opening:
        """Outline of the boss, as a round opening about the shaft."""
        from camgeo.part.shapes import disc

        return disc(self.name, "HOLES", (0.0, 0.0), 0.5 * self.diameter)

    def holds(self, point: tuple[float, float]) -> bool:
        """Whether a point (x, y) of the disc's face, mm, lies within it."""
        x, y = point
        return x * x + y * y < 0.25 * self.diameter * self.diameter


class Refusal(NamedTuple):
    """Why a feature does not go with something, and what to do; `unless` tells by its keys where it does."""

    problem: str
    remedy: str
    unless: Callable[[Values], bool] | None = None


class FeatureCheck(NamedTuple):
    """Check of a feature: its name in reports and its unit, and of what it is made.

    `exact`: of the exact cam; `files`: of no file, of solids, or of all files with a contour but programs. `strict`: a
    figure equal to its limit fails. `remedy` gives what would let it hold, of the check and the report as plain JSON.
    """

    name: str
    unit: str = "mm"
    exact: bool = False
    files: Literal["none", "solids", "all"] = "solids"
    strict: bool = False
    remedy: Callable[[dict[str, Any], dict[str, Any], Recipe], str] | None = None


class Callout(NamedTuple):
    """A size of a feature on a shop drawing: a text with a leader, and a note below it, empty for none.

    The leader ends on the circle of this centre and radius, mm, at `angle`, rad. `value` is a diameter, mm, that is a
    dimension; None of words.
    """

    text: str
    note: str
    centre: tuple[float, float]
    radius: float
    angle: float
    value: float | None = None


class SheetView(NamedTuple):
    """A part as a shop drawing shows it, perhaps mirrored.

    `part` as in the recipe, `openings` as drawn, by their names. `number` writes a size in mm, `degrees` a direction of
    the recipe, rad; `direction` gives that direction in the drawing, rad.
    """

    part: Part
    openings: Mapping[str, Opening]
    number: Callable[[float], str]
    degrees: Callable[[float], str]
    direction: Callable[[float], float]

    def circle(self, name: str, diameter: float, half_turns: float) -> Callout:
        """Callout of a circle about the shaft, its leader at so many half turns."""
        text = f"Ø{self.number(diameter)}"
        return Callout(text, name, (0.0, 0.0), 0.5 * diameter, half_turns * math.pi, diameter)

    def named(self, word: str) -> list[tuple[tuple[float, float], float]]:
        """Centre and radius of each round opening whose name begins with a word, mm."""
        return [
            opening.circle
            for name, opening in self.openings.items()
            if name.startswith(word) and opening.circle is not None
        ]


@dataclass(frozen=True)
class Feature(Generic[T]):
    """A feature of the part: all that the core asks of it; fields that do not apply are left out.

    Openings, a boss, chamfered edges and cross holes are what solids are made of, and what the judge is given.

    kind      class of its value, which `Part.of` and `Body.of` give
    field     its key of `part`
    needs     other keys of `part` that it cannot be without, each with the reason
    of_ring   whether a ring may have it, `of_pair` whether conjugate discs may
    grooved   why a disc with a groove cannot have it
    locates   whether it fixes the angle of the part on its shaft
    holes     whether it cuts holes, `walled` whether there are walls between it and other edges without them
    check     notes the faults between its keys and others of `part`
    make      its value by what was read of it and of all of `part`; without it `kind` takes its keys
    bore      outline of the bore that it shapes, of a radius in mm
    openings  what it cuts where the recipe says
    place     what it cuts where it finds a place, in the order of the features
    boss      boss that it is
    edge      chamfer of 45 degrees that it gives both edges of the contour, mm
    cross     radial hole that it drills through a boss of a disc of this thickness, mm
    walls     walls round it besides those of its openings, of a body with these surfaces
    contour   check of a contour of the part; the last argument gives the shaft angle, degrees, of its parameter
    judged    what is checked of it
    round     beginning of the names of its round openings, and the field that states their diameter
    grown     its value with metal grown by `out` mm, then scaled
    mirrored  its value in a part mirrored about the x axis
    steadies  change of it that draws the centre of mass to the shaft
    metric    its metric standard size, and what to give instead beside a bore by the inch; empty of any other
    remark    what a drawing does not show of it, in units of so many mm
    unmilled  why a program for a milling machine leaves it
    callouts  its sizes on a shop drawing, beside a bore's own view
    """

    kind: type[T]
    field: Field
    needs: Sequence[tuple[str, str]] = ()
    of_ring: bool = True
    of_pair: bool = True
    grooved: Refusal | None = None
    locates: bool = False
    holes: bool = False
    walled: bool = False
    check: Callable[[Values, Reader], None] = NO_CHECK
    make: Callable[[Any, Values], T | None] | None = None
    bore: Callable[[T, float], ArcSpline] | None = None
    openings: Callable[[T], Sequence[Opening]] | None = None
    place: Callable[[T, Site], Placed] | None = None
    boss: Callable[[T], Boss] | None = None
    edge: Callable[[T], float] | None = None
    cross: Callable[[T, Boss, float], CrossHole] | None = None
    walls: Callable[[T, Body, Sequence[Looks]], Iterable[Possible]] | None = None
    contour: Callable[[T, Curve, Callable[[float], float]], Check] | None = None
    judged: FeatureCheck | None = None
    round: tuple[str, str] | None = None
    grown: Callable[[T, float, float], T] | None = None
    mirrored: Callable[[T], T] | None = None
    steadies: str = ""
    metric: Callable[[T], str] | None = None
    remark: Callable[[T, float], str] | None = None
    unmilled: str = ""
    callouts: Callable[[T, SheetView], Iterable[Callout]] | None = None

    @property
    def name(self) -> str:
        """Key of the feature in `part`, such as `hub`."""
        return self.field.name

    def build(self, part: Values) -> T | None:
        """Make the feature's value from the keys of `part`, in which there is no fault.

        None where the recipe does not give the feature.
        """
        if self.name not in part:
            return None
        if self.make is not None:
            return self.make(part[self.name], part)
        kind: Callable[..., T] = self.kind
        return kind(**part[self.name])


class NothingLeftError(CamgeoError, ValueError):
    """An opening that is no wider than what is taken from it."""


def narrowed(width: float, out: float, scale: float) -> float:
    """Width of an opening, mm, when metal has grown by `out`, mm, on either side and is scaled.

    Raises NothingLeftError where that closes the opening.
    """
    left = width - 2.0 * out
    if not left > 0.0:
        raise NothingLeftError(f"it is {width:.6g} mm across")
    return scale * left


def angle(name: str, about: str) -> Field:
    """Make the field of a direction, an angle in the recipe that is rad as a value."""
    return Field(name, Kind.ANGLE, about, default="0", at_least=-360, at_most=360)


def count(name: str, about: str, *, least: int = 1, required: bool = False) -> Field:
    """Make the field of a number of holes."""
    return Field(name, Kind.INTEGER, about, required, at_least=least, at_most=MOST_HOLES)


def optional(name: str, about: str, *fields: Field, alternatives: Collection[str] = ()) -> Field:
    """Make the field of a feature that is a mapping, of whose `alternatives` exactly one is given."""
    table = FieldTable(fields, alternatives=tuple((word, ()) for word in alternatives))
    return Field(name, Kind.TABLE, about, default="none", table=table)


def check_below(reader: Reader, path: str, value: float | None, bound: float, what: str) -> None:
    """Note a length that was given, mm, and is not below a bound."""
    if value is not None and value >= bound:
        limit = size_words(bound, reader)
        reader.fault_at(path, f"not below {what}", size_words(value, reader), f"give less than {limit}")


def size_words(value: float, reader: Reader) -> str:
    """Write a length of so many mm in the recipe's unit."""
    return f"{value / reader.mm:.6g} {reader.units}"
