"""The limits of a recipe: bounds of its figures."""

from __future__ import annotations

import math
from functools import partial
from typing import TYPE_CHECKING

from camgeo.recipe.figures import FIGURES, ON_RETURN, ON_RISE
from camgeo.recipe.words import words_of
from camgeo.schema.errors import suggestion
from camgeo.schema.fields import MOST, Field, FieldTable, Kind, OwnForm, either
from camgeo.schema.json_schema import table_schema
from camgeo.schema.yaml_source import Mapping, Sequence, describe, entries, join, keys
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from camgeo.recipe.design_figure import DesignFigure
    from camgeo.schema.fields import Schema
    from camgeo.schema.reader import Reader, Values
    from camgeo.schema.yaml_source import Node

MOST_LIFTS = 20  # lifts at which a recipe may bound one figure


@dataclass(frozen=True)
class Limit:
    """Bounds of a figure, as reported: angles in degrees, lengths in mm, rates per radian of shaft angle.

    `at_least` or `at_most` is None where there is no such bound. `rpm` is the speed, turns a minute, at which a figure
    in time is bounded, None for the recipe's speed. `at_lift` is the lift, mm, at which a figure of a lobe is taken,
    None for its usual lift. `key` is the path below `limits` of the upper bound where that is not the figure's own,
    such as pressure-angle.on_return, else empty. `place` is the limit's entry in a list of limits of the figure, such
    as duration[1], else empty.
    """

    figure: str
    at_least: float | None = None
    at_most: float | None = None
    rpm: float | None = None
    at_lift: float | None = None
    key: str = ""
    place: str = ""

    @property
    def lift(self) -> float:
        """Lift, mm, at which the figure of a lobe is bounded; 0 for other figures."""
        return (FIGURES[self.figure].at_lift or 0.0) if self.at_lift is None else self.at_lift

    def field(self, sense: str) -> str:
        """Path of the recipe's field of a bound; `sense` is at_least or at_most."""
        own = f"{self.place or self.figure}.{sense}"
        return f"limits.{self.key}" if self.key and sense == "at_most" else f"limits.{own}"


def bounds(figure: DesignFigure) -> FieldTable:
    """Table of the keys at_least and at_most of a figure, without the keys that only a recipe's own limits have."""
    return FieldTable(
        tuple(
            Field(name, Kind.NUMBER, about, at_least=-(MOST**2), at_most=MOST**2, unit=figure.kind)
            for name, about in (("at_least", "least value accepted"), ("at_most", "greatest value accepted"))
        )
    )


def own_bounds(name: str) -> FieldTable:
    """Table of the keys of a figure in a recipe's own `limits`; raises KeyError for a name of no figure."""
    figure = FIGURES[name]
    return FieldTable((*bounds(figure).fields, *figure.keys))


def limits_form(*, swept: bool) -> OwnForm[Reader]:
    """Form of limits by figures: a recipe's own, or with `swept` a sweep's, which has fewer figures and only bounds."""
    return OwnForm(
        "limits",
        "a mapping from figures to bounds, such as {transmission-angle: {at_least: 40}}",
        partial(_read_limits, swept),
        partial(_limits_schema, swept),
    )


def _read_limits(swept: bool, reader: Reader, field: Field, node: Node, path: str) -> list[Values] | None:
    """Read limits by the figures that they bound: lengths in mm, angles in degrees; None for what is no mapping."""
    if not isinstance(node, Mapping):
        reader.fault(node.mark, path, "not a mapping", describe(node), reader.wanted(field))
        return None
    nodes = entries(node)
    limits = []
    for name, key in keys(node).items():
        below = join(path, name)
        if name not in FIGURES or (swept and not FIGURES[name].swept):
            figures = tuple(figure for figure in figures_of(reader) if FIGURES[figure].swept or not swept)
            remedy = suggestion(name, figures) or f"the figures are {either(figures, 'and')}"
            reader.fault(key.mark, below, "unknown figure", None, remedy)
            continue
        value = nodes[name]
        if not swept and FIGURES[name].at_lift is not None and isinstance(value, Sequence):
            for i, item in enumerate(reader.items(_bounded(swept, name), value, below, MOST_LIFTS)):
                own = _read_limit(swept, reader, name, item, join(below, i))
                limits += [{**limit, "place": f"{name}[{i}]"} for limit in own]
        else:
            limits += _read_limit(swept, reader, name, value, below)
    return limits


def _bounded(swept: bool, name: str) -> Field:
    return Field("", Kind.TABLE, "", table=bounds(FIGURES[name]) if swept else own_bounds(name))


