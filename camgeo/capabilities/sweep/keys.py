"""A search among designs: what varies, the figures that limit and rank."""

from __future__ import annotations

import math
from collections import Counter
from functools import cached_property
from typing import TYPE_CHECKING, Literal

from camgeo.recipe.figures import FIGURES
from camgeo.recipe.limits import Limit, build_limits, limits_form
from camgeo.schema.errors import quote, suggestion
from camgeo.schema.fields import Field, FieldTable, Kind, OwnForm, field_at
from camgeo.schema.json_schema import number_schema, table_schema
from camgeo.schema.yaml_source import Mapping, Scalar, Sequence, describe, entries, is_empty, join, scalars
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from camgeo.recipe.design_figure import DesignFigure
    from camgeo.recipe.recipe import Recipe
    from camgeo.schema.fields import Schema
    from camgeo.schema.reader import Reader, Values
    from camgeo.schema.yaml_source import Node

MOST_AXES = 20
MOST_VALUES = 1000  # listed for one axis
MOST_STEPS = 1_000_000  # of one axis
MOST_DESIGNS = 100_000_000
KEEP = 10  # best designs, where the recipe gives no number
SAMPLES = 360  # angles of a design, likewise
_VARIABLE = ("cam.", "linkage.")  # sections that figures depend on


@dataclass(frozen=True)
class Axis:
    """Varied field of a sweep, by its path in the recipe; all values in the recipe's units.

    It takes the `listed` values or `words`; without any it runs from `low` to `high`, in a grid in `steps` values.
    """

    path: str
    low: float
    high: float
    listed: tuple[float, ...] = ()
    words: tuple[str, ...] = ()
    steps: int | None = None

    @cached_property
    def values(self) -> tuple[float, ...]:
        """Values of the axis, both ends exact; indices of words; empty for a range without steps."""
        import numpy as np

        if self.words:
            return tuple(map(float, range(len(self.words))))
        return self.listed or tuple(np.linspace(self.low, self.high, self.steps or 0).tolist())

    @property
    def is_range(self) -> bool:
        """Whether the values between the ends are allowed too."""
        return not (self.listed or self.words)

    @property
    def range(self) -> float:
        """Difference of the ends, the unit of distances between values; 1 for words, so that they lie apart."""
        return 1.0 if self.words else abs(self.high - self.low)

    def written(self, value: float) -> float | str:
        """The value as the recipe writes it: a number, or the word with this index."""
        return self.words[int(value)] if self.words else value


