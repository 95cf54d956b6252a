"""A flat in a bore: its outline, and widths that leave none."""

import math

import pytest
from support.parts import recipe_of

from camgeo.part.flat import FEATURE, Flat
from camgeo.schema.errors import RecipeErrors


def test_the_bore_is_as_wide_as_it_says_towards_the_flat():
    x_min, y_min, x_max, y_max = FEATURE.bore(Flat(17.0, math.pi / 2), 10.0).box()
    assert [x_min, x_max, y_max - y_min] == pytest.approx([-10.0, 10.0, 17.0])


@pytest.mark.parametrize(
    ("across", "problem"),
    [(12, "the bore's diameter"), (6, "not above half the bore"), (5, "half the bore")],
)
def test_a_width_without_a_flat_is_refused(across, problem):
    with pytest.raises(RecipeErrors, match=problem):
        recipe_of(f"{{bore: 12, flat: {{across: {across}}}}}")
    recipe_of("{bore: 12, flat: {across: 11.9}}")
