"""Runs attacks in worker processes that are watched: processor time, memory, and what they leave.

A worker makes many calls of `camgeo.cli.main.main` in one process. One that takes KILLED seconds of processor time, or
WAITED of any, or more memory than is allowed, is killed, which is a finding, and another takes its place.
"""

from __future__ import annotations

import contextlib
import io
import multiprocessing
import os
import resource
import tempfile
import time
import traceback
from collections import Counter
from itertools import islice
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from attacks.outcome import MOST_MEGABYTES, Attack, Done, findings

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable
    from multiprocessing.connection import Connection

KILLED = 90.0  # s of processor time after which a call is ended
WAITED = 400.0  # s of waiting after which it is
MANY = 400  # attacks of one worker, which then makes room for another


class Told(NamedTuple):
    """What came of one attack."""

    number: int
    name: str
    words: tuple[str, ...]
    status: int | None
    seconds: float
    megabytes: float
    findings: tuple[str, ...]


def run(seed: int, numbers: Iterable[int], told: Callable[[Told], None]) -> None:
    """Make the attacks of a seed one after another; `told` hears of each."""
    waiting = iter(numbers)
    left: list[int] = []
    while batch := [*left, *islice(waiting, MANY - len(left))]:
        left = _worked(seed, batch, told)


def _worked(seed: int, batch: list[int], told: Callable[[Told], None]) -> list[int]:
    """Make a batch in one process; gives what is left of it where that process had to be killed or died."""
    context = multiprocessing.get_context("spawn")
    here, there = context.Pipe()
    process = context.Process(target=_serve, args=(there, seed, batch), daemon=True)
    process.start()
    there.close()
    begun, spent = time.monotonic(), 0.0
    done, current = 0, "?"
    try:
        while done < len(batch):
            if here.poll(0.25):
                try:
                    message = here.recv()
                except EOFError:
                    told(Told(batch[done], current, (), None, 0.0, 0.0, ("traceback: the process died",)))
                    return batch[done + 1 :]
                if isinstance(message, str):
                    current, begun, spent = message, time.monotonic(), _seconds(process.pid)
                else:
                    done += 1
                    told(message)
                continue
            used, waited, memory = _seconds(process.pid) - spent, time.monotonic() - begun, _megabytes(process.pid)
            if used > KILLED or waited > WAITED or memory > 1.5 * MOST_MEGABYTES:
                why = f"time: killed after {used:.1f} s of processor time, {waited:.1f} s of waiting, {memory:.0f} MB"
                told(Told(batch[done], current, (), None, used, memory, (why,)))
                return batch[done + 1 :]
    finally:
        process.kill()
        process.join()
    return []


def _seconds(pid: int | None) -> float:
    """Processor seconds of a process."""
    try:
        fields = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    except OSError:
        return 0.0
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def _megabytes(pid: int | str | None, row: str = "VmRSS") -> float:
    try:
        lines = Path(f"/proc/{pid}/status").read_text().splitlines()
    except OSError:
        return 0.0
    return next((int(line.split()[1]) / 1024.0 for line in lines if line.startswith(row)), 0.0)


def _serve(pipe: Connection, seed: int, batch: list[int]) -> None:
    from attacks.generator import attack_of

    _imported()
    for number in batch:
        pipe.send(f"{number} being made")
        try:
            attack = attack_of(seed, number)
            pipe.send(attack.name)
            pipe.send(made(attack, number))
        except Exception:  # noqa: BLE001 - a fault of the generator is told, and is not one of camgeo
            fault = f"generator: {traceback.format_exc(limit=-3)}"
            pipe.send(Told(number, "generator", (), None, 0.0, 0.0, (fault,)))


def _imported() -> None:
    """Import what a first call would import, which is not its own time."""
    from camgeo.registry.formats import MODULES

    with tempfile.TemporaryDirectory() as folder:
        recipe = Path(folder) / "cam.yaml"
        recipe.write_text(
            "cam: {kind: support, p: 9 + cos(3*t)}\npart: {thickness: 5, bore: 4, hub: {diameter: 8, height: 4}}\n"
            f"export: {{tolerance: 0.01, files: [{', '.join(MODULES)}]}}\nverify: {{angles: 60}}\n"
        )
        call(("export", str(recipe), "--out", folder))
        call(("verify", str(recipe), f"{folder}/cam/cam.dxf", f"{folder}/cam/cam.3mf", "--second-opinion"))


def made(attack: Attack, number: int) -> Told:
    """Make one attack in a folder of its own, in this process."""
    with tempfile.TemporaryDirectory(prefix="attack-") as folder:
        for name, raw in attack.files.items():
            path = Path(folder, name)
            path.parent.mkdir(exist_ok=True)
            path.write_bytes(raw)
        before = Path.cwd()
        os.chdir(folder)
        try:
            done = call(attack.words)
        finally:
            os.chdir(before)
        found = findings(attack, done, Path(folder))
    return Told(number, attack.name, attack.words, done.status, done.seconds, done.megabytes, tuple(found))


def call(words: tuple[str, ...]) -> Done:
    """Call the command line in this process; what it would print, its cost, and its traceback if it has one."""
    from camgeo.cli.main import main

    out, err = io.TextIOWrapper(io.BytesIO(), "utf-8"), io.TextIOWrapper(io.BytesIO(), "utf-8")
    with contextlib.suppress(OSError):
        Path("/proc/self/clear_refs").write_text("5")  # the highest memory begins anew
    begun, status, fault = _used(), 0, ""
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
        try:
            status = main(list(words))
        except SystemExit as left:
            status = left.code if isinstance(left.code, int) else 1
        except BaseException:  # noqa: BLE001 - whatever comes out is what is looked for
            status, fault = 1, traceback.format_exc(limit=-6)
    texts = []
    for stream in (out, err):
        with contextlib.suppress(ValueError):
            stream.flush()
            texts.append(stream.buffer.getvalue().decode("utf-8", "replace"))
    printed, said = (*texts, "", "")[:2]
    return Done(status, printed, said, _used() - begun, _megabytes("self", "VmHWM"), fault)


def _used() -> float:
    spent = [resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
    return sum(one.ru_utime + one.ru_stime for one in spent)


def summary(all_told: list[Told]) -> str:
    """Counts of statuses, of findings by kind, and the slowest."""
    by_status = Counter(one.status for one in all_told)
    by_kind = Counter(text.partition(":")[0] for one in all_told for text in one.findings)
    slow = max(all_told, key=lambda one: one.seconds, default=None)
    large = max(all_told, key=lambda one: one.megabytes, default=None)
    statuses = ", ".join(f"{count} ended with {status}" for status, count in sorted(by_status.items(), key=str))
    lines = [f"{len(all_told)} attacks: {statuses}", f"findings: {dict(by_kind) or 'none'}"]
    if slow is not None and large is not None:
        lines.append(f"slowest {slow.seconds:.1f} s ({slow.name}), largest {large.megabytes:.0f} MB ({large.name})")
    return "\n".join(lines)
