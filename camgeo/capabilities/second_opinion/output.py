"""Checks of files beside the judge's, in a run with the option."""

from __future__ import annotations

from camgeo.capabilities.second_opinion.opinion import demand_libraries, look
from camgeo.output.extension import Output

ANSWERS = Output(demand=demand_libraries, look=look)
