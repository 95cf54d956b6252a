"""The table of forces as CSV."""

from __future__ import annotations

from camgeo.capabilities.dynamics.table import FORM
from camgeo.formats.extension import Tables

ANSWERS = Tables(tables={FORM.name: FORM})
