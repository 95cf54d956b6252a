"""Followers of a call: what goes together, the base circle that each touches, and its keys in a recipe."""

from __future__ import annotations

import math
from typing import Any

import pytest
import yaml

from camgeo.capabilities.follow.follower import describe_follower
from camgeo.common.errors import CallError

NONE: dict[str, Any] = {
    "roller": None,
    "shoe": None,
    "flat": False,
    "width": None,
    "offset": 0.0,
    "arm": (),
    "leading": False,
    "yoke": False,
    "track": "external",
}


@pytest.mark.parametrize(
    ("call", "position", "radius"),
    [
        ({"roller": 5.0, "offset": 9.0}, 12.0, 10.0),  # hypot(12, 9) less the roller
        ({"roller": 5.0, "offset": 9.0, "track": "internal"}, 12.0, 20.0),
        ({"flat": True}, 12.0, 12.0),
        ({"flat": True, "arm": (20.0,)}, math.radians(30.0), 10.0),
        ({"roller": 2.0, "arm": (50.0, 30.0)}, 0.5 * math.pi, math.hypot(50.0, 30.0) - 2.0),
    ],
)
def test_the_circle_that_a_follower_touches(call: dict[str, Any], position: float, radius: float) -> None:
    assert describe_follower(**NONE | call).base_radius(position) == pytest.approx(radius)


def test_its_keys_are_those_of_a_recipe() -> None:
    follower = describe_follower(**NONE | {"roller": 8.0, "arm": (80.0, 65.0), "leading": True})
    assert yaml.safe_load(follower.keys) == {
        "kind": "roller",
        "radius": 8.0,
        "arm": {"length": 65.0, "pivot": 80.0, "side": "leading"},
    }
    assert follower.words == "roller of radius 8 mm on a leading arm of 65 mm, pivot at 80 mm"
    assert follower.motion_to_mm == 65.0
    knife = describe_follower(**NONE | {"roller": 0.0, "offset": -3.0})
    assert yaml.safe_load(knife.keys) == {"kind": "knife-edge", "offset": -3.0}
    assert knife.motion_to_mm == 1.0


def test_all_that_does_not_go_together_is_said_at_once() -> None:
    with pytest.raises(CallError) as caught:
        describe_follower(**NONE | {"shoe": -2.0, "offset": 1.0, "arm": (80.0,), "width": 4.0, "track": "groove"})
    assert [fault.split()[:2] for fault in caught.value.faults] == [
        ["a", "shoe"],
        ["only", "a"],
        ["an", "arm"],
        ["an", "arm"],
        ["in", "a"],
    ]
