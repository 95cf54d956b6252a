"""Fields and tables of fields, of which the schema of a recipe is made, with their bounds.

The packages above declare the tables. They are data: recipes are read and checked by them, `json_schema` publishes
them, `starter` turns them into comments.
"""

from __future__ import annotations

import re
from enum import Enum
from typing import TYPE_CHECKING, Any, Generic, TypeAlias, TypeVar

from kin.numeric.records import KW_ONLY, dataclass, field

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Iterable, Mapping

    from camgeo.schema.yaml_source import Node

Schema: TypeAlias = dict[str, Any]  # a JSON schema
R = TypeVar("R")  # reader of recipes

MOST = 2e6  # of lengths as written, two kilometres in mm: a bound against slips, far above any cam
_SLIPS = (MOST, MOST**2)
MOST_HARMONIC = 199
MOST_SEGMENTS = 100
MOST_DYADS = 20
MOST_COEFFICIENTS = 20
MOST_COEFFICIENT = 1e6
MOST_FILES = 20


def either(words: Iterable[str], conjunction: str = "or") -> str:
    """Words joined in a sentence: `a, b or c`; `conjunction` stands before the last."""
    words = tuple(words)
    return f" {conjunction} ".join(filter(None, (", ".join(words[:-1]), *words[-1:])))


class Kind(Enum):
    """Kind of a field's value; the enum's value is its noun in messages."""

    TEXT = "a text"
    NAME = "a name"
    CHOICE = "a choice"
    LENGTH = "a length"
    AREA = "an area"
    ANGLE = "an angle"
    NUMBER = "a number"
    INTEGER = "a whole number"
    STROKE = "a stroke"  # a length, or an angle where the follower swings
    ERROR = "a motion error"  # a length, or an angle where the follower swings
    OUTPUT = "a change of the output"  # of a linkage: an angle, or a length where its last link slides
    MOTION = "a motion"  # of the output, or without a linkage of the follower
    BACKLASH = "a backlash"  # an angle of a flat pair, else a length
    FORCE = "a force"
    MOMENT = "a moment"
    RATE = "a spring rate"
    PRESSURE = "a pressure"
    MASS = "a mass"
    THRUST = "a force along the travel"  # a moment where the follower swings, or what a linkage drives
    GIVING = "a stiffness along the travel"  # likewise
    INERTIA = "an inertia along the travel"  # likewise
    TRUTH = "true or false"
    RATIO = "a ratio"
    FORMULA = "a formula"
    POINT = "a point"
    PAIR = "a pair of lengths"
    HARMONICS = "harmonics"
    NUMBERS = "a list of numbers"
    TABLE = "a mapping"
    OWN = "a form of its own"  # that its topic declares


@dataclass(frozen=True, eq=False)
class OwnForm(Generic[R]):
    """Form of a field of `Kind.OWN`, declared by the module that knows it.

    `noun` and `wanted` are for messages. `read`, (reader, field, node, path), gives the value, or None for a faulty
    one, whose fault it notes; `schema` makes the JSON schema. For a mapping whose `kind` chooses its keys, `tables` has
    the table of each kind, and messages name the place of a key by `group` and the kind: `cam of kind support`;
    `elsewhere` are further kinds, which other recipes have.
    """

    noun: str
    wanted: str
    read: Callable[[R, Field, Node, str], Any]
    schema: Callable[[Field], Schema]
    tables: Mapping[str, FieldTable] | None = None
    group: str = ""
    others: str = ""  # remedy for a `kind` that is none of these
    elsewhere: tuple[str, ...] = ()
    instead: FieldTable | None = None  # of a mapping that may stand in place of a list


