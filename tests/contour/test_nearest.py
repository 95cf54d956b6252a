"""Nearest pieces of chains: as if every piece were looked at, in bounded memory and with few looks."""

from __future__ import annotations

import tracemalloc

import numpy as np
import pytest

from kin.contour import nearest as module
from kin.contour.arcs import Arcs, nearest_on, turned
from kin.contour.nearest import nearest


def chain(count: int, bend: float) -> Arcs:
    """Pieces along a lobed curve, each turning by up to `bend` either way."""
    t = np.linspace(0.0, 2.0 * np.pi, count, endpoint=False)
    r = 20.0 + 5.0 * np.cos(3.0 * t)
    start = np.column_stack([r * np.cos(t), r * np.sin(t)])
    chord = np.roll(start, -1, axis=0) - start
    length = np.hypot(chord[:, 0], chord[:, 1])
    half = 0.5 * bend * np.random.default_rng(count).uniform(-1.0, 1.0, count)
    tangent, bow = turned(chord / length[:, None], -half), length / np.sinc(half / np.pi)
    return Arcs(start, tangent, 2.0 * np.sin(half) / length, bow)


def points(arcs: Arcs) -> np.ndarray:
    """Places near and far, the shaft's centre, and places that two pieces share."""
    scattered = np.random.default_rng(0).uniform(-40.0, 40.0, (40, 2))
    on = arcs.start[:20], arcs.ends[:20], arcs.points(0.5 * arcs.length)
    return np.concatenate([scattered, np.zeros((1, 2)), *on])


@pytest.mark.thin(8)
@pytest.mark.parametrize("bend", [0.0, 0.4, np.pi - 1e-9])
@pytest.mark.parametrize("count", [3, 17, 150])
@pytest.mark.parametrize("order", ["chain", "any", "twice"])
def test_first_of_all_the_pieces_that_are_nearest(count: int, bend: float, order: str) -> None:
    arcs = chain(count, bend)
    where = points(arcs)
    if order == "any":
        arcs = arcs.take(np.random.default_rng(1).permutation(count))
    elif order == "twice":
        arcs = arcs.joined(arcs)
    every = np.array([nearest_on(arcs, np.tile(point, (len(arcs), 1)))[1] for point in where])
    piece, distance = nearest(arcs, where)
    assert np.array_equal(piece, every.argmin(axis=1))
    assert np.array_equal(distance, every.min(axis=1))


@pytest.mark.parametrize("count", [1000, 10_000])
def test_few_pieces_are_looked_at_for_a_place_off_the_chain(count: int, monkeypatch: pytest.MonkeyPatch) -> None:
    t = np.linspace(0.0, 2.0 * np.pi, count, endpoint=False)
    start = 30.0 * np.column_stack([np.cos(t), np.sin(t)])
    chord = np.roll(start, -1, axis=0) - start
    length = np.hypot(chord[:, 0], chord[:, 1])
    arcs = Arcs(start, chord / length[:, None], np.zeros(count), length)
    looks: list[int] = []

    def counted(taken: Arcs, where: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        looks.append(len(where))
        return nearest_on(taken, where)

    monkeypatch.setattr(module, "nearest_on", counted)
    angle = np.linspace(0.0, 2.0 * np.pi, 3001)
    nearest(arcs, 38.0 * np.column_stack([np.cos(angle), np.sin(angle)]))
    assert sum(looks) <= 4 * angle.size


@pytest.mark.slow
def test_memory_does_not_grow_with_points_that_all_pieces_are_nearest_to() -> None:
    t = np.linspace(0.0, 2.0 * np.pi, 1000, endpoint=False)
    heading = np.column_stack([-np.sin(t), np.cos(t)])
    arcs = Arcs(np.column_stack([np.cos(t), np.sin(t)]), heading, np.ones(t.size), np.full(t.size, t[1]))
    tracemalloc.start()
    nearest(arcs, np.zeros((4000, 2)))
    _, most = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert most < 100e6


def test_loops_that_close_within_a_run() -> None:
    """Three squares of eight pieces each: the chord of each run has no length."""
    side = np.array([[0, 0], [1, 0], [2, 0], [2, 1], [2, 2], [1, 2], [0, 2], [0, 1]], dtype=np.float64)
    start = np.concatenate([side + place for place in ([0.0, 0.0], [10.0, 0.0], [0.0, 10.0])])
    ahead = np.roll(side, -1, axis=0) - side
    arcs = Arcs(start, np.tile(ahead, (3, 1)), np.zeros(24), np.ones(24))
    where = points(arcs)
    every = np.array([nearest_on(arcs, np.tile(point, (24, 1)))[1] for point in where])
    piece, distance = nearest(arcs, where)
    assert np.array_equal(piece, every.argmin(axis=1))
    assert np.array_equal(distance, every.min(axis=1))
