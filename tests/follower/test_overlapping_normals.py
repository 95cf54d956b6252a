"""Whether neighbours' normals overlap so much that it matters which of them bears: R b^2/2 against rounding."""

from __future__ import annotations

import math
from types import SimpleNamespace

import numpy as np
import pytest

from kin.contour.pieces import ARC, LINE
from kin.follower.support import _overlap

EPS = np.finfo(float).eps


class Pieces(SimpleNamespace):
    def __len__(self) -> int:
        return len(self.kind)


def pieces(radius: list[float], turns: list[float], joints: list[float], kinds: list[int]) -> Pieces:
    """Pieces whose chord is radius times turn; `joints` are the turns of the tangent from the piece before."""
    chord = np.array(radius) * np.array(turns)
    start, end = np.zeros((len(chord), 2)), np.column_stack([chord, 0.0 * chord])
    turned = {"turns": np.array(turns), "joints": np.array(joints), "kind": np.array(kinds)}
    return Pieces(start=start, end=end, vertices=np.array([[64.0, -10.0]]), **turned)


@pytest.mark.parametrize("place", [0, 1, 2])
def test_where_the_tangent_turns_back_onto_an_arc_or_from_one(place: int) -> None:
    """Radii 30, 10 and 1 mm on a contour 64 mm wide: 4 rounding errors of 64 mm are R b^2/2 of the larger neighbour."""
    radius = [30.0, 10.0, 1.0]
    larger = max(radius[place], radius[place - 1])
    just = math.sqrt(2.0 * 4.0 * EPS * 64.0 / larger)
    for share, overlaps in ((0.99, False), (1.01, True), (-5.0, False)):
        joints = [0.0, 0.0, 0.0]
        joints[place] = -share * just
        made = pieces(radius, [0.5, 0.5, 0.5], joints, [ARC, ARC, ARC])
        assert _overlap(made) is overlaps


def test_a_line_has_no_radius() -> None:
    made = pieces([1e9, 0.0], [1e-9, 0.0], [-1e-6, -1e-6], [LINE, ARC])
    assert _overlap(made) is False
