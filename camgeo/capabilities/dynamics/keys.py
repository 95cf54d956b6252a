"""The follower train whose dynamics are found: its key in recipes, the faults of its values, and its value."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

from camgeo.capabilities.dynamics.load_table import LOAD
from camgeo.common.rounding import downward
from camgeo.part.features import edge_of, values_read
from camgeo.recipe.discs import is_pair
from camgeo.recipe.linkage import TURNING
from camgeo.recipe.materials import material
from camgeo.recipe.track import is_groove
from camgeo.schema.fields import MOST, Field, FieldTable, Kind, OwnForm, length, mapping
from camgeo.schema.json_schema import number_schema, table_schema
from camgeo.schema.yaml_source import Mapping, Sequence, describe, join
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from camgeo.capabilities.dynamics.load_table import LoadTable
    from camgeo.recipe.materials import Material
    from camgeo.schema.reader import Reader, Values
    from camgeo.schema.yaml_source import Node

PER_MM = 1e-3  # m
SAME = 1e-12  # share by which contacts may be wider than the metal through rounding
MOST_DAMPING = 10.0  # times critical: kin.dynamics.train refuses more


@dataclass(frozen=True)
class StemGuide:
    """The guide of a stem: its overhang A and length B, mm, and the coefficient of friction mu.

    The overhang is the distance from the guide's near end to the roller's centre, or the flat face, at the lowest lift.
    """

    overhang: float
    length: float
    friction: float

    def jam(self, beyond: float = 0.0) -> float:
        """Pressure angle alpha, rad, from which on no force moves the stem: tan alpha = B/(mu (2 A + B)).

        `beyond`, mm, is added to the overhang A.
        """
        return math.atan2(self.length, self.friction * (2.0 * (self.overhang + beyond) + self.length))

    @property
    def reach(self) -> float:
        """Distance of a flat face's contact from the stem's axis, mm, at which no force moves the stem: B/(2 mu)."""
        return self.length / (2.0 * self.friction)


@dataclass(frozen=True)
class CouplerBody:
    """The square frame of a linkage as a body.

    `mass` is in kg; `centre` is the centre of mass (x, y) in the frame's axes, from the frame's middle, mm; `inertia`
    is the moment of inertia about that centre, kg m^2.
    """

    mass: float
    centre: tuple[float, float] = (0.0, 0.0)
    inertia: float = 0.0


@dataclass(frozen=True)
class Dynamics:
    """A follower train: N, kg and m; of a follower that turns N m, kg m^2 and rad. Lengths named below are in mm.

    mass         driven by the contact; beside `moved_mass` that of the tappet alone
    stiffness    of the contact or train, N/m; None for a rigid train
    rpm          speed of the shaft, turns a minute
    damping      N s/m
    preload      force of the spring at the lowest position; None without one, or where `least_force` gives it
    rate         of that spring, N/m
    backlash     clearance at the contacts, mm, in place of a spring; None without
    transient    whether the train is followed from rest, with its impacts
    load         formula of the shaft angle t, or a table; above 0 towards the cam
    least_force  least force along the travel from which the preload follows; None where that is given
    width        of the contacts along the shaft, mm; None for the width of the metal
    roller_material  of what touches the cam; None where it is the cam's `material`
    spring       the coil spring, if one is given: preload and rate follow from it, unless it is on a valve
    moved_mass   of the body that the tappet moves besides itself, kg, such as a valve
    """

    mass: float
    stiffness: float | None
    rpm: float
    damping: float = 0.0
    preload: float | None = None
    rate: float = 0.0
    backlash: float | None = None
    guide: StemGuide | None = None
    coupler: CouplerBody | None = None
    transient: bool = False
    load: str | LoadTable = "0"
    least_force: float | None = None
    width: float | None = None
    material: Material | None = None
    roller_material: Material | None = None
    spring: Coil | None = None
    moved_mass: float = 0.0


@dataclass(frozen=True)
class Coil:
    """A coil spring on the stem, or with `on_body` on the valve that it works: its lengths, mm, and its rate, N/m.

    `free` is the length without a load, `seat` at the lowest position of what carries it, `solid` with the coils on one
    another, None where it is not given. Lifts are of what carries it.
    """

    free: float
    seat: float
    rate: float
    solid: float | None = None
    on_body: bool = False

    @property
    def preload(self) -> float:
        """Force at the lowest position, N."""
        return self.load(0.0)

    def load(self, lift: float) -> float:
        """Force at a lift, mm, in N."""
        return PER_MM * self.rate * (self.free - self.seat + lift)

    def left(self, lift: float) -> float | None:
        """Travel left before the coils bind, mm, at a lift, mm; below 0 where they bind, None without `solid`."""
        return None if self.solid is None else self.seat - lift - self.solid


class Width(NamedTuple):
    """Width of the contacts along the shaft, mm, and the key of `BOUNDS` that limits it."""

    length: float
    bound: str


BOUNDS = {
    "width": "dynamics.width",
    "thickness": "the part's thickness",
    "land": "the land between the chamfers",
    "groove": "the groove's depth",
}
"""What may bound the width of contacts, in words."""


def contact_width(
    width: float | None, thickness: float | None, edge: float = 0.0, depth: float | None = None
) -> Width | None:
    """The least width of the contacts, mm, and what bounds it; None without any bound.

    Bounds are the stated `width`, the part's `thickness`, that less the chamfer `edge` on both edges (0 for none), and
    the `depth` of a groove (None for a contour that goes through the part); all in mm.
    """
    bounds = {"width": width, "thickness": thickness, "groove": depth}
    if thickness is not None and edge:
        bounds["land"] = thickness - 2.0 * edge
    lengths = [Width(length, name) for name, length in bounds.items() if length is not None]
    return min(lengths, default=None)


def _read_loads(reader: Reader, field: Field, node: Node, path: str) -> tuple[tuple[float, float], ...] | None:
    """Read two pairs of a length, mm, and a force, N, the greater at the shorter length; None after a fault."""
    parts = (length("", ""), Field("", Kind.NUMBER, "", at_least=0, at_most=_MOST, unit=Kind.FORCE))
    rows = []
    for i, item in enumerate(reader.items(field, node, path, _PAIR)):
        if not isinstance(item, Sequence) or len(item.items) != _PAIR:
            reader.fault(item.mark, join(path, i), "not a length with its force", describe(item), "give [40, 250]")
            return None
        pairs = enumerate(zip(parts, item.items, strict=True))
        rows.append(tuple(reader.field(part, cell, f"{join(path, i)}[{k}]") for k, (part, cell) in pairs))
    if len(rows) != _PAIR or any(None in row for row in rows):
        if len(rows) == 1:
            reader.fault(node.mark, path, "one load tells no rate", None, reader.wanted(field))
        return None
    (long, low), (short, high) = sorted(rows, reverse=True)
    if not (long > short and high > low):
        reader.fault(
            node.mark, path, "the force does not grow as it is pressed", None, "give the greater at the shorter"
        )
        return None
    return tuple(rows)


_PAIR = 2
_MOST = MOST**2  # greatest figure in SI that is accepted: more is a slip of the unit
_LOADS: OwnForm[Reader] = OwnForm(
    "two loads",
    "two lengths with their forces, such as [[40, 250 N], [32, 560 N]]",
    _read_loads,
    lambda _: {"type": "array", "items": {"type": "array", "minItems": 2, "maxItems": 2}, "minItems": 2, "maxItems": 2},
)


def _read_mass(reader: Reader, _: Field, node: Node, path: str) -> float | tuple[float, float] | None:
    """Read a mass or inertia, or the masses of tappet and valve, kg; None after a fault."""
    if isinstance(node, Mapping):
        values = reader.table(MASSES, node, path)
        return (values[TAPPET], values[VALVE]) if {TAPPET, VALVE} <= values.keys() else None
    number: float | None = reader.readers[Kind.NUMBER](reader, _MASS, node, path)
    return number


TAPPET, VALVE = "tappet", "valve"
_MASS = Field("mass", Kind.NUMBER, "", required=True, above=0, at_most=_MOST, unit=Kind.INERTIA)
MASSES = FieldTable(
    (
        Field(
            TAPPET,
            Kind.NUMBER,
            "mass of what moves with the tappet, and the rocker's as felt there, kg",
            required=True,
            above=0,
            at_most=_MOST,
            unit=Kind.MASS,
        ),
        Field(
            VALVE,
            Kind.NUMBER,
            "mass of what moves with the valve: retainer, keys and a third of its spring too, kg",
            required=True,
            at_least=0,
            at_most=_MOST,
            unit=Kind.MASS,
        ),
    )
)
_MASS_FORM: OwnForm[Reader] = OwnForm(
    "a mass",
    "a number above 0, or beside valve {tappet: 0.08, valve: 0.11}",
    _read_mass,
    lambda _: {"anyOf": [*number_schema(_MASS)["anyOf"], table_schema(MASSES)]},
    instead=MASSES,
)
COIL = FieldTable(
    (
        Field("on", Kind.CHOICE, "what carries it; required beside valve", default=TAPPET, choices=(VALVE, TAPPET)),
        length("seat_length", "length where the follower is lowest, or the valve is on its seat", required=True),
        Field("rate", Kind.RATE, "its rate, N/m; a unit may stand behind it: 30 N/mm", above=0, at_most=_MOST),
        length("free_length", "length without a load, with the rate"),
        Field("loads", Kind.OWN, "two lengths with the forces there, in place of both", form=_LOADS),
        length("solid_length", "length at which its coils lie on one another", default="not judged"),
    ),
    alternatives=(("rate", ("free_length",)), ("loads", ())),
)
DYNAMICS = FieldTable(
    (
        Field(
            "mass",
            Kind.OWN,
            "mass that the contact drives, kg; where the follower turns its moment of inertia, kg m²",
            required=True,
            unit=Kind.INERTIA,
            form=_MASS_FORM,
        ),
        Field(
            "damping",
            Kind.NUMBER,
            "damping of the contact or train, N s/m; N m s/rad where it turns",
            default="0",
            at_least=0,
            at_most=_MOST,
        ),
        Field(
            "stiffness",
            Kind.NUMBER,
            "stiffness of the contact or train, N/m; N m/rad where it turns; without it the train is rigid",
            default="rigid",
            above=0,
            at_most=_MOST,
            unit=Kind.GIVING,
        ),
        Field(
            "preload",
            Kind.NUMBER,
            "force of the spring that holds the follower on the cam, N, at its lowest; N m where it turns",
            above=0,
            at_most=_MOST,
            unit=Kind.THRUST,
        ),
        length("backlash", "clearance between the cam and the two faces or rollers that hold it, in place of a spring"),
        Field(
            "rate",
            Kind.NUMBER,
            "rate of the preload spring, N/m; N m/rad where it turns",
            default="0",
            at_least=0,
            at_most=_MOST,
            unit=Kind.GIVING,
        ),
        Field(
            "least_force",
            Kind.NUMBER,
            "least force along the travel for which the preload of the spring is found, N; N m where it turns",
            above=0,
            at_most=_MOST,
            unit=Kind.THRUST,
        ),
        Field(
            "load",
            Kind.OWN,
            "load of a rigid train over the shaft angle t, N, above 0 towards the cam; N m where it turns",
            default="0",
            unit=Kind.THRUST,
            form=LOAD,
        ),
        Field("spring", Kind.TABLE, "a coil spring on the stem or the valve, in place of preload and rate", table=COIL),
        length("width", "width of the contacts, of which their pressure is found", default="that of the metal"),
        material("material", "material of the cam"),
        material("roller_material", "that of what touches it", default="that of the cam"),
        Field("rpm", Kind.NUMBER, "speed of the shaft, turns a minute", required=True, above=0, at_most=MOST),
        Field("transient", Kind.TRUTH, "whether the train is followed from rest, with its impacts", default="false"),
        mapping(
            "guide",
            "guide of the stem, in which it must not jam",
            length(
                "overhang",
                "how far the roller's centre, or the flat face, stands out before the guide, at its lowest",
                required=True,
            ),
            length("length", "length of the guide", required=True),
            Field("friction", Kind.NUMBER, "coefficient of friction in the guide", required=True, above=0, at_most=10),
        ),
        mapping(
            "coupler",
            "the square frame of a linkage as a body, for a rigid train",
            Field("mass", Kind.NUMBER, "its mass, kg", required=True, above=0, at_most=_MOST, unit=Kind.MASS),
            Field(
                "centre",
                Kind.POINT,
                "its centre of mass in the frame's axes, from the frame's middle",
                default="[0, 0]",
            ),
            Field(
                "inertia",
                Kind.NUMBER,
                "its moment of inertia about that, kg m²",
                default="0",
                at_least=0,
                at_most=_MOST,
            ),
        ),
    ),
    alternatives=(("preload", ()), ("backlash", ()), ("spring", ())),
    optional=True,
)


def fields() -> tuple[Field, ...]:
    """Give the key `dynamics` of a recipe."""
    about = "the follower train, whose forces, float and impacts at a speed are found"
    return (Field("dynamics", Kind.TABLE, about, default="none", table=DYNAMICS, after="dwell"),)


def check(values: Values, reader: Reader) -> None:
    """Note the faults of a follower train and of keys that do not go with it; a coil spring gives preload and rate."""
    _take_masses(values.get("dynamics", {}), reader)
    _take_spring(values.get("dynamics", {}), reader)
    _check_train(values.get("dynamics", {}), reader)
    _check_guide(values, reader)
    _check_width(values, reader)
    _check_preloaded(values, reader)
    _check_elastic(values, reader)


def _take_masses(train: Values, reader: Reader) -> None:
    """Part the masses of tappet and valve, or note their faults."""
    masses = train.get("mass")
    if not isinstance(masses, tuple):
        return
    train["mass"], train["moved_mass"] = masses
    path = "dynamics.mass"
    if VALVE not in reader.marks:
        reader.fault_at(path, "masses of tappet and valve without a valve", None, "give one number, or valve")
    elif "dynamics.stiffness" in reader.marks:
        what = "an elastic train has one mass"
        reader.fault_at(path, what, None, "give one number, tappet + ratio^2 valve, or leave stiffness out")


def _check_carrier(path: str, spring: Values, reader: Reader) -> bool:
    """Whether it is told what carries a coil spring; notes its faults."""
    beside, carrier = VALVE in reader.marks, spring.get("on")
    if beside and f"{path}.on" not in reader.marks:
        remedy = "give on: valve, whose travel it has, or on: tappet for one that presses the tappet itself"
        reader.fault(reader.marks[path], f"{path}.on", "missing, needed beside valve", None, remedy)
    elif carrier == VALVE and not beside:
        reader.fault_at(f"{path}.on", "there is no valve", "'valve'", "give valve, or leave this out")
    elif carrier == VALVE and "dynamics.stiffness" in reader.marks:
        what = "the seat carries its spring while the valve is shut, which an elastic train does not follow"
        remedy = "leave stiffness out, or give preload and rate as the tappet feels them in place of spring"
        reader.fault_at(f"{path}.on", what, "'valve'", remedy)
    else:
        return True
    return False


def _take_spring(train: Values, reader: Reader) -> None:
    """Set preload and rate of the train to those of its coil spring on the stem, or note the spring's faults."""
    spring = train.get("spring")
    if spring is None:
        return
    path, seat = "dynamics.spring", spring.get("seat_length")
    if Kind.STROKE in reader.angular or "linkage" in reader.marks:
        remedy = "give preload and rate in its place"
        reader.fault_at(path, "a coil spring on a stem, and there is none", None, remedy)
        return
    if "dynamics.rate" in reader.marks:
        reader.fault_at("dynamics.rate", "cannot be combined with spring", None, "leave one of the two out")
        return
    if not _check_carrier(path, spring, reader):
        return
    free, rate = spring.get("free_length"), spring.get("rate")
    if "loads" in spring:  # the straight line through two loads: its slope, and the length at which it is 0
        (long, low), (short, high) = sorted(spring["loads"], reverse=True)
        rate = (high - low) / (PER_MM * (long - short))
        free = long + low / (PER_MM * rate)
    if seat is None or free is None or rate is None:
        return
    coil = Coil(free, seat, rate, spring.get("solid_length"), spring.get("on") == VALVE)
    if not seat < free:
        length = f"{free / reader.mm:.6g} {reader.units}"
        reader.fault_at(f"{path}.seat_length", "the spring is slack there", None, f"give less than {length}")
    elif coil.solid is not None and not coil.solid < seat:
        length = f"{seat / reader.mm:.6g} {reader.units}"
        reader.fault_at(f"{path}.solid_length", "its coils touch before it moves", None, f"give less than {length}")
    else:
        train.update(spring=coil, **({} if coil.on_body else {"preload": coil.preload, "rate": rate}))
        reader.marks["dynamics.preload"] = reader.marks[path]  # figures and checks of a preload now apply


