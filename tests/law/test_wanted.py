"""The series nearest to a wanted law: mpmath as the oracle, no other series better, and a bound that is proved."""

import math
from itertools import pairwise

import mpmath as mp
import numpy as np
import pytest
from support.programmes import Segment, law, programme

from kin.law.normalised import IntentError
from kin.law.transmission import from_delta, from_law
from kin.law.wanted import nearest, proved_error
from kin.numeric.records import replace


def up_and_down(lam, swing, name, *, corners=False):
    """Dwell, rise, dwell, return over delta = 180/lam degrees; swing in degrees."""
    whole = 180 / lam
    parts = (("dwell", 0.1, 0.0), ("rise", 0.35, swing), ("dwell", 0.05, 0.0), ("return", 0.5, swing))
    segments = [
        Segment(kind, math.radians(share * whole), math.radians(stroke), None if kind == "dwell" else law(name))
        for kind, share, stroke in parts
    ]
    return from_law(lam, lam - 1 if lam % 2 == 0 else 1, 1.0, programme(segments, math.pi / lam), corners=corners)


def errors(cos, sin, wanted, phi):
    """Psi of a series at arms of 1 less that of the wanted law at shaft angles."""
    made = from_delta(wanted.lam, wanted.mu, 1.0, cos, sin)
    return made.psi_of_shaft(phi, 0)[0] - wanted.psi_of_shaft(phi, 0)[0]


def oracle_wanted(phi):
    """A cycloidal rise of 5 degrees over 0.1 to 0.45 of 45 degrees and a return over 0.5 to 1, and W 4.9."""
    delta, stroke = mp.pi / 4, mp.radians(5)

    def on_half(x):
        share = x / delta
        if share < 0.1:
            return mp.mpf(0)
        up = min((share - mp.mpf("0.1")) / mp.mpf("0.35"), mp.mpf(1))
        down = max((share - mp.mpf("0.5")) / mp.mpf("0.5"), mp.mpf(0))
        return stroke * sum(sign * (u - mp.sin(2 * mp.pi * u) / (2 * mp.pi)) for sign, u in ((1, up), (-1, down)))

    if phi < delta:
        return on_half(phi)
    x = mp.findroot(lambda x: x + delta - on_half(x) - phi, (phi - delta, phi - delta + 0.01), tol=1e-30)
    return -on_half(x)


@pytest.mark.slow
def test_three_harmonics_by_mpmath():
    """Every digit anew: psi by W 4.4 and 5.7, the wanted law and its image, extremes of one size in turn."""
    found = nearest(up_and_down(4, 5.0, "cycloidal"), 3)
    alpha, delta = 3 * mp.pi / 4, mp.pi / 4

    def made(phi):
        def rest(psi):
            t = phi - (psi + alpha) / 2
            d = mp.fsum(
                c * f(j * 4 * t) for f, part in ((mp.cos, found.cos), (mp.sin, found.sin)) for j, c in part.items()
            )
            return psi + mp.asin(d)

        return mp.findroot(rest, (mp.mpf(0), mp.mpf("0.01")), tol=1e-28)

    with mp.workdps(20):
        places = [2 * delta * k / 120 for k in range(120)]
        error = [made(phi) - oracle_wanted(phi) for phi in places]
        tops = [k for k in range(120) if abs(error[k]) >= max(abs(error[k - 1]), abs(error[(k + 1) % 120]))]

        def sharp(k):
            low, high = places[k] - 2 * delta / 120, places[k] + 2 * delta / 120
            for _ in range(14):
                thirds = low + (high - low) / 3, high - (high - low) / 3
                sizes = [abs(made(x % (2 * delta)) - oracle_wanted(x % (2 * delta))) for x in thirds]
                low, high = (low, thirds[1]) if sizes[0] > sizes[1] else (thirds[0], high)
            return max(sizes)

        sizes = sorted((float(sharp(k)) for k in tops if abs(error[k]) > 0.9 * max(map(abs, error))), reverse=True)
    assert len(sizes) >= 5  # as many as there are unknowns, one of which is the error itself
    assert sizes[0] == pytest.approx(found.error, rel=1e-8)
    assert sizes[4] == pytest.approx(found.error, rel=1e-6)
    assert found.least <= found.error <= found.least * (1 + 1e-6)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("lam", "name", "harmonics"),
    [
        (2, "cycloidal", 1),
        pytest.param(4, "modified-sine", 7, marks=pytest.mark.slow),
        pytest.param(3, "parabolic", 31, marks=pytest.mark.slow),
    ],
)
def test_no_series_is_nearer(lam, name, harmonics):
    """Every series near by is farther, whichever way it is changed; the bound is proved and hardly above."""
    wanted = up_and_down(lam, 3.0, name)
    found = nearest(wanted, harmonics)
    phi = np.linspace(0, 2 * wanted.delta, 1000, endpoint=False)
    assert np.abs(errors(found.cos, found.sin, wanted, phi)).max() == pytest.approx(found.error, rel=2e-3)
    assert found.error <= proved_error(found, wanted) <= 1.001 * found.error
    rng = np.random.default_rng(7)
    for size in (1e-3, 1e-1):
        cos, sin = (
            {j: c + size * found.error * rng.normal() for j, c in part.items()} for part in (found.cos, found.sin)
        )
        assert np.abs(errors(cos, sin, wanted, phi)).max() > found.error


