"""A search among designs: what varies, the figures that limit and rank."""

from __future__ import annotations

import math
from collections import Counter
from typing import TYPE_CHECKING, Literal

from camgeo.recipe.figures import FIGURES, Figure
from camgeo.recipe.limits import Limit, build_limits, limits_form
from camgeo.schema.errors import shown, suggestion
from camgeo.schema.fields import Field, Form, Kind, Table, field_at
from camgeo.schema.json_schema import number_schema, table_schema
from camgeo.schema.yaml_source import Mapping, Scalar, Sequence, described, entries, is_empty, join, scalars
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from camgeo.recipe.recipe import Recipe
    from camgeo.schema.fields import Schema
    from camgeo.schema.reader import Reader, Values
    from camgeo.schema.yaml_source import Node

MOST_AXES = 20
MOST_VALUES = 1000  # listed for one axis
MOST_STEPS = 1_000_000  # of one axis
MOST_DESIGNS = 100_000_000


@dataclass(frozen=True)
class Axis:
    """One number or word that a sweep varies, by its path in the recipe; all values as the recipe writes them.

    `values` are those listed, or `words`; where there are none the axis runs from `low` to `high`, over a grid in
    `steps` values.
    """

    path: str
    low: float = 0.0
    high: float = 0.0
    steps: int | None = None
    values: tuple[float, ...] = ()
    words: tuple[str, ...] = ()


@dataclass(frozen=True)
class Sweep:
    """A search among designs: `count` of them, or of a grid (count None) every combination of the axes' values.

    `rank` is the figure to be best in, `keep` the number of best designs that become recipes, `angles` the number of
    angles at which a design is sampled, `refine` whether the best are polished.
    """

    vary: tuple[Axis, ...]
    method: Literal["grid", "random", "sobol"]
    count: int | None
    seed: int
    limits: tuple[Limit, ...]
    rank: str
    keep: int
    angles: int
    refine: bool


def varied(recipe: Recipe) -> tuple[Axis, ...]:
    """Give what the sweep of a recipe varies; nothing without one."""
    sweep = recipe.of(Sweep)
    return () if sweep is None else sweep.vary


def swept() -> dict[str, Figure]:
    """Give the figures that a sweep knows, by name."""
    return {name: figure for name, figure in FIGURES.items() if figure.swept}


def _range_of(unit: Kind | None) -> Table:
    """Give the table of a range of numbers of some kind."""
    steps = "number of values, both ends included; for a grid"
    return Table(
        (
            Field("from", Kind.NUMBER, "first value, as the recipe writes it", required=True, unit=unit),
            Field("to", Kind.NUMBER, "last value", required=True, unit=unit),
            Field("steps", Kind.INTEGER, steps, at_least=2, at_most=MOST_STEPS),
        )
    )


RANGE = _range_of(None)


def read_vary(reader: Reader, field: Field, node: Node, path: str) -> list[Values] | None:
    """Read the axes of a sweep as they stand, each with the path of its number and its own place (`at`).

    Whether there is a number at that path shows only when the whole recipe has been read.
    """
    if not isinstance(node, Mapping):
        reader.fault(node.mark, path, "not a mapping", described(node), reader.wanted(field))
        return None
    given = entries(node)
    if not given:
        reader.fault(node.mark, path, "nothing varies", None, reader.wanted(field))
        return None
    if len(given) > MOST_AXES:
        reader.fault(node.mark, path, f"more than {MOST_AXES} axes", str(len(given)), "leave some out")
        return None
    axes = []
    for name, below in ((name, join(path, name)) for name in given):
        listed = _words(reader, given[name], name, below)
        axis = {"words": listed} if listed else _axis(reader, given[name], below, _varied(reader, name))
        if axis is not None:
            axes.append({"path": name, "at": below, **axis})
    return axes


