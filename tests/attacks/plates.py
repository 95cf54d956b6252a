# needs: linear
"""Random linear cams, whose drawings are held against rollers set down on points of them by positions alone."""

from __future__ import annotations

import importlib
import math
import sys
from typing import TYPE_CHECKING, Any

import numpy as np
import yaml
from support.places import ROOT

import camgeo
from attacks.outcome import Attack

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path
    from random import Random

    from attacks.outcome import Done

LENGTHS = {"mm": 1.0, "inch": 25.4, "thou": 0.0254}
SHORT = {"mm": "mm", "inch": "in", "thou": "thou"}
HARMS = ("short", "swap", "twice", "late", "word", "slip", "equal", "falling", "key")
OTHER = (
    *(", columns: {column: 2, step: 0.001}", ", columns: {column: 3, step: 1}", ", columns: [1, 1]", ", over: 90"),
    *(", rest: mirror", ", angle: cam", ", scale: -1", ", scale: 0", ", offset: 9", ", reading: 5", ", reading: 1e-9"),
    *(", length: furlong", ", suspect: maybe", ", period: 3", ", points: [[0, 0]]"),
)
PLACES = 41  # of the travel at which the roller is set down
STEP = 2e-4  # rad: of an arc between two points


def slid(rng: Random, number: int) -> Attack:
    """A random plate on a stem or an arm, with ends or without: its drawing moves the roller as intended."""
    benchmarks = str(ROOT / "benchmarks")
    if benchmarks not in sys.path:
        sys.path.append(benchmarks)
    units = rng.choice(["mm", "inch"])
    draw = importlib.import_module("random_recipes").Draw(rng, 25.4 if units == "inch" else 1.0)
    recipe: dict[str, Any] = {"units": units, **draw.plate(groove=False)}
    recipe["cam"].pop("undercut", None)
    recipe["export"]["files"] = [{"dxf": {"as": rng.choice(["arcs", "polyline"])}}]
    text = yaml.safe_dump(recipe, sort_keys=False)

    def judge(done: Done, folder: Path) -> list[str]:
        if done.status:
            return [] if done.status in {1, 2} else [f"verdict: {done.err[:200]}"]
        return wrong(folder, recipe["export"]["tolerance"])

    return Attack(f"plate {number}", ("export", "plate.yaml"), {"plate.yaml": text.encode()}, (0, 1, 2), judge)


def law(rng: Random) -> tuple[float, Callable[[np.ndarray], np.ndarray]]:
    """A travel, mm, and a lift over it that is nowhere at rest at its ends: a parabola, and a wave."""
    travel = float(rng.randrange(40, 160))
    rise, bend, wave = rng.uniform(-10, 10), rng.uniform(-4, 4), rng.uniform(0.0, 3.0)
    turns, level = rng.uniform(0.3, 1.2), rng.choice([0.0, 0.0, rng.uniform(-20, 20)])

    def lift(x: np.ndarray) -> np.ndarray:
        u = x / travel
        return np.asarray(level + rise * u + bend * u * u + wave * np.sin(2.0 * math.pi * turns * u))

    return travel, lift


def rows_of(rng: Random) -> tuple[list[str], str, str, Callable[[np.ndarray], np.ndarray], float]:
    """Rows of such a law, the keys that they need, the recipe's unit, the law, and the reading, mm."""
    travel, lift = law(rng)
    unit, shown, units = rng.choice([*LENGTHS]), rng.choice([*LENGTHS]), rng.choice(["mm", "inch"])
    mm, value = LENGTHS[unit], LENGTHS[shown]
    step, decimals = rng.choice([0.5, 1.0, 2.0, 5.0]), rng.randrange(2, 7) + (1 if shown == "inch" else 0)
    x = np.append(np.arange(0.0, travel, step), travel)
    rows = [f"{at / mm:.9f};{s / value:.{decimals}f}" for at, s in zip(x, lift(x), strict=True)]
    headed, keys = rng.random() < 0.5, []
    if headed:
        rows.insert(0, f"travel_{SHORT[unit]};lift_{SHORT[shown]}")
    else:
        keys += [] if unit == units and rng.random() < 0.5 else [f"length: {unit}"]
        keys += [] if shown == units and rng.random() < 0.5 else [f"units: {shown}"]
    if rng.random() < 0.3:
        keys.append(f"suspect: {rng.choice(['keep', 'drop', 'refuse'])}")
    reading = max(0.5 * 10.0**-decimals * value, 1e-7 * float(np.ptp(lift(x))))
    return rows, "".join(f", {key}" for key in keys), units, lift, reading


