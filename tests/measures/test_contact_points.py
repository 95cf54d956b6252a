"""Points of contact as a drawing has them, and on a contour: a roller's centre is its radius away along the normal."""

import math
from pathlib import Path

import numpy as np
import pytest

from camgeo.measures.contact_points import ContactPoints, contact_points
from camgeo.recipe.loading import load_text
from camgeo.synthesis.design import designed

DISC = """
cam:
  kind: disc
  base_radius: 20
  follower: {kind: roller, radius: 5}
  motion: [{rise: 8, over: 180, law: cycloidal}, {return: 8, over: 180, law: cycloidal}]
"""


def test_turned_and_mirrored_as_drawn():
    points = ContactPoints(np.zeros(1), np.array([[3.0, 1.0]]), np.array([[0.0, 1.0]]))
    turned = points.as_drawn(0.5 * math.pi, "cw")
    assert turned.places.tolist() == pytest.approx(np.array([[-1.0, 3.0]]))
    assert turned.normals == pytest.approx(np.array([[-1.0, 0.0]]))
    assert points.as_drawn(0.0, "ccw").places.tolist() == [[3.0, -1.0]]


def test_the_centre_of_a_roller_is_its_radius_beyond_the_contact():
    design = designed(load_text(DISC, Path("cam.yaml")))
    (points,) = contact_points(design, np.linspace(0.0, 6.0, 25), design.contours)
    centres = points.places + 5.0 * points.normals
    assert np.hypot(*points.normals.T) == pytest.approx(np.ones(25), abs=1e-12)
    lift = design.motion.travel(points.angles, 0)[0]
    assert np.hypot(*centres.T) == pytest.approx(25.0 + lift, abs=1e-9)