def _read_limit(swept: bool, reader: Reader, name: str, node: Node, path: str) -> list[Values]:
    """Read the bounds of one figure: one limit, or with on_return a limit of rise and of return; none after a fault."""
    faults = len(reader.errors)
    values = reader.field(_bounded(swept, name), node, path)
    if values is None or len(reader.errors) > faults:
        return []
    stated = {key: values.pop(key) for key in ("rpm", "at_lift") if key in values}
    on_return = values.pop("on_return", None)
    if not values and on_return is None:
        reader.fault(node.mark, path, "no bound", None, "give at_least, at_most or both")
    factor = reader.mm if reader.unit(FIGURES[name].kind) == reader.units else 1.0
    if values.get("at_least", -math.inf) > values.get("at_most", math.inf):
        none = "no design" if swept else "nothing"
        reader.fault_at(f"{path}.at_most", f"below at_least, so {none} is accepted", None, "exchange them")
    bounds_given = {bound: factor * value for bound, value in values.items()}
    if on_return is None:
        return [{"figure": name, "at": path, **bounds_given, **stated}]
    if "at_least" in values:
        reader.fault_at(f"{path}.at_least", "cannot be combined with on_return", None, "leave one of the two out")
        return []
    parts = ((ON_RISE, "at_most", bounds_given.get("at_most")), (ON_RETURN, "on_return", on_return))
    return [
        {"figure": figure, "at": path, "at_most": most, "key": f"{name}.{bound}"}
        for figure, bound, most in parts
        if most is not None
    ]


def _limits_schema(swept: bool, _: Field) -> Schema:
    known = {name: figure for name, figure in FIGURES.items() if figure.swept or not swept}
    tables = {name: bounds(figure) if swept else own_bounds(name) for name, figure in known.items()}
    limits = {name: {**table_schema(table), "minProperties": 1} for name, table in tables.items()}
    for name in () if swept else (name for name, figure in known.items() if figure.at_lift is not None):
        item = limits[name]  # one lift, or a list of them
        limits[name] = {**item, "type": ["object", "array"], "items": item, "minItems": 1, "maxItems": MOST_LIFTS}
    return {"type": "object", "properties": limits, "additionalProperties": False}


LIMITS = Field(
    "limits",
    Kind.OWN,
    "figures that must keep within bounds, each a check of its own, such as {pressure-angle: {at_most: 45}}",
    default="none",
    form=limits_form(swept=False),
)


def _given(reader: Reader) -> set[str]:
    """Paths of the fields that the recipe being read gives, and the words of its files."""
    return {*reader.marks, *words_of(reader.source.root)}


def figures_of(reader: Reader) -> tuple[str, ...]:
    """Names of the figures that the recipe being read has."""
    paths = _given(reader)
    return tuple(name for name, figure in FIGURES.items() if figure.needs.there(reader.offers, paths))


def check_limits(limits: list[Values], reader: Reader) -> None:
    """Note limits of figures that the recipe does not have, and two limits of one bound; `limits` as they were read."""
    paths, bounded = _given(reader), dict[tuple[str, str, float | None], str]()
    for limit in limits:
        name, figure = limit["figure"], FIGURES[limit["figure"]]
        for bound in ("at_least", "at_most"):
            bound_id = name, bound, limit.get("at_lift", figure.at_lift)
            if bound in limit and bounded.setdefault(bound_id, limit["at"]) != limit["at"]:
                general, path = sorted((bounded[bound_id], limit["at"]), key=len)
                reason = "at the same lift" if "place" in limit else "with on_return"
                reader.fault_at(path, f"{general} {reason} bounds it too", None, "leave one of the two out")
        # a key of a limit counts as the field that it replaces: rpm as dynamics.rpm
        defaults = {item.default for item in figure.keys if item.name in limit}
        if not figure.needs.there(reader.offers, paths | defaults):
            remedy = f"the figures of this recipe are {either(figures_of(reader), 'and')}"
            path, subject = limit["at"], name
            if "key" in limit:  # the bound on_return of another figure
                path, subject, remedy = (
                    f"{path}.on_return",
                    "on_return",
                    "give at_most alone, which holds on the return too",
                )
            reader.fault_at(path, f"{subject} needs {figure.needs.words}", None, remedy)


def build_limits(limits: list[Values]) -> tuple[Limit, ...]:
    """Build the limits from values of a recipe without faults."""
    values = ({name: value for name, value in limit.items() if name != "at"} for limit in limits)
    return tuple(Limit(**limit) for limit in values)
