"""Two elastic contacts that hold a follower from both sides, against springs pushed together by bisection."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest

from kin.follower.contact_forces import Elastic, Guided, preloaded

if TYPE_CHECKING:
    from collections.abc import Callable

    from kin.numeric.arrays import Array

MANY = 400
RNG = np.random.default_rng(1)
LEVERS = RNG.uniform(0.3, 1.0, (2, MANY))
OVERLAPS, STIFFNESS = (0.012, 0.007), (30_000.0, 12_000.0)
PAIR = preloaded((LEVERS[0], LEVERS[1]), OVERLAPS, STIFFNESS)
ENDS = RNG.uniform(-1.0, 1.0, (2, 2, MANY))
RUB = RNG.choice([-1.0, 0.0, 1.0], MANY) * RNG.uniform(0.05, 0.4, MANY)


def pressed(outward: Array) -> Array:
    """P1 and P2 (2, n) of a follower `outward` along its travel from where it would touch a metal of no overlap."""
    first = STIFFNESS[0] * np.maximum(OVERLAPS[0] - LEVERS[0] * outward, 0.0) * LEVERS[0]
    second = STIFFNESS[1] * np.maximum(OVERLAPS[1] + LEVERS[1] * outward, 0.0) * LEVERS[1]
    return np.array([first, second])


def along(pair: Array, rub: Array) -> Array:
    """Force of both contacts along the travel, less what the guide's ends rub."""
    reactions = pair[0] * ENDS[0] + pair[1] * ENDS[1]
    rubbed: Array = pair[0] - pair[1] - rub * np.abs(reactions).sum(axis=0)
    return rubbed


def balanced(force: Array, given: Callable[[Array], Array]) -> Array:
    """P1 and P2 (2, n) at which what is given, falling as the follower goes out, is `force`, by bisection."""
    low, high = np.full(MANY, -10.0), np.full(MANY, 10.0)
    for _ in range(80):
        middle = 0.5 * (low + high)
        more = given(pressed(middle)) > force
        low, high = np.where(more, middle, low), np.where(more, high, middle)
    return pressed(0.5 * (low + high))


def test_a_preload_is_where_both_contacts_press_alike() -> None:
    first, second = balanced(np.zeros(MANY), lambda pair: pair[0] - pair[1])
    assert first == pytest.approx(second, rel=1e-9)
    assert PAIR.preload == pytest.approx(first, rel=1e-9)
    assert PAIR.together == pytest.approx(np.ones(MANY), abs=0.0)


def test_a_force_is_shared_by_stiffness_until_one_contact_is_lost() -> None:
    force = RNG.uniform(-900.0, 900.0, MANY)
    expected = balanced(force, lambda pair: pair[0] - pair[1])
    assert PAIR.split(force) == pytest.approx(expected, rel=1e-8, abs=1e-7)
    lost = (expected == 0.0).sum(axis=1)
    assert (lost > 30).all()
    assert (force > PAIR.loses_second).sum() == lost[1]
    assert (force < PAIR.loses_first).sum() == lost[0]
    assert PAIR.split(PAIR.loses_second)[1] == pytest.approx(np.zeros(MANY), abs=1e-9)
    assert PAIR.split(PAIR.loses_first)[0] == pytest.approx(np.zeros(MANY), abs=1e-9)


def test_narrower_metal_takes_preload_and_never_more_than_there_is() -> None:
    """Both contacts in line, 10 N/mm and 40 N/mm on 0.5 mm: 8 N/mm together, 4 N; 0.2 mm less leaves 2.4 N."""
    pair = Elastic(np.array([4.0, 4.0, 4.0]), np.full(3, 10.0), np.full(3, 40.0))
    assert pair.apart(np.array([0.0, 0.2, 0.7])).preload == pytest.approx([4.0, 2.4, 0.0], abs=1e-12)
    assert (pair.loses_second[0], pair.loses_first[0]) == (5.0, -20.0)


def test_a_guide_that_rubs() -> None:
    """What is left of force and stiffness for the worst signs of the guide's reactions, and the forces of both."""
    guided = Guided(PAIR, ENDS, RUB)
    one, none = np.ones(MANY), np.zeros(MANY)
    assert guided.alone[0] == pytest.approx(along(np.array([one, none]), RUB), rel=1e-12)
    assert guided.alone[1] == pytest.approx(-along(np.array([none, one]), RUB), rel=1e-12)
    # 1 mm outward takes K1 of P1 and gives K2 to P2; the friction of both ends changes by as much as their reactions do
    first, second = (k * lever**2 for k, lever in zip(STIFFNESS, LEVERS, strict=True))
    changed = np.abs(second * ENDS[1] - first * ENDS[0]).sum(axis=0)
    share = 1.0 - np.abs(RUB) * changed / (first + second)
    assert guided.together == pytest.approx(share, rel=1e-12)

    force = RNG.uniform(-900.0, 900.0, MANY)
    free = (guided.alone > 0.0).all(axis=0) & (share > 0.0)
    found, expected = guided.split(force), balanced(force, lambda pair: along(pair, RUB))
    assert free.sum() > 0.6 * MANY
    assert found[:, free] == pytest.approx(expected[:, free], rel=1e-8, abs=1e-7)
    assert along(found, RUB)[free] == pytest.approx(force[free], rel=1e-9, abs=1e-7)
    for loses, contact in ((guided.loses_second, 1), (guided.loses_first, 0)):
        assert guided.split(loses)[contact][free] == pytest.approx(np.zeros(free.sum()), abs=1e-8)
        lost = force > loses if contact else force < loses
        assert ((expected[contact] == 0.0) == lost)[free].all()


def test_a_guide_that_jams_has_no_forces() -> None:
    """With 1 N on the contact that pushes both ends bear 2 N; friction of 0.26 takes more, of 0.24 all but 4 %."""
    pair = Elastic(*(np.full(2, value) for value in (4.0, 10.0, 10.0)))
    ends = np.array([[[2.0, 2.0], [-2.0, -2.0]], [[0.0, 0.0], [0.0, 0.0]]])
    guided = Guided(pair, ends, np.array([0.26, 0.24]))
    assert guided.alone == pytest.approx(np.array([[-0.04, 0.04], [1.0, 1.0]]), abs=1e-12)
    assert guided.together == pytest.approx([0.48, 0.52], rel=1e-12)
    assert np.isnan(guided.split(np.array([100.0, 100.0]))).tolist() == [[True, False], [True, False]]
    assert guided.split(np.array([100.0, 100.0]))[:, 1] == pytest.approx([2500.0, 0.0], rel=1e-12)
