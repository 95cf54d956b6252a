"""Distinct values, against numpy.unique."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from kin.numeric.distinct import distinct


@given(st.lists(st.sampled_from([-np.inf, -1.0, -0.0, 0.0, 5e-324, 1.0, np.inf]), max_size=30))
def test_as_unique(values):
    array = np.array(values, dtype=float)
    assert np.array_equal(distinct(array), np.unique(array))
