"""Records of features of the part, one for each file of `camgeo.part`, and helpers that such files share."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, Generic, NamedTuple, TypeVar

from camgeo.schema.fields import Field, Kind, Table
from kin.numeric.errors import CamgeoError
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Iterable, Mapping, Sequence

    from camgeo.fit.pieces import ArcSpline
    from camgeo.part.body import Body
    from camgeo.part.part import Part
    from camgeo.part.shapes import Opening
    from camgeo.part.walls import Looks, Possible
    from camgeo.schema.reader import Reader, Values
    from kin.judge.check import Check

T = TypeVar("T")
MOST_HOLES = 60
WALL = "wall"  # name of the check on the least wall, and of the figure


class Site(NamedTuple):
    """Part in which a feature seeks its place: the contour, and the openings and the hub that are there.

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


class View(NamedTuple):
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


def _check_nothing(_part: Values, _reader: Reader) -> None:
    pass


@dataclass(frozen=True)
class Feature(Generic[T]):
    """A feature of the part: keys, openings, walls, remarks and callouts; fields that do not apply are left out.

    kind      class of its value, which `Part.of` and `Body.of` give
    field     its key of `part`
    needs     other keys of `part` that it cannot be without, each with the reason
    of_ring   whether a ring may have it, `of_pair` whether conjugate discs may
    holes     whether it cuts holes, `walled` whether there are walls between it and other edges without them
    check     notes the faults between its keys and others of `part`
    make      its value by what was read of it and of all of `part`; without it `kind` takes its keys
    bore      outline of the bore that it shapes, of a radius in mm
    openings  what it cuts where the recipe says
    place     what it cuts where it finds a place, in the order of the features
    walls     walls round it besides those of its openings, of a body with these surfaces
    round     beginning of the names of its round openings, and the field that states their diameter
    grown     its value with metal grown by `out` mm, then scaled
    remark    what a drawing does not show of it, in units of so many mm
    unmilled  why a program for a milling machine leaves it
    callouts  its sizes on a shop drawing, beside a bore's own view
    """

    kind: type[T]
    field: Field
    needs: Sequence[tuple[str, str]] = ()
    of_ring: bool = True
    of_pair: bool = True
    holes: bool = False
    walled: bool = False
    check: Callable[[Values, Reader], None] = _check_nothing
    make: Callable[[Any, Values], T | None] | None = None
    bore: Callable[[T, float], ArcSpline] | None = None
    openings: Callable[[T], Sequence[Opening]] | None = None
    place: Callable[[T, Site], Placed] | None = None
    walls: Callable[[T, Body, Sequence[Looks]], Iterable[Possible]] | None = None
    round: tuple[str, str] | None = None
    grown: Callable[[T, float, float], T] | None = None
    remark: Callable[[T, float], str] | None = None
    unmilled: str = ""
    callouts: Callable[[T, View], Iterable[Callout]] | None = None

    @property
    def name(self) -> str:
        """Key of the feature in `part`, such as `hub`."""
        return self.field.name

    def build(self, part: Values) -> T | None:
        """Make its value of all keys of `part`, in which there is no fault; None where the recipe does not give it."""
        if self.name not in part:
            return None
        if self.make is not None:
            return self.make(part[self.name], part)
        kind: Callable[..., T] = self.kind
        return kind(**part[self.name])


class NothingLeftError(CamgeoError, ValueError):
    """An opening that is no wider than what is taken from it."""


def narrowed(width: float, out: float, scale: float) -> float:
    """Width of an opening, mm, when metal has grown by `out` on either side and is scaled; raises NothingLeftError."""
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
    table = Table(fields, alternatives=tuple((word, ()) for word in alternatives))
    return Field(name, Kind.TABLE, about, default="none", table=table)


def check_below(reader: Reader, path: str, value: float | None, bound: float, what: str) -> None:
    """Note a length that was given, mm, and is not below a bound."""
    if value is not None and value >= bound:
        limit = size_words(bound, reader)
        reader.fault_at(path, f"not below {what}", size_words(value, reader), f"give less than {limit}")


def size_words(value: float, reader: Reader) -> str:
    """Write a length of so many mm in the recipe's unit."""
    return f"{value / reader.mm:.6g} {reader.units}"
