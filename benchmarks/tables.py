"""What a motion from a table costs: `python benchmarks/tables.py [--small]`.

Processor time without imports, the least of several runs, and the greatest resident memory, for a table of 36, 360,
3,600 and 100,000 rows to two, three and four decimals; one process each, on one thread. The motions are two strokes
with dwells between them, and two without. What is aimed at: 10, 30, 250 ms and 6 s, within 350 MB.
"""

from __future__ import annotations

import argparse
import math
import os
import resource
import subprocess
import sys
import time

COUNTS = (36, 360, 3_600, 100_000)
MANY = 100_000  # rows whose last digit of fewer than four is many rows long
SHORT = 20_000  # rows that are read again and again for their least time


def measure(count: int) -> str:
    """Row of the table for a number of rows."""
    import numpy as np

    from kin.law.sources.laws import named
    from kin.law.sources.programme import Dwell, Move, programme
    from kin.law.sources.ring import Samples
    from kin.law.sources.table import from_table

    rad = math.radians
    plate = [Move(rad(100), named("modified-sine"), by=20.0), Dwell(rad(60))]
    plate += [Move(rad(140), named("modified-trapezoid"), by=-20.0), Dwell(rad(60))]
    law = named("polynomial-345")
    strokes = [Move(rad(170), law, by=20.0), Move(rad(190), law, by=-20.0)]
    theta = np.arange(count) * (2.0 * math.pi / count)
    cells = []
    for steps in (plate, strokes):
        s = programme(steps, 2.0 * math.pi).derivatives(theta, 0)[0]
        for places in (4,) if count >= MANY else (2, 3, 4):
            rows = Samples(theta, np.round(s, places), np.arange(count) + 1)
            best = math.inf
            for _ in range(max(2, SHORT // count)):  # the first of them imports
                begin = time.process_time()
                from_table(rows, 0.5 * 10.0**-places)
                best = min(best, time.process_time() - begin)
            cells.append(f"{1e3 * best:.3g}")
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0
    half = len(cells) // 2
    return f"| {count} | {', '.join(cells[:half])} | {', '.join(cells[half:])} | {memory:.0f} |"


def main(counts: tuple[int, ...]) -> None:
    """Print the table, each row from a process of its own."""
    print("| rows | with dwells, ms | without, ms | greatest MB |")
    print("| --- | --- | --- | --- |", flush=True)
    for count in counts:
        environment = {**os.environ, "OPENBLAS_NUM_THREADS": "1"}
        subprocess.run([sys.executable, __file__, "--count", str(count)], env=environment, check=True)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--small", action="store_true", help="a small size, to see that it works")
    parser.add_argument("--count", type=int, help="a row for so many rows")
    arguments = parser.parse_args()
    if arguments.count:
        print(measure(arguments.count), flush=True)
    else:
        main((36,) if arguments.small else COUNTS)
