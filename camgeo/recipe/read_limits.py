"""Reading limits of figures, those of the recipe and those that the designs of a sweep keep."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from camgeo.recipe.errors import suggestion
from camgeo.recipe.source import Mapping, described, entries, join, keys, scalars
from camgeo.recipe.spec import Field, Kind, either
from camgeo.recipe.table_figures import ALL, FIGURES, LIMITS, NEEDS, bounds, there

if TYPE_CHECKING:
    from camgeo.recipe.reader import Reader, Values
    from camgeo.recipe.source import Node


def read_limits(reader: Reader, field: Field, node: Node, path: str) -> list[Values] | None:
    """Read limits by the figures that they bound, those in `field.choices`; lengths in mm, angles in degrees."""
    if not isinstance(node, Mapping):
        reader.fault(node.mark, path, "not a mapping", described(node), reader.wanted(field))
        return None
    given = entries(node)
    limits = []
    for name, key in keys(node).items():
        below = join(path, name)
        if name not in field.choices:
            known = tuple(here for here in of_recipe(reader) if here in field.choices)
            remedy = suggestion(name, known) or f"the figures are {either(known, 'and')}"
            reader.fault(key.mark, below, "no such figure", None, remedy)
            continue
        table = Field("", Kind.TABLE, "", table=bounds(FIGURES[name]))
        found = len(reader.errors)
        values = reader.field(table, given[name], below)
        if values is None or len(reader.errors) > found:
            continue
        if not values:
            reader.fault(given[name].mark, below, "no bound", None, "give at_least, at_most or both")
        factor = reader.mm if reader.unit(FIGURES[name].kind) == reader.units else 1.0
        if values.get("at_least", -math.inf) > values.get("at_most", math.inf):
            told = "no design" if field is not LIMITS else "nothing"
            reader.fault_at(f"{below}.at_most", f"below at_least, so {told} will do", None, "exchange them")
        limits.append({"figure": name, "at": below, **{bound: factor * value for bound, value in values.items()}})
    return limits


def of_recipe(reader: Reader) -> tuple[str, ...]:
    """Name the figures that the recipe being read has."""
    given = set(reader.marks)
    if any(path.endswith(".parts") and scalar.text == "all" for path, scalar in scalars(reader.source.root)):
        given.add(ALL)
    return tuple(name for name, figure in FIGURES.items() if there(figure.needs, reader.cam_kind, given))


def check_limits(limits: list[Values], reader: Reader) -> None:
    """Note limits of figures that the recipe has not."""
    here = of_recipe(reader)
    for limit in limits:
        name, needs = limit["figure"], FIGURES[limit["figure"]].needs
        if needs and name not in here:
            remedy = f"the figures of this recipe are {either(here, 'and')}"
            reader.fault_at(limit["at"], f"{name} needs {NEEDS[needs]}", None, remedy)
