# needs: camshaft, made
"""Points of camshafts by chance: columns, lobes that are turned, swapped or missing, shafts that are another's."""

from __future__ import annotations

import tempfile
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from support.measured import bump
from support.shafts import Planted, camshaft, shaft_points

from attacks.outcome import Attack

if TYPE_CHECKING:
    from random import Random

    from attacks.outcome import Done

Row = tuple[str, float, float, float]
LIMITS = ("", "made: {profile: 0.05}\n", "limits: {duration: [{at_lift: 1, at_least: 1}, {at_lift: 7, at_least: 1}]}\n")
OPTIONS = (
    ["--align", "rotation"],
    ["--align", "best-fit"],
    ["--probe-error", "0.002"],
    ["--axes-error", "0.005,0.02"],
    ["--probe-radius", "1"],
    ["--spans", "12"],
    ["--units", "inch"],
    ["--out", "out"],
    ["--json"],
    ["-v"],
)
SOUND = ("lobe,z_mm,x_mm,y_mm", "z_mm,x_mm,y_mm", "lobe,x_mm,y_mm")
COLUMNS = (*SOUND, *SOUND, "x_mm,y_mm", "z,x,y", "lobe,x,y", "lobe,z,x")
HARMS = (
    *[""] * 14,
    "mirror",
    "end",
    "swap",
    "one",
    "few",
    "turn",
    "shift",
    "unknown",
    "word",
    "inch",
    "ecc",
    "lean",
    "lifts",
)


@cache
def _made(late: float, height: float, noise: float, more: str) -> tuple[dict[str, bytes], list[Row]]:
    """Recipes of a shaft, and points of it with a fault."""
    with tempfile.TemporaryDirectory() as folder:
        recipe = camshaft(Path(folder), more=more)
        planted = {"roller": Planted(late=late), "arm": Planted(deviation=bump(height))}
        rows = shaft_points(recipe, planted, noise=noise, count=72)
        return {path.name: path.read_bytes() for path in Path(folder).iterdir()}, rows


def _harmed(rng: Random, rows: list[Row], harm: str) -> list[Row]:
    turn = np.exp(1j * rng.uniform(-3.0, 3.0))
    altered = []
    for name, z, x, y in rows:
        place = complex(x, y)
        match harm:
            case "mirror":
                altered.append((name, z, x, -y))
            case "end":
                altered.append((name, 92.0 - z, x, -y))
            case "swap":
                altered.append(({"flat": "arm", "arm": "flat"}.get(name, name), z, x, y))
            case "turn":
                altered.append((name, z, (place * turn).real, (place * turn).imag))
            case "shift":
                altered.append((name, z + 11.0, x, y))
            case "inch":
                altered.append((name, z / 25.4, x / 25.4, y / 25.4))
            case "ecc":
                altered.append((name, z, x + 2.0, y))
            case "lean":
                altered.append((name, z, x + 1e-3 * z, y - 5e-4 * z))
            case "unknown":
                altered.append((f"{name}2", z, x, y))
            case _:
                altered.append((name, z, x, y))
    if harm == "one":
        return [row for row in altered if row[0] == "arm"]
    return altered[:100] if harm == "few" else altered


def of_a_shaft(rng: Random, number: int) -> Attack:
    """Points of a shaft, right or wrong; wrong ones are told in one line."""
    late, height = rng.choice([(0.0, 0.0), (0.1, 0.01), (3.0, 0.0), (-40.0, 0.05)])
    recipes, rows = _made(late, height, rng.choice([0.0, 0.001]), rng.choice(["", "rotation: ccw\n"]))
    harm, columns = rng.choice(HARMS), rng.choice(COLUMNS)
    rows = _harmed(rng, rows, harm)
    if harm == "lifts":
        columns = rng.choice(["lobe,angle_deg,lift_mm", "lobe,crank_deg,lift_mm", "lobe,cam_deg,lift_rad"])
    rng.shuffle(rows)
    numbers = {"flat": "1", "roller": "2", "arm": "3"} if rng.random() < 0.3 else {}
    known = ("lobe", "z", "x", "y")
    plain = [name.removesuffix("_mm") for name in columns.split(",")]
    chosen = [known.index(name) if name in known else 2 for name in plain]
    lines = [
        ",".join(numbers.get(str(row[k]), str(row[k])) if k == 0 else f"{row[k]:.7f}" for k in chosen) for row in rows
    ]
    if harm == "word":
        lines[rng.randrange(len(lines))] = rng.choice(["foo", "nan,nan,nan,nan", "1,2", "1e300,1e300,1e300,1"])
    options = rng.sample(OPTIONS, rng.randrange(3))
    words = ["verify", "shaft.yaml", "points.csv", *(word for option in options for word in option)]
    files = {**recipes, "points.csv": "\n".join([columns, *lines]).encode()}
    files["flat.yaml"] += rng.choice(LIMITS).encode()

    def judge(done: Done, _: Path) -> list[str]:
        told = [line for line in done.err.splitlines() if not line.endswith(" ...")]
        if done.status == 2 and len(told) != 1:
            return [f"lines: {len(told)} lines of complaint"]
        sound = not harm and not late and columns in SOUND and not options
        return [f"verdict: sound points ended with {done.status}"] if sound and done.status != 0 else []

    return Attack(f"shaft points {number}", tuple(words), files, judge=judge)
