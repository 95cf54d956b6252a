"""What searches add to recipes: the key `sweep` and a starter."""

from __future__ import annotations

from typing import TYPE_CHECKING

from camgeo.capabilities.sweep.keys import build_sweep, check_sweep, fields
from camgeo.registry.capability import Capability

if TYPE_CHECKING:
    from collections.abc import Mapping

    from camgeo.recipe.starter import Starter


def _starters() -> Mapping[str, Starter]:
    from camgeo.capabilities.sweep.starter import STARTERS

    return STARTERS


CAPABILITY = Capability(fields=fields, check=check_sweep, build=build_sweep, starters=_starters)