@dataclass(frozen=True)
class Field:
    """One key of a table. Bounds are in the recipe's own units and degrees, as written.

    `about` describes the value in messages and in the JSON schema. `after` is the core's key behind which the key of a
    capability stands; `unshown` are starters that leave it out; `slips` are words that some write in place of its name.
    """

    name: str
    kind: Kind
    about: str
    required: bool = False
    _: KW_ONLY
    others: str = ""  # remedy for a word that is none of the choices
    default: str = ""  # as documented; the value itself is set where the recipe is built
    above: float | None = None
    at_least: float | None = None
    at_most: float | None = None
    odd: bool = False
    choices: Collection[str] = ()
    variable: str = "t"
    table: FieldTable | None = None  # of a mapping, or of each segment of a motion
    unit: Kind | None = None  # of the coefficients of harmonics, of a list of numbers, or of a form of its own
    form: OwnForm[Any] | None = None  # of a field of Kind.OWN
    most: int = MOST_COEFFICIENTS  # entries of a list of numbers
    after: str = ""
    unshown: Collection[str] = ()
    slips: Collection[str] = ()

    @property
    def noun(self) -> str:
        """Value that the field holds, for messages: `a length`."""
        return self.form.noun if self.form else self.kind.value

    @property
    def entry(self) -> Field:
        """The field of one entry of a list of numbers: coefficients, unless the list has bounds of its own."""
        unit, bounded = self.unit or Kind.NUMBER, self.at_least is not None
        least, most = (self.at_least, self.at_most) if bounded else (-MOST_COEFFICIENT, MOST_COEFFICIENT)
        return Field("", unit, "", at_least=least, at_most=most)

    @property
    def inner(self) -> FieldTable:
        """Table of a field that has one; raises AssertionError for a field without a table."""
        if self.table is None:
            raise AssertionError(self.name)
        return self.table

    def wanted(self) -> str:
        """Values that the field takes, in words: `an odd whole number from 3 to 99`."""
        if self.form is not None:
            return self.form.wanted
        match self.kind:
            case Kind.CHOICE:
                return either(self.choices)
            case Kind.RATIO:
                return "a fraction lambda/mu above 1 in lowest terms with mu odd, such as 4/3, or a whole number"
            case Kind.FORMULA:
                return f"a formula in {self.variable}"
            case Kind.POINT:
                return "a list of two lengths [x, y]"
            case Kind.PAIR:
                return "a list of two lengths above 0 [a, b]"
            case Kind.HARMONICS:
                return f"a mapping from {'odd ' if self.odd else ''}harmonics to coefficients, such as {{3: 0.5}}"
            case Kind.TABLE:
                return f"a mapping with {either(self.table.keys if self.table else (), 'and')}"
            case _:
                noun = self.kind.value.replace("a whole", "an odd whole") if self.odd else self.kind.value
                return f"{noun}{self._bounds()}"

    def out_of_bounds(self, value: float) -> str:
        """Bound that a number breaks, in words: `above 99`, `an even number` where odd ones are taken; else empty."""
        if self.above is not None and value <= self.above:
            return f"not above {self.above:.10g}"
        if self.at_least is not None and value < self.at_least:
            return f"below {self.at_least:.10g}"
        if self.at_most is not None and value > self.at_most:
            return f"above {self.at_most:.10g}"
        return "an even number" if self.odd and value % 2 == 0 else ""

    def _bounds(self) -> str:
        """Bounds in words, without those that only guard against slips."""
        if self.at_least is not None and self.at_most is not None:
            if self.at_most not in _SLIPS:
                return f" from {self.at_least:.10g} to {self.at_most:.10g}"
            return "" if self.at_least == -self.at_most else f" of at least {self.at_least:.10g}"
        low = f" above {self.above:.10g}" if self.above is not None else ""
        high = f" up to {self.at_most:.10g}" if self.at_most not in (None, *_SLIPS) else ""
        return low + high


@dataclass(frozen=True)
class FieldTable:
    """Fields of a mapping.

    A recipe gives exactly one of the `alternatives`, or none where they are `optional`; each is a key with the keys
    that must come with it.
    """

    fields: tuple[Field, ...]
    alternatives: tuple[tuple[str, tuple[str, ...]], ...] = ()
    optional: bool = field(default=False, kw_only=True)

    @property
    def keys(self) -> tuple[str, ...]:
        """Names of the fields."""
        return tuple(item.name for item in self.fields)

    def field(self, name: str) -> Field:
        """Field of a key; raises StopIteration for a key that the table does not have."""
        return next(item for item in self.fields if item.name == name)