def _varied(reader: Reader, path: str) -> Kind:
    """Say what the number at a path is, whose unit its values may carry; a length where the path itself is at fault."""
    field = reader.numbers.get(path) or field_at(reader.root, path, reader.kinds)
    return Kind.LENGTH if field is None else field.unit or field.kind


def _words(reader: Reader, node: Node, path: str, place: str) -> tuple[str, ...]:
    """Give the words of a list for a field that holds one; none where it is no such list, or no such field."""
    if not isinstance(node, Sequence) or path in reader.numbers:
        return ()
    if path not in dict(scalars(reader.source.root)):
        return ()
    words = [item.text for item in node.items if isinstance(item, Scalar) and not is_empty(item)]
    reader.marks.update({join(place, i): item.mark for i, item in enumerate(node.items)})
    return tuple(words) if len(words) == len(node.items) <= MOST_VALUES else ()


def _axis(reader: Reader, node: Node, path: str, unit: Kind) -> Values | None:
    """Read a range or a list of values of a number of some kind, as the recipe writes them."""
    either_way = Field("", Kind.OWN, "", form=_AXIS)
    if isinstance(node, Sequence):
        items = reader.items(either_way, node, path, MOST_VALUES)
        part = Field("", Kind.NUMBER, "", unit=unit)
        values = [reader.field(part, item, join(path, i)) for i, item in enumerate(items)]
        return {"values": tuple(values)} if values and None not in values else None
    if not isinstance(node, Mapping):
        reader.fault(node.mark, path, "not a range", described(node), reader.wanted(either_way))
        return None
    read = reader.table(_range_of(unit), node, path)
    return read if {"from", "to"} <= read.keys() else None


def _vary_schema(_: Field) -> Schema:
    items = {"anyOf": [number_schema(unit=Kind.MOTION), {"type": "string"}]}
    values = {"type": "array", "items": items, "minItems": 1, "maxItems": MOST_VALUES}
    axis = {"anyOf": [table_schema(_range_of(Kind.MOTION)), values]}
    return {"type": "object", "additionalProperties": axis, "minProperties": 1, "maxProperties": MOST_AXES}


_VARY = Form(
    "what varies",
    "a mapping from paths to ranges, such as {linkage.rocker: {from: 95, to: 110, steps: 16}}",
    read_vary,
    _vary_schema,
)
_AXIS = Form("a range", "a range such as {from: 95, to: 110, steps: 16}, or a list of values", read_vary, _vary_schema)


def fields() -> tuple[Field, ...]:
    """Give the key `sweep` of a recipe."""
    return (
        Field(
            "sweep",
            Kind.TABLE,
            "a search among designs",
            after="dwell",
            table=Table(
                (
                    Field(
                        "vary",
                        Kind.OWN,
                        "numbers and words of cam and linkage by their paths, each with its range or values",
                        required=True,
                        form=_VARY,
                    ),
                    Field(
                        "method",
                        Kind.CHOICE,
                        "how the designs are chosen",
                        default="grid",
                        choices=("grid", "random", "sobol"),
                    ),
                    Field("count", Kind.INTEGER, "number of designs; not for a grid", at_least=1, at_most=MOST_DESIGNS),
                    Field("seed", Kind.INTEGER, "seed of random and sobol", default="0", at_least=0, at_most=2**32 - 1),
                    Field(
                        "limits",
                        Kind.OWN,
                        "figures that a design must keep within bounds",
                        default="none",
                        form=limits_form(swept=True),
                    ),
                    Field(
                        "rank",
                        Kind.CHOICE,
                        "figure by which the designs are ranked",
                        required=True,
                        choices=tuple(swept()),
                    ),
                    Field(
                        "keep",
                        Kind.INTEGER,
                        "number of best designs that become recipes",
                        default="10",
                        at_least=1,
                        at_most=1000,
                    ),
                    Field(
                        "angles",
                        Kind.INTEGER,
                        "number of angles at which a design is sampled",
                        default="360",
                        at_least=24,
                        at_most=36_000,
                    ),
                    Field("refine", Kind.TRUTH, "whether the best designs are polished, off the grid", default="false"),
                )
            ),
        ),
    )


