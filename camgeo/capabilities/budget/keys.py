"""The key `budget` of a recipe: how it is read, what is checked of it, the value that it becomes."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Literal

from camgeo.capabilities.budget.dimensions import (
    ANGLE,
    BORE,
    CONJUGATE,
    DIMENSIONS,
    GUIDE,
    LINKAGE,
    PROFILE,
    dimension_names,
    traits,
)
from camgeo.capabilities.budget.fits import SHAFTS, ShaftFit, fit_of
from camgeo.part.bore import diameter_of
from camgeo.part.din6885 import key_for
from camgeo.part.iso286 import KEYWAYS, UPPER_ENDS
from camgeo.schema.errors import suggestion
from camgeo.schema.fields import MOST, Field, FieldTable, Kind, OwnForm, either
from camgeo.schema.json_schema import number_schema
from camgeo.schema.read_scalar import read_numeric
from camgeo.schema.yaml_source import Mapping, Scalar, describe, entries, join, keys
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from camgeo.schema.fields import Schema
    from camgeo.schema.reader import Reader, Values
    from camgeo.schema.yaml_source import Node

FREE, NO_ZERO = "free", "none"
RUNS, MOST_RUNS = 10_000, 1_000_000  # half a second for a roller cam, and 50
MOST_SEED = 2**32 - 1  # as of a sweep; a number of a recipe is exact to it
MOST_WAVES = 1000  # a bound against slips
MOST_EXPONENT = 10  # of costs; known ones of machining lie between 0.5 and 3
MOST_OFF = 45  # degrees of an angle's tolerance: a bound against slips
# fields of `cam` that shape the contour and have no tolerance of their own
SHAPES = (
    "base_radius",
    "motion",
    "p",
    "fourier",
    "reuleaux",
    "hypocycloid",
    "swing",
    "delta",
    "arc",
    "ratio",
    "sizing",
)


@dataclass(frozen=True)
class Budget:
    """The recipe's budget of errors; lengths in mm, angles in rad.

    `permitted` is the greatest error of the follower or of the linkage's output, mm or rad. `tolerances` are plus and
    minus, with the words of their dimensions; None marks a free dimension, whose tolerance is to be found. `cost` has c
    by the words of the free dimensions: a tolerance in the recipe's unit of length, or in degrees, costs
    c/tolerance^`exponent`. `zero` is the shaft angle, rad, at
    which the machine is set, None without one. `play` is the greatest permitted play of a follower that is held from
    both sides, mm or rad, None for any. `guide` is the distance from the middle of a stem's guide to the foot of the
    perpendicular from the shaft on the line of travel. `fit` is half the play of bore and key by their fits, which
    `tolerances` hold too. `sums` says which sum must stay within `permitted`. `waves` is the number of waves per turn
    of the profile's error, None where it is not stated. `runs` made parts are simulated, 0 for none, by random numbers
    from `seed`.
    """

    permitted: float
    tolerances: tuple[tuple[str, float | None], ...]
    cost: tuple[tuple[str, float], ...] = ()
    exponent: float = 1.0
    zero: float | None = None
    play: float | None = None
    guide: float | None = None
    fit: ShaftFit | None = None
    sums: Literal["worst", "rss"] = "worst"
    waves: int | None = None
    runs: int = RUNS
    seed: int = 1

    @property
    def to_be_found(self) -> tuple[str, ...]:
        """Words of the free dimensions, in the order of `tolerances`."""
        return tuple(name for name, tolerance in self.tolerances if tolerance is None)

    def split(self, tolerances: Sequence[tuple[str, float]]) -> Budget:
        """The budget with `tolerances`, pairs of a word and mm or rad, for its free dimensions, and without costs."""
        chosen = dict(tolerances)
        stated = tuple((name, chosen.get(name, tolerance)) for name, tolerance in self.tolerances)
        return replace(self, tolerances=stated, cost=())


# --- reading ----------------------------------------------------------------------------------------------------------


def _tolerance(name: str) -> Field:
    """Field of a dimension's tolerance."""
    if DIMENSIONS[name].angle:
        return Field(name, Kind.ANGLE, DIMENSIONS[name].about, at_least=0, at_most=MOST_OFF)
    return Field(name, Kind.LENGTH, DIMENSIONS[name].about, at_least=0, at_most=MOST)


def _traits(reader: Reader) -> frozenset[str]:
    discs = 2 if "cam.conjugate" in reader.marks else 1
    return traits(reader.offers, discs, reader.kinds["linkage"])