def _check_train(train: Values, reader: Reader) -> None:
    """Note fields of the train that exclude one another, and damping beyond MOST_DAMPING."""
    _check_spring(train, reader)
    _check_coupler(train, reader)
    if "backlash" in train and "rate" in train:
        remedy = "give preload in place of backlash, or leave the rate out"
        reader.fault_at("dynamics.rate", "a spring rate beside backlash", None, remedy)
    if "backlash" in train and "linkage" in reader.marks:
        remedy = "give preload: clearance in the joints of a linkage is not modelled"
        reader.fault_at("dynamics.backlash", "backlash at the cam under a linkage", None, remedy)
    if {"mass", "stiffness"} <= train.keys() and "damping" in train:
        ratio = train["damping"] / math.sqrt((train["stiffness"] + train.get("rate", 0.0)) * train["mass"]) / 2
        if ratio > MOST_DAMPING:
            most = train["damping"] * MOST_DAMPING / ratio
            remedy = f"give less than {downward(most)}"
            reader.fault_at("dynamics.damping", f"{ratio:.4g} times critical", None, remedy)


def _check_width(values: Values, reader: Reader) -> None:
    """Note a stated width of the contacts that exceeds the metal's."""
    width, part = values.get("dynamics", {}).get("width"), values.get("part", {})
    cam = values.get("cam", {})
    depth = cam["track"].get("groove", {}).get("depth") if is_groove(cam) else None
    metal = contact_width(None, part.get("thickness"), edge_of(values_read(part)), depth)
    if width is not None and metal is not None and width > metal.length * (1.0 + SAME) and metal.length > 0.0:
        most = f"{metal.length / reader.mm:.9g} {reader.units}"
        what = f"wider than the metal: {BOUNDS[metal.bound]} is {most}"
        remedy = f"give {most} or less, or leave it out"
        reader.fault_at("dynamics.width", what, f"{width / reader.mm:.9g} {reader.units}", remedy)


