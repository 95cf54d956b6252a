"""Advice by which checks and limits of a follower train would hold."""

from __future__ import annotations

from typing import TYPE_CHECKING

from camgeo.capabilities.dynamics.figures import (
    BACKLASH_LEFT,
    FORCE_GREATEST,
    FORCE_LEAST,
    GUIDE_FORCE,
    JAM_MARGIN,
    LEAST_FORCE,
    MEAN_FORCE,
    PEAK_FORCE,
    PRESSURE,
    TORQUE,
)
from camgeo.capabilities.dynamics.keys import Dynamics
from camgeo.checks.remedies import worst
from camgeo.common.rounding import downward, upward

if TYPE_CHECKING:
    from camgeo.checks.declaration import Entry
    from camgeo.recipe.recipe import Recipe


def stronger_spring(check: Entry, report: Entry, recipe: Recipe) -> str:
    """Words with the preload, or the coil spring's force, at which contact holds as intended and with every file.

    Empty where contact holds, and for a train without a spring. In an elastic train the contact gets k/(k + k_p) of a
    greater preload, with k the stiffness of the train and k_p the rate of the spring; a spring on a valve is felt by
    the tappet times the ratio, of which the least counts.
    """
    train, least = recipe.of(Dynamics), worst(check, report)
    if train is None or not least < 0.0:
        return ""
    yields = 0.0 if train.stiffness is None else train.rate / train.stiffness
    lacking = -least * (1.0 + yields)
    if train.spring is not None:
        felt = report["forces"]["moved"]["ratio"]["min"] if train.spring.on_body else 1.0
        return (
            f"a dynamics.spring of {upward(train.spring.preload + lacking / felt)} N at its seat_length, its rate kept"
        )
    return "" if train.preload is None else f"a dynamics.preload of {upward(train.preload + lacking)}"


def of_limit(recipe: Recipe, figure: str, value: float, bound: float) -> str:
    """Words for a change that brings a figure's `value` towards `bound`, both in the figure's unit.

    Empty for a bound of 0 or less, for a figure without advice, and where the advice would not help.
    """
    if bound <= 0.0:
        return ""
    if figure == BACKLASH_LEFT:
        return "a greater dynamics.backlash, or a lower dynamics.rpm" if value < bound else ""
    if figure == JAM_MARGIN:
        advice, shorter = recipe.cam.advice, "a longer guide, less overhang or friction of it"
        larger = f", or {advice.larger}, {advice.less_steep}" if advice.larger and not recipe.cam.sizes else ""
        return shorter + larger if value < bound else ""
    held = ("dynamics.spring", "dynamics.preload", "dynamics.least_force", "cam.preload.interference")
    spring = next((path for path in held if path in recipe.marks), "")
    more, less = ("stronger", "weaker") if spring == "dynamics.spring" else ("greater", "smaller")
    if figure in {FORCE_LEAST, LEAST_FORCE}:
        return f"a {more} {spring}, or a lower dynamics.rpm" if spring and value < bound else ""
    if figure not in {PRESSURE, FORCE_GREATEST, PEAK_FORCE, TORQUE, GUIDE_FORCE, MEAN_FORCE}:
        return ""
    raised = value < bound
    forces = "more mass or load" if raised else "less mass or load"
    forces = f"a {more if raised else less} {spring}, {forces}" if spring else forces
    if figure == PRESSURE:  # Hertz's pressure grows with the root of force over width
        share = (value / bound) ** 2
        if raised:
            return f"contacts {downward(share)} times as wide (part.thickness, a chamfer), a smaller radius, {forces}"
        wider = f"contacts {upward(share)} times as wide (part.thickness, less chamfer, a deeper groove)"
        return f"{wider}, a larger radius, {forces}"
    return f"a {'shorter' if raised else 'longer'} guide, or {forces}" if figure == GUIDE_FORCE else forces
