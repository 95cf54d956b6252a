"""The part round the contour: its disc, its bore, and the features that a recipe gives it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, TypeVar

from camgeo.common.rounding import NOISE, upward
from camgeo.part import bore
from camgeo.part.features import FEATURES, boss_of, built, edge_of, with_records
from camgeo.schema.fields import Field, Kind, length, mapping
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from camgeo.part.feature import Boss
    from camgeo.part.shapes import Opening
    from camgeo.schema.reader import Reader, Values

T = TypeVar("T")
DENSEST = 30_000  # kg/m^3; osmium has 22 590
THINNEST = 1e-6  # mm: of a body; the kernel of STEP takes points within 1e-7 mm as one
_NO_SIZES = frozenset({"wall", "least"})  # what has to be left, which may be as little as one likes


@dataclass(frozen=True)
class Part:
    """The part round the contour; lengths in mm.

    `thickness` is the disc's along the shaft. `bore` is a diameter, or the width across flats where `sides` (4 or
    6) are given; `bore_at`, rad, is then the direction of one flat's normal. `fit` is the tolerance class of a round
    bore, empty where none is stated; files have the nominal size. `wall` is the least wall permitted between any two
    edges; without it the least wall is reported and must be above 0. `outer` is the diameter of the round outline of a
    ring, whose opening is the cam, or of the blank of a groove. `density` is in kg/m^3. `features` are the values of
    those in FEATURES that the recipe gives.
    """

    thickness: float | None = None
    bore: float | None = None
    sides: int = 0
    bore_at: float = 0.0
    fit: str = ""
    wall: float | None = None
    outer: float | None = None
    density: float | None = None
    features: tuple[object, ...] = ()

    def of(self, kind: type[T]) -> T | None:
        """Value of the feature of this class; None where the part does not have it."""
        return next((value for value in self.features if isinstance(value, kind)), None)

    @property
    def boss(self) -> Boss | None:
        """Boss about the shaft; None without one."""
        return boss_of(self.features)

    @property
    def edge(self) -> float:
        """Chamfer along both edges of the contour, mm; 0 without one."""
        return edge_of(self.features)

    def with_sharp_edges(self) -> Part:
        """The part without features that chamfer the edges of its contour."""
        kept = tuple(value for feature, value in with_records(self.features) if feature.edge is None)
        return replace(self, features=kept)

    @property
    def plain(self) -> bool:
        """Whether the part has no features, no outline of its own, and no bore or a round one."""
        return not self.sides and self.outer is None and not self.features

    @property
    def round_bore(self) -> bool:
        """Whether the part has a bore and it is a plain circle: no keyway, flat or polygon."""
        shaped = any(feature.bore is not None for feature, _ in with_records(self.features))
        return self.bore is not None and not self.sides and not shaped

    @property
    def holed(self) -> bool:
        """Whether the part has holes besides its bore."""
        return any(feature.holes for feature, _ in with_records(self.features))

    @property
    def walled(self) -> bool:
        """Whether the part has an edge besides the contour, and so walls: a bore, a rim, or a feature with an edge."""
        edges = any(feature.holes or feature.walled for feature, _ in with_records(self.features))
        return self.bore is not None or self.outer is not None or edges

    @property
    def openings(self) -> list[Opening]:
        """Openings at places that the recipe states, without the bore and without those that have to find a place."""
        features = with_records(self.features)
        return [each for feature, value in features if feature.openings is not None for each in feature.openings(value)]


DENSITY = Field(
    "density",
    Kind.NUMBER,
    "density of the material, kg/m³, for mass, inertia and unbalance",
    default="none",
    above=0,
    at_most=DENSEST,
)
PART = mapping(
    "part",
    "the part round the contour",
    length("thickness", "thickness of the disc along the shaft; solids need it"),
    bore.FIELD,
    *(feature.field for feature in FEATURES),
    length(
        "outer", "diameter of the outline of a ring, with `track: internal`, or of a groove's blank", default="none"
    ),
    length("wall", "least wall between any two edges", default="reported, and above 0"),
    DENSITY,
)


def check_part(part: Values, reader: Reader) -> None:
    """Note the faults between the fields of `part` that were read, in the reader."""
    _check_needs(reader, "density", "thickness", "the mass is that of a solid")
    bore.check_bore(part, reader, [each.name for each in FEATURES if each.bore is not None and each.name in part])
    for feature in FEATURES:
        for key, why in feature.needs:
            _check_needs(reader, feature.name, key, why)
        if feature.name in part:
            feature.check(part, reader)
    _check_sizes(part, reader)


def _check_needs(reader: Reader, name: str, other: str, why: str) -> None:
    if f"part.{name}" in reader.marks and f"part.{other}" not in reader.marks:
        reader.fault_at(f"part.{name}", f"needs part.{other}: {why}", None, f"give part.{other}, or leave it out")


def _check_sizes(part: Values, reader: Reader) -> None:
    """Note lengths of `part` below the least size that a file can hold, but for walls that have to be left."""
    for path, field in reader.numbers.items():
        top, *names = path.split(".")
        if top != "part" or field.kind is not Kind.LENGTH or field.above is None or names[-1] in _NO_SIZES:
            continue
        value: Any = part
        for name in names:
            value = value.get(name, {})
        least = THINNEST if path == "part.thickness" else bore.LEAST_SIZE
        if isinstance(value, float) and value < least * (1.0 - NOISE):
            remedy = f"give at least {upward(least / reader.mm)} {reader.units}"
            reader.fault_at(path, "smaller than a file can hold", f"{value / reader.mm:g}", remedy)


def build_part(values: Values) -> Part:
    """Build the part from values of `part` in which no fault was noted."""
    own = {name: values[name] for name in ("thickness", "wall", "outer", "density") if name in values}
    return Part(features=built(values), **bore.build_bore(values), **own)
