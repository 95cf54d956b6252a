"""What a motion from a table costs: `python benchmarks/tables.py [--small]`.

Processor time without imports, the least of several runs, and the greatest resident memory, for a table of 36, 360,
3,600 and 100,000 rows to two, three and four decimals; one process each, on one thread. The motions are two strokes
with dwells between them, and two without. What is aimed at: 10, 30, 250 ms and 6 s, within 350 MB.
"""

from __future__ import annotations

import math
import time

from counted import peak_mb, table

COUNTS = (36, 360, 3_600, 100_000)
MANY = 100_000  # rows whose last digit of fewer than four is many rows long
SHORT = 20_000  # rows that are read again and again for their least time


def measure(count: int) -> list[str]:
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
    half = len(cells) // 2
    return [", ".join(cells[:half]), ", ".join(cells[half:]), peak_mb()]


if __name__ == "__main__":
    table(str(__doc__), ("rows", "with dwells, ms", "without, ms", "greatest MB"), measure, COUNTS, 36)
