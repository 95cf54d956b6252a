"""Reading a recipe's tree by the schema: values converted, every fault noted with its place."""

from __future__ import annotations

import math
from contextlib import suppress
from typing import TYPE_CHECKING, Any, TypeAlias

from camgeo.schema.errors import RecipeError, shown, suggestion
from camgeo.schema.fields import Field, Kind, Table, either, elsewhere, of_other_kind
from camgeo.schema.quantity import parted
from camgeo.schema.scalars import Complaint, read_number
from camgeo.schema.yaml_source import (
    Mapping,
    Scalar,
    Sequence,
    described,
    entries,
    is_empty,
    join,
    keys,
)

if TYPE_CHECKING:
    import collections.abc
    from collections.abc import Callable

    from camgeo.schema.yaml_source import Mark, Node, Source

# A mapping read by its table: fields that are absent or faulty are left out. What a field holds is settled by its kind.
Values: TypeAlias = dict[str, Any]
# How each kind of field is read; a reader of a kind gives None for what is faulty, and has noted the fault.
Readers: TypeAlias = "collections.abc.Mapping[Kind, Callable[[Reader, Field, Node, str], Any]]"

_LENGTHS = (Kind.LENGTH, Kind.STROKE, Kind.ERROR, Kind.OUTPUT, Kind.MOTION, Kind.BACKLASH)  # unless it is an angle


# Their units, and those of what turns.
_SI = {
    Kind.FORCE: ("N", "N"),
    Kind.MOMENT: ("N m", "N m"),
    Kind.RATE: ("N/m", "N/m"),
    Kind.PRESSURE: ("N/mm^2", "N/mm^2"),
    Kind.MASS: ("kg", "kg"),
    Kind.THRUST: ("N", "N m"),
    Kind.GIVING: ("N/m", "N m/rad"),
    Kind.INERTIA: ("kg", "kg m²"),
}