def _check_guide(values: Values, reader: Reader) -> None:
    """Note a guide for a follower without a stem of its own, and for a tilted face."""
    if "dynamics.guide" not in reader.marks:
        return
    if "led" not in reader.offers or "linkage" in reader.marks:
        remedy = "leave it out, or give a follower on a stem, without a linkage"
        reader.fault_at("dynamics.guide", "the follower has no stem of its own", None, remedy)
    elif values.get("cam", {}).get("follower", {}).get("tilt"):
        reader.fault_at(
            "dynamics.guide", "the friction of a tilted face is not found", None, "leave it out, or the tilt"
        )


def _check_coupler(train: Values, reader: Reader) -> None:
    """Note a coupler without a linkage, and under a linkage whose frame slides on the rocker."""
    if "coupler" not in train:
        return
    if "linkage" not in reader.marks:
        remedy = "leave it out, or give a linkage"
        reader.fault_at("dynamics.coupler", "a coupler without a linkage", None, remedy)
    elif reader.kinds["linkage"] in TURNING:
        what = "the frame of this linkage is no coupler: it slides on the rocker and turns with it"
        remedy = "leave it out, and add the frame's moment of inertia about the rocker's pivot to dynamics.mass"
        reader.fault_at("dynamics.coupler", what, None, remedy)


