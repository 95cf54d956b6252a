"""Contours that are the exact one elsewhere: told by how much, and wrong all the same."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from support import followers
from support.camfiles import support_points, write_dxf
from support.cases import examples
from support.intent import part_of

from kin.contour.contour import Contour
from kin.contour.placement import placement
from kin.judge.intent import Limits
from kin.judge.verify import verify
from kin.law.support_function import lift_from_fourier
from kin.numeric.lengths import mirrored, shown

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

YOKE = followers.yoke(lift_from_fourier(25.0, {3: 2.0}, {5: 0.3}), 50.0)
TOLERANCE = 0.01


def turned(points: np.ndarray, degrees: float) -> np.ndarray:
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    return points @ np.array([[c, s], [-s, c]])


def larger(points: np.ndarray, by: float) -> np.ndarray:
    along = np.roll(points, -1, axis=0) - np.roll(points, 1, axis=0)
    return points + by * np.column_stack([along[:, 1], -along[:, 0]]) / np.hypot(*along.T)[:, None]


def words(points: np.ndarray) -> str:
    return shown(marked_words(points))


def marked_words(points: np.ndarray) -> str:
    return placement(
        Contour.from_vertices(points),
        YOKE.envelope.points(np.linspace(0.0, 2.0 * np.pi, 720, endpoint=False)),
        TOLERANCE,
    )


@pytest.mark.thin(14)
@pytest.mark.parametrize(
    ("placed", "expected"),
    [
        (lambda exact: exact, ""),
        (lambda exact: turned(exact, 180.0), "turned by 180 degrees"),
        (lambda exact: turned(exact, -33.3), "turned by -33.3 degrees"),
        (lambda exact: exact + np.array([2.65, -1.32]), "moved by (2.65, -1.32) mm"),
        (lambda exact: (exact * [1.0, -1.0])[::-1], "mirrored in the x axis"),
        (lambda exact: turned((exact * [1.0, -1.0])[::-1], 40.0), "mirrored in the x axis, turned by 40 degrees"),
        (lambda exact: 25.4 * exact, "25.4 times as large"),
        (lambda exact: exact / 25.4, "25.4 times as small"),
        (lambda exact: 25.4 * exact + [100.0, 0.0], "25.4 times as large, moved by (100, 0) mm"),
        (lambda exact: 0.1 * exact + [0.5, -2.0], "10 times as small, moved by (0.5, -2) mm"),
        (lambda exact: 10.0 * larger(exact, 0.1), "10 times as large, 1 mm larger all round"),
        (lambda exact: larger(exact, 0.1), "0.1 mm larger all round"),
        (lambda exact: larger(exact, -0.15), "0.15 mm smaller all round"),
        (lambda exact: turned(exact, 40.0) + np.array([3.0, 4.0]), "turned by 40 degrees, moved by (3, 4) mm"),
        (lambda exact: 1.3 * exact, ""),
        (lambda exact: exact * [1.02, 1.0], ""),
        (lambda exact: np.where(np.arange(len(exact))[:, None] == 7, 1.05, 1.0) * exact, ""),
        (lambda exact: exact[:3] * [1.0, 0.0], ""),
    ],
)
def test_what_makes_the_exact_one_fit(placed: Callable[[np.ndarray], np.ndarray], expected: str) -> None:
    assert words(placed(support_points(2000))) == (f"it is the exact one {expected}" if expected else "")


def test_words_of_a_mirrored_drawing_place_the_mirrored_exact_one() -> None:
    """A cam turned by 40 degrees and moved by (3, 4) is, drawn mirrored, turned by -40 and moved by (3, -4)."""
    words = mirrored(marked_words(turned(support_points(2000), 40.0) + np.array([3.0, 4.0])))
    assert shown(words) == "it is the exact one turned by -40 degrees, moved by (3, -4) mm"
    assert (
        shown(words, 25.4, "inch")
        == "it is the exact one turned by -40 degrees, moved by (0.118110236, -0.157480315) inch"
    )


@given(st.floats(-179.0, 179.0), st.floats(-20.0, 20.0), st.floats(-20.0, 20.0))
@settings(max_examples=examples(10), deadline=None)
def test_any_turn_and_shift(degrees: float, x: float, y: float) -> None:
    said = words(turned(support_points(500), degrees) + np.array([x, y]))
    for name, value, accuracy in (("turned by ", degrees, 0.03), ("moved by (", x, 0.03), (", ", y, 0.03)):
        if abs(value) > 0.1 and name in said:
            told = said.rpartition(name)[2].split(" ")[0].strip("(),")
            assert float(told) == pytest.approx(value, abs=accuracy)
    assert said or max(abs(degrees), abs(x), abs(y)) < 0.1


@pytest.mark.slow
def test_it_stays_wrong(tmp_path: Path) -> None:
    path = write_dxf(tmp_path / "cam.dxf", turned(support_points(2000), 180.0))
    checks = {check.name: check for check in verify(path, part_of(YOKE, bore=10.0), 90, Limits(TOLERANCE)).checks}
    assert not checks["contour"].ok
    assert checks["contour"].detail.endswith("; it is the exact one turned by 180 degrees")
    assert not checks["motion"].ok