def of_a_table(units: str, keys: str, files: str = "dxf") -> str:
    """The recipe of a plate whose motion is a table."""
    mm = 25.4 if units == "inch" else 1.0
    cam = f"kind: linear, base: {40 / mm:.6g}, follower: {{radius: {3 / mm:.6g}}}, ends: {{overrun: {6 / mm:.6g}}}"
    more = f"part: {{thickness: {9 / mm:.6g}}}\nexport: {{tolerance: {0.002 / mm:.6g}, files: [{files}]}}\n"
    return f"units: {units}\ncam: {{{cam}, undercut: trim, motion: {{table: lift.csv{keys}}}}}\n{more}"


def tabled(rng: Random, number: int) -> Attack:
    """A law over a length as a table, in any unit: the motion stays at the rows, and the drawing at the motion."""
    rows, keys, units, lift, reading = rows_of(rng)

    def judge(done: Done, folder: Path) -> list[str]:
        if done.status == 2:
            return [f"verdict: a sound table is refused: {done.err[:300]}"] if "touches" not in done.err else []
        design: Any = camgeo.design(camgeo.load(folder / "plate.yaml"))
        x = np.array([float(row.partition(";")[0]) for row in rows[rows[0].startswith("travel") :]])
        x = np.minimum(design.travel * x / x[-1], design.travel)
        far, most = 0.5 * float(np.ptp(design.motion(x) - lift(x))), 2.0 * reading + 1e-8
        found = [] if far <= most else [f"verdict: {far:.3g} off the table's rows, {most:.3g} at most"]
        lost = design.figures.get("lost-motion")
        return (
            found
            if done.status or (lost is not None and lost.value)
            else found + wrong(folder, 0.002 / design.recipe.mm)
        )

    files = {"plate.yaml": of_a_table(units, keys).encode(), "lift.csv": "\n".join(rows).encode()}
    return Attack(f"plate's table {number}", ("export", "plate.yaml"), files, (0, 1, 2), judge)


def mangled(rng: Random, number: int) -> Attack:
    """Such a table with something wrong: refused with one error, or followed, and never a traceback."""
    rows, keys, units, _, _ = rows_of(rng)
    harm, i = rng.choice(HARMS), rng.randrange(2, len(rows) - 2)
    match harm:
        case "short":
            rows = rows[: rng.randrange(4)]
        case "swap":
            rows[i], rows[i + 1] = rows[i + 1], rows[i]
        case "twice":
            rows.insert(i, rows[i].partition(";")[0] + ";0")
        case "late":
            del rows[1:i]
        case "word":
            rows[i] = rng.choice(["a;b", ";", "1;nan", "inf;0", "1e300;1", "3;1e9"])
        case "slip":
            place, _, value = rows[i].partition(";")
            rows[i] = f"{place};{float(value) + rng.choice([-1.0, 0.1, 5.0]):.4f}"
        case "equal":
            rows = [rows[0], *(f"{row.partition(';')[0]};1.5" for row in rows[1:])]
        case "falling":
            rows = [*rows[:1], *rows[:0:-1]]
        case _:
            keys += rng.choice(OTHER)
    text = of_a_table(units, keys, "csv")
    if rng.random() < 0.2:
        text = (
            text.replace("ends:", "endless: true, x:", 1) if rng.random() < 0.5 else text.replace("table", "tabel", 1)
        )
    files = {"plate.yaml": text.encode(), "lift.csv": "\n".join(rows).encode()}
    return Attack(f"mangled plate's table {number}, {harm}", ("check", "plate.yaml", "--json"), files, (0, 1, 2))