@dataclass(frozen=True)
class Sweep:
    """A search among designs: `count` of them, or in a grid (count None) every combination of the fields' values.

    `rank` is the figure by which designs are ranked, `keep` the number of best designs that become recipes, `angles`
    the number of angles at which a design is sampled, `refine` whether the best are polished.
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


def varied_fields(recipe: Recipe) -> tuple[Axis, ...]:
    """Fields that the sweep of a recipe varies; none without a sweep."""
    sweep = recipe.of(Sweep)
    return () if sweep is None else sweep.vary


def sweep_figures() -> dict[str, DesignFigure]:
    """Figures by which designs can be limited and ranked, by name."""
    return {name: figure for name, figure in FIGURES.items() if figure.swept}


def _range_table(unit: Kind | None) -> FieldTable:
    """Keys of a range: `from`, `to` and `steps`, its ends numbers with a unit of this kind."""
    steps = "number of values, both ends included; for a grid"
    return FieldTable(
        (
            Field("from", Kind.NUMBER, "first value, as the recipe writes it", required=True, unit=unit),
            Field("to", Kind.NUMBER, "last value", required=True, unit=unit),
            Field("steps", Kind.INTEGER, steps, at_least=2, at_most=MOST_STEPS),
        )
    )


RANGE = _range_table(None)


def read_vary(reader: Reader, field: Field, node: Node, path: str) -> list[Values] | None:
    """Axes of a sweep as written, each with the `path` of its field and its own place (`at`).

    An axis has besides `words`, `values` or the keys of a range; a faulty one is left out. None where there is no
    mapping, or one with no or too many entries. Faults are added to the reader's. Whether a number stands at that path
    is checked in `check_sweep`, once the whole recipe has been read.
    """
    if not isinstance(node, Mapping):
        reader.fault(node.mark, path, "not a mapping", describe(node), reader.wanted(field))
        return None
    nodes = entries(node)
    if not nodes:
        reader.fault(node.mark, path, "nothing varies", None, reader.wanted(field))
        return None
    if len(nodes) > MOST_AXES:
        reader.fault(node.mark, path, f"more than {MOST_AXES} axes", str(len(nodes)), "leave some out")
        return None
    axes = []
    for name, entry in nodes.items():
        place = join(path, name)
        words = _read_words(reader, entry, name, place)
        varied = reader.numbers.get(name) or field_at(reader.root, name, reader.kinds)
        kind = Kind.LENGTH if varied is None else varied.unit or varied.kind  # without a field the path is at fault
        axis = {"words": words} if words else _read_numbers(reader, entry, place, kind)
        if axis is not None:
            axes.append({"path": name, "at": place, **axis})
    return axes


def _read_words(reader: Reader, node: Node, path: str, place: str) -> tuple[str, ...]:
    """Words listed for a field that holds a word; empty for another node or field, or too many entries."""
    if not isinstance(node, Sequence) or path in reader.numbers or path not in dict(scalars(reader.source.root)):
        return ()
    words = [item.text for item in node.items if isinstance(item, Scalar) and not is_empty(item)]
    reader.marks.update({join(place, i): item.mark for i, item in enumerate(node.items)})
    return tuple(words) if len(words) == len(node.items) <= MOST_VALUES else ()


def _read_numbers(reader: Reader, node: Node, path: str, unit: Kind) -> Values | None:
    """A range, or a tuple `values`, of numbers with a unit of this kind, in the recipe's units; None after a fault."""
    range_or_list = Field("", Kind.OWN, "", form=_AXIS)
    if isinstance(node, Sequence):
        items = reader.items(range_or_list, node, path, MOST_VALUES)
        number = Field("", Kind.NUMBER, "", unit=unit)
        values = [reader.field(number, item, join(path, i)) for i, item in enumerate(items)]
        return {"values": tuple(values)} if values and None not in values else None
    if not isinstance(node, Mapping):
        reader.fault(node.mark, path, "not a range", describe(node), reader.wanted(range_or_list))
        return None
    axis = reader.table(_range_table(unit), node, path)
    return axis if {"from", "to"} <= axis.keys() else None


def _vary_schema(_: Field) -> Schema:
    items = {"anyOf": [number_schema(unit=Kind.MOTION), {"type": "string"}]}
    values = {"type": "array", "items": items, "minItems": 1, "maxItems": MOST_VALUES}
    axis = {"anyOf": [table_schema(_range_table(Kind.MOTION)), values]}
    return {"type": "object", "additionalProperties": axis, "minProperties": 1, "maxProperties": MOST_AXES}


_VARY = OwnForm(
    "what varies",
    "a mapping from paths to ranges, such as {linkage.rocker: {from: 95, to: 110, steps: 16}}",
    read_vary,
    _vary_schema,
)
_AXIS = OwnForm(
    "a range", "a range such as {from: 95, to: 110, steps: 16}, or a list of values", read_vary, _vary_schema
)


