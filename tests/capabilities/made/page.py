"""Tables of keys that docs/made.md explains in its own words, for the list of all keys."""

from camgeo.capabilities.made.keys import POINT_FILE

LISTED = {"made.points": POINT_FILE}
