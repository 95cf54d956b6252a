"""The command's entry: numpy starts with one thread there, and the environment of a program stays its own.

Holds: camgeo.__main__.
"""

from __future__ import annotations

import os
import subprocess
import sys

import pytest
from support.places import ROOT

COMMAND = """
import os, sys
import camgeo.cli.main as cli
def environment(_):
    import numpy
    print([os.environ.get(name) for name in sorted(entry._THREADS)])
    return 0
from camgeo import __main__ as entry
cli.main = lambda: environment(None)
entry.main()
"""
LIBRARY = """
import os
before = dict(os.environ)
import camgeo, camgeo.pytest_plugin, camgeo.testing
camgeo.design(camgeo.load("recipes/rabinowitz.yaml"))
assert dict(os.environ) == before
"""
NAMES = ("MKL_NUM_THREADS", "OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "VECLIB_MAXIMUM_THREADS")


@pytest.mark.thin(2)
@pytest.mark.parametrize(
    ("given", "seen"),
    [({}, "['1', '1', '1', '1']"), ({"OMP_NUM_THREADS": "3"}, "[None, '3', None, None]")],
    ids=["unset", "set"],
)
def test_a_command_starts_one_thread_unless_told_otherwise(given: dict[str, str], seen: str) -> None:
    bare = {name: value for name, value in os.environ.items() if name not in NAMES}
    done = subprocess.run([sys.executable, "-c", COMMAND], env=bare | given, capture_output=True, text=True, check=True)
    assert done.stdout.strip() == seen


@pytest.mark.slow
def test_the_library_leaves_the_environment_alone() -> None:
    bare = {name: value for name, value in os.environ.items() if name not in NAMES}
    subprocess.run([sys.executable, "-c", LIBRARY], env=bare, cwd=ROOT, check=True)


LEFT_TO_THE_END = """
import atexit, threading, time, weakref
class Kept: pass
kept = Kept()
weakref.finalize(kept, print, "finalizer")
atexit.register(print, "registered before")
import camgeo.cli.main as cli
def run():
    atexit.register(print, "registered within")
    threading.Thread(target=lambda: (time.sleep(0.2), print("thread"))).start()
    return 1
cli.main = run
from camgeo.__main__ import main
main()
"""


SAID = """
import camgeo.cli.main as cli
cli.main = lambda: print("said") or 1
from camgeo.__main__ import main
main()
"""


def test_nothing_that_is_left_to_the_end_is_lost() -> None:
    done = subprocess.run([sys.executable, "-c", LEFT_TO_THE_END], capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (1, "")
    assert sorted(done.stdout.splitlines()) == ["finalizer", "registered before", "registered within", "thread"]


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="no device that is always full")  # noqa: PTH110
def test_an_output_that_cannot_be_written_changes_no_other_status() -> None:
    """What is said is held back until the end, as without PYTHONUNBUFFERED."""
    kept = {name: value for name, value in os.environ.items() if name != "PYTHONUNBUFFERED"}
    call = [sys.executable, "-c", SAID]
    with open("/dev/full", "w", encoding="utf-8") as full:  # noqa: PTH123
        done = subprocess.run(call, env=kept, stdout=full, stderr=subprocess.PIPE, text=True, check=False)
    assert (done.returncode, done.stderr) == (1, "")
