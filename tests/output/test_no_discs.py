"""A request for which no disc has a file: there is none, and what each was checked for is told."""

from __future__ import annotations

from types import SimpleNamespace

from camgeo.output.job import Job, MadeFiles
from kin.numeric.check import Check


def test_checks_of_discs_without_files_are_kept() -> None:
    checks = [Check(f"cutter-reach {k}", False, 1.0, 0.0, "mm") for k in range(3)]
    products = [MadeFiles((), tuple(checks[:2])), MadeFiles((), (checks[2],))]
    made = Job.combine_discs(SimpleNamespace(), SimpleNamespace(kind="gcode"), products)
    assert made.files == ()
    assert made.checks == tuple(checks)
