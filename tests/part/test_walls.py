"""Shapes cut into a part and the walls between them, against closed forms; the keyways of DIN 6885."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from support.cases import examples
from support.heavy import shapely
from support.places import RECIPES

from camgeo.curve.curvature import roots
from camgeo.curve.curve import Curve
from camgeo.curve.support import SupportShape
from camgeo.fit.bound import EXACT
from camgeo.fit.pieces import ArcSpline
from camgeo.part import walls as part_walls
from camgeo.part.checks import ROUNDING, thinnest, walls
from camgeo.part.din6885 import TABLE, key_for
from camgeo.part.shapes import Opening, disc, flattened, keyed, polar, polygonal, slot
from camgeo.part.walls import Looks, contour_gap, distance_inside, inside_gap, least_wall, outside_gap
from camgeo.recipe.loading import load
from camgeo.synthesis.design import designed
from kin.contour.contour import Contour
from kin.law.support_function import lift_from_fourier, lift_reuleaux


def circle(pivot, radius=25.0):
    return Curve.whole(SupportShape(lift_from_fourier(radius, {}, {}, pivot)))


@pytest.mark.parametrize("pivot", [(3.0, 4.0), (-12.0, 5.0), (0.0, -24.0)])
def test_circle_off_its_shaft(pivot):
    wall, at = least_wall(Looks.of(circle(pivot)), 8.0)
    assert wall == pytest.approx(25.0 - math.hypot(*pivot) - 4.0, abs=1e-12)
    # nearest where the outward normal points from the centre to the shaft
    assert math.cos(at - math.atan2(pivot[1], pivot[0])) == pytest.approx(1.0, abs=1e-12)


def test_shaft_outside_the_contour():
    wall, _ = least_wall(Looks.of(circle((30.0, 40.0))), 8.0)
    assert wall == pytest.approx(-(50.0 - 25.0) - 4.0, abs=1e-12)


def test_reuleaux_about_its_middle():
    # a flank is an arc of radius w - r about the middle of the opposite corner, (w - 2 r)/sqrt 3 from the shaft
    wall, _ = least_wall(Looks.of(Curve.whole(SupportShape(lift_reuleaux(3, 50.0, 5.0)))), 10.0)
    assert wall == pytest.approx(45.0 - 40.0 / math.sqrt(3.0) - 5.0, abs=1e-9)


def test_point_in_a_circle():
    inside, _ = distance_inside(Looks.of(circle((3.0, 4.0))), (7.0, -4.0))
    assert inside == pytest.approx(25.0 - math.hypot(7.0 + 3.0, -4.0 + 4.0), abs=1e-12)


def test_a_least_distance_is_sought_only_where_it_may_be(monkeypatch):
    """A cam of eleven lobes comes near in eleven places, of which one is by far the nearest from beside the middle."""
    looks = Looks.of(Curve.whole(SupportShape(lift_from_fourier(25.0, {11: 0.15}, {}))))
    sought = []
    monkeypatch.setattr(part_walls, "roots", lambda f, low, *rest: sought.append(low.size) or roots(f, low, *rest))
    t = np.linspace(0.0, 2.0 * np.pi, 200_001)
    points = looks.contour.sample(t).point
    for place in ((0.9, 0.2), (-0.5, 0.8)):
        distance, _ = distance_inside(looks, place)
        assert distance == pytest.approx(np.hypot(*(points - place).T).min(), abs=1e-7)
        gap = contour_gap(looks, disc("hole", "HOLES", place, 3.0).chain)
        assert gap.wall == pytest.approx(distance - 3.0, abs=1e-9)
    assert max(sought) <= 3


# --- shapes ---------------------------------------------------------------------------------------------------------


def test_keyed_bore_has_the_area_and_reach_of_its_formulas():
    r, b, t2 = 6.0, 4.0, 1.8
    outline = keyed(r, b, t2, 0.0)
    h = b / 2
    slot_area = b * (r + t2) - (h * math.sqrt(r * r - h * h) + r * r * math.asin(h / r))
    assert outline.area == pytest.approx(math.pi * r * r + slot_area, rel=1e-14)
    # d + t2, the dimension on a hub's drawing
    x_min, y_min, x_max, y_max = outline.box()
    assert x_max - x_min == pytest.approx(2 * r + t2, abs=1e-14)
    assert (y_min, y_max) == pytest.approx((-r, r), abs=1e-14)


def test_flat_is_as_wide_across_as_asked():
    outline = flattened(6.0, 10.5, 0.0)
    c = 4.5
    assert outline.area == pytest.approx(36 * (math.pi - math.acos(c / 6)) + c * math.sqrt(36 - c * c), rel=1e-14)
    assert outline.box() == pytest.approx((-6.0, -6.0, 4.5, 6.0), abs=1e-14)


@pytest.mark.parametrize(("sides", "area"), [(4, 100.0), (6, 50.0 * math.sqrt(3.0))])
def test_polygonal_bores(sides, area):
    outline = polygonal(sides, 10.0, 0.0)
    assert outline.area == pytest.approx(area, rel=1e-14)
    assert outline.box()[2] == pytest.approx(5.0, abs=1e-14)


def test_slot_lies_on_the_ray():
    outline = slot(10.0, 14.0, 1.0)
    assert outline.area == pytest.approx(3.0 + math.pi / 4, rel=1e-14)
    assert outline.box() == pytest.approx((10.0, -0.5, 14.0, 0.5), abs=1e-14)


@pytest.mark.parametrize(
    "outline", [keyed(6, 4, 1.8, 0.7), flattened(6, 10.5, 2.0), polygonal(6, 10, 0.1), slot(3, 9, 2)]
)
def test_mirroring_and_turning(outline):
    opening = Opening("bore", "BORE", outline)
    mirrored = opening.mirrored().outline
    assert mirrored.area == pytest.approx(outline.area, rel=1e-13)
    assert mirrored.box() == pytest.approx(
        (outline.box()[0], -outline.box()[3], outline.box()[2], -outline.box()[1]), abs=1e-13
    )


def test_directions_on_the_axes_are_exact():
    assert polar(3.0, math.pi / 2) == (0.0, 3.0)
    assert polar(3.0, -math.pi) == (-3.0, 0.0)
    assert keyed(6, 4, 2, math.pi / 2).points[2].tolist() == [2.0, 8.0]


# --- walls ----------------------------------------------------------------------------------------------------------


@given(st.floats(-20, 20), st.floats(-20, 20), st.floats(0.5, 8), st.floats(0.5, 8))
def test_wall_between_two_circles(x, y, r, s):
    one, two = disc("one", "HOLES", (0.0, 0.0), r).chain, disc("two", "HOLES", (x, y), s).chain
    apart = math.hypot(x, y)
    wall = outside_gap(one, two).wall
    if apart > r + s:
        assert wall == pytest.approx(apart - r - s, abs=1e-9)
    else:
        assert wall <= 1e-9
    if apart + s < r - 1e-6:
        assert inside_gap(two, one).wall == pytest.approx(r - apart - s, abs=1e-9)
    elif apart + s > r + 1e-6:
        assert inside_gap(two, one).wall < 0.0


OUTLINES = [keyed(5, 3, 1.4, 0.4), flattened(5, 9, -1.0), polygonal(4, 8, 0.2), slot(-4, 4, 2)]


@settings(max_examples=examples(40))
@given(st.sampled_from(OUTLINES), st.sampled_from(OUTLINES), st.floats(13.5, 20), st.floats(0, 6.28))
def test_wall_between_outlines_is_that_of_fine_polygons(one, two, away, angle):
    moved = ArcSpline(two.points + away * np.array([math.cos(angle), math.sin(angle)]), two.bulges, EXACT)
    chains = [Opening("", "HOLES", outline).chain for outline in (one, moved)]
    regions = [shapely.Polygon(Contour.from_bulges(o.points, o.bulges).sample(200)) for o in (one, moved)]
    expected = regions[0].distance(regions[1])
    assert outside_gap(*chains).wall == pytest.approx(expected, abs=2e-3)
    assert outside_gap(*chains[::-1]).wall == pytest.approx(outside_gap(*chains).wall, abs=1e-9)


@given(st.floats(0, 6.28), st.floats(0, 17), st.floats(0.2, 5))
def test_wall_between_a_hole_and_a_round_contour(angle, away, radius):
    hole = disc("hole", "HOLES", polar(away, angle), radius)
    gap = contour_gap(Looks.of(circle((0.0, 0.0))), hole.chain)
    assert gap.wall == pytest.approx(25.0 - away - radius, abs=1e-9)


def test_wall_of_a_hole_outside_or_across_the_contour_is_negative():
    looks = Looks.of(circle((0.0, 0.0)))
    assert contour_gap(looks, disc("", "HOLES", (40.0, 0.0), 3.0).chain).wall == pytest.approx(-12.0, abs=1e-9)
    assert contour_gap(looks, disc("", "HOLES", (25.0, 0.0), 3.0).chain).wall < -2.9


def test_wall_to_a_keyway_is_to_its_corners():
    key = Opening("bore", "BORE", keyed(6, 4, 1.8, math.pi / 2))
    gap = contour_gap(Looks.of(circle((0.0, 0.0))), key.chain)
    assert gap.wall == pytest.approx(25.0 - math.hypot(7.8, 2.0), abs=1e-9)


# --- DIN 6885-1 -----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("bore", "width", "hub"),
    [(6, 2, 1.0), (8, 2, 1.0), (8.01, 3, 1.4), (12, 4, 1.8), (17, 5, 2.3), (20, 6, 2.8), (25, 8, 3.3), (40, 12, 3.3),
     (50, 14, 3.8), (60, 18, 4.4), (230, 50, 11.4)],
)  # fmt: skip
def test_keys_by_the_bore(bore, width, hub):
    row = key_for(bore)
    assert (row.width, row.hub) == (width, hub)


@pytest.mark.parametrize("bore", [5.99, 230.01])
def test_bores_without_a_key(bore):
    assert key_for(bore) is None


def test_the_table_is_whole_and_its_keys_have_play_in_the_hub():
    assert [row.over for row in TABLE[1:]] == [row.to for row in TABLE[:-1]]
    for row in TABLE:
        play = row.shaft + row.hub - row.height
        assert 0.15 < play < 0.45
        assert row.shaft > row.hub


@pytest.mark.slow
@pytest.mark.parametrize(
    "name",
    [
        "w-law",
        "disc-ring",  # needs: milling
        "disc-packaging",  # needs: milling
        "w-rosette",
        "hypocycloid",
    ],
)
@pytest.mark.parametrize("limit", [0.0, 6.0])
def test_walls_that_are_left_out_are_neither_the_least_nor_thin(name: str, limit: float) -> None:
    recipe = load(RECIPES / f"{name}.yaml")
    design = designed(recipe)
    assert design.only_surface.contour is not None
    assert design.discs[0].body is not None
    looks = Looks.of(design.only_surface.contour, design.only_surface.surface.side)
    possible = list(walls(design.discs[0].body, [looks]))
    every = [(bound, pair()) for bound, pair in possible]
    assert all(bound <= pair.gap.wall + ROUNDING for bound, pair in every)
    whole = sorted((pair for _, pair in every), key=lambda pair: pair.gap.wall)
    most = max(whole[0].gap.wall, limit)
    assert thinnest(possible, limit) == [pair for pair in whole if pair.gap.wall <= most]
