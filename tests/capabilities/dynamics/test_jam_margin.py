# needs: sweep
"""Margin of the pressure angle to jamming, for many cams: by hand, and refused where no stem is led."""

from __future__ import annotations

import math
from types import SimpleNamespace

import numpy as np
import pytest

from camgeo.capabilities.dynamics.sweep import _jam_margin

GUIDE = SimpleNamespace(guide=SimpleNamespace(jam=lambda: math.radians(40.0)))


def cams(train: object, lean: float | None) -> SimpleNamespace:
    return SimpleNamespace(
        recipe=SimpleNamespace(of=lambda _: train),
        lean=lean,
        slope=None,
        most=lambda _: np.tan(np.radians([25.0, 44.0, -3.0])),
    )


def test_the_steeper_of_slope_and_lean_counts() -> None:
    found = _jam_margin(cams(GUIDE, math.tan(math.radians(10.0))))
    assert found == pytest.approx([15.0, -4.0, 30.0])


@pytest.mark.parametrize("train", [None, SimpleNamespace(guide=None), GUIDE])
def test_without_a_led_stem_there_is_none(train: object) -> None:
    with pytest.raises(TypeError, match="no stem is led in a guide"):
        _jam_margin(cams(train, None if train is GUIDE else 0.1))
