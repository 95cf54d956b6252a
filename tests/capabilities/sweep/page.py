"""Tables of docs/sweep.md that no field holds."""

from camgeo.capabilities.sweep.keys import RANGE

TABLES = {"sweep.vary": RANGE}
