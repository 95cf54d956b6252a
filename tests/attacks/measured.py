"""Measured points by chance: formats, placings, noise, faults of parts and of files, options."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING

import numpy as np
from support.measured import RECIPES, bump, nothing, points, surfaces, turned

from attacks.outcome import Attack

if TYPE_CHECKING:
    from pathlib import Path
    from random import Random

    from attacks.outcome import Done

KINDS = (
    "roller on a stem",
    "roller on a trailing arm",
    "ring",
    "groove",
    "flat",
    "tilted flat",
    "flat on an arm",
    "knife edge on a stem",
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
def _surfaces(kind: str) -> list[tuple[int, object, object]]:
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
        lines = [line for line in done.err.splitlines() if not line.endswith(" s ...")]
        if done.status == 2 and len(lines) != 1 and "error: argument" not in done.err:
            return [f"lines: {len(lines)} lines of complaint"]
        return []

    return Attack(f"points {number}", tuple(words), {"cam.yaml": recipe.encode(), name: text.encode()}, judge=judge)


def _corrected(rng: Random, number: int, kind: str, file: tuple[str, str]) -> Attack:
    """An export that is corrected by points as those of an earlier run."""
    name, text = file
    plain = rng.choice(["dxf", "svg", "{dxf: {as: arcs, kerf: 0.1}}", "{svg: {correct: 0}}"])
    share = rng.choice(["0.8", "1", "1.5", "-1", "2", "half"])
    run = rng.choice([name, f"[{name}, {name}]", f"{{file: {name}, align: rotation}}", "no.csv", "[]"])
    recipe = RECIPES[kind].partition("\nexport:")[0]
    recipe += f"\nmade: {{points: [{run}]}}\nexport: {{files: [{plain}, {{dxf: {{as: arcs, correct: {share}}}}}]}}\n"
    return Attack(f"corrected {number}", ("export", "cam.yaml"), {"cam.yaml": recipe.encode(), name: text.encode()})


def _started(rng: Random, number: int, kind: str, file: tuple[str, str]) -> Attack:
    """A recipe made of points; what says the follower has a base radius and a motion, or not."""
    name, text = file
    recipe = RECIPES[kind]
    if rng.random() < 0.5:
        recipe = recipe.replace("base_radius: 40, ", "")
    words = ["new", "--from", name, "cam.yaml", rng.choice(["new.yaml", "new.yaml", "cam.yaml", "-"])]
    return Attack(f"started {number}", tuple(words), {"cam.yaml": recipe.encode(), name: text.encode()})
