"""The same outcome whoever computes the chunks, in whatever order, and however often the run is killed."""

from __future__ import annotations

import hashlib
import json
import logging
import os
import re
import signal
import socket
import subprocess
import sys
import threading
import time
from contextlib import suppress
from itertools import count
from types import SimpleNamespace
from typing import TYPE_CHECKING

import numpy as np
import pytest
from support.cases import few
from support.heavy import distributed
from support.places import TESTS
from support.sweepers import GRID, PROCEDURES, Aside, calls, hills, job, task, tree

from camgeo.capabilities.sweep import engines
from camgeo.capabilities.sweep.chunks import EngineError, SweepJob, VersionsError, chunks_of, compute, decode, result
from camgeo.capabilities.sweep.engines import Workers
from camgeo.capabilities.sweep.figures import compute_figures
from camgeo.capabilities.sweep.keys import Axis
from camgeo.capabilities.sweep.plan import Plan
from camgeo.capabilities.sweep.search import search
from camgeo.capabilities.sweep.task import SweepTask
from camgeo.recipe.loading import read

if TYPE_CHECKING:
    from pathlib import Path

    from distributed import LocalCluster

HELPERS = f"{TESTS}{os.pathsep}{TESTS / 'capabilities' / 'sweep'}"  # where a run of its own finds this file

RUN = """\
import sys
from pathlib import Path
from support.sweepers import PROCEDURES, task
from camgeo.capabilities.sweep import engines
from camgeo.capabilities.sweep.engines import Workers
from camgeo.capabilities.sweep.search import search
if __name__ == "__main__":
    engines._TRIAL = engines._WORTHWHILE = 0.0  # processes after the first chunk
    search(task(sys.argv[1]), Path(sys.argv[2]), Workers(int(sys.argv[3])), PROCEDURES)
"""


@pytest.fixture(scope="module")
def cluster():
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, processes=True, dashboard_address=":0") as cluster:
        yield cluster


@pytest.fixture
def near():
    """A scheduler whose only worker is a thread of this process."""
    how = {"n_workers": 1, "threads_per_worker": 1, "processes": False, "protocol": "tcp", "dashboard_address": ":0"}
    with distributed.LocalCluster(**how) as cluster:
        yield cluster


@pytest.fixture(scope="module")
def plain(tmp_path_factory: pytest.TempPathFactory) -> dict[str, bytes]:
    """Files of a sweep that one process computed in one go."""
    out = tmp_path_factory.mktemp("plain")
    search(task(), out, Workers(1), PROCEDURES)
    return tree(out)


def hasty(scene, values):
    """Another order of arrival: the earlier a chunk, the longer it takes."""
    time.sleep(max(0.0, 0.1 - 0.01 * (values[0, 0] - 10.0)))
    return hills(scene, values)


def failing(scene, values):
    """A fault that the first chunk does not meet."""
    if values[0, 0] > 12.0:
        raise ArithmeticError("no figures beyond 12")
    return hills(scene, values)


# --- equality ---------------------------------------------------------------------------------------------------------


@pytest.mark.usefixtures("pooled")
@pytest.mark.slow
@pytest.mark.parametrize("engine", few(["processes", "as many as are worthwhile", "dask"], 3))
def test_every_engine_writes_the_same_files(
    engine: str, cluster: LocalCluster, plain: dict[str, bytes], tmp_path: Path
) -> None:
    how = {
        "processes": Workers(2),
        "as many as are worthwhile": Workers(),
        "dask": Workers(scheduler=cluster.scheduler_address),
    }[engine]
    told = tmp_path / "calls"
    told.mkdir()
    outcome = search(task(f"calls={told}; seconds=0.01;"), tmp_path / "out", how, PROCEDURES)
    assert outcome.work.computed == GRID.count
    assert len(calls(told)) == len(set(calls(told))) == GRID.chunks
    assert tree(tmp_path / "out") == plain


