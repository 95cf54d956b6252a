"""Which function reads which kind of field."""

from __future__ import annotations

from typing import TYPE_CHECKING

from camgeo.recipe.read_limits import read_limits
from camgeo.recipe.read_linkage import read_cam, read_dyads, read_linkage
from camgeo.recipe.read_list import (
    read_files,
    read_harmonics,
    read_law,
    read_numbers,
    read_pair,
    read_point,
    read_segments,
)
from camgeo.recipe.read_part import read_bore, read_keyway
from camgeo.recipe.read_scalar import read_choice, read_formula, read_numeric, read_text, read_truth
from camgeo.recipe.read_sweep import read_vary
from camgeo.recipe.reader import Reader
from camgeo.recipe.spec import Kind

if TYPE_CHECKING:
    from camgeo.recipe.reader import Readers

READERS: Readers = {
    Kind.TEXT: read_text,
    Kind.NAME: read_text,
    Kind.CHOICE: read_choice,
    Kind.LENGTH: read_numeric,
    Kind.AREA: read_numeric,
    Kind.ANGLE: read_numeric,
    Kind.NUMBER: read_numeric,
    Kind.INTEGER: read_numeric,
    Kind.ERROR: read_numeric,
    Kind.OUTPUT: read_numeric,
    Kind.TRUTH: read_truth,
    Kind.RATIO: read_text,
    Kind.FORMULA: read_formula,
    Kind.POINT: read_point,
    Kind.PAIR: read_pair,
    Kind.HARMONICS: read_harmonics,
    Kind.LAW: read_law,
    Kind.NUMBERS: read_numbers,
    Kind.TABLE: Reader.mapping,
    Kind.SEGMENTS: read_segments,
    Kind.FILES: read_files,
    Kind.CAM: read_cam,
    Kind.LINKAGE: read_linkage,
    Kind.DYADS: read_dyads,
    Kind.VARY: read_vary,
    Kind.LIMITS: read_limits,
    Kind.BORE: read_bore,
    Kind.KEYWAY: read_keyway,
}
