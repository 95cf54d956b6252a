"""Content of a page: the exact contours that it traces, and the places on them."""

from __future__ import annotations

import math

import pytest

from camgeo.recipe.loading import load_text
from camgeo.report.page.content import content
from camgeo.report.page.outline import Exact
from camgeo.report.page.scene import STEPS
from camgeo.synthesis.design import designed

TEXT = "cam: {kind: support, p: 25 + 2*cos(3*t)}\nrotation: cw\n"


def on_contour(degrees: float) -> tuple[float, float]:
    angle = math.radians(degrees)
    p, slope = 25.0 + 2.0 * math.cos(3.0 * angle), -6.0 * math.sin(3.0 * angle)
    return p * math.cos(angle) - slope * math.sin(angle), p * math.sin(angle) + slope * math.cos(angle)


@pytest.mark.parametrize(("per", "share"), [(1, 0.0), (3, 1.0 / 3.0), (6, 0.5)])
def test_the_nearest_of_the_places_that_are_traced(per: int, share: float, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Exact, "looks", lambda _files: per)
    recipe = load_text(TEXT, "cam.yaml")
    (traced,) = content(recipe, designed(recipe), []).contours.values()
    step = 360.0 / STEPS
    for k in (0, 1, 200, 719):
        at_deg = (k + share) * step
        assert traced.point[k] == pytest.approx(on_contour(at_deg), abs=1e-9)
        for near in (-0.49, 0.0, 0.49):
            assert traced.at(at_deg + near * step) == pytest.approx(on_contour(at_deg), abs=1e-9)
