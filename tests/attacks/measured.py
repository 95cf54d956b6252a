"""Measured points by chance: formats, placings, noise, faults of parts and of files, options."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING, Any

import numpy as np
from support.measured import RECIPES, bump, nothing, points, surfaces, table, turned

from attacks.outcome import Attack
from kin.read.files import read_drawing

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path
    from random import Random

    from attacks.outcome import Done
    from kin.numeric.arrays import Array

KINDS = (
    "roller on a stem",
    "roller on a trailing arm",
    "ring",
    "groove",
    "flat",
    "tilted flat",
    "flat on an arm",
    "knife edge on a stem",
    "double roller",
)
HARMS = (
    "",
    "",
    "",
    "cut",
    "word",
    "nan",
    "big",
    "columns",
    "mirror",
    "turn",
    "inch",
    "shift",
    "gap",
    "one",
    "swap",
    "constant",
)
LONG = 60.0  # seconds: several discs, each fitted and judged
CORNERED = (
    "yoke"  # its radius of curvature jumps, where a correction leaves a corner: no spline has it, no face may reach
)
OPTIONS = (
    ["--align", "rotation"],
    ["--align", "best-fit"],
    ["--probe-error", "0.002"],
    ["--probe-radius", "1"],
    ["--axes-error", "0.005,0.02"],
    ["--axes-error", "x"],
    ["--spans", "36"],
    ["--spans", "9999"],
    ["--units", "inch"],
    ["--as", "grinding"],
    ["--as", "measured"],
    ["--out", "out"],
    ["--out", "cam.yaml"],
    ["--probe-face", "20"],
    ["--probe-face", "0"],
    ["-v"],
    ["--json"],
)


@cache
def _surfaces(kind: str) -> tuple[tuple[int, Any, Any], ...]:
    return surfaces(RECIPES[kind])


def probed(rng: Random, number: int) -> Attack:
    """Points of a cam, right or wrong, in a file of some form; a sound part without options is never failed."""
    kind = rng.choice(KINDS)
    count = rng.choice([36, 48, 72, 180, 360, 720])
    deviation = rng.choice([nothing, bump(0.01), bump(-0.02, 2.0), bump(0.3, 20.0)])
    places = np.concatenate(
        [points(part, one, deviation, rng.choice([0.0, 0.001]), count) for _, part, one in _surfaces(kind)]
    )
    harm = rng.choice(HARMS)
    if harm == "mirror":
        places = places * [1.0, -1.0]
    elif harm == "turn":
        places = turned(places, rng.uniform(-180.0, 180.0))
    elif harm == "inch":
        places /= 25.4
    elif harm == "shift":
        places = places + np.array([rng.uniform(-5.0, 5.0), 1.0])
    elif harm == "gap":
        places = places[: max(36, len(places) * 2 // 3)]
    elif harm == "constant":
        places = np.full_like(places, 40.0)
    elif harm == "one":
        places = places[:1]
    if rng.random() < 0.3:
        places = places[np.random.default_rng(number).permutation(len(places))]
    mark = rng.choice([",", ";", "\t", " "])
    head = rng.choice(["x_mm,y_mm", "X [mm],Y [mm]", "x,y", ""]).replace(",", mark)
    lines = [mark.join(f"{value:.6f}" for value in row) for row in places]
    if mark != "," and rng.random() < 0.3:
        lines = [line.replace(".", ",") for line in lines]
    at = rng.randrange(len(lines))
    if harm == "cut":
        lines[at] = lines[at][: len(lines[at]) // 3]
    elif harm in {"word", "nan", "big"}:
        lines[at] = mark.join(["1", {"word": "foo", "nan": "nan", "big": "1e300"}[harm]])
    elif harm == "columns":
        lines = [f"{line}{mark}1" for line in lines]
    elif harm == "swap":
        head = mark.join(["y", "x"])
    text = "\n".join([*([head] if head else []), *lines])
    name = f"points{rng.choice(['.csv', '.txt', '.xyz', '.asc', '.dmo'])}"
    words = ["verify", "cam.yaml", name]
    chosen = rng.sample(OPTIONS, rng.randrange(3))
    words += [word for option in chosen for word in option]
    recipe = RECIPES[kind] + rng.choice(["", "\nmade: {profile: 0.05}", "\nmade: {profile: 0.05, datum: none}"])
    if rng.random() < 0.5:
        return rng.choice([_corrected, _started])(rng, number, kind, (name, text))

    def judge(done: Done, _: Path) -> list[str]:
        # a stage that a busy machine takes long for is said too
        lines = [line for line in done.err.splitlines() if not line.endswith(" ...")]
        if done.status == 2 and len(lines) != 1 and "error: argument" not in done.err:
            return [f"lines: {len(lines)} lines of complaint"]
        return []

    return Attack(f"points {number}", tuple(words), {"cam.yaml": recipe.encode(), name: text.encode()}, judge=judge)


# needs: camshaft
def of_a_shaft(rng: Random, number: int) -> Attack:
    """Points of a camshaft."""
    from attacks import shaft_points

    return shaft_points.of_a_shaft(rng, number)


def _corrected(rng: Random, number: int, kind: str, file: tuple[str, str]) -> Attack:
    """An export that is corrected by points as those of an earlier run."""
    name, text = file
    plain = rng.choice(["dxf", "svg", "{dxf: {as: arcs, kerf: 0.1}}", "{svg: {correct: 0}}"])
    share = rng.choice(["0.8", "1", "1.5", "-1", "2", "half"])
    local = rng.choice(["", "", ", local: take", ", local: leave", ", local: some"])
    run = rng.choice([name, f"[{name}, {name}]", f"{{file: {name}, align: rotation}}", "no.csv", "[]"])
    recipe = RECIPES[kind].partition("\nexport:")[0]
    recipe += (
        f"\nmade: {{points: [{run}]}}\nexport: {{files: [{plain}, {{dxf: {{as: arcs, correct: {share}{local}}}}}]}}\n"
    )
    return Attack(f"corrected {number}", ("export", "cam.yaml"), {"cam.yaml": recipe.encode(), name: text.encode()})


def corrected(rng: Random, number: int) -> Attack:
    """A sound export of any kind, corrected by sound points of runs: it holds, and lies where the sum says."""
    kind = rng.choice([kind for kind in RECIPES if kind != CORNERED])
    share, text = round(rng.uniform(0.0, 1.5), rng.choice([0, 1, 4])), RECIPES[kind].partition("\nexport:")[0]
    waves, phase, high = rng.choice([1, 2, 3, 5]), rng.uniform(0.0, 6.0), rng.uniform(0.001, 0.015)

    def off(t: Array) -> Array:
        wave: Array = high * np.cos(waves * t - phase)
        return wave

    def off_by(factor: float) -> Callable[[Array], Array]:
        return lambda t: factor * off(t)

    runs = [1.0] if rng.random() < 0.5 else [0.75, 0.25]
    files: dict[str, bytes] = {}
    for run, part_of_it in enumerate(runs):
        rows: dict[int, list[Array]] = {}
        for disc, part, one in _surfaces(kind):
            rows.setdefault(disc, []).append(points(part, one, off_by(part_of_it), 0.0003))
        for disc, places in rows.items():
            files[f"run{run}-{disc + 1}.csv"] = table(np.concatenate(places)).encode()
    listed = ", ".join(
        f"[{', '.join(name for name in files if name.startswith(f'run{run}-'))}]" for run in range(len(runs))
    )
    form = rng.choice(["dxf: {as: arcs, ", "dxf: {as: spline, ", "svg: {"])
    text += f"\nmade: {{points: [{listed}]}}\nexport: {{files: [{{{form}correct: {share}}}}}]}}\n"

    def judge(done: Done, folder: Path) -> list[str]:
        if done.status != 0:
            return [f"verdict: {done.status} of a sound correction of {kind} by {share}"]
        surfaces_of = _surfaces(kind)
        if len(surfaces_of) > 1:
            return []
        ((_, part, one),) = surfaces_of
        (file,) = [*(folder / "out").rglob("*.dxf"), *(folder / "out").rglob("*.svg")]
        mirror = np.array([1.0, -1.0 if part.mirrored else 1.0])
        worst = np.inf
        for chain in read_drawing(file).chains:  # the contour is one of them
            feet = one.gauge.envelope.feet(chain.contour.sample(4) * mirror)
            worst = min(worst, float(np.abs(one.side * feet.excess + share * off(feet.parameter)).max()))
        return [f"contour: {worst:.4g} mm from where the sum says"] if worst > 0.003 else []

    return Attack(
        f"corrected {kind} {number}",
        ("export", "cam.yaml"),
        {"cam.yaml": text.encode(), **files},
        judge=judge,
        seconds=LONG,
    )


def _started(rng: Random, number: int, kind: str, file: tuple[str, str]) -> Attack:
    """A recipe made of points; what says the follower has a base radius and a motion, or not."""
    name, text = file
    recipe = RECIPES[kind]
    if rng.random() < 0.5:
        recipe = recipe.replace("base_radius: 40, ", "")
    words = ["new", "--from", name, "cam.yaml", rng.choice(["new.yaml", "new.yaml", "cam.yaml", "-"])]
    return Attack(f"started {number}", tuple(words), {"cam.yaml": recipe.encode(), name: text.encode()})
