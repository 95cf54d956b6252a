"""Points of earlier runs in a run, and the cam that is corrected by them."""

from __future__ import annotations

from camgeo.capabilities.made.correction import corrected
from camgeo.capabilities.made.earlier_runs import examine, left_out
from camgeo.measures.extension import Measures

ANSWERS = Measures(
    examine=lambda recipe, design, _, clock: examine(recipe, design, clock),
    alter=corrected,
    remarks={"thickness": left_out},
)
