"""What a schema of a recipe is made of: fields and tables of fields, with their bounds.

The tables themselves are in `tables` and the modules below it. They are data: recipes are read and checked by them,
`schema` turns them into a JSON schema, `starter` into comments. A key that a coming version will know stands under
`later` of its table: moving it into `fields` is what makes it known.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

MOST = 2e6  # of lengths as written, two kilometres in mm: a bound against slips, far above any cam
_SLIPS = (MOST, MOST**2)
MOST_HARMONIC = 199
MOST_LAMBDA = 200
MOST_SEGMENTS = 100
MOST_DYADS = 20
MOST_COEFFICIENTS = 20
MOST_COEFFICIENT = 1e6
MOST_FILES = 20
MOST_TEXT = 1000  # characters
MOST_AXES = 20  # of a sweep
MOST_VALUES = 1000  # listed for one axis
MOST_STEPS = 1_000_000  # of one axis
MOST_DESIGNS = 100_000_000  # of a sweep


def either(words: tuple[str, ...], conjunction: str = "or") -> str:
    """Join words: `a, b or c`."""
    return f" {conjunction} ".join(filter(None, (", ".join(words[:-1]), *words[-1:])))


class Kind(Enum):
    """What a field holds; the value is the noun that messages use."""

    TEXT = "a text"
    NAME = "a name"
    CHOICE = "a choice"
    LENGTH = "a length"
    AREA = "an area"
    ANGLE = "an angle"
    NUMBER = "a number"
    INTEGER = "a whole number"
    ERROR = "a motion error"  # a length, or an angle where the follower swings
    OUTPUT = "a change of the output"  # of a linkage: an angle, or a length where its last link slides
    MOTION = "a motion"  # of the output, or without a linkage of the follower
    PLAY = "a backlash"  # an angle of a flat pair, else a length
    TRUTH = "true or false"
    RATIO = "a ratio"
    FORMULA = "a formula"
    POINT = "a point"
    PAIR = "a pair of lengths"
    HARMONICS = "harmonics"
    LAW = "a motion law"
    NUMBERS = "a list of numbers"
    TABLE = "a mapping"
    SEGMENTS = "a list of motion segments"
    FILES = "a list of files"
    CAM = "a cam"
    LINKAGE = "a linkage"
    DYADS = "a list of dyads"
    DYAD = "a dyad"
    VARY = "what varies"
    AXIS = "a range"
    LIMITS = "limits"
    BORE = "a bore"
    KEYWAY = "a keyway"


@dataclass(frozen=True)
class Field:
    """One key of a table. Bounds are in the recipe's own units and degrees, as written."""

    name: str
    kind: Kind
    about: str
    required: bool = False
    others: str = ""  # said of a word that is none of the choices
    default: str = ""  # as documented; `load` knows the value
    above: float | None = None
    at_least: float | None = None
    at_most: float | None = None
    odd: bool = False
    choices: tuple[str, ...] = ()
    variable: str = "t"
    table: Table | None = None  # of a mapping, or of each segment of a motion
    unit: Kind | None = None  # of the coefficients of harmonics

    def wanted(self) -> str:
        """Say what would do: `an odd whole number from 3 to 99`."""
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
            case Kind.CAM:
                return "a mapping with the kind of cam and its fields"
            case Kind.LINKAGE:
                return "a mapping with the kind of linkage and its fields"
            case Kind.DYADS:
                return "a list of dyads such as [{kind: rrr, point: [80, 0], ground: [140, 80], links: [100, 30]}]"
            case Kind.DYAD:
                return "a mapping with the kind of dyad and its fields"
            case Kind.AXIS:
                return "a range such as {from: 95, to: 110, steps: 16}, or a list of values"
            case Kind.VARY:
                return "a mapping from paths to ranges, such as {linkage.rocker: {from: 95, to: 110, steps: 16}}"
            case Kind.BORE:
                return "a diameter above 0, or a form such as {square: 10} or {hexagon: 10}"
            case Kind.KEYWAY:
                return "din6885, or a mapping such as {width: 4, depth: 1.8}"
            case Kind.LIMITS:
                return "a mapping from figures to bounds, such as {transmission-angle: {at_least: 40}}"
            case Kind.SEGMENTS:
                return "a list of segments such as [{rise: 20, over: 120, law: modified-sine}, {dwell: 60}]"
            case Kind.FILES:
                return "a list of files such as [dxf, stl]"
            case Kind.TABLE:
                return f"a mapping with {either(self.table.keys if self.table else (), 'and')}"
            case _:
                noun = self.kind.value.replace("a whole", "an odd whole") if self.odd else self.kind.value
                return f"{noun}{self._bounds()}"

    def out_of_bounds(self, value: float) -> str:
        """Say which bound a number breaks, or nothing."""
        if self.above is not None and value <= self.above:
            return f"not above {self.above:.10g}"
        if self.at_least is not None and value < self.at_least:
            return f"below {self.at_least:.10g}"
        if self.at_most is not None and value > self.at_most:
            return f"above {self.at_most:.10g}"
        return "an even number" if self.odd and value % 2 == 0 else ""

    def _bounds(self) -> str:
        """Say the bounds, but not those against slips alone."""
        if self.at_least is not None and self.at_most is not None:
            if self.at_most not in _SLIPS:
                return f" from {self.at_least:.10g} to {self.at_most:.10g}"
            return "" if self.at_least == -self.at_most else f" of at least {self.at_least:.10g}"
        low = f" above {self.above:.10g}" if self.above is not None else ""
        high = f" up to {self.at_most:.10g}" if self.at_most not in (None, *_SLIPS) else ""
        return low + high


@dataclass(frozen=True)
class Table:
    """The keys of a mapping.

    Of `alternatives` exactly one is given; each names the keys that must come with it. `later` are keys that this
    version recognises and refuses.
    """

    fields: tuple[Field, ...]
    alternatives: tuple[tuple[str, tuple[str, ...]], ...] = ()
    later: tuple[str, ...] = ()

    @property
    def keys(self) -> tuple[str, ...]:
        """The keys."""
        return tuple(item.name for item in self.fields)

    def field(self, name: str) -> Field:
        """Find a field by its key, which must be one of the table's."""
        return next(item for item in self.fields if item.name == name)


def length(name: str, about: str, *, required: bool = False, default: str = "") -> Field:
    """Make the field of a length above 0, in the recipe's unit."""
    return Field(name, Kind.LENGTH, about, required, default, above=0, at_most=MOST)


def coordinate(name: str, about: str, *, required: bool = False, default: str = "") -> Field:
    """Make the field of a length that may be 0 or negative."""
    return Field(name, Kind.LENGTH, about, required, default, at_least=-MOST, at_most=MOST)


def mapping(name: str, about: str, *fields: Field, later: tuple[str, ...] = ()) -> Field:
    """Make the field of a mapping with these fields."""
    return Field(name, Kind.TABLE, about, table=Table(fields, later=later))
