"""The valve train to start from runs, and its valve does what its recipe says."""

import pytest

from camgeo.api.loading import load
from camgeo.capabilities.valve.starter import ANSWERS
from camgeo.output.pipeline import check
from camgeo.recipe.starter import starter


@pytest.mark.parametrize("name", ANSWERS.starters)
def test_the_starter_passes_with_its_lift_and_its_lash(name: str) -> None:
    report = check(load(starter(name))).report
    assert all(entry["ok"] for entry in report["checks"])
    assert report["valve"]["lift"] == pytest.approx(1.5 * 7.4 - 0.25, abs=1e-9)
