"""What an attack is, and what may come of it."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, TypeAlias

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

MOST_SECONDS = 5.0  # of processor time, a call
MOST_MEGABYTES = 2048.0  # resident


@dataclass(frozen=True)
class Done:
    """What one call of the command line left: its exit status, what it printed, and what it cost."""

    status: int
    out: str
    err: str
    seconds: float = 0.0
    megabytes: float = 0.0
    traceback: str = ""


Judge: TypeAlias = "Callable[[Done, Path], list[str]]"


def nothing_more(_: Done, __: Path) -> list[str]:
    """Judge nothing but what is judged of every call."""
    return []


@dataclass(frozen=True)
class Attack:
    """One call of the command line, in a folder with these files.

    `statuses` are those that it may end with; `judge` gives what else is wrong of it, each as `<kind>: <what>`, with
    the folder as it is left. `seconds` is more than MOST_SECONDS only for what is known to take longer, by `name`.
    """

    name: str
    words: tuple[str, ...]
    files: dict[str, bytes] = field(default_factory=dict)
    statuses: tuple[int, ...] = (0, 1, 2, 3)
    judge: Judge = nothing_more
    seconds: float = MOST_SECONDS


FOREIGN = ("Traceback (most", "<class '", "object at 0x", "NoneType", "np.float64", "Warning: ", "RuntimeWarning")
"""Words of Python's, numpy's and other libraries' that no user is to read."""


def findings(attack: Attack, done: Done, folder: Path) -> list[str]:
    """Tell what is wrong with the outcome of an attack, each as `<kind>: <what>`."""
    if done.traceback:
        return [f"traceback: {done.traceback}"]
    found = []
    if done.seconds > attack.seconds:
        found.append(f"time: {done.seconds:.1f} s, at most {attack.seconds:g}")
    if done.megabytes > MOST_MEGABYTES:
        found.append(f"memory: {done.megabytes:.0f} MB, at most {MOST_MEGABYTES:g}")
    if done.status not in attack.statuses:
        found.append(f"status: {done.status}, expected {attack.statuses}: {(done.err or done.out)[:300]!r}")
    if done.status in {2, 3} and not done.err.strip():
        found.append(f"words: status {done.status} without a word")
    found += [f"words: {word!r} in {text[:300]!r}" for text in (done.out, done.err) for word in FOREIGN if word in text]
    return [*found, *attack.judge(done, folder)]