@pytest.mark.usefixtures("pooled")
@pytest.mark.thin(3)
@pytest.mark.parametrize("engine", ["serial", "processes", "dask"])
def test_chunks_are_the_same_bytes_in_any_order_of_arrival(engine: str, request: pytest.FixtureRequest) -> None:
    slow = SweepJob(GRID, Aside(), hasty)
    numbers = list(range(GRID.chunks))
    how = Workers({"serial": 1, "processes": 2, "dask": None}[engine])
    if engine == "dask":
        how = Workers(scheduler=request.getfixturevalue("cluster").scheduler_address)
    landed = dict(how.results(slow, numbers))
    assert landed == {number: result(slow, number, slow.key) for number in numbers}


@pytest.mark.usefixtures("pooled")
@pytest.mark.slow
@pytest.mark.parametrize("engine", ["processes", "dask"])
def test_figures_of_linkages_are_the_same_bytes_from_every_engine(engine: str, cluster: LocalCluster) -> None:
    text = task().recipe.text
    for old, new in (
        (", steps: 25", ""),
        (", steps: 33", ""),
        ("rank: dwell", "rank: dwell\n  method: sobol\n  count: 300"),
    ):
        assert old in text
        text = text.replace(old, new)
    asked = SweepTask.from_recipe(read(text.encode(), "four-bar.yaml"))
    real = SweepJob(asked.plan, asked.scene(asked.figures), compute_figures)
    how = {"processes": Workers(2), "dask": Workers(scheduler=cluster.scheduler_address)}[engine]
    numbers = range(real.plan.chunks)
    landed = dict(how.results(real, numbers))
    assert landed == {number: result(real, number, real.key) for number in numbers}
    dwells = np.concatenate([decode(landed[n], real.key, *real.plan.span(n))["dwell"] for n in numbers])
    assert len(np.unique(dwells)) > 250


def test_more_processes_are_started_only_where_they_pay(monkeypatch: pytest.MonkeyPatch) -> None:
    started = []

    def instead(function, items, count):
        started.append((list(items), count))
        return ((item, function(item)) for item in items)

    monkeypatch.setattr(engines, "in_processes", instead)
    monkeypatch.setattr(engines, "_TRIAL", 0.02)
    monkeypatch.setattr(os, "sched_getaffinity", lambda _: {0, 1, 2})
    seconds, times = 0.01, count()  # a chunk takes so long by the clock that is played here
    monkeypatch.setattr(engines, "time", SimpleNamespace(perf_counter=lambda: seconds * next(times)))
    for how in (Workers(), Workers(4), Workers(1)):
        assert [number for number, _ in how.results(job(), range(GRID.chunks))] == list(range(GRID.chunks))
    assert started == []
    monkeypatch.setattr(engines, "_WORTHWHILE", 0.05)
    seconds = 0.03
    for how in (Workers(), Workers(4), Workers(1)):
        assert [number for number, _ in how.results(job(), range(GRID.chunks))] == list(range(GRID.chunks))
    assert started == [(list(range(1, GRID.chunks)), 3), (list(range(1, GRID.chunks)), 4)]


@pytest.mark.usefixtures("pooled")
@pytest.mark.parametrize("engine", ["serial", "processes", "dask"])
def test_a_fault_of_what_computes_comes_through(engine: str, request: pytest.FixtureRequest, tmp_path: Path) -> None:
    how = Workers({"serial": 1, "processes": 2, "dask": None}[engine])
    if engine == "dask":
        how = Workers(scheduler=request.getfixturevalue("near").scheduler_address)
    faulty = SweepJob(GRID, Aside(), failing)
    with pytest.raises(ArithmeticError, match="no figures beyond 12"):
        compute(faulty, chunks_of(faulty, tmp_path), how)


