"""Reading a recipe's tree by the schema: values converted, every fault noted with its place."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, TypeAlias

from camgeo.recipe.errors import RecipeError, shown, suggestion
from camgeo.recipe.scalars import Complaint, read_name, read_number, read_paragraph, read_ratio, read_whole
from camgeo.recipe.source import (
    Mapping,
    Node,
    Scalar,
    Sequence,
    described,
    entries,
    is_empty,
    join,
    keys,
    written,
)
from camgeo.recipe.spec import (
    CAMS,
    FILES,
    LATER_FILES,
    MOST,
    MOST_COEFFICIENT,
    MOST_COEFFICIENTS,
    MOST_FILES,
    MOST_HARMONIC,
    MOST_SEGMENTS,
    RECIPE,
    SWINGING,
    Field,
    Kind,
    Table,
    either,
    elsewhere,
)

if TYPE_CHECKING:
    from collections.abc import Callable

    from camgeo.recipe.source import Mark, Source

# A mapping read by its table: fields that are absent or faulty are left out. What a field holds is settled by its kind.
Values: TypeAlias = dict[str, Any]

_MM = {"mm": 1.0, "inch": 25.4}


class Reader:
    """Reads one recipe; `errors` and `marks` (of every field given, by path) grow as it does."""

    def __init__(self, source: Source) -> None:
        self.source = source
        self.errors: list[RecipeError] = []
        self.marks: dict[str, Mark] = {}
        self.units = "mm"
        self.mm = 1.0
        self.cam_kind = ""
        self._by_kind: dict[Kind, Callable[[Field, Node, str], Any]] = {
            Kind.TEXT: self._text,
            Kind.NAME: self._text,
            Kind.CHOICE: self._choice,
            Kind.LENGTH: self._number,
            Kind.AREA: self._number,
            Kind.ANGLE: self._number,
            Kind.NUMBER: self._number,
            Kind.INTEGER: self._number,
            Kind.ERROR: self._number,
            Kind.RATIO: self._text,
            Kind.FORMULA: self._formula,
            Kind.POINT: self._point,
            Kind.HARMONICS: self._harmonics,
            Kind.LAW: self._law,
            Kind.NUMBERS: self._numbers,
            Kind.TABLE: self._mapping,
            Kind.SEGMENTS: self._segments,
            Kind.FILES: self._files,
            Kind.CAM: self._cam,
        }

    # --- faults ------------------------------------------------------------------------------------------------------

    def fault(self, mark: Mark, path: str, problem: str, value: str | None = None, remedy: str = "") -> None:
        """Note a fault."""
        self.errors.append(RecipeError(self.source.file, *mark, path, problem, value, remedy))

    def fault_at(self, path: str, problem: str, value: str | None = None, remedy: str = "") -> None:
        """Note a fault of a field that was given."""
        self.fault(self.marks[path], path, problem, value, remedy)

    def wanted(self, field: Field) -> str:
        """Say what would do for a field, with its unit: `give a length above 0 in mm`."""
        unit = self._unit(field.unit or field.kind)
        return f"give {field.wanted()}{f' in {unit}' if unit else ''}"

    def _unit(self, kind: Kind) -> str:
        if kind is Kind.ANGLE or (kind is Kind.ERROR and self.cam_kind in SWINGING):
            return "degrees"
        if kind is Kind.AREA:
            return f"square {self.units}"
        return self.units if kind in {Kind.LENGTH, Kind.POINT, Kind.ERROR} else ""

    def _scale(self, kind: Kind) -> float:
        """Factor from a number as written to mm, mm^2 or radians."""
        if kind is Kind.ANGLE or (kind is Kind.ERROR and self.cam_kind in SWINGING):
            return math.pi / 180
        return {Kind.LENGTH: self.mm, Kind.ERROR: self.mm, Kind.AREA: self.mm**2}.get(kind, 1.0)

    # --- tables ------------------------------------------------------------------------------------------------------

    def recipe(self) -> Values:
        """Read the whole recipe."""
        root = self.source.root
        self._survey(root, "")
        if not isinstance(root, Mapping):
            self.fault(root.mark, "", "a recipe is a mapping", described(root), "begin with the key `cam:`")
            return {}
        # Units and the kind of cam decide how other fields read, wherever they stand.
        top = entries(root)
        units = top.get("units")
        if isinstance(units, Scalar) and units.text in _MM:
            self.units, self.mm = units.text, _MM[units.text]
        cam = top.get("cam")
        kind = entries(cam).get("kind") if isinstance(cam, Mapping) else None
        if isinstance(kind, Scalar) and kind.text in CAMS:
            self.cam_kind = kind.text
        return {"mm": self.mm, **self._table(RECIPE, root, "")}

    def _survey(self, node: Node, path: str) -> None:
        """Note where every field stands, and what YAML allows but a recipe does not."""
        self.marks.setdefault(path, node.mark)
        if node.tag is not None:
            self.fault(node.mark, path, "a YAML tag", shown(node.tag), "leave it out; the field says how it is read")
        if isinstance(node, Sequence):
            for i, item in enumerate(node.items):
                self._survey(item, join(path, i))
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
                    remedy = f"it stands in line {lines[key.text]} already"
                    self.fault(key.mark, below, "a key that stands twice", None, remedy)
                    continue
                lines[key.text] = key.mark[0]
                self._survey(value, below)

    def _table(self, table: Table, node: Mapping, path: str) -> Values:
        given = entries(node)
        self._refuse_unknown(table, node, path)
        self._refuse_alternatives(table, given, node, path)
        values: Values = {}
        for field in table.fields:
            below = join(path, field.name)
            if field.name in given:
                value = self._field(field, given[field.name], below)
                if value is not None:
                    values[field.name] = value
            elif field.required:
                self.fault(node.mark, below, "missing", None, f"{self.wanted(field)}: {field.about}")
        return values

    def _field(self, field: Field, node: Node, path: str) -> Any:  # noqa: ANN401 - settled by the field's kind
        if is_empty(node):
            leave = "" if field.required else ", or leave the key out"
            self.fault(node.mark, path, "nothing given", None, self.wanted(field) + leave)
            return None
        return self._by_kind[field.kind](field, node, path)

    def _refuse_unknown(self, table: Table, node: Mapping, path: str) -> None:
        known = table.keys
        for name, key in keys(node).items():
            below = join(path, name)
            if name in known:
                continue
            if name in table.later:
                remedy = f"leave it out; here it has {either(known, 'and')}"
                self.fault(key.mark, below, "not available in this version", None, remedy)
            elif name == "<<":
                self.fault(key.mark, below, "merge keys are not read", None, "write the keys out")
            else:
                self.fault(key.mark, below, "unknown key", None, suggestion(name, known) or elsewhere(name, known))

    def _refuse_alternatives(self, table: Table, given: dict[str, Node], node: Mapping, path: str) -> None:
        names = [name for name, _ in table.alternatives]
        chosen = [name for name, _ in table.alternatives if name in given]
        if names and not chosen and not any(name in given for name in table.later):
            self.fault(node.mark, path, f"needs {either(tuple(names))}", None, "give exactly one of them")
        for name in chosen[1:]:
            problem = f"cannot stand beside {chosen[0]}"
            self.fault_at(join(path, name), problem, None, f"give exactly one of {either(tuple(names))}")
        if len(chosen) != 1:
            return
        companions = dict(table.alternatives)
        for name in companions[chosen[0]]:
            if name not in given:
                field = table.field(name)
                remedy = f"{self.wanted(field)}: {field.about}"
                self.fault(node.mark, join(path, name), f"missing beside {chosen[0]}", None, remedy)
        for name in dict.fromkeys(name for others in companions.values() for name in others):
            if name in given and name not in companions[chosen[0]]:
                self.fault_at(join(path, name), f"cannot stand beside {chosen[0]}", None, "leave it out")

    # --- scalars -----------------------------------------------------------------------------------------------------

    def _scalar(self, field: Field, node: Node, path: str) -> str | None:
        if isinstance(node, Scalar):
            return node.text
        self.fault(node.mark, path, f"not {field.kind.value}", described(node), self.wanted(field))
        return None

    def _complain(self, field: Field, node: Scalar, path: str, complaint: Complaint) -> None:
        remedy = complaint.remedy or self.wanted(field)
        self.fault(node.mark, path, complaint.problem, written(node), remedy)

    def _text(self, field: Field, node: Node, path: str) -> Any:  # noqa: ANN401 - a text, or a ratio's pair
        readers: dict[Kind, Callable[[str], object]] = {
            Kind.TEXT: read_paragraph,
            Kind.NAME: read_name,
            Kind.RATIO: read_ratio,
        }
        text = self._scalar(field, node, path)
        if text is None or not isinstance(node, Scalar):
            return None
        try:
            return readers[field.kind](text)
        except Complaint as complaint:
            self._complain(field, node, path, complaint)
            return None

    def _choice(self, field: Field, node: Node, path: str) -> str | None:
        text = self._scalar(field, node, path)
        if text is None or text in field.choices:
            return text
        remedy = suggestion(text, field.choices) or self.wanted(field)
        self.fault(node.mark, path, "not one of the choices", shown(text), remedy)
        return None

    def _number(self, field: Field, node: Node, path: str) -> float | int | None:
        """Read a number, check its bounds as written, and convert it."""
        text = self._scalar(field, node, path)
        if text is None or not isinstance(node, Scalar):
            return None
        try:
            value = read_whole(text) if field.kind is Kind.INTEGER else read_number(text)
        except Complaint as complaint:
            self._complain(field, node, path, complaint)
            return None
        if problem := field.out_of_bounds(value):
            self.fault(node.mark, path, problem, written(node), self.wanted(field))
            return None
        return value if field.kind is Kind.INTEGER else value * self._scale(field.kind)

    def _formula(self, field: Field, node: Node, path: str) -> str | None:
        from kin.formula import Formula, FormulaError

        text = self._scalar(field, node, path)
        if text is None or not isinstance(node, Scalar):
            return None
        text = text.replace("\n", " ")
        try:
            Formula(text, (field.variable,))
        except FormulaError as error:
            remedy = self.wanted(field)
            if self._behind(node) == "," and text.count("(") > text.count(")"):
                remedy = "a formula with a comma in it needs quotes inside braces"
            mark = self._inside(node, error.column)
            self.fault(mark, path, error.message, shown(text), remedy)
            return None
        return text

    def _inside(self, node: Scalar, column: int) -> Mark:
        """Place of a character of a scalar, or of the scalar where escapes or line breaks hide it."""
        (line, start), (end_line, end) = node.mark, node.end
        raw = self.source.lines[line - 1][start - 1 : end - 1] if line == end_line else ""
        for lead in (0, 1):  # plain, quoted
            if raw and raw[lead : len(raw) - lead] == node.text:
                return line, start + lead + column
        return node.mark

    def _behind(self, node: Scalar) -> str:
        line, column = node.end
        return "".join(self.source.lines[line - 1 : line])[column - 1 : column]

    # --- lists and mappings ------------------------------------------------------------------------------------------

    def _mapping(self, field: Field, node: Node, path: str) -> Values | None:
        if field.table is None or not isinstance(node, Mapping):
            self.fault(node.mark, path, "not a mapping", described(node), self.wanted(field))
            return None
        return self._table(field.table, node, path)

    def _items(self, field: Field, node: Node, path: str, most: int) -> tuple[Node, ...]:
        if not isinstance(node, Sequence):
            self.fault(node.mark, path, "not a list", described(node), self.wanted(field))
            return ()
        if not node.items:
            self.fault(node.mark, path, "an empty list", None, self.wanted(field))
        if len(node.items) > most:
            self.fault(node.mark, path, f"more than {most} entries", str(len(node.items)), f"at most {most} are read")
            return ()
        return node.items

    def _point(self, field: Field, node: Node, path: str) -> tuple[float, float] | None:
        if not isinstance(node, Sequence) or len(node.items) != 2:
            self.fault(node.mark, path, "not a point", described(node), self.wanted(field))
            return None
        part = Field("", Kind.LENGTH, "", at_least=-MOST, at_most=MOST)
        x, y = (self._field(part, item, join(path, i)) for i, item in enumerate(node.items))
        return None if x is None or y is None else (x, y)

    def _numbers(self, field: Field, node: Node, path: str) -> tuple[float, ...] | None:
        part = Field("", Kind.NUMBER, "", at_least=-MOST_COEFFICIENT, at_most=MOST_COEFFICIENT)
        items = self._items(field, node, path, MOST_COEFFICIENTS)
        values = [self._field(part, item, join(path, i)) for i, item in enumerate(items)]
        return tuple(values) if values and None not in values else None

    def _harmonics(self, field: Field, node: Node, path: str) -> tuple[tuple[int, float], ...] | None:
        if not isinstance(node, Mapping):
            self.fault(node.mark, path, "not a mapping", described(node), self.wanted(field))
            return None
        harmonic = Field("", Kind.INTEGER, "", at_least=1, at_most=MOST_HARMONIC, odd=field.odd)
        bound = MOST**2 if field.unit is Kind.AREA else MOST
        coefficient = Field("", field.unit or Kind.NUMBER, "", at_least=-bound, at_most=bound)
        values = entries(node)
        read: dict[int, float] = {}
        for name, key in keys(node).items():
            below = join(path, name)
            j = self._number(harmonic, key, below)
            value = self._field(coefficient, values[name], below)
            if j in read:
                self.fault(key.mark, below, "the harmonic stands twice", None, "give each harmonic once")
            elif isinstance(j, int) and value is not None:
                read[j] = value
        return tuple(sorted(read.items()))

    def _law(self, field: Field, node: Node, path: str) -> str | tuple[float, ...] | None:
        from kin.law import LAWS, IntentError, polynomial_law

        names = tuple(LAWS)
        if isinstance(node, Scalar):
            if node.text in LAWS:
                return node.text
            remedy = suggestion(node.text, names) or f"give {either(names)}, or {{polynomial: [...]}}"
            self.fault(node.mark, path, "no such motion law", shown(node.text), remedy)
            return None
        values = self._mapping(field, node, path)
        coefficients: tuple[float, ...] | None = values.get("polynomial") if values else None
        if coefficients is None:
            return None
        try:
            polynomial_law(coefficients)
        except IntentError as error:
            self.fault(node.mark, path, error.message, None, "let c0 be 0 and the sum of all coefficients 1")
            return None
        return coefficients

    def _segments(self, field: Field, node: Node, path: str) -> list[Values] | None:
        """Read a motion programme, or None where a segment is faulty."""
        found = len(self.errors)
        items = self._items(field, node, path, MOST_SEGMENTS)
        segment = Field("", Kind.TABLE, "", table=field.table)
        values = [self._field(segment, item, join(path, i)) for i, item in enumerate(items)]
        return values if len(self.errors) == found else None

    def _files(self, field: Field, node: Node, path: str) -> list[Values] | None:
        """Read the list of files; each with its `kind`. A faulty one is left out."""
        found = []
        for i, item in enumerate(self._items(field, node, path, MOST_FILES)):
            below = join(path, i)
            kind, options = _format(item)
            if kind is None:
                remedy = "give a format, or a mapping with one format such as {dxf: {as: spline}}"
                self.fault(item.mark, below, "not a file", described(item), remedy)
                continue
            if kind.text not in FILES:
                self._refuse_format(kind, below)
            elif options is None:
                found.append({"kind": kind.text, "path": below})
            else:
                table = Field("", Kind.TABLE, "", table=FILES[kind.text])
                values = self._field(table, options, join(below, kind.text))
                if values is not None:
                    found.append({"kind": kind.text, "path": below, **values})
        return found

    def _refuse_format(self, kind: Scalar, path: str) -> None:
        later = kind.text.lower() in LATER_FILES
        problem = "not available in this version" if later else "no such file format"
        self.fault(kind.mark, path, problem, shown(kind.text), f"give {either(tuple(FILES))}")

    def _cam(self, field: Field, node: Node, path: str) -> Values | None:
        if not isinstance(node, Mapping):
            self.fault(node.mark, path, "not a mapping", described(node), self.wanted(field))
            return None
        kind = Field("kind", Kind.CHOICE, "the kind of cam", required=True, choices=tuple(CAMS))
        if self.cam_kind:
            table = CAMS[self.cam_kind]
            return self._table(Table((kind, *table.fields), table.alternatives, table.later), node, path)
        # Without a kind only keys that no cam has are faults, and which kind was meant is not guessed at.
        every = {item.name: item for table in CAMS.values() for item in table.fields}
        self._refuse_unknown(Table((kind, *every.values())), node, path)
        if "kind" in entries(node):
            self._field(kind, entries(node)["kind"], join(path, "kind"))
        else:
            self.fault(node.mark, join(path, "kind"), "missing", None, f"{self.wanted(kind)}: {kind.about}")
        return None


def _format(node: Node) -> tuple[Scalar | None, Node | None]:
    """Take an entry of the list of files apart: `dxf`, or the format and options of `{dxf: {...}}`."""
    if isinstance(node, Scalar):
        return (None if is_empty(node) else node), None
    if isinstance(node, Mapping) and len(node.entries) == 1:
        key, options = node.entries[0]
        return (key if isinstance(key, Scalar) else None), options
    return None, None
