"""Fits of one contour: each made once, within the tolerance that was given, less what a formula loses by rounding."""

from __future__ import annotations

import numpy as np
import pytest

from camgeo.common.clock import Clock
from camgeo.curve.curve import Curve
from camgeo.curve.support import SupportShape
from camgeo.fit.cache import Fits, formula_rounding
from camgeo.fit.nodes import ToleranceError
from kin.law.support_function import lift_from_fourier

CURVE = Curve.whole(SupportShape(lift_from_fourier(25.0, {3: 2.0}, {})))
FORMS = ("polyline", "arcs", "spline")


@pytest.mark.parametrize("form", FORMS)
def test_a_fit_is_made_once_and_keeps_its_tolerance(form: str) -> None:
    fits = Fits(CURVE, Clock())
    coarse, fine = fits.within(form, 0.01), fits.within(form, 0.001)
    assert fits.within(form, 0.01) is coarse
    assert 0.003 < max(coarse.bound.outward, coarse.bound.inward) <= 0.01
    assert 0.0003 < max(fine.bound.outward, fine.bound.inward) <= 0.001


@pytest.mark.parametrize("form", FORMS)
def test_what_a_formula_loses_comes_off_the_tolerance_and_into_the_bound(form: str) -> None:
    sure, unsure = Fits(CURVE, Clock()).within(form, 0.008), Fits(CURVE, Clock(), 0.001).within(form, 0.01)
    assert unsure.bound.outward == pytest.approx(sure.bound.outward + 0.001, rel=1e-12)
    assert unsure.bound.inward == pytest.approx(sure.bound.inward + 0.001, rel=1e-12)
    with pytest.raises(ToleranceError, match=r"at least 0\.004 mm") as refused:
        Fits(CURVE, Clock(), 0.001).within(form, 0.0039)
    assert refused.value.reached == pytest.approx(0.004)


def test_rounding_that_is_usual_counts_for_nothing() -> None:
    assert formula_rounding(float(np.finfo(float).eps), CURVE) == 0.0
    assert formula_rounding(1e-6, CURVE) == 1e-6
