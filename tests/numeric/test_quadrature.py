"""Gauss's rule: exact for polynomials of degree 2 n - 1, and no more."""

import numpy as np
import pytest

from kin.numeric.quadrature import gauss


@pytest.mark.parametrize("count", [1, 3, 12])
def test_polynomials_up_to_their_degree_are_exact(count):
    nodes, weights = gauss(count)
    for degree in range(2 * count + 1):
        integral = 2.0 / (degree + 1) if degree % 2 == 0 else 0.0
        assert (float(weights @ nodes**degree) == pytest.approx(integral, abs=1e-14)) == (degree < 2 * count)
    assert np.all(np.diff(nodes) > 0.0)