def fields() -> tuple[Field, ...]:
    """The key `sweep` of a recipe, with the keys below it."""
    vary = "numbers and words of cam and linkage by their paths, each with its range or values"
    methods, figures = ("grid", "random", "sobol"), tuple(sweep_figures())
    limits, best = "figures that a design must keep within bounds", "number of best designs that become recipes"
    angles = "number of angles at which a design is sampled"
    table = (
        Field("vary", Kind.OWN, vary, required=True, form=_VARY),
        Field("method", Kind.CHOICE, "how the designs are chosen", default="grid", choices=methods),
        Field("count", Kind.INTEGER, "number of designs; not for a grid", at_least=1, at_most=MOST_DESIGNS),
        Field("seed", Kind.INTEGER, "seed of random and sobol", default="0", at_least=0, at_most=2**32 - 1),
        Field("limits", Kind.OWN, limits, default="none", form=limits_form(swept=True)),
        Field("rank", Kind.CHOICE, "figure by which the designs are ranked", required=True, choices=figures),
        Field("keep", Kind.INTEGER, best, default=f"{KEEP}", at_least=1, at_most=1000),
        Field("angles", Kind.INTEGER, angles, default=f"{SAMPLES}", at_least=24, at_most=36_000),
        Field("refine", Kind.TRUTH, "whether the best designs are polished, off the grid", default="false"),
    )
    return (Field("sweep", Kind.TABLE, "a search among designs", after="dwell", table=FieldTable(table)),)


def check_sweep(values: Values, reader: Reader) -> None:
    """Add the faults of a recipe's sweep to the reader's errors; nothing without a sweep that could be read."""
    sweep: Values | None = values.get("sweep")
    if sweep is None:
        return
    _check_figures(sweep, reader)
    axes: list[Values] = sweep.get("vary", [])
    numbers = [path for path in reader.numbers if path.startswith(_VARIABLE)]
    counts = Counter(id(scalar) for _, scalar in scalars(reader.source.root))
    shared = {path for path, scalar in scalars(reader.source.root) if counts[id(scalar)] > 1}
    for axis in axes:
        path = axis["path"]
        if "words" in axis and path.startswith(_VARIABLE) and path not in shared:
            _check_words(axis, reader)
        elif path not in numbers and not (path in shared and "words" in axis):
            _report_absent(axis, numbers, reader)
        elif path in shared:
            remedy = "write the number out wherever it is meant"
            reader.fault_at(axis["at"], "a number that an alias shares with other fields", None, remedy)
        else:
            _check_values(axis, reader)
    _check_method(sweep, axes, reader)


def _check_words(axis: Values, reader: Reader) -> None:
    """Note words listed twice, and fields on which other keys depend: the kinds of cam and linkage."""
    path, words = axis["path"], axis["words"]
    if path.endswith(("cam.kind", "linkage.kind")):
        reader.fault_at(axis["at"], f"another {path[:-5]} has other keys", None, "give it a recipe of its own")
    for i, word in enumerate(words):
        if word in words[:i]:
            reader.fault_at(f"{axis['at']}[{i}]", "listed twice", quote(word), "leave one of the two out")


def _check_figures(sweep: Values, reader: Reader) -> None:
    """Note figures of `limits` and `rank` that the recipe's designs do not have."""
    limits: list[Values] = sweep.get("limits", [])
    figures = [(limit["at"], limit["figure"]) for limit in limits]
    if "rank" in sweep:
        figures.append(("sweep.rank", sweep["rank"]))
    weighed = "linkage" not in reader.marks  # designs with a linkage have no mass
    fields = set(reader.marks) if weighed else set(reader.marks) - {"part.density"}
    for path, name in figures:
        needs = FIGURES[name].needs
        if not needs.there(reader.offers, fields):
            remedy = f"give {needs.words}, or take another figure"
            reader.fault_at(path, f"{name} needs {needs.words}", None, remedy)


