"""Outlines of a camshaft that meet at one height: one within the other, or crossing."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from camgeo.capabilities.camshaft.body import camshaft_outlines
from camgeo.files.errors import RegionError
from camgeo.fit.bound import Bound
from camgeo.fit.pieces import ArcSpline


def outlines(journal: float, lobe: tuple[float, float]) -> int:
    """Stretches of a shaft of 6 mm with a journal of this diameter on a round lobe between two distances, mm."""
    near, far = lobe
    contour = ArcSpline(np.array([[far, 0.0], [-near, 0.0]]), np.ones(2), Bound(0.0, 0.0))
    bars = [SimpleNamespace(diameter=6.0, low=0.0, high=30.0), SimpleNamespace(diameter=journal, low=20.0, high=25.0)]
    recipe: Any = SimpleNamespace(bars=bars, rotation="cw")
    placed: Any = SimpleNamespace(at=0.0, lobe=SimpleNamespace(low=10.0, high=20.0))
    fits: Any = SimpleNamespace(within=lambda *_: contour)
    return len(camshaft_outlines(recipe, [placed], lambda _: fits, 0.01)[0])


@pytest.mark.parametrize("journal", [16.0, 16.3, 32.3, 32.6])  # circles of some diameters have no rounding
def test_a_journal_that_crosses_the_lobe_beside_it_is_refused(journal: float) -> None:
    with pytest.raises(RegionError, match="cross one another"):
        outlines(journal, (0.5 * journal - 2.0, 0.5 * journal + 2.0))


@pytest.mark.parametrize("journal", [16.0, 16.3])
def test_a_journal_within_a_lobe_or_touching_it_from_inside_is_made(journal: float) -> None:
    assert outlines(journal, (0.5 * journal + 1.0, 0.5 * journal + 3.0)) == 4
    assert outlines(journal, (0.5 * journal, 0.5 * journal + 3.0)) == 4
