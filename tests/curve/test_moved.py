"""A curve moved outwards by a spline: frames by difference quotients, bounds held on every cell, no corners."""

from __future__ import annotations

import numpy as np
import pytest
from support.measured import MOTION, RECIPES, disc

from camgeo.curve.curve import Curve
from camgeo.curve.moved import AlongNormals, BySupport, PeriodicPolynomials
from camgeo.recipe.recipe import read
from camgeo.synthesis.design import designed

TURN = 2.0 * np.pi


def spline(spans=30, height=0.03):
    """Piecewise Hermite quintics through a wave's values and two derivatives: twice differentiable."""
    knots = np.arange(spans) * TURN / spans
    h = TURN / spans

    def rows(t):
        return np.stack([np.sin(3.0 * t), 3.0 * h * np.cos(3.0 * t), -9.0 * h**2 * np.sin(3.0 * t)]) * height

    (a, da, dda), (b, db, ddb) = rows(knots), rows(knots + h)
    r, s, q = b - a - da - 0.5 * dda, db - da - dda, ddb - dda
    return PeriodicPolynomials(
        np.stack([a, da, 0.5 * dda, 10 * r - 4 * s + 0.5 * q, -15 * r + 7 * s - q, 6 * r - 3 * s + 0.5 * q])
    )


def moved(kind, by):
    """Curves of a recipe, pitch curves or what a flat face touches, and each moved."""
    return moved_of(RECIPES[kind], by)


def moved_of(text, by):
    exact = designed(read(text.encode(), "part.yaml")).exact
    form = AlongNormals if exact.follower.contacts[0].touch.centred else BySupport
    return [(surface.base, Curve.whole(form(surface.base.shape, by))) for surface in exact.surfaces]


def test_the_spline_is_the_wave():
    from kin.numeric.jet import BallJet, Jet

    t = np.linspace(0.001, TURN + 2.0, 500)
    off, slope = spline().on(Jet.variable(t, 1)).c
    assert off == pytest.approx(0.03 * np.sin(3.0 * t), abs=1e-7)
    assert slope == pytest.approx(0.09 * np.cos(3.0 * t), abs=1e-6)
    low, high = spline().on(BallJet.variable(t, t + 1e-4, 2)).bounds()
    assert (low[0] <= off).all()
    assert (high[0] >= off).all()


@pytest.mark.thin(4)
@pytest.mark.parametrize("kind", list(RECIPES))
def test_frames_are_those_of_the_moved_points(kind):
    for contour, curve in moved(kind, spline()):
        t, h = np.linspace(0.0137, TURN, 300), 1e-5
        breaks = np.append(curve.shape.breaks, TURN)
        t = t[np.abs(t[:, None] - breaks).min(axis=1) > 3.0 * h]
        frame = curve.sample(t)
        base = contour.sample(t)
        off = 0.03 * np.sin(3.0 * t)
        away = frame.point - base.point
        assert np.sum(away * base.normal, axis=1) == pytest.approx(off, abs=2e-7)
        assert np.abs(np.sum(away * base.tangent, axis=1)).max() < 0.1  # the slope, 0.09 mm/rad, where there is any
        after, before = curve.sample(t + h), curve.sample(t - h)
        rate = (after.point - before.point) / (2.0 * h)
        assert rate == pytest.approx(frame.speed[:, None] * frame.tangent, abs=1e-6)
        assert (after.tangent - before.tangent) / (2.0 * h) == pytest.approx(
            -frame.turn[:, None] * frame.normal, abs=1e-5
        )
        assert (after.speed - before.speed) / (2.0 * h) == pytest.approx(frame.speed_slope, rel=1e-4, abs=1e-3)
        assert (after.turn - before.turn) / (2.0 * h) == pytest.approx(frame.turn_slope, rel=1e-4, abs=1e-3)


@pytest.mark.thin(8)
@pytest.mark.parametrize("kind", list(RECIPES))
def test_bounds_hold_on_every_cell(kind):
    random = np.random.default_rng(3)
    for _, curve in moved(kind, spline()):
        cells = curve.cells
        for _ in range(20):
            t = cells.low + (cells.high - cells.low) * random.random(len(cells.low))
            frame = curve.sample(t)
            speed_low, speed_high, turn_low, turn_high, speed_slope, turn_slope, *_ = cells.rows
            assert (frame.speed >= speed_low).all()
            assert (frame.speed <= speed_high).all()
            assert (frame.turn >= turn_low).all()
            assert (frame.turn <= turn_high).all()
            assert (np.abs(frame.speed_slope) <= speed_slope).all()
            assert (np.abs(frame.turn_slope) <= turn_slope).all()


def test_a_knot_that_is_a_break_is_one_break():
    """A rise that ends on a knot, and knots that meet none; where there is no break the knots are all."""
    ((contour, curve),) = moved("roller on a stem", spline(30))
    assert len(curve.shape.breaks) == 30 + len(contour.shape.breaks) - sum(
        abs((b / TURN * 30) - round(b / TURN * 30)) < 1e-9 for b in contour.shape.breaks
    )
    assert curve.closed


def test_a_jump_of_the_radius_of_curvature_leaves_no_corner():
    """Arcs of 5 and 45 mm: along the normals the tangent would jump by 0.09 (1/5 - 1/45), 0.016 rad."""
    ((base, curve),) = moved("yoke", spline())
    ends = base.sample(base.shape.breaks, -1), base.sample(base.shape.breaks, 1)
    assert (np.abs(ends[0].speed - ends[1].speed) > 39.0).all()
    before, after = (curve.sample(base.shape.breaks, side) for side in (-1, 1))
    assert before.tangent == pytest.approx(after.tangent, abs=1e-14)
    assert before.point == pytest.approx(after.point, abs=1e-12)


def test_a_pitch_curve_has_hardly_a_corner_where_its_curvature_jumps():
    """At the ends of a harmonic stroke: by the slope times the distance and the jump of the curvature, 1e-7."""
    law = disc("kind: roller, radius: 10", MOTION.replace("cycloidal", "harmonic"))
    ((base, curve),) = moved_of(law, spline())
    before, after = (curve.sample(base.shape.breaks, side) for side in (-1, 1))
    assert (np.abs(before.turn - after.turn) > 0.1).any()
    assert np.abs(before.tangent - after.tangent).max() < 1e-6
