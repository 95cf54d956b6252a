"""Tables of keys that docs/camshafts.md explains in its own words, for the list of all keys."""

from camgeo.capabilities.camshaft.keys import JOURNAL, LOBE

LISTED = {"camshaft.journals": JOURNAL, "camshaft.lobes": LOBE}
