"""Layers of a solid for the judge: heights, insets, outlines and the openings through each, by hand.

Holds: camgeo.part.hub, camgeo.part.chamfer, camgeo.part.set_screw.
"""

import math

import pytest

from camgeo.part.as_intent import holes_of, layers_of
from camgeo.part.body import Body
from camgeo.part.chamfer import Chamfer
from camgeo.part.hub import Hub
from camgeo.part.set_screw import SetScrew
from camgeo.part.shapes import disc
from kin.numeric.records import replace
from kin.read.layers import CrossHole

BORE = disc("bore", "BORE", (0.0, 0.0), 6.0)
FAR = disc("dowel hole", "HOLES", (20.0, 0.0), 2.0)
MARK = replace(disc("mark", "ENGRAVE", (15.0, 0.0), 1.0), depth=0.5)


def spans(body):
    return [(layer.low, layer.high, layer.inset) for layer in layers_of(body)]


def names(body):
    return [[hole.name for hole in layer.holes] for layer in layers_of(body)]


def test_a_plain_disc_is_one_layer_and_one_without_thickness_is_none():
    assert spans(Body(8.0, (BORE,))) == [(0.0, 8.0, (0.0, 0.0))]
    assert layers_of(Body(None, (BORE,))) == ()


def test_a_chamfer_leans_below_and_above():
    assert spans(Body(8.0, (), features=(Chamfer(1.0),))) == [
        (0.0, 1.0, (1.0, 0.0)),
        (1.0, 7.0, (0.0, 0.0)),
        (7.0, 8.0, (0.0, 1.0)),
    ]


@pytest.mark.parametrize(
    ("side", "ends"), [("top", [(8.0, 13.0)]), ("bottom", [(-5.0, 0.0)]), ("both", [(-5.0, 0.0), (8.0, 13.0)])]
)
def test_a_hub_stands_on_its_side_and_what_goes_through_it_goes_on(side, ends):
    body = Body(8.0, (BORE, FAR), features=(Hub(20.0, 5.0, side),))
    outlined = [layer for layer in layers_of(body) if layer.outline is not None]
    assert [(layer.low, layer.high) for layer in outlined] == ends
    assert [[hole.name for hole in layer.holes] for layer in outlined] == [["bore"]] * len(ends)
    assert all(layer.outline.name == "hub" for layer in outlined)
    assert (body.bottom, body.top) == (min(0.0, ends[0][0]), max(8.0, ends[-1][1]))


def test_an_engraving_is_in_the_upper_layer_alone():
    body = Body(8.0, (BORE, MARK))
    assert spans(body) == [(0.0, 7.5, (0.0, 0.0)), (7.5, 8.0, (0.0, 0.0))]
    assert names(body) == [["bore"], ["bore", "mark"]]
    assert [(hole.kind, hole.depth) for hole in holes_of(body)] == [("bore", None), ("mark", 0.5)]


def test_a_groove_has_a_floor_below_its_contours():
    body = Body(12.0, (BORE,), outer=160.0, pocket=6.0)
    assert [(layer.low, layer.high, layer.outline is not None) for layer in layers_of(body)] == [
        (0.0, 6.0, True),
        (6.0, 12.0, False),
    ]


@pytest.mark.parametrize(
    ("side", "height", "z"), [("top", None, 10.5), ("both", 1.0, 9.0), ("bottom", None, -2.5), ("bottom", 1.0, -1.0)]
)
def test_a_set_screw_is_drilled_through_the_upper_one_of_two_hubs(side, height, z):
    screw = SetScrew(4.0, math.pi / 3, height)
    body = Body(8.0, (BORE,), features=(Hub(20.0, 5.0, side), screw))
    assert body.cross_holes == (CrossHole("set screw", math.pi / 3, 4.0, z),)
    assert body.mirrored().cross_holes == (CrossHole("set screw", -math.pi / 3, 4.0, z),)
    assert Body(8.0, (BORE,), features=(screw,)).cross_holes == ()


def test_a_polygon_is_fitted_finer_for_the_inner_edge_of_a_chamfer():
    # share c/r = 1/4: (1 - c/r)/(1 + c/r)
    assert Body(8.0, (), features=(Chamfer(1.0),), least_radius=4.0).fineness == pytest.approx(0.6)
    assert Body(8.0, ()).fineness == 1.0
