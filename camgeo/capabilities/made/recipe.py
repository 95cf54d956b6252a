"""Key `made` of a recipe, and the options `correct` and `local` of files."""

from __future__ import annotations

from typing import TYPE_CHECKING

from camgeo.capabilities.made.keys import CORRECT, LOCAL, ZONE_PATH, build, check, check_corrected, fields, offered
from camgeo.recipe.extension import Alteration, Keys

if TYPE_CHECKING:
    from camgeo.capabilities.made.keys import Made


def _profile(made: Made) -> tuple[str, float] | None:
    """Field and width, mm, of the tolerance zone of a measured contour; None for a recipe without it."""
    return None if made.profile is None else (ZONE_PATH, made.profile)


ANSWERS = Keys(
    fields=fields,
    check=check,
    build=build,
    profile=_profile,
    alteration=Alteration(option=CORRECT, offered=offered, check=check_corrected, beside=LOCAL),
)
