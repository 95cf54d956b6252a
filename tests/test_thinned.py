"""What a quick run takes of a test's rows: each value of each parameter, and always the first."""

from itertools import product
from types import SimpleNamespace

import pytest
from support.cases import thinned_out

CAMS, FAULTS = ("yoke", "rollers", "pair"), ("turned", "moved", "scaled", "mirrored")


def row(names, every, *, slow=False):
    marks = {"thin": SimpleNamespace(args=(every,)), "slow": SimpleNamespace() if slow else None}
    return SimpleNamespace(
        nodeid=f"tests/test_rows.py::test_a_fault[{'-'.join(names)}]",
        callspec=SimpleNamespace(_idlist=names),
        get_closest_marker=marks.get,
    )


def quick(rows):
    left = list(thinned_out(rows))
    return [one.callspec._idlist for one in rows if one not in left and one.get_closest_marker("slow") is None]


def test_a_product_has_each_fault_once_and_each_cam():
    chosen = quick([row(names, 3) for names in product(CAMS, FAULTS)])
    assert sorted(fault for _, fault in chosen) == sorted(FAULTS)
    assert {cam for cam, _ in chosen} == set(CAMS)


def test_of_rows_that_are_few_already_the_first_stays():
    assert quick([row((fault,), 2, slow=number % 2 == 0) for number, fault in enumerate(FAULTS)]) == [("moved",)]


@pytest.fixture(params=CAMS)
def cam(request):
    return request.param


@pytest.mark.parametrize("fault", FAULTS)
def test_a_row_has_the_names_of_its_parameters(request, cam, fault):
    """Pytest has no public word for them."""
    assert sorted(request.node.callspec._idlist) == sorted([cam, fault])