def length(name: str, about: str, *, required: bool = False, default: str = "") -> Field:
    """Field of a length above 0, in the recipe's unit."""
    return Field(name, Kind.LENGTH, about, required, default=default, above=0, at_most=MOST)


def coordinate(name: str, about: str, *, required: bool = False, default: str = "") -> Field:
    """Field of a length that may be 0 or negative, in the recipe's unit."""
    return Field(name, Kind.LENGTH, about, required, default=default, at_least=-MOST, at_most=MOST)


def mapping(name: str, about: str, *fields: Field) -> Field:
    """Field of a mapping with these fields."""
    return Field(name, Kind.TABLE, about, table=FieldTable(fields))


def field_at(root: FieldTable, path: str, kinds: Mapping[str, str]) -> Field | None:
    """Field at a path such as `cam.shaft[0]`, the same for every entry of a list; None where the schema has none.

    `kinds` has the kind of each mapping with kinds, by its key; a mapping it does not name may be of any kind. An entry
    of points, numbers and harmonics has the field of the whole.
    """
    table: FieldTable | None = root
    field: Field | None = None
    for part in path.split("."):
        name, bracket, index = part.partition("[")
        if re.fullmatch(r"([0-9]+\]\[)*[0-9]+\]", index) is None and bracket:
            return None
        if field is not None and field.kind is Kind.HARMONICS:
            return field if name.isdecimal() else None
        if table is None or name not in table.keys:
            return None
        field = table.field(name)
        tables = field.form.tables if field.form else None
        instead = field.form.instead if field.form else None
        if tables is None:
            # of a list in whose place a mapping may stand: the fields of an entry of the list, and those of the mapping
            of_entry = field.table.fields if field.table else ()
            table = FieldTable((*of_entry, *instead.fields)) if instead else field.table
        elif field.name in kinds:
            table = tables.get(kinds[field.name])
        else:
            table = FieldTable(tuple(item for kind_table in tables.values() for item in kind_table.fields))
    return field


def place_of_key(root: FieldTable, name: str, table: FieldTable) -> str:
    """Remedy for a key `name` that `table` lacks: its place, `it belongs under part`, or else the keys here."""
    below = tuple(item.name for item in table.fields if item.table and name in item.table.keys)
    if below and table is not root:
        return f"it belongs under {either(below)}"
    if name in root.keys:
        return "it belongs at the top level"
    plain = tuple(item.name for item in root.fields if item.table and name in item.table.keys)
    places = [either(plain)] if plain else []
    of_group: dict[str, list[str]] = {}
    for group, kind, kind_table in _grouped(root):
        if name in kind_table.keys:
            of_group.setdefault(group, []).append(kind)
    places += [f"{group} {either(tuple(kinds))}" for group, kinds in of_group.items()]
    if places:
        return f"it belongs under {', or under '.join(places)}"
    return f"the keys here are {either(table.keys, 'and')}" if table.keys else "there are no keys here"


def belongs_to_other_kind(root: FieldTable, path: str) -> bool:
    """Whether a key that the kind of its mapping lacks belongs to another kind: `cam.swing` of a disc cam."""
    parent, _, name = path.rpartition(".")
    return any(group.split()[0] == parent and name in table.keys for group, _, table in _grouped(root))


def _grouped(table: FieldTable) -> list[tuple[str, str, FieldTable]]:
    """Group, kind and table of every table that a kind chooses: files before cams, linkages and their dyads."""
    forms: dict[str, OwnForm[Any]] = {}

    def walk(within: FieldTable) -> None:
        for item in within.fields:
            if item.form and item.form.group and item.form.tables:
                forms.setdefault(item.form.group, item.form)
            below = (*(item.form.tables.values() if item.form and item.form.tables else ()), item.table)
            for inner in below:
                if inner is not None:
                    walk(inner)

    walk(table)
    order = sorted(forms, key=lambda group: (group != "the file", list(forms).index(group)))
    return [(group, kind, kind_table) for group in order for kind, kind_table in (forms[group].tables or {}).items()]
