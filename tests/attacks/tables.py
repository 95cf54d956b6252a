"""Tables of all kinds: laws at any step, digits and unit, with columns, scales and faults; drawings as motions."""

from __future__ import annotations

import math
import re
from typing import TYPE_CHECKING

import numpy as np
from support.brute_disc import motion

from attacks.cams import SHARE, drawn, reported
from attacks.outcome import Attack

if TYPE_CHECKING:
    from pathlib import Path
    from random import Random

    from attacks.cams import Cam
    from attacks.outcome import Done

SMOOTH = ("cycloidal", "polynomial-345", "polynomial-4567")
UNITS = {"mm": 1.0, "inch": 25.4, "thou": 0.0254}
ANGLES = {"cam": 360.0, "crank": 720.0, "radians": 2 * math.pi, "turns": 1.0, "percent": 100.0}
HARMS = (
    *("cut", "twice", "swap", "word", "big", "gap", "empty", "wide", "constant", "same", "noise", "nan", "headed"),
    *("count", "comment", "units", "bars", "short", "alone", "exponents"),
)
SUFFIXES = {"mm": "_mm", "inch": "_in", "thou": "_thou"}


def with_motion(text: str, given: str) -> str:
    """The recipe with another motion."""
    return re.sub(r"motion: \[.*\]\}", lambda _: f"motion: {given}}}", text, count=1)


def on_a_stem(rng: Random) -> Cam:
    """A cam by chance whose follower is led on a line, with smooth laws."""
    while True:
        cam = drawn(rng)
        if not cam.touching.sense and all(law in {*SMOOTH, ""} for _, _, law in cam.rows):
            return cam


def tabled(rng: Random, number: int) -> Attack:
    """A law as a table, rounded to its last digit; the motion felt on the drawing stays at the rows."""
    cam = on_a_stem(rng)
    step, decimals = rng.choice([1, 2, 3, 5, 10, 15]), rng.randrange(1, 5)
    unit, angle = rng.choice([*UNITS]), rng.choice([*ANGLES])
    decimals += {"mm": 0, "inch": 1, "thou": -1}[unit]
    degrees = np.arange(0.0, 360.0, step)
    if rng.random() < 0.2:  # uneven steps
        degrees[1:] += np.array([round(rng.uniform(-0.3, 0.3) * step, 1) for _ in degrees[1:]])
    lifts = motion(list(cam.rows), degrees) / UNITS[unit]
    scale = rng.choice([1.0, 1.0, 1.6, 0.5])
    several, headed = rng.random() < 0.3, rng.random() < 0.5
    names = ["deg" if angle == "cam" else f"phi_{angle}" if angle != "radians" else "phi_rad", f"lift{SUFFIXES[unit]}"]
    head = [names[0], "other", names[1]] if several else names
    mark = rng.choice([";", "\t", ", "])
    lines = [mark.join(head)] if headed else []
    for value, lift in zip(degrees * ANGLES[angle] / 360.0, lifts / scale, strict=True):
        cells = [f"{value:.9g}", *(["7"] if several else []), f"{lift:.{decimals}f}"]
        lines.append(mark.join(cells))
    digit = 10.0**-decimals * scale * UNITS[unit]
    keys = [f"scale: {scale}"] if scale != 1.0 else []
    keys += [f"columns: [1, {3 if several else 2}]"] if several else []
    keys += [] if headed else [f"angle: {angle}", f"units: {unit}"]
    keys += ["reading: auto"] if rng.random() < 0.3 else []
    text = with_motion(cam.text("{dxf: {as: arcs}}"), f"{{table: table.csv{''.join(f', {key}' for key in keys)}}}")

    def judge(done: Done, folder: Path) -> list[str]:
        report = reported(done)
        if done.status or report is None:
            refused = [word for word in ("stated", "does not close", "rounding stands", "column") if word in done.err]
            return [f"verdict: a sound table is refused: {done.err[:300]}"] if refused else []
        if step > 2 or digit > 0.05:  # between rows far apart, or of few digits, nothing is said
            return []
        limit = next(check["limit"] for check in report["checks"] if check["name"] == "motion")
        off, most = cam.error(folder / "out" / "cam" / "cam.dxf"), digit + limit + 0.2 * digit
        return (
            [] if off <= SHARE * most + cam.margin else [f"verdict: {off:.6g} off the table's law, {most:.6g} at most"]
        )

    files = {"cam.yaml": text.encode(), "table.csv": "\n".join(lines).encode()}
    return Attack(f"table {number}", ("export", "cam.yaml", "--json"), files, (0, 1, 2), judge)


