"""Outlines cut into a part: areas in closed form, directions, and quarter turns that are exact."""

import math

import pytest

from camgeo.part.shapes import disc, flattened, hole_at, keyed, polar, polygonal, slot, strip


def test_a_keyway_adds_what_lies_beyond_the_circle():
    r, b, t = 10.0, 6.0, 2.8
    beyond = b * (r + t) - b * math.sqrt(r * r - b * b / 4) - (r * r * math.asin(b / 2 / r) * 1.0 - 0.0)
    # a rectangle from the chord to the bottom, less the segment of the circle over the chord
    chord = math.sqrt(r * r - b * b / 4)
    segment = r * r * math.asin(b / (2 * r)) - 0.5 * b * chord
    assert keyed(r, b, t, 0.3).area == pytest.approx(math.pi * r * r + b * (r + t - chord) - segment)
    assert beyond < b * (r + t)


def test_a_flat_takes_a_segment():
    r, across = 10.0, 18.0
    half = math.acos((across - r) / r)
    assert flattened(r, across, 1.0).area == pytest.approx(math.pi * r * r - r * r * (half - math.sin(2 * half) / 2))


@pytest.mark.parametrize(("sides", "area"), [(4, 100.0), (6, 50.0 * math.sqrt(3.0))])
def test_a_polygon_has_its_width_across_flats(sides, area):
    assert polygonal(sides, 10.0, 0.2).area == pytest.approx(area)
    x_min, _, x_max, _ = polygonal(sides, 10.0, 0.0).box()
    assert x_max - x_min == pytest.approx(10.0)


def test_slots_and_strips():
    assert slot(5.0, 15.0, 4.0).area == pytest.approx(4.0 * 6.0 + math.pi * 4.0)
    assert slot(5.0, 15.0, 4.0).box() == pytest.approx((5.0, -2.0, 15.0, 2.0))
    assert strip(20.0, 4.0, 0.0).area == pytest.approx(80.0)


def test_quarter_turns_are_exact():
    assert [polar(3.0, k * math.pi / 2) for k in range(4)] == [(3.0, 0.0), (0.0, 3.0), (-3.0, 0.0), (0.0, -3.0)]
    assert hole_at("dowel hole", 40.0, 6.0, math.pi / 2).circle == ((0.0, 20.0), 3.0)


def test_a_mirror_image_keeps_size_and_depth():
    hole = disc("bore", "BORE", (3.0, 4.0), 2.0)
    assert hole.mirrored().circle == ((3.0, -4.0), 2.0)
    assert hole.mirrored().outline.area == pytest.approx(4.0 * math.pi)
    assert (hole.middle, hole.radius) == ((3.0, 4.0), 2.0)
