"""Checks of a follower train, each declared once."""

from __future__ import annotations

from typing import TYPE_CHECKING

from camgeo.capabilities.dynamics.figures import BACKLASH_LEFT
from camgeo.capabilities.dynamics.keys import Dynamics
from camgeo.capabilities.dynamics.remedies import stronger_spring
from camgeo.checks.declared import FACE_WIDTH, OUTPUT, Declared, run_with

if TYPE_CHECKING:
    from camgeo.checks.declared import CheckFacts


def _guided(scene: CheckFacts) -> bool:
    train = scene.recipe.of(Dynamics)
    return train is not None and train.guide is not None


def _sprung(scene: CheckFacts) -> bool:
    train = scene.recipe.of(Dynamics)
    if train is None or train.backlash is not None:
        return False
    return train.stiffness is not None or not scene.follower.closure


def _elastic(scene: CheckFacts) -> bool:
    train = scene.recipe.of(Dynamics)
    return _sprung(scene) and train is not None and train.stiffness is not None


def _loose(scene: CheckFacts) -> bool:
    train = scene.recipe.of(Dynamics)
    return train is not None and train.backlash is not None


JAM = Declared("guide-jam", ("deg", "mm"), _guided, field="dynamics.guide", strict=True, after=FACE_WIDTH.name)
FLOAT = Declared(
    "float",
    ("N", "N m"),
    _sprung,
    lambda scene, file: _elastic(scene) and run_with(scene, file),
    field="dynamics.preload",
    remedy=stronger_spring,
    after=OUTPUT.name,
)
LEAST_BACKLASH = Declared(
    BACKLASH_LEFT,
    ("mm", "deg", "N"),
    _loose,
    lambda scene, file: _loose(scene) and run_with(scene, file),
    strict_at=(0.0,),
    after=OUTPUT.name,
)

CHECKS = (JAM, FLOAT, LEAST_BACKLASH)