def mangled(rng: Random, number: int) -> Attack:
    """A table with something wrong: refused with one error, or followed, and never a traceback."""
    cam = on_a_stem(rng)
    degrees = np.arange(0.0, 360.0, rng.choice([2, 5, 10, 20]))
    rows = [f"{a:g};{s:.3f}" for a, s in zip(degrees, motion(list(cam.rows), degrees), strict=True)]
    i = rng.randrange(len(rows))
    harm = rng.choice(HARMS)
    if harm == "cut":
        rows = rows[: i + 1]
    elif harm == "twice":
        rows.insert(i, rows[i])
    elif harm == "swap":
        rows[i], rows[i - 1] = rows[i - 1], rows[i]
    elif harm in {"word", "big", "nan"}:
        rows[i] = f"{degrees[i]:g};{ {'word': 'x', 'big': '1e300', 'nan': 'nan'}[harm] }"
    elif harm == "gap":
        del rows[i : i + rng.randrange(1, 9)]
    elif harm == "empty":
        rows = rows[:0]
    elif harm == "wide":
        rows[i] += ";1;2"
    elif harm == "constant":
        rows = [f"{a:g};0.000" for a in degrees]
    elif harm == "same":
        rows = [rows[i]] * 5
    elif harm == "noise":
        rows = [f"{a:g};{rng.uniform(0, 5):.3f}" for a in degrees]
    elif harm == "count":
        rows.insert(0, str(len(rows) + rng.randrange(-1, 2)))
    elif harm == "comment":
        rows[i] += rng.choice([" # note", "  // note", ";note", " ! note;1"])
    elif harm == "units":
        rows = [
            row.replace(";", rng.choice([" deg;", " rad;", ";"])) + rng.choice([" mm", "mm", " in"]) for row in rows
        ]
    elif harm == "bars":
        rows = ["| deg | lift |", "|---|---|", *(f"| {row.replace(';', ' | ')} |" for row in rows)]
    elif harm == "short":
        rows = [f"{row};{row}" if k < i else rng.choice([f"{row};", f"{row};;", row]) for k, row in enumerate(rows)]
    elif harm == "alone":
        rows = [row.partition(";")[2] for row in rows]
    elif harm == "exponents":
        rows = [f"{row}{rng.choice(['D+00', 'd0', 'e0', 'D', 'E-1'])}" for row in rows]
    elif harm == "headed":
        rows = rng.sample(["sep=;", "Cam 7", "deg;lift", "[deg];[mm]", ";mm", "x;1"], rng.randrange(1, 4)) + rows
    keys = [
        f"reading: {rng.choice(['1e-12', '0.001', '0.5', '100', 'auto', '0', '-1'])}",
        f"angle: {rng.choice(['cam', 'crank', 'radians', 'turns', 'percent', 'seconds', 'grad'])}",
        f"period: {rng.choice(['360', '0.5', '0', '1e-9'])}",
        f"columns: {rng.choice(['[1, 2]', '[2, 1]', '[3, 4]', '[1, 9]', '[deg, lift]', '2', '[]'])}",
        f"columns: {{column: {rng.choice([1, 2, 'lift'])}, step: {rng.choice([2, 5, 720, 0])}}}",
        f"scale: {rng.choice(['1e-9', '-1', '0', '1e6', 'x'])}",
        f"offset: {rng.choice(['3', '-3', '1e6'])}",
        f"rest: {rng.choice(['dwell', 'cycle', 'mirror', 'none'])}",
        f"suspect: {rng.choice(['keep', 'drop', 'refuse'])}",
        f"units: {rng.choice([*UNITS, 'yards'])}",
    ]
    drawn_keys = {key.partition(":")[0]: key for key in rng.sample(keys, rng.randrange(4))}
    chosen = "".join(f", {key}" for key in drawn_keys.values())
    text = with_motion(cam.text("csv"), f"{{table: table.csv{chosen}}}")
    files = {"cam.yaml": text.encode(), "table.csv": "\n".join(rows).encode()}
    return Attack(f"mangled table {number}, {harm}", ("check", "cam.yaml", "--json"), files, (0, 1, 2))


