"""Which function reads which kind of field, those apart whose topic has a form of its own."""

from __future__ import annotations

from typing import TYPE_CHECKING

from camgeo.schema.fields import Kind
from camgeo.schema.read_list import (
    read_harmonics,
    read_numbers,
    read_pair,
    read_point,
)
from camgeo.schema.read_scalar import read_choice, read_formula, read_numeric, read_text, read_truth
from camgeo.schema.reader import Reader

if TYPE_CHECKING:
    from camgeo.schema.reader import Readers

READERS: Readers = {
    Kind.TEXT: read_text,
    Kind.NAME: read_text,
    Kind.CHOICE: read_choice,
    Kind.LENGTH: read_numeric,
    Kind.AREA: read_numeric,
    Kind.ANGLE: read_numeric,
    Kind.NUMBER: read_numeric,
    Kind.INTEGER: read_numeric,
    Kind.STROKE: read_numeric,
    Kind.ERROR: read_numeric,
    Kind.OUTPUT: read_numeric,
    Kind.TRUTH: read_truth,
    Kind.RATIO: read_text,
    Kind.FORMULA: read_formula,
    Kind.POINT: read_point,
    Kind.PAIR: read_pair,
    Kind.HARMONICS: read_harmonics,
    Kind.NUMBERS: read_numbers,
    Kind.TABLE: Reader.mapping,
}