@pytest.mark.usefixtures("pooled")
@pytest.mark.parametrize("engine", few(["processes", "dask"]))  # Dask's workers take seconds to start
def test_workers_refuse_a_job_that_they_read_otherwise(
    engine: str, request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("camgeo.capabilities.sweep.chunks.__version__", "99.0")
    how = Workers(2)
    if engine == "dask":
        how = Workers(scheduler=request.getfixturevalue("cluster").scheduler_address)
    with pytest.raises(VersionsError, match="a worker has other versions than this run") as caught:
        list(how.results(job(), [0, 1]))
    if engine == "dask":
        assert re.search(r"tcp://.* has camgeo .*, numpy .*, this run camgeo 99\.0, numpy", str(caught.value))


@pytest.mark.slow
def test_a_worker_without_camgeo_is_told(tmp_path: Path) -> None:
    preload = tmp_path / "without.py"
    preload.write_text("import sys\nsys.modules['camgeo'] = None\n", encoding="utf-8")
    with distributed.LocalCluster(n_workers=0, dashboard_address=":0") as empty:
        options = ["--no-nanny", "--no-dashboard", "--preload", str(preload)]
        command = [sys.executable, "-m", "distributed.cli.dask_worker", empty.scheduler_address, *options]
        with subprocess.Popen(command, stderr=subprocess.DEVNULL) as worker:
            empty.wait_for_workers(1, 30)
            with pytest.raises(EngineError, match=r"^the worker at tcp://.* cannot run camgeo: .*camgeo"):
                next(engines.dask(job(), [0], empty.scheduler_address))
            worker.terminate()


# --- surroundings -----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("address", "message"),
    [
        ("tcp://127.0.0.1:1", "no Dask scheduler answers at tcp://127.0.0.1:1: "),
        ("nonsense", "nonsense is not the address of a Dask scheduler, such as tcp://host:8786"),
        ("tcp://here:port", "tcp://here:port is not the address of a Dask scheduler, such as tcp://host:8786"),
    ],
)
def test_a_scheduler_that_is_none_is_told_at_once(address: str, message: str) -> None:
    with pytest.raises(EngineError, match=f"^{message}"):
        next(engines.dask(job(), [0], address))


