"""Key `valve` of a recipe, and the figures that recipes limit."""

from __future__ import annotations

from camgeo.capabilities.valve.figures import FIGURES
from camgeo.capabilities.valve.keys import build, check, fields
from camgeo.recipe.extension import Keys

ANSWERS = Keys(fields=fields, check=check, build=build, figures=FIGURES)
