"""Key `sweep` of a recipe."""

from __future__ import annotations

from camgeo.capabilities.sweep.keys import build_sweep, check_sweep, fields
from camgeo.recipe.extension import Keys

ANSWERS = Keys(fields=fields, check=check_sweep, build=build_sweep)