def _refuse(reader: Reader, name: str, node: Mapping, path: str) -> None:
    """Note the fault of a word that is no dimension of this cam, with the words that it takes."""
    known, mark = dimension_names(_traits(reader)), keys(node)[name].mark
    first = name.removeprefix("cam.").partition(".")[0].partition("[")[0]
    if first in SHAPES:
        reader.fault(mark, path, "shapes the contour, which is made by it", None, "give profile: what that may be off")
        return
    if name in DIMENSIONS:
        remedy = f"those of this cam are {either(known, 'and')}"
        reader.fault(mark, path, "this cam has no such dimension", None, remedy)
        return
    reader.fault(mark, path, "unknown dimension", None, suggestion(name, known) or f"give {either(known)}")


def _read_tolerances(reader: Reader, field: Field, node: Node, path: str) -> dict[str, float | None] | None:
    """Read the tolerances by the words of their dimensions, mm or rad, None for `free`; None for no mapping."""
    return _read_by_word(reader, field, node, path, _tolerance, free=True)


def _read_cost(reader: Reader, field: Field, node: Node, path: str) -> dict[str, float | None] | None:
    """Read the costs by the words of their dimensions; None for no mapping."""
    return _read_by_word(
        reader, field, node, path, lambda name: Field(name, Kind.NUMBER, "its cost", above=0, at_most=MOST), free=False
    )


def _read_by_word(
    reader: Reader, field: Field, node: Node, path: str, value_field: Callable[[str], Field], *, free: bool
) -> dict[str, float | None] | None:
    """Read a mapping from words of this cam's dimensions to values, None for `free` where `free` is permitted.

    `value_field` gives the field by which the value of a word is read. Faults are noted, and values with faults left
    out; the result is None where the node is no mapping.
    """
    if not isinstance(node, Mapping):
        reader.fault(node.mark, path, "not a mapping", describe(node), reader.wanted(field))
        return None
    known = dimension_names(_traits(reader))
    values: dict[str, float | None] = {}
    for name, value in entries(node).items():
        below = join(path, name)
        if name not in known:
            _refuse(reader, name, node, below)
        elif free and isinstance(value, Scalar) and value.text == FREE:
            values[name] = None
        elif (number := reader.field(value_field(name), value, below)) is not None:
            values[name] = number
    return values


def _read_zero(reader: Reader, _field: Field, node: Node, path: str) -> float | str | None:
    """Read the shaft angle at which a machine is set, rad, or the word `none`; None where a fault was noted."""
    if isinstance(node, Scalar) and node.text == NO_ZERO:
        return NO_ZERO
    return read_numeric(reader, _ZERO_ANGLE, node, path)


def _schema_of_words(value: Schema) -> Schema:
    return {"type": "object", "properties": dict.fromkeys(DIMENSIONS, value), "additionalProperties": False}


_ZERO_ANGLE = Field("zero", Kind.ANGLE, "shaft angle at which the machine is set", at_least=-360, at_most=360)
_AMOUNT = number_schema(Field("", Kind.LENGTH, "", at_least=0, at_most=MOST))
_TURNED = number_schema(Field("", Kind.ANGLE, "", at_least=0, at_most=MOST_OFF))
_TOLERANCES = OwnForm(
    "tolerances",
    "a mapping from dimensions to plus and minus, such as {profile: 0.01, shaft: 0.02}, or to free",
    _read_tolerances,
    lambda _: _schema_of_words({"anyOf": [{"const": FREE}, _AMOUNT, _TURNED]}),
)
_COST = OwnForm(
    "costs",
    "a mapping from dimensions to costs, such as {profile: 1, follower.radius: 0.3}",
    _read_cost,
    lambda _: _schema_of_words(number_schema(Field("", Kind.NUMBER, "", above=0, at_most=MOST))),
)
_ZERO = OwnForm(
    "a setting",
    "a shaft angle, or none",
    _read_zero,
    lambda _: {"anyOf": [{"const": NO_ZERO}, number_schema(_ZERO_ANGLE)]},
)
_KEY = FieldTable(
    tuple(
        Field(name, Kind.CHOICE, f"tolerance class of the {name}'s keyway", required=True, choices=tuple(KEYWAYS))
        for name in ("hub", "shaft")
    )
)

