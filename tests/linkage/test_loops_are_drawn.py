"""Every loop of a linkage has its maker on the page and in printed sets."""

import pytest

from camgeo.capabilities.mechanism import linkage_bodies as bodies  # needs: mechanism
from camgeo.report.page import linked as page
from kin.linkage import dyad, four_bar


def kinds(module):
    """Classes of a module of kin that are loops: they tell how far they are from binding."""
    own = (one for one in vars(module).values() if isinstance(one, type) and one.__module__ == module.__name__)
    return {kind for kind in own if "margins" in vars(kind)}


TABLES = {"page": set(page.MAKERS)}
TABLES["bodies"] = set(bodies.MAKERS)  # needs: mechanism


@pytest.mark.parametrize("table", TABLES.values(), ids=TABLES)
def test_every_loop_has_a_maker(table):
    loops = kinds(four_bar) | kinds(dyad)
    assert len(loops) == 6
    assert table == loops