@pytest.mark.slow
@pytest.mark.parametrize("says", [b"", b"HTTP/1.1 400 Bad Request\r\nContent-Length: 0\r\n\r\n", bytes(64)])
def test_a_listener_that_is_no_scheduler_is_told_in_time(says: bytes, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(engines, "_TIMEOUT", 1.0)
    accepted = []

    def answer() -> None:
        with suppress(OSError):  # closed at the end
            while True:
                accepted.append(listener.accept()[0])
                accepted[-1].sendall(says)

    with socket.create_server(("127.0.0.1", 0)) as listener:
        threading.Thread(target=answer, daemon=True).start()
        address = f"tcp://127.0.0.1:{listener.getsockname()[1]}"
        with pytest.raises(EngineError, match=f"^the server at {address} (is not|does not|speaks)"):
            next(engines.dask(job(), [0], address))
        listener.shutdown(socket.SHUT_RDWR)
    for connection in accepted:
        connection.close()


@pytest.mark.slow
def test_distributed_prints_no_lines_of_its_own(caplog: pytest.LogCaptureFixture) -> None:
    loggers = [logging.getLogger(name) for name in ("distributed.client", "tornado.application")]
    for logger in loggers:
        logger.addHandler(caplog.handler)
    try:
        with engines._quiet():
            for logger in loggers:
                logger.error("Failed to reconnect to scheduler")
        assert not caplog.records
        loggers[0].error("as before")
        assert [record.getMessage() for record in caplog.records][:1] == ["as before"]
    finally:
        for logger in loggers:
            logger.removeHandler(caplog.handler)


@pytest.mark.slow
def test_a_worker_is_no_scheduler(cluster: LocalCluster) -> None:
    address = next(iter(cluster.scheduler_info["workers"]))
    with pytest.raises(EngineError, match=f"^the server at {address} is not a Dask scheduler, but a Worker$"):
        next(engines.dask(job(), [0], address))


@pytest.mark.slow
def test_a_scheduler_without_workers_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    said: list[str] = []

    def waiting(words: str) -> None:
        said.append(words)
        if "workers" in words:  # the scheduler has answered, in its own time
            monkeypatch.setattr(engines, "_TIMEOUT", 0.5)

    with (
        distributed.LocalCluster(n_workers=0, dashboard_address=":0") as empty,
        pytest.raises(EngineError, match="has no workers"),
    ):
        next(Workers(scheduler=empty.scheduler_address, waiting=waiting).results(job(), [0]))
    assert said == [f"the scheduler at {empty.scheduler_address} is asked"] + 2 * [
        f"the scheduler at {empty.scheduler_address} has no workers yet"
    ]


def slowly(seconds: float) -> float:
    time.sleep(seconds)
    return seconds


@pytest.mark.slow
def test_workers_are_left_behind_at_once_when_nobody_waits_for_them() -> None:
    begun = time.monotonic()
    results = engines.in_processes(slowly, [0.0, 600.0, 600.0], 2)
    assert next(results) == (0.0, 0.0)
    results.close()
    assert time.monotonic() - begun < 300.0


@pytest.mark.slow
def test_an_interrupt_while_workers_start_is_said_once(tmp_path: Path) -> None:
    script = tmp_path / "start.py"
    script.write_text(STARTING)
    environment = {**os.environ, "PYTHONPATH": HELPERS}
    with subprocess.Popen(
        [sys.executable, str(script)],
        env=environment,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    ) as process:
        assert process.stdout is not None
        process.stdout.readline()
        for _ in range(20):  # the whole group hears them, as from a terminal; the run itself is deaf here
            time.sleep(0.02)
            os.killpg(process.pid, signal.SIGINT)
        said, complaint = process.communicate(timeout=60)
    assert (said, complaint) == ("[0.0, 0.1]\n", "")


STARTING = """\
import signal
from camgeo.capabilities.sweep.engines import in_processes
from test_engines import slowly
if __name__ == "__main__":
    signal.signal(signal.SIGINT, lambda *_: None)
    print("begun", flush=True)
    print(sorted(result for _, result in in_processes(slowly, [0.0, 0.1], 2)))
"""


def killed(scene, values):
    """A chunk of which its process dies, from a value on."""
    if values[0, 0] > float(scene):
        os.kill(os.getpid(), signal.SIGKILL)
    return hills("", values)


@pytest.mark.usefixtures("pooled")
@pytest.mark.slow
@pytest.mark.parametrize("deadly", ["19.5", "12"])
def test_chunks_that_kill_their_process_fail_the_run_and_others_land(deadly: str, tmp_path: Path) -> None:
    """Where they are few all others land; where they are many the run soon ends."""
    sweep = SweepJob(GRID, deadly, killed)
    chunks = chunks_of(sweep, tmp_path)
    with pytest.raises(EngineError, match="a process was killed before it was done"):
        compute(sweep, chunks, Workers(2))
    first = [GRID.values(*GRID.span(number))[0, 0] for number in range(GRID.chunks)]
    kill = [number for number, value in enumerate(first) if value > float(deadly)]
    missing, damaged = chunks.missing_chunks()
    assert damaged == 0
    assert set(kill) <= set(missing)
    assert len(kill) > 4 or missing == kill


# --- killed and resumed -----------------------------------------------------------------------------------------------


def finished(out: Path) -> set[str]:
    return {path.name for path in out.glob("four-bar/sweep/*/chunk-*.bin")}


def first_values(names: set[str]) -> set[str]:
    """What the calls for these chunks leave behind."""
    numbers = (int(name[6:13]) for name in names)
    return {repr(GRID.values(*GRID.span(number))[0].tolist()) for number in numbers}


def assert_whole(folder: Path) -> None:
    """No file of a set without its report, and every one that the report names as it says."""
    report = folder / "sweep.json"
    if report.exists():
        for file in json.loads(report.read_text(encoding="utf-8"))["files"]:
            assert hashlib.sha256((folder / file["path"]).read_bytes()).hexdigest() == file["sha256"]


@pytest.mark.slow
@pytest.mark.parametrize("jobs", [1, 2])
def test_a_killed_sweep_goes_on_where_it_was_and_ends_the_same(
    jobs: int, plain: dict[str, bytes], tmp_path: Path
) -> None:
    out = tmp_path / "out"
    script = tmp_path / "run.py"
    script.write_text(RUN)
    environment = {**os.environ, "PYTHONPATH": HELPERS}
    # killed once so many chunks are there, and after them at some moments of what follows
    moments = [(1, 0.0), (9, 0.013), *((GRID.chunks, delay) for delay in (0.01, 0.7, 1.1))]
    for run, (chunks, delay) in enumerate(moments):
        told = tmp_path / f"calls-{run}"
        told.mkdir()
        before = finished(out)
        command = [sys.executable, str(script), f"calls={told}; seconds=0.02;", str(out), str(jobs)]
        with subprocess.Popen(command, env=environment, stderr=subprocess.DEVNULL) as process:
            while len(finished(out)) < chunks and process.poll() is None:
                time.sleep(0.001)
            time.sleep(delay)
            process.send_signal(signal.SIGKILL)
        assert before <= finished(out)
        assert_whole(out / "four-bar")
        assert not first_values(before) & set(calls(told))  # nothing that was finished is computed again
    told = tmp_path / "calls"
    told.mkdir()
    before = finished(out)
    outcome = search(task(f"calls={told};"), out, Workers(1), PROCEDURES)
    assert len(before) == GRID.chunks
    assert outcome.work.computed == 0
    assert calls(told) == []
    assert tree(out) == plain


@pytest.mark.slow
def test_workers_end_with_the_run_that_is_killed(tmp_path: Path) -> None:
    script = tmp_path / "run.py"
    script.write_text(RUN)
    told = tmp_path / "calls"
    told.mkdir()
    environment = {**os.environ, "PYTHONPATH": HELPERS}
    command = [sys.executable, str(script), f"calls={told}; seconds=1;", str(tmp_path / "out"), "2"]
    # workers hold the pipe open: it ends with the last of them
    with subprocess.Popen(command, env=environment, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL) as process:
        while not finished(tmp_path / "out") and process.poll() is None:
            time.sleep(0.01)
        process.send_signal(signal.SIGKILL)
        process.communicate(timeout=30)
    count = len(calls(told))
    time.sleep(0.5)
    assert len(calls(told)) == count < GRID.chunks


@pytest.mark.slow
def test_two_sweeps_at_once_do_not_disturb_each_other(plain: dict[str, bytes], tmp_path: Path) -> None:
    script = tmp_path / "run.py"
    script.write_text(RUN)
    environment = {**os.environ, "PYTHONPATH": HELPERS}
    out = tmp_path / "out"
    command = [sys.executable, str(script), "seconds=0.01;", str(out), "1"]
    runs = [subprocess.Popen(command, env=environment) for _ in range(2)]
    assert [run.wait() for run in runs] == [0, 0]
    assert tree(out) == plain


@pytest.mark.slow
def test_a_sweep_that_grows_does_not_take_the_old_ones_chunks(tmp_path: Path) -> None:
    short = job(Plan((Axis("x", 0.0, 1.0), Axis("y", 0.0, 1.0)), "random", 640))
    long = job(Plan(short.plan.axes, "random", 1280))
    compute(short, chunks_of(short, tmp_path), Workers(1))
    assert compute(long, chunks_of(long, tmp_path), Workers(1)).computed == 1280
