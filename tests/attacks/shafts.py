"""Camshafts of bodies that meet face to face, in tenths of a millimetre, and of gaps too thin to be told."""

from __future__ import annotations

from typing import TYPE_CHECKING

from attacks.outcome import Attack

if TYPE_CHECKING:
    from pathlib import Path
    from random import Random

    from attacks.outcome import Done

LOBE = b"""\
cam:
  kind: disc
  base_radius: 18
  follower: {kind: roller, radius: 8}
  motion: [{rise: 6, over: 90, law: cycloidal}, {return: 6, over: 90, law: cycloidal}, {dwell: 180}]
"""
THIN = (1e-7, 1e-4, 0.009)  # mm, below the tolerance


def flush(rng: Random, number: int) -> Attack:
    """Lobes and journals one on the other: right as they stand, and refused where one gap is too thin."""
    z = rng.randrange(0, 30)  # tenths of a millimetre
    thin = rng.choice(THIN) if rng.random() < 0.3 else 0.0
    angles = rng.choice([(0,), (0, 90), (0, 0, 360), (0, 17)])
    lobes, journals = [], []
    for k in range(rng.randrange(2, 7)):
        long = rng.randrange(1, 150)
        place = f"z: {z / 10 + (thin if k == 1 else 0.0):.9g}, length: {long / 10}"
        if rng.random() < 0.7 or not lobes:
            lobes.append(f"    - {{recipe: lobe.yaml, at: {rng.choice(angles)}, {place}}}\n")
        else:
            journals.append(f"    - {{{place}, diameter: {rng.choice([30, 50])}}}\n")
        z += long
        if k == 1 and thin:
            z += 10  # room for what the thin gap moves
    end = z / 10 + rng.choice([0, 1 if thin else 0, 5])
    rows = f"  lobes:\n{''.join(lobes)}" + (f"  journals:\n{''.join(journals)}" if journals else "")
    kind = rng.choice(["stl", "3mf"])
    text = f"camshaft:\n  shaft: {{diameter: 26, to: {end}}}\n{rows}export: {{tolerance: 0.01, files: [{kind}]}}\n"
    text += "verify: {angles: 60}\n"

    def judge(done: Done, _: Path) -> list[str]:
        if thin:
            return [] if done.status == 2 and "too thin" in done.err else [f"verdict: a gap of {thin} mm: {done.err}"]
        return [] if done.status == 0 else [f"verdict: bodies that meet are refused: {done.out}{done.err}"[:400]]

    files = {"shaft.yaml": text.encode(), "lobe.yaml": LOBE}
    return Attack(f"shaft {number}", ("check", "shaft.yaml"), files, statuses=(2,) if thin else (0,), judge=judge)