def _check_spring(train: Values, reader: Reader) -> None:
    """Note a follower that is held on the cam twice or not at all, and keys that a rigid or elastic train lacks."""
    keys = [name for name in ("preload", "backlash") if f"dynamics.{name}" in reader.marks]
    if keys and "dynamics.least_force" in reader.marks:
        remedy = "give exactly one of preload, backlash or least_force"
        reader.fault_at("dynamics.least_force", f"cannot be combined with {keys[0]}", None, remedy)
    if "dynamics" not in reader.marks or not train:
        return
    if "dynamics.stiffness" in reader.marks:
        if not keys and {"cam.preload", "dynamics.spring"}.isdisjoint(reader.marks):
            reader.fault(
                reader.marks["dynamics"], "dynamics", "needs preload or backlash", None, "give exactly one of them"
            )
        sprung = "dynamics.preload" in reader.marks and "linkage" not in reader.marks
        pressed = () if sprung else ("width", "material", "roller_material")
        for name in ("load", "least_force", "coupler", *pressed):
            if name in train:
                remedy = "leave stiffness out, or this"
                reader.fault_at(f"dynamics.{name}", "belongs to a train without stiffness", None, remedy)
        return
    wanted = "give a number above 0: stiffness of the contact or train, N/m; N m/rad where it turns"
    needing = [name for name in ("backlash", "transient", "damping") if train.get(name)]
    if needing:
        reader.fault(reader.marks["dynamics"], "dynamics.stiffness", f"missing, needed with {needing[0]}", None, wanted)
    if "linkage" in reader.marks and "least_force" in train:
        remedy = (
            "leave it out: the faces of a square frame hold the cam from all sides; preload is a spring at the output"
        )
        reader.fault_at("dynamics.least_force", "no spring holds a square frame on the cam", None, remedy)


