"""The lobe polynomial: its closed form, its ends at rest, and what is none."""

import math
import tracemalloc

import numpy as np
import pytest

from kin.law.normalised import IntentError
from kin.law.piecewise import Piecewise
from kin.law.segment import AffineStretch
from kin.law.sources import functions
from kin.law.sources.functions import Flank
from kin.law.sources.lobe import coefficients, lobe
from kin.numeric.jet import horner

TURN = 2 * math.pi
rad = math.radians
VALVE = lobe(8.0, rad(68), (2, 8, 14, 20, 26))


def test_the_lobe_has_the_coefficients_and_lifts_of_its_closed_form():
    found = coefficients((2, 8, 14, 20, 26))
    assert found == pytest.approx((-1.872427984, 1.872427984, -1.604938272, 0.748971193, -0.144032922), abs=5e-10)
    p, q, r, s = 8, 14, 20, 26
    assert found[0] == pytest.approx(-p * q * r * s / ((p - 2) * (q - 2) * (r - 2) * (s - 2)), rel=1e-15)
    assert found[1] == pytest.approx(2 * q * r * s / ((p - 2) * (q - p) * (r - p) * (s - p)), rel=1e-15)
    lifts = VALVE.derivatives(np.radians([0.0, 20.0, 45.0]), 0)[0]
    assert lifts == pytest.approx([8, 6.705040433, 1.952853268], abs=5e-10)
    assert VALVE.derivatives(np.radians([320.23336]), 1)[1] == pytest.approx([12.538158514], abs=5e-9)


def test_a_lobe_ends_with_four_derivatives_at_rest():
    assert VALVE.derivatives(rad(68), 4, -1)[:, 0].tolist() == [0, 0, 0, 0, 0]
    assert VALVE.derivatives(TURN - rad(68), 4)[:, 0] == pytest.approx([0] * 5, abs=0)
    assert VALVE.joints == ()
    theta = np.linspace(0.01, rad(67.9), 50)
    u = theta / rad(68)
    powers = zip(coefficients((2, 8, 14, 20, 26)), (2, 8, 14, 20, 26), strict=True)
    plain = 8 * (1 + sum(c * u**k for c, k in powers))
    assert VALVE.derivatives(theta, 0)[0] == pytest.approx(plain, abs=1e-13)
    assert VALVE.derivatives(TURN - theta, 0)[0] == pytest.approx(plain, abs=1e-13)


@pytest.mark.parametrize(
    ("lift", "half", "powers", "message"),
    [
        (0.0, 1.0, (2, 4, 6, 8, 10), "the lift of a lobe must be above 0, not 0"),
        (1.0, 3.2, (2, 4, 6, 8, 10), "half the event lies between 0 and 180 degrees, not 183.346"),
        (
            1.0,
            1.0,
            (2, 8, 8, 20, 26),
            (
                "the powers of a lobe are 2 and four more whole numbers that rise to 100 at most, "
                "such as [2, 8, 14, 20, 26], not [2, 8, 8, 20, 26]"
            ),
        ),
    ],
)
def test_what_is_no_lobe_is_refused(lift, half, powers, message):
    with pytest.raises(IntentError) as caught:
        lobe(lift, half, powers)
    assert caught.value.message == message


def test_unlike_flanks_are_one_evaluation_with_the_same_digits(monkeypatch):
    """A cam card gives either side a flank of its own."""
    first, second = Flank.of((2, 8, 14, 20, 26), 8.0)[0], Flank.of((2, 7, 13, 21, 26), 8.0)[0]
    back = AffineStretch(second, start=2.0, width=-1.0)
    both = Piecewise(np.array([0.0, 1.0, 2.0]), (first, back))
    t = np.linspace(0.0, 2.0, 41)
    alone = np.hstack(
        [Piecewise(both.knots[k : k + 2], (f,)).derivatives(t[t // 1 == k], 3) for k, f in enumerate(both.functions)]
    )
    balls = [
        Piecewise(both.knots[k : k + 2], (f,)).enclosure(k + 0.2, k + 0.4, 3) for k, f in enumerate(both.functions)
    ]
    evaluated = []
    monkeypatch.setattr(functions, "horner", lambda *args: evaluated.append(1) or horner(*args))
    assert both.derivatives(t, 3)[:, :-1].tolist() == alone.tolist()
    mid, rad = both.enclosure(np.array([0.2, 1.2]), np.array([0.4, 1.4]), 3)
    assert len(evaluated) == 2
    assert np.stack([mid, rad])[:, :, 0].tolist() == np.stack(balls[0])[:, :, 0].tolist()
    assert np.stack([mid, rad])[:, :, 1].tolist() == np.stack(balls[1])[:, :, 0].tolist()


def test_many_points_of_a_flank_take_no_more_memory_than_their_parts():
    """Each point has the coefficients of its own flank, a hundred with high powers."""
    flanks = [Flank.of((2, 26, 50, 74, power), 8.0)[0] for power in (100, 98)]
    flanks[1] = Flank((*flanks[1].coefficients, 0.0, 0.0))
    both = Piecewise(np.array([0.0, 1.0, 2.0]), (flanks[0], AffineStretch(flanks[1], start=2.0, width=-1.0)))
    t = np.linspace(0.0, 2.0, 30_001)
    tracemalloc.start()
    whole = both.derivatives(t, 2)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < 20e6  # 96 coefficients for each point alone would be 23 MB
    parts = np.hstack([both.derivatives(part, 2) for part in np.array_split(t, 100)])
    assert whole.tolist() == parts.tolist()
