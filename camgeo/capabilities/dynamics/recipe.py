"""Key `dynamics` of a recipe, and the figures that recipes limit."""

from __future__ import annotations

from typing import TYPE_CHECKING

from camgeo.capabilities.dynamics.figures import FIGURES
from camgeo.capabilities.dynamics.keys import build, check, fields
from camgeo.recipe.extension import Keys

if TYPE_CHECKING:
    from camgeo.capabilities.dynamics.keys import Dynamics


def _speed(train: Dynamics) -> float:
    return train.rpm


ANSWERS = Keys(fields=fields, check=check, build=build, speed=_speed, figures=FIGURES)
