"""The shaft's sections by hand, and how high its knob must stand for bodies that pass under it."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
import pytest

from camgeo.capabilities.mechanism.assembly import Member, Plate
from camgeo.capabilities.mechanism.shaft import Disk, Drive, bearing, least_pad_radius, shaft_in, shaft_members
from camgeo.capabilities.mechanism.shapes import disc
from camgeo.capabilities.mechanism.sizes import BodyError, Sizes
from camgeo.recipe.loading import read
from kin.contour.contour import Contour

if TYPE_CHECKING:
    from camgeo.part.part import Part
    from kin.numeric.arrays import Array

SIZES = Sizes(
    clearance=0.4, gap=0.3, press=0.1, space=1.0, pin=5.0, bar=9.0, plate=4.0, link=3.0, wall=2.0, clip=2.0, knob=16.0
)


def part(text: str) -> Part:
    whole = f"part: {{thickness: 8, {text}}}\ncam: {{kind: support, p: 30 + cos(2*t)}}\n"
    return read(whole.encode(), "c.yaml").part


@pytest.mark.parametrize(
    ("text", "journal", "across", "excess", "area"),
    [
        ("bore: 10", 4.8, 5.05, None, math.pi * 5.05**2),
        # a hexagon of 9.6 mm across its flats
        (
            "bore: {hexagon: 10}",
            4.8,
            4.8 / math.cos(math.pi / 6),
            9.6 / math.cos(math.pi / 6) - 10.0,
            0.8660254 * 9.6**2,
        ),
        # a circle of 4.8 mm cut 2.8 mm beyond its middle
        (
            "bore: 10, flat: {across: 8}",
            2.8,
            4.8,
            1.6,
            math.pi * 4.8**2 - 4.8**2 * math.acos(2.8 / 4.8) + 2.8 * math.sqrt(15.2),
        ),
    ],
)
def test_a_shaft_is_half_the_clearance_smaller_than_its_bore(
    text: str, journal: float, across: float, excess: float | None, area: float
) -> None:
    shaft = shaft_in(part(text), SIZES)
    assert (shaft.journal, shaft.across) == pytest.approx((journal, across), rel=1e-9)
    assert shaft.excess == (None if excess is None else pytest.approx(excess, rel=1e-9))
    assert shaft.pressed == (excess is None)
    drive = Contour.from_bulges(shaft.drive.points, shaft.drive.bulges)
    assert drive.area == pytest.approx(area, rel=1e-6)
    assert np.hypot(*drive.sample(200).T).max() == pytest.approx(across, rel=1e-9)


def test_a_key_is_narrower_than_its_keyway() -> None:
    """A bore of 10 mm, 3 mm wide up to 6.4 mm from the middle: 2.6 mm on the shaft, up to 6.2 mm."""
    shaft = shaft_in(part("bore: 10, keyway: {width: 3, depth: 1.4}"), SIZES)
    corner = math.hypot(6.2, 1.3)
    drive = Contour.from_bulges(shaft.drive.points, shaft.drive.bulges)
    assert np.hypot(*drive.sample(200).T).max() == pytest.approx(corner, rel=1e-9)
    assert corner <= shaft.across < corner + 0.05
    assert shaft.excess == pytest.approx(4.8 + corner - 10.0, rel=1e-9)
    assert shaft.journal == pytest.approx(4.8, rel=1e-12)


def test_a_journal_is_no_thinner_than_2_mm_and_the_remedy_does() -> None:
    """A bore of 2.3 mm leaves 1.9 mm, 4 mm is the least that is named; a flat leaves 6 - 0.4 - 4.55 = 1.05 mm."""
    with pytest.raises(BodyError, match=r"a journal of 1\.9 mm") as caught:
        shaft_in(part("bore: 2.3"), SIZES)
    assert caught.value.texts()[1] == "give a bore of 4 mm or more"
    assert shaft_in(part("bore: 4"), SIZES).journal == pytest.approx(1.8)
    assert shaft_in(part("bore: 9.5, flat: {across: 6}"), SIZES).journal == pytest.approx(1.05)
    with pytest.raises(BodyError, match=r"a journal of 1\.9 mm"):
        shaft_in(part("bore: 9.5, flat: {across: 5.9}"), SIZES)


def members(others: list[Member], text: str = "bore: 10") -> tuple[Member, Member, Member]:
    disk = Disk((Plate(disc(30.0), (disc(5.0),), 0.0, 8.0),), 8.0, -2.0, 11.0)
    return shaft_members(Drive(disk, 30.0, shaft_in(part(text), SIZES), SIZES), 20.0, turning(0.0, 0.0, 0.0), others)


def turning(x: float, y: float, turned: float, swing: float = 0.0):
    """A place at (x, y), turned by an angle, rad, that swings by `swing` to either side."""

    def place(t: Array, order: int) -> Array:
        assert order == 0
        return np.array([np.full_like(t, x), np.full_like(t, y), turned + swing * np.sin(t)])[:, None]

    return place


def heights(member: Member) -> list[tuple[float, float]]:
    return [(plate.low, plate.high) for plate in member.plates]


def test_sections_of_a_shaft() -> None:
    """The hub reaches from 18 to 31 mm, with 0.3 mm of air below the knob, which is 3 mm thick."""
    cam, shaft, clip = members([])
    assert [h for pair in heights(cam) for h in pair] == [20.0, 28.0]
    assert [h for pair in heights(shaft) for h in pair] == pytest.approx([0.3, 18.0, 18.0, 31.3, 31.3, 34.3])
    areas = [Contour.from_bulges(p.outline.points, p.outline.bulges).area for p in shaft.plates]
    knob = 2.0 * math.sqrt(2.0) * 8.0**2 / math.cos(math.pi / 8.0) ** 2  # an octagon 16 mm across its flats
    assert areas == pytest.approx([math.pi * 4.8**2, math.pi * 5.05**2, knob], rel=1e-9)
    assert clip.group == shaft.group == cam.group
    (ring,) = clip.plates  # pressed on the journal, 2 mm wide and high
    sizes = [Contour.from_bulges(*_arcs(one)).area / math.pi for one in (ring.outline, *ring.holes)]
    assert (ring.low, ring.high, *sizes) == pytest.approx((0.3, 2.3, 6.8**2, 4.75**2))


@pytest.mark.parametrize("seed", range(6))
def test_the_knob_stands_above_what_passes_under_it(seed: int) -> None:
    """A disc on a body that swings: the knob's corners with 1 mm of air pass within 9.66 mm of the shaft."""
    rng = np.random.default_rng(seed)
    x, y = 30.0 * np.array([math.cos(seed), math.sin(seed)])
    turned, swing = rng.uniform(-3.0, 3.0), rng.uniform(0.1, 0.6)
    along, across = rng.uniform(5, 15), rng.uniform(-8, 8)
    angle = turned + swing * np.sin(np.linspace(0.0, 2.0 * math.pi, 20_001))
    middle = complex(x, y) + complex(along, across) * np.exp(1j * angle)
    near = float(np.abs(middle).min()) - 8.0 / math.cos(math.pi / 8.0) - 1.0
    assert near > 0.5
    for radius, passes in ((near - 0.05, False), (near + 0.05, True)):
        for high, above in ((35.0, True), (31.3, False)):
            plates = (Plate(disc(radius, along, across), (), 1.0, high), Plate(disc(0.5, 40.0, 40.0), (), 30.0, 50.0))
            other = Member("other", plates, "other", turning(x, y, turned, swing))
            _, shaft, _ = members([other])
            top = 35.3 if passes and above else 31.3
            assert heights(shaft)[-1] == pytest.approx((top, top + 3.0))
            assert len(shaft.plates) == (4 if passes and above else 3)
            if passes and above:  # a collar 2 mm wide, from where the drive ends
                assert heights(shaft)[2] == pytest.approx((31.3, 35.3))
                assert Contour.from_bulges(*_arcs(shaft.plates[2].outline)).area == pytest.approx(math.pi * 7.05**2)


