"""Table of earlier runs, on the page and on the terminal."""

from __future__ import annotations

from camgeo.capabilities.made.earlier_runs import lines, panel
from camgeo.report.extension import Page

ANSWERS = Page(panel=panel, lines=lines)
