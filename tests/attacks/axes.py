# needs: axis
"""Random motions of an axis: its table is within what the report says, found from the rows and laws alone."""

from __future__ import annotations

import csv
import json
import math
from typing import TYPE_CHECKING

import numpy as np
from support.brute_disc import LAWS, motion

from attacks.outcome import Attack

if TYPE_CHECKING:
    from pathlib import Path
    from random import Random

    from attacks.outcome import Done

CONTROLLERS = (
    "codesys",
    "codesys-table",
    "twincat",
    "twincat-table",
    "rockwell",
    "rockwell-linear",
    "siemens",
    "plain",
)
PLACES = 4001  # of a turn at which lines are looked at
WRONG = (
    *("index: maybe", "modulo: -1", "rpm: .nan", "kind: round", "modulo: 1e300", "motion: []", "indx: true"),
    *("motion: {formula: t**}", "motion: {formula: 1/t}", "motion: {points: [[0, 0], [0, 1]]}", "axis: {}"),
)


def driven(rng: Random, number: int) -> Attack:
    """A random axis, its table and its motion in time: rows and what lines make of them are the motion."""
    rotary, index = rng.random() < 0.5, rng.random() < 0.5
    laws, first = sorted(LAWS), rng.randrange(30, 150)
    rise, law = rng.choice([0.5, 12.0, 45.0, 360 / 7, 400.0]), rng.choice(laws)
    rows = [(rise, float(first), law), (0.0, 60.0, "")]
    rows += [(0.0, 300.0 - first, "")] if index else [(-rise, 200.0 - first, rng.choice(laws)), (0.0, 100.0, "")]
    words = [
        f"{{dwell: {over!r}}}"
        if not by
        else f"{{{'rise' if by > 0 else 'return'}: {abs(by)!r}, over: {over!r}, law: {law}}}"
        for by, over, law in rows
    ]
    options = f"as: controller, for: {rng.choice(CONTROLLERS)}"
    options += rng.choice(
        ["", "", ", joints: true", ", step: 1", ", step: 0.01", ", tolerance: 1e-7", ", velocity_error: 1"]
    )
    keys = f"rpm: {rng.choice([0.01, 60, 3000, 1e6])}, kind: {'rotary' if rotary else 'linear'}"
    keys += f", index: {str(index).lower()}" + rng.choice(["", ", modulo: 360", ", modulo: 0.7"])
    text = f"axis: {{{keys}, motion: [{', '.join(words)}]}}\n"
    text += f"limits: {{velocity: {{at_most: {rng.choice([1, 1e9])}}}}}\n" if rng.random() < 0.3 else ""
    text += f"export: {{tolerance: 0.01, files: [{{csv: {{{options}}}}}, csv]}}\n"

    def judge(done: Done, folder: Path) -> list[str]:
        if done.status:
            return []
        made = folder / "out" / "axis"
        report = json.loads((made / "report.json").read_text(encoding="utf-8"))
        worst = next(check["value"] for check in report["checks"] if check["name"] == "interpolation")
        return wrong(
            made / "axis.csv", rows, worst, lines="table" in options or "linear" in options or "siemens" in options
        )

    return Attack(
        f"axis {number}", ("export", "axis.yaml"), {"axis.yaml": text.encode()}, (0, 1, 2), judge, seconds=15.0
    )


def wrong(path: Path, rows: list[tuple[float, float, str]], worst: float, *, lines: bool) -> list[str]:
    """Complaints on a table: rows off the motion, or lines farther off than the report says, or nearer everywhere."""
    text = [line for line in path.read_text(encoding="utf-8").splitlines() if not line.startswith("#")]
    table = list(csv.DictReader(text))
    master, slave = (
        np.array([float(next(row[key] for key in row if key.lower().startswith(word))) for row in table])
        for word in ("master", "slave")
    )
    size = max(abs(by) for by, _, _ in rows)
    master, slave = master[:-1], slave[:-1]  # at the end of the turn the motion here begins anew
    off = float(np.abs(slave - motion(rows, master)).max())
    told = [] if off <= 1e-6 * size else [f"axis: a row is off by {off:.3g}"]
    if lines:
        angles = np.linspace(0.0, float(master[-1]), PLACES)
        between = float(np.abs(np.interp(angles, master, slave) - motion(rows, angles)).max())
        if not (between <= worst * (1 + 1e-6) + 1e-6 * size and math.isfinite(worst)):
            told.append(f"axis: {worst:.3g} is said, {between:.3g} is found")
    return told


def misdriven(rng: Random, number: int) -> Attack:
    """A recipe of an axis with one wrong line: refused with its place, or made; never a traceback."""
    lines = ["  rpm: 60", "  index: true", "  motion: [{rise: 45, over: 150, law: cycloidal}, {dwell: 210}]"]
    lines[rng.randrange(len(lines))] = f"  {rng.choice(WRONG)}"
    text = "axis:\n" + "\n".join(lines) + "\nexport: {files: [{csv: {as: controller, for: rockwell}}, html]}\n"
    return Attack(f"axis's recipe {number}", ("check", "axis.yaml"), {"axis.yaml": text.encode()}, statuses=(0, 1, 2))
