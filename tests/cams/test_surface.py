"""Figures of a surface over the shaft angle: their extremes, and where there are none."""

from __future__ import annotations

import numpy as np
import pytest

from camgeo.cams.surface import Surface, no_pressure_angle
from camgeo.curve.curve import Curve
from camgeo.curve.support import SupportShape
from kin.law.support_function import lift_from_fourier

LIFT = lift_from_fourier(25.0, {2: 2.0}, {})
CURVE = Curve.whole(SupportShape(LIFT))


def test_extremes_of_a_figure_are_those_of_its_series() -> None:
    surface = Surface(CURVE, CURVE, series={"lift": lambda tau, side=1: LIFT.law.on(tau, side)})
    extremes = surface.extremes("lift")
    assert extremes is not None
    least, greatest = extremes
    assert least.value == pytest.approx(23.0, abs=1e-9)
    assert greatest.value == pytest.approx(27.0, abs=1e-9)
    assert surface.extremes("lift") is extremes
    assert surface.extremes("spin") is None


def test_a_face_square_to_its_way_has_no_pressure_angle() -> None:
    assert no_pressure_angle(np.linspace(0.0, 6.0, 5)).tolist() == [0.0] * 5


def test_columns_of_one_surface_among_several_bear_its_name() -> None:
    assert Surface(CURVE, CURVE).prefix == ""
    assert Surface(CURVE, CURVE, name="outer flank").prefix == "outer_flank_"
