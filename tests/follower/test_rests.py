"""Dwells of intended motions, against where a law was made constant."""

from __future__ import annotations

import numpy as np
import pytest

from kin.follower.rests import dwell_angles, dwells_of_law
from kin.law.piecewise import Piecewise
from kin.law.segment import Constant
from kin.law.support_function import lift_from_fourier

TURN = 2.0 * np.pi
WAVE = lift_from_fourier(40.0, {2: 3.0}, {}).law.functions[0]


def test_constant_stretches_are_the_dwells_and_no_others() -> None:
    law = Piecewise(np.array([0.5, 2.0, 3.0, 0.5 + TURN]), (Constant(43.0), WAVE, Constant(41.0)), TURN)
    assert sorted(dwells_of_law(law)) == [
        pytest.approx((0.5, 2.0), abs=1e-12),
        pytest.approx((3.0, 0.5 + TURN), abs=1e-12),
    ]


def test_a_law_without_breaks_rests_all_round_or_nowhere() -> None:
    ends = np.array([0.0, TURN])
    assert list(dwells_of_law(Piecewise(ends, (Constant(40.0),), TURN, smooth_seam=True))) == [(0.0, TURN)]
    assert list(dwells_of_law(Piecewise(ends, (WAVE,), TURN, smooth_seam=True))) == []


def test_angles_within_a_dwell_over_the_seam_follow_its_beginning() -> None:
    (angles,) = dwell_angles([(6.0, 7.0)], np.array([0.2, 1.0, 6.1]))
    assert angles == pytest.approx([6.0, 6.1, 0.2 + TURN, 7.0], abs=1e-12)
