"""Peaks of the normalised motion laws, rest to rest (H. A. Rothbart, Cam Design Handbook, 2004; Neklutin's curves).

Each law is rebuilt here from the shape of its acceleration alone, normalised by quadrature with mpmath; the peaks of
the product are those of its motion at 24,001 places, and of the motion table of an exported cam.
"""

import mpmath as mp
import numpy as np
import pytest
from support.page_tables import Row

from kin.law.sources.laws import named
from kin.law.sources.peaks import peaks as law_peaks

PI = mp.pi
INFINITE = float("inf")


def level(value):
    return lambda _: mp.mpf(value)


# breaks, and the shape of the acceleration on each stretch, peak 1
SHAPES = {
    "parabolic": ([0, 0.5, 1], [level(1), level(-1)]),
    "harmonic": ([0, 1], [lambda u: mp.cos(PI * u)]),
    "cycloidal": ([0, 1], [lambda u: mp.sin(2 * PI * u)]),
    "modified-trapezoid": (
        [0, 1 / 8, 3 / 8, 5 / 8, 7 / 8, 1],
        [
            lambda u: mp.sin(4 * PI * u),
            level(1),
            lambda u: mp.cos(4 * PI * (u - 0.375)),
            level(-1),
            lambda u: -mp.cos(4 * PI * (u - 0.875)),
        ],
    ),
    "modified-sine": (
        [0, 1 / 8, 7 / 8, 1],
        [
            lambda u: mp.sin(4 * PI * u),
            lambda u: mp.cos(4 * PI / 3 * (u - 0.125)),
            lambda u: -mp.cos(4 * PI * (u - 0.875)),
        ],
    ),
    "modified-constant-velocity": (
        [0, 1 / 16, 1 / 4, 3 / 4, 15 / 16, 1],
        [
            lambda u: mp.sin(8 * PI * u),
            lambda u: mp.cos(8 * PI / 3 * (u - 0.0625)),
            level(0),
            lambda u: -mp.sin(8 * PI / 3 * (u - 0.75)),
            lambda u: -mp.cos(8 * PI * (u - 0.9375)),
        ],
    ),
    "polynomial-345": ([0, 1], [lambda u: u * (1 - u) * (1 - 2 * u)]),
    "polynomial-4567": ([0, 1], [lambda u: u**2 * (1 - u) ** 2 * (1 - 2 * u)]),
}

# velocity, acceleration, jerk inside the law: text and value
PUBLISHED = {
    "parabolic": (("2", 2.0), ("4", 4.0), ("0", 0.0)),
    "harmonic": (("π/2", PI / 2), ("π²/2", PI**2 / 2), ("π³/2", PI**3 / 2)),
    "cycloidal": (("2", 2.0), ("2π", 2 * PI), ("4π²", 4 * PI**2)),
    "modified-trapezoid": (("2", 2.0), ("8π/(π+2)", 8 * PI / (PI + 2)), ("32π²/(π+2)", 32 * PI**2 / (PI + 2))),
    "modified-sine": (
        ("4π/(π+4)", 4 * PI / (PI + 4)),
        ("4π²/(π+4)", 4 * PI**2 / (PI + 4)),
        ("16π³/(π+4)", 16 * PI**3 / (PI + 4)),
    ),
    "modified-constant-velocity": (
        ("8π/(5π+4)", 8 * PI / (5 * PI + 4)),
        ("16π²/(5π+4)", 16 * PI**2 / (5 * PI + 4)),
        ("128π³/(5π+4)", 128 * PI**3 / (5 * PI + 4)),
    ),
    "polynomial-345": (("15/8", 1.875), ("10/√3", 10 / mp.sqrt(3)), ("60", 60.0)),
    "polynomial-4567": (("35/16", 2.1875), ("84/√125", 84 / mp.sqrt(125)), ("52.5", 52.5)),
}
WORDS = ("velocity", "acceleration", "jerk")


def peaks(name):
    """Greatest |s'|, |s''|, |s'''| of the product's law, inside and as limits at its knots; (3,)."""
    law = named(name)
    knots = law.motion.knots
    u = np.unique(np.concatenate([np.linspace(0, 1, 24_001), knots]))
    right = law.derivatives(u[:-1], 3, 1)
    left = law.derivatives(u[1:], 3, -1)
    return np.abs(np.concatenate([right, left], axis=1)).max(axis=1)[1:]


def rows(workshop):  # noqa: ARG001 - every topic is called alike
    found = []
    for name, figures in PUBLISHED.items():
        for word, (text, value), ours in zip(WORDS, figures, peaks(name), strict=True):
            # a grid of 1/24000 loses 1e-8 of a smooth peak
            found.append(Row(f"{name}: peak {word}", "closed form", text, float(value), ours, 1e-7, ".8g"))
    return found


