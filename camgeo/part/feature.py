"""Records of features of the part, one for each file of `camgeo.part`, and helpers that such files share."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Generic, Literal, NamedTuple, TypeAlias, TypeVar

from camgeo.registry.slot import NO_CHECK
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
    from camgeo.schema.reader import Reader, Values
    from kin.numeric.check import Check
    from kin.read.layers import CrossHole

T = TypeVar("T")
Circle: TypeAlias = tuple[tuple[float, float], float]  # centre and radius, mm
MOST_HOLES = 60
WALL = "wall"  # name of the check on the least wall, and of the figure


class Site(NamedTuple):
    """Part in which a feature is placed: the contour, and the outlines of openings and boss that are there.

    `wall` is the recipe's least wall, mm, None where it states none; `edge`, mm, is what a chamfer takes off the
    contour.
    """

    looks: Looks
    openings: Sequence[Opening]
    wall: float | None
    edge: float


class Placed(NamedTuple):
    """Openings for which a place was found, and a check of that; the check is None where it could only hold."""

    openings: Sequence[Opening]
    check: Check | None = None


class Boss(NamedTuple):
    """Round body about the shaft that stands on the disc; lengths in mm.

    `name` is the name of its edge, and of the check of files. `above` and `below` are its heights beyond the upper and
    the lower face of the disc, 0 on a face without it.
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

    def holds(self, opening: Opening) -> bool:
        """Whether an opening goes through disc and boss, as its middle lies within the boss."""
        x, y = opening.middle
        return opening.depth is None and x * x + y * y < 0.25 * self.diameter * self.diameter


class Refusal(NamedTuple):
    """Problem of a feature in a part where it cannot be made, and the remedy.

    `unless` is true of keys of the feature with which it can be made all the same.
    """

    problem: str
    remedy: str
    unless: Callable[[Values], bool] | None = None


class FeatureCheck(NamedTuple):
    """Check of a feature: its name in reports, its unit, and what is checked.

    `exact` is whether the exact cam is checked; `files` whether no file is, solids are, or all files with a contour but
    programs. With `strict` a figure equal to its limit fails. `remedy` gives, from the check as plain JSON, a
    sentence on a change that lets it hold.
    """

    name: str
    unit: str = "mm"
    exact: bool = False
    files: Literal["none", "solids", "all"] = "solids"
    strict: bool = False
    remedy: Callable[[dict[str, Any]], str] | None = None


class Callout(NamedTuple):
    """A size of a feature on a shop drawing: a text with a leader, and the lines of a note below it.

    The leader ends on any of the `circles`, pairs of a centre and a radius, mm, or at any of the `points`, mm. `value`
    is the diameter of the circles, mm, where the text is a dimension; None for other texts.
    """

    text: str
    notes: tuple[str, ...]
    circles: tuple[Circle, ...] = ()
    points: tuple[tuple[float, float], ...] = ()
    value: float | None = None


class SheetView(NamedTuple):
    """A part as a shop drawing shows it, perhaps mirrored.

    `part` is as in the recipe, `openings` are as drawn, by name. `number` gives the text of a size in mm, `degrees` the
    text of a direction of the recipe, rad; `direction` gives that direction in the drawing, rad.
    """

    part: Part
    openings: Mapping[str, Opening]
    number: Callable[[float], str]
    degrees: Callable[[float], str]
    direction: Callable[[float], float]

    def circle(self, name: str, diameter: float) -> Callout:
        """Callout of a circle about the shaft of a diameter, mm."""
        return Callout(f"Ø{self.number(diameter)}", (name,), (((0.0, 0.0), 0.5 * diameter),), value=diameter)

    def holes(self, circles: Sequence[Circle], *notes: str) -> Callout:
        """Callout of equal holes: their number and diameter stand once."""
        count, diameter = len(circles), 2.0 * circles[0][1]
        text = f"{f'{count} × ' if count > 1 else ''}Ø{self.number(diameter)}"
        return Callout(text, notes, tuple(circles), value=diameter)

    def edge(self, name: str) -> tuple[tuple[float, float], ...]:
        """Middles (x, y), mm, of the straight pieces of an opening's outline."""
        outline = self.openings[name].outline
        starts, chords = outline.points, outline.chords
        return tuple((x, y) for x, y in (starts + 0.5 * chords)[outline.bulges == 0.0].tolist())

    def named(self, word: str) -> list[Circle]:
        """Centre (x, y) and radius, mm, of each round opening whose name begins with a word."""
        return [
            opening.circle
            for name, opening in self.openings.items()
            if name.startswith(word) and opening.circle is not None
        ]


