"""Monotone pieces: roots and extremes of functions that are known, and what is too rough."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from kin.numeric.monotone import RoughError, between, cells, extremes, extremes_of_each, pieces

TURN = 2 * math.pi


def cut(f, places=(0.0, TURN), resolution=1e-13):
    return pieces(cells(lambda x: f(x)[None], np.array(places), resolution))


@given(st.lists(st.floats(-1, 1), min_size=1, max_size=7), st.lists(st.floats(-1, 1), min_size=7, max_size=7))
def test_every_piece_is_monotone_and_so_is_its_slope(cos, sin):
    k = np.arange(1, len(cos) + 1)[:, None]
    c, s = np.array(cos), np.array(sin[: len(cos)])

    def derivative(x, order):
        turn = order * math.pi / 2
        return (c * k.T**order) @ np.cos(k * x + turn) + (s * k.T**order) @ np.sin(k * x + turn)

    of = cut(lambda x: derivative(x, 0)[0])
    at = of.x[:-1] + np.linspace(0.01, 0.99, 9)[:, None] * of.width
    size = np.abs([c, s]).sum() * 8
    for order in (1, 2):
        values = derivative(at.ravel(), order).reshape(at.shape)
        assert (np.minimum(values.max(axis=0), -values.min(axis=0)) <= 1e-9 * size**order).all()
    every = np.arange(len(of.width))
    for row in at:
        assert np.abs(of.at(every, row) - derivative(row, 0)[0]).max() < 1e-12 * max(size, 1)
        # a piece may be as narrow as 1e-8, and its slope is known to the rounding of its values over its width
        known = 1e-9 * max(size, 1) + of.blur / of.width
        assert (np.abs(of.slope(every, row) - derivative(row, 1)[0]) < known).all()


@given(
    st.lists(st.floats(-1, 1), min_size=1, max_size=7),
    st.lists(st.floats(-1, 1), min_size=7, max_size=7),
    st.sampled_from([1, 3, 40]),
)
def test_extremes_without_pieces_are_those_of_the_pieces(cos, sin, parts):
    k = np.arange(1, len(cos) + 1)[:, None]
    places = np.linspace(0.0, TURN, parts + 1)

    def f(x):
        return (np.array(cos) @ np.cos(k * x) + np.array(sin[: len(cos)]) @ np.sin(k * x))[None]

    made = cells(f, places, 1e-12)
    of = pieces(made)
    assert extremes(made) == (of.least(), of.greatest())


def test_roots_and_touching_roots():
    assert cut(np.sin).crossings(0.0) == pytest.approx([0, math.pi, TURN], abs=1e-14)
    assert cut(np.sin).crossings(1.0) == pytest.approx([math.pi / 2], abs=1e-7)
    assert cut(np.sin).crossings(0.5) == pytest.approx([math.pi / 6, 5 * math.pi / 6], abs=1e-14)
    assert len(cut(np.sin).crossings(1.001)) == 0
    third = cut(lambda x: (x - 1) ** 3).crossings(0.0)
    assert third == pytest.approx([1.0], abs=1e-4)


def test_two_roots_much_closer_than_any_cell():
    gap = 1e-6
    of = cut(lambda x: (x - 1) ** 2 - gap**2)
    assert of.crossings(0.0) == pytest.approx([1 - gap, 1 + gap], abs=1e-8)


def test_a_run_along_a_level_gives_both_its_ends():
    def shelf(x):
        return np.maximum(x - 3, 0.0) - np.maximum(1 - x, 0.0)

    of = cut(shelf, (0.0, 1.0, 3.0, TURN))
    assert of.crossings(0.0) == pytest.approx([1, 3])
    assert len(of.crossings(0.1)) == 1


def test_round_a_turn_its_end_is_its_beginning():
    assert cut(np.sin).crossings_round(0.0) == pytest.approx([0, math.pi], abs=1e-14)
    assert cut(np.cos).crossings_round(0.0) == pytest.approx([math.pi / 2, 3 * math.pi / 2], abs=1e-14)
    # along the level from 300 degrees on to 60: no end of that run is at 0
    third = math.pi / 3
    of = cut(lambda x: np.maximum(0.5 - np.cos(x), 0.0), (0.0, third, 5 * third, TURN))
    assert of.crossings_round(0.0) == pytest.approx([third, 5 * third], abs=1e-12)
    assert cut(np.zeros_like).crossings_round(0.0).tolist() == []


def test_extremes_at_ends_inside_and_at_a_corner_nobody_declared():
    of = cut(lambda x: np.sin(x) + 0.1 * x)
    at = math.acos(-0.1)
    assert of.greatest() == pytest.approx((math.sin(at) + 0.1 * at, at), abs=1e-8)
    assert of.least() == pytest.approx((math.sin(TURN - at) + 0.1 * (TURN - at), TURN - at), abs=1e-8)
    value, place = cut(lambda x: -np.abs(x - 1.234)).greatest()
    assert value == pytest.approx(0, abs=1e-9)
    assert place == pytest.approx(1.234, abs=1e-8)


@pytest.mark.thin(3)
@pytest.mark.parametrize("share", [1e-5, 1e-3, 0.004])
@pytest.mark.parametrize("side", [-1.0, 1.0])
def test_a_corner_between_the_outermost_point_of_a_cell_and_its_end(side, share):
    """No point of the cell is beyond it: what shows is that the neighbours do not meet."""
    cell = TURN / 32.0
    at = 7.0 * cell + side * share * cell
    value, place = cut(lambda x: np.abs(x - at) - 0.3 * (x - at)).least()
    assert value == pytest.approx(0.0, abs=1e-9)
    assert place == pytest.approx(at, abs=1e-8)


@pytest.mark.thin(4)
@pytest.mark.parametrize("share", [1e-4, 2e-3, 0.0045])
@pytest.mark.parametrize(("end", "side"), [(0, 1.0), (1, -1.0), (1, 1.0), (2, -1.0), (2, 1.0), (3, -1.0)])
def test_a_corner_beside_a_break_or_an_end_of_the_range(end, side, share):
    """There is no neighbour there, or none that must meet: the function leaps at the breaks."""
    places = TURN / 3.0 * np.arange(4)
    at = places[end] + side * share * TURN / 33.0
    of = cut(lambda x: np.abs(x - at) - 0.3 * (x - at) + 10.0 * np.floor(3.0 * x / TURN) ** 2, places)
    level = 10.0 * math.floor(3.0 * at / TURN) ** 2
    beside = np.array([at - 1e-5, at, at + 1e-5])
    piece = np.clip(np.searchsorted(of.x, beside, side="right") - 1, 0, len(of.x) - 2)
    assert of.at(piece, beside) - level == pytest.approx([1.3e-5, 0.0, 0.7e-5], abs=1e-9)


@pytest.mark.thin(2)
@pytest.mark.parametrize("count", [22, 29, 47])
def test_corners_that_nobody_declared_are_all_found(count):
    of = cut(lambda x: np.abs(np.sin(0.5 * count * (x - 0.01))))
    assert of.least()[0] == pytest.approx(0.0, abs=1e-8)
    assert len(of.crossings(1e-3)) == 2 * count


def test_what_has_no_smooth_stretch_is_refused():
    rng = np.random.default_rng(7)
    with pytest.raises(RoughError, match=r"too rough to be resolved to 1e-06"):
        cells(lambda x: rng.uniform(-1, 1, (1, len(x))), np.array([0.0, 1.0]), 1e-6)


def test_several_functions_share_their_cells():
    of = cells(lambda x: np.stack([np.sin(x), 1e3 * np.cos(9 * x)]), np.array([0.0, TURN]), share=1e-12)
    assert pieces(of, 0).greatest()[0] == pytest.approx(1, abs=1e-11)
    assert pieces(of, 1).least()[0] == pytest.approx(-1e3, abs=1e-8)
    assert len(pieces(of, 1).crossings(0.0)) == 18


def test_an_end_at_the_level_but_for_rounding_is_where_the_level_is_reached():
    """Newton's method would creep to it at the top of a parabola, by halves."""
    of = pieces(cells(lambda x: -((x - 1.0) ** 2)[None], np.array([0.0, 1.0, 3.0])))
    piece = int(np.argmin(np.abs(of.x - 1.0))) + np.array([-1, 0])
    for level in (0.0, -1e-17, 1e-17):
        assert of.crossing(piece, np.full(2, level)).tolist() == [1.0, 1.0]
    assert of.crossing(piece, np.full(2, -1e-8)) == pytest.approx([1.0 - 1e-4, 1.0 + 1e-4], abs=1e-8)


