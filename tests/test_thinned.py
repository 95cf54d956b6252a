"""What a quick run takes of a table: each value of each parameter, always the first; parts of slow runs; examples."""

from importlib import import_module
from itertools import product
from types import SimpleNamespace

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
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


def test_every_slow_test_is_in_one_part_and_rows_of_a_table_in_all():
    rows = [row(names, 1, slow=True) for names in product(CAMS, FAULTS)]
    single = [row((str(number),), 1, slow=True) for number in range(30)]
    for number, one in enumerate(single):
        one.nodeid = one.nodeid.replace("a_fault", f"one_{number}")
    fast = [row((fault,), 1) for fault in FAULTS]
    left = [left_to_other_parts([*rows, *single, *fast], part, 3) for part in (1, 2, 3)]
    taken = [[one for one in [*rows, *single] if one not in others] for others in left]
    assert [sum(one in rows for one in part) for part in taken] == [4, 4, 4]
    assert min(sum(one in single for one in part) for part in taken) > 4
    assert sorted(one.nodeid for part in taken for one in part) == sorted(one.nodeid for one in [*rows, *single])
    assert all(one not in others for others in left for one in fast)
    assert left_to_other_parts(rows, 1, 1) == []


def test_examples_are_the_same_whatever_was_imported_before(tmp_path, monkeypatch):
    """Else they would depend on the tests that one process ran before, and on how many processes there are."""
    (tmp_path / "module_of_constants.py").write_text(f"CONSTANTS = {[*range(10**6, 10**6 + 50)]}\n")
    monkeypatch.syspath_prepend(tmp_path)
    runs = []

    @settings(max_examples=60)
    @given(st.integers())
    def example(number):
        runs[-1].append(number)

    for _ in range(2):
        runs.append([])
        example()
        import_module("module_of_constants")
    assert runs[0] == runs[1]
