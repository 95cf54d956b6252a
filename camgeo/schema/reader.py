"""Reading a recipe's tree by the schema: values converted, every fault noted with its place."""

from __future__ import annotations

import math
from contextlib import suppress
from typing import TYPE_CHECKING, Any, NamedTuple, TypeAlias

from camgeo.schema.errors import RecipeError, nearest_word, quote
from camgeo.schema.fields import Field, FieldTable, Kind, belongs_to_other_kind, either, place_of_key
from camgeo.schema.quantity import split_unit
from camgeo.schema.scalars import Complaint, read_number
from camgeo.schema.yaml_source import Mapping, Scalar, Sequence, describe, entries, is_empty, join, keys

if TYPE_CHECKING:
    import collections.abc
    from collections.abc import Callable

    from camgeo.schema.yaml_source import Mark, Node, Source

# A mapping read by its table: fields that are absent or faulty are left out. What a field holds is settled by its kind.
Values: TypeAlias = dict[str, Any]
# How each kind of field is read; a reader of a kind gives None for what is faulty, and has noted the fault.
Readers: TypeAlias = "collections.abc.Mapping[Kind, Callable[[Reader, Field, Node, str], Any]]"

_LENGTHS = (Kind.LENGTH, Kind.STROKE, Kind.ERROR, Kind.OUTPUT, Kind.MOTION, Kind.BACKLASH)  # unless it is an angle

_SI = {  # units of a follower that slides, and of one that turns
    Kind.FORCE: ("N", "N"),
    Kind.MOMENT: ("N m", "N m"),
    Kind.RATE: ("N/m", "N/m"),
    Kind.PRESSURE: ("N/mm^2", "N/mm^2"),
    Kind.MASS: ("kg", "kg"),
    Kind.THRUST: ("N", "N m"),
    Kind.GIVING: ("N/m", "N m/rad"),
    Kind.INERTIA: ("kg", "kg m²"),
}


class Others(NamedTuple):
    """Words of other recipes, which a recipe of this noun does not take; `instead` is the recipe to give with them.

    `have` says whether a word is one of them.
    """

    noun: str
    instead: str
    have: collections.abc.Callable[[str], bool]

    def refusal(self, word: str) -> tuple[str, None, str]:
        """Problem, value and remedy of the fault of a word of another recipe."""
        return f"a {self.noun} takes no {word}", None, f"leave it out, or give {self.instead}"


NO_OTHERS = Others("", "", lambda _: False)


