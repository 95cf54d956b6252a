"""Reading the scalar fields of a recipe: texts, choices, numbers, formulas.

Each function takes the field, its node and its path, and notes faults in the reader.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from camgeo.schema.errors import NEAR, NEARER, quote, suggestion
from camgeo.schema.fields import Kind, either
from camgeo.schema.quantity import UnitComplaint, holds_unit, is_metric, quantity_in, read_quantity, units_for
from camgeo.schema.scalars import Complaint, SmallComplaint, read_name, read_paragraph, read_ratio, whole
from camgeo.schema.yaml_source import Scalar, describe, scalar_text

if TYPE_CHECKING:
    from collections.abc import Callable

    from camgeo.schema.fields import Field
    from camgeo.schema.reader import Reader
    from camgeo.schema.yaml_source import Mark, Node


def read_text(reader: Reader, field: Field, node: Node, path: str) -> object:
    """Value of a text by the kind of its field: a note, a name, or a ratio (lambda, mu); None where faulty."""
    readers: dict[Kind, Callable[[str], object]] = {
        Kind.TEXT: read_paragraph,
        Kind.NAME: read_name,
        Kind.RATIO: read_ratio,
    }
    scalar = _scalar(reader, field, node, path)
    if scalar is None:
        return None
    try:
        return readers[field.kind](scalar.text)
    except Complaint as complaint:
        _complain(reader, field, scalar, path, complaint)
        return None


def read_choice(reader: Reader, field: Field, node: Node, path: str) -> str | None:
    """Word of a field with choices; None where it is none of them."""
    scalar = _scalar(reader, field, node, path)
    if scalar is None or scalar.text in field.choices:
        return None if scalar is None else scalar.text
    remedy = suggestion(scalar.text, field.choices, NEARER if field.others else NEAR)
    remedy = remedy or field.others or reader.wanted(field)
    reader.fault(node.mark, path, "not one of the choices", quote(scalar.text), remedy)
    return None


def read_truth(reader: Reader, field: Field, node: Node, path: str) -> bool | None:
    """Truth value of the words true and false; None for anything else, other truth values of YAML included."""
    scalar = _scalar(reader, field, node, path)
    if scalar is None or scalar.text in {"true", "false"}:
        return None if scalar is None else scalar.text == "true"
    reader.fault(node.mark, path, "not true or false", quote(scalar.text), reader.wanted(field))
    return None


def read_numeric(reader: Reader, field: Field, node: Node, path: str) -> float | int | None:
    """Number in mm, rad or the field's own unit, within its bounds; None where faulty.

    It is written in the recipe's unit or with a unit of its own; bounds hold in the recipe's unit.
    """
    scalar = _scalar(reader, field, node, path)
    if scalar is None:
        return None
    try:
        value = read_quantity(scalar.text, reader.unit(field.unit or field.kind))
        value = whole(value) if field.kind is Kind.INTEGER else value
    except UnitComplaint as complaint:
        _refuse_unit(reader, field, scalar, path, complaint.unit)
        return None
    except SmallComplaint as complaint:
        remedy = complaint.instead if field.out_of_bounds(0.0) else complaint.remedy
        reader.fault(node.mark, path, complaint.problem, scalar_text(scalar), remedy)
        return None
    except Complaint as complaint:
        _complain(reader, field, scalar, path, complaint)
        return None
    if problem := field.out_of_bounds(value):
        reader.fault(node.mark, path, problem, scalar_text(scalar), reader.wanted(field))
        return None
    reader.numbers[path] = field
    if field.kind is Kind.INTEGER:
        return value
    scale = reader.scale(field.kind)
    if scale == reader.mm != 1.0 and is_metric(scalar.text):
        return read_quantity(scalar.text, "mm")  # 12 mm are 12 mm, which standards count on, and not 12/25.4 * 25.4
    return value * scale


def _refuse_unit(reader: Reader, field: Field, scalar: Scalar, path: str, unit: str) -> None:
    """Note a fault: a unit that numbers of this field do not take, with the units that they do."""
    own_unit = reader.unit(field.unit or field.kind)
    if units := units_for(own_unit):
        problem = f"'{unit}' is no unit of {quantity_in(own_unit)}"
        remedy = f"give {either(units)}, or a number alone, which is in {own_unit}"
    else:
        problem, meaning = "carries a unit", f": {field.about}" if field.about else ""
        remedy = f"give {field.wanted()}{f' in {own_unit}' if own_unit else ''} without a unit{meaning}"
    reader.fault(scalar.mark, path, problem, scalar_text(scalar), remedy)


def read_formula(reader: Reader, field: Field, node: Node, path: str) -> str | None:
    """Text of a formula on one line; None where it is faulty, with the fault noted at its place within the formula."""
    from kin.law.formula.formula import Formula, FormulaError

    scalar = _scalar(reader, field, node, path)
    if scalar is None:
        return None
    text = scalar.text.replace("\n", " ")
    try:
        Formula(text, (field.variable,))
    except FormulaError as error:
        remedy = reader.wanted(field)
        if _behind(reader, scalar) == "," and text.count("(") > text.count(")"):
            remedy = "a formula with a comma in it needs quotes inside braces"
        mark, problem = _inside(reader, scalar, error.column), error.message
        if holds_unit(text):
            unit = reader.unit(field.unit or Kind.LENGTH)
            problem, remedy = "a formula carries no units", f"give its numbers alone, in {unit}"
        reader.fault(mark, path, problem, quote(text), remedy)
        return None
    return text


def _scalar(reader: Reader, field: Field, node: Node, path: str) -> Scalar | None:
    if isinstance(node, Scalar):
        return node
    reader.fault(node.mark, path, f"not {field.noun}", describe(node), reader.wanted(field))
    return None


def _complain(reader: Reader, field: Field, node: Scalar, path: str, complaint: Complaint) -> None:
    remedy = complaint.remedy or reader.wanted(field)
    reader.fault(node.mark, path, complaint.problem, scalar_text(node), remedy)


def _inside(reader: Reader, node: Scalar, column: int) -> Mark:
    """Place of the character `column` of a scalar; that of the scalar where escapes or line breaks are in between."""
    (line, start), (end_line, end) = node.mark, node.end
    raw = reader.source.lines[line - 1][start - 1 : end - 1] if line == end_line else ""
    for lead in (0, 1):  # plain, quoted
        if raw and raw[lead : len(raw) - lead] == node.text:
            return line, start + lead + column
    return node.mark


def _behind(reader: Reader, node: Scalar) -> str:
    line, column = node.end
    return "".join(reader.source.lines[line - 1 : line])[column - 1 : column]