def test_all_functions_at_places_and_where_the_first_has_values():
    of = cells(lambda x: np.stack([x + 0.1 * np.sin(x), np.cos(x)]), np.array([0.0, 1.0, 6.0]))
    x = np.linspace(0.0, 6.0, 101)
    assert of.at(x) == pytest.approx(np.stack([x + 0.1 * np.sin(x), np.cos(x)]), abs=1e-14)
    cell, share = of.reach(x + 0.1 * np.sin(x))
    assert of.low[cell] + share * (of.high - of.low)[cell] == pytest.approx(x, abs=1e-14)


def test_places_are_ends_and_the_breaks_between():
    assert between(0.0, 2.0, [1.5, -1.0, 0.5, 2.0, 0.5]).tolist() == [0.0, 0.5, 1.5, 2.0]


def test_extremes_of_several_functions_are_those_of_each():
    """a sin t + b sin 3 t: extremes where a cos t + 3 b cos 3 t vanishes, 4 cos^2 t = 3 - a/(3 b), or cos t = 0."""
    factors = [(1.0, 0.0), (1.0, 0.3), (-2.0, 1.0), (0.0, 1e-3)]
    curves = cells(
        lambda t: np.stack([a * np.sin(t) + b * np.sin(3.0 * t) for a, b in factors]), between(0.0, TURN, [])
    )
    for row, ((a, b), found) in enumerate(zip(factors, extremes_of_each(curves), strict=True)):
        assert found == extremes(curves, row)
        square = (3.0 - a / (3.0 * b)) / 4.0 if b else 2.0
        cosines = [0.0, *([math.sqrt(square)] if 0.0 <= square <= 1.0 else [])]
        sines = [math.sqrt(1.0 - cosine**2) for cosine in cosines]  # sin 3 t = 3 s - 4 s^3
        greatest = max(abs(a * s + b * (3.0 * s - 4.0 * s**3)) for s in sines)
        for sign, (value, at) in zip((-1.0, 1.0), found, strict=True):
            assert value == pytest.approx(sign * greatest, rel=1e-13)
            assert a * math.sin(at) + b * math.sin(3.0 * at) == pytest.approx(value, rel=1e-13)
