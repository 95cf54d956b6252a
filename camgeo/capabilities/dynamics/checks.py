"""Checks of a follower train: their declarations, the guide's, and what would help a figure."""

from __future__ import annotations

from camgeo.capabilities.dynamics.declared import CHECKS
from camgeo.capabilities.dynamics.guide import guide_checks
from camgeo.capabilities.dynamics.remedies import of_limit
from camgeo.checks.extension import Checks

ANSWERS = Checks(checks=CHECKS, exact=lambda recipe, exact, _: guide_checks(recipe, exact), remedy=of_limit)
