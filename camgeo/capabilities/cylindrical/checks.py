"""Checks of a drum that fail at the value 0 too: a line of contact or a rib of no length carries nothing."""

from __future__ import annotations

from camgeo.checks.declaration import Declared
from camgeo.checks.extension import Checks

LENGTH, RIB = "contact-length", "rib-thickness"
ANSWERS = Checks(others=[Declared(name, ("mm",), strict_at=(0.0,)) for name in (LENGTH, RIB)])
