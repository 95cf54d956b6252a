"""Options that formats of files share."""

from __future__ import annotations

from camgeo.recipe.machining import COMPENSATION
from camgeo.schema.fields import Field, Kind, length

TOLERANCE = length("tolerance", "greatest distance between this file's contour and the exact one", default="export's")


def _units(default: str) -> Field:
    about = "unit of the file's numbers, which the file states where its format can"
    return Field("units", Kind.CHOICE, about, default=default, choices=("mm", "inch"))


RECIPE_UNITS, SOLID_UNITS = _units("the recipe's"), _units("mm")
OF_DRAWING = (RECIPE_UNITS, TOLERANCE, *COMPENSATION)
OF_SOLID = (SOLID_UNITS, TOLERANCE, *COMPENSATION)
