"""Checks of a drum at which a figure fails that is on its limit: a length of 0 carries nothing."""

from __future__ import annotations

from camgeo.checks.declaration import Declared
from camgeo.checks.extension import Checks

LENGTH, RIB = "contact-length", "rib-thickness"
ANSWERS = Checks(others=[Declared(name, ("mm",), strict_at=(0.0,)) for name in (LENGTH, RIB)])