def test_the_bearing_in_the_base() -> None:
    """A sink of 4.8 + 2 + 1 mm and 2 + 0.6 mm deep, a hole of 5 mm through the plate of 4 mm, a boss 2 mm wide."""
    disk = Disk((Plate(disc(30.0), (disc(5.0),), 0.0, 8.0),), 8.0, -2.0, 11.0)
    drive = Drive(disk, 30.0, shaft_in(part("bore: 10"), SIZES), SIZES)
    assert least_pad_radius(drive) == pytest.approx(9.8)
    for high, boss in ((4.14, False), (4.16, True)):
        plates = bearing(drive, [disc(20.0)], high)
        assert len(plates) == (3 if boss else 2)
        told = [(plate.low, plate.high, abs(Contour.from_bulges(*_arcs(plate.holes[0])).area)) for plate in plates]
        expected = [(0.0, 2.6, math.pi * 7.8**2), (2.6, 4.0, math.pi * 25.0), (4.0, high, math.pi * 25.0)]
        assert np.ravel(told) == pytest.approx(np.ravel(expected[: len(plates)]), rel=1e-9)
        if boss:
            assert Contour.from_bulges(*_arcs(plates[2].outline)).area == pytest.approx(math.pi * 49.0, rel=1e-9)


def _arcs(outline) -> tuple[Array, Array]:
    return outline.points, outline.bulges