def rebuilt(name):
    """Peaks of velocity and acceleration from the shape of the acceleration alone, stroke 1."""
    breaks, shapes = SHAPES[name]
    spans = list(zip(breaks[:-1], breaks[1:], shapes, strict=True))
    # stroke = integral of (1 - u) a(u), velocity at the middle = integral of a over the first half
    stroke = sum(mp.quad(lambda u, a=a: (1 - u) * a(u), [b, c]) for b, c, a in spans)
    top = sum(mp.quad(a, [b, min(c, 0.5)]) for b, c, a in spans if b < 0.5)
    places = np.linspace(0, 1, 2001)
    peak = max(abs(shapes[-1 if u == 1 else np.searchsorted(breaks, u, "right") - 1](mp.mpf(u))) for u in places)
    return float(top / stroke), float(peak / stroke)


@pytest.mark.thin(12)
@pytest.mark.parametrize("name", sorted(SHAPES))
def test_peaks_follow_from_the_shape_of_the_acceleration(name):
    velocity, acceleration, _ = peaks(name)
    top, peak = rebuilt(name)
    assert velocity == pytest.approx(top, rel=1e-12)
    # 2001 places miss the polynomials' peak by less than 1e-6
    assert acceleration == pytest.approx(peak, rel=1e-6)


@pytest.mark.thin(4)
@pytest.mark.parametrize("name", sorted(SHAPES))
def test_acceleration_is_the_rebuilt_one_everywhere(name):
    breaks, shapes = SHAPES[name]
    u = np.linspace(0, 1, 97)[1:-1] + 1e-3
    found = named(name).derivatives(u, 2)[2]
    spans = list(zip(breaks[:-1], breaks[1:], shapes, strict=True))
    stroke = sum(mp.quad(lambda x, a=a: (1 - x) * a(x), [b, c]) for b, c, a in spans)
    wanted = [float(shapes[np.searchsorted(breaks, x, "right") - 1](mp.mpf(x)) / stroke) for x in u]
    assert found == pytest.approx(wanted, rel=1e-10, abs=1e-9)


@pytest.mark.thin(3)
@pytest.mark.parametrize("name", sorted(SHAPES))
def test_derivatives_against_difference_quotients(name):
    """Central quotients of each derivative give the next, away from the knots."""
    h = 1e-5
    knots = named(name).motion.knots
    u = np.linspace(0.003, 0.997, 331)
    u = u[np.abs(u[:, None] - knots).min(axis=1) > 2 * h]
    rows_ = named(name).derivatives(u, 3)
    quotient = (named(name).derivatives(u + h, 2) - named(name).derivatives(u - h, 2)) / (2 * h)
    for k in range(3):
        assert quotient[k] == pytest.approx(rows_[k + 1], abs=2e-6 * max(1.0, np.abs(rows_[k + 1]).max()))


@pytest.mark.thin(3)
@pytest.mark.parametrize("name", sorted(SHAPES))
def test_ends_and_continuity(name):
    law = named(name)
    start, end = law.derivatives(np.array([0.0]), 3, 1)[:, 0], law.derivatives(np.array([1.0]), 3, -1)[:, 0]
    assert start[:2] == pytest.approx([0, 0], abs=1e-15)
    assert end[:2] == pytest.approx([1, 0], abs=1e-14)
    inner = law.motion.knots[1:-1]
    jumps = np.abs(law.derivatives(inner, 2, 1) - law.derivatives(inner, 2, -1))
    assert (jumps[:2] < 1e-13).all()
    smooth = name not in {"parabolic", "harmonic"}
    if smooth:
        assert (jumps[2] < 1e-12).all()
        assert abs(start[2]) + abs(end[2]) < 1e-12
    # the table of peaks tells which laws step
    assert (law_peaks(law.motion).jerk == INFINITE) is not smooth


@pytest.mark.thin(6)
@pytest.mark.parametrize("name", sorted(set(SHAPES) - {"parabolic", "harmonic"}))
def test_peaks_in_the_motion_table_of_a_cam(workshop, name):
    """h C_v/beta and h C_a/beta^2 for 5 mm in 120 degrees, read from the CSV."""
    text = f"""
cam: {{kind: constant-breadth, base_radius: 60, motion: [{{rise: 5, over: 120, law: {name}}}, {{dwell: 60}}]}}
export: {{tolerance: 0.01}}
"""
    motion = workshop.written(f"law-{name}", text).motion
    velocity, acceleration, jerk = peaks(name)
    beta = 2 * np.pi / 3
    assert np.abs(motion["velocity"]).max() == pytest.approx(5 * velocity / beta, rel=1e-6)
    assert np.abs(motion["acceleration"]).max() == pytest.approx(5 * acceleration / beta**2, rel=3e-6)
    # a row every 0.1 degrees misses a polynomial's peak by 2e-6
    assert np.abs(motion["jerk"]).max() == pytest.approx(5 * jerk / beta**3, rel=1e-6)
