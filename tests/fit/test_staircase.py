"""Chains of linear equations against the same system written out in full."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from camgeo.fit.staircase import UNKNOWNS, solve_chains


def links_of(lengths: list[int], seed: int) -> tuple[np.ndarray, np.ndarray]:
    """Random equations, as many as unknowns: three a link, but two for the first and the last of a chain."""
    rng = np.random.default_rng(seed)
    chain = np.repeat(np.arange(len(lengths)), lengths)
    links = rng.normal(size=(chain.size, 3, 8))
    first = np.flatnonzero(np.diff(chain, prepend=-1))
    last = np.append(first[1:] - 1, chain.size - 1)
    links[first, 2] = 0.0
    links[last, 1] = 0.0
    return links, chain


def in_full(links: np.ndarray) -> tuple[np.ndarray, float]:
    """Joints (n + 1, 3) and number of one chain, from a dense matrix."""
    n = len(links)
    matrix = np.zeros((3 * n, UNKNOWNS * (n + 1) + 1))
    for i, rows in enumerate(links):
        matrix[3 * i : 3 * i + 3, UNKNOWNS * i : UNKNOWNS * (i + 2)] = rows[:, :6]
        matrix[3 * i : 3 * i + 3, -1] = rows[:, 6]
    inner = matrix[:, UNKNOWNS : -UNKNOWNS - 1]
    solution = np.linalg.lstsq(np.column_stack([inner, matrix[:, -1]]), links[:, :, 7].ravel(), rcond=None)[0]
    joints = np.zeros((n + 1, UNKNOWNS))
    joints[1:-1] = solution[:-1].reshape(-1, UNKNOWNS)
    return joints, float(solution[-1])


@given(st.lists(st.integers(2, 19), min_size=1, max_size=6), st.integers(0, 1000))
def test_chains_are_solved_each_by_itself(lengths: list[int], seed: int) -> None:
    links, chain = links_of(lengths, seed)
    joints, numbers = solve_chains(links.copy(), chain)
    begin = 0
    for number, length in enumerate(lengths):
        own, expected = in_full(links[begin : begin + length])
        mine = joints[begin + number : begin + number + length + 1]
        scale = 1e-7 * (1.0 + np.abs(own).max() + abs(expected))
        assert numbers[number] == pytest.approx(expected, abs=scale)
        assert mine == pytest.approx(own, abs=scale)
        begin += length


def test_the_equations_hold() -> None:
    links, chain = links_of([64, 2, 33], 5)
    joints, numbers = solve_chains(links, chain)
    left = np.arange(chain.size) + chain
    known = np.concatenate([joints[left], joints[left + 1], numbers[chain, None]], axis=1)
    assert np.einsum("nij,nj->ni", links[:, :, :7], known) == pytest.approx(links[:, :, 7], abs=1e-9)


def test_what_is_not_determined_is_no_number_to_work_with() -> None:
    links, chain = links_of([4], 1)
    links[:, :, 6] = 0.0
    assert not np.isfinite(solve_chains(links, chain)[1]).all()