def redrawn(rng: Random, number: int) -> Attack:
    """A recipe whose motion is a contour that is none, a drawing of nothing about the shaft, or points of any kind."""
    cam = on_a_stem(rng)
    name = rng.choice(["old.svg", "missing.svg", "old.dxf", "old.csv", "old.csv"])
    radius, x = round(rng.uniform(1.0, 60.0), 3), round(rng.choice([0.0, rng.uniform(-80.0, 80.0)]), 3)
    circle = f'<circle cx="{x}" cy="0" r="{radius}"/>' if name == "old.svg" else ""
    svg = f'<svg xmlns="http://www.w3.org/2000/svg" width="99mm" height="99mm" viewBox="-50 -50 99 99">{circle}</svg>'
    keys = [f"reading: {rng.choice(['0.02', '1e-9', 'auto', '5'])}"]
    keys += [f"curve: {rng.choice(['cam', 'pitch', 'none'])}"] if rng.random() < 0.5 else []
    keys += [f"units: {rng.choice([*UNITS])}"] if rng.random() < 0.2 else []
    more = ["across: arc", "across: chord", "mirror: x", "mirror: y", "turn: -30", "turn: 1e9", "gap: 0.01", "gap: 0"]
    keys += rng.sample(more, rng.choice([0, 0, 1, 2]))
    text = with_motion(cam.text("csv"), f"{{contour: {name}, {', '.join(keys)}}}")
    points = round_the_shaft(rng, radius, x)
    files = {"cam.yaml": text.encode(), "old.svg": svg.encode(), "old.dxf": b"0\nEOF\n", "old.csv": points.encode()}
    return Attack(f"contour {number}", ("check", "cam.yaml", "--json"), files, (0, 1, 2))


def round_the_shaft(rng: Random, radius: float, x: float) -> str:
    """Points of a lobed contour about a place, or of none: out of order, doubled, few, with a word, as lifts."""
    count, waves, height = rng.choice([20, 36, 90, 360, 1000]), rng.randrange(1, 6), rng.uniform(0.0, 0.4)
    places = []
    for k in range(count):
        angle = 2.0 * math.pi * k / count
        r = radius * (1.0 + height * math.cos(waves * angle))
        places.append((x + r * math.cos(angle), r * math.sin(angle)))
    harm = rng.choice(["", "", "shuffled", "doubled", "again", "word", "lifts", "backwards", "hole"])
    if harm == "shuffled":
        rng.shuffle(places)
    elif harm == "doubled":
        places = [place for place in places for _ in (0, 1)]
    elif harm == "again":
        places *= 2
    elif harm == "backwards":
        places.reverse()
    elif harm == "hole":
        places = places[: -rng.randrange(1, count)]
    rows = [f"{a:.{rng.randrange(2, 6)}f},{b:.4f}" for a, b in places]
    if harm == "word":
        rows[rng.randrange(len(rows))] = "x,1"
    lifts = ["angle_deg,lift", "crank_deg,lift", "angle_rad,lift_rad"]
    heading = rng.choice(lifts if harm == "lifts" else ["x,y", "X [mm],Y [mm]", "x_in,y_in", "X pos,Y pos", ""])
    return "\n".join([heading, *rows] if heading else rows)
