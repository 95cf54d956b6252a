"""A bolt circle: where its holes lie, and holes that would meet."""

import math

import pytest
from support.parts import recipe_of

from camgeo.part.bolts import FEATURE, Bolts
from camgeo.schema.errors import RecipeErrors


def test_holes_at_equal_angles_from_the_first():
    holes = FEATURE.openings(Bolts(4, 40.0, 6.0, math.pi / 2))
    assert [hole.name for hole in holes] == [f"bolt hole {k}" for k in (1, 2, 3, 4)]
    assert [hole.circle[0] for hole in holes] == [
        pytest.approx(place, abs=1e-12) for place in ((0, 20), (-20, 0), (0, -20), (20, 0))
    ]
    assert {hole.circle[1] for hole in holes} == {3.0}


def test_holes_as_wide_as_they_stand_apart_are_refused():
    with pytest.raises(RecipeErrors, match=r"part\.bolts\.hole: not below the distance between two of them"):
        recipe_of("{bolts: {count: 6, circle: 30, hole: 15}}")  # whose chord is the radius
    recipe_of("{bolts: {count: 6, circle: 30, hole: 14.99}}")
