"""In a quick run each cam is proved sound once in a process: most tests ask for one that others ask for too.

The design itself is made anew. What its proof depends on is its key; a cam that is refused is refused each time.
"""

from __future__ import annotations

import pickle
from typing import TYPE_CHECKING

import pytest

from camgeo.capabilities.indexing import soundness

if TYPE_CHECKING:
    from collections.abc import Iterator

    from camgeo.capabilities.indexing.design import IndexDesign

PROVED = "turret", "roller", "stops", "start", "motion", "clearance"  # of a recipe; neither its bore nor its files


@pytest.fixture(scope="package", autouse=True)
def proved_once(request: pytest.FixtureRequest) -> Iterator[None]:
    if request.config.getoption("markexpr") != "not slow":
        yield
        return
    real, known = soundness.demand_sound, set[bytes]()

    def demand_sound(design: IndexDesign) -> None:
        key = pickle.dumps([getattr(design.recipe, name) for name in PROVED])
        if key not in known:
            real(design)
            known.add(key)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("camgeo.capabilities.indexing.exact.demand_sound", demand_sound)
        yield