BUDGET = FieldTable(
    (
        Field(
            "permitted",
            Kind.MOTION,
            "greatest error of the follower, or of the linkage's output: a length, or degrees where it turns",
            required=True,
            above=0,
            at_most=MOST,
        ),
        Field(
            "tolerances", Kind.OWN, "what each dimension may be off, plus and minus", required=True, form=_TOLERANCES
        ),
        Field(
            "cost",
            Kind.OWN,
            "cost c of each free dimension: c/tolerance^exponent, lengths in the recipe's unit, angles in degrees",
            default="none",
            form=_COST,
        ),
        Field("exponent", Kind.NUMBER, "of the tolerance in the costs", default="1", above=0, at_most=MOST_EXPONENT),
        Field("zero", Kind.OWN, "where the machine is set: its error there is subtracted", default="none", form=_ZERO),
        Field("sum", Kind.CHOICE, "the sum that must stay within", default="worst", choices=("worst", "rss")),
        Field("play", Kind.MOTION, "greatest play of a follower held from both sides", above=0, at_most=MOST),
        Field(GUIDE, Kind.LENGTH, "from the shaft to the middle of the stem's guide, along it", above=0, at_most=MOST),
        Field("fit", Kind.CHOICE, "tolerance class of the shaft in the bore", choices=tuple(SHAFTS)),
        Field("key", Kind.TABLE, "tolerance classes of the keyways", default="the key has no play", table=_KEY),
        Field("runs", Kind.INTEGER, "parts that are simulated", default=str(RUNS), at_least=0, at_most=MOST_RUNS),
        Field(
            "waves",
            Kind.INTEGER,
            "waves of the profile's error over a turn, for errors of velocity",
            default="these are left out",
            at_least=1,
            at_most=MOST_WAVES,
        ),
        Field("seed", Kind.INTEGER, "seed of the simulation", default="1", at_least=0, at_most=MOST_SEED),
    )
)


def fields() -> tuple[Field, ...]:
    """The field `budget` of a recipe's top level."""
    return (Field("budget", Kind.TABLE, "what each dimension may be off", default="none", table=BUDGET),)


# --- faults -----------------------------------------------------------------------------------------------------------


def check_budget(values: Values, reader: Reader) -> None:
    """Note the faults between the fields of a budget, and those with other sections of the recipe.

    A dimension that has only a cost is put into `budget.tolerances` of the values as free.
    """
    if "budget" not in values:
        return
    budget = values["budget"]
    tolerances = budget.get("tolerances", {})
    if values.get("linkage", {}).get("dyads"):
        problem, remedy = "the influence of dyads is not known", "leave budget or linkage.dyads out"
        reader.fault_at("budget", problem, None, remedy)
    _check_costs(budget, tolerances, reader)
    _check_guide(budget, tolerances, reader)
    _check_play(values, reader)
    _check_fit(values, reader)
    _check_made(values, reader)
    if not tolerances and "budget.tolerances" in reader.marks and not reader.errors:
        reader.fault_at("budget.tolerances", "no tolerance is given", None, "give profile: 0.01 or another one")


def _place(name: str, reader: Reader) -> str:
    """Path of a dimension of the budget: that of its tolerance, or of its cost where it has no more."""
    tolerance = join("budget.tolerances", name)
    return tolerance if tolerance in reader.marks else join("budget.cost", name)


def _check_costs(budget: Values, tolerances: Values, reader: Reader) -> None:
    """Note costs of dimensions with a stated tolerance, free dimensions without a cost, an exponent without costs.

    A single free dimension needs no cost. A dimension that has only a cost is put into `tolerances` as free.
    """
    free = [name for name, tolerance in tolerances.items() if tolerance is None]
    for name in budget.get("cost", {}):
        if tolerances.get(name) is not None:
            where = join("budget.cost", name)
            reader.fault_at(where, "its tolerance is stated", None, f"give tolerances.{name}: free, or no cost")
        elif name not in tolerances:
            tolerances[name] = None
    if "exponent" in budget and "budget.cost" not in reader.marks:
        reader.fault_at("budget.exponent", "without a cost it has no use", None, "leave it out, or give cost")
    without = [name for name in free if join("budget.cost", name) not in reader.marks]
    if without and (len(free) > 1 or "cost" in budget):
        where = join("budget.tolerances", without[0])
        reader.fault_at(where, "free, and without a cost", FREE, f"give cost.{without[0]}, or a tolerance")


def _check_guide(budget: Values, tolerances: Values, reader: Reader) -> None:
    """Note a tolerance of the guide's direction without the guide's place, and the place without the tolerance."""
    if GUIDE in tolerances and f"budget.{GUIDE}" not in reader.marks:
        problem, remedy = "the guide's place is not known", f"give budget.{GUIDE}: from the shaft to its middle"
        reader.fault_at(_place(GUIDE, reader), problem, None, remedy)
    elif GUIDE in budget and GUIDE not in tolerances and f"budget.tolerances.{GUIDE}" not in reader.marks:
        problem, remedy = f"without tolerances.{GUIDE} it has no use", "leave it out"
        reader.fault_at(f"budget.{GUIDE}", problem, None, remedy)


def _check_play(values: Values, reader: Reader) -> None:
    """Note a limit of play for a follower that is not held from both sides."""
    # `held`: traits, or dimensions, of a follower held from both sides
    cam, held = values.get("cam", {}), {"swings", "breadth", LINKAGE, CONJUGATE}
    held_twice = held & {*_traits(reader), *dimension_names(_traits(reader))} or isinstance(cam.get("track"), dict)
    if "play" in values["budget"] and not held_twice:
        reader.fault_at("budget.play", "the follower is not held from both sides", None, "leave it out")


