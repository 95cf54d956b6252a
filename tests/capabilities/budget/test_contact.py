"""Positions of a made follower on made metal, by hand: a round cam whose sizes are off."""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from camgeo.capabilities.budget.contact import ContactPlace, SizeErrors, positions
from camgeo.capabilities.budget.file_metal import ReadMetal
from kin.law.contacts import Contact, Flat, Roller, Translating

if TYPE_CHECKING:
    from kin.numeric.arrays import Array, Complexes

RADIUS = 20.0
BESIDE = 0.7 - math.radians(40.0)  # from the stem, of the x axis of a cam that is turned by 0.7


class Circle:
    """Metal of a round cam about the origin of its axes."""

    def reach(self, normal: Complexes) -> Array:
        return RADIUS * np.abs(normal)

    def along(self, way: Complexes, middle: Complexes, radius: Array) -> Array:
        aside = np.conj(way) * middle
        centre: Array = np.sqrt((RADIUS + radius) ** 2 - aside.imag**2) - aside.real
        return centre

    def arm(self, pivot: Complexes, length: Array, radius: Array) -> Complexes:
        raise NotImplementedError

    def face_normal(self, pivot: Complexes, nearer: Array) -> Complexes:
        raise NotImplementedError


def position(touch: Flat | Roller, degrees: float, **sizes: complex) -> float:
    """Position of a stem at a shaft angle, degrees, where some sizes are off."""
    angle = np.radians([degrees])
    contact = Contact(Translating(0.0), touch)
    place = ContactPlace(contact, Circle(), angle, np.zeros(1), np.exp(1j * angle), 0.0, 60.0)
    names = ("turned", "bore", "shaft", "pivot", "grown", "offset", "guide", "face", "length", "datum")
    off = SizeErrors(**{name: np.array([[sizes.get(name, 0.0)]]) for name in names})
    return float(positions(place, off)[0, 0].real)


@pytest.mark.parametrize(
    ("touch", "sizes", "expected"),
    [
        (Roller(5.0), {}, 25.0),
        (Roller(5.0), {"grown": 0.1}, 25.1),
        (Roller(5.0), {"offset": 7.0}, 24.0),  # of a triangle 7, 24, 25
        (Roller(5.0), {"shaft": 0.3}, 25.3),  # the shaft stands nearer the follower
        (
            Roller(5.0),
            {"bore": 0.3, "turned": 0.7},
            0.3 * math.cos(BESIDE) + math.sqrt(625.0 - (0.3 * math.sin(BESIDE)) ** 2),
        ),
        (Flat(), {"grown": 0.1}, 20.1),
        (Flat(), {"face": 0.1}, 20.0 / math.cos(0.1)),
        (Flat(), {"datum": 0.25}, 19.75),
    ],
)
def test_a_round_cam_with_a_size_that_is_off(touch: Flat | Roller, sizes: dict[str, complex], expected: float) -> None:
    assert position(touch, 40.0, **sizes) == pytest.approx(expected, abs=1e-9)


@pytest.mark.parametrize("top", [-9, -4, 0, 4, 9])
def test_more_points_are_looked_at_where_the_first_or_the_last_holds_the_touch(top: int) -> None:
    """Of four on either side of the nearest, as wide as the search begins."""
    index = np.arange(200)
    held = -np.abs(index - (100 + top)).astype(float)
    metal: Any = SimpleNamespace(points=index + 0j, side=1, wander=0.0, _few=lambda *_: 4)
    found = ReadMetal._nearby(metal, lambda within: held[within][None], (), 100.0 + 0j)
    assert found.tolist() == [0.0]