_VARIED = ("cam.", "linkage.")  # what figures depend on


def check_sweep(values: Values, reader: Reader) -> None:
    """Note the faults of the sweep of a recipe, where there is one that was read."""
    sweep: Values | None = values.get("sweep")
    if sweep is None:
        return
    _figures(sweep, reader)
    axes: list[Values] = sweep.get("vary", [])
    design = [path for path in reader.numbers if path.startswith(_VARIED)]
    counts = Counter(id(scalar) for _, scalar in scalars(reader.source.root))
    shared = {path for path, scalar in scalars(reader.source.root) if counts[id(scalar)] > 1}
    for axis in axes:
        path = axis["path"]
        if "words" in axis and path.startswith(_VARIED) and path not in shared:
            _listed(axis, reader)
        elif path not in design and not (path in shared and "words" in axis):
            _no_number(axis, design, reader)
        elif path in shared:
            remedy = "write the number out wherever it is meant"
            reader.fault_at(axis["at"], "a number that an alias shares with other fields", None, remedy)
        else:
            _values(axis, reader)
    _method(sweep, axes, reader)


def _listed(axis: Values, reader: Reader) -> None:
    """Note words that stand twice, and those of the fields that say which other keys there are."""
    path, words = axis["path"], axis["words"]
    if path.endswith(("cam.kind", "linkage.kind")):
        reader.fault_at(axis["at"], f"another {path[:-5]} has other keys", None, "give it a recipe of its own")
    for i, word in enumerate(words):
        if word in words[:i]:
            reader.fault_at(f"{axis['at']}[{i}]", "listed twice", shown(word), "leave one of the two out")


def _figures(sweep: Values, reader: Reader) -> None:
    limits: list[Values] = sweep.get("limits", [])
    asked = [(limit["at"], limit["figure"]) for limit in limits]
    if "rank" in sweep:
        asked.append(("sweep.rank", sweep["rank"]))
    given = set(reader.marks) - ({"part.density"} if "linkage" in reader.marks else set())  # designs are not weighed
    for path, name in asked:
        needs = FIGURES[name].needs
        if not needs.there(reader.offers, given):
            remedy = f"give {needs.words}, or take another figure"
            reader.fault_at(path, f"{name} needs {needs.words}", None, remedy)


def _no_number(axis: Values, design: list[str], reader: Reader) -> None:
    """Say why there is nothing to vary at a path."""
    path, at = axis["path"], axis["at"]
    if any(error.path == path for error in reader.errors):  # a number, but a faulty one
        return
    such = f", such as {design[0]}" if design else ""
    if path in reader.numbers:
        reader.fault_at(at, "no figure of a design depends on it", None, f"vary numbers of cam and linkage{such}")
    elif path in reader.marks:
        within = next((one for one in design if one.startswith((f"{path}.", f"{path}["))), None)
        remedy = f"give the path of a number in it, such as {within}" if within else f"give the path of a number{such}"
        if path in dict(scalars(reader.source.root)) and path.startswith(_VARIED):
            remedy = "list the words that it takes, such as [cycloidal, modified-sine]"
        reader.fault_at(at, "no number stands there", None, remedy)
    elif _is_absent(path, reader) and path.startswith(_VARIED):
        reader.fault_at(at, "the recipe gives it no value", None, "give it a value first, which the sweep replaces")
    else:
        reader.fault_at(
            at, "unknown field", shown(axis["path"]), suggestion(path, design) or f"give the path of a number{such}"
        )


def _is_absent(path: str, reader: Reader) -> bool:
    """Tell whether a field is known but not given, and not an entry that a given list does not have."""
    end = path.find("]")
    while end >= 0:
        entry = path[: end + 1]
        if entry not in reader.marks and entry[: entry.rfind("[")] in reader.marks:
            return False
        end = path.find("]", end + 1)
    return field_at(reader.root, path, reader.kinds) is not None


