"""Faults of a sweep that show without any geometry: what it varies, how, and by which figures it judges."""

from __future__ import annotations

import math
from collections import Counter
from typing import TYPE_CHECKING

from camgeo.recipe.errors import shown, suggestion
from camgeo.recipe.source import scalars
from camgeo.recipe.spec import MOST_DESIGNS, Kind
from camgeo.recipe.table_figures import FIGURES, NEEDS, there
from camgeo.recipe.table_sweep import RANGE
from camgeo.recipe.tables import is_known

if TYPE_CHECKING:
    from camgeo.recipe.reader import Reader, Values

_VARIED = ("cam.", "linkage.")  # what figures depend on


def check_sweep(sweep: Values, reader: Reader) -> None:
    """Note the faults of a sweep that was read."""
    _figures(sweep, reader)
    axes: list[Values] = sweep.get("vary", [])
    design = [path for path in reader.numbers if path.startswith(_VARIED)]
    counts = Counter(id(scalar) for _, scalar in scalars(reader.source.root))
    shared = {path for path, scalar in scalars(reader.source.root) if counts[id(scalar)] > 1}
    for axis in axes:
        if axis["path"] not in design:
            _no_number(axis, design, reader)
        elif axis["path"] in shared:
            remedy = "write the number out wherever it is meant"
            reader.fault_at(axis["at"], "a number that an alias shares with other fields", None, remedy)
        else:
            _values(axis, reader)
    _method(sweep, axes, reader)


def _figures(sweep: Values, reader: Reader) -> None:
    limits: list[Values] = sweep.get("limits", [])
    asked = [(limit["at"], limit["figure"]) for limit in limits]
    if "rank" in sweep:
        asked.append(("sweep.rank", sweep["rank"]))
    for path, name in asked:
        needs = FIGURES[name].needs
        if not there(needs, reader.cam_kind, set(reader.marks)):
            remedy = f"give {NEEDS[needs]}, or take another figure"
            reader.fault_at(path, f"{name} needs {NEEDS[needs]}", None, remedy)


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
        reader.fault_at(at, "no number stands there", None, remedy)
    elif _is_absent(path, reader) and path.startswith(_VARIED):
        reader.fault_at(at, "the recipe gives it no value", None, "give it a value first, which the sweep replaces")
    else:
        reader.fault_at(
            at, "no such field", shown(path), suggestion(path, design) or f"give the path of a number{such}"
        )


def _is_absent(path: str, reader: Reader) -> bool:
    """Tell whether a field is known but not given, and not an entry that a given list does not have."""
    end = path.find("]")
    while end >= 0:
        entry = path[: end + 1]
        if entry not in reader.marks and entry[: entry.rfind("[")] in reader.marks:
            return False
        end = path.find("]", end + 1)
    return is_known(path, reader.cam_kind, reader.linkage_kind)


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
    ranges = [axis for axis in axes if "values" not in axis]
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
    designs = math.prod(len(axis["values"]) if "values" in axis else axis.get("steps", 1) for axis in axes)
    if designs > MOST_DESIGNS:
        remedy = f"at most {MOST_DESIGNS} are looked at; take fewer steps, or the method sobol with a count"
        reader.fault_at("sweep.vary", "too many designs", str(designs), remedy)
