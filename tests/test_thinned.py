"""Rows that a quick run takes of a test: each value of each parameter, always the first; and parts of slow runs."""

from itertools import product
from types import SimpleNamespace

import pytest
from support.cases import left_to_other_parts, thinned_out

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


def test_every_slow_row_is_in_one_part_and_each_part_has_rows_of_each_table():
    names = list(product(CAMS, FAULTS))
    rows = [row(name, 1, slow=True) for name in names]
    few = [row((cam,), 1, slow=True) for cam in CAMS]
    for one in few:
        one.nodeid = one.nodeid.replace("a_fault", "a_cam")
    fast = [row((fault,), 1) for fault in FAULTS]
    left = [left_to_other_parts([*rows, *few, *fast], part, 3) for part in (1, 2, 3)]
    taken = [[one for one in rows if one not in others] for others in left]
    assert [len(part) for part in taken] == [4, 4, 4]
    assert sorted(one.callspec._idlist for part in taken for one in part) == sorted(names)
    assert all(one not in others for others in left for one in [*few, *fast])
    assert left_to_other_parts(rows, 1, 1) == []
