"""Key `mechanism` of a recipe, figures that it limits, and the option `parts` of solids."""

from __future__ import annotations

from typing import TYPE_CHECKING

from camgeo.capabilities.mechanism.figures import FIGURES
from camgeo.capabilities.mechanism.keys import PARTS, build, check, fields
from camgeo.recipe.extension import Keys, Variant

if TYPE_CHECKING:
    from camgeo.registry.formats import Format


def _tag(record: Format) -> str:
    """Ending of the name of a request's first file: the cam's file, or the file of all bodies."""
    if record.by_disc:
        return "cam"
    return "parts" if record.contour else "assembly"


ANSWERS = Keys(
    fields=fields,
    build=build,
    figures=FIGURES,
    variant=Variant(option=PARTS, offered=lambda record: record.mesh, tag=_tag, check=check),
)
