"""Reading functions by kind of field, and the forms of mappings whose `kind` chooses their keys."""

from __future__ import annotations

from typing import TYPE_CHECKING

from camgeo.schema.fields import Form, Kind
from camgeo.schema.json_schema import one_of_schema
from camgeo.schema.read_list import read_harmonics, read_numbers, read_pair, read_point
from camgeo.schema.read_scalar import read_choice, read_formula, read_numeric, read_text, read_truth
from camgeo.schema.reader import Reader

if TYPE_CHECKING:
    from collections.abc import Mapping

    from camgeo.schema.fields import Table
    from camgeo.schema.reader import Readers

READERS: Readers = {
    Kind.TEXT: read_text,
    Kind.NAME: read_text,
    Kind.CHOICE: read_choice,
    Kind.LENGTH: read_numeric,
    Kind.AREA: read_numeric,
    Kind.ANGLE: read_numeric,
    Kind.NUMBER: read_numeric,
    Kind.RATE: read_numeric,
    Kind.INTEGER: read_numeric,
    Kind.STROKE: read_numeric,
    Kind.ERROR: read_numeric,
    Kind.OUTPUT: read_numeric,
    Kind.MOTION: read_numeric,
    Kind.BACKLASH: read_numeric,
    Kind.TRUTH: read_truth,
    Kind.RATIO: read_text,
    Kind.FORMULA: read_formula,
    Kind.POINT: read_point,
    Kind.PAIR: read_pair,
    Kind.HARMONICS: read_harmonics,
    Kind.NUMBERS: read_numbers,
    Kind.TABLE: Reader.mapping,
}


def form_of_kinds(noun: str, tables: Mapping[str, Table], group: str = "", others: str = "") -> Form[Reader]:
    """Form of a mapping whose `kind` chooses the table of its keys; see `Form` for `group` and `others`."""
    return Form(
        f"a {noun}",
        f"a mapping with the kind of {noun} and its fields",
        Reader.one_of,
        lambda _: one_of_schema(noun, tables),
        tables=tables,
        group=group,
        others=others,
    )
