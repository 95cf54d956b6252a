"""The values of a sweep carry units."""

from __future__ import annotations

import pytest

from camgeo.capabilities.sweep.keys import Sweep
from camgeo.recipe.loading import load_text
from camgeo.schema.errors import RecipeErrors


def refusal(text: str) -> str:
    with pytest.raises(RecipeErrors) as caught:
        load_text(text, "unit.yaml")
    return str(caught.value)


def support(text: str, units: str = "mm") -> str:
    return f"units: {units}\ncam: {{kind: support, p: 25 + 2*cos(3*t), shaft: [{text}, 4]}}\n"


def test_a_sweep_varies_in_the_unit_of_its_field() -> None:
    sweep = "sweep:\n  vary: {{{}}}\n  rank: size\n"
    at = "'cam.shaft[0]': "
    found = load_text(support("1 cm") + sweep.format(at + "{from: 1 cm, to: 0.75 in, steps: 4}"), "a.yaml").of(Sweep)
    assert found is not None
    assert (found.vary[0].low, found.vary[0].high) == (10.0, 19.05)
    listed = load_text(support("1", "inch") + sweep.format(at + "[12.7 mm, 1]"), "a.yaml").of(Sweep)
    assert listed is not None
    assert listed.vary[0].values == (0.5, 1.0)
    assert "'kg' is no unit of a length" in refusal(support("1") + sweep.format(at + "[1 kg]"))
    unknown = refusal(support("1") + sweep.format("cam.shoft: [1 mm]"))
    assert "unknown field" in unknown
    assert "no unit" not in unknown
