"""A design as what draws it sees it: contacts in the fixed axes, and views of one kind of follower alone."""

from __future__ import annotations

import numpy as np
import pytest

from camgeo.recipe.loading import load_text
from camgeo.synthesis.design import designed
from camgeo.synthesis.view import view_of
from kin.law.contacts import Flat, Roller, Translating

DISC = """
cam:
  kind: disc
  base_radius: 20
  follower: {kind: roller, radius: 5}
  motion: [{rise: 8, over: 180, law: cycloidal}, {return: 8, over: 180, law: cycloidal}]
"""
SHAFT = np.linspace(0.0, 6.0, 13)


def test_a_roller_on_the_x_axis_touches_its_cam_a_radius_away_from_its_centre():
    recipe = load_text(DISC, "cam.yaml")
    view = view_of(recipe, designed(recipe))
    (points,) = view.contact_points_fixed(SHAFT)
    lift = view.travel(SHAFT)[0]
    from_centre = points - (25.0 + lift)
    assert np.abs(from_centre) == pytest.approx(np.full(13, 5.0), abs=1e-9)
    # the contact lies off the stem on the side that comes on: at the pressure angle, above 0 on a rise
    assert np.angle(-from_centre) == pytest.approx(-view.pressure(SHAFT), abs=1e-9)


def test_a_view_of_another_follower_is_refused():
    recipe = load_text(DISC, "cam.yaml")
    view = view_of(recipe, designed(recipe))
    assert view.of(Translating, Roller).touch.radius == 5.0
    with pytest.raises(TypeError, match="no Flat on a guide Translating"):
        view.of(Translating, Flat)
    with pytest.raises(TypeError, match="no flat face is touched"):
        view.place(SHAFT)
