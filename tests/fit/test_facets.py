"""Triangles on a cylinder, whose second derivatives are known: none is farther off than its bound."""

import math
from types import SimpleNamespace

import numpy as np
import pytest

from camgeo.fit.facets import facets_off, facets_width

RADIUS = 40.0


def cylinder(count):
    """Bounds of (R cos a, R sin a, b): |p_11| is R, along the normal, which turns by a."""
    rows = np.array([[RADIUS], [0.0], [0.0]]) * np.ones(count)
    return SimpleNamespace(across=rows, whole=rows, turns=np.array([[1.0], [0.0]]) * np.ones(count))


@pytest.mark.parametrize("h1", [0.01, 0.1, 0.3])
def test_a_chord_is_within_its_bound_and_the_bound_is_near(h1):
    sagitta = RADIUS * (1.0 - math.cos(0.5 * h1))
    bound = facets_off(cylinder(1), np.array([h1]), 5.0)[0]
    assert sagitta <= bound <= sagitta * (1.01 + 2.2 * h1)


@pytest.mark.parametrize("tolerance", [1e-4, 1e-2, 0.5])
def test_a_width_holds_its_tolerance_and_little_less(tolerance):
    width = facets_width(cylinder(3), 5.0, tolerance)
    off = facets_off(cylinder(3), width, 5.0)
    assert (off <= tolerance * (1.0 + 1e-12)).all()
    assert (off >= 0.5 * tolerance).all()


def test_no_width_is_fine_enough_where_the_other_side_is_too_wide():
    bent = SimpleNamespace(across=np.ones((3, 1)), whole=np.ones((3, 1)), turns=np.zeros((2, 1)))
    assert facets_width(bent, 1.0, 0.1).tolist() == [0.0]
