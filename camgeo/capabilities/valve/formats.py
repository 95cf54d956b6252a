"""The table of a valve as CSV."""

from __future__ import annotations

from camgeo.capabilities.valve.table import FORM
from camgeo.formats.extension import Tables

ANSWERS = Tables(tables={FORM.name: FORM})
