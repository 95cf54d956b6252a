"""The schema of a recipe as data: one table that is read, checked, published and explained from.

`load` reads and checks by it, `schema` turns it into a JSON schema, `starter` into comments. A key that a coming
version will know stands under `later` of its table: moving it into `fields` is what makes it known.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from enum import Enum

MOST = 1e5  # of lengths as written: a bound against slips, far above any cam
_SLIPS = (MOST, MOST**2)
MOST_HARMONIC = 199
MOST_LAMBDA = 200
MOST_SEGMENTS = 100
MOST_COEFFICIENTS = 20
MOST_COEFFICIENT = 1e6
MOST_FILES = 20
MOST_TEXT = 1000  # characters


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
    RATIO = "a ratio"
    FORMULA = "a formula"
    POINT = "a point"
    HARMONICS = "harmonics"
    LAW = "a motion law"
    NUMBERS = "a list of numbers"
    TABLE = "a mapping"
    SEGMENTS = "a list of motion segments"
    FILES = "a list of files"
    CAM = "a cam"


@dataclass(frozen=True)
class Field:
    """One key of a table. Bounds are in the recipe's own units and degrees, as written."""

    name: str
    kind: Kind
    about: str
    required: bool = False
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
            case Kind.HARMONICS:
                return f"a mapping from {'odd ' if self.odd else ''}harmonics to coefficients, such as {{3: 0.5}}"
            case Kind.CAM:
                return "a mapping with the kind of cam and its fields"
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
            return f" from {self.at_least:.10g} to {self.at_most:.10g}" if self.at_most not in _SLIPS else ""
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
        """Find a field by its key, which must be one."""
        return next(item for item in self.fields if item.name == name)


def _length(name: str, about: str, *, required: bool = False, default: str = "") -> Field:
    return Field(name, Kind.LENGTH, about, required, default, above=0, at_most=MOST)


def _odd(name: str, about: str) -> Field:
    return Field(name, Kind.INTEGER, about, required=True, at_least=3, at_most=99, odd=True)


POLYNOMIAL = Table(
    (Field("polynomial", Kind.NUMBERS, "coefficients c0, c1, ... of u, from 0 to 1 as u does", required=True),)
)


def _motion(name: str, stroke: Kind, about: str) -> Field:
    """Make the field of a motion programme whose strokes are lengths or angles."""
    strokes = [
        Field(key, stroke, f"stroke of the {key}", above=0, at_most=MOST if stroke is Kind.LENGTH else 180)
        for key in ("rise", "return")
    ]
    angle = Field("over", Kind.ANGLE, "shaft angle of the segment", above=0, at_most=180)
    segment = Table(
        (
            *strokes,
            replace(angle, name="dwell", about="shaft angle of a rest"),
            angle,
            Field("law", Kind.LAW, "motion law by name, or {polynomial: [c0, c1, ...]}", table=POLYNOMIAL),
        ),
        alternatives=(("rise", ("over", "law")), ("return", ("over", "law")), ("dwell", ())),
        later=("displacement", "table"),
    )
    return Field(name, Kind.SEGMENTS, about, table=segment)


def _table(name: str, about: str, *fields: Field, later: tuple[str, ...] = ()) -> Field:
    return Field(name, Kind.TABLE, about, table=Table(fields, later=later))


_UNDERCUT = Field(
    "undercut",
    Kind.CHOICE,
    "what to do about undercut (trim reports the motion that is lost)",
    default="refuse",
    choices=("refuse", "trim"),
)

_FOURIER = _table(
    "fourier",
    "support function as a Fourier series",
    _length("mean", "mean of the support function", required=True),
    Field("cos", Kind.HARMONICS, "coefficients of cos(k t)", default="none", unit=Kind.LENGTH),
    Field("sin", Kind.HARMONICS, "coefficients of sin(k t)", default="none", unit=Kind.LENGTH),
)
_REULEAUX = _table(
    "reuleaux",
    "a regular Reuleaux polygon with rounded corners",
    _odd("sides", "number of sides"),
    _length("breadth", "constant breadth", required=True),
    _length("rounding", "radius of the corners, below half the breadth", required=True),
)
_HYPOCYCLOID = _table(
    "hypocycloid",
    "the parallel curve of a hypocycloid, p = breadth/2 + size*cos(cusps*t)",
    _odd("cusps", "number of cusps"),
    _length("size", "radius of the circle inscribed in the hypocycloid", required=True),
    _length("breadth", "constant breadth", required=True),
)

SUPPORT = Table(
    (
        Field("p", Kind.FORMULA, "support function p(t), t in radians, its value a length"),
        _FOURIER,
        _REULEAUX,
        _HYPOCYCLOID,
        Field("pivot", Kind.POINT, "the shaft [x, y] in the axes in which p is written", default="[0, 0]"),
        _UNDERCUT,
    ),
    alternatives=(("p", ()), ("fourier", ()), ("reuleaux", ()), ("hypocycloid", ())),
)

CONSTANT_BREADTH = Table(
    (
        _length("base_radius", "radius of the base circle", required=True),
        replace(
            _motion("motion", Kind.LENGTH, "motion over one half turn, 180 degrees; the other half follows from it"),
            required=True,
        ),
        _UNDERCUT,
    ),
)

