"""Shop drawings of parts by chance: nothing over anything else, all within the frame, leaders clear of openings.

Holds: camgeo.capabilities.sheet.callouts.
"""

from __future__ import annotations

import functools
import tempfile
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import pytest
from shapely.geometry import LineString, Polygon
from support.cases import few
from support.random_parts import random_part
from support.sheets import demand_clear

import camgeo
from camgeo.capabilities.sheet import drawing, views
from camgeo.recipe.recipe import load_text

if TYPE_CHECKING:
    from camgeo.capabilities.sheet.part import DrawnDisc
    from camgeo.capabilities.sheet.views import Layout

TRIES = 12  # of a seed, until a part keeps its walls


class Made(NamedTuple):
    """A drawing that was made: its pages, the disc, the places of its views."""

    pages: drawing.Pages
    drawn: DrawnDisc
    layout: Layout


@functools.cache
def made(seed: int) -> Made:
    """The drawing of the first part of a seed that is made."""
    seen: dict[str, Any] = {}
    lay_out, pages = views.lay_out, drawing._pages

    def kept(drawn: DrawnDisc, *arguments: Any) -> Layout:
        seen["drawn"], seen["layout"] = drawn, lay_out(drawn, *arguments)
        return seen["layout"]

    def paged(*arguments: Any, **options: Any) -> drawing.Pages:
        seen["pages"] = pages(*arguments, **options)
        return seen["pages"]

    with pytest.MonkeyPatch.context() as patch, tempfile.TemporaryDirectory() as folder:
        patch.setattr(drawing, "lay_out", kept)
        patch.setattr(drawing, "_pages", paged)
        for attempt in range(TRIES):
            text = random_part(seed, attempt)
            try:
                camgeo.export(load_text(text, f"p{attempt}.yaml"), folder)
            except camgeo.RecipeErrors:
                continue
            if seen:
                return Made(seen["pages"], seen["drawn"], seen["layout"])
    raise AssertionError(f"no part of seed {seed} is made")


def through_openings(made: Made) -> list[str]:
    """Texts whose leaders run through an opening of the face, by the outlines of the openings."""
    k, openings = made.layout.scale, [loop.points for loop in made.drawn.loops if loop.layer != "CUT"]
    areas = [Polygon(k * points).buffer(-1e-3) for points in openings]
    found = []
    for callout in made.layout.callouts:
        line = LineString(callout.leader)
        # a chord of an opening lies within its circle by less than this
        if any(line.intersection(area).length > 0.05 for area in areas):
            found.append(callout.row.text)
    return found


def demand_sound(made: Made) -> None:
    demand_clear(made.pages)
    assert through_openings(made) == []
    texts = [text.text for text in made.pages.annotated[0].texts if text.layer == "DIM" and text.text.startswith("Ø")]
    about = [text for text in texts if " " not in text]
    assert len(about) == len(set(about)), about


@pytest.mark.slow
@pytest.mark.parametrize("seed", few(range(8), 8))
def test_of_a_part_by_chance(seed: int) -> None:
    demand_sound(made(seed))


@pytest.mark.costly("the first part by chance that is made")
def test_a_planted_leader_through_an_opening_is_seen() -> None:
    found = made(0)
    callouts = found.layout.callouts
    x = found.layout.scale * found.drawn.reach
    planted = [callouts[0]._replace(leader=np.array([(-x, 0.0), (x, 0.01)])), *callouts[1:]]
    assert through_openings(found._replace(layout=found.layout._replace(callouts=planted))) == [callouts[0].row.text]
