"""Quick tests of much work say why: the work is counted, and those that do not are found."""

from __future__ import annotations

import subprocess
import sys

import pytest
from support import work
from support.places import RECIPES

import camgeo


@pytest.mark.costly("exports and a process, as they are what is counted")
def test_an_export_is_one_and_a_process_counts(tmp_path):
    count = work.Work()
    count.count()
    try:
        count.pytest_runtest_setup()
        assert count.export > 100.0
        camgeo.export(RECIPES / "shu-wu.yaml", tmp_path)
        assert (count.done - count.begun) / count.export == pytest.approx(1.0, rel=0.05)
        before = count.done
        subprocess.run([sys.executable, "-S", "-c", ""], check=True)
        assert count.done > before
    finally:
        count.stop()
    before = count.done
    camgeo.design(RECIPES / "shu-wu.yaml")
    assert count.done == before


class Item:
    """A test with marks."""

    def __init__(self, *marks):
        self.get_closest_marker = dict.fromkeys(marks, "it is so").get


def run(count, item, did, scope="function"):
    """A test for which a fixture of a scope works, by so many exports."""
    count.pytest_runtest_setup()
    fixture = count.pytest_fixture_setup(type("Fixture", (), {"scope": scope}))
    next(fixture)
    count.done += did * count.export
    with pytest.raises(StopIteration):
        fixture.send(None)
    call = count.pytest_runtest_call(item)
    next(call)
    with pytest.raises(StopIteration):
        call.send(None)


def test_a_test_of_much_work_needs_a_reason():
    count = work.Work()
    count.export = 500.0
    run(count, Item(), 6.9)
    run(count, Item("costly"), 9.0)
    run(count, Item("slow"), 9.0)
    run(count, Item(), 9.0, scope="module")
    with pytest.raises(pytest.fail.Exception, match=r"the work of 7\.1 exports of shu-wu: do with less"):
        run(count, Item(), 7.1)
