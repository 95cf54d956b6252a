"""Placing of points on a contour: minimax with its certificate, least squares, intervals; digits of worked cases."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from support.cases import examples
from support.disc_followers import FOLLOWERS

from kin.made.placing import conditions, interval, least_squares, minimax

THETA = np.radians(np.arange(720) * 0.5)


def columns(kind):
    frame = FOLLOWERS[kind].envelope.frames(THETA)
    x, y = frame.points.T
    nx, ny = frame.normals.T
    return {"g": x * ny - y * nx, "x": nx, "y": ny} | {"g": ny * x - nx * y}


def matrix(parts, names):
    return np.column_stack([parts[name] for name in names])


def offset_cam():
    parts = columns("roller, offset")
    e = 0.006 * np.sin(3 * THETA) + 0.004 * np.cos(7 * THETA + 0.5) + np.radians(0.03) * parts["g"]
    return parts, e


def stroke_cam():
    parts = columns("roller, offset")
    wave = 0.006 * np.sin(5 * THETA) * (1.0 + np.cos(THETA - np.radians(50.0))) / 2.0
    return parts, wave + np.radians(0.03) * parts["g"]


def central_cam():
    parts = columns("roller")
    return parts, 0.003 * np.cos(5 * THETA) + np.radians(0.05) * parts["g"] + 0.020 * parts["x"]


CASES = {  # cam, unknowns: minimax unknowns (degrees, mm), its value, touching degrees; least squares, its rms
    (offset_cam, "g"): ((0.03,), 0.0099988862, (150, 330), (0.0238622665,), 0.0049701865),
    (offset_cam, "xy"): (
        (-0.0041245151, -0.0061837917),
        0.0090340680,
        (1.5, 72.5, 150),
        (-0.0046671166, -0.0052794842),
        0.0044425110,
    ),
    (offset_cam, "gxy"): (
        (0.0150473698, -0.0039949444, -0.0027878908),
        0.0081025115,
        (1.5, 75, 75.5, 224),
        (0.0023766786, -0.0043048551, -0.0048701574),
        0.0044372589,
    ),
    (stroke_cam, "g"): ((0.0307412286,), 0.0056916609, (19, 54), (0.0316237109,), 0.0025805451),
    (stroke_cam, "xy"): (
        (-0.0058296628, -0.0066627032),
        0.0094805306,
        (9, 52.5, 92.5),
        (-0.0046935984, -0.0051180358),
        0.0041476868,
    ),
    (stroke_cam, "gxy"): (
        (0.0362474388, 0.0011690362, 0.0013882817),
        0.0052468155,
        (20.5, 54.5, 344, 344.5),
        (0.0361189497, 0.0008117769, 0.0011026010),
        0.0025361665,
    ),
    (central_cam, "xy"): (
        (0.0161853473, -0.0109613420),
        0.0071747928,
        (44.5, 135, 184, 315),
        (0.0148921769, -0.0087695124),
        0.0042334019,
    ),
    (central_cam, "gxy"): (
        (0.05, 0.02, 0.0),
        0.0030000000,
        (0, 36, 72, 108, 144, 180, 216, 252, 288, 324),
        (0.0482283906, 0.0198151654, -0.0003098058),
        0.0021170394,
    ),
}


def as_told(x, names):
    return [float(np.degrees(value)) if name == "g" else float(value) for name, value in zip(names, x, strict=True)]


@pytest.mark.parametrize(
    ("make", "names"), list(CASES), ids=lambda each: each if isinstance(each, str) else each.__name__
)
def test_worked_cases(make, names):
    parts, e = make()
    a = matrix(parts, names)
    x, value, touching, least, rms = CASES[make, names]
    found = minimax(a, e)
    assert found.value == pytest.approx(value, abs=1e-10)
    assert found.certificate == pytest.approx(found.value, rel=1e-12)
    assert (found.multipliers >= 0.0).all()
    assert found.multipliers.sum() == pytest.approx(1.0)
    signs = np.sign(e - a @ found.x)[found.touching]
    assert (found.multipliers * signs) @ a[found.touching] == pytest.approx(0.0, abs=1e-9)
    if names != "g":
        assert as_told(found.x, names) == pytest.approx(x, abs=1e-9)
    held = found.touching[found.multipliers > 1e-9] * 0.5
    assert set(held.tolist()) <= {*touching}
    best = least_squares(a, e)
    assert as_told(best, names) == pytest.approx(least, abs=1e-10)
    assert np.sqrt(np.mean((e - a @ best) ** 2)) == pytest.approx(rms, abs=1e-10)


def test_where_dwells_fix_the_zone_the_angle_is_an_interval():
    parts, e = offset_cam()
    found = minimax(matrix(parts, "g"), e)
    low, high = np.degrees(interval(parts["g"], e, found.value))
    assert (low, high) == pytest.approx((0.03, 0.0346746320), abs=1e-9)
    parts, e = central_cam()
    low, high = np.degrees(interval(parts["g"], e, minimax(matrix(parts, "g"), e).value))
    assert (low, high) == pytest.approx((-0.0457959124, 0.0711118761), abs=1e-9)
    parts, e = stroke_cam()
    low, high = np.degrees(interval(parts["g"], e, minimax(matrix(parts, "g"), e).value))
    assert (low, high) == pytest.approx((0.0307412286, 0.0307412286), abs=1e-9)


def test_singular_values():
    parts, _ = offset_cam()
    assert conditions(matrix(parts, "gxy")) == pytest.approx((10.649979, 0.710459, 0.343858), abs=1e-6)
    parts, _ = central_cam()
    assert conditions(matrix(parts, "gxy")) == pytest.approx((9.140792, 0.724606, 0.328363), abs=1e-6)


@settings(max_examples=examples(60))
@given(st.integers(0, 10_000), st.integers(1, 3), st.booleans())
def test_no_placing_is_better(seed, k, whole):
    """Also on whole numbers, where many points tie; the certificate is a bound that any placing meets."""
    draw = np.random.default_rng(seed)
    a = draw.integers(-2, 3, (30, k)).astype(float) if whole else draw.normal(size=(30, k))
    e = draw.integers(-5, 6, 30).astype(float) if whole else draw.normal(size=30)
    found = minimax(a, e)
    assert found.certificate == pytest.approx(found.value, rel=1e-9, abs=1e-12)
    for _ in range(20):
        other = found.x + draw.normal(size=k) * draw.choice([1e-4, 1e-2, 1.0])
        assert np.abs(e - a @ other).max() >= found.value - 1e-12
