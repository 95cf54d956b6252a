"""Checks of a follower train, each declared once."""

from __future__ import annotations

from typing import TYPE_CHECKING

from camgeo.capabilities.dynamics.figures import BACKLASH_LEFT
from camgeo.capabilities.dynamics.keys import Dynamics
from camgeo.capabilities.dynamics.remedies import stronger_spring
from camgeo.checks.declaration import Declared
from camgeo.checks.declared import FACE_WIDTH, OUTPUT, run_with

if TYPE_CHECKING:
    from camgeo.checks.declaration import CheckFacts


def _guided(facts: CheckFacts) -> bool:
    train = facts.recipe.of(Dynamics)
    return train is not None and train.guide is not None


def _sprung(facts: CheckFacts) -> bool:
    train = facts.recipe.of(Dynamics)
    if train is None or train.backlash is not None:
        return False
    return train.stiffness is not None or not facts.follower.closure


def _elastic(facts: CheckFacts) -> bool:
    train = facts.recipe.of(Dynamics)
    return _sprung(facts) and train is not None and train.stiffness is not None


def _loose(facts: CheckFacts) -> bool:
    train = facts.recipe.of(Dynamics)
    return train is not None and train.backlash is not None


JAM = Declared("guide-jam", ("deg", "mm"), _guided, field="dynamics.guide", strict=True, after=FACE_WIDTH.name)
FLOAT = Declared(
    "float",
    ("N", "N m"),
    _sprung,
    lambda facts, file: _elastic(facts) and run_with(facts, file),
    field="dynamics.preload",
    remedy=stronger_spring,
    after=OUTPUT.name,
)
LEAST_BACKLASH = Declared(
    BACKLASH_LEFT,
    ("mm", "deg", "N"),
    _loose,
    lambda facts, file: _loose(facts) and run_with(facts, file),
    strict_at=(0.0,),
    after=OUTPUT.name,
)

CHECKS = (JAM, FLOAT, LEAST_BACKLASH)
