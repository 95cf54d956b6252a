"""Rows of a table that are measured for several counts, each in a process of its own, on one thread."""

from __future__ import annotations

import argparse
import os
import resource
import subprocess
import sys
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence


def peak_mb() -> str:
    """Greatest resident memory of this process so far, in MB."""
    return f"{resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0:.0f}"


def table(
    about: str, columns: Sequence[str], row: Callable[[int], Sequence[str]], counts: tuple[int, ...], few: int
) -> None:
    """Print the table of a script for its counts, or with --small for `few`; the first column is the count."""
    parser = argparse.ArgumentParser(description=about, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--small", action="store_true", help="a small size, to see that it works")
    parser.add_argument("--count", type=int, help=f"one row, for so many {columns[0]}")
    arguments = parser.parse_args()
    if arguments.count:
        print(f"| {' | '.join([str(arguments.count), *row(arguments.count)])} |", flush=True)
        return
    print(f"| {' | '.join(columns)} |")
    print(f"| {' | '.join('---' for _ in columns)} |", flush=True)
    for count in (few,) if arguments.small else counts:
        environment = {**os.environ, "OPENBLAS_NUM_THREADS": "1"}
        subprocess.run([sys.executable, sys.argv[0], "--count", str(count)], env=environment, check=True)