@pytest.mark.slow
def test_more_harmonics_are_nearer():
    """By an order or two with smooth laws; where the acceleration jumps the error falls with the square."""
    wanted = up_and_down(5, 4.0, "cycloidal")
    figures = [nearest(wanted, harmonics).error for harmonics in (1, 5, 15)]
    assert all(more < less for less, more in pairwise(figures))
    assert figures[-1] < 0.02 * figures[0]


def test_a_series_is_its_own_nearest():
    """A law that is one of the series comes back, whichever route it was given by."""
    cos, sin = {1: 0.06, 3: -0.02}, {1: 0.01, 3: 0.005}
    found = nearest(from_delta(4, 3, 1.0, cos, sin), 3)
    assert found.error < 1e-11
    assert found.cos == pytest.approx(cos, abs=1e-11)
    assert found.sin == pytest.approx(sin, abs=1e-11)


def test_a_figure_too_small_is_not_proved():
    """The proof finds what the search would have missed."""
    wanted = up_and_down(4, 5.0, "cycloidal")
    found = nearest(wanted, 3)
    assert proved_error(replace(found, error=found.error / 1.05), wanted) > found.error
    with pytest.raises(IntentError, match="no bound near"):
        proved_error(replace(found, error=found.error / 4), wanted)


@pytest.mark.slow
def test_a_law_with_corners():
    """Constant velocity: refused of a cam that should follow it exactly, and followed by a series."""
    rise = Segment("rise", math.radians(22.5), math.radians(3), law("constant-velocity"))
    back = Segment("return", math.radians(22.5), math.radians(3), law("constant-velocity"))
    motion = programme([rise, back], math.pi / 4)
    with pytest.raises(IntentError, match="corner"):
        from_law(4, 3, 1.0, motion)
    wanted = from_law(4, 3, 1.0, motion, corners=True)
    found = nearest(wanted, 15)
    assert math.degrees(proved_error(found, wanted)) < 0.15


@pytest.mark.slow
@pytest.mark.parametrize("harmonics", [1, 7])
def test_a_law_all_but_too_steep(harmonics) -> None:
    """44 degrees in 45, whose image all but jumps: the best series is found, or an error says that it is not."""
    parts = [Segment(kind, math.radians(45), math.radians(44), law("constant-velocity")) for kind in ("rise", "return")]
    wanted = from_law(2, 1, 1.0, programme(parts, math.pi / 2), corners=True)
    if harmonics == 1:
        assert nearest(wanted, 1).error == pytest.approx(nearest(wanted, 1).least, rel=1e-6)
    else:
        with pytest.raises(IntentError, match="nearest series up to harmonic 7 was not found"):
            nearest(wanted, harmonics)