class Reader:
    """Reads one recipe by its tables and collects its faults.

    root     table of the whole recipe
    errors   faults so far
    marks    place of every field of the recipe, by path
    numbers  field of every number of the recipe, by path
    units    the recipe's unit, and `mm` its length; these and the following are set before other fields are read
    kinds    kind of each mapping with kinds, by its key
    angular  kinds of field that hold an angle
    offers   words for what its cam has, such as `roller`, `arm` and `plate`
    others   words of other recipes, which this one does not take
    """

    def __init__(self, source: Source, readers: Readers, root: FieldTable, others: Others = NO_OTHERS) -> None:
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
        self.others = others

    # --- faults ------------------------------------------------------------------------------------------------------

    def fault(self, mark: Mark, path: str, problem: str, value: str | None = None, remedy: str = "") -> None:
        """Add a fault at a place of the text."""
        self.errors.append(RecipeError(self.source.file, *mark, path, problem, value, remedy))

    def fault_at(self, path: str, problem: str, value: str | None = None, remedy: str = "") -> None:
        """Add a fault at the place of a field that the recipe has; raises KeyError for another."""
        self.fault(self.marks[path], path, problem, value, remedy)

    def wanted(self, field: Field) -> str:
        """Remedy for a faulty field, with its unit: `give a length above 0 in mm`."""
        unit = self.unit(field.unit or field.kind)
        return f"give {field.wanted()}{f' in {unit}' if unit else ''}"

    def unit(self, kind: Kind) -> str:
        """Unit in which the recipe writes a kind of field; empty for a kind without units."""
        if kind in self.angular:
            return "degrees"
        if kind is Kind.AREA:
            return f"square {self.units}"
        if kind in _SI:
            return _SI[kind][Kind.MOTION in self.angular]
        return self.units if kind in {Kind.POINT, Kind.PAIR, *_LENGTHS} else ""

    def scale(self, kind: Kind) -> float:
        """Factor from a number as written to mm, mm^2 or rad; 1 for other kinds."""
        if kind in self.angular:
            return math.pi / 180
        return {**dict.fromkeys(_LENGTHS, self.mm), Kind.AREA: self.mm**2}.get(kind, 1.0)

    def shown(self, length: float, digits: int = 9) -> str:
        """Text of a length, mm, in the recipe's unit, with at most `digits` significant digits: `12.5 mm`."""
        return f"{length / self.mm:.{digits}g} {self.units}"

    # --- tables ------------------------------------------------------------------------------------------------------

    def survey(self, node: Node, path: str) -> None:
        """Fill `marks` with the place of every field, and note what YAML allows but a recipe does not."""
        self.marks.setdefault(path, node.mark)
        if node.tag is not None:
            self.fault(node.mark, path, "a YAML tag", quote(node.tag), "leave it out; the field says how it is read")
        if isinstance(node, Sequence):
            for i, item in enumerate(node.items):
                self.survey(item, join(path, i))
        elif isinstance(node, Mapping):
            lines: dict[str, int] = {}
            for key, value in node.entries:
                if not isinstance(key, Scalar):
                    self.fault(key.mark, path, "a key must be a text", describe(key))
                    continue
                below = join(path, key.text)
                if key.tag is not None:
                    self.fault(key.mark, below, "a YAML tag", quote(key.tag), "leave it out")
                if key.text in lines:
                    self.fault(
                        key.mark, below, "a duplicate key", None, f"it is given in line {lines[key.text]} already"
                    )
                    continue
                lines[key.text] = key.mark[0]
                self.survey(value, below)

    def table(self, table: FieldTable, node: Mapping, path: str) -> Values:
        """Values of a mapping by key, without faulty ones; unknown, missing and conflicting keys are noted.

        A missing key is not noted where it is what the remedy of an unknown one names.
        """
        nodes = entries(node)
        misspelled = self._refuse_unknown(table, node, path)
        self._refuse_alternatives(table, nodes, node, path, misspelled)
        values: Values = {}
        for field in table.fields:
            below = join(path, field.name)
            if field.name in nodes:
                value = self.field(field, nodes[field.name], below)
                if value is not None:
                    values[field.name] = value
            elif field.required and field.name not in misspelled:
                self.fault(node.mark, below, "missing", None, f"{self.wanted(field)}: {field.about}")
        return values

    def field(self, field: Field, node: Node, path: str) -> Any:  # noqa: ANN401 - settled by the field's kind
        """Value of a field, of the type that its kind has; None where it is faulty, with the fault noted."""
        if is_empty(node):
            leave = "" if field.required else ", or leave the key out"
            self.fault(node.mark, path, "nothing given", None, self.wanted(field) + leave)
            return None
        read_field = field.form.read if field.form else self.readers[field.kind]
        return read_field(self, field, node, path)

    def _refuse_unknown(self, table: FieldTable, node: Mapping, path: str) -> set[str]:
        """Note unknown keys; return the known ones that their remedies name."""
        known_keys = table.keys
        misspelled: set[str] = set()
        for name, key in keys(node).items():
            below = join(path, name)
            if name in known_keys:
                continue
            if name == "<<":
                self.fault(key.mark, below, "merge keys are not read", None, "write the keys out")
            elif name.isdecimal() and is_empty(entries(node)[name]):  # {rise: 12,5}
                self.fault(key.mark, below, "a number cut at its comma", None, "a decimal takes a point, not a comma")
            elif not path and self.others.have(name):
                self.fault(key.mark, below, *self.others.refusal(name))
            else:
                near, remedy = _other_measure(name, entries(node)[name], known_keys)
                if not near:
                    meant = (field.name for field in table.fields if name in field.slips)
                    near = next(meant, "") or nearest_word(name, known_keys)
                    if near and path and name in self.root.keys and name not in near:
                        near = ""  # a word of the top level is spelled as it was meant
                    if name not in near and belongs_to_other_kind(self.root, below):
                        near = ""  # a key of another kind is no slip of the pen, unless it is a part of the near word
                    remedy = f"did you mean {near}?" if near else place_of_key(self.root, name, table)
                self.fault(key.mark, below, "unknown key", None, remedy)
                if near:
                    misspelled.add(near)
        return misspelled

    def _refuse_alternatives(
        self, table: FieldTable, nodes: dict[str, Node], node: Mapping, path: str, misspelled: collections.abc.Set[str]
    ) -> None:
        """Note alternatives that are missing, but for those that are misspelled, and those that exclude each other."""
        names = [name for name, _ in table.alternatives]
        chosen = [name for name, _ in table.alternatives if name in nodes]
        if names and not chosen and not table.optional and misspelled.isdisjoint(names):
            self.fault(node.mark, path, f"needs {either(tuple(names))}", None, "give exactly one of them")
        # as the last name of its path, which `join` would quote if it were unusual
        chosen_key = join(path, chosen[0]).rpartition(".")[2] if chosen else ""
        for name in chosen[1:]:
            remedy = f"give exactly one of {either(names)}"
            self.fault_at(join(path, name), f"cannot be combined with {chosen_key}", None, remedy)
        if len(chosen) != 1:
            return
        companions = dict(table.alternatives)
        for name in companions[chosen[0]]:
            field = table.field(name)
            if name not in nodes and name not in misspelled and not field.default:
                problem, remedy = f"missing, needed with {chosen_key}", f"{self.wanted(field)}: {field.about}"
                self.fault(node.mark, join(path, name), problem, None, remedy)
        for name in dict.fromkeys(name for group in companions.values() for name in group):
            if name in nodes and name not in companions[chosen[0]]:
                self.fault_at(join(path, name), f"cannot be combined with {chosen_key}", None, "leave it out")

    # --- kinds that several readers share ----------------------------------------------------------------------------

    def mapping(self, field: Field, node: Node, path: str) -> Values | None:
        """Values of a mapping by the table of its field; None where it is no mapping, with the fault noted."""
        if field.table is None or not isinstance(node, Mapping):
            self.fault(node.mark, path, "not a mapping", describe(node), self.wanted(field))
            return None
        return self.table(field.table, node, path)

    def one_of(self, field: Field, node: Node, path: str) -> Values | None:
        """Values of a mapping whose `kind` chooses one of its form's tables.

        None where it is no mapping or its kind is faulty, with the fault noted.
        """
        tables = (field.form.tables if field.form else None) or {}
        if not isinstance(node, Mapping):
            self.fault(node.mark, path, "not a mapping", describe(node), self.wanted(field))
            return None
        about = f"the kind of {field.noun.removeprefix('a ')}"
        hint, more = (field.form.others, field.form.elsewhere) if field.form else ("", ())
        kind = Field("kind", Kind.CHOICE, about, required=True, choices=(*tables, *more), others=hint)
        if chosen := kind_of(node, tables):
            table = tables[chosen]
            return self.table(FieldTable((kind, *table.fields), table.alternatives), node, path)
        # Without a kind only keys that no table has are faults; the kind is not guessed.
        all_fields = {item.name: item for table in tables.values() for item in table.fields}
        misspelled = self._refuse_unknown(FieldTable((kind, *all_fields.values())), node, path)
        if "kind" in entries(node):
            self.field(kind, entries(node)["kind"], join(path, "kind"))
        elif "kind" not in misspelled:
            self.fault(node.mark, join(path, "kind"), "missing", None, f"{self.wanted(kind)}: {kind.about}")
        return None

    def items(self, field: Field, node: Node, path: str, most: int) -> tuple[Node, ...]:
        """Entries of a list of 1 to `most` entries; empty where it is faulty, with the fault noted."""
        if not isinstance(node, Sequence):
            self.fault(node.mark, path, "not a list", describe(node), self.wanted(field))
            return ()
        if not node.items:
            self.fault(node.mark, path, "an empty list", None, self.wanted(field))
        if len(node.items) > most:
            self.fault(node.mark, path, f"more than {most} entries", str(len(node.items)), f"at most {most} are read")
            return ()
        return node.items


def _other_measure(name: str, node: Node, names: collections.abc.Collection[str]) -> tuple[str, str]:
    """Key for a diameter given in place of a radius, or the reverse, and a remedy with its value; empty for others."""
    for measure, counterpart, factor in (("diameter", "radius", 0.5), ("radius", "diameter", 2.0)):
        new_name = name.replace(measure, counterpart)
        if measure in name and new_name in names and isinstance(node, Scalar):
            text, unit = split_unit(node.text)
            with suppress(Complaint):
                return new_name, f"give {new_name}: {factor * read_number(text):.12g} {unit}".rstrip()
            return new_name, f"give {new_name}"
    return "", ""


def kind_of(node: Node | None, tables: collections.abc.Mapping[str, FieldTable]) -> str:
    """Word of a mapping's `kind`; empty where `tables` does not have it, and for any other node."""
    kind = entries(node).get("kind") if isinstance(node, Mapping) else None
    return kind.text if isinstance(kind, Scalar) and kind.text in tables else ""
