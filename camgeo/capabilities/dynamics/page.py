"""Panels and plots of a follower train on the page."""

from __future__ import annotations

from camgeo.capabilities.dynamics.panel import panel
from camgeo.capabilities.dynamics.plots import plots
from camgeo.report.extension import Page

ANSWERS = Page(panel=panel, plots=plots)
