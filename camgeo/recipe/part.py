"""The part round the contour: bore, keyway, hub, holes and marks."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, Literal

from camgeo.common.rounding import NOISE, upward
from camgeo.recipe.din6885 import LEAST, key_for
from camgeo.recipe.din6885 import MOST as WIDEST
from camgeo.schema.errors import quote
from camgeo.schema.fields import Field, Form, Kind, Table, length, mapping
from camgeo.schema.json_schema import number_schema, table_schema
from camgeo.schema.read_scalar import read_numeric
from camgeo.schema.yaml_source import Scalar
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from camgeo.schema.reader import Reader, Values
    from camgeo.schema.yaml_source import Node


@dataclass(frozen=True)
class Keyway:
    """A keyway in a round bore: `depth` is t2 of DIN 6885, from the bore's circle to the floor; `at` its middle.

    `standard` is whether width and depth are those of that standard by the bore.
    """

    width: float
    depth: float
    at: float = 0.0
    standard: bool = False


@dataclass(frozen=True)
class Flat:
    """A flat of a D-shaped bore, `across` from the opposite side of the bore; `at` is the direction of its normal."""

    across: float
    at: float = 0.0


@dataclass(frozen=True)
class Hub:
    """A round hub about the shaft: `height` beyond the face of the disc, on one side or on both."""

    diameter: float
    height: float
    side: Literal["top", "bottom", "both"] = "top"


@dataclass(frozen=True)
class SetScrew:
    """A radial hole from the hub's outside into the bore, `height` above the face of the disc (None: half the hub)."""

    diameter: float
    at: float = 0.0
    height: float | None = None


@dataclass(frozen=True)
class Bolts:
    """Equal round holes at equal angles; `circle` is the diameter that their centres lie on, `hole` their own."""

    count: int
    circle: float
    hole: float
    start: float = 0.0


@dataclass(frozen=True)
class Dowel:
    """One round hole of diameter `hole`, its centre on a circle of diameter `circle`."""

    circle: float
    hole: float
    at: float = 0.0


@dataclass(frozen=True)
class Lightening:
    """Round holes that are placed where there is room, `wall` from every edge; none smaller than `least` across.

    `ring` equal ones at equal angles from `start`, or up to `largest` of them, each the largest that still fits.
    """

    wall: float
    ring: int | None = None
    largest: int | None = None
    least: float | None = None
    start: float = 0.0


@dataclass(frozen=True)
class Mark:
    """A slot on the ray at 0, engraved into the upper face or cut through; `radius` is that of its outer end.

    Without a radius the slot lies as far out as the wall lets it.
    """

    kind: Literal["engrave", "cut"] = "engrave"
    width: float = 0.5
    length: float = 4.0
    depth: float = 0.3
    radius: float | None = None


@dataclass(frozen=True)
class Part:
    """The part round the contour, mm.

    `thickness` of the disc along the shaft. `bore` is a diameter, or the width across flats where `sides` (4 or 6) are
    given; `bore_at` is then the direction of one flat's normal. `fit` is the tolerance class of a round one, empty
    where none is stated; files have the nominal size. `wall` is the least that may be left between any two
    edges; without it what is left is reported and must be above 0. `outer` is the diameter of a ring, whose opening is
    the cam. `density` is in kg/m^3.
    """

    thickness: float | None = None
    bore: float | None = None
    sides: int = 0
    bore_at: float = 0.0
    fit: str = ""
    keyway: Keyway | None = None
    flat: Flat | None = None
    hub: Hub | None = None
    set_screw: SetScrew | None = None
    bolts: Bolts | None = None
    dowel: Dowel | None = None
    lightening: Lightening | None = None
    chamfer: float | None = None
    mark: Mark | None = None
    wall: float | None = None
    outer: float | None = None
    density: float | None = None

    @property
    def plain(self) -> bool:
        """Whether there is nothing but a round bore or none."""
        holes = (self.bolts, self.dowel, self.lightening)
        shaped = (self.outer, self.keyway, self.flat, self.hub, *holes, self.chamfer, self.mark)
        return not self.sides and all(feature is None for feature in shaped)


MOST_HOLES = 60
DENSEST = 30_000  # kg/m^3; osmium has 22 590
LEAST_SIZE = 1e-3  # mm: of what is cut, drilled or stands; a file's reader takes much less for nothing
THINNEST = 1e-6  # mm: of a body; the kernel of STEP takes points within 1e-7 mm as one
_NO_SIZES = frozenset({"wall", "least"})  # what has to be left, which may be as little as one likes


def _angle(name: str, about: str, default: str = "0") -> Field:
    return Field(name, Kind.ANGLE, about, default=default, at_least=-360, at_most=360)