def _values(axis: Values, reader: Reader) -> None:
    """Note values that the field itself would refuse."""
    path, at = axis["path"], axis["at"]
    field = reader.numbers[path]
    whole = field.kind is Kind.INTEGER
    if "values" in axis:
        given = {f"{at}[{i}]": value for i, value in enumerate(axis["values"])}
    else:
        given = {f"{at}.{end}": axis[end] for end in ("from", "to")}
        if axis["from"] >= axis["to"]:
            remedy = "give a greater number, or a list of values"
            reader.fault_at(f"{at}.to", "not above `from`", f"{axis['to']:.10g}", remedy)
        if whole:
            reader.fault_at(at, f"{path} takes whole numbers alone", None, "list them, such as [3, 5, 7]")
            return
    for place, value in given.items():
        problem = "not a whole number" if whole and value != math.floor(value) else field.out_of_bounds(value)
        if problem:
            reader.fault_at(place, problem, f"{value:.10g}", f"{path} takes {field.wanted()}")


def _method(sweep: Values, axes: list[Values], reader: Reader) -> None:
    """Note what the method lacks and what it has no use for, and a grid with too many designs."""
    method = sweep.get("method", "grid")
    if "sweep.method" in reader.marks and "method" not in sweep:
        return
    ranges = [axis for axis in axes if not {"values", "words"} & axis.keys()]
    if method != "grid":
        if "sweep.count" not in reader.marks:
            reader.fault_at("sweep", f"{method} needs count", None, "give the number of designs, such as count: 1000")
        for axis in ranges:
            if "steps" in axis:
                reader.fault_at(f"{axis['at']}.steps", f"{method} has no steps", None, "leave it out, or take a grid")
        return
    for name in ("count", "seed"):
        if f"sweep.{name}" in reader.marks:
            remedy = "leave it out, or take the method random or sobol"
            reader.fault_at(f"sweep.{name}", f"a grid has no {name}", None, remedy)
    for axis in ranges:
        if "steps" not in axis and f"{axis['at']}.steps" not in reader.marks:
            remedy = f"{reader.wanted(RANGE.field('steps'))}, or take the method random or sobol"
            reader.fault_at(axis["at"], "a grid needs steps", None, remedy)
    listed = (axis.get("values") or axis.get("words") for axis in axes)
    designs = math.prod(len(each) if each else axis.get("steps", 1) for each, axis in zip(listed, axes, strict=True))
    if designs > MOST_DESIGNS:
        remedy = f"at most {MOST_DESIGNS} are looked at; take fewer steps, or the method sobol with a count"
        reader.fault_at("sweep.vary", "too many designs", str(designs), remedy)


KEEP = 10  # designs of a sweep


SAMPLES = 360  # angles at which a sweep looks at a design


def build_sweep(values: Values) -> Sweep | None:
    """Make the sweep of a recipe's values in which there is no fault, where there is one."""
    sweep: Values | None = values.get("sweep")
    if sweep is None:
        return None
    return Sweep(
        vary=tuple(map(_range, sweep["vary"])),
        method=sweep.get("method", "grid"),
        count=sweep.get("count"),
        seed=sweep.get("seed", 0),
        limits=build_limits(sweep.get("limits", [])),
        rank=sweep["rank"],
        keep=sweep.get("keep", KEEP),
        angles=sweep.get("angles", SAMPLES),
        refine=sweep.get("refine", False),
    )


def _range(axis: Values) -> Axis:
    if "values" in axis:
        return Axis(axis["path"], values=axis["values"])
    if "words" in axis:
        return Axis(axis["path"], words=axis["words"])
    return Axis(axis["path"], axis["from"], axis["to"], axis.get("steps"))