def _report_absent(axis: Values, numbers: list[str], reader: Reader) -> None:
    """Note why nothing can be varied at a path; `numbers` are the paths of those that can."""
    path, place = axis["path"], axis["at"]
    if any(error.path == path for error in reader.errors):  # a number, but a faulty one
        return
    such = f", such as {numbers[0]}" if numbers else ""
    if path in reader.numbers:
        reader.fault_at(place, "no figure of a design depends on it", None, f"vary numbers of cam and linkage{such}")
    elif path in reader.marks:
        within = next((number for number in numbers if number.startswith((f"{path}.", f"{path}["))), None)
        remedy = f"give the path of a number in it, such as {within}" if within else f"give the path of a number{such}"
        if path in dict(scalars(reader.source.root)) and path.startswith(_VARIABLE):
            remedy = "list the words that it takes, such as [cycloidal, modified-sine]"
        reader.fault_at(place, "no number stands there", None, remedy)
    elif _is_absent(path, reader) and path.startswith(_VARIABLE):
        reader.fault_at(place, "the recipe gives it no value", None, "give it a value first, which the sweep replaces")
    else:
        remedy = suggestion(path, numbers) or f"give the path of a number{such}"
        reader.fault_at(place, "unknown field", quote(path), remedy)


def _is_absent(path: str, reader: Reader) -> bool:
    """Whether a path without a value is that of a known field; False for an entry beyond the end of a list."""
    end = path.find("]")
    while end >= 0:
        entry = path[: end + 1]
        if entry not in reader.marks and entry[: entry.rfind("[")] in reader.marks:
            return False
        end = path.find("]", end + 1)
    return field_at(reader.root, path, reader.kinds) is not None


def _check_values(axis: Values, reader: Reader) -> None:
    """Note values that the varied field itself refuses, and ranges that do not rise."""
    path, entry = axis["path"], axis["at"]
    field = reader.numbers[path]
    whole = field.kind is Kind.INTEGER
    if "values" in axis:
        values = {f"{entry}[{i}]": value for i, value in enumerate(axis["values"])}
    else:
        values = {f"{entry}.{end}": axis[end] for end in ("from", "to")}
        if axis["from"] >= axis["to"]:
            remedy = "give a greater number, or a list of values"
            reader.fault_at(f"{entry}.to", "not above `from`", f"{axis['to']:.10g}", remedy)
        if whole:
            reader.fault_at(entry, f"{path} takes whole numbers alone", None, "list them, such as [3, 5, 7]")
            return
    for place, value in values.items():
        problem = "not a whole number" if whole and value != math.floor(value) else field.out_of_bounds(value)
        if problem:
            reader.fault_at(place, problem, f"{value:.10g}", f"{path} takes {field.wanted()}")


def _check_method(sweep: Values, axes: list[Values], reader: Reader) -> None:
    """Note keys that the method lacks or does not take, and a grid with too many designs."""
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
    lists = (axis.get("values") or axis.get("words") for axis in axes)
    designs = math.prod(
        len(values) if values else axis.get("steps", 1) for values, axis in zip(lists, axes, strict=True)
    )
    if designs > MOST_DESIGNS:
        remedy = f"at most {MOST_DESIGNS} are looked at; take fewer steps, or the method sobol with a count"
        reader.fault_at("sweep.vary", "too many designs", str(designs), remedy)


def build_sweep(values: Values) -> Sweep | None:
    """The sweep of a recipe without faults, lengths in the recipe's units; None without the key."""
    sweep: Values | None = values.get("sweep")
    if sweep is None:
        return None
    return Sweep(
        vary=tuple(map(_axis, sweep["vary"])),
        method=sweep.get("method", "grid"),
        count=sweep.get("count"),
        seed=sweep.get("seed", 0),
        limits=build_limits(sweep.get("limits", [])),
        rank=sweep["rank"],
        keep=sweep.get("keep", KEEP),
        angles=sweep.get("angles", SAMPLES),
        refine=sweep.get("refine", False),
    )


def _axis(axis: Values) -> Axis:
    if words := axis.get("words"):
        return Axis(axis["path"], 0.0, len(words) - 1.0, words=words)
    if listed := axis.get("values"):
        return Axis(axis["path"], min(listed), max(listed), listed)
    return Axis(axis["path"], axis["from"], axis["to"], steps=axis.get("steps"))
