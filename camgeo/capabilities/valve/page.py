"""Panel and plots of a valve on the page."""

from __future__ import annotations

from camgeo.capabilities.valve.section import panel, plots
from camgeo.report.extension import Page

ANSWERS = Page(panel=panel, plots=plots)