@dataclass(frozen=True)
class Feature(Generic[T]):
    """A feature of the part: all that the core needs of it; fields that do not apply are left out.

    Solids are made, and files judged, by openings, a boss, chamfered edges and cross holes alone. In the functions T is
    the value of the feature in a part.

    kind      class of its value, which `Part.of` gives
    field     its key of `part`
    needs     other keys of `part` that it cannot be without, each with the reason
    of_ring   whether a ring may have it, `of_pair` whether conjugate discs may
    grooved   why a disc with a groove cannot have it
    locates   whether it fixes the angle of the part on its shaft
    holes     whether it cuts holes, `walled` whether there are walls between it and other edges without them
    check     notes the faults between its keys and others of `part`
    make      its value: (what was read under its key, values of `part`); without it `kind` is called with its keys
    bore      outline of the bore that it shapes: (value, radius of the round bore, mm)
    openings  what it cuts at places that the recipe states
    place     what it cuts at places that it has to find, in the order of the features
    boss      boss that it makes
    edge      chamfer of 45 degrees that it gives both edges of the contour, mm
    cross     radial hole that it drills through a boss of a disc of this thickness, mm
    walls     walls round it besides those of its openings: (value, body, surfaces)
    contour   check of a contour of the part; the last argument gives the shaft angle, degrees, of its parameter
    judged    check by which reports name it
    round     beginning of the names of its round openings, and the field that states their diameter
    grown     its value with all metal enlarged: (value, mm to every side, scale of the result)
    mirrored  its value in a part mirrored about the x axis
    steadies  words for a change of it that draws the centre of mass to the shaft
    metric    words for its metric standard size and for what to give instead where the bore is in inches; empty for a
              size that follows no metric standard
    remark    words for what a drawing does not show of it: (value, mm in the unit of lengths)
    unmilled  why a milling program does not make it
    callouts  its sizes on a shop drawing, beside those of the bore
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
    make: Callable[[Any, Values], T] | None = None
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
        """Value of the feature by the keys of `part`, which are without fault; None where `part` does not have it."""
        if self.name not in part:
            return None
        if self.make is not None:
            return self.make(part[self.name], part)
        kind: Callable[..., T] = self.kind
        return kind(**part[self.name])


class NothingLeftError(CamgeoError, ValueError):
    """An opening is no wider than what an enlargement of the metal takes from it."""


def narrowed(width: float, out: float, scale: float) -> float:
    """Width of an opening, mm, once the metal is enlarged by `out`, mm, on either side and then scaled.

    Raises NothingLeftError where that closes the opening.
    """
    remaining = width - 2.0 * out
    if not remaining > 0.0:
        raise NothingLeftError(f"it is {width:.6g} mm across")
    return scale * remaining


def angle(name: str, about: str) -> Field:
    """Field of a direction, from -360 to 360 degrees in the recipe; its value is in rad."""
    return Field(name, Kind.ANGLE, about, default="0", at_least=-360, at_most=360)


def count(name: str, about: str, *, least: int = 1, required: bool = False) -> Field:
    """Field of a number of holes, from `least` to `MOST_HOLES`."""
    return Field(name, Kind.INTEGER, about, required, at_least=least, at_most=MOST_HOLES)


def optional(name: str, about: str, *fields: Field, alternatives: Collection[str] = ()) -> Field:
    """Field of a feature that is a mapping of `fields`; of the keys `alternatives` exactly one has to be given."""
    table = FieldTable(fields, alternatives=tuple((word, ()) for word in alternatives))
    return Field(name, Kind.TABLE, about, default="none", table=table)


def check_below(reader: Reader, path: str, value: float | None, bound: float, what: str) -> None:
    """Note a fault at `path` where a length, mm, is given and not below a bound, mm; `what` names the bound."""
    if value is not None and value >= bound:
        limit = size_words(bound, reader)
        reader.fault_at(path, f"not below {what}", size_words(value, reader), f"give less than {limit}")


def size_words(value: float, reader: Reader) -> str:
    """Text of a length, given in mm, in the recipe's unit."""
    return f"{value / reader.mm:.6g} {reader.units}"
