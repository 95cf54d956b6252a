"""Contours closed across a slot: where it is closed, by what, and what a follower touches there."""

import math

import numpy as np
import pytest

from kin.contour.across import Bridge, bulge_across, closed_across, notched, tented
from kin.contour.contour import Contour
from kin.follower.measured import positions
from kin.follower.unknown import stretches, unknown_angles
from kin.law.contacts import Contact, KnifeEdge, Roller, Translating

RADIUS, ECCENTRIC, HALF = 20.0, 3.0, 3.0  # of the disc, of its middle, and half the slot's width, mm
RIM = math.sqrt(RADIUS**2 - HALF**2)


def slotted(turn: float = 0.0, *, rounded: float = 0.0) -> Contour:
    """A round disc about (3, 0) with a slot from x = -RIM + 3 to a round end about the shaft, clockwise."""
    bulge = math.tan(0.25 * (2.0 * math.pi - 2.0 * math.asin(HALF / RADIUS)))
    out = ECCENTRIC - RIM
    points = np.array([(out, HALF), (0.0, HALF), (0.0, -HALF), (out, -HALF)])
    bulges = np.array([0.0, -1.0, 0.0, bulge])
    if rounded:  # edges that are broken at 45 degrees
        points = np.insert(points, [1, 3], [(out + rounded, HALF), (out + rounded, -HALF)], axis=0)
        points[0, 1] += rounded
        points[5, 1] -= rounded
        points[[0, 5], 0] = ECCENTRIC - math.sqrt(RADIUS**2 - (HALF + rounded) ** 2)
        sweep = 2.0 * math.pi - 2.0 * math.asin((HALF + rounded) / RADIUS)
        bulges = np.array([0.0, 0.0, -1.0, 0.0, 0.0, math.tan(0.25 * sweep)])
    return Contour.from_bulges(points, bulges).turned(turn)


@pytest.mark.parametrize("turn", [0.0, 2.0])
@pytest.mark.parametrize("rounded", [0.0, 0.5])
def test_a_slot_is_closed_between_the_last_places_of_the_rim_that_the_shaft_sees(turn: float, rounded: float) -> None:
    contour = slotted(turn, rounded=rounded)
    closed, bridge = closed_across(contour, "arc") or pytest.fail("no slot")
    ends = np.array(bridge)
    assert np.hypot(*ends.T) == pytest.approx([math.hypot(RIM - ECCENTRIC - rounded, HALF)] * 2, rel=1e-3)
    assert np.degrees(np.diff(bridge.angles)) == pytest.approx(
        2.0 * math.degrees(math.asin(HALF / math.hypot(*ends[0])))
    )
    # the arc is about the shaft
    assert closed.area > 0.0
    last = closed.radius[-1]
    assert last == pytest.approx(math.hypot(*ends[0]))
    assert closed.centre[-1] == pytest.approx([0.0, 0.0], abs=1e-9)
    assert closed.area == pytest.approx(math.pi * RADIUS**2, rel=0.01)
    mirrored, turned = closed_across(contour.reversed(), "chord") or pytest.fail("no slot")
    assert turned == bridge
    assert mirrored.area < closed.area


def test_no_slot_is_found_beside_the_shaft() -> None:
    assert closed_across(slotted().moved(40.0, 0.0), "arc") is None
    assert (
        closed_across(slotted().moved(0.0, 10.0), "arc") is None
    )  # the shaft lies in the metal's bay, not in its hull


def test_an_arc_between_places_at_different_distances_has_its_centre_near_the_shaft() -> None:
    start, end = np.array([10.0, 0.0]), np.array([0.0, 12.0])
    bulge = bulge_across(start, end, "arc")
    arc = Contour.from_bulges(np.array([start, end, [-9.0, -9.0]]), np.array([bulge, 0.0, 0.0]))
    middle, chord = 0.5 * (start + end), end - start
    assert float((arc.centre[0] - middle) @ chord) == pytest.approx(0.0, abs=1e-9)
    assert float(arc.centre[0] @ np.array([-chord[1], chord[0]])) == pytest.approx(0.0, abs=1e-9)
    assert bulge_across(start, end, "chord") == 0.0


@pytest.mark.parametrize("touch", [Roller(5.0), KnifeEdge()])
def test_what_a_follower_touches_there_is_known_to_be_unknown(touch: Roller | KnifeEdge) -> None:
    contact = Contact(Translating(0.0), touch)
    closed, bridge = closed_across(slotted(), "arc") or pytest.fail("no slot")
    phi = np.radians(np.arange(0.0, 360.0, 0.5) + 0.25)
    unknown = unknown_angles(closed, bridge, contact, 1, phi)
    ((begin, end),) = stretches(phi, unknown)
    first, last = bridge.angles
    assert (begin, end) == pytest.approx((first, last), abs=math.radians(0.6))
    # elsewhere the positions are those of the contour without it
    known = positions(closed, contact, 1, phi[~unknown])
    assert known == pytest.approx(positions(notched(closed, bridge), contact, 1, phi[~unknown]), abs=1e-9)


def test_tangents_stand_in_place_of_the_stretch_up_to_where_they_meet() -> None:
    """On a circle without a quarter turn that is the corner of the square round it; without 176, none."""
    for part, count in ((90.0, 1), (176.0, 2)):
        t = np.radians(np.array([0.5 * part, 180.0, 360.0 - 0.5 * part]))
        places = 20.0 * np.column_stack([np.cos(t), np.sin(t)])
        quarter = math.tan(0.25 * (math.pi - math.radians(0.5 * part)))
        contour = Contour.from_bulges(places, np.array([quarter, quarter, 0.0]))
        tent = tented(contour, Bridge(tuple(places[2]), tuple(places[0])))
        assert len(tent) == 3 + count
        if count == 1:
            assert tent.end[-2] == pytest.approx([20.0 * math.sqrt(2.0), 0.0])


def test_stretches_run_on_over_the_end_of_the_turn() -> None:
    phi = np.radians(np.arange(0.0, 360.0, 90.0))
    assert np.degrees(stretches(phi, np.array([True, False, False, True]))).tolist() == [[270.0, 360.0]]
    assert stretches(phi, np.zeros(4, dtype=bool)) == []
    assert stretches(phi, np.ones(4, dtype=bool)) == [(0.0, 2.0 * math.pi)]


def test_a_stretch_is_placed_as_its_contour() -> None:
    bridge = Bridge((1.0, 2.0), (-1.0, 3.0))
    assert bridge.mirrored() == Bridge((-1.0, -3.0), (1.0, -2.0))
    assert np.array(bridge.turned(0.5 * math.pi)) == pytest.approx(np.array([(-2.0, 1.0), (-3.0, -1.0)]))
    assert bridge.scaled(2.0).moved(1.0, 0.0) == Bridge((3.0, 4.0), (-1.0, 6.0))
