"""The proof of chains by itself: against dense samples, at the limit of a tolerance, and where it has no end."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from support.cases import few

from camgeo.curve.curve import Curve
from camgeo.curve.support import SupportShape
from camgeo.fit import deviation
from camgeo.fit.deviation import FEW, MOST_NODES, SLACK, Chain, chain_deviation, foot, radial, sampled_deviation
from kin.law.support_function import lift_from_fourier

CURVE = Curve.whole(SupportShape(lift_from_fourier(25.0, {3: 2.0}, {5: 0.1}, (18.0, 8.5))))


def pieces(count: int, bend: float = 0.0) -> Chain:
    """Chords of the curve, or arcs so many times as curved as it is."""
    t = np.linspace(0.0, 2.0 * math.pi, count + 1)
    at = CURVE.sample(t)
    chord = np.diff(at.point, axis=0)
    length = np.hypot(chord[:, 0], chord[:, 1])
    turned = np.unwrap(np.arctan2(at.tangent[:, 1], at.tangent[:, 0]))
    curvature = bend * np.diff(turned) / length
    angle = np.arctan2(chord[:, 1], chord[:, 0]) - np.arcsin(0.5 * curvature * length)
    return Chain(at.point[:-1], np.column_stack([np.cos(angle), np.sin(angle)]), curvature, t[:-1], t[1:])


def sampled(chain: Chain) -> tuple[np.ndarray, np.ndarray]:
    """Least and greatest distance of the curve outside each piece, at a thousand places and by the parabola there."""
    share = np.linspace(0.0, 1.0, 1001)
    t = chain.low[:, None] + (chain.high - chain.low)[:, None] * share
    points = CURVE.sample(t.ravel()).point.reshape(*t.shape, 2)
    f, _ = radial(chain.start[:, None], chain.tangent[:, None], chain.curvature[:, None], points)
    return f.min(axis=1), f.max(axis=1)


@pytest.fixture
def looks(monkeypatch: pytest.MonkeyPatch) -> list[tuple[int, int]]:
    """How many pieces each round looked at, and at how many nodes."""
    kept: list[tuple[int, int]] = []
    ranges = deviation._ranges

    def counted(curve: Curve, chain: Chain, nodes: int) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        kept.append((chain.low.size, nodes))
        return ranges(curve, chain, nodes)

    monkeypatch.setattr(deviation, "_ranges", counted)
    return kept


def limit(chain: Chain) -> float:
    """Tolerance halfway between the truth and what the first nodes prove of it, which is less than a proof may lack."""
    low, high = sampled(chain)
    truth = float(np.maximum(high, -low).max())
    first = float(chain_deviation(CURVE, chain, 1e9).worst.max())
    assert truth + 1e-13 < first < truth * (1.0 + SLACK)
    return 0.5 * (truth + first)


@pytest.mark.parametrize("bend", [0.0, 1.0, 2.0])
@pytest.mark.parametrize("count", [12, 36, 200])
def test_what_is_proved_holds_and_is_sharp_on_both_sides(count: int, bend: float) -> None:
    chain = pieces(count, bend)
    low, high = sampled(chain)
    tolerance = float(np.maximum(high, -low).max())
    found = chain_deviation(CURVE, chain, tolerance)
    assert (found.outside >= high - 1e-13).all()
    assert (found.inside <= low + 1e-13).all()
    assert (found.outside - high <= 1.01 * SLACK * tolerance).all()
    assert (low - found.inside <= 1.01 * SLACK * tolerance).all()
    assert np.array_equal(found.worst, np.maximum(found.outside, -found.inside))
    assert (sampled_deviation(CURVE, chain, 8) <= found.worst).all()


@pytest.mark.parametrize("bend", [0.0, 2.0])
def test_what_hangs_on_the_proof_is_decided_where_that_is_asked_for(bend: float) -> None:
    chain = pieces(60, bend)
    tolerance = limit(chain)
    assert chain_deviation(CURVE, chain, tolerance).worst.max() > tolerance
    assert chain_deviation(CURVE, chain, tolerance, decide=True).worst.max() <= tolerance


@pytest.mark.slow
@pytest.mark.parametrize(("count", "decided"), few([(FEW, True), (FEW + 1, False)], 2))
def test_many_pieces_are_not_decided_one_by_one(count: int, decided: bool) -> None:
    chain = pieces(count)
    tolerance = limit(chain)
    found = chain_deviation(CURVE, chain, tolerance, decide=True)
    assert bool(found.worst.max() <= tolerance) is decided


def test_a_piece_that_breaks_the_tolerance_needs_no_sharper_proof(looks: list[tuple[int, int]]) -> None:
    every = pieces(8)
    worst = int(np.argmax(sampled(every)[1]))
    rows = (every.start, every.tangent, every.curvature, every.low, every.high)
    chain = Chain(*(row[worst : worst + 1] for row in rows))
    truth = float(sampled(chain)[1][0])
    chain_deviation(CURVE, chain, truth / 1.1)
    assert len(looks) == 1
    rounds = []
    for decide in (False, True):
        looks.clear()
        chain_deviation(CURVE, chain, truth / 1.02, decide=decide)
        rounds.append(len(looks))
    assert rounds[0] == rounds[1] > 1  # barely beyond it: how far is worth to be known, and there is nothing to decide


def test_proofs_end_where_nodes_do(looks: list[tuple[int, int]]) -> None:
    found = chain_deviation(CURVE, pieces(36), 1e9, 4)
    assert [nodes for _, nodes in looks] == [4]
    looks.clear()
    bounds = CURVE.cells.rows.copy()
    bounds[6:] = 1e15  # bends of which nothing is known
    curve = replace(CURVE)
    object.__setattr__(curve, "cells", replace(CURVE.cells, rows=bounds))
    found = chain_deviation(curve, pieces(36), 1.0)
    assert [nodes for _, nodes in looks] == [4 << i for i in range(8)]
    assert looks[-1][1] == MOST_NODES
    assert (found.worst > 1.0).all()


def test_a_piece_run_backwards_is_never_proved() -> None:
    chain = pieces(36)
    found = chain_deviation(CURVE, replace(chain, tangent=-chain.tangent), 1.0)
    assert np.isinf(found.worst).all()
    assert np.isinf(sampled_deviation(CURVE, replace(chain, tangent=-chain.tangent), 4)).all()


def test_a_foot_is_found_or_told_how_far_off_it_is() -> None:
    chain = pieces(36)
    middle = CURVE.sample(0.3 * chain.low + 0.7 * chain.high)
    t, miss = foot(CURVE, chain.low, chain.high, middle.point, middle.tangent, enough=1e-12)
    assert t == pytest.approx(0.3 * chain.low + 0.7 * chain.high, abs=1e-12)
    assert (miss <= 1e-12).all()
    beyond = CURVE.sample(chain.high + 0.1)
    t, miss = foot(CURVE, chain.low, chain.high, beyond.point, beyond.tangent, enough=1e-12)
    assert t == pytest.approx(chain.high, abs=1e-6)
    assert (miss > 0.1).all()
