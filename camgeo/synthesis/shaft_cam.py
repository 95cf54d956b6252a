"""A cam among several on one shaft."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from camgeo.recipe.recipe import Recipe
    from camgeo.synthesis.design import Design


class ShaftCam(NamedTuple):
    """One of several cams on a shaft; lengths are mm, angles rad.

    name       its name, which no other cam of the shaft has
    recipe     its own recipe, with the unit and the sense of rotation of the shaft
    design     its exact cam
    at         angle by which its metal is turned, counter-clockwise in a drawing for rotation `cw`
    zero       shaft angle at which its motion begins
    low, high  its ends along the shaft
    events     lift of its follower at which events are stated; None: no events
    """

    name: str
    recipe: Recipe
    design: Design
    at: float
    zero: float
    low: float
    high: float
    events: float | None