_DELTA = _table(
    "delta",
    "D(t), the sum of cos[j]*cos(j*lambda*t) + sin[j]*sin(j*lambda*t), j odd",
    Field("cos", Kind.HARMONICS, "coefficients of the cosines", default="none", unit=Kind.AREA, odd=True),
    Field("sin", Kind.HARMONICS, "coefficients of the sines", default="none", unit=Kind.AREA, odd=True),
)
_ARC = _table(
    "arc",
    "first arc of the pitch curve, symmetric about its bisector",
    _length("radius", "radius of the arc", required=True),
    Field("side", Kind.CHOICE, "how the arc bulges", default="convex", choices=("convex", "concave")),
)
_ROSETTE = _table(
    "rosette",
    "one leaf of the path of the third arm's tip",
    Field(
        "leaf",
        Kind.FORMULA,
        "distance of the tip from the shaft, x from 0 to 1 over the leaf, its value a length",
        required=True,
        variable="x",
    ),
)


def _swinging(law: str, roller: tuple[Field, ...]) -> Table:
    """Make the table of a double roller or a flat pair, which differ in the roller and in what swings."""
    routes = (_DELTA, _motion("law", Kind.ANGLE, law), _ARC, _ROSETTE)
    return Table(
        (
            Field("ratio", Kind.RATIO, "pi/alpha = lambda/mu in lowest terms, mu odd", required=True),
            _length("arm", "arm length, the distance l of the closing equation", required=True),
            *roller,
            *routes,
            _UNDERCUT,
        ),
        alternatives=tuple((route.name, ()) for route in routes),
    )


DOUBLE_ROLLER = _swinging(
    "swing psi of the follower, over 180/lambda degrees of shaft angle from psi = 0",
    (_length("roller_radius", "radius of both rollers", required=True),),
)
FLAT_PAIR = _swinging("swing of the pair, psi/2, over 180/lambda degrees of shaft angle from 0", ())

CAMS: dict[str, Table] = {
    "support": SUPPORT,
    "constant-breadth": CONSTANT_BREADTH,
    "double-roller": DOUBLE_ROLLER,
    "flat-pair": FLAT_PAIR,
}
SWINGING = ("double-roller", "flat-pair")  # their motion errors are angles

_TOLERANCE = _length("tolerance", "greatest distance between this file's contour and the exact one", default="export's")
FILES: dict[str, Table] = {
    "dxf": Table(
        (
            Field(
                "as",
                Kind.CHOICE,
                "what the contour is made of",
                default="arcs",
                choices=("arcs", "polyline", "spline"),
            ),
            Field(
                "version",
                Kind.CHOICE,
                "version of the format; R12 has no splines",
                default="R2010",
                choices=("R12", "R2000", "R2010", "R2013"),
            ),
            _TOLERANCE,
        ),
    ),
    "stl": Table((_TOLERANCE,)),
    "csv": Table(()),
}
LATER_FILES = ("3mf", "step", "svg")

RECIPE = Table(
    (
        Field("name", Kind.NAME, "name of the output folder and of the files in it", default="the file's stem"),
        Field("about", Kind.TEXT, "a note that travels into the files", default="none"),
        Field("units", Kind.CHOICE, "unit of every length", default="mm", choices=("mm", "inch")),
        Field(
            "rotation",
            Kind.CHOICE,
            "sense in which the shaft turns, seen as drawn",
            default="cw",
            choices=("cw", "ccw"),
        ),
        Field("cam", Kind.CAM, "the cam, of exactly one kind", required=True),
        _table(
            "part",
            "the plain part",
            _length("thickness", "thickness along the shaft; STL needs it"),
            _length("bore", "diameter of the bore around the shaft", default="none"),
            later=("keyway", "holes", "hub", "follower"),
        ),
        _table(
            "export",
            "the files",
            _length("tolerance", "greatest distance between a file's contour and the exact one", default="0.001 mm"),
            Field("files", Kind.FILES, "dxf, stl, csv, or mappings such as {dxf: {as: spline}}", default="[dxf]"),
        ),
        _table(
            "verify",
            "how each file is judged",
            Field(
                "angles",
                Kind.INTEGER,
                "number of shaft angles at which each file is judged",
                default="3600",
                at_least=8,
                at_most=1_000_000,
            ),
            Field(
                "motion_error",
                Kind.ERROR,
                "greatest motion error permitted: a length, or degrees where the follower swings",
                default="what the tolerance implies",
                above=0,
                at_most=MOST,
            ),
        ),
    ),
    later=("linkage", "dwell", "sweep", "dynamics"),
)


def elsewhere(name: str, known: tuple[str, ...]) -> str:
    """Say where a key belongs that stands in the wrong place, or else which keys there are."""
    if name in RECIPE.keys:
        return "it belongs at the top level"
    places = [item.name for item in RECIPE.fields if item.table and name in item.table.keys]
    places += [f"the file {kind}" for kind, table in FILES.items() if name in table.keys]
    places += [f"cam of kind {kind}" for kind, table in CAMS.items() if name in table.keys]
    if places:
        return f"it belongs under {either(tuple(places))}"
    return f"the keys here are {either(known, 'and')}" if known else "there are no keys here"