class Reader:
    """Reads one recipe; what it has found grows as it does.

    `root` is the table of the whole recipe. `errors`; `marks` of every field given and `numbers`, the fields of every
    number given, by path. Further what decides how other fields read, which whoever reads the recipe finds first: its
    unit, the `kinds` of its mappings with kinds, the kinds of field that hold an angle, and what figures its cam
    offers.
    """

    def __init__(self, source: Source, readers: Readers, root: Table) -> None:
        self.source = source
        self.readers = readers
        self.root = root
        self.errors: list[RecipeError] = []
        self.marks: dict[str, Mark] = {}
        self.numbers: dict[str, Field] = {}
        self.units = "mm"
        self.mm = 1.0
        self.kinds: dict[str, str] = {}
        self.angular = {Kind.ANGLE}
        self.offers: frozenset[str] = frozenset()

    # --- faults ------------------------------------------------------------------------------------------------------

    def fault(self, mark: Mark, path: str, problem: str, value: str | None = None, remedy: str = "") -> None:
        """Note a fault."""
        self.errors.append(RecipeError(self.source.file, *mark, path, problem, value, remedy))

    def fault_at(self, path: str, problem: str, value: str | None = None, remedy: str = "") -> None:
        """Note a fault of a field that was given."""
        self.fault(self.marks[path], path, problem, value, remedy)

    def wanted(self, field: Field) -> str:
        """Say what would do for a field, with its unit: `give a length above 0 in mm`."""
        unit = self.unit(field.unit or field.kind)
        return f"give {field.wanted()}{f' in {unit}' if unit else ''}"

    def unit(self, kind: Kind) -> str:
        """Name the unit of a kind of field as written."""
        if kind in self.angular:
            return "degrees"
        if kind is Kind.AREA:
            return f"square {self.units}"
        if kind in _SI:
            return _SI[kind][Kind.MOTION in self.angular]
        return self.units if kind in {Kind.POINT, Kind.PAIR, *_LENGTHS} else ""

    def scale(self, kind: Kind) -> float:
        """Factor from a number as written to mm, mm^2 or radians."""
        if kind in self.angular:
            return math.pi / 180
        return {**dict.fromkeys(_LENGTHS, self.mm), Kind.AREA: self.mm**2}.get(kind, 1.0)

    # --- tables ------------------------------------------------------------------------------------------------------

    def survey(self, node: Node, path: str) -> None:
        """Note where every field stands, and what YAML allows but a recipe does not."""
        self.marks.setdefault(path, node.mark)
        if node.tag is not None:
            self.fault(node.mark, path, "a YAML tag", shown(node.tag), "leave it out; the field says how it is read")
        if isinstance(node, Sequence):
            for i, item in enumerate(node.items):
                self.survey(item, join(path, i))
        elif isinstance(node, Mapping):
            lines: dict[str, int] = {}
            for key, value in node.entries:
                if not isinstance(key, Scalar):
                    self.fault(key.mark, path, "a key must be a text", described(key))
                    continue
                below = join(path, key.text)
                if key.tag is not None:
                    self.fault(key.mark, below, "a YAML tag", shown(key.tag), "leave it out")
                if key.text in lines:
                    remedy = f"it is given in line {lines[key.text]} already"
                    self.fault(key.mark, below, "a duplicate key", None, remedy)
                    continue
                lines[key.text] = key.mark[0]
                self.survey(value, below)

    def table(self, table: Table, node: Mapping, path: str) -> Values:
        """Read a mapping's fields, each by its own kind; refuse what is unknown, missing or in each other's way."""
        given = entries(node)
        self._refuse_unknown(table, node, path)
        self._refuse_alternatives(table, given, node, path)
        values: Values = {}
        for field in table.fields:
            below = join(path, field.name)
            if field.name in given:
                value = self.field(field, given[field.name], below)
                if value is not None:
                    values[field.name] = value
            elif field.required:
                self.fault(node.mark, below, "missing", None, f"{self.wanted(field)}: {field.about}")
        return values

    def field(self, field: Field, node: Node, path: str) -> Any:  # noqa: ANN401 - settled by the field's kind
        """Read one field, or None where it is faulty."""
        if is_empty(node):
            leave = "" if field.required else ", or leave the key out"
            self.fault(node.mark, path, "nothing given", None, self.wanted(field) + leave)
            return None
        read = field.form.read if field.form else self.readers[field.kind]
        return read(self, field, node, path)

    def _refuse_unknown(self, table: Table, node: Mapping, path: str) -> None:
        known = table.keys
        for name, key in keys(node).items():
            below = join(path, name)
            if name in known:
                continue
            if name == "<<":
                self.fault(key.mark, below, "merge keys are not read", None, "write the keys out")
            elif name.isdecimal() and is_empty(entries(node)[name]):  # {rise: 12,5}
                self.fault(key.mark, below, "a number cut at its comma", None, "a decimal takes a point, not a comma")
            else:
                if other := _other_measure(name, entries(node)[name], known):
                    self.fault(key.mark, below, "unknown key", None, other)
                    continue
                near = suggestion(name, known)
                if name not in near and of_other_kind(self.root, below):
                    near = ""  # it is no slip for another word, unless it is a part of that one
                self.fault(key.mark, below, "unknown key", None, near or elsewhere(self.root, name, table))

    def _refuse_alternatives(self, table: Table, nodes: dict[str, Node], node: Mapping, path: str) -> None:
        names = [name for name, _ in table.alternatives]
        chosen = [name for name, _ in table.alternatives if name in nodes]
        if names and not chosen and not table.optional:
            self.fault(node.mark, path, f"needs {either(tuple(names))}", None, "give exactly one of them")
        for name in chosen[1:]:
            problem = f"cannot be combined with {self._key(path, chosen[0])}"
            self.fault_at(join(path, name), problem, None, f"give exactly one of {either(tuple(names))}")
        if len(chosen) != 1:
            return
        companions = dict(table.alternatives)
        for name in companions[chosen[0]]:
            if name not in nodes:
                field = table.field(name)
                remedy = f"{self.wanted(field)}: {field.about}"
                self.fault(
                    node.mark, join(path, name), f"missing, needed with {self._key(path, chosen[0])}", None, remedy
                )
        for name in dict.fromkeys(name for others in companions.values() for name in others):
            if name in nodes and name not in companions[chosen[0]]:
                problem = f"cannot be combined with {self._key(path, chosen[0])}"
                self.fault_at(join(path, name), problem, None, "leave it out")

    def _key(self, path: str, name: str) -> str:
        """Name a key of a mapping as the recipe does."""
        return join(path, name).rpartition(".")[2]

    # --- kinds that several readers share ----------------------------------------------------------------------------

    def mapping(self, field: Field, node: Node, path: str) -> Values | None:
        """Read a mapping by its table."""
        if field.table is None or not isinstance(node, Mapping):
            self.fault(node.mark, path, "not a mapping", described(node), self.wanted(field))
            return None
        return self.table(field.table, node, path)

    def one_of(self, field: Field, node: Node, path: str) -> Values | None:
        """Read a mapping whose `kind` says which of its form's tables is its own."""
        tables = (field.form.tables if field.form else None) or {}
        if not isinstance(node, Mapping):
            self.fault(node.mark, path, "not a mapping", described(node), self.wanted(field))
            return None
        about = f"the kind of {field.noun.removeprefix('a ')}"
        others = field.form.others if field.form else ""
        kind = Field("kind", Kind.CHOICE, about, required=True, choices=tuple(tables), others=others)
        if found := kind_of(node, tables):
            table = tables[found]
            return self.table(Table((kind, *table.fields), table.alternatives), node, path)
        # Without a kind only keys that no table has are faults, and which kind was meant is not guessed at.
        every = {item.name: item for table in tables.values() for item in table.fields}
        self._refuse_unknown(Table((kind, *every.values())), node, path)
        if "kind" in entries(node):
            self.field(kind, entries(node)["kind"], join(path, "kind"))
        else:
            self.fault(node.mark, join(path, "kind"), "missing", None, f"{self.wanted(kind)}: {kind.about}")
        return None

    def items(self, field: Field, node: Node, path: str, most: int) -> tuple[Node, ...]:
        """Give the entries of a list, which has one at least."""
        if not isinstance(node, Sequence):
            self.fault(node.mark, path, "not a list", described(node), self.wanted(field))
            return ()
        if not node.items:
            self.fault(node.mark, path, "an empty list", None, self.wanted(field))
        if len(node.items) > most:
            self.fault(node.mark, path, f"more than {most} entries", str(len(node.items)), f"at most {most} are read")
            return ()
        return node.items


def _other_measure(name: str, node: Node, names: collections.abc.Collection[str]) -> str:
    """Say which radius is meant by a diameter, or which diameter by a radius, with its value; empty for other keys."""
    for own, other, factor in (("diameter", "radius", 0.5), ("radius", "diameter", 2.0)):
        wanted = name.replace(own, other)
        if own in name and wanted in names and isinstance(node, Scalar):
            text, unit = parted(node.text)
            with suppress(Complaint):
                return f"give {wanted}: {factor * read_number(text):.12g} {unit}".rstrip()
            return f"give {wanted}"
    return ""


def kind_of(node: Node | None, tables: collections.abc.Mapping[str, Table]) -> str:
    """Give the `kind` of a mapping where it is one of those known, or nothing."""
    kind = entries(node).get("kind") if isinstance(node, Mapping) else None
    return kind.text if isinstance(kind, Scalar) and kind.text in tables else ""