def _check_made(values: Values, reader: Reader) -> None:
    """Note a tolerance of the profile that is not half of `made.profile`, the zone for measured points."""
    profile, zone = values["budget"].get("tolerances", {}).get(PROFILE), values.get("made", {}).get("profile")
    if profile is None or zone is None or math.isclose(2.0 * profile, zone, rel_tol=1e-9):
        return
    own, line = join("budget.tolerances", PROFILE), reader.marks["made.profile"][0]
    problem = f"not half of made.profile, {zone / reader.mm:.9g} in line {line}, which is a zone"
    remedy = f"give {0.5 * zone / reader.mm:.9g}, or made.profile {2.0 * profile / reader.mm:.9g}"
    reader.fault_at(own, problem, f"{profile / reader.mm:.9g}", remedy)


def _check_fit(values: Values, reader: Reader) -> None:
    """Note a fit with a bore of no tolerance class or beyond the table, and a key without a fit or a keyway.

    A tolerance that the fit or the key states already is noted too.
    """
    budget, diameter = values["budget"], diameter_of(values.get("part", {}))
    tolerances = budget.get("tolerances", {})
    if "budget.fit" not in reader.marks:
        if "key" in budget:
            reader.fault_at("budget.key", "needs budget.fit, that of the shaft", None, "give fit: h6, or leave it out")
        return
    if "part.bore.fit" not in reader.marks:
        remedy = "give part.bore: {diameter: 20, fit: H7}, or leave it out"
        reader.fault_at("budget.fit", "the bore has no tolerance class", None, remedy)
        return
    if diameter is not None and diameter > UPPER_ENDS[-1]:
        most = f"{UPPER_ENDS[-1] / reader.mm:.6g} {reader.units}"
        problem, remedy = f"the table of fits reaches to {most}", f"leave it out, and give tolerances.{BORE}"
        reader.fault_at("budget.fit", problem, f"{diameter / reader.mm:.6g}", remedy)
        return
    if BORE in tolerances:
        reader.fault_at(_place(BORE, reader), "the fit says it already", None, "leave it out, or budget.fit")
    if "key" not in budget:
        return
    if "part.keyway" not in reader.marks:
        reader.fault_at("budget.key", "the part has no keyway", None, "give part.keyway: din6885, or leave it out")
    keyway, hub = values.get("part", {}).get("keyway", {}), budget["key"].get("hub")
    if "fit" in keyway and hub not in {None, keyway["fit"]}:
        problem = f"part.keyway.fit in line {reader.marks['part.keyway.fit'][0]} makes it {keyway['fit']}"
        remedy = f"give {keyway['fit']}, or part.keyway.fit: {hub}"
        reader.fault_at("budget.key.hub", problem, hub, remedy)
    if ANGLE in tolerances:
        remedy = "leave it out, or budget.key"
        reader.fault_at(_place(ANGLE, reader), "the play of the key says it already", None, remedy)


# --- the value --------------------------------------------------------------------------------------------------------


def build_budget(values: Values) -> Budget | None:
    """The budget of checked values; None for a recipe without `budget`."""
    if "budget" not in values:
        return None
    budget = values["budget"]
    fit = _fit(budget, values.get("part", {}))
    tolerances = dict(budget["tolerances"])
    if fit is not None:
        tolerances[BORE] = fit.bore
        tolerances |= {} if fit.angle is None else {ANGLE: fit.angle}
    stated = {name: tolerances[name] for name in DIMENSIONS if name in tolerances}
    zero = budget.get("zero", NO_ZERO)
    optional = {name: budget[name] for name in ("exponent", "play", GUIDE, "waves", "runs", "seed") if name in budget}
    return Budget(
        permitted=budget["permitted"],
        tolerances=tuple(stated.items()),
        cost=tuple(budget.get("cost", {}).items()),
        zero=None if zero == NO_ZERO else math.remainder(zero, 2.0 * math.pi) % (2.0 * math.pi),
        fit=fit,
        sums=budget.get("sum", "worst"),
        **optional,
    )


def _fit(budget: Values, part: Values) -> ShaftFit | None:
    """How far the cam may stand off its place by the fits of bore and key; None where no fit is stated."""
    if "fit" not in budget:
        return None
    bore, key = part["bore"], budget.get("key")
    if key is None:
        return fit_of(bore["diameter"], bore["fit"], budget["fit"])
    keyway = part["keyway"]
    row = key_for(bore["diameter"])
    width = keyway.get("width", row.width if row else None)
    return fit_of(bore["diameter"], bore["fit"], budget["fit"], (key["hub"], key["shaft"]), width)