def wrong(folder: Path, tolerance: float) -> list[str]:
    """What is wrong of the motion that the drawing gives, over some places of the travel."""
    recipe: Any = camgeo.load(folder / "plate.yaml")
    design: Any = camgeo.design(recipe)
    step = 0.2 * math.sqrt(recipe.follower.radius * tolerance * recipe.mm)  # the roller sinks by 0.5 % of it between
    points = flank(folder / "out" / "plate" / "plate.dxf", step / recipe.mm) * recipe.mm
    if recipe.travel == "right":
        points[:, 0] *= -1.0
    span = design.travel
    u = np.linspace(0.0, span, PLACES)
    periods = 1 if recipe.ends is not None else 3
    tiled = np.concatenate([points + np.array([k * span * recipe.periods, 0.0]) for k in range(-periods, periods + 1)])
    found = lifts(recipe, points if periods == 1 else tiled, u)
    off = np.abs(found - design.motion(u))
    lever = recipe.follower.arm.length if recipe.swings else 1.0
    most = tolerance * recipe.mm / lever / math.cos(math.radians(design.figures["pressure-angle"].value))
    worst = float(off.max())
    return [] if worst <= 1.02 * most + 1e-6 / lever else [f"verdict: off by {worst:.3g}, {most:.3g} is allowed"]


def flank(path: Path, step: float) -> np.ndarray:
    """Points (n, 2) of the closed outline on CUT, `step` apart at most and on arcs STEP, in the drawing's unit."""
    import ezdxf

    polyline: Any
    (polyline,) = ezdxf.readfile(path).modelspace().query('LWPOLYLINE[layer=="CUT"]')
    rows = np.array(polyline.get_points("xyb"))
    found = []
    for (x, y, bulge), (far_x, far_y, _) in zip(rows, np.roll(rows, -1, axis=0), strict=True):
        start, chord = np.array([x, y]), np.array([far_x - x, far_y - y])
        sweep = 4.0 * math.atan(bulge)
        count = max(math.ceil(abs(sweep) / STEP), math.ceil(math.hypot(*chord) / step), 200)
        share = np.arange(count) / count
        if abs(sweep) < 1e-9:
            found.append(start + share[:, None] * chord)
            continue
        radius = math.hypot(*chord) / (2.0 * math.sin(0.5 * sweep))
        middle = 0.5 * (start + start + chord) + np.array([-chord[1], chord[0]]) * 0.5 / math.tan(0.5 * sweep)
        begin = math.atan2(*(start - middle)[::-1])
        angle = begin + sweep * share
        found.append(middle + abs(radius) * np.column_stack([np.cos(angle), np.sin(angle)]))
    return np.concatenate(found)


def lifts(recipe: Any, points: np.ndarray, u: np.ndarray) -> np.ndarray:
    """Lift (n,), mm or rad, of the roller set down on points (m, 2), mm, at places u (n,) of a plate to the left."""
    radius, arm = recipe.follower.radius, recipe.follower.arm
    found = []
    for place in u:
        rel = points - [place, recipe.pitch]
        if arm is None:
            way = np.array([-math.sin(recipe.follower.lean), math.cos(recipe.follower.lean)])
            across, along = rel @ [way[1], -way[0]], rel @ way
            near = np.abs(across) < radius
            found.append((along[near] + np.sqrt(radius**2 - across[near] ** 2)).max())
            continue
        side = 1.0 if arm.side == "trailing" else -1.0
        apart = points - [place, arm.pivot]
        far, angle = np.hypot(*apart.T), np.arctan2(apart[:, 1], -side * apart[:, 0])
        cosine = (arm.length**2 + far**2 - radius**2) / (2.0 * arm.length * far)
        near = np.abs(cosine) <= 1.0
        psi = angle[near] + np.arccos(cosine[near])
        found.append(psi[psi < 0.5 * math.pi].max() - recipe.rest)  # beyond, the arm would come from the other side
    return np.array(found)