def _count(name: str, about: str, *, least: int = 1, required: bool = False) -> Field:
    return Field(name, Kind.INTEGER, about, required, at_least=least, at_most=MOST_HOLES)


BORE = Table(
    (
        length("square", "width across flats of a square bore"),
        length("hexagon", "width across flats of a hexagonal bore"),
        _angle("at", "direction of one flat's normal"),
        length("diameter", "diameter of a round bore with a tolerance class"),
        Field("fit", Kind.CHOICE, "its tolerance class of ISO 286", choices=("H7",)),
    ),
    alternatives=(("square", ()), ("hexagon", ()), ("diameter", ("fit",))),
)


STANDARDS = ("din6885", "jis-b1301")  # which have the same widths and depths


KEYWAY = Table(
    (
        Field("standard", Kind.CHOICE, "width and depth by the bore, from DIN 6885-1 or JIS B 1301", choices=STANDARDS),
        length("width", "width b of the key"),
        length("depth", "depth t2 into the hub, from the bore's circle to the floor"),
        _angle("at", "direction of the keyway's middle"),
    ),
    alternatives=(("standard", ()), ("width", ("depth",))),
)


_BOLTS = (
    _count("count", "number of holes", required=True),
    length("circle", "diameter of the circle about the shaft that their centres lie on", required=True),
    length("hole", "diameter of each hole", required=True),
    _angle("start", "direction of the first hole"),
)


_DOWEL = (
    length("circle", "diameter of the circle about the shaft that its centre lies on", required=True),
    length("hole", "diameter of the hole", required=True),
    _angle("at", "direction of the hole"),
)


_HUB = (
    length("diameter", "diameter of the hub", required=True),
    length("height", "height beyond the face of the disc", required=True),
    Field(
        "side",
        Kind.CHOICE,
        "which side of the disc: top is the side that the drawing shows",
        default="top",
        choices=("top", "bottom", "both"),
    ),
)


_SCREW = (
    length("diameter", "diameter of the radial hole from the hub's outside into the bore", required=True),
    _angle("at", "direction of the hole"),
    length("height", "height of its axis above the face of the disc", default="half the hub"),
)


_LIGHTENING = Field(
    "lightening",
    Kind.TABLE,
    "round holes placed where there is room",
    default="none",
    table=Table(
        (
            _count("ring", "that many equal holes at equal angles about the shaft", least=2),
            _count("largest", "up to that many holes, each the largest that still fits"),
            length("wall", "wall left to every edge", required=True),
            length("least", "least diameter of a hole", default="twice the wall"),
            _angle("start", "direction of the first hole of a ring"),
        ),
        alternatives=(("ring", ()), ("largest", ())),
    ),
)


_MARK = (
    Field(
        "as",
        Kind.CHOICE,
        "engraved into the upper face, or cut through",
        default="engrave",
        choices=("engrave", "cut"),
    ),
    length("width", "width of the slot", default="0.5 mm"),
    length("length", "length of the slot along the ray", default="4 mm"),
    length("depth", "depth of an engraved slot", default="0.3 mm"),
    length("radius", "distance of the slot's outer end from the shaft", default="as far out as the wall lets it"),
)


def _optional(name: str, about: str, *fields: Field) -> Field:
    return Field(name, Kind.TABLE, about, default="none", table=Table(fields))


def read_bore(reader: Reader, field: Field, node: Node, path: str) -> float | Values | None:
    """Read a diameter in mm, or the mapping of a bore with flats or with a tolerance class."""
    if isinstance(node, Scalar):
        return read_numeric(reader, length(field.name, field.about), node, path)
    return reader.mapping(field, node, path)


def read_keyway(reader: Reader, field: Field, node: Node, path: str) -> Values | None:
    """Read the word for the standard's keyway, or its mapping."""
    if isinstance(node, Scalar):
        if node.text in STANDARDS:
            return {"standard": node.text}
        reader.fault(node.mark, path, "unknown keyway", quote(node.text), reader.wanted(field))
        return None
    return reader.mapping(field, node, path)


_BORE = Form(
    "a bore",
    "a diameter above 0, or a form such as {square: 10}, {hexagon: 10} or {diameter: 20, fit: H7}",
    read_bore,
    lambda field: {"anyOf": [number_schema(length("", "")), table_schema(field.inner)]},
)
_KEYWAY = Form(
    "a keyway",
    "din6885, jis-b1301, or a mapping such as {width: 4, depth: 1.8}",
    read_keyway,
    lambda field: {"anyOf": [{"enum": list(STANDARDS)}, table_schema(field.inner)]},
)