def _check_preloaded(values: Values, reader: Reader) -> None:
    """Note backlash, a spring and stiffness of a train where both contacts are preloaded."""
    train = values.get("dynamics", {})
    if values.get("cam", {}).get("preload") is None:
        return
    spring = next((name for name in ("spring", "preload", "least_force") if name in train), None)
    if "backlash" in train:
        remedy = "leave cam.preload out, or dynamics"
        reader.fault_at("dynamics.backlash", "clearance beside an interference", None, remedy)
    elif spring is not None and not reader.kinds["linkage"]:  # under which it acts on the output
        remedy = "leave cam.preload out, or dynamics"
        reader.fault_at(f"dynamics.{spring}", "a spring beside a second contact that is preloaded", None, remedy)
    elif "stiffness" in train:
        remedy = "leave it out; cam.preload.stiffness has that of the contacts"
        reader.fault_at("dynamics.stiffness", "an elastic train beside preloaded contacts", None, remedy)


def _check_elastic(values: Values, reader: Reader) -> None:
    """Note an elastic train for a cam that cannot have one: a groove, and conjugate discs without preload."""
    cam = values.get("cam", {})
    if "stiffness" not in values.get("dynamics", {}):
        return
    remedy = "leave it out: the forces of a rigid follower are found"
    if is_groove(cam):
        reader.fault_at("dynamics.stiffness", "a groove has no elastic train", None, remedy)
    if is_pair(values) and "preload" not in cam:
        reader.fault_at("dynamics.stiffness", "two conjugate discs have no elastic train", None, remedy)


def build(values: Values) -> Dynamics | None:
    """Make the train of values without a fault; None for a recipe without `dynamics`."""
    train: Values | None = values.get("dynamics")
    if train is None:
        return None
    guide, coupler = train.get("guide"), train.get("coupler")
    bodies = {
        "guide": None if guide is None else StemGuide(**guide),
        "coupler": None if coupler is None else CouplerBody(**coupler),
    }
    return Dynamics(**{"stiffness": None, **train, **bodies})
