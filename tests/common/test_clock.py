"""Seconds of stages: those within another are not counted twice, and each is told as it begins."""

import time

from camgeo.common.clock import Clock


def test_a_stage_leaves_out_the_stages_within_it(monkeypatch):
    times = iter([0.0, 1.0, 4.0, 9.0, 10.0, 12.0])
    monkeypatch.setattr(time, "perf_counter", lambda: next(times))
    begun = []
    timed = Clock(begun.append)
    with timed.stage("outer"), timed.stage("inner"):
        pass
    with timed.stage("last"):
        pass
    assert timed.stages == [("inner", 3.0), ("outer", 6.0), ("last", 2.0)]
    assert begun == ["outer", "inner", "last"]