PART = mapping(
    "part",
    "the part round the contour",
    length("thickness", "thickness of the disc along the shaft; solids need it"),
    Field(
        "bore",
        Kind.OWN,
        "diameter of the bore around the shaft, or its form",
        default="none",
        table=BORE,
        unit=Kind.LENGTH,
        form=_BORE,
    ),
    Field("keyway", Kind.OWN, "keyway in a round bore", default="none", table=KEYWAY, form=_KEYWAY),
    _optional(
        "flat",
        "flat of a D-shaped bore",
        length("across", "width from the flat to the opposite side of the bore", required=True),
        _angle("at", "direction of the flat's normal"),
    ),
    _optional("hub", "hub about the shaft", *_HUB),
    _optional("set_screw", "hole for a set screw, through the hub", *_SCREW),
    _optional("bolts", "bolt circle", *_BOLTS),
    _optional("dowel", "dowel hole", *_DOWEL),
    _LIGHTENING,
    length("chamfer", "chamfer of 45 degrees along both edges of the contour, its height", default="none"),
    _optional("mark", "timing mark on the ray where the shaft angle is 0", *_MARK),
    length(
        "outer", "diameter of the outline of a ring, with `track: internal`, or of a groove's blank", default="none"
    ),
    length("wall", "least wall between any two edges", default="reported, and above 0"),
    Field(
        "density",
        Kind.NUMBER,
        "density of the material, kg/m³, for mass, inertia and unbalance",
        default="none",
        above=0,
        at_most=DENSEST,
    ),
)


def check_part(part: Values, reader: Reader) -> None:
    """Note the faults between the fields of `part` that were read."""
    _needs(reader, "keyway", "bore", "a keyway is cut into a bore")
    _needs(reader, "flat", "bore", "a flat is left in a bore")
    _needs(reader, "hub", "thickness", "a hub stands on the disc")
    _needs(reader, "chamfer", "thickness", "a chamfer runs along the edges of the disc")
    _needs(reader, "set_screw", "hub", "its hole goes through the hub")
    _needs(reader, "set_screw", "bore", "its hole leads into the bore")
    _needs(reader, "density", "thickness", "the mass is that of a solid")
    bore = part.get("bore")
    diameter = _diameter(part)
    if diameter is not None:
        _round(part, diameter, reader)
        if isinstance(bore, dict) and "at" in bore:
            reader.fault_at("part.bore.at", "a round bore has no flats", None, "leave it out")
    elif bore is not None and "fit" not in bore:
        across = bore.get("square", bore.get("hexagon"))
        if across is not None:
            screw = part.get("set_screw", {}).get("diameter")
            _below(reader, "part.set_screw.diameter", screw, across, "the bore's width")
        for name in ("keyway", "flat"):
            if name in part:
                reader.fault_at(f"part.{name}", "needs a round bore", None, "give the bore's diameter, or leave it out")
    _disc(part, reader)
    _holes(part, reader)
    _sizes(part, reader)


def _diameter(part: Values) -> float | None:
    """Diameter of a round bore, mm; None of one with flats, and without a bore."""
    bore = part.get("bore")
    diameter: float | None = bore.get("diameter") if isinstance(bore, dict) else bore
    return diameter


def _sizes(part: Values, reader: Reader) -> None:
    """Note what is too small to be told from nothing in a file."""
    for path, field in reader.numbers.items():
        top, *names = path.split(".")
        if top != "part" or field.kind is not Kind.LENGTH or field.above is None or names[-1] in _NO_SIZES:
            continue
        value: Any = part
        for name in names:
            value = value.get(name, {})
        least = THINNEST if path == "part.thickness" else LEAST_SIZE
        if isinstance(value, float) and value < least * (1.0 - NOISE):
            remedy = f"give at least {upward(least / reader.mm)} {reader.units}"
            reader.fault_at(path, "smaller than a file can hold", f"{value / reader.mm:g}", remedy)


def _needs(reader: Reader, name: str, other: str, why: str) -> None:
    if f"part.{name}" in reader.marks and f"part.{other}" not in reader.marks:
        reader.fault_at(f"part.{name}", f"needs part.{other}: {why}", None, f"give part.{other}, or leave it out")


