"""Reading the scalar fields of a recipe: texts, choices, numbers, formulas."""

from __future__ import annotations

from typing import TYPE_CHECKING

from camgeo.schema.errors import NEAR, NEARER, shown, suggestion
from camgeo.schema.fields import Kind, either
from camgeo.schema.quantity import UnitComplaint, holds_unit, is_metric, quantity_in, read_quantity, units_for
from camgeo.schema.scalars import Complaint, SmallComplaint, read_name, read_paragraph, read_ratio, whole
from camgeo.schema.yaml_source import Scalar, described, written

if TYPE_CHECKING:
    from collections.abc import Callable

    from camgeo.schema.fields import Field
    from camgeo.schema.reader import Reader
    from camgeo.schema.yaml_source import Mark, Node


def read_text(reader: Reader, field: Field, node: Node, path: str) -> object:
    """Read a text, a name, or a ratio, which is a pair."""
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
    """Read one of a few words."""
    scalar = _scalar(reader, field, node, path)
    if scalar is None or scalar.text in field.choices:
        return None if scalar is None else scalar.text
    remedy = suggestion(scalar.text, field.choices, NEARER if field.others else NEAR)
    remedy = remedy or field.others or reader.wanted(field)
    reader.fault(node.mark, path, "not one of the choices", shown(scalar.text), remedy)
    return None


def read_truth(reader: Reader, field: Field, node: Node, path: str) -> bool | None:
    """Read true or false, and none of YAML's other words for them."""
    scalar = _scalar(reader, field, node, path)
    if scalar is None or scalar.text in {"true", "false"}:
        return None if scalar is None else scalar.text == "true"
    reader.fault(node.mark, path, "not true or false", shown(scalar.text), reader.wanted(field))
    return None


def read_numeric(reader: Reader, field: Field, node: Node, path: str) -> float | int | None:
    """Read a number in the recipe's unit or its own, check its bounds in the recipe's, and convert it."""
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
        reader.fault(node.mark, path, complaint.problem, written(scalar), remedy)
        return None
    except Complaint as complaint:
        _complain(reader, field, scalar, path, complaint)
        return None
    if problem := field.out_of_bounds(value):
        reader.fault(node.mark, path, problem, written(scalar), reader.wanted(field))
        return None
    reader.numbers[path] = field
    if field.kind is Kind.INTEGER:
        return value
    scale = reader.scale(field.kind)
    if scale == reader.mm != 1.0 and is_metric(scalar.text):
        return read_quantity(scalar.text, "mm")  # 12 mm are 12 mm, which standards count on, and not 12/25.4 * 25.4
    return value * scale


def _refuse_unit(reader: Reader, field: Field, scalar: Scalar, path: str, unit: str) -> None:
    """Note a unit that a number of this field does not take, with those that it does."""
    own = reader.unit(field.unit or field.kind)
    if taken := units_for(own):
        problem = f"'{unit}' is no unit of {quantity_in(own)}"
        remedy = f"give {either(taken)}, or a number alone, which is in {own}"
    else:
        problem, meaning = "carries a unit", f": {field.about}" if field.about else ""
        remedy = f"give {field.wanted()}{f' in {own}' if own else ''} without a unit{meaning}"
    reader.fault(scalar.mark, path, problem, written(scalar), remedy)


def read_formula(reader: Reader, field: Field, node: Node, path: str) -> str | None:
    """Read a formula, pointing into its text where it is faulty."""
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
            own = reader.unit(field.unit or Kind.LENGTH)
            problem, remedy = "a formula carries no units", f"give its numbers alone, in {own}"
        reader.fault(mark, path, problem, shown(text), remedy)
        return None
    return text


def _scalar(reader: Reader, field: Field, node: Node, path: str) -> Scalar | None:
    if isinstance(node, Scalar):
        return node
    reader.fault(node.mark, path, f"not {field.noun}", described(node), reader.wanted(field))
    return None


def _complain(reader: Reader, field: Field, node: Scalar, path: str, complaint: Complaint) -> None:
    remedy = complaint.remedy or reader.wanted(field)
    reader.fault(node.mark, path, complaint.problem, written(node), remedy)


def _inside(reader: Reader, node: Scalar, column: int) -> Mark:
    """Place of a character of a scalar, or of the scalar where escapes or line breaks hide it."""
    (line, start), (end_line, end) = node.mark, node.end
    raw = reader.source.lines[line - 1][start - 1 : end - 1] if line == end_line else ""
    for lead in (0, 1):  # plain, quoted
        if raw and raw[lead : len(raw) - lead] == node.text:
            return line, start + lead + column
    return node.mark


def _behind(reader: Reader, node: Scalar) -> str:
    line, column = node.end
    return "".join(reader.source.lines[line - 1 : line])[column - 1 : column]