def _round(part: Values, bore: float, reader: Reader) -> None:
    keyway, flat = part.get("keyway"), part.get("flat")
    if keyway is not None and flat is not None:
        reader.fault_at("part.flat", "cannot be combined with keyway", None, "give one of them")
    if keyway is not None and "standard" in keyway and key_for(bore) is None:
        low, high = LEAST / reader.mm, WIDEST / reader.mm
        remedy = f"the standard has bores from {low:.6g} to {high:.6g} {reader.units}; give width and depth"
        reader.fault_at("part.keyway", "no key of DIN 6885 for this bore", _told(bore, reader), remedy)
    if keyway is not None:
        _below(reader, "part.keyway.width", keyway.get("width"), bore, "the bore's diameter")
    if flat is not None and "across" in flat:
        _below(reader, "part.flat.across", flat["across"], bore, "the bore's diameter")
        if flat["across"] <= 0.5 * bore:
            remedy = f"give more than {_told(0.5 * bore, reader)}"
            reader.fault_at("part.flat.across", "not above half the bore", _told(flat["across"], reader), remedy)
    screw = part.get("set_screw", {})
    _below(reader, "part.set_screw.diameter", screw.get("diameter"), bore, "the bore's diameter")


def _disc(part: Values, reader: Reader) -> None:
    thickness, hub, screw = part.get("thickness"), part.get("hub", {}), part.get("set_screw", {})
    bore = _diameter(part)
    if bore is not None and "diameter" in hub and hub["diameter"] <= bore + 2.0 * LEAST_SIZE:
        remedy = f"give more than {upward((bore + 2.0 * LEAST_SIZE) / reader.mm)} {reader.units}"
        reader.fault_at(
            "part.hub.diameter",
            "not above the bore" if hub["diameter"] <= bore else "no wall round the bore",
            _told(hub["diameter"], reader),
            remedy,
        )
    if thickness is not None:
        chamfer = part.get("chamfer")
        _below(reader, "part.chamfer", chamfer, 0.5 * thickness, "half the thickness")
        _below(reader, "part.mark.depth", part.get("mark", {}).get("depth"), thickness, "the thickness")
    if "height" in hub:
        _below(reader, "part.set_screw.diameter", screw.get("diameter"), hub["height"], "the hub's height")
        _below(reader, "part.set_screw.height", screw.get("height"), hub["height"], "the hub's height")
    mark = part.get("mark", {})
    if "width" in mark and "length" in mark:
        _below(reader, "part.mark.width", mark["width"], mark["length"], "its length")
    if mark.get("as") == "cut" and "depth" in mark:
        reader.fault_at("part.mark.depth", "a mark that is cut through has no depth", None, "leave it out")


def _holes(part: Values, reader: Reader) -> None:
    bolts = part.get("bolts", {})
    if bolts.keys() >= {"count", "circle", "hole"} and bolts["count"] > 1:
        apart = bolts["circle"] * math.sin(math.pi / bolts["count"])
        _below(reader, "part.bolts.hole", bolts["hole"], apart, "the distance between two of them")
    if "largest" in part.get("lightening", {}) and "start" in part["lightening"]:
        reader.fault_at("part.lightening.start", "needs a ring", None, "leave it out")


def _below(reader: Reader, path: str, value: float | None, bound: float, what: str) -> None:
    if value is not None and value >= bound:
        reader.fault_at(path, f"not below {what}", _told(value, reader), f"give less than {_told(bound, reader)}")


def _told(value: float, reader: Reader) -> str:
    return f"{value / reader.mm:.6g} {reader.units}"


SIDES = {"square": 4, "hexagon": 6}
FEATURES: Mapping[str, Callable[..., object]] = {
    "flat": Flat,
    "hub": Hub,
    "set_screw": SetScrew,
    "bolts": Bolts,
    "dowel": Dowel,
    "lightening": Lightening,
}


def build_part(values: Values) -> Part:
    """Make the part of values in which there is no fault."""
    bore = values.get("bore")
    form: Values = bore if isinstance(bore, dict) else {}
    name = next((name for name in SIDES if name in form), "")
    width = form[name] if name else _diameter(values)
    features: Values = {name: feature(**values[name]) for name, feature in FEATURES.items() if name in values}
    features |= {name: values[name] for name in ("thickness", "outer", "chamfer", "wall", "density") if name in values}
    if "mark" in values:
        features["mark"] = Mark(**{"kind" if key == "as" else key: item for key, item in values["mark"].items()})
    shape = {"bore": width, "sides": SIDES.get(name, 0), "bore_at": form.get("at", 0.0), "fit": form.get("fit", "")}
    return Part(**shape, keyway=_keyway(values.get("keyway"), width), **features)


def _keyway(keyway: Values | None, bore: float | None) -> Keyway | None:
    if keyway is None or "width" in keyway:
        return None if keyway is None else Keyway(**keyway)
    row = None if bore is None else key_for(bore)
    return None if row is None else Keyway(row.width, row.hub, keyway.get("at", 0.0), standard=True)
